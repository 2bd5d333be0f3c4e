"""Where curves meet, where a point lies with respect to a loop, and where two curves are nearest.

Every decision is a sign of a polynomial in the coordinates; square roots appear in results only, so rational
curves are decided in rational arithmetic. Coordinates are unpacked to `fmpq` where they are rational and stay
`Real` where they are not: the same formulas serve both.

Preconditions throughout: segments have two distinct ends, arcs a positive radius and either two distinct ends
or ``full``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any

from flint import fmpq

from exactacq.geometry.coordinates import (
    Vector,
    advance,
    between,
    compare,
    cross,
    dot,
    minus,
    ratio,
    raw,
    same_direction,
    sign,
    square_root,
)
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Location, Point, distance_sq
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real


class ContactKind(Enum):
    """How two curves meet."""

    CROSSING = "cross"
    """At one point, inner to both, where each passes from one side of the other to the other side."""
    TOUCHING = "touch"
    """At one point: a tangency, or an end of one of the two."""
    OVERLAP = "overlap"
    """Along a common piece."""


@dataclass(frozen=True)
class Contact:
    """One component of the intersection of two curves: ``start is end`` unless it is an overlap.

    An overlap runs from start to end in the first curve's direction; on two equal full circles both are the
    first circle's start. Ends of curves are copied, never recomputed.
    """

    kind: ContactKind
    start: Point
    end: Point


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


def spans(arc: Arc, direction: Vector, strict: bool = False) -> bool:
    """Whether the ray from the arc's centre in a direction (not 0) meets the arc, or its interior if strict.

    Coordinates are fmpq or Real; three cross products, no square root.
    """
    if arc.full:
        return True
    center = raw(arc.center)
    start, end = minus(raw(arc.start), center), minus(raw(arc.end), center)
    return between(start, end, direction, strict) if arc.ccw else between(end, start, direction, strict)


# -- lines -----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _LineHit:
    """Where a line meets a curve: the parameter on the line, the curve's end if it is one, tangency."""

    parameter: Any
    end: Point | None = None
    tangent: bool = False


def line_contacts(origin: Point, direction: Point, curve: Curve) -> list[Real]:
    """The ascending parameters lambda for which ``origin + lambda direction`` lies on the closed curve.

    A tangency counts once; a segment on the line gives both its ends. The direction is not 0. Whether an end
    of the curve lies on the line is decided before any root is taken, and then gives the root rationally.
    """
    hits = _line_hits(raw(origin), raw(direction), curve)
    return sorted(Real(hit.parameter) for hit in hits)


def _line_hits(origin: Vector, direction: Vector, curve: Curve) -> list[_LineHit]:
    if isinstance(curve, Segment):
        return _line_segment(origin, direction, curve)
    return _line_arc(origin, direction, curve)


def _line_segment(origin: Vector, direction: Vector, segment: Segment) -> list[_LineHit]:
    start, end = minus(raw(segment.start), origin), minus(raw(segment.end), origin)
    s, e = cross(direction, start), cross(direction, end)
    before, after = sign(s), sign(e)
    if before * after > 0:
        return []
    if before and after:
        return [_LineHit(cross(start, end) / (e - s))]
    hits = [] if before else [_LineHit(ratio(start, direction), segment.start)]
    return hits if after else [*hits, _LineHit(ratio(end, direction), segment.end)]


