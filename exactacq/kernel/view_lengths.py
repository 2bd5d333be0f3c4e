"""How long the views along the lines of a family are, in floats with bounds.

A family is taken in pieces. With u and n the unit vectors along a line and across it, to the left, and w how
fast lines turn as the parameter grows, a place at distance s on a line moves across it at the speed w (s +
k), where k is the distance from the contact back to the point that the line turns about: 0 for a tangent,
the radius for a spoke. (Lines that slide do not turn: there all places move alike.) So if it moves on a
curve that meets the line at the angle a, it moves along the line at that speed times cot a. From the length
in the middle of a piece, and bounds of how fast it changes in all of the piece, follow bounds of all lengths
there, and often that they grow.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Final

from exactacq.kernel.bounded import TINY, UNIT, WIDEN, length, product, quotient, total
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.family_images import CONTACT
from exactacq.kernel.images import ROLLING, SLIDING, SPOKES
from exactacq.kernel.lines import Frame, Line, line_at, meets_straight, reaches

PIECES: Final = 64
"""How many pieces of a family are looked at, at most."""
FINEST: Final = 2.0**-9
"""The shortest piece, in shares of the family."""
ELSEWHERE: Final = 2
"""Instead of an order: the view does not begin where it was asked about."""

Views = tuple[float, float, float, float, float, float]
"""Of the views of a piece: a length and how far others are off; the slope in the parameter, with its bound;
where on a straight leg they begin, with a bound."""


def length_along(
    line: Line, here: int, there: int, leg: CurveImage, shown: CurveImage | None
) -> tuple[float, float]:
    """The length of the view along a line; (0, inf) if it may lie on a wrong side of the contact."""
    a, p, b, q = 0.0, 0.0, 0.0, 0.0
    if here != CONTACT:
        a, p, _, _ = reaches(line, leg, here)
    if there != CONTACT and shown is not None:
        b, q, _, _ = reaches(line, shown, there)
    return _apart(a, p, b, q) if a * here >= p and b * there >= q else (0.0, inf)


def order_along(
    line: Line,
    here: int,
    there: int,
    leg: CurveImage,
    shown: CurveImage | None,
    reach: tuple[float, float],
) -> int:
    """-1 or 1 as the view along a line surely is shorter than the range or longer, else 0."""
    size, error = length_along(line, here, there, leg, shown)
    return _order(size, error, reach)


def order_of_all(
    frame: Frame,
    fraction: tuple[float, float, float, float],
    here: int,
    there: int,
    leg: CurveImage | None,
    shown: CurveImage | None,
    reach: tuple[float, float],
    part: tuple[float, float],
) -> int:
    """-1 or 1 as all views of a family surely are shorter than the range or longer, else 0.

    *fraction* bounds the parameters of the first and of the last line. Only views from a *part* of the leg
    count, of which all lines between meet both sides; the leg is straight if that is not `EVERYTHING`.
    """
    is_part = part[0] > -inf or part[1] < inf
    start, end = fraction[0], fraction[3]
    views = views_between(frame, start, fraction[1], here, there, leg, shown)
    first = _order_in(views, is_part, part, reach)
    views = views_between(frame, fraction[2], end, here, there, leg, shown)
    last = _order_in(views, is_part, part, reach)
    if first == 0 or last == 0 or first == -last:
        return 0
    told = last if first == ELSEWHERE else first
    piece = end - start
    least = piece * FINEST
    for _ in range(PIECES):
        stop = min(start + piece, end)
        views = views_between(frame, start, stop, here, there, leg, shown)
        order = _order_in(views, is_part, part, reach)
        if order == -told or (order == 0 and piece < least):
            return 0
        if order == 0:
            piece *= 0.5
            continue
        if order != ELSEWHERE:
            told = order
        if stop >= end:
            return told if told != ELSEWHERE else 0
        start, piece = stop, 2.0 * piece
    return 0


def crosses_once(
    frame: Frame,
    fraction: tuple[float, float, float, float],
    here: int,
    there: int,
    leg: CurveImage,
    shown: CurveImage | None,
    reach: tuple[float, float],
    order: int,
) -> bool:
    """Whether exactly one view of a family surely is as long as the range.

    The first view is told by *order*, the last one by the opposite: between views of which this is sure the
    length grows, or falls, all along.
    """
    start, end = fraction[0], fraction[3]
    piece = end - start
    least = piece * FINEST
    # What was told last: as of the first view, of none (0), or as of the last one.
    state = order
    for _ in range(PIECES):
        stop = min(start + piece, end)
        size, error, slope, bound, _, _ = views_between(frame, start, stop, here, there, leg, shown)
        told = _order(size, error, reach)
        if told == 0 and state != -order and size > error and slope * order + bound < 0.0:
            state = 0
        elif told and (told == state or told == -order):
            state = told
        elif piece < least:
            return False
        else:
            piece *= 0.5
            continue
        if stop >= end:
            return state != order
        start, piece = stop, 2.0 * piece
    return False


def _order(size: float, error: float, reach: tuple[float, float]) -> int:
    return -1 if size + error < reach[0] else 1 if size - error > reach[1] else 0


def _order_in(views: Views, is_part: bool, part: tuple[float, float], reach: tuple[float, float]) -> int:
    """How long some views are; `ELSEWHERE` if surely none begins in a part of the leg."""
    size, error, _, _, u, away = views
    if is_part and (u + away < part[0] or u - away > part[1]):
        return ELSEWHERE
    return _order(size, error, reach)


def views_between(
    frame: Frame,
    start: float,
    stop: float,
    here: int,
    there: int,
    leg: CurveImage | None,
    shown: CurveImage | None,
) -> Views:
    """The views between two parameters, of which all lines meet both sides."""
    t = 0.5 * (start + stop)
    half = 0.5 * (stop - start)
    half += UNIT * (abs(t) + half) + TINY
    line, lines = line_at(frame, t, 0.0), line_at(frame, t, half)
    square, bound = product(t, half, t, half)
    below, below_bound = total(1.0, 0.0, square, bound)
    turn, turn_bound = quotient(2.0 if frame[0] == ROLLING else 1.0, 0.0, below, below_bound)
    # At the contact the line rolls on ahead.
    ahead, ahead_bound = 0.0, 0.0
    if frame[0] == ROLLING and (here == CONTACT or there == CONTACT):
        radius, radius_bound = _size_of_base(frame)
        ahead, ahead_bound = product(radius, radius_bound, turn, turn_bound)
    # Distance and speed along the line: on the line in the middle, on all lines.
    a, p, c, r, av, ap = 0.0, 0.0, 0.0, 0.0, ahead, ahead_bound
    b, q, d, s, bv, bq = 0.0, 0.0, 0.0, 0.0, ahead, ahead_bound
    u, away = 0.0, inf
    if here != CONTACT and leg is not None:
        a, p, _, _ = reaches(line, leg, here)
        c, r, cot, cot_bound = reaches(lines, leg, here)
        across, across_bound = _across(frame, turn, turn_bound, c, r)
        av, ap = product(across, across_bound, cot, cot_bound)
        if not leg.sense:
            _, _, u, error, _, _, _ = meets_straight(line, leg)
            slant = abs(cot) + cot_bound
            speed = (abs(across) + across_bound) * sqrt(1.0 + slant * slant)
            away = (error + half * speed / sqrt(leg.wx * leg.wx + leg.wy * leg.wy)) * WIDEN
    if there != CONTACT and shown is not None:
        b, q, _, _ = reaches(line, shown, there)
        d, s, cot, cot_bound = reaches(lines, shown, there)
        across, across_bound = _across(frame, turn, turn_bound, d, s)
        bv, bq = product(across, across_bound, cot, cot_bound)
    size, error = _apart(a, p, b, q)
    slope, bound = total(bv, bq, -av, ap)
    error = (error + half * (abs(slope) + bound)) * WIDEN
    other, rough = _apart(c, r, d, s)
    if not error <= rough:
        # Where lines nearly touch an arc, places move at any speed.
        size, error = other, rough
    return size, error, -slope if b < a else slope, bound, u, away


def _across(frame: Frame, turn: float, turn_bound: float, far: float, error: float) -> tuple[float, float]:
    """How fast a place on a line moves across it; of lines that slide to the left of them, it moves back."""
    kind, radius, sense = frame[0], frame[5], frame[6]
    if kind == SLIDING:
        size, bound = _size_of_base(frame)
        return -sense * size, bound
    if kind == SPOKES:
        far, error = total(far, error, sense * radius, UNIT * radius)
    return product(far, error, turn, turn_bound)


def _size_of_base(frame: Frame) -> tuple[float, float]:
    ex, ey = frame[3], frame[4]
    return length(ex, ey, UNIT * max(abs(ex), abs(ey)) + TINY)


def _apart(a: float, p: float, b: float, q: float) -> tuple[float, float]:
    """The distance of two places on a line. The last rounding takes less than ten times `UNIT` of it."""
    if not (p < inf and q < inf):
        return 0.0, inf
    size = abs(a - b)
    return size, (p + q + 10.0 * UNIT * size) * WIDEN
