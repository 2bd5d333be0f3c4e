"""Timings, reported and not asserted: ``pytest tests/benchmarks --benchmark-enable``.

Without that option each workload of the everyday suite runs once, to see that it still runs.
"""

from __future__ import annotations

import pytest

import exactacq as xa
from exactacq.files.octagons import random_octagons
from exactacq.visibility.links import Links

SEED = 1


def skip_unless_timed(benchmark: object, n: int) -> None:
    """Large workloads are for timing only."""
    if n > 10 and benchmark.disabled:
        pytest.skip(f"n = {n} takes too long for the everyday suite: run with --benchmark-enable")


@pytest.mark.parametrize("n", [10, 30, 100, 1000])
def test_visibility_graph(benchmark: object, n: int) -> None:
    skip_unless_timed(benchmark, n)
    scene = random_octagons(n, SEED)
    graph = benchmark.pedantic(xa.visibility_graph, (scene,), rounds=3 if n <= 100 else 1)
    assert graph.number_of_nodes() == n + 1


@pytest.mark.parametrize("n", [10, 30, 100, 1000])
def test_sightseer(benchmark: object, n: int) -> None:
    skip_unless_timed(benchmark, n)
    scene = random_octagons(n, SEED)
    run = benchmark.pedantic(xa.sightseer, (scene,), rounds=3 if n <= 100 else 1)
    assert run.complete


@pytest.mark.parametrize("n", [10, 30, 100, 1000])
def test_length_of_a_run(benchmark: object, n: int) -> None:
    """The sum of all pieces, and its first 50 digits."""
    skip_unless_timed(benchmark, n)
    path = xa.sightseer(random_octagons(n, SEED)).path
    digits = benchmark.pedantic(lambda: path.length_after(len(path)).decimal(50), rounds=3 if n <= 100 else 1)
    assert len(digits) > 50


def test_one_link_with_a_free_closest_pair(benchmark: object) -> None:
    """v of an obstacle and its nearest neighbour, which nothing stands between; another pair each round."""
    scene = random_octagons(10 if benchmark.disabled else 100, SEED)
    pairs = iter(nearest_pairs(Links(scene, scene.radius)))
    links = Links(scene, scene.radius)
    links.between(*next(pairs))  # the spatial index is built once a scene

    rounds = 1 if benchmark.disabled else 40
    found = benchmark.pedantic(links.between, setup=lambda: (next(pairs), {}), rounds=rounds)
    assert found is not None


def nearest_pairs(links: Links) -> list[tuple[int, int]]:
    """Each obstacle with its nearest one, no pair twice."""
    pairs = set()
    for i in range(links.count):
        near = [links.between(i, j) for j in links.neighbours(i)]
        shortest = min((link for link in near if link is not None), key=lambda link: link.length)
        pairs.add((min(i, shortest.target), max(i, shortest.target)))
    return sorted(pairs)


def test_random_octagons(benchmark: object) -> None:
    """Making and validating a scene of 1000 obstacles."""
    n = 100 if benchmark.disabled else 1000
    assert len(benchmark.pedantic(random_octagons, (n, SEED), rounds=1).shapes) == n
