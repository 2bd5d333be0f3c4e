"""What the range leaves of a piece of the boundary: its part within a closed disc, with exact ends.

Both a segment's line and an arc's circle meet the disc in one piece, whose ends are square roots over the
data. Ends that are within range are kept as they are, and decided first: no root is compared with another.
Balls decide what they can, and the roots are late points: made when they are looked into.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from flint import arb, fmpq

from exactacq.geometry.coordinates import Vector, advance, cross, dot, minus, raw, sign, square_root
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import spans
from exactacq.geometry.late import Balls, ball_of, balls, clearly_between, from_to, late_point, may_be_one
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import ball_sign

Span: TypeAlias = "tuple[Point, Point]"
"""A closed piece of an edge in the boundary's direction; equal ends are a single point."""


class Disc:
    """The closed disc about a point with a rational squared radius, and balls around these numbers.

    Some points of curves are known to lie on its *rim*: as objects in ``on_rim``.
    """

    __slots__ = ("_balls", "_rim", "center", "on_rim", "point", "square")
    _balls: tuple[Balls, arb]

    def __init__(self, point: Point, square: fmpq, rim: Sequence[tuple[Curve, Point]] = ()) -> None:
        self.point, self.center, self.square, self._rim = point, raw(point), square, rim
        self.on_rim = [point for _, point in rim]

    @property
    def balls(self) -> tuple[Balls, arb]:
        """Balls around the centre, and one around the radius' square."""
        try:
            return self._balls
        except AttributeError:
            self._balls = balls(self.point), arb(self.square)
            return self._balls

    def excess(self, point: Point) -> int:
        """-1, 0 or 1 as a point is nearer to the centre than the radius, as near, or farther."""
        (x, y), ((cx, cy), square) = balls(point), self.balls
        x, y = x - cx, y - cy
        if clear := ball_sign(x * x + y * y - square):
            return clear
        if any(point is known for known in self.on_rim):
            return 0
        offset = minus(raw(point), self.center)
        return sign(dot(offset, offset) - self.square)

    def known(self, curve: Curve, around: Callable[[int], Balls], side: int) -> Point | None:
        """Where a curve's line or circle meets the rim on a side, 1 or -1, if that is known.

        *around* gives balls for both sides: what certainly is not on the other one is on this one.
        """
        for known, point in self._rim:
            if known is not curve or may_be_one(balls(point), around(-side)):
                continue
            if may_be_one(balls(point), around(side)):
                return point
        return None


def within(
    curve: Curve,
    start: Point,
    end: Point,
    disc: Disc,
    touch: Point | None = None,
) -> list[Span]:
    """The parts of the piece of a curve from *start* to *end* in a disc, in order.

    At most two parts, each perhaps a single point. *start* and *end* may be one point of a segment, but on an
    arc they are distinct. *touch* is where the curve is known to touch the circle, not at its own ends.
    """
    excess = disc.excess(start), disc.excess(end)
    if isinstance(curve, Segment):
        return _of_segment(curve, (start, end), excess, disc, touch)
    ends, flipped = ((start, end), excess), not curve.ccw
    if flipped:
        ends = (end, start), excess[::-1]
    parts = _of_arc(curve, *ends, disc, touch)
    return [(b, a) for a, b in reversed(parts)] if flipped else parts


def of_circle(circle: Arc, disc: Disc) -> list[Span] | None:
    """The part of a full circle in a disc: at most one; None if all of it is."""
    at = _CircleCut(circle, disc)
    rest = at.rest()
    if rest < 0 or (rest == 0 and sign(at.level) >= 0):
        return None if sign(at.level) >= 0 else []
    if rest == 0:
        point = at.touching()
        return [(point, point)]
    part = at.point(1), at.point(-1)
    return [part] if circle.ccw else [part[::-1]]


def crossing(line: Segment, disc: Disc, side: int) -> Point:
    """Where a segment that certainly does so enters (-1) or leaves (1) a disc."""
    return _on_line(line, disc.center, disc.square, side)


def late_crossing(line: Segment, disc: Disc, side: int) -> Point:
    """That point, made when it is looked into."""
    return _Secant(line, disc).crossing(side)


