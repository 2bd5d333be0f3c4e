"""Timings of sensing beside its peers, reported and not asserted.

``pytest tests/benchmarks/test_sensing_speed.py --benchmark-enable -s`` shows ratios, group by group; without
that option each small workload runs once, to see that it still runs. The peers:

- pyvispoly (CGAL): the view of unlimited range within the scene's square, from coordinates as exact as ours;
- the stepping simulator of `stepping`: approximate, and without loss and regain of sight. Its "polygon" makes
  the view of limited range at every step, "lazy" only what the map still needs;
- `float_views`, which steps too: a plain sweep in floats at every step, compiled by mypyc if it can be.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import atan2, isqrt, pi
from random import Random
from types import ModuleType
from typing import Any

import float_views
import numpy as np
import pytest
from compiling import compiled
from flint import fmpq
from stepping import Stepper, chords, steps

import exactacq as xa
from exactacq.files.octagons import random_octagons
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.points import Location
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.end_names import Seen
from exactacq.sensing.sensor import Sensor
from exactacq.sensing.view_events import Sweep
from exactacq.visibility.sensor_range import Range

SEED = 1
POINTS = 40
SENSED = ("sight", "acquire", "lose", "regain")
GLIMPSE = 100
"""Steps of the stepping simulator where timings are off."""
FEW = 10
"""Obstacles of a whole run where timings are off."""
SOME = 300
"""Steps of the stepping simulator that stand for the whole path of a large scene."""
LARGE: dict[int, xa.Run] = {}
"""The large runs by their number of obstacles, once they were timed."""


def skip_unless_timed(benchmark: object, n: int) -> None:
    """Large workloads are for timing only."""
    if n > 100 and benchmark.disabled:
        pytest.skip(f"n = {n} takes too long for the everyday suite: run with --benchmark-enable")


@cache
def octagons(n: int) -> xa.Scene:
    """One scene for all tests, as tables that belong to a scene are kept with it."""
    return random_octagons(n, SEED)


@cache
def places(n: int) -> list[tuple[fmpq, fmpq]]:
    """Free rational points of the middle of the scene, out of sight of its rim for both radii.

    The octagons are as dense in every scene, so what is in range does not depend on n.
    """
    rng, scene = Random(SEED), octagons(n)
    side = max(max(x, y) for shape in scene.shapes for x, y, _ in shape.vertices)
    middle, reach = isqrt(int(side * side / 4)), 11
    found: list[tuple[fmpq, fmpq]] = []
    while len(found) < POINTS:
        point = tuple(middle + fmpq(rng.randint(-97 * reach, 97 * reach), 97) for _ in range(2))
        place = xa.Point.of(point)
        if all(obstacle.locate(place) is Location.OUTSIDE for obstacle in scene.obstacles):
            found.append(point)
    return found


# -- views: one group, so that n = 100, n = 1000 and the peer stand side by side -------------------------


def outline(scene: xa.Scene, point: object, radius: int) -> list[object]:
    """The closed outline with all its exact ends, as a view makes only what it is asked for."""
    curves = [piece.curve for piece in xa.isovist(scene, point, radius).pieces]
    return [end.rational for curve in curves for end in (curve.start, curve.end)]


def unread(scene: xa.Scene, point: object, radius: int) -> tuple[object, ...]:
    """The closed outline of whose ends nobody asks more than what kind they are."""
    return xa.isovist(scene, point, radius).pieces


def boundary(scene: xa.Scene, point: object, radius: int) -> object:
    """The boundary seen, of whose ends nobody asks more than their order on the edges."""
    table, rails = sensed(scene)
    return dict(Seen(table, rails, xa.Point.of(point), Range(fmpq(radius)), ()).spans)


@cache
def sensed(scene: xa.Scene) -> tuple[EdgeTable, list[Rail]]:
    """What the sensor keeps of a scene."""
    table = EdgeTable(scene.obstacles)
    return table, [Rail(curve) for curve in table.curves]


def area(scene: xa.Scene, point: object, radius: int) -> xa.Length:
    """The view's exact area (a view made for it alone, outline included)."""
    return xa.isovist(scene, point, radius).area


@pytest.mark.benchmark(group="one view")
@pytest.mark.parametrize("radius", [5, 10])
@pytest.mark.parametrize("n", [100, 1000])
@pytest.mark.parametrize("ask", [outline, unread, boundary, area])
def test_isovist(benchmark: object, ask: Callable[..., object], n: int, radius: int) -> None:
    """The median is one view; what a scene needs once is made before."""
    skip_unless_timed(benchmark, n)
    scene, points = octagons(n), iter(places(n))
    ask(scene, places(n)[0], radius)
    assert benchmark.pedantic(ask, setup=lambda: ((scene, next(points), radius), {}), rounds=POINTS)


