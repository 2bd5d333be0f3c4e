"""Float oracle of knowledge: what a robot that walks a path has seen, and when.

Shares no code with the engine. The spec's words: q is visible from p iff |pq| <= R and the open segment meets
no obstacle's interior (grazing does not block); known is every boundary point that some point of the path
sees. Both answers come with a proof, up to rounding, and what lies between them is `Answer.CLOSE`:

- YES: some p of the path sees q with room to spare. Segment pq stays `MARGIN` away from every edge but those
  that p and q lie on, it leaves those towards the free side, and |pq| <= R - MARGIN. (Or q lies on the path,
  or on a straight edge with p.)
- NO: cells of the path cover it, and from none of them q is seen. A cell of half length h around p sees
  nothing of a boundary cell of half length g around q if |pq| > R + h + g, or if pq runs at a fraction t of
  its length deeper than (1 - t) h + t g inside an obstacle: no point of pq moves by more than that.

`search` splits pairs of cells until they are decided or smaller than asked for. With one point as the
boundary cell it tells when a point is first seen, with all of a loop when an obstacle is, and with one
point as the path what is in sight.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from oracles import TAU, Disc, Room, World, cross, unit

from exactacq import Circle, Point, Scene
from exactacq.geometry.curves import Arc

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

MARGIN = 1e-7
"""What counts as clear."""
TOUCH = 1e-9
"""A point this close to an edge lies on it."""
PROBE = 1e-3
"""So far from its end a segment has to be clear of the edge on which it ends."""
CELLS = 100_000
"""When more pairs of cells than this are open they stay undecided: the answer is wider, not wrong."""
CHUNK = 256
"""Pairs that are judged before the next ones are compared with what was found."""
BATCH = 300_000
"""Pairs times edges that are judged at once."""


class Answer(IntEnum):
    """Known or in sight: CLOSE if floats should not tell."""

    NO = 0
    YES = 1
    CLOSE = 2


@dataclass(frozen=True)
class Spot:
    """A boundary point at the parameter ``u`` of an edge, exact and in floats."""

    obstacle: int
    edge: int
    u: Fraction
    point: Point

    @property
    def xy(self) -> tuple[float, float]:
        return self.point.xy


def spots(scene: Scene, shares: Sequence[Fraction]) -> list[Spot]:
    """The points of every edge at these parameters."""
    return [
        Spot(obstacle.index, k, u, edge.point(u))
        for obstacle in scene.obstacles
        for k, edge in enumerate(obstacle.edges)
        for u in shares
    ]


class Track:
    """Curves or points, one after the other; its cells are rows (curve, from, to) of fractions of length."""

    def __init__(self, items: Iterable[object]) -> None:
        rows = [_row(getattr(item, "curve", item)) for item in items]
        self.a, self.b, self.c = (np.array([row[k] for row in rows]).reshape(-1, 2) for k in range(3))
        self.r, self.a0, self.sweep = (np.array([row[k] for row in rows], dtype=float) for k in (3, 4, 5))
        straight = np.hypot(*(self.b - self.a).T)
        self.lengths = np.where(self.r > 0, self.r * np.abs(self.sweep), straight)
        self.before = np.concatenate([[0.0], np.cumsum(self.lengths)])

    def at(self, k: NDArray[np.int64], u: Floats) -> Floats:
        """Points at fractions of curves."""
        line = self.a[k] + u[:, None] * (self.b[k] - self.a[k])
        turned = self.c[k] + self.r[k][:, None] * unit(self.a0[k] + u * self.sweep[k])
        return np.where(self.r[k][:, None] > 0, turned, line)

    def place(self, s: float) -> Floats:
        """The point after the length *s*."""
        k = min(max(int(np.searchsorted(self.before, s, "right")) - 1, 0), len(self.lengths) - 1)
        u = (s - self.before[k]) / self.lengths[k] if self.lengths[k] else 0.0
        return self.at(np.array([k]), np.array([u]))[0]

    def fraction(self, k: int, point: Floats) -> float:
        """The fraction of curve k's length at which a point of it lies."""
        if self.r[k] == 0:
            along = self.b[k] - self.a[k]
            return float((point - self.a[k]) @ along / (along @ along))
        x, y = point - self.c[k]
        turn = (math.atan2(y, x) - self.a0[k]) * math.copysign(1, self.sweep[k]) % TAU
        share = turn / abs(self.sweep[k])
        return share - TAU / abs(self.sweep[k]) if share > (1 + TAU / abs(self.sweep[k])) / 2 else share

    def cells(self, step: float) -> Floats:
        """All of it in cells of at most this length."""
        parts = [np.linspace(0, 1, max(1, math.ceil(length / step)) + 1) for length in self.lengths]
        rows = [np.stack([np.full(len(u) - 1, k), u[:-1], u[1:]], 1) for k, u in enumerate(parts)]
        return np.concatenate(rows) if rows else np.empty((0, 3))

    def middle(self, cells: Floats) -> tuple[Floats, Floats]:
        """Middle points and half lengths of cells."""
        k = cells[:, 0].astype(int)
        half = (cells[:, 2] - cells[:, 1]) / 2
        return self.at(k, cells[:, 1] + half), half * self.lengths[k]

    def position(self, cells: Floats, column: int) -> Floats:
        """Length so far at the start (1) or end (2) of cells."""
        k = cells[:, 0].astype(int)
        return self.before[k] + cells[:, column] * self.lengths[k]

    def box(self) -> tuple[Floats, Floats]:
        """Lower left and upper right of something that holds it."""
        reach = self.r[:, None] * (self.r[:, None] > 0)
        low = np.where(reach > 0, self.c - reach, np.minimum(self.a, self.b))
        high = np.where(reach > 0, self.c + reach, np.maximum(self.a, self.b))
        return low.min(axis=0), high.max(axis=0)


