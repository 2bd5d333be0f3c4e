"""Steps of a run cost what they change, however much is known: calls are counted, not seconds.

Twice the scene is twice the work. A step that goes over all that is known makes it four times as much in
the end, and small as it may be beside the rest, it shows in the calls of its own file.
"""

from __future__ import annotations

import sys
import tracemalloc
from collections import Counter
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest
from flint import fmpq
from nightly import NIGHTLY, some

import exactacq as xa
from exactacq.files.octagons import random_octagons
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.interval_union import Cover
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.memory import History, Moment
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.visibility.sensor_range import Range

HALF, QUARTER = fmpq(1, 2), fmpq(1, 4)
SIZES = (6, 12) if NIGHTLY else (4, 8)
GROWTH = 2.4
"""Work in a scene of twice the size, at most: 2, and what comes at its ends."""


def bars(n: int) -> xa.Scene:
    """A tall terrain of two strips, with bars that block line 1 and squares to the west of it.

    The robot has not seen the backs of the squares, and most of them are out of sight most of the time.
    """
    shapes = []
    for y in range(1, 4 * n, 4):
        low, high = y, y + QUARTER
        shapes.append(xa.Polygon([(3 + HALF, low), (4 + HALF, low), (4 + HALF, high), (3 + HALF, high)]))
        shapes.append(xa.Polygon([(1, y + 1), (2, y + 1), (2, y + 2), (1, y + 2)]))
    return xa.Scene(shapes, terrain=xa.Terrain(8, 4 * n + 2), radius=4)


def comb(n: int) -> xa.Scene:
    """A comb with a crumb in each of its slots, from which the comb alone is seen.

    All n links are links from one obstacle.
    """
    outline: list[tuple[int, int]] = [(0, 0), (4 * n + 1, 0)]
    for x in reversed(range(0, 4 * n, 4)):
        outline += [(x + 5, 4), (x + 4, 4), (x + 4, 1), (x + 1, 1)]
    crumbs = [[(x + 2, 2), (x + 3, 2), (x + 3, 3), (x + 2, 3)] for x in range(0, 4 * n, 4)]
    return xa.Scene([xa.Polygon(p) for p in ([*outline, (1, 4), (0, 4)], *crumbs)], (0, -1), radius=3)


def stairs(n: int) -> xa.Scene:
    """One obstacle with n steps, of which the robot sees a few at a time."""
    steps = [corner for k in range(n) for corner in ((k + 1, k), (k + 1, k + 1))]
    return xa.Scene([xa.Polygon([(0, 0), *steps, (0, n)])], start=(-1, -1), radius=5)


def calls(action: Callable[[], object]) -> Counter[str]:
    """Calls of functions, and what their generators yield, by the files of the package."""
    found: Counter[str] = Counter()

    def count(frame: FrameType, event: str, argument: Any) -> None:
        if event == "call":
            found[frame.f_code.co_filename] += 1

    sys.setprofile(count)
    try:
        action()
    finally:
        sys.setprofile(None)
    return Counter({file.rpartition("exactacq/")[2]: n for file, n in found.items() if "exactacq/" in file})


def is_linear(small: Counter[str], large: Counter[str], *files: str) -> bool:
    """Whether twice the scene is twice the work in some files."""
    return all(0 < large[file] < GROWTH * small[file] for file in files)


@pytest.mark.parametrize("lookahead", some([True, False], 1))
def test_a_sweep_is_not_quadratic(lookahead: bool) -> None:
    small, large = (calls(lambda n=n: xa.seed_spreader(bars(n), lookahead=lookahead)) for n in SIZES)
    spreader = [f"strategies/seed_spreader/{name}.py" for name in ("rules", "losses")]
    robot = [f"strategies/{name}.py" for name in ("robot", "observer", "lookout", "routes", "known_map")]
    assert is_linear(small, large, *spreader, *robot, "sensing/memory.py", "sensing/map.py")


