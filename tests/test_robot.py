"""The public robot: moves, questions, and that it tells nothing of what it has not seen."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import is_dataclass
from enum import Enum
from random import Random

import numpy as np
import pytest
from flint import fmpq

import exactacq as xa
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Location, Point
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.scene import Obstacle
from exactacq.sensing.map import Map
from exactacq.sensing.memory import Memory
from exactacq.strategies.first_hit import first_hit
from exactacq.strategies.moves import HaltKind
from exactacq.study.random_scenes import Subject, random_scene
from exactacq.visibility.free_segment import is_free
from exactacq.visibility.links import Link, Links

SQUARES = xa.Scene(
    [[(2, -1), (4, -1), (4, 1), (2, 1)], [(7, -1), (9, -1), (9, 1), (7, 1)]], start=(0, 0), radius=20
)
SIGHTS = ("sight", "regain", "acquire", "lose")


def wanderer(seed: int, moves: int = 6) -> xa.Robot:
    """A robot in a random scene after some random moves: numbers get long where ends lead to ends."""
    rng = Random(seed)
    robot = xa.Robot(random_scene(Subject.SIGHTSEER, seed))
    for _ in range(moves):
        until = rng.choice([(), (), SIGHTS, ("acquire",)])
        ends = [point for _, point in robot.frontier]
        if robot.at is not None and rng.random() < 0.6:
            robot.walk(rng.choice(["left", "right"]), to=rng.choice([*ends, None]), until=until)
        elif ends:
            robot.go_to(rng.choice(ends), until=until)
        else:
            robot.go_to((rng.randint(-9, 9), rng.randint(-9, 9)), until=until)
    return robot


class TestStraightMoves:
    def test_end_where_an_obstacle_blocks(self) -> None:
        robot = xa.Robot(SQUARES)
        halt = robot.go_to((20, 0))
        assert (halt.kind, halt.place, halt.obstacle) == (HaltKind.HIT, Point(2, 0), 0)
        assert robot.position == Point(2, 0) and robot.at == 0 and robot.length == 2
        again = robot.go_to((20, 0))
        assert (again.kind, again.place) == (HaltKind.HIT, Point(2, 0)) and len(robot.path) == 1

    def test_may_touch_and_run_along_boundaries(self) -> None:
        robot = xa.Robot(SQUARES)
        for target in ((0, 1), (20, 1)):
            assert robot.go_to(target).kind == "arrived"
        assert robot.at is None and robot.length == 21
        assert robot.go_to((9, 1)).obstacle == 1 and robot.go_to((7, 1)).obstacle == 1
        assert [p.kind for p in robot.path] == ["straight"] * 4

    def test_halt_at_events(self) -> None:
        robot = xa.Robot(xa.Scene([xa.Circle((10, 0), 2)], start=(0, 0), radius=5))
        halt = robot.go_to((20, 0), until=["sight", "lose"])
        assert (halt.kind, halt.place, halt.obstacle) == (HaltKind.EVENT, Point(3, 0), None)
        assert halt.sighting is not None and halt.sighting.obstacle == 0 and robot.seen == (0,)
        assert robot.go_to((20, 0), until="sight").kind == "hit"

    def test_to_where_the_robot_is(self) -> None:
        robot = xa.Robot(SQUARES)
        assert robot.go_to((0, 0)).kind == "arrived" and robot.at is None and len(robot.path) == 0
        beside = xa.Robot(SQUARES, start=(2, 0))
        assert beside.at is None
        with pytest.raises(xa.MoveError, match=r"it only touches one; go_to\(robot.position\) puts it there"):
            beside.walk()
        assert beside.go_to((2, 0)).obstacle == 0 and beside.walk().kind == "round"

    def test_from_a_boundary_into_its_obstacle(self) -> None:
        robot = xa.Robot(SQUARES, start=(2, 0))
        halt = robot.go_to((3, 0))
        assert (halt.kind, halt.place, robot.at) == (HaltKind.HIT, Point(2, 0), 0)

    @pytest.mark.parametrize("seed", range(12))
    def test_first_hits_are_where_freedom_ends(self, seed: int) -> None:
        """By the filter that links use, by places inside obstacles, and from the other end."""
        scene, rng = random_scene(Subject.SIGHTSEER, seed), Random(seed)
        table, start = EdgeTable(scene.obstacles), scene.start
        for _ in range(12):
            target = Point(fmpq(rng.randint(-30, 30), 2), fmpq(rng.randint(-30, 30), 2))
            if target == start or any(o.locate(target) is not Location.OUTSIDE for o in scene.obstacles):
                continue
            if any(o.locate(start) is not Location.OUTSIDE for o in scene.obstacles):
                return
            way = Segment(start, target)
            hit, back = first_hit(table, way), first_hit(table, way.reversed())
            assert (hit is None) == (back is None) == is_free(table, start, target)
            if hit is not None:
                obstacle = scene.obstacles[hit.obstacle]
                assert obstacle.locate(hit.place) is Location.BOUNDARY
                assert hit.place == start + way.direction * hit.u
                assert first_hit(table, Segment(start, hit.place)) is None
                assert first_hit(table, Segment(hit.place, target)).u.sign() == 0


class TestWalks:
    @pytest.mark.parametrize("hand", ["left", "right"])
    def test_all_around_are_as_long_as_the_boundary(self, hand: str) -> None:
        robot = xa.Robot(SQUARES)
        robot.go_to((5, 0))
        assert robot.walk(hand).kind == "round"
        assert robot.position == Point(2, 0) and robot.length == 10 and robot.visited == (0,)

    def test_that_were_interrupted_go_on(self) -> None:
        robot = xa.Robot(SQUARES)
        robot.go_to((5, 0))
        for corner in ((2, -1), (4, -1), (4, 0)):
            assert robot.walk(to=corner).kind == "arrived"
        assert robot.visited == () and robot.walk(to=(3, 0)).kind == "round"
        assert robot.visited == (0,) and robot.length == 10

    def test_the_other_way_begin_anew(self) -> None:
        robot = xa.Robot(SQUARES)
        robot.go_to((5, 0))
        robot.walk(to=(4, 1))
        assert robot.walk("right").kind == "round" and robot.position == Point(4, 1)

    def test_around_a_circle_pass_its_seam(self) -> None:
        robot = xa.Robot(xa.Scene([xa.Circle((5, 0), 2), xa.Circle((12, 0), 1)], start=(0, 0), radius=20))
        robot.go_to((5, 0))
        assert robot.walk(until="sight").sighting.obstacle == 1
        assert robot.walk(until=["lose"]).kind == "event"
        assert robot.walk().kind == "round"
        assert robot.length == xa.Length.turns(1) * 2 + 3

    def test_the_shorter_way_is_known_with_the_boundary(self) -> None:
        robot = xa.Robot(SQUARES)
        with pytest.raises(xa.MoveError, match="at no boundary"):
            robot.walk_to((2, 0))
        robot.go_to((5, 0))
        with pytest.raises(xa.MoveError, match="parts of obstacle 0 are unknown"):
            robot.walk_to((4, 0))
        robot.circle()
        assert robot.way_to((4, 1))[0] == 3 and robot.way_to((4, 1))[1] == "right"
        with pytest.raises(xa.MoveError, match="no way along this boundary"):
            robot.walk_to((0, 0))
        robot.walk_to((4, 1))
        assert robot.length == 13

    def test_with_no_hand_or_event_are_errors(self) -> None:
        robot = xa.Robot(SQUARES)
        robot.go_to((5, 0))
        with pytest.raises(ValueError, match='a hand is "left" or "right"'):
            robot.walk("up")
        with pytest.raises(ValueError, match="a robot looks out for sight"):
            robot.walk(until="hit")
        with pytest.raises(
            ValueError, match="a robot looks out for sight, regain, acquire, lose, not for seen"
        ):
            robot.walk(until="seen")


class TestLinks:
    def test_are_known_from_boundaries_that_were_circled(self) -> None:
        robot = xa.Robot(SQUARES)
        for source in (0, 1, -1, 7):
            with pytest.raises(xa.MoveError, match="known once it was walked around"):
                robot.links(source)
        robot.take(robot.nearest_unvisited(None))
        robot.circle()
        (link,) = robot.links(0)
        assert (link.source, link.target, link.length) == (0, 1, 3)

    def test_of_another_robot_or_place_are_no_ways(self) -> None:
        robot, other = xa.Robot(SQUARES), xa.Robot(SQUARES)
        link = other.nearest_unvisited(None)
        with pytest.raises(xa.MoveError, match="another robot"):
            robot.take(link)
        other.go_to((0, 5))
        with pytest.raises(xa.MoveError, match="somewhere else"):
            other.take(link)
        other.go_to((2, 0))
        with pytest.raises(xa.MoveError, match="the robot is at obstacle 0"):
            other.take(link)

    def test_lead_back(self) -> None:
        robot = xa.Robot(SQUARES)
        way = robot.take(robot.nearest_unvisited(None))
        robot.walk(to=(2, -1))
        with pytest.raises(xa.MoveError, match="parts of obstacle 0"):
            robot.go_back(way)
        robot.walk()
        robot.go_back(way)
        assert robot.position == Point(0, 0) and robot.at is None
        with pytest.raises(xa.MoveError, match="in free space"):
            robot.go_back(way)


class TestWhatIsTold:
    @pytest.mark.parametrize("seed", range(10))
    def test_is_the_map_of_the_path(self, seed: int) -> None:
        """Sensed again from the finished path; numbers follow the order of first sights."""
        robot = wanderer(seed)
        scene = random_scene(Subject.SIGHTSEER, seed)
        again = Memory.of(scene, robot.radius, robot.start, robot._walker.pieces)
        own = list(dict.fromkeys(report.obstacle for report in again.reports))
        assert robot.seen == tuple(range(len(own)))
        told, chart = robot.map, again.now
        assert {own[i] for i in told.acquired} == set(chart.acquired)
        assert {own[i] for i in told.incomplete} == set(chart.incomplete)
        assert sorted((own[i], p.xy) for i, p in told.frontier) == sorted(
            (k, p.xy) for k, p in chart.frontier
        )
        assert told.known_length() == chart.known_length()
        assert [(s.kind, own[s.obstacle]) for s in robot.sightings] == [
            (r.kind, r.obstacle) for r in again.reports
        ]
        assert robot.length == xa.Length.sum(piece.length for piece in robot.path)

    @pytest.mark.parametrize("seed", range(10))
    def test_in_sight_is_on_the_map(self, seed: int) -> None:
        robot = wanderer(seed, 4)
        chart, view = robot.map, robot.look()
        assert all(chart.knows(part.start) and chart.knows(part.end) for part in view)
        scene = random_scene(Subject.SIGHTSEER, seed)
        everywhere = xa.isovist(scene, robot.position, robot.radius)
        assert {robot._numbers[part.obstacle] for part in view} == {k for k, _ in everywhere.seen()}

    def test_what_is_incomplete_is_told_without_a_look_at_boundaries(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """A strategy may ask after every move: that must not cost all boundaries each time."""
        robot = wanderer(3)
        left = robot.map.incomplete
        monkeypatch.delattr(Map, "_is_acquired")
        assert left == robot.map.incomplete == tuple(i for i in robot.seen if robot.map.is_incomplete(i))
        assert {i for i, _ in robot.map.frontier} <= {*left}
        with pytest.raises(ValueError, match="no obstacle"):
            robot.map.is_incomplete(99)

    def test_the_map_stays_as_it_was(self) -> None:
        robot = xa.Robot(SQUARES)
        before = robot.map
        robot.go_to((0, 5))
        robot.go_to((20, 5))
        assert before.seen == (0,) and before.known_length() == 2 and robot.map.seen == (0, 1)

    def test_nearest_points(self) -> None:
        chart = xa.Robot(SQUARES).map
        assert chart.nearest(0, (0, 0)) == Point(2, 0) and chart.nearest(0, (0, 9)) == Point(2, 1)

    def test_of_equally_near_points_the_least_is_the_nearest(self) -> None:
        """Of half a disc seen from afar, from its other side; and of a round room, from its centre."""
        half = xa.Scene([xa.Outline([(3, 0, 1), (-3, 0)])], start=(0, 9), radius=30)
        nearest = xa.Robot(half).map.nearest(0, (0, 0))
        assert nearest.x.compare(0) < 0 and nearest.y == 1
        room = xa.Scene([], start=(0, 0), radius=20, enclosure=xa.Circle((0, 0), 9))
        assert xa.Robot(room).nearest([0]) == (0, Point(-9, 0))


class TestPeeking:
    """No public name leads to what was not seen."""

    ALLOWED = (int, float, str, bool, type(None), fmpq, xa.Length, xa.Real, Point, Enum)
    FORBIDDEN = (xa.Scene, Obstacle, EdgeTable, Memory, Map, Link, Links, xa.Terrain)

    def reachable(self, root: object) -> Iterator[object]:
        """All that public attributes, methods without arguments and containers lead to."""
        pending, met = [root], {id(root): root}
        while pending:
            thing = pending.pop()
            yield thing
            if isinstance(thing, (*self.ALLOWED, type)) or callable(thing):
                continue
            for other in _beyond(thing):
                if id(other) not in met:
                    met[id(other)] = other
                    pending.append(other)

    @pytest.mark.parametrize("seed", [1, 4])
    def test_attributes_and_results_lead_to_what_was_seen(self, seed: int) -> None:
        robot = wanderer(seed, 5)
        hidden = [o for o in robot._table.obstacles if o.index not in robot._numbers]
        corners = {edge.start.xy for o in hidden for edge in o.edges}
        for thing in self.reachable(robot):
            assert not isinstance(thing, self.FORBIDDEN), thing
            if isinstance(thing, Point):
                assert thing.xy not in corners
        assert {type(thing).__name__ for thing in self.reachable(robot)} >= {
            "KnownMap",
            "KnownPart",
            "Sighting",
        }

    def test_a_leak_would_be_found(self, monkeypatch: pytest.MonkeyPatch) -> None:
        robot = xa.Robot(SQUARES)
        monkeypatch.setattr(
            type(robot.map), "bodies", property(lambda self: self._of(0)[0].obstacles), raising=False
        )
        assert any(isinstance(thing, self.FORBIDDEN) for thing in self.reachable(robot))

    def test_every_public_name_was_thought_of(self) -> None:
        names = {name for name in dir(xa.Robot) if not name.startswith("_")}
        moves = {"go_to", "go_along", "walk", "walk_to", "circle", "follow", "take_up", "take", "go_back"}
        asks = {
            "radius", "start", "position", "at", "path", "length", "seen", "visited", "map", "frontier",
            "sightings", "look", "links", "nearest_unvisited", "knows_unvisited", "unvisited", "way_to",
            "path_to", "terrain", "in_sight", "incomplete", "nearest", "news", "lay", "way_back", "exits",
            "unvisited_now",
        }  # fmt: skip
        assert names == moves | asks
        assert set(vars(xa.Robot(SQUARES))).isdisjoint(names)

    def test_numbers_say_nothing_of_others(self) -> None:
        """With more obstacles out of sight, before and after it in the scene, a robot tells the same."""
        near = [(5, -1), (7, -1), (6, 1)]
        hidden = [[(x, 50), (x + 1, 50), (x, 51)] for x in (0, 10, 20)]
        scenes = [
            xa.Scene(shapes, start=(0, 0), radius=20) for shapes in ([near], [*hidden, near, hidden[0]][:4])
        ]
        told = []
        for scene in scenes:
            robot = xa.Robot(scene)
            halt = robot.go_to((6, 0))
            halts = [halt, robot.walk(until="acquire"), robot.walk()]
            told.append((repr(robot), repr(robot.map), halts, robot.look(), robot.map.known(0), robot.seen))
        assert told[0] == told[1]

    @pytest.mark.parametrize("number", [1, 2, 5, -1, "O2", None, 0.5])
    def test_what_was_not_seen_and_what_is_not_there_are_one(self, number: object) -> None:
        chart = xa.Robot(
            xa.Scene([[(5, -1), (7, -1), (6, 1)], [(5, 50), (7, 50), (6, 51)]], (0, 0), radius=9)
        ).map
        for ask in (chart.known, lambda i: chart.nearest(i, (0, 0))):
            with pytest.raises(ValueError, match=f"no obstacle {number!r} was seen yet"):
                ask(number)

    def test_places_on_unseen_boundary_are_like_any_other(self) -> None:
        robot = xa.Robot(SQUARES)
        assert [robot.map.knows(p) for p in ((2, 0), (4, 0), (3, 5), (7, 0))] == [True, False, False, False]

    def test_state_cannot_be_set(self) -> None:
        robot = xa.Robot(SQUARES)
        for name in ("position", "at", "radius", "start", "map", "path", "seen", "visited"):
            with pytest.raises(AttributeError):
                setattr(robot, name, None)

    def test_a_boundary_that_goes_on_is_not_told(self) -> None:
        """A long obstacle and a short one that look the same until their far sides are in sight."""
        told = []
        for end in (30, 60):
            box = [(4, -1), (end, -1), (end, 1), (4, 1)]
            robot = xa.Robot(xa.Scene([box], start=(0, 0), radius=3))
            robot.go_to((5, 0))
            told.append((robot.go_to((4, 1)), robot.map.known(0), robot.frontier, robot.look(), repr(robot)))
            with pytest.raises(xa.MoveError) as failed:
                robot.way_to((4, -1))
            told.append((str(failed.value), failed.value.args))
        assert told[:2] == told[2:]


def _beyond(thing: object) -> Iterator[object]:
    if isinstance(thing, Mapping):
        yield from thing.values()
    elif isinstance(thing, (list, tuple, set, frozenset)):
        yield from thing
    elif isinstance(thing, np.ndarray):
        return
    for name in dir(thing):
        if name.startswith("_"):
            continue
        value = getattr(thing, name)
        yield _called(value) if callable(value) else value
    if is_dataclass(thing):
        yield repr(thing)


def _called(method: Callable[..., object]) -> object:
    """What a question without arguments, or about obstacle 0, answers; moves and curves are left alone."""
    if isinstance(method, type) or inspect.isbuiltin(method) or method.__name__ in ("circle", "walk"):
        return None
    if isinstance(
        getattr(method, "__self__", None), (Arc, Segment)
    ):  # It gives curves again, which give curves.
        return None
    needed = [
        p for p in inspect.signature(method).parameters.values()
        if p.default is p.empty and p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)
    ]  # fmt: skip
    given = {0: (), 1: (0,)}.get(len(needed))
    try:
        return None if given is None or method.__name__ == "go_to" else method(*given)
    except (ValueError, TypeError, AttributeError, IndexError, ArithmeticError) as error:
        return error


class TestErrors:
    def test_of_starts_and_radii(self) -> None:
        with pytest.raises(xa.InvalidScene, match="a start point"):
            xa.Robot(xa.Scene([], radius=3))
        with pytest.raises(xa.InvalidScene, match="a radius of vision"):
            xa.Robot(xa.Scene([], start=(0, 0)))
        with pytest.raises(xa.InvalidScene, match="lies inside obstacle"):
            xa.Robot(SQUARES, start=(3, 0))
        crossing = xa.Scene([[(-1, 1), (1, 1), (1, 2)]], start=(3, 3), terrain=xa.Terrain(5, 5), radius=2)
        with pytest.raises(xa.InvalidScene, match="only robots that are confined"):
            xa.Robot(crossing)

    def test_undecided_is_for_good(self, monkeypatch: pytest.MonkeyPatch) -> None:
        robot = xa.Robot(SQUARES)

        def fail(self: Memory, piece: object) -> None:
            raise xa.Undecided("two numbers")

        with monkeypatch.context() as patch:
            patch.setattr(Memory, "walk", fail)
            with pytest.raises(xa.Undecided):
                robot.go_to((0, 1))
        with pytest.raises(xa.Undecided):
            robot.go_to((0, 2))


def test_arcs_end_where_they_are_cut() -> None:
    robot = xa.Robot(xa.Scene([xa.Circle((5, 0), 2)], start=(0, 0), radius=4))
    robot.go_to((5, 0))
    robot.walk("right", to=(5, 2))
    (_, piece) = robot.path
    assert isinstance(piece.curve, Arc) and not piece.curve.ccw and piece.obstacle == 0
    assert robot.length == xa.Length.turns(1) / 2 + 3 or robot.length == 3 + xa.Length.turns("1/4") * 2


SQUARE = xa.Polygon([(0, 0), (2, 0), (2, 2), (0, 2)])
HALF_FROM_NORTH = xa.Outline([(0, 1, xa.Around((0, 0))), (0, -1, xa.Around((0, 0)))])
HALF_FROM_EAST = xa.Outline([(1, 0, xa.Around((0, 0))), (-1, 0, xa.Around((0, 0)))])


@pytest.mark.parametrize(
    ("obstacles", "start", "goal", "hand", "place"),
    [
        ([SQUARE, xa.Polygon([(4, 0), (5, 0), (5, 1), (4, 1)])], (3, 1), (2, 1), "left", (2, 2)),
        ([HALF_FROM_NORTH, xa.Circle((4, 0), 1)], (2, 0), (1, 0), "left", (0, 1)),
        ([HALF_FROM_EAST, xa.Circle((4, 0), 1)], (2, 0), (1, 0), "left", (0, 1)),
        ([xa.Circle((0, 0), 1), xa.Circle((0, 4), 1)], (0, 2), (0, 1), "right", (1, 0)),
        ([HALF_FROM_NORTH, xa.Circle((0, 4), 1)], (0, 2), (0, 1), "right", (1, 0)),
    ],
    ids=["corner", "joint of arcs", "inside an arc", "start of a circle", "arc"],
)
def test_a_walk_halts_where_an_edge_begins_as_it_does_inside_one(
    obstacles: list[object], start: object, goal: object, hand: str, place: object
) -> None:
    """What is in sight up to the end of an edge is lost as the next one begins, however edges are drawn."""
    robot = xa.Robot(xa.Scene(obstacles, start=start, radius=20))
    robot.go_to(goal)
    halt = robot.walk(hand, until="lose")
    assert halt.kind == "event"
    assert halt.place == xa.Point(*place)
    assert robot.position == halt.place
    # It goes on from there: the same place does not count again.
    assert robot.walk(hand, until="lose").kind != "event" or robot.position != halt.place
    assert robot.walk(hand).kind == "round"


def test_a_straight_way_halts_at_a_corner_that_it_touches() -> None:
    wall = xa.Polygon([(2, -1), (4, -1), (4, 0), (2, 0)])
    low = xa.Polygon([(1, -4), (5, -4), (5, -3), (1, -3)])
    robot = xa.Robot(xa.Scene([wall, low], start=(0, 0), radius=20))
    halt = robot.go_to((8, 0), until="lose")
    assert (halt.kind.value, halt.place) == ("event", xa.Point(2, 0))
    assert robot.go_to((8, 0), until="regain").kind == "event"
