"""The cells of a pencil: between neighbouring lines at which something is passed, joined where all else is
equal."""

from __future__ import annotations

from math import inf, nan
from operator import attrgetter
from typing import final

from exactacq.kernel.bound_lines import BoundLine


@final
class LineCells:
    """Neighbouring cells as one: the lines that bound them, and the first edges that are met."""

    def __init__(self, first: BoundLine, last: BoundLine, behind: int, ahead: int) -> None:
        self.first, self.last, self.behind, self.ahead = first, last, behind, ahead


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
