"""What is known of a point because of how it was made, where its numbers would take long to tell.

A robot may stand on an arc where it saw the last of it past another arc, from a place that it found in the
same way: its coordinates have a high degree. That the place lies on the first arc, and that the way to it
touches the second one, is known when it is made.

These facts belong to one object; an equal point that was made otherwise has others. Where a fact is missing
arithmetic decides. Points that others hand over have none, nor have those that the audit makes.
"""

from __future__ import annotations

from typing import TypeAlias

from flint import fmpq

from exactacq.geometry.points import Point

Carrier: TypeAlias = "tuple[fmpq, fmpq, fmpq]"
"""A circle whose centre and squared radius are rational: both coordinates, then the square."""


def put_on(point: Point, carrier: Carrier | None) -> None:
    """Note that a point was made on a circle; nothing if that is not rational."""
    if carrier is not None and not is_put_on(point, carrier):
        point._facts = (*_facts(point), carrier)


def is_put_on(point: Point, carrier: Carrier | None) -> bool:
    """Whether a point was made on a circle; of one that was not, nothing is known."""
    return carrier is not None and carrier in _facts(point)


def put_on_tangent(point: Point, origin: Point, carrier: Carrier | None) -> None:
    """Note that a point was made on the line from another one that touches a circle."""
    if carrier is not None and not is_put_on_tangent(point, origin, carrier):
        point._facts = (*_facts(point), (origin, carrier))


def is_put_on_tangent(point: Point, origin: Point, carrier: Carrier | None) -> bool:
    """Whether a point was made on the line from that very object that touches a circle."""
    facts = (fact for fact in _facts(point) if len(fact) == 2 and fact[0] is origin)
    return any(fact[1] == carrier for fact in facts)


def _facts(point: Point) -> tuple[tuple[object, ...], ...]:
    return getattr(point, "_facts", ())
