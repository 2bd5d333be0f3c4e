"""Graphs of a scene, as networkx has them.

The obstacle visibility graph joins obstacles that see each other. The tangent graph joins corners, contacts
and given points by free tangents and arcs. Runs need neither: so they do not load networkx.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cmp_to_key
from itertools import count, pairwise
from typing import NamedTuple, TypeAlias

import networkx as nx

from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.scene.scene import Scene
from exactacq.visibility.known_ground import Charted, Grounded, KnownGround
from exactacq.visibility.links import START, Link, Links, lexicographic
from exactacq.visibility.pegs import Peg
from exactacq.visibility.scene_tables import place_in
from exactacq.visibility.tangents import FreeTangent, Tangents

BITS = 64


def visibility_graph(scene: Scene, radius: object = None) -> nx.Graph:
    """The obstacle visibility graph: nodes are obstacle indices, and "S" if the scene has a start.

    The nodes sort, "S" first.

    An edge joins two nodes that see each other within *radius* (the scene's own if None). Its ``weight`` is
    v, the length of a shortest free segment between them (paper, section 3), as a `Length`; ``link`` is the
    `Link` with all shortest segments; ``leave``, on the link's source, and ``hit`` are the ends of the
    lexicographically least of them. Raises `InvalidScene` for a missing or illegal radius. Cost: near linear
    in the number of obstacles at constant density.

    >>> import exactacq as xa
    >>> graph = visibility_graph(xa.load("circles"))
    >>> [(i, j, str(v)) for i, j, v in graph.edges(data="weight")]
    [(0, 1, '2'), (0, 'S', '3')]
    >>> sorted(graph.nodes)
    ['S', 0, 1]
    """
    return graph_of(Links(scene, radius))


def graph_of(links: Links) -> nx.Graph:
    """The obstacle visibility graph of links, as `visibility_graph` gives it."""
    scene, graph = links.scene, nx.Graph()
    graph.add_nodes_from(range(links.count))
    for i in range(links.count):
        for j in links.neighbours(i):
            if j > i and (link := links.between(i, j)) is not None:
                _add_edge(graph, link)
    if scene.start is not None:
        graph.add_node(START)
        for link in links.from_point(scene.start).values():
            _add_edge(graph, link)
    return graph


def _add_edge(graph: nx.Graph, link: Link) -> None:
    leave, hit = min(link.segments(), key=cmp_to_key(lexicographic))
    graph.add_edge(link.source, link.target, weight=Length(link.length), leave=leave, hit=hit, link=link)


def tangent_graph(
    scene: Scene | Charted | Grounded | KnownGround, points: Iterable[object] = ()
) -> nx.MultiGraph:
    """The graph on which shortest paths lie: its edges are what a taut path may be made of.

    Nodes are numbers, the given *points* first, in their order; equal ones share the first of their numbers.
    A node has its exact ``point``, and its ``kind``: "place", "corner" (a convex one), "contact" (a tangent
    touches an arc there) or "joint" (where one convex arc goes on smoothly in another). Edges have their
    exact ``length``, ``curve``, ``kind`` and ``obstacle``:

    - "tangent": a free segment that touches no further corner or arc on its way; no obstacle;
    - "edge": such a segment along straight boundary;
    - "arc": a part of a convex arc between neighbouring nodes. Two nodes of a circle may be joined by two.

    Free space is closed: tangents may graze. If the scene has a terrain, what lies beyond its border is left
    out. On a map the ends of known parts are corners too, obstacles have the map's numbers, and corners and
    places in one point are two nodes if they lie on different sides of a wall. Distances between the given
    points, as by networkx's Dijkstra with ``weight="length"``, are those of `shortest_path`. Raises what
    that one raises. Cost: quadratic in the corners and arcs, times the edges near a segment; for few pairs
    `shortest_path` does far less.

    >>> import exactacq as xa, networkx as nx
    >>> graph = xa.tangent_graph(xa.Scene([xa.Circle((0, 0), 1)]), [(-2, 0), (2, 0)])
    >>> graph.number_of_nodes(), sorted(kind for _, _, kind in graph.edges(data="kind"))
    (6, ['arc', 'arc', 'arc', 'arc', 'tangent', 'tangent', 'tangent', 'tangent'])
    >>> print(nx.dijkstra_path_length(graph, 0, 1, weight="length"))
    pi/3 + 2*sqrt(3)
    """
    ground = KnownGround.of(scene)
    places = [place_in(ground.scene, f"point {k}", point) for k, point in enumerate(points)]
    return _GraphOfTangents(ground.tangents.with_places(places), ground.numbers).graph


class _GraphOfTangents:
    """A tangent graph in the making."""

    def __init__(self, tangents: Tangents, numbers: Sequence[int]) -> None:
        self.graph, self.tangents, self.numbers = nx.MultiGraph(), tangents, numbers
        self.pegs, self.table = tangents.pegs, tangents.table
        self.places: dict[int, Peg] = {}
        """The nodes of places."""
        self.node_of: dict[int, int] = {}
        """Nodes by the numbers of pegs."""
        self._contacts: dict[_End, int] = {}
        """Nodes by the ends of tangents that lie on arcs."""
        self._joints: dict[int, int] = {}
        self._straight: set[tuple[int, int]] = set()
        self._next = count(len(self.pegs.pegs) - self.pegs.own)
        self._add_places()
        self._add_corners()
        found = [(i, j, tangent) for i, j in self._pairs() if (tangent := tangents.between(i, j))]
        contacts: dict[int, list[tuple[_End, Point]]] = {}
        for n, (i, j, tangent) in enumerate(found):
            contacts.setdefault(i, []).append(((n, 0), tangent.start))
            contacts.setdefault(j, []).append(((n, 1), tangent.end))
        for peg in self.pegs.pegs:
            if peg.arc is not None:
                sides = (self.pegs.entry(peg, side) for side in (1, -1))
                self._add_arc(peg, peg.arc, [end for entry in sides for end in contacts.get(entry, ())])
        for n, (i, j, tangent) in enumerate(found):
            self._add_tangent(n, i, j, tangent)

    def _add_places(self) -> None:
        own = self.pegs.own
        for peg in self.pegs.pegs[own:]:
            node = self._place_at(peg.center)
            if node is None:
                node = peg.number - own
                self.places[node] = peg
                self.graph.add_node(node, point=peg.center, kind="place")
            self.node_of[peg.number] = node

    def _add_corners(self) -> None:
        for peg in self.pegs.pegs[: self.pegs.own]:
            if peg.arc is None:
                node = self._place_at(peg.center, peg.edges)
                self.node_of[peg.number] = self._node(peg.center, "corner") if node is None else node

    def _pairs(self) -> Iterator[tuple[int, int]]:
        """Each tangent that floats allow, in one of its two directions."""
        turned = self.pegs.turned
        for i in range(len(self.pegs.entries)):
            for j in self.tangents.beams(i).entries.tolist():
                if (i, j) <= (turned(j), turned(i)):
                    yield i, j

    def _place_at(self, point: Point, edges: Sequence[int] | None = None) -> int | None:
        """The node of the place that a point is, if there is one; on some edges, which know their side."""
        for node, place in self.places.items():
            if place.center == point and (edges is None or any(e in edges for e in place.edges)):
                return node
        return None

    def _node(self, point: Point, kind: str) -> int:
        node = next(self._next)
        self.graph.add_node(node, point=point, kind=kind)
        return node

    # -- arcs ----------------------------------------------------------------------------------------

    def _add_arc(self, peg: Peg, arc: Arc, contacts: list[tuple[_End, Point]]) -> None:
        """The nodes on an arc, and the parts of it between them."""
        rail, (e,) = Rail(arc), peg.edges
        spots: list[_ArcSpot] = [_ArcSpot(rail.parameter(point), point, end=end) for end, point in contacts]
        if peg.before is not None:
            spots.append(_ArcSpot(Real(0), arc.start, self._at_end(peg.before, peg.number, arc.start)))
        if peg.after is not None:
            spots.append(_ArcSpot(rail.top, arc.end, self._at_end(peg.after, peg.after, arc.end)))
        for place in self.pegs.pegs[self.pegs.own :]:
            if e in place.edges and arc.contains(place.center):
                u = rail.parameter(place.center)
                spots.append(_ArcSpot(u, place.center, self.node_of[place.number]))
        spots.sort(key=cmp_to_key(_by_parameter))
        row: list[tuple[int, Point]] = []
        for same in _groups(spots):
            nodes = [spot.node for spot in same if spot.node is not None]
            node = nodes[0] if nodes else self._node(same[0].point, "contact")
            self._contacts.update((spot.end, node) for spot in same if spot.end is not None)
            row.append((node, same[0].point))
        if arc.full and len(row) > 1:
            row.append(row[0])
        for (node, start), (following, end) in pairwise(row):
            piece = arc.part(start, end)
            self._add_edge(node, following, piece, piece.length, "arc", e)

    def _at_end(self, other: int, joint: int, end: Point) -> int:
        """The node at the end of an arc: of a corner, or of a joint, known by the arc that begins there."""
        if self.pegs.pegs[other].arc is None:
            return self.node_of[other]
        if joint not in self._joints:
            node = self._place_at(end, self.pegs.pegs[joint].edges)
            self._joints[joint] = self._node(end, "joint") if node is None else node
        return self._joints[joint]

    # -- tangents ------------------------------------------------------------------------------------

    def _add_tangent(self, n: int, i: int, j: int, tangent: FreeTangent) -> None:
        (one, _), (other, _) = self.pegs.entries[i], self.pegs.entries[j]
        a = self.node_of[one.number] if one.arc is None else self._contacts[n, 0]
        b = self.node_of[other.number] if other.arc is None else self._contacts[n, 1]
        key = min(a, b), max(a, b)
        curve = tangent.curve
        if (
            a == b
            or key in self._straight
            or any(self._passes(curve, i, node) for node in {*self.places} - {a, b})
        ):
            return
        self._straight.add(key)
        edge = self._edge_along(curve, one)
        self._add_edge(a, b, curve, Length(tangent.length), "tangent" if edge is None else "edge", edge)

    def _passes(self, curve: Segment, i: int, node: int) -> bool:
        """Whether a tangent from an entry passes a place, and not on the other side of a chain."""
        place, point = self.places[node], self.places[node].center
        if not curve.may_pass(point, BITS) or not curve.passes(point):
            return False
        if point in (curve.start, curve.end):
            # That end is a corner of a chain, and the place is on its other side.
            return False
        return self.tangents.between(i, self.pegs.entry(place, 0)) is not None

    def _edge_along(self, curve: Segment, peg: Peg) -> int | None:
        """The straight edge that a free segment from a peg begins along.

        It goes on along boundary then: where that turns away there is a corner or an arc, where it turns to
        the other side the segment would be blocked.
        """
        edges = peg.edges
        if peg.arc is not None:
            is_end = curve.start == peg.arc.start or curve.start == peg.arc.end
            edges = self.table.edges_at(curve.start) if is_end else ()
        for e in edges:
            edge = self.table.curves[e]
            if isinstance(edge, Segment) and edge.direction.cross(curve.direction).sign() == 0:
                far = edge.end if edge.direction.dot(curve.direction).sign() > 0 else edge.start
                if far != curve.start:
                    return e
        return None

    def _add_edge(self, a: int, b: int, curve: Curve, length: Length, kind: str, edge: int | None) -> None:
        obstacle = None if edge is None else self.numbers[self.table.owners[edge]]
        self.graph.add_edge(a, b, length=length, curve=curve, kind=kind, obstacle=obstacle)


_End: TypeAlias = tuple[int, int]
"""The number of a tangent, and 0 for its start or 1 for its end."""


class _ArcSpot(NamedTuple):
    """A point of an arc and its parameter, with its node if it has one, or the tangent's end that it is."""

    parameter: Real
    point: Point
    node: int | None = None
    end: _End | None = None


def _by_parameter(one: _ArcSpot, other: _ArcSpot) -> int:
    return one.parameter.compare(other.parameter)


def _groups(spots: list[_ArcSpot]) -> Iterator[list[_ArcSpot]]:
    """Spots, in order, by their places."""
    group: list[_ArcSpot] = []
    for spot in spots:
        if group and _by_parameter(group[0], spot):
            yield group
            group = []
        group.append(spot)
    if group:
        yield group
