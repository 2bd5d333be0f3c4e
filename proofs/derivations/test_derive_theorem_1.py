"""Bounds (1) and (2), and the corrected Theorem 1, from the counts of Lemmas 1 and 2."""

from __future__ import annotations

import pytest
from formulas import (
    HALF,
    PRINTED,
    approach,
    assert_derives,
    d_max,
    is_same,
    n,
    p_last,
    p_max,
    perimeters,
    radius,
    v_max,
    with_one_coefficient_changed,
)
from scenes import comb
from sympy import Expr, IndexedBase, Min, Rational, Symbol, expand, interpolate, limit, oo, symbols
from trees import Walk, walks

from exactacq import Length
from exactacq.study.claims.model import Case
from exactacq.visibility.links import START

SIZES = range(2, 8)
"""Numbers of obstacles for which all ordered trees are walked: 1 to 132 trees each."""


def most(count) -> Expr:
    """The largest value of a count over all walks, as a polynomial in n that all sizes obey."""
    values = [(size, max(count(walk) for walk in walks(size))) for size in SIZES]
    line = interpolate(values[:2], n)
    assert all(line.subs(n, size) == value for size, value in values), f"{values} is not linear in n"
    return expand(line)


def links_walked(walk: Walk) -> int:
    return sum(walk.traversals.values())


def returns(walk: Walk) -> int:
    return len(walk.returns)


def visits(walk: Walk) -> int:
    return len(walk.stops)


@pytest.mark.parametrize(("size", "trees"), list(zip(SIZES, [1, 2, 5, 14, 42, 132], strict=True)))
def test_all_ordered_trees_are_walked(size: int, trees: int) -> None:
    assert len({walk.parents for walk in walks(size)}) == trees, "a Catalan number"


def test_lemma_1_no_link_is_walked_more_than_twice() -> None:
    assert max(max(walk.traversals.values()) for size in SIZES for walk in walks(size)) == 2


def test_lemma_2_the_most_visits_returns_and_links() -> None:
    assert most(visits) == 2 * n - 2
    assert most(returns) == n - 2
    assert most(links_walked) == 2 * n - 3, "one less than in (1): the last link is not walked back"


def test_stars_reach_lemma_2() -> None:
    for size in SIZES:
        best = [walk for walk in walks(size) if visits(walk) == 2 * size - 2]
        assert any(set(walk.parents) == {0} for walk in best)


def boundary_walks(walk: Walk) -> Expr:
    """Every loop once, and half a perimeter after every arrival but the last, if the robot turns at all."""
    q = IndexedBase("p")
    turned = zip(walk.stops, walk.turns, strict=False)
    return sum(q[k] for k in range(walk.count)) + sum(q[k] / 2 for k, turns in turned if turns)


@pytest.mark.parametrize("size", SIZES)
def test_boundaries_cost_no_more_than_loops_departures_and_returns(size: int) -> None:
    """Term by term: 3/2 of each perimeter, half of it less for the last, and half of one for each return."""
    q = IndexedBase("p")
    for walk in walks(size):
        charged = Rational(3, 2) * sum(q[k] for k in range(size)) - q[size - 1] / 2
        charged += sum(q[k] / 2 for k in walk.returns)
        spared = expand(charged - boundary_walks(walk))
        assert all(spared.coeff(q[k]) >= 0 for k in range(size))


def ledger(links: Expr, step: Expr) -> Expr:
    """What a tour costs at most: links, loops, one departure for each first visit, one for each return."""
    return links * step + perimeters + perimeters / 2 + most(returns) * p_max / 2


def test_bound_1() -> None:
    assert_derives(ledger(2 * (n - 1), Min(radius, d_max)), "(1)")


def test_bound_2_is_bound_1_where_the_radius_is_the_smaller() -> None:
    beyond = Symbol("beyond", nonnegative=True)
    assert_derives(PRINTED["(1)"].subs(d_max, radius + beyond), "(2)")


def test_corrected_theorem_1() -> None:
    derived = approach + ledger(most(links_walked), Min(radius, v_max)) - p_last / 2
    corrected = (
        approach
        + (2 * n - 3) * Min(radius, v_max)
        + 3 * HALF * perimeters
        - HALF * p_last
        + (n - 2) * p_max * HALF
    )
    assert is_same(derived, corrected)
    assert not any(is_same(derived, other) for other in with_one_coefficient_changed(corrected))


def test_2_with_the_approach_follows_from_the_corrected_theorem() -> None:
    saved, links = symbols("saved links", nonnegative=True)
    corrected = approach + links * (radius - saved) + 3 * HALF * perimeters - p_last / 2 + (n - 2) * p_max / 2
    spared = expand((PRINTED["(2)"] + approach - corrected).subs(links, 2 * n - 3))
    assert is_same(spared, radius + p_last / 2 + (2 * n - 3) * saved), "each term is at least 0 for n >= 2"


def test_one_obstacle_costs_its_approach_and_its_loop() -> None:
    """For n = 1 bound (2) with the approach is exact."""
    p_1 = Symbol("p_1", positive=True)
    one = {n: 1, p_max: p_1}
    value = (PRINTED["(2)"] + approach).subs(one).doit().subs(IndexedBase("p", real=True)[1], p_1)
    assert expand(value - approach - p_1) == 0


def test_combs_of_crumbs_come_as_near_to_2_as_one_likes() -> None:
    """Crumbs at distance R, without perimeters: the walks over links are all but those to the last crumb."""
    size = Symbol("m", integer=True, positive=True)
    fewest = size**2 / 2
    ratio = (2 * (n - 1) - 2 * size) / (2 * (n - 1))
    assert limit(ratio.subs(n, fewest), size, oo) == 1
    m = 4
    assert len(comb(m).obstacles) >= fewest.subs(size, m)


@pytest.mark.parametrize("nearest", [True, False])
def test_a_comb_by_two_rules(nearest: bool) -> None:
    """No rule spares more walks than those between the first crumb and the last one."""
    case = Case(comb(4))
    run = case.sightseer if nearest else case.farthest
    count = len(run.obstacles)
    assert case.is_mutually_visible
    assert len([link for link in run.links if link.source != START]) == count - 1
    walks = [link.traversals for link in run.links if link.source != START]
    assert sum(walks) >= 2 * (count - 1) - 2 * 4
    assert run.length > Length(9 * sum(walks))
