"""How far away a known piece of boundary is: its nearest point, and where on a line it comes within range."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cmp_to_key
from itertools import pairwise

from flint import fmpq

from exactacq.geometry.constructions import put_on, put_on_normal
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.intersections import spans
from exactacq.geometry.points import Point, distance_sq
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real


def nearest_point(curve: Curve, place: Point) -> Point:
    """The point of a closed curve nearest to a place; of equally near ones the lexicographically least."""
    if isinstance(curve, Arc):
        ray = place - curve.center
        if ray.x.sign() == 0 == ray.y.sign():
            # All of the arc is equally near.
            ray = Point(-1, 0)
        if spans(curve, (ray.x, ray.y)):
            foot: Point = curve.center + ray * (curve.radius / ray.norm_sq().sqrt())
            put_on(foot, curve.carrier)
            put_on_normal(foot, place, curve.carrier)
            return foot
        return nearest_of((curve.start, curve.end), place)
    along = curve.whole.direction
    if (place - curve.start).dot(along).sign() <= 0:
        return curve.start
    if (place - curve.end).dot(along).sign() >= 0:
        return curve.end
    origin = curve.whole.start
    return origin + along * ((place - origin).dot(along) / along.norm_sq())


def nearest_of(points: Sequence[Point], place: Point) -> Point:
    """The point nearest to a place; of equally near ones the lexicographically least."""

    def order(a: Point, b: Point) -> int:
        return distance_sq(a, place).compare(distance_sq(b, place)) or a.compare(b)

    return min(points, key=cmp_to_key(order))


def is_in_reach(place: Point, curves: Sequence[Curve], radius: fmpq) -> bool:
    """Whether some curve comes within the radius of a place."""
    near = (distance_sq(place, nearest_point(curve, place)) for curve in curves)
    return any(distance.compare(radius * radius) <= 0 for distance in near)


def thresholds(x: fmpq, curve: Curve, radius: fmpq) -> Iterator[Real]:
    """Ordinates at which a place with abscissa *x* is as far as the radius from a point of a curve.

    Among them are all ends of the stretches from which the curve is within the radius: there the nearest
    point is an end or the foot of a perpendicular.
    """
    for end in (curve.start, curve.end):
        yield from _level(x, end, Real(radius))
    if isinstance(curve, Arc):
        for size in (curve.radius + radius, curve.radius - radius):
            if size.sign() > 0:
                for y in _level(x, curve.center, size):
                    ray = x - curve.center.x, y - curve.center.y
                    # Opposite to a foot, where the ray leaves the arc's other side, nothing is as near.
                    if spans(curve, ray):
                        yield y
        return
    origin, along = curve.whole.start, curve.whole.direction
    if along.x.sign():
        rise = Real(radius) * along.norm_sq().sqrt() / along.x
        middle = origin.y + along.y * ((x - origin.x) / along.x)
        for y in (middle - rise, middle + rise):
            after, before = ((Point(x, y) - end).dot(along).sign() for end in (curve.start, curve.end))
            if after > 0 and before < 0:
                yield y


def _level(x: fmpq, center: Point, radius: Real) -> list[Real]:
    """The ordinates at which a vertical line meets a circle."""
    across = center.x - x
    square = radius * radius - across * across
    if square.sign() < 0:
        return []
    height = square.sqrt()
    return [center.y - height, center.y + height]


def last_in_reach(x: fmpq, upward: bool, curves: Sequence[Curve], radius: fmpq) -> Real | None:
    """The last ordinate with some curve in reach as one walks a vertical line; None if there is none."""
    found = [y for curve in curves for y in thresholds(x, curve, radius)]
    return (max(found) if upward else min(found)) if found else None


def first_out_of_reach(
    x: fmpq, upward: bool, begin: Real, curves: Sequence[Curve], radius: fmpq
) -> Real | None:
    """The first ordinate from *begin* on, as one walks, with a curve in reach and none just after."""
    sense = 1 if upward else -1
    found = [begin] if is_in_reach(Point(x, begin), curves, radius) else []
    found += [y for curve in curves for y in thresholds(x, curve, radius) if y.compare(begin) == sense]
    found.sort(reverse=not upward)
    for y, after in pairwise(found):
        if y.compare(after):
            middle = Point(x, rational_between(min(y, after), max(y, after)))
            if not is_in_reach(middle, curves, radius):
                return y
    return found[-1] if found else None


def leftmost(curve: Curve) -> Real:
    """The least abscissa on a closed curve."""
    if isinstance(curve, Arc) and spans(curve, (fmpq(-1), fmpq(0))):
        return curve.center.x - curve.radius
    return min(curve.start.x, curve.end.x)
