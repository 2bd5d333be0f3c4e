"""Points of curves: rational ones, which the audit looks at, and the nearest ones."""

from __future__ import annotations

from math import atan2, pi, tan

from flint import fmpq

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import contacts
from exactacq.geometry.nearest_points import nearest_points
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import nearest_float, rational
from exactacq.numbers.real import Real


def point_at(edge: Curve, share: fmpq) -> Point | None:
    """A rational point at about a share of an edge of the scene, from the tangent of half the angle."""
    if isinstance(edge, Segment):
        return edge.point(share)
    return _turned(edge, nearest_float(share) * _angle(edge, edge.end))


def point_near(edge: Curve, point: Point, shift: fmpq) -> Point | None:
    """A rational point of an edge about *shift* beyond a point of it, None beyond the edge's ends."""
    if isinstance(edge, Arc):
        return _turned(edge, _angle(edge, point, full=0.0) + nearest_float(shift) / float(edge.radius))
    along = (point - edge.start).dot(edge.direction) / edge.direction.norm_sq()
    share = rational(float(along)) + shift / rational(float(edge.length))
    return edge.point(share) if 0 <= share <= 1 else None


def _angle(arc: Arc, point: Point, full: float = 2 * pi) -> float:
    """The angle from an arc's start to a point of it in the arc's sense, in floats; *full* at the start."""
    (a, b), (c, d) = ((p - arc.center).xy for p in (arc.start, point))
    angle = atan2(a * d - b * c, a * c + b * d) % (2 * pi)
    return (angle if arc.ccw else -angle % (2 * pi)) or full


def _turned(arc: Arc, angle: float) -> Point | None:
    """The arc's start, turned by about an angle in its sense, if that is on the arc."""
    half = rational(tan(angle / 2 if arc.ccw else -angle / 2))
    cosine, sine = (1 - half * half) / (1 + half * half), 2 * half / (1 + half * half)
    radial = arc.start - arc.center
    point = arc.center + radial * cosine + radial.left() * sine
    return point if arc.contains(point) else None


def near_points(curve: Curve | Point, place: Point) -> list[Point]:
    """Points of a curve among which is one that is nearest to a place."""
    if isinstance(curve, Point):
        return [curve]
    if isinstance(curve, Segment):
        origin, along = curve.whole.start, curve.whole.direction
        foot = origin + along * ((place - origin).dot(along) / along.norm_sq())
        return [curve.start, curve.end, *([foot] if curve.contains(foot) else [])]
    ray = place - curve.center
    size = ray.norm_sq()
    foot = curve.center + ray * (curve.radius / size.sqrt()) if size.sign() else curve.start
    return [curve.start, curve.end, *([foot] if curve.contains(foot) else [])]


def distances_sq(curve: Curve | Point, rest: Curve | Point) -> list[Real]:
    """Squared distances between two curves or points, the least one among them.

    They are not compared with each other: those of mirror images are equal in two forms.
    """
    if isinstance(curve, Point):
        return [(p - curve).norm_sq() for p in near_points(rest, curve)]
    if isinstance(rest, Point):
        return distances_sq(rest, curve)
    if contacts(curve, rest):
        return [Real(0)]
    return [pair.distance_sq for pair in nearest_points(curve, rest)]
