"""M20(k): a thin bar across k lines. Its length in closed form, and where it breaks which bound.

w = R = 1, A = 4, B = k + 1, one rectangle [0.1, k + 0.9] x [2, 2.01].
"""

from __future__ import annotations

import pytest
from formulas import PRINTED, height, i, n, ns, p_max, pairs, perimeters, r, radius, strip, width
from sympy import Expr, Min, Poly, Rational, Symbol, expand, floor, limit, oo, real_roots, summation

from exactacq import seed_spreader
from exactacq.files import gallery

k, m = Symbol("k", integer=True, positive=True), Symbol("m", integer=True, positive=True)
TENTH, THICK = Rational(1, 10), Rational(1, 100)
CASES = {"(11)": 3, "(10)": 6, "(9)": 8, "(6)": 16}
"""The least k that breaks a bound."""


def perimeter(lines: Expr) -> Expr:
    return 2 * ((lines + 1 - 2 * TENTH) + THICK)


def way_round(line: Expr, lines: Expr) -> Expr:
    """From one side of the bar to the other at x = line, by the nearer end."""
    return 2 * Min(line - TENTH, lines + 1 - TENTH - line) + THICK


def walked(lines: int) -> Expr:
    """What a sweep walks, part by part: the free M-line, one circle, and a way round on every line."""
    m_line = (lines + 2) * 4 + (lines + 1)
    return m_line - lines * THICK + perimeter(lines) + sum(way_round(x, lines) for x in range(1, lines + 1))


def closed_form(lines: Expr) -> Expr:
    """P = 6.8 k + 10.62 + 2 floor((k + 1)^2 / 4)."""
    return Rational(34, 5) * lines + Rational(531, 50) + 2 * floor((lines + 1) ** 2 / Rational(4))


def bound(name: str, lines: Expr) -> Expr:
    """A printed bound on M20(k): n = n_0 = 1, r = B = k + 1, no pairs."""
    values = {n: 1, r: lines + 1, height: 4, width: lines + 1, radius: 1, strip: 1, p_max: perimeter(lines)}
    return PRINTED[name].subs({pairs: 0, perimeters: perimeter(lines), ns[0]: 1}).subs(values)


PARITIES = [(2 * m, m * (m + 1)), (2 * m - 1, m**2)]
"""Even and odd k in terms of m = 1, 2, ..., and floor((k + 1)^2 / 4) for them."""


def length(lines: Expr, square: Expr) -> Expr:
    """The closed form as a polynomial in m."""
    return closed_form(k).subs(floor((k + 1) ** 2 / 4), square).subs(k, lines)


@pytest.mark.parametrize(("lines", "square"), PARITIES)
def test_the_closed_form_by_summation(lines: Expr, square: Expr) -> None:
    """The ways round are symmetric: the western half is summed and doubled, less the middle for odd k."""
    assert all(square.subs(m, v) == floor((lines.subs(m, v) + 1) ** 2 / Rational(4)) for v in range(1, 9))
    west = summation(i - TENTH, (i, 1, m))
    nearer = 2 * west - (2 * m - lines) * (m - TENTH)
    rounds = 2 * nearer + lines * THICK
    total = (lines + 2) * 4 + lines + 1 - lines * THICK + perimeter(lines) + rounds
    assert expand(total - length(lines, square)) == 0


@pytest.mark.parametrize("lines", range(1, 30))
def test_the_closed_form_is_what_is_walked(lines: int) -> None:
    assert walked(lines) == closed_form(lines)


@pytest.mark.parametrize("lines", CASES.values())
def test_the_closed_form_is_what_the_sweep_walks(lines: int) -> None:
    assert seed_spreader(gallery.scene(f"m20-{lines}")).length.sympy() == closed_form(lines)


@pytest.mark.parametrize(("name", "least"), CASES.items())
def test_the_least_k_that_breaks_a_bound(name: str, least: int) -> None:
    """Exactly; and all k from there on do, for the excess has no root beyond."""
    assert all(closed_form(lines) <= bound(name, lines) for lines in range(1, least))
    for lines, square in PARITIES:
        excess = Poly(expand(length(lines, square) - bound(name, lines)), m)
        first = min(v for v in range(1, 20) if lines.subs(m, v) >= least)
        assert excess.LC() > 0
        assert all(root < first for root in real_roots(excess))


@pytest.mark.parametrize(("lines", "square"), PARITIES)
def test_the_length_grows_like_half_the_square_of_k(lines: Expr, square: Expr) -> None:
    """While (6), the largest of the bounds, is linear in k."""
    assert limit(length(lines, square) / lines**2, m, oo) == Rational(1, 2)
    assert limit(length(lines, square) / bound("(6)", lines), m, oo) == oo
    assert Poly(expand(bound("(6)", k)), k).degree() == 1


@pytest.mark.parametrize(("lines", "square"), PARITIES)
def test_what_is_met_again_pays_for_it(lines: Expr, square: Expr) -> None:
    """With p/2 for each of k - 1 meetings the bound holds for every k; in the limit it is twice as large."""
    corrected = bound("(10)", lines) + (lines - 1) * perimeter(lines) / 2
    spared = Poly(expand(corrected - length(lines, square)).subs(m, m + 1), m)
    assert all(c >= 0 for c in spared.all_coeffs()), "no coefficient is negative in m - 1"
    assert limit(corrected / length(lines, square), m, oo) == 2
