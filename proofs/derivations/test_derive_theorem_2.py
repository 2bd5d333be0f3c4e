"""Bounds (5)-(11) and the corrected Theorem 2 from what a sweep walks."""

from __future__ import annotations

import pytest
from formulas import (
    HALF,
    PRINTED,
    assert_derives,
    height,
    is_same,
    n,
    n_0,
    p_max,
    pairs,
    perimeters,
    r,
    radius,
    strip,
    width,
    with_one_coefficient_changed,
)
from sympy import Expr, Max, Min, Piecewise, Rational, Symbol, ceiling, expand, simplify, symbols

whole, onward = Symbol("whole", positive=True), Symbol("onward", nonnegative=True)
"""A perimeter, and where on the boundary the robot goes next, seen from H or from an end."""


# -- what one obstacle costs -----------------------------------------------------------------------


def worst(cost: Expr, *free: Symbol) -> Expr:
    """The largest value of a piecewise linear cost over *free* in [0, whole]: at 0, whole/2 or whole."""
    values = [cost]
    for symbol in free:
        values = [v.subs(symbol, end) for v in values for end in (0, whole / 2, whole)]
    return simplify(Max(*values))


def acquisition(clear: bool) -> Expr:
    """Circling an obstacle and walking to where the robot leaves, at most."""
    if clear:
        return worst(whole + Min(onward, whole - onward), onward)
    begun = Symbol("begun", nonnegative=True)
    return worst(begun + whole + onward, begun, onward)


def aim(clear: bool) -> Expr:
    """Circling the aim of a diversion and walking back to Q: no shore is longer than its two ways."""
    begun = Symbol("begun", nonnegative=True)
    return whole if clear else expand(begun + whole + (whole - begun))


def passing(clear: bool) -> Expr:
    """Passing a known obstacle, at most."""
    return worst(Min(onward, whole - onward) if clear else onward, onward)


@pytest.mark.parametrize(("clear", "alpha", "kappa"), [(True, 3 * HALF, HALF), (False, 3, 1)])
def test_shares_of_a_perimeter(clear: bool, alpha: Rational, kappa: Rational) -> None:
    """SSS-7: 1.5 p and p/2 clear of the border, else 3 p and p. The aim leaves room for one passing."""
    assert acquisition(clear) == alpha * whole
    assert passing(clear) == kappa * whole
    assert is_same(aim(clear) + passing(clear), alpha * whole)


def test_the_cost_is_linear_between_the_ends() -> None:
    """What `worst` relies on: the shorter way grows to half of the boundary and shrinks again."""
    u = Symbol("u", positive=True)
    way = Min(u, 1 - u).rewrite(Piecewise)
    assert [piece.diff(u) for piece, _ in way.args] in ([1, -1], [-1, 1])


# -- the straight parts ----------------------------------------------------------------------------


def lines_and_joints(joints: Expr) -> Expr:
    """r + 1 lines of length A, joined along the border."""
    return (r + 1) * height + joints


def passings() -> Expr:
    """The visits of Lemma 3 that acquire nothing."""
    return PRINTED["(4)"] - n


def total(joints: Expr, reach: Expr, clear: bool, passed: Expr) -> Expr:
    """M-line, n diversions of *reach* there and back, n acquisitions, passings there and back."""
    alpha, kappa = acquisition(clear) / whole, passing(clear) / whole
    return lines_and_joints(joints) + n * 2 * reach + alpha * perimeters + passed * 2 * kappa * p_max


def test_5_from_its_parts() -> None:
    assert_derives(total(r * strip, strip, False, passings()), "(5)")


def test_6_from_its_parts() -> None:
    """With the joints as long as they are, B, and diversions as long as R."""
    assert_derives(total(width, radius, False, passings()), "(6)")


def test_6_is_5_where_strips_fill_the_terrain_and_are_as_wide_as_the_radius() -> None:
    """r = B/R as in print: then r w = B in the joints, and w = R in the diversions. Both are needed."""
    unrolled = expand(PRINTED["(5)"])
    joints = unrolled.coeff(strip).coeff(n, 0) * strip
    diversions = unrolled.coeff(strip).coeff(n, 1) * n * strip
    assert is_same(joints, r * strip)
    assert is_same(diversions, 2 * n * strip)
    rest = unrolled - joints - diversions
    assert_derives(rest + joints.subs(r, width / strip) + diversions.subs(strip, radius), "(6)")
    assert not is_same(rest + joints + diversions.subs(strip, radius), PRINTED["(6)"])
    assert not is_same(rest + joints.subs(r, width / strip) + diversions, PRINTED["(6)"])


