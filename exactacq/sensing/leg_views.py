"""All that one leg shows of some obstacles.

A `Share` is a family of views together with the part of the leg from which it is seen. On a boundary edge the
families are those that the visibility complex keeps for the edge; on a straight way they are those that cross
it. The views from the two ends of the leg are added.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain
from typing import TypeAlias

from exactacq.cached import cached_property
from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.interval_union import EMPTY, Cover, Interval
from exactacq.geometry.late import balls
from exactacq.geometry.points import Point
from exactacq.kernel.extents import Extent, Span
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real
from exactacq.sensing.cut_ends import CutEnd
from exactacq.sensing.end_names import Seen
from exactacq.sensing.family_clipper import FamilyClipper
from exactacq.sensing.family_filter import FamilyFilter, LastShown
from exactacq.sensing.free_way import WayViews
from exactacq.sensing.legs import Leg, Place
from exactacq.sensing.named_pins import NamedPins
from exactacq.sensing.straight_way import StraightWay, View, view_from_end
from exactacq.sensing.targets import Targets
from exactacq.sensing.view_families import LineView, ViewFamily
from exactacq.sensing.visibility_complex import VisibilityComplex

Covers: TypeAlias = "Mapping[int, Cover]"
"""What is known of each edge, by its number; nothing is known of an edge that is missing."""
Families: TypeAlias = "Iterator[tuple[ViewFamily, int]]"
"""Families at a leg, and which of their sides lies on it."""


@dataclass(slots=True)
class Share:
    """A family of a leg: where it is seen from, and which part of edge ``edge`` it shows."""

    source: Interval
    edge: int
    shown: Interval
    family: ViewFamily
    side: int

    @classmethod
    def of(cls, family: ViewFamily, side: int) -> Share:
        """The share of a family whose one side lies on the leg."""
        there = 1 - side
        return cls(family.interval(side), family.edges[there], family.interval(there), family, side)

    def cut(self, family: ViewFamily) -> Share:
        """The share of a part of its family, whose sides run as its own do: nothing is to be compared."""
        first, a, b = self.family.first, family.first, family.last
        source, shown = (
            Interval(a.places[k], a.points[k], b.places[k], b.points[k])
            if whole.low is first.places[k]
            else Interval(b.places[k], b.points[k], a.places[k], a.points[k])
            for whole, k in ((self.source, self.side), (self.shown, 1 - self.side))
        )
        return Share(source, self.edge, shown, family, self.side)


class Shares:
    """What a leg shows of some obstacles.

    *view* gives what is seen from a point, with the edges through it if these are known. A given *way*
    shares its points by name. If *facts* are to be told of places where something changes (see
    `exactacq.sensing.leg_facts`), all families that end there are made.
    """

    def __init__(
        self,
        complex_: VisibilityComplex,
        targets: Targets,
        leg: Leg,
        obstacles: Collection[int],
        view: View,
        known: Mapping[int, Sequence[Span]] | None = None,
        of: dict[int, list[Share]] | None = None,
        ends: dict[int, list[tuple[CutEnd, Interval]]] | None = None,
        way: StraightWay | None = None,
        facts: bool = False,
    ) -> None:
        self.complex, self.targets, self.leg = complex_, targets, leg
        self._facts = facts
        self.obstacles, self.view = obstacles, view
        self.in_sight: Mapping[int, Sequence[Interval]] = {}
        self._pins: NamedPins | None = None
        self._way = way
        # The edges that are known all over at the end of the leg. And by edges the families that tell when
        # something is shown, as long as nobody asks, with what makes them and what chose them.
        self._shown_whole: Collection[int] = ()
        self._spared: dict[int, list[Extent]] = {}
        self._made: Callable[[Iterable[Extent]], Families] = partial(_made_on_edge, complex_)
        self._filter: FamilyFilter | None = None
        self.of = self._found(self._families(known)) if of is None else of
        self.ends = self._seen_ends() if ends is None else ends

    def _found(self, families: Families) -> dict[int, list[Share]]:
        """The shares of some families at the leg."""
        parts: list[tuple[int, ViewFamily, int, None]] = []
        for family, side in families:
            for k, target in self.targets.on(family.edges[1 - side]):
                if k in self.obstacles:
                    whole = target.whole
                    part = family if whole else self._clipper.clipped(family, 1 - side, target.span)
                    if part is not None:
                        parts.append((k, part, side, None))
        return self._shares(parts, self.leg, self.obstacles)

    def _shares(
        self,
        parts: Iterable[tuple[int, ViewFamily, int, Share | None]],
        leg: Leg,
        obstacles: Collection[int],
    ) -> dict[int, list[Share]]:
        """What of some families, or of their shares, is seen from a leg; views from its ends share points."""
        found: dict[int, list[Share]] = {k: [] for k in obstacles}
        begin, end = leg.first, leg.last
        for k, family, side, whole in parts:
            cut = self._clipper.clipped(family, side, leg.span)
            if cut is None:
                continue
            first, last = cut.first, cut.last
            if first.places[side] is begin or first.places[side] is end:
                first = self._pinned(first, cut, side, leg)
            if last.places[side] is begin or last.places[side] is end:
                last = self._pinned(last, cut, side, leg)
            is_cut = first is cut.first and last is cut.last
            part = cut if is_cut else ViewFamily(cut.edges, first, last, cut.free_views)
            found[k].append(Share.of(part, side) if whole is None else whole.cut(part))
        return found

    def _seen_ends(self) -> dict[int, list[tuple[CutEnd, Interval]]]:
        """From where the ends of obstacles are seen that are cut by a border."""
        cut_ends = self.targets.cut_ends
        return {
            k: [(end, part) for end in cut_ends[k] for part in end.along(self.leg)]
            for k in self.obstacles
            if k in cut_ends
        }

    def _pinned(self, end: LineView, family: ViewFamily, side: int, leg: Leg) -> LineView:
        """An extreme view that begins at an end of the leg, as what is seen from there has its other end."""
        u = end.places[side]
        if u is self.leg.first:
            view = self.end_views[0]
        elif u is self.leg.last:
            view = self.end_views[1]
        else:
            place = leg.start if u is leg.first else leg.end
            view = view_from_end(self.view, self.complex.table, leg, place, leg.own(u))
        return view.pinned(end, family, side)

    def _families(self, known: Mapping[int, Sequence[Span]] | None) -> Families:
        """The families at the leg; only those that matter if it is told what is *known*."""
        complex_, leg, obstacles = self.complex, self.leg, self.obstacles
        along = [k for k in obstacles if self._is_along(k)]
        chooser = None
        if known is not None:
            at_end = {} if self._facts else self.end_views[1].surely
            chooser = FamilyFilter(leg, self.targets, obstacles, along, known, at_end, self._facts)
        choose = None if chooser is None else chooser.choose
        # Facts are told of every place, and what is not chosen from is wanted all.
        every = known is None or self._facts
        if leg.edge is None:
            near = complex_.table.lit(leg.spots, complex_.range.above)
            edges = chain.from_iterable(self.targets.edges[k] for k in obstacles)
            way = StraightWay(complex_, leg) if self._way is None else self._way
            crossing = WayViews(way, frozenset(near).intersection(edges), self.view, every)
            self._pins = way.clipper.views.pins
            self._made = lambda extents: ((family, 0) for family in crossing.views(extents))
            yield from ((family, 0) for family in crossing.families(choose))
        else:
            extents = complex_.extents(leg.edge) if every else complex_.telling_extents(leg.edge)
            yield from self._made(extents if choose is None else choose(extents, complex_.pin))
        if chooser is not None:
            self.in_sight = chooser.in_sight
            self._spared, self._shown_whole = chooser.spared, chooser.complete
            self._filter = chooser

    def _make_spared(self, obstacles: Collection[int], edges: Collection[int] | None = None) -> None:
        """Make the families of some obstacles that were spared: when they show something is asked.

        Of some *edges*, if these are given.
        """
        on = self.targets.on
        asked = [e for e in self._spared if any(k in obstacles for k, _ in on(e))]
        if edges is not None:
            asked = [e for e in asked if e in edges]
        if asked:
            extents = [one for e in asked for one in self._spared.pop(e)]
            for k, shares in self._found(self._made(extents)).items():
                self.of[k] += shares

    def ending_at(self, u: Real) -> Shares:
        """This with the families that may begin or end at a place and were left out; see `families`."""
        if self._filter is None:
            return self
        of = self._found(self._made(self._filter.ending_at(u)))
        for k, shares in self.of.items():
            of[k] += shares
        return Shares(self.complex, self.targets, self.leg, self.obstacles, self.view, of=of, ends=self.ends)

    @cached_property
    def _clipper(self) -> FamilyClipper:
        clipper = self.complex.clipper
        return clipper if self.leg.edge is not None else clipper.with_way(self.leg.rail)

    def cut(self, leg: Leg, obstacles: Collection[int] | None = None) -> Shares:
        """What a part of the leg shows, of some of the obstacles if these are given."""
        obstacles = self.obstacles if obstacles is None else obstacles
        self._make_spared(obstacles)
        kept: dict[int, list[Share]] = {}
        parts: list[tuple[int, ViewFamily, int, Share]] = []
        for k in obstacles:
            for share in self.of[k]:
                inside = self._is_inside(share.source, leg.span)
                if inside:
                    kept.setdefault(k, []).append(share)
                elif inside is None:
                    parts.append((k, share.family, share.side, share))
        of = self._shares(parts, leg, obstacles)
        for k, shares in kept.items():
            of[k] += shares
        ends = {
            k: [(end, part) for end, whole in self.ends[k] if (part := whole.within(leg.span)) is not None]
            for k in obstacles
            if k in self.ends
        }
        return Shares(self.complex, self.targets, leg, obstacles, self.view, of=of, ends=ends)

    def last_shown(self, k: int, covers: Covers) -> LastShown:
        """Which edges of an obstacle that is whole at the end of the leg may be the last to become known.

        *covers* are known before the leg.
        """
        parts = [part for part in self.targets.of[k] if not part.is_in(covers.get(part.edge, EMPTY))]
        edges = [part.edge for part in parts]
        # Of a part of an edge no more than its end may be left, which is seen from behind too.
        if self._filter is None or not all(part.whole for part in parts):
            return LastShown(edges)
        curve = curve_image(self.leg.rail.curve)
        return self._filter.last_shown(edges, curve, self.complex.images.curves)

    def place_of(self, single: Extent) -> Place:
        """Where on the leg a single line meets it that surely shows something."""
        family, side = next(self._made([single]))
        return family.first.places[side], family.first.points[side]

    def teaching(self, k: int, covers: Covers, edges: Collection[int]) -> Shares:
        """What the leg shows of some edges of one obstacle without what shows only what *covers* contain."""
        self._make_spared({k}, edges)
        of = [share for share in self.of[k] if share.edge in edges and _is_new(share, covers)]
        ends = {k: self.ends[k]} if k in self.ends else {}
        return Shares(self.complex, self.targets, self.leg, {k}, self.view, of={k: of}, ends=ends)

    def _is_inside(self, source: Interval, part: Interval) -> bool | None:
        """Whether a part of the leg contains the source of a share: True, False if it contains nothing of it.

        None if the source is to be cut, or if it ends where the part does but the leg does not.
        """
        span, inside = self.leg.span, True
        if part.low is not span.low:
            if source.high.compare(part.low) < 0:
                return False
            inside = source.low.compare(part.low) > 0
        if part.high is not span.high:
            if source.low.compare(part.high) > 0:
                return False
            inside = inside and source.high.compare(part.high) < 0
        return inside or None

    def taught(
        self, covers: Covers, known: Mapping[int, Sequence[Span]] | None = None, is_here: bool = False
    ) -> dict[int, Cover]:
        """The covers that grow along the leg, if *covers* are known before it.

        *known* has them in floats, rounded inward: then less is to be made. *is_here* if they contain the
        view from the start.
        """
        learned = self.taught_between(covers)
        self.add_views_from_ends(learned, covers, known, is_here)
        return learned

    def taught_between(self, covers: Covers) -> dict[int, Cover]:
        """The covers that grow, perhaps by less where the views from the ends of the leg tell more."""
        leg, rails = self.leg, self.complex.clipper.rails
        learned = {e: Cover((Interval.whole(rails[e]),)) for e in self._shown_whole}
        for shares in self.of.values():
            for share in sorted(shares, key=lambda share: size(share.shown), reverse=True):
                add(learned, covers, share.edge, share.shown)
        for seen in self.ends.values():
            for end, _ in seen:
                add(learned, covers, end.edge, end.pin)
        if leg.edge is not None and self._along:
            add(learned, covers, leg.edge, leg.span)
        return learned

    def add_views_from_ends(
        self,
        learned: dict[int, Cover],
        covers: Covers,
        known: Mapping[int, Sequence[Span]] | None = None,
        is_here: bool = False,
    ) -> None:
        """Add to the covers that have grown what the views from the ends of the leg show; see `taught`."""
        for view in self.end_views:
            if is_here and view.place is self.leg.start:
                continue
            spans: Mapping[int, Sequence[Interval]] = view.spans
            if known is not None:
                edges = [e for e in view.edges if e not in self._shown_whole]
                spans = view.beyond(known, self.targets.counting(edges, self.obstacles))
            for _, (e, interval) in self.targets.within(self.obstacles, spans):
                add(learned, covers, e, interval)

    def _is_along(self, k: int) -> bool:
        """Whether the leg is on the boundary of an obstacle."""
        return k in self._along

    @cached_property
    def _along(self) -> frozenset[int]:
        """The obstacles on whose boundaries the leg is."""
        leg = self.leg
        if leg.edge is None:
            return frozenset()
        owners = self.targets.on(leg.edge)
        return frozenset(k for k, target in owners if k in self.obstacles and target.contains(leg.span))

    @cached_property
    def end_views(self) -> tuple[Seen, Seen]:
        """What is seen from the first and from the last place of the leg."""
        leg, table = self.leg, self.complex.table
        return (
            view_from_end(self.view, table, leg, leg.start, leg.own(leg.first)),
            view_from_end(self.view, table, leg, leg.end, leg.own(leg.last)),
        )

    def note(self, places: Iterable[Real]) -> None:
        """Keep the names of places of a straight way, of which something is reported."""
        if self._pins is not None:
            for u in places:
                self.leg.named.update(self._pins.at(u))

    def shown(self) -> set[int]:
        """The obstacles of which something may be in sight somewhere on the leg."""
        of = [k for k, shares in self.of.items() if shares]
        seen = self.targets.of_edges(e for view in self.end_views for e in view.edges)
        return {*of, *self.in_sight, *self.ends, *self._along, *seen.intersection(self.obstacles)}

    def is_in_sight(self, k: int) -> bool:
        """Whether an obstacle is surely in sight all along: no exact number is read."""
        span = self.leg.span
        if self._is_along(k):
            return True
        return any(i.low is span.low and i.high is span.high for i in self.in_sight.get(k, ()))

    def times(self, k: int) -> Cover:
        """When an obstacle is in sight, as a cover of the leg's rail."""
        leg = self.leg
        if self.is_in_sight(k):
            return Cover((leg.span,))
        times = EMPTY
        places = (leg.first, leg.start), (leg.last, leg.end)
        for (u, place), view in zip(places, self.end_views, strict=True):
            if self.targets.is_among(k, view.spans):
                times = times.added(Interval(u, place, u, place))
        sources = [share.source for share in self.of[k]]
        sources += self.in_sight.get(k, ())
        sources += [part for _, part in self.ends.get(k, ())]
        for interval in sorted(sources, key=size, reverse=True):
            times = times.added(interval)
        return times

    def is_short(self, k: int, u: Real) -> bool:
        """Whether a view of an obstacle that begins or ends at *u* is shorter than the range."""
        if self._is_surely_near(k, u) or self._is_near(k, u) or self._is_end_near(k, u):
            return True
        ends = [
            (end.places[share.side], end)
            for share in self.of[k]
            for end in (share.family.first, share.family.last)
        ]
        # Most often the very number was copied: no proof is needed that it is equal.
        ends.sort(key=lambda end: end[0] is not u)
        return any(
            end.is_short(self.complex.range) for place, end in ends if place is u or place.compare(u) == 0
        )

    def _is_surely_near(self, k: int, u: Real) -> bool:
        """Whether an interval from which an obstacle is seen within the range begins or ends at *u*."""
        ends = [v for interval in self.in_sight.get(k, ()) for v in (interval.low, interval.high)]
        return any(v is u for v in ends) or any(v.compare(u) == 0 for v in ends)

    def _is_end_near(self, k: int, u: Real) -> bool:
        """Whether a cut end is seen last or first from *u*, nearer than the range."""
        return any(
            (v is u or v.compare(u) == 0) and self.complex.range.order(place, end.point) < 0
            for end, part in self.ends.get(k, ())
            for v, place in ((part.low, part.start), (part.high, part.end))
        )

    def _is_near(self, k: int, u: Real) -> bool:
        """Whether *u* is an end of the leg from which something nearer than the range is seen."""
        leg = self.leg
        if u is not leg.first and u is not leg.last:
            return False
        view = self.end_views[0 if u is leg.first else 1]
        return any(
            self._is_nearer(view, e, point)
            for _, (e, interval) in self.targets.within({k}, view.spans)
            for point in self._samples(e, interval)
        )

    def _is_nearer(self, view: Seen, e: int, point: Point) -> bool:
        """Whether a point of an edge that a view shows is nearer than the range."""
        range_ = self.complex.range
        clear = range_.clear_order(balls(view.place), balls(point))
        return clear < 0 or (
            clear == 0 and not view.is_at_range(e, point) and range_.order(view.place, point) < 0
        )

    def _samples(self, e: int, interval: Interval) -> Iterator[Point]:
        """The ends of an interval and, lest both are at the range, a place between."""
        yield from (interval.start, interval.end)
        if interval.low.compare(interval.high) < 0:
            yield self._clipper.rails[e].point(rational_between(interval.low, interval.high))

    def reaching(self, k: int, e: int, u: Real, point: Point) -> Iterator[Share]:
        """The views that show a point of edge *e* of an obstacle, whose parameter is *u*."""
        single = Interval(u, point, u, point)
        for share in self.of[k]:
            if share.edge == e:
                family = self._clipper.clipped(share.family, 1 - share.side, single)
                if family is not None:
                    yield Share.of(family, share.side)


def _made_on_edge(complex_: VisibilityComplex, extents: Iterable[Extent]) -> Families:
    """The families at a boundary edge that extents tell of."""
    return chain.from_iterable(map(complex_.views, extents))


def size(interval: Interval) -> float:
    """Rough size. Large intervals are added first: equal ends inside them need not be compared."""
    return interval.high.rough() - interval.low.rough()


def _is_new(share: Share, covers: Covers) -> bool:
    """Whether a share shows more than covers contain."""
    known = covers.get(share.edge, EMPTY)
    return known.added(share.shown) is not known


def add(learned: dict[int, Cover], covers: Covers, e: int, interval: Interval) -> None:
    """Add an interval to the cover of an edge, in *learned* if it grows."""
    before = learned[e] if e in learned else covers.get(e, EMPTY)
    after = before.added(interval)
    if after is not before:
        learned[e] = after
