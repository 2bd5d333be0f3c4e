"""One-parameter families of views: free segments between two boundary edges, none longer than the range.

Take a point of edge f that is visible from edge e, and its *shortest* view from e. It cannot be shortened
by moving its end along e. So it touches a corner or a convex arc that keeps it from moving, or it is
normal to e, or it starts at an end of e. Hence the tangent lines of corners and arcs, the normals of
edges and the rays from vertices, families with one parameter each, contain every shortest view: together
they give all that e sees of f, and, with the roles exchanged, the part of e from which anything of f is
in sight. A `FreeViews` is such a family before the range is considered; `FamilyClipper.families` restricts it
to the range, and the results are `ViewFamily` objects.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cmp_to_key, partial
from itertools import pairwise
from math import inf
from typing import TypeAlias, overload

from flint import arb, fmpq

from exactacq.geometry.curve_images import curve_image, held_point
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.intersections import contacts, line_contacts
from exactacq.geometry.interval_union import Interval
from exactacq.geometry.late import Balls, Pin, balls, late_point
from exactacq.geometry.points import Point
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import in_range, sagitta
from exactacq.kernel.family_images import EdgePlace, EdgePlaces
from exactacq.kernel.line_keys import LineNumbers
from exactacq.kernel.lines import line_at, meets, parameter_round
from exactacq.numbers.between import rational_between
from exactacq.numbers.float_bounds import float_ball, margin
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.sensing.line_points import LinePoints, Role, Side, along_normal
from exactacq.sensing.named_pins import NamedPins
from exactacq.sensing.view_length import of_length_on
from exactacq.visibility.chords import of_length
from exactacq.visibility.line_balls import CurveBalls, Line, line, through
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes
from exactacq.visibility.line_names import Names
from exactacq.visibility.rotational_sweep import Passed
from exactacq.visibility.sensor_range import Range

BITS = 128
"""Precision of the balls that tell a short way from a long proof."""

SidePin: TypeAlias = "tuple[int, Pin]"
"""The point of the first side, 0, or of the second one, 1."""
Candidate: TypeAlias = "tuple[Real, SidePin | None]"
"""The parameter of a line, and the point of a side there if it is known."""


@dataclass(slots=True)
class End:
    """One view of a family: line parameter, the two end points with their rail parameters.

    ``tight`` if it is known to be as long as the range, because the views on one side of it are longer.
    """

    t: Real
    points: tuple[Point, Point]
    places: tuple[Real, Real]
    tight: bool = False

    def is_short(self, range_: Range) -> bool:
        """Whether the view is shorter than the range."""
        return not self.tight and range_.order(*self.points) < 0


@dataclass(slots=True)
class FreeViews:
    """The views between two sides along the lines of a sector from ``low`` to ``high``.

    ``names`` are those of the first and the last line (see `line_names`); ``pinned`` are their points on the
    first side, where these are known; ``passed`` tells what they pass. ``anchor`` is the number of the
    feature that tangents touch; the views along normals, without, bound nothing of what is seen. ``in_range``
    if all are known to be within range.
    """

    sector: Sector
    low: Real
    high: Real
    sides: tuple[Side, Side]
    names: tuple[Names, Names] = ((), ())
    pinned: tuple[Pin | None, Pin | None] = (None, None)
    passed: tuple[Passed, Passed] = ((), ())
    anchor: int | None = None
    in_range: bool = False

    @property
    def is_normal(self) -> bool:
        """Whether the lines are normals of an edge."""
        return isinstance(self.sector, Sliding | Spokes)

    def touched(self, t: Real, numbers: LineNumbers) -> list[int]:
        """The features that the first or the last line touches, by their numbers; none for a normal."""
        for bound, passed in zip((self.low, self.high), self.passed, strict=True):
            if t is bound and self.anchor is not None:
                return [self.anchor, *(numbers.feature(number, side != 0) for number, side, _ in passed)]
        return []


@dataclass(slots=True)
class ViewFamily:
    """A family of free views within range, from one extreme view to the other; both ends move monotonically.

    Without a free views the family has one fixed end, and all views lie on one line.
    """

    edges: tuple[int, int]
    first: End
    last: End
    free_views: FreeViews | None = None


class RailsAndWay(Sequence[Rail]):
    """Rails by number and one more, that of a way: without a copy, as families of every way keep it."""

    __slots__ = ("_rails", "_way")

    def __init__(self, rails: Sequence[Rail], way: Rail) -> None:
        self._rails, self._way = rails, way

    @overload
    def __getitem__(self, e: int) -> Rail: ...
    @overload
    def __getitem__(self, e: slice) -> Sequence[Rail]: ...
    def __getitem__(self, e: int | slice) -> Rail | Sequence[Rail]:
        if isinstance(e, slice):
            return [*self._rails, self._way][e]
        return self._way if e in (-1, len(self._rails)) else self._rails[e]

    def __len__(self) -> int:
        return len(self._rails) + 1


class FamilyClipper:
    """Cuts free views to a range and finds their views; holds the rails of the scene's edges by number."""

    def __init__(self, rails: Sequence[Rail], range_: Range, roundoff: float, numbers: LineNumbers) -> None:
        self.rails, self.range, self.roundoff, self.numbers = rails, range_, roundoff, numbers
        self._points = LinePoints(rails)
        self._pins = NamedPins()
        self._base: FamilyClipper | None = None
        self._balls: dict[int, CurveBalls] = {}
        self._images: dict[int, CurveImage] = {}
        self._touched: Collection[int] = ()

    def with_way(self, way: Rail, touches: Collection[int] = ()) -> FamilyClipper:
        """These and one more curve, a way through free space, with the numbers of the features it touches."""
        extent = max(abs(v) for p in (way.curve.start, way.curve.end) for v in p.xy)
        clipper = FamilyClipper(
            RailsAndWay(self.rails, way),
            self.range,
            max(self.roundoff, margin(2.0**-50 * extent)),
            self.numbers,
        )
        clipper._pins = NamedPins(self._pins)
        clipper._base = self
        clipper._touched = touches
        return clipper

    def curve(self, e: int) -> Curve:
        """The curve of a number."""
        return self.rails[e].curve

    def families(self, free_views: FreeViews) -> list[ViewFamily]:
        """The parts of a free views that lie within range, as closed families; single views count."""
        found = list(self._within(free_views))
        for k, side in enumerate(free_views.sides):
            if getattr(self.curve(side.edge), "full", False):
                found = [part for family in found for part in self._unrolled(family, k)]
        return found

    def _unrolled(self, family: ViewFamily, k: int) -> Iterator[ViewFamily]:
        """On a full circle: cut where a side passes the circle's start, whose parameter is 0 or 4."""
        first, last, free_views = family.first, family.last, family.free_views
        if free_views is None or first is last or self._is_on_one_side(family, free_views, k):
            yield family
            return
        a, b = first.places[k], last.places[k]
        middle = self.end(free_views, Real(rational_between(first.t, last.t))).places[k]
        if a.sign() == 0 and middle.compare(b) > 0:
            a = Real(4)
        if b.sign() == 0 and middle.compare(a) > 0:
            b = Real(4)
        first, last = _placed(first, k, a), _placed(last, k, b)
        if min(a, b) <= middle <= max(a, b):
            yield ViewFamily(family.edges, first, last, free_views)
            return
        seam = self.view_from(family, k, self.curve(family.edges[k]).start)
        before, after = (Real(4), Real(0)) if a > b else (Real(0), Real(4))
        yield ViewFamily(family.edges, first, _placed(seam, k, before), free_views)
        yield ViewFamily(family.edges, _placed(seam, k, after), last, free_views)

    def _is_on_one_side(self, family: ViewFamily, free_views: FreeViews, k: int) -> bool:
        """Whether a side on a full circle surely does not pass its start, as a line between tells in floats.

        Differences of floats are off by far less than half of themselves.
        """
        sector, side = free_views.sector, free_views.sides[k]
        if not sector.is_rational:
            return False
        ends = family.first, family.last
        (low, p), (high, q) = (float_ball(end.t) for end in ends)
        t = (low + high) / 2.0
        if not (t - low > 2.0 * p and high - t > 2.0 * q):
            return False
        line_, image = line_at(sector.image, t, 0.0), self._image(side.edge)
        if side.role is Role.CONTACT:
            x, y, _, _, e, _ = line_
            u, r = parameter_round(image, x, y, e)
        else:
            _, _, u, r, *_ = meets(line_, image, side.role)
        (a, p), (b, q) = sorted(float_ball(end.places[k]) for end in ends)
        return u - a > 2.0 * (p + r) and b - u > 2.0 * (q + r)

    def _image(self, e: int) -> CurveImage:
        """The curve of a number in floats."""
        if self._base is not None and 0 <= e < len(self._base.rails):
            return self._base._image(e)
        if e not in self._images:
            self._images[e] = curve_image(self.curve(e))
        return self._images[e]

    def _within(self, free_views: FreeViews) -> Iterator[ViewFamily]:
        low, high = self.end(free_views, free_views.low), self.end(free_views, free_views.high)
        edges = free_views.sides[0].edge, free_views.sides[1].edge
        if certain := 1 if free_views.in_range else self._certain(free_views, low, high):
            if certain > 0:
                yield ViewFamily(edges, low, high, free_views)
            return
        ends = [low, *self._at_range(free_views, low, high), high]
        inside = [self._is_inside(free_views, rational_between(a.t, b.t)) for a, b in pairwise(ends)]
        begin: End | None = None
        for k, end in enumerate(ends):
            before, after = k > 0 and inside[k - 1], k < len(inside) and inside[k]
            if after and begin is None:
                begin = _tight(end) if k > 0 else end
            elif before and not after:
                assert begin is not None
                yield ViewFamily(edges, begin, _tight(end) if k < len(inside) else end, free_views)
                begin = None
            elif not before and not after and self.range.order(*end.points) <= 0:
                yield ViewFamily(edges, end, end, free_views)

    def along(self, pin: Pin, run: tuple[Pin, Pin], shown: int) -> Iterator[tuple[End, End]]:
        """The views along one line from a place to a run on an edge, as far as it is within range."""
        (place, here), (near, far) = pin, run
        if self.range.order(place, near[0]) > 0:
            return
        if self.range.order(place, far[0]) > 0:
            along = far[0] - place
            last = place + along * (self.range.radius / along.norm_sq().sqrt())
            far = last, self.rails[shown].parameter(last)
        one, other = (End(Real(0), (place, point), (here, u)) for point, u in (near, far))
        yield one, other

    def end(self, free_views: FreeViews, t: Real, known: SidePin | None = None) -> End:
        """The view of a free views at a parameter; the point of one side there may be *known*."""
        names: Names = ()
        pin: Pin | None = None
        passed: Passed = ()
        for k, bound in enumerate((free_views.low, free_views.high)):
            if t is bound:
                names, pin, passed = free_views.names[k], free_views.pinned[k], free_views.passed[k]
        given = {} if pin is None else {0: pin}
        if known is not None:
            given[known[0]] = known[1]
        pins = [
            given[k] if k in given else self.pin(free_views.sector, t, side, names, passed)
            for k, side in enumerate(free_views.sides)
        ]
        return End(t, (pins[0][0], pins[1][0]), (pins[0][1], pins[1][1]))

    def pin(self, sector: Sector, t: Real, side: Side, names: Names, passed: Passed) -> Pin:
        """Where a line meets an edge: the same point as on the same line under another name.

        A line that touches the edge's circle meets it at the contact, in either sense.
        """
        role = side.role
        touches = any(touching and number == side.edge for number, touching, _ in passed)
        keys = [
            (name, side.edge, 0 if touches or self.numbers.touches(name, side.edge) else role * sense)
            for name, sense in names
        ]
        for key in keys:
            known = self._pins.get(key)
            if known is not None:
                return known
        pin = self._late_pin(sector, t, side, passed)
        for key in keys:
            self._pins.put(key, pin)
        return pin

    def _late_pin(self, sector: Sector, t: Real, side: Side, passed: Passed) -> Pin:
        """Where a line meets an edge: a corner if it is one, else a place that is made when it is read."""
        curve = self.curve(side.edge)
        if side.role is Role.CONTACT and side.fixed:
            corner = side.corner(curve)
            return corner, self.rails[side.edge].parameter(corner)
        rail, make = self.rails[side.edge], partial(self._points.exact, sector, t, side, passed)
        at = line(sector, t.ball(64))
        is_told, found = self._points.passed_in_balls(side, at, passed)
        if isinstance(found, Point):
            return found, rail.parameter(found)
        if found is None and is_told:
            found = self._spot(at, side)
        point = make() if found is None else late_point(found, make)
        return point, rail.parameter(point)

    def _spot(self, at: Line, side: Side) -> Balls | None:
        """Where a line meets an edge, in balls; None if no ball holds it."""
        if side.role is Role.CONTACT:
            return at[:2]
        met = self.balls(side.edge).met(at, side.role)
        return None if met is None else met[1]

    def balls(self, e: int) -> CurveBalls:
        """The curve of a number in balls."""
        if self._base is not None and 0 <= e < len(self._base.rails):
            return self._base.balls(e)
        if e not in self._balls:
            self._balls[e] = CurveBalls(self.curve(e))
        return self._balls[e]

    def clipped(self, family: ViewFamily, side: int, span: Interval) -> ViewFamily | None:
        """The part of a family whose one side lies in an interval of that side's rail."""
        a, b = family.first.places[side], family.last.places[side]
        if span.low.rational == 0 and span.high is self.rails[family.edges[side]].top:
            return family
        low, high = (a, b) if a.compare(b) <= 0 else (b, a)
        if low.compare(span.high) > 0 or high.compare(span.low) < 0:
            return None
        first = self._moved(family, family.first, family.last, side, span)
        last = self._moved(family, family.last, family.first, side, span)
        if family.free_views is not None and first.t.compare(last.t) > 0:
            first, last = last, first
        return ViewFamily(family.edges, first, last, family.free_views)

    def _moved(self, family: ViewFamily, end: End, other: End, side: int, span: Interval) -> End:
        """An extreme view, moved to the end of an interval if it lies outside; *other* is the other one."""
        place = end.places[side]
        at_low, at_high = place.compare(span.low), place.compare(span.high)
        if at_low == 0:
            return _shared(end, side, span.start, span.low)
        if at_high == 0:
            return _shared(end, side, span.end, span.high)
        if at_low > 0 > at_high:
            return end
        place, point = (span.low, span.start) if at_low < 0 else (span.high, span.end)
        if place.compare(other.places[side]) == 0:
            return _shared(other, side, point, place)
        if family.free_views is None:
            points = (point, end.points[1]) if side == 0 else (end.points[0], point)
            return _placed(End(end.t, points, end.places), side, place)
        return _placed(self.view_from(family, side, point), side, place)

    def view_from(self, family: ViewFamily, side: int, point: Point) -> End:
        """The view of a family from a point of one of its sides, strictly between its extreme views."""
        assert family.free_views is not None
        late = self._late_view(family, family.free_views, side, point)
        return self._exact_view(family, family.free_views, side, point) if late is None else late

    def _late_view(self, family: ViewFamily, free_views: FreeViews, side: int, point: Point) -> End | None:
        """The view from a point, with numbers made when they are read; None if balls leave it open.

        Of the two tangents through a point one is the view. The other one may be the last line of the family,
        as where a way touches the circle itself: then balls leave that one open, and the view is told all the
        same.
        """
        sector, (here, there) = free_views.sector, (free_views.sides[side], free_views.sides[1 - side])
        if isinstance(sector, Spokes) or (here.role is Role.CONTACT and isinstance(sector, Rolling)):
            return None
        x, y = balls(point)
        for k, t in enumerate(through(sector, (x, y)) or ()):
            after, before = ball_sign(t - family.first.t.ball(64)), ball_sign(family.last.t.ball(64) - t)
            if min(after, before) < 0:
                continue
            at = line(sector, t)
            ahead = ball_sign((x - at[0]) * at[2] + (y - at[1]) * at[3])
            is_open = not (after and before and (ahead or here.role is Role.CONTACT))
            if not is_open and here.role in (ahead, Role.CONTACT):
                found = Real.late(t, partial(_line_through, sector, point, k))
                far, _ = self._late_pin(sector, found, there, ())
                points = (point, far) if side == 0 else (far, point)
                one, other = (
                    self.rails[s.edge].parameter(p) for s, p in zip(free_views.sides, points, strict=True)
                )
                return End(found, points, (one, other))
        return None

    def _exact_view(self, family: ViewFamily, free_views: FreeViews, side: int, point: Point) -> End:
        """The view from a point, by exact numbers."""
        role = free_views.sides[side].role
        sector = free_views.sector
        if role == 0 and isinstance(sector, Rolling):
            lines = [sector.touching(point)]
        else:
            lines = sector.through(point)
        for t in lines:
            if t.compare(family.first.t) < 0 or t.compare(family.last.t) > 0:
                continue
            contact, direction = free_views.sector.touch(t)
            # 0: the two sides meet there, as where a way touches a circle.
            if role == 0 or (point - contact).dot(direction).sign() in (0, role):
                near, far = (self.curve(free_views.sides[k].edge) for k in (side, 1 - side))
                other = along_normal(sector, free_views.sides[1 - side].role, near, far, point, direction)
                if other is None:
                    other = self._points.at(sector, free_views.sides[1 - side], contact, direction)
                points = (point, other) if side == 0 else (other, point)
                places = [
                    self.rails[s.edge].parameter(p) for s, p in zip(free_views.sides, points, strict=True)
                ]
                return End(t, points, (places[0], places[1]))
        # Each point of the plane, but for one that all lines may share, lies on one line of a family on that
        # side of the contact: on one half tangent of a circle, one ray from a corner, one normal. So where
        # the lines meet a side moves along it without turning back, through all places between the extreme
        # ones. Where they all meet it in the shared point, the centre of an arc to which they are normal,
        # there is no place between: `rotational_sweep` parts such normals from the others.
        raise AssertionError("a line of the family passes each point between its extreme views")

    def _is_inside(self, free_views: FreeViews, t: fmpq) -> bool:
        at = line(free_views.sector, arb(t))
        here, there = (self._spot(at, side) for side in free_views.sides)
        if here is not None and there is not None and (clear := self.range.clear_order(here, there)):
            return clear < 0
        contact, direction = free_views.sector.touch(Real(t))
        a, b = (self._points.at(free_views.sector, side, contact, direction) for side in free_views.sides)
        return self.range.order(a, b) <= 0

    def _certain(self, free_views: FreeViews, low: End, high: End) -> int:
        """1 if floats prove that all views are within range, -1 if none is, 0 if they cannot tell."""
        near, far = ((_held(low.points[k]), _held(high.points[k])) for k in (0, 1))
        slack = self._bent(free_views, 0, near) + self._bent(free_views, 1, far)
        return in_range(near, far, slack, (self.range.below, self.range.above))

    def _bent(self, free_views: FreeViews, k: int, places: EdgePlaces) -> float:
        """How far a side may leave the box of its two extreme points."""
        side = free_views.sides[k]
        curve = self.curve(side.edge)
        radius = float(curve.radius) if isinstance(curve, Arc) and not side.fixed else 0.0
        return sagitta(radius, not isinstance(free_views.sector, Rolling | Sliding), places)

    # -- where a family meets the range --------------------------------------------------------------

    def _at_range(self, free_views: FreeViews, low: End, high: End) -> list[End]:
        """The views strictly between the extreme ones that may be as long as the range, in order."""
        found = [
            at
            for at in self._candidates(free_views, low, high)
            if at[0].compare(free_views.low) > 0 and at[0].compare(free_views.high) < 0
        ]
        found.sort(key=cmp_to_key(_by_parameter))
        distinct: list[Candidate] = []
        for at in found:
            if not distinct or _by_parameter(at, distinct[-1]):
                distinct.append(at)
            elif distinct[-1][1] is None:
                distinct[-1] = at
        ends = (self.end(free_views, t, known) for t, known in distinct)
        return [end for end in ends if self._may_be_at_range(end)]

    def _longer_at(self, low: End, high: End, t: Real) -> int:
        """-1, 0 or 1 as the view at one of two ends is shorter than the range, as long or longer."""
        end = low if t is low.t else high
        return self.range.order(*end.points)

    def _may_be_at_range(self, end: End) -> bool:
        return not self.range.clear_order(*map(balls, end.points))

    def _candidates(self, free_views: FreeViews, low: End, high: End) -> Iterator[Candidate]:
        """Where views may be as long as the range."""
        sector, (one, other) = free_views.sector, free_views.sides
        roles = {side.role: side.edge for side in (one, other)}
        curves = {role: self.curve(edge) for role, edge in roles.items()}
        if Role.CONTACT not in roles:
            behind, ahead = curves[Role.BEHIND], curves[Role.AHEAD]
            if _is_rational(behind) and _is_rational(ahead):
                found = of_length(sector, behind, ahead, self.range.square)
            else:
                is_touched = sector.round and free_views.anchor in self._touched
                way = self.rails[-1].curve if is_touched else None
                span = free_views.low, free_views.high
                longer_at = partial(self._longer_at, low, high)
                found = of_length_on(sector, behind, ahead, self.range.square, *span, way, longer_at)
            yield from ((t, None) for t in found)
            return
        k = 1 if one.role is Role.CONTACT else 0
        far = free_views.sides[k]
        if isinstance(sector, Sliding):
            yield from ((t, None) for t in self._beside(sector, curves[far.role]))
            return
        # An arc that is met twice is seen where the line enters the obstacle. At the other place no view
        # ends: those beside it are all longer than the range, or all shorter.
        for pin in self._rim(Point(*sector.center), self._square_from_center(sector), far.edge):
            for t in sector.through(pin[0]):
                yield t, (k, pin) if self._is_towards(sector, t, far.role, pin[0]) else None

    def _rim(self, center: Point, square: Real, edge: int) -> list[Pin]:
        """The points of an edge at a squared distance from a point, the same ones for all families."""
        curve, rail = self.curve(edge), self.rails[edge]
        return self._pins.rim(
            (center.key, square.key, edge),
            lambda: [(point, rail.parameter(point)) for point in _at_distance(center, square, curve)],
        )

    def _is_towards(self, sector: Sector, t: Real, role: Role, point: Point) -> bool:
        """Whether balls tell that a line's point lies where its role is: ahead of the contact or behind."""
        (cx, cy, dx, dy), (x, y) = line(sector, t.ball(64)), balls(point)
        return ball_sign((x - cx) * dx + (y - cy) * dy) == role

    def _beside(self, sector: Sliding, far: Curve) -> list[Real]:
        """Where the parallel of a segment at the range meets an edge."""
        start, normal = sector.touch(Real(0))
        offset = normal * (self.range.radius / normal.norm_sq().sqrt())
        return line_contacts(start + offset, Point(*sector.base), far)

    def _square_from_center(self, sector: Sector) -> Real:
        """Squared distance from a sector's centre to the far end of a view that is as long as the range."""
        if sector.round:
            return Real(self.range.square + sector.base[0] ** 2 + sector.base[1] ** 2)
        if isinstance(sector, Spokes):
            radius = Real(sector.radius_sq).sqrt()
            away: Real = radius + self.range.radius if sector.outward else radius - self.range.radius
            return away * away
        return Real(self.range.square)