def test_5_exceeds_6_by_what_the_last_strip_lacks() -> None:
    """With w = R: by rw - B, which is 0 or more and less than w. (6) still holds, as the M-line is B wide."""
    excess = expand((PRINTED["(5)"] - PRINTED["(6)"]).subs(strip, radius))
    assert is_same(excess, r * radius - width)
    full = Symbol("full", integer=True, nonnegative=True)
    share = Symbol("share", positive=True)
    for part in (Rational(1, 1000), HALF, 1):
        count = ceiling(full + part)
        assert count == full + 1
        lacking = (count * radius - (full + share) * radius).subs(share, part)
        share_lacking = simplify(lacking / radius)
        assert is_same(share_lacking, 1 - part)
        assert 0 <= share_lacking < 1


def test_5_is_less_than_6_in_a_narrow_terrain() -> None:
    """B < R: one strip, w = B. (5) lets a diversion be B long only, (6) lets it be R long."""
    spare = Symbol("spare", positive=True)
    gap = (PRINTED["(6)"] - PRINTED["(5)"]).subs({r: 1, strip: width, radius: width + spare})
    assert is_same(gap, 2 * n * spare)


def test_7_the_five_terms() -> None:
    terms = {
        "a1": lines_and_joints(width),
        "a2": n * 2 * radius,
        "a3": acquisition(False) / whole * perimeters,
        "a4": n * n_0 * 2 * passing(False) / whole * p_max,
        "a5": (passings() - n * n_0) * 2 * passing(False) / whole * p_max,
    }
    assert is_same(terms["a1"], height + width + r * height)
    assert is_same(terms["a4"], 2 * n * n_0 * p_max)
    assert is_same(terms["a5"], p_max * pairs)
    assert_derives(sum(terms.values()), "(6)")


# -- the cases -------------------------------------------------------------------------------------


def test_8_is_the_m_line_alone() -> None:
    assert_derives(lines_and_joints(width), "(8)")


def test_9_is_6_without_passings() -> None:
    assert_derives(total(width, radius, False, n * 0), "(9)")


def test_10_is_6_clear_of_the_border() -> None:
    """The last term's half is unreadable in the scan; it follows from p/2 for a passing."""
    assert_derives(total(width, radius, True, passings()), "(10)")


def test_11_is_both() -> None:
    assert_derives(total(width, radius, True, n * 0), "(11)")


# -- corrected -------------------------------------------------------------------------------------


@pytest.mark.parametrize("clear", [True, False])
@pytest.mark.parametrize("stays", [True, False])
def test_corrected_theorem_2(clear: bool, stays: bool) -> None:
    """Diversions as long as they are, hits on the M-line again, aims that are passed on the way to them.

    ``met`` is the sum of re_i p_i, ``aims`` the sum of p over such aims. If diversions stay in their strips
    the pairs are those of (4) at most, else all.
    """
    ways, met, aims, m_line = symbols("ways met aims m_line", nonnegative=True)
    alpha, kappa = (3 * HALF, HALF) if clear else (3, 1)
    meetings = passings() if stays else n * (n - 1) / 2
    circled = acquisition(clear) / whole * perimeters
    passed = passing(clear) / whole * (met + aims + 2 * meetings * p_max)
    derived = m_line + 2 * ways + circled + passed
    bracket = 2 * n * n_0 * p_max + p_max * pairs if stays else n * (n - 1) * p_max
    corrected = m_line + 2 * ways + alpha * perimeters + kappa * bracket + kappa * met + kappa * aims
    assert is_same(derived, corrected)
    assert not any(is_same(derived, other) for other in with_one_coefficient_changed(corrected))


def test_corrected_theorem_2_without_premises() -> None:
    """At most n aims are passed, each costs p_max at most: n (n - 1) and n make n^2."""
    assert is_same(n * (n - 1) * p_max + n * p_max, n**2 * p_max)
