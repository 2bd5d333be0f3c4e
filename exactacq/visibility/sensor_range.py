"""The range of the sensor: the radius of vision, squared, and as floats on either side of it."""

from __future__ import annotations

from flint import arb, fmpq

from exactacq.geometry.constructions import is_put_around
from exactacq.geometry.late import Balls, balls
from exactacq.geometry.points import Point, distance_sq
from exactacq.numbers.rationals import ball_sign


class Range:
    """How far the sensor sees: up to a *radius*, positive and rational, and at that distance too.

    ``square`` is its square; ``above`` and ``below`` are floats that bound it, to prune with.
    """

    __slots__ = ("above", "below", "radius", "square")

    def __init__(self, radius: fmpq) -> None:
        self.radius, self.square = radius, radius * radius
        self.above, self.below = float(radius) * (1 + 1e-12), float(radius) * (1 - 1e-12)

    def order(self, a: Point, b: Point) -> int:
        """-1, 0 or 1 as two points are closer than the radius, at its distance, or farther."""
        if a.is_late or b.is_late or a.rational is None or b.rational is None:
            clear = self.clear_order(balls(a), balls(b))
            if clear:
                return clear
            if is_put_around(a, b, self.square):
                return 0
        return distance_sq(a, b).compare(self.square)

    def clear_order(self, a: Balls, b: Balls) -> int:
        """-1, 0 or 1 as `order` says of two points in balls; 0 also where these leave it open."""
        x, y = a[0] - b[0], a[1] - b[1]
        return ball_sign(x * x + y * y - arb(self.square))
