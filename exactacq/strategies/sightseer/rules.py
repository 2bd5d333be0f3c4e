"""The rules of the Sightseer Strategy (paper, section 3): visit the nearest visible unvisited obstacle,
circle it, backtrack by a depth-first stack. They know the robot, and nothing else."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from exactacq.numbers.length import Length
from exactacq.sensing.decision import FEW, Candidate, Decision, Rule
from exactacq.strategies.moves import KnownLink, Way
from exactacq.strategies.robot import Robot


class Tour:
    """A tour of a robot from its start by the Sightseer's rules.

    ``ways`` are those to the obstacles that were visited, in this order, ``depths`` how many entries the
    stack held after each, and ``back`` the ways by which the robot came back.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.ways: list[Way] = []
        self.depths: list[int] = []
        self.back: list[Way] = []
        self.stack: list[Way] = []

    def explore(self) -> None:
        """Steps 0 to 4 of the paper; comments give their numbers."""
        robot = self.robot
        while True:
            link = robot.nearest_unvisited()  # 1
            if link is not None:
                self._advance(link)  # 3 and 4
            elif not self.stack or not robot.knows_unvisited:
                break
            else:
                self._backtrack()  # 2

    def _advance(self, link: KnownLink) -> None:
        way = self.robot.take(link)
        self.stack.append(way)
        self.ways.append(way)
        self.depths.append(len(self.stack))
        self.robot.circle()

    def _backtrack(self) -> None:
        robot, way = self.robot, self.stack.pop()
        robot.go_back(way, reason=partial(_why_back, way, Length(robot.radius), robot.unvisited_now))
        self.back.append(way)


def _why_back(way: Way, radius: Length, unvisited: Callable[[], Sequence[int]]) -> Decision:
    left = unvisited()
    return Decision(
        rule=Rule.BACK,
        chosen="S" if way.source is None else way.source,
        length=radius,
        others=tuple(map(Candidate, left[:FEW])),
        more=len(left[FEW:]),
    )
