"""The ends of what a place sees, by their numbers: points that are made when somebody asks for them.

Vertices and the other events of the sweep keep their numbers. Those above are of `ViewParts`: where a ray
past an event meets a face behind it, where an edge leaves the range, and points that exact arithmetic found.
"""

from __future__ import annotations

from exactacq.geometry.constructions import put_around
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.kernel.view_parts import CROSSING, GIVEN, HERE, HIT, ViewParts
from exactacq.visibility.radial_sweep import RadialSweep
from exactacq.visibility.range_clip import Disc, Span, crossing, late_crossing

AT_RANGE = -1
"""In place of the rank of a point's direction."""


class ViewEnds:
    """The points of one view's ends, by their numbers; each is made once."""

    def __init__(self, sweep: RadialSweep, parts: ViewParts, disc: Disc) -> None:
        self.sweep, self.parts, self.disc = sweep, parts, disc
        self._starts = sweep.faces.table.starts
        self._points: dict[int, Point] = {}
        self._ranks: dict[int, int] = {}

    def point(self, end: int, read: bool = False) -> Point:
        """The point of an end; one that is to be *read* is not made late."""
        if end < len(self._starts):
            return self._starts[end] if end >= 0 else self.sweep.faces.point
        point = self._points.get(end)
        if point is None:
            point = self._points[end] = self._made(end, read)
        return point

    def _made(self, end: int, read: bool) -> Point:
        sweep, parts = self.sweep, self.parts
        if end < parts.base:
            point, rank = sweep.faces.place(end), sweep.rank_of(end)
        else:
            kind, face, rank = parts.made[end - parts.base]
            if kind == HIT:
                point = sweep.hit(face, rank) if read else sweep.late_hit(face, rank)
            else:
                assert kind == CROSSING, "points that were given are known"
                line = sweep.table.curves[sweep.edge(face)]
                assert isinstance(line, Segment)
                point = (crossing if read else late_crossing)(line, self.disc, rank)
                put_around(point, sweep.faces.point, self.disc.square)
                rank = AT_RANGE
        self._ranks[end] = rank
        return point

    def rank(self, end: int) -> int | None:
        """The rank of an end's direction, or `AT_RANGE`; None for vertices and points without one."""
        return self._ranks.get(end)

    def number(self, e: int, point: Point, at_range: bool = False, rank: int | None = None) -> int:
        """The number of a point of an edge that was made elsewhere.

        It may have been made for the distance of the range, or on the ray of a rank.
        """
        table = self.sweep.table
        curve = table.curves[e]
        if point is curve.start:
            return e
        if point is curve.end:
            return table.following[e]
        end = self.parts.add(GIVEN, HERE, HERE)
        self._points[end] = point
        if rank is not None:
            self._ranks[end] = rank
        if at_range:
            self._ranks[end] = AT_RANGE
            put_around(point, self.sweep.faces.point, self.disc.square)
        return end

    def span(self, part: tuple[int, int]) -> Span:
        """Both points of a part."""
        start = self.point(part[0])
        return start, start if part[1] == part[0] else self.point(part[1])
