"""Shortest paths on what is known: closed forms, laws, and brute force among walls without thickness."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise
from random import Random

import networkx as nx
import pytest
from brute_chains import Pair, free_walls, wall_paths
from brute_paths import shortest_length
from nightly import some
from planted_maps import PartlyKnown, Walled
from strategies import FREE_CUSPS, ROUNDED_U, S_BAND, SPIKES, STADIUM, box

import exactacq as xa
from exactacq import kernel
from exactacq.files.octagons import random_octagons
from exactacq.geometry.points import Location
from exactacq.strategies import known_paths
from exactacq.study.random_scenes import Subject, random_scene
from exactacq.visibility.known_ground import KnownGround

CIRCLE = xa.Circle((0, 0), 1)
EAST, NORTH, WEST, SOUTH = 0, 1, 2, 3
"""Parameters of the unit circle's extreme points."""


def found(chart: object, a: object, b: object) -> xa.ShortestPath:
    """A shortest path whose pieces join and add up, and are as long as they can be."""
    path = xa.shortest_path(chart, a, b)
    assert path is not None
    assert all(one.end == other.start for one, other in pairwise(path.path))
    assert path.length == xa.Length.sum(piece.length for piece in path.path)
    straight = [piece for piece in path.path if isinstance(piece, xa.Segment)]
    for one, other in pairwise(straight):
        turn, ahead = one.direction.cross(other.direction), one.direction.dot(other.direction)
        assert turn.sign() or ahead.sign() < 0 or one.end != other.start
    return path


def told(chart: object, a: object, b: object) -> tuple[str, int, list[str]]:
    path = found(chart, a, b)
    return str(path.length), path.count, [str(point) for point in path.points[1:-1]]


# -- against brute force ---------------------------------------------------------------------------


def drawn(seed: int, solid: bool) -> tuple[Walled, list, list, list[Pair]]:
    """Walls on a small grid, some of them closed if *solid*, and places, many of them on walls."""
    rng = Random(seed)
    size = rng.choice([3, 4, 6, 9])
    rows = free_walls(rng, rng.randint(1, 5), size, most=rng.choice([2, 3, 4, 6]))
    solids: list[list[Pair]] = []
    for row in rows if solid else ():
        try:
            (obstacle,) = xa.Scene([row]).obstacles
            loop = [tuple(map(int, edge.start.rational)) for edge in obstacle.edges]
            xa.Scene([*solids, loop, *(_thin(other) for other in rows if other is not row)])
        except xa.InvalidScene:
            continue
        solids.append(loop)
        rows = [other for other in rows if other is not row]
    scene = xa.Scene(solids)
    places = [(rng.randint(-1, size + 1), rng.randint(-1, size + 1)) for _ in range(6)]
    places += [rng.choice(row) for row in rows]
    free = [p for p in places if all(o.locate(xa.Point(*p)) is not Location.INSIDE for o in scene.obstacles)]
    return Walled(rows, scene), rows, solids, free


def _thin(row: list[Pair]) -> list[tuple]:
    """A wall with so little thickness that it meets what the wall meets, of rows that are apart."""
    hair = xa.Length("1e-9").rational
    return [*row, *((x + hair, y + 2 * hair) for x, y in reversed(row))]


@pytest.mark.parametrize("solid", [False, True], ids=["walls", "and obstacles"])
@pytest.mark.parametrize("seed", some(range(400), 25))
def test_brute_force_finds_the_same(seed: int, solid: bool) -> None:
    """Lengths, how many are as short, the one whose corners come first, and the way back."""
    chart, walls, solids, places = drawn(seed, solid)
    for a, b in pairwise(places):
        if a == b:
            continue
        path, (length, ways) = found(chart, a, b), wall_paths(walls, solids, a, b)
        assert float(path.length) == pytest.approx(length, abs=1e-9)
        assert path.count == len(ways)
        assert path.points == tuple(xa.Point(*p) for p in min(ways))
        back = found(chart, b, a)
        assert (back.length, back.count) == (path.length, path.count)


