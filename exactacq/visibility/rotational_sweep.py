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

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, cmp_to_key, partial
from math import inf, isnan
from typing import TypeAlias

from flint import arb, fmpq

from exactacq.geometry.coordinates import raw
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Point
from exactacq.kernel.bounded import UNIT
from exactacq.kernel.cells import BoundLine, LineCells, clusters, middles, rows, sure_bounds
from exactacq.kernel.first_edges import DOUBT, NOTHING, first_edges
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


class Pencil:
    """The lines of one sector: ``rows`` are its cells, from low to high, as floats tell them apart.

    The exact parameters of the lines that bound cells are made when they are first asked for.
    """

    def __init__(self, table: EdgeTable, sector: Sector) -> None:
        self.table, self.sector = table, sector
        self.rows: list[LineCells] = []
        self._pinched: list[BoundLine] = []

    def join(self, bounds: list[BoundLine], rows: list[LineCells]) -> None:
        """Take in what was swept."""
        self.rows = rows
        self._pinched = [bound for bound in bounds if len(bound.passed) > 1]

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """The cells."""
        return tuple(self.cell(row) for row in self.rows)

    @property
    def pinches(self) -> Iterator[tuple[Real, Passed]]:
        """The lines that pass several things, and these."""
        return ((self.value(bound), tuple(bound.passed)) for bound in self._pinched)

    def cell(self, row: LineCells) -> Cell:
        """The cell of a row."""
        first, last = row.first, row.last
        return Cell(
            self.value(first),
            self.value(last),
            None if row.behind < 0 else row.behind,
            None if row.ahead < 0 else row.ahead,
            (tuple(first.passed), tuple(last.passed)),
        )

    def value(self, bound: BoundLine) -> Real:
        """The exact parameter of a line; a late number where only the interval is known."""
        if bound.value is None:
            ((number, side, sign),) = bound.passed
            make = partial(_exact, self.sector, *target(self.table, number, side), side, sign)
            bound.value = Real.late(arb(bound.low).union(arb(bound.high)), make)
        assert isinstance(bound.value, Real), "values are made here"
        return bound.value


