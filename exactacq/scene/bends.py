"""How an edge bends: rational bulges, and arcs told by their centre or by a third point.

A bulge b turns by 4 atan b, so of the arcs whose ends and centre are rational only some have a rational one:
a quarter circle has sqrt(2) - 1. Three rational points on one circle always have a rational centre, so an arc
about a rational centre holds whatever a third point tells, and all bulges too.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

from flint import fmpq

from exactacq.errors import FormatError, shown
from exactacq.geometry.geo import point_pair
from exactacq.numbers.atoms import rational_sqrt
from exactacq.numbers.rationals import rational

Pair: TypeAlias = "tuple[fmpq, fmpq]"


@dataclass(frozen=True, slots=True, init=False)
class Around:
    """An edge of an `Outline` that is an arc around a rational centre, counterclockwise or clockwise.

    Both ends are equally far from the centre; equal ends make a full circle. Raises `FormatError` for what is
    no pair of numbers.

    >>> import exactacq as xa
    >>> quarter = xa.Outline([(0, 0), (1, 0, xa.Around((0, 0))), (0, 1)])
    >>> print(xa.Scene([quarter]).obstacles[0].area)
    pi/4
    """

    center: Pair
    ccw: bool = True

    def __init__(self, center: Iterable[object], ccw: bool = True) -> None:
        if not isinstance(ccw, bool):
            raise FormatError(f"ccw is True or False, not {shown(ccw)}")
        object.__setattr__(self, "center", rational_pair(center))
        object.__setattr__(self, "ccw", ccw)

    def __neg__(self) -> Around:
        """An arc of that circle in the other sense.

        >>> -Around((0, 0))
        Around(center=(0, 0), ccw=False)
        """
        return Around(self.center, not self.ccw)


@dataclass(frozen=True, slots=True, init=False)
class Via:
    """An edge of an `Outline` that is an arc through a third point, strictly between its ends.

    A point of the chord makes the edge straight. Equal ends make a full circle, counterclockwise, of which
    the point is opposite. Raises `FormatError` for what is no pair of numbers.

    >>> import exactacq as xa
    >>> half = xa.Outline([(-1, 0), (1, 0, xa.Via((0, 1)))])
    >>> half == xa.Outline([(-1, 0), (1, 0, 1)])
    True
    """

    point: Pair

    def __init__(self, point: Iterable[object]) -> None:
        object.__setattr__(self, "point", rational_pair(point))


Bend: TypeAlias = "fmpq | Around"
"""A rational bulge, 0 for a straight edge, or an arc whose bulge is irrational."""


def bend(start: Pair, end: Pair, told: fmpq | Around | Via) -> Bend:
    """The bend of an edge between different points, its bulge if that is rational.

    Raises `FormatError` for a centre or a third point that makes no arc from start to end.
    """
    if isinstance(told, Via):
        around = center_through(start, told.point, end)
        if around is None:
            return fmpq(0)
        told = around
    if isinstance(told, Around):
        (x, y), (u, v) = ((p[0] - told.center[0], p[1] - told.center[1]) for p in (start, end))
        if x * x + y * y != u * u + v * v:
            raise FormatError("the centre is not equally far from both ends")
        slope = slope_of(start, end, told)
        root = rational_sqrt(slope * slope + 1)
        if root is not None:
            return root - slope if told.ccw else -root - slope
    return told


def center_through(start: Pair, middle: Pair, end: Pair) -> Around | None:
    """The arc through a middle point between different ends; None if that lies on the chord.

    Raises `FormatError` if it lies on the line of the ends elsewhere.
    """
    (ax, ay), (bx, by) = ((p[0] - start[0], p[1] - start[1]) for p in (middle, end))
    turn = ax * by - ay * bx
    if turn == 0:
        if 0 < ax * bx + ay * by < bx * bx + by * by:
            return None
        raise FormatError("the third point lies on the line of the ends, but not between them")
    a, b = ax * ax + ay * ay, bx * bx + by * by
    center = start[0] + (by * a - ay * b) / (2 * turn), start[1] + (ax * b - bx * a) / (2 * turn)
    return Around(center, bool(turn > 0))


def slope_of(start: Pair, end: Pair, arc: Around) -> fmpq:
    """How far the centre lies to the left of the chord, over half of the chord.

    A bulge b puts it at (1 - b^2) / (2 b), so b^2 + 2 slope b - 1 = 0: the roots are the bulges of the arc
    and of its clockwise counterpart.
    """
    dx, dy = end[0] - start[0], end[1] - start[1]
    x, y = arc.center[0] - start[0], arc.center[1] - start[1]
    return 2 * (dx * y - dy * x) / (dx * dx + dy * dy)


def opposite(start: Pair, told: fmpq | Around | Via) -> tuple[Pair, fmpq] | None:
    """The point opposite to *start* on the full circle that an edge between equal points is told to be.

    With it the bulge of both halves; None for a bulge, which tells no circle. Raises `FormatError` for a
    circle of no radius.
    """
    if isinstance(told, fmpq):
        return None
    if isinstance(told, Around):
        x, y = 2 * told.center[0] - start[0], 2 * told.center[1] - start[1]
    else:
        x, y = told.point
    if (x, y) == start:
        raise FormatError("an arc from a point to itself needs a centre, or a point opposite, elsewhere")
    return (x, y), fmpq(1 if isinstance(told, Via) or told.ccw else -1)


def rational_pair(pair: Iterable[object]) -> Pair:
    """Two rationals from any pair of numbers, or another library's Point; `FormatError` otherwise."""
    values = entries(point_pair(pair))
    if len(values) != 2:
        raise FormatError(f"a point needs two numbers, not {shown(pair)}")
    return rational(values[0]), rational(values[1])


def entries(row: Any) -> tuple[Any, ...]:
    """The entries of a row; none of what has no entries, or is a text."""
    try:
        return () if isinstance(row, str) else tuple(row)
    except TypeError:
        return ()
