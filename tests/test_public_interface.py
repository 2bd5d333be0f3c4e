"""What users' hands expect of the public types: copies, formats, reprs, errors where the mistake is made."""

from __future__ import annotations

import ast
import copy
import doctest
import json
import pickle
import re
import subprocess
import sys
from fractions import Fraction
from functools import partial
from importlib import import_module
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st
from nightly import NIGHTLY

import exactacq as xa
from exactacq.output.animation import frames

Q = Fraction
ROOT = Path(xa.__file__).parent
SCENE = xa.Scene(
    [xa.Circle((5, 0), 2), xa.Polygon([(9, 1), (10, 0), (10, 2)])], start=(0, 0), radius=20, name="two"
)
SWEPT = xa.Scene([xa.Circle((3, 4), 1), xa.Circle((6, 6), 1)], terrain=xa.Terrain(8, 8), radius=3)


@pytest.fixture(scope="module", params=["sightseer", "seed spreader"])
def run(request: pytest.FixtureRequest) -> xa.Run:
    return xa.sightseer(SCENE) if request.param == "sightseer" else xa.seed_spreader(SWEPT)


def test_the_version_is_told() -> None:
    assert re.fullmatch(r"\d+\.\d+\.\d+.*", xa.__version__)


class TestCopies:
    @pytest.mark.parametrize("again", [lambda x: pickle.loads(pickle.dumps(x)), copy.deepcopy, copy.copy])
    def test_of_a_run_are_the_run(self, run: xa.Run, again: object) -> None:
        """The sensing knows places by identity, so it is repeated and not copied."""
        other = again(run)  # type: ignore[operator]
        assert other.length == run.length
        assert other.visits == run.visits
        assert [(e.kind, e.obstacle, e.at) for e in other.events] == [
            (e.kind, e.obstacle, e.at) for e in run.events
        ]
        middle = run.length / 2 if run.length.rational else xa.Length(Q(int(float(run.length) * 8), 16))
        assert other.map_at(middle).known_length() == run.map_at(middle).known_length()
        assert other.map.frontier == run.map.frontier
        assert other == run and other.path == run.path and other.scene == run.scene

    def test_of_what_is_seen(self) -> None:
        run = xa.sightseer(SCENE)
        view, swept = xa.isovist(SCENE, (0, 0)), xa.sweep(SCENE, run.path[0].curve)
        for value, of in ((view, lambda v: v.area), (run.map, lambda m: m.known_length())):
            assert of(pickle.loads(pickle.dumps(value))) == of(value)
        again = pickle.loads(pickle.dumps(swept))
        assert [e.place for e in again.events] == [e.place for e in swept.events]


class TestEquality:
    def test_of_runs_is_that_of_what_they_hold(self, run: xa.Run, tmp_path: Path) -> None:
        (tmp_path / "run.json").write_text(json.dumps(run.to_json()))
        assert xa.load_run(tmp_path / "run.json") == run
        assert run != xa.sightseer(SCENE, 21)
        assert xa.sightseer(SCENE) == xa.sightseer(SCENE)

    def test_of_a_run_whose_bounds_are_0(self) -> None:
        """Their ratio, NaN, is not equal to itself."""
        run = xa.sightseer(xa.Scene([], start=(0, 0), radius=1))
        assert pickle.loads(pickle.dumps(run)) == run

    def test_of_scenes_is_that_of_what_was_given(self) -> None:
        parts = {"start": (0, 0), "radius": 20, "name": "two"}
        same = xa.Scene(SCENE.shapes, **parts)
        assert same == SCENE and hash(same) == hash(SCENE) and same is not SCENE
        others: list[dict[str, object]] = [
            {"start": (0, 1)}, {"radius": 21}, {"name": None}, {"notes": ["n"]},
            {"terrain": xa.Terrain(1, 1)}, {"enclosure": xa.Circle((0, 0), 99)},
        ]  # fmt: skip
        assert all(xa.Scene(SCENE.shapes, **{**parts, **other}) != SCENE for other in others)
        assert xa.Scene(SCENE.shapes[::-1], **parts) != SCENE and SCENE != 3
        assert xa.isovist(same, (0, 0)).area == xa.isovist(SCENE, (0, 0)).area

    def test_of_curves_is_that_of_their_places(self) -> None:
        one, other = xa.Segment((0, 0), (1, "1/3")), xa.Segment(xa.Point(0, 0), xa.Point(1, Q(1, 3)))
        assert one == other and hash(one) == hash(other) and one != one.reversed()
        arc, again = (xa.Arc.from_bulge(xa.Point(0, 0), xa.Point(1, 0), fmpq(1, 2)) for _ in range(2))
        assert arc == again and hash(arc) == hash(again)
        assert arc != arc.reversed() and arc != one and one != arc
        assert arc != xa.Arc.from_bulge(xa.Point(0, 0), xa.Point(1, 0), fmpq(2))
        assert arc == xa.Arc.from_bulge(xa.Point(0, 0), xa.Point(1, 0), "1/2")
        root = xa.Real(2).sqrt()
        slanted = xa.Segment((0, 0), (root, 1 / root))
        assert slanted == xa.Segment((0, 0), (2 / root, root / 2))
        with pytest.raises(TypeError, match="different forms"):
            hash(slanted)


