"""What a line meets as far as it is free, kept for all features that it touches.

A line along a row grazes feature after feature, and from each of them it meets much the same. A run is found
from one of them; another one reads off it what is within its own reach.
"""

from __future__ import annotations

from typing import NamedTuple

from exactacq.geometry.late import Pin
from exactacq.geometry.points import Point
from exactacq.kernel.extents import Span
from exactacq.kernel.images import STRAIGHT
from exactacq.kernel.single_lines import Spot
from exactacq.scene.edge_table import EdgeTable

SLACK = 1e-9
"""Edges count as met that are farther than the reach by at most this part of it, as floats tell."""


class Hit(NamedTuple):
    """An edge that a line meets: how far along it, in which place, at which vertex or how, and where."""

    along: float
    place: int
    edge: int
    vertex: int
    pin: Pin
    span: Span
    spot: Spot


class RunSide(NamedTuple):
    """What is met on one side of a place, nearest first; whether the line is blocked at the last."""

    hits: list[Hit]
    blocked: bool


class FreeRun:
    """What a line meets: *behind* the place from which it was followed, *here* and *ahead*.

    It is complete up to what blocks it, or else as far as *reach*; *heading* is the line's direction.
    """

    def __init__(
        self,
        table: EdgeTable,
        heading: tuple[float, float],
        behind: RunSide,
        here: list[Hit],
        ahead: RunSide,
        reach: float,
    ) -> None:
        self._table, self._heading, self._reach = table, heading, reach
        self._sides = behind, ahead
        self._hits = [*reversed(behind.hits), *here, *ahead.hits]

    def place_of(self, edges: tuple[int, ...], corner: Point | None) -> Hit | None:
        """Where a feature is met: its *corner*, or an arc where the line touches it. None if it is not."""
        there = (hit for hit in self._hits if hit.edge in edges)
        return next((hit for hit in there if corner is None or hit.pin[0] == corner), None)

    def seen_from(
        self, here: Hit, heading: tuple[float, float], reach: float
    ) -> tuple[RunSide, RunSide] | None:
        """What is met behind a place and ahead of it, as one goes that way; None if it is not all known."""
        # As one goes, what was ahead on the way of the run may be behind.
        onward = 1 if heading[0] * self._heading[0] + heading[1] * self._heading[1] > 0 else -1
        found: list[RunSide] = []
        for role in (-1, 1):
            sense = role * onward
            if not self._sides[sense > 0].blocked and sense * here.along + reach > self._reach:
                return None
            side = self._within(here, sense, reach)
            hits = [hit._replace(place=role * abs(hit.place - here.place)) for hit in side.hits]
            # Edges that are met in one place are always in one order, whichever way the run went.
            hits.sort(key=lambda hit: (abs(hit.place), role * hit.edge))
            found.append(side._replace(hits=hits))
        return found[0], found[1]

    def _within(self, here: Hit, sense: int, reach: float) -> RunSide:
        """What is met on one side within reach, and of the same edges up to where one along the line ends."""

        def away(hit: Hit) -> float:
            return abs(hit.along - here.along)

        side, far, kinds = self._sides[sense > 0], reach * (1 + SLACK), self._table.kinds
        within = {hit.edge for hit in self._hits if away(hit) <= far}
        hits = [hit for hit in self._hits[::sense] if (hit.place - here.place) * sense > 0]
        again = [hit for hit in hits if hit.edge in within]
        limit = max(far, *(away(hit) for hit in again if kinds[hit.edge] == STRAIGHT), 0.0)
        near = [hit for hit in hits if away(hit) <= (limit if hit.edge in within else far)]
        return RunSide(near, side.blocked and len(near) == len(hits))
