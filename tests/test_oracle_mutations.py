"""Wrong code planted into contacts, places in loops, nearest points, numbers and lengths.

The oracles must notice each fault: every day in one case that shows it, at night in the cases that their own
strategies draw. They say nothing of that case where nothing is planted.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator

import pytest
import test_contact_oracle as contact_oracle
import test_length_oracle as length_oracle
import test_locate_oracle as locate_oracle
import test_nearest_oracle as nearest_oracle
import test_number_oracle as number_oracle
from nightly import NIGHTLY
from planted_geometry import CONTACT_FAULTS, CONTACTS, LOCATION_FAULTS, NEAREST, NEAREST_FAULTS, WINDING
from planted_numbers import ANGLES, LENGTH_FAULTS, NUMBER_FAULTS, TIES
from planting import Planted, holds, holds_always

from exactacq.numbers import tower

FAULTS = [*CONTACT_FAULTS, *LOCATION_FAULTS, *NEAREST_FAULTS, *NUMBER_FAULTS, *LENGTH_FAULTS]
SECONDS = 1.0
"""Of the processor for one case: the longest take a fifth of that where nothing is planted."""


@pytest.fixture(autouse=True)
def no_events(monkeypatch: pytest.MonkeyPatch) -> None:
    """The laws tell Hypothesis what they meet, which it takes from within its own tests only."""
    for module in (contact_oracle, locate_oracle, nearest_oracle, number_oracle, length_oracle):
        monkeypatch.setattr(module, "event", lambda _: None)


@pytest.fixture(autouse=True)
def own_obstacles() -> Iterator[None]:
    """Obstacles are kept by the oracle of places, and so is what they know."""
    locate_oracle.obstacle.cache_clear()
    yield
    locate_oracle.obstacle.cache_clear()


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timers")
@pytest.mark.parametrize("planted", [pytest.param(each, id=each.what) for each in FAULTS])
def test_a_planted_fault_is_noticed(planted: Planted, monkeypatch: pytest.MonkeyPatch) -> None:
    law, case = planted.law, planted.case
    assert holds(law.check, case, SECONDS)
    planted.fault.plant(monkeypatch)
    locate_oracle.obstacle.cache_clear()
    monkeypatch.setattr(tower, "_kept", {})
    assert not holds(law.check, case, SECONDS), "the oracle says nothing of the case"
    if NIGHTLY:
        assert not holds_always(law.check, law.cases, law.examples), "the oracle's cases do not show it"


def test_what_the_faults_are_planted_in_is_sound() -> None:
    """The laws hold on cases of their own where nothing is planted."""
    for law in (CONTACTS, WINDING, NEAREST, TIES, ANGLES):
        assert holds_always(law.check, law.cases, 10)
