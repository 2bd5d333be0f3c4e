"""Smooth curves become chains of circular arcs and segments, proven to lie within a tolerance.

Floats propose, as far along the curve as they find one that fits: where to part it, and a biarc between two
of its points. `exactacq.files.repairs.biarcs` then proves in rationals that curve and biarc are within the
tolerance of each other; if it cannot, a shorter part is tried. Where no biarc fits (at a cusp, along a
straight part, or where parts are short beside the tolerance) there is a segment. So the bound always holds,
for the distance is that of Hausdorff: from each point of the curve to the chain, and from the chain to the
curve. The ends of the curve stay exactly where they were, all arcs have rational bulges, and neighbouring
biarcs have one tangent, within the tolerance over the curve's size of the curve's own.

The number of arcs grows like tol^(-1/3), that of chords would like tol^(-1/2).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import atan2, comb, cos, pi, sin, tan

import numpy as np
from flint import fmpq
from numpy.typing import NDArray

from exactacq.errors import FormatError, shown
from exactacq.files.loops.rational_arcs import simplest_between
from exactacq.files.repairs.bezier import BezierPiece, Pair
from exactacq.files.repairs.biarcs import Biarc, biarc, fits_biarc, fits_segment
from exactacq.numbers.rationals import rational

MAX_PIECES = 2_000
"""Most arcs and segments of one curve: a tolerance that needs more is a mistake."""
MAX_RATIO = 10**11
"""Largest size of a curve over the tolerance: floats, which propose, have digits for no more."""
SAMPLES = 33
"""Points at which floats compare curve and biarc."""
JOINTS = (0.3, 0.4, 0.5, 0.6, 0.7)
"""Fractions of a part at which the curve's tangent is tried for that of the joint."""
MARGIN = 0.92
"""How much of the tolerance floats may use: the exact proof needs the rest."""
MAX_TURN = 2.4
"""Largest turn of a part, in radians: two arcs of at most a quarter."""
GRID = 8
"""A part is at least this many steps wide of the grid that its end is rounded to: so numbers stay short."""
REFINEMENTS = 4
"""Halvings of the interval between a width that fits and one that does not."""
SHORTER = fmpq(7, 8)
"""By how much a part is shortened when the proof fails."""
SAME_ANGLE = 1e-9
"""Tangents of neighbouring pieces that differ by less, in radians, are one: 2^-53 times some rounding."""
Floats = NDArray[np.float64]
Edge = tuple[fmpq, fmpq, fmpq]
"""x and y of the start of an edge, and its bulge."""


@dataclass(slots=True)
class FlatChain:
    """The edges of a chain by their starts and bulges, its end, and how many are arcs of biarcs."""

    edges: list[Edge] = field(default_factory=list)
    end: Pair | None = None
    arcs: int = 0

    def add(self, start: Pair, bulge: fmpq, end: Pair) -> None:
        """Append an edge, which begins where the last one ended; one without length is left out."""
        if start != end:
            self.edges.append((*start, bulge))
            self.arcs += bulge != 0
        self.end = end


def flatten(pieces: Sequence[BezierPiece], tolerance: fmpq) -> FlatChain:
    """A chain of arcs and segments within *tolerance* > 0 of a curve, which is given as joined pieces.

    The bound holds for each piece and its part of the chain, see above. Raises `FormatError` for a tolerance
    that is not positive, or less than the size over `MAX_RATIO`, and if `MAX_PIECES` do not suffice. A piece
    that is a point adds nothing. Time grows with the number of arcs: some milliseconds for each.

    >>> from exactacq.files.repairs.bezier import polynomial
    >>> points = [(fmpq(x), fmpq(y)) for x, y in ((0, 0), (0, 2), (2, 2), (2, 0))]
    >>> chain = flatten([polynomial(points)], fmpq(1, 100))
    >>> len(chain.edges), chain.arcs, chain.edges[0][:2], chain.end
    (6, 6, (0, 0), (2, 0))
    """
    if tolerance <= 0:
        raise FormatError(f"flatten: a length above 0 is needed, not {shown(tolerance)}")
    chain = FlatChain()
    sizes = [_size(piece) for piece in pieces]
    if max(sizes, default=fmpq(0)) > tolerance * MAX_RATIO:
        raise FormatError(
            f"flatten: {shown(tolerance)} is too short for so large a curve; give a larger length"
        )
    bits = 6
    while tolerance * 2**bits < 8 * max(sizes, default=fmpq(0)):
        bits += 1
    last = None
    for piece, size in zip(pieces, sizes, strict=True):
        if size:
            last = _Fit(piece, size, tolerance, fmpq(1, 1 << bits), chain).run(last)
    return chain


