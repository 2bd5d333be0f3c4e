"""A short rational strictly between two reals: it serves as a sample point of a cell."""

from __future__ import annotations

from math import floor, frexp

from flint import arb, fmpq, fmpz

from exactacq.numbers.rationals import ends, nearest_float
from exactacq.numbers.real import Real


def rational_between(low: Real, high: Real) -> fmpq:
    """A short rational strictly between two reals, near their middle; floats propose it where they can."""
    if low.is_late or high.is_late:
        left, right = low.ball(64), high.ball(64)
        a, b = float(left) + float(left.rad()), float(right) - float(right.rad())
        if b - a > 1e-9:
            between = fmpq(*((a + b) / 2).as_integer_ratio())
            if left < arb(between) < right:
                return between
        if left < right:
            return _dyadic_between(ends(left)[1], ends(right)[0])
    first, last = low.rational, high.rational
    if first is not None and last is not None:
        a, b = nearest_float(first), nearest_float(last)
        if b - a > 1e-9:
            scale = 1 << max(4 - frexp(b - a)[1], 0)
            between = fmpq(floor((a + b) / 2 * scale), scale)
            if first < between < last:
                return between
    bits = 64
    while True:
        (_, left_end), (right_end, _) = low.enclosure(bits), high.enclosure(bits)
        if left_end < right_end:
            return _dyadic_between(left_end, right_end)
        bits *= 2


def short_between(low: Real, high: Real) -> fmpq:
    """A rational strictly between two reals that is about as short as their distance allows."""
    first = rational_between(low, high)
    last = rational_between(Real(first), high)
    return rational_between(Real(first), Real(last))


def _dyadic_between(low: fmpq, high: fmpq) -> fmpq:
    """A multiple of a power of two between two rationals, near their middle."""
    scale = fmpz(2) ** (int((1 / (high - low)).ceil().bit_length()) + 3)
    return fmpq(((low + high) / 2 * scale).floor(), scale)
