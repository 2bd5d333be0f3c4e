"""What a place sees from the front, in floats with bounds: faces, and the directions in which they end.

A *face* is a part of an edge that turns its free side to the place (see `exactacq.visibility.front_faces`).
Seen from the place it covers the directions counterclockwise from its low *event* to its high one. A straight
edge is one face or none: it runs clockwise, from its start s to its end t, so it is one if s x t < 0, with s
and t as offsets from the place.

Events are numbered by whoever asks: a vertex by its number, points that are no vertices by larger numbers.
"""

from __future__ import annotations

from typing import Final, final

from exactacq.kernel.bounded import (
    TINY,
    UNIT,
    WIDEN,
    cross,
    dot,
    length,
    product,
    quotient,
    root,
    total,
    verdict,
)
from exactacq.kernel.images import CONCAVE, REST, STRAIGHT, EdgeImage
from exactacq.kernel.lattice import Lattice

NONE: Final = -1
"""In place of the number of a face's event: it is a full circle around the place."""


@final
class FaceEnd:
    """A direction in which faces end, by the number of the point that lies there.

    (x, y) is the vector to that point, or some positive multiple of it, both components held with ``bound``.
    The sweep (see `exactacq.kernel.radial_sweep`) finds bounds of its key, its rank among the directions, and
    the faces that begin there or stop, counterclockwise, -1 for none; and ``beside`` it another event in
    the same direction. While directions are put in order, ``after`` is the next one.
    """

    def __init__(self, number: int, x: float, y: float, bound: float) -> None:
        self.number = number
        self.x, self.y, self.bound = x, y, bound
        self.least = self.most = 0.0
        self.rank = self.begins = self.stops = -1
        self.beside: FaceEnd | None = None
        self.after: FaceEnd | None = None


@final
class Face:
    """A face: its edge and both events, None of a full circle around the place.

    ``within`` says whether all of it certainly lies within range. Of a straight one from s to t, seen from
    the place, (ax, ay) is the vector a from s to t held with ``a``, and ``turn`` is s x t with its bound.
    """

    def __init__(
        self, number: int, edge: int, low: FaceEnd | None, high: FaceEnd | None, within: bool
    ) -> None:
        self.number, self.edge, self.low, self.high, self.within = number, edge, low, high, within
        self.ax = self.ay = self.a = self.turn = self.turn_bound = 0.0
        self.at = 0
        """Where it is among the faces that a ray meets."""

    def low_rank(self) -> int:
        """The rank of the direction in which it begins, counterclockwise, -1 if there is none."""
        return -1 if self.low is None else self.low.rank

    def high_rank(self) -> int:
        """The rank of the direction in which it stops."""
        return -1 if self.high is None else self.high.rank


