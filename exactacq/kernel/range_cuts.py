"""Where along a leg views of a family are as long as the range, in floats with bounds."""

from __future__ import annotations

from math import inf
from typing import Final

from exactacq.kernel.bounded import UNIT, WIDEN
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import NOTHING, Span
from exactacq.kernel.family_images import CONTACT, FamilyImage
from exactacq.kernel.images import SLIDING, TURNING
from exactacq.kernel.lines import Line, line_at, meets_straight

STEPS: Final = 40
"""How often a line is tried at most."""
ENOUGH: Final = 4e-13
"""A length is near enough to the radius if it differs by less than so much of it: less than its bounds do."""
NEXT: Final = 2e-13
"""How far the next line is from there at first, in shares of the family."""


def range_cut(
    family: FamilyImage,
    here: int,
    there: int,
    leg: CurveImage,
    shown: CurveImage | None,
    reach: tuple[float, float],
) -> tuple[int, Span]:
    """At which end views of a family are too long, and where on a leg the last one in range begins.

    The end is the first (-1) or the last (1) line; 0 if floats do not tell, if both ends are in range or if
    neither is. *shown* is None for a contact at a corner. The leg and what is shown are straight, and no line
    is parallel to either.

    Lines that turn meet a straight edge at a distance h / cos(a) with a the angle from the edge's normal, a
    convex function; those that slide at one that is linear in the parameter. The length of a view is such a
    distance or the sum of two, so it is convex along the family: if it is below the radius at one end and
    above it at the other, it is equal to it exactly once between. So between two lines of which one surely is
    in range and the other is not there is the last one that is. Where lines meet the leg moves along it
    without turning back, so the places on these two lines bound that of the last one.
    """
    if family.frame[0] not in (TURNING, SLIDING) or leg.sense or (shown is not None and shown.sense):
        return 0, NOTHING
    if _turns_past(family, leg) or (shown is not None and _turns_past(family, shown)):
        return 0, NOTHING
    first = _order(family.first, here, there, leg, shown, reach)
    last = _order(family.last, here, there, leg, shown, reach)
    if first * last >= 0:
        return 0, NOTHING
    inner, outer = family.fraction[1:3] if first < 0 else (family.fraction[2], family.fraction[1])
    near, far = _parted(family, here, there, leg, shown, reach, inner, outer)
    one, other = line_at(family.frame, near, 0.0), line_at(family.frame, far, 0.0)
    if _order(one, here, there, leg, shown, reach) >= 0 or _order(other, here, there, leg, shown, reach) <= 0:
        return 0, NOTHING
    u, p = _place(family, one, near, here, leg)
    v, q = _place(family, other, far, here, leg)
    if not (p < inf and q < inf):
        return 0, NOTHING
    return (1 if first < 0 else -1), (min(u - p, v - q), max(u + p, v + q))


def _parted(
    family: FamilyImage,
    here: int,
    there: int,
    leg: CurveImage,
    shown: CurveImage | None,
    reach: tuple[float, float],
    inner: float,
    outer: float,
) -> tuple[float, float]:
    """Parameters near to each other, of a view that floats may find in range and of one beyond.

    A zero is looked for by the Illinois variant of false position. From there both go outward, the further
    the more often floats do not tell. They stay between *inner* and *outer*.
    """
    middle = 0.5 * (reach[0] + reach[1])
    a, b = inner, outer
    f = _length(line_at(family.frame, a, 0.0), here, there, leg, shown)[0] - middle
    g = _length(line_at(family.frame, b, 0.0), here, there, leg, shown)[0] - middle
    t, kept = a, 0
    for _ in range(STEPS):
        if not f < 0.0 < g:
            break
        t = b - g * (b - a) / (g - f)
        h = _length(line_at(family.frame, t, 0.0), here, there, leg, shown)[0] - middle
        if abs(h) <= ENOUGH * middle:
            break
        if h < 0.0:
            a, f, g = t, h, 0.5 * g if kept < 0 else g
            kept = -1
        else:
            b, g, f = t, h, 0.5 * f if kept > 0 else f
            kept = 1
    away = abs(outer - inner) * NEXT
    towards = 1.0 if inner < outer else -1.0
    near = far = t
    for _ in range(STEPS):
        if _order(line_at(family.frame, near, 0.0), here, there, leg, shown, reach) < 0:
            break
        near -= towards * away
        away *= 4.0
    away = abs(outer - inner) * NEXT
    for _ in range(STEPS):
        if _order(line_at(family.frame, far, 0.0), here, there, leg, shown, reach) > 0:
            break
        far += towards * away
        away *= 4.0
    low, high = min(inner, outer), max(inner, outer)
    return min(max(near, low), high), min(max(far, low), high)


def _order(
    line: Line,
    here: int,
    there: int,
    leg: CurveImage,
    shown: CurveImage | None,
    reach: tuple[float, float],
) -> int:
    """-1 or 1 as the view along a line surely is shorter than the range or longer, else 0."""
    size, error = _length(line, here, there, leg, shown)
    return -1 if size + error < reach[0] else 1 if size - error > reach[1] else 0


def _length(
    line: Line, here: int, there: int, leg: CurveImage, shown: CurveImage | None
) -> tuple[float, float]:
    """The length of the view along a line; (0, inf) if it may not lie on the sides of the contact it should.

    The last rounding takes less than ten times `UNIT` of it.
    """
    a, p, b, q = 0.0, 0.0, 0.0, 0.0
    if here != CONTACT:
        a, p = meets_straight(line, leg)[:2]
    if there != CONTACT and shown is not None:
        b, q = meets_straight(line, shown)[:2]
    if not (a * here >= p and b * there >= q and p < inf and q < inf):
        return 0.0, inf
    size = abs(a - b)
    return size, (p + q + 10.0 * UNIT * size) * WIDEN


def _place(family: FamilyImage, line: Line, t: float, here: int, leg: CurveImage) -> tuple[float, float]:
    """Where a line meets the leg: its contact slides along the leg itself."""
    if here == CONTACT:
        return t, 0.0
    return meets_straight(line, leg)[2:4]


def _turns_past(family: FamilyImage, curve: CurveImage) -> bool:
    """Whether a line between the first and the last one may be parallel to a segment."""
    one, other = family.first, family.last
    first = curve.wx * one[3] - curve.wy * one[2]
    last = curve.wx * other[3] - curve.wy * other[2]
    return first == 0.0 or last == 0.0 or (first > 0.0) != (last > 0.0)
