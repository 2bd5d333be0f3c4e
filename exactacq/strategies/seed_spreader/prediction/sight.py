"""The exact part of predictions: the walk, whether a line of sight from it is free, and how fast it grows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from flint import arb, fmpq

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import ContactKind, Touched, contacts
from exactacq.geometry.points import Point
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.precision import workprec
from exactacq.numbers.real import Real
from exactacq.strategies.seed_spreader.hulls import ConvexHull, overlap
from exactacq.strategies.seed_spreader.prediction.pieces import Pieces


class VerticalWalk:
    """A walk up or down a vertical line at abscissa *x*, from ordinate *start* to *stop*, and the range."""

    def __init__(self, x: fmpq, start: Real, stop: Real | fmpq, radius: fmpq, including: bool) -> None:
        self.x, self.start, self.stop, self.radius = x, start, stop, radius
        self.including = including
        # 1 up, -1 down; a walk of one place counts as up.
        self.sense = Real(stop).compare(start) or 1
        self.reach = float(radius) * (1 + 1e-9)
        self.low, self.high = sorted((float(start), float(stop)))

    def passes(self, y: Real) -> bool:
        """Whether an ordinate lies beyond the start, or there if *including*, and not beyond the stop."""
        order = y.compare(self.start)
        return (
            order in (self.sense, 0 if self.including else self.sense) and y.compare(self.stop) != self.sense
        )

    def may_reach(self, place: tuple[float, ...]) -> bool:
        """Whether a box may be within range."""
        x, r = float(self.x), self.reach
        return overlap(place, (x - r, self.low - r, x + r, self.high + r))

    def field(self, hulls: Sequence[tuple[float, ...]]) -> tuple[float, float, float, float]:
        """A box around all lines of sight to boxes."""
        x, r = float(self.x), self.reach
        a, b, c, d = (f(h[k] for h in hulls) for k, f in enumerate((min, min, max, max)))
        low, high = max(self.low, b - r), min(self.high, d + r)
        left, right = max(min(x, a), x - r), min(max(x, c), x + r)
        pad = self._pad(low, high)
        bottom, top = min(low, max(b, low - r)), max(high, min(d, high + r))
        return left - pad, bottom - pad, right + pad, top + pad

    def corridor(self, hulls: Sequence[tuple[float, ...]], field: Sequence[float]) -> ConvexHull:
        """The convex hull of all lines of sight to boxes; *field* is the box around these."""
        x, low, high = float(self.x), max(self.low, field[1]), min(self.high, field[3])
        corners = [(u, v) for a, b, c, d in hulls for u in (a, c) for v in (b, d)]
        pad = self._pad(low, high) + 1e-9 * max(abs(c) for corner in corners for c in corner)
        return ConvexHull([*corners, (x, low), (x, high)], margin(pad))

    def _pad(self, low: float, high: float) -> float:
        return 1e-9 * (self.reach + abs(float(self.x)) + abs(low) + abs(high))


def unique(curves: Sequence[Curve]) -> Iterator[Curve]:
    """Each curve once."""
    seen = set()
    for curve in curves:
        sense = curve.ccw if isinstance(curve, Arc) else None
        size = (curve.center.key, curve.radius_sq) if isinstance(curve, Arc) else None
        key = curve.start.key, curve.end.key, sense, size
        if key not in seen:
            seen.add(key)
            yield curve


# -- one line of sight ----------------------------------------------------------------------------


class _Germ(NamedTuple):
    """A curve as it leaves a point: its direction, and its curvature to the left, or a number ordered alike.

    Those that are known to run *along* the line of sight have one direction, or opposite ones.
    """

    way: Point
    curvature: fmpq
    along: bool = False


def _enters(leave: _Germ, back: _Germ, way: Point) -> bool:
    """Whether a ray leaves a point strictly between two curves, counterclockwise from leave to back."""
    ray = _Germ(way, fmpq(0), along=True)
    to_ray, to_back = _turn(leave, ray), _turn(leave, back)
    if not to_ray or to_ray > to_back:
        return False
    return to_ray < to_back or _turn(ray, back) in {1, 2}


def _turn(a: _Germ, b: _Germ) -> int:
    """Rank of the counterclockwise turn from a to b: 2, 3 or 4 if it is less than half a turn, half, or more.

    Where both have one direction, 0 if their curvatures are equal, 1 if b curves to the left of a, else 5.
    """
    side = 0 if a.along and b.along else a.way.cross(b.way).sign()
    if side:
        return 3 - side
    if a.way.dot(b.way).sign() < 0:
        return 3
    return 0 if a.curvature == b.curvature else 1 if b.curvature > a.curvature else 5


def _germ(curve: Curve, at: Point, on: Touched) -> _Germ:
    """A curve as it runs on from one of its points, through which a line goes that touches *on*."""
    if isinstance(curve, Segment):
        return _Germ(curve.whole.direction, fmpq(0))
    # A line that touches a circle meets it once, so it does here.
    along, curvature = any(curve is one for one in on), (1 if curve.ccw else -1) / curve.radius_sq
    return _Germ(curve.tangent(at), curvature, along)


def _reversed(germ: _Germ) -> _Germ:
    return _Germ(-germ.way, -germ.curvature, germ.along)


class Sights:
    """Decides lines of sight among known pieces."""

    def __init__(self, pieces: Pieces) -> None:
        self.pieces = pieces

    def is_free(self, p: Point, q: Point, on: Touched = ()) -> bool:
        """Whether the segment from a place p to a point q of a boundary nowhere enters the blocked side.

        *on* is what its line is known to touch.
        """
        if p == q:
            return True
        sight = Segment(p, q)
        near = self.pieces.possible(np.array(p.xy), np.array(q.xy))
        return all(self._passes(sight, int(k), on) for k in near)

    def _passes(self, sight: Segment, k: int, on: Touched) -> bool:
        found = contacts(sight, self.pieces.curves[k], on)
        if any(contact.kind is ContactKind.CROSSING for contact in found):
            return False
        return all(self._may_pass(sight, k, z, on) for contact in found for z in contact.places)

    def _may_pass(self, sight: Segment, k: int, z: Point, on: Touched) -> bool:
        """Whether a sight that touches a piece at a point does not enter the blocked side there."""
        curves, curve = self.pieces.curves, self.pieces.curves[k]
        at_end, at_begin = z == sight.end, z == sight.start
        leave, back = None, None
        if z == curve.start:
            leave, other = _germ(curve, z, on), int(self.pieces.before[k])
            back = None if other < 0 else _reversed(_germ(curves[other], z, on))
        elif z == curve.end:
            back, other = _reversed(_germ(curve, z, on)), int(self.pieces.after[k])
            leave = None if other < 0 else _germ(curves[other], z, on)
        else:
            leave = _germ(curve, z, on)
            back = _reversed(leave)
        if (leave is None or back is None) and not at_end:
            # Sights past a lone end from places beside this one are free: so is this one, their limit.
            return True
        # At a lone end that is looked at, the boundary is taken to go straight on.
        leave = _Germ(-back.way, fmpq(0), back.along) if leave is None and back is not None else leave
        # Each of the three cases above knows one of the two germs.
        assert leave is not None
        back = _Germ(-leave.way, fmpq(0), leave.along) if back is None else back
        ways = [] if at_end else [sight.direction]
        ways += [] if at_begin else [-sight.direction]
        return not any(_enters(leave, back, way) for way in ways)


BITS = 128


def growth(
    x: Real, ordinates: tuple[Real, Real], shape: tuple[Point, Real], target: Curve, length: Real
) -> tuple[arb, arb]:
    """Balls around l and l', how long a line of sight is and how fast it grows along the walk, at all
    ordinates between two; no numbers where balls do not tell.

    *shape* is a feature's centre with the signed turn; *length* is l at one of the ordinates: it tells
    which of the two points of a circle is meant.

    The line starts at p = (x, y), has the unit direction e, passes a feature's centre c at the constant
    signed distance n.(c - p) = -turn with n = e turned left, and ends at q = p + l e on a target with tangent
    f. With p' = (0, 1) it turns at the rate w = -n_y / (e.(c - p)), and q' parallel to f gives
    l' = -((p' + l w n) x f) / (e x f).
    """
    with workprec(BITS):
        y = _ball(ordinates[0]).union(_ball(ordinates[1]))
        return _growth(_ball(x), y, shape, target, _ball(length))


def _growth(x: arb, y: arb, shape: tuple[Point, Real], target: Curve, near: arb) -> tuple[arb, arb]:
    center, turn = shape
    dx, dy, k = _ball(center.x) - x, _ball(center.y) - y, _ball(turn)
    square = dx * dx + dy * dy
    before = (square - k * k).nonnegative_part().sqrt()
    if isinstance(target, Arc) and turn * turn == target.radius_sq and center == target.center:
        # The tangent of the target's own circle ends where it touches it.
        return before, -dy / before
    # d = e (before - i turn), as complex numbers.
    ex, ey = (dx * before - dy * k) / square, (dy * before + dx * k) / square
    if isinstance(target, Arc):
        mx, my = _ball(target.center.x) - x, _ball(target.center.y) - y
        foot = mx * ex + my * ey
        rest = foot * foot - mx * mx - my * my + _ball(Real(target.radius_sq))
        half = rest.nonnegative_part().sqrt()
        back, front = foot - half, foot + half
        along = back if not front.overlaps(near) else front if not back.overlaps(near) else back.union(front)
        fx, fy = -(ey * along - my), ex * along - mx
    else:
        ax, ay = _ball(target.start.x) - x, _ball(target.start.y) - y
        fx, fy = _ball(target.direction.x), _ball(target.direction.y)
        along = (ax * fy - ay * fx) / (ex * fy - ey * fx)
    turning = -ex / before
    vx, vy = -ey * along * turning, 1 + ex * along * turning
    return along, -(vx * fy - vy * fx) / (ex * fy - ey * fx)


def _ball(value: Real) -> arb:
    return value.working_ball(BITS)
