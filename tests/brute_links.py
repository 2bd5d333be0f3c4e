"""Independent of the library: whether a segment is free, and v(i, j) between polygons by brute force."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations, pairwise

import mpmath
from oracles import Disc, Room, free
from strategies import Pair

Q = Fraction


mp = mpmath.mp.clone()
mp.dps = 70
FINE = mp.mpf(10) ** -30


class Loops:
    """The shapes as chords and arcs in 70 digits: (ax, ay, bx, by, bulge, centre x, centre y, radius)."""

    def __init__(self, shapes: Sequence[object]) -> None:
        self.loops = [self._loop(shape) for shape in shapes]
        self.rooms = [isinstance(shape, Room) for shape in shapes]

    @staticmethod
    def _loop(shape: object) -> list[tuple]:
        if isinstance(shape, Disc):
            x, y, r = (Q(c) for c in shape)
            shape = [(x + r, y, 1), (x - r, y, 1)]
        vertices = shape.vertices if isinstance(shape, Room) else shape
        edges = []
        for k, (*start, bulge) in enumerate((*map(Q, v), *[Q(0)] * (3 - len(v))) for v in vertices):
            x, y = start
            u, v = (Q(c) for c in vertices[(k + 1) % len(vertices)][:2])
            data = [x, y, u, v, bulge]
            if bulge:
                away = (1 - bulge**2) / (4 * bulge)
                cx, cy = (x + u) / 2 - (v - y) * away, (y + v) / 2 + (u - x) * away
                data += [cx, cy, (x - cx) ** 2 + (y - cy) ** 2]
            edges.append(tuple(mp.mpf(c.numerator) / c.denominator for c in data))
        return edges

    def gap(self, k: int, x: object, y: object) -> object:
        """Distance of a point from boundary k."""
        return min(_distance(edge, x, y) for edge in self.loops[k])

    def is_inside(self, k: int, x: object, y: object) -> bool:
        """Whether a point lies on the blocked side of boundary k, deeper than `FINE`."""
        if self.gap(k, x, y) < FINE:
            return False
        turns = 0
        for ax, ay, bx, by, bulge, *circle in self.loops[k]:
            side = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
            if abs(side) < FINE:  # as if the point were a little to the west, and much less to the north
                side = (by - ay) or (bx - ax)
            if (ay > y) != (by > y):
                turns += (1 if by > ay else -1) * ((side > 0) == (by > ay))
            if bulge:
                cx, cy, square = circle
                within = (x - cx) ** 2 + (y - cy) ** 2 < square
                turns += (1 if bulge > 0 else -1) * (within and (side < 0) == (bulge > 0))
        return (turns == 0) == self.rooms[k]

    def is_free(self, p: Sequence, q: Sequence) -> bool:
        """Whether the open segment dips nowhere deeper than `FINE`."""
        for k, loop in enumerate(self.loops):
            cuts = sorted({mp.mpf(0), mp.mpf(1), *(t for edge in loop for t in _cuts(edge, p, q))})
            for a, b in pairwise(cuts):
                t = (a + b) / 2
                if b - a > FINE and self.is_inside(k, p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t):
                    return False
        return True


def _distance(edge: tuple, x: object, y: object) -> object:
    ax, ay, bx, by, bulge, *circle = edge
    ends = min(mp.hypot(x - ax, y - ay), mp.hypot(x - bx, y - by))
    side = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    if bulge:
        cx, cy, square = circle
        size, radius = mp.hypot(x - cx, y - cy), mp.sqrt(square)
        if size == 0:
            return radius
        fx, fy = cx + (x - cx) * radius / size, cy + (y - cy) * radius / size
        on = (bx - ax) * (fy - ay) - (by - ay) * (fx - ax)
        return min(ends, abs(size - radius)) if (on < 0) == (bulge > 0) else ends
    square = (bx - ax) ** 2 + (by - ay) ** 2
    along = (x - ax) * (bx - ax) + (y - ay) * (by - ay)
    return abs(side) / mp.sqrt(square) if 0 <= along <= square else ends


def _cuts(edge: tuple, p: Sequence, q: Sequence) -> Iterator[object]:
    """Where the segment crosses an edge's line or circle, and the feet of the edge's ends."""
    ax, ay, bx, by, bulge, *circle = edge
    (px, py), (qx, qy) = p, q
    dx, dy = qx - px, qy - py
    square = dx * dx + dy * dy
    if square == 0:
        return
    found = [((ax - px) * dx + (ay - py) * dy) / square]
    if bulge:
        cx, cy, radius_sq = circle
        middle = ((cx - px) * dx + (cy - py) * dy) / square
        height = (cx - px) * dy - (cy - py) * dx
        half = mp.sqrt(max(radius_sq / square - (height / square) ** 2, 0))
        found += [middle - half, middle + half]
    else:
        below = dx * (by - ay) - dy * (bx - ax)
        if abs(below) > FINE:
            found.append(((ax - px) * (by - ay) - (ay - py) * (bx - ax)) / below)
    yield from (t for t in found if 0 < t < 1)


def brute_force(shapes: Sequence[Sequence[tuple]], i: int, j: int, radius: object) -> object | None:
    """v(i, j) of polygons with integer corners: the shortest free candidate, or None."""
    loops = Loops(shapes)
    corners = [(Q(x), Q(y)) for shape in shapes for x, y, *_ in shape]
    left, right = ([tuple(map(Q, edge[:4])) for edge in _exact_edges(shapes[k])] for k in (i, j))
    chords = [(p, q) for p in _starts(left) for q in _starts(right)]
    chords += [(p, f) for p in _starts(left) for e in right if (f := _foot(p, e))]
    chords += [(f, q) for q in _starts(right) for e in left if (f := _foot(q, e))]
    for c, d in combinations(corners, 2):
        if c != d:
            chords += [(p, q) for e in left for f in right for p in _on(c, d, e) for q in _on(c, d, f)]
    exact = {pair for pair in chords if _square(*pair) <= Q(radius) ** 2}
    found = [tuple((mp.mpf(c.numerator) / c.denominator for c in p) for p in pair) for pair in exact]
    found = [tuple(tuple(p) for p in pair) for pair in found]
    third = [(Q(x), Q(y)) for k, s in enumerate(shapes) if k not in (i, j) for x, y, *_ in s]
    found += [pair for c in set(third) for e in left for f in right for pair in _stationary(c, e, f)]
    lengths = [(mp.hypot(p[0] - q[0], p[1] - q[1]), p, q) for p, q in found]
    for length, p, q in sorted(lengths):
        if length > radius + FINE:
            return None
        if free(shapes, p, q, 1e-6) and loops.is_free(p, q):  # the float test is only quick
            return length
    return None


def _exact_edges(shape: Sequence[tuple]) -> list[tuple]:
    return [(*shape[k][:2], *shape[(k + 1) % len(shape)][:2]) for k in range(len(shape))]


def _starts(edges: Sequence[tuple]) -> list[Pair]:
    return [edge[:2] for edge in edges]


def _square(p: Pair, q: Pair) -> Fraction:
    return (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2


def _foot(p: Pair, edge: tuple) -> Pair | None:
    ax, ay, bx, by = edge
    t = ((p[0] - ax) * (bx - ax) + (p[1] - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2)
    return (ax + t * (bx - ax), ay + t * (by - ay)) if 0 <= t <= 1 else None


def _on(c: Pair, d: Pair, edge: tuple) -> list[Pair]:
    """Where the line through two points meets an edge; both ends if it contains the edge."""
    ax, ay, bx, by = edge
    a = (d[0] - c[0]) * (ay - c[1]) - (d[1] - c[1]) * (ax - c[0])
    b = (d[0] - c[0]) * (by - c[1]) - (d[1] - c[1]) * (bx - c[0])
    if a == b == 0:
        return [(ax, ay), (bx, by)]
    if a * b > 0:
        return []
    t = a / (a - b)
    return [(ax + t * (bx - ax), ay + t * (by - ay))]


def _stationary(c: Pair, e: tuple, f: tuple) -> Iterator[tuple]:
    """Chords from line e through a corner to line f, of stationary length: directions (1, t) and (t, 1)."""
    for swap in (False, True):
        lines = []
        for ax, ay, bx, by in (e, f):
            n = (by - ay, ax - bx)
            o = n[0] * (ax - c[0]) + n[1] * (ay - c[1])
            lines.append((o, *(reversed(n) if swap else n)))
        (o1, a1, b1), (o2, a2, b2) = lines
        # length / sqrt(1 + t^2) = o2 / (a2 + b2 t) - o1 / (a1 + b1 t)
        one, two = [a1, b1], [a2, b2]
        terms = [
            _times([o2], [0, 1], two, one, one),
            _times([-o1], [0, 1], one, two, two),
            _times([-o2 * b2], [1, 0, 1], one, one),
            _times([o1 * b1], [1, 0, 1], two, two),
        ]
        size = max(map(len, terms))
        polynomial = [sum((t[k] for t in terms if k < len(t)), Q(0)) for k in range(size)]
        while polynomial and polynomial[-1] == 0:
            polynomial.pop()
        if len(polynomial) < 2:
            continue
        top = [mp.mpf(k.numerator) / k.denominator for k in reversed(polynomial)]
        for root in mp.polyroots(top, maxsteps=500, extraprec=1000, error=False):
            if abs(mp.im(root)) < mp.mpf(10) ** -40:
                t = mp.re(root)
                ends = []
                for (o, a, b), edge in zip(lines, (e, f), strict=True):
                    below = mp.mpf(a.numerator) / a.denominator + t * mp.mpf(b.numerator) / b.denominator
                    if abs(below) < FINE:
                        break
                    tau = mp.mpf(o.numerator) / o.denominator / below
                    x, y = (t, mp.mpf(1)) if swap else (mp.mpf(1), t)
                    cx, cy = (mp.mpf(k.numerator) / k.denominator for k in c)
                    point = (cx + tau * x, cy + tau * y)
                    exact = tuple(mp.mpf(q.numerator) / q.denominator for q in edge)
                    if _distance((*exact, 0), *point) > FINE:
                        break
                    ends.append((tau, point))
                if len(ends) == 2 and ends[0][0] * ends[1][0] < 0:
                    yield ends[0][1], ends[1][1]


def _times(*factors: list) -> list:
    product = [Q(1)]
    for factor in factors:
        out = [Q(0)] * (len(product) + len(factor) - 1)
        for i, a in enumerate(product):
            for j, b in enumerate(factor):
                out[i + j] += a * b
        product = out
    return product
