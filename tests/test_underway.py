"""The map inside a piece: edge by edge what the whole leg, cut at the place, shows."""

from __future__ import annotations

import pickle
from random import Random

import pytest
from flint import fmpq
from nightly import NIGHTLY
from strategies import arc_terrain, degenerate_terrain, random_terrain

import exactacq as xa
from exactacq import Point, Polygon, Scene
from exactacq.files.octagons import random_octagons
from exactacq.geometry.curves import Segment
from exactacq.geometry.interval_union import Cover
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.leg_views import Shares
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.strategies.run import Run
from exactacq.study.random_scenes import Subject, random_scene


def ends(cover: Cover | None) -> list[tuple[Real, Real]]:
    return [] if cover is None else [(i.low, i.high) for i in cover.intervals]


def check(run: Run) -> int:
    """Compare all edges, at places inside all pieces, with what the cut leg shows; the number of places."""
    memory, count = run.memory, 0
    for number, legs in enumerate(memory._legs):
        for k, leg in enumerate(legs):
            if number in memory._retraced:
                continue
            before = dict(memory.after(number)._covers)
            for other in legs[:k]:
                before.update(memory._sensor.shares(other).taught(before))
            whole = memory._sensor.shares(leg)
            u = rational_between(leg.span.low, leg.span.high)
            for at in (u, rational_between(leg.span.low, Real(u)), rational_between(Real(u), leg.span.high)):
                place = leg.rail.point(at)
                cut = whole.cut(leg.upto(Real(at), place)).taught(before)
                covers = memory.within(number, place)._covers
                for e in range(len(memory._table.curves)):
                    assert ends(covers.get(e)) == ends(cut.get(e, before.get(e)))
                assert set(covers) == set(before) | set(cut) and len(covers) == len(set(covers))
                count += 1
    return count


@pytest.mark.parametrize("terrain", [random_terrain, degenerate_terrain, arc_terrain])
def test_edges_are_what_the_cut_leg_shows(terrain: object) -> None:
    places = 0
    for seed in range(4 if NIGHTLY else 2):
        some = terrain(Random(seed))  # type: ignore[operator]
        scene = some.scene()
        places += check(
            xa.sightseer(Scene(scene.shapes, some.start, enclosure=scene.enclosure, radius=some.radius))
        )
    assert places > 9


def test_where_a_border_cuts_obstacles() -> None:
    """A comb has two components, and their ends are looked out from."""
    comb = Polygon([(2, -3), (8, -3), (8, 2), (7, 2), (7, -2), (3, -2), (3, 3), (2, 3)])
    scene = Scene([comb, Polygon([(4, 6), (6, 6), (6, 12), (4, 12)])], terrain=xa.Terrain(10, 10), radius=4)
    assert check(xa.seed_spreader(scene)) > 9


def row(n: int) -> Memory:
    """What a straight way between two rows of boxes shows, in one leg."""
    boxes = [
        Polygon([(4 * k, y), (4 * k + 2, y), (4 * k + 2, y + 1), (4 * k, y + 1)])
        for k in range(n)
        for y in (2 + fmpq(k % 3, 4), -3 - fmpq(k % 2, 3))
    ]
    start = Point(-3, 0)
    return Memory.of(Scene(boxes), fmpq(5), start, [Piece("straight", None, Segment(start, Point(4 * n, 0)))])


@pytest.fixture
def cuts(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many shares are cut, time after time."""
    found: list[int] = []
    plain = Shares.cut

    def counted(self: Shares, *args: object) -> Shares:
        found.append(sum(map(len, self.of.values())))
        return plain(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(Shares, "cut", counted)
    return found


def test_one_obstacle_in_every_map_of_a_long_leg_costs_linear_time(cuts: list[int]) -> None:
    """What is cut is what is near, however many obstacles the leg passes."""
    spent = []
    for n in (8, 16, 32):
        memory = row(n)
        places = [report.place for report in memory.reports if report.inside]
        cuts.clear()
        for k, place in enumerate(places):
            assert memory.within(0, place).known(min(2 * k * n // len(places), 2 * n - 1)) is not None
        spent.append(sum(cuts))
    assert 0 < spent[2] < 2.5 * spent[1] < 2.5 * 2.5 * spent[0]


def test_a_map_is_made_of_what_is_read(cuts: list[int]) -> None:
    memory = row(4)
    place = next(report.place for report in memory.reports if report.inside)
    cuts.clear()
    chart = memory.within(0, place)
    assert not cuts
    again = pickle.loads(pickle.dumps(dict(chart._covers)))
    assert cuts and {e: ends(cover) for e, cover in again.items()} == {
        e: ends(cover) for e, cover in chart._covers.items()
    }


def test_a_copied_map_says_the_same() -> None:
    run = xa.sightseer(random_octagons(4, seed=1), 10)
    event = next(event for event in run.events if event.inside)
    chart = run.map_at(event)
    again = pickle.loads(pickle.dumps(chart))
    assert [again.known_length(i) for i in again.seen] == [chart.known_length(i) for i in chart.seen]


@pytest.mark.parametrize("seed", range(4))
def test_views_at_events_know_the_edges_through_their_places(seed: int) -> None:
    """Taken from the way there, and asked exactly, they are the same, in the same order."""
    for kind, explore in ((Subject.SIGHTSEER, xa.sightseer), (Subject.SEED_SPREADER, xa.seed_spreader)):
        run = explore(random_scene(kind, 91000000 + seed))
        table = EdgeTable(run.scene.obstacles)
        for event in run.events:
            assert run.view_at(event)._view.own == table.edges_at(event.point)
