"""Timings of sweeps, reported and not asserted.

``pytest tests/benchmarks/test_sweep_speed.py --benchmark-enable -s`` shows how the time of a run grows with
the length of the M-line at constant density; without that option the small terrain is swept once.
"""

from __future__ import annotations

from functools import cache
from math import ceil

import pytest

import exactacq as xa
from exactacq.files.octagons import random_octagons

SEED = 1
RADIUS = 10


@cache
def terrain(n: int) -> xa.Scene:
    """n octagons with a terrain that just holds them."""
    scene = random_octagons(n, SEED)
    corners = [edge.start.xy for obstacle in scene.obstacles for edge in obstacle.edges]
    width, height = (ceil(max(corner[k] for corner in corners)) + 1 for k in (0, 1))
    return xa.Scene(scene.shapes, terrain=xa.Terrain(width, height), radius=RADIUS)


@pytest.mark.parametrize("lookahead", [True, False])
@pytest.mark.parametrize("n", [10, 30, 100, 300])
def test_sweep(benchmark: object, n: int, lookahead: bool) -> None:
    if n > 10 and benchmark.disabled:
        pytest.skip(f"n = {n} takes too long for the everyday suite: run with --benchmark-enable")
    scene = terrain(n)
    run = benchmark.pedantic(xa.seed_spreader, (scene,), {"lookahead": lookahead}, rounds=1)
    line = (scene.terrain.width / RADIUS + 1) * scene.terrain.height
    seconds = benchmark.stats.stats.median if not benchmark.disabled else float("nan")
    print(
        f"\nn = {n}, lookahead {lookahead}: {seconds:.1f} s, {len(run.visits)} visits,"
        f" {len(run.diversions)} diversions, path {float(run.length):.0f},"
        f" {seconds / float(run.length) * 1e3:.0f} ms per unit of it, M-line about {float(line):.0f}"
    )
    assert run.complete
