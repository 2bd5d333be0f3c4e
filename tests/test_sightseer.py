"""The Sightseer Strategy: closed forms, tie rules on grids, the paper's lemmas and bounds, enclosures."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise, product
from random import Random

import mpmath
import networkx as nx
import pytest
from hypothesis import given
from nightly import examples, some
from oracles import Disc, reverse_loop, shortest_visible
from sampled_links import Tour, ambiguous, sightseer_order, visibility_weights
from strategies import (
    EPS,
    POLYGONS,
    SIMILARITIES,
    Similarity,
    Terrain,
    box,
    build,
    circle_grid,
    degenerate_terrains,
    random_terrain,
    reversed_order,
    square_grid,
    terrains,
)

import exactacq as xa
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real

Q = Fraction
SQUARES = [box(2, 4, -1, 1), box(7, 9, -1, 1)]
CIRCLES = [Disc(5, 0, 2), Disc(12, 0, 3)]


def explore(shapes: list, radius: object, start: tuple = (0, 0)) -> xa.Run:
    return xa.sightseer(build(shapes, start), radius)


def run_of(terrain: Terrain) -> xa.Run:
    return xa.sightseer(terrain.scene(), terrain.radius).sense()


def least(values: list) -> object:
    """`min` by the exact order alone."""
    best = values[0]
    for value in values[1:]:
        best = min(best, value)
    return best


def greatest(values: list) -> object:
    best = values[0]
    for value in values[1:]:
        best = max(best, value)
    return best


# What every run must be.


def check_run(run: xa.Run) -> None:
    """The path hangs together, follows the rules of the world and is accounted for."""
    perimeters = [obstacle.perimeter for obstacle in run.scene.obstacles]
    pieces = list(run.path)
    assert not pieces or pieces[0].start == run.start
    assert all(one.end == other.start for one, other in pairwise(pieces))
    assert run.length == Length.sum(piece.length for piece in pieces)
    for piece in pieces:
        assert piece.kind in ("straight", "boundary")
        assert (piece.obstacle is None) == (piece.kind == "straight")
        assert piece.start == piece.curve.start
        assert piece.end == piece.curve.end

    assert len(set(run.visits)) == len(run.visits)
    moves = [{(p.start.xy, p.end.xy): p.length} for p in pieces if p.kind == "straight"]
    for link in run.links:
        there, back = (link.leave.xy, link.hit.xy), (link.hit.xy, link.leave.xy)
        walked_as = [move[way] for move in moves for way in (there, back) if way in move]
        assert len(walked_as) == (link.traversals if link.length.sign() else 0)
        assert all(length == link.length for length in walked_as)
    assert len(moves) == sum(link.traversals for link in run.links if link.length.sign())
    walked = [
        Length.sum(p.length for p in pieces if p.kind == "boundary" and p.obstacle == i)
        for i in range(len(perimeters))
    ]
    for i, perimeter in enumerate(perimeters):
        assert walked[i] >= perimeter if i in run.visits else walked[i] == 0

    kinds = [event.kind for event in run.events]
    assert kinds[0] == "start"
    assert kinds[-1] == "stop"
    assert kinds.count("hit") == len(run.visits)
    assert [event.obstacle for event in run.events if event.kind == "hit"] == list(run.visits)
    assert all(one.at <= other.at for one, other in pairwise(run.events))
    assert run.events[0].at == 0
    assert run.events[-1].at == run.length


def check_lemmas(run: xa.Run) -> None:
    """Lemma 1, spanning tree, SS-6 corrected; in model (a) also Lemma 2, the stack and T1 corrected."""
    assert all(1 <= link.traversals <= 2 for link in run.links)
    tree = nx.Graph((link.source, link.target) for link in run.links)
    assert len(run.links) == len(run.visits)
    assert set(tree.nodes) == {"S", *run.visits} if run.visits else not run.links
    assert not run.visits or nx.is_tree(tree)
    assert [link.target for link in run.links] == list(run.visits)
    assert all(link.length <= run.radius for link in run.links)
    if not run.visits:
        return
    graph = xa.visibility_graph(run.scene, run.radius)
    component = nx.node_connected_component(graph, "S")
    assert component == {"S", *run.visits}
    for link in run.links:
        assert link.length == graph.edges[link.source, link.target]["weight"]

    n = len(run.visits)
    inner = tree.subgraph(run.visits)
    if n < 2 or not nx.is_connected(graph.subgraph(run.visits)) or not run.complete:
        return
    assert nx.is_connected(inner)
    arrivals = sum(link.traversals for link in run.links)
    assert arrivals <= 2 * (n - 1)
    depths = nx.single_source_shortest_path_length(tree, "S")
    assert max(depths.values()) - 1 <= n - 1
    assert run.length <= corrected_bound(run)
    bounds = [bound for bound in run.bounds if bound.value == corrected_bound(run)]
    assert bounds
    assert all(bound.holds for bound in bounds)
    for bound in run.bounds:
        assert bound.holds == (run.length <= bound.value)
        assert bound.ratio == pytest.approx(float(run.length) / float(bound.value))


def corrected_bound(run: xa.Run) -> Length:
    """S S1 + (2n-3) min(R, v_max) + 1.5 sum(p) - p_last/2 + (n-2) p_max/2, v_max over the tree edges."""
    perimeters = [run.scene.obstacles[i].perimeter for i in run.visits]
    n = len(perimeters)
    first, rest = run.links[0], run.links[1:]
    v_max = greatest([link.length for link in rest])
    reach = least([v_max, Length(run.radius)])
    return (
        first.length
        + reach * (2 * n - 3)
        + Length.sum(perimeters) * Q(3, 2)
        - perimeters[-1] * Q(1, 2)
        + greatest(perimeters) * Q(n - 2, 2)
    )


class TestByHand:
    def test_two_circles(self) -> None:
        run = explore(CIRCLES, 20)
        assert str(run.length) == "5 + 12*pi"
        assert run.length == Length(5) + Length.turns(6)
        assert tuple(run.visits) == (0, 1)
        assert run.complete
        check_run(run)
        check_lemmas(run)

    def test_two_squares(self) -> None:
        run = explore(SQUARES, 20)
        assert run.length == 24
        assert str(run.length) == "24"
        assert [link.length for link in run.links] == [Length(2), Length(3)]
        check_run(run)
        check_lemmas(run)

    def test_no_obstacle_in_range(self) -> None:
        run = explore(SQUARES, 2 - EPS)
        assert run.length == 0
        assert tuple(run.visits) == ()
        assert not run.complete
        assert set(run.unseen) == {0, 1}

    def test_the_range_decides_who_is_visited(self) -> None:
        assert tuple(explore(SQUARES, 3).visits) == (0, 1)
        run = explore(SQUARES, 3 - EPS)
        assert tuple(run.visits) == (0,)
        assert run.length == 10
        assert set(run.unseen) == {1}

    @pytest.mark.parametrize("shift, order", [(EPS, (0, 1)), (0, (0, 1)), (-EPS, (1, 0))])
    def test_a_shift_of_1e_60_swaps_the_order(self, shift: Fraction, order: tuple) -> None:
        """At shift 0 the two tie and the least index wins."""
        run = explore([box(2, 3, -1, 1), box(-3, -2 - shift, -1, 1)], 20)
        assert tuple(run.visits) == order
        circles = explore([Disc(3, 0, 1), Disc(-3 - shift, 0, 1)], 20)
        assert tuple(circles.visits) == order

    def test_a_start_on_a_boundary(self) -> None:
        run = explore(SQUARES, 20, (2, Q(1, 2)))
        assert tuple(run.visits) == (0, 1)
        assert run.links[0].length == 0
        assert run.length == 8 + Q(5, 2) + 3 + 8
        check_run(run)

    def test_a_quarter_turn_left_along_concentric_arcs(self) -> None:
        """From (0, -1) both ends of the half ring are a quarter away: counterclockwise, to (1, 0)."""
        ring = [(5, 0, 1), (-5, 0, 0), (-3, 0, -1), (3, 0, 0)]
        run = explore([Disc(0, 0, 1), ring], 20, (0, -1))
        assert run.links[1].leave == xa.Point(1, 0)
        assert run.links[1].hit == xa.Point(3, 0)
        assert run.length == Length(6) + Length.turns(Q(21, 4))
        check_run(run)

    def test_a_star_is_walked_there_and_back(self) -> None:
        shapes = [Disc(0, 0, 2), Disc(4, 0, 1), Disc(0, Q(9, 2), 1), Disc(-5, 0, 1)]
        run = explore(shapes, Q(5, 2), (0, -3))
        assert tuple(run.visits) == (0, 1, 2, 3)
        assert [link.traversals for link in run.links] == [1, 2, 2, 1]
        assert run.length == Length(8) + Length.turns(Q(13, 2))
        check_run(run)
        check_lemmas(run)

    def test_equal_ways_round_go_left(self) -> None:
        """Half way round a circle: counterclockwise, so the walk's first piece bends left."""
        run = explore(CIRCLES, 20)
        walk = [piece for piece in run.path if piece.kind == "boundary" and piece.obstacle == 0]
        assert all(piece.curve.ccw for piece in walk)


