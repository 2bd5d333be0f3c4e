"""When an obstacle becomes whole: not before the place that is told, and no later."""

from __future__ import annotations

from collections import ChainMap
from fractions import Fraction
from random import Random

import pytest
from flint import arb, fmpq
from nightly import some
from strategies import arc_terrain, degenerate_terrain, random_terrain

import exactacq as xa
from exactacq import Point, Real
from exactacq.files.octagons import random_octagons
from exactacq.geometry.box_index import box
from exactacq.geometry.curves import Arc
from exactacq.geometry.interval_union import Cover
from exactacq.geometry.late import late_point
from exactacq.numbers.rationals import ends
from exactacq.sensing.acquisition import Acquisition, between, clusters, distance_bounds
from exactacq.sensing.leg_views import Shares
from exactacq.sensing.legs import Leg, Place

NEAR = fmpq(1, 2**40)
"""So much before and after the place the obstacle is asked about."""


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> list[tuple[bool | None, bool | None]]:
    """For every acquisition inside a leg whether the obstacle is whole just before and just after it."""
    found: list[tuple[bool | None, bool | None]] = []
    begun, plain = Acquisition.__init__, Acquisition.place
    # The acquisition itself looks only at what may be the last.
    everything: list[Shares] = []

    def begin(self: Acquisition, shares: Shares, k: int, before: ChainMap[int, Cover]) -> None:
        everything[:] = [shares]
        begun(self, shares, k, before)

    def checked(self: Acquisition) -> Place:
        u, place = plain(self)
        (shares,) = everything
        leg, (low, high) = self.shares.leg, u.enclosure(80)
        step = NEAR if leg.ahead else -NEAR
        before, after = (low - step, high + step) if leg.ahead else (high - step, low + step)
        whole: list[bool | None] = [None, None]
        for k, (v, bound, side) in enumerate(((before, leg.first, 1), (after, leg.last, -1))):
            if leg.order(Real(v), bound) == side:
                known = shares.cut(leg.upto(Real(v), leg.rail.point(v)), {self.k}).taught(self.before)
                whole[k] = shares.targets.is_whole(self.k, {**self.before, **known})
        found.append((whole[0], whole[1]))
        return u, place

    monkeypatch.setattr(Acquisition, "__init__", begin)
    monkeypatch.setattr(Acquisition, "place", checked)
    return found


@pytest.mark.parametrize("terrain", [random_terrain, degenerate_terrain, arc_terrain])
def test_an_obstacle_is_whole_from_the_place_on(terrain: object, told: list[tuple[bool, bool]]) -> None:
    for seed in some(range(6), 3):
        drawn = terrain(Random(seed))  # type: ignore[operator]
        scene = drawn.scene()
        xa.sightseer(
            xa.Scene(scene.shapes, drawn.start, enclosure=scene.enclosure, radius=drawn.radius)
        ).sense()
    assert any(before is not None for before, _ in told) and any(after is not None for _, after in told)
    assert not any(before for before, _ in told)
    assert all(after in (True, None) for _, after in told)


def test_among_octagons(told: list[tuple[bool, bool]]) -> None:
    """Most are whole at the end of a leg; no view is taken between its ends then."""
    xa.sightseer(random_octagons(20, seed=3), 10).sense()
    assert len(told) == 20 and not any(before for before, _ in told)


def test_on_long_ways(told: list[tuple[bool, bool]], monkeypatch: pytest.MonkeyPatch) -> None:
    """Some are whole where an edge comes to the front, seen along its own line; others only later."""
    # Whether the obstacle is whole at the front of an edge; None if nobody had to ask.
    fronts: list[bool | None] = []
    place_of, partly = Shares.place_of, Acquisition._partly_known
    monkeypatch.setattr(Shares, "place_of", lambda self, one: fronts.append(None) or place_of(self, one))

    def known(self: Acquisition, part: Leg) -> ChainMap[int, Cover] | None:
        found = partly(self, part)
        if self._last.along is not None and len(self._last.edges) > 1 and fronts[-1] is None:
            fronts[-1] = found is None
        return found

    monkeypatch.setattr(Acquisition, "_partly_known", known)
    octagons = random_octagons(50, seed=3)
    xa.seed_spreader(xa.Scene(octagons.shapes, terrain=xa.Terrain(60, 60), radius=10))
    assert {True, False, None} <= set(fronts)
    assert not any(before for before, _ in told)
    assert all(after in (True, None) for _, after in told)


# -- candidates -----------------------------------------------------------------------------------------


def places(*values: object) -> list[Place]:
    return [(Real(value), Point(value, 0)) for value in values]


def test_places_that_balls_do_not_part_are_together() -> None:
    root, again = Real(2).sqrt(), (3 + 2 * Real(2).sqrt()).sqrt() - 1
    late = Real.late(arb(1.5, 1e-12), lambda: Real("3/2"))
    found = clusters([*places(1, root, "3/2", again), (late, Point(0, 0)), *places(2)])
    assert [[float(u) for u, _ in cluster] for cluster in found[:2]] == [[1.0], [2.0**0.5, 2.0**0.5]]
    assert sorted(u is late for u, _ in found[2]) == [False, True] and len(found) == 4
    (one,) = clusters([(root, Point(0, 0)), (root, Point(1, 0))])
    assert one == [(root, Point(0, 0))]


def test_a_rational_between_clusters() -> None:
    root = Real(2).sqrt()
    close = Real(sum(ends(root.ball(200))) / 2)
    for one, other in (([root], [close]), ([root, Real(1)], [Real(2)]), ([Real(3)], [root, Real(1)])):
        low, high = sorted((max(one), min(other))) if one[0] < other[0] else (max(other), min(one))
        for a, b in ((one, other), (other, one)):
            u = between([(v, Point(0, 0)) for v in a], [(v, Point(0, 0)) for v in b])
            assert low < u < high


@pytest.mark.parametrize("size", [1, 10**9])
def test_bounds_of_distances_from_a_box(size: int) -> None:
    """They hold every distance from the point to the curve; a late point is not made."""
    rng = Random(size)

    def number() -> Fraction:
        return Fraction(rng.randint(-(10**6), 10**6), 997) * size

    for _ in range(50):
        curve = Arc.from_bulge(
            Point(number(), number()), Point(number(), number()), fmpq(1, rng.randint(1, 9))
        )
        x, y = number(), number()
        around = arb(fmpq(x.numerator, x.denominator)), arb(fmpq(y.numerator, y.denominator))
        point = late_point(around, lambda x=x, y=y: Point(x, y))  # type: ignore[misc]
        least, most = distance_bounds(box(curve), point)
        assert point.is_late
        for u in (0, Fraction(1, 3), Fraction(1, 2), 1):
            away = float((curve.point(u) - point).norm_sq().sqrt())
            assert least <= away <= most


def test_the_place_of_a_line_has_one_parameter() -> None:
    """A point that begins and ends what is seen has the same number twice: no proof that it is equal."""
    rail = xa.sightseer(xa.load("circles")).memory._sensor.rails[0]
    assert isinstance(rail.curve, Arc)
    place = rail.curve.center + Point(1, Real(3).sqrt()) * (rail.curve.radius / 2)
    u = rail.parameter(place)
    assert u.is_late and rail.parameter(place) is u and rail.parameter(Point(*place)) is not u
