"""Edges that become known all over on a leg: which surely do, and when the last of some does."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from exactacq.kernel.bounded import TINY, UNIT, cross_sign
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import EVERYTHING, Extent, Span
from exactacq.kernel.leg_spans import Known, LegSpan, is_covered
from exactacq.kernel.lines import line_along, meets_straight


def is_shown_whole(some: list[Extent], span: LegSpan, known: Sequence[Span] | None) -> bool:
    """Whether an edge surely is known all over at the end of the leg, by what is known and families show."""
    spans = [one.told for one in some if one.told[0] <= one.told[1] and span.contains(one.source)]
    return bool(spans) and is_covered(EVERYTHING, spans if known is None else [*spans, *known])


def last_shown(
    edges: list[int],
    extents: list[Extent],
    span: LegSpan,
    known: Known,
    ahead: bool,
    leg: CurveImage,
    curves: list[CurveImage],
) -> tuple[list[int], Span, int]:
    """Which of some edges that become known all over on a leg may be the last, and when at the earliest and
    at the latest.

    If that is where the leg crosses the edge's line to its front, and it is seen along that line, the number
    of the extent that tells so; else -1. All *extents* at the leg of families that show something new of the
    edges are needed. The leg lies on the curve *leg*; no *curves* are given if floats are to tell nothing.
    Where the robot walks back, a later moment has a lower parameter.
    """
    moments: list[Span] = []
    latest = -inf
    for e in edges:
        first = _comes_in_front(leg, curves[e], ahead) if curves else -inf
        moments.append((first, _end_of_news(e, extents, span, known.get(e), ahead)))
        latest = max(latest, first)
    end = -inf
    found: list[int] = []
    for n in range(len(edges)):
        if moments[n][1] >= latest:
            found.append(edges[n])
            end = max(end, moments[n][1])
    along = _along(found[0], extents, span) if len(found) == 1 and latest > -inf else -1
    return found, (latest, end) if ahead else (-end, -latest), along


def _along(edge: int, extents: list[Extent], span: LegSpan) -> int:
    """The number of the extent by which all of an edge surely is seen along its own line, -1 if none does."""
    for n in range(len(extents)):
        one = extents[n]
        is_line = one.surely[0] > one.surely[1]
        if one.edge == edge and is_line and one.told == EVERYTHING and span.contains(one.source):
            return n
    return -1


def _comes_in_front(leg: CurveImage, edge: CurveImage, ahead: bool) -> float:
    """When a straight leg comes to the free side of a straight edge, at the earliest.

    Before that no more than the ends of the edge is seen. Obstacles lie to the left of their edges.
    """
    if leg.sense or edge.sense:
        return -inf
    line = line_along(edge)
    error = UNIT * max(abs(leg.wx), abs(leg.wy)) + TINY
    turn = cross_sign(line[2], line[3], line[5], leg.wx, leg.wy, error)
    if turn != (-1 if ahead else 1):
        return -inf
    _, _, u, bound, _, _, _ = meets_straight(line, leg)
    if not bound < inf:
        return -inf
    return u - bound if ahead else -u - bound


def _end_of_news(
    edge: int, extents: list[Extent], span: LegSpan, known: Sequence[Span] | None, ahead: bool
) -> float:
    """After which moment an edge surely is known all over; infinite if that is open."""
    shown: list[tuple[float, Span]] = []
    for one in extents:
        if one.edge == edge and one.told[0] <= one.told[1] and span.contains(one.source):
            shown.append((one.source[1] if ahead else -one.source[0], one.told))
    spans = [] if known is None else [*known]
    for moment, told in sorted(shown):
        spans.append(told)
        if is_covered(EVERYTHING, spans):
            return moment
    return inf
