"""The Sightseer Strategy with another choice rule: of the visible unvisited obstacles, the farthest one.

The paper says that its choice of the nearest does not affect the worst case (section 3.3). A run by this
rule must then keep Theorem 1's bound too. Everything else is the Sightseer's own.
"""

from __future__ import annotations

from collections.abc import Set

from exactacq.geometry.points import Point
from exactacq.sensing.memory import Memory, Report
from exactacq.sensing.path import Piece
from exactacq.strategies.known_links import KnownLinks
from exactacq.strategies.moves import KnownLink
from exactacq.strategies.robot import Robot
from exactacq.strategies.run import SightseerRun
from exactacq.strategies.sightseer.strategy import explored_by
from exactacq.strategies.walker import Walker
from exactacq.visibility.links import Links


class _Unsensed(Memory):
    """A memory that takes in nothing, and calls all boundaries known: the rule goes by links alone.

    These tell all of a visited boundary's neighbours. What else is seen on the way decides nothing where all
    obstacles are linked, and costs more than the rest of the run.
    """

    def begin(self, start: Point) -> list[Report]:
        return []

    def walk(self, piece: Piece) -> list[Report]:
        return []

    @property
    def acquired(self) -> Set[int]:
        return set(range(len(self.bodies)))

    @property
    def seen(self) -> set[int]:
        return set(range(len(self.bodies)))


class _FarSighted(Robot):
    """A scout that names the farthest unvisited obstacle where it is asked for the nearest."""

    def __init__(self, links: Links) -> None:
        super().__init__(links.scene, radius=links.radius)
        self._walker = Walker(self.start, _Unsensed(links.scene, links.radius, links.table))
        self._links = KnownLinks(links, self.start)

    def nearest_unvisited(self, source: int | None) -> KnownLink | None:
        """The longest link (then the first one) from a visited node to an unvisited obstacle it sees."""
        for seen in self._known_links().of(self._node(source)):
            self._numbering.add(seen.target)
        links = self.links(source)
        if source is None:
            # A start on an obstacle is no node of its own: that obstacle comes first, by either rule.
            links = tuple(link for link in links if link.length.sign() == 0) or links
        best: KnownLink | None = None
        for link in links:
            if link.target not in self.visited and (best is None or link.length > best.length):
                best = link
        return best


def farthest_first(links: Links) -> SightseerRun:
    """Explore the scene of some links from its start, always going to the farthest obstacle in sight.

    The run tells path, visits and bounds; its map is empty. Raises `InvalidScene` if there is no rational
    start. Cost: all links within the radius.
    """
    return explored_by(_FarSighted(links), links.scene)
