"""Routes and what watches them, robots that are confined to a terrain, and what maps tell of places."""

from __future__ import annotations

from itertools import pairwise
from random import Random

import pytest
from flint import fmpq
from nightly import some
from test_robot import SQUARES, TestPeeking

import exactacq as xa
from exactacq.geometry.box_index import box
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Location, Point
from exactacq.scene.scene import Scene
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.strategies.moves import HaltKind, Passage
from exactacq.strategies.routes import Route
from exactacq.study.random_scenes import Subject, random_scene

SHORE = Scene(
    [[(3, 0), (5, 0), (5, 4), (3, 4)], [(7, 6), (8, 6), (8, 7)]], terrain=xa.Terrain(9, 9), radius=6
)
"""One obstacle stands on the border."""


def corner_to_corner(robot: xa.Robot, rng: Random) -> Route:
    """A route through three random free places of a scene, from where the robot is."""
    obstacles = robot._table.obstacles
    places = (Point(rng.randint(-12, 12), rng.randint(-12, 12)) for _ in range(200))
    free = [p for p in places if all(o.locate(p) is Location.OUTSIDE for o in obstacles)][:3]
    return robot.lay([robot.position, *free])


def told_by(passages: list[Passage]) -> list[tuple[object, ...]]:
    return [(p.sighting.kind, p.sighting.obstacle, p.place.xy) for p in passages if p.sighting is not None]


