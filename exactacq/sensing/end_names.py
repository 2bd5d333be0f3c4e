"""Names for the ends of views, by what determines them: equal ends are recognised without a proof.

From a given place, the point of an edge seen past a corner, or past a circle on its left or right, is one
point, whether it was computed by the view from that place or by a family of views that contains it. So is
the point of an edge at the distance of the range, in either direction along the edge.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from math import inf
from typing import Any

from exactacq.cached import cached_property
from exactacq.geometry.constructions import is_put_on
from exactacq.geometry.curve_images import held_point
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.interval_union import Interval
from exactacq.geometry.late import BITS as LATE_BITS
from exactacq.geometry.late import Pin, balls, from_to, may_be_one
from exactacq.geometry.points import Point
from exactacq.kernel.clearance import met_ahead
from exactacq.kernel.extents import Span
from exactacq.kernel.radial_sweep import Part
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.view_families import FreeViews, LineView, ViewFamily
from exactacq.visibility.line_balls import line
from exactacq.visibility.line_families import Sliding
from exactacq.visibility.place_facts import NOTHING_KNOWN, Hold, PlaceFacts
from exactacq.visibility.sensor_range import Range
from exactacq.visibility.visible_boundary import BoundaryView

RANGE = -1
"""In place of a feature's number."""
BITS = 128
"""Signs are read from balls of this precision, or not at all."""


class SeenSpans(Mapping[int, "list[Interval]"]):
    """The closed intervals that are seen of each edge, by its number; those of an edge are made when it is
    asked for."""

    def __init__(self, view: BoundaryView, rails: Sequence[Rail]) -> None:
        self._parts, self._ends, self._rails = view.seen_parts, view.ends, rails
        self._made: dict[tuple[int, Part], list[Interval]] = {}

    def __getitem__(self, e: int) -> list[Interval]:
        return self.intervals(e, self._parts[e])

    def ends_on(self, e: int) -> Iterator[tuple[int, Pin]]:
        """The ends of what is seen of an edge, by their numbers; a circle's start may stand for one."""
        for part in self._parts.get(e, ()):
            intervals = self._of(e, part)
            yield part[0], (intervals[0].start, intervals[0].low)
            yield part[1], (intervals[-1].end, intervals[-1].high)

    def __contains__(self, e: object) -> bool:
        return e in self._parts

    def __iter__(self) -> Iterator[int]:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)

    def intervals(self, e: int, parts: Iterable[Part]) -> list[Interval]:
        """Some parts of an edge, by the numbers of their ends, as intervals."""
        return [i for part in parts for i in self._of(e, part)]

    def _of(self, e: int, part: Part) -> list[Interval]:
        found = self._made.get((e, part))
        if found is None:
            found = Interval.between(self._rails[e], *self._ends.span(part))
            self._made[e, part] = found
        return found


class SureSpans(Mapping[int, "list[Span]"]):
    """What surely is seen of edges from a place, by floats, in extended numbers; nothing of full circles."""

    def __init__(self, view: BoundaryView, rails: Sequence[Rail]) -> None:
        self._view, self._rails = view, rails

    def __getitem__(self, e: int) -> list[Span]:
        if self._rails[e].is_closed:
            return []
        spans = (self._view.surely(e, part) for part in self._view.seen_parts[e])
        return [(low, high) for low, high in spans if low <= high]

    def get(self, e: int, default: Any = None) -> Any:
        """That of an edge; of most that are asked for nothing is seen, which is no error."""
        return self[e] if e in self._view.seen_parts else default

    def __iter__(self) -> Iterator[int]:
        return iter(self._view.seen_parts)

    def __len__(self) -> int:
        return len(self._view.seen_parts)


