"""Numbers and transforms of SVG, exactly; rotations by angles that are no multiples of 90 degrees nearly.

The cosine and sine of such an angle are irrational: a rational rotation near it keeps circles circles.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.loops.rational_arcs import rational_turn
from exactacq.files.source import MAX_EDGES, one_line
from exactacq.numbers.rationals import MAX_DIGITS, rational

NUMBER = r"[-+]?(?:\d++\.?\d*+|\.\d++)(?:[eE][-+]?\d++)?"
"""Its digits are not given back, else a long number before what is none took quadratic time."""
ZERO, ONE = fmpq(0), fmpq(1)
MAX_TRANSFORMS = 64
"""Most transforms in one attribute."""
MAX_BITS = 4 * MAX_DIGITS
"""Longest numbers of a matrix: rotations within rotations make them longer and longer."""
_PART = re.compile(rf"[\s,]+|({NUMBER})", re.ASCII)
_CALL = re.compile(r"[\s,]*(\w+)\s*\(([^()]*)\)")
_COUNTS = {
    "matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Matrix:
    """(x, y) -> (a x + c y + e, b x + d y + f); *error* bounds by how many radians its rotations are off."""

    a: fmpq = ONE
    b: fmpq = ZERO
    c: fmpq = ZERO
    d: fmpq = ONE
    e: fmpq = ZERO
    f: fmpq = ZERO
    error: fmpq = ZERO

    def __call__(self, x: fmpq, y: fmpq) -> tuple[fmpq, fmpq]:
        """The image of a point."""
        return self.a * x + self.c * y + self.e, self.b * x + self.d * y + self.f

    def after(self, m: Matrix) -> Matrix:
        """First another one, then this one."""
        made = Matrix(
            self.a * m.a + self.c * m.b,
            self.b * m.a + self.d * m.b,
            self.a * m.c + self.c * m.d,
            self.b * m.c + self.d * m.d,
            *self(m.e, m.f),
            self.error + m.error,
        )
        if any(max(v.p.bit_length(), v.q.bit_length()) > MAX_BITS for v in (made.a, made.b, made.e, made.f)):
            raise FormatError("transforms within transforms need too long numbers; apply them")
        return made

    @property
    def determinant(self) -> fmpq:
        """Negative if the image is mirrored, 0 if it is flat."""
        return self.a * self.d - self.b * self.c

    def is_similar(self) -> bool:
        """Whether circles stay circles."""
        across = self.a * self.c + self.b * self.d
        return bool(across == 0 and self.a**2 + self.b**2 == self.c**2 + self.d**2)


def numbers(text: str, what: str) -> list[fmpq]:
    """Numbers that are parted by blanks and commas, or by their signs alone."""
    found, place = [], 0
    for match in _PART.finditer(text):
        if match.start() != place:
            break
        place = match.end()
        if match[1]:
            found.append(rational(match[1]))
        if len(found) > 2 * MAX_EDGES:
            raise FormatError(f"{what}: more than {2 * MAX_EDGES} numbers; export only the part that matters")
    if place < len(text):
        raise FormatError(f"{what}: numbers are needed, not {one_line(repr(text[place : place + 20]))}")
    return found


def transform(text: str) -> Matrix:
    """The matrix of a transform attribute; `FormatError` for what is none."""
    matrix, place = Matrix(), 0
    for _ in range(MAX_TRANSFORMS):
        call = _CALL.match(text, place)
        given = numbers(call[2], "transform") if call else []
        if call is None or len(given) not in _COUNTS.get(call[1], ()):
            break
        matrix, place = matrix.after(_matrix(call[1], given)), call.end()
    if text[place:].strip(" \t\r\n,"):
        raise FormatError(f"not a transform: {one_line(repr(text[place : place + 40]))}")
    return matrix


def _matrix(name: str, given: list[fmpq]) -> Matrix:
    if name == "matrix":
        return Matrix(*given)
    if name == "translate":
        return Matrix(e=given[0], f=given[1] if given[1:] else fmpq(0))
    if name == "scale":
        return Matrix(a=given[0], d=given[-1])
    if name == "rotate":
        (cosine, sine), error = rational_turn(given[0])
        turn = Matrix(cosine, sine, -sine, cosine, error=error)
        if not given[1:]:
            return turn
        x, y = given[1:]
        return Matrix(e=x, f=y).after(turn).after(Matrix(e=-x, f=-y))
    (cosine, sine), error = rational_turn(given[0])
    if not cosine:
        raise FormatError(f"{name} by {given[0]} degrees has no image")
    slope = sine / cosine
    error *= 1 + slope * slope
    return Matrix(c=slope, error=error) if name == "skewX" else Matrix(b=slope, error=error)
