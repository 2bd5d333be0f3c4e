"""Legs: the parts of a path, each with an exact parameter along it, rational wherever possible."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np

from exactacq.cached import cached_property
from exactacq.errors import FormatError
from exactacq.geometry.box_index import box
from exactacq.geometry.constructions import (
    is_past_corner,
    is_put_on,
    is_tangent,
    put_on_line,
    put_on_tangent,
    touch_on_tangent,
)
from exactacq.geometry.coordinates import cross
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import ContactKind, contacts
from exactacq.geometry.interval_union import Interval
from exactacq.geometry.late import Pin, balls, from_to
from exactacq.geometry.points import Point
from exactacq.kernel.shadows import Spot
from exactacq.numbers.between import rational_between, short_between
from exactacq.numbers.float_bounds import rough
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable, Floats, Ints, corners
from exactacq.sensing.named_pins import PinName
from exactacq.visibility.place_facts import NOTHING_KNOWN, Alignment, PlaceFacts, along_way

BITS = 256
"""Precision of the balls that tell which corners a way may touch, and which places are inside an edge."""
SOON = 6
"""How often the way to whatever happens next is halved to find a place just past a sighting."""

Place: TypeAlias = "tuple[Real, Point]"
"""A place of a leg: its parameter on the rail, and the point."""


class HaltPlace(NamedTuple):
    """A place where a robot halted, what is known of the view from there, and lines of sight that pass it.

    These come with the names under which a way is crossed by them.
    """

    place: Point
    facts: PlaceFacts
    lines: tuple[tuple[PinName, Alignment], ...]


@dataclass(frozen=True)
class Leg:
    """A part of a path along one rail: that of boundary edge ``edge``, or of a straight way if that is None.

    ``ahead`` tells whether the rail's parameter grows along the way; ``touches`` has the numbers of the
    features that the line of a straight way touches (see `line_keys`), ``beside`` the edges before and after
    the edge. ``halts`` are the ends at which a robot halted, with what is known of the view from there.
    """

    rail: Rail
    edge: int | None
    span: Interval
    ahead: bool
    touches: tuple[int, ...] = ()
    beside: tuple[int, int] | None = None
    halts: tuple[HaltPlace, ...] = ()

    @property
    def start(self) -> Point:
        """Where the leg begins."""
        return self.span.start if self.ahead else self.span.end

    @property
    def end(self) -> Point:
        """Where it ends."""
        return self.span.end if self.ahead else self.span.start

    @property
    def first(self) -> Real:
        """The parameter of the start."""
        return self.span.low if self.ahead else self.span.high

    @property
    def last(self) -> Real:
        """The parameter of the end."""
        return self.span.high if self.ahead else self.span.low

    @cached_property
    def curve(self) -> Curve:
        """The part of the rail's curve that the leg covers, in the curve's direction."""
        whole = self.span.low.sign() == 0 and self.span.high.compare(self.rail.top) == 0
        return self.rail.curve if whole else self.rail.curve.part(self.span.start, self.span.end)

    @cached_property
    def named(self) -> dict[PinName, Pin]:
        """Where named lines meet a straight way at places of which something was reported.

        Where the way is looked along once more they are the same points: their numbers may be of a degree at
        which nobody can prove that they are equal.
        """
        return {}

    def facts(
        self, table: EdgeTable, place: Point, met: Callable[[], Mapping[int, Point]] = dict
    ) -> PlaceFacts:
        """What is known of the view from a place: of a halt, and by what a straight way touches.

        Where that is met beyond the place, by edges, may be known.
        """
        halted = next((halt.facts for halt in self.halts if halt.place is place), NOTHING_KNOWN)
        if not self.touches:
            return halted
        assert isinstance(self.rail.curve, Segment), "only lines touch features"
        line, ends = self.rail.curve, (self.span.start, self.span.end)
        return halted.joined(PlaceFacts([*along_way(table, place, line, ends, self.touches, met())]))

    def tell_crossed(self, halt: HaltPlace) -> None:
        """Tell a straight way which lines it crosses at its start, where the robot halted; not its own."""
        along = from_to(balls(self.start), balls(self.end))
        for name, ray in halt.lines:
            if ball_sign(cross(balls(Point(*ray.direction)), along)):
                self.named[name] = halt.place, self.first

    def tell_touched(self, table: EdgeTable, place: Point) -> None:
        """Tell a place of a way through free space what is known of the line from its start to there."""
        if self.edge is not None or place is self.start or place is self.end:
            return
        put_on_line(place, self.start, self.end)
        for feature in self.touches:
            if table.line_numbers.is_circle(feature):
                arc = table.arc_on(feature)
                touch = touch_on_tangent(self.start, self.end, arc.carrier)
                put_on_tangent(place, self.start, arc.carrier, touch)

    @cached_property
    def box(self) -> tuple[float, float, float, float]:
        """A box that contains the leg."""
        return box(self.curve)

    @property
    def spots(self) -> tuple[Spot, ...]:
        """Places between which all of the leg lies."""
        if isinstance(self.rail.curve, Segment):
            return self.span.start.xy, self.span.end.xy
        return corners(self.box)

    def own(self, u: Real) -> tuple[int, ...] | None:
        """The edges through a place of the leg if they are known: inside its edge there is no other.

        At a vertex they are the incoming one and the outgoing one.
        """
        if self.edge is None or self.beside is None:
            return None
        if self.rail.is_closed:
            return (self.edge,)
        top, (before, after) = self.rail.top, self.beside
        if u is top:
            return self.edge, after
        if not u.is_late and u.rational == 0:
            return before, self.edge
        inside = u.clear_sign(BITS) > 0 and (top - u).clear_sign(BITS) > 0
        return (self.edge,) if inside else None

    def upto(self, u: Real, place: Point) -> Leg:
        """The leg as far as a place on it."""
        span = self.span
        cut = (span.low, span.start, u, place) if self.ahead else (u, place, span.high, span.end)
        return replace(self, span=Interval(*cut))

    def between(self, begin: Place, end: Place) -> Leg:
        """The part of the leg between two places, given as the robot passes them."""
        low, high = (begin, end) if self.ahead else (end, begin)
        return replace(self, span=Interval(*low, *high))

    def just_past(self, u: Real, after: Real) -> Point:
        """A place with short numbers early on the way from one parameter to a later one."""
        # Late numbers are not made: that may take longer than all else.
        near = after
        for _ in range(SOON):
            near = Real(rational_between(u, near) if self.ahead else rational_between(near, u))
        return self.rail.point(short_between(u, near) if self.ahead else short_between(near, u))

    def order(self, a: Real, b: Real) -> int:
        """-1, 0 or 1 as the robot passes one parameter before, at or after another."""
        return a.compare(b) if self.ahead else b.compare(a)


def legs_of(
    table: EdgeTable,
    rails: Sequence[Rail],
    obstacle: int | None,
    curve: Curve,
) -> list[Leg]:
    """The legs of a path piece, on the boundary of an obstacle or straight through free space if None.

    One leg; two if the piece passes the start of a full circle. A straight piece that runs along edges has a
    leg on each, and between them; it is cut at corners, from which it may see what it sees from nowhere else.
    """
    if obstacle is None:
        # The robots walk arcs only along boundaries; `load_run` refuses other pieces.
        assert isinstance(curve, Segment), "free space is crossed on straight lines"
        return [
            leg
            for e, part in _along_edges(table, curve)
            for leg in (_through_space(table, part) if e is None else [_on_edge(table, rails[e], e, part)])
        ]
    e = _edge_of(table, obstacle, curve)
    rail = rails[e]
    if isinstance(curve, Segment):
        return [_on_edge(table, rail, e, curve)]
    assert isinstance(rail.curve, Arc), "an arc is carried by an arc"
    ahead = curve.ccw == rail.curve.ccw
    start, end = (curve.start, curve.end) if ahead else (curve.end, curve.start)
    low, high, beside = rail.parameter(start), rail.parameter(end), _beside(table, e)
    if low.compare(high) < 0:
        return [Leg(rail, e, Interval(low, start, high, end), ahead, beside=beside)]
    seam = rail.curve.start
    spans = [Interval(low, start, rail.top, seam), Interval(Real(0), seam, high, end)]
    legs = [Leg(rail, e, span, ahead, beside=beside) for span in spans if span.low.compare(span.high) < 0]
    return legs if ahead else legs[::-1]


def parts_of(table: EdgeTable, way: Segment) -> list[tuple[int | None, Segment]]:
    """A straight way in parts: along edges, with their numbers, and free ones, with None, between corners."""
    return [
        (e, piece)
        for e, part in _along_edges(table, way)
        for piece in ([part] if e is not None else _between_corners(part, _corners_on(table, part)))
    ]


def _between_corners(way: Segment, corners: list[tuple[int, Point]]) -> list[Segment]:
    """A free way, cut at the corners that lie on it between its ends."""
    along, size = way.direction, way.direction.norm_sq()
    stops: list[tuple[Real, Point]] = []
    for _, corner in corners:
        place = (corner - way.start).dot(along)
        if place.sign() > 0 > place.compare(size):
            stops.append((place, corner))
    if not stops:
        return [way]
    stops.sort(key=lambda stop: stop[0])
    return [Segment(a, b) for a, b in pairwise([way.start, *(p for _, p in stops), way.end])]


def _corners_on(table: EdgeTable, way: Segment) -> list[tuple[int, Point]]:
    """The corners near a way that lie on its line, by number."""
    near = _near(table, way)
    near = near[~table.full[near]]
    numbers = np.unique(np.concatenate((near, table.next[near])))
    heights, slack = _heights(table, way, table.start[numbers])
    corners = [(n, table.curves[n].start) for n in numbers[np.abs(heights) <= slack].tolist()]
    start, end = way.start, way.end
    return [
        (n, p)
        for n, p in corners
        if is_past_corner(start, end, p) or _is_zero((end - start).cross(p - start))
    ]


def _circles_beside(table: EdgeTable, way: Segment) -> list[int]:
    """The circles of arcs near a way that its line touches, by the number of their first arc."""
    near = _near(table, way)
    near = near[table.kind[near] != 0]
    heights, slack = _heights(table, way, table.center[near])
    size = math.hypot(*_rough_direction(way))
    close = np.abs(np.abs(heights) - table.radius[near] * size) <= slack
    found: list[int] = []
    for number in dict.fromkeys(table.circles[e] for e in near[close].tolist()):
        arc = table.curves[number]
        assert isinstance(arc, Arc)
        if _touches(way, arc):
            found.append(number)
    return found


def _touches(way: Segment, arc: Arc) -> bool:
    """Whether the line of a way touches an arc's circle: in an end of the way if that was made on it."""
    if is_tangent(way.start, way.end, arc.carrier):
        return True
    for end in (way.start, way.end):
        if is_put_on(end, arc.carrier):
            return _is_zero(way.direction.dot(end - arc.center))
    height = way.direction.cross(arc.center - way.start)
    return _is_zero(height * height - way.direction.norm_sq() * arc.radius_sq)


