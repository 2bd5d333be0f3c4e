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

from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import isnan
from operator import itemgetter
from typing import TypeAlias

from flint import arb, fmpq

from exactacq.cached import cached_property
from exactacq.geometry.coordinates import Vector, raw
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Point
from exactacq.grouping import in_groups
from exactacq.kernel.bound_lines import NOTHING, BoundLine, known_line
from exactacq.kernel.bounded import UNIT
from exactacq.kernel.cells import LineCells
from exactacq.kernel.images import SLIDING, SPOKES, TURNING
from exactacq.kernel.lattice import LatticeLines
from exactacq.kernel.near_edges import NearEdges
from exactacq.kernel.pencil_sweep import DONE, EDGES, EVENTS, MIDDLES, ORDER, PencilSweep
from exactacq.kernel.sector_edges import may_be_met
from exactacq.kernel.surroundings import Surroundings
from exactacq.numbers.between import rational_between
from exactacq.numbers.precision import workprec
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable, corners
from exactacq.visibility.features import directions_at, enters
from exactacq.visibility.line_balls import LONG, Line, entered, event_ball, first_meetings, long_frame
from exactacq.visibility.line_families import Rolling, Sector, Sliding, held
from exactacq.visibility.quadratic_roots import QuadraticRoot

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

    def __init__(
        self,
        table: EdgeTable,
        sector: Sector,
        edges: list[int],
        rows: list[LineCells],
        pinched: list[BoundLine],
    ) -> None:
        self.table, self.sector, self._edges = table, sector, edges
        self.rows, self._pinched = rows, pinched

    @cached_property
    def edges(self) -> frozenset[int]:
        """The edges among which the sector was swept."""
        return frozenset(self._edges)

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
        return value_of(self.table, self.sector, bound)

    def rational(self, bound: BoundLine) -> fmpq | None:
        """The exact parameter of a line, if it is seen to be rational."""
        value = bound.value
        if value is None and bound.passes_several:
            value = self.value(bound)
        if isinstance(value, Real):
            return None if value.is_late else value.rational
        return value if isinstance(value, fmpq) else None


def value_of(table: EdgeTable, sector: Sector, bound: BoundLine) -> Real:
    """The exact parameter of a line of a sector; a late number where only the interval is known."""
    value = bound.value
    if isinstance(value, Real):
        return value
    if isinstance(value, fmpq):
        made = Real(value)
    elif bound.passes_several:
        # Integers brought together what it passes: vertices.
        shared = through_vertex(table, sector, bound.number)
        assert shared is not None, "on a lattice all is rational"
        made = Real(shared)
    else:
        circle = target(table, bound.number, bound.side)
        around = arb(bound.low).union(arb(bound.high))
        made = Real.late(around, _exact, sector, *circle, bound.side, bound.sign)
    bound.value = made
    return made


def through_vertex(table: EdgeTable, sector: Sector, v: int) -> fmpq | None:
    """The parameter of the line through a vertex, where it is one quotient of rationals."""
    (x, y), (cx, cy), (ex, ey) = table.vertices[v], sector.center, sector.base
    if isinstance(sector, Rolling) or not (isinstance(cx, fmpq) and isinstance(ex, fmpq)):
        return None
    dx, dy = x - cx, y - cy
    along = ex * dx + ey * dy
    if isinstance(sector, Sliding):
        return along / (ex * ex + ey * ey)
    return (ex * dy - ey * dx) / along if along else None


def pencil(
    table: EdgeTable,
    sector: Sector,
    own: tuple[int, ...],
    reach: float,
    breaks: tuple[Vector, ...] = (),
    vertex: int = NOTHING,
) -> Pencil:
    """Sweep one sector; only edges that may be seen within *reach* of the contact are considered.

    *own* are the edges through the contact, *breaks* further directions (at a corner) that end cells, and
    *vertex* is that in the sector's centre, if it is known. What lies beyond *reach* may be reported wrongly
    or as None, so a chord is to be trusted only if both its halves are no longer than *reach*.
    """
    (x, y), extent = map(float, sector.center), sector.extent
    places = corners((x - extent, y - extent, x + extent, y + extent)) if extent else ((x, y),)
    edges = table.lit(places, reach)
    return swept(table, sector, own, edges, breaks, vertex=vertex)


