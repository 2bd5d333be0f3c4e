"""Lines of a sector and where they meet curves, in floats: each value with a bound of its error.

Let u = 2^-53 be the unit roundoff and EPS = 2 u. Coordinates and vectors of a scene come in as the nearest
floats of rationals, off by u of themselves, those of a robot's way off by 4 u at most; a sum, product,
quotient or root is off by u of itself. A computed value is returned with a bound of its distance from the
exact value. Bounds are sums of first-order terms: for each input its error times the size of the derivative,
for each operation u times the result. They are rounded up by constants at least twice as large as the count
of operations requires, which also covers what the bounds themselves lose to rounding and all products of two
errors, as long as a bound is smaller than what it belongs to; where it is not (a divisor that may be 0), the
bound is infinite. `TINY` covers underflow.
"""

from __future__ import annotations

from math import hypot, inf, sqrt

from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.images import ROLLING, SLIDING, TURNING

EPS = 2.0**-52
TINY = 1e-290

Frame = tuple[int, float, float, float, float, float, int]
"""A sector: its kind, centre, base vector and, of normals, the arc's radius and the sense in which they go
(see `exactacq.kernel.images.LineFrame`)."""
Line = tuple[float, float, float, float, float, float]
"""Contact, direction, and bounds of the errors of their coordinates."""
Meeting = tuple[float, float, float, float, float, float, float]
"""How far along a line, in lengths, a curve is met, with error; the parameter there, with error; the point,
with the error of its coordinates. An infinite error: unknown."""

UNKNOWN: Meeting = (0.0, inf, 0.0, inf, 0.0, 0.0, inf)


def line_at(frame: Frame, t: float, te: float) -> Line:
    """The line at a parameter that is off by *te*, for parameters between -1 and 1 or little beyond.

    The derivatives of unit vectors with respect to t are at most 2: those of cosine and sine of twice the
    arc tangent, and 1 for the direction of e + t e'.
    """
    kind, cx, cy, ex, ey, radius, sense = frame
    size = abs(ex) + abs(ey)
    base = EPS * (abs(cx) + abs(cy))
    if kind == SLIDING:
        error = base + size * (te + 8.0 * EPS) + TINY
        return cx + ex * t, cy + ey * t, -ey * sense, ex * sense, error, EPS * size + TINY
    if kind == ROLLING:
        square = t * t
        cosine, sine = (1.0 - square) / (1.0 + square), 2.0 * t / (1.0 + square)
        vx, vy = cosine * ex - sine * ey, cosine * ey + sine * ex
        error = size * (4.0 * te + 16.0 * EPS) + TINY
        return cx + vx, cy + vy, -vy, vx, error + 2.0 * base, error
    dx, dy = ex - t * ey, ey + t * ex
    error = size * (te + 8.0 * EPS) + TINY
    if kind == TURNING:
        return cx, cy, dx, dy, base + TINY, error
    away = radius / hypot(dx, dy)
    contact = 2.0 * base + radius * (2.0 * te + 32.0 * EPS) + TINY
    return cx + dx * away, cy + dy * away, dx * sense, dy * sense, contact, error


def meets(line: Line, curve: CurveImage, side: int) -> Meeting:
    """Where a line enters what a curve bounds, ahead (1) or back (-1) along the line."""
    return meets_round(line, curve, side) if curve.sense else meets_straight(line, curve)


