"""Campaigns: verdicts do not depend on who judges, and no kill loses what is judged."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import typer
from nightly import by_night, some
from planted_claims import MARK, SOUND, no_third
from typer.testing import CliRunner

from exactacq.errors import AuditError, FormatError
from exactacq.files.scene_json import parse_json, scene_of, scene_to_json
from exactacq.study.campaign import command, judging
from exactacq.study.campaign.coordinator import conduct
from exactacq.study.campaign.judging import Record, judge
from exactacq.study.campaign.settings import (
    CampaignError,
    SceneSource,
    Settings,
    Task,
    claims_at,
    parts,
    sizes_of,
)
from exactacq.study.campaign.store import Store
from exactacq.study.campaign.summary import faults, tallies, unfinished
from exactacq.study.claims.model import Case, Outcome, Subject
from exactacq.study.processes import ProcessError
from exactacq.study.random_scenes import random_scene

QUICK = Settings(scenes=4, strategies=("sightseer",), audit=False, claims="planted_claims:SOUND")


def opened(settings: Settings, path: Path | None = None) -> Store:
    return Store(path, settings, [called for called, _ in parts(claims_at(settings.claims))])


def verdicts(store: Store) -> list[tuple[Any, ...]]:
    """All that a campaign found, without the times it took."""
    scenes = store.rows("SELECT strategy, seed, outcome, length, detail, json FROM scenes ORDER BY 1, 2")
    findings = store.rows("SELECT strategy, seed, claim, outcome, ratio FROM findings ORDER BY 1, 2, 3, 4")
    return [*scenes, *findings]


@pytest.fixture(scope="module")
def expected() -> list[tuple[Any, ...]]:
    """The verdicts of QUICK, judged one by one in this process."""
    statements = list(parts(SOUND))
    with opened(QUICK) as store:
        store.add([judge(task, statements, audited=False) for task in QUICK.tasks()], 0)
        return verdicts(store)


class TestVerdicts:
    @pytest.mark.parametrize("workers", some([2, 1], 1))
    def test_do_not_depend_on_the_number_of_workers(self, workers: int, expected: list[Any]) -> None:
        with opened(QUICK) as store:
            conduct(QUICK, store, workers)
            assert verdicts(store) == expected

    def test_do_not_depend_on_the_cluster(self, expected: list[Any]) -> None:
        distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed")
        with (
            distributed.LocalCluster(n_workers=1, processes=False, dashboard_address=None) as cluster,
            opened(QUICK) as store,
        ):
            conduct(QUICK, store, scheduler=cluster.scheduler_address)
            assert verdicts(store) == expected

    def test_of_both_strategies_with_audit(self) -> None:
        settings = replace(Settings(), scenes=1)
        assert [str(task) for task in settings.tasks()] == ["sightseer:0", "seed-spreader:0"]
        for task in settings.tasks():
            record = judge(task, list(parts(SOUND)), audited=True)
            assert (record.result, record.detail) == ("passed", "")
            assert len(record.rows) == (2 if task.strategy == "sightseer" else 0)

    def test_of_families_have_all_sizes_in_turn(self) -> None:
        source = SceneSource("staircases", 6, 8)
        settings = replace(QUICK, source=source)
        with opened(settings) as store:
            conduct(settings, store, 1)
            found = dict(store.rows("SELECT seed, outcome FROM scenes"))
            assert found == dict.fromkeys(range(4), "passed")
        edges = [
            sum(len(o.edges) for o in source.scene(t).obstacles if not o.is_enclosure)
            for t in settings.tasks()
        ]
        assert edges == [6, 7, 8, 6]

    def test_without_claims_are_those_of_run_and_audit(self) -> None:
        record = judge(Task("sightseer", 0), list(parts(claims_at(""))), audited=True)
        assert (record.result, record.rows) == ("passed", ())
        assert record.length is not None and record.length > 0

    def test_seeds_of_campaigns_are_apart(self) -> None:
        first, second = (set(Settings(scenes=50, seed=seed).tasks()) for seed in (4, 5))
        assert len(first) == 100
        assert not first & second


class TestFailures:
    def test_a_failing_scene_is_stored_and_can_be_replayed(self) -> None:
        settings = replace(QUICK, claims="planted_claims:FALSE", scenes=4)
        with opened(settings) as store:
            conduct(settings, store, 1)
            assert faults(store) == [(Task("sightseer", 3), "no_third (printed) fails", "the third")]
            ((text,),) = store.rows("SELECT json FROM scenes WHERE seed = 3")
            again = scene_of(parse_json(text.encode()))
            assert scene_to_json(again) == scene_to_json(random_scene(Subject.SIGHTSEER, 3))
            assert no_third(Case(again)).outcome is Outcome.FAILS

    def test_a_statement_called_false_may_fail(self) -> None:
        with opened(QUICK) as store:
            store.add([judge(task, list(parts(SOUND)), audited=False) for task in QUICK.tasks()], 0)
            assert not faults(store)
            true, false = tallies(store)
            assert (true.held, true.silent, true.failed) == (4, 0, 0)
            assert (false.called.truth, false.held + false.failed) == ("false", 4)
            assert false.failed > 0

    def test_the_worst_ratio_and_its_first_scene(self) -> None:
        rows = [judging.Row("positive", "printed", "holds", ratio) for ratio in (0.5, 0.75, 0.75, None)]
        records = [Record(Task("sightseer", k), "passed", rows=(row,)) for k, row in enumerate(rows)]
        with opened(QUICK) as store:
            store.add(records, 0)
            tally = tallies(store)[0]
            assert (tally.worst, tally.at, tally.tried) == (0.75, Task("sightseer", 1), 4)

    def test_a_failed_audit_is_a_fault(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def flawed(*_: object, **__: object) -> None:
            raise AuditError("planted flaw")

        monkeypatch.setattr(judging, "audit", flawed)
        record = judge(Task("sightseer", 0), list(parts(SOUND)), audited=True)
        assert (record.result, record.detail, len(record.rows)) == ("audit failed", "planted flaw", 2)
        with opened(QUICK) as store:
            store.add([record], 0)
            assert faults(store) == [(record.task, "audit failed", "planted flaw")]

    def test_a_scene_that_cannot_be_made_is_an_error(self) -> None:
        """It killed two workers, and then the coordinator, which made it once more for the record."""
        record = judge(Task("sightseer", 3), [], True, SceneSource("cubes"))
        assert (record.result, record.scene) == ("error", None)
        assert record.detail.startswith("ValueError: 'cubes' is not a valid Family")

    def test_undecided_and_broken_checks_are_no_passes(self) -> None:
        settings = replace(QUICK, claims="planted_claims:DOUBTFUL", scenes=3)
        with opened(settings) as store:
            conduct(settings, store, 1)
            assert store.rows("SELECT outcome FROM scenes ORDER BY seed") == [
                ("undecided",), ("error",), ("passed",),
            ]  # fmt: skip
            tally = tallies(store)[0]
            assert (tally.tried, tally.held, tally.unanswered) == (3, 1, 2)
            assert [task.seed for task, *_ in faults(store)] == [1]
            assert [task.seed for task, *_ in unfinished(store)] == [0]
            assert "ZeroDivisionError: planted (in doubt)" in faults(store)[0][2]

    @by_night
    def test_a_scene_that_hangs_is_a_timeout(self) -> None:
        settings = replace(QUICK, claims="planted_claims:HANGING", scenes=3, timeout=3)
        with opened(settings) as store:
            conduct(settings, store, 1)
            assert store.rows("SELECT outcome, json IS NULL FROM scenes ORDER BY seed") == [
                ("passed", 1), ("timeout", 0), ("passed", 1),
            ]  # fmt: skip
            assert not faults(store)
            assert [task.seed for task, *_ in unfinished(store)] == [1]


class TestKills:
    def test_a_killed_worker_loses_nothing(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, expected: list[Any]
    ) -> None:
        monkeypatch.setenv(MARK, str(tmp_path / "mark"))
        settings = replace(QUICK, claims="planted_claims:DYING_ONCE")
        with opened(settings) as store:
            conduct(settings, store, 2)
            assert (tmp_path / "mark").exists()
            assert verdicts(store) == expected

    @by_night
    def test_a_scene_that_kills_every_process_is_given_up(self) -> None:
        settings = replace(QUICK, claims="planted_claims:DYING", scenes=4)
        with opened(settings) as store:
            conduct(settings, store, 1)
            assert store.rows("SELECT seed FROM scenes WHERE outcome = 'passed'") == [(0,), (1,), (3,)]
            assert [(task.seed, what) for task, what, _ in faults(store)] == [(2, "crashed")]

    @by_night
    def test_workers_that_cannot_start_are_an_error(self) -> None:
        settings = replace(QUICK, claims="planted_claims:NOTHING")
        with Store(None, settings, []) as store, pytest.raises(ProcessError, match="end before they take up"):
            conduct(settings, store, 1)

    def test_a_killed_coordinator_loses_nothing(self, tmp_path: Path) -> None:
        path, settings = tmp_path / "campaign.sqlite", replace(QUICK, claims="planted_claims:SLOW")
        code = (
            "from test_campaign import *\n"
            f"settings = replace(QUICK, claims={settings.claims!r})\n"
            f"conduct(settings, opened(settings, Path({str(path)!r})), 2)"
        )
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        coordinator = subprocess.Popen([sys.executable, "-c", code], env=environment)
        deadline = time.monotonic() + 30
        while _committed(path) < 1 and time.monotonic() < deadline:
            time.sleep(0.05)
        coordinator.kill()
        assert coordinator.wait() == -signal.SIGKILL
        kept = _committed(path)
        assert 1 <= kept < settings.scenes
        judged: list[Record] = []
        with opened(settings, path) as store:
            before = verdicts(store)
            conduct(settings, store, 1, report=judged.append)
            assert len(judged) == settings.scenes - kept
            assert set(before) <= set(verdicts(store))
            assert store.done() == set(settings.tasks())


def _committed(path: Path) -> int:
    """The number of scenes in the file, as another process sees it."""
    if not path.exists():
        return 0
    base = sqlite3.connect(path)
    try:
        return int(base.execute("SELECT count(*) FROM scenes").fetchone()[0])
    except sqlite3.OperationalError:
        return 0
    finally:
        base.close()


class TestFile:
    def test_goes_on_where_it_stopped(self, tmp_path: Path, expected: list[Any]) -> None:
        path = tmp_path / "campaign.sqlite"
        records = [judge(task, list(parts(SOUND)), audited=False) for task in list(QUICK.tasks())[:2]]
        with opened(QUICK, path) as store:
            store.add(records, 7.5)
        judged: list[Record] = []
        with opened(QUICK, path) as store:
            conduct(QUICK, store, 1, report=judged.append)
            assert [record.task.seed for record in judged] == [2, 3]
            assert verdicts(store) == expected
            assert store.wall > 7.5
            conduct(QUICK, store, 1, report=judged.append)
        assert len(judged) == 2

    def test_a_scene_is_counted_once(self) -> None:
        record = judge(Task("sightseer", 0), list(parts(SOUND)), audited=False)
        with opened(QUICK) as store:
            store.add([record, record], 0)
            store.add([record], 0)
            assert tallies(store)[0].tried == 1

    @pytest.mark.parametrize(
        ("changed", "word"),
        [({"seed": 1}, "seed"), ({"scenes": 7}, "scenes"), ({"audit": True}, "audit"),
         ({"timeout": 9}, "timeout"), ({"strategies": ("seed-spreader",)}, "strategies"),
         ({"claims": "planted_claims:FALSE"}, "claims"), ({"source": SceneSource("gears")}, "source"),
         ({"source": SceneSource("gears", 5, 6)}, "source")],
    )  # fmt: skip
    def test_of_another_campaign_is_refused(self, tmp_path: Path, changed: Any, word: str) -> None:
        path = tmp_path / "campaign.sqlite"
        opened(QUICK, path).__exit__(None, None, None)
        with pytest.raises(CampaignError, match=f"made with {word}"):
            opened(replace(QUICK, **changed), path)

    def test_of_another_version_is_refused(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        path = tmp_path / "campaign.sqlite"
        opened(QUICK, path).__exit__(None, None, None)
        monkeypatch.setattr("exactacq.study.campaign.settings.version", lambda _: "0.0.1")
        with pytest.raises(CampaignError, match=r"made with version .*, not 0\.0\.1"):
            opened(QUICK, path)

    def test_with_other_statements_is_refused(self, tmp_path: Path) -> None:
        path = tmp_path / "campaign.sqlite"
        Store(path, QUICK, []).__exit__(None, None, None)
        with pytest.raises(CampaignError, match="other statements"):
            opened(QUICK, path)

    def test_foreign_files_are_refused_and_left(self, tmp_path: Path) -> None:
        text, base = tmp_path / "notes.txt", tmp_path / "other.sqlite"
        text.write_text("not a database, but long enough to be looked at" * 20)
        with sqlite3.connect(base) as other:
            other.execute("CREATE TABLE scenes (mine TEXT)")
        other.close()
        for path in (text, base):
            before = path.read_bytes()
            with pytest.raises(CampaignError, match="file"):
                opened(QUICK, path)
            assert path.read_bytes() == before
        with pytest.raises(CampaignError, match="cannot be used"):
            opened(QUICK, tmp_path / "missing" / "campaign.sqlite")


app = typer.Typer()
app.command()(command.verify)


@pytest.fixture
def planted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The command line with the claims of this module."""
    monkeypatch.setattr(Settings, "__init__", _with_claims(Settings.__init__))


