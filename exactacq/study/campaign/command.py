"""The command ``exactacq verify``; what it needs is imported when it runs."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Annotated

import typer

from exactacq.errors import FormatError
from exactacq.study.campaign.settings import (
    MOST_SCENES,
    RANDOM,
    SceneSource,
    Settings,
    Task,
    claims_at,
    parts,
    sizes_of,
)
from exactacq.study.families.names import Family

if TYPE_CHECKING:
    from exactacq.study.campaign.judging import Record

CONTRADICTED = 1
"""Exit status if a statement that is called true failed, or an audit did, or a scene went wrong."""
FILES = (".sqlite", ".db")
"""File types of campaigns."""
LINES = 20
"""About as many lines tell how far a campaign is where no terminal watches."""


class Chosen(StrEnum):
    """Which strategies are tried."""

    BOTH = "both"
    SIGHTSEER = "sightseer"
    SEED_SPREADER = "seed-spreader"


def verify(
    scenes: Annotated[
        int, typer.Option(min=1, max=MOST_SCENES, metavar="N", help="Random scenes of each strategy.")
    ] = 100,
    seed: Annotated[int, typer.Option(min=0, max=10**9, metavar="S", help="Another seed, other scenes.")] = 0,
    strategy: Annotated[Chosen, typer.Option(help="Which strategies to try.")] = Chosen.BOTH,
    family: Annotated[
        Family | None, typer.Option(help="Scenes like such drawings in place of small random ones.")
    ] = None,
    size: Annotated[
        str | None,
        typer.Option(metavar="N..M", help="Sizes of these drawings, 5 to 300; default: 5..40."),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, metavar="K", help="Processes on this machine; default: one a core.")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="A dask cluster's scheduler, in place of processes here."),
    ] = None,
    out: Annotated[
        str | None,
        typer.Option(metavar="F", help="Keep the results in this SQLite file, and go on from what it holds."),
    ] = None,
    table: Annotated[
        str | None, typer.Option("--export", metavar="F", help="Write all findings as a table: .parquet.")
    ] = None,
    replay: Annotated[
        str | None,
        typer.Option(metavar="STRATEGY:SEED", help="Judge one scene again, without a time limit."),
    ] = None,
    timeout: Annotated[
        float, typer.Option(min=0.1, metavar="T", help="Seconds a scene may take; more count as a timeout.")
    ] = 120.0,
    audited: Annotated[bool, typer.Option("--audit/--no-audit", help="Audit every run.")] = True,
    claimed: Annotated[
        bool, typer.Option("--claims/--no-claims", help="Put every scene to the claims.")
    ] = True,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, and no table.")] = False,
) -> None:
    """Put random exact scenes to every claim: run, audit, and check each statement.

    Exit status 1 if a statement that is called true fails on a scene, an audit fails, or a scene cannot be
    judged; timeouts and undecided scenes are counted apart.
    """
    from exactacq.files.whole_files import check_output
    from exactacq.study.campaign.table import SUFFIXES, arrow

    source = _source(family, size)
    if replay is not None:
        if out is not None or table is not None or scheduler is not None:
            raise FormatError("--replay: judges one scene here and writes nothing; leave the files out")
        _replay(_task(replay), _asked(Settings(audit=audited, source=source), claimed), as_json)
        return
    chosen = Settings().strategies if strategy is Chosen.BOTH else (strategy.value,)
    settings = _asked(Settings(scenes, seed, chosen, audited, timeout, source=source), claimed)
    target = None if table is None else check_output(table, SUFFIXES)
    if target is not None:
        arrow()
    if out is not None:
        check_output(out, FILES)
    if workers is not None and scheduler is not None:
        raise FormatError("--workers: counts processes on this machine; leave it out with --scheduler")
    if run_campaign(settings, out, workers, scheduler, target, as_json):
        raise typer.Exit(CONTRADICTED)


def run_campaign(
    settings: Settings,
    out: str | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    table: Path | None = None,
    as_json: bool = False,
) -> bool:
    """Judge what is not judged yet, print the summary, and write the table; whether anything went wrong."""
    from exactacq.output.report import console
    from exactacq.output.report_data import text_of
    from exactacq.study.campaign.coordinator import conduct
    from exactacq.study.campaign.store import Store
    from exactacq.study.campaign.summary import faults, summary, summary_data
    from exactacq.study.campaign.table import export

    called = [c for c, _ in parts(claims_at(settings.claims)) if c.strategy in settings.strategies]
    with Store(None if out is None else Path(out), settings, called) as store:
        total = sum(1 for _ in settings.tasks())
        with _progress(len(store.done()), total) as report:
            conduct(settings, store, workers, scheduler, report)
        written = None if table is None else export(store, table)
        if as_json:
            sys.stdout.write(text_of(summary_data(store)))
        else:
            console().print(summary(store))
            if written is not None:
                print(f"{written} findings written to {table}")
        return bool(faults(store))


def _source(family: Family | None, size: str | None) -> SceneSource:
    if family is None:
        if size is not None:
            raise FormatError("--size: is that of drawings; name their --family too")
        return RANDOM
    return SceneSource(family.value) if size is None else SceneSource(family.value, *sizes_of(size))


def _asked(settings: Settings, claimed: bool) -> Settings:
    return settings if claimed else replace(settings, claims="")


def _task(text: str) -> Task:
    strategy, _, seed = text.rpartition(":")
    if strategy not in Settings().strategies or not (seed.isascii() and seed.isdecimal() and len(seed) < 20):
        raise FormatError(
            f"--replay: not a scene: {text[:40]!r}; give one like sightseer:17 or seed-spreader:0"
        )
    return Task(strategy, int(seed))


def _replay(task: Task, settings: Settings, as_json: bool) -> None:
    from exactacq.output.report import console
    from exactacq.output.report_data import text_of
    from exactacq.study.campaign.judging import judge
    from exactacq.study.campaign.summary import is_faulty, record_data, record_report

    statements = list(parts(claims_at(settings.claims)))
    record = judge(task, statements, settings.audit, settings.source)
    if as_json:
        sys.stdout.write(text_of(record_data(record)))
    else:
        console().print(record_report(record))
    if is_faulty([called for called, _ in statements], record):
        raise typer.Exit(CONTRADICTED)


@contextmanager
def _progress(done: int, total: int) -> Iterator[Callable[[Record], None]]:
    """Tells standard error how far a campaign is: a bar on a terminal, else a line now and then."""
    if not sys.stderr.isatty():
        yield _lines(done, total)
        return
    from exactacq.output.report import progress_bar

    with progress_bar("verifying") as bar:
        task = bar.add_task("", total=total, completed=done)
        yield lambda _: bar.update(task, advance=1)


def _lines(done: int, total: int) -> Callable[[Record], None]:
    from exactacq.study.campaign.judging import Result

    began, count, apart = monotonic(), done, 0
    if done:
        print(f"verify: {done} of {total} scenes are judged already", file=sys.stderr, flush=True)

    def report(record: Record) -> None:
        nonlocal count, apart
        count += 1
        apart += record.result != Result.PASSED
        if count == total or count % max(1, total // LINES) == 0:
            spent = monotonic() - began
            line = f"verify: {count} of {total} scenes, {apart} not passed, {spent:.0f} s"
            print(line, file=sys.stderr, flush=True)

    return report
