"""Brings scenes to workers, and what they find into the campaign's file; nobody else writes there."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import closing
from time import monotonic

from exactacq.study.campaign.cluster import cluster_records
from exactacq.study.campaign.judging import Record, records
from exactacq.study.campaign.settings import Settings
from exactacq.study.campaign.store import Store


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
    is committed stays, and the next call goes on from there. Raises `CampaignError`,
    `exactacq.study.processes.ProcessError`.
    """
    judged = store.done()
    tasks = [task for task in settings.tasks() if task not in judged]
    began, before = monotonic(), store.wall
    if scheduler is None:
        judging = records(settings, tasks, workers or _cores())
    else:
        judging = cluster_records(settings, tasks, scheduler)
    with closing(judging):
        for record in judging:
            store.add([record], before + monotonic() - began)
            if report is not None:
                report(record)


def _cores() -> int:
    """The cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
