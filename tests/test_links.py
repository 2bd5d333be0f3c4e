"""The obstacle visibility graph: against the float oracle, by hand in degenerate scenes, and its laws."""

from __future__ import annotations

import math
import tracemalloc
from fractions import Fraction
from itertools import combinations
from random import Random

import networkx as nx
import numpy as np
import pytest
from flint import fmpq
from hypothesis import given
from nightly import NIGHTLY, examples
from oracles import Disc, Room, free, shortest_visible, world
from sampled_links import ambiguous, free_sample_shorter
from strategies import (
    EPS,
    POLYGONS,
    ROUND,
    SIMILARITIES,
    Similarity,
    Terrain,
    box,
    build,
    circle_grid,
    degenerate_terrain,
    degenerate_terrains,
    random_terrain,
    reversed_order,
    square_grid,
    terrains,
)

import exactacq as xa
from exactacq.errors import InvalidScene
from exactacq.files.octagons import random_octagons
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.gaps import near_hull
from exactacq.visibility import congruent_chords
from exactacq.visibility.chords import Chord
from exactacq.visibility.features import features
from exactacq.visibility.line_families import Turning
from exactacq.visibility.links import Links

Q = Fraction
LAW_EXAMPLES = examples(3, 60)


def graph_of(terrain: Terrain) -> nx.Graph:
    return xa.visibility_graph(terrain.scene(), terrain.radius)


def weights(graph: nx.Graph) -> dict[frozenset, Length]:
    return {frozenset(edge[:2]): edge[2] for edge in graph.edges(data="weight")}


def weight(shapes: list, radius: object) -> Length | None:
    """v(0, 1)."""
    graph = xa.visibility_graph(build(shapes), radius)
    return graph.edges[0, 1]["weight"] if graph.has_edge(0, 1) else None


def root(radicand: int) -> Length:
    return Length(Real(radicand).sqrt())


def ends(graph: nx.Graph, i: int, j: int) -> set[tuple[float, float]]:
    data = graph.edges[i, j]
    return {data["leave"].xy, data["hit"].xy}


