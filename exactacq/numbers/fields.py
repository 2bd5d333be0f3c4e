"""First fields of towers of square roots: the rationals, and the rational functions of any numbers.

Elements are integers, or integer polynomials in the numbers, over the common denominator of a sum: so not
every product is reduced. What is equal as a function of some numbers is equal whatever these are; they come
in only where their balls tell which of two square roots is meant. Fields of roots are in `number_field`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Sequence
from typing import Any, TypeAlias

from flint import Ordering, arb, fmpz, fmpz_mpoly, fmpz_mpoly_ctx
from flint.utils.flint_exceptions import DomainError

from exactacq.numbers.atoms import Atom, Node, Root

WORDS = 512
"""Machine words of a factor that take as long as one product of short integers."""
POLYNOMIAL_BITS = 512
"""Bits of a polynomial that take as long as one product of short integers."""
DIVISION = 4
"""How many products a division takes, of numbers of the same lengths."""
SEVERAL = 4
"""How many times longer that of polynomials in several numbers takes."""
RootKey: TypeAlias = "tuple[tuple[int, ...], int]"
"""Ascending coefficients of an irreducible integer polynomial, and which of its real roots is meant."""


class FractionField(ABC):
    """A field of fractions: its elements are of a ring, over the common denominator of a sum."""

    def times(self, a: Any, b: Any) -> Any:
        """The product of two elements."""
        return a * b

    @abstractmethod
    def cost(self, a: Collection[Any], b: Any) -> float:
        """What it costs to multiply elements by one, in products of short integers."""

    def lowest(self, parts: dict[int, Any], under: Any) -> tuple[dict[int, Any], Any]:
        """Elements over a common denominator, in lowest terms."""
        if under == 1:
            return parts, under
        # What a sum of multiples shares with the denominator, all of them mostly share.
        total = sum((k * c for k, c in enumerate(parts.values(), 1)), 0 * under)
        common = under.gcd(total)
        while common != 1:
            divided = {m: divmod(c, common) for m, c in parts.items()}
            rest = next((rest for _, rest in divided.values() if rest), None)
            if rest is None:
                return {m: c for m, (c, _) in divided.items()}, under // common
            common = common.gcd(rest)
        return parts, under

    def lowest_cost(self, parts: dict[int, Any], under: Any) -> float:
        """What `lowest` costs."""
        return DIVISION * self.cost(parts.values(), under)

    def inverse_cost(self, a: Any) -> float:
        """What an inverse costs: nothing."""
        return 0


class Rationals(FractionField):
    """The rationals as a first field: its elements are integers."""

    one = fmpz(1)

    def constant(self, value: int) -> fmpz:
        """An integer as an element."""
        return fmpz(value)

    def of_atom(self, atom: Atom) -> None:
        """None: no atom but 1 is rational."""

    def cost(self, a: Collection[fmpz], b: fmpz) -> float:
        """What it costs to multiply elements by one, in products of short integers."""
        return product_cost(a, b, fmpz.bit_length)

    def inverse(self, a: fmpz) -> tuple[fmpz, fmpz]:
        """1 over an element that is not 0, as an element and its denominator."""
        return fmpz(1 if a > 0 else -1), abs(a)

    def square_root(self, a: fmpz) -> fmpz | None:
        """The square root of a square, else None."""
        return a.isqrt() if a >= 0 and a.is_square() else None

    def ball(self, a: fmpz, bits: int) -> arb:
        """An enclosure of an element, with *bits* working bits that the caller has set."""
        return arb(a)


class RationalFunctions(FractionField):
    """The field over Q of some numbers, of which nothing is known but balls: *numbers* are nodes, or roots.

    Its elements are integer polynomials in these, over the common denominator of a sum, a polynomial too.

    >>> from exactacq.numbers.atoms import Root
    >>> field = RationalFunctions([((-2, 0, 0, 1), 0)])
    >>> tau = field.of_atom(Root.make((-2, 0, 0, 1), 0, 1))
    >>> field.square_root(tau * tau + 2 * tau + 1), field.square_root(tau)
    (x0 + 1, None)
    """

    def __init__(self, numbers: Sequence[Node | RootKey]) -> None:
        names = tuple(f"x{k}" for k in range(len(numbers)))
        self._ring = fmpz_mpoly_ctx.get(names, Ordering.degrevlex)
        nodes = (one if isinstance(one, Node) else Root.make(one[0], one[1], 1) for one in numbers)
        # The order tells how long polynomials take, and so what is given up: all processes have the same.
        self._numbers = sorted(nodes, key=lambda node: node.middle)
        self._variables = dict(zip(self._numbers, self._ring.gens(), strict=True))
        self.one = self._ring.constant(1)

    def constant(self, value: int) -> fmpz_mpoly:
        """An integer as an element."""
        return self._ring.constant(value)

    def of_atom(self, atom: Atom) -> fmpz_mpoly | None:
        """A number or a power of a root; None for others, which are not in the field."""
        if isinstance(atom, Root):
            coefficients, index, power = atom.args
            variable = self._variables.get(Root.make(coefficients, index, 1))
            return None if variable is None else variable**power
        return self._variables.get(atom) if isinstance(atom, Node) else None

    def inverse(self, a: fmpz_mpoly) -> tuple[fmpz_mpoly, fmpz_mpoly]:
        """1 over an element that is not 0, as an element and its denominator."""
        return self.one, a

    def square_root(self, a: fmpz_mpoly) -> fmpz_mpoly | None:
        """A square root of an element if it has one, else None."""
        try:
            return a.sqrt()
        except DomainError:
            return None

    def cost(self, a: Collection[fmpz_mpoly], b: fmpz_mpoly) -> float:
        """What it costs to multiply elements by one, in products of short integers."""
        products = len(a) + (len(a) * self._bits(b) + sum(map(self._bits, a))) // POLYNOMIAL_BITS
        return products if len(self._numbers) < 2 else SEVERAL * products

    def _bits(self, a: fmpz_mpoly) -> int:
        # Those in the middle are the longest.
        return len(a) * int(a.coefficient(len(a) // 2).bit_length()) if a else 0

    def ball(self, a: fmpz_mpoly, bits: int) -> arb:
        """An enclosure of an element, with *bits* working bits that the caller has set."""
        total = arb(0)
        for exponents, coefficient in a.terms():
            term = arb(coefficient)
            for number, exponent in zip(self._numbers, exponents, strict=True):
                term *= number.ball(bits) ** int(exponent)
            total += term
        return total


def product_cost(a: Collection[Any], b: Any, bits: Callable[[Any], int]) -> float:
    """How long products take, as each takes the longer the more words it multiplies."""
    return len(a) + (len(a) * (bits(b) >> 6) + (sum(map(bits, a)) >> 6)) // WORDS
