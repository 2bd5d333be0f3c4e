"""The audit of a sweep's moves: the Seed Spreader's rules replayed along the events and the path of a run.

Step by step the run's next move has to be the one that the rules allow: along the M-line to the next blocked
stretch, around what blocks it, out to an obstacle that is about to be lost, and back. Where obstacles block,
and where boundaries lie, is found by `exactacq.auditing.ground`; what was known is taken from the run's maps,
which `exactacq.auditing.knowledge` checks.
"""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

from flint import arb, fmpq

from exactacq.auditing.comparisons import (
    BITS,
    AuditedBody,
    Tracks,
    ball_sum,
    event_name,
    is_close,
    is_shorter_way,
    place_text,
    rational_on,
    same,
)
from exactacq.auditing.ground import CrossingPoint, Field, Stretch
from exactacq.auditing.knowledge import MOMENTS, is_whole
from exactacq.auditing.look_ahead import Answer, seen_later
from exactacq.auditing.places import distances_sq, near_points
from exactacq.auditing.rest_of_line import KnownPieces, Rest
from exactacq.auditing.visibility import Viewpoints, visible
from exactacq.cached import cached_property
from exactacq.errors import AuditError
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.progress import Meter
from exactacq.sensing.event import Ending, Event, EventKind, Occasion, Reason
from exactacq.strategies.run import Diversion, SeedSpreaderRun

MOVES = tuple(map(EventKind, ("start", "hit", "cross", "leave", "divert", "return", "stop")))
"""What the robot does on a sweep."""
JUST = fmpq(1, 10**100)
"""How far beyond a place it is asked what is in sight just after it: no edge is as short."""


