"""Threads of one process: the same results as one after the other, though all balls have one precision."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Barrier, Thread
from typing import Any

import pytest
from flint import arb, ctx
from nightly import some

import exactacq as xa
from exactacq.cached import cached_property
from exactacq.numbers.atoms import Node
from exactacq.numbers.precision import LOCK, workprec
from exactacq.numbers.real import Real

PATIENCE = 120
"""Seconds after which a thread hangs."""


@pytest.fixture
def restless() -> Iterator[None]:
    """Threads take turns as often as they can."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def together(*actions: Callable[[], object]) -> list[object]:
    """What actions give that threads do at once."""
    found: list[object] = [None] * len(actions)

    def act(k: int) -> None:
        try:
            found[k] = actions[k]()
        except Exception as error:
            found[k] = error

    threads = [Thread(target=act, args=(k,), daemon=True) for k in range(len(actions))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
        assert not thread.is_alive(), "a thread hangs"
    return found


def told(run: xa.Run) -> list[Any]:
    """What a run says, in 40 digits."""
    numbers = [(*(c.decimal(40) for c in event.point), event.at.decimal(40)) for event in run.events]
    kinds = [(event.kind, event.obstacle, event.after) for event in run.events]
    return [kinds, numbers, run.length.decimal(40), [(bound.name, bound.holds) for bound in run.bounds]]


def tour(name: str) -> list[Any]:
    run = xa.sightseer(xa.load(name))
    xa.audit(run, samples=8)
    return [*told(run), run.view_at(run.events[-1]).area.decimal(40)]


def swept(name: str) -> list[Any]:
    run = xa.seed_spreader(xa.load(name))
    xa.audit(run, samples=8)
    return told(run)


@pytest.mark.usefixtures("restless")
def test_runs_of_two_threads_are_those_of_one() -> None:
    def first() -> list[Any]:
        return [tour(name) for name in some(("circles", "m4", "figure1", "m8"), 2)]

    def second() -> list[Any]:
        return [swept(name) for name in some(("m25", "case3", "m15"), 1)]

    assert together(first, second, first) == [first(), second(), first()]
    assert ctx.prec == 53, "the precision is back where it was"


@pytest.mark.usefixtures("restless")
def test_precision_is_that_of_the_thread() -> None:
    def worst(bits: int) -> float:
        errors = []
        for _ in range(2000):
            with workprec(bits):
                errors.append(float(arb(2).sqrt().rel_accuracy_bits()))
        return min(errors)

    low, high = together(lambda: worst(64), lambda: worst(1000))
    assert (low, high) == (worst(64), worst(1000))


@pytest.mark.usefixtures("restless")
def test_equal_roots_of_two_threads_are_one_node() -> None:
    def roots() -> list[Node]:
        return [next(iter((k + Real(2).sqrt()).sqrt().terms)) for k in range(300)]  # type: ignore[misc]

    one, other = together(roots, roots)
    assert all(a is b for a, b in zip(one, other, strict=True))  # type: ignore[call-overload]


@pytest.mark.usefixtures("restless")
def test_a_late_number_is_made_once_for_all() -> None:
    for k in range(300):
        number = Real.late(arb(k, 1), lambda k=k: (k + Real(2).sqrt()) - Real(2).sqrt() + Real(3).sqrt())
        expected = k + Real(3).sqrt()
        assert together(*[lambda n=number: n.key] * 3) == [expected.key] * 3
        assert number == expected


def test_no_lock_is_held_while_a_cached_property_is_computed() -> None:
    """Two threads compute it for two objects at once."""
    both = Barrier(2, timeout=60)

    class Thing:
        @cached_property
        def value(self) -> int:
            """How many waited before."""
            return both.wait()

    things = Thing(), Thing()
    assert sorted(together(*(lambda thing=thing: thing.value for thing in things))) == [0, 1]
    assert sorted(thing.value for thing in things) == [0, 1]
    assert Thing.value.__doc__ == "How many waited before."


def test_a_precision_that_is_none_is_refused_and_changes_nothing() -> None:
    with pytest.raises((TypeError, ValueError, OverflowError)), workprec(-1):
        pass
    assert ctx.prec == 53
    assert not LOCK._is_owned()


def test_nobody_sets_the_precision_elsewhere() -> None:
    package = Path(xa.__file__).parent
    sets = ("ctx.workprec", "ctx.prec =", "ctx.dps", "extraprec", "workdps")
    found = [
        path.name for path in package.rglob("*.py") if any(word in path.read_text("utf-8") for word in sets)
    ]
    assert found == ["precision.py"]
