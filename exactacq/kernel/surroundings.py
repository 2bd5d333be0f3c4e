"""Points and circles in the frame of a family of lines, and the lines there.

Let e be the base vector divided by a power of two, its length about 1, and p the offset of a point from the
centre. The point's coordinates in the frame are (e . p, e x p). So the frame is turned, and larger by the
factor |e|, the *scale*. The base vector itself is (K, 0) there, with K, the *span*, its product with e. Lines
have simple forms: with (c, d) for contact and direction

- turning: (0, 0) and (1, t);
- rolling: K (cos, sin) and (-sin, cos), where cos = (1 - t^2) / (1 + t^2) and sin = 2 t / (1 + t^2);
- sliding: (t K, 0) and (0, 1) or (0, -1);
- normals of an arc: r |e| (1, t) / sqrt(1 + t^2) and (1, t) or (-1, -t).
"""

from __future__ import annotations

from math import sqrt
from typing import Final, final

from exactacq.kernel.bounded import TINY, UNIT, WIDEN, dot, product, root
from exactacq.kernel.images import REST, ROLLING, SLIDING, SPOKES, STRAIGHT, LineFrame
from exactacq.kernel.near_edges import NearEdges

APART: Final = 0
"""An edge that has nothing to do with the contact,"""
THROUGH: Final = 1
"""an arc through it, which its lines may meet a second time,"""
LEFT_OUT: Final = 2
"""and an edge through it that its lines do not meet elsewhere."""


@final
class FramePoint:
    """A vertex or an arc's centre in the frame: (x, y), held with ``bound``, and ``size`` = |x| + |y|."""

    def __init__(self, x: float, y: float, bound: float) -> None:
        self.x, self.y, self.bound = x, y, bound
        self.size = abs(x) + abs(y)


@final
class Surroundings:
    """The edges within reach of a family, in its frame: the ``spots`` of their vertices and the ``centers``.

    *own* are the edges through the contact, or all arcs of the circle on which it rolls; ``place[j]`` says of
    each edge whether it is `APART` from it.

    The bound: an offset o is held with b, see `exactacq.kernel.images`, and e with q. Both components of the
    product with e are held with |e|_1 b + q (|o|_1 + 2 b) for the data and 2 UNIT |e|_1 |o|_1 for three
    roundings, where | |_1 is the sum of the components' sizes.
    """

    def __init__(self, near: NearEdges, frame: LineFrame, own: tuple[int, ...]) -> None:
        self.near, self.images, self.frame = near, near.images, frame
        images = self.images
        square, bound = dot(frame.ux, frame.uy, frame.bound, frame.ux, frame.uy, frame.bound)
        self.scale, self.scale_bound = root(square, bound)
        self.span, self.span_bound = product(square, bound, frame.unit, 0.0)
        self.place = [APART] * len(near.edges)
        for e in own:
            j = near.edge(e)
            if j >= 0:
                is_out = images[e].kind == STRAIGHT or frame.kind == ROLLING
                self.place[j] = LEFT_OUT if is_out else THROUGH
        self.spots = self._spots(near.vertices, False)
        self.centers = self._spots([near.edges[j] for j in near.arcs], True)

    def _spots(self, edges: list[int], are_centers: bool) -> list[FramePoint]:
        """Vertices or centres of arcs in the frame."""
        frame = self.frame
        ux, uy, cx, cy, cx_rest, cy_rest = frame.ux, frame.uy, frame.x, frame.y, frame.x_rest, frame.y_rest
        length = abs(ux) + abs(uy)
        base, least = abs(cx) + abs(cy), frame.blur + TINY
        for_size = frame.bound + 2.0 * UNIT * length
        found: list[FramePoint] = []
        for e in edges:
            edge = self.images[e]
            if are_centers:
                px, py, px_rest, py_rest = edge.cx, edge.cy, edge.cx_rest, edge.cy_rest
            else:
                px, py, px_rest, py_rest = edge.x, edge.y, edge.x_rest, edge.y_rest
            dx = (px - cx) + (px_rest - cx_rest)
            dy = (py - cy) + (py_rest - cy_rest)
            size = abs(dx) + abs(dy)
            b = UNIT * size + REST * (abs(px) + abs(py) + base) + least
            bound = (length * b + for_size * (size + 2.0 * b) + TINY) * WIDEN
            found.append(FramePoint(ux * dx + uy * dy, ux * dy - uy * dx, bound))
        return found

    def radius(self, e: int) -> tuple[float, float]:
        """The radius of an arc, in the frame."""
        r = self.images[e].radius
        return product(self.scale, self.scale_bound, r, UNIT * r)


