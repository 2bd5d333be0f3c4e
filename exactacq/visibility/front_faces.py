"""Front faces: the parts of the boundary that turn their free side to a point (faces in the code).

A ray from the point enters an obstacle only through a face, and meets each face once. Seen from the
point a face runs clockwise in the boundary's direction, since the obstacle lies on its left. A straight
edge is one face or none. An arc is divided where tangents from the point touch its circle: the near part
of a convex arc is a face, the far part of a concave one, and all of a concave one if the point is inside
the circle.

The ends of faces are *events*, numbered: below the number of edges they are vertices, from there on *marks*,
points that are no vertices (tangent points, the point itself). Floats decide what their margins prove.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import hypot, sqrt
from typing import Any

import numpy as np
from flint import arb

from exactacq.geometry.coordinates import Vector, advance, cross, dot, minus, raw, sign, square_root
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import spans
from exactacq.geometry.late import Balls, ball_of, balls, clearly_between, from_to, late_point
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import ball_sign
from exactacq.scene.edge_table import STRAIGHT, EdgeTable, Floats, Ints
from exactacq.visibility.features import is_spike, parallel

SLACK = 8.0
"""Margin of float differences of coordinates, in units of the table's round-off; the larger, the more is
decided exactly."""
VAGUE = 10.0
"""Margin of an angle that floats do not know at all."""
EXACT = 64 * 2.0**-52
"""Margin of the direction of a vector whose coordinates are correctly rounded."""
SURE_GAP = 1e-3
"""A circle at least so many radii away has float tangents that are good to the margin."""
NOWHERE = -1
"""The event where a full circle about the point begins and ends: there is none."""


class SweepEnd:
    """An event that is no vertex: its point, the direction to it, and that direction as floats with a margin.

    It lies on arc ``edge``, to whose circle the direction is tangent; ``side`` is 1 if the circle is to the
    left, else -1. ``around`` are balls around the direction that `vector` gives exactly.
    """

    __slots__ = ("around", "edge", "margin", "point", "side", "vector", "xy")

    def __init__(
        self,
        point: Point,
        vector: Callable[[], Vector],
        around: Balls,
        xy: tuple[float, float],
        margin: float,
        edge: int,
        side: int,
    ) -> None:
        self.point, self.vector, self.around = point, vector, around
        self.xy, self.margin, self.edge, self.side = xy, margin, edge, side


class _Touch:
    """Where the left (1) or right (-1) tangent from a point touches a circle; w leads to the centre.

    With h^2 the squared length of the tangent and g = h r the direction is h^2 w +- g left(w), which is |w|^2
    times as long as the way.
    """

    __slots__ = ("_vector", "arc", "origin", "side", "w")

    def __init__(self, origin: Vector, arc: Arc, w: Vector, side: int) -> None:
        self.origin, self.arc, self.w, self.side = origin, arc, w, side
        self._vector: Vector | None = None

    def vector(self) -> Vector:
        """The exact direction."""
        if self._vector is None:
            w, radius_sq = self.w, self.arc.radius_sq
            excess = dot(w, w) - radius_sq
            self._vector = _tangent(w, excess, square_root(excess * radius_sq) * self.side)
        return self._vector

    def point(self) -> Point:
        """The exact point."""
        return advance(self.origin, self.vector(), 1 / dot(self.w, self.w))

    def around(self, origin: Balls) -> tuple[Balls, Balls]:
        """Balls around the direction and the point."""
        (x, y), center, radius_sq = origin, balls(self.arc.center), arb(self.arc.radius_sq)
        w = center[0] - x, center[1] - y
        square = dot(w, w)
        excess = square - radius_sq
        u, v = _tangent(w, excess, (excess * radius_sq).sqrt() * self.side)
        return (u, v), (x + u / square, y + v / square)


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
    """The faces within reach of one free point, as parallel arrays, with their events.

    ``edge``, ``low`` and ``high``: edge number and events of each face; it covers the directions
    counterclockwise from low to high, and runs from high to low. ``own`` are the edges through the point, at
    a vertex the incoming one first; ``on_ray`` the other straight edges that the point sees edge-on.
    """

    def __init__(self, table: EdgeTable, point: Point, reach: float, own: tuple[int, ...]) -> None:
        self.table, self.point, self.own = table, point, own
        self.origin, self.around = raw(point), balls(point)
        self.xy = point.xy
        self.reach = reach
        self.slack = SLACK * table.roundoff_at(self.xy)
        self.marks: list[SweepEnd] = []
        self.on_ray: list[int] = []
        self.special: list[int] = []
        self._offsets: dict[int, Vector] = {}
        near = table.near(self.xy, self.xy, reach)
        arcs: list[tuple[int, int, int]] = []
        if table.curved:
            straight = table.kind[near] == STRAIGHT
            edges, low, high = self._straight(near[straight])
            for e in near[~straight].tolist():
                if e not in own:
                    arcs += self._arc(e)
        else:
            edges, low, high = self._straight(near)
        self.cone = self._cone(arcs) if own else None
        for e in self.on_ray:
            self.special += (e, int(table.next[e]))
        self.curved = bool(arcs)
        if arcs:
            more = np.array(arcs, dtype=np.intp)
            self.rows = np.concatenate((self.rows, np.zeros((6, len(more)))), axis=1)
            edges, low, high = (
                np.concatenate((a, b)) for a, b in zip((edges, low, high), more.T, strict=True)
            )
        self.edge, self.low, self.high = edges, low, high

    rows: Floats
    """Six rows, zeros for arcs: from the point to a face's start (x, y), from there to its end (x, y), the
    vector product of these two, and its margin."""

    def __len__(self) -> int:
        return len(self.edge)

    # -- events ------------------------------------------------------------------------------------

    def offset(self, event: int) -> Vector:
        """The exact vector from the point to an event, or some positive multiple of it."""
        known = self._offsets.get(event)
        if known is None:
            vertices = self.table.vertices
            if event < len(vertices):
                known = minus(vertices[event], self.origin)
            else:
                known = self.marks[event - len(vertices)].vector()
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
        mark = self.marks[event - len(vertices)]
        return mark.around, mark.vector

    def place(self, event: int) -> Point:
        """The point where an event lies."""
        count = len(self.table.vertices)
        return self.table.curves[event].start if event < count else self.marks[event - count].point

    def _mark(self, mark: SweepEnd) -> int:
        self.marks.append(mark)
        return len(self.table.vertices) + len(self.marks) - 1

    # -- straight edges ----------------------------------------------------------------------------

    def _straight(self, edges: Ints) -> tuple[Ints, Ints, Ints]:
        table, slack = self.table, self.slack
        for e in self.own:
            edges = edges[edges != e]
        rows = table.rows[:, edges]
        rows[0] -= self.xy[0]
        rows[1] -= self.xy[1]
        sx, sy, ax, ay = rows
        margin = np.abs(rows).sum(axis=0)
        margin *= 4 * slack
        turn = sx * ay
        turn -= sy * ax
        front = turn < -margin
        vague = np.abs(turn) <= margin
        share = sx * ax
        share += sy * ay
        share /= -np.maximum(ax * ax + ay * ay, 1e-300)
        share = np.minimum(np.maximum(share, 0.0), 1.0)
        gap = np.hypot(sx + share * ax, sy + share * ay)
        near = ~(gap > self.reach + 4 * slack)
        if vague.any():
            for k in np.flatnonzero(vague & near).tolist():
                e = int(edges[k])
                side = sign(cross(self.offset(e), self.offset(int(table.next[e]))))
                front[k] = side < 0
                if side == 0:
                    self.on_ray.append(e)
        front &= near
        chosen = edges[front]
        self.rows = np.concatenate((rows, (turn, margin)))[:, front]
        return chosen, table.next[chosen], chosen

    # -- arcs --------------------------------------------------------------------------------------

    def _arc(self, e: int) -> list[tuple[int, int, int]]:
        """The faces (edge, low, high) of an arc that does not pass through the point, in its direction."""
        table, slack, arc = self.table, self.slack, self.table.curves[e]
        assert isinstance(arc, Arc)
        wx, wy = float(table.center[e, 0] - self.xy[0]), float(table.center[e, 1] - self.xy[1])
        size, radius = hypot(wx, wy), float(table.radius[e])
        if abs(size - radius) > self.reach + 8 * slack:
            return []
        end = int(table.next[e])
        w = minus(raw(arc.center), self.origin)
        outside = size > radius
        if any(table.circles.get(own) == table.circles[e] for own in self.own):
            outside = False  # An own edge is another arc of the same circle, so the point is on it.
        elif not abs(size - radius) > 8 * slack:
            outside = sign(dot(w, w) - arc.radius_sq) > 0
        if not outside:
            whole = NOWHERE if arc.full else e
            return [] if arc.ccw else [(e, NOWHERE if arc.full else end, whole)]
        away = (-w[0], -w[1])
        front, back = (away, w) if arc.ccw else (w, away)
        first, last = (not arc.full and self._facing(arc, w, p) for p in (arc.start, arc.end))
        if first and last:
            if not self._spans(arc, back):
                return [(e, end, e)]
        elif not (first or last) and not self._spans(arc, front):
            return []
        # From the left tangent point to the right one: clockwise as seen from the point.
        enter, leave = self._tangent(e, w, 1), self._tangent(e, w, -1)
        if first and last:
            return [(e, leave, e), (e, end, enter)]
        return [(e, end if last else leave, e if first else enter)]

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

    def _tangent(self, e: int, w: Vector, side: int) -> int:
        """The event of the left (1) or right (-1) tangent from the point to the circle of an arc."""
        arc = self.table.curves[e]
        assert isinstance(arc, Arc)
        (wx, wy), radius = self.table.center[e] - self.xy, float(self.table.radius[e])
        gap, margin = hypot(wx, wy) - radius, EXACT
        if gap > radius * SURE_GAP:
            reach = sqrt(gap * (gap + 2 * radius))
            margin += 16 * self.slack / reach
        else:
            # Correctly rounded exact values: no cancellation is left.
            wx, wy = float(w[0]), float(w[1])
            radius, reach = float(arc.radius), sqrt(float(dot(w, w) - arc.radius_sq))
        xy = wx * reach - wy * radius * side, wy * reach + wx * radius * side
        touch = _Touch(self.origin, arc, w, side)
        vector, point = touch.around(self.around)
        return self._mark(
            SweepEnd(late_point(point, touch.point), touch.vector, vector, xy, margin, e, -side)
        )

    # -- the point's own edges ---------------------------------------------------------------------

    def _cone(self, arcs: list[tuple[int, int, int]]) -> Cone | None:
        """The blocked directions of a boundary point; adds the faces of its own concave arcs to *arcs*."""
        table = self.table
        incoming, outgoing = self.own[0], self.own[-1]
        before, after = table.curves[incoming], table.curves[outgoing]
        low = self._departure(after, outgoing, int(table.next[outgoing]), 1)
        high = self._departure(before, incoming, incoming, -1)
        self.special += (low, high)
        if isinstance(before, Arc) and not before.ccw and before is after and before.full:
            arcs.append((outgoing, high, low))
        else:
            if isinstance(before, Arc) and not before.ccw:
                arcs.append((incoming, high, incoming))
            if isinstance(after, Arc) and not after.ccw:
                arcs.append((outgoing, int(table.next[outgoing]), low))
        if len(self.own) == 2 and parallel(self.offset(low), self.offset(high)):
            return None if is_spike(before, after) else Cone(low, low)
        return Cone(low, high)

    def _departure(self, curve: Curve, e: int, vertex: int, sense: int) -> int:
        """The event of the direction in which an own edge leaves the point, forward (1) or back (-1)."""
        if isinstance(curve, Segment):
            x, y = raw(curve.direction)
            self._offsets[vertex] = x * sense, y * sense
            return vertex
        x, y = raw(curve.tangent(self.point))
        vector = x * sense, y * sense
        around, xy = (ball_of(vector[0]), ball_of(vector[1])), (float(vector[0]), float(vector[1]))
        side = sense if curve.ccw else -sense
        return self._mark(SweepEnd(self.point, lambda: vector, around, xy, EXACT, e, side))
