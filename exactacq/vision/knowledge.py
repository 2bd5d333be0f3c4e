"""The map: for every boundary edge the union of closed intervals that the robot has seen.

Intervals are ordered by exact rail parameters and merged where they meet, which is decided exactly.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from exactacq.curves import Arc, Curve
from exactacq.lengths import Length
from exactacq.points import Point
from exactacq.reals import Real
from exactacq.scene import Scene
from exactacq.vision.intervals import EMPTY, Cover
from exactacq.vision.rails import Rail


@dataclass(frozen=True)
class Known:
    """A known part of a boundary: on edge ``edge`` of its obstacle, from start to end along the edge.

    Equal ends are a single known point, or, if ``whole``, all of a full circle.
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


class Map:
    """What a robot knows at one moment. Immutable; exact.

    An obstacle is *seen* if any point of its boundary is known, *acquired* if all of it is, *incomplete* if
    some but not all.
    """

    def __init__(self, scene: Scene, rails: list[Rail], covers: Mapping[int, Cover]) -> None:
        self.scene = scene
        self._rails, self._covers = rails, covers
        firsts = [0]
        for obstacle in scene.obstacles:
            firsts.append(firsts[-1] + len(obstacle.edges))
        self._first = firsts

    def known(self, i: int) -> tuple[Known, ...]:
        """The known parts of obstacle i, by edge and then along it; parts that meet in an edge are one."""
        return tuple(part for k in range(len(self.scene.obstacles[i].edges)) for part in self._on_edge(i, k))

    def knows(self, i: int, point: Point) -> bool:
        """Whether a point of the boundary of obstacle i is known; ValueError if it is not on it."""
        edges = [k for k, edge in enumerate(self.scene.obstacles[i].edges) if edge.passes(point)]
        if not edges:
            raise ValueError(f"{point} is not on the boundary of obstacle {i}")
        return any(self._knows_on(self._first[i] + k, point) for k in edges)

    def _knows_on(self, e: int, point: Point) -> bool:
        rail, cover = self._rails[e], self._cover(e)
        if point in (rail.curve.start, rail.curve.end):
            ends = (Real(0), rail.top) if isinstance(rail.curve, Arc) and rail.curve.full else ()
            if any(cover.contains(u) for u in ends):
                return True
            point = rail.curve.start if point == rail.curve.start else rail.curve.end
        return cover.contains(rail.parameter(point))

    def known_length(self, i: int | None = None) -> Length:
        """Exact length of what is known of obstacle i, or of all obstacles."""
        obstacles = range(len(self.scene.obstacles)) if i is None else (i,)
        return Length.sum(
            self.scene.obstacles[j].perimeter
            if self._is_acquired(j)
            else Length.sum(p.length for p in self.known(j))
            for j in obstacles
        )

    @cached_property
    def seen(self) -> tuple[int, ...]:
        """Obstacles with a known point."""
        return tuple(i for i in range(len(self.scene.obstacles)) if self._is_seen(i))

    @cached_property
    def acquired(self) -> tuple[int, ...]:
        """Obstacles whose whole boundary is known."""
        return tuple(i for i in self.seen if self._is_acquired(i))

    @cached_property
    def incomplete(self) -> tuple[int, ...]:
        """Obstacles of whose boundary some but not all is known."""
        return tuple(i for i in self.seen if i not in set(self.acquired))

    @cached_property
    def frontier(self) -> tuple[tuple[int, Point], ...]:
        """Where known boundary ends: (obstacle, point), in the order of the boundary.

        A vertex between two edges that are both known there is no end; a single known point is one end.
        """
        return tuple((i, point) for i in self.incomplete for point in self._frontier(i))

    def _frontier(self, i: int) -> Iterator[Point]:
        count = len(self.scene.obstacles[i].edges)
        for k in range(count):
            e = self._first[i] + k
            before, after = (self._first[i] + (k + step) % count for step in (-1, 1))
            for part in self._cover(e).intervals:
                at_start, at_end = part.low.sign() == 0, part.high.compare(self._rails[e].top) == 0
                single = part.low.compare(part.high) == 0
                open_start = not (at_start and self._reaches_end(before))
                open_end = not (at_end and self._reaches_start(after))
                if single:
                    if open_start and open_end:
                        yield part.start
                    continue
                if open_start:
                    yield part.start
                if open_end:
                    yield part.end

    def _reaches_end(self, e: int) -> bool:
        parts, top = self._cover(e).intervals, self._rails[e].top
        return bool(parts) and parts[-1].high.compare(top) == 0 and parts[-1].low.compare(top) < 0

    def _reaches_start(self, e: int) -> bool:
        parts = self._cover(e).intervals
        return bool(parts) and parts[0].low.sign() == 0 and parts[0].high.sign() > 0

    def _cover(self, e: int) -> Cover:
        return self._covers.get(e, EMPTY)

    def _is_seen(self, i: int) -> bool:
        return any(self._covers.get(e) for e in self._edges(i))

    def _is_acquired(self, i: int) -> bool:
        return all(self._cover(e).covers(self._rails[e].top) for e in self._edges(i))

    def _edges(self, i: int) -> range:
        return range(self._first[i], self._first[i + 1])

    def _on_edge(self, i: int, k: int) -> Iterator[Known]:
        e = self._first[i] + k
        rail, cover = self._rails[e], self._cover(e)
        curve = rail.curve
        if cover.covers(rail.top):
            yield Known(k, curve.start, curve.end, curve, whole=isinstance(curve, Arc) and curve.full)
            return
        for part in cover.intervals:
            single = part.low.compare(part.high) == 0
            yield Known(k, part.start, part.end, None if single else curve.part(part.start, part.end))
