"""First fields of towers of square roots: that of one root of a polynomial, and that of any number.

Elements of the field of a root of an irreducible integer polynomial are polynomials in the root; the
rationals are the field of the root 0 of x. Those of the field of any number are its rational functions: what
is equal there is equal whatever number it is, which itself comes in only where its ball tells which of two
square roots is meant.
"""

from __future__ import annotations

from functools import cached_property
from itertools import product

from flint import acb, arb, fmpq, fmpq_poly, fmpz, fmpz_poly

from exactacq.numbers.atoms import Atom, Node, Root
from exactacq.numbers.precision import workprec

MOST_DEGREE = 8
"""Square roots are not looked for in fields of a higher degree: signs of all conjugates are tried."""
BITS = 128
"""Working bits beyond those of an element's coefficients that are tried first for its roots."""
WIDE = 0.25
"""Balls with a smaller radius hold at most one integer."""

UNIT, X = fmpq_poly([1]), fmpq_poly([0, 1])


class NumberField:
    """The field of real root number *index* of an irreducible polynomial of ascending *coefficients*.

    >>> cubic = NumberField((-2, 0, 0, 1), 0)
    >>> cubic.inverse(fmpq_poly([0, 1]))
    1/2*x^2
    >>> cubic.square_root(fmpq_poly([1, 2, 1])), cubic.square_root(fmpq_poly([2]))
    (x + 1, None)
    """

    def __init__(self, coefficients: tuple[int, ...] = (0, 1), index: int = 0) -> None:
        self.polynomial = fmpz_poly(list(coefficients))
        self.modulus = fmpq_poly(self.polynomial)
        self.degree = self.polynomial.degree()
        self._root: Node | None = Root.make(coefficients, index, 1) if self.degree > 1 else None

    def constant(self, value: fmpq | int) -> fmpq_poly:
        """A rational as an element."""
        return fmpq_poly([value])

    def of_atom(self, atom: Atom) -> fmpq_poly | None:
        """A power of the root; None for what is not in the field."""
        return fmpq_poly([*[0] * atom.args[2], 1]) if isinstance(atom, Root) else None

    def size(self, a: fmpq_poly) -> int:
        """Bits of an element, roughly."""
        return len(a) * int(a.numer().height_bits() + a.denom().bit_length())

    def times(self, a: fmpq_poly, b: fmpq_poly) -> fmpq_poly:
        """The product of two elements."""
        return a * b if self.degree == 1 else a * b % self.modulus

    def inverse(self, c: fmpq_poly) -> fmpq_poly:
        """1 over an element that is not 0."""
        if c.degree() == 0:
            return fmpq_poly([1 / c[0]])
        common, inverse, _ = c.xgcd(self.modulus)
        return inverse / common[0]

    def square_root(self, c: fmpq_poly) -> fmpq_poly | None:
        """A square root of an element if the field holds one, else None (beyond `MOST_DEGREE` always).

        Let f be the polynomial, a its root, and f(x) / (x - a) = sum of d_i x^i: the d_i are algebraic
        integers. So if s is one too, the traces T_i of s d_i are integers, and s f'(a) = sum of T_i a^i
        (Euler's dual basis).
        """
        if c.degree() <= 0 and c[0] >= 0 and (c[0].p * c[0].q).is_square():
            return fmpq_poly([(c[0].p * c[0].q).isqrt()]) / c[0].q
        if not 1 < self.degree <= MOST_DEGREE:
            return None
        lead = self.polynomial.leading_coefficient()
        # The norm of a square is a square.
        norm = self.polynomial.resultant(c.numer()) * lead ** c.degree() * c.denom() ** self.degree
        if norm < 0 or not norm.is_square():
            return None
        scale = c.denom() * lead ** (self.degree - 1)
        whole = c * scale * scale
        for traces in self._traces(whole.numer()):
            root = fmpq_poly(traces) * self._inverse_slope % self.modulus
            if self.times(root, root) == whole:
                return root / scale
        return None

    @cached_property
    def _inverse_slope(self) -> fmpq_poly:
        return self.inverse(self.modulus.derivative())

    def _traces(self, c: fmpz_poly) -> list[list[fmpz]]:
        """Integers that may be the traces of s d_i with s^2 = c: all that balls leave over."""
        bits = int(c.height_bits()) + BITS
        while True:
            with workprec(bits):
                shares = self._shares(c)
                if shares is None:
                    return []
                if all(sum(share[i].rad() for share in shares) < WIDE for i in range(self.degree)):
                    first, *others = shares
                    signs = product((1, -1), repeat=len(others))
                    return [found for some in signs if (found := self._integers(first, others, some))]
            bits *= 2

    def _integers(self, first: list[arb], others: list[list[arb]], signs: tuple[int, ...]) -> list[fmpz]:
        """The sums of all shares with some signs, empty if one of them is no integer."""
        found: list[fmpz] = []
        for i in range(self.degree):
            total = first[i]
            for share, sign in zip(others, signs, strict=True):
                total = total + share[i] if sign > 0 else total - share[i]
            trace = total.unique_fmpz()
            if trace is None:
                return []
            found.append(trace)
        return found

    def _shares(self, c: fmpz_poly) -> list[list[arb]] | None:
        """What each root of f, with its conjugate, adds to the traces, up to a sign; None if s cannot be.

        The root of what c is there is taken away from the negative axis, where it would jump.
        """
        shares: list[list[arb]] = []
        for place, _ in self.polynomial.complex_roots():
            is_real = place.imag == 0
            value = c(place)
            if is_real and value.real < 0:
                return None
            if is_real or place.imag > 0:
                root = (-value).sqrt() * acb(0, 1) if value.real.mid() < 0 else value.sqrt()
                share, dual = [], acb(self.polynomial[self.degree])
                for k in reversed(range(self.degree)):
                    term = root * dual
                    share.append(term.real if is_real else 2 * term.real)
                    dual = dual * place + self.polynomial[k]
                shares.append(share[::-1])
        return shares

    def ball(self, c: fmpq_poly, bits: int) -> arb:
        """An enclosure of an element, with *bits* working bits that the caller has set."""
        if self._root is None or c.degree() <= 0:
            return arb(c[0])
        root, total = self._root.ball(bits), arb(0)
        for coefficient in reversed(c.numer().coeffs()):
            total = total * root + coefficient
        return total / c.denom()


