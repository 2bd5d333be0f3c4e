"""The script that explores drawings in many ways finds what is planted."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest
import stress_drawings
from stress_drawings import DATA, main, tried

import exactacq as xa
from exactacq.files.octagons import random_octagons

BANDAID = DATA / "bandaid.svg"


def test_runs_of_a_drawing_pass(tmp_path: Path) -> None:
    """Also sweeps, where no wall is around it."""
    room = tmp_path / "room.wkt"
    room.write_text("POLYGON ((0 0, 9 0, 9 6, 0 6, 0 0), (2 2, 4 2, 3 5, 2 2), (6 1, 7 2, 6 3, 6 1))")
    found = list(tried(room, random=0))
    assert len(found) == 12 and {what for _, what in found} <= {"passed", "not free"}
    assert sum(what == "passed" for _, what in found) >= 6
    two = tmp_path / "two.wkt"
    two.write_text("MULTIPOLYGON (((0 0, 4 0, 2 3, 0 0)), ((6 0, 9 1, 6 2, 6 0)))")
    swept = dict(list(tried(two, random=0))[12:])
    assert len(swept) == 6 and all("--terrain bbox:" in options for options in swept)
    assert set(swept.values()) == {"passed"}


def test_a_fault_is_told_with_its_start(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def undecided(*args: object, **options: object) -> None:
        raise xa.Undecided("a tie")

    monkeypatch.setattr(stress_drawings.xa, "sightseer", undecided)
    assert main([str(BANDAID)]) == 1
    told = capsys.readouterr().out.splitlines()
    assert all("--start" in line and "a tie" in line for line in told[:-1])
    assert told[-1] == "1 files: 0 runs passed, 24 did not"


def test_a_late_run_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stress_drawings, "SECONDS", 1)
    run = partial(xa.sightseer, random_octagons(400, 1), 20)
    assert stress_drawings.outcome(run) == "more than 1 s"
