"""The order of directions about a place, and the face that comes first in each, in floats with bounds.

The directions in which faces end divide the full turn into *cells*: cell k lies counterclockwise of
direction k. Boundaries have no point in common, so in a cell faces have the same order along all rays, and
faces that go on together keep it. So the first face of a cell stays the first one until it ends, unless one
that begins lies before it. Where it ends in a vertex in which another one begins, that is the next: all
others are farther away than the vertex.
"""

from __future__ import annotations

from math import inf
from operator import attrgetter
from typing import Final, final

from exactacq.kernel.bounded import TINY, UNIT, WIDEN, cross
from exactacq.kernel.lattice import Lattice, place_among
from exactacq.kernel.radial_faces import Face, FaceEnd, RadialFaces

NOTHING: Final = -1
"""No face within reach."""
BLOCKED: Final = -2
"""Directions into the place's own obstacle."""
DOUBT: Final = -3
"""The margins leave it open."""
WIDE: Final = 1.9
"""Where the keys of a cell's sides differ by more, a quarter turn from its first side is inside."""

NUMBER: Final = attrgetter("number")

Part = tuple[int, int]
"""The numbers of the ends of a closed piece of an edge, in the boundary's direction."""


@final
class FirstFace:
    """A face that comes first from the rank ``low`` to ``high``, counterclockwise; or `NOTHING` or `BLOCKED`.

    All around if the ranks are equal. ``start`` and ``end`` are the numbers of the ends of what is seen of
    it, in the boundary's direction, and ``parts`` what of that is within range, None for all of it: see
    `exactacq.kernel.view_parts`.
    """

    def __init__(self, face: int, low: int, high: int) -> None:
        self.face, self.low, self.high = face, low, high
        self.start = self.end = -1
        self.parts: list[Part] | None = None


