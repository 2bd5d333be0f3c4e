"""What whole runs cost, in loops of 10 million additions of integers in plain Python, and in memory.

``pytest tests/benchmarks/test_engine_speed.py --benchmark-enable -s`` prints one line for each work. Each is
done in a process of its own, which takes the time of the loop before and after it. Without that option only
the smallest is done.
"""

from __future__ import annotations

import json
import subprocess
import sys
from os import environ

import pytest

MEASURE = """
import json, resource, time
import exactacq as xa
from exactacq.files.octagons import random_octagons

def loop():
    start, total = time.process_time(), 0
    for k in range(10_000_000):
        total += k
    return time.process_time() - start

{make}
xa.sightseer(random_octagons(2, 1), radius=3)
before = loop()
start = time.process_time()
done = {work}
spent = time.process_time() - start
most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(json.dumps([2 * spent / (before + loop()), most, str(done)]))
"""

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
WORKS = {
    "Sightseer, 10 octagons": (OCTAGONS.format(n=10), "xa.sightseer(scene, 10)"),
    "Sightseer, 100 octagons": (OCTAGONS.format(n=100), "xa.sightseer(scene, 10)"),
    "Sightseer, 1000 octagons": (OCTAGONS.format(n=1000), "xa.sightseer(scene, 10)"),
    "Seed Spreader, 100 octagons": (TERRAIN.format(n=100), "xa.seed_spreader(scene)"),
    "a board with 93 holes": (BOARD, "xa.sightseer(scene)"),
    "a closed curve of 1000 edges": (CURVE, "xa.sightseer(scene)"),
}


@pytest.mark.parametrize("kernel", ["as it is", "python"])
@pytest.mark.parametrize("name", WORKS)
def test_works(benchmark: object, name: str, kernel: str) -> None:
    if benchmark.disabled and (name != "Sightseer, 10 octagons" or kernel == "python"):
        pytest.skip("takes too long for the everyday suite: run with --benchmark-enable")
    make, work = WORKS[name]
    program = MEASURE.replace("{make}", make).replace("{work}", work)
    wish = {"EXACTACQ_KERNEL": "python"} if kernel == "python" else {}
    command = [sys.executable, "-c", program]
    answer = benchmark.pedantic(
        subprocess.run,
        (command,),
        {"capture_output": True, "check": True, "env": {**environ, **wish}},
        rounds=1,
    )
    loops, megabytes, run = json.loads(answer.stdout)
    print(f"\n{name} (kernel {kernel}): {loops:.1f} loops, {megabytes:.0f} MB; {run}")
    assert loops > 0
