"""Where curves meet lines and each other.

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
from typing import Any, TypeAlias

from flint import fmpq

from exactacq.geometry.constructions import corners_passed, is_put_around, is_put_on, is_tangent, put_on
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
)
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.late import balls, may_be_one
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real

Touched: TypeAlias = "Sequence[Point | Arc]"
"""What a line is known to touch by construction: points on it, and arcs whose circles it touches.

These objects themselves are recognised in a curve and its ends, without arithmetic; equal ones are not."""


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

    @property
    def places(self) -> tuple[Point, ...]:
        """The point, or the two ends of an overlap."""
        return (self.start,) if self.start is self.end else (self.start, self.end)


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
    """Where a line meets a curve: the parameter on the line, the point if it is known, tangency."""

    parameter: Any
    end: Point | None = None
    tangent: bool = False


def line_contacts(origin: Point, direction: Point, curve: Curve) -> list[Real]:
    """The ascending parameters lambda for which ``origin + lambda direction`` lies on the closed curve.

    A tangency counts once; a segment on the line gives both its ends. The direction is not 0. Whether an end
    of the curve lies on the line is decided before any root is taken, and then gives the root rationally.
    """
    hits = _line_hits(raw(origin), raw(direction), curve, ())
    return sorted(Real(hit.parameter) for hit in hits)


def line_points(origin: Point, direction: Point, curve: Curve, on: Touched = ()) -> list[Point]:
    """The points that a line and a closed curve share, as `line_contacts` finds them, in no order.

    Ends of the curve are copied, never recomputed; *on* is what the line is known to touch.
    """
    start, way = raw(origin), raw(direction)
    hits = _line_hits(start, way, curve, on)
    if isinstance(curve, Arc):
        return [_made(start, way, hit.parameter, curve) if hit.end is None else hit.end for hit in hits]
    return [advance(start, way, hit.parameter) if hit.end is None else hit.end for hit in hits]


def _line_hits(origin: Vector, direction: Vector, curve: Curve, on: Touched) -> list[_LineHit]:
    if isinstance(curve, Segment):
        return _line_segment(origin, direction, curve, on)
    return _line_arc(origin, direction, curve, on)


def _touches(on: Touched, thing: Point | Arc) -> bool:
    """Whether an object is one of those that a line is known to touch: equal ones are not asked for."""
    return any(thing is other for other in on)


def _side(point: Point, product: Any, on: Touched) -> int:
    """The side of a line that a point is on: the sign of a vector product, 0 if it is known to be on it."""
    return 0 if _touches(on, point) else sign(product)


def _line_segment(origin: Vector, direction: Vector, segment: Segment, on: Touched) -> list[_LineHit]:
    ends = segment.start, segment.end
    ways = [minus(raw(end), origin) for end in ends]
    sides = [_side(end, cross(direction, way), on) for end, way in zip(ends, ways, strict=True)]
    if sides[0] * sides[1] > 0:
        return []
    met = [k for k in (0, 1) if sides[k] == 0]
    if len(met) == 2 or (met and segment.whole is segment):
        return [_LineHit(ratio(ways[k], direction), ends[k]) for k in met]
    start, along = _line(segment)
    parameter = cross(minus(start, origin), along) / cross(direction, along)
    return [_LineHit(parameter, ends[met[0]] if met else None)]


def _line(segment: Segment) -> tuple[Vector, Vector]:
    """A point of a segment's line and its direction: those of the whole, if the segment is a part."""
    start = raw(segment.whole.start)
    return start, minus(raw(segment.whole.end), start)


