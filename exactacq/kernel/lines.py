"""Lines of a sector and where they meet curves, in floats with bounds, by the rules of `kernel.bounded`.

Coordinates and vectors of a scene come in as floats that are off by `UNIT` of themselves at most: those of
boundaries are the nearest ones, those of a robot's way nearly so.
"""

from __future__ import annotations

from math import inf
from typing import Final

from exactacq.kernel.bounded import (
    TINY,
    UNIT,
    WIDEN,
    cross,
    dot,
    length,
    product,
    quotient,
    root,
    total,
    verdict,
)
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.images import ROLLING, SLIDING, TURNING

Frame = tuple[int, float, float, float, float, float, int]
"""A sector: its kind, centre, base vector and, of normals, the arc's radius and the sense in which they go
(see `exactacq.kernel.images.LineFrame`)."""
Line = tuple[float, float, float, float, float, float]
"""Contact and direction, the coordinates of each held with one bound."""
Meeting = tuple[float, float, float, float, float, float, float]
"""How far along a line, in lengths, a curve is met, with bound; the parameter there, with bound; the point,
its coordinates held with one bound. An infinite bound: unknown."""

UNKNOWN: Meeting = (0.0, inf, 0.0, inf, 0.0, 0.0, inf)
QUARTERS: Final = 4


def line_at(frame: Frame, t: float, te: float) -> Line:
    """The line at a parameter that is held with *te*."""
    kind, cx, cy, ex, ey, radius, sense = frame
    ce, ee = UNIT * max(abs(cx), abs(cy)) + TINY, UNIT * max(abs(ex), abs(ey)) + TINY
    if kind == SLIDING:
        x, y, e = _moved(cx, cy, ce, ex, ey, ee, t, te)
        return x, y, -ey * sense, ex * sense, e, ee
    if kind == ROLLING:
        square, bound = product(t, te, t, te)
        below, below_bound = total(1.0, 0.0, square, bound)
        top, top_bound = total(1.0, 0.0, -square, bound)
        cosine, cosine_bound = quotient(top, top_bound, below, below_bound)
        sine, sine_bound = quotient(2.0 * t, 2.0 * te, below, below_bound)
        vx, vy, ve = _moved(0.0, 0.0, 0.0, ex, ey, ee, cosine, cosine_bound)
        vx, vy, ve = _moved(vx, vy, ve, -ey, ex, ee, sine, sine_bound)
        x, y, e = _moved(cx, cy, ce, vx, vy, ve, 1.0, 0.0)
        return x, y, -vy, vx, e, ve
    dx, dy, de = _moved(ex, ey, ee, -ey, ex, ee, t, te)
    if kind == TURNING:
        return cx, cy, dx, dy, ce, de
    size, size_bound = length(dx, dy, de)
    away, away_bound = quotient(radius, UNIT * radius, size, size_bound)
    x, y, e = _moved(cx, cy, ce, dx, dy, de, away, away_bound)
    return x, y, dx * sense, dy * sense, e, de


def _moved(
    x: float, y: float, e: float, dx: float, dy: float, de: float, t: float, te: float
) -> tuple[float, float, float]:
    """A point moved by a multiple of a vector."""
    px, p = product(dx, de, t, te)
    py, q = product(dy, de, t, te)
    x, p = total(x, e, px, p)
    y, q = total(y, e, py, q)
    return x, y, max(p, q)


def rounding(x: float, y: float) -> float:
    """How far off the nearest floats of a place of the scene may be."""
    return UNIT * max(abs(x), abs(y)) + TINY


def side_of(line: Line, x: float, y: float, error: float, least: float) -> int:
    """1 or -1 if a place is certainly left of a line, by more than *least*, or right of it; else 0.

    The height is the product of the direction with the offset: times the direction's length. Of all there is
    this is asked most: two times `total` and one `cross`, unrolled.
    """
    cx, cy, dx, dy, ce, de = line
    ox, oy = x - cx, y - cy
    across, down = abs(ox), abs(oy)
    offset = (error + ce + UNIT * (across if across > down else down)) * WIDEN
    left, right = dx * oy, dy * ox
    height = left - right
    sizes = (abs(dx) + abs(dy)) * offset + (across + down + 2.0 * offset) * de
    bound = (sizes + UNIT * (abs(left) + abs(right) + abs(height)) + TINY) * WIDEN
    if height - bound > least:
        return 1
    return -1 if -height > bound else 0


