"""From where on a leg each edge is seen, and where that changes: in floats first, exactly where it is asked.

Every family at the leg is an interval of it, a `Sight`. Floats know nearly all of them, and the kernel tells
from them where something changes (`exactacq.kernel.leg_changes`). A family is made exact only if floats do
not know its ends, if two places that matter look the same, or if someone reads the place of a change.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cmp_to_key
from itertools import groupby, pairwise
from math import inf

from flint import arb

from exactacq.geometry.coordinates import dot, minus
from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Segment
from exactacq.geometry.interval_union import Interval
from exactacq.geometry.late import Pin, late_point
from exactacq.geometry.points import Point
from exactacq.kernel.choice import LegSpan
from exactacq.kernel.extents import Extent, Span
from exactacq.kernel.family_images import NONE, FamilyImage
from exactacq.kernel.leg_changes import (
    AFTER,
    BEFORE,
    BOTH_SHORT,
    EITHER,
    LegChanges,
    Sight,
    Spot,
    Turn,
    between,
    corner_normals,
    in_reach,
    name_of,
    normal_sights,
    sights,
)
from exactacq.kernel.line_keys import key_of_normal
from exactacq.kernel.lines import meets_straight
from exactacq.numbers.float_bounds import float_ball
from exactacq.numbers.real import Real
from exactacq.sensing.end_names import Seen
from exactacq.sensing.free_way import WayViews
from exactacq.sensing.leg_views import Share
from exactacq.sensing.legs import Leg
from exactacq.sensing.line_family import PencilFamilies, SingleLine, family_of
from exactacq.sensing.line_images import bounds
from exactacq.sensing.view_families import End, ViewFamily
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.visibility.rotational_sweep import Pencil

WAY_KEYS = -(2**60)
"""From here down go keys of a way's own normals, to either side: below those of the scene's lines."""


class LegSights:
    """All from where edges are seen on one leg, obstacles with their whole boundaries.

    *view* gives what is seen from a point, with the edges through it if these are known.
    """

    def __init__(
        self, complex_: VisibilityComplex, leg: Leg, view: Callable[[Point, tuple[int, ...] | None], Seen]
    ) -> None:
        self.complex, self.leg = complex_, leg
        self._view, self._clipper = view, complex_.clipper
        self._rail = None if leg.edge is None else leg.rail
        self._numbers = complex_.table.line_numbers
        self._scene = complex_.table.curve_images, self._numbers.circles, complex_.images.reach
        self._span = LegSpan(bounds(leg.span.low, None), bounds(leg.span.high, None))
        self._made: dict[int, list[Share]] = {}
        self._sights = [*(self._on_way() if leg.edge is None else self._on_edge(leg.edge))]
        self._changes = LegChanges(self._sights, self._span, NONE if leg.edge is None else leg.edge)

    def turns(self) -> list[Turn]:
        """The changes inside the leg."""
        changes = self._changes
        return changes.settle([self._parted(cluster) for cluster in changes.clusters()])

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

    def is_short(self, end: int) -> bool:
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
        curve = complex_.table.curve_images[edge]
        extents = complex_.extents(edge)
        also = self._normals_at(corner_normals(extents, []))
        found, left = sights(extents, [], self._span, curve, self._scene, also)
        yield from found
        for one in left:
            if isinstance(one.origin, SingleLine) and one.is_known:
                yield from self._single_on_edge(one, one.origin)
            else:
                yield from self._exactly(one)

    def _single_on_edge(self, one: Extent, single: SingleLine) -> Iterator[Sight]:
        """The sights of a single line from the leg's edge: from its place, or from the run that it shows."""
        reach, (near, far) = self.complex.images.reach, single.points
        place = _spot(single.place)
        at_near = in_reach(place, _spot(near), reach)
        if at_near < 0:
            return
        if one.here == 0 and at_near > 0:
            keys = self._keys(single)
            yield Sight(one.edge, NONE, one.source, one.source, keys, keys, BOTH_SHORT, one)
        elif one.here and self._is_whole(single) and in_reach(place, _spot(far), reach) > 0:
            yield Sight(one.edge, NONE, BEFORE, AFTER, [], [], BOTH_SHORT, one)
        else:
            yield from self._exactly(one)

    def _on_way(self) -> Iterator[Sight]:
        complex_, leg = self.complex, self.leg
        x, y, right, top = leg.box
        near = complex_.table.near((x, y), (right, top), complex_.range.above)
        self._way = way = WayViews(complex_, leg, frozenset(near.tolist()), self._view)
        self._clipper = way.way.clipper
        self._crossing = list(way.crossing)
        images = [image for image, _ in self._crossing]
        extents, curve = way.crossing.extents(), curve_image(leg.rail.curve)
        also = self._normals_at(corner_normals(extents, images))
        found, left = sights(extents, images, self._span, curve, self._scene, also)
        yield from found
        for one in left:
            yield from self._exactly(one)
        for one in way.single_lines():
            assert isinstance(one.origin, SingleLine), "extents of single lines tell of them"
            yield from self._single_on_way(one.origin)
        for family in way.own_line.families():
            yield from self._sights_of([Share.of(family, 0)], None)
        for k, (lines, normals) in enumerate(groupby(way.normals.images, lambda image: image.origin), 1):
            assert isinstance(lines, Pencil), "normals come from pencils"
            yield from self._along_normals(lines, [*normals], k * WAY_KEYS)

    def _normals_at(self, images: Iterable[FamilyImage]) -> dict[int, int]:
        """Second keys of normals of corners that are normals of the edges there too, by the first key."""
        found: dict[int, int] = {}
        table, count = self.complex.table, self._numbers.count
        for image in images:
            assert isinstance(image.origin, PencilFamilies), "families come from pencils"
            corner, lines = image.corner, image.origin.lines
            for row, bound, keys, edge, t in (
                (0, lines.rows[0].first, image.first_keys, int(table.previous[corner]), lines.sector.low),
                (len(lines.rows) - 1, lines.rows[-1].last, image.last_keys, corner, lines.sector.high),
            ):
                if image.number != row or lines.value(bound).rational != t or table.images.kind[edge]:
                    continue
                (x, y), along = (
                    lines.sector.base,
                    minus(table.vertices[int(table.next[edge])], table.vertices[edge]),
                )
                if dot((x - t * y, y + t * x), along) == 0:
                    found[keys[0]] = key_of_normal(edge, corner, count)
        return found

    def _along_normals(self, lines: Pencil, normals: list[FamilyImage], first_key: int) -> Iterator[Sight]:
        """The sights along the way's normals to one side."""
        curves, reach = self.complex.table.curve_images, self.complex.images.reach
        found, left = normal_sights(normals, len(lines.rows), curves, reach, first_key)
        yield from found
        for family in left:
            yield from self._sights_of(self._shares_along(family), None)

    def _shares_along(self, normals: FamilyImage) -> list[Share]:
        """What some normals of the way show."""
        return [Share.of(family, 0) for family in self._way.normals.views(normals)]

    def _single_on_way(self, single: SingleLine) -> Iterator[Sight]:
        """The sight of a single line where it crosses the way."""
        image = single.image(self.complex.images)
        _, _, u, error, *at, e = meets_straight(image.line, self._way.way.image.line)
        if error < inf:
            here = at[0], at[1], e
            crosses = between(image.place, image.near, here)
            reaches = in_reach(here, image.near, self.complex.images.reach)
            if crosses < 0 or reaches < 0 or u + error < self._span.low[0] or u - error > self._span.high[1]:
                return
            if crosses and reaches:
                keys, source = self._keys(single), (u - error, u + error)
                yield Sight(single.shown, NONE, source, source, keys, keys, BOTH_SHORT, single)
                return
        yield from self._sights_of([Share.of(f, 0) for f in self._way.along(single)], None)

    def _is_whole(self, single: SingleLine) -> bool:
        """Whether a single line shows a whole straight edge end on."""
        curve = self.complex.table.curves[single.shown]
        if not isinstance(curve, Segment):
            return False
        first, last = single.points
        return (first is curve.start and last is curve.end) or (first is curve.end and last is curve.start)

    def _keys(self, single: SingleLine) -> list[int]:
        """The number of a single line, if it runs along an edge."""
        if not self._is_whole(single) or self.complex.table.curve_images[self.leg.edge or 0].sense:
            return []
        e = single.shown
        return [self._numbers.corners(e, int(self.complex.table.next[e]))]

    # -- what is made exactly ----------------------------------------------------------------------

    def _exactly(self, one: Extent) -> Iterator[Sight]:
        """The sights of a family of which floats do not tell both ends."""
        image = self._image(one)
        yield from self._sights_of(self._shares_of(one), image)

    def _image(self, one: Extent) -> FamilyImage | None:
        if isinstance(one.origin, int):
            return self._crossing[one.origin][0]
        return one.origin if isinstance(one.origin, FamilyImage) else None

    def _sights_of(self, shares: Iterable[Share], image: FamilyImage | None) -> Iterator[Sight]:
        for share in shares:
            family, source, name = share.family, share.source, NONE
            first, last = (self._keys_at(end, image) for end in (family.first, family.last))
            if source.low is not family.first.places[share.side]:
                first, last = last, first
            free_views = family.free_views
            if free_views is not None and free_views.anchor is not None:
                name = name_of(free_views.anchor, free_views.sides[1 - share.side].role)
            low, high = self._bounds(source.low), self._bounds(source.high)
            yield Sight(share.edge, name, low, high, first, last, (EITHER, EITHER), share)

    def _bounds(self, u: Real) -> Span:
        span = self.leg.span
        return BEFORE if u is span.low else AFTER if u is span.high else bounds(u, self._rail)

    def _keys_at(self, end: End, image: FamilyImage | None) -> list[int]:
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
            if isinstance(origin, SingleLine):
                self._made[k] = [Share.of(family, 0) for family in self._way.along(origin)]
            elif isinstance(origin, FamilyImage):
                self._made[k] = self._shares_along(origin)
            else:
                assert isinstance(origin, Extent), "sights come from families"
                self._made[k] = self._shares_of(origin)
        return self._made[k]

    def _shares_of(self, one: Extent) -> list[Share]:
        """What a family shows of an edge, from one part of it to another."""
        if not isinstance(one.origin, int):
            return [Share.of(family, side) for family, side in self.complex.views(one)]
        image, certain = self._crossing[one.origin]
        found = self._way.crossing.views(family_of(image), certain, frozenset({one.edge}))
        return [Share.of(family, 0) for family in found if _role(family) == one.there]

    # -- places ------------------------------------------------------------------------------------

    def _parted(self, cluster: list[int]) -> list[list[int]]:
        """Some places in their exact order, equal ones together."""
        places = [(end, self.made(end)[1]) for end in cluster]
        places.sort(key=cmp_to_key(_by_place))
        parts = [[places[0][0]]]
        for (_, u), (end, v) in pairwise(places):
            if u.compare(v):
                parts.append([end])
            else:
                parts[-1].append(end)
        return parts

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


def _role(family: ViewFamily) -> int:
    """Where on its lines a family from a way shows something."""
    return 0 if family.free_views is None else int(family.free_views.sides[1].role)


def _spot(point: Point) -> Spot:
    (x, p), (y, q) = float_ball(point.x), float_ball(point.y)
    return x, y, max(p, q)
