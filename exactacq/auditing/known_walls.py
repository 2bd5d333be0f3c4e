"""Known pieces of boundaries as the only walls: whether a line of sight among them is free.

A line of sight may touch a wall, and may not cross it, from whichever side; nor may it enter the blocked
side, left of a piece, at a point of it. So what lies on a piece is seen from the free side only. Where the
knowledge ends one may look past; what lies there is seen as if its piece went straight on.

Two answers are given. `Walls.is_free` computes with balls of `PRECISION` bits: what they do not part by
then, more than `DIGITS` digits, counts as equal, so a sight that is made to touch a piece touches it.
`Walls.block` says in floats, of many lines of sight at once, which are certainly blocked.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import ceil, cos, pi, sin
from typing import NamedTuple

import numpy as np
from flint import arb

from exactacq.auditing.comparisons import BITS
from exactacq.auditing.hits import Bools, Floats, Ints, cross
from exactacq.geometry.box_index import bounds
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real

PRECISION = 2 * BITS
"""Working bits: the root of what vanishes to this precision still vanishes to `BITS`."""
SUBARC = pi / 8
"""Greatest angle of an arc that a chord stands for in floats."""
UNIT = 2.0**-46
"""Error of a coordinate, for size 1. Rounding is 2^-53; a point c + r (cos, sin) of an arc has an angle of at
most 3 pi, which as a sum of rounded parts is off by less than 2^-48."""
ROOM = 2.0**-46
"""Error of a cross product, for sizes of the scene and of the two vectors: see `Walls.block`."""
CHUNK, BATCH = 2048, 16
"""Sights and chords, of many of both, that are compared at once: a table that the processor's cache holds."""


class BallPoint(NamedTuple):
    """A point or a vector in balls."""

    x: arb
    y: arb

    def minus(self, other: BallPoint) -> BallPoint:
        return BallPoint(self.x - other.x, self.y - other.y)

    def along(self, way: BallPoint, t: arb) -> BallPoint:
        """The point that is t vectors farther."""
        return BallPoint(self.x + way.x * t, self.y + way.y * t)

    def dot(self, other: BallPoint) -> arb:
        return self.x * other.x + self.y * other.y

    def cross(self, other: BallPoint) -> arb:
        return self.x * other.y - self.y * other.x

    def left(self) -> BallPoint:
        return BallPoint(-self.y, self.x)

    def reversed(self) -> BallPoint:
        return BallPoint(-self.x, -self.y)


def ball_point(point: Point) -> BallPoint:
    return BallPoint(point.x.ball(PRECISION), point.y.ball(PRECISION))


def sign(ball: arb) -> int:
    """1 or -1, and 0 if the ball does not tell."""
    return 1 if ball > 0 else -1 if ball < 0 else 0


class Departure(NamedTuple):
    """How a curve leaves a point: the direction, and the curvature, positive to the left; 0 for a ray."""

    way: BallPoint
    bend: arb

    def turned_back(self) -> Departure:
        return Departure(self.way.reversed(), -self.bend)


UPRIGHT = tuple(Departure(BallPoint(arb(0), arb(y)), arb(0)) for y in (1, -1))
"""Up and down."""


