"""What a family draws: obstacles, perhaps a wall about them, and the distances and places that make ties."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from flint import fmpq

from exactacq.scene.shapes import Shape

Corner = tuple[fmpq, fmpq]


class Rectangle(NamedTuple):
    """A rectangle along the axes."""

    left: fmpq
    bottom: fmpq
    right: fmpq
    top: fmpq

    def wider(self, margin: fmpq | int) -> Rectangle:
        """The rectangle that is wider by a margin on every side."""
        return Rectangle(self.left - margin, self.bottom - margin, self.right + margin, self.top + margin)

    def united(self, other: Rectangle | None) -> Rectangle:
        """The least rectangle about both, if there is another."""
        if other is None:
            return self
        west, south = min(self.left, other.left), min(self.bottom, other.bottom)
        return Rectangle(west, south, max(self.right, other.right), max(self.top, other.top))

    @property
    def middle(self) -> Corner:
        """The centre."""
        return (self.left + self.right) / 2, (self.bottom + self.top) / 2


class Plan(NamedTuple):
    """A drawing without a robot.

    ``box`` bounds the obstacles. ``gap`` is a distance of neighbours, ``pitch`` that from one to the next of
    the same kind; a radius may equal either. ``bite`` is so small that a terrain whose border is so far
    within ``box`` still meets every obstacle. ``places`` are where ties are: on axes of symmetry, on lines
    of a grid, equally far from several obstacles; some may not be free.
    """

    shapes: Sequence[Shape]
    wall: Shape | None
    box: Rectangle
    gap: fmpq
    pitch: fmpq
    bite: fmpq
    places: Sequence[Corner]