def _near(table: EdgeTable, way: Segment) -> Ints:
    left, bottom, right, top = box(way)
    return table.near((left, bottom), (right, top), 0.0)


def _heights(table: EdgeTable, way: Segment, places: Floats) -> tuple[Floats, float]:
    """How far some places of the table are from a way's line, times the way's length, and the margin."""
    left, bottom, right, top = box(way)
    (x, y), (dx, dy) = way.start.xy, _rough_direction(way)
    offsets = places - (x, y)
    slack = 64 * table.roundoff_at((left, bottom), (right, top)) * math.hypot(dx, dy)
    return offsets[:, 0] * dy - offsets[:, 1] * dx, slack


def _rough_direction(way: Segment) -> tuple[float, float]:
    """A way's direction in floats that are off by round-off alone, however much cancels in its numbers."""
    dx, dy = way.direction
    return rough(dx), rough(dy)


def _is_zero(value: Real) -> bool:
    return bool(value.ball(BITS).contains(0)) and value.sign() == 0


def _along_edges(table: EdgeTable, way: Segment) -> list[tuple[int | None, Segment]]:
    """A straight way in parts: along edges, with their numbers, and other ones with None between."""
    left, bottom, right, top = box(way)
    dx, dy = _rough_direction(way)
    near = [e for e in table.around((left, bottom), (right, top), 0.0) if not table.kind[e]]
    edges, length = table.end[near] - table.start[near], math.hypot(dx, dy)
    sizes, slack = np.hypot(*edges.T), 16 * table.roundoff_at((left, bottom), (right, top))
    slopes = np.abs(edges[:, 0] * dy - edges[:, 1] * dx)
    parallel = slopes <= (1e-9 * sizes + slack) * (length + slack)
    found = [
        (e, contact)
        for e, is_parallel in zip(near, parallel, strict=True)
        if is_parallel
        for contact in contacts(way, table.curves[e])
        if contact.kind is ContactKind.OVERLAP
    ]
    found.sort(key=lambda f: (f[1].start - way.start).dot(way.direction))
    parts: list[tuple[int | None, Segment]] = []
    at = way.start
    for e, contact in found:
        if at != contact.start:
            parts.append((None, Segment(at, contact.start)))
        parts.append((e, Segment(contact.start, contact.end)))
        at = contact.end
    if at != way.end or not parts:
        parts.append((None, Segment(at, way.end) if parts else way))
    return parts


