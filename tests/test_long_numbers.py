"""Numbers of thousands of digits: squares in radicands, and how places are written."""

from __future__ import annotations

from itertools import product
from math import isqrt

import pytest
from flint import fmpq

from exactacq.geometry.points import Point
from exactacq.numbers.atoms import square_free
from exactacq.numbers.rationals import plain
from exactacq.scene.validation import place_text

PRIME = 2**2203 - 1
"""A Mersenne prime: nothing is found in it."""


@pytest.mark.parametrize(
    ("side", "rest"),
    list(product((1, 2, 2**40 * 3**7, 4093**2, 4093 * 4091), (1, 6, 4093, PRIME, 2 * PRIME))),
)
def test_small_squares_are_found(side: int, rest: int) -> None:
    assert square_free(side * side * rest) == (side, rest)


@pytest.mark.parametrize("root", [PRIME, 10**700 + 1, 3 * PRIME])
def test_a_long_square_is_found(root: int) -> None:
    assert square_free(root * root) == (root, 1)
    assert square_free(12 * root * root * 7**2) == (14 * root, 3)


def test_a_long_radicand_keeps_its_value() -> None:
    for n in (10**900 + 7, 3**2000 * 5**3, isqrt(7 * 10**1400)):
        side, rest = square_free(n)
        assert side * side * rest == n


def test_numbers_beyond_what_python_writes_are_written() -> None:
    """Python refuses to write integers of more than 4300 digits; a place in a hostile drawing had more."""
    assert plain(fmpq(10**6000 + 1, 4)) == "25" + "0" * 5998 + ".25"
    assert plain(fmpq(-1, 2**5000)).startswith("-0.000")
    near = Point(fmpq(1, 3**9999) + 2, fmpq(-(10**5000) - 1, 10**5000))
    assert place_text(near) == "(2.000000000, -1.000000000)"
