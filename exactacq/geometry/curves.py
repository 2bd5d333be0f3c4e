"""Segments and circular arcs: directed pieces of boundaries and paths.

An obstacle lies on the left of its boundary. So a counterclockwise arc of a boundary is convex (the obstacle
is inside the circle) and a clockwise arc is concave.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2
from typing import TypeAlias

from flint import arb, fmpq

from exactacq.cached import cached_property
from exactacq.geometry.constructions import Carrier, is_put_on
from exactacq.geometry.geo import Geo, line_string
from exactacq.geometry.late import Balls, from_to
from exactacq.geometry.points import Orientation, Point, distance, orientation
from exactacq.geometry.strokes import Stroke
from exactacq.numbers.length import Length
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.numbers.transcendental import transcendental, turned

DRAWN = 192
"""Working bits of strokes: many are drawn once, and lengths by exact angles would take most of the time."""


class Segment:
    """The straight piece from ``start`` to ``end``, which are points or pairs of numbers.

    A robot's path may hold a piece of length 0; else the ends are distinct. Segments are equal if their ends
    are, in this order; irrational ends have no hash. Raises `FormatError` for an end that is no point.

    >>> print(Segment((0, 0), (1, 1)).length)
    sqrt(2)
    >>> Segment((0, 0), (1, "1/2")).__geo_interface__
    {'type': 'LineString', 'coordinates': ((0.0, 0.0), (1.0, 0.5))}
    """

    _whole: Segment | None = None

    def __init__(self, start: Point | Sequence[object], end: Point | Sequence[object]) -> None:
        self.start: Point = start if type(start) is Point else Point.of(start)
        self.end: Point = end if type(end) is Point else Point.of(end)

    @property
    def whole(self) -> Segment:
        """The segment with rational ends of which this one is a `part`, else itself.

        Both have one direction and one line, which the ends of the whole tell in simpler numbers.
        """
        return self._whole or self

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Segment):
            return NotImplemented
        return self is other or (self.start == other.start and self.end == other.end)

    def __hash__(self) -> int:
        return hash((self.start, self.end))

    @cached_property
    def direction(self) -> Point:
        """The vector from start to end."""
        return self.end - self.start

    @cached_property
    def length(self) -> Length:
        """Euclidean length."""
        return Length(distance(self.start, self.end))

    def point(self, u: object) -> Point:
        """The point at the rational fraction *u* of the way; ValueError unless 0 <= u <= 1.

        >>> Segment(Point(0, 0), Point(3, 4)).point("1/2")
        Point(3/2, 2)
        """
        offset: Point = self.direction * _fraction(u)
        return self.start + offset

    def after(self, length: Length) -> Point:
        """The point at a distance *length* from the start; that it is not beyond the end is not checked.

        A length with a multiple of pi or of an angle gives transcendental coordinates (Baker's theorem).

        >>> Segment(Point(0, 0), Point(3, 4)).after(Length(1))
        Point(3/5, 4/5)
        """
        known = length == Length(length.algebraic)
        way = length.algebraic if known else transcendental(Real, length.ball)
        offset: Point = self.direction * (way / self.length.algebraic)
        return self.start + offset

    def contains(self, point: Point) -> bool:
        """Whether a point *of the supporting line* lies on the closed segment; see `passes` for any point.

        >>> Segment(Point(0, 0), Point(3, 4)).contains(Point(6, 8))
        False
        """
        along = self.whole.direction
        return (point - self.start).dot(along).sign() >= 0 >= (point - self.end).dot(along).sign()

    def passes(self, point: Point) -> bool:
        """Whether the closed segment contains the point.

        >>> Segment(Point(0, 0), Point(3, 4)).passes(Point("3/2", 2))
        True
        """
        whole = self.whole
        if whole.direction.cross(point - whole.start).sign() or not self.contains(point):
            return False
        # Without length it has no line, on which all points seemed to lie.
        return self.start != self.end or point == self.start

    def may_pass(self, point: Point, bits: int) -> bool:
        """False only if balls of that precision prove that the closed segment does not contain the point."""
        offset, along = point - self.start, self.direction
        if along.cross(offset).clear_sign(bits):
            return False
        return offset.dot(along).clear_sign(bits) >= 0 >= (point - self.end).dot(along).clear_sign(bits)

    def part(self, start: Point, end: Point) -> Segment:
        """The piece between two of its points, the second not before the first; not checked.

        >>> Segment(Point(0, 0), Point(3, 4)).part(Point(0, 0), Point("3/2", 2))
        Segment(Point(0, 0), Point(3/2, 2))
        """
        piece = Segment(start, end)
        piece._whole = self._whole or (self if _is_known_rational(self) else None)
        return piece

    def reversed(self) -> Segment:
        """The segment from ``end`` to ``start``.

        >>> Segment(Point(0, 0), Point(4, 0)).reversed()
        Segment(Point(4, 0), Point(0, 0))
        """
        return Segment(self.end, self.start)

    def stroke(self) -> Stroke:
        """The segment in floats: to draw with.

        >>> Segment(Point(0, 0), Point(3, 4)).stroke().at(0.5)
        (1.5, 2.0)
        """
        with workprec(DRAWN):
            x, y = from_to(_drawn(self.start), _drawn(self.end))
            length = _drawn_length((x * x + y * y).sqrt())
        return Stroke(self.start.xy, self.end.xy, float(self.length) if length is None else length)

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON LineString, or a Point if the ends are one to floats."""
        return line_string([self.stroke()])

    def __repr__(self) -> str:
        return f"Segment({self.start!r}, {self.end!r})"


def _is_known_rational(segment: Segment) -> bool:
    """Whether the ends are rational; those that are only balls so far are not made for this."""
    return all(not end.is_late and end.rational is not None for end in (segment.start, segment.end))


class Arc:
    """The arc of a circle from ``start`` to ``end``, counterclockwise if ``ccw``.

    The supporting circle has a rational ``center`` and a rational squared radius ``radius_sq``. The angle is
    in (0, 2 pi]; a full circle has equal ends and ``full``. That the ends lie on the circle is not checked.
    Arcs are equal if all this is; irrational ends have no hash.

    >>> east, north = Point(2, 0), Point(0, 2)
    >>> quarter = Arc(east, north, Point(0, 0), fmpq(4), ccw=True)
    >>> print(quarter.length, quarter == quarter.reversed().reversed())
    pi True
    >>> len(quarter.__geo_interface__["coordinates"])
    57
    """

    def __init__(
        self, start: Point, end: Point, center: Point, radius_sq: fmpq, ccw: bool, full: bool = False
    ) -> None:
        self.start, self.end, self.center = start, end, center
        self.radius_sq, self.ccw, self.full = radius_sq, ccw, full

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Arc):
            return NotImplemented
        if (self.ccw, self.full, self.radius_sq) != (other.ccw, other.full, other.radius_sq):
            return False
        mine, its = (self.center, self.start, self.end), (other.center, other.start, other.end)
        return self is other or mine == its

    def __hash__(self) -> int:
        return hash((self.start, self.end, self.center))

    @classmethod
    def from_bulge(cls, start: Point, end: Point, bulge: object) -> Arc:
        """The arc whose included angle is ``4 atan(bulge)``, clockwise for a negative bulge.

        Start and end are rational and distinct; 1 makes a half circle. Raises ValueError for a bulge of 0,
        and `FormatError` for one that is no rational number.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1))
        Arc(Point(1, 0), Point(-1, 0), center=Point(0, 0), ccw)
        """
        chord, b = end - start, rational(bulge)
        if b == 0:
            raise ValueError("an arc has a bulge that is not 0")
        center = start + chord * fmpq(1, 2) + chord.left() * ((1 - b * b) / (4 * b))
        radius_sq = rational((start - center).norm_sq())
        return cls(start, end, center, radius_sq, b > 0)

    @classmethod
    def circle(cls, center: Point, radius_sq: Real | fmpq) -> Arc:
        """The full circle about a point, counterclockwise from its east.

        >>> Arc.circle(Point(1, 0), fmpq(4)).start
        Point(3, 0)
        """
        east = Point(center.x + Real(radius_sq).sqrt(), center.y)
        return cls(east, east, center, radius_sq, ccw=True, full=True)

    @cached_property
    def carrier(self) -> Carrier | None:
        """The supporting circle if its centre and squared radius are rational, as those of boundaries."""
        center, square = self.center.rational, Real(self.radius_sq).rational
        return None if center is None or square is None else Carrier(*center, square)

    @cached_property
    def radius(self) -> Real:
        """Radius of the supporting circle."""
        return Real(self.radius_sq).sqrt()

    @cached_property
    def turn(self) -> tuple[Real, Real]:
        """Cosine and sine of the angle from start to end, measured in the arc's own sense."""
        a, b = self.start - self.center, self.end - self.center
        sine = a.cross(b) / self.radius_sq
        return a.dot(b) / self.radius_sq, sine if self.ccw else -sine

    @cached_property
    def length(self) -> Length:
        """Radius times angle."""
        if self.full:
            return Length.turns(self.radius)
        a, b = (self.start, self.end) if self.ccw else (self.end, self.start)
        a, b = a - self.center, b - self.center
        return Length.between(self.radius, (a.x, a.y), (b.x, b.y), self.radius_sq)

    def contains(self, point: Point) -> bool:
        """Whether a point *of the supporting circle* lies on the closed arc; see `passes` for any point.

        A counterclockwise arc lies to the right of its chord, whatever its angle.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1)).contains(Point(0, -1))
        False
        """
        if self.full:
            return True
        side = orientation(self.start, self.end, point)
        return side != (Orientation.COUNTERCLOCKWISE if self.ccw else Orientation.CLOCKWISE)

    def on_circle(self, point: Point) -> bool:
        """Whether the supporting circle contains the point.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1)).on_circle(Point(0, -1))
        True
        """
        if is_put_on(point, self.carrier):
            return True
        return (point - self.center).norm_sq().compare(self.radius_sq) == 0

    def passes(self, point: Point) -> bool:
        """Whether the closed arc contains the point.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1)).passes(Point("3/5", "4/5"))
        True
        """
        return self.on_circle(point) and self.contains(point)

    def may_pass(self, point: Point, bits: int) -> bool:
        """False only if balls of that precision prove that the closed arc does not contain the point."""
        if abs(((point - self.center).norm_sq() - self.radius_sq).ball(bits)) > 0:
            return False
        side = (self.end - self.start).cross(point - self.start)
        wrong = (side if self.ccw else -side).ball(bits) > 0
        return self.full or not wrong

    def point(self, u: object) -> Point:
        """A point that moves from start (u = 0) to end (u = 1), for rational *u*; ValueError for other u.

        The tangent of a quarter of the angle grows in proportion to u (on a full circle: on each half). So
        the point is algebraic, but in general not at the fraction u of the length.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1)).point("1/2")
        Point(-7/25, 24/25)
        """
        fraction = _fraction(u)
        radial = self.start - self.center
        tangent = Real(fraction) * self.quarter_tangent
        if self.full:
            if fraction > fmpq(1, 2):
                radial, fraction = -radial, fraction - fmpq(1, 2)
            tangent = Real(2 * fraction)
        if not self.ccw:
            tangent = -tangent
        square = tangent * tangent
        half_cos, half_sin = (1 - square) / (1 + square), 2 * tangent / (1 + square)
        cosine = half_cos * half_cos - half_sin * half_sin
        sine: Real = 2 * half_cos * half_sin
        return self.center + radial * cosine + radial.left() * sine

    @cached_property
    def quarter_tangent(self) -> Real:
        """The tangent of a quarter of the angle, the size of a bulge; of a full circle that of its halves."""
        if self.full:
            return Real(1)
        cosine, sine = self.turn
        half_cos = ((1 + cosine) / 2).sqrt() * (-1 if sine.sign() < 0 else 1)
        return ((1 - cosine) / 2).sqrt() / (1 + half_cos)

    def after(self, length: Length) -> Point:
        """The point after a length of the arc, measured from its start.

        The angle is the length over the radius. With an algebraic part the coordinates are transcendental
        (Baker's theorem, see `exactacq.numbers.transcendental`). Without one ValueError, if the angle is not
        a sum of simple fractions of pi and of angles with known cosine.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1)).after(Length.turns(1, "1/6"))
        Point(1/2, sqrt(3)/2)
        """
        sense = 1 if self.ccw else -1
        radial = self.start - self.center
        if length.algebraic.sign():
            vector = turned((radial.x, radial.y), sense, length.ball, self.radius.ball)
            return self.center + Point(*vector)
        direction = length.direction(self.radius)
        if direction is None:
            told = length.decimal(15)
            raise ValueError(f"no coordinates are known for the place after {told} of an arc")
        cosine, sine = direction
        return self.center + radial * cosine + radial.left() * (sine * sense)

    def tangent(self, point: Point) -> Point:
        """Direction of travel at a point of the arc, as a vector as long as the radius.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1)).tangent(Point(0, 1))
        Point(-1, 0)
        """
        radial = point - self.center
        return radial.left() if self.ccw else -radial.left()

    def part(self, start: Point, end: Point) -> Arc:
        """The piece between two of its points, in the arc's sense; equal points give the full circle.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1)).part(Point(1, 0), Point(0, 1))
        Arc(Point(1, 0), Point(0, 1), center=Point(0, 0), ccw)
        """
        whole = start is end or start == end
        return Arc(start, end, self.center, self.radius_sq, self.ccw, full=whole)

    def reversed(self) -> Arc:
        """The arc from ``end`` to ``start``, which turns in the opposite sense.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1)).reversed()
        Arc(Point(-1, 0), Point(1, 0), center=Point(0, 0), cw)
        """
        return Arc(self.end, self.start, self.center, self.radius_sq, not self.ccw, self.full)

    def stroke(self) -> Stroke:
        """The arc in floats: to draw with.

        >>> Arc.from_bulge(Point(1, 0), Point(-1, 0), fmpq(1)).stroke().radius
        1.0
        """
        radius = float(self.radius)
        with workprec(DRAWN):
            (ax, ay), (bx, by) = (from_to(_drawn(self.center), _drawn(p)) for p in (self.start, self.end))
            across, along = (ax * by - ay * bx) * (1 if self.ccw else -1), ax * bx + ay * by
            if self.full:
                turn = 2 * arb.pi()
            elif along.mid() < 0:
                # Of half a circle the sign of the product is open.
                turn = arb.pi() + arb.atan2(-across, -along)
            else:
                turn = arb.atan2(across, along) + (2 * arb.pi() if across.mid() < 0 else 0)
            length = _drawn_length(turn * self.radius.ball(DRAWN))
        if length is None:
            radial, length = self.start - self.center, float(self.length)
            angle = atan2(float(radial.y), float(radial.x))
        else:
            angle = atan2(float(ay.mid()), float(ax.mid()))
        # A radius may be smaller than any float.
        sweep = length / radius if radius else float(turn.mid())
        sweep = sweep if self.ccw else -sweep
        return Stroke(self.start.xy, self.end.xy, length, self.center.xy, radius, angle, sweep)

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON LineString of chords: see `exactacq.geometry.geo.FLATNESS`."""
        return line_string([self.stroke()])

    def __repr__(self) -> str:
        sense = "ccw" if self.ccw else "cw"
        return f"Arc({self.start!r}, {self.end!r}, center={self.center!r}, {sense})"


Curve: TypeAlias = "Segment | Arc"


def _drawn(point: Point) -> Balls:
    """Balls around the coordinates of a point, to draw it; the caller must have set the precision."""
    return point.x.working_ball(DRAWN), point.y.working_ball(DRAWN)


def _drawn_length(ball: arb) -> float | None:
    """The float nearest to a length; None if its ball is too wide to tell, as where long numbers cancel."""
    return float(ball.mid()) if ball.rel_accuracy_bits() > DRAWN // 2 else None


def _fraction(u: object) -> fmpq:
    fraction = rational(u)
    if not 0 <= fraction <= 1:
        raise ValueError(f"a parameter lies in [0, 1], not {fraction}")
    return fraction
