"""How far long work is: counts that grow, by one step at a time, to the total that was told first."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from terminals import on_a_terminal

import exactacq as xa
from exactacq.progress import Meter

Told = list[tuple[int, int]]


def told_by(work: Callable[[Callable[[int, int], None]], object]) -> Told:
    told: Told = []
    work(lambda done, total: told.append((done, total)))
    assert told, "nothing was told"
    totals = {total for _, total in told}
    assert len(totals) == 1
    assert all(a < b for (a, _), (b, _) in pairwise(told))
    return told


def test_a_long_visit_is_told_edge_by_edge() -> None:
    """The robot circles a polygon of 40 edges, and then a triangle."""
    ring = [
        (20 + x, y)
        for x, y in [*((k, k * k) for k in range(-10, 11)), *((k, 250 - k * k) for k in range(10, -10, -1))]
    ]
    scene = xa.Scene([xa.Polygon(ring), xa.Polygon([(40, 0), (44, 0), (42, 3)])], (0, 0), radius=500)
    told = told_by(lambda progress: xa.sightseer(scene, progress=progress))
    edges = sum(len(obstacle.edges) for obstacle in scene.obstacles)
    assert told == [(k, edges) for k in range(1, edges + 1)]


def test_a_sweep_tells_pieces_of_the_m_line_and_edges_around_obstacles() -> None:
    """The border takes an edge from the wall: there are three to walk."""
    walls = [xa.Polygon([(3, -1), (5, -1), (5, 7), (3, 7)]), xa.Circle((8, 4), 1)]
    run = None

    def sweep(progress: Callable[[int, int], None]) -> None:
        nonlocal run
        run = xa.seed_spreader(xa.Scene(walls, terrain=xa.Terrain(12, 10)), radius=4, progress=progress)

    told = told_by(sweep)
    assert run is not None and len(run.visits) == 2
    edges = 3 + len(run.scene.obstacles[1].edges)  # of the wall and of the disc
    every = 7 + edges  # four lines and three joints
    # The wall stands on the end of a line and on the joint after it: these two are behind the robot at once.
    assert [done for done, _ in told] == [1, 2, 3, 4, 5, *range(7, every + 1)]
    assert told[-1] == (every, every)


@pytest.mark.parametrize("name", ["figure2", "case3"])
def test_an_audit_tells_how_far_it_is(name: str) -> None:
    run = xa.sightseer(xa.load(name)) if name == "figure2" else xa.seed_spreader(xa.load(name))
    told = told_by(lambda progress: xa.audit(run, samples=8, progress=progress))
    assert told[-1][0] == told[-1][1]
    assert len(told) > len(run.path) + 8


def test_an_audit_with_progress_checks_the_same() -> None:
    run = xa.sightseer(xa.load("circles"))
    flawed = replace(run, events=run.events[:1] + run.events[2:])
    for progress in (None, lambda done, total: None):
        with pytest.raises(xa.AuditError):
            xa.audit(flawed, progress=progress)


def test_parts_that_are_shorter_than_said_are_closed() -> None:
    def work(progress: Callable[[int, int], None]) -> None:
        meter = Meter(progress, 2, 3, 1)
        meter.add()
        meter.close()
        meter.close()
        meter.add(2)
        meter.close()

    assert told_by(work) == [(1, 6), (2, 6), (5, 6), (6, 6)]


def test_a_meter_never_tells_more_than_the_total() -> None:
    def work(progress: Callable[[int, int], None]) -> None:
        meter = Meter(progress, 3)
        meter.add(2)
        meter.add(5)
        meter.close()

    assert told_by(work) == [(2, 3), (3, 3)]


def test_a_terminal_sees_audits_and_drawings(tmp_path: Path) -> None:
    figure, page = tmp_path / "run.svg", tmp_path / "run.html"
    options = ["--audit", "--figure", str(figure), "--animate", str(page)]
    scene = tmp_path / "scene.json"
    scene.write_text('{"start": [0, 0], "radius": 9, "obstacles": [{"boundary": [[3, 0], [5, 0], [4, 1]]}]}')
    out, seen = on_a_terminal("explore", str(scene), *options)
    assert b"audit passed" in out
    assert all(word in seen for word in (b"exploring", b"drawing", b"auditing"))
