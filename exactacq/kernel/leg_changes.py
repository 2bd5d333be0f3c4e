"""Where the sight of edges changes along a leg: from where they are seen, and the order of the ends.

An edge is seen from a union of closed intervals, one for each family that shows it. Most ends are no events:
they lie within the union, or a family begins on the line where another ends. Floats and the numbers of lines
tell that. Of those left floats tell the order, but for *clusters*, which exact numbers have to part.
"""

from __future__ import annotations

from math import inf
from typing import Final, final

from exactacq.kernel.bounded import TINY, UNIT, cross, length, product, total
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import Extent, Span, extent, views_in_range
from exactacq.kernel.family_images import AHEAD, BEHIND, CONTACT, NONE, FamilyImage
from exactacq.kernel.images import ROLLING, SLIDING, TURNING
from exactacq.kernel.leg_spans import LegSpan
from exactacq.kernel.line_keys import key_of_corners, key_of_normal
from exactacq.kernel.lines import Line, meets_straight
from exactacq.kernel.range_cuts import range_cut

BEGINS: Final = 0
"""The edge is seen from there on, by the parameter."""
ENDS: Final = 1
"""It is seen up to there."""
TURNS: Final = 2
"""What bounds the view of it becomes another."""

CLEAR: Final = 0.001
"""A line that leaves the middle of a circle so many radii aside meets it in two places that are no nearer."""
NARROW: Final = 0.0001
"""Parameters with bounds that are no wider tell these places apart."""
SHORT: Final = -1
LONG: Final = 1
EITHER: Final = 0
BOTH_SHORT: Final = (SHORT, SHORT)

BEFORE: Span = (-inf, -inf)
"""Instead of the bounds of a place that is the start of the leg's span or lies before it."""
AFTER: Span = (inf, inf)
"""Of one that is its end or lies behind it."""


@final
class Sight:
    """An interval of a leg from which edge ``edge`` is seen along the lines of a family.

    Both ends have bounds, in extended numbers, and the keys of the lines there: equal keys and bounds that
    overlap, one place. ``name`` tells the feature and side that bound the views, `NONE` if none does. The
    view at an end is shorter than the range (`SHORT`), as long, or either. ``origin`` is what it comes from.
    """

    def __init__(
        self,
        edge: int,
        name: int,
        low: Span,
        high: Span,
        low_keys: list[int],
        high_keys: list[int],
        lengths: tuple[int, int],
        origin: object,
    ) -> None:
        self.edge, self.name = edge, name
        self.low, self.high = low, high
        self.low_keys, self.high_keys = low_keys, high_keys
        self.lengths, self.origin = lengths, origin


@final
class Turn:
    """A change at an end of a sight, number ``end``: of edge ``edge``, at place ``rank`` in the leg's order.

    It ``is_short`` if a view of the edge from there is known to be shorter than the range; else one at an end
    of ``unsure`` may be.
    """

    def __init__(self, rank: int, edge: int, kind: int, end: int, is_short: bool, unsure: list[int]) -> None:
        self.rank, self.edge, self.kind, self.end = rank, edge, kind, end
        self.is_short, self.unsure = is_short, unsure


@final
class AtEnd:
    """An edge in sight inside a leg up to its end, with the names of what bounds its views; see `Turn`."""

    def __init__(self, edge: int, names: list[int], is_short: bool, unsure: list[int]) -> None:
        self.edge, self.names = edge, names
        self.is_short, self.unsure = is_short, unsure


@final
class Group:
    """Sights of one edge that surely are connected; which of their ends may be first or last.

    The first one is before the leg if ``before``, the last one behind it if ``after``.
    """

    def __init__(self, lows: list[int], highs: list[int], before: bool, after: bool) -> None:
        self.lows, self.highs, self.before, self.after = lows, highs, before, after


def name_of(feature: int, there: int) -> int:
    """A number for a feature, by its own, and where on the lines what they show is."""
    return feature * 3 + there + 1


