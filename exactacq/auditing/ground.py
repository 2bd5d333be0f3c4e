"""The audit of a sweep's ground: M-line, blocked ways, and what the terrain leaves of obstacles, found again.

Boundaries are cut at the lines of the border and ordered by lengths in balls. Their parts and the intervals
of the border between them are nodes of two graphs: what free space joins, and what obstacles join. A
boundary that nowhere meets the border is joined to what a ray to the west meets. What a way along the border
has beside it is decided by rays too. Nothing of the strategy, of its M-line or of its components is used.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from functools import cmp_to_key
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from flint import arb

from exactacq.auditing.comparisons import (
    BITS,
    ball_sum,
    ball_to,
    is_close,
    is_part,
    passes,
    place_text,
    refined,
    same,
)
from exactacq.auditing.visibility import World, between
from exactacq.cached import cached_property
from exactacq.errors import AuditError
from exactacq.geometry.box_index import bounds
from exactacq.geometry.coordinates import minus, ratio, raw
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import contacts, line_contacts
from exactacq.geometry.points import Location, Point
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.scene.scene import Obstacle
from exactacq.strategies.run import Run, SeedSpreaderRun

if TYPE_CHECKING:
    from networkx.utils import UnionFind


class Stretch(NamedTuple):
    """A blocked stretch of a way, between two parameters from 0 to 1, and the obstacle that blocks it."""

    obstacle: int
    low: Real
    high: Real
    begin: Point
    end: Point

    def reversed(self) -> Stretch:
        """The stretch as it lies on the way in the other direction."""
        return Stretch(self.obstacle, 1 - self.high, 1 - self.low, self.end, self.begin)


class CrossingPoint(NamedTuple):
    """An end of a blocked stretch of the M-line: on which straight piece, and at which length from S.

    ``owner`` is the component that blocks, None for one that cannot be reached; ``ashore`` if the place is
    on the owner's walkable boundary.
    """

    piece: int
    at: Real
    point: Point
    ends: bool
    owner: int | None
    ashore: bool


class Field:
    """The terrain of a run with the M-line, and where obstacles block straight ways through it."""

    def __init__(self, run: Run, world: World) -> None:
        assert run.scene.terrain is not None
        self.run, self.world = run, world
        self.width, self.height = run.scene.terrain.width, run.scene.terrain.height
        self.west, self.south = run.scene.terrain.origin
        self.east, self.north = self.west + self.width, self.south + self.height
        self.lines = [self.west]
        while self.lines[-1] < self.east:
            self.lines.append(min(self.lines[-1] + run.radius, self.east))
        ends = [(self.south, self.north), (self.north, self.south)]
        corners = [Point(x, y) for j, x in enumerate(self.lines) for y in ends[j % 2]]
        self.pieces = [Segment(p, q) for p, q in pairwise(corners)]
        self.bases = [Real(0)]
        for piece in self.pieces:
            along = piece.direction
            self.bases.append(self.bases[-1] + abs(along.x) + abs(along.y))

    # -- the M-line --------------------------------------------------------------------------------

    def position(self, piece: int, point: Point) -> Real | None:
        """The length of the M-line from S to a point of a straight piece of it; None if it is not on it."""
        way = self.pieces[piece]
        if not way.passes(point):
            return None
        offset = point - way.start
        return self.bases[piece] + abs(offset.x) + abs(offset.y)

    @cached_property
    def marks(self) -> list[CrossingPoint]:
        """All ends of blocked stretches, in the order of the M-line; T is none if it is blocked itself."""
        found: list[CrossingPoint] = []
        for k, way in enumerate(self.pieces):
            for stretch in self.stretches(way):
                obstacle = self.world.obstacles[stretch.obstacle]
                if stretch.low.sign() == 0 and self._is_sealed(obstacle, way.start):
                    found.pop()
                else:
                    found.append(self._mark(k, stretch.obstacle, stretch.begin, False))
                found.append(self._mark(k, stretch.obstacle, stretch.end, True))
        if found and found[-1].at == self.bases[-1]:
            blocked = [o for o in self.world.obstacles if self._is_sealed(o, found[-1].point)]
            if blocked:
                found.pop()
        return found

    def _mark(self, piece: int, obstacle: int, point: Point, ends: bool) -> CrossingPoint:
        at = self.position(piece, point)
        assert at is not None
        owner = self.owner(obstacle, point)
        return CrossingPoint(
            piece, at, point, ends, owner, owner is not None and self.is_ashore(owner, point)
        )

    @cached_property
    def crossing(self) -> frozenset[int]:
        """The components that block the M-line somewhere."""
        return frozenset(mark.owner for mark in self.marks if mark.owner is not None)

    def extent(self, k: int) -> tuple[Real, Real]:
        """The least and the greatest x of a component's boundary in the terrain."""
        component: Any = self.run.obstacles[k]
        curves = [part.curve for shore in (component.shore, *component.hidden) for part in shore]
        values = [end.x for curve in curves for end in (curve.start, curve.end)]
        for curve in curves:
            if isinstance(curve, Arc):
                sides = (Point(curve.center.x + r, curve.center.y) for r in (curve.radius, -curve.radius))
                values += [side.x for side in sides if curve.contains(side)]
        return min(values), max(values)

    def strip(self, k: int) -> int:
        """The strip j, from line j - 1 to line j, that holds a component that does not cross the M-line."""
        east = self.extent(k)[1]
        return next(j for j, x in enumerate(self.lines) if east <= x)

    def owner(self, obstacle: int, point: Point) -> int | None:
        """The component of an obstacle on whose boundary, walkable or not, a point lies."""
        for k, component in enumerate(self.run.obstacles):
            body: Any = component
            if body.obstacle.index == obstacle:
                shores = (body.shore, *body.hidden)
                if any(passes(part.curve, point) for shore in shores for part in shore):
                    return k
        return None

    def is_ashore(self, component: int, point: Point) -> bool:
        """Whether a point lies on a component's walkable boundary."""
        return any(passes(edge, point) for edge in self.run.obstacles[component].edges)

    # -- blocked ways ------------------------------------------------------------------------------

    def stretches(self, way: Segment) -> list[Stretch]:
        """The blocked stretches of a way through the terrain, in its order, without such as meet in a point.

        A place is blocked if all of the terrain around it is obstacle.
        """
        (window,) = bounds([way])
        near = [int(e) for e in self.world.index.query(*window)]
        found: list[Stretch] = []
        for k in sorted({self.world.owner[e] for e in near}):
            edges = (self.world.edges[e] for e in near if self.world.owner[e] == k)
            cuts = [(Real(0), way.start), *(cut for edge in edges for cut in _inner_contacts(way, edge))]
            cuts = sorted([*cuts, (Real(1), way.end)], key=lambda cut: cut[0])
            cuts = [cut for n, cut in enumerate(cuts) if n == 0 or cuts[n - 1][0] != cut[0]]
            found += self._blocked(way, self.world.obstacles[k], cuts)
        return sorted(found, key=lambda stretch: stretch.low)

    def _blocked(
        self, way: Segment, obstacle: Obstacle, cuts: Sequence[tuple[Real, Point]]
    ) -> Iterator[Stretch]:
        """What one obstacle blocks of a way, cut where it meets the obstacle's edges."""
        shares, places = zip(*cuts, strict=True)
        begin = 0
        for n in range(1, len(cuts)):
            middle = way.start + way.direction * between(shares[n - 1], shares[n])
            if not self._is_blocked(way, obstacle, middle):
                begin = n
                continue
            # A cut between the ends lies on the obstacle's boundary: that need not be found out.
            going_on = n + 1 < len(cuts) and self._is_sealed_on_boundary(obstacle, places[n])
            if going_on:
                after = way.start + way.direction * between(shares[n], shares[n + 1])
                going_on = self._is_blocked(way, obstacle, after)
            if not going_on:
                yield Stretch(obstacle.index, shares[begin], shares[n], places[begin], places[n])
                begin = n

    def _is_blocked(self, way: Segment, obstacle: Obstacle, place: Point) -> bool:
        """Whether a place of a way is blocked that lies between two cuts."""
        location = obstacle.locate(place)
        if location is Location.BOUNDARY:
            inward = self.inward(way.start, way.end)
            return len(inward) == 1 and self._is_inside_beside(obstacle, place, inward[0])
        return location is Location.INSIDE

    def _is_inside_beside(self, obstacle: Obstacle, place: Point, inward: Point) -> bool:
        """Whether the obstacle lies beside a place on the border: from it to where a ray meets an edge."""
        far = [t for edge in obstacle.edges for t in line_contacts(place, inward, edge) if t.sign() > 0]
        return bool(far) and obstacle.locate(place + inward * (min(far) / 2)) is Location.INSIDE

    def inward(self, *points: Point) -> list[Point]:
        """The directions into the terrain from the sides of the border that hold all of some points."""
        sides = [
            ((p.x for p in points), self.west, Point(1, 0)),
            ((p.y for p in points), self.south, Point(0, 1)),
            ((p.x for p in points), self.east, Point(-1, 0)),
            ((p.y for p in points), self.north, Point(0, -1)),
        ]
        return [inward for values, limit, inward in sides if all(v.compare(limit) == 0 for v in values)]

    def is_on_border(self, point: Point) -> bool:
        """Whether a point lies on the border."""
        return self.contains(point) and bool(self.inward(point))

    def _is_sealed(self, obstacle: Obstacle, point: Point) -> bool:
        """Whether a point beside a blocked stretch is blocked: no boundary runs from it into the terrain."""
        location = obstacle.locate(point)
        if location is Location.BOUNDARY:
            return self._is_sealed_on_boundary(obstacle, point)
        return location is Location.INSIDE

    def _is_sealed_on_boundary(self, obstacle: Obstacle, point: Point) -> bool:
        """Whether a point of the boundary beside a blocked stretch is blocked, as `_is_sealed` asks it."""
        inward = self.inward(point)
        edges = (edge for edge in obstacle.edges if passes(edge, point))
        return bool(inward) and not any(_runs_into(edge, point, inward) for edge in edges)

    def contains(self, point: Point) -> bool:
        """Whether a point lies in the closed terrain."""
        (x, y) = point
        is_beside = x.compare(self.west) < 0 or x.compare(self.east) > 0
        return not (is_beside or y.compare(self.south) < 0 or y.compare(self.north) > 0)

    def is_well_inside(self, x: arb, y: arb) -> bool:
        """Whether balls show that a point lies in the open terrain."""
        return bool(arb(self.west) < x < arb(self.east)) and bool(arb(self.south) < y < arb(self.north))

    # -- the border --------------------------------------------------------------------------------

    @cached_property
    def _sides(self) -> list[Segment]:
        """The border, counterclockwise from the SW corner."""
        south, north = ([Point(x, y) for x in (self.west, self.east)] for y in (self.south, self.north))
        corners = [*south, *reversed(north)]
        return [Segment(p, q) for p, q in zip(corners, [*corners[1:], corners[0]], strict=True)]

    def border_contacts(self, edge: int) -> list[tuple[int, Real, Point]]:
        """Where an edge meets the lines of the border: side, share of the side, any number, and point."""
        x0, y0, x1, y1 = map(rational, self.world.boxes[edge].tolist())
        if self.west < x0 and self.south < y0 and x1 < self.east and y1 < self.north:
            return []
        return [
            (k, t, side.start + side.direction * t)
            for k, side in enumerate(self._sides)
            for t in line_contacts(side.start, side.direction, self.world.edges[edge])
        ]

    @cached_property
    def stops(self) -> list[Point]:
        """Corners of the border, and where boundaries meet it, counterclockwise from the SW corner."""
        found = [(k, Real(0), side.start) for k, side in enumerate(self._sides)]
        for edge in range(len(self.world.edges)):
            found += [(k, t, point) for k, t, point in self.border_contacts(edge) if 0 < t < 1]
        found.sort(key=lambda stop: (stop[0], stop[1]))
        apart = [a[:2] != b[:2] for a, b in pairwise(found)]
        return [stop[2] for stop, kept in zip(found, [True, *apart], strict=True) if kept]

    def is_border_blocked(self, start: Point, end: Point) -> bool:
        """Whether the border is blocked between two stops that follow each other."""
        way = Segment(start, end)
        middle = start + way.direction / 2
        return any(self._is_blocked(way, obstacle, middle) for obstacle in self.world.obstacles)