def _size(piece: BezierPiece) -> fmpq:
    """The larger side of the box of the control points."""
    (x0, y0), (x1, y1) = piece.reach()
    return max(x1 - x0, y1 - y0)


Direction = tuple[float, Pair]
"""The angle of a tangent, and a rational unit vector whose square is near it."""


class _Fit:
    """One piece, approximated from its start to its end."""

    def __init__(
        self, piece: BezierPiece, size: fmpq, tolerance: fmpq, slack: fmpq, chain: FlatChain
    ) -> None:
        self.piece, self.size, self.tolerance, self.slack, self.chain = piece, size, tolerance, slack, chain
        self.image = _Image(piece, size)
        self.limit = float(min(tolerance / size, fmpq(4)))
        self.known: dict[fmpq, Direction] = {}

    def run(self, last: Direction | None) -> Direction:
        """Append the piece to the chain; *last* is the direction in which the piece before ended."""
        if last is not None:
            apart = abs(self.image.angle(0.0) - last[0])
            if min(apart, 2 * pi - apart) < SAME_ANGLE:
                self.known[fmpq(0)] = last
        low, width = fmpq(0), fmpq(1)
        while low < 1:
            width, found = self._farthest(low, min(2 * width, 1 - low))
            start, end = self.piece.point(low), self.piece.point(low + width)
            if found is None:
                self.chain.add(start, fmpq(0), end)
            else:
                for arc in (found.first, found.second):
                    self.chain.add(arc.start, arc.bulge, arc.end)
            if len(self.chain.edges) > MAX_PIECES:
                raise FormatError(
                    f"flatten: {shown(self.tolerance)} needs too many arcs; give a larger length"
                )
            low += width
        return self._direction(fmpq(1))

    def _farthest(self, low: fmpq, width: fmpq) -> tuple[fmpq, Biarc | None]:
        """How far one biarc reaches from a parameter, or a segment if that is as far, tried from a width."""
        grow = True
        while True:
            if self._bends(low, low + width):
                width = self._longest(low, width, self._bends) if grow else width
                if not self._is_straight(low, low + width):
                    found = self._biarc(low, low + width)
                    if found is not None:
                        return width, found
                    grow, width = False, _on_grid(low, width * SHORTER)
                    continue
            if self._is_straight(low, low + width):
                return self._longest(low, width, self._is_straight), None
            width = _on_grid(low, width / 2)

    def _longest(self, low: fmpq, width: fmpq, fits: Callable[[fmpq, fmpq], object]) -> fmpq:
        """A width that fits and can hardly be enlarged, from one that fits."""
        too_wide = None
        while too_wide is None and low + width < 1:
            wider = min(2 * width, 1 - low)
            if fits(low, low + wider):
                width = wider
            else:
                too_wide = wider
        for _ in range(REFINEMENTS if too_wide is not None else 0):
            middle = _on_grid(low, (width + too_wide) / 2)
            if fits(low, low + middle):
                width = middle
            else:
                too_wide = middle
        return width

    def _bends(self, low: fmpq, high: fmpq) -> bool:
        """Whether floats find a biarc that fits."""
        return self.image.joint(float(low), float(high), self.limit * MARGIN) is not None

    def _is_straight(self, low: fmpq, high: fmpq) -> bool:
        """Whether the segment between two points of the piece is proven to fit."""
        return self.image.chord_fits(float(low), float(high), self.limit) and fits_segment(
            self.piece.part(low, high), self.tolerance
        )

    def _biarc(self, low: fmpq, high: fmpq) -> Biarc | None:
        """A biarc that is proven to fit, or None."""
        angle = self.image.joint(float(low), float(high), self.limit * MARGIN)
        if angle is None:
            return None
        turns = self._direction(low)[1], _half_turn(angle, self.slack), self._direction(high)[1]
        found = biarc(self.piece.point(low), self.piece.point(high), turns)
        if found is None:
            return None
        joint = self.image.local(found.first.end)
        parting = self.image.parting(float(low), float(high), joint, found.tangent)
        step = self.slack / 64
        part = min(max((rational(parting) / step).floor() * step, step), 1 - step)
        fits = fits_biarc(self.piece.part(low, high), found, part, self.tolerance)
        return found if fits else None

    def _direction(self, t: fmpq) -> Direction:
        if t not in self.known:
            angle = self.image.angle(float(t))
            self.known[t] = angle, _half_turn(angle, self.slack)
        return self.known[t]


