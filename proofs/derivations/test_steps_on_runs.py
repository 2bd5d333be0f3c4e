"""Steps of the written arguments that are easily wrong, tried on runs: exactly, step by step."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest
from flint import fmpq
from scenes import overlapping_links, trapped_end

from exactacq import Circle, Length, Run, Scene, Terrain, seed_spreader, sightseer
from exactacq.files import gallery
from exactacq.geometry.points import Point, distance
from exactacq.sensing.event import Ending, Event, Occasion, Reason
from exactacq.study.claims.tight_families import relay

SWEPT = ["case1", "case2", "case3", "e3", "figure3", "figure4", "m14", "m15", "m18", "m20-6", "m25"]
HALF = fmpq(1, 2)


@pytest.fixture(scope="module", params=[*SWEPT, "relay"])
def sweep(request) -> Run:
    return seed_spreader(relay(3) if request.param == "relay" else gallery.scene(request.param))


def ways(run: Run) -> list[list[Event]]:
    """The events of each diversion, from "divert" to "return"."""
    found: list[list[Event]] = []
    is_out = False
    for event in run.events:
        if event.kind == "divert":
            found.append([])
            is_out = True
        if is_out:
            found[-1].append(event)
        is_out = is_out and event.kind != "return"
    return found


def straight(run: Run, first: int, last: int) -> Length:
    return Length.sum(piece.length for piece in run.path[first:last] if piece.kind == "straight")


# -- SSS-1: the M-line is walked once, and a hit is a step on --------------------------------------


def test_sss_1_the_m_line_parts_add_up_to_no_more_than_the_m_line(sweep: Run) -> None:
    off = Length.sum(straight(sweep, d.first, d.last) for d in sweep.diversions)
    whole = next(b.value for b in sweep.bounds if b.name == "(8)")
    assert straight(sweep, 0, len(sweep.path)) - off <= whole


# -- the lemma on ways -----------------------------------------------------------------------------


def test_ways_a_diversion_walks_no_more_than_twice_d_q_straight(sweep: Run) -> None:
    for d in sweep.diversions:
        assert straight(sweep, d.first, d.last) <= Length(distance(d.leave, d.hit)) * 2


def test_ways_that_sight_or_reach_begins_are_within_the_radius(sweep: Run) -> None:
    for d in sweep.diversions:
        near = Length(distance(d.leave, d.hit)) <= Length(sweep.radius)
        assert near or d.reason not in (Reason.OUT_OF_SIGHT, Reason.OUT_OF_REACH)


def test_ways_at_the_end_of_a_line_too() -> None:
    """What was seen from a diversion that began where the line ends can be farther than the radius."""
    run = seed_spreader(relay(2, foot=5))
    assert [d.reason for d in run.diversions] == [Reason.LINE_ENDS] * 3
    lengths = [float(distance(d.leave, d.hit)) for d in run.diversions]
    assert lengths == pytest.approx([7.787, 24.738, 43.416], abs=1e-3)


def test_ways_meet_an_obstacle_once_there_and_once_back_and_a_pair_never_again(sweep: Run) -> None:
    pairs: list[frozenset[int | None]] = []
    for events in ways(sweep):
        aim = events[0].obstacle
        for occasion in (Occasion.WAY_OUT, Occasion.WAY_BACK):
            met = Counter(e.obstacle for e in events if e.kind == "hit" and e.occasion is occasion)
            assert all(count == 1 for count in met.values())
        pairs += {frozenset((aim, e.obstacle)) for e in events if e.kind == "hit" and e.obstacle != aim}
    assert len(pairs) == len(set(pairs))


def test_sss_5_every_diversion_has_an_aim_of_its_own(sweep: Run) -> None:
    aims = [d.obstacle for d in sweep.diversions]
    assert len(aims) == len(set(aims))


# -- the lemma on shores ---------------------------------------------------------------------------


def test_shores_a_disc_that_touches_two_borders_is_walked_around() -> None:
    """Its collar within the terrain is in two pieces; its boundary is one loop, and is circled."""
    run = seed_spreader(Scene([Circle((5, 2), 2)], terrain=Terrain(10, 4), radius=5))
    (disc,) = run.obstacles
    assert disc.closed
    assert run.visits == (0,)
    hit, leave = (e.point for e in run.events if e.kind in ("hit", "leave"))
    assert (hit, leave) == (Point(5, 4), Point(5, 0))
    assert run.path[-1].end == Point(10, 4)
    assert sum(p.obstacle == 0 for p in run.path) > 1


# -- SSS-7: what each boundary costs ---------------------------------------------------------------


def test_sss_7_each_boundary_costs_its_circling_and_its_passings(sweep: Run) -> None:
    """1.5 p and p/2 for a closed one, 3 p and p at the border: obstacle by obstacle."""
    arrivals = Counter(e.obstacle for e in sweep.events if e.kind in ("hit", "cross"))
    for k, body in enumerate(sweep.obstacles):
        share = HALF if body.closed else fmpq(1)
        circled = sweep.visits.count(k)
        assert circled <= 1
        walked = Length.sum(piece.length for piece in sweep.path if piece.obstacle == k)
        assert walked <= body.perimeter * ((3 * circled + arrivals[k] - circled) * share)


# -- L1: links, not points -------------------------------------------------------------------------


def test_l1_a_stretch_of_two_links_is_walked_four_times() -> None:
    run = sightseer(overlapping_links())
    assert {link.traversals for link in run.links} <= {1, 2}
    middle = Point(6, 0)
    over = [p for p in run.path if p.kind == "straight" and p.curve.passes(middle)]
    assert [(p.start, p.end) for p in over] == [
        (Point(5, 0), Point(7, 0)),
        (Point(0, 0), Point(10, 0)),
        (Point(10, 0), Point(0, 0)),
        (Point(7, 0), Point(5, 0)),
    ]


# -- T1: the way from S is walked once, the last link too ------------------------------------------


@pytest.mark.parametrize("name", ["figure1", "figure2", "m8", "m11", "circles", "squares"])
def test_t1_only_links_between_obstacles_are_walked_back(name: str) -> None:
    run = sightseer(gallery.scene(name))
    assert run.complete
    by_target = {link.target: link for link in run.links}
    assert [link.target for link in run.links if link.source == "S"] == [run.visits[0]]
    assert by_target[run.visits[0]].traversals == by_target[run.visits[-1]].traversals == 1
    arrivals = [e.obstacle for e in run.events if e.kind in ("hit", "backtrack")]
    assert arrivals[-1] == run.visits[-1]
    assert len(arrivals) - len(run.visits) <= max(len(run.visits) - 2, 0)
    assert all(one != other for one, other in pairwise(arrivals))


# -- SSS-2: the end of the M-line must be free -----------------------------------------------------


def test_sss_2_what_is_known_is_acquired_unless_the_end_is_trapped() -> None:
    assert seed_spreader(trapped_end(True)).complete
    run = seed_spreader(trapped_end(False))
    assert run.incomplete == (0,)
    assert run.ending is Ending.TRAPPED
