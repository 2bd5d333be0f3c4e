"""Timings of shortest paths beside pyvisgraph and extremitypathfinder, reported and not asserted.

``pytest tests/benchmarks/test_path_speed.py --benchmark-enable -s`` shows the ratios in one run, by CPU time;
without that option the smallest scene runs once. Both peers compute in floats on polygons; what they prepare
for a scene is their visibility graph. A peer that is not installed is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from importlib import import_module
from itertools import pairwise
from math import dist
from time import process_time
from typing import Any

import pytest

import exactacq as xa
from exactacq.files.octagons import random_octagons

SEED = 1
COUNTS = (10, 30, 100, 300, 1000)
PEERS_UP_TO = 100
"""More octagons take a peer longer than the rest of the run together."""
QUERIES = 10
Pair = tuple[float, float]


@cache
def octagons(n: int) -> xa.Scene:
    """One scene for all tests."""
    return random_octagons(n, SEED)


def rings(n: int) -> list[list[Pair]]:
    """The obstacles in floats."""
    return [[edge.start.xy for edge in obstacle.edges] for obstacle in octagons(n).obstacles]


def ends(n: int) -> list[tuple[Pair, Pair]]:
    """Pairs of points on both sides of the scene, so that paths lead through the whole of it."""
    side = max(max(corner) for ring in rings(n) for corner in ring)
    steps = [Fraction(k, QUERIES) for k in range(QUERIES)]
    return [((-1.0, float(int(side * u))), (float(int(side)) + 2, float(int(side * (1 - u))))) for u in steps]


def exactly(n: int) -> Iterator[Callable[[], Any]]:
    """What is prepared, and then a query for each pair of points; the length of its path."""
    shapes = octagons(n).shapes
    made: list[xa.Scene] = []

    def prepare() -> None:
        made.append(xa.Scene(shapes, name="timed"))
        xa.shortest_path(made[0], (-1, -1), (-1, -2))

    yield prepare
    for a, b in ends(n):
        yield lambda a=a, b=b: float(xa.shortest_path(made[0], a, b).length)


def by_pyvisgraph(n: int) -> Iterator[Callable[[], Any]]:
    """The same by pyvisgraph."""
    peer = import_module("pyvisgraph")
    graph = peer.VisGraph()
    shapes = [[peer.Point(*corner) for corner in ring] for ring in rings(n)]
    yield lambda: graph.build(shapes, status=False)
    for a, b in ends(n):

        def query(a: Pair = a, b: Pair = b) -> float:
            way = [(p.x, p.y) for p in graph.shortest_path(peer.Point(*a), peer.Point(*b))]
            return sum(dist(*piece) for piece in pairwise(way))

        yield query


def by_extremitypathfinder(n: int) -> Iterator[Callable[[], Any]]:
    """The same by extremitypathfinder, within a square about the scene."""
    peer = import_module("extremitypathfinder")
    environment = peer.PolygonEnvironment()
    side = max(max(corner) for ring in rings(n) for corner in ring) + 9
    square = [(-9.0, -9.0), (side, -9.0), (side, side), (-9.0, side)]

    def prepare() -> None:
        environment.store(square, [ring[::-1] for ring in rings(n)])
        if hasattr(environment, "prepare"):
            environment.prepare()

    yield prepare
    for a, b in ends(n):
        yield lambda a=a, b=b: environment.find_shortest_path(a, b)[1]


SOLVERS: dict[str, Callable[[int], Iterator[Callable[[], Any]]]] = {
    "exactacq": exactly,
    "pyvisgraph": by_pyvisgraph,
    "extremitypathfinder": by_extremitypathfinder,
}


def timed(act: Callable[[], Any]) -> tuple[float, Any]:
    """Seconds of CPU time, and what comes of it."""
    begin = process_time()
    value = act()
    return process_time() - begin, value


def compare(n: int) -> None:
    """Let all solvers find the same paths, and print their times."""
    lengths: dict[str, list[float]] = {}
    for name, solver in SOLVERS.items():
        if name != "exactacq" and n > PEERS_UP_TO:
            continue
        try:
            first, *rest = solver(n)
        except ModuleNotFoundError:
            continue
        prepared, _ = timed(first)
        answers = [timed(query) for query in rest]
        mean = sum(seconds for seconds, _ in answers) / len(answers)
        lengths[name] = [length for _, length in answers]
        print(f"\n{n} octagons, {name}: {prepared:.3f} s to prepare, {mean * 1000:.1f} ms a path", end="")
    for name, found in lengths.items():
        assert found == pytest.approx(lengths["exactacq"], abs=1e-6), name


@pytest.mark.parametrize("n", COUNTS)
def test_paths_through_octagons(n: int, benchmark: Any) -> None:
    """All solvers find paths of the same length."""
    if benchmark.disabled and n > COUNTS[0]:
        pytest.skip("takes too long for the everyday suite: run with --benchmark-enable")
    benchmark.pedantic(compare, (n,), rounds=1)
