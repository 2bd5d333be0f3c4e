"""The range of the sensor: the radius of vision, squared, and as floats on either side of it."""

from __future__ import annotations

from flint import arb, fmpq

from exactacq.geometry.points import Point, distance_sq

BITS = 64
"""Precision of the balls that tell most distances from the radius."""


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
            x, y = a.x.ball(BITS) - b.x.ball(BITS), a.y.ball(BITS) - b.y.ball(BITS)
            excess = x * x + y * y - arb(self.square)
            if excess > 0 or excess < 0:
                return 1 if excess > 0 else -1
        return distance_sq(a, b).compare(self.square)