@pytest.mark.benchmark(group="one view")
@pytest.mark.parametrize("n", [100, 1000])
@pytest.mark.parametrize("ask", ["outline", "area"])
def test_pyvispoly(benchmark: object, ask: str, n: int) -> None:
    """The whole visibility polygon; the scene's arrangement is made before."""
    skip_unless_timed(benchmark, n)
    peers = pytest.importorskip("peers", reason="needs pyvispoly, an optional test dependency")
    views = peers.views(octagons(n), peers.square_around(octagons(n)))
    points = iter([peers.place(point) for point in places(n)])

    def look(point: object) -> object:
        seen = views.compute_visibility_polygon(point)
        return seen.boundary() if ask == "outline" else seen.area()

    assert benchmark.pedantic(look, setup=lambda: ((next(points),), {}), rounds=POINTS)


# -- whole runs -------------------------------------------------------------------------------------


def explored(scene: xa.Scene) -> xa.Run:
    """A Sightseer's run with its map."""
    run = xa.sightseer(scene)
    assert not run.map.incomplete
    return run


@pytest.mark.benchmark(group="a run with its map, n = 100")
def test_way_of_the_sightseer(benchmark: object) -> None:
    """The way alone, which follows from links."""
    n = FEW if benchmark.disabled else 100
    assert benchmark.pedantic(
        xa.sightseer, setup=lambda: ((random_octagons(n, SEED),), {}), rounds=3
    ).complete


@pytest.mark.benchmark(group="a run with its map, many obstacles")
@pytest.mark.parametrize("n", [1000, 2000])
def test_way_in_a_large_scene(benchmark: object, n: int) -> None:
    """The way alone."""
    skip_unless_timed(benchmark, n)
    assert benchmark.pedantic(
        xa.sightseer, setup=lambda: ((random_octagons(n, SEED),), {}), rounds=1
    ).complete


@pytest.mark.benchmark(group="a run with its map, n = 100")
def test_sensing_sightseer(benchmark: object) -> None:
    n = FEW if benchmark.disabled else 100
    run = benchmark.pedantic(explored, setup=lambda: ((random_octagons(n, SEED),), {}), rounds=3)
    report(benchmark, run)


@pytest.mark.benchmark(group="a run with its map, many obstacles")
@pytest.mark.parametrize("n", [1000, 2000])
def test_large_sensing_sightseer(benchmark: object, n: int) -> None:
    skip_unless_timed(benchmark, n)
    LARGE[n] = benchmark.pedantic(explored, setup=lambda: ((random_octagons(n, SEED),), {}), rounds=1)
    report(benchmark, LARGE[n])


def report(benchmark: object, run: xa.Run) -> None:
    """Cost per sensing event, printed (with -s) and kept with the benchmark's data."""
    events = sum(event.kind in SENSED for event in run.events)
    assert events >= 2 * len(run.scene.obstacles), "each obstacle is seen and acquired"
    benchmark.extra_info["sensing events"] = events
    if not benchmark.disabled:
        cost = benchmark.stats.stats.median / events
        benchmark.extra_info["seconds per sensing event"] = cost
        print(f"\n{events} sensing events, {1e3 * cost:.2f} ms of the whole run for each")


@pytest.mark.benchmark(group="a run with its map, n = 100")
@pytest.mark.parametrize("look", ["lazy", "polygon", "cgal"])
def test_stepping(benchmark: object, look: str) -> None:
    """The peer walks the whole path of the finished run in steps of R / 100."""
    if look == "cgal":
        pytest.importorskip("peers", reason="needs pyvispoly, an optional test dependency")
    run = finished(FEW if benchmark.disabled else 100)
    curves = [piece.curve for piece in run.path]
    steps = GLIMPSE if benchmark.disabled else None
    found = benchmark.pedantic(lambda: Stepper(run.scene, run.radius, look).walk(curves, steps), rounds=1)
    assert found.events
    if steps is None:
        assert found.done.all(), "the peer knows all in the end"


@pytest.mark.benchmark(group="a run with its map, n = 100")
def test_float_stepping(benchmark: object) -> None:
    """The whole path in steps of R / 100; where the robot steps is worked out before."""
    module, is_compiled = (float_views, False) if benchmark.disabled else compiled("float_views")
    run = finished(FEW if benchmark.disabled else 100)
    views, places = stepper(module, run.scene, run.radius), step_places(run)
    left = benchmark.pedantic(views.walk, (places,), rounds=1)
    benchmark.extra_info["compiled"] = is_compiled
    assert left == 0, "the peer knows all in the end"
    if not benchmark.disabled:
        told(is_compiled, len(places), benchmark.stats.stats.median)


