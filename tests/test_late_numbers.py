"""Late numbers: known by a ball until more is asked, and then equal to what they stand for."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from fractions import Fraction

import pytest
from flint import arb
from hypothesis import given
from hypothesis import strategies as st

from exactacq.numbers.real import Real

NUMBERS = st.builds(
    lambda p, q, root: Real(Fraction(p, q)) + Real(root).sqrt(),
    st.integers(-9, 9),
    st.integers(1, 4),
    st.integers(0, 5),
)


def late(value: Real, spread: float, made: list[Real]) -> Real:
    """A late number that notes when it is made."""

    def make() -> Real:
        made.append(value)
        return value

    return Real.late(arb(float(value), spread + 1e-12), make)


@given(NUMBERS, NUMBERS, st.sampled_from([0.0, 1e-3, 1.0]))
def test_order_and_arithmetic(a: Real, b: Real, spread: float) -> None:
    """A late number compares, adds and prints like the number it stands for."""
    uses: list[Callable[[Real], object]] = [
        lambda x: x.compare(b),
        b.compare,
        lambda x: x == b,
        lambda x: x < b,
        lambda x: x.sign(),
        bool,
        lambda x: x + b,
        lambda x: b - x,
        lambda x: x * b,
        str,
        float,
        lambda x: x.rational,
        lambda x: x.terms,
        lambda x: x.key,
        lambda x: x.enclosure(200),
        lambda x: x.overlaps(b),
        lambda x: x.clear_sign(128),
        lambda x: pickle.loads(pickle.dumps(x)),
    ]
    for use in uses:
        made: list[Real] = []
        assert use(late(a, spread, made)) == use(a)
        assert len(made) <= 1


def test_what_the_ball_decides_makes_nothing() -> None:
    """Signs and comparisons that the ball decides leave the number late."""
    made: list[Real] = []
    x, y = late(Real(2).sqrt(), 0.1, made), late(Real(3).sqrt(), 0.1, made)
    assert x < y and y > x and x.compare(2) < 0 < x.sign() and x.clear_sign(64) == 1
    assert x.compare(x) == 0 and not x.overlaps(y) and x.is_late and not made
    assert abs(x.rough() - 1.4142) < 1e-3
    assert x * x == 2 and not x.is_late and len(made) == 1


def test_a_failure_to_make_shows() -> None:
    """What goes wrong when a late number is made is not taken for a missing attribute."""

    def make() -> Real:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        assert Real.late(arb(0, 1), make) + 1
