"""The rotational sweep: all tangent lines of one feature, divided where what they meet changes.

The tangent lines of a feature form a one-parameter family, its *pencil*. Each line meets a first edge
ahead of the contact and one behind it. These edges change only where the line passes a vertex or becomes
tangent to another convex arc: at an *event*. Between neighbouring events the pair of edges is constant,
so one rational line determines it: a `Cell`. The lines that bound a cell are limits of free lines, hence
free. A line that touches two further features may be free although no line next to it is: such a line is
*pinched*, and reported separately.

Float intervals give the order of events and the first edges (`exactacq.kernel`); where they overlap, exact
values decide. An event that overlaps no other is never made exact here: it is a late number. Cost for n edges
within reach: O(n log n) for the events; near n for the edges met, as only those with an event are looked at
again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cmp_to_key, partial
from itertools import pairwise
from math import inf
from operator import attrgetter
from typing import TypeAlias

from flint import arb, fmpq

from exactacq.geometry.coordinates import raw
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Point
from exactacq.kernel.bounded import UNIT
from exactacq.kernel.first_edges import DOUBT, first_edges
from exactacq.kernel.line_events import line_events
from exactacq.kernel.surroundings import Surroundings
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import STRAIGHT, EdgeTable
from exactacq.visibility.features import directions_at, enters
from exactacq.visibility.line_families import Sector, Spokes, Vector, held

Passed: TypeAlias = "tuple[tuple[int, int, int], ...]"
"""The events at one line, each with number (a vertex, or an arc), side and sign: see `Sector.exact`."""


@dataclass(slots=True)
class Cell:
    """Lines from ``low`` to ``high`` of a sector that first meet edge ``behind`` and edge ``ahead``.

    The bounds say what the first and the last line pass. Neighbouring cells share a bound as one object.
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
    pinches: tuple[tuple[Real, Passed], ...]


@dataclass(slots=True, eq=False)
class _EventLine:
    """A line of the family, its parameter between ``low`` and ``high``, and what it passes.

    Before those that are equal are brought together, *passed* has at most one event.
    """

    low: float
    high: float
    passed: Passed
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
    edges = table.near(*_box(sector), reach).tolist()
    return _SectorSweep(table, sector, own, edges, breaks).run()


def _box(sector: Sector) -> tuple[tuple[float, float], tuple[float, float]]:
    (x, y), extent = sector.origin, sector.extent
    return (x - extent, y - extent), (x + extent, y + extent)