def swept(
    table: EdgeTable,
    sector: Sector,
    own: tuple[int, ...],
    edges: list[int],
    breaks: tuple[Vector, ...] = (),
    ends: tuple[int, int] = (NOTHING, NOTHING),
    vertex: int = NOTHING,
    goes_back: bool = True,
) -> Pencil:
    """Sweep one sector among the edges near its contact.

    *ends* are vertices that the first and the last line of the sector pass: to find that out would take exact
    numbers. *vertex* is that in the sector's centre, if it is known. Unless it *goes_back* nothing is asked
    of what is behind the contact.
    """
    images, (low, high) = table.images, sector.span
    if sector.is_rational:
        edges = may_be_met(images, edges, sector.image, low, high, goes_back)
    near = NearEdges(images, edges)
    frame = sector.frame(None if vertex == NOTHING else images[vertex].place())
    # The edges through the centre of an arc whose normals go there: all of these pass that point.
    is_inward = frame.kind == SPOKES and frame.sense < 0
    through = table.edges_at(Point(*sector.center)) if is_inward else ()
    first, last = ends
    broken = list(_break_events(table, sector, breaks, through)) if breaks or through else []
    sweep = PencilSweep(
        # A tangent of a circle meets none of its arcs but at the contact.
        Surroundings(near, frame, table.on_circle_of(own[0]) if sector.round else own),
        known_line(*low, [(first, 0, 0)] if near.has_vertex(first) else [], sector.low),
        known_line(*high, [(last, 0, 0)] if near.has_vertex(last) else [], sector.high),
        broken,
        table.following[own[0]] if len(own) == 2 else NOTHING,
        bool(through),
        None if breaks or vertex == NOTHING else _on_lattice(table, sector, frame.kind, vertex),
    )
    if sweep.stage != DONE:
        _Decisions(table, sector, own, through, sweep).make()
    if not breaks:
        return Pencil(table, sector, edges, sweep.rows, sweep.pinched)
    return Pencil(table, sector, edges, sweep.rows, [b for b in sweep.bounds if _is_pinched(b, broken)])


def _is_pinched(bound: BoundLine, broken: Sequence[BoundLine]) -> bool:
    """Whether no line beside one may be free as far.

    It passes several things, one thing along a break, or none along two. On one side of a break lines lead
    into the obstacle at the contact; on both sides if two are one, as in a hollow between two arcs. A line
    that floats do not part from a break counts.
    """
    if bound.passes_several:
        return True
    along = [b for b in broken if bound.low <= b.high and b.low <= bound.high]
    return len(along) > 1 or (bool(along) and bool(bound.passed))


def _on_lattice(table: EdgeTable, sector: Sector, kind: int, vertex: int) -> LatticeLines | None:
    """The lines of a sector about a vertex in integers; None where there are none, or large ones only."""
    if table.lattice is None or kind not in (TURNING, SLIDING):
        return None
    common, lattice = table.lattice
    x, y = (c * common for c in sector.base)
    low, high = sector.low, sector.high
    if not (x.q == y.q == 1 and isinstance(low, fmpq) and isinstance(high, fmpq)):
        return None
    ends = (int(low.p), int(low.q)), (int(high.p), int(high.q))
    return LatticeLines(lattice, kind, vertex, (int(x.p), int(y.p)), *ends)


def _break_events(
    table: EdgeTable, sector: Sector, breaks: tuple[Vector, ...], through: tuple[int, ...]
) -> Iterator[BoundLine]:
    x, y = sector.center
    for dx, dy in (*breaks, *directions_at(table, Point(x, y), through)):
        value = sector.exact((x + dx, y + dy), fmpq(0), 0, 0)
        if value is not None and sector.low <= value <= sector.high:
            yield _known(value)


