"""Simplified rings, judged by shapely."""

from __future__ import annotations

from pathlib import Path
from random import Random

import numpy as np
import pytest
import shapely
from flint import fmpq
from nightly import some

from exactacq.errors import FormatError
from exactacq.files.by_suffix import load
from exactacq.files.grids.outlines import JOIN, PART, outlines
from exactacq.files.repairs.simplify import simplify


def stairs(steps: int) -> list[tuple[int, int]]:
    rise = [node for k in range(steps) for node in ((k, k), (k + 1, k))]
    return [*rise, (steps, steps), (0, steps)][0:]


def blobs(seed: int, size: int = 28) -> np.ndarray:
    """Blocked cells with smooth borders, islands in lakes and corners that touch."""
    random = np.random.default_rng(seed)
    waves = np.zeros((size, size))
    y, x = np.mgrid[:size, :size]
    for _ in range(8):
        a, b, c = random.uniform(-0.7, 0.7, 3)
        waves += np.cos(a * x + b * y + 9 * c)
    return waves + random.normal(0, 0.3, waves.shape) > 0.5


def relation(rings: list) -> list[tuple[bool, ...]]:
    """Which ring lies in which."""
    shapes = [shapely.Polygon(ring) for ring in rings]
    return [tuple(a.contains(b) for b in shapes) for a in shapes]


def check(before: list, after: list, tolerance: float) -> None:
    assert len(before) == len(after)
    for old, new in zip(before, after, strict=True):
        assert set(new) <= set(old)
        assert len(new) >= 3
        assert shapely.LinearRing(new).is_simple
        assert shapely.Polygon(new).area > 0
        a, b = (shapely.segmentize(shapely.LinearRing(ring), 0.25) for ring in (old, new))
        assert shapely.hausdorff_distance(a, b) <= tolerance + 1e-9
    lines = [shapely.LinearRing(ring) for ring in after]
    tree = shapely.STRtree(lines)
    first, second = tree.query(lines, predicate="intersects")
    assert (first == second).all()
    assert relation(before) == relation(after)


@pytest.mark.parametrize("corners", [JOIN, PART])
@pytest.mark.parametrize("seed", some(range(8), 3))
def test_rings_stay_near_simple_disjoint_and_nested(seed: int, corners: str) -> None:
    rings = outlines(blobs(seed), corners)
    last = sum(map(len, rings))
    for steps in (1, 3, 6, 14):
        found = simplify(rings, fmpq(steps))
        check(rings, found, steps)
        assert sum(map(len, found)) <= last * 1.1
        last = sum(map(len, found))


def test_a_staircase_becomes_a_line() -> None:
    ring = stairs(40)
    assert sorted(simplify([ring], fmpq(1))[0]) == [(0, 0), (0, 40), (40, 40)]
    check([ring], simplify([ring], fmpq(1)), 1)
    assert len(simplify([ring], fmpq(1, 4))[0]) == len(ring)


def test_a_small_ring_never_vanishes() -> None:
    cell = [(0, 0), (4, 0), (4, 4), (0, 4)]
    found = simplify([cell], fmpq(100))
    assert len(found[0]) == 3
    check([cell], found, 100)


def test_an_island_that_a_run_would_jump_over_stays_outside() -> None:
    bay = [(0, 0), (40, 0), (40, 20), (30, 20), (30, 4), (10, 4), (10, 20), (0, 20)]
    island = [(18, 8), (22, 8), (22, 12), (18, 12)]
    check([bay, island], simplify([bay, island], fmpq(17)), 17)
    assert len(simplify([bay], fmpq(17))[0]) < len(simplify([bay, island], fmpq(17))[0])


def test_a_fixed_point_stays_on_its_side() -> None:
    bay = [(0, 0), (40, 0), (40, 20), (30, 20), (30, 4), (10, 4), (10, 20), (0, 20)]
    point = (fmpq(39, 2), fmpq(21, 2))
    for fixed in ([], [point]):
        (ring,) = simplify([bay], fmpq(17), fixed)
        assert shapely.Polygon(ring).contains(shapely.Point(19.5, 10.5)) == (not fixed)


def test_a_narrow_passage_is_not_closed() -> None:
    low = [(0, 0), (20, 0), (20, 3), (10, 7), (0, 3)]
    high = [(0, 20), (0, 5), (10, 9), (20, 5), (20, 20)]
    check([low, high], simplify([low, high], fmpq(6)), 6)


@pytest.mark.parametrize("seed", range(5))
def test_the_order_and_the_sense_of_rings_do_not_matter_for_what_holds(seed: int) -> None:
    rings = outlines(blobs(seed + 50, 16))
    Random(seed).shuffle(rings)
    turned = [ring[::-1] for ring in rings]
    check(turned, simplify(turned, fmpq(5)), 5)


def test_without_a_tolerance_only_vertices_on_lines_go() -> None:
    ring = [(0, 0), (2, 0), (4, 0), (4, 4), (0, 4)]
    assert simplify([ring], fmpq(0)) == [[(0, 0), (4, 0), (4, 4), (0, 4)]]


def test_a_negative_tolerance_is_refused() -> None:
    with pytest.raises(FormatError, match="at least 0"):
        simplify([stairs(3)], fmpq(-1))


def test_a_map_of_a_robot_is_simplified_within_the_length_and_says_so() -> None:
    path = Path(__file__).parent / "data" / "turtlebot3.yaml"
    plain = load(path, start=(0, 0))
    fewer = load(path, start=(0, 0), simplify="1/20")
    edges = [sum(len(s.vertices) for s in (*scene.shapes, scene.enclosure)) for scene in (plain, fewer)]
    assert edges[1] < edges[0] * 0.7
    assert len(plain.obstacles) == len(fewer.obstacles)
    assert any("is farther than 0.05 from the other" in note for note in fewer.notes)
    assert load(path, start=(0, 0), simplify=0).notes != plain.notes