def _inner_contacts(way: Segment, edge: Curve) -> Iterator[tuple[Real, Point]]:
    """Where an edge meets a way between its ends: shares of the way, and the places.

    A place on a straight edge is made from the edge, so that its form shows that it lies on it. Whether a
    contact with an arc is an end of the way is not compared if that end lies on the arc, as an aim does.
    """
    if isinstance(edge, Segment):
        for contact in contacts(way, edge):
            for place in contact.places:
                if place is not way.start and place is not way.end:
                    yield Real(ratio(minus(raw(place), raw(way.start)), raw(way.direction))), place
        return
    for share in line_contacts(way.start, way.direction, edge):
        ends = ((Real(0), way.start), (Real(1), way.end))
        is_end = any(_may_equal(share, other) and passes(edge, end) for other, end in ends)
        if not is_end and 0 < share < 1:
            yield share, way.start + way.direction * share


def _may_equal(a: Real, b: Real) -> bool:
    """Whether two numbers are equal: exactly if they are rational, else to `DIGITS` digits at least."""
    return a.overlaps(b) and is_close(a.ball(BITS), b.ball(BITS))


def _runs_into(edge: Curve, point: Point, inward: Sequence[Point]) -> bool:
    """Whether a part of an edge beside one of its points on the border lies in the open terrain.

    *inward* are the directions into the terrain there: two at its corners.
    """
    if isinstance(edge, Segment):
        ways = [end - point for end in (edge.start, edge.end) if end != point]
        return any(all(way.dot(n).sign() > 0 for n in inward) for way in ways)
    tangent = edge.tangent(point)
    ways = [tangent] if edge.full or point != edge.end else []
    ways += [-tangent] if edge.full or point != edge.start else []
    bend = edge.center - point
    return any(
        all(way.dot(n).sign() > 0 or (way.dot(n).sign() == 0 and bend.dot(n).sign() > 0) for n in inward)
        for way in ways
    )


