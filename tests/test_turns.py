"""Where a sweep turns on its M-line: told at corners to which the robot comes, and then it does so."""

from __future__ import annotations

import re

import pytest
from gallery_runs import gallery_run

import exactacq as xa
from exactacq.output.animation.frames import frames_of
from exactacq.output.animation.page import told
from exactacq.output.report import console, run_report
from exactacq.output.turns import turns
from exactacq.output.vocabulary import Labels
from exactacq.sensing.event import EventKind


def words(run: xa.Run) -> list[str]:
    return [turn.words for turn in turns(run)]


def test_an_empty_terrain_has_all_turns() -> None:
    scene = xa.Scene([], terrain=xa.Terrain(7, 5, origin=(-1, 2)), radius=3)
    run = xa.seed_spreader(scene)
    assert [turn.after for turn in turns(run)] == [1, 2, 3, 4, 5, 6]
    assert words(run) == [
        "end of the line: the next one is 3 further east", "along the next line, to the south",
        "end of the line: the next one is 3 further east", "along the next line, to the north",
        "end of the line: the next one is 1 further east", "along the next line, to the south",
    ]  # fmt: skip


@pytest.mark.parametrize("name", ["figure3", "figure4", "case3", "m20-3", "m18"])
def test_what_is_told_is_what_the_path_does(name: str) -> None:
    """The next piece of the path leads where the words say, from a side of the terrain."""
    run = gallery_run(name)
    west, south, east, north = run.ground.terrain.limits
    found = list(turns(run))
    assert found and [turn.after for turn in found] == sorted({turn.after for turn in found})
    for after, text in found:
        piece = run.path[after]
        there = piece.end - piece.start
        assert piece.start.y.rational in (south, north)
        if match := re.search(r" ([\d/.]+) further east$", text):
            assert there.x > 0 == there.y
            assert west < piece.start.x + xa.Real(match[1]) <= east
        else:
            assert there.x == 0 and (there.y > 0) == text.endswith("to the north")


def test_a_corner_to_which_a_diversion_comes_back_is_told_once() -> None:
    run = gallery_run("figure4")
    back = next(event for event in run.events if event.kind is EventKind.RETURN)
    assert run.path[back.after].start == back.point, "the diversion begins at the end of a line"
    at_corner = [turn.after for turn in turns(run) if run.path[turn.after].start == back.point]
    assert at_corner == [back.after]


def test_other_strategies_have_no_turns() -> None:
    assert words(gallery_run("figure2")) == []


def test_page_and_report_tell_of_turns() -> None:
    run = gallery_run("figure4")
    plans = [text for _, text in told(run, frames_of(run, 12, fine=0), Labels.ALL)["plans"]]
    assert "along the next line, to the south" in plans
    back = next(event for event in run.events if event.kind is EventKind.RETURN)
    assert f"end of the line: the next one is 8 further east; {back.why(list(run.names()))}" in plans
    out = console()
    with out.capture() as said:
        out.print(run_report(run))
    rows = [line.split() for line in said.get().splitlines()]
    assert ["43.9757", "turn", "along", "the", "next", "line,", "to", "the", "south"] in rows
