"""Chains of edges on their way from a drawing to loops, with a proven bound of how far each point moved.

An edge from p to q with bulge b is the image of w_b under z -> p + (q - p) z, where w_b runs from 0 to 1 on
the arc of bulge b. Parametrised as w_b(s) = s / (s + (1 - s) k) with k = exp(2 i atan b), it satisfies

    |w_b|, |1 - w_b| <= W(b) = 1 for |b| <= 1, else (1 + b^2) / (2 |b|)    (the diameter over the chord)
    |d w_b / d b| <= 1/2                                                   (attained at s = 1/2, the apex)

so moving the ends by d_p and d_q and the bulge by d_b moves no point of the edge by more than
W(b) (d_p + d_q) + |q - p| |d_b| / 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from flint import fmpq

from exactacq.scene.bends import Around, Bend
from exactacq.scene.shapes import Outline, Polygon, Shape

ZERO = fmpq(0)


@dataclass(slots=True)
class Corner:
    """A vertex and the bulge of the edge that follows; the shifts bound how far both are from the file's.

    An arc of irrational bulge has its centre beside a bulge near it: exact as long as its ends do not move.
    """

    x: fmpq
    y: fmpq
    bulge: fmpq
    shift: fmpq = ZERO
    bulge_shift: fmpq = ZERO
    center: tuple[fmpq, fmpq] | None = None

    def move_to(self, other: Corner) -> fmpq:
        """Copy another corner's place; an upper bound of the distance moved."""
        moved = distance_above(self, other)
        self.x, self.y = other.x, other.y
        self.shift += moved
        return moved


@dataclass(slots=True)
class Chain:
    """Consecutive edges; the last corner's edge closes the chain if ``closed``, else there is none.

    ``order`` is the place of its entity in the file. ``stated``: the corners are numbers of the file, not
    computed like the ends of an ARC; joints prefer those.
    """

    label: str
    corners: list[Corner]
    order: int = 0
    closed: bool = False
    stated: bool = True

    @property
    def edges(self) -> int:
        """Number of edges."""
        return len(self.corners) - (not self.closed)

    def backwards(self) -> list[Corner]:
        """The corners of the open chain walked the other way."""
        turned = []
        for i in range(len(self.corners) - 1, -1, -1):
            here, before = self.corners[i], self.corners[i - 1] if i else None
            bulge, bulge_shift = (-before.bulge, before.bulge_shift) if before else (fmpq(0), fmpq(0))
            center = before.center if before else None
            turned.append(Corner(here.x, here.y, bulge, here.shift, bulge_shift, center))
        return turned

    def shape(self) -> Shape:
        """The closed chain as a `Polygon`, or an `Outline` if any edge is an arc."""
        if any(c.bulge for c in self.corners):
            ends = [*self.corners[1:], *self.corners[:1]]
            return Outline(
                [(c.x, c.y, bend_of(c, e)) for c, e in zip(self.corners, ends, strict=True)], self.label
            )
        return Polygon([(c.x, c.y) for c in self.corners], self.label)

    def moved(self) -> fmpq:
        """An upper bound of how far any point of the closed chain is from the file's."""
        n = len(self.corners)
        return max((_moved(self.corners[i], self.corners[(i + 1) % n]) for i in range(n)), default=fmpq(0))


def bend_of(start: Corner, end: Corner) -> Bend:
    """How the edge from a corner bends: around its centre where that is still exact."""
    if start.center is None or start.shift or end.shift:
        return start.bulge
    return Around(start.center, bool(start.bulge > 0))


def _moved(start: Corner, end: Corner) -> fmpq:
    if isinstance(bend_of(start, end), Around):
        return ZERO
    if start.bulge == 0 and start.bulge_shift == 0:
        return max(start.shift, end.shift)
    size = abs(start.bulge) + start.bulge_shift
    wide = (1 + size * size) / (2 * size) if size > 1 else fmpq(1)
    shift = wide * (start.shift + end.shift)
    return shift + (distance_above(start, end) * start.bulge_shift / 2 if start.bulge_shift else 0)


def distance_above(a: Corner, b: Corner) -> fmpq:
    """A rational at least |ab|, at most a billionth of it larger; 0 only if a = b."""
    return root_above((a.x - b.x) ** 2 + (a.y - b.y) ** 2)


def root_above(square: fmpq) -> fmpq:
    """A rational at least the square root of *square* >= 0, at most a billionth larger; exact if rational."""
    p, q = int(square.p), int(square.q)
    root = isqrt(p * q)
    if root * root == p * q:
        return fmpq(root, q)
    scale = max(0, 64 - root.bit_length())
    return fmpq(isqrt((p * q) << (2 * scale)) + 1, q << scale)


def scientific_above(value: fmpq, places: int = 2) -> str:
    """A bound as a short decimal, of two digits or so many, rounded up: ``2.7e-13``; "0" for 0."""
    if value == 0:
        return "0"
    bits = int(value.p).bit_length() - int(value.q).bit_length()
    # log 2 = 0.30103: with two places at least 100 times less than the value
    power = bits * 30103 // 100_000 - places - 1
    digits = int((value / fmpq(10) ** power).ceil())
    while digits >= 10**places:
        digits, power = -(-digits // 10), power + 1
    return (
        f"{float(digits * Fraction(10) ** power):.{places}g}"
        if -300 < power < 300 - places
        else f"{digits}e{power}"
    )