# -- components ------------------------------------------------------------------------------------


class _EdgePart(NamedTuple):
    """A part of an edge of the scene in the open terrain, between two lengths along the edge."""

    obstacle: int
    edge: int
    low: arb
    high: arb
    start: Point
    end: Point


class _ClaimedComponent(NamedTuple):
    """A part of an edge of the scene that a component claims, as its shore or hidden."""

    component: int
    is_shore: bool
    edge: int
    low: arb
    high: arb

    def holds(self, part: _EdgePart) -> bool:
        """Whether the middle of a part is claimed."""
        with workprec(BITS):
            middle = (part.low + part.high) / 2
            return self.edge == part.edge and bool(self.low < middle) and bool(middle < self.high)


def check_components(run: Run, field: Field) -> None:
    """The components are what the terrain leaves of the obstacles, their shores what S can reach of them."""
    claims = list(_claims(run, field))
    parts = [part for obstacle in field.world.obstacles for part in _parts(field, obstacle)]
    free, solid = _joined(field, parts)
    home = free["S"]
    reached = {solid[n] for n in range(len(parts)) if free[n] == home}
    numbers: dict[Hashable, int] = {}
    for n, part in enumerate(parts):
        where = f"the boundary of obstacle {part.obstacle} of the scene from {place_text(part.start)}"
        group, is_near = solid[n], free[n] == home
        found = [claim for claim in claims if claim.holds(part)]
        if len(found) != (group in reached):
            raise AuditError(f"{where} is part of {len(found)} components, not of {int(group in reached)}")
        for claim in found:
            if claim.is_shore != is_near:
                verb = "can" if is_near else "cannot"
                raise AuditError(f"{where} {verb} be reached, component {claim.component} says otherwise")
            if numbers.setdefault(group, claim.component) != claim.component:
                raise AuditError(f"{where} is of component {numbers[group]}, not {claim.component}")
    if sorted(numbers.values()) != list(range(len(run.obstacles))):
        raise AuditError(
            f"components {sorted(numbers.values())} are in reach, not all of {len(run.obstacles)}"
        )
    groups = {number: group for group, number in numbers.items()}
    for k, component in enumerate(run.obstacles):
        _check_component(field, k, component, [p for n, p in enumerate(parts) if solid[n] == groups[k]])
    lost = sorted({part.obstacle for n, part in enumerate(parts) if solid[n] not in reached})
    if isinstance(run, SeedSpreaderRun) and list(run.unreached) != lost:
        raise AuditError(f"obstacles out of reach are {list(run.unreached)}, not {lost}")


