"""The search for a shortest path: best first, with tangents made when they are tried.

A *label* is a way to come to an entry (see `exactacq.visibility.pegs`): at a corner or a place the shortest
one, on an arc one for each tangent that comes to it. From a label the path goes on along the arc and then a
tangent. Each is tried in the order of a proven lower bound of the whole path: what leads to the label, the
arc, the tangent, and the straight line from there to the goal. So what is tried last is never made, and of
what is made most is found blocked by floats. Lengths are balls; where two overlap, exact lengths decide. The
search ends when every bound that is left is above the length of a path to the goal. All paths of that length
are found: a label keeps each equally short way to it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from heapq import heappop, heappush
from itertools import count
from math import inf, pi

import numpy as np
from flint import arb

from exactacq.cached import cached_property
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.length import Length
from exactacq.scene.edge_table import Floats
from exactacq.visibility.pegs import Peg
from exactacq.visibility.tangents import ROUNDINGS, Tangents

BITS = 64
WALKED, FROM_START = -1, -2
"""Tails of labels to which no tangent leads: a walk comes to an arc at its end, or begins within it."""


@dataclass(frozen=True, slots=True)
class TautWay:
    """The pieces from a label to the next, with their lengths."""

    source: Label
    pieces: tuple[tuple[Curve, Length], ...]


@dataclass(eq=False)
class Label:
    """A shortest way to a contact of an entry; ``ways`` are all that are equally short.

    ``tail`` is the entry that the tangent there comes from, or one of `WALKED` and `FROM_START`: labels of
    one arc with the same tail have the same contact. ``turn`` is the angle from the start of an arc to the
    contact, off by ``slack``. A path that starts on an arc leaves it ``beyond`` the contact, or else from the
    place itself. ``ball`` holds the length.
    """

    entry: int
    contact: Point
    tail: int
    ways: list[TautWay]
    ball: arb
    turn: float = 0.0
    slack: float = 0.0
    beyond: bool = False
    superseded: bool = field(default=False, init=False)

    @cached_property
    def bounds(self) -> tuple[float, float]:
        """Floats below and above the length."""
        middle, error = float(self.ball.mid()), float(self.ball.rad())
        error = margin(error * (1 + 2.0**-40) + 2.0**-50 * abs(middle))
        return middle - error, middle + error

    @cached_property
    def length(self) -> Length:
        """The exact length."""
        lengths, label = list[Length](), self
        while label.ways:
            lengths += [length for _, length in label.ways[0].pieces]
            label = label.ways[0].source
        return Length.sum(lengths)

    def compare(self, other: Label) -> int:
        """-1, 0 or 1 as it is shorter than another, equally long, or longer."""
        (low, high), (least, most) = self.bounds, other.bounds
        if high < least:
            return -1
        return 1 if low > most else self.length.compare(other.length)


class PathSearch:
    """The shortest paths between two places, by the tangents of a scene's own pegs."""

    def __init__(self, tangents: Tangents, start: Point, goal: Point) -> None:
        self.tangents = tangents.with_places((start, goal))
        self.pegs = self.tangents.pegs
        self._start, self._goal = (self.pegs.entry(peg, 0) for peg in self.pegs.pegs[-2:])
        self.goal: Label | None = None
        self._order = count()
        self._heap: list[tuple[float, int, Iterator[float]]] = []
        self._labels: dict[int, list[Label]] = {}

    def run(self) -> Label | None:
        """The label of the goal; None if it cannot be reached."""
        self._arrive(Label(self._start, self.pegs.entries[self._start][0].center, -1, [], arb(0)))
        while self._heap:
            bound, _, tries = heappop(self._heap)
            if self.goal is not None and bound > self.goal.bounds[1]:
                break
            self._push(tries)
        return self.goal

    def _push(self, tries: Iterator[float]) -> None:
        """Let tries go on: each makes one, and gives the bound of the next."""
        bound = next(tries, None)
        if bound is not None:
            heappush(self._heap, (bound, next(self._order), tries))

    # -- what a label leads to -----------------------------------------------------------------------

    def _tries(self, label: Label) -> Iterator[float]:
        """Goes on from a label, best first; gives the bound of what comes next."""
        yield label.bounds[0] + float(self._straight(np.array([label.contact.xy]), 0.0)[0])
        if label.superseded:
            return
        self._walk(label)
        bounds = self._bounds(label)
        for k in np.argsort(bounds, kind="stable").tolist():
            if bounds[k] == inf:
                return
            yield float(bounds[k])
            if label.superseded:
                return
            self._try(label, k)

    def _straight(self, points: Floats, blur: Floats | float) -> Floats:
        """Lower bounds of the distances from points, held with errors, to the goal."""
        far = np.hypot(*(points - self.pegs.rows.centers[self._goal]).T)
        room = far * (1 - 2.0**-50) - blur - margin(2.0**-49 * self.pegs.largest)
        bounds: Floats = np.maximum(np.nan_to_num(room, nan=0.0, neginf=0.0), 0.0)
        return bounds

    def _bounds(self, label: Label) -> Floats:
        """Lower bounds of whole paths that leave a label for other entries; infinite where none does."""
        beams, low = self.tangents.beams(label.entry), label.bounds[0]
        peg, side = self.pegs.entries[label.entry]
        bounds = low + beams.low + self._straight(beams.end, beams.blur)
        if peg.arc is not None:
            turned = side * (beams.turn - label.turn)
            slack = beams.slack + label.slack + ROUNDINGS
            if peg.arc.full:
                turned = np.mod(turned, 2 * pi)
                turned = np.where(turned > 2 * pi - slack, 0.0, turned)
            least = np.maximum(np.nan_to_num(turned - slack, nan=0.0, neginf=0.0), 0.0)
            bounds = bounds + least * (float(peg.radius) * (1 - ROUNDINGS))
            if not peg.arc.full:
                bounds[turned < -slack] = inf
        proven: Floats = np.where(bounds >= low, bounds * (1 - 2.0**-49), low)
        return proven

    def _try(self, label: Label, k: int) -> None:
        """Follow a tangent from a label, if it is free."""
        beams = self.tangents.beams(label.entry)
        low, j = label.bounds[0] + float(beams.low[k]), int(beams.entries[k])
        peg, _ = self.pegs.entries[j]
        if peg.arc is None and any(low > known.bounds[1] for known in self._at(peg)):
            return
        tangent = self.tangents.between(label.entry, j)
        if tangent is None:
            return
        pieces: list[tuple[Curve, Length]] = []
        own, _ = self.pegs.entries[label.entry]
        if own.arc is not None:
            arc = self._along(label, tangent.start, float(beams.turn[k]), float(beams.slack[k]))
            if arc is None:
                return
            pieces += [(piece, piece.length) for piece in arc]
        pieces.append((tangent.curve, Length(tangent.length)))
        turn, slack = float(beams.arrival[k]), float(beams.slack[k])
        self._go(label, tuple(pieces), j, tangent.end, label.entry, turn, slack)

    def _walk(self, label: Label) -> None:
        """Go on along the boundary: from a corner or the start to its arcs, along an arc to its end."""
        peg, side = self.pegs.entries[label.entry]
        if peg.arc is None:
            for onward, sense in self._arcs_from(label):
                self._step(label, (), onward, sense, label.contact, beyond=not side)
            return
        goal, _ = self.pegs.entries[self._goal]
        if peg.edges[0] in goal.edges and peg.arc.contains(goal.center):
            for piece in self._along(label, goal.center, 0.0, inf, beyond=True) or ():
                self._go(label, ((piece, piece.length),), self._goal, goal.center, label.entry)
        following = peg.after if side > 0 else peg.before
        if following is not None:
            end = peg.arc.end if side > 0 else peg.arc.start
            pieces = self._along(label, end, 0.0, inf)
            if pieces is not None:
                joint = self.pegs.pegs[following]
                self._step(label, tuple((piece, piece.length) for piece in pieces), joint, side, end)

    def _arcs_from(self, label: Label) -> Iterator[tuple[Peg, int]]:
        """The arcs along which a walk from a corner or a place goes on, and on which side.

        From a corner it keeps to its side, along an arc that begins there. From a place it goes both ways,
        but not off the end of an arc.
        """
        peg, side = self.pegs.entries[label.entry]
        for e in sorted(set(peg.edges)):
            for onward in self.pegs.on_edge.get(e, ()):
                arc = onward.arc
                if arc is None or not arc.contains(peg.center):
                    continue
                if side:
                    if (onward.before if side > 0 else onward.after) == peg.number:
                        yield onward, side
                    continue
                for sense, last in ((1, arc.end), (-1, arc.start)):
                    if arc.full or last != label.contact:
                        yield onward, sense

    def _step(
        self,
        label: Label,
        pieces: tuple[tuple[Curve, Length], ...],
        peg: Peg,
        side: int,
        contact: Point,
        beyond: bool = False,
    ) -> None:
        """Come to a peg by a walk along the boundary."""
        entry, turn, slack = self.pegs.entry(peg, side), 0.0, 0.0
        if peg.arc is not None:
            x, y = (contact - peg.arc.center).xy
            u, v = (peg.arc.start - peg.arc.center).xy
            turn = float(np.arctan2(u * y - v * x, u * x + v * y)) % (2 * pi)
            slack = margin(ROUNDINGS)
        tail = FROM_START if beyond else WALKED
        self._go(label, pieces, entry, contact, tail, turn, slack, beyond)

    def _along(
        self, label: Label, point: Point, turn: float, slack: float, beyond: bool = False
    ) -> tuple[Arc, ...] | None:
        """The arc from a label's contact to a further point, nothing if it is the same; None if it is behind.

        *beyond* says that the point must not be the same.
        """
        peg, side = self.pegs.entries[label.entry]
        arc = peg.arc
        assert arc is not None
        slack += label.slack + ROUNDINGS
        turned = side * (turn - label.turn)
        if arc.full:
            turned %= 2 * pi
        is_clear = slack < turned < 2 * pi - slack
        if not is_clear:
            if label.contact is point or label.contact == point:
                return None if beyond or label.beyond else ()
            if not arc.full:
                rail = Rail(arc)
                if rail.parameter(point).compare(rail.parameter(label.contact)) != side:
                    return None
        return (Arc(label.contact, point, arc.center, arc.radius_sq, side > 0),)

    # -- labels --------------------------------------------------------------------------------------

    def _at(self, peg: Peg) -> Iterator[Label]:
        """The labels of a peg, on both sides."""
        for side in (0,) if peg.is_place else (1, -1):
            yield from self._labels.get(self.pegs.entry(peg, side), ())

    def _go(
        self,
        label: Label,
        pieces: tuple[tuple[Curve, Length], ...],
        entry: int,
        contact: Point,
        tail: int,
        turn: float = 0.0,
        slack: float = 0.0,
        beyond: bool = False,
    ) -> None:
        ball = label.ball
        for _, length in pieces:
            ball = ball + length.ball(BITS)
        way = TautWay(label, pieces)
        self._arrive(Label(entry, contact, tail, [way], ball, turn, slack, beyond))

    def _arrive(self, label: Label) -> None:
        """Keep a label, unless it is longer than another way there."""
        peg, _ = self.pegs.entries[label.entry]
        known = self._labels.setdefault(label.entry, [])
        if peg.arc is None:
            if any(label.compare(other) > 0 for other in self._at(peg)):
                return
            same = known[0] if known else None
        else:
            if any(self._is_behind(label, other) for other in known):
                return
            same = next((other for other in known if other.tail == label.tail), None)
        if same is not None:
            if label.compare(same) == 0:
                numbers = {self._number(way) for way in same.ways}
                same.ways += [way for way in label.ways if self._number(way) not in numbers]
                return
            same.superseded = True
            known.remove(same)
        known.append(label)
        if label.entry == self._goal:
            self.goal = label
        else:
            self._push(self._tries(label))

    def _number(self, way: TautWay) -> tuple[int, int]:
        """What tells ways to one label apart: the peg that they come from, its label if there are several."""
        peg, _ = self.pegs.entries[way.source.entry]
        is_one = peg.arc is None and not peg.is_tip
        return peg.number, len(way.pieces) if is_one else id(way.source)

    def _is_behind(self, label: Label, other: Label) -> bool:
        """Whether a label on an arc is longer than another one, and the way from there along the arc."""
        if other.tail == label.tail:
            return label.compare(other) > 0
        if label.bounds[1] < other.bounds[0]:
            return False
        pieces = self._along(other, label.contact, label.turn, label.slack)
        if not pieces:
            return pieces is not None and label.compare(other) > 0
        (piece,) = pieces
        way = TautWay(other, ((piece, piece.length),))
        longer = Label(label.entry, label.contact, -1, [way], other.ball + piece.length.ball(BITS))
        return label.compare(longer) > 0