def _on_grid(low: fmpq, width: fmpq) -> fmpq:
    """A width, at most that one, that ends on a grid of powers of 2; unchanged if it ends at 1."""
    if low + width == 1:
        return width
    step = fmpq(1)
    while step * GRID > width:
        step /= 2
    return ((low + width) / step).floor() * step - low


def _half_turn(angle: float, slack: fmpq) -> Pair:
    """A rational unit vector near half an angle in [-pi, pi], by the simplest tangent of a quarter of it."""
    tangent = rational(tan(angle / 4))
    size = abs(tangent)
    simple = simplest_between(max(size - slack, fmpq(0)), size + slack)
    tangent = simple if tangent >= 0 else -simple
    square = tangent * tangent
    return (1 - square) / (1 + square), 2 * tangent / (1 + square)


class _Image:
    """A piece in floats, moved to the origin and scaled to size 1: what proposes."""

    def __init__(self, piece: BezierPiece, size: fmpq) -> None:
        self.origin, self.size = piece.point(fmpq(0)), size
        degree = len(piece.rows) - 1
        most = max(w for _, _, w in piece.rows)
        rows = [(*self.local((x / w, y / w)), float(w / most)) for x, y, w in piece.rows]
        weights = np.array([w for _, _, w in rows])
        self.rows = np.array([(x, y, 1.0) for x, y, _ in rows]) * weights[:, None]
        self.powers = np.arange(degree + 1)
        self.binomials = np.array([comb(degree, i) for i in range(degree + 1)], dtype=float)
        self.lower = np.array([comb(degree - 1, i) for i in range(degree)], dtype=float)
        self.slopes = degree * np.diff(self.rows, axis=0)

    def local(self, point: Pair) -> tuple[float, float]:
        """A point of the drawing in the image's coordinates."""
        return tuple(float((c - o) / self.size) for c, o in zip(point, self.origin, strict=True))  # type: ignore[return-value]

    def points(self, t: Floats) -> Floats:
        """The points at parameters, as rows."""
        mixed = self._mix(t, self.binomials) @ self.rows
        found: Floats = mixed[:, :2] / mixed[:, 2:]
        return found

    def _mix(self, t: Floats, binomials: Floats) -> Floats:
        powers = self.powers[: len(binomials)]
        return binomials * t[:, None] ** powers * (1 - t[:, None]) ** powers[::-1]

    def directions(self, t: Floats) -> Floats:
        """The tangents' angles at parameters; where the curve stands still, that of a short chord."""
        mixed, slope = self._mix(t, self.binomials) @ self.rows, self._mix(t, self.lower) @ self.slopes
        vectors = slope[:, :2] * mixed[:, 2:] - mixed[:, :2] * slope[:, 2:]
        still = np.hypot(*vectors.T) < 1e-7 * mixed[:, 2] ** 2
        if still.any():
            here = t[still]
            vectors[still] = self.points(np.minimum(here + 1e-4, 1.0)) - self.points(
                np.maximum(here - 1e-4, 0.0)
            )
        found: Floats = np.arctan2(vectors[:, 1], vectors[:, 0])
        return found

    def angle(self, t: float) -> float:
        """The tangent's angle at a parameter."""
        return float(self.directions(np.array([t]))[0])

    def joint(self, low: float, high: float, limit: float) -> float | None:
        """The tangent's angle at the joint of the best biarc for a part, if that is within the limit."""
        t = low + (high - low) * np.linspace(0.0, 1.0, SAMPLES)
        points, angles = self.points(t), np.unwrap(self.directions(t))
        if np.ptp(angles) > MAX_TURN:
            return None
        first, last = float(angles[0]), float(angles[-1])
        middles = [float(angles[round(f * (SAMPLES - 1))]) for f in JOINTS]
        best = min((_deviation(points, first, m, last), m) for m in [(first + last) / 2, *middles])
        return atan2(sin(best[1]), cos(best[1])) if best[0] <= limit else None

    def chord_fits(self, low: float, high: float, limit: float) -> bool:
        """Whether a part is nearly as close to its chord as the limit, to floats."""
        points = self.points(low + (high - low) * np.linspace(0.0, 1.0, SAMPLES))
        along = points[-1] - points[0]
        square = float(along @ along)
        fractions = np.clip((points - points[0]) @ along / square, 0.0, 1.0) if square else np.zeros(SAMPLES)
        apart = points - points[0] - fractions[:, None] * along
        return float(np.hypot(*apart.T).max()) <= limit * (1 + 1e-6) + 1e-14

    def parting(self, low: float, high: float, joint: tuple[float, float], tangent: Pair) -> float:
        """The fraction of a part at which it passes the line through the joint across the tangent."""
        across = np.array([float(tangent[0]), float(tangent[1])])
        before, after = 0.0, 1.0
        while after - before > 1e-15:
            cuts = np.linspace(before, after, SAMPLES)
            sides = (self.points(low + (high - low) * cuts) - np.array(joint)) @ across
            k = int(np.argmax(sides > 0)) if (sides > 0).any() else SAMPLES - 1
            before, after = float(cuts[max(k - 1, 0)]), float(cuts[max(k, 1)])
        return (before + after) / 2


