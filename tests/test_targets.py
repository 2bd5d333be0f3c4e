"""What counts for which obstacle: whole boundaries, and what a border leaves of them."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest

import exactacq as xa
from exactacq import Polygon, Real, Scene, Terrain
from exactacq.files.octagons import random_octagons
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.interval_union import Cover, Interval
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.terrain_components import Ground
from exactacq.sensing.sensor import Sensor
from exactacq.sensing.targets import Targets
from exactacq.visibility.sensor_range import Range

# A bar across a narrow terrain, and one that its border cuts at both of its long edges.
CUT = Scene(
    [
        Polygon([(-1, 4), (11, 4), (11, 5), (-1, 5)]),
        Polygon([(2, 8), (3, 8), (3, 12), (2, 12)]),
        Polygon([(5, 1), (7, 1), (7, 2), (5, 2)]),
    ],
    terrain=Terrain(10, 10),
    radius=3,
)


def targets(name: str) -> tuple[EdgeTable, Targets]:
    scene = CUT if name == "cut" else random_octagons(5, seed=2)
    table = EdgeTable(scene.obstacles)
    rails = [Rail(curve) for curve in table.curves]
    if name == "whole":
        return table, Targets.whole(table, rails)
    ground = xa.seed_spreader(scene).ground
    assert isinstance(ground, Ground)
    return table, Targets.of_components(ground.components, table, Range(xa.Scene([], radius=3).radius))


def some_spans(table: EdgeTable, rng: Random) -> dict[int, list[Interval]]:
    """Random intervals of some edges."""
    found: dict[int, list[Interval]] = {}
    for e, curve in enumerate(table.curves):
        rail = Rail(curve)
        for _ in range(rng.randrange(3)):
            low, high = sorted(Fraction(rng.randrange(13), 12) for _ in range(2))
            ends = [(Real(u), curve.point(u)) for u in (low, high)]
            assert all(rail.parameter(point) == u for u, point in ends)
            found.setdefault(e, []).append(Interval(*ends[0], *ends[1]))
    return found


@pytest.mark.parametrize("name", ["whole", "cut"])
def test_intervals_of_an_obstacle(name: str) -> None:
    """Those of every obstacle are what its own targets leave of the intervals, one target at a time."""
    table, some = targets(name)
    for seed in range(10):
        spans = some_spans(table, Random(seed))
        for k, own in enumerate(some.of):
            expected = [
                (t.edge, part.low, part.high)
                for t in own
                for interval in spans.get(t.edge, ())
                for part in [interval.within(t.span)]
                if part is not None
            ]
            got = [(e, part.low, part.high) for _, (e, part) in some.within({k}, spans)]
            assert sorted(got) == sorted(expected)
            assert (k in some.of_edges(spans)) >= bool(expected)


@pytest.mark.parametrize("name", ["whole", "cut"])
def test_obstacles_of_edges(name: str) -> None:
    _, some = targets(name)
    for e in range(40):
        assert some.of_edges([e, 99]) == {k for k, own in enumerate(some.of) if any(t.edge == e for t in own)}
    assert some.of_edges([]) == set()


def test_only_an_obstacle_of_which_more_is_known_is_asked_whether_it_is_whole(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Among 30 octagons a dozen obstacles are within reach of every leg; few of them are asked about."""
    asked: list[int] = []
    plain = Targets.is_whole

    def counted(self: Targets, k: int, covers: dict[int, Cover]) -> bool:
        asked.append(k)
        return plain(self, k, covers)

    near: list[int] = []
    ahead = Sensor.ahead

    def looked(self: Sensor, leg: object, *told: object) -> object:
        found = ahead(self, leg, *told)  # type: ignore[arg-type]
        near.append(0 if found.shares is None else len(found.shares.obstacles))
        return found

    monkeypatch.setattr(Targets, "is_whole", counted)
    monkeypatch.setattr(Sensor, "ahead", looked)
    run = xa.sightseer(random_octagons(30, seed=1), 10)
    assert len(run.memory.acquired) == 30
    assert len(asked) < sum(near) / 2


def test_what_is_missing_is_found_before_and_after_what_was_missing_last() -> None:
    scene = xa.Scene([xa.Polygon([(0, 0), (1, 0), (1, 1), (0, 1)])], start=(-1, -1), radius=5)
    table = EdgeTable(scene.obstacles)
    targets = Targets.whole(table, [Rail(curve) for curve in table.curves])
    everything = dict(targets.whole_covers(0))
    for missing in (3, 0, 2, 1, 3):
        assert not targets.is_whole(0, {e: cover for e, cover in everything.items() if e != missing})
    assert targets.is_whole(0, everything)
