"""The table of bounds: the gallery scene on which each is tightest, and the smallest scene that breaks it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from exactacq.strategies.run import Bound, Run, SeedSpreaderRun
from exactacq.study.claims.model import Case
from exactacq.study.claims.premises import PREMISES


class Entry(NamedTuple):
    """One scene's say on a bound: exactly whether it holds, and about how close it is."""

    scene: str
    size: tuple[int, ...]
    holds: bool
    ratio: float


def write(folder: Path, cases: Iterable[tuple[str, Case, Run]]) -> None:
    """Write tightest.md: the table over the *cases*, each with its name and the run to be asked."""
    found: dict[str, list[Entry]] = {name: [] for name in PREMISES}
    for scene, case, run in cases:
        for bound in run.bounds:
            if bound.value.sign() and PREMISES[bound.name].holds(case):
                found[bound.name].append(_entry(scene, run, bound))
    (folder / "tightest.md").write_text("\n".join(table(found)) + "\n", encoding="utf-8")


def _entry(scene: str, run: Run, bound: Bound) -> Entry:
    size = len(run.scene.obstacles), sum(len(o.edges) for o in run.scene.obstacles)
    if isinstance(run, SeedSpreaderRun):
        size = (*size, int((run.scene.terrain.width / run.radius).ceil()))
    return Entry(scene, size, bound.holds, bound.ratio)


def table(found: dict[str, list[Entry]]) -> Iterator[str]:
    """The lines of the table, in Markdown."""
    yield "| bound | runs that it is for | largest ratio | smallest scene that breaks it |"
    yield "| --- | --- | --- | --- |"
    for name, entries in found.items():
        if not entries:
            continue
        worst = max(entries, key=lambda e: (not e.holds, e.ratio))
        broken = [entry for entry in entries if not entry.holds]
        least = _in_words(min(broken, key=lambda e: (e.size, -e.ratio))) if broken else ""
        yield f"| {name} | {PREMISES[name].words} | {worst.ratio:.6f} on `{worst.scene}` | {least} |"


def _in_words(entry: Entry) -> str:
    counts = zip(entry.size, ("obstacle", "edge", "strip"), strict=False)
    words = ", ".join(f"{count} {what}{'s' * (count != 1)}" for count, what in counts)
    return f"`{entry.scene}`: {words}; ratio {entry.ratio:.6f}"
