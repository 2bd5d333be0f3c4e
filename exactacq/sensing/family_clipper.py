"""Cuts families of free views: to the range, where full circles begin, and to parts of their sides."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import overload

from exactacq.geometry.curve_parameter import ZERO, Rail
from exactacq.geometry.curves import Curve
from exactacq.geometry.interval_union import Interval
from exactacq.geometry.late import Pin
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.line_views import LineViews
from exactacq.sensing.range_ends import IsAtRange, RangeEnds
from exactacq.sensing.view_families import FreeViews, LineView, ViewFamily
from exactacq.visibility.sensor_range import Range

TOP = Real(4)
"""The parameter of a full circle's start where the circle ends."""


class RailsAndWay(Sequence[Rail]):
    """Rails by number and one more, that of a way: without a copy, as families of every way keep it."""

    __slots__ = ("_count", "_rails", "_way")

    def __init__(self, rails: Sequence[Rail], way: Rail) -> None:
        self._rails, self._way, self._count = rails, way, len(rails)

    @overload
    def __getitem__(self, e: int) -> Rail: ...
    @overload
    def __getitem__(self, e: slice) -> Sequence[Rail]: ...
    def __getitem__(self, e: int | slice) -> Rail | Sequence[Rail]:
        if isinstance(e, slice):
            return [*self._rails, self._way][e]
        if 0 <= e < self._count:
            return self._rails[e]
        if e not in (-1, self._count):
            raise IndexError(f"no rail {e}")
        return self._way

    def __len__(self) -> int:
        return self._count + 1


class FamilyClipper:
    """Cuts free views to a range and finds their views; holds the rails of the scene's edges by number."""

    def __init__(
        self,
        rails: Sequence[Rail],
        range_: Range,
        table: EdgeTable,
        base: FamilyClipper | None = None,
        touched: Collection[int] = (),
        at_range: IsAtRange | None = None,
    ) -> None:
        """*base* are the rails without a way, *touched* the numbers of the features that it touches.

        Of some views from it *at_range* tells that they are as long as the range.
        """
        self.rails, self.range, self._table = rails, range_, table
        self.views: LineViews = LineViews(rails, table, None if base is None else base.views)
        self._ends = RangeEnds(self.views, range_, touched, at_range)

    def with_way(
        self, way: Rail, touches: Collection[int] = (), at_range: IsAtRange | None = None
    ) -> FamilyClipper:
        """These and one more curve, a way through free space, with the numbers of the features it touches.

        Of some views from it *at_range* tells that they are as long as the range.
        """
        rails = RailsAndWay(self.rails, way)
        return FamilyClipper(rails, self.range, self._table, self, touches, at_range)

    def curve(self, e: int) -> Curve:
        """The curve of a number."""
        return self.rails[e].curve

    def families(self, free_views: FreeViews) -> list[ViewFamily]:
        """The parts of some free views that lie within range, as closed families; single views count."""
        found = list(self._ends.within(free_views))
        for k, side in enumerate(free_views.sides):
            if side.start != 0 and getattr(self.curve(side.edge), "full", False):
                found = [part for family in found for part in self._unrolled(family, k)]
        return found

    def _unrolled(self, family: ViewFamily, k: int) -> Iterator[ViewFamily]:
        """On a full circle: cut where a side passes the circle's start, whose parameter is 0 or 4."""
        first, last, free_views = family.first, family.last, family.free_views
        if free_views is None or first is last:
            yield family
            return
        is_told = free_views.sides[k].start is not None
        if not is_told and not self._passes_start(free_views, first, last, k):
            yield family
            return
        a, b = first.places[k], last.places[k]
        if is_told or not (a.sign() and b.sign()):
            first, last = (end if end.places[k].sign() else end.placed(k, TOP) for end in (first, last))
            yield ViewFamily(family.edges, first, last, free_views)
            return
        seam = self.views.view_from(family, k, self.curve(family.edges[k]).start)
        before, after = (TOP, ZERO) if a > b else (ZERO, TOP)
        yield ViewFamily(family.edges, first, seam.placed(k, before), free_views)
        yield ViewFamily(family.edges, seam.placed(k, after), last, free_views)

    def _passes_start(self, free_views: FreeViews, first: LineView, last: LineView, k: int) -> bool:
        """Whether a side passes the start of a full circle, or comes to it from the end."""
        a, b = first.places[k], last.places[k]
        grows = free_views.grows(k)
        if grows is not None:
            return a.compare(b) == (1 if grows else -1)
        middle = self.views.view(free_views, Real(rational_between(first.t, last.t))).places[k]
        return not min(a, b) <= middle <= max(a, b)

    def along(self, pin: Pin, run: tuple[Pin, Pin], shown: int) -> Iterator[tuple[LineView, LineView]]:
        """The views along one line from a place to a run on an edge, as far as it is within range."""
        (place, here), (near, far) = pin, run
        if self.range.order(place, near[0]) > 0:
            return
        if self.range.order(place, far[0]) > 0:
            # From the run, by one number: the point shows that it is on the edge, the place need not.
            along = far[0] - near[0]
            unit = along * (1 / along.norm_sq().sqrt())
            last = near[0] + unit * (self.range.radius - (near[0] - place).dot(unit))
            far = last, self.rails[shown].parameter(last)
        one, other = (LineView(Real(0), (place, point), (here, u)) for point, u in (near, far))
        yield one, other

    def clipped(self, family: ViewFamily, side: int, span: Interval) -> ViewFamily | None:
        """The part of a family whose one side lies in an interval of that side's rail."""
        if span.low.rational == 0 and span.high is self.rails[family.edges[side]].top:
            return family
        one, other = family.ends_on(side)
        low, high = one.places[side], other.places[side]
        after, before = low.compare(span.low), high.compare(span.high)
        if after > 0 > before:
            return family
        if (before > 0 and low.compare(span.high) > 0) or (after < 0 and high.compare(span.low) < 0):
            return None
        first = self._moved(family, family.first, family.last, side, span)
        last = self._moved(family, family.last, family.first, side, span)
        return ViewFamily(family.edges, first, last, family.free_views)

    def _moved(
        self, family: ViewFamily, end: LineView, other: LineView, side: int, span: Interval
    ) -> LineView:
        """An extreme view, moved to the end of an interval if it lies outside; *other* is the other one."""
        place = end.places[side]
        at_low, at_high = place.compare(span.low), place.compare(span.high)
        if at_low == 0:
            return end.pinned(side, span.start, span.low)
        if at_high == 0:
            return end.pinned(side, span.end, span.high)
        if at_low > 0 > at_high:
            return end
        place, point = (span.low, span.start) if at_low < 0 else (span.high, span.end)
        if place.compare(other.places[side]) == 0:
            return other.pinned(side, point, place)
        if family.free_views is None:
            points = (point, end.points[1]) if side == 0 else (end.points[0], point)
            return LineView(end.t, points, end.places).placed(side, place)
        return self.views.view_from(family, side, point).placed(side, place)
