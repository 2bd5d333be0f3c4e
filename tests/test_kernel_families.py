"""Images of families in the kernel: what is at an edge, and which families matter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction as Q
from math import inf
from random import Random

import pytest
from nightly import some
from strategies import arc_terrain, degenerate_terrain

import exactacq as xa
from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Segment
from exactacq.kernel.choice import Source, mattering
from exactacq.kernel.extents import EVERYTHING, Extent, Span
from exactacq.kernel.family_images import NONE
from exactacq.kernel.images import ROLLING
from exactacq.kernel.leg_spans import LegSpan
from exactacq.kernel.whole_edges import last_shown, not_covered
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.complex_edges import FamilySweeper
from exactacq.sensing.line_family import single_of
from exactacq.visibility.sensor_range import Range


def scene_of(seed: int) -> xa.Scene:
    return (arc_terrain, degenerate_terrain)[seed % 2](Random(seed)).scene()


def sweeper_of(seed: int) -> FamilySweeper:
    try:
        table = EdgeTable(scene_of(seed).obstacles)
    except xa.InvalidScene:
        pytest.skip("no scene")
    return FamilySweeper(table, Range(xa.Real(4).rational))


@pytest.mark.parametrize("seed", range(8))
def test_what_is_at_an_edge(seed: int) -> None:
    """All families and single lines of an edge, and no others; and single lines begin where it is said."""
    sweeper = sweeper_of(seed)
    edges = range(len(sweeper.table.curves))
    ways = sweeper.tangents, sweeper.normals, sweeper.corner_normals
    for found in (swept(e) for e in edges for swept in ways):
        for e in edges:
            assert found.at.get(e, []) == [one for one in found.images if e in one.edges]
            assert found.lines_at.get(e, []) == [
                one for one in found.single_lines if one.edge != NONE and e in (one.edge, one.shown)
            ]
        for one in found.single_lines:
            single = single_of(one)
            x, y, error = one.place
            offset = single.place - xa.Point(x, y)
            assert error == inf or max(abs(offset.x), abs(offset.y)) <= error
            if one.edge != NONE:
                curve, u = sweeper.table.curves[one.edge], single.u
                assert u is not None and curve.passes(single.place)
                top = sweeper.clipper.rails[one.edge].top
                low, high = (0 if v == -inf else top if v == inf else xa.Real(v) for v in one.source)
                if sweeper.table.full[one.edge]:
                    assert low <= u <= high or one.source in (EVERYTHING, (-inf, -inf), (inf, inf))
                else:
                    assert low <= u <= high


def test_an_arc_sees_from_all_of_it() -> None:
    """What is near an arc's end is swept, though it is far from the corner where the arc starts."""
    half_disc = xa.Outline([(-3, 0), (3, 0, 1)])
    square = xa.Polygon([(-5, 1), (-4, 1), (-4, 2), (-5, 2)])
    table = EdgeTable(xa.Scene([half_disc, square], radius=2).obstacles)
    found = FamilySweeper(table, Range(xa.Real(2).rational)).tangents(1)
    tangents = [one for one in found.images if one.frame[0] == ROLLING]
    assert any(table.owner[e] == 1 for one in tangents for e in one.edges if e >= 0)


BLUR = 1 / 1024
"""Half the least width of what floats tell of a place."""
NEARBY = [Q(0), Q(0), Q(0), Q(1, 4096)]
"""Most places are equal or far apart, and some are so close that floats do not part them."""
LEG = Q(0), Q(1)
SEGMENT = curve_image(Segment(xa.Point(0, 0), xa.Point(1, 0)))
"""The curve of a leg where that does not matter."""
Exact = tuple[Q, Q]


@dataclass
class Planted:
    """A family as it is: the part of the leg's line from which it is seen, and what it shows from there.

    From its low end to its high end it shows edge ``edge`` from the first to the last of ``shown``. Of one
    that is not surely in range only ``part`` is there, if anything. A single line is seen from one place.
    """

    source: Exact
    edge: int
    shown: Exact
    part: Exact | None
    sure: bool

    def told_within(self, low: Q, high: Q) -> Exact | None:
        """What it shows from a part of the leg."""
        if self.part is None or max(low, self.part[0]) > min(high, self.part[1]):
            return None
        (a, b), (c, d) = self.source, self.shown
        if a == b:
            return c, d
        ends = [c + (d - c) * (u - a) / (b - a) for u in (max(low, self.part[0]), min(high, self.part[1]))]
        return min(ends), max(ends)

    def extent(self, rng: Random) -> Extent:
        """What floats tell of it; the line at each place has a key, known or not."""
        width = rng.choice((1, 1, 2, 8))
        outer, inner = blurred(self.source, width), blurred(self.source, -width)
        c, d = min(self.shown), max(self.shown)
        keys = [[int(4096 * u)] if rng.random() < 0.8 else [-rng.randrange(1, 10**9)] for u in self.source]
        surely, told = (inner, blurred((c, d), -width)) if self.sure else ((inf, -inf), (inf, -inf))
        keys = keys if self.sure else [[], []]
        if self.source[0] == self.source[1]:
            surely, told, keys = (inf, -inf), (inf, -inf), [[-rng.randrange(1, 10**9)]] * 2
        shown = blurred((c, d), width)
        if rng.random() < 0.8:
            shown, told = (extended(span, (c, d)) for span in (shown, told))
        one = Extent(self.edge, shown, outer, surely, *keys, None, 0, 1, rng.random() < 0.9, told)
        one.in_range = self.sure
        return one


