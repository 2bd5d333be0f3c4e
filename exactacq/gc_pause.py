"""Pausing the interpreter's search for cyclic garbage.

A run, or a sweep, makes millions of small objects that live as long as it. It leaves no cycles, and once
dropped it is freed without a search (tests see to both). Without a pause the interpreter walks through all of
them again and again: a sixth of the time, more in larger scenes. Nor does it walk through them when the pause
is over: what was made meanwhile counts as old then, as if a search had found it in use.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from time import perf_counter

SHARE = 100
"""A full search is made when a hundredth of the time since the last one is enough for it."""


@dataclass(slots=True)
class _FullSearch:
    """When the last full search ended, and how many seconds it took: at first a guess."""

    ended: float
    took: float = 0.1


_last = _FullSearch(perf_counter())


@contextmanager
def uncollected() -> Iterator[None]:
    """No search for cyclic garbage meanwhile (of the whole process), if there is one. Also a decorator.

    Where the pauses of two threads overlap, the search goes on as soon as the one that stopped it ends.
    """
    searching = gc.isenabled()
    if searching:
        _search_now_and_then()
    gc.disable()
    try:
        yield
    finally:
        if searching:
            _take_as_old()
            gc.enable()


def _search_now_and_then() -> None:
    """Search all objects if it is time, for who makes cycles around each of many runs.

    Before a run: what it makes would only be walked through afterwards, and nothing of that found.
    """
    now = perf_counter()
    if now - _last.ended >= SHARE * _last.took:
        gc.collect()
        _last.ended = perf_counter()
        _last.took = _last.ended - now


def _take_as_old() -> None:
    """Let what is there be searched only when all objects are.

    To freeze is to move the lists of all objects to one that is never searched, in constant time, and to thaw
    moves this on to that of the oldest. Not where somebody else keeps objects frozen: they would thaw too.
    It sets the interpreter's own count of searches back, so a full search is made now and then.
    """
    if gc.get_freeze_count() == 0:
        gc.freeze()
        gc.unfreeze()
