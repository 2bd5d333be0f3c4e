"""The Sightseer Strategy with another choice rule: of the visible unvisited obstacles, the farthest one.

The paper says that its choice of the nearest does not affect the worst case (section 3.3). A run by this
rule must then keep Theorem 1's bound too. Everything else is the Sightseer's own.
"""

from __future__ import annotations

from exactacq.strategies.known_links import KnownLinks
from exactacq.strategies.moves import KnownLink
from exactacq.strategies.observer import HERE, Here
from exactacq.strategies.robot import Robot
from exactacq.strategies.run import SightseerRun
from exactacq.strategies.sightseer.strategy import explored_by
from exactacq.visibility.links import START, Link, Links


class _FarSighted(Robot):
    """A scout that names the farthest unvisited obstacle where it is asked for the nearest."""

    def __init__(self, links: Links) -> None:
        super().__init__(links.scene, radius=links.radius)
        self._links = KnownLinks(links, self.start)

    def nearest_unvisited(self, source: int | Here | None = HERE) -> KnownLink | None:
        """The longest link (then the first one) from a visited node to an unvisited obstacle it sees."""
        node = self._node_here() if source is HERE else self._node(source)
        links = self._known_links().of(node)
        if node == START:
            # A start on an obstacle is no node of its own: that obstacle comes first, by either rule.
            links = [link for link in links if link.length.sign() == 0] or links
        best: Link | None = None
        for link in links:
            if link.target not in self._walker.visited and (best is None or link.length > best.length):
                best = link
        return None if best is None else self._known_link(best)


def farthest_first(links: Links) -> SightseerRun:
    """Explore the scene of some links from its start, always going to the farthest obstacle in sight.

    Raises `InvalidScene` if there is no rational start. Cost: all links within the radius.
    """
    return explored_by(_FarSighted(links), links.scene)
