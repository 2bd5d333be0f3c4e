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

Beyond `ZERO_TEST_BITS` the zero test gives up with `Undecided`.  This is the one file, with
`lengths`, that imports flint.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache, total_ordering
from math import log2, prod
from typing import TYPE_CHECKING, Any, TypeAlias
from weakref import WeakValueDictionary

from flint import arb, ctx, fmpq, fmpq_poly, fmpz, fmpz_poly

from exactacq.errors import Undecided
from exactacq.numerals import decimal_string, enclose, rational, round_to_float, sympy_rational

if TYPE_CHECKING:
    import sympy

FILTER_BITS = (64, 128, 256)
ZERO_TEST_BITS = 1 << 21
"""Largest precision of the zero test; 2^21 bits take about a second an operation."""
EXPAND_TERMS = 64
"""A product of two radical sums is multiplied out up to this many terms."""

ZERO, ONE = fmpq(0), fmpq(1)

@lru_cache(maxsize=1 << 16)
def _square_free(n: int) -> tuple[int, int]:
    """(s, d) with n = s^2 d, s as large as trial division and one perfect-square test find it."""
    number, side = fmpz(n), fmpz(1)
    factors = number.factor() if number.bit_length() <= 62 else number.factor_smooth(12)
    rest = fmpz(1)
    for factor, exponent in factors:
        base, odd = fmpz(factor), exponent % 2
        if not odd or not base.is_square():
            side *= base ** (exponent // 2)
            rest *= base if odd else fmpz(1)
        else:
            side *= base.isqrt() ** exponent
    return int(side), int(rest)


class _Node:
    """An interned atom that is not the root of an integer; subclasses say how it is evaluated."""

    __slots__ = ("__weakref__", "_ball", "_bits", "_generators", "_height", "args")
    _interned: WeakValueDictionary[Hashable, _Node] = WeakValueDictionary()

    args: tuple[Any, ...]

    @classmethod
    def make(cls, *args: Any) -> _Node:
        key = (cls, *(a.key if isinstance(a, Real) else a for a in args))
        node = cls._interned.get(key)
        if node is None:
            node = object.__new__(cls)
            node.args, node._bits, node._height, node._generators = args, 0, None, None
            cls._interned[key] = node
        return node

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).make, self.args

    def ball(self, bits: int) -> arb:
        """Enclosure computed with at least *bits* working bits (the caller has set the precision)."""
        if self._bits < bits:
            self._ball, self._bits = self._evaluate(bits), bits
        return self._ball

    def height(self) -> float:
        """Upper bound of the absolute logarithmic height, base 2."""
        if self._height is None:
            self._height = self._bound()
        return self._height

    def generators(self) -> frozenset[tuple[Hashable, int]]:
        """The distinct radicals and roots below, with their degrees."""
        if self._generators is None:
            self._generators = self._collect()
        return self._generators

    def _evaluate(self, bits: int) -> arb:
        raise NotImplementedError

    def _bound(self) -> float:
        return sum(a._height_bound() for a in self.args)

    def _collect(self) -> frozenset[tuple[Hashable, int]]:
        return frozenset().union(*(a._generator_set() for a in self.args))

    def sympy(self) -> sympy.Expr:
        raise NotImplementedError


class _Sqrt(_Node):
    __slots__ = ()

    def _evaluate(self, bits: int) -> arb:
        # The argument was proved to be non-negative when the node was made.
        return self.args[0]._working_ball(bits).nonnegative_part().sqrt()

    def _bound(self) -> float:
        return self.args[0]._height_bound() / 2

    def _collect(self) -> frozenset[tuple[Hashable, int]]:
        return self.args[0]._generator_set() | {(self, 2)}

    def sympy(self) -> sympy.Expr:
        from sympy import sqrt

        return sqrt(self.args[0].sympy())


class _Product(_Node):
    __slots__ = ()

    @classmethod
    def make(cls, *args: Any) -> _Node:
        # Factors in the order of this process's hashes, also when they come from a pickle.
        return super().make(*sorted(args, key=lambda factor: hash(factor.key)))

    def _evaluate(self, bits: int) -> arb:
        return self.args[0]._working_ball(bits) * self.args[1]._working_ball(bits)

    def sympy(self) -> sympy.Expr:
        return self.args[0].sympy() * self.args[1].sympy()