def _all_keys(keys: list[int], family: FamilyImage, count: int) -> list[int]:
    """The keys of a line, and if it is a ray or a normal, those by which other families know it."""
    if family.goes_back or not keys:
        return keys
    passed = family.first_corners if keys is family.first_keys else family.last_corners
    own = family.corner
    if own >= 0:
        return keys + [key_of_corners(own, v, count) for v in passed]
    if family.frame[0] == SLIDING:
        return keys + [key_of_normal(family.edges[1], v, count) for v in passed]
    return keys


def sights(
    extents: list[Extent],
    crossing: list[FamilyImage],
    span: LegSpan,
    leg: CurveImage,
    scene: tuple[list[CurveImage], list[int], list[int], tuple[float, float]],
) -> tuple[list[Sight], list[Extent]]:
    """The sights of families of which floats tell both ends, and the families of which they do not.

    *crossing* are the families that the extents of a straight way tell of by their places; the leg lies on
    the curve *leg*. *scene* has its curves, for each the number of the one before it, the numbers of the
    circles of arcs, and bounds of the radius.
    """
    curves, previous, circles, reach = scene
    count = len(circles)
    found: list[Sight] = []
    left: list[Extent] = []
    for one in extents:
        if not one.is_known:
            left.append(one)
            continue
        outer = span.outer(one.source)
        if outer[0] > outer[1] or not (outer[0] < inf and outer[1] > -inf):
            continue
        origin, is_way = one.origin, False
        if isinstance(origin, int):
            family, is_way = crossing[origin], True
        elif isinstance(origin, FamilyImage):
            family = origin
        else:
            left.append(one)
            continue
        name, edge = _bounded_by(family, one.there, circles), _seen(family, one, previous)
        low, high = one.source
        first, last = one.surely
        if first > last:
            cut = _cut(one, family, is_way, (edge, name), leg, curves, reach, count)
            if cut is None:
                left.append(one)
            else:
                found.append(cut)
            continue
        lows, highs = one.first_keys, one.last_keys
        if leg.sense:
            lows, highs = _keys_on_arc(family, one.here, low, leg)
        lows, highs = _all_keys(lows, family, count), _all_keys(highs, family, count)
        found.append(Sight(edge, name, (low, first), (last, high), lows, highs, BOTH_SHORT, one))
    return found, left


def _seen(family: FamilyImage, one: Extent, previous: list[int]) -> int:
    """The edge that is seen along some lines: from behind a corner that they touch, that before it."""
    is_before = one.there == CONTACT and one.here == BEHIND and family.fixed
    return previous[family.corner] if is_before else one.edge


def _bounded_by(family: FamilyImage, there: int, circles: list[int]) -> int:
    """The name of what bounds the views to a part of a family, if they are along tangents."""
    kind, contact = family.frame[0], family.edges[1]
    if not family.goes_back or kind not in (TURNING, ROLLING):
        return NONE
    return name_of(len(circles) + circles[contact] if kind == ROLLING else contact, there)


def _cut(
    one: Extent,
    family: FamilyImage,
    is_way: bool,
    seen: tuple[int, int],
    leg: CurveImage,
    curves: list[CurveImage],
    reach: tuple[float, float],
    count: int,
) -> Sight | None:
    """The sight of a family that leaves the range at one end, if floats tell where.

    *seen* are the edge and the name of what bounds the views of it.
    """
    edge, name = seen
    shown = None if one.there == CONTACT else curves[one.edge]
    end, cut = range_cut(family, one.here, one.there, leg, shown, reach)
    if end == 0:
        return None
    line, keys = (family.first, family.first_keys) if end > 0 else (family.last, family.last_keys)
    if is_way:
        _, _, u, error, *_ = meets_straight(line, leg)
        near = u - error, u + error
    else:
        near = family.places(one.here)[0 if end > 0 else 1][:2]
    keys = _all_keys(keys, family, count)
    if near[1] <= cut[0]:
        return Sight(edge, name, near, cut, keys, [], (SHORT, LONG), one)
    if cut[1] <= near[0]:
        return Sight(edge, name, cut, near, [], keys, (LONG, SHORT), one)
    return None


