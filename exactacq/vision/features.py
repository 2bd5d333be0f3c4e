"""Features: what can stop a sightline from turning further, that is convex corners and convex arcs.

A corner is a circle of radius 0. A line touches a feature with the obstacle on its left; its
direction then lies in the feature's *tangent range*, which turns counterclockwise from the direction
of the incoming edge to that of the outgoing one. The range is cut into `Sector`s of at most a quarter
turn, on which a rational parameter t describes the tangent line:

- corner at C, base vector e:    d(t) = e + t e',             contact C,        -1 <= t <= 1
- circle about C, base radius e: v(t) = (e (1 - t^2) + 2 t e') / (1 + t^2), contact C + v, d = v',
  0 <= t <= 1  (t is the tangent of half the angle turned; |v| = |e| is the radius)

where ' turns a vector counterclockwise by a quarter. All data are rational, also for irrational radii.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from flint import fmpq

from exactacq.curves import Arc, Curve
from exactacq.points import Point
from exactacq.reals import Real
from exactacq.vision.table import EdgeTable

Vector: TypeAlias = "tuple[fmpq, fmpq]"
ONE = fmpq(1)


@dataclass(frozen=True, slots=True)
class Sector:
    """At most a quarter turn of the tangent lines of one feature: t runs from low to high."""

    center: Vector
    base: Vector
    round: bool
    low: fmpq
    high: fmpq

    def touch(self, t: Real) -> tuple[Point, Point]:
        """Contact point and direction of the tangent line at *t*."""
        (cx, cy), (ex, ey) = self.center, self.base
        if not self.round:
            return Point(cx, cy), Point(ex - t * ey, ey + t * ex)
        square = t * t
        cosine, sine = (1 - square) / (1 + square), 2 * t / (1 + square)
        vx, vy = cosine * ex - sine * ey, cosine * ey + sine * ex
        return Point(vx + cx, vy + cy), Point(-vy, vx)

    def through(self, point: Point) -> list[Real]:
        """The parameters, in the sector or not, of the tangent lines through a point.

        At a circle the roots of (k + p) t^2 - 2 q t + (k - p) = 0 with k = |e|^2, p and q the point's
        coordinates along e and e'.
        """
        offset = point - Point(*self.center)
        base = Point(*self.base)
        along, across = base.dot(offset), base.cross(offset)
        if not self.round:
            return [across / along] if along.sign() else []
        k = Real(dot(self.base, self.base))
        square = along * along + across * across - k * k
        if square.sign() < 0:
            return []
        if (k + along).sign() == 0:
            return [(k - along) / (2 * across)] if across.sign() else []
        root = square.sqrt()
        return [(across + root) / (k + along), (across - root) / (k + along)]


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


def features(table: EdgeTable) -> list[Feature]:
    """All features of a scene, in the order of the edges they start with."""
    found: list[Feature] = []
    for e, curve in enumerate(table.curves):
        if isinstance(curve, Arc) and curve.ccw:
            found.append(_arc_feature(table, e, curve))
        if not table.full[e]:
            corner = _corner_feature(table, e, int(table.next[e]))
            if corner is not None:
                found.append(corner)
    return found


def _arc_feature(table: EdgeTable, e: int, arc: Arc) -> Feature:
    center = _exact(arc.center)
    first, last = _exact(arc.start - arc.center), _exact(arc.end - arc.center)
    sectors = tuple(_round_sectors(center, first, None if arc.full else last))
    return Feature(int(table.owner[e]), True, center, arc.radius_sq, (e,), sectors)


def _corner_feature(table: EdgeTable, e: int, following: int) -> Feature | None:
    """The corner between edge *e* and the next one, if the obstacle is convex there."""
    incoming, outgoing = table.curves[e], table.curves[following]
    first, last = leaving(incoming, at_end=True), leaving(outgoing, at_end=False)
    turn = cross(first, last)
    if turn < 0:
        return None
    if turn == 0 and (dot(first, last) > 0 or not is_spike(incoming, outgoing)):
        return None
    center = table.vertices[following]
    sectors = tuple(corner_sectors(center, first, last))
    return Feature(int(table.owner[e]), False, center, fmpq(0), (e, following), sectors)


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


def leaving(curve: Curve, at_end: bool) -> Vector:
    """Direction of travel at one end of a boundary edge."""
    if isinstance(curve, Arc):
        return _exact(curve.tangent(curve.end if at_end else curve.start))
    return _exact(curve.direction)


def corner_sectors(center: Vector, first: Vector, last: Vector | None) -> Iterator[Sector]:
    """Quarter turns from direction *first* to *last* (None: all around)."""
    ray = first
    for _ in range(4):
        base = (ray[0] - ray[1], ray[1] + ray[0])
        if last is not None and dot(ray, last) >= 0 and cross(ray, last) >= 0:
            if cross(ray, last) > 0:
                high = cross(base, last) / dot(base, last)
                yield Sector(center, base, False, -ONE, high)
            return
        yield Sector(center, base, False, -ONE, ONE)
        ray = left(ray)


def _round_sectors(center: Vector, first: Vector, last: Vector | None) -> Iterator[Sector]:
    """Quarter turns from radius *first* to *last* (None: the full circle)."""
    radius = first
    for _ in range(4):
        if last is not None and dot(radius, last) >= 0 and cross(radius, last) >= 0:
            if cross(radius, last) > 0:
                high = cross(radius, last) / (dot(radius, radius) + dot(radius, last))
                yield Sector(center, radius, True, fmpq(0), high)
            return
        yield Sector(center, radius, True, fmpq(0), ONE)
        radius = left(radius)


def dot(a: Vector, b: Vector) -> fmpq:
    """Scalar product of rational vectors."""
    return a[0] * b[0] + a[1] * b[1]


def cross(a: Vector, b: Vector) -> fmpq:
    """z of the vector product of rational vectors."""
    return a[0] * b[1] - a[1] * b[0]


def left(a: Vector) -> Vector:
    """A rational vector turned by a quarter, counterclockwise."""
    return -a[1], a[0]


def _exact(point: Point) -> Vector:
    pair = point.rational
    assert pair is not None, "boundary data are rational"
    return pair