@final
class FaceSweep:
    """The sweep about a place, in the steps `look_up`, `order`, `rank`, `look` and `sights`.

    Between them whoever asks decides what the floats leave open: on which side of the east a direction is
    (`look_up`), which of some directions are one (``open``), which face comes first (``doubts``).

    The order is that of *keys*: (x, y) has the key y / (|x| + |y|) in the first quarter, and every quarter
    turn adds 1. Let both components be held with b, and n = |x| + |y|. On the way from what is held to what
    holds it the size is at least n - 2 b, and the key grows by at most b divided by that, as its derivatives
    are y and x divided by the size's square. So the key is held with b / (n - 2 b), and 8 UNIT for the
    roundings, those of its bounds too, unless the way leads over the east, where keys jump from 4 to 0.
    """

    def __init__(self, faces: RadialFaces) -> None:
        self.faces = faces
        self.leads: list[FaceEnd] = []
        """An event of every direction, counterclockwise from the east."""
        self.open: list[tuple[int, list[FaceEnd]]] = []
        """What may be several directions: its place among the leads, and its events."""
        self.first: list[int] = []
        """The first face of every cell, by number."""
        self.doubts: list[int] = []
        self.rivals: list[list[int]] = []
        """Cells where that is open, and the faces that it may be."""

    # -- the order of directions -------------------------------------------------------------------

    def look_up(self) -> list[FaceEnd]:
        """Compute the keys; returns the events whose direction may be on either side of the east."""
        found: list[FaceEnd] = []
        for event in self.faces.events:
            x, y, b = event.x, event.y, event.bound
            size = abs(x) + abs(y)
            room = size - 2.0 * b
            if not room > TINY:
                event.least, event.most = -inf, inf
                continue
            if y >= 0.0:
                key = y / size if x >= 0.0 else 1.0 - x / size
            else:
                key = 2.0 - y / size if x < 0.0 else 3.0 + x / size
            bound = (b / room + 8.0 * UNIT) * WIDEN
            event.least, event.most = key - bound, key + bound
            if x > 0.0 and abs(y) <= b:
                found.append(event)
        return found

    def put(self, event: FaceEnd, upper: bool) -> None:
        """Tell on which side of the east a direction next to it is; the east itself is on the upper one."""
        bound = event.most - event.least
        event.least = 0.0 if upper else 4.0 - bound
        event.most = bound if upper else 4.0

    def order(self) -> None:
        """Order the directions, as far as the keys tell."""
        leads, reached, at_open = self.leads, -inf, -1
        following = _in_order(self.faces.events)
        while following is not None:
            event = following
            following = event.after
            event.after = None
            if event.least > reached or not leads:
                leads.append(event)
                reached = event.most
                continue
            at = len(leads) - 1
            if at != at_open:
                self.open.append((at, [leads[at]]))
                at_open = at
            self.open[-1][1].append(event)
            reached = max(reached, event.most)

    def parted(self, events: list[FaceEnd], lattice: Lattice, center: int) -> list[list[FaceEnd]]:
        """Events by direction about a vertex, as whole numbers tell it, counterclockwise.

        None at all if one of them is no vertex.
        """
        vectors: list[tuple[int, int]] = []
        groups: list[list[FaceEnd]] = []
        for event in sorted(events, key=NUMBER):
            number = event.number
            if number >= len(lattice.x):
                return []
            x, y = lattice.x[number] - lattice.x[center], lattice.y[number] - lattice.y[center]
            at, is_there = place_among(vectors, x, y)
            if is_there:
                groups[at].append(event)
            else:
                vectors.insert(at, (x, y))
                groups.insert(at, [event])
        return groups

    def part(self, at: int, groups: list[list[FaceEnd]]) -> None:
        """Tell which directions an open one is; the last ones first, as their places change."""
        self.leads[at : at + 1] = [group[0] for group in groups]
        for group in groups:
            for k in range(1, len(group)):
                group[k - 1].beside = group[k]

    def rank(self) -> None:
        """Number the directions, after all of them are told apart."""
        leads = self.leads
        for rank in range(len(leads)):
            event: FaceEnd | None = leads[rank]
            while event is not None:
                event.rank = rank
                event = event.beside

    def events(self, rank: int) -> list[FaceEnd]:
        """The events in a direction."""
        found: list[FaceEnd] = []
        event: FaceEnd | None = self.leads[rank]
        while event is not None:
            found.append(event)
            event = event.beside
        return found

    def several(self) -> list[int]:
        """The ranks of directions with more than one event, ascending."""
        return [rank for rank in range(len(self.leads)) if self.leads[rank].beside is not None]

    # -- what comes first --------------------------------------------------------------------------

    def look(self, cone_low: int, cone_high: int) -> None:
        """Find the first face of every cell.

        Between two directions, all around if they are one, the place's own obstacle lies; negative for none.
        """
        faces, leads, first = self.faces.faces, self.leads, self.first
        count = len(leads)
        cells = max(count, 1)
        blocked = 0
        if cone_low >= 0:
            blocked = (cone_high - cone_low) % cells
            if blocked == 0:
                blocked = cells
        # First those of the last cell.
        active: list[Face] = []
        for face in faces:
            low, high = face.low, face.high
            if low is None or high is None:
                _enter(active, face)
            elif low.rank != high.rank:
                low.begins = high.stops = face.number
                if low.rank > high.rank:
                    _enter(active, face)
        near, known = NOTHING, False
        fresh: list[Face] = []
        for rank in range(cells):
            if fresh:
                fresh.clear()
            event = leads[rank] if count else None
            if event is not None and event.stops >= 0 and event.begins >= 0 and event.beside is None:
                # One face goes on as another.
                begun = faces[event.begins]
                begun.at = faces[event.stops].at
                active[begun.at] = begun
                if near == event.stops:
                    near = event.begins
                event = None
            while event is not None:
                if event.stops >= 0:
                    _leave(active, faces[event.stops])
                    known = known and near != event.stops
                if event.begins >= 0:
                    _enter(active, faces[event.begins])
                    fresh.append(faces[event.begins])
                event = event.beside
            if cone_low >= 0 and (rank - cone_low) % cells < blocked:
                first.append(BLOCKED)
                known = False
                continue
            if not known:
                near = self._choose(active, rank)
            elif fresh:
                if near >= 0:
                    fresh.append(faces[near])
                near = self._choose(fresh, rank)
            known = near != DOUBT
            first.append(near)

    def _choose(self, tried: list[Face], cell: int) -> int:
        """The nearest of some faces in a cell, by one ray."""
        if len(tried) < 2:
            return tried[0].number if tried else NOTHING
        found = DOUBT
        dx, dy, sure = self.ray(cell)
        if sure:
            least = rest = inf
            best_low = inf
            for face in tried:
                m, e = self.faces.way(face, dx, dy, 0.0)
                if not e < inf:
                    rest = -inf
                    break
                e = e * WIDEN + UNIT * abs(m)
                low, high = m - e, m + e
                if high < least:
                    rest = min(rest, best_low)
                    found, least, best_low = face.number, high, low
                elif low < rest:
                    rest = low
            if not rest > least:
                found = DOUBT
        if found == DOUBT:
            self.doubts.append(cell)
            self.rivals.append([face.number for face in tried])
        return found

    def ray(self, cell: int) -> tuple[float, float, bool]:
        """A direction, and whether it certainly lies within a cell.

        Of the sum of two directions both vector products tell. A quarter turn adds 1 to a key.
        """
        leads = self.leads
        count = len(leads)
        if count == 0:
            return 1.0, 0.0, True
        is_last = cell + 1 == count
        a, b = leads[cell], leads[0 if is_last else cell + 1]
        gap = b.least - a.most
        if is_last:
            gap += 4.0
        if gap > WIDE:
            return -a.y, a.x, a.most - a.least < 1.0
        n, m = abs(a.x) + abs(a.y), abs(b.x) + abs(b.y)
        if not (n > TINY and m > TINY):
            return 1.0, 0.0, False
        dx, dy = a.x / n + b.x / m, a.y / n + b.y / m
        after, after_bound = cross(a.x, a.y, a.bound, dx, dy, 0.0)
        before, before_bound = cross(dx, dy, 0.0, b.x, b.y, b.bound)
        return dx, dy, after > after_bound and before > before_bound

    def sights(self) -> list[FirstFace]:
        """Cells with the same first face joined, from a change on; empty if there is none."""
        first = self.first
        if not first:
            return []
        found: list[FirstFace] = []
        before = first[len(first) - 1]
        for k in range(len(first)):
            face = first[k]
            if face != before:
                if found:
                    found[len(found) - 1].high = k
                found.append(FirstFace(face, k, k))
                before = face
        if found:
            found[len(found) - 1].high = found[0].low
        return found

    def covering(self, rank: int) -> list[Face]:
        """The faces that cover a direction and do not end there."""
        cells = max(len(self.leads), 1)
        found: list[Face] = []
        for face in self.faces.faces:
            low, high = face.low_rank(), face.high_rank()
            if low < 0 or 0 < (rank - low) % cells < (high - low) % cells:
                found.append(face)
        return found


