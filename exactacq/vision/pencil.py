"""The rotational sweep: the tangent lines of one feature, cut where what they meet changes.

A line that turns about a feature meets, ahead and behind, a first edge each. These edges change only
where the line passes a vertex or becomes tangent to another convex arc: at an *event*. Between two
neighbouring events the pair is constant, so one rational line tells it: a `Cell`. The lines that bound
a cell (the sightlines of the feature) are limits of free lines, hence free. A line that grazes two
further features may be free although no neighbour is: it is reported as a *pinch*.

Floats propose the order of events and the first edges; where their proven margins overlap, the exact
values decide. Cost for n edges within reach: O(n log n) for the events, n times the number of cells
for the edges met, the latter in numpy.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cmp_to_key
from itertools import pairwise
from math import hypot

import numpy as np
from flint import fmpq, fmpz

from exactacq.contacts import line_contacts
from exactacq.curves import Segment
from exactacq.points import Point
from exactacq.reals import Real
from exactacq.vision.crossings import Crossings
from exactacq.vision.features import Sector, Vector, dot, left
from exactacq.vision.table import CONVEX, STRAIGHT, EdgeTable, Floats, Ints

CHUNK = 1 << 18
"""Entries of one array of the cell-by-edge tables: bounds the memory of a sweep."""


@dataclass(frozen=True, slots=True)
class Cell:
    """Lines from ``low`` to ``high`` of a sector that first meet edge ``behind`` and edge ``ahead``."""

    low: Real
    high: Real
    behind: int | None
    ahead: int | None


@dataclass(frozen=True, slots=True)
class Pencil:
    """The cells of one sector, from low to high, and its pinched lines."""

    sector: Sector
    cells: tuple[Cell, ...]
    pinches: tuple[Real, ...]


@dataclass(slots=True)
class _Event:
    """Line through a vertex, or tangent to a convex arc (``side`` +1: on the left, -1: on the right)."""

    guess: float
    margin: float
    edge: int
    side: int
    sign: int
    value: Real | None = None


def pencil(
    table: EdgeTable,
    sector: Sector,
    own: tuple[int, ...],
    reach: float,
    breaks: tuple[Vector, ...] = (),
) -> Pencil:
    """Sweep one sector; only edges within *reach* of the contact are considered.

    *own* are the edges through the contact, *breaks* further directions (at a corner) that end cells. What
    lies beyond *reach* may be reported wrongly or as None, so a chord is to be trusted only if both its
    halves are no longer than *reach*.
    """
    center = (float(sector.center[0]), float(sector.center[1]))
    size = hypot(float(sector.base[0]), float(sector.base[1])) * (1 + 1e-9) if sector.round else 0.0
    edges = table.near(center, center, reach + size)
    return _Sweep(table, sector, own, edges, breaks).run()


class _Sweep:
    def __init__(
        self, table: EdgeTable, sector: Sector, own: tuple[int, ...], edges: Ints, breaks: tuple[Vector, ...]
    ) -> None:
        self.table, self.sector, self.own, self.breaks = table, sector, own, breaks
        self.origin = np.array((float(sector.center[0]), float(sector.center[1])))
        base = np.array((float(sector.base[0]), float(sector.base[1])))
        self.base = base / np.hypot(*base)
        self.size = float(np.hypot(*base)) if sector.round else 0.0
        self.slack = 64 * (table.roundoff + 2.0**-50 * self.size)
        straight_own = [e for e in own if table.kind[e] == STRAIGHT]
        self.edges = edges[~np.isin(edges, list(own) if sector.round else straight_own)]

    def run(self) -> Pencil:
        values, pinches = self._events()
        middles = [rational_between(a, b) for a, b in pairwise(values)]
        cells: list[Cell] = []
        for (low, high), (behind, ahead) in zip(pairwise(values), self._meets(middles), strict=True):
            if cells and (cells[-1].behind, cells[-1].ahead) == (behind, ahead):
                cells[-1] = Cell(cells[-1].low, high, behind, ahead)
            else:
                cells.append(Cell(low, high, behind, ahead))
        return Pencil(self.sector, tuple(cells), tuple(pinches))

    # -- events --------------------------------------------------------------------------------

    def _events(self) -> tuple[list[Real], list[Real]]:
        """Distinct event parameters from low to high, and those that two or more events share."""
        low, high = Real(self.sector.low), Real(self.sector.high)
        bounds = [_Event(float(low), 1e-15, -1, 0, 0, low), _Event(float(high), 1e-15, -1, 0, 0, high)]
        events = [*bounds, *self._break_events(), *self._vertex_events(), *self._arc_events()]
        values: list[Real] = []
        pinches: list[Real] = []
        for cluster in _clusters(events):
            for value, sources in self._resolve(cluster):
                if value.compare(low) < 0 or value.compare(high) > 0:
                    continue
                values.append(value)
                if sources > 1:
                    pinches.append(value)
        return values, pinches

    def _resolve(self, cluster: list[_Event]) -> Iterator[tuple[Real, int]]:
        """The distinct exact values of a cluster, ascending, with the number of true events at each."""
        known = [(value, event) for event in cluster if (value := self._exact(event)) is not None]
        if len(known) > 1:
            known.sort(key=cmp_to_key(_by_value))
        current: Real | None = None
        sources = 0
        for value, event in known:
            if current is not None and value.compare(current) != 0:
                yield current, sources
                current, sources = None, 0
            current = value if current is None else current
            sources += event.edge >= 0
        if current is not None:
            yield current, sources

    def _break_events(self) -> Iterator[_Event]:
        for direction in self.breaks:
            along = dot(self.sector.base, direction)
            if along != 0:
                value = dot(left(self.sector.base), direction) / along
                if self.sector.low <= value <= self.sector.high:
                    yield _Event(float(value), 1e-15, -1, 0, 0, Real(value))

    def _vertex_events(self) -> Iterator[_Event]:
        table = self.table
        edges = self.edges[~table.full[self.edges]]
        ids = np.unique(np.concatenate((edges, table.next[edges])))
        offsets = table.start[ids] - self.origin
        if not self.sector.round:
            own = [int(table.next[self.own[0]])] if len(self.own) == 2 else []
            keep = ~np.isin(ids, own)
            ids, offsets = ids[keep], offsets[keep]
            yield from self._collect(ids, 0, 0, *self._line_through(offsets))
            return
        for sign in (1, -1):
            yield from self._collect(ids, 0, sign, *self._tangent_through(offsets, 0.0, sign))

    def _arc_events(self) -> Iterator[_Event]:
        table = self.table
        ids = self.edges[table.kind[self.edges] == CONVEX]
        if not self.sector.round:
            ids = ids[~np.isin(ids, list(self.own))]
        offsets, radii = table.center[ids] - self.origin, table.radius[ids]
        for sign in (1, -1):
            if self.sector.round:
                for side in (1, -1):
                    guess = self._tangent_through(offsets, side * radii, sign)
                    yield from self._collect(ids, side, sign, *guess)
            else:
                yield from self._collect(ids, 1, sign, *self._tangent_from(offsets, radii, sign))

    def _collect(self, ids: Ints, side: int, sign: int, guess: Floats, margin: Floats) -> Iterator[_Event]:
        low, high = float(self.sector.low), float(self.sector.high)
        vague = margin > 0.05
        guess, margin = np.where(vague, 0.0, guess), np.where(vague, 3.0, margin)
        inside = (guess >= low - margin) & (guess <= high + margin)
        for k in np.flatnonzero(inside):
            yield _Event(float(guess[k]), float(margin[k]), int(ids[k]), side, sign)

    def _polar(self, offsets: Floats) -> tuple[Floats, Floats, Floats]:
        """Distance, angle from the base vector, and error of the angle."""
        x = offsets @ self.base
        y = offsets @ np.array((-self.base[1], self.base[0]))
        size = np.hypot(x, y)
        error = np.minimum(self.slack / np.maximum(size, 1e-300), 1.0) + 1e-14
        return size, np.arctan2(y, x), error

    def _line_through(self, offsets: Floats) -> tuple[Floats, Floats]:
        """Parameter at a corner of the line through a point, on either side."""
        _, angle, error = self._polar(offsets)
        return _slope(angle), 4 * error

    def _tangent_from(self, offsets: Floats, radii: Floats, sign: int) -> tuple[Floats, Floats]:
        """Parameter at a corner of the line tangent to a circle."""
        size, angle, error = self._polar(offsets)
        ratio = radii / np.maximum(size, 1e-300)
        wing = np.arcsin(np.clip(ratio, -1.0, 1.0))
        guess, margin = _slope(angle + sign * wing), 4 * (error + _arc_error(ratio, error))
        return np.where(ratio > 1 + error, np.nan, guess), margin

    def _tangent_through(self, offsets: Floats, radii: Floats | float, sign: int) -> tuple[Floats, Floats]:
        """Parameter at a circle of the line tangent to another one (radius 0: through a point)."""
        size, angle, error = self._polar(offsets)
        ratio = (self.size + radii) / np.maximum(size, 1e-300)
        wing = np.arccos(np.clip(ratio, -1.0, 1.0))
        turned = np.remainder(angle + sign * wing + np.pi, 2 * np.pi) - np.pi
        guess, margin = np.tan(turned / 2), 4 * (error + _arc_error(ratio, error))
        return np.where(np.abs(ratio) > 1 + error, np.nan, guess), margin

    def _exact(self, event: _Event) -> Real | None:
        """The exact parameter, or None if the tangent that floats proposed does not exist."""
        if event.value is None:
            target, radius_sq = self._target(event)
            offset = (target[0] - self.sector.center[0], target[1] - self.sector.center[1])
            along, across = dot(self.sector.base, offset), dot(left(self.sector.base), offset)
            if self.sector.round:
                event.value = self._exact_round(event, offset, along, across, radius_sq)
            elif event.side == 0:
                event.value = None if along == 0 else Real(across / along)
            else:
                event.value = _exact_corner(event.sign, offset, along, across, radius_sq)
        return event.value

    def _target(self, event: _Event) -> tuple[Vector, fmpq]:
        if event.side == 0:
            return self.table.vertices[event.edge], fmpq(0)
        arc = self.table.curves[event.edge]
        return arc.center.rational, arc.radius_sq  # type: ignore[union-attr, return-value]

    def _exact_round(
        self, event: _Event, offset: Vector, along: fmpq, across: fmpq, radius_sq: fmpq
    ) -> Real | None:
        """Root of (k + q) t^2 - 2 p t + (k - q) = 0, k = rho (rho +- r): see `features` for t."""
        rho_sq = dot(self.sector.base, self.sector.base)
        k = Real(rho_sq) + event.side * Real(rho_sq * radius_sq).sqrt()
        square = Real(rho_sq * dot(offset, offset)) - k * k
        if square.sign() < 0:
            return None
        root = square.sqrt() * event.sign
        below = k + along
        if below.sign() == 0:
            # One root is at infinity: half a turn from the base, in no sector.
            return (k - along) / (across - root) if (across - root).sign() else None
        value: Real = (across + root) / below
        return value

    # -- edges met -----------------------------------------------------------------------------

    def _meets(self, middles: list[fmpq]) -> Iterator[tuple[int | None, int | None]]:
        """First edge behind and ahead at each of the rational parameters."""
        if not len(self.edges):
            yield from ((None, None) for _ in middles)
            return
        step = max(1, CHUNK // len(self.edges))
        for k in range(0, len(middles), step):
            yield from self._meet_chunk(middles[k : k + step])

    def _meet_chunk(self, middles: list[fmpq]) -> Iterator[tuple[int | None, int | None]]:
        t = np.array([float(m) for m in middles])
        if self.sector.round:
            angle = 2 * np.arctan(t)
            spoke = _rotated(self.base, angle)
            contact, direction = spoke * self.size, np.stack((-spoke[:, 1], spoke[:, 0]), axis=1)
        else:
            direction = _rotated(self.base, np.arctan(t))
            contact = np.zeros_like(direction)
        found = Crossings(self.table, self.edges, self.own, self.origin, contact, direction, self.slack)
        for row, middle in enumerate(middles):
            met = found.nearest(row)
            yield self._exact_meet(middle, found.possible(row)) if met is None else met

    def _exact_meet(self, middle: fmpq, edges: Ints) -> tuple[int | None, int | None]:
        contact, direction = self.sector.touch(Real(middle))
        nearest: dict[int, tuple[Real, int]] = {}
        for e in edges:
            for tau in line_contacts(contact, direction, self.table.curves[e]):
                side = tau.sign()
                if side and (side not in nearest or (tau - nearest[side][0]).sign() == -side):
                    nearest[side] = tau, int(e)
        proper = {s: e for s, (tau, e) in nearest.items() if self._enters(contact, direction, tau, e, s)}
        return proper.get(-1), proper.get(1)

    def _enters(self, contact: Point, direction: Point, tau: Real, e: int, side: int) -> bool:
        """Whether the line, followed ahead (side 1) or back (-1), passes from free to blocked at an edge."""
        edge = self.table.curves[e]
        if isinstance(edge, Segment):
            return edge.direction.cross(direction).sign() == side
        outward = (contact + direction * tau - edge.center).dot(direction).sign() * side
        return outward == (-1 if edge.ccw else 1)


def _exact_corner(sign: int, offset: Vector, along: fmpq, across: fmpq, radius_sq: fmpq) -> Real | None:
    """tan(angle of the centre +- asin(r / distance)), from the addition theorem."""
    square = dot(offset, offset) - radius_sq
    if square < 0:
        return None
    reach, radius = Real(square).sqrt(), Real(radius_sq).sqrt() * sign
    below = reach * along - radius * across
    return (reach * across + radius * along) / below if below.sign() else None


def _clusters(events: list[_Event]) -> Iterator[list[_Event]]:
    """Runs of events whose order the float guesses leave open."""
    cluster: list[_Event] = []
    reached = -np.inf
    for event in sorted(events, key=lambda e: e.guess - e.margin):
        if cluster and event.guess - event.margin > reached:
            yield cluster
            cluster = []
        reached = max(reached, event.guess + event.margin) if cluster else event.guess + event.margin
        cluster.append(event)
    if cluster:
        yield cluster


def rational_between(low: Real, high: Real) -> fmpq:
    """A short rational strictly between two reals, near their middle."""
    bits = 64
    while True:
        (_, left_end), (right_end, _) = low.enclosure(bits), high.enclosure(bits)
        gap = right_end - left_end
        if gap > 0:
            scale = fmpz(2) ** (int((1 / gap).ceil().bit_length()) + 3)
            return fmpq(((left_end + right_end) / 2 * scale).floor(), scale)
        bits *= 2


def _by_value(a: tuple[Real, _Event], b: tuple[Real, _Event]) -> int:
    return a[0].compare(b[0])


def _slope(angle: Floats) -> Floats:
    """Parameter at a corner for a direction, taken modulo a half turn; NaN far from the base."""
    folded = np.remainder(angle + np.pi / 2, np.pi) - np.pi / 2
    return np.where(np.abs(folded) > 1.0, np.nan, np.tan(folded))


def _arc_error(ratio: Floats, error: Floats) -> Floats:
    """Error of asin or acos of a ratio that is off by about *error*."""
    capped = np.minimum(np.abs(ratio), 1.0)
    flat = np.sqrt(np.maximum(1 - capped * capped, 1e-30))
    bound: Floats = np.minimum(4 * error / flat, 4 * np.sqrt(error))
    return bound


def _rotated(vector: Floats, angle: Floats) -> Floats:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.stack((cosine * vector[0] - sine * vector[1], cosine * vector[1] + sine * vector[0]), axis=1)
