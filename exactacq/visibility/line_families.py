"""Sectors: one-parameter families of lines, each with a rational frame and a parameter t.

- `Turning` about a corner C:    d(t) = e + t e',                           contact C,      -1 <= t <= 1
- `Rolling` on a circle about C: v(t) = (e (1 - t^2) + 2 t e') / (1 + t^2), contact C + v, d = v', 0 <= t <= 1
  (t is the tangent of half the angle turned; |v| = |e| is the radius)
- `Sliding` along a segment:     contact C + t e, d = e' or -e',            0 <= t <= 1
- `Spokes` of an arc about C:    d(t) as for Turning, contact C + r d / |d|, going outward or inward

where ' turns a vector counterclockwise by a quarter. Turning and Rolling lines are the tangent lines of a
feature, Sliding and Spokes the normals of an edge. Boundary data are rational, also for irrational radii;
sectors that belong to a point of the path may have irrational frames. The event parameters at which a line
passes a point or touches a circle come twice: as float guesses with proven margins, and exactly.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import hypot
from typing import Any, TypeAlias

import numpy as np
from flint import arb, fmpq

from exactacq.geometry.coordinates import cross, dot, sign
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import Floats, quotient

Vector: TypeAlias = "tuple[Any, Any]"
Guess: TypeAlias = "tuple[int, int, Floats, Floats]"
"""Side and sign of an event (see `Sector.exact`), and its float parameters with their margins."""
ZERO, ONE = fmpq(0), fmpq(1)


@dataclass(frozen=True)
class Sector(ABC):
    """A family of lines: t runs from low to high, at most a quarter turn where lines turn."""

    center: Vector
    base: Vector
    low: fmpq | Real
    high: fmpq | Real

    round = False
    """Whether the contact rolls on a circle of radius |base|."""

    @cached_property
    def origin(self) -> Floats:
        """The centre in floats."""
        return np.array((float(self.center[0]), float(self.center[1])))

    @cached_property
    def size(self) -> float:
        """Length of the base vector in floats."""
        return hypot(float(self.base[0]), float(self.base[1]))

    @cached_property
    def unit(self) -> Floats:
        """Direction of the base vector in floats."""
        return np.array((float(self.base[0]), float(self.base[1]))) / self.size

    @cached_property
    def balls(self) -> tuple[arb, arb, arb, arb]:
        """Centre and base vector in balls."""
        x, y, ex, ey = (v.ball(64) if isinstance(v, Real) else arb(v) for v in (*self.center, *self.base))
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
    def lines(self, t: Floats) -> tuple[Floats, Floats]:
        """Contacts, relative to the centre, and unit directions in floats, one row for each parameter."""

    @abstractmethod
    def past_points(self, offsets: Floats, slack: float) -> Iterator[Guess]:
        """Where lines pass points, given relative to the centre with an error below *slack*."""

    @abstractmethod
    def past_circles(self, offsets: Floats, radii: Floats, slack: float) -> Iterator[Guess]:
        """Where lines touch circles."""

    @abstractmethod
    def exact(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> Real | None:
        """The parameter of an event, or None if the line that floats proposed does not exist.

        ``side`` is 0 for a point, 1 or -1 for a circle to the left or the right of the line where that
        matters; ``sign`` tells the solutions apart.
        """

    def _frame(self, center: Vector) -> tuple[Vector, Any, Any]:
        """Offset of a point from the centre, and its components along and across the base vector."""
        offset = center[0] - self.center[0], center[1] - self.center[1]
        return offset, dot(self.base, offset), cross(self.base, offset)

    def _polar(self, offsets: Floats, slack: float) -> tuple[Floats, Floats, Floats]:
        """Distance, angle from the base vector, and error of the angle."""
        x = offsets @ self.unit
        y = offsets @ np.array((-self.unit[1], self.unit[0]))
        size = np.hypot(x, y)
        error = np.minimum(quotient(slack, size), 1.0) + 1e-14
        return size, np.arctan2(y, x), error


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

    def lines(self, t: Floats) -> tuple[Floats, Floats]:
        direction = _rotated(self.unit, np.arctan(t))
        return np.zeros_like(direction), direction

    def past_points(self, offsets: Floats, slack: float) -> Iterator[Guess]:
        _, angle, error = self._polar(offsets, slack)
        yield 0, 0, _slope(angle), 4 * error

    def past_circles(self, offsets: Floats, radii: Floats, slack: float) -> Iterator[Guess]:
        size, angle, error = self._polar(offsets, slack)
        ratio = quotient(radii, size)
        wing = np.arcsin(np.clip(ratio, -1.0, 1.0))
        margin = 4 * (error + _arc_error(ratio, error))
        for turn in (1, -1):
            yield 1, turn, np.where(ratio > 1 + error, np.nan, _slope(angle + turn * wing)), margin

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
        square = along * along + across * across - k * k
        if square.sign() < 0:
            return []
        if (k + along).sign() == 0:
            return [(k - along) / (2 * across)] if across.sign() else []
        root = square.sqrt()
        return [(across + root) / (k + along), (across - root) / (k + along)]

    def lines(self, t: Floats) -> tuple[Floats, Floats]:
        spoke = _rotated(self.unit, 2 * np.arctan(t))
        return spoke * self.size, np.stack((-spoke[:, 1], spoke[:, 0]), axis=1)

    def past_points(self, offsets: Floats, slack: float) -> Iterator[Guess]:
        for turn in (1, -1):
            yield 0, turn, *self._past(offsets, 0.0, turn, slack)

    def past_circles(self, offsets: Floats, radii: Floats, slack: float) -> Iterator[Guess]:
        for turn in (1, -1):
            for side in (1, -1):
                yield side, turn, *self._past(offsets, side * radii, turn, slack)

    def _past(self, offsets: Floats, radii: Floats | float, turn: int, slack: float) -> tuple[Floats, Floats]:
        """The line touching another circle (radius 0: through a point); negative radii lie to the right."""
        size, angle, error = self._polar(offsets, slack)
        ratio = quotient(self.size + radii, size)
        wing = np.arccos(np.clip(ratio, -1.0, 1.0))
        turned = np.remainder(angle + turn * wing + np.pi, 2 * np.pi) - np.pi
        guess, margin = np.tan(turned / 2), 4 * (error + _arc_error(ratio, error))
        return np.where(np.abs(ratio) > 1 + error, np.nan, guess), margin

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


@dataclass(frozen=True)
class Sliding(Sector):
    """The normals of the segment from C to C + e, going to its left or right."""

    leftward: bool

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

    def lines(self, t: Floats) -> tuple[Floats, Floats]:
        x, y = self.unit
        normal = np.array((-y, x) if self.leftward else (y, -x))
        return t[:, None] * (self.unit * self.size), np.broadcast_to(normal, (len(t), 2))

    def past_points(self, offsets: Floats, slack: float) -> Iterator[Guess]:
        yield 0, 0, *self._past(offsets, 0.0, slack)

    def past_circles(self, offsets: Floats, radii: Floats, slack: float) -> Iterator[Guess]:
        for turn in (1, -1):
            yield 1, turn, *self._past(offsets, turn * radii, slack)

    def _past(self, offsets: Floats, shift: Floats | float, slack: float) -> tuple[Floats, Floats]:
        along = offsets @ self.unit
        error = 4 * slack + 1e-14 * (np.abs(along) + np.abs(shift))
        return (along + shift) / self.size, error / self.size

    def exact(self, center: Vector, radius_sq: fmpq, side: int, sign: int) -> Real | None:
        _, along, _ = self._frame(center)
        square = dot(self.base, self.base)
        shift = Real(radius_sq * square).sqrt() * sign if side else 0
        value: Real = (along + shift) / Real(square)
        return value


@dataclass(frozen=True)
class Spokes(Turning):
    """The normals of an arc about C, going away from C (``outward``) or through it."""

    radius_sq: fmpq
    outward: bool

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

    def lines(self, t: Floats) -> tuple[Floats, Floats]:
        _, direction = super().lines(t)
        return direction * self._radius, direction if self.outward else -direction


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


def _slope(angle: Floats) -> Floats:
    """Parameter for a direction, taken modulo a half turn; NaN far from the base."""
    folded = np.remainder(angle + np.pi / 2, np.pi) - np.pi / 2
    return np.where(np.abs(folded) > 1.0, np.nan, np.tan(folded))


def _arc_error(ratio: Floats, error: Floats) -> Floats:
    """Error of asin or acos of a ratio that is off by about *error*."""
    capped = np.minimum(np.abs(ratio), 1.0)
    flat = np.sqrt(np.maximum(1 - capped * capped, 1e-30))
    bound: Floats = np.minimum(4 * error / flat, 4 * np.sqrt(error))
    return bound


def _rotated(vector: Floats, angle: Floats) -> Floats:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.stack((cosine * vector[0] - sine * vector[1], cosine * vector[1] + sine * vector[0]), axis=1)