class TestRoutes:
    @pytest.mark.parametrize("seed", some(range(40), 12))
    def test_lead_around_all_that_blocks_them(self, seed: int) -> None:
        """As Bug 2 goes, but all around: it hits what `go_to` hits, and comes to its end or to a trap."""
        rng, robot = Random(seed), xa.Robot(random_scene(Subject.SIGHTSEER, seed))
        other = xa.Robot(random_scene(Subject.SIGHTSEER, seed))
        if any(o.locate(robot.start) is not Location.OUTSIDE for o in robot._table.obstacles):
            return
        route = corner_to_corner(robot, rng)
        first = other.go_to(route.pieces[0].end) if route.pieces else None
        halt = robot.follow(route)
        if first is not None:
            assert (halt.kind, halt.obstacle, halt.place) == (first.kind, first.obstacle, first.place)
        for _ in range(60):
            if halt.kind is HaltKind.HIT:
                robot.circle()
                place = next(robot.exits(route, halt.obstacle), None)
                if place is None:
                    return
                robot.take_up(route, place)
                assert robot.position == place.point and route.piece == place.piece
            elif not route.turn():
                assert robot.position == route.end
                break
            halt = robot.follow(route)
        assert sorted(robot.visited) == sorted(set(robot.visited))

    def test_and_the_same_way_back(self) -> None:
        robot = xa.Robot(SQUARES)
        route = robot.lay([(0, 0), (0, 3), (6, 3), (6, -3)])
        for _ in range(2):
            robot.follow(route)
            route.turn()
        robot.follow(route)
        back = robot.way_back(route)
        while robot.follow(back).kind == "arrived" and back.turn():
            pass
        assert robot.position is robot.start
        out, home = robot.path[:3], robot.path[3:]
        assert [(p.start, p.end) for p in home] == [(p.end, p.start) for p in reversed(out)]

    def test_back_from_behind_an_obstacle(self) -> None:
        """The points of the way out again: not equal ones, the same ones."""
        robot = xa.Robot(xa.Scene([xa.Circle((5, 1), 2)], start=(0, 0), radius=20))
        route = robot.lay([(0, 0), (9, 2)])
        enters = robot.follow(route).place
        robot.circle()
        (leave,) = robot.exits(route, 0)
        robot.take_up(route, leave)
        assert robot.follow(route).kind == "arrived"
        back = robot.way_back(route)
        assert robot.follow(back).place is leave.point
        (home,) = robot.exits(back, 0)
        assert home.point is enters

    def test_that_turn_within_an_obstacle(self) -> None:
        """Or end in it; a route that ends in the wall touches it, and that is free."""
        robot = xa.Robot(SQUARES)
        for ends, places in (
            ([(3, 0), (3, 9)], [(1, (3, 1))]),
            ([(3, 0)], []),
            ([(3, 0), (3, 1)], [(1, (3, 1))]),
        ):
            route = robot.lay([robot.position, *ends])
            halt = robot.follow(route)
            assert (halt.kind, halt.place) == (HaltKind.HIT, Point(2, 0))
            robot.circle()
            found = [(place.piece, place.point) for place in robot.exits(route, 0)]
            assert found == [(piece, Point(*point)) for piece, point in places]
            robot.go_to((0, 0))

    def test_of_no_length(self) -> None:
        robot = xa.Robot(SQUARES)
        route = robot.lay([(0, 0), (0, 0)])
        assert route.pieces == () and route.end == Point(0, 0)
        assert robot.follow(route).kind == "arrived" and not route.turn() and len(robot.path) == 0

    def test_stay_at_their_end(self) -> None:
        """Each call counted as one more piece."""
        robot = xa.Robot(SQUARES)
        route = robot.lay([(0, 0), (0, 4)])
        robot.follow(route)
        assert not route.turn() and not route.turn() and route.piece == 1
        assert robot.follow(route).place == Point(0, 4)

    def test_are_written_as_other_moves_are(self) -> None:
        def along(robot: xa.Robot) -> None:
            route = robot.lay([(0, 0), (20, 0)])
            while (halt := robot.follow(route)).kind == "hit":
                robot.circle()
                robot.take_up(route, next(robot.exits(route, halt.obstacle)))

        run = xa.explore(SQUARES, along)
        kinds = [event.kind.value for event in run.events if event.obstacle is not None]
        assert [kind for kind in kinds if kind in ("hit", "leave")] == ["hit", "leave", "hit", "leave"]
        xa.audit(run, samples=4)

    def test_are_for_their_robot_and_its_place(self) -> None:
        robot, other = xa.Robot(SQUARES), xa.Robot(SQUARES)
        route = robot.lay([(0, 0), (20, 0)])
        for ask in (
            lambda: other.follow(route),
            lambda: other.way_back(route),
            lambda: other.exits(route, 0),
        ):
            with pytest.raises(xa.MoveError, match="another robot"):
                ask()
        with pytest.raises(xa.MoveError, match=r"a route is what robot\.lay or robot\.way_back gives, not "):
            robot.follow([(0, 0), (20, 0)])  # type: ignore[arg-type]
        for places in ([(1, 0), (2, 0)], []):
            with pytest.raises(xa.MoveError, match="begins where the robot is"):
                robot.lay(places)
        with pytest.raises(xa.MoveError, match="not at the end of this piece"):
            route.turn()
        robot.go_to((0, 5))
        with pytest.raises(xa.MoveError, match="not on the route"):
            robot.follow(route)
        robot.go_to((0, 0))
        robot.follow(route)
        with pytest.raises(xa.MoveError, match="parts of obstacle 0 are unknown"):
            robot.exits(route, 0)
        with pytest.raises(ValueError, match="no obstacle 2 was seen"):
            robot.exits(route, 2)
        robot.circle()
        (place,) = robot.exits(route, 0)
        robot.take_up(route, place)
        with pytest.raises(xa.MoveError, match="not ahead"):
            robot.take_up(route, place)
        with pytest.raises(xa.MoveError, match="not one of this route"):
            robot.take_up(robot.lay([robot.position, (20, 0)]), place)


