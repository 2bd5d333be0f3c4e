"""Strategies of one's own: registered, run, written and read, drawn, told, and audited."""

from __future__ import annotations

import json
import pickle
import re
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from random import Random

import pytest
import test_robot
from nightly import some

import exactacq as xa
from exactacq.geometry.points import Point
from exactacq.output.animation.frames import frames_of
from exactacq.output.animation.page import page
from exactacq.output.animation.several import page_of_runs
from exactacq.output.figures import svg
from exactacq.output.report import console, run_report
from exactacq.sensing.event import Ending
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.strategies import registry
from exactacq.strategies.run import Bound
from exactacq.study.random_scenes import Subject, random_scene

CIRCLES = xa.load("circles")


@pytest.fixture(autouse=True)
def own_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "_known", {})


def nearest_first(robot: xa.Robot) -> None:
    """The Sightseer in small: along links, and back where none goes on."""
    ways = []
    while True:
        link = robot.nearest_unvisited(robot.at)
        if link is not None:
            ways.append(robot.take(link))
            robot.circle()
        elif ways:
            robot.go_back(ways.pop())
        else:
            return


def wanderer(seed: int, robot: xa.Robot) -> None:
    """Random moves: straight ones, walks that are interrupted, laps, and ways along links."""
    rng, ways = Random(seed), []
    for _ in range(7):
        ends = [point for _, point in robot.frontier]
        link = robot.nearest_unvisited(robot.at) if robot.at in robot.visited else None
        if link is not None and rng.random() < 0.7:
            ways.append(robot.take(link))
        elif ways and robot.at == ways[-1].target and robot.at in robot.visited and rng.random() < 0.5:
            robot.go_back(ways.pop())
        elif robot.at is not None and robot.at not in robot.visited:
            robot.walk(rng.choice(["left", "right"]), until=rng.choice([(), "acquire", "sight"]))
        elif ends:
            robot.go_to(rng.choice(ends), until=rng.choice([(), "regain"]))
        else:
            robot.go_to((rng.randint(-9, 9), rng.randint(-9, 9)))


def wandered(seed: int) -> xa.OwnRun:
    return xa.explore(random_scene(Subject.SIGHTSEER, seed), partial(wanderer, seed))


def touch(robot: xa.Robot) -> None:
    robot.go_to(robot.map.nearest(0, robot.position))


