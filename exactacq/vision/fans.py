"""The fan of a point: all rays from it, cut into cells in which one edge is met first."""

from __future__ import annotations

from collections.abc import Iterator

from flint import fmpq

from exactacq.curves import Arc
from exactacq.points import Point
from exactacq.vectors import raw
from exactacq.vision.pencil import Pencil, pencil
from exactacq.vision.sectors import Vector, corner_sectors
from exactacq.vision.table import EdgeTable

EAST = fmpq(1), fmpq(0)


def fan(table: EdgeTable, point: Point, reach: float, own: tuple[int, ...] | None = None) -> list[Pencil]:
    """Four pencils of a quarter turn each, counterclockwise from the east; only ``ahead`` means anything.

    The point must be free. On a boundary, a ray into the obstacle meets nothing; *own* are the edges through
    the point, found by `edges_at` if not given.
    """
    own = edges_at(table, point) if own is None else own
    breaks = tuple(_tangents(table, point, own))
    return [pencil(table, sector, own, reach, breaks) for sector in corner_sectors(raw(point), EAST, None)]


def edges_at(table: EdgeTable, point: Point) -> tuple[int, ...]:
    """The edges through a point of a boundary: at a vertex the incoming one, then the outgoing one."""
    x, y = point.xy
    near = [int(e) for e in table.near((x, y), (x, y), 0.0)]
    found = [e for e in near if table.curves[e].passes(point)]
    if len(found) == 2 and table.curves[found[0]].start == point:
        found.reverse()
    return tuple(found)


def _tangents(table: EdgeTable, point: Point, own: tuple[int, ...]) -> Iterator[Vector]:
    """Directions of the boundary at a point of it: there a fan passes from free to blocked."""
    for e in own:
        curve = table.curves[e]
        tangent = curve.tangent(point) if isinstance(curve, Arc) else curve.direction
        yield raw(tangent)
