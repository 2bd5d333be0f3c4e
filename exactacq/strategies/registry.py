"""Strategies of the user's own, by name."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias, TypeVar

from exactacq.errors import StrategyError, shown
from exactacq.numbers.length import Length
from exactacq.strategies.nearest_frontier import nearest_frontier
from exactacq.strategies.options import Baseline, Strategy
from exactacq.strategies.robot import Robot

Rules: TypeAlias = "Callable[[Robot], Any]"
"""What a strategy is: it is called with a robot at the start, and is done when it returns."""
Bounds: TypeAlias = "Callable[[Any], Iterable[tuple[str, str, Length | int]]]"
"""From a finished run names, sources and values of bounds on its length."""
Function = TypeVar("Function", bound=Rules)
_NAME = re.compile(r"\w[\w-]*")


@dataclass(frozen=True)
class OwnStrategy:
    """A strategy with its name, and what bounds the length of its runs, if anything does.

    If it is ``confined``, so is its robot: it keeps within the scene's terrain and starts in the SW corner.
    """

    name: str
    rules: Rules
    bounds: Bounds | None = None
    confined: bool = False


_BASELINES = {Baseline.NEAREST_FRONTIER.value: OwnStrategy(Baseline.NEAREST_FRONTIER, nearest_frontier)}
_known: dict[str, OwnStrategy] = {}


def strategy(
    name: str, *, bounds: Bounds | None = None, confined: bool = False
) -> Callable[[Function], Function]:
    """Register a strategy of one's own under a name: a decorator of a function that takes a `Robot`.

    The name has letters, digits, "-" and "_" only. *bounds*, if given, is called with each finished run and
    gives names, sources and exact values of bounds on its length; they are found again, and not read, when a
    run is read from a file. The robot of a *confined* strategy is confined to the scene's terrain (see
    `Robot`), and starts in its SW corner, as that of the Seed Spreader. A function that is defined anew in
    the same module takes the place of the one before. Raises `StrategyError` for another name, and for that
    of another strategy.

    >>> import exactacq as xa
    >>> @xa.strategy("nearest-first", bounds=lambda run: [("most", "a guess", run.radius * 2)])
    ... def nearest_first(robot):
    ...     while link := robot.nearest_unvisited():
    ...         robot.take(link)
    ...         robot.circle()
    >>> run = xa.explore(xa.load("circles"), "nearest-first")
    >>> print(run.visits, run.length, [(bound.name, bound.holds) for bound in run.bounds])
    (0, 1) 5 + 12*pi [('most', False)]
    """
    if name in (*Strategy, *_BASELINES):
        raise StrategyError(f"{name} is a strategy of exactacq: choose another name")
    if callable(name):
        raise StrategyError('a strategy is registered under a name: write @xa.strategy("NAME")')
    if bounds is not None and not callable(bounds):
        raise StrategyError(f"bounds are what a function of the run gives, not {shown(bounds)}")
    if not is_name(name):
        raise StrategyError(f'a strategy has a name of letters, digits, "-" and "_", not {shown(name)}')

    def register(rules: Function) -> Function:
        if not callable(rules):
            raise StrategyError(f"the strategy {name} is no function: {shown(rules)}")
        other = _known.get(name)
        if other is not None and _home(other.rules) != _home(rules):
            raise StrategyError(f"there is a strategy {name} already, in {_home(other.rules)[0]}")
        _known[name] = OwnStrategy(name, rules, bounds, confined)
        return rules

    return register


def is_name(name: object) -> bool:
    """Whether a strategy of the user's own may have a name: whether it is a word of such characters."""
    return isinstance(name, str) and _NAME.fullmatch(name) is not None and name not in tuple(Strategy)


def _home(rules: Rules) -> tuple[str, str]:
    """Where a function was defined."""
    return getattr(rules, "__module__", ""), getattr(rules, "__qualname__", repr(rules))


def registered(name: str) -> OwnStrategy | None:
    """The strategy of a name, if there is one."""
    return _BASELINES.get(name) or _known.get(name)


def registered_in(module: str) -> list[str]:
    """The names of the strategies that a module defines, in the order in which it registered them."""
    return [name for name, own in _known.items() if _home(own.rules)[0] == module]


def of_function(rules: Rules) -> OwnStrategy:
    """A function as a strategy: as it was registered, or under its own name, with "-" if that is taken."""
    # A method is another object each time that it is asked for, and equal.
    found = next((own for own in (*_BASELINES.values(), *_known.values()) if own.rules == rules), None)
    if found is not None:
        return found
    name = re.sub(r"[^\w-]", "", getattr(rules, "__name__", "")) or type(rules).__name__
    return OwnStrategy(f"{name}-" if name in names() else name, rules)


def names() -> list[str]:
    """The names of all strategies, those of exactacq first."""
    return [*Strategy, *Baseline, *sorted(_known)]
