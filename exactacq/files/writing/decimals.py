"""Exact coordinates as numbers of a file, with proven bounds of how far they moved."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from flint import fmpq

from exactacq.files.writing.sheet import Sheet
from exactacq.geometry.curves import Arc
from exactacq.numbers.rationals import plain, rational
from exactacq.numbers.real import Real

DIGITS = 17
"""Significant digits of numbers that are no finite decimals, counted from the largest coordinate: no double
resolves more."""
KEPT = 60
"""Finite decimals of at most so many characters are written in full."""
SPARE_BITS = 70
"""Bits of an enclosure beyond those of the rounding: what they leave open is 10^-20 of it."""


@dataclass(frozen=True, slots=True)
class Precision:
    """How a format holds numbers: with so many decimal ``places``, or, if None, as doubles.

    A double stands for the shortest decimal that denotes it, as readers take it.
    """

    places: int | None

    @classmethod
    def of(cls, sheet: Sheet) -> Precision:
        """Decimals as fine as `DIGITS` digits of the largest coordinate (or radius) of a sheet."""
        return cls(DIGITS - _magnitude(_reaches(sheet)))

    def rounded(self, value: Real) -> tuple[fmpq, fmpq]:
        """The number of the file, and an upper bound of its distance from the value."""
        return _double(value) if self.places is None else _decimal(value, self.places)

    def share(self, value: Real) -> tuple[fmpq, fmpq]:
        """A number without unit, such as a bulge, with a bound of its distance from the value."""
        return _double(value) if self.places is None else _decimal(value, DIGITS)


def text(value: fmpq) -> str:
    """A finite decimal as it is written."""
    assert is_decimal(value), "what is written was rounded to a finite decimal"
    return plain(value)


def is_decimal(value: fmpq) -> bool:
    """Whether a rational is a finite decimal."""
    return "/" not in plain(value)


def _double(value: Real) -> tuple[fmpq, fmpq]:
    near = rational(repr(float(value)))
    size = near or fmpq(1, 1 << 1074)
    bits = SPARE_BITS + max(0, int(size.q).bit_length() - int(abs(size.p)).bit_length() + 53)
    return near, _apart(value, near, bits)


def _decimal(value: Real, places: int) -> tuple[fmpq, fmpq]:
    q = value.rational
    if q is not None and int(q.q).bit_length() <= 4 * KEPT:
        full = plain(q)
        if "/" not in full and len(full) <= KEPT:
            return q, fmpq(0)
    unit = fmpq(10) ** -places
    bits = SPARE_BITS + max(0, 4 * places)
    low, high = value.enclosure(bits)
    near = ((low + high) / 2 / unit + fmpq(1, 2)).floor() * unit
    return fmpq(near), max(abs(high - near), abs(near - low))


def _apart(value: Real, near: fmpq, bits: int) -> fmpq:
    low, high = value.enclosure(bits)
    return max(abs(high - near), abs(near - low))


def _reaches(sheet: Sheet) -> Iterable[float]:
    for item in sheet.items:
        for point in item.points:
            yield from map(abs, point.xy)
        for curve in item.curves:
            if isinstance(curve, Arc) and curve.full:
                yield float(curve.radius)


def _magnitude(sizes: Iterable[float]) -> int:
    """Digits before the point of the largest number; negative for small ones."""
    largest = max(sizes, default=1.0) or 1.0
    return int(f"{largest:e}".partition("e")[2]) + 1
