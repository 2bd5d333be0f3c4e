"""The sign of an irrational `Real`: by balls; where these contain 0 by a zero test (see `numbers/real`)."""

from __future__ import annotations

from math import prod
from typing import Any

from flint import arb

from exactacq.errors import Undecided
from exactacq.numbers.atoms import Node, Sqrt
from exactacq.numbers.linear_forms import field_of, is_surd, merged
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.tower import vanishes, vanishes_about
from exactacq.numbers.transcendental import generic_in, sign_at

FILTER_BITS = (64, 128, 256)
"""Precisions of the balls that are tried before the zero test: most signs show at the first."""
ZERO_TEST_BITS = 1 << 23
"""Largest precision of the zero test: there an operation takes about a tenth of a second."""
TRIAL_BITS = 1 << 16
"""Precision that is tried where the zero test would be too long: what is not zero shows long before."""
TOWER_BITS = 1 << 12
"""Zero tests that would take more bits compute in the number's field first (see `exactacq.numbers.tower`)."""

SMALL_BITS = 64
"""A number within a ball of the radius 2 to the minus this that contains 0 is mostly 0."""


def decided_sign(value: Any) -> int:
    """-1, 0 or 1 for a `Real`; `Undecided` where excluding 0 would take more than `ZERO_TEST_BITS`."""
    for bits in FILTER_BITS:
        if sign := ball_sign(value.ball(bits)):
            return sign
    terms = value.terms
    if is_surd(terms):
        fewer = merged(terms)
        if len(fewer) < len(terms):
            return int(type(value)._form(fewer).sign())
    elif (tau := generic_in(value)) is not None:
        return 0 if vanishes_about(value) else sign_at(value, tau)
    elif field_of(terms) is None:
        limit = _separation_bits(value)
        zero = None
        if limit > TOWER_BITS:
            if sign := _shown_sign(value):
                return sign
            zero = vanishes(value)
        if zero:
            return 0
        bits = 2 * FILTER_BITS[-1]
        while zero is None:
            ball = value.ball(bits)
            if sign := ball_sign(ball):
                return sign
            if ball.abs_upper() < arb(2) ** -limit:
                return 0
            if limit > ZERO_TEST_BITS and bits >= TRIAL_BITS and ball.is_finite():
                if _is_known_zero(value):
                    return 0
                raise Undecided(
                    f"whether a number that is 0 to {_zeros(ball):,} decimals is 0: a proof would take "
                    f"{limit:,} bits, more than {ZERO_TEST_BITS:,}"
                )
            bits = min(2 * bits, limit + limit // 4 + 4096) if bits < limit else 2 * bits
    bits = 2 * FILTER_BITS[-1]
    while not (sign := ball_sign(value.ball(bits))):
        bits *= 2
    return sign


def _shown_sign(value: Any) -> int:
    """The sign by longer balls, or 0 once one is so small that what lies in it hardly differs from 0.

    Elements of a field may have coefficients of hundreds of digits that nearly cancel; and roots of two
    polynomials may differ by as little as their coefficients are long.
    """
    bits = FILTER_BITS[-1]
    polynomials = [key[0] for key, _ in value.generators() if isinstance(key, tuple)]
    longest = max((c.bit_length() for coefficients in polynomials for c in coefficients), default=0)
    small = arb(2) ** -(SMALL_BITS + longest)
    while value.ball(bits).rad() > small and bits < TOWER_BITS:
        bits *= 2
        if sign := ball_sign(value.ball(bits)):
            return sign
    return 0


def _is_known_zero(value: Any) -> bool:
    """Whether a real that is made of zeros of functions (see `function_zeros`) surely is 0.

    It is if it vanishes whatever numbers it is made of, and if it does so with the value of such a function
    at its zero added or subtracted, which is 0 by definition.
    """
    zeros = [key for key, _ in value.generators() if isinstance(key, Node) and not isinstance(key, Sqrt)]
    if not zeros:
        return False
    known = [number.args[0](type(value).of_atom(number)) for number in zeros]
    return vanishes_about(value, *(value + sign * own for own in known for sign in (-1, 1)))


def _zeros(ball: arb) -> int:
    """How many decimals of all numbers in a ball around 0 are 0."""
    return int(-float((ball.abs_upper().log() / arb(10).log()).mid()))


def _separation_bits(value: Any) -> int:
    """If the value is not 0, its absolute value is at least 2 to the minus this (stage 3)."""
    degree = prod(d for _, d in value.generators())
    return int(min(degree, 1 << 60) * (value.height_bound() + 1)) + 8
