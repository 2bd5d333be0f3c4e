"""Interned angles, folded so that complementary arcs share them, and formal sums of angles.

An `Angle` lies in (0, pi/4] and belongs to a complex number of modulus 1 with algebraic coordinates; the
angle of any such number is ``k pi/2 +- t`` for an interned angle t (or t/2). An `AngleSum` is
``q pi + c_1 t_1 + ... + c_k t_k`` with Reals q and c_i.
"""

from __future__ import annotations

import atexit
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from math import pi
from typing import ClassVar, NamedTuple, TypeAlias
from weakref import WeakValueDictionary

from flint import arb, fmpq, fmpz_poly

from exactacq.errors import Undecided
from exactacq.numbers.function_zeros import roots
from exactacq.numbers.precision import LOCK, workprec
from exactacq.numbers.real import Real

MAX_DENOMINATOR = 30
"""Angles p pi/q up to this q are recognised when they are made; others stay angles and compare exactly."""
MAX_ENDS = 64
"""Most pairs of directions that an angle remembers: a bound where one arc is repeated in many poses."""

MOST_HALVES, MOST_TIMES = 8, 64
"""Fractions of angles whose directions are made: their denominator divides the one, up to the other times."""

QUARTER, HALF, TWO = fmpq(1, 4), fmpq(1, 2), fmpq(2)

Vector: TypeAlias = "tuple[Real, Real]"


class Ends(NamedTuple):
    """Two directions that an angle lies between: vectors of squared length ``norm_sq``."""

    start: Vector
    end: Vector
    norm_sq: fmpq


class Angle:
    """An interned angle in (0, pi/4], identified by the structural key of its cosine.

    ``half_tangent`` is tan(angle/2) if cosine and sine are rational, else None; ``share`` is the angle
    over pi if that was recognised to be rational, else None.
    """

    __slots__ = ("__weakref__", "_ball", "_bits", "_ends", "cosine", "half_tangent", "share", "sine")
    _interned: ClassVar[WeakValueDictionary[Hashable, Angle]] = WeakValueDictionary()

    _ball: arb
    _bits: int
    _ends: dict[Hashable, Ends]
    cosine: Real
    sine: Real
    half_tangent: fmpq | None
    share: fmpq | None

    @classmethod
    def make(cls, cosine: Real, sine: Real, ends: Iterable[Ends] = ()) -> Angle:
        """The one angle of this cosine: in (0, pi/4] the cosine determines it."""
        c, s = cosine.rational, sine.rational
        # Not by the rational itself, which cannot be hashed while the interpreter shuts down.
        key = cosine.key if c is None else (int(c.p), int(c.q))
        with LOCK:
            angle = cls._interned.get(key)
            if angle is None:
                angle = object.__new__(cls)
                angle.cosine, angle.sine, angle._bits, angle._ends = cosine, sine, 0, {}
                angle.half_tangent = None if c is None or s is None else s / (1 + c)
                angle.share = _share_of_pi(angle)
                cls._interned[key] = angle
            for pair in ends:
                angle.remember(pair)
            return angle

    def __reduce__(self) -> tuple[Callable[..., Angle], tuple[Real, Real, tuple[Ends, ...]]]:
        return Angle.make, (self.cosine, self.sine, self.ends)

    @property
    def ends(self) -> tuple[Ends, ...]:
        """Directions of the arcs made with this angle: arg(end) - arg(start) is the angle modulo pi/2."""
        return tuple(self._ends.values())

    def remember(self, ends: Ends) -> None:
        """Keep a pair of directions, so that contiguous arcs can be proved to cancel.

        What is forgotten beyond `MAX_ENDS` can cost a proof (`Undecided`), never a wrong one.
        """
        if len(self._ends) < MAX_ENDS:
            (a, b), (c, d), _ = ends
            self._ends[a.key, b.key, c.key, d.key] = ends

    def ball(self, bits: int) -> arb:
        """Enclosure with at least *bits* working bits."""
        if self._bits < bits:
            with workprec(bits):
                if self.half_tangent is not None:
                    self._ball = 2 * arb(self.half_tangent).atan()
                else:
                    self._ball = arb.atan2(self.sine.ball(bits), self.cosine.ball(bits))
                self._bits = bits
        return self._ball