class _Decisions:
    """Decides what floats leave open in the sweep of a sector."""

    def __init__(
        self,
        table: EdgeTable,
        sector: Sector,
        own: tuple[int, ...],
        through: tuple[int, ...],
        sweep: PencilSweep,
    ) -> None:
        self.table, self.sector, self.own, self.through, self.sweep = table, sector, own, through, sweep
        self._exact_middles: dict[int, fmpq] = {}
        # The edges that the line met first at which floats left that open last, if balls told.
        self._nearest: list[int] | None = None

    def make(self) -> None:
        """Tell the sweep what it waits for, until it is done."""
        sweep = self.sweep
        if sweep.stage == EVENTS:
            sweep.order(list(self._unsure_events()))
        if sweep.stage == ORDER:
            sweep.part(list(self._parted(sweep.clusters)))
        if sweep.stage == MIDDLES:
            sweep.look(self._middles())
        if sweep.stage == EDGES:
            for cell, edges in sweep.possible.items():
                met = self._met(self._middle(cell), self._perhaps_first(cell, edges))
                sweep.behind[cell], sweep.ahead[cell] = met
            sweep.join([int(self._is_at_center(cell)) for cell in range(len(sweep.middles))])

    # -- events --------------------------------------------------------------------------------

    def _unsure_events(self) -> Iterator[BoundLine]:
        """Those that there are, of which floats leave that open."""
        for event in self.sweep.unsure:
            number, side, sign = event.number, event.side, event.sign
            value = self.sector.exact(*target(self.table, number, side), side, sign)
            if value is not None:
                yield _known(value, [(number, side, sign)])

    def _parted(self, clusters: list[list[BoundLine]]) -> Iterator[BoundLine]:
        """The distinct lines at which there are events, from low to high."""
        for cluster in clusters:
            if len(cluster) == 1:
                yield cluster[0]
            else:
                yield from self._resolved(cluster)

    def _resolved(self, cluster: list[BoundLine]) -> Iterator[BoundLine]:
        """The distinct lines of a cluster, from the low bound on or up to the high one, in exact order."""
        low, high = self.sweep.low, self.sweep.high
        waits = low in cluster
        for group in self._grouped(cluster):
            has_low, has_high = low in group, high in group
            waits = waits and not has_low
            if not waits:
                yield from self._compared(group, has_low, has_high)
            if has_high:
                return

    def _grouped(self, cluster: list[BoundLine]) -> list[list[BoundLine]]:
        """The lines of a cluster in order, together where long balls leave it open; they know their values.

        Lines of a drawing with rounded coordinates differ by less than floats tell, but most do differ. On a
        coarse lattice most are equal.
        """
        if self.table.is_coarse or not self.sector.is_rational:
            return [cluster]
        lines = [(self._rational(event), event) for event in cluster]
        found: list[tuple[arb, arb, BoundLine]] = []
        with workprec(LONG):
            at = long_frame(self.sector)
            for value, event in lines:
                ball = self._long_ball(at, event) if value is None else arb(value)
                if ball is None:
                    return [cluster]
                found.append((ball.lower(), ball.upper(), event))
        found.sort(key=itemgetter(0))
        groups: list[list[BoundLine]] = []
        reached: arb | None = None
        for low, high, event in found:
            if reached is None or reached < low:
                groups.append([event])
                reached = high
            else:
                groups[-1].append(event)
                reached = max(reached, high)
        return groups

    def _long_ball(self, at: Line, event: BoundLine) -> arb | None:
        """A long ball around the parameter of a line, which it has as its late value from now on."""
        value = event.value
        if isinstance(value, Real) and not value.is_late:
            return value.working_ball(LONG)
        circle = target(self.table, event.number, event.side)
        ball = event_ball(self.sector, at, circle, event.side, event.sign)
        if ball is not None and value is None:
            event.value = Real.late(ball, _exact, self.sector, *circle, event.side, event.sign)
        return ball

    def _compared(self, group: list[BoundLine], has_low: bool, has_high: bool) -> Iterator[BoundLine]:
        """The distinct lines of some, from the low bound on or up to the high one, in exact order."""
        if len(group) == 1:
            (event,) = group
            value = self._rational(event)
            yield _known(value_of(self.table, self.sector, event) if value is None else value, event.passed)
            return
        found: dict[Hashable, _Value] = {}
        values = [(self._valued(event, found), event) for event in group]
        if any(isinstance(value.number, Real) for value, _ in values):
            groups = in_groups(values, _by_value)
        else:
            values.sort(key=_rational_value)
            groups = [list(equal) for _, equal in groupby(values, key=_rational_value)]
        waits = has_low
        for equal in groups:
            events = [event for _, event in equal]
            waits = waits and self.sweep.low not in events
            if not waits:
                yield _known(equal[0][0].number, [one for event in events for one in event.passed])
            if has_high and self.sweep.high in events:
                return

    def _valued(self, event: BoundLine, found: dict[Hashable, _Value]) -> _Value:
        """The parameter of a line; one object for equal roots, as circles in a row share many tangents."""
        if isinstance(self.sector, Sliding) and not self.sector.is_rational:
            return self._measured(self.sector, event)
        value = self._rational(event)
        if value is not None:
            return _Value(value)
        root = None
        if event.number != NOTHING and not event.others:
            circle = target(self.table, event.number, event.side)
            root = self.sector.root(*circle, event.side, event.sign)
        if isinstance(root, fmpq):
            event.value = root
            return _Value(root)
        if root is None:
            return _Value(value_of(self.table, self.sector, event))
        key = root.key
        if key not in found:
            found[key] = _Value(value_of(self.table, self.sector, event), root)
        return found[key]

    def _measured(self, sector: Sliding, event: BoundLine) -> _Value:
        """The parameter of a normal of an irrational segment, with its height."""
        number, sign = (self.table.circles[event.number], event.sign) if event.side else (event.number, 0)
        known = sector.touching.get((number, sign))
        value = value_of(self.table, sector, event) if known is None else known
        if event.number == NOTHING or known is not None:
            return _Value(value, height=sector.height_at(value))
        circle = target(self.table, event.number, event.side)
        return _Value(value, height=sector.height(*circle, event.side, event.sign))

    def _rational(self, event: BoundLine) -> fmpq | None:
        """The exact parameter of a line, if it is seen to be rational."""
        value = event.value
        if value is None and event.side == 0:
            value = event.value = through_vertex(self.table, self.sector, event.number)
        if isinstance(value, Real):
            return None if value.is_late else value.rational
        assert value is None or isinstance(value, fmpq), "values are exact"
        return value

    # -- lines of the cells ----------------------------------------------------------------------

    def _middles(self) -> list[float]:
        """Finds a rational line where floats part no two bounds; the errors of all middles."""
        sweep = self.sweep
        errors = [0.0] * len(sweep.middles)
        for cell, middle in enumerate(sweep.middles):
            if isnan(middle):
                low, high = (
                    value_of(self.table, self.sector, bound) for bound in sweep.bounds[cell : cell + 2]
                )
                self._exact_middles[cell] = rational_between(low, high)
                sweep.middles[cell] = float(self._exact_middles[cell])
                errors[cell] = UNIT * abs(sweep.middles[cell])
        return errors

    def _middle(self, cell: int) -> fmpq:
        exact = self._exact_middles.get(cell)
        return fmpq(*self.sweep.middles[cell].as_integer_ratio()) if exact is None else exact

    # -- edges met -----------------------------------------------------------------------------

    def _perhaps_first(self, cell: int, edges: list[int]) -> list[int]:
        """Of the edges that a cell's line may meet those that it may meet first.

        An edge without an event between two cells is met in both, in the same order with all other such
        edges: so what was met first in the cell before hides them, unless it has an event itself. Concave
        arcs that are touched without an event are touched where the line is blocked already.
        """
        nearest = self._nearest if cell - 1 in self.sweep.possible else self._nearest_in_floats(cell - 1)
        if nearest is None or self.through:
            return edges
        changed = set[int]()
        for number, side, _ in self.sweep.bounds[cell].passed:
            changed.update((number,) if side else (number, self.table.preceding[number]))
        if not changed.isdisjoint(nearest):
            return edges
        changed.update(nearest)
        return [e for e in edges if e in changed]

    def _nearest_in_floats(self, cell: int) -> list[int] | None:
        """What the line of a cell meets first behind and ahead, where floats tell that both are entered."""
        if cell < 0:
            return None
        nearest = [self.sweep.behind[cell], self.sweep.ahead[cell]]
        return None if NOTHING in nearest else nearest

    def _met(self, middle: fmpq, edges: list[int]) -> tuple[int, int]:
        """The first edges that a line meets behind and ahead."""
        first, left = first_meetings(self.table, self.sector, middle, edges, self.own)
        self._nearest = None if left else [e for *_, e in first.values()]
        if not left and not self.through:
            return entered(first)
        # All these lines pass the centre, where edges *through* it are: balls tell these from it in no case.
        left += [e for e in edges if e in self.through]
        return self._exact_meet(middle, [*left, *(e for *_, e in first.values())])

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

    def _is_at_center(self, cell: int) -> bool:
        """Whether a normal meets the edge ahead in the centre of the arc.

        Then all normals of a family do; others, which meet the same arc elsewhere, are another family.
        """
        ahead = self.sweep.ahead[cell]
        if ahead not in self.through:
            return False
        contact, direction = self.sector.touch(Real(self._middle(cell)))
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