def pencil(
    table: EdgeTable,
    sector: Sector,
    own: tuple[int, ...],
    reach: float,
    breaks: tuple[Vector, ...] = (),
    ends: tuple[int, int] = (NOTHING, NOTHING),
) -> Pencil:
    """Sweep one sector; only edges within *reach* of the contact are considered.

    *own* are the edges through the contact, *breaks* further directions (at a corner) that end cells, *ends*
    vertices that the first and the last line of the sector pass: to find that out would take exact numbers.
    What lies beyond *reach* may be reported wrongly or as None, so a chord is to be trusted only if both its
    halves are no longer than *reach*.
    """
    edges = table.near(*_box(sector), reach).tolist()
    return _SectorSweep(table, sector, own, edges, breaks, ends).run()


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
        ends: tuple[int, int],
    ) -> None:
        self.table, self.sector, self.own, self.breaks = table, sector, own, breaks
        self.pencil = Pencil(table, sector)
        images = table.images
        left_out = [e for e in own if sector.round or images.kind[e] == STRAIGHT]
        self.edges = [e for e in edges if e not in left_out] if left_out else edges
        self.around = Surroundings(images, sector.frame(), self.edges, list(own))
        vertices = self.around.vertices
        self.ends = [vertex if vertex in vertices else NOTHING for vertex in ends]
        # The edges through the centre of an arc whose normals go there: all of these pass that point.
        self.through: tuple[int, ...] = ()
        if isinstance(sector, Spokes) and not sector.outward:
            self.through = table.edges_at(Point(*sector.center))

    def run(self) -> Pencil:
        bounds = self._bounds()
        exact: dict[int, fmpq] = {}
        places = middles(bounds)
        errors = [0.0] * len(places)
        for k, place in enumerate(places):
            if isnan(place):
                exact[k] = rational_between(self.pencil.value(bounds[k]), self.pencil.value(bounds[k + 1]))
                places[k] = float(exact[k])
                errors[k] = UNIT * abs(places[k])
        passed = [
            [number if side == 0 else -1 - number for number, side, _ in bound.passed]
            for bound in bounds[:-1]
        ]
        behind, ahead, possible = first_edges(self.around, places, errors, passed, bool(self.through))
        for k, edge in enumerate(behind):
            if edge == DOUBT:
                behind[k], ahead[k] = self._exact_meet(exact.get(k, _rational(places[k])), possible[k])
        kinds = [0] * len(places)
        if self.through:
            kinds = [
                int(self._is_at_center(exact.get(k, _rational(place)), ahead[k]))
                for k, place in enumerate(places)
            ]
        self.pencil.join(bounds, rows(bounds, behind, ahead, kinds))
        return self.pencil

    # -- events --------------------------------------------------------------------------------

    def _bounds(self) -> list[BoundLine]:
        """The distinct lines at which there are events, from low to high."""
        low, high = _known(Real(self.sector.low)), _known(Real(self.sector.high))
        events = [*self._break_events(), *self._edge_events(low.low, high.high)]
        for bound, vertex in zip((low, high), self.ends, strict=True):
            if vertex != NOTHING:
                bound.passed = [(vertex, 0, 0)]
        events += [low, high]
        found: list[BoundLine] = []
        for cluster in clusters(events, low, high):
            if len(cluster) == 1:
                found += cluster
            else:
                found += self._resolved(cluster, low in cluster, high in cluster)
        return found

    def _resolved(self, cluster: list[BoundLine], has_low: bool, has_high: bool) -> Iterator[BoundLine]:
        """The distinct lines of a cluster, from the low bound on or up to the high one, in exact order."""
        values = [(self.pencil.value(event), event) for event in cluster]
        values.sort(key=cmp_to_key(_by_value))
        low, high = Real(self.sector.low), Real(self.sector.high)
        current: Real | None = None
        passed: list[tuple[int, int, int]] = []
        for value, event in values:
            if has_low and value.compare(low) < 0:
                continue
            if has_high and value.compare(high) > 0:
                break
            if current is not None and value.compare(current) != 0:
                yield _known(current, passed)
                current, passed = None, []
            current = value if current is None else current
            passed += event.passed
        if current is not None:
            yield _known(current, passed)

    def _break_events(self) -> Iterator[BoundLine]:
        x, y = self.sector.center
        at_center = directions_at(self.table, Point(x, y), self.through)
        for dx, dy in (*self.breaks, *at_center):
            value = self.sector.exact((x + dx, y + dy), fmpq(0), 0, 0)
            if value is not None and self.sector.low <= value <= self.sector.high:
                yield _known(value)

    def _edge_events(self, low: float, high: float) -> list[BoundLine]:
        """Where lines pass vertices or touch arcs; what floats leave open is made exact."""
        corner = self.table.images.following[self.own[0]] if len(self.own) == 2 else -1
        if low == -inf or high == inf:
            low, high = -1.0, 1.0
        events = line_events(self.around, corner, low, high)
        found = sure_bounds(events, *self.ends)
        if len(found) < len(events):
            for _, _, number, side, sign, sure in events:
                if not sure and (side or number not in self.ends):
                    value = self.sector.exact(*target(self.table, number, side), side, sign)
                    if value is not None:
                        found.append(_known(value, [(number, side, sign)]))
        return found

    # -- edges met -----------------------------------------------------------------------------

    def _exact_meet(self, middle: fmpq, edges: Iterable[int]) -> tuple[int, int]:
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
        return proper.get(-1, NOTHING), proper.get(1, NOTHING)

    def _is_blocked_at_center(self, direction: Point) -> bool:
        """Whether a normal enters an obstacle in the centre of the arc, on a boundary that goes through it.

        Where that is a corner, no edge tells it alone, though one at least is entered if the obstacle is.
        """
        if not self.through:
            return False
        incoming, outgoing = self.table.curves[self.through[0]], self.table.curves[self.through[-1]]
        ways = list(directions_at(self.table, Point(*self.sector.center), self.through))
        return enters(incoming, outgoing, ways[0], ways[-1], raw(direction))

    def _is_at_center(self, middle: fmpq, ahead: int) -> bool:
        """Whether a normal meets the edge ahead in the centre of the arc.

        Then all normals of a family do; others, which meet the same arc elsewhere, are another family.
        """
        if ahead not in self.through:
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


def _exact(sector: Sector, center: Vector, radius_sq: fmpq, side: int, sign: int) -> Real:
    """The exact parameter of an event that there is."""
    value = sector.exact(center, radius_sq, side, sign)
    assert value is not None, "floats are certain only of lines that exist"
    return value


def target(table: EdgeTable, number: int, side: int) -> tuple[Vector, fmpq]:
    """What a line passes, as a circle: a vertex, with radius 0, or that of an arc."""
    if side == 0:
        return table.vertices[number], fmpq(0)
    arc = table.curves[number]
    return arc.center.rational, arc.radius_sq  # type: ignore[union-attr, return-value]


def _rational(middle: float) -> fmpq:
    return fmpq(*middle.as_integer_ratio())


def _known(value: Real, passed: Sequence[tuple[int, int, int]] = ()) -> BoundLine:
    near, bound = held(value)
    return BoundLine(near - 2 * bound, near + 2 * bound, list(passed), value)


def _by_value(a: tuple[Real, BoundLine], b: tuple[Real, BoundLine]) -> int:
    return a[0].compare(b[0])
