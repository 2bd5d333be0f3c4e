"""Broad phase: float boxes that provably contain their curves, and an index of boxes.

Floats only prune here: a box is rounded outward, so two curves whose boxes are disjoint are disjoint.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from math import hypot, inf, nextafter

import numpy as np
from flint import arb
from numpy.typing import NDArray

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import spans
from exactacq.geometry.late import balls, clearly_between, from_to
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.real import Real

Boxes = NDArray[np.float64]
Indices = NDArray[np.int64]

DIRECTIONS = ((-1, 0), (0, -1), (1, 0), (0, 1))
"""West, south, east, north: the sides of a box in the order (x0, y0, x1, y1)."""

RATIO = 4.0
"""Quotient of the cell sizes of neighbouring levels; 2 doubles the levels, 8 the false candidates."""
FEWEST = 32
"""A level with fewer boxes joins the next coarser one: it would cost more than it prunes."""
CHUNK = 1 << 20
"""Candidate pairs handled at once: bounds the memory (about 50 bytes a pair) on hostile scenes."""

SCANNED = 1 << 13
"""Up to so many boxes a window is compared with all of them: that takes less than looking up cells."""
FLAT = 1000
"""An arc whose radius is so many times its chord has one extreme point at most, or nearly all of them."""
TINY = 1e-290
"""Added to margins: covers what underflow loses."""
LIMIT = 1e300
"""Coordinates are clipped to this for filing (never for the final comparison): infinities have no cell."""


def box(curve: Curve) -> tuple[float, float, float, float]:
    """(x0, y0, x1, y1) that contains the curve, at most a few units in the last place too large.

    Which of its circle's extreme points an arc contains is decided exactly where balls leave it open.
    """
    (ax, ay), (bx, by) = (_nearest(p.x, p.y) for p in (curve.start, curve.end))
    sides = [_down(min(ax, bx)), _down(min(ay, by)), _up(max(ax, bx)), _up(max(ay, by))]
    if isinstance(curve, Arc):
        center = _nearest(curve.center.x, curve.center.y)
        radius, extremes = _up(_nearest(curve.radius)[0]), list(_extremes(curve))
        chord = hypot(*_nearest(curve.end.x - curve.start.x, curve.end.y - curve.start.y))
        # Less than half a circle rises above its chord c by c^2 / (4 r + 4 sqrt(r^2 - c^2 / 4)). Sums with a
        # large radius are coarser.
        rise = inf
        if len(extremes) == 1 and FLAT * chord < radius < inf:
            rise = chord * (chord / radius) * (1 + 1 / FLAT) / 8 + TINY
        for k in extremes:
            middle = center[k % 2]
            if k < 2:
                sides[k] = max(_down(_down(middle) - radius), _down(sides[k] - rise))
            else:
                sides[k] = min(_up(_up(middle) + radius), _up(sides[k] + rise))
    return sides[0], sides[1], sides[2], sides[3]


def _extremes(arc: Arc) -> Iterator[int]:
    """The numbers of the directions in which an arc has the extreme point of its circle."""
    start, end = (arc.start, arc.end) if arc.ccw else (arc.end, arc.start)
    if arc.full or (start.rational is not None and end.rational is not None):
        yield from (k for k, direction in enumerate(DIRECTIONS) if spans(arc, direction))
        return
    center = balls(arc.center)
    first, last = from_to(center, balls(start)), from_to(center, balls(end))
    for k, (u, v) in enumerate(DIRECTIONS):
        clear = clearly_between(first, last, (arb(u), arb(v)))
        if spans(arc, (u, v)) if clear is None else clear:
            yield k


def bounds(curves: Sequence[Curve]) -> Boxes:
    """The boxes of curves as an array of shape (n, 4)."""
    return np.array([box(curve) for curve in curves], dtype=np.float64).reshape(-1, 4)


def united(boxes: Boxes, first: Sequence[int] | Indices) -> Boxes:
    """The boxes around groups of boxes that follow each other, none empty; *first* is where groups begin."""
    if not len(boxes):
        return np.zeros((0, 4))
    low = np.minimum.reduceat(boxes[:, :2], first, axis=0)
    return np.hstack((low, np.maximum.reduceat(boxes[:, 2:], first, axis=0)))


def circles(curves: Sequence[Curve]) -> NDArray[np.float64]:
    """Centre and radius of the circle of every arc in the nearest floats, zeros for segments."""
    rows = [
        _nearest(c.center.x, c.center.y, c.radius) if isinstance(c, Arc) else (0.0, 0.0, 0.0) for c in curves
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 3)


def _nearest(*values: Real) -> tuple[float, ...]:
    """The nearest floats; beyond their range an infinity, which `_up` and `_down` treat correctly."""
    return tuple(_float(value) for value in values)


def _float(value: Real) -> float:
    try:
        return float(value)
    except OverflowError:
        return inf if value.sign() > 0 else -inf


def _up(value: float) -> float:
    return nextafter(value, inf)


def _down(value: float) -> float:
    return nextafter(value, -inf)


class BoxIndex:
    """An index of closed boxes for windows and for overlapping pairs.

    Boxes are sorted into levels by size; a level is a sparse grid whose cells are at least twice as wide as
    its boxes, each box filed once, under the cell of its lower left corner. So memory is linear whatever the
    sizes and the extent, building costs a sort, and a window at constant density costs some microseconds a
    level. Boxes must not contain NaN; infinite ones are allowed.
    """

    def __init__(self, array: Boxes) -> None:
        self.boxes: Boxes = np.ascontiguousarray(array, dtype=np.float64).reshape(-1, 4)
        self._levels = [_Level(self.boxes, members, size) for members, size in _sort_by_size(self.boxes)]
        self._sides = self.boxes.T.copy() if len(self.boxes) <= SCANNED else None

    def __len__(self) -> int:
        return len(self.boxes)

    def query(self, x0: float, y0: float, x1: float, y1: float) -> Indices:
        """Ascending indices of the boxes that meet a closed window."""
        if self._sides is not None:
            left, low, right, high = self._sides
            meets = left <= x1
            meets &= right >= x0
            meets &= low <= y1
            meets &= high >= y0
            return np.flatnonzero(meets)
        window = [min(max(side, -LIMIT), LIMIT) for side in (x0, y0, x1, y1)]
        found = [run for level in self._levels for run in level.window(*window)]
        indices = np.concatenate(found) if found else np.empty(0, np.int64)
        b = self.boxes[indices]
        meets = (b[:, 0] <= x1) & (b[:, 2] >= x0) & (b[:, 1] <= y1) & (b[:, 3] >= y0)
        result = indices[meets]
        result.sort()
        return result

    def pairs(self) -> Iterator[tuple[Indices, Indices]]:
        """Every pair i < j of overlapping boxes once, in chunks: two arrays of equal length each time.

        Within a level each pair is met from both sides and kept once; between levels the smaller boxes ask
        the coarser grid. Cost: near linear plus the number of pairs that share cells.
        """
        for k, level in enumerate(self._levels):
            for coarser in self._levels[k:]:
                for owner, second in coarser.candidates(self.boxes[level.members]):
                    first = level.members[owner]
                    keep = _overlap(self.boxes[first], self.boxes[second])
                    if coarser is level:
                        keep &= first < second
                    a, b = first[keep], second[keep]
                    if len(a):
                        yield np.minimum(a, b), np.maximum(a, b)


def _overlap(a: Boxes, b: Boxes) -> NDArray[np.bool_]:
    return np.logical_and((a[:, :2] <= b[:, 2:]).all(axis=1), (b[:, :2] <= a[:, 2:]).all(axis=1))


def _sort_by_size(array: Boxes) -> Iterator[tuple[Indices, float]]:
    """Groups of box indices with the cell size of each, from small to large."""
    if not len(array):
        return
    finite = np.clip(array, -LIMIT, LIMIT)
    side = np.maximum(finite[:, 2] - finite[:, 0], finite[:, 3] - finite[:, 1])
    # A cell is never finer than 2^-44 of its coordinates: cell numbers stay exact integers below 2^46.
    side = np.maximum(side, np.abs(finite).max(axis=1) * 2.0**-44)
    exponent = np.ceil(np.log2(np.maximum(side, 1e-300)) / np.log2(RATIO)).astype(np.int64)
    order = np.argsort(exponent, kind="stable")
    levels, starts = np.unique(exponent[order], return_index=True)
    begin = 0
    for level, end in zip(levels, [*starts[1:], len(order)], strict=True):
        if end - begin >= FEWEST or end == len(order):
            yield order[begin:end], 2.0 * RATIO ** float(level)
            begin = end


class _Level:
    """A sparse grid over some of the boxes: occupied rows and columns are numbered, cells sorted by both."""

    def __init__(self, array: Boxes, members: Indices, size: float) -> None:
        self.size = size
        corner = np.clip(array[members, :2], -LIMIT, LIMIT)
        cells = np.floor(corner / size)
        self.columns, column = np.unique(cells[:, 0], return_inverse=True)
        self.rows, row = np.unique(cells[:, 1], return_inverse=True)
        keys = row * len(self.columns) + column
        order = np.argsort(keys, kind="stable")
        self.keys, self.members = keys[order], members[order]
        # One window is looked up by bisection of lists, several times faster than numpy's calls.
        self._lists = self.columns.tolist(), self.rows.tolist(), self.keys.tolist()

    def window(self, x0: float, y0: float, x1: float, y1: float) -> Iterator[Indices]:
        """Runs of box indices that hold every box of the level that meets the window."""
        columns, rows, keys = self._lists
        size = self.size
        left, right = bisect_left(columns, x0 // size - 1), bisect_right(columns, x1 // size)
        bottom, top = bisect_left(rows, y0 // size - 1), bisect_right(rows, y1 // size)
        if left >= right:
            return
        if right - left == len(columns):
            bottom, top = bottom * len(columns), top * len(columns)
            yield self.members[bisect_left(keys, bottom) : bisect_left(keys, top)]
            return
        for row in range(bottom * len(columns), top * len(columns), len(columns)):
            begin = bisect_left(keys, row + left)
            end = bisect_left(keys, row + right, begin)
            if begin < end:
                yield self.members[begin:end]

    def candidates(self, windows: Boxes) -> Iterator[tuple[Indices, Indices]]:
        """(window number, box index) for every box filed in a cell that may hold boxes meeting the window.

        In chunks: a window's rows first, then each row's run of cells.
        """
        with np.errstate(over="ignore"):
            cells = np.floor(np.clip(windows, -LIMIT, LIMIT) / self.size)
        width = len(self.columns)
        left = np.searchsorted(self.columns, cells[:, 0] - 1)
        right = np.searchsorted(self.columns, cells[:, 2], side="right")
        bottom = np.searchsorted(self.rows, cells[:, 1] - 1)
        top = np.searchsorted(self.rows, cells[:, 3], side="right")
        top = np.where(left < right, top, bottom)
        for some in _batches(top - bottom):
            owner, row = _ranges(bottom[some], top[some])
            owner += some.start
            begin = np.searchsorted(self.keys, row * width + left[owner])
            end = np.searchsorted(self.keys, row * width + right[owner])
            for runs in _batches(end - begin):
                run, position = _ranges(begin[runs], end[runs])
                yield owner[runs][run], self.members[position]


def _batches(counts: Indices) -> Iterator[slice]:
    """Consecutive slices whose counts add up to `CHUNK` or to a single item's count."""
    total = np.cumsum(counts)
    begin = 0
    while begin < len(counts):
        done = total[begin - 1] if begin else 0
        end = max(begin + 1, int(np.searchsorted(total, done + CHUNK, side="right")))
        yield slice(begin, end)
        begin = end


