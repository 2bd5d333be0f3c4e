"""Exact numbers as floats with bounds of the error, as the compiled loops take them.

The switch `exactacq.kernel.EXACT_ONLY` makes all bounds infinite, so that nothing is decided by floats. Code
that has a bound of its own passes it through `margin`; so does what prunes with lower bounds, which are then
-inf.
"""

from __future__ import annotations

from math import inf

from exactacq import kernel
from exactacq.kernel.bounded import TINY, UNIT
from exactacq.numbers.rationals import nearest_float
from exactacq.numbers.real import Real


def margin(error: float) -> float:
    """A bound of errors, as verdicts of floats take it: infinite if tests want nothing decided by floats."""
    return inf if kernel.EXACT_ONLY else error


def rough(value: Real) -> float:
    """A float that is off by at most `UNIT` times a number, or times `TINY` if that is more."""
    if not value.is_late and value.rational is not None:
        return nearest_float(value.rational)
    bits = 64
    while True:
        ball = value.ball(bits)
        if ball.is_finite():  # not so while an inverse cannot exclude 0
            middle = nearest_float(ball.mid().fmpq())
            if float(ball.rad()) <= 2.0**-55 * max(abs(middle), TINY):
                return middle
        bits *= 2


def float_ball(t: Real) -> tuple[float, float]:
    """A float near a parameter, with a bound of its error: of a late one what its ball tells."""
    if t.is_late or t.rational is None:
        bits = 64
        ball = t.ball(bits)
        while not t.is_late and not ball.rad() <= 2.0**-52 * max(abs(float(ball)), 1.0):
            bits *= 2
            ball = t.ball(bits)
        middle = float(ball)
        return middle, margin(2.0 * float(ball.rad()) + UNIT * abs(middle) + TINY)
    middle = nearest_float(t.rational)
    return middle, margin(UNIT * max(abs(middle), TINY))
