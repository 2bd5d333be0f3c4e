"""Shortest paths: closed forms, degenerate scenes, laws, and peers that share no code with the search."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise
from random import Random

import networkx as nx
import pytest
from brute_paths import shortest_length
from drawn_scenes import terrains as drawn_terrains
from flint import arb
from hypothesis import given
from hypothesis import strategies as st
from strategies import (
    FREE_CUSPS,
    POLYGONS,
    ROUNDED_U,
    SIMILARITIES,
    SPIKES,
    STADIUM,
    Similarity,
    Terrain,
    arcs_of_circle,
    box,
    build,
    circle_grid,
    degenerate_terrain,
    random_terrain,
    split_point,
    square_grid,
)

import exactacq as xa
from exactacq import kernel
from exactacq.geometry.points import Location
from exactacq.visibility import tangents
from exactacq.visibility.free_segment import is_free_among
from exactacq.visibility.pegs import Peg, Pegs
from exactacq.visibility.shortest_path import _Equals
from exactacq.visibility.taut_search import Label, TautWay

Q = Fraction
HALF = Q(1, 2)


def found(scene: object, a: object, b: object) -> xa.ShortestPath:
    """A shortest path whose pieces join, add up, and turn at no point that could be left out."""
    path = xa.shortest_path(scene, a, b)
    assert path is not None
    assert path.points[-1] == path.end == xa.Point.of(b)
    assert all(one.end == other.start for one, other in pairwise(path.path))
    assert path.length == xa.Length.sum(piece.length for piece in path.path)
    return path


def kinds(path: xa.ShortestPath) -> str:
    return "".join("-" if isinstance(piece, xa.Segment) else "(" if piece.ccw else ")" for piece in path.path)


def places(rng: Random, scene: xa.Scene, count: int) -> list[xa.Point]:
    """Free points: on a grid, at vertices, and within edges."""
    edges = [edge for obstacle in scene.obstacles for edge in obstacle.edges]
    points: list[xa.Point] = []
    for _ in range(200):
        way = rng.random()
        if way < 0.4:
            point = xa.Point(Q(rng.randint(-8, 60), 4), Q(rng.randint(-8, 40), 4))
        else:
            point = rng.choice(edges).start if way < 0.7 else rng.choice(edges).point(Q(rng.randint(1, 7), 8))
        if all(o.locate(point) is not Location.INSIDE for o in scene.obstacles) and point not in points:
            points.append(point)
        if len(points) == count:
            break
    return points


# -- closed forms ----------------------------------------------------------------------------------


def test_around_a_circle() -> None:
    path = found(xa.Scene([xa.Circle((0, 0), 3)]), (-5, 0), (5, 0))
    angle = xa.Length.turns(3, HALF) - 2 * xa.Length.arc(3, "3/5", "4/5")
    assert path.length == 8 + angle and path.count == 2 and kinds(path) == "-(-"
    assert path.points[1] == xa.Point("-9/5", "-12/5")


@pytest.mark.parametrize(
    ("goal", "length", "form"),
    [
        ((10, 2), xa.Length(10), "-"),
        (
            (10, -2),
            xa.Length(2 * xa.Real(21).sqrt()) + 4 * xa.Length.arc(1, xa.Real(21).sqrt() / 5, "2/5"),
            ")-(",
        ),
    ],
    ids=["on one side", "across"],
)
def test_between_two_circles(goal: object, length: xa.Length, form: str) -> None:
    """From the top of one to the top and the bottom of the other, five radii away."""
    path = found(xa.Scene([xa.Circle((0, 0), 2), xa.Circle((10, 0), 2)]), (0, 2), goal)
    assert path.length == length and kinds(path) == form and path.count == 1


def test_along_a_belt_about_unequal_circles() -> None:
    scene = xa.Scene([xa.Circle((0, 0), 3), xa.Circle(("4.5", 0), 1)])
    path = found(scene, (-3, 0), ("5.5", 0))
    straight = (xa.Real("4.5") ** 2 - 4).sqrt()
    angle = xa.Length.arc(1, xa.Real(2) / xa.Real("4.5"), straight / xa.Real("4.5"))
    assert path.count == 2 and kinds(path) == "(-("
    assert path.length == straight + xa.Length.turns(3, HALF) - 2 * angle


def test_around_a_square() -> None:
    path = found(xa.Scene([box(0, 2, 0, 2)]), (-1, 1), (3, 1))
    assert path.length == 2 + 2 * xa.Real(2).sqrt() and path.count == 2
    assert path.points[1:3] == (xa.Point(0, 0), xa.Point(2, 0))


def test_start_and_end_are_one() -> None:
    path = xa.shortest_path(xa.Scene([]), (1, 2), (1, 2))
    assert path.path == () and path.length == 0 and path.count == 1 and path.points == (xa.Point(1, 2),)


# -- degenerate scenes -----------------------------------------------------------------------------


def test_a_line_that_grazes_everything_is_one_piece() -> None:
    """Corners on both sides, an edge and a circle: free space is closed."""
    shapes = [box(0, 1, -1, 0), [(2, 0), (3, 1), (1, 1)], xa.Circle((5, -1), 1), box(7, 8, 0, 2)]
    path = found(xa.Scene(shapes), (-1, 0), (9, 0))
    assert path.length == 10 and kinds(path) == "-" and path.count == 1


def test_a_long_row_costs_little_for_each_pair(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether a line along a row is free of all of it was decided before a corner on its way was noticed."""
    lengths: list[int] = []

    def counted(table: object, start: xa.Point, end: xa.Point, edges: list[int]) -> bool:
        lengths.append(len(edges))
        return is_free_among(table, start, end, edges)

    monkeypatch.setattr(tangents, "is_free_among", counted)
    path = found(build(square_grid(12, 1)), (-1, 1), (24, 1))
    assert path.length == 25 and kinds(path) == "-" and max(lengths) < 12


