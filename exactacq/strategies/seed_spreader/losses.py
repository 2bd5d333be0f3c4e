"""When the Seed Spreader is about to lose an obstacle that it knows in part (paper, section 4.1).

On a line of the M-line, the first one aside, an incomplete obstacle with a known point to the west is about
to be lost where (i) it goes out of sight and, by the map, cannot be seen any more from the rest of the line,
(ii) what is known of it goes out of reach for the rest of the line, (iii) the line ends, (iv) the robot
comes back to the line, and it is out of reach already. Not so if it is known to block the rest of the M-line.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Callable, Container, Iterator, Sequence, Set
from typing import NamedTuple

from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.sensing.event import EventKind, Reason
from exactacq.sensing.legs import Leg
from exactacq.sensing.map import Map
from exactacq.sensing.sensor import Ahead, Notice
from exactacq.strategies.seed_spreader.horizon import Horizon, reach_begins
from exactacq.strategies.seed_spreader.prediction.decide import sees_later
from exactacq.strategies.seed_spreader.range_thresholds import first_out_of_reach, is_in_reach, leftmost
from exactacq.strategies.seed_spreader.robot import SeedSpreaderRobot


class Loss(NamedTuple):
    """An obstacle that is about to be lost."""

    obstacle: int
    reason: Reason


class _OutOfSight(NamedTuple):
    """A stretch over which an obstacle is not in sight: from a place, at a parameter, to an ordinate.

    ``fresh`` if it was seen at the place; ``end`` is None if it is not seen again on the way.
    """

    obstacle: int
    u: Real
    place: Point
    fresh: bool
    end: Real | None


class Line:
    """A line of the M-line as the robot walks it.

    What is out of sight, and of which nothing more became known, is asked about only where it may be about
    to be lost: obstacles at stake are kept by the ordinate from which on this may be.
    """

    def __init__(self, robot: SeedSpreaderRobot, lookahead: bool) -> None:
        way = robot.mline.pieces[robot.piece]
        end = way.end.rational
        assert end is not None, "the M-line's corners are rational"
        self.robot, self.lookahead = robot, lookahead
        self.x, self.last = end
        self.upward = way.direction.y.sign() > 0
        self.sense = 1 if self.upward else -1
        self.losses: list[Loss] = []
        robot.news()
        self._first: Real | None = None
        self._unsettled = set(robot.incomplete)
        self._from: dict[int, float] = {}
        self._by_ordinate: list[tuple[float, int]] = []

    # -- what is at stake --------------------------------------------------------------------------

    def _settle(self) -> None:
        """Look again at obstacles that are out of sight and of which more became known."""
        robot = self.robot
        self._unsettled |= robot.news()
        out_of_sight = self._unsettled - robot.in_sight
        self._unsettled -= out_of_sight
        for k in out_of_sight:
            if k in self._from:
                del self._by_ordinate[bisect_left(self._by_ordinate, (self._from.pop(k), k))]
            if k in robot.incomplete and (curves := self._at_stake(k, robot.map)):
                self._from[k] = self._earliest(curves)
                insort(self._by_ordinate, (self._from[k], k))

    def _earliest(self, curves: list[Curve]) -> float:
        """Pieces do not go out of reach before this ordinate, times the sense."""
        if self.lookahead:
            return self._horizon(curves).bounds[0]
        return reach_begins(self.sense, curves, self.robot.radius)

    def _due(self, before: Real) -> Iterator[int]:
        """Obstacles at stake that may go out of reach up to an ordinate, the first one first."""
        for earliest, k in self._by_ordinate:
            if earliest > self.sense * float(before):
                return
            yield k

    def _all_at_stake(self) -> list[int]:
        """All obstacles at stake."""
        self._unsettled |= self.robot.news()
        chart = self.robot.map
        some = {*self._from, *self._unsettled} & self.robot.incomplete
        return [k for k in sorted(some) if self._at_stake(k, chart)]

    # -- on the way --------------------------------------------------------------------------------

    def watch(self, ahead: Ahead) -> Point | None:
        """The first place of a way along the line where something is about to be lost.

        What it is, is in ``losses``. That it stops at a place depends on nothing that is learned later.
        """
        self.losses, self._first = [], None
        leg = ahead.leg
        notices: dict[int, list[Notice]] = {}
        for notice in ahead.notices:
            notices.setdefault(notice.obstacle, []).append(notice)
        for k in self._dormant(leg.end.y, notices):
            self._look(_OutOfSight(k, leg.first, leg.start, False, None), ahead)
        gaps = (gap for k in sorted(notices) for gap in self._gaps(k, notices[k], leg))
        for gap in sorted(gaps, key=lambda gap: gap.place.y, reverse=not self.upward):
            if self._first is not None and self._order(self._first, gap.place.y) < 0:
                break
            self._look(gap, ahead)
        return None if self._first is None else Point(self.x, self._first)

    def _look(self, gap: _OutOfSight, ahead: Ahead) -> None:
        """Note what is about to be lost in a gap, unless something else is before."""
        found = self._loss(gap, ahead)
        if found is None:
            return
        y, reason = found
        order = 1 if self._first is None else self._order(self._first, y)
        if order > 0:
            self._first, self.losses = y, []
        if order >= 0:
            self.losses.append(Loss(gap.obstacle, reason))

    def _order(self, a: Real, b: Real) -> int:
        return a.compare(b) * self.sense

    def _dormant(self, end: Real, others: Container[int]) -> Iterator[int]:
        """Obstacles out of sight that may be lost before a way ends, and before what is lost by then."""
        self._settle()
        for k in self._due(end):
            if self._first is not None and self._from[k] > self.sense * float(self._first):
                return
            if k not in self.robot.in_sight and k not in others:
                yield k

    def _gaps(self, k: int, notices: list[Notice], leg: Leg) -> Iterator[_OutOfSight]:
        """When an obstacle that is on the map, or comes on it, is out of sight, until it is acquired."""
        begin = None if k in self.robot.in_sight else (leg.first, leg.start, False)
        for notice in notices:
            if notice.kind is EventKind.LOSE:
                begin = notice.u, notice.place, True
            elif begin is not None:
                # Where it is lost and seen again at one place, nothing lies between.
                if self._order(begin[1].y, notice.place.y) < 0:
                    yield _OutOfSight(k, *begin, notice.place.y)
                begin = None
            if notice.kind is EventKind.ACQUIRE:
                return
        if begin is not None:
            yield _OutOfSight(k, *begin, None)

    def _loss(self, gap: _OutOfSight, ahead: Ahead) -> tuple[Real, Reason] | None:
        """Where, before the end of a gap and of the way, its obstacle is about to be lost, and why."""
        robot, y, k = self.robot, gap.place.y, gap.obstacle

        def chart(obstacles: Set[int]) -> Map:
            return robot.map_ahead(ahead, gap.u, gap.place, obstacles)

        # Asked first, as this spares the map.
        curves = self._at_stake(k, chart({k})) if robot.may_lie_west(k, self.x) else []
        if not curves:
            return None
        if gap.fresh and not (self.lookahead and self._sees(k, curves, chart, y, Real(self.last))):
            return y, Reason.OUT_OF_SIGHT
        horizon = self._horizon(curves)
        if horizon.order(y) < 0:
            return y, Reason.OVERDUE
        end = ahead.leg.end.y if gap.end is None else gap.end
        last = None
        if not self.lookahead:
            last = first_out_of_reach(self.x, self.upward, y, curves, robot.radius)
        if last is None and horizon.order(end) < 0:
            last = horizon.exact
        return (last, Reason.OUT_OF_REACH) if last is not None and self._order(last, end) < 0 else None

    def _horizon(self, curves: Sequence[Curve]) -> Horizon:
        return Horizon(self.x, self.upward, curves, self.robot.radius)

    def _at_stake(self, obstacle: int, chart: Map) -> list[Curve]:
        """What is known of an obstacle, if it is at stake: else nothing.

        So it is if it is incomplete, known west of the line, and not known to block what is left.
        """
        if not (self.robot.may_lie_west(obstacle, self.x) and chart.is_incomplete(obstacle)):
            return []
        curves = known(chart, obstacle)
        is_west = any(leftmost(curve).compare(self.x) < 0 for curve in curves)
        return curves if is_west and not self.robot.blocks_ahead(obstacle, chart) else []

    def _sees(
        self,
        obstacle: int,
        pieces: Sequence[Curve],
        chart: Callable[[Set[int]], Map],
        start: Real,
        stop: Real,
        including: bool = False,
    ) -> bool:
        """Whether by the map a point of an obstacle's known *pieces* is seen from between two ordinates.

        *chart* gives the map of some obstacles.
        """
        points = [curve.start for curve in pieces if not _is_long(curve)]
        targets = [curve for curve in pieces if _is_long(curve)]

        def blockers(field: Sequence[float]) -> list[Curve]:
            others = self.robot.meeting(field) - {obstacle}
            around = chart(others)
            return [*targets, *(c for k in sorted(others) for c in known(around, k) if _is_long(c))]

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
        found = []
        for k in sorted({*self._due(leave.y), *(robot.in_sight & robot.incomplete)}):
            curves = self._at_stake(k, chart)
            if not curves:
                continue
            if self._goes_out_of_reach(curves, leave):
                found.append(Loss(k, Reason.OUT_OF_REACH))
            elif k in robot.in_sight and not self._is_visible_from(k, curves, chart, leave):
                found.append(Loss(k, Reason.OUT_OF_SIGHT))
        return found

    def _goes_out_of_reach(self, curves: Sequence[Curve], leave: Point) -> bool:
        """Whether it is in reach here, and not from a leave point on or, without a look ahead, from there."""
        robot = self.robot
        if not is_in_reach(robot.position, curves, robot.radius):
            return False
        if not self.lookahead:
            return not is_in_reach(leave, curves, robot.radius)
        return self._horizon(curves).order(leave.y) < 0

    def _is_visible_from(self, obstacle: int, curves: Sequence[Curve], chart: Map, leave: Point) -> bool:
        """Whether by the map an obstacle is seen from a leave point on or, without a look ahead, there."""
        stop = Real(self.last) if self.lookahead else leave.y
        return self._sees(obstacle, curves, lambda _: chart, leave.y, stop, including=True)


def known(chart: Map, obstacle: int) -> list[Curve]:
    """The known pieces of an obstacle; a single point is a piece without length."""
    return [part.curve or Segment(part.start, part.start) for part in chart.known(obstacle)]


def _is_long(curve: Curve) -> bool:
    return not isinstance(curve, Segment) or curve.start is not curve.end
