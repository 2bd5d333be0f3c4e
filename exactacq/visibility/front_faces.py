"""Front faces: the parts of the boundary that turn their free side to a point (faces in the code).

A ray from the point enters an obstacle only through a face, and meets each face once. Seen from the
point a face runs clockwise in the boundary's direction, since the obstacle lies on its left. A straight
edge is one face or none. An arc is divided where tangents from the point touch its circle: the near part
of a convex arc is a face, the far part of a concave one, and all of a concave one if the point is inside
the circle.

The ends of faces are *events*, numbered: below the number of edges they are vertices, from there on *marks*,
points that are no vertices (tangent points, the point itself). Floats decide what they can (see
`exactacq.kernel.radial_faces`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

from flint import arb, fmpq

from exactacq.geometry.constructions import put_on, put_on_tangent
from exactacq.geometry.coordinates import (
    Vector,
    advance,
    cross,
    dot,
    minus,
    raw,
    same_direction,
    sign,
    square_root,
)
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import spans
from exactacq.geometry.late import BITS, Balls, ball_of, balls, clearly_between, from_to, late_point
from exactacq.geometry.points import Point
from exactacq.kernel.bounded import TINY, UNIT, WIDEN
from exactacq.kernel.radial_faces import RadialFaces
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import is_spike
from exactacq.visibility.line_balls import LONG, long_vector
from exactacq.visibility.line_families import held
from exactacq.visibility.place_facts import (
    NOTHING_KNOWN,
    Alignment,
    PlaceFacts,
    Touched,
    along_edge,
    by_touched,
)
from exactacq.visibility.sensor_range import Range

NOWHERE = -1
"""The event where a full circle about the point begins and ends: there is none."""


class SweepEnd:
    """An event that is no vertex: its point, and the direction to it.

    It lies on arc ``edge``, to whose circle the direction is tangent; ``side`` is 1 if the circle is to the
    left, else -1. ``around`` are balls around the direction that `vector` gives exactly, and `long` in long
    balls. They and the point are found when one of them is first asked for.
    """

    __slots__ = ("_find", "_found", "edge", "long", "side", "vector")

    def __init__(
        self,
        find: Callable[[], tuple[Point, Balls]],
        vector: Callable[[], Vector],
        long: Callable[[], Balls],
        edge: int,
        side: int,
    ) -> None:
        self._find, self.vector, self.long = find, vector, long
        self._found: tuple[Point, Balls] | None = None
        self.edge, self.side = edge, side

    @property
    def point(self) -> Point:
        """Where the event lies."""
        return self._made[0]

    @property
    def around(self) -> Balls:
        """Balls around the direction."""
        return self._made[1]

    @property
    def _made(self) -> tuple[Point, Balls]:
        if self._found is None:
            self._found = self._find()
        return self._found


class _Touch:
    """Where the left (1) or right (-1) tangent from a point touches a circle; w leads to the centre.

    With h^2 the squared length of the tangent and g = h r the direction is h^2 w +- g left(w), which is |w|^2
    times as long as the way. Where the tangent is a known *ray*, it gives direction and point.
    """

    __slots__ = ("_vector", "arc", "around", "circle", "origin", "place", "ray", "side", "table")

    def __init__(
        self,
        table: EdgeTable,
        place: Point,
        origin: Vector,
        around: Balls,
        arc: Arc,
        side: int,
        circle: int,
        ray: Alignment | None,
    ) -> None:
        self.place, self.origin, self.around, self.arc, self.side = place, origin, around, arc, side
        self.table, self.circle, self.ray = table, circle, ray
        self._vector: Vector | None = None

    @property
    def _w(self) -> Vector:
        return minus(raw(self.arc.center), self.origin)

    def vector(self) -> Vector:
        """The exact direction."""
        if self.ray is not None:
            return self.ray.direction
        if self._vector is None:
            w, radius_sq = self._w, self.arc.radius_sq
            excess = dot(w, w) - radius_sq
            self._vector = _tangent(w, excess, square_root(excess * radius_sq) * self.side)
        return self._vector

    def found(self) -> tuple[Point, Balls]:
        """The point, made when it is looked into, and balls around the direction."""
        (x, y), center, radius_sq = self.around, balls(self.arc.center), arb(self.arc.radius_sq)
        w = center[0] - x, center[1] - y
        square = dot(w, w)
        excess = square - radius_sq
        u, v = _tangent(w, excess, (excess * radius_sq).sqrt() * self.side)
        touch = late_point((x + u / square, y + v / square), self._point)
        put_on(touch, self.arc.carrier)
        put_on_tangent(touch, self.place, self.arc.carrier)
        if self.ray is not None:
            self.ray.tell_line(self.table, touch, self.place)
        return touch, (u, v)

    def long(self) -> Balls:
        """Long balls around the direction."""
        if self.ray is not None:
            return long_vector(self.ray.direction)
        x, y = long_vector(self.origin)
        with workprec(LONG):
            cx, cy = raw(self.arc.center)
            w, radius_sq = (arb(cx) - x, arb(cy) - y), arb(self.arc.radius_sq)
            excess = dot(w, w) - radius_sq
            u, v = _tangent(w, excess, (excess * radius_sq).sqrt() * self.side)
        return u, v

    def _point(self) -> Point:
        if self.ray is not None:
            return self.ray.touch(self.circle, self.arc.center)
        w = self._w
        return advance(self.origin, self.vector(), 1 / dot(w, w))


def _tangent(w: Any, excess: Any, g: Any) -> Any:
    return w[0] * excess - w[1] * g, w[1] * excess + w[0] * g


@dataclass(frozen=True, slots=True)
class Cone:
    """The directions that lead from a boundary point into its obstacle: counterclockwise between events.

    The two are one event if all directions but that one do.
    """

    low: int
    high: int


class FrontFaces:
    """The faces within reach of one free point, with their events.

    ``floats`` are the faces as the sweep takes them. A face covers the directions counterclockwise from its
    low event to its high one, and runs from high to low. ``own`` are the edges through the point, at a vertex
    the incoming one first, found if not given; ``on_ray`` the other straight edges that the point sees
    edge-on; ``here`` are the events that are the point itself; numbers of events are less than ``count``.
    *facts* are what is known of the point beforehand.
    """

    def __init__(
        self,
        table: EdgeTable,
        point: Point,
        range_: Range,
        own: tuple[int, ...] | None,
        facts: PlaceFacts = NOTHING_KNOWN,
    ) -> None:
        self.table, self.point, self.range, self.facts = table, point, range_, facts
        self._rays = by_touched(facts.rays)
        self.origin = raw(point)
        self._marks: dict[int, SweepEnd] = {}
        self.here: list[int] = []
        self.on_ray: list[int] = []
        self.special: list[int] = []
        self._offsets: dict[int, Vector] = {}
        self.floats = faces = RadialFaces(table.images, _image(self.origin), held(range_.square))
        near = table.lit((point.xy,), range_.above)
        open_ = faces.add_straight(near)
        round_ = faces.add_arcs(faces.arcs(near)) if table.curved else []
        self.count = len(table.vertices) + 2 * len(faces.circles)
        if own is None:
            own = self._edges_at_point(open_, round_)
        self.own = own
        faces.own = list(own)
        if len(own) == 1 and point.rational is None and isinstance(table.curves[own[0]], Segment):
            # Those that were known tell more.
            self._rays = by_touched([*along_edge(table, point, own[0], near), *facts.rays])
        if open_:
            self._decide(open_)
        arcs: list[tuple[int, int, int]] = []
        for e in round_:
            if e not in own:
                arcs += self._arc(e)
        self.cone = self._cone(arcs) if own else None
        for e in self.on_ray:
            self.special += (e, table.following[e])
        for event in self.special:
            if event < len(table.vertices):
                faces.event(event)
        for e, low, high in arcs:
            faces.add_arc(e, low, high)

    @property
    def around(self) -> Balls:
        """Balls around the point."""
        return balls(self.point)

    def __len__(self) -> int:
        return len(self.floats.faces)

    def ends(self, face: int) -> tuple[int, int]:
        """The events in which a face begins and stops, counterclockwise, or NOWHERE."""
        found = self.floats.faces[face]
        if found.low is None or found.high is None:
            return NOWHERE, NOWHERE
        return found.low.number, found.high.number

    def _decide(self, edges: list[int]) -> None:
        """Add what straight edges show whose side floats leave open."""
        others = [e for e in edges if e not in self.own]
        for e, side in zip(others, self._sides(others), strict=True):
            if side < 0:
                self.floats.add_open(e)
            elif side == 0:
                self.on_ray.append(e)

    def _edges_at_point(self, open_: list[int], round_: list[int]) -> tuple[int, ...]:
        """The edges through the point, at a vertex the incoming one first.

        They are among the straight ones on whose line the point may be, and the arcs on whose circle it may
        be.
        """
        some = open_ + [e for e in round_ if not self.floats.beside(e)]
        return self.table.passing(some, self.point)

    def _sides(self, edges: list[int]) -> list[int]:
        """1 or -1 as straight edges turn left or right about the point, 0 if it is on their line; exact."""
        lattice = self.table.lattice
        if lattice is not None and len(self.own) == 2:
            # Two edges meet at the vertex at which the second one begins.
            return self.floats.sides(edges, lattice[1], self.own[1])
        return [sign(cross(self.offset(e), self.offset(self.table.following[e]))) for e in edges]

    # -- events ------------------------------------------------------------------------------------

    def offset(self, event: int) -> Vector:
        """The exact vector from the point to an event, or some positive multiple of it."""
        known = self._offsets.get(event)
        if known is None:
            vertices = self.table.vertices
            if event >= len(vertices):
                known = self.mark(event).vector()
            elif (ray := self._rays.get((event, 0))) is not None:
                known = ray.direction
            else:
                known = minus(vertices[event], self.origin)
            self._offsets[event] = known
        return known

    def late_offset(self, event: int) -> tuple[Balls, Callable[[], Vector]]:
        """Balls around that vector, and what makes it."""
        vertices = self.table.vertices
        known = self._offsets.get(event)
        if known is not None:
            return (ball_of(known[0]), ball_of(known[1])), lambda: known
        if event < len(vertices):
            x, y = balls(self.table.curves[event].start)
            return (x - self.around[0], y - self.around[1]), partial(minus, vertices[event], self.origin)
        mark = self.mark(event)
        return mark.around, mark.vector

    def long_offset(self, event: int) -> Balls:
        """Long balls around that vector."""
        if event in self._offsets or event < len(self.table.vertices):
            return long_vector(self.offset(event))
        return self.mark(event).long()

    @property
    def has_rays(self) -> bool:
        """Whether any ray is known."""
        return bool(self._rays)

    def ray(self, events: Iterable[int]) -> Alignment | None:
        """The known ray that touches one of some events, or None."""
        if not self._rays:
            return None
        found = (self._rays.get(self.touched(event)) for event in events)
        return next((ray for ray in found if ray is not None), None)

    def is_one_ray(self, a: int, b: int) -> bool:
        """Whether two events are known to lie on one ray."""
        ray = self.ray((a,))
        return ray is not None and ray is self.ray((b,))

    def touched(self, event: int) -> Touched:
        """What a ray to an event touches."""
        if event < len(self.table.vertices):
            return event, 0
        mark = self.mark(event)
        return self.table.line_numbers.feature(mark.edge, True), mark.side

    def place(self, event: int) -> Point:
        """The point where an event lies."""
        starts = self.table.starts
        return starts[event] if event < len(starts) else self.mark(event).point

    def mark(self, event: int) -> SweepEnd:
        """An event that is no vertex; a tangent of a round obstacle is made when it is first asked for."""
        made = self._marks.get(event)
        if made is None:
            k = event - len(self.table.vertices)
            made = self._marks[event] = self._touching(self.floats.circles[k // 2], 1 - 2 * (k % 2))
        return made

    def _add_mark(self, mark: SweepEnd, image: tuple[float, float, float]) -> int:
        event, self.count = self.count, self.count + 1
        self._marks[event] = mark
        self.floats.add_event(event, *image)
        return event

    # -- arcs --------------------------------------------------------------------------------------

    def _arc(self, e: int) -> list[tuple[int, int, int]]:
        """The faces (edge, low, high) of an arc that does not pass through the point, in its direction."""
        table, arc = self.table, self.table.curves[e]
        assert isinstance(arc, Arc)
        is_tangent = table.line_numbers.circles[e] in self.facts.tangent
        if not is_tangent and (self.floats.reaches(e) or self._reaches(arc)) < 0:
            return []
        end = table.following[e]
        # If an own edge is another arc of the same circle, the point is on it.
        outside = -1 if any(table.circles.get(own) == table.circles[e] for own in self.own) else 0
        if (outside or self.floats.beside(e) or self._is_outside(arc)) <= 0:
            whole = NOWHERE if arc.full else e
            return [] if arc.ccw else [(e, NOWHERE if arc.full else end, whole)]
        if arc.full:
            enter, leave = self._tangent(e, 1), self._tangent(e, -1)
            return [(e, leave, enter)]
        w = minus(raw(arc.center), self.origin)
        away = (-w[0], -w[1])
        front, back = (away, w) if arc.ccw else (w, away)
        first, last = (self._facing(arc, w, p) for p in (arc.start, arc.end))
        if first and last:
            if not self._spans(arc, back):
                return [(e, end, e)]
        elif not (first or last) and not self._spans(arc, front):
            return []
        # From the left tangent point to the right one: clockwise as seen from the point. A tangent that ends
        # no face is not made: it may touch the circle just where the arc ends.
        if first and last:
            return [(e, self._tangent(e, -1), e), (e, end, self._tangent(e, 1))]
        return [(e, end if last else self._tangent(e, -1), e if first else self._tangent(e, 1))]

    def _reaches(self, arc: Arc) -> int:
        """1, 0 or -1 as an arc's circle comes nearer than the range, as near, or not."""
        gap = square_root(self._distance_sq(arc)) - arc.radius
        return -abs(gap).compare(self.range.radius)

    def _is_outside(self, arc: Arc) -> int:
        """1, 0 or -1 as the point is outside an arc's circle, on it, or inside."""
        return sign(self._distance_sq(arc) - arc.radius_sq)

    def _distance_sq(self, arc: Arc) -> Any:
        """The squared distance of the point from an arc's centre: by name if it is on a concentric arc."""
        for e in self.own:
            own = self.table.curves[e]
            if isinstance(own, Arc) and own.center == arc.center:
                return own.radius_sq
        w = minus(raw(arc.center), self.origin)
        return dot(w, w)

    def _facing(self, arc: Arc, w: Vector, end: Point) -> bool:
        """Whether the boundary near an end of the arc, on the arc, turns its free side to the point."""
        center = balls(arc.center)
        beyond = ball_sign(dot(from_to(center, balls(end)), from_to(self.around, center)) + arc.radius_sq)
        if not beyond:
            z = minus(raw(end), raw(arc.center))
            beyond = sign(dot(z, w) + arc.radius_sq)
            if beyond == 0:
                # The end is a tangent point: faces go from the left one to the right one.
                left = sign(cross(w, z)) > 0
                return left if end is arc.start else not left
        return (beyond < 0) if arc.ccw else (beyond > 0)

    def _spans(self, arc: Arc, direction: Vector) -> bool:
        """Whether an arc contains the point of its circle in a direction from the centre."""
        center = balls(arc.center)
        first, last = (from_to(center, balls(p)) for p in (arc.start, arc.end))
        ends = (first, last) if arc.ccw else (last, first)
        clear = clearly_between(*ends, (ball_of(direction[0]), ball_of(direction[1])))
        return spans(arc, direction) if clear is None else clear

    def _tangent(self, e: int, side: int) -> int:
        """The event of the left (1) or right (-1) tangent from the point to the circle of an arc."""
        return self._add_mark(self._touching(e, side), self.floats.tangent(e, side))

    def _touching(self, e: int, side: int) -> SweepEnd:
        """Where the left (1) or right (-1) tangent from the point touches the circle of an arc."""
        arc = self.table.curves[e]
        assert isinstance(arc, Arc)
        circle = self.table.line_numbers.feature(e, True)
        ray = self._rays.get((circle, -side))
        touch = _Touch(self.table, self.point, self.origin, self.around, arc, side, circle, ray)
        return SweepEnd(touch.found, touch.vector, touch.long, e, -side)

    # -- the point's own edges ---------------------------------------------------------------------

    def _cone(self, arcs: list[tuple[int, int, int]]) -> Cone | None:
        """The blocked directions of a boundary point; adds the faces of its own concave arcs to *arcs*."""
        table = self.table
        incoming, outgoing = self.own[0], self.own[-1]
        before, after = table.curves[incoming], table.curves[outgoing]
        low = self._departure(after, outgoing, table.following[outgoing], 1)
        high = self._departure(before, incoming, incoming, -1)
        self.special += (low, high)
        if isinstance(before, Arc) and not before.ccw and before is after and before.full:
            arcs.append((outgoing, high, low))
        else:
            if isinstance(before, Arc) and not before.ccw:
                arcs.append((incoming, high, incoming))
            if isinstance(after, Arc) and not after.ccw:
                arcs.append((outgoing, table.following[outgoing], low))
        if len(self.own) == 2 and same_direction(self.offset(low), self.offset(high)):
            return None if is_spike(before, after) else Cone(low, low)
        return Cone(low, high)

    def _departure(self, curve: Curve, e: int, vertex: int, sense: int) -> int:
        """The event of the direction in which an own edge leaves the point, forward (1) or back (-1)."""
        if isinstance(curve, Segment):
            x, y = raw(curve.direction)
            self._offsets[vertex] = vector = x * sense, y * sense
            self.floats.add_event(vertex, *_held(vector))
            return vertex
        x, y = raw(curve.tangent(self.point))
        vector = x * sense, y * sense
        around = ball_of(vector[0]), ball_of(vector[1])
        side = sense if curve.ccw else -sense
        here = self.point, around
        mark = SweepEnd(lambda: here, lambda: vector, lambda: long_vector(vector), e, side)
        event = self._add_mark(mark, _held(vector))
        self.here.append(event)
        return event


def _held(vector: Vector) -> tuple[float, float, float]:
    """A vector in floats, with one bound for both components."""
    (x, p), (y, q) = map(held, vector)
    return x, y, max(p, q)


def _image(place: Vector) -> tuple[float, float, float, float, float]:
    """A place in floats: each coordinate and what it leaves, and a bound of what is left then."""
    (x, u, p), (y, v, q) = _with_rest(place[0]), _with_rest(place[1])
    return x, u, y, v, margin(max(p, q))


def _with_rest(value: fmpq | Real) -> tuple[float, float, float]:
    if not isinstance(value, Real):
        x = float(value)
        return x, float(value - fmpq(*x.as_integer_ratio())), 0.0
    ball = value.ball(BITS)
    x = float(ball)
    rest = ball - arb(x)
    near = float(rest)
    return x, near, (2 * float(rest.rad()) + 2 * UNIT * abs(near) + TINY) * WIDEN
