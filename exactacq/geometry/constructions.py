"""What is known of a point because of how it was made, where its numbers would take long to tell.

A robot may stand on an arc where it saw the last of it past another arc, from a place that it found in the
same way: its coordinates have a high degree. That the place lies on the first arc, and that the way to it
touches the second one, is known when it is made.

These facts belong to one object; an equal point that was made otherwise has others. Where a fact is missing
arithmetic decides. Points that others hand over have none, nor have those that the audit makes.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

from flint import fmpq

from exactacq.geometry.coordinates import cross, dot
from exactacq.geometry.late import balls, from_to, may_be_one
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import ball_sign


class Carrier(NamedTuple):
    """A circle whose centre and squared radius are rational."""

    x: fmpq
    y: fmpq
    square: fmpq


class _CircleAbout(NamedTuple):
    """The circle of a squared radius about a point, whatever its numbers are."""

    center: Point
    square: fmpq


class _CircleTangent(NamedTuple):
    """The line from a point that touches a circle, and where it does if that was made."""

    origin: Point
    carrier: Carrier
    touch: Point | None


class _CircleNormal(NamedTuple):
    """The line from a point through the centre of a circle."""

    origin: Point
    carrier: Carrier


class _CornerLine(NamedTuple):
    """The line from a point through another one, most often a corner."""

    origin: Point
    corner: Point


_Line: TypeAlias = "_CircleTangent | _CircleNormal | _CornerLine"
_Fact: TypeAlias = "Carrier | _CircleAbout | _Line"


def put_on(point: Point, carrier: Carrier | None) -> None:
    """Note that a point was made on a circle; nothing if that is not rational."""
    if carrier is not None and not is_put_on(point, carrier):
        _put(point, carrier)


def is_put_on(point: Point, carrier: Carrier | None) -> bool:
    """Whether a point was made on a circle; of one that was not, nothing is known."""
    return any(isinstance(fact, Carrier) and fact == carrier for fact in _facts(point))


def put_around(point: Point, center: Point, square: fmpq) -> None:
    """Note that a point was made at a squared distance from another one."""
    if not _is_around(point, center, square):
        _put(point, _CircleAbout(center, square))


def is_put_around(point: Point, other: Point, square: fmpq) -> bool:
    """Whether one of two points was made at a squared distance from the other."""
    return _is_around(point, other, square) or _is_around(other, point, square)


def _is_around(point: Point, center: Point, square: fmpq) -> bool:
    found = (fact for fact in _facts(point) if isinstance(fact, _CircleAbout) and fact.square == square)
    return any(_is_one(fact.center, center) for fact in found)


# -- lines through two points ----------------------------------------------------------------------
#
# What is known of the line of two points was noted at one of them, as that was made on a line from another
# point, its origin. The other one is that origin, or a place that the line was made through: the very object,
# or an equal rational point. Of several forms of a fact the first counts.


def put_on_tangent(point: Point, origin: Point, carrier: Carrier | None, touch: Point | None = None) -> None:
    """Note that a point was made on the line from another one that touches a circle, in *touch* if given.

    That one may have been made itself on the line from a corner that touches the circle: if both touch it on
    one side, they are one line.
    """
    if carrier is None or _tangent(origin, point, carrier) is not None:
        return
    _put(point, _CircleTangent(origin, carrier, touch))
    for fact in _facts(origin):
        if isinstance(fact, _CircleTangent) and fact.carrier == carrier:
            side = tangent_side(origin, point, carrier)
            if side and side == tangent_side(origin, fact.origin, carrier):
                put_past_corner(point, origin, fact.origin)


def tangent_side(origin: Point, point: Point, carrier: Carrier | None) -> int:
    """1 or -1 as the circle that a line through two points touches lies to its left or right; 0 if unsure.

    The line is taken from the first point towards the circle, wherever the second one lies on it.
    """
    if carrier is None:
        return 0
    center = Point(carrier.x, carrier.y)
    w, v = from_to(balls(origin), balls(center)), from_to(balls(origin), balls(point))
    return ball_sign(cross(v, w)) * ball_sign(dot(v, w))


def is_tangent(start: Point, end: Point, carrier: Carrier | None) -> bool:
    """Whether the line of two points is known to touch a circle."""
    return _tangent(start, end, carrier) is not None


def circles_touched(start: Point, end: Point) -> list[Carrier]:
    """The circles that the line of two points is known to touch."""
    return [line.carrier for line in _lines(start, end) if isinstance(line, _CircleTangent)]


def touch_on_tangent(start: Point, end: Point, carrier: Carrier | None) -> Point | None:
    """Where the line of two points that is known to touch a circle does so, if that was made."""
    fact = _tangent(start, end, carrier)
    if fact is None or fact.touch is not None:
        return None if fact is None else fact.touch
    # A line that touches a circle meets it once.
    return next((point for point in (end, start) if is_put_on(point, carrier)), None)


def put_on_normal(point: Point, origin: Point, carrier: Carrier | None) -> None:
    """Note that a point was made on the line from another one through the centre of a circle."""
    if carrier is not None and not is_normal(origin, point, carrier):
        _put(point, _CircleNormal(origin, carrier))


def is_normal(start: Point, end: Point, carrier: Carrier | None) -> bool:
    """Whether the line of two points is known to pass the centre of a circle."""
    return any(isinstance(line, _CircleNormal) and line.carrier == carrier for line in _lines(start, end))


def put_past_corner(point: Point, origin: Point, corner: Point) -> None:
    """Note that a point was made on the line from another one through a corner, which it may be itself."""
    if corner is not point and not is_past_corner(origin, point, corner):
        _put(point, _CornerLine(origin, corner))


def is_past_corner(start: Point, end: Point, corner: Point) -> bool:
    """Whether the line of two points is known to pass a corner; *corner* is rational."""
    return any(_is_one(corner, other) for other in corners_passed(start, end))


def corners_passed(start: Point, end: Point) -> list[Point]:
    """The corners, as objects, that the line of two points is known to pass."""
    return [line.corner for line in _lines(start, end) if isinstance(line, _CornerLine)]


def _is_one(point: Point, other: Point) -> bool:
    """Whether two points are one object, or seen to be one rational point: nothing late is made."""
    if point is other:
        return True
    return not (point.is_late or other.is_late) and None is not point.rational == other.rational


def put_on_line(point: Point, start: Point, end: Point) -> None:
    """Note that a point was made on the line of two others: what is known of this line it takes over."""
    if point is start or point is end:
        return
    put_past_corner(point, start, end)
    for line in _lines(start, end):
        match line:
            case _CircleTangent(_, carrier, _):
                put_on_tangent(point, start, carrier, touch_on_tangent(start, end, carrier))
            case _CircleNormal(_, carrier):
                put_on_normal(point, start, carrier)
            case _CornerLine(_, corner):
                put_past_corner(point, start, corner)


def _tangent(start: Point, end: Point, carrier: Carrier | None) -> _CircleTangent | None:
    lines = (line for line in _lines(start, end) if isinstance(line, _CircleTangent))
    return next((line for line in lines if line.carrier == carrier), None)


def _lines(start: Point, end: Point) -> Iterator[_Line]:
    """What is known of the line of two points: by lines through one of them on which the other one lies."""
    for point, other in ((end, start), (start, end)):
        by_origin: dict[int, list[_Line]] = {}
        for fact in _facts(point):
            if isinstance(fact, _CircleTangent | _CircleNormal | _CornerLine):
                by_origin.setdefault(id(fact.origin), []).append(fact)
        for lines in by_origin.values():
            is_origin = _is_one(lines[0].origin, other)
            if is_origin or any(_is_one(place, other) for line in lines for place in _places(line)[1:]):
                yield from lines


def _places(line: _Line) -> tuple[Point, ...]:
    """The points, besides that which knows it, that a line was made through."""
    match line:
        case _CircleTangent(origin, _, touch) if touch is not None:
            return origin, touch
        case _CornerLine(origin, corner):
            return origin, corner
    return (line.origin,)


def put_equal(point: Point, other: Point) -> None:
    """Note that two points are equal: each takes over what is known of the other.

    Nothing is noted of rational points: their numbers tell, and corners outlive what is known of places.
    """
    if _facts(point) is _facts(other):
        return
    if any(not one.is_late and one.rational is not None for one in (point, other)):
        return
    for fact in _facts(other):
        match fact:
            case Carrier():
                put_on(point, fact)
            case _CircleAbout(center, square):
                put_around(point, center, square)
            case _CircleTangent(origin, carrier, touch):
                put_on_tangent(point, origin, carrier, touch)
            case _CircleNormal(origin, carrier):
                put_on_normal(point, origin, carrier)
            case _CornerLine(origin, corner):
                put_past_corner(point, origin, corner)
    other._facts = _facts(point)


def _put(point: Point, fact: _Fact) -> None:
    # Through two points that are one there are many lines: none is noted.
    origin = None if isinstance(fact, Carrier | _CircleAbout) else fact.origin
    if origin is None or not may_be_one(balls(point), balls(origin)):
        point._facts = (*_facts(point), fact)


def _facts(point: Point) -> tuple[_Fact, ...]:
    return getattr(point, "_facts", ())
