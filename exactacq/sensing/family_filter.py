"""Which of the families at a leg matter: most show what is known, from where more is seen anyway.

A family matters if it may show anything new, or if where it is seen from may decide when an obstacle comes
into sight or goes out of it. Floats with proven bounds tell (see `line_images`); what they leave open
matters.
"""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterator, Mapping, Sequence
from itertools import chain
from math import inf
from operator import itemgetter
from typing import NamedTuple

import networkx as nx
from flint import fmpq

from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.interval_union import EMPTY, Cover, Interval
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.sensing.legs import Leg
from exactacq.sensing.line_images import NOTHING, Extent, Span, bounds
from exactacq.sensing.targets import Targets


def inside(cover: Cover, rail: Rail) -> list[Span]:
    """The intervals of a cover, rounded inward."""
    found = []
    for i in cover.intervals:
        low, high = bounds(i.low, rail)[1], bounds(i.high, rail)[0]
        if low <= high:
            found.append((low, high))
    return found


class KnownSpans(Mapping[int, Sequence[Span]]):
    """What covers contain of edges, by their numbers, rounded inward: made when it is asked for."""

    def __init__(self, covers: Mapping[int, Cover], rails: Sequence[Rail]) -> None:
        self._covers, self._rails = covers, rails
        self._spans: dict[int, list[Span]] = {}

    def __getitem__(self, e: int) -> Sequence[Span]:
        if e not in self._spans:
            self._spans[e] = inside(self._covers.get(e, EMPTY), self._rails[e])
        return self._spans[e]

    def __iter__(self) -> Iterator[int]:
        return iter(self._covers)

    def __len__(self) -> int:
        return len(self._covers)


class SourceSpan(NamedTuple):
    """Where a family of that number is seen from on the leg: at most and at least; names of both ends."""

    number: int
    outer: Span
    surely: Span
    names: tuple[Collection[Hashable], Collection[Hashable]]


class FamilyFilter:
    """Chooses the families of one leg that matter, for some obstacles; *known* is rounded inward."""

    def __init__(
        self,
        leg: Leg,
        targets: Targets,
        obstacles: Collection[int],
        along: Collection[int],
        known: Mapping[int, Sequence[Span]],
    ) -> None:
        self.targets, self.obstacles, self.along, self.known = targets, obstacles, along, known
        self.leg = leg
        self.in_sight: dict[int, list[Interval]] = {}
        span = leg.span
        rail = None if leg.edge is None else leg.rail
        self.low, self.high = bounds(span.low, rail), bounds(span.high, rail)

    def matter(self, seen: Sequence[Extent | None]) -> list[bool]:
        """Which of the families matter; None stands for one of which nothing is known, so it does.

        Then ``in_sight`` has, for obstacles, intervals from which they are surely seen.
        """
        chosen = [one is None for one in seen]
        sources: dict[int, list[SourceSpan]] = {}
        for n, one in enumerate(seen):
            if one is None:
                continue
            outer, surely = self._clipped(one)
            if outer[0] > outer[1]:
                continue
            new = not any(a <= one.shown[0] and one.shown[1] <= b for a, b in self.known.get(one.edge, ()))
            for k, target in self.targets.on(one.edge):
                if k in self.obstacles:
                    chosen[n] |= new
                    # What is seen from an end of the leg alone is part of the view from there.
                    if k not in self.along and outer[0] < inf and outer[1] > -inf:
                        if not target.whole:
                            surely = NOTHING
                        sources.setdefault(k, []).append(SourceSpan(n, outer, surely, one.names))
        for k, some in sources.items():
            groups = _joined([source for source in some if source.surely != NOTHING])
            spans = [(group[0].surely[0], max(source.surely[1] for source in group)) for group in groups]
            for source in some:
                if not any(a <= source.outer[0] and source.outer[1] <= b for a, b in spans):
                    chosen[source.number] = True
            self.in_sight[k] = [interval for group in groups for interval in self._interval(group)]
        return chosen

    def _interval(self, group: Sequence[SourceSpan]) -> Iterator[Interval]:
        """From inside the interval of a group that begins first to inside the one that ends last."""
        span = self.leg.span
        first, last = group[0].surely, max((source.surely for source in group), key=itemgetter(1))
        low, start = (span.low, span.start) if first[0] == -inf else self._place(first)
        high, end = (span.high, span.end) if last[1] == inf else self._place(last)
        if low.compare(high) < 0:
            yield Interval(low, start, high, end)

    def _place(self, span: Span) -> tuple[Real, Point]:
        """A place in an interval that has a finite end: the middle, if both are finite."""
        ends = [end for end in span if abs(end) < inf]
        u = fmpq(*(sum(ends) / len(ends)).as_integer_ratio())
        return Real(u), self.leg.rail.point(u)

    def _clipped(self, one: Extent) -> tuple[Span, Span]:
        """Where a family is seen from on the leg: at most and at least; the leg's ends are infinite."""
        (low, high), (first, last) = one.source, one.surely
        if high < self.low[0] or low > self.high[1]:
            return NOTHING, NOTHING
        if high == -inf or low == inf:
            return (low, high), NOTHING
        source = -inf if low <= self.low[1] else low, inf if high >= self.high[0] else high
        if first > last or last < self.low[1] or first > self.high[0]:
            return source, NOTHING
        return source, (-inf if first <= self.low[0] else first, inf if last >= self.high[1] else last)


def _joined(sources: list[SourceSpan]) -> list[list[SourceSpan]]:
    """Intervals in groups that are connected, since they overlap or an end of one is an end of another.

    Each group is in the order of its lower ends.
    """
    sources.sort(key=lambda one: one.surely)
    graph = nx.utils.UnionFind(range(len(sources)))
    at: dict[Hashable, int] = {}
    reached, last = -inf, 0
    for n, one in enumerate(sources):
        if n and one.surely[0] <= reached:
            graph.union(last, n)
        if one.surely[1] >= reached:
            reached, last = one.surely[1], n
        for name in chain(*one.names):
            graph.union(at.setdefault(name, n), n)
    return [[sources[n] for n in sorted(group)] for group in graph.to_sets()]
