"""Which of the families at a leg have to be made exact.

Most show only what is known, of obstacles in sight without them. Floats with proven bounds tell which
(see `exactacq.kernel.choice`); where they leave it open, the family is made.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from math import inf
from typing import NamedTuple, TypeAlias

from flint import fmpq

from exactacq.cached import cached_property
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.interval_union import EMPTY, Cover, Interval
from exactacq.geometry.late import unmade_point
from exactacq.geometry.points import Point
from exactacq.kernel.choice import Source, mattering
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import EVERYTHING, Extent, Span
from exactacq.kernel.leg_spans import LegSpan
from exactacq.kernel.whole_edges import last_shown
from exactacq.numbers.real import Real
from exactacq.sensing.free_way import PinOf
from exactacq.sensing.legs import Leg, Place
from exactacq.sensing.line_images import bounds
from exactacq.sensing.targets import Targets

Family: TypeAlias = "tuple[object, int, int]"
"""Where a family comes from, and its two parts."""


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


class LastShown(NamedTuple):
    """Which of some edges may be the last to become known all over, and bounds of where on the leg that is.

    If ``along`` is given, it is the line of one of them: before the leg crosses it that edge is not known all
    over, and where it does the robot sees all of the edge along it.
    """

    edges: Collection[int]
    span: Span = EVERYTHING
    along: Extent | None = None


class FamilyFilter:
    """Chooses the families of one leg that matter, for some obstacles; *known* is rounded inward.

    ``in_sight`` then has, for obstacles, intervals of the leg from which they are surely seen. By edges that
    surely are known all over at its end, ``spared`` has the families that tell when what of them is shown.
    """

    def __init__(
        self,
        leg: Leg,
        targets: Targets,
        obstacles: Collection[int],
        along: Collection[int],
        known: Mapping[int, Sequence[Span]],
        at_end: Mapping[int, Sequence[Span]],
        facts: bool = False,
    ) -> None:
        self.leg, self.targets, self.known, self._facts = leg, targets, known, facts
        self.obstacles, self.along = set(obstacles), set(along)
        self.in_sight: dict[int, list[Interval]] = {}
        self.spared: dict[int, list[Extent]] = {}
        self.complete: list[int] = []
        self._at_end = at_end
        self._offered: list[Extent] = []

    def choose(self, extents: list[Extent], pin: PinOf) -> list[Extent]:
        """Those that matter; *pin* tells where the first or the last line of one meets the leg."""
        self._offered = extents
        part, owners, obstacles = self._part, self.targets.owners, self.obstacles
        numbers, groups, spared, complete = mattering(
            extents, part, owners, obstacles, self.along, self.known, self._at_end
        )
        if self._facts:
            numbers += [n for _, some in spared for n in some]
            spared = []
        else:
            self.complete = complete
        chosen = {_family(extents[n]): extents[n] for n in numbers}
        for k, first, last in groups:
            if first.is_alone:
                interval = self._single(first, chosen, pin)
            else:
                low, start = self._end(first, False, chosen, pin)
                high, end = self._end(last, True, chosen, pin)
                interval = Interval(low, start, high, end) if low.compare(high) <= 0 else None
            if interval is not None:
                self.in_sight.setdefault(k, []).append(interval)
        for e, some in spared:
            self.spared[e] = [one for n in some if _family(one := extents[n]) not in chosen]
        return list(chosen.values())

    def ending_at(self, u: Real) -> list[Extent]:
        """Those that may begin or end at a place of the leg, by floats."""
        low, high = bounds(u, None if self.leg.edge is None else self.leg.rail)
        found = []
        for one in self._offered:
            (first, last), (begin, end) = one.source, one.surely
            if first <= high and low <= last and (low <= begin or end <= high):
                found.append(one)
        return found

    @cached_property
    def _part(self) -> LegSpan:
        span, rail = self.leg.span, None if self.leg.edge is None else self.leg.rail
        return LegSpan(bounds(span.low, rail), bounds(span.high, rail), self.leg.ahead)

    def last_shown(self, edges: Collection[int], leg: CurveImage, curves: list[CurveImage]) -> LastShown:
        """Which of some edges that are known all over at the end of the leg may be the last to become so.

        The curve of the leg is given in floats, as those of the scene's edges.
        """
        if not edges:
            return LastShown(edges)
        offered = self._offered
        found, span, along = last_shown(list(edges), offered, self._part, self.known, leg, curves)
        return LastShown(found, span, None if along < 0 else offered[along])

    def _single(self, source: Source, chosen: dict[Family, Extent], pin: PinOf) -> Interval | None:
        """The place from which a single line shows something, unless it is *chosen* or beyond the leg."""
        one, span = source.extent, self.leg.span
        if not self._is_left(one, chosen):
            return None
        made = pin(one, False)
        if made is None or span.low.compare(made[1]) > 0 or span.high.compare(made[1]) < 0:
            return None
        point, u = made
        return Interval(u, point, u, point)

    def _end(self, source: Source, is_high: bool, chosen: dict[Family, Extent], pin: PinOf) -> Place:
        """The place of the leg where a family begins or ends; if it is *chosen*, a place inside will do."""
        one, span = source.extent, self.leg.span
        if is_high and source.surely[1] == inf:
            return span.high, span.end
        if not is_high and source.surely[0] == -inf:
            return span.low, span.start
        made = pin(one, is_high != one.is_turned) if self._is_left(one, chosen) else None
        if made is not None:
            return self._within(*made)
        chosen[_family(one)] = one
        return self._place(source.surely)

    def _is_left(self, one: Extent, chosen: dict[Family, Extent]) -> bool:
        """Whether a family that matters for where it begins or ends alone is not to be made."""
        if self._facts:
            chosen[_family(one)] = one
        return _family(one) not in chosen

    def _within(self, point: Point, u: Real) -> Place:
        """A place of the leg's curve, moved to the end of the leg if it lies there or beyond it."""
        leg, span = self.leg, self.leg.span
        # What lies on an edge lies between its ends; a way's line is crossed beyond these too.
        if leg.edge is None or not (span.low.rational == 0 and span.high is leg.rail.top):
            if u.compare(span.low) <= 0:
                return span.low, span.start
            if u.compare(span.high) >= 0:
                return span.high, span.end
        return u, point

    def _place(self, span: Span) -> Place:
        """A place in an interval that has a finite end: the middle, if both are finite."""
        ends = [end for end in span if abs(end) < inf]
        u = fmpq(*(sum(ends) / len(ends)).as_integer_ratio())
        # A family begins before it or ends after it, so that nobody asks for the point.
        return Real(u), unmade_point(self.leg.rail.point, u)


def _family(one: Extent) -> Family:
    """What the extents of one family, divided by the start of a full circle, have in common."""
    return one.origin, one.here, one.there