class _Inverse(_Node):
    __slots__ = ()

    def _evaluate(self, bits: int) -> arb:
        return 1 / self.args[0]._working_ball(bits)

    def sympy(self) -> sympy.Expr:
        return 1 / self.args[0].sympy()


class _Root(_Node):
    """A power of real root number ``index`` (from the left) of an irreducible integer polynomial.

    Powers below the degree are a basis of the field that the root generates: elements of one such field
    multiply, divide and cancel as polynomials.
    """

    __slots__ = ()

    def _evaluate(self, bits: int) -> arb:
        coefficients, index, power = self.args
        if power > 1:
            return _Root.make(coefficients, index, 1).ball(bits) ** power
        return _newton(fmpz_poly(list(coefficients)), _isolated(coefficients)[index])

    def _bound(self) -> float:
        coefficients, _, power = self.args
        norm = sum(int(c) ** 2 for c in coefficients).bit_length() / 2 + 1
        return float(power * norm / (len(coefficients) - 1))

    def _collect(self) -> frozenset[tuple[Hashable, int]]:
        coefficients, index, _ = self.args
        return frozenset({((coefficients, index), len(coefficients) - 1)})

    def sympy(self) -> sympy.Expr:
        from sympy import CRootOf, Poly, Symbol

        coefficients, index, power = self.args
        return CRootOf(Poly([int(c) for c in reversed(coefficients)], Symbol("x")), index) ** power


@lru_cache(maxsize=1 << 10)
def _isolated(coefficients: tuple[int, ...]) -> list[arb]:
    """Balls of the real roots of an irreducible polynomial, ascending, so tight that Newton's method starts."""
    polynomial = fmpz_poly(list(coefficients))
    slope = polynomial.derivative()
    bits = 64
    while True:
        with ctx.workprec(bits):
            balls = _real_roots(polynomial)
            if all(_ball_sign(slope(ball)) for ball in balls):
                return balls
        bits *= 2


def _newton(polynomial: fmpz_poly, ball: arb) -> arb:
    """An isolating ball refined by the interval Newton method to the working precision."""
    slope = polynomial.derivative()
    while True:
        middle = ball.mid()
        finer = middle - polynomial(middle) / slope(ball)
        if not finer.rad() < ball.rad() / 2:
            return ball
        ball = finer


def _real_roots(polynomial: fmpz_poly) -> list[arb]:
    """Disjoint balls of the real roots of a squarefree polynomial, from left to right."""
    roots = [r.real for r, _ in polynomial.complex_roots() if r.imag == 0]
    return sorted(roots, key=lambda ball: ball.mid().fmpq())


Atom: TypeAlias = "int | _Node"