class Wall:
    """A known piece in balls, with the blocked side on its left; ``target`` if it is of the obstacle sought.

    ``before`` and ``after`` are the pieces that join it at its start and its end; None where knowledge ends.
    """

    def __init__(self, curve: Curve, target: bool) -> None:
        self.curve, self.target = curve, target
        self.start, self.end = ball_point(curve.start), ball_point(curve.end)
        self.center: BallPoint | None = None
        self.sense = 0
        if isinstance(curve, Arc):
            self.center, self.sense = ball_point(curve.center), 1 if curve.ccw else -1
            self.square, self.radius = (Real(v).ball(PRECISION) for v in (curve.radius_sq, curve.radius))
            self.full = curve.full
        self.before: Wall | None = None
        self.after: Wall | None = None

    def germ(self, at: BallPoint) -> Departure:
        """How the piece runs on from one of its points."""
        if self.center is None:
            return Departure(self.end.minus(self.start), arb(0))
        radial = at.minus(self.center).left()
        return Departure(radial if self.sense > 0 else radial.reversed(), self.sense / self.radius)

    @property
    def sweep(self) -> arb:
        """The angle of an arc, negative if it is clockwise; 0 of a straight piece."""
        if self.center is None:
            return arb(0)
        if self.full:
            return 2 * arb.pi() * self.sense
        a, b = self.start.minus(self.center), self.end.minus(self.center)
        return self.sense * (arb.pi() + arb.atan2(-self.sense * a.cross(b), -a.dot(b)))

    def holds(self, point: BallPoint) -> bool:
        """Whether a point of the supporting line or circle is on the piece."""
        if self.center is None:
            chord = self.end.minus(self.start)
            offset = point.minus(self.start)
            return sign(chord.dot(offset)) >= 0 and sign(chord.dot(chord) - chord.dot(offset)) >= 0
        return self.full or self.side(point) <= 0

    def side(self, point: BallPoint) -> int:
        """-1, 0 or 1: a point of the circle is inside the arc, at one of its ends, or off it."""
        return sign(self.end.minus(self.start).cross(point.minus(self.start))) * self.sense

    def is_end(self, point: BallPoint) -> bool:
        return coincide(point, self.start) or coincide(point, self.end)


def coincide(a: BallPoint, b: BallPoint) -> bool:
    return not (sign(a.x - b.x) or sign(a.y - b.y))


class WallChord(NamedTuple):
    """A piece of a wall in floats, and how far it is from its chord."""

    start: tuple[float, float]
    end: tuple[float, float]
    bulge: float
    wall: int


def _chords(k: int, curve: Curve) -> Iterator[WallChord]:
    stroke = curve.stroke()
    if stroke.center is None:
        yield WallChord(stroke.start, stroke.end, 0.0, k)
        return
    (x, y), r = stroke.center, stroke.radius
    count = max(1, ceil(abs(stroke.sweep) / SUBARC))
    angles = [stroke.angle + stroke.sweep * n / count for n in range(count + 1)]
    points = [(x + r * cos(angle), y + r * sin(angle)) for angle in angles]
    bulge = r * (1 - cos(stroke.sweep / count / 2))
    for a, b in pairwise(points):
        yield WallChord(a, b, bulge, k)


