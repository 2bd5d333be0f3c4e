"""What a line meets, on both sides of its contact, up to what blocks it.

Which vertices the line passes and which arcs it touches is known by name. Floats with bounds (see
`kernel.bounded`) tell the rest: on which sides of the line other vertices lie, where it crosses edges, and in
which order it meets all this. Where one of these is open, or an arc ends on the line, nothing is told.
"""

from __future__ import annotations

from math import inf
from typing import Final, final

from exactacq.kernel.bound_lines import NOTHING
from exactacq.kernel.bounded import TINY, UNIT, cross, dot, product, quotient, root, total, verdict
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.images import CONVEX, STRAIGHT, EdgeImages
from exactacq.kernel.lines import Line, meets_straight, side_of

TOUCHED: Final = -1
CROSSED: Final = -2
"""How an edge is met that is not met at a vertex."""
Hit = tuple[int, int]
"""An edge that is met, and the vertex where it is met, or how it is."""


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
    passes, *touched* the arcs. The contact is the vertex *own* or, with *is_round*, on the arc *own*. What
    is farther than *reach* is left out, but for the end of an edge along the line. If floats leave anything
    open, the line is not told of: ``is_told`` is false.
    """

    def __init__(
        self,
        images: EdgeImages,
        curves: list[CurveImage],
        edges: list[int],
        line: Line,
        passed: set[int],
        touched: set[int],
        own: int,
        is_round: bool,
        reach: float,
    ) -> None:
        self._images, self._curves, self._line = images, curves, line
        self._passed, self._touched = passed, touched
        self._own, self._is_round, self._reach = own, is_round, reach
        self._size = root(*dot(line[2], line[3], line[5], line[2], line[3], line[5]))
        self._sides: dict[int, int] = {}
        self._at: dict[int, GrazedPlace] = {}
        self._spots: list[GrazedPlace] = []
        self.is_told = True
        self.ahead: list[Hit] = []
        self.behind: list[Hit] = []
        self.is_blocked_ahead = False
        self.is_blocked_behind = False
        for e in edges:
            if images.kind[e] == STRAIGHT:
                self._meet_straight(e)
            else:
                self._meet_round(e)
            if not self.is_told:
                return
        self.is_blocked_ahead = self._follow(1, self.ahead)
        self.is_blocked_behind = self._follow(-1, self.behind)

    # -- what is met -----------------------------------------------------------------------------

    def _meet_straight(self, e: int) -> None:
        v, w = e, self._images.following[e]
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
        if e not in self._touched:
            for far, bound in self._crossings(e):
                self._add(far, bound, CROSSED, e)
            return
        if not self._images.full[e] and (self._side(e) == 0 or self._side(self._images.following[e]) == 0):
            self.is_told = False  # At an end of the arc one place would have two names.
        elif not (self._is_round and e == self._own):
            curve = self._curves[e]
            foot, bound = self._along(curve.x, curve.y)
            side = self._beyond_chord(e, foot, bound)
            if side > 0:
                self._add(foot, bound, TOUCHED, e)
            self.is_told = self.is_told and side != 0

    def _crossings(self, e: int) -> list[tuple[float, float]]:
        """Where the line crosses an arc that it does not touch, as far as its circle is met on the arc."""
        images, curve = self._images, self._curves[e]
        x, y, dx, dy, ce, de = self._line
        ox, p = total(curve.x, _rounding(curve.x, curve.y), -x, ce)
        oy, q = total(curve.y, _rounding(curve.x, curve.y), -y, ce)
        height, bound = quotient(*cross(dx, dy, de, ox, oy, max(p, q)), *self._size)
        radius, blur = curve.radius, UNIT * curve.radius
        under, under_bound = product(
            *total(radius, blur, height, bound), *total(radius, blur, -height, bound)
        )
        if -under > under_bound:
            return []
        if not images.full[e] and (self._side(e) == 0 or self._side(images.following[e]) == 0):
            self.is_told = False
            return []
        half, half_bound = root(under, under_bound)
        middle, middle_bound = self._along(curve.x, curve.y)
        found: list[tuple[float, float]] = []
        for sign in (-1.0, 1.0):
            far, far_bound = total(middle, middle_bound, sign * half, half_bound)
            side = self._beyond_chord(e, far, far_bound)
            if side == 0 or under <= under_bound:
                self.is_told = False
            elif side > 0:
                found.append((far, far_bound))
        return found

    def _beyond_chord(self, e: int, far: float, bound: float) -> int:
        """1 if a place of an arc's circle on the line certainly is on the arc, -1 if it is not, else 0."""
        if self._images.full[e]:
            return 1
        x, y, dx, dy, ce, de = self._line
        step, step_bound = quotient(far, bound, *self._size)
        px, p = total(x, ce, *product(dx, de, step, step_bound))
        py, q = total(y, ce, *product(dy, de, step, step_bound))
        ax, ay = self._images.x[e], self._images.y[e]
        ux, uy, u = self._vector(e, self._images.following[e])
        vx, r = total(px, p, -ax, _rounding(ax, ay))
        vy, s = total(py, q, -ay, _rounding(ax, ay))
        return -self._images.kind[e] * verdict(*cross(ux, uy, u, vx, vy, max(r, s)))

    def _side(self, v: int) -> int:
        """1 or -1 for a vertex left or right of the line, 0 for one on it, or if that is open."""
        if v in self._passed:
            return 0
        side = self._sides.get(v, 0)
        if side == 0:
            x, y = self._images.x[v], self._images.y[v]
            side = self._sides[v] = side_of(self._line, x, y, _rounding(x, y), 0.0)
            self.is_told = self.is_told and side != 0
        return side

    def _along(self, x: float, y: float) -> tuple[float, float]:
        """How far along the line the foot of a place of the scene is, in lengths."""
        cx, cy, dx, dy, ce, de = self._line
        ox, p = total(x, _rounding(x, y), -cx, ce)
        oy, q = total(y, _rounding(x, y), -cy, ce)
        return quotient(*dot(ox, oy, max(p, q), dx, dy, de), *self._size)

    def _add_vertex(self, v: int, e: int) -> None:
        if v in self._at:
            self._at[v].edges.append(e)
        elif v == self._own and not self._is_round:
            return
        else:
            self._add(*self._along(self._images.x[v], self._images.y[v]), v, e)
            self._at[v] = self._spots[-1]

    def _add(self, far: float, bound: float, vertex: int, e: int) -> None:
        self._spots.append(GrazedPlace(far - bound, far + bound, vertex, e))
        self.is_told = self.is_told and (far - bound > 0.0 or far + bound < 0.0) and bound < inf

    # -- as far as it is free ----------------------------------------------------------------------

    def _follow(self, sense: int, hits: list[Hit]) -> bool:
        """Collect what is met ahead (1) or behind (-1) up to what blocks the line; whether anything does."""
        order = [
            (s.low if sense > 0 else -s.high, k) for k, s in enumerate(self._spots) if s.low * sense > 0.0
        ]
        order.sort()
        last = 0.0
        vertex = NOTHING if self._is_round else self._own
        for near, k in order:
            spot = self._spots[k]
            is_far = near > self._reach
            if is_far and not self._are_joined(vertex, spot.vertex):
                return False
            if near <= last:
                self.is_told = False
                return False
            last, vertex = (spot.high if sense > 0 else -spot.low), spot.vertex
            edges = spot.edges if sense > 0 else spot.edges[::-1]
            for e in edges:
                hits.append((e, vertex))
            if is_far:
                return False
            if vertex == CROSSED or (vertex >= 0 and self._blocks(vertex, sense)):
                return True
            if vertex == TOUCHED and self._images.kind[spot.edges[0]] != CONVEX:
                self.is_told = False
        return False

    def _are_joined(self, v: int, w: int) -> bool:
        """Whether a straight edge joins two vertices."""
        following, kind = self._images.following, self._images.kind
        if v < 0 or w < 0:
            return False
        return (following[v] == w and kind[v] == STRAIGHT) or (following[w] == v and kind[w] == STRAIGHT)

    def _blocks(self, v: int, sense: int) -> bool:
        """Whether the line, free up to a vertex, enters the obstacle there.

        An obstacle lies to the left of its edges.
        """
        before, after = self._images.previous[v], self._images.following[v]
        last, following = self._side(before) * sense, self._side(after) * sense
        if not self.is_told:
            return False
        if last and following:
            if last != following:
                return True
            self.is_told = self._turn(before, v, after) > 0
            return False
        if not last and not following:
            self.is_told = self._is_behind(before, v, sense) != self._is_behind(after, v, sense)
            return False
        # One edge lies along the line. The obstacle is to its left; as one goes, that may be to the right.
        goes_on = following == 0
        is_behind = self._is_behind(after if goes_on else before, v, sense)
        inner = 1 if goes_on != is_behind else -1
        side = last if goes_on else following
        if is_behind:
            return side != inner
        self.is_told = side == inner
        return False

    def _turn(self, u: int, v: int, w: int) -> int:
        """1 or -1 if the way over three vertices certainly turns left or right, else 0."""
        ax, ay, a = self._vector(u, v)
        bx, by, b = self._vector(v, w)
        return verdict(*cross(ax, ay, a, bx, by, b))

    def _vector(self, v: int, w: int) -> tuple[float, float, float]:
        """The vector from a vertex to another."""
        ax, ay, bx, by = self._images.x[v], self._images.y[v], self._images.x[w], self._images.y[w]
        x, p = total(bx, _rounding(bx, by), -ax, _rounding(ax, ay))
        y, q = total(by, _rounding(bx, by), -ay, _rounding(ax, ay))
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


def _rounding(x: float, y: float) -> float:
    """How far off the nearest floats of a place of the scene are."""
    return UNIT * max(abs(x), abs(y)) + TINY