def meets_straight(line: Line, segment: CurveImage) -> Meeting:
    """Where a line meets a segment's line."""
    x, y, dx, dy, ce, de = line
    sx, sy, wx, wy = segment.x, segment.y, segment.wx, segment.wy
    ox, oy = x - sx, y - sy
    oe = ce + 4.0 * EPS * (abs(sx) + abs(sy) + abs(ox) + abs(oy))
    d, w, o = abs(dx) + abs(dy), abs(wx) + abs(wy), abs(ox) + abs(oy)
    under = wx * dy - wy * dx
    undere = w * (de + 8.0 * EPS * d) + TINY
    least = abs(under) - undere
    if not least > 0.0:
        return UNKNOWN
    u, tau = (ox * dy - oy * dx) / under, (ox * wy - oy * wx) / under
    ue = 2.0 * ((oe * (d + de) + o * (de + 8.0 * EPS * d) + abs(u) * undere) / least + EPS * abs(u)) + TINY
    te = 2.0 * ((oe * w + 8.0 * EPS * o * w + abs(tau) * undere) / least + EPS * abs(tau)) + TINY
    size = hypot(dx, dy)
    px, py = sx + wx * u, sy + wy * u
    pe = w * ue + 8.0 * EPS * (abs(sx) + abs(sy) + w * abs(u)) + TINY
    far = tau * size
    fe = te * size + abs(tau) * 2.0 * de + 8.0 * EPS * abs(far)
    return far, fe, u, ue, px, py, pe


def meets_round(line: Line, arc: CurveImage, side: int) -> Meeting:
    """Where a line enters what an arc bounds, ahead (1) or back (-1) along the line.

    With the unit direction, h is the foot of the centre along the line and g its height above it.
    """
    x, y, dx, dy, ce, de = line
    ax, ay, radius, sense = arc.x, arc.y, arc.radius, arc.sense
    size = hypot(dx, dy)
    if not size > 4.0 * de:
        return UNKNOWN
    dx, dy = dx / size, dy / size
    de = 4.0 * de / size + 8.0 * EPS
    ox, oy = ax - x, ay - y
    o = abs(ox) + abs(oy)
    oe = ce + EPS * (abs(ax) + abs(ay) + o)
    h, g = ox * dx + oy * dy, ox * dy - oy * dx
    he = 2.0 * oe + o * (de + 8.0 * EPS) + TINY
    ge = he + EPS * radius
    square = (radius - abs(g)) * (radius + abs(g))
    squaree = 2.0 * ge * (2.0 * (radius + abs(g)) + ge) + 8.0 * EPS * abs(square) + TINY
    if square > 2.0 * squaree:
        root = sqrt(square)
        roote = 2.0 * squaree / root + EPS * root
    elif square > -squaree:
        root = roote = sqrt(4.0 * squaree)
    else:
        return UNKNOWN
    far = h - side * sense * root
    fe = he + roote + 4.0 * EPS * (abs(h) + root)
    px, py = x + dx * far, y + dy * far
    pe = ce + abs(far) * de + fe + 8.0 * EPS * (abs(x) + abs(y) + abs(far))
    u, ue = parameter_round(arc, px, py, pe)
    return far, fe, u, ue, px, py, pe


def parameter_round(arc: CurveImage, x: float, y: float, e: float) -> tuple[float, float]:
    """The parameter of a point of an arc; for a full circle, if it is not 0 within the error.

    Quarter turns follow each other continuously. At their border the slope jumps by a factor of 2: a point
    taken for one of the wrong quarter is off by no more than twice the bound of the right one. A point that
    may be the start is one next to it on the arc, for the other side of the start is not on the arc.
    """
    ax, ay, radius, bx, by, sense = arc.x, arc.y, arc.radius, arc.wx, arc.wy, arc.sense
    vx, vy = x - ax, y - ay
    e = e + EPS * (abs(ax) + abs(ay) + abs(vx) + abs(vy))
    along, across = bx * vx + by * vy, (bx * vy - by * vx) * sense
    b = abs(bx) + abs(by)
    error = b * (e + 8.0 * EPS * radius) + TINY
    square = radius * radius
    if along > 0.0 and abs(across) <= error:
        return 0.0, 16.0 * error / square + 16.0 * EPS
    quarter = 0.0
    while not (along > 0.0 and across >= 0.0):
        along, across = across, -along
        quarter += 1.0
        if quarter > 3.0:
            return 0.0, inf
    return quarter + across / (square + along), 8.0 * error / square + 16.0 * EPS
