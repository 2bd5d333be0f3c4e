"""All of the boundary that a point sees within a range: closed pieces of edges, and single rays.

A boundary point is seen if a free segment reaches it, and a free segment may touch boundaries. So the
visible set is closed. It contains the front faces that are met first over whole ranges of directions, and
also what only single rays reach: rays that touch corners on both sides, edges seen end on, the edges
through the point itself, and corners touched on the way.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from functools import cached_property, cmp_to_key
from typing import Any, TypeAlias

from exactacq.errors import Undecided
from exactacq.geometry.coordinates import Vector, advance, dot, minus, raw, sign, square_root
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import enters
from exactacq.visibility.radial_sweep import BLOCKED, NOTHING, FirstFace, RadialSweep
from exactacq.visibility.range_clip import Disc, Span, of_circle, within
from exactacq.visibility.sensor_range import Range

LAST = 1 << 60
AT_RANGE = -1
"""In place of the rank of a point's direction."""
Hold: TypeAlias = "tuple[int, Hashable, int]"
"""An edge, the name of what the line to its point touches (see `line_names`) or of the range, and a side."""


def seen_from(
    table: EdgeTable, point: Point, range_: Range, own: tuple[int, ...] | None = None
) -> dict[int, list[Span]]:
    """All boundary points that a free point sees within a radius: by edge, closed pieces in its direction.

    The pieces of an edge are disjoint and in order; a single point is a piece with equal ends. A vertex is
    reported as the end of a piece of either edge, or alone with the edge that starts there. Two
    exceptions on full circles: a piece may run over the circle's start, and a circle that is seen whole comes
    as its two halves. *own* are the edges through the point, at a vertex the incoming one first (found if not
    given). The point may be algebraic.
    """
    return BoundaryView(table, point, range_, own).seen()


@dataclass(frozen=True, slots=True)
class SingleRay:
    """What is seen exactly along one direction, where neighbouring rays may not go.

    ``end`` is where the free run or the range ends, ``events`` lie on the way, ``along`` are straight edges
    seen along their length, ``beyond`` tells that no neighbouring ray is free as far, ``struck`` is the face
    that only this ray reaches, if any.
    """

    rank: int
    end: Point
    events: tuple[int, ...]
    along: tuple[int, ...]
    beyond: bool
    struck: int | None