class TestGraphNodes:
    def test_sort_with_the_start_first(self) -> None:
        graph = xa.visibility_graph(SCENE)
        assert sorted(graph.nodes) == ["S", 0, 1]
        assert sorted(graph.nodes, reverse=True) == [1, 0, "S"]
        assert "S" in graph and graph["S"] == graph.adj["S"]
        assert sorted(sorted(edge) for edge in graph.edges) == [["S", 0], [0, 1]]

    def test_the_start_is_the_text_s(self) -> None:
        (start,) = (node for node in xa.visibility_graph(SCENE) if isinstance(node, str))
        assert start == "S" and hash(start) == hash("S") and repr(start) == "'S'"
        assert start < 0 and start <= -1 and not start > 0 and not start >= 0
        assert start < 0 and start <= -1 and not start > 0 and not start >= 0
        assert start < "T" and start <= "S" and start > "R" and start >= "S"
        assert pickle.loads(pickle.dumps(start)) is copy.deepcopy(start) is copy.copy(start) is start
        assert json.dumps(start) == '"S"'
        copied = pickle.loads(pickle.dumps(xa.visibility_graph(SCENE)))
        assert sorted(copied.nodes) == ["S", 0, 1]


class TestNumbers:
    LENGTH = xa.Length.turns(xa.Real(1)) + xa.Length("1/8")

    def test_formats(self) -> None:
        assert f"{self.LENGTH:.3f}" == "6.408"
        assert f"{self.LENGTH:10.2e}" == "   6.41e+0"
        assert f"{self.LENGTH:.30f}" == "6.408185307179586476925286766559"
        assert f"{xa.Real(2).sqrt():.40f}" == "1.4142135623730950488016887242096980785697"
        assert f"{self.LENGTH}" == str(self.LENGTH) == "1/8 + 2*pi"
        assert f"{xa.Length(0):.1f}" == "0.0"
        assert f"{xa.Real(10) ** 400:.1f}" == "1" + "0" * 400 + ".0"
        assert f"{-xa.Length('1e30'):.1f}" == "-1000000000000000000000000000000.0"

    @given(st.fractions(max_denominator=2000), st.sampled_from([None, 0, 1, 2, -1]))
    def test_rounding_is_that_of_fractions(self, value: Fraction, places: int | None) -> None:
        for number in (xa.Length(value), xa.Real(value)):
            found = round(number, places)
            assert (found if places is None else Q(int(found.p), int(found.q))) == round(value, places)

    def test_rounding_decides_ties(self) -> None:
        """A tie goes to the even side; what is a hair above it goes up."""
        hair = xa.Length(Q(1, 10**60)) * xa.Real(2).sqrt()
        assert [round(xa.Length("5/2")), round(xa.Length("5/2") + hair), round(xa.Length("7/2") - hair)] == [
            2,
            3,
            3,
        ]

    def test_ratios(self) -> None:
        assert xa.Length("3/2").as_integer_ratio() == (3, 2)
        with pytest.raises(ValueError, match="irrational"):
            self.LENGTH.as_integer_ratio()

    def test_a_quotient_of_lengths_is_compared_exactly(self) -> None:
        double = self.LENGTH * 2 / self.LENGTH
        assert double == 2
        assert double > Q(19, 10) and double <= 2 and not double < 2
        assert double == xa.Length(5) / xa.Length("5/2")
        assert float(self.LENGTH / xa.Length(4)) == pytest.approx(1.6020463267948966)
        assert f"{self.LENGTH / xa.Length(4):.3f}" == "1.602"
        low, high = (self.LENGTH / xa.Length(4)).enclosure(100)
        assert low < high and high - low < fmpq(1, 2**100)
        assert round(self.LENGTH / xa.Length(4), 1) == fmpq(8, 5)
        assert double != "two" and double != "2" and double < float("inf")
        third = self.LENGTH / xa.Length(3)
        assert third > self.LENGTH / xa.Length(4)
        assert third == self.LENGTH * 2 / xa.Length(6)
        with pytest.raises(ZeroDivisionError):
            self.LENGTH / xa.Length(0)

    def test_equal_hashable_numbers_hash_alike(self) -> None:
        assert len({xa.Length("1/2"), xa.Length(Q(2, 4)), xa.Real("1/2")}) == 1
        assert len({xa.Point(1, 2), xa.Point("1", Q(4, 2))}) == 1
        for value in (self.LENGTH, xa.Real(2).sqrt(), xa.Point(xa.Real(2).sqrt(), 0)):
            with pytest.raises(TypeError, match="different forms"):
                hash(value)

    def test_points_are_arrays(self) -> None:
        assert np.asarray(xa.Point(1, "1/2")).tolist() == [1.0, 0.5]
        assert np.asarray([xa.Point(0, 1), xa.Point(2, 3)]).shape == (2, 2)
        assert 2 * xa.Point(1, 2) == xa.Point(2, 4)