# The paper's scenes.


M4 = [
    [(0, 0), (-1, Q(1, 2)), (-1, Q(-1, 2))],
    [(10, 0), (11, Q(1, 2)), (11, Q(-1, 2))],
    [(5, Q(46, 5)), (6, 10), (4, 10)],
]


class TestClaims:
    def test_m4_a_registered_obstacle_stays_out_of_reach(self) -> None:
        """O3 is seen from (5, 0) between O1 and O2, so the robot goes back to S before it gives up."""
        run = explore(M4, 10, (-1, 0))
        assert tuple(run.visits) == (0, 1)
        assert [link.traversals for link in run.links] == [2, 2]
        assert run.path[-1].end == run.start
        assert run.length == 23 + 3 * Length(Real(5).sqrt())
        assert not run.complete
        assert tuple(run.unseen) == ()
        check_run(run)

    def test_m4_reports_what_stays_incomplete(self) -> None:
        assert tuple(explore(M4, 10, (-1, 0)).incomplete) == (2,)

    def test_m8_a_tree_edge_longer_than_d_max(self) -> None:
        shapes = [box(-1, 6, 2, 3), box(0, 10, 0, 1), [(0, Q(9, 2)), (10, Q(29, 2)), (0, Q(29, 2))]]
        run = explore(shapes, 20, (0, 2))
        assert tuple(run.visits) == (0, 1, 2)
        edge = run.links[2]
        assert (edge.source, edge.target) == (1, 2)
        assert edge.length > Q(7, 2)  # d_max, between O1 and O2
        assert float(edge.length) == pytest.approx(shortest_visible(shapes, 1, 2, 20).length, abs=1e-9)
        assert float(edge.length) == pytest.approx(7.80, abs=0.005)
        check_run(run)
        check_lemmas(run)

    def test_m9_breaks_bound_1_and_keeps_the_corrected_one(self) -> None:
        run = explore(m9_shapes(), 200, (Q(1, 2), Q(1, 100)))
        assert float(run.length) == pytest.approx(2248.735, abs=5e-4)
        assert sorted(run.visits) == list(range(12))
        assert run.visits[:2] == (1, 0)
        broken = [bound for bound in run.bounds if abs(float(bound.value) - 1625.7) < 0.1]
        assert broken
        assert not any(bound.holds for bound in broken)
        check_run(run)
        check_lemmas(run)

    def test_m11_a_known_obstacle_is_still_visited(self) -> None:
        """O2 is seen all round from O1, yet only its visit shows O3; 9.8 = the gap between O2 and O3."""
        outer = [(-11, -11), (2, -11), (2, -9), (-9, -9), (-9, 9), (2, 9), (2, 11), (-11, 11)]
        shapes = [outer, box(-1, 1, -1, 1), box(Q(54, 5), 12, Q(-1, 2), Q(1, 2))]
        run = explore(shapes, 10, (-9, 0))
        assert tuple(run.visits) == (0, 1, 2)
        assert [link.length for link in run.links] == [Length(0), Length(8), Length(Q(49, 5))]
        assert run.links[2].leave == xa.Point(1, Q(-1, 2))  # both ways are 3.5: counterclockwise
        assert run.length == Q(1257, 10)
        check_run(run)
        check_lemmas(run)


