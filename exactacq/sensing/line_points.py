"""The exact points in which lines of a sector meet edges: what views begin and end with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import TypeGuard

from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.late import Balls, balls, from_to
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.visibility.chords import meet
from exactacq.visibility.line_balls import Line
from exactacq.visibility.line_families import Sector, Spokes
from exactacq.visibility.rotational_sweep import Passed

BITS = 128
"""Precision of the balls that tell a short way from a long proof."""


class Role(IntEnum):
    """Where on a line one end of a view lies."""

    BEHIND = -1
    CONTACT = 0
    AHEAD = 1


@dataclass(slots=True)
class Side:
    """One end of a family of views: the edge it runs on and its role on the lines.

    A ``fixed`` end stays at the contact: a corner, the start of its edge or, if ``at_end``, its end. On a
    full circle, where parameters jump at the start, ``start`` is what they are there, 0 or 4, for these views
    if it is known that none passes the start. The end may be ``on_way``, not on a boundary.
    """

    edge: int
    role: Role
    fixed: bool = False
    at_end: bool = False
    start: int | None = None
    on_way: bool = False

    def corner(self, curve: Curve) -> Point:
        """Where a fixed end stays, on the curve of its edge."""
        return curve.end if self.at_end else curve.start


class LinePoints:
    """Where lines meet edges, which are known by their rails."""

    def __init__(self, rails: Sequence[Rail]) -> None:
        self._rails = rails

    def exact(self, sector: Sector, t: Real, side: Side, passed: Passed) -> Point:
        """Where the line at a parameter meets an edge, by what it passes there."""
        contact, direction = sector.touch(t)
        point = self._passed(side, contact, direction, passed)
        return self.at(sector, side, contact, direction) if point is None else point

    def _passed(self, side: Side, contact: Point, direction: Point, passed: Passed) -> Point | None:
        """Where a line meets an edge, if that is an event of the line: no root is to be proved 0 or equal."""
        if side.role is Role.CONTACT:
            return None
        curve = self._rails[side.edge].curve
        for number, touching, _ in passed:
            if touching and number == side.edge and isinstance(curve, Arc):
                foot: Real = (curve.center - contact).dot(direction) / direction.norm_sq()
                return contact + direction * foot
            vertex = self._rails[number].curve.start
            for end in (curve.start, curve.end):
                if not touching and _is_same(end, vertex) and _is_met(direction, curve, end, side.role):
                    return end
        return None

    def passed_in_balls(self, side: Side, at: Line, passed: Passed) -> tuple[bool, Point | Balls | None]:
        """Where a line in balls meets an edge, if that is an event of the line: a corner, or balls around it.

        None if it is no event; before it whether balls tell.
        """
        if side.role is Role.CONTACT:
            return True, None
        x, y, dx, dy = at
        curve = self._rails[side.edge].curve
        for number, touching, _ in passed:
            if touching and number == side.edge and isinstance(curve, Arc):
                cx, cy = balls(curve.center)
                foot = ((cx - x) * dx + (cy - y) * dy) / (dx * dx + dy * dy)
                return True, (x + dx * foot, y + dy * foot)
            vertex = self._rails[number].curve.start
            for end in (curve.start, curve.end):
                if not touching and _is_same(end, vertex):
                    sense = _sense((dx, dy), curve, end)
                    if not sense:
                        return False, None
                    if isinstance(curve, Segment) or sense == (-side.role if curve.ccw else side.role):
                        return True, end
        return True, None

    def at(self, sector: Sector, side: Side, contact: Point, direction: Point) -> Point:
        """Where a line, given by its contact and direction, meets an edge."""
        curve = self._rails[side.edge].curve
        if side.role is Role.CONTACT:
            return side.corner(curve) if side.fixed else contact
        center = _met_in_center(sector, curve, direction, side.role)
        if center is not None:
            return center
        try:
            if isinstance(curve, Segment) and curve.start.rational is not None:
                # Linear in one number, and with an edge's own abscissa if that is vertical: ties show.
                share = direction.cross(contact - curve.start) / direction.cross(curve.direction)
                return curve.start + curve.direction * share
            straight = isinstance(curve, Segment)
            start, along = _in_one_form(contact, direction) if straight else (contact, direction)
            return start + along * meet(start, along, curve, side.role)
        except ZeroDivisionError:
            # A line along the edge: where the others meet the edge has a limit. Normals of an arc all pass
            # through its centre. A tangent meets another one half way, by angle, between the two contacts.
            return Point(*sector.center) if isinstance(sector, Spokes) else contact


def _is_same(end: Point, vertex: Point) -> bool:
    """Whether an end of an edge is a vertex: mostly it is the very object, or floats differ."""
    return end is vertex or (end.xy == vertex.xy and end.rational == vertex.rational)


def _in_one_form(contact: Point, direction: Point) -> tuple[Point, Point]:
    """A rational line by one point and one direction, however it was found; another line as it is.

    A corner and an arc that ends there have a tangent in common. Where it meets a way with irrational numbers
    both find one number in one form then, and nobody has to prove that two are equal.
    """
    at, along = contact.rational, direction.rational
    if at is None or along is None:
        return contact, direction
    (x, y), (dx, dy) = at, along
    return (Point(x, 0), Point(0, 1)) if dx == 0 else (Point(0, y - x * dy / dx), Point(1, dy / dx))


def along_normal(
    sector: Sector, role: Role, near: Curve, far: Curve, point: Point, direction: Point
) -> Point | None:
    """Where a normal of an arc that passes a point of a curve meets an arc with the same centre, if it does.

    Of concentric arcs each has the normals of the other. So that both tell of the same point, it is made
    from the given one: c + (p - c) r / |p - c|, or on the other side of the centre.
    """
    if not isinstance(sector, Spokes) or not _is_about(far, sector):
        return None
    offset = point - far.center
    ahead = offset.dot(direction).clear_sign(BITS)
    if not ahead:
        return None
    size = near.radius if _is_about(near, sector) else offset.norm_sq().sqrt()
    side = -role if far.ccw else int(role)
    if role is Role.CONTACT:
        side = 1 if sector.outward else -1
    return far.center + offset * (far.radius / size * (ahead * side))


def _is_about(curve: Curve, sector: Sector) -> TypeGuard[Arc]:
    """Whether a curve is an arc about the centre of a sector."""
    return isinstance(curve, Arc) and curve.center.rational == sector.center


def _met_in_center(sector: Sector, curve: Curve, direction: Point, role: Role) -> Point | None:
    """The centre of an arc, if that is where a normal of the arc meets an edge: then all of them do."""
    if not isinstance(sector, Spokes):
        return None
    center = Point(*sector.center)
    if not curve.may_pass(center, BITS) or not curve.passes(center):
        return None
    ends = (end for end in (curve.start, curve.end) if end == center)
    return next(ends, center) if _is_met(direction, curve, center, role) else None


def _is_met(direction: Point, curve: Curve, end: Point, role: Role) -> bool:
    """Whether balls tell that a line through a point of an edge, perhaps an end, enters its obstacle."""
    if isinstance(curve, Segment):
        return direction.cross(curve.direction).clear_sign(BITS) != 0
    far = -role if curve.ccw else role
    return (end - curve.center).dot(direction).clear_sign(BITS) == far


def _sense(direction: Balls, curve: Curve, end: Point) -> int:
    """1 or -1 as a line through a point of an edge goes left or right of it, or out of an arc's circle or in.

    0 if balls do not tell.
    """
    if isinstance(curve, Segment):
        (dx, dy), (wx, wy) = direction, from_to(balls(curve.start), balls(curve.end))
        return ball_sign(dx * wy - dy * wx)
    (dx, dy), (ox, oy) = direction, from_to(balls(curve.center), balls(end))
    return ball_sign(ox * dx + oy * dy)
