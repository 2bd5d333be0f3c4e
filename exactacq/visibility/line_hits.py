"""Where lines cross edges, in floats with certainty flags: the numpy kernel of sweeps and clearance tests.

That a line hits an edge or misses it is proved by margins that are multiples of the table's round-off;
everything else is unsure, and the callers then ask the exact predicates.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exactacq.scene.edge_table import STRAIGHT, EdgeTable, Floats, Ints, quotient


class Crossings:
    """Where lines (rows) cross edges (columns): float parameters with certainty flags.

    ``hit`` and ``unsure`` are the flags; ``enters`` tells that the line, followed ahead, passes from free to
    blocked.
    """

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
        self.edges, self.slack = edges, slack
        kind = table.kind[edges]
        straight, curved = np.flatnonzero(kind == STRAIGHT), np.flatnonzero(kind != STRAIGHT)
        start, end = table.start[edges] - origin, table.end[edges] - origin
        s0, a0 = _frame(start[straight], contact, direction)
        s1, a1 = _frame(end[straight], contact, direction)
        # Negated, so that what is no number is unsure.
        unsure = ~((np.abs(s0) > slack) & (np.abs(s1) > slack))
        enters = s0 > s1
        difference = s1 - s0
        difference[difference == 0] = 1.0
        tau = (a0 * s1 - a1 * s0) / difference
        error = 4 * slack * (1 + quotient(np.abs(a0) + np.abs(a1), np.abs(difference)))
        hit = ((s0 < 0) != (s1 < 0)) & ~unsure
        parts: list[tuple[NDArray[Any], ...]] = [
            (np.broadcast_to(straight, hit.shape), hit, unsure, tau, error, enters)
        ]
        self._reaches = [(a0, a1)]
        if len(curved):
            arcs = edges[curved]
            through = np.isin(arcs, list(own))
            middle, radius = table.center[arcs] - origin, table.radius[arcs]
            g, h = _frame(middle, contact, direction)
            square = np.where(through, h * h, (radius - g) * (radius + g))
            half = np.sqrt(np.maximum(square, 0.0))
            thick = slack * (1 + quotient(4 * radius, half))
            chord = end[curved] - start[curved]
            for sign in (1, -1):
                tau = h + sign * half
                x = contact[:, None, 0] + tau * direction[:, None, 0] - start[curved, 0]
                y = contact[:, None, 1] + tau * direction[:, None, 1] - start[curved, 1]
                side = (chord[:, 0] * y - chord[:, 1] * x) * -kind[curved]
                near = (thick + slack) * (2 * np.hypot(chord[:, 0], chord[:, 1]) + slack)
                hit = table.full[arcs] | (side > near)
                unsure = ~hit & ~(side < -near)
                apart = np.abs(g) > radius + slack
                hit, unsure = hit & ~apart, unsure & ~apart
                touched = ~through & (np.abs(np.abs(g) - radius) <= slack)
                # An arc through the contact meets every line there: that root is no crossing.
                zero = through & (np.abs(tau) <= np.abs(h))
                hit &= ~(touched | zero)
                unsure = ((unsure | touched) & ~zero) | (zero & ~(np.abs(h) > thick))
                enters = np.broadcast_to(sign * kind[curved] < 0, hit.shape)
                parts.append((np.broadcast_to(curved, hit.shape), hit, unsure, tau, 4 * thick, enters))
                self._reaches.append((h - radius - slack, h + radius + slack))
        self.column, self.hit, self.unsure, self.tau, self.error, self.enters = (
            columns[0] if len(columns) == 1 else np.concatenate(columns, axis=1)
            for columns in zip(*parts, strict=True)
        )

    @cached_property
    def _reach(self) -> tuple[Floats, Floats]:
        """Between which parameters a line may meet an edge."""
        low = np.concatenate([np.minimum(*ends) for ends in self._reaches], axis=1)
        return low, np.concatenate([np.maximum(*ends) for ends in self._reaches], axis=1)

    @cached_property
    def _rows(self) -> list[tuple[int | None, int | None] | None]:
        """Per row the edges behind and ahead, or None where the margins leave a doubt.

        An edge that is met from its blocked side stands for one that was left out: no edge then.
        """
        hit, unsure = self.hit, self.unsure
        doubt = (hit & (np.abs(self.tau) <= self.error)).any(axis=1)
        vague = bool(unsure.any())
        chosen = []
        for side in (-1, 1):
            tau = self.tau * side
            forward = hit & (tau > self.error)
            nearest = np.where(forward, tau, np.inf)
            best = nearest.argmin(axis=1)
            rows = np.arange(len(best))
            limit = nearest[rows, best] + self.error[rows, best]
            close = forward & (tau - self.error <= limit[:, None])
            doubt |= close.sum(axis=1) > 1
            if vague:
                low, high = self._reach if side > 0 else [-end for end in self._reach[::-1]]
                near = unsure & (high >= -self.slack) & (low - self.slack <= limit[:, None])
                doubt |= near.any(axis=1)
            proper = forward[rows, best] & (self.enters[rows, best] == (side > 0))
            chosen.append(np.where(proper, self.column[rows, best], -1).tolist())
        return [
            None if doubted else (self._edge(behind), self._edge(ahead))
            for doubted, behind, ahead in zip(doubt.tolist(), *chosen, strict=True)
        ]

    def _edge(self, column: int) -> int | None:
        return int(self.edges[column]) if column >= 0 else None

    def nearest(self, row: int) -> tuple[int | None, int | None] | None:
        """First edge behind and ahead on the line of a row, or None where the margins leave a doubt."""
        return self._rows[row]

    def possible(self, row: int) -> Ints:
        """The edges that the line of a row may meet."""
        return self._at(row, self.hit[row] | self.unsure[row])

    def blocks(self, row: int, size: float) -> bool:
        """Whether some edge certainly crosses the line of a row between 0 and *size*."""
        hit, tau, error = self.hit[row], self.tau[row], self.error[row]
        return bool((hit & (tau > error) & (tau < size - error)).any())

    def doubtful(self, row: int, size: float) -> Ints:
        """The edges that may meet the line of a row between 0 and *size*."""
        tau, error = self.tau[row], self.error[row]
        low, high = (end[row] for end in self._reach)
        hit = self.hit[row] & ~((tau < -error) | (tau > size + error))
        unsure = self.unsure[row] & ~((high < -self.slack) | (low > size + self.slack))
        return self._at(row, hit | unsure)

    def _at(self, row: int, chosen: NDArray[np.bool_]) -> Ints:
        edges: Ints = self.edges[np.unique(self.column[row][chosen])]
        return edges


def _frame(points: Floats, contact: Floats, direction: Floats) -> tuple[Floats, Floats]:
    """Signed distance to the left of each line, and position along it."""
    x = points[None, :, 0] - contact[:, None, 0]
    y = points[None, :, 1] - contact[:, None, 1]
    dx, dy = direction[:, None, 0], direction[:, None, 1]
    return dx * y - dy * x, dx * x + dy * y
