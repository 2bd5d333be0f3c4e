"""How near edges, boxes and circles may come to each other: in floats, with margins that cover the rounding.

What is proven so need not be looked at exactly, as for the distance of two boundaries.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from exactacq.geometry.nearest_points import nearest_points
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import STRAIGHT, EdgeTable, Floats, Ints, quotient

SLACK = 1e-12
"""Floats of lengths that differ by more than this part tell which is less."""


def boundary_distance(table: EdgeTable, i: int, j: int) -> Real:
    """The exact distance between the boundaries of two obstacles: the least of their edges'."""
    a, b = (np.array(table.edges_of(k), dtype=np.intp) for k in (i, j))
    bounds = pair_bounds(table, a, b)
    least: Real | None = None
    reach = np.inf
    for k in np.argsort(bounds, axis=None):
        r, c = divmod(int(k), len(b))
        if bounds[r, c] > reach:
            break
        for found in nearest_points(table.curves[a[r]], table.curves[b[c]]):
            if least is None or found.distance_sq < least:
                least = found.distance_sq
                reach = float(least.sqrt()) * (1 + SLACK)
    # The nearest points of two compact sets are those of some two edges, and the loop ends only after it has
    # found a pair.
    assert least is not None, "two boundaries have nearest points"
    return least.sqrt()


def pair_bounds(table: EdgeTable, a: Ints, b: Ints) -> Floats:
    """Lower bounds of the distances between edges: one row for each of *a*, one column for each of *b*."""
    low, high = table.boxes[:, :2], table.boxes[:, 2:]
    apart = np.maximum(low[a][:, None] - high[b][None], low[b][None] - high[a][:, None])
    bounds = np.hypot(*np.moveaxis(np.maximum(apart, 0.0), 2, 0))
    straight_a, straight_b = table.kind[a] == STRAIGHT, table.kind[b] == STRAIGHT
    middles = np.where(straight_a[:, None], table.start[a], table.center[a])
    ends = np.where(straight_a[:, None], table.end[a], table.center[a])
    size_a, size_b = table.radius[a], table.radius[b]
    other = np.where(straight_b[:, None], table.start[b], table.center[b])
    other_ends = np.where(straight_b[:, None], table.end[b], table.center[b])
    to_b = np.minimum(_to_segments(middles, other, other_ends), _to_segments(ends, other, other_ends))
    to_a = np.minimum(_to_segments(other, middles, ends), _to_segments(other_ends, middles, ends)).T
    capsules = np.minimum(to_b, to_a) - size_a[:, None] - size_b[None]
    bounds = np.maximum(bounds, capsules)
    return np.maximum(bounds * (1 - 1e-14) - 64 * table.roundoff, 0.0)


def may_face(table: EdgeTable, a: Ints, b: Ints) -> NDArray[np.bool_]:
    """False where no free shortest segment can join two edges: one lies behind the other.

    Such a segment leaves a straight edge, or one of the two edges at a vertex, to its right.
    """
    return (_reach_right(table, a, b) > 0) & (_reach_right(table, b, a).T > 0)


def _reach_right(table: EdgeTable, a: Ints, b: Ints) -> Floats:
    """How far at most edges b (columns) lie to the right of the edges a (rows); infinite for arcs a."""
    along = table.end[a] - table.start[a]
    size = np.hypot(along[:, 0], along[:, 1])
    normal = np.stack((along[:, 1], -along[:, 0]), axis=1) / np.maximum(size, 1e-300)[:, None]
    straight = table.kind[b] == STRAIGHT
    offset = (normal * table.start[a]).sum(axis=1)[:, None]
    at_start, at_end = normal @ table.start[b].T - offset, normal @ table.end[b].T - offset
    at_center = normal @ table.center[b].T - offset + table.radius[b]
    right = np.where(straight, np.maximum(at_start, at_end), at_center)
    margin = 64 * table.roundoff * (1 + np.minimum(quotient(table.magnitude, size), 1e60))[:, None]
    return np.where((table.kind[a] == STRAIGHT)[:, None], right + margin, np.inf)


def _to_segments(points: Floats, starts: Floats, ends: Floats) -> Floats:
    """Distances from points (rows) to segments (columns)."""
    along = ends - starts
    offset = points[:, None] - starts[None]
    size = np.maximum((along**2).sum(axis=1), 1e-300)
    u = np.clip((offset * along).sum(axis=2) / size, 0.0, 1.0)
    distances: Floats = np.hypot(*np.moveaxis(offset - u[:, :, None] * along, 2, 0))
    return distances


def box_gaps(points: Floats, box: Floats, sizes: Floats) -> Floats:
    """Lower bounds of the distances from circles to a box."""
    apart = np.maximum(np.maximum(box[:2] - points, points - box[2:]), 0.0)
    return np.maximum(np.hypot(apart[:, 0], apart[:, 1]) * (1 - 1e-13) - sizes * (1 + 1e-13), 0.0)


def near_hull(places: Floats, points: Floats, sizes: Floats) -> NDArray[np.bool_]:
    """Which circles may meet the convex hull of some points; False is certain for radii less a margin.

    A circle does not if it lies on one side of a line and all the points on the other. Directions of lines
    through two of the points are tried; any would do, so their rounding takes nothing from the truth. The
    margin is for heights over the lines: with coordinates up to M and u = 2^-53, a scalar product is off by 3
    u M, the difference to that of the line by 8 u M, and two of them are compared: 16 u M. The normal is a
    unit vector but for 4 u, so a radius up to M counts for 4 u M more or less. `EdgeTable.roundoff` is at
    least 8 u M, so three of it are enough.
    """
    one, other = (points[k] for k in np.triu_indices(len(points), 1))
    along = other - one
    long = np.hypot(along[:, 0], along[:, 1])
    one, along = one[long > 0], along[long > 0] / long[long > 0, None]
    normal = np.stack((-along[:, 1], along[:, 0]), axis=1)
    level = (normal * one).sum(axis=1)
    heights, rims = normal @ points.T - level[:, None], places @ normal.T - level
    beyond = (rims - sizes[:, None] > heights.max(axis=1)) | (rims + sizes[:, None] < heights.min(axis=1))
    near: NDArray[np.bool_] = ~beyond.any(axis=1)
    return near