def _claims(run: Run, field: Field) -> Iterator[_ClaimedComponent]:
    """What components claim; each is a part of an edge of their obstacle."""
    obstacles, before = field.world.obstacles, 0
    for k, body in enumerate(run.obstacles):
        component: Any = body
        i = component.obstacle.index
        if i not in range(before, len(obstacles)) or component.obstacle is not obstacles[i]:
            raise AuditError(f"component {k} is of no obstacle of the scene, or not in their order")
        before, edges = i, obstacles[i].edges
        for shore in (component.shore, *component.hidden):
            for part in shore:
                if part.edge not in range(len(edges)) or not is_part(part.curve, edges[part.edge]):
                    raise AuditError(f"a part of component {k} is not on edge {part.edge} of obstacle {i}")
                low, size = _length_to(edges[part.edge], part.curve.start), ball_sum([part.curve])
                with workprec(BITS):
                    high = low + size
                yield _ClaimedComponent(
                    k, shore is component.shore, field.world.first[i] + part.edge, low, high
                )


def _check_component(field: Field, k: int, component: Any, parts: Sequence[_EdgePart]) -> None:
    """A component has the length of its parts, and its shore is a loop, or leads from border to border."""
    claimed = ball_sum([part.curve for shore in (component.shore, *component.hidden) for part in shore])
    with workprec(BITS):
        total = sum((part.high - part.low for part in parts), arb(0))
    if not is_close(claimed, total):
        raise AuditError(
            f"component {k} has {claimed.str(20)} of boundary, the terrain leaves {total.str(20)}"
        )
    curves = [part.curve for part in component.shore]
    for before, after in pairwise(curves):
        if not same(before.end, after.start):
            raise AuditError(f"the shore of component {k} is not in one piece at {place_text(after.start)}")
    if component.closed is not is_close(ball_sum(curves), ball_sum(component.obstacle.edges)):
        raise AuditError(f"component {k} says {component.closed}, but whether it is a loop is not that")
    ends = curves[0].start, curves[-1].end
    if not (same(*ends) if component.closed else all(field.is_on_border(end) for end in ends)):
        raise AuditError(f"the shore of component {k} ends at {place_text(ends[1])}")


