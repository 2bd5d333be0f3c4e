"""How fast a line of sight grows along the walk, in balls: a proof of its sign, or none.

The line starts at p = (x, y), has the unit direction e, passes a feature's centre c at the constant signed
distance n.(c - p) = -turn with n = e turned left, and ends at q = p + l e on a target with tangent f. With
p' = (0, 1) it turns at the rate w = -n_y / (e.(c - p)), and q' parallel to f gives
l' = -((p' + l w n) x f) / (e x f).
"""

from __future__ import annotations

from flint import arb, ctx

from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real

BITS = 128


def growth_sign(
    x: Real, ordinates: tuple[Real, Real], shape: tuple[Point, Real], target: Curve, length: Real
) -> int:
    """The sign of l' at all ordinates between two; 0 if the balls do not tell.

    *shape* is a feature's centre with the signed turn; *length* is l at one of the ordinates: it tells
    which of the two points of a circle is meant.
    """
    with ctx.workprec(BITS):
        rate = _rate(_ball(x), _ball(ordinates[0]).union(_ball(ordinates[1])), shape, target, _ball(length))
    return 0 if rate is None else int(rate > 0) - int(rate < 0)


def _rate(x: arb, y: arb, shape: tuple[Point, Real], target: Curve, near: arb) -> arb | None:
    """l', or None where the end of the line is not one point."""
    center, turn = shape
    dx, dy, k = _ball(center.x) - x, _ball(center.y) - y, _ball(turn)
    square = dx * dx + dy * dy
    before = (square - k * k).sqrt()
    # d = e (before - i turn), as complex numbers.
    ex, ey = (dx * before - dy * k) / square, (dy * before + dx * k) / square
    if isinstance(target, Arc):
        mx, my = _ball(target.center.x) - x, _ball(target.center.y) - y
        foot = mx * ex + my * ey
        half = (foot * foot - mx * mx - my * my + _ball(Real(target.radius_sq))).sqrt()
        ends = [end for end in (foot - half, foot + half) if end.overlaps(near)]
        if len(ends) != 1:
            return None
        length = ends[0]
        fx, fy = -(ey * length - my), ex * length - mx
    else:
        ax, ay = _ball(target.start.x) - x, _ball(target.start.y) - y
        fx, fy = _ball(target.direction.x), _ball(target.direction.y)
        length = (ax * fy - ay * fx) / (ex * fy - ey * fx)
    turning = -ex / before
    vx, vy = -ey * length * turning, 1 + ex * length * turning
    return -(vx * fy - vy * fx) / (ex * fy - ey * fx)


def _ball(value: Real) -> arb:
    return value.working_ball(BITS)
