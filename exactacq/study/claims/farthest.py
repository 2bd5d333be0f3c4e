"""The Sightseer Strategy with another choice rule: of the visible unvisited obstacles, the farthest one.

The paper says that its choice of the nearest does not affect the worst case (section 3.3). A run by this
rule must then keep Theorem 1's bound too. Everything else is the Sightseer's own.
"""

from __future__ import annotations

from exactacq.scene.scene import Scene, start_of
from exactacq.strategies.run import SightseerRun
from exactacq.strategies.sightseer.robot import SightseerRobot
from exactacq.strategies.sightseer.strategy import explored_by
from exactacq.visibility.links import START, Link, Node


class _FarSighted(SightseerRobot):
    """A scout that names the farthest unvisited obstacle where it is asked for the nearest."""

    def nearest_unvisited(self, node: Node) -> Link | None:
        """The longest link (then the least index) from a visited node to an unvisited obstacle it sees."""
        links = self.links_from(node)
        if node == START:
            # A start on an obstacle is no node of its own: that obstacle comes first, by either rule.
            links = [link for link in links if link.length.sign() == 0] or links
        best: Link | None = None
        for link in links:
            if link.target not in self.visited and (best is None or link.length > best.length):
                best = link
        return best


def farthest_first(scene: Scene, radius: object = None) -> SightseerRun:
    """Explore a scene from its start, always going to the farthest obstacle in sight.

    *radius* defaults to the scene's own. Raises `InvalidScene` if the scene has no rational start. Cost: all
    links within the radius.
    """
    return explored_by(_FarSighted(scene, radius, start_of(scene)), scene)