@pytest.mark.benchmark(group="a run with its map, many obstacles")
@pytest.mark.parametrize("n", [1000, 2000])
def test_float_stepping_through_a_large_scene(benchmark: object, n: int) -> None:
    """The whole path again."""
    skip_unless_timed(benchmark, n)
    module, is_compiled = compiled("float_views")
    run = LARGE[n] if n in LARGE else finished(n)
    views, places = stepper(module, run.scene, run.radius), step_places(run)
    assert benchmark.pedantic(views.walk, (places,), rounds=1) == 0
    told(is_compiled, len(places), benchmark.stats.stats.median)


def stepper(module: ModuleType, scene: xa.Scene, radius: object) -> Any:
    """The float robot in a scene."""
    start, end, _ = chords(scene)
    return module.FloatViews(*start.T.tolist(), *end.T.tolist(), float(radius))


def step_places(run: xa.Run) -> list[tuple[float, float]]:
    """Where a run's path is looked around from."""
    return [tuple(p.tolist()) for p, _ in steps([piece.curve for piece in run.path], float(run.radius) / 100)]


def told(is_compiled: bool, count: int, seconds: float) -> None:
    """Print what the float robot took."""
    kind = "compiled" if is_compiled else "in Python"
    print(f"\nfloats, {kind}: {count} steps in {seconds:.2f} s, {1e6 * seconds / count:.0f} us each")


def test_the_float_robot_sees_what_isovists_show() -> None:
    """The length of boundary in sight and the area, which the edges in sight cut off the disc."""
    scene = octagons(100)
    views = stepper(float_views, scene, 10)
    for point in places(100)[:12]:
        x, y = map(float, point)
        views.look(x, y)
        exact = xa.isovist(scene, point, 10)
        area = turned = 0.0
        for edge, low, high in zip(views.seen, views.low, views.high, strict=True):
            base = np.array((views.ax[edge] - x, views.ay[edge] - y))
            along = np.array((views.ex[edge], views.ey[edge]))
            p, q = base + high * along, base + low * along
            cross = p[0] * q[1] - p[1] * q[0]
            area, turned = area + cross / 2, turned + atan2(cross, p @ q)
        assert area + 50 * (2 * pi - turned) == pytest.approx(float(exact.area), abs=1e-6)
        length = sum(float(piece.curve.length) for piece in exact.pieces if piece.obstacle is not None)
        assert sum(views.high) - sum(views.low) == pytest.approx(length, abs=1e-6)


@pytest.mark.benchmark(group="a run with its map, many obstacles")
@pytest.mark.parametrize("n", [1000, 2000])
@pytest.mark.parametrize("look", ["lazy", "polygon", "cgal"])
def test_stepping_through_a_large_scene(benchmark: object, look: str, n: int) -> None:
    """Some steps from the middle of the path: the whole walk takes as many times longer as it has more."""
    skip_unless_timed(benchmark, n)
    if look == "cgal":
        pytest.importorskip("peers", reason="needs pyvispoly, an optional test dependency")
    run = LARGE[n] if n in LARGE else finished(n)
    curves = [piece.curve for piece in run.path[len(run.path) // 2 :]]
    stepper = Stepper(run.scene, run.radius, look)
    benchmark.pedantic(lambda: stepper.walk(curves, SOME), rounds=1)
    steps = 100 * float(run.length) / float(run.radius)
    whole = benchmark.stats.stats.median * steps / SOME
    benchmark.extra_info["seconds for the whole path"] = whole
    print(f"\n{look}: {SOME} of {steps:.0f} steps timed; {whole:.0f} s for the whole path at this rate")


@pytest.mark.benchmark(group="one sweep event beside one view, n = 100")
@pytest.mark.parametrize("ask", ["sweep", "view"])
def test_sweep(benchmark: object, ask: str) -> None:
    """The sweeps of all pieces of a run, of all obstacles in reach; and views from places on them."""
    n = FEW if benchmark.disabled else 100
    run = finished(n)
    if ask == "view":
        points = [piece.curve.point(fmpq(1, 2)) for piece in run.path[:: max(1, len(run.path) // 100)]]
        waiting = iter(points)
        setup = lambda: ((run.scene, next(waiting), run.radius), {})  # noqa: E731
        benchmark.pedantic(outline, setup=setup, rounds=len(points))
        return

    def swept() -> int:
        senses = Sensor(EdgeTable(run.scene.obstacles), Range(run.radius))
        return sum(len(Sweep(run.scene, piece, senses).events) for piece in run.path)

    events = benchmark.pedantic(swept, rounds=1)
    assert events > len(run.path)
    benchmark.extra_info["events"] = events
    if not benchmark.disabled:
        print(f"\n{events} events of the view, {1e3 * benchmark.stats.stats.median / events:.2f} ms for each")


@cache
def finished(n: int) -> xa.Run:
    """The run whose path the steppers walk."""
    return xa.sightseer(octagons(n))
