"""The errors of the library; each message is one line that says what is wrong, where, and what to do."""

from __future__ import annotations

from collections.abc import Iterable
from reprlib import repr as short
from typing import Any
from unicodedata import category


class ExactacqError(Exception):
    """Base class of the errors that exactacq defines.

    >>> import exactacq as xa
    >>> try:
    ...     xa.load("nowhere")
    ... except xa.ExactacqError as error:
    ...     print(error)
    nowhere: no such file or gallery scene; `exactacq gallery` lists the scenes
    """


class InvalidScene(ExactacqError, ValueError):
    """A scene breaks a rule of `exactacq.scene.validation`: all violations found are in ``violations``.

    Of a scene from a file, ``cure`` says what may help, such as an option of the file's format.

    >>> import exactacq as xa
    >>> xa.Scene([xa.Circle((0, 0), 1)], start=(0, 0))
    Traceback (most recent call last):
    exactacq.errors.InvalidScene: start (0, 0) lies inside obstacle O1: it must lie in free space
    """

    def __init__(self, violations: Iterable[str], cure: str = "") -> None:
        self.violations, self.cure = tuple(violations), cure
        super().__init__("; ".join((*self.violations, cure) if cure else self.violations))

    def __reduce__(self) -> tuple[type[InvalidScene], tuple[tuple[str, ...], str]]:
        return type(self), (self.violations, self.cure)


class FormatError(ExactacqError, ValueError):
    """A file cannot be read as a scene, or a value as the number, point or shape that is needed.

    >>> import exactacq as xa
    >>> xa.Length("1/2/3")
    Traceback (most recent call last):
    exactacq.errors.FormatError: not a number: '1/2/3'
    """


class CurvesRefused(FormatError):
    """A drawing has curves that are read by arcs only, with the option ``flatten``."""


class MoveError(ExactacqError, ValueError):
    """A robot was to do, or asked, what makes no sense where it is; the message says what is wrong.

    >>> import exactacq as xa
    >>> xa.Robot(xa.load("circles")).walk()
    Traceback (most recent call last):
    exactacq.errors.MoveError: the robot is at no boundary: go to one first
    """


class StrategyError(ExactacqError, ValueError):
    """A strategy of the user's own is not there, cannot be loaded, or has failed; the message says where.

    >>> import exactacq as xa
    >>> xa.strategy("two words")
    Traceback (most recent call last):
    exactacq.errors.StrategyError: a strategy has a name of letters, digits, "-" and "_", not 'two words'
    """


class Undecided(ExactacqError, ArithmeticError):
    """An exact comparison is beyond the library's limits; the message names it. It is never guessed.

    ``comparison`` says what is compared. Where a strategy could not go on, or what a robot saw is not decided
    (see `Run.sense`), ``run`` is the run up to there, a `Run` like any other whose ``ending`` is
    `Ending.UNDECIDED`, ``place`` is where the robot stands, and ``obstacle`` the number of the obstacle at
    which it is. All three are None elsewhere.

    >>> import exactacq as xa
    >>> circle, double = xa.Length.turns(1), xa.Length.turns(2)
    >>> (circle + 1) / circle == (double + 2) / double
    Traceback (most recent call last):
    exactacq.errors.Undecided: two quotients of irrational lengths that may be equal
    """

    def __init__(self, comparison: str = "", run: Any = None) -> None:
        self.comparison, self.run = comparison, run
        self.is_told = False
        cure = CURES.get(getattr(run, "strategy", ""), CURE_OF_OWN)
        super().__init__(comparison if run is None else f"{_so_far(run)}: {comparison}; {cure}")

    @property
    def place(self) -> Any:
        """Where the robot stands."""
        return None if self.run is None else self.run.events[-1].point

    @property
    def obstacle(self) -> int | None:
        """At which obstacle it is."""
        return None if self.run is None else self.run.events[-1].obstacle

    def __reduce__(self) -> tuple[type[Undecided], tuple[str, Any]]:
        return type(self), (self.comparison, self.run)


CURE = "a start or a radius close by may decide it"
"""What to try where a run is undecided: ties are exact, so the least change ends them."""
CURES = dict.fromkeys(("sightseer", "seed-spreader", "nearest-frontier"), CURE)
CURE_OF_OWN = (
    "places found from places have longer and longer numbers: moves that halt with `just_past=True`, and "
    "ways to corners or to `map.beside` an end of what is known, keep them short"
)
"""What to try where a strategy of the user's own is undecided: it picks the places itself."""


def _so_far(run: Any) -> str:
    """Where a run was given up."""
    stop = run.events[-1]
    x, y = stop.point.xy
    at = "" if stop.obstacle is None else f" on {list(run.names())[stop.obstacle]}"
    return f"undecided after {float(run.length):.6g} of the path, at ({x:.6g}, {y:.6g}){at}"


class deciding:  # noqa: N801  # It is used as a word, as `about`.
    """Put what is being decided before the numbers of an `Undecided`: *words* with places for *what*.

    Nothing is written unless the comparison fails. The innermost words stay: they are the closest.
    """

    __slots__ = ("_what", "_words")

    def __init__(self, words: str, *what: Any) -> None:
        self._words, self._what = words, what

    def __enter__(self) -> None: ...

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, Undecided) and error.run is None and not error.is_told:
            told = Undecided(f"{self._words.format(*map(_spot, self._what))}: {error.comparison}")
            told.is_told = True
            raise told from error


def _spot(what: Any) -> str:
    """A place in six digits, anything else as it is."""
    spot = getattr(what, "xy", None)
    return str(what) if spot is None else "({:.6g}, {:.6g})".format(*spot)


class AuditError(ExactacqError, AssertionError):
    """A finished run contradicts its scene; the message names the first flaw found.

    >>> import exactacq as xa
    >>> from dataclasses import replace
    >>> xa.audit(replace(xa.sightseer(xa.load("circles")), visits=()))
    Traceback (most recent call last):
    exactacq.errors.AuditError: visits are [], but the hits were [0, 1]
    """


class about:  # noqa: N801  # It is used as a word: ``with about("start"):``.
    """Put the name of a part before what a `FormatError` says of it."""

    __slots__ = ("_part",)

    def __init__(self, part: str) -> None:
        self._part = part

    def __enter__(self) -> None: ...

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, FormatError):
            raise type(error)(f"{self._part}: {error}") from None


def shown(value: object) -> str:
    """A value in a message: short, and on one line."""
    return " ".join(short(value).split())


def without_controls(name: str) -> str:
    """A name to be shown, without control characters: a terminal would obey them, and XML forbids them."""
    return "".join(" " if category(character) == "Cc" else character for character in name)
