"""Runs pause the search for cyclic garbage: so they must not leave any, nor be it, and must resume it."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable, Iterator
from itertools import pairwise

import pytest
from nightly import NIGHTLY

import exactacq as xa
from exactacq import gc_pause
from exactacq.gc_pause import SHARE, uncollected

FEW = 100
"""Objects that belong to others: the libraries below, and the tests themselves."""
RUNS: dict[str, Callable[[xa.Scene], xa.Run]] = {
    "circles": xa.sightseer,
    "m15": xa.seed_spreader,
    **({"m11": xa.sightseer, "plate": xa.sightseer, "relay": xa.seed_spreader} if NIGHTLY else {}),
}


@pytest.fixture
def unsearched(others_frozen: None) -> Iterator[None]:
    """No search meanwhile but by the test."""
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("unsearched")
@pytest.mark.parametrize("is_read", [False, True])
@pytest.mark.parametrize("name", RUNS)
def test_a_run_leaves_no_cycles_and_goes_without_a_search(name: str, is_read: bool) -> None:
    scene = xa.load(name)
    RUNS[name](scene)  # whatever is made once is made
    there, dropped = [], []
    for _ in range(3):
        # What others leave, such as servers of other tests that end in threads, is not left each time.
        gc.collect()
        run = RUNS[name](scene)
        assert run.path and (not is_read or run.events)
        there.append(gc.collect())
        del run
        dropped.append(gc.collect())
        if max(there[-1], dropped[-1]) < FEW:
            break
    assert min(there) < FEW, "while the run is there"
    assert min(dropped) < FEW, "once it is dropped: many runs in turn would pile up"


@pytest.mark.usefixtures("unsearched")
def test_sweeps_leave_no_cycles() -> None:
    scene = xa.load("m11")
    pieces = xa.sightseer(scene).path[:6]

    def swept() -> int:
        found = 0
        for piece in pieces:
            events = xa.sweep(scene, piece.curve, obstacle=piece.obstacle).events
            found += len([event for event in events[::2] if float(event.place.x) < 1e9])
        return found

    swept()
    gc.collect()
    assert swept() > 0
    assert gc.collect() < FEW


@pytest.mark.usefixtures("unsearched")
@pytest.mark.parametrize("name", RUNS)
def test_audits_leave_few_cycles(name: str) -> None:
    """Only the walls of the look ahead know each other, in rings: some hundred objects in a sweep's audit."""
    run = RUNS[name](xa.load(name))
    xa.audit(run, samples=8)
    gc.collect()
    xa.audit(run, samples=8)
    assert gc.collect() < (FEW if RUNS[name] is xa.sightseer else 10 * FEW)


def test_a_run_that_fails_resumes_the_search() -> None:
    def stop(visited: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        xa.sightseer(xa.load("m11"), progress=stop)
    run = xa.sightseer(xa.load("m11"))
    with pytest.raises(KeyboardInterrupt):
        run.sense(progress=stop)
    assert gc.isenabled()


def test_a_run_resumes_the_search() -> None:
    xa.sightseer(xa.load("m11")).sense()
    assert gc.isenabled()


@pytest.mark.usefixtures("unsearched")
def test_who_switched_it_off_finds_it_off() -> None:
    xa.sightseer(xa.load("m11")).sense()
    assert not gc.isenabled()


def test_what_a_run_made_is_not_searched_when_the_pause_is_over() -> None:
    with uncollected():
        made = [[k] for k in range(100_000)]
    youngest = len(gc.get_objects(generation=0)) + len(gc.get_objects(generation=1))
    assert len(made) == 100_000
    assert youngest < 50_000
    assert gc.isenabled()


def test_what_others_froze_stays_frozen() -> None:
    gc.freeze()
    frozen = gc.get_freeze_count()
    try:
        with uncollected():
            pass
        assert gc.get_freeze_count() > frozen // 2
    finally:
        gc.unfreeze()


@pytest.mark.parametrize("took", [0.5, 2.0])
def test_full_searches_take_a_hundredth_of_the_time(monkeypatch: pytest.MonkeyPatch, took: float) -> None:
    """Cycles around many runs do not pile up: here a run takes a second, and a search as long as is told."""
    now, searches = [0.0], []

    def search() -> None:
        searches.append(now[0])
        now[0] += took

    monkeypatch.setattr(gc_pause, "_last", gc_pause._FullSearch(0.0))
    monkeypatch.setattr(gc_pause, "perf_counter", lambda: now[0])
    monkeypatch.setattr(gc_pause.gc, "collect", search)
    for _ in range(1000):
        with uncollected():
            now[0] += 1
    gaps = [b - a - took for a, b in pairwise(searches)]
    assert searches[0] <= SHARE
    assert gaps and set(gaps) == {SHARE * took}


@pytest.mark.usefixtures("others_frozen")
def test_a_full_search_frees_cycles_around_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    class Ring:
        """A user's object that refers to itself."""

    monkeypatch.setattr(gc_pause, "_last", gc_pause._FullSearch(0.0, 0.0))
    ring = Ring()
    ring.self = ring  # type: ignore[attr-defined]
    alive = weakref.ref(ring)
    del ring
    with uncollected():
        pass
    assert alive() is None
