"""A run that is undecided is not lost: the error carries it up to there, and the command line tells it."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from strategies import box

import exactacq as xa
from exactacq import cli
from exactacq.auditing import audit as auditing
from exactacq.errors import deciding
from exactacq.files.scene_json import scene_to_json
from exactacq.output.animation import frames
from exactacq.play import exploring
from exactacq.play.scenes import Request
from exactacq.sensing.event import Ending
from exactacq.sensing.memory import Memory
from exactacq.sensing.sensor import Sensor

STRATEGIES: dict[str, tuple[Callable[..., Any], str]] = {
    "sightseer": (xa.sightseer, "squares"),
    "seed-spreader": (xa.seed_spreader, "case3"),
}
WORDS = "sign of 0.00000...: excluding 0 would take too many bits"


def undecided_after(monkeypatch: pytest.MonkeyPatch, count: int) -> None:
    """Let the sensing of a piece fail once that many pieces are walked."""
    walk, walked = Memory.walk, []

    def failing(memory: Memory, piece: Any) -> Any:
        if len(walked) == count:
            raise xa.Undecided(WORDS)
        walked.append(piece)
        return walk(memory, piece)

    monkeypatch.setattr(Memory, "walk", failing)


@pytest.mark.parametrize("count", [0, 1, 3, 6])
@pytest.mark.parametrize("name", STRATEGIES)
def test_the_error_carries_the_run_so_far(name: str, count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    explore, scene = STRATEGIES[name]
    whole = explore(xa.load(scene)).sense()
    undecided_after(monkeypatch, count)
    with pytest.raises(xa.Undecided) as caught:
        explore(xa.load(scene)).sense()
    error = caught.value
    run = error.run
    assert error.comparison == WORDS in str(error)
    assert "a start or a radius close by" in str(error)
    assert run.ending is Ending.UNDECIDED
    assert len(run.path) == count
    assert run.length == whole.path.length_after(count)
    assert error.place == (whole.path[count].start if count < len(whole.path) else whole.start)
    assert error.obstacle == (whole.path[count - 1].obstacle if count else None)
    told = [event for event in whole.events if event.after + event.inside <= count]
    assert set(map(str, run.events[:-1])) <= set(map(str, told))
    assert run.bounds == ()
    monkeypatch.undo()
    assert xa.load_run(run.to_json()) == run
    assert pickle.loads(pickle.dumps(error)).run == run
    with pytest.raises(ValueError, match="given up"):
        xa.audit(run)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_of_a_piece_that_is_undecided_midway_nothing_is_known(
    count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A way along a wall is sensed in three parts, and a part that fails takes the ones before it back.

    They were kept: a robot that stands at the start knew what it would have seen on the way.
    """
    boxes = box(2, 4, 0, 1), box(8, 9, 2, 3), box(2, 3, -3, -2)
    scene = xa.Scene(list(map(xa.Polygon, boxes)), start=(0, 0), radius=2)
    fresh, ahead, legs = xa.Robot(scene), Sensor.ahead, []

    def failing(sensor: Sensor, leg: Any, retraced: bool = False) -> Any:
        legs.append(leg)
        if len(legs) == count:
            raise xa.Undecided(WORDS)
        return ahead(sensor, leg, retraced)

    monkeypatch.setattr(Sensor, "ahead", failing)
    robot = xa.Robot(scene)
    with pytest.raises(xa.Undecided):
        robot.go_to((7, 0))
    assert robot.position == scene.start and len(legs) == count
    assert robot.map.known_length() == fresh.map.known_length()
    assert (robot.seen, robot.in_sight, robot.incomplete) == (fresh.seen, fresh.in_sight, fresh.incomplete)
    legs.clear()
    with pytest.raises(xa.Undecided) as caught:
        xa.explore(scene, lambda robot: robot.go_to((7, 0)))
    run = caught.value.run
    assert run.map.seen == run.unvisited == (0,) and run.unseen == (1, 2)


@pytest.mark.parametrize("name", STRATEGIES)
def test_the_page_to_draw_in_plays_what_there_is(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    undecided_after(monkeypatch, 3)
    monkeypatch.setattr(exploring, "FINE", exploring.SOON)
    parts: list[bytes] = []
    body = json.dumps({"scene": scene_to_json(xa.load(STRATEGIES[name][1])), "strategy": name})
    exploring.Explored().explore(Request.of(body.encode()), lambda *_: None, parts.append)
    told = json.loads(parts[0])
    assert WORDS in told["report"]["trouble"]
    assert told["report"]["bounds"] == [] and not told["report"]["is_own"]
    assert told["run"]["plans"][-1][1].startswith("given up")


@pytest.mark.parametrize("name", STRATEGIES)
def test_the_command_line_tells_what_there_is(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    undecided_after(monkeypatch, 5)
    figure, trace, page = (tmp_path / f"run.{kind}" for kind in ("svg", "json", "html"))
    wanted = ["--figure", str(figure), "--trace", str(trace), "--animate", str(page), "--audit"]
    monkeypatch.setattr(frames, "frames_of", partial(frames.frames_of, limit=9, fine=0))
    assert cli.main(["explore", STRATEGIES[name][1], "--strategy", name, *wanted]) == 3
    monkeypatch.undo()
    out, err = capsys.readouterr()
    assert "given up at (" in out
    assert "length" in out
    assert "audit passed" not in out
    assert err.count("\n") == 1
    assert "undecided after" in err
    assert WORDS in err
    assert figure.stat().st_size > 1000
    assert page.stat().st_size > 1000
    assert xa.load_run(trace).ending is Ending.UNDECIDED


@pytest.mark.parametrize(("error", "status"), [(xa.Undecided(WORDS), 3), (xa.AuditError("a flaw"), 2)])
def test_an_audit_that_fails_keeps_the_report(
    error: Exception, status: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(auditing, "audit", fails)
    assert cli.main(["explore", "circles", "--audit"]) == status
    out, err = capsys.readouterr()
    assert "order of visits" in out
    assert "audit passed" not in out
    assert str(error) in err


def test_without_a_run_there_is_none() -> None:
    error = xa.Undecided("two numbers")
    assert (error.run, error.place, error.obstacle, str(error)) == (None, None, None, "two numbers")
    assert pickle.loads(pickle.dumps(error)).comparison == "two numbers"


def test_what_is_decided_is_told_in_words() -> None:
    """The closest words stay; what went well costs no word."""
    at = xa.Point(1, "1/3")
    with (
        pytest.raises(xa.Undecided) as caught,
        deciding("what is known at {}", at),
        deciding("what is seen from {}", at),
    ):
        raise xa.Undecided(WORDS)
    assert caught.value.comparison == f"what is seen from (1, 0.333333): {WORDS}"
    with pytest.raises(ValueError, match=r"^other$"), deciding("{} and {}"):
        raise ValueError("other")


def test_a_strategy_of_ones_own_is_told_what_helps(monkeypatch: pytest.MonkeyPatch) -> None:
    undecided_after(monkeypatch, 2)
    with pytest.raises(xa.Undecided, match="halt with `just_past=True`, and ways to corners"):
        xa.explore(xa.load("circles"), lambda robot: [robot.go_to((x, 0)) for x in (1, 2, 3)])