def normal_sights(
    normals: list[FamilyImage],
    count: int,
    curves: list[CurveImage],
    reach: tuple[float, float],
    first_key: int,
) -> tuple[list[Sight], list[FamilyImage]]:
    """The sights along some normals of a straight way to one side; of *count* in all, from start to end.

    And those normals of which floats do not tell what they show. The keys of the lines go down from
    *first_key*.
    """
    found: list[Sight] = []
    left: list[FamilyImage] = []
    for family in normals:
        edge, k = family.edges[2], family.number
        one: Extent | None = None
        if family.is_known:
            a, b, c, d = family.fraction
            x, y, _, _, p, _ = family.first
            u, v, _, _, q, _ = family.last
            source = (a, b, x, y, p), (c, d, u, v, q)
            shown = family.places(AHEAD)
            told = views_in_range(family, (CONTACT, AHEAD), (source, shown), None, curves, reach)
            one = extent(edge, source, shown, told, ([], []), k, CONTACT, AHEAD)
            if one is None:
                continue
        if one is None or one.surely[0] > one.surely[1]:
            left.append(family)
            continue
        low = BEFORE if k == 0 else (one.source[0], one.surely[0])
        high = AFTER if k == count - 1 else (one.surely[1], one.source[1])
        found.append(Sight(edge, NONE, low, high, [first_key - k], [first_key - k - 1], BOTH_SHORT, family))
    return found, left


def _keys_on_arc(family: FamilyImage, here: int, low: float, arc: CurveImage) -> tuple[list[int], list[int]]:
    """The keys of the lines at the ends of a sight from an arc, as far as these tell places.

    A line meets an arc twice. Bounds of the parameter part these two, unless it nearly touches the circle.
    """
    one, other = family.places(here)
    first = family.first_keys if _tells(family.first, one[0], one[1], arc) else []
    last = family.last_keys if _tells(family.last, other[0], other[1], arc) else []
    return (first, last) if one[0] <= low else (last, first)


def _tells(line: Line, low: float, high: float, arc: CurveImage) -> bool:
    """Whether the two places of a line on a circle are far apart, and bounds of a parameter are narrow."""
    if low == high:
        return True
    if not high - low <= NARROW:
        return False
    x, y, dx, dy, ce, de = line
    ox, p = total(arc.x, UNIT * abs(arc.x) + TINY, -x, ce)
    oy, q = total(arc.y, UNIT * abs(arc.y) + TINY, -y, ce)
    height, bound = cross(ox, oy, max(p, q), dx, dy, de)
    size, size_bound = length(dx, dy, de)
    reach, reach_bound = product(arc.radius, UNIT * arc.radius, size, size_bound)
    # Half the chord is at least the root of 2 CLEAR radii, and the parameter grows by half the angle or more.
    return abs(height) + bound < (reach - reach_bound) * (1.0 - CLEAR)


