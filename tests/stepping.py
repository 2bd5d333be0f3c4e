"""A stepping simulator of the sensing Sightseer, built on shapely: the peer of exact sensing.

It walks a finished run's path in steps of R / 100 and looks around at each. Everything is approximate: what
is seen only between two steps is missed, lengths of events are good to one step, and arcs are cut into
chords. Loss and regain of sight are not reported. Three ways to look, from the textbook's to the quickest:

- "polygon": the visibility polygon of limited range within the window of obstacles in reach (a disc less the
  shadows), and the parts of the boundaries in reach that the shadows leave;
- "lazy": the same parts, but only of edges in reach that are not wholly known yet, and shadows only of
  what can hide those; steps where nothing is left to learn cost one query of the spatial index;
- "cgal": the same as "polygon", but the whole scene's visibility polygon from pyvispoly, cut with the disc.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray

from exactacq import Scene
from exactacq.geometry.curves import Arc, Curve

Floats = NDArray[np.float64]

BEND = math.pi / 32
"""Largest angle of an arc that one chord stands for."""
BEHIND = 1e-7
"""Shadows begin this share of the distance behind what throws them, so that they do not hide it."""
TOUCH = 1e-9
"""Closer than this to an edge the robot stands on it."""
OFF = 1e-6
"""So far off the boundary it looks from there: its own edges throw shadows like all others."""
CLOSE = 1e-6
"""Parts of an edge that are closer than this, as lengths, are joined."""


@dataclass(frozen=True)
class StepEvent:
    """A sight or an acquisition after about this length of path."""

    kind: str
    obstacle: int
    at: float


@dataclass
class StepMap:
    """What the steps have shown: for each chord of the boundaries sorted parts, as lengths from its start."""

    lengths: Floats
    owner: NDArray[np.int64]
    parts: list[list[tuple[float, float]]]
    done: NDArray[np.bool_]
    events: list[StepEvent] = field(default_factory=list)

    @property
    def known_lengths(self) -> Floats:
        """Known length of each obstacle's boundary."""
        out = np.zeros(int(self.owner.max()) + 1)
        for edge, parts in enumerate(self.parts):
            out[self.owner[edge]] += sum(high - low for low, high in parts)
        return out