def _on_edge(table: EdgeTable, rail: Rail, e: int, piece: Segment) -> Leg:
    start, end, beside = piece.start, piece.end, _beside(table, e)
    low, high = rail.parameter(start), rail.parameter(end)
    if low.compare(high) < 0:
        return Leg(rail, e, Interval(low, start, high, end), True, beside=beside)
    return Leg(rail, e, Interval(high, end, low, start), False, beside=beside)


def _beside(table: EdgeTable, e: int) -> tuple[int, int]:
    """The edges before and after an edge."""
    return table.preceding[e], table.following[e]


def _through_space(table: EdgeTable, way: Segment) -> list[Leg]:
    """The legs of a free way, each on a rail with rational ends if its line is seen to be rational."""
    corners = _corners_on(table, way)
    touches = [table.line_numbers.feature(number, False) for number, _ in corners]
    touches += [table.line_numbers.feature(number, True) for number in _circles_beside(table, way)]
    touches += table.known_touched(way.start, way.end)
    legs = []
    for piece in _between_corners(way, corners):
        rail = Rail(_rational_carrier(piece) or piece)
        low, high = rail.parameter(piece.start), rail.parameter(piece.end)
        span = Interval(low, piece.start, high, piece.end)
        legs.append(Leg(rail, None, span, True, tuple(dict.fromkeys(touches))))
    return legs


