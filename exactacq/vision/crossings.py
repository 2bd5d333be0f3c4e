"""Where lines cross edges, in floats with certainty flags: the numpy kernel of sweeps and clearance tests.

A flag HIT or MISSED is proved by margins that are multiples of the table's round-off; everything else is
UNSURE, and the callers then ask the exact predicates.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from exactacq.vision.table import STRAIGHT, EdgeTable, Floats, Ints

MISSED, UNSURE, HIT = 0, 1, 2


class Crossings:
    """Where lines (rows) cross edges (columns): float parameters with certainty flags."""

    def __init__(
        self,
        table: EdgeTable,
        edges: Ints,
        own: tuple[int, ...],
        origin: Floats,
        contact: Floats,
        direction: Floats,
        slack: float,
    ) -> None:
        self.edges = edges
        kind = table.kind[edges]
        straight, curved = np.flatnonzero(kind == STRAIGHT), np.flatnonzero(kind != STRAIGHT)
        start, end = table.start[edges] - origin, table.end[edges] - origin
        s0, a0 = _frame(start[straight], contact, direction)
        s1, a1 = _frame(end[straight], contact, direction)
        difference = np.where(s1 == s0, 1.0, s1 - s0)
        sure = (np.abs(s0) > slack) & (np.abs(s1) > slack)
        state = np.where(sure, np.where(s0 * s1 < 0, HIT, MISSED), UNSURE)
        tau = (a0 * s1 - a1 * s0) / difference
        error = 4 * slack * (1 + (np.abs(a0) + np.abs(a1)) / np.maximum(np.abs(difference), 1e-300))
        inward = np.where(s0 > s1, 1, -1)
        parts = [(straight, state, tau, error, np.minimum(a0, a1), np.maximum(a0, a1), inward)]
        if len(curved):
            arcs = edges[curved]
            through = np.isin(arcs, list(own))
            middle, radius = table.center[arcs] - origin, table.radius[arcs]
            g, h = _frame(middle, contact, direction)
            square = np.where(through, h * h, (radius - g) * (radius + g))
            half = np.sqrt(np.maximum(square, 0.0))
            thick = slack * (1 + 4 * radius / np.maximum(half, 1e-300))
            chord = end[curved] - start[curved]
            for sign in (1, -1):
                tau = h + sign * half
                x = contact[:, None, 0] + tau * direction[:, None, 0] - start[curved, 0]
                y = contact[:, None, 1] + tau * direction[:, None, 1] - start[curved, 1]
                side = (chord[:, 0] * y - chord[:, 1] * x) * -kind[curved]
                near = (thick + slack) * (2 * np.hypot(chord[:, 0], chord[:, 1]) + slack)
                on = np.where(table.full[arcs] | (side > near), HIT, np.where(side < -near, MISSED, UNSURE))
                state = np.where(np.abs(g) > radius + slack, MISSED, on)
                state = np.where(~through & (np.abs(np.abs(g) - radius) <= slack), UNSURE, state)
                # An arc through the contact meets every line there: that root is no crossing.
                zero = through & (np.abs(tau) <= np.abs(h))
                state = np.where(zero, np.where(np.abs(h) > thick, MISSED, UNSURE), state)
                inward = np.broadcast_to(-sign * kind[curved], state.shape)
                parts.append((curved, state, tau, 4 * thick, h - radius - slack, h + radius + slack, inward))
        columns = [np.broadcast_to(p[0], p[1].shape) for p in parts]
        self.column = np.concatenate(columns, axis=1)
        self.state = np.concatenate([p[1] for p in parts], axis=1)
        self.tau = np.concatenate([p[2] for p in parts], axis=1)
        self.error = np.concatenate([np.broadcast_to(p[3], p[1].shape) for p in parts], axis=1)
        self.low = np.concatenate([p[4] for p in parts], axis=1)
        self.high = np.concatenate([p[5] for p in parts], axis=1)
        # 1 where the line, followed ahead, passes from free to blocked.
        self.inward = np.concatenate([p[6] for p in parts], axis=1)
        self.slack = slack

    @cached_property
    def _rows(self) -> list[tuple[int | None, int | None] | None]:
        """Per row the edges behind and ahead, or None where the margins leave a doubt.

        An edge that is met from its blocked side stands for one that was left out: no edge then.
        """
        hit, unsure = self.state == HIT, self.state == UNSURE
        doubt = (hit & (np.abs(self.tau) <= self.error)).any(axis=1)
        chosen = []
        sides = ((-self.tau, -self.high, -self.low, -1), (self.tau, self.low, self.high, 1))
        for tau, low, high, inward in sides:
            forward = hit & (tau > self.error)
            nearest = np.where(forward, tau, np.inf)
            best = nearest.argmin(axis=1)
            rows = np.arange(len(best))
            limit = nearest[rows, best] + self.error[rows, best]
            close = forward & (tau - self.error <= limit[:, None])
            doubt |= close.sum(axis=1) > 1
            vague = unsure & (high >= -self.slack) & (low - self.slack <= limit[:, None])
            doubt |= vague.any(axis=1)
            proper = forward.any(axis=1) & (self.inward[rows, best] == inward)
            chosen.append(np.where(proper, self.column[rows, best], -1))
        return [
            None if doubt[k] else (self._edge(chosen[0][k]), self._edge(chosen[1][k]))
            for k in range(len(doubt))
        ]

    def _edge(self, column: int) -> int | None:
        return int(self.edges[column]) if column >= 0 else None

    def nearest(self, row: int) -> tuple[int | None, int | None] | None:
        """First edge behind and ahead on the line of a row, or None where the margins leave a doubt."""
        return self._rows[row]

    def possible(self, row: int) -> Ints:
        """The edges that the line of a row may meet."""
        return self._at(row, self.state[row] != MISSED)

    def blocks(self, row: int, size: float) -> bool:
        """Whether some edge certainly crosses the line of a row between 0 and *size*."""
        hit, tau, error = self.state[row] == HIT, self.tau[row], self.error[row]
        return bool((hit & (tau > error) & (tau < size - error)).any())

    def doubtful(self, row: int, size: float) -> Ints:
        """The edges that may meet the line of a row between 0 and *size*."""
        state, tau, error = self.state[row], self.tau[row], self.error[row]
        away = (state == HIT) & ((tau < -error) | (tau > size + error))
        away |= (state == UNSURE) & ((self.high[row] < -self.slack) | (self.low[row] > size + self.slack))
        return self._at(row, ~away & (state != MISSED))

    def _at(self, row: int, chosen: NDArray[np.bool_]) -> Ints:
        edges: Ints = self.edges[np.unique(self.column[row][chosen])]
        return edges


def _frame(points: Floats, contact: Floats, direction: Floats) -> tuple[Floats, Floats]:
    """Signed distance to the left of each line, and position along it."""
    x = points[None, :, 0] - contact[:, None, 0]
    y = points[None, :, 1] - contact[:, None, 1]
    dx, dy = direction[:, None, 0], direction[:, None, 1]
    return dx * y - dy * x, dx * x + dy * y
