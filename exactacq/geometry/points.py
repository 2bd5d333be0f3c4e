"""Points and vectors with exact coordinates, and the orientation predicate."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import Any

import numpy as np
from flint import fmpq
from numpy.typing import NDArray

from exactacq.errors import FormatError, shown
from exactacq.geometry.geo import Geo, point_pair
from exactacq.geometry.geo import point as geo_point
from exactacq.numbers.real import Real, real


class Orientation(IntEnum):
    """Which way three points turn."""

    CLOCKWISE = -1
    COLLINEAR = 0
    COUNTERCLOCKWISE = 1


class Location(IntEnum):
    """Where a point lies with respect to a closed region."""

    OUTSIDE = -1
    BOUNDARY = 0
    INSIDE = 1


class Point:
    """A point, or a vector, of the plane with exact coordinates ``x`` and ``y``, both `Real`.

    A coordinate is anything that `Real` accepts. Vectors are added, subtracted and scaled by numbers.
    Equality is exact and may raise `Undecided`. Points with rational coordinates are hashable, others not.

    >>> Point(1, "1/2") + 2 * Point(0, "0.25")
    Point(1, 1)
    """

    __slots__ = ("_facts", "_xy", "x", "y")
    _xy: tuple[float, float]
    _facts: tuple[Any, ...]  # see `exactacq.geometry.constructions`

    def __init__(self, x: object, y: object) -> None:
        self.x = x if isinstance(x, Real) else real(x) if type(x) is fmpq else Real(x)
        self.y = y if isinstance(y, Real) else real(y) if type(y) is fmpq else Real(y)

    def __reduce__(self) -> tuple[type[Point], tuple[Real, Real]]:
        # How it was made is known of this object alone; the places before it would follow, one by one.
        return Point, (self.x, self.y)

    @classmethod
    def of(cls, value: Point | Sequence[object]) -> Point:
        """A point from a Point or a pair of numbers; `FormatError` for anything else.

        >>> Point.of(("1/2", 3))
        Point(1/2, 3)
        """
        if isinstance(value, Point):
            return value
        try:
            x, y = point_pair(None if isinstance(value, str | bytes | bytearray) else value)
        except (TypeError, ValueError):
            raise FormatError(f"a point needs two numbers, not {shown(value)}") from None
        return cls(x, y)

    @property
    def rational(self) -> tuple[fmpq, fmpq] | None:
        """Both coordinates as rationals, or None."""
        x, y = self.x.rational, self.y.rational
        return None if x is None or y is None else (x, y)

    @property
    def is_late(self) -> bool:
        """Whether a coordinate is only a ball so far (see `Real.late`)."""
        return self.x.is_late or self.y.is_late

    @property
    def xy(self) -> tuple[float, float]:
        """The nearest floats: for drawing and pruning only."""
        try:
            return self._xy
        except AttributeError:
            self._xy = float(self.x), float(self.y)
            return self._xy

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON Point, in floats."""
        return geo_point(self.xy)

    @property
    def key(self) -> tuple[object, object]:
        """Structural identity: equal keys are equal points."""
        return self.x.key, self.y.key

    def __add__(self, other: Point) -> Point:
        return Point(self.x + other.x, self.y + other.y)

    def __sub__(self, other: Point) -> Point:
        return Point(self.x - other.x, self.y - other.y)

    def __mul__(self, factor: object) -> Point:
        return Point(self.x * factor, self.y * factor)

    __rmul__ = __mul__

    def __truediv__(self, divisor: object) -> Point:
        return Point(self.x / divisor, self.y / divisor)

    def __neg__(self) -> Point:
        return Point(-self.x, -self.y)

    def dot(self, other: Point) -> Real:
        """Scalar product with another vector.

        >>> Point(1, 2).dot(Point(3, 4))
        Real('11')
        """
        a, b, c, d = self.x.rational, self.y.rational, other.x.rational, other.y.rational
        if a is None or b is None or c is None or d is None:
            return self.x * other.x + self.y * other.y
        return real(a * c + b * d)

    def cross(self, other: Point) -> Real:
        """The z coordinate of the vector product: positive if *other* lies counterclockwise of self.

        >>> Point(1, 0).cross(Point(0, 2))
        Real('2')
        """
        a, b, c, d = self.x.rational, self.y.rational, other.x.rational, other.y.rational
        if a is None or b is None or c is None or d is None:
            return self.x * other.y - self.y * other.x
        return real(a * d - b * c)

    def norm_sq(self) -> Real:
        """Squared length of the vector.

        >>> Point(3, 4).norm_sq()
        Real('25')
        """
        x, y = self.x.rational, self.y.rational
        if x is None or y is None:
            return self.x * self.x + self.y * self.y
        return real(x * x + y * y)

    def left(self) -> Point:
        """The vector turned counterclockwise by a quarter of a full turn.

        >>> Point(1, 2).left()
        Point(-2, 1)
        """
        return Point(-self.y, self.x)

    def compare(self, other: Point) -> int:
        """-1, 0 or 1 as self comes before, equals or comes after *other* in the order by x, then by y.

        >>> Point(1, 2).compare(Point(1, 3))
        -1
        """
        return self.x.compare(other.x) or self.y.compare(other.y)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Point):
            return NotImplemented
        if self is other:
            return True
        if self.is_late or other.is_late or self.x.rational is None or other.x.rational is None:
            # Ordinates that clearly differ spare the proof that abscissas are equal.
            a, b = self.y.ball(64), other.y.ball(64)
            if a < b or a > b:
                return False
        return self.compare(other) == 0

    def __hash__(self) -> int:
        """That of the coordinates; TypeError if one is irrational: equal ones may have different forms."""
        return hash((self.x, self.y))

    def __iter__(self):  # type: ignore[no-untyped-def]
        return iter((self.x, self.y))

    def __str__(self) -> str:
        return f"({self.x}, {self.y})"

    def __repr__(self) -> str:
        return f"Point({self.x}, {self.y})"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """The nearest floats as an array of two."""
        return np.array(self.xy, dtype=dtype)


def orientation(a: Point, b: Point, c: Point) -> Orientation:
    """The turn of a -> b -> c."""
    return Orientation((b - a).cross(c - a).sign())


def distance_sq(a: Point, b: Point) -> Real:
    """Squared distance."""
    return (a - b).norm_sq()


def distance(a: Point, b: Point) -> Real:
    """Euclidean distance; without a nested root where the direction is seen to be rational."""
    across, up = b.x - a.x, b.y - a.y
    slope = across.rational_ratio(up)
    if slope is not None:
        return abs(up) * Real(1 + slope * slope).sqrt()
    return (across * across + up * up).sqrt()
