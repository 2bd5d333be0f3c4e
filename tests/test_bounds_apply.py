"""A bound says whether it speaks of a run: as the claims count it, by code of their own."""

from __future__ import annotations

import pickle

import pytest
from nightly import some

import exactacq as xa
from exactacq.sensing.event import Ending
from exactacq.strategies import bounds
from exactacq.study.claims.model import Case, Subject
from exactacq.study.claims.premises import PREMISES
from exactacq.study.random_scenes import random_scene

SIGHTSEERS = {name: xa.load(name) for name in ("circles", "squares", "m14")}
SIGHTSEERS |= {f"random {seed}": random_scene(Subject.SIGHTSEER, seed) for seed in some(range(8), 4)}
SIGHTSEERS["by way of S alone"] = xa.Scene([xa.Circle((0, 0), 1), xa.Circle((10, 0), 1)], (5, 0), radius=5)
SIGHTSEERS["some by way of S alone"] = xa.Scene(
    [xa.Circle((x, y), 1) for x, y in ((0, 0), (10, 0), (0, 3), (10, 3))], (5, 0), radius=5
)
SPREADERS = {
    name: xa.load(name) for name in ("figure3", "figure4", "case1", "case2", "case3", "m15", "m20-8")
}
SPREADERS["one passed on the way back only"] = random_scene(Subject.SEED_SPREADER, 5_000_010)
SPREADERS |= {f"random {seed}": random_scene(Subject.SEED_SPREADER, seed) for seed in some(range(8), 4)}


@pytest.mark.parametrize("name", SIGHTSEERS)
def test_bounds_of_the_sightseer(name: str) -> None:
    """All are for the paper's model (a): not where obstacles see each other by way of the start alone."""
    case = Case(SIGHTSEERS[name])
    for bound in case.sightseer.bounds:
        assert bound.applies == PREMISES["T1 corrected"].holds(case), bound.name


@pytest.mark.parametrize("name", SPREADERS)
def test_bounds_of_the_seed_spreader(name: str) -> None:
    case = Case(SPREADERS[name])
    whole = case.spreader.ending is Ending.END_OF_M_LINE
    for bound in case.spreader.bounds:
        assert bound.applies == (whole and PREMISES[bound.name].holds(case)), bound.name


def test_case_2_is_for_diversions_that_meet_nothing_known_on_the_way_back_either() -> None:
    """What is circled on the way out was taken for unknown on the way back, where it is passed."""
    run = Case(SPREADERS["one passed on the way back only"]).spreader
    assert [e.occasion for e in run.events if e.kind == "hit" and e.obstacle == 0][-2:] == [
        "way out",
        "way back",
    ]
    assert [b.applies for b in run.bounds if b.name in ("(9)", "(11)")] == [False, False]


def test_a_run_that_sees_nothing_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    from exactacq import cli

    assert cli.main(["explore", "m14"]) == 0
    out = capsys.readouterr().out
    assert "nothing is in sight of S within R = 20" in out
    assert out.count("does not apply") == 4
    assert "80.1 " in out


@pytest.mark.parametrize("explore", [xa.sightseer, xa.seed_spreader])
def test_bounds_are_found_when_they_are_read(explore: object, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once, and as they would have been at once; a copy has them too."""
    found: list[object] = []
    told = bounds.with_bounds
    monkeypatch.setattr(bounds, "with_bounds", lambda *a: found.append(a) or told(*a))
    run = explore(xa.load("m15"))  # type: ignore[operator]
    assert not found
    assert run.bounds and run.bounds is run.bounds and len(found) == 1
    assert pickle.loads(pickle.dumps(run)).bounds == run.bounds == told(run).bounds
