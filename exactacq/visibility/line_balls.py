"""Where lines meet curves, in balls: enclosures of what `chords.meet` gives exactly.

An exact place costs many times what its ball does, and most places are never asked for more than their
order along an edge. All arithmetic is that of `flint.arb`, which bounds its own errors.
"""

from __future__ import annotations

from typing import TypeAlias

from flint import arb

from exactacq.geometry.coordinates import minus, raw
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.late import Balls, ball_of, balls
from exactacq.numbers.rationals import ball_sign
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes, Turning

Line: TypeAlias = "tuple[arb, arb, arb, arb]"
"""Contact and direction."""


def line(sector: Sector, t: arb) -> Line:
    """The line of a sector at a parameter, as `Sector.touch` gives it."""
    cx, cy, ex, ey = sector.balls
    if type(sector) is Turning:
        # Of this kind are most.
        return cx, cy, ex - t * ey, ey + t * ex
    if isinstance(sector, Sliding):
        dx, dy = (-ey, ex) if sector.leftward else (ey, -ex)
        return cx + ex * t, cy + ey * t, dx, dy
    if isinstance(sector, Rolling):
        square = t * t
        growth = 1 + square
        cosine, sine = (1 - square) / growth, 2 * t / growth
        vx, vy = cosine * ex - sine * ey, cosine * ey + sine * ex
        return cx + vx, cy + vy, -vy, vx
    assert isinstance(sector, Spokes), "there are four kinds of sectors"
    dx, dy = ex - t * ey, ey + t * ex
    away = (ball_of(sector.radius_sq) / (dx * dx + dy * dy)).sqrt()
    x, y = cx + dx * away, cy + dy * away
    return (x, y, dx, dy) if sector.outward else (x, y, -dx, -dy)


def through(sector: Sector, point: Balls) -> list[arb] | None:
    """The parameters of the lines through a point, as `Sector.through` has them; None if that is open."""
    (x, y), (cx, cy, ex, ey) = point, sector.balls
    ox, oy, size = x - cx, y - cy, ex * ex + ey * ey
    along, across = ex * ox + ey * oy, ex * oy - ey * ox
    if isinstance(sector, Sliding):
        return [along / size]
    if not isinstance(sector, Rolling):
        return [across / along] if ball_sign(along) else None
    square, below = along * along + across * across - size * size, size + along
    if not (square > 0 and ball_sign(below)):
        return None
    root = square.sqrt()
    return [(across + root) / below, (across - root) / below]


class CurveBalls:
    """The image of a curve in balls."""

    __slots__ = ("_center", "_curve", "_radius_sq", "_start", "_way")

    def __init__(self, curve: Curve) -> None:
        self._curve = curve
        start, end = raw(curve.start), raw(curve.end)
        self._start = balls(curve.start)
        if isinstance(curve, Segment):
            x, y = minus(end, start)
            self._way = ball_of(x), ball_of(y)
        else:
            self._center, self._radius_sq = balls(curve.center), ball_of(curve.radius_sq)

    def met(self, at: Line, role: int) -> tuple[arb, Balls] | None:
        """How far along a line enters the obstacle, ahead (1) or back (-1), and where on the curve.

        None if no ball holds it: the line may run along the curve.
        """
        x, y, dx, dy = at
        if isinstance(self._curve, Segment):
            (sx, sy), (wx, wy) = self._start, self._way
            under = wx * dy - wy * dx
            ox, oy = x - sx, y - sy
            u, tau = (ox * dy - oy * dx) / under, (ox * wy - oy * wx) / under
            return (tau, (sx + wx * u, sy + wy * u)) if u.is_finite() else None
        cx, cy = self._center
        ox, oy, size = cx - x, cy - y, dx * dx + dy * dy
        across = ox * dy - oy * dx
        root = (size * self._radius_sq - across * across).nonnegative_part().sqrt()
        far = -role if self._curve.ccw else role
        tau = (ox * dx + oy * dy + far * root) / size
        return (tau, (x + dx * tau, y + dy * tau)) if tau.is_finite() else None
