"""The table of bounds: the gallery scene on which each is tightest, and the smallest scene that breaks it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from exactacq.claims.model import Case
from exactacq.links import START
from exactacq.trace import Bound, Run


class Entry(NamedTuple):
    """One scene's say on a bound: exactly whether it holds, and about how close it is."""

    scene: str
    size: tuple[int, ...]
    holds: bool
    ratio: float


def _is_seated(case: Case) -> bool:
    """Whether model (a) holds and the start lies on a boundary, as the paper takes it to."""
    ways = (link for link in case.sightseer.links if link.source == START)
    return case.is_mutually_visible and all(link.length.sign() == 0 for link in ways)


def _is_plain(case: Case) -> bool:
    """Whether the sweep follows the M-line all the way."""
    return not any(event.kind in ("hit", "cross", "divert") for event in case.spreader.events)


BOUNDS: dict[str, tuple[str, Callable[[Case], bool]]] = {
    "(1)": ("model (a), S on a boundary", _is_seated),
    "(2)": ("model (a), S on a boundary", _is_seated),
    "T1 corrected": ("model (a)", lambda case: case.is_mutually_visible),
    "(2) + S-S1": ("model (a)", lambda case: case.is_mutually_visible),
    "(4)": ("all sweeps", lambda _: True),
    "(5)": ("all sweeps", lambda _: True),
    "(6)": ("all sweeps", lambda _: True),
    "(8)": ("no hit, no diversion", _is_plain),
    "(9)": ("no known obstacle met on diversions", lambda case: not case.tally.diversions_meet_known),
    "(10)": ("clear of the border", lambda case: case.tally.is_clear),
    "(11)": (
        "both of these",
        lambda case: case.tally.is_clear and not case.tally.diversions_meet_known,
    ),
    "L3 corrected": ("all sweeps", lambda _: True),
    "T2 corrected": ("all sweeps", lambda _: True),
}
"""The bounds in the table's order; in words, and as a question to a case, which runs each is meant for."""


def write(folder: Path, cases: Iterable[tuple[str, Case, Run]]) -> None:
    """Write tightest.md: the table over the *cases*, each with its name and the run to be asked."""
    found: dict[str, list[Entry]] = {name: [] for name in BOUNDS}
    for scene, case, run in cases:
        for bound in run.bounds:
            if bound.value.sign() and BOUNDS[bound.name][1](case):
                found[bound.name].append(_entry(scene, run, bound))
    (folder / "tightest.md").write_text("\n".join(table(found)) + "\n", encoding="utf-8")


def _entry(scene: str, run: Run, bound: Bound) -> Entry:
    size = len(run.scene.obstacles), sum(len(o.edges) for o in run.scene.obstacles)
    if run.sweeping is not None:
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
        yield f"| {name} | {BOUNDS[name][0]} | {worst.ratio:.6f} on `{worst.scene}` | {least} |"


def _in_words(entry: Entry) -> str:
    counts = zip(entry.size, ("obstacle", "edge", "strip"), strict=False)
    words = ", ".join(f"{count} {what}{'s' * (count != 1)}" for count, what in counts)
    return f"`{entry.scene}`: {words}; ratio {entry.ratio:.6f}"
