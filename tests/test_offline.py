"""Lower bounds of all paths: closed forms, brute force by other means, and no run below them."""

from __future__ import annotations

from itertools import combinations, pairwise
from math import pi

import networkx as nx
import pytest
import shapely
from gallery_runs import gallery_run
from hypothesis import given
from hypothesis import strategies as st
from nightly import examples

import exactacq as xa
from exactacq.files import gallery
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.gaps import boundary_distance
from exactacq.strategies import offline
from exactacq.strategies.offline import offline_bounds

SIGHTSEER = [name for name in gallery.names() if not gallery.is_swept(name)]


def box(x: object, y: object, size: object = 1) -> xa.Polygon:
    return xa.Polygon([(x, y), (x + size, y), (x + size, y + size), (x, y + size)])


@pytest.mark.parametrize("name", SIGHTSEER)
def test_no_run_is_shorter(name: str) -> None:
    run = gallery_run(name)
    bounds = offline_bounds(run.scene, obstacles=run.visits)
    assert bounds.seeing <= bounds.circling <= run.length


def test_squares_in_a_row_are_joined_one_by_one() -> None:
    """The start has its own gap; of the distances 1, 2, 4 between squares the longer ones are left out."""
    scene = xa.Scene([box(2, -1), box(4, -1), box(7, -1), box(12, -1)], start=(0, 0))
    bounds = offline_bounds(scene, radius=1)
    assert bounds.circling == 16 + 2 + 1 + 2 + 4
    assert [(gap.source, gap.target) for gap in bounds.tree] == [(0, 1), ("S", 0), (1, 2), (2, 3)]
    assert bounds.seeing == 1 + 0 + 0 + 2
    assert offline_bounds(scene, radius=1, obstacles=[3]).circling == 4 + 12


def test_a_wall_between_does_not_matter() -> None:
    """Distances are those of the boundaries, whatever stands between: the bound is one of any path."""
    wall = xa.Polygon([(3, -50), (4, -50), (4, 50), (3, 50)])
    scene = xa.Scene([box(1, 0), wall, box(6, 0)], start=(0, "1/2"))
    assert offline_bounds(scene, radius=9, obstacles=[0, 2]).circling == 8 + 1 + 4


def test_round_obstacles_and_a_start_in_the_centre_of_an_arc() -> None:
    half = xa.Outline([(3, 0, 1), (-3, 0, xa.Via((0, "7/2")))])
    bounds = offline_bounds(xa.Scene([half], start=(0, 0)), radius=1)
    assert bounds.tree[0].length == 3
    assert offline_bounds(xa.Scene([xa.Circle((5, 0), 2)], start=(3, 0)), radius=1).tree[0].length == 0


def test_of_obstacles_that_are_seen_at_once_few_distances_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """All weigh nothing where the radius is large: the first that join them are enough."""
    found: list[tuple[int, int]] = []

    def counted(table: EdgeTable, i: int, j: int) -> xa.Real:
        found.append((i, j))
        return boundary_distance(table, i, j)

    monkeypatch.setattr(offline, "boundary_distance", counted)
    squares = [box(2 * x, 2 * y + 1) for x in range(4) for y in range(4)]
    assert offline_bounds(xa.Scene(squares, start=(0, 0)), radius=99).seeing == 0
    assert len(found) <= 2 * len(squares)


def test_nothing_to_explore() -> None:
    assert offline_bounds(xa.Scene([], start=(0, 0)), radius=1)[:2] == (0, 0)


@examples(15)
@given(
    st.lists(
        st.tuples(st.integers(0, 5), st.integers(0, 5), st.sampled_from(["1/2", "1/3", "2/5"])),
        min_size=1,
        max_size=7,
        unique_by=lambda p: p[:2],
    ),
    st.sampled_from(["1/2", 1, 3]),
)
def test_it_is_the_tree_that_all_pairs_give(spots: list[tuple[int, int, str]], radius: object) -> None:
    """Circles and squares on a grid, many gaps equal; by shapely and networkx."""
    shapes: list[object] = []
    floats: list[tuple[shapely.Geometry, float]] = []  # What all points within a distance make up.
    for k, (x, y, size) in enumerate(spots):
        r = float(xa.Real(size))
        if k % 2:
            shapes.append(xa.Circle((2 * x, 2 * y), size))
            floats.append((shapely.Point(2 * x, 2 * y), r))
        else:
            q = xa.Real(size).rational
            corners = [(2 * x - q, 2 * y), (2 * x, 2 * y - q), (2 * x + q, 2 * y), (2 * x, 2 * y + q)]
            shapes.append(xa.Polygon(corners))
            floats.append((shapely.Polygon([(float(a), float(b)) for a, b in corners]), 0.0))
    bounds = offline_bounds(xa.Scene(shapes, start=(-3, 1), radius=radius))
    nodes = [(shapely.Point(-3, 1), 0.0), *floats]
    for value, reach in ((bounds.circling, 0.0), (bounds.seeing, float(xa.Real(radius)))):
        graph = nx.Graph()
        for i, j in combinations(range(len(nodes)), 2):
            (one, r), (other, q) = nodes[i], nodes[j]
            less = r + q + (reach if i == 0 else 2 * reach)
            graph.add_edge(i, j, weight=max(one.distance(other) - less, 0.0))
        total = nx.minimum_spanning_tree(graph).size("weight")
        perimeters = 0 if reach else sum(shape.length + 2 * pi * r for shape, r in floats)
        assert float(value) == pytest.approx(total + perimeters, abs=1e-9)


def test_more_obstacles_never_make_circling_shorter() -> None:
    run = xa.sightseer(xa.load("figure2"))
    bounds = [offline_bounds(run.scene, obstacles=range(k)).circling for k in range(len(run.visits) + 1)]
    assert all(a < b for a, b in pairwise(bounds))
