"""Where obstacles block straight ways and polylines, in the plane or within the border of a terrain.

A point of a way is blocked if its whole neighbourhood within the terrain belongs to an obstacle. So a way
that touches a boundary or runs along it is free, except along the border of the terrain, where one side
counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple, TypeAlias

from exactacq.geometry.box_index import box
from exactacq.geometry.coordinates import advance, dot, minus, raw, sign
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import contacts
from exactacq.geometry.points import Location, Point
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.scene import Obstacle
from exactacq.scene.terrain_components import Component, Ground, sides

Blocker: TypeAlias = "Obstacle | Component"
"""What blocks a way: an obstacle, or a component that a border leaves of one."""


class WayPoint(NamedTuple):
    """A place on a way, its parameter there, 0 at the start and 1 at the end, and all edges that pass it.

    These are edges of the one obstacle that is asked for, by their numbers.
    """

    u: Real
    point: Point
    edges: frozenset[int] = frozenset()


class Gap(NamedTuple):
    """A maximal blocked stretch of a way, without its ends, and what blocks it.

    The component is None if both ends of the stretch are blocked, so that they are the ends of the way.
    """

    obstacle: Obstacle
    component: Blocker | None
    begin: WayPoint
    end: WayPoint


class Crossing(NamedTuple):
    """A crossing point, by its number on a polyline: an end of a blocked stretch.

    ``stop`` is where on straight piece number ``piece`` it lies; ``ends`` is True where the stretch ends.
    """

    number: int
    component: Blocker
    piece: int
    stop: WayPoint
    ends: bool


class Blocking:
    """The blocked stretches of ways through a ground, or, with None, through the plane."""

    def __init__(self, ground: Ground | None, table: EdgeTable) -> None:
        self.ground, self.table = ground, table
        self._sides = [] if ground is None else sides(ground.terrain)

    def gaps(self, way: Segment, end_on: Curve | None = None) -> list[Gap]:
        """The blocked stretches of a way with distinct ends, in its order.

        *end_on* is a piece of boundary on which the way ends, if one is known.
        """
        left, bottom, right, top = box(way)
        near = self.table.near((left, bottom), (right, top), 0.0)
        owners = sorted({self.table.owners[e] for e in near.tolist()})
        found = [gap for k in owners for gap in self._of(way, self.table.obstacles[k], end_on)]
        return sorted(found, key=lambda gap: gap.begin.u)

    def crossings(self, pieces: Sequence[Segment], end_on: Curve | None = None) -> list[Crossing]:
        """All crossing points of a polyline, in its order; it begins at a free point, and may end on a curve.

        A stretch goes on over a corner of the polyline that is itself blocked. One that reaches its end has
        no end.
        """
        found: list[Crossing] = []
        for k, piece in enumerate(pieces):
            for gap in self.gaps(piece, end_on if k == len(pieces) - 1 else None):
                component = gap.component
                if gap.begin.u.rational == 0 and not self.is_free(gap.obstacle, gap.begin):
                    component = found.pop().component
                else:
                    # `_owner` finds none only if both ends are blocked, and this beginning is free.
                    assert component is not None, "a stretch begins at its component"
                    found.append(Crossing(len(found), component, k, gap.begin, False))
                found.append(Crossing(len(found), component, k, gap.end, True))
        if found:
            last = found[-1]
            at_end = last.piece == len(pieces) - 1 and last.stop.u.rational == 1
            if at_end and not self.is_free(_whole(last.component), last.stop):
                found.pop()
        return found

    def _of(self, way: Segment, obstacle: Obstacle, end_on: Curve | None) -> list[Gap]:
        rail = Rail(way)
        all_stops = [WayPoint(Real(0), way.start), WayPoint(Real(1), way.end)]
        for e, edge in enumerate(obstacle.edges):
            for point in _met(way, edge, end_on):
                u = Real(1) if point is way.end else rail.parameter(point)
                all_stops.append(WayPoint(u, point, frozenset((e,))))
        all_stops.sort(key=lambda stop: stop.u)
        stops = all_stops[:1]
        for stop in all_stops[1:]:
            if stops[-1].u.compare(stop.u) < 0:
                stops.append(stop)
            else:
                stops[-1] = stops[-1]._replace(edges=stops[-1].edges | stop.edges)
        found: list[tuple[WayPoint, WayPoint]] = []
        for one, other in pairwise(stops):
            if self._is_blocked(way, obstacle, rail.point(rational_between(one.u, other.u))):
                if found and found[-1][1].u is one.u and not self.is_free(obstacle, one):
                    found[-1] = found[-1][0], other
                else:
                    found.append((one, other))
        return [Gap(obstacle, self._owner(obstacle, begin, end), begin, end) for begin, end in found]

    def _is_blocked(self, way: Segment, obstacle: Obstacle, place: Point) -> bool:
        """Whether a place of a way is blocked that is no contact point."""
        location = obstacle.locate(place)
        if location is not Location.BOUNDARY:
            return location is Location.INSIDE
        side = next((s for s in self._sides if s.passes(way.start) and s.passes(way.end)), None)
        if side is None:
            return False
        edge = next(e for e in obstacle.edges if isinstance(e, Segment) and e.passes(place))
        # Both the terrain and the obstacle lie on the left of their sides.
        return edge.direction.dot(side.direction).sign() > 0

    def is_free(self, obstacle: Obstacle, stop: WayPoint) -> bool:
        """Whether a point of an obstacle is on a component's boundary, so that free points are beside it.

        In the plane the component is the obstacle.
        """
        if self.ground is None:
            return bool(stop.edges)
        return any(c.is_bounded_by(stop.point, stop.edges) for c in self.ground.of(obstacle.index))

    def _owner(self, obstacle: Obstacle, begin: WayPoint, end: WayPoint) -> Blocker | None:
        if self.ground is None:
            return obstacle
        for stop in (begin, end):
            for component in self.ground.of(obstacle.index):
                if component.is_bounded_by(stop.point, stop.edges):
                    return component
        return None


def _met(way: Segment, edge: Curve, end_on: Curve | None) -> list[Point]:
    """The ends of what a way has in common with an edge."""
    if not (isinstance(end_on, Arc) and isinstance(edge, Arc) and _have_one_circle(end_on, edge)):
        return [point for contact in contacts(way, edge) for point in (contact.start, contact.end)]
    # The way ends on the circle. Its parameters there are 1 and, as their sum is rational in the rest, this:
    start, center = raw(way.start), raw(edge.center)
    along, inward = minus(raw(way.end), start), minus(center, raw(way.end))
    lean, size = dot(inward, along), dot(along, along)
    points = [way.end]
    if sign(lean) < 0 and sign(size + 2 * lean) >= 0:
        points.append(advance(start, along, 1 + 2 * lean / size))
    return [point for point in points if edge.contains(point)]


def _have_one_circle(a: Arc, b: Arc) -> bool:
    return a.radius_sq == b.radius_sq and a.center == b.center


def _whole(blocker: Blocker) -> Obstacle:
    return blocker.obstacle if isinstance(blocker, Component) else blocker
