"""The Sightseer's way follows from links: what it sees is found out when it is asked for, and is the same."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from typing import Any

import pytest
from nightly import some

import exactacq as xa
from exactacq.scene.scene import Scene
from exactacq.sensing.memory import Memory
from exactacq.strategies.robot import Robot
from exactacq.strategies.sightseer.rules import Tour
from exactacq.strategies.sightseer.strategy import explored_by
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene

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


@pytest.mark.parametrize("count", [0, 2, 9])
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
