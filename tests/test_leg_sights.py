"""From where on a leg edges are seen: the kernel against whole numbers, sweeps against all exact families."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator
from fractions import Fraction
from itertools import chain, pairwise
from math import inf
from random import Random

import pytest
from nightly import NIGHTLY, some
from strategies import arc_terrain, build, circle_grid, degenerate_terrain, random_terrain

import exactacq as xa
from exactacq import kernel
from exactacq.files.octagons import random_octagons
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.family_images import AHEAD, BEHIND, CONTACT, NONE, EndLine, FamilyImage
from exactacq.kernel.images import SLIDING, TURNING
from exactacq.kernel.leg_changes import BEGINS, BOTH_SHORT, ENDS, TURNS, LegChanges, Sight
from exactacq.kernel.leg_spans import LegSpan
from exactacq.kernel.range_cuts import range_cut
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.leg_views import Shares
from exactacq.sensing.legs import legs_of
from exactacq.sensing.path import Piece
from exactacq.sensing.sensor import Sensor
from exactacq.sensing.view_events import Change, Sweep
from exactacq.visibility.sensor_range import Range

# -- the kernel ------------------------------------------------------------------------------------


def brute_changes(sights: list[tuple[int, int, int, int]], last: int) -> set[tuple[int, int, int]]:
    """Changes strictly between 0 and *last*, as (place, edge, kind), of sights (edge, name, low, high)."""
    found = set()
    for edge in {e for e, *_ in sights}:
        mine = [(low, high) for e, _, low, high in sights if e == edge and high >= 0 and low <= last]
        # Twice the places, so that there are numbers between them.
        seen = [any(2 * a <= x <= 2 * b for a, b in mine) for x in range(-1, 2 * last + 2)]
        at = dict(zip(range(-1, 2 * last + 2), seen, strict=True))
        for x in range(1, last):
            if at[2 * x] and at[2 * x - 1] != at[2 * x + 1]:
                found.add((x, edge, BEGINS if at[2 * x + 1] else ENDS))
        counts: Counter[tuple[int, int]] = Counter()
        for e, name, low, high in sights:
            if e == edge and name != NONE and high >= 0 and low <= last:
                counts[name, low] += 1
                counts[name, high] -= 1
        taken = {x for x, e, _ in found if e == edge}
        found |= {(x, edge, TURNS) for (_, x), count in counts.items() if count and 0 < x < last} - {
            (x, edge, TURNS) for x in taken
        }
    return found


@pytest.mark.parametrize("seed", some(range(300), 100))
def test_changes_are_those_of_whole_numbers(seed: int) -> None:
    """However wide the bounds are, and whether equal places have equal keys or only equal values."""
    rng, last = Random(seed), 8
    plain, found, values = [], [], []

    def bounds(value: int) -> tuple[float, float]:
        wide = rng.choice((0.0, 0.1, 0.7, 2.0))
        return value - wide * rng.random(), value + wide * rng.random()

    for _ in range(rng.randint(1, 12)):
        low, high = sorted(rng.randint(-1, last + 1) for _ in range(2))
        edge, name = rng.randint(0, 2), rng.choice((NONE, 0, 1))
        keys = [[100 + value] if rng.random() < 0.5 else [] for value in (low, high)]
        plain.append((edge, name, low, high))
        found.append(Sight(edge, name, bounds(low), bounds(high), keys[0], keys[1], BOTH_SHORT, None))
        values += [low, high]
    values += [0, last]
    changes = LegChanges(found, LegSpan(bounds(0), bounds(last)), NONE)
    parted = []
    for cluster in changes.clusters():
        places = sorted({values[end] for end in cluster})
        parted.append([[end for end in cluster if values[end] == place] for place in places])
    turns = changes.settle(parted)
    assert {(values[turn.end], turn.edge, turn.kind) for turn in turns} == brute_changes(plain, last)
    order = sorted(turns, key=lambda turn: turn.rank)
    assert [values[turn.end] for turn in order] == sorted(values[turn.end] for turn in turns)
    for a in turns:
        for b in turns:
            assert (a.rank == b.rank) == (values[a.end] == values[b.end])


def segment(ax: Fraction, ay: Fraction, bx: Fraction, by: Fraction) -> CurveImage:
    return CurveImage(float(ax), float(ay), float(bx - ax), float(by - ay), 0.0, 0, False)


def turning(ends: tuple[float, float], edges: tuple[int, int, int]) -> FamilyImage:
    """Lines through the origin, that of parameter t in the direction (1, t)."""
    frame = TURNING, 0.0, 0.0, 1.0, 0.0, 0.0, 1
    first, last = (EndLine(frame, t, 0.0, [], []) for t in ends)
    return FamilyImage(frame, (first, last), edges, True, 0, None, 0)


def square_length(u: Fraction, leg: list[Fraction], wall: list[Fraction] | None) -> Fraction:
    """The squared length of the view from a place of a segment through the origin to a wall, or to there."""
    ax, ay, bx, by = leg
    x, y = ax + u * (bx - ax), ay + u * (by - ay)
    if wall is None:
        return x * x + y * y
    cx, cy, dx, dy = wall
    share = (cx * (dy - cy) - cy * (dx - cx)) / (x * (dy - cy) - y * (dx - cx))
    return (x * x + y * y) * (1 - share) ** 2


@pytest.mark.parametrize("seed", some(range(60), 30))
@pytest.mark.parametrize("past", [False, True])
def test_the_last_view_in_range_is_where_it_is(seed: int, past: bool) -> None:
    """By fractions: the length at the two bounds of the place is on either side of the radius."""
    rng = Random(seed)

    def number(low: int, high: int) -> Fraction:
        return Fraction(rng.randint(64 * low, 64 * high), 64)

    leg = [number(-6, -2), number(-9, -3), number(-6, -2), number(3, 9)]
    wall = [number(2, 6), number(-9, -3), number(2, 6), number(3, 9)] if past else None
    radius = number(3, 9)
    ends = sorted((rng.random() - 0.5, rng.random() - 0.5))
    family = turning((ends[0], ends[1]), (0, 0, 1))
    there = AHEAD if past else CONTACT
    shown = None if wall is None else segment(*wall)
    reach = float(radius) * (1 - 1e-12), float(radius) * (1 + 1e-12)
    end, (low, high) = range_cut(family, BEHIND, there, segment(*leg), shown, reach)
    places = []
    for t in map(Fraction, ends):
        ax, ay, bx, by = leg
        places.append((ay - t * ax) / (t * (bx - ax) - (by - ay)))
    orders = [square_length(u, leg, wall) > radius**2 for u in places]
    if orders[0] == orders[1]:
        assert end == 0
        return
    assert end == (1 if orders[1] else -1)
    assert high - low < 1e-9
    assert (square_length(Fraction(low), leg, wall) > radius**2) != (
        square_length(Fraction(high), leg, wall) > radius**2
    )


def test_normals_end_where_they_are_as_long_as_the_range() -> None:
    """From the x-axis up to the line y = x + 1: that of length 3 begins at x = 2, a fifth of the way."""
    frame = SLIDING, 0.0, 0.0, 10.0, 0.0, 0.0, 1
    first, last = (EndLine(frame, t, 0.0, [], []) for t in (0.0, 1.0))
    family = FamilyImage(frame, (first, last), (NONE, 0, 1), False, NONE, None, 0)
    axis, roof = (segment(*map(Fraction, ends)) for ends in ((0, 0, 10, 0), (-1, 0, 19, 20)))
    end, (low, high) = range_cut(family, CONTACT, AHEAD, axis, roof, (3 * (1 - 1e-12), 3 * (1 + 1e-12)))
    assert end == 1
    assert low < 0.2 < high < low + 1e-9


def test_what_is_round_or_passes_infinity_is_left_open() -> None:
    leg = segment(*map(Fraction, (-2, -9, -2, 9)))
    ring = CurveImage(5.0, 0.0, 1.0, 0.0, 1.0, 1, True)
    level = segment(*map(Fraction, (-9, -1, 9, -1)))
    family, reach = turning((-0.4, 0.4), (0, 0, 1)), (3.0, 3.0)
    for shown in (ring, level):
        assert range_cut(family, BEHIND, AHEAD, leg, shown, reach)[0] == 0
    assert range_cut(family, BEHIND, CONTACT, level, None, reach)[0] == 0


# -- sweeps ----------------------------------------------------------------------------------------


def turnings(shares: Shares, taken: dict[int, list[xa.Real]]) -> Iterator[tuple[int, xa.Real]]:
    """Where windows begin or end, edge by edge, from all families with exact ends; in no order.

    A place does not count where the edge comes or goes: these are *taken*.
    """
    leg, table = shares.leg, shares.complex.table
    places: dict[int, list[tuple[xa.Real, Counter[Hashable]]]] = {}
    for share in chain.from_iterable(shares.of.values()):
        views = share.family.free_views
        if views is None or views.anchor is None:
            continue
        here, there = views.sides[share.side], views.sides[1 - share.side]
        # Behind a corner it is the edge before it that ends there.
        e = int(table.previous[share.edge]) if there.fixed and here.role < 0 else share.edge
        known = places.setdefault(e, [])
        for u, step in ((share.source.low, 1), (share.source.high, -1)):
            counts = next((c for v, c in known if v.compare(u) == 0), None)
            if counts is None:
                counts = Counter()
                known.append((u, counts))
            counts[views.anchor, there.role] += step
    for e, known in places.items():
        for u, counts in known:
            is_inside = leg.order(u, leg.first) > 0 > leg.order(u, leg.last)
            if any(counts.values()) and is_inside and all(u.compare(v) for v in taken.get(e, ())):
                yield e, u


def check_sweep(scene: xa.Scene, piece: Piece, radius: object) -> int:
    """The windows of a sweep against all exact families. Returns how many events there are."""
    table, range_ = EdgeTable(scene.obstacles), Range(xa.Real(radius).rational)
    mine = Sweep(scene, piece, Sensor(table, range_)).events
    fresh = Sensor(table, range_)
    legs = legs_of(table, fresh.rails, piece.obstacle, piece.curve)
    for k, leg in enumerate(legs):
        events = [event for event in mine if event.leg == k]
        taken: dict[int, list[xa.Real]] = {}
        turned = []
        for event in events:
            e = table.edges_of(event.obstacle).start + event.edge
            assert leg.rail.parameter(event.place).compare(event.u) == 0
            if event.change is Change.TURNING and leg.order(event.u, leg.first) > 0:
                turned.append((e, event.u))
            else:
                taken.setdefault(e, []).append(event.u)
        for a, b in pairwise(events):
            assert leg.order(a.u, b.u) <= 0
            assert leg.order(a.u, b.u) or (a.obstacle, a.edge) <= (b.obstacle, b.edge)
        expected = [*turnings(fresh.shares(leg), taken)]
        assert len(turned) == len(expected)
        for e, u in turned:
            assert any(e == f and u.compare(v) == 0 for f, v in expected)
    return len(mine)


def run_of(make: object, seed: int) -> tuple[xa.Scene, xa.Run]:
    terrain = make(Random(seed))
    scene = terrain.scene()
    return scene, xa.sightseer(scene, terrain.radius)


@pytest.mark.parametrize("make", [random_terrain, degenerate_terrain, arc_terrain])
@pytest.mark.parametrize("seed", some(range(5), 2))
def test_windows_are_those_of_all_exact_families(make: object, seed: int) -> None:
    scene, run = run_of(make, seed)
    for piece in run.path[:6]:
        check_sweep(scene, piece, run.radius)


@pytest.mark.parametrize("make", some([degenerate_terrain, random_terrain, arc_terrain], 2))
def test_floats_change_nothing(make: object, monkeypatch: pytest.MonkeyPatch) -> None:
    """With every float unsure all families are made, all places compared, and the events are the same."""
    scene, run = run_of(make, 4)
    count = 0
    for k, piece in enumerate(run.path):
        if count and k >= (2 if NIGHTLY else 1):
            break
        swept = xa.sweep(scene, piece.curve, run.radius, obstacle=piece.obstacle).events
        with monkeypatch.context() as patch:
            patch.setattr(kernel, "EXACT_ONLY", True)
            exactly = xa.sweep(scene, piece.curve, run.radius, obstacle=piece.obstacle).events
        count += len(exactly)
        assert [(e.change, e.leg, e.obstacle, e.edge) for e in swept] == [
            (e.change, e.leg, e.obstacle, e.edge) for e in exactly
        ]
        assert all(a.u.compare(b.u) == 0 for a, b in zip(swept, exactly, strict=True))
    assert count > 0


def test_places_are_made_when_they_are_read() -> None:
    scene = random_octagons(12, 3)
    run = xa.sightseer(scene, 10)
    senses = Sensor(EdgeTable(scene.obstacles), Range(run.radius))
    events = [event for piece in run.path for event in Sweep(scene, piece, senses).events]
    late = [event for event in events if event.u.is_late and event.place.is_late]
    assert len(late) > 0.8 * len(events) > 100
    place = late[0].place
    assert -inf < float(place.x + place.y) < inf
    assert not place.is_late


@pytest.mark.parametrize("radius", [3, "33/4"])
def test_exact_places_are_where_floats_tell(radius: object) -> None:
    """All around discs, where many families pass the start of the circle and are told in two parts."""
    discs = build(circle_grid(3, 3))
    senses = Sensor(EdgeTable(discs.obstacles), Range(xa.Real(radius).rational))
    count = 0
    for edge in (0, 4, 5):
        quarters = discs.obstacles[edge].edges[0]
        (leg,) = legs_of(senses.table, senses.rails, edge, quarters)
        sights = senses.sights(leg)
        assert sights.turns
        for end, (low, high) in enumerate(zip(sights._changes.low, sights._changes.high, strict=True)):
            if high - low < inf:
                count += 1
                assert low <= sights.made(end)[1] <= high
    assert count > 100


def test_what_is_shown_in_two_parts_is_one_sight() -> None:
    """From a disc another one is seen, over its start: each family is one interval of places all the same."""
    discs = build(circle_grid(2, 1))
    senses = Sensor(EdgeTable(discs.obstacles), Range(xa.Real(9).rational))
    (leg,) = legs_of(senses.table, senses.rails, 1, discs.obstacles[1].edges[0])
    sights = senses.sights(leg)._sights
    found = Counter((one.origin.origin, one.origin.here, one.origin.there, one.low) for one in sights)
    assert max(found.values()) == 1
