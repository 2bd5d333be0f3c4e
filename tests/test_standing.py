"""How runs stand beside lower bounds, and what they missed: closed forms, and laws on the gallery."""

from __future__ import annotations

from math import isnan

import pytest
from gallery_runs import gallery_run

import exactacq as xa
from exactacq.files import gallery
from exactacq.numbers.real import Real
from exactacq.strategies.offline import offline_bounds
from exactacq.strategies.standing import standing


@pytest.mark.parametrize("name", gallery.names())
def test_no_run_that_does_the_task_is_below_the_bound(name: str) -> None:
    run = gallery_run(name)
    found = standing(run)
    for bound in (found.seeing, found.circling):
        assert not bound.applies or bound.value <= run.length
        if bound.value.sign():
            assert bound.ratio == pytest.approx(float(run.length) / float(bound.value))
        else:
            assert isnan(bound.ratio)
    assert found.seeing.value <= found.circling.value
    assert found.unknown + run.map.known_length() == found.boundary
    is_all_known = len(run.map.acquired) == len(run.obstacles)
    assert (found.unknown.sign() == 0) == is_all_known
    if run.ground is None:
        bounds = offline_bounds(run.scene, run.radius, start=run.start)
        assert (found.seeing.value, found.circling.value) == (bounds.seeing, bounds.circling)
        assert found.circling.applies == (not run.unvisited and not run.unseen)


def test_a_terrain_counts_what_is_left_within_it() -> None:
    """Of a square on the border a rectangle is left, of which three sides can be walked."""
    square = xa.Polygon([(8, 4), (12, 4), (12, 6), (8, 6)])
    scene = xa.Scene([square], terrain=xa.Terrain(10, 10), radius=3)
    found = standing(xa.seed_spreader(scene))
    assert found.boundary == 2 + 2 + 2
    gap = xa.Length(Real(80).sqrt())
    assert (found.circling.value, found.seeing.value) == (gap + 6, gap - 3)


def test_what_is_missed_is_the_rest() -> None:
    def stay(robot: xa.Robot) -> None:
        robot.look()

    run = xa.explore(xa.load("squares"), stay)
    found = standing(run)
    assert (found.unknown, found.boundary) == (14, 16)
    assert not found.circling.applies and not found.seeing.applies
    assert found.circling.ratio == 0


def test_without_obstacles_there_is_nothing_to_do() -> None:
    found = standing(xa.sightseer(xa.Scene([], start=(0, 0), radius=1)))
    assert found.boundary == found.unknown == found.circling.value == 0
    assert found.circling.applies and isnan(found.circling.ratio)