def _line_arc(origin: Vector, direction: Vector, arc: Arc, on: Touched) -> list[_LineHit]:
    """Roots of A l^2 + 2 B l + C with A = |d|^2, B = w.d, where w = origin - centre.

    The discriminant is A r^2 - (d x w)^2. If an end of the arc lies on the line it is one root and -2B/A
    less that root is the other. Otherwise the line misses both ends, and a root is on the arc if it is on the
    arc's side of the chord, where the sign is never 0. A point of the line that was made on the circle is a
    root, too.
    """
    w = minus(origin, raw(arc.center))
    height = cross(direction, w)
    square = dot(direction, direction)
    discriminant = square * arc.radius_sq - height * height
    made = [p for p in on if isinstance(p, Point) and _is_known_on(arc, p)]
    if _touches(on, arc):
        count = 1
    elif made:
        is_chord = _other(made, made[0]) is not None
        count = 2 if is_chord or sign(dot(minus(raw(made[0]), raw(arc.center)), direction)) else 1
    else:
        count = sign(discriminant) + 1
    if count == 0:
        return []
    middle = -dot(w, direction) / square
    ends = [] if arc.full else [(p, minus(raw(p), origin)) for p in (arc.start, arc.end)]
    on_line = [(p, v) for p, v in ends if _side(p, cross(direction, v), on) == 0]
    if len(on_line) == 2 and count == 2:
        return [_LineHit(ratio(v, direction), p) for p, v in on_line]
    if on_line or made:
        known = on_line[0][0] if on_line else made[0]
        first = _LineHit(ratio(minus(raw(known), origin), direction), known, tangent=count == 1)
        hits = [first] if on_line or _spans_at(arc, w, direction, first.parameter) else []
        if count == 2:
            again = _other(made, known)
            other = (
                2 * middle - first.parameter if again is None else ratio(minus(raw(again), origin), direction)
            )
            hits += [_LineHit(other, again)] if _spans_at(arc, w, direction, other) else []
        return hits
    if count == 1:
        return [_LineHit(middle, tangent=True)] if _spans_at(arc, w, direction, middle) else []
    half = Real(discriminant).sqrt() / square
    return [_LineHit(root) for root in (middle - half, middle + half) if _spans_at(arc, w, direction, root)]


def _other(points: Sequence[Point], point: Point) -> Point | None:
    """One of some points that surely is another one."""
    return next((q for q in points if not may_be_one(balls(point), balls(q))), None)


def _is_known_on(arc: Arc, point: Point) -> bool:
    """Whether a point is known to lie on an arc's circle: it was made there, or rational numbers tell."""
    if is_put_on(point, arc.carrier) or is_put_around(point, arc.center, arc.radius_sq):
        return True
    return not point.is_late and point.rational is not None and arc.on_circle(point)


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


def contacts(a: Curve, b: Curve, on: Touched = ()) -> list[Contact]:
    """Every component of the intersection of two closed curves, in no particular order.

    Rational curves that do not meet are told apart without square roots. *on* is what the line of a segment
    *a* is known to touch; its own ends need not be among that.
    """
    if isinstance(a, Segment):
        on = (a.start, a.end, *corners_passed(a.start, a.end), *on)
        return _segments(a, b, on) if isinstance(b, Segment) else _segment_arc(a, b, on)
    if isinstance(b, Segment):
        return _segment_arc(b, a, (b.start, b.end, *corners_passed(b.start, b.end)))
    if compare(raw(a.center), raw(b.center)) == 0:
        return _same_circle(a, b) if a.radius_sq == b.radius_sq else []
    return _arcs(a, b)


def _at(kind: ContactKind, point: Point) -> Contact:
    return Contact(kind, point, point)


def _segments(a: Segment, b: Segment, on: Touched) -> list[Contact]:
    (p, along), (u, across) = _line(a), _line(b)
    first, last = (cross(along, minus(raw(end), p)) for end in (b.start, b.end))
    u_side, v_side = _side(b.start, first, on), _side(b.end, last, on)
    if u_side * v_side > 0:
        return []
    start, end = (cross(across, minus(raw(end), u)) for end in (a.start, a.end))
    ends = (b.start, b.end)
    p_side, q_side = _side(a.start, start, ends), _side(a.end, end, ends)
    if p_side * q_side > 0:
        return []
    if not (u_side or v_side):
        return _collinear(a, b)
    for side, point in ((p_side, a.start), (q_side, a.end), (u_side, b.start), (v_side, b.end)):
        if side == 0:
            return [_at(ContactKind.TOUCHING, point)]
    if all(isinstance(c, fmpq) for c in (*u, *across)):
        # On a rational line the point shows that it is on it: both coordinates are made of one number.
        point = advance(u, across, cross(along, minus(p, u)) / cross(along, across))
    else:
        point = advance(p, along, cross(across, minus(u, p)) / cross(across, along))
    return [_at(ContactKind.CROSSING, point)]


