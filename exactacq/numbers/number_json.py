"""Exact numbers as JSON: rationals as text, algebraic numbers as the expressions that define them.

All irrational numbers of a document share one table. An entry is a linear form, a list of
``[coefficient, atom]`` with

- ``["radical", "d"]``: the square root of a positive integer,
- ``["sqrt", n]``, ``["product", n, n]``, ``["inverse", n]`` of numbers n,
- ``["root", ["c0", "c1", ...], index, power]``: a power of a real root, counted from the left, of an
  irreducible integer polynomial,
- ``["zero", parts, low, high]``: the one zero between two rationals of a function whose parts are lists
  ``[name, n, ...]`` of numbers n under a name (see `exactacq.sensing.view_length`),

and a number is ``"p/q"`` or the place of an earlier entry. Shared subexpressions are stored once.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable
from typing import Any, TypeAlias

from flint import fmpz

from exactacq.errors import FormatError
from exactacq.numbers.atoms import Inverse, Node, Product, Root, Sqrt
from exactacq.numbers.function_zeros import Function, Parts, Zero, roots, zero_between
from exactacq.numbers.linear_forms import field_of
from exactacq.numbers.real import Real, fmpq

Number: TypeAlias = "str | int"
MAX_DEGREE = 200
"""Largest degree of a polynomial that is read: chords reach 24, and isolating roots must stay cheap."""
MAX_DEPTH = 64
"""Most levels of expressions within expressions that are read; runs have two or three."""
MAX_SIZE = 1 << 26
"""Most bits of the coefficients and radicands of a number that is read: squares of squares double them.

Runs have numbers of some 2^18 bits. Heights are no measure: those of nested numbers reach 2^30 and more.
"""
MAX_TOTAL = 1 << 30
"""Most bits of all numbers of a document, which bounds the memory that they take."""
MAX_INVERTED = 10**6
"""Most work for inverses, about a second: the sum, over all of them, of the cube of the field's degree times
the square of the longest coefficient in units of `INVERTED_BITS`.