def meets(line: Line, curve: CurveImage, side: int) -> Meeting:
    """Where a line enters what a curve bounds, ahead (1) or back (-1) along the line."""
    return meets_round(line, curve, side) if curve.sense else meets_straight(line, curve)


def reaches(line: Line, curve: CurveImage, side: int) -> tuple[float, float, float, float]:
    """How far along a line, in lengths, it enters what a curve bounds, ahead (1) or back (-1); and the
    cotangent of the angle from the line to the curve there. Each with its bound."""
    if curve.sense:
        h, he, g, ge, half, half_bound, square, square_bound = _chord(line, curve)
        size, size_bound = root(square, square_bound)
        half *= -side * curve.sense
        top, top_bound = total(h, he, half, half_bound)
        far, fe = quotient(top, top_bound, size, size_bound)
        cot, cot_bound = quotient(-g, ge, half, half_bound)
        return far, fe if half_bound < inf else inf, cot, cot_bound
    far, fe = meets_straight(line, curve)[:2]
    dx, dy, de = line[2], line[3], line[5]
    we = UNIT * max(abs(curve.wx), abs(curve.wy)) + TINY
    along, along_bound = dot(dx, dy, de, curve.wx, curve.wy, we)
    under, under_bound = cross(dx, dy, de, curve.wx, curve.wy, we)
    cot, cot_bound = quotient(along, along_bound, under, under_bound)
    return far, fe, cot, cot_bound


def line_along(segment: CurveImage) -> Line:
    """The line of a segment."""
    x, y, dx, dy = segment.x, segment.y, segment.wx, segment.wy
    return x, y, dx, dy, UNIT * max(abs(x), abs(y)) + TINY, UNIT * max(abs(dx), abs(dy)) + TINY


def meets_straight(line: Line, segment: CurveImage) -> Meeting:
    """Where a line meets a segment's line."""
    x, y, dx, dy, ce, de = line
    sx, sy, wx, wy = segment.x, segment.y, segment.wx, segment.wy
    se, we = UNIT * max(abs(sx), abs(sy)) + TINY, UNIT * max(abs(wx), abs(wy)) + TINY
    ox, p = total(x, ce, -sx, se)
    oy, q = total(y, ce, -sy, se)
    oe = max(p, q)
    under, under_bound = cross(wx, wy, we, dx, dy, de)
    top, top_bound = cross(ox, oy, oe, dx, dy, de)
    u, ue = quotient(top, top_bound, under, under_bound)
    top, top_bound = cross(ox, oy, oe, wx, wy, we)
    tau, taue = quotient(top, top_bound, under, under_bound)
    if not (ue < inf and taue < inf):
        return UNKNOWN
    size, size_bound = length(dx, dy, de)
    far, fe = product(tau, taue, size, size_bound)
    px, py, pe = _moved(sx, sy, se, wx, wy, we, u, ue)
    return far, fe, u, ue, px, py, pe


def meets_round(line: Line, arc: CurveImage, side: int) -> Meeting:
    """Where a line enters what an arc bounds, ahead (1) or back (-1) along the line."""
    x, y, dx, dy, ce, de = line
    h, he, _, _, half, half_bound, square, square_bound = _chord(line, arc)
    if not half_bound < inf:
        return UNKNOWN
    size, size_bound = root(square, square_bound)
    top, top_bound = total(h, he, -side * arc.sense * half, half_bound)
    far, fe = quotient(top, top_bound, size, size_bound)
    tau, taue = quotient(top, top_bound, square, square_bound)
    px, py, pe = _moved(x, y, ce, dx, dy, de, tau, taue)
    u, ue = parameter_round(arc, px, py, pe)
    return far, fe, u, ue, px, py, pe


