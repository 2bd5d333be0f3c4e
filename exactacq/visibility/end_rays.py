"""Rays from the ends of an edge, to places from which that end is what is nearest of the edge.

Seen from a place, what is visible of an edge comes nearest at the foot of a normal, where something bounds
the view of it, or at an end of the edge. In the last case the place lies in front of the edge, beyond the
normal at that end: on a ray between this normal and the direction in which the edge would go on.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from exactacq.geometry.coordinates import cross, dot, sign
from exactacq.geometry.curves import Segment
from exactacq.kernel.family_images import NONE
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import is_spike, leaving
from exactacq.visibility.line_families import Turning, Vector, corner_sectors


@dataclass(frozen=True, slots=True)
class EndRays:
    """The rays from one end of an edge. *own* are the edges into and out of that vertex.

    ``bounds`` are the directions of the first and the last ray, a quarter turn to the left at most, and
    ``passed`` the vertices that these are known to pass besides, or `NONE`.
    """

    sector: Turning
    bounds: tuple[Vector, Vector]
    own: tuple[int, int]
    passed: tuple[int, int]


def end_rays(table: EdgeTable, e: int) -> Iterator[EndRays]:
    """The rays from both ends of an edge. A full circle has no ends, and a narrow nook has no rays."""
    if table.full[e]:
        return
    for incoming, outgoing in ((int(table.previous[e]), e), (e, int(table.next[e]))):
        before = leaving(table.curves[incoming], at_end=True)
        after = leaving(table.curves[outgoing], at_end=False)
        is_start = outgoing == e
        (x, y), other = (after, incoming) if is_start else (before, outgoing)
        normal, onward, along = (y, -x), (-x, -y) if is_start else (x, y), e
        if _is_nook(table, incoming, outgoing, before, after):
            onward, along = (-before[0], -before[1]) if is_start else after, other
        first, last = (onward, normal) if is_start else (normal, onward)
        if sign(cross(first, last)) > 0:
            far = _far_end(table, along, outgoing)
            (sector,) = corner_sectors(table.vertices[outgoing], first, last)
            passed = (far, NONE) if is_start else (NONE, far)
            yield EndRays(sector, (first, last), (incoming, outgoing), passed)


def _is_nook(table: EdgeTable, incoming: int, outgoing: int, before: Vector, after: Vector) -> bool:
    """Whether less than a half turn is free at a vertex, so that the edges there bound what leaves it."""
    turn = sign(cross(before, after))
    if turn == 0 and sign(dot(before, after)) < 0:
        return not is_spike(table.curves[incoming], table.curves[outgoing])
    return turn < 0


def _far_end(table: EdgeTable, e: int, vertex: int) -> int:
    """The other vertex of an edge at a vertex, if it is straight; else `NONE`."""
    if not isinstance(table.curves[e], Segment):
        return NONE
    return int(table.next[e]) if vertex == e else e
