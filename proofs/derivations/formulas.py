"""The paper's printed bounds as sympy expressions, transcribed once, and what derivations share.

Sums over obstacles and strips stay symbolic: p[i] for i = 1..n, and ns[j] for j = 0..r, where ns[0] is n_0.
"""

from __future__ import annotations

from collections.abc import Iterator

from sympy import Eq, Expr, IndexedBase, Min, Rational, Sum, Symbol, expand, symbols

n = Symbol("n", integer=True, positive=True)
r = Symbol("r", integer=True, positive=True)
i, j = symbols("i j", integer=True, nonnegative=True)
radius, d_max, width, height, strip = symbols("R d_max B A w", positive=True)
p_max, p_last, approach, v_max = symbols("p_max p_last SS_1 v_max", nonnegative=True)
p, ns = IndexedBase("p", real=True), IndexedBase("n", real=True)
n_0 = ns[0]

perimeters = Sum(p[i], (i, 1, n))
pairs = Sum(ns[j] * (ns[j] - 1), (j, 0, r))
"""The paper's sum of n_j (n_j - 1), which counts every pair twice."""

HALF = Rational(1, 2)

PRINTED: dict[str, Expr] = {
    "(1)": 2 * (n - 1) * Min(radius, d_max) + 3 * HALF * perimeters + p_max * (n - 2) / 2,
    "(2)": 2 * radius * (n - 1) + 3 * HALF * perimeters + p_max * (n - 2) / 2,
    "(4)": n + n * n_0 + HALF * pairs,
    "(5)": height
    + r * (strip + height)
    + 2 * n * strip
    + 3 * perimeters
    + 2 * n * n_0 * p_max
    + p_max * pairs,
    "(6)": height
    + width
    + r * height
    + 2 * n * radius
    + 3 * perimeters
    + 2 * n * n_0 * p_max
    + p_max * pairs,
    "(8)": height + width + r * height,
    "(9)": height + width + r * height + 2 * n * radius + 3 * perimeters,
    "(10)": height
    + width
    + r * height
    + 2 * n * radius
    + 3 * HALF * perimeters
    + n * n_0 * p_max
    + HALF * p_max * pairs,
    "(11)": height + width + r * height + 2 * n * radius + 3 * HALF * perimeters,
}


def is_same(one: Expr, other: Expr) -> bool:
    """Whether two expressions are equal term by term, sums taken as they are."""
    return expand(one - other) == 0


def with_one_coefficient_changed(formula: Expr) -> Iterator[Expr]:
    """The formula with one term after the other counted once more: no derivation may end in any of them."""
    for term in expand(formula).as_ordered_terms():
        yield formula + term


def assert_derives(derived: Expr, name: str) -> None:
    """Fail unless *derived* is the printed bound of that name, and no neighbour of it."""
    assert is_same(derived, PRINTED[name]), Eq(derived, PRINTED[name])
    assert not any(is_same(derived, other) for other in with_one_coefficient_changed(PRINTED[name]))
