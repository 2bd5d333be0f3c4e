"""Features: convex corners and convex arcs, the places that a line of sight can touch without being blocked.

A corner is a circle of radius 0. A line touches a feature with the obstacle on its left; its direction
then lies in the feature's *tangent range*, which turns counterclockwise from the direction of the
incoming edge to that of the outgoing one. The range is divided into `Sector`s of at most a quarter turn.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from weakref import WeakKeyDictionary

from flint import fmpq

from exactacq.geometry.coordinates import Vector, cross, dot, raw, same_direction, sign
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.kernel.images import STRAIGHT
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.line_families import Sector, corner_sectors, round_sectors


@dataclass(frozen=True, slots=True)
class Feature:
    """A convex corner (``round`` false) or a convex arc of obstacle ``owner``.

    ``edges`` are the edges that pass through the contact: the two at a corner, the arc itself.
    """

    owner: int
    round: bool
    center: Vector
    radius_sq: fmpq
    edges: tuple[int, ...]
    sectors: tuple[Sector, ...]


class Joint(Enum):
    """How two edges of a boundary meet: with more than a half turn free between them, just that, or less."""

    CONVEX = "convex"
    SMOOTH = "smooth"
    REFLEX = "reflex"


def joint(incoming: Curve, outgoing: Curve, before: Vector, after: Vector) -> Joint:
    """How an edge meets the next one, with their directions of travel there; of a cusp curvatures tell."""
    turn = sign(cross(before, after))
    if turn == 0 and dot(before, after) > 0:
        return Joint.SMOOTH
    is_convex = turn > 0 if turn else is_spike(incoming, outgoing)
    return Joint.CONVEX if is_convex else Joint.REFLEX


_kept: WeakKeyDictionary[EdgeTable, list[Feature]] = WeakKeyDictionary()
_corners_kept: WeakKeyDictionary[EdgeTable, list[bool]] = WeakKeyDictionary()


def features(table: EdgeTable) -> list[Feature]:
    """All features of a scene, in the order of the edges they start with: made once for a table."""
    if table not in _kept:
        _kept[table] = _features(table)
    return _kept[table]


def corners_of_segments(table: EdgeTable) -> list[bool]:
    """By vertices, whether a corner of two segments is there at which the obstacle is convex."""
    if table not in _corners_kept:
        kind, found = table.kinds, [False] * len(table.curves)
        for feature in features(table):
            if not feature.round:
                incoming, vertex = feature.edges
                found[vertex] = kind[incoming] == STRAIGHT == kind[vertex]
        _corners_kept[table] = found
    return _corners_kept[table]


def _features(table: EdgeTable) -> list[Feature]:
    found: list[Feature] = []
    for e, curve in enumerate(table.curves):
        if isinstance(curve, Arc) and curve.ccw:
            found.append(_arc_feature(table, e, curve))
        if not table.full[e]:
            corner = _corner_feature(table, e, table.following[e])
            if corner is not None:
                found.append(corner)
    return found


def _arc_feature(table: EdgeTable, e: int, arc: Arc) -> Feature:
    center = _exact(arc.center)
    first, last = _exact(arc.start - arc.center), _exact(arc.end - arc.center)
    sectors = tuple(round_sectors(center, first, None if arc.full else last))
    return Feature(int(table.owner[e]), True, center, arc.radius_sq, (e,), sectors)


def _corner_feature(table: EdgeTable, e: int, following: int) -> Feature | None:
    """The corner between edge *e* and the next one, if the obstacle is convex there."""
    incoming, outgoing = table.curves[e], table.curves[following]
    first, last = leaving(incoming, at_end=True), leaving(outgoing, at_end=False)
    if joint(incoming, outgoing, first, last) is not Joint.CONVEX:
        return None
    sectors = tuple(corner_sectors(table.vertices[following], first, last))
    return corner_at(table, (e, following), sectors)


def corner_at(table: EdgeTable, edges: tuple[int, int], sectors: tuple[Sector, ...]) -> Feature:
    """The corner between two edges, convex or not, with the sectors of some lines through it."""
    e, following = edges
    return Feature(int(table.owner[e]), False, table.vertices[following], fmpq(0), edges, sectors)


def is_spike(incoming: Curve, outgoing: Curve) -> bool:
    """Of two edges that leave a cusp side by side: whether the obstacle fills the cusp.

    Seen along the cusp, the outgoing edge then bends away to the right of the incoming one; signed
    curvatures are compared (one of them at least is an arc, or the edges would overlap).
    """
    outward, inward = _curvature(outgoing), -_curvature(incoming)
    return outward < inward


def _curvature(curve: Curve) -> Real:
    """Signed curvature in the direction of travel, positive for a left bend."""
    if not isinstance(curve, Arc):
        return Real(0)
    return 1 / curve.radius if curve.ccw else -1 / curve.radius


def enters(incoming: Curve, outgoing: Curve, before: Vector, after: Vector, direction: Vector) -> bool:
    """Whether a ray from a boundary point leads straight into its obstacle.

    *before* and *after* are the directions of travel into and out of the point. Along an edge the ray is free
    if the edge is straight or convex.
    """
    back = -before[0], -before[1]
    along = [same_direction(after, direction), same_direction(back, direction)]
    curls = [isinstance(c, Arc) and not c.ccw for c in (outgoing, incoming)]
    turn = sign(cross(after, back))
    if turn == 0 and sign(dot(after, back)) > 0:
        spike = is_spike(incoming, outgoing)
        if not along[0]:
            return not spike
        return all(curls) if spike else any(curls)
    if along[0] or along[1]:
        return curls[0] if along[0] else curls[1]
    left, right = sign(cross(after, direction)) > 0, sign(cross(direction, back)) > 0
    return (left and right) if turn > 0 else left if turn == 0 else (left or right)


def directions_at(table: EdgeTable, point: Point, own: Iterable[int]) -> Iterator[Vector]:
    """Directions of the edges through a point: there a line about it passes from free to blocked."""
    for e in own:
        curve = table.curves[e]
        yield raw(curve.tangent(point) if isinstance(curve, Arc) else curve.direction)


def leaving(curve: Curve, at_end: bool) -> Vector:
    """Direction of travel at one end of a boundary edge."""
    if isinstance(curve, Arc):
        return _exact(curve.tangent(curve.end if at_end else curve.start))
    return _exact(curve.direction)


def _exact(point: Point) -> Vector:
    pair = point.rational
    assert pair is not None, "boundary data are rational"
    return pair
