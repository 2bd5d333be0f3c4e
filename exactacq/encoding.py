"""Exact numbers as JSON: rationals as text, algebraic numbers as the expressions that define them.

All irrational numbers of a document share one table. An entry is a linear form, a list of
``[coefficient, atom]`` with

- ``["radical", "d"]``: the square root of a positive integer,
- ``["sqrt", n]``, ``["product", n, n]``, ``["inverse", n]`` of numbers n,
- ``["root", ["c0", "c1", ...], index, power]``: a power of a real root, counted from the left, of an
  irreducible integer polynomial,

and a number is ``"p/q"`` or the place of an earlier entry. Shared subexpressions are stored once.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any, TypeAlias

from exactacq.atoms import Inverse, Node, Product, Root, Sqrt
from exactacq.errors import FormatError
from exactacq.numerals import rational
from exactacq.reals import Real, fmpq, roots

Number: TypeAlias = "str | int"
MAX_DEGREE = 200
"""Largest degree of a polynomial that is read: chords reach 24, and isolating roots must stay cheap."""
KINDS = {Sqrt: "sqrt", Product: "product", Inverse: "inverse"}


class Encoder:
    """Collects the table of a document while its numbers are written."""

    def __init__(self) -> None:
        self.table: list[list[list[Any]]] = []
        self._places: dict[Hashable, int] = {}

    def number(self, value: Real) -> Number:
        """``"p/q"``, or the place of an irrational number in the table."""
        if value.rational is not None:
            return str(value.rational)
        if value.key not in self._places:
            entry = [[str(c), self._atom(atom)] for atom, c in value.terms.items()]
            self.table.append(entry)
            self._places[value.key] = len(self.table) - 1
        return self._places[value.key]

    def _atom(self, atom: int | Node) -> list[Any]:
        if isinstance(atom, int):
            return ["radical", str(atom)]
        if isinstance(atom, Root):
            coefficients, index, power = atom.args
            return ["root", [str(c) for c in coefficients], index, power]
        kind = next(name for cls, name in KINDS.items() if isinstance(atom, cls))
        return [kind, *(self.number(argument) for argument in atom.args)]


class Decoder:
    """Reads numbers back; every entry of the table is built once, in order.

    Raises `FormatError` for a table that is not of that form, ValueError or ZeroDivisionError where an
    expression has no value.
    """

    def __init__(self, table: list[Any]) -> None:
        self._values: list[Real] = []
        for entry in table:
            self._values.append(Real.sum(self._atom(atom) * rational(c) for c, atom in entry))

    def number(self, value: Any) -> Real:
        """The number that ``"p/q"`` or a place in the table stands for."""
        if not is_place(value):
            return Real(rational(value))
        place = int(value)
        if not 0 <= place < len(self._values):
            raise FormatError(f"number {place} is not defined before it is used")
        return self._values[place]

    def _atom(self, atom: Any) -> Real:
        kind, *arguments = atom
        if kind == "radical":
            return Real(int(arguments[0])).sqrt()
        if kind == "root":
            return _root(*arguments)
        values = [self.number(argument) for argument in arguments]
        if kind == "sqrt" and len(values) == 1:
            return values[0].sqrt()
        if kind == "product" and len(values) == 2:
            return values[0] * values[1]
        if kind == "inverse" and len(values) == 1:
            return 1 / values[0]
        raise FormatError(f"unknown kind of number {str(kind)[:20]!r}")


def is_place(value: Any) -> bool:
    """Whether a number refers to the table: an int, or one that the JSON reader kept as its text."""
    return not isinstance(value, str) or getattr(value, "is_json_number", False)


def _root(coefficients: list[Any], index: Any, power: Any) -> Real:
    if not 2 <= len(coefficients) <= MAX_DEGREE + 1 or not 0 < int(power) < MAX_DEGREE:
        raise FormatError("a root needs a polynomial of moderate degree")
    found = roots([fmpq(int(c)) for c in coefficients])
    if not 0 <= int(index) < len(found):
        raise FormatError(f"the polynomial has {len(found)} real roots, not {int(index) + 1}")
    return found[int(index)] ** int(power)
