"""Shares: all that one leg shows of some obstacles, each glance with where on the leg it is seen from.

A leg is on a boundary edge, where the glances are kept by the scene's sightlines, or a straight way through
free space, which crosses them. The views from the two ends of the leg belong to what it shows.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from exactacq.points import Point
from exactacq.reals import Real
from exactacq.vision.crossing import Crossing
from exactacq.vision.glances import Glance, Ranges
from exactacq.vision.intervals import EMPTY, Cover, Interval
from exactacq.vision.legs import Leg
from exactacq.vision.sightlines import Sightlines

Covers: TypeAlias = "Mapping[int, Cover]"
"""What is known of each edge, by its number; nothing is known of an edge that is missing."""
View: TypeAlias = "Mapping[int, list[Interval]]"
"""What is seen from one place, by edge."""


@dataclass(frozen=True, slots=True)
class Share:
    """A glance of a leg: where it is seen from, and which part of edge ``edge`` it shows."""

    source: Interval
    edge: int
    shown: Interval
    glance: Glance
    side: int

    @classmethod
    def of(cls, glance: Glance, side: int) -> Share:
        """The share of a glance whose one side lies on the leg."""
        a, b = glance.first, glance.last
        source, shown = (
            Interval.of(a.places[k], a.points[k], b.places[k], b.points[k]) for k in (side, 1 - side)
        )
        return cls(source, glance.edges[1 - side], shown, glance, side)


class Shares:
    """What a leg shows of some obstacles. *view* gives what is seen from a point."""

    def __init__(
        self,
        sightlines: Sightlines,
        leg: Leg,
        obstacles: Collection[int],
        view: Callable[[Point], View],
        of: dict[int, list[Share]] | None = None,
    ) -> None:
        self.sightlines, self.leg, self.obstacles, self.view = sightlines, leg, obstacles, view
        self.owner = sightlines.table.owners
        self.of = self._found() if of is None else of

    def _found(self) -> dict[int, list[Share]]:
        found: dict[int, list[Share]] = {k: [] for k in self.obstacles}
        for glance, side in self._glances():
            cut = self._ranges.clipped(glance, side, self.leg.span)
            if cut is not None:
                found[self.owner[glance.edges[1 - side]]].append(Share.of(cut, side))
        return found

    def _glances(self) -> Iterator[tuple[Glance, int]]:
        sightlines, leg, owner, obstacles = self.sightlines, self.leg, self.owner, self.obstacles
        if leg.edge is None:
            crossing = Crossing(sightlines, leg, lambda e: owner[e] in obstacles, self.view)
            yield from ((glance, 0) for glance in crossing.glances())
            return
        for bundle, side in sightlines.on(leg.edge):
            if owner[bundle.edges[1 - side]] in obstacles:
                for glance in bundle.glances(sightlines.ranges):
                    yield glance, side

    @cached_property
    def _ranges(self) -> Ranges:
        ranges = self.sightlines.ranges
        return ranges if self.leg.edge is not None else ranges.with_way(self.leg.rail)

    def cut(self, leg: Leg, obstacles: Collection[int]) -> Shares:
        """What a part of the leg shows of some of the obstacles."""
        of = {
            k: [
                Share.of(cut, share.side)
                for share in self.of[k]
                if (cut := self._ranges.clipped(share.glance, share.side, leg.span)) is not None
            ]
            for k in obstacles
        }
        return Shares(self.sightlines, leg, obstacles, self.view, of)

    def taught(self, covers: Covers) -> dict[int, Cover]:
        """The covers that grow along the leg, if *covers* are known before it."""
        learned: dict[int, Cover] = {}
        leg = self.leg
        for shares in self.of.values():
            for share in sorted(shares, key=lambda share: size(share.shown), reverse=True):
                add(learned, covers, share.edge, share.shown)
        for place in (leg.start, leg.end):
            for e, intervals in self.view(place).items():
                if self.owner[e] in self.obstacles:
                    for interval in intervals:
                        add(learned, covers, e, interval)
        if leg.edge is not None and self.owner[leg.edge] in self.obstacles:
            add(learned, covers, leg.edge, leg.span)
        return learned

    def times(self, k: int, edge: int | None = None) -> Cover:
        """When an obstacle, or only one edge of it, is in sight, as a cover of the leg's rail."""
        span = self.leg.span
        edges = self.sightlines.table.edges_of(k) if edge is None else (edge,)
        if self.leg.edge in edges:
            return Cover((span,))
        times = Cover()
        for u, place in ((span.low, span.start), (span.high, span.end)):
            if any(e in edges for e in self.view(place)):
                times = times.added(Interval(u, place, u, place))
        sources = (share.source for share in self.of[k] if share.edge in edges)
        for interval in sorted(sources, key=size, reverse=True):
            times = times.added(interval)
        return times

    def is_short(self, k: int, u: Real) -> bool:
        """Whether some view of an obstacle that begins or ends at *u* is shorter than the range."""
        ends = [
            (end.places[share.side], end)
            for share in self.of[k]
            for end in (share.glance.first, share.glance.last)
        ]
        # Most often the very number was copied: no proof is needed that it is equal.
        ends.sort(key=lambda end: end[0] is not u)
        square = self.sightlines.ranges.square
        return any(end.is_short(square) for place, end in ends if place is u or place.compare(u) == 0)

    def reaching(self, e: int, u: Real, point: Point) -> Iterator[tuple[Real, Point]]:
        """Where glances show a point of edge *e*, whose parameter is *u*."""
        single = Interval(u, point, u, point)
        for share in self.of[self.owner[e]]:
            if share.edge == e:
                glance = self._ranges.clipped(share.glance, 1 - share.side, single)
                if glance is not None:
                    yield glance.first.places[share.side], glance.first.points[share.side]


def size(interval: Interval) -> float:
    """Rough size. Large intervals are added first: equal ends inside them need not be compared."""
    return float((interval.high - interval.low).ball(64).mid())


def add(learned: dict[int, Cover], covers: Covers, e: int, interval: Interval) -> None:
    """Add an interval to the cover of an edge, in *learned* if it grows."""
    before = learned[e] if e in learned else covers.get(e, EMPTY)
    after = before.added(interval)
    if after is not before:
        learned[e] = after
