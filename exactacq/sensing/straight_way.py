"""A straight way through free space, with the facts from which the views along it are found."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from types import MappingProxyType
from typing import TypeAlias

from exactacq.cached import cached_property
from exactacq.geometry.constructions import (
    Carrier,
    is_normal,
    is_put_on,
    is_tangent,
    tangent_side,
    touch_on_tangent,
)
from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.late import Pin
from exactacq.geometry.points import Point
from exactacq.kernel.bounded import TINY, UNIT
from exactacq.kernel.ways import Crossing, WayImage, lines_at_ends
from exactacq.numbers.float_bounds import margin, rough
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import CONCAVE, EdgeTable
from exactacq.sensing.end_names import Seen, holds
from exactacq.sensing.legs import HaltPlace, Leg
from exactacq.sensing.line_family import rational_line
from exactacq.sensing.line_images import bounds
from exactacq.sensing.line_points import Role
from exactacq.sensing.view_families import FreeViews, LineView
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.visibility.line_names import Names
from exactacq.visibility.place_facts import Alignment, PlaceFacts, numbers_of_way

NOTHING_MET: Mapping[int, Point] = MappingProxyType({})
View: TypeAlias = "Callable[..., Seen]"
"""Gives what is seen from a point, given the edges through it, if these are known, and what else is known."""
OWN = -8
"""The name of a way's own line among those of its clipper: no number of a line (see `line_keys`)."""


class StraightWay:
    """A leg through free space. ``number`` is that of its rail for ``clipper``, ``line`` the rail's curve.

    ``touches`` has the numbers of the features that it is known to touch (see `line_keys`).
    """

    def __init__(self, complex_: VisibilityComplex, leg: Leg) -> None:
        self.complex, self.table, self.leg = complex_, complex_.table, leg
        assert isinstance(leg.rail.curve, Segment), "straight ways lie on lines"
        self.span, self.rail = leg.span, leg.rail
        self.line, self.spots = leg.rail.curve, leg.spots
        self.piece = Segment(leg.span.start, leg.span.end)
        self.touches: frozenset[int] = frozenset(leg.touches)
        self.touches |= {f for key in self.own_lines for f in self.table.line_numbers.features(key)}
        at_range = partial(_is_at_range, self.table, leg.halts) if leg.halts else None
        self.clipper = complex_.clipper.with_way(leg.rail, self.touches, at_range)
        for name, pin in leg.named.items():
            self.clipper.views.pins.put(name, pin)
        self.number = len(self.clipper.rails) - 1
        self._feet: dict[int, Pin] = {}
        self._through_centres: dict[int, bool] = {}
        self._name_lines_of_edges()
        if leg.touches:
            self._name_ends()

    def _name_lines_of_edges(self) -> None:
        """Name the ends that lie inside straight edges, as where the lines of these cross the way.

        Where an end is rational its numbers tell that.
        """
        numbers, following = self.table.line_numbers, self.table.following
        for end, u in self.ends:
            for e in self.table.edges_at(end) if end.rational is None else ():
                if not self.table.kinds[e]:
                    key = numbers.corners(e, following[e])
                    self.clipper.views.pins.put((key, self.number, 0), (end, u))

    def _name_ends(self) -> None:
        """Name the ends that lie on edges, as where the way's own line meets these.

        It enters an edge once; a concave arc it may leave in another place, but not towards the way.
        """
        for (end, _), outward in zip(self.ends, (-1, 1), strict=True):
            for e in self.table.edges_at(end):
                pin = end, self.clipper.rails[e].parameter(end)
                for sense in (outward,) if self.table.kinds[e] == CONCAVE else (1, -1):
                    self.clipper.views.pins.put((OWN, e, sense), pin)

    @property
    def ends(self) -> tuple[Pin, Pin]:
        """Its ends: points and parameters."""
        span = self.span
        return (span.start, span.low), (span.end, span.high)

    def seen_from(self, view: View, end: Point) -> Seen:
        """What is seen from an end of it; *view* makes views, or knows them."""
        return view_from_end(view, self.table, self.leg, end)

    def passes_centre(self, circle: int) -> bool:
        """Whether its line passes the centre of the circle of an arc, given as the first arc on it."""
        if circle not in self._through_centres:
            arc = self.table.curves[circle]
            assert isinstance(arc, Arc), "only arcs have circles"
            start, end = self.piece.start, self.piece.end
            passes = is_normal(start, end, arc.carrier) or (end - start).cross(arc.center - start).sign() == 0
            self._through_centres[circle] = passes
        return self._through_centres[circle]

    def own_names(self, direction: Point) -> Names:
        """The name of the way's own line, for lines in a direction along it or against it."""
        return ((OWN, direction.dot(self.line.direction).sign()),)

    def foot_on(self, circle: int) -> Pin:
        """Where the way's line touches a circle that it is known to touch: one point on all arcs."""
        pin = self._feet.get(circle)
        if pin is None:
            arc = self.table.arc_on(circle)
            # An end that was made on the circle is the foot: its numbers might take long to tell.
            pin = next((end for end in self.ends if is_put_on(end[0], arc.carrier)), None)
            if pin is None:
                (start, _), (end, _) = self.ends
                foot = touch_on_tangent(start, end, arc.carrier) or self.foot(arc.center)
                pin = foot, self.rail.parameter(foot)
            self._feet[circle], place = pin, pin[0]
            for e in self.table.on_circle_of(self.table.line_numbers.first_arc(circle)):
                if self.table.curves[e].contains(place):
                    on_arc = place, self.clipper.rails[e].parameter(place)
                    self.clipper.views.pins.put((OWN, e, 0), on_arc)
        return pin

    @cached_property
    def image(self) -> WayImage:
        """The way in floats."""
        (ax, ay), (bx, by) = ((rough(p.x), rough(p.y)) for p, _ in self.ends)
        error = margin(UNIT * (abs(ax) + abs(ay) + abs(bx) + abs(by)) + TINY)
        starts, stops = (self.table.vertices_at(end) for end, _ in self.ends)
        low, high = bounds(self.span.low, None), bounds(self.span.high, None)
        return WayImage(curve_image(self.line), low, high, (ax, ay, bx, by, error), starts, stops)

    def tell_lines_at_ends(self, found: list[Crossing]) -> None:
        """Tell the image which of the rational lines that bound some families pass an end of the way.

        Most often they touch the round obstacle there.
        """
        image, (start, stop) = self.image, (self.span.start, self.span.end)
        at_start, at_stop = start.rational is not None, stop.rational is not None
        for family, is_last, is_stop in lines_at_ends(found, image, at_start, at_stop):
            point, passing = (stop, image.lines_at_stop) if is_stop else (start, image.lines_at_start)
            at = rational_line(family, is_last)
            if at is not None and at[1].cross(point - at[0]).sign() == 0:
                keys = family.last_keys if is_last else family.first_keys
                passing.update(keys)
                if at[0] == point:
                    image.touching.update((key, family.edges[1]) for key in keys)

    def foot(self, point: Point) -> Point:
        """The place of its line that is nearest to a point."""
        start, along = self.line.start, self.line.direction
        return start + along * ((point - start).dot(along) / along.norm_sq())

    def is_tangent(self, circle: Carrier) -> bool:
        """Whether the way's line touches a circle."""
        if is_tangent(self.piece.start, self.piece.end, circle):
            return True
        along = self.line.direction
        height = along.cross(Point(circle.x, circle.y) - self.line.start)
        excess: Real = height * height - along.norm_sq() * circle.square
        return excess.sign() == 0

    @cached_property
    def own_lines(self) -> frozenset[int]:
        """Numbers of its own line (see `line_keys`), as far as a circle that it touches tells them.

        So does a ray from a halt at an end, if it touches what the way touches on the same side.
        """
        ends = self.piece.start, self.piece.end
        found = set(numbers_of_way(self.table, ends, self.touches))
        for halt in self.leg.halts:
            for other in ends if any(halt.place is end for end in ends) else ():
                for ray in halt.facts.rays:
                    if other is not halt.place and self._follows(ray, halt.place, other):
                        found |= ray.lines
        return frozenset(found)

    def _follows(self, ray: Alignment, place: Point, other: Point) -> bool:
        """Whether a ray from one end of the way touches what the way does on its way to the other end."""
        return any(
            not side or tangent_side(place, other, self.table.arc_on(feature).carrier) == side
            for feature, side in ray.touched
            if feature in self.touches
        )


