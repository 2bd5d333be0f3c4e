"""Zero test in towers of square roots, by norms.

A real made of rationals and nested square roots is a fraction N / D of polynomials in its radicals t_1,
..., t_k, linear in each, where t_i^2 is such a polynomial in earlier radicals. Split by the last one,
N = A + B t, it is 0 only if A^2 - B^2 t^2 is, a polynomial in one radical less; and if that is 0, then N or
A - B t is 0, and balls decide which. Radicals may depend on each other: nothing is assumed to be a field. The
coefficients are integers or, where the real holds a root of higher degree, elements of that root's field.
The norms of a true zero cancel after few steps, whatever the degree of the numbers in it.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from flint import arb, fmpq_poly, fmpz

from exactacq.numbers.atoms import Form, Inverse, Node, Product, Root, Sqrt
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import ball_sign, coprime_base

Coefficient: TypeAlias = "fmpz | fmpq_poly"
Polynomial: TypeAlias = "dict[int, Any]"
"""Coefficients by monomial: bit i of the key tells whether t_i is a factor."""
Fraction: TypeAlias = "tuple[Polynomial, Polynomial]"

MOST_RADICALS = 12
MOST_TERMS = 1 << 18
"""Products of terms after which a test gives up: a few seconds of work at most."""
WORDS = 512
"""Machine words of a factor that take as long as one product of short terms."""
BITS = 256


class _TooLong(Exception):
    """The test would take too long."""


def vanishes(value: Form) -> bool | None:
    """Whether a real is 0; None if it holds several other roots, or the test would take too long."""
    try:
        tower = _Tower(value)
        return tower.is_zero(tower.fraction(value)[0])
    except _TooLong:
        return None


class _Tower:
    def __init__(self, value: Form) -> None:
        self.squares: list[Polynomial] = []
        self.balls: list[tuple[Node | int, Polynomial | None]] = []
        self.known: dict[Node, Fraction] = {}
        self.work, self.field = 0, _field(value)
        for d in sorted(coprime_base(_radicands(value))):
            self._radical({0: self._constant(fmpz(d))}, d, None)

    def _constant(self, n: fmpz) -> Coefficient:
        return n if self.field is None else fmpq_poly([n])

    def _radical(self, square: Polynomial, source: Node | int, factor: Polynomial | None) -> Polynomial:
        """A new radical: the root of an integer, or a node times a factor; given with its square."""
        if len(self.squares) == MOST_RADICALS:
            raise _TooLong
        self.squares.append(square)
        self.balls.append((source, factor))
        return {1 << (len(self.squares) - 1): self._constant(fmpz(1))}

    # -- reals as fractions ------------------------------------------------------------------------

    def fraction(self, value: Form) -> Fraction:
        """Numerator and denominator (not 0) of a real."""
        scale = fmpz(1)
        for c in value.terms.values():
            scale = scale.lcm(c.q)
        top: Polynomial = {}
        bottom: Polynomial = {0: self._constant(fmpz(1))}
        for atom, c in value.terms.items():
            n, d = self._root_of(atom) if isinstance(atom, int) else self._node(atom)
            n = {m: q * (c * scale).p for m, q in n.items()}
            if d == bottom:
                top = _sum(top, n)
            else:
                top = _sum(self.times(top, d), self.times(n, bottom))
                bottom = self.times(bottom, d)
        bottom = {m: q * scale for m, q in bottom.items()}
        return _primitive(top, bottom) if self.field is None else (top, bottom)

    def _root_of(self, d: int) -> Fraction:
        """The root of an integer as a rational multiple of a product of the tower's integer radicals."""
        mask, rest = 0, fmpz(d)
        side = fmpz(1)
        for i, (source, _) in enumerate(self.balls):
            if isinstance(source, int):
                power = 0
                while rest % source == 0:
                    rest, power = rest // source, power + 1
                side *= fmpz(source) ** (power // 2)
                mask |= (power % 2) << i
        assert rest == 1, "the radicals of integers divide every radicand"
        return {mask: self._constant(side)}, {0: self._constant(fmpz(1))}

    def _node(self, node: Node) -> Fraction:
        if node not in self.known:
            if isinstance(node, Sqrt):
                top, bottom = self.fraction(node.args[0])
                # s = sqrt(N / D) is t / D with t = s D, t^2 = N D
                self.known[node] = self._radical(self.times(top, bottom), node, bottom), bottom
            elif isinstance(node, Product):
                (a, b), (c, d) = (self.fraction(factor) for factor in node.args)
                self.known[node] = self.times(a, c), self.times(b, d)
            elif isinstance(node, Inverse):
                top, bottom = self.fraction(node.args[0])
                self.known[node] = bottom, top
            else:
                assert isinstance(node, Root)
                power = fmpq_poly([*[0] * node.args[2], 1])
                self.known[node] = {0: power}, {0: self._constant(fmpz(1))}
        return self.known[node]

    # -- arithmetic --------------------------------------------------------------------------------

    def times(self, a: Polynomial, b: Polynomial) -> Polynomial:
        """The product, with squares of radicals replaced."""
        self.work += len(a) * len(b) * (1 if self.field is None else self.field[0].degree() ** 2)
        self.work += (len(b) * _words(a) + len(a) * _words(b)) // WORDS
        if self.work > MOST_TERMS:
            raise _TooLong
        plain: dict[tuple[int, int], Any] = {}
        for m, p in a.items():
            for n, q in b.items():
                key = m ^ n, m & n
                plain[key] = plain[key] + p * q if key in plain else p * q
        if self.field is not None:
            plain = {key: c % self.field[0] for key, c in plain.items()}
        result: Polynomial = {}
        squared: dict[int, Polynomial] = {}
        for (mask, twice), c in plain.items():
            if twice:
                squared.setdefault(twice, {})[mask] = c
            else:
                result[mask] = c
        for twice, rest in squared.items():
            part = {m: c for m, c in rest.items() if c}
            for i in range(twice.bit_length()):
                if twice >> i & 1:
                    part = self.times(part, self.squares[i])
            result = _sum(result, part)
        return {m: c for m, c in result.items() if c}

    def is_zero(self, value: Polynomial) -> bool:
        """Whether the number that a polynomial stands for is 0."""
        if set(value) <= {0}:
            return not value
        if ball_sign(self._ball(value, BITS)):
            return False
        top = max(value).bit_length() - 1
        a = {m: c for m, c in value.items() if not m >> top & 1}
        b = {m ^ (1 << top): c for m, c in value.items() if m >> top & 1}
        square = self.times(self.times(b, b), self.squares[top])
        if not self.is_zero(_sum(self.times(a, a), {m: -c for m, c in square.items()})):
            return False
        if self.is_zero(b):
            return True
        # A and B t are equal up to the sign and not 0: of A + B t and A - B t exactly one is 0.
        conjugate = _sum(a, {m | (1 << top): -c for m, c in b.items()})
        bits = BITS
        while True:
            if ball_sign(self._ball(value, bits)):
                return False
            if ball_sign(self._ball(conjugate, bits)):
                return True
            bits *= 2

    def _ball(self, value: Polynomial, bits: int) -> arb:
        with workprec(bits):
            total = arb(0)
            for mask, c in value.items():
                term = arb(c) if self.field is None else self._evaluated(c, bits)
                for i in range(mask.bit_length()):
                    if mask >> i & 1:
                        term *= self._radical_ball(i, bits)
                total += term
        return total

    def _evaluated(self, c: fmpq_poly, bits: int) -> arb:
        assert self.field is not None
        root, total = self.field[1].ball(bits), arb(0)
        for coefficient in reversed(c.coeffs()):
            total = total * root + arb(coefficient)
        return total

    def _radical_ball(self, i: int, bits: int) -> arb:
        source, factor = self.balls[i]
        if isinstance(source, int):
            return arb(source).sqrt()
        assert factor is not None
        return source.ball(bits) * self._ball(factor, bits)


def _sum(a: Polynomial, b: Polynomial) -> Polynomial:
    result = dict(a)
    for m, c in b.items():
        total = result[m] + c if m in result else c
        if total:
            result[m] = total
        else:
            result.pop(m, None)
    return result


def _words(a: Polynomial) -> int:
    """Machine words of all coefficients."""
    return sum(_bits(c) for c in a.values()) >> 6


def _bits(c: Coefficient) -> int:
    if isinstance(c, fmpz):
        return int(c.bit_length())
    return len(c) * int(c.numer().height_bits() + c.denom().bit_length())


def _primitive(top: Polynomial, bottom: Polynomial) -> Fraction:
    """A fraction without the integers that divide all its coefficients."""
    common = fmpz(0)
    for c in (*top.values(), *bottom.values()):
        common = common.gcd(c)
    if common <= 1:
        return top, bottom
    return {m: c // common for m, c in top.items()}, {m: c // common for m, c in bottom.items()}


def _field(value: Form) -> tuple[fmpq_poly, Node] | None:
    """Polynomial and first power of the one root of higher degree that a real is made of, if there is any."""
    found = {key for key, _ in value.generators() if not isinstance(key, int | Sqrt)}
    if not found:
        return None
    key = found.pop()
    if found or not isinstance(key, tuple):
        raise _TooLong
    coefficients, index = key
    return fmpq_poly(list(coefficients)), Root.make(coefficients, index, 1)


def _radicands(value: Form) -> set[int]:
    """The integers whose square roots a real is made of."""
    found: set[int] = set()
    waiting, done = [value], set()
    while waiting:
        for atom in waiting.pop().terms:
            if isinstance(atom, int):
                if atom != 1:
                    found.add(atom)
            elif atom not in done:
                done.add(atom)
                if isinstance(atom, Sqrt | Product | Inverse):
                    waiting += atom.args
    return found
