"""Which edges the lines of a family meet first behind and ahead of the contact, in floats with bounds.

Cells follow one another between events, and in each a line at its middle stands for all. Whether a line
crosses an edge changes only where it passes an end of the edge or becomes tangent to it. So an edge is looked
at again only after an event of its own, and the nearest crossing stays the nearest until its own edge has an
event or another crossing appears: crossings of different edges never change their order, as edges do not
cross. A tangency to a concave arc, or to an arc through the contact, is no event; these are looked at in
every cell.
"""

from __future__ import annotations

from math import inf
from typing import Final, final

from exactacq.kernel.bound_lines import NOTHING, BoundLine
from exactacq.kernel.bounded import UNIT, WIDEN
from exactacq.kernel.crossings import VAGUE, EdgeStates
from exactacq.kernel.images import CONCAVE
from exactacq.kernel.surroundings import THROUGH, FrameLine, Surroundings

DOUBT: Final = -2
"""The margins leave open which edge is met; `NOTHING`: none, or one that is met from its blocked side and
stands for one that was left out."""


def first_edges(
    around: Surroundings,
    middles: list[float],
    errors: list[float],
    bounds: list[BoundLine],
    always: bool,
) -> tuple[list[int], list[int], dict[int, list[int]]]:
    """For each cell the first edge behind and the one ahead; for each in `DOUBT` what may be met at all.

    Each cell follows one of *bounds*. With *always* every edge is looked at in every cell.
    """
    behind: list[int] = []
    ahead: list[int] = []
    possible: dict[int, list[int]] = {}
    walk = EdgeWalk(EdgeStates(around))
    for cell in range(len(middles)):
        line = FrameLine(around, middles[cell], errors[cell])
        fresh = always or cell == 0
        sure = walk.start(line) if fresh else walk.step(walk.concerned(bounds[cell]), line)
        behind.append(walk.met_behind() if sure else DOUBT)
        ahead.append(walk.met_ahead() if sure else DOUBT)
        if not sure:
            possible[cell] = [around.near.edges[j] for j in walk.active]
    return behind, ahead, possible


@final
class EdgeWalk:
    """The state of a walk from cell to cell: what is crossed, and the nearest crossings if they are known."""

    def __init__(self, states: EdgeStates) -> None:
        self.states, self.around = states, states.around
        near, images = self.around.near, self.around.images
        self.unsteady = [
            j for j in near.arcs if images[near.edges[j]].kind == CONCAVE or self.around.place[j] == THROUGH
        ]
        self.active: list[int] = []
        self.vague: list[int] = []
        self.known = False
        # The edges of the nearest crossings, -1 for none, and their roots.
        self.behind, self.behind_root = -1, 0
        self.ahead, self.ahead_root = -1, 0

    def concerned(self, bound: BoundLine) -> list[int]:
        """The numbers of the edges that have an event at a line."""
        found: list[int] = []
        if bound.number != NOTHING:
            self._concern(found, bound.number, bound.side)
            if bound.others is not None:
                for number, side, _ in bound.others:
                    self._concern(found, number, side)
        return found

    def _concern(self, found: list[int], number: int, side: int) -> None:
        near = self.around.near
        j = near.edge(number)
        if j >= 0:
            found.append(j)
        if side == 0:
            j = near.edge(self.around.images[number].previous)
            if j >= 0:
                found.append(j)

    def start(self, line: FrameLine) -> bool:
        """Look at all edges; whether the nearest crossings are certain."""
        states = self.states.look_at_all(line)
        self.states.state = states
        self.active = [j for j, state in enumerate(states) if state]
        self.vague = [j for j in self.active if states[j] == VAGUE]
        self.known = not self.vague and self._choose(self.active, line)
        return self.known

    def step(self, events: list[int], line: FrameLine) -> bool:
        """Look at the edges that have an event before this cell, and at others that may have changed."""
        changed = events + self.vague + self.unsteady if self.vague or self.unsteady else events
        self._look(changed, line)
        if self.vague:
            self.known = False
            return False
        state, behind, ahead = self.states.state, self.behind, self.ahead
        if behind >= 0 and (behind in events or not state[behind] & self.behind_root):
            self.known = False
        if ahead >= 0 and (ahead in events or not state[ahead] & self.ahead_root):
            self.known = False
        if not self.known:
            self.known = self._choose(self.active, line)
            return self.known
        tried: list[int] = []
        for j in changed:
            if state[j] and j != behind and j != ahead and not self._is_beyond(j):
                tried.append(j)
        if tried:
            # Otherwise nothing has come in front of the nearest.
            if behind >= 0:
                tried.append(behind)
            if ahead >= 0:
                tried.append(ahead)
            self.known = self._choose(tried, line)
        return self.known

    def _is_beyond(self, j: int) -> bool:
        """Whether an edge is surely crossed farther away than the nearest on its side: it needs no line."""
        low, high = self.states.span(j)
        if self.ahead >= 0 and low > self.states.span(self.ahead)[1]:
            return True
        return self.behind >= 0 and high < self.states.span(self.behind)[0]

    def met_behind(self) -> int:
        """The edge of the nearest crossing behind, if an obstacle is entered there going back."""
        j = self.behind
        return (
            self.around.near.edges[j] if j >= 0 and not self.states.enters(j, self.behind_root) else NOTHING
        )

    def met_ahead(self) -> int:
        """The edge of the nearest crossing ahead, if an obstacle is entered there."""
        j = self.ahead
        return self.around.near.edges[j] if j >= 0 and self.states.enters(j, self.ahead_root) else NOTHING

    def _look(self, changed: list[int], line: FrameLine) -> None:
        states = self.states
        self.vague = []
        for j in changed:
            old, new = states.state[j], states.look(j, line)
            if new != old:
                states.state[j] = new
                if old == 0:
                    self.active.append(j)
                elif new == 0:
                    self.active.remove(j)
            if new == VAGUE:
                self.vague.append(j)

    def _choose(self, tried: list[int], line: FrameLine) -> bool:
        """Find the nearest crossing on either side among those of some edges; False if it is not certain."""
        states = self.states
        ahead, ahead_root, behind, behind_root = -1, 0, -1, 0
        # The interval of the nearest one's distance, and the least that another one's may be.
        ahead_low = ahead_high = ahead_rest = inf
        behind_low = behind_high = behind_rest = inf
        for j in tried:
            state = states.state[j]
            for which in range(1, 3):
                if not state & which:
                    continue
                m, e = states.place(j, which, line)
                e = e * WIDEN + UNIT * abs(m)
                if m > e:
                    low, high = m - e, m + e
                    if high < ahead_high:
                        ahead_rest = min(ahead_rest, ahead_low)
                        ahead_low, ahead_high, ahead, ahead_root = low, high, j, which
                    elif low < ahead_rest:
                        ahead_rest = low
                elif -m > e:
                    low, high = -m - e, e - m
                    if high < behind_high:
                        behind_rest = min(behind_rest, behind_low)
                        behind_low, behind_high, behind, behind_root = low, high, j, which
                    elif low < behind_rest:
                        behind_rest = low
                else:
                    return False
        if (ahead >= 0 and not ahead_rest > ahead_high) or (behind >= 0 and not behind_rest > behind_high):
            return False
        self.behind, self.behind_root = behind, behind_root
        self.ahead, self.ahead_root = ahead, ahead_root
        return True
