"""Rational points of boundaries, which the audit looks at."""

from __future__ import annotations

from math import atan2, pi, tan

from flint import fmpq

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import nearest_float, rational


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
