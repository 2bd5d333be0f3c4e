"""Attacks on campaigns: processes killed, files damaged, no room, no rights, two at once.

``python tests/stress_campaign.py [ATTACK...] [--times N]`` makes the attacks named (all: see `ATTACKS`), each
N times where it is made of random moments or places, and prints one line a kind with counts. After each
attack the same command must finish the campaign with the verdicts of an undisturbed one, or end with status
2 and one line, and leave the file as it was. For Linux: children are found in /proc. Takes half an hour.
"""

from __future__ import annotations

import os
import resource
import shlex
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from random import Random

from hostile_mounts import cannot_mount, ending, in_own_mounts, without_override

SECONDS = 120
"""Most time for a command that has little to do, on a busy machine."""
ALONE = 10
"""Seconds within which workers notice that their coordinator is gone."""
SCENES = 30
"""Scenes of the campaigns whose processes are killed: another seed follows when all are judged."""
FEW = 6
"""Scenes of the campaign whose file is damaged."""


def command(path: Path, scenes: int, seed: int, workers: int = 2) -> list[str]:
    """The command line of a campaign."""
    own = ["--scenes", str(scenes), "--seed", str(seed), "--strategy", "sightseer", "--no-audit"]
    return [sys.executable, "-m", "exactacq", "verify", *own, "--workers", str(workers), "--out", str(path)]


def verdicts(path: Path) -> list[tuple[object, ...]]:
    """All that a campaign found, without the times that it took."""
    with closing(sqlite3.connect(path)) as base:
        scenes = base.execute(
            "SELECT strategy, seed, outcome, length, detail, json FROM scenes ORDER BY 1, 2"
        )
        found = scenes.fetchall()
        columns = "strategy, seed, claim, statement, outcome, ratio, detail"
        return found + base.execute(f"SELECT {columns} FROM findings ORDER BY 1, 2, 3, 4").fetchall()


def judged(path: Path) -> set[tuple[object, ...]]:
    """The scenes of a file, as another process sees it while it is written."""
    try:
        with closing(sqlite3.connect(path)) as base:
            return set(base.execute("SELECT strategy, seed, outcome, seconds FROM scenes"))
    except sqlite3.OperationalError:
        return set()


class Stage:
    """A folder, random numbers, the undisturbed campaigns, and what went wrong."""

    def __init__(self, folder: Path, times: int) -> None:
        self.folder, self.times, self.random = folder, times, Random(1)
        self.counts: Counter[str] = Counter()
        self._expected: dict[tuple[int, int], Path] = {}

    def undisturbed(self, scenes: int, seed: int) -> Path:
        """The file of a campaign that nothing happened to."""
        if (scenes, seed) not in self._expected:
            path = self.folder / f"undisturbed-{scenes}-{seed}.sqlite"
            subprocess.run(command(path, scenes, seed), capture_output=True, check=False)
            self._expected[scenes, seed] = path
        return self._expected[scenes, seed]

    def ended(self, what: str, status: int | None, told: str, *allowed: int) -> None:
        """Count how a command ended; a flaw if not by one of the statuses, or not in one line."""
        lines = [line for line in told.splitlines() if not line.startswith("verify:")]
        right = status in allowed and len(lines) == (0 if status in (0, 1) else 1)
        self.counts[f"{what}: status {status}"] += 1
        if not right:
            self.flaw(f"{what}: status {status}: {told[-2000:]}")

    def flaw(self, words: str) -> None:
        """Tell and count what must not be."""
        self.counts["FLAWS"] += 1
        print(f"FLAW {words}", flush=True)

    def same(self, what: str, path: Path, scenes: int, seed: int) -> None:
        """Whether a file has the verdicts of the undisturbed campaign."""
        if verdicts(path) != verdicts(self.undisturbed(scenes, seed)):
            self.flaw(f"{what}: other verdicts than undisturbed")

    def finish(self, what: str, path: Path, scenes: int, seed: int) -> None:
        """The same command goes on to the end."""
        done = subprocess.run(command(path, scenes, seed), capture_output=True, text=True, check=False)
        self.ended(f"{what}, then whole", done.returncode, done.stderr, 0, 1)
        self.same(what, path, scenes, seed)


def children(parent: int) -> list[int]:
    """The processes that a process began."""
    out = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[1]) == parent and fields[0] != "Z":
                out.append(int(entry.name))
    return out


def is_at_work(pid: int) -> bool:
    """Whether a process is there and is a worker's."""
    try:
        return b"exactacq.study.processes" in Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


# -- attacks -------------------------------------------------------------------------------------------


