"""Intervals of a leg and of the edges that are seen from it, in extended numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from typing import final

from exactacq.kernel.extents import NOTHING, Span

Known = Mapping[int, Sequence[Span]]
"""What is known of edges, by their numbers, rounded inward."""


@final
class LegSpan:
    """A leg, by bounds of the parameters of both its ends; the robot walks it *ahead* or back."""

    def __init__(self, low: Span, high: Span, ahead: bool = True) -> None:
        self.low, self.high, self.ahead = low, high, ahead

    def contains(self, source: Span) -> bool:
        """Whether all of an interval surely lies in the leg."""
        return self.low[1] <= source[0] and source[1] <= self.high[0]

    def outer(self, source: Span) -> Span:
        """What of an interval may lie in the leg; the ends of the leg are infinite."""
        low, high = source
        if high < self.low[0] or low > self.high[1]:
            return NOTHING
        if high == -inf or low == inf:
            return source
        return -inf if low <= self.low[1] else low, inf if high >= self.high[0] else high

    def inner(self, surely: Span) -> Span:
        """What of an interval, rounded inward, surely lies in the leg; ends as above."""
        first, last = surely
        if first > last or last < self.low[1] or first > self.high[0]:
            return NOTHING
        return -inf if first <= self.low[0] else first, inf if last >= self.high[1] else last


def is_covered(shown: Span, spans: list[Span]) -> bool:
    """Whether intervals together contain all of one."""
    low, high = shown
    for a, b in sorted(spans):
        if a > low:
            return False
        if b >= high:
            return True
        low = max(low, b)
    return False