def test_thousands_of_ways_on_one_line() -> None:
    """They were joined by recursion, which ended a path past 250 squares in a row with an error."""
    labels = [Label(0, xa.Point(0, 0), -1, [], arb(0))]
    for k in range(3000):
        piece = xa.Segment((k, 0), (k + 1, 0))
        ways = [TautWay(labels[-1], ((piece, piece.length),))]
        labels.append(Label(k + 1, piece.end, k, ways, arb(k + 1)))
    assert list(_Equals(labels[-1]).chosen()) == [xa.Segment((0, 0), (3000, 0))]


def test_equally_short_paths_are_counted() -> None:
    """Of both sides of a row the one with the lower points is taken."""
    row = [[(4 * k + 1, 0), (4 * k + 2, -1), (4 * k + 3, 0), (4 * k + 2, 1)] for k in range(4)]
    path = found(xa.Scene(row), (0, 0), (16, 0))
    assert path.length == 12 + 2 * xa.Real(5).sqrt() and path.count == 2
    assert path.points[1:3] == (xa.Point(2, -1), xa.Point(14, -1))
    assert found(xa.Scene(row), (0, 0), (16, Q(1, 10**30))).count == 1
    assert found(build(circle_grid(4, 1, 1, 4)), (-2, 0), (14, 0)).count == 2


def test_one_path_turns_where_another_goes_straight_on() -> None:
    """The one that turns has its point first; it does not go on with the other from there."""
    shapes = [[(2, 0), ("21/10", 3), ("19/10", 3)], [(3, 0), ("17/5", "7/10"), (3, 1), ("29/10", "4/5")]]
    path = found(xa.Scene(shapes), (1, 0), (4, 1))
    assert (path.length, path.count) == (2 + xa.Real(2).sqrt(), 2)
    assert path.points[1:-1] == (xa.Point(2, 0), xa.Point(3, 1))