def _touched(ends: Span, excess: tuple[int, ...], inside: list[Span]) -> list[Span]:
    """What is within range of a piece of a curve that has one point there: an end, or a point *inside*."""
    return next(([(end, end)] for end, far in zip(ends, excess, strict=True) if far <= 0), inside)


# -- segments --------------------------------------------------------------------------------------


def _of_segment(
    line: Segment, ends: Span, excess: tuple[int, ...], disc: Disc, touch: Point | None
) -> list[Span]:
    if max(excess) <= 0:
        return [ends]
    chord = _Secant(line, disc)
    if touch is not None:
        return _touched(ends, excess, [(touch, touch)] if chord.has_foot_between(*ends) else [])
    if min(excess) > 0:
        if chord.misses(*ends):
            return []
        if not ball_sign(chord.rest):
            foot, square, rest = _foot(line, disc.center, disc.square)
            if sign(rest) == 0:
                point = advance(raw(line.start), raw(line.direction), foot / square)
                return [(point, point)]
    start, end = ends
    first = start if excess[0] <= 0 else None
    last = end if excess[1] <= 0 else None
    along, center = raw(line.direction), disc.center
    if first is not None and excess[0] == 0 and sign(dot(minus(center, raw(start)), along)) <= 0:
        return [(start, start)]
    if last is not None and excess[1] == 0 and sign(dot(minus(center, raw(end)), along)) >= 0:
        return [(end, end)]
    return [(first or chord.crossing(-1), last or chord.crossing(1))]


class _Secant:
    """Where a segment's line meets a disc, in balls: as `_foot`."""

    def __init__(self, line: Segment, disc: Disc) -> None:
        self.line, self.disc = line, disc
        self.start, self.along = start, (u, v) = balls(line.start), balls(line.direction)
        x, y = disc.balls[0][0] - start[0], disc.balls[0][1] - start[1]
        height = u * y - v * x
        self.foot, self.square = x * u + y * v, u * u + v * v
        self.rest = self.square * disc.balls[1] - height * height

    def misses(self, start: Point, end: Point) -> bool:
        """Whether a piece of the line, both of whose ends are outside the disc, does not meet it."""
        if ball_sign(self.rest) < 0 or self._forward(start) < 0 or self._forward(end) > 0:
            return True
        if not self.has_foot_between(start, end):
            return True
        if ball_sign(self.rest) > 0:
            return False
        return sign(_foot(self.line, self.disc.center, self.disc.square)[2]) < 0

    def has_foot_between(self, start: Point, end: Point) -> bool:
        """Whether the foot of the centre lies between two points of the line."""
        along, center = raw(self.line.direction), self.disc.center
        before = self._forward(start) or sign(dot(minus(center, raw(start)), along))
        after = self._forward(end) or sign(dot(minus(center, raw(end)), along))
        return before > 0 > after

    def _forward(self, point: Point) -> int:
        """1 or -1 as the foot of the centre is clearly ahead of a point of the line or behind it, or 0."""
        x, y = balls(point)
        center = self.disc.balls[0]
        return ball_sign((center[0] - x) * self.along[0] + (center[1] - y) * self.along[1])

    def crossing(self, side: int) -> Point:
        """Where the line enters (-1) or leaves (1) the disc."""
        known = self.disc.known(self.line, self._around, side)
        if known is not None:
            return known
        return late_point(self._around(side), _on_line, self.line, self.disc.center, self.disc.square, side)

    def _around(self, side: int) -> Balls:
        share = (self.foot + self.rest.sqrt() * side) / self.square
        return self.start[0] + self.along[0] * share, self.start[1] + self.along[1] * share


def _foot(line: Segment, center: Vector, radius_sq: fmpq) -> tuple[Any, Any, Any]:
    """(f, q, r): the line is in range from the f - sqrt(r) to the f + sqrt(r) q-th parts of its vector."""
    along, offset = raw(line.direction), minus(center, raw(line.start))
    square, height = dot(along, along), cross(along, offset)
    return dot(offset, along), square, square * radius_sq - height * height


