"""The places from which an end of a component's boundary is seen.

Where a terrain's border cuts an edge, or an edge along the border follows, the boundary that counts ends
at a point that is no corner of the scene. No family of tangent lines leads to it, so its own isovist is
computed: visibility is symmetric, and a place of the path sees the point if the point sees the place.
"""

from __future__ import annotations

from itertools import pairwise

from exactacq.cached import cached_property
from exactacq.geometry.coordinates import raw
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.intersections import contacts
from exactacq.geometry.interval_union import Interval
from exactacq.geometry.points import Point
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.legs import Leg
from exactacq.visibility.free_segment import is_free
from exactacq.visibility.outline import outline
from exactacq.visibility.sensor_range import Range
from exactacq.visibility.visible_boundary import BoundaryView


class CutEnd:
    """An end of boundary, at parameter *u* of the rail of ``edge``, and what is seen from it within range."""

    def __init__(self, table: EdgeTable, range_: Range, edge: int, u: Real, point: Point) -> None:
        self.table, self.range, self.edge = table, range_, edge
        self.pin = Interval(u, point, u, point)
        self.point = point

    def sees(self, place: Point) -> bool:
        """Whether a free place is seen."""
        if self.range.order(self.point, place) > 0:
            return False
        if place == self.point:
            return True
        return not self._view.buries(raw(place - self.point)) and is_free(self.table, self.point, place)

    def along(self, leg: Leg) -> list[Interval]:
        """The parts of a leg that are seen, as closed intervals; single places count."""
        left, bottom, right, top = leg.box
        x, y, r = *self.point.xy, self.range.above + 8 * self.table.roundoff_at(self.point.xy)
        if left > x + r or right < x - r or bottom > y + r or top < y - r:
            return []
        cuts = [(leg.span.low, leg.span.start), (leg.span.high, leg.span.end)]
        for curve in self._outline:
            for contact in contacts(leg.curve, curve):
                cuts += [(leg.rail.parameter(p), p) for p in (contact.start, contact.end)]
        # A full circle's start is at 0, and at the top for a leg that ends there: that end is a cut anyway.
        cuts = [cut for cut in cuts if leg.span.low <= cut[0] <= leg.span.high]
        cuts.sort(key=lambda cut: cut[0])
        cuts = [c for k, c in enumerate(cuts) if k == 0 or cuts[k - 1][0].compare(c[0]) < 0]
        inside = [self.sees(leg.rail.point(rational_between(a[0], b[0]))) for a, b in pairwise(cuts)]
        found: list[Interval] = []
        for k, (u, p) in enumerate(cuts):
            if k > 0 and inside[k - 1]:
                found[-1] = Interval(found[-1].low, found[-1].start, u, p)
            elif (k < len(inside) and inside[k]) or self.sees(p):
                found.append(Interval(u, p, u, p))
        return found

    @cached_property
    def _view(self) -> BoundaryView:
        return BoundaryView(self.table, self.point, self.range, None)

    @cached_property
    def _outline(self) -> list[Curve]:
        """The view's outline, and the single rays that see more than their neighbours."""
        rays = [Segment(self.point, end) for end in self._view.lone_ends()]
        return [piece.curve for piece in outline(self._view)] + [*rays]
