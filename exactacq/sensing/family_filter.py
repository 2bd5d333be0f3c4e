"""Which of the families at a leg matter: most show what is known, from where more is seen anyway.

Floats with proven bounds tell (see `exactacq.kernel.choice`); what they leave open matters.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from math import inf

from flint import fmpq

from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.interval_union import EMPTY, Cover, Interval
from exactacq.geometry.late import unmade_point
from exactacq.geometry.points import Point
from exactacq.kernel.choice import LegSpan, mattering
from exactacq.kernel.extents import Extent, Span
from exactacq.numbers.real import Real
from exactacq.sensing.legs import Leg
from exactacq.sensing.line_images import bounds
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


class FamilyFilter:
    """Chooses the families of one leg that matter, for some obstacles; *known* is rounded inward.

    ``in_sight`` then has, for obstacles, intervals of the leg from which they are surely seen.
    """

    def __init__(
        self,
        leg: Leg,
        targets: Targets,
        obstacles: Collection[int],
        along: Collection[int],
        known: Mapping[int, Sequence[Span]],
    ) -> None:
        self.leg, self.targets, self.known = leg, targets, known
        self.obstacles, self.along = set(obstacles), set(along)
        self.in_sight: dict[int, list[Interval]] = {}

    def choose(self, extents: list[Extent]) -> list[Extent]:
        """Those that matter."""
        span, rail = self.leg.span, None if self.leg.edge is None else self.leg.rail
        part = LegSpan(bounds(span.low, rail), bounds(span.high, rail))
        owners, obstacles, ahead = self.targets.owners, self.obstacles, self.leg.ahead
        numbers, groups = mattering(extents, part, owners, obstacles, self.along, self.known, ahead)
        for k, first, last in groups:
            self.in_sight.setdefault(k, []).extend(self._interval(first, last))
        return [extents[n] for n in numbers]

    def _interval(self, first: Span, last: Span) -> Iterator[Interval]:
        """From inside one interval to inside another, which ends after it."""
        span = self.leg.span
        low, start = (span.low, span.start) if first[0] == -inf else self._place(first)
        high, end = (span.high, span.end) if last[1] == inf else self._place(last)
        if low.compare(high) < 0:
            yield Interval(low, start, high, end)

    def _place(self, span: Span) -> tuple[Real, Point]:
        """A place in an interval that has a finite end: the middle, if both are finite."""
        ends = [end for end in span if abs(end) < inf]
        u = fmpq(*(sum(ends) / len(ends)).as_integer_ratio())
        # A family begins before it or ends after it, so that nobody asks for the point.
        return Real(u), unmade_point(self.leg.rail.point, u)
