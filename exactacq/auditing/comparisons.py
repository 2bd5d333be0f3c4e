"""What the checks of the audit share: lengths re-added in balls, comparisons of points, names in messages.

Places that are not rational are compared at `DIGITS` digits: there a deviation beyond them is not found.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from math import ceil, log2
from typing import NamedTuple, TypeAlias

from flint import arb, fmpq

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import rational
from exactacq.sensing.event import Event
from exactacq.strategies.run import Run

DIGITS = 500
"""Decimals to which lengths are re-added, and at least to which irrational places are compared."""
SPARE = 256
"""Bits that cover cancellation."""
BITS = ceil(DIGITS * log2(10)) + SPARE
"""First working precision."""


class Track(NamedTuple):
    """The edge of the scene on which a boundary piece lies, and whether it follows the edge's sense."""

    edge: int
    forward: bool


Tracks: TypeAlias = "list[Track | None]"


class AuditedBody(NamedTuple):
    """A boundary that the robot can walk, number ``number`` of a run: ``curves``, a loop if ``closed``.

    ``edges`` are the numbers of the scene's edges on which the curves lie, all of obstacle ``obstacle``.
    """

    number: int
    obstacle: int
    curves: Sequence[Curve]
    edges: Sequence[int]
    closed: bool


def refined(compute: Callable[[int], arb]) -> arb:
    """A ball computed with enough working bits to know `DIGITS` decimals."""
    bits = BITS
    while True:
        with workprec(bits):
            ball = compute(bits)
            if ball.is_finite() and ball.rad() < arb(10) ** -DIGITS:
                return ball
        bits *= 2


def _difference(a: Point, b: Point, bits: int) -> tuple[arb, arb]:
    return a.x.ball(bits) - b.x.ball(bits), a.y.ball(bits) - b.y.ball(bits)


def ball_to(curve: Curve, point: Point, bits: int) -> arb:
    """Length of a curve from its start to a point of it, 0 to the start itself."""
    if same(point, curve.start):
        return arb(0)
    if isinstance(curve, Segment):
        x, y = _difference(point, curve.start, bits)
        return (x * x + y * y).sqrt()
    a, b = (_difference(p, curve.center, bits) for p in (curve.start, point))
    sine = a[0] * b[1] - a[1] * b[0]
    # From 0 to a full turn, with the cut of the arc tangent at the start.
    angle = arb.pi() + arb.atan2(-sine if curve.ccw else sine, -(a[0] * b[0] + a[1] * b[1]))
    return arb(curve.radius_sq).sqrt() * angle


def ball_of(curve: Curve, bits: int) -> arb:
    """Length of a curve: sqrt(dx^2 + dy^2), or radius times angle."""
    if isinstance(curve, Arc) and (curve.full or same(curve.start, curve.end)):
        return 2 * arb.pi() * arb(curve.radius_sq).sqrt()
    return ball_to(curve, curve.end, bits)


def ball_sum(curves: Sequence[Curve]) -> arb:
    return refined(lambda bits: sum((ball_of(curve, bits) for curve in curves), arb(0)))


def is_shorter_way(walk: Sequence[Curve], whole: arb, senses: Collection[bool]) -> bool:
    """Whether a walk along part of a loop is the shorter way, of two equal ones that in the loop's sense."""
    walked = ball_sum(walk)
    with workprec(BITS):
        rest = whole - walked
    return not walked > rest and (walked < rest or set(senses) <= {True})


def agrees(length: Length, ball: arb) -> bool:
    """Whether a length and a ball agree to `DIGITS` decimals."""
    with workprec(BITS):
        low, high = length.enclosure(BITS - SPARE)
        return not (arb(high) < ball or arb(low) > ball)


def is_close(a: arb, b: arb) -> bool:
    """Whether two balls do not exclude that they are equal."""
    return not (a < b or a > b)


def same(a: Point, b: Point) -> bool:
    """Whether two points are equal: by their form if that shows it, else decided."""
    return a is b or a.key == b.key or a == b


def passes(curve: Curve, point: Point) -> bool:
    """Whether a curve contains a point: exactly if it is rational, else to `DIGITS` digits at least."""
    if point is curve.start or point is curve.end:
        return True
    rational = point.rational
    # Another point: what this one is said to have been made on does not count.
    return curve.may_pass(point, BITS) if rational is None else curve.passes(Point(*rational))


def place_text(point: Point) -> str:
    x, y = point.xy
    return f"({x:.15g}, {y:.15g})"


def event_name(run: Run, event: Event) -> str:
    number = next(k for k, other in enumerate(run.events) if other is event)
    about = "" if event.obstacle is None else f" of obstacle {event.obstacle}"
    return f"event {number} ({event.kind}{about})"


def event_position(run: Run, event: Event) -> tuple[int, arb]:
    """Number of whole pieces, and the way along the next one."""
    if not event.inside:
        return event.after, arb(0)
    curve = run.path[event.after].curve
    return event.after, refined(lambda bits: ball_to(curve, event.point, bits))


def is_part(curve: Curve, edge: Curve) -> bool:
    """Whether a curve is a part of an edge, longer than a point, in the edge's sense."""
    if isinstance(curve, Segment) and isinstance(edge, Segment):
        ends_match = all(edge.may_pass(p, 64) and passes(edge, p) for p in (curve.start, curve.end))
        return ends_match and curve.direction.dot(edge.direction).sign() > 0
    if isinstance(curve, Segment) or isinstance(edge, Segment):
        return False
    if (curve.ccw, curve.radius_sq) != (edge.ccw, edge.radius_sq) or not same(curve.center, edge.center):
        return False
    if same(curve.start, edge.start) and same(curve.end, edge.end):
        return curve.full == edge.full
    if curve.full or not all(edge.may_pass(p, 64) and passes(edge, p) for p in (curve.start, curve.end)):
        return edge.full and passes(edge, curve.start)
    if edge.full or same(curve.start, edge.start) or same(curve.end, edge.end):
        return True
    reverse = same(curve.start, edge.end) or same(curve.end, edge.start)
    return not reverse and edge.part(edge.start, curve.end).contains(curve.start)


def rational_on(segment: Segment, share: fmpq) -> Point | None:
    """A rational point at about a share of a segment with rational ends or along an axis, else None."""
    place = segment.point(share)
    if place.rational is not None:
        return place
    x, y = (c.rational for c in segment.start)
    if x is not None and segment.direction.x.rational == 0:
        place = Point(x, rational(float(place.y)))
    elif y is not None and segment.direction.y.rational == 0:
        place = Point(rational(float(place.x)), y)
    else:
        return None
    return place if segment.contains(place) else None