def _length_to(edge: Curve, point: Point) -> arb:
    return refined(lambda bits: ball_to(edge, point, bits))


def _parts(field: Field, obstacle: Obstacle) -> Iterator[_EdgePart]:
    """The parts of an obstacle's boundary in the open terrain, cut where they meet lines of the border."""
    for e in field.world.edges_of(obstacle.index):
        edge = field.world.edges[e]
        cuts: list[tuple[arb, Point]] = [(arb(0), edge.start), (ball_sum([edge]), edge.end)]
        for _, _, point in field.border_contacts(e):
            if not any(same(point, other) for _, other in cuts):
                cuts.append((_length_to(edge, point), point))
        cuts.sort(key=cmp_to_key(_order))
        for (low, start), (high, end) in pairwise(cuts):
            with workprec(BITS):
                inside = field.is_well_inside(*_point_after(edge, (low + high) / 2))
            if inside:
                yield _EdgePart(obstacle.index, e, low, high, start, end)


def _order(a: tuple[arb, Point], b: tuple[arb, Point]) -> int:
    return -1 if a[0] < b[0] else int(a[0] > b[0])


def _point_after(edge: Curve, length: arb) -> tuple[arb, arb]:
    """The point after a length of an edge, in balls."""
    x, y = (value.ball(BITS) for value in edge.start)
    if isinstance(edge, Segment):
        dx, dy = (value.ball(BITS) for value in edge.direction)
        share = length / (dx * dx + dy * dy).sqrt()
        return x + dx * share, y + dy * share
    u, v = (value.ball(BITS) for value in edge.center)
    angle = length / arb(edge.radius_sq).sqrt() * (1 if edge.ccw else -1)
    sine, cosine = angle.sin(), angle.cos()
    return u + (x - u) * cosine - (y - v) * sine, v + (x - u) * sine + (y - v) * cosine