@total_ordering
class Real:
    """An exact real algebraic number.

    ``Real(value)`` takes what `rational` takes.  Arithmetic with numbers is exact, `sqrt` of a
    negative number raises ValueError, division by zero ZeroDivisionError.  Comparisons form a
    total order and raise `Undecided` beyond the documented limits.  An irrational Real is not
    hashable: equal values may have different expressions.
    """

    __slots__ = ("_ball", "_bits", "_q", "_sign", "_terms")

    _q: fmpq | None
    _terms: Mapping[Atom, fmpq]

    def __new__(cls, value: object = 0) -> Real:
        return value if isinstance(value, Real) else cls._rational(rational(value))

    @classmethod
    def _rational(cls, q: fmpq) -> Real:
        self = object.__new__(cls)
        self._q, self._terms, self._bits, self._sign = q, ({1: q} if q else {}), 0, None
        return self

    @classmethod
    def _form(cls, terms: Mapping[Atom, fmpq]) -> Real:
        if not terms or (len(terms) == 1 and 1 in terms):
            return cls._rational(terms.get(1, ZERO))
        self = object.__new__(cls)
        self._q, self._terms, self._bits, self._sign = None, terms, 0, None
        return self

    @classmethod
    def _atom(cls, atom: Atom) -> Real:
        return cls._form({atom: ONE})

    @classmethod
    def sum(cls, values: Iterable[Real]) -> Real:
        """The exact sum; linear in the number of terms."""
        terms: dict[Atom, fmpq] = {}
        for value in values:
            for atom, c in value._terms.items():
                terms[atom] = terms.get(atom, ZERO) + c
        return cls._form({a: c for a, c in terms.items() if c})

    def __reduce__(self) -> tuple[Any, ...]:
        # Caches stay behind: balls cannot be pickled, and atoms must be interned where they arrive.
        return Real._form, (dict(self._terms),)

    # -- structure ---------------------------------------------------------------------------

    @property
    def rational(self) -> fmpq | None:
        """The value if the form is rational, else None (a hidden rational stays hidden)."""
        return self._q

    @property
    def key(self) -> Hashable:
        """Equal keys mean equal values (not conversely): the structural identity."""
        return self._q if self._q is not None else frozenset(self._terms.items())

    @property
    def _is_surd(self) -> bool:
        return all(type(atom) is int for atom in self._terms)

    def _field(self) -> tuple[tuple[int, ...], int] | None:
        """The irreducible polynomial and the root whose field the form lies in, if it needs no other atoms."""
        field = None
        for atom in self._terms:
            if isinstance(atom, _Root):
                if field is None:
                    field = atom.args[:2]
                elif field != atom.args[:2]:
                    return None
            elif atom != 1:
                return None
        return field

    def _polynomial(self) -> fmpq_poly:
        """The form as a polynomial in its one root."""
        powers = {0 if isinstance(atom, int) else atom.args[2]: c for atom, c in self._terms.items()}
        return fmpq_poly([powers.get(k, 0) for k in range(max(powers) + 1)])

    # -- arithmetic --------------------------------------------------------------------------

    def __add__(self, other: object) -> Real:
        right = _coerce(other)
        if right is None:
            return NotImplemented
        if self._q is not None and right._q is not None:
            return Real._rational(self._q + right._q)
        return Real.sum((self, right))

    __radd__ = __add__

    def __neg__(self) -> Real:
        return self._scaled(-ONE)

    def __pos__(self) -> Real:
        return self

    def __abs__(self) -> Real:
        return -self if self.sign() < 0 else self

    def __sub__(self, other: object) -> Real:
        right = _coerce(other)
        return NotImplemented if right is None else self + right._scaled(-ONE)

    def __rsub__(self, other: object) -> Real:
        return (-self) + other

    def _scaled(self, q: fmpq) -> Real:
        if self._q is not None:
            return Real._rational(self._q * q)
        return Real._form({a: c * q for a, c in self._terms.items()} if q else {})

    def __mul__(self, other: object) -> Real:
        right = _coerce(other)
        if right is None:
            return NotImplemented
        if right._q is not None:
            return self._scaled(right._q)
        if self._q is not None:
            return right._scaled(self._q)
        field = self._field()
        if field is not None and field == right._field():
            modulus = fmpq_poly(list(field[0]))
            return _field_element(field, self._polynomial() * right._polynomial() % modulus)
        few = len(self._terms) == 1 or len(right._terms) == 1
        surds = self._is_surd and right._is_surd
        if len(self._terms) * len(right._terms) <= EXPAND_TERMS and (few or surds):
            return Real.sum(
                _atom_product(a, b)._scaled(p * q)
                for a, p in self._terms.items()
                for b, q in right._terms.items()
            )
        return _node_product(self, right)

    __rmul__ = __mul__

    def __truediv__(self, other: object) -> Real:
        right = _coerce(other)
        if right is None:
            return NotImplemented
        if right._q is not None:
            if not right._q:
                raise ZeroDivisionError("division of an exact real by zero")
            return self._scaled(1 / right._q)
        if self.key == right.key:
            return Real._rational(ONE)
        return self * right._inverse()

    def __rtruediv__(self, other: object) -> Real:
        left = _coerce(other)
        return NotImplemented if left is None else left / self

    def _inverse(self) -> Real:
        if self.sign() == 0:
            raise ZeroDivisionError("division of an exact real by zero")
        if len(self._terms) <= 2 and self._is_surd:
            (a, p), (b, q) = (*self._terms.items(), (1, ZERO))[:2]
            conjugate = Real._form({a: p, b: -q} if q else {a: p})
            norm = p * p * a - q * q * b  # type: ignore[operator]
            if norm:  # 0 if a and b are one radical, with a square factor that trial division missed
                return conjugate._scaled(1 / norm)
        field = self._field()
        if field is not None:
            _, inverse, _ = self._polynomial().xgcd(fmpq_poly(list(field[0])))
            return _field_element(field, inverse)
        if len(self._terms) == 1:
            ((atom, c),) = self._terms.items()
            if isinstance(atom, _Inverse):
                return atom.args[0]._scaled(1 / c)
            return Real._atom(_Inverse.make(Real._atom(atom)))._scaled(1 / c)
        return Real._atom(_Inverse.make(self))

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
        """The non-negative square root; ValueError for a negative number."""
        sign = self.sign()
        if sign < 0:
            raise ValueError(f"square root of the negative number {self.decimal(20)}")
        if sign == 0:
            return Real(0)
        if self._q is not None:
            return _sqrt_rational(self._q)
        return _denested(self) or _sqrt_node(self)

    def rational_ratio(self, other: Real) -> fmpq | None:
        """The rational q with self = q * other if the two forms show it, else None (also where other is 0)."""
        if len(self._terms) != len(other._terms) and self._terms:
            return None
        ratio = ZERO
        for atom, c in self._terms.items():
            below = other._terms.get(atom)
            if below is None or (ratio and c != ratio * below):
                return None
            ratio = c / below
        return ratio if other._terms else None

    # -- order -------------------------------------------------------------------------------

    def sign(self) -> int:
        """-1, 0 or 1, decided exactly; raises `Undecided` beyond `ZERO_TEST_BITS`."""
        if self._q is not None:
            return (self._q > 0) - (self._q < 0)
        if self._sign is None:
            self._sign = self._decide_sign()
        return self._sign

    def _decide_sign(self) -> int:
        for bits in FILTER_BITS:
            if sign := _ball_sign(self.ball(bits)):
                return sign
        if self._is_surd:
            merged = _merge_surds(self._terms)
            if len(merged) < len(self._terms):
                return Real._form(merged).sign()
        elif self._field() is None:
            limit = self._separation_bits()
            if limit > ZERO_TEST_BITS:
                raise Undecided(
                    f"sign of {decimal_string(self.ball, 20)}...: excluding zero would take {limit} bits, "
                    f"more than {ZERO_TEST_BITS}"
                )
            bits = 2 * FILTER_BITS[-1]
            while True:
                ball = self.ball(bits)
                if sign := _ball_sign(ball):
                    return sign
                if ball.abs_upper() < arb(2) ** -limit:
                    return 0
                bits = min(2 * bits, limit + limit // 4 + 4096) if bits < limit else 2 * bits
        bits = 2 * FILTER_BITS[-1]
        while not (sign := _ball_sign(self.ball(bits))):
            bits *= 2
        return sign

    def _height_bound(self) -> float:
        if self._q is not None:
            return float(self._q.height_bits())
        parts = (c.height_bits() + _atom_height(a) for a, c in self._terms.items())
        return sum(parts) + log2(len(self._terms))

    def _generator_set(self) -> frozenset[tuple[Hashable, int]]:
        if self._q is not None:
            return frozenset()
        return frozenset().union(*(_atom_generators(a) for a in self._terms))

    def _separation_bits(self) -> int:
        degree = prod(d for _, d in self._generator_set())
        return int(min(degree, 1 << 60) * (self._height_bound() + 1)) + 8

    def compare(self, other: object) -> int:
        """-1, 0 or 1 as self is less than, equal to or greater than *other*."""
        right = _coerce(other)
        if right is None:
            raise TypeError(f"cannot compare an exact real with {type(other).__name__}")
        if self._q is not None and right._q is not None:
            return (self._q > right._q) - (self._q < right._q)
        left_ball, right_ball = self.ball(64), right.ball(64)
        if left_ball < right_ball:
            return -1
        if left_ball > right_ball:
            return 1
        return (self - right).sign()

    def __eq__(self, other: object) -> bool:
        return NotImplemented if _coerce(other) is None else self.compare(other) == 0

    def __lt__(self, other: object) -> bool:
        return NotImplemented if _coerce(other) is None else self.compare(other) < 0

    def __hash__(self) -> int:
        if self._q is None:
            raise TypeError("an irrational Real is not hashable: use .key for structural identity")
        return hash(self._q)

    def __bool__(self) -> bool:
        return self.sign() != 0

    # -- values ------------------------------------------------------------------------------

    def ball(self, bits: int) -> arb:
        """An enclosing ball computed with *bits* working bits (more if cached)."""
        if self._bits >= bits:
            return self._ball
        with ctx.workprec(bits):
            return self._working_ball(bits)

    def _working_ball(self, bits: int) -> arb:
        if self._bits < bits:
            if self._q is not None:
                ball = arb(self._q)
            else:
                ball = arb(0)
                for atom, c in self._terms.items():
                    root = arb(atom).sqrt() if type(atom) is int else atom.ball(bits)
                    ball += arb(c) * root if atom != 1 else arb(c)
            self._ball, self._bits = ball, bits
        return self._ball

    def enclosure(self, bits: int) -> tuple[fmpq, fmpq]:
        """Rational (low, high) around the value, at most 2^-bits apart; exact if rational."""
        if self._q is not None:
            return self._q, self._q
        return enclose(self.ball, bits)

    def __float__(self) -> float:
        """The nearest float, ties to even."""
        if self._q is not None:
            return int(self._q.p) / int(self._q.q)
        return round_to_float(self.ball, lambda middle: self == middle) + 0.0

    def decimal(self, digits: int) -> str:
        """The value with *digits* significant digits, correctly rounded to one unit in the last."""
        if not _ball_sign(self.ball(FILTER_BITS[-1])) and self.sign() == 0:
            return "0"
        return decimal_string(self.ball, digits)

    def sympy(self) -> sympy.Expr:
        """The closed form as a sympy expression."""
        from sympy import Add, Integer, sqrt

        def atom(a: Atom) -> sympy.Expr:
            return sqrt(Integer(a)) if isinstance(a, int) else a.sympy()

        return Add(*(sympy_rational(c) * atom(a) for a, c in self._terms.items()))

    def latex(self) -> str:
        """The closed form in LaTeX."""
        from sympy import latex

        return str(latex(self.sympy()))

    def __str__(self) -> str:
        return str(self._q) if self._q is not None else str(self.sympy())

    def __repr__(self) -> str:
        return f"Real({str(self)!r})" if self._q is not None else f"<Real {self.decimal(15)}>"


def _coerce(value: object) -> Real | None:
    if isinstance(value, Real):
        return value
    if isinstance(value, (int, fmpz, fmpq, Fraction, float, Decimal)):
        return Real._rational(rational(value))
    return None


def _field_element(field: tuple[tuple[int, ...], int], polynomial: fmpq_poly) -> Real:
    """A polynomial of degree below the field's, evaluated at its root."""
    coefficients, index = field
    return Real._form(
        {
            _Root.make(coefficients, index, k) if k else 1: c
            for k, c in enumerate(polynomial.coeffs())
            if c
        }
    )


def _atom_height(atom: Atom) -> float:
    return log2(atom) / 2 if isinstance(atom, int) else atom.height()


def _atom_generators(atom: Atom) -> frozenset[tuple[Hashable, int]]:
    if isinstance(atom, int):
        return frozenset() if atom == 1 else frozenset({(atom, 2)})
    return atom.generators()


def _atom_product(a: Atom, b: Atom) -> Real:
    if isinstance(a, int) and isinstance(b, int):
        if a == 1 or b == 1:
            return Real._atom(a * b) if a * b != 1 else Real(1)
        return _sqrt_rational(fmpq(fmpz(a) * b))
    if a == 1 or b == 1:
        return Real._atom(b if a == 1 else a)
    if a is b and isinstance(a, _Sqrt):
        return a.args[0]  # type: ignore[no-any-return]
    return _node_product(Real._atom(a), Real._atom(b))


def _node_product(a: Real, b: Real) -> Real:
    (p, first), (q, second) = _primitive(a), _primitive(b)
    return Real._atom(_Product.make(first, second))._scaled(p * q)


def _primitive(x: Real) -> tuple[fmpq, Real]:
    """(c, y) with x = c y, the same y for all rational multiples of x."""
    numerator, denominator = fmpz(0), fmpz(1)
    for c in x._terms.values():
        numerator, denominator = numerator.gcd(c.p), denominator.lcm(c.q)
    content = fmpq(numerator, denominator)
    if x._terms[min(x._terms, key=hash)] < 0:
        content = -content
    return content, x._scaled(1 / content)


def _sqrt_rational(q: fmpq) -> Real:
    side, radicand = _square_free(int(q.p * q.q))
    coefficient = fmpq(side) / q.q
    return Real._rational(coefficient) if radicand == 1 else Real._form({radicand: coefficient})


def _denested(x: Real) -> Real | None:
    """sqrt(p + q sqrt(d)) as a sum of two square roots, where p^2 - q^2 d is a square."""
    if len(x._terms) != 2 or not x._is_surd or 1 not in x._terms:
        return None
    p = x._terms[1]
    ((d, q),) = ((a, c) for a, c in x._terms.items() if a != 1)
    norm = _rational_sqrt(p * p - q * q * d)  # type: ignore[operator]
    if norm is None or p < 0:
        return None
    large, small = _sqrt_rational((p + norm) / 2), _sqrt_rational((p - norm) / 2)
    return large + small if q > 0 else large - small


def _rational_sqrt(q: fmpq) -> fmpq | None:
    if q < 0 or not q.p.is_square() or not q.q.is_square():
        return None
    return fmpq(q.p.isqrt(), q.q.isqrt())


def _sqrt_node(x: Real) -> Real:
    """sqrt of a form, its rational content taken out as far as it is a square."""
    numerator, denominator = fmpz(0), fmpz(1)
    for c in x._terms.values():
        numerator, denominator = numerator.gcd(c.p), denominator.lcm(c.q)
    side, rest = _square_free(int(numerator * denominator))
    content = fmpq(numerator, denominator)
    inner = x._scaled(fmpq(rest) / content)
    return Real._atom(_Sqrt.make(inner))._scaled(fmpq(side, denominator))


def _merge_surds(terms: Mapping[Atom, fmpq]) -> dict[Atom, fmpq]:
    """Collect radicals that differ by a square factor which trial division did not find."""
    merged: dict[Atom, fmpq] = {}
    for d, c in terms.items():
        for e in merged:
            ratio = _rational_sqrt(fmpq(d, e))  # type: ignore[arg-type]
            if ratio is not None:
                merged[e] += c * ratio
                break
        else:
            merged[d] = c
    return {a: c for a, c in merged.items() if c}


def _ball_sign(ball: arb) -> int:
    """Sign of a ball that excludes 0, else 0; an exact zero ball also gives 0."""
    return 1 if ball > 0 else -1 if ball < 0 else 0


def roots(coefficients: Iterable[object]) -> list[Real]:
    """All distinct real roots, ascending, of ``c_0 + c_1 x + ...`` with rational coefficients.

    Rational and quadratic roots come in closed form.  ValueError for the zero polynomial.
    """
    values = [rational(c) for c in coefficients]
    common = fmpz(1)
    for c in values:
        common = common.lcm(c.q)
    polynomial = fmpz_poly([(c * common).p for c in values])
    if polynomial.degree() < 0:
        raise ValueError("every number is a root of the zero polynomial")
    found: list[Real] = []
    for factor, _ in polynomial.factor()[1]:
        found += _irreducible_roots(factor)
    return sorted(found)


def _irreducible_roots(factor: fmpz_poly) -> list[Real]:
    coefficients = tuple(factor.coeffs())
    if len(coefficients) == 2:
        return [Real._rational(fmpq(-coefficients[0], coefficients[1]))]
    if len(coefficients) == 3:
        c, b, a = coefficients
        square = b * b - 4 * a * c
        if square < 0:
            return []
        root = _sqrt_rational(fmpq(square))
        return [(root._scaled(s) - Real(b)) / (2 * a) for s in (ONE, -ONE)]
    key = tuple(int(c) for c in coefficients)
    return [Real._atom(_Root.make(key, index, 1)) for index in range(len(_isolated(key)))]


