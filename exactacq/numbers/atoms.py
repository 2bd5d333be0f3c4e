"""Atoms of exact reals: 1, square roots of integers, and interned nodes over other reals.

An atom is an int d >= 1, which stands for the square root of d, or a `Node`. Equal expressions share
their nodes, so that identity decides whether two terms of a form are the same.
"""

from __future__ import annotations

import atexit
from abc import ABC, abstractmethod
from collections.abc import Hashable, Mapping
from functools import lru_cache
from math import log2
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeAlias
from weakref import WeakValueDictionary

from flint import arb, fmpq, fmpz

from exactacq.numbers.isolation import refined
from exactacq.numbers.precision import LOCK, workprec
from exactacq.numbers.rationals import without

if TYPE_CHECKING:
    import sympy

ORDERING_BITS = 64
"""Precision of the balls by which atoms and factors are put in order."""
Generators: TypeAlias = "frozenset[tuple[Hashable, int]]"
"""Distinct radicals and roots of an expression with their degrees: the product bounds its degree."""


class Form(Protocol):
    """What an atom needs of the real numbers it is made of (`exactacq.numbers.real.Real`)."""

    @property
    def key(self) -> Hashable:
        """Structural identity."""

    @property
    def terms(self) -> Mapping[Atom, fmpq]:
        """The coefficient of each atom of the linear form; that of 1 is the rational part."""

    def ball(self, bits: int) -> arb:
        """Enclosure with at least *bits* working bits."""

    def working_ball(self, bits: int) -> arb:
        """Enclosure with *bits* working bits, which the caller has set."""

    def height_bound(self) -> float:
        """Upper bound of the absolute logarithmic height, base 2."""

    def generators(self) -> Generators:
        """The radicals and roots in the expression."""

    def sympy(self) -> sympy.Expr:
        """Closed form."""


class Node(ABC):
    """An interned atom that is not the root of an integer; subclasses say how it is evaluated.

    Lives as long as a real holds it; ball, height and generators are computed once.
    """

    __slots__ = ("__weakref__", "_ball", "_bits", "_generators", "_height", "_middle", "args")
    _interned: ClassVar[WeakValueDictionary[Hashable, Node]] = WeakValueDictionary()

    args: tuple[Any, ...]
    _ball: arb
    _bits: int
    _generators: Generators | None
    _height: float | None
    _middle: arb | None

    @classmethod
    def make(cls, *args: Any) -> Node:
        """The one node of these arguments."""
        return cls._intern((cls, *(a.key for a in args)), args)

    @classmethod
    def _intern(cls, key: Hashable, args: tuple[Any, ...]) -> Node:
        with LOCK:
            node = Node._interned.get(key)
            if node is None:
                node = object.__new__(cls)
                node.args, node._bits, node._height, node._generators = args, 0, None, None
                node._middle = None
                Node._interned[key] = node
            return node

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).make, self.args

    def __deepcopy__(self, memo: object) -> Node:
        # A copy of a transcendental number's name would be another number.
        return self

    def ball(self, bits: int) -> arb:
        """Enclosure computed with at least *bits* working bits (the caller has set the precision)."""
        if self._bits < bits:
            self._ball, self._bits = self._evaluate(bits), bits
        return self._ball

    def precise_ball(self, bits: int) -> arb:
        """An enclosure computed with at least *bits* working bits, which this method sets itself."""
        with workprec(bits):
            return self.ball(bits)

    @property
    def middle(self) -> arb:
        """About its value: the middle of a ball, always the same one."""
        if self._middle is None:
            self._middle = self.precise_ball(ORDERING_BITS).mid()
        return self._middle

    def height(self) -> float:
        """Upper bound of the absolute logarithmic height, base 2."""
        if self._height is None:
            self._height = self._bound()
        return self._height

    def generators(self) -> Generators:
        """The distinct radicals and roots below, with their degrees."""
        if self._generators is None:
            self._generators = self._collect()
        return self._generators

    @abstractmethod
    def _evaluate(self, bits: int) -> arb:
        """A ball around the value, from balls of the arguments."""

    def _bound(self) -> float:
        return sum((a.height_bound() for a in self.args), 0.0)

    def _collect(self) -> Generators:
        return frozenset[tuple[Hashable, int]]().union(*(a.generators() for a in self.args))

    @abstractmethod
    def sympy(self) -> sympy.Expr:
        """Closed form."""


def order_of_atom(atom: Atom) -> tuple[bool, Any, int]:
    """What atoms are put in order by: it stays, and is the same in all processes unless balls are equal."""
    return (False, atom, 0) if isinstance(atom, int) else (True, atom.middle, hash(atom))


# Keys cannot be hashed any more once the interpreter takes its modules apart.
atexit.register(Node._interned.clear)


class Sqrt(Node):
    """The square root of a real that was proved to be non-negative when the node was made."""

    __slots__ = ()
    args: tuple[Form]

    def _evaluate(self, bits: int) -> arb:
        return self.args[0].working_ball(bits).nonnegative_part().sqrt()

    def _bound(self) -> float:
        return self.args[0].height_bound() / 2

    def _collect(self) -> Generators:
        return self.args[0].generators() | {(self, 2)}

    def sympy(self) -> sympy.Expr:
        from sympy import sqrt

        return sqrt(self.args[0].sympy())