class TestReprs:
    def test_are_short(self, run: xa.Run) -> None:
        shown = [run, run.path, run.map, run.events[1], run.start, xa.isovist(SCENE, (0, 0)), SCENE]
        assert all(len(repr(value)) < 120 for value in shown)
        assert all("object at 0x" not in repr(value) for value in shown)

    def test_a_notebook_shows_a_line_and_the_figure(self, run: xa.Run) -> None:
        html = run._repr_html_()
        assert html.startswith(f"<div><p>{type(run).__name__}") and "<svg" in html and "<?xml" not in html

    def test_the_vocabulary(self) -> None:
        assert dir(xa) == sorted(xa.__all__)
        assert all(getattr(xa, name) is not None for name in dir(xa))


class TestImports:
    """What one asks for is loaded, and no more."""

    @staticmethod
    def loaded(statement: str) -> set[str]:
        code = f"import sys, exactacq as xa; {statement}; print(*sys.modules)"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        return {name.split(".")[0] for name in done.stdout.splitlines()[-1].split()}

    def test_the_package_itself_is_light(self) -> None:
        assert not self.loaded("pass") & {"numpy", "flint", "networkx", "sympy"}

    def test_a_length_needs_no_pictures_files_or_graphs(self) -> None:
        heavy = {"networkx", "sympy", "matplotlib", "ezdxf", "typer", "rich"}
        assert not self.loaded("xa.Length") & heavy
        scene = "xa.Scene([xa.Circle((5, 5), 1)], terrain=xa.Terrain(9, 9), radius=3)"
        run = f"xa.sightseer({scene}, start=(0, 0)); xa.seed_spreader({scene})"
        assert not self.loaded(f"{run}; xa.isovist; xa.audit") & heavy

    @pytest.mark.parametrize(
        "line", ["--help", "--version", "explore --help", "verify --help", "search --help"]
    )
    def test_the_command_line_says_what_it_takes_without_what_it_does(self, line: str) -> None:
        loaded = self.loaded(f"from exactacq.cli import main; assert main({line.split()}) == 0")
        heavy = {"numpy", "flint", "networkx", "sympy", "matplotlib", "ezdxf", "hypothesis"}
        assert "typer" in loaded and not loaded & heavy

    def test_a_command_loads_what_it_uses(self) -> None:
        loaded = self.loaded("from exactacq.cli import main; assert main(['explore', 'squares']) == 0")
        assert {"networkx", "rich"} <= loaded and not loaded & {"sympy", "matplotlib", "ezdxf"}

    def test_names_that_are_not_there(self) -> None:
        with pytest.raises(AttributeError, match="no attribute 'sightseeing'"):
            xa.sightseeing  # noqa: B018


