"""The views from a straight piece of the path through free space.

The scene's families of free lines (`exactacq.sensing.complex_edges`) are intersected with the piece.
Where a line crosses it, the robot sees along the line in both directions: past the contact, to the
contact, or, on the normal of an edge, to the foot. A family is divided at the lines through the two ends
of the piece; each part then crosses the piece in all its lines or in none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cached_property, cmp_to_key
from itertools import pairwise
from math import hypot, inf
from typing import Any, TypeAlias

import numpy as np
from flint import fmpq

from exactacq import kernel
from exactacq.geometry.box_index import box
from exactacq.geometry.coordinates import dot, minus, raw
from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.interval_union import Cover
from exactacq.geometry.late import Pin
from exactacq.geometry.points import Point
from exactacq.kernel.bounded import TINY, UNIT
from exactacq.kernel.cells import LineCells
from exactacq.kernel.extents import EVERYTHING, Extent
from exactacq.kernel.family_images import NONE, FamilyImage
from exactacq.kernel.lines import Meeting, meets_straight
from exactacq.kernel.ways import Crossing, WayImage, crossings, extents_from_way
from exactacq.numbers.between import rational_between
from exactacq.numbers.float_bounds import rough
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.complex_edges import EdgeFamilies
from exactacq.sensing.end_names import Seen
from exactacq.sensing.legs import Leg
from exactacq.sensing.line_family import LineFamily, SingleLine, family_of
from exactacq.sensing.line_images import bounds
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.view_families import End, FreeViews, ViewFamily
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.visibility.chords import meet
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes
from exactacq.visibility.line_names import Names
from exactacq.visibility.rotational_sweep import Pencil, pencil

Cut: TypeAlias = "tuple[Real, Pin | None, Names]"
"""A parameter where a line family is cut, the point of the way there, and the names of the line."""
Choose: TypeAlias = "Callable[[list[Extent]], Iterable[Extent]]"
"""Chooses those of families that matter (see `exactacq.sensing.family_filter`)."""

BITS = 256
"""Precision of the balls that propose ties."""


class WayViews:
    """The families at some edges from one straight way: a span of a rail in closed free space.

    *view* tells what is seen from an end of the way.
    """

    def __init__(
        self,
        complex_: VisibilityComplex,
        leg: Leg,
        wanted: frozenset[int],
        view: Callable[[Point, None], Seen],
    ) -> None:
        self.complex, self.span, self.wanted, self.view = complex_, leg.span, wanted, view
        self.touches: frozenset[Any] = frozenset(leg.touches)
        self.rail = rail = leg.rail
        self.piece = Segment(leg.span.start, leg.span.end)
        self.line = rail.curve
        self.places = [(rough(p.x), rough(p.y)) for p in (leg.span.start, leg.span.end)]
        self.clipper = complex_.clipper.with_way(rail, leg.touches)
        self.way = len(self.clipper.rails) - 1
        self.slack = 256 * self.clipper.roundoff
        self._through: dict[int, tuple[Sector, list[tuple[Pin, list[Real]]]]] = {}

    def families(self, choose: Choose | None = None) -> Iterator[ViewFamily]:
        """All families at wanted edges whose first side lies on the way, or those that are chosen."""
        single_lines = self._single_lines()
        if choose is None:
            wanted = dict.fromkeys(range(len(self._found)), self.wanted)
        else:
            wanted, single_lines = self._chosen(single_lines, choose)
        for n, edges in wanted.items():
            k, certain = self._found[n]
            yield from self.across(family_of(self._families[k]), certain, edges)
        for single in single_lines:
            yield from self._along(single)
        yield from self._normals()
        yield from self._own_line()

    def _chosen(
        self, single_lines: list[SingleLine], choose: Choose
    ) -> tuple[dict[int, frozenset[int]], list[SingleLine]]:
        """The line families that matter, by number with the edges for which they do, and single lines."""
        extents = [*self.extents(), *map(self._extent, single_lines)]
        lines: list[SingleLine] = []
        wanted: dict[int, frozenset[int]] = {}
        for one in choose(extents):
            if isinstance(one.origin, SingleLine):
                lines.append(one.origin)
            elif isinstance(one.origin, int):
                wanted[one.origin] = wanted.get(one.origin, frozenset()) | {one.edge}
        return wanted, lines

    @property
    def crossing(self) -> list[tuple[FamilyImage, bool]]:
        """The line families that may cross the way, and whether all their lines do."""
        return [(self._families[k], certain) for k, certain in self._found]

    def extents(self) -> list[Extent]:
        """What the line families in `crossing` show, in floats; the origins are their places there."""
        curves, reach = self.complex.table.curve_images, self.complex.images.reach
        return extents_from_way(self._families, self._found, set(self.wanted), self._image, curves, reach)

    @property
    def single_lines(self) -> list[tuple[SingleLine, Meeting]]:
        """The single lines that may cross the way, and where they meet its line, in floats."""
        line = self._image.line
        return [(single, meets_straight(single.image.first, line)) for single in self._single_lines()]

    def single_views(self, single: SingleLine | None) -> list[ViewFamily]:
        """The views along a single line from the way, or along the way itself if None."""
        return [*(self._own_line() if single is None else self._along(single))]

    @cached_property
    def _near(self) -> list[EdgeFamilies]:
        x, y, right, top = box(self.piece)
        return self.complex.near(np.array((x, y, right, top)))

    @cached_property
    def _families(self) -> list[FamilyImage]:
        return [image for edge in self._near for image in edge.images]

    @cached_property
    def _found(self) -> list[Crossing]:
        return crossings(self._families, set(self.wanted), self._image)

    @cached_property
    def _image(self) -> WayImage:
        (ax, ay), (bx, by) = self.places
        error = inf if kernel.EXACT_ONLY else UNIT * (abs(ax) + abs(ay) + abs(bx) + abs(by)) + TINY
        starts, stops = (self._vertices_at(end) for end in (self.span.start, self.span.end))
        low, high = bounds(self.span.low, None), bounds(self.span.high, None)
        return WayImage(curve_image(self.line), low, high, (ax, ay, bx, by, error), starts, stops)

    def _vertices_at(self, point: Point) -> list[int]:
        """The vertices at a point."""
        if point.rational is None:
            return []
        x, y = point.xy
        table = self.complex.table
        near = table.near((x, y), (x, y), 0.0).tolist()
        numbers = {number for e in near for number in (e, int(table.next[e]))}
        return [number for number in numbers if table.vertices[number] == point.rational]

    def _single_lines(self) -> list[SingleLine]:
        """The single lines that may cross the way and show something that is wanted."""
        lines = [line for edge in self._near for line in edge.single_lines if line.shown in self.wanted]
        return [lines[k] for k, _ in crossings([line.image for line in lines], {NONE}, self._image)]

    def _extent(self, single: SingleLine) -> Extent:
        """What a single line shows at most, and where it crosses the way."""
        one = single.extent(self.complex.images)
        _, _, u, error, *_ = meets_straight(single.image.first, self._image.line)
        one.source = (u - error, u + error) if error < inf else EVERYTHING
        return one

    def across(self, line_family: LineFamily, certain: bool, wanted: frozenset[int]) -> Iterator[ViewFamily]:
        """Views along the lines of a family; *certain* if each line passes between the ends of the way."""
        if not any(side is not None and side.edge in wanted for side in line_family.sides):
            return
        if not line_family.sector.round and line_family.anchor in self.touches:
            # Every line through a corner that the way touches crosses it there and shows nothing else.
            return
        cuts: list[Cut] = [
            (line_family.low, None, line_family.names[0]),
            (line_family.high, None, line_family.names[1]),
        ]
        if not certain:
            cuts = self._cuts(line_family)
        for (low, first, called), (high, last, named) in pairwise(cuts):
            role = self._role(line_family, rational_between(low, high), wanted)
            if role is None:
                continue
            here = Side(self.way, role)
            for other in self._shown(line_family, role, wanted):
                names, pins = (called, named), (first, last)
                passed = (
                    line_family.passed[0] if low is line_family.low else (),
                    line_family.passed[1] if high is line_family.high else (),
                )
                free_views = FreeViews(
                    line_family.sector,
                    low,
                    high,
                    (here, other),
                    names,
                    pins,
                    passed,
                    line_family.anchor if line_family.goes_back else None,
                )
                yield from self.clipper.families(free_views)

    def _shown(self, line_family: LineFamily, role: Role, wanted: frozenset[int]) -> list[Side]:
        """The wanted sides that a line family shows from behind or ahead of its contact."""
        shown = (line_family.contact, line_family.ahead if role is Role.BEHIND else line_family.behind)
        return [side for side in shown if side is not None and side.edge in wanted]

    def _cuts(self, line_family: LineFamily) -> list[Cut]:
        """The ends of a family and, between them, the lines through the way's ends: parameters in order."""
        lines: list[tuple[Real, Pin]] = []
        ends = self._through_ends(line_family.sector)
        # All normals of an arc pass its centre. If one end of the way is there, the line through the other
        # one is the way's own, and its neighbours cross the way in the centre.
        centers = [pin for pin, _ in ends if _is_center(line_family.sector, pin[0])]
        if centers:
            ends = [(centers[0], through) for _, through in ends]
        for pin, through in ends:
            for t in through:
                same = next((k for k, (known, _) in enumerate(lines) if known.overlaps(t)), None)
                if same is None:
                    lines.append((t, pin))
                elif line_family.anchor in self.touches or self._is_own(
                    line_family.sector, t, lines[same][0]
                ):
                    lines[same] = t, self._pin_of_own(line_family, line_family.sector.touch(t)[0])
                else:
                    lines.append((t, pin))
        low, high = (
            (t, self._pin_at(line_family, t, names), names)
            for t, names in zip((line_family.low, line_family.high), line_family.names, strict=True)
        )
        inner = [line for line in lines if self._is_inside(line_family, *line)]
        inner.sort(key=cmp_to_key(_by_parameter))
        cuts = [low]
        for t, pin in inner:
            if t.compare(cuts[-1][0]) != 0:
                cuts.append((t, pin, ()))
        return [*cuts, high]

    def _through_ends(self, sector: Sector) -> list[tuple[Pin, list[Real]]]:
        """The way's ends, with the parameters of a sector's lines through them; families share sectors."""
        kept = self._through.get(id(sector))
        if kept is None:
            span = self.span
            pins = (span.start, span.low), (span.end, span.high)
            kept = self._through[id(sector)] = sector, [(pin, sector.through(pin[0])) for pin in pins]
        return kept[1]

    def _is_own(self, sector: Sector, t: Real, other: Real) -> bool:
        """Whether the lines through the way's ends, which look the same, are one: the way's own line."""
        if isinstance(sector, Rolling):
            return self._is_tangent(Point(*sector.center), dot(sector.base, sector.base))
        return isinstance(sector, Spokes) and t.compare(other) == 0

    def _is_tangent(self, center: Point, radius_sq: fmpq) -> bool:
        """Whether the way's line touches a circle."""
        along = self.line.end - self.line.start
        height = along.cross(center - self.line.start)
        excess: Real = height * height - along.norm_sq() * radius_sq
        return excess.sign() == 0

    def _is_inside(self, line_family: LineFamily, t: Real, pin: Pin) -> bool:
        """Whether a line through a point of the way lies strictly inside a line family.

        A way often ends on a line that bounds a line family. That is asked of the point: comparing parameters
        would take a root more. If the way's own line bounds the family, its name says so.
        """
        for bound, side, names in (
            (line_family.low, 1, line_family.names[0]),
            (line_family.high, -1, line_family.names[1]),
        ):
            if t.overlaps(bound):
                if any(name in self.touches for name, _ in names):
                    return False
                contact, direction = line_family.sector.touch(bound)
                if direction.cross(pin[0] - contact).sign() == 0:
                    return False
            if t.compare(bound) != side:
                return False
        return True

    def _pin_at(self, line_family: LineFamily, t: Real, names: Names) -> Pin | None:
        """The point of the way on a line that bounds a line family, where it need not be computed."""
        is_own = any(name in self.touches for name, _ in names)
        # No parameter: the end may be the point about which the lines turn.
        near = [
            pin
            for pin, through in self._through_ends(line_family.sector)
            if not through or any(t.overlaps(u) for u in through)
        ]
        if not near and not is_own:
            return None
        contact, direction = line_family.sector.touch(t)
        if is_own:
            return contact, self.rail.parameter(contact)
        on_line = [pin for pin in near if direction.cross(pin[0] - contact).sign() == 0]
        if len(on_line) == 2:
            return self._pin_of_own(line_family, contact)
        return on_line[0] if on_line else None

    def _pin_of_own(self, line_family: LineFamily, contact: Point) -> Pin:
        """Where the lines of a line family near one that is the way's own cross the way.

        Tangents do so near their contact, normals of an arc in its centre.
        """
        place = Point(*line_family.sector.center) if isinstance(line_family.sector, Spokes) else contact
        return place, self.rail.parameter(place)

    def _role(self, line_family: LineFamily, t: fmpq, wanted: frozenset[int]) -> Role | None:
        """On which side of the contact the line crosses the way within its free part, if it does."""
        contact, direction = line_family.sector.touch(Real(t))
        met = line_contacts(contact, direction, self.piece)
        if not met or met[0].sign() == 0:
            return None
        side = met[0].sign()
        role = Role.AHEAD if side > 0 else Role.BEHIND
        if not self._shown(line_family, role, wanted):
            return None
        wall = line_family.ahead if side > 0 else line_family.behind
        if wall is None:
            # Nothing was met within reach; normals do not go back from their edge.
            return role if side > 0 or line_family.goes_back else None
        limit = meet(contact, direction, self.clipper.curve(wall.edge), side)
        return role if (limit - met[0]).sign() * side >= 0 else None

    def _along(self, single: SingleLine) -> Iterator[ViewFamily]:
        """A single line that crosses the way between its place and the run that it shows."""
        direction = single.run[0] - single.place
        met = line_contacts(single.place, direction, self.piece)
        if not met:
            return
        for place in {id(m): m for m in (met[0], met[-1])}.values():
            if place.sign() < 0 or place.compare(1) > 0:
                continue
            point = single.place + direction * place
            pin = point, self.rail.parameter(point)
            for first, last in self.clipper.along(pin, single.run, single.shown):
                yield ViewFamily((self.way, single.shown), first, last)

    def _own_line(self) -> Iterator[ViewFamily]:
        """The views along the way itself: of its ends, of corners it touches, and of what lies beyond."""
        table, span = self.complex.table, self.span
        shown = [(e, p) for p in (span.start, span.end) for e in _edges_near(table, p)]
        along = self.line.end - self.line.start
        shown += [*self._beyond(span.end, along), *self._beyond(span.start, -along)]
        for e, point in self._touched():
            # Its line may touch things beyond its ends too; those at an end are there already.
            u = self.rail.parameter(point)
            if _certainly(span.low, u) and _certainly(u, span.high):
                shown.append((e, point))
        for e, point in shown:
            if e in self.wanted:
                place = self.clipper.rails[e].parameter(point)
                near = self._within(point)
                ends = [End(Real(0), (p, point), (u, place)) for p, u in near]
                if ends:
                    yield ViewFamily((self.way, e), ends[0], ends[-1])

    def _touched(self) -> Iterator[tuple[int, Point]]:
        """The corners and the tangent points of wanted edges on the way's line, named or not."""
        table, start = self.complex.table, self.line.start
        along = self.line.end - start
        (x, y), (dx, dy) = start.xy, along.xy
        slack = self.slack * hypot(dx, dy)
        for e in self.wanted:
            left, bottom, right, top = table.boxes[e]
            sides = [(cx - x) * dy - (cy - y) * dx for cx in (left, right) for cy in (bottom, top)]
            if min(sides) > slack or max(sides) < -slack:
                continue
            curve = table.curves[e]
            for number, corner in ((e, curve.start), (int(table.next[e]), curve.end)):
                if ("corner", number) in self.touches or along.cross(corner - start).sign() == 0:
                    yield e, corner
            if isinstance(curve, Arc):
                named = ("circle", table.circles[e]) in self.touches
                if named or self._is_tangent(curve.center, curve.radius_sq):
                    foot = start + along * ((curve.center - start).dot(along) / along.norm_sq())
                    if curve.contains(foot):
                        yield e, foot

    def _beyond(self, end: Point, onward: Point) -> Iterator[tuple[int, Point]]:
        """What the way's line meets beyond an end, as far as it is seen from there."""
        table = self.complex.table
        own = _edges_near(table, end)
        (x, y), (dx, dy) = end.xy, onward.xy
        size = hypot(dx, dy)
        for e, intervals in self.view(end, None).spans.items():
            curve = table.curves[e]
            low, high = table.boxes[e, :2], table.boxes[e, 2:]
            corners = [(cx - x, cy - y) for cx in (low[0], high[0]) for cy in (low[1], high[1])]
            ahead = max(cx * dx + cy * dy for cx, cy in corners)
            sides = [cx * dy - cy * dx for cx, cy in corners]
            slack = self.slack * size
            if e not in self.wanted or ahead < -slack or min(sides) > slack or max(sides) < -slack:
                continue
            if e in own:
                # The line meets an edge at its end only there, unless it runs along it.
                if isinstance(curve, Segment) and len(line_contacts(end, onward, curve)) == 2:
                    far = max((curve.start, curve.end), key=lambda p: (p - end).dot(onward))
                    yield e, far
                continue
            for share in line_contacts(end, onward, curve):
                if share.sign() > 0:
                    point = end + onward * share
                    rail = self.clipper.rails[e]
                    u = rail.parameter(point)
                    # A full circle's start is at 0 and at the top.
                    full = isinstance(curve, Arc) and curve.full
                    places = [u, rail.top] if full and u.sign() == 0 else [u]
                    if any(Cover(tuple(intervals)).contains(place) for place in places):
                        yield e, point

    def _within(self, point: Point) -> list[Pin]:
        """The ends of the part of the way within range of a point of its line."""
        span = self.span
        ends = [(span.start, span.low), (span.end, span.high)]
        far = [self.clipper.range.order(p, point) > 0 for p, _ in ends]
        if not any(far):
            return ends
        along = self.line.end - self.line.start
        step = along * (self.clipper.range.radius / along.norm_sq().sqrt())
        for k, place in enumerate((point - step, point + step)):
            if far[k]:
                u = self.rail.parameter(place)
                if u.compare(span.low) < 0 or u.compare(span.high) > 0:
                    return []
                ends[k] = place, u
        return ends

    def normals(self) -> Iterator[Pencil]:
        """The normals of the way itself, to both sides."""
        start, end = raw(self.line.start), raw(self.line.end)
        low, high = self.span.low, self.span.high
        for leftward in (True, False):
            sector = Sliding(start, minus(end, start), low, high, leftward=leftward)
            yield pencil(self.complex.table, sector, (), self.complex.range.above)

    def normal_views(self, lines: Pencil, row: LineCells) -> list[ViewFamily]:
        """The views along some neighbouring normals of the way."""
        cell = lines.cell(row)
        if cell.ahead is None or cell.ahead not in self.wanted:
            return []
        sides = Side(self.way, Role.CONTACT), Side(cell.ahead, Role.AHEAD)
        free_views = FreeViews(lines.sector, cell.low, cell.high, sides, passed=cell.bounds)
        return self.clipper.families(free_views)

    def _normals(self) -> Iterator[ViewFamily]:
        """The views along the normals of the way itself."""
        for lines in self.normals():
            for row in lines.rows:
                yield from self.normal_views(lines, row)


def _edges_near(table: EdgeTable, point: Point) -> list[int]:
    """The edges that balls do not part from a point: the end of a way lies on a boundary, or it does not."""
    x, y = point.xy
    near = (int(e) for e in table.near((x, y), (x, y), 0.0))
    return [e for e in near if table.curves[e].may_pass(point, BITS)]


def _is_center(sector: Sector, point: Point) -> bool:
    """Whether a point is the centre of the arc to which a sector's lines are normal."""
    return isinstance(sector, Spokes) and point == Point(*sector.center)


def _by_parameter(a: tuple[Real, Pin], b: tuple[Real, Pin]) -> int:
    return a[0].compare(b[0])


def _certainly(low: Real, high: Real) -> bool:
    """Whether balls tell that one number is less than another."""
    return (high - low).clear_sign(BITS) > 0
