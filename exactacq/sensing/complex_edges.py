"""Edges of the visibility complex: families of free lines that touch one corner, arc or edge.

A family (a `LineFamily`) is a maximal set of neighbouring lines that all meet the same two edges, one behind
the contact and one ahead of it. It contains three families of views (a `FreeViews` each): from the edge
behind to the contact, from the contact to the edge ahead, and from the one edge to the other. Two kinds
of single lines are added. One runs along a straight edge and shows that edge end on. The other is
*pinched*: it touches obstacles on both sides and shows what no neighbouring line does.
"""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property, partial
from math import inf

from flint import arb, fmpq

from exactacq import kernel
from exactacq.geometry.coordinates import Vector, cross, dot, minus, raw
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.late import late_point
from exactacq.geometry.points import Point, distance_sq
from exactacq.kernel.extents import EVERYTHING, NOTHING, Extent, Span
from exactacq.kernel.family_images import NONE, FamilyImage
from exactacq.kernel.images import TURNING
from exactacq.kernel.lines import EPS
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.line_images import LineImages, curve_image
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.view_families import FamilyClipper, FreeViews, ViewFamily
from exactacq.visibility.chords import meet
from exactacq.visibility.features import Feature, features, leaving
from exactacq.visibility.free_segment import walk_line
from exactacq.visibility.line_balls import line
from exactacq.visibility.line_families import Sector, Sliding, Spokes, corner_sectors, quarters
from exactacq.visibility.line_names import Anchor, Namer, Names
from exactacq.visibility.pinched_lines import may_be_pinched
from exactacq.visibility.rotational_sweep import Cell, Passed, Pencil, pencil
from exactacq.visibility.sensor_range import Range


@dataclass(slots=True)
class LineFamily:
    """A cell of a pencil with what its lines meet; None where nothing is met within reach.

    Normals have nothing ``behind`` and do not go back: they start at the contact, which lies on an edge. So
    does the contact of a convex arc; a corner counts as the start of the edge that follows it. ``anchor``
    names what tangents touch, ``names`` the first and the last line (see `line_names`), ``passed`` what they
    pass; ``keys`` are numbers of these lines, equal only for equal lines.
    """

    sector: Sector
    low: Real
    high: Real
    behind: Side | None
    contact: Side
    ahead: Side | None
    goes_back: bool
    keys: tuple[list[int], list[int]]
    anchor: Anchor | None = None
    names: tuple[Names, Names] = ((), ())
    passed: tuple[Passed, Passed] = ((), ())
    _views: dict[tuple[int, int], list[ViewFamily]] = field(default_factory=dict)

    @property
    def sides(self) -> tuple[Side | None, Side, Side | None]:
        """What its lines meet or touch: behind, at the contact, ahead."""
        return self.behind, self.contact, self.ahead

    def image(self, images: LineImages) -> FamilyImage:
        """The family in floats."""
        ends = self.low, self.high
        return images.of(self.sector, ends, self.passed, self.sides, self.goes_back, self.keys)

    def views(self, here: int, there: int, clipper: FamilyClipper) -> tuple[list[ViewFamily], int]:
        """The views within range between two of its parts, and which of their two sides is *here*.

        They are made when they are first asked for.
        """
        pair = min(here, there), max(here, there)
        if pair not in self._views:
            self._views[pair] = clipper.families(self._free_views(*pair))
        return self._views[pair], int(here > there)

    def _free_views(self, first: int, last: int) -> FreeViews:
        one, other = self.sides[first + 1], self.sides[last + 1]
        assert one is not None and other is not None, "views lie between edges"
        anchor = self.anchor if self.goes_back else None
        return FreeViews(
            self.sector, self.low, self.high, (one, other), self.names, passed=self.passed, anchor=anchor
        )


