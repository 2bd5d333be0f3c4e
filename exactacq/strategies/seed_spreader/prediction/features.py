"""What lines of sight can touch, and the lines and families of lines that a prediction examines.

See `exactacq.strategies.seed_spreader.prediction.decide`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.strategies.seed_spreader.prediction.pieces import ANGLE, Flags, Floats, Ints, Pieces, cross


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
            pivot = x * -v + y * u > -ANGLE
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
    """Lines through two features, numbers i and j of the list of touches; j is -1 for the tangent, at a point
    i, of a ``piece``. They meet the walk at ``y``, with that error; ``bend`` is the error
    of the unit direction ``way``."""

    i: Ints
    j: Ints
    piece: Ints
    y: Floats
    error: Floats
    way: Floats
    bend: Floats

    def __getitem__(self, part: Any) -> Lines:
        return Lines(*(getattr(self, name)[part] for name in self.__dataclass_fields__))


@dataclass(frozen=True)
class ProposedLine:
    """A proposed line of sight: along a line to a target, or to a feature (target -1), or of any line."""

    i: int
    j: int
    piece: int
    goal: int
    target: int
    y: float


@dataclass(frozen=True)
class LineCell:
    """Lines that touch one feature, with ordinates from low to high, and meet one target in one branch.

    Marks stand for ordinates of other lines: a number of a line, or -1 - k for the k-th fixed ordinate. The
    cell lies between ``below`` and ``above``; if nothing is above, it is a run of cells between ordinates
    that floats cannot part. ``sample`` is an ordinate with a line certainly within range, ``tight`` tells
    where the range is not decided.
    """

    touch: int
    target: int
    branch: int
    low: float
    high: float
    below: tuple[int, ...]
    above: tuple[int, ...]
    sample: float | None = None
    tight: tuple[tuple[float, float], ...] = ()


class Gaps:
    """Cells by feature, before targets are looked at: between runs of ordinates that floats cannot part, and
    these runs."""

    def __init__(self) -> None:
        self._touch: list[Ints] = []
        self._low: list[Floats] = []
        self._high: list[Floats] = []
        self._tiny: list[Flags] = []
        self._marks: list[tuple[Ints, Ints, Ints]] = []

    def add(self, touch: int, y: Floats, error: Floats, marks: Ints) -> None:
        """The cells of one feature from the ascending ordinates of its lines."""
        parted = np.flatnonzero(y[1:] - error[1:] > np.maximum.accumulate(y + error)[:-1])
        first, last = np.concatenate(([0], parted + 1)), np.concatenate((parted, [len(y) - 1]))
        runs = last > first
        self._low += [y[parted], y[first[runs]]]
        self._high += [y[parted + 1], y[last[runs]]]
        self._tiny += [np.zeros(len(parted), dtype=bool), np.ones(int(runs.sum()), dtype=bool)]
        self._touch.append(np.full(len(parted) + int(runs.sum()), touch))
        self._marks.append((marks, first, last))

    def closed(self) -> Gaps:
        """The collected cells as arrays ``touch``, ``low``, ``high``, ``tiny``; call it once, at the end."""
        self.touch = np.concatenate([np.empty(0, dtype=np.intp), *self._touch])
        self.low, self.high = (
            np.concatenate([np.empty(0), *self._low]),
            np.concatenate([np.empty(0), *self._high]),
        )
        self.tiny = np.concatenate([np.empty(0, dtype=bool), *self._tiny])
        self._offsets = np.concatenate(([0], np.cumsum([len(t) for t in self._touch]))).astype(np.intp)
        return self

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
