"""Scenes on a cluster that runs already: dask.distributed, an optional part of exactacq."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from importlib import import_module
from importlib.metadata import version
from typing import Any

from exactacq.files.extras import installing
from exactacq.study.campaign.judging import Record, Result, lost, records
from exactacq.study.campaign.settings import CampaignError, Settings, Task

BATCH = 8
"""Scenes of one task: enough to pay for the process that it starts, few enough to lose with a coordinator."""
PATIENCE = 15
"""Seconds to wait for the scheduler."""


def cluster_records(settings: Settings, tasks: Iterable[Task], address: str) -> Generator[Record, None, None]:
    """The records of all tasks from the workers of the scheduler at *address*, batch by batch.

    A task judges its batch in a process of its own beside the dask worker, so that scenes are bounded in time
    as on one machine. If dask loses workers over a batch, its scenes are tried singly, and those that take
    a worker with them again are recorded as crashed. Raises `CampaignError` if dask is not installed, if
    nobody answers at the address, or if workers run another version.
    """
    try:
        dask = import_module("distributed")
    except ImportError:
        raise CampaignError(f"--scheduler needs dask.distributed: {installing('cluster')}") from None
    try:
        client = dask.Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise CampaignError(f"--scheduler: no dask scheduler answers at {address}: {error}") from None
    with client:
        yield from _gathered(dask, client, settings, list(tasks))


def _gathered(dask: Any, client: Any, settings: Settings, tasks: list[Task]) -> Generator[Record, None, None]:
    batches = [tasks[k : k + BATCH] for k in range(0, len(tasks), BATCH)]
    futures = {_submit(client, settings, batch): batch for batch in batches}
    done = dask.as_completed(futures, loop=client.loop)
    for future in done:
        batch = futures.pop(future)
        try:
            judged = future.result()
        except dask.KilledWorker as error:
            if len(batch) == 1:
                yield lost(settings, batch[0], Result.CRASHED, 0.0, str(error))
                continue
            for task in batch:
                again = _submit(client, settings, [task])
                futures[again] = [task]
                done.add(again)
            continue
        yield from judged


def _submit(client: Any, settings: Settings, batch: list[Task]) -> Any:
    # Not pure: dask must not take a scene that was lost for one that is done.
    return client.submit(judge_batch, settings, batch, version("exactacq"), pure=False)


def judge_batch(settings: Settings, batch: list[Task], wanted: str) -> list[Record]:
    """A dask task: the records of a few scenes. Raises `CampaignError` under another version of exactacq."""
    if version("exactacq") != wanted:
        raise CampaignError(f"a worker runs exactacq {version('exactacq')}, the coordinator {wanted}")
    return list(records(settings, batch, 1))
