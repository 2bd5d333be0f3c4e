"""The script that compares strategies: single outcomes, its tables from planted ones, and what is stored."""

from __future__ import annotations

import json
import signal

import compare_strategies as script
import pytest
from compare_strategies import Outcome, beside, outcome, random_results, summary, told, with_terrain

import exactacq as xa
from exactacq.strategies.options import Baseline, Strategy


@pytest.fixture(autouse=True)
def alarm() -> None:
    signal.signal(signal.SIGPROF, script.give_up)


def test_a_run_that_ends() -> None:
    found = outcome(xa.load("squares"), Strategy.SIGHTSEER, 20)
    assert (found.length, found.acquired, found.obstacles, found.unseen) == (24, 2, 2, 0)
    assert found.circling == pytest.approx(24 / 21) and found.seeing is None
    assert (found.unknown, found.boundary, found.is_whole) == (0, 16, True)
    assert told(found) == "24 (1.143)"


def test_all_strategies_run_on_a_scene_that_has_no_terrain() -> None:
    scene = with_terrain(xa.load("circles"))
    found = [outcome(scene, strategy, 20) for strategy in script.STRATEGIES]
    assert [one.why for one in found] == ["", "", ""] and all(one.is_whole for one in found)
    west, south, *_ = scene.terrain.limits
    assert (west, south) == (2, -4)


def test_refusals_and_runs_without_an_end(monkeypatch: pytest.MonkeyPatch) -> None:
    room = xa.Scene([], start=(1, 1), radius=1, enclosure=xa.Polygon([(0, 0), (9, 0), (0, 9)]))
    assert outcome(with_terrain(room), Strategy.SEED_SPREADER, 20).why == "refused"

    def endless(scene: xa.Scene, strategy: str) -> xa.Run:
        while True:
            pass

    monkeypatch.setattr(xa, "explore", endless)
    assert outcome(xa.load("squares"), Strategy.SIGHTSEER, 0.05).why == "slow"

    def open_question(scene: xa.Scene, strategy: str) -> xa.Run:
        raise xa.Undecided("which")

    monkeypatch.setattr(xa, "explore", open_question)
    assert outcome(xa.load("squares"), Strategy.SIGHTSEER, 20).why == "undecided"


def planted(length: float, acquired: int = 2, why: str = "", circling: float | None = None) -> Outcome:
    return Outcome("s", "x", why, length, acquired, 2, 2 - acquired, 8.0 * (2 - acquired), 16.0, circling)


def test_rows_tell_medians_and_extremes() -> None:
    found = [planted(2, circling=1.5), planted(3, circling=2.0), planted(4, 1), planted(0, why="slow")]
    row = summary("x", found)
    assert row == ["x", "3", "2", "1 of 6", "16.67%", "1.750, 2.000 (2 runs)", "-", "0", "1"]
    assert told(found[2]) == "4; 1 never seen of 2" and told(found[3]) == "slow"
    first = [planted(4), planted(2), planted(1), planted(1)]
    assert beside("x", found, first) == ["x", "2", "1", "0.500", "0.750", "1.000", "1.250", "1.500"]


def test_a_small_campaign_is_made_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(script, "version", lambda: "0123456")
    (_, table), (_, lengths) = random_results(4, 0, 20)
    assert [row[0] for row in table["rows"]] == [*Strategy, *Baseline]
    assert all(len(row) == len(table["columns"]) for row in table["rows"])
    assert all(len(row) == len(lengths["columns"]) for row in lengths["rows"])
    json.dumps([table, lengths])