class TestErrorsWhereTheMistakeIs:
    @pytest.mark.parametrize(
        ("make", "message"),
        [
            (lambda: xa.Scene([], start=(1, 2, 3)), "start: a point needs two numbers, not"),
            (lambda: xa.Scene([], start=7), "start: a point needs two numbers, not 7"),
            (lambda: xa.sightseer(SCENE, 3, start=(1, 2, 3)), "start: a point needs two numbers"),
            (lambda: xa.isovist(SCENE, (1, 2, 3)), "point: a point needs two numbers"),
            (lambda: xa.Segment((0, 0), "01"), "a point needs two numbers, not '01'"),
            (lambda: xa.Segment((0, 0), b"01"), "a point needs two numbers, not b'01'"),
            (lambda: xa.Scene(5), "the obstacles are a list of shapes, not 5"),
            (lambda: xa.Scene(xa.Circle((0, 0), 1)), "not a single one"),
            (lambda: xa.Scene([(0, 0), (1, 0), (0, 1)]), "obstacle 0: vertex 0: a vertex is "),
            (lambda: xa.Scene([SCENE.shapes[0], None]), "obstacle 1: a boundary is a list of vertices, not"),
            (lambda: xa.Scene([], enclosure=[(0, 0), (1, "x")]), "enclosure: vertex 1: not a number: 'x'"),
            (lambda: xa.Scene([], terrain=(3, 4)), "terrain: give a Terrain"),
            (lambda: xa.Scene([], radius="x"), "radius: not a number: 'x'"),
            (lambda: xa.Scene([], radius=True), "radius: not a number: True"),
            (lambda: xa.Scene([], name=3), "name: a name is a text, not 3"),
            (lambda: xa.Circle((0, 0), 1, name="\udc80"), r"name: '.udc80' has half of a character"),
            (lambda: xa.sightseer(SCENE, "x"), "radius: not a number: 'x'"),
            (lambda: xa.seed_spreader(SWEPT, "x"), "radius: not a number: 'x'"),
            (lambda: xa.isovist(SCENE, (0, 0), "x"), "radius: not a number: 'x'"),
            (lambda: xa.sweep(SCENE, xa.Segment((0, 0), (1, 0)), "x"), "radius: not a number: 'x'"),
            (lambda: xa.visibility_graph(SCENE, "x"), "radius: not a number: 'x'"),
            (lambda: xa.seed_spreader(SWEPT, target="far"), '"known" or "visible", not \'far\''),
            (lambda: xa.Polygon([(0, 0), (1, float("inf"))]), "vertex 1: not a finite number: inf"),
            (lambda: xa.Polygon([(0, 0), (1, np.True_)]), "vertex 1: not a number: "),
            (lambda: xa.Polygon(np.zeros(4)), "vertex 0: a vertex is"),
            (lambda: xa.Polygon(np.zeros((30, 4))), "vertex 0: a vertex is"),
            (lambda: xa.Polygon(np.float64(1)), "a boundary is a list of vertices"),
            (lambda: xa.Polygon([(0, 0, 1), (1, 0), (0, 1)]), "no bulges: use Outline"),
            (lambda: xa.Polygon([(0, 0), (1, 0), (0, 1)], name=3), "a name is a text"),
            (lambda: xa.Outline([(0, 0), 3]), "vertex 1: a vertex is .* or .*, not 3"),
            (lambda: xa.Circle(5, 1), "center: a point needs two numbers, not 5"),
            (lambda: xa.Circle((0, 0), "x"), "radius: not a number: 'x'"),
            (lambda: xa.Terrain(1, "b"), "height: not a number: 'b'"),
        ],
    )
    def test_one_sentence(self, make: object, message: str) -> None:
        with pytest.raises(xa.FormatError, match=message) as caught:
            make()  # type: ignore[operator]
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "use",
    [
        xa.explore, xa.sightseer, xa.seed_spreader, xa.Robot, xa.visibility_graph, xa.figure,
        lambda scene: xa.isovist(scene, (0, 0), 3), lambda scene: xa.shortest_path(scene, (0, 0), (1, 1)),
    ],
)  # fmt: skip
def test_the_name_of_a_scene_is_no_scene(use: object) -> None:
    with pytest.raises(xa.FormatError, match=r"a scene .*not 'circles'"):
        use("circles")  # type: ignore[operator]


