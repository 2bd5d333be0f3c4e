"""Real roots of integer polynomials as balls: isolation and refinement, on flint alone."""

from __future__ import annotations

from functools import lru_cache

from flint import arb, fmpz_poly

from exactacq.numbers.precision import workprec


@lru_cache(maxsize=1 << 10)
def isolated_roots(coefficients: tuple[int, ...]) -> list[arb]:
    """Balls of the real roots of an irreducible polynomial, ascending, in which its slope has a sign.

    *coefficients* ascend. The slope's sign makes a ball fit to start `refined`; the precision doubles
    until all balls are, which ends since the roots of an irreducible polynomial are simple.
    """
    polynomial = fmpz_poly(list(coefficients))
    slope = polynomial.derivative()
    bits = 64
    while True:
        with workprec(bits):
            balls = [root.real for root, _ in polynomial.complex_roots() if root.imag == 0]
            if all(slope(ball) > 0 or slope(ball) < 0 for ball in balls):
                return sorted(balls, key=lambda ball: ball.mid().fmpq())
        bits *= 2


def refined(coefficients: tuple[int, ...], index: int) -> arb:
    """Real root number *index* (from the left), to the working precision that the caller has set.

    Interval Newton steps from the isolating ball, about one for each doubling of the precision; a
    step that gains less than one bit has reached the rounding errors.
    """
    polynomial, ball = fmpz_poly(list(coefficients)), isolated_roots(coefficients)[index]
    slope = polynomial.derivative()
    while True:
        middle = ball.mid()
        finer = middle - polynomial(middle) / slope(ball)
        if not finer.rad() < ball.rad() / 2:
            return ball
        ball = finer
