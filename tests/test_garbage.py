"""Runs pause the search for cyclic garbage: so they must not leave any, nor be it, and must resume it."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator

import pytest

import exactacq as xa

FEW = 100
"""Objects that belong to others: the libraries below, and the tests themselves."""
RUNS: dict[str, Callable[[xa.Scene], xa.Run]] = {
    "m11": xa.sightseer,
    "plate": xa.sightseer,
    "relay": xa.seed_spreader,
}


@pytest.fixture
def unsearched() -> Iterator[None]:
    """No search meanwhile but by the test."""
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("unsearched")
@pytest.mark.parametrize("name", RUNS)
def test_a_run_leaves_no_cycles_and_goes_without_a_search(name: str) -> None:
    scene = xa.load(name)
    RUNS[name](scene)  # whatever is made once is made
    gc.collect()
    run = RUNS[name](scene)
    assert run.path
    assert gc.collect() < FEW, "while the run is there"
    del run
    assert gc.collect() < FEW, "once it is dropped: many runs in turn would pile up"


def test_a_run_that_fails_resumes_the_search() -> None:
    def stop(visited: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        xa.sightseer(xa.load("m11"), progress=stop)
    assert gc.isenabled()


def test_a_run_resumes_the_search() -> None:
    xa.sightseer(xa.load("m11"))
    assert gc.isenabled()


@pytest.mark.usefixtures("unsearched")
def test_who_switched_it_off_finds_it_off() -> None:
    xa.sightseer(xa.load("m11"))
    assert not gc.isenabled()
