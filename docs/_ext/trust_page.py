"""The tables of the pages on trust and comparison, from the results that are stored in ``docs/results``.

Each file there is one experiment: its ``title``, what it ``asks``, the ``commands`` that made it, the commit
that it was made with as ``version``, and a table with ``columns`` and ``rows``, or ``campaigns``: what
each ``exactacq verify --json`` printed. ``notes`` follow the table. Files are shown in the order of their
names.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

NAMED, WHY = 40, 160
"""Most scenes of a campaign that are named, and most characters of the reason."""


def write(folder: Path, results: Path, name: str = "trust.md") -> None:
    """Write all experiments of a folder."""
    stored = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(results.glob("*.json"))]
    lines = [line for result in stored for line in section(result)]
    (folder / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def section(result: dict[str, Any]) -> Iterator[str]:
    """One experiment, in Markdown."""
    yield from (f"## {result['title']}", "", result["asks"], "", "```console")
    yield from (f"$ {command}" for command in result["commands"])
    yield from ("```", "", f"Made with the version of commit `{result['version']}`.", "")
    if "campaigns" in result:
        yield from _campaigns(result["campaigns"])
    else:
        yield from table(result["columns"], result["rows"])
    if result.get("notes"):
        yield from ("", result["notes"])
    yield ""


def table(columns: Iterable[str], rows: Iterable[Iterable[object]]) -> Iterator[str]:
    """A table in Markdown."""
    names = list(columns)
    yield f"| {' | '.join(names)} |"
    yield "|---" * len(names) + "|"
    yield from (f"| {' | '.join(map(str, row))} |" for row in rows)


def _campaigns(summaries: list[dict[str, Any]]) -> Iterator[str]:
    """What became of the scenes, what was said of the statements that are called true, and what is open."""
    outcomes = list(summaries[0]["scenes"])
    yield from table(outcomes, [[sum(part["scenes"][key] for part in summaries) for key in outcomes]])
    true = [row for part in summaries for row in part["statements"] if row["called"] == "true"]
    held, failed, unanswered = (sum(row[key] for row in true) for key in ("held", "failed", "unanswered"))
    count = len({(row["claim"], row["statement"]) for row in true})
    yield ""
    yield (
        f"The {count} statements that are called true held {held} times on single scenes, "
        f"failed {failed} times, and got no answer {unanswered} times."
    )
    left = [one for part in summaries for one in (*part["wrong"], *part["open"])]
    if left:
        yield ""
        rows = [(f"`{one['scene']}`", one["what"], one["why"][:WHY]) for one in left[:NAMED]]
        yield from table(("scene", "what became of it", "why"), rows)
    if len(left) > NAMED:
        yield from ("", f"{len(left) - NAMED} more are like these.")
