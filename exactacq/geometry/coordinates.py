"""Arithmetic on unpacked coordinates: fmpq where a coordinate is rational, `Real` where it is not.

The same formula then serves both, and rational data never pay for the objects that algebraic numbers need.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from flint import fmpq

from exactacq.geometry.points import Point
from exactacq.numbers.atoms import square_free
from exactacq.numbers.rationals import rational_sign
from exactacq.numbers.real import Real

Vector: TypeAlias = "tuple[Any, Any]"
"""Coordinates, each an fmpq if the Real is rational and the Real itself otherwise."""


def raw(point: Point) -> Vector:
    """Unpacked coordinates."""
    x, y = point.x.rational, point.y.rational
    return point.x if x is None else x, point.y if y is None else y


def sign(value: Any) -> int:
    """-1, 0 or 1, exactly."""
    return value.sign() if isinstance(value, Real) else rational_sign(value)


def minus(a: Vector, b: Vector) -> Vector:
    """The vector from b to a."""
    return a[0] - b[0], a[1] - b[1]


def cross(a: Vector, b: Vector) -> Any:
    """z of the vector product: positive if b lies counterclockwise of a."""
    return a[0] * b[1] - a[1] * b[0]


def dot(a: Vector, b: Vector) -> Any:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1]


def advance(origin: Vector, direction: Vector, parameter: Any) -> Point:
    """origin + parameter * direction."""
    (x, y), (dx, dy) = origin, direction
    if type(x) is type(y) is type(dx) is type(dy) is fmpq and isinstance(parameter, Real):
        return Point(parameter.affine(dx, x), parameter.affine(dy, y))
    return Point(origin[0] + direction[0] * parameter, origin[1] + direction[1] * parameter)


def at_distance(origin: Vector, direction: Vector, distance: fmpq) -> Point:
    """The point at a rational distance from another one in a direction, not 0.

    >>> print(at_distance((fmpq(0), fmpq(1)), (fmpq(-1, 3), fmpq(-2, 3)), fmpq(5)))
    (-sqrt(5), 1 - 2*sqrt(5))
    """
    u, v = direction
    if not (type(origin[0]) is type(origin[1]) is type(u) is type(v) is fmpq and u and v):
        return advance(origin, direction, square_root(distance * distance / dot(direction, direction)))
    # Without common factors of the direction the number under the root is smaller, and an integer.
    slope = u / v
    a, b = int(slope.p), int(slope.q)
    if v < 0:
        a, b = -a, -b
    side, radicand = square_free(a * a + b * b)
    root, share = Real.of_atom(radicand), distance / (side * radicand)
    return Point(root.affine(share * a, origin[0]), root.affine(share * b, origin[1]))


def ratio(vector: Vector, direction: Vector) -> Any:
    """l with vector = l * direction, for parallel vectors, the direction not 0."""
    axis = 0 if sign(direction[0]) else 1
    return vector[axis] / direction[axis]


def compare(a: Vector, b: Vector) -> int:
    """Lexicographic order: x, then y."""
    return sign(a[0] - b[0]) or sign(a[1] - b[1])


def same_direction(a: Vector, b: Vector) -> bool:
    """Whether two vectors, not 0, point the same way."""
    return sign(cross(a, b)) == 0 and sign(dot(a, b)) > 0


def between(start: Vector, end: Vector, direction: Vector, strict: bool) -> bool:
    """Whether a direction lies counterclockwise between start and end; these count unless strict."""
    turn, after, before = (sign(cross(*p)) for p in ((start, end), (start, direction), (direction, end)))
    least = 1 if strict else 0
    if turn > 0:
        return after >= least and before >= least
    if turn < 0:
        return after >= least or before >= least
    return after >= least


def square_root(square: Any) -> Real:
    """The non-negative square root."""
    return Real(square).sqrt()
