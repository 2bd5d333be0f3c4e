"""The sweep: how the view of a robot changes along one piece of a path, and what it sees between the changes.

What is seen of an edge is bounded by windows: lines through the robot that touch a corner or a convex arc. An
edge is in sight where a part of it with length is seen, or all along where its nearest point is just in
range. A *visual event* is a place where a window begins to touch something else, or where an edge comes into
sight or goes out of it (Hall-Holt, "Kinetic visibility", 2002). Between neighbouring events, in a *cell*, the
view keeps its combinatorial form.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import groupby
from typing import Any

from flint import fmpq

from exactacq.cached import cached_property
from exactacq.errors import InvalidScene, deciding, shown
from exactacq.gc_pause import uncollected
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.late import Pin
from exactacq.geometry.points import Location, Point
from exactacq.kernel.leg_changes import BEGINS, TURNS, AtEnd, Turn
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.scene import Scene, radius_of
from exactacq.scene.validation import place_text
from exactacq.sensing.leg_facts import LegFacts
from exactacq.sensing.leg_sights import LegSights
from exactacq.sensing.leg_views import Shares
from exactacq.sensing.legs import Leg, Place, legs_of
from exactacq.sensing.line_points import Role
from exactacq.sensing.map import Map
from exactacq.sensing.path import Piece
from exactacq.sensing.sensor import Sensor
from exactacq.sensing.straight_way import StraightWay
from exactacq.visibility.free_segment import is_free
from exactacq.visibility.scene_tables import SceneTables, point_flaws
from exactacq.visibility.sensor_range import Range


class Change(Enum):
    """What an event changes for one edge, which is in sight where a part of it with length is seen."""

    REAPPEARANCE = "reappearance"
    """The edge comes into sight from behind something."""
    ENTRY = "entry"
    """It comes into range."""
    OCCLUSION = "occlusion"
    """It goes out of sight behind something."""
    EXIT = "exit"
    """It goes out of range."""
    TURNING = "turning"
    """What bounds the view of it becomes another: a corner, an arc, or the range."""


@dataclass(frozen=True, slots=True)
class SweepEvent:
    """A change of the view of an edge, given as obstacle and number of the edge, at a place of the piece.

    ``leg`` is the number of the leg of the piece: there is a new one where a straight piece touches a corner,
    where an edge that it runs along begins or ends, and where a piece passes the start of a full circle.
    Parameter ``u`` is on the leg's rail (see `exactacq.geometry.curve_parameter`) and may fall on the way.
    Obstacles and edges are numbered as in ``scene.obstacles``, the enclosure last.
    """

    change: Change
    obstacle: int
    edge: int
    leg: int
    u: Real
    place: Point


@dataclass(frozen=True)
class SweepCell:
    """A stretch of the piece without an event inside, from ``begin`` to ``end`` as the robot passes them."""

    leg: int
    begin: Place
    end: Place
    swept: SweptLeg
    scene: Scene

    @property
    def low(self) -> Real:
        """The lesser parameter."""
        return self.begin[0] if self.swept.leg.ahead else self.end[0]

    @property
    def high(self) -> Real:
        """The greater parameter."""
        return self.end[0] if self.swept.leg.ahead else self.begin[0]

    @property
    def rail(self) -> Rail:
        """What the parameters belong to."""
        return self.swept.leg.rail

    def point(self, u: object) -> Point:
        """The place at a rational parameter."""
        return self.rail.point(rational(u))

    @cached_property
    def map(self) -> Map:
        """The map of a robot that has walked this cell only: all that is seen from it, its ends included."""
        shares, leg = self.swept.shares, self.swept.leg
        for u, place in (self.begin, self.end):
            self.swept.facts.tell(u, place)
        part = leg.between(self.begin, self.end)
        rails = shares.complex.clipper.rails
        return Map(self.scene.obstacles, shares.targets, rails, shares.cut(part).taught({}))

    def windows(self, u: object) -> list[tuple[Point, Point | None]]:
        """The windows of the view at a rational parameter: the touched point, and the point seen beyond it.

        The latter is None if it is out of range. A view along the robot's own line is no window here. What is
        seen along it may go out of range without an event.
        """
        touched: list[Point] = []
        found: list[tuple[Point, Point | None]] = []
        for share in self.swept.sights.bounding(Real(rational(u)), self.point(u)):
            free_views = share.family.free_views
            assert free_views is not None, "what bounds a view touches something"
            near, seen = free_views.sector.touch(share.family.first.t)[0], share.shown.start
            if free_views.sides[1 - share.side].role is Role.CONTACT:
                touched.append(near)
            elif (near, seen) not in found:
                found.append((near, seen))
        past = [near for near, _ in found]
        return [*found, *((near, None) for near in _distinct(touched) if near not in past)]


class SweptLeg:
    """The views along one leg: where they change, and all that they show, each made when it is asked for."""

    def __init__(self, sensor: Sensor, leg: Leg) -> None:
        self.leg, self._sensor = leg, sensor

    @cached_property
    def _way(self) -> StraightWay | None:
        """A straight leg as a way: where named lines cross it there is one point, whoever asks."""
        return StraightWay(self._sensor.complex, self.leg) if self.leg.edge is None else None

    @cached_property
    def sights(self) -> LegSights:
        """From where edges are seen."""
        return self._sensor.sights(self.leg, self._way)

    @cached_property
    def shares(self) -> Shares:
        """All that the leg shows."""
        return self._sensor.shares(self.leg, self._way)

    @cached_property
    def facts(self) -> LegFacts:
        """What is known of the views from the places of events."""
        return LegFacts(self.shares)

    def events(self, number: int) -> Iterator[SweepEvent]:
        """The events inside the leg of that number; those of one place by edge."""
        sights, leg = self.sights, self.leg
        places: dict[int, Pin] = {}
        step = 1 if leg.ahead else -1
        for turn in sorted(sights.turns, key=lambda turn: (step * turn.rank, turn.edge)):
            if turn.rank not in places:
                places[turn.rank] = sights.place(turn.end)
            place, u = places[turn.rank]
            change = Change.TURNING
            if turn.kind != TURNS:
                change = self._change(turn, comes=(turn.kind == BEGINS) == leg.ahead)
            yield self._event(change, turn.edge, number, u, place)

    def events_at_start(self, before: SweptLeg, number: int) -> Iterator[SweepEvent]:
        """The events where the leg of that number begins, after another one."""
        gone, here, own = before.sights.at_end(True), self.sights.at_end(False), self.leg.edge
        for edge in sorted({*gone, *here}):
            if edge not in here:
                change = before._change(gone[edge], comes=False)
            elif edge not in gone:
                change = self._change(here[edge], comes=True)
            elif gone[edge].names != here[edge].names and edge not in (own, before.leg.edge):
                change = Change.TURNING
            else:
                continue
            yield self._event(change, edge, number, self.leg.first, self.leg.start)

    def _event(self, change: Change, edge: int, number: int, u: Real, place: Point) -> SweepEvent:
        table = self._sensor.table
        owner = table.owners[edge]
        return SweepEvent(change, owner, edge - table.edges_of(owner).start, number, u, place)

    def _change(self, seen: Turn | AtEnd, comes: bool) -> Change:
        if self.sights.is_near(seen):
            return Change.REAPPEARANCE if comes else Change.OCCLUSION
        return Change.ENTRY if comes else Change.EXIT


class Sweep:
    """The views along a piece of a path: ``events`` in the robot's order, and the ``cells`` between them."""

    def __init__(self, scene: Scene, piece: Piece, sensor: Sensor) -> None:
        self.scene = scene
        self._made_of = piece, sensor.range.radius
        legs = legs_of(sensor.table, sensor.rails, piece.obstacle, piece.curve)
        self._legs = [SweptLeg(sensor, leg) for leg in legs]

    def __reduce__(self) -> tuple[Any, ...]:
        """Without the sensing, which is repeated: it knows places by identity."""
        return _again, (self.scene, *self._made_of)

    def __repr__(self) -> str:
        piece, radius = self._made_of
        return f"<Sweep from {piece.start} to {piece.end} within {radius}>"

    @cached_property
    @uncollected()
    def events(self) -> tuple[SweepEvent, ...]:
        """All events inside the piece; those of one place by edge."""
        found: list[SweepEvent] = []
        piece, _ = self._made_of
        with deciding("where the view changes on the way from {} to {}", piece.start, piece.end):
            for k, swept in enumerate(self._legs):
                if k:
                    found += swept.events_at_start(self._legs[k - 1], k)
                found += swept.events(k)
        return tuple(found)

    @cached_property
    def cells(self) -> tuple[SweepCell, ...]:
        """The stretches between events; at least one for each leg."""
        on = {k: [*events] for k, events in groupby(self.events, lambda event: event.leg)}
        return tuple(cell for k in range(len(self._legs)) for cell in self._cells(k, on.get(k, [])))

    def _cells(self, k: int, events: list[SweepEvent]) -> Iterator[SweepCell]:
        """The cells of the leg of that number, from its events."""
        swept, leg = self._legs[k], self._legs[k].leg
        begin: Place = leg.first, leg.start
        for event in events:
            if event.u is not begin[0]:
                yield SweepCell(k, begin, (event.u, event.place), swept, self.scene)
                begin = event.u, event.place
        yield SweepCell(k, begin, (leg.last, leg.end), swept, self.scene)


