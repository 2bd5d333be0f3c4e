"""Edges near a place and their vertices, numbered anew: the same for all families of lines there."""

from __future__ import annotations

from typing import final

from exactacq.kernel.images import STRAIGHT, EdgeImage


@final
class NearEdges:
    """Some edges of a scene, each once; edge j is number ``edges[j]`` in the scene.

    It begins at vertex j and ends at vertex ``last[j]``; ``vertices`` are the numbers of these in the scene:
    first where edges begin, then other ends. ``arcs`` are the numbers here of the arcs; ``middle[j]`` is the
    place of edge j among them, -1 for a segment.
    """

    def __init__(self, images: list[EdgeImage], edges: list[int]) -> None:
        self.images, self.edges = images, edges
        count = len(edges)
        self._at: dict[int, int] = {}
        self._beyond: dict[int, int] = {}
        self.last = [0] * count
        self.middle = [-1] * count
        self.arcs: list[int] = []
        self.vertices = edges.copy()
        at, beyond = self._at, self._beyond
        for j in range(count):
            at[edges[j]] = j
        for j in range(count):
            edge = images[edges[j]]
            v = edge.following
            # Mostly an edge is followed by the next one in the list.
            if j + 1 < count and edges[j + 1] == v:
                self.last[j] = j + 1
            else:
                k = at.get(v, -1)
                if k < 0:
                    k = beyond.get(v, -1)
                if k < 0:
                    k = beyond[v] = len(self.vertices)
                    self.vertices.append(v)
                self.last[j] = k
            if edge.kind != STRAIGHT:
                self.middle[j] = len(self.arcs)
                self.arcs.append(j)

    def edge(self, e: int) -> int:
        """The number here of an edge of the scene, -1 if it is not near."""
        return self._at.get(e, -1)

    def has_vertex(self, v: int) -> bool:
        """Whether a vertex of the scene is an end of an edge here."""
        return v in self._at or v in self._beyond
