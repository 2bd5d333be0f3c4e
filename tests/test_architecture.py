"""The picture in ARCHITECTURE.md is the code: it lists every file, and imports point down or to the right."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "exactacq"
SCREEN = 60
"""Lines that the picture may take."""
LONGEST = 600
"""Lines that a file may have."""


def pictured(text: str) -> list[str]:
    """The files in the order of the picture; a name ending in / opens a folder, of rooms or in a room."""
    found: list[str] = []
    room = ""
    for line in re.search(r"```\n(.*?)```", text, re.S)[1].splitlines():
        if header := re.match(r"(\w+)/", line):
            room = header[1]
            continue
        room = room if line.startswith(" ") else ""
        folder = room
        for name in line.split():
            if name.endswith("/"):
                folder = f"{room}/{name[:-1]}"
            else:
                found.append(f"{folder}/{name}" if folder else name)
    return found


def files() -> dict[str, Path]:
    """Every file of the package by its path without the suffix; a package by its folder's."""
    found = {}
    for path in PACKAGE.rglob("*.py"):
        name = "/".join(path.relative_to(PACKAGE).with_suffix("").parts)
        found[name.removesuffix("/__init__")] = path
    del found["__init__"]
    return found


@cache
def statements(text: str) -> list[ast.AST]:
    """The statements of a source, wherever they stand; expressions have none."""
    found: list[ast.AST] = [ast.parse(text)]
    for node in found:
        inner = ast.iter_child_nodes(node)
        found += [one for one in inner if isinstance(one, ast.stmt | ast.excepthandler | ast.match_case)]
    return found


def imports(text: str, known: set[str]) -> set[str]:
    """What a file imports of the package, wherever the statement stands: in functions and for types too."""
    found = set()
    for node in statements(text):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "exactacq":
            base = "/".join((node.module or "").split(".")[1:])
            for alias in node.names:
                name = f"{base}/{alias.name}".strip("/")
                found.add(name if name in known else base)
        if isinstance(node, ast.Import):
            found |= {a.name for a in node.names if a.name.startswith("exactacq")}
    return found


def place(name: str, order: list[str]) -> int | None:
    """Where a file stands; a package stands where its first file does."""
    return next((k for k, p in enumerate(order) if p == name or p.startswith(f"{name}/")), None)


def violations(order: list[str], used: dict[str, set[str]]) -> list[str]:
    wrong = []
    for name, others in used.items():
        for other in others:
            if other.startswith(f"{name}/"):
                continue  # A package offers what is in it.
            here, there = place(name, order), place(other, order)
            if here is None or there is None or not here < there:
                wrong.append(f"{name} imports {other}")
    return wrong


@cache
def used() -> dict[str, set[str]]:
    known = files()
    return {name: imports(path.read_text(encoding="utf-8"), set(known)) for name, path in known.items()}


def test_the_picture_is_true() -> None:
    order = pictured((ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8"))
    found = used()
    packages = {name for name in found if any(other.startswith(f"{name}/") for other in found)}
    assert sorted(order) == sorted(set(found) - packages)
    assert violations(order, found) == []


def test_the_audit_shares_nothing_with_what_it_checks() -> None:
    """Of the rooms that make runs it knows the run, its path and its events."""
    makers = ("visibility/", "sensing/", "strategies/")
    known = {other for name, others in used().items() if name.startswith("auditing") for other in others}
    assert {name for name in known if name.startswith(makers)} <= {
        "sensing/decision",
        "sensing/event",
        "sensing/path",
        "strategies/run",
    }


RULES = (
    "sightseer/rules",
    "seed_spreader/rules",
    "seed_spreader/reasons",
    "seed_spreader/losses",
    "seed_spreader/prediction/",
)
"""Files of the strategies that know the robot and nothing else."""
TOLD = ("robot", "routes", "moves", "known_map", "options", "seed_spreader/")
"""What of their own room they may know: what robots are and tell, and themselves."""
FORMULAS = ("visibility/chords", "visibility/line_families")
"""Formulas for lengths and lines, which know nothing of scenes."""


def peeks(text: str) -> list[str]:
    """Private names that a file reads and does not define."""
    found = list(ast.walk(ast.parse(text)))
    private = [node for node in found if isinstance(node, ast.Attribute) and re.match("_(?!_)", node.attr)]
    own = {node.name for node in found if isinstance(node, ast.FunctionDef)}
    own |= {node.attr for node in private if isinstance(node.ctx, ast.Store)}
    return [node.attr for node in private if node.attr not in own]


def test_rules_of_strategies_know_the_robot_and_nothing_else() -> None:
    rules = {
        name: path
        for name, path in files().items()
        if name.startswith(tuple(f"strategies/{r}" for r in RULES))
    }
    assert len(rules) == 9
    allowed = (
        "errors",
        "cached",
        "numbers/",
        "geometry/",
        "kernel/",
        "sensing/decision",
        "sensing/event",
        *FORMULAS,
        *(f"strategies/{t}" for t in TOLD),
    )
    imported = used()
    assert {other for name in rules for other in imported[name] if not other.startswith(allowed)} == set()
    assert {name: found for name, path in rules.items() if (found := peeks(path.read_text("utf-8")))} == {}
    assert peeks("self._line = robot._walker.at, self._line, robot.__class__") == ["_walker"]


def test_no_class_name_is_used_twice() -> None:
    """Nor with an underscore: a name has one meaning in the whole package."""
    homes: dict[str, list[str]] = {}
    for name, path in files().items():
        for node in statements(path.read_text(encoding="utf-8")):
            if isinstance(node, ast.ClassDef):
                homes.setdefault(node.name.lstrip("_"), []).append(name)
    assert {name: where for name, where in homes.items() if len(where) > 1} == {}


def test_the_picture_fits_a_screen() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    lines = re.search(r"```\n(.*?)```", text, re.S)[1].splitlines()
    assert len(lines) <= SCREEN
    assert max(map(len, lines)) <= 110


def test_no_file_is_long() -> None:
    """Nor one of the tests and proofs."""
    others = (path for folder in ("tests", "proofs") for path in (ROOT / folder).rglob("*.py"))
    every = [*files().values(), *others]
    assert [path for path in every if len(path.read_text(encoding="utf-8").splitlines()) > LONGEST] == []


def test_a_wrong_order_shows() -> None:
    order = pictured("```\nabove/  what stands above\n    one  two\n    inner/  three\nbelow/\n    four\n```")
    assert order == ["above/one", "above/two", "above/inner/three", "below/four"]
    fine = {"above/one": {"above/two", "below"}, "above/inner": {"above/inner/three"}}
    assert violations(order, fine) == []
    wrong = {"above/two": {"above/one"}, "below/four": {"above/inner"}, "below/five": {"below/four"}}
    assert len(violations(order, wrong)) == 3


def test_late_imports_and_those_for_types_are_seen() -> None:
    text = """
if TYPE_CHECKING:
    from exactacq.a import b
def f():
    from exactacq.c.d import e
    import exactacq.g
"""
    assert imports(text, {"a", "c/d", "c/d/e"}) == {"a", "c/d/e", "exactacq.g"}