def documented() -> list[ModuleType]:
    """The modules with examples in docstrings."""
    paths = [path for path in ROOT.rglob("*.py") if ">>> " in path.read_text(encoding="utf-8")]
    return [import_module(".".join(["exactacq", *p.relative_to(ROOT).with_suffix("").parts])) for p in paths]


@pytest.mark.parametrize("module", documented(), ids=lambda module: module.__name__)
def test_examples_in_docstrings(module: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    if not NIGHTLY:  # Animations show few moments.
        monkeypatch.setattr(frames, "frames_of", partial(frames.frames_of, limit=9, fine=0))
    found = doctest.testmod(module)
    assert found.attempted > 0
    assert found.failed == 0


def docstrings(path: Path) -> list[str]:
    """The docstrings of a file: of the module, its classes and all functions, inner ones too."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    tree = ast.parse(path.read_text(encoding="utf-8"))
    nodes = (node for node in ast.walk(tree) if isinstance(node, kinds))
    return [text for node in nodes if (text := ast.get_docstring(node))]


def test_docstrings_stand_alone() -> None:
    """A docstring gives a contract of its own instead of a difference from its neighbour."""
    leaning = [
        (path.name, text)
        for path in ROOT.rglob("*.py")
        for text in docstrings(path)
        if re.match(r"(The same|As)\b", text)
    ]
    assert leaning == []


WITHOUT_EXAMPLE = {
    "Arc.may_pass": "a filter in balls: `passes` decides",
    "Segment.may_pass": "a filter in balls: `passes` decides",
    "Real.affine": "a shortcut of the arithmetic",
    "Real.clear_sign": "a filter in balls: `sign` decides",
    "Real.generators": "a part of the zero test",
    "Real.height_bound": "a part of the zero test",
    "Real.of_atom": "what atoms are is no concern of users",
    "Real.overlaps": "a filter in balls: `compare` decides",
    "Real.rough": "a float to draw with: `float` gives the nearest one",
    "Real.working_ball": "a step of `ball`",
}
"""Public methods that are machinery of the library, and why they need no example."""


def public_docstrings() -> dict[str, str]:
    """The docstrings of all that the package offers, and of the methods of its classes, by name."""
    found = {}
    for name in xa.__all__:
        offered = getattr(xa, name)
        found[name] = offered.__doc__ or ""
        kinds = [kind for kind in getattr(offered, "__mro__", ()) if kind.__module__.startswith("exactacq.")]
        for kind in reversed(kinds):
            for member, value in vars(kind).items():
                function = getattr(value, "__func__", value)
                if not member.startswith("_") and callable(function):
                    found[f"{name}.{member}"] = function.__doc__ or ""
    return found


def test_what_is_public_has_an_example() -> None:
    """`test_examples_in_docstrings` runs them."""
    bare = {name for name, text in public_docstrings().items() if ">>> " not in text}
    assert bare == set(WITHOUT_EXAMPLE)


def test_points_are_also_pairs_of_numbers() -> None:
    view = xa.isovist(SCENE, (0, 0))
    assert view.contains((2, 0)) and view.contains(("5/2", "0")) and not view.contains((5, 0))
    assert xa.sightseer(SCENE).map.knows(0, (3, 0))
    with pytest.raises(xa.FormatError, match="a point needs two numbers"):
        view.contains("3,0")  # type: ignore[arg-type]
    with pytest.raises(xa.FormatError, match="a scene is needed"):
        xa.isovist("circles", (0, 0))  # type: ignore[arg-type]