@pytest.mark.parametrize("seed", [*some(range(200), 12), 54])
def test_distances_are_those_of_the_graph(seed: int) -> None:
    """Seed 54: a place in a hollow, and a path that turns around the hollow's corner on its other side."""
    chart, _, _, places = drawn(seed, False)
    ends = list(dict.fromkeys(places))[:4]
    graph = xa.tangent_graph(chart, ends)
    for i, j in pairwise(range(len(ends))):
        length = nx.dijkstra_path_length(graph, i, j, weight="length")
        assert length == found(chart, ends[i], ends[j]).length


@pytest.mark.parametrize("seed", some(range(60), 6))
def test_floats_do_not_decide(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """With all bounds infinite paths are the same, among walls and on what a robot sees at first."""
    _, walls, solids, places = drawn(seed, bool(seed % 2))
    sight = xa.Robot(random_scene(Subject.SIGHTSEER, seed)).map
    asked = [(Walled(walls, xa.Scene(solids)), places[0], places[-1]), (sight, (-6, -5), (6, 5))]
    paths = [found(*ask) for ask in asked]
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    again = (
        Walled(walls, xa.Scene(solids)),
        KnownGround(sight._known_ground.scene, sight._known_ground.chains),
    )
    for path, chart in zip(paths, again, strict=True):
        other = found(chart, path.start, path.end)
        assert (other.length, other.count, other.points) == (path.length, path.count, path.points)


THIN = 1e-5


def sliver(x: float, y: float, r: float, first: float, last: float) -> list[tuple]:
    """A part of a ring, between two angles: what is known of a circle, with some thickness inward."""
    b, s = math.tan((last - first) / 4), r - THIN
    corners = [(r, first, b), (r, last, 0.0), (s, last, -b), (s, first, 0.0)]
    return [(x + q * math.cos(a), y + q * math.sin(a), bulge) for q, a, bulge in corners]


@pytest.mark.parametrize("seed", some(range(60), 12))
def test_brute_force_agrees_on_parts_of_circles(seed: int) -> None:
    rng = Random(seed)
    scene, known, shapes = [], {}, []
    for k in range(rng.randint(1, 3)):
        x, r = 4 * k, rng.choice([1, "3/2"])
        y = rng.choice([0, 0, 1, -1])
        low = rng.choice([0, "1/2", 1, "5/3", 2])
        high = rng.choice(["7/3", "5/2", 3, "7/2"])
        scene.append(xa.Circle((x, y), r))
        known[k] = [(0, low, high)]
        angles = [
            math.pi / 2 * int(float(u)) + 2 * math.atan(float(u) % 1) for u in map(xa.Real, (low, high))
        ]
        shapes.append(sliver(x, y, float(xa.Real(r)), *angles))
    chart = PartlyKnown(xa.Scene(scene), known)
    ends = [(-2, 0), (10, 1), (0, 0), (4, "1/4"), ("1/2", "5/2"), (6, -2), (2, 0)]
    for a, b in pairwise(rng.sample(ends, 4)):
        brute = shortest_length(shapes, xa.Point.of(a).xy, xa.Point.of(b).xy)
        assert float(found(chart, a, b).length) == pytest.approx(brute, abs=1e-3)


# -- closed forms ----------------------------------------------------------------------------------


def test_around_the_end_of_a_half_known_circle() -> None:
    """The west half is known: the shorter ways go to an end of it and on, and along nothing else."""
    half = PartlyKnown(xa.Scene([CIRCLE]), {0: [(0, NORTH, SOUTH)]})
    assert found(half, (-3, 0), (0, 0)).count == 2
    # The tangent from (-3, 0), the arc from there to the south end, and the radius back to the centre.
    angle = xa.Length.turns(1, "1/2") - xa.Length.arc(1, "1/3", xa.Real(8).sqrt() / 3)
    length = xa.Length(xa.Real(8).sqrt()) + angle - xa.Length.turns(1, "1/4") + 1
    assert found(half, (-3, 0), (0, 0)).length == length
    assert [type(piece).__name__ for piece in found(half, (-3, 0), (0, 0)).path] == [
        "Segment",
        "Arc",
        "Segment",
    ]
    # In the hollow nothing is in the way; from inside to outside it is the end that is.
    assert told(half, (0, 0), ("-1/2", 0)) == ("1/2", 1, [])
    assert told(half, ("-1/2", 0), (4, 0)) == ("9/2", 1, [])
    # A place on the arc is on its outer side, and a place at its end on both.
    assert told(half, (0, 1), (0, -1)) == ("2", 1, [])
    assert found(half, (-1, 0), (0, 0)).length == 1 + xa.Length.turns(1, "1/4")


def test_a_circle_whose_known_part_passes_its_first_point() -> None:
    """The east half, in two parts that are one chain."""
    half = PartlyKnown(xa.Scene([CIRCLE]), {0: [(0, EAST, NORTH), (0, SOUTH, 4)]})
    path = found(half, (0, -1), (0, 1))
    assert path.length == 2
    assert found(half, (1, -1), (1, 1)).length == 2
    assert (
        found(half, (3, 0), (0, 1)).length
        == found(PartlyKnown(xa.Scene([CIRCLE]), {0: [(0, NORTH, SOUTH)]}), (-3, 0), (0, 1)).length
    )
    assert [type(piece).__name__ for piece in path.path] == ["Segment"]


def test_two_places_of_one_arc_may_be_joined_across_its_ends() -> None:
    """A walk that begins on an arc, and one that comes to its end, are two: the longer one is not dropped."""
    mouth = xa.Outline([(1, 0, xa.Around((0, 0))), (0, -1), (0, 0)])
    half_known = PartlyKnown(xa.Scene([CIRCLE]), {0: [(0, EAST, SOUTH)]})
    a, b = xa.Point("3/5", "4/5"), xa.Point("-3/5", "-4/5")
    for ground in (xa.Scene([mouth]), half_known):
        for start, goal in ((a, b), (b, a)):
            path = found(ground, start, goal)
            assert (str(path.length), path.count) == ("sqrt(2) + pi/2", 1)
            assert sorted(map(str, path.points[1:-1])) == ["(0, -1)", "(1, 0)"]


def test_the_end_of_a_chain_is_not_computed_to_lie_on_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ends of views from irrational places have numbers too long to decide that."""
    end = xa.Point("3/5", "4/5")
    chart = PartlyKnown(xa.Scene([CIRCLE]), {0: [(0, end, WEST)]})
    passes = xa.Arc.passes

    def short(arc: xa.Arc, point: xa.Point) -> bool:
        assert point is not end
        return passes(arc, point)

    monkeypatch.setattr(xa.Arc, "passes", short)
    assert told(chart, (0, 0), end) == ("1", 1, [])
    assert told(chart, (0, 2), end) == told(chart, (0, 2), xa.Point("3/5", "4/5"))


def test_the_end_of_a_view_on_an_arc() -> None:
    """What a robot sees of a circle ends where its tangents touch; a path beyond turns there."""
    robot = xa.Robot(xa.Scene([xa.Circle((5, 0), 2)], start=(0, 0), radius=20))
    path = robot.path_to((10, 0))
    touch = xa.Point("21/5", -2 * xa.Real(21).sqrt() / 5)
    assert (path.count, path.points[1]) == (2, touch)
    assert path.length == xa.Length(xa.Real(21).sqrt()) + xa.Segment(touch, (10, 0)).length


@pytest.mark.parametrize(
    ("a", "b", "answer"),
    [
        ((-1, 0), (4, 0), ("5", 1, [])),
        ((-1, 0), (2, 0), ("3", 1, [])),
        (("1/2", 1), ("5/2", -1), ("2*sqrt(2)", 1, [])),
        ((1, 0), (2, 0), ("1", 1, [])),
        ((1, 0), (1, -1), ("1", 1, [])),
        ((1, 0), (1, 1), ("1", 1, [])),
        (("1/2", 1), ("1/2", -1), ("sqrt(5)", 2, ["(0, 0)"])),
        (("1/2", 0), ("1/2", 1), ("1/2 + sqrt(5)/2", 2, ["(0, 0)"])),
        (("1/2", 0), ("1/2", -1), ("1", 1, [])),
        (("1/2", 0), ("5/2", 0), ("2", 1, [])),
    ],
)
def test_walls_on_one_line_with_a_gap(a: object, b: object, answer: object) -> None:
    """The walls lead from west to east, so that their free side is the south."""
    assert told(Walled([[(0, 0), (1, 0)], [(2, 0), (3, 0)]]), a, b) == answer


def test_a_gap_of_a_hair() -> None:
    hair = xa.Length("1e-60").rational
    walls = Walled([[(0, -9), (0, 0)], [(0, hair), (0, 9)]])
    assert told(walls, (-3, 0), (4, 0)) == ("7", 1, [])
    assert found(walls, (-3, hair), (4, 0)).length > 7


def test_corners_count_on_their_convex_side() -> None:
    """A wall that goes south and then east: the free side of its corner is the outer one."""
    bend = Walled([[(0, 2), (0, 0), (2, 0)]])
    assert told(bend, (-1, 1), (1, -1)) == ("2*sqrt(2)", 1, [])
    assert told(bend, (1, 1), (-1, -1)) == ("sqrt(2) + sqrt(10)", 2, ["(0, 2)"])
    assert told(bend, (1, 0), (0, 1)) == ("2", 1, ["(0, 0)"])
    assert told(bend, (0, 0), (1, 1)) == ("sqrt(2) + 2", 2, ["(0, 2)"])
    assert told(bend, (0, 2), (2, 0)) == ("2*sqrt(2)", 1, [])


def test_walls_in_pieces_are_walls() -> None:
    whole, parts = Walled([[(0, 0), (4, 0)]]), Walled([[(0, 0), (1, 0), (3, 0), (4, 0)]])
    for a, b in [((2, 1), (2, -1)), ((1, 0), (3, 1)), ((-1, 0), (5, 0)), ((0, 0), (3, 0)), ((1, 1), (1, 0))]:
        assert told(whole, a, b) == told(parts, a, b)


def test_single_points_are_no_obstacle() -> None:
    scene = xa.Scene([box(0, 2, 0, 2)])

    class Spotted(PartlyKnown):
        def known(self, i: int) -> list:
            return [part._replace(curve=None) for part in super().known(i)]

    chart = Spotted(scene, {0: [(0, "1/2", "1/2")]})
    assert told(chart, (1, -1), (1, 3)) == ("4", 1, [])


def test_what_is_no_map_is_refused() -> None:
    with pytest.raises(xa.FormatError, match="a scene or a map, not 3"):
        xa.shortest_path(3, (0, 0), (1, 1))
    with pytest.raises(xa.FormatError, match="a scene or a map"):
        xa.tangent_graph("figure2", [(0, 0)])
    with pytest.raises(xa.FormatError, match="a scene or a map"):
        xa.shortest_path(xa.Robot(xa.load("circles")), (0, 0), (1, 1))


# -- laws ------------------------------------------------------------------------------------------

MOVES = {
    "mirrored": lambda x, y: (-x, y),
    "turned by 3-4-5": lambda x, y: ((3 * x - 4 * y) / 5, (4 * x + 3 * y) / 5),
}


@pytest.mark.parametrize("move", MOVES.values(), ids=MOVES)
@pytest.mark.parametrize("seed", some(range(100), 8))
def test_paths_move_with_the_walls(seed: int, move: object) -> None:
    """A mirror image has its free side on the other one, so that walls are walked the other way."""
    _, walls, _, places = drawn(seed, False)
    mirrored = move is MOVES["mirrored"]
    chart = Walled(walls)
    moved = Walled([[move(*map(xa.Real, p)) for p in (row[::-1] if mirrored else row)] for row in walls])
    for a, b in pairwise(places):
        if a != b:
            one, other = found(chart, a, b), found(moved, *(move(*map(xa.Real, p)) for p in (a, b)))
            assert (one.length, one.count) == (other.length, other.count)


@pytest.mark.parametrize("name", ["circles", "figure2", "case1"])
def test_more_knowledge_never_makes_a_path_shorter(name: str) -> None:
    """At the start of several pieces of a run, and in the end as in the scene, if that is all known."""
    scene = xa.load(name)
    run = xa.explore(scene, "nearest-frontier")
    assert not run.unseen
    scene = scene.replace(terrain=None)
    ends = [(-3, 1), (21, 22), scene.start]
    free = [p for p in ends if all(o.locate(xa.Point.of(p)) is Location.OUTSIDE for o in scene.obstacles)]
    count = len(run.path)
    moments = sorted({*range(0, count, max(1, count // 4)), count})
    for a, b in pairwise(free):
        lengths = [found(run.record.after(k), a, b).length for k in moments]
        assert all(one <= other for one, other in pairwise(lengths))
        assert lengths[-1] == found(scene, a, b).length
        assert found(run.map, a, b).count == found(scene, a, b).count


def test_a_robots_map_has_its_own_numbers_and_keeps_names() -> None:
    scene = xa.Scene([xa.Circle((40, 0), 1, name="far"), box(5, 7, -1, 1)], start=(0, 0), radius=20)
    robot = xa.Robot(scene)
    graph = xa.tangent_graph(robot.map, [(0, 0), (9, 0)])
    assert {number for _, _, number in graph.edges(data="obstacle")} == {None, 0}
    path = xa.shortest_path(robot.map, (0, 0), (9, 0))
    assert path.length == robot.path_to((9, 0)).length == xa.Real(26).sqrt() + xa.Real(17).sqrt()
    assert path.scene.obstacles == () and path.walls == (xa.Segment((5, 1), (5, -1)),)


CHORDS = 40


def chords(edge: object, low: float, high: float) -> list[tuple]:
    """Rational points along a part of an edge."""
    stroke = edge.stroke()
    count = CHORDS if isinstance(edge, xa.Arc) else 1
    rows = (stroke.at(low + (high - low) * k / count) for k in range(count + 1))
    return [tuple(Fraction(float(c)).limit_denominator(10**6) for c in row) for row in rows]


@pytest.mark.parametrize("shape", [STADIUM, ROUNDED_U, S_BAND, *SPIKES, *FREE_CUSPS], ids=len)
@pytest.mark.parametrize("seed", some(range(40), 2))
def test_chains_with_arcs_are_like_those_of_many_chords(seed: int, shape: list) -> None:
    """Some edges in a row are known, the first and the last in part; the rest of the obstacle is free."""
    rng = Random(seed)
    scene = xa.Scene([xa.Outline(shape)])
    edges = scene.obstacles[0].edges
    first, count = rng.randrange(len(edges)), rng.randint(1, len(edges) - 1)
    row = [(first + k) % len(edges) for k in range(count)]
    spans = {e: [0.0, 1.0] for e in row}
    spans[row[0]][0], spans[row[-1]][1] = rng.choice([0, 0, 0.25]), rng.choice([1, 1, 0.625])
    known, wall = [], []
    for e in row:
        edge, (low, high) = edges[e], spans[e]
        stroke = edge.stroke()
        ends = [edge.start if u == 0 else edge.end if u == 1 else place_on(edge, u) for u in (low, high)]
        known.append((e, *ends))
        fractions = [
            0.0 if p is edge.start else 1.0 if p is edge.end else swept(edge, p) / stroke.length for p in ends
        ]
        wall += chords(edge, *fractions)[bool(wall) :]
    chart, other = PartlyKnown(scene, {0: sorted(known, key=lambda part: part[0])}), Walled([wall])
    for _ in range(4):
        a, b = (
            (Fraction(rng.randint(-9, 9), 3) + Fraction(1, 7), Fraction(rng.randint(-9, 9), 3)) for _ in "ab"
        )
        assert float(found(chart, a, b).length) == pytest.approx(float(found(other, a, b).length), abs=0.03)


def place_on(edge: object, u: float) -> xa.Point:
    return edge.point(Fraction(u))


def swept(edge: object, point: xa.Point) -> float:
    return float(edge.part(edge.start, point).length)


@pytest.mark.parametrize("seed", some(range(120), 6))
def test_what_robots_know_is_like_many_chords(seed: int) -> None:
    """The ends of views are irrational, and lie on lines with corners: in chords they are rational."""
    rng = Random(seed)
    robot = xa.Robot(random_scene(Subject.SIGHTSEER, seed))
    for _ in range(3):
        known = KnownGround.of(robot.map)
        walls = [row for chain in known.chains if len(row := in_chords(chain)) > 1]
        other = Walled(walls, known.scene)
        for _ in range(3):
            ends = [tuple(Fraction(rng.randint(-70, 70), 10) for _ in "xy") for _ in "ab"]
            free = [o.locate(xa.Point(*p)) is Location.OUTSIDE for o in known.scene.obstacles for p in ends]
            if all(free) and not any(robot.map.knows(p) for p in ends):
                length = float(found(robot.map, *ends).length)
                assert length == pytest.approx(float(found(other, *ends).length), abs=0.03)
        robot.go_to((rng.randint(-6, 6), rng.randint(-6, 6)))


def in_chords(chain: object) -> list[tuple]:
    places = [place for piece in chain.pieces for place in chords(piece.curve, 0.0, 1.0)]
    return [place for k, place in enumerate(places) if not k or place != places[k - 1]]


# -- of a robot, among what may be in the way ---------------------------------------------------------


def asked(path: Callable[[], xa.ShortestPath | None]) -> object:
    try:
        way = path()
    except (xa.MoveError, xa.InvalidScene) as error:
        # What a robot knows is a scene of its own: it numbers obstacles in another way.
        return (
            re.sub(r"obstacle O\d+", "an obstacle", str(error))
            .removeprefix("no path: ")
            .removeprefix("end: ")
        )
    return None if way is None else (way.length, way.count, way.points)


@pytest.mark.parametrize("first", [1.0, 1.25])
@pytest.mark.parametrize("seed", some(range(6), 2))
def test_what_is_far_away_changes_no_path(seed: int, first: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The robot looks at what is near enough; of all that it knows the path is the same.

    If it takes paths to be no longer than the straight line, it has to look farther for each that bends.
    """
    monkeypatch.setattr(known_paths, "FIRST", first)
    rng, robot = Random(seed), xa.Robot(random_octagons(30, seed))
    looks = spied(monkeypatch)
    for _ in range(4):
        robot.take(robot.nearest_unvisited())
        robot.circle()
        for size in (2, 5, 15):
            x, y = (round(c) + rng.randint(-size, size) for c in robot.position.xy)
            near = asked(lambda x=x, y=y: robot.path_to((x, y)))
            assert near == asked(lambda x=x, y=y: xa.shortest_path(robot.map, robot.position, (x, y)))
    assert len(looks) > 12 * (first == 1.0)
    assert any(not is_all for is_all in looks)


def spied(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Tells of each look for a ground whether it is all that is known."""
    looks, ground = list[bool](), known_paths.KnownPaths._ground

    def look(self: known_paths.KnownPaths, reach: float) -> tuple[KnownGround, bool]:
        found = ground(self, reach)
        looks.append(found[1])
        return found

    monkeypatch.setattr(known_paths.KnownPaths, "_ground", look)
    return looks


def test_a_way_that_is_much_longer_than_the_straight_line() -> None:
    """Around the one end of a long wall: what stands at its other end, far away, is in the way too."""
    wall, bar = box(-60, 60, -1, 1), box(61, 62, -80, 80)
    robot = xa.Robot(xa.Scene([wall, bar], start=(59, 9), radius=300))
    robot.take(robot.nearest_unvisited())
    robot.circle()
    robot.take(robot.nearest_unvisited())
    robot.circle()
    robot.go_to((58, 9))
    assert robot.path_to((58, -9)).length == xa.shortest_path(robot.map, (58, 9), (58, -9)).length
    assert robot.path_to((63, 9)).length == xa.shortest_path(robot.map, (58, 9), (63, 9)).length > 140


# -- within a terrain ------------------------------------------------------------------------------


def confined(*obstacles: object) -> xa.Robot:
    return xa.Robot(xa.Scene(obstacles, terrain=xa.Terrain(9, 9), radius=20), confined=True)


def test_nothing_leads_around_an_obstacle_at_the_border() -> None:
    """The west side of a bar that crosses the border is in sight: it ends at the border and in a corner."""
    robot = confined(box(4, 5, -1, 6))
    assert str(robot.path_to((9, 0)).length) == "2*sqrt(13) + sqrt(61)"
    assert robot.path_to((8, 0)).points[1] == xa.Point(4, 6)
    assert robot.path_to((4, 0)).length == 4
    assert xa.shortest_path(robot.map, (0, 0), (8, 0)).length == robot.path_to((8, 0)).length


def test_border_and_known_boundary_may_leave_no_path() -> None:
    robot = confined(box(4, 5, -1, 10))
    assert robot.path_to((4, 9)).length == xa.Real(97).sqrt()
    with pytest.raises(xa.MoveError, match=r"part the robot from \(9, 0\)"):
        robot.path_to((9, 0))
    with pytest.raises(xa.MoveError, match="beyond the border"):
        robot.path_to((10, 0))


RUNS_ALONG = (0, 14, 31)
"""Seeds of scenes where an obstacle runs along the border: there a path in the scene may follow it."""


@pytest.mark.parametrize("seed", [seed for seed in some(range(60), 8) if seed not in RUNS_ALONG])
def test_when_all_is_known_paths_are_those_in_the_terrain(seed: int) -> None:
    scene = random_scene(Subject.SEED_SPREADER, seed)
    run = xa.seed_spreader(scene)
    known = not run.map.incomplete and len(run.map.acquired) == len(run.obstacles)
    west, south, east, north = scene.terrain.limits
    rng, corner = Random(seed), scene.terrain.south_west
    for _ in range(3):
        goal = (
            west + (east - west) * rng.randint(0, 12) / 12,
            south + (north - south) * rng.randint(0, 12) / 12,
        )
        if any(o.locate(xa.Point(*goal)) is Location.INSIDE for o in scene.obstacles):
            continue
        whole, partly = xa.shortest_path(scene, corner, goal), xa.shortest_path(run.map, corner, goal)
        if whole is not None and known:
            assert (partly.length, partly.count) == (whole.length, whole.count)
        assert whole is None or partly.length <= whole.length


def test_a_path_along_a_row_of_walls_is_chosen_at_once() -> None:
    """Each wall has pegs on both sides: by these there are 4^16 ways along the row, all of them one path."""
    row = [xa.Polygon([(k, 0), (k + 1, 0), (k + 1, 1), (k, 1)]) for k in range(1, 33, 2)]
    robot = xa.Robot(xa.Scene(row, start=(0, 0), radius=100))
    path = robot.path_to((34, 0))
    assert (path.length, path.count, len(path.path)) == (34, 1, 1)
