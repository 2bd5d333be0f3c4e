"""Where a straight way first leads into an obstacle, and which obstacle a place lies on."""

from __future__ import annotations

from functools import cmp_to_key
from itertools import pairwise
from typing import NamedTuple

from exactacq.geometry.box_index import box
from exactacq.geometry.curve_images import held_point
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Segment
from exactacq.geometry.intersections import contacts
from exactacq.geometry.points import Location, Point
from exactacq.kernel.clearance import crossed
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable


class FirstHit(NamedTuple):
    """The obstacle that a way leads into, and where: at a parameter of the way, 0 at its start."""

    obstacle: int
    place: Point
    u: Real


def first_hit(table: EdgeTable, way: Segment) -> FirstHit | None:
    """Where a way with distinct ends, whose start is free, first leads into an obstacle's interior.

    Touching a boundary and running along it do not block. None if the way is free up to its end. Floats leave
    out the edges that the way certainly misses; the contacts with the others divide it, and one exact place
    of each part tells whether that part is inside.
    """
    left, bottom, right, top = box(way)
    edges = table.around((left, bottom), (right, top), 0.0)
    verdicts = crossed(table.images, edges, held_point(way.start), held_point(way.end))
    met: dict[int, list[int]] = {}
    for e, verdict in zip(edges, verdicts, strict=True):
        if verdict >= 0:
            met.setdefault(table.owners[e], []).append(e)
    hits = (_into(table, way, k, met[k]) for k in sorted(met))
    found = [hit for hit in hits if hit is not None]
    return min(found, key=cmp_to_key(_by_parameter)) if found else None


def _by_parameter(a: FirstHit, b: FirstHit) -> int:
    return a.u.compare(b.u)


def _into(table: EdgeTable, way: Segment, obstacle: int, edges: list[int]) -> FirstHit | None:
    """Where a way first leads into one obstacle, of which it meets no other edges."""
    rail = Rail(way)
    stops = [(Real(0), way.start), (Real(1), way.end)]
    for e in edges:
        for contact in contacts(way, table.curves[e]):
            stops += [(rail.parameter(p), p) for p in (contact.start, contact.end)]
    stops.sort(key=lambda stop: stop[0])
    for (low, place), (high, _) in pairwise(stops):
        if low.compare(high) < 0:
            middle = rail.point(rational_between(low, high))
            if table.obstacles[obstacle].locate(middle) is Location.INSIDE:
                return FirstHit(obstacle, place, low)
    return None


def obstacle_at(table: EdgeTable, place: Point) -> int | None:
    """The obstacle on whose boundary a place lies, if there is one: boundaries do not meet."""
    x, y, error = held_point(place)
    near = table.around((x, y), (x, y), error)
    owners = sorted({table.owners[e] for e in near})
    return next((k for k in owners if table.obstacles[k].edges_at(place)), None)
