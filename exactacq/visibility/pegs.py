"""Pegs: the places where a taut path bends. Convex corners and arcs, and the places that it goes between.

A path that cannot be made shorter is a string drawn tight: straight but where it lies against a corner, a
circle of radius 0, or an arc. On a *side* of 1 the obstacle is to the left of the path, which turns left
there; on side -1 it is to the right. A peg with a side is an *entry*. Places, such as the ends of a path,
are pegs that stop nothing: their one entry has side 0.

A terrain is convex, so a way between two of its points leaves it along arcs only. An arc that crosses its
border counts as the arcs that are left of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from math import hypot, inf
from typing import NamedTuple

import numpy as np

from exactacq.geometry.coordinates import raw
from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable, Floats, Ints
from exactacq.scene.shapes import Terrain
from exactacq.scene.terrain_components import pieces_within
from exactacq.visibility.features import Feature, directions_at, enters, features, leaving, parallel

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
    """The corners and arcs of a scene, and maybe places: their numbers and entries come last."""

    def __init__(self, table: EdgeTable, terrain: Terrain | None) -> None:
        self.table = table
        self.pegs: list[Peg] = []
        self.at_vertex: dict[int, Peg] = {}
        self.on_edge: dict[int, list[Peg]] = {}
        for feature in features(table):
            if feature.round:
                self._add_arcs(feature.edges[0], terrain)
            elif is_within(Point(*feature.center), terrain):
                self._add_corner(feature)
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
        added = [Peg(self.own + k, place, self.table.edges_at(place)) for k, place in enumerate(places)]
        pegs.pegs = self.pegs + added
        pegs.entries = self.entries + [(peg, 0) for peg in added]
        rows = zip(self.rows, EntryRows.of(pegs.entries[2 * self.own :]), strict=True)
        pegs.rows = EntryRows(*(np.concatenate(pair) for pair in rows))
        return pegs

    def _add_corner(self, feature: Feature) -> None:
        incoming, outgoing = feature.edges
        curves = self.table.curves
        first, last = leaving(curves[incoming], at_end=True), leaving(curves[outgoing], at_end=False)
        turns = Point(*first), Point(*last)
        peg = Peg(len(self.pegs), Point(*feature.center), feature.edges, range=turns)
        self.at_vertex[outgoing] = peg
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
        following = int(self.table.next[e])
        if arc.start is curves[e].start and e in self.at_vertex:
            peg.before, peg.owns_start = self.at_vertex[e].number, False
        if arc.end is not curves[e].end:
            return
        if following in self.at_vertex:
            peg.after = self.at_vertex[following].number
        elif parallel(leaving(curves[e], at_end=True), leaving(curves[following], at_end=False)):
            for other in self.on_edge.get(following, ()):
                if other.arc and other.arc.start is curves[following].start:
                    peg.after, other.before = other.number, peg.number

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

    def may_leave(self, entry: int, contact: Point, along: Point) -> bool:
        """Whether a ray from a contact in a tangent direction does not lead straight into the obstacle."""
        peg, _ = self.entries[entry]
        own = peg.edges
        if peg.arc is not None:
            if contact != peg.arc.start and contact != peg.arc.end:
                return True
            own = self.table.edges_at(contact)
        if not own:
            return True
        incoming, outgoing = (self.table.curves[e] for e in (own[0], own[-1]))
        ways = list(directions_at(self.table, contact, own))
        return not enters(incoming, outgoing, ways[0], ways[-1], raw(along))


def is_within(point: Point, terrain: Terrain | None) -> bool:
    """Whether a point lies in a terrain or on its border, if there is one."""
    if terrain is None:
        return True
    west, south, east, north = terrain.limits
    spans = (point.x, west, east), (point.y, south, north)
    return all(c.compare(low) >= 0 >= c.compare(high) for c, low, high in spans)
