"""From where lines that touch one feature are exactly as long as the range, in closed form.

Between a vertical line and a known piece the squared length of such a line is an algebraic function of its
parameter (see `exactacq.visibility.chords`): it equals the square of the range at roots of a rational
polynomial. That tells what bounds of the length cannot: whether it comes down to just the range.
"""

from __future__ import annotations

from collections.abc import Iterator

from flint import fmpq

from exactacq.geometry.coordinates import Vector, minus
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.visibility.chords import of_length
from exactacq.visibility.line_families import EAST, WEST, Sector, corner_sectors, round_sectors


def ordinates_at_range(x: fmpq, feature: Point | Arc, target: Curve, radius: fmpq) -> list[Real] | None:
    """A finite superset of the ordinates from which a line that touches a feature is as long as the range.

    There is one for each such line, from the vertical line at *x* to the line or circle of the target.
    None where no closed form is known: where the feature, or the line that the target is part of, is not seen
    to be rational.
    """
    sectors = _sectors(feature)
    target = target if isinstance(target, Arc) else target.whole
    if sectors is None or (isinstance(target, Segment) and not _is_rational(target.start, target.end)):
        return None
    way = Segment(Point(x, 0), Point(x, 1))
    found = []
    for sector in sectors:
        for t in of_length(sector, way, target, radius * radius):
            contact, direction = sector.touch(t)
            # Other sectors find the same lines.
            if sector.low <= t < sector.high and direction.x.sign():
                found.append(contact.y + direction.y * ((x - contact.x) / direction.x))
    return found


def _sectors(feature: Point | Arc) -> list[Sector] | None:
    """All lines that touch a feature, each of them once: about a corner those of half a turn."""
    if isinstance(feature, Point):
        return None if feature.rational is None else [*corner_sectors(feature.rational, EAST, WEST)]
    center = feature.center.rational
    assert center is not None, "arcs of boundaries have rational centres"
    spoke = next(_rational_spokes(feature, center), None)
    return None if spoke is None else [*round_sectors(center, spoke, None)]


def _rational_spokes(arc: Arc, center: Vector) -> Iterator[Vector]:
    """Rational vectors from the centre of an arc to points of its circle."""
    radius = arc.radius.rational
    if radius is not None:
        yield radius, fmpq(0)
    yield from (minus(end, center) for end in (arc.start.rational, arc.end.rational) if end is not None)


def _is_rational(*points: Point) -> bool:
    return all(point.rational is not None for point in points)
