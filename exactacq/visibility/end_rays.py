"""Rays from the ends of an edge, to places from which that end is what is nearest of the edge.

Seen from a place, what is visible of an edge comes nearest at the foot of a normal, where something bounds
the view of it, or at an end of the edge. In the last case the place lies in front of the edge, beyond the
normal at that end: on a ray between this normal and the direction in which the edge would go on.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from exactacq.geometry.coordinates import cross, sign
from exactacq.geometry.curves import Segment
from exactacq.kernel.family_images import NONE
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import Joint, joint, leaving
from exactacq.visibility.line_families import Turning, corner_sectors


@dataclass(frozen=True, slots=True)
class EndRays:
    """The rays from one end of an edge. *own* are the edges into and out of that vertex.

    ``bounds`` are the directions of the first and the last ray, a quarter turn to the left at most, and
    ``passed`` the vertices that these are known to pass besides, or `NONE`.
    """

    sector: Turning
    own: tuple[int, int]
    passed: tuple[int, int]


def end_rays(table: EdgeTable, e: int) -> Iterator[EndRays]:
    """The rays from both ends of an edge. A full circle has none, nor an end in a corner that is narrow."""
    if table.full[e]:
        return
    for incoming, outgoing in ((table.preceding[e], e), (e, table.following[e])):
        curves = table.curves[incoming], table.curves[outgoing]
        before, after = leaving(curves[0], at_end=True), leaving(curves[1], at_end=False)
        is_start = outgoing == e
        (x, y), other = (after, incoming) if is_start else (before, outgoing)
        normal, onward, along = (y, -x), (-x, -y) if is_start else (x, y), e
        if joint(*curves, before, after) is Joint.REFLEX:
            # The other edge there bounds the rays.
            onward, along = (-before[0], -before[1]) if is_start else after, other
        first, last = (onward, normal) if is_start else (normal, onward)
        if sign(cross(first, last)) > 0:
            far = _far_end(table, along, outgoing)
            (sector,) = corner_sectors(table.vertices[outgoing], first, last)
            passed = (far, NONE) if is_start else (NONE, far)
            yield EndRays(sector, (incoming, outgoing), passed)


def _far_end(table: EdgeTable, e: int, vertex: int) -> int:
    """The other vertex of an edge at a vertex, if it is straight; else `NONE`."""
    if not isinstance(table.curves[e], Segment):
        return NONE
    return table.following[e] if vertex == e else e