def _collinear(a: Segment, b: Segment) -> list[Contact]:
    forward = compare(raw(a.start), raw(a.end))
    first, last = (b.start, b.end) if compare(raw(b.start), raw(b.end)) == forward else (b.end, b.start)
    start = first if compare(raw(a.start), raw(first)) == forward else a.start
    end = last if compare(raw(last), raw(a.end)) == forward else a.end
    order = compare(raw(start), raw(end))
    if order == 0:
        return [_at(ContactKind.TOUCHING, start)]
    return [Contact(ContactKind.OVERLAP, start, end)] if order == forward else []


def _segment_arc(segment: Segment, arc: Arc, on: Touched) -> list[Contact]:
    origin = raw(segment.start)
    direction = minus(raw(segment.end), origin)
    if is_tangent(segment.start, segment.end, arc.carrier):
        on = (arc, *on)
    found = []
    for hit in _line_arc(origin, direction, arc, on):
        after = 0 if hit.end is segment.start else sign(hit.parameter)
        before = 0 if hit.end is segment.end else sign(1 - hit.parameter)
        if after < 0 or before < 0:
            continue
        end = segment.start if after == 0 else segment.end if before == 0 else hit.end
        is_end = end is segment.start or end is segment.end or end is arc.start or end is arc.end
        kind = ContactKind.TOUCHING if is_end or hit.tangent else ContactKind.CROSSING
        found.append(_at(kind, _made(origin, direction, hit.parameter, arc) if end is None else end))
    return found


def _made(origin: Vector, direction: Vector, parameter: Any, arc: Arc) -> Point:
    """The point of a line at a parameter, where it meets an arc."""
    point = advance(origin, direction, parameter)
    if not isinstance(parameter, fmpq):
        put_on(point, arc.carrier)
    return point


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
    ends = [(p, other) for arc, other in ((a, b), (b, a)) if not arc.full for p in (arc.start, arc.end)]
    points = [advance(foot, (-d[1], d[0]), h) for h in (height, -height)[:count]]
    for point, beyond in zip(points, reversed(points), strict=True):
        if height.rational is None:
            put_on(point, a.carrier)
            put_on(point, b.carrier)
        end = next((p for p, other in ends if _is_met(p, other, point, beyond)), None)
        if all(_on_arc(arc, point, end) for arc in (a, b)):
            kind = ContactKind.CROSSING if end is None and count == 2 else ContactKind.TOUCHING
            found.append(_at(kind, point if end is None else end))
    return found


def _is_met(end: Point, other: Arc, point: Point, beyond: Point) -> bool:
    """Whether the end of an arc is the *point* where its circle meets another's, and not the one *beyond*."""
    if _is_known_on(other, end) and not may_be_one(balls(end), balls(beyond)):
        return True
    return end == point


def _on_arc(arc: Arc, point: Point, end: Point | None) -> bool:
    """Whether a point of the supporting circle (known to be some curve's end, or no end) is on the arc."""
    return arc.full or end is arc.start or end is arc.end or arc.contains(point if end is None else end)


def _same_circle(a: Arc, b: Arc) -> list[Contact]:
    found = []
    for start, end in common_angles(a, b):
        whole = a.full and b.full
        kind = ContactKind.OVERLAP if whole or start is not end else ContactKind.TOUCHING
        found.append(Contact(kind, start, end))
    return found


def common_angles(a: Arc, b: Arc) -> list[tuple[Point, Point]]:
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
