"""Which edges of one boundary a point, or its ray to the east, may meet: by their boxes.

To locate a point on a boundary of n edges takes n exact tests; nearly all of them are about edges far away.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite

import numpy as np

from exactacq.geometry.box_index import Boxes, bounds
from exactacq.geometry.curves import Curve
from exactacq.geometry.points import Point
from exactacq.numbers.float_bounds import float_ball
from exactacq.numbers.real import Real

FEW = 12
"""So few edges are tested at once: to sort them out would take longer."""


class BoundaryIndex:
    """The edges of a boundary with their boxes, which are made when a first point is asked about.

    >>> from exactacq.geometry.curves import Segment
    >>> corners = [Point(x, y) for x, y in [(k, 0) for k in range(20)] + [(9, 9)]]
    >>> edges = [Segment(p, q) for p, q in zip(corners, corners[1:] + corners[:1])]
    >>> index = BoundaryIndex(edges)
    >>> index.may_pass(Point("11/2", -1)), index.may_pass(Point("1/2", 0)), index.may_be_east(Point(17, 1))
    ([], [0, 20], [19])
    """

    def __init__(self, edges: Sequence[Curve]) -> None:
        self.edges = edges
        self._sides: Boxes | None = None

    def may_pass(self, point: Point) -> list[int]:
        """The numbers of the edges whose boxes may hold a point: all others certainly do not pass it."""
        return self._meeting(point, 0.0)

    def may_be_east(self, point: Point) -> list[int]:
        """The numbers of the edges that the ray from a point to the east may meet.

        All others lie on one side of the ray's line, or west of the point. They add nothing to the number of
        turns that `geometry.loops.winding` counts, and do not pass the point.
        """
        return self._meeting(point, inf)

    def _meeting(self, point: Point, reach: float) -> list[int]:
        """The edges whose boxes meet the way from a point to as far to the east as *reach*."""
        if len(self.edges) <= FEW:
            return list(range(len(self.edges)))
        if self._sides is None:
            self._sides = bounds(self.edges).T.copy()
        (x, dx), (y, dy) = _around(point.x), _around(point.y)
        left, low, right, high = self._sides
        meets = (low <= y + dy) & (high >= y - dy) & (right >= x - dx) & (left <= x + dx + reach)
        found: list[int] = np.flatnonzero(meets).tolist()
        return found


def _around(value: Real) -> tuple[float, float]:
    """A float and how far it may be off, which counts the rounding of a sum of both; else 0 and infinity.

    Such a sum is rounded by less than 2^-53 of both: the error is doubled, and grows by 2^-52 of the float.
    """
    try:
        near, error = float_ball(value)
    except OverflowError:
        return 0.0, inf
    return (near, 2.0 * error + 2.0**-52 * abs(near)) if isfinite(near) else (0.0, inf)