class Seen:
    """What is seen from a place.

    *own* are the edges through the place, if known, and *facts* what else is known of it.
    """

    def __init__(
        self,
        table: EdgeTable,
        rails: Sequence[Rail],
        place: Point,
        range_: Range,
        own: tuple[int, ...] | None,
        facts: PlaceFacts = NOTHING_KNOWN,
    ) -> None:
        self.table, self.place = table, place
        self._view = BoundaryView(table, place, range_, own, facts)
        self._rails, self._facts = rails, facts
        self._held: dict[int, dict[Hold, Pin]] = {}

    @property
    def own(self) -> tuple[int, ...]:
        """The edges through the place, at a vertex the incoming one first."""
        return self._view.own

    @cached_property
    def spans(self) -> SeenSpans:
        """What is seen of each edge."""
        return SeenSpans(self._view, self._rails)

    @property
    def edges(self) -> Collection[int]:
        """The edges of which something is seen."""
        return self._view.seen_parts

    @property
    def surely(self) -> SureSpans:
        """What surely is seen of edges, by floats."""
        return SureSpans(self._view, self._rails)

    def beyond(self, known: Mapping[int, Sequence[Span]], edges: Iterable[int]) -> dict[int, list[Interval]]:
        """Of `spans` of some edges those that *known* does not surely contain, by edge.

        *known* has intervals of edges, rounded inward (see `family_filter.KnownSpans`), whose ends are
        infinite where they are those of the edge. Floats decide, and only what is returned is made.
        """
        view, found = self._view, dict[int, list[Interval]]()
        for e in edges:
            parts, spans = view.seen_parts.get(e), known.get(e, ())
            if parts is None or (-inf, inf) in spans:
                continue
            new = parts
            if spans and not self._rails[e].is_closed:
                new = [part for part in parts if not _is_in(view.bracket(e, part), spans)]
            if new:
                found[e] = self.spans.intervals(e, new)
        return found

    def pinned(self, end: LineView, family: ViewFamily, side: int) -> LineView:
        """An extreme view of a family from this place, its other end the view's own point if it is one."""
        e, point = family.edges[1 - side], end.points[1 - side]
        for pin in self._pins(e, point, end, family.free_views):
            # A full circle's start has two parameters: a family over it keeps the one on its side.
            if not _apart(pin[1], end.places[1 - side]):
                here = end.points[side], end.places[side]
                (p, u), (q, v) = (here, pin) if side == 0 else (pin, here)
                return LineView(end.t, (p, q), (u, v), end.tight)
        return end

    def _pins(self, e: int, point: Point, end: LineView, free_views: FreeViews | None) -> Iterator[Pin]:
        """What a point of an edge that is seen along an extreme view may be."""
        if free_views is not None and self._is_here(e, point, end.t, free_views):
            yield self.place, self._rails[e].parameter(self.place)
        for hold in self._holds(e, point, end, free_views):
            if hold in self.held(e):
                yield self.held(e)[hold]

    def _is_here(self, e: int, point: Point, t: Real, free_views: FreeViews) -> bool:
        """Whether this place lies on an edge, and a line from it certainly meets the edge just here.

        It does if the point may be here, and cannot be where the line meets the edge's circle again.
        """
        if e not in self._view.own:
            return False
        here, there, curve = balls(self.place), balls(point), self.table.curves[e]
        if not may_be_one(here, there):
            return False
        *_, u, v = line(free_views.sector, t.ball(LATE_BITS))
        if isinstance(curve, Segment):
            x, y = balls(curve.direction)
            return ball_sign(u * y - v * x) != 0
        if free_views.anchor == self.table.line_numbers.feature(e, True):
            # The tangent of a circle in a point of it.
            return True
        (x, y), (cx, cy) = here, balls(curve.center)
        again = 2 * ((cx - x) * u + (cy - y) * v) / (u * u + v * v)
        return not may_be_one((x + u * again, y + v * again), there)

    def is_at_range(self, e: int, point: Point) -> bool:
        """Whether what is seen of an edge is known to end at the range in a point, that very object."""
        if any(point is other for _, other in self._facts.rim):
            return True
        return any(pin[0] is point and self._view.is_at_range(e, end) for end, pin in self.spans.ends_on(e))

    def ahead(self, features: Collection[int], onward: Point) -> dict[int, Point]:
        """Where a line from here that touches features meets edges ahead, by these; see `held_ahead`."""
        edges = met_ahead(self.table.images, [*self.edges], held_point(self.place), held_point(onward))
        return {e: point for e in edges for point in self.held_ahead(e, features, onward)}

    def held_ahead(self, e: int, features: Iterable[int], onward: Point) -> Iterator[Point]:
        """The end of a sight on an edge along a line that touches *features*, one of them ahead or here."""
        numbers, (u, v) = self.table.line_numbers, balls(onward)
        for feature in features:
            arc = self.table.arc_on(feature) if numbers.is_circle(feature) else None
            center = self.table.curves[feature].start if arc is None else arc.center
            x, y = from_to(balls(self.place), balls(center))
            is_here = arc is not None and is_put_on(self.place, arc.carrier)
            side = 0 if arc is None else ball_sign(u * y - v * x)
            if (is_here or ball_sign(u * x + v * y) > 0) and (side != 0) == (arc is not None):
                pin = self.held(e).get((e, feature, side))
                if pin is not None:
                    yield pin[0]

    def held(self, e: int) -> dict[Hold, Pin]:
        """The ends of what is seen of an edge, by what holds them."""
        if e not in self._held:
            self._held[e] = self._held_on(e)
            for ray in self._facts.rays:
                if e in ray.met:
                    pin = ray.met[e], self._rails[e].parameter(ray.met[e])
                    for touched in ray.touched:
                        self._held[e].setdefault((e, *touched), pin)
        return self._held[e]

    def _held_on(self, e: int) -> dict[Hold, Pin]:
        found: dict[Hold, Pin] = {}
        curve = self.table.curves[e]
        for end, pin in self.spans.ends_on(e):
            point = pin[0]
            if point is curve.start or point is curve.end:
                # A line through the corner may meet the edge again: there its name is another's.
                continue
            if self._view.is_at_range(e, end):
                found[e, RANGE, self._onward(e, point)] = pin
            found.update((hold, pin) for hold in self._view.holds(e, end))
        return {hold: pin for hold, pin in found.items() if hold[1] != RANGE or hold[2]}

    def _holds(self, e: int, point: Point, end: LineView, free_views: FreeViews | None) -> Iterator[Hold]:
        if end.tight:
            yield e, RANGE, self._onward(e, point)
        if free_views is not None:
            yield from holds(self.table, self.place, e, point, free_views, end.t)

    def _onward(self, e: int, point: Point) -> int:
        """1 or -1 as a point of an edge lies to one side or the other from here; 0 if balls do not tell."""
        curve = self.table.curves[e]
        if isinstance(curve, Arc):
            return _turn(self.place, curve, point)
        (x, y), (a, b), (u, v) = balls(point), balls(self.place), balls(curve.direction)
        clear = ball_sign((x - a) * u + (y - b) * v)
        return clear or (point - self.place).dot(curve.direction).clear_sign(BITS)


