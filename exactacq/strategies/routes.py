"""Polylines that robots follow: how far a robot is on one, and where obstacles cross it.

A route knows all its crossing points from the beginning; a robot tells of them only what it has met, or what
is on its map.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from exactacq.errors import MoveError
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.scene.terrain_components import Component
from exactacq.sensing.map import Map, Spots
from exactacq.strategies.seed_spreader.blocked import Crossing
from exactacq.strategies.walker import Walker
from exactacq.visibility.links import Node


class Route:
    """A polyline that a robot follows, from where it laid it, and how far along it the robot is.

    ``pieces`` are its straight pieces; no two ends of one are equal. Robots make routes: `Robot.lay` and
    `Robot.way_back`.

    >>> import exactacq as xa
    >>> route = xa.Robot(xa.load("squares")).lay([(0, 0), (0, 4), (9, 4)])
    >>> [str(piece.length) for piece in route.pieces], route.piece
    (['4', '9'], 0)
    """

    def __init__(
        self,
        pieces: Sequence[Segment],
        _of: Walker,
        _start: Point,
        _crossings: Sequence[Crossing],
        _ends_at: Node | None = None,
    ) -> None:
        # The nodes where it was laid and where it ends, the latter if it is known.
        self._of, self._start, self._at, self._ends_at = _of, _start, _of.at, _ends_at
        self.pieces, self._crossings = tuple(pieces), tuple(_crossings)
        # Where the robot left it last, the piece that it is on or comes to, the crossing point that it comes
        # to, and the one that it was to come to when news were last asked for.
        self._place, self._piece, self._next, self._news_from = _start, 0, 0, 0
        self._numbers: dict[int, list[int]] = {}
        for n, crossing in enumerate(self._crossings):
            self._numbers.setdefault(crossing.component.index, []).append(n)
        self._spots: dict[int, Spots] = {}

    def __repr__(self) -> str:
        return f"<Route of {len(self.pieces)} pieces, at {self._piece}>"

    @property
    def piece(self) -> int:
        """The number of the piece that the robot is on, or comes to; after the last one their count."""
        return self._piece

    @property
    def end(self) -> Point:
        """Where it ends."""
        return self.pieces[-1].end if self.pieces else self._start

    def turn(self) -> bool:
        """Take up the next piece, at the end of one; False at the end of the last.

        `MoveError` if the robot did not come to the end of its piece.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("squares"))
        >>> route = robot.lay([(0, 0), (0, 4), (9, 4)])
        >>> robot.follow(route).kind, route.turn(), robot.follow(route).kind, route.turn()
        (<HaltKind.ARRIVED: 'arrived'>, True, <HaltKind.ARRIVED: 'arrived'>, False)
        """
        if self._piece < len(self.pieces):
            if self._place != self.pieces[self._piece].end:
                raise MoveError("the robot is not at the end of this piece of the route")
            self._piece += 1
        return self._piece < len(self.pieces)

    def _coming(self) -> Crossing | None:
        """The crossing point that the robot comes to on its piece, where an obstacle begins to block it."""
        if self._next < len(self._crossings):
            crossing = self._crossings[self._next]
            if crossing.piece == self._piece:
                return crossing
        return None

    def _take_up(self, crossing: Crossing) -> None:
        self._piece, self._next, self._place = crossing.piece, crossing.number + 1, crossing.stop.point

    def _ahead(self, obstacle: int) -> list[int]:
        """The numbers of an obstacle's crossing points on the rest of the route."""
        numbers = self._numbers.get(obstacle, [])
        return numbers[bisect_left(numbers, self._next) :]

    def _ashore(self, number: int, chart: Map) -> Spots:
        """Where a crossing point lies on the boundary that the robot can reach, if it does."""
        if number not in self._spots:
            # That the point lies on some edges is how it was found: it may be far to prove once more.
            component, (_, point, on) = self._crossings[number].component, self._crossings[number].stop
            edges = component.edges_on(point, on) if isinstance(component, Component) else sorted(on)
            self._spots[number] = chart.spots_on(component.index, point, edges)
        return self._spots[number]

    def _exits(self, obstacle: int, chart: Map) -> Iterable[Exit]:
        """Where the rest of the route comes out of an obstacle; each is found when it is asked for."""
        for n in self._ahead(obstacle):
            crossing = self._crossings[n]
            if crossing.ends and self._ashore(n, chart):
                yield Exit(crossing.piece, crossing.stop.point, self, crossing)

    def _passed(self) -> set[tuple[int, int]]:
        """The crossing points left behind since this was asked last: obstacle and number of each."""
        passed = {(c.component.index, c.number) for c in self._crossings[self._news_from : self._next]}
        self._news_from = self._next
        return passed

    def _back(self, here: Point) -> Route:
        """The way back from the robot's place on it, which may begin to block it.

        Its points are those of the way out: found again, they would be other forms of the same numbers. Only
        the parameters of the crossing points remain what they were, and are of no use.
        """
        done = self.pieces[: self._piece + 1]
        ends = [*(piece.start for piece in done), here]
        pieces = [Segment(q, p) for p, q in pairwise(ends) if p != q][::-1]
        lost = len(done) - len(pieces)
        found = [
            Crossing(n, c.component, len(done) - 1 - c.piece - lost, c.stop, not c.ends)
            for n, c in enumerate(reversed(self._crossings[: self._next]))
        ]
        return Route(pieces, self._of, here, found, self._at)


@dataclass(frozen=True, eq=False)
class Exit:
    """A place where a route comes out of an obstacle: on which of its pieces, and which point.

    Robots make them.

    >>> import exactacq as xa
    >>> robot = xa.Robot(xa.load("squares"))
    >>> route = robot.lay([(0, 0), (20, 0)])
    >>> halt, _ = robot.follow(route), robot.circle()
    >>> for place in robot.exits(route, halt.obstacle):
    ...     print(place.piece, place.point)
    0 (4, 0)
    """

    piece: int
    point: Point
    _of: Route = field(repr=False)
    _crossing: Crossing = field(repr=False)