def _on_line(line: Segment, center: Vector, radius_sq: fmpq, side: int) -> Point:
    foot, square, rest = _foot(line, center, radius_sq)
    half = square_root(rest)
    is_rational = type(foot) is type(square) is fmpq
    share = half.affine(side / square, foot / square) if is_rational else (foot + half * side) / square
    return advance(raw(line.start), raw(line.direction), share)


# -- arcs ------------------------------------------------------------------------------------------


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


class _CircleCut:
    """Where an arc's circle meets a disc; w leads from the disc's centre to its own."""

    def __init__(self, arc: Arc, disc: Disc) -> None:
        self.arc, self.disc = arc, disc
        self.w: Vector = minus(raw(arc.center), disc.center)
        self.level = _level(arc, self.w, disc.square)

    def rest(self) -> int:
        """The sign of what is under the root: 0 if the circle touches the range, -1 if they do not meet."""
        return sign(self.arc.radius_sq * dot(self.w, self.w) - self.level * self.level)

    def touching(self) -> Point:
        """Where the circle touches the range from outside."""
        return advance(raw(self.arc.center), self.w, self.level / dot(self.w, self.w))

    def point(self, side: int) -> Point:
        """Where the circle leaves the range to the left (1) or right (-1) of w; a late point."""
        known = self.disc.known(self.arc, self._around, side)
        if known is not None:
            return known
        return late_point(self._around(side), _crossing, self.arc, self.w, self.level, side)

    def _around(self, side: int) -> Balls:
        x, y = balls(self.arc.center)
        u, v = x - self.disc.balls[0][0], y - self.disc.balls[0][1]
        square, radius_sq = u * u + v * v, arb(self.arc.radius_sq)
        level = (self.disc.balls[1] - square - radius_sq) / 2
        height = (radius_sq * square - level * level).sqrt() * side
        return x + (u * level - v * height) / square, y + (v * level + u * height) / square

    def is_point(self, point: Point, excess: int, side: int) -> bool:
        """Whether a point of the circle is its crossing of the range to the left (1) or right (-1) of w.

        Where the range only touches the circle, the two crossings are one point.
        """
        return excess == 0 and sign(cross(self.w, minus(raw(point), raw(self.arc.center)))) in (0, side)


def _of_arc(arc: Arc, ends: Span, excess: tuple[int, ...], disc: Disc, touch: Point | None) -> list[Span]:
    """Of the counterclockwise piece between two points of the circle."""
    first, last = ends
    at = _CircleCut(arc, disc)
    w = at.w
    if touch is not None:
        if max(excess) <= 0:
            # The disc contains the circle.
            return [ends]
        return _touched(ends, excess, [(touch, touch)] if _passes(arc, ends, (-w[0], -w[1])) else [])
    if max(excess) <= 0:
        if not (sign(w[0]) or sign(w[1])) or not _passes(arc, ends, w) or at.rest() <= 0:
            return [ends]
        left = last if at.is_point(last, excess[1], 1) else at.point(1)
        right = first if at.is_point(first, excess[0], -1) else at.point(-1)
        return [(first, right), (left, last)]
    if min(excess) > 0:
        rest = at.rest()
        if rest < 0 or not _passes(arc, ends, (-w[0], -w[1])):
            return []
        if rest == 0:
            point = at.touching()
            return [(point, point)]
        return [(at.point(1), at.point(-1))]
    if excess[0] <= 0:
        return [(first, first if at.is_point(first, excess[0], -1) else at.point(-1))]
    return [(last if at.is_point(last, excess[1], 1) else at.point(1), last)]


def _passes(arc: Arc, ends: Span, direction: Vector) -> bool:
    """Whether a direction, not 0, lies strictly between two points of the circle, counterclockwise."""
    center, first, last = (balls(p) for p in (arc.center, *ends))
    vector = ball_of(direction[0]), ball_of(direction[1])
    clear = clearly_between(from_to(center, first), from_to(center, last), vector)
    if clear is not None:
        return clear
    return spans(Arc(*ends, arc.center, arc.radius_sq, ccw=True), direction, strict=True)