def holds(
    table: EdgeTable, place: Point, e: int, point: Point, free_views: FreeViews, t: Real
) -> Iterator[Hold]:
    """What holds a point of an edge that a family sees from a place along one of its lines, that at *t*."""
    numbers, feature = table.line_numbers, free_views.anchor
    if isinstance(free_views.sector, Sliding):
        touching = (circle for (circle, sign), u in free_views.sector.touching.items() if sign and u is t)
        feature = next((numbers.feature(circle, True) for circle in touching), None)
    if feature is None:
        return
    if numbers.is_circle(feature):
        yield e, feature, _turn(place, table.arc_on(feature), point)
    elif not any(one.fixed for one in free_views.sides):
        # Only past the corner: from there the lines of the family show different points.
        yield e, feature, 0


def _turn(place: Point, arc: Arc, point: Point) -> int:
    """1 or -1 as an arc's centre is to the left or right of the line from a place to a point; 0 if balls do
    not tell."""
    (x, y), (a, b), (u, v) = balls(point), balls(place), balls(arc.center)
    clear = ball_sign((x - a) * (v - b) - (y - b) * (u - a))
    return clear or (point - place).cross(arc.center - place).clear_sign(BITS)


def _is_in(bracket: Span, spans: Iterable[Span]) -> bool:
    """Whether a bracket lies in one of some intervals."""
    low, high = bracket
    return any(a <= low and high <= b for a, b in spans)


def _apart(a: Real, b: Real) -> bool:
    """Whether balls tell two parameters apart; those of late numbers are enough."""
    if a.is_late or b.is_late:
        return not a.ball(LATE_BITS).overlaps(b.ball(LATE_BITS))
    return (a - b).clear_sign(BITS) != 0
