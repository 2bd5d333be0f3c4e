"""Exact lengths and areas: an algebraic number plus algebraic multiples of angles, totally ordered.

A `Length` is ``a + q pi + c_1 t_1 + ... + c_k t_k`` with Reals a, q, c_i (a radius, or r^2/2 for areas)
over interned *angles* t_i in (0, pi/4]: t_i is the angle of a complex number of modulus 1 with
algebraic coordinates.  Every arc is folded to ``k pi/2 +- t`` (or t/2), and angles that are simple rational
multiples of pi are recognised, so complementary arcs cancel to multiples of pi term by term.

How a sign is decided, in this order:

1. forms without angles and without pi: the sign of the algebraic part;
2. balls of 64, 128 and 256 bits that exclude 0;
3. Baker's theorem (Transcendental Number Theory, theorems 2.1 and 2.2): an algebraic combination of
   logarithms of algebraic numbers is 0 or transcendental, so a != 0 excludes 0; and logarithms that
   are linearly independent over Q are so over the algebraic numbers, so for a = 0 the form is 0 if
   and only if all its coefficients over a Q-basis of {pi, t_i} are 0.  Angles with rational cosine
   and sine are written in such a basis by factors in Z[i] (complete); for others, integer relations
   are proposed by LLL and used only when proved by exact multiplication;
4. if 0 is excluded, refinement until the ball has a sign;
5. if 0 is neither proved nor excluded (only with irrational cosines or sines), refinement up to
   `UNDECIDED_BITS`, then `Undecided`.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping
from contextlib import suppress
from decimal import Decimal
from fractions import Fraction
from itertools import combinations, product
from math import gcd, isqrt
from typing import TYPE_CHECKING, ClassVar, TypeAlias
from weakref import WeakValueDictionary

from flint import arb, ctx, fmpq, fmpz, fmpz_mat, fmpz_poly

from exactacq.errors import Undecided
from exactacq.numerals import decimal_string, enclose, rational, round_to_float, sympy_rational
from exactacq.reals import FILTER_BITS, Real

if TYPE_CHECKING:
    import sympy

UNDECIDED_BITS = 1 << 15
"""Precision up to which a sum of angles is refined when 0 is neither proved nor excluded."""
RELATION_ANGLES = 12
"""Most angles among which integer relations are sought, to keep LLL and the proofs in milliseconds."""
RELATION_WEIGHT = 64
"""Largest sum of absolute coefficients of a relation that is proved by multiplication."""
MAX_DENOMINATOR = 30
"""Angles p pi/q up to this q are recognised when they are made; others stay angles and compare exactly."""
FACTOR_BITS = 96
"""Norms up to this size are factored (milliseconds); larger ones are split by greatest common divisors."""
DISPLAY_ANGLES = 4
"""Up to this many angles the closed form tries the complements of the angles to become simpler."""

QUARTER, HALF, TWO = fmpq(1, 4), fmpq(1, 2), fmpq(2)
NUMBERS = (Real, int, fmpz, fmpq, Fraction, Decimal, float)
Number: TypeAlias = "Real | int | fmpz | fmpq | Fraction | Decimal | float"


class _Angle:
    """An interned angle in (0, pi/4].

    ``half_tangent`` is tan(angle/2) if cosine and sine are rational, else None; ``share`` is the angle
    over pi if that was recognised to be rational, else None.
    """

    __slots__ = ("__weakref__", "_ball", "_bits", "cosine", "half_tangent", "share", "sine")
    _interned: ClassVar[WeakValueDictionary[Hashable, _Angle]] = WeakValueDictionary()

    _ball: arb
    _bits: int
    cosine: Real
    sine: Real
    half_tangent: fmpq | None
    share: fmpq | None

    @classmethod
    def make(cls, cosine: Real, sine: Real) -> _Angle:
        # In this range the cosine determines the angle.
        angle = cls._interned.get(cosine.key)
        if angle is None:
            angle = object.__new__(cls)
            angle.cosine, angle.sine, angle._bits = cosine, sine, 0
            c, s = cosine.rational, sine.rational
            angle.half_tangent = None if c is None or s is None else s / (1 + c)
            angle.share = _share_of_pi(angle)
            cls._interned[cosine.key] = angle
        return angle

    def __reduce__(self) -> tuple[Callable[..., _Angle], tuple[Real, Real]]:
        return _Angle.make, (self.cosine, self.sine)

    def ball(self, bits: int) -> arb:
        """Enclosure with at least *bits* working bits."""
        if self._bits < bits:
            with ctx.workprec(bits):
                if self.half_tangent is not None:
                    ball = 2 * arb(self.half_tangent).atan()
                else:
                    ball = arb.atan2(self.sine.ball(bits), self.cosine.ball(bits))
            self._ball, self._bits = ball, bits
        return self._ball


def _share_of_pi(angle: _Angle) -> fmpq | None:
    """angle/pi if it is rational with denominator up to `MAX_DENOMINATOR`, proved; else None.

    The ball proposes p/q; then the angle t is p pi/q if and only if 2 cos 2t is a root of the minimal
    polynomial of 2 cos(2 pi/q).
    """
    if angle.half_tangent is not None:
        return None  # Niven: no rational multiple of pi in (0, pi/4] has rational cosine and sine.
    with ctx.workprec(64):
        share = float((angle.ball(64) / arb.pi()).mid())
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


def _fold(cosine: Real, sine: Real) -> tuple[fmpq, fmpq, _Angle | None]:
    """(q, s, t) with: the angle in [0, 2 pi) of cosine + i sine is q pi + s t; s is 1, 1/2 or minus that.

    Where only the double angle has rational cosine and sine, as that of atan(1/7), t is the double angle:
    so that stage 3 can decide it completely.
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
            twice, scale, angle = _fold(x, y)
            return share + sign * twice / 2, sign * scale / 2, angle
    angle = _Angle.make(cosine, sine)
    return (share, sign, angle) if angle.share is None else (share + sign * angle.share, sign, None)


