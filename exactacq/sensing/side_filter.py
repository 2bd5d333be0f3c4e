"""On which side of all lines of a family a place lies: floats with proven margins, many families at once.

A single line is a family whose first and last line coincide.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan, atan2, hypot, inf, pi

import numpy as np

from exactacq.geometry.box_index import TINY
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import Floats, Ints
from exactacq.visibility.line_families import Sector, Sliding

ERROR = 2.0**-45
"""Bounds the error of a distance, as a part of what it comes from: the coordinates of the place and of the
line family's origin, added up, and the line family's extent.

Let e = 2^-53. Coordinates are off by 4 e of themselves, parameters (at most 1) and directions of base vectors
by 4 e, functions by 4 units in the last place, that is 8 e. So the directions of lines, below 8, are off by
60 e, the angles between them and the direction of the place, below 16, by 95 e, and their sines by 103 e.
Times its distance from the origin, no more than the coordinates, and with what these are off themselves, that
is 120 e of the coordinates; lifts and places on segments are off by 16 e of the extent. Less than 2^-46 in
all; doubled.
"""


class Sides:
    """Float images of line families, each a sector with a least and a greatest parameter."""

    def __init__(self, line_families: Sequence[tuple[Sector, Real, Real]]) -> None:
        self._table = _table([_image(*line_family) for line_family in line_families])

    def __len__(self) -> int:
        return len(self._table)

    @classmethod
    def of_lines(cls, lines: Sequence[tuple[Point, Point]]) -> Sides:
        """The lines from one point through another."""
        whole = cls([])
        whole._table = _table([_line(*line) for line in lines])
        return whole

    @classmethod
    def joined(cls, parts: Sequence[Sides]) -> Sides:
        """All line families of several."""
        whole = cls([])
        if parts:
            whole._table = np.concatenate([part._table for part in parts])
        return whole

    def of(self, x: float, y: float, slack: float) -> Ints:
        """For each line family 1 or -1 if the place is certainly left or right of all its lines, else 0.

        The place may be off by *slack*, besides the error of `rough`.
        """
        low, high = self.distances(x, y)
        margin = self._table[:, -1] + (slack + ERROR * (abs(x) + abs(y)))
        return np.where(low > margin, 1, np.where(high < -margin, -1, 0))

    def distances(self, x: float, y: float) -> tuple[Floats, Floats]:
        """Bounds, up to round-off, of a place's distances from each family's lines, positive to the left.

        Lines that turn have a direction between two angles, a rolling contact lifts them by its radius. A
        normal that goes left leaves what lies farther along its segment to its right. All normals of an arc
        are taken as going outward.
        """
        ox, oy, first, last, lift, turn, ux, uy, _ = self._table.T
        wx, wy = x - ox, y - oy
        along = wx * ux + wy * uy
        ends = turn * (first - along), turn * (last - along)
        away, size = np.arctan2(wy, wx), np.hypot(wx, wy)
        least, most = _sines(away - last, away - first)
        slides = turn != 0
        low = np.where(slides, np.minimum(*ends), size * least + lift)
        high = np.where(slides, np.maximum(*ends), size * most + lift)
        return low, high


def rough(point: Point) -> tuple[float, float]:
    """A point in floats: each coordinate off by at most 2^-51 of itself, or of `TINY`, however deep it is."""
    return _float(point.x, TINY), _float(point.y, TINY)


def _bound(t: Real, side: int) -> float:
    """A parameter as a float; that of a late one to the outside: a few more lines do no harm."""
    if not t.is_late:
        return _float(t, 1.0)
    ball = t.ball(64)
    return float(ball.mid()) + side * float(ball.rad())


def _float(value: Real, least: float) -> float:
    """A float that is off by at most 2^-51 of the number, or of *least* if that is more."""
    bits = 64
    while True:
        ball = value.ball(bits)
        middle = float(ball.mid())
        if float(ball.rad()) <= 2.0**-52 * max(abs(middle), least):
            return middle
        bits *= 2


def _table(rows: list[tuple[float, ...]]) -> Floats:
    return np.array(rows, dtype=float).reshape(-1, 9)


def _image(sector: Sector, low: Real, high: Real) -> tuple[float, ...]:
    """Origin; directions or places of first and last line; lift; sense of normals, else 0; base; error."""
    first, last = _bound(low, -1), _bound(high, 1)
    (ox, oy), (ux, uy), size = sector.origin, sector.unit, sector.size
    error = _error(ox, oy, sector.extent, size)
    if isinstance(sector, Sliding):
        turn = 1.0 if sector.leftward else -1.0
        return ox, oy, first * size, last * size, 0.0, turn, ux, uy, error
    angle, half = atan2(uy, ux) + (pi / 2 if sector.round else 0.0), 2 if sector.round else 1
    ends = angle + half * atan(first), angle + half * atan(last)
    return ox, oy, *ends, size if sector.round else 0.0, 0.0, ux, uy, error


def _line(start: Point, end: Point) -> tuple[float, ...]:
    """The row of `_image` for the line through two points.

    The points are subtracted exactly and then rounded: the difference of their floats could be 0.
    """
    (ox, oy), (dx, dy) = rough(start), rough(end - start)
    angle = atan2(dy, dx)
    return ox, oy, angle, angle, 0.0, 0.0, 0.0, 0.0, _error(ox, oy, 0.0, hypot(dx, dy))


def _error(ox: float, oy: float, extent: float, size: float) -> float:
    """The part of the margin that belongs to a family; infinite where underflow may spoil the base vector."""
    return TINY + ERROR * (abs(ox) + abs(oy) + extent) if size > TINY else inf


def _sines(low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Least and greatest sine of the angles between two, less than a full turn apart."""
    one, other = np.sin(low), np.sin(high)
    peak = low + np.remainder(pi / 2 - low, 2 * pi) <= high
    trough = low + np.remainder(-pi / 2 - low, 2 * pi) <= high
    return np.where(trough, -1.0, np.minimum(one, other)), np.where(peak, 1.0, np.maximum(one, other))