@final
class FrameLine:
    """A line of the family in its frame: contact (cx, cy) and direction (dx, dy) with bounds, and what
    follows.

    ``cross`` and ``dot`` are those of direction and contact, with bounds. For a point (x, y) held with p, of
    size |x| + |y| = z, the products of the direction with its offset from the contact,

        dx y - dy x - cross  and  dx x + dy y - dot,

    are held with p ``for_bound`` + z ``for_size`` + ``cross_bound`` or ``dot_bound``: for a direction held
    with d, |d|_1 p + d (z + 2 p) are the data's errors, and three roundings make at most 2 UNIT (|d|_1 z +
    |cross|).
    """

    def __init__(self, around: Surroundings, t: float, e: float) -> None:
        """The line at t, which is held with e.

        (1 - t^2) / (1 + t^2) is the cosine of the angle 2 atan t; where t is off by e, cosine and sine are
        off by at most 2 e. Roundings make at most 6 u: 1 - t^2, computed as (1 - t) (1 + t), has a relative
        error of 3 u, 1 + t^2 one of 2 u. So each is held with 3 UNIT + 2 e. Of normals of an arc, sqrt(1 +
        t^2) is held with 2 UNIT times itself + e, and the cosine and sine of atan t with 4 UNIT + e.
        """
        kind, span, wide = around.frame.kind, around.span, around.span_bound
        self.cx = self.cy = self.contact_bound = 0.0
        self.dx, self.dy, self.direction_bound = 1.0, t, e
        cross = dot = cross_bound = dot_bound = 0.0
        self.length, self.length_bound = 1.0, 0.0
        if kind == ROLLING:
            below = 1.0 + t * t
            cosine, sine = (1.0 - t) * (1.0 + t) / below, 2.0 * t / below
            bound = (3.0 * UNIT + 2.0 * e) * WIDEN
            self.cx, self.cy = span * cosine, span * sine
            self.contact_bound = (wide * (1.0 + bound) + span * (bound + UNIT) + TINY) * WIDEN
            self.dx, self.dy, self.direction_bound = -sine, cosine, bound
            cross, cross_bound = -span, wide
        elif kind == SLIDING:
            self.cx = t * span
            self.contact_bound = (abs(t) * wide + e * (span + wide) + UNIT * abs(self.cx) + TINY) * WIDEN
            self.dx, self.dy, self.direction_bound = 0.0, float(around.frame.sense), 0.0
            cross, cross_bound = -self.dy * self.cx, self.contact_bound
        else:
            self.length = sqrt(1.0 + t * t)
            self.length_bound = (2.0 * UNIT * self.length + e) * WIDEN
        if kind == SPOKES:
            r = around.frame.radius
            reach, reach_bound = product(around.scale, around.scale_bound, r, UNIT * r)
            self.cx, self.cy = reach / self.length, reach * (t / self.length)
            bound = 4.0 * UNIT + e
            self.contact_bound = (reach_bound * (1.0 + bound) + reach * (bound + 2.0 * UNIT) + TINY) * WIDEN
            dot, dot_bound = product(reach, reach_bound, self.length, self.length_bound)
            if around.frame.sense < 0:
                self.dx, self.dy, dot = -self.dx, -self.dy, -dot
        one, d = abs(self.dx) + abs(self.dy), self.direction_bound
        self.for_bound = (one + 2.0 * d) * WIDEN
        self.for_size = (d + 2.0 * UNIT * one) * WIDEN
        self.cross, self.dot = cross, dot
        self.cross_bound = (cross_bound + 2.0 * UNIT * abs(cross) + TINY) * WIDEN
        self.dot_bound = (dot_bound + 2.0 * UNIT * abs(dot) + TINY) * WIDEN
        self.contact_size = abs(self.cx) + abs(self.cy)