def _with_claims(make: Callable[..., None]) -> Callable[..., None]:
    def init(self: Settings, *values: object, **named: object) -> None:
        make(self, *values, **{"claims": "planted_claims:FALSE", **named})

    return init


@pytest.mark.usefixtures("planted")
class TestCommand:
    ARGUMENTS = ("--scenes", "4", "--strategy", "sightseer", "--no-audit", "--workers", "1")

    def test_summary_table_and_replay(self, tmp_path: Path) -> None:
        parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")
        table, out = tmp_path / "t.parquet", tmp_path / "c.sqlite"
        done = CliRunner().invoke(app, [*self.ARGUMENTS, "--out", str(out), "--export", str(table)])
        assert done.exit_code == 1
        assert "exactacq verify --replay sightseer:3" in done.output
        assert "4 scenes: 4 passed, 0 undecided, 0 timeout, 0 audit failed, 0 crashed, 0 error" in done.output
        assert "verify: 4 of 4 scenes, 0 not passed" in done.output
        read = parquet.read_table(table)
        assert read.schema.metadata[b"seed"] == b"0"
        settings = replace(QUICK, scenes=4, claims="planted_claims:FALSE")
        with opened(replace(settings, timeout=120.0), out) as store:
            rows = store.rows("SELECT strategy, seed, claim, outcome, ratio FROM findings ORDER BY 2, 1, 3")
        names = ("strategy", "seed", "claim", "outcome", "ratio")
        assert [tuple(row[name] for name in names) for row in read.to_pylist()] == rows
        assert len(rows) == 12
        again = CliRunner().invoke(app, ["--replay", "sightseer:3", "--no-audit"])
        assert again.exit_code == 1
        assert "the third" in again.output

    def test_families_are_named_where_a_scene_is_to_be_seen_again(self) -> None:
        options = ("--family", "staircases", "--size", "6..8")
        done = CliRunner().invoke(app, [*self.ARGUMENTS, *options])
        assert "exactacq verify --family staircases --size 6..8 --replay sightseer:3" in done.output
        again = CliRunner().invoke(app, [*options, "--replay", "sightseer:3", "--no-audit"])
        assert (again.exit_code, "the third" in again.output) == (1, True)
        silent = CliRunner().invoke(app, [*options, "--replay", "sightseer:3", "--no-claims"])
        assert (silent.exit_code, "the third" in silent.output) == (0, False)

    @pytest.mark.parametrize("text", ["4", "301", "9..8", "5..", "..9", "5..6..7", "-5", "x", "5,6", ""])
    def test_sizes_that_are_none_are_refused(self, text: str) -> None:
        with pytest.raises(FormatError, match="--size"):
            CliRunner().invoke(app, ["--family", "gears", "--size", text], catch_exceptions=False)

    def test_sizes_are_those_of_a_family(self) -> None:
        assert (sizes_of("12"), sizes_of("5..300")) == ((12, 12), (5, 300))
        with pytest.raises(FormatError, match="--family"):
            CliRunner().invoke(app, ["--size", "5..9"], catch_exceptions=False)

    def test_exit_status_0_if_nothing_true_fails(self) -> None:
        done = CliRunner().invoke(app, [*self.ARGUMENTS, "--scenes", "2"])
        assert done.exit_code == 0
        assert CliRunner().invoke(app, ["--replay", "sightseer:0", "--no-audit"]).exit_code == 0

    @pytest.mark.parametrize(
        "text", ["17", "sightseer:-1", "both:3", "sightseer:x", "sightseer:", f"sightseer:{'9' * 5000}"]
    )
    def test_a_scene_that_is_none_is_refused(self, text: str) -> None:
        with pytest.raises(FormatError, match="not a scene"):
            CliRunner().invoke(app, ["--replay", text], catch_exceptions=False)

    def test_outputs_are_refused_before_work(self, tmp_path: Path) -> None:
        def refused(*arguments: str) -> str:
            with pytest.raises((FormatError, CampaignError)) as caught:
                CliRunner().invoke(app, arguments, catch_exceptions=False)
            return str(caught.value)

        assert ".parquet" in refused("--export", str(tmp_path / "t.csv"))
        assert ".sqlite" in refused("--out", str(tmp_path / "scene.json"))
        assert "leave it out" in refused("--workers", "2", "--scheduler", "tcp://127.0.0.1:1")
        assert "no directory" in refused("--export", str(tmp_path / "missing" / "t.parquet"))
        assert "writes nothing" in refused("--replay", "sightseer:1", "--out", "x.sqlite")

    @pytest.mark.parametrize(
        ("module", "option", "value"),
        [("pyarrow", "--export", "t.parquet"), ("distributed", "--scheduler", "tcp://127.0.0.1:1")],
    )
    def test_missing_extras_are_named(
        self, module: str, option: str, value: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
    ) -> None:
        monkeypatch.setitem(sys.modules, module, None)
        monkeypatch.chdir(tmp_path)
        with pytest.raises(
            CampaignError, match=rf"{option} needs .*: in a clone of exactacq, pip install '\.\["
        ):
            CliRunner().invoke(app, [option, value], catch_exceptions=False)
