"""What a place sees from the front, in floats with bounds: faces, and the directions in which they end.

A *face* is a part of an edge that turns its free side to the place (see `exactacq.visibility.front_faces`).
Seen from the place it covers the directions counterclockwise from its low *event* to its high one. A straight
edge is one face or none: it runs clockwise, from its start s to its end t, so it is one if s x t < 0, with s
and t as offsets from the place.

Events are numbered by whoever asks: a vertex by its number, points that are no vertices by larger numbers.
Here they have *slots* besides, in the order in which they come. A slot has a vector to its event, or some
positive multiple of it; both components are held with one bound.
"""

from __future__ import annotations

from typing import Final, final

from exactacq.kernel.bounded import TINY, UNIT, WIDEN, product, quotient, root, total
from exactacq.kernel.images import REST, STRAIGHT, EdgeImages

NONE: Final = -1
"""The slot of a face's end if it has none: a full circle around the place."""


@final
class RadialFaces:
    """The faces of one place, as parallel lists.

    The place is held like a vertex: both coordinates with their rests, and a bound for what these leave.
    ``square`` is the square of the range.
    """

    def __init__(
        self,
        images: EdgeImages,
        place: tuple[float, float, float, float, float],
        square: tuple[float, float],
        own: list[int],
    ) -> None:
        self.images, self.own = images, own
        self.px, self.px_rest, self.py, self.py_rest, self.blur = place
        self.square, self.square_bound = square
        self.slots: dict[int, int] = {}
        self.events: list[int] = []
        self.x: list[float] = []
        self.y: list[float] = []
        self.bound: list[float] = []
        # Of the faces: edge, slots of both ends, and whether all of it certainly lies within range.
        self.edge: list[int] = []
        self.low: list[int] = []
        self.high: list[int] = []
        self.within: list[bool] = []
        # Of straight faces: the vector from start to end, and the product of both offsets.
        self.ax: list[float] = []
        self.ay: list[float] = []
        self.a_bound: list[float] = []
        self.turn: list[float] = []
        self.turn_bound: list[float] = []

    def offset(self, v: int) -> tuple[float, float, float]:
        """The vector from the place to a vertex, with a bound for both components: see `images`."""
        images = self.images
        x, y = images.x[v], images.y[v]
        u = (x - self.px) + (images.x_rest[v] - self.px_rest)
        w = (y - self.py) + (images.y_rest[v] - self.py_rest)
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
        """Add the faces that straight edges are, but the place's own; those whose side is open are returned.

        Left out is what certainly lies beyond the range.
        """
        images, own = self.images, self.own
        following, kinds = images.following, images.kind
        open_: list[int] = []
        last = -1
        sx = sy = s = tx = ty = t = 0.0
        for e in edges:
            if kinds[e] != STRAIGHT or e in own:
                continue
            v = following[e]
            if e == last:
                sx, sy, s = tx, ty, t
            else:
                sx, sy, s = self.offset(e)
            tx, ty, t = self.offset(v)
            last = v
            left, right = sx * ty, sy * tx
            turn = left - right
            sizes = (abs(sx) + abs(sy)) * t + (abs(tx) + abs(ty) + 2.0 * t) * s
            bound = (sizes + UNIT * (abs(left) + abs(right) + abs(turn)) + TINY) * WIDEN
            if turn > bound:
                continue
            ax, ay, a, near = self._extent(sx, sy, s, tx, ty, t, turn, bound)
            if near < 0:
                continue
            if -turn > bound:
                self._add(e, self.vertex(v, tx, ty, t), self.vertex(e, sx, sy, s), near > 0)
                self._add_line(ax, ay, a, turn, bound)
            else:
                open_.append(e)
        return open_

    def add_open(self, e: int) -> None:
        """Add the face that a straight edge is, though its side was open."""
        v = self.images.following[e]
        sx, sy, s = self.offset(e)
        tx, ty, t = self.offset(v)
        left, right = sx * ty, sy * tx
        turn = left - right
        sizes = (abs(sx) + abs(sy)) * t + (abs(tx) + abs(ty) + 2.0 * t) * s
        bound = (sizes + UNIT * (abs(left) + abs(right) + abs(turn)) + TINY) * WIDEN
        ax, ay, a, near = self._extent(sx, sy, s, tx, ty, t, turn, bound)
        self._add(e, self.vertex(v, tx, ty, t), self.vertex(e, sx, sy, s), near > 0)
        self._add_line(ax, ay, a, turn, bound)

    def add_arc(self, e: int, low: int, high: int) -> None:
        """Add a face of an arc between two events (`NONE` for none): vertices, or events that are added."""
        ends = [NONE, NONE]
        for k, event in enumerate((low, high)):
            if event >= 0:
                ends[k] = self.slots[event] if event in self.slots else self.vertex(event, *self.offset(event))
        w, wy, e_bound = self.center(e)
        far, far_bound = root(*total(*product(w, e_bound, w, e_bound), *product(wy, e_bound, wy, e_bound)))
        r = self.images.radius[e]
        far, far_bound = total(far, far_bound, r, UNIT * r)
        self._add(e, ends[0], ends[1], self.reach(far, 0.0, far_bound) > 0)
        self._add_line(0.0, 0.0, 0.0, 0.0, 0.0)

    def add_event(self, event: int, x: float, y: float, e: float) -> None:
        """Add an event with its vector; that of a vertex which is known already is replaced."""
        k = self.slots.get(event, -1)
        if k < 0:
            self.vertex(event, x, y, e)
        else:
            self.x[k], self.y[k], self.bound[k] = x, y, e

    def vertex(self, event: int, x: float, y: float, e: float) -> int:
        """The slot of an event; its vector is taken if it is new."""
        k = self.slots.get(event, -1)
        if k < 0:
            k = self.slots[event] = len(self.events)
            self.events.append(event)
            self.x.append(x)
            self.y.append(y)
            self.bound.append(e)
        return k

    def center(self, e: int) -> tuple[float, float, float]:
        """The vector from the place to an arc's centre, as `offset`."""
        images = self.images
        x, y = images.cx[e], images.cy[e]
        u = (x - self.px) + (images.cx_rest[e] - self.px_rest)
        w = (y - self.py) + (images.cy_rest[e] - self.py_rest)
        far = abs(x) + abs(y) + abs(self.px) + abs(self.py)
        return u, w, (UNIT * (abs(u) + abs(w)) + REST * far + self.blur + TINY) * WIDEN

    def tangent(self, e: int, side: int) -> tuple[float, float, float]:
        """A vector along the left (1) or right (-1) tangent from the place to a circle that it is outside of.

        With w to the centre, r the radius and h^2 = (|w| - r) (|w| + r) it is h w +- r left(w).
        """
        wx, wy, w = self.center(e)
        r = self.images.radius[e]
        far, far_bound = root(*total(*product(wx, w, wx, w), *product(wy, w, wy, w)))
        gap, gap_bound = total(far, far_bound, -r, UNIT * r)
        h, h_bound = root(*product(gap, gap_bound, *total(far, far_bound, r, UNIT * r)))
        across, across_bound = side * r, UNIT * r
        x, x_bound = total(*product(wx, w, h, h_bound), *product(-wy, w, across, across_bound))
        y, y_bound = total(*product(wy, w, h, h_bound), *product(wx, w, across, across_bound))
        return x, y, max(x_bound, y_bound)

    def way(self, f: int, dx: float, dy: float, d: float) -> tuple[float, float]:
        """How many times a vector leads from the place to a face that covers it; its components are held
        with d.

        On the line through s along a it is s x a / (d x a), and s x a = s x t. On a circle about w it is (d . w
        -+ sqrt(|d|^2 r^2 - (d x w)^2)) / |d|^2, and twice d . w / |d|^2 if the place is on it.
        """
        e = self.edge[f]
        images = self.images
        if images.kind[e] == STRAIGHT:
            ax, ay, a = self.ax[f], self.ay[f], self.a_bound[f]
            left, right = dx * ay, dy * ax
            below = left - right
            sizes = (abs(dx) + abs(dy)) * a + (abs(ax) + abs(ay) + 2.0 * a) * d
            bound = (sizes + UNIT * (abs(left) + abs(right) + abs(below)) + TINY) * WIDEN
            return quotient(self.turn[f], self.turn_bound[f], below, bound)
        wx, wy, w = self.center(e)
        square, square_bound = total(*product(dx, d, dx, d), *product(dy, d, dy, d))
        h, h_bound = total(*product(dx, d, wx, w), *product(dy, d, wy, w))
        if e in self.own:
            return quotient(2.0 * h, 2.0 * h_bound, square, square_bound)
        g, g_bound = total(*product(dx, d, wy, w), *product(-dy, d, wx, w))
        r = images.radius[e]
        size, size_bound = root(square, square_bound)
        across, across_bound = product(size, size_bound, r, UNIT * r)
        plus, plus_bound = total(across, across_bound, g, g_bound)
        minus, minus_bound = total(across, across_bound, -g, g_bound)
        half, half_bound = root(*product(plus, plus_bound, minus, minus_bound))
        top, top_bound = total(h, h_bound, -images.kind[e] * half, half_bound)
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
    ) -> tuple[float, float, float, int]:
        """The vector a from s to t with its bound, and 1 or -1 if all or none of that is within range.

        None is if both ends are beyond and the foot of the place is not between them, or if the line is too
        far: its distance is |s x t| / |a| >= |s x t| / |a|_1.
        """
        ax, ay = tx - sx, ty - sy
        size = abs(ax) + abs(ay)
        a = (s + t + UNIT * size) * WIDEN
        at_start, at_end = self.reach(sx, sy, s), self.reach(tx, ty, t)
        if at_start > 0 and at_end > 0:
            return ax, ay, a, 1
        if at_start < 0 and at_end < 0:
            over, over_bound = quotient(turn, turn_bound, size, 2.0 * a)
            if self.reach(over, 0.0, over_bound) < 0:
                return ax, ay, a, -1
            ahead = sx * ax + sy * ay
            sizes = (abs(sx) + abs(sy)) * a + (size + 2.0 * a) * s
            if ahead > (sizes + 2.0 * UNIT * (abs(sx * ax) + abs(sy * ay)) + TINY) * WIDEN:
                return ax, ay, a, -1
            behind = tx * ax + ty * ay
            sizes = (abs(tx) + abs(ty)) * a + (size + 2.0 * a) * t
            if -behind > (sizes + 2.0 * UNIT * (abs(tx * ax) + abs(ty * ay)) + TINY) * WIDEN:
                return ax, ay, a, -1
        return ax, ay, a, 0

    def _add(self, e: int, low: int, high: int, within: bool) -> None:
        self.edge.append(e)
        self.low.append(low)
        self.high.append(high)
        self.within.append(within)

    def _add_line(self, ax: float, ay: float, a: float, turn: float, bound: float) -> None:
        self.ax.append(ax)
        self.ay.append(ay)
        self.a_bound.append(a)
        self.turn.append(turn)
        self.turn_bound.append(bound)
