"""What is known of a point because of how it was made, where its numbers would take long to tell.

A robot may stand on an arc where it saw the last of it past another arc, from a place that it found in the
same way: its coordinates have a high degree. That the place lies on the first arc, and that the way to it
touches the second one, is known when it is made.

These facts belong to one object; an equal point that was made otherwise has others. Where a fact is missing
arithmetic decides. Points that others hand over have none, nor have those that the audit makes.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from flint import fmpq

from exactacq.geometry.points import Point


class Carrier(NamedTuple):
    """A circle whose centre and squared radius are rational."""

    x: fmpq
    y: fmpq
    square: fmpq


class _CircleAbout(NamedTuple):
    """The circle of a squared radius about a point, whatever its numbers are."""

    center: Point
    square: fmpq


class _FromOrigin(NamedTuple):
    """The line from a point that touches a circle, and where it does if that was made."""

    origin: Point
    carrier: Carrier
    touch: Point | None


_Fact: TypeAlias = "Carrier | _CircleAbout | _FromOrigin"


def put_on(point: Point, carrier: Carrier | None) -> None:
    """Note that a point was made on a circle; nothing if that is not rational."""
    if carrier is not None and not is_put_on(point, carrier):
        point._facts = (*_facts(point), carrier)


def is_put_on(point: Point, carrier: Carrier | None) -> bool:
    """Whether a point was made on a circle; of one that was not, nothing is known."""
    return any(isinstance(fact, Carrier) and fact == carrier for fact in _facts(point))


def put_around(point: Point, center: Point, square: fmpq) -> None:
    """Note that a point was made at a squared distance from another one."""
    if not _is_around(point, center, square):
        point._facts = (*_facts(point), _CircleAbout(center, square))


def is_put_around(point: Point, other: Point, square: fmpq) -> bool:
    """Whether one of two points was made at a squared distance from the other, that very object."""
    return _is_around(point, other, square) or _is_around(other, point, square)


def _is_around(point: Point, center: Point, square: fmpq) -> bool:
    found = (fact for fact in _facts(point) if isinstance(fact, _CircleAbout) and fact.center is center)
    return any(fact.square == square for fact in found)


def put_on_tangent(point: Point, origin: Point, carrier: Carrier | None, touch: Point | None = None) -> None:
    """Note that a point was made on the line from another one that touches a circle, in *touch* if given."""
    if carrier is not None and not is_put_on_tangent(point, origin, carrier):
        point._facts = (*_facts(point), _FromOrigin(origin, carrier, touch))


def is_put_on_tangent(point: Point, origin: Point, carrier: Carrier | None) -> bool:
    """Whether a point was made on the line from that very object that touches a circle."""
    return _tangent(point, origin, carrier) is not None


def touch_on_tangent(point: Point, origin: Point, carrier: Carrier | None) -> Point | None:
    """Where the line from that very object on which a point was made touches a circle, if that was made."""
    fact = _tangent(point, origin, carrier)
    if fact is None or fact.touch is not None:
        return None if fact is None else fact.touch
    # A line that touches a circle meets it once.
    return point if is_put_on(point, carrier) else None


def _tangent(point: Point, origin: Point, carrier: Carrier | None) -> _FromOrigin | None:
    found = (fact for fact in _facts(point) if isinstance(fact, _FromOrigin) and fact.origin is origin)
    return next((fact for fact in found if fact.carrier == carrier), None)


def _facts(point: Point) -> tuple[_Fact, ...]:
    return getattr(point, "_facts", ())
