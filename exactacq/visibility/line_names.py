"""Names of lines: a line that is found from two features gets one name, so its points are made once.

A line that touches two features bounds a cell of each one's tangent family. Its points on the edges,
computed from either feature, are equal numbers in different forms, and with arcs their equality takes
long to prove. The name identifies the line: its number (see `exactacq.kernel.line_keys`) and a sense, 1 if
a sector runs along the line from the first of the two features in the number to the second, else -1.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from exactacq.geometry.coordinates import dot, minus, raw
from exactacq.geometry.curves import Arc, Segment
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import Feature
from exactacq.visibility.line_balls import line
from exactacq.visibility.line_families import Sector
from exactacq.visibility.place_facts import names_by_circles
from exactacq.visibility.rotational_sweep import Passed

Names: TypeAlias = "tuple[tuple[int, int], ...]"
"""Numbers of one line with their senses."""
BITS = 64
"""Precision of the parameter from which a line's direction is taken."""


class Namer:
    """Names the tangent lines of a scene's features."""

    def __init__(self, table: EdgeTable) -> None:
        self.table, self.numbers = table, table.line_numbers

    def number(self, feature: Feature) -> int:
        """The number of what a feature's lines touch: a corner by the edge that starts there, or a circle."""
        return self.numbers.feature(feature.edges[-1], feature.round)

    def names(self, feature: Feature, sector: Sector, t: Real, passed: Passed) -> Names:
        """The names of a feature's tangent line at *t*, from what it passes."""
        keys = self.numbers.keys(self.number(feature), [*passed])
        senses = (
            self._from_circle(feature, passed)
            if feature.round
            else self._from_corner(feature.edges[1], sector, t, passed)
        )
        return tuple(zip(keys, senses, strict=True))

    def names_of_normal(self, e: int, sector: Sector, t: Real, passed: Passed) -> Names:
        """The names of a straight edge's normal at *t*, by two corners or by a circle and another feature.

        Where it passes an end of the edge it has them from other corners that it passes, and at a right angle
        from the edge beside.
        """
        circles = [self.numbers.feature(number, True) for number, side, _ in passed if side]
        names: Names = ()
        if circles:
            x, y, dx, dy = line(sector, t.ball(BITS))
            features = [*circles, *(number for number, side, _ in passed if side == 0)]
            names = tuple(names_by_circles(self.table, (x, y), (dx, dy), dict.fromkeys(features)))
        ends = e, self.table.following[e]
        own = next((number for number, side, _ in passed if side == 0 and number in ends), None)
        if own is None:
            return names
        corners = {number: None for number, side, _ in passed if side == 0 and number != own}
        beside = self.table.preceding[e] if own == e else own
        one, other = self.table.curves[e], self.table.curves[beside]
        assert isinstance(one, Segment), "arcs have their normals about the centre"
        if isinstance(other, Segment) and dot(raw(one.direction), raw(other.direction)) == 0:
            corners[beside if own == e else self.table.following[beside]] = None
        passed = tuple((number, 0, 0) for number in corners)
        keys = self.numbers.keys(own, [*passed])
        return (*zip(keys, self._from_corner(own, sector, t, passed), strict=True), *names)

    def _from_corner(self, own: int, sector: Sector, t: Real, passed: Passed) -> Iterator[int]:
        """A float is enough to tell ahead from behind.

        What is passed is a vertex on the line or a circle, whose centre lies to the right of the way from the
        corner to where the line touches it if *sign* is 1, else to the left. So of the products of the exact
        offset of vertex or centre with the line's direction, the larger one, along or across, is at least 0.7
        times the product of their lengths: its sign is beyond doubt. Only the one across remains where the
        corner lies on the circle.
        """
        _, _, *along_it = line(sector, t.ball(BITS))
        x, y = (float(v) for v in along_it)
        for number, side, sign in passed:
            curve = self.table.curves[number]
            place = raw(curve.center) if side and isinstance(curve, Arc) else self.table.vertices[number]
            px, py = (float(c) for c in minus(place, self.table.vertices[own]))
            along, across = px * x + py * y, x * py - y * px
            if abs(along) < abs(across):
                along = -sign * across
            ahead = 1 if along > 0 else -1
            yield ahead if side or own < number else -ahead

    def _from_circle(self, feature: Feature, passed: Passed) -> Iterator[int]:
        """The contact's spoke is turned by *sign* from the direction to what is passed: 1 means behind.

        Arcs of the same circle give no names.
        """
        own = self.table.circles[feature.edges[0]]
        for number, side, sign in passed:
            if side == 0:
                yield sign
            elif self.table.circles[number] != own:
                yield -sign if own < self.table.circles[number] else sign
