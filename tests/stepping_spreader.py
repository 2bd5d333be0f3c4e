"""A stepping simulator of the Seed Spreader in floats: an oracle that shares no code with the library.

The robot is a point that moves in small steps along the M-line, boundaries and diversion lines, and looks
around after each. Boundaries are known by samples. Everything is approximate: what is seen only between two
steps is missed, and places of diversions are good to a fraction of a step. Decisions can hang on less than a
step: compare runs only where a finer step decides the same.

Obstacles are cut at the terrain's border first, and every part counts for itself. Results name parts, and
`Spread.owner` tells whose they are; with one part each, the two numberings agree.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Spot = tuple[float, float]

TINY = 1e-9
"""Lengths closer than this are equal."""
INSET = 1e-7
"""Obstacles hide things only from this depth on, so that grazing does not."""
FINEST = 1 / 64
"""A loss is located to this share of a step."""
LATER = ("i", "ii")
"""These rules may fire a little later than here, somewhere in the next step."""


@dataclass(frozen=True)
class Diversion:
    """From *leave* (D) to *target* (Q) on an obstacle, for one of the reasons "i" to "iv"."""

    leave: Spot
    target: Spot
    reason: str
    obstacle: int
    at: float


@dataclass
class Spread:
    """What a run did. Numbers are those of the parts of obstacles inside the terrain.

    Acquisitions come with the length of the path so far; visits are circumnavigations; a hit is what blocked
    the M-line, where, and "circumnavigate" or "pass". *trapped* is the part that ended the run before T; the
    robot's free region does not touch *unreached* parts.
    """

    owner: list[int]
    length: float = 0.0
    path: list[Spot] = field(default_factory=lambda: [(0.0, 0.0)])
    acquisitions: list[tuple[int, float]] = field(default_factory=list)
    visits: list[int] = field(default_factory=list)
    hits: list[tuple[int, Spot, str]] = field(default_factory=list)
    diversions: list[Diversion] = field(default_factory=list)
    trapped: int | None = None
    unreached: list[int] = field(default_factory=list)
    unseen: list[int] = field(default_factory=list)
    incomplete: list[int] = field(default_factory=list)

    @property
    def position(self) -> Spot:
        return self.path[-1]


def spread(
    loops: Iterable[Sequence[Spot]], width: float, height: float, radius: float, **options: Any
) -> Spread:
    """Run on polygons in the terrain [0, width] x [0, height].

    Options: lookahead (True), target ("known" or "visible"), step (radius / 200).
    """
    return _Robot([np.asarray(loop, float) for loop in loops], width, height, radius, **options).run()


def spread_scene(scene: Any, radius: object, **options: Any) -> Spread:
    """`spread` on the plain data of a library scene of polygons."""
    assert not any(bulge for shape in scene.shapes for _, _, bulge in shape.vertices)
    loops = [[(_number(x), _number(y)) for x, y, _ in shape.vertices] for shape in scene.shapes]
    size = _number(scene.terrain.width), _number(scene.terrain.height)
    return spread(loops, *size, _number(radius), **options)


class _Line:
    """A polyline by length."""

    def __init__(self, points: Sequence[Sequence[float]] | Floats) -> None:
        self.points = np.asarray(points, float)
        self.at = np.append(0.0, np.cumsum(np.hypot(*np.diff(self.points, axis=0).T)))
        self.size = float(self.at[-1])

    def point(self, s: float) -> Floats:
        return np.array([np.interp(s, self.at, self.points[:, k]) for k in (0, 1)])


class _Part:
    """One connected part of an obstacle in the terrain, and its walkable boundary, counterclockwise."""

    def __init__(self, shape: shapely.Polygon, terrain: shapely.Polygon, free: shapely.Geometry) -> None:
        self.shape = shape
        ring = shapely.get_coordinates(shapely.orient_polygons(shape).exterior)
        walls = np.array([terrain.bounds[:2], terrain.bounds[2:]])
        on_wall = (np.abs(ring[:, None] - walls) < TINY).reshape(-1, 4)
        border = (on_wall[:-1] & on_wall[1:]).any(axis=1)
        self.inner = shapely.multilinestrings(np.stack([ring[:-1], ring[1:]], axis=1)[~border])
        """The boundary without what lies on the border."""
        self.closed = not border.any()
        runs = [ring] if self.closed else _runs(ring, border)
        runs = [run for run in runs if _beside(run).dwithin(free, TINY)]
        self.reached = bool(runs)
        self.line = _Line(max(runs, key=len, default=np.empty((0, 2))))
        self.curve = shapely.linestrings(self.line.points)

    def blocks(self, point: Floats) -> bool:
        """Whether all of the terrain around the point is this obstacle."""
        spot = shapely.Point(point)
        return bool(self.shape.dwithin(spot, TINY) and self.inner.distance(spot) > TINY)

    def blocked(self, line: _Line) -> list[tuple[float, float]]:
        """The intervals of a line, as lengths from its start, that this obstacle blocks."""
        cuts = set(line.at.tolist())
        for at, (start, end) in zip(line.at, pairwise(line.points), strict=False):
            spots = shapely.get_coordinates(shapely.LineString([start, end]).intersection(self.inner))
            cuts |= {float(at + math.dist(start, spot)) for spot in spots}
        out: list[tuple[float, float]] = []
        for low, high in pairwise(sorted(cuts)):
            if high - low <= TINY or not self.blocks(line.point((low + high) / 2)):
                continue
            goes_on = out and low - out[-1][1] <= TINY and self.blocks(line.point(low))
            out.append((out.pop()[0] if goes_on else low, high))
        return out

    def walkable(self, point: Floats) -> bool:
        """Whether the point lies on the walkable boundary."""
        return bool(self.curve.dwithin(shapely.Point(point), 100 * TINY))

    def mark(self, points: Iterable[Floats]) -> None:
        """Make corners of points on the walkable boundary."""
        for place in map(self._locate, points):
            if np.abs(self.line.at - place).min() > TINY:
                before = np.searchsorted(self.line.at, place)
                self.line = _Line(np.insert(self.line.points, before, self.line.point(place), axis=0))

    def tour(self, point: Floats) -> list[Floats]:
        """All of the boundary: the whole loop, or from the point to one end and on to the other."""
        here, size = self._locate(point), self.line.size
        if self.closed:
            return self._corners(here, here + size)
        if here < TINY:
            return self._corners(0, size)
        return (self._corners(here, size) if here < size - TINY else []) + self._corners(size, 0)

    def way(self, start: Floats, end: Floats) -> list[Floats]:
        """The shorter way along the boundary; of two equal ones, counterclockwise."""
        here, there, size = self._locate(start), self._locate(end), self.line.size
        if self.closed:
            ahead = (there - here) % size
            there = here + (ahead if 2 * ahead <= size + TINY else ahead - size)
        return self._corners(here, there)

    def _locate(self, point: Floats) -> float:
        return float(self.curve.project(shapely.Point(point)))

    def _corners(self, low: float, high: float) -> list[Floats]:
        """The corners between two places and the second place; places of a loop go on past its ends."""
        at, size = self.line.at, self.line.size
        at = np.concatenate([at[:-1] - size, at[:-1], at[:-1] + size]) if self.closed else at
        inside = at[(at > min(low, high) + TINY) & (at < max(low, high) - TINY)]
        places = [*(inside if high > low else inside[::-1]), high]
        return [self.line.point(place % size if self.closed else place) for place in places]


class _Samples:
    """Samples of all walkable boundaries; each edge has its own, both ends included."""

    def __init__(self, parts: Sequence[_Part], spacing: float) -> None:
        rows = []
        for k, part in enumerate(parts):
            chain = part.line.points
            for ends, shrunk in zip(pairwise(chain), pairwise(_inset(chain, part.closed)), strict=True):
                count = max(4, math.ceil(math.dist(*ends) / spacing)) + 1
                dx, dy = (ends[1] - ends[0]) / math.dist(*ends)
                places = np.hstack([np.linspace(*ends, count), np.linspace(*shrunk, count)])
                rows.append(np.hstack([places, np.tile([dy, -dx, k, len(rows)], (count, 1))]))
        table = np.concatenate([np.empty((0, 8)), *rows])
        self.spots, self.shrunk, self.normals = table[:, :2], table[:, 2:4], table[:, 4:6]
        self.part, edge = table[:, 6].astype(int), table[:, 7]
        self.joined = np.append(edge[1:], -1) == edge
        """Whether a sample and the next are on one edge."""
        self.known = np.zeros(len(table), bool)

    def pieces(self, chosen: Mask, spots: Floats) -> Floats:
        """The longest pieces between samples that are all chosen, as rows of start and end."""
        link = chosen & np.append(chosen[1:], False) & self.joined
        first = np.flatnonzero(link & ~np.append(False, link[:-1]))
        last = np.flatnonzero(link & ~np.append(link[1:], False)) + 1
        return np.stack([spots[first], spots[last]], axis=1)


@dataclass
class _Robot:
    loops: list[Floats]
    width: float
    height: float
    radius: float
    lookahead: bool = True
    target: str = "known"
    step: float = 0.0

    def __post_init__(self) -> None:
        self.step = self.step or self.radius / 200
        shapes = [shapely.orient_polygons(shapely.Polygon(loop)) for loop in self.loops]
        terrain, start = shapely.box(0, 0, self.width, self.height), shapely.Point(0, 0)
        regions = shapely.get_parts(shapely.difference(terrain, shapely.union_all(shapes)))
        free = min(regions, key=start.distance)
        cut = [shapely.get_parts(shapely.intersection(shape, terrain)) for shape in shapes]
        found = [(owner, part) for owner, parts in enumerate(cut) for part in parts if part.area > 0]
        self.out = Spread([owner for owner, _ in found])
        self.parts = [_Part(part, terrain, free) for _, part in found]
        rings = [_inset(shapely.get_coordinates(shape.exterior), closed=True) for shape in shapes]
        walls = [np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings]
        self.walls = np.concatenate([np.empty((0, 2, 2)), *walls])
        self._lay_line()
        self.samples = _Samples(self.parts, self.step / 2)
        self.own = [np.flatnonzero(self.samples.part == k) for k in range(len(self.parts))]
        self.corners = np.concatenate([np.empty((0, 2)), *self.loops])
        self.missing = [len(own) for own in self.own]
        self.from_line: dict[int, bool] = {}
        """Each part seen so far: whether it was first seen from the M-line."""
        self.s, self.here = 0.0, np.zeros(2)

    def _lay_line(self) -> None:
        """Step 0: the M-line, where its eastern lines begin and end, and what blocks it."""
        strips = math.ceil(self.width / self.radius - TINY)
        xs = [min(j * self.radius, self.width) for j in range(strips + 1)]
        ends = [(0.0, self.height), (self.height, 0.0)]
        self.line = _Line([(x, y) for j, x in enumerate(xs) for y in ends[j % 2]])
        self.eastern = [(x, x + j * self.height, x + (j + 1) * self.height) for j, x in enumerate(xs)][1:]
        self.blocked = [part.blocked(self.line) for part in self.parts]
        self.starts = [(a, k) for k, pairs in enumerate(self.blocked) for a, _ in pairs]
        self.crossings: list[list[float]] = [[] for _ in self.parts]
        """Of each part the walkable crossing points on the M-line."""
        for part, pairs, own in zip(self.parts, self.blocked, self.crossings, strict=True):
            own += [s for pair in pairs for s in pair if part.walkable(self.line.point(s))]
            part.mark([self.line.point(s) for s in own])
        corners = np.concatenate([np.empty((0, 2)), *(part.line.points for part in self.parts)])
        stops = {*self.line.at.tolist(), *(a for a, _ in self.starts)}
        for at, (start, end) in zip(self.line.at, pairwise(self.line.points), strict=False):
            share = (corners - start) @ (end - start) / math.dist(start, end)
            stops |= set((at + share[(share > 0) & (share < math.dist(start, end))]).tolist())
        self.stops = sorted(stops)
        """Ends of lines, hits, and where a corner is just abeam: the range reaches some only from there."""

    def run(self) -> Spread:
        """Step 1."""
        self._sense(on_line=True)
        stride, back, out = self.step, False, self.out
        while True:
            hit = next((k for a, k in self.starts if abs(a - self.s) < TINY), None)
            if hit is not None:
                if not self._hop(hit):
                    out.trapped = hit
                    break
                back = True
                continue
            ahead = self.s + stride
            ahead = next((s for s in self.stops if self.s + TINY < s < ahead + TINY), ahead)
            loss = self._loss(ahead, back)
            if loss and loss.reason in LATER and ahead - self.s > FINEST * self.step:
                stride = (ahead - self.s) / 2
            elif loss:
                self._divert(loss)
                stride, back = FINEST / 2 * self.step, True
            elif self.s > self.line.size - TINY:
                break
            else:
                self._go(self.line.point(ahead), on_line=True)
                self.s, stride, back = ahead, min(2 * stride, self.step), False
        out.unreached = [k for k, part in enumerate(self.parts) if not part.reached]
        out.unseen = [k for k, part in enumerate(self.parts) if part.reached and k not in self.from_line]
        out.incomplete = [k for k in sorted(self.from_line) if self.missing[k]]
        return out

    def _hop(self, k: int) -> bool:
        """Steps 2 and 1(c): around what blocks the M-line to L; False if there is no L."""
        part, how = self.parts[k], "circumnavigate" if self.missing[k] else "pass"
        self.out.hits.append((k, _spot(self.here), how))
        if self.missing[k]:
            self._tour(k)
        ends = [b for a, b in self.blocked[k] if a > self.s - TINY and part.walkable(self.line.point(b))]
        ahead = ends[0] if ends else math.inf
        while loss := self._loss(ahead, back=False):
            self._divert(loss)
        if ends:
            self._follow(part.way(self.here, self.line.point(ahead)))
            self.s, self.here = ahead, self.line.point(ahead)
        return bool(ends)

    def _loss(self, ahead: float, back: bool) -> Diversion | None:
        """1(d): the diversion due before going on to *ahead* on the M-line; *back*: just back on it."""
        line = next((line for line in self.eastern if line[1] - TINY <= self.s <= line[2] + TINY), None)
        due = []
        for k in [k for k in sorted(self.from_line) if line and self.missing[k]]:
            (x, _, end), own = line, self.own[k]
            known = own[self.samples.known[own]]
            crossings = [self.line.point(s) for s in self.crossings[k] if s > self.s + TINY]
            blocks = any((np.hypot(*(self.samples.spots[known] - c).T) < 10 * TINY).any() for c in crossings)
            if blocks or not (self.samples.spots[known, 0] < x - TINY).any():
                continue
            if reason := self._reason(k, known, ahead, end, back):
                spot = self._nearest(k)
                later = reason in LATER and ahead - self.s > FINEST * self.step
                rank = later, round(math.dist(spot, self.here) / TINY), k
                due.append((rank, Diversion(_spot(self.here), _spot(spot), reason, k, self.out.length)))
        return min(due)[1] if due else None

    def _reason(self, k: int, known: NDArray[np.int64], ahead: float, end: float, back: bool) -> str | None:
        """Which rule says that an obstacle is lost if the robot goes on."""
        if self.s > end - TINY or ahead > end + TINY:
            return "iii"
        near = self._in_reach(known, self.s, self.s)
        if back and not near and not self.from_line[k] and not self._in_reach(known, self.s, end):
            return "iv"
        later = self._in_reach(known, ahead, end if self.lookahead else ahead)
        now, then = self.line.point(self.s), self.line.point(ahead)
        hides = not len(self._view(k, then)) and len(self._view(k, now))
        if hides and not (self.lookahead and self._foreseen(known, ahead, end)):
            return "i"
        return "ii" if near and not later else None

    def _in_reach(self, known: NDArray[np.int64], low: float, high: float) -> bool:
        """Whether a sample is in reach somewhere between two places of one line."""
        start, along = self.line.point(low), self.line.point(high) - self.line.point(low)
        offset = self.samples.spots[known] - start
        share = np.clip(offset @ along / ((along @ along) or 1), 0, 1)
        return bool((np.hypot(*(offset - share[:, None] * along).T) <= self.radius + TINY).any())

    def _view(self, k: int, point: Floats) -> Floats:
        """Visible points of an obstacle: samples, or what is visible between them if no sample is.

        That is ends of what is visible of an edge: at the range or on a ray past a corner.
        """
        own = self.own[k][self._sees(point, self.own[k], self.walls)]
        if len(own):
            return self.samples.spots[own]
        chain, rays = self.parts[k].line.points, self.corners - point
        a, along = chain[:-1] - point, np.diff(chain, axis=0)
        across = along[:, None, 1] * rays[:, 0] - along[:, None, 0] * rays[:, 1]
        across[across == 0] = math.inf
        on_rays = (a[:, None, 0] * rays[:, 1] - a[:, None, 1] * rays[:, 0]) / across
        size = (along**2).sum(axis=1)
        foot = -(a * along).sum(axis=1) / size
        half = np.sqrt(np.maximum(foot**2 - ((a**2).sum(axis=1) - self.radius**2) / size, 0))
        share = np.hstack([on_rays, (foot - half)[:, None], (foot + half)[:, None]])
        edge, column = np.nonzero((share > 0) & (share < 1))
        spots = point + a[edge] + share[edge, column][:, None] * along[edge]
        normals = np.stack([along[edge, 1], -along[edge, 0]], axis=1)
        return spots[self._clear(point, spots, normals, self.walls)]

    def _foreseen(self, known: NDArray[np.int64], low: float, high: float) -> bool:
        """Whether by the map a known sample can be seen between two places of one line."""
        pieces = self.samples.pieces(self.samples.known, self.samples.shrunk)
        places = np.linspace(low, high, math.ceil((high - low) / self.step) + 2)
        places = np.append(places, [s for s in self.stops if low < s < high])
        places = np.concatenate([places[first::16] for first in range(16)])
        return any(self._sees(self.line.point(s), known, pieces).any() for s in places)

    def _nearest(self, k: int) -> Floats:
        """Q: the known (or visible) point of an obstacle nearest to the robot; of equals the least x."""
        samples, spots = self.samples, self._view(k, self.here)
        chosen = samples.known & (samples.part == k)
        if self.target == "visible" and len(spots):
            chosen[self.own[k]] = self._sees(self.here, self.own[k], self.walls)
        else:
            spots = samples.spots[chosen]
        pieces = samples.pieces(chosen, samples.spots)
        along = pieces[:, 1] - pieces[:, 0]
        share = ((self.here - pieces[:, 0]) * along).sum(axis=1) / (along**2).sum(axis=1)
        spots = np.concatenate([pieces[:, 0] + np.clip(share, 0, 1)[:, None] * along, spots])
        far = np.hypot(*(spots - self.here).T)
        return min(spots[far <= far.min() + TINY], key=lambda spot: (spot[0], spot[1]))

    def _divert(self, loss: Diversion) -> None:
        """Step 3."""
        self.out.diversions.append(loss)
        leave = self.here
        self._straight(np.array(loss.target), aim=loss.obstacle)
        goal = self.here
        self._tour(loss.obstacle)
        self._follow(self.parts[loss.obstacle].way(self.here, goal))
        self._straight(leave)

    def _straight(self, goal: Floats, aim: int | None = None) -> None:
        """To a goal around what is in the way; stops at a hit on the obstacle aimed at, if incomplete."""
        while True:
            way = _Line([self.here, goal])
            rows = [(pairs, k) for k, part in enumerate(self.parts) if (pairs := part.blocked(way))]
            if not rows:
                return self._go(goal)
            pairs, k = min(rows)
            self._go(way.point(pairs[0][0]))
            if self.missing[k] and k == aim:
                return None
            if self.missing[k]:
                self._tour(k)
            part, ends = self.parts[k], [way.point(b) for _, b in pairs]
            last = [end for end in ends if part.walkable(end)][-1]
            self._follow(part.way(self.here, last))
            self.here = last

    def _tour(self, k: int) -> None:
        self.out.visits.append(k)
        self._follow(self.parts[k].tour(self.here))
        self._learn(self.own[k], on_line=False)

    def _follow(self, corners: Iterable[Floats]) -> None:
        for corner in corners:
            self._go(corner)

    def _go(self, goal: Floats, on_line: bool = False) -> None:
        """Straight to a place, looking around at every step."""
        start, behind, size = self.here, self.out.length, math.dist(self.here, goal)
        for share in np.linspace(0, 1, max(1, math.ceil(size / self.step - TINY)) + 1)[1:]:
            self.here = goal if share == 1 else start + share * (goal - start)
            self.out.length = behind + float(share) * size
            self._sense(on_line)
        self.out.path.append(_spot(goal))

    def _sense(self, on_line: bool) -> None:
        """Register what is visible from here."""
        unknown = np.flatnonzero(~self.samples.known)
        self._learn(unknown[self._sees(self.here, unknown, self.walls)], on_line)

    def _learn(self, samples: NDArray[np.int64], on_line: bool) -> None:
        new = samples[~self.samples.known[samples]]
        self.samples.known[new] = True
        for k, count in zip(*np.unique(self.samples.part[new], return_counts=True), strict=True):
            self.from_line.setdefault(int(k), on_line)
            self.missing[k] -= int(count)
            if not self.missing[k]:
                self.out.acquisitions.append((int(k), self.out.length))

    def _sees(self, point: Floats, samples: NDArray[np.int64], walls: Floats) -> Mask:
        """Which samples are visible past walls (rows of start and end)."""
        return self._clear(point, self.samples.spots[samples], self.samples.normals[samples], walls)

    def _clear(self, point: Floats, spots: Floats, normals: Floats, walls: Floats) -> Mask:
        """Which spots are in range, face the point and are not behind a wall."""
        x, y = spots[:, 0] - point[0], spots[:, 1] - point[1]
        near = (x * x + y * y <= (self.radius + TINY) ** 2) & (x * normals[:, 0] + y * normals[:, 1] <= TINY)
        near, seen = np.flatnonzero(near), np.zeros(len(spots), bool)
        if len(near):
            x, y = x[near, None], y[near, None]
            a, b = walls[:, 0] - point, walls[:, 1] - walls[:, 0]
            side = x * a[:, 1] - y * a[:, 0]
            other_side = side + x * b[:, 1] - y * b[:, 0]
            front = b[:, 1] * a[:, 0] - b[:, 0] * a[:, 1]
            behind = front + b[:, 0] * y - b[:, 1] * x
            hidden = ((side >= 0) != (other_side >= 0)) & ((front >= 0) != (behind >= 0))
            seen[near[~hidden.any(axis=1)]] = True
        return seen


def _runs(ring: Floats, border: Mask) -> list[Floats]:
    """The chains of a closed ring between its edges on the border."""
    first = int(np.flatnonzero(border)[0])
    ring, border = np.roll(ring[:-1], -first, axis=0), np.roll(border, -first)
    stops = [*np.flatnonzero(border), len(border)]
    return [ring[np.arange(a + 1, b + 1) % len(ring)] for a, b in pairwise(stops) if b > a + 1]


def _beside(chain: Floats) -> shapely.Point:
    """A place just outside the middle of a chain's first edge."""
    dx, dy = (chain[1] - chain[0]) / math.dist(chain[0], chain[1])
    return shapely.Point((chain[0] + chain[1]) / 2 + INSET * np.array([dy, -dx]))


def _inset(chain: Floats, closed: bool) -> Floats:
    """A counterclockwise chain moved inwards by `INSET`; open ends go on a little, over the border."""
    along = np.diff(chain, axis=0)
    along /= np.hypot(*along.T)[:, None]
    before = np.concatenate([along[-1:] if closed else along[:1], along])
    after = np.concatenate([along, along[:1] if closed else along[-1:]])
    inward = np.stack([-(before + after)[:, 1], (before + after)[:, 0]], axis=1)
    out = chain + INSET * inward / (1 + (before * after).sum(axis=1))[:, None]
    if not closed and len(chain):
        out[[0, -1]] += 2 * INSET * np.stack([-along[0], along[-1]])
    return out


def _spot(point: Floats) -> Spot:
    return float(point[0]), float(point[1])


def _number(value: Any) -> float:
    return int(value.p) / int(value.q) if hasattr(value, "p") else float(value)
