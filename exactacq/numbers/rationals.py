"""Exact parsing of numbers that users give, and certified rounding of numbers that they are shown."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterable
from decimal import Decimal
from fractions import Fraction
from math import isfinite, nextafter, ulp
from numbers import Rational
from typing import TYPE_CHECKING, TypeAlias

from flint import arb, fmpq, fmpz

from exactacq.errors import FormatError, shown

if TYPE_CHECKING:
    import sympy

MAX_DIGITS = 5000
"""Longest number, in decimal digits, that is accepted as input: keeps hostile files cheap."""

Enclosing: TypeAlias = Callable[[int], arb]
"""A value as a function from working bits to an enclosing ball."""

ZERO = arb(0)
"""To compare with: a number of Python's would be made a ball each time."""

_LITERAL = re.compile(r"[+-]?(\d+(?:\.\d*)?|\.\d+)([eE][+-]?\d{1,6})?(/\d+)?", re.ASCII)


def rational(value: object) -> fmpq:
    """The rational that *value* denotes: int, Fraction, Decimal, finite float (exactly), or a literal.

    Integers and floats of numpy are taken too, also as arrays of no dimension, and integers and rationals of
    sympy and others. A float is the binary fraction that it is: 0.1 is not 1/10, but "0.1" is.

    Literals are integers, decimals, also of `decimal`, and ``"p/q"``.  Raises `FormatError` for anything
    else, for NaN and infinities, and beyond `MAX_DIGITS` digits.
    """
    if isinstance(value, fmpq):
        return value
    if isinstance(value, bool):
        raise FormatError(f"not a number: {value!r}")
    if isinstance(value, (int, fmpz)):
        return fmpq(value)
    if hasattr(value, "rational"):
        if value.rational is None:
            raise FormatError(f"not a rational number: {shown(value)}")
        return value.rational
    if isinstance(value, Fraction):
        return fmpq(value.numerator, value.denominator)
    if isinstance(value, str | Decimal):  # The ratio of Decimal("1e999999999") would take all memory.
        return _literal(str(value).strip())
    if isinstance(value, float) or hasattr(value, "as_integer_ratio"):
        try:
            return fmpq(*value.as_integer_ratio())
        except (ValueError, OverflowError):
            raise FormatError(f"not a finite number: {value!r}") from None
    if isinstance(value, Rational):
        return fmpq(int(value.numerator), int(value.denominator))
    if getattr(value, "shape", None) == () and hasattr(value, "item"):  # an array of no dimension
        item = value.item()
        if item is not value and isinstance(item, int | float):
            return rational(item)
    raise FormatError(f"not a number: {shown(value)}")


def _literal(text: str) -> fmpq:
    match = _LITERAL.fullmatch(text) if len(text) <= MAX_DIGITS else None
    if match is None:
        raise FormatError(f"not a number: {text[:40]!r}")
    numerator, exponent, denominator = match[1], int((match[2] or "e0")[1:]), match[3]
    if abs(exponent) > MAX_DIGITS:
        raise FormatError(f"number out of range: {text[:40]!r}")
    whole, _, part = numerator.partition(".")
    shift = exponent - len(part)
    value = fmpq(fmpz(whole + part or "0")) * (fmpq(10) ** shift)
    if denominator is not None:
        divisor = fmpz(denominator[1:])
        if divisor == 0:
            raise FormatError(f"division by zero: {text[:40]!r}")
        value /= divisor
    return -value if text.startswith("-") else value


def nonfinite(value: object) -> float | None:
    """A float or Decimal that is infinite or NaN, as a float; else None."""
    if isinstance(value, float):
        return None if isfinite(value) else value
    if isinstance(value, Decimal) and not value.is_finite():
        return float("nan") if value.is_nan() else float(value)
    return None


def rational_sign(q: fmpq) -> int:
    """-1, 0 or 1: read off the nearest float, which takes a tenth of the time of comparing with 0."""
    try:
        near = float(q)
    except OverflowError:
        near = 0.0
    if near:
        return 1 if near > 0.0 else -1
    # It is 0, or beyond the range of floats.
    p = q.p
    return 1 if p > 0 else -1 if p else 0


def nearest_float(q: fmpq) -> float:
    """The nearest float, ties to even; OverflowError with a clear message beyond the largest float."""
    try:
        return float(q)
    except OverflowError:
        raise OverflowError("an exact number beyond the range of floats: use decimal or enclosure") from None


def ends(ball: arb) -> tuple[fmpq, fmpq]:
    """The exact ends of a ball (`arb.lower` would round to the global precision)."""
    middle, radius = ball.mid().fmpq(), ball.rad().fmpq()
    return middle - radius, middle + radius