class Length:
    """An exact length (or area): ``Length(value)`` of a number or Real; arcs by `arc` and `turns`.

    Lengths add, subtract and scale by numbers exactly, and compare with each other and with numbers.
    Comparisons are a total order, or raise `Undecided` (stage 5 above).  Not hashable: equal values
    may have different expressions.  The empty sum, and a full circle of radius 0, are 0.
    """

    __slots__ = ("_algebraic", "_angles", "_ball", "_bits", "_sign", "_turn")

    _algebraic: Real
    _turn: Real
    _angles: Mapping[_Angle, Real]
    _ball: arb
    _bits: int
    _sign: int | None

    __hash__ = None  # type: ignore[assignment]

    def __new__(cls, value: object = 0) -> Length:
        return value if isinstance(value, Length) else cls._make(Real(value), Real(0), {})

    @classmethod
    def _make(cls, algebraic: Real, turn: Real, angles: Mapping[_Angle, Real]) -> Length:
        self = object.__new__(cls)
        self._algebraic, self._turn, self._angles = algebraic, turn, angles
        self._bits, self._sign = 0, None
        return self

    @classmethod
    def arc(cls, coefficient: Number, cosine: Number, sine: Number) -> Length:
        """*coefficient* times the angle in [0, 2 pi) of the complex number cosine + i sine.

        ValueError if that number is not on the unit circle: exact for rational coordinates, else the
        caller's promise, checked to 64 bits.
        """
        scale = Real(coefficient)
        share, sign, angle = _fold(Real(cosine), Real(sine))
        angles = {} if angle is None or scale.rational == 0 else {angle: scale * sign}
        return cls._make(Real(0), scale * share, angles)

    @classmethod
    def turns(cls, coefficient: Number, k: object = 1) -> Length:
        """*coefficient* times k full turns, ``2 pi k coefficient``, for a rational k."""
        return cls._make(Real(0), Real(coefficient) * (2 * rational(k)), {})

    @classmethod
    def sum(cls, values: Iterable[Length | Number]) -> Length:
        """The exact sum; linear in the number of terms."""
        parts = [Length(value) for value in values]
        collected: dict[_Angle, list[Real]] = {}
        for part in parts:
            for angle, c in part._angles.items():
                collected.setdefault(angle, []).append(c)
        angles = {angle: cs[0] if len(cs) == 1 else Real.sum(cs) for angle, cs in collected.items()}
        return cls._make(
            Real.sum(part._algebraic for part in parts),
            Real.sum(part._turn for part in parts),
            {angle: c for angle, c in angles.items() if c.rational != 0},
        )

    def __reduce__(self) -> tuple[Callable[..., Length], tuple[Real, Real, dict[_Angle, Real]]]:
        return Length._make, (self._algebraic, self._turn, dict(self._angles))

    @property
    def algebraic(self) -> Real:
        """The part without pi and angles."""
        return self._algebraic

    @property
    def _is_algebraic(self) -> bool:
        return not self._angles and self._turn.rational == 0

    # -- arithmetic --------------------------------------------------------------------------

    def __add__(self, other: object) -> Length:
        right = _coerce(other)
        if right is None:
            return NotImplemented
        large, small = (self, right) if len(self._angles) >= len(right._angles) else (right, self)
        angles = large._angles
        if small._angles:
            angles = dict(angles)
            for angle, c in small._angles.items():
                both = angles[angle] + c if angle in angles else c
                if both.rational == 0:
                    del angles[angle]
                else:
                    angles[angle] = both
        total = Length._make(self._algebraic + right._algebraic, self._turn + right._turn, angles)
        bits = min(self._bits, right._bits)
        if bits:  # A running total of n pieces would otherwise evaluate all n again.
            with ctx.workprec(bits):
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
        if not isinstance(other, NUMBERS):
            return NotImplemented
        q = Real(other)
        angles = {} if q.rational == 0 else {angle: c * q for angle, c in self._angles.items()}
        return Length._make(self._algebraic * q, self._turn * q, angles)

    __rmul__ = __mul__

    def __truediv__(self, other: object) -> Length:
        return self * (1 / Real(other)) if isinstance(other, NUMBERS) else NotImplemented

    # -- order -------------------------------------------------------------------------------

    def sign(self) -> int:
        """-1, 0 or 1, decided exactly; raises `Undecided` beyond the limits above."""
        if self._sign is None:
            self._sign = self._decide_sign()
        return self._sign

    def _decide_sign(self) -> int:
        if self._is_algebraic:
            return self._algebraic.sign()
        for bits in FILTER_BITS:
            if sign := _ball_sign(self.ball(bits)):
                return sign
        if self._algebraic.sign() != 0:
            return self._refined_sign()
        basis = _eliminated(_in_gaussian_basis(Length._make(Real(0), self._turn, self._angles)))
        turn, angles = basis._turn.sign(), basis._angles
        if not angles:
            return turn
        if all(angle.half_tangent is not None for angle in angles) or (len(angles) == 1 and not turn):
            return self._refined_sign()
        sign = self._refined_sign(UNDECIDED_BITS)
        if sign == 0:
            raise Undecided(
                f"sign of a sum of {len(angles)} angles: it is below 2^-{UNDECIDED_BITS}, "
                "and neither proved nor refuted to be 0"
            )
        return sign

    def _refined_sign(self, limit: int | None = None) -> int:
        """The sign of a number that is not 0; with *limit*, 0 if the sign does not show up to there."""
        bits = FILTER_BITS[-1]
        while limit is None or bits < limit:
            bits *= 2
            if sign := _ball_sign(self.ball(bits)):
                return sign
        return 0

    def compare(self, other: object) -> int:
        """-1, 0 or 1 as self is less than, equal to or greater than *other*."""
        right = _coerce(other)
        if right is None:
            raise TypeError(f"cannot compare a length with {type(other).__name__}")
        if self is right:
            return 0
        if self._is_algebraic and right._is_algebraic:
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

    def __eq__(self, other: object) -> bool:
        return NotImplemented if _coerce(other) is None else self.compare(other) == 0

    def __lt__(self, other: object) -> bool:
        return NotImplemented if _coerce(other) is None else self.compare(other) < 0

    def __le__(self, other: object) -> bool:
        return NotImplemented if _coerce(other) is None else self.compare(other) <= 0

    def __gt__(self, other: object) -> bool:
        return NotImplemented if _coerce(other) is None else self.compare(other) > 0

    def __ge__(self, other: object) -> bool:
        return NotImplemented if _coerce(other) is None else self.compare(other) >= 0

    def __bool__(self) -> bool:
        return self.sign() != 0

    # -- values ------------------------------------------------------------------------------

    def ball(self, bits: int) -> arb:
        """An enclosing ball computed with *bits* working bits (more if cached)."""
        if self._bits < bits:
            with ctx.workprec(bits):
                ball = self._algebraic.ball(bits)
                if self._turn.rational != 0:
                    ball += self._turn.ball(bits) * arb.pi()
                for angle, c in self._angles.items():
                    ball += c.ball(bits) * angle.ball(bits)
            self._ball, self._bits = ball, bits
        return self._ball

    def enclosure(self, bits: int) -> tuple[fmpq, fmpq]:
        """Rational (low, high) around the value, at most 2^-bits apart; exact if rational."""
        if self._is_algebraic:
            return self._algebraic.enclosure(bits)
        return enclose(self.ball, bits)

    def __float__(self) -> float:
        """The nearest float, ties to even."""
        if self._is_algebraic:
            return float(self._algebraic)
        return round_to_float(self.ball, lambda middle: self.compare(middle) == 0) + 0.0  # never -0.0

    def decimal(self, digits: int) -> str:
        """The value with *digits* significant digits, correctly rounded to one unit in the last."""
        if _ball_sign(self.ball(FILTER_BITS[-1])) == 0 and self.sign() == 0:
            return "0"
        return decimal_string(self.ball, digits)

    def sympy(self) -> sympy.Expr:
        """The closed form as a sympy expression, full turns and proved relations folded to pi."""
        from sympy import Add, pi

        turn, terms = _readable(self)
        angles = (c.sympy() * angle for c, angle in terms)
        return Add(self._algebraic.sympy(), turn.sympy() * pi, *angles)

    def latex(self) -> str:
        """The closed form in LaTeX."""
        from sympy import latex

        return str(latex(self.sympy()))

    def __str__(self) -> str:
        return str(self._algebraic if self._is_algebraic else self.sympy())

    def __repr__(self) -> str:
        if self._is_algebraic and self._algebraic.rational is not None:
            return f"Length({str(self)!r})"
        return f"<Length {self.ball(64).str(15, radius=False)}>"


