"""Shells complete commands, options, scenes and words; names of files are left to the shell."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from nightly import some

from exactacq.cli.completion import scenes
from exactacq.files import gallery

ROOT = Path(__file__).parent.parent


def offered(folder: Path, line: str) -> list[str]:
    """What bash is told for a line that ends where the cursor is."""
    words = line.split(" ")
    asked = {
        "_EXACTACQ_COMPLETE": "complete_bash",
        "COMP_WORDS": "\n".join(words), "COMP_CWORD": str(len(words) - 1),
        "PYTHONPATH": os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")])),
    }  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-m", "exactacq"],
        cwd=folder, env={**os.environ, **asked}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.parametrize(
    ("line", "words"),
    some(
        [
            ("exactacq co", ["compare", "convert"]),
            ("exactacq play --no", ["--no-browser"]),
            ("exactacq --ver", ["--version"]),
            ("exactacq explore --ani", ["--animate"]),
            ("exactacq explore --strategy ", ["sightseer", "seed-spreader"]),
            ("exactacq explore --strategy se", ["seed-spreader"]),
            ("exactacq check --outer ", ["wall", "drop", "room"]),
            ("exactacq explore plat", ["plate", "platform.dxf"]),
            ("exactacq convert pl", ["plate", "platform.dxf"]),
            ("exactacq explore part", []),
            ("exactacq explore plate --figure pl", []),
            ("exactacq gallery tight-sss", ["tight-sss2", "tight-sss5", "tight-sss5-fan"]),
            ("exactacq search T", ["T1", "T2"]),
            ("exactacq verify --strategy ", ["both", "sightseer", "seed-spreader"]),
        ],
        5,
    ),
)
def test_what_bash_is_told(line: str, words: list[str], tmp_path: Path) -> None:
    for name in ("part.dxf", "platform.dxf", "plates.txt"):
        (tmp_path / name).touch()
    assert offered(tmp_path, line) == words


def test_scenes_come_before_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "m1.svg").touch()
    (tmp_path / "m2").mkdir()
    monkeypatch.chdir(tmp_path)
    assert scenes("m1") == [name for name in gallery.names() if name.startswith("m1")] + ["m1.svg"]
    assert scenes("") == [*gallery.names(), "m1.svg"]
    assert scenes("nothing") == []


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_is_shown_and_installed(shell: str, tmp_path: Path) -> None:
    """The variable lets the shell be named, where typer would ask which one runs."""
    named = {"_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1", "HOME": str(tmp_path)}
    for option in ("--show-completion", "--install-completion"):
        done = subprocess.run(
            [sys.executable, "-m", "exactacq", option, shell],
            cwd=ROOT, env={**os.environ, **named}, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert (done.returncode, done.stderr) == (0, "")
        if option == "--show-completion":
            assert "_EXACTACQ_COMPLETE" in done.stdout
    assert any("_EXACTACQ_COMPLETE" in f.read_text() for f in tmp_path.rglob("*exactacq*") if f.is_file())
