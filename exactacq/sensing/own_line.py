"""What is seen along a straight way itself: by single lines of sight, on its own line."""

from __future__ import annotations

from collections.abc import Iterator

from exactacq.cached import cached_property
from exactacq.geometry.constructions import is_past_corner
from exactacq.geometry.curve_images import held_point
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.interval_union import Cover
from exactacq.geometry.late import Pin, balls, may_be_one
from exactacq.geometry.points import Point
from exactacq.kernel.clearance import met, met_ahead
from exactacq.numbers.real import Real
from exactacq.sensing.end_names import Seen
from exactacq.sensing.straight_way import StraightWay, View
from exactacq.sensing.view_families import LineView, ViewFamily

BITS = 256
"""Precision of the balls that propose ties."""


class OwnLine:
    """The views along a way's own line; *view* tells what is seen from an end of it."""

    def __init__(self, way: StraightWay, wanted: frozenset[int], view: View) -> None:
        self.way, self.wanted, self.view = way, wanted, view
        self.table, self.line = way.table, way.line

    @cached_property
    def _near(self) -> list[int]:
        """The wanted edges that the way's line may meet."""
        start, along = held_point(self.line.start), held_point(self.line.direction)
        return met(self.table.images, [*self.wanted], start, along)

    def families(self) -> Iterator[ViewFamily]:
        """The views of the way's ends, of corners that it touches, and of what lies beyond."""
        if not self._near:
            return
        span, rails = self.way.span, self.way.clipper.rails
        shown = [(e, p) for p in (span.start, span.end) for e in self._view(p).own]
        along = self.line.direction
        shown += [*self._beyond(span.end, along), *self._beyond(span.start, -along)]
        for e, point in self._touched():
            # Its line may touch things beyond its ends too; those at an end are there already.
            u = self.way.rail.parameter(point)
            if _certainly(span.low, u) and _certainly(u, span.high):
                shown.append((e, point))
        for e, point in shown:
            if e in self.wanted:
                place = rails[e].parameter(point)
                ends = [LineView(Real(0), (p, point), (u, place)) for p, u in self._within(point)]
                if ends:
                    yield ViewFamily((self.way.number, e), ends[0], ends[-1])

    def _touched(self) -> Iterator[tuple[int, Point]]:
        """The corners and the tangent points of wanted edges on the way's line, named or not."""
        table, start, end, touches = self.table, self.line.start, self.line.end, self.way.touches
        numbers, along = table.line_numbers, self.line.direction
        for e in self._near:
            curve = table.curves[e]
            for number, corner in ((e, curve.start), (table.following[e], curve.end)):
                named = numbers.feature(number, False) in touches or is_past_corner(start, end, corner)
                if named or along.cross(corner - start).sign() == 0:
                    yield e, corner
            if isinstance(curve, Arc):
                circle = numbers.feature(e, True)
                named = circle in touches
                if named or (curve.carrier is not None and self.way.is_tangent(curve.carrier)):
                    foot = self.way.foot_on(circle)[0] if named else self.way.foot(curve.center)
                    if curve.contains(foot):
                        yield e, foot

    def _beyond(self, end: Point, onward: Point) -> Iterator[tuple[int, Point]]:
        """What the way's line meets beyond an end, as far as it is seen from there."""
        view = self._view(end)
        own = view.own
        edges = met_ahead(self.table.images, self._near, held_point(end), held_point(onward))
        # The line meets a straight edge through the end only there, unless it runs along it.
        edges = [e for e in edges if e not in own or self._leads_on(e, end, onward)]
        for e in edges:
            curve = self.table.curves[e]
            if e not in view.edges:
                continue
            if e in own and isinstance(curve, Segment):
                yield e, max((curve.start, curve.end), key=lambda p: (p - end).dot(onward))
                continue
            for point in self._as_seen(e, onward, [*self._met(e, end, onward, is_own=e in own)]):
                rail, seen = self.way.clipper.rails[e], Cover(tuple(view.spans[e]))
                if any(seen.contains(u) for u in parameters(rail, rail.parameter(point))):
                    yield e, point

    def _met(self, e: int, end: Point, onward: Point, is_own: bool) -> Iterator[Point]:
        """Where the way's line meets an edge beyond an end; *is_own* if the edge passes the end."""
        curve, circle = self.table.curves[e], self.table.line_numbers.feature(e, True)
        if isinstance(curve, Arc) and circle in self.way.touches:
            foot = self.way.foot_on(circle)[0]
            if foot is not end and (foot - end).dot(onward).sign() > 0 and curve.contains(foot):
                yield foot
            return
        for share in _again(end, onward, curve) if is_own else line_contacts(end, onward, curve):
            if share.sign() > 0:
                yield end + onward * share

    def _as_seen(self, e: int, onward: Point, met: list[Point]) -> list[Point]:
        """Where the way's line meets an edge beyond an end, as the views from both ends have these points.

        Past what the line touches ahead, or just there, a sight on the edge ends in one of them.
        """
        views = (self._view(end) for end, _ in self.way.ends)
        for known in (point for view in views for point in view.held_ahead(e, self.way.touches, onward)):
            near = [k for k, point in enumerate(met) if may_be_one(balls(point), balls(known))]
            if len(near) == 1:
                met[near[0]] = known
        return met

    def _leads_on(self, e: int, end: Point, onward: Point) -> bool:
        """Whether an edge through an end is an arc, or straight and along the line."""
        curve = self.table.curves[e]
        return isinstance(curve, Arc) or len(line_contacts(end, onward, curve)) == 2

    def _view(self, end: Point) -> Seen:
        """What is seen from an end of the way."""
        return self.way.seen_from(self.view, end)

    def _within(self, point: Point) -> list[Pin]:
        """The ends of the part of the way within range of a point of its line."""
        span, range_ = self.way.span, self.way.clipper.range
        ends = list(self.way.ends)
        far = [range_.order(p, point) > 0 for p, _ in ends]
        if not any(far):
            return ends
        along = self.line.direction
        step = along * (range_.radius / along.norm_sq().sqrt())
        for k, place in enumerate((point - step, point + step)):
            if far[k]:
                u = self.way.rail.parameter(place)
                if u.compare(span.low) < 0 or u.compare(span.high) > 0:
                    return []
                ends[k] = place, u
        return ends


def parameters(rail: Rail, u: Real) -> list[Real]:
    """The parameters of a place, of which one is given: a full circle's start has two, 0 and the top."""
    return [u, rail.top] if rail.is_closed and u.sign() == 0 else [u]


def _again(place: Point, along: Point, curve: Curve) -> list[Real]:
    """Where a line through a point of an arc meets it again inside the circle, in multiples of *along*.

    Outside a round obstacle it does not. Of the two places one is at 0, so their sum is the other.
    """
    if not isinstance(curve, Arc) or curve.ccw:
        return []
    share: Real = -2 * (place - curve.center).dot(along) / along.norm_sq()
    return [share] if share.sign() > 0 and curve.contains(place + along * share) else []


def _certainly(low: Real, high: Real) -> bool:
    """Whether balls tell that one number is less than another."""
    return (high - low).clear_sign(BITS) > 0