# Keys cannot be hashed any more once the interpreter takes its modules apart.
atexit.register(Angle._interned.clear)


def _share_of_pi(angle: Angle) -> fmpq | None:
    """angle/pi if it is rational with denominator up to `MAX_DENOMINATOR`, proved; else None.

    The ball proposes p/q; then the angle t is p pi/q if and only if 2 cos 2t is a root of the minimal
    polynomial of 2 cos(2 pi/q).
    """
    if angle.half_tangent is not None:
        return None  # Niven: no rational multiple of pi in (0, pi/4] has rational cosine and sine.
    bits, ball = 64, angle.ball(64)
    while ball.rad() > 2.0**-50:
        bits *= 2
        ball = angle.ball(bits)
    share = float(ball) / pi
    for q in range(5, MAX_DENOMINATOR + 1):
        p = round(share * q)
        if p and abs(share * q - p) < 1e-12:
            x, value = 4 * angle.cosine * angle.cosine - 2, Real(0)
            for c in reversed(fmpz_poly.cos_minpoly(q).coeffs()):
                value = value * x + c
            try:
                return fmpq(p, q) if value.sign() == 0 else None
            except Undecided:
                return None
    return None


def folded(cosine: Real, sine: Real) -> tuple[fmpq, fmpq, Angle | None]:
    """(q, s, t) with: the angle in [0, 2 pi) of cosine + i sine is q pi + s t; s is 1, 1/2 or minus that.

    Where only the double angle has rational cosine and sine, as that of atan(1/7), t is the double angle:
    factors in Z[i] decide it completely. ValueError if the number is not on the unit circle: exact for
    rational coordinates, else the caller's promise, checked to 64 bits.
    """
    c, s = cosine.rational, sine.rational
    if c is not None and s is not None:
        valid = c * c + s * s == 1
    else:
        valid = bool((cosine.ball(64) ** 2 + sine.ball(64) ** 2).contains(1))
    if not valid:
        raise ValueError(f"not on the unit circle: {cosine!r}, {sine!r}")
    share, sign = fmpq(0), fmpq(1)
    if sine.sign() < 0:
        share, sign, sine = TWO, -sign, -sine
    if cosine.sign() < 0:
        share, sign, cosine = share + sign, -sign, -cosine
    order = sine.compare(cosine)
    if order == 0:
        return share + sign * QUARTER, sign, None
    if order > 0:
        share, sign, cosine, sine = share + sign * HALF, -sign, sine, cosine
    if sine.sign() == 0:
        return share, sign, None
    if c is None or s is None:
        x, y = 2 * cosine * cosine - 1, 2 * cosine * sine
        if x.rational is not None and y.rational is not None:
            twice, scale, angle = folded(x, y)
            return share + sign * twice / 2, sign * scale / 2, angle
    angle = Angle.make(cosine, sine)
    return (share, sign, angle) if angle.share is None else (share + sign * angle.share, sign, None)


