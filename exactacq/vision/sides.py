"""On which side of all lines of a beam a place lies: floats with proven margins, many beams at once.

A single line is a beam whose first and last line are one.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

import numpy as np

from exactacq.points import Point
from exactacq.reals import Real
from exactacq.vision.sectors import Sector, Sliding
from exactacq.vision.table import Floats, Ints


class Sides:
    """Float images of beams, each a sector with a least and a greatest parameter."""

    def __init__(self, beams: Sequence[tuple[Sector, Real, Real]]) -> None:
        table = np.array([_image(*beam) for beam in beams], dtype=float).reshape(-1, 8)
        self._table = table

    def __len__(self) -> int:
        return len(self._table)

    @classmethod
    def of_lines(cls, lines: Sequence[tuple[Point, Point]]) -> Sides:
        """The lines from one point through another."""
        whole = cls([])
        if lines:
            start, end = (np.array([rough(line[k]) for line in lines]) for k in (0, 1))
            angle = np.arctan2(*(end - start).T[::-1])
            nothing = np.zeros(len(lines))
            whole._table = np.stack((*start.T, angle, angle, *[nothing] * 4), axis=1)
        return whole

    @classmethod
    def joined(cls, parts: Sequence[Sides]) -> Sides:
        """All beams of several."""
        whole = cls([])
        if parts:
            whole._table = np.concatenate([part._table for part in parts])
        return whole

    def of(self, x: float, y: float, slack: float) -> Ints:
        """1 or -1 for each beam if the place is certainly to the left or right of all its lines, else 0."""
        low, high = self.distances(x, y)
        margin = slack + 1e-9 * (np.abs(low) + np.abs(high))
        return np.where(low > margin, 1, np.where(high < -margin, -1, 0))

    def distances(self, x: float, y: float) -> tuple[Floats, Floats]:
        """Bounds, up to round-off, of the distances of a place from each beam's lines, positive to the left.

        Lines that turn have a direction between two angles, a rolling contact lifts them by its radius. A
        normal that goes left leaves what lies farther along its segment to its right.
        """
        ox, oy, first, last, lift, turn, ux, uy = self._table.T
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
    """A point in floats; never a proof, however deep its numbers are."""
    return float(point.x.ball(64).mid()), float(point.y.ball(64).mid())


def _image(sector: Sector, low: Real, high: Real) -> tuple[float, ...]:
    """Origin; directions or places of first and last line; lift; sense of normals, else 0; base vector."""
    first, last = (float(t.ball(64).mid()) for t in (low, high))
    ux, uy = sector.unit
    if isinstance(sector, Sliding):
        turn = 1.0 if sector.leftward else -1.0
        return (*sector.origin, first * sector.size, last * sector.size, 0.0, turn, ux, uy)
    angle, half = np.arctan2(uy, ux) + (pi / 2 if sector.round else 0.0), 2 if sector.round else 1
    ends = angle + half * np.arctan(first), angle + half * np.arctan(last)
    return (*sector.origin, *ends, sector.size if sector.round else 0.0, 0.0, ux, uy)


def _sines(low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Least and greatest sine of the angles between two, less than a full turn apart."""
    one, other = np.sin(low), np.sin(high)
    peak = low + np.remainder(pi / 2 - low, 2 * pi) <= high
    trough = low + np.remainder(-pi / 2 - low, 2 * pi) <= high
    return np.where(trough, -1.0, np.minimum(one, other)), np.where(peak, 1.0, np.maximum(one, other))
