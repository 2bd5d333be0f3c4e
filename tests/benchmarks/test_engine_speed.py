"""What whole runs cost, in loops of 10 million additions of integers in plain Python, and in memory.

``pytest tests/benchmarks/test_engine_speed.py --benchmark-enable -s`` prints one line for each work. Each is
done in a process of its own, which takes the time of the loop before and after it. Without that option only
the smallest is done. The run among 10,000 octagons is stopped after `MINUTES` of its processor's time: it
prints how far it came, and how fast.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from measuring import measured

OCTAGONS = "scene = random_octagons({n}, 1)"
TERRAIN = """
octagons = random_octagons({n}, 1)
corners = [edge.start.xy for obstacle in octagons.obstacles for edge in obstacle.edges]
width, height = (int(max(corner[k] for corner in corners)) + 2 for k in (0, 1))
scene = xa.Scene(octagons.shapes, terrain=xa.Terrain(width, height), radius=10)
"""
BOARD = """
holes = [xa.Circle((k % 10 * 2 + 2, k // 10 * 2 + 2), "3/5") for k in range(93)]
scene = xa.Scene(holes, start=(1, 1), radius=20)
"""
CURVE = """
from fractions import Fraction
from math import cos, pi, sin
def corner(k):
    size = 100 + (5 if k % 2 else 0)
    return [Fraction(round(1000 * size * f(2 * pi * k / 1000)), 1000) for f in (cos, sin)]
scene = xa.Scene([xa.Polygon([corner(k) for k in range(1000)])], start=(-112, 0), radius=20)
"""
GRID = """
from pathlib import Path
from grids import grid_scene
scene = grid_scene(Path({data!r}, "turtlebot3.pgm"), (199, 230), 25)
def audited(run):
    xa.audit(run)
    return run
"""
CAMPAIGN = """
from collections import Counter
from exactacq.study.campaign.judging import judge
from exactacq.study.campaign.settings import Task
def judged(strategy, count):
    begin = time.process_time()
    results = Counter(judge(Task(strategy, seed), (), audited=True).result for seed in range(count))
    return f"{count / (time.process_time() - begin):.1f} scenes a second, {dict(results)}"
"""
SWEEPS = """
from flint import fmpq
from exactacq.gc_pause import uncollected
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.sensor import Sensor
from exactacq.sensing.view_events import Sweep
from exactacq.visibility.sensor_range import Range
run = xa.sightseer(random_octagons({n}, 1), 10)
def swept():
    begin = time.process_time()
    senses = Sensor(EdgeTable(run.scene.obstacles), Range(run.radius))
    events = sum(len(Sweep(run.scene, piece, senses).events) for piece in run.path)
    middle = time.process_time()
    places = [piece.curve.point(fmpq(1, 2)) for piece in run.path]
    with uncollected():
        views = [xa.isovist(run.scene, place, run.radius).pieces for place in places]
    one, other = (middle - begin) / events, (time.process_time() - middle) / len(views)
    times = f"{{1e3 * one:.2f}} ms each, a view {{1e3 * other:.2f}} ms"
    return f"{{events}} events, {{times}}: {{one / other:.2f}} views for an event"
"""
FAR = """
import resource, time
import exactacq as xa
from exactacq.files.octagons import random_octagons

class Over(Exception):
    pass

scene = random_octagons({n}, 1)
begin, told = time.process_time(), [0.0]

def telling(what):
    told[0] = 0.0
    def progress(done, total):
        spent = time.process_time() - begin
        if spent > told[0] + {seconds} / 10 or done == total or spent > {seconds}:
            most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            print(f"{{done}} of {{total}} {{what}} after {{spent:.0f}} s, {{most:.0f}} MB", flush=True)
            told[0] = spent
        if spent > {seconds}:
            raise Over
    return progress

try:
    run = xa.sightseer(scene, progress=telling("edges circled"))
    run.sense(telling("pieces sensed"))
    print(f"{{len(run.visits)}} of {n} visited")
except Over:
    pass
"""
HEAP = """
import tracemalloc
import exactacq as xa
from exactacq.files.octagons import random_octagons
scene = random_octagons({n}, 1)
tracemalloc.start()
run = xa.sightseer(scene, 10).sense()
held, most = (size / 2**20 for size in tracemalloc.get_traced_memory())
print(f"{n} octagons: {{held:.0f}} MB held by the run, {{most:.0f}} MB at most, {{len(run.events)}} events")
"""
MINUTES = 10
DATA = Path(__file__).resolve().parents[1] / "data"
WORKS = {
    "Sightseer, 10 octagons": (OCTAGONS.format(n=10), "xa.sightseer(scene, 10).sense()"),
    "Sightseer, 100 octagons, its way": (OCTAGONS.format(n=100), "xa.sightseer(scene, 10)"),
    "Sightseer, 100 octagons": (OCTAGONS.format(n=100), "xa.sightseer(scene, 10).sense()"),
    "Sightseer, 1000 octagons, its way": (OCTAGONS.format(n=1000), "xa.sightseer(scene, 10)"),
    "Sightseer, 1000 octagons": (OCTAGONS.format(n=1000), "xa.sightseer(scene, 10).sense()"),
    "Seed Spreader, 100 octagons": (TERRAIN.format(n=100), "xa.seed_spreader(scene)"),
    "a board with 93 holes": (BOARD, "xa.sightseer(scene).sense()"),
    "a closed curve of 1000 edges": (CURVE, "xa.sightseer(scene).sense()"),
    "the TurtleBot3 map, R = 25, audited": (GRID.format(data=str(DATA)), "audited(xa.sightseer(scene))"),
    "random scenes, Sightseer": (CAMPAIGN, "judged('sightseer', 40)"),
    "random scenes, Seed Spreader": (CAMPAIGN, "judged('seed-spreader', 40)"),
    "sweeps, 30 octagons": (SWEEPS.format(n=30), "swept()"),
}


@pytest.mark.parametrize("kernel", ["as it is", "python"])
@pytest.mark.parametrize("name", WORKS)
def test_works(benchmark: object, name: str, kernel: str) -> None:
    if benchmark.disabled and (name != "Sightseer, 10 octagons" or kernel == "python"):
        pytest.skip("takes too long for the everyday suite: run with --benchmark-enable")
    wish = {"EXACTACQ_KERNEL": "python"} if kernel == "python" else {}
    found = measured(benchmark, *WORKS[name], wish)
    print(f"\n{name} (kernel {kernel}): {found.loops:.1f} loops, {found.megabytes:.0f} MB; {found.result}")
    assert found.loops > 0


def test_many_octagons(benchmark: object) -> None:
    """10,000 of them, as far as the run comes in `MINUTES`; without timing, two octagons."""
    size, seconds = (2, 60) if benchmark.disabled else (10_000, 60 * MINUTES)
    command = [sys.executable, "-c", FAR.format(n=size, seconds=seconds)]
    asked = {"capture_output": True, "check": True, "text": True}
    answer = benchmark.pedantic(subprocess.run, (command,), asked, rounds=1)
    print(f"\n{answer.stdout}")
    assert "edges circled" in answer.stdout


@pytest.mark.parametrize("size", [2, 100, 1000, 10_000])
def test_heap(benchmark: object, size: int) -> None:
    """What Python's own objects take, by `tracemalloc`, which makes runs some four times slower."""
    if benchmark.disabled and size > 2:
        pytest.skip("takes too long for the everyday suite: run with --benchmark-enable")
    command = [sys.executable, "-c", HEAP.format(n=size)]
    asked = {"capture_output": True, "check": True, "text": True}
    answer = benchmark.pedantic(subprocess.run, (command,), asked, rounds=1)
    print(f"\n{answer.stdout}")
    assert f"{size} octagons" in answer.stdout
