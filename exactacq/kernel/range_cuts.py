"""Where along a leg views of a family are as long as the range, in floats with bounds."""

from __future__ import annotations

from math import inf
from typing import Final

from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import EVERYTHING, NOTHING, Span
from exactacq.kernel.family_images import CONTACT, FamilyImage
from exactacq.kernel.images import SLIDING, TURNING
from exactacq.kernel.lines import Frame, Line, line_at, meets_straight
from exactacq.kernel.view_lengths import crosses_once, length_along, order_along, order_of_all

STEPS: Final = 40
"""How often a line is tried at most."""
ENOUGH: Final = 4e-13
"""A length is near enough to the radius if it differs by less than so much of it: less than its bounds do."""
NEXT: Final = 2e-13
"""How far the next line is from there at first, in shares of the family."""


UNSURE: Final = 0
"""Floats do not tell which views are in range."""
FIRST_TOO_LONG: Final = -1
"""The first view is too long, the last one is in range."""
LAST_TOO_LONG: Final = 1
"""The last view is too long, the first one is in range."""
ALL_IN_RANGE: Final = 2
"""All views are in range."""
NONE_IN_RANGE: Final = -2
"""None is."""


def range_cut(
    family: FamilyImage,
    here: int,
    there: int,
    leg: CurveImage,
    shown: CurveImage | None,
    reach: tuple[float, float],
) -> tuple[int, Span]:
    """At which end views of a family are too long, and where on a leg the last one in range begins.

    Where lines meet the leg moves along it without turning back, so the places on the two lines of
    `parted_lines` bound that of the last view in range.
    """
    if leg.sense or not _is_convex(family.frame, leg, shown):
        return UNSURE, NOTHING
    ends = family.first, family.last
    told, near, far = parted_lines(family.frame, ends, family.fraction, here, there, leg, shown, reach)
    if told not in (FIRST_TOO_LONG, LAST_TOO_LONG):
        return UNSURE, NOTHING
    u, p = _place(line_at(family.frame, near, 0.0), near, here, leg)
    v, q = _place(line_at(family.frame, far, 0.0), far, here, leg)
    if not (p < inf and q < inf):
        return UNSURE, NOTHING
    return told, (min(u - p, v - q), max(u + p, v + q))


def parted_lines(
    frame: Frame,
    ends: tuple[Line, Line],
    fraction: tuple[float, float, float, float],
    here: int,
    there: int,
    leg: CurveImage,
    shown: CurveImage | None,
    reach: tuple[float, float],
) -> tuple[int, float, float]:
    """Which views are in range; and, if it is some, parameters of a view in range and of one beyond.

    *ends* are the first and the last line, *fraction* bounds their parameters, the first one's before the
    last one's. All lines between meet both sides, the leg and what is shown; this is None for a contact at a
    corner.

    Lines that turn meet a straight edge at a distance h / cos(a) with a the angle from the edge's normal, a
    convex function as long as no line is parallel to the edge; those that slide at one that is linear in the
    parameter. The length of a view is such a distance or the sum of two, so it is convex along the family: if
    it is below the radius at both ends, it is so everywhere; if it is below at one end and above at the
    other, it is equal to it exactly once between. So between two lines of which one surely is in range and
    the other is not there is the last one that is. Of other families that is found piece by piece.
    """
    unsure = UNSURE, 0.0, 0.0
    is_convex = _is_convex(frame, leg, shown)
    if is_convex and (_turns_past(ends, leg) or (shown is not None and _turns_past(ends, shown))):
        return unsure
    first = order_along(ends[0], here, there, leg, shown, reach)
    last = order_along(ends[1], here, there, leg, shown, reach)
    if first == 0 or last == 0:
        return unsure
    if first == last:
        if first < 0 and is_convex:
            return ALL_IN_RANGE, 0.0, 0.0
        order = order_of_all(frame, fraction, here, there, leg, shown, reach, EVERYTHING)
        return (ALL_IN_RANGE if order < 0 else NONE_IN_RANGE if order > 0 else UNSURE), 0.0, 0.0
    if not (is_convex or crosses_once(frame, fraction, here, there, leg, shown, reach, first)):
        return unsure
    inner, outer = (fraction[1], fraction[2]) if first < 0 else (fraction[2], fraction[1])
    near, far = _parted(frame, here, there, leg, shown, reach, inner, outer)
    one, other = line_at(frame, near, 0.0), line_at(frame, far, 0.0)
    if order_along(one, here, there, leg, shown, reach) >= 0:
        return unsure
    if order_along(other, here, there, leg, shown, reach) <= 0:
        return unsure
    return (LAST_TOO_LONG if first < 0 else FIRST_TOO_LONG), near, far


def _parted(
    frame: Frame,
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
    f = length_along(line_at(frame, a, 0.0), here, there, leg, shown)[0] - middle
    g = length_along(line_at(frame, b, 0.0), here, there, leg, shown)[0] - middle
    t, kept = a, 0
    for _ in range(STEPS):
        if not f < 0.0 < g:
            break
        t = b - g * (b - a) / (g - f)
        h = length_along(line_at(frame, t, 0.0), here, there, leg, shown)[0] - middle
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
        if order_along(line_at(frame, near, 0.0), here, there, leg, shown, reach) < 0:
            break
        near -= towards * away
        away *= 4.0
    away = abs(outer - inner) * NEXT
    for _ in range(STEPS):
        if order_along(line_at(frame, far, 0.0), here, there, leg, shown, reach) > 0:
            break
        far += towards * away
        away *= 4.0
    low, high = min(inner, outer), max(inner, outer)
    return min(max(near, low), high), min(max(far, low), high)


def _place(line: Line, t: float, here: int, leg: CurveImage) -> tuple[float, float]:
    """Where a line meets the leg: its contact slides along the leg itself."""
    if here == CONTACT:
        return t, 0.0
    return meets_straight(line, leg)[2:4]


def _is_convex(frame: Frame, leg: CurveImage, shown: CurveImage | None) -> bool:
    """Whether a family turns or slides, and its sides are straight."""
    return frame[0] in (TURNING, SLIDING) and not leg.sense and (shown is None or not shown.sense)


def _turns_past(ends: tuple[Line, Line], curve: CurveImage) -> bool:
    """Whether a line between the first and the last one may be parallel to a segment."""
    one, other = ends
    first = curve.wx * one[3] - curve.wy * one[2]
    last = curve.wx * other[3] - curve.wy * other[2]
    return first == 0.0 or last == 0.0 or (first > 0.0) != (last > 0.0)
