"""Pegs: the places where a taut path bends. Convex corners and arcs, and the places that it goes between.

A path that cannot be made shorter is a string drawn tight: straight but where it lies against a corner, a
circle of radius 0, or an arc. On a *side* of 1 the obstacle is to the left of the path, which turns left
there; on side -1 it is to the right. A peg with a side is an *entry*. Places, such as the ends of a path,
are pegs that stop nothing: their one entry has side 0.

A terrain is convex, so a way between two of its points leaves it along arcs only. An arc that crosses its
border counts as the arcs that are left of it.

A chain (`exactacq.visibility.known_chains`) is a polygon without area: its corners and arcs are pegs on that
side where they are convex, and its ends are corners of angle 0. There the two sides of a path share the
directions along the chain.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from math import hypot, inf
from typing import NamedTuple

import numpy as np

from exactacq.cached import cached_property
from exactacq.geometry.coordinates import Vector, cross, dot, raw, same_direction, sign
from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable, Floats, Ints
from exactacq.scene.shapes import Terrain
from exactacq.scene.terrain_components import pieces_within
from exactacq.visibility.chain_table import ChainTable
from exactacq.visibility.features import (
    Feature,
    directions_at,
    enters,
    features,
    is_spike,
    leaving,
)

ZERO = Real(0)


@dataclass(eq=False)
class Peg:
    """A corner with its tangent range, an arc that has its obstacle on the left, or a place without either.

    ``before`` and ``after`` are the numbers of the pegs at the ends of an arc, to which a walk along it goes
    on: a corner, or the next arc where the joint is smooth. ``edges`` pass through all contacts.
    """

    number: int
    center: Point
    edges: tuple[int, ...]
    arc: Arc | None = None
    range: tuple[Point, Point] | None = None
    before: int | None = None
    after: int | None = None
    owns_start: bool = True
    is_tip: bool = False

    @property
    def is_place(self) -> bool:
        """Whether a path may pass it in any direction."""
        return self.arc is None and self.range is None

    @cached_property
    def radius(self) -> Real:
        """0 for a corner and a place."""
        return ZERO if self.arc is None else self.arc.radius

    def owns(self, point: Point) -> bool:
        """Whether lines that touch the circle at a point touch this arc: of a point of the circle.

        The end of an arc belongs to the corner there, or to the arc that goes on.
        """
        arc = self.arc
        assert arc is not None, "only arcs have circles"
        if arc.full:
            return True
        if point == arc.start:
            return self.owns_start
        return self.after is None if point == arc.end else arc.contains(point)


class EntryRows(NamedTuple):
    """All entries in floats, a row each: centres, and radii times the side, are the nearest floats.

    Of corners ``ranges`` has the first and the last direction, on side -1 those opposite to the boundary's;
    of arcs ``spokes`` has the direction from the centre to the start. These are unit vectors, and zeros of
    other pegs. ``angles`` are those of arcs, infinite of full circles and of other pegs.
    """

    numbers: Ints
    centers: Floats
    rhos: Floats
    ranges: Floats
    spokes: Floats
    angles: Floats

    @classmethod
    def of(cls, entries: Sequence[tuple[Peg, int]]) -> EntryRows:
        """The rows of some entries."""
        made = [_row(peg, side) for peg, side in entries]
        numbers = np.array([peg.number for peg, _ in entries], dtype=np.intp)
        rows = np.array(made, dtype=float).reshape(-1, 10)
        return cls(numbers, rows[:, :2], rows[:, 2], rows[:, 3:7], rows[:, 7:9], rows[:, 9])

    def some(self, chosen: Ints | slice) -> EntryRows:
        """The rows of some entries."""
        return EntryRows(
            self.numbers[chosen],
            self.centers[chosen],
            self.rhos[chosen],
            self.ranges[chosen],
            self.spokes[chosen],
            self.angles[chosen],
        )


def _row(peg: Peg, side: int) -> list[float]:
    row = [*peg.center.xy, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inf]
    if peg.range is not None:
        row[3:7] = [side * c for vector in peg.range for c in _unit(vector)]
    if peg.arc is not None:
        row[2] = side * float(peg.radius)
        row[7:9] = _unit(peg.arc.start - peg.arc.center)
        if not peg.arc.full:
            row[9] = float(peg.arc.length) / float(peg.radius)
    return row


def _unit(vector: Point) -> tuple[float, float]:
    x, y = vector.xy
    size = hypot(x, y)
    return x / size, y / size


class Pegs:
    """The corners and arcs of a scene and chains, and maybe places: their numbers and entries come last."""

    def __init__(self, table: EdgeTable, terrain: Terrain | None) -> None:
        self.table = table
        self.pegs: list[Peg] = []
        self.at_vertex: dict[int, Peg] = {}
        self.on_edge: dict[int, list[Peg]] = {}
        for feature in features(table.solid if isinstance(table, ChainTable) else table):
            if feature.round:
                self._add_arcs(feature.edges[0], terrain)
            elif is_within(Point(*feature.center), terrain):
                self._add_corner(feature)
        if isinstance(table, ChainTable):
            for e in range(table.solids, len(table.curves)):
                self._add_of_chain(table, e)
        for peg in self.pegs:
            if peg.arc is not None and not peg.arc.full:
                self._join(peg, peg.arc)
        self.own = len(self.pegs)
        """How many pegs are the scene's own."""
        self.entries = [(peg, side) for peg in self.pegs for side in (1, -1)]
        self.rows = EntryRows.of(self.entries)

    def with_places(self, places: Sequence[Point]) -> Pegs:
        """These pegs and those of some places."""
        pegs = copy(self)
        added = [self._place(self.own + k, place) for k, place in enumerate(places)]
        pegs.pegs = self.pegs + added
        pegs.entries = self.entries + [(peg, 0) for peg in added]
        rows = zip(self.rows, EntryRows.of(pegs.entries[2 * self.own :]), strict=True)
        pegs.rows = EntryRows(*(np.concatenate(pair) for pair in rows))
        return pegs

    def _place(self, number: int, place: Point) -> Peg:
        edges = self.table.edges_at(place)
        tip = self.table.tip_at(edges, place) if isinstance(self.table, ChainTable) else None
        return Peg(number, place, edges if tip is None else tip, is_tip=tip is not None)

    def _add_corner(self, feature: Feature) -> None:
        incoming, outgoing = feature.edges
        curves = self.table.curves
        first, last = leaving(curves[incoming], at_end=True), leaving(curves[outgoing], at_end=False)
        turns = Point(*first), Point(*last)
        peg = Peg(len(self.pegs), Point(*feature.center), feature.edges, range=turns)
        self.at_vertex[outgoing] = peg
        self.pegs.append(peg)

    def _add_of_chain(self, table: ChainTable, e: int) -> None:
        """The arc that an edge of a chain is on its side, and the corner at its end."""
        curve, following = table.curves[e], table.following[e]
        if isinstance(curve, Arc) and curve.ccw:
            peg = Peg(len(self.pegs), curve.center, (e,), arc=curve)
            self.on_edge[e] = [peg]
            self.pegs.append(peg)
        is_end, first = following == table.twin(e), table.way(e, curve.end)
        last = table.way(following, curve.end)
        if is_end:
            is_peg = table.tip_at((min(e, following),), curve.end) is not None
        else:
            turn = sign(cross(first, last))
            is_peg = turn > 0
            if turn == 0 and sign(dot(first, last)) < 0:
                is_peg = is_spike(curve, table.curves[following])
        if is_peg:
            peg = Peg(len(self.pegs), curve.end, (e, following), range=(Point(*first), Point(*last)))
            peg.is_tip = is_end
            self.at_vertex[following] = peg
            self.pegs.append(peg)

    def _add_arcs(self, e: int, terrain: Terrain | None) -> None:
        curve = self.table.curves[e]
        parts = [curve]
        if terrain is not None:
            parts = [part.curve for part in pieces_within(e, curve, terrain) if part is not None]
        for part in parts:
            assert isinstance(part, Arc), "what is round is an arc"
            peg = Peg(len(self.pegs), part.center, (e,), arc=part)
            self.on_edge.setdefault(e, []).append(peg)
            self.pegs.append(peg)

    def _join(self, peg: Peg, arc: Arc) -> None:
        """Find what a walk along an arc goes on to."""
        (e,), curves = peg.edges, self.table.curves
        following = self.table.following[e]
        if arc.start is curves[e].start and e in self.at_vertex:
            peg.before, peg.owns_start = self.at_vertex[e].number, False
        if arc.end is not curves[e].end:
            return
        if following in self.at_vertex:
            peg.after = self.at_vertex[following].number
        elif same_direction(self._leaving(e, at_end=True), self._leaving(following, at_end=False)):
            for other in self.on_edge.get(following, ()):
                if other.arc and other.arc.start is curves[following].start:
                    peg.after, other.before = other.number, peg.number

    def _leaving(self, e: int, at_end: bool) -> Vector:
        """Direction of travel at one end of an edge."""
        curve, table = self.table.curves[e], self.table
        if isinstance(table, ChainTable) and e >= table.solids:
            return table.way(e, curve.end if at_end else curve.start)
        return leaving(curve, at_end)

    def entry(self, peg: Peg, side: int) -> int:
        """The number of an entry."""
        return self.own + peg.number if peg.is_place else 2 * peg.number + (side < 0)

    def turned(self, entry: int) -> int:
        """The number of the entry of the same peg on the other side."""
        return entry if entry >= 2 * self.own else entry ^ 1

    @cached_property
    def is_curved(self) -> bool:
        """Whether there are arcs."""
        return bool(self.on_edge)

    @property
    def largest(self) -> float:
        """The largest coordinate or radius."""
        centers, rhos = (np.abs(values).max(initial=1e-200) for values in (self.rows.centers, self.rows.rhos))
        return max(self.table.magnitude, float(centers), float(rhos))

    def rim(self, peg: Peg, contact: Point) -> tuple[int, ...]:
        """The edges through a contact, on the peg's side of a chain; none inside an arc."""
        if peg.arc is None:
            return peg.edges
        at_start = contact == peg.arc.start
        if not at_start and contact != peg.arc.end:
            return ()
        (e,), table = peg.edges, self.table
        if isinstance(table, ChainTable) and e >= table.solids:
            return (table.preceding[e], e) if at_start else (e, table.following[e])
        return table.edges_at(contact)

    def may_leave(self, entry: int, contact: Point, along: Point) -> bool:
        """Whether a ray from a contact in a tangent direction does not lead straight into the obstacle."""
        peg, _ = self.entries[entry]
        own, table = self.rim(peg, contact), self.table
        if not own or peg.is_tip:
            return True
        incoming, outgoing = (table.curves[e] for e in (own[0], own[-1]))
        if isinstance(table, ChainTable) and own[0] >= table.solids:
            ways = [table.way(e, contact) for e in own]
        else:
            ways = list(directions_at(table, contact, own))
        return not enters(incoming, outgoing, ways[0], ways[-1], raw(along))


def is_within(point: Point, terrain: Terrain | None) -> bool:
    """Whether a point lies in a terrain or on its border, if there is one."""
    if terrain is None:
        return True
    west, south, east, north = terrain.limits
    spans = (point.x, west, east), (point.y, south, north)
    return all(c.compare(low) >= 0 >= c.compare(high) for c, low, high in spans)
