"""What a line meets, on both sides of its contact, up to what blocks it.

Which vertices the line passes and which arcs it touches is known by name. Floats with bounds (see
`kernel.bounded`) tell the rest: on which sides of the line other vertices lie, where it crosses edges, and in
which order it meets all this. Where one of these is open nothing is told.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Final, final

from exactacq.kernel.bound_lines import NOTHING
from exactacq.kernel.bounded import (
    UNIT,
    WIDEN,
    cross,
    cross_sign,
    dot,
    dot_sign,
    length,
    product,
    quotient,
    root,
    total,
)
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import EVERYTHING
from exactacq.kernel.grazing_lines import MetEdge
from exactacq.kernel.images import CONVEX, STRAIGHT, EdgeImage
from exactacq.kernel.lines import QUARTERS, Line, meets_straight, parameter, rounding, side_of
from exactacq.kernel.single_lines import Spot

TOUCHED: Final = -1
CROSSED: Final = -2
"""How an edge is met that is not met at a vertex."""
AHEAD: Final = 0
LEFT: Final = 1
BEHIND: Final = 2
RIGHT: Final = 3
"""Where an edge leaves from a vertex on the line: along it, or to a side; in the order of turning left."""


@final
class GrazedPlace:
    """Where a line meets edges: from ``low`` to ``high`` along it, in lengths; at which vertex, or how."""

    def __init__(self, low: float, high: float, vertex: int, edge: int) -> None:
        self.low, self.high = low, high
        self.vertex, self.edges = vertex, [edge]


@final
class WalkedLine:
    """A line, followed from its contact ``ahead`` and ``behind``: what it meets, nearest first.

    The last of that blocks the line, if it ``is_blocked`` there. *passed* are the vertices that the line
    passes, *touched* arcs on the circles that it touches; *circles* has the first arc on the circle of each
    arc. The contact is the vertex *own* or, with *is_round*, on the arc *own*. What is farther than *reach*
    is left out, but for the end of an edge along the line. If floats leave anything open, the line is not
    told of: ``is_told`` is false.
    """

    def __init__(
        self,
        images: list[EdgeImage],
        curves: list[CurveImage],
        edges: list[int],
        line: Line,
        passed: set[int],
        touched: set[int],
        circles: list[int],
        own: int,
        is_round: bool,
        reach: float,
    ) -> None:
        self._images, self._curves, self._line = images, curves, line
        self._passed, self._circles = passed, circles
        self._touched = {circles[e] for e in touched}
        self._reach = reach
        # The contact of an arc that ends there is a vertex like others.
        end = self._passed_end(own) if is_round else own
        self._own, self._is_round = (own, True) if end == NOTHING else (end, False)
        self._size = length(line[2], line[3], line[5])
        self._sides: dict[int, int] = {}
        self._at: dict[int, GrazedPlace] = {}
        self._spots: list[GrazedPlace] = []
        self.is_told = True
        self.ahead: list[MetEdge] = []
        self.behind: list[MetEdge] = []
        self.is_blocked_ahead = False
        self.is_blocked_behind = False
        for e in edges:
            if images[e].kind == STRAIGHT:
                self._meet_straight(e)
            else:
                self._meet_round(e)
            if not self.is_told:
                return
        self.is_blocked_ahead = self._is_blocked_at_once(1) or self._follow(1, self.ahead)
        self.is_blocked_behind = self._is_blocked_at_once(-1) or self._follow(-1, self.behind)

    # -- what is met -----------------------------------------------------------------------------

    def _meet_straight(self, e: int) -> None:
        v, w = e, self._images[e].following
        first, last = self._side(v), self._side(w)
        if not self.is_told:
            return
        if first == 0:
            self._add_vertex(v, e)
        if last == 0:
            self._add_vertex(w, e)
        if first * last < 0:
            far, bound, _, _, _, _, _ = meets_straight(self._line, self._curves[e])
            self._add(far, bound, CROSSED, e)

    def _meet_round(self, e: int) -> None:
        v, w = e, self._images[e].following
        if self._circles[e] in self._touched:
            end = self._passed_end(e)
            if end != NOTHING:
                self._add_vertex(end, e)
            elif not (self._is_round and e == self._own):
                self._touch(e)
            return
        foot, bound = self._along(self._curves[e].x, self._curves[e].y)
        half, half_bound = self._half_chord(e)
        if half < 0.0:
            return
        if half == 0.0:
            # Crossed, touched or missed, all near the foot.
            self.is_told = self._beyond_chord(e, foot, bound + half_bound) < 0
            return
        is_whole = self._images[e].full
        first, last = (1, 1) if is_whole else (self._side(v), self._side(w))
        if not self.is_told:
            return
        if first and last:
            for reach in (-half, half):
                far, far_bound = total(foot, bound, reach, half_bound)
                self._cross(e, far, far_bound)
            return
        if first == 0:
            self._add_vertex(v, e)
        if last == 0:
            self._add_vertex(w, e)
        if first or last:
            # The circle is met once more, as far from the foot on its other side.
            far, far_bound = self._vertex_along(w if first else v)
            far, far_bound = total(2.0 * foot, 2.0 * bound, -far, far_bound)
            self._cross(e, far, far_bound)

    def _passed_end(self, e: int) -> int:
        """The vertex at which an arc that the line touches ends there; `NOTHING` if it goes on."""
        if self._images[e].full:
            return NOTHING
        for v in (e, self._images[e].following):
            if v in self._passed:
                return v
        return NOTHING

    def _touch(self, e: int) -> None:
        """Add where the line touches an arc's circle, if that is on the arc."""
        foot, bound = self._along(self._curves[e].x, self._curves[e].y)
        side = self._beyond_chord(e, foot, bound)
        if side > 0:
            self._add(foot, bound, TOUCHED, e)
        self.is_told = self.is_told and side != 0

    def _cross(self, e: int, far: float, bound: float) -> None:
        """Add a place where the line crosses an arc's circle, if it is on the arc."""
        side = self._beyond_chord(e, far, bound)
        if side > 0:
            self._add(far, bound, CROSSED, e)
        self.is_told = self.is_told and side != 0

    def _half_chord(self, e: int) -> tuple[float, float]:
        """Half of what an arc's circle, which the line does not touch, cuts out of it; -1 if nothing surely.

        0 with a bound where that is open.
        """
        curve = self._curves[e]
        x, y, dx, dy, ce, de = self._line
        ox, p = total(curve.x, rounding(curve.x, curve.y), -x, ce)
        oy, q = total(curve.y, rounding(curve.x, curve.y), -y, ce)
        across, across_bound = cross(dx, dy, de, ox, oy, max(p, q))
        height, bound = self._in_lengths(across, across_bound)
        radius, blur = curve.radius, UNIT * curve.radius
        plus, plus_bound = total(radius, blur, height, bound)
        minus, minus_bound = total(radius, blur, -height, bound)
        under, under_bound = product(plus, plus_bound, minus, minus_bound)
        if -under > under_bound:
            return -1.0, 0.0
        if under > under_bound:
            return root(under, under_bound)
        return 0.0, sqrt(under + under_bound) * WIDEN

    def _beyond_chord(self, e: int, far: float, bound: float) -> int:
        """1 if a place of an arc's circle on the line certainly is on the arc, -1 if it is not, else 0."""
        if self._images[e].full:
            return 1
        px, py, error = self.spot(far, bound)
        ax, ay = self._images[e].x, self._images[e].y
        ux, uy, u = self._vector(e, self._images[e].following)
        vx, r = total(px, error, -ax, rounding(ax, ay))
        vy, s = total(py, error, -ay, rounding(ax, ay))
        return -self._images[e].kind * cross_sign(ux, uy, u, vx, vy, max(r, s))

    def spot(self, far: float, bound: float) -> Spot:
        """A place of the line, so far along it, in lengths."""
        x, y, dx, dy, ce, de = self._line
        step, step_bound = self._in_lengths(far, bound)
        px, p = product(dx, de, step, step_bound)
        py, q = product(dy, de, step, step_bound)
        px, p = total(x, ce, px, p)
        py, q = total(y, ce, py, q)
        return px, py, max(p, q)

    def _side(self, v: int) -> int:
        """1 or -1 for a vertex left or right of the line, 0 for one on it, or if that is open."""
        if v in self._passed:
            return 0
        side = self._sides.get(v, 0)
        if side == 0:
            x, y = self._images[v].x, self._images[v].y
            side = self._sides[v] = side_of(self._line, x, y, rounding(x, y), 0.0)
            self.is_told = self.is_told and side != 0
        return side

    def _along(self, x: float, y: float) -> tuple[float, float]:
        """How far along the line the foot of a place of the scene is, in lengths."""
        cx, cy, dx, dy, ce, de = self._line
        ox, p = total(x, rounding(x, y), -cx, ce)
        oy, q = total(y, rounding(x, y), -cy, ce)
        along, bound = dot(ox, oy, max(p, q), dx, dy, de)
        return self._in_lengths(along, bound)

    def _in_lengths(self, value: float, bound: float) -> tuple[float, float]:
        """A value divided by the length of the line's direction."""
        size, size_bound = self._size
        return quotient(value, bound, size, size_bound)

    def _vertex_along(self, v: int) -> tuple[float, float]:
        """How far along the line a vertex on it is, in lengths."""
        if v == self._own and not self._is_round:
            return 0.0, 0.0
        return self._along(self._images[v].x, self._images[v].y)

    def _add_vertex(self, v: int, e: int) -> None:
        if v in self._at:
            self._at[v].edges.append(e)
        elif v == self._own and not self._is_round:
            return
        else:
            far, bound = self._vertex_along(v)
            self._add(far, bound, v, e)
            self._at[v] = self._spots[-1]

    def _add(self, far: float, bound: float, vertex: int, e: int) -> None:
        self._spots.append(GrazedPlace(far - bound, far + bound, vertex, e))
        self.is_told = self.is_told and (far - bound > 0.0 or far + bound < 0.0) and bound < inf

    # -- as far as it is free ----------------------------------------------------------------------

    def _is_blocked_at_once(self, sense: int) -> bool:
        """Whether the line enters an obstacle at its contact: it may at a vertex, at the tip of a cusp."""
        return not self._is_round and self._blocks(self._own, sense)

    def _follow(self, sense: int, met: list[MetEdge]) -> bool:
        """Collect what is met ahead (1) or behind (-1) up to what blocks the line; whether anything does."""
        order = [
            (s.low if sense > 0 else -s.high, k) for k, s in enumerate(self._spots) if s.low * sense > 0.0
        ]
        order.sort()
        vertex = NOTHING if self._is_round else self._own
        for n, (near, k) in enumerate(order):
            spot = self._spots[k]
            is_far = near > self._reach
            if is_far and not self._are_joined(vertex, spot.vertex):
                return False
            if n + 1 < len(order) and order[n + 1][0] <= (spot.high if sense > 0 else -spot.low):
                self.is_told = False  # Which of the two places comes first is open.
                return False
            vertex = spot.vertex
            edges = spot.edges if sense > 0 else spot.edges[::-1]
            for e in edges:
                met.append(self._met(e, spot, sense * (n + 1)))
            if is_far:
                return False
            if vertex == CROSSED or (vertex >= 0 and self._blocks(vertex, sense)):
                return True
            if vertex == TOUCHED and self._images[spot.edges[0]].kind != CONVEX:
                self.is_told = False
        return False

    def contact(self, edges: list[int]) -> list[MetEdge]:
        """The contact, as it is met with its edges."""
        spot = GrazedPlace(0.0, 0.0, TOUCHED if self._is_round else self._own, NOTHING)
        return [self._met(e, spot, 0) for e in edges]

    def _met(self, e: int, spot: GrazedPlace, place: int) -> MetEdge:
        """An edge as it is met in a place."""
        if spot.vertex >= 0:
            end = -inf if spot.vertex == e else inf
            x, y = self._images[spot.vertex].x, self._images[spot.vertex].y
            return MetEdge(e, spot.vertex, place, (end, end), (x, y, rounding(x, y)))
        curve = self._curves[e]
        if self._images[e].kind == STRAIGHT:
            _, _, u, bound, x, y, error = meets_straight(self._line, curve)
            return MetEdge(e, spot.vertex, place, (u - bound, u + bound), (x, y, error))
        # Twice what seems to be enough: the bounds themselves are rounded.
        at = self.spot((spot.low + spot.high) / 2.0, 2.0 * (spot.high - spot.low) * WIDEN)
        u, bound = parameter(curve, at[0], at[1], at[2])
        # At the start of a full circle parameters jump.
        is_known = not self._images[e].full or bound < u < QUARTERS - bound
        return MetEdge(e, spot.vertex, place, (u - bound, u + bound) if is_known else EVERYTHING, at)

    def _are_joined(self, v: int, w: int) -> bool:
        """Whether a straight edge joins two vertices."""
        if v < 0 or w < 0:
            return False
        one, other = self._images[v], self._images[w]
        if one.following == w and one.kind == STRAIGHT:
            return True
        return other.following == v and other.kind == STRAIGHT

    def _blocks(self, v: int, sense: int) -> bool:
        """Whether the line enters an obstacle at a vertex, as one goes.

        The inside is what one passes in turning left from the edge that begins there to the one that ends.
        """
        before = self._images[v].previous
        out, back = self._quarter(v, v, sense), self._quarter(before, v, sense)
        if out == back:
            # What lies behind, or the contact, is not inside, so little is: no more than that quarter.
            self.is_told = self.is_told and self._is_narrow(before, v)
            return False
        return out > back > AHEAD

    def _is_narrow(self, before: int, v: int) -> bool:
        """Whether two edges that leave a vertex to one side certainly leave no room behind it."""
        if self._images[before].kind == STRAIGHT and self._images[v].kind == STRAIGHT:
            return self._turn(before, v, self._images[v].following) > 0
        touched = self._circles[before] in self._touched and self._circles[v] in self._touched
        return not touched or self._onward(before, v) * self._onward(v, v) < 0

    def _quarter(self, e: int, v: int, sense: int) -> int:
        """Where an edge leaves from its end v on the line, as one goes."""
        side = self._leaves(e, v) * sense
        if side:
            return LEFT if side > 0 else RIGHT
        other = self._images[e].following if v == e else e
        return BEHIND if self._is_behind(other, v, sense) else AHEAD

    def _leaves(self, e: int, v: int) -> int:
        """1 or -1 as an edge leaves its end v on the line to the left or right, 0 if along it, or if open."""
        kind = self._images[e].kind
        if kind == STRAIGHT:
            return self._side(self._images[e].following if v == e else e)
        curve = self._curves[e]
        if self._circles[e] in self._touched:
            side = side_of(self._line, curve.x, curve.y, rounding(curve.x, curve.y), 0.0)
        else:
            # Across the radius to v: the line goes up it or down.
            ax, ay = self._images[v].x, self._images[v].y
            ux, p = total(ax, rounding(ax, ay), -curve.x, rounding(curve.x, curve.y))
            uy, q = total(ay, rounding(ax, ay), -curve.y, rounding(curve.x, curve.y))
            _, _, dx, dy, _, de = self._line
            side = dot_sign(dx, dy, de, ux, uy, max(p, q)) * kind * (1 if v == e else -1)
        self.is_told = self.is_told and side != 0
        return side

    def _onward(self, e: int, v: int) -> int:
        """1 or -1 as an arc that touches the line at its end v leaves ahead or back, 0 if that is open."""
        side = self._leaves(e, v)
        return side * self._images[e].kind * (1 if v == e else -1)

    def _turn(self, u: int, v: int, w: int) -> int:
        """1 or -1 if the way over three vertices certainly turns left or right, else 0."""
        ax, ay, a = self._vector(u, v)
        bx, by, b = self._vector(v, w)
        return cross_sign(ax, ay, a, bx, by, b)

    def _vector(self, v: int, w: int) -> tuple[float, float, float]:
        """The vector from a vertex to another."""
        ax, ay, bx, by = self._images[v].x, self._images[v].y, self._images[w].x, self._images[w].y
        x, p = total(bx, rounding(bx, by), -ax, rounding(ax, ay))
        y, q = total(by, rounding(bx, by), -ay, rounding(ax, ay))
        return x, y, max(p, q)

    def _is_behind(self, v: int, w: int, sense: int) -> bool:
        """Whether of two vertices on the line the first comes before the second, as one goes."""
        return self._low(v) * sense < self._low(w) * sense

    def _low(self, v: int) -> float:
        if v == self._own and not self._is_round:
            return 0.0
        if v not in self._at:
            self.is_told = False
            return 0.0
        return self._at[v].low
