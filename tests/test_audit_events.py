"""The audit reads all that events say: of which obstacle, where, on what occasion and why."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest
from test_audit import refused, with_event

import exactacq as xa
from exactacq.strategies.run import Run


@cache
def tour() -> Run:
    """East to a disc, back to the start, west to a second disc, and from it on to a third."""
    discs = [xa.Circle((x, 0), 1) for x in (4, -4, -9)]
    return xa.sightseer(xa.Scene(discs, start=(0, 0)), 5)


def number(run: Run, kind: str, n: int = 0) -> int:
    """The number of the n-th event of a kind."""
    return [k for k, event in enumerate(run.events) if event.kind == kind][n]


class TestObstacles:
    """Numbers that no obstacle has, and none at all where something is sensed."""

    @pytest.mark.parametrize(("kind", "obstacle"), [("regain", None), ("sight", 3), ("hit", 3), ("hit", -1)])
    def test_of_a_tour(self, kind: str, obstacle: int | None) -> None:
        k = number(tour(), kind)
        refused(with_event(tour(), k, obstacle=obstacle), f"event {k} ({kind}", "none that the run has")

    def test_of_an_own_strategy(self) -> None:
        run = xa.explore(xa.load("circles"), "nearest-frontier")
        k = number(run, "hit")
        refused(with_event(run, k, obstacle=2), f"event {k} (hit of obstacle 2)", "none that the run has")
        refused(replace(run, visits=(2,)), "obstacle 2 was visited, but never walked all around")