class Walls:
    """The walls, exactly and in floats. ``size`` is that of all coordinates, ``grain`` an error of each."""

    def __init__(self, curves: Sequence[Curve], targets: int, size: float) -> None:
        self.list = [Wall(curve, k < targets) for k, curve in enumerate(curves)]
        self.size = size
        self.grain = UNIT * size
        self.boxes = bounds(curves)
        chords = [chord for k, curve in enumerate(curves) for chord in _chords(k, curve)]
        self.starts = np.array([chord.start for chord in chords]).reshape(-1, 2)
        self.ends = np.array([chord.end for chord in chords]).reshape(-1, 2)
        self.bulges = np.array([chord.bulge for chord in chords])
        self._blocked = np.zeros(len(chords), dtype=np.intp)

    def join(self) -> None:
        """Find which pieces join; done once, with the working precision set."""
        ends = np.array([[float(v) for at in (wall.start, wall.end) for v in at] for wall in self.list])
        ends = ends.reshape(-1, 4)
        close = np.abs(ends[:, None, 2:] - ends[None, :, :2]).max(axis=2, initial=0.0) <= 2 * self.grain
        for i, j in np.argwhere(close):
            one, two = self.list[i], self.list[j]
            if coincide(one.end, two.start):
                one.after, two.before = two, one

    # -- floats ------------------------------------------------------------------------------------

    def block(self, p: Floats, q: Floats, error: Floats) -> Bools:
        """Which segments from p to q certainly cross a wall, where both ends are known up to an *error*.

        Of a chord from a to b with a bulge s let all four, a and b beside pq, p and q beside ab, be farther
        than twice the error from the other line, p and q by s more, and on opposite sides. Then the two
        segments cross, also if each end is moved by the error: no end comes to the other segment on the way.
        And p and q lie outside of what the arc and the chord enclose: there the sight, which comes in through
        the chord, goes out through the arc.

        Distances are cross products over lengths. Coordinates of size S are off by 2^-53 S, so differences by
        2^-51 S; the product of two of lengths l and m is off by 2^-51 S (l + m) + 2^-51 l m, less than
        2^-49 S (l + m). `ROOM` is eight times that. The error is at least the grain, which covers a and b.
        """
        found = np.zeros(len(p), dtype=bool)
        # What has blocked most comes first: few segments are left for the other chords.
        order = np.argsort(-self._blocked, kind="stable")
        while len(order) and len(left := np.flatnonzero(~found)):
            width = max(BATCH, CHUNK * BATCH // len(left))
            some, order = order[:width], order[width:]
            for k in range(0, len(left), CHUNK):
                rows = left[k : k + CHUNK]
                crossed = self._crossed(p[rows, None], q[rows, None], error[rows, None], some)
                found[rows] = crossed.any(axis=1)
                self._blocked[some] += crossed.sum(axis=0)
        return found

    def _crossed(self, p: Floats, q: Floats, error: Floats, some: Ints) -> Bools:
        """Which segments certainly cross which of some chords."""
        starts, ends = self.starts[some], self.ends[some]
        sight, chord = q - p, ends - starts
        length, width = np.hypot(*np.moveaxis(sight, -1, 0)), np.hypot(*chord.T)
        to_start, to_end = starts - p, ends - p
        far = np.hypot(*np.moveaxis(to_start, -1, 0)) + width
        error = np.maximum(error, self.grain)
        room = ROOM * self.size
        least = 2 * error * length + room * (length + far)
        one, two = cross(sight, to_start), cross(sight, to_end)
        beside = (np.minimum(one, two) < -least) & (np.maximum(one, two) > least)
        least = (2 * error + self.bulges[some]) * width + room * (width + far + length)
        one, two = -cross(chord, to_start), cross(chord, q - starts)
        across = (np.minimum(one, two) < -least) & (np.maximum(one, two) > least)
        crossed: Bools = beside & across
        return crossed

    # -- balls -------------------------------------------------------------------------------------

    def is_free(self, p: BallPoint, q: BallPoint, leaves_any_side: bool = False) -> bool:
        """Whether the way from a place p to a known point q crosses no wall and enters no blocked side.

        With *leaves_any_side* it may enter what is blocked at p, if to go up or down enters it too: then
        p is the end of a stretch of a vertical line that lies within what a wall bounds.
        """
        sight = q.minus(p)
        if not (sign(sight.x) or sign(sight.y)):
            return True
        return not any(self._stops(p, q, sight, wall, leaves_any_side) for wall in self._near(p, q))

    def _near(self, p: BallPoint, q: BallPoint) -> list[Wall]:
        """The walls whose boxes come near that of a segment."""
        (a, b), (c, d) = ((float(s.x), float(s.y)) for s in (p, q))
        boxes, pad = self.boxes, 4 * self.grain
        apart = (boxes[:, 0] > max(a, c) + pad) | (boxes[:, 2] < min(a, c) - pad)
        apart |= (boxes[:, 1] > max(b, d) + pad) | (boxes[:, 3] < min(b, d) - pad)
        return [self.list[k] for k in np.flatnonzero(~apart)]

    def _stops(self, p: BallPoint, q: BallPoint, sight: BallPoint, wall: Wall, lax: bool) -> bool:
        for end, is_start in ((wall.start, True), (wall.end, False)):
            if _is_on(p, q, sight, end) and self._is_entered(p, q, sight, wall, end, is_start, lax):
                return True
        crosses = _is_crossed if wall.center is None else _is_cut
        return crosses(p, q, sight, wall, lax)

    def _is_entered(
        self,
        p: BallPoint,
        q: BallPoint,
        sight: BallPoint,
        wall: Wall,
        end: BallPoint,
        is_start: bool,
        lax: bool,
    ) -> bool:
        """Whether a sight that passes an end of a wall enters what is blocked there."""
        at_goal, at_place = coincide(end, q), coincide(end, p)
        other = wall.before if is_start else wall.after
        if other is None and not at_goal:
            return False
        own = wall.germ(end) if is_start else wall.germ(end).turned_back()
        beside = None if other is None else other.germ(end).turned_back() if is_start else other.germ(end)
        if beside is None:
            beside = Departure(own.way.reversed(), arb(0))
        leave, back = (own, beside) if is_start else (beside, own)
        within = at_place and lax and any(_lies_between(leave, ray, back) for ray in UPRIGHT)
        ways = [] if at_goal or within else [sight]
        ways += [] if at_place else [sight.reversed()]
        return any(_lies_between(leave, Departure(way, arb(0)), back) for way in ways)


def _is_on(p: BallPoint, q: BallPoint, sight: BallPoint, point: BallPoint) -> bool:
    """Whether a point is on the segment from p to q."""
    if sign(sight.cross(point.minus(p))):
        return False
    return sign(sight.dot(point.minus(p))) >= 0 and sign(sight.dot(q.minus(point))) >= 0


def _is_crossed(p: BallPoint, q: BallPoint, sight: BallPoint, wall: Wall, lax: bool) -> bool:
    """Whether a sight crosses a straight wall inside both, or begins or ends there on the blocked side."""
    if sign(sight.cross(wall.start.minus(p))) * sign(sight.cross(wall.end.minus(p))) >= 0:
        return False
    chord = wall.end.minus(wall.start)
    here, there = sign(chord.cross(p.minus(wall.start))), sign(chord.cross(q.minus(wall.start)))
    within = lax and sign(chord.x)
    return here * there < 0 or (not here and there > 0 and not within) or (not there and here > 0)


def _is_cut(p: BallPoint, q: BallPoint, sight: BallPoint, wall: Wall, lax: bool) -> bool:
    """Whether a sight crosses an arc so: the line p + t sight at its two points, or where it touches.

    Where it comes into the circle it leaves the blocked side of a clockwise arc; a line that touches one from
    without is on the blocked side all along.
    """
    assert wall.center is not None
    offset, size = wall.center.minus(p), sight.dot(sight)
    within = lax and (wall.sense < 0 or sign(offset.y) != 0)
    along, aside = sight.dot(offset), sight.cross(offset)
    square = wall.square * size - aside * aside
    if sign(square) < 0:
        return False
    if not sign(square):
        t = along / size
        touches = sign(t) >= (1 if within else 0) and sign(1 - t) >= 0 and _is_inner(wall, p.along(sight, t))
        return touches and wall.sense < 0
    root = square.sqrt()
    for t, goes_in in (((along - root) / size, True), ((along + root) / size, False)):
        begins, ends = sign(t), sign(1 - t)
        if begins < 0 or ends < 0 or (within and not begins) or not _is_inner(wall, p.along(sight, t)):
            continue
        if (begins and ends) or goes_in is (wall.sense > 0 if not begins else wall.sense < 0):
            return True
    return False


def _is_inner(wall: Wall, point: BallPoint) -> bool:
    """Whether a point of the circle is on the arc and not an end of it."""
    return not coincide(point, wall.start) if wall.full else wall.side(point) < 0


def _lies_between(leave: Departure, ray: Departure, back: Departure) -> bool:
    """Whether a ray lies strictly between two curves from its start, counterclockwise from *leave*."""
    to_ray, to_back = _turn(leave, ray), _turn(leave, back)
    if to_ray == 0 or to_ray > to_back:
        return False
    return to_ray < to_back or _turn(ray, back) in (1, 2)


def _turn(a: Departure, b: Departure) -> int:
    """How far b is counterclockwise of a: 0 not at all, 1 a bend, 2 less than half a turn, 3 half a turn,
    4 more, 5 a full turn but for a bend."""
    side = sign(a.way.cross(b.way))
    if side:
        return 2 if side > 0 else 4
    if sign(a.way.dot(b.way)) < 0:
        return 3
    return (0, 1, 5)[sign(b.bend - a.bend)]
