"""The audit reads all that events say: of which obstacle, where, on what occasion and why."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import pytest
from planted_sweeps import around, diverted, hasty, moves, resewn, straight, with_sights
from sweeps import rectangle
from test_audit import Chart, lying, refused, with_event

import exactacq as xa
from exactacq.auditing.audit import audit
from exactacq.auditing.bounds import check_bounds
from exactacq.auditing.comparisons import BITS
from exactacq.errors import AuditError
from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.sensing.event import Ending, EventKind, Occasion, Reason
from exactacq.sensing.path import Path
from exactacq.strategies.run import Run

SQUARES = ((0, 0, 2), (3, 1, 1), (1, 3, 1))
"""Corner and side: from the corner (2, 2) of the first the other two are as near as can be."""


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


class TestMovesOfATour:
    def test_a_leave_at_the_start(self) -> None:
        """From there the robot sets out anew, without a link to go back by."""
        run = tour()
        k = number(run, "backtrack")
        back = run.events[k]
        leave = replace(back, kind=EventKind.LEAVE, decided=None)
        for more in ((leave,), (leave, back)):
            events = (*run.events[: k + 1], *more, *run.events[k + 1 :])
            refused(replace(run, events=events), f"event {k + 1} (leave) cannot follow event {k} (backtrack)")

    def test_no_leave_where_the_robot_came_back(self) -> None:
        """Back at the disc in the middle the robot is where it leaves for the disc beyond the first."""
        shapes = [xa.Polygon([(x, y), (x + w, y), (x + w, y + w), (x, y + w)]) for x, y, w in SQUARES]
        run = xa.sightseer(xa.Scene(shapes, start=(-1, 1)), 1)
        k = number(run, "leave", 2)
        assert (run.events[k - 1].kind, run.events[k].after) == ("backtrack", run.events[k - 1].after)
        events = (*run.events[:k], *run.events[k + 1 :])
        refused(replace(run, events=events), "(hit of obstacle 2) cannot follow")

    def test_another_way_round(self) -> None:
        """From (-3, 0) to (-5, 0) clockwise, which is as far; and a lap before it goes the right way."""
        lap, half = tour().path[4:6]
        clockwise = replace(half, curve=Arc(half.start, half.end, half.curve.center, 1, ccw=False))
        for way in ([clockwise], [lap, half]):
            refused(resewn(tour(), 5, 6, *way), "(leave of obstacle 1) is not reached the shorter way")

    def test_walks_on(self) -> None:
        """Around the third disc once more, where nothing is left to be done."""
        run = resewn(tour(), 8, 8, tour().path[7])
        refused(with_event(run, number(run, "stop"), point=run.path[-1].end, after=9), "1 pieces after")

    def test_a_link_twice(self) -> None:
        """From a start on its boundary the first obstacle has a link of length 0, which adds nothing."""
        run = xa.sightseer(xa.load("circles"), start=(3, 0))
        refused(replace(run, links=(run.links[0], *run.links)), "links lead to [0, 0, 1]")

    def test_returns_the_longer_way(self) -> None:
        """A lap around the first disc before the way back."""
        run = resewn(tour(), 2, 2, tour().path[1])
        refused(run, "(leave of obstacle 0)")


class TestWords:
    """The occasion, the other end of a link, the reason or the ending that an event tells."""

    @pytest.mark.parametrize(
        ("kind", "changes"),
        [
            ("hit", {"other": 1}),
            ("hit", {"occasion": Occasion.BACKTRACK}),
            ("leave", {"other": 1}),
            ("backtrack", {"other": "S"}),
            ("backtrack", {"occasion": None}),
            ("start", {"occasion": Occasion.ADVANCE}),
            ("sight", {"reason": Reason.RANGE}),
            ("leave", {"ending": Ending.ALL_VISITED}),
        ],
    )
    def test_of_a_tour(self, kind: str, changes: dict[str, Any]) -> None:
        k = number(tour(), kind)
        refused(with_event(tour(), k, **changes), f"event {k} ({kind}")

    @pytest.mark.parametrize(
        ("kind", "changes"),
        [
            ("hit", {"occasion": Occasion.DIVERSION}),
            ("hit", {"other": 0}),
            ("leave", {"occasion": Occasion.WAY_BACK}),
            ("divert", {"occasion": Occasion.WAY_OUT}),
            ("stop", {"obstacle": 0}),
        ],
    )
    def test_of_a_sweep(self, kind: str, changes: dict[str, Any]) -> None:
        k = number(around(), kind)
        refused(with_event(around(), k, **changes), f"event {k} ({kind}")

    def test_of_an_own_strategy(self) -> None:
        """What goes to an obstacle does not come back to it."""
        run = xa.explore(xa.load("circles"), "nearest-frontier")
        k = number(run, "hit")
        refused(with_event(run, k, kind=EventKind.BACKTRACK), f"event {k} (backtrack of obstacle 0)")


@pytest.mark.parametrize("make", [tour, around, hasty])
def test_whether_a_bound_applies(make: Callable[[], Run]) -> None:
    """A broken bound that is said not to apply would be told as none."""
    run = make()
    values = {bound.name: bound.value.ball(BITS) for bound in run.bounds}
    check_bounds(run, values)
    for k, bound in enumerate(run.bounds):
        wrong = replace(bound, applies=not bound.applies)
        with pytest.raises(AuditError, match="but applies is"):
            check_bounds(replace(run, bounds=(*run.bounds[:k], wrong, *run.bounds[k + 1 :])), values)


def test_ratios_are_as_close_as_floats_are() -> None:
    """The path is far longer than its bound: the last digit of the ratio is more than 10^-12."""
    box = xa.Polygon([(10**6, 0), (10**6 + 1, 0), (10**6, 1)])
    run = xa.sightseer(xa.Scene([box], start=(0, 0)), 10**7)
    audit(run, samples=2)
    bound = run.bounds[0]
    wrong = replace(bound, ratio=bound.ratio * (1 + 1e-11))
    refused(replace(run, bounds=(wrong, *run.bounds[1:])), "bound (1) has the ratio")


class TestPlaces:
    """Where something comes into sight, goes out of it, or is known as a whole."""

    @pytest.mark.parametrize("changes", [{"after": 2, "inside": False}, {"point": Point("17/5", "4/5")}])
    def test_late_to_be_known(self, changes: dict[str, Any]) -> None:
        """All of the first disc is known on the way around it, and said to be so at its end, or later on."""
        k = number(tour(), "acquire")
        changes = {"point": tour().path[1].end, **changes}
        refused(with_event(tour(), k, **changes), f"event {k} (acquire of obstacle 0) is late")

    @pytest.mark.parametrize("shift", ["1e-9", "-1e-9"])
    def test_lost_beside_the_place(self, shift: str) -> None:
        """The second disc is out of range from (2, 0) on."""
        k = number(tour(), "lose")
        assert tour().events[k].point == Point(2, 0)
        words = "out of sight" if shift.startswith("-") else "in sight"
        refused(with_event(tour(), k, point=Point(2 + xa.Real(shift), 0)), f"obstacle 1 is not {words} from")

    def test_a_frontier_where_nothing_ends(self) -> None:
        class Frayed(Chart):
            @property
            def frontier(self) -> tuple[tuple[int, Point], ...]:
                return (*super().frontier, (0, Point(2, "1/7")))

        refused(
            lying(lambda rows, after: rows, Frayed), "(2, 0.142857142857143) of obstacle 0 is in the frontier"
        )


class TestReasonsToDivert:
    """Where it is that something is about to be lost, without a look ahead."""

    def test_out_of_reach_and_in_reach_again(self) -> None:
        """What is known of the wall behind the screen ends at both sides of a third one, so far apart.

        Between them the robot is out of reach of both, and diverts though it will be in reach of the lower.
        """
        shapes = [
            rectangle("3/2", "1/2", 2, 20),
            rectangle("23/10", "1/5", "26/10", 23),
            rectangle("1/2", 6, 1, 14),
        ]
        run = xa.seed_spreader(xa.Scene(shapes, terrain=xa.Terrain(6, 24)), 3, lookahead=False)
        (diversion,) = run.diversions
        assert (diversion.obstacle, diversion.reason) == (0, Reason.OUT_OF_REACH)
        audit(run, samples=2)

    def test_too_early(self) -> None:
        """From (20, 53), where W is still in sight, by a straight way to (9, 52) and back."""
        run, place = hasty(), (20, 53)
        way = [*straight((20, 100), place, (9, 52)), *run.path[6:10], *straight((9, 52), place, (20, 0))]
        path = Path((*run.path[:2], *way))
        after = {"start": 0, "divert": 3, "hit": 4, "leave": 8, "return": 9, "stop": 10}
        events = tuple(
            replace(
                event,
                path=path,
                after=after[event.kind],
                point=Point(*place) if event.kind in ("divert", "return") else event.point,
                decided=None,
            )
            for event in moves(run)
        )
        early = with_sights(replace(run, path=path, events=events, record=None))
        early = diverted(early, leave=Point(*place), first=3, last=9)
        refused(early, "(divert of obstacle 0) is due to 'out of sight', which is not so")


def test_places_beside_events_of_a_large_scene() -> None:
    """An arc ends where a corner comes in range; 10^-11 before, a billion away, is that end once more."""
    size = 10**9
    sector = xa.Outline([(0, 0), (25 * size, 0, "1/3"), (7 * size, 24 * size)])
    corner = xa.Polygon([(4 * size, 28 * size), (8 * size, 40 * size), (0, 40 * size)])
    run = xa.sightseer(xa.Scene([sector, corner], start=(27 * size, 0)), 5 * size)
    assert run.events[number(run, "sight", 1)].point == Point(7 * size, 24 * size)
    for seed in range(4):
        audit(run, samples=8, seed=seed)
