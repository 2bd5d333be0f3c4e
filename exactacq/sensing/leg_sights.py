"""From where on a leg each edge is seen, and where that changes: in floats first, exactly where it is asked.

Every family at the leg is an interval of it, a `Sight`. Floats know nearly all of them, and the kernel tells
from them where something changes (`exactacq.kernel.leg_changes`). A family is made exact only if floats do
not know its ends, if two places that matter look the same, or if someone reads the place of a change.

The families are the tangents of features and the normals of edges, which sensing uses too, and the rays from
the ends of edges (`exactacq.visibility.end_rays`). Single lines count where the leg runs along them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import groupby, pairwise
from math import inf

from flint import arb

from exactacq.cached import cached_property
from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.interval_union import Interval
from exactacq.geometry.late import Pin, late_point
from exactacq.geometry.points import Point
from exactacq.grouping import in_groups
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import Extent, Span, by_source
from exactacq.kernel.family_images import NONE, FamilyImage
from exactacq.kernel.leg_changes import (
    AFTER,
    BEFORE,
    EITHER,
    AtEnd,
    LegChanges,
    Sight,
    Turn,
    name_of,
    normal_sights,
    sights,
)
from exactacq.kernel.leg_spans import LegSpan
from exactacq.numbers.between import rational_between
from exactacq.numbers.float_bounds import float_ball
from exactacq.numbers.real import Real
from exactacq.sensing.leg_views import Share
from exactacq.sensing.legs import Leg
from exactacq.sensing.line_family import family_of
from exactacq.sensing.line_images import bounds
from exactacq.sensing.line_points import Role
from exactacq.sensing.own_line import OwnLine, parameters
from exactacq.sensing.straight_way import StraightWay, View
from exactacq.sensing.view_families import LineView, ViewFamily
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.sensing.way_crossings import WayCrossings
from exactacq.sensing.way_normals import WayNormals
from exactacq.visibility.rotational_sweep import Pencil

BITS = 256
"""Precision of the balls that part a point from visible parts."""
WAY_KEYS = -(2**60)
"""From here down go keys of a way's own normals, to either side: below those of the scene's lines."""


class LegSights:
    """From where on one leg each edge is seen; obstacles count with their whole boundaries.

    *view* gives what is seen from a point, with the edges through it if these are known. *way* is a straight
    leg as a way, if it is there.
    """

    def __init__(
        self,
        complex_: VisibilityComplex,
        leg: Leg,
        view: View,
        way: StraightWay | None = None,
    ) -> None:
        self.complex, self.leg, self._given = complex_, leg, way
        self._view, self._clipper = view, complex_.clipper
        self._rail = None if leg.edge is None else leg.rail
        self._previous = complex_.table.preceding
        circles = complex_.table.line_numbers.circles
        self._scene = complex_.table.curve_images, self._previous, circles, complex_.images.reach
        self._span = LegSpan(bounds(leg.span.low, None), bounds(leg.span.high, None))
        self._made: dict[int, list[Share]] = {}
        self._sights = [*(self._on_way() if leg.edge is None else self._on_edge(leg.edge))]
        self._changes = self._changed()
        if found := [*self._on_line()]:
            self._sights += found
            self._changes = self._changed()

    def _changed(self) -> LegChanges:
        return LegChanges(self._sights, self._span, NONE if self.leg.edge is None else self.leg.edge)

    @cached_property
    def turns(self) -> list[Turn]:
        """The changes inside the leg."""
        changes = self._changes
        return changes.settle([self._parted(cluster) for cluster in changes.clusters()])

    def at_end(self, is_last: bool) -> dict[int, AtEnd]:
        """The edges in sight where the robot leaves the leg if *is_last*, else where it enters it.

        The leg's own edge is among them.
        """
        _ = self.turns  # Places are in order once changes are known.
        found = {one.edge: one for one in self._changes.at_end(is_last == self.leg.ahead)}
        if self.leg.edge is not None:
            found[self.leg.edge] = AtEnd(self.leg.edge, [], True, [])
        return found

    def is_near(self, seen: Turn | AtEnd) -> bool:
        """Whether a view of what comes or goes is shorter than the range."""
        return seen.is_short or any(self._is_short(end) for end in seen.unsure)

    def place(self, end: int) -> Pin:
        """The place of an end of a sight, or of the leg, by its number there; late where floats know it."""
        span, k = self.leg.span, end // 2
        if k == len(self._sights):
            return (span.end, span.high) if end % 2 else (span.start, span.low)
        low, high = self._changes.low[end], self._changes.high[end]
        if isinstance(self._sights[k].origin, Share) or not high - low < inf:
            return self.made(end)
        middle = 0.5 * (low + high)
        # Rounding moves the middle, and takes from the difference, by less than these together.
        u = arb(middle, 0.5 * (high - low) * (1.0 + 2.0**-50) + 2.0**-51 * abs(middle))
        around = self.leg.rail.around(u)
        if around is None:
            return self.made(end)
        late = _LateEnd(self, end)
        return late_point(around, late.point), Real.late(u, late.parameter)

    def _is_short(self, end: int) -> bool:
        """Whether a view of a sight from one of its ends is shorter than the range."""
        u = self.made(end)[1]
        return any(
            (v is u or v.compare(u) == 0) and extreme.is_short(self.complex.range)
            for share in self._shares(end // 2)
            for extreme in (share.family.first, share.family.last)
            for v in (extreme.places[share.side],)
        )

    def bounding(self, u: Real, place: Point) -> Iterator[Share]:
        """The views from a place strictly inside the leg that bound what is seen."""
        middle, error = float_ball(u)
        here = Interval(u, place, u, place)
        for k, sight in enumerate(self._sights):
            if sight.name == NONE or sight.low[0] > middle + error or sight.high[1] < middle - error:
                continue
            for share in self._shares(k):
                if share.source.low.compare(share.source.high) < 0:
                    view = self._clipper.clipped(share.family, share.side, here)
                    if view is not None:
                        yield share.cut(view)

    # -- finding the sights ------------------------------------------------------------------------

    def _on_edge(self, edge: int) -> Iterator[Sight]:
        complex_ = self.complex
        extents = complex_.sighting_extents(edge) + complex_.extents_of_rays(edge)
        yield from self._sights_in(extents, [], complex_.table.curve_images[edge])

    def _on_way(self) -> Iterator[Sight]:
        complex_, leg, way, wanted = self.complex, self.leg, self._way, self._near
        self._clipper = way.clipper
        near = complex_.sighting(way.spots) + complex_.rays(way.spots)
        images = [image for families in near for image in families.images]
        self._crossings = WayCrossings(way, [images], wanted)
        self._crossing = list(self._crossings)
        yield from self._sights_in(
            self._crossings.extents(), [image for image, _ in self._crossing], curve_image(leg.rail.curve)
        )
        self._normals = WayNormals(way, wanted, self._view)
        for k, (lines, normals) in enumerate(groupby(self._normals.images, lambda image: image.origin), 1):
            assert isinstance(lines, Pencil), "normals come from pencils"
            yield from self._along_normals(lines, [*normals], k * WAY_KEYS)

    @cached_property
    def _way(self) -> StraightWay:
        """The leg, if it is straight, as a way through free space."""
        return StraightWay(self.complex, replace(self.leg, edge=None)) if self._given is None else self._given

    @cached_property
    def _near(self) -> frozenset[int]:
        """The edges that may be seen from the leg."""
        return frozenset(self.complex.table.lit(self.leg.spots, self.complex.range.above))

    def _sights_in(
        self, extents: list[Extent], crossing: list[FamilyImage], curve: CurveImage
    ) -> Iterator[Sight]:
        """The sights that extents tell of, *crossing* as for `exactacq.kernel.leg_changes.sights`."""
        found, left = sights(by_source(extents), crossing, self._span, curve, self._scene)
        yield from found
        for one in left:
            yield from self._sights_of(self._shares_of(one), self._image(one))

    def _on_line(self) -> Iterator[Sight]:
        """What is seen along the leg's own line of edges that are not in sight all along without that.

        It counts where the view shows more than a point. Between places where the leg touches circles that is
        so everywhere or nowhere, for what lies beside the line on the way to what is seen is the same.
        """
        if not isinstance(self.leg.rail.curve, Segment):
            return
        wanted = {e for e in self._near if not self._changes.is_throughout(e)} - self._behind
        for family in OwnLine(self._way, frozenset(wanted), self._view).families():
            whole = Share.of(family, 0)
            for stretch in self._stretches:
                view = self._way.clipper.clipped(family, 0, stretch)
                share = whole if view is None else whole.cut(view)
                low, high = share.source.low, share.source.high
                if view is None or low.compare(high) == 0:
                    continue
                middle = self.leg.rail.point(rational_between(low, high))
                seen = self._view(middle, None if self.leg.edge is None else (self.leg.edge,)).spans
                if self._is_more(seen.get(share.edge, ()), share):
                    yield from self._sights_of([share], None)

    @cached_property
    def _stretches(self) -> list[Interval]:
        """The leg, divided where it touches circles."""
        table, span, stops = self.complex.table, self.leg.span, list[Pin]()
        for number in self.leg.touches:
            if table.line_numbers.is_circle(number):
                foot, u = self._way.foot_on(number)
                if span.low.compare(u) < 0 < span.high.compare(u):
                    stops.append((foot, u))
        stops.sort(key=lambda stop: stop[1])
        pins = [(span.start, span.low), *stops, (span.end, span.high)]
        return [Interval(u, p, v, q) for (p, u), (q, v) in pairwise(pins)]

    @property
    def _behind(self) -> set[int]:
        """The leg's own edge and those next to it that are straight and turn away from it."""
        e, table = self.leg.edge, self.complex.table
        if e is None:
            return set()
        beside = table.preceding[e], table.following[e]
        middle = self.leg.rail.point(rational_between(self.leg.span.low, self.leg.span.high))
        return {e, *(f for f in beside if _is_left_of(middle, table.curves[f]))}

    def _is_more(self, parts: Sequence[Interval], share: Share) -> bool:
        """Whether of an edge's visible parts that has length which contains what a share shows: a point.

        One contains it, as it is visible. Balls tell which may. Numbers, in other forms, are compared only if
        some of those have length and some have not.
        """
        places = parameters(self.complex.clipper.rails[share.edge], share.shown.low)
        may = [(part, v) for part in parts for v in places if _may_contain(part, v)]
        long = [(part, v) for part, v in may if part.low.compare(part.high) < 0]
        if len(long) in (0, len(may)):
            return bool(long)
        return any(part.low.compare(v) <= 0 <= part.high.compare(v) for part, v in long)

    def _along_normals(self, lines: Pencil, normals: list[FamilyImage], first_key: int) -> Iterator[Sight]:
        """The sights along the way's normals to one side."""
        curves, reach = self.complex.table.curve_images, self.complex.images.reach
        found, left = normal_sights(normals, len(lines.rows), curves, reach, first_key)
        yield from found
        for family in left:
            yield from self._sights_of(self._shares_along(family), None)

    def _shares_along(self, normals: FamilyImage) -> list[Share]:
        """What some normals of the way show."""
        return [Share.of(family, 0) for family in self._normals.views(normals)]

    # -- what is made exactly ----------------------------------------------------------------------

    def _image(self, one: Extent) -> FamilyImage | None:
        if isinstance(one.origin, int):
            return self._crossing[one.origin][0]
        return one.origin if isinstance(one.origin, FamilyImage) else None

    def _sights_of(self, shares: Iterable[Share], image: FamilyImage | None) -> Iterator[Sight]:
        for share in shares:
            family, source, edge, name = share.family, share.source, share.edge, NONE
            first, last = (self._keys_at(end, image) for end in (family.first, family.last))
            if source.low is not family.first.places[share.side]:
                first, last = last, first
            free_views = family.free_views
            if free_views is not None and free_views.anchor is not None:
                here, there = free_views.sides[share.side], free_views.sides[1 - share.side]
                name = name_of(free_views.anchor, there.role)
                if there.fixed and here.role is Role.BEHIND:
                    edge = self._previous[edge]
            low, high = self._bounds(source.low), self._bounds(source.high)
            yield Sight(edge, name, low, high, first, last, (EITHER, EITHER), share)

    def _bounds(self, u: Real) -> Span:
        span = self.leg.span
        return BEFORE if u is span.low else AFTER if u is span.high else bounds(u, self._rail)

    def _keys_at(self, end: LineView, image: FamilyImage | None) -> list[int]:
        """The keys of an extreme view's line, if it bounds its line family and the leg is straight."""
        if image is None or not isinstance(self.leg.rail.curve, Segment):
            return []
        line_family = family_of(image)
        if end.t is line_family.low:
            return image.first_keys
        return image.last_keys if end.t is line_family.high else []

    def _shares(self, k: int) -> list[Share]:
        """The families of a sight."""
        origin = self._sights[k].origin
        if isinstance(origin, Share):
            return [origin]
        if k not in self._made:
            if isinstance(origin, FamilyImage):
                self._made[k] = self._shares_along(origin)
            else:
                assert isinstance(origin, Extent), "sights come from families"
                self._made[k] = self._shares_of(origin)
        return self._made[k]

    def _shares_of(self, one: Extent) -> list[Share]:
        """What a family shows of an edge, from one part of it to another."""
        if not isinstance(one.origin, int):
            shares = (Share.of(family, side) for family, side in self.complex.views(one))
            return [share for share in shares if _is_part(share, one)]
        image, certain = self._crossing[one.origin]
        found = self._crossings.views(family_of(image), certain, frozenset({one.edge}))
        return [Share.of(family, 0) for family in found if _role(family) == one.there]

    # -- places ------------------------------------------------------------------------------------

    def _parted(self, cluster: list[int]) -> list[list[int]]:
        """Some places in their exact order, equal ones together."""
        places = [(end, self.made(end)[1]) for end in cluster]
        return [[end for end, _ in group] for group in in_groups(places, _by_place)]

    def made(self, end: int) -> Pin:
        """The place of an end, exactly."""
        if end // 2 == len(self._sights):
            return self.place(end)
        sources = [share.source for share in self._shares(end // 2)]
        if not sources:
            # The lines meet the leg in its end alone: nothing was made of them.
            span, is_first = self.leg.span, self._changes.low[end] <= self._span.low[1]
            return (span.start, span.low) if is_first else (span.end, span.high)
        if end % 2:
            last = max(sources, key=lambda source: source.high)
            return last.end, last.high
        first = min(sources, key=lambda source: source.low)
        return first.start, first.low


class _LateEnd:
    """A place that is made once, for its parameter and its point."""

    __slots__ = ("_end", "_pin", "_sights")

    def __init__(self, sights_: LegSights, end: int) -> None:
        self._sights, self._end = sights_, end
        self._pin: Pin | None = None

    def _made(self) -> Pin:
        if self._pin is None:
            self._pin = self._sights.made(self._end)
        return self._pin

    def point(self) -> Point:
        return self._made()[0]

    def parameter(self) -> Real:
        return self._made()[1]


def _by_place(a: tuple[int, Real], b: tuple[int, Real]) -> int:
    return a[1].compare(b[1])


def _is_left_of(place: Point, curve: Curve) -> bool:
    return isinstance(curve, Segment) and curve.direction.cross(place - curve.start).sign() > 0


def _may_contain(part: Interval, u: Real) -> bool:
    return (u - part.low).clear_sign(BITS) >= 0 and (part.high - u).clear_sign(BITS) >= 0


def _is_part(share: Share, one: Extent) -> bool:
    """Whether a share belongs to a part of a family on a full circle: other parts lie far away."""
    middle = 0.5 * (float_ball(share.source.low)[0] + float_ball(share.source.high)[0])
    return one.source[0] - 0.25 < middle < one.source[1] + 0.25


def _role(family: ViewFamily) -> int:
    """Where on its lines a family from a way shows something."""
    return 0 if family.free_views is None else int(family.free_views.sides[1].role)