def _row(curve: object) -> tuple:
    if not hasattr(curve, "start"):
        xy = Point.of(curve).xy
        return xy, xy, (0.0, 0.0), 0.0, 0.0, 0.0
    start, end = curve.start.xy, curve.end.xy
    if not isinstance(curve, Arc):
        return start, end, (0.0, 0.0), 0.0, 0.0, 0.0
    (cx, cy), sign = curve.center.xy, 1 if curve.ccw else -1
    first = math.atan2(start[1] - cy, start[0] - cx)
    turn = (math.atan2(end[1] - cy, end[0] - cx) - first) * sign % TAU
    whole = curve.full or turn == 0
    return start, end, (cx, cy), float(curve.radius), first, sign * (TAU if whole else turn)


@lru_cache(maxsize=4)
def _shapes(scene: Scene) -> tuple[list[object], list[tuple[Floats, Floats]]]:
    """The shapes as `oracles` takes them, and boxes around them (none around the room)."""
    given = [*scene.shapes, *([scene.enclosure] if scene.enclosure else [])]
    shapes = [
        Disc(*(float(v) for v in (*shape.center, shape.radius)))
        if isinstance(shape, Circle)
        else [tuple(float(v) for v in vertex) for vertex in shape.vertices]
        for shape in given
    ]
    boxes = [Track(obstacle.edges).box() for obstacle in scene.obstacles]
    if scene.enclosure is not None:
        shapes[-1] = Room(_polygonal_circle(shapes[-1]))
        boxes[-1] = np.full(2, -np.inf), np.full(2, np.inf)
    return shapes, boxes


def _polygonal_circle(shape: object) -> object:
    """A round room as two half circles."""
    if not isinstance(shape, Disc):
        return shape
    return [(shape.x - shape.r, shape.y, 1.0), (shape.x + shape.r, shape.y, 1.0)]