def _edge_of(table: EdgeTable, obstacle: int, piece: Curve) -> int:
    """The edge of an obstacle that carries a piece of its boundary.

    A whole edge is known by its ends; else balls leave one or a few. `FormatError` if none does. Cost: that
    of finding the edges near one place, however many the boundary has.
    """
    start, edges = piece.start.xy, table.edges_of(obstacle)
    near: list[int] = [e for e in table.around(start, start, 0.0) if e in edges]
    for e in near:
        if _is_whole(table.curves[e], piece):
            return e
    near = [e for e in near if _may_carry(table.curves[e], piece)]
    found = near if len(near) == 1 else [e for e in near if _carries(table.curves[e], piece)]
    if not found:
        raise FormatError(f"no edge of the boundary carries {piece}")
    return found[0]


def _is_whole(edge: Curve, piece: Curve) -> bool:
    """Whether a piece is all of an edge, in one direction or the other, by the identity of its ends."""
    if edge is piece:
        return True
    ahead = piece.start is edge.start and piece.end is edge.end
    if not ahead and not (piece.start is edge.end and piece.end is edge.start):
        return False
    if isinstance(edge, Arc) and isinstance(piece, Arc):
        # On a full circle both directions have the same ends.
        alike = edge.full or (edge.ccw == piece.ccw) == ahead
        return alike and edge.full == piece.full and _is_same_circle(edge, piece)
    return isinstance(edge, Segment) and isinstance(piece, Segment)


def _may_carry(edge: Curve, piece: Curve) -> bool:
    """False only if an edge certainly does not carry a piece."""
    if isinstance(edge, Arc) != isinstance(piece, Arc):
        return False
    if isinstance(edge, Arc) and isinstance(piece, Arc) and not _is_same_circle(edge, piece):
        return False
    return all(edge.may_pass(p, BITS) for p in (piece.start, piece.end))


def _carries(edge: Curve, piece: Curve) -> bool:
    """Whether an edge carries all of a piece, which is no longer than a full turn.

    Two edges of one circle may share both ends of the piece: the one that carries it runs from the first
    to the second, in its own direction, without passing its start.
    """
    if not (edge.passes(piece.start) and edge.passes(piece.end)):
        return False
    if not (isinstance(edge, Arc) and isinstance(piece, Arc)):
        return True
    if piece.full or edge.full:
        return edge.full
    ends = (piece.start, piece.end) if piece.ccw == edge.ccw else (piece.end, piece.start)
    first, last = (Rail(edge).parameter(end) for end in ends)
    return first.compare(last) < 0


def _is_same_circle(a: Arc, b: Arc) -> bool:
    return a.radius_sq == b.radius_sq and a.center.rational == b.center.rational


def _rational_carrier(piece: Segment) -> Segment | None:
    """A segment with rational ends on the line of a piece that contains it, or None if none is seen."""
    (dx, dy), (x, y) = piece.direction, piece.start
    if piece.start.rational is not None and piece.end.rational is not None:
        return piece
    steep = abs(float(dy)) > abs(float(dx))
    if steep:
        dx, dy, x, y = dy, dx, y, x
    slope = Real(0) if dy.rational == 0 else dy.rational_ratio(dx)
    if slope is None:
        return None
    height = (y - x * slope).rational
    if height is None:
        return None
    ends = []
    for point, side in ((piece.start, -1), (piece.end, 1)):
        value = point.y if steep else point.x
        outward = side if float(dx) > 0 else -side
        low, high = value.enclosure(64)
        at = (high.ceil() if outward > 0 else low.floor()) + 0
        ends.append(Point(height + slope * at, at) if steep else Point(at, height + slope * at))
    return Segment(ends[0], ends[1])
