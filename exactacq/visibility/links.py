"""Links: the shortest visible segments between boundaries.

v(i, j) is the least length of a free segment between the boundaries of obstacles i and j. There are three
kinds of shortest segments. One touches no feature: it is a local minimum of the distance, from
`exactacq.geometry.nearest_points`. One touches one feature and is stationary when it turns about it. One
touches two or more features and cannot turn at all. The last two kinds come from the tangent families of
features of third obstacles (`rotational_sweep`, `chords`): a shortest segment meets i and j at its ends
only, so their own features play no part. Candidates are visited in the order of proven lower bounds until
the next one cannot be shorter.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from heapq import heappop, heappush
from itertools import count, islice
from typing import TypeAlias

import numpy as np
from flint import arb

from exactacq.cached import cached_property
from exactacq.errors import deciding
from exactacq.geometry.coordinates import raw
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.late import BITS
from exactacq.geometry.nearest_points import Nearest, NearestFamily, NearestFamilyKind, nearest_points
from exactacq.geometry.points import Point
from exactacq.kernel.bound_lines import NOTHING
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable, Floats, Ints
from exactacq.scene.gaps import box_gaps, may_face, near_hull, pair_bounds
from exactacq.scene.scene import Scene, as_scene, radius_of
from exactacq.visibility.chords import Chord, chord_at, critical, length_ball
from exactacq.visibility.congruent_chords import CongruentChords
from exactacq.visibility.features import Feature, directions_at, leaving
from exactacq.visibility.features import features as scene_features
from exactacq.visibility.free_segment import is_free, walk_line
from exactacq.visibility.free_translates import free_pieces
from exactacq.visibility.line_families import EAST, corner_sectors
from exactacq.visibility.pinched_chords import PinchedLine, first_met
from exactacq.visibility.rotational_sweep import Cell, Pencil, pencil
from exactacq.visibility.sensor_range import Range


class _Start(str):
    """The node of the start: equal to "S", with its hash, and less than every number of an obstacle."""

    __slots__ = ()

    def __lt__(self, other: int | str) -> bool:
        return isinstance(other, int) or str(self) < other

    def __gt__(self, other: int | str) -> bool:
        return not isinstance(other, int) and str(self) > other

    def __le__(self, other: int | str) -> bool:
        return isinstance(other, int) or str(self) <= other

    def __ge__(self, other: int | str) -> bool:
        return not isinstance(other, int) and str(self) >= other

    def __reduce__(self) -> str:
        """A copy is the constant itself."""
        return "START"


GAPS_AT_ONCE = 2**16
"""Gaps of boxes, or of edges, that are computed in one array."""

START = _Start("S")
Node: TypeAlias = "int | str"
Shortest: TypeAlias = "Chord | NearestFamily"


@dataclass(frozen=True, slots=True)
class Link:
    """v between two nodes: the length, and every segment (or continuum of segments) that attains it."""

    source: Node
    target: int
    length: Real
    shortest: tuple[Shortest, ...]

    def segments(self, position: Point | None = None) -> list[tuple[Point, Point]]:
        """Leave and hit points of the shortest segments among which every tie rule's choice is.

        A continuum gives its ends, its westernmost segment, and that from *position*.
        """
        return [pair for item in self.shortest for pair in _extremes(item, position)]

    def reversed(self) -> Link:
        """This link with source and target exchanged; the source must be an obstacle, not the start."""
        assert isinstance(self.source, int)
        return Link(self.target, self.source, self.length, tuple(_flipped(s) for s in self.shortest))


class Links:
    """The links of one scene and radius, computed on demand and kept.

    *radius*, None for the scene's own, is rational and positive: `InvalidScene` otherwise. ``between(i, j)``
    costs less than a millisecond where the closest points see each other; otherwise the pencils of the
    features between i and j are swept once and kept.
    """

    def __init__(self, scene: Scene, radius: object) -> None:
        self.scene, self.radius = as_scene(scene), radius_of(scene, radius, scene.start)
        self.reach, self.limit = Range(self.radius).above, Real(self.radius)
        self.table = EdgeTable(scene.obstacles)
        self._between: dict[tuple[int, int], Link | None] = {}
        self._pencils: dict[int, dict[tuple[int, int], list[tuple[Pencil, Cell]]]] = {}
        self._pinched: dict[int, list[PinchedLine]] = {}
        self._from_start: tuple[Point, dict[int, Link]] | None = None
        self._congruent = CongruentChords()

    @cached_property
    def features(self) -> list[Feature]:
        """The features of the scene."""
        return scene_features(self.table)

    @cached_property
    def spots(self) -> tuple[Floats, Floats]:
        """Feature centres in floats, and radii that cover the rounding of the centres and of boxes."""
        centers = [(float(f.center[0]), float(f.center[1])) for f in self.features]
        sizes = [float(Real(f.radius_sq).sqrt()) if f.round else 0.0 for f in self.features]
        return np.array(centers).reshape(-1, 2), np.array(sizes) + 8 * self.table.roundoff

    @property
    def count(self) -> int:
        """Number of obstacles, the enclosure included."""
        return len(self.scene.obstacles)

    # -- between two obstacles ---------------------------------------------------------------------

    def between(self, i: int, j: int) -> Link | None:
        """The link from obstacle i to obstacle j, or None if no free segment of length <= radius exists."""
        key = (min(i, j), max(i, j))
        if key not in self._between:
            with deciding("what the link between the obstacles O{} and O{} is", *(k + 1 for k in key)):
                self._between[key] = self._shortest_between(*key)
        link = self._between[key]
        return link if link is None or link.source == i else link.reversed()

    def lower_bounds(self, i: int, others: Sequence[int]) -> Floats:
        """Lower bounds of v(i, j) for some others j: the gaps between boxes of edges of i and the box of j.

        A box around all of i would be around all that i encloses.
        """
        hulls = self.table.hulls[others]
        found, step = np.full(len(hulls), np.inf), max(1, GAPS_AT_ONCE // max(len(hulls), 1))
        edges = [*self.table.edges_of(i)]
        for k in range(0, len(edges), step):
            boxes = self.table.boxes[edges[k : k + step], None]
            found = np.minimum(found, self._gaps(boxes, hulls).min(axis=0))
        return found

    def _gaps(self, boxes: Floats, hulls: Floats) -> Floats:
        """Lower bounds of how far some boxes (rows) are from others (columns)."""
        apart = np.maximum(np.maximum(hulls[:, :2] - boxes[..., 2:], boxes[..., :2] - hulls[:, 2:]), 0.0)
        gaps: Floats = np.hypot(apart[..., 0], apart[..., 1]) * (1 - 1e-14) - self.table.roundoff
        return np.maximum(gaps, 0.0)

    def neighbours(self, i: int) -> list[int]:
        """The obstacles other than i whose bounding boxes come within the radius of i's."""
        near = self._box_neighbours(self.table.hulls[i])
        return [j for j in near if j != i]

    def _box_neighbours(self, box: Floats) -> list[int]:
        edges = self.table.near((box[0], box[1]), (box[2], box[3]), self.reach)
        return [int(j) for j in np.unique(self.table.owner[edges])]

    def _shortest_between(self, i: int, j: int) -> Link | None:
        best = _Best(self.limit)
        unblocked = self._nearest(self.table.edges_of(i), self.table.edges_of(j), best)
        if not unblocked:
            self._pivoting(i, j, best)
        return best.link(i, j)

    def _nearest(self, left: Sequence[int], right: Sequence[int], best: _Best) -> bool:
        """Offer the free local minima of the distance; whether the least distance itself is free."""
        pairs, order = self._close_pairs(left, right), count(len(left) * len(right))
        heap: list[tuple[float, int, tuple[int, int] | Nearest | NearestFamily]] = [*islice(pairs, 1)]
        least: Real | None = None
        seen: set[Hashable] = set()
        while heap and heap[0][0] <= best.guess:
            _, _, item = heappop(heap)
            if isinstance(item, tuple):
                for pair in islice(pairs, 1):
                    heappush(heap, pair)
                for found in self._minima(*item):
                    if isinstance(found, Nearest):
                        # A vertex is found once for each of its edges.
                        ends = found.start.key, found.end.key
                        if ends in seen:
                            continue
                        seen.add(ends)
                    heappush(heap, (_at_least(float(found.distance_sq) ** 0.5), next(order), found))
                continue
            length = item.distance_sq.sqrt()
            if least is None or length < least:
                least = length
            if best.length.compare(length) < 0:
                continue
            for piece in self._free_part(item, length):
                best.offer(length, piece)
        return least is not None and best.found and best.length == least

    def _close_pairs(
        self, left: Sequence[int], right: Sequence[int]
    ) -> Iterator[tuple[float, int, tuple[int, int]]]:
        """The pairs of edges that a segment within the radius may join, by lower bounds, with numbers."""
        a, b = np.array(left, dtype=np.intp), np.array(right, dtype=np.intp)
        step = max(1, GAPS_AT_ONCE // len(b))
        rows = []
        for k in range(0, len(a), step):
            some = a[k : k + step]
            bounds = pair_bounds(self.table, some, b)
            r, c = np.nonzero((bounds <= self.reach) & may_face(self.table, some, b))
            rows.append((bounds[r, c], some[r], b[c]))
        lows, ones, others = map(np.concatenate, zip(*rows, strict=True))
        for n, k in enumerate(np.argsort(lows, kind="stable").tolist()):
            yield float(lows[k]), n, (int(ones[k]), int(others[k]))

    def _minima(self, a: int, b: int) -> Iterator[Nearest | NearestFamily]:
        """Local minima of the distance near two edges: of the boundaries, not only of the edges."""
        for found in nearest_points(self.table.curves[a], self.table.curves[b]):
            if isinstance(found, NearestFamily) or (
                self._is_foot(a, found.start, found.end) and self._is_foot(b, found.end, found.start)
            ):
                yield found

    def _is_foot(self, e: int, foot: Point, other: Point) -> bool:
        """Whether a vertex of edge e does not come nearer to a point along the neighbouring edge.

        If it does, nothing is lost: a segment that only a third obstacle keeps from sliding is held by a
        feature of that obstacle.
        """
        curves = self.table.curves
        if foot is curves[e].start:
            x, y = leaving(curves[self.table.preceding[e]], at_end=True)
            x, y = -x, -y
        elif foot is curves[e].end:
            x, y = leaving(curves[self.table.following[e]], at_end=False)
        else:
            return True
        nearer: Real = (other.x - foot.x) * x + (other.y - foot.y) * y
        return nearer.sign() <= 0

    def _free_part(self, item: Nearest | NearestFamily, length: Real) -> Iterator[Shortest]:
        """What is free of the nearest points of two edges, at a distance of *length*."""
        if isinstance(item, NearestFamily):
            yield from free_pieces(self.table, item)
        elif is_free(self.table, item.start, item.end):
            yield Chord(item.start, item.end, length)

    def _pivoting(self, i: int, j: int, best: _Best) -> None:
        """Offer the chords from i to j that features of third obstacles hold.

        What may be or hold the least is looked at first: features, bounded by boxes and then by edges, and
        their cells.
        """
        near = self._features_near(i)
        if not near:
            return
        centers, sizes = (spots[near] for spots in self.spots)
        bounds = box_gaps(centers, self.table.hulls[i], sizes) + box_gaps(centers, self.table.hulls[j], sizes)
        order = count()
        heap: list[tuple[float, int, Callable[[], None]]] = []

        def push(bound: float, step: Callable[[], None]) -> None:
            if bound <= best.guess:
                heappush(heap, (bound, next(order), step))

        def bound_by_edges(k: int) -> None:
            push(self.clearance(k, edges[0]) + self.clearance(k, edges[1]), partial(look_into, k))

        def look_into(k: int) -> None:
            for ends in ((i, j), (j, i)):
                for sweep, cell in self._cells(k).get(ends, ()):
                    push(self._cell_bound(k, cell), partial(offer, sweep, cell, ends))
            for line in self._pinched[k]:
                for ends in ((i, j), (j, i)):
                    if (chord := line.chord(*ends)) is not None:
                        offer_one(chord, ends)

        def offer(sweep: Pencil, cell: Cell, ends: tuple[int, int]) -> None:
            for chord in self._cell_chords(sweep, cell, best):
                offer_one(chord, ends)

        def offer_one(chord: Chord, ends: tuple[int, int]) -> None:
            best.offer(chord.length, chord if ends == (i, j) else chord.reversed())

        edges = [np.array(self.table.edges_of(one), dtype=np.intp) for one in (i, j)]
        close = np.flatnonzero(bounds <= best.guess)
        # A chord lies in the convex hull of what it joins, and with it the place where a feature holds it.
        margins = sizes[close] + 4 * self.table.roundoff
        between = near_hull(centers[close], _corners(self.table.hulls[[i, j]]), margins)
        for at in close[between].tolist():
            k = near[at]
            if self.features[k].owner not in (i, j):
                push(float(bounds[at]), partial(bound_by_edges, k))
        while heap and heap[0][0] <= best.guess:
            _, _, step = heappop(heap)
            step()

    def _features_near(self, i: int) -> list[int]:
        """The features that may hold a chord of obstacle i, in order: it touches them within the radius."""
        x0, y0, x1, y1 = self.table.hulls[i].tolist()
        edges = self.table.near((x0, y0), (x1, y1), self.reach)
        return sorted(k for e in edges for k in self._features_of.get(e, ()))

    @cached_property
    def _features_of(self) -> dict[int, list[int]]:
        """The features by the first of the edges that meet at each."""
        found: dict[int, list[int]] = {}
        for k, feature in enumerate(self.features):
            found.setdefault(feature.edges[0], []).append(k)
        return found

    def _cells(self, k: int) -> dict[tuple[int, int], list[tuple[Pencil, Cell]]]:
        """Cells of feature k by the obstacles behind and ahead; its pinched lines are found with them."""
        if k not in self._pencils:
            feature, owner = self.features[k], self.table.owner
            groups: dict[tuple[int, int], list[tuple[Pencil, Cell]]] = {}
            self._pinched[k] = []
            for sector in feature.sectors:
                vertex = NOTHING if feature.round else feature.edges[1]
                sweep = pencil(self.table, sector, feature.edges, self.reach, vertex=vertex)
                for cell in sweep.cells:
                    if cell.behind is not None and cell.ahead is not None:
                        ends = int(owner[cell.behind]), int(owner[cell.ahead])
                        if ends[0] != ends[1]:
                            groups.setdefault(ends, []).append((sweep, cell))
                self._pinched[k] += [
                    PinchedLine.of(sweep, feature, t, passed, self.reach) for t, passed in sweep.pinches
                ]
            self._pencils[k] = groups
        return self._pencils[k]

    def _cell_bound(self, k: int, cell: Cell) -> float:
        """Lower bound of the chords of a cell: the ways from the feature to the two edges."""
        assert cell.behind is not None
        assert cell.ahead is not None
        return sum(self.clearance(k, np.array((e,))) for e in (cell.behind, cell.ahead))

    def clearance(self, k: int, edges: Ints) -> float:
        """Lower bound of the way along a tangent of a feature from its contact to the first of some edges."""
        (x, y), size = self.spots[0][k], self.spots[1][k]
        gap = self.table.distance_bounds(float(x), float(y), edges).min()
        return _at_least(float(max(gap**2 - size**2 * (1 + 1e-12), 0.0) ** 0.5))

    def _cell_chords(self, sweep: Pencil, cell: Cell, best: _Best) -> Iterator[Chord]:
        """The chords of a closed cell among which its shortest are, if these may be as short as the best."""
        sector = sweep.sector
        behind = None if cell.behind is None else self.table.curves[cell.behind]
        assert cell.ahead is not None
        ahead = self.table.curves[cell.ahead]
        for t in (cell.low, cell.high):
            if not best.is_shorter_than(length_ball(sector, t, behind, ahead)):
                yield chord_at(sector, t, behind, ahead)
        # A constant length (arcs about the contact's centre) is never the least: it shrinks off the feature.
        stationary = critical(sector, behind, ahead) or []
        for t in stationary:
            if t.compare(cell.low) > 0 and t.compare(cell.high) < 0:
                length = length_ball(sector, t, behind, ahead)
                if best.is_shorter_than(length):
                    continue
                if behind is None or length is None:
                    yield chord_at(sector, t, behind, ahead)
                else:
                    yield self._congruent.chord(sector, t, stationary, (behind, ahead), length)

    # -- from the start ----------------------------------------------------------------------------

    def from_point(self, point: Point) -> dict[int, Link]:
        """The links from a free point with rational coordinates to all obstacles it sees."""
        if self._from_start is None or self._from_start[0] is not point:
            self._from_start = point, self._fan_links(point)
        return self._from_start[1]

    def _fan_links(self, point: Point) -> dict[int, Link]:
        best: dict[int, _Best] = {}
        for e in self.table.edges_at(point):
            owner = int(self.table.owner[e])
            best.setdefault(owner, _Best(self.limit)).offer(Real(0), Chord(point, point, Real(0)))
        for sweep in self._fan(point):
            for cell in sweep.cells:
                if cell.ahead is None:
                    continue
                target = best.setdefault(int(self.table.owner[cell.ahead]), _Best(self.limit))
                self._offer_fan(sweep, cell, target)
            for t, _ in sweep.pinches:
                self._offer_pinched_rays(sweep, t, best)
        links = ((j, found.link(START, j)) for j, found in sorted(best.items()))
        return {j: link for j, link in links if link is not None}

    def _fan(self, point: Point) -> Iterator[Pencil]:
        """All rays from a point, counterclockwise from the east: only what is ``ahead`` of it means anything.

        On a boundary a ray into the obstacle meets nothing.
        """
        own = self.table.edges_at(point)
        breaks = tuple(directions_at(self.table, point, own))
        for sector in corner_sectors(raw(point), EAST, None):
            yield pencil(self.table, sector, own, self.reach, breaks)

    def _offer_fan(self, sweep: Pencil, cell: Cell, best: _Best) -> None:
        assert cell.ahead is not None
        ahead = self.table.curves[cell.ahead]
        if critical(sweep.sector, None, ahead) is None and isinstance(ahead, Arc):
            low = chord_at(sweep.sector, cell.low, None, ahead)
            high = chord_at(sweep.sector, cell.high, None, ahead)
            part = (ahead if ahead.ccw else ahead.reversed()).part(low.end, high.end)
            best.offer(low.length, NearestFamily(NearestFamilyKind.CONCENTRIC, low.start, part))
            return
        for chord in self._cell_chords(sweep, replace(cell, behind=None), best):
            best.offer(chord.length, chord)

    def _offer_pinched_rays(self, sweep: Pencil, t: Real, best: dict[int, _Best]) -> None:
        contact, direction = sweep.sector.touch(t)
        size = direction.norm_sq().sqrt()
        _, ahead = walk_line(self.table, sweep.sector, t, self.reach)
        for j, tau in first_met(self.table, ((e, tau) for tau, e in ahead.hits)).items():
            chord = Chord(contact, contact + direction * tau, tau * size)
            best.setdefault(j, _Best(self.limit)).offer(chord.length, chord)


class _Best:
    """The least length offered so far, at most the limit, and all that attain it."""

    def __init__(self, limit: Real) -> None:
        self.length, self.found = limit, False
        self.guess = float(limit) * (1 + 1e-12)
        self.shortest: list[Shortest] = []

    def is_shorter_than(self, length: arb | None) -> bool:
        """Whether the least length is clearly less than one in a ball, which need not be made then."""
        return length is not None and bool(self.length.ball(BITS) < length)

    def offer(self, length: Real, item: Shortest) -> None:
        order = length.compare(self.length)
        if order > 0:
            return
        if order < 0:
            self.shortest.clear()
            self.length, self.guess = length, float(length) * (1 + 1e-12)
        self.found = True
        if not any(_same(item, known) for known in self.shortest):
            self.shortest.append(item)

    def link(self, source: Node, target: int) -> Link | None:
        return Link(source, target, self.length, tuple(self.shortest)) if self.found else None


def _at_least(length: float) -> float:
    """A lower bound of a length that was computed in floats, by some roundings of numbers of its size."""
    return max(length - margin(1e-13 * length), 0.0)


def _corners(boxes: Floats) -> Floats:
    """The corners of boxes."""
    return boxes[:, [[0, 1], [2, 1], [2, 3], [0, 3]]].reshape(-1, 2)


def _flipped(item: Shortest) -> Shortest:
    return item.reversed() if isinstance(item, Chord) else NearestFamily(item.kind, item.second, item.first)


def _same(a: Shortest, b: Shortest) -> bool:
    if isinstance(a, Chord) and isinstance(b, Chord):
        ends = ((a.start, b.start), (a.end, b.end))
        # Mirrored chords share a coordinate, which is long to prove: the other one tells them apart at once.
        if any(abs((p - q).norm_sq().ball(128)) > 0 for p, q in ends):
            return False
        return a.start == b.start and a.end == b.end
    return a is b


def lexicographic(a: tuple[Point, Point], b: tuple[Point, Point]) -> int:
    """Order of segments by their starts, then their ends."""
    return a[0].compare(b[0]) or a[1].compare(b[1])


def _extremes(item: Shortest, position: Point | None) -> Iterator[tuple[Point, Point]]:
    """The segments of a shortest item among which the tie rules' choices are.

    Of a continuum: its ends, the one that is westernmost, and the one that leaves from where the robot is.
    """
    if isinstance(item, Chord):
        yield item.start, item.end
        return
    first, second = item.first, item.second
    ends = [
        (first if isinstance(first, Point) else p, second if isinstance(second, Point) else q)
        for p, q in zip(_ends(first), _ends(second), strict=True)
    ]
    yield from ends
    arc = next((side for side in (first, second) if isinstance(side, Arc)), None)
    if arc is not None and arc.contains(_westernmost(arc)):
        # Both ends are westernmost: they lie on one ray from the centre, or one of them is the centre.
        yield _westernmost(first), _westernmost(second)
    if position is not None and not isinstance(first, Point) and first.passes(position):
        yield position, _partner(item, position)


def _westernmost(side: Curve | Point) -> Point:
    """The westernmost point of an arc's circle; a point itself."""
    if isinstance(side, Point):
        return side
    assert isinstance(side, Arc), "segments are nearest along their length to segments alone"
    return Point(side.center.x - side.radius, side.center.y)


def _ends(side: Curve | Point) -> tuple[Point, Point]:
    return (side, side) if isinstance(side, Point) else (side.start, side.end)


def _partner(family: NearestFamily, position: Point) -> Point:
    """The point of the second curve that corresponds to a point of the first."""
    first, second = family.first, family.second
    if isinstance(second, Point):
        return second
    if isinstance(first, Arc) and isinstance(second, Arc):
        return first.center + (position - first.center) * (second.radius / first.radius)
    assert not isinstance(first, Point)
    return position + (second.start - first.start)