def _coerce(value: object) -> Length | None:
    if isinstance(value, Length):
        return value
    return Length(value) if isinstance(value, NUMBERS) else None


def _ball_sign(ball: arb) -> int:
    return 1 if ball > 0 else -1 if ball < 0 else 0


# -- angles with rational cosine and sine: a basis from factors in Z[i] --------------------------


def _in_gaussian_basis(length: Length) -> Length:
    """The same value, its angles of rational cosine and sine replaced by independent ones.

    Such an angle is twice the argument of w = q + i p, tan(angle/2) = p/q.  Split the norms of all w
    into coprime factors n; then w is a unit times a power of 1 + i times powers of Gaussian integers
    of norm n, pairwise coprime with each other and with their conjugates, so the angles of the
    quotients g/conj(g) are linearly independent with pi, by unique factorisation.
    """
    simple = [angle for angle in length._angles if angle.half_tangent is not None]
    if not simple:
        return length
    others = {angle: c for angle, c in length._angles.items() if angle.half_tangent is None}
    parts = [Length._make(length._algebraic, length._turn, others)]
    generators: dict[tuple[int, int], Length] = {}
    for angle, powers in _gaussian_powers(simple).items():
        for ideal in powers:
            if ideal not in generators:
                x, y = _generator(*ideal)
                n = ideal[0]
                generators[ideal] = Length.arc(1, fmpq(x * x - y * y, n), fmpq(2 * x * y, n))
        image = Length.sum(generators[ideal] * e for ideal, e in powers.items())
        image += Length.turns(QUARTER, _whole_quarters(_combination({angle: 1}) - image))
        parts.append(image * length._angles[angle])
    return Length.sum(parts)


