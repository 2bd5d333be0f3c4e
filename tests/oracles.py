"""Float oracles: shortest visible segments by brute force, and the Sightseer Strategy simulated on them.

Nothing here shares code with the library: plain numbers in, plain numbers out. A *shape* is a list of
vertices ``(x, y)`` or ``(x, y, bulge)``, a `Disc`, or (at most one) a `Room`, which is blocked outside.
Obstacles are disjoint. Answers are good to about 1e-12 of the scene's size in generic scenes; where two
candidates differ by less than the tolerance of `free`, ask with two tolerances and compare (`ambiguous`).

Two methods find the shortest visible segment. `shortest_visible` enumerates what can be a minimum:
unobstructed local minima, chords tangent to one feature (a corner is a circle of radius 0) minimised over
their angle, and chords along the common tangents of two features. `shortest_by_sampling` knows nothing of
that: it samples both boundaries and improves the best free pair by a random search that stays free.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

Floats = NDArray[np.float64]
TAU = 2 * math.pi
GRAZE = 1e-9  # dips up to this deep count as grazing
OFF_BOUNDARY = 1e-10  # chords that start or end farther away do not count
ON_LINE = 1e-9  # a vertex this close to a chord cuts it (more cuts do no harm)


class Disc(NamedTuple):
    """A full circle."""

    x: object
    y: object
    r: object


class Room(NamedTuple):
    """An enclosure: blocked outside the loop."""

    vertices: Sequence[tuple]


class Chord(NamedTuple):
    """A segment between two boundaries."""

    length: float
    start: tuple[float, float]
    end: tuple[float, float]

    def reversed(self) -> Chord:
        return Chord(self.length, self.end, self.start)


def cross(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def unit(angle: Floats) -> Floats:
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


class World:
    """The edges of all shapes as float arrays, blocked side on the left; arcs are cut where y is extreme.

    ``r == 0`` marks a straight edge; ``a0`` and ``sweep`` are an arc's first angle and signed included angle.
    """

    def __init__(self, shapes: Sequence[object]) -> None:
        rows: list[tuple] = []
        self.room = any(isinstance(shape, Room) for shape in shapes)
        self.count = len(shapes)
        for owner, shape in enumerate(shapes):
            rows += [(owner, *edge) for edge in _edges(shape)]
        self.owner = np.array([row[0] for row in rows])
        self.a, self.b, self.c = (np.array([row[k] for row in rows], dtype=float) for k in (1, 2, 3))
        self.r, self.a0, self.sweep = (np.array([row[k] for row in rows], dtype=float) for k in (4, 5, 6))
        self.true_start = np.array([row[7] for row in rows], dtype=bool)
        chord = np.hypot(*(self.b - self.a).T)
        self.length = np.where(self.r > 0, self.r * np.abs(self.sweep), chord)
        self.ids = [np.flatnonzero(self.owner == k) for k in range(self.count)]
        self.all_ids = np.arange(len(rows))

    def perimeter(self, i: int) -> float:
        return float(self.length[self.ids[i]].sum())

    def at(self, i: int, s: float) -> tuple[float, float]:
        """The boundary point of shape i at arc length s from the loop's first vertex, blocked side left."""
        s %= self.perimeter(i)
        *before, e = self.ids[i]
        for one in before:
            if s <= self.length[one]:
                e = one
                break
            s -= self.length[one]
        # A sum of rounded lengths may exceed the last edge by round-off: that is its end.
        u = min(s / self.length[e], 1.0)
        if self.r[e] == 0:
            point = self.a[e] + u * (self.b[e] - self.a[e])
        else:
            point = self.c[e] + self.r[e] * unit(self.a0[e] + u * self.sweep[e])
        return float(point[0]), float(point[1])

    def position(self, i: int, point: tuple[float, float]) -> float:
        """The arc length at which the boundary of shape i is nearest to the point."""
        ids = self.ids[i]
        gaps = self.distances(np.array([point], dtype=float), ids)[0]
        k = int(gaps.argmin())
        e = ids[k]
        here = np.array(point, dtype=float) - (self.a[e] if self.r[e] == 0 else self.c[e])
        if self.r[e] == 0:
            u = here @ (self.b[e] - self.a[e]) / self.length[e] ** 2
        else:
            turn = (math.atan2(here[1], here[0]) - self.a0[e]) * np.sign(self.sweep[e]) % TAU
            u = 0.0 if turn > (TAU + abs(self.sweep[e])) / 2 else turn / abs(self.sweep[e])
        return float(self.length[ids[:k]].sum() + min(max(u, 0.0), 1.0) * self.length[e])

    def distances(self, points: Floats, ids: NDArray[np.int64]) -> Floats:
        """Distance of every point to every edge."""
        a, b, c, r = self.a[ids], self.b[ids], self.c[ids], self.r[ids]
        p = points[:, None, :]
        along = b - a
        squared = np.where(r > 0, 1.0, (along**2).sum(-1))
        u = np.clip(((p - a) * along).sum(-1) / squared, 0, 1)
        straight = np.hypot(*np.moveaxis(p - (a + u[..., None] * along), -1, 0))
        ray = p - c
        turn = (np.arctan2(ray[..., 1], ray[..., 0]) - self.a0[ids]) * np.sign(self.sweep[ids]) % TAU
        ends = np.minimum(np.hypot(*np.moveaxis(p - a, -1, 0)), np.hypot(*np.moveaxis(p - b, -1, 0)))
        radial = np.abs(np.hypot(*np.moveaxis(ray, -1, 0)) - r)
        round_ = np.where(turn <= np.abs(self.sweep[ids]), radial, ends)
        return np.where(r > 0, round_, straight)

    def blocked(self, points: Floats) -> NDArray[np.bool_]:
        """Which points lie inside an obstacle (crossings of a ray to the east; unreliable on boundaries)."""
        px, py = points[:, 0, None], points[:, 1, None]
        a, b = self.a, self.b
        spans = (a[:, 1] <= py) != (b[:, 1] <= py)
        rise = np.where(b[:, 1] == a[:, 1], 1.0, b[:, 1] - a[:, 1])
        x_line = a[:, 0] + (py - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
        middle = self.a0 + self.sweep / 2
        half = np.sqrt(np.maximum(self.r**2 - (py - self.c[:, 1]) ** 2, 0))
        x_arc = self.c[:, 0] + np.sign(np.cos(middle)) * half
        x = np.where(self.r > 0, x_arc, x_line)
        odd = (spans & (x > px)).sum(axis=1) % 2 == 1
        return ~odd if self.room else odd

    def line_hits(self, p: Floats, d: Floats, ids: NDArray[np.int64], slack: float = 1e-12) -> Floats:
        """Parameters t at which the lines p + t d meet the edges: shape (lines, edges, 2), NaN for no hit."""
        a, along, r = self.a[ids], self.b[ids] - self.a[ids], self.r[ids]
        p, d = p[:, None, :], d[:, None, :]
        with np.errstate(divide="ignore", invalid="ignore"):
            det = cross(d, along)
            t, u = cross(a - p, along) / det, cross(a - p, d) / det
            t = np.where((r == 0) & (np.abs(u - 0.5) <= 0.5 + slack) & (det != 0), t, np.nan)
            out = np.stack([t, np.full_like(t, np.nan)], axis=-1)
            arcs = np.flatnonzero(r > 0)
            if len(arcs):
                ray, dd = self.c[ids][arcs] - p, (d**2).sum(-1)
                foot = (ray * d).sum(-1) / dd
                root = np.sqrt(r[arcs] ** 2 / dd - (cross(ray, d) / dd) ** 2)
                both = np.stack([foot - root, foot + root], axis=-1)
                spot = p[:, :, None, :] + both[..., None] * d[:, :, None, :] - self.c[ids][arcs][:, None, :]
                sweep = self.sweep[ids][arcs][:, None]
                angle = np.arctan2(spot[..., 1], spot[..., 0]) - self.a0[ids][arcs][:, None]
                turn = angle * np.sign(sweep) % TAU
                keep = (turn <= np.abs(sweep) + slack) | (turn >= TAU - slack)
                out[:, arcs] = np.where(keep, both, np.nan)
        return out

    def edge_hit(self, p: Floats, d: Floats, edge: NDArray[np.int64], root: NDArray[np.int64]) -> Floats:
        """Row by row: where the line p + t d (d of length 1) meets the line or circle of its edge."""
        a, along, r = self.a[edge], self.b[edge] - self.a[edge], self.r[edge]
        with np.errstate(divide="ignore", invalid="ignore"):
            straight = cross(a - p, along) / cross(d, along)
            ray = self.c[edge] - p
            half = np.sqrt(np.maximum(r**2 - cross(ray, d) ** 2, 0))
            return np.where(r > 0, (ray * d).sum(-1) + np.where(root == 1, half, -half), straight)

    def depth(self, p: Floats, q: Floats) -> Floats:
        """How deep each segment p q dips into an obstacle's interior (0: it does not)."""
        d = q - p
        length = np.hypot(d[:, 0], d[:, 1])
        cuts = self.line_hits(p, d, self.all_ids).reshape(len(p), -1)
        with np.errstate(divide="ignore", invalid="ignore"):
            ray = self.a - p[:, None, :]
            foot = (ray * d[:, None, :]).sum(-1) / length[:, None] ** 2
            aside = np.abs(cross(ray, d[:, None, :])) / length[:, None]
            foot = np.where(aside < ON_LINE, foot, np.nan)
        rim = np.tile([0.0, 1.0], (len(p), 1))
        cuts = np.concatenate([rim, cuts, foot], axis=1)
        cuts = np.sort(np.where((cuts >= 0) & (cuts <= 1), cuts, np.nan), axis=1)
        cuts = cuts[:, : max(2, int((~np.isnan(cuts)).sum(axis=1).max()))]
        row, k = np.nonzero((cuts[:, 1:] - cuts[:, :-1]) * length[:, None] > 1e-12)
        deepest = np.zeros(len(p))
        for share in (0.5, 0.23, 0.81):
            t = cuts[row, k] + share * (cuts[row, k + 1] - cuts[row, k])
            points = p[row] + t[:, None] * d[row]
            inside = self.blocked(points)
            if inside.any():
                gap = self.distances(points[inside], self.all_ids).min(axis=1)
                np.maximum.at(deepest, row[inside], gap)
        return deepest


def _edges(shape: object) -> list[tuple]:
    """Rows (a, b, centre, r, a0, sweep, starts at a true vertex) of one loop, blocked side on the left."""
    if isinstance(shape, Disc):
        x, y, r = (float(v) for v in shape)
        low, high = (x, y - r), (x, y + r)
        return [
            (low, high, (x, y), r, -math.pi / 2, math.pi, False),
            (high, low, (x, y), r, math.pi / 2, math.pi, False),
        ]
    loop = shape.vertices if isinstance(shape, Room) else shape
    vertices = [tuple(float(v) for v in (*vertex, 0)[:3]) for vertex in loop]
    if (signed_area(vertices) < 0) != isinstance(shape, Room):
        vertices = reverse_loop(vertices)
    rows: list[tuple] = []
    for (ax, ay, bulge), (bx, by, _) in zip(vertices, vertices[1:] + vertices[:1], strict=True):
        if bulge == 0:
            rows.append(((ax, ay), (bx, by), (0.0, 0.0), 0.0, 0.0, 0.0, True))
            continue
        centre, r, a0, sweep = arc_of(ax, ay, bx, by, bulge)
        sign = math.copysign(1, sweep)
        turns = sorted((quarter - a0) * sign % TAU for quarter in (math.pi / 2, -math.pi / 2))
        stops = [0.0, *(turn for turn in turns if 1e-9 < turn < abs(sweep) - 1e-9), abs(sweep)]
        for k, (low, high) in enumerate(pairwise(stops)):
            ends = []
            for turn in (low, high):
                angle = a0 + sign * turn
                ends.append((centre[0], centre[1] + math.copysign(r, math.sin(angle))))
            start = (ax, ay) if k == 0 else ends[0]
            end = (bx, by) if high == stops[-1] else ends[1]
            rows.append((start, end, centre, r, a0 + sign * low, sign * (high - low), k == 0))
    return rows


def arc_of(
    ax: float, ay: float, bx: float, by: float, bulge: float
) -> tuple[tuple[float, float], float, float, float]:
    """Centre, radius, first angle and signed included angle of a bulged edge."""
    shift = (1 - bulge**2) / (4 * bulge)  # of the centre from the middle, in chords, to the left
    centre = ((ax + bx) / 2 - shift * (by - ay), (ay + by) / 2 + shift * (bx - ax))
    r = math.hypot(bx - ax, by - ay) * (1 + bulge**2) / (4 * abs(bulge))
    return centre, r, math.atan2(ay - centre[1], ax - centre[0]), 4 * math.atan(bulge)


def signed_area(vertices: Sequence[tuple[float, float, float]]) -> float:
    """Positive for a counterclockwise loop, bulges included."""
    total = 0.0
    for (ax, ay, bulge), (bx, by, _) in zip(vertices, [*vertices[1:], vertices[0]], strict=True):
        total += (ax * by - ay * bx) / 2
        if bulge:
            _, r, _, sweep = arc_of(ax, ay, bx, by, bulge)
            total += r * r * (sweep - math.sin(sweep)) / 2
    return total


def reverse_loop(vertices: Sequence[tuple]) -> list[tuple]:
    """The same loop in the other direction."""
    n = len(vertices)
    bulges = [(*v, 0)[2] for v in vertices]
    return [(*vertices[-k][:2], -bulges[(-k - 1) % n]) for k in range(n)]


@lru_cache(maxsize=8)
def _world(key: tuple) -> World:
    return World([Room(item[1]) if item[0] == "room" else item[1] for item in key])


def world(shapes: Sequence[object]) -> World:
    """The float edges of the shapes, remembered."""
    key = []
    for shape in shapes:
        if isinstance(shape, Room):
            key.append(("room", tuple(map(tuple, shape.vertices))))
        else:
            key.append(("shape", shape if isinstance(shape, Disc) else tuple(map(tuple, shape))))
    return _world(tuple(key))


def free(shapes: Sequence[object], p: Sequence[float], q: Sequence[float], tol: float = GRAZE) -> bool:
    """Whether the open segment dips nowhere deeper than `tol` into an obstacle: grazing is free."""
    ends = (np.array([[float(v) for v in point]]) for point in (p, q))
    return bool(world(shapes).depth(*ends)[0] <= tol)


def free_by_shapely(shapes: Sequence[object], p: Sequence[float], q: Sequence[float], tol: float) -> bool:
    """The same with GEOS, on arcs cut into 400 chords and obstacles shrunk by `tol`."""
    line = shapely.LineString([tuple(map(float, p)), tuple(map(float, q))])
    return not any(shapely.intersects(line, region) for region in _shrunk(shapes, tol))


def _shrunk(shapes: Sequence[object], tol: float) -> list[shapely.Geometry]:
    w = world(shapes)
    regions = []
    for i, shape in enumerate(shapes):
        points: list[tuple[float, float]] = []
        for e in w.ids[i]:
            if w.r[e] == 0:
                points.append(tuple(w.a[e]))
            else:
                angles = w.a0[e] + w.sweep[e] * np.linspace(0, 1, 400, endpoint=False)
                points += [tuple(spot) for spot in w.c[e] + w.r[e] * unit(angles)]
        region = shapely.Polygon(points)
        if isinstance(shape, Room):
            region = region.buffer(100 * math.sqrt(region.area)).difference(region)
        regions.append(region.buffer(-tol))
    return regions


# Shortest visible segments: every candidate for a minimum.


def shortest_visible(
    shapes: Sequence[object], i: int | Sequence[float], j: int, radius: float, tol: float = GRAZE
) -> Chord | None:
    """The shortest free segment, at most `radius` long, from boundary i (or from a point) to boundary j."""
    w = world(shapes)
    node_i, node_j = _Node(w, i), _Node(w, j)
    reach = float(radius) * (1 + 1e-12)
    best = _first_free(node_i, node_j, _unobstructed(node_i, node_j) + _samples(node_i, node_j), reach, tol)
    bound = reach if best is None else best.length
    features = _features(w, node_i, node_j, bound)
    held = _held_by_two(w, node_i, node_j, features, bound)
    if len(features[0]) and node_i.index is not None:
        held += _held_by_one(w, node_i, node_j, features, bound)
    found = _first_free(node_i, node_j, held, bound, tol)
    return best if found is None else found


class _Node:
    """A boundary, or a lone point, as one end of chords."""

    def __init__(self, w: World, which: int | Sequence[float]) -> None:
        self.world = w
        self.index = int(which) if isinstance(which, int | np.integer) else None
        if self.index is None:
            self.ids = np.zeros(0, dtype=np.int64)
            self.vertices = np.array([[float(v) for v in which]])
        else:
            self.ids = w.ids[self.index]
            self.vertices = w.a[self.ids]

    def distances(self, points: Floats) -> Floats:
        """Of points to the boundary."""
        if self.index is None:
            return np.hypot(*(points - self.vertices[0]).T)
        return self.world.distances(points, self.ids).min(axis=1)

    def hits(self, p: Floats, d: Floats) -> Floats:
        """Parameters of the lines' hits, one row a line (NaN: none)."""
        if self.index is None:
            ray = self.vertices[0] - p
            aside = np.abs(cross(ray, d))
            return np.where(aside < ON_LINE, (ray * d).sum(-1), np.nan)[:, None]
        return self.world.line_hits(p, d, self.ids).reshape(len(p), -1)

    def samples(self) -> Floats:
        """Boundary points that give a first upper bound."""
        w = self.world
        spots = [self.vertices]
        for e in self.ids:
            for u in (0.25, 0.5, 0.75):
                if w.r[e] == 0:
                    spots.append((w.a[e] + u * (w.b[e] - w.a[e]))[None])
                else:
                    spots.append((w.c[e] + w.r[e] * unit(w.a0[e] + u * w.sweep[e]))[None])
        return np.concatenate(spots)


Candidates = list[tuple[Floats, Floats]]  # pairs of (n, 2) arrays: starts on i, ends on j


def _first_free(i: _Node, j: _Node, candidates: Candidates, bound: float, tol: float) -> Chord | None:
    """The shortest candidate that is free, tested in order of length.

    Lines that run along an edge meet it anywhere, so candidates may miss the boundaries: those are dropped.
    """
    if not candidates:
        return None
    w = i.world
    p, q = (np.concatenate([pair[k] for pair in candidates]) for k in (0, 1))
    length = np.hypot(*(q - p).T)
    order = np.argsort(length, kind="stable")
    order = order[length[order] <= bound]
    at = 0
    size = 16
    while at < len(order):
        batch = order[at : at + size]
        batch = batch[(i.distances(p[batch]) < OFF_BOUNDARY) & (j.distances(q[batch]) < OFF_BOUNDARY)]
        fine = np.flatnonzero(w.depth(p[batch], q[batch]) <= tol) if len(batch) else ()
        if len(fine):
            k = batch[fine[0]]
            return Chord(float(length[k]), tuple(map(float, p[k])), tuple(map(float, q[k])))
        at, size = at + size, min(4 * size, 512)
    return None


def _samples(i: _Node, j: _Node) -> Candidates:
    p, q = i.samples(), j.samples()
    return [(np.repeat(p, len(q), axis=0), np.tile(q, (len(p), 1)))]


def _feet(w: World, points: Floats, ids: NDArray[np.int64]) -> tuple[Floats, Floats]:
    """Points, and where their distance to an edge is stationary."""
    starts, ends = [], []
    for e in ids:
        if w.r[e] == 0:
            along = w.b[e] - w.a[e]
            u = (points - w.a[e]) @ along / (along @ along)
            keep = (u >= -1e-12) & (u <= 1 + 1e-12)
            starts.append(points[keep])
            ends.append(w.a[e] + u[keep, None] * along)
            continue
        ray = points - w.c[e]
        for sign in (1, -1):
            angle = np.arctan2(sign * ray[:, 1], sign * ray[:, 0])
            turn = (angle - w.a0[e]) * np.sign(w.sweep[e]) % TAU
            keep = (turn <= abs(w.sweep[e]) + 1e-12) | (turn >= TAU - 1e-12)
            starts.append(points[keep])
            ends.append(w.c[e] + w.r[e] * unit(angle[keep]))
    if not starts:
        return np.zeros((0, 2)), np.zeros((0, 2))
    return np.concatenate(starts), np.concatenate(ends)


def _unobstructed(i: _Node, j: _Node) -> Candidates:
    """Vertex to vertex, vertex to foot, and common normals of two edges."""
    w = i.world
    p, q = i.vertices, j.vertices
    chords = [(np.repeat(p, len(q), axis=0), np.tile(q, (len(p), 1)))]
    if i.index is not None:
        q_from, p_to = _feet(w, q, i.ids)
        chords.append((p_to, q_from))
    chords.append(_feet(w, p, j.ids))
    arcs_i, arcs_j = ({tuple(w.c[e]) for e in n.ids if w.r[e] > 0} for n in (i, j))
    for centre in arcs_i:  # a common normal of an arc runs through its centre
        c = np.array([centre])
        _, q_to = _feet(w, np.concatenate([c, *(np.array([o]) for o in arcs_j)]), j.ids)
        _, p_to = _feet(w, np.concatenate([c, q_to]), i.ids)
        chords.append((np.repeat(p_to, len(q_to), axis=0), np.tile(q_to, (len(p_to), 1))))
    for centre in arcs_j:
        if i.index is None:
            continue
        _, p_to = _feet(w, np.array([centre]), i.ids)
        _, q_to = _feet(w, np.concatenate([np.array([centre]), p_to]), j.ids)
        chords.append((np.repeat(p_to, len(q_to), axis=0), np.tile(q_to, (len(p_to), 1))))
    return chords


def _features(w: World, i: _Node, j: _Node, bound: float) -> tuple[Floats, Floats]:
    """Centres and radii of the others' corners and convex arcs that a chord of length `bound` can touch."""
    other = ~np.isin(w.owner, [n.index for n in (i, j) if n.index is not None])
    corners = w.a[other & w.true_start]
    rows = {(*corner, 0.0) for corner in corners.tolist()}
    round_ = other & (w.r > 0) & (w.sweep > 0)
    rows |= {(*c, r) for c, r in zip(w.c[round_].tolist(), w.r[round_].tolist(), strict=True)}
    if not rows:
        return np.zeros((0, 2)), np.zeros(0)
    table = np.array(sorted(rows))
    centres, radii = table[:, :2], table[:, 2]
    gap = np.zeros(len(table))
    for node in (i, j):
        gap += np.maximum(node.distances(centres) - radii, 0)
    keep = gap <= bound
    return centres[keep], radii[keep]


def _held_by_two(w: World, i: _Node, j: _Node, features: tuple[Floats, Floats], bound: float) -> Candidates:
    """Chords along the common tangents of two features; the ends' own vertices count as features."""
    centres = np.concatenate([features[0], i.vertices, j.vertices])
    radii = np.concatenate([features[1], np.zeros(len(i.vertices) + len(j.vertices))])
    first, second = np.triu_indices(len(centres), 1)
    between = centres[second] - centres[first]
    gap = np.hypot(*between.T)
    apart = gap > 1e-12
    lines_p, lines_d = [], []
    for side in (1, -1):
        for turn in (1, -1):
            use = apart
            if side == -1:
                use = use & (radii[first] > 0) & (radii[second] > 0)
            if turn == -1:
                use = use & ((radii[first] > 0) | (radii[second] > 0))
            m, n = first[use], second[use]
            with np.errstate(invalid="ignore"):
                lean = np.arccos((radii[m] - side * radii[n]) / gap[use])
            normal = unit(np.arctan2(between[use, 1], between[use, 0]) + turn * lean)
            real = ~np.isnan(lean)
            lines_p.append((centres[m] + radii[m, None] * normal)[real])
            lines_d.append(np.stack([-normal[:, 1], normal[:, 0]], axis=-1)[real])
    p, d = np.concatenate(lines_p), np.concatenate(lines_d)
    chords = []
    for at in range(0, len(p), 400):
        pp, dd = p[at : at + 400], d[at : at + 400]
        ti, tj = i.hits(pp, dd), j.hits(pp, dd)
        gaps = tj[:, None, :] - ti[:, :, None]
        for sign in (1, -1):  # from each hit of i the next hit of j, both ways
            step = np.where(sign * gaps >= 0, sign * gaps, np.inf)
            k = step.argmin(axis=2)
            shortest = np.take_along_axis(step, k[..., None], axis=2)[..., 0]
            row, col = np.nonzero(shortest <= bound)
            t0, t1 = ti[row, col], tj[row, k[row, col]]
            chords.append((pp[row] + t0[:, None] * dd[row], pp[row] + t1[:, None] * dd[row]))
    return chords


def _held_by_one(w: World, i: _Node, j: _Node, features: tuple[Floats, Floats], bound: float) -> Candidates:
    """Chords tangent to one feature, minimised over the angle between those at which another edge is hit."""
    ids = np.concatenate([i.ids, j.ids])
    round_ids = ids[w.r[ids] > 0]
    marks = np.concatenate([w.a[ids], w.c[round_ids]])
    mark_r = np.concatenate([np.zeros(len(ids)), w.r[round_ids]])
    rows: list[Floats] = []
    for centre, r in zip(*features, strict=True):
        ray = marks - centre
        gap = np.hypot(*ray.T)
        cuts = [np.array([0.0])]
        with np.errstate(invalid="ignore", divide="ignore"):
            for side in (1, -1):
                lean = np.arccos((r - side * mark_r) / gap)
                cuts += [np.arctan2(ray[:, 1], ray[:, 0]) + turn * lean for turn in (1, -1)]
        angles = np.concatenate(cuts)
        angles = np.sort(angles[~np.isnan(angles)] % TAU)
        low = angles
        high = np.append(angles[1:], angles[0] + TAU)
        wide = high - low > 1e-13
        low, high = low[wide], high[wide]
        steps = np.linspace(0, 1, 5)
        low, high = (
            (low[:, None] + (high - low)[:, None] * part).ravel() for part in (steps[:-1], steps[1:])
        )
        normal = unit((low + high) / 2)
        d = np.stack([-normal[:, 1], normal[:, 0]], axis=-1)
        p = centre + r * normal
        ti, tj = i.hits(p, d), j.hits(p, d)
        for sign in (1, -1) if r > 0 else (1,):
            back = np.where(sign * ti < 0, -sign * ti, np.inf)
            ahead = np.where(sign * tj > 0, sign * tj, np.inf)
            ki, kj = back.argmin(axis=1), ahead.argmin(axis=1)
            real = np.isfinite(back.min(axis=1)) & np.isfinite(ahead.min(axis=1))
            block = np.empty((int(real.sum()), 9))
            block[:, 0:3] = *centre, r
            block[:, 3], block[:, 4] = low[real], high[real]
            block[:, 5], block[:, 6] = i.ids[ki[real] // 2], ki[real] % 2
            block[:, 7], block[:, 8] = j.ids[kj[real] // 2], kj[real] % 2
            rows.append(block)
    table = np.concatenate(rows)
    if not len(table):
        return []
    centre, r, low, high = table[:, :2], table[:, 2:3], table[:, 3], table[:, 4]
    ei, ri, ej, rj = table[:, 5:].astype(np.int64).T

    def chord(angle: Floats) -> tuple[Floats, Floats]:
        normal = unit(angle)
        d = np.stack([-normal[:, 1], normal[:, 0]], axis=-1)
        p = centre + r * normal
        t0, t1 = w.edge_hit(p, d, ei, ri), w.edge_hit(p, d, ej, rj)
        return p + t0[:, None] * d, p + t1[:, None] * d

    def length(angle: Floats) -> Floats:
        start, end = chord(angle)
        value = np.hypot(*(end - start).T)
        return np.where(np.isnan(value), np.inf, value)

    return [chord(golden_section(length, low, high))]


def golden_section(f: object, low: Floats, high: Floats, rounds: int = 45) -> Floats:
    """Row by row a local minimiser in [low, high]."""
    g = (math.sqrt(5) - 1) / 2
    x, y = high - g * (high - low), low + g * (high - low)
    fx, fy = f(x), f(y)
    for _ in range(rounds):
        left = fx <= fy
        low, high = np.where(left, low, x), np.where(left, y, high)
        x_next = np.where(left, high - g * (high - low), y)
        y_next = np.where(left, x, low + g * (high - low))
        probe = f(np.where(left, x_next, y_next))
        fx, fy = np.where(left, probe, fy), np.where(left, fx, probe)
        x, y = x_next, y_next
    return (low + high) / 2


# The other method: sampling, then a search that never leaves free space.
