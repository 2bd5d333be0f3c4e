"""How short any path must be that explores a scene, even if the scene were known: exact lower bounds.

The shortest tour that sees, or circles, every obstacle is hard to find. What is bounded here is less: the
tree that joins the obstacles. Each bound says what it leaves out.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from heapq import heapify, heappop, heappush
from typing import NamedTuple

import numpy as np
from flint import fmpq
from networkx.utils import UnionFind

from exactacq.cached import cached_property
from exactacq.geometry.coordinates import raw
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.intersections import spans
from exactacq.geometry.points import Point
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.gaps import SLACK, boundary_distance
from exactacq.scene.scene import Scene, radius_of, start_of
from exactacq.visibility.links import START, Node


class Separation(NamedTuple):
    """Two nodes of a tree, numbers of obstacles or the start "S", and how far apart they are at least."""

    source: Node
    target: Node
    length: Real


class OfflineBounds(NamedTuple):
    """Lower bounds of paths, and the gaps whose sum each contains.

    ``circling``: for a path from the start that walks along the whole boundary of every obstacle.
    ``seeing``: for one that comes near enough to each to see something of it.
    """

    circling: Length
    seeing: Length
    tree: tuple[Separation, ...]
    seeing_tree: tuple[Separation, ...]


def offline_bounds(
    scene: Scene,
    radius: object = None,
    *,
    start: Point | Sequence[object] | None = None,
    obstacles: Collection[int] | None = None,
) -> OfflineBounds:
    """Exact lower bounds of any path that explores a scene from a start with a sensor of a radius.

    Only some *obstacles*, by number, are to be explored if they are given. *radius* and *start* default to
    the scene's own, or to the south-west corner of its terrain.

    *Circling*: take the boundaries out of such a path. What is left consists of ways that join two
    obstacles, or the start and one, and touch nothing between; each is at least as long as the distance of
    the two. Together they join all, so they are no shorter than a minimum spanning tree of the distances.
    To this the perimeters are added. Left out: ways that obstacles or the order of visits make longer, and
    boundary that is walked twice.

    *Seeing*: to see anything of an obstacle the path comes within the radius R of it. Between two such
    places it is at least the distance less 2R long; from the start, less R. In the order in which the path
    sees the obstacles first, these are the edges of a spanning tree. Left out besides: that all of the
    boundary is to be seen.

    Raises `InvalidScene` and `FormatError` as the strategies do for a radius and a start. Cost: the gaps of
    all boxes, quadratic in the obstacles in floats; distances are exact only for pairs that may be edges.

    >>> import exactacq as xa
    >>> run = xa.sightseer(xa.load("circles"))
    >>> bounds = offline_bounds(run.scene)
    >>> print(bounds.circling, bounds.seeing, run.length)
    5 + 10*pi 0 5 + 12*pi
    >>> print(offline_bounds(run.scene, radius=1).seeing)
    2
    """
    place = _start(scene, start)
    reach = radius_of(scene, radius, place)
    numbers = range(len(scene.obstacles)) if obstacles is None else sorted(set(obstacles))
    gaps = _Separations(scene, place, numbers)
    tree = tuple(gaps.tree(lambda gap, _: gap))
    seeing = tuple(gaps.tree(lambda gap, is_first: _without(gap, reach if is_first else 2 * reach)))
    perimeters = Length.sum(scene.obstacles[k].perimeter for k in numbers)
    return OfflineBounds(perimeters + _sum(tree), _sum(seeing), tree, seeing)


def _start(scene: Scene, start: Point | Sequence[object] | None) -> Point:
    if start is None and scene.start is None and scene.terrain is not None:
        return scene.terrain.south_west
    return start_of(scene, start)


def _without(gap: Real, reach: fmpq) -> Real:
    """What is left of a gap, if anything."""
    rest = gap - reach
    return rest if rest.sign() > 0 else Real(0)


def _sum(tree: Collection[Separation]) -> Length:
    return Length(Real.sum(gap.length for gap in tree))


class _Separations:
    """The distances between some obstacles of a scene, and from a place to each."""

    def __init__(self, scene: Scene, start: Point, numbers: Sequence[int]) -> None:
        self.table, self.start, self.numbers = EdgeTable(scene.obstacles), start, numbers
        self._exact: dict[tuple[Node, Node], Real] = {}

    def tree(self, weight: Callable[[Real, bool], Real]) -> Iterator[Separation]:
        """A minimum spanning tree (Kruskal) of the gaps, weighted by a function that does not fall.

        It is asked for the weight of a gap and whether that begins at the start. Gaps are computed when lower
        bounds do not show that shorter ones join the same parts.
        """
        joined, wanted = UnionFind([START, *self.numbers]), len(self.numbers)
        heap: list[tuple[float, tuple[int, int], Separation | None]] = [
            (_at_least(weight(Real(low), i == 0)), (i, j), None) for low, i, j in self._lower_bounds
        ]
        heapify(heap)
        while wanted:
            close = self._next(heap, joined, weight)
            if not close:
                return
            for place, gap in close[1:]:
                heappush(heap, (_at_least(gap.length), place, gap))
            _, least = close[0]
            joined.union(least.source, least.target)
            wanted -= 1
            yield least

    def _next(
        self,
        heap: list[tuple[float, tuple[int, int], Separation | None]],
        joined: UnionFind,
        weight: Callable[[Real, bool], Real],
    ) -> list[tuple[tuple[int, int], Separation]]:
        """The gaps that may be the least between parts, in exact order; they leave the heap."""
        close: list[tuple[tuple[int, int], Separation]] = []
        most = float("inf")
        while heap and heap[0][0] <= most:
            _, (i, j), gap = heappop(heap)
            source, target = self._node(i), self._node(j)
            if joined[source] == joined[target]:
                continue
            if gap is None:
                gap = Separation(source, target, weight(self._gap(source, target), i == 0))
                heappush(heap, (_at_least(gap.length), (i, j), gap))
                continue
            if gap.length.rational == 0:
                # Nothing is less: what else may be 0 is left for later.
                return [((i, j), gap), *close]
            close.append(((i, j), gap))
            size = float(gap.length)
            most = min(most, size + margin(SLACK * size))
        close.sort(key=lambda one: one[1].length)
        return close

    def _node(self, i: int) -> Node:
        return START if i == 0 else self.numbers[i - 1]

    @cached_property
    def _lower_bounds(self) -> list[tuple[float, int, int]]:
        """Lower bounds of all gaps: those of boxes, the start's first."""
        x, y = self.start.xy
        boxes = np.vstack(([(x, y, x, y)], self.table.hulls[list(self.numbers)]))
        slack = 1e-14 * (abs(x) + abs(y)) + self.table.roundoff
        found = []
        for i, box in enumerate(boxes):
            apart = np.maximum(np.maximum(boxes[i + 1 :, :2] - box[2:], box[:2] - boxes[i + 1 :, 2:]), 0.0)
            lows = np.maximum(np.hypot(*apart.T) * (1 - 1e-14) - slack, 0.0)
            found += [(low, i, i + 1 + k) for k, low in enumerate(lows.tolist())]
        return found

    def _gap(self, source: Node, target: Node) -> Real:
        key = source, target
        if key not in self._exact:
            assert isinstance(target, int), "the start comes first"
            self._exact[key] = (
                boundary_distance(self.table, source, target)
                if isinstance(source, int)
                else self._from_start(target)
            )
        return self._exact[key]

    def _from_start(self, j: int) -> Real:
        squares = (_distance_sq(self.start, self.table.curves[e]) for e in self.table.edges_of(j))
        least: Real = min(squares)
        return least.sqrt()


def _distance_sq(place: Point, curve: Curve) -> Real:
    """The square of a place's distance from a curve, arcs with their ends."""
    ends = [(place - end).norm_sq() for end in (curve.start, curve.end)]
    if isinstance(curve, Segment):
        along = curve.direction
        share = (place - curve.start).dot(along) / along.norm_sq()
        if 0 < share < 1:
            foot = curve.start + along * share
            return (foot - place).norm_sq()
        return min(ends)
    offset = place - curve.center
    if offset.norm_sq().sign() == 0:
        return Real(curve.radius_sq)
    if curve.full or spans(curve, raw(offset)):
        gap = offset.norm_sq().sqrt() - curve.radius
        return gap * gap
    return min(ends)


def _at_least(length: Real) -> float:
    """A lower bound of a length, from its float."""
    size = float(length)
    return max(size - margin(SLACK * size), 0.0)