def blurred(span: Exact, outward: int) -> Span:
    """An interval in floats, wider or narrower than it is."""
    return float(span[0]) - outward * BLUR, float(span[1]) + outward * BLUR


def extended(span: Span, exact: Exact) -> Span:
    """Bounds of an interval of an edge from 0 to 1, where it is known that it ends where the edge does."""
    if span[0] > span[1]:
        return span
    return -inf if exact[0] == 0 else span[0], inf if exact[1] == 1 else span[1]


def planted(rng: Random) -> Iterator[Planted]:
    """Families at a leg from 0 to 1, some of them seen from beyond, with many places in common."""
    for _ in range(rng.randint(1, 12)):
        a = Q(rng.randrange(-2, 9), 8) + rng.choice(NEARBY)
        b = a + Q(rng.randrange(1, 6), 8) + rng.choice(NEARBY)
        c, d = (min(Q(rng.randrange(9), 8) + rng.choice(NEARBY), Q(1)) for _ in range(2))
        sure = rng.random() < 0.8
        if rng.random() < 0.2:
            yield Planted(
                (a, a), rng.randrange(3), (c, c), (a, a) if sure else rng.choice([None, (a, a)]), sure
            )
        part = (a, b) if sure else rng.choice([None, (a, a + (b - a) / 3), (a + (b - a) / 2, b)])
        if c != d:
            yield Planted((a, b), rng.randrange(3), (c, d), part, sure)


def united(spans: list[Exact | None]) -> list[Exact]:
    """The union of closed intervals."""
    found: list[Exact] = []
    for low, high in sorted(span for span in spans if span is not None):
        if found and low <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], high)
        else:
            found.append((low, high))
    return found


@pytest.mark.parametrize("seed", some(range(400), 130))
def test_what_is_left_out_changes_nothing(seed: int) -> None:
    """At every place of the leg all that is shown so far is known or shown by a family that matters.

    And an obstacle is in sight where one that matters shows it, or where it surely is, and nowhere else.
    """
    rng = Random(seed)
    some = [*planted(rng), *planted(rng)]
    extents = [one.extent(rng) for one in some]
    some_known = [[], [(Q(-1), Q(2))], [(Q(rng.randrange(4), 8), Q(rng.randrange(4, 9), 8))]]
    known = {e: rng.choice(some_known) for e in (0, 1)}
    owners = {0: [(0, True)], 1: [(0, True), (1, False)]}
    ahead = rng.random() < 0.5
    leg = LegSpan((-BLUR, BLUR), (1 - BLUR, 1 + BLUR), ahead)
    view = {0: rng.choice(some_known), 1: rng.choice(some_known)}
    inside, at_end = (
        {e: [extended(blurred(span, -1), span) for span in spans] for e, spans in one.items()}
        for one in (known, view)
    )
    numbers, groups, spared, complete = mattering(extents, leg, owners, {0, 1}, set(), inside, at_end)
    assert all(n in numbers for n, one in enumerate(extents) if not one.is_known and one.edge in owners)
    # What is spared may matter for the time: with it nothing is left out.
    in_time = {*numbers, *(n for _, kept in spared for n in kept)}
    assert complete in ([], [0]), "of edge 1 only a part counts for obstacle 1"
    for e in (0, 1):
        told = {n: one.told_within(*LEG) for n, one in enumerate(some) if one.edge == e}
        before = [*known[e], *view[e]]
        everything = united([*before, *told.values()])
        if e in complete:
            assert covers(everything, (Q(0), Q(1)))
        else:
            assert united([*before, *(span for n, span in told.items() if n in numbers)]) == everything
    assert not any(some[n].edge == 2 for n in in_time)
    # Of edge 1 only a part counts for obstacle 1: floats do not tell that it is this which is seen.
    assert not any(owner == 1 for owner, *_ in groups)
    for place in (Q(k, 16) for k in range(17)):
        part = (Q(0), place) if ahead else (place, Q(1))
        for e in (0, 1):
            shown = [(n, one.told_within(*part)) for n, one in enumerate(some) if one.edge == e]
            everything = united([*known[e], *(span for _, span in shown)])
            assert united([*known[e], *(span for n, span in shown if n in in_time)]) == everything
    for k in (0, 1):
        of_k = [n for n, one in enumerate(some) if k in [owner for owner, _ in owners.get(one.edge, [])]]
        times = {n: clipped(some[n].part) for n in of_k}
        sure = [sure_interval(some, first, last) for owner, first, last in groups if owner == k]
        inner = [time for time in united(list(times.values())) if LEG[0] < time[1] and time[0] < LEG[1]]
        chosen = united([*sure, *(times[n] for n in of_k if n in numbers)])
        assert [time for time in chosen if LEG[0] < time[1] and time[0] < LEG[1]] == inner


