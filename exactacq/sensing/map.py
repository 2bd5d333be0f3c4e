"""The map: for every boundary edge the union of the closed intervals that the robot has seen.

Intervals are ordered by exact parameters along the edge (`exactacq.geometry.curve_parameter`) and merged
where they meet; both are decided exactly.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

from exactacq.cached import cached_property
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.geo import Geo, collection, feature
from exactacq.geometry.interval_union import EMPTY, Cover, Interval
from exactacq.geometry.points import Point
from exactacq.numbers.between import short_between
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.sensing.targets import Target, Targets

Spots: TypeAlias = "tuple[tuple[int, Real], ...]"
"""The places of a point on a boundary: numbers of edges in the scene, and parameters there."""

CLOSE = 64
"""This share of a known part is what lies beside its end."""


@dataclass(frozen=True)
class Known:
    """A known part of a boundary: on edge number ``edge`` of its obstacle, from start to end along the edge.

    Equal ends are a single known point, with ``curve`` None, or, if ``whole``, a full circle.
    """

    edge: int
    start: Point
    end: Point
    curve: Curve | None
    whole: bool = False

    @property
    def length(self) -> Length:
        """Exact length, 0 for a single point."""
        return Length(0) if self.curve is None else self.curve.length


class Body(Protocol):
    """What maps are of: an obstacle, or a component of one (see `exactacq.scene.terrain_components`)."""

    @property
    def edges(self) -> Sequence[Curve]: ...
    def edges_at(self, point: Point) -> tuple[int, ...]: ...
    @property
    def perimeter(self) -> Length: ...
    @property
    def label(self) -> str: ...
    @property
    def closed(self) -> bool: ...


class Map:
    """What a robot knows at one moment: which parts of which boundaries it has seen. Exact, and immutable.

    A boundary point is *known* if it was visible from some point of the path so far. An obstacle is *seen* if
    a point of its boundary is known, *acquired* if all of it is, *incomplete* if some but not all of it is.
    Obstacles are given by their numbers in the run, from 0 (``Run.obstacles``); ValueError for any other
    number. Linear in the number of known parts; `knows` may raise `Undecided`.

    >>> import exactacq as xa
    >>> run = xa.sightseer(xa.load("circles"))
    >>> known = run.map_at(2)
    >>> known.seen, known.acquired, known.incomplete
    ((0,), (), (0,))
    >>> print(*(point for _, point in known.frontier))
    (21/5, 2*sqrt(21)/5) (21/5, -2*sqrt(21)/5)
    """

    def __init__(
        self, obstacles: Sequence[Body], targets: Targets, rails: Sequence[Rail], covers: Mapping[int, Cover]
    ) -> None:
        self.obstacles = obstacles
        self._targets, self._rails, self._covers = targets, rails, covers
        self._known: dict[int, tuple[Known, ...]] = {}

    def __repr__(self) -> str:
        return f"<Map: {len(self.seen)} of {len(self.obstacles)} obstacles seen>"

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON FeatureCollection: a feature for each of the `known` parts, obstacle by obstacle.

        A part is a LineString along the boundary, arcs as chords (`geometry.geo.FLATNESS`), a single known
        point a Point. Properties: ``obstacle``, ``name`` (the label), ``edge``, and whether the obstacle
        is ``acquired``.
        """
        acquired = set(self.acquired)
        return collection(
            feature(
                part.start.__geo_interface__ if part.curve is None else part.curve.__geo_interface__,
                obstacle=i,
                name=self.obstacles[i].label,
                edge=part.edge,
                acquired=i in acquired,
            )
            for i in self.seen
            for part in self.known(i)
        )

    def known(self, i: int) -> tuple[Known, ...]:
        """The known parts of obstacle i, edge by edge, in order along each; parts of an edge are disjoint.

        >>> import exactacq as xa
        >>> run = xa.sightseer(xa.load("circles"))
        >>> [(part.edge, str(part.length)) for part in run.map_at(2).known(0)]
        [(0, '2*acos(-17/25)')]
        """
        if i not in self._known:
            edges = range(len(self._body(i).edges))
            self._known[i] = tuple(part for k in edges for part in self._on_edge(i, k))
        return self._known[i]

    def knows(self, i: int, point: Point | Sequence[object]) -> bool:
        """Whether a point of the boundary of obstacle i is known; ValueError if it is not on the boundary.

        The point may be given as two numbers.

        >>> import exactacq as xa
        >>> xa.sightseer(xa.load("circles")).map_at(2).knows(0, xa.Point(7, 0))
        False
        """
        point = Point.of(point)
        spots = self.spots(i, point)
        if not spots:
            raise ValueError(f"{point} is not on the boundary of obstacle {i}")
        return self.knows_some(spots)

    def spots(self, i: int, point: Point) -> Spots:
        """Where on the boundary of obstacle i a point lies; the same for all maps of a run.

        >>> import exactacq as xa
        >>> xa.sightseer(xa.load("squares")).map.spots(0, xa.Point(-9, -9))
        ()
        """
        return self.spots_on(i, point, self._body(i).edges_at(point))

    def spots_on(self, i: int, point: Point, edges: Iterable[int]) -> Spots:
        """Where a point lies that is known to be on some edges of obstacle i, as `spots` tells it.

        >>> import exactacq as xa
        >>> run = xa.sightseer(xa.load("circles"))
        >>> run.map.spots_on(0, xa.Point(7, 0), (0,)) == run.map.spots(0, xa.Point(7, 0))
        True
        """
        targets = (self._targets.of[self._checked(i)][k] for k in edges)
        return tuple((target.edge, u) for target in targets for u in self._parameters(target, point))

    def _parameters(self, target: Target, point: Point) -> list[Real]:
        span = target.span
        ends = [u for u, end in ((span.low, span.start), (span.high, span.end)) if point == end]
        return ends or [self._rails[target.edge].parameter(point)]

    def knows_some(self, spots: Spots) -> bool:
        """Whether a point is known at some of its places on a boundary (see `spots`).

        >>> import exactacq as xa
        >>> run = xa.sightseer(xa.load("circles"))
        >>> spots = run.map.spots(0, xa.Point(7, 0))
        >>> run.map_at(2).knows_some(spots), run.map.knows_some(spots)
        (False, True)
        """
        return any(self._cover(e).contains(u) for e, u in spots)

    def known_length(self, i: int | None = None) -> Length:
        """Exact length of what is known of obstacle i, or of all obstacles.

        >>> import exactacq as xa
        >>> print(xa.sightseer(xa.load("circles")).map.known_length())
        10*pi
        """
        obstacles = range(len(self.obstacles)) if i is None else (i,)
        return Length.sum(
            self.obstacles[j].perimeter
            if self._is_acquired(j)
            else Length.sum(p.length for p in self.known(j))
            for j in obstacles
        )

    @cached_property
    def seen(self) -> tuple[int, ...]:
        """Obstacles with a known point."""
        return tuple(i for i in range(len(self.obstacles)) if self._is_seen(i))

    @cached_property
    def acquired(self) -> tuple[int, ...]:
        """Obstacles whose whole boundary is known."""
        return tuple(i for i in self.seen if self._is_acquired(i))

    @cached_property
    def incomplete(self) -> tuple[int, ...]:
        """Obstacles of whose boundary some but not all is known."""
        acquired = set(self.acquired)
        return tuple(i for i in self.seen if i not in acquired)

    @cached_property
    def frontier(self) -> tuple[tuple[int, Point], ...]:
        """Where known boundary ends: (obstacle, point), in the order of the boundary, as `ends` tells it."""
        return tuple((i, point) for i in self.incomplete for point in self.ends(i))

    def is_incomplete(self, i: int) -> bool:
        """Whether some but not all of the boundary of obstacle i is known.

        >>> import exactacq as xa
        >>> xa.sightseer(xa.load("circles")).map_at(2).is_incomplete(0)
        True
        """
        return self._is_seen(i) and not self._is_acquired(i)

    def beside(self, i: int, end: Point) -> Point:
        """A known point of obstacle i with short coordinates, beside an end of known boundary.

        It is in the last 64th of the known part, as parameters along the edge go. The end itself if that
        is a vertex or a single known point.

        >>> import exactacq as xa
        >>> known = xa.sightseer(xa.load("circles")).map_at(2)
        >>> for _, end in known.frontier:
        ...     print(end, known.beside(0, end))
        (21/5, 2*sqrt(21)/5) (4570733/1100105, 1994094/1100105)
        (21/5, -2*sqrt(21)/5) (6204175/1485497, -2707456/1485497)
        """
        for target in self._targets.of[self._checked(i)]:
            for part in self._parts(target):
                little = (part.high - part.low) / CLOSE
                if little.sign() == 0:
                    continue
                if part.end is end or part.end == end:
                    low, high, last = part.high - little, part.high, target.span.high
                elif part.start is end or part.start == end:
                    low, high, last = part.low, part.low + little, target.span.low
                else:
                    continue
                is_vertex = last in (low, high)
                return end if is_vertex else self._rails[target.edge].point(short_between(low, high))
        return end

    def ends(self, i: int) -> Iterator[Point]:
        """Where known boundary of obstacle i ends, in its order.

        A vertex between two edges that are both known there is no end, nor is a border point where a boundary
        ends as a whole; a single known point is one end.

        >>> import exactacq as xa
        >>> print(*xa.sightseer(xa.load("circles")).map_at(2).ends(0))
        (21/5, 2*sqrt(21)/5) (21/5, -2*sqrt(21)/5)
        """
        targets = self._targets.of[self._checked(i)]
        for k, target in enumerate(targets):
            before, after = targets[k - 1], targets[(k + 1) % len(targets)]
            for part in self._parts(target):
                at_start = part.low.compare(target.span.low) == 0
                at_end = part.high.compare(target.span.high) == 0
                single = part.low.compare(part.high) == 0
                open_start = not (at_start and self._goes_on(before, target, self._reaches_end(before)))
                open_end = not (at_end and self._goes_on(target, after, self._reaches_start(after)))
                if single:
                    if open_start and open_end and not self._is_told_beside(i, k, part):
                        yield part.start
                    continue
                if open_start:
                    yield part.start
                if open_end:
                    yield part.end

    @staticmethod
    def _goes_on(target: Target, following: Target, known: bool) -> bool:
        """Whether there is no end where two targets meet, or where a boundary ends as a whole."""
        return known or target.span.end != following.span.start

    def _reaches_end(self, target: Target) -> bool:
        top = target.span.high
        return any(p.high.compare(top) == 0 and p.low.compare(top) < 0 for p in self._parts(target))

    def _reaches_start(self, target: Target) -> bool:
        low = target.span.low
        return any(p.low.compare(low) == 0 and p.high.compare(low) > 0 for p in self._parts(target))

    def _parts(self, target: Target) -> list[Interval]:
        """The known intervals of a target; a full circle's start alone is not told beside its end."""
        parts = [part for part in self._cover(target.edge).intervals if target.contains(part)]
        curve = self._rails[target.edge].curve
        if len(parts) > 1 and target.whole and isinstance(curve, Arc) and curve.full:
            first, last = parts[0], parts[-1]
            if first.low.sign() == 0 and last.high.compare(target.span.high) == 0:
                if last.low.compare(last.high) == 0:
                    parts.pop()
                elif first.low.compare(first.high) == 0:
                    parts.pop(0)
        return parts

    def _cover(self, e: int) -> Cover:
        return self._covers.get(e, EMPTY)

    def _checked(self, i: int) -> int:
        """A number that an obstacle has."""
        count = len(self.obstacles)
        if i not in range(count):
            raise ValueError(f"no obstacle {i!r}: this map has {count}, numbered from 0")
        return i

    def _body(self, i: int) -> Body:
        return self.obstacles[self._checked(i)]

    def _is_seen(self, i: int) -> bool:
        return any(self._parts(target) for target in self._targets.of[self._checked(i)])

    def _is_acquired(self, i: int) -> bool:
        return self._targets.is_whole(self._checked(i), self._covers)

    def _is_told_beside(self, i: int, k: int, part: Interval) -> bool:
        """Whether a known point of an edge is a corner of which another edge tells.

        A known corner belongs to the edge that starts there, unless it ends a known part of the other one.
        """
        targets = self._targets.of[i]
        before, target, after = targets[k - 1], targets[k], targets[(k + 1) % len(targets)]
        if len(targets) == 1:
            return False
        if part.low.compare(target.span.low) == 0:
            return before.span.end == target.span.start and self._reaches_end(before)
        if part.high.compare(target.span.high) != 0 or target.span.end != after.span.start:
            return False
        return any(part.low.compare(after.span.low) == 0 for part in self._parts(after))

    def _on_edge(self, i: int, k: int) -> Iterator[Known]:
        target = self._targets.of[i][k]
        curve = self.obstacles[i].edges[k]
        if target.is_in(self._cover(target.edge)):
            yield Known(k, curve.start, curve.end, curve, whole=isinstance(curve, Arc) and curve.full)
            return
        for part in self._parts(target):
            if part.low.compare(part.high) == 0:
                # The two ends may be one point in two forms.
                if not self._is_told_beside(i, k, part):
                    yield Known(k, part.start, part.start, None)
            else:
                yield Known(k, part.start, part.end, curve.part(part.start, part.end))