def _in_order(events: list[FaceEnd]) -> FaceEnd | None:
    """The event whose key is least; from each the next one follows, in ascending order of these bounds.

    A merge sort of chains, for a list is sorted by keys that are objects. The events of one boundary mostly
    come in falling order: then they are a chain to begin with.
    """
    chains: list[FaceEnd] = []
    head: FaceEnd | None = None
    for event in events:
        if head is not None:
            if event.least <= head.least:
                event.after = head
            else:
                chains.append(head)
        head = event
    if head is None:
        return None
    chains.append(head)
    while len(chains) > 1:
        merged: list[FaceEnd] = []
        for k in range(1, len(chains), 2):
            merged.append(_merged(chains[k - 1], chains[k]))
        if len(chains) % 2:
            merged.append(chains[len(chains) - 1])
        chains = merged
    return chains[0]


def _merged(one: FaceEnd, other: FaceEnd) -> FaceEnd:
    """Two chains in one."""
    if other.least < one.least:
        one, other = other, one
    last, left, right = one, one.after, other
    while left is not None:
        if right.least < left.least:
            last.after = right
            last = right
            rest = right.after
            if rest is None:
                last.after = left
                return one
            right = rest
        else:
            last.after = left
            last = left
            left = left.after
    last.after = right
    return one


def _enter(active: list[Face], face: Face) -> None:
    face.at = len(active)
    active.append(face)


def _leave(active: list[Face], face: Face) -> None:
    last = active.pop()
    if last is not face:
        active[face.at] = last
        last.at = face.at