def _chord(line: Line, arc: CurveImage) -> tuple[float, float, float, float, float, float, float, float]:
    """What a line cuts off an arc's circle: h, g, the root of r^2 |d|^2 - g^2, |d|^2, each with its bound.

    With the direction d, the centre's foot on the line is at h / |d| and its height above it g / |d|; half
    the chord is that root, divided by |d|. An infinite bound if the line surely misses the circle.
    """
    x, y, dx, dy, ce, de = line
    ae = UNIT * max(abs(arc.x), abs(arc.y)) + TINY
    ox, oy, oe = _moved(arc.x, arc.y, ae, -x, -y, ce, 1.0, 0.0)
    square, square_bound = dot(dx, dy, de, dx, dy, de)
    size, size_bound = root(square, square_bound)
    h, he = dot(ox, oy, oe, dx, dy, de)
    g, ge = cross(ox, oy, oe, dx, dy, de)
    reach, reach_bound = product(arc.radius, UNIT * arc.radius, size, size_bound)
    plus, plus_bound = total(reach, reach_bound, g, ge)
    minus, minus_bound = total(reach, reach_bound, -g, ge)
    under, under_bound = product(plus, plus_bound, minus, minus_bound)
    if -under > under_bound:
        return h, he, g, ge, 0.0, inf, square, square_bound
    half, half_bound = root(under, under_bound)
    return h, he, g, ge, half, half_bound, square, square_bound


def parameter(curve: CurveImage, x: float, y: float, e: float) -> tuple[float, float]:
    """The parameter of a point of a curve."""
    if curve.sense:
        return parameter_round(curve, x, y, e)
    se, we = UNIT * max(abs(curve.x), abs(curve.y)) + TINY, UNIT * max(abs(curve.wx), abs(curve.wy)) + TINY
    ox, oy, oe = _moved(x, y, e, -curve.x, -curve.y, se, 1.0, 0.0)
    along, along_bound = dot(ox, oy, oe, curve.wx, curve.wy, we)
    square, square_bound = dot(curve.wx, curve.wy, we, curve.wx, curve.wy, we)
    return quotient(along, along_bound, square, square_bound)


def parameter_round(arc: CurveImage, x: float, y: float, e: float) -> tuple[float, float]:
    """The parameter of a point of an arc; for a full circle, if it is not 0 within the bound.

    In each quarter turn it is the number of quarters before, and across / (r^2 + along) by the components
    along the vector to where the quarter begins and across it. Quarters follow each other continuously. At
    their border the slope jumps by a factor of 2 at most: a point that is taken for one of the wrong quarter
    is off by no more than twice the bound there. A point that may be the start is taken for one next to it on
    the arc, for the other side of the start is not on the arc.
    """
    ae, be = UNIT * max(abs(arc.x), abs(arc.y)) + TINY, UNIT * max(abs(arc.wx), abs(arc.wy)) + TINY
    vx, vy, ve = _moved(x, y, e, -arc.x, -arc.y, ae, 1.0, 0.0)
    along, along_bound = dot(arc.wx, arc.wy, be, vx, vy, ve)
    across, across_bound = cross(arc.wx, arc.wy, be, vx, vy, ve)
    across *= arc.sense
    square, square_bound = product(arc.radius, UNIT * arc.radius, arc.radius, UNIT * arc.radius)
    is_start = along > along_bound and verdict(across, across_bound) == 0
    for quarter in range(QUARTERS):
        if along > 0.0 and (across >= 0.0 or is_start):
            below, below_bound = total(square, square_bound, along, along_bound)
            u, ue = quotient(across, across_bound, below, below_bound)
            return (0.0, abs(u) + 2.0 * ue) if is_start else (quarter + u, 2.0 * ue + UNIT * (quarter + 1))
        along, across, along_bound, across_bound = across, -along, across_bound, along_bound
    return 0.0, inf