def test_a_tour_is_not_quadratic() -> None:
    small, large = (calls(lambda n=n: xa.sightseer(comb(n)).sense()) for n in SIZES)
    assert is_linear(
        small,
        large,
        "strategies/known_links.py",
        "strategies/robot.py",
        "strategies/walker.py",
        "sensing/memory.py",
    )


def test_a_walk_around_is_not_quadratic() -> None:
    """At every edge it is asked whether the obstacle is known all around: what was missing is asked first."""
    small, large = (calls(lambda n=n: xa.sightseer(stairs(n)).sense()) for n in (30, 60))
    assert is_linear(small, large, "sensing/targets.py", "geometry/interval_union.py")


def test_places_in_order_are_not_quadratic() -> None:
    runs = [xa.sightseer(comb(n)) for n in (6, 12)]
    small, large = (calls(lambda r=run: [event.at for event in r.events]) for run in runs)
    assert is_linear(small, large, "sensing/event.py", "sensing/path.py")


def test_maps_in_order_are_not_quadratic() -> None:
    runs = [xa.sightseer(comb(n)) for n in (6, 12)]
    small, large = (calls(lambda r=run: [r.map_at(event) for event in r.events]) for run in runs)
    assert is_linear(small, large, "strategies/run.py", "sensing/memory.py", "sensing/leg_views.py")


def memory_for(action: Callable[[], object]) -> int:
    """The most bytes that an action needs at a time."""
    tracemalloc.start()
    try:
        kept = action()
        return tracemalloc.get_traced_memory()[1] if kept is not None else 0
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("make", [lambda run: run.memory.now, lambda run: run.map_at(run.events[-1])])
def test_a_map_is_made_without_a_copy_of_what_is_known(make: Callable[[xa.Run], xa.Map]) -> None:
    runs = (xa.sightseer(comb(n)).sense() for n in (3, 12))
    small, large = (memory_for(lambda r=run: make(r)) for run in runs)
    assert large < 1.5 * small


def test_a_map_stays_as_it_was() -> None:
    run = xa.seed_spreader(xa.load("case3"))
    maps = [run.memory.after(count) for count in range(len(run.path) + 1)]
    told = [[chart.known(k) for k in range(len(run.obstacles))] for chart in maps]
    again = run.memory.of(run.scene, run.radius, run.start, (), run.ground)
    now = [again.now]
    for piece in run.path:
        again.walk(piece)
        now.append(again.now)
    lengths = [[length_of(known) for known in moment] for moment in told]
    assert [[chart.known_length(k) for k in range(len(run.obstacles))] for chart in now] == lengths


def length_of(known: tuple[Any, ...]) -> xa.Length:
    return xa.Length.sum(part.length for part in known)


def test_a_moment_lists_the_edges_that_were_known() -> None:
    history = History()
    first, second, third = Cover(), Cover(), Cover()
    for learned in ({4: first}, {2: second}, {4: third}):
        history.learn(learned)
    assert dict(Moment(history, 0, {})) == {4: first}
    assert dict(Moment(history, 2, {})) == {4: third, 2: second}
    moment = Moment(history, 1, {}).grown({7: third})
    assert (len(moment), moment[4], moment[7], moment.get(3)) == (3, first, third, None)


def test_ways_share_the_rails_of_the_scene() -> None:
    """A run keeps what its ways showed. A copy of all rails for every way would make that quadratic."""
    table = EdgeTable(random_octagons(60, 1).obstacles)
    clipper = VisibilityComplex(table, Range(fmpq(10))).clipper
    way = Rail(xa.Segment((0, 0), (1, 1)))
    rails, count = clipper.with_way(way).rails, len(clipper.rails)
    assert rails[count] is rails[-1] is way and len(rails) == count + 1
    assert all(rails[e] is clipper.rails[e] for e in range(count))
    assert memory_for(lambda: [clipper.with_way(way) for _ in range(100)]) < 100 * 8 * count