def test_halves_of_a_circle_are_equal() -> None:
    path = found(xa.Scene([xa.Circle((0, 0), 1)]), (0, 1), (0, -1))
    assert path.length == xa.Length.turns(1, HALF) and path.count == 2 and kinds(path) == "("


@pytest.mark.parametrize(
    ("a", "b", "form"), [((0, 1), (1, 0), ")"), ((1, 0), (0, 1), "("), ((0, 1), (-3, 1), "-")]
)
def test_on_one_arc(a: object, b: object, form: str) -> None:
    for shape in (xa.Circle((0, 0), 1), xa.Outline(arcs_of_circle((Q(0), Q(0)), Q(1), Q(1, 3)))):
        assert kinds(found(xa.Scene([shape]), a, b)) == form


@pytest.mark.parametrize("bulge", [Q(1, 3), Q(1), Q(2)])
def test_a_circle_in_parts_is_a_circle(bulge: Fraction) -> None:
    other = xa.Circle((4, 0), 1)
    whole = xa.Scene([xa.Circle((0, 0), 2), other])
    parts = xa.Scene([xa.Outline(arcs_of_circle((Q(0), Q(0)), Q(2), bulge)), other])
    ends = [(-3, 0), (0, 2), (-2, 0), (2, 0), (3, 0), (6, -1), (-1, -5)]
    for a in ends:
        for b in ends[: ends.index(a)]:
            one, two = found(whole, a, b), found(parts, a, b)
            assert (one.length, one.count, one.points) == (two.length, two.count, two.points)


def test_smooth_joints() -> None:
    """Around a stadium: half circles joined to straight edges."""
    scene = xa.Scene([xa.Outline(STADIUM)])
    path = found(scene, (-3, 0), (3, 0))
    assert path.length == 4 + xa.Length.turns(1, HALF) and kinds(path) == "(-(" and path.count == 2
    assert kinds(found(scene, (0, -1), (3, 0))) == "-("
    assert kinds(found(scene, (0, -1), (5, -1))) == "-"


@pytest.mark.parametrize("shape", [*SPIKES, *FREE_CUSPS, ROUNDED_U], ids=lambda shape: str(len(shape)))
def test_cusps_and_hollows(shape: list) -> None:
    scene = xa.Scene([xa.Outline(shape)])
    rng = Random(1)
    for a, b in pairwise(places(rng, scene, 14)):
        assert float(found(scene, a, b).length) == pytest.approx(
            shortest_length([shape], a.xy, b.xy), abs=1e-6
        )


def test_through_a_gap_of_a_hair() -> None:
    hair = Q(1, 10**60)
    walls = [box(0, 1, -9, 0), box(0, 1, hair, 9)]
    path = found(xa.Scene(walls), (-3, 0), (4, 0))
    assert path.length == 7 and path.count == 1
    assert found(xa.Scene(walls), (-3, hair), (4, 0)).length > 7


def test_irrational_points() -> None:
    root = xa.Real(2).sqrt()
    scene = xa.Scene([xa.Circle((0, 0), 2)])
    on_circle = xa.Point(root, root)
    assert found(scene, on_circle, (0, 2)).length == xa.Length.turns(2, Q(1, 8))
    assert found(scene, xa.Point(-2 * root, 0), xa.Point(0, 2 * root)).length == 4 - xa.Length(0)


# -- terrains and refusals -------------------------------------------------------------------------


def test_the_border_is_a_wall() -> None:
    """A bar that leaves one way around within the border, though the other is shorter."""
    bar = box(4, 5, -1, 6)
    free, walled = xa.Scene([bar]), xa.Scene([bar], terrain=xa.Terrain(9, 9))
    assert found(free, (0, 0), (9, 0)).points[1] == xa.Point(4, -1)
    assert found(walled, (0, 0), (9, 0)).points[1:3] == (xa.Point(4, 6), xa.Point(5, 6))


