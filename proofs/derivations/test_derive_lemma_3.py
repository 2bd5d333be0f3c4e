"""Bound (4) from its counts, from (5), and what the pairs of obstacles really are."""

from __future__ import annotations

from itertools import combinations, product

import pytest
from formulas import HALF, PRINTED, assert_derives, i, is_same, j, n, n_0, ns, p_max, pairs, r
from sympy import Expr, Sum, Symbol, expand, factor, summation, symbols


def summed(term: Expr, count: Expr, index: Symbol = i) -> Expr:
    """The sum of a term over index = 1..count, in closed form."""
    bound = Symbol("bound", integer=True, nonnegative=True)
    return summation(term, (index, 1, bound)).subs(bound, count)


def test_4_from_its_counts() -> None:
    """Each obstacle is acquired once; on that visit's way, the i-th of a strip meets the i - 1 known ones of
    its strip and all those that cross the M-line."""
    acquisitions = summed(1, n)
    crossing = summed(n_0, n)
    within = HALF * Sum(factor(2 * summed(i - 1, ns[j])), (j, 0, r))
    assert_derives(acquisitions + crossing + within, "(4)")


def test_4_from_5() -> None:
    """(4) is unreadable in the scan. The text after it leaves no choice: all but n visits are passings, which
    cost 2 p_max each, and those are the terms of (5) with p_max."""
    passings = expand(PRINTED["(5)"]).coeff(p_max) / (2 * 1)
    assert_derives(n + passings, "(4)")


def test_pairs_that_can_meet_within_strips() -> None:
    """A passing takes one known and one aimed obstacle, and each pair meets on one diversion at most.

    Two that lie in different strips never meet. So (4) counts n_0^2 too many.
    """
    inside = symbols("inside", cls=Symbol)
    both_cross = n_0 * (n_0 - 1) / 2
    one_crosses = n_0 * (n - n_0)
    spared = expand(PRINTED["(4)"] - n - both_cross - one_crosses - inside)
    assert is_same(spared.subs(inside, HALF * pairs - both_cross), n_0**2)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_pairs_that_can_meet_counted_one_by_one(count: int) -> None:
    """Over all ways to put obstacles on the M-line (0) or into the strips 1..3."""
    for places in product(range(4), repeat=count):
        sizes = [places.count(strip) for strip in range(4)]
        meeting = sum(a == b or 0 in (a, b) for a, b in combinations(places, 2))
        printed = count * sizes[0] + sum(m * (m - 1) for m in sizes) // 2
        assert meeting == printed - sizes[0] ** 2
        assert meeting <= count * (count - 1) // 2


def test_pairs_of_any_strips() -> None:
    """If diversions leave their strips all pairs can meet: n (n - 1) / 2 of them, more than (4) has."""
    everything = summed(i - 1, n)
    assert is_same(everything, n * (n - 1) / 2)
    alone = {ns[0]: 0, ns[1]: 1, ns[2]: 1, n: 2, r: 2}
    printed = PRINTED["(4)"].subs({n: 2, r: 2}).doit().subs(alone)
    assert printed == 2, "one obstacle in each of two strips: no passing is allowed for"
    assert everything.subs(n, 2) == 1
