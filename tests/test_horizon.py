"""How far along a line something is in reach: the floats against the exact ordinates, and against samples."""

from __future__ import annotations

from math import inf
from random import Random

import pytest

from exactacq import kernel
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real, fmpq, rational
from exactacq.strategies.seed_spreader.horizon import Horizon, reach_begins
from exactacq.strategies.seed_spreader.range_thresholds import last_in_reach, thresholds

TINY = fmpq(1, 10**60)


def curves_of(rng: Random, far: int) -> list[Curve]:
    """A few segments, points and arcs about a place, some with irrational ends."""

    def number() -> Real:
        whole = Real(fmpq(rng.randint(-40, 40), 4) + far)
        return whole + Real(rng.choice((2, 3, 5))).sqrt() if rng.random() < 0.3 else whole

    def one() -> Curve:
        a = Point(number(), number())
        kind = rng.random()
        if kind < 0.2:
            return Segment(a, a)
        if kind < 0.6:
            return Segment(a, Point(number(), number()))
        square = fmpq(rng.randint(1, 60), rng.choice((1, 4)))
        center = Point(fmpq(rng.randint(-40, 40), 4) + far, fmpq(rng.randint(-40, 40), 4) + far)
        root = Real(square).sqrt()
        east, west = center + Point(root, 0), center - Point(root, 0)
        ends = (east, west) if rng.random() < 0.5 else (west, east)
        return Arc(*ends, center, square, rng.random() < 0.5)

    return [one() for _ in range(rng.randint(0, 4))]


@pytest.mark.parametrize("far", [0, 10**9, -(10**30)])
@pytest.mark.parametrize("upward", [True, False])
def test_the_bounds_hold_the_exact_ordinate(upward: bool, far: int) -> None:
    rng, sense, told = Random(3), 1 if upward else -1, 0
    for _ in range(150):
        curves, x = curves_of(rng, far), fmpq(rng.randint(-40, 40), 4) + far
        radius = fmpq(rng.randint(1, 40), 4)
        exact = last_in_reach(x, upward, curves, radius)
        horizon = Horizon(x, upward, curves, radius)
        low, high = horizon.bounds
        if exact is None:
            assert low == -inf
        else:
            assert low == -inf or (exact * sense).compare(rational(low)) >= 0
            assert high == inf or (exact * sense).compare(rational(high)) <= 0
        for y in [Real(fmpq(rng.randint(-90, 90), 8) + far), *([] if exact is None else [exact])]:
            assert horizon.order(y) == (-1 if exact is None else exact.compare(y) * sense)
        told += high - low < 1
    assert told > 10 or abs(far) > 10**20


@pytest.mark.parametrize("far", [0, 10**9])
def test_nothing_is_in_reach_before_reach_begins(far: int) -> None:
    rng = Random(5)
    for _ in range(100):
        curves, x = curves_of(rng, far), fmpq(rng.randint(-40, 40), 4) + far
        radius = fmpq(rng.randint(1, 40), 4)
        for sense in (1, -1):
            begin = reach_begins(sense, curves, radius)
            for curve in curves:
                for y in thresholds(x, curve, radius):
                    assert begin == -inf or (y * sense).compare(rational(begin)) >= 0


def test_what_is_exactly_a_radius_aside_is_in_reach_from_one_place() -> None:
    wall = Segment(Point(3, 0), Point(3, 8))
    for x, there in ((fmpq(0), True), (-TINY, False), (TINY, True)):
        horizon = Horizon(x, True, [wall], fmpq(3))
        assert (horizon.exact is not None) is there
        assert horizon.order(Real(8)) == (-1 if not there else 0 if x == 0 else 1)
    corner = Segment(Point(3, 4), Point(3, 4))
    assert Horizon(fmpq(0), True, [corner], fmpq(5)).order(Real(8)) == 0
    assert Horizon(fmpq(0), True, [corner], fmpq(5)).order(Real(8) + TINY) == -1
    assert Horizon(fmpq(0), False, [corner], fmpq(5)).order(Real(0)) == 0


def test_the_clear_cases_make_nothing_exact() -> None:
    bar = Segment(Point(2, 0), Point(4, 1))
    horizon = Horizon(fmpq(0), True, [bar], fmpq(10))
    assert (horizon.order(Real(5)), horizon.order(Real(12))) == (1, -1)
    assert "exact" not in vars(horizon)
    assert Horizon(fmpq(0), True, [], fmpq(10)).order(Real(-100)) == -1


def test_without_floats_all_is_decided_exactly(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    bar = Segment(Point(2, 0), Point(4, 1))
    horizon = Horizon(fmpq(0), True, [bar], fmpq(10))
    assert horizon.bounds == (-inf, inf)
    assert (horizon.order(Real(5)), horizon.order(Real(12))) == (1, -1)
    assert reach_begins(1, [bar], fmpq(10)) == -inf
