"""Single lines in floats, and which of them cross a straight way before they reach what they show."""

from __future__ import annotations

from math import inf
from typing import final

from exactacq.kernel.bounded import TINY, UNIT, total
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import EVERYTHING, Span
from exactacq.kernel.lines import Line, meets_straight, side_of
from exactacq.kernel.ways import WayImage

Spot = tuple[float, float, float]
"""A point, its coordinates held with one bound."""


@final
class SingleImage:
    """A line from a place to the nearest point of what it shows: a run along a segment, or a point."""

    def __init__(self, place: Spot, near: Spot, run: CurveImage | None) -> None:
        self.line = _line_through(place, near) if run is None else line_along(run)
        self.place, self.near = place, near

    def side(self, x: float, y: float, error: float) -> int:
        """1 or -1 if a place is certainly left or right of the line, else 0."""
        return side_of(self.line, x, y, error, 0.0)


def _line_through(place: Spot, near: Spot) -> Line:
    """The line from a place to another."""
    x, p = total(near[0], near[2], -place[0], place[2])
    y, q = total(near[1], near[2], -place[1], place[2])
    return place[0], place[1], x, y, place[2], max(p, q)


def line_along(segment: CurveImage) -> Line:
    """The line of a segment."""
    x, y, dx, dy = segment.x, segment.y, segment.wx, segment.wy
    return x, y, dx, dy, UNIT * max(abs(x), abs(y)) + TINY, UNIT * max(abs(dx), abs(dy)) + TINY


def crossing_lines(lines: list[SingleImage], way: WayImage) -> list[tuple[int, Span]]:
    """The lines that may cross a way between their two points: their numbers, and where they do.

    Others leave the whole way on one side, or have both their points on one side of it.
    """
    ax, ay, bx, by, error = way.ends
    across = line_along(way.line)
    found: list[tuple[int, Span]] = []
    for k in range(len(lines)):
        one = lines[k]
        side = one.side(ax, ay, error)
        if side and side == one.side(bx, by, error):
            continue
        px, py, p = one.place
        qx, qy, q = one.near
        side = side_of(across, px, py, p, 0.0)
        if side and side == side_of(across, qx, qy, q, 0.0):
            continue
        _, _, u, bound, _, _, _ = meets_straight(one.line, way.line)
        found.append((k, (u - bound, u + bound) if bound < inf else EVERYTHING))
    return found
