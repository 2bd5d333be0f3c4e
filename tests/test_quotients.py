"""Quotients of lengths: their order, by their values."""

from __future__ import annotations

import itertools

import mpmath
import pytest
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st

from exactacq.errors import FormatError, Undecided
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real


@given(st.lists(st.integers(-3, 3), min_size=8, max_size=8))
def test_quotients_are_ordered_as_their_values(rows: list[int]) -> None:
    """Ties too, where both divisors or both dividends have no angles, or are equal."""
    roots = [Real(0), Real(1), Real(5).sqrt(), Real("1/3")]
    lengths = [
        Length(roots[abs(k)]) * k + Length.turns(fmpq(m, 2)) for k, m in zip(rows[:4], rows[4:], strict=True)
    ]
    for a, b, c, d in itertools.permutations(lengths):
        if not (b.sign() and d.sign()):
            continue
        first, second = a / b, c / d
        with mpmath.workdps(60):
            x, y = (value(q.top) / value(q.bottom) for q in (first, second))
            expected = 0 if abs(x - y) < mpmath.mpf(10) ** -50 else 1 if x > y else -1
        try:
            assert first.compare(second) == expected
        except Undecided:
            tells = (a.is_algebraic and c.is_algebraic) or (b.is_algebraic and d.is_algebraic)
            assert expected == 0 and not tells and a != c and b != d


def test_a_rational_quotient_is_compared_exactly_from_both_sides() -> None:
    half, same = Length(1) / Length(2), Length.turns(1) / Length.turns(2)
    assert half == same and same == half and half.compare(Length.turns(-2) / Length.turns(-5)) == 1


def test_a_quotient_is_not_compared_with_a_number_of_long_form() -> None:
    """To refuse it no closed form is written, which would take seconds."""
    nested = Real(2)
    for k in range(100):
        nested = (nested + k).sqrt()
    with pytest.raises(TypeError, match="cannot compare"):
        (Length(1) / Length.turns(1)).compare(nested)
    with pytest.raises(FormatError, match=r"not a rational number: <Real 10\."):
        Length.turns(1, nested)


def value(length: Length) -> mpmath.mpf:
    return mpmath.mpf(length.decimal(60))