def _ranges(begin: Indices, end: Indices) -> tuple[Indices, Indices]:
    """All integers of the ranges begin[k] <= i < end[k], as (k, i)."""
    counts = end - begin
    owner = np.repeat(np.arange(len(counts)), counts)
    offset = begin - (np.cumsum(counts) - counts)
    return owner, np.arange(len(owner)) + offset[owner]


class Separator:
    """Tells many pairs of curves apart in floats, with a margin that covers the rounding.

    Boxes do not separate long slanted neighbours or nested arcs; the line of a segment and the circle of an
    arc do. Each curve is held by four points whose convex hull contains it: a segment by its ends, an arc by
    its box.
    """

    def __init__(self, curves: Sequence[Curve], boxes: Boxes) -> None:
        hulls = boxes[:, [0, 1, 2, 1, 2, 3, 0, 3]].reshape(-1, 4, 2)
        self.is_segment = np.array([isinstance(curve, Segment) for curve in curves], dtype=bool)
        for k, curve in enumerate(curves):
            if isinstance(curve, Segment):
                ends = [_nearest(p.x, p.y) for p in (curve.start, curve.end)]
                hulls[k] = [*ends, *ends]
        self.hulls, self.circles = hulls, circles(curves)

    def separated(self, first: Indices, second: Indices) -> NDArray[np.bool_]:
        """True only for pairs that certainly do not meet."""
        with np.errstate(over="ignore", invalid="ignore"):
            apart = self._beside_line(first, second) | self._beside_line(second, first)
            return np.logical_or(apart, self._off_circle(first, second))

    def _beside_line(self, segments: Indices, others: Indices) -> NDArray[np.bool_]:
        """The hull of the other curve is strictly on one side of the segment's line.

        Coordinates of size m have errors up to 2^-53 m, differences 2^-51 m, the determinant less than
        2^-46 m^2: m is taken over all six points.
        """
        a, b = self.hulls[segments, 0, None], self.hulls[segments, 1, None]
        hull = self.hulls[others]
        along, offset = b - a, hull - a
        side = along[..., 0] * offset[..., 1] - along[..., 1] * offset[..., 0]
        size = np.maximum(np.abs(hull).max(axis=(1, 2)), np.abs(self.hulls[segments]).max(axis=(1, 2)))
        error = size * size * margin(2.0**-46) + TINY
        apart = (side.min(axis=1) > error) | (side.max(axis=1) < -error)
        beside: NDArray[np.bool_] = apart & self.is_segment[segments]
        return beside

    def _off_circle(self, first: Indices, second: Indices) -> NDArray[np.bool_]:
        """Two arcs whose circles are apart or one within the other."""
        a, b = self.circles[first], self.circles[second]
        gap = np.hypot(a[:, 0] - b[:, 0], a[:, 1] - b[:, 1])
        size = np.maximum(np.abs(a).max(axis=1), np.abs(b).max(axis=1))
        error = size * margin(2.0**-46) + TINY
        apart = (gap > a[:, 2] + b[:, 2] + error) | (gap < np.abs(a[:, 2] - b[:, 2]) - error)
        off: NDArray[np.bool_] = apart & ~self.is_segment[first] & ~self.is_segment[second]
        return off
