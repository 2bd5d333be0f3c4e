"""Strategies that a command line names: those of the library, and those of the user's own in files."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from inspect import isclass, signature
from types import ModuleType
from typing import TYPE_CHECKING, NamedTuple

from exactacq.errors import StrategyError, Undecided, shown
from exactacq.strategies.options import Baseline, Strategy

if TYPE_CHECKING:
    from exactacq.strategies.registry import Rules

WORDS = "|".join((*Strategy, *Baseline, "FILE.py:NAME"))
"""How the help tells what can be chosen."""


class NamedStrategy(NamedTuple):
    """What `exactacq.explore` takes, the strategy's name in messages, and the file where it is, if known.

    It ``sweeps`` if its robot is confined to a terrain, and so starts in the corner of that.
    """

    strategy: str | Rules
    name: str
    file: str = ""
    sweeps: bool = False


def chosen(text: str) -> NamedStrategy:
    """The strategy of an option: a name, FILE.py:NAME, or FILE.py if there is one only in it.

    NAME is that under which the file registers the strategy, or that of a function. The file is run.
    """
    if text in tuple(Strategy):
        return NamedStrategy(Strategy(text), text, sweeps=text == Strategy.SEED_SPREADER)
    if text in tuple(Baseline):
        return NamedStrategy(text, text)
    from exactacq.strategies.registry import names, registered

    own = registered(text)
    if own is not None:
        code = getattr(own.rules, "__code__", None)
        return NamedStrategy(text, text, "" if code is None else code.co_filename, own.confined)
    path, colon, name = (text, "", "") if text.endswith(".py") else text.rpartition(":")
    if not path:
        raise StrategyError(
            f"--strategy: no strategy {shown(text)}; there are {', '.join(names())}, and FILE.py:NAME"
        )
    return _of_file(path, name if colon else None)


def _of_file(path: str, name: str | None) -> NamedStrategy:
    """The strategy of a name in a file, or the only one there."""
    from exactacq.strategies.registry import registered

    module = _run(path)
    offered = _offered(module)
    if not offered:
        raise StrategyError(
            f"--strategy: {path}: there is no strategy in it: define a function that takes a robot"
        )
    if name is None:
        if len(offered) != 1:
            raise StrategyError(f"--strategy: which of {path}? {_told(path, offered)}")
        (name,) = offered
    if name not in offered:
        raise StrategyError(f"--strategy: {path} has no strategy {shown(name)}; {_told(path, offered)}")
    own = registered(name)
    if own is not None and own.rules.__module__ == module.__name__:
        return NamedStrategy(name, name, path, own.confined)
    return NamedStrategy(getattr(module, name), name, path)


def _told(path: str, offered: list[str]) -> str:
    return f"there are {', '.join(f'{path}:{name}' for name in offered)}"


def _offered(module: ModuleType) -> list[str]:
    """The strategies that a file registers; if there are none, what it defines that takes one argument."""
    from exactacq.strategies.registry import registered_in

    return registered_in(module.__name__) or [
        name
        for name, thing in vars(module).items()
        if callable(thing) and not isclass(thing) and not name.startswith("_")
        if thing.__module__ == module.__name__ and _takes_one(thing)
    ]


def _takes_one(function: Callable[..., object]) -> bool:
    """Whether a function can be called with a robot alone."""
    try:
        signature(function).bind(None)
    except TypeError:
        return False
    except ValueError:
        pass  # What does not tell what it takes may take one.
    return True


def _run(path: str) -> ModuleType:
    """The module that a file defines; it may import what lies beside it. Nothing is written."""
    place = os.path.abspath(path)
    try:
        with open(path, "rb") as file:
            source = file.read()
    except OSError as error:
        raise StrategyError(f"--strategy: {path}: {error.strerror}") from None
    module = ModuleType(place)
    module.__file__ = place
    sys.modules[place] = module
    sys.path.insert(0, os.path.dirname(place))
    try:
        with blaming(path):
            exec(compile(source, path, "exec", dont_inherit=True), vars(module))
    except (SyntaxError, ValueError) as error:
        if isinstance(error, StrategyError):
            raise
        line = f", line {error.lineno}" if isinstance(error, SyntaxError) and error.lineno else ""
        raise StrategyError(f"{path}{line}: not Python: {getattr(error, 'msg', error)}") from None
    finally:
        sys.path.remove(os.path.dirname(place))
    return module


@contextmanager
def blaming(file: str) -> Iterator[None]:
    """Make an error that comes out of a file a `StrategyError` that names the file and its line.

    That a comparison is undecided is no fault of the file.
    """
    try:
        yield
    except Undecided:
        raise
    except (Exception, SystemExit) as error:
        frames = [
            (line, frame.f_code.co_name)
            for frame, line in traceback.walk_tb(error.__traceback__)
            if frame.f_code.co_filename == file
        ]
        if not frames:
            raise
        line, name = frames[-1]
        where = f"{file}, line {line}" if name == "<module>" else f"{file}, line {line}, in {name}"
        text = f": {error}" if str(error) else ""
        raise StrategyError(f"{where}: {type(error).__name__}{text}") from error