def _combination(powers: Mapping[_Angle, int]) -> Length:
    return Length._make(Real(0), Real(0), {angle: Real(m) for angle, m in powers.items()})


def _whole_quarters(length: Length) -> int:
    """length / (pi/2), known to be an integer."""
    bits = FILTER_BITS[0]
    while True:
        with ctx.workprec(bits):
            quarters = 2 * length.ball(bits) / arb.pi()
        whole = quarters.unique_fmpz()
        if whole is not None:
            return int(whole)
        bits *= 2


def _gaussian_powers(angles: list[_Angle]) -> dict[_Angle, dict[tuple[int, int], int]]:
    """For each angle the exponents of the ideals (n, r) in w = q + i p, negative for the conjugate.

    The n are pairwise coprime and odd; r is a square root of -1 mod n and (n, r) the ideal of Gaussian
    integers x + i y with x = r y mod n.
    """
    norms, factors = {}, {}
    for angle in angles:
        p, q = int(angle.half_tangent.p), int(angle.half_tangent.q)  # type: ignore[union-attr]
        norm = p * p + q * q
        norms[angle] = norm if norm % 2 else norm // 2
        if norm.bit_length() <= FACTOR_BITS:
            factors[angle] = [int(prime) for prime, _ in fmpz(norms[angle]).factor()]
    large = [angle for angle in angles if angle not in factors]
    if large:
        primes = set().union(*factors.values())
        base = primes | set(_split_large(large, norms, primes))
        for angle in large:
            factors[angle] = [n for n in base if norms[angle] % n == 0]
    result = {}
    for angle in angles:
        powers = {}
        for n in factors[angle]:
            root = _root_of_minus_one(angle, n)
            powers[n, min(root, n - root)] = _valuation(norms[angle], n) * (1 if 2 * root < n else -1)
        result[angle] = powers
    return result


