"""Shortest paths of a robot on what it knows, among no more obstacles than may be in the way.

All points of paths from p to q that are no longer than L lie within (L + |pq|) / 2 of p. So the path that is
shortest among the obstacles within a square around p is shortest among all, if the square is that wide.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import frexp

from exactacq.geometry.points import Point, distance
from exactacq.sensing.map import Body, Known
from exactacq.strategies.sightings import Sightings
from exactacq.strategies.walker import Walker
from exactacq.visibility.known_ground import KnownGround
from exactacq.visibility.shortest_path import ShortestPath, shortest_path

FIRST = 1.25
"""How much longer than the straight line a path is taken to be at first."""
ROOM = 1 + 2.0**-20
"""Distances are taken so much larger, and a share of the coordinates is added: more than floats are off."""


@dataclass(frozen=True, slots=True)
class _Nearby:
    """What is known of some obstacles."""

    obstacles: Sequence[Body]
    seen: tuple[int, ...]
    acquired: tuple[int, ...]
    known: Callable[[int], tuple[Known, ...]]


class KnownPaths:
    """The shortest paths from where a robot is, and the grounds that they are searched on."""

    def __init__(self, walker: Walker, seen: Sightings) -> None:
        self._walker, self._seen = walker, seen
        # By the size of the square: after how many pieces of the way, the ground there, and if that is all.
        self._grounds: dict[float, tuple[int, KnownGround, bool]] = {}

    def to(self, goal: Point) -> ShortestPath | None:
        """A shortest path; None if there is none. Raises what `shortest_path` raises."""
        here = self._walker.position
        far = float(distance(here, goal))
        longest = FIRST * far
        while True:
            reach = (longest + far) / 2 * ROOM + (ROOM - 1) * max(map(abs, here.xy))
            ground, is_all = self._ground(reach)
            found = shortest_path(ground, here, goal)
            length = 4 * longest if found is None else float(found.length)
            if is_all or length <= longest:
                return found
            longest = length

    def _ground(self, reach: float) -> tuple[KnownGround, bool]:
        """What is known within a square of at least that size, and whether that is all that is known."""
        size, count = _power_of_two(reach), self._walker.count
        at, known, is_all = self._grounds.get(size, (-1, None, False))
        if known is None or at != count:
            known, is_all = self._charted(size, known)
            self._grounds[size] = count, known, is_all
        return known, is_all

    def _charted(self, size: float, known: KnownGround | None) -> tuple[KnownGround, bool]:
        numbers, chart, (x, y) = self._seen.numbers, self._walker.memory.now, self._walker.position.xy
        near = [k for k in numbers.meeting((x - size, y - size, x + size, y + size)) if k in numbers.own]
        whole = tuple(k for k in near if numbers.own[k] not in self._seen.incomplete)
        nearby = _Nearby(chart.obstacles, tuple(near), whole, chart.known)
        ground = KnownGround.on_map(nearby, number=numbers.own.__getitem__, known=known)
        return ground, len(near) == len(numbers.order)


def _power_of_two(size: float) -> float:
    """The least one that is larger than a size, so that goals of about one distance share a square."""
    return float(2.0 ** frexp(size)[1])