def test_of_families_that_show_the_same_one_is_kept() -> None:
    """Each is told by the other one; they cannot both be left out."""
    one, other = (
        Extent(0, EVERYTHING, (0.2, 0.8), (0.3, 0.7), [], [], None, 0, 1, True, EVERYTHING) for _ in range(2)
    )
    leg = LegSpan((0.0, 0.0), (1.0, 1.0))
    assert len(not_covered([one, other], leg, [])) == 1
    assert not_covered([one, other], leg, [(-inf, 0.5), (0.4, inf)]) == []


@pytest.mark.parametrize("seed", some(range(400), 130))
def test_when_an_edge_is_known_all_over(seed: int) -> None:
    """At the latest moment that floats tell for some edges, each of them is known all over."""
    rng = Random(seed)
    families = [*planted(rng), *planted(rng)]
    extents = [one.extent(rng) for one in families]
    ahead = rng.random() < 0.5
    leg = LegSpan((-BLUR, BLUR), (1 - BLUR, 1 + BLUR), ahead)
    known = {e: [(Q(0), Q(rng.randrange(8), 8))] for e in range(3)}
    inside = {e: [extended(blurred(span, -1), span) for span in spans] for e, spans in known.items()}
    found, (low, high), _ = last_shown([0, 1, 2], extents, leg, inside, SEGMENT, [])
    assert found == [0, 1, 2] and (low if ahead else -high) == -inf
    for e in range(3):
        (edge,), (low, high), _ = last_shown([e], extents, leg, inside, SEGMENT, [])
        place = high if ahead else low
        if abs(place) < inf:
            part = (Q(0), Q(place)) if ahead else (Q(place), Q(1))
            told = [one.told_within(*part) for one in families if one.edge == edge]
            assert covers(united([*known[e], *told]), (Q(0), Q(1)))


def test_some_edges_are_known_all_over() -> None:
    """The laws above speak of cases that there are."""
    spared, timed = 0, 0
    for seed in range(130):
        rng = Random(seed)
        extents = [one.extent(rng) for _ in range(3) for one in planted(rng)]
        leg = LegSpan((-BLUR, BLUR), (1 - BLUR, 1 + BLUR))
        spared += len(mattering(extents, leg, {0: [(0, True)]}, {0}, set(), {}, {})[3])
        timed += last_shown([0], extents, leg, {}, SEGMENT, [])[1][1] < inf
    assert spared > 5 and timed > 5, (spared, timed)


@pytest.mark.parametrize("seed", range(20))
def test_before_an_edge_is_in_front_it_is_behind(seed: int) -> None:
    """Before the earliest moment all of a straight leg lies strictly on the closed side of the edge."""
    rng = Random(seed)
    told = 0
    for _ in range(60):
        far = rng.choice([0, 0, 10**6])
        (ax, ay), (bx, by), (px, py), (qx, qy) = (
            (far + Q(rng.randrange(-9, 10), 7) + rng.choice(NEARBY), Q(rng.randrange(-9, 10), 7))
            for _ in range(4)
        )
        if (ax, ay) == (bx, by) or (px, py) == (qx, qy):
            continue
        leg, edge = (
            curve_image(Segment(xa.Point(*one), xa.Point(*other)))
            for one, other in (((ax, ay), (bx, by)), ((px, py), (qx, qy)))
        )
        ahead = rng.random() < 0.5
        span = LegSpan((0.0, 0.0), (1.0, 1.0), ahead)
        _, (low, high), _ = last_shown([0], [], span, {}, leg, [edge])
        bound = Q(low if ahead else high) if abs(low if ahead else high) < inf else None
        heights = [(qx - px) * (y - py) - (qy - py) * (x - px) for x, y in ((ax, ay), (bx, by))]
        if bound is None:
            continue
        told += 1
        # Heights are linear along the leg: left of the edge, in its obstacle, they are positive.
        at = heights[0] + (heights[1] - heights[0]) * bound
        slope = (heights[1] - heights[0]) * (1 if ahead else -1)
        assert slope < 0 and at >= 0
    assert told > 5


def covers(spans: list[Exact], whole: Exact) -> bool:
    """Whether one of some separate intervals contains another one."""
    return any(low <= whole[0] and whole[1] <= high for low, high in spans)


def sure_interval(some: list[Planted], first: Source, last: Source) -> Exact:
    """From where one family begins to where another ends, or to the ends of the leg."""
    low = LEG[0] if first.surely[0] == -inf else max(some[first.number].source[0], LEG[0])
    high = LEG[1] if last.surely[1] == inf else min(some[last.number].source[1], LEG[1])
    return low, high


def clipped(span: Exact | None) -> Exact | None:
    """What of an interval lies in the leg."""
    if span is None or span[0] > LEG[1] or span[1] < LEG[0]:
        return None
    return max(span[0], LEG[0]), min(span[1], LEG[1])
