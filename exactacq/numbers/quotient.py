"""The quotient of two lengths: compared exactly, and enclosed as closely as asked."""

from __future__ import annotations

from typing import Any

from flint import arb, fmpq

from exactacq.errors import FormatError, Undecided
from exactacq.numbers.exact import Exact
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import ball_sign, enclose, rational

EARLY, LATE = (64, 256), (1024, 4096)
"""Working bits of balls that tell two irrational quotients apart, before and after these are multiplied."""


class Quotient(Exact):
    """How many times one length goes into another, which is not 0.

    Comparisons with rational numbers are exact: a / b < q where a < q b. So are those of two quotients with
    one bottom, and of those whose bottoms, or whose tops, have no angles: a / b < c / d where a d < c b, if b
    and d are positive. Of others balls tell all but equality. They raise `Undecided` where that does.

    >>> from exactacq.numbers.length import Length
    >>> half = Length("3/2") / Length(3)
    >>> half == fmpq(1, 2), half < 1, float(half)
    (True, True, 0.5)
    """

    def __init__(self, top: Any, bottom: Any) -> None:
        self._sign = bottom.sign()
        if not self._sign:
            raise ZeroDivisionError("division by a length of 0")
        self.top, self.bottom = top, bottom

    def ball(self, bits: int) -> arb:
        """An enclosing ball computed with *bits* working bits, or more where the divisor is near 0."""
        while True:
            with workprec(bits):
                below = self.bottom.ball(bits)
                if not below.contains(0):
                    return self.top.ball(bits) / below
            bits *= 2

    def enclosure(self, bits: int) -> tuple[fmpq, fmpq]:
        """Rational (low, high) around the value, at most 2^-bits apart."""
        return enclose(self.ball, bits)

    @property
    def rational(self) -> fmpq | None:  # type: ignore[override]
        """The value if both lengths are rational, or None."""
        a, b = self.top.rational, self.bottom.rational
        return None if a is None or b is None else a / b

    def __mul__(self, factor: object) -> Quotient:
        return Quotient(self.top * factor, self.bottom)

    def sign(self) -> int:
        """-1, 0 or 1."""
        return int(self.top.sign() * self._sign)

    def _coerced(self, other: object) -> fmpq | None:
        if isinstance(other, str | bool):
            return None
        try:
            return rational(other)
        except FormatError:
            return None

    def _against(self, right: Quotient | fmpq) -> int:
        number = right.rational if isinstance(right, Quotient) else right
        if isinstance(right, Quotient) and number is None:
            return self._ordered(right) if self.rational is None else -right._against(self.rational)
        return int((self.top - self.bottom * number).sign() * self._sign)

    def _ordered(self, other: Quotient) -> int:
        """The order of two irrational quotients."""
        for bits in EARLY:
            if order := ball_sign(self.ball(bits) - other.ball(bits)):
                return order
        difference = self._multiplied(other)
        if difference is not None:
            return int(difference.sign() * self._sign * other._sign)
        for bits in LATE:
            if order := ball_sign(self.ball(bits) - other.ball(bits)):
                return order
        raise Undecided("two quotients of irrational lengths that may be equal")

    def _multiplied(self, other: Quotient) -> Any:
        """The difference of two quotients times both bottoms, or None if that is no length."""
        (a, b), (c, d) = (self.top, self.bottom), (other.top, other.bottom)
        if b.is_algebraic and d.is_algebraic:
            return a * d.algebraic - c * b.algebraic
        if a.is_algebraic and c.is_algebraic:
            return d * a.algebraic - b * c.algebraic
        # Times one bottom only, and its sign.
        return (a - c) * b.sign() if b == d else None

    def __str__(self) -> str:
        return self.decimal(15)

    def __repr__(self) -> str:
        return f"<Quotient {self}>"
