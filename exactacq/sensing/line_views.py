"""The views of families, line by line: their end points, made late, and found again by name."""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Curve
from exactacq.geometry.late import Balls, Pin, balls, late_point
from exactacq.geometry.points import Point
from exactacq.kernel.curve_images import CurveImage
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.line_points import LinePoints, Role, Side, along_normal
from exactacq.sensing.named_pins import NamedPins, PinName
from exactacq.sensing.view_families import FreeViews, LineView, SidePin, ViewFamily
from exactacq.visibility.line_balls import CurveBalls, Line, line, through
from exactacq.visibility.line_families import Rolling, Sector, Spokes
from exactacq.visibility.line_names import Names
from exactacq.visibility.rotational_sweep import Passed


class LineViews:
    """Makes the views of families, line by line; holds the rails of the scene's edges by number.

    *base* are those that it adds a way to.
    """

    def __init__(
        self,
        rails: Sequence[Rail],
        table: EdgeTable,
        base: LineViews | None = None,
    ) -> None:
        self.rails, self.table, self.numbers = rails, table, table.line_numbers
        self.pins: NamedPins = NamedPins(self.numbers, None if base is None else base.pins)
        self._points = LinePoints(rails)
        self._base = base
        self.way: int | None = None if base is None else len(rails) - 1
        """The number of the way that is added."""
        self._balls: dict[int, CurveBalls] = {}
        self._last: tuple[Sector | None, Real | None, Line] = (None, None, (arb(), arb(), arb(), arb()))

    def curve(self, e: int) -> Curve:
        """The curve of a number."""
        return self.rails[e].curve

    def image(self, e: int) -> CurveImage:
        """The curve of a number in floats."""
        return curve_image(self.curve(e)) if e == self.way else self.table.curve_images[e]

    def view(self, free_views: FreeViews, t: Real, known: SidePin | None = None) -> LineView:
        """The view along the line at a parameter; the point of one side there may be *known*."""
        names: Names = ()
        pin: Pin | None = None
        passed: Passed = ()
        for k, bound in enumerate((free_views.low, free_views.high)):
            if t is bound:
                names, pin, passed = free_views.names[k], free_views.pinned[k], free_views.passed[k]
        sector, (here, there) = free_views.sector, free_views.sides
        one = known[1] if known is not None and known[0] == 0 else pin
        other = known[1] if known is not None and known[0] == 1 else None
        one = self.pin(sector, t, here, names, passed) if one is None else one
        other = self.pin(sector, t, there, names, passed) if other is None else other
        return LineView(t, (one[0], other[0]), (one[1], other[1]))

    def between(self, free_views: FreeViews, t: Real, points: tuple[Point, Point]) -> LineView:
        """The view along the line at a parameter, between the points in which it meets the two sides."""
        (here, there), (p, q) = free_views.sides, points
        return LineView(t, points, (self.rails[here.edge].parameter(p), self.rails[there.edge].parameter(q)))

    def pin(self, sector: Sector, t: Real, side: Side, names: Names, passed: Passed) -> Pin:
        """Where a line meets an edge: the same point as on the same line under another name.

        A line that touches the edge's circle meets it at the contact, in either sense, and the way once. A
        normal begins where it would enter the obstacle going back: a circle has it as its normal twice.
        """
        role = side.role
        if role is Role.CONTACT and side.fixed:
            corner = side.corner(self.curve(side.edge))
            return corner, self.rails[side.edge].parameter(corner)
        edge, touches = side.edge, self.numbers.touches
        once = edge == self.way or edge in [e for e, touching, _ in passed if touching]
        way = role if role is not Role.CONTACT or sector.round else Role.BEHIND
        keys = [(name, edge, 0 if once or touches(name, edge) else way * sense) for name, sense in names]
        pin = next((pin for key in keys if (pin := self.pins.get(key)) is not None), None)
        if pin is not None and len(keys) == 1:
            return pin
        if pin is None:
            pin = self._late_pin(sector, t, side, passed)
        # Who knows the line by another of its names finds it too.
        for key in keys:
            self._pins_of(key).put(key, pin)
        return pin

    def _pins_of(self, name: PinName) -> NamedPins:
        """Where a point is kept: other ways share those of the scene's edges on the scene's lines."""
        number, edge, _ = name
        base = self._base
        return self.pins if base is None or number < 0 or edge == self.way else base.pins

    def _late_pin(self, sector: Sector, t: Real, side: Side, passed: Passed) -> Pin:
        """Where a line meets an edge: a corner that it passes, else a place that is made when it is read."""
        rail, points = self.rails[side.edge], self._points
        at = self._line(sector, t)
        is_told, found = self._points.passed_in_balls(side, at, passed)
        if isinstance(found, Point):
            return found, rail.parameter(found)
        if found is None and is_told:
            found = self.spot(at, side)
        if found is None:
            point = points.exact(sector, t, side, passed)
        else:
            point = late_point(found, LinePoints.exact, points, sector, t, side, passed)
        return point, rail.parameter(point)

    def _line(self, sector: Sector, t: Real) -> Line:
        """A line in balls; the last one is kept, for a view has two ends."""
        # Read once: another thread may look at another line meanwhile.
        last, u, at = self._last
        if last is not sector or u is not t:
            at = line(sector, t.ball(64))
            self._last = sector, t, at
        return at

    def spot(self, at: Line, side: Side) -> Balls | None:
        """Where a line meets an edge, in balls; None if no ball holds it."""
        if side.role is Role.CONTACT:
            return at[:2]
        met = self.balls_of(side.edge).met(at, side.role)
        return None if met is None else met[1]

    def balls_of(self, e: int) -> CurveBalls:
        """The curve of a number in balls."""
        if self._base is not None and 0 <= e < len(self._base.rails):
            return self._base.balls_of(e)
        if e not in self._balls:
            self._balls[e] = CurveBalls(self.curve(e))
        return self._balls[e]

    def view_from(self, family: ViewFamily, side: int, point: Point) -> LineView:
        """The view of a family from a point of one of its sides, strictly between its extreme views."""
        assert family.free_views is not None
        late = self._late_view(family, family.free_views, side, point)
        return self._exact_view(family, family.free_views, side, point) if late is None else late

    def _late_view(
        self, family: ViewFamily, free_views: FreeViews, side: int, point: Point
    ) -> LineView | None:
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
                found = Real.late(t, _line_through, sector, point, k)
                far, _ = self.pin(sector, found, there, (), ())
                return self.between(free_views, found, (point, far) if side == 0 else (far, point))
        return None

    def _exact_view(self, family: ViewFamily, free_views: FreeViews, side: int, point: Point) -> LineView:
        """The view from a point, by exact numbers."""
        sector, role, there = free_views.sector, free_views.sides[side].role, free_views.sides[1 - side]
        if role == 0 and isinstance(sector, Rolling):
            lines = [sector.touching(point)]
        else:
            lines = sector.through(point)
        for t in lines:
            if t.compare(family.first.t) < 0 or t.compare(family.last.t) > 0:
                continue
            contact, direction = sector.touch(t)
            # 0: the two sides meet there, as where a way touches a circle.
            if role == 0 or (point - contact).dot(direction).sign() in (0, role):
                near, far = (self.curve(free_views.sides[k].edge) for k in (side, 1 - side))
                other = along_normal(sector, there.role, near, far, point, direction)
                if other is None:
                    other = self._points.at(sector, there, contact, direction)
                return self.between(free_views, t, (point, other) if side == 0 else (other, point))
        # Each point of the plane, but for one that all lines may share, lies on one line of a family on that
        # side of the contact: on one half tangent of a circle, one ray from a corner, one normal. So where
        # the lines meet a side moves along it without turning back, through all places between the extreme
        # ones. Where they all meet it in the shared point, the centre of an arc to which they are normal,
        # there is no place between: `rotational_sweep` parts such normals from the others.
        raise AssertionError("a line of the family passes each point between its extreme views")

    def exactly(self, sector: Sector, t: Real, sides: tuple[Side, Side]) -> list[Point]:
        """Where the line at an exact parameter meets two sides."""
        contact, direction = sector.touch(t)
        return [self._points.at(sector, side, contact, direction) for side in sides]


def lines_through(sector: Sector, point: Point) -> list[Real]:
    """The parameters of the lines of a sector through a point; of a circle's tangents they are late."""
    found = through(sector, balls(point)) if isinstance(sector, Rolling) else None
    if found is None:
        return sector.through(point)
    return [Real.late(t, _line_through, sector, point, k) for k, t in enumerate(found)]


def _line_through(sector: Sector, point: Point, k: int) -> Real:
    """One of the lines of a sector through a point."""
    return sector.through(point)[k]
