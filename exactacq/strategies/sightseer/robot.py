"""The Sightseer's robot: it finds the nearest unvisited obstacle, and goes from obstacle to obstacle by the
shortest segments that it has seen. Of equally near obstacles the one with the least index is the nearest.

A strategy can ask for the robot's place, the obstacles on its map, and the links from boundaries that it
has walked all around (or from the start), and for nothing else.
"""

from __future__ import annotations

from collections.abc import Hashable

from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Location, Point
from exactacq.scene.scene import Scene
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.strategies.robot import Robot
from exactacq.visibility.links import START, Link, Links, Node


class SightseerRobot(Robot):
    """A point robot at *start* with a vision sensor of limited *radius*.

    The start must be free and have rational coordinates: ValueError otherwise.
    """

    def __init__(self, scene: Scene, radius: object, start: Point) -> None:
        self._links = Links(scene, radius)
        for obstacle in scene.obstacles:
            if obstacle.locate(start) is Location.INSIDE:
                raise ValueError(f"the start {start} lies inside obstacle {obstacle.index}")
        self.radius = self._links.radius
        self._exhausted: set[Node] = set()
        super().__init__(start, Memory(scene, self.radius, self._links.table))

    # -- the map -----------------------------------------------------------------------------------

    def nearest_unvisited(self, node: Node) -> Link | None:
        """The shortest link (then the least index) from a visited node to an unvisited obstacle it sees."""
        if node in self._exhausted:
            return None
        if node == START:
            found = [link for j, link in self._links.from_point(self.start).items() if j not in self.visited]
        else:
            assert isinstance(node, int)
            assert node in self.visited, "a boundary shows its links only once it was walked all around"
            found = self._best_first(node)
        best: Link | None = None
        for link in sorted(found, key=lambda link: link.target):
            if best is None or link.length < best.length:
                best = link
        if best is None:
            self._exhausted.add(node)
        return best

    def links_from(self, node: Node) -> list[Link]:
        """All links from a visited node, in the order of the obstacles that they lead to."""
        if node == START:
            return [link for _, link in sorted(self._links.from_point(self.start).items())]
        assert isinstance(node, int)
        assert node in self.visited, "a boundary shows its links only once it was walked all around"
        between = (self._links.between(node, j) for j in sorted(self._links.neighbours(node)))
        return [link for link in between if link is not None]

    def _best_first(self, node: int) -> list[Link]:
        """The links that can be the least: lower bounds decide which are computed."""
        bounds = self._links.lower_bounds(node)
        near = sorted(
            (j for j in self._links.neighbours(node) if j not in self.visited), key=lambda j: bounds[j]
        )
        found: list[Link] = []
        least = float("inf")
        for j in near:
            if bounds[j] > least:
                break
            link = self._links.between(node, j)
            if link is not None:
                found.append(link)
                least = min(least, float(link.length) * (1 + 1e-12))
        return found

    def knows_unvisited(self) -> bool:
        """Whether an obstacle that was not visited is on the map."""
        return not self._memory.seen <= self.visited.keys()

    def unvisited(self) -> tuple[list[int], list[int]]:
        """The obstacles on the map that were not visited, and those that never came on the map."""
        left = [j for j in range(self._links.count) if j not in self.visited]
        seen = self._memory.seen
        return [j for j in left if j in seen], [j for j in left if j not in seen]

    # -- motion ------------------------------------------------------------------------------------

    def linear_navigate(self, node: Node, target: Point) -> None:
        """Go straight to a point of *node* along a free segment."""
        if self.position != target:
            self._move(Piece("straight", None, Segment(self.position, target), self._touches(node, target)))
        self.at, self.position = node, target

    def _touches(self, node: Node, target: Point) -> tuple[Hashable, ...]:
        """What holds the way to a point of another node."""
        if isinstance(self.at, int) and isinstance(node, int):
            link = self._links.between(self.at, node)
            return () if link is None else link.touches(self.position, target)
        inner = self.at if isinstance(self.at, int) else node
        link = self._links.from_point(self.start).get(inner) if isinstance(inner, int) else None
        if link is None:
            return ()
        hit = target if isinstance(node, int) else self.position
        return link.touches(None, hit)
