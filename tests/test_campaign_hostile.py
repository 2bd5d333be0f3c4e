"""Campaigns in a hostile world: no room, files damaged, mixed up or another's, two coordinators at once.

`stress_campaign` attacks whole commands, with kills too; what it found is in the cases below.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import Any

import pytest
from hostile_mounts import cannot_mount, ending, in_own_mounts, without_override
from nightly import by_night
from test_campaign import QUICK, SOUND, opened, verdicts

from exactacq.cli.entry import main
from exactacq.study import processes
from exactacq.study.campaign import store as stores
from exactacq.study.campaign.judging import Record, judge
from exactacq.study.campaign.settings import CampaignError, parts
from exactacq.study.processes import Lost, ProcessError, Team

NOISE = bytes(range(256)) * 16


@pytest.fixture(scope="module")
def records() -> list[Record]:
    """All scenes of QUICK, judged."""
    return [judge(task, list(parts(SOUND)), audited=False) for task in QUICK.tasks()]


@pytest.fixture
def whole(tmp_path: Path, records: list[Record]) -> Path:
    """The file of a campaign that is done."""
    path = tmp_path / "whole.sqlite"
    with opened(QUICK, path) as store:
        store.add(records, 1)
    return path


def pending(path: Path, count: int) -> None:
    """A file in WAL mode whose rows are in the file beside, as after a kill of who wrote them."""
    code = (
        "import os, sqlite3\n"
        f"base = sqlite3.connect({str(path)!r}, isolation_level=None)\n"
        "base.execute('PRAGMA journal_mode = WAL')\n"
        "base.execute('CREATE TABLE mine (k INTEGER PRIMARY KEY, text TEXT)')\n"
        f"for k in range({count}): base.execute('INSERT INTO mine VALUES (?, ?)', (k, 'x' * 99))\n"
        "os._exit(0)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    assert Path(f"{path}-wal").stat().st_size > 0


class TestNoRoom:
    def test_loses_nothing_that_is_judged(self, tmp_path: Path, records: list[Record]) -> None:
        """Errors of SQLite after the opening were internal errors."""
        path = tmp_path / "campaign.sqlite"
        big = [record._replace(detail="x" * 50_000) for record in records]
        with opened(QUICK, path) as store:
            store.add(big[:2], 1)
            store.rows("PRAGMA max_page_count = 40")
            with pytest.raises(CampaignError, match=r"what is judged so far is kept, but .* full$"):
                store.add(big[2:], 2)
            assert len(store.done()) == 2
        with opened(QUICK, path) as store:
            assert store.done() == {record.task for record in records[:2]}
            store.add(big[2:], 3)
            assert len(store.done()) == 4

    def test_is_told_in_one_line(self, whole: Path, capfd: pytest.CaptureFixture[str]) -> None:
        with closing(sqlite3.connect(whole)) as other:
            other.execute("DROP TABLE findings")
        assert main(["verify", "--scenes", "4", "--out", str(whole)]) == 2
        out, told = capfd.readouterr()
        assert (out, told.count("\n")) == ("", 1)
        assert "not the file of a campaign" in told


PLAIN = replace(QUICK, claims="")
"""What `COMMAND` asks for."""
COMMAND = [
    *(sys.executable, "-m", "exactacq", "verify", "--scenes", "4", "--strategy", "sightseer"),
    *("--no-audit", "--no-claims", "--workers", "1", "--out"),
]


@pytest.fixture(scope="module")
def plain() -> list[Record]:
    """All scenes of PLAIN, judged."""
    return [judge(task, [], audited=False) for task in PLAIN.tasks()]


class TestFileSystems:
    """The command on a file system that is full or read-only, and in a folder that may not be written."""

    @pytest.fixture
    def half(self, tmp_path: Path, plain: list[Record]) -> Path:
        """The file of a campaign of which two scenes are judged."""
        path = tmp_path / "half.sqlite"
        with opened(PLAIN, path) as store:
            store.add(plain[:2], 1)
        return path

    def only_line(self, told: Path) -> str:
        """What was told beside how far the campaign is."""
        (line,) = [line for line in told.read_text().splitlines() if not line.startswith("verify:")]
        return line

    @by_night
    @pytest.mark.skipif(bool(cannot_mount()), reason=f"nothing can be mounted: {cannot_mount()}")
    def test_a_full_one_keeps_what_is_judged(self, half: Path, plain: list[Record]) -> None:
        """Room for the file, its index of 32 KB and what the opening writes; then for all."""
        mount, kept = half.parent / "mount", half.parent / "kept"
        mount.mkdir()
        kept.mkdir()
        path, room = mount / half.name, half.stat().st_size + 32 * 1024 + 8 * 1024
        command = shlex.join([*COMMAND, str(path)])
        script = [
            f"mount -t tmpfs -o size={room} none {mount}",
            f"cp {half} {mount}",
            ending(command, half.parent / "full"),
            f"cp {mount}/* {kept}",
            f"mount -o remount,size=10m {mount}",
            ending(command, half.parent / "room"),
            f"cp {path} {half}",
        ]
        done = in_own_mounts("\n".join(script))
        assert (done.stdout, done.stderr, done.returncode) == ("2\n0\n", "", 0)
        full = f"exactacq: {path}: what is judged so far is kept, but no more can be written: "
        assert self.only_line(half.parent / "full") == f"{full}database or disk is full"
        with opened(PLAIN, kept / half.name) as store:
            assert store.done() == {record.task for record in plain[:2]}
        with opened(PLAIN, half) as store, opened(PLAIN) as expected:
            expected.add(plain, 1)
            assert verdicts(store) == verdicts(expected)

    @pytest.mark.skipif(bool(cannot_mount()), reason=f"nothing can be mounted: {cannot_mount()}")
    def test_one_that_is_read_only_is_told_before_work(self, half: Path) -> None:
        mount, told = half.parent / "mount", half.parent / "told"
        mount.mkdir()
        script = [
            f"mount -t tmpfs none {mount}",
            f"cp {half} {mount}",
            f"mount -o remount,ro {mount}",
            ending(shlex.join([*COMMAND, f"{mount / half.name}"]), told),
            f"cmp {half} {mount / half.name}",
        ]
        done = in_own_mounts("\n".join(script))
        assert (done.stdout, done.stderr, done.returncode) == ("2\n", "", 0)
        assert told.read_text() == (
            f"exactacq: {mount / half.name}: the directory {mount} cannot be written to\n"
        )

    @pytest.mark.skipif(not hasattr(os, "geteuid"), reason="no rights of files as Unix has them")
    @pytest.mark.parametrize(
        ("folder_mode", "file_mode", "words"),
        [
            (0o555, 0o644, "the directory .* cannot be written to"),
            (0o755, 0o444, "cannot be used .* readonly"),
        ],
        ids=["folder", "file"],
    )
    def test_what_may_not_be_written_is_told_before_work(
        self, half: Path, folder_mode: int, file_mode: int, words: str
    ) -> None:
        before = half.read_bytes()
        half.chmod(file_mode)
        half.parent.chmod(folder_mode)
        done = subprocess.run(
            [*COMMAND, str(half)], capture_output=True, text=True, check=False, preexec_fn=without_override
        )
        half.parent.chmod(0o755)
        assert (done.returncode, done.stdout) == (2, "")
        assert re.fullmatch(f"exactacq: {half}: .*{words}.*\n", done.stderr)
        assert half.read_bytes() == before


class TestDamage:
    @pytest.mark.parametrize(
        ("change", "words"),
        [
            ("UPDATE scenes SET seconds = 'long'", "a value of the wrong type among the scenes"),
            ("UPDATE findings SET detail = x'ff'", "a value of the wrong type among the findings"),
            ("UPDATE scenes SET length = 'far'", "a value of the wrong type among the scenes"),
            ("UPDATE scenes SET seed = seed + 100", "scenes that were not asked for"),
            ("DELETE FROM scenes WHERE seed = 2", "findings of scenes that are not there"),
            ("UPDATE campaign SET value = 'much' WHERE key = 'wall'", "the seconds spent are no number"),
            ("DELETE FROM campaign WHERE key = 'wall'", "the seconds spent are no number"),
            ("PRAGMA application_id = 7", "not the file of a campaign"),
            ("CREATE TRIGGER t AFTER INSERT ON scenes BEGIN DELETE FROM scenes; END", "not the file of a"),
            ("ALTER TABLE scenes ADD COLUMN extra", "not the file of a campaign"),
            ("UPDATE campaign SET value = hex(zeroblob(9999)) WHERE key = 'seed'", r"made with seed 0{160},"),
        ],
    )
    def test_of_values_and_tables_is_told(self, whole: Path, change: str, words: str) -> None:
        with closing(sqlite3.connect(whole)) as other, other:
            other.execute(change)
        self.refused(whole, words)

    def test_of_bytes_is_told(self, whole: Path, tmp_path: Path) -> None:
        data = whole.read_bytes()
        cases: dict[str, tuple[bytes, str]] = {
            "half": (data[: len(data) // 2], "damaged"),
            "page": (data[: 2 * 4096] + NOISE + data[3 * 4096 :], "damaged|not the file"),
            "tail": (data[:-4096] + NOISE, "damaged"),
            "text": (b"notes\n" * 2000, "file is not a database"),
        }
        for name, (damaged, words) in cases.items():
            path = tmp_path / f"{name}.sqlite"
            path.write_bytes(damaged)
            self.refused(path, words)

    def test_of_an_index_is_told(self, whole: Path) -> None:
        """Scenes were looked up in an index that named others than the table."""
        data = whole.read_bytes()
        key = b"sightseer\x03"  # the last scene, in the table and in the index
        places = [k for k in range(len(data)) if data.startswith(key, k)]
        assert places
        spoilt = bytearray(data)
        spoilt[places[-1] + len(key) - 1] ^= 4
        whole.write_bytes(spoilt)
        self.refused(whole, "damaged")

    def test_another_ones_pending_results_are_not_merged(self, whole: Path, records: list[Record]) -> None:
        """SQLite takes any -wal for the file's own; closing merged it, and all results were gone."""
        other = whole.with_name("other.sqlite")
        pending(other, 500)
        shutil.copy(f"{other}-wal", f"{whole}-wal")
        self.refused(whole, r"not the file of a campaign|is not of the same campaign, take it away")
        for beside in ("-wal", "-shm"):
            Path(f"{whole}{beside}").unlink(missing_ok=True)
        with opened(QUICK, whole) as store:
            assert store.done() == {record.task for record in records}

    def test_another_ones_journal_is_not_rolled_back(self, whole: Path) -> None:
        Path(f"{whole}-journal").write_bytes(NOISE)
        self.refused(whole, "whole.sqlite-journal: not of the campaign beside it; take it away")

    def test_a_journal_of_the_first_page_is(self, tmp_path: Path, records: list[Record]) -> None:
        """As after a kill in the first moments."""
        path = tmp_path / "campaign.sqlite"
        path.write_bytes(b"")
        Path(f"{path}-journal").write_bytes(b"")
        with opened(QUICK, path) as store:
            store.add(records, 1)
            assert len(store.done()) == 4

    @pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
    def test_what_is_no_regular_file_is_refused(self, tmp_path: Path) -> None:
        os.mkfifo(tmp_path / "pipe.sqlite")
        (tmp_path / "null.sqlite").symlink_to(os.devnull)
        (tmp_path / "loop.sqlite").symlink_to("loop.sqlite")
        for name, words in (("pipe", "not a regular"), ("null", "not a regular"), ("loop", "cannot be used")):
            with pytest.raises(CampaignError, match=words):
                opened(QUICK, tmp_path / f"{name}.sqlite")

    def refused(self, path: Path, words: str) -> None:
        """In one line; the file stays as it is."""
        before = path.read_bytes()
        with pytest.raises(CampaignError, match=words) as error:
            opened(QUICK, path)
        assert "\n" not in str(error.value) and len(str(error.value)) < 1000
        assert path.read_bytes() == before


