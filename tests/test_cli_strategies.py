"""Strategies of one's own on the command line: how they are named, what they do, and what goes wrong."""

from __future__ import annotations

import json
import re
from functools import partial
from pathlib import Path

import pytest
from test_cli import answered, refused

import exactacq as xa
from exactacq import cli
from exactacq.cli.completion import strategies
from exactacq.output.animation import frames
from exactacq.strategies import registry

MINE = """
import exactacq as xa

@xa.strategy("nearest-first")
def near(robot):
    while link := robot.nearest_unvisited(robot.at):
        robot.take(link)
        robot.circle()

@xa.strategy("touch", bounds=lambda run: [("b", "a guess", run.radius)])
def come(robot):
    robot.go_to(robot.map.nearest(0, robot.position))
"""


@pytest.fixture(autouse=True)
def elsewhere(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(registry, "_known", {})
    monkeypatch.setattr(frames, "frames_of", partial(frames.frames_of, limit=9, fine=0))
    monkeypatch.chdir(tmp_path)


def written(text: str, name: str = "mine.py") -> str:
    Path(name).write_text(text, encoding="utf-8")
    return name


def broken(capsys: pytest.CaptureFixture[str], text: str, *more: str) -> str:
    """The one line about a file with a strategy `go`."""
    name = written(text)
    return refused(capsys, "explore", "circles", "--strategy", f"{name}:go", *more)


class TestExplore:
    def test_a_file_of_ones_own(self, capsys: pytest.CaptureFixture[str]) -> None:
        written(MINE)
        out = answered(
            capsys, "explore", "circles", "--strategy", "mine.py:nearest-first", "--audit",
            "--trace", "run.json", "--figure", "run.svg",
        )  # fmt: skip
        assert "Strategy nearest-first on circles" in out and "length  5 + 12*pi" in out
        assert "ended because the strategy is done" in out and "audit passed" in out
        run = xa.load_run("run.json")
        assert isinstance(run, xa.OwnRun) and run.visits == (0, 1) and Path("run.svg").exists()
        assert not Path("__pycache__").exists()
        assert "Strategy nearest-first" in answered(
            capsys, "explore", "circles", "--strategy", "nearest-first"
        )

    def test_bounds_are_in_the_report(self, capsys: pytest.CaptureFixture[str]) -> None:
        out = answered(capsys, "explore", "circles", "--strategy", f"{written(MINE)}:touch")
        assert re.search(r"^b +20 +yes +0.150000 +a guess", out, re.M)

    @pytest.mark.parametrize("name", ["only.py", "only.py:go", "./only.py:go"])
    def test_a_function_that_is_not_registered(self, name: str, capsys: pytest.CaptureFixture[str]) -> None:
        written("def go(robot):\n    robot.go_to((3, 0))\n", "only.py")
        assert "Strategy go on circles" in answered(capsys, "explore", "circles", "--strategy", name)

    def test_a_file_may_import_its_neighbour(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("strategies").mkdir()
        written("PLACE = (3, 0)\n", "strategies/beside_it.py")
        written("from beside_it import PLACE\ndef go(robot):\n    robot.go_to(PLACE)\n", "strategies/own.py")
        assert "length  3" in answered(capsys, "explore", "circles", "--strategy", "strategies/own.py")

    def test_endless_ones_end(self, capsys: pytest.CaptureFixture[str]) -> None:
        name = written("def go(robot):\n    while True:\n        robot.go_to((3, 0)), robot.go_to((2, 0))\n")
        out = answered(capsys, "explore", "circles", "--strategy", name, "--max-moves", "4", "--audit")
        assert "ended because no more moves are allowed" in out and "length  6" in out
        assert "--max-moves" in refused(capsys, "explore", "circles", "--strategy", name, "--max-moves", "0")


class TestWhatIsWrong:
    def test_no_such_name_or_file(self, capsys: pytest.CaptureFixture[str]) -> None:
        line = refused(capsys, "explore", "circles", "--strategy", "random")
        assert (
            "no strategy 'random'; there are sightseer, seed-spreader, nearest-frontier, and FILE.py:NAME"
            in line
        )
        for name in ("nowhere.py:go", "nowhere.py"):
            line = refused(capsys, "explore", "circles", "--strategy", name)
            assert "--strategy: nowhere.py: No such file" in line
        assert "Is a directory" in refused(capsys, "explore", "circles", "--strategy", "..:go")
        written(MINE)
        line = refused(capsys, "explore", "circles", "--strategy", "mine.py:other")
        assert "mine.py has no strategy 'other'; there are mine.py:nearest-first, mine.py:touch" in line
        assert "which of mine.py?" in refused(capsys, "explore", "circles", "--strategy", "mine.py")
        # What cannot be called with a robot alone is none.
        written(
            "class Tool: ...\ndef helper(x, y): ...\n"
            "def s(robot): robot.take(robot.nearest_unvisited(None))\n",
            "one.py",
        )
        answered(capsys, "explore", "circles", "--strategy", "one.py", "--max-moves", "1")
        written("import math\nSPEED = 3\n", "empty.py")
        for name in ("empty.py", "empty.py:math", "empty.py:SPEED", "empty.py:"):
            assert "there is no strategy in it: define" in refused(
                capsys, "explore", "circles", "--strategy", name
            )

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("def go(robot:\n    pass\n", "mine.py, line 1: not Python: "),
            ("def go(robot):\n    if robot\n", "mine.py, line 2: not Python: "),
            ("\0", "mine.py"),
            ("import nothing_of_this_name\n", "mine.py, line 1: ModuleNotFoundError: No module named"),
            ("x = 1\nx.y\n", "mine.py, line 2: AttributeError"),
            ("raise SystemExit\n", "mine.py, line 1: SystemExit"),
            ("import exactacq as xa\nxa.strategy('a b')\n", "mine.py, line 2: StrategyError: a strategy has"),
            ("def go(robot):\n    robot.walk()\n", "mine.py, line 2, in go: MoveError: the robot is at no"),
            (
                "def go(robot):\n    more()\ndef more():\n    1 / 0\n",
                "mine.py, line 4, in more: ZeroDivisionError",
            ),
            ("def go(robot):\n    robot.fly()\n", "mine.py, line 2, in go: AttributeError"),
            ("def go(robot):\n    raise ValueError('two\\nlines')\n", "line 2, in go: ValueError: two lines"),
            ("def go(robot):\n    assert robot.at\n", "mine.py, line 2, in go: AssertionError\n"),
            ("def go(robot):\n    go(robot)\n", "mine.py, line 2, in go: RecursionError"),
            ("import sys\ndef go(robot):\n    sys.exit()\n", "mine.py, line 3, in go: SystemExit"),
        ],
    )
    def test_one_line_says_where(self, text: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
        assert message in broken(capsys, text, "--trace", "run.json")
        assert not Path("run.json").exists()

    def test_what_is_no_fault_of_the_file(self, capsys: pytest.CaptureFixture[str]) -> None:
        line = broken(capsys, "def go(robot):\n    pass\n", "--start", "5,0")
        assert "mine.py" not in line and "lies inside" in line

    def test_undecided_is_told_as_ever(self, capsys: pytest.CaptureFixture[str]) -> None:
        name = written("import exactacq as xa\ndef go(robot):\n    raise xa.Undecided('two numbers')\n")
        assert cli.main(["explore", "circles", "--strategy", name]) == 3
        assert "two numbers" in capsys.readouterr().err


class TestCompare:
    def test_as_many_as_are_named(self, capsys: pytest.CaptureFixture[str]) -> None:
        name = written(MINE)
        out = answered(
            capsys, "compare", "case3", "--strategy", "sightseer", "--strategy", f"{name}:touch",
            "--strategy", "seed-spreader", "--figure", "all.svg",
        )  # fmt: skip
        assert "3 strategies on case3" in out and Path("all.svg").exists()
        assert re.search(r"^touch / Sightseer +0\.\d", out, re.M)
        assert re.search(r"^Seed Spreader / Sightseer +\d", out, re.M)

    def test_what_any_path_needs_and_what_was_missed(self, capsys: pytest.CaptureFixture[str]) -> None:
        name = written(MINE)
        arguments = ("compare", "squares", "--strategy", "sightseer", "--strategy", f"{name}:touch")
        out = answered(capsys, *arguments, "--animate", "both.html")
        assert re.search(r"^unknown boundary +0 +14 of 16 \(87\.50%\)", out, re.M)
        assert re.search(r"^circling bound +21 +21 *\n +1\.1429 +0\.0952 \(does not apply\)", out, re.M)
        assert re.search(r"^seeing bound +0 +0", out, re.M) and "page written to both.html" in out
        assert Path("both.html").read_text(encoding="utf-8").startswith("<!doctype html>")
        first, second = json.loads(answered(capsys, *arguments, "--json"))["runs"]
        assert second["unknown"]["closed"] == "14" and second["boundary"]["closed"] == "16"
        circling, seeing = (first["lower_bounds"][kind] for kind in ("circling", "seeing"))
        assert circling["applies"] and circling["value"]["closed"] == "21"
        assert seeing == {"value": {"closed": "0", "decimal": "0"}, "ratio": None, "applies": True}
        assert cli.main([*arguments, "--animate", "both.gif"]) == 2
        assert "must end in .html" in capsys.readouterr().err

    def test_the_two_of_the_paper_unless_told(self, capsys: pytest.CaptureFixture[str]) -> None:
        named = answered(capsys, "compare", "case3", "--strategy", "sightseer", "--strategy", "seed-spreader")
        assert answered(capsys, "compare", "case3") == named
        assert named.startswith("Both strategies on case3")

    def test_one_alone_and_one_that_is_refused(self, capsys: pytest.CaptureFixture[str]) -> None:
        name = written(MINE)
        arguments = ("compare", "circles", "--strategy", f"{name}:touch", "--strategy", "seed-spreader")
        out = answered(capsys, *arguments)
        assert "Strategy touch on circles" in out and "no seed-spreader: " in out
        found = json.loads(answered(capsys, *arguments, "--json"))
        assert [run["strategy"] for run in found["runs"]] == ["touch"] and len(found["refused"]) == 1
        assert "no touch: " in answered(
            capsys, "compare", "figure4", "--strategy", f"{name}:touch", "--strategy", "seed-spreader"
        )


def test_shells_are_offered_words_and_files() -> None:
    written("", "seen.py"), written("", "notes.txt")
    assert strategies("") == ["sightseer", "seed-spreader", "nearest-frontier", "seen.py"]
    assert strategies("see") == ["seed-spreader", "seen.py"]


class TestConfined:
    SWEEP = """
import exactacq as xa

@xa.strategy("north", confined=True)
def north(robot):
    west, south, east, top = robot.terrain.limits
    robot.go_to((west, top))
"""

    def test_it_starts_in_the_corner(self, capsys: pytest.CaptureFixture[str]) -> None:
        """The scene has a start of its own."""
        name, terrain = written(self.SWEEP), ("--terrain", "bbox:1/2")
        out = answered(
            capsys, "explore", "circles", *terrain, "--strategy", name, "--trace", "run.json", "--audit",
        )  # fmt: skip
        assert "S = (-0.5, -3.5), R = 20, 2 obstacles" in out and "length  7" in out and "audit passed" in out
        run = xa.load_run("run.json")
        assert isinstance(run, xa.OwnRun) and run.confined and run.ground is not None
        both = ("--strategy", f"{name}:north", "--strategy", "sightseer")
        assert "north" in answered(capsys, "compare", "circles", *terrain, *both, "--figure", "both.svg")

    def test_it_needs_a_terrain_and_its_corner(self, capsys: pytest.CaptureFixture[str]) -> None:
        name = written(self.SWEEP)
        assert "a terrain is needed: give one with --terrain" in refused(
            capsys, "explore", "circles", "--strategy", name
        )
        line = refused(capsys, "explore", "figure2", "--strategy", name, "--start", "1,0")
        assert "is not the terrain's SW corner (0, 0)" in line
