"""The rules of the Sightseer Strategy (paper, section 3): visit the nearest visible unvisited obstacle,
circle it, backtrack by a depth-first stack. They know the robot, and nothing else."""

from __future__ import annotations

from exactacq.numbers.length import Length
from exactacq.sensing.decision import FEW, Candidate, Decision, Rule
from exactacq.strategies.moves import KnownLink, Way
from exactacq.strategies.robot import Robot


class Tour:
    """A tour of a robot from its start by the Sightseer's rules.

    ``ways`` are those to the obstacles that were visited, in this order, ``walked_back`` the obstacles from
    which the robot came back by theirs, and ``depth`` the most entries that the stack held.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.ways: list[Way] = []
        self.walked_back: set[int] = set()
        self.stack: list[Way] = []
        self.depth = 0

    def explore(self) -> None:
        """Steps 0 to 4 of the paper; comments give their numbers."""
        robot = self.robot
        while True:
            link = robot.nearest_unvisited(robot.at)  # 1
            if link is not None:
                self._advance(link)  # 3 and 4
            elif robot.at is None or not robot.knows_unvisited:
                break
            else:
                self._backtrack()  # 2

    def _advance(self, link: KnownLink) -> None:
        way = self.robot.take(link)
        self.stack.append(way)
        self.ways.append(way)
        self.depth = max(self.depth, len(self.stack))
        self.robot.circle()

    def _backtrack(self) -> None:
        way = self.stack.pop()
        self.robot.go_back(way, reason=self._why_back(way))
        self.walked_back.add(way.target)

    def _why_back(self, way: Way) -> Decision:
        left = self.robot.unvisited
        return Decision(
            rule=Rule.BACK,
            chosen="S" if way.source is None else way.source,
            length=Length(self.robot.radius),
            others=tuple(map(Candidate, left[:FEW])),
            more=len(left[FEW:]),
        )
