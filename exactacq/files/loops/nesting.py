"""Which loop of a drawing is the wall, which are obstacles, and which the robot can never see."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from exactacq.cached import cached_property
from exactacq.errors import FormatError
from exactacq.files.rereading import once
from exactacq.geometry.box_index import BoxIndex, bounds, box, united
from exactacq.geometry.curves import Segment
from exactacq.geometry.intersections import contacts
from exactacq.geometry.loops import winding
from exactacq.geometry.points import Point
from exactacq.scene.shapes import Shape, shape_edges

MAX_CANDIDATES = 5_000_000
"""Pairs of edges with overlapping boxes beyond which a drawing is refused: a minute's work, and no clean part
comes near it (a real plan of 1854 edges has some thousand)."""
MAX_COMPARED = 100_000
"""Most pairs of edges of different loops that are compared exactly: each takes some 0.03 milliseconds. Loops
of a drawing are apart but for a few."""


class Loops:
    """Closed loops, valid or not, with exact answers on which meet and which lie inside which."""

    def __init__(self, shapes: Sequence[Shape]) -> None:
        self.shapes = tuple(shapes)
        self.edges = [shape_edges(shape) for shape in shapes]

    @cached_property
    def _boxes(self) -> tuple[NDArray[np.float64], list[int]]:
        """The box of every edge, and where each loop's edges begin."""
        begin = [0]
        for edges in self.edges:
            begin.append(begin[-1] + len(edges))
        return bounds([edge for edges in self.edges for edge in edges]), begin

    @cached_property
    def _hulls(self) -> NDArray[np.float64]:
        """The box of every loop."""
        array, begin = self._boxes
        return united(array, begin[:-1])

    @cached_property
    def meeting(self) -> frozenset[tuple[int, int]]:
        """The pairs i < j of loops whose boundaries have a point in common."""
        array, begin = self._boxes
        owner = np.repeat(np.arange(len(self.edges)), np.diff(begin))
        flat = [edge for edges in self.edges for edge in edges]
        found: set[tuple[int, int]] = set()
        # Options that are tried leave most loops as they were.
        numbers: dict[Shape, int] = once("loops", dict)
        told: dict[tuple[int, int], bool] = once("whether loops meet", dict)
        number = [numbers.setdefault(shape, len(numbers)) for shape in self.shapes]
        asked: set[tuple[int, int]] = set()
        candidates = compared = 0
        for first, second in BoxIndex(array).pairs():
            other = owner[first] != owner[second]
            candidates += int(other.sum())
            if candidates > MAX_CANDIDATES:
                raise FormatError(
                    f"more than {MAX_CANDIDATES} pairs of edges overlap; select layers that hold one part"
                )
            for a, b in zip(first[other].tolist(), second[other].tolist(), strict=True):
                i, j = sorted((int(owner[a]), int(owner[b])))
                if (i, j) in found:
                    continue
                known = told.get((number[i], number[j]))
                if known is None:
                    asked.add((i, j))
                    compared += 1
                    if compared > MAX_COMPARED:
                        raise FormatError(
                            f"more than {MAX_COMPARED} pairs of edges nearly meet; "
                            "select layers that hold one part"
                        )
                    known = bool(contacts(flat[a], flat[b]))
                if known:
                    found.add((i, j))
        told.update({(number[i], number[j]): (i, j) in found for i, j in asked})
        return frozenset(found)

    def meet(self, i: int, j: int) -> bool:
        """Whether two loops have a common point."""
        return (min(i, j), max(i, j)) in self.meeting

    def around(self, point: Point) -> list[int]:
        """The loops that wind round a point (those through it do not count)."""
        index = BoxIndex(self._hulls)
        x0, y0, x1, y1 = _window(point)
        return [i for i in index.query(x0, y0, x1, y1).tolist() if self._winds(i, point)]

    def containers(self, i: int) -> list[int]:
        """The loops that contain loop i entirely, without a common point."""
        x0, y0, x1, y1 = self._hulls[i]
        h = self._hulls
        wider = (h[:, 0] <= x0) & (h[:, 1] <= y0) & (h[:, 2] >= x1) & (h[:, 3] >= y1)
        point = self.edges[i][0].start
        return [
            j
            for j in np.flatnonzero(wider).tolist()
            if j != i and not self.meet(i, j) and self._winds(j, point)
        ]

    def _winds(self, i: int, point: Point) -> bool:
        """Whether loop i winds round a point; edges whose boxes the ray to the east misses are not asked."""
        array, begin = self._boxes
        part = array[begin[i] : begin[i + 1]]
        x0, y0, _, y1 = _window(point)
        near = (part[:, 1] <= y1) & (part[:, 3] >= y0) & (part[:, 2] >= x0)
        return bool(winding([self.edges[i][k] for k in np.flatnonzero(near).tolist()], point))


def _window(point: Point) -> tuple[float, float, float, float]:
    """A box that contains a point."""
    return box(Segment(point, point))


@dataclass(slots=True)
class Nested:
    """The outcome: indices into the loops."""

    obstacles: list[int]
    wall: int | None = None
    dropped: int | None = None
    """The outer loop, dropped on request."""
    outside: list[int] = field(default_factory=list)
    hidden: list[int] = field(default_factory=list)


def nest(loops: Loops, start: Point | None, outer: str = "wall", wall: int | None = None) -> Nested:
    """Sort loops into wall, obstacles, those outside the wall and those hidden inside an obstacle.

    The outermost loop that winds round the start becomes the wall, or is dropped with ``outer="drop"``; with
    ``outer="room"`` the innermost one is the wall, so that the loops may bound areas of any nesting. All
    loops are obstacles alike with ``outer="keep"``, without a start, and if *wall* names the wall. A start
    on a loop is not inside it. A loop counts as outside or hidden only if it has no point in common with the
    loop that separates it: what crosses or touches stays, for the scene to refuse. Near linear in the edges,
    quadratic (one numpy comparison a loop) in the loops.
    """
    remaining = list(range(len(loops.shapes)))
    outcome = Nested([], wall)
    around = loops.around(start) if start is not None and outer != "keep" and wall is None else []
    if wall is not None:
        remaining.remove(wall)
    if around:
        depth = {i: len(set(loops.containers(i)) & set(around)) for i in around}
        sign = -1 if outer == "room" else 1
        chosen = min(around, key=lambda i: (sign * depth[i], i))
        remaining.remove(chosen)
        if outer == "drop":
            outcome.dropped = chosen
        else:
            outcome.wall = chosen
    containers = {i: loops.containers(i) for i in remaining}
    inner = outcome.wall
    if inner is not None:
        outcome.outside = [i for i in remaining if inner not in containers[i] and not loops.meet(i, inner)]
        remaining = sorted(set(remaining) - set(outcome.outside))
    solid = set(remaining)
    outcome.hidden = [i for i in remaining if any(j in solid for j in containers[i])]
    outcome.obstacles = [i for i in remaining if i not in set(outcome.hidden)]
    return outcome
