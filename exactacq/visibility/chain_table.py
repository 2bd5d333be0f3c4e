"""The edges of a scene and of chains in one table (see `exactacq.visibility.known_chains`).

A chain has every piece twice: on the way there, with the number of its *forward* edge, and on the way back.
The edges of a scene come first, then all forward edges of chains, then as many on the way back; only those on
the way there are found by place. So a peg knows by the numbers of its edges on which side of a chain it is,
and a place on a chain is on its free side.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from exactacq.cached import cached_property
from exactacq.geometry.box_index import bounds, circles
from exactacq.geometry.coordinates import Vector, raw
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Point
from exactacq.kernel.box_tree import BoxNode, box_tree
from exactacq.kernel.images import EdgeImage
from exactacq.numbers.real import Real
from exactacq.recent import Recent
from exactacq.scene.edge_table import CONCAVE, CONVEX, NEAR_KEPT, STRAIGHT, EdgeTable
from exactacq.visibility.known_chains import ChainPiece, KnownChain


class ChainTable(EdgeTable):
    """The table of a scene's edges with chains behind them.

    It has what shortest paths ask of a table; ``obstacles``, and arrays that only views need, are the
    scene's. ``owners`` of chains are their numbers after those of obstacles.
    """

    def __init__(self, solid: EdgeTable, chains: Sequence[KnownChain]) -> None:
        self.__dict__.update({k: v for k, v in vars(solid).items() if k not in _MADE_LATE})
        self.solid, self.chains, self.solids = solid, tuple(chains), len(solid.curves)
        there = [piece for chain in chains for piece in chain.pieces]
        self.forward = self.solids + len(there)
        """Edges before this number are found by place."""
        self._pieces = there + [piece.reversed() for piece in there]
        self.curves = [*solid.curves, *(piece.curve for piece in self._pieces)]
        spans = np.cumsum([self.solids, *(len(chain.pieces) for chain in chains)]).tolist()
        self.ends = [(first, last - 1) for first, last in itertools.pairwise(spans)]
        """Of each chain the first and the last forward edge."""
        self.following = following = [*solid.following, *([0] * len(self._pieces))]
        for first, last in self.ends:
            for e in range(first, last + 1):
                following[e] = e + 1 if e < last else self.twin(e)
                following[self.twin(e)] = self.twin(e - 1) if e > first else e
        self.next = np.array(following, dtype=np.intp)
        self.previous = np.argsort(self.next)
        self.preceding = self.previous.tolist()
        kinds = (STRAIGHT if isinstance(c, Segment) else CONVEX if c.ccw else CONCAVE for c in self.curves)
        self.kinds = list(kinds)
        owners = [len(solid.obstacles) + k for k, chain in enumerate(chains) for _ in chain.pieces]
        self.owners = [*solid.owners, *owners, *owners]
        self.owner = np.array(self.owners, dtype=np.intp)
        self.boxes = np.concatenate((solid.boxes, bounds([piece.curve for piece in there])))
        self.radius = np.concatenate((solid.radius, circles(self.curves[self.solids :])[:, 2]))
        self.magnitude = float(np.abs(self.boxes).max(initial=0.0))
        self._largest = max(self.magnitude, float(self.radius.max(initial=0.0)))
        self._around, self._lit = Recent(NEAR_KEPT), Recent(NEAR_KEPT)

    @cached_property
    def tree(self) -> BoxNode:
        """The boxes of the scene's and the forward edges."""
        return box_tree([(x0, y0, x1, y1) for x0, y0, x1, y1 in self.boxes.tolist()])

    @cached_property
    def images(self) -> list[EdgeImage]:
        """The edges as `kernel.clearance` takes them, which looks at no rests of coordinates."""
        found, radii = self.solid.images.copy(), self.radius.tolist()
        for e in range(self.solids, len(self.curves)):
            curve = self.curves[e]
            x, y = curve.start.xy
            u, v = curve.center.xy if isinstance(curve, Arc) else (0.0, 0.0)
            start, center = (x, 0.0, y, 0.0), (u, 0.0, v, 0.0)
            around = self.following[e], self.preceding[e]
            found.append(EdgeImage(start, center, radii[e], self.kinds[e], False, *around))
        return found

    # -- the two sides of chains -----------------------------------------------------------------------

    def twin(self, e: int) -> int:
        """The edge of a chain on its other side; an edge of the scene is its own."""
        if e < self.solids:
            return e
        count = self.forward - self.solids
        return e + count if e < self.forward else e - count

    def piece(self, e: int) -> ChainPiece:
        """The piece of a chain that is an edge of this number."""
        return self._pieces[e - self.solids]

    def way(self, e: int, point: Point) -> Vector:
        """The direction of travel on an edge of a chain at a point of it."""
        return raw(self.piece(e).direction(point))

    def edges_at(self, point: Point) -> tuple[int, ...]:
        """The edges of the scene, or forward edges, through a point.

        That a chain's own end lies on it is known: it may be a long number, for which a proof takes long.
        """
        for chain, (first, last) in zip(self.chains, self.ends, strict=True):
            if chain.opens[0] and self.curves[first].start is point:
                return (first,)
            if chain.opens[1] and self.curves[last].end is point:
                return (last,)
        return super().edges_at(point)

    def tip_at(self, edges: Sequence[int], point: Point) -> tuple[int, int] | None:
        """Both sides of the edge at the end of a chain, if a point, on these edges, is one to turn around."""
        if len(edges) != 1 or edges[0] < self.solids:
            return None
        (e,) = edges
        chain, (first, last) = self.chains[k := self.owners[e] - len(self.obstacles)], self.ends[k]
        at_start = e == first and chain.opens[0] and point == self.curves[e].start
        at_end = e == last and chain.opens[1] and point == self.curves[e].end
        return (e, self.twin(e)) if at_start or at_end else None

    def touches(self, e: int, start: Point, end: Point, is_on: tuple[bool, bool]) -> bool:
        """Whether a segment meets a forward edge of a chain strictly between its own ends.

        *is_on* says of its ends that they are known to lie on the edge's line or circle; if not, that is
        decided. An edge that it runs along counts only if it ends there.
        """
        curve, along = self.curves[e], end - start
        if isinstance(curve, Arc):
            on = [known or curve.on_circle(p) for known, p in zip(is_on, (start, end), strict=True)]
            return self._meets_arc(curve, start, along, on)
        whole = self.piece(e).edge
        assert isinstance(whole, Segment), "a part of a segment is one"
        sides = [
            0 if known else whole.direction.cross(p - whole.start).sign()
            for known, p in zip(is_on, (start, end), strict=True)
        ]
        if sides == [0, 0]:
            size = along.norm_sq()
            offsets = ((p - start).dot(along) for p in (curve.start, curve.end))
            return any(offset.sign() > 0 and offset.compare(size) < 0 for offset in offsets)
        if sides[0] * sides[1] >= 0:
            return False
        first, last = (along.cross(p - start).sign() for p in (curve.start, curve.end))
        return first * last <= 0

    @staticmethod
    def _meets_arc(arc: Arc, start: Point, along: Point, on: Sequence[bool]) -> bool:
        """Of an arc; of a segment that begins or ends on its circle the other crossing needs no root."""
        if all(on):
            return False
        if not any(on):
            found = line_contacts(start, along, arc)
        else:
            middle = (arc.center - start).dot(along) / along.norm_sq()
            other = 2 * middle - (0 if on[0] else 1)
            is_between = other.sign() > 0 and other.compare(1) < 0
            found = [other] if is_between and arc.contains(start + along * other) else []
        return any(Real(u).sign() > 0 and Real(u).compare(1) < 0 for u in found)


_MADE_LATE = ("tree", "images", "hulls", "circles", "_on_circles", "lattice", "line_numbers", "curve_images")
"""What a table makes when it is first asked for."""
