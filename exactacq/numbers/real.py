"""Exact real algebraic numbers: linear forms over radicals, decided by balls and a height bound.

A `Real` is a rational, or a sum ``c_1 a_1 + ... + c_k a_k`` with rational ``c_i`` over *atoms*: 1,
square roots of integers, and interned nodes (square roots, products and inverses of Reals, roots of
integer polynomials).  Equal expressions share their atoms, so symbolic ties cancel term by term.

How a sign is decided, in this order:

1. rationals at once; a form without terms is 0;
2. balls of 64, 128 and 256 bits that exclude 0;
3. zero test.  Square roots of integers whose pairwise products are no squares are linearly
   independent over Q, and so are the powers of one root below its degree: such forms are 0 only if
   they cancel.  Any other form x has
   degree at most D (the product of the degrees of its distinct radicals and roots) and logarithmic
   height at most h (bounded along the expression); Liouville's inequality says x = 0 or
   |x| >= 2^(-D h), so a ball of that precision decides (Waldschmidt, Diophantine Approximation on
   Linear Algebraic Groups, section 3.5);
4. only after zero is excluded, refinement until the ball has a sign.

Beyond `ZERO_TEST_BITS` the zero test gives up with `Undecided`.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping
from decimal import Decimal
from fractions import Fraction
from math import gcd, log2
from typing import TYPE_CHECKING, Any, TypeVarTuple

from flint import arb, fmpq, fmpq_poly, fmpz

from exactacq.numbers.atoms import (
    Atom,
    Generators,
    Inverse,
    Product,
    Sqrt,
    atom_ball,
    atom_generators,
    atom_height,
    atom_sympy,
    order_of_atom,
)
from exactacq.numbers.exact import Exact
from exactacq.numbers.linear_forms import (
    Terms,
    add_to,
    denested,
    field_element,
    field_of,
    is_surd,
    polynomial,
    short_content,
    square_root,
)
from exactacq.numbers.precision import LOCK, workprec
from exactacq.numbers.rationals import (
    ball_sign,
    enclose,
    nearest_float,
    parted,
    rational,
    rational_sign,
    sympy_rational,
)
from exactacq.numbers.sign import FILTER_BITS, ZERO_TEST_BITS, decided_sign

if TYPE_CHECKING:
    import sympy

__all__ = ["FILTER_BITS", "ZERO_TEST_BITS", "Real", "fmpq", "rational", "real"]

LATE = 1
"""The working bits of a number that is only a ball so far; no computed ball has so few."""
LATE_BITS = 64
"""Up to this precision a late number answers by the ball it came with."""
EXPAND_TERMS = 64
"""A product of two radical sums is multiplied out up to this many terms."""
ZERO, ONE = fmpq(0), fmpq(1)
Given = TypeVarTuple("Given")


class Real(Exact):
    """An exact real algebraic number.

    ``Real(value)`` takes an int, Fraction, Decimal, text such as "21/2" or "0.1", or a float, which counts
    as the binary fraction that it is.  Arithmetic with numbers is exact, `sqrt` of a negative number raises
    ValueError, division by zero ZeroDivisionError.  Comparisons form a total order, in which infinities are
    the ends and a NaN has no place (all comparisons but ``!=`` are False, as for floats), and raise
    `Undecided` beyond the documented limits.  Bools are not numbers here.  An irrational Real is not
    hashable: equal values may have different expressions.

    >>> golden = (1 + Real(5).sqrt()) / 2
    >>> golden * golden == golden + 1
    True
    """

    __slots__ = ("_ball", "_bits", "_linear", "_make", "_sign", "rational")

    rational: fmpq | None
    """The value if the form is rational, else None (a hidden rational stays hidden). Not to be assigned."""
    _ball: arb
    _bits: int
    _make: tuple[Any, ...]
    _sign: int | None
    _linear: Mapping[Atom, fmpq] | None

    def __new__(cls, value: object = 0) -> Real:
        return value if isinstance(value, Real) else real(value if type(value) is fmpq else rational(value))

    @classmethod
    def _form(cls, terms: Mapping[Atom, fmpq]) -> Real:
        if not terms or (len(terms) == 1 and 1 in terms):
            return real(terms.get(1, ZERO))
        return _irrational(terms)

    @classmethod
    def of_atom(cls, atom: Atom) -> Real:
        """The real that an atom stands for."""
        return cls._form({atom: ONE})

    @classmethod
    def late(cls, ball: arb, make: Callable[[*Given], Real], *given: *Given) -> Real:
        """The number that *make* makes of what is *given*, once more is asked for than *ball*, around it.

        Signs and comparisons that the ball decides cost no arithmetic. *make* is called at most once.

        >>> root = Real.late(arb(1.4, 0.1), lambda: Real(2).sqrt())
        >>> root < 2, root * root
        (True, Real('2'))
        """
        self = object.__new__(_LateReal)
        self._ball, self._bits, self._make, self._sign = ball, LATE, (make, *given), None
        return self

    @property
    def is_late(self) -> bool:
        """Whether the number is only a ball so far."""
        return self._bits == LATE

    @classmethod
    def sum(cls, values: Iterable[Real]) -> Real:
        """The exact sum; linear in the number of terms.

        >>> print(Real.sum([Real(2).sqrt(), Real(8).sqrt(), Real(1)]))
        1 + 3*sqrt(2)
        """
        terms: dict[Atom, fmpq] = {}
        for value in values:
            add_to(terms, value.terms)
        return cls._form(terms)

    def __reduce__(self) -> tuple[Any, ...]:
        # Caches stay behind: balls cannot be pickled, and atoms must be interned where they arrive.
        return Real._form, (dict(self.terms),)

    # -- structure ---------------------------------------------------------------------------

    @property
    def terms(self) -> Mapping[Atom, fmpq]:
        """The linear form: coefficients by atom (1, the radicand of a square root, or a node)."""
        terms = self._linear
        if terms is None:
            # Most rationals never need it.
            assert self.rational is not None
            terms = self._linear = {1: self.rational} if self.rational else {}
        return terms

    @property
    def key(self) -> Hashable:
        """Equal keys mean equal values (not conversely): the structural identity."""
        q = self.rational
        if q is not None:
            # Hashing a rational itself takes ten times as long.
            return q.p, q.q
        return frozenset([(atom, c.p, c.q) for atom, c in self.terms.items()])

    # -- arithmetic --------------------------------------------------------------------------

    def __add__(self, other: object) -> Real:
        right = other if isinstance(other, Real) else _coerce(other)
        if right is None:
            return NotImplemented
        a, b = self.rational, right.rational
        if a is not None and b is not None:
            return real(a + b)
        return Real._form(add_to({**self.terms}, right.terms))

    __radd__ = __add__

    def __neg__(self) -> Real:
        return self._scaled(-ONE)

    def __pos__(self) -> Real:
        return self

    def __abs__(self) -> Real:
        return -self if self.sign() < 0 else self

    def __sub__(self, other: object) -> Real:
        right = other if isinstance(other, Real) else _coerce(other)
        if right is None:
            return NotImplemented
        a, b = self.rational, right.rational
        if a is not None and b is not None:
            return real(a - b)
        return Real._form(add_to({**self.terms}, right.terms, -ONE))

    def __rsub__(self, other: object) -> Real:
        left = _coerce(other)
        return NotImplemented if left is None else left - self

    def _scaled(self, q: fmpq) -> Real:
        if self.rational is not None:
            return real(self.rational * q)
        return Real._form({a: c * q for a, c in self.terms.items()} if q else {})

    def affine(self, factor: fmpq, offset: fmpq) -> Real:
        """offset + factor * self, in one step."""
        if self.rational is not None:
            return real(offset + factor * self.rational)
        if not factor:
            return real(offset)
        if len(own := self.terms) == 1 and offset:
            ((atom, c),) = own.items()
            return _irrational({atom: c * factor, 1: offset})
        terms = {atom: c * factor for atom, c in own.items()}
        return _irrational(add_to(terms, {1: offset}) if offset else terms)

    def __mul__(self, other: object) -> Real:
        right = other if isinstance(other, Real) else _coerce(other)
        if right is None:
            return NotImplemented
        a, b = self.rational, right.rational
        if a is not None:
            return real(a * b) if b is not None else right._scaled(a)
        if b is not None:
            return self._scaled(b)
        surds = is_surd(self.terms) and is_surd(right.terms)
        field = None if surds else field_of(self.terms)
        if field is not None and field == field_of(right.terms):
            product = polynomial(self.terms) * polynomial(right.terms)
            return Real._form(field_element(field, product % fmpq_poly(list(field[0]))))
        few = len(self.terms) == 1 or len(right.terms) == 1
        if len(self.terms) * len(right.terms) <= EXPAND_TERMS and (few or surds):
            terms: dict[Atom, fmpq] = {}
            for a, p in self.terms.items():
                for b, q in right.terms.items():
                    form, scale = _atom_product(a, b)
                    add_to(terms, form, p * q * scale)
            return Real._form(terms)
        return _node_product(self, right)

    __rmul__ = __mul__

    def __truediv__(self, other: object) -> Real:
        right = other if isinstance(other, Real) else _coerce(other)
        if right is None:
            return NotImplemented
        a, b = self.rational, right.rational
        if b is not None:
            if not b:
                raise ZeroDivisionError("division of an exact real by zero")
            return real(a / b) if a is not None else self._scaled(1 / b)
        if self.terms == right.terms and right.sign():
            return real(ONE)
        return self * right._inverse()

    def __rtruediv__(self, other: object) -> Real:
        left = _coerce(other)
        return NotImplemented if left is None else left / self

    def _inverse(self) -> Real:
        if self.sign() == 0:
            raise ZeroDivisionError("division of an exact real by zero")
        if len(self.terms) <= 2 and is_surd(self.terms):
            (a, p), (b, q) = (*self.terms.items(), (1, ZERO))[:2]
            conjugate = Real._form({a: p, b: -q} if q else {a: p})
            norm = p * p * a - q * q * b
            if norm:  # 0 if a and b are one radical, with a square factor that trial division missed
                return conjugate._scaled(1 / norm)
        field = field_of(self.terms)
        if field is not None:
            _, inverse, _ = polynomial(self.terms).xgcd(fmpq_poly(list(field[0])))
            return Real._form(field_element(field, inverse))
        if len(self.terms) == 1:
            ((atom, c),) = self.terms.items()
            if isinstance(atom, Inverse):
                inner = atom.args[0]
                assert isinstance(inner, Real)
                return inner._scaled(1 / c)
            return Real.of_atom(Inverse.make(Real.of_atom(atom)))._scaled(1 / c)
        return Real.of_atom(Inverse.make(self))

    def __pow__(self, exponent: int) -> Real:
        if exponent < 0:
            return 1 / self ** (-exponent)
        result, base = Real(1), self
        while exponent:
            if exponent & 1:
                result = result * base
            base, exponent = base * base if exponent > 1 else base, exponent >> 1
        return result

    def sqrt(self) -> Real:
        """The non-negative square root; ValueError for a negative number.

        >>> print(Real(12).sqrt())
        2*sqrt(3)
        """
        q = self.rational
        if q is not None and q > 0:
            return Real._form(square_root(q))
        sign = self.sign()
        if sign < 0:
            raise ValueError(f"square root of the negative number {self.decimal(20)}")
        if sign == 0:
            return Real(0)
        plain = denested(self.terms)
        return _sqrt_node(self) if plain is None else Real._form(plain)

    def rational_ratio(self, other: Real) -> fmpq | None:
        """The rational q with self = q * other if the forms show it, else None (also where other is 0).

        >>> print(Real(8).sqrt().rational_ratio(Real(2).sqrt()))
        2
        """
        if len(self.terms) != len(other.terms) and self.terms:
            return None
        ratio = ZERO
        for atom, c in self.terms.items():
            below = other.terms.get(atom)
            if below is None or (ratio and c != ratio * below):
                return None
            ratio = c / below
        return ratio if other.terms else None

    # -- order -------------------------------------------------------------------------------

    def sign(self) -> int:
        """-1, 0 or 1, decided exactly; raises `Undecided` beyond `ZERO_TEST_BITS`.

        >>> (Real(2).sqrt() + Real(3).sqrt() - (5 + 2 * Real(6).sqrt()).sqrt()).sign()
        0
        """
        if self._bits == LATE and (sign := ball_sign(self._ball)):
            return sign
        if self.rational is not None:
            return rational_sign(self.rational)
        if self._sign is None:
            self._sign = decided_sign(self)
        return self._sign

    def height_bound(self) -> float:
        """Upper bound of the absolute logarithmic height, base 2 (Waldschmidt, section 3.2)."""
        if self.rational is not None:
            return float(self.rational.height_bits())
        parts = (c.height_bits() + atom_height(a) for a, c in self.terms.items())
        return float(sum(parts)) + log2(len(self.terms))

    def generators(self) -> Generators:
        """The distinct radicals and roots of the expression, with their degrees."""
        if self.rational is not None:
            return frozenset()
        return frozenset().union(*(atom_generators(a) for a in self.terms))

    def compare(self, other: object) -> int:
        """-1, 0 or 1 as self is less than, equal to or greater than *other*, which may be infinite.

        TypeError for what is no number, ValueError for a NaN, `Undecided` beyond `ZERO_TEST_BITS`.

        >>> Real(2).sqrt().compare(Real("1.41421356"))
        1
        """
        if self is other:
            return 0
        if isinstance(other, Real):
            if self._bits and other._bits:
                if self._ball < other._ball:
                    return -1
                if self._ball > other._ball:
                    return 1
            return self._against(other)
        return self._compared(other)

    def _order(self, other: object) -> Any:
        return self.compare(other) if isinstance(other, Real) else super()._order(other)

    def _coerced(self, other: object) -> Real | None:
        return _coerce(other)

    def _against(self, right: Real) -> int:
        is_late = self._bits == LATE or right._bits == LATE
        if is_late and (order := parted(self.ball(LATE_BITS), right.ball(LATE_BITS))):
            return order
        if self.rational is not None and right.rational is not None:
            return rational_sign(self.rational - right.rational)
        if order := parted(self.ball(64), right.ball(64)):
            return order
        if self._is_root and right._is_root:
            # Two positive roots that 64 bits cannot tell apart: their squares have a quarter of the degree.
            return (self * self - right * right).sign()
        return (self - right).sign()

    def clear_sign(self, bits: int) -> int:
        """The sign if a ball of *bits* working bits shows it, else 0; rationals show theirs."""
        if self._bits == LATE and (sign := ball_sign(self._ball)):
            return sign
        return self.sign() if self.rational is not None else ball_sign(self.ball(bits))

    def overlaps(self, other: Real) -> bool:
        """Whether two numbers may be equal: balls leave it open, or rationals are."""
        late = self._bits == LATE or other._bits == LATE
        if late and not self.ball(LATE_BITS).overlaps(other.ball(LATE_BITS)):
            return False
        a, b = self.rational, other.rational
        if a is not None and b is not None:
            return bool(a == b)
        return all(self.ball(bits).overlaps(other.ball(bits)) for bits in FILTER_BITS)

    @property
    def _is_root(self) -> bool:
        """Whether the form is a positive multiple of one square root."""
        if len(self.terms) != 1:
            return False
        ((atom, c),) = self.terms.items()
        return isinstance(atom, Sqrt) and c > 0

    # -- values ------------------------------------------------------------------------------

    def ball(self, bits: int) -> arb:
        """An enclosing ball, a `flint.arb`, computed with *bits* working bits (more if cached).

        >>> Real(2).sqrt().ball(64)
        [1.41421356237310 +/- 4.96e-15]
        """
        if self._bits >= bits or (self._bits == LATE and bits <= LATE_BITS):
            return self._ball
        with workprec(bits):
            return self.working_ball(bits)

    def working_ball(self, bits: int) -> arb:
        """An enclosing ball; the caller must have set the working precision to *bits*."""
        if self._bits == LATE:
            if bits <= LATE_BITS:
                return self._ball
            assert isinstance(self, _LateReal), "no other number has such bits"
            self._made()
        if self._bits < bits:
            if self.rational is not None:
                ball = arb(self.rational)
            else:
                ball = arb(0)
                for atom, c in self.terms.items():
                    ball += arb(c) if atom == 1 else atom_ball(atom, bits) * c
            self._ball, self._bits = ball, bits
        return self._ball

    def enclosure(self, bits: int) -> tuple[fmpq, fmpq]:
        """Rational (low, high) around the value, at most 2^-bits apart; exact if rational.

        >>> low, high = Real(2).sqrt().enclosure(100)
        >>> low < Real(2).sqrt() < high, high - low < fmpq(1, 2**100)
        (True, True)
        """
        if self.rational is not None:
            return self.rational, self.rational
        return enclose(self.ball, bits)

    def rough(self) -> float:
        """A float near the value: to draw or to sort, never to decide."""
        if self._bits == LATE:
            return float(self._ball)
        return nearest_float(self.rational) if self.rational is not None else float(self.ball(64))

    def sympy(self) -> sympy.Expr:
        """The closed form as a sympy expression.

        >>> (1 / Real(2).sqrt()).sympy()
        sqrt(2)/2
        """
        from sympy import Add

        return Add(*(sympy_rational(c) * atom_sympy(a) for a, c in self.terms.items()))

    @property
    def numbers(self) -> tuple[Real]:
        """The number itself: the only one in its closed form."""
        return (self,)

    def __repr__(self) -> str:
        return f"Real({str(self)!r})" if self.rational is not None else f"<Real {self.decimal(15)}>"


class _LateReal(Real):
    """A number that is only a ball so far: a plain one, which is faster to read, once it is looked into."""

    __slots__ = ()

    def __getattr__(self, name: str) -> Any:
        if name in ("rational", "_linear") and self._bits == LATE:
            self._made()
        return object.__getattribute__(self, name)

    def _made(self) -> None:
        make = getattr(self, "_make", None)
        value = None if make is None else make[0](*make[1:])
        rational = None if value is None else value.rational
        with LOCK:
            if value is not None and self._bits == LATE:
                self._linear = None if rational is not None else value.terms
                if value._bits:
                    self._ball = value._ball
                self.rational, self._sign, self._bits = rational, value._sign, value._bits
                del self._make
                self.__class__ = Real  # type: ignore[assignment]


_LateReal.__name__ = _LateReal.__qualname__ = Real.__name__  # It is nothing else to those who read of it.


def real(q: fmpq) -> Real:
    """A rational as a Real, without any check: the commonest of all steps."""
    self = object.__new__(Real)
    self.rational, self._linear, self._bits, self._sign = q, None, 0, None
    return self


def _irrational(terms: Mapping[Atom, fmpq]) -> Real:
    """A form of which an atom is no rational."""
    self = object.__new__(Real)
    self.rational, self._linear, self._bits, self._sign = None, terms, 0, None
    return self


def _coerce(value: object) -> Real | None:
    """A number as a Real, None for what is no number (bools included); FormatError if it is not finite."""
    if type(value) is fmpq:
        return real(value)
    if isinstance(value, Real):
        return value
    if isinstance(value, (int, fmpz, fmpq, Fraction, float, Decimal)) and not isinstance(value, bool):
        return real(rational(value))
    return None


def _atom_product(a: Atom, b: Atom) -> tuple[Terms, fmpq | int]:
    """A form and a rational whose product is that of two atoms."""
    if a == 1 or b == 1:
        return {b if a == 1 else a: ONE}, 1
    if isinstance(a, int) and isinstance(b, int):
        common = gcd(a, b)
        return square_root(fmpq(a // common * (b // common))), common
    if a is b and isinstance(a, Sqrt):
        square = a.args[0]
        assert isinstance(square, Real)
        return square.terms, 1
    return _node_product(Real.of_atom(a), Real.of_atom(b)).terms, 1


def _node_product(a: Real, b: Real) -> Real:
    (p, first), (q, second) = _primitive(a), _primitive(b)
    return Real.of_atom(Product.make(first, second))._scaled(p * q)


def _primitive(x: Real) -> tuple[fmpq, Real]:
    """(c, y) with x = c y, the same y for all rational multiples of x unless these are long."""
    divisor = short_content(x.terms)
    if x.terms[min(x.terms, key=order_of_atom)] < 0:
        divisor = -divisor
    return divisor, x._scaled(1 / divisor)


def _sqrt_node(x: Real) -> Real:
    """sqrt of a form, its rational content taken out as far as it is a square."""
    divisor = short_content(x.terms)
    ((radicand, factor),) = square_root(divisor).items()
    assert isinstance(radicand, int)
    return Real.of_atom(Sqrt.make(x._scaled(fmpq(radicand) / divisor)))._scaled(factor)