def m9_shapes() -> list:
    feet = [Q(9, 2) + Q(k, 10) for k in range(10)]
    comb = [(-1, Q(1, 100)), (1, Q(1, 100))]
    for y in feet:
        comb += [(1, y), (0, y), (0, y + Q(1, 25)), (1, y + Q(1, 25))]
    comb += [(1, 9), (-1, 9)]
    hook = [(0, -1), (100, -1), (100, 10), (99, 10), (99, 0), (0, 0)]
    leaves = [box(Q(2, 100), Q(3, 100), y + Q(15, 1000), y + Q(25, 1000)) for y in feet]
    return [hook, comb, *leaves]


# Grids, where everything ties: a reference of a few lines, with positions on a boundary as exact numbers.


@dataclass(frozen=True)
class Tie:
    """One link of a grid cell: what orders it, the target, where it may leave, and where it then hits."""

    rank: Fraction
    target: int
    low: Fraction
    high: Fraction
    hit: Callable[[Fraction], Fraction]


def reference_tour(
    first: tuple[int, Fraction], ties: dict[int, list[Tie]], perimeter: Fraction
) -> tuple[list[int], list[Fraction], Fraction]:
    """Visits, ranks of the links walked (each traversal), and the length walked on boundaries."""
    curr, here = first
    visits, ranks, walked = [curr], [], perimeter
    stack: list[tuple[int, Fraction, Fraction, Fraction]] = []
    while len(visits) < len(ties):
        open_ = [tie for tie in ties[curr] if tie.target not in visits]
        if open_:
            tie = min(open_, key=lambda tie: (tie.rank, tie.target))
            ahead, back = (tie.low - here) % perimeter, (here - tie.high) % perimeter
            if (here - tie.low) % perimeter <= tie.high - tie.low:
                leave, way = here, Fraction(0)
            elif ahead <= back:
                leave, way = tie.low, ahead
            else:
                leave, way = tie.high, back
            hit = tie.hit(leave) % perimeter
            stack.append((curr, leave % perimeter, hit, tie.rank))
            curr, here = tie.target, hit
            visits.append(curr)
            walked += way + perimeter
            ranks.append(tie.rank)
        else:
            previous, leave, hit, rank = stack.pop()
            gap = (hit - here) % perimeter
            walked += min(gap, perimeter - gap)
            ranks.append(rank)
            curr, here = previous, leave
    return visits, ranks, walked