class TestTwoAtOnce:
    def test_count_each_scene_once(self, tmp_path: Path, records: list[Record]) -> None:
        path = tmp_path / "campaign.sqlite"
        with opened(QUICK, path) as first, opened(QUICK, path) as second:
            for record in records:
                first.add([record], 1)
                second.add([record], 2)
            assert verdicts(first) == verdicts(second)
            assert len(first.done()) == len(first.rows("SELECT * FROM scenes")) == 4

    def test_may_begin_at_the_same_moment(self, whole: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        """Another one made the tables after this one saw that there were none."""
        monkeypatch.setattr(stores, "_is_begun", lambda _: False)
        with opened(QUICK, whole) as store:
            assert len(store.done()) == 4
        with pytest.raises(CampaignError, match="made with seed 0, not 1"):
            opened(replace(QUICK, seed=1), whole)

    def test_wait_for_each_other_for_a_while(self, whole: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(stores, "PATIENCE", 0.2)
        with closing(sqlite3.connect(whole, isolation_level=None)) as other:
            other.execute("BEGIN IMMEDIATE")
            with pytest.raises(CampaignError, match="database is locked"):
                opened(QUICK, whole)


# -- processes -----------------------------------------------------------------------------------------


def slow() -> Callable[[Any], Any]:
    """Makes work that takes a moment."""
    return _slowly


def _slowly(task: int) -> int:
    time.sleep(0.3)
    return task


def test_a_limit_may_be_infinite() -> None:
    """More seconds than the platform can wait ended `verify --timeout inf` and `search --limit inf`."""
    with Team(slow, 1, inf) as team:
        assert list(team.results([1])) == [(1, 1)]


@by_night
def test_results_that_came_in_time_are_taken_late() -> None:
    """All processes whose time was over after a pause of the coordinator were killed, finished or not."""
    with Team(slow, 2, 1.5) as team:
        found: list[int | Lost] = []
        for _, answer in team.results(range(8)):
            found.append(answer)
            if len(found) == 4:  # by now both are at work
                time.sleep(2)
    assert set(found) == set(range(8))


def _never_ready() -> Callable[[int], int]:
    time.sleep(600)
    raise AssertionError("the process is killed before")


@by_night
def test_processes_that_never_start_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that was stopped while it started had no deadline, and the campaign waited for ever."""
    monkeypatch.setattr(processes, "START", 0.5)
    with (
        Team(_never_ready, 1, 5) as team,
        pytest.raises(ProcessError, match=r"not ready .* after 0.5 seconds"),
    ):
        list(team.results([1]))
