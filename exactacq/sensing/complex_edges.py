"""Edges of the visibility complex: families of free lines that touch one corner, arc or edge.

To the families of all pencils (see `exactacq.sensing.line_family`) two kinds of single lines are added. One
runs along a straight edge and shows that edge end on. The other is *pinched*: it touches obstacles on both
sides and shows what no neighbouring line does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TypeAlias

from flint import fmpq

from exactacq.cached import cached_property
from exactacq.geometry.coordinates import minus, raw, same_direction
from exactacq.geometry.curve_images import held_point
from exactacq.geometry.curve_parameter import ZERO, Rail
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.late import Pin
from exactacq.kernel.bound_lines import BoundLine
from exactacq.kernel.extents import EVERYTHING
from exactacq.kernel.family_images import ANYWHERE, NONE, EdgePlace, FamilyImage
from exactacq.kernel.line_keys import key_of_normal
from exactacq.kernel.shadows import Spot
from exactacq.kernel.single_lines import EdgeFamilies, SingleImage, place_beyond
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.family_clipper import FamilyClipper
from exactacq.sensing.followed_lines import FeatureLine, LineFollower
from exactacq.sensing.line_family import PencilFamilies, Reached, SingleLine, SingleLines
from exactacq.sensing.line_images import LineImages
from exactacq.sensing.line_points import Role, Side
from exactacq.visibility.end_rays import end_rays
from exactacq.visibility.features import Feature, corner_at, features, leaving
from exactacq.visibility.line_families import Sector, Sliding, Spokes, corner_sectors, quarters
from exactacq.visibility.line_names import Namer
from exactacq.visibility.pinched_lines import may_be_pinched
from exactacq.visibility.rotational_sweep import Pencil, swept
from exactacq.visibility.sensor_range import Range

NO_ENDS = (NONE, NONE)
Swept: TypeAlias = "tuple[Pencil, list[FamilyImage]]"
"""A pencil and the images of its families."""


class EndOnLine(SingleLines):
    """The line of a straight edge, which shows the edge end on from a place made on demand."""

    def __init__(self, make: Callable[[], Reached], run: tuple[Pin, Pin]) -> None:
        self._make, self._run = make, run
        self._made: SingleLine | None = None

    def single(self, image: SingleImage) -> SingleLine:
        """The line."""
        if self._made is None:
            self._made = SingleLine(self._make, self._run, image)
        return self._made


class FamilySweeper:
    """Sweeps the families of one scene within one radius. It keeps none of them."""

    def __init__(self, table: EdgeTable, range_: Range) -> None:
        self.table, self.range = table, range_
        rails = [Rail(curve) for curve in table.curves]
        self.clipper = FamilyClipper(rails, range_, table)
        self.images = LineImages(table, range_)
        self._namer, self._numbers = Namer(table), table.line_numbers
        self.follower = LineFollower(table, range_, self.clipper.views, self._namer, self.images)

    @cached_property
    def _features(self) -> dict[int, list[Feature]]:
        """Convex arcs, by their numbers, and corners, by the edges that start there."""
        found: dict[int, list[Feature]] = {}
        for feature in features(self.table):
            found.setdefault(feature.edges[-1], []).append(feature)
        return found

    def tangents(self, e: int) -> EdgeFamilies:
        """The tangents of the features at an edge, with the single lines that join them.

        A corner belongs to the edge that starts there.
        """
        images: list[FamilyImage] = []
        single_lines: list[SingleImage] = []
        for feature in self._features.get(e, ()):
            near = self._near_to(feature)
            contact = Side(e, Role.CONTACT, fixed=not feature.round)
            first, last = self._corners_beside(feature)
            sweeps = [
                self._add(
                    images,
                    s,
                    near,
                    feature.edges,
                    contact,
                    feature,
                    (first if k == 0 else NONE, last if k == len(feature.sectors) - 1 else NONE),
                )
                for k, s in enumerate(feature.sectors)
            ]
            followed, close = set[int](), frozenset(near)
            for s, _ in sweeps:
                for t, passed in s.pinches:
                    keys = self._numbers.keys(self._namer.number(feature), [*passed])
                    # Neighbouring sectors share a line.
                    if followed.isdisjoint(keys) and may_be_pinched(self.table, feature, s.sector, t, passed):
                        line = self.follower.follow(FeatureLine(feature, s.sector, t, passed), close)
                        single_lines += line.image.single_lines(keys, line)
                        followed.update(keys)
            single_lines += self._end_on(feature, sweeps[0], sweeps[-1], close)
        return EdgeFamilies(images, single_lines)

    def normals(self, e: int) -> EdgeFamilies:
        """The normals of an edge."""
        images: list[FamilyImage] = []
        near = self._near(self.table.spots(e))
        for sector in normals(self.table.curves[e]):
            ends = (e, self.table.following[e]) if isinstance(sector, Sliding) else NO_ENDS
            self._add(images, sector, near, (e,), Side(e, Role.CONTACT), None, ends, goes_back=False)
        return EdgeFamilies(images, [])

    def corner_normals(self, e: int) -> EdgeFamilies:
        """The normals of the boundary at a convex corner where an edge starts."""
        images: list[FamilyImage] = []
        for feature in self._features.get(e, ()):
            if not feature.round:
                near, contact = self._near_to(feature), Side(e, Role.CONTACT, fixed=True)
                for sector in self._corner_normals(feature):
                    self._add(images, sector, near, feature.edges, contact, feature, goes_back=False)
        return EdgeFamilies(images, [])

    def rays(self, e: int) -> EdgeFamilies:
        """The rays from the ends of an edge to where these are what is nearest of it (see `end_rays`)."""
        images: list[FamilyImage] = []
        for end in end_rays(self.table, e):
            vertex = end.own[1]
            near = self._near((self.table.curves[vertex].start.xy,))
            contact = Side(e, Role.CONTACT, fixed=True, at_end=vertex != e)
            corner = corner_at(self.table, end.own, (end.sector,))
            _, found = self._add(
                images, end.sector, near, end.own, contact, corner, end.passed, goes_back=False
            )
            # The normal of the edge there bounds them.
            keys = found[-1].last_keys if vertex == e else found[0].first_keys
            keys.append(key_of_normal(e, vertex, self._numbers.count))
        return EdgeFamilies(images, [])

    def _near(self, places: tuple[Spot, ...]) -> list[int]:
        """The edges that may be seen within reach of somewhere between some places."""
        return self.table.lit(places, self.range.above)

    def _near_to(self, feature: Feature) -> list[int]:
        """What may be seen from a feature; what only an edge at it sees would divide families further."""
        e = feature.edges[-1]
        return self._near(self.table.spots(e) if feature.round else (self.table.curves[e].start.xy,))

    def _corners_beside(self, feature: Feature) -> tuple[int, int]:
        """The other ends of the straight edges at a corner: its first and its last tangent pass them."""
        if feature.round:
            return NO_ENDS
        incoming, outgoing = feature.edges
        curves = self.table.curves
        first = incoming if isinstance(curves[incoming], Segment) else NONE
        return first, self.table.following[outgoing] if isinstance(curves[outgoing], Segment) else NONE

    def _corner_normals(self, feature: Feature) -> Iterator[Sector]:
        """The normals of the boundary at a convex corner."""
        incoming, outgoing = feature.edges
        ax, ay = leaving(self.table.curves[incoming], at_end=True)
        bx, by = leaving(self.table.curves[outgoing], at_end=False)
        return corner_sectors(feature.center, (ay, -ax), (by, -bx))

    def _add(
        self,
        images: list[FamilyImage],
        sector: Sector,
        near: list[int],
        own: tuple[int, ...],
        contact: Side,
        feature: Feature | None,
        ends: tuple[int, int] = NO_ENDS,
        goes_back: bool = True,
    ) -> Swept:
        """Sweep a sector, of which the first and the last line pass vertices *ends*, and add its families."""
        vertex = own[1] if contact.fixed else contact.edge if isinstance(sector, Sliding) else NONE
        lines = swept(self.table, sector, own, near, ends=ends, vertex=vertex, goes_back=goes_back)
        families = PencilFamilies(lines, contact, self._namer, feature, goes_back)
        imaged = families.imaged(self.images, self._numbers)
        images += imaged
        return lines, imaged

    # -- single lines ------------------------------------------------------------------------------

    def _end_on(
        self, feature: Feature, first: Swept, last: Swept, near: frozenset[int]
    ) -> Iterator[SingleImage]:
        """The straight edges beside a feature as seen along their own lines, from where these first end."""
        incoming, outgoing = self._beside(feature)
        for e, (sweep, images), role in ((incoming, first, Role.AHEAD), (outgoing, last, Role.BEHIND)):
            edge = self.table.curves[e]
            if not isinstance(edge, Segment):
                continue
            ahead = role is Role.AHEAD
            image = images[0] if ahead else images[-1]
            ends = (edge.start, ZERO), (edge.end, self.clipper.rails[e].top)
            run = (ends[1], ends[0]) if ahead else ends
            segment, spot = self.table.curve_images[e], held_point(run[0][0])
            met, place, make = self._end(feature, sweep, image, role, e, near)
            if met == NONE:
                place = *EVERYTHING, *place_beyond(spot, segment, int(role), self.images.reach)
            origin, spans = EndOnLine(make, run), (place[:2], EVERYTHING)
            keys = self._numbers.keys(self._namer.number(feature), [*_bound(sweep, image, role).passed])
            yield SingleImage((met, e), spans, place[2:], spot, segment, keys, origin, (0, 0, 0))

    def _end(
        self, feature: Feature, sweep: Pencil, image: FamilyImage, role: Role, e: int, near: frozenset[int]
    ) -> tuple[int, EdgePlace, Callable[[], Reached]]:
        """Where the line along edge *e* ends, the first ahead or the last behind: what it meets, if anything,
        where in floats, and what makes the place.
        """
        ahead = role is Role.AHEAD
        bound = _bound(sweep, image, role)
        if all(not side and number in (e, self.table.next[e]) for number, side, _ in bound.passed):
            met, place = image.edge(role), image.places(role)[0 if ahead else 1]
            make = partial(self._reached, feature, sweep, bound, role, met)
            return met, place if image.is_known else ANYWHERE, make
        # The line grazes what may block its neighbours: it goes on by itself.
        at = FeatureLine(feature, sweep.sector, sweep.value(bound), tuple(bound.passed))
        line = self.follower.follow(at, near)
        end = line.end(role)
        if end is None:
            return NONE, ANYWHERE, lambda: (line.ended(role), None)
        one = line.met[end]
        return one.edge, (*one.span, *one.spot), partial(line.pin, end)

    def _reached(self, feature: Feature, sweep: Pencil, bound: BoundLine, role: Role, met: int) -> Reached:
        """Where a line that touches a feature meets an edge, or is as long as the range if it meets none."""
        at = FeatureLine(feature, sweep.sector, sweep.value(bound), tuple(bound.passed))
        if met == NONE:
            return self.follower.at_range(at, role), None
        return self.follower.meeting(at, role, met)

    def _beside(self, feature: Feature) -> tuple[int, int]:
        """The edges into and out of a feature; an arc's neighbours only where they go on in its direction.

        Elsewhere they meet it at a corner of its own, and the arc stands for itself.
        """
        if not feature.round:
            return feature.edges[0], feature.edges[1]
        (e,) = feature.edges
        curves = self.table.curves
        before, after = self.table.preceding[e], self.table.following[e]
        ends = leaving(curves[before], at_end=True), leaving(curves[e], at_end=False)
        incoming = before if same_direction(*ends) else e
        ends = leaving(curves[e], at_end=True), leaving(curves[after], at_end=False)
        return incoming, after if same_direction(*ends) else e


def _bound(sweep: Pencil, image: FamilyImage, role: Role) -> BoundLine:
    """The first line of a family if its edge lies ahead, else the last one."""
    row = sweep.rows[image.number]
    return row.first if role is Role.AHEAD else row.last


def normals(curve: Curve) -> Iterator[Sector]:
    """The normals of a boundary edge on its free side."""
    start, end = raw(curve.start), raw(curve.end)
    if isinstance(curve, Segment):
        yield Sliding(start, minus(end, start), fmpq(0), fmpq(1), leftward=False)
        return
    center = raw(curve.center)
    first, last = minus(start, center), None if curve.full else minus(end, center)
    if not curve.ccw and last is not None:
        first, last = last, first
    for base, low, high in quarters(first, last):
        yield Spokes(center, base, low, high, radius_sq=curve.radius_sq, outward=curve.ccw)
