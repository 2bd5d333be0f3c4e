"""The cells of a pencil: between neighbouring lines at which something is passed, joined where all else is
equal."""

from __future__ import annotations

from math import inf, nan
from operator import attrgetter
from typing import final

from exactacq.kernel.line_events import Event

Passed = list[tuple[int, int, int]]
"""What a line passes: number (a vertex, or an arc), side and sign of each (see `kernel.line_events`)."""


@final
class BoundLine:
    """A line of a pencil: its parameter lies between ``low`` and ``high``; what it passes; its exact value.

    The value is None where none is made yet. Before those that are equal are brought together, a bound passes
    one thing at most.
    """

    def __init__(self, low: float, high: float, passed: Passed, value: object) -> None:
        self.low, self.high, self.passed, self.value = low, high, passed, value


@final
class LineCells:
    """Neighbouring cells as one: the lines that bound them, and the first edges that are met."""

    def __init__(self, first: BoundLine, last: BoundLine, behind: int, ahead: int) -> None:
        self.first, self.last, self.behind, self.ahead = first, last, behind, ahead


def sure_bounds(events: list[Event], first: int, last: int) -> list[BoundLine]:
    """The lines of those events that certainly are there, but for two vertices that others stand for."""
    return [
        BoundLine(low, high, [(number, side, sign)], None)
        for low, high, number, side, sign, sure in events
        if sure and (side or (number != first and number != last))
    ]


def clusters(bounds: list[BoundLine], start: BoundLine, stop: BoundLine) -> list[list[BoundLine]]:
    """The bounds in order, from that with *start* to that with *stop*; those of which it is open together."""
    found: list[list[BoundLine]] = []
    reached = -inf
    cluster: list[BoundLine] = []
    has_started = has_stopped = False
    for bound in sorted(bounds, key=attrgetter("low")):
        if cluster and bound.low > reached:
            if has_started:
                found.append(cluster)
            if has_stopped:
                return found
            cluster = []
        reached = max(reached, bound.high) if cluster else bound.high
        cluster.append(bound)
        has_started = has_started or bound is start
        has_stopped = has_stopped or bound is stop
    if cluster and has_started:
        found.append(cluster)
    return found


def middles(bounds: list[BoundLine]) -> list[float]:
    """A number between each two neighbours, no number (NaN) where floats do not part them."""
    found: list[float] = []
    for k in range(len(bounds) - 1):
        a, b = bounds[k].high, bounds[k + 1].low
        middle = 0.5 * (a + b)
        found.append(middle if a < middle < b else nan)
    return found


def rows(bounds: list[BoundLine], behind: list[int], ahead: list[int], kinds: list[int]) -> list[LineCells]:
    """Cells joined where the edges met are the same, and what else tells them apart, their *kinds*."""
    found: list[LineCells] = []
    for k in range(len(behind)):
        if k and behind[k] == behind[k - 1] and ahead[k] == ahead[k - 1] and kinds[k] == kinds[k - 1]:
            found[-1].last = bounds[k + 1]
        else:
            found.append(LineCells(bounds[k], bounds[k + 1], behind[k], ahead[k]))
    return found