def _known(value: fmpq | Real, passed: Sequence[tuple[int, int, int]] = ()) -> BoundLine:
    return known_line(*held(value), list(passed), value)


class _Value:
    """The parameter of a line, perhaps also as the root of a quadratic: then equal ones cost no radical.

    Or with its height (see `Sliding.height`), by which it is compared with others that have one.
    """

    __slots__ = ("height", "number", "root")

    def __init__(
        self, number: fmpq | Real, root: QuadraticRoot | None = None, height: Real | None = None
    ) -> None:
        if isinstance(number, Real) and not number.is_late and number.rational is not None:
            number = number.rational
        self.number, self.root, self.height = number, root, height

    def compare(self, other: _Value) -> int:
        """-1, 0 or 1 as it is less than another one, equal to it or greater."""
        if self is other:
            return 0
        if self.height is not None and other.height is not None:
            return self.height.compare(other.height)
        one, two = self.number, other.number
        if isinstance(one, fmpq) and isinstance(two, fmpq):
            return int(one > two) - int(one < two)
        return 0 if self._equals(other) else Real(one).compare(two)

    def _equals(self, other: _Value) -> bool:
        """Whether they are seen to be equal."""
        if self.root is None:
            return (
                other.root is not None and isinstance(self.number, fmpq) and other.root.is_value(self.number)
            )
        if other.root is None:
            return isinstance(other.number, fmpq) and self.root.is_value(other.number)
        return self.root.equals(other.root)


def _by_value(a: tuple[_Value, BoundLine], b: tuple[_Value, BoundLine]) -> int:
    return a[0].compare(b[0])


def _rational_value(a: tuple[_Value, BoundLine]) -> fmpq | Real:
    return a[0].number
