"""ARCHITECTURE.md: every module is in the picture, and imports only from what is below it or to its right."""

from __future__ import annotations

import ast
import re
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).parent.parent
FREE = {"", "errors"}
"""What everything may import: the package's own names, and the errors."""
COLUMN = 37
"""Where the picture says what a row is for."""


def patterns(text: str) -> list[str]:
    """The modules of the picture from top to bottom, and from left to right."""
    found: list[str] = []
    for line in re.search(r"```\n(.*?)```", text, re.S)[1].splitlines():
        folder = ""
        for word in line[:COLUMN].replace("|", " ").split():
            folder = word.rpartition("/")[0] or folder
            found.append(word if "/" in word or not folder else f"{folder}/{word}")
    return found


def modules() -> dict[str, set[str]]:
    """What each module imports of the package when it is loaded; a package goes by its own name."""
    package = ROOT / "exactacq"
    files = {named(path.relative_to(package)): path for path in package.rglob("*.py")}
    return {name: imports(path.read_text(encoding="utf-8"), set(files)) for name, path in files.items()}


def named(path: Path) -> str:
    return "/".join(path.with_suffix("").parts).removesuffix("__init__").rstrip("/")


def imports(text: str, known: set[str]) -> set[str]:
    found = set()
    for node in ast.parse(text).body:
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("exactacq"):
            base = node.module.split(".")[1:]
            for alias in node.names:
                name = "/".join([*base, alias.name])
                found.add(name if name in known else "/".join(base))
    return found


def place(name: str, order: list[str]) -> int | None:
    """Where a module stands, by its name or else by a pattern; a package stands where its modules do."""
    if name in order:
        return order.index(name)
    return next((k for k, p in enumerate(order) if fnmatch(name, p) or p == f"{name}/*"), None)


def violations(order: list[str], found: dict[str, set[str]]) -> list[str]:
    wrong = []
    for name, used in found.items():
        if name in FREE | {"__main__", "vision"}:
            continue
        here = place(name, order)
        if here is None:
            wrong.append(f"{name} is not in the picture")
            continue
        for other in sorted(used - FREE):
            there = place(other, order)
            together = there == here and "*" in order[here]
            if there is None or (there <= here and not together):
                wrong.append(f"{name} imports {other}")
    return wrong


def test_the_picture_is_true() -> None:
    order, found = patterns((ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")), modules()
    assert violations(order, found) == []
    assert [p for k, p in enumerate(order) if k not in {place(name, order) for name in found}] == []


def test_a_module_that_imports_from_above_is_found() -> None:
    order = patterns(f"```\n{'top  side':{COLUMN}}the top\n  |\n{'low/*':{COLUMN}}below\nlow/a  b\n```")
    assert order == ["top", "side", "low/*", "low/a", "low/b"]
    found = {"top": {"side", "errors"}, "side": {"low/c"}, "low/c": {"low/a", "low/d"}, "low/d": set()}
    assert violations(order, {**found, "low/a": {"low/b"}, "low/b": set()}) == []
    assert violations(order, {"side": {"top"}, "low/a": {"low/c"}, "new": set()}) == [
        "side imports top",
        "low/a imports low/c",
        "new is not in the picture",
    ]