class AngleSum:
    """``turn * pi`` plus the sum of coefficient times angle: a plain linear form, not compared here.

    Coefficients that are seen to be 0 are dropped; hidden zeros stay.
    """

    __slots__ = ("angles", "turn")

    def __init__(self, turn: Real, angles: Mapping[Angle, Real]) -> None:
        self.turn, self.angles = turn, angles

    @classmethod
    def of(cls, cosine: Real, sine: Real, coefficient: Real) -> AngleSum:
        """*coefficient* times the angle in [0, 2 pi) of cosine + i sine, as in `folded`."""
        return cls.scaled(*folded(cosine, sine), coefficient)

    @classmethod
    def scaled(cls, share: fmpq, sign: fmpq, angle: Angle | None, coefficient: Real) -> AngleSum:
        """*coefficient* times a folded angle, ``share * pi + sign * angle``."""
        angles = {} if angle is None or coefficient.rational == 0 else {angle: coefficient * sign}
        return cls(coefficient * share, angles)

    @classmethod
    def sum(cls, parts: Iterable[AngleSum]) -> AngleSum:
        """The exact sum; linear in the number of terms."""
        collected: dict[Angle, list[Real]] = {}
        turns = []
        for part in parts:
            turns.append(part.turn)
            for angle, c in part.angles.items():
                collected.setdefault(angle, []).append(c)
        angles = {angle: cs[0] if len(cs) == 1 else Real.sum(cs) for angle, cs in collected.items()}
        return cls(Real.sum(turns), {angle: c for angle, c in angles.items() if c.rational != 0})

    def __reduce__(self) -> tuple[type[AngleSum], tuple[Real, dict[Angle, Real]]]:
        return AngleSum, (self.turn, dict(self.angles))

    def direction(self, divisor: Real) -> Vector | None:
        """Cosine and sine of the sum over a number; None if the parts are not seen to be simple fractions.

        Of pi with denominators up to `MAX_DENOMINATOR`, of angles with a power of 2 up to `MOST_HALVES`.
        """
        share = (self.turn / divisor).rational
        if share is None or share.q > MAX_DENOMINATOR:
            return None
        found = _cosine_of_pi(share), _cosine_of_pi(share - HALF)
        for angle, c in self.angles.items():
            times = (c / divisor).rational
            if times is None or MOST_HALVES % int(times.q) or abs(times.p) > MOST_TIMES:
                return None
            turn = angle.cosine, angle.sine
            for _ in range(int(times.q).bit_length() - 1):
                turn = ((1 + turn[0]) / 2).sqrt(), ((1 - turn[0]) / 2).sqrt()
            turn = turn if times > 0 else (turn[0], -turn[1])
            for _ in range(abs(int(times.p))):
                found = _product(found, turn)
        return found

    def numbers(self) -> Iterator[Real]:
        """All numbers that the sum is made of."""
        yield self.turn
        for angle, coefficient in self.angles.items():
            yield from (coefficient, angle.cosine, angle.sine)

    @property
    def is_zero(self) -> bool:
        """Whether no term is left (a zero that hides says False)."""
        return not self.angles and self.turn.rational == 0

    def __add__(self, other: AngleSum) -> AngleSum:
        """A running total copies its terms each time; of one angle after the other, use `sum`."""
        large, small = (self, other) if len(self.angles) >= len(other.angles) else (other, self)
        angles = large.angles
        if small.angles:
            angles = dict(angles)
            for angle, c in small.angles.items():
                both = angles[angle] + c if angle in angles else c
                if both.rational == 0:
                    del angles[angle]
                else:
                    angles[angle] = both
        return AngleSum(self.turn + other.turn, angles)

    def __sub__(self, other: AngleSum) -> AngleSum:
        return self + other * Real(-1)

    def __mul__(self, factor: Real) -> AngleSum:
        if factor.rational == 0:
            return AngleSum(Real(0), {})
        return AngleSum(self.turn * factor, {angle: c * factor for angle, c in self.angles.items()})

    def ball(self, bits: int) -> arb:
        """Enclosure computed with *bits* working bits."""
        with workprec(bits):
            ball = self.turn.ball(bits) * arb.pi() if self.turn.rational != 0 else arb(0)
            for angle, c in self.angles.items():
                ball += c.ball(bits) * angle.ball(bits)
            return ball


def _cosine_of_pi(share: fmpq) -> Real:
    """The cosine of a rational multiple of pi: half a root of the minimal polynomial of 2 cos(2 pi / n)."""
    turn, bits = share / 2, 64
    found = roots(fmpz_poly.cos_minpoly(int(turn.q)).coeffs())
    # The root that is meant overlaps at every precision, each other one only up to some precision.
    while len(found) > 1:
        with workprec(bits):
            near = 2 * arb.cos_pi_fmpq(share)
        found = [root for root in found if root.ball(bits).overlaps(near)]
        bits *= 2
    return found[0] / 2


def _product(a: Vector, b: Vector) -> Vector:
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]
