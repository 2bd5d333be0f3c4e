"""The sweep: how the view of a robot changes along one piece of a path, and what it sees between the changes.

What is seen of an edge is bounded by windows: lines through the robot that touch a corner or a convex arc. A
*visual event* is a place where a window begins to touch something else, or where an edge comes into sight or
goes out of it (Hall-Holt, "Kinetic visibility", 2002). Between neighbouring events, in a *cell*, the view
keeps its combinatorial form.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from operator import attrgetter
from typing import Any, TypeAlias

from flint import fmpq

from exactacq.geometry.coordinates import dot
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.scene import Scene, radius_of
from exactacq.sensing.leg_views import Share, Shares
from exactacq.sensing.legs import legs_of
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.map import Map
from exactacq.sensing.path import Piece
from exactacq.sensing.sensor import Sensor
from exactacq.visibility.line_families import Sector
from exactacq.visibility.sensor_range import Range

Place: TypeAlias = "tuple[Real, Point]"
"""A place of a leg: its parameter on the rail, and the point."""


class Change(Enum):
    """What an event changes for one edge."""

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

    ``u`` is the parameter on the piece's rail (see `exactacq.geometry.curve_parameter`); ``leg`` is 1 once
    the start of a full circle was passed, else 0.
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
    shares: Shares
    scene: Scene

    @property
    def low(self) -> Real:
        """The lesser parameter."""
        return self.begin[0] if self.shares.leg.ahead else self.end[0]

    @property
    def high(self) -> Real:
        """The greater parameter."""
        return self.end[0] if self.shares.leg.ahead else self.begin[0]

    def point(self, u: fmpq) -> Point:
        """The place at a rational parameter."""
        return self.shares.leg.rail.point(u)

    @cached_property
    def map(self) -> Map:
        """The map of a robot that has walked this cell only: all that is seen from some place of it."""
        part = self.shares.leg.between(self.begin, self.end)
        rails = self.shares.complex.clipper.rails
        return Map(self.scene.obstacles, self.shares.targets, rails, self.shares.cut(part).taught({}))

    def windows(self, u: fmpq) -> list[tuple[Point, Point | None]]:
        """The windows of the view at a rational parameter: the touched point, and the point seen beyond it.

        The latter is None if it is out of range. A view along the robot's own line is no window here.
        """
        at, place = Real(u), self.point(u)
        cut = [self.shares.at(share, at, place) for share in _bounds(self.shares)]
        touched: list[Point] = []
        found: list[tuple[Point, Point | None]] = []
        for share in cut:
            if share is None:
                continue
            near, seen = _sector(share).touch(share.family.first.t)[0], share.shown.start
            if _shown(share).role is Role.CONTACT:
                touched.append(near)
            elif (near, seen) not in found:
                found.append((near, seen))
        past = [near for near, _ in found]
        return [*found, *((near, None) for near in _distinct(touched) if near not in past)]


class Sweep:
    """The views along a piece of a path: ``events`` in the robot's order, and the ``cells`` between them."""

    def __init__(self, scene: Scene, piece: Piece, sensor: Sensor) -> None:
        self.scene = scene
        self._made_of = piece, sensor.range.radius
        legs = legs_of(sensor.table, sensor.rails, piece.obstacle, piece.curve)
        self._shares = [sensor.shares(leg) for leg in legs]

    def __reduce__(self) -> tuple[Any, ...]:
        """Without the sensing, which is repeated: it knows places by identity."""
        return _again, (self.scene, *self._made_of)

    def __repr__(self) -> str:
        piece, radius = self._made_of
        return f"<Sweep from {piece.start} to {piece.end} within {radius}>"

    @cached_property
    def events(self) -> tuple[SweepEvent, ...]:
        """All events inside the piece; those of one place by edge."""
        return tuple(event for k, shares in enumerate(self._shares) for event in _events(k, shares))

    @cached_property
    def cells(self) -> tuple[SweepCell, ...]:
        """The stretches between events; at least one for each leg."""
        return tuple(cell for k in range(len(self._shares)) for cell in self._cells(k))

    def _cells(self, k: int) -> Iterator[SweepCell]:
        shares = self._shares[k]
        leg = shares.leg
        begin: Place = leg.first, leg.start
        for event in self.events:
            if event.leg == k and leg.order(begin[0], event.u) < 0:
                yield SweepCell(k, begin, (event.u, event.place), shares, self.scene)
                begin = event.u, event.place
        yield SweepCell(k, begin, (leg.last, leg.end), shares, self.scene)


