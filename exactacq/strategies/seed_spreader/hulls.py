"""Boxes in floats around known pieces of boundaries, and around what lies between them: for filters.

They are padded where that matters.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import hypot

from exactacq.geometry.curves import Curve, Segment


def hull(curve: Curve) -> tuple[float, ...]:
    """A box around a curve, of an arc around its circle."""
    if isinstance(curve, Segment):
        (a, b), (c, d) = curve.start.xy, curve.end.xy
        return min(a, c), min(b, d), max(a, c), max(b, d)
    (x, y), r = curve.center.xy, float(curve.radius) * (1 + 1e-12)
    return x - r, y - r, x + r, y + r


def overlap(a: Sequence[float], b: Sequence[float]) -> bool:
    """Whether two boxes meet."""
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


class ConvexHull:
    """The convex hull of some places in floats, grown by *pad*: all segments between them lie in it."""

    def __init__(self, places: Iterable[tuple[float, float]], pad: float) -> None:
        ordered = sorted(set(places))
        corners = [*_chain(ordered)[:-1], *_chain(ordered[::-1])]
        self._sides = [(*a, *_unit(a, b)) for a, b in pairwise(corners)]
        self._pad = pad

    def may_meet(self, box: Sequence[float]) -> bool:
        """Whether a box does not certainly lie beside it."""
        west, south, east, north = box
        for x, y, u, v in self._sides:
            # The corner of the box that is farthest to the left of the side.
            left = u * ((north if u > 0 else south) - y) - v * ((west if v > 0 else east) - x)
            if left < -self._pad:
                return False
        return True


def _chain(places: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Of places in order those that turn to the left: one half of their convex hull."""
    found: list[tuple[float, float]] = []
    for x, y in places:
        while len(found) > 1:
            (a, b), (c, d) = found[-2:]
            if (c - a) * (y - b) - (d - b) * (x - a) > 0:
                break
            found.pop()
        found.append((x, y))
    return found


def _unit(a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    """The direction from a place to another one."""
    x, y = b[0] - a[0], b[1] - a[1]
    size = hypot(x, y)
    return x / size, y / size