class Stepper:
    """The robot that looks around after every step; made once a scene and radius."""

    def __init__(self, scene: Scene, radius: object, look: str = "polygon") -> None:
        self.radius, self.look = float(radius), look
        self.a, self.b, loops = chords(scene)
        self.owner = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
        self.first = np.concatenate([[0], np.cumsum([len(loop) for loop in loops])])
        self.lengths = np.hypot(*(self.b - self.a).T)
        self.along = (self.b - self.a) / self.lengths[:, None]
        sides = [np.roll(loop, -1, axis=0) - loop for loop in loops]
        self.convex = np.array([bool((_cross(s, np.roll(s, -1, axis=0)) >= 0).all()) for s in sides])
        self.edges = shapely.linestrings(np.stack([self.a, self.b], axis=1))
        self.tree = shapely.STRtree(self.edges)
        self.cgal = _Cgal(scene, self.radius) if look == "cgal" else None
        self.map = StepMap(self.lengths, self.owner, [[] for _ in self.a], np.zeros(len(self.a), dtype=bool))
        self.missing = np.diff(self.first)
        self.sighted = np.zeros(len(loops), dtype=bool)

    def walk(self, curves: Iterable[Curve], limit: int | None = None) -> StepMap:
        """Walk the curves (at most *limit* steps of R / 100) and look around at every step."""
        for count, (point, length) in enumerate(steps(curves, self.radius / 100)):
            if limit is not None and count >= limit:
                break
            self._see(point, length)
        return self.map

    def _see(self, point: Floats, length: float) -> None:
        near = self.tree.query(shapely.Point(point), predicate="dwithin", distance=self.radius)
        own = self._passes(near, point)
        if own.any():
            along = self.along[near[own]].sum(axis=0)
            point = point + OFF * np.array([along[1], -along[0]])
        front = _cross(self.along[near], point - self.a[near]) < 0
        wanted = front | own
        if self.look == "lazy":
            wanted &= ~self.map.done[near]
        edges, bare = near[wanted], own[wanted]
        low, high = self._in_range(point, edges)
        bare, some = bare & (low < high), ~bare & (low < high)
        self._add(edges[bare], low[bare], high[bare], length)
        edges, low, high = edges[some], low[some], high[some]
        if not len(edges) and self.look == "lazy":
            return
        lines = shapely.linestrings(np.stack([self._at(edges, low), self._at(edges, high)], axis=1))
        if self.look == "lazy":
            self._see_lines(lines, edges, low, high, self._shadows(point, near[front]), length)
            return
        seen = self._polygon(point, near[front])
        shapely.prepare(seen)
        whole = shapely.covers(seen, lines)
        self._add(edges[whole], low[whole], high[whole], length)
        some = shapely.intersects(seen, lines) & ~whole
        self._add_pieces(shapely.intersection(lines[some], seen), edges[some], length)

    def _passes(self, edges: NDArray[np.int64], point: Floats) -> NDArray[np.bool_]:
        """Which edges the point lies on."""
        offset = point - self.a[edges]
        foot = (offset * self.along[edges]).sum(axis=1)
        within = (foot >= -TOUCH) & (foot <= self.lengths[edges] + TOUCH)
        return within & (np.abs(_cross(self.along[edges], offset)) <= TOUCH)

    def _see_lines(
        self,
        lines: NDArray[np.object_],
        edges: NDArray[np.int64],
        low: Floats,
        high: Floats,
        shadows: NDArray[np.object_],
        length: float,
    ) -> None:
        """Each line less the shadows that it meets."""
        hidden = shapely.intersects(lines[:, None], shadows)
        whole = ~hidden.any(axis=1)
        self._add(edges[whole], low[whole], high[whole], length)
        for k in np.flatnonzero(~whole):
            left = lines[k]
            for shadow in shadows[hidden[k]]:
                left = shapely.difference(left, shadow)
                if left.is_empty:
                    break
            else:
                self._add_pieces(np.array([left]), edges[k : k + 1], length)

    def _polygon(self, point: Floats, front: NDArray[np.int64]) -> shapely.Geometry:
        """The visibility polygon of limited range, a little larger where it ends at obstacles."""
        if self.cgal is not None:
            return self.cgal.polygon(point)
        disc = shapely.Point(point).buffer(self.radius * (1 + 1e-3), quad_segs=32)
        return shapely.difference(disc, shapely.union_all(self._shadows(point, front)))

    def _shadows(self, point: Floats, front: NDArray[np.int64]) -> NDArray[np.object_]:
        """What the obstacles hide: of a convex one a single hull, of others what each edge in front hides."""
        out: list[shapely.Geometry] = []
        owner = self.owner[front]
        hull = self.convex[owner]
        sizes = np.diff(self.first)
        for size in np.unique(sizes[owner[hull]]):
            loops = np.unique(owner[hull & (sizes[owner] == size)])
            out += list(self._thrown(point, self.a[self.first[loops][:, None] + np.arange(size)]))
        if not hull.all():
            rest = front[~hull]
            out += list(self._thrown(point, np.stack([self.a[rest], self.b[rest]], axis=1)))
        return np.array(out)

    def _thrown(self, point: Floats, corners: Floats) -> NDArray[np.object_]:
        """The shadows of the hulls of rows of corners, cut off far away; they start a little behind them."""
        ray = corners - point
        size = np.hypot(ray[..., 0], ray[..., 1])[..., None]
        middle = ray.mean(axis=1, keepdims=True)
        angle = np.arctan2(_cross(middle, ray), (middle * ray).sum(axis=2))
        # A shadow can be half a plane: its corners far away need one between them.
        angle = (angle.min(axis=1) + angle.max(axis=1)) / 2 + np.arctan2(middle[:, 0, 1], middle[:, 0, 0])
        axis = np.stack([np.cos(angle), np.sin(angle)], axis=1)[:, None, :]
        far = np.concatenate([ray / np.maximum(size, 1e-12), axis], axis=1) * 10 * self.radius
        spots = point + np.concatenate([ray * (1 + BEHIND), far], axis=1)
        return shapely.convex_hull(shapely.linestrings(spots))

    def _in_range(self, point: Floats, edges: NDArray[np.int64]) -> tuple[Floats, Floats]:
        """The lengths along edges between which they are within range."""
        offset = point - self.a[edges]
        foot = (offset * self.along[edges]).sum(axis=1)
        half = np.sqrt(np.maximum(self.radius**2 - _cross(self.along[edges], offset) ** 2, 0))
        return np.maximum(foot - half, 0), np.minimum(foot + half, self.lengths[edges])

    def _at(self, edges: NDArray[np.int64], along: Floats) -> Floats:
        return self.a[edges] + along[:, None] * self.along[edges]

    def _add_pieces(self, pieces: NDArray[np.object_], edges: NDArray[np.int64], length: float) -> None:
        """Register lines that are parts of edges."""
        parts, of = shapely.get_parts(pieces, return_index=True)
        lines = shapely.get_type_id(parts) == 1
        parts, of = parts[lines & ~shapely.is_empty(parts)], of[lines & ~shapely.is_empty(parts)]
        if len(parts):
            edges = edges[of]
            ends = shapely.get_coordinates(shapely.get_point(parts, [[0], [-1]])).reshape(2, -1, 2)
            s = ((ends - self.a[edges]) * self.along[edges]).sum(axis=2)
            self._add(edges, s.min(axis=0), s.max(axis=0), length)

    def _add(self, edges: NDArray[np.int64], low: Floats, high: Floats, length: float) -> None:
        """Register parts of edges as known."""
        open_ = ~self.map.done[edges]
        rows = (values[open_].tolist() for values in (edges, low, high))
        for edge, start, end in zip(*rows, strict=True):
            parts = self.map.parts[edge] = _union(self.map.parts[edge], start, end)
            loop = int(self.owner[edge])
            if not self.sighted[loop]:
                self.sighted[loop] = True
                self.map.events.append(StepEvent("sight", loop, length))
            if parts[0][0] <= CLOSE and parts[0][1] >= self.lengths[edge] - CLOSE:
                self.map.done[edge] = True
                self.missing[loop] -= 1
                if not self.missing[loop]:
                    self.map.events.append(StepEvent("acquire", loop, length))