def _split_large(angles: list[_Angle], norms: Mapping[_Angle, int], primes: Iterable[int]) -> list[int]:
    """A coprime base of the norms without *primes*, fine enough that all roots of -1 agree up to sign.

    Quadratic in the number of angles, which are those with norms beyond `FACTOR_BITS`.
    """
    rests = []
    for angle in angles:
        rest = norms[angle]
        for prime in primes:
            rest //= prime ** _valuation(rest, prime)
        rests.append((rest, _root_of_minus_one(angle, rest)))
    numbers = [n for n, _ in rests]
    for (m, r), (n, s) in combinations(rests, 2):
        common = gcd(m, n)
        numbers += [gcd(common, r - s), gcd(common, r + s)]
    return _coprime_base(numbers)


def _root_of_minus_one(angle: _Angle, n: int) -> int:
    u = angle.half_tangent
    return int(u.q) * pow(int(u.p), -1, n) % n  # type: ignore[union-attr]


def _coprime_base(numbers: Iterable[int]) -> list[int]:
    """Pairwise coprime numbers > 1 of which each given number is a product of powers."""
    base: list[int] = []
    todo = [n for n in numbers if n > 1]
    while todo:
        n = todo.pop()
        for index, m in enumerate(base):
            common = gcd(m, n)
            if common > 1:
                del base[index]
                todo += [k for k in (m // common, common, n // common) if k > 1]
                break
        else:
            base.append(n)
    return base


def _valuation(number: int, base: int) -> int:
    exponent = 0
    while number % base == 0:
        number //= base
        exponent += 1
    return exponent


def _generator(n: int, root: int) -> tuple[int, int]:
    """(x, y) with x^2 + y^2 = n and x = root y mod n, for root^2 = -1 mod n (Hermite, Serret)."""
    (a, s), (b, t) = (n, 0), (root, 1)
    while b > isqrt(n):
        quotient = a // b
        (a, s), (b, t) = (b, t), (a - quotient * b, s - quotient * t)
    return b, t


# -- angles with algebraic cosine and sine: proposed and proved relations ------------------------


def _eliminated(length: Length) -> Length:
    """The same value with the terms of coefficient 0 and all angles that are proved dependent removed."""
    angles = {angle: c for angle, c in length._angles.items() if c.sign() != 0}
    length = Length._make(length._algebraic, length._turn, angles)
    for bundle in _bundles(angles):
        while (relation := _relation([t for t in bundle if t in length._angles])) is not None:
            # The relation is a sum that is 0: subtract the multiple that cancels one angle.
            pivot = min(
                (angle for angle in relation._angles if angle.half_tangent is None),
                key=lambda angle: abs(relation._angles[angle]),
            )
            factor = length._angles[pivot] / relation._angles[pivot]
            length -= relation * factor
            rest = {angle: c for angle, c in length._angles.items() if c.sign() != 0}
            length = Length._make(length._algebraic, length._turn, rest)
    return length


def _bundles(angles: Mapping[_Angle, Real]) -> list[list[_Angle]]:
    """The sets in which relations are sought: all angles if few, else those of commensurable radii."""
    if len(angles) <= RELATION_ANGLES:
        return [list(angles)]
    bundles: list[tuple[Real, list[_Angle]]] = []
    for angle, c in angles.items():
        for first, bundle in bundles:
            if c.rational_ratio(first) is not None:
                bundle.append(angle)
                break
        else:
            bundles.append((c, [angle]))
    return [bundle for _, bundle in bundles if len(bundle) <= RELATION_ANGLES]


def _relation(angles: list[_Angle]) -> Length | None:
    """A proved sum ``m_1 t_1 + ... + m_k t_k - j pi/2 = 0`` with an irrational t_i, or None."""
    if all(angle.half_tangent is not None for angle in angles):
        return None
    size = len(angles) + 1
    bits = 64 * size
    rows = [[int(i == k) for i in range(size - 1)] for k in range(size)]
    with ctx.workprec(bits + 64):
        for angle, row in zip(angles, rows, strict=False):
            share = 2 * angle.ball(bits + 64) / arb.pi()
            row.append(int((share.mid() * fmpz(2) ** bits).floor().unique_fmpz()))
    rows[-1].append(1 << bits)
    # A chance relation has coefficients of about 64 bits: the light rows are worth a proof.
    for row in fmpz_mat(rows).lll().tolist():
        powers = {angle: int(m) for angle, m in zip(angles, row, strict=False) if m}
        weight = sum(abs(m) for m in powers.values())
        if weight and weight <= RELATION_WEIGHT and (proved := _proved(powers)) is not None:
            return proved
    return None


def _proved(powers: Mapping[_Angle, int]) -> Length | None:
    """The sum of m t minus its multiple of pi/2 if the product of e^{i m t} proves it to be 0."""
    if all(angle.half_tangent is not None for angle in powers):
        return None
    total = _combination(powers)
    with ctx.workprec(FILTER_BITS[-1]):
        share = 2 * total.ball(FILTER_BITS[-1]) / arb.pi()
        whole = int((share.mid() + HALF).floor().unique_fmpz())
        if not abs(share - whole) < arb(2) ** -128:
            return None
    left = _unit_product((angle, m) for angle, m in powers.items() if m > 0)
    right = _unit_product((angle, -m) for angle, m in powers.items() if m < 0)
    for _ in range(whole % 4):
        right = (-right[1], right[0])
    # Both are points of the unit circle, closer than 2^-100: one coordinate decides, where it is steep.
    flat = next((i for i in (0, 1) if abs(left[i].ball(128)) > HALF), None)
    try:
        proved = flat is not None and left[1 - flat] == right[1 - flat]
    except Undecided:
        return None
    return total - Length.turns(QUARTER, whole) if proved else None


def _unit_product(powers: Iterable[tuple[_Angle, int]]) -> tuple[Real, Real]:
    """Cosine and sine of the sum of m t."""
    x, y = Real(1), Real(0)
    for angle, exponent in powers:
        c, s = angle.cosine, angle.sine
        for bit in range(exponent.bit_length()):
            if bit:
                c, s = c * c - s * s, 2 * c * s
            if exponent >> bit & 1:
                x, y = x * c - y * s, x * s + y * c
    return x, y


# -- closed form -------------------------------------------------------------------------------


def _readable(length: Length) -> tuple[Real, list[tuple[Real, sympy.Expr]]]:
    """The multiple of pi and the terms (coefficient, angle) as a person would write them.

    Relations are used where they leave fewer angles; then few angles are replaced by complements or
    supplements so that pi disappears, or else so that coefficients are positive and pi's is simple.
    """
    with suppress(Undecided):  # The form as it stands is right, too.
        length = _eliminated(length)
    if 1 < len(length._angles) <= RELATION_ANGLES:
        length = min(length, _in_gaussian_basis(length), key=lambda form: len(form._angles))
    # t = sign u + share pi for each way to write t by another angle u
    ways = ((1, fmpq(0)), (-1, HALF), (1, -HALF), (-1, fmpq(1)))
    items = list(length._angles.items())

    def turn(choice: tuple[int, ...]) -> Real:
        return length._turn + Real.sum(c * ways[i][1] for i, (_, c) in zip(choice, items, strict=True))

    def cost(choice: tuple[int, ...]) -> tuple[object, ...]:
        q = turn(choice)
        negative = sum(c.ball(64) * ways[i][0] < 0 for i, (_, c) in zip(choice, items, strict=True))
        return q.rational != 0, negative, int(q.rational.q) if q.rational is not None else 0, sum(choice)

    choice = (0,) * len(items)
    if len(items) <= DISPLAY_ANGLES:
        choice = min(product(range(4), repeat=len(items)), key=cost)
    terms = [(c * ways[i][0], _angle_sympy(angle, i)) for i, (angle, c) in zip(choice, items, strict=True)]
    return turn(choice), terms


def _angle_sympy(angle: _Angle, way: int) -> sympy.Expr:
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
