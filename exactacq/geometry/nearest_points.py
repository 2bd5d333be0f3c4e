"""Where two curves are nearest to each other.

Every decision is a sign of a polynomial in the coordinates, as in `exactacq.geometry.intersections`, whose
preconditions are these too.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from flint import fmpq

from exactacq.cached import cached_property
from exactacq.geometry.constructions import put_on
from exactacq.geometry.coordinates import Vector, advance, cross, dot, minus, raw, sign, square_root
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import common_angles, spans
from exactacq.geometry.points import Point, distance_sq
from exactacq.numbers.real import Real


class NearestFamilyKind(Enum):
    """Why two curves keep their distance along a whole piece."""

    PARALLEL = "parallel"
    CONCENTRIC = "concentric"


@dataclass(frozen=True)
class Nearest:
    """A pair of points, ``start`` on the first curve and ``end`` on the second."""

    start: Point
    end: Point

    @cached_property
    def distance_sq(self) -> Real:
        """Squared distance of the pair."""
        return distance_sq(self.start, self.end)


@dataclass(frozen=True)
class NearestFamily:
    """A continuum of nearest pairs: points of ``first`` (part of one curve) and ``second`` (of the other).

    Starts correspond to starts and ends to ends, so ``second`` may run against its curve. PARALLEL:
    two segments, a point and its orthogonal translate. CONCENTRIC: two arcs, points on one ray from the
    centre; or ``first`` or ``second`` is the centre itself, which corresponds to every point of the other.
    """

    kind: NearestFamilyKind
    first: Curve | Point
    second: Curve | Point

    @cached_property
    def distance_sq(self) -> Real:
        """Squared distance of every pair."""
        ends = (c if isinstance(c, Point) else c.start for c in (self.first, self.second))
        return distance_sq(*ends)


def nearest_points(a: Curve, b: Curve) -> list[Nearest | NearestFamily]:
    """All local minima of the distance between two closed curves, a function on a x b, and perhaps more.

    Pairs of ends are kept if no first-order move along the curves brings them nearer; an end and an inner
    point if the latter is the foot of the end's perpendicular (on an arc: on the ray from the centre through
    the end); two inner points if their line is the common normal. Of the normals of two circles only one
    gives a minimum, none if the circles cross: their other three are maxima or saddles. Whole pieces
    at one distance come as a `NearestFamily`, which stands for the pairs in it. All decisions for rational
    curves are rational.
    """
    if isinstance(a, Segment) and isinstance(b, Segment):
        family = _parallel(a, b)
        if family is not None:
            return [family]
    found: list[Nearest | NearestFamily] = []
    ends, others = _ends(a), _ends(b)
    for p, into in ends:
        at_p = raw(p)
        for q, onto in others:
            gap = minus(at_p, raw(q))
            if sign(dot(gap, into)) >= 0 and sign(dot(gap, onto)) <= 0:
                found.append(Nearest(p, q))
        found += _from_end(p, into, b)
    for q, onto in others:
        found += [_swapped(pair) for pair in _from_end(q, onto, a)]
    return found + _inner_pairs(a, b)


def _swapped(pair: Nearest | NearestFamily) -> Nearest | NearestFamily:
    if isinstance(pair, Nearest):
        return Nearest(pair.end, pair.start)
    return NearestFamily(pair.kind, pair.second, pair.first)


def _ends(curve: Curve) -> list[tuple[Point, Vector]]:
    """The ends of a curve, each with a vector that points along the curve from there."""
    start, end = raw(curve.start), raw(curve.end)
    if isinstance(curve, Segment):
        return [(curve.start, minus(end, start)), (curve.end, minus(start, end))]
    if curve.full:
        return []
    (x, y), (u, v) = (minus(p, raw(curve.center)) for p in (start, end))
    flip = 1 if curve.ccw else -1
    return [(curve.start, (-y * flip, x * flip)), (curve.end, (v * flip, -u * flip))]


def _from_end(p: Point, into: Vector, curve: Curve) -> list[Nearest | NearestFamily]:
    """The end p of one curve against the inner points of the other."""
    if isinstance(curve, Segment):
        start = raw(curve.start)
        along = minus(raw(curve.end), start)
        offset = minus(raw(p), start)
        t, square = dot(offset, along), dot(along, along)
        if sign(t) <= 0 or sign(square - t) <= 0:
            return []
        # p - foot = offset - (t / square) along, scaled by the positive square
        rise = (offset[0] * square - along[0] * t, offset[1] * square - along[1] * t)
        return [Nearest(p, advance(start, along, t / square))] if sign(dot(rise, into)) >= 0 else []
    center = raw(curve.center)
    ray = minus(raw(p), center)
    square = dot(ray, ray)
    if sign(square) == 0:
        return [NearestFamily(NearestFamilyKind.CONCENTRIC, p, curve)]
    # p - q is a multiple of the ray: positive outside the circle, negative inside, 0 on it.
    if sign(square - curve.radius_sq) * sign(dot(ray, into)) < 0 or not spans(curve, ray, strict=True):
        return []
    return [Nearest(p, _projected(curve, p))]


def _projected(arc: Arc, point: Point) -> Point:
    """The point of the supporting circle on the ray from the centre through a point."""
    center = raw(arc.center)
    ray = minus(raw(point), center)
    foot = advance(center, ray, square_root(arc.radius_sq / dot(ray, ray)))
    put_on(foot, arc.carrier)
    return foot


def _parallel(a: Segment, b: Segment) -> NearestFamily | None:
    """The pieces of two parallel segments that face each other, if they are longer than a point."""
    along = minus(raw(a.end), raw(a.start))
    heading, other = _heading(along), _heading(minus(raw(b.end), raw(b.start)))
    if sign(cross(heading, other)) != 0:
        return None
    first, last = (b.start, b.end) if sign(dot(heading, other)) >= 0 else (b.end, b.start)

    def ahead(p: Point, q: Point) -> int:
        return sign(dot(minus(raw(q), raw(p)), heading))

    if ahead(a.start, last) <= 0 or ahead(first, a.end) <= 0:
        return None
    to_b, square = minus(raw(first), raw(a.start)), dot(along, along)
    fraction = dot(to_b, along) / square
    offset = (to_b[0] - along[0] * fraction, to_b[1] - along[1] * fraction)
    ends = []
    for p, q, side in ((a.start, first, ahead(a.start, first)), (a.end, last, ahead(last, a.end))):
        if side < 0:
            ends.append((p, advance(raw(p), offset, 1)))
        else:
            ends.append((advance(raw(q), offset, -1) if side else p, q))
    (p, first), (q, last) = ends
    return NearestFamily(NearestFamilyKind.PARALLEL, a.part(p, q), Segment(first, last))


def _heading(vector: Vector) -> Vector:
    """A positive multiple of a vector, rational if its slope is seen to be: what lies ahead shows easily."""
    x, y = (Real(coordinate) for coordinate in vector)
    if x.rational is not None and y.rational is not None:
        return vector
    steep = bool(abs(y.ball(64)) > abs(x.ball(64)))
    major, minor = (y, x) if steep else (x, y)
    slope = minor.rational_ratio(major)
    if slope is None:
        return vector
    unit = fmpq(major.sign())
    return (slope * unit, unit) if steep else (unit, slope * unit)


def _inner_pairs(a: Curve, b: Curve) -> list[Nearest | NearestFamily]:
    """Minima between inner points of both curves; segments have none that `_parallel` does not find."""
    if isinstance(a, Segment):
        return [] if isinstance(b, Segment) else _segment_to_arc(a, b)
    if isinstance(b, Segment):
        return [_swapped(pair) for pair in _segment_to_arc(b, a)]
    d = minus(raw(b.center), raw(a.center))
    square = dot(d, d)
    if sign(square) == 0:
        return _concentric(a, b)
    # |d| >= r_a + r_b or |d| <= |r_a - r_b|, squared twice; between the two the circles cross.
    excess = square - a.radius_sq - b.radius_sq
    if sign(excess * excess - 4 * a.radius_sq * b.radius_sq) < 0:
        return []
    apart = sign(excess) > 0
    side_a = 1 if apart or a.radius_sq > b.radius_sq else -1
    side_b = -1 if apart or a.radius_sq < b.radius_sq else 1
    points = []
    for arc, side in ((a, side_a), (b, side_b)):
        ray = (d[0] * side, d[1] * side)
        if not spans(arc, ray, strict=True):
            return []
        points.append(advance(raw(arc.center), ray, square_root(arc.radius_sq / square)))
    return [Nearest(*points)]


def _segment_to_arc(segment: Segment, arc: Arc) -> list[Nearest | NearestFamily]:
    """The foot of the centre on the segment, if not within the circle, and the arc's point next to it."""
    start, center = raw(segment.start), raw(arc.center)
    along = minus(raw(segment.end), start)
    t, square = dot(minus(center, start), along), dot(along, along)
    if sign(t) <= 0 or sign(square - t) <= 0:
        return []
    foot = advance(start, along, t / square)
    ray = minus(raw(foot), center)
    if sign(dot(ray, ray) - arc.radius_sq) < 0 or not spans(arc, ray, strict=True):
        return []
    return [Nearest(foot, _projected(arc, foot))]


def _concentric(a: Arc, b: Arc) -> list[Nearest | NearestFamily]:
    """The pieces of two concentric arcs that span the same angles."""
    found: list[Nearest | NearestFamily] = []
    for start, end in common_angles(a, b):
        if start is end and not (a.full and b.full):
            continue
        parts = []
        for arc in (a, b):
            own = [p if p in (arc.start, arc.end) else _projected(arc, p) for p in (start, end)]
            sense = arc if arc.ccw == a.ccw else arc.reversed()
            parts.append(sense if arc.full and own[0] is own[1] else sense.part(own[0], own[1]))
        found.append(NearestFamily(NearestFamilyKind.CONCENTRIC, parts[0], parts[1]))
    return found