@dataclass(slots=True)
class SingleLine:
    """A single line: from ``place`` it shows edge ``shown`` from one point of a run to the other.

    The place lies on edge ``edge``, with parameter ``u`` if known, or in free space within reach (None);
    what lies between sees the run too.
    """

    place: Point
    edge: int | None
    run: tuple[Point, Point]
    shown: int
    u: Real | None = None
    _views: list[ViewFamily] | None = None
    _image: FamilyImage | None = None

    @property
    def line(self) -> tuple[Point, Point]:
        """Two points of the line, of the scene's if possible."""
        return self.run if self.run[0] is not self.run[1] else (self.place, self.run[0])

    @property
    def image(self) -> FamilyImage:
        """The line in floats, as a family of one: by a point and a direction.

        The points are subtracted exactly and then rounded: the difference of their floats could be 0.
        """
        if self._image is None:
            self._image = self._imaged()
        return self._image

    def _imaged(self) -> FamilyImage:
        start, end = self.line
        way = curve_image(Segment(start, end))
        frame = TURNING, way.x, way.y, way.wx, way.wy, 0.0, 1
        at = 0.0, 4 * EPS, 0.0, 4 * EPS
        return FamilyImage(frame, at, (NONE, NONE, NONE), False, True, NONE, ([], []), ([], []))

    def extent(self, table: EdgeTable, here: int = 0) -> Extent:
        """What is shown at most, and from where: of the run from the place, or if *here* of the place."""
        run = _hull_on(table.curves[self.shown], self.run)
        edge, shown, source = self.shown, run, EVERYTHING
        if self.edge is not None:
            source = _hull_on(table.curves[self.edge], (self.place,))
            if here:
                edge, shown, source = self.edge, source, run
        is_known = not kernel.EXACT_ONLY
        return Extent(edge, shown, source, NOTHING, [], [], self, here, 1 - here, is_known)

    def views(self, here: int, there: int, clipper: FamilyClipper) -> tuple[list[ViewFamily], int]:
        """The views from the place, which lies on an edge, within range; and on which side of them is *here*.

        They are made when they are first asked for.
        """
        if self._views is None:
            assert self.edge is not None, "a place in free space is on no edge"
            u = clipper.rails[self.edge].parameter(self.place) if self.u is None else self.u
            ends = clipper.along((self.place, u), self.run, self.shown)
            self._views = [ViewFamily((self.edge, self.shown), *end) for end in ends]
        return self._views, here


class FeatureFamilies:
    """The line families and single lines of one feature, edge or corner."""

    def __init__(self, line_families: Iterable[LineFamily], single_lines: Iterable[SingleLine] = ()) -> None:
        self.line_families, self.single_lines = tuple(line_families), tuple(single_lines)
        self._images: list[FamilyImage] | None = None

    def images(self, images: LineImages) -> list[FamilyImage]:
        """The line families in floats."""
        if self._images is None:
            self._images = [line_family.image(images) for line_family in self.line_families]
        return self._images


