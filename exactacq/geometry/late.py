"""Late points: known by balls until more is asked of them, and made then, once for all of their numbers.

Order, range and clipping are decided by the balls nearly always, and most points are asked for nothing else.
A late point is a `Point` like any other: its coordinates, and parameters that are read off it, share one
maker. What a maker holds lives as long as the point is not made, so it should hold little. Reading
``rational``, `float`, ``xy`` or arithmetic makes the point; `compare`, ``clear_sign``, ``rough`` and
``ball(64)`` do so only where the ball leaves them open.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any, TypeAlias, TypeVarTuple

from flint import arb, fmpq

from exactacq.geometry.points import Point
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real

ANYWHERE = arb(0, inf)
"""A ball around every number."""
BITS = 64
"""Working bits of the balls that decide before anything is made."""

Balls: TypeAlias = "tuple[arb, arb]"
"""Balls around two coordinates."""
Pin: TypeAlias = "tuple[Point, Real]"
"""A point of a curve with its parameter there."""
Given = TypeVarTuple("Given")


class _Once:
    """A point that is made when one of its coordinates is first asked for."""

    __slots__ = ("_make", "_point")
    _point: Point

    def __init__(self, make: Callable[..., Point], given: tuple[Any, ...]) -> None:
        # One object and not two: there are many of them.
        self._make: tuple[Any, ...] | None = (make, *given)

    def _made(self) -> Point:
        if self._make is not None:
            self._point, self._make = self._make[0](*self._make[1:]), None
        return self._point

    def x(self) -> Real:
        return self._made().x

    def y(self) -> Real:
        return self._made().y


def late_point(around: Balls, make: Callable[[*Given], Point], *given: *Given) -> Point:
    """The point that *make* makes of what is *given*, whose coordinates lie in two balls.

    *make* is called at most once. Where a ball is not finite it is called at once.

    >>> corner = late_point((arb(3, 1e-9), arb(1.4, 0.1)), lambda: Point(3, Real(2).sqrt()))
    >>> corner.x > 2, corner.y.is_late
    (True, True)
    >>> print(corner.y, corner.x)
    sqrt(2) 3
    """
    x, y = around
    if not (x.is_finite() and y.is_finite()):
        return make(*given)
    once = _Once(make, given)
    return Point(Real.late(x, _Once.x, once), Real.late(y, _Once.y, once))


def unmade_point(make: Callable[[*Given], Point], *given: *Given) -> Point:
    """The point that *make* makes of what is *given* once anything of it is asked for: no ball is known."""
    once = _Once(make, given)
    return Point(Real.late(ANYWHERE, _Once.x, once), Real.late(ANYWHERE, _Once.y, once))


def balls(point: Point) -> Balls:
    """Balls around the coordinates of a point; they are kept with its numbers."""
    return point.x.ball(BITS), point.y.ball(BITS)


def ball_of(value: fmpq | Real) -> arb:
    """A ball around a number as `coordinates.raw` unpacks it."""
    return value.ball(BITS) if isinstance(value, Real) else arb(value)


def from_to(start: Balls, end: Balls) -> Balls:
    """Balls around the vector between two points."""
    return end[0] - start[0], end[1] - start[1]


def may_be_one(one: Balls, other: Balls) -> bool:
    """Whether two points may be one; balls that are not finite leave it open."""
    apart = (a.is_finite() and b.is_finite() and not a.overlaps(b) for a, b in zip(one, other, strict=True))
    return not any(apart)


def clearly_between(start: Balls, end: Balls, direction: Balls) -> bool | None:
    """Whether a direction lies counterclockwise between two others; None if balls leave that open.

    Whether it is a half turn from the first to the second, or less, or more, may be open: a direction on the
    same side of both is told all the same.
    """
    (ax, ay), (bx, by), (u, v) = start, end, direction
    turn, after, before = (ball_sign(c) for c in (ax * by - ay * bx, ax * v - ay * u, u * by - v * bx))
    if not (after and before):
        return None
    if after == before:
        return after > 0
    return turn < 0 if turn else None