def parted(a: arb, b: arb) -> int:
    """-1 or 1 as one ball lies below another or above it, else 0."""
    return -1 if a < b else 1 if a > b else 0


def ball_sign(ball: arb) -> int:
    """Sign of a ball that excludes 0, else 0; an exact zero ball also gives 0."""
    return 1 if ball > ZERO else -1 if ball < ZERO else 0


def enclose(ball: Enclosing, bits: int) -> tuple[fmpq, fmpq]:
    """Rational ends at most 2^-bits apart from ``ball(working_bits)``, refined as needed."""
    working, width = bits + 64, fmpq(1, fmpz(2) ** bits)
    while True:
        value = ball(working)
        if value.is_finite():  # not so while an inverse cannot exclude 0
            low, high = ends(value)
            if high - low <= width:
                return low, high
        working *= 2


def round_to_float(ball: Enclosing, equals: Callable[[fmpq], bool]) -> float:
    """The float nearest to a value given by balls, ties to even; OverflowError beyond the largest float.

    Balls of 512 bits, or more until they are narrower than the gap between floats, decide unless they contain
    the midpoint of two floats; then ``equals(q)``, an exact comparison of the value with that midpoint, tells
    a tie from a value that refinement settles. A value less than half of the least float is rounded to 0, and
    whether it is 0 need not be proved.
    """
    bits = 64
    while True:
        value = ball(bits)
        if value.is_finite():  # not so while an inverse cannot exclude 0
            near = float(value.mid())
            # Half the way to the next float towards 0, which may be half as far away as the other one. As a
            # ball: half of the least float is no float.
            half = arb(ulp(nextafter(near, 0.0))) / 2
            if isfinite(near) and abs(value - near) < half:
                return near
            if bits >= 512 and value.rad() < half:
                break
        bits *= 2
    low, high = ends(value)
    below, above = nearest_float(low), nearest_float(high)
    if below != above and equals(middle := (rational(below) + rational(above)) / 2):
        return nearest_float(middle)
    while nearest_float(low) != nearest_float(high):
        bits *= 2
        value = ball(bits)
        low, high = ends(value)
    return nearest_float(low)


def decimal_string(ball: Enclosing, digits: int) -> str:
    """Decimal with *digits* significant digits from ``ball(working_bits)``.

    A zero with an exponent if 2^16 bits show none.
    """
    if operator.index(digits) < 1:
        raise ValueError(f"at least 1 digit is needed, not {digits}")
    bits = int(digits * 3.33) + 64
    while True:
        value = ball(bits)
        if value.is_exact() and value == 0:
            return "0"
        text = str(value.str(digits, radius=False))
        if value.rel_accuracy_bits() > digits * 3.33 + 4 or (bits > 1 << 16 and value.contains(0)):
            return text
        bits *= 2


def coprime_base(numbers: Iterable[int]) -> list[int]:
    """Pairwise coprime integers > 1 of which each of the positive numbers is a product of powers."""
    base: list[fmpz] = []
    todo = [fmpz(n) for n in numbers]
    while todo:
        n = todo.pop()
        if n == 1:
            continue
        for index, m in enumerate(base):
            common = m.gcd(n)
            if common != 1:
                del base[index]
                todo += (m // common, common, n // common)
                break
        else:
            base.append(n)
    return [int(m) for m in base]


def valuation(number: int, base: int) -> int:
    """How often a number other than 0 can be divided by *base*."""
    return without(fmpz(number), fmpz(base))[1]


def without(number: fmpz, base: fmpz) -> tuple[fmpz, int]:
    """A number other than 0 without a factor, and how often it held that, by a few divisions a bit."""
    if number % base:
        return number, 0
    rest, squares = without(number // base, base * base)
    return (rest, 2 * squares + 1) if rest % base else (rest // base, 2 * squares + 2)


def plain(value: fmpq) -> str:
    """A rational as people write it, without loss: a decimal if that is finite, else "p/q".

    >>> plain(fmpq(1301, 10)), plain(fmpq(-1, 3)), plain(fmpq(12))
    ('130.1', '-1/3', '12')
    """
    bottom = int(value.q)
    twos, fives = valuation(bottom, 2), valuation(bottom, 5)
    if 2**twos * 5**fives != bottom:
        return f"{value.p}/{value.q}"
    places = max(twos, fives)
    # Digits by flint: Python writes no number of more than 4300.
    digits = str(fmpz(abs(int(value.p)) * 10**places // bottom)).rjust(places + 1, "0")
    point = len(digits) - places
    return ("-" if value < 0 else "") + digits[:point] + (f".{digits[point:]}" if places else "")


def sympy_rational(q: fmpq) -> sympy.Expr:
    """A rational as sympy's."""
    from sympy import Rational

    return Rational(int(q.p), int(q.q))
