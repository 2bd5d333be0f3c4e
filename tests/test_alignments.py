"""Rays that are known to touch something because the place lies on a line that does."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest
from flint import fmpq
from nightly import NIGHTLY
from strategies import arc_terrain, degenerate_terrain, random_terrain

import exactacq as xa
from exactacq import Point, Scene
from exactacq.geometry.curves import Arc
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.underway import LegNews
from exactacq.strategies.run import Run
from exactacq.visibility.alignments import Alignment
from exactacq.visibility.sensor_range import Range
from exactacq.visibility.visible_boundary import BoundaryView

DATA = Path(__file__).parent / "data"


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[tuple[Point, list[Alignment]]]]:
    """The rays that are told to views, with their places."""
    found: list[tuple[Point, list[Alignment]]] = []
    plain = LegNews.aligned

    def aligned(self: LegNews, u: Real, place: Point) -> list[Alignment]:
        rays = plain(self, u, place)
        found.append((place, rays))
        return rays

    monkeypatch.setattr(LegNews, "aligned", aligned)
    yield found


def read_maps(run: Run) -> None:
    """Read what is known of all obstacles at all events."""
    for chart in map(run.map_at, run.events):
        for i in range(len(run.scene.obstacles)):
            chart.known(i)


def seen(
    table: EdgeTable, place: Point, radius: fmpq, rays: list[Alignment]
) -> dict[int, list[tuple[Point, Point]]]:
    return BoundaryView(table, place, Range(radius), None, rays).seen()


@pytest.mark.parametrize("terrain", [random_terrain, degenerate_terrain, arc_terrain])
def test_rays_touch_what_they_are_said_to(terrain: object, told: list[tuple[Point, list[Alignment]]]) -> None:
    """Exactly, one by one; and a view that is told of them sees the same as one that is not."""
    corners = circles = several = 0
    for seed in range(12 if NIGHTLY else 4):
        some = terrain(Random(seed))  # type: ignore[operator]
        scene = some.scene()
        run = xa.sightseer(Scene(scene.shapes, some.start, enclosure=scene.enclosure, radius=some.radius))
        read_maps(run)
        table, radius = EdgeTable(run.scene.obstacles), run.radius
        numbers = table.line_numbers
        for place, rays in told:
            for ray in rays:
                direction = Point(*ray.direction)
                assert (place - ray.contact).cross(direction) == 0
                several += len(ray.touched) > 1
                for feature, side in ray.touched:
                    if side == 0:
                        corners += 1
                        way = table.curves[feature].start - place
                        assert way.cross(direction) == 0
                    else:
                        circles += 1
                        arc = table.curves[numbers.first_arc(feature)]
                        assert isinstance(arc, Arc)
                        touch = ray.touch(feature, arc.center)
                        way, spoke = touch - place, arc.center - touch
                        assert way.cross(direction) == 0 and spoke.dot(direction) == 0
                        assert spoke.norm_sq() == arc.radius_sq
                        assert direction.cross(spoke).sign() == side
                    assert way.dot(direction) > 0
            if rays:
                assert seen(table, place, radius, rays) == seen(table, place, radius, [])
        told.clear()
    assert several > 3 and (circles > 3 if terrain is arc_terrain else corners > 9)


def test_a_place_whose_numbers_do_not_tell_that_two_arcs_are_in_line() -> None:
    """Within a straight leg of this drawing an arc comes into sight behind another one.

    The place is a number of degree 640. That both arcs touch one ray from there would take a proof with
    650 billion bits, but the place was found on the line that touches both.
    """
    scene = xa.inspect(DATA / "issue39.dxf").scene
    run = xa.sightseer(scene, "48/5", start=("5825/2", 3184))
    event = run.events[212]
    assert event.kind == "regain" and event.obstacle == 0
    assert run.map_at(event).known(0)
