"""Rails: exact parameters along a curve, so that places on it are ordered by comparing numbers.

On a segment u is the fraction of the way, 0 <= u <= 1. On an arc u = k + t, where k counts the quarter turns
since the start and t is the tangent of half the angle turned since then, 0 <= t < 1. Rational parameters of
boundary edges are points with rational coordinates.
"""

from __future__ import annotations

from functools import cached_property, partial
from typing import Any

from flint import arb, fmpq

from exactacq.geometry.coordinates import Vector, cross, dot, minus, raw, sign
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.late import BITS, Balls, ball_of, balls
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real

ZERO = Real(0)


class Rail:
    """The exact parameter of points along one curve; points given must lie on it."""

    def __init__(self, curve: Curve) -> None:
        self.curve = curve
        self.is_closed = isinstance(curve, Arc) and curve.full

    def __reduce__(self) -> tuple[type[Rail], tuple[Curve]]:
        # Balls cannot be pickled.
        return Rail, (self.curve,)

    @cached_property
    def top(self) -> Real:
        """Parameter of the end: 1 for a segment, 4 for a full circle."""
        if isinstance(self.curve, Segment):
            return Real(1)
        return Real(4) if self.curve.full else self._turned(self.curve.end)

    def parameter(self, point: Point) -> Real:
        """Where a point of the curve lies: its ends by identity; a full circle's start is at 0.

        The parameter of a late point is late, and made with it; on an arc that of every irrational point is
        late, for it is a quotient of such numbers, and order is most often clear without it.
        """
        if point is self.curve.start:
            return ZERO
        if point is self.curve.end:
            return self.top
        if isinstance(self.curve, Segment):
            return self._late_fraction(point) if point.x.is_late else self._fraction(point)
        is_plain = not point.is_late and point.rational is not None
        return self._turned(point) if is_plain else self._late_turned(point)

    def point(self, u: fmpq) -> Point:
        """The point at a rational parameter."""
        curve = self.curve
        if isinstance(curve, Segment):
            offset: Point = curve.direction * u
            return curve.start + offset
        k = min(int(u.floor()), 3)
        x, y = self._bases[k]
        t = u - k
        cosine, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t) * self._sense
        return curve.center + Point(x * cosine - y * sine, y * cosine + x * sine)

    @cached_property
    def _axis(self) -> tuple[int, Any, Any]:
        """The coordinate that grows faster along a segment, its value at the start and its growth."""
        start, end = raw(self.curve.start), raw(self.curve.end)
        x, y = minus(end, start)
        k = 0 if abs(float(x)) >= abs(float(y)) else 1
        return k, start[k], (x, y)[k]

    def _fraction(self, point: Point) -> Real:
        k, start, growth = self._axis
        place = point.y if k else point.x
        return Real(((place if place.rational is None else place.rational) - start) / growth)

    def _late_fraction(self, point: Point) -> Real:
        """That of a late point, as late: it shares the point's maker."""
        k, start, growth = self._ball_axis
        around = ((point.y if k else point.x).ball(BITS) - start) / growth
        return Real.late(around, partial(self._fraction, point))

    @cached_property
    def _ball_axis(self) -> tuple[int, arb, arb]:
        k, start, growth = self._axis
        return k, ball_of(start), ball_of(growth)

    @cached_property
    def _sense(self) -> int:
        assert isinstance(self.curve, Arc)
        return 1 if self.curve.ccw else -1

    @cached_property
    def _bases(self) -> list[Vector]:
        """Radii of the arc's start and of the quarter turns after it."""
        assert isinstance(self.curve, Arc)
        x, y = minus(raw(self.curve.start), raw(self.curve.center))
        bases = [(x, y)]
        for _ in range(3):
            x, y = -y * self._sense, x * self._sense
            bases.append((x, y))
        return bases

    def _late_turned(self, point: Point) -> Real:
        """That of an irrational or late point, as late if balls tell the quarter turn."""
        assert isinstance(self.curve, Arc)
        (x, y), (cx, cy) = balls(point), balls(self.curve.center)
        radius, radius_sq = (x - cx, y - cy), arb(self.curve.radius_sq)
        for k, base in enumerate(self._ball_bases):
            along, across = dot(base, radius), cross(base, radius) * self._sense
            if along > 0 and across > 0:
                return Real.late(k + across / (radius_sq + along), partial(self._turned, point))
        return self._turned(point)

    @cached_property
    def _ball_bases(self) -> list[Balls]:
        return [(ball_of(x), ball_of(y)) for x, y in self._bases]

    def _turned(self, point: Point) -> Real:
        assert isinstance(self.curve, Arc)
        radius = minus(raw(point), raw(self.curve.center))
        for k, base in enumerate(self._bases):
            along, across = dot(base, radius), cross(base, radius) * self._sense
            if sign(along) > 0 and sign(across) >= 0:
                return Real(k + across / (self.curve.radius_sq + along))
        # The four half-open quarters are disjoint and cover the plane but for its origin, the centre, which
        # is not on the circle.
        raise AssertionError("one of four quarter turns contains every direction")
