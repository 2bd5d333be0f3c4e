"""A path: straight pieces, and pieces of boundaries."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from math import ceil, pi
from typing import Any

import numpy as np

from exactacq.cached import cached_property
from exactacq.geometry.curves import Curve
from exactacq.geometry.geo import Geo, corners, line_string
from exactacq.geometry.points import Point
from exactacq.geometry.strokes import Floats, Stroke
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.length import Length

MOST_WAYPOINTS = 10_000_000
"""Most places at a spacing: an array of 320 MB."""
ROUNDOFF = 1e-12
"""Share of a length by which floats may be off: within it a place is at a corner, or at the path's end."""


@dataclass(frozen=True)
class Piece:
    """One piece of the path: ``kind`` is "straight", or "boundary" along an edge of ``obstacle``.

    >>> import exactacq as xa
    >>> piece = xa.sightseer(xa.load("circles")).path[1]
    >>> print(piece.kind, piece.obstacle, piece.start, piece.length)
    boundary 0 (3, 0) 4*pi
    """

    kind: str
    obstacle: int | None
    curve: Curve

    @property
    def start(self) -> Point:
        """Where the piece begins."""
        return self.curve.start

    @property
    def end(self) -> Point:
        """Where the piece ends."""
        return self.curve.end

    @property
    def length(self) -> Length:
        """Exact length."""
        return self.curve.length

    def point(self, u: object) -> Point:
        """The point at rational parameter *u* in [0, 1] of the curve (see `Segment.point`, `Arc.point`)."""
        return self.curve.point(u)


class Path(tuple[Piece, ...]):
    """The pieces of a run's path in order, each starting where the one before ends.

    Boundary walks are divided at corners, so each piece is one `Segment` or one `Arc`. A path remembers the
    length up to the last place that was asked for, so asking for places in their order adds every piece once.
    (Lengths kept for all places would hold every radical of the path as often as there are places after it.)

    >>> import exactacq as xa
    >>> [str(piece.length) for piece in xa.sightseer(xa.load("circles")).path]
    ['3', '4*pi', '2*pi', '2', '6*pi']
    """

    def __repr__(self) -> str:
        return f"<Path of {len(self)} pieces, length {self._ends[-1]:.6g}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Path, (tuple(self),)

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON LineString along all pieces, arcs as chords (`geometry.geo.FLATNESS`).

        A Point if the path never leaves its start; without coordinates if it has no pieces.
        """
        return line_string(piece.curve.stroke() for piece in self)

    def to_numpy(self) -> Floats:
        """The path as corners: an array of floats of shape (n, 2), columns x and y in the scene's unit.

        Arcs become chords that stray by at most 10^-4 of the radius (`exactacq.geometry.geo.FLATNESS`); a
        place that repeats stands once. Shape (0, 2) for a path without pieces. Linear in the corners.

        >>> import exactacq as xa
        >>> xa.sightseer(xa.load("squares")).path.to_numpy()[:3].tolist()
        [[0.0, 0.0], [2.0, 0.0], [2.0, -1.0]]
        """
        return np.array(corners(piece.curve.stroke() for piece in self), dtype=float).reshape(-1, 2)

    def waypoints(self, spacing: object) -> Floats:
        """Places at equal distances along the path: an array of floats of shape (n, 4).

        The columns are x, y, the direction of travel there as an angle in (-pi, pi], counterclockwise from
        the x axis, and the length of the path so far; the first three as poses of a robot have them. The
        first place is the start, the last one the end, which may be nearer to the one before than *spacing*,
        a positive number in the scene's unit. At a corner the direction is that of the piece that begins.
        Shape (0, 4) for a path without pieces; one row for a path without length. ValueError for a spacing
        that is not positive or makes more than `MOST_WAYPOINTS`. Linear in pieces and places.

        >>> import exactacq as xa
        >>> path = xa.sightseer(xa.load("squares")).path
        >>> path.waypoints(10).round(3).tolist()
        [[0.0, 0.0, 0.0, 0.0], [2.0, 0.0, -1.571, 10.0], [9.0, 1.0, 3.142, 20.0], [7.0, -1.0, -1.571, 24.0]]
        """
        step = float(Length(spacing))
        total = self._ends[-1]
        if not (step > 0 and total / step < MOST_WAYPOINTS):
            raise ValueError(
                f"a spacing is positive and makes at most {MOST_WAYPOINTS} places, not {spacing}"
            )
        if not self:
            return np.empty((0, 4))
        strokes = [piece.curve.stroke() for piece in self]
        count = ceil(total / step * (1 - ROUNDOFF))
        return np.array([self._pose(strokes, at) for at in (*(k * step for k in range(count)), total)])

    def _pose(self, strokes: Sequence[Stroke], at: float) -> tuple[float, float, float, float]:
        """Place, direction and length so far, after about a length."""
        k = bisect_right(self._ends, at * (1 + ROUNDOFF)) - 1
        while k and (k >= len(strokes) or not strokes[k].length):
            k -= 1
        stroke = strokes[k]
        share = min(max((at - self._ends[k]) / stroke.length, 0.0), 1.0) if stroke.length else 0.0
        return (*stroke.at(share), _turned(stroke.heading(share)), at)

    def length_after(self, count: int) -> Length:
        """Length of the first *count* pieces. Cost: linear in the pieces since the last place asked for.

        >>> import exactacq as xa
        >>> print(xa.sightseer(xa.load("circles")).path.length_after(2))
        3 + 4*pi
        """
        first, done = self._measured if self._measured[0] <= count else (0, Length(0))
        length = Length.sum((done, *(piece.length for piece in self[first:count])))
        self._measured = count, length
        return length

    _measured = 0, Length(0)
    """A number of pieces, and their length."""

    @cached_property
    def _ends(self) -> list[float]:
        """About the length after each number of pieces."""
        return list(accumulate((float(piece.length) for piece in self), initial=0.0))

    def find(self, length: Length) -> tuple[int, Length]:
        """Where the path is after a length: number of whole pieces, and what is left of the length.

        ValueError if the path is shorter, or the length negative. Linear in the number of pieces.

        >>> import exactacq as xa
        >>> xa.sightseer(xa.load("circles")).path.find(xa.Length(4))
        (1, Length('1'))
        """
        slack = margin(1e-6 * (self._ends[-1] + 1.0))
        count = max(bisect_left(self._ends, float(length) - slack) - 1, 0)
        rest = length - self.length_after(count)
        while count < len(self) and rest >= self[count].length:
            rest = rest - self[count].length
            count += 1
        if rest.sign() < 0 or (count == len(self) and rest.sign() > 0):
            whole, told = self._ends[-1], length.decimal(6)
            raise ValueError(f"the path has no place after length {told}: it is {whole:.6g} long")
        return count, rest


def _turned(angle: float) -> float:
    """A direction as an angle in (-pi, pi]."""
    turned = angle - 2 * pi * ceil((angle - pi) / (2 * pi))
    return pi if turned <= -pi else turned