def _line_arc(origin: Vector, direction: Vector, arc: Arc) -> list[_LineHit]:
    """Roots of A l^2 + 2 B l + C with A = |d|^2, B = w.d, where w = origin - centre.

    The discriminant is A r^2 - (d x w)^2. If an end of the arc lies on the line it is one root and -2B/A
    less that root is the other. Otherwise the line misses both ends, and a root is on the arc if it is on the
    arc's side of the chord, where the sign is never 0.
    """
    w = minus(origin, raw(arc.center))
    height = cross(direction, w)
    square = dot(direction, direction)
    discriminant = square * arc.radius_sq - height * height
    count = sign(discriminant) + 1
    if count == 0:
        return []
    middle = -dot(w, direction) / square
    ends = [] if arc.full else [(p, minus(raw(p), origin)) for p in (arc.start, arc.end)]
    on_line = [(p, v) for p, v in ends if sign(cross(direction, v)) == 0]
    if len(on_line) == 2 and count == 2:
        return [_LineHit(ratio(v, direction), p) for p, v in on_line]
    if on_line:
        p, v = on_line[0]
        first = _LineHit(ratio(v, direction), p, tangent=count == 1)
        other = 2 * middle - first.parameter
        return [first, _LineHit(other)] if count == 2 and _spans_at(arc, w, direction, other) else [first]
    if count == 1:
        return [_LineHit(middle, tangent=True)] if _spans_at(arc, w, direction, middle) else []
    half = Real(discriminant).sqrt() / square
    return [_LineHit(root) for root in (middle - half, middle + half) if _spans_at(arc, w, direction, root)]


def _spans_at(arc: Arc, w: Vector, direction: Vector, parameter: Any) -> bool:
    """Whether centre + w + parameter * direction, a point of the circle and no end, lies on the arc."""
    if arc.full:
        return True
    center = raw(arc.center)
    start, end = minus(raw(arc.start), center), minus(raw(arc.end), center)
    chord = minus(end, start)
    side = sign(cross(chord, minus(w, start)) + cross(chord, direction) * parameter)
    return side < 0 if arc.ccw else side > 0


# -- contacts of two curves ------------------------------------------------------------------------


def contacts(a: Curve, b: Curve) -> list[Contact]:
    """Every component of the intersection of two closed curves, in no particular order.

    Rational curves that do not meet are told apart without square roots.
    """
    if isinstance(a, Segment):
        return _segments(a, b) if isinstance(b, Segment) else _segment_arc(a, b)
    if isinstance(b, Segment):
        return _segment_arc(b, a)
    if compare(raw(a.center), raw(b.center)) == 0:
        return _same_circle(a, b) if a.radius_sq == b.radius_sq else []
    return _arcs(a, b)


def _at(kind: ContactKind, point: Point) -> Contact:
    return Contact(kind, point, point)


def _segments(a: Segment, b: Segment) -> list[Contact]:
    p, q, u, v = raw(a.start), raw(a.end), raw(b.start), raw(b.end)
    along, across = minus(q, p), minus(v, u)
    first, last = cross(along, minus(u, p)), cross(along, minus(v, p))
    u_side, v_side = sign(first), sign(last)
    if u_side * v_side > 0:
        return []
    start, end = cross(across, minus(p, u)), cross(across, minus(q, u))
    p_side, q_side = sign(start), sign(end)
    if p_side * q_side > 0:
        return []
    if not (u_side or v_side):
        return _collinear(a, b)
    for side, point in ((p_side, a.start), (q_side, a.end), (u_side, b.start), (v_side, b.end)):
        if side == 0:
            return [_at(ContactKind.TOUCHING, point)]
    if all(isinstance(c, fmpq) for c in (*u, *v)):
        # On a rational line the point shows that it is on it: both coordinates are made of one number.
        return [_at(ContactKind.CROSSING, advance(u, across, first / (first - last)))]
    return [_at(ContactKind.CROSSING, advance(p, along, start / (start - end)))]


def _collinear(a: Segment, b: Segment) -> list[Contact]:
    forward = compare(raw(a.start), raw(a.end))
    first, last = (b.start, b.end) if compare(raw(b.start), raw(b.end)) == forward else (b.end, b.start)
    start = first if compare(raw(a.start), raw(first)) == forward else a.start
    end = last if compare(raw(last), raw(a.end)) == forward else a.end
    order = compare(raw(start), raw(end))
    if order == 0:
        return [_at(ContactKind.TOUCHING, start)]
    return [Contact(ContactKind.OVERLAP, start, end)] if order == forward else []


