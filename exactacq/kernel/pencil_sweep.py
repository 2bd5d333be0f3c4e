"""The sweep of one pencil, as far as floats go.

It finds the events, their order, a line in the middle of each cell and the edges that these lines meet, and
joins cells where these edges are the same. Mostly it does all of this at once. Where something is left open
it stops, until it is told what exact arithmetic says.
"""

from __future__ import annotations

from math import inf, isnan
from typing import Final, final

from exactacq.kernel.bound_lines import BoundLine
from exactacq.kernel.cells import LineCells, clusters, middles, rows
from exactacq.kernel.first_edges import first_edges
from exactacq.kernel.lattice import LatticeLines
from exactacq.kernel.line_events import line_events
from exactacq.kernel.surroundings import Surroundings

EVENTS: Final = 0
"""It is open whether the lines ``unsure`` exist: `order` takes those that do, with exact values."""
ORDER: Final = 1
"""It is open in which order the lines within one of ``clusters`` come: `part` takes all in order."""
MIDDLES: Final = 2
"""Of ``middles`` some are no numbers: `look` takes the errors of all, once these were set."""
EDGES: Final = 3
"""Some cells are in doubt, or cells may differ in kind: `join` takes the kinds, once the edges were set."""
DONE: Final = 4


@final
class PencilSweep:
    """The sweep between two lines: what it found so far, and which step it stands before.

    ``bounds`` are all lines at which something changes; ``behind``, ``ahead`` and ``possible`` are the edges
    met in the cells between them (see `kernel.first_edges`); ``rows`` are the cells, joined; ``pinched`` the
    lines that pass several things.
    """

    def __init__(
        self,
        around: Surroundings,
        low: BoundLine,
        high: BoundLine,
        breaks: list[BoundLine],
        corner: int,
        has_kinds: bool,
        on_lattice: LatticeLines | None,
    ) -> None:
        """*breaks* are further lines that end cells; *corner* is the vertex at the contact, or `NOTHING`.

        What the first and the last line pass already is not passed by others. With *has_kinds* every edge is
        looked at in every cell, and cells are joined only if they are of one kind. *on_lattice* decides the
        order of lines through vertices, if it is known how.
        """
        self.around, self.low, self.high, self.has_kinds = around, low, high, has_kinds
        self._on_lattice = on_lattice
        self.clusters: list[list[BoundLine]] = []
        self.bounds: list[BoundLine] = []
        self.middles: list[float] = []
        self.behind: list[int] = []
        self.ahead: list[int] = []
        self.possible: dict[int, list[int]] = {}
        self.rows: list[LineCells] = []
        self.pinched: list[BoundLine] = []
        self.stage = EVENTS
        first, last = low.low, high.high
        if first == -inf or last == inf:
            first, last = -1.0, 1.0
        self.unsure: list[BoundLine] = []
        self._sure = breaks.copy()
        for event in line_events(around, corner, first, last):
            if event.side == 0 and (event.number == low.number or event.number == high.number):
                continue
            if event.is_sure:
                self._sure.append(event)
            else:
                self.unsure.append(event)
        if not self.unsure:
            self.order([])

    def order(self, found: list[BoundLine]) -> None:
        """Put the lines in order, with those *found* of which it was open whether they exist."""
        self.stage = ORDER
        every = clusters([*self._sure, *found, self.low, self.high], self.low, self.high)
        parted = [cluster if len(cluster) == 1 else self._parted(cluster) for cluster in every]
        if all(len(lines) > 0 for lines in parted):
            self.part([line for lines in parted for line in lines])
            return
        self.clusters = []
        for k in range(len(every)):
            self.clusters += [[line] for line in parted[k]] if parted[k] else [every[k]]

    def _parted(self, cluster: list[BoundLine]) -> list[BoundLine]:
        """The distinct lines of a cluster, in order; none where that stays open."""
        lattice = self._on_lattice
        return [] if lattice is None else lattice.parted(cluster, self.low, self.high)

    def part(self, bounds: list[BoundLine]) -> None:
        """Find a line between each two neighbours."""
        self.stage = MIDDLES
        self.bounds = bounds
        self.middles = middles(bounds)
        for middle in self.middles:
            if isnan(middle):
                return
        self.look([0.0] * len(self.middles))

    def look(self, errors: list[float]) -> None:
        """Find what these lines meet; they are off by *errors*."""
        self.stage = EDGES
        self.behind, self.ahead, self.possible = first_edges(
            self.around, self.middles, errors, self.bounds, self.has_kinds
        )
        if not self.has_kinds and not self.possible:
            self.join([0] * len(self.middles))

    def join(self, kinds: list[int]) -> None:
        """Join the cells that are of one kind and meet the same edges."""
        self.stage = DONE
        self.rows = rows(self.bounds, self.behind, self.ahead, kinds)
        self.pinched = [bound for bound in self.bounds if bound.passes_several]
