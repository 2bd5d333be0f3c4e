"""Chains of curves as corners with bulges that a file can hold, with proven bounds of the moves.

Ends and bulges are rounded one by one; `exactacq.files.loops.chains` says how far that moves the points of
an edge. A wide arc would magnify it, so one that cannot be written exactly is cut in the middle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from flint import fmpq

from exactacq.files.loops.chains import Chain, Corner
from exactacq.files.writing.decimals import Precision
from exactacq.files.writing.sheet import Item
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.bends import Around, bend

Exactly = Callable[[Arc], bool]
"""Whether a format holds an arc between two rational points without any rounding."""


class Corners:
    """The corners of a chain, ready to be written, and of each the curve that follows (None at an open end).

    *exactly* tells the arcs whose form in the file needs no rounding beyond that of their ends; others are
    cut until their bulge is at most *widest*, which is at most 1. Edges whose ends fall together by rounding
    are left out.
    """

    def __init__(self, item: Item, precision: Precision, exactly: Exactly, widest: fmpq) -> None:
        self._precision, self._exactly, self._widest = precision, exactly, widest
        self.closed = item.closed
        self.corners: list[Corner] = []
        self.curves: list[Curve | None] = []
        for curve in item.curves:
            for part in self._parts(curve):
                self._add(self._corner(part.start, part), part)
        if not item.closed:
            self._add(self._corner(item.curves[-1].end, None), None)
        elif len(self.corners) > 1 and _same(self.corners[0], self.corners[-1]):
            last = self.corners.pop()
            self.curves.pop()
            _absorb(self.corners[0], last)

    @property
    def moved(self) -> fmpq:
        """An upper bound of how far any point of the chain moved."""
        return Chain("", self.corners, closed=self.closed).moved()

    def _parts(self, curve: Curve) -> Iterator[Curve]:
        if not isinstance(curve, Arc):
            yield curve
            return
        if curve.full:
            middle = curve.center + (curve.center - curve.start)
            for start, end in ((curve.start, middle), (middle, curve.start)):
                yield from self._parts(Arc(start, end, curve.center, curve.radius_sq, curve.ccw))
            return
        if not curve.quarter_tangent.ball(64) > self._widest or self._is_exact(curve):
            yield curve
            return
        middle = curve.point(fmpq(1, 2))
        for start, end in ((curve.start, middle), (middle, curve.end)):
            yield from self._parts(Arc(start, end, curve.center, curve.radius_sq, curve.ccw))

    def _is_exact(self, arc: Arc) -> bool:
        numbers = (arc.start.x, arc.start.y, arc.end.x, arc.end.y)
        return not any(self._precision.rounded(x)[1] for x in numbers) and self._exactly(arc)

    def _corner(self, point: Point, curve: Curve | None) -> Corner:
        x, shift_x = self._precision.rounded(point.x)
        y, shift_y = self._precision.rounded(point.y)
        corner = Corner(x, y, fmpq(0), shift_x + shift_y)
        if isinstance(curve, Arc):
            size, error = self._precision.share(bulge_of(curve))
            corner.bulge = size if curve.ccw else -size
            corner.bulge_shift = fmpq(0) if self._is_exact(curve) else error
        return corner

    def _add(self, corner: Corner, curve: Curve | None) -> None:
        if self.corners and _same(self.corners[-1], corner):
            _absorb(corner, self.corners.pop())
            self.curves.pop()
        self.corners.append(corner)
        self.curves.append(curve)


def bulge_of(arc: Arc) -> Real:
    """The tangent of a quarter of an arc's angle, positive; rational where it is."""
    start, end, center = arc.start.rational, arc.end.rational, arc.center.rational
    if start is not None and end is not None and center is not None:
        told = bend(start, end, Around(center, arc.ccw))
        if not isinstance(told, Around):
            return Real(abs(told))
    return arc.quarter_tangent


def is_exact_bulge(precision: Precision) -> Exactly:
    """Whether a format that holds bulges holds that of an arc."""
    return lambda arc: precision.share(bulge_of(arc))[1] == 0


def _same(a: Corner, b: Corner) -> bool:
    return bool(a.x == b.x and a.y == b.y)


def _absorb(kept: Corner, lost: Corner) -> None:
    """Take over the moves of a corner whose edge fell together.

    Its ends were within both shifts of the one place that is kept, so within their sum of each other. An edge
    with a bulge of at most 1 lies in the disc over its ends: no point of it is farther from the place than
    twice that sum.
    """
    kept.shift = 2 * (kept.shift + lost.shift)
