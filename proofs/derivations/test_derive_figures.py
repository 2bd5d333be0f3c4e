"""The numbers of Figures 2 and 3: tours and a sweep of the column, in closed form and as walked."""

from __future__ import annotations

import pytest
from formulas import HALF
from sympy import Expr, Rational, expand, pi

from exactacq import Length
from exactacq.study.claims.figure_scenes import column
from exactacq.study.claims.model import Case
from exactacq.study.claims.tallies import bounds_of

AROUND = [10, 15, 3 * pi, 24, 10, 15, 24, 3 * pi, 10, 24, 5]
"""The perimeters of the column's shapes."""


def exact(length: Length) -> Expr:
    return length.sympy()


def test_the_perimeters_of_the_column() -> None:
    assert [exact(o.perimeter) for o in Case(column()).scene.obstacles] == AROUND


@pytest.mark.parametrize("count", [2, 3, 6, 11])
def test_a_tour_of_the_column(count: int) -> None:
    """P = nR + 1.5 sum p - p_last / 2."""
    run = Case(column(count)).sightseer
    form = 10 * count + 3 * HALF * sum(AROUND[:count]) - HALF * AROUND[count - 1]
    assert expand(exact(run.length) - form) == 0
    assert {str(link.length) for link in run.links} == {"10"}


def test_the_numbers_of_figure_2() -> None:
    run = Case(column()).sightseer
    assert exact(run.length) == 313 + 9 * pi
    assert exact(bounds_of(run)["(2)"]) == Rational(1027, 2) + 9 * pi
    assert run.length * 3 < bounds_of(run)["(2)"] * 2


def test_a_sweep_of_the_column() -> None:
    """Three are circled: from 4/5 west of their easternmost points, 6/5 of the line blocked, 2 around."""
    run = Case(column()).spreader
    top = 8 + (3 * 4 + 2 * 6 + 2 * 3 + 3 * Rational(36, 5) + 2) + 11 * 10
    chord = 2 * Rational(18, 5) * Rational(4, 5) / Rational(24, 5)
    around = 2 * Rational(6) * Rational(4, 5) / Rational(24, 5)
    assert exact(run.length) == 3 * top + 20 + 3 * (24 + around - chord) == Rational(3046, 5)
    assert (sorted(run.visits), run.diversions, run.complete) == ([3, 6, 9], (), True)
