"""The fan of a point: all rays from it, divided into cells whose rays meet the same edge first."""

from __future__ import annotations

from exactacq.geometry.coordinates import raw
from exactacq.geometry.points import Point
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import directions_at
from exactacq.visibility.line_families import EAST, corner_sectors
from exactacq.visibility.rotational_sweep import Pencil, pencil


def fan(table: EdgeTable, point: Point, reach: float, own: tuple[int, ...] | None = None) -> list[Pencil]:
    """Four pencils of a quarter turn each, counterclockwise from the east; only ``ahead`` means anything.

    The point must be free. On a boundary, a ray into the obstacle meets nothing; *own* are the edges through
    the point, found if not given.
    """
    own = table.edges_at(point) if own is None else own
    breaks = tuple(directions_at(table, point, own))
    return [pencil(table, sector, own, reach, breaks) for sector in corner_sectors(raw(point), EAST, None)]
