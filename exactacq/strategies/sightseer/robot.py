"""The Sightseer's robot: it finds the nearest unvisited obstacle, and goes from obstacle to obstacle by the
shortest segments that it has seen. Of equally near obstacles the one with the least index is the nearest.

A strategy can ask for the robot's place, the obstacles on its map, and the links from boundaries that it
has walked all around (or from the start), and for nothing else.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable
from functools import partial
from heapq import heappop, heappush

from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Location, Point
from exactacq.numbers.float_bounds import margin
from exactacq.scene.scene import Scene
from exactacq.scene.validation import place_text
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.strategies.robot import Robot
from exactacq.visibility.links import START, Link, Links, Node

SLACK = 1e-12
"""Floats of lengths that differ by more than this part tell which is less."""


class _LinksByLength:
    """The links from one node, the least (then that to the least index) first; each is compared once.

    *near* are the obstacles that they may lead to, each with a lower bound of the length; lower bounds decide
    which links are computed.
    """

    def __init__(self, near: Iterable[tuple[float, int]], link: Callable[[int], Link | None]) -> None:
        self._link = link
        self._near = sorted(near, reverse=True)
        self._found: list[tuple[float, int, Link]] = []
        # The links that floats cannot tell from the least, in order, the first one last.
        self._least: list[Link] = []

    def first(self, visited: Container[int]) -> Link | None:
        """The least link to an obstacle that was not visited."""
        while True:
            while self._least and self._least[-1].target in visited:
                self._least.pop()
            if self._least:
                return self._least[-1]
            self._least = self._next(visited)
            if not self._least:
                return None

    def _next(self, visited: Container[int]) -> list[Link]:
        while self._found and self._found[0][1] in visited:
            heappop(self._found)
        while self._near and not (self._found and self._near[-1][0] > _at_most(self._found[0][0])):
            _, j = self._near.pop()
            link = None if j in visited else self._link(j)
            if link is not None:
                heappush(self._found, (float(link.length), j, link))
        least = _at_most(self._found[0][0]) if self._found else 0.0
        close = []
        while self._found and self._found[0][0] <= least:
            _, j, link = heappop(self._found)
            if j not in visited:
                close.append(link)
        close.sort(key=lambda link: link.target)
        close.sort(key=lambda link: link.length)
        return close[::-1]


def _at_most(length: float) -> float:
    """An upper bound of a length, from its float."""
    return length + margin(SLACK * length)


class SightseerRobot(Robot):
    """A point robot at *start* with a vision sensor of limited *radius*.

    The start must be free and have rational coordinates: ValueError otherwise.
    """

    def __init__(self, scene: Scene, radius: object, start: Point) -> None:
        self._links = Links(scene, radius)
        for obstacle in scene.obstacles:
            if obstacle.locate(start) is Location.INSIDE:
                raise ValueError(f"the start {place_text(start)} lies inside obstacle {obstacle.label}")
        self.radius = self._links.radius
        self._nearest: dict[Node, _LinksByLength] = {}
        super().__init__(start, Memory(scene, self.radius, self._links.table))

    # -- the map -----------------------------------------------------------------------------------

    def nearest_unvisited(self, node: Node) -> Link | None:
        """The shortest link (then the least index) from a visited node to an unvisited obstacle it sees."""
        if node not in self._nearest:
            self._nearest[node] = self._links_by_length(node)
        return self._nearest[node].first(self.visited)

    def _links_by_length(self, node: Node) -> _LinksByLength:
        if node == START:
            links = self._links.from_point(self.start)
            return _LinksByLength(((0.0, j) for j in links), links.get)
        assert isinstance(node, int)
        assert node in self.visited, "a boundary shows its links only once it was walked all around"
        bounds = self._links.lower_bounds(node)
        near = ((float(bounds[j]), j) for j in self._links.neighbours(node))
        return _LinksByLength(near, partial(self._links.between, node))

    def links_from(self, node: Node) -> list[Link]:
        """All links from a visited node, in the order of the obstacles that they lead to."""
        if node == START:
            return [link for _, link in sorted(self._links.from_point(self.start).items())]
        assert isinstance(node, int)
        assert node in self.visited, "a boundary shows its links only once it was walked all around"
        between = (self._links.between(node, j) for j in sorted(self._links.neighbours(node)))
        return [link for link in between if link is not None]

    def knows_unvisited(self) -> bool:
        """Whether an obstacle that was not visited is on the map."""
        # What was visited was seen: the robot stood on it.
        return len(self._memory.seen) > len(self.visited)

    def unvisited(self) -> tuple[list[int], list[int]]:
        """The obstacles on the map that were not visited, and those that never came on the map."""
        left = [j for j in range(self._links.count) if j not in self.visited]
        seen = self._memory.seen
        return [j for j in left if j in seen], [j for j in left if j not in seen]

    # -- motion ------------------------------------------------------------------------------------

    def linear_navigate(self, node: Node, target: Point) -> None:
        """Go straight to a point of *node* along a free segment."""
        if self.position != target:
            self._move(Piece("straight", None, Segment(self.position, target)))
        self.at, self.position = node, target
