"""pyvispoly (CGAL's visibility polygons, an optional test dependency) on this library's scenes.

Its coordinates are exact: every rational can be handed over as it is, and areas compared for equality. Its
polygons are straight and its range is unlimited.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import pyvispoly
from flint import fmpq

from exactacq import Scene
from exactacq.numbers.rationals import rational

Corner = Sequence[object]
WORD = 1 << 30
"""Integers below this reach CGAL as such."""


def number(value: object) -> pyvispoly.FieldNumber:
    """A rational (anything that the library takes for one) as CGAL's exact number."""
    exact = rational(value)
    return _integer(int(exact.p)) / _integer(int(exact.q))


def _integer(value: int) -> pyvispoly.FieldNumber:
    if value < 0:
        return pyvispoly.FieldNumber(0) - _integer(-value)
    high, low = divmod(value, WORD)
    small = pyvispoly.FieldNumber(low)
    return _integer(high) * pyvispoly.FieldNumber(WORD) + small if high else small


def place(corner: Corner) -> pyvispoly.Point:
    """An exact point."""
    return pyvispoly.Point(number(corner[0]), number(corner[1]))


def views(scene: Scene, outer: Iterable[Corner] | None = None) -> pyvispoly.VisibilityPolygonCalculator:
    """Views of a scene of polygons within its enclosure, or within the ring *outer* (counterclockwise)."""
    rings = [[edge.start.rational for edge in obstacle.edges] for obstacle in scene.obstacles]
    if outer is None:
        outer = rings.pop()[::-1]
    holes = [_ring(reversed(ring)) for ring in rings]
    return pyvispoly.VisibilityPolygonCalculator(pyvispoly.PolygonWithHoles(_ring(outer), holes))


def _ring(corners: Iterable[Corner]) -> pyvispoly.Polygon:
    return pyvispoly.Polygon([place(corner) for corner in corners])


def square_around(scene: Scene, margin: object = 1) -> list[tuple[fmpq, fmpq]]:
    """The corners of the least square around a scene of polygons and its start, widened; counterclockwise."""
    corners = [edge.start.rational for obstacle in scene.obstacles for edge in obstacle.edges]
    if scene.start is not None:
        corners.append(scene.start.rational)
    low = [min(c[k] for c in corners) - rational(margin) for k in (0, 1)]
    side = max(max(c[k] for c in corners) + rational(margin) - low[k] for k in (0, 1))
    x, y = low
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]
