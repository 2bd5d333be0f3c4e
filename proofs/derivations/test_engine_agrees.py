"""The bounds that the library evaluates are the transcribed ones, on scenes of the gallery, exactly."""

from __future__ import annotations

import pytest
from formulas import PRINTED, d_max, height, n, ns, p_max, pairs, perimeters, r, radius, strip, width
from sympy import Expr, Integer, Rational, Symbol, expand

from exactacq import Length, Run, seed_spreader, sightseer
from exactacq.files import gallery
from exactacq.strategies.bounds import census

SWEPT = ["case2", "case3", "figure4", "m14", "m18", "m20-3"]


def number(value: object) -> Rational:
    return Rational(str(value))


def evaluate(formula: Expr, around: Expr, ordered: int, values: dict[Symbol, Expr]) -> Expr:
    """A formula with its two sums and all its symbols replaced."""
    return formula.subs({perimeters: around, pairs: Integer(ordered)}).subs(values)


def perimeters_of(run: Run) -> tuple[Expr, Expr]:
    """The sum of the perimeters, and the largest."""
    lengths = [body.perimeter for body in run.obstacles]
    return Length.sum(lengths).sympy(), max(lengths).sympy()


@pytest.mark.parametrize("name", SWEPT)
def test_bounds_of_sweeps(name: str) -> None:
    run = seed_spreader(gallery.scene(name))
    terrain = run.scene.terrain
    assert terrain is not None
    around, largest = perimeters_of(run)
    counts = census(run.ground, run.radius)
    wide, reach = number(terrain.width), number(run.radius)
    values = {
        n: len(run.obstacles),
        ns[0]: sum(counts.crossing),
        r: -(-wide // reach),
        height: number(terrain.height),
        width: wide,
        radius: reach,
        strip: min(wide, reach),
        p_max: largest,
    }
    told = {bound.name: bound.value.sympy() for bound in run.bounds}
    for label in ("(4)", "(5)", "(6)", "(8)", "(9)", "(10)", "(11)"):
        assert expand(evaluate(PRINTED[label], around, counts.pairs, values) - told[label]) == 0


@pytest.mark.parametrize(("name", "farthest"), [("m8", Rational(7, 2)), ("squares", Rational(3))])
def test_bounds_of_tours(name: str, farthest: Expr) -> None:
    """``farthest`` is d_max, measured by hand."""
    run = sightseer(gallery.scene(name))
    around, largest = perimeters_of(run)
    values = {n: len(run.obstacles), radius: number(run.radius), d_max: farthest, p_max: largest}
    told = {bound.name: bound.value.sympy() for bound in run.bounds}
    for label in ("(1)", "(2)"):
        assert expand(evaluate(PRINTED[label], around, 0, values) - told[label]) == 0