def _deviation(points: Floats, first: float, middle: float, last: float) -> float:
    """How far points are from the biarc with such tangents' angles, at most; infinite if there is none."""
    along = np.array([cos((first + middle) / 2), sin((first + middle) / 2)])
    across = np.array([cos((middle + last) / 2), sin((middle + last) / 2)])
    gap, both = points[-1] - points[0], along[0] * across[1] - along[1] * across[0]
    if abs(both) < 1e-9:
        return float("inf")
    a = (gap[0] * across[1] - gap[1] * across[0]) / both
    b = (along[0] * gap[1] - along[1] * gap[0]) / both
    turns = middle - first, last - middle
    if min(a, b) <= 0 or not all(1e-6 < abs(turn) < pi / 2 for turn in turns):
        return float("inf")
    joint = points[0] + a * along
    ahead = (points - joint) @ np.array([cos(middle), sin(middle)]) > 0
    apart = [
        np.abs(np.hypot(*(points - start - radius * np.array([-sin(angle), cos(angle)])).T) - abs(radius))
        for start, angle, radius in (
            (points[0], first, a / (2 * sin(turns[0] / 2))),
            (joint, middle, b / (2 * sin(turns[1] / 2))),
        )
    ]
    return float(np.where(ahead, apart[1], apart[0]).max())
