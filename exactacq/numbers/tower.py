"""Zero test in towers of square roots: the field of a real, in which every number has one form.

A real made of rationals, nested square roots and one or two roots of polynomials lies in a field that is
made in steps. It begins with the rationals, or the field of the roots, and each square root t of an element
that has none in the field so far makes the field of all A + B t. A square root of an element that has one is
that or its negative, as balls tell: most radicals of a tie are of this kind, where a line meets a circle in a
point known before. So a number has one form, a sum of products of radicals with coefficients in lowest
terms, and is 0 only if it has no terms. Degrees and sizes are those of the number itself, not those of the
expression that made it, which are all that the height bound knows. Over roots of a high degree no square
roots are looked for: there an element with terms may be 0, and its norm tells.

The root of A + B t is x + y t only if the norm A^2 - B^2 t^2 is a square n^2 and x^2 = (A + n) / 2 or
(A - n) / 2; where B = 0, if A or A t^2 is a square: questions in the field below.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, prod
from typing import Any, TypeAlias

from flint import arb, fmpq

from exactacq.numbers.atoms import Atom, Form, Inverse, Node, Product, Sqrt, atom_ball
from exactacq.numbers.number_field import (
    NumberField,
    RationalFunctions,
    RootKey,
    joined_roots,
    vanishes_in_parts,
)
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import ball_sign

Element: TypeAlias = "dict[int, Any]"
"""Coefficients in the first field, none of them 0, by monomial: bit i of the key stands for radical i."""

MOST_DEGREE = 36
"""Highest degree of the field of two roots."""
MOST_RADICALS = 12
MOST_TERMS = 1 << 18
"""Products of terms after which a test gives up: a few seconds of work at most."""
WORDS = 512
"""Machine words of a factor that take as long as one product of short terms."""
INVERSE = 3500
"""An inverse in the first field costs its degree squared times its words to the power 1.5, over this: so one
that takes more than ten seconds is not begun."""
BITS = 256


class _TooLong(Exception):
    """The test would take too long."""


def vanishes(value: Form) -> bool | None:
    """Whether a real is 0; None if it holds more than two roots of polynomials, or would take too long."""
    if (told := vanishes_in_parts(value.terms)) is not None:
        return told
    try:
        tower = Tower(value)
        return tower.is_zero(tower.element(value))
    except _TooLong:
        return None


def vanishes_about(value: Form, numbers: Sequence[Node | RootKey]) -> bool:
    """Whether a real that is made of some numbers is surely 0 whatever they are, near these; then it is 0."""
    try:
        return not FormalTower(value, numbers).element(value)
    except _TooLong:
        return False


class Tower:
    """The field of a real and what it is made of, as far as `element` has come across it."""

    most_terms, most_bits = MOST_TERMS, inf

    def __init__(self, value: Form, field: NumberField | RationalFunctions | None = None) -> None:
        self.field: Any = _first_field(value) if field is None else field
        self.squares: list[Element] = []
        self.radicals: list[Atom] = []
        self.known: dict[Atom, Element] = {1: {0: self.field.constant(1)}}
        self.work = 0.0

    def element(self, value: Form) -> Element:
        """The element that a real is."""
        total: Element = {}
        for atom, c in value.terms.items():
            if max(c.p.bit_length(), c.q.bit_length()) > self.most_bits:
                raise _TooLong
            total = _sum(total, self._of_atom(atom), c)
        return total

    def _of_atom(self, atom: Atom) -> Element:
        if atom not in self.known:
            if isinstance(atom, int):
                self.known[atom] = self._radical(atom, {0: self.field.constant(atom)})
            elif isinstance(atom, Sqrt):
                self.known[atom] = self._radical(atom, self.element(atom.args[0]))
            elif isinstance(atom, Product):
                self.known[atom] = self.times(*(self.element(factor) for factor in atom.args))
            elif isinstance(atom, Inverse):
                self.known[atom] = self.inverse(self.element(atom.args[0]))
            elif (own := self.field.of_atom(atom)) is not None:
                self.known[atom] = {0: own}
            else:
                raise _TooLong
        return self.known[atom]

    def _radical(self, atom: Atom, square: Element) -> Element:
        """The positive square root that an atom stands for: in the field so far, or a new radical of it."""
        root = self.square_root(square, len(self.squares))
        if root is not None:
            return _scaled(root, self._sign(root))
        if len(self.squares) == MOST_RADICALS:
            raise _TooLong
        self.squares.append(square)
        self.radicals.append(atom)
        return {1 << (len(self.squares) - 1): self.field.constant(1)}

    # -- arithmetic --------------------------------------------------------------------------------

    def times(self, a: Element, b: Element) -> Element:
        """The product, with squares of radicals replaced."""
        self._spend(len(a) * len(b) * self.field.degree**2)
        self._spend((len(b) * self._words(a) + len(a) * self._words(b)) // WORDS)
        plain: dict[int, Element] = {}
        for m, p in a.items():
            for n, q in b.items():
                rest, product = plain.setdefault(m & n, {}), self.field.times(p, q)
                rest[m ^ n] = rest[m ^ n] + product if m ^ n in rest else product
        result: Element = {}
        for twice, rest in plain.items():
            part = {m: c for m, c in rest.items() if c}
            for i in range(twice.bit_length()):
                if twice >> i & 1:
                    part = self.times(part, self.squares[i])
            result = _sum(result, part)
        return result

    def _spend(self, work: float) -> None:
        """Count some work, and give up where it is too much."""
        self.work += work
        if self.work > self.most_terms:
            raise _TooLong

    def _words(self, a: Element) -> int:
        """Machine words of all coefficients."""
        words: int = sum(map(self.field.size, a.values())) >> 6
        return words

    def inverse(self, a: Element) -> Element:
        """1 over an element that is not 0: (A - B t) / (A^2 - B^2 t^2) for A + B t."""
        if set(a) == {0}:
            self._spend(self.field.degree**2 * self._words(a) ** 1.5 / INVERSE)
            return {0: self.field.inverse(a[0])}
        last = max(a).bit_length() - 1
        conjugate = {m: -c if m >> last & 1 else c for m, c in a.items()}
        norm = self.times(a, conjugate)
        if self.is_zero(norm):
            return self.inverse({m: 2 * c for m, c in a.items() if not m >> last & 1})
        return self.times(conjugate, self.inverse(norm))

    # -- zero --------------------------------------------------------------------------------------

    def is_zero(self, a: Element) -> bool:
        """Whether the number that an element stands for is 0.

        An element with terms is so only where a root was not looked for: then A + B t or A - B t is.
        """
        if set(a) <= {0} or ball_sign(self._ball(a, BITS)):
            return not a
        last = max(a).bit_length() - 1
        conjugate = {m: -c if m >> last & 1 else c for m, c in a.items()}
        if not self.is_zero(self.times(a, conjugate)):
            return False
        if self.is_zero({m: c for m, c in a.items() if m >> last & 1}):
            return True
        bits = BITS
        while True:
            # B is not 0: so of the two exactly one is 0.
            if ball_sign(self._ball(a, bits)):
                return False
            if ball_sign(self._ball(conjugate, bits)):
                return True
            bits *= 2

    # -- square roots ------------------------------------------------------------------------------

    def square_root(self, a: Element, count: int) -> Element | None:
        """A square root in the field of the first *count* radicals, which holds the element, or None."""
        if not a:
            return a
        if count == 0:
            root = self.field.square_root(a[0])
            return None if root is None else {0: root}
        last = count - 1
        t, square = 1 << last, self.squares[last]
        low, high = {m: c for m, c in a.items() if not m & t}, {m ^ t: c for m, c in a.items() if m & t}
        if not high:
            x = self.square_root(low, last)
            if x is None and (y := self.square_root(self.times(low, square), last)) is not None:
                x = self.times(self.times(y, self.inverse(square)), {t: self.field.constant(1)})
            return x
        norm = _sum(self.times(low, low), self.times(self.times(high, high), square), -1)
        n = self.square_root(norm, last)
        if n is None:
            return None
        for sign in (1, -1):
            x = self.square_root(_scaled(_sum(low, n, sign), fmpq(1, 2)), last)
            if x:
                y = self.times(high, self.inverse(_scaled(x, 2)))
                return x | {m | t: c for m, c in y.items()}
        return None

    # -- signs of roots ----------------------------------------------------------------------------

    def _sign(self, a: Element) -> int:
        """The sign of a number that is not 0."""
        bits = BITS
        while not (sign := ball_sign(self._ball(a, bits))):
            bits *= 2
            if bits > self.most_bits:
                raise _TooLong
        return sign

    def _ball(self, a: Element, bits: int) -> arb:
        with workprec(bits):
            total = arb(0)
            for mask, c in a.items():
                term = self.field.ball(c, bits)
                for i, atom in enumerate(self.radicals):
                    if mask >> i & 1:
                        term *= atom_ball(atom, bits)
                total += term
            return total


class FormalTower(Tower):
    """A tower over the rational functions of some numbers: without terms an element is 0 whatever they are.

    One with terms may be 0 as well, by chance. Nothing is asked of it but the signs of square roots.
    """

    most_terms, most_bits = 1 << 12, 1 << 14

    def __init__(self, value: Form, numbers: Sequence[Node | RootKey]) -> None:
        super().__init__(value, RationalFunctions(numbers))

    def is_zero(self, a: Element) -> bool:
        """Whether an element has no terms."""
        return not a


def _scaled(a: Element, factor: fmpq | int) -> Element:
    return {m: c * factor for m, c in a.items()}


def _sum(a: Element, b: Element, factor: fmpq | int = 1) -> Element:
    """a + factor * b, without terms that are 0."""
    result = dict(a)
    for m, c in b.items():
        total = result[m] + c * factor if m in result else c * factor
        if total:
            result[m] = total
        else:
            result.pop(m, None)
    return result


def _first_field(value: Form) -> NumberField:
    """The field of the roots of higher degree, two at most, that a real is made of; else the rationals."""
    generators = [(key, degree) for key, degree in value.generators() if not isinstance(key, int | Sqrt)]
    keys: list[RootKey] = sorted(key for key, _ in generators if isinstance(key, tuple))
    if len(keys) < len(generators) or len(keys) > 2:
        raise _TooLong
    if len(keys) < 2:
        return NumberField(*keys[0]) if keys else NumberField()
    if prod(degree for _, degree in generators) > MOST_DEGREE:
        raise _TooLong
    return joined_roots(*keys)
