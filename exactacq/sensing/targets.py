"""What a run has to acquire: obstacles by number, each with the edges, or parts of edges, that belong to it.

An obstacle usually counts with its whole boundary. Where a terrain's border cuts obstacles, only boundary
that the robot can reach counts, and one edge may belong to several components.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import chain, repeat
from typing import NamedTuple, TypeAlias

from exactacq.cached import cached_property
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.interval_union import EMPTY, Cover, Interval
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.terrain_components import Component
from exactacq.sensing.cut_ends import CutEnd
from exactacq.visibility.sensor_range import Range

Part: TypeAlias = "tuple[int, Interval]"
"""An edge, by its number, and an interval of it."""
NOBODY: frozenset[int] = frozenset()
"""What an edge counts for that belongs to no obstacle."""


class Target(NamedTuple):
    """A part of an edge that counts for an obstacle; ``whole`` if it is all of the edge."""

    edge: int
    span: Interval
    whole: bool

    def clip(self, interval: Interval) -> Interval | None:
        """What of an interval of the edge lies in the part; ends are copied."""
        return interval if self.whole else interval.within(self.span)

    def contains(self, interval: Interval) -> bool:
        """Whether the part contains an interval of the edge."""
        return self.whole or (self.span.low <= interval.low and self.span.high >= interval.high)

    def is_in(self, cover: Cover) -> bool:
        """Whether a cover of the edge contains all of the part."""
        return cover.covers(self.span.low, self.span.high)


class Targets:
    """The targets of every obstacle, in the order of its boundary.

    ``cut_ends`` are, by obstacle, the two ends of a boundary that a terrain's border cuts; ``cut`` are the
    scene's obstacles of which not all counts, by their own numbers.
    """

    def __init__(
        self,
        of: Sequence[tuple[Target, ...]],
        cut_ends: Mapping[int, Sequence[CutEnd]] | None = None,
        cut: Collection[int] = (),
    ) -> None:
        self.of, self.cut_ends, self.cut = tuple(of), cut_ends or {}, cut
        self.edges = [frozenset(target.edge for target in targets) for targets in self.of]
        self._on: dict[int, list[tuple[int, Target]]] = {}
        for k, targets in enumerate(self.of):
            for target in targets:
                self._on.setdefault(target.edge, []).append((k, target))
        # One object for equal sets: mostly all edges of an obstacle count for it alone.
        shared: dict[frozenset[int], frozenset[int]] = {}
        self._owners = {
            e: shared.setdefault(owners := frozenset(k for k, _ in found), owners)
            for e, found in self._on.items()
        }
        self._missing: dict[int, int] = {}

    def whole_covers(self, k: int) -> Iterator[tuple[int, Cover]]:
        """The edges that count for an obstacle with all they are, covered all over."""
        return ((target.edge, Cover((target.span,))) for target in self.of[k] if target.whole)

    @cached_property
    def owners(self) -> dict[int, list[tuple[int, bool]]]:
        """The obstacles that edges count for, and whether all of the edge does."""
        return {e: [(k, target.whole) for k, target in some] for e, some in self._on.items()}

    @classmethod
    def whole(cls, table: EdgeTable, rails: Sequence[Rail]) -> Targets:
        """All obstacles of a scene with their whole boundaries."""
        return cls(
            [
                tuple(Target(e, Interval.whole(rails[e]), True) for e in table.edges_of(k))
                for k in range(len(table.obstacles))
            ]
        )

    @classmethod
    def of_components(cls, components: Iterable[Component], table: EdgeTable, range_: Range) -> Targets:
        """The shores of a terrain's components, with their ends where a border cuts them."""
        of, cut_ends, cut = [], {}, set[int]()
        for component in components:
            first = int(table.first[component.obstacle.index])
            targets = tuple(Target(first + p.edge, p.span, p.is_whole) for p in component.shore)
            if sum(target.whole for target in targets) < len(component.obstacle.edges):
                cut.add(component.obstacle.index)
            if not component.closed:
                begin, end = targets[0], targets[-1]
                cut_ends[component.index] = (
                    CutEnd(table, range_, begin.edge, begin.span.low, begin.span.start),
                    CutEnd(table, range_, end.edge, end.span.high, end.span.end),
                )
            of.append(targets)
        return cls(of, cut_ends, cut)

    def on(self, edge: int) -> Sequence[tuple[int, Target]]:
        """The obstacles that an edge counts for."""
        return self._on.get(edge, ())

    def alone(self, k: int) -> set[int]:
        """The edges that count for an obstacle and for no other."""
        return {e for e in self.edges[k] if len(self._on[e]) == 1}

    def of_edges(self, edges: Iterable[int]) -> set[int]:
        """The obstacles that some of the edges count for."""
        return set[int]().union(*self._different(edges))

    def counting(self, edges: Collection[int], obstacles: Collection[int]) -> list[int]:
        """Those of some edges that count for some of the obstacles."""
        owners, some = self._owners, frozenset(obstacles)
        counting = {of for of in self._different(edges) if not some.isdisjoint(of)}
        return [e for e in edges if owners.get(e) in counting]

    def _different(self, edges: Iterable[int]) -> set[frozenset[int]]:
        """The different sets of obstacles that some edges count for."""
        return set(map(self._owners.get, edges, repeat(NOBODY)))

    def is_among(self, k: int, spans: Mapping[int, Iterable[Interval]]) -> bool:
        """Whether intervals of edges, by their numbers, contain anything of an obstacle."""
        if self.edges[k].isdisjoint(spans):
            return False
        return any(
            target.edge in spans
            and (target.whole or any(target.clip(i) is not None for i in spans[target.edge]))
            for target in self.of[k]
        )

    def within(
        self, obstacles: Collection[int], spans: Mapping[int, Iterable[Interval]]
    ) -> Iterator[tuple[int, Part]]:
        """What intervals of edges, by their numbers, contain of some obstacles, with the obstacle of each.

        Only intervals of their edges are looked up. Cost: linear in the edges with intervals, or in those of
        the obstacles if these are fewer.
        """
        edges: Iterable[int] = spans
        if sum(len(self.edges[k]) for k in obstacles) < len(spans):
            edges = {e for k in obstacles for e in self.edges[k] if e in spans}
        for e in edges:
            for k, target in self.on(e):
                if k in obstacles:
                    for interval in spans[e]:
                        part = target.clip(interval)
                        if part is not None:
                            yield k, (e, part)

    def is_whole(self, k: int, covers: Mapping[int, Cover]) -> bool:
        """Whether covers of the edges contain all of an obstacle.

        The one that was missing when last asked is asked first: a walk around asks once for every edge.
        """
        targets = self.of[k]
        first = self._missing.get(k, 0)
        for at in chain(range(first, len(targets)), range(first)):
            if not targets[at].is_in(covers.get(targets[at].edge, EMPTY)):
                self._missing[k] = at
                return False
        return True
