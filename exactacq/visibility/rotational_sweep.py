"""The rotational sweep: all tangent lines of one feature, divided where what they meet changes.

The tangent lines of a feature form a one-parameter family, its *pencil*. Each line meets a first edge
ahead of the contact and one behind it. These edges change only where the line passes a vertex or becomes
tangent to another convex arc: at an *event*. Between neighbouring events the pair of edges is constant,
so one rational line determines it: a `Cell`. The lines that bound a cell are limits of free lines, hence
free. A line that touches two further features may be free although no line next to it is: such a line is
*pinched*, and reported separately.

Floats propose the order of events and the first edges; where their proven margins overlap, the exact
values decide. Cost for n edges within reach: O(n log n) for the events, n times the number of cells
for the edges met, the latter in numpy.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cmp_to_key
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from flint import fmpq

from exactacq.geometry.coordinates import raw
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Point
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import CONVEX, STRAIGHT, EdgeTable, Floats, Ints
from exactacq.visibility.features import directions_at, enters
from exactacq.visibility.line_families import Sector, Spokes, Vector
from exactacq.visibility.line_hits import Crossings

CHUNK = 1 << 18
"""Entries of one array of the cell-by-edge tables: bounds the memory of a sweep."""


Passed: TypeAlias = "tuple[tuple[int, int, int], ...]"
"""The events at one line, each with number (a vertex, or an arc), side and sign: see `Sector.exact`."""


@dataclass(slots=True)
class Cell:
    """Lines from ``low`` to ``high`` of a sector that first meet edge ``behind`` and edge ``ahead``.

    The bounds say what the first and the last line pass.
    """

    low: Real
    high: Real
    behind: int | None
    ahead: int | None
    bounds: tuple[Passed, Passed] = ((), ())


@dataclass(slots=True)
class Pencil:
    """The cells of one sector, from low to high, and its pinched lines."""

    sector: Sector
    cells: tuple[Cell, ...]
    pinches: tuple[Real, ...]


@dataclass(slots=True)
class _Passage:
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
    edges = table.near(*_box(sector), reach)
    return _SectorSweep(table, sector, own, edges, breaks).run()


def _box(sector: Sector) -> tuple[tuple[float, float], tuple[float, float]]:
    (x, y), extent = sector.origin, sector.extent
    return (x - extent, y - extent), (x + extent, y + extent)


class _SectorSweep:
    def __init__(
        self, table: EdgeTable, sector: Sector, own: tuple[int, ...], edges: Ints, breaks: tuple[Vector, ...]
    ) -> None:
        self.table, self.sector, self.own, self.breaks = table, sector, own, breaks
        self.slack = 64 * (table.roundoff + 2.0**-50 * sector.extent)
        for e in own:
            if sector.round or table.kind[e] == STRAIGHT:
                edges = edges[edges != e]
        self.edges = edges
        # The edges through the centre of an arc whose normals go there: all of these pass that point.
        self.through: tuple[int, ...] = ()
        if isinstance(sector, Spokes) and not sector.outward:
            self.through = table.edges_at(Point(*sector.center))

    def run(self) -> Pencil:
        lines = self._events()
        middles = [rational_between(a, b) for (a, _), (b, _) in pairwise(lines)]
        cells: list[Cell] = []
        was_at_center = False
        for ((low, first), (high, last)), middle, (behind, ahead) in zip(
            pairwise(lines), middles, self._meets(middles), strict=True
        ):
            cell = Cell(low, high, behind, ahead, (first, last))
            at_center = self._is_at_center(middle, ahead)
            if (
                cells
                and (cells[-1].behind, cells[-1].ahead) == (behind, ahead)
                and at_center == was_at_center
            ):
                before = cells.pop()
                cell = Cell(before.low, high, behind, ahead, (before.bounds[0], last))
            cells.append(cell)
            was_at_center = at_center
        pinches = tuple(value for value, passed in lines if len(passed) > 1)
        return Pencil(self.sector, tuple(cells), pinches)

    # -- events --------------------------------------------------------------------------------

    def _events(self) -> list[tuple[Real, Passed]]:
        """Distinct event parameters from low to high, with what the lines pass there."""
        low, high = Real(self.sector.low), Real(self.sector.high)
        bounds = [_Passage(float(low), 1e-15, -1, 0, 0, low), _Passage(float(high), 1e-15, -1, 0, 0, high)]
        events = [*bounds, *self._break_events(), *self._vertex_events(), *self._arc_events()]
        lines = [line for cluster in _clusters(events) for line in self._resolve(cluster)]
        while lines[0][0].compare(low) < 0:
            del lines[0]
        while lines[-1][0].compare(high) > 0:
            del lines[-1]
        return lines

    def _resolve(self, cluster: list[_Passage]) -> Iterator[tuple[Real, Passed]]:
        """The distinct exact values of a cluster, ascending, with the true events at each."""
        if len(cluster) == 1:
            (event,) = cluster
            value = self._exact(event)
            if value is not None:
                yield value, ((event.edge, event.side, event.sign),) if event.edge >= 0 else ()
            return
        known = [(value, event) for event in cluster if (value := self._exact(event)) is not None]
        if len(known) > 1:
            known.sort(key=cmp_to_key(_by_value))
        current: Real | None = None
        passed: list[tuple[int, int, int]] = []
        for value, event in known:
            if current is not None and value.compare(current) != 0:
                yield current, tuple(passed)
                current, passed = None, []
            current = value if current is None else current
            if event.edge >= 0:
                passed.append((event.edge, event.side, event.sign))
        if current is not None:
            yield current, tuple(passed)

    def _break_events(self) -> Iterator[_Passage]:
        x, y = self.sector.center
        at_center = directions_at(self.table, Point(x, y), self.through)
        for dx, dy in (*self.breaks, *at_center):
            value = self.sector.exact((x + dx, y + dy), fmpq(0), 0, 0)
            if value is not None and self.sector.low <= value <= self.sector.high:
                yield _Passage(float(value), 1e-15, -1, 0, 0, value)

    def _vertex_events(self) -> Iterator[_Passage]:
        table, sector = self.table, self.sector
        edges = self.edges[~table.full[self.edges]]
        ids = np.unique(np.concatenate((edges, table.next[edges])))
        if len(self.own) == 2:
            ids = ids[ids != table.next[self.own[0]]]
        offsets = table.start[ids] - sector.origin
        for side, sign, guess, margin in sector.past_points(offsets, self.slack):
            yield from self._collect(ids, side, sign, guess, margin)

    def _arc_events(self) -> Iterator[_Passage]:
        table, sector = self.table, self.sector
        ids = self.edges[table.kind[self.edges] == CONVEX]
        for e in self.own:
            ids = ids[ids != e]
        if not len(ids):
            return
        offsets, radii = table.center[ids] - sector.origin, table.radius[ids]
        for side, sign, guess, margin in sector.past_circles(offsets, radii, self.slack):
            yield from self._collect(ids, side, sign, guess, margin)

    def _collect(self, ids: Ints, side: int, sign: int, guess: Floats, margin: Floats) -> Iterator[_Passage]:
        low, high = float(self.sector.low), float(self.sector.high)
        vague = margin > 0.05
        guess, margin = np.where(vague, 0.0, guess), np.where(vague, 3.0, margin)
        inside = (guess >= low - margin) & (guess <= high + margin)
        for k in np.flatnonzero(inside):
            yield _Passage(float(guess[k]), float(margin[k]), int(ids[k]), side, sign)

    def _exact(self, event: _Passage) -> Real | None:
        """The exact parameter, or None if the tangent that floats proposed does not exist."""
        if event.value is None:
            event.value = self.sector.exact(*self._target(event), event.side, event.sign)
        return event.value

    def _target(self, event: _Passage) -> tuple[Vector, fmpq]:
        if event.side == 0:
            return self.table.vertices[event.edge], fmpq(0)
        arc = self.table.curves[event.edge]
        return arc.center.rational, arc.radius_sq  # type: ignore[union-attr, return-value]

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
        contact, direction = self.sector.lines(t)
        origin = self.sector.origin
        found = Crossings(self.table, self.edges, self.own, origin, contact, direction, self.slack)
        for row, middle in enumerate(middles):
            met = found.nearest(row)
            yield self._exact_meet(middle, found.possible(row)) if met is None else met

    def _exact_meet(self, middle: fmpq, edges: Ints) -> tuple[int | None, int | None]:
        contact, direction = self.sector.touch(Real(middle))
        nearest: dict[int, tuple[Real, int]] = {}
        center = (Point(*self.sector.center) - contact).dot(direction) / direction.norm_sq()
        if self._is_blocked_at_center(direction):
            nearest[1] = (
                center,
                next(e for e in self.through[::-1] if self._enters(contact, direction, center, e, 1)),
            )
        for e in edges:
            for tau in line_contacts(contact, direction, self.table.curves[e]):
                if e in self.through and tau.compare(center) == 0:
                    continue
                side = tau.sign()
                if side == 0 and e not in self.own and isinstance(self.table.curves[e], Arc):
                    # A normal of a way where the way touches this arc.
                    side = 1 if self._enters(contact, direction, tau, e, 1) else -1
                if side and (side not in nearest or (tau - nearest[side][0]).sign() == -side):
                    nearest[side] = tau, int(e)
        proper = {s: e for s, (tau, e) in nearest.items() if self._enters(contact, direction, tau, e, s)}
        return proper.get(-1), proper.get(1)

    def _is_blocked_at_center(self, direction: Point) -> bool:
        """Whether a normal enters an obstacle in the centre of the arc, on a boundary that goes through it.

        Where that is a corner, no edge tells it alone, though one at least is entered if the obstacle is.
        """
        if not self.through:
            return False
        incoming, outgoing = self.table.curves[self.through[0]], self.table.curves[self.through[-1]]
        ways = list(directions_at(self.table, Point(*self.sector.center), self.through))
        return enters(incoming, outgoing, ways[0], ways[-1], raw(direction))

    def _is_at_center(self, middle: fmpq, ahead: int | None) -> bool:
        """Whether a normal meets the edge ahead in the centre of the arc.

        Then all normals of a family do; others, which meet the same arc elsewhere, are another family.
        """
        if ahead is None or ahead not in self.through:
            return False
        contact, direction = self.sector.touch(Real(middle))
        center = (Point(*self.sector.center) - contact).dot(direction) / direction.norm_sq()
        return isinstance(self.table.curves[ahead], Segment) or self._enters(
            contact, direction, center, ahead, 1
        )

    def _enters(self, contact: Point, direction: Point, tau: Real, e: int, side: int) -> bool:
        """Whether the line, followed ahead (side 1) or back (-1), passes from free to blocked at an edge."""
        edge = self.table.curves[e]
        if isinstance(edge, Segment):
            return edge.direction.cross(direction).sign() == side
        outward = (contact + direction * tau - edge.center).dot(direction).sign() * side
        return outward == (-1 if edge.ccw else 1)


def _clusters(events: list[_Passage]) -> Iterator[list[_Passage]]:
    """Runs of events whose order the float guesses leave open."""
    cluster: list[_Passage] = []
    reached = -np.inf
    for event in sorted(events, key=lambda e: e.guess - e.margin):
        if cluster and event.guess - event.margin > reached:
            yield cluster
            cluster = []
        reached = max(reached, event.guess + event.margin) if cluster else event.guess + event.margin
        cluster.append(event)
    if cluster:
        yield cluster


def _by_value(a: tuple[Real, _Passage], b: tuple[Real, _Passage]) -> int:
    return a[0].compare(b[0])
