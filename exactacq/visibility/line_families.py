"""Sectors: one-parameter families of lines, each with a rational frame and a parameter t.

- `Turning` about a corner C:    d(t) = e + t e',                           contact C,      -1 <= t <= 1
- `Rolling` on a circle about C: v(t) = (e (1 - t^2) + 2 t e') / (1 + t^2), contact C + v, d = v', 0 <= t <= 1
  (t is the tangent of half the angle turned; |v| = |e| is the radius)
- `Sliding` along a segment:     contact C + t e, d = e' or -e',            0 <= t <= 1
- `Spokes` of an arc about C:    d(t) as for Turning, contact C + r d / |d|, going outward or inward

where ' turns a vector counterclockwise by a quarter. Turning and Rolling lines are the tangent lines of a
feature, Sliding and Spokes the normals of an edge. Boundary data are rational, also for irrational radii;
sectors that belong to a point of the path may have irrational frames. The event parameters at which a line
passes a point or touches a circle come twice: as float intervals (`exactacq.kernel.line_events`), and
exactly.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import frexp, hypot, ldexp
from typing import Any, TypeAlias

from flint import arb, fmpq

from exactacq.cached import cached_property
from exactacq.geometry.constructions import Carrier, is_put_on
from exactacq.geometry.coordinates import Vector, cross, dot, sign
from exactacq.geometry.late import BITS, ball_of
from exactacq.geometry.points import Point
from exactacq.kernel import lines
from exactacq.kernel.bounded import TINY, UNIT, WIDEN
from exactacq.kernel.images import ROLLING, SLIDING, SPOKES, TURNING, LineFrame
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.rationals import nearest_float
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import with_rests
from exactacq.visibility.quadratic_roots import QuadraticRoot, root_of

ZERO, ONE = fmpq(0), fmpq(1)
EAST: Vector = (ONE, ZERO)
WEST: Vector = (-ONE, ZERO)
Held: TypeAlias = "tuple[float, float]"
"""A float near a number, and a bound of its error."""


@dataclass(frozen=True, eq=False)
class Sector(ABC):
    """A family of lines: t runs from low to high, at most a quarter turn where lines turn.

    It is equal to itself alone, as what is found for its lines is kept by it.
    """

    center: Vector
    base: Vector
    low: fmpq | Real
    high: fmpq | Real

    round = False
    """Whether the contact rolls on a circle of radius |base|."""

    @property
    def turns(self) -> bool:
        """Whether lines turn counterclockwise, about the contact or, where they only go ahead, behind it."""
        return True

    @cached_property
    def size(self) -> float:
        """Length of the base vector in floats."""
        return hypot(float(self.base[0]), float(self.base[1]))

    @cached_property
    def image(self) -> lines.Frame:
        """The sector in floats, if it `is_rational`."""
        (x, y), (dx, dy) = self.center, self.base
        kind, radius, sense = self._kind
        return kind, nearest_float(x), nearest_float(y), nearest_float(dx), nearest_float(dy), radius, sense

    @property
    def span(self) -> tuple[Held, Held]:
        """The parameters of the first and the last line in floats, with bounds of the errors."""
        return held(self.low), held(self.high)

    @cached_property
    def balls(self) -> tuple[arb, arb, arb, arb]:
        """Centre and base vector in balls."""
        x, y, ex, ey = map(ball_of, (*self.center, *self.base))
        return x, y, ex, ey

    @property
    def extent(self) -> float:
        """How far from the centre contacts lie at most."""
        return 0.0

    @abstractmethod
    def touch(self, t: Real) -> tuple[Point, Point]:
        """Contact point and direction of the line at *t*."""

    @abstractmethod
    def through(self, point: Point) -> list[Real]:
        """The parameters, in the sector or not, of the lines through a point."""

    @abstractmethod
    def exact(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> Real | None:
        """The parameter of an event, or None if the line that floats proposed does not exist.

        ``side`` is 0 for a point, 1 or -1 for a circle to the left or the right of the line where that
        matters; ``sign`` tells the solutions apart.
        """

    def root(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> QuadraticRoot | fmpq | None:
        """The parameter of an event that there is, if a rational quadratic is seen to have it as a root."""
        return None

    @cached_property
    def is_rational(self) -> bool:
        """Whether all coordinates of the centre and the base vector are rational: one alone says nothing."""
        (x, y), (dx, dy) = self.center, self.base
        return type(x) is type(y) is type(dx) is type(dy) is fmpq

    def _frame(self, center: Vector) -> tuple[Vector, Any, Any]:
        """Offset of a point from the centre, and its components along and across the base vector."""
        offset = center[0] - self.center[0], center[1] - self.center[1]
        return offset, dot(self.base, offset), cross(self.base, offset)

    def frame(self, place: tuple[float, float, float, float] | None = None) -> LineFrame:
        """The family as the compiled loops take it; *place* is its centre with rests, if that is known."""
        kind, radius, sense = self._kind
        center, blur = _place(self.center) if place is None else (place, margin(0.0))
        (x, p), (y, q) = (held(c) for c in self.base)
        # A power of two, so that dividing by it is exact.
        unit = ldexp(1.0, frexp(max(abs(x), abs(y)))[1])
        return LineFrame(kind, center, blur, (x / unit, y / unit, max(p, q) / unit), unit, radius, sense)

    @property
    @abstractmethod
    def _kind(self) -> tuple[int, float, int]:
        """Kind of the family, radius and sense of its normals (see `exactacq.kernel.images.LineFrame`)."""


class Turning(Sector):
    """The lines through a point."""

    def touch(self, t: Real) -> tuple[Point, Point]:
        return Point(*self.center), self.direction(t)

    def direction(self, t: Real) -> Point:
        """e + t e'."""
        (ex, ey), q = self.base, t if t.rational is None else t.rational
        return Point(ex - q * ey, ey + q * ex)

    def through(self, point: Point) -> list[Real]:
        _, along, across = self._frame((point.x, point.y))
        return [across / along] if along.sign() else []

    @property
    def _kind(self) -> tuple[int, float, int]:
        return TURNING, 0.0, 1

    def exact(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> Real | None:
        offset, along, across = self._frame(center)
        if side == 0:
            return None if along == 0 else Real(across / along)
        # tan(angle of the centre +- asin(r / distance)), from the addition theorem
        square = dot(offset, offset) - radius_sq
        if square < 0:
            return None
        reach, radius = Real(square).sqrt(), Real(radius_sq).sqrt() * sign
        below = reach * along - radius * across
        return (reach * across + radius * along) / below if below.sign() else None

    def root(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> QuadraticRoot | fmpq | None:
        """With d = e + t e': (d x w)^2 = r^2 |d|^2, if w leads to the centre; d x w is across - t along."""
        if side == 0 or not self.is_rational:
            return None
        _, along, across = self._frame(center)
        square = radius_sq * dot(self.base, self.base)
        return root_of(along * along - square, along * across, across * across - square, sign)


class Rolling(Sector):
    """The tangent lines of a circle, which lies to their left."""

    round = True

    @property
    def extent(self) -> float:
        return self.size * (1 + 1e-9)

    def touch(self, t: Real) -> tuple[Point, Point]:
        (cx, cy), (ex, ey) = self.center, self.base
        square = t * t
        cosine, sine = (1 - square) / (1 + square), 2 * t / (1 + square)
        vx, vy = cosine * ex - sine * ey, cosine * ey + sine * ex
        return Point(vx + cx, vy + cy), Point(-vy, vx)

    def touching(self, point: Point) -> Real:
        """The parameter of the line that touches the circle at a point, not opposite to the start."""
        _, along, across = self._frame((point.x, point.y))
        return Real(across / (dot(self.base, self.base) + along))

    def through(self, point: Point) -> list[Real]:
        """Roots of (k + p) t^2 - 2 q t + (k - p) = 0, k = |e|^2, p and q the components along e and e'."""
        _, along, across = self._frame((point.x, point.y))
        k = Real(dot(self.base, self.base))
        on_circle = self.is_rational and is_put_on(point, Carrier(*self.center, dot(self.base, self.base)))
        square = Real(0) if on_circle else along * along + across * across - k * k
        if square.sign() < 0:
            return []
        if (k + along).sign() == 0:
            return [(k - along) / (2 * across)] if across.sign() else []
        root = square.sqrt()
        return [(across + root) / (k + along), (across - root) / (k + along)]

    @property
    def _kind(self) -> tuple[int, float, int]:
        return ROLLING, 0.0, 1

    def exact(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> Real | None:
        """Root of (k + q) t^2 - 2 p t + (k - q) = 0, k = rho (rho +- r)."""
        offset, along, across = self._frame(center)
        rho_sq = dot(self.base, self.base)
        k = Real(rho_sq) + side * Real(rho_sq * radius_sq).sqrt()
        square = Real(rho_sq * dot(offset, offset)) - k * k
        if square.sign() < 0:
            return None
        root = square.sqrt() * sign
        below = k + along
        if below.sign() == 0:
            # One root is at infinity: half a turn from the base, in no sector.
            return (k - along) / (across - root) if (across - root).sign() else None
        value: Real = (across + root) / below
        return value

    def root(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> QuadraticRoot | fmpq | None:
        """That of the quadratic in `exact`, if k is rational."""
        if not self.is_rational:
            return None
        rho_sq = dot(self.base, self.base)
        product: fmpq | None = radius_sq
        if side and radius_sq != rho_sq:
            # Otherwise the circles are equal, as in most rows.
            product = Real(rho_sq * radius_sq).sqrt().rational
        if product is None:
            return None
        _, along, across = self._frame(center)
        k = rho_sq + side * product
        return root_of(k + along, across, k - along, sign)


@dataclass(frozen=True, eq=False)
class Sliding(Sector):
    """The normals of the segment from C to C + e, going to its left or right.

    Of some that are ``touching`` a circle the parameter is known, by the first arc on the circle and the sign
    that tells which of the two tangents it is; of some through a vertex, by its number and 0.
    """

    leftward: bool
    touching: Mapping[tuple[int, int], Real] = field(default_factory=dict)

    @property
    def turns(self) -> bool:
        return False

    @property
    def extent(self) -> float:
        return self.size * (1 + 1e-9)

    def touch(self, t: Real) -> tuple[Point, Point]:
        (cx, cy), (ex, ey) = self.center, self.base
        normal = Point(-ey, ex) if self.leftward else Point(ey, -ex)
        return Point(cx + ex * t, cy + ey * t), normal

    def through(self, point: Point) -> list[Real]:
        _, along, _ = self._frame((point.x, point.y))
        return [along / dot(self.base, self.base)]

    @property
    def _kind(self) -> tuple[int, float, int]:
        return SLIDING, 0.0, 1 if self.leftward else -1

    def exact(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> Real | None:
        _, along, _ = self._frame(center)
        square = dot(self.base, self.base)
        shift = Real(radius_sq * square).sqrt() * sign if side else 0
        value: Real = (along + shift) / Real(square)
        return value

    def height(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> Real:
        """The parameter of an event in another measure, |e|^2 t + e C: the order is the same.

        Of an irrational segment events have comparable heights, for these are linear in e and |e|.
        """
        height: Real = dot(self.base, center)
        return height + Real(radius_sq).sqrt() * self._length * sign if side else height

    @cached_property
    def _length(self) -> Real:
        """That of the base vector."""
        return Real(dot(self.base, self.base)).sqrt()

    def height_at(self, t: Real) -> Real:
        """The height of the line at a parameter."""
        height: Real = dot(self.base, self.center) + t * dot(self.base, self.base)
        return height

    def root(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> QuadraticRoot | fmpq | None:
        """(|e|^2 t - along)^2 = r^2 |e|^2."""
        if side == 0 or not self.is_rational:
            return None
        square = dot(self.base, self.base)
        _, along, _ = self._frame(center)
        return root_of(square * square, square * along, along * along - radius_sq * square, sign)


@dataclass(frozen=True, eq=False)
class Spokes(Turning):
    """The normals of an arc about C, going away from C (``outward``) or through it."""

    radius_sq: fmpq
    outward: bool

    @property
    def turns(self) -> bool:
        return self.outward

    @cached_property
    def _radius(self) -> float:
        return float(Real(self.radius_sq).sqrt())

    @property
    def extent(self) -> float:
        return self._radius * (1 + 1e-9)

    def touch(self, t: Real) -> tuple[Point, Point]:
        direction = self.direction(t)
        spoke = direction * (Real(self.radius_sq) / direction.norm_sq()).sqrt()
        return Point(*self.center) + spoke, direction if self.outward else -direction

    @property
    def _kind(self) -> tuple[int, float, int]:
        return SPOKES, self._radius, 1 if self.outward else -1


def corner_sectors(center: Vector, first: Vector, last: Vector | None) -> Iterator[Turning]:
    """Quarter turns from direction *first* to *last* (None: all around)."""
    for base, low, high in quarters(first, last):
        yield Turning(center, base, low, high)


def quarters(first: Vector, last: Vector | None) -> Iterator[tuple[Vector, fmpq, Any]]:
    """Base vectors and parameter ranges of the quarter turns from *first* to *last*."""
    ray = first
    for _ in range(4):
        base = (ray[0] - ray[1], ray[1] + ray[0])
        if last is not None and sign(dot(ray, last)) >= 0 and sign(cross(ray, last)) >= 0:
            if sign(cross(ray, last)) > 0:
                yield base, -ONE, cross(base, last) / dot(base, last)
            return
        yield base, -ONE, ONE
        ray = left(ray)


def round_sectors(center: Vector, first: Vector, last: Vector | None) -> Iterator[Rolling]:
    """Quarter turns from radius *first* to *last* (None: the full circle)."""
    radius = first
    for _ in range(4):
        if last is not None and dot(radius, last) >= 0 and cross(radius, last) >= 0:
            if cross(radius, last) > 0:
                high = cross(radius, last) / (dot(radius, radius) + dot(radius, last))
                yield Rolling(center, radius, ZERO, high)
            return
        yield Rolling(center, radius, ZERO, ONE)
        radius = left(radius)


def left(a: Vector) -> Vector:
    """A vector turned by a quarter, counterclockwise."""
    return -a[1], a[0]


def held(value: fmpq | Real) -> Held:
    """A float near a number and a bound of its error."""
    if isinstance(value, Real):
        ball = value.ball(BITS)
        near = float(ball)
        return near, margin((2 * float(ball.rad()) + 2 * UNIT * abs(near) + TINY) * WIDEN)
    near = float(value)
    return near, margin(UNIT * abs(near) + TINY)


def _place(point: Vector) -> tuple[tuple[float, float, float, float], float]:
    """A point in floats, with rests if it is rational, and a bound of what they leave."""
    x, y = point
    if isinstance(x, Real) or isinstance(y, Real):
        (u, p), (v, q) = held(x), held(y)
        return (u, 0.0, v, 0.0), max(p, q)
    return with_rests((x, y)), margin(0.0)