def _segment_arc(segment: Segment, arc: Arc) -> list[Contact]:
    origin = raw(segment.start)
    direction = minus(raw(segment.end), origin)
    found = []
    for hit in _line_hits(origin, direction, arc):
        after, before = sign(hit.parameter), sign(1 - hit.parameter)
        if after < 0 or before < 0:
            continue
        end = segment.start if after == 0 else segment.end if before == 0 else hit.end
        kind = ContactKind.TOUCHING if end is not None or hit.tangent else ContactKind.CROSSING
        found.append(_at(kind, advance(origin, direction, hit.parameter) if end is None else end))
    return found


def _arcs(a: Arc, b: Arc) -> list[Contact]:
    """Arcs of two circles with different centres.

    With d from centre to centre the circles meet at c_a + t d +- h left(d), where
    t = (d^2 + r_a^2 - r_b^2) / (2 d^2) and h^2 = r_a^2 / d^2 - t^2.
    """
    center = raw(a.center)
    d = minus(raw(b.center), center)
    square = dot(d, d)
    t = (square + a.radius_sq - b.radius_sq) / (2 * square)
    height_sq = a.radius_sq / square - t * t
    count = sign(height_sq) + 1
    if count == 0:
        return []
    found = []
    foot = (center[0] + d[0] * t, center[1] + d[1] * t)
    height = Real(height_sq).sqrt()
    ends = [p for arc in (a, b) if not arc.full for p in (arc.start, arc.end)]
    for h in (height, -height)[:count]:
        point = advance(foot, (-d[1], d[0]), h)
        end = next((p for p in ends if p == point), None)
        if all(_on_arc(arc, point, end) for arc in (a, b)):
            kind = ContactKind.CROSSING if end is None and count == 2 else ContactKind.TOUCHING
            found.append(_at(kind, point if end is None else end))
    return found


def _on_arc(arc: Arc, point: Point, end: Point | None) -> bool:
    """Whether a point of the supporting circle (known to be some curve's end, or no end) is on the arc."""
    return arc.full or end is arc.start or end is arc.end or arc.contains(point if end is None else end)


def _same_circle(a: Arc, b: Arc) -> list[Contact]:
    found = []
    for start, end in _common(a, b):
        whole = a.full and b.full
        kind = ContactKind.OVERLAP if whole or start is not end else ContactKind.TOUCHING
        found.append(Contact(kind, start, end))
    return found


def _common(a: Arc, b: Arc) -> list[tuple[Point, Point]]:
    """The common angles of two concentric arcs, as (start, end) in a's sense, copied from either arc.

    A common piece starts where one arc starts within the other, and ends at the first end from there; a
    single common direction gives the same point twice.
    """
    if b.full:
        return [(a.start, a.start if a.full else a.end)]
    if a.ccw != b.ccw:
        b = b.reversed()
    if a.full:
        return [(b.start, b.end)]
    flip = 1 if a.ccw else -1
    center = raw(a.center)

    def vector(point: Point) -> Vector:
        x, y = minus(raw(point), center)
        return x, y * flip

    ends = [(vector(arc.start), vector(arc.end)) for arc in (a, b)]
    (a_start, a_end), (b_start, b_end) = ends
    starts = [(a.start, a_start)] if between(b_start, b_end, a_start, strict=False) else []
    if not same_direction(a_start, b_start) and between(a_start, a_end, b_start, strict=False):
        starts.append((b.start, b_start))
    found = []
    for point, start in starts:
        if same_direction(start, a_end) or same_direction(start, b_end):
            found.append((point, point))
        else:
            found.append((point, b.end if between(start, a_end, b_end, strict=False) else a.end))
    return found


# -- loops -----------------------------------------------------------------------------------------


