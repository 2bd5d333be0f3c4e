"""Names of lines: a line that is found from two features gets one name, so its points are made once.

A line that touches two features bounds a cell of each one's tangent family. Its points on the edges,
computed from either feature, are equal numbers in different forms, and with arcs their equality takes
long to prove. The name identifies the line: two vertices, a vertex and a circle with its side, or two
circles with the kind of common tangent. Every name has a sense: 1 if a sector runs along the line in the
direction of the name, else -1.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from typing import TypeAlias

from exactacq.geometry.coordinates import minus, raw
from exactacq.geometry.curves import Arc
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import Feature
from exactacq.visibility.line_balls import line
from exactacq.visibility.line_families import Sector
from exactacq.visibility.rotational_sweep import Passed

Names: TypeAlias = "tuple[tuple[Hashable, int], ...]"
"""Names of one line with their senses."""
BITS = 64
"""Precision of the parameter from which a line's direction is taken."""
Anchor: TypeAlias = "tuple[str, int]"
"""A corner, by the edge that starts there, or a circle, by the first arc on it."""


class Namer:
    """Names the tangent lines of a scene's features."""

    def __init__(self, table: EdgeTable) -> None:
        self.table = table

    def anchor(self, feature: Feature) -> Anchor:
        """The name of what a feature's lines touch."""
        if feature.round:
            return "circle", self.table.circles[feature.edges[0]]
        return "corner", feature.edges[1]

    def number(self, feature: Feature) -> int:
        """The number in that name."""
        return self.anchor(feature)[1]

    def names(self, feature: Feature, sector: Sector, t: Real, passed: Passed) -> Names:
        """The names of a feature's tangent line at *t*, from what it passes."""
        return tuple(
            self._round(feature, passed) if feature.round else self._corner(feature, sector, t, passed)
        )

    def _corner(
        self, feature: Feature, sector: Sector, t: Real, passed: Passed
    ) -> Iterator[tuple[Hashable, int]]:
        """A float is enough to tell ahead from behind.

        What is passed is a vertex on the line or a circle, whose centre lies to the right of the way from the
        corner to where the line touches it if *sign* is 1, else to the left. So of the products of the exact
        offset of vertex or centre with the line's direction, the larger one, along or across, is at least 0.7
        times the product of their lengths: its sign is beyond doubt. Only the one across remains where the
        corner lies on the circle.
        """
        own = feature.edges[1]
        _, _, *along_it = line(sector, t.ball(BITS))
        x, y = (float(v.mid()) for v in along_it)
        for number, side, sign in passed:
            curve = self.table.curves[number]
            place = raw(curve.center) if side and isinstance(curve, Arc) else self.table.vertices[number]
            px, py = (float(c) for c in minus(place, self.table.vertices[own]))
            along, across = px * x + py * y, x * py - y * px
            if abs(along) < abs(across):
                along = -sign * across
            ahead = 1 if along > 0 else -1
            if side:
                yield ("corner, circle", own, self.table.circles[number], sign > 0), ahead
            else:
                pair = min(own, number), max(own, number)
                yield ("corners", *pair), ahead if own < number else -ahead

    def _round(self, feature: Feature, passed: Passed) -> Iterator[tuple[Hashable, int]]:
        own = self.table.circles[feature.edges[0]]
        for number, side, sign in passed:
            # The contact's spoke is turned by *sign* from the direction to what is passed: 1 means behind.
            if side == 0:
                yield ("corner, circle", number, own, sign < 0), sign
                continue
            other = self.table.circles[number]
            if own != other:
                crossing, swapped = side > 0, own > other
                turn = sign if crossing or not swapped else -sign
                sense = -sign if not swapped else sign
                yield ("circles", min(own, other), max(own, other), crossing, turn), sense
