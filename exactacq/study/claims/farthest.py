"""The Sightseer Strategy with another choice rule: of the visible unvisited obstacles, the farthest one.

The paper says that its choice of the nearest does not affect the worst case (section 3.3). A run by this
rule must then keep Theorem 1's bound too. Everything else is the Sightseer's own.
"""

from __future__ import annotations

from exactacq.scene.scene import Scene
from exactacq.strategies.moves import KnownLink
from exactacq.strategies.robot import Robot
from exactacq.strategies.run import SightseerRun
from exactacq.strategies.sightseer.strategy import explored_by


class _FarSighted(Robot):
    """A scout that names the farthest unvisited obstacle where it is asked for the nearest."""

    def nearest_unvisited(self, source: int | None) -> KnownLink | None:
        """The longest link (then the first one) from a visited node to an unvisited obstacle it sees."""
        links = self.links(source)
        if source is None:
            # A start on an obstacle is no node of its own: that obstacle comes first, by either rule.
            links = tuple(link for link in links if link.length.sign() == 0) or links
        best: KnownLink | None = None
        for link in links:
            if link.target not in self.visited and (best is None or link.length > best.length):
                best = link
        return best


def farthest_first(scene: Scene, radius: object = None) -> SightseerRun:
    """Explore a scene from its start, always going to the farthest obstacle in sight.

    *radius* defaults to the scene's own. Raises `InvalidScene` if the scene has no rational start. Cost: all
    links within the radius.
    """
    return explored_by(_FarSighted(scene, radius=radius), scene)