def cube_root(n: int) -> int:
    """Rounded down."""
    x = 1 << -(-n.bit_length() // 3)
    while (y := (2 * x + n // (x * x)) // 3) < x:
        x = y
    return x


# Against the oracle.


def check_against_oracle(terrain: Terrain, accuracy: float = 1e-9) -> None:
    """The same edges and lengths; every link is free, and no sampled pair of points is closer."""
    graph = graph_of(terrain)
    shapes, radius = terrain.shapes, terrain.radius
    w = world(shapes)
    n = len(shapes)
    assert set(graph.nodes) == {*range(n), "S"}
    pairs = [*combinations(range(n), 2), *(("S", j) for j in range(n))]
    for i, j in pairs:
        source = terrain.start if i == "S" else i
        expected = shortest_visible(shapes, source, j, radius)
        if graph.has_edge(i, j) != (expected is not None):
            assert ambiguous(shapes, source, j, radius), (i, j, expected)
        if not graph.has_edge(i, j):
            continue
        data = graph.edges[i, j]
        length, p, q = float(data["weight"]), data["leave"].xy, data["hit"].xy
        assert length <= radius
        assert math.dist(p, q) == pytest.approx(length, abs=1e-9)
        assert free(shapes, p, q), (i, j, p, q)
        gaps = [boundary_gap(w, terrain, i, a) + boundary_gap(w, terrain, j, b) for a, b in [(p, q), (q, p)]]
        assert min(gaps) < 1e-9, (i, j, p, q)
        if expected is not None and abs(expected.length - length) > accuracy:
            assert ambiguous(shapes, source, j, radius), (i, j, length, expected)
        if i != "S" and length > 1e-6:
            assert free_sample_shorter(shapes, i, j, length - 1e-6, 24) is None, (i, j)


def boundary_gap(w: object, terrain: Terrain, i: object, point: tuple[float, float]) -> float:
    """Distance of a point to the boundary i, or to the start."""
    if i == "S":
        return math.dist(point, [float(c) for c in terrain.start])
    return math.dist(point, w.at(i, w.position(i, point)))


class TestAgainstTheOracle:
    @examples(8, 400)
    @given(terrains(kinds=POLYGONS))
    def test_polygons(self, terrain: Terrain) -> None:
        check_against_oracle(terrain)

    @examples(8, 400)
    @given(terrains(kinds=ROUND))
    def test_arcs(self, terrain: Terrain) -> None:
        check_against_oracle(terrain)

    @examples(5, 200)
    @given(terrains(room=True))
    def test_rooms(self, terrain: Terrain) -> None:
        check_against_oracle(terrain)

    @examples(10, 400)
    @given(degenerate_terrains())
    def test_small_integers(self, terrain: Terrain) -> None:
        """Chords that end tangent to a circle are common here, and there the floats are good to 1e-7 only."""
        check_against_oracle(terrain, accuracy=1e-6)

    @pytest.mark.parametrize("seed", range(4))
    def test_seeded_small_integers(self, seed: int) -> None:
        check_against_oracle(degenerate_terrain(Random(seed)), accuracy=1e-6)

    @pytest.mark.parametrize("seed", range(6))
    def test_seeded_scenes(self, seed: int) -> None:
        """Hypothesis's quick examples stay simple; these are in general position."""
        check_against_oracle(random_terrain(Random(seed), columns=4 if seed < 2 else 3))


# By hand.


class TestRange:
    @pytest.mark.parametrize(
        "shapes",
        [
            [box(0, 1, 0, 1), box(4, 5, 0, 1)],
            [box(0, 1, 0, 1), box(Q(14, 5), 9, Q(17, 5), 9)],
            [Disc(0, 0, 1), Disc(3, 4, 1)],
            [Disc(0, 0, 1), box(4, 5, -1, 1)],
            [[(2, 3), (-7, 3), (-7, 4)], Disc(2, -1, 1)],
        ],
        ids=["edges", "corners", "circles", "circle and edge", "corner and circle"],
    )
    def test_sees_at_exactly_the_gap(self, shapes: list) -> None:
        """All gaps are 3."""
        assert weight(shapes, 3) == 3
        assert weight(shapes, 3 + EPS) == 3
        assert weight(shapes, 3 - EPS) is None

    def test_an_irrational_chord_against_rational_ranges(self) -> None:
        below = Q(math.isqrt(125 * 10**160), 10**80)
        assert weight(LADDER, below) is None
        assert weight(LADDER, below + Q(1, 10**80)) == 5 * root(5)

    def test_a_wider_range_changes_nothing_else(self) -> None:
        terrain = random_terrain(Random(5))
        near = weights(xa.visibility_graph(terrain.scene(), 3))
        far = weights(xa.visibility_graph(terrain.scene(), 6))
        assert {key for key, value in far.items() if value <= 3} == near.keys()
        assert all(far[key] == value for key, value in near.items())


FLOOR, CEILING = box(-3, 3, 0, 1), box(-3, 3, 6, 7)


def gate(left_end: object, right_end: object) -> list:
    """Two bars between floor and ceiling, at different heights so that they may overlap without touching."""
    return [FLOOR, CEILING, box(-20, left_end, 2, 3), box(right_end, 20, 4, 5)]


class TestGaps:
    @pytest.mark.parametrize("gap", [EPS, Q(1)], ids=["10^-60", "1"])
    def test_light_through_a_gap(self, gap: Fraction) -> None:
        shapes = [FLOOR, CEILING, box(-20, 0, 2, 3), box(gap, 20, 2, 3)]
        assert weight(shapes, 5) == 5

    def test_a_closed_gap_is_refused(self) -> None:
        with pytest.raises(InvalidScene):
            build([FLOOR, CEILING, box(-20, 0, 2, 3), box(0, 20, 2, 3)])

    def test_grazing_is_free_and_an_overlap_of_1e_60_is_not(self) -> None:
        assert weight(gate(0, EPS), 5) == 5
        assert weight(gate(0, 0), 5) == 5
        assert weight(gate(EPS, 0), 5) is None
        assert weight(gate(0, -EPS), 5) is None
        around = weight(gate(EPS, 0), 10)
        assert 5 < around < 5 + Q(1, 10**100)  # it leans by about 10^-60

    def test_the_leaning_chord_is_held_by_both_bars(self) -> None:
        """From (EPS, 3) to (0, 4): one unit up leans by EPS, five units by 5 EPS."""
        assert weight(gate(EPS, 0), 10) == 5 * Length(Real(1 + EPS * EPS).sqrt())

    @pytest.mark.parametrize(
        "middle", [box(-10, 0, 2, 3), Disc(Q(-1, 2), Q(5, 2), Q(1, 2))], ids=["box", "circle"]
    )
    def test_a_pinched_line(self, middle: object) -> None:
        """Three blockers on alternating sides leave the line x = 0 only."""
        targets = [box(Q(-1, 2), Q(1, 2), -2, -1), box(Q(-1, 2), Q(1, 2), 6, 7)]
        bars = [box(0, 10, 0, 1), box(0, 10, 4, 5)]
        graph = xa.visibility_graph(build([*targets, middle, *bars]), 7)
        assert graph.edges[0, 1]["weight"] == 7
        assert ends(graph, 0, 1) == {(0, -1), (0, 6)}
        pushed = Similarity(shift=(EPS, Q(0))).shape(middle)
        assert weight([*targets, pushed, *bars], 7) is None
        pulled = Similarity(shift=(-EPS, Q(0))).shape(middle)
        assert weight([*targets, pulled, *bars], 7) == 7

    def test_unit_squares_pinch_too(self) -> None:
        """The same with small squares: at R = 7 only upright chords are short enough."""
        targets = [box(Q(-1, 2), Q(1, 2), -2, -1), box(Q(-1, 2), Q(1, 2), 6, 7)]
        squares = [box(0, 1, 0, 1), box(-1, 0, 2, 3), box(0, 1, 4, 5)]
        graph = xa.visibility_graph(build(targets + squares), 7)
        assert graph.edges[0, 1]["weight"] == 7
        assert ends(graph, 0, 1) == {(0, -1), (0, 6)}
        squares[1] = box(-1, EPS, 2, 3)
        assert weight(targets + squares, 7) is None


HALF_RING = [(4, 0, 1), (-4, 0, 0), (-3, 0, -1), (3, 0, 0)]
WALLS = [[(Q(1, 10), 0), (20, -1), (20, 0)], [(0, Q(1, 10)), (0, 20), (-1, 20)]]
LADDER = [*WALLS, box(Q(1, 100), 1, Q(1, 100), 8)]


class TestBlockedPairs:
    def test_a_corner_far_from_one_of_the_two_holds_the_link(self) -> None:
        """It is 7 from one and 1 from the other, where R is 9: from (1, 1) over (8, 3/2) to (9, 11/7)."""
        one, other, wall = box(0, 1, 0, 1), box(9, 10, Q(6, 5), 3), box(8, Q(17, 2), -9, Q(3, 2))
        for shapes in ([one, other, wall], [other, one, wall]):
            assert weight(shapes, 9) == Real(3152).sqrt() / 7

    def test_a_ladder_over_a_corner(self) -> None:
        """The shortest ladder over a box (a, b) is (a^(2/3) + b^(2/3))^(3/2): here (1 + 4)^(3/2)."""
        graph = xa.visibility_graph(build(LADDER), 40)
        assert graph.edges[0, 1]["weight"] == 5 * root(5)
        assert ends(graph, 0, 1) == {(5, 0), (0, 10)}

    def test_a_ladder_of_cube_roots(self) -> None:
        found = weight([*WALLS, box(Q(1, 100), 1, Q(1, 100), 2)], 40)
        assert float(found) == pytest.approx((1 + 2 ** (2 / 3)) ** 1.5, rel=1e-15)
        low = cube_root(4 * 10**120)  # L^2 = (1 + 4^(1/3))^3
        least, most = (Q(low + k, 10**40) for k in (0, 1))
        lo, hi = (Q(int(end.p), int(end.q)) for end in found.enclosure(256))
        assert 0 <= hi - lo < Q(1, 2**250)
        assert lo**2 <= (1 + most) ** 3
        assert hi**2 >= (1 + least) ** 3

    def test_tangent_to_one_arc(self) -> None:
        graph = xa.visibility_graph(build([*WALLS, [(Q(1, 100), Q(1, 100)), (3, 1, 1), (1, 3)]]), 40)
        assert graph.edges[0, 1]["weight"] == 6 * root(2)
        assert ends(graph, 0, 1) == {(6, 0), (0, 6)}

    def test_held_by_two_corners(self) -> None:
        shapes = [box(-15, 15, -1, 0), box(-15, 15, 10, 11), box(-20, 1, 2, 3), box(-2, 20, 7, 8)]
        graph = xa.visibility_graph(build(shapes), 40)
        assert graph.edges[0, 1]["weight"] == Q(25, 2)
        assert ends(graph, 0, 1) == {(13 / 4, 0), (-17 / 4, 10)}

    def test_held_by_two_circles(self) -> None:
        """An inner common tangent of circles 10 apart with radii 3 and 3 leans by asin(6/10)."""
        walls = [box(-40, 40, -11, -10), box(-40, 40, 10, 11)]
        bars = [box(-50, Q(1, 2), Q(-89, 10), Q(-17, 2)), box(Q(-1, 2), 50, Q(17, 2), Q(89, 10))]
        graph = xa.visibility_graph(build([*walls, Disc(0, -5, 3), Disc(0, 5, 3), *bars]), 40)
        assert graph.edges[0, 1]["weight"] == 25
        assert ends(graph, 0, 1) == {(7.5, -10), (-7.5, 10)}

    def test_parallel_edges_with_a_window(self) -> None:
        """Upright chords of length 5 pass between two posts wherever they like."""
        posts = [box(-9, -1, 2, 3), box(1, 9, 2, 3)]
        graph = xa.visibility_graph(build([FLOOR, CEILING, *posts]), 5)
        assert graph.edges[0, 1]["weight"] == 5
        (x, _), (other, _) = ends(graph, 0, 1)
        assert x == other
        assert -1 <= x <= 1

    def test_concentric_arcs(self) -> None:
        ring = [(5, 0, 1), (-5, 0, 0), (-3, 0, -1), (3, 0, 0)]
        assert weight([Disc(0, 0, 1), ring], 2) == 2
        assert weight([Disc(0, 0, 1), ring], 2 - EPS) is None
        posts = [Disc(0, 2, Q(1, 2)), Disc(-2, 0, Q(1, 2)), Disc(2, 0, Q(1, 2))]
        graph = xa.visibility_graph(build([Disc(0, 0, 1), ring, *posts]), 9)
        assert graph.edges[0, 1]["weight"] == 2
        p, q = ends(graph, 0, 1)
        assert sorted([math.hypot(*p), math.hypot(*q)]) == pytest.approx([1, 3])
        assert abs(p[0] * q[1] - p[1] * q[0]) < 1e-12

    def test_the_least_of_concentric_segments(self) -> None:
        """It was sought among those at the ends of the arcs alone, here in the east."""
        scene = xa.Scene([xa.Circle((0, 0), 1)], enclosure=xa.Circle((0, 0), 3))
        data = xa.visibility_graph(scene, 9).edges[0, 1]
        assert (data["leave"], data["hit"]) == (xa.Point(-1, 0), xa.Point(-3, 0))

    @pytest.mark.parametrize(
        ("posts", "kinds"),
        [
            ([], ["family"]),
            ([(-2, 0, "1/2")], ["family"]),
            ([(2, "1/2", "1/2")], ["family"]),
            ([(2, "-1/2", "1/2")], ["family"]),
            ([(2, "-1/2", "1/2"), ("7/4", "1/4", "1/4")], ["chord", "family"]),
            ([(2, 0, "1/2"), (-2, 0, "1/2")], ["family", "family"]),
        ],
    )
    def test_what_is_free_between_concentric_circles(self, posts: list, kinds: list[str]) -> None:
        """Where the circles start a part was divided, and its end was told once more as a single segment."""
        shapes = [xa.Circle((0, 0), 1), *(xa.Circle((x, y), r) for x, y, r in posts)]
        graph = xa.visibility_graph(xa.Scene(shapes, enclosure=xa.Circle((0, 0), 3)), 9)
        shortest = graph.edges[0, len(shapes)]["link"].shortest
        assert sorted("chord" if isinstance(item, Chord) else "family" for item in shortest) == kinds

    def test_all_pairs_of_many_edges_are_in_no_array(self) -> None:
        """Of two boundaries of 20,000 edges one such array had 3 GB, and there were several."""
        combs = [[(x, 0), *((x + 1 + k % 2, k) for k in range(700)), (x, 700)] for x in (0, 20)]
        links = Links(xa.Scene(combs), 30)
        tracemalloc.start()
        found = links.between(0, 1)
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert found is not None and found.length == 18 and len(found.shortest) == 350
        assert most < 2**24

    def test_mirrored_chords_from_a_line_through_the_middle(self) -> None:
        """A rounded hole inside two half rings, all symmetric about the x-axis.

        The two shortest chords from the hole to the straight side of the outer ring end on a line through the
        centre of the inner ring, which holds them. They were not seen to be mirror images, and lengths of
        degree 12 could not be compared: `Undecided`.
        """
        hole = [(x, y, "0.4142") for x, y in (("0.75", 0), (0, "0.75"), ("-0.75", 0), (0, "-0.75"))]
        inner = [(0, "-1.5", 1), (0, "1.5", 1), (0, "1.25", -1), (0, "-1.25", 1)]
        outer = [(0, -2, 1), (0, 2), (0, "1.75", -1), (0, "-1.75")]
        scene = xa.Scene(map(xa.Outline, (hole, inner, outer)), start=("-3.5", 3))
        (p, q), (r, s) = xa.visibility_graph(scene, 5).edges[0, 2]["link"].segments()
        assert p.y > r.y
        assert [p, q] == [xa.Point(r.x, -r.y), xa.Point(s.x, -s.y)]
        assert xa.sightseer(scene, 5).complete

    def test_a_line_through_the_middle_is_told_by_its_direction(self) -> None:
        """The foot of the perpendicular is the centre for all such lines; only parallel ones are the same."""
        disc = xa.Arc(xa.Point(3, 0), xa.Point(3, 0), xa.Point(2, 0), 1, ccw=True, full=True)
        held = Turning((fmpq(0), fmpq(0)), (fmpq(1), fmpq(0)), fmpq(0), fmpq(1))

        def figure(x: int, y: int) -> congruent_chords._Figure:
            found = congruent_chords._figure(held, disc, xa.Segment(xa.Point(x, y), xa.Point(3 * x, 3 * y)))
            assert found is not None
            return found

        up = figure(0, 1)
        assert congruent_chords._isometry(up, figure(0, -2), False) is not None
        for other in (figure(1, 1), figure(-1, 1)):
            assert congruent_chords._isometry(up, other, False) is None

    def test_nothing_passes_a_long_wall(self) -> None:
        assert weight([Disc(-3, 0, 1), Disc(3, 0, 1), box(Q(-1, 2), Q(1, 2), -9, 9)], 9) is None

    def test_a_room_is_one_more_obstacle(self) -> None:
        graph = xa.visibility_graph(build([Disc(0, 0, 1), Room(box(-3, 4, -6, 7))], (Q(-2), Q(0))), 20)
        assert weights(graph) == {frozenset({0, 1}): 2, frozenset({"S", 0}): 1, frozenset({"S", 1}): 1}

    def test_a_start_on_a_boundary_touches(self) -> None:
        graph = xa.visibility_graph(build([box(0, 1, 0, 1), box(3, 4, 0, 1)], (1, Q(1, 2))), 20)
        assert graph.edges["S", 0]["weight"] == 0
        assert graph.edges["S", 1]["weight"] == 2

    @pytest.mark.parametrize("start", [(4, 0), (-4, 0), (3, 0), (0, 4), (0, 3), (Q(7, 2), 0)])
    def test_a_start_on_the_boundary_of_a_half_ring(self, start: tuple) -> None:
        """Corners, arcs and a straight edge: the link has no length."""
        graph = xa.visibility_graph(build([HALF_RING], start), 20)
        assert graph.edges["S", 0]["weight"] == 0

    @pytest.mark.parametrize("radius", [10 - EPS, Q(99, 10), 9, 5])
    def test_the_missing_half_of_an_arc_is_not_there(self, radius: Fraction) -> None:
        """From (-12, -6) the corner (-4, 0) is nearest; rays to the corners meet the arc's circle earlier."""
        scene = build([HALF_RING], (-12, -6))
        assert xa.visibility_graph(scene, 10).edges["S", 0]["weight"] == 10
        assert not xa.visibility_graph(scene, radius).has_edge("S", 0)

    def test_m4_registers_what_it_cannot_reach(self) -> None:
        """O3 is seen on the way from O1 to O2 but from neither boundary."""
        shapes = [
            [(0, 0), (-1, Q(1, 2)), (-1, Q(-1, 2))],
            [(10, 0), (11, Q(1, 2)), (11, Q(-1, 2))],
            [(5, Q(46, 5)), (6, 10), (4, 10)],
        ]
        graph = xa.visibility_graph(build(shapes), 10)
        assert weights(graph) == {frozenset({0, 1}): 10}


# Laws.


def turn_of_grid(key: frozenset, columns: int, turn: int) -> frozenset:
    """The pair of cells after one of the eight symmetries of a square grid."""
    out = []
    for cell in key:
        x, y = cell % columns, cell // columns
        if turn & 1:
            x = columns - 1 - x
        if turn & 2:
            y = columns - 1 - y
        if turn & 4:
            x, y = y, x
        out.append(columns * y + x)
    return frozenset(out)


class TestLaws:
    @pytest.mark.parametrize("name", SIMILARITIES)
    @LAW_EXAMPLES
    @given(terrains(columns=2))
    def test_similar_scenes_have_the_same_graph(self, name: str, terrain: Terrain) -> None:
        similarity = SIMILARITIES[name]
        before, after = weights(graph_of(terrain)), weights(graph_of(similarity.terrain(terrain)))
        assert after.keys() == before.keys()
        assert all(after[key] == value * similarity.scale for key, value in before.items())

    @LAW_EXAMPLES
    @given(terrains())
    def test_vertex_order_does_not_matter(self, terrain: Terrain) -> None:
        assert weights(graph_of(reversed_order(terrain))) == weights(graph_of(terrain))

    @LAW_EXAMPLES
    @given(terrains())
    def test_numbering_does_not_matter(self, terrain: Terrain) -> None:
        n = len(terrain.shapes)
        renamed = Terrain(tuple(reversed(terrain.shapes)), terrain.start, terrain.radius)
        before, after = weights(graph_of(terrain)), weights(graph_of(renamed))
        name = {"S": "S"} | {i: n - 1 - i for i in range(n)}
        assert {frozenset(name[i] for i in key): value for key, value in before.items()} == after

    @pytest.mark.parametrize("turn", ["1", "3/5"])
    @pytest.mark.parametrize("grid", [square_grid(3, 3), circle_grid(3, 3)], ids=["squares", "circles"])
    def test_grids_tie_by_symmetry(self, grid: list, turn: str) -> None:
        """All eight symmetries of the grid keep the weights, blocked pairs included, also when turned."""
        similarity = Similarity(turn=(Q(1), Q(0)) if turn == "1" else (Q(3, 5), Q(4, 5)))
        found = weights(xa.visibility_graph(build([similarity.shape(s) for s in grid]), 5))
        for k in range(1, 8):
            image = {turn_of_grid(key, 3, k): value for key, value in found.items()}
            assert image.keys() == found.keys()
            assert all(found[key] == value for key, value in image.items())

    def test_grid_weights(self) -> None:
        """Neighbours and diagonal neighbours only: 12 and 8 of them."""
        for grid, radius, diagonal in (
            (square_grid(3, 3), 2, root(2)),
            (circle_grid(3, 3), 3, 3 * root(2) - Length(2)),
        ):
            found = list(weights(xa.visibility_graph(build(grid), radius)).values())
            assert sum(value == 1 for value in found) == 12
            assert sum(value == diagonal for value in found) == 8
            assert len(found) == 20


def in_hull(place: np.ndarray, points: np.ndarray) -> bool:
    """Whether a place is an average of three of the points, to 1e-9."""
    for some in combinations(points, 3):
        a, b, c = some
        area = np.linalg.det(np.stack((b - a, c - a)))
        if abs(area) > 1e-9:
            u, v = np.linalg.solve(np.stack((b - a, c - a), axis=1), place - a)
            if u >= -1e-9 and v >= -1e-9 and u + v <= 1 + 1e-9:
                return True
    return False


def test_circles_beside_a_hull_are_told() -> None:
    rng = np.random.default_rng(4)
    beside = 0
    for _ in range(25 if NIGHTLY else 10):
        points = rng.integers(-5, 6, (6, 2)).astype(float)
        places, sizes = rng.integers(-9, 10, (20, 2)) / 2, rng.integers(0, 3, 20) / 2 + 1e-9
        for place, size, near in zip(places, sizes, near_hull(places, points, sizes), strict=True):
            turns = np.exp(1j * np.linspace(0, 2 * np.pi, 24))
            rim = place + (size - 2e-9) * np.stack((turns.real, turns.imag), axis=1)
            meets = in_hull(place, points) or any(in_hull(p, points) for p in rim)
            assert near or not meets
            beside += not near
    assert beside > (120 if NIGHTLY else 48)


@pytest.mark.parametrize("points", [[(2, 3)] * 8, [(0, 0)] * 4 + [(4, 4)] * 4])
def test_a_hull_without_an_inside(points: list[tuple[int, int]]) -> None:
    """All points are one, or on one line: what is on it is near."""
    hull = np.array(points, dtype=float)
    assert near_hull(hull, hull, np.full(len(hull), 1e-9)).all()
    aside = np.array([[9.0, 2.0]])
    assert near_hull(aside, hull, np.array([1.0]))[0] == (len(set(points)) == 1)


def test_features_are_made_once_for_a_table() -> None:
    table = EdgeTable(random_octagons(3, 1).obstacles)
    assert features(table) is features(table)
    assert features(EdgeTable(random_octagons(3, 1).obstacles)) is not features(table)


def test_a_wall_around_others_is_asked_for_the_near_ones_first() -> None:
    """A box around the wall would be around all posts; boxes around its edges tell which are far."""
    wall = xa.Polygon([(0, 0), (40, 0), (40, 10), (0, 10), (0, 9), (39, 9), (39, 1), (0, 1)])
    posts = [xa.Circle((x, 4 + Fraction(x, 40)), 1) for x in range(3, 37, 3)]
    links = Links(xa.Scene([wall, *posts], start=(-1, -1), radius=9), 9)
    bounds = links.lower_bounds(0, range(links.count))
    for k in range(1, links.count):
        link = links.between(0, k)
        assert link is not None and 0.9 * float(link.length) < bounds[k] <= float(link.length)


def halves(x: object, y: object, r: object, turn: int) -> xa.Outline:
    """A circle of two arcs, from its east or from its north."""
    at = [(x + r, y), (x, y + r), (x - r, y), (x, y - r)]
    return xa.Outline([(*at[turn], xa.Around((x, y))), (*at[turn + 2], xa.Around((x, y)))])


HALF = fmpq(1, 2)
UPPER = {
    "circle": xa.Circle((0, fmpq(5, 2)), HALF),
    "halves from the east": halves(fmpq(0), fmpq(5, 2), HALF, 0),
    "halves from the north": halves(fmpq(0), fmpq(5, 2), HALF, 1),
    "stadium": xa.Outline(
        [(HALF, fmpq(5, 2)), (HALF, 4), (-HALF, 4), (-HALF, fmpq(5, 2), xa.Around((0, fmpq(5, 2))))]
    ),
}
LOWER = {
    "circle": xa.Circle((0, 0), HALF),
    "halves": halves(fmpq(0), fmpq(0), HALF, 0),
    "diamond": xa.Polygon([(HALF, 0), (0, HALF), (-HALF, 0), (0, -HALF)]),
    "box": xa.Polygon([(HALF, 0), (HALF, -1), (-HALF, -1), (-HALF, 0)]),
}


@pytest.mark.parametrize("upper", UPPER)
@pytest.mark.parametrize("lower", LOWER)
def test_a_link_along_the_boundary_under_the_start(upper: str, lower: str) -> None:
    """One thing that the ray touches is enough: on one side of it lies the obstacle under the start."""
    start = (HALF, fmpq(5, 2))
    scene = xa.Scene([UPPER[upper], LOWER[lower]], start=start, radius=4)
    assert any(k == 1 for k, _ in xa.isovist(scene, start).seen())
    least = fmpq(5, 2)
    assert xa.visibility_graph(scene)["S"][1]["weight"] == least


@pytest.mark.parametrize(
    ("target", "length"),
    [
        (xa.Circle((0, -4), 1), 3),
        (xa.Polygon([(-2, -4), (-2, -5), (2, -5), (2, -4)]), 4),
        (xa.Polygon([(-2, -4), (-2, -5), (2, -5), (2, -4), (0, -4)]), 4),
    ],
    ids=["disc", "side", "divided side"],
)
def test_a_link_out_of_a_hollow_between_two_arcs(target: object, length: int) -> None:
    """One ray leads out of it, and meets nothing on its way."""
    hollow = xa.Outline([(0, 0, xa.Around((1, 0))), (1, -1), (1, 1), (-1, 1), (-1, -1, xa.Around((-1, 0)))])
    graph = xa.visibility_graph(xa.Scene([hollow, target], start=(0, 0), radius=9))
    assert {k: graph["S"][k]["weight"] for k in graph["S"]} == {0: 0, 1: length}
