"""A path and what happened on it: pieces, and events at places of them."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field
from itertools import accumulate

from exactacq.geometry.curves import Curve
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length


@dataclass(frozen=True)
class Piece:
    """One piece of the path: ``kind`` "straight", or "boundary" along ``obstacle``.

    ``touches`` names the features that hold a straight piece (see `exactacq.visibility.line_names`): known
    from how it was found, they spare long proofs.
    """

    kind: str
    obstacle: int | None
    curve: Curve
    touches: tuple[Hashable, ...] = ()

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
        """The point at rational parameter *u* in [0, 1] of the curve."""
        return self.curve.point(u)


class Path(tuple[Piece, ...]):
    """The pieces in order, each starting where the one before ends."""

    __slots__ = ()

    def __repr__(self) -> str:
        return f"<Path of {len(self)} pieces, length {sum(float(piece.length) for piece in self):.6g}>"

    def length_after(self, count: int) -> Length:
        """Length of the first *count* pieces; linear in *count*."""
        return Length.sum(piece.length for piece in self[:count])

    def find(self, length: Length) -> tuple[int, Length]:
        """Where the path is after a length: number of whole pieces, and what is left of the length.

        ValueError if the path is shorter, or the length negative.
        """
        guesses = list(accumulate((float(piece.length) for piece in self), initial=0.0))
        slack = 1e-6 * (guesses[-1] + 1.0)
        count = max(sum(guess < float(length) - slack for guess in guesses) - 1, 0)
        rest = length - self.length_after(count)
        while count < len(self) and rest >= self[count].length:
            rest = rest - self[count].length
            count += 1
        if rest.sign() < 0 or (count == len(self) and rest.sign() > 0):
            raise ValueError(
                f"the path has no place after length {length}: it is {float(guesses[-1]):.6g} long"
            )
        return count, rest


@dataclass(frozen=True)
class Event:
    """Something that happened after the first ``after`` pieces of the path, or ``inside`` the next one.

    Kinds: start, stop; hit, leave, backtrack (the Sightseer's moves); hit, cross (an acquired obstacle blocks
    the M-line), leave, divert, return (the Seed Spreader's); sight, acquire, lose, regain (see
    `exactacq.sensing.sensor`). Events are in the order in which they happened.
    """

    kind: str
    point: Point
    obstacle: int | None
    note: str
    after: int
    path: Path = field(repr=False, compare=False)
    inside: bool = False

    @property
    def at(self) -> Length:
        """Path length so far, summed on demand."""
        whole = self.path.length_after(self.after)
        return whole + self.beyond if self.inside else whole

    @property
    def beyond(self) -> Length:
        """Length walked since the end of the last whole piece."""
        if not self.inside:
            return Length(0)
        curve = self.path[self.after].curve
        return curve.part(curve.start, self.point).length
