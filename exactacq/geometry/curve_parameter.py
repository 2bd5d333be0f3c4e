"""Rails: exact parameters along a curve, so that places on it are ordered by comparing numbers.

On a segment u is the fraction of the way, 0 <= u <= 1. On an arc u = k + t, where k counts the quarter turns
since the start and t is the tangent of half the angle turned since then, 0 <= t < 1. Rational parameters of
boundary edges are points with rational coordinates.
"""

from __future__ import annotations

from flint import arb, fmpq

from exactacq.cached import cached_property
from exactacq.geometry.constructions import put_on
from exactacq.geometry.coordinates import Vector, cross, dot, minus, raw, sign
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.late import BITS, Balls, ball_of, balls
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real

ZERO = Real(0)


class Rail:
    """The exact parameter of points along one curve; points given must lie on it."""

    def __init__(self, curve: Curve) -> None:
        self.curve = curve
        self.is_closed = isinstance(curve, Arc) and curve.full
        self._last: tuple[Point, Real] = curve.start, ZERO

    def __reduce__(self) -> tuple[type[Rail], tuple[Curve]]:
        # Balls cannot be pickled.
        return Rail, (self.curve,)

    @cached_property
    def top(self) -> Real:
        """Parameter of the end: 1 for a segment, 4 for a full circle."""
        if isinstance(self.curve, Segment):
            return Real(1)
        return Real(4) if self.curve.full else self._turns.exact(self.curve.end)

    def parameter(self, point: Point) -> Real:
        """Where a point of the curve lies: its ends by identity; a full circle's start is at 0.

        The parameter of a late point is late, and made with it; on an arc that of every irrational point is
        late, for it is a quotient of such numbers, and order is most often clear without it. The last point
        that is not late has the same number when it is asked for again, as the one place of a line is.
        """
        if point is self.curve.start:
            return ZERO
        if point is self.curve.end:
            return self.top
        last, u = self._last
        if point is not last:
            u = self._fractions.of(point) if isinstance(self.curve, Segment) else self._turns.of(point)
            if isinstance(self.curve, Arc) and (u.is_late or point.rational is None):
                put_on(point, self.curve.carrier)
            if not point.is_late:
                # A late one may know the rail.
                self._last = point, u
        return u

    def point(self, u: fmpq) -> Point:
        """The point at a rational parameter."""
        curve = self.curve
        if isinstance(curve, Segment):
            offset: Point = curve.direction * u
            return curve.start + offset
        k = min(int(u.floor()), 3)
        x, y = self._turns.bases[k]
        t = u - k
        cosine, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t) * self._turns.sense
        return curve.center + Point(x * cosine - y * sine, y * cosine + x * sine)

    def around(self, u: arb) -> Balls | None:
        """Balls around the points at the parameters in a ball; None if these may lie on two quarters."""
        curve = self.curve
        if isinstance(curve, Segment):
            start, (dx, dy) = balls(curve.start), balls(curve.direction)
            return start[0] + u * dx, start[1] + u * dy
        k = (u - u.rad()).floor().unique_fmpz()
        if k is None or not 0 <= k < 4 or not u < k + 1:
            return None
        (cx, cy), (x, y) = balls(curve.center), self._turns.around[int(k)]
        t = u - k
        cosine, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t) * self._turns.sense
        return cx + x * cosine - y * sine, cy + y * cosine + x * sine

    # Late numbers keep these and not the rail, which keeps a number: so none of them is in a cycle.

    @cached_property
    def _fractions(self) -> _Along:
        assert isinstance(self.curve, Segment)
        return _Along(self.curve)

    @cached_property
    def _turns(self) -> _Turns:
        assert isinstance(self.curve, Arc)
        return _Turns(self.curve)


class _Along:
    """Fractions of the way along a segment, read off the coordinate that grows faster, or off a rational one.

    Where an irrational segment crosses upright or level lines, equal places have equal numbers so, however
    they were found.
    """

    def __init__(self, segment: Segment) -> None:
        start, end = raw(segment.start), raw(segment.end)
        x, y = minus(end, start)
        across, up = abs(float(x)), abs(float(y))
        # Both floats are 0 where the segment is shorter than any float.
        self.steep = across < up or (across == up == 0 and sign(x) == 0)
        both = (start[0], x), (start[1], y)
        (self.start, self.growth), self._other = both[self.steep], both[not self.steep]

    def of(self, point: Point) -> Real:
        """That of a point, as late if the point is."""
        if not point.x.is_late:
            return self.exact(point)
        start, growth = self._balls
        around = ((point.y if self.steep else point.x).ball(BITS) - start) / growth
        return Real.late(around, _Along.exact, self, point)

    def exact(self, point: Point) -> Real:
        """That of a point, which is made."""
        place, other = (point.y, point.x) if self.steep else (point.x, point.y)
        start, growth = self.start, self.growth
        if place.rational is None and other.rational is not None and self._grows_both:
            place, (start, growth) = other, self._other
        return Real(((place if place.rational is None else place.rational) - start) / growth)

    @cached_property
    def _grows_both(self) -> bool:
        """Whether balls tell that the other coordinate changes too."""
        return ball_sign(ball_of(self._other[1])) != 0

    @cached_property
    def _balls(self) -> Balls:
        return ball_of(self.start), ball_of(self.growth)


class _Turns:
    """Quarter turns along an arc, and tangents of half the angle beyond them."""

    def __init__(self, arc: Arc) -> None:
        self.center, self.radius_sq, self.sense = arc.center, arc.radius_sq, 1 if arc.ccw else -1
        x, y = minus(raw(arc.start), raw(arc.center))
        self.bases: list[Vector] = [(x, y)]
        """Radii of the arc's start and of the quarter turns after it."""
        for _ in range(3):
            x, y = -y * self.sense, x * self.sense
            self.bases.append((x, y))

    def of(self, point: Point) -> Real:
        """That of a point, as late if it is irrational or late and balls tell the quarter turn."""
        if not point.is_late and point.rational is not None:
            return self.exact(point)
        (x, y), (radius_sq, (cx, cy), (a, b)) = balls(point), self._balls
        u, v = x - cx, y - cy
        along, across = a * u + b * v, (a * v - b * u) * self.sense
        for k in range(4):
            if along > 0 and across > 0:
                return Real.late(k + across / (radius_sq + along), _Turns.exact, self, point)
            along, across = across, -along
        return self.exact(point)

    def exact(self, point: Point) -> Real:
        """That of a point, which is made."""
        radius, base = minus(raw(point), raw(self.center)), self.bases[0]
        along, across = dot(base, radius), cross(base, radius) * self.sense
        for k in range(4):
            if sign(along) > 0 and sign(across) >= 0:
                return Real(k + across / (self.radius_sq + along))
            # As seen from where the next quarter begins.
            along, across = across, -along
        # The four half-open quarters are disjoint and cover the plane but for its origin, the centre, which
        # is not on the circle.
        raise AssertionError("one of four quarter turns contains every direction")

    @cached_property
    def around(self) -> list[Balls]:
        """Balls around the radii of `bases`."""
        return [(ball_of(x), ball_of(y)) for x, y in self.bases]

    @cached_property
    def _balls(self) -> tuple[arb, Balls, Balls]:
        """Balls around the squared radius, the centre, and the radius of the start."""
        return arb(self.radius_sq), balls(self.center), self.around[0]
