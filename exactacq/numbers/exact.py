"""What every exact number offers besides arithmetic: order, hash, formats and rounding."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal
from math import isnan
from typing import TYPE_CHECKING, Any

from flint import arb, fmpq

from exactacq.numbers.rationals import ball_sign, decimal_string, nearest_float, nonfinite, round_to_float
from exactacq.numbers.sign import FILTER_BITS

if TYPE_CHECKING:
    import sympy

    from exactacq.numbers.atoms import Atom, Form

GUARD = 10
"""Digits beyond those that are shown: rounding twice is then rounding once, but for ties no one could see."""
HALF = fmpq(1, 2)
BITS_PER_CHARACTER = 4
"""More than the 3.33 bits of a decimal digit."""
SHORT, SHOWN = 80, 15
"""Closed forms of about this many characters at most are shown in notebooks; digits of others."""
LONGEST, LONGEST_SHOWN = 10_000, 30
"""Closed forms that may take more characters are no text: nobody reads them, and they take minutes."""


def is_short(number: Form, limit: int) -> bool:
    """Whether the closed form of a real may have no more than *limit* characters.

    Forms of more radicals are not even to be written out, which would take seconds: k distinct radicals take
    more than k characters. Nor are those with numbers whose digits alone are too many, or whose parts are
    where each is written out wherever it stands.
    """
    if len(number.generators()) > limit or number.height_bound() > BITS_PER_CHARACTER * limit:
        return False
    return _digits_in(number, {}) <= limit


def _digits_in(number: Form, known: dict[int, int]) -> int:
    """About how many digits the closed form has; *known* are those of its nodes, by their identities."""
    return sum(
        (c.p.bit_length() + c.q.bit_length()) // BITS_PER_CHARACTER + _digits_below(atom, known)
        for atom, c in number.terms.items()
    )


def _digits_below(atom: Atom, known: dict[int, int]) -> int:
    if isinstance(atom, int):
        return atom.bit_length() // BITS_PER_CHARACTER
    if id(atom) not in known:
        forms = (form for form in atom.args if hasattr(form, "terms"))
        known[id(atom)] = 1 + sum(_digits_in(form, known) for form in forms)
    return known[id(atom)]


class Exact:
    """A number with an exact order.

    A subclass says what it takes for a number (`_coerced`) and how it compares with one (`_against`). It has
    ``rational`` (None if it is irrational), ``numbers``, the reals in its closed form, `sign`, `ball`,
    `enclosure`, `sympy` and a product with rationals.

    >>> from exactacq.numbers.length import Length
    >>> root = Length(2) * Length("3/2").algebraic
    >>> f"{root:.2f}", round(root * fmpq(5, 2)), root.as_integer_ratio()
    ('3.00', 8, (3, 1))
    """

    __slots__ = ()

    rational: fmpq | None

    @property
    def numbers(self) -> Sequence[Form]:
        """The reals in the closed form."""
        raise NotImplementedError

    def ball(self, bits: int) -> arb:
        """An enclosing ball, computed with *bits* working bits or more."""
        raise NotImplementedError

    def sympy(self) -> sympy.Expr:
        """The closed form as a sympy expression."""
        raise NotImplementedError

    def _coerced(self, other: object) -> Any:
        """Another number as one to compare with, or None for what is none."""
        raise NotImplementedError

    def _against(self, right: Any) -> int:
        """The sign of self - right, which is of the same type or what `_coerced` gave."""
        raise NotImplementedError

    def sign(self) -> int:
        """-1, 0 or 1, decided exactly."""
        raise NotImplementedError

    def _order(self, other: object) -> Any:
        """The sign of self - other; None for a NaN, NotImplemented for what is no number."""
        if self is other:
            return 0
        right = other if isinstance(other, type(self)) else None
        if right is None:
            special = nonfinite(other)
            if special is not None:
                return None if isnan(special) else -1 if special > 0 else 1
            right = self._coerced(other)
            if right is None:
                return NotImplemented
        return self._against(right)

    def compare(self, other: object) -> int:
        """-1, 0 or 1 as self is less than, equal to or greater than *other*, which may be infinite.

        TypeError for what is no number, ValueError for a NaN, `Undecided` beyond the limits of the type.

        >>> from exactacq.numbers.length import Length
        >>> Length.turns(1).compare(7)
        -1
        """
        return self._compared(other)

    def _compared(self, other: object) -> int:
        order = self._order(other)
        if order is NotImplemented or order is None:
            kind = type(self).__name__
            if order is None:
                raise ValueError(f"cannot compare a {kind} with NaN")
            raise TypeError(f"cannot compare a {kind} with {type(other).__name__}")
        return int(order)

    def __bool__(self) -> bool:
        return self.sign() != 0

    def __eq__(self, other: object) -> bool:
        order = self._order(other)
        return NotImplemented if order is NotImplemented else order == 0

    def __lt__(self, other: object) -> bool:
        order = self._order(other)
        return NotImplemented if order is NotImplemented else order is not None and order < 0

    def __le__(self, other: object) -> bool:
        order = self._order(other)
        return NotImplemented if order is NotImplemented else order is not None and order <= 0

    def __gt__(self, other: object) -> bool:
        order = self._order(other)
        return NotImplemented if order is NotImplemented else order is not None and order > 0

    def __ge__(self, other: object) -> bool:
        order = self._order(other)
        return NotImplemented if order is NotImplemented else order is not None and order >= 0

    def __hash__(self) -> int:
        """Equal numbers have equal hashes; irrational ones, which may be equal in many forms, have none."""
        if self.rational is None:
            kind = type(self).__name__
            raise TypeError(f"an irrational {kind} is not hashable: equal ones may have different forms")
        return hash(self.rational)

    def as_integer_ratio(self) -> tuple[int, int]:
        """Numerator and denominator; ValueError for an irrational number.

        >>> from exactacq.numbers.real import Real
        >>> Real("0.75").as_integer_ratio()
        (3, 4)
        """
        if self.rational is None:
            raise ValueError(f"an irrational number is no ratio of integers: {self}")
        return int(self.rational.p), int(self.rational.q)

    def __float__(self) -> float:
        """The nearest float, ties to even; OverflowError beyond the largest float, as for Fraction."""
        if self.rational is not None:
            return nearest_float(self.rational)
        return round_to_float(self.ball, lambda middle: self.compare(middle) == 0) + 0.0  # never -0.0

    def decimal(self, digits: int) -> str:
        """The value with *digits* significant digits, right to within one unit of the last.

        >>> from exactacq.numbers.length import Length
        >>> Length.turns(1).decimal(30)
        '6.28318530717958647692528676656'
        """
        if not ball_sign(self.ball(FILTER_BITS[-1])) and self.sign() == 0:
            return "0"
        return decimal_string(self.ball, digits)

    def __str__(self) -> str:
        """The closed form; 30 digits and an ellipsis where it may have more than 10,000 characters.

        `sympy` makes any form, however long that takes, and `decimal` any number of digits.

        >>> from exactacq.numbers.real import Real
        >>> str(Real(2).sqrt()), str(Real(2).sqrt() + fmpq(1, 10**20_000))
        ('sqrt(2)', '1.41421356237309504880168872421...')
        """
        if self.rational is not None:
            return str(self.rational)
        # Of a sum of angles every number may be short, and all of them together long.
        size = sum(number.height_bound() for number in self.numbers)
        if size <= BITS_PER_CHARACTER * LONGEST and all(is_short(n, LONGEST) for n in self.numbers):
            return str(self.sympy())
        return f"{self.decimal(LONGEST_SHOWN)}..."

    def __format__(self, spec: str) -> str:
        """The number formatted as a `decimal.Decimal` would be; without a specification its closed form.

        All digits shown are correct, however many are asked for: they are not read off a float.
        """
        if not spec:
            return str(self)
        _, point, places = spec.rstrip("%eEfFgGn").rpartition(".")
        wanted = int(places) if point and places.isdigit() else 6
        number: Any = self
        whole = len(str(max(abs(end).floor() for end in number.enclosure(8))))
        return format(Decimal(number.decimal(whole + wanted + GUARD)), spec)

    def latex(self) -> str:
        r"""The closed form in LaTeX.

        >>> from exactacq.numbers.length import Length
        >>> print((1 + Length.turns(1, "1/6")).latex())
        1 + \frac{\pi}{3}
        """
        from sympy import latex

        return str(latex(self.sympy()))

    def _repr_latex_(self) -> str:
        """For notebooks: the closed form where it is short, else the decimal value."""
        if all(is_short(number, SHORT) for number in self.numbers) and len(str(self)) <= SHORT:
            return f"$\\displaystyle {self.latex()}$"
        return f"$\\approx {self.decimal(SHOWN)}$"

    def __round__(self, places: int | None = None) -> int | fmpq:
        """The nearest integer, or the nearest multiple of 10^-places as a rational; ties to even, exactly."""
        scale = fmpq(10) ** (places or 0)
        scaled: Any = self * scale
        low, high = scaled.enclosure(8)
        nearest = int(((low + high) / 2 + HALF).floor())
        above, below = scaled.compare(nearest + HALF), scaled.compare(nearest - HALF)
        if above > 0 or (above == 0 and nearest % 2):
            nearest += 1
        elif below < 0 or (below == 0 and nearest % 2):
            nearest -= 1
        return nearest if places is None else fmpq(nearest) / scale

    def __floor__(self) -> int:
        """The greatest integer that is not more: `math.floor` would else take that of the nearest float."""
        nearest: Any = round(self)
        return int(nearest) - (self.compare(nearest) < 0)

    def __ceil__(self) -> int:
        """The least integer that is not less, for `math.ceil`."""
        nearest: Any = round(self)
        return int(nearest) + (self.compare(nearest) > 0)
