"""The order of directions about a place, and the face that comes first in each, in floats with bounds.

The directions in which faces end divide the full turn into *cells*: cell k lies counterclockwise of
direction k. Boundaries have no point in common, so in a cell faces have the same order along all rays, and
faces that go on together keep it. So the first face of a cell stays the first one until it ends, unless one
that begins lies before it. Where it ends in a vertex in which another one begins, that is the next: all
others are farther away than the vertex.
"""

from __future__ import annotations

from math import inf
from typing import Final, final

from exactacq.kernel.bounded import TINY, UNIT, WIDEN, cross
from exactacq.kernel.lattice import Lattice, place_among
from exactacq.kernel.radial_faces import RadialFaces

NOTHING: Final = -1
"""No face within reach."""
BLOCKED: Final = -2
"""Directions into the place's own obstacle."""
DOUBT: Final = -3
"""The margins leave it open."""
WIDE: Final = 1.9
"""Where the keys of a cell's sides differ by more, a quarter turn from its first side is inside."""


@final
class FaceSweep:
    """The sweep about a place, in the steps `look_up`, `group`, `rank`, `look` and `sights`.

    Between them whoever asks decides what the floats leave open: on which side of the east a direction is
    (`look_up`), which directions of a group are one (``open_groups``), which face comes first (``doubts``).

    The order is that of *keys*: (x, y) has the key y / (|x| + |y|) in the first quarter, and every quarter
    turn adds 1. Let both components be held with b, and n = |x| + |y|. On the way from what is held to what
    holds it the size is at least n - 2 b, and the key grows by at most b divided by that, as its derivatives
    are y and x divided by the size's square. So the key is held with b / (n - 2 b), and 8 UNIT for the
    roundings, those of its bounds too, unless the way leads over the east, where keys jump from 4 to 0.
    """

    def __init__(self, faces: RadialFaces) -> None:
        self.faces = faces
        # Bounds of the keys, by slot.
        self.least: list[float] = []
        self.most: list[float] = []
        # Slots by direction, counterclockwise from the east, and the numbers of groups that may be several.
        self.groups: list[list[int]] = []
        self.open_groups: list[int] = []
        # The ranks of the slots, and of the directions in which faces end.
        self.ranks: list[int] = []
        self.low: list[int] = []
        self.high: list[int] = []
        # The first face of every cell; cells where it is open, and the faces that it may be.
        self.first: list[int] = []
        self.doubts: list[int] = []
        self.rivals: list[list[int]] = []

    # -- the order of directions -------------------------------------------------------------------

    def look_up(self) -> list[int]:
        """Compute the keys; returns the slots whose direction may be on either side of the east."""
        faces, least, most = self.faces, self.least, self.most
        events, given = faces.events, faces.given
        found: list[int] = []
        for k in range(len(events)):
            x, y, b = faces.vector(k) if given else faces.offset(events[k])
            size = abs(x) + abs(y)
            room = size - 2.0 * b
            if not room > TINY:
                least.append(-inf)
                most.append(inf)
                continue
            if y >= 0.0:
                key = y / size if x >= 0.0 else 1.0 - x / size
            else:
                key = 2.0 - y / size if x < 0.0 else 3.0 + x / size
            bound = (b / room + 8.0 * UNIT) * WIDEN
            least.append(key - bound)
            most.append(key + bound)
            if x > 0.0 and abs(y) <= b:
                found.append(k)
        return found

    def put(self, k: int, upper: bool) -> None:
        """Tell on which side of the east a direction next to it is; the east itself is on the upper one."""
        bound = self.most[k] - self.least[k]
        self.least[k] = 0.0 if upper else 4.0 - bound
        self.most[k] = bound if upper else 4.0

    def group(self) -> None:
        """Group the slots by direction: those in a group may be one."""
        least, most, groups = self.least, self.most, self.groups
        reached = -inf
        for k in sorted(range(len(least)), key=least.__getitem__):
            if least[k] > reached or not groups:
                groups.append([k])
                reached = most[k]
            else:
                if len(groups[-1]) == 1:
                    self.open_groups.append(len(groups) - 1)
                groups[-1].append(k)
                reached = max(reached, most[k])

    def parted(self, slots: list[int], lattice: Lattice, center: int) -> list[list[int]]:
        """The slots of a group by direction about a vertex, as whole numbers tell it, counterclockwise.

        None at all if one of them is no vertex.
        """
        events = self.faces.events
        vectors: list[tuple[int, int]] = []
        groups: list[list[int]] = []
        for event, k in sorted([(events[k], k) for k in slots]):
            if event >= len(lattice.x):
                return []
            x, y = lattice.x[event] - lattice.x[center], lattice.y[event] - lattice.y[center]
            at, is_there = place_among(vectors, x, y)
            if is_there:
                groups[at].append(k)
            else:
                vectors.insert(at, (x, y))
                groups.insert(at, [k])
        return groups

    def rank(self) -> None:
        """Number the directions, after every group is one."""
        faces, groups = self.faces, self.groups
        self.ranks = ranks = [0] * len(faces.events)
        for rank in range(len(groups)):
            for k in groups[rank]:
                ranks[k] = rank
        self.low = [ranks[k] if k >= 0 else -1 for k in faces.low]
        self.high = [ranks[k] if k >= 0 else -1 for k in faces.high]

    def several(self) -> list[int]:
        """The ranks of directions with more than one event."""
        return [rank for rank in range(len(self.groups)) if len(self.groups[rank]) > 1]

    # -- what comes first --------------------------------------------------------------------------

    def look(self, cone_low: int, cone_high: int) -> None:
        """Find the first face of every cell.

        Between two directions, all around if they are one, the place's own obstacle lies; negative for none.
        """
        faces, groups = self.faces, self.groups
        count = len(groups)
        cells = max(count, 1)
        blocked = 0
        if cone_low >= 0:
            blocked = (cone_high - cone_low) % cells
            if blocked == 0:
                blocked = cells
        begins, stops = [-1] * len(faces.events), [-1] * len(faces.events)
        # First those of the last cell.
        active: list[int] = []
        for f in range(len(faces.edge)):
            if self.low[f] != self.high[f]:
                begins[faces.low[f]] = f
                stops[faces.high[f]] = f
            if self.low[f] > self.high[f] or faces.low[f] < 0:
                active.append(f)
        known, near = False, NOTHING
        for rank in range(cells):
            fresh: list[int] = []
            for k in groups[rank] if count else fresh:
                f, g = stops[k], begins[k]
                if f >= 0 and g >= 0 and len(groups[rank]) == 1:
                    active[active.index(f)] = g
                    if near == f:
                        near = g
                    break
                if f >= 0:
                    active.remove(f)
                    if near == f:
                        known = False
                if g >= 0:
                    fresh.append(g)
                    active.append(g)
            if cone_low >= 0 and (rank - cone_low) % cells < blocked:
                self.first.append(BLOCKED)
                known = False
                continue
            if not known:
                near = self._choose(active, rank)
            elif fresh:
                if near >= 0:
                    fresh.append(near)
                near = self._choose(fresh, rank)
            known = near != DOUBT
            self.first.append(near)

    def _choose(self, tried: list[int], cell: int) -> int:
        """The nearest of some faces in a cell, by one ray."""
        if len(tried) < 2:
            return tried[0] if tried else NOTHING
        found = DOUBT
        dx, dy, sure = self.ray(cell)
        if sure:
            least = rest = inf
            best_low = inf
            for f in tried:
                m, e = self.faces.way(f, dx, dy, 0.0)
                if not e < inf:
                    rest = -inf
                    break
                e = e * WIDEN + UNIT * abs(m)
                low, high = m - e, m + e
                if high < least:
                    rest = min(rest, best_low)
                    found, least, best_low = f, high, low
                elif low < rest:
                    rest = low
            if not rest > least:
                found = DOUBT
        if found == DOUBT:
            self.doubts.append(cell)
            self.rivals.append(tried.copy())
        return found

    def ray(self, cell: int) -> tuple[float, float, bool]:
        """A direction, and whether it certainly lies within a cell.

        Of the sum of two directions both vector products tell. A quarter turn adds 1 to a key.
        """
        faces, groups = self.faces, self.groups
        count = len(groups)
        if count == 0:
            return 1.0, 0.0, True
        a, b = groups[cell][0], groups[(cell + 1) % count][0]
        ax, ay, p = faces.vector(a)
        bx, by, q = faces.vector(b)
        gap = self.least[b] - self.most[a] if cell + 1 < count else self.least[b] - self.most[a] + 4.0
        if gap > WIDE:
            return -ay, ax, self.most[a] - self.least[a] < 1.0
        n, m = abs(ax) + abs(ay), abs(bx) + abs(by)
        if not (n > TINY and m > TINY):
            return 1.0, 0.0, False
        dx, dy = ax / n + bx / m, ay / n + by / m
        after, after_bound = cross(ax, ay, p, dx, dy, 0.0)
        before, before_bound = cross(dx, dy, 0.0, bx, by, q)
        return dx, dy, after > after_bound and before > before_bound

    def sights(self) -> list[tuple[int, int, int]]:
        """Cells with the same first face joined: (face, rank of its low side, of its high side).

        They begin at a change; empty if there is none.
        """
        first = self.first
        changes = [k for k in range(len(first)) if first[k] != first[k - 1]]
        count = len(changes)
        return [(first[changes[k]], changes[k], changes[(k + 1) % count]) for k in range(count)]

    def covering(self, rank: int) -> list[int]:
        """The faces that cover a direction and do not end there."""
        cells = max(len(self.groups), 1)
        found: list[int] = []
        for f in range(len(self.low)):
            low, high = self.low[f], self.high[f]
            if low < 0 or 0 < (rank - low) % cells < (high - low) % cells:
                found.append(f)
        return found
