"""Places on a curve that are known by balls until more than the balls is asked for."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TypeAlias

from flint import arb

from exactacq.geometry.points import Point
from exactacq.numbers.real import Real

Pin: TypeAlias = "tuple[Point, Real]"
"""A point of a curve with its parameter there."""


class _Maker:
    """Makes a pin once, for whichever of its three numbers is asked for first."""

    __slots__ = ("_make", "_pin")

    def __init__(self, make: Callable[[], Pin]) -> None:
        self._make: Callable[[], Pin] | None = make
        self._pin: Pin

    def part(self, k: int) -> Real:
        if self._make is not None:
            self._pin = self._make()
            self._make = None
        point, u = self._pin
        return point.x if k == 0 else point.y if k == 1 else u


def late_pin(balls: tuple[arb, arb, arb], make: Callable[[], Pin]) -> Pin:
    """The pin that *make* gives, whose coordinates and parameter lie in *balls* (see `Real.late`).

    >>> point, u = late_pin((arb(1), arb(0), arb(0.5)), lambda: (Point(1, 0), Real("1/2")))
    >>> u < 1, point.is_late, print(point)
    (1, 0)
    (True, True, None)
    """
    maker = _Maker(make)
    x, y, u = (Real.late(ball, partial(maker.part, k)) for k, ball in enumerate(balls))
    return Point(x, y), u
