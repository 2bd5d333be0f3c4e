"""Exact lengths and areas: an algebraic number plus algebraic multiples of angles, totally ordered.

A `Length` is ``a + q pi + c_1 t_1 + ... + c_k t_k`` with Reals a, q, c_i (a radius, or r^2/2 for areas) over
the interned angles t_i in (0, pi/4] of `exactacq.numbers.angles`: every arc is folded to ``k pi/2 +- t`` (or
t/2), and angles that are simple rational multiples of pi are recognised, so complementary arcs cancel to
multiples of pi term by term.

How a sign is decided, in this order:

1. forms without angles and without pi: the sign of the algebraic part;
2. balls of 64, 128 and 256 bits that exclude 0;
3. Baker's theorem (Transcendental Number Theory, theorems 2.1 and 2.2): an algebraic combination of
   logarithms of algebraic numbers is 0 or transcendental, so a != 0 excludes 0; and logarithms that are
   linearly independent over Q are so over the algebraic numbers, so for a = 0 the form is 0 if and only if
   all its coefficients over a Q-basis of {pi, t_i} are 0; `exactacq.numbers.angle_relations` looks for one:
   contiguous arcs telescope, rational cosines and sines have a complete basis, other relations are proposed
   by LLL and proved;
4. if 0 is excluded, refinement until the ball has a sign;
5. if 0 is neither proved nor excluded (only with irrational cosines or sines), refinement up to
   `UNDECIDED_BITS`, then `Undecided`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from decimal import Decimal
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any, TypeAlias, TypeGuard

from flint import arb, fmpq, fmpz

from exactacq.errors import Undecided
from exactacq.numbers.angle_relations import reduced, simplified
from exactacq.numbers.angles import HALF, Angle, AngleSum, Ends, Vector, folded
from exactacq.numbers.exact import Exact
from exactacq.numbers.precision import workprec
from exactacq.numbers.quotient import Quotient
from exactacq.numbers.rationals import (
    ball_sign,
    enclose,
    rational,
    sympy_rational,
)
from exactacq.numbers.real import FILTER_BITS, Real
from exactacq.numbers.transcendental import generic_in

if TYPE_CHECKING:
    import sympy

UNDECIDED_BITS = 1 << 15
"""Precision up to which a sum of angles is refined when 0 is neither proved nor excluded."""
DISPLAY_ANGLES = 4
"""Up to this many angles the closed form tries the complements of the angles to become simpler."""

NUMBERS = (Real, int, fmpz, fmpq, Fraction, Decimal, float)
Number: TypeAlias = "Real | int | fmpz | fmpq | Fraction | Decimal | float"


class Length(Exact):
    """An exact length, in the unit of the scene, or an exact area, in its square.

    ``Length(value)`` takes what `Real` takes; lengths of arcs are made by `turns`, `arc` and `between`.
    Lengths add, subtract and scale by numbers exactly, and compare with each other and with numbers
    (infinities are the ends of the order; comparisons with a NaN are False but for ``!=``).
    Comparisons are a total order, or raise `Undecided` (stage 5 above).  Irrational lengths are not
    hashable: equal ones may have different expressions.  The empty sum, and a full circle of radius 0, are 0.
    The quotient of two lengths is a `Quotient`.

    >>> path = Length(5) + Length.turns(6)
    >>> print(path, path < Length("42.7"), f"{path:.3f}")
    5 + 12*pi True 42.699
    """

    __slots__ = ("_algebraic", "_angular", "_ball", "_bits", "_sign")

    _algebraic: Real
    _angular: AngleSum
    _ball: arb
    _bits: int
    _sign: int | None

    def __new__(cls, value: object = 0) -> Length:
        return value if isinstance(value, Length) else cls._make(Real(value), NO_ANGLES)

    @classmethod
    def _make(cls, algebraic: Real, angular: AngleSum) -> Length:
        self = object.__new__(cls)
        self._algebraic, self._angular = algebraic, angular
        self._bits, self._sign = 0, None
        return self

    @classmethod
    def arc(cls, coefficient: Number, cosine: Number, sine: Number) -> Length:
        """*coefficient* times the angle in [0, 2 pi) of the complex number cosine + i sine.

        ValueError if that number is not on the unit circle. This is checked exactly for rational coordinates
        and otherwise to 64 bits only: then it is up to the caller.

        >>> print(Length.arc(1, "3/5", "4/5") + Length.arc(1, "4/5", "3/5"))
        pi/2
        """
        return cls._make(Real(0), AngleSum.of(Real(cosine), Real(sine), Real(coefficient)))

    @classmethod
    def between(cls, coefficient: Number, start: Vector, end: Vector, norm_sq: fmpq) -> Length:
        """*coefficient* times the counterclockwise angle in [0, 2 pi) from one vector to another.

        *norm_sq* is the squared length of both vectors, checked as in `arc`. The angle remembers its two
        directions, so sums of contiguous arcs are decided into however many pieces their circle is divided,
        if pieces that meet are given the same vector (the same expression) there.

        >>> east, north = (Real(1), Real(0)), (Real(0), Real(1))
        >>> print(Length.between(2, north, east, fmpq(1)))
        3*pi
        """
        (a, b), (c, d) = start, end
        share, sign, angle = folded((a * c + b * d) / norm_sq, (a * d - b * c) / norm_sq)
        if angle is not None and angle.half_tangent is None:
            angle.remember(Ends(start, end, norm_sq) if sign > 0 else Ends(end, start, norm_sq))
        return cls._make(Real(0), AngleSum.scaled(share, sign, angle, Real(coefficient)))

    @classmethod
    def turns(cls, coefficient: Number, k: object = 1) -> Length:
        """*coefficient* times k full turns, ``2 pi k coefficient``, for a rational k.

        With a radius as coefficient it is the length of an arc that turns k times.

        >>> print(Length.turns(3, "1/4"))
        3*pi/2
        """
        return cls._make(Real(0), AngleSum(Real(coefficient) * (2 * rational(k)), {}))

    @classmethod
    def sum(cls, values: Iterable[Length | Number]) -> Length:
        """The exact sum; linear in the number of terms.

        >>> print(Length.sum([1, "1/2", Length.turns(1)]))
        3/2 + 2*pi
        """
        parts = [Length(value) for value in values]
        algebraic = Real.sum(part._algebraic for part in parts)
        return cls._make(algebraic, AngleSum.sum(part._angular for part in parts))

    @staticmethod
    def running_decimals(values: Iterable[Length], digits: int) -> list[str]:
        """Decimals of the sums of the first 0, 1, 2, ... values; linear: no exact partial sums are made.

        >>> Length.running_decimals([Length.turns(1), Length(1)], digits=6)
        ['0', '6.28319', '7.28319']
        """
        bits = 4 * digits + 64
        total, sums = arb(0), ["0"]
        for value in values:
            with workprec(bits):
                total += value.ball(bits)
            # An exact 0 so far stays "0"; otherwise the ball has far more digits than are asked for.
            sums.append("0" if total == 0 else str(total.str(digits, radius=False)))
        return sums

    def __reduce__(self) -> tuple[Callable[..., Length], tuple[Real, AngleSum]]:
        return Length._make, (self._algebraic, self._angular)

    @property
    def algebraic(self) -> Real:
        """The part without pi and angles."""
        return self._algebraic

    @property
    def rational(self) -> fmpq | None:  # type: ignore[override]
        """The value if it is rational and has no angles, or None."""
        return self._algebraic.rational if self.is_algebraic else None

    @property
    def numbers(self) -> tuple[Real, ...]:
        """What the closed form is made of: the part without angles, coefficients, cosines and sines."""
        angular = self._angular
        directions = (number for angle in angular.angles for number in (angle.cosine, angle.sine))
        return self._algebraic, angular.turn, *angular.angles.values(), *directions

    def direction(self, radius: Real) -> Vector | None:
        """Cosine and sine of the angle that this length spans on a circle of that radius.

        The algebraic part is left out. None if the angle is not a sum of simple fractions of pi and of angles
        with known cosine.

        >>> Length.turns(3, "1/4").direction(Real(3))
        (Real('0'), Real('1'))
        """
        return self._angular.direction(radius)

    @property
    def is_algebraic(self) -> bool:
        """Whether it has no pi and no angles.

        >>> Length(2).is_algebraic, Length.turns(1).is_algebraic
        (True, False)
        """
        return self._angular.is_zero

    # -- arithmetic --------------------------------------------------------------------------

    def __add__(self, other: object) -> Length:
        right = _coerce(other)
        if right is None:
            return NotImplemented
        total = Length._make(self._algebraic + right._algebraic, self._angular + right._angular)
        bits = min(self._bits, right._bits)
        if bits:  # A running total of n pieces would otherwise evaluate all n again.
            with workprec(bits):
                total._ball, total._bits = self._ball + right._ball, bits
        return total

    __radd__ = __add__

    def __neg__(self) -> Length:
        return self * -1

    def __pos__(self) -> Length:
        return self

    def __sub__(self, other: object) -> Length:
        right = _coerce(other)
        return NotImplemented if right is None else self + (-right)

    def __rsub__(self, other: object) -> Length:
        return (-self) + other

    def __abs__(self) -> Length:
        return -self if self.sign() < 0 else self

    def __mul__(self, other: object) -> Length:
        if not _is_number(other):
            return NotImplemented
        q = Real(other)
        return Length._make(self._algebraic * q, self._angular * q)

    __rmul__ = __mul__

    def __truediv__(self, other: object) -> Any:
        """A length, or how many times one goes into another (`Quotient`)."""
        if isinstance(other, Length):
            return Quotient(self, other)
        return self * (1 / Real(other)) if _is_number(other) else NotImplemented

    # -- order -------------------------------------------------------------------------------

    def sign(self) -> int:
        """-1, 0 or 1, decided exactly; raises `Undecided` beyond the limits above.

        >>> (Length.turns("113/2") - 355).sign()
        -1
        """
        if self._sign is None:
            self._sign = self._decide_sign()
        return self._sign

    def _decide_sign(self) -> int:
        if self.is_algebraic:
            return self._algebraic.sign()
        for bits in FILTER_BITS:
            if sign := ball_sign(self.ball(bits)):
                return sign
        if any(generic_in(number) is not None for number in (self._algebraic, *self._angular.numbers())):
            return self._shown_sign("a length at a place with transcendental coordinates")
        if self._algebraic.sign() != 0:
            return self._refined_sign()
        basis = reduced(self._angular)
        turn, angles = basis.turn.sign(), basis.angles
        if not angles:
            return turn
        if all(angle.half_tangent is not None for angle in angles) or (len(angles) == 1 and not turn):
            return self._refined_sign()
        return self._shown_sign(f"a sum of {len(angles)} angles")

    def _shown_sign(self, what: str) -> int:
        """The sign where no proof of 0 is known."""
        sign = self._refined_sign(UNDECIDED_BITS)
        if sign == 0:
            raise Undecided(
                f"sign of {what}: it is below 2^-{UNDECIDED_BITS}, and neither proved nor refuted to be 0"
            )
        return sign

    def _refined_sign(self, limit: int | None = None) -> int:
        """The sign of a number that is not 0; with *limit*, 0 if the sign does not show up to there."""
        bits = FILTER_BITS[-1]
        while limit is None or bits < limit:
            bits *= 2
            if sign := ball_sign(self.ball(bits)):
                return sign
        return 0

    def _coerced(self, other: object) -> Length | None:
        return _coerce(other)

    def _against(self, right: Length) -> int:
        if self.is_algebraic and right.is_algebraic:
            return self._algebraic.compare(right._algebraic)
        left_ball, right_ball = self.ball(64), right.ball(64)
        if left_ball < right_ball:
            return -1
        if left_ball > right_ball:
            return 1
        try:
            return (self - right).sign()
        except Undecided as reason:
            raise Undecided(f"comparison of {self!r} with {right!r}: {reason}") from None

    # -- values ------------------------------------------------------------------------------

    def ball(self, bits: int) -> arb:
        """An enclosing ball, a `flint.arb`, computed with *bits* working bits (more if cached).

        >>> Length.turns(1).ball(64)
        [6.28318530717959 +/- 3.53e-15]
        """
        if self._bits < bits:
            with workprec(bits):
                self._ball = self._algebraic.ball(bits) + self._angular.ball(bits)
                self._bits = bits
        return self._ball

    def enclosure(self, bits: int) -> tuple[fmpq, fmpq]:
        """Rational (low, high) around the value, at most 2^-bits apart; exact if rational.

        >>> low, high = Length.turns(1).enclosure(100)
        >>> low < Length.turns(1) < high, high - low < fmpq(1, 2**100)
        (True, True)
        """
        if self.is_algebraic:
            return self._algebraic.enclosure(bits)
        return enclose(self.ball, bits)

    def sympy(self) -> sympy.Expr:
        """The closed form as a sympy expression, full turns and proved relations folded to pi.

        >>> Length.arc(1, "3/5", "4/5").sympy()
        2*atan(1/2)
        """
        from sympy import Add, pi

        turn, terms = _readable(self._angular)
        angles = (c.sympy() * angle for c, angle in terms)
        return Add(self._algebraic.sympy(), turn.sympy() * pi, *angles)

    def __repr__(self) -> str:
        if self.is_algebraic and self._algebraic.rational is not None:
            return f"Length({str(self)!r})"
        return f"<Length {self.ball(64).str(15, radius=False)}>"


NO_ANGLES = AngleSum(Real(0), {})


def _is_number(value: object) -> TypeGuard[Number]:
    return isinstance(value, NUMBERS) and not isinstance(value, bool)


def _coerce(value: object) -> Length | None:
    """A number as a Length, None for what is no number (bools included); FormatError if it is not finite."""
    if isinstance(value, Length):
        return value
    return Length(value) if _is_number(value) else None


# -- closed form -------------------------------------------------------------------------------


def _readable(form: AngleSum) -> tuple[Real, list[tuple[Real, sympy.Expr]]]:
    """The multiple of pi and the terms (coefficient, angle) as a person would write them.

    Relations are used where they leave fewer angles; then few angles are replaced by complements or
    supplements so that pi disappears, or else so that coefficients are positive and pi's is simple.
    """
    form = simplified(form)
    # t = sign u + share pi for each way to write t by another angle u
    ways = ((1, fmpq(0)), (-1, HALF), (1, -HALF), (-1, fmpq(1)))
    items = list(form.angles.items())

    def turn(choice: tuple[int, ...]) -> Real:
        return form.turn + Real.sum(c * ways[i][1] for i, (_, c) in zip(choice, items, strict=True))

    def cost(choice: tuple[int, ...]) -> tuple[object, ...]:
        q = turn(choice)
        negative = sum(c.ball(64) * ways[i][0] < 0 for i, (_, c) in zip(choice, items, strict=True))
        return q.rational != 0, negative, int(q.rational.q) if q.rational is not None else 0, sum(choice)

    choice = (0,) * len(items)
    if len(items) <= DISPLAY_ANGLES:
        choice = min(product(range(4), repeat=len(items)), key=cost)
    terms = [(c * ways[i][0], _angle_sympy(angle, i)) for i, (angle, c) in zip(choice, items, strict=True)]
    return turn(choice), terms


def _angle_sympy(angle: Angle, way: int) -> sympy.Expr:
    """t, pi/2 - t, pi/2 + t or pi - t in closed form."""
    from sympy import acos, asin, atan

    u = angle.half_tangent
    if u is not None:
        u = (u, (1 - u) / (1 + u), (1 + u) / (1 - u), 1 / u)[way]
        factor = 2
        # Halve the angle as long as its tangent stays rational: 4 atan(b) for an arc of bulge b.
        while (norm := u.p**2 + u.q**2).is_square():
            u, factor = u.p / (u.q + fmpq(norm.isqrt())), 2 * factor
        return factor * atan(sympy_rational(u))
    c, s = angle.cosine, angle.sine
    x, y = ((c, s), (s, c), (-s, c), (-c, s))[way]
    forms = [acos(x.sympy())]
    if way < 2:
        forms += [asin(y.sympy()), atan((y / x).sympy())]
    return min(forms, key=lambda form: len(str(form)))