def square_ties(columns: int, rows: int, name: list[int], *, diagonals: bool) -> dict[int, list[Tie]]:
    """Unit squares of pitch 2; positions run counterclockwise from the lower left; ranks are v^2."""
    ties: dict[int, list[Tie]] = {}
    faces = {(0, -1): 0, (1, 0): 1, (0, 1): 2, (-1, 0): 3}
    corners = {(-1, -1): 0, (1, -1): 1, (1, 1): 2, (-1, 1): 3}
    for y in range(rows):
        for x in range(columns):
            out = ties.setdefault(name[columns * y + x], [])
            for dx in (-1, 0, 1):
                for dy in (-1, 0, 1):
                    if not (0 <= x + dx < columns and 0 <= y + dy < rows):
                        continue
                    target = name[columns * (y + dy) + x + dx]
                    if (dx, dy) in faces:
                        side = faces[dx, dy]
                        turn = 2 * side + 3  # the mirror image of s on the facing edge
                        out.append(Tie(Q(1), target, Q(side), Q(side + 1), lambda s, k=turn: k - s))
                    elif diagonals and (dx, dy) in corners:
                        corner = Q(corners[dx, dy])
                        out.append(Tie(Q(2), target, corner, corner, lambda s: s + 2))
    return ties


def circle_ties(columns: int, rows: int, name: list[int], *, diagonals: bool) -> dict[int, list[Tie]]:
    """Unit circles of pitch 3; positions are eighths of a turn; ranks are squared centre distances."""
    ties: dict[int, list[Tie]] = {}
    compass = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)]
    for y in range(rows):
        for x in range(columns):
            out = ties.setdefault(name[columns * y + x], [])
            for eighth, (dx, dy) in enumerate(compass):
                near = dx == 0 or dy == 0
                if (near or diagonals) and 0 <= x + dx < columns and 0 <= y + dy < rows:
                    target = name[columns * (y + dy) + x + dx]
                    spot = Q(eighth)
                    out.append(Tie(Q(9) if near else Q(18), target, spot, spot, lambda s: s + 4))
    return ties


def shuffled(count: int, seed: int) -> list[int]:
    """The index of each cell; seed 0 keeps the order."""
    name = list(range(count))
    if seed:
        Random(seed).shuffle(name)
    return name


TURNS = {"upright": Similarity(), "turned": Similarity(turn=(Q(3, 5), Q(4, 5)), shift=(Q(1, 3), Q(-2, 7)))}
GRIDS = some(product(TURNS, range(4), (False, True)), 5)
"""How a grid is turned, a seed of its numbering, and whether R reaches its diagonals."""


