"""The rules of the Seed Spreader Strategy (paper, section 4): sweep along the M-line, walk around what blocks
it, divert at the last moment to what is about to be lost. They know the robot, and nothing else."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

from exactacq.geometry.points import Point
from exactacq.sensing.decision import Decision
from exactacq.sensing.event import Ending, EventKind, Occasion, Reason
from exactacq.strategies.moves import Halt, HaltKind
from exactacq.strategies.options import TargetChoice
from exactacq.strategies.robot import Robot
from exactacq.strategies.routes import Exit, Route
from exactacq.strategies.seed_spreader.losses import Line, Loss
from exactacq.strategies.seed_spreader.mline import MLine
from exactacq.strategies.seed_spreader.reasons import going_on, nearest_loss


class Stuck(Exception):
    """The strategy ends before T: an obstacle leaves no way on."""

    def __init__(self, ending: Ending, obstacle: int) -> None:
        self.ending, self.obstacle = ending, obstacle


class Excursion(NamedTuple):
    """A diversion that was made: from ``leave`` (D) on the M-line to ``hit`` (Q), and back."""

    loss: Loss
    leave: Point
    hit: Point


class Tell(Protocol):
    """Is told what the strategy does at the robot's place, with which obstacle, on what occasion and why."""

    def __call__(
        self,
        kind: EventKind,
        obstacle: int,
        *,
        occasion: Occasion | None = None,
        reason: Reason | None = None,
    ) -> None: ...


class Spreader:
    """A sweep of a terrain by a robot that is confined to it, along an M-line that begins at its place.

    ``diversions`` are those that were made, ``encounters`` the obstacles that were met on the M-line or on
    the way out on a diversion, ``again`` those that blocked the M-line and were acquired before. *tell* and
    *advance*, which is told the number of pieces of the M-line that were done, report on the way.
    """

    def __init__(
        self,
        robot: Robot,
        mline: MLine,
        lookahead: bool,
        target: TargetChoice,
        tell: Tell,
        advance: Callable[[int], None],
    ) -> None:
        self.robot, self.mline, self.lookahead, self.target = robot, mline, lookahead, target
        self.tell, self.advance = tell, advance
        self.diversions: list[Excursion] = []
        self.encounters: list[int] = []
        self.again: list[int] = []
        self.line: Line | None = None
        self._line_of = -1

    def explore(self) -> None:
        """Steps 0 to 3 of the paper; comments give their numbers. Raises `Stuck` if it ends before T."""
        route = self.robot.lay(self.mline.corners)
        while True:
            before = route.piece
            self._follow(route)
            self.advance(route.piece + 1 - before)
            if not route.turn():  # 1(a)
                return

    # -- step 1: along the M-line ------------------------------------------------------------------

    def _follow(self, route: Route) -> None:
        """Follow the straight pieces of the M-line to the end of the one the robot is on or comes to."""
        robot = self.robot
        while True:
            if route.piece != self._line_of:
                self._line_of = route.piece
                self.line = Line(robot, route, self.lookahead) if self.mline.line(route.piece) else None
            watch = None if self.line is None else self.line.watch
            halt = robot.follow(route, watch=watch, reason=going_on(robot.incomplete))
            if halt.kind is HaltKind.HIT:
                self._meet(route, halt)  # 1(b), 1(c)
            elif halt.kind is HaltKind.STOPPED and self.line is not None:
                self._divert(self.line.lost())  # 1(d)
            elif not self._diverts_at_end():
                return

    def _diverts_at_end(self) -> bool:
        losses = [] if self.line is None else self.line.at_end()
        if losses:
            self._divert(losses)
        return bool(losses)

    def _meet(self, route: Route, halt: Halt) -> None:
        """Walk around an obstacle that blocks the M-line (step 2), or that is known, to where it goes on."""
        robot, obstacle = self.robot, _obstacle(halt)
        met = not robot.map.is_incomplete(obstacle)
        self.tell(EventKind.CROSS if met else EventKind.HIT, obstacle, occasion=Occasion.M_LINE)
        self.encounters.append(obstacle)
        if met:
            self.again.append(obstacle)
        else:
            robot.circle()
        leave = next(robot.exits(route, obstacle), None)
        if leave is None:
            raise Stuck(Ending.TRAPPED, obstacle)
        if self.line is not None and robot.position == halt.place:
            while losses := self.line.before_hop(leave.point if leave.piece == route.piece else None):
                self._divert(losses)
        self._take_up(route, leave, obstacle, Occasion.M_LINE)

    def _take_up(self, route: Route, leave: Exit, obstacle: int, occasion: Occasion) -> None:
        self.robot.take_up(route, leave)
        self.tell(EventKind.LEAVE, obstacle, occasion=occasion)

    # -- step 3: diversions ------------------------------------------------------------------------

    def _divert(self, losses: list[Loss]) -> None:
        """Acquire the nearest obstacle that is about to be lost, and come back."""
        robot = self.robot
        leave, visible = robot.position, self.target is TargetChoice.VISIBLE
        about = {loss.obstacle: loss for loss in losses}
        aims = dict(robot.nearest([k], visible=visible) for k in about) if losses[1:] else {}
        obstacle, aim = robot.nearest(about, visible=visible)
        loss, why = about[obstacle], nearest_loss(obstacle, {**aims, obstacle: aim}, leave)
        self.tell(EventKind.DIVERT, obstacle, reason=loss.reason)
        out = robot.lay([leave, aim])
        self._approach(out, obstacle, why)
        hit = robot.position
        robot.circle()
        robot.walk_to(hit)
        self.tell(EventKind.LEAVE, obstacle, occasion=Occasion.DIVERSION)
        self._approach(robot.way_back(out), None)
        self.tell(EventKind.RETURN, obstacle, reason=loss.reason)
        self.diversions.append(Excursion(loss, leave, hit))

    def _approach(self, route: Route, aimed: int | None, why: Decision | str = "") -> None:
        """Go the straight way, around what is in the way; or to the first hit of the *aimed* obstacle."""
        robot = self.robot
        occasion = Occasion.WAY_BACK if aimed is None else Occasion.WAY_OUT
        halt = robot.follow(route, reason=why)
        while halt.kind is HaltKind.HIT:
            obstacle = _obstacle(halt)
            self.tell(EventKind.HIT, obstacle, occasion=occasion)
            if aimed is not None:
                self.encounters.append(obstacle)
            if robot.map.is_incomplete(obstacle):
                if obstacle == aimed:
                    return
                robot.circle()
            exits = list(robot.exits(route, obstacle))
            if not exits:
                raise Stuck(Ending.WAY_CLOSED, obstacle)
            self._take_up(route, exits[-1], obstacle, occasion)
            halt = robot.follow(route)
        if aimed is not None:
            self.encounters.append(aimed)
            self.tell(EventKind.HIT, aimed, occasion=Occasion.DIVERSION)


def _obstacle(halt: Halt) -> int:
    assert halt.obstacle is not None, "what is hit is an obstacle"
    return halt.obstacle
