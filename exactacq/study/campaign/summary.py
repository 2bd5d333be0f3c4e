"""What a campaign found, in tables for a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from rich.console import Group, RenderableType
from rich.table import Table

from exactacq.study.campaign.judging import FAILS, HOLDS, SILENT, Record, Result
from exactacq.study.campaign.settings import Called, SceneSource, Task
from exactacq.study.campaign.store import Store

SHOWN = 12
"""Most scenes that went wrong which are named; the file has them all."""
BAD = (Result.AUDIT, Result.CRASHED, Result.ERROR)
"""What no scene may come to. Timeouts and undecided scenes are no fault, and no praise either."""


class StatementCount(NamedTuple):
    """What all scenes said of one statement; ``tried`` is the sum of the other numbers.

    ``unanswered`` are checks that were undecided or in error; ``worst`` is the largest ratio, ``at`` the
    first scene that has it.
    """

    called: Called
    tried: int
    held: int
    failed: int
    silent: int
    unanswered: int
    worst: float | None
    at: Task | None


def tallies(store: Store) -> list[StatementCount]:
    """One a statement, in the order of the claims."""
    counts: dict[tuple[str, str], dict[str, int]] = {}
    for claim, part, outcome, count in store.rows(
        "SELECT claim, statement, outcome, count(*) FROM findings GROUP BY claim, statement, outcome"
    ):
        counts.setdefault((claim, part), {})[outcome] = count
    worst: dict[tuple[str, str], tuple[float, Task]] = {}
    for claim, part, ratio, strategy, seed in store.rows(
        "SELECT claim, statement, ratio, strategy, seed FROM findings WHERE ratio IS NOT NULL"
        " ORDER BY ratio, seed DESC"
    ):
        worst[claim, part] = ratio, Task(strategy, seed)  # The last one stays: the largest.
    return [
        _tally(called, counts.get(called[:2], {}), *worst.get(called[:2], (None, None)))
        for called in (Called(*row) for row in store.rows("SELECT * FROM statements ORDER BY rowid"))
    ]


def _tally(called: Called, counts: dict[str, int], worst: float | None, at: Task | None) -> StatementCount:
    tried = sum(counts.values())
    held, failed, silent = (counts.get(outcome, 0) for outcome in (HOLDS, FAILS, SILENT))
    return StatementCount(called, tried, held, failed, silent, tried - held - failed - silent, worst, at)


def faults(store: Store) -> list[tuple[Task, str, str]]:
    """Scenes that contradict what is called true, or that went wrong: which, what, and why; by seed."""
    bad = ", ".join(f"'{result.value}'" for result in BAD)
    found = store.rows(
        f"SELECT strategy, seed, outcome, detail FROM scenes WHERE outcome IN ({bad}) UNION ALL"
        " SELECT f.strategy, seed, f.claim || ' (' || f.statement || ') fails', detail"
        " FROM findings f JOIN statements s ON f.claim = s.claim AND f.statement = s.statement"
        f" WHERE f.outcome = '{FAILS}' AND s.called = 'true' ORDER BY 2, 1, 3"
    )
    return [(Task(strategy, seed), what, detail) for strategy, seed, what, detail in found]


def unfinished(store: Store) -> list[tuple[Task, str, str]]:
    """Timeouts and undecided scenes: which, what, and why; by seed."""
    found = store.rows(
        "SELECT strategy, seed, outcome, detail FROM scenes WHERE outcome IN (?, ?) ORDER BY 2, 1",
        (Result.TIMEOUT.value, Result.UNDECIDED.value),
    )
    return [(Task(strategy, seed), what, detail) for strategy, seed, what, detail in found]


def summary(store: Store) -> RenderableType:
    """The table of statements, the counts of scenes, and how to replay those that went wrong."""
    counts = ("tried", "held", "failed", "silent", "no answer")
    table = _table("claim", "statement", "called", *counts, "worst", "at")
    for t in tallies(store):
        numbers = map(str, (t.tried, t.held, t.failed, t.silent, t.unanswered))
        worst = ("", "") if t.worst is None else (f"{t.worst:.6g}", str(t.at))
        table.add_row(t.called.claim, t.called.part, t.called.truth, *numbers, *worst)
    wrong, others = (
        _named(title, found, store.settings.source)
        for title, found in (("wrong", faults(store)), ("open", unfinished(store)))
    )
    return Group(table, "", _counts(store), *wrong, *others)


def summary_data(store: Store) -> dict[str, Any]:
    """What `summary` tells, as JSON data; all scenes that went wrong or are open."""
    statements = [
        {
            "claim": t.called.claim,
            "statement": t.called.part,
            "called": t.called.truth,
            "tried": t.tried,
            "held": t.held,
            "failed": t.failed,
            "silent": t.silent,
            "unanswered": t.unanswered,
            "worst": t.worst,
            "at": None if t.at is None else str(t.at),
        }
        for t in tallies(store)
    ]
    counts = dict(store.rows("SELECT outcome, count(*) FROM scenes GROUP BY outcome"))
    return {
        "statements": statements,
        "scenes": {result.value: counts.get(result.value, 0) for result in Result},
        "seconds": store.wall,
        "wrong": [_told(*found) for found in faults(store)],
        "open": [_told(*found) for found in unfinished(store)],
    }


def _told(task: Task, what: str, why: str) -> dict[str, str]:
    return {"scene": str(task), "what": what, "why": why}


def record_data(record: Record) -> dict[str, Any]:
    """What one scene says of every statement, as JSON data."""
    return {
        "scene": str(record.task),
        "result": str(record.result),
        "detail": record.detail,
        "length": record.length,
        "seconds": record.seconds,
        "statements": [row._asdict() for row in record.rows],
    }


def _counts(store: Store) -> str:
    counts = dict(store.rows("SELECT outcome, count(*) FROM scenes GROUP BY outcome"))
    ((longest,),) = store.rows("SELECT max(seconds) FROM scenes")
    words = [f"{counts.get(result.value, 0)} {result.value}" for result in Result]
    slowest = "" if longest is None else f", the slowest scene {longest:.1f} s"
    return f"{sum(counts.values())} scenes: {', '.join(words)}; {store.wall:.1f} s{slowest}"


def _named(title: str, found: list[tuple[Task, str, str]], source: SceneSource) -> Iterator[RenderableType]:
    if not found:
        return
    yield ""
    table = _table(title, "what", "why")
    for task, what, detail in found[:SHOWN]:
        table.add_row(str(task), what, detail)
    yield table
    if len(found) > SHOWN:
        yield f"and {len(found) - SHOWN} more in the file"
    yield f"see one again with: exactacq verify{source.options} --replay {found[0][0]}"


def record_report(record: Record) -> RenderableType:
    """What one scene says of every statement."""
    table = _table("claim", "statement", "outcome", "ratio", "why")
    for row in record.rows:
        ratio = "" if row.ratio is None else f"{row.ratio:.6g}"
        table.add_row(row.claim, row.statement, row.outcome, ratio, row.detail)
    length = "" if record.length is None else f", length ≈ {record.length:.9g}"
    why = f": {record.detail}" if record.detail else ""
    return Group(f"{record.task}: {record.result}{why}{length}; {record.seconds:.1f} s", "", table)


def _table(*columns: str) -> Table:
    return Table(*columns, box=None, pad_edge=False)


def is_faulty(rows: Iterable[Called], record: Record) -> bool:
    """Whether one scene contradicts what is called true, or went wrong."""
    true = {(called.claim, called.part) for called in rows if called.truth == "true"}
    fails = any(row.outcome == FAILS and (row.claim, row.statement) in true for row in record.rows)
    return fails or record.result in BAD
