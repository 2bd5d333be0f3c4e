"""All of the boundary that a point sees within a range: closed pieces of edges, and single rays.

A boundary point is seen if a free segment reaches it, and a free segment may touch boundaries. So the
visible set is closed. It contains the front faces that are met first over whole ranges of directions, and
also what only single rays reach: rays that touch corners on both sides, edges seen end on, the edges
through the point itself, and corners touched on the way.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cmp_to_key
from math import inf
from typing import Any, TypeAlias

from exactacq.cached import cached_property
from exactacq.geometry.constructions import put_around
from exactacq.geometry.coordinates import Vector, at_distance, dot, minus, raw, sign
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point
from exactacq.kernel.radial_sweep import Part
from exactacq.kernel.view_parts import ViewParts
from exactacq.scene.edge_table import CONCAVE, EdgeTable
from exactacq.visibility.features import enters
from exactacq.visibility.place_facts import NOTHING_KNOWN, Hold, PlaceFacts
from exactacq.visibility.radial_sweep import BLOCKED, NOTHING, RadialSweep
from exactacq.visibility.range_clip import Disc, Span, of_circle, within
from exactacq.visibility.sensor_range import Range
from exactacq.visibility.view_ends import AT_RANGE, ViewEnds

LAST = 1 << 60
"""The position on a face of what comes after all else there."""
Placed: TypeAlias = "tuple[int, int, Part]"
"""A part with its face and the position on it."""


@dataclass(frozen=True, slots=True)
class SingleRay:
    """What is seen exactly along one direction, where neighbouring rays may not go.

    ``events`` lie on the way, ``along`` are straight edges seen along their length. The last event may end
    the free run (``blocker``), or a ``face`` within range; else the range ends it.
    """

    rank: int
    events: tuple[int, ...]
    along: tuple[int, ...]
    blocker: int | None
    face: int | None


class BoundaryView:
    """The sweep of a point, cut off at a rational radius."""

    def __init__(
        self,
        table: EdgeTable,
        point: Point,
        range_: Range,
        own: tuple[int, ...] | None = None,
        facts: PlaceFacts = NOTHING_KNOWN,
    ) -> None:
        self.table, self.point, self.range = table, point, range_
        self.sweep = RadialSweep(table, point, range_, own, facts)
        self.own = self.sweep.faces.own
        self.origin = self.sweep.faces.origin
        self._at_range: dict[int, Point] = {}
        self._facts = facts

    @cached_property
    def disc(self) -> Disc:
        """What is within range."""
        curves = self.table.curves
        return Disc(self.point, self.range.square, [(curves[e], point) for e, point in self._facts.rim])

    @property
    def parts(self) -> ViewParts:
        """What the range leaves of every sight."""
        return self.ends.parts

    @cached_property
    def ends(self) -> ViewEnds:
        """The points where parts end."""
        sweep = self.sweep
        parts = sweep.parts()
        ends = ViewEnds(sweep, parts, self.disc)
        for n in parts.doubts:
            sight = parts.sights[n]
            e, start, end = sweep.edge(sight.face), sight.start, sight.end
            whole = ends.point(start), ends.point(end)
            at = zip(whole, (start, end), strict=True)
            for point, k in at:
                if self._is_at_rim(e, ends.rank(k)):
                    self.disc.on_rim.append(point)
                    put_around(point, self.point, self.range.square)
            found: list[Part] = []
            last: Point | None = None
            for span in self._clipped(e, whole):
                first, stop = self._known(e, span, whole, (start, end), ends)
                # Both halves of a circle that is seen from a point of it have one point in common.
                found.append((found[-1][1] if span[0] is last else first, stop))
                last = span[1]
            sight.parts = found
        return ends

    def _known(self, e: int, span: Span, whole: Span, numbers: Part, ends: ViewEnds) -> Part:
        """The ends of a clipped span by their numbers, the first and the last one by those of the whole."""
        found = []
        for point in span:
            if point is whole[0] or point is whole[1]:
                found.append(numbers[0 if point is whole[0] else 1])
            else:
                found.append(ends.number(e, point, at_range=whole[0] is not whole[1]))
        return found[0], found[0] if span[0] is span[1] else found[1]

    def seen(self) -> dict[int, list[Span]]:
        """All boundary points seen within the range: by edge, closed pieces in its direction.

        The pieces of an edge are disjoint and in order; a single point is a piece with equal ends. A vertex
        is reported as the end of a piece of either edge, or alone with the edge that starts there. Two
        exceptions on full circles: a piece may run over the circle's start, and a circle that is seen whole
        comes as its two halves.
        """
        span = self.ends.span
        return {e: [span(part) for part in parts] for e, parts in self.seen_parts.items()}

    def bracket(self, e: int, part: Part) -> tuple[float, float]:
        """Bounds of the parameters of a part of an edge, no full circle; infinite at the edge's ends."""
        start, end = part
        return self._bounds(e, start)[0], self._bounds(e, end)[1]

    def surely(self, e: int, part: Part) -> tuple[float, float]:
        """What surely lies in a part of an edge, likewise; an empty interval where nothing does."""
        start, end = part
        return self._bounds(e, start)[1], self._bounds(e, end)[0]

    def _bounds(self, e: int, end: int) -> tuple[float, float]:
        if end == e:
            return -inf, -inf
        return (inf, inf) if end == self.table.following[e] else self.parts.bracket(end)

    @cached_property
    def seen_parts(self) -> dict[int, list[Part]]:
        """What is seen, by the numbers of its ends (see `ViewEnds`)."""
        found: dict[int, list[Placed]] = {}
        for e, face, order, part in self.parts.rows():
            found.setdefault(e, []).append((face, order, part))
        first = self.sweep.sights[0]
        if first.face >= 0 and first.low == first.high:
            e = self.sweep.edge(first.face)
            found[e] = [(first.face, 0, self._numbered(e, span)) for span in self.all_around(first.face)]
        for ray in self.rays:
            self._add_ray(ray, found)
        self._add_own(found)
        pieces = {
            e: [placed[0][2]] if len(placed) == 1 else _joined([one[2] for one in sorted(placed, key=_key)])
            for e, placed in found.items()
        }
        return self._tidied(pieces)

    def _numbered(self, e: int, span: Span, at_range: bool = False) -> Part:
        start, end = span
        first = self.ends.number(e, start, at_range)
        return first, first if end is start else self.ends.number(e, end, at_range)

    def _tidied(self, pieces: dict[int, list[Part]]) -> dict[int, list[Part]]:
        """Vertices that the range leaves alone on an edge moved to the edge that starts there, or dropped
        where a piece has them."""
        following = self.table.following
        for e in [e for e, parts in pieces.items() if parts and parts[-1][0] == parts[-1][1]]:
            vertex = pieces[e][-1][0]
            if vertex != following[e] or vertex == e:
                continue
            onward = pieces.setdefault(vertex, [])
            if not onward or onward[0][0] != vertex:
                onward.insert(0, pieces[e][-1])
            pieces[e].pop()
        for e in [e for e, parts in pieces.items() if parts and parts[0][0] == parts[0][1]]:
            vertex, before = pieces[e][0][0], self.table.preceding[e]
            if vertex == e and before != e:
                ends = pieces.get(before, ())
                if ends and ends[-1][1] == vertex:
                    pieces[e].pop(0)
        return {e: parts for e, parts in pieces.items() if parts}

    def all_around(self, face: int) -> list[Span]:
        """The parts within range of a face that is seen all around."""
        curve = self.table.curves[self.sweep.edge(face)]
        # All around is seen only a full circle: from inside a circle a ray meets it once, so that a part
        # of it covers less; from outside, and so of straight edges, a face covers less than half a turn.
        assert isinstance(curve, Arc)
        some = of_circle(curve, self.disc)
        if some is None:
            opposite = curve.center + (curve.center - curve.start)
            return [(curve.start, opposite), (opposite, curve.start)]
        return some

    def is_at_range(self, e: int, end: int) -> bool:
        """Whether an end of what is seen of an edge, by its number, is known to be at the range."""
        rank = self.ends.rank(end)
        return rank == AT_RANGE or self._is_at_rim(e, rank)

    def holds(self, e: int, end: int) -> list[Hold]:
        """What holds an end of what is seen that is no vertex and ends a sight, by what the ray touches."""
        rank = self.ends.rank(end)
        return [] if rank is None or rank == AT_RANGE else self._holds(e, rank)

    def _holds(self, e: int, rank: int) -> list[Hold]:
        return [(e, *self.sweep.faces.touched(event)) for event in self.sweep.events(rank)]

    def _is_at_rim(self, e: int, rank: int | None) -> bool:
        """Whether the end of a sight, made on the ray of a rank, is known to be as far away as the range."""
        holds = self._facts.holds
        return rank is not None and bool(holds) and any(hold in holds for hold in self._holds(e, rank))

    def _clipped(self, e: int, ends: Span) -> list[Span]:
        """The parts within range of what a sight sees; ends within range stay the same objects."""
        curve, (start, end) = self.table.curves[e], ends
        touch = self._facts.tangent.get(self.table.line_numbers.circles[e])
        if start is end:
            # All of a full circle that passes through the point itself: the ends of other faces are distinct.
            assert isinstance(curve, Arc)
            opposite = curve.center + (curve.center - start)
            return within(curve, start, opposite, self.disc) + within(curve, opposite, end, self.disc)
        return within(curve, start, end, self.disc, touch)

    # -- single rays -------------------------------------------------------------------------------

    @cached_property
    def rays(self) -> list[SingleRay]:
        """The directions in which several events lie, an edge is seen edge-on, or an own edge leaves."""
        return [ray for rank in self.sweep.special if (ray := self._ray(rank)) is not None]

    def lone_ends(self) -> list[Point]:
        """The ends of the free runs of rays that see more than their neighbours, or along an edge."""
        return [self._end(ray) for ray in self.rays if ray.along or self._is_beyond(ray)]

    def _end(self, ray: SingleRay) -> Point:
        """Where the free run or the range ends."""
        if ray.blocker is not None:
            return self.sweep.faces.place(ray.blocker)
        if ray.face is not None:
            return self.sweep.hit(ray.face, ray.rank)
        return self.at_range(ray.rank)

    def _is_beyond(self, ray: SingleRay) -> bool:
        """Whether no neighbouring ray is free as far."""
        sweep, rank = self.sweep, ray.rank
        for face, high in ((sweep.first[rank - 1], True), (sweep.first[rank], False)):
            if face == NOTHING:
                return False
            if face == BLOCKED:
                continue
            if ray.blocker is not None:
                ends_here = (sweep.high if high else sweep.low)(face) == rank
                reached = ends_here and sweep.faces.ends(face)[high] == ray.blocker
            elif ray.face is not None:
                reached = face == ray.face
            else:
                reached = self.disc.excess(sweep.at(face, rank, not high)) >= 0
            if reached:
                return False
        return True

    def _ray(self, rank: int) -> SingleRay | None:
        sweep = self.sweep
        before, after = sweep.first[rank - 1], sweep.first[rank]
        if before == after >= 0 and sweep.low(before) != rank:
            return None
        if self._is_buried(rank):
            return None
        known = sweep.met(rank)
        struck, events, inside = self._met(rank) if known is None else known
        met: list[int] = []
        blocker = None
        for event in events:
            met.append(event)
            if sweep.blocks(event, rank, self.own):
                blocker = event
                break
        face = None
        if blocker is None and struck != NOTHING:
            place = None if inside else sweep.hit(struck, rank)
            is_told = inside > 0 or self._is_at_rim(sweep.edge(struck), rank)
            if is_told or (place is not None and self.disc.excess(place) <= 0):
                face = struck
        edges = *self._edge_on.get(rank, ()), *self.own
        along = tuple(e for e in edges if self._runs_along(e, rank, met, blocker))
        return SingleRay(rank, tuple(met), along, blocker, face)

    def _met(self, rank: int) -> tuple[int, list[int], int]:
        """The first face that a ray does not pass at an end, and the events before that and within range,
        nearest first; exact, and whether the face is within range is left open (0)."""
        sweep = self.sweep
        direction = sweep.direction(rank)
        struck, limit = sweep.nearest(direction, sweep.covering(rank)), None
        if struck != NOTHING:
            limit = sweep.parameter(Point(*direction), struck) * dot(direction, direction)
        events = []
        for way, event in self._on_ray(rank, direction):
            if limit is not None and sign(limit - way) < 0:
                break
            if self.disc.excess(sweep.faces.place(event)) > 0:
                break
            events.append(event)
        return struck, events, 0

    def _is_buried(self, rank: int) -> bool:
        """Whether a ray leads from the point straight into its own obstacle."""
        if not self.own:
            return False
        cone, ranks = self.sweep.faces.cone, self.sweep.rank
        if cone is None:
            return self.buries(self.sweep.direction(rank))
        if ranks[cone.low] == rank or ranks[cone.high] == rank:
            # Along a single edge, or along straight ones.
            if len(self.own) == 1 or not any(self.table.kinds[e] for e in self.own):
                return bool(self.table.kinds[self.own[0]] == CONCAVE)
            return self.buries(self.sweep.direction(rank))
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
        ends = e, self.table.following[e]
        if e in self.own:
            return any(self.sweep.rank.get(end) == rank and self.runs_out(e, end) for end in ends)
        nearer = [event for event in met if event in ends][:1]
        return bool(nearer) and nearer[0] != blocker

    @cached_property
    def _edge_on(self) -> dict[int, list[int]]:
        """The straight edges that are seen edge-on, by direction."""
        found: dict[int, list[int]] = {}
        for e in self.sweep.faces.on_ray:
            found.setdefault(self.sweep.rank[e], []).append(e)
        return found

    def runs_out(self, e: int, vertex: int) -> bool:
        """Whether an edge through the point is straight and leads from there to a vertex, an end of it."""
        if not isinstance(self.table.curves[e], Segment):
            return False
        return len(self.own) == 1 or vertex == (e if e == self.own[0] else self.table.following[e])

    def at_range(self, rank: int) -> Point:
        """The point of the range circle in the direction of a rank, always the same object."""
        point = self._at_range.get(rank)
        if point is None:
            point = self._at_range[rank] = at_distance(
                self.origin, self.sweep.direction(rank), self.range.radius
            )
        return point

    # -- points beside the sights ------------------------------------------------------------------

    def _add_ray(self, ray: SingleRay, found: dict[int, list[Placed]]) -> None:
        sweep, table = self.sweep, self.table
        covered = {e for edge in ray.along for e in (edge, table.following[edge])}
        for face, high in ((sweep.first[ray.rank - 1], True), (sweep.first[ray.rank], False)):
            if face >= 0 and (sweep.high if high else sweep.low)(face) == ray.rank:
                covered.add(sweep.faces.ends(face)[high])
        for e in ray.along:
            if e not in self.own:
                curve = table.curves[e]
                for span in within(curve, curve.start, curve.end, self.disc):
                    found.setdefault(e, []).append((-1, 0, self._numbered(e, span, at_range=True)))
        for event in ray.events:
            if event in covered:
                continue
            if event < len(table.vertices):
                found.setdefault(event, []).append((-2, 0, (event, event)))
                continue
            for face in range(len(sweep.faces)):
                ends = sweep.faces.ends(face)
                if event in ends:
                    order = LAST if ends[0] == event else -1
                    found.setdefault(sweep.edge(face), []).append((face, order, (event, event)))
        struck = ray.face
        if struck is not None and struck not in (sweep.first[ray.rank - 1], sweep.first[ray.rank]):
            # Only this ray reaches it.
            order = (sweep.high(struck) - ray.rank) % max(sweep.count, 1)
            end = self.ends.number(sweep.edge(struck), self._end(ray), rank=ray.rank)
            found.setdefault(sweep.edge(struck), []).append((struck, order, (end, end)))

    def _add_own(self, found: dict[int, list[Placed]]) -> None:
        """The straight edges through the point, or the point alone."""
        alone = True
        for e in self.own:
            curve = self.table.curves[e]
            if isinstance(curve, Segment):
                alone = False
                spans = within(curve, curve.start, curve.end, self.disc)
                found[e] = [(0, 0, self._numbered(e, span, at_range=True)) for span in spans]
            elif not curve.ccw:
                alone &= e not in found
        if alone and self.own:
            end = self.ends.number(self.own[-1], self.point)
            found.setdefault(self.own[-1], []).insert(0, (-1, 0, (end, end)))


def _by_way(a: tuple[Any, int], b: tuple[Any, int]) -> int:
    return sign(a[0] - b[0])


def _key(placed: Placed) -> tuple[int, int]:
    return placed[:2]


def _joined(parts: list[Part]) -> list[Part]:
    """Pieces that share an end joined."""
    if len(parts) < 2:
        return parts
    joined = parts[:1]
    for start, end in parts[1:]:
        if start == joined[-1][1] and end != joined[-1][0]:
            joined[-1] = joined[-1][0], end
        else:
            joined.append((start, end))
    return joined