class FamilySweeper:
    """Sweeps the families of one scene within one radius. It keeps none of them."""

    def __init__(self, table: EdgeTable, range_: Range) -> None:
        self.table, self.range = table, range_
        rails = [Rail(curve) for curve in table.curves]
        self.clipper = FamilyClipper(rails, range_, table.roundoff, table.circles)
        self._namer, self._keys = Namer(table), LineKeys()

    @cached_property
    def features(self) -> list[Feature]:
        """Convex corners and arcs."""
        return features(self.table)

    def normals(self, e: int) -> FeatureFamilies:
        """The normals of an edge."""
        return FeatureFamilies(self._normals(e))

    def tangents(self, k: int) -> FeatureFamilies:
        """The tangent lines of a feature, and the single lines that join them."""
        return FeatureFamilies(*self._tangents(self.features[k]))

    def corner_normals(self, k: int) -> FeatureFamilies:
        """The normals of the boundary at a feature that is a corner."""
        return FeatureFamilies(self._corner_normals(self.features[k]))

    # -- the families ------------------------------------------------------------------------------

    def _tangents(self, feature: Feature) -> tuple[list[LineFamily], list[SingleLine]]:
        """The tangent lines of a feature, and the single lines that join them."""
        contact = Side(feature.edges[-1], Role.CONTACT, fixed=not feature.round)
        sweeps = [pencil(self.table, s, feature.edges, self.range.above) for s in feature.sectors]
        line_families = [
            self._line_family(feature, s.sector, cell, contact) for s in sweeps for cell in s.cells
        ]
        single_lines = [
            single
            for s in sweeps
            for t, passed in s.pinches
            if may_be_pinched(self.table, feature, s.sector, t, passed)
            for single in self._pinched(s.sector, t, feature.edges)
        ]
        return line_families, [*single_lines, *self._end_on(feature, sweeps[0], sweeps[-1])]

    def _line_family(self, feature: Feature, sector: Sector, cell: Cell, contact: Side) -> LineFamily:
        behind = None if cell.behind is None else Side(cell.behind, Role.BEHIND)
        ahead = None if cell.ahead is None else Side(cell.ahead, Role.AHEAD)
        first, last = (
            self._namer.names(feature, sector, t, passed)
            for t, passed in zip((cell.low, cell.high), cell.bounds, strict=True)
        )
        anchor, names = self._namer.anchor(feature), (first, last)
        keys = self._keys.of(cell, names)
        return LineFamily(
            sector, cell.low, cell.high, behind, contact, ahead, True, keys, anchor, names, cell.bounds
        )

    def _normals(self, e: int) -> Iterator[LineFamily]:
        """The views along the normals of an edge."""
        for sector in normals(self.table.curves[e]):
            sweep = pencil(self.table, sector, (e,), self.range.above)
            yield from (self._outward(sector, cell, Side(e, Role.CONTACT)) for cell in sweep.cells)

    def _corner_normals(self, feature: Feature) -> Iterator[LineFamily]:
        """The views from a convex corner along the normals of the boundary there."""
        incoming, outgoing = feature.edges
        ax, ay = leaving(self.table.curves[incoming], at_end=True)
        bx, by = leaving(self.table.curves[outgoing], at_end=False)
        corner = Side(outgoing, Role.CONTACT, fixed=True)
        for sector in corner_sectors(feature.center, (ay, -ax), (by, -bx)):
            sweep = pencil(self.table, sector, feature.edges, self.range.above)
            anchor = self._namer.anchor(feature)
            yield from (self._outward(sector, cell, corner, anchor) for cell in sweep.cells)

    def _outward(self, sector: Sector, cell: Cell, start: Side, anchor: Anchor | None = None) -> LineFamily:
        ahead = None if cell.ahead is None else Side(cell.ahead, Role.AHEAD)
        keys = self._keys.of(cell, ((), ()))
        return LineFamily(
            sector, cell.low, cell.high, None, start, ahead, False, keys, anchor, passed=cell.bounds
        )

    # -- single lines ------------------------------------------------------------------------------

    def _end_on(self, feature: Feature, first: Pencil, last: Pencil) -> Iterator[SingleLine]:
        """The straight edges beside a feature as seen along their own lines, from where these first end."""
        incoming, outgoing = self._beside(feature)
        for e, sweep, cell, ahead in (
            (incoming, first, first.cells[0], True),
            (outgoing, last, last.cells[-1], False),
        ):
            edge, met = self.table.curves[e], cell.ahead if ahead else cell.behind
            if not isinstance(edge, Segment):
                continue
            t, passed = (cell.low, cell.bounds[0]) if ahead else (cell.high, cell.bounds[1])
            far = None
            if any(side or number not in (e, self.table.next[e]) for number, side, _ in passed):
                # The line grazes what may block its neighbours: it goes on by itself.
                walk = walk_line(self.table, sweep.sector, t, self.range.above)[ahead]
                far, met = (abs(walk.hits[-1][0]), walk.hits[-1][1]) if walk.blocked else (None, None)
            role = Role.AHEAD if ahead else Role.BEHIND
            place, u = self._reached(sweep.sector, t, role, met, far)
            run = (edge.end, edge.start) if ahead else (edge.start, edge.end)
            yield SingleLine(place, met, run, e, u)

    def _reached(
        self, sector: Sector, t: Real, role: Role, met: int | None, far: Real | None
    ) -> tuple[Point, Real | None]:
        """Where a line that touches a feature meets an edge, or is as long as the range if it meets none.

        *far* tells how far away it meets it, if that is known: it may run along the edge.
        """
        if far is not None:
            contact, direction = sector.touch(t)
            return contact + direction * (far * int(role)), None
        x, y, dx, dy = at = line(sector, t.ball(64))
        make = partial(self._reached_exactly, sector, t, role, met)
        if met is None:
            away = role * arb(self.range.radius) / (dx * dx + dy * dy).sqrt()
            return late_point((x + dx * away, y + dy * away), make), None
        hit = self.clipper.balls(met).met(at, role)
        place = make() if hit is None else late_point(hit[1], make)
        return place, self.clipper.rails[met].parameter(place)

    def _reached_exactly(self, sector: Sector, t: Real, role: Role, met: int | None) -> Point:
        contact, along = sector.touch(t)
        onward: Point = along * int(role)
        if met is None:
            far: Real = self.range.radius / onward.norm_sq().sqrt()
        else:
            far = meet(contact, onward, self.table.curves[met], 1)
        reached: Point = contact + onward * far
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
        runs: list[tuple[int, Point, Point]] = []
        for e in dict.fromkeys(e for _, e in met):
            points = [contact + direction * tau for tau, f in met if f == e]
            if isinstance(self.table.curves[e], Segment):
                runs.append((e, points[0], points[-1]))
            else:
                runs += [(e, point, point) for point in points]
        for e, start, end in runs:
            for f, low, high in runs:
                if e == f:
                    continue
                for place in (start, end) if start != end else (start,):
                    near, far = (low, high) if _nearer(place, low, high) else (high, low)
                    if place != near:
                        yield SingleLine(place, e, (near, far), f)
        step = direction * (self.range.radius / direction.norm_sq().sqrt())
        for walk, place in ((behind, contact - step), (ahead, contact + step)):
            if not walk.blocked:
                for f, low, high in runs:
                    near, far = (low, high) if _nearer(place, low, high) else (high, low)
                    if place != near:
                        yield SingleLine(place, None, (near, far), f)