class BoundaryView:
    """The sweep of a point, cut off at a rational radius."""

    def __init__(
        self, table: EdgeTable, point: Point, range_: Range, own: tuple[int, ...] | None = None
    ) -> None:
        self.table, self.point, self.range = table, point, range_
        self.own = table.edges_at(point) if own is None else own
        self.sweep = RadialSweep(table, point, range_, self.own)
        self.origin = self.sweep.faces.origin
        self.disc = Disc(point, range_.square)
        self._at_range: dict[int, Point] = {}
        self.tight: set[Hold] = set()
        """What holds the ends of sights that are known, by who asks, to be as far away as the range."""
        self._held: dict[int, tuple[Point, int]] = {}

    @property
    def near(self) -> list[bool]:
        """For each face whether floats prove that all of it is within range."""
        return self.sweep.faces.floats.within

    def seen(self) -> dict[int, list[Span]]:
        """See `seen_from`."""
        found: dict[int, list[tuple[tuple[int, int], Span]]] = {}
        sweep, near = self.sweep, self.near
        edges, top, cells = sweep.edges, sweep.high, max(sweep.count, 1)
        for sight in sweep.sights:
            face, low, high = sight
            if face < 0:
                continue
            if low == high:
                spans = self.spans(sight)
            else:
                ends = self.ends(sight)
                spans = [ends] if near[face] and ends[0] is not ends[1] else self.clipped(sight, ends)
            # The position on the face, in the boundary's direction.
            key = face, (top[face] - high) % cells
            for span in spans:
                found.setdefault(edges[face], []).append((key, span))
        for ray in self.rays:
            self._add_ray(ray, found)
        self._add_own(found)
        pieces = {
            e: [spans[0][1]] if len(spans) == 1 else _joined([span for _, span in sorted(spans, key=_key)])
            for e, spans in found.items()
        }
        return self._tidied(pieces)

    def _tidied(self, pieces: dict[int, list[Span]]) -> dict[int, list[Span]]:
        """Vertices that the range leaves alone on an edge moved to the edge that starts there, or dropped
        where a piece has them."""
        for e in [e for e, spans in pieces.items() if spans and spans[-1][0] is spans[-1][1]]:
            (vertex, _), following = pieces[e][-1], int(self.table.next[e])
            if vertex is not self.table.curves[e].end or following == e:
                continue
            onward = pieces.setdefault(following, [])
            if not onward or onward[0][0] is not vertex:
                onward.insert(0, pieces[e][-1])
            pieces[e].pop()
        for e in [e for e, spans in pieces.items() if spans and spans[0][0] is spans[0][1]]:
            vertex, before = pieces[e][0][0], int(self.table.previous[e])
            if vertex is self.table.curves[e].start and before != e:
                ends = pieces.get(before, ())
                if ends and ends[-1][1] is vertex:
                    pieces[e].pop(0)
        return {e: spans for e, spans in pieces.items() if spans}

    def spans(self, sight: FirstFace) -> list[Span]:
        """The parts within range of what is seen of a face, in the boundary's direction."""
        face = sight.face
        if sight.low == sight.high:
            curve = self.table.curves[self.sweep.edges[face]]
            # All around is seen only a full circle: from inside a circle a ray meets it once, so that a part
            # of it covers less; from outside, and so of straight edges, a face covers less than half a turn.
            assert isinstance(curve, Arc)
            some = of_circle(curve, self.disc)
            if some is None:
                opposite = curve.center + (curve.center - curve.start)
                return [(curve.start, opposite), (opposite, curve.start)]
            return some
        return self.clipped(sight, self.ends(sight))

    def ends(self, sight: FirstFace) -> Span:
        """What a sight sees of a face, in the boundary's direction and whatever the range."""
        face, low, high = sight
        sweep, curves = self.sweep, self.table.curves
        event = sweep.ends_high[face] if high == sweep.high[face] else LAST
        start = curves[event].start if event < len(curves) else self._end(face, event, high)
        event = sweep.ends_low[face] if low == sweep.low[face] else LAST
        end = curves[event].start if event < len(curves) else self._end(face, event, low)
        return start, end

    def _end(self, face: int, event: int, rank: int) -> Point:
        """An end of what is seen of a face that is no vertex."""
        sweep = self.sweep
        point = sweep.late_hit(face, rank) if event == LAST else sweep.faces.place(event)
        self._held[id(point)] = point, rank
        return point

    def is_at_range(self, point: Point) -> bool:
        """Whether an end of what is seen was made as a point as far away as the range."""
        return self._held.get(id(point), (point, LAST))[1] == AT_RANGE

    def holds(self, e: int, point: Point) -> list[Hold]:
        """What holds an end of what is seen that is no vertex and ends a sight, by what the ray touches."""
        rank = self._held.get(id(point), (point, LAST))[1]
        return [] if rank in (AT_RANGE, LAST) else self._holds(e, rank)

    def _holds(self, e: int, rank: int) -> list[Hold]:
        return [
            (e, ("circle", self.table.circles[number]) if side else ("corner", number), side)
            for number, side in self._touched(rank)
        ]

    def _touched(self, rank: int) -> list[tuple[int, int]]:
        """What a ray touches: vertices with 0, arcs with 1 if the circle is to its left, else -1."""
        count, marks = len(self.table.vertices), self.sweep.faces.marks
        return [
            (event, 0) if event < count else (marks[event - count].edge, marks[event - count].side)
            for event in self.sweep.events(rank)
        ]

    def clipped(self, sight: FirstFace, ends: Span) -> list[Span]:
        """The parts within range of what a sight sees; ends within range stay the same objects."""
        face, (start, end) = sight.face, ends
        if self.near[face] and start is not end:
            return [ends]
        curve = self.table.curves[self.sweep.edges[face]]
        if start is not end:
            try:
                spans = within(curve, start, end, self.disc)
            except Undecided:
                e = self.sweep.edges[face]
                ranks = zip(ends, (sight.high, sight.low), strict=True)
                known = [id(p) for p, rank in ranks if not self.tight.isdisjoint(self._holds(e, rank))]
                spans = within(curve, start, end, self.disc, known)
            for point in (p for span in spans for p in span if p is not start and p is not end):
                self._held[id(point)] = point, AT_RANGE
            return spans
        # All of a full circle that passes through the point itself: the ends of other faces are distinct.
        assert isinstance(curve, Arc)
        opposite = curve.center + (curve.center - start)
        first = within(curve, start, opposite, self.disc)
        return first + within(curve, opposite, end, self.disc)

    def _order(self, face: int, rank: int) -> int:
        """Position of a rank on a face, in the boundary's direction."""
        sweep = self.sweep
        return (sweep.high[face] - rank) % max(sweep.count, 1)

    def _in_range(self, point: Point) -> bool:
        return self.disc.excess(point) <= 0

    # -- single rays -------------------------------------------------------------------------------

    @cached_property
    def rays(self) -> list[SingleRay]:
        """The directions in which several events lie, an edge is seen edge-on, or an own edge leaves."""
        return [ray for rank in self.sweep.special if (ray := self._ray(rank)) is not None]

    def _ray(self, rank: int) -> SingleRay | None:
        sweep = self.sweep
        faces = sweep.faces
        before, after = sweep.first[rank - 1], sweep.first[rank]
        if before == after >= 0 and sweep.low[before] != rank:
            return None
        direction = sweep.direction(rank)
        if self._is_buried(direction, rank):
            return None
        square = dot(direction, direction)
        struck = sweep.nearest(direction, covering) if (covering := sweep.covering(rank)) else None
        limit = None if struck is None else sweep.parameter(Point(*direction), struck) * square
        met: list[int] = []
        blocker = None
        for way, event in self._on_ray(rank, direction):
            place = faces.place(event)
            if (limit is not None and sign(limit - way) < 0) or not self._in_range(place):
                break
            met.append(event)
            if sweep.blocks(event, direction):
                blocker = event
                break
        end = None
        if blocker is not None:
            end = faces.place(blocker)
        elif struck is not None:
            place = sweep.hit(struck, direction)
            end = place if self._in_range(place) else None
        limited = end is not None
        if end is None:
            end = self.at_range(rank)
        along = tuple(e for e in (*faces.on_ray, *self.own) if self._runs_along(e, rank, met, blocker))
        reached = False
        for face, high in ((before, True), (after, False)):
            if face == NOTHING:
                reached = True
            elif face != BLOCKED and limited:
                ends_here = (sweep.high if high else sweep.low)[face] == rank
                event = (sweep.ends_high if high else sweep.ends_low)[face]
                reached |= (ends_here and event == blocker) or (face == struck and blocker is None)
            elif face != BLOCKED:
                place = sweep.at(face, rank, not high)
                reached |= self.disc.excess(place) >= 0
        alone = struck if limited and blocker is None and struck not in (before, after) else None
        return SingleRay(rank, end, tuple(met), along, not reached, alone)

    def _is_buried(self, direction: Vector, rank: int) -> bool:
        """Whether a ray leads from the point straight into its own obstacle."""
        if not self.own:
            return False
        cone = self.sweep.faces.cone
        if cone is None or self.sweep.rank[cone.low] == rank or self.sweep.rank[cone.high] == rank:
            return self.buries(direction)
        return self.sweep.first[rank - 1] == self.sweep.first[rank] == BLOCKED

    def buries(self, direction: Vector) -> bool:
        """Whether a direction leads from the point, on a boundary, straight into its obstacle."""
        if not self.own:
            return False
        incoming, outgoing = curves = [self.table.curves[e] for e in (self.own[0], self.own[-1])]
        before, after = (raw(c.tangent(self.point) if isinstance(c, Arc) else c.direction) for c in curves)
        return enters(incoming, outgoing, before, after, direction)

    def _on_ray(self, rank: int, direction: Vector) -> list[tuple[Any, int]]:
        """The events on a ray with their products with its vector, nearest first; not the point itself."""
        sweep = self.sweep
        found: list[tuple[Any, int]] = []
        for event in sweep.events(rank):
            place = sweep.faces.place(event)
            if place is not self.point:
                found.append((dot(minus(raw(place), self.origin), direction), event))
        return sorted(found, key=cmp_to_key(_by_way))

    def _runs_along(self, e: int, rank: int, met: list[int], blocker: int | None) -> bool:
        """Whether a straight edge on the ray is seen along its length."""
        ranks = self.sweep.rank
        ends = e, int(self.table.next[e])
        if e in self.own:
            return any(ranks.get(end) == rank and self.runs_out(e, end) for end in ends)
        nearer = [event for event in met if event in ends][:1]
        return ranks[e] == rank and bool(nearer) and nearer[0] != blocker

    def runs_out(self, e: int, vertex: int) -> bool:
        """Whether an edge through the point is straight and leads from there to a vertex, an end of it."""
        if not isinstance(self.table.curves[e], Segment):
            return False
        return len(self.own) == 1 or vertex == (e if e == self.own[0] else int(self.table.next[e]))

    def at_range(self, rank: int) -> Point:
        """The point of the range circle in the direction of a rank, always the same object."""
        point = self._at_range.get(rank)
        if point is None:
            direction = self.sweep.direction(rank)
            share = square_root(self.range.square / dot(direction, direction))
            point = self._at_range[rank] = advance(self.origin, direction, share)
        return point

    # -- points beside the sights ------------------------------------------------------------------

    def _add_ray(self, ray: SingleRay, found: dict[int, list[tuple[tuple[int, int], Span]]]) -> None:
        sweep, table = self.sweep, self.table
        faces = sweep.faces
        covered = {e for edge in ray.along for e in (edge, int(table.next[edge]))}
        for face, high in ((sweep.first[ray.rank - 1], True), (sweep.first[ray.rank], False)):
            if face >= 0 and (sweep.high if high else sweep.low)[face] == ray.rank:
                covered.add((sweep.ends_high if high else sweep.ends_low)[face])
        for e in ray.along:
            if e not in self.own:
                curve = table.curves[e]
                for span in within(curve, curve.start, curve.end, self.disc):
                    found.setdefault(e, []).append(((-1, 0), span))
        for event in ray.events:
            if event in covered:
                continue
            place = faces.place(event)
            self._held[id(place)] = place, ray.rank
            if event < len(table.vertices):
                found.setdefault(event, []).append(((-2, 0), (place, place)))
                continue
            for face, ends in enumerate(zip(sweep.ends_low, sweep.ends_high, strict=True)):
                if event not in ends:
                    continue
                order = LAST if sweep.ends_low[face] == event else -1
                found.setdefault(sweep.edges[face], []).append(((face, order), (place, place)))
        if ray.struck is not None:
            key = ray.struck, self._order(ray.struck, ray.rank)
            found.setdefault(sweep.edges[ray.struck], []).append((key, (ray.end, ray.end)))

    def _add_own(self, found: dict[int, list[tuple[tuple[int, int], Span]]]) -> None:
        """The straight edges through the point, or the point alone."""
        alone = True
        for e in self.own:
            curve = self.table.curves[e]
            if isinstance(curve, Segment):
                alone = False
                spans = within(curve, curve.start, curve.end, self.disc)
                found[e] = [((0, 0), span) for span in spans]
            elif not curve.ccw:
                alone &= e not in found
        if alone and self.own:
            found.setdefault(self.own[-1], []).insert(0, ((-1, 0), (self.point, self.point)))


def _by_way(a: tuple[Any, int], b: tuple[Any, int]) -> int:
    return sign(a[0] - b[0])


def _key(item: tuple[tuple[int, int], Span]) -> tuple[int, int]:
    return item[0]


def _joined(spans: list[Span]) -> list[Span]:
    """Pieces that share an end joined."""
    if len(spans) < 2:
        return spans
    joined = spans[:1]
    for start, end in spans[1:]:
        if start is joined[-1][1] and end is not joined[-1][0]:
            joined[-1] = joined[-1][0], end
        else:
            joined.append((start, end))
    return joined