def _by_parameter(a: Candidate, b: Candidate) -> int:
    return a[0].compare(b[0])


def _line_through(sector: Sector, point: Point, k: int) -> Real:
    """One of the lines of a sector through a point."""
    return sector.through(point)[k]


def _held(point: Point) -> EdgePlace:
    """A point in floats, as of an edge wherever it is there."""
    return -inf, inf, *held_point(point)


def _shared(end: End, k: int, point: Point, place: Real) -> End:
    """The view *end* with *point* and its parameter *place* on side k."""
    points = (point, end.points[1]) if k == 0 else (end.points[0], point)
    return _placed(End(end.t, points, end.places, end.tight), k, place)


def _tight(end: End) -> End:
    """The view *end*, marked as exactly as long as the range."""
    return End(end.t, end.points, end.places, tight=True)


def _placed(end: End, k: int, place: Real) -> End:
    """The view *end* with the parameter *place* on side k."""
    places = (place, end.places[1]) if k == 0 else (end.places[0], place)
    return End(end.t, end.points, places, end.tight)


def _is_rational(curve: Curve) -> bool:
    """Whether a curve is fit for `of_length`: arcs, and segments with rational ends."""
    return isinstance(curve, Arc) or (curve.start.rational is not None and curve.end.rational is not None)


def _at_distance(center: Point, square: Real, curve: Curve) -> Iterator[Point]:
    """The points of a curve at a squared distance from a point; none where that is all or nothing of it."""
    if square.sign() == 0:
        return
    east = Point(center.x + square.sqrt(), center.y)
    circle = Arc(east, east, center, square, ccw=True, full=True)
    for contact in contacts(curve, circle):
        if contact.start is contact.end:
            yield contact.start