class Window:
    """What can stand between places within *radius* of a box and points of that box."""

    def __init__(self, scene: Scene, box: tuple[Floats, Floats], radius: float) -> None:
        shapes, boxes = _shapes(scene)
        low, high = box[0] - radius - MARGIN, box[1] + radius + MARGIN
        near = [k for k, (a, b) in enumerate(boxes) if (a <= high).all() and (b >= low).all()]
        self.radius = radius
        self.world = World([shapes[k] for k in near]) if near else None

    def judge(self, p: Floats, hp: Floats, q: Floats, hq: Floats) -> tuple[Bools, Bools]:
        """Which pairs of cells certainly never see each other, and of which the middles certainly do."""
        gap = np.hypot(*(q - p).T)
        never = gap > self.radius + hp + hq + MARGIN
        sees = gap <= self.radius - MARGIN
        if self.world is not None:
            size = max(1, BATCH // len(self.world.r))
            within = np.flatnonzero(~never)
            for first in range(0, len(within), size):
                rows = within[first : first + size]
                never[rows] = self._blocked(p[rows], hp[rows], q[rows], hq[rows])
                left = rows[~never[rows] & sees[rows]]
                sees[left] = self._clear(p[left], q[left])
        return never, sees & ~never

    def _blocked(self, p: Floats, hp: Floats, q: Floats, hq: Floats) -> Bools:
        """Whether pq dips deeper into an obstacle than moving its ends by hp and hq can undo."""
        w, d = self.world, q - p
        out = np.zeros(len(p), dtype=bool)
        cuts = w.line_hits(p, d, w.all_ids).reshape(len(p), -1)
        cuts = np.concatenate([np.tile([0.0, 1.0], (len(p), 1)), cuts], axis=1)
        cuts = np.sort(np.where((cuts >= 0) & (cuts <= 1), cuts, np.nan), axis=1)
        cuts = cuts[:, : max(2, int((~np.isnan(cuts)).sum(axis=1).max(initial=2)))]
        row, k = np.nonzero(cuts[:, 1:] - cuts[:, :-1] > 1e-12)
        for share in (0.5, 0.15, 0.85):
            left = ~out[row]
            row, k = row[left], k[left]
            t = cuts[row, k] + share * (cuts[row, k + 1] - cuts[row, k])
            x = p[row] + t[:, None] * d[row]
            inside = np.flatnonzero(w.blocked(x)) if len(x) else np.empty(0, dtype=int)
            if len(inside):
                depth = w.distances(x[inside], w.all_ids).min(axis=1)
                at, t = row[inside], t[inside]
                out[at[depth > (1 - t) * hp[at] + t * hq[at] + MARGIN]] = True
        return out

    def _clear(self, p: Floats, q: Floats) -> Bools:
        """Whether pq keeps off all edges but those of its ends, and leaves those to the free side."""
        if not len(p):
            return np.zeros(0, dtype=bool)
        w, d = self.world, q - p
        length = np.maximum(np.hypot(*d.T), TOUCH)[:, None]
        from_p, from_q = (w.distances(x, w.all_ids) for x in (p, q))
        at_p, at_q = from_p <= TOUCH, from_q <= TOUCH
        d = np.where(length > TOUCH, d, 1.0)
        t = w.line_hits(p, d, w.all_ids, slack=1e-9)
        hit = (t >= 0) & (t <= 1)
        room = np.minimum(from_p, from_q)
        for corner in (w.a, w.b):
            room = np.minimum(room, _off_segment(corner - p[:, None, :], d))
        room = np.minimum(room, self._bow(p, d))
        room[hit.any(axis=2)] = 0.0
        with np.errstate(invalid="ignore"):
            near_p = at_p[..., None] & (np.abs(t) * length[..., None] <= 10 * MARGIN)
            near_q = at_q[..., None] & (np.abs(t - 1) * length[..., None] <= 10 * MARGIN)
        own = ~(hit & ~near_p & ~near_q).any(axis=2)
        step = d * np.minimum(PROBE / length, 1 / 3)
        for at, probe in ((at_p, p + step), (at_q, q - step)):
            out = ~w.blocked(probe) & (w.distances(probe, w.all_ids).min(axis=1) >= MARGIN)
            own &= ~at | out[:, None]
        along = at_p & at_q & ((w.r == 0) | (length <= TOUCH))
        return np.where(at_p | at_q, own, room >= MARGIN).all(axis=1) | along.any(axis=1)

    def _bow(self, p: Floats, d: Floats) -> Floats:
        """Distance of each segment's point nearest to an arc's centre from the arc, if it lies before it."""
        w = self.world
        t = np.clip(((w.c - p[:, None, :]) * d[:, None, :]).sum(-1) / (d**2).sum(-1)[:, None], 0, 1)
        ray = p[:, None, :] + t[..., None] * d[:, None, :] - w.c
        turn = (np.arctan2(ray[..., 1], ray[..., 0]) - w.a0) * np.sign(w.sweep) % TAU
        gap = np.abs(np.hypot(ray[..., 0], ray[..., 1]) - w.r)
        return np.where((w.r > 0) & (turn <= np.abs(w.sweep)), gap, np.inf)


def _off_segment(offset: Floats, d: Floats) -> Floats:
    """Distance of points, reckoned from the segments' starts, from the segments."""
    d = d[:, None, :]
    t = np.clip((offset * d).sum(-1) / (d**2).sum(-1), 0, 1)
    return np.hypot(*np.moveaxis(offset - t[..., None] * d, -1, 0))


def search(
    scene: Scene,
    radius: object,
    path: Track,
    target: Track,
    *,
    spacing: float = 0.25,
    tolerance: float = 1e-5,
    first: bool = False,
) -> tuple[float, float]:
    """Bounds of the path length at which some point of *target* is first seen.

    (inf, inf): certainly never; (finite, inf): not certain. Stops at any sight if *first* is set (then only
    whether the upper bound is finite means something).
    """
    window = Window(scene, target.box(), float(radius))
    ours, theirs = path.cells(spacing), target.cells(spacing)
    (p, hp), (q, hq) = path.middle(ours), target.middle(theirs)
    gap = np.hypot(*np.moveaxis(p[:, None, :] - q, -1, 0))
    i, j = np.nonzero(gap <= window.radius + hp[:, None] + hq + MARGIN)
    order = np.argsort(gap[i, j] if first else i, kind="stable")
    pairs = np.hstack([ours[i[order]], theirs[j[order]]])
    seen, stuck = np.inf, np.inf
    if len(target.lengths) == 1 and target.lengths[0] == 0:
        seen = _passed(window, path, target.a[0])
    while len(pairs) and not (first and seen < np.inf):
        pairs = pairs[path.position(pairs, 1) < seen]
        if len(pairs) > CELLS:
            stuck = min(stuck, path.position(pairs, 1).min())
            break
        (p, hp), (q, hq) = path.middle(pairs), target.middle(pairs[:, 3:])
        begin = path.position(pairs, 1)
        open_ = np.zeros(len(pairs), dtype=bool)
        for low in range(0, len(pairs), CHUNK):
            part = low + np.flatnonzero(begin[low : low + CHUNK] < seen)
            never, sees = window.judge(p[part], hp[part], q[part], hq[part])
            open_[part] = ~never
            if sees.any():
                seen = min(seen, (begin[part] + hp[part])[sees].min())
                if first:
                    break
        open_ &= begin < seen
        pairs, hp, hq, begin = pairs[open_], hp[open_], hq[open_], begin[open_]
        done = (2 * hp <= tolerance) & (2 * hq <= tolerance) | (begin >= seen - tolerance)
        if done.any():
            stuck = min(stuck, begin[done].min())
        pairs = _split(pairs[~done], hp[~done] >= hq[~done])
    return min(stuck, seen), seen


def _passed(window: Window, path: Track, q: Floats) -> float:
    """Length at which the path passes through the boundary point q itself, inf if it does not."""
    for k, length in enumerate(path.lengths):
        u = min(max(path.fraction(k, q), 0.0), 1.0) if length else 0.0
        p = path.at(np.array([k]), np.array([u]))[0]
        if np.hypot(*(p - q)) <= TOUCH:
            return float(path.before[k] + u * length)
    return math.inf


def _split(pairs: Floats, ours: Bools) -> Floats:
    """Each pair of cells in two, along the longer cell; in the path's order."""
    out = []
    for column, rows in ((1, pairs[ours]), (4, pairs[~ours])):
        middle = (rows[:, column] + rows[:, column + 1]) / 2
        for side in (column + 1, column):
            half = rows.copy()
            half[:, side] = middle
            out.append(half)
    halves = np.concatenate(out)
    return halves[np.lexsort((halves[:, 1], halves[:, 0]))]


# What tests ask.


def known(
    scene: Scene, radius: object, curves: Iterable[object], samples: Sequence[Spot], spacing: float = 0.25
) -> NDArray[np.int64]:
    """An `Answer` for each sample: is it visible from some point of the curves?"""
    path = Track(curves)
    out = []
    for spot in samples:
        low, high = search(scene, radius, path, Track([spot.point]), spacing=spacing, first=True)
        out.append(Answer.YES if high < math.inf else Answer.CLOSE if low < math.inf else Answer.NO)
    return np.array(out)


def first_seen(
    scene: Scene, radius: object, curves: Iterable[object], point: object, tolerance: float = 1e-5
) -> tuple[float, float]:
    """Lower and upper bound of the path length at which the boundary point is first seen; inf: never."""
    return search(scene, radius, Track(curves), Track([point]), tolerance=tolerance)


def sight_length(
    scene: Scene, radius: object, curves: Iterable[object], obstacle: int, tolerance: float = 1e-4
) -> tuple[float, float]:
    """Lower and upper bound of the path length at which an obstacle's first boundary point is seen."""
    loop = Track(scene.obstacles[obstacle].edges)
    return search(scene, radius, Track(curves), loop, tolerance=tolerance)


def acquire_length(
    scene: Scene, radius: object, curves: Iterable[object], samples: Sequence[Spot], tolerance: float = 1e-4
) -> float:
    """A lower bound of the path length at which all of the samples are known."""
    path = Track(curves)
    found = (search(scene, radius, path, Track([s.point]), tolerance=tolerance) for s in samples)
    return max(low for low, _ in found)


def in_sight(scene: Scene, radius: object, place: object, obstacle: int, tolerance: float = 1e-5) -> Answer:
    """Whether some boundary point of the obstacle is visible from the place."""
    loop = Track(scene.obstacles[obstacle].edges)
    low, high = search(scene, radius, Track([place]), loop, tolerance=tolerance, first=True)
    return Answer.YES if high < math.inf else Answer.CLOSE if low < math.inf else Answer.NO


def known_parts(
    scene: Scene,
    radius: object,
    curves: Sequence[object],
    obstacle: int,
    edge: int,
    count: int = 16,
    precision: float = 1e-5,
) -> list[tuple[float, float]]:
    """The known parts of an edge, as fractions of its length: samples, and bisection where they differ.

    Parts and gaps shorter than 1 / *count* of the edge may be missed; ends are good to *precision*, or
    lie where floats are not certain.
    """
    path, line = Track(curves), Track([scene.obstacles[obstacle].edges[edge]])

    def is_known(u: float) -> bool:
        point = line.at(np.array([0]), np.array([u]))[0]
        return search(scene, radius, path, Track([tuple(point)]), first=True)[1] < math.inf

    shares = (np.arange(count) + 0.5) / count
    states = [is_known(u) for u in shares]
    ends = [0.0] if states[0] else []
    for k in range(count - 1):
        if states[k] != states[k + 1]:
            low, high = shares[k], shares[k + 1]
            while high - low > precision:
                middle = (low + high) / 2
                low, high = (middle, high) if is_known(middle) == states[k] else (low, middle)
            ends.append((low + high) / 2)
    if states[-1]:
        ends.append(1.0)
    return list(zip(ends[::2], ends[1::2], strict=True))


@dataclass(frozen=True)
class Seen:
    """The part of an edge between two fractions of its length, in the boundary's direction."""

    obstacle: int
    edge: int
    low: float
    high: float


def view(scene: Scene, radius: object, place: object) -> list[Seen]:
    """What a place sees of every edge, sorted, by casting a ray between any two critical directions.

    Critical are the directions of corners, of tangents to arcs and of the ends of what is within range. Edges
    seen end-on (from a point of their own line) are left out.
    """
    reach = float(radius)
    edges = [(o.index, k, edge) for o in scene.obstacles for k, edge in enumerate(o.edges)]
    line = Track(edge for _, _, edge in edges)
    here = np.array(Point.of(place).xy)
    box = here, here
    world = Window(scene, box, reach).world
    if world is None:
        return []
    angles = np.concatenate([_critical(world, here, reach), np.arctan2(*(line.a - here).T[::-1])])
    angles = np.sort(angles % TAU)
    angles = np.concatenate([angles, angles[:1] + TAU])
    low, high = angles[:-1], angles[1:]
    keep = high - low > 1e-9
    low, high = low[keep], high[keep]
    rays = unit((low + high) / 2)
    t = world.line_hits(np.tile(here, (len(rays), 1)), rays, world.all_ids)
    t = np.where(t > TOUCH, t, np.inf).min(axis=2)
    hit = t.argmin(axis=1)
    nearest = t.min(axis=1)
    leaves = ~world.blocked(here + rays * np.minimum(nearest, reach)[:, None] * 1e-3)
    found: dict[int, list[tuple[float, float]]] = {}
    for k in np.flatnonzero(leaves & (nearest <= reach)):
        spot = here + nearest[k] * rays[k]
        owner = _edge_at(line, spot)
        middle, ends = line.fraction(owner, spot), []
        for angle in (low[k], high[k]):
            direction = unit(np.array([angle]))
            hits = world.line_hits(here[None], direction, hit[k : k + 1], slack=1e-6)[0, 0]
            if np.isnan(hits).all():  # it just misses an arc: the point nearest to the centre
                hits = (world.c[hit[k]] - here) @ direction.T
            there = hits[np.nanargmin(np.abs(hits - nearest[k]))]
            share = line.fraction(owner, here + there * direction[0])
            turns = round((middle - share) * abs(line.sweep[owner]) / TAU)  # a full circle's ends meet
            ends.append(min(max(share + turns * TAU / (abs(line.sweep[owner]) or 1.0), 0.0), 1.0))
        found.setdefault(owner, []).append((min(ends), max(ends)))
    return [Seen(*edges[owner][:2], *part) for owner in sorted(found) for part in _merged(found[owner])]


def _critical(world: World, here: Floats, reach: float) -> Floats:
    """Directions in which what a ray hits can change."""
    spots = [world.a, world.b]
    offset = here - world.c
    gap = np.hypot(*offset.T)
    out = []
    for k in np.flatnonzero(world.r > 0):
        if gap[k] > world.r[k]:
            middle, half = math.atan2(*-offset[k][::-1]), math.asin(world.r[k] / gap[k])
            out += [middle - half, middle + half]
        if gap[k] and abs(world.r[k] - reach) <= gap[k] <= world.r[k] + reach:
            # Where the range circle meets the arc's circle: seen from here, off the centre's direction.
            cosine = (reach**2 + gap[k] ** 2 - world.r[k] ** 2) / (2 * reach * gap[k])
            middle, half = math.atan2(*-offset[k][::-1]), math.acos(min(1.0, max(-1.0, cosine)))
            out += [middle - half, middle + half]
    straight = world.r == 0
    along = (world.b - world.a)[straight]
    size = np.hypot(*along.T)
    ray = world.a[straight] - here
    foot = (ray * along).sum(-1) / size
    aside = np.abs(cross(ray, along)) / size
    with np.errstate(invalid="ignore"):
        half = np.sqrt(reach**2 - aside**2)
    for sign in (-1, 1):
        spots.append((here + ray + (sign * half - foot)[:, None] * along / size[:, None])[~np.isnan(half)])
    offsets = np.concatenate(spots) - here
    offsets = offsets[np.hypot(*offsets.T) > TOUCH]
    own = np.concatenate([along, -along])
    return np.concatenate([np.arctan2(o[:, 1], o[:, 0]) for o in (offsets, own)] + [np.array(out)])


def _edge_at(line: Track, spot: Floats) -> int:
    """The curve on which a point lies."""

    def gap(k: int) -> float:
        u = min(max(line.fraction(k, spot), 0.0), 1.0)
        return float(np.hypot(*(line.at(np.array([k]), np.array([u]))[0] - spot)))

    return min(range(len(line.lengths)), key=gap)


def _merged(parts: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Union of intervals, those that nearly touch joined."""
    out: list[tuple[float, float]] = []
    for low, high in sorted(parts):
        if out and low <= out[-1][1] + 1e-6:
            out[-1] = (out[-1][0], max(out[-1][1], high))
        else:
            out.append((low, high))
    return out
