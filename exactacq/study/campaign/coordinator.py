"""Brings scenes to workers, and what they find into the campaign's file; nobody else writes there."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator
from contextlib import closing
from time import monotonic

from exactacq.study.campaign.cluster import cluster_records
from exactacq.study.campaign.judging import Record
from exactacq.study.campaign.settings import Settings, Task
from exactacq.study.campaign.store import Store
from exactacq.study.campaign.team import Team


def conduct(
    settings: Settings,
    store: Store,
    workers: int | None = None,
    scheduler: str | None = None,
    report: Callable[[Record], None] | None = None,
) -> None:
    """Judge all scenes that are not in the store yet; every record is committed before it is reported.

    By *workers* processes on this machine, by default one a core, or by the dask cluster whose *scheduler*
    has that address. The verdicts are the same, timeouts aside. May be ended at any time, by a kill too: what
    is committed stays, and the next call goes on from there. Raises `CampaignError`.
    """
    judged = store.done()
    tasks = [task for task in settings.tasks() if task not in judged]
    began, before = monotonic(), store.wall
    with closing(_records(settings, tasks, workers or _cores(), scheduler)) as records:
        for record in records:
            store.add([record], before + monotonic() - began)
            if report is not None:
                report(record)


def _records(
    settings: Settings, tasks: list[Task], size: int, scheduler: str | None
) -> Generator[Record, None, None]:
    if scheduler is not None:
        yield from cluster_records(settings, tasks, scheduler)
        return
    with Team(settings, size) as team:
        yield from team.records(tasks)


def _cores() -> int:
    """The cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
