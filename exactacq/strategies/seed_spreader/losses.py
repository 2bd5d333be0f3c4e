"""When the Seed Spreader is about to lose an obstacle that it knows in part (paper, section 4.1).

On a line of the M-line, the first one aside, an incomplete obstacle with a known point to the west is about
to be lost where (i) it goes out of sight and, by the map, cannot be seen any more from the rest of the line,
(ii) what is known of it goes out of reach for the rest of the line, (iii) the line ends, (iv) the robot
comes back to the line, and it is out of reach already. Not so if it is known to block the rest of the M-line.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Sequence
from math import inf
from typing import NamedTuple

from exactacq.cached import cached_property
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.sensing.event import EventKind, Reason
from exactacq.strategies.known_map import KnownMap
from exactacq.strategies.moves import Passage
from exactacq.strategies.robot import Robot
from exactacq.strategies.routes import Route
from exactacq.strategies.seed_spreader.horizon import Horizon, at_most, reach_begins
from exactacq.strategies.seed_spreader.hulls import hull, overlap
from exactacq.strategies.seed_spreader.prediction.decide import sees_later
from exactacq.strategies.seed_spreader.range_thresholds import first_out_of_reach, is_in_reach


class Loss(NamedTuple):
    """An obstacle that is about to be lost."""

    obstacle: int
    reason: Reason


class _Deadline(NamedTuple):
    """Where an obstacle is about to be lost unless it is seen again before, and why.

    ``latest`` is a float that the ordinate, times the sense of the walk, does not exceed.
    """

    place: Point
    reason: Reason
    latest: float


class _Stake:
    """What is known of an obstacle at stake, as one walks a line, and how far along it that is in reach."""

    def __init__(self, line: Line, curves: list[Curve]) -> None:
        self.curves, self._lookahead = curves, line.lookahead
        self._x, self._upward, self._radius = line.x, line.upward, line.robot.radius

    @cached_property
    def horizon(self) -> Horizon:
        """Up to where it is in reach."""
        return Horizon(self._x, self._upward, self.curves, self._radius)

    @cached_property
    def earliest(self) -> float:
        """An ordinate, times the sense of the walk, before which it is not about to go out of reach."""
        if self._lookahead:
            return self.horizon.bounds[0]
        return reach_begins(1 if self._upward else -1, self.curves, self._radius)


class Line:
    """A line of the M-line as the robot walks it.

    What is out of sight, and of which nothing more became known, is asked about only where it may be about
    to be lost: obstacles at stake are kept by the ordinate from which on this may be.
    """

    def __init__(self, robot: Robot, route: Route, lookahead: bool) -> None:
        way = route.pieces[route.piece]
        end = way.end.rational
        assert end is not None, "the M-line's corners are rational"
        self.robot, self.route, self.lookahead = robot, route, lookahead
        self.x, self.last = end
        self.upward = way.direction.y.sign() > 0
        self.sense = 1 if self.upward else -1
        robot.news(route)
        self._unsettled = set(robot.incomplete)
        self._out_of_sight: dict[int, _Stake] = {}
        self._by_ordinate: list[tuple[float, int]] = []
        # On a way: the obstacles that were seen when it began or then, those with a deadline, the first
        # deadline, and what was out of sight when it began, as far as it was not asked about.
        self._seen: set[int] = set()
        self._deadlines: dict[int, _Deadline] = {}
        self._first: _Deadline | None = None
        self._dormant: list[tuple[float, int]] = []

    # -- what is at stake --------------------------------------------------------------------------

    def _settle(self) -> None:
        """Look again at obstacles that are out of sight and of which more became known."""
        robot = self.robot
        self._unsettled |= robot.news(self.route)
        out_of_sight = self._unsettled - robot.in_sight
        self._unsettled -= out_of_sight
        incomplete, chart = robot.incomplete, robot.map
        for k in out_of_sight:
            if k in self._out_of_sight:
                before = self._out_of_sight.pop(k).earliest, k
                del self._by_ordinate[bisect_left(self._by_ordinate, before)]
            if k in incomplete and (stake := self._at_stake(k, chart)):
                self._out_of_sight[k] = stake
                insort(self._by_ordinate, (stake.earliest, k))

    def _due(self, before: float) -> list[tuple[float, int]]:
        """What at stake may go out of reach up to an ordinate, times the sense, the first one first."""
        return self._by_ordinate[: bisect_left(self._by_ordinate, (before, inf))]

    def _all_at_stake(self) -> list[int]:
        """All obstacles at stake."""
        self._unsettled |= self.robot.news(self.route)
        chart = self.robot.map
        some = {*self._out_of_sight, *self._unsettled} & self.robot.incomplete
        return [k for k in sorted(some) if self._at_stake(k, chart)]

    # -- on the way --------------------------------------------------------------------------------

    def watch(self, passage: Passage) -> Point | None:
        """The first place of a way along the line where, as known now, something is about to be lost."""
        seen = passage.sighting
        if seen is None:
            self._set_out()
        else:
            self._seen.add(seen.obstacle)
            if self._deadlines.pop(seen.obstacle, None) is self._first:
                self._first = self._earliest_deadline()
            if seen.kind is EventKind.LOSE and (stake := self._at_stake(seen.obstacle, passage.map)):
                self._ask(seen.obstacle, stake, passage.place.y, passage.map)
        self._ask_dormant(passage.place.y)
        return None if self._first is None else self._first.place

    def lost(self) -> list[Loss]:
        """What is about to be lost where the robot has stopped."""
        y = self.robot.position.y
        return [Loss(k, d.reason) for k, d in self._deadlines.items() if d.place.y.compare(y) == 0]

    def _set_out(self) -> None:
        self._settle()
        self._seen, self._deadlines, self._first = set(self.robot.in_sight), {}, None
        # The first one last.
        self._dormant = self._due(self.sense * float(self.last))[::-1]

    def _ask_dormant(self, y: Real) -> None:
        """Ask about what is out of sight since the way began, until none may be lost before the first."""
        while self._dormant and (self._first is None or self._dormant[-1][0] <= self._first.latest):
            _, k = self._dormant.pop()
            if k not in self._seen:
                self._ask(k, self._out_of_sight[k], y, None)

    def _ask(self, k: int, stake: _Stake, y: Real, lost: KnownMap | None) -> None:
        """Note where from an ordinate on an obstacle out of sight is lost; with the map if it just went."""
        deadline = self._deadline(k, stake, y, lost)
        if deadline is not None:
            self._deadlines[k] = deadline
            if self._first is None or self._is_before(deadline, self._first):
                self._first = deadline

    def _earliest_deadline(self) -> _Deadline | None:
        first: _Deadline | None = None
        for deadline in self._deadlines.values():
            if first is None or self._is_before(deadline, first):
                first = deadline
        return first

    def _is_before(self, a: _Deadline, b: _Deadline) -> bool:
        return a.place.y.compare(b.place.y) == -self.sense

    def _deadline(self, k: int, stake: _Stake, y: Real, lost: KnownMap | None) -> _Deadline | None:
        """Where before the end of the line an obstacle out of sight is about to be lost, and why."""
        curves, sees = stake.curves, lost is None
        if lost is not None and self.lookahead:
            sees = self._sees(k, curves, lost, y, Real(self.last))
        if not sees:
            return self._at(y, Reason.OUT_OF_SIGHT)
        horizon = stake.horizon
        if horizon.order(y) < 0:
            return self._at(y, Reason.OVERDUE)
        if not self.lookahead:
            last = first_out_of_reach(self.x, self.upward, y, curves, self.robot.radius)
            if last is not None:
                return self._at(last, Reason.OUT_OF_REACH) if last.compare(self.last) == -self.sense else None
        if horizon.order(Real(self.last)) < 0:
            return _Deadline(Point(self.x, horizon.late), Reason.OUT_OF_REACH, horizon.bounds[1])
        return None

    def _at(self, y: Real, reason: Reason) -> _Deadline:
        return _Deadline(Point(self.x, y), reason, at_most(y, self.sense))

    def _at_stake(self, obstacle: int, chart: KnownMap) -> _Stake | None:
        """What is known of an obstacle, if it is at stake: else None.

        So it is if it is incomplete, known west of the line, and not known to block what is left.
        """
        if not (chart.lies_west(obstacle, self.x) and chart.is_incomplete(obstacle)):
            return None
        if chart.blocks(obstacle, self.route):
            return None
        curves = [part.curve or Segment(part.start, part.start) for part in chart.known(obstacle)]
        return _Stake(self, curves)

    def _sees(
        self,
        obstacle: int,
        pieces: Sequence[Curve],
        chart: KnownMap,
        start: Real,
        stop: Real,
        including: bool = False,
    ) -> bool:
        """Whether by the map a point of an obstacle's known *pieces* is seen from between two ordinates."""
        points = [curve.start for curve in pieces if not _is_long(curve)]
        targets = [curve for curve in pieces if _is_long(curve)]

        def blockers(field: Sequence[float]) -> list[Curve]:
            others = chart.known_in(field, but=(obstacle,))
            near = [curve for curve in targets if overlap(hull(curve), field)]
            return near + [part.curve for part in others if part.curve is not None]

        return sees_later(self.x, start, stop, targets, blockers, self.robot.radius, points, including)

    # -- at a stop ---------------------------------------------------------------------------------

    def at_end(self) -> list[Loss]:
        """What is lost where the line ends."""
        return [Loss(k, Reason.LINE_ENDS) for k in self._all_at_stake()]

    def before_hop(self, leave: Point | None) -> list[Loss]:
        """What is lost on the hop around an obstacle to a leave point, None if it lies beyond the line."""
        if leave is None:
            return self.at_end()
        robot, chart = self.robot, self.robot.map
        self._settle()
        found, in_sight = [], robot.in_sight
        for k in sorted({*(k for _, k in self._due(self.sense * float(leave.y))), *in_sight}):
            stake = self._at_stake(k, chart) if k in in_sight else self._out_of_sight[k]
            if stake is None:
                continue
            if self._goes_out_of_reach(stake, leave):
                found.append(Loss(k, Reason.OUT_OF_REACH))
            elif k in in_sight and not self._is_visible_from(k, stake.curves, chart, leave):
                found.append(Loss(k, Reason.OUT_OF_SIGHT))
        return found

    def _goes_out_of_reach(self, stake: _Stake, leave: Point) -> bool:
        """Whether it is in reach here, and not from a leave point on or, without a look ahead, from there."""
        robot = self.robot
        if not is_in_reach(robot.position, stake.curves, robot.radius):
            return False
        if not self.lookahead:
            return not is_in_reach(leave, stake.curves, robot.radius)
        return stake.horizon.order(leave.y) < 0

    def _is_visible_from(self, obstacle: int, curves: Sequence[Curve], chart: KnownMap, leave: Point) -> bool:
        """Whether by the map an obstacle is seen from a leave point on or, without a look ahead, there."""
        stop = Real(self.last) if self.lookahead else leave.y
        return self._sees(obstacle, curves, chart, leave.y, stop, including=True)


def _is_long(curve: Curve) -> bool:
    return not isinstance(curve, Segment) or curve.start is not curve.end
