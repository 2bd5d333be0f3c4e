"""Where lines meet curves, in balls: enclosures of what `chords.meet` and `Rail.parameter` give exactly.

An exact place costs many times what its ball does, and most places are never asked for more than their
order along an edge. All arithmetic is that of `flint.arb`, which bounds its own errors. What a ball cannot
hold, because a line may run along an edge or a full circle's start may be passed, is None.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from flint import arb

from exactacq.geometry.coordinates import minus, raw
from exactacq.geometry.curves import Curve, Segment
from exactacq.numbers.real import Real
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes

Line: TypeAlias = "tuple[arb, arb, arb, arb]"
"""Contact and direction."""
Spot: TypeAlias = "tuple[arb, arb, arb]"
"""Coordinates of a place on a curve and its parameter there."""
BITS = 64


def number(value: Any) -> arb:
    """The ball of a coordinate."""
    return value.ball(BITS) if isinstance(value, Real) else arb(value)


def line(sector: Sector, t: arb) -> Line:
    """The line of a sector at a parameter, as `Sector.touch` gives it."""
    cx, cy, ex, ey = sector.balls
    if isinstance(sector, Sliding):
        dx, dy = (-ey, ex) if sector.leftward else (ey, -ex)
        return cx + ex * t, cy + ey * t, dx, dy
    if isinstance(sector, Rolling):
        square = t * t
        growth = 1 + square
        cosine, sine = (1 - square) / growth, 2 * t / growth
        vx, vy = cosine * ex - sine * ey, cosine * ey + sine * ex
        return cx + vx, cy + vy, -vy, vx
    dx, dy = ex - t * ey, ey + t * ex
    if isinstance(sector, Spokes):
        away = (number(sector.radius_sq) / (dx * dx + dy * dy)).sqrt()
        x, y = cx + dx * away, cy + dy * away
        return (x, y, dx, dy) if sector.outward else (x, y, -dx, -dy)
    return cx, cy, dx, dy


class CurveBalls:
    """The image of a curve in balls."""

    __slots__ = ("_bases", "_center", "_curve", "_radius_sq", "_start", "_way")

    def __init__(self, curve: Curve) -> None:
        self._curve = curve
        start, end = raw(curve.start), raw(curve.end)
        self._start = number(start[0]), number(start[1])
        if isinstance(curve, Segment):
            x, y = minus(end, start)
            self._way = number(x), number(y)
            return
        center = raw(curve.center)
        self._center, self._radius_sq = (number(center[0]), number(center[1])), number(curve.radius_sq)
        (x, y), turn = minus(start, center), 1 if curve.ccw else -1
        bases = [(x, y), (-y * turn, x * turn), (-x, -y), (y * turn, -x * turn)]
        self._bases = [(number(a), number(b)) for a, b in bases]

    def met(self, at: Line, role: int) -> tuple[arb, Spot] | None:
        """How far along a line enters the obstacle, ahead (1) or back (-1), and where on the curve."""
        x, y, dx, dy = at
        if isinstance(self._curve, Segment):
            (sx, sy), (wx, wy) = self._start, self._way
            under = wx * dy - wy * dx
            ox, oy = x - sx, y - sy
            u, tau = (ox * dy - oy * dx) / under, (ox * wy - oy * wx) / under
            return (tau, (sx + wx * u, sy + wy * u, u)) if u.is_finite() else None
        cx, cy = self._center
        ox, oy, size = cx - x, cy - y, dx * dx + dy * dy
        across = ox * dy - oy * dx
        root = (size * self._radius_sq - across * across).nonnegative_part().sqrt()
        far = -role if self._curve.ccw else role
        tau = (ox * dx + oy * dy + far * root) / size
        if not tau.is_finite():
            return None
        px, py = x + dx * tau, y + dy * tau
        u = self.parameter(px, py)
        return None if u is None else (tau, (px, py, u))

    def place(self, x: arb, y: arb) -> Spot | None:
        """A point of the curve with its parameter."""
        u = self.parameter(x, y)
        return None if u is None else (x, y, u)

    def parameter(self, x: arb, y: arb) -> arb | None:
        """The parameter of a point of the curve; None where it may lie on either side of an arc's start."""
        if isinstance(self._curve, Segment):
            (sx, sy), (wx, wy) = self._start, self._way
            u = (x - sx) / wx if abs(wx) > abs(wy) else (y - sy) / wy
            return u if u.is_finite() else None
        cx, cy = self._center
        vx, vy = x - cx, y - cy
        sense = 1 if self._curve.ccw else -1
        found: arb | None = None
        quarters = []
        for k, (bx, by) in enumerate(self._bases):
            along, across = bx * vx + by * vy, (bx * vy - by * vx) * sense
            if along <= 0 or across < 0:
                continue
            u = k + across / (self._radius_sq + along)
            if not u.is_finite():
                return None
            quarters.append(k)
            found = u if found is None else found.union(u)
        return None if quarters in ([0, 3], []) or len(quarters) > 2 else found
