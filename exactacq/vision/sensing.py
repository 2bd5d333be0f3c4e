"""Sensing while moving: what each piece of a path teaches, and when obstacles come into sight or leave it.

Nothing is sampled and nothing stepped. A piece of the path is a *leg* on the rail that carries it; what it
shows is the union of the glances that start on it and of the views from its two ends (see `glances`). Only
obstacles that are not acquired yet are looked at.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cmp_to_key

import numpy as np
from flint import fmpq

from exactacq.contacts import contacts
from exactacq.curves import Arc
from exactacq.points import Point, distance_sq
from exactacq.reals import Real
from exactacq.vision.crossing import Crossing
from exactacq.vision.glances import Glance, Ranges
from exactacq.vision.intervals import EMPTY, Cover, Interval
from exactacq.vision.legs import Leg
from exactacq.vision.pencil import rational_between
from exactacq.vision.sightlines import Sightlines
from exactacq.vision.table import EdgeTable
from exactacq.vision.views import seen_from

Covers = Mapping[int, Cover]
"""What is known of each edge, by its number; nothing is known of an edge that is missing."""


VIEWS_KEPT = 64
"""Views from ends of legs that are remembered: enough for a walk along one boundary and back."""


class Kind(Enum):
    """What sensing reports; several reports from one place come in this order."""

    SIGHT = "sight"
    """The first point of an obstacle is known."""
    REGAIN = "regain"
    """An obstacle that is not acquired comes back into sight."""
    ACQUIRE = "acquire"
    """The whole boundary of an obstacle is known."""
    LOSE = "lose"
    """An obstacle that is not acquired goes out of sight."""


ORDER = {kind: k for k, kind in enumerate(Kind)}


@dataclass(frozen=True, slots=True)
class Notice:
    """A report from a place of a leg (``u`` on its rail); ``note`` says why an obstacle was lost."""

    kind: Kind
    obstacle: int
    u: Real
    place: Point
    note: str = ""


@dataclass(frozen=True, slots=True)
class Share:
    """What a glance shows from a leg: where it is seen from, and which part of edge ``edge`` it shows."""

    source: Interval
    edge: int
    shown: Interval
    glance: Glance
    side: int


class Senses:
    """The sensor of a robot in one scene: what is known so far, and what is in sight.

    *radius* is positive and rational.
    """

    def __init__(self, table: EdgeTable, radius: fmpq) -> None:
        self.table, self.radius, self.square = table, radius, radius * radius
        self.sightlines = Sightlines(table, radius)
        self.rails = self.sightlines.ranges.rails
        self.covers: dict[int, Cover] = {}
        self.seen: set[int] = set()
        self.acquired: set[int] = set()
        self.in_sight: set[int] = set()
        self._views: dict[int, tuple[Point, dict[int, list[Interval]]]] = {}

    # -- moving ------------------------------------------------------------------------------------

    def look_around(self, place: Point) -> tuple[list[Notice], dict[int, Cover]]:
        """Take in the view from the start of the path; as `follow`."""
        view = self._view(place)
        learned = self._with_view({}, self.covers, view, range(len(self.table.obstacles)))
        notices = []
        for k in sorted({int(self.table.owner[e]) for e in view}):
            notices.append(Notice(Kind.SIGHT, k, Real(0), place))
            if self._is_whole(ChainMap(learned, self.covers), k):
                notices.append(Notice(Kind.ACQUIRE, k, Real(0), place))
        return self._settle(notices, learned)

    def follow(self, leg: Leg) -> tuple[list[Notice], dict[int, Cover]]:
        """Move along a leg: the reports in the order in which they come, and the covers that grew."""
        obstacles = self._near(leg) - self.acquired
        if not obstacles:
            return [], {}
        shares = self._shares(leg, obstacles)
        learned = self._taught(leg, self.covers, shares, obstacles)
        now = ChainMap(learned, self.covers)
        notices: list[Notice] = []
        for k in sorted(obstacles):
            whole = self._acquired(leg, k, shares[k]) if self._is_whole(now, k) else None
            for notice in self._changes(leg, k, shares[k]):
                if whole is None or leg.order(notice.u, whole.u) < (1 if notice.kind is Kind.SIGHT else 0):
                    notices.append(notice)
            if whole is not None:
                notices.append(whole)
        notices.sort(key=cmp_to_key(lambda a, b: leg.order(a.u, b.u) or ORDER[a.kind] - ORDER[b.kind]))
        return self._settle(notices, learned)

    def known_after(self, leg: Leg, covers: Covers) -> dict[int, Cover]:
        """The covers that grow along a leg, if *covers* are known before it."""
        obstacles = self._near(leg)
        return self._taught(leg, covers, self._shares(leg, obstacles), obstacles)

    def _settle(
        self, notices: list[Notice], learned: dict[int, Cover]
    ) -> tuple[list[Notice], dict[int, Cover]]:
        self.covers.update(learned)
        for notice in notices:
            if notice.kind is Kind.ACQUIRE:
                self.acquired.add(notice.obstacle)
                self.in_sight.discard(notice.obstacle)
            elif notice.kind is Kind.LOSE:
                self.in_sight.discard(notice.obstacle)
            else:
                self.seen.add(notice.obstacle)
                self.in_sight.add(notice.obstacle)
        return notices, learned

    def _near(self, leg: Leg) -> set[int]:
        """The obstacles with an edge whose box is within reach of the leg's."""
        x, y, right, top = leg.box
        edges = self.table.near((x, y), (right, top), self.sightlines.reach)
        return {int(k) for k in np.unique(self.table.owner[edges])}

    # -- what a leg shows --------------------------------------------------------------------------

    def _shares(self, leg: Leg, obstacles: set[int]) -> dict[int, list[Share]]:
        """The glances from a leg at some obstacles, cut to the leg."""
        found: dict[int, list[Share]] = {k: [] for k in obstacles}
        owner, ranges = self.table.owner, self._ranges(leg)
        for glance, side in self._glances(leg, obstacles):
            cut = ranges.clipped(glance, side, leg.span)
            if cut is not None:
                edge = glance.edges[1 - side]
                found[int(owner[edge])].append(_share(cut, side, edge))
        return found

    def _glances(self, leg: Leg, obstacles: set[int]) -> Iterator[tuple[Glance, int]]:
        owner, ranges = self.table.owner, self.sightlines.ranges
        if leg.edge is None:
            crossing = Crossing(self.sightlines, leg, lambda e: int(owner[e]) in obstacles, self._view)
            yield from ((glance, 0) for glance in crossing.glances())
            return
        for bundle, side in self.sightlines.on(leg.edge):
            if int(owner[bundle.edges[1 - side]]) in obstacles:
                for glance in bundle.glances(ranges):
                    yield glance, side

    def _ranges(self, leg: Leg) -> Ranges:
        ranges = self.sightlines.ranges
        return ranges if leg.edge is not None else ranges.with_way(leg.rail)

    def _taught(
        self, leg: Leg, covers: Covers, shares: Mapping[int, list[Share]], obstacles: set[int]
    ) -> dict[int, Cover]:
        """The covers that grow by what a leg shows of some obstacles."""
        learned: dict[int, Cover] = {}
        for k in obstacles:
            for share in sorted(shares[k], key=lambda share: _size(share.shown), reverse=True):
                _add(learned, covers, share.edge, share.shown)
        for place in (leg.start, leg.end):
            learned = self._with_view(learned, covers, self._view(place), obstacles)
        if leg.edge is not None and int(self.table.owner[leg.edge]) in obstacles:
            _add(learned, covers, leg.edge, leg.span)
        return learned

    def _with_view(
        self,
        learned: dict[int, Cover],
        covers: Covers,
        view: Mapping[int, list[Interval]],
        obstacles: set[int] | range,
    ) -> dict[int, Cover]:
        for e, intervals in view.items():
            if int(self.table.owner[e]) in obstacles:
                for interval in intervals:
                    _add(learned, covers, e, interval)
        return learned

    def _view(self, place: Point) -> dict[int, list[Interval]]:
        """What is seen from a place; the last views are kept, for legs share their ends."""
        kept = self._views.get(id(place))
        if kept is None:
            if len(self._views) >= VIEWS_KEPT:
                self._views.clear()
            seen = seen_from(self.table, place, self.radius)
            view = {
                e: [i for a, b in parts for i in Interval.between(self.rails[e], a, b)]
                for e, parts in seen.items()
            }
            kept = self._views[id(place)] = place, view
        return kept[1]

    def _is_whole(self, covers: Covers, k: int) -> bool:
        return all(covers.get(e, EMPTY).covers(self.rails[e].top) for e in self._edges(k))

    def _edges(self, k: int) -> range:
        first = int(self.table.first[k])
        return range(first, first + len(self.table.obstacles[k].edges))

    # -- reports -----------------------------------------------------------------------------------

    def _changes(self, leg: Leg, k: int, shares: list[Share]) -> Iterator[Notice]:
        """When an obstacle comes into sight and goes out of it; it is in sight over closed intervals."""
        times = self._times(leg, k, shares)
        in_sight, known = k in self.in_sight, k in self.seen
        for interval in times.intervals if leg.ahead else reversed(times.intervals):
            begin, end = (interval.low, interval.start), (interval.high, interval.end)
            if not leg.ahead:
                begin, end = end, begin
            if not in_sight:
                yield Notice(Kind.REGAIN if known else Kind.SIGHT, k, *begin)
                known = True
            in_sight = leg.order(end[0], leg.last) == 0
            if not in_sight:
                yield Notice(Kind.LOSE, k, *end, self._why(shares, end[0]))

    def _times(self, leg: Leg, k: int, shares: list[Share]) -> Cover:
        """When an obstacle is in sight along a leg, as a cover of the leg's rail."""
        if leg.edge is not None and int(self.table.owner[leg.edge]) == k:
            return Cover((leg.span,))
        times = Cover()
        for u, place in ((leg.span.low, leg.span.start), (leg.span.high, leg.span.end)):
            if any(int(self.table.owner[e]) == k for e in self._view(place)):
                times = times.added(Interval(u, place, u, place))
        for interval in sorted((share.source for share in shares), key=_size, reverse=True):
            times = times.added(interval)
        return times

    def _why(self, shares: list[Share], u: Real) -> str:
        """Out of range, if all last views were as long as the range; else occluded."""
        ends = [
            (end.places[share.side], end.points)
            for share in shares
            for end in (share.glance.first, share.glance.last)
        ]
        # Most often the very number was copied: no proof is needed that it is equal.
        ends.sort(key=lambda end: end[0] is not u)
        short = (
            distance_sq(*points).compare(self.square) < 0
            for place, points in ends
            if place is u or place.compare(u) == 0
        )
        return "occlusion" if any(short) else "range"

    def _acquired(self, leg: Leg, k: int, shares: list[Share]) -> Notice:
        """When an obstacle that is wholly known after a leg became so.

        What is known grows with closed sets, so the moment is one of finitely many candidates; between two of
        them a place with a rational parameter tells. The gaps at the start of the leg give a first guess;
        their ends may have moved meanwhile, so the gaps just before it are looked at again.
        """
        learned = self._with_view({}, self.covers, self._view(leg.start), {k})
        before = ChainMap(learned, self.covers)
        if self._is_whole(before, k):
            return Notice(Kind.ACQUIRE, k, leg.first, leg.start)
        _, around = self._closing(leg, leg, k, shares, before)
        late = self._until(leg.upto(around.first, around.start), k, shares, before)
        moment, _ = self._closing(leg, around, k, shares, late)
        return Notice(Kind.ACQUIRE, k, *moment)

    def _closing(
        self, leg: Leg, around: Leg, k: int, shares: list[Share], known: ChainMap[int, Cover]
    ) -> tuple[tuple[Real, Point], Leg]:
        """The first candidate on a part of a leg after which an obstacle is whole, and the way around it.

        *known* is what is known at the start of the part.
        """
        moments = self._moments(around, k, shares, known)
        before = ChainMap(self._with_view({}, self.covers, self._view(leg.start), {k}), self.covers)
        low, high = 0, len(moments) - 1
        begin, end = (around.first, around.start), (around.last, around.end)
        while low < high:
            middle = (low + high) // 2
            one, other = moments[middle][0], moments[middle + 1][0]
            u = rational_between(*((one, other) if leg.ahead else (other, one)))
            place = leg.rail.point(u)
            if self._is_whole(self._until(leg.upto(Real(u), place), k, shares, before), k):
                high, end = middle, (Real(u), place)
            else:
                low, begin = middle + 1, (Real(u), place)
        return moments[low], leg.between(begin, end)

    def _until(
        self, leg: Leg, k: int, shares: list[Share], before: ChainMap[int, Cover]
    ) -> ChainMap[int, Cover]:
        cut, ranges = [], self._ranges(leg)
        for share in shares:
            glance = ranges.clipped(share.glance, share.side, leg.span)
            if glance is not None:
                cut.append(_share(glance, share.side, share.edge))
        return ChainMap(self._taught(leg, before, {k: cut}, {k}), *before.maps)

    def _moments(self, leg: Leg, k: int, shares: list[Share], before: Covers) -> list[tuple[Real, Point]]:
        """The places of a leg, in its order, at one of which the last gap closes.

        There a glance begins or ends, or what it shows reaches the end of a gap, or the end of a gap comes
        into range, or the leg itself reaches it.
        """
        found: list[tuple[Real, Point]] = [(leg.first, leg.start), (leg.last, leg.end)]
        for share in shares:
            for end in (share.glance.first, share.glance.last):
                found.append((end.places[share.side], end.points[share.side]))
        for e in self._edges(k):
            on_edge = [share for share in shares if share.edge == e]
            for gap in before.get(e, EMPTY).gaps(self.rails[e]):
                for u, point in ((gap.low, gap.start), (gap.high, gap.end)):
                    found += self._reaching(leg, on_edge, u, point)
                    if e == leg.edge:
                        found.append((u, point))
        inside: list[tuple[Real, Point]] = [
            m for m in found if leg.order(m[0], leg.first) >= 0 and leg.order(m[0], leg.last) <= 0
        ]
        inside.sort(key=lambda moment: moment[0], reverse=not leg.ahead)
        return [m for k, m in enumerate(inside) if k == 0 or leg.order(m[0], inside[k - 1][0]) > 0]

    def _reaching(self, leg: Leg, shares: list[Share], u: Real, point: Point) -> Iterator[tuple[Real, Point]]:
        """Where glances on one edge show a point of it, and where the point comes into range."""
        single = Interval(u, point, u, point)
        for share in shares:
            glance = self._ranges(leg).clipped(share.glance, 1 - share.side, single)
            if glance is not None:
                yield glance.first.places[share.side], glance.first.points[share.side]
        east = Point(point.x + self.radius, point.y)
        for contact in contacts(leg.curve, Arc(east, east, point, self.square, ccw=True, full=True)):
            yield leg.rail.parameter(contact.start), contact.start


def _size(interval: Interval) -> float:
    """Rough size. Large intervals are added first: equal ends inside them need not be compared."""
    return float((interval.high - interval.low).ball(64).mid())


def _add(learned: dict[int, Cover], covers: Covers, e: int, interval: Interval) -> None:
    """Add an interval to the cover of an edge, in *learned* if it grows."""
    before = learned[e] if e in learned else covers.get(e, EMPTY)
    after = before.added(interval)
    if after is not before:
        learned[e] = after


def _share(glance: Glance, side: int, edge: int) -> Share:
    a, b = glance.first, glance.last
    source, shown = (
        Interval.of(a.places[k], a.points[k], b.places[k], b.points[k]) for k in (side, 1 - side)
    )
    return Share(source, edge, shown, glance, side)
