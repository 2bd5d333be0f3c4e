"""Which of the families at a leg matter: most show what is known, from where more is seen anyway.

A family matters if it may show anything new, or if where it is seen from may decide when an obstacle comes
into sight or goes out of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Final, final

from exactacq.kernel.extents import EVERYTHING, NOTHING, Extent, Span
from exactacq.kernel.leg_spans import Known, LegSpan, is_covered
from exactacq.kernel.whole_edges import is_shown_whole, not_covered, spans_of

NOBODY: Final[list[tuple[int, bool]]] = []


@final
class Source:
    """Where the family of that number is seen from on a leg.

    It ``is_alone`` if it is a single line that surely shows something, within the range.
    """

    def __init__(self, number: int, outer: Span, surely: Span, one: Extent, is_alone: bool) -> None:
        self.number, self.outer, self.surely, self.extent = number, outer, surely, one
        self.is_alone = is_alone


Group = tuple[int, Source, Source]
"""An obstacle, and of families that show it from connected places, surely and in range, the one that begins
first and the one that ends last."""
Spared = tuple[int, list[int]]
"""An edge, and families that tell no more than when what of it becomes known."""


def mattering(
    extents: list[Extent],
    span: LegSpan,
    owners: dict[int, list[tuple[int, bool]]],
    obstacles: set[int],
    along: set[int],
    known: Known,
    at_end: Known,
) -> tuple[list[int], list[Group], list[Spared], list[int]]:
    """Which of some families matter on a leg, by their numbers, and from where obstacles surely are seen.

    *owners* are the obstacles that edges count for, and whether all of the edge does. The leg lies on the
    boundaries of the obstacles *along*, which are in sight anyway. What is seen from where it ends is in
    *at_end*. Families that tell only when something becomes known are spared, and told apart. Last come the
    edges that surely are known all over at the end of the leg.
    """
    chosen = [False] * len(extents)
    sources: dict[int, list[Source]] = {}
    # Of an obstacle that one family shows from all of the leg no other is needed.
    throughout: set[int] = set()
    news: dict[int, list[int]] = {}
    told = _extreme_views(extents)
    of: dict[int, list[tuple[int, bool]]] = {}
    for n in range(len(extents)):
        one = extents[n]
        is_single = _is_single(one)
        if is_single and _is_told(one, told):
            continue
        if one.edge not in of:
            of[one.edge] = [owner for owner in owners.get(one.edge, NOBODY) if owner[0] in obstacles]
        concerned = of[one.edge]
        if not concerned:
            continue
        if not one.is_known:
            chosen[n] = True
            continue
        outer = span.outer(one.source)
        if outer[0] > outer[1]:
            continue
        # Also from an end of the leg alone: of the edges at a corner the view from there tells one.
        if not _is_known(one, known):
            if one.edge not in news:
                news[one.edge] = []
            news[one.edge].append(n)
        # What is seen from an end of the leg alone is part of the view from there.
        if not (outer[0] < inf and outer[1] > -inf):
            continue
        surely = span.inner(one.surely)
        for k, whole in concerned:
            if k in along or k in throughout:
                continue
            source = Source(n, outer, surely if whole else NOTHING, one, whole and is_single and one.in_range)
            if whole and surely[0] == -inf and surely[1] == inf:
                throughout.add(k)
                sources[k] = [source]
            elif k in sources:
                sources[k].append(source)
            else:
                sources[k] = [source]
    spared, complete = _spared(extents, news, chosen, span, owners, known, at_end)
    groups = _groups(sources, chosen)
    return [n for n in range(len(extents)) if chosen[n]], groups, spared, complete


def _spared(
    extents: list[Extent],
    news: dict[int, list[int]],
    chosen: list[bool],
    span: LegSpan,
    owners: dict[int, list[tuple[int, bool]]],
    known: Known,
    at_end: Known,
) -> tuple[list[Spared], list[int]]:
    """Of families that show something new of edges those that tell only when; what else matters is *chosen*.

    And the edges that surely are known all over at the end of the leg.
    """
    spared: list[Spared] = []
    complete: list[int] = []
    for e, numbers in news.items():
        new = [extents[m] for m in numbers]
        seen = spans_of(e, known, at_end)
        is_complete = all(whole for _, whole in owners[e]) and is_shown_whole(new, span, seen)
        if is_complete:
            complete.append(e)
        untold = [numbers[n] for n in _untold(new, span, known.get(e))]
        needed = [] if is_complete else not_covered([extents[m] for m in untold], span, seen)
        for n in needed:
            chosen[untold[n]] = True
        left = [m for m in untold if not chosen[m]]
        if left:
            spared.append((e, left))
    return spared, complete


def _groups(sources: dict[int, list[Source]], chosen: list[bool]) -> list[Group]:
    """From where obstacles surely are seen; what else may be seen is *chosen*."""
    groups: list[Group] = []
    for k, some in sources.items():
        found = [SightGroup(group) for group in _joined([s for s in some if s.surely[0] <= s.surely[1]])]
        for sight in found:
            groups.append((k, sight.first, sight.last))
        for source in some:
            if not any(sight.contains(source) for sight in found):
                if source.is_alone:
                    groups.append((k, source, source))
                else:
                    chosen[source.number] = True
    return groups


def _extreme_views(extents: list[Extent]) -> set[tuple[int, int]]:
    """The first and the last views of families, by their keys and the edges that are seen.

    Only those of single lines are asked for; where there are none, none is told.
    """
    lone = {key for one in extents if _is_single(one) for key in one.first_keys}
    found: set[tuple[int, int]] = set()
    if lone:
        for one in extents:
            if one.surely[0] <= one.surely[1]:
                for key in one.first_keys:
                    if key in lone:
                        found.add((key, one.edge))
                for key in one.last_keys:
                    if key in lone:
                        found.add((key, one.edge))
    return found


def _is_single(one: Extent) -> bool:
    """Whether a view is along one line that has a key: other families may be as narrow in floats."""
    return one.surely[0] > one.surely[1] and bool(one.first_keys) and one.first_keys == one.last_keys


def _is_told(one: Extent, told: set[tuple[int, int]]) -> bool:
    """Whether the view along a single line is one that is told, as the extreme one of a family or another's.

    If not, it is from now on. At corners, and at the start of a full circle, a place may have two names.
    """
    if one.source[0] == -inf or one.source[1] == inf or one.shown == EVERYTHING:
        return False
    for key in one.first_keys:
        if (key, one.edge) in told:
            return True
    for key in one.first_keys:
        told.add((key, one.edge))
    return False


def _is_known(one: Extent, known: Known) -> bool:
    """Whether all that a family shows is known."""
    low, high = one.shown
    spans = known.get(one.edge)
    return spans is not None and any(a <= low and high <= b for a, b in spans)


def _untold(some: list[Extent], span: LegSpan, known: Sequence[Span] | None) -> list[int]:
    """Of families that show something new of one edge those that are not certainly the later to show it.

    All of such a one is known, or shown by families that end where it begins or before. These do not depend
    on it in turn, for each of them is seen from more than one place.
    """
    whole = [
        one
        for one in some
        if one.told[0] <= one.told[1] and one.surely[0] < one.surely[1] and span.contains(one.source)
    ]
    found: list[int] = []
    for n in range(len(some)):
        one = some[n]
        spans = [
            other.told
            for other in whole
            if (_is_before(other, one) if span.ahead else _is_before(one, other))
        ]
        if not spans or not is_covered(one.shown, spans if known is None else [*spans, *known]):
            found.append(n)
    return found


def _is_before(one: Extent, other: Extent) -> bool:
    """Whether one family certainly ends where another begins, or at a lower place."""
    if one.source[1] < other.source[0]:
        return True
    return (
        one.surely[0] <= one.surely[1]
        and other.surely[0] <= other.surely[1]
        and _have_common(one.last_keys, other.first_keys)
    )


@final
class SightGroup:
    """Connected places from which an obstacle surely is seen: the one that begins first, the one that ends
    last.

    Lines with equal keys meet the leg in one place. So a family that begins with the line with which the
    first begins, or ends with that with which the last ends, is seen from no place beyond.
    """

    def __init__(self, group: list[Source]) -> None:
        self.first = self.last = group[0]
        for source in group:
            if source.surely[1] > self.last.surely[1]:
                self.last = source

    def contains(self, source: Source) -> bool:
        """Whether a family certainly is seen from here alone."""
        low, high = source.outer
        first, last = self.first, self.last
        begins, ends = first.surely[0] <= low, high <= last.surely[1]
        if source.surely[0] <= source.surely[1]:
            begins = begins or _have_common(source.extent.first_keys, first.extent.first_keys)
            ends = ends or _have_common(source.extent.last_keys, last.extent.last_keys)
        return begins and ends


def _have_common(keys: list[int], others: list[int]) -> bool:
    return any(key in others for key in keys)


def _joined(sources: list[Source]) -> list[list[Source]]:
    """Intervals in groups that are connected, since they overlap or have an end in common.

    Each group is in the order of its lower ends.
    """
    count = len(sources)
    ends = [(sources[n].surely[0], sources[n].surely[1], n) for n in range(count)]
    order = [n for _, _, n in sorted(ends)]
    leader = list(range(count))
    at: dict[int, int] = {}
    reached, last = -inf, -1
    for n in order:
        low, high = sources[n].surely
        if last >= 0 and low <= reached:
            _unite(leader, last, n)
        if high >= reached:
            reached, last = high, n
        for key in sources[n].extent.first_keys + sources[n].extent.last_keys:
            if key in at:
                _unite(leader, at[key], n)
            else:
                at[key] = n
    groups: dict[int, list[Source]] = {}
    for n in order:
        first = _leader(leader, n)
        if first not in groups:
            groups[first] = []
        groups[first].append(sources[n])
    return list(groups.values())


def _leader(leader: list[int], n: int) -> int:
    while leader[n] != n:
        leader[n] = leader[leader[n]]
        n = leader[n]
    return n


def _unite(leader: list[int], a: int, b: int) -> None:
    leader[_leader(leader, b)] = _leader(leader, a)
