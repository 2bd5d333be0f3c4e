"""Curves in absolute coordinates, as the float images of whole families and of ways need them."""

from __future__ import annotations

from typing import final


@final
class CurveImage:
    """A boundary edge, or a straight way, in floats: each the nearest one, off by 2^-53 of itself.

    Of a segment: its start (x, y) and the vector (wx, wy) to its end. Of an arc: its centre (x, y), the
    vector (wx, wy) from there to its start, its radius, and its sense: 1 if it runs counterclockwise, else
    -1. The sense of a segment is 0.
    """

    def __init__(
        self, x: float, y: float, wx: float, wy: float, radius: float, sense: int, full: bool
    ) -> None:
        self.x, self.y, self.wx, self.wy = x, y, wx, wy
        self.radius, self.sense, self.full = radius, sense, full