def _middle_of_factor(factor: Form) -> arb:
    return factor.ball(ORDERING_BITS).mid()


class Product(Node):
    """The product of two reals that is not multiplied out."""

    __slots__ = ()
    args: tuple[Form, Form]

    @classmethod
    def make(cls, *args: Any) -> Node:
        # One node for both orders of the factors, which has them in one that other processes have too.
        key = cls, frozenset(factor.key for factor in args)
        return cls._intern(key, tuple(sorted(args, key=_middle_of_factor)))

    def _evaluate(self, bits: int) -> arb:
        return self.args[0].working_ball(bits) * self.args[1].working_ball(bits)

    def sympy(self) -> sympy.Expr:
        return self.args[0].sympy() * self.args[1].sympy()


class Inverse(Node):
    """1 over a real that was proved not to be 0 when the node was made."""

    __slots__ = ()
    args: tuple[Form]

    def _evaluate(self, bits: int) -> arb:
        return 1 / self.args[0].working_ball(bits)

    def sympy(self) -> sympy.Expr:
        return 1 / self.args[0].sympy()


class Root(Node):
    """A power of real root number ``index`` (from the left) of an irreducible integer polynomial.

    Powers below the degree are a basis of the field that the root generates: elements of one such field
    multiply, divide and cancel as polynomials.
    """

    __slots__ = ()
    args: tuple[tuple[int, ...], int, int]

    @classmethod
    def make(cls, *args: Any) -> Node:
        """Of ascending coefficients, index and power."""
        return cls._intern((cls, *args), args)

    def _evaluate(self, bits: int) -> arb:
        coefficients, index, power = self.args
        if power > 1:
            return Root.make(coefficients, index, 1).ball(bits) ** power
        return refined(coefficients, index)

    def _bound(self) -> float:
        # Mahler's measure is at most the Euclidean norm of the coefficients (Landau).
        coefficients, _, power = self.args
        norm = sum(c**2 for c in coefficients).bit_length() / 2 + 1
        return power * norm / (len(coefficients) - 1)

    def _collect(self) -> Generators:
        coefficients, index, _ = self.args
        return frozenset({((coefficients, index), len(coefficients) - 1)})

    def sympy(self) -> sympy.Expr:
        from sympy import CRootOf, Poly, Symbol

        coefficients, index, power = self.args
        return CRootOf(Poly(list(reversed(coefficients)), Symbol("x")), index) ** power


Atom: TypeAlias = "int | Node"


def atom_ball(atom: Atom, bits: int) -> arb:
    """Enclosure of an atom with at least *bits* working bits, which the caller has set."""
    return arb(atom).sqrt() if isinstance(atom, int) else atom.ball(bits)


def atom_height(atom: Atom) -> float:
    """Upper bound of the absolute logarithmic height of an atom, base 2."""
    return log2(atom) / 2 if isinstance(atom, int) else atom.height()


def atom_generators(atom: Atom) -> Generators:
    """The radicals and roots that an atom is made of."""
    if isinstance(atom, int):
        return frozenset() if atom == 1 else frozenset({(atom, 2)})
    return atom.generators()


def atom_sympy(atom: Atom) -> sympy.Expr:
    """Closed form of an atom."""
    from sympy import Integer, UnevaluatedExpr, sqrt

    if not isinstance(atom, int):
        return atom.sympy()
    try:
        return sqrt(Integer(atom))
    except ValueError:  # sympy 1.14 takes a factor for a prime where two factors are close, and refuses it.
        return sqrt(UnevaluatedExpr(Integer(atom)))


WHOLLY_FACTORED = 62
"""Bits up to which a radicand is factored completely: that takes microseconds."""


SEARCHED = 2048
"""Bits up to which a radicand's factors are searched for: the time grows faster than its square."""
SMALL_PRIMES = fmpz.primorial_ui(4096)
"""The product of the primes by which longer ones are divided."""


@lru_cache(maxsize=1 << 16)
def square_free(n: int) -> tuple[int, int]:
    """(s, d) with n = s^2 d > 0, s as large as trial division and one perfect-square test find it."""
    side = 1
    if n.bit_length() <= WHOLLY_FACTORED:
        for prime, exponent in fmpz(n).factor():
            if exponent > 1:
                side *= int(prime) ** (exponent // 2)
        return (side, n // (side * side)) if side > 1 else (1, n)
    if n.bit_length() > SEARCHED:
        # Python's own integers take time that grows with the square of their length.
        rest = fmpz(n)
        small, root = (rest % SMALL_PRIMES).gcd(SMALL_PRIMES), fmpz(1)
        for prime, _ in small.factor() if small > 1 else ():
            rest, exponent = without(rest, fmpz(prime))
            root *= fmpz(prime) ** (exponent // 2)
        root *= rest.isqrt() if rest.is_square() else 1
        return int(root), int(fmpz(n) // (root * root))
    for factor, exponent in fmpz(n).factor_smooth(12):
        base = fmpz(factor)
        # The last factor may be composite, and a square.
        side *= int(base.isqrt() ** exponent if base.is_square() else base ** (exponent // 2))
    return side, n // (side * side)


def rational_sqrt(q: fmpq) -> fmpq | None:
    """The square root of a rational if that is rational, else None."""
    if q < 0 or not q.p.is_square() or not q.q.is_square():
        return None
    return fmpq(q.p.isqrt(), q.q.isqrt())