class TestGrids:
    @pytest.mark.parametrize(("turn", "seed", "diagonals"), GRIDS)
    def test_squares(self, turn: str, seed: int, *, diagonals: bool) -> None:
        """S in the middle of four squares; R is the gap itself, or reaches the diagonal neighbours too."""
        columns, rows = 4, 3
        name = shuffled(columns * rows, seed)
        around = {0: Q(2), 1: Q(3), columns: Q(1), columns + 1: Q(0)}  # cell: its corner towards S
        cell = min(around, key=lambda c: name[c])
        visits, ranks, walked = reference_tour(
            (name[cell], around[cell]), square_ties(columns, rows, name, diagonals=diagonals), Q(4)
        )
        expected = Length(walked) + Length(Real(2).sqrt()) / 2
        for rank in ranks:
            expected = expected + Length(Real(rank).sqrt())

        run = self.run(square_grid(columns, rows), name, turn, (Q(3, 2), Q(3, 2)), 1 + Q(diagonals, 2))
        assert list(run.visits) == visits
        assert run.length == expected
        check_run(run)

    @pytest.mark.parametrize(("turn", "seed", "diagonals"), GRIDS)
    def test_circles(self, turn: str, seed: int, *, diagonals: bool) -> None:
        """S half way between the first two circles; gaps are 1 and 3 sqrt(2) - 2."""
        columns, rows = 4, 3
        name = shuffled(columns * rows, seed)
        first = (name[0], Q(0)) if name[0] < name[1] else (name[1], Q(4))
        visits, ranks, walked = reference_tour(
            first, circle_ties(columns, rows, name, diagonals=diagonals), Q(8)
        )
        expected = Length.turns(walked / 8) + Length(Q(1, 2))
        for rank in ranks:
            expected = expected + Length(Real(rank).sqrt()) - Length(2)

        radius = Q(9, 4) if diagonals else 1
        run = self.run(circle_grid(columns, rows), name, turn, (Q(3, 2), Q(0)), radius)
        assert list(run.visits) == visits
        assert run.length == expected
        check_run(run)

    @staticmethod
    def run(grid: list, name: list[int], turn: str, start: tuple, radius: object) -> xa.Run:
        similarity = TURNS[turn]
        shapes: list = [None] * len(grid)
        for cell, shape in enumerate(grid):
            image = similarity.shape(shape)
            if not isinstance(image, Disc) and name[cell] % 2:
                image = reverse_loop([(*v, 0) for v in image])  # expressions arise in another order
                image = [v[:2] for v in image]
            shapes[name[cell]] = image
        return explore(shapes, radius, similarity.point(start))


# Random scenes.


def is_generic(terrain: Terrain, tour: Tour) -> bool:
    """Whether floats can be trusted with every decision of the tour."""
    n = len(terrain.shapes)
    pairs = [(i, j) for i in range(n) for j in range(i + 1, n)] + [("S", j) for j in range(n)]
    sources = {"S": terrain.start}
    if any(ambiguous(terrain.shapes, sources.get(i, i), j, terrain.radius) for i, j in pairs):
        return False
    weights = sorted(c.length for c in visibility_weights(terrain.shapes, terrain.radius).values())
    return bool(tour.visits) and all(b - a > 1e-9 for a, b in pairwise(weights))


