"""A path: straight pieces, and pieces of boundaries."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import Any

from exactacq.geometry.curves import Curve
from exactacq.geometry.geo import Geo, line_string
from exactacq.geometry.points import Point
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.length import Length


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
            raise ValueError(f"the path has no place after length {length}: it is {self._ends[-1]:.6g} long")
        return count, rest