def signed_area(edges: Sequence[Curve]) -> Length:
    """The area that a closed chain encloses, positive if it runs counterclockwise.

    Half the shoelace sum, plus (r^2 / 2)(theta - sin theta) for each counterclockwise arc, minus it for each
    clockwise one.
    """
    shoelace = Real.sum(edge.start.cross(edge.end) for edge in edges)
    caps = []
    for edge in edges:
        if isinstance(edge, Arc):
            half = edge.radius_sq / 2 if edge.ccw else -edge.radius_sq / 2
            if edge.full:
                caps.append(Length.turns(Real(half)))
            else:
                cosine, sine = edge.turn
                caps.append(Length.arc(Real(half), cosine, sine) - Length(sine * half))
    return Length.sum([Length(shoelace / 2), *caps])


def winding(edges: Sequence[Curve], point: Point) -> int | None:
    """How often a closed chain winds round a point, counterclockwise; None if the point is on the chain.

    Crossings of the ray to the east are counted as seen from the point moved by (e^2, e), e infinitesimal,
    so vertices, horizontal edges and tangencies on the ray need no care. An arc counts as its chord, plus one
    turn if the point lies between chord and arc. No square roots; linear in the edges.
    """
    p = raw(point)
    turns = 0
    for edge in edges:
        if isinstance(edge, Arc) and edge.full:
            side = _circle_side(edge, p)
            if side == 0:
                return None
            turns += (1 if edge.ccw else -1) if side < 0 else 0
            continue
        start, end = minus(raw(edge.start), p), minus(raw(edge.end), p)
        from_height, to_height = sign(start[1]), sign(end[1])
        if isinstance(edge, Segment) and from_height * to_height > 0:
            continue
        side = sign(cross(start, end))
        if side == 0:
            if _meets_origin(edge, start, end):
                return None
            chord = minus(end, start)
            side = sign(chord[0]) or -sign(chord[1])
        rise = int(to_height > 0) - int(from_height > 0)
        turns += rise if rise == side else 0
        if isinstance(edge, Arc) and side == (-1 if edge.ccw else 1):
            inside = _circle_side(edge, p)
            if inside == 0:
                return None
            turns -= side if inside < 0 else 0
    return turns


def _circle_side(arc: Arc, point: Vector) -> int:
    """-1, 0 or 1 as the point is inside, on or outside the supporting circle."""
    w = minus(point, raw(arc.center))
    return sign(dot(w, w) - arc.radius_sq)


def _meets_origin(edge: Curve, start: Vector, end: Vector) -> bool:
    """Whether the origin, on the line through start and end, lies on the segment, or is an end of the arc."""
    if isinstance(edge, Segment):
        return sign(dot(start, end)) <= 0
    return compare(start, (0, 0)) == 0 or compare(end, (0, 0)) == 0


def locate(edges: Sequence[Curve], point: Point, ccw: bool | None = None) -> Location:
    """Where a point lies with respect to a simple loop whose blocked side is on the left.

    INSIDE is strictly on the blocked side: within a counterclockwise loop, outside a clockwise one. *ccw*
    is the loop's sense if the caller knows it; otherwise a point that the loop does not wind round costs the
    sign of the loop's area.
    """
    turns = winding(edges, point)
    if turns is None:
        return Location.BOUNDARY
    if turns:
        return Location.INSIDE if turns > 0 else Location.OUTSIDE
    if ccw is None:
        ccw = signed_area(edges).sign() > 0
    return Location.OUTSIDE if ccw else Location.INSIDE


# -- nearest points --------------------------------------------------------------------------------


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
    return advance(center, ray, square_root(arc.radius_sq / dot(ray, ray)))


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
    return NearestFamily(NearestFamilyKind.PARALLEL, a.part(p, q), b.part(first, last))


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
    for start, end in _common(a, b):
        if start is end and not (a.full and b.full):
            continue
        parts = []
        for arc in (a, b):
            own = [p if p in (arc.start, arc.end) else _projected(arc, p) for p in (start, end)]
            sense = arc if arc.ccw == a.ccw else arc.reversed()
            parts.append(sense if arc.full and own[0] is own[1] else sense.part(own[0], own[1]))
        found.append(NearestFamily(NearestFamilyKind.CONCENTRIC, parts[0], parts[1]))
    return found
