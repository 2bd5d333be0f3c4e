"""Control-C at any moment of a process ends it with one line and status 130, also while it is importing."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
CLEAN = (130, "exactacq: interrupted\n")
AT_IMPORT = """
import os, runpy, signal, sys
class Interrupter:
    left = int(sys.argv[1])
    def find_spec(self, name, path=None, target=None):
        self.left -= name != "exactacq.__main__"
        if self.left == 0:
            os.kill(os.getpid(), signal.SIGINT)
import exactacq
sys.meta_path.insert(0, Interrupter())
sys.argv[:] = ["exactacq", *sys.argv[2:]]
runpy.run_module("exactacq", run_name="__main__", alter_sys=True)
"""
"""Runs the command line, and presses control-C when a module is looked for, the one of the given number."""


@pytest.fixture(autouse=True)
def control_c_is_heard() -> Iterator[None]:
    """Whatever started the tests may ignore control-C, and so would the processes that they start."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupted_at(number: int, *arguments: str) -> tuple[int, str]:
    done = subprocess.run(
        [sys.executable, "-c", AT_IMPORT, str(number), *arguments],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    return done.returncode, done.stderr


@pytest.mark.parametrize("number", [1, 2, 3, 5, 10, 20, 40, 80, 120, 160, 200])
def test_while_importing(number: int) -> None:
    assert interrupted_at(number, "explore", "squares") == CLEAN


def test_when_there_is_nothing_left_to_import() -> None:
    assert interrupted_at(10_000, "--version") == (0, "")


@pytest.mark.parametrize("delay", [10, 20, 40, 60, 80, 120, 160, 240, 320])
def test_after_some_milliseconds(delay: int, tmp_path: Path) -> None:
    """Python itself may not be ready by then: the command line is not in what it says then."""
    command = [sys.executable, "-m", "exactacq", "explore", "figure2", "--trace", "run.json"]
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    process = subprocess.Popen(
        command, cwd=tmp_path, env={**os.environ, "PYTHONPATH": path},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    time.sleep(delay / 1000)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=120)
    was_early = process.returncode in (1, -signal.SIGINT) and "exactacq/__main__" not in said
    assert was_early or (process.returncode, said) == CLEAN
    assert list(tmp_path.iterdir()) == []


def test_in_the_background_it_is_ignored() -> None:
    """As in a shell's background job, where control-C is meant for another process."""
    background = f"import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)\n{AT_IMPORT}"
    done = subprocess.run(
        [sys.executable, "-c", background, "5", "--version"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
