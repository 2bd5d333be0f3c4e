"""The relay: diversions longer than R, and why no multiple of n R covers them."""

from __future__ import annotations

import pytest
from formulas import PRINTED, height, n, ns, p_max, pairs, perimeters, r, radius, strip, width
from sympy import Expr, Poly, Rational, Symbol, expand, limit, oo, real_roots

from exactacq import Length, Run, seed_spreader
from exactacq.geometry.points import distance
from exactacq.study.claims.tight_families import relay

k = Symbol("k", integer=True, positive=True)
LEAST = 4
"""The least number of screened crumbs that breaks the bounds."""
SCREENS = 2 * (Rational(1, 2) + Rational(43, 5)) / 100, 2 * (Rational(1, 2) + Rational(36, 5)) / 100
POCKET, CRUMB = Rational(17, 100), Rational(4, 1000)


def bound(name: str) -> Expr:
    """A printed bound on the relay with k screened crumbs: n = 3 k + 1, all in the only strip."""
    around = POCKET + k * (sum(SCREENS) + CRUMB)
    formula = PRINTED[name].subs({pairs: n * (n - 1), perimeters: around, ns[0]: 0})
    values = {r: 1, height: 60 + 19 * k, width: 20, strip: 20, radius: 20, p_max: max(*SCREENS, POCKET)}
    return expand(formula.subs(values).subs(n, 3 * k + 1))


def ways() -> Expr:
    """The diversions there and back are longer than their heights: 19 i to the i-th crumb, from the foot."""
    low, high = Symbol("low"), Symbol("high")
    steps = (low + high) * k / 2
    return expand(2 * steps.subs({low: 19, high: 19 * k}))


def test_the_perimeters_are_those_of_the_scene() -> None:
    shapes = [o.perimeter.sympy() for o in seed_spreader(relay(1)).scene.obstacles]
    assert shapes == [POCKET, *SCREENS, CRUMB]


@pytest.mark.parametrize("name", ["(5)", "(6)", "(9)", "(10)", "(11)"])
def test_the_relay_outgrows_every_bound(name: str) -> None:
    """M-line and ways grow with the square of k. A bound's squared term has only p_max = 0.182 in it."""
    m_line = PRINTED["(8)"].subs({r: 1, height: 60 + 19 * k, width: 20})
    excess = Poly(expand(m_line + ways() - bound(name)), k)
    assert excess.degree() == 2
    assert excess.LC() > 17
    assert max(real_roots(excess)) < 7, "with the ways' heights only; the runs below break it sooner"


def test_more_than_any_multiple_of_n_r() -> None:
    """So no constant in place of 2 in 2nR helps."""
    assert limit(ways() / ((3 * k + 1) * 20), k, oo) == oo


def exact(run: Run, name: str) -> Length:
    return next(b.value for b in run.bounds if b.name == name)


@pytest.fixture(scope="module", params=[1, LEAST - 1, LEAST])
def run(request) -> Run:
    return seed_spreader(relay(request.param))


def test_runs_are_m_line_ways_and_loops(run: Run) -> None:
    """Nothing else: no crossing, no passing; every diversion but the first is overdue."""
    diversions = run.diversions
    straight = Length.sum(Length(distance(d.leave, d.hit)) for d in diversions)
    loops = Length.sum(run.obstacles[k].perimeter for k in run.visits)
    assert run.length == exact(run, "(8)") + straight * 2 + loops
    assert [d.reason for d in diversions] == ["out of sight"] + ["overdue"] * (len(run.obstacles) // 3)
    assert run.again == ()
    assert run.complete


@pytest.mark.parametrize("name", ["(5)", "(6)", "(9)", "(10)", "(11)"])
def test_printed_bounds_of_runs(run: Run, name: str) -> None:
    """The engine's values are those derived here, and fail from LEAST on."""
    count = len(run.obstacles) // 3
    assert exact(run, name).sympy() == bound(name).subs(k, count)
    assert (run.length > exact(run, name)) == (count >= LEAST)


def test_with_the_ways_as_they_are_the_bound_holds(run: Run) -> None:
    reach = Length.sum(Length(distance(d.leave, d.hit)) for d in run.diversions)
    most = exact(run, "(10)") - Length(2 * len(run.obstacles) * run.radius) + reach * 2
    assert run.length <= most
