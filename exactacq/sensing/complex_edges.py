"""Edges of the visibility complex: families of free lines that touch one corner, arc or edge.

To the families of all pencils (see `exactacq.sensing.line_family`) two kinds of single lines are added. One
runs along a straight edge and shows that edge end on. The other is *pinched*: it touches obstacles on both
sides and shows what no neighbouring line does.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cached_property, partial
from typing import TypeAlias

from flint import arb, fmpq

from exactacq.geometry.coordinates import Vector, cross, dot, minus, raw
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.late import late_point
from exactacq.geometry.points import Point, distance_sq
from exactacq.kernel.bound_lines import BoundLine
from exactacq.kernel.extents import EVERYTHING
from exactacq.kernel.family_images import NONE, FamilyImage, by_edge
from exactacq.kernel.near_edges import NearEdges
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import CONVEX, EdgeTable
from exactacq.sensing.line_family import PencilFamilies, Reached, SingleLine
from exactacq.sensing.line_images import LineImages
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.view_families import FamilyClipper
from exactacq.visibility.chords import meet
from exactacq.visibility.features import Feature, features, leaving
from exactacq.visibility.free_segment import LineWalk, walk_line
from exactacq.visibility.line_balls import line
from exactacq.visibility.line_families import Sector, Sliding, Spokes, corner_sectors, quarters
from exactacq.visibility.line_names import Namer
from exactacq.visibility.pinched_lines import may_be_pinched
from exactacq.visibility.rotational_sweep import Pencil, swept
from exactacq.visibility.sensor_range import Range

NO_ENDS = (NONE, NONE)
Swept: TypeAlias = "tuple[Pencil, list[FamilyImage]]"
"""A pencil and the images of its families."""


class EdgeFamilies:
    """The line families of one edge, as float images, and the single lines.

    By edges, ``at`` has the families that meet or touch them, and ``lines_at`` the single lines from edge to
    edge that begin there or show them.
    """

    def __init__(self, images: list[FamilyImage], single_lines: list[SingleLine]) -> None:
        self.images, self.single_lines = images, single_lines
        self.at = by_edge(images)
        self.lines_at: dict[int, list[SingleLine]] = {}
        for single in single_lines:
            if single.edge is not None:
                for e in {single.edge, single.shown}:
                    self.lines_at.setdefault(e, []).append(single)


class FamilySweeper:
    """Sweeps the families of one scene within one radius. It keeps none of them."""

    def __init__(self, table: EdgeTable, range_: Range) -> None:
        self.table, self.range = table, range_
        rails = [Rail(curve) for curve in table.curves]
        self.clipper = FamilyClipper(rails, range_, table.roundoff, table.line_numbers)
        self.images = LineImages(table, range_)
        self._namer, self._numbers = Namer(table), table.line_numbers

    @cached_property
    def _features(self) -> dict[int, list[Feature]]:
        """Convex arcs, by their numbers, and corners, by the edges that start there."""
        found: dict[int, list[Feature]] = {}
        for feature in features(self.table):
            found.setdefault(feature.edges[-1], []).append(feature)
        return found

    def of(self, e: int) -> EdgeFamilies:
        """The normals of an edge, the tangents of the features at it, and the normals at its start.

        With the single lines that join the tangents. A corner belongs to the edge that starts there.
        """
        images: list[FamilyImage] = []
        single_lines: list[SingleLine] = []
        around = self._near(self.table.boxes[e].tolist())
        for sector in normals(self.table.curves[e]):
            ends = (e, int(self.table.next[e])) if isinstance(sector, Sliding) else NO_ENDS
            self._add(images, sector, around, (e,), Side(e, Role.CONTACT), None, ends, goes_back=False)
        for feature in self._features.get(e, ()):
            near = around if feature.round else self._near(self.table.curves[e].start.xy * 2)
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
            for s, _ in sweeps:
                for t, passed in s.pinches:
                    if may_be_pinched(self.table, feature, s.sector, t, passed):
                        single_lines += self._pinched(s.sector, t, feature.edges)
            single_lines += self._end_on(feature, sweeps[0], sweeps[-1])
            if not feature.round:
                for sector in self._corner_normals(feature):
                    self._add(images, sector, near, feature.edges, contact, feature, goes_back=False)
        return EdgeFamilies(images, single_lines)

    def _near(self, box: Sequence[float]) -> NearEdges:
        """The edges within reach of a box."""
        left, bottom, right, top = box
        edges = self.table.around((left, bottom), (right, top), self.range.above)
        return NearEdges(self.table.images, edges)

    def _corners_beside(self, feature: Feature) -> tuple[int, int]:
        """The other ends of the straight edges at a corner: its first and its last tangent pass them."""
        if feature.round:
            return NO_ENDS
        incoming, outgoing = feature.edges
        curves = self.table.curves
        first = incoming if isinstance(curves[incoming], Segment) else NONE
        return first, int(self.table.next[outgoing]) if isinstance(curves[outgoing], Segment) else NONE

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
        near: NearEdges,
        own: tuple[int, ...],
        contact: Side,
        feature: Feature | None,
        ends: tuple[int, int] = NO_ENDS,
        goes_back: bool = True,
    ) -> Swept:
        """Sweep a sector, of which the first and the last line pass vertices *ends*, and add its families."""
        at_start = isinstance(sector, Sliding) or (feature is not None and not feature.round)
        lines = swept(self.table, sector, own, near, ends=ends, vertex=contact.edge if at_start else NONE)
        families = PencilFamilies(lines, contact, self._namer, feature, goes_back)
        imaged = families.imaged(self.images, self._numbers)
        images += imaged
        return lines, imaged

    # -- single lines ------------------------------------------------------------------------------

    def _end_on(self, feature: Feature, first: Swept, last: Swept) -> Iterator[SingleLine]:
        """The straight edges beside a feature as seen along their own lines, from where these first end."""
        incoming, outgoing = self._beside(feature)
        for e, (sweep, images), role in ((incoming, first, Role.AHEAD), (outgoing, last, Role.BEHIND)):
            edge = self.table.curves[e]
            if not isinstance(edge, Segment):
                continue
            ahead = role is Role.AHEAD
            image = images[0] if ahead else images[-1]
            row = sweep.rows[image.number]
            bound = row.first if ahead else row.last
            run = (edge.end, edge.start) if ahead else (edge.start, edge.end)
            if any(side or number not in (e, self.table.next[e]) for number, side, _ in bound.passed):
                # The line grazes what may block its neighbours: it goes on by itself.
                yield SingleLine(*self._walked(sweep.sector, sweep.value(bound), role), run, e)
                continue
            met = image.edge(role) if image.edge(role) != NONE else None
            make = partial(self._reached, sweep, bound, role, met)
            low, high, *_ = image.places(role)[0 if ahead else 1]
            yield SingleLine(make, met, run, e, (low, high) if image.is_known else EVERYTHING)

    def _walked(self, sector: Sector, t: Real, role: Role) -> tuple[Reached, int | None]:
        """Where a line that may run along edges meets the first that blocks it, and that edge.

        If none does, a place in free space.
        """
        walk = walk_line(self.table, sector, t, self.range.above)[role is Role.AHEAD]
        if not walk.blocked:
            return (self._at_range(sector, t, role), None), None
        contact, direction = sector.touch(t)
        far, met = walk.hits[-1]
        return (contact + direction * (abs(far) * int(role)), None), met

    def _reached(self, sweep: Pencil, bound: BoundLine, role: Role, met: int | None) -> Reached:
        """Where a line that touches a feature meets an edge, or is as long as the range if it meets none."""
        sector, t = sweep.sector, sweep.value(bound)
        if met is None:
            return self._at_range(sector, t, role), None
        hit = self.clipper.balls(met).met(line(sector, t.ball(64)), role)
        make = partial(self._met, sector, t, role, met)
        place = make() if hit is None else late_point(hit[1], make)
        return place, self.clipper.rails[met].parameter(place)

    def _at_range(self, sector: Sector, t: Real, role: Role) -> Point:
        """The end of a line that is as long as the range."""
        x, y, dx, dy = line(sector, t.ball(64))
        away = role * arb(self.range.radius) / (dx * dx + dy * dy).sqrt()
        return late_point((x + dx * away, y + dy * away), partial(self._at_range_exactly, sector, t, role))

    def _at_range_exactly(self, sector: Sector, t: Real, role: Role) -> Point:
        contact, direction = sector.touch(t)
        reached: Point = contact + direction * (int(role) * self.range.radius / direction.norm_sq().sqrt())
        return reached

    def _met(self, sector: Sector, t: Real, role: Role, edge: int) -> Point:
        contact, direction = sector.touch(t)
        onward: Point = direction * int(role)
        reached: Point = contact + onward * meet(contact, onward, self.table.curves[edge], 1)
        return reached

    def _beside(self, feature: Feature) -> tuple[int, int]:
        """The edges into and out of a feature; an arc's neighbours only where they go on in its direction.

        Elsewhere they meet it at a corner of its own, and the arc stands for itself.
        """
        if not feature.round:
            return feature.edges[0], feature.edges[1]
        (e,) = feature.edges
        curves = self.table.curves
        before, after = int(self.table.previous[e]), int(self.table.next[e])
        ends = leaving(curves[before], at_end=True), leaving(curves[e], at_end=False)
        incoming = before if _continues(*ends) else e
        ends = leaving(curves[e], at_end=True), leaving(curves[after], at_end=False)
        return incoming, after if _continues(*ends) else e

    def _pinched(self, sector: Sector, t: Real, own: tuple[int, ...]) -> Iterator[SingleLine]:
        """What the touched points and edges of a line that grazes several features show of each other."""
        behind, ahead = walk_line(self.table, sector, t, self.range.above)
        contact, direction = sector.touch(t)
        met = [*reversed(behind.hits), (Real(0), own[-1]), *ahead.hits]
        others = self._touched_arcs(behind, ahead) - {own[-1]}
        runs: list[tuple[int, Point, Point]] = []
        for e in dict.fromkeys(e for _, e in met):
            points = [contact + direction * tau for tau, f in met if f == e]
            if isinstance(self.table.curves[e], Segment):
                runs.append((e, points[0], points[-1]))
            else:
                runs += [(e, point, point) for point in points]
        for e, start, end in runs:
            for f, low, high in runs:
                if e == f or f in others:
                    continue
                for place in (start, end) if start != end else (start,):
                    near, far = (low, high) if _nearer(place, low, high) else (high, low)
                    if place != near:
                        yield SingleLine((place, None), e, (near, far), f)
        step = direction * (self.range.radius / direction.norm_sq().sqrt())
        for walk, place in ((behind, contact - step), (ahead, contact + step)):
            if not walk.blocked:
                for f, low, high in runs:
                    if f in others:
                        continue
                    near, far = (low, high) if _nearer(place, low, high) else (high, low)
                    if place != near:
                        yield SingleLine((place, None), None, (near, far), f)

    def _touched_arcs(self, *walks: LineWalk) -> set[int]:
        """The convex arcs that a line touches once, between their ends: they tell who sees them along it."""
        met = [hit for walk in walks for hit in walk.hits]
        blocking = {walk.hits[-1][1] for walk in walks if walk.blocked and walk.hits}
        times = Counter(e for _, e in met)
        return {
            e
            for e, count in times.items()
            if count == 1 and e not in blocking and self.table.images.kind[e] == CONVEX
        }


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


def _continues(a: Vector, b: Vector) -> bool:
    return bool(cross(a, b) == 0 and dot(a, b) > 0)


def _nearer(place: Point, a: Point, b: Point) -> bool:
    return a is b or distance_sq(place, a).compare(distance_sq(place, b)) <= 0