def _joined(field: Field, parts: Sequence[_EdgePart]) -> tuple[UnionFind, UnionFind]:
    """Parts by their numbers, and "S": what closed free space joins, and what the obstacles join.

    A boundary that touches the border goes on there; so does the free border on its sides.
    """
    from networkx.utils import UnionFind  # networkx takes long to import

    free, solid = UnionFind(), UnionFind()
    stops = field.stops
    blocked = [field.is_border_blocked(a, b) for a, b in zip(stops, [*stops[1:], stops[0]], strict=True)]
    for k, point in enumerate(stops):
        ends = [n for n, part in enumerate(parts) if same(part.start, point) or same(part.end, point)]
        for classes, kind in ((free, False), (solid, True)):
            beside = [("border", m % len(stops)) for m in (k - 1, k) if blocked[m] is kind]
            classes.union(*beside, *(ends if beside else ()))
    free.union("S", ("border", 0))
    for obstacle in field.world.obstacles:
        mine = [n for n, part in enumerate(parts) if part.obstacle == obstacle.index]
        for n, m in zip(mine, [*mine[1:], *mine[:1]], strict=True):
            if same(parts[n].end, parts[m].start):
                free.union(n, m)
                solid.union(n, m)
        if mine and not any(field.border_contacts(e) for e in field.world.edges_of(obstacle.index)):
            free.union(_west_of(field, parts, obstacle), mine[0])
    return free, solid


def _west_of(field: Field, parts: Sequence[_EdgePart], obstacle: Obstacle) -> Hashable:
    """What lies just west of an obstacle's westernmost point: a part, or an interval of the border."""
    points = [edge.start for edge in obstacle.edges]
    for edge in obstacle.edges:
        if isinstance(edge, Arc):
            west = Point(edge.center.x - edge.radius, edge.center.y)
            points += [west] if edge.contains(west) else []
    point = min(points, key=lambda p: p.x)
    met: list[int] = []
    far: Real = point.x - field.west
    for e, edge in enumerate(field.world.edges):
        for t in line_contacts(point, Point(-1, 0), edge):
            if 0 < t <= far:
                met, far = [*met, e] if t == far else [e], t
    place = Point(point.x - far, point.y)
    if place.x == field.west:
        for k, (a, b) in enumerate(pairwise([*field.stops, field.stops[0]])):
            # At a stop one of the two intervals may be blocked, or both where a bay ends at the border.
            if Segment(a, b).passes(place) and not field.is_border_blocked(a, b):
                return "border", k
    for e in met:
        at = _length_to(field.world.edges[e], place)
        for n, part in enumerate(parts):
            if part.edge == e and not (at < part.low or at > part.high):
                return n
    # The westernmost point of a loop in the terrain is free to its west. The first edge there bounds the free
    # region, so it is the part of some shore; without one the ray ends at a free stretch of the border.
    raise AssertionError("a ray in the terrain ends at a boundary in it, or at the border")