def coordinators(stage: Stage) -> None:
    """The coordinator is killed at random moments; the same command goes on."""
    seed, path = 0, stage.folder / "coordinators.sqlite"
    for _ in range(stage.times):
        before = judged(path)
        process = subprocess.Popen(
            command(path, SCENES, seed), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        moment = stage.random.choice((2, 8, 8)) * stage.random.random()
        try:
            process.wait(moment)
            stage.counts["whole before the kill"] += 1
            workers = []
        except subprocess.TimeoutExpired:
            workers = children(process.pid)
            process.kill()
            process.wait()
            stage.counts["kills"] += 1
        after = judged(path)
        if not before <= after:
            stage.flaw("coordinators: what was judged is lost")
        deadline = time.monotonic() + ALONE
        while any(map(is_at_work, workers)) and time.monotonic() < deadline:
            time.sleep(0.1)
        if any(map(is_at_work, workers)):
            stage.flaw("coordinators: workers go on without theirs")
        if len(after) == SCENES:
            stage.same("coordinators", path, SCENES, seed)
            seed, path = seed + 1, stage.folder / f"coordinators-{seed + 1}.sqlite"
    stage.finish("coordinators", path, SCENES, seed)
    stage.counts["campaigns"] = seed + 1


def workers(stage: Stage) -> None:
    """Random workers are killed while the coordinator goes on."""
    kills, seed, path = 0, 100, stage.folder / "workers-100.sqlite"
    while kills < stage.times:
        process = subprocess.Popen(
            command(path, SCENES, seed), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        while process.poll() is None and kills < stage.times:
            time.sleep(4 * stage.random.random())
            if found := [pid for pid in children(process.pid) if is_at_work(pid)]:
                os.kill(stage.random.choice(found), signal.SIGKILL)
                kills += 1
        _, told = process.communicate(timeout=20 * SECONDS)
        # If the kills meet processes that begin, again and again, the coordinator gives up for now.
        stage.ended("workers", process.returncode, told, 0, 1, 2)
        if process.returncode == 2:
            continue
        # A scene over which two processes died is recorded as crashed: so it is told to be.
        got, expected = verdicts(path), set(verdicts(stage.undisturbed(SCENES, seed)))
        crashed = {row[:2] for row in got if row[2] == "crashed"}
        stage.counts["killed twice over one scene"] += len(crashed)
        lost = {row for row in expected if row[:2] not in crashed} - set(got)
        if lost or len({row[1] for row in got}) != SCENES:
            stage.flaw(f"workers: {len(lost)} verdicts differ")
        seed += 1
        path = stage.folder / f"workers-{seed}.sqlite"
    stage.counts["kills"] = kills


def pairs(stage: Stage) -> None:
    """Two coordinators begin, and go on, in one file at once."""
    for k in range(max(1, stage.times // 10)):
        path = stage.folder / f"pairs-{k}.sqlite"
        both = [
            subprocess.Popen(
                command(path, FEW, 0, 1), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
            )
            for _ in range(2)
        ]
        for process in both:
            _, told = process.communicate(timeout=5 * SECONDS)
            stage.ended("pairs", process.returncode, told, 0, 1)
        stage.same("pairs", path, FEW, 0)


def room(stage: Stage) -> None:
    """No file may grow beyond a size, as on a full disk; with room the same command goes on."""
    for size in (0, 1, 1000, 4096, 20_000, 33_000, 40_000, 50_000, 65_000, 80_000, 100_000, 150_000):
        path = stage.folder / f"room-{size}.sqlite"

        def limit(size: int = size) -> None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

        done = subprocess.run(
            command(path, FEW, 0), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
            preexec_fn=limit, timeout=5 * SECONDS, check=False,
        )  # fmt: skip
        kept = judged(path)
        stage.ended("room", done.returncode, done.stderr, 0, 1, 2)
        stage.finish("room", path, FEW, 0)
        if not kept <= judged(path):
            stage.flaw("room: what was judged is lost")


def mounts(stage: Stage) -> None:
    """File systems of some sizes that are full sooner or later; with room the same command goes on."""
    if reason := cannot_mount():
        stage.counts[f"left out: {reason}"] += 1
        return
    mount = stage.folder / "mount"
    mount.mkdir()
    path = mount / "a.sqlite"
    line = shlex.join(command(path, FEW, 0))
    for size in range(4, 164, 8):
        full, room = stage.folder / f"full-{size}", stage.folder / f"room-{size}"
        for folder in (full, room):
            folder.mkdir()
        script = [
            f"mount -t tmpfs -o size={size}k none {mount}",
            ending(line, full / "told"),
            f"cp {mount}/* {full} || true",
            f"mount -o remount,size=10m {mount}",
            ending(line, room / "told"),
            f"cp {mount}/* {room}",
        ]
        before, after = in_own_mounts("\n".join(script)).stdout.split()
        stage.ended("mounts", int(before), (full / "told").read_text(), 0, 1, 2)
        stage.ended("mounts, then room", int(after), (room / "told").read_text(), 0, 1)
        stage.same("mounts", room / path.name, FEW, 0)
        if not judged(full / path.name) <= judged(room / path.name):
            stage.flaw("mounts: what was judged is lost")


def rights(stage: Stage) -> None:
    """A folder and a file that may not be written; root gives up its rights."""
    for what, folder_mode, file_mode in (
        ("folder", 0o555, 0o644),
        ("file", 0o777, 0o444),
        ("both", 0o555, 0o444),
    ):
        folder = stage.folder / f"rights-{what}"
        folder.mkdir()
        path = folder / "a.sqlite"
        shutil.copy(stage.undisturbed(FEW, 0), path)
        path.chmod(file_mode)
        folder.chmod(folder_mode)
        for target in (path, folder / "new.sqlite") if what == "folder" else (path,):
            done = subprocess.run(
                command(target, FEW, 0), capture_output=True, text=True, timeout=SECONDS, check=False,
                preexec_fn=without_override,
            )  # fmt: skip
            stage.ended(f"rights of the {what}", done.returncode, done.stderr, 2)
        folder.chmod(0o755)
        if path.read_bytes() != stage.undisturbed(FEW, 0).read_bytes():
            stage.flaw(f"rights of the {what}: the file is changed")


def foreign(stage: Stage) -> None:
    """What is no campaign's file: other kinds of files, other applications' and versions'."""
    folder = stage.folder / "foreign"
    folder.mkdir()
    (folder / "text.sqlite").write_text("notes\n" * 500)
    (folder / "noise.sqlite").write_bytes(stage.random.randbytes(50_000))
    (folder / "magic.sqlite").write_bytes(b"SQLite format 3\0" + stage.random.randbytes(5000))
    (folder / "folder.sqlite").mkdir()
    os.mkfifo(folder / "pipe.sqlite")
    (folder / "loop.sqlite").symlink_to("loop.sqlite")
    (folder / "null.sqlite").symlink_to("/dev/null")
    (folder / "zero.sqlite").symlink_to("/dev/zero")
    (folder / "full.sqlite").symlink_to("/dev/full")
    (folder / "nowhere.sqlite").symlink_to("missing/x.sqlite")
    endless = "WITH RECURSIVE r(k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM r) SELECT k, k FROM r"
    commands = {
        "other": ["CREATE TABLE scenes (mine TEXT)"],
        "endless": ["PRAGMA application_id = 1702388067", f"CREATE VIEW campaign(key, value) AS {endless}"],
        "ahead": ["PRAGMA journal_mode = WAL", "CREATE TABLE scenes (mine TEXT)"],
    }
    changes = {
        "version": ["UPDATE campaign SET value = '0.0.1' WHERE key = 'version'"],
        "trigger": ["CREATE TRIGGER t AFTER INSERT ON scenes BEGIN DELETE FROM scenes; END"],
        "column": ["ALTER TABLE scenes ADD COLUMN extra"],
        "application": ["PRAGMA application_id = 7"],
        "types": ["UPDATE scenes SET seconds = 'long'"],
        "bytes": ["UPDATE findings SET detail = x'ff00'"],
        "wall": ["UPDATE campaign SET value = 'much' WHERE key = 'wall'"],
        "nowall": ["DELETE FROM campaign WHERE key = 'wall'"],
        "seeds": ["UPDATE scenes SET seed = seed + 1000"],
        "words": ["UPDATE campaign SET value = hex(zeroblob(9999)) WHERE key = 'seed'"],
    }
    for name in changes:
        shutil.copy(stage.undisturbed(FEW, 0), folder / f"{name}.sqlite")
    for name, lines in (commands | changes).items():
        with closing(sqlite3.connect(folder / f"{name}.sqlite")) as base, base:
            for line in lines:
                base.execute(line)
    for path in sorted(folder.iterdir()):
        refused(stage, "foreign", path)


def damage(stage: Stage) -> None:
    """Bits flipped, pages exchanged, the end cut off; files beside that are missing, damaged or others'."""
    whole = stage.undisturbed(FEW, 0)
    pending, other = _pending(stage, 0), _pending(stage, 1)
    for k in range(stage.times):
        folder = stage.folder / f"damage-{k}"
        folder.mkdir()
        path, ahead = folder / "a.sqlite", folder / "a.sqlite-wal"
        kind = stage.random.choice(
            ("bit", "cut", "page", "wal bit", "wal cut", "foreign wal", "foreign shm", "journal")
        )
        data = bytearray(whole.read_bytes())
        if kind in ("bit", "cut", "page"):
            _spoil(data, kind, stage.random)
            path.write_bytes(data)
        elif kind == "journal":
            path.write_bytes(data)
            Path(f"{path}-journal").write_bytes(
                b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7" + stage.random.randbytes(600)
            )
        elif kind == "foreign wal":
            shutil.copy(whole, path)
            shutil.copy(f"{other}-wal", ahead)
        else:
            shutil.copy(pending, path)
            data = bytearray(Path(f"{pending}-wal").read_bytes())
            if kind == "foreign shm":
                Path(f"{path}-shm").write_bytes(stage.random.randbytes(32768))
            else:
                _spoil(data, kind[4:], stage.random)
            ahead.write_bytes(data)
        refused(stage, kind, path, may_go_on=True)
        if kind == "foreign wal":  # Whatever was done, the file itself still has all.
            ahead.unlink(missing_ok=True)
            Path(f"{path}-shm").unlink(missing_ok=True)
            stage.same(kind, path, FEW, 0)


def _spoil(data: bytearray, kind: str, random: Random) -> None:
    if kind == "bit":
        data[random.randrange(len(data))] ^= 1 << random.randrange(8)
    elif kind == "cut":
        del data[random.randrange(len(data)) :]
    else:
        i, j = (4096 * random.randrange(len(data) // 4096) for _ in range(2))
        data[i : i + 4096] = data[j : j + 4096]


def _pending(stage: Stage, seed: int) -> Path:
    """A whole campaign whose results are still in the file beside, as after a kill."""
    path = stage.folder / f"pending-{seed}.sqlite"
    with closing(sqlite3.connect(stage.undisturbed(FEW, seed))) as base:
        lines = [f"{sql};" for (sql,) in base.execute("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL")]
        rows = [line for line in base.iterdump() if line.startswith("INSERT")]
    found = [line for line in rows if line.startswith(('INSERT INTO "scenes"', 'INSERT INTO "findings"'))]
    begun = [line for line in rows if line not in found]
    lines = ["BEGIN;", *lines, *begun, "COMMIT;", "BEGIN;", *found, "COMMIT;"]
    code = (
        "import os, sqlite3, sys\n"
        f"base = sqlite3.connect({str(path)!r}, isolation_level=None)\n"
        "base.execute('PRAGMA journal_mode = WAL')\n"
        "base.execute('PRAGMA application_id = 1702388067')\n"
        "base.executescript(sys.stdin.read())\n"
        "os._exit(0)"
    )
    subprocess.run([sys.executable, "-c", code], input="\n".join(lines), text=True, check=True)
    return path


def refused(stage: Stage, what: str, path: Path, may_go_on: bool = False) -> None:
    """The command refuses a file in one line, and leaves it; or goes on, with the same verdicts or others."""
    is_regular = path.is_file()
    before = path.read_bytes() if is_regular else b""
    done = subprocess.run(
        command(path, FEW, 0), capture_output=True, text=True, timeout=SECONDS, check=False
    )  # fmt: skip
    stage.ended(what, done.returncode, done.stderr, *((0, 1, 2) if may_go_on else (2,)))
    if done.returncode == 2 and is_regular and path.read_bytes() != before:
        stage.flaw(f"{what}: {path.name} was refused, but is changed")
    if done.returncode != 2 and may_go_on:
        is_same = verdicts(path) == verdicts(stage.undisturbed(FEW, 0))
        stage.counts[f"{what}: {'the same' if is_same else 'OTHER'} verdicts"] += 1


ATTACKS: dict[str, Callable[[Stage], None]] = {
    attack.__name__: attack
    for attack in (coordinators, workers, pairs, room, mounts, rights, foreign, damage)
}


def main(words: list[str]) -> int:
    """Make the attacks; the number of flaws."""
    times = int(words[words.index("--times") + 1]) if "--times" in words else 100
    chosen = [word for word in words if word in ATTACKS] or list(ATTACKS)
    flaws = 0
    for name in chosen:
        with tempfile.TemporaryDirectory() as folder:
            Path(folder).chmod(0o755)
            stage, began = Stage(Path(folder), times), time.monotonic()
            ATTACKS[name](stage)
            counts = ", ".join(f"{what} {count}" for what, count in sorted(stage.counts.items()))
            print(f"{name}: {counts}; {time.monotonic() - began:.0f} s", flush=True)
            flaws += stage.counts["FLAWS"]
    return flaws


if __name__ == "__main__":
    sys.exit(bool(main(sys.argv[1:])))
