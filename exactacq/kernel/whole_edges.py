"""What families show of edges together: what of it is told by some of them, which edges become known all over
on a leg, and when the last of some does."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from exactacq.kernel.bounded import TINY, UNIT, cross_sign
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import EVERYTHING, NOTHING, Extent, Span
from exactacq.kernel.leg_spans import Known, LegSpan, is_covered
from exactacq.kernel.lines import line_along, meets_straight


def spans_of(edge: int, known: Known, others: Known) -> list[Span]:
    """What is known of an edge, and what others tell of it."""
    found: list[Span] = []
    for some in (known.get(edge), others.get(edge)):
        if some is not None:
            found += some
    return found


def is_shown_whole(some: list[Extent], span: LegSpan, seen: list[Span]) -> bool:
    """Whether an edge surely is known all over at the end of the leg, by what is *seen* and families show."""
    return is_covered(EVERYTHING, seen + [_told(one, span) for one in some])


def not_covered(some: list[Extent], span: LegSpan, seen: list[Span]) -> list[int]:
    """Some of the families at a leg that show all that they do together, but for what is *seen*.

    The one that shows least is the first to be left out.
    """
    told = [_told(one, span) for one in some]
    kept = [True] * len(some)
    for _, n in sorted([(_size(some[n].shown), n) for n in range(len(some))]):
        spans = seen + [told[m] for m in range(len(some)) if kept[m] and m != n]
        kept[n] = not is_covered(some[n].shown, spans)
    return [n for n in range(len(some)) if kept[n]]


def _told(one: Extent, span: LegSpan) -> Span:
    """What a family surely shows from the leg."""
    return one.told if span.contains(one.source) else NOTHING


def _size(span: Span) -> float:
    return 0.0 if span[0] == span[1] else span[1] - span[0]


def last_shown(
    edges: list[int],
    extents: list[Extent],
    span: LegSpan,
    known: Known,
    leg: CurveImage,
    curves: list[CurveImage],
) -> tuple[list[int], Span, int]:
    """Which of some edges that become known all over on a leg may be the last, and when at the earliest and
    at the latest.

    If at the earliest it is where the leg crosses an edge's line to its front, and all of that edge is
    seen along that line, the number of the extent that tells so; else -1. All *extents* at the leg of
    families that show something new of the edges are needed. The leg lies on the curve *leg*; no *curves*
    are given if floats are to tell nothing. Where the robot walks back, a later moment has a lower
    parameter.
    """
    ahead = span.ahead
    moments: list[float] = []
    latest, front = -inf, -1
    for e in edges:
        first = _comes_in_front(leg, curves[e], ahead) if curves else -inf
        moments.append(_end_of_news(e, extents, span, known.get(e)))
        if first > latest:
            latest, front = first, e
    end = -inf
    found: list[int] = []
    for n in range(len(edges)):
        if moments[n] >= latest:
            found.append(edges[n])
            end = max(end, moments[n])
    along = _along(front, extents, span) if front >= 0 else -1
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


def _end_of_news(edge: int, extents: list[Extent], span: LegSpan, known: Sequence[Span] | None) -> float:
    """After which moment an edge surely is known all over; infinite if that is open."""
    shown: list[tuple[float, Span]] = []
    for one in extents:
        if one.edge == edge and one.told[0] <= one.told[1] and span.contains(one.source):
            shown.append((one.source[1] if span.ahead else -one.source[0], one.told))
    spans = [] if known is None else [*known]
    for moment, told in sorted(shown):
        spans.append(told)
        if is_covered(EVERYTHING, spans):
            return moment
    return inf
