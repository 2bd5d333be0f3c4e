"""The robot's own numbers of obstacles, in the order in which it saw them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import index
from typing import Any

import numpy as np
from flint import fmpq

from exactacq.cached import cached_property
from exactacq.errors import shown
from exactacq.numbers.real import rational
from exactacq.scene.edge_table import Floats


class Numbering:
    """Numbers of the obstacles that were seen: ``order`` has the scene's by the robot's, ``own`` the reverse.

    It knows boxes around whole obstacles, for filters: what these let pass is decided by what is known.
    """

    def __init__(self, hulls: Callable[[], Floats]) -> None:
        self.order: list[int] = []
        self.own: dict[int, int] = {}
        self._hulls = hulls

    def add(self, obstacle: int) -> int:
        """The robot's number of an obstacle of the scene, which it sees."""
        number = self.own.get(obstacle)
        if number is None:
            number = self.own[obstacle] = len(self.order)
            self.order.append(obstacle)
        return number

    def cut(self, count: int) -> None:
        """Take back all numbers but the first ones."""
        for obstacle in self.order[count:]:
            del self.own[obstacle]
        del self.order[count:]

    def scene_number(self, number: Any, count: int) -> int:
        """The scene's number of one of the first *count* obstacles; ValueError for any other."""
        try:
            k = index(number)
        except TypeError:
            k = -1
        if k not in range(count):
            raise ValueError(f"no obstacle {shown(number)} was seen yet")
        return self.order[k]

    @cached_property
    def _boxes(self) -> Floats:
        return self._hulls()

    def meeting(self, box: Sequence[float]) -> list[int]:
        """The scene's numbers of all obstacles that may have points in a box, seen or not, in order."""
        apart = (self._boxes[:, :2] > box[2:]) | (self._boxes[:, 2:] < box[:2])
        found: list[int] = np.flatnonzero(~apart.any(axis=1)).tolist()
        return found

    def may_lie_west(self, obstacle: int, x: fmpq) -> bool:
        """Whether an obstacle of the scene may have points west of a vertical line."""
        return bool(rational(float(self._boxes[obstacle, 0])) < x)
