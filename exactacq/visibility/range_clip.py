"""What the range leaves of a piece of the boundary: its part within a closed disc, with exact ends.

Both a segment's line and an arc's circle meet the disc in one piece, whose ends are square roots over the
data. Ends that are within range are kept as they are, and decided first: no root is compared with another.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, TypeAlias

from flint import fmpq

from exactacq.geometry.coordinates import Vector, advance, cross, dot, minus, raw, sign, square_root
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import spans
from exactacq.geometry.points import Point

Span: TypeAlias = "tuple[Point, Point]"
"""A closed piece of an edge in the boundary's direction; equal ends are a single point."""


def within(
    curve: Curve,
    start: Point,
    end: Point,
    center: Vector,
    radius_sq: fmpq,
    at_range: Collection[int] = (),
) -> list[Span]:
    """The parts of the piece of a curve from *start* to *end* at most a radius away from a point, in order.

    At most two parts, each perhaps a single point. *start* and *end* may be one point of a segment, but on an
    arc they are distinct. *at_range* are identities of ends that are known to be as far away as the radius.
    """
    excess = tuple(0 if id(p) in at_range else _excess(p, center, radius_sq) for p in (start, end))
    if isinstance(curve, Segment):
        return _of_segment(curve, (start, end), excess, center, radius_sq)
    ends, flipped = ((start, end), excess), not curve.ccw
    if flipped:
        ends = (end, start), excess[::-1]
    parts = _of_arc(curve, *ends, center, radius_sq)
    return [(b, a) for a, b in reversed(parts)] if flipped else parts


def of_circle(circle: Arc, center: Vector, radius_sq: fmpq) -> list[Span] | None:
    """The part of a full circle within a radius of a point: at most one; None if all of it is within."""
    w = minus(raw(circle.center), center)
    level, square = _level(circle, w, radius_sq), dot(w, w)
    rest = sign(circle.radius_sq * square - level * level)
    if rest <= 0:
        touching = rest == 0 and sign(level) < 0
        if sign(level) > 0 or (sign(level) == 0 and not touching):
            return None
        if not touching:
            return []
        point = advance(raw(circle.center), w, level / square)
        return [(point, point)]
    part = _crossing(circle, w, level, 1), _crossing(circle, w, level, -1)
    return [part] if circle.ccw else [part[::-1]]


def _excess(point: Point, center: Vector, radius_sq: fmpq) -> int:
    """-1, 0 or 1 as a point is nearer than the radius, as near, or farther."""
    offset = minus(raw(point), center)
    return sign(dot(offset, offset) - radius_sq)


def _of_segment(
    line: Segment, ends: Span, excess: tuple[int, ...], center: Vector, radius_sq: fmpq
) -> list[Span]:
    if max(excess) <= 0:
        return [ends]
    origin, along = raw(line.start), raw(line.direction)
    offset = minus(center, origin)
    foot, square, height = dot(offset, along), dot(along, along), cross(along, offset)
    rest = square * radius_sq - height * height
    if min(excess) > 0:
        before, after = (minus(center, raw(p)) for p in ends)
        if sign(rest) < 0 or sign(dot(before, along)) <= 0 or sign(dot(after, along)) >= 0:
            return []
        if sign(rest) == 0:
            point = advance(origin, along, foot / square)
            return [(point, point)]
    root = square_root(rest)
    start, end = ends
    first = start if excess[0] <= 0 else None
    last = end if excess[1] <= 0 else None
    if first is not None and excess[0] == 0 and sign(dot(minus(center, raw(start)), along)) <= 0:
        return [(start, start)]
    if last is not None and excess[1] == 0 and sign(dot(minus(center, raw(end)), along)) >= 0:
        return [(end, end)]
    return [
        (
            first or advance(origin, along, (foot - root) / square),
            last or advance(origin, along, (foot + root) / square),
        )
    ]


def _level(arc: Arc, w: Vector, radius_sq: fmpq) -> Any:
    """k such that a point c + z of the circle is within range if and only if z . w <= k, w = c - p."""
    return (radius_sq - dot(w, w) - arc.radius_sq) / 2


def _crossing(arc: Arc, w: Vector, level: Any, side: int) -> Point:
    """Where the circle leaves the range, to the left (1) or right (-1) of w; counterclockwise from the left
    one to the right one it is within range."""
    square = dot(w, w)
    height = square_root(arc.radius_sq * square - level * level) * side
    x, y = raw(arc.center)
    return Point(x + (w[0] * level - w[1] * height) / square, y + (w[1] * level + w[0] * height) / square)


def _of_arc(arc: Arc, ends: Span, excess: tuple[int, ...], center: Vector, radius_sq: fmpq) -> list[Span]:
    """Of the counterclockwise piece between two points of the circle."""
    first, last = ends
    w = minus(raw(arc.center), center)
    whole = Arc(first, last, arc.center, arc.radius_sq, ccw=True)
    if max(excess) <= 0:
        far = w if sign(w[0]) or sign(w[1]) else None
        if far is None or not spans(whole, far, strict=True):
            return [ends]
        level = _level(arc, w, radius_sq)
        if sign(arc.radius_sq * dot(w, w) - level * level) <= 0:
            return [ends]
        left = last if _is_side(last, arc, w, excess[1], 1) else _crossing(arc, w, level, 1)
        right = first if _is_side(first, arc, w, excess[0], -1) else _crossing(arc, w, level, -1)
        return [(first, right), (left, last)]
    level = _level(arc, w, radius_sq)
    if min(excess) > 0:
        rest = sign(arc.radius_sq * dot(w, w) - level * level)
        if rest < 0 or not spans(whole, (-w[0], -w[1]), strict=True):
            return []
        if rest == 0:
            point = advance(raw(arc.center), w, level / dot(w, w))
            return [(point, point)]
        return [(_crossing(arc, w, level, 1), _crossing(arc, w, level, -1))]
    if excess[0] <= 0:
        if _is_side(first, arc, w, excess[0], -1):
            return [(first, first)]
        return [(first, _crossing(arc, w, level, -1))]
    if _is_side(last, arc, w, excess[1], 1):
        return [(last, last)]
    return [(_crossing(arc, w, level, 1), last)]


def _is_side(point: Point, arc: Arc, w: Vector, excess: int, side: int) -> bool:
    """Whether a point of the circle is its crossing of the range to the left (1) or right (-1) of w.

    Where the range only touches the circle, the two crossings are one point.
    """
    return excess == 0 and sign(cross(w, minus(raw(point), raw(arc.center)))) in (0, side)
