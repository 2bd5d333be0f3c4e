"""The page about strategies of one's own: its command lines print what it says, and its example explores."""

from __future__ import annotations

import doctest
import runpy
import shlex
from collections.abc import Callable, Iterator
from pathlib import Path
from shutil import copyfile

import pytest
from nightly import some
from test_tutorial import FLAGS, commands

import exactacq as xa
from exactacq.cli import main
from exactacq.files import gallery
from exactacq.strategies import registry
from exactacq.study.random_scenes import Subject, random_scene

DOCS = Path(__file__).parent.parent / "docs"
PAGE = (DOCS / "own_strategy.md").read_text(encoding="utf-8")
EXAMPLE = DOCS / "examples" / "straight_frontier.py"
SLOW = ("plate",)
"""Scenes on which the example takes several seconds."""


@pytest.fixture(autouse=True)
def own_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "_known", {})


@pytest.fixture
def straight_frontier() -> Iterator[Callable[[xa.Robot], None]]:
    yield runpy.run_path(str(EXAMPLE))["straight_frontier"]


def test_command_lines_print_what_the_page_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    copyfile(EXAMPLE, tmp_path / EXAMPLE.name)
    monkeypatch.chdir(tmp_path)
    told = list(commands(PAGE))
    assert len(told) == 2
    for line, printed in told:
        program, *arguments = shlex.split(line)
        assert program == "exactacq" and main(arguments) == 0, line
        found = capsys.readouterr().out
        assert doctest.OutputChecker().check_output(printed, found, FLAGS), f"{line}\n{found}"
    assert (tmp_path / "frontier.svg").stat().st_size > 0


def test_the_example_is_short_and_uses_the_public_interface_only() -> None:
    code = [line for line in EXAMPLE.read_text(encoding="utf-8").splitlines() if line.strip()]
    assert len(code) <= 35
    assert [line for line in code if "import" in line] == ["import exactacq as xa"]
    assert "._" not in "".join(code)
    assert f"examples/{EXAMPLE.name}" in PAGE


@pytest.mark.parametrize(
    "name", some([n for n in gallery.names() if n not in SLOW and not gallery.is_swept(n)], 4)
)
def test_the_example_acquires_what_it_sees_in_the_gallery(
    name: str, straight_frontier: Callable[[xa.Robot], None]
) -> None:
    scene = gallery.scene(name)
    run = xa.explore(scene, straight_frontier, max_moves=500)
    assert run.ending.value == "finished" and run.unvisited == ()
    xa.audit(run, samples=6)


@pytest.mark.parametrize("seed", some(range(40), 5))
def test_the_example_acquires_what_it_sees(seed: int, straight_frontier: Callable[[xa.Robot], None]) -> None:
    run = xa.explore(random_scene(Subject.SIGHTSEER, seed), straight_frontier, max_moves=500)
    assert run.ending.value == "finished" and run.unvisited == ()
    xa.audit(run, samples=6)