@final
class RadialFaces:
    """The faces of one place, and their events.

    The place is held like a vertex: both coordinates with their rests, and a bound for what these leave.
    ``square`` is the square of the range.
    """

    def __init__(
        self,
        images: list[EdgeImage],
        place: tuple[float, float, float, float, float],
        square: tuple[float, float],
    ) -> None:
        self.images = images
        self.own: list[int] = []
        """The edges through the place, once they are known."""
        self.px, self.px_rest, self.py, self.py_rest, self.blur = place
        self.square, self.square_bound = square
        self.faces: list[Face] = []
        self.events: list[FaceEnd] = []
        self._numbered: dict[int, FaceEnd] = {}
        self.circles: list[int] = []

    def offset(self, v: int) -> tuple[float, float, float]:
        """The vector from the place to a vertex, with a bound for both components: see `images`."""
        vertex = self.images[v]
        x, y = vertex.x, vertex.y
        u = (x - self.px) + (vertex.x_rest - self.px_rest)
        w = (y - self.py) + (vertex.y_rest - self.py_rest)
        far = abs(x) + abs(y) + abs(self.px) + abs(self.py)
        return u, w, (UNIT * (abs(u) + abs(w)) + REST * far + self.blur + TINY) * WIDEN

    def reach(self, x: float, y: float, e: float) -> int:
        """1 if a vector is certainly shorter than the range, -1 if it is certainly longer, else 0.

        The square of a vector of size n = |x| + |y| whose components are held with e is held with 2 n e + 2
        e^2 for the data and 2 UNIT x^2 + 2 UNIT y^2 for three roundings; one more is that of the difference.
        """
        size = abs(x) + abs(y)
        square = x * x + y * y
        rest = self.square - square
        data = 2.0 * e * (size + e) + self.square_bound
        bound = (data + UNIT * (2.0 * square + abs(rest)) + TINY) * WIDEN
        return 1 if rest > bound else -1 if -rest > bound else 0

    def add_straight(self, edges: list[int]) -> list[int]:
        """Add the faces that straight edges are, in ascending order; those whose side is open are returned.

        Left out is what certainly lies beyond the range.
        """
        images = self.images
        px, px_rest, py, py_rest, blur = self.px, self.px_rest, self.py, self.py_rest, self.blur + TINY
        here = abs(px) + abs(py)
        open_: list[int] = []
        last = -1
        sx = sy = s = tx = ty = t = 0.0
        # The event at which the last face ended, and that with which the first one of an obstacle began:
        # no others can be met again.
        tail: FaceEnd | None = None
        opening: FaceEnd | None = None
        for e in edges:
            edge = images[e]
            if edge.kind != STRAIGHT:
                continue
            v = edge.following
            # As `offset`.
            if e == last:
                sx, sy, s = tx, ty, t
            else:
                x, y = edge.x, edge.y
                sx, sy = (x - px) + (edge.x_rest - px_rest), (y - py) + (edge.y_rest - py_rest)
                s = (UNIT * (abs(sx) + abs(sy)) + REST * (abs(x) + abs(y) + here) + blur) * WIDEN
            end = images[v]
            x, y = end.x, end.y
            tx, ty = (x - px) + (end.x_rest - px_rest), (y - py) + (end.y_rest - py_rest)
            t = (UNIT * (abs(tx) + abs(ty)) + REST * (abs(x) + abs(y) + here) + blur) * WIDEN
            last = v
            left, right = sx * ty, sy * tx
            turn = left - right
            # As `cross`.
            sizes = (abs(sx) + abs(sy)) * t + (abs(tx) + abs(ty) + 2.0 * t) * s
            bound = (sizes + UNIT * (abs(left) + abs(right) + abs(turn)) + TINY) * WIDEN
            if turn > bound:
                continue
            near = self._extent(sx, sy, s, tx, ty, t, turn, bound)
            if near < 0:
                continue
            if not -turn > bound:
                open_.append(e)
                continue
            low = opening if opening is not None and opening.number == v else self._new(v, tx, ty, t)
            if tail is not None and tail.number == e:
                high = tail
            else:
                high = self._new(e, sx, sy, s)
                if edge.previous > e:
                    opening = high
            tail = low
            self._add_line(e, low, high, near > 0, (tx - sx, ty - sy, s + t), (turn, bound))
        return open_

    def sides(self, edges: list[int], lattice: Lattice, place: int) -> list[int]:
        """1 or -1 as straight edges turn left or right about the place, which is a vertex, 0 if neither."""
        xs, ys = lattice.x, lattice.y
        x, y = xs[place], ys[place]
        found: list[int] = []
        for e in edges:
            v = self.images[e].following
            turn = (xs[e] - x) * (ys[v] - y) - (ys[e] - y) * (xs[v] - x)
            found.append(1 if turn > 0 else -1 if turn < 0 else 0)
        return found

    def add_open(self, e: int) -> None:
        """Add the face that a straight edge is, though its side was open."""
        v = self.images[e].following
        sx, sy, s = self.offset(e)
        tx, ty, t = self.offset(v)
        turn, bound = cross(sx, sy, s, tx, ty, t)
        near = self._extent(sx, sy, s, tx, ty, t, turn, bound)
        low, high = self.event(v), self.event(e)
        self._add_line(e, low, high, near > 0, (tx - sx, ty - sy, s + t), (turn, bound))

    def arcs(self, edges: list[int]) -> list[int]:
        """The arcs among some edges."""
        return [e for e in edges if self.images[e].kind != STRAIGHT]

    def gap(self, e: int) -> tuple[float, float]:
        """How far the place lies outside the circle of an arc; negative inside."""
        wx, wy, w = self.center(e)
        r = self.images[e].radius
        far, far_bound = length(wx, wy, w)
        return total(far, far_bound, -r, UNIT * r)

    def beside(self, e: int) -> int:
        """1 or -1 if the place is certainly outside or inside the circle of an arc, else 0."""
        gap, bound = self.gap(e)
        return verdict(gap, bound)

    def reaches(self, e: int) -> int:
        """1 if the circle of an arc certainly comes within range, -1 if it certainly does not, else 0."""
        gap, bound = self.gap(e)
        return self.reach(gap, 0.0, bound)

    def add_arcs(self, edges: list[int]) -> list[int]:
        """Add the faces of some arcs; those of which floats leave something open are returned.

        Left out is what certainly lies beyond the range. Each of ``circles`` has two events: from the number
        of edges on the left tangent point of the first one, its right one, and so on.
        """
        images, left = self.images, list[int]()
        for e in edges:
            gap, bound = self.gap(e)
            reach = self.reach(gap, 0.0, bound)
            if reach < 0:
                continue
            if reach == 0 or not abs(gap) > bound:
                left.append(e)
            elif gap < 0.0:
                # From inside nothing is seen of a round obstacle, and all of an arc around the place.
                if images[e].kind == CONCAVE and images[e].full:
                    self.add_arc(e, NONE, NONE)
                elif images[e].kind == CONCAVE:
                    self.add_arc(e, images[e].following, e)
            elif images[e].full:
                enter, leave = self._tangents(e, True, True)
                self.add_arc(e, leave, enter)
            elif not self._add_part(e):
                left.append(e)
        return left

    def _add_part(self, e: int) -> bool:
        """Add the faces of an arc that is no full circle, from outside its circle; False if that is open.

        With w from the place to the centre and z from there to an end, the arc turns its free side to the
        place there if r^2 + w . z < 0, or > 0 if it is concave. What it has of the near part of the circle,
        or of the far one if it is concave, is a face, or two if the ends lie on that part and the arc leads
        around the other one.
        """
        kind, end = self.images[e].kind, self.images[e].following
        first, last = kind * -self._beyond(e, e), kind * -self._beyond(e, end)
        if first == 0 or last == 0:
            return False
        if first != last:
            enter, leave = self._tangents(e, first < 0, last < 0)
            self.add_arc(e, end if last > 0 else leave, e if first > 0 else enter)
            return True
        # Both ends on the face's part of the circle, or none: does the arc contain the middle of the other?
        around = self._spans(e, kind * first)
        if around == 0:
            return False
        if around > 0:
            enter, leave = self._tangents(e, True, True)
            if first < 0:
                self.add_arc(e, leave, enter)
            else:
                self.add_arc(e, leave, e)
                self.add_arc(e, end, enter)
        elif first > 0:
            self.add_arc(e, end, e)
        return True

    def _tangents(self, e: int, has_left: bool, has_right: bool) -> tuple[int, int]:
        """The events on both tangent points of an arc's circle, left and right; those asked for are added."""
        event = len(self.images) + 2 * len(self.circles)
        self.circles.append(e)
        if has_left:
            x, y, bound = self.tangent(e, 1)
            self.add_event(event, x, y, bound)
        if has_right:
            x, y, bound = self.tangent(e, -1)
            self.add_event(event + 1, x, y, bound)
        return event, event + 1

    def _from_center(self, e: int, v: int) -> tuple[float, float, float]:
        """The vector from an arc's centre to a vertex, as `offset`."""
        vertex, arc = self.images[v], self.images[e]
        x, y, cx, cy = vertex.x, vertex.y, arc.cx, arc.cy
        u = (x - cx) + (vertex.x_rest - arc.cx_rest)
        w = (y - cy) + (vertex.y_rest - arc.cy_rest)
        far = abs(x) + abs(y) + abs(cx) + abs(cy)
        return u, w, (UNIT * (abs(u) + abs(w)) + REST * far + TINY) * WIDEN

    def _beyond(self, e: int, v: int) -> int:
        """The sign of r^2 + w . z, with w from the place to an arc's centre and z from there to a vertex."""
        wx, wy, w = self.center(e)
        x, y, z = self._from_center(e, v)
        r = self.images[e].radius
        square, square_bound = product(r, UNIT * r, r, UNIT * r)
        m, bound = dot(wx, wy, w, x, y, z)
        m, bound = total(m, bound, square, square_bound)
        return verdict(m, bound)

    def _spans(self, e: int, away: int) -> int:
        """1 or -1 as an arc certainly contains the point of its circle away (1) or towards the place, or not.

        A direction that lies on the same side of those to both ends is between them, or it is not, whichever
        way the arc turns (see `exactacq.geometry.late.clearly_between`).
        """
        wx, wy, w = self.center(e)
        dx, dy = away * wx, away * wy
        start, end = e, self.images[e].following
        if self.images[e].kind == CONCAVE:
            start, end = end, start
        ax, ay, a = self._from_center(e, start)
        bx, by, b = self._from_center(e, end)
        m, bound = cross(ax, ay, a, dx, dy, w)
        after = verdict(m, bound)
        m, bound = cross(dx, dy, w, bx, by, b)
        before = verdict(m, bound)
        if after == before:
            return after
        m, bound = cross(ax, ay, a, bx, by, b)
        return -verdict(m, bound) if after and before else 0

    def add_arc(self, e: int, low: int, high: int) -> None:
        """Add a face of an arc between two events (`NONE` for none): vertices, or events that are added."""
        first = self.event(low) if low >= 0 else None
        last = self.event(high) if high >= 0 else None
        wx, wy, w = self.center(e)
        far, far_bound = length(wx, wy, w)
        r = self.images[e].radius
        far, far_bound = total(far, far_bound, r, UNIT * r)
        self._add(e, first, last, self.reach(far, 0.0, far_bound) > 0)

    def add_event(self, number: int, x: float, y: float, bound: float) -> None:
        """Add an event with its vector; for a vertex too it is taken instead of the offset."""
        event = self.found(number)
        if event is None:
            self._new(number, x, y, bound)
        else:
            event.x, event.y, event.bound = x, y, bound

    def event(self, number: int) -> FaceEnd:
        """The event with a number; of a vertex that has none a new one."""
        event = self.found(number)
        if event is None:
            x, y, bound = self.offset(number)
            event = self._new(number, x, y, bound)
        return event

    def found(self, number: int) -> FaceEnd | None:
        """The event with a number, or None."""
        known = self._numbered
        for k in range(len(known), len(self.events)):
            known[self.events[k].number] = self.events[k]
        return known.get(number)

    def _new(self, number: int, x: float, y: float, bound: float) -> FaceEnd:
        event = FaceEnd(number, x, y, bound)
        self.events.append(event)
        return event

    def center(self, e: int) -> tuple[float, float, float]:
        """The vector from the place to an arc's centre, as `offset`."""
        arc = self.images[e]
        x, y = arc.cx, arc.cy
        u = (x - self.px) + (arc.cx_rest - self.px_rest)
        w = (y - self.py) + (arc.cy_rest - self.py_rest)
        far = abs(x) + abs(y) + abs(self.px) + abs(self.py)
        return u, w, (UNIT * (abs(u) + abs(w)) + REST * far + self.blur + TINY) * WIDEN

    def tangent(self, e: int, side: int) -> tuple[float, float, float]:
        """A vector along the left (1) or right (-1) tangent from the place to a circle that it is outside of.

        With w to the centre, r the radius and h^2 = (|w| - r) (|w| + r) it is h w +- r left(w).
        """
        wx, wy, w = self.center(e)
        r = self.images[e].radius
        far, far_bound = length(wx, wy, w)
        gap, gap_bound = total(far, far_bound, -r, UNIT * r)
        most, most_bound = total(far, far_bound, r, UNIT * r)
        square, square_bound = product(gap, gap_bound, most, most_bound)
        h, h_bound = root(square, square_bound)
        across, across_bound = side * r, UNIT * r
        x, x_bound = product(wx, w, h, h_bound)
        y, y_bound = product(wy, w, h, h_bound)
        u, u_bound = product(-wy, w, across, across_bound)
        v, v_bound = product(wx, w, across, across_bound)
        x, x_bound = total(x, x_bound, u, u_bound)
        y, y_bound = total(y, y_bound, v, v_bound)
        return x, y, max(x_bound, y_bound)

    def way(self, face: Face, dx: float, dy: float, d: float) -> tuple[float, float]:
        """How many times a vector, its components held with d, leads from the place to a face that covers it.

        On the line through s along a it is s x a / (d x a), and s x a = s x t. On a circle about w it is
        (d . w -+ sqrt(|d|^2 r^2 - (d x w)^2)) / |d|^2, and 2 d . w / |d|^2 if the place is on it.
        """
        e = face.edge
        edge = self.images[e]
        if edge.kind == STRAIGHT:
            below, bound = cross(dx, dy, d, face.ax, face.ay, face.a)
            return quotient(face.turn, face.turn_bound, below, bound)
        wx, wy, w = self.center(e)
        square, square_bound = dot(dx, dy, d, dx, dy, d)
        h, h_bound = dot(dx, dy, d, wx, wy, w)
        if e in self.own:
            return quotient(2.0 * h, 2.0 * h_bound, square, square_bound)
        g, g_bound = cross(dx, dy, d, wx, wy, w)
        r = edge.radius
        size, size_bound = root(square, square_bound)
        across, across_bound = product(size, size_bound, r, UNIT * r)
        plus, plus_bound = total(across, across_bound, g, g_bound)
        minus, minus_bound = total(across, across_bound, -g, g_bound)
        under, under_bound = product(plus, plus_bound, minus, minus_bound)
        half, half_bound = root(under, under_bound)
        top, top_bound = total(h, h_bound, -edge.kind * half, half_bound)
        return quotient(top, top_bound, square, square_bound)

    def _extent(
        self,
        sx: float,
        sy: float,
        s: float,
        tx: float,
        ty: float,
        t: float,
        turn: float,
        turn_bound: float,
    ) -> int:
        """1 or -1 if all or none of the segment from s to t is certainly within range, else 0.

        With a from s to t, none of it is if both ends are beyond and the foot of the place is not between
        them, or the line is too far: its distance is |s x t| / |a| >= |s x t| / |a|_1.
        """
        first = self.reach(sx, sy, s)
        last = self.reach(tx, ty, t)
        if first > 0 and last > 0:
            return 1
        if not (first < 0 and last < 0):
            return 0
        ax, ay = tx - sx, ty - sy
        size = abs(ax) + abs(ay)
        a = (s + t + UNIT * size) * WIDEN
        far, far_bound = quotient(turn, turn_bound, size, 2.0 * a)
        if self.reach(far, 0.0, far_bound) < 0:
            return -1
        ahead, ahead_bound = dot(sx, sy, s, ax, ay, a)
        behind, behind_bound = dot(tx, ty, t, ax, ay, a)
        return -1 if ahead > ahead_bound or -behind > behind_bound else 0

    def _add_line(
        self,
        e: int,
        low: FaceEnd,
        high: FaceEnd,
        within: bool,
        vector: tuple[float, float, float],
        turn: tuple[float, float],
    ) -> None:
        """Add a straight face, by the vector along it, with the bounds of what it is the difference of."""
        face = self._add(e, low, high, within)
        ax, ay, a = vector
        face.ax, face.ay, face.a = ax, ay, (a + UNIT * (abs(ax) + abs(ay))) * WIDEN
        face.turn, face.turn_bound = turn

    def _add(self, e: int, low: FaceEnd | None, high: FaceEnd | None, within: bool) -> Face:
        face = Face(len(self.faces), e, low, high, within)
        self.faces.append(face)
        return face