@final
class LegChanges:
    """The changes along a leg, from all sights there; *own* is the leg's edge: it sees itself all along.

    Ends have numbers: 2 k and 2 k + 1 are those of sight k, and the last two those of the leg.
    """

    def __init__(self, found: list[Sight], span: LegSpan, own: int) -> None:
        self.sights, self.span, self.own = found, span, own
        self.low: list[float] = []
        self.high: list[float] = []
        for sight in found:
            self.low += [sight.low[0], sight.high[0]]
            self.high += [sight.low[1], sight.high[1]]
        self.low += [span.low[0], span.high[0]]
        self.high += [span.low[1], span.high[1]]
        self.leader = list(range(len(self.low)))
        self._rank: dict[int, int] = {}
        self._order: list[list[int]] = []
        self._groups: dict[int, list[Group]] = {}
        self._turns: dict[int, dict[tuple[int, int], int]] = {}
        self._find()

    def clusters(self) -> list[list[int]]:
        """The places that matter and that floats do not part, each as the number of one end there."""
        return [cluster for cluster in self._order if len(cluster) > 1]

    def is_throughout(self, edge: int) -> bool:
        """Whether an edge surely is in sight all along the leg."""
        return any(group.before and group.after for group in self._groups.get(edge, []))

    def is_out(self, end: int) -> bool:
        """Whether an end surely does not lie inside the leg."""
        return self.high[end] <= self.span.low[0] or self.low[end] >= self.span.high[1]

    def _find(self) -> None:
        of: dict[int, list[int]] = {}
        for k in range(len(self.sights)):
            low, high = 2 * k, 2 * k + 1
            if self.high[high] <= self.span.low[0] or self.low[low] >= self.span.high[1]:
                continue
            edge = self.sights[k].edge
            if edge in of:
                of[edge].append(k)
            else:
                of[edge] = [k]
        self._name_places(of)
        matter: set[int] = {len(self.low) - 2, len(self.low) - 1}
        for edge, some in of.items():
            self._turns[edge] = self._unbalanced(some)
            matter.update([place for _, place in self._turns[edge]])
            if edge != self.own:
                groups = self._connected(some)
                self._groups[edge] = groups
                for group in groups:
                    matter.update([self.leader[end] for end in group.lows + group.highs])
        cluster: list[int] = []
        reached = -inf
        for _, place in sorted([(self.low[place], place) for place in matter]):
            if cluster and self.low[place] > reached:
                self._order.append(cluster)
                cluster = []
            reached = max(reached, self.high[place]) if cluster else self.high[place]
            cluster.append(place)
        self._order.append(cluster)

    def _name_places(self, of: dict[int, list[int]]) -> None:
        """Find which ends are one place since they lie on one line; they share their bounds."""
        at: dict[int, list[int]] = {}
        for some in of.values():
            for k in some:
                sight = self.sights[k]
                for end, keys in ((2 * k, sight.low_keys), (2 * k + 1, sight.high_keys)):
                    if not self.is_out(end):
                        for key in keys:
                            if key in at:
                                self._meet(end, at[key])
                            else:
                                at[key] = [end]
        for end in range(len(self.leader)):
            place = _leader(self.leader, end)
            self.leader[end] = place
            self.low[place] = max(self.low[place], self.low[end])
            self.high[place] = min(self.high[place], self.high[end])
        for end in range(len(self.leader)):
            place = self.leader[end]
            self.low[end], self.high[end] = self.low[place], self.high[place]

    def _meet(self, end: int, others: list[int]) -> None:
        for other in others:
            if self.low[end] <= self.high[other] and self.low[other] <= self.high[end]:
                self.leader[_leader(self.leader, end)] = _leader(self.leader, other)
                return
        others.append(end)

    def _unbalanced(self, some: list[int]) -> dict[tuple[int, int], int]:
        """How many windows of a name begin at a place, less those that end, where that is not 0."""
        balance: dict[tuple[int, int], int] = {}
        for k in some:
            name = self.sights[k].name
            if name == NONE:
                continue
            for end, step in ((2 * k, 1), (2 * k + 1, -1)):
                if not self.is_out(end):
                    at = name, self.leader[end]
                    count = balance.get(at, 0) + step
                    if count:
                        balance[at] = count
                    else:
                        del balance[at]
        return balance

    def _connected(self, some: list[int]) -> list[Group]:
        """Sights of one edge in groups that surely are connected, for they overlap or share a place."""
        leader = list(range(len(some)))
        at: dict[int, int] = {}
        order: list[tuple[float, float, int]] = []
        for n in range(len(some)):
            low, high = 2 * some[n], 2 * some[n] + 1
            for end in (low, high):
                place = self.leader[end]
                if place in at:
                    leader[_leader(leader, n)] = _leader(leader, at[place])
                else:
                    at[place] = n
            if self.high[low] <= self.low[high]:
                order.append((self.high[low], self.low[high], n))
        reached, last = -inf, -1
        for first, until, n in sorted(order):
            if last >= 0 and first <= reached:
                leader[_leader(leader, n)] = _leader(leader, last)
            if last < 0 or until >= reached:
                reached, last = until, n
        while True:
            heads = [_leader(leader, n) for n in range(len(some))]
            cores = self._cores(some, heads)
            joined = False
            for n in range(len(some)):
                for head, core in cores.items():
                    if head != heads[n] and self._is_met(some[n], core):
                        leader[_leader(leader, n)] = _leader(leader, head)
                        joined = True
            if not joined:
                return self._groups_of(some, heads, cores)

    def _cores(self, some: list[int], heads: list[int]) -> dict[int, Span]:
        """What each group surely covers, by its head."""
        cores: dict[int, Span] = {}
        for n in range(len(some)):
            low, high = self.high[2 * some[n]], self.low[2 * some[n] + 1]
            if heads[n] in cores:
                first, last = cores[heads[n]]
                cores[heads[n]] = min(low, first), max(high, last)
            else:
                cores[heads[n]] = low, high
        return cores

    def _groups_of(self, some: list[int], heads: list[int], cores: dict[int, Span]) -> list[Group]:
        found: dict[int, Group] = {}
        for n in range(len(some)):
            head, low, high = heads[n], 2 * some[n], 2 * some[n] + 1
            if head not in found:
                found[head] = Group([], [], False, False)
            group = found[head]
            if self.high[low] <= self.span.low[0]:
                group.before = True
            elif not self.is_out(low) and not self._is_within(low, cores[head]):
                group.lows.append(low)
            if self.low[high] >= self.span.high[1]:
                group.after = True
            elif not self.is_out(high) and not self._is_within(high, cores[head]):
                group.highs.append(high)
        return list(found.values())

    def _is_met(self, sight: int, core: Span) -> bool:
        """Whether an end of a sight surely lies strictly inside what is covered."""
        return self._is_within(2 * sight, core) or self._is_within(2 * sight + 1, core)

    def _is_within(self, end: int, core: Span) -> bool:
        return core[0] < self.low[end] and self.high[end] < core[1]

    def settle(self, clusters: list[list[list[int]]]) -> list[Turn]:
        """All changes inside the leg, with each of `clusters` parted into equal places in order."""
        rank = next_cluster = 0
        for cluster in self._order:
            parts = [cluster]
            if len(cluster) > 1:
                parts = clusters[next_cluster]
                next_cluster += 1
            for part in parts:
                for place in part:
                    self._rank[place] = rank
                rank += 1
        found: list[Turn] = []
        for edge, turns in self._turns.items():
            taken: set[int] = set()
            if edge in self._groups:
                self._sighted(edge, found, taken)
            self._turned(edge, turns, taken, found)
        return found

    def _at(self, end: int) -> int:
        return self._rank[self.leader[end]]

    def _is_inside(self, rank: int) -> bool:
        return self._at(len(self.low) - 2) < rank < self._at(len(self.low) - 1)

    def _sighted(self, edge: int, found: list[Turn], places: set[int]) -> None:
        """Add where an edge comes into sight and goes out of it, and these places; not if they are one."""
        ends: list[int] = []
        for group in self._groups[edge]:
            ends += group.lows + group.highs
        for low, begin, high, end in self._spans(edge):
            if low == high:
                continue
            for rank, kind, at in ((low, BEGINS, begin), (high, ENDS, end)):
                if self._is_inside(rank):
                    places.add(rank)
                    there = [end for end in ends if self._at(end) == rank]
                    is_short = any(self._length(end) == SHORT for end in there)
                    unsure = [end for end in there if self._length(end) == EITHER]
                    found.append(Turn(rank, edge, kind, at, is_short, unsure))

    def at_end(self, is_high: bool) -> list[AtEnd]:
        """The edges that are in sight inside the leg up to its low or its high end, once it is settled."""
        step = 1 if is_high else 0
        rank = self._at(len(self.low) - 2 + step)
        found: list[AtEnd] = []
        for edge in self._groups:
            spans = self._spans(edge)
            is_seen = any(low < rank <= high if is_high else low <= rank < high for low, _, high, _ in spans)
            if is_seen:
                found.append(self._views_at_end(edge, step, rank))
        return found

    def _views_at_end(self, edge: int, step: int, rank: int) -> AtEnd:
        """What is seen of an edge up to an end of the leg: by sights that reach it and do not begin there."""
        one = AtEnd(edge, [], False, [])
        for k in range(len(self.sights)):
            sight, end, other = self.sights[k], 2 * k + step, 2 * k + 1 - step
            if sight.edge != edge or self._passes(other, step) or self._rank_of(other) == rank:
                continue
            is_beyond = self._passes(end, step)
            if is_beyond or self._rank_of(end) == rank:
                if sight.name != NONE and sight.name not in one.names:
                    one.names.append(sight.name)
                if is_beyond or self._length(end) == SHORT:
                    one.is_short = True
                elif self._length(end) == EITHER:
                    one.unsure.append(end)
        one.names.sort()
        return one

    def _rank_of(self, end: int) -> int:
        """The rank of a place, -2 if it does not matter."""
        return self._rank.get(self.leader[end], -2)

    def _passes(self, end: int, step: int) -> bool:
        """Whether an end of a sight surely is at the high end of the leg or behind it, or at the low one."""
        return self.low[end] >= self.span.high[1] if step else self.high[end] <= self.span.low[0]

    def _spans(self, edge: int) -> list[tuple[int, int, int, int]]:
        """The stretches of which an edge is in sight: ranks and ends where they begin and end."""
        spans: list[tuple[int, int, int, int]] = []
        most = len(self._rank)
        for group in self._groups[edge]:
            low, begin, high, end = most, NONE, -1, NONE
            for candidate in group.lows:
                if self._at(candidate) < low:
                    low, begin = self._at(candidate), candidate
            for candidate in group.highs:
                if self._at(candidate) > high:
                    high, end = self._at(candidate), candidate
            if group.before:
                low = -1
            if group.after:
                high = most
            if low <= high:
                spans.append((low, begin, high, end))
        spans.sort()
        found: list[tuple[int, int, int, int]] = []
        k = 0
        while k < len(spans):
            low, begin, high, end = spans[k]
            k += 1
            while k < len(spans) and spans[k][0] <= high:
                if spans[k][2] > high:
                    high, end = spans[k][2], spans[k][3]
                k += 1
            found.append((low, begin, high, end))
        return found

    def _length(self, end: int) -> int:
        return self.sights[end // 2].lengths[end % 2]

    def _turned(
        self, edge: int, turns: dict[tuple[int, int], int], taken: set[int], found: list[Turn]
    ) -> None:
        """Add where other windows begin or end, but not at places that are *taken*."""
        balance: dict[tuple[int, int], int] = {}
        end_at: dict[int, int] = {}
        for (name, place), count in turns.items():
            rank = self._rank[place]
            end_at[rank] = place
            balance[name, rank] = balance.get((name, rank), 0) + count
        places = {rank for (_, rank), count in balance.items() if count}
        for rank in sorted(places):
            if rank not in taken and self._is_inside(rank):
                found.append(Turn(rank, edge, TURNS, end_at[rank], False, []))


def _leader(leader: list[int], n: int) -> int:
    while leader[n] != n:
        leader[n] = leader[leader[n]]
        n = leader[n]
    return n
