"""The Sightseer's way follows from links: what it sees is found out when it is asked for, and is the same."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from copy import copy
from threading import Event
from time import sleep
from traceback import walk_tb
from typing import Any

import pytest
from nightly import some

import exactacq as xa
from exactacq.geometry.points import Point
from exactacq.scene.scene import Scene
from exactacq.sensing.memory import Memory
from exactacq.sensing.sensor import Sensor
from exactacq.strategies.robot import Robot
from exactacq.strategies.sightseer import strategy
from exactacq.strategies.sightseer.rules import Tour
from exactacq.strategies.sightseer.strategy import explored_by
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene
from exactacq.visibility.links import Links

WORDS = "two numbers"


@pytest.fixture
def sensed(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The pieces that are sensed, as they are."""
    walk, pieces = Memory.walk, list[Any]()

    def walked(memory: Memory, piece: Any) -> Any:
        pieces.append(piece)
        return walk(memory, piece)

    monkeypatch.setattr(Memory, "walk", walked)
    return pieces


@pytest.fixture
def failing(monkeypatch: pytest.MonkeyPatch) -> Callable[[int, BaseException], None]:
    """Lets the sensing of a piece fail once, when that many were sensed."""

    def fail(count: int, error: BaseException) -> None:
        walk, done, failed = Memory.walk, list[Any](), list[Any]()

        def walked(memory: Memory, piece: Any) -> Any:
            if len(done) == count and not failed:
                failed.append(piece)
                raise error
            done.append(piece)
            return walk(memory, piece)

        monkeypatch.setattr(Memory, "walk", walked)

    return fail


def scene_of(seed: int) -> Scene:
    return random_scene(Subject.SIGHTSEER, seed)


class Eager(Robot):
    """One that senses as it moves, whatever the strategy."""

    def __setattr__(self, name: str, value: object) -> None:
        super().__setattr__(name, False if name == "_senses_late" else value)


def test_what_the_way_needs_is_not_sensed(sensed: list[Any]) -> None:
    run = xa.sightseer(xa.load("figure2"))
    assert run.length > 0 and run.visits and run.links and run.complete and run.bounds and repr(run)
    assert sensed == []
    assert run.events and run.map.acquired
    assert sensed == list(run.path)
    assert run.sense() is run and run.memory is run.memory
    assert len(sensed) == len(run.path)


def test_what_is_not_visited_is_sensed_for(sensed: list[Any]) -> None:
    """Only what was seen tells whether the robot knows of more obstacles than it has visited."""
    scene = xa.Scene([[(2, -1), (4, -1), (4, 1), (2, 1)], [(99, 0), (100, 0), (100, 1)]], (0, 0), radius=9)
    run = xa.sightseer(scene)
    assert run.unseen == (1,) and run.unvisited == ()
    assert sensed == list(run.path)


@pytest.mark.parametrize("seed", some(range(200), 12))
def test_late_and_at_once_are_one(seed: int) -> None:
    scene = scene_of(seed)
    late, eager = xa.sightseer(scene), explored_by(Eager(scene), scene)
    assert (late.unseen, late.unvisited, late.stack_depth) == (
        eager.unseen,
        eager.unvisited,
        eager.stack_depth,
    )
    assert late == eager
    assert [e.why() for e in late.events if e.decided] == [e.why() for e in eager.events if e.decided]


@pytest.mark.parametrize("seed", some(range(200, 400), 12))
def test_links_tell_whether_more_is_known(seed: int) -> None:
    """At every step of a tour, beside a robot that has sensed all."""
    scene = scene_of(seed)
    late, eager = Robot(scene), Eager(scene)
    late._senses_late = True
    tours = Tour(late), Tour(eager)
    asked = 0
    while True:
        links = [tour.robot.nearest_unvisited() for tour in tours]
        if all(links):
            for tour, link in zip(tours, links, strict=True):
                assert link is not None
                tour._advance(link)
            continue
        assert links == [None, None]
        knows = eager.knows_unvisited
        assert late.knows_unvisited is knows
        asked += 1
        if not tours[0].stack or not knows:
            break
        for tour in tours:
            tour._backtrack()
    assert asked
    assert late.unvisited == eager.unvisited and late.sightings == eager.sightings