def test_a_terrain_that_is_cut_in_two() -> None:
    scene = xa.Scene([box(4, 5, -1, 10)], terrain=xa.Terrain(9, 9))
    assert xa.shortest_path(scene, (0, 0), (9, 0)) is None
    assert (
        xa.shortest_path(xa.Scene([xa.Circle((4, 4), 5)], terrain=xa.Terrain(8, 8)), (0, 0), (8, 8)) is None
    )


def test_an_obstacle_that_touches_the_border_leaves_a_way() -> None:
    """Free space is closed: the point of contact belongs to it."""
    scene = xa.Scene([xa.Circle((4, 4), 4)], terrain=xa.Terrain(8, 8))
    path = found(scene, (0, 0), (8, 0))
    assert path.length == 8 and kinds(path) == "-"
    assert found(scene, (0, 0), (8, 8)).length == 8 + xa.Length.turns(4, Q(1, 4))


def test_arcs_end_at_the_border() -> None:
    """The circle sticks out below: the way from its west to its east leads over its top."""
    scene = xa.Scene([xa.Circle((5, 1), 2)], terrain=xa.Terrain(10, 9))
    below, above = xa.Scene([xa.Circle((5, 1), 2)]), found(scene, (0, 0), (10, 0))
    assert above.length > found(below, (0, 0), (10, 0)).length
    assert above.points[1].y > 1


def test_refusals() -> None:
    scene = xa.Scene([xa.Circle((0, 0), 1)], terrain=xa.Terrain(9, 9))
    for a, b, words in (
        ((0, "1/2"), (5, 5), r"start: the point \(0, 0\.5\) lies inside obstacle O1"),
        ((5, 5), (10, 0), "end: the point .* outside the terrain"),
    ):
        with pytest.raises(xa.InvalidScene, match=words):
            xa.shortest_path(scene, a, b)
    with pytest.raises(xa.FormatError, match="start: a point needs two numbers"):
        xa.shortest_path(scene, (1, 2, 3), (5, 5))
    room = xa.Scene([], enclosure=box(0, 9, 0, 9))
    with pytest.raises(xa.InvalidScene, match=r"end: the point \(10, 1\) lies outside the wall"):
        xa.shortest_path(room, (1, 1), (10, 1))
    with pytest.raises(xa.InvalidScene, match="point 1: "):
        xa.tangent_graph(room, [(1, 1), (10, 1)])
    # Its nearest float was asked for, and there is none: an OverflowError.
    with pytest.raises(xa.InvalidScene, match=r"end: it must not lie farther than 10\^100"):
        xa.shortest_path(xa.Scene([]), (1, 1), (10**400, 1))


# -- laws ------------------------------------------------------------------------------------------

TERRAINS: tuple[Callable[[Random], Terrain], ...] = (
    random_terrain,
    lambda rng: random_terrain(rng, room=True),
    degenerate_terrain,
)


def drawn(seed: int) -> tuple[Random, Terrain]:
    rng = Random(seed)
    return rng, TERRAINS[seed % len(TERRAINS)](rng)


@pytest.mark.parametrize("seed", range(18))
def test_brute_force_finds_the_same(seed: int) -> None:
    rng, terrain = drawn(seed)
    scene = terrain.scene()
    for a, b in pairwise(places(rng, scene, 5)):
        assert float(found(scene, a, b).length) == pytest.approx(
            shortest_length(terrain.shapes, a.xy, b.xy), abs=1e-6
        )


@given(drawn_terrains(moved=False), st.integers(0, 99))
def test_brute_force_finds_the_same_among_drawn_scenes(terrain: Terrain, seed: int) -> None:
    """Where obstacles are thin it takes ways through them."""
    scene = terrain.scene()
    is_sturdy = all(float(edge.length) > 1e-3 for o in scene.obstacles for edge in o.edges)
    for a, b in pairwise(places(Random(seed), scene, 3)):
        brute, exact = shortest_length(terrain.shapes, a.xy, b.xy), float(found(scene, a, b).length)
        assert exact >= brute * (1 - 1e-6) - 1e-6
        assert exact == pytest.approx(brute, rel=1e-6, abs=1e-6) or not is_sturdy