class LineKeys:
    """Numbers for the lines that bound cells: one for each name, and one for each that has no name.

    Neighbouring cells share a bound without a name; their sweeps follow each other.
    """

    def __init__(self) -> None:
        self._of: dict[Hashable, int] = {}
        self._count = 0
        self._last: tuple[Real, int] | None = None

    def of(self, cell: Cell, names: tuple[Names, Names]) -> tuple[list[int], list[int]]:
        """The keys of the first and of the last line of a cell."""
        return self._numbers(cell.low, names[0]), self._numbers(cell.high, names[1])

    def _numbers(self, t: Real, names: Names) -> list[int]:
        if names:
            return [self._of.setdefault(name, len(self._of)) for name, _ in names]
        if self._last is None or self._last[0] is not t:
            self._count -= 1
            self._last = t, self._count
        return [self._last[1]]


def _hull_on(curve: Curve, points: Collection[Point]) -> Span:
    """Bounds of the parameters of some points of a curve, in extended numbers: finite ones are not told."""
    if isinstance(curve, Arc) and curve.full:
        return EVERYTHING
    known = {-inf for p in points if not p.is_late and p.rational == curve.start.rational}
    known |= {inf for p in points if not p.is_late and p.rational == curve.end.rational}
    return (min(known), max(known)) if len(known) == len(set(map(id, points))) else EVERYTHING


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
    return distance_sq(place, a).compare(distance_sq(place, b)) <= 0