def test_interrupted_it_begins_anew(failing: Callable[[int, BaseException], None]) -> None:
    whole, run = xa.sightseer(xa.load("squares")).sense(), xa.sightseer(xa.load("squares"))
    failing(3, KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        assert run.events
    assert run.events == whole.events
    assert [run.map_at(event).known_length() for event in run.events] == [
        whole.map_at(event).known_length() for event in whole.events
    ]


@pytest.mark.parametrize("count", [0, 2, 5, 6, 9])
def test_undecided_it_is_so_each_time(count: int, failing: Callable[[int, BaseException], None]) -> None:
    run = xa.sightseer(xa.load("squares"))
    failing(count, xa.Undecided(WORDS))
    errors = []
    for ask in (
        lambda: run.events,
        lambda: run.map,
        run.sense,
        lambda: pickle.dumps(run),
        lambda: run.ending,
    ):
        with pytest.raises(xa.Undecided, match=WORDS) as caught:
            ask()
        errors.append(caught.value)
    assert {error.run for error in errors[1:]} == {errors[0].run}
    part = errors[0].run
    assert len(part.path) == count and part.events[-1].ending == "undecided"
    assert part.map.acquired is not None and list(part.path) == list(run.path[:count])
    assert run.length > part.length
    laps = [xa.Length.sum(p.length for p in part.path if p.obstacle == k) for k in (0, 1)]
    rounds = [k for k, walked in enumerate(laps) if walked >= run.obstacles[k].perimeter]
    assert list(part.visits) == rounds and (count != 6 or rounds == [0])
    assert len(part.links) == sum(event.kind == "hit" for event in part.events)
    assert sum(link.traversals for link in part.links) == len(part.links) + sum(
        event.kind == "backtrack" for event in part.events
    )


def test_two_threads_may_ask() -> None:
    scene = xa.load("figure2")
    whole, run = xa.sightseer(scene).sense(), xa.sightseer(scene)
    with ThreadPoolExecutor(4) as pool:
        told = [*pool.map(lambda _: run.events, range(4))]
    assert all(events == whole.events for events in told)


def test_copies_are_told_the_same() -> None:
    run = xa.sightseer(xa.load("squares"))
    assert copy(run) == pickle.loads(pickle.dumps(run)) == run == xa.load_run(run.to_json())
    assert len({id(each.events) for each in (run, run)}) == 1


def test_progress_is_told_in_pieces() -> None:
    told: list[tuple[int, int]] = []
    run = xa.sightseer(xa.load("squares"))
    run.sense(lambda *step: told.append(step))
    count = told[-1][1]
    assert told == [(k, count) for k in range(1, count + 1)] and count == len(run.path) + 1
    for again in (run, xa.load_run(run.to_json()), xa.seed_spreader(xa.load("case3"))):
        told.clear()
        assert again.sense(lambda *step: told.append(step)) is again
        assert len(told) == 1 and told[0][0] == told[0][1] > 0


def test_what_was_unvisited_then_is_told_later(sensed: list[Any]) -> None:
    robot = Robot(xa.load("figure2"))
    robot._senses_late = True
    then, now = [], []
    while link := robot.nearest_unvisited():
        then.append(robot.unvisited_now)
        now.append(len(robot._walker.visited))
        robot.take(link)
        robot.circle()
    assert sensed == []
    again = Robot(xa.load("figure2"))
    for late, visits in zip(then, now, strict=True):
        assert len(again._walker.visited) == visits
        assert late() == again.unvisited
        link = again.nearest_unvisited()
        assert link is not None
        again.take(link)
        again.circle()


# -- what may come between ------------------------------------------------------------------------------


def test_interrupted_twice_it_begins_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """Once in the middle of a piece, which is taken in by half, and then where the fresh memory is made."""
    whole, run = xa.sightseer(xa.load("squares")).sense(), xa.sightseer(xa.load("squares"))
    follow, make, count = Sensor.follow, Memory.__init__, [0, 0]

    def followed(sensor: Sensor, ahead: Any) -> Any:
        found = follow(sensor, ahead)
        count[0] += 1
        if count[0] == 4:
            raise KeyboardInterrupt
        return found

    def made(memory: Memory, *given: Any) -> None:
        count[1] += 1
        if count[1] == 1:
            raise KeyboardInterrupt
        make(memory, *given)

    monkeypatch.setattr(Sensor, "follow", followed)
    monkeypatch.setattr(Memory, "__init__", made)
    for _ in range(2):
        with pytest.raises(KeyboardInterrupt):
            assert run.events
    assert run.events == whole.events
    for event, other in zip(run.events, whole.events, strict=True):
        assert run.map_at(event).known_length() == whole.map_at(other).known_length()


def test_interrupted_after_it_was_found_undecided_it_stays_so(
    failing: Callable[[int, BaseException], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    run, finished, left = xa.sightseer(xa.load("squares")), strategy._finished, [1]

    def interrupted(*given: Any, **options: Any) -> Any:
        if left:
            left.pop()
            raise KeyboardInterrupt
        return finished(*given, **options)

    failing(3, xa.Undecided(WORDS))
    monkeypatch.setattr(strategy, "_finished", interrupted)
    with pytest.raises(KeyboardInterrupt):
        assert run.events
    with pytest.raises(xa.Undecided, match=WORDS) as caught:
        assert run.events
    stops = [event for event in caught.value.run.events if event.kind == "stop"]
    assert len(stops) == 1 and caught.value.run.events[-1] is stops[0]


def test_a_thread_that_waits_for_another_is_told_that_it_is_undecided(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run, walk, waiting, failed = xa.sightseer(xa.load("squares")), Memory.walk, Event(), list[Any]()

    def walked(memory: Memory, piece: Any) -> Any:
        if not failed:
            failed.append(piece)
            waiting.wait(9)
            sleep(0.05)
            raise xa.Undecided(WORDS)
        return walk(memory, piece)

    def ask(first: bool) -> object:
        while not (first or failed):
            sleep(0.001)
        if not first:
            waiting.set()
        return run.events

    monkeypatch.setattr(Memory, "walk", walked)
    with ThreadPoolExecutor(2) as pool:
        for answer in [pool.submit(ask, first) for first in (True, False)]:
            with pytest.raises(xa.Undecided, match=WORDS):
                answer.result()


def test_errors_do_not_grow(failing: Callable[[int, BaseException], None]) -> None:
    run, sizes = xa.sightseer(xa.load("squares")), []
    failing(3, xa.Undecided(WORDS))
    for _ in range(4):
        with pytest.raises(xa.Undecided) as caught:
            assert run.events
        sizes.append(len(list(walk_tb(caught.value.__traceback__))))
    assert sizes[1:] == sizes[1:2] * 3


def test_threads_read_reasons(monkeypatch: pytest.MonkeyPatch) -> None:
    """They take in what was seen, once."""
    before = sys.getswitchinterval()
    usual = [event.why() for event in xa.sightseer(xa.load("figure2")).events if event.decided]
    sys.setswitchinterval(1e-6)
    try:
        run = xa.sightseer(xa.load("figure2")).sense()
        with ThreadPoolExecutor(6) as pool:
            told = list(pool.map(lambda _: [e.why() for e in run.events if e.decided], range(6)))
    finally:
        sys.setswitchinterval(before)
    assert told == [usual] * 6


def test_a_watched_way_that_is_undecided_was_not_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its sightings were shown to the watch, and their numbers are taken back."""
    circles = [xa.Circle((3, y), 1) for y in (0, 20, 40)]
    robot = Robot(xa.Scene(circles, (0, 0), radius=6))
    route = robot.lay([(0, 0), (0, 40)])
    shown: list[Any] = []

    def fail(memory: Memory, piece: Any) -> None:
        raise xa.Undecided(WORDS)

    monkeypatch.setattr(Memory, "walk", fail)
    with pytest.raises(xa.Undecided):
        robot.follow(route, watch=lambda passage: shown.append(passage.sighting))
    assert {sighting.obstacle for sighting in shown if sighting} == {0, 1, 2}
    assert robot.seen == robot.map.seen == (0,) and robot.map.acquired == ()
    assert [sighting.obstacle for sighting in robot.sightings] == [0] and robot.position == Point(0, 0)


def test_an_undecided_robot_knows_where_it_stands(failing: Callable[[int, BaseException], None]) -> None:
    robot = Robot(xa.load("squares"))
    failing(1, xa.Undecided(WORDS))
    robot.go_to((5, 0))
    with pytest.raises(xa.Undecided):
        robot.go_to((0, 3))
    assert (robot.at, robot.position, robot.length) == (0, Point(2, 0), 2)


def test_sightings_are_taken_in_once_though_who_hears_of_them_fails() -> None:
    told: list[list[str]] = []

    def once(done: int, total: int) -> None:
        if not told:
            told.append([])
            raise RuntimeError

    def go(robot: Robot) -> None:
        with suppress(RuntimeError):
            robot.go_to((5, 0))
            robot.circle()
        told.append([str(sighting.kind) for sighting in robot.sightings])

    xa.explore(xa.load("squares"), go, progress=once)
    assert told[1] == ["sight", "sight", "acquire", "lose"]


def test_a_question_about_links_may_be_interrupted(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = Robot(xa.load("figure2"))
    robot.take(robot.nearest_unvisited())
    robot.circle()
    between, failed = Links.between, list[Any]()

    def once(links: Links, i: int, j: int) -> Any:
        if not failed:
            failed.append((i, j))
            raise KeyboardInterrupt
        return between(links, i, j)

    monkeypatch.setattr(Links, "between", once)
    with pytest.raises(KeyboardInterrupt):
        robot.nearest_unvisited()
    link = robot.nearest_unvisited()
    assert link is not None and link.length == min(other.length for other in robot.links(robot.at))


def test_what_is_seen_from_the_ways_alone_may_stay_unvisited() -> None:
    """A disc beside the way between two blocks is farther than R from both."""
    blocks = [[(x, "-1/20"), (x + 1, "-1/20"), (x + 1, "1/20"), (x, "1/20")] for x in (8, 17)]
    scene = xa.Scene([*blocks, xa.Circle(("25/2", "88/10"), "1/10")], (0, 0), radius=9)
    run, eager = xa.sightseer(scene), explored_by(Eager(scene), scene)
    assert (run.visits, run.unvisited, run.unseen, run.stack_depth) == ((0, 1), (2,), (), 2)
    assert run == eager and run.ending == "back at the start"
