"""Unions of closed intervals on a rail, with exact ends."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from exactacq.geometry.constructions import put_equal
from exactacq.geometry.curve_parameter import ZERO, Rail
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real


@dataclass(slots=True)
class Interval:
    """A closed interval of rail parameters with its end points; low = high is a single point."""

    low: Real
    start: Point
    high: Real
    end: Point

    @classmethod
    def whole(cls, rail: Rail) -> Interval:
        """All of a rail."""
        return cls(ZERO, rail.curve.start, rail.top, rail.curve.end)

    def within(self, span: Interval) -> Interval | None:
        """What of it lies in another one; ends are copied."""
        low, start = (span.low, span.start) if self.low < span.low else (self.low, self.start)
        high, end = (span.high, span.end) if self.high > span.high else (self.high, self.end)
        return Interval(low, start, high, end) if low <= high else None

    @classmethod
    def between(cls, rail: Rail, start: Point, end: Point) -> list[Interval]:
        """The part of a rail from start to end, in two pieces if it passes the start of a full circle."""
        curve = rail.curve
        if start is curve.start and end is curve.end and not rail.is_closed:
            return [cls.whole(rail)]
        low = rail.parameter(start)
        high = low if end is start else rail.parameter(end)
        if low is high or not rail.is_closed or low.compare(high) <= 0:
            return [cls(low, start, high, end)]
        seam = curve.start
        return [
            part
            for part in (cls(low, start, rail.top, seam), cls(ZERO, seam, high, end))
            if part.low.compare(part.high) < 0
        ]


class Cover:
    """A union of closed intervals on one rail: sorted, disjoint, merged. Immutable."""

    __slots__ = ("intervals",)

    def __init__(self, intervals: tuple[Interval, ...] = ()) -> None:
        self.intervals = intervals

    def added(self, new: Interval) -> Cover:
        """The union with one more interval; self if that adds nothing."""
        before: list[Interval] = []
        after: list[Interval] = []
        for old in self.intervals:
            at_low = old.low.compare(new.low)
            if at_low == 0 and old.start is not new.start:
                put_equal(old.start, new.start)
            if at_low <= 0:
                at_high = old.high.compare(new.high)
                if at_high == 0 and old.end is not new.end:
                    put_equal(old.end, new.end)
                if at_high >= 0:
                    return self
            if at_low > 0 and old.low.compare(new.high) > 0:
                after.append(old)
            elif at_low < 0 and old.high.compare(new.low) < 0:
                before.append(old)
            else:
                left = old if at_low <= 0 else new
                right = old if at_low > 0 and old.high.compare(new.high) >= 0 else new
                new = Interval(left.low, left.start, right.high, right.end)
        return Cover((*before, new, *after))

    def contains(self, u: Real) -> bool:
        """Whether a parameter is covered."""
        return any(i.low.compare(u) <= 0 and i.high.compare(u) >= 0 for i in self.intervals)

    def covers(self, low: Real, high: Real) -> bool:
        """Whether all of [low, high] is covered."""
        for i in self.intervals:  # noqa: SIM110 - one interval, most often: a generator would cost more
            if i.low.compare(low) <= 0 and i.high.compare(high) >= 0:
                return True
        return False

    def gaps(self, span: Interval) -> Iterator[Interval]:
        """The closures of what is left of an interval, from low to high; no part of the cover juts out."""
        at, place = span.low, span.start
        for i in self.intervals:
            if i.low.compare(span.low) < 0 or i.high.compare(span.high) > 0:
                continue
            if i.low.compare(at) > 0:
                yield Interval(at, place, i.low, i.start)
            at, place = i.high, i.end
        if at.compare(span.high) < 0:
            yield Interval(at, place, span.high, span.end)


EMPTY = Cover()
