"""Loops in floats: how they lie in each other, and how far places are from their chords.

Only proposals and descriptions are made of it; what is proposed is verified exactly elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from flint import fmpq
from numpy.typing import NDArray

from exactacq.cached import cached_property
from exactacq.files.loops.drawing import main_box
from exactacq.files.rereading import once
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.strokes import FLAT, Floats, Stroke
from exactacq.numbers.rationals import nearest_float
from exactacq.numbers.real import Real
from exactacq.scene.shapes import Shape, shape_edges

HUGE = 10**150
"""Coordinates beyond this are not sketched: squares of floats would overflow."""
AT_ONCE = 2_000_000
"""Pairs of a place and a chord that are looked at in one step, which bounds the memory."""
NEAR = 1e-9
"""What is nearer to a loop counts as on it, as a part of the width of everything."""
Bools = NDArray[np.bool_]


class Sketch:
    """The chords of closed loops; edges without length or of absurd size are left out."""

    def __init__(self, shapes: Sequence[Shape]) -> None:
        strokes = [strokes_of(shape_edges(shape)) for shape in shapes]
        rows = [[stroke.points() for stroke in row] for row in strokes]
        self.count = len(rows)
        self.lines = [np.concatenate(row) if row else np.zeros((0, 2)) for row in rows]
        """Of each loop the points along it, from its first vertex on."""
        parts = [(row[:-1], row[1:]) for points in rows for row in points]
        self.starts = np.concatenate([np.zeros((0, 2)), *(start for start, _ in parts)])
        self.ends = np.concatenate([np.zeros((0, 2)), *(end for _, end in parts)])
        sizes = [sum(len(row) - 1 for row in points) for points in rows]
        self.begin = np.cumsum([0, *sizes])
        curves = [stroke for row in strokes for stroke in row]
        counts = [len(start) for start, _ in parts]
        centers = [stroke.start if stroke.center is None else stroke.center for stroke in curves]
        self.centers = np.repeat(np.array(centers, dtype=float).reshape(-1, 2), counts, axis=0)
        self.radii = np.repeat(np.array([stroke.radius for stroke in curves], dtype=float), counts)
        """Of the circle that bulges beyond each chord; 0 of straight ones."""
        self._corners = [stroke.start for stroke in curves]
        self._extremes = [place for stroke in curves for place in stroke.extremes()]

    @classmethod
    def of(cls, shapes: Sequence[Shape]) -> Sketch:
        """The sketch of some loops, made once while a file is read several times."""
        return once(("sketch", *shapes), lambda: cls(shapes))

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to be seen."""
        return len(self.starts) == 0

    @property
    def box(self) -> tuple[Floats, Floats]:
        """The lower left and the upper right corner of everything."""
        places = np.array(self._extremes)
        return places.min(axis=0), places.max(axis=0)

    @cached_property
    def main_box(self) -> tuple[Floats, Floats]:
        """The corners of a box around all but what is far from everything else."""
        low, high = map(np.array, main_box(self._corners))
        corners = np.array(self._corners)
        inside = ((low <= corners) & (corners <= high)).all(axis=1)
        return self.box if inside.all() else (low, high)

    def around(self, places: Floats) -> Bools:
        """Which loops lie around which places: a row for each place."""
        found = np.zeros((len(places), self.count), dtype=bool)
        for k in range(self.count):
            found[:, k] = self._in_loop(k, places)
        return found

    def _in_loop(self, k: int, places: Floats) -> Bools:
        """Which places lie in a loop."""
        found = np.zeros(len(places), dtype=bool)
        start, end = self._chords(k)
        center, radius = self.centers[self._part(k)], self.radii[self._part(k)]
        if len(start):
            bulge = np.hypot(*(end - start)[radius > 0].T).max(initial=0.0)
            low, high = start.min(axis=0) - bulge, start.max(axis=0) + bulge
            near = np.flatnonzero(((places >= low) & (places <= high)).all(axis=1))
            for some in _steps(near, len(start)):
                at = places[some]
                found[some] = _crossed(at, start, end) ^ _bulged(at, start, end, center, radius)
        return found

    def clearance(self, places: Floats) -> Floats:
        """The distance of each place to the nearest chord."""
        return _least(places, self.starts, self.ends)

    @cached_property
    def nesting(self) -> Bools:
        """Row i: the loops around the first vertex of loop i, or around another one where that is on them."""
        known = [k for k in range(self.count) if len(self.lines[k])]
        found = np.zeros((self.count, self.count), dtype=bool)
        if known:
            first, later = (
                np.array([self.lines[k][n * len(self.lines[k]) // 2] for k in known]) for n in (0, 1)
            )
            inside = self.around(first)
            inside[np.arange(len(known)), known] = False
            near = NEAR * np.ptp(self.ends[:, 0])
            for k in np.flatnonzero(inside.any(axis=0)).tolist():
                rows = np.flatnonzero(inside[:, k])
                rows = rows[_least(first[rows], *self._chords(k)) <= near]
                inside[rows, k] = self._in_loop(k, later[rows])
            found[known] = inside
        return found

    def _chords(self, loop: int) -> tuple[Floats, Floats]:
        return self.starts[self._part(loop)], self.ends[self._part(loop)]

    def _part(self, loop: int) -> slice:
        return slice(self.begin[loop], self.begin[loop + 1])


def _least(places: Floats, starts: Floats, ends: Floats) -> Floats:
    """The distance of each place to the nearest of some chords."""
    least = np.full(len(places), np.inf)
    along = ends - starts
    size = np.maximum((along**2).sum(axis=1), 1e-300)
    for some in _steps(np.arange(len(places)), len(starts)):
        offset = places[some][:, None] - starts
        share = np.clip((offset * along).sum(axis=2) / size, 0, 1)
        offset -= share[..., None] * along
        least[some] = np.sqrt((offset**2).sum(axis=2).min(axis=1))
    return least


def points_of(edges: Sequence[Curve]) -> list[Floats]:
    """The points along each edge that can be shown."""
    return [stroke.points() for stroke in strokes_of(edges)]


def places_of(pairs: Iterable[tuple[fmpq, fmpq]]) -> list[tuple[float, float]]:
    """The places that can be shown."""
    return [(nearest_float(x), nearest_float(y)) for x, y in pairs if max(abs(x), abs(y)) <= HUGE]


def strokes_of(edges: Iterable[Curve]) -> list[Stroke]:
    """The edges that can be shown."""
    return [edge.stroke() for edge in edges if _is_shown(edge)]


def _is_shown(edge: Curve) -> bool:
    if any(abs(Real(c)) > HUGE for point in (edge.start, edge.end) for c in (point.x, point.y)):
        return False
    if isinstance(edge, Segment):
        return edge.start != edge.end
    return 0 < Real(edge.radius_sq) < HUGE**2 and (edge.full or edge.start != edge.end)


def _steps(members: NDArray[np.intp], width: int) -> list[NDArray[np.intp]]:
    """Some numbers in groups, so that a table of a group by *width* stays small."""
    return np.array_split(members, max(1, -(-len(members) * width // AT_ONCE))) if len(members) else []


def _crossed(places: Floats, starts: Floats, ends: Floats) -> Bools:
    """Which places are inside of the chords, by the number of these that the ray to the east crosses."""
    x, y = places[:, :1], places[:, 1:]
    across = (starts[:, 1] > y) != (ends[:, 1] > y)
    rise = np.where(starts[:, 1] == ends[:, 1], 1.0, ends[:, 1] - starts[:, 1])
    with np.errstate(over="ignore"):  # by lines of chords that are not crossed
        crossing = starts[:, 0] + (y - starts[:, 1]) * (ends[:, 0] - starts[:, 0]) / rise
    inside: Bools = ((across & (x < crossing)).sum(axis=1) % 2).astype(bool)
    return inside


def _bulged(places: Floats, starts: Floats, ends: Floats, centers: Floats, radii: Floats) -> Bools:
    """Which places lie between chords and their arcs, of an odd number of them."""
    arcs = (radii > 0) & (radii < FLAT * np.hypot(*(ends - starts).T))
    (ax, ay), (cx, cy), (ux, uy) = starts[arcs].T, centers[arcs].T, (ends - starts)[arcs].T
    x, y = places[:, :1], places[:, 1:]
    beyond = ux * (y - ay) - uy * (x - ax)
    side = ux * (cy - ay) - uy * (cx - ax)
    between = (np.sign(beyond) * np.sign(side) < 0) & (np.hypot(x - cx, y - cy) < radii[arcs])
    inside: Bools = (between.sum(axis=1) % 2).astype(bool)
    return inside
