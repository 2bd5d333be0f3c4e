"""Known pieces of boundaries as float arrays, what lines of sight can touch of them, and such lines.

The arrays only prune lines of sight that are certainly blocked: `decide`, in this folder, says what is
examined and why.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.float_bounds import margin

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.intp]
Flags: TypeAlias = NDArray[np.bool_]

TINY = 1e-300
MARGIN = 1e-11
"""Margin of lengths, for coordinates of size 1: 10^4 times the rounding errors of the formulas."""
ANGLE = 1e-10
"""Margin of sines of angles."""
CHUNK, BATCH = 2048, 16
"""How many lines and pieces are compared at once, where there are many: a table that fits into the cache."""


def cross(a: Floats, b: Floats) -> Any:
    """z of vector products, row by row."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def dot(a: Floats, b: Floats) -> Any:
    """Scalar products, row by row."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]


def norm(a: Floats) -> Floats:
    """Lengths, row by row."""
    lengths: Floats = np.hypot(a[..., 0], a[..., 1])
    return lengths


def left(a: Floats) -> Floats:
    """Vectors turned by a quarter, counterclockwise."""
    return np.stack((-a[..., 1], a[..., 0]), axis=-1)


def unit(a: Floats) -> Floats:
    """Vectors scaled to length 1; zero stays zero."""
    scaled: Floats = a / np.maximum(norm(a), TINY)[..., None]
    return scaled


def chords(way: Floats, offset: Floats, radius: Floats) -> tuple[Floats, Floats, Floats]:
    """Where lines with unit directions pass circles, whose centres lie at offsets from a place of each.

    How far along the line the centre's foot lies, how far to the left the centre lies, and half the length of
    the chord: 0 if the line misses the circle.
    """
    foot, height = dot(offset, way), cross(way, offset)
    return foot, height, np.sqrt(np.maximum(radius * radius - height * height, 0.0))


class Pieces:
    """Known pieces of boundaries as flat arrays, and where they join.

    ``before[k]`` is the piece that ends where piece k starts, ``after[k]`` the one that starts where it ends;
    -1 where knowledge ends. ``slack`` is the margin of lengths, infinite if tests want nothing decided by
    floats; ``grain`` tells what is too close for lines to be computed in floats.
    """

    def __init__(self, curves: Sequence[Curve], size: float) -> None:
        self.curves = curves
        self.grain = MARGIN * size
        self.slack = margin(self.grain)
        ends = np.array([(*c.start.xy, *c.end.xy) for c in curves]).reshape(-1, 4)
        self.start, self.end = ends[:, :2], ends[:, 2:]
        self.sense = np.array([c.ccw * 2 - 1 if isinstance(c, Arc) else 0 for c in curves], dtype=float)
        self.full = np.array([isinstance(c, Arc) and c.start == c.end for c in curves], dtype=bool)
        circles = [(*c.center.xy, float(c.radius)) if isinstance(c, Arc) else (0.0, 0.0, 1.0) for c in curves]
        table = np.array(circles).reshape(-1, 3)
        self.center, self.radius = table[:, :2], table[:, 2]
        self._blocked = np.zeros(len(curves), dtype=np.intp)
        close = norm(self.end[:, None] - self.start[None]) <= self.slack
        self.before = np.full(len(curves), -1)
        self.after = np.full(len(curves), -1)
        for i, j in np.argwhere(close):
            if curves[i].end == curves[j].start:
                self.after[i], self.before[j] = j, i

    def tangents(self, k: Ints, at: Floats) -> Floats:
        """Unit directions of travel of pieces k at points of them."""
        straight = unit(self.end[k] - self.start[k])
        round_ = left(at - self.center[k]) * (self.sense[k] / self.radius[k])[:, None]
        return np.where(self.sense[k, None] == 0, straight, round_)

    def possible(self, p: Floats, q: Floats) -> Ints:
        """The pieces that the segment from p to q does not certainly miss."""
        d, slack = unit(q - p), self.slack
        a, b = cross(d, self.start - p), cross(d, self.end - p)
        along = unit(self.end - self.start)
        s, t = cross(along, p - self.start), cross(along, q - self.start)
        straight = (np.maximum(a, b) < -slack) | (np.minimum(a, b) > slack)
        straight |= (np.maximum(s, t) < -slack) | (np.minimum(s, t) > slack)
        reach = np.clip(dot(self.center - p, d), 0.0, float(norm(q - p)))
        off = norm(self.center - p - reach[:, None] * d) > self.radius + slack
        within = np.maximum(norm(p - self.center), norm(q - self.center)) < self.radius - slack
        wide = norm(self.end - self.start) > 1e-6 * self.radius
        aside = wide & (np.minimum(s * self.sense, t * self.sense) > slack)
        missed = np.where(self.sense == 0, straight, off | within | aside & ~self.full)
        return np.flatnonzero(~missed)

    def block(self, p: Floats, q: Floats, error: Floats) -> Flags:
        """Which segments, with ends known up to an error, certainly cross a piece inside it."""
        found = np.zeros(len(p), dtype=bool)
        # What has blocked most comes first: few segments are left for the other pieces.
        order = np.argsort(-self._blocked, kind="stable")
        while len(order) and len(left_over := np.flatnonzero(~found)):
            width = max(BATCH, CHUNK * BATCH // len(left_over))
            some, order = order[:width], order[width:]
            is_straight = self.sense[some] == 0
            for k in range(0, len(left_over), CHUNK):
                rows = left_over[k : k + CHUNK]
                a, b, errors = p[rows, None], q[rows, None], error[rows, None]
                crossed = np.zeros((len(rows), len(some)), dtype=bool)
                crossed[:, is_straight] = self._crossed_straight(a, b, errors, some[is_straight])
                crossed[:, ~is_straight] = self._crossed_round(a, b, errors, some[~is_straight])
                found[rows] = crossed.any(axis=1)
                self._blocked[some] += crossed.sum(axis=0)
        return found

    def _crossed_straight(self, p: Floats, q: Floats, error: Floats, k: Ints) -> Flags:
        length, d = norm(q - p), unit(q - p)
        a, b = self.start[k] - p, self.end[k] - p
        along = unit(b - a)
        grown = self.slack + error * (1 + 2 * np.maximum(norm(a), norm(b)) / np.maximum(length, TINY))
        one, two = cross(d, a), cross(d, b)
        parted = (one * two < 0) & (np.minimum(np.abs(one), np.abs(two)) > grown)
        one, two = -cross(along, a), cross(along, q - p - a)
        parted &= (one * two < 0) & (np.minimum(np.abs(one), np.abs(two)) > self.slack + error)
        return np.asarray(parted)

    def _crossed_round(self, p: Floats, q: Floats, error: Floats, k: Ints) -> Flags:
        length, d = norm(q - p), unit(q - p)
        radius, sense, full = self.radius[k], self.sense[k], self.full[k]
        offset = self.center[k] - p
        height, middle = cross(d, offset), dot(offset, d)
        grown = self.slack + error * (1 + 2 * (norm(offset) + radius) / np.maximum(length, TINY))
        deep = np.abs(height) < radius - 2 * grown
        half = np.sqrt(np.maximum(radius * radius - height * height, TINY))
        shift = grown * (2 + 2 * radius / half)
        chord = self.end[k] - self.start[k]
        wide = norm(chord) > 1e-6 * radius
        crossed = np.zeros(height.shape, dtype=bool)
        for root in (middle - half, middle + half):
            inner = (root > shift) & (root < length - shift)
            place = p + root[..., None] * d
            side = cross(unit(chord), place - self.start[k]) * -sense
            inside = full | wide & (side > shift)
            crossed |= deep & inner & inside
        return crossed


@dataclass(frozen=True)
class KnownFeature:
    """A point or a convex arc that a line of sight can touch.

    At a point ``leave`` and ``back`` are the unit directions along the boundary from there, the blocked side
    being counterclockwise from leave to back; zero if nothing is known there. ``joined``: two pieces meet.
    """

    shape: Point | Arc
    leave: tuple[float, float] = (0.0, 0.0)
    back: tuple[float, float] = (0.0, 0.0)
    joined: bool = False
    pivot: bool = False
    """A line of sight can turn about it."""
    goal: bool = False
    """It belongs to the obstacle looked for."""
    stand: bool = False
    """It is a place of the walk."""
    on: tuple[int, ...] = ()
    """The pieces it lies on."""

    @property
    def place(self) -> Point:
        """The point that it is; an arc is none."""
        assert isinstance(self.shape, Point), "arcs are no places"
        return self.shape


def features_of(pieces: Pieces, goals: set[int]) -> list[KnownFeature]:
    """Corners, lone ends and convex arcs; *goals* are the pieces looked for."""
    found = []
    everything = np.arange(len(pieces.curves))
    first = pieces.tangents(everything, pieces.start).tolist()
    last = pieces.tangents(everything, pieces.end).tolist()
    for k, curve in enumerate(pieces.curves):
        i, j = int(pieces.before[k]), int(pieces.after[k])
        x, y = first[k]
        if i < 0:
            found.append(KnownFeature(curve.start, (x, y), (-x, -y), pivot=True, goal=k in goals, on=(k,)))
        else:
            u, v = last[i]
            pivot = x * -v + y * u > -margin(ANGLE)
            goal = k in goals or i in goals
            found.append(KnownFeature(curve.start, (x, y), (-u, -v), True, pivot, goal, on=(i, k)))
        if j < 0:
            u, v = last[k]
            found.append(KnownFeature(curve.end, (u, v), (-u, -v), pivot=True, goal=k in goals, on=(k,)))
        if isinstance(curve, Arc) and curve.ccw:
            found.append(KnownFeature(curve, pivot=True, goal=k in goals, on=(k,)))
    return found


def enters(leave: Floats, back: Floats, way: Floats, margin: Floats) -> Flags:
    """Whether directions certainly lead strictly into the blocked side at points."""
    one, two = cross(leave, way) > margin, cross(way, back) > margin
    reflex = cross(leave, back) < -margin
    return np.asarray(one & two | reflex & (one | two))


# -- lines -----------------------------------------------------------------------------------------


@dataclass
class Lines:
    """Lines of two touches, i and j by their numbers; j is -1 for the tangent of a ``piece`` at its point i.

    A touch is a point, or an arc on one of its two sides (see `Proposals`). The lines meet the walk at
    ordinate ``y``, up to ``error``; ``tilt`` bounds the error of their unit direction ``way``.
    """

    i: Ints
    j: Ints
    piece: Ints
    y: Floats
    error: Floats
    way: Floats
    tilt: Floats

    def __getitem__(self, part: Any) -> Lines:
        return Lines(*(getattr(self, name)[part] for name in self.__dataclass_fields__))


@dataclass(frozen=True)
class ProposedLine:
    """A line of sight along the line of i, j and piece (see `Lines`), which meets the walk at y.

    It ends on the piece ``target``, or, if that is -1, at the touch ``goal``.
    """

    i: int
    j: int
    piece: int
    goal: int
    target: int
    y: float


@dataclass(frozen=True)
class LineCell:
    """Lines of one touch, with ordinates from low to high, that meet one target.

    They meet a circle first in ``branch`` 0, then in branch 1.

    Marks stand for ordinates of other lines: a number of a line, or -1 - k for the k-th fixed ordinate. The
    cell lies between ``below`` and ``above``; if nothing is above, it is a run of cells between ordinates
    that floats cannot part. ``sample`` is an ordinate with a line that is within range as far as floats tell.
    """

    touch: int
    target: int
    branch: int
    low: float
    high: float
    below: tuple[int, ...]
    above: tuple[int, ...]
    sample: float | None = None


class Gaps:
    """Cells before targets are looked at, as arrays ``touch``, ``low``, ``high`` and ``tiny``.

    They lie between runs of ordinates that floats cannot part; these runs are the tiny ones. *ordinates* are
    touches with the ascending ordinates of their lines, the errors of these, and marks (see `LineCell`).
    """

    def __init__(self, ordinates: Iterable[tuple[int, Floats, Floats, Ints]]) -> None:
        touches, lows, highs = [np.empty(0, dtype=np.intp)], [np.empty(0)], [np.empty(0)]
        tiny, sizes = [np.empty(0, dtype=bool)], [0]
        self._marks: list[tuple[Ints, Ints, Ints]] = []
        for touch, y, error, marks in ordinates:
            parted = np.flatnonzero(y[1:] - error[1:] > np.maximum.accumulate(y + error)[:-1])
            first, last = np.concatenate(([0], parted + 1)), np.concatenate((parted, [len(y) - 1]))
            runs = last > first
            lows += [y[parted], y[first[runs]]]
            highs += [y[parted + 1], y[last[runs]]]
            tiny += [np.zeros(len(parted), dtype=bool), np.ones(int(runs.sum()), dtype=bool)]
            sizes.append(len(parted) + int(runs.sum()))
            touches.append(np.full(sizes[-1], touch))
            self._marks.append((marks, first, last))
        self.touch, self.tiny = np.concatenate(touches), np.concatenate(tiny)
        self.low, self.high = np.concatenate(lows), np.concatenate(highs)
        self._offsets = np.cumsum(sizes)

    def cell(self, k: int, target: int, branch: int) -> LineCell:
        """One of them, with a target."""
        group = int(np.searchsorted(self._offsets, k, side="right")) - 1
        marks, first, last = self._marks[group]
        n, at = len(first) - 1, int(k - self._offsets[group])
        if at < n:
            below = marks[first[at] : last[at] + 1]
            above = marks[first[at + 1] : last[at + 1] + 1]
        else:
            run = np.flatnonzero(last > first)[at - n]
            below, above = marks[first[run] : last[run] + 1], marks[:0]
        low, high = float(self.low[k]), float(self.high[k])
        return LineCell(
            int(self.touch[k]), target, branch, low, high, tuple(below.tolist()), tuple(above.tolist())
        )