class _Cgal:
    """Visibility polygons from pyvispoly, in a square around the scene that is nowhere within range."""

    def __init__(self, scene: Scene, radius: float) -> None:
        import peers

        self.radius, self.place = radius, peers.place
        self.views = peers.views(scene, peers.square_around(scene, 2 * radius))

    def polygon(self, point: Floats) -> shapely.Geometry:
        """The view within range, grown a little: its floats do not quite lie on the obstacles' edges."""
        seen = self.views.compute_visibility_polygon(self.place(point.tolist()))
        corners = [(float(p.x()), float(p.y())) for p in seen.boundary()]
        disc = shapely.Point(point).buffer(self.radius * (1 + 1e-3), quad_segs=32)
        return shapely.intersection(shapely.Polygon(corners).buffer(BEHIND, quad_segs=1), disc)


def _union(parts: list[tuple[float, float]], start: float, end: float) -> list[tuple[float, float]]:
    """Sorted disjoint parts with one more."""
    before = [part for part in parts if part[1] < start - CLOSE]
    after = [part for part in parts if part[0] > end + CLOSE]
    touched = parts[len(before) : len(parts) - len(after)]
    if touched:
        start, end = min(start, touched[0][0]), max(end, touched[-1][1])
    return [*before, (start, end), *after]


def _cross(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def chords(scene: Scene) -> tuple[Floats, Floats, list[Floats]]:
    """Starts and ends of the chords of all boundaries, and the starts by obstacle."""
    loops = [_flat(obstacle.edges) for obstacle in scene.obstacles]
    return np.concatenate(loops), np.concatenate([np.roll(loop, -1, axis=0) for loop in loops]), loops


def _flat(curves: Sequence[Curve]) -> Floats:
    """The starts of the chords of a loop."""
    return np.concatenate([_chain(curve)[:-1] for curve in curves])


def _chain(curve: Curve) -> Floats:
    """Points along a curve, both ends included, so that chords turn by `BEND` at most."""
    ends = np.array([curve.start.xy, curve.end.xy])
    if not isinstance(curve, Arc):
        return ends
    ray = ends - np.array(curve.center.xy)
    first, last = np.arctan2(ray[:, 1], ray[:, 0])
    turn = (last - first) % (2 * math.pi) if curve.ccw else -((first - last) % (2 * math.pi))
    if curve.full or turn == 0:
        turn = 2 * math.pi if curve.ccw else -2 * math.pi
    angles = first + turn * np.linspace(0, 1, max(2, math.ceil(abs(turn) / BEND)) + 1)
    chain = np.array(curve.center.xy) + float(curve.radius) * np.stack([np.cos(angles), np.sin(angles)], 1)
    chain[0], chain[-1] = ends
    return chain


def steps(curves: Iterable[Curve], step: float) -> Iterator[tuple[Floats, float]]:
    """The start and every further *step* along the path, and its end."""
    behind, into = 0.0, 0.0
    here = None
    for curve in curves:
        chain = _chain(curve)
        for start, end in pairwise(chain):
            size = float(np.hypot(*(end - start)))
            while into <= size and size:
                yield start + into / size * (end - start), behind + into
                into += step
            into, behind, here = into - size, behind + size, end
    if here is not None:
        yield here, behind
