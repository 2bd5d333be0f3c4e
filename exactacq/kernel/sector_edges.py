"""Which edges the lines of a sector may meet: a sweep is spared the others."""

from __future__ import annotations

from typing import Final

from exactacq.kernel.bounded import WIDEN, dot_sign, total
from exactacq.kernel.family_images import side_of_all
from exactacq.kernel.images import SLIDING, STRAIGHT, TURNING, EdgeImage
from exactacq.kernel.lines import Frame, Line, line_at, rounding

NO_VERTEX: Final = -1
BEHIND: Final = 2
"""Certainly ahead of the contact on no line; besides the sides 1 and -1 of `side_of_all`, and 0."""


def may_be_met(
    images: list[EdgeImage],
    edges: list[int],
    frame: Frame,
    low: tuple[float, float],
    high: tuple[float, float],
    goes_back: bool,
) -> list[int]:
    """Those of some edges that lines of a sector may meet, in the same order.

    *low* and *high* are the parameters of the first and the last line, held with bounds. Unless the sector
    *goes_back* what lies behind the contact is left out too. What lies to the left of all lines is convex, as
    is what lies to their right, or behind all: there lies a segment if both of its ends do, and an arc if its
    circle does.
    """
    first, last = line_at(frame, low[0], low[1]), line_at(frame, high[0], high[1])
    found: list[int] = []
    vertex, there = NO_VERTEX, 0
    for e in edges:
        edge = images[e]
        if edge.kind != STRAIGHT:
            x, y = edge.cx, edge.cy
            here = _where(frame, first, last, x, y, (edge.radius + rounding(x, y)) * WIDEN, goes_back)
            if here == 0:
                found.append(e)
            continue
        # Mostly an edge begins where the last one ends.
        here = there if e == vertex else _where_is(images, e, frame, first, last, goes_back)
        vertex = edge.following
        there = _where_is(images, vertex, frame, first, last, goes_back)
        if here == 0 or here != there:
            found.append(e)
    return found


def _where_is(images: list[EdgeImage], v: int, frame: Frame, first: Line, last: Line, goes_back: bool) -> int:
    """Where a vertex lies."""
    x, y = images[v].x, images[v].y
    return _where(frame, first, last, x, y, rounding(x, y), goes_back)


def _where(frame: Frame, first: Line, last: Line, x: float, y: float, error: float, goes_back: bool) -> int:
    """1 or -1 if a place certainly lies left or right of all lines, `BEHIND` if behind, 0 if that is open.

    Lines turn by a quarter at most, about a contact that stays, or slide across their direction: so what is
    behind the first line lies ahead of the contact on none.
    """
    side = side_of_all(frame, first, last, x, y, error)
    if side or goes_back or frame[0] not in (TURNING, SLIDING):
        return side
    return BEHIND if _is_behind(first, x, y, error) else 0


def _is_behind(line: Line, x: float, y: float, error: float) -> bool:
    cx, cy, dx, dy, ce, de = line
    ox, p = total(x, error, -cx, ce)
    oy, q = total(y, error, -cy, ce)
    return dot_sign(ox, oy, max(p, q), dx, dy, de) < 0
