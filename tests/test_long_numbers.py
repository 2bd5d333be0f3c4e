"""Numbers of thousands of digits: squares in radicands, and how places are written."""

from __future__ import annotations

import re
import time
from fractions import Fraction
from itertools import product
from math import isqrt, sqrt

import pytest
from flint import fmpq

from exactacq import Length, Outline, Scene, sightseer
from exactacq.geometry.points import Point
from exactacq.numbers.atoms import Node, square_free
from exactacq.numbers.exact import LONGEST
from exactacq.numbers.linear_forms import CONTENT_BITS
from exactacq.numbers.rationals import plain
from exactacq.numbers.real import Real
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
    assert f"{Real('1e5000'):.2f}" == f"{Length('1e5000'):.2f}" == "1" + "0" * 5000 + ".00"
    near = Point(fmpq(1, 3**9999) + 2, fmpq(-(10**5000) - 1, 10**5000))
    assert place_text(near) == "(2.000000000, -1.000000000)"


def test_all_digits_are_right_of_numbers_that_nearly_cancel() -> None:
    """A ball of 2^17 bits shows the sign of such a number, and few of its digits."""
    bits = 131_050
    tiny = Real(2).sqrt() - Real(fmpq(isqrt(2 << 2 * bits), 1 << bits))
    shown = tiny.decimal(30)
    tiny.ball(4 * bits)
    assert shown == tiny.decimal(30) == "4.66432708153402882771756026306e-39452"


def test_what_would_take_minutes_to_write_is_told_by_digits() -> None:
    """Lengths up to events between two C shapes: a closed form has some 10^6 characters."""
    bulge, inner = Fraction(37321, 10000), Fraction(-37321, 10000)
    shapes = [
        Outline(
            [("3.291", "1.9", bulge), ("3.291", "-1.9", 1), ("2.944", "-1.7", inner), ("2.944", "1.7", 1)]
        ),
        Outline(
            [("-4.33", "-2.5", bulge), ("-4.33", "2.5", 1), ("-3.984", "2.3", inner), ("-3.984", "-2.3", 1)]
        ),
    ]
    texts = [str(event.at) for event in sightseer(Scene(shapes, start=(7, 0), radius=3)).events]
    long = [text for text in texts if text.endswith("...")]
    assert long and all(len(text) < 40 for text in long)
    assert any("sqrt" in text for text in texts) and max(map(len, texts)) <= LONGEST
    assert str(Length.arc(1, "3/5", "4/5") + 1) == "2*atan(1/2) + 1"


def test_numbers_made_of_one_another_stay_short() -> None:
    """The content of a long form, as many bits as all of it, was taken out and multiplied at each step.

    A robot that halted at 14 places, each made of the one before, had coefficients of four million bits.
    """
    x, rough = Real(2).sqrt(), sqrt(2)
    for n in range(40):
        x = (x * x / 7 + x / (n + 3) + Real(1) / 3).sqrt() * (1 + x / (n + 5))
        rough = sqrt(rough * rough / 7 + rough / (n + 3) + 1 / 3) * (1 + rough / (n + 5))
    assert 256 < _longest_coefficient(x) < 2 * CONTENT_BITS
    assert float(x) == pytest.approx(rough, rel=1e-9)


def _longest_coefficient(value: Real) -> int:
    longest, ahead, seen = 0, [value], set()
    while ahead:
        for atom, c in ahead.pop().terms.items():
            longest = max(longest, int(c.height_bits()))
            if isinstance(atom, Node) and atom not in seen:
                seen.add(atom)
                ahead.extend(atom.args)
    return longest


def test_a_form_that_is_long_only_when_written_out_is_shown_by_digits() -> None:
    """Each step holds the one before four times: written out it would be megabytes."""
    number = Real(2).sqrt()
    for _ in range(10):
        number = (number * (number + 1).sqrt() + number + 3).sqrt() + number
    begin = time.process_time()
    assert re.fullmatch(r"\d+\.\d{20,30}\.\.\.", str(number))
    assert time.process_time() - begin < 5
    assert str((Real(2).sqrt() + 1).sqrt()) == "sqrt(1 + sqrt(2))"
