"""Blocked cells become rings: placed, scaled and turned, exactly."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from flint import fmpq

from exactacq.errors import FormatError, shown
from exactacq.files.counting import count
from exactacq.files.grids.outlines import JOIN, STEPS, Cells, outlines
from exactacq.files.loops.areas import Areas
from exactacq.files.loops.chains import scientific_above
from exactacq.files.loops.contents import Contents
from exactacq.files.repairs.simplify import check_tolerance, simplify

ZERO, ONE = fmpq(0), fmpq(1)


@dataclass(frozen=True, slots=True)
class Placement:
    """Where a grid lies: the width of its cells, its SW corner, and cosine and sine of how it is turned."""

    size: fmpq = ONE
    origin: tuple[fmpq, fmpq] = (ZERO, ZERO)
    turn: tuple[fmpq, fmpq] = (ONE, ZERO)

    def __call__(self, x: int, y: int) -> tuple[fmpq, fmpq, fmpq]:
        """The vertex at a lattice point."""
        step = self.size / STEPS
        (cosine, sine), u, v = self.turn, x * step, y * step
        return self.origin[0] + u * cosine - v * sine, self.origin[1] + u * sine + v * cosine, ZERO

    def steps(self, place: tuple[fmpq, fmpq]) -> tuple[fmpq, fmpq]:
        """The point of the lattice, in steps, that lies at a place."""
        (cosine, sine), step = self.turn, self.size / STEPS
        x, y = place[0] - self.origin[0], place[1] - self.origin[1]
        return (x * cosine + y * sine) / step, (y * cosine - x * sine) / step


def grid_contents(
    blocked: Cells,
    placement: Placement,
    name: str,
    start: tuple[fmpq, fmpq] | None,
    *,
    corners: str = JOIN,
    border: str = "open",
    tolerance: fmpq | None = None,
    notes: tuple[str, ...] = (),
) -> Contents:
    """The rings of the blocked cells, whose rows go up; what is free is told by where the start lies.

    With *border* "wall" nothing beyond the grid is free, and a start is needed. With a *tolerance* outlines
    get fewer vertices and stay within that length of what they were, see `exactacq.files.repairs.simplify`;
    the start stays on its side. See `outlines` for *corners*, and `exactacq.files.loops.areas` for rings
    around the start. Raises `FormatError`.
    """
    if placement.size <= 0:
        raise FormatError(f"a cell {shown(placement.size)} wide; the width of a cell is positive")
    walled = border == "wall"
    startless = ""
    if walled:
        height, width = blocked.shape
        (x0, y0, _), (x1, y1, _) = placement(0, 0), placement(STEPS * width, STEPS * height)
        startless = (
            "beyond its border all is blocked: give a start with --start X,Y (start=(x, y) in Python); "
            f"it lies between ({shown(x0)}, {shown(y0)}) and ({shown(x1)}, {shown(y1)})"
        )
    rings = outlines(np.pad(blocked, 1, constant_values=True) if walled else blocked, corners)
    if walled:  # of the border of blocked cells around, the outside is none of the grid's
        rings = [[(x - STEPS, y - STEPS) for x, y in ring] for ring in rings if (0, 0) not in ring]
    areas = Areas(notes=list(notes))
    cut = sum(bool(x % STEPS or y % STEPS) for ring in rings for x, y in ring) // 4
    if cut:
        how = "joined" if corners == JOIN else "parted"
        areas.notes.append(
            f"{how} the blocked cells at {count(cut, 'corner')} in which two of them touch, "
            f"by cuts of 1/{STEPS} of a cell"
        )
    if tolerance is not None:
        check_tolerance(tolerance)
        before = sum(map(len, rings))
        rings = simplify(
            rings, tolerance * STEPS / placement.size, [] if start is None else [placement.steps(start)]
        )
        far = scientific_above(tolerance)
        areas.notes.append(
            f"took out {before - sum(map(len, rings))} of {before} vertices of outlines: no point of an "
            f"outline, new or old, is farther than {far} from the other; none meet, each lies where it lay"
        )
    for ring in rings:
        areas.add([placement(x, y) for x, y in (*ring, ring[0])], None)
    return replace(areas.contents(name, start, union=None, free=int(walled)), startless=startless)
