"""Moves of robots: just past sightings, all around, along paths; and what is told of slips."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from random import Random

import pytest

import exactacq as xa
from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.study.random_scenes import Subject, random_scene

SQUARES = xa.Scene(
    [[(2, -1), (4, -1), (4, 1), (2, 1)], [(7, -1), (9, -1), (9, 1), (7, 1)]], start=(0, 0), radius=20
)
SIGHTS = ("sight", "regain", "acquire", "lose")


@pytest.mark.parametrize("seed", range(40))
def test_just_past_a_sighting_nothing_else_has_happened_and_numbers_are_short(seed: int) -> None:
    scene = random_scene(Subject.SIGHTSEER, seed)
    rng = Random(seed)
    goal, kinds, hand = (
        (rng.randint(-9, 9), rng.randint(-9, 9)),
        SIGHTS[seed % 4],
        rng.choice(["left", "right"]),
    )
    exact, past = xa.Robot(scene), xa.Robot(scene)
    at = exact.go_to(goal, until=kinds)
    short = past.go_to(goal, until=kinds, just_past=True)
    if at.kind == "hit":
        at, short = exact.walk(hand, until=kinds), past.walk(hand, until=kinds, just_past=True)
    assert (short.kind, short.obstacle, short.sighting) == (at.kind, at.obstacle, at.sighting)
    # What is in sight up to the very place of the sighting is lost beyond it.
    told = len(exact.sightings)
    assert past.sightings[:told] == exact.sightings
    assert all(later.kind == "lose" and later.place == at.place for later in past.sightings[told:])
    if at.kind == "event" and at.place.rational is None:
        assert short.place.rational is not None
        assert exact.length.compare(past.length) < 0


def test_moves_just_past_sightings_end_at_the_goal_and_at_corners_too() -> None:
    robot = xa.Robot(SQUARES)
    halt = robot.go_to((20, 0), until="sight", just_past=True)
    assert (halt.kind, halt.place) == ("hit", Point(2, 0))
    halt = robot.walk(until="acquire", just_past=True)
    assert halt.kind == "event" and halt.place == halt.sighting.place == Point(4, 1)


def test_on_the_way_that_it_came_a_robot_looks_out_too() -> None:
    """What is seen there is known, in other forms of the same numbers: that these are equal was undecided."""
    bay = xa.Outline([(3, 4), (3, 2, 1), (1, 2), (1, 4)])
    lens = xa.Outline([(2, 6, "1/5"), (1, 6), (1, 8), (2, 8)])
    robot = xa.Robot(xa.Scene([bay, lens], terrain=xa.Terrain(3, 12), radius=3), confined=True)
    robot.go_to(robot.frontier[0][1])
    assert robot.length == 3 and robot.go_to((0, 0), until="lose").kind == "arrived"


@pytest.mark.parametrize("past", [False, True])
def test_on_the_way_that_it_came_a_robot_halts(past: bool) -> None:
    """The parts of that way, too, show what is known, also to whoever reads the run from a file."""

    def out_and_back(robot: xa.Robot) -> None:
        robot.go_to(robot.frontier[0][1])
        while robot.go_to(robot.start, until=SIGHTS, just_past=past).kind == "event":
            pass
        assert robot.position == robot.start

    run = xa.explore(random_scene(Subject.SIGHTSEER, 64), out_and_back)
    assert len(run.path) > 2
    assert xa.load_run(run.to_json()).map.known_length() == run.map.known_length()


@pytest.mark.parametrize("past", [False, True])
def test_a_walk_is_round_though_something_happens_just_there(past: bool) -> None:
    """The last of a disc is seen where the lap ends; there a second lap began, and so on for ever."""
    robot = xa.Robot(xa.Scene([xa.Circle((5, 0), 2)], start=(3, 0), radius=20))
    robot.go_to((3, 0))
    kinds = [robot.walk(until="acquire", just_past=past).kind.value for _ in range(3)]
    assert kinds == ["event", "round", "round"]
    assert robot.length == xa.Length.turns(4) and robot.visited == (0,)


@pytest.mark.parametrize("seed", range(30))
def test_walks_all_around_end(seed: int) -> None:
    """However often they are stopped, one lap is as long as the boundary."""
    robot = xa.Robot(random_scene(Subject.SIGHTSEER, seed))
    if not robot.seen:
        return
    halt = robot.go_to(robot.map.nearest(0, robot.position))
    hand = "left" if seed % 2 else "right"
    if halt.obstacle is not None:
        way = robot.length
        for _ in range(400):
            if robot.walk(hand, until=SIGHTS, just_past=seed % 3 == 0).kind == "round":
                break
        perimeter = random_scene(Subject.SIGHTSEER, seed).obstacles[robot._numbers[halt.obstacle]].perimeter
        assert robot.length - way == perimeter


FAR = 10**200
BOXES = ((0, 0), None, "abcd", (0, 0, float("nan"), 1), (1, 0, 0, 1))


@pytest.mark.parametrize(
    ("ask", "error", "text"),
    [
        (lambda r: r.go_to((0, FAR)), xa.MoveError, "too far away: coordinates lie within 10^100"),
        (lambda r: r.lay([(0, 0), (-1e308, 0)]), xa.MoveError, "too far away"),
        (lambda r: r.path_to((0, FAR)), xa.MoveError, "too far away"),
        (lambda r: r.go_to((0, 1), until=None), ValueError, "looks out for sight, .* not for None"),
        (lambda r: r.go_to((0, 1), until=5), ValueError, "not for 5"),
        (
            lambda r: r.follow(r.lay([(0, 0), (0, 5)]), watch=lambda _: True),
            xa.MoveError,
            "answers with a point",
        ),
        (lambda r: r.follow(r.lay([(0, 0), (0, 5)]), watch=lambda _: (7, 7)), xa.MoveError, "not on the way"),
        (
            lambda r: r.take_up(r.lay([(0, 0), (3, 0)]), None),
            xa.MoveError,
            "an exit is what robot.exits gives",
        ),
        (lambda r: r.news(5), xa.MoveError, "a route is what robot.lay"),
        (lambda r: r.news(xa.Robot(SQUARES).lay([(0, 0)])), xa.MoveError, "that of another robot"),
        (lambda r: r.map.known([0]), ValueError, r"no obstacle \[0\] was seen"),
        (lambda r: r.map.known(0.0), ValueError, "no obstacle 0.0 was seen"),
        (lambda r: r.go_to((0, 1), until=[[1]]), ValueError, r"not for \[1\]"),
        *((lambda r, b=box: r.map.known_in(b), ValueError, "a box is") for box in BOXES),
    ],
)
def test_slips_are_told_in_words(
    ask: Callable[[xa.Robot], object], error: type[Exception], text: str
) -> None:
    robot = xa.Robot(SQUARES)
    with pytest.raises(error, match=text.replace("^", r"\^")):
        ask(robot)


def test_slips_at_a_boundary_are_told_as_what_they_are() -> None:
    """Each of them was told to be no way along the boundary."""
    robot = xa.Robot(SQUARES)
    robot.go_to((2, 0))
    for ask in (robot.walk_to, robot.way_to):
        with pytest.raises(xa.MoveError, match=r"^parts of obstacle 0 are unknown"):
            ask((4, 0))
        with pytest.raises(xa.FormatError, match=r"^a point needs two numbers"):
            ask("here")


def test_a_robot_that_stays_hits_nothing_once_more() -> None:
    def stay(robot: xa.Robot) -> None:
        for goal in ((2, 0), (2, 0), (5, 0), (2, 0)):
            robot.go_to(goal)

    run = xa.explore(SQUARES, stay)
    assert [event.kind.value for event in run.events] == ["start", "sight", "hit", "stop"]


def test_a_watch_may_answer_with_coordinates() -> None:
    robot = xa.Robot(SQUARES)
    assert robot.follow(robot.lay([(0, 0), (0, 5)]), watch=lambda _: (0, 2)).place == Point(0, 2)


def test_no_path_leads_into_an_obstacle_whatever_its_number_is() -> None:
    robot = xa.Robot(xa.Scene([xa.Circle((5, 0), 2), xa.Circle((0, 9), 2)], start=(0, 0), radius=20))
    robot.go_to((0, 9))
    robot.circle()
    with pytest.raises(xa.MoveError, match=r"^no path: the point \(0, 9\) lies inside an obstacle"):
        robot.path_to((0, 9))


def test_after_a_lap_the_next_one_begins() -> None:
    """Whether it was stopped just where it ended or not; and a walk to a place leads there."""
    robot = xa.Robot(SQUARES)
    robot.go_to((2, 0))
    assert [robot.walk().kind.value for _ in range(3)] == ["round"] * 3 and robot.length == 2 + 3 * 8
    again = xa.Robot(xa.Scene([xa.Circle((5, 0), 2)], start=(3, 0), radius=20))
    again.go_to((3, 0))
    assert again.walk(until="acquire").kind == "event"
    assert again.walk(to=(7, 0)).kind == "arrived" and again.position == Point(7, 0)


@pytest.mark.parametrize(
    "slip",
    [
        lambda r: r.walk_to((4, 0)),
        lambda r: r.walk("left", to=(4, 0), reason=7),
        lambda r: r.walk("right", reason=7),
        lambda r: r.follow(r.lay([r.position])),
    ],
)
def test_a_lap_goes_on_after_what_did_not_move_the_robot(slip: Callable[[xa.Robot], object]) -> None:
    robot = xa.Robot(SQUARES)
    robot.go_to((2, 0))
    robot.walk("left", to=(2, -1))
    with suppress(ValueError):
        slip(robot)
    assert robot.walk("left").kind == "round" and robot.position == Point(2, 0) and robot.length == 10


def test_parts_have_the_numbers_of_their_obstacles_however_these_are_asked_for() -> None:
    known = xa.Robot(SQUARES).map
    assert known.known(False)[0].obstacle is not False and type(known.known(0)[0].obstacle) is int


class TestPaths:
    def test_lead_around_what_is_known_and_end_at_what_is_not(self) -> None:
        robot = xa.Robot(xa.load("circles"))
        robot.take(robot.nearest_unvisited())
        robot.circle()
        way, path = robot.length, robot.path_to((12, 1))
        assert any(isinstance(piece, Arc) for piece in path.path)
        halt = robot.go_along(path)
        assert halt.kind == "hit" and halt.obstacle == 1 and robot.length - way < path.length
        robot.circle()
        goal = robot.path_to((20, 0))
        way = robot.length
        assert robot.go_along(goal).kind == "arrived" and robot.length - way == goal.length
        assert robot.position == Point(20, 0) and robot.go_along(robot.path_to((20, 0))).kind == "arrived"

    def test_halt_where_something_happens(self) -> None:
        robot = xa.Robot(xa.load("circles"), radius=5)
        halt = robot.go_along(robot.path_to((0, 5)), until="lose")
        assert (halt.kind.value, str(halt.place)) == ("event", "(0, 2*sqrt(6))")
        past = xa.Robot(xa.load("circles"), radius=5)
        halt = past.go_along(past.path_to((0, 5)), until="lose", just_past=True)
        assert halt.kind == "event" and halt.place.rational is not None

    def test_lead_on_from_where_a_lap_ends(self) -> None:
        robot = xa.Robot(xa.Scene([xa.Circle((5, 0), 2)], start=(0, 0), radius=20))
        robot.go_to((3, 0))
        robot.walk(until="acquire")
        path = robot.path_to((4, -6))
        assert isinstance(path.path[0], Arc) and path.path[0].passes(Point(3, 0))
        assert robot.go_along(path).kind == "arrived" and robot.position == Point(4, -6)

    def test_lead_along_a_hollow_arc_that_is_known_from_the_other_side(self) -> None:
        """What of its inside is unknown counts as free: the robot walked the long way to where it is not."""
        hollow = xa.Outline([(0, 1, "-1/5"), (3, 1), (3, 2), (0, 2)])
        robot = xa.Robot(xa.Scene([hollow], start=(5, -3), radius=20))
        path = robot.path_to((1, "13/10"))
        straight, arc, _ = path.path
        assert isinstance(arc, Arc) and not arc.ccw
        assert robot.go_along(path).kind == "hit"
        assert robot.position == arc.end and robot.length == straight.length + arc.length

    def test_lead_along_boundaries_that_a_border_cuts(self) -> None:
        scene = xa.Scene([xa.Circle((4, 0), 2)], terrain=xa.Terrain(8, 8), radius=9)
        robot = xa.Robot(scene, confined=True)
        robot.go_to((4, 0))
        robot.circle()
        path = robot.path_to((0, 0))
        assert any(isinstance(piece, Arc) for piece in path.path)
        before = robot.length
        assert robot.go_along(path).kind == "arrived" and robot.length - before == path.length

    def test_lead_on_along_the_boundary_of_a_start(self) -> None:
        robot = xa.Robot(xa.Scene([xa.Circle((5, 0), 2)], start=(3, 0), radius=20))
        way = robot.take(robot.nearest_unvisited())
        robot.circle()
        robot.go_back(way)
        path = robot.path_to((7, 0))
        assert robot.at is None and robot.go_along(path).kind == "arrived" and robot.at == 0

    def test_begin_where_the_robot_is(self) -> None:
        robot = xa.Robot(SQUARES)
        path = robot.path_to((0, 3))
        with pytest.raises(xa.MoveError, match="a path is what"):
            robot.go_along([(0, 0), (0, 3)])
        robot.go_to((0, 1))
        with pytest.raises(xa.MoveError, match="begins elsewhere"):
            robot.go_along(path)

    def test_keep_to_the_boundary_where_the_robot_is(self) -> None:
        walls = xa.Circle((4, 0), 1), xa.Polygon([(3, -2), (5, -2), (5, 2), (3, 2)])
        around, other = (xa.Robot(xa.Scene([wall], start=(0, 0), radius=20)) for wall in walls)
        around.go_to((3, 0))
        around.circle()
        other.go_to((3, 0))
        with pytest.raises(xa.MoveError, match="is not on the boundary"):
            other.go_along(around.path_to((6, 0)))
