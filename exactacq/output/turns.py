"""Where the Seed Spreader turns on its M-line, in words: it decides nothing there, so no event tells it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from exactacq.files.whole_files import readable
from exactacq.numbers.length import Length
from exactacq.sensing.event import EventKind
from exactacq.strategies.run import Run, SeedSpreaderRun
from exactacq.strategies.seed_spreader.mline import MLine

CLOSED_FORM, DIGITS = 12, 6
"""Characters of a closed form that is told, and digits of a length."""


class SweepTurn(NamedTuple):
    """A turn ``after`` so many pieces of the path, and what the robot does from there on."""

    after: int
    words: str


def turns(run: Run) -> Iterator[SweepTurn]:
    """The turns from a line to the next one, in the order of the walk; none but for the Seed Spreader.

    Corners of the M-line that an obstacle covers are never reached, and are left out, and so are those
    where a boundary begins along which the robot goes on. Linear in the path and the lines.

    >>> import exactacq as xa
    >>> run = xa.seed_spreader(xa.Scene([xa.Circle((2, 4), 1)], terrain=xa.Terrain(5, 8)), radius=3)
    >>> for turn in turns(run):
    ...     print(run.path.length_after(turn.after), turn.words)
    8 end of the line: the next one is 3 further east
    11 along the next line, to the south
    19 end of the line: the next one is 2 further east
    21 along the next line, to the north
    """
    if not isinstance(run, SeedSpreaderRun):
        return
    mline = MLine(run.ground.terrain, run.radius)
    ahead = {corner: k for k, corner in enumerate(mline.corners[1:-1], 1)}
    away = set(_away(run))
    for after, piece in enumerate(run.path):
        is_on = piece.kind == "straight" and after not in away and piece.start.rational is not None
        if is_on and piece.start in ahead:
            yield SweepTurn(after, _words(mline, ahead[piece.start]))


def _away(run: SeedSpreaderRun) -> Iterator[int]:
    """The numbers of the pieces of the path on diversions; the last of these may not have ended."""
    begin: int | None = None
    for event in run.events:
        if event.kind is EventKind.DIVERT:
            begin = event.after
        elif event.kind is EventKind.RETURN and begin is not None:
            yield from range(begin, event.after)
            begin = None
    if begin is not None:
        yield from range(begin, len(run.path))


def _words(mline: MLine, corner: int) -> str:
    """What the robot does from a corner on: two of them belong to each line, its beginning and its end."""
    line, is_end = divmod(corner, 2)
    if not is_end:
        return f"along the next line, to the {'south' if line % 2 else 'north'}"
    step = Length(mline.lines[line + 1] - mline.lines[line])
    return f"end of the line: the next one is {readable(step, CLOSED_FORM, DIGITS)[0]} further east"