class _SectorSweep:
    def __init__(
        self,
        table: EdgeTable,
        sector: Sector,
        own: tuple[int, ...],
        edges: list[int],
        breaks: tuple[Vector, ...],
    ) -> None:
        self.table, self.sector, self.own, self.breaks = table, sector, own, breaks
        images = table.images
        left_out = [e for e in own if sector.round or images.kind[e] == STRAIGHT]
        self.edges = [e for e in edges if e not in left_out] if left_out else edges
        self.around = Surroundings(images, sector.frame(), self.edges, list(own))
        # The edges through the centre of an arc whose normals go there: all of these pass that point.
        self.through: tuple[int, ...] = ()
        if isinstance(sector, Spokes) and not sector.outward:
            self.through = table.edges_at(Point(*sector.center))

    def run(self) -> Pencil:
        lines = self._lines()
        middles = [self._middle(a, b) for a, b in pairwise(lines)]
        cells: list[tuple[_EventLine, _EventLine, int | None, int | None]] = []
        was_at_center = False
        for (first, last), (middle, _), (behind, ahead) in zip(
            pairwise(lines), middles, self._meets(lines, middles), strict=True
        ):
            at_center = self._is_at_center(middle, ahead)
            if cells and cells[-1][2:] == (behind, ahead) and at_center == was_at_center:
                cells[-1] = (cells[-1][0], last, behind, ahead)
            else:
                cells.append((first, last, behind, ahead))
            was_at_center = at_center
        return Pencil(
            self.sector,
            tuple(
                Cell(self._value(first), self._value(last), behind, ahead, (first.passed, last.passed))
                for first, last, behind, ahead in cells
            ),
            tuple((self._value(line), line.passed) for line in lines if len(line.passed) > 1),
        )

    # -- events --------------------------------------------------------------------------------

    def _lines(self) -> list[_EventLine]:
        """The distinct lines at which there are events, from low to high."""
        low, high = _known(Real(self.sector.low)), _known(Real(self.sector.high))
        events = [low, high, *self._break_events(), *self._edge_events(low.low, high.high)]
        events.sort(key=attrgetter("low"))
        lines: list[_EventLine] = []
        started = False
        for cluster in _clusters(events):
            has_low, has_high = low in cluster, high in cluster
            started = started or has_low
            if started:
                if len(cluster) == 1:
                    lines += cluster
                else:
                    lines += self._resolved(cluster, low if has_low else None, high if has_high else None)
            if has_high:
                break
        return lines

    def _resolved(
        self, cluster: list[_EventLine], low: _EventLine | None, high: _EventLine | None
    ) -> Iterator[_EventLine]:
        """The distinct lines of a cluster, from the low bound on or up to the high one, in exact order."""
        values = [(self._value(event), event) for event in cluster]
        values.sort(key=cmp_to_key(_by_value))
        current: Real | None = None
        passed: Passed = ()
        for value, event in values:
            if low is not None and value.compare(low.value) < 0:
                continue
            if high is not None and value.compare(high.value) > 0:
                break
            if current is not None and value.compare(current) != 0:
                yield _known(current, passed)
                current, passed = None, ()
            current = value if current is None else current
            passed += event.passed
        if current is not None:
            yield _known(current, passed)

    def _break_events(self) -> Iterator[_EventLine]:
        x, y = self.sector.center
        at_center = directions_at(self.table, Point(x, y), self.through)
        for dx, dy in (*self.breaks, *at_center):
            value = self.sector.exact((x + dx, y + dy), fmpq(0), 0, 0)
            if value is not None and self.sector.low <= value <= self.sector.high:
                yield _known(value)

    def _edge_events(self, low: float, high: float) -> Iterator[_EventLine]:
        """Where lines pass vertices or touch arcs; what floats leave open is made exact."""
        corner = self.table.images.following[self.own[0]] if len(self.own) == 2 else -1
        if low == -inf or high == inf:
            low, high = -1.0, 1.0
        for first, last, number, side, sign, sure in line_events(self.around, corner, low, high):
            passed = ((number, side, sign),)
            if sure:
                yield _EventLine(first, last, passed)
                continue
            value = self.sector.exact(*self._target(number, side), side, sign)
            if value is not None:
                yield _known(value, passed)

    def _value(self, line: _EventLine) -> Real:
        """The exact parameter of a line; a late number where only the interval is known."""
        if line.value is None:
            ((number, side, sign),) = line.passed
            make = partial(_exact, self.sector, *self._target(number, side), side, sign)
            line.value = Real.late(arb(line.low).union(arb(line.high)), make)
        return line.value

    def _target(self, number: int, side: int) -> tuple[Vector, fmpq]:
        if side == 0:
            return self.table.vertices[number], fmpq(0)
        arc = self.table.curves[number]
        return arc.center.rational, arc.radius_sq  # type: ignore[union-attr, return-value]

    # -- edges met -----------------------------------------------------------------------------

    def _middle(self, a: _EventLine, b: _EventLine) -> tuple[float | fmpq, float]:
        """A number between two lines, a float if they are apart, with the bound of its own float."""
        if a.high < b.low:
            middle = 0.5 * (a.high + b.low)
            if a.high < middle < b.low:
                return middle, 0.0
        between = rational_between(self._value(a), self._value(b))
        return between, UNIT * abs(float(between))

    def _meets(
        self, lines: list[_EventLine], middles: list[tuple[float | fmpq, float]]
    ) -> Iterator[tuple[int | None, int | None]]:
        """First edge behind and ahead in the middle of each cell."""
        passed = [
            [number if side == 0 else -1 - number for number, side, _ in line.passed] for line in lines[:-1]
        ]
        places, bounds = [float(middle) for middle, _ in middles], [bound for _, bound in middles]
        found = first_edges(self.around, places, bounds, passed, bool(self.through))
        for (middle, _), behind, ahead, possible in zip(middles, *found, strict=True):
            if behind == DOUBT:
                yield self._exact_meet(_rational(middle), possible)
            else:
                yield behind if behind >= 0 else None, ahead if ahead >= 0 else None

    def _exact_meet(self, middle: fmpq, edges: Iterable[int]) -> tuple[int | None, int | None]:
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
                    nearest[side] = tau, e
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

    def _is_at_center(self, middle: float | fmpq, ahead: int | None) -> bool:
        """Whether a normal meets the edge ahead in the centre of the arc.

        Then all normals of a family do; others, which meet the same arc elsewhere, are another family.
        """
        if ahead is None or ahead not in self.through:
            return False
        contact, direction = self.sector.touch(Real(_rational(middle)))
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


def _exact(sector: Sector, center: Vector, radius_sq: fmpq, side: int, sign: int) -> Real:
    """The exact parameter of an event that there is."""
    value = sector.exact(center, radius_sq, side, sign)
    assert value is not None, "floats are certain only of lines that exist"
    return value


def _rational(middle: float | fmpq) -> fmpq:
    return fmpq(*middle.as_integer_ratio()) if isinstance(middle, float) else middle


def _known(value: Real, passed: Passed = ()) -> _EventLine:
    near, bound = held(value)
    return _EventLine(near - 2 * bound, near + 2 * bound, passed, value)


def _clusters(events: list[_EventLine]) -> Iterator[list[_EventLine]]:
    """Runs of events whose order the intervals leave open; the events come by their lower ends."""
    cluster: list[_EventLine] = []
    reached = -inf
    for event in events:
        if cluster and event.low > reached:
            yield cluster
            cluster = []
        reached = max(reached, event.high) if cluster else event.high
        cluster.append(event)
    if cluster:
        yield cluster


def _by_value(a: tuple[Real, _EventLine], b: tuple[Real, _EventLine]) -> int:
    return a[0].compare(b[0])