class TestWatching:
    @pytest.mark.parametrize("seed", some(range(60), 15))
    def test_shows_what_is_seen_where_it_is_seen(self, seed: int) -> None:
        """Against a robot that walks just as far as each place, and against the sightings."""
        scene = random_scene(Subject.SIGHTSEER, seed)
        robot, shown = xa.Robot(scene), []
        if any(o.locate(robot.start) is not Location.OUTSIDE for o in scene.obstacles):
            return
        route = corner_to_corner(robot, Random(seed))

        def see(passage: Passage) -> None:
            known = passage.map.known_length(), passage.map.seen, passage.map.incomplete
            shown.append((passage, known, tuple(map(passage.map.known_length, passage.map.seen))))

        before = len(robot.sightings)
        robot.follow(route, watch=see)
        assert shown[0][0].sighting is None and shown[0][0].place == robot.start
        passages = [passage for passage, *_ in shown]
        assert [p.sighting for p in passages[1:]] == list(robot.sightings[before:])
        for passage, (length, seen, incomplete), each in shown[1:][:: max(1, len(shown) // 3)]:
            there = Memory(scene, robot.radius)
            there.begin(robot.start)
            if passage.place != robot.start:
                way = Segment(robot.start, passage.place)
                for part in there.parts(way):
                    there.walk(Piece("straight", None, part))
            chart = there.now
            assert length == chart.known_length() == xa.Length.sum(each)
            own = robot._numbers
            assert {own[i] for i in seen} >= set(chart.seen)
            assert {own[i] for i in incomplete if i in seen} == set(chart.incomplete)

    def test_halts_where_it_says(self) -> None:
        robot = xa.Robot(xa.Scene([xa.Circle((10, 0), 2)], start=(0, 0), radius=5))
        halt = robot.follow(robot.lay([(0, 0), (20, 0)]), watch=lambda passage: Point("7/2", 0))
        assert (halt.kind, halt.place, halt.obstacle) == (HaltKind.STOPPED, Point("7/2", 0), None)
        assert [s.place for s in robot.sightings] == [Point(3, 0)]

    @pytest.mark.parametrize("asked", [Point(3, 0), Point(2, 0), Point(0, 0)])
    def test_that_says_before_what_comes_is_not_told_of_it(self, asked: Point) -> None:
        """What is at the place itself is told; the robot is where it said, and knows no more than there."""
        robot, shown = xa.Robot(xa.Scene([xa.Circle((10, 0), 2)], start=(0, 0), radius=5)), []
        halt = robot.follow(robot.lay([(0, 0), (20, 0)]), watch=lambda p: shown.append(p) or asked)
        assert halt.kind == "stopped" and halt.place == robot.position == asked
        assert len(shown) == (2 if asked == Point(3, 0) else 1)
        assert robot.seen == ((0,) if asked == Point(3, 0) else ())

    def test_may_think_again(self) -> None:
        robot = xa.Robot(xa.Scene([xa.Circle((10, 9), 5)], start=(0, 0), radius=6))
        places = []

        def on(passage: Passage) -> Point | None:
            places.append(passage.place)
            return Point(19, 0) if passage.sighting is None or passage.sighting.kind == "sight" else None

        assert robot.follow(robot.lay([(0, 0), (20, 0)]), watch=on).kind == "arrived"
        assert len(places) == 3

    @pytest.mark.parametrize("end", [(0, 20), (20, 0), (-12, 9)])
    def test_of_ways_in_all_directions(self, end: tuple[int, int]) -> None:
        far = Point(*end)
        robot = xa.Robot(xa.Scene([xa.Circle((far.x * 2, far.y * 2), 1)], start=(0, 0), radius=5))
        halt = robot.follow(robot.lay([(0, 0), far]), watch=lambda _: far * fmpq(1, 3))
        assert halt.kind == "stopped" and robot.position == far * fmpq(1, 3)

    def test_cannot_move_the_robot_or_go_back_in_time(self) -> None:
        scene = xa.Scene([xa.Circle((10, 0), 2)], start=(0, 0), radius=5)
        robot, kept = xa.Robot(scene), []
        wrong = {
            "is underway": lambda passage: robot.go_to((0, 1)),
            "has passed": lambda passage: Point(1, 0) if passage.sighting else None,
            "is not on the way": lambda passage: Point(1, 1),
        }
        for words, watch in wrong.items():
            with pytest.raises(xa.MoveError, match=words):
                robot.follow(robot.lay([robot.position, (20, 0)]), watch=watch)
            assert robot.position == Point(0, 0) and robot.seen == () and robot.map.seen == ()
        robot.follow(robot.lay([(0, 0), (20, 0)]), watch=kept.append)
        assert kept[0].map.seen == ()
        with pytest.raises(xa.MoveError, match="has passed the place of this map"):
            kept[1].map.known_length()

    def test_that_fails_on_the_way_leaves_the_robot_where_it_is(self) -> None:
        """It had gone to the second wall's corner, and was taken to be still at the first one."""
        walls = [
            xa.Polygon([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]) for x, y in ((2, 0), (5, 0), (8, 2))
        ]
        robot = xa.Robot(xa.Scene(walls, start=(0, 0), radius=3))
        robot.go_to((2, 0))
        route = robot.lay([(2, 0), (10, 0)])
        with pytest.raises(xa.MoveError, match="is not on the way"):
            robot.follow(route, watch=lambda passage: (0, 9) if passage.place.x.compare(5) > 0 else None)
        assert robot.position == Point(5, 0) and robot.at is None
        with pytest.raises(xa.MoveError, match="it only touches one"):
            robot.circle()
        assert robot.follow(route).kind == "arrived" and robot.position == Point(10, 0)

    @pytest.mark.parametrize("seed", some(range(30), 8))
    def test_tells_nothing_of_what_comes(self, seed: int) -> None:
        """Until it halts a robot is told the same where obstacles beyond what it sees there are left out."""
        scene, told = random_scene(Subject.SIGHTSEER, seed), []
        robot = xa.Robot(scene)
        if any(o.locate(robot.start) is not Location.OUTSIDE for o in scene.obstacles):
            return
        route = corner_to_corner(robot, Random(seed))
        if not route.pieces:
            return
        half = route.pieces[0].point(fmpq(1, 2))
        reach = float(robot.radius) + 1
        x, y, right, top = box(Segment(robot.start, half))
        near = [
            shape for o, shape in zip(scene.obstacles, scene.shapes, strict=False)
            if any(_meets(box(e), (x - reach, y - reach, right + reach, top + reach)) for e in o.edges)
        ]  # fmt: skip
        for shapes in (scene.shapes, near):
            robot, passages = (
                xa.Robot(Scene(shapes, scene.start, radius=scene.radius, enclosure=scene.enclosure)),
                [],
            )
            route = robot.lay([robot.position, route.pieces[0].end])
            halt = robot.follow(route, watch=lambda p, to=passages: to.append(p) or half)
            told.append((halt.place.xy, halt.kind, told_by(passages), repr(robot), robot.map.known_length()))
        assert told[0] == told[1]


def _meets(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


class TestConfined:
    def test_knows_its_border_and_starts_in_the_corner(self) -> None:
        robot = xa.Robot(SHORE, confined=True)
        assert robot.terrain == SHORE.terrain and robot.position == Point(0, 0)
        assert xa.Robot(SQUARES).terrain is None
        for scene, words in (
            (SQUARES, "needs a terrain"),
            (SHORE.replace(start=(1, 1)), "SW corner"),
            (
                Scene([[(-1, -1), (1, -1), (1, 1)]], terrain=xa.Terrain(4, 4), radius=1),
                "covers the SW corner",
            ),
        ):
            with pytest.raises(xa.InvalidScene, match=words):
                xa.Robot(scene, confined=True)
        with pytest.raises(xa.InvalidScene, match="meets the terrain's border"):
            xa.Robot(SHORE, start=(0, 0))

    def test_keeps_within(self) -> None:
        robot = xa.Robot(SHORE, confined=True)
        for ask in (lambda: robot.go_to((0, 10)), lambda: robot.lay([(0, 0), (-1, 5)])):
            with pytest.raises(xa.MoveError, match="beyond the border"):
                ask()
        assert robot.go_to((0, 9)).kind == "arrived" and robot.go_to((9, 9)).kind == "arrived"

    def test_walks_boundaries_from_end_to_end(self) -> None:
        robot = xa.Robot(SHORE, confined=True)
        halt = robot.go_to((9, 2))
        assert (halt.kind, halt.place, halt.obstacle) == (HaltKind.HIT, Point(3, "2/3"), robot.at)
        with pytest.raises(xa.MoveError, match="the border cuts this boundary"):
            robot.walk()
        robot.circle()
        assert robot.position == Point(5, 0) and robot.at in robot.visited
        assert robot.map.acquired and robot.map.known_length(robot.at) == 10
        robot.circle()
        assert robot.position == Point(3, 0) and robot.way_to((5, 0)) == (xa.Length(10), "right")

    def test_a_blocked_corner_of_a_route(self) -> None:
        """The route turns within an obstacle: it goes on where it comes out, on a later piece."""
        scene = Scene([[(3, -1), (10, -1), (10, 5), (3, 5)]], terrain=xa.Terrain(9, 9), radius=20)
        robot = xa.Robot(scene, confined=True)
        route = robot.lay([(0, 0), (0, 3), (9, 3), (9, 9)])
        robot.follow(route)
        route.turn()
        halt = robot.follow(route)
        assert (halt.kind, halt.place) == (HaltKind.HIT, Point(3, 3))
        robot.circle()
        (place,) = robot.exits(route, halt.obstacle)
        assert (place.piece, place.point) == (2, Point(9, 5))
        robot.take_up(route, place)
        assert robot.follow(route).kind == "arrived" and robot.position == Point(9, 9)

    def test_news_of_an_edge_that_the_border_cuts_in_two(self) -> None:
        """Of an arch that stands out of the terrain two parts are left; the second one is out of range."""
        arch = xa.Outline([(18, 5, 1), (6, 5, 0), (7, 5, -1), (17, 5, 0)])
        robot = xa.Robot(Scene([arch], terrain=xa.Terrain(24, 9), radius=7), confined=True)
        robot.go_to((0, 5))
        assert len(robot._ground.components) == 2
        assert robot.seen == (0,) and robot.news() == {0} and robot.in_sight == {0}

    def test_knows_no_links(self) -> None:
        robot = xa.Robot(SHORE, confined=True)
        for ask in (robot.links, robot.nearest_unvisited):
            with pytest.raises(xa.MoveError, match="knows no links"):
                ask(None)

    @pytest.mark.parametrize("seed", some(range(12), 3))
    def test_leads_to_nothing_unseen(self, seed: int) -> None:
        """But to the terrain, which it knows."""
        robot = xa.Robot(random_scene(Subject.SEED_SPREADER, seed), confined=True)
        west, south, east, north = robot.terrain.limits
        route, peeping, found = robot.lay([(west, south), (west, north), (east, north)]), TestPeeking(), []
        halt = robot.follow(route, watch=lambda passage: found.extend(peeping.reachable(passage)))
        told = [robot, route, halt, robot.way_back(route)]
        if halt.kind is HaltKind.HIT:
            robot.circle()
            told.append(list(robot.exits(route, halt.obstacle)))
        forbidden = tuple(kind for kind in peeping.FORBIDDEN if kind is not xa.Terrain)
        hidden = [o for o in robot._table.obstacles if not _is_seen(robot, o.index)]
        corners = {edge.start.xy for o in hidden for edge in o.edges} - {c.xy for c in robot.terrain.corners}
        for thing in (*found, *(thing for root in told for thing in peeping.reachable(root))):
            assert not isinstance(thing, forbidden), thing
            assert not (isinstance(thing, Point) and thing.xy in corners), thing


def _is_seen(robot: xa.Robot, obstacle: int) -> bool:
    seen = {robot._ground.components[k].obstacle.index for k in robot._numbers}
    return obstacle in seen


class TestQuestions:
    @pytest.mark.parametrize("seed", some(range(30), 8))
    def test_what_is_known_about_a_place(self, seed: int) -> None:
        rng, robot = Random(seed), xa.Robot(random_scene(Subject.SIGHTSEER, seed))
        robot.go_to((rng.randint(-9, 9), rng.randint(-9, 9)))
        chart = robot.map
        parts = [part for i in chart.seen for part in chart.known(i)]
        for _ in range(6):
            x, y = rng.randint(-9, 9), rng.randint(-9, 9)
            window = (x, y, x + rng.randint(0, 6), y + rng.randint(0, 6))
            found = chart.known_in(window)
            assert len(found) == len(set(map(str, found)))
            straight = [p for p in parts if isinstance(p.curve, Segment)]
            expected = {str(p) for p in straight if _meets(box(p.curve), window)}
            got = {str(p) for p in found if isinstance(p.curve, Segment)}
            assert got <= {str(p) for p in parts} and got == expected
            assert {p.obstacle for p in chart.known_in(window, but=chart.seen)} == set()
            for i in chart.seen:
                ends = [p.start.x for p in chart.known(i)] + [p.end.x for p in chart.known(i)]
                assert chart.lies_west(i, x) >= (min(ends) < x)
                if all(isinstance(p.curve, Segment | None) for p in chart.known(i)):
                    assert chart.lies_west(i, x) == (min(ends) < x)
        now = robot._walker.memory.now
        assert robot.incomplete == set(chart.incomplete)
        assert {robot._numbers[i] for i in chart.incomplete} == set(now.incomplete)
        assert all(chart.is_incomplete(i) is now.is_incomplete(robot._numbers[i]) for i in chart.seen)

    @pytest.mark.parametrize("seed", some(range(30), 8))
    def test_in_sight_and_nearest(self, seed: int) -> None:
        rng, robot = Random(seed), xa.Robot(random_scene(Subject.SIGHTSEER, seed))
        for _ in range(3):
            robot.go_to((rng.randint(-9, 9), rng.randint(-9, 9)))
            assert robot.in_sight == {part.obstacle for part in robot.look()} & robot.incomplete
            assert all(robot.look(i) == tuple(p for p in robot.look() if p.obstacle == i) for i in robot.seen)
            if robot.seen:
                i, point = robot.nearest(robot.seen)
                assert point == robot.map.nearest(i, robot.position)
                gaps = [_gap(robot, robot.map.nearest(j, robot.position)) for j in robot.seen]
                assert _gap(robot, point) == min(gaps)
                _, visible = robot.nearest(robot.seen, visible=True)
                assert _gap(robot, visible) >= _gap(robot, point) and robot.map.knows(visible)
        with pytest.raises(ValueError, match="no obstacles"):
            robot.nearest([])

    def test_of_equally_near_ones_the_order_is_the_scene_s(self) -> None:
        sides = [[(2, -1), (4, -1), (4, 1), (2, 1)], [(-2, 1), (-4, 1), (-4, -1), (-2, -1)]]
        for shapes, x in ((sides, 2), (sides[::-1], -2)):
            robot = xa.Robot(Scene(shapes, start=(0, 0), radius=20))
            assert robot.nearest(robot.seen)[1] == Point(x, 0) == robot.nearest(robot.seen[::-1])[1]

    @pytest.mark.parametrize("seed", some(range(30), 8))
    def test_news_are_what_changed(self, seed: int) -> None:
        rng, robot = Random(seed), xa.Robot(random_scene(Subject.SIGHTSEER, seed))
        assert robot.news() == set(robot.seen)
        for _ in range(4):
            before = robot.map
            robot.go_to((rng.randint(-9, 9), rng.randint(-9, 9)))
            after = robot.map
            changed = {
                i for i in after.seen if i not in before.seen or after.known(i) != before.known(i)
            }  # fmt: skip
            assert robot.news() >= changed and robot.news() == frozenset()

    def test_known_blocks_of_a_route(self) -> None:
        """News tell that the robot has left a known crossing point behind."""
        robot = xa.Robot(SQUARES)
        route = robot.lay([(0, 0), (20, 0)])
        assert robot.map.blocks(0, route)
        robot.follow(route)
        robot.circle()
        assert robot.map.seen == (0, 1) and robot.map.blocks(1, route)
        robot.news(route)
        robot.take_up(route, next(robot.exits(route, 0)))
        robot.news()
        assert not robot.map.blocks(0, route)
        assert robot.news(route) == {0} and robot.news(route) == frozenset()
        robot.follow(route)
        for i in (0, 1):
            assert robot.map.blocks(i, route) is (i == 1)
        with pytest.raises(ValueError, match="no obstacle 2"):
            robot.map.blocks(2, route)


def _gap(robot: xa.Robot, point: Point) -> xa.Real:
    return (point - robot.position).norm_sq()


def test_polylines_need_no_straight_corners() -> None:
    """Corners on a line divide a route as others do."""
    robot = xa.Robot(SQUARES)
    route = robot.lay([(0, 0), (0, 1), (0, 2), (0, 2), (0, 5)])
    assert len(route.pieces) == 3
    assert all(a.end == b.start for a, b in pairwise(route.pieces))