class Replay:
    """A run of the Seed Spreader, followed move by move.

    ``here`` is where the robot is, after ``done`` pieces of the path; on the M-line that is ``at`` from S, on
    straight piece ``piece``, and ``ahead`` is the number of the next crossing point.
    """

    def __init__(
        self, run: SeedSpreaderRun, field: Field, bodies: Sequence[AuditedBody], tracks: Tracks, rng: Random
    ) -> None:
        self.run, self.field, self.bodies, self.tracks, self.rng = run, field, bodies, tracks, rng
        self.moves = [event for event in run.events if event.kind in MOVES]
        self.next = 1
        self.here, self.done = run.start, 0
        self.at, self.piece, self.ahead = Real(0), 0, 0
        self.visits: list[int] = []
        self.encounters: list[int] = []
        self.again: list[int] = []
        self.diverted = 0
        count = len(run.path)
        self.probes = set(rng.sample(range(count), min(MOMENTS, count)))

    # -- the order of moves ------------------------------------------------------------------------

    @property
    def upcoming(self) -> Event:
        """The move that comes next."""
        return self.moves[self.next]

    def name(self, event: Event) -> str:
        return event_name(self.run, event)

    def check(self, meter: Meter) -> None:
        """Follow the M-line to its end, or to where the run is trapped."""
        if not same(self.here, self.field.pieces[0].start):
            raise AuditError(f"the run starts at {place_text(self.here)}, not in the SW corner")
        trapped = False
        while self.upcoming.kind is not EventKind.STOP:
            meter.add()
            self._advance(self.upcoming)
            if self.upcoming.kind in (EventKind.HIT, EventKind.CROSS):
                trapped = not self._meet()
                if trapped:
                    break
            elif self.upcoming.kind is EventKind.DIVERT:
                self._divert(None)
            else:
                raise AuditError(f"{self.name(self.upcoming)} comes on the M-line")
        self._stop(trapped)
        for what, claimed, found in (
            ("visits", self.run.visits, self.visits),
            ("encounters", self.run.encounters, self.encounters),
            ("encounters of known obstacles", self.run.again, self.again),
        ):
            if list(claimed) != found:
                raise AuditError(f"{what} are {list(claimed)}, but the moves make {found}")
        if self.diverted != len(self.run.diversions):
            raise AuditError(f"diversions are {len(self.run.diversions)}, the moves make {self.diverted}")

    def _stop(self, trapped: bool) -> None:
        """The run ends at T, or where a hit leaves no way on."""
        stop = self.upcoming
        if not trapped:
            self._advance(stop)
            if self.at != self.field.bases[-1]:
                raise AuditError(f"{self.name(stop)} comes before the end of the M-line")
            self._turn()
        if stop.kind is not EventKind.STOP or stop.after != self.done or self.next != len(self.moves) - 1:
            raise AuditError(f"{self.name(stop)} is no stop at {place_text(self.here)}")
        due = (Ending.TRAPPED, self.encounters[-1]) if trapped else (Ending.END_OF_M_LINE, None)
        if (stop.ending, stop.obstacle) != due:
            raise AuditError(f"{self.name(stop)} is due to {stop.note!r}, but trapped is {trapped}")

    def _take(self, kind: EventKind, obstacle: int, occasion: Occasion | None = None) -> Event:
        """The next move, which has to be of that kind, about that obstacle, on that occasion, and here."""
        event = self.upcoming
        if (event.kind, event.obstacle, event.after) != (kind, obstacle, self.done):
            raise AuditError(
                f"{self.name(event)} comes after {event.after} pieces, but {kind} of obstacle {obstacle} "
                f"is due after {self.done}"
            )
        if (event.occasion, event.other) != (occasion, None):
            raise AuditError(f"{self.name(event)} is due on the occasion {occasion}, not {event.note!r}")
        self.next += 1
        return event

    # -- along the M-line --------------------------------------------------------------------------

    def _advance(self, event: Event) -> None:
        """Follow the M-line to an event, not past a place where it is blocked."""
        while self.done < event.after:
            if self.at == self.field.bases[self.piece + 1]:
                self._turn()
                if self.piece == len(self.field.pieces):
                    raise AuditError(f"piece {self.done} goes on from the end of the M-line")
            piece = self.run.path[self.done]
            at = self.field.position(self.piece, piece.end) if piece.kind == "straight" else None
            if at is None or not at > self.at:
                raise AuditError(f"piece {self.done} does not advance on the M-line")
            if self.ahead < len(self.field.marks) and self.field.marks[self.ahead].at < at:
                place = place_text(self.field.marks[self.ahead].point)
                raise AuditError(f"piece {self.done} follows the M-line where it is blocked, at {place}")
            self._check_line(piece.curve)
            self.here, self.at = piece.end, at
            self.done += 1

    def _turn(self) -> None:
        """Go on to the next straight piece of the M-line: no obstacle must be left on the line that ends."""
        if self._line is not None:
            for k in self._at_stake(self._chart()):
                raise AuditError(f"obstacle {k} is lost at the end of the line at {place_text(self.here)}")
        self.piece += 1

    @property
    def _line(self) -> fmpq | None:
        """The abscissa of the eastern line that the robot is on."""
        return self.field.lines[self.piece // 2] if self.piece % 2 == 0 and self.piece else None

    @property
    def _line_end(self) -> Point:
        return self.field.pieces[self.piece].end

    def _meet(self) -> bool:
        """Walk around what blocks the M-line here; False if there is no way on."""
        event, marks = self.upcoming, self.field.marks
        mark = marks[self.ahead] if self.ahead < len(marks) else None
        if mark is None or mark.ends or mark.at != self.at or mark.owner != event.obstacle or not mark.ashore:
            raise AuditError(f"{self.name(event)} is not where an obstacle begins to block the M-line")
        assert mark.owner is not None
        while self.piece < mark.piece:
            self._turn()
        met = self._is_acquired(mark.owner, event)
        self._take(EventKind.CROSS if met else EventKind.HIT, mark.owner, Occasion.M_LINE)
        self.encounters.append(mark.owner)
        if met:
            self.again.append(mark.owner)
        else:
            self._circumnavigate(mark.owner, event)
        later = range(self.ahead + 1, len(marks))
        ends = [n for n in later if marks[n].ends and marks[n].ashore and marks[n].owner == mark.owner]
        if not ends:
            return False
        leave = marks[ends[0]]
        if same(self.here, mark.point):
            while self.upcoming.kind is EventKind.DIVERT:
                self._divert(leave)
            self._check_hop(leave)
        self._walk(mark.owner, leave.point, self.upcoming)
        self._take(EventKind.LEAVE, mark.owner, Occasion.M_LINE)
        self.at, self.piece, self.ahead = leave.at, leave.piece, ends[0] + 1
        return True

    def _is_acquired(self, obstacle: int, event: Event) -> bool:
        """Whether all of an obstacle was known before a move."""
        n = next(n for n, other in enumerate(self.run.events) if other is event)
        return any((e.kind, e.obstacle) == (EventKind.ACQUIRE, obstacle) for e in self.run.events[:n])

    # -- along boundaries --------------------------------------------------------------------------

    def _circumnavigate(self, i: int, event: Event) -> None:
        """The whole loop counterclockwise, or a walk to the last end and the first, unless it began there."""
        body, first = self.bodies[i], self.done
        if body.closed:
            self._follow(i, True, self.here, event)
            walked = ball_sum([piece.curve for piece in self.run.path[first : self.done]])
            if not is_close(walked, self._perimeters[i]):
                raise AuditError(f"obstacle {i} was not walked all around after {self.name(event)}")
        else:
            start, end = body.curves[0].start, body.curves[-1].end
            from_start = same(self.here, start)
            if not same(self.here, end):
                self._follow(i, True, end, event)
            if not from_start:
                self._follow(i, False, start, event)
        self.visits.append(i)

    @cached_property
    def _perimeters(self) -> list[arb]:
        return [ball_sum(body.curves) for body in self.bodies]

    def _follow(self, i: int, forward: bool, goal: Point, event: Event) -> None:
        """Follow a boundary in one sense until a point of it is reached."""
        for k in range(self.done, len(self.run.path)):
            piece, track = self.run.path[k], self.tracks[k]
            if piece.obstacle != i or track is None or track.forward is not forward:
                break
            self.here, self.done = piece.end, k + 1
            if same(self.here, goal):
                return
        raise AuditError(f"obstacle {i} was not walked all around after {self.name(event)}")

    def _walk(self, i: int, goal: Point, event: Event) -> None:
        """Walk a boundary to a point of it, up to an event: the shorter way, of two equal ones ahead."""
        first = self.done
        senses = set()
        for k in range(first, event.after):
            piece, track = self.run.path[k], self.tracks[k]
            if piece.obstacle != i or track is None:
                raise AuditError(f"piece {k} before {self.name(event)} is not along obstacle {i}")
            senses.add(track.forward)
            self.here, self.done = piece.end, k + 1
        if len(senses) > 1 or not same(self.here, goal):
            raise AuditError(f"{self.name(event)} is not reached by one walk to {place_text(goal)}")
        walk = [piece.curve for piece in self.run.path[first : self.done]]
        if self.bodies[i].closed and not is_shorter_way(walk, self._perimeters[i], senses):
            raise AuditError(f"{self.name(event)} is not reached the shorter way")

    # -- diversions --------------------------------------------------------------------------------

    def _divert(self, leap: CrossingPoint | None) -> None:
        """Out to an obstacle, around it, and back; *leap* is where another one that was hit will be left."""
        event = self.upcoming
        if self.diverted == len(self.run.diversions):
            raise AuditError(f"{self.name(event)} is in no list of diversions")
        told = self.run.diversions[self.diverted]
        self._take(EventKind.DIVERT, told.obstacle)
        if (told.first, told.reason) != (event.after, event.reason) or not same(told.leave, self.here):
            raise AuditError(f"{self.name(event)} is not diversion {self.diverted}")
        if self._line is None and self.at == self.field.bases[self.piece + 1]:
            self._turn()
        leave, i = self.here, told.obstacle
        chart = self.run.map_at(event)
        if self._line is None or i not in self._at_stake(chart):
            raise AuditError(f"{self.name(event)}: the obstacle is not at stake on an eastern line")
        self._check_reason(event, chart, leap)
        aim = self._aim(event, told, chart)
        self._check_told(event, chart)
        out = self._stretches(leave, aim)
        self._go(out, aim, i)
        if not same(told.hit, self.here):
            raise AuditError(f"diversion {self.diverted} did not reach {place_text(told.hit)}")
        self._circumnavigate(i, event)
        self._walk(i, told.hit, self.upcoming)
        self._take(EventKind.LEAVE, i, Occasion.DIVERSION)
        # The way back is the way out: its places, made anew from the other end, would have other forms.
        way_back = [s.reversed() for s in reversed(out)]
        self._go(way_back if aim is told.hit else self._stretches(told.hit, leave), leave, None)
        back = self._take(EventKind.RETURN, i)
        if (told.last, told.reason) != (back.after, back.reason):
            raise AuditError(f"{self.name(back)} is not the end of diversion {self.diverted}")
        self.diverted += 1

    def _stretches(self, start: Point, end: Point) -> list[Stretch]:
        """The blocked stretches of the straight way between two places, which may be one."""
        return [] if same(start, end) else self.field.stretches(Segment(start, end))

    def _go(self, stretches: Sequence[Stretch], goal: Point, aimed: int | None) -> None:
        """Go straight, around what blocks stretches of the way, to its end, or to the obstacle aimed at."""
        done, occasion = Real(0), Occasion.WAY_BACK if aimed is None else Occasion.WAY_OUT
        while stretch := next((s for s in stretches if s.low >= done), None):
            self._step(stretch.begin)
            event, k = self.upcoming, self.field.owner(stretch.obstacle, stretch.begin)
            if k is None or not self.field.is_ashore(k, stretch.begin):
                raise AuditError(f"{self.name(event)} is on a boundary that cannot be reached")
            self._take(EventKind.HIT, k, occasion)
            if aimed is not None:
                self.encounters.append(k)
            if not self._is_acquired(k, event):
                if k == aimed:
                    return
                self._circumnavigate(k, event)
            ends = [s for s in stretches if self._is_left(s, k)]
            if not ends or not ends[-1].high > stretch.low:
                raise AuditError(f"{self.name(event)}: the obstacle closes the way")
            self._walk(k, ends[-1].end, self.upcoming)
            self._take(EventKind.LEAVE, k, occasion)
            done = ends[-1].high
        self._step(goal)
        if aimed is not None:
            self._take(EventKind.HIT, aimed, Occasion.DIVERSION)
            self.encounters.append(aimed)

    def _is_left(self, stretch: Stretch, component: int) -> bool:
        """Whether a stretch ends at a component's walkable boundary."""
        obstacle: Any = self.run.obstacles[component]
        return stretch.obstacle == obstacle.obstacle.index and self.field.is_ashore(component, stretch.end)

    def _step(self, goal: Point) -> None:
        """Go straight to a point, in pieces that follow each other on the way there."""
        event = self.upcoming
        for k in range(self.done, event.after):
            piece = self.run.path[k]
            onward = piece.kind == "straight" and not same(self.here, goal)
            arrives = onward and same(piece.end, goal)
            if not arrives and not (onward and Segment(self.here, goal).passes(piece.end)):
                raise AuditError(f"piece {k} is not on the way to {place_text(goal)}")
            self.here, self.done = piece.end, k + 1
        if not same(self.here, goal):
            raise AuditError(f"{self.name(event)} comes before {place_text(goal)} is reached")
        self.here = goal

    def _aim(self, event: Event, told: Diversion, chart: Any) -> Point:
        """The point aimed at: the nearest known one, or the nearest visible one if there is one."""
        known = self._known(chart, told.obstacle)
        points = [p for curve in known for p in near_points(curve, self.here)]
        sizes = [(p - self.here).norm_sq() for p in points]
        least = min(sizes)
        aims = [p for p, size in zip(points, sizes, strict=True) if size == least]
        hit = told.hit
        if self.run.target == "visible" and not any(self._sees(p) for p in aims):
            if self._sees(hit) and chart.knows(told.obstacle, hit):
                return hit
            if self._is_visible(told.obstacle, self.here):
                raise AuditError(f"{self.name(event)} does not aim at a visible point")
        if (hit - self.here).norm_sq() == least and chart.knows(told.obstacle, hit):
            return hit
        for aim in aims:
            if Segment(self.here, aim).passes(hit):
                return aim
        raise AuditError(f"{self.name(event)} does not aim at the nearest known point")

    def _sees(self, point: Point) -> bool:
        return visible(self.field.world, self.run.radius, self.here, point)

    def _is_visible(self, obstacle: int, place: Point) -> bool | None:
        """Whether something of an obstacle is in sight; None, for unknown, from an irrational place."""
        if place.rational is None:
            return None
        body = self.bodies[obstacle]
        lookout = Viewpoints(self.field.world, self.run.radius, body.curves, body.edges)
        return lookout.first(place) is not None

    def _just_after(self) -> Point | None:
        """A rational place of the line about `JUST` beyond this one; None where the line is blocked."""
        if self.ahead < len(self.field.marks) and self.field.marks[self.ahead].at == self.at:
            return None
        mantissa, exponent = self.here.y.ball(BITS).mid().man_exp()
        sense = (self._line_end.y - self.here.y).sign()
        place = Point(self._line, fmpq(mantissa) * fmpq(2) ** int(exponent) + sense * JUST)
        return place if (place.y - self.here.y).sign() == sense else None

    # -- what is about to be lost ------------------------------------------------------------------

    def _chart(self, place: Point | None = None) -> Any:
        """The map here, or at a place on the next piece."""
        here = self.here if place is None else place
        return self.run.map_at(
            Event(EventKind.MOMENT, here, None, self.done, self.run.path, place is not None)
        )

    def _at_stake(self, chart: Any) -> list[int]:
        """Incomplete obstacles that are known west of the line, and not to block the rest of the M-line."""
        found = []
        for k in chart.incomplete:
            west = any(self._is_west(curve) for curve in self._known(chart, k))
            marks = (m for m in self.field.marks[self.ahead :] if m.owner == k and m.ashore)
            if west and not any(chart.knows(k, mark.point) for mark in marks):
                found.append(k)
        return found

    def _is_west(self, curve: Curve | Point) -> bool:
        points = [curve] if isinstance(curve, Point) else [curve.start, curve.end]
        if isinstance(curve, Arc):
            west = Point(curve.center.x - curve.radius, curve.center.y)
            points += [west] if curve.contains(west) else []
        return any(point.x < self._line for point in points)

    def _known(self, chart: Any, i: int) -> list[Curve | Point]:
        """The known parts of an obstacle: curves, and single points."""
        found: list[Curve | Point] = []
        for part in chart.known(i):
            edge = self.bodies[i].curves[part.edge]
            if is_whole(edge, part):
                found.append(edge)
            else:
                single = same(part.start, part.end)
                found.append(part.start if single else edge.part(part.start, part.end))
        return found

    def _beyond_reach(self, chart: Any, obstacle: int, start: Point, stop: Point) -> int:
        """1 if all that is known of an obstacle is out of reach of a part of the line, 0 if just not."""
        rest = start if same(start, stop) else Segment(start, stop)
        square, order = self.run.radius**2, 1
        for curve in self._known(chart, obstacle):
            for size in distances_sq(curve, rest):
                order = min(order, size.compare(square))
                if order < 0:
                    return order
        return order

    def _check_reason(self, event: Event, chart: Any, leap: CrossingPoint | None) -> None:
        """An obstacle is about to be lost here, or when the robot has gone around another one to *leap*."""
        assert event.obstacle is not None
        i, reason, name = event.obstacle, event.reason, self.name(event)
        over = leap is not None and leap.piece > self.piece
        onward = self.here if leap is None or over else leap.point
        stop = self._line_end if self.run.lookahead or reason is Reason.OVERDUE else onward
        if reason is Reason.LINE_ENDS:
            is_due = over or self.at == self.field.bases[self.piece + 1]
        elif over:
            is_due = False
        elif reason is Reason.OUT_OF_REACH and leap is None:
            is_due = all(self._beyond_reach(chart, i, onward, end) == 0 for end in (onward, stop))
        elif reason is Reason.OUT_OF_REACH or (reason is Reason.OVERDUE and leap is None):
            is_due = self._beyond_reach(chart, i, onward, stop) > 0
        elif reason is Reason.OUT_OF_SIGHT:
            after = self._just_after() if leap is None else None
            is_due = self._is_visible(i, self.here) is not False
            is_due &= after is None or not self._is_visible(i, after)
            if self.run.lookahead or leap is not None:
                self._check_unseen_later(name, chart, i, leap)
        else:
            is_due = False
        if not is_due:
            raise AuditError(f"{name} is due to {event.note!r}, which is not so")

    def _check_told(self, event: Event, chart: Any) -> None:
        """What the decision says is about to be lost is at stake, and as far away as it says.

        The nearest visible point of an obstacle may be farther than the nearest known one.
        """
        decision = event.decision
        others = () if decision is None else ((decision.chosen, decision.length), *decision.others)
        stakes = self._at_stake(chart)
        for k, length in others:
            if not isinstance(k, int) or length is None or k not in stakes:
                raise AuditError(f"the decision at {self.name(event)}: obstacle {k} is not about to be lost")
            known = self._known(chart, k)
            near = min((p - self.here).norm_sq() for curve in known for p in near_points(curve, self.here))
            order = (length.algebraic**2).compare(near)
            is_size = length.is_algebraic and length.sign() >= 0
            if not is_size or order < 0 or (order > 0 and self.run.target == "known"):
                raise AuditError(f"the decision at {self.name(event)}: obstacle {k} is not so far away")

    def _check_unseen_later(self, name: str, chart: Any, i: int, leap: CrossingPoint | None) -> None:
        """By the map nothing of an obstacle is seen from the rest of the line."""
        answer = self._seen_later(chart, i, self.here if leap is None else leap.point, leap is not None)
        if answer.sees:
            raise AuditError(f"{name} is needless: by the map {answer.goal} is seen from {answer.place}")

    def _seen_later(self, chart: Any, i: int, start: Point, including: bool) -> Answer:
        """What by the map is seen of an obstacle from the rest of the line, or from its start alone.

        The start is left out unless *including*, which also means that without a look ahead it is all.
        """
        stop = self._line_end if self.run.lookahead else start
        known = self._known(chart, i)
        others = [c for k in chart.seen if k != i for c in self._known(chart, k) if not isinstance(c, Point)]
        targets = [curve for curve in known if not isinstance(curve, Point)]
        points = [point for point in known if isinstance(point, Point)]
        return seen_later(Rest(start, stop, including), KnownPieces(targets, points, others), self.run.radius)

    def _share(self) -> fmpq:
        return fmpq(self.rng.randrange(1, 1 << 10), 1 << 10)

    def _check_rest(self, chart: Any, start: Point, where: str) -> None:
        """Obstacles at stake are in reach of the line from a place on."""
        for k in self._at_stake(chart):
            if self._beyond_reach(chart, k, start, self._line_end) > 0:
                raise AuditError(
                    f"obstacle {k} is out of reach {where} at {place_text(start)}, without a diversion"
                )

    def _check_line(self, curve: Curve) -> None:
        """Along the next piece nothing is lost that is at stake."""
        if self._line is None:
            return
        self._check_rest(self._chart(), self.here, "on the line")
        place = rational_on(curve, self._share()) if isinstance(curve, Segment) else None
        if self.done in self.probes and place is not None:
            self._check_rest(self._chart(place), place, "on the line")
        passed = [e for e in self._after_last_move() if e.after == self.done]
        for n, event in enumerate(passed):
            if event.kind is EventKind.LOSE:
                later = (e for e in passed[n + 1 :] if e.obstacle == event.obstacle)
                back = next(later, None)
                if back is not None and same(back.point, event.point):
                    continue
                self._check_lost(event)

    def _after_last_move(self) -> list[Event]:
        """The events since the robot began or went on to follow this line."""
        events = self.run.events
        last = next(n for n, event in enumerate(events) if event is self.moves[self.next - 1])
        return list(events[last + 1 :])

    def _check_lost(self, event: Event) -> None:
        """What goes out of sight without a diversion is not at stake, or by the map it is seen later."""
        assert event.obstacle is not None
        after = Event(EventKind.MOMENT, self.run.path[self.done].end, None, self.done + 1, self.run.path)
        if not any(self._is_west(c) for c in self._known(self.run.map_at(after), event.obstacle)):
            return  # Nor is it known west of the line before: that spares a map within a piece.
        chart = self.run.map_at(event)
        if event.obstacle not in self._at_stake(chart):
            return
        if self.run.lookahead:
            answer = self._seen_later(chart, event.obstacle, event.point, False)
            if answer.sees or answer.is_open:
                return
        raise AuditError(f"{self.name(event)} is not followed by a diversion")

    def _is_in_sight(self, obstacle: int) -> bool:
        """Whether by the events an obstacle is in sight here; one that is lost here is, at this place."""
        state = False
        for event in self.run.events:
            if event.obstacle != obstacle or (event.after, event.inside) > (self.done, False):
                continue
            if event.kind in (EventKind.SIGHT, EventKind.REGAIN):
                state = True
            elif event.kind is EventKind.LOSE and event.after < self.done:
                state = False
        return state

    def _check_hop(self, leave: CrossingPoint) -> None:
        """Nothing that is at stake is lost between a hit and the leave point."""
        if self._line is None:
            return
        chart = self._chart()
        if leave.piece == self.piece:
            self._check_rest(chart, leave.point, "beyond the obstacle")
            for k in self._at_stake(chart):
                if not self._is_in_sight(k):
                    continue
                answer = self._seen_later(chart, k, leave.point, True)
                if not (answer.sees or answer.is_open):
                    where = place_text(leave.point)
                    raise AuditError(
                        f"obstacle {k} is lost without a diversion: it is not seen from {where} on"
                    )
        else:
            for k in self._at_stake(chart):
                raise AuditError(
                    f"obstacle {k} is lost where the line ends, before {place_text(leave.point)}"
                )