def sweep(scene: Scene, curve: Curve, radius: object = None, *, obstacle: int | None = None) -> Sweep:
    """How the view within a radius (the scene's own if None) changes along a curve.

    The curve is a free segment, or part of one boundary edge of the obstacle of that number. Raises
    `InvalidScene` if the radius is missing or not positive, or the segment leads through an obstacle, and
    ValueError if the curve has no length or is no part of the boundary, or there is no such obstacle. Cost:
    near linear in the free lines within reach that touch two corners or arcs.

    >>> import exactacq as xa
    >>> scene = xa.Scene([xa.Polygon([(2, -1), (3, -1), (3, 1), (2, 1)])])
    >>> swept = sweep(scene, xa.Segment(xa.Point(0, 2), xa.Point(4, 2)), radius=5)
    >>> [(event.change.value, event.edge, str(event.place)) for event in swept.events[1:3]]
    [('occlusion', 3, '(2, 2)'), ('reappearance', 1, '(3, 2)')]
    """
    if not isinstance(curve, Segment | Arc):
        raise TypeError(f"a sweep goes along a Segment or an Arc, not {shown(curve)}")
    reach = radius_of(scene, radius, curve.start)
    if obstacle is None and not isinstance(curve, Segment):
        raise ValueError("free space is crossed on straight lines: an arc needs its obstacle's number")
    if obstacle is not None and not 0 <= obstacle < len(scene.obstacles):
        raise ValueError(f"there is no obstacle number {obstacle}: the scene has {len(scene.obstacles)}")
    if isinstance(curve, Segment) and curve.start == curve.end:
        raise ValueError(f"a segment without length, at {curve.start}, is no piece of a path")
    kind = "straight" if obstacle is None else "boundary"
    if obstacle is None:
        _check_free(scene, curve)
    return _again(scene, Piece(kind, obstacle, curve), reach)


def _check_free(scene: Scene, way: Curve) -> None:
    """`InvalidScene` for a segment that begins, ends or leads through an obstacle."""
    tables = SceneTables.of(scene)
    ends = [flaw for end in (way.start, way.end) for flaw in point_flaws("end", end, tables.around(end))]
    if ends:
        raise InvalidScene(ends)
    middle = tables.around(way.point(fmpq(1, 2)))
    if any(at is Location.INSIDE for at, _ in middle) or not is_free(tables.edges, way.start, way.end):
        between = f"from {place_text(way.start)} to {place_text(way.end)}"
        raise InvalidScene([f"the segment {between} leads through an obstacle"])


def _again(scene: Scene, piece: Piece, radius: fmpq) -> Sweep:
    """The sweep of a piece, with a sensor of its own."""
    return Sweep(scene, piece, Sensor(EdgeTable(scene.obstacles), Range(radius)))


def _distinct(points: list[Point]) -> list[Point]:
    return [p for k, p in enumerate(points) if p not in points[:k]]