class TestRuns:
    def test_of_the_papers_strategies_by_name(self) -> None:
        assert xa.explore(CIRCLES) == xa.sightseer(CIRCLES)
        terrain = xa.load("figure2")
        assert xa.explore(terrain, "seed-spreader") == xa.seed_spreader(terrain)
        assert xa.explore(CIRCLES, "sightseer", 9, start=(0, 1)) == xa.sightseer(CIRCLES, 9, start=(0, 1))

    @pytest.mark.parametrize("seed", some(range(30), 4))
    def test_of_the_sightseers_rules_are_its_walk(self, seed: int) -> None:
        scene = random_scene(Subject.SIGHTSEER, seed)
        own, other = xa.explore(scene, nearest_first), xa.sightseer(scene)
        assert own.visits == other.visits and own.unseen == other.unseen
        if other.ending is Ending.BACK_AT_START:
            assert own.path == other.path
        else:
            assert own.path[: len(other.path)] == other.path[:]

    def test_tell_what_was_missed(self) -> None:
        run = xa.explore(CIRCLES, touch)
        assert (run.strategy, run.title, run.name) == ("touch", "Strategy touch", "touch")
        assert run.length == 3 and run.visits == () and run.bounds == ()
        assert (run.unseen, run.unvisited, run.complete) == ((1,), (0,), False)
        assert run.ending is Ending.FINISHED and run.events[-1].note == "the strategy is done"
        assert [event.kind.value for event in run.events] == ["start", "sight", "hit", "stop"]

    def test_begin_where_they_are_told(self) -> None:
        run = xa.explore(CIRCLES, touch, "5/2", start=(1, 0))
        assert run.start == Point(1, 0) and run.length == 2 and run.radius * 2 == 5

    def test_without_a_move(self) -> None:
        run = xa.explore(CIRCLES, lambda robot: None)
        assert len(run.path) == 0 and run.name == "lambda" and run.ending is Ending.FINISHED
        xa.audit(run, samples=4)
        nothing = xa.explore(xa.Scene([], start=(0, 0), radius=1), lambda robot: robot.go_to((1, 1)))
        assert nothing.complete
        xa.audit(nothing, samples=4)

    def test_have_no_more_moves_than_allowed(self) -> None:
        def endless(robot: xa.Robot) -> None:
            while True:
                try:
                    robot.go_to((0, 1))
                    robot.go_to((0, 0))
                except Exception:
                    continue

        run = xa.explore(CIRCLES, endless, max_moves=5)
        assert run.ending is Ending.MOST_MOVES and len(run.path) == 5 and run.length == 5
        xa.audit(run, samples=4)
        for most in (0, -1, 2.5, True, "9"):
            with pytest.raises(xa.FormatError, match="max_moves: a positive integer"):
                xa.explore(CIRCLES, touch, max_moves=most)

    def test_are_over_when_they_are(self) -> None:
        kept = []
        xa.explore(CIRCLES, kept.append)
        with pytest.raises(xa.MoveError, match="the run of this robot is over"):
            kept[0].go_to((1, 1))

    def test_fail_as_the_strategy_does(self) -> None:
        with pytest.raises(ZeroDivisionError):
            xa.explore(CIRCLES, lambda robot: 1 // 0)

    @pytest.mark.parametrize("goes_on", [False, True])
    def test_that_are_undecided_tell_how_far(self, goes_on: bool, monkeypatch: pytest.MonkeyPatch) -> None:
        walk = Memory.walk

        def fail(self: Memory, piece: Piece) -> object:
            if piece.end.y == 3:
                raise xa.Undecided("two numbers")
            return walk(self, piece)

        def go(robot: xa.Robot) -> None:
            robot.go_to((0, 2))
            try:
                robot.go_to((0, 3))
            except xa.Undecided:
                if not goes_on:
                    raise

        monkeypatch.setattr(Memory, "walk", fail)
        with pytest.raises(xa.Undecided, match="undecided after") as caught:
            xa.explore(CIRCLES, go)
        run = caught.value.run
        assert (run.ending, run.name, run.length) == (Ending.UNDECIDED, "go", 2)
        assert caught.value.place == Point(0, 2)
        assert xa.load_run(run.to_json()) == run

    def test_that_compare_what_is_undecided_are_given_up(self) -> None:
        def go(robot: xa.Robot) -> None:
            robot.go_to((0, 2))
            circle, double = xa.Length.turns(1), xa.Length.turns(2)
            assert (circle + 1) / circle == (double + 2) / double

        with pytest.raises(xa.Undecided, match="undecided after 2 of the path") as caught:
            xa.explore(CIRCLES, go)
        assert caught.value.run.ending is Ending.UNDECIDED

    def test_that_are_generators_or_coroutines_do_not_run(self) -> None:
        def steps(robot: xa.Robot) -> Iterator[None]:
            robot.go_to((0, 2))
            yield

        async def later(robot: xa.Robot) -> None:
            robot.go_to((0, 2))

        started = []

        def awaited(robot: xa.Robot) -> Awaitable[None]:
            started.append(later(robot))
            return started[-1]

        for rules in (steps, awaited):
            with pytest.raises(xa.StrategyError, match="has not run: it is called, not iterated or awaited"):
                xa.explore(CIRCLES, rules)
        started[0].close()

    def test_report_progress(self) -> None:
        told: list[tuple[int, int]] = []
        room = xa.Scene(
            [xa.Circle((0, 0), 1)], start=(3, 3), radius=20,
            enclosure=[(-5, -5), (5, -5), (5, 5), (-5, 5)],
        )  # fmt: skip
        for scene in (CIRCLES, room):
            xa.explore(scene, nearest_first, progress=lambda *step: told.append(step))
            edges = sum(len(obstacle.edges) for obstacle in scene.obstacles)
            assert told[-1] == (edges, edges)


class TestNames:
    def test_are_for_one_strategy(self) -> None:
        xa.strategy("mine")(touch)
        assert xa.strategy("mine")(touch) is touch
        with pytest.raises(xa.StrategyError, match="there is a strategy mine already"):
            xa.strategy("mine")(nearest_first)
        with pytest.raises(
            xa.StrategyError,
            match="no strategy 'other'; there are sightseer, seed-spreader, nearest-frontier, mine",
        ):
            xa.explore(CIRCLES, "other")
        assert xa.explore(CIRCLES, "mine") == xa.explore(CIRCLES, touch)

    @pytest.mark.parametrize("name", ["", "a b", "-a", "<b>", "a.py:b", None, 3, ["a"]])
    def test_are_words(self, name: object) -> None:
        with pytest.raises(xa.StrategyError, match="a strategy has a name of letters"):
            xa.strategy(name)

    def test_of_the_paper_are_taken(self) -> None:
        with pytest.raises(xa.StrategyError, match="is a strategy of exactacq"):
            xa.strategy("sightseer")

        def sightseer(robot: xa.Robot) -> None:
            robot.go_to((1, 0))

        assert xa.explore(CIRCLES, sightseer).name == "sightseer-"

    def test_of_others_are_taken(self) -> None:
        """Read back, the run of another function had the bounds of the strategy of its name."""
        xa.strategy("touch", bounds=lambda run: [("most", "a guess", run.radius)])(nearest_first)
        run = xa.explore(CIRCLES, touch)
        assert run.name == "touch-" and xa.load_run(run.to_json()) == run

    def test_of_methods_are_found(self) -> None:
        class Toucher:
            def go(self, robot: xa.Robot) -> None:
                touch(robot)

        toucher = Toucher()
        xa.strategy("toucher")(toucher.go)
        assert xa.explore(CIRCLES, toucher.go).name == "toucher"

    def test_of_one_that_takes_no_link(self) -> None:
        with pytest.raises(xa.MoveError, match=r"a link is what robot\.links .* gives, not None"):
            xa.explore(CIRCLES, lambda robot: robot.take(None))
        with pytest.raises(xa.MoveError, match=r"a way is what robot\.take has returned, not None"):
            xa.explore(CIRCLES, lambda robot: robot.go_back(None))

    def test_are_told_to_the_decorator(self) -> None:
        with pytest.raises(xa.StrategyError, match=r'write @xa.strategy\("NAME"\)'):
            xa.strategy(nearest_first)  # type: ignore[arg-type]
        with pytest.raises(xa.StrategyError, match="nothing is no function: None"):
            xa.strategy("nothing")(None)  # type: ignore[type-var]

    def test_of_what_takes_no_robot(self) -> None:
        for rules in (lambda: None, lambda robot, speed: None, lambda *, robot: None):
            with pytest.raises(xa.StrategyError, match="cannot be called with a robot and nothing else"):
                xa.explore(CIRCLES, rules)
        assert xa.explore(CIRCLES, lambda robot, speed=3: None).length == 0

    def test_of_what_is_no_strategy(self) -> None:
        for thing in (None, 3, b"sightseer"):
            with pytest.raises(xa.StrategyError, match="no strategy"):
                xa.explore(CIRCLES, thing)


class TestBounds:
    def told(self, *values: object) -> Callable[[xa.Run], Iterator[tuple[str, str, object]]]:
        return lambda run: ((f"b{k}", "a guess", value) for k, value in enumerate(values))

    def test_are_as_registered(self) -> None:
        xa.strategy("mine", bounds=self.told(3, "5/2", xa.Length.turns(1)))(touch)
        run = xa.explore(CIRCLES, "mine")
        assert [(b.name, b.holds, b.applies) for b in run.bounds] == [
            ("b0", True, True),
            ("b1", False, True),
            ("b2", True, True),
        ]
        xa.audit(run, samples=4)
        assert xa.load_run(run.to_json()) == run
        first = run.bounds[0]
        for wrong in (replace(first, holds=False), replace(first, ratio=0.5)):
            with pytest.raises(xa.AuditError, match="bound b0"):
                xa.audit(replace(run, bounds=(wrong, *run.bounds[1:])), samples=4)

    def test_are_not_those_of_another_strategy_of_its_name(self) -> None:
        xa.strategy("touch", bounds=self.told(3))(nearest_first)
        assert xa.explore(CIRCLES, touch).bounds == ()

    @pytest.mark.parametrize("told", [3, [3], ["abcd"], [("most", "a guess")], [("most", "a guess", "far")]])
    def test_without_name_source_and_value_are_refused(self, told: object) -> None:
        xa.strategy("still", bounds=lambda run: told)(lambda robot: None)  # type: ignore[arg-type, return-value]
        with pytest.raises(xa.StrategyError, match="bounds of still: "):
            xa.explore(CIRCLES, "still")

    def test_with_one_name_are_refused(self) -> None:
        xa.strategy("mine", bounds=lambda run: [("b", "", 1), ("b", "", 2)])(touch)
        with pytest.raises(xa.StrategyError, match="two bounds of mine have one name"):
            xa.explore(CIRCLES, "mine")

    def test_named_as_the_papers_are_lengths(self) -> None:
        xa.strategy("mine", bounds=lambda run: [("(4)", "", 3)])(touch)
        xa.audit(xa.explore(CIRCLES, "mine"), samples=4)


class TestWhatIsMadeOfRuns:
    @pytest.mark.parametrize("seed", some(range(12), 3))
    def test_files_are_read_as_written(self, seed: int) -> None:
        run = wandered(seed)
        document = json.loads(json.dumps(run.to_json()))
        again = xa.load_run(document)
        assert (
            type(again) is xa.OwnRun and again == run and again.map.known_length() == run.map.known_length()
        )
        assert again.to_json() == document
        assert pickle.loads(pickle.dumps(run)) == run

    @pytest.mark.parametrize("name", ["sightseer", "a b", "<script>", None])
    def test_files_with_other_names_are_refused(self, name: object) -> None:
        document = xa.explore(CIRCLES, touch).to_json()
        with pytest.raises(xa.FormatError):
            xa.load_run({**document, "strategy": name})
        with pytest.raises(xa.FormatError, match="unknown strategy"):
            xa.load_run({**document, "own": False})

    def test_reports_and_figures(self, tmp_path: Path) -> None:
        run = wandered(1)
        out = console()
        with out.capture() as said:
            out.print(run_report(run))
        text = said.get()
        assert "Strategy wanderer" in text or "Strategy partial" in text
        assert "ended because the strategy is done" in text and "model (a)" not in text
        assert "<svg" in svg(run) and run.title in svg(run)
        assert run.title in page(run, frames_of(run, limit=4, fine=0))
        for name in ("run.svg", "run.csv", "run.dxf", "run.geojson"):
            xa.write(run, tmp_path / name)
        assert run._repr_html_().startswith("<div><p>OwnRun")

    def test_pictures_show_a_path_that_leaves_the_obstacles_behind(self) -> None:
        run = xa.explore(CIRCLES, lambda robot: robot.go_to((0, 40)))
        assert xa.figure(run).axes[0].get_ylim()[1] > 40
        still = xa.explore(CIRCLES, lambda robot: None)
        for text in (page(run, frames_of(run)), page_of_runs([still, run], map(frames_of, [still, run]))):
            for box in re.findall(r'"box":\[([\d.]+),([\d.]+)\]', text.replace(" ", "")):
                assert float(box[1]) > 2 * float(box[0])


class TestAudits:
    @pytest.mark.parametrize("seed", some(range(40), 6))
    def test_find_no_flaw(self, seed: int) -> None:
        xa.audit(wandered(seed), samples=6)

    def test_find_each_flaw(self) -> None:
        run = xa.explore(CIRCLES, nearest_first)
        xa.audit(run, samples=4)
        moves = {event.kind: k for k, event in enumerate(run.events)}

        def with_event(which: str, **changes: object) -> xa.OwnRun:
            events, k = list(run.events), moves[xa.EventKind(which)]
            events[k] = replace(events[k], **changes)
            return replace(run, events=tuple(events))

        flawed = {
            "visited, but never walked": replace(xa.explore(CIRCLES, touch), visits=(0,)),
            "names one twice": replace(run, visits=(0, 1, 1)),
            "which no such strategy does": with_event("stop", ending=Ending.ALL_VISITED),
            "on the boundary of obstacle 0": with_event("hit", obstacle=0),
            "happens at None": with_event("stop", obstacle=0),
            "between .* is not at None": replace(
                run, events=tuple(e for e in run.events if e.kind is not xa.EventKind.HIT)
            ),
            "happens at 0": with_event("leave", obstacle=None, kind=xa.EventKind.BACKTRACK),
            "by the map": replace(run, unvisited=(0,)),
            "the bounds are": replace(run, bounds=(Bound("a", "", xa.Length(1), False, 1.0),) * 2),
            "is not on the path": with_event("hit", point=Point(0, 1)),
        }
        for words, wrong in flawed.items():
            with pytest.raises(xa.AuditError, match=words):
                xa.audit(wrong, samples=4)


class TestPeeking:
    """A strategy that looks behind all public names finds nothing that it has not seen."""

    @pytest.mark.parametrize("seed", some(range(10), 2))
    def test_from_within_a_run(self, seed: int) -> None:
        scene = random_scene(Subject.SIGHTSEER, seed)
        peeping, found = test_robot.TestPeeking(), []

        def peep(robot: xa.Robot) -> None:
            told: list[object] = [robot, robot.go_to((3, 1))]
            is_there = robot.at is None and robot.position == robot.start
            link = robot.nearest_unvisited(None) if is_there else None
            told += [] if link is None else [link, robot.take(link)]
            for wrong in (lambda: robot.links(99), lambda: robot.map.known(99), lambda: robot.walk("up")):
                try:
                    wrong()
                except ValueError as error:
                    told += [error, *error.args, *vars(error).values()]
            found.extend(thing for root in told for thing in peeping.reachable(root))

        xa.explore(scene, peep)
        assert len(found) > 10
        assert not [thing for thing in found if isinstance(thing, peeping.FORBIDDEN)]

    def test_an_undecided_move_tells_the_strategy_no_run(self, monkeypatch: pytest.MonkeyPatch) -> None:
        caught: list[xa.Undecided] = []

        def fail(self: Memory, piece: Piece) -> None:
            raise xa.Undecided("two numbers")

        def go(robot: xa.Robot) -> None:
            try:
                robot.go_to((0, 1))
            except xa.Undecided as error:
                caught.append(error)
                assert error.run is None and error.place is None

        monkeypatch.setattr(Memory, "walk", fail)
        with pytest.raises(xa.Undecided):
            xa.explore(CIRCLES, go)
        assert len(caught) == 1


def test_a_way_to_a_place_with_one_irrational_coordinate() -> None:
    """(21/5, 2 sqrt(21)/5): a normal of that way has one rational coordinate too, and no image."""
    robot = xa.Robot(xa.load("circles"))
    ((_, end), *_) = robot.frontier
    assert end.x.rational is not None
    assert end.y.rational is None
    robot.go_to(end)
    assert robot.position == end


class TestConfined:
    """Runs by a robot that keeps within a terrain, with an obstacle that the border cuts in two."""

    BAR = xa.Polygon([(2, -1), (3, -1), (3, 9), (2, 9)])
    SCENE = xa.Scene([BAR, xa.Circle((1, 4), "1/2")], terrain=xa.Terrain(6, 8), radius=9, start=(0, 0))

    @staticmethod
    def around(robot: xa.Robot) -> None:
        robot.go_to((6, 0))
        robot.circle()
        robot.go_to((1, "7/2"))
        robot.circle()

    def test_obstacles_are_components(self) -> None:
        xa.strategy("around", confined=True)(self.around)
        for run in (xa.explore(self.SCENE, "around"), xa.explore(self.SCENE, self.around)):
            assert run.confined and run.ground is not None
            assert [body.closed for body in run.obstacles] == [False, True]
            assert run.map.acquired == (0, 1) and run.complete and run.visits == (1,)
            xa.audit(run, samples=6)
            assert xa.load_run(run.to_json()) == run == pickle.loads(pickle.dumps(run))

    def test_an_audit_holds_it_to_the_border(self) -> None:
        """What was walked without a border is no run by a robot that keeps within one."""
        scene = xa.Scene([xa.Circle((3, 4), 1)], terrain=xa.Terrain(6, 8), radius=9, start=(0, 0))
        inside, outside = (xa.explore(scene, lambda robot, y=y: robot.go_to((1, y))) for y in (7, 9))
        xa.audit(replace(inside, confined=True, record=None), samples=4)
        with pytest.raises(xa.AuditError, match="piece 0 leaves the terrain"):
            xa.audit(replace(outside, confined=True, record=None), samples=4)

    def test_a_lap_may_end_in_a_tiny_piece(self) -> None:
        """One shorter than a thousand millionth of the boundary was not waited for: not all around."""

        def lap(robot: xa.Robot) -> None:
            robot.go_to((2, 0))
            for place in ((2, -1), (2, "1e-12"), (2, 0)):
                robot.walk("left", to=place)

        box = xa.Polygon([(2, -1), (4, -1), (4, 1), (2, 1)])
        run = xa.explore(xa.Scene([box], start=(0, 0), radius=9), lap)
        assert run.visits == (0,)
        xa.audit(run, samples=4)

    def test_the_robot_of_a_function_is_not_confined(self) -> None:
        with pytest.raises(xa.InvalidScene, match="meets the terrain's border"):
            xa.explore(self.SCENE, self.around)

    def test_it_is_drawn_and_played_within_the_border(self) -> None:
        short = xa.strategy("short", confined=True)(lambda robot: robot.go_to((1, 0)))
        run = xa.explore(xa.Scene([self.BAR], terrain=xa.Terrain(6, 8), radius=9), short)
        assert "M-line" not in svg(run)
        text = page(run, frames_of(run))
        assert '"mline":""' in text.replace(" ", "")

    def test_a_start_elsewhere_is_refused(self) -> None:
        xa.strategy("around", confined=True)(self.around)
        with pytest.raises(xa.InvalidScene, match="not the terrain's SW corner"):
            xa.explore(self.SCENE, "around", start=(1, 1))
        with pytest.raises(xa.InvalidScene, match="needs a terrain"):
            xa.explore(self.SCENE.replace(terrain=None), "around")

    def test_what_it_goes_on_without_end_for_is_ended(self) -> None:
        @xa.strategy("endless", confined=True)
        def endless(robot: xa.Robot) -> None:
            while True:
                robot.go_to((0, 1))
                robot.go_to((0, 0))

        run = xa.explore(self.SCENE, endless, max_moves=5)
        assert run.ending is Ending.MOST_MOVES and run.confined
