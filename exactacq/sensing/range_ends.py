"""Where families of free views meet the range, and what of them lies within it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from functools import cache, partial
from itertools import pairwise
from operator import itemgetter
from typing import TypeAlias

from flint import arb, fmpq

from exactacq.geometry.constructions import Carrier, is_put_on
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import contacts, line_points
from exactacq.geometry.late import Pin, balls, late_point
from exactacq.geometry.points import Point
from exactacq.kernel.lines import line_at
from exactacq.kernel.range_cuts import (
    ALL_IN_RANGE,
    FIRST_TOO_LONG,
    LAST_TOO_LONG,
    NONE_IN_RANGE,
    UNSURE,
    parted_lines,
)
from exactacq.numbers.between import rational_between
from exactacq.numbers.float_bounds import float_ball
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.sensing.line_points import Role
from exactacq.sensing.line_views import LineViews
from exactacq.sensing.view_families import FreeViews, LineView, SidePin, ViewFamily
from exactacq.sensing.view_length import of_length_on
from exactacq.visibility.chords import of_length
from exactacq.visibility.line_balls import line
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes
from exactacq.visibility.sensor_range import Range

Candidate: TypeAlias = "tuple[Real, SidePin | None, bool]"
"""The parameter of a line, the point of a side there if that is known, and whether the view surely is as long
as the range."""


IsAtRange: TypeAlias = "Callable[[FreeViews, LineView], bool]"
"""Tells whether one of some views is known to be as long as the range."""


class RangeEnds:
    """Restricts families to the range.

    *touched* are the numbers of the features that a way touches. Of some views from it *at_range* tells that
    they are as long as the range.
    """

    def __init__(
        self,
        views: LineViews,
        range_: Range,
        touched: Collection[int] = (),
        at_range: IsAtRange | None = None,
    ) -> None:
        self.views, self.range = views, range_
        self._touched, self._is_known_at_range = touched, at_range

    def within(self, free_views: FreeViews) -> Iterator[ViewFamily]:
        """The parts of some free views that lie within range, as closed families; single views count."""
        edges, views = (free_views.sides[0].edge, free_views.sides[1].edge), self.views
        told, last = (ALL_IN_RANGE, None) if free_views.in_range else self._by_floats(free_views)
        if told == NONE_IN_RANGE:
            return
        if last is not None:
            kept = views.view(free_views, free_views.low if told == LAST_TOO_LONG else free_views.high)
            yield ViewFamily(edges, *((kept, last) if told == LAST_TOO_LONG else (last, kept)), free_views)
            return
        low, high = (self._extreme(free_views, t) for t in (free_views.low, free_views.high))
        if told == ALL_IN_RANGE:
            yield ViewFamily(edges, low, high, free_views)
            return
        ends = [low, *self._at_range(free_views, low, high), high]
        inside = [self._is_inside(free_views, rational_between(a.t, b.t)) for a, b in pairwise(ends)]
        begin: LineView | None = None
        for k, end in enumerate(ends):
            before, after = k > 0 and inside[k - 1], k < len(inside) and inside[k]
            if after and begin is None:
                begin = end.tightened() if k > 0 else end
            elif before and not after:
                assert begin is not None
                yield ViewFamily(edges, begin, end.tightened() if k < len(inside) else end, free_views)
                begin = None
            elif not before and not after and self._order(free_views, end) <= 0:
                yield ViewFamily(edges, end, end, free_views)

    def _extreme(self, free_views: FreeViews, t: Real) -> LineView:
        """The first or the last view."""
        end = self.views.view(free_views, t)
        is_known = self._is_known_at_range is not None and self._is_known_at_range(free_views, end)
        return end.tightened() if is_known else end

    def _is_inside(self, free_views: FreeViews, t: fmpq) -> bool:
        at = line(free_views.sector, arb(t))
        here, there = (self.views.spot(at, side) for side in free_views.sides)
        if here is not None and there is not None and (clear := self.range.clear_order(here, there)):
            return clear < 0
        return self.range.order(*self.views.exactly(free_views.sector, Real(t), free_views.sides)) <= 0

    # -- by floats -----------------------------------------------------------------------------------

    def _by_floats(self, free_views: FreeViews) -> tuple[int, LineView | None]:
        """Which views floats find in range; the last one of them if some are and some are not."""
        if not free_views.sector.is_rational:
            return UNSURE, None
        frame = free_views.sector.image
        here, there = sorted(free_views.sides, key=lambda side: side.fixed)
        (a, p), (b, q) = float_ball(free_views.low), float_ball(free_views.high)
        told, near, far = parted_lines(
            frame,
            (line_at(frame, a, p), line_at(frame, b, q)),
            (a - p, a + p, b - q, b + q),
            here.role,
            there.role,
            self.views.image(here.edge),
            None if there.fixed else self.views.image(there.edge),
            (self.range.below, self.range.above),
        )
        if told not in (FIRST_TOO_LONG, LAST_TOO_LONG):
            return told, None
        if self._ends_on_rim(free_views):
            return UNSURE, None
        return told, self._late_last(free_views, arb(near).union(arb(far)))

    def _ends_on_rim(self, free_views: FreeViews) -> bool:
        """Whether the last view in range ends in a place of `_rim`, where those of other families end too."""
        roles = {side.role: side.edge for side in free_views.sides}
        if Role.CONTACT not in roles or isinstance(free_views.sector, Sliding):
            return False
        far = next(edge for role, edge in roles.items() if role is not Role.CONTACT)
        return isinstance(free_views.sector, Rolling | Spokes) or isinstance(self.views.curve(far), Arc)

    def _late_last(self, free_views: FreeViews, t: arb) -> LineView:
        """The last view in range, along a line in a ball: its numbers are made when they are read."""
        at, exact, points = line(free_views.sector, t), cache(partial(self._last, free_views)), []
        for k, side in enumerate(free_views.sides):
            spot = self.views.spot(at, side)
            if spot is None:
                return exact()
            corner = side.corner(self.views.curve(side.edge)) if side.fixed else None
            points.append(late_point(spot, _point_of, exact, k) if corner is None else corner)
        last = self.views.between(free_views, Real.late(t, lambda: exact().t), (points[0], points[1]))
        return last.tightened()

    def _last(self, free_views: FreeViews) -> LineView:
        """The one view between the extreme ones that is as long as the range."""
        ends = (self.views.view(free_views, t) for t in (free_views.low, free_views.high))
        found = self._at_range(free_views, *ends)
        end = found[0] if len(found) == 1 else next(e for e in found if not self.range.order(*e.points))
        return end.tightened()

    # -- all views that may be as long as the range, exactly -----------------------------------------

    def _at_range(self, free_views: FreeViews, low: LineView, high: LineView) -> list[LineView]:
        """The views strictly between the extreme ones that may be as long as the range, in order."""
        found = [
            at
            for at in self._candidates(free_views, low, high)
            if at[0].compare(free_views.low) > 0 and at[0].compare(free_views.high) < 0
        ]
        found.sort(key=itemgetter(0))
        distinct: list[Candidate] = []
        for at in found:
            if not distinct or at[0].compare(distinct[-1][0]):
                distinct.append(at)
            else:
                t, pin, is_tight = distinct[-1]
                distinct[-1] = t, at[1] if pin is None else pin, is_tight or at[2]
        ends = ((self.views.view(free_views, t, known), is_tight) for t, known, is_tight in distinct)
        return [end.tightened() if is_tight else end for end, is_tight in ends if self._may_be_at_range(end)]

    def _order(self, free_views: FreeViews, end: LineView) -> int:
        """-1, 0 or 1 as a view is shorter than the range, as long or longer.

        It is as long if its far point was made where the range is reached along the lines.
        """
        roles = [side.role for side in free_views.sides]
        if end.tight:
            return 0
        if Role.CONTACT in roles and _meets_rim_once(free_views.sector):
            square = self._square_from_center(free_views.sector).rational
            far = end.points[1 - roles.index(Role.CONTACT)]
            if square is not None and is_put_on(far, Carrier(*free_views.sector.center, square)):
                return 0
        return self.range.order(*end.points)

    def _may_be_at_range(self, end: LineView) -> bool:
        return not self.range.clear_order(*map(balls, end.points))

    def _candidates(self, free_views: FreeViews, low: LineView, high: LineView) -> Iterator[Candidate]:
        """Where views may be as long as the range."""
        sector, (one, other) = free_views.sector, free_views.sides
        roles = {side.role: side.edge for side in (one, other)}
        curves = {role: self.views.curve(edge) for role, edge in roles.items()}
        if Role.CONTACT not in roles:
            behind, ahead = curves[Role.BEHIND], curves[Role.AHEAD]
            if _is_rational(behind) and _is_rational(ahead):
                found = of_length(sector, behind, ahead, self.range.square)
                yield from ((t, None, False) for t in found)
                return
            is_touched = sector.round and free_views.anchor in self._touched
            way = self.views.rails[-1].curve if is_touched else None
            span = free_views.low, free_views.high

            def longer_at(t: Real) -> int:
                return self._order(free_views, low if t is low.t else high)

            is_flat = partial(self._is_flat, free_views, low, high)
            center = self._common_center(behind, ahead) or self._common_center(ahead, behind)
            known = [] if center is None else sector.through(center)
            square = self.range.square
            for t in of_length_on(sector, behind, ahead, square, *span, way, longer_at, known, is_flat):
                if center is not None and any(t is own for own in known):
                    k = 0 if isinstance(self.views.curve(one.edge), Segment) else 1
                    own_end = k, (center, self.views.rails[free_views.sides[k].edge].parameter(center))
                    yield t, own_end, True
                else:
                    yield t, None, True
            return
        k = 1 if one.role is Role.CONTACT else 0
        far = free_views.sides[k]
        if isinstance(sector, Sliding):
            stops = [end.points[k] for end in (low, high) if end.tight]
            # On other edges the point is made there, of one number too.
            is_told = isinstance(curves[far.role], Segment) and not _is_rational(curves[far.role])
            for t, point in self._beside(sector, curves[far.role], stops):
                pin = point, self.views.rails[far.edge].parameter(point)
                yield t, (k, pin) if is_told else None, True
            return
        # An arc that is met twice is seen where the line enters the obstacle. At the other place no view
        # ends: those beside it are all longer than the range, or all shorter.
        for pin in self._rim(Point(*sector.center), self._square_from_center(sector), far.edge):
            for t in sector.through(pin[0]):
                is_told = self._is_towards(sector, t, far.role, pin[0])
                yield t, (k, pin) if is_told else None, is_told and _meets_rim_once(sector)

    def _is_flat(self, free_views: FreeViews, low: LineView, high: LineView, t: Real) -> bool:
        """Whether the view at one of two ends is as long as the range, and its length stationary there.

        So it is if the line touches its circle where it crosses the way, and meets the other side along that
        side's normal: as the line rolls on, one end stays and the other moves across the view.
        """
        end, sector = low if t is low.t else high, free_views.sector
        curves = [self.views.curve(side.edge) for side in free_views.sides]
        k = 0 if _is_rational(curves[1]) else 1
        way, wall, near, far = curves[k], curves[1 - k], end.points[k], end.points[1 - k]
        along = wall.direction if isinstance(wall, Segment) else (far - wall.center).left()
        return (
            sector.round
            and isinstance(way, Segment)
            and along.dot(far - near).sign() == 0
            and sector.touch(t)[0] == near
            and way.direction.cross(far - near).sign() != 0
            and self.range.order(near, far) == 0
        )

    def _common_center(self, way: Curve, arc: Curve) -> Point | None:
        """The centre of an arc whose radius is the range, if a straight curve's line passes it.

        From there all views to the arc are as long as the range.
        """
        if not (isinstance(way, Segment) and isinstance(arc, Arc) and arc.radius_sq == self.range.square):
            return None
        return arc.center if way.direction.cross(arc.center - way.start).sign() == 0 else None

    def _rim(self, center: Point, square: Real, edge: int) -> list[Pin]:
        """The points of an edge at a squared distance from a point, the same ones for all families."""
        curve, rail = self.views.curve(edge), self.views.rails[edge]
        return self.views.pins.rim(
            (center.key, square.key, edge),
            lambda: [(point, rail.parameter(point)) for point in _at_distance(center, square, curve)],
        )

    def _is_towards(self, sector: Sector, t: Real, role: Role, point: Point) -> bool:
        """Whether balls tell that a line's point lies where its role is: ahead of the contact or behind."""
        (cx, cy, dx, dy), (x, y) = line(sector, t.ball(64)), balls(point)
        return ball_sign((x - cx) * dx + (y - cy) * dy) == role

    def _beside(self, sector: Sliding, far: Curve, known: list[Point]) -> Iterator[tuple[Real, Point]]:
        """Where the parallel of a segment at the range meets an edge; some ends are *known* to lie on it.

        Each point is made of one number along the parallel: its own numbers show that it is on it.
        """
        start, normal = sector.touch(Real(0))
        offset = normal * (self.range.radius / normal.norm_sq().sqrt())
        base = Point(*sector.base)
        for point in line_points(start + offset, base, far, known):
            yield (point - start).dot(base) / base.norm_sq(), point

    def _square_from_center(self, sector: Sector) -> Real:
        """Squared distance from a sector's centre to the far end of a view that is as long as the range."""
        if sector.round:
            return Real(self.range.square + sector.base[0] ** 2 + sector.base[1] ** 2)
        if isinstance(sector, Spokes):
            radius = Real(sector.radius_sq).sqrt()
            away: Real = radius + self.range.radius if sector.outward else radius - self.range.radius
            return away * away
        return Real(self.range.square)


def _meets_rim_once(sector: Sector) -> bool:
    """Whether what lies on a line, and as far from the sector's centre as the range reaches, is at the range.

    A normal through the centre of its arc passes two such places. Parallels have no centre.
    """
    return not isinstance(sector, Sliding) and (not isinstance(sector, Spokes) or sector.outward)


def _point_of(view: Callable[[], LineView], k: int) -> Point:
    """The point of a view on its side k."""
    return view().points[k]


def _is_rational(curve: Curve) -> bool:
    """Whether a curve is fit for `of_length`: arcs, and segments with rational ends."""
    return isinstance(curve, Arc) or (curve.start.rational is not None and curve.end.rational is not None)


def _at_distance(center: Point, square: Real, curve: Curve) -> Iterator[Point]:
    """The points of a curve at a squared distance from a point; none where that is all or nothing of it."""
    if square.sign() == 0:
        return
    for contact in contacts(curve, Arc.circle(center, square)):
        if contact.start is contact.end:
            yield contact.start
