"""Maps with planted knowledge: any parts of the boundaries of obstacles, and walls that belong to none."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import exactacq as xa
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Curve
from exactacq.visibility.known_chains import KnownChain, known_chains
from exactacq.visibility.known_ground import KnownGround


class Part(NamedTuple):
    """A known part of an edge; a single point has no curve."""

    edge: int
    curve: Curve | None


class PartlyKnown:
    """A map of a scene on which of each edge the part between two parameters is known, or nothing.

    Of obstacles that are not named all is known. Parameters are numbers, or points of the edge.
    """

    def __init__(self, scene: xa.Scene, known: Mapping[int, Sequence[tuple[int, object, object]]]) -> None:
        self.obstacles, self._spans = scene.obstacles, known
        self.seen = tuple(range(len(scene.obstacles)))
        self.acquired = tuple(i for i in self.seen if i not in known)

    def known(self, i: int) -> list[Part]:
        edges = self.obstacles[i].edges
        if i not in self._spans:
            return [Part(k, edge) for k, edge in enumerate(edges)]
        parts = []
        for k, low, high in self._spans[i]:
            start, end = (_place(edges[k], u) for u in (low, high))
            is_whole = start is edges[k].start and end is edges[k].end
            parts.append(Part(k, edges[k] if is_whole else edges[k].part(start, end)))
        return parts


def _place(edge: Curve, u: object) -> xa.Point:
    if isinstance(u, xa.Point):
        return u
    rail, u = Rail(edge), xa.Real(u)
    return edge.start if u == 0 else edge.end if u == rail.top else rail.point(u.rational)


class Walled:
    """A map of walls, polylines whose obstacles are to the left, beside a scene that is wholly known."""

    def __init__(self, walls: Sequence[Sequence[object]], scene: xa.Scene | None = None) -> None:
        self._known_ground = KnownGround(
            scene or xa.Scene([]), [chain for wall in walls for chain in _chains(wall)]
        )


def _chains(wall: Sequence[object]) -> list[KnownChain]:
    """The edges of a boundary that goes on unseen at both ends."""
    (x, y), (u, v) = xa.Point.of(wall[0]), xa.Point.of(wall[-1])
    row = [(x - 1, y - 1), *wall, (u - 1, v - 1)]
    edges = [xa.Segment(p, q) for p, q in pairwise(xa.Point.of(point) for point in row)]
    return known_chains(0, [Part(k, edges[k]) for k in range(1, len(edges) - 1)], edges, False, edges)
