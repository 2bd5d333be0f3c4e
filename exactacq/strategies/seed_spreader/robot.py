"""The Seed Spreader's robot: it follows the M-line, and goes straight to known points.

A strategy can ask for the robot's place, the map, what is in sight, and the crossing points of boundaries
that are on the map. It learns what is in the way by meeting it.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence, Set
from typing import NamedTuple

import numpy as np
from flint import fmpq

from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real, rational
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.scene import Scene
from exactacq.scene.terrain_components import Ground
from exactacq.sensing.map import Map, Spots
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.sensing.sensor import Ahead
from exactacq.strategies.seed_spreader.blocked import Blocker, Blocking, Crossing, Gap
from exactacq.strategies.seed_spreader.mline import MLine
from exactacq.strategies.walker import Walker


class Hit(NamedTuple):
    """What stopped the robot: an obstacle, and where on the M-line it begins to block, if it was followed."""

    obstacle: int
    crossing: Crossing | None


Watch = Callable[[Ahead], Point | None]
"""Is shown what the next way will tell, and answers where the robot is to stop, if anywhere."""


class SeedSpreaderRobot(Walker):
    """A point robot in the SW corner of a terrain, with a vision sensor of limited *radius* (rational).

    The corner must be free.
    """

    def __init__(self, scene: Scene, ground: Ground, radius: fmpq) -> None:
        table = EdgeTable(scene.obstacles)
        self.radius = radius
        self.mline = MLine(ground.terrain, radius)
        self._blocking = Blocking(ground, table)
        self._crossings = self.mline.crossings(self._blocking)
        self._of: dict[int, list[int]] = {}
        for n, crossing in enumerate(self._crossings):
            self._of.setdefault(crossing.component.index, []).append(n)
        # Around the whole obstacles: boxes that a component's boundary does not leave.
        self._boxes = table.hulls[[component.obstacle.index for component in ground.components]]
        self._spots: dict[int, Spots] = {}
        self._next = self.piece = self._passed_by = 0
        self._gaps: list[Gap] = []
        start = ground.terrain.south_west
        self._bases, self._passed = (start, start), 0
        super().__init__(start, Memory(scene, radius, table, ground))

    # -- the map -----------------------------------------------------------------------------------

    @property
    def map(self) -> Map:
        """What is known now."""
        return self.memory.now

    @property
    def in_sight(self) -> Set[int]:
        """The obstacles in sight that are not acquired."""
        return self.memory.in_sight

    @property
    def incomplete(self) -> Set[int]:
        """The obstacles of which some, but not all, is known."""
        return self.memory.incomplete

    def is_acquired(self, obstacle: int) -> bool:
        """Whether all of an obstacle is known."""
        return obstacle in self.memory.acquired

    def map_ahead(self, ahead: Ahead, u: Real, place: Point, obstacles: Set[int]) -> Map:
        """What will be known of some obstacles at a place of a way that was looked along."""
        return self.memory.map_ahead(ahead, u, place, obstacles)

    def meeting(self, box: Sequence[float]) -> set[int]:
        """Obstacles that may have points in a box: to ask the map for no others."""
        apart = (self._boxes[:, :2] > box[2:]) | (self._boxes[:, 2:] < box[:2])
        return set(np.flatnonzero(~apart.any(axis=1)).tolist())

    def may_lie_west(self, obstacle: int, x: fmpq) -> bool:
        """Whether an obstacle may have points west of a line: if not, no map shows any."""
        return bool(rational(float(self._boxes[obstacle, 0])) < x)

    def visible(self, obstacle: int) -> list[Curve]:
        """The pieces of an obstacle in sight from here; a single point is a piece without length."""
        return self.memory.visible(self.position, obstacle)

    def news(self) -> set[int]:
        """The obstacles of which more became known or a crossing point was passed since the last time."""
        passed = {crossing.component.index for crossing in self._crossings[self._passed_by : self._next]}
        self._passed_by = self._next
        return self.memory.news() | passed

    def blocks_ahead(self, obstacle: int, chart: Map) -> bool:
        """Whether a crossing point of an obstacle on the rest of the M-line is on a map."""
        return any(chart.knows_some(self._ashore(n, chart)) for n in self._ahead(obstacle))

    def _ahead(self, obstacle: int) -> Iterator[int]:
        """The numbers of an obstacle's crossing points on the rest of the M-line."""
        numbers = self._of.get(obstacle, [])
        return (numbers[k] for k in range(bisect_left(numbers, self._next), len(numbers)))

    def _ashore(self, number: int, chart: Map) -> Spots:
        """Where a crossing point lies on the boundary that the robot can reach, if it does."""
        if number not in self._spots:
            crossing = self._crossings[number]
            self._spots[number] = chart.spots(crossing.component.index, crossing.stop.point)
        return self._spots[number]

    def leave_point(self, hit: Hit) -> Crossing | None:
        """Where the M-line goes on after an obstacle that was walked around; None if it traps S or T."""
        for n in self._ahead(hit.obstacle):
            if self._crossings[n].ends and self._ashore(n, self.map):
                return self._crossings[n]
        return None

    # -- motion ------------------------------------------------------------------------------------

    def follow(self, watch: Watch | None = None) -> Hit | None:
        """Follow the M-line to the end of its straight piece, unless an obstacle blocks or *watch* stops."""
        way = self.mline.pieces[self.piece]
        crossing = self._crossings[self._next] if self._next < len(self._crossings) else None
        is_blocked = crossing is not None and crossing.piece == self.piece
        target = crossing.stop.point if crossing is not None and is_blocked else way.end
        if not self._walk_straight(target, watch) or crossing is None or not is_blocked:
            return None
        self.at = crossing.component.index
        return Hit(self.at, crossing)

    def turn(self) -> bool:
        """Take up the next piece of the M-line; False at T."""
        self.piece += 1
        return self.piece < len(self.mline.pieces)

    def resume(self, crossing: Crossing) -> None:
        """Take up the M-line at a leave point, to which the robot has walked."""
        self.piece, self._next = crossing.piece, crossing.number + 1

    def head_for(self, goal: Point) -> None:
        """Lay a straight way from here to a point."""
        self._bases, self._passed = (self.position, goal), 0
        self._gaps = self._blocking.gaps(Segment(*self._bases)) if self.position != goal else []

    def head_back(self) -> None:
        """Lay the straight way back, from where the robot came to its end, or to what blocks it.

        Its points are those of the way out: found again, they would be other forms of the same numbers.
        """
        passed = reversed(self._gaps[: self._passed])
        self._gaps = [Gap(gap.obstacle, gap.component, gap.end, gap.begin) for gap in passed]
        self._bases, self._passed = (self.position, self._bases[0]), 0

    def go(self) -> Hit | None:
        """Go on along the straight way until an obstacle blocks it, or to its end."""
        if self._passed == len(self._gaps):
            self._walk_straight(self._bases[1], None)
            return None
        gap = self._gaps[self._passed]
        self._walk_straight(gap.begin.point, None)
        # `Blocking` finds no component only where both ends of a stretch are blocked, and these can only be
        # ends of the way: the robot's own place or its free goal.
        assert gap.component is not None, "a way between free points is blocked between them"
        self.at = gap.component.index
        return Hit(self.at, None)

    def pass_by(self, obstacle: int) -> Point | None:
        """Take up the straight way at the last crossing point of an obstacle with it, which is returned.

        None if there is none that can be walked to.
        """
        for k in range(len(self._gaps) - 1, self._passed - 1, -1):
            component, place = self._gaps[k].component, self._gaps[k].end.point
            if component is not None and component.index == obstacle and _is_ashore(component, place):
                self._passed = k + 1
                return place
        return None

    def _walk_straight(self, target: Point, watch: Watch | None) -> bool:
        """Walk to a point that can be reached; False if *watch* stopped the robot before."""
        if self.position == target:
            return True
        for part in self.memory.parts(Segment(self.position, target)):
            piece = Piece("straight", None, part)
            stop = None if watch is None else watch(self.memory.ahead(piece))
            if stop is not None and stop != part.end:
                piece = Piece("straight", None, Segment(self.position, stop))
            if stop is None or stop != self.position:
                self.move(piece)
                self.position = piece.end
            if stop is not None:
                return False
        return True


def _is_ashore(component: Blocker, point: Point) -> bool:
    return any(edge.passes(point) for edge in component.edges)