Files that are written have none: an element of the field of one root is written as a form.
"""
INVERTED_BITS = 512
"""The unit of length: an inverse takes time in proportion to the square of its longest coefficient."""
MAX_PARTS = 8
"""Most parts of a function of which a zero is read: a length of views has three."""
MAX_FINENESS = 1 << 12
"""Most bits of the denominators of the cell of a zero that is read: a cell is seldom narrower than 2^-100."""
MAX_LENGTH = 1_400_000
"""Longest text of a rational."""
FRACTION = re.compile(r"(-?\d+)(?:/(\d+))?", re.ASCII)
KINDS = {Sqrt: "sqrt", Product: "product", Inverse: "inverse"}


class Encoder:
    """Collects the table of a document while its numbers are written.

    `FormatError` for a transcendental number: no place of a path is made of one.
    """

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
            return ["radical", _digits(atom)]
        if isinstance(atom, Root):
            coefficients, index, power = atom.args
            return ["root", [_digits(c) for c in coefficients], index, power]
        if isinstance(atom, Zero):
            function, low, high = atom.args
            parts = [[name, *(self.number(n) for n in numbers)] for name, numbers in function.parts]
            return ["zero", parts, str(low), str(high)]
        kind = next((name for cls, name in KINDS.items() if isinstance(atom, cls)), None)
        if kind is None:
            raise FormatError(f"no exact form in JSON for {atom.sympy()}, which is transcendental")
        return [kind, *(self.number(argument) for argument in atom.args)]


class Decoder:
    """Reads numbers back; every entry of the table is built once, in order.

    *function* makes the functions of zeros of their parts, or raises ValueError or KeyError.
    Raises `FormatError` for a table that is not of that form or beyond the limits above, ValueError or
    ZeroDivisionError where an expression has no value.
    """

    def __init__(self, table: list[Any], function: Callable[[Parts], Function]) -> None:
        self._function = function
        self._values: list[Real] = []
        self._depths: list[int] = []
        self._inverted = total = 0
        for entry in table:
            value = Real.sum(self._atom(atom) * _fraction(c) for c, atom in entry)
            size = sum(int(c.p.bit_length() + c.q.bit_length()) for c in value.terms.values())
            size += sum(atom.bit_length() for atom in value.terms if isinstance(atom, int))
            total += size
            if size > MAX_SIZE or total > MAX_TOTAL:
                raise FormatError(f"number {len(self._values)} is too large")
            depth = 1 + max((self._depth(atom) for _, atom in entry), default=0)
            if depth > MAX_DEPTH:
                raise FormatError(f"number {len(self._values)} is nested more than {MAX_DEPTH} deep")
            self._values.append(value)
            self._depths.append(depth)

    def number(self, value: Any) -> Real:
        """The number that ``"p/q"`` or a place in the table stands for."""
        if not is_place(value):
            return Real(_fraction(value))
        place = int(value)
        if not 0 <= place < len(self._values):
            raise FormatError(f"number {place} is not defined before it is used")
        return self._values[place]

    def _depth(self, atom: Any) -> int:
        """Levels of expressions below an atom that was read."""
        kind, *arguments = atom
        if kind == "zero":
            arguments = [n for _, *numbers in arguments[0] for n in numbers]
        elif kind not in KINDS.values():
            arguments = []
        places = [int(n) for n in arguments if is_place(n)]
        return max((self._depths[place] for place in places), default=0)

    def _atom(self, atom: Any) -> Real:
        kind, *arguments = atom
        if kind == "radical":
            return Real(_integer(arguments[0])).sqrt()
        if kind == "root":
            return _root(*arguments)
        if kind == "zero":
            return self._zero(*arguments)
        values = [self.number(argument) for argument in arguments]
        if kind == "sqrt" and len(values) == 1:
            return values[0].sqrt()
        if kind == "product" and len(values) == 2:
            return values[0] * values[1]
        if kind == "inverse" and len(values) == 1:
            if (field := field_of(values[0].terms)) is not None:
                bits = max(int(c.height_bits()) for c in (*values[0].terms.values(), *map(fmpq, field[0])))
                self._inverted += (len(field[0]) - 1) ** 3 * (1 + bits // INVERTED_BITS) ** 2
            if self._inverted > MAX_INVERTED:
                raise FormatError("too many inverses of long numbers or in fields of high degree")
            return 1 / values[0]
        raise FormatError(f"unknown kind of number {str(kind)[:20]!r}")

    def _zero(self, parts: list[Any], low: Any, high: Any) -> Real:
        cell = _fraction(low), _fraction(high)
        if len(parts) > MAX_PARTS or max(c.q.bit_length() for c in cell) > MAX_FINENESS:
            raise FormatError("a zero of a function needs few parts and two moderate ends")
        made = tuple((name, tuple(self.number(n) for n in numbers)) for name, *numbers in parts)
        return zero_between(self._function(made), *cell)


def is_place(value: Any) -> bool:
    """Whether a number refers to the table: an int, or one that the JSON reader kept as its text."""
    return not isinstance(value, str) or getattr(value, "is_json_number", False)


def _digits(integer: int) -> str:
    """Decimal digits, also of integers that Python refuses to write for their length."""
    return str(fmpz(integer))


def _fraction(text: Any) -> fmpq:
    match = FRACTION.fullmatch(text) if isinstance(text, str) and len(text) <= MAX_LENGTH else None
    if match is None:
        raise FormatError(f"not a number: {str(text)[:40]!r}")
    return fmpq(fmpz(match[1]), fmpz(match[2] or "1"))


def _integer(text: Any) -> fmpz:
    fraction = _fraction(text)
    if fraction.q != 1:
        raise FormatError(f"not a whole number: {str(text)[:40]!r}")
    return fraction.p


def _root(coefficients: list[Any], index: Any, power: Any) -> Real:
    if not 2 <= len(coefficients) <= MAX_DEGREE + 1 or not 0 < int(power) < MAX_DEGREE:
        raise FormatError("a root needs a polynomial of moderate degree")
    found = roots([_integer(c) for c in coefficients])
    if not 0 <= int(index) < len(found):
        raise FormatError(f"the polynomial has {len(found)} real roots, not {int(index) + 1}")
    return found[int(index)] ** int(power)