class TestRandomScenes:
    @pytest.mark.parametrize("seed", some(range(8), 3))
    def test_agrees_with_the_float_simulation(self, seed: int) -> None:
        terrain = random_terrain(Random(seed))
        weights = visibility_weights(terrain.shapes, terrain.radius, terrain.start)
        tour = sightseer_order(terrain.shapes, weights)
        if not is_generic(terrain, tour):
            pytest.skip("a tie")
        run = run_of(terrain)
        assert tuple(run.visits) == tour.visits
        assert [(link.source, link.target) for link in run.links] == [
            (e.source, e.target) for e in tour.edges
        ]
        for link, edge in zip(run.links, tour.edges, strict=True):
            assert float(link.length) == pytest.approx(edge.chord.length, abs=1e-9)
            assert link.leave.xy == pytest.approx(edge.chord.start, abs=1e-5)
            assert link.hit.xy == pytest.approx(edge.chord.end, abs=1e-5)
        if len(tour.visits) == len(terrain.shapes):
            assert [link.traversals for link in run.links] == [edge.traversals for edge in tour.edges]
            assert float(run.length) == pytest.approx(tour.length, abs=1e-5)
        check_run(run)
        check_lemmas(run)

    @examples(5, 400)
    @given(terrains())
    def test_lemmas(self, terrain: Terrain) -> None:
        run = run_of(terrain)
        check_run(run)
        check_lemmas(run)

    @pytest.mark.parametrize("seed", [533, 548, 1038])
    def test_points_known_to_lie_on_an_arc_need_no_proof(self, seed: int) -> None:
        """Ends of cubic chords on arcs with long coordinates: proving that they lie there is `Undecided`."""
        run = run_of(random_terrain(Random(seed)))
        check_run(run)
        check_lemmas(run)

    @given(terrains(room=True))
    @examples(2, 40)
    def test_lemmas_in_a_room(self, terrain: Terrain) -> None:
        run = run_of(terrain)
        check_run(run)
        check_lemmas(run)

    @examples(8, 400)
    @given(degenerate_terrains())
    def test_lemmas_with_ties(self, terrain: Terrain) -> None:
        run = run_of(terrain)
        check_run(run)
        check_lemmas(run)

    @pytest.mark.parametrize(("name", "seed"), some(product([*SIMILARITIES, "reversed"], (2, 11)), 5))
    def test_similar_scenes_have_similar_runs(self, name: str, seed: int) -> None:
        """A mirror swaps left and right, so it is tested where nothing ties."""
        terrain = random_terrain(
            Random(seed), POLYGONS if seed == 2 else (*POLYGONS, lambda rng: Disc(0, 0, 1))
        )
        similarity = SIMILARITIES.get(name, Similarity())
        image = reversed_order(terrain) if name == "reversed" else similarity.terrain(terrain)
        before, after = run_of(terrain), run_of(image)
        assert after.visits == before.visits
        assert after.length == before.length * similarity.scale
        for one, other in zip(before.links, after.links, strict=True):
            assert other.length == one.length * similarity.scale
            assert other.traversals == one.traversals


# Certified numbers.


def mp(x: object) -> mpmath.mpf:
    """A Real (or a rational) at mpmath's precision."""
    if hasattr(x, "enclosure"):
        low, high = x.enclosure(mpmath.mp.prec + 64)
        x = (low + high) / 2
    return mpmath.mpf(int(x.p)) / int(x.q)


def mp_length(curve: object) -> mpmath.mpf:
    """The length of a segment or arc from its end points, by mpmath alone."""
    (ax, ay), (bx, by) = ((mp(p.x), mp(p.y)) for p in (curve.start, curve.end))
    if not hasattr(curve, "center"):
        return mpmath.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
    cx, cy, squared = (mp(v) for v in (*curve.center, curve.radius_sq))
    turn = mpmath.atan2(by - cy, bx - cx) - mpmath.atan2(ay - cy, ax - cx)
    if not curve.ccw:
        turn = -turn
    if curve.start == curve.end:
        turn = 2 * mpmath.pi
    elif turn < 0:
        turn += 2 * mpmath.pi
    return mpmath.sqrt(squared) * turn


class TestEnclosures:
    @pytest.mark.parametrize(
        "terrain",
        [
            Terrain(tuple(CIRCLES), (Q(0), Q(0)), Q(20)),
            Terrain(tuple(circle_grid(3, 2)), (Q(3, 2), Q(3, 2)), Q(4)),
            random_terrain(Random(3)),
            random_terrain(Random(7), room=True),
        ],
        ids=["two circles", "a grid", "random", "in a room"],
    )
    def test_4096_bits(self, terrain: Terrain) -> None:
        run = run_of(terrain)
        low, high = run.length.enclosure(4096)
        low, high = Q(int(low.p), int(low.q)), Q(int(high.p), int(high.q))
        assert 0 <= high - low < Q(1, 2**4000)
        with mpmath.workprec(4400):
            value = mpmath.fsum(mp_length(piece.curve) for piece in run.path)
            rounding = mpmath.mpf(2) ** -4300
            assert mpmath.mpf(low.numerator) / low.denominator <= value + rounding
            assert value - rounding <= mpmath.mpf(high.numerator) / high.denominator
            assert float(value) == float(run.length)
        assert float(low) == float(high) == float(run.length)

    def test_decimals(self) -> None:
        run = explore(CIRCLES, 20)
        with mpmath.workdps(80):
            digits = mpmath.nstr(5 + 12 * mpmath.pi, 60)
        assert str(run.length.decimal(50)).startswith(digits[:48])
        assert float(run.length) == 5 + 12 * math.pi
