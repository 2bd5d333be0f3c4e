"""The views from a straight piece of the path through free space.

The scene's families of free lines and its single lines (`exactacq.sensing.complex_edges`) are intersected
with the piece. The normals of the piece itself and the views along its own line are added.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TypeAlias

from exactacq.cached import cached_property
from exactacq.geometry.curves import Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.late import Balls, Pin, balls, from_to, late_point
from exactacq.geometry.points import Point
from exactacq.kernel.extents import Extent
from exactacq.kernel.family_images import FamilyImage
from exactacq.kernel.single_lines import EdgeFamilies, SingleImage, extents_of_crossing_lines
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.sensing.line_family import SingleLine, family_of, single_of
from exactacq.sensing.line_points import Role
from exactacq.sensing.own_line import OwnLine
from exactacq.sensing.straight_way import StraightWay, View
from exactacq.sensing.view_families import ViewFamily
from exactacq.sensing.way_crossings import WayCrossings
from exactacq.sensing.way_normals import WayNormals
from exactacq.visibility.line_balls import crossing

PinOf: TypeAlias = "Callable[[Extent, bool], Pin | None]"
"""Tells where the first or the last line of a family meets a leg; None if only the family itself tells."""
Choose: TypeAlias = "Callable[[list[Extent], PinOf], Iterable[Extent]]"
"""Chooses those of families that matter (see `exactacq.sensing.family_filter`)."""


class WayViews:
    """The families at some edges from one straight way: a span of a rail in closed free space.

    *view* tells what is seen from an end of the way. Unless *every* normal is to count, those are left out
    that tell no more than tangents and the views from both ends do (see `kernel.normals`).
    """

    def __init__(self, way: StraightWay, wanted: frozenset[int], view: View, every: bool = True) -> None:
        self.wanted, self.way, self._every = wanted, way, every
        self.normals = WayNormals(self.way, wanted, view)
        self.own_line = OwnLine(self.way, wanted, view)

    @cached_property
    def _near(self) -> list[EdgeFamilies]:
        complex_, spots = self.way.complex, self.way.spots
        return complex_.near(spots) if self._every else complex_.telling(spots)

    @cached_property
    def crossing(self) -> WayCrossings:
        """The line families that may cross the way."""
        return WayCrossings(self.way, [edge.images for edge in self._near], self.wanted)

    def families(self, choose: Choose | None = None) -> Iterator[ViewFamily]:
        """All families at wanted edges whose first side lies on the way, or those that are chosen."""
        crossing = [] if choose is None else self.crossing.extents()
        found = self.single_lines()
        if self._every or self.way.complex.shows_along_normals(self.way.spots, self.wanted):
            found += self.normals.extents()
        if choose is None:
            for image, certain in self.crossing:
                yield from self.crossing.views(family_of(image), certain, self.wanted)
        else:
            found = [*choose([*crossing, *found], self._pin_of)]
        yield from self.views(found)
        yield from self.own_line.families()

    def _pin_of(self, one: Extent, is_last: bool) -> Pin | None:
        """Where the first or the last line of a family crosses the way."""
        return self.crossing.pin(one.origin, Role(one.here), is_last) if isinstance(one.origin, int) else None

    def single_lines(self) -> list[Extent]:
        """What the single lines that may cross the way show, in floats; they are the origins.

        Which of them pass the way's ends is known where families were asked for before.
        """
        groups, curves = [edge.whole_lines for edge in self._near], self.way.table.curve_images
        least = self.way.complex.images.reach[0]
        return extents_of_crossing_lines(groups, set(self.wanted), self.way.image, curves, least)

    def views(self, extents: Iterable[Extent]) -> Iterator[ViewFamily]:
        """The families that extents tell of."""
        # By families: the edges that they show, on which side of the contact they cross the way, and of which
        # sides all views are known to be in range.
        crossing, roles = dict[int, set[int]](), dict[int, Role | None]()
        near: dict[int, set[int]] = {}
        for one in extents:
            if isinstance(one.origin, SingleImage):
                yield from self.along(single_of(one.origin))
            elif isinstance(one.origin, FamilyImage):
                yield from self.normals.views(one.origin)
            elif isinstance(one.origin, int):
                crossing.setdefault(one.origin, set()).add(one.edge)
                if one.in_range:
                    near.setdefault(one.origin, set()).add(one.there)
                roles[one.origin] = Role(one.here) if one.is_known else None
        if crossing:
            families = list(self.crossing)
            for n, edges in crossing.items():
                image, certain = families[n]
                wanted, sides = frozenset(edges), near.get(n, ())
                yield from self.crossing.views(family_of(image), certain, wanted, roles[n], sides)

    def along(self, single: SingleLine) -> Iterator[ViewFamily]:
        """A single line that crosses the way between its place and the run that it shows."""
        near, far = single.points
        if single.edge is None and single.place == near:
            # What is shown is itself as far from what the line touches as the range.
            return
        # The run tells the line: in most scenes by rational numbers.
        tail, tip = (near, single.place) if near is far else (far, near)
        names: Sequence[int] = single.keys
        found = self._clearly_crossed(near, tail, tip, single.place)
        if found is None:
            found = self._known_crossed(names, near, from_to(balls(tail), balls(tip)), single.place)
        if found is None:
            back = tip - tail
            limit = _share(single.place, near, back)
            places = line_contacts(near, back, self.way.piece)
            # Lines along the way meet it in both ends.
            names = names if len(places) == 1 else ()
            found = [near + back * at for at in places if at.sign() >= 0 and at.compare(limit) <= 0]
        for point in found:
            pin = self._pin(names, point)
            for first, last in self.way.clipper.along(pin, single.run, single.shown):
                yield ViewFamily((self.way.number, single.shown), first, last)

    def _clearly_crossed(self, near: Point, tail: Point, tip: Point, place: Point) -> list[Point] | None:
        """Where the way is crossed between two places of a line, made late; None if balls leave that open.

        The line runs from *tail* to *tip*.
        """
        piece, (x, y), (dx, dy) = self.way.piece, balls(near), from_to(balls(tail), balls(tip))
        met = crossing((x, y, dx, dy), balls(piece.start), balls(piece.end))
        if not met:
            return met if met is None else []
        tau = met[0][0]
        spot = x + dx * tau, y + dy * tau
        ox, oy = from_to(spot, balls(place))
        after, before = ball_sign(tau), ball_sign(ox * dx + oy * dy)
        if not (after and before):
            return None
        return [late_point(spot, _met, near, tail, tip, piece)] if after > 0 and before > 0 else []

    def _known_crossed(
        self, names: Sequence[int], near: Point, along: Balls, place: Point
    ) -> list[Point] | None:
        """Where the way is crossed between two places of a line, if its names tell; None if that is open.

        A robot that has halted on the line sets out from there.
        """
        known = self._named(names)
        if known is None:
            return None
        (x, y), (u, v) = from_to(balls(near), balls(known[0])), from_to(balls(known[0]), balls(place))
        after, before = (ball_sign(a * along[0] + b * along[1]) for a, b in ((x, y), (u, v)))
        if not (after and before):
            return None
        return [known[0]] if after > 0 and before > 0 else []

    def _named(self, names: Sequence[int]) -> Pin | None:
        """Where a line is known to cross the way, by its names."""
        pins, number = self.way.clipper.views.pins, self.way.number
        return next((pin for name in names if (pin := pins.get((name, number, 0))) is not None), None)

    def _pin(self, names: Sequence[int], point: Point) -> Pin:
        """Where a line crosses the way: the same point as of families that its names tell of."""
        pins, number = self.way.clipper.views.pins, self.way.number
        pin = self._named(names) or (point, self.way.rail.parameter(point))
        for name in names:
            pins.put((name, number, 0), pin)
        return pin


def _met(near: Point, tail: Point, tip: Point, piece: Segment) -> Point:
    """Where a line that is known to cross a segment does so."""
    back = tip - tail
    (tau,) = line_contacts(near, back, piece)
    return near + back * tau


def _share(place: Point, start: Point, along: Point) -> Real:
    """How many times a vector leads from a start to a place on its line; late if the place is."""
    (x, y), (a, b), (u, v) = balls(place), balls(start), balls(along)
    return Real.late(((x - a) * u + (y - b) * v) / (u * u + v * v), _exact_share, place, start, along)


def _exact_share(place: Point, start: Point, along: Point) -> Real:
    """The number itself that a share is."""
    return (place - start).dot(along) / along.norm_sq()
