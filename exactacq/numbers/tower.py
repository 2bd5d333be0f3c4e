"""Zero test in towers of square roots: the field of a real, in which every number has one form.

A real made of rationals, nested square roots and one or two roots of polynomials lies in a field that is
made in steps. It begins with the rationals, or the field of the roots, and each square root t of an element
that has none in the field so far makes the field of all A + B t. A square root of an element that has one is
that or its negative, as balls tell: most radicals of a tie are of this kind, where a line meets a circle in a
point known before. So a number has one form, a sum of products of radicals with coefficients in lowest
terms, and is 0 only if it has no terms. Degrees and sizes are those of the number itself, not those of the
expression that made it, which are all that the height bound knows. Over roots of a high degree no square
roots are looked for: there an element with terms may be 0, and its norm tells.

Coefficients have one denominator for all of an element, and radicals are taken times what leaves none in
their squares: so products are made of integers, and reduced once.

The root of A + B t is x + y t only if the norm A^2 - B^2 t^2 is a square n^2 and x^2 = (A + n) / 2 or
(A - n) / 2; where B = 0, if A or A t^2 is a square: questions in the field below.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from math import inf, prod
from typing import Any, NamedTuple, TypeAlias

from flint import arb, fmpq

from exactacq.numbers.atoms import Atom, Form, Generators, Inverse, Product, Sqrt, atom_ball
from exactacq.numbers.fields import RationalFunctions, Rationals, RootKey
from exactacq.numbers.number_field import NumberField, joined_roots, vanishes_in_parts
from exactacq.numbers.precision import LOCK, workprec
from exactacq.numbers.rationals import ball_sign

MOST_DEGREE = 36
"""Highest degree of the field of two roots."""
MOST_RADICALS = 12
MOST_TERMS = 1 << 19
"""Products of terms after which a test gives up: a few seconds of work at most."""
ROOT = 8
"""How many products a square root of a coefficient takes."""
BITS = 256
HALF = fmpq(1, 2)
TOWERS_KEPT = 8
_kept: dict[tuple[type[Tower], Generators], Tower] = {}
"""Towers of the last tests by what their numbers are made of: ties come in groups that share their radicals.
All tests of one tower together may take as long as one test; then it is made anew. The largest that was seen
held 20 MB."""


class _TooLong(Exception):
    """The test would take too long."""


def vanishes(value: Form) -> bool | None:
    """Whether a real is 0; None if it holds more than two roots of polynomials, or would take too long."""
    if (told := vanishes_in_parts(value.terms)) is not None:
        return told
    return _asked(Tower, value.generators(), lambda tower: tower.is_zero(tower.element(value)))


def vanishes_about(*values: Form) -> bool:
    """Whether one of some reals is surely 0 whatever the numbers are, near theirs, that they are made of.

    Then it is 0. Numbers are all that is made neither by arithmetic nor by square roots.
    """
    generators = frozenset[tuple[Hashable, int]]().union(*(value.generators() for value in values))
    return bool(_asked(FormalTower, generators, lambda tower: _any_zero(tower, values)))


def _any_zero(tower: Tower, values: Sequence[Form]) -> bool:
    """Whether one of some elements is 0, though others may be too long to tell."""
    is_open = False
    for value in values:
        try:
            if not tower.element(value):
                return True
        except _TooLong:
            is_open = True
    if is_open:
        raise _TooLong
    return False


def _asked(kind: type[Tower], generators: Generators, ask: Callable[[Tower], bool]) -> bool | None:
    """What is asked of a tower, one that is kept or a new one; None if it would take too long."""
    with LOCK:
        tower = _kept.pop((kind, generators), None)
    told = None if tower is None else _told(tower, ask)
    if told is None:
        try:
            tower = kind(generators)
        except _TooLong:
            return None
        told = _told(tower, ask)
    if tower is not None and told is not None:
        with LOCK:
            _kept[kind, generators] = tower
            if len(_kept) > TOWERS_KEPT:
                del _kept[next(iter(_kept))]
    return told


def _told(tower: Tower, ask: Callable[[Tower], bool]) -> bool | None:
    try:
        return ask(tower)
    except _TooLong:
        return None


Parts: TypeAlias = "dict[int, Any]"
"""Coefficients in the first field, none of them 0, by products of radicals: bit i of a key is radical i."""


class TowerElement(NamedTuple):
    """A sum of products of radicals over a common denominator."""

    parts: Parts
    under: Any

    def __bool__(self) -> bool:
        """Whether there are terms."""
        return bool(self.parts)

    def split(self, radical: int) -> tuple[TowerElement, TowerElement]:
        """A and B of A + B t."""
        low, high = _split(self.parts, 1 << radical)
        return TowerElement(low, self.under), TowerElement(high, self.under)

    def conjugate(self, radical: int) -> TowerElement:
        """A - B t of A + B t."""
        return TowerElement({m: -c if m >> radical & 1 else c for m, c in self.parts.items()}, self.under)


def _split(parts: Parts, bit: int) -> tuple[Parts, Parts]:
    return {m: c for m, c in parts.items() if not m & bit}, {m ^ bit: c for m, c in parts.items() if m & bit}


def _added(a: Parts, b: Parts, factor: Any = 1) -> Parts:
    """a + factor * b, without terms that are 0."""
    parts = dict(a)
    for m, c in b.items():
        total = parts[m] + c * factor if m in parts else c * factor
        if total:
            parts[m] = total
        else:
            del parts[m]
    return parts


class Tower:
    """The field of a real and what it is made of, as far as `element` has come across it."""

    most_terms, most_bits = MOST_TERMS, inf

    def __init__(self, generators: Generators) -> None:
        self.field = self._first_field(_numbers(generators))
        self.zero = TowerElement({}, self.field.one)
        self.radicals: list[tuple[Atom, Any]] = []
        self.squares: list[Parts] = []
        self.known: dict[Atom, TowerElement] = {1: self._constant(1)}
        self.work = 0.0

    def element(self, value: Form) -> TowerElement:
        """The element that a real is."""
        total = self.zero
        for atom, c in value.terms.items():
            if max(c.p.bit_length(), c.q.bit_length()) > self.most_bits:
                raise _TooLong
            total = self._sum(total, self._of_atom(atom), c)
        return total

    def _constant(self, value: int) -> TowerElement:
        return TowerElement({0: self.field.constant(value)}, self.field.one)

    def _of_atom(self, atom: Atom) -> TowerElement:
        if atom not in self.known:
            if isinstance(atom, int):
                self.known[atom] = self._radical(atom, self._constant(atom))
            elif isinstance(atom, Sqrt):
                self.known[atom] = self._radical(atom, self.element(atom.args[0]))
            elif isinstance(atom, Product):
                self.known[atom] = self.times(*(self.element(factor) for factor in atom.args))
            elif isinstance(atom, Inverse):
                self.known[atom] = self.inverse(self.element(atom.args[0]))
            elif (own := self.field.of_atom(atom)) is not None:
                self.known[atom] = TowerElement({0: own}, self.field.one)
            else:
                raise _TooLong
        return self.known[atom]

    def _radical(self, atom: Atom, square: TowerElement) -> TowerElement:
        """The positive square root that an atom stands for: in the field so far, or a new radical of it."""
        root = self.square_root(square, len(self.squares))
        if root is not None:
            return self._scaled(root, self._sign(root))
        if len(self.squares) == MOST_RADICALS:
            raise _TooLong
        # The radical is a multiple of the root whose square has no denominator: products then need none.
        self.squares.append({m: c * square.under for m, c in square.parts.items()})
        self.radicals.append((atom, square.under))
        return TowerElement({1 << (len(self.squares) - 1): self.field.constant(1)}, square.under)

    def _first_field(self, numbers: list[Any]) -> Any:
        """The field of the roots of higher degree, two at most; else the rationals."""
        if len(numbers) > 2 or not all(isinstance(number, tuple) for number in numbers):
            raise _TooLong
        keys: list[RootKey] = sorted(numbers)
        if len(keys) < 2:
            return NumberField(*keys[0]) if keys else Rationals()
        if prod(len(coefficients) - 1 for coefficients, _ in keys) > MOST_DEGREE:
            raise _TooLong
        return joined_roots(*keys)

    # -- arithmetic --------------------------------------------------------------------------------

    def times(self, a: TowerElement, b: TowerElement) -> TowerElement:
        """The product, with squares of radicals replaced."""
        return self._lowest(self._product(a.parts, b.parts), a.under * b.under)

    def _product(self, a: Parts, b: Parts) -> Parts:
        """(A + B t) (C + D t) = A C + B D t^2 + ((A + B) (C + D) - A C - B D) t, without denominators."""
        if not a or not b:
            return {}
        if max(a) < max(b):
            a, b = b, a
        if max(b) == 0:
            self._spend(self.field.cost(a.values(), b[0]))
            return {m: self.field.times(c, b[0]) for m, c in a.items()}
        last = max(a).bit_length() - 1
        bit = 1 << last
        (low, high), (other_low, other_high) = _split(a, bit), _split(b, bit)
        plain, twice = self._product(low, other_low), self._product(high, other_high)
        both = self._product(_added(low, high), _added(other_low, other_high))
        mixed = _added(_added(both, plain, -1), twice, -1)
        result = _added(plain, self._product(twice, self.squares[last]))
        return result | {m | bit: c for m, c in mixed.items()}

    def _norm(self, a: TowerElement, radical: int) -> TowerElement:
        """A^2 - B^2 t^2 of A + B t."""
        low, high = (part.parts for part in a.split(radical))
        square = self._product(self._product(high, high), self.squares[radical])
        return self._lowest(_added(self._product(low, low), square, -1), a.under * a.under)

    def _sum(self, a: TowerElement, b: TowerElement, factor: fmpq | int = 1) -> TowerElement:
        """a + factor * b."""
        factor = fmpq(factor)
        below = b.under * factor.q
        common = a.under.gcd(below)
        first, second = below // common, a.under // common * factor.p
        parts = {m: c * first for m, c in a.parts.items()}
        return self._lowest(_added(parts, b.parts, second), a.under * first)

    def _scaled(self, a: TowerElement, factor: fmpq | int) -> TowerElement:
        return self._sum(self.zero, a, factor)

    def _lowest(self, parts: Parts, under: Any) -> TowerElement:
        if not parts or under == 1:
            return TowerElement(parts, under) if parts else self.zero
        self._spend(self.field.lowest_cost(parts, under))
        return TowerElement(*self.field.lowest(parts, under))

    def _spend(self, work: float) -> None:
        """Count some work, and give up where it is too much."""
        self.work += work
        if self.work > self.most_terms:
            raise _TooLong

    def inverse(self, a: TowerElement) -> TowerElement:
        """1 over an element that is not 0: (A - B t) / (A^2 - B^2 t^2) for A + B t."""
        if set(a.parts) == {0}:
            self._spend(self.field.inverse_cost(a.parts[0]))
            over, under = self.field.inverse(a.parts[0])
            return self._lowest({0: over * a.under}, under)
        last = max(a.parts).bit_length() - 1
        norm = self._norm(a, last)
        if self.is_zero(norm):
            return self.inverse(self._scaled(a.split(last)[0], 2))
        return self.times(a.conjugate(last), self.inverse(norm))

    # -- zero --------------------------------------------------------------------------------------

    def is_zero(self, a: TowerElement) -> bool:
        """Whether the number that an element stands for is 0.

        An element with terms is so only where a root was not looked for: then A + B t or A - B t is.
        """
        if set(a.parts) <= {0} or ball_sign(self._ball(a, BITS)):
            return not a
        last = max(a.parts).bit_length() - 1
        if not self.is_zero(self._norm(a, last)):
            return False
        if self.is_zero(a.split(last)[1]):
            return True
        bits = BITS
        while True:
            # B is not 0: so of the two exactly one is 0.
            if ball_sign(self._ball(a, bits)):
                return False
            if ball_sign(self._ball(a.conjugate(last), bits)):
                return True
            bits *= 2

    # -- square roots ------------------------------------------------------------------------------

    def square_root(self, a: TowerElement, count: int) -> TowerElement | None:
        """A square root in the field of the first *count* radicals, which holds the element, or None."""
        if not a:
            return a
        if count == 0:
            radicand = a.parts[0] * a.under
            self._spend(ROOT * self.field.cost([radicand], radicand))
            root = self.field.square_root(radicand)
            return None if root is None else self._lowest({0: root}, a.under)
        last = count - 1
        square = TowerElement(self.squares[last], self.field.one)
        low, high = a.split(last)
        if not high:
            x = self.square_root(low, last)
            if x is None and (y := self.square_root(self.times(low, square), last)) is not None:
                x = self._with_radical(self.times(y, self.inverse(square)), last)
            return x
        n = self.square_root(self._norm(a, last), last)
        if n is None:
            return None
        for sign in (1, -1):
            x = self.square_root(self._scaled(self._sum(low, n, sign), HALF), last)
            if x:
                y = self.times(high, self.inverse(self._scaled(x, 2)))
                return self._sum(x, self._with_radical(y, last))
        return None

    def _with_radical(self, a: TowerElement, radical: int) -> TowerElement:
        """A t, for an A without t."""
        return TowerElement({m | 1 << radical: c for m, c in a.parts.items()}, a.under)

    # -- signs of roots ----------------------------------------------------------------------------

    def _sign(self, a: TowerElement) -> int:
        """The sign of a number that is not 0."""
        bits = BITS
        while not (sign := ball_sign(self._ball(a, bits))):
            bits *= 2
            if bits > self.most_bits:
                raise _TooLong
        return sign

    def _ball(self, a: TowerElement, bits: int) -> arb:
        with workprec(bits):
            total = arb(0)
            for mask, c in a.parts.items():
                term = self.field.ball(c, bits)
                for i, (atom, multiple) in enumerate(self.radicals):
                    if mask >> i & 1:
                        term *= atom_ball(atom, bits) * self._under_ball(multiple, bits)
                total += term
            return total / self._under_ball(a.under, bits)

    def _under_ball(self, under: Any, bits: int) -> arb:
        return arb(1) if under == 1 else self.field.ball(under, bits)


class FormalTower(Tower):
    """A tower over the rational functions of some numbers: without terms an element is 0 whatever they are.

    One with terms may be 0 as well, by chance. Nothing is asked of it but the signs of square roots.
    """

    most_terms, most_bits = 3 << 23, 1 << 14

    def _first_field(self, numbers: list[Any]) -> Any:
        return RationalFunctions(numbers)

    def is_zero(self, a: TowerElement) -> bool:
        """Whether an element has no terms."""
        return not a


def _numbers(generators: Generators) -> list[Any]:
    """What is made neither by arithmetic nor by square roots: nodes, and roots of polynomials."""
    return [key for key, _ in generators if not isinstance(key, int | Sqrt)]
