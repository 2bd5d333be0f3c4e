"""An infinite, locally finite terrain, tried on growing parts of it: the Sightseer never runs out.

The obstacles are squares of side 1 around the points of the lattice of pitch 2, and the radius is 1: a square
sees its four neighbours and no others. All neighbours are equally near, and of these the southern one is
preferred, so on the whole lattice the robot goes south for ever. As long as the robot has circled inner
squares of a finite part only, it has seen exactly what it would have seen on the whole lattice, so that its
run there begins the same.
"""

from __future__ import annotations

from itertools import pairwise

from exactacq.numbers.rationals import rational
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Polygon
from exactacq.sensing.event import EventKind
from exactacq.strategies.run import Run
from exactacq.strategies.sightseer.strategy import sightseer
from exactacq.study.claims.model import Finding, found
from exactacq.study.claims.trees import circled

ROWS = (3, 6, 9)
"""Rows of the parts; a second or two in all."""
COLUMNS = 3


def part(rows: int) -> Scene:
    """Three columns and so many rows of the lattice; the start is on the middle one of the second last row.

    Squares are numbered from west to east, row by row from the south: of two that are equally near the
    Sightseer takes the southern one.
    """
    half = rational("1/2")
    places = [(2 * x, 2 * y) for y in range(rows) for x in range(COLUMNS)]
    squares = [
        Polygon([(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)])
        for x, y in places
    ]
    return Scene(squares, (2, 2 * rows - 4 - half), radius=1, name=f"lattice-{rows}")


def inner_visits(run: Run, rows: int) -> int:
    """How many squares are circled before the first on the rim of a part: the same on the whole lattice."""
    count = 0
    for k in circled(run):
        row, column = divmod(k, COLUMNS)
        if not (0 < row < rows - 1 and 0 < column < COLUMNS - 1):
            return count
        count += 1
    return count


def column(rows: int) -> list[int]:
    """The inner squares of a part that the robot circles first: south in the middle column."""
    return [COLUMNS * row + COLUMNS // 2 for row in range(rows - 2, 0, -1)]


def never_ends() -> Finding:
    """FAILS, with the growing numbers of visits, if the Sightseer does not end on an infinite lattice.

    That is: on ever larger parts it circles ever more squares that it would circle on the whole lattice, the
    column that the argument predicts, and after each visit but the very last one it has an unvisited square
    on its map.
    """
    inner = []
    for rows in ROWS:
        run = sightseer(part(rows))
        if len(circled(run)) != COLUMNS * rows:
            return found(True, f"{len(circled(run))} squares are circled in {rows} rows")
        if _runs_dry(run):
            return found(True, f"nothing unvisited is left on the map before the end of {rows} rows")
        inner.append(inner_visits(run, rows))
        if circled(run)[: inner[-1]] != column(rows):
            return found(True, f"{circled(run)[: inner[-1]]} are circled first in {rows} rows")
    grows = all(a < b for a, b in pairwise(inner))
    return found(not grows, f"visits that the whole lattice shares: {inner}, growing with the part")


def _runs_dry(run: Run) -> bool:
    """Whether at the end of some visit but the last every square that was seen had been visited."""
    seen: set[int] = set()
    hits = 0
    for event in run.events:
        if event.kind is EventKind.SIGHT and event.obstacle is not None:
            seen.add(event.obstacle)
        elif event.kind is EventKind.HIT:
            hits += 1
        elif event.kind in (EventKind.LEAVE, EventKind.BACKTRACK) and len(seen) == hits < len(run.visits):
            return True
    return False