def sweep(scene: Scene, curve: Curve, radius: object = None, *, obstacle: int | None = None) -> Sweep:
    """How the view within a radius (the scene's own if None) changes along a curve.

    The curve is a free segment, or part of one boundary edge of the obstacle of that number. That a segment
    is free is not checked. Raises `InvalidScene` if the radius is missing or not positive, and ValueError if
    the curve is no part of the boundary. Cost: near linear in the free lines within reach that touch two
    corners or arcs.

    >>> import exactacq as xa
    >>> scene = xa.Scene([xa.Polygon([(2, -1), (3, -1), (3, 1), (2, 1)])])
    >>> swept = sweep(scene, xa.Segment(xa.Point(0, 2), xa.Point(4, 2)), radius=5)
    >>> [(event.change.value, event.edge, str(event.place)) for event in swept.events[::2]]
    [('occlusion', 0, '(2, 2)'), ('reappearance', 1, '(3, 2)')]
    """
    reach = radius_of(scene, radius, curve.start)
    if obstacle is None and not isinstance(curve, Segment):
        raise ValueError("free space is crossed on straight lines: an arc needs its obstacle's number")
    kind = "straight" if obstacle is None else "boundary"
    return _again(scene, Piece(kind, obstacle, curve), reach)


def _again(scene: Scene, piece: Piece, radius: fmpq) -> Sweep:
    """The sweep of a piece, with a sensor of its own."""
    return Sweep(scene, piece, Sensor(EdgeTable(scene.obstacles), Range(radius)))


def _events(number: int, shares: Shares) -> list[SweepEvent]:
    found: dict[int, list[tuple[Real, Point, Change]]] = {}
    for e in dict.fromkeys(share.edge for k in shares.of for share in shares.of[k]):
        found[e] = [*_sightings(shares, e)]
    for u, place, e in _turnings(shares):
        if all(u.compare(other) != 0 for other, _, _ in found[e]):
            found[e].append((u, place, Change.TURNING))
    table, leg = shares.complex.table, shares.leg
    events: list[SweepEvent] = [
        SweepEvent(change, table.owners[e], e - table.edges_of(table.owners[e]).start, number, u, place)
        for e in sorted(found)
        for u, place, change in found[e]
    ]
    return sorted(events, key=attrgetter("u"), reverse=not leg.ahead)


def _sightings(shares: Shares, e: int) -> Iterator[tuple[Real, Point, Change]]:
    """When an edge comes into sight and goes out of it, inside the leg."""
    leg, owner = shares.leg, shares.complex.table.owners[e]
    for interval in shares.times(owner, e).intervals:
        ends = [(interval.low, interval.start), (interval.high, interval.end)]
        for k, (u, place) in enumerate(ends):
            if leg.order(u, leg.first) > 0 and leg.order(u, leg.last) < 0:
                short = shares.is_short(owner, u, e)
                if (k == 0) == leg.ahead:
                    yield u, place, Change.REAPPEARANCE if short else Change.ENTRY
                else:
                    yield u, place, Change.OCCLUSION if short else Change.EXIT


def _turnings(shares: Shares) -> Iterator[tuple[Real, Point, int]]:
    """Where windows on an edge begin and end, unless one goes over into another of the same feature."""
    leg = shares.leg
    ends: list[tuple[Real, Point, int, Hashable, int]] = []
    for share in _bounds(shares):
        name, i = _feature(share), share.source
        ends.append((i.low, i.start, share.edge, name, 1))
        ends.append((i.high, i.end, share.edge, name, -1))
    ends = [end for end in ends if leg.order(end[0], leg.first) > 0 and leg.order(end[0], leg.last) < 0]
    ends.sort(key=lambda end: end[0])
    k = 0
    while k < len(ends):
        u, place = ends[k][:2]
        balance: Counter[tuple[int, Hashable]] = Counter()
        while k < len(ends) and ends[k][0].compare(u) == 0:
            _, _, e, name, step = ends[k]
            balance[e, name] += step
            k += 1
        for e in sorted({e for (e, _), count in balance.items() if count}):
            yield u, place, e


def _bounds(shares: Shares) -> Iterator[Share]:
    """The families that bound what is seen, over more than one place of the leg."""
    for found in shares.of.values():
        for share in found:
            free_views, i = share.family.free_views, share.source
            if free_views is not None and free_views.anchor is not None and i.low.compare(i.high) < 0:
                yield share


def _feature(share: Share) -> Hashable:
    """What tells the windows of a feature on one edge from those of another."""
    sector = _sector(share)
    size = dot(sector.base, sector.base) if sector.round else None
    return _shown(share).role, *sector.center, size


def _sector(share: Share) -> Sector:
    assert share.family.free_views is not None
    return share.family.free_views.sector


def _shown(share: Share) -> Side:
    assert share.family.free_views is not None
    return share.family.free_views.sides[1 - share.side]


def _distinct(points: list[Point]) -> list[Point]:
    return [p for k, p in enumerate(points) if p not in points[:k]]
