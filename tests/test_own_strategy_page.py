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
from exactacq.geometry.points import Location
from exactacq.scene.terrain_components import ground_of
from exactacq.strategies import registry
from exactacq.study.random_scenes import Subject, random_scene

DOCS = Path(__file__).parent.parent / "docs"
PAGE = (DOCS / "own_strategy.md").read_text(encoding="utf-8")
EXAMPLES = tuple(DOCS / "examples" / f"{name}.py" for name in ("straight_frontier", "lanes", "bug2"))
EXAMPLE, LANES, BUG_2 = EXAMPLES
SLOW = ("plate",)
"""Scenes on which the example takes several seconds."""


BEYOND_THE_AUDIT = 2
"""The seed of a lap with a last piece that is shorter than the floats in which the audit adds laps up."""


@pytest.fixture(autouse=True)
def own_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "_known", {})


@pytest.fixture
def straight_frontier() -> Iterator[Callable[[xa.Robot], None]]:
    yield runpy.run_path(str(EXAMPLE))["straight_frontier"]


def test_command_lines_print_what_the_page_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for example in EXAMPLES:
        copyfile(example, tmp_path / example.name)
    monkeypatch.chdir(tmp_path)
    told = list(commands(PAGE))
    assert len(told) == 5
    for line, printed in told:
        program, *arguments = shlex.split(line)
        assert program == "exactacq" and main(arguments) == 0, line
        found = capsys.readouterr().out
        assert doctest.OutputChecker().check_output(printed, found, FLAGS), f"{line}\n{found}"
    assert all(
        (tmp_path / f"{name}.svg").stat().st_size > 0 for name in ("bug2", "frontier", "lanes", "both")
    )


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_the_examples_are_short_and_use_the_public_interface_only(example: Path) -> None:
    code = [line for line in example.read_text(encoding="utf-8").splitlines() if line.strip()]
    assert len(code) <= 35
    assert [line for line in code if "import" in line] == ["import exactacq as xa"]
    assert "._" not in "".join(code)
    assert f"examples/{example.name}" in PAGE


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


@pytest.mark.parametrize("seed", some([seed for seed in range(40) if seed != BEYOND_THE_AUDIT], 5))
def test_lanes_keep_within_the_terrain(seed: int) -> None:
    """Audited, written and read, with obstacles that cross the border."""
    runpy.run_path(str(LANES))
    scene = random_scene(Subject.SEED_SPREADER, seed)
    run = xa.explore(scene, "lanes", max_moves=500)
    assert run.confined and run.start == scene.terrain.south_west
    assert [body.label for body in run.obstacles] == [c.label for c in ground_of(scene).components]
    assert all(run.obstacles[k].closed for k in run.visits)
    xa.audit(run, samples=6)
    assert xa.load_run(run.to_json()) == run
    sides = zip(scene.terrain.limits, (1, 1, -1, -1), "xyxy", strict=True)
    for limit, sign, axis in sides:
        assert all((getattr(piece.end, axis) - limit) * sign >= 0 for piece in run.path)


@pytest.mark.parametrize("seed", some(range(40), 5))
def test_bug_2_comes_to_its_goal_unless_that_is_inside_an_obstacle(seed: int) -> None:
    rules = runpy.run_path(str(BUG_2))
    scene = random_scene(Subject.SIGHTSEER, seed)
    for goal in (xa.Point(7, 3), xa.Point(-5, 4), xa.Point(30, 1)):
        rules["bug2"].__globals__["GOAL"] = goal
        run = xa.explore(scene, "bug2", max_moves=200)
        inside = any(obstacle.locate(goal) is Location.INSIDE for obstacle in scene.obstacles)
        assert run.ending.value == "finished"
        assert (run.path[-1].end == goal if run.path else scene.start == goal) is not inside
        xa.audit(run, samples=4)