@pytest.mark.parametrize("seed", range(3, 9))
def test_distances_are_those_of_the_graph_and_make_a_metric(seed: int) -> None:
    rng, terrain = drawn(seed)
    scene = terrain.scene()
    points = places(rng, scene, 4)
    graph = xa.tangent_graph(scene, points)
    far = {(i, j): found(scene, points[i], points[j]) for i in range(4) for j in range(4) if i != j}
    for (i, j), path in far.items():
        back = far[j, i]
        assert path.length == back.length and path.count == back.count
        assert nx.dijkstra_path_length(graph, i, j, weight="length") == path.length
        k = next(k for k in range(4) if k not in (i, j))
        assert far[i, k].length + far[k, j].length >= path.length


@pytest.mark.parametrize("name", SIMILARITIES)
def test_motions(name: str) -> None:
    change = SIMILARITIES[name]
    for seed in range(3):
        rng, terrain = drawn(seed)
        scene, moved = terrain.scene(), change.terrain(terrain).scene()
        for a, b in pairwise([p for p in places(rng, scene, 9) if p.rational]):
            images = [_image(change, point) for point in (a, b)]
            one, other = found(scene, a, b), found(moved, *images)
            assert other.length == one.length * change.scale and other.count == one.count


def _image(change: Similarity, point: xa.Point) -> tuple:
    return change.point([Q(int(c.p), int(c.q)) for c in point.rational])


@pytest.mark.parametrize("seed", range(3))
def test_another_obstacle_makes_no_path_shorter(seed: int) -> None:
    rng, terrain = drawn(3 * seed)
    shapes = list(terrain.shapes)
    whole, fewer = build(shapes), build(shapes[1:])
    for a, b in pairwise(places(rng, whole, 5)):
        assert found(fewer, a, b).length <= found(whole, a, b).length


@pytest.mark.parametrize("seed", range(3))
def test_vertices_on_edges_change_nothing(seed: int) -> None:
    rng, terrain = drawn(3 * seed + 2)
    shapes = []
    for shape in terrain.shapes:
        if not isinstance(shape, list):
            shapes.append(shape)
            continue
        cut = []
        for p, q in zip(shape, [*shape[1:], shape[0]], strict=True):
            bulge = Q(p[2]) if len(p) > 2 else Q(0)
            middle, first, last = split_point(p, q, bulge, Q(1, 3))
            cut += [(*p[:2], first), (*middle, last)]
        shapes.append(cut)
    scene, parts = terrain.scene(), build(shapes)
    for a, b in pairwise(places(rng, scene, 5)):
        one, other = found(scene, a, b), found(parts, a, b)
        assert (one.length, one.count, one.points) == (other.length, other.count, other.points)