def view_from_end(
    view: View, table: EdgeTable, leg: Leg, end: Point, own: tuple[int, ...] | None = None
) -> Seen:
    """What is seen from an end of a leg, with its edges if these are known; *view* makes or knows it."""
    return view(end, own, partial(facts_on_leg, view, table, leg, end))


def facts_on_leg(
    view: View, table: EdgeTable, leg: Leg, place: Point, met: Mapping[int, Point] = NOTHING_MET
) -> PlaceFacts:
    """What is known of the view from a place of a leg by the leg itself.

    What a straight way comes to beyond the place is in sight from its start, past what its line touches; or
    it is known where edges are *met* there.
    """
    if leg.edge is not None or not leg.touches or place is leg.start:
        return leg.facts(table, place)

    def beyond() -> Mapping[int, Point]:
        from_start = view_from_end(view, table, leg, leg.start)
        return {**met, **from_start.ahead(leg.touches, leg.end - leg.start)}

    return leg.facts(table, place, beyond)


def _is_at_range(table: EdgeTable, halts: Iterable[HaltPlace], free_views: FreeViews, view: LineView) -> bool:
    """Whether an extreme view of a family from where a robot halted is known to be as long as the range."""
    for halt in halts:
        for k, point in enumerate(view.points):
            if point is halt.place:
                facts, side, far = halt.facts, free_views.sides[1 - k], view.points[1 - k]
                if any(far is other for _, other in facts.rim):
                    return True
                if free_views.is_normal:
                    circle = table.line_numbers.circles[side.edge]
                    return side.role is Role.CONTACT and circle in facts.tangent
                return any(
                    hold in facts.holds for hold in holds(table, point, side.edge, far, free_views, view.t)
                )
    return False