class RationalFunction:
    """A rational function over Q."""

    __slots__ = ("bottom", "top")

    def __init__(self, top: fmpq_poly, bottom: fmpq_poly = UNIT) -> None:
        # In lowest terms, monic below: equal ones are equal term by term.
        if bottom.degree() > 0:
            common = top.gcd(bottom)
            if common.degree() > 0:
                top, bottom = top // common, bottom // common
        lead = bottom.leading_coefficient()
        self.top, self.bottom = (top, bottom) if lead == 1 else (top / lead, bottom / lead)

    def __bool__(self) -> bool:
        return not self.top.is_zero()

    def __neg__(self) -> RationalFunction:
        return RationalFunction(-self.top, self.bottom)

    def __add__(self, other: RationalFunction) -> RationalFunction:
        if self.bottom == other.bottom:
            return RationalFunction(self.top + other.top, self.bottom)
        return RationalFunction(self.top * other.bottom + other.top * self.bottom, self.bottom * other.bottom)

    def __mul__(self, other: RationalFunction | fmpq | int) -> RationalFunction:
        if isinstance(other, RationalFunction):
            return RationalFunction(self.top * other.top, self.bottom * other.bottom)
        return RationalFunction(self.top * other, self.bottom)

    __rmul__ = __mul__


class RationalFunctions:
    """The field over Q of a number *tau*, of which nothing is known but balls.

    >>> from exactacq.numbers.atoms import Root
    >>> atom = Root.make((-2, 0, 0, 1), 0, 1)
    >>> field = RationalFunctions(atom)
    >>> tau = field.of_atom(atom)
    >>> field.square_root(tau * tau + 2 * tau + field.constant(1)).top, field.square_root(tau)
    (x + 1, None)
    """

    degree = 1

    def __init__(self, tau: Node) -> None:
        self.tau = tau

    def constant(self, value: fmpq | int) -> RationalFunction:
        """A rational as an element."""
        return RationalFunction(fmpq_poly([value]))

    def of_atom(self, atom: Atom) -> RationalFunction | None:
        """The number itself; None for others, which are not in the field."""
        return RationalFunction(X) if atom is self.tau else None

    def times(self, a: RationalFunction, b: RationalFunction) -> RationalFunction:
        """The product of two elements."""
        return a * b

    def inverse(self, a: RationalFunction) -> RationalFunction:
        """1 over an element that is not 0."""
        return RationalFunction(a.bottom, a.top)

    def square_root(self, a: RationalFunction) -> RationalFunction | None:
        """A square root of an element if the field holds one, else None."""
        content, factors = (a.top * a.bottom).factor()
        content = fmpq(content)
        if content < 0 or not (content.p * content.q).is_square() or any(e % 2 for _, e in factors):
            return None
        root = fmpq_poly([fmpq((content.p * content.q).isqrt(), content.q)])
        for factor, exponent in factors:
            root *= fmpq_poly(factor) ** (exponent // 2)
        return RationalFunction(root, a.bottom)

    def size(self, a: RationalFunction) -> int:
        """Bits of an element, roughly."""
        parts = (a.top, a.bottom)
        return sum(len(p) * int(p.numer().height_bits() + p.denom().bit_length()) for p in parts)

    def ball(self, a: RationalFunction, bits: int) -> arb:
        """An enclosure of an element, with *bits* working bits that the caller has set."""
        tau = self.tau.ball(bits)
        return _at(a.top, tau) / _at(a.bottom, tau)


def _at(polynomial: fmpq_poly, place: arb) -> arb:
    total = arb(0)
    for coefficient in reversed(polynomial.coeffs()):
        total = total * place + arb(coefficient)
    return total