@pytest.mark.parametrize("seed", range(4))
def test_floats_decide_nothing(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """With all bounds infinite paths are the same."""
    rng = Random(seed)
    terrain = degenerate_terrain(rng, columns=2) if seed % 2 else random_terrain(rng, columns=2)
    scene = terrain.scene()
    ends = places(rng, scene, 3)
    paths = [found(scene, a, b) for a, b in pairwise(ends)]
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    again = terrain.scene().replace(name="again")
    for path in paths:
        other = found(again, path.start, path.end)
        assert (other.length, other.count, other.points) == (path.length, path.count, path.points)


# -- peers -----------------------------------------------------------------------------------------


def test_pyvisgraph_finds_the_same() -> None:
    """On polygons in general position; its own tolerances are coarse where lines graze."""
    peer = pytest.importorskip("pyvisgraph")
    for seed in range(6):
        rng = Random(seed)
        terrain = random_terrain(rng, POLYGONS)
        scene = terrain.scene()
        graph = peer.VisGraph()
        graph.build(
            [[peer.Point(float(x), float(y)) for x, y in shape] for shape in terrain.shapes], status=False
        )
        outside = [p for p in places(rng, scene, 20) if all(not o.edges_at(p) for o in scene.obstacles)]
        for a, b in pairwise(outside[:4]):
            way = [(p.x, p.y) for p in graph.shortest_path(peer.Point(*a.xy), peer.Point(*b.xy))]
            length = sum(((x - u) ** 2 + (y - v) ** 2) ** 0.5 for (x, y), (u, v) in pairwise(way))
            assert float(found(scene, a, b).length) == pytest.approx(length, abs=1e-6)


def visible_pairs(scene: xa.Scene, ends: Sequence[xa.Point]) -> xa.Length:
    """The shortest path among polygons by all pairs of corners that see each other, by `isovist`."""
    points = [*ends, *(e.start for o in scene.obstacles for e in o.edges)]
    views = [xa.isovist(scene, point, radius=1000) for point in points]
    graph = nx.Graph()
    for i, point in enumerate(points):
        for j in range(i):
            if views[i].contains(points[j]):
                graph.add_edge(i, j, length=xa.Segment(points[j], point).length)
    return nx.dijkstra_path_length(graph, 0, 1, weight="length")


@pytest.mark.parametrize("seed", range(4))
def test_all_pairs_of_corners_give_the_same(seed: int) -> None:
    """Exactly, without a sweep of tangents."""
    rng = Random(seed)
    terrain = random_terrain(rng, POLYGONS, columns=2) if seed % 2 else build(square_grid(3, 2))
    scene = terrain.scene() if isinstance(terrain, Terrain) else terrain
    a, b = places(rng, scene, 2)
    assert found(scene, a, b).length == visible_pairs(scene, (a, b))


# -- the graph -------------------------------------------------------------------------------------


def test_the_graph_of_two_circles() -> None:
    graph = xa.tangent_graph(xa.Scene([xa.Circle((0, 0), 1), xa.Circle((4, 0), 1)]))
    counted = [kind for _, _, kind in graph.edges(data="kind")]
    assert (counted.count("tangent"), counted.count("arc"), len(graph)) == (4, 8, 8)
    assert {node["kind"] for node in graph.nodes.values()} == {"contact"}
    edges = [data for *_, data in graph.edges(data=True) if data["kind"] == "tangent"]
    assert sorted(float(data["length"]) for data in edges) == pytest.approx([12**0.5, 12**0.5, 4, 4])


def test_the_graph_of_a_square_and_places() -> None:
    graph = xa.tangent_graph(xa.Scene([box(0, 1, 0, 1)]), [(0, 0), (2, 0), (0, 0), ("1/2", 0)])
    assert graph.nodes[0]["point"] == xa.Point(0, 0) and set(graph) == {0, 1, 3, 4, 5, 6}
    edges = [data for *_, data in graph.edges(data=True) if data["kind"] == "edge"]
    sides = [(data["obstacle"], str(data["length"])) for data in edges]
    assert sorted(sides) == [(0, "1"), (0, "1"), (0, "1"), (0, "1/2"), (0, "1/2")]
    assert graph.number_of_edges() == 7


def test_two_arcs_have_two_joints() -> None:
    """One of them is a place, from which a tangent and both arcs go on."""
    bulge = Q(1, 2)
    scene = xa.Scene([xa.Outline(arcs_of_circle((Q(0), Q(0)), Q(1), bulge)), xa.Circle((4, 0), 1)])
    joints = [edge.start for edge in scene.obstacles[0].edges]
    ends = [*joints, xa.Point(0, -1), xa.Point(-1, 0), xa.Point(0, 3)]
    graph = xa.tangent_graph(scene, ends)
    for i, a in enumerate(ends):
        for j, b in enumerate(ends[:i]):
            assert nx.dijkstra_path_length(graph, i, j, weight="length") == found(scene, a, b).length


def test_joints_join_arcs() -> None:
    graph = xa.tangent_graph(
        xa.Scene([xa.Outline(arcs_of_circle((Q(0), Q(0)), Q(1), Q(1)))]), [(-2, 0), (2, 0)]
    )
    kinds_of_nodes = [node["kind"] for node in graph.nodes.values()]
    assert kinds_of_nodes.count("joint") == 2 and kinds_of_nodes.count("contact") == 4
    assert sum(kind == "arc" for *_, kind in graph.edges(data="kind")) == 6


# -- the path as an object -------------------------------------------------------------------------


def test_a_path_shows_and_writes_itself(tmp_path: object) -> None:
    scene = xa.Scene([xa.Circle((0, 0), 1)], terrain=xa.Terrain(8, 8, origin=(-4, -4)))
    path = found(scene, (-2, 0), (2, 0))
    assert path._repr_svg_().startswith("<?xml") and path._repr_svg_() == path._repr_svg_()
    assert path.__geo_interface__["type"] == "LineString"
    assert xa.shortest_path(scene, (2, 0), (2, 0)).__geo_interface__["type"] == "Point"
    assert xa.figure(path).axes[0].get_title() == "length pi/3 + 2*sqrt(3)"
    assert repr(path) == "<ShortestPath from (-2, 0) to (2, 0): 4.5113, 3 pieces>"
    for name in ("way.wkt", "way.dxf", "way.geojson"):
        assert xa.write(path, tmp_path / name)
    assert xa.write(xa.shortest_path(scene, (2, 0), (2, 0)), tmp_path / "point.wkt")
    room = xa.Scene([], enclosure=box(0, 9, 0, 9))
    assert xa.figure(found(room, (1, 1), (2, 2)))


# -- planted faults --------------------------------------------------------------------------------


def all_free(patch: pytest.MonkeyPatch) -> None:
    """What floats leave open counts as free."""
    patch.setattr(tangents, "is_free_among", lambda *_: True)


def half_arcs(patch: pytest.MonkeyPatch) -> None:
    """Lines that touch an arc in its end are missed."""
    patch.setattr(Peg, "owns", lambda self, point: self.arc.full or self.arc.start != point != self.arc.end)


def no_buried(patch: pytest.MonkeyPatch) -> None:
    """Rays into an obstacle count as free."""
    patch.setattr(Pegs, "may_leave", lambda *_: True)


def no_joints(patch: pytest.MonkeyPatch) -> None:
    """A walk along an arc ends with it."""
    patch.setattr(Pegs, "_join", lambda *_: None)


PLANTS = [all_free, half_arcs, no_buried, no_joints]


@pytest.mark.parametrize("plant", PLANTS, ids=lambda plant: plant.__name__)
def test_a_planted_fault_is_noticed(plant: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the comparison with brute force, between points that lie on boundaries and in line with vertices."""
    bar = [(4, -1), (5, -1), (5, 0), (5, 1), (4, 1), (4, 0)]
    shapes = [STADIUM, bar, [(-5, 0), (-4, 0), (-4, 2), ("-9/2", HALF), (-5, 2)]]
    shapes.append(arcs_of_circle((Q(0), Q(5)), Q(1), Q(1, 3)))
    shapes = [[tuple(map(Q, corner)) for corner in shape] for shape in shapes]
    ends = [(-3, 0), (4, 0), (-4, 1), (-5, 1), (0, -1), (3, 0), (6, 0), (-2, 5), (0, 6), (2, 5)]
    pairs = [(a, b) for a in ends for b in ends[: ends.index(a)]]

    def differences() -> int:
        scene, wrong = build(shapes), 0
        for (a, b), brute in zip(pairs, lengths, strict=True):
            path = xa.shortest_path(scene, a, b)
            wrong += path is None or abs(float(path.length) - brute) > 1e-6
        return wrong

    lengths = [shortest_length(shapes, a, b) for a, b in pairs]
    assert differences() == 0
    plant(monkeypatch)
    assert differences() > 0
