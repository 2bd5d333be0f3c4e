"""Memory: the sensing of a whole path, piece by piece, and the map as it was at any moment of it.

What a piece added is kept with the edges that changed, so a run remembers every moment in memory proportional
to what was learned, and a map of any of them is made at once: it looks edges up when it is asked.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

from flint import fmpq

from exactacq.errors import Undecided, deciding
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.interval_union import EMPTY, Cover
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.scene import Scene
from exactacq.scene.terrain_components import Ground
from exactacq.sensing.event import Event, EventKind, Reason
from exactacq.sensing.leg_facts import LegFacts
from exactacq.sensing.leg_views import Covers
from exactacq.sensing.legs import HaltPlace, Leg, legs_of, parts_of
from exactacq.sensing.map import Body, Map
from exactacq.sensing.path import Path, Piece
from exactacq.sensing.sensor import Ahead, Notice, Sensor
from exactacq.sensing.targets import Targets
from exactacq.visibility.place_facts import NOTHING_KNOWN, PlaceFacts
from exactacq.visibility.sensor_range import Range

Own: TypeAlias = "tuple[int, ...] | None"
"""The edges through a place, if they are known."""


@dataclass(slots=True)
class Report:
    """A notice placed on the path: after ``after`` whole pieces, or inside the piece of that number.

    Its place is that of parameter ``u`` on the piece's leg number ``leg``: numbers that families share, so
    that ties are free.
    """

    kind: EventKind
    obstacle: int
    place: Point
    u: Real
    leg: int
    reason: Reason | None
    after: int
    inside: bool

    def event(self, path: Path) -> Event:
        """The event on the whole path."""
        return Event(self.kind, self.place, self.obstacle, self.after, path, self.inside, reason=self.reason)


def _facts_at(ahead: Ahead, halt: Notice) -> PlaceFacts:
    """What a leg that was looked along tells of the view from where the robot halts on it.

    It halts as something happens there: so families of views end there, or what they show.
    """
    assert ahead.shares is not None, "what is told was seen"
    facts = LegFacts(ahead.shares.ending_at(halt.u)).at(halt.u, halt.place)
    for notice in ahead.notices:
        if notice.place is halt.place:
            facts = facts.joined(notice.facts)
    return facts


def _report(notice: Notice, leg: int, after: int, inside: bool) -> Report:
    return Report(notice.kind, notice.obstacle, notice.place, notice.u, leg, notice.reason, after, inside)


class History:
    """The covers of all edges after the look around at the start and after each leg, the latest included.

    An edge has an entry for every time that it changed. To learn costs time proportional to what changed.
    """

    def __init__(self) -> None:
        self.moments = 0
        self._of: dict[int, tuple[list[int], list[Cover]]] = {}

    def learn(self, learned: Mapping[int, Cover]) -> None:
        """Take in the covers that one more leg made grow."""
        for e, cover in learned.items():
            moments, covers = self._of.setdefault(e, ([], []))
            moments.append(self.moments)
            covers.append(cover)
        self.moments += 1

    def cut(self, count: int) -> None:
        """Forget all but the first *count* moments. Linear in the edges of which something is known."""
        for moments, covers in self._of.values():
            kept = bisect_left(moments, count)
            del moments[kept:], covers[kept:]
        self._of = {e: entry for e, entry in self._of.items() if entry[0]}
        self.moments = count

    def cover(self, edge: int, count: int) -> Cover | None:
        """What was known of an edge after *count* legs. Cost: a binary search among its changes."""
        entry = self._of.get(edge)
        if entry is None:
            return None
        moments, covers = entry
        k = bisect_right(moments, count)
        return covers[k - 1] if k else None

    def edges(self, count: int) -> Iterator[int]:
        """The edges of which something was known after *count* legs."""
        return (e for e, (moments, _) in self._of.items() if moments[0] <= count)


class Moment(Mapping[int, Cover]):
    """The covers as they were after *count* legs, but for those in *newer*. Made in constant time.

    What is learned later does not change it.
    """

    __slots__ = ("_count", "_history", "_newer")

    def __init__(self, history: History, count: int, newer: Mapping[int, Cover]) -> None:
        self._history, self._count, self._newer = history, count, newer

    def grown(self, learned: Mapping[int, Cover]) -> Moment:
        """With covers that grew since."""
        return Moment(self._history, self._count, {**self._newer, **learned})

    def __getitem__(self, edge: int) -> Cover:
        found: Cover | None = self.get(edge)
        if found is None:
            raise KeyError(edge)
        return found

    def get(self, edge: int, default: Any = None) -> Any:
        """The cover of an edge; that nothing is known of many is no error."""
        found = self._newer.get(edge) or self._history.cover(edge, self._count)
        return default if found is None else found

    def __iter__(self) -> Iterator[int]:
        return iter(dict.fromkeys((*self._history.edges(self._count), *self._newer)))

    def __len__(self) -> int:
        return sum(1 for _ in self)


class Memory:
    """What a robot has learned on its way so far, with all ``reports``. *radius* is rational and positive.

    On a *ground* its components take the place of the scene's obstacles.
    """

    def __init__(
        self,
        scene: Scene,
        radius: fmpq,
        table: EdgeTable | None = None,
        ground: Ground | None = None,
    ) -> None:
        self.scene, self.radius, self.ground = scene, radius, ground
        self._table = EdgeTable(scene.obstacles) if table is None else table
        self.bodies: Sequence[Body] = scene.obstacles if ground is None else ground.components
        range_ = Range(radius)
        targets = None if ground is None else Targets.of_components(ground.components, self._table, range_)
        self._sensor = Sensor(self._table, range_, targets)
        self.reports: list[Report] = []
        # The number of reports before every piece, and of all.
        self._report_counts: list[int] = []
        self._looked: tuple[Piece | None, Piece | None, Ahead | None] = None, None, None
        self._halt: HaltPlace | None = None
        self._walked: set[tuple[object, object]] = set()
        # The last straight piece that did not go back on an earlier one, until the robot leaves it.
        self._way: Curve | None = None
        self._walked_on: dict[int, Cover] = {}
        self._retraced: set[int] = set()
        self._history = History()
        self._news: set[int] = set()
        self._facts: tuple[Leg | None, LegFacts | None] = None, None
        self._legs: list[list[Leg]] = []
        # The number of legs before every piece, and of all.
        self._before = [0]

    @classmethod
    def of(
        cls, scene: Scene, radius: fmpq, start: Point, path: Iterable[Piece], ground: Ground | None = None
    ) -> Memory:
        """The memory of a robot that walked a path."""
        memory = cls(scene, radius, ground=ground)
        memory.begin(start)
        for piece in path:
            memory.walk(piece)
        return memory

    @property
    def seen(self) -> set[int]:
        """The obstacles of which some point is known by now."""
        return self._sensor.seen

    def begin(self, start: Point) -> list[Report]:
        """Look around at the start."""
        notices, learned = self._sensor.look_around(start)
        self._learn(learned)
        return self._reported([_report(n, 0, 0, False) for n in notices])

    def walk(self, piece: Piece) -> list[Report]:
        """Take in all that a piece of the path shows; the reports in the order in which they come.

        Where a comparison is `Undecided`, nothing of the piece is taken in.
        """
        ahead, halt = self._taken(piece)
        if ahead is None:
            legs = self._legs_of(piece)
        else:
            legs = [ahead.leg if halt is None else self._halted(ahead, halt)]
        count, reports, retraced = len(self._legs), [], self._is_retraced(piece, legs)
        self._note_walked(piece, legs)
        undo: list[Callable[[], None]] = []
        try:
            for k, leg in enumerate(legs):
                if ahead is None:
                    took = self._sensor.ahead(leg, retraced)
                else:
                    took = ahead if halt is None else self._sensor.upto(ahead, leg, retraced)
                if len(legs) > 1:
                    undo.append(self._savepoint(took))
                notices, learned = self._sensor.follow(took)
                self._learn(learned)
                for n in notices:
                    at_start = k == 0 and leg.order(n.u, leg.first) == 0
                    at_end = k == len(legs) - 1 and leg.order(n.u, leg.last) == 0
                    after = count + 1 if at_end and not at_start else count
                    inside = not (at_start or at_end)
                    reports.append(_report(n, k, after, inside))
        except Undecided:
            for take_back in reversed(undo):
                take_back()
            if undo:
                self._history.cut(1 + self._before[-1])
            raise
        self._legs.append(legs)
        self._before.append(self._before[-1] + len(legs))
        if retraced:
            self._retraced.add(count)
        return self._reported(reports)

    def _taken(self, piece: Piece) -> tuple[Ahead | None, Notice | None]:
        """What was looked along last, if the robot takes it, and where on it the robot halts, if it does.

        Nothing if nothing happens where it halts: then the part is looked along anew.
        """
        known, part, ahead = self._looked
        self._looked = None, None, None
        if ahead is None or known is piece:
            return ahead, None
        if piece is part:
            for notice in ahead.notices:
                if notice.place is piece.end and ahead.leg.order(notice.u, ahead.leg.first):
                    return ahead, notice
        return None, None

    def _halted(self, ahead: Ahead, halt: Notice) -> Leg:
        """The part of a leg that was looked along, up to where the robot halts."""
        part = ahead.leg.upto(halt.u, halt.place)
        facts, place = _facts_at(ahead, halt), halt.place
        if place.rational is None:
            facts.tell(self._table, place, self.radius * self.radius)
        way = len(self._table.curves)
        lines = tuple(((key, way, 0), ray) for ray in facts.rays for key in sorted(ray.lines))
        self._halt = HaltPlace(place, facts, lines)
        return replace(part, halts=(*part.halts, self._halt))

    def _savepoint(self, ahead: Ahead) -> Callable[[], None]:
        """A function that takes back what a leg will have told, but for the history."""
        forget, more = (
            self._sensor.savepoint(ahead),
            self._sensor.targets.of_edges(ahead.learned) - self._news,
        )

        def take_back() -> None:
            forget()
            self._news -= more

        return take_back

    def _learn(self, learned: Mapping[int, Cover]) -> None:
        self._history.learn(learned)
        self._news |= self._sensor.targets.of_edges(learned)

    def news(self) -> set[int]:
        """The obstacles of which more became known since the last time that this was asked."""
        news, self._news = self._news, set()
        return news

    def _is_retraced(self, piece: Piece, legs: list[Leg]) -> bool:
        """Whether all of a piece was walked before: of a straight one, if that was the other way.

        It shows what is known, in other forms of the same numbers: ties that need no proof.
        """
        if piece.obstacle is not None:
            return all(map(self._is_walked_on, legs))
        return (piece.end.key, piece.start.key) in self._walked or self._stays_on_way(piece)

    def _stays_on_way(self, piece: Piece) -> bool:
        """Whether a straight piece, which begins on the last way, is known to end there too."""
        try:
            # Farther on along the line, where most ways lead, it takes long to prove that they are on it.
            way = self._way
            return way is not None and way.contains(piece.end) and way.passes(piece.end)
        except Undecided:
            return False

    def _is_walked_on(self, leg: Leg) -> bool:
        """Whether the robot was on all of a leg on a boundary edge."""
        before = None if leg.edge is None else self._walked_on.get(leg.edge)
        return before is not None and before.added(leg.span) is before

    def _note_walked(self, piece: Piece, legs: list[Leg]) -> None:
        """Keep that the robot was on all of a piece."""
        if piece.obstacle is None:
            self._walked.add((piece.start.key, piece.end.key))
            if not self._stays_on_way(piece):
                self._way = piece.curve
            return
        self._way = None
        for leg in legs:
            if leg.edge is not None:
                self._walked_on[leg.edge] = self._walked_on.get(leg.edge, EMPTY).added(leg.span)

    def _legs_of(self, piece: Piece) -> list[Leg]:
        owner = piece.obstacle
        if owner is not None and self.ground is not None:
            owner = self.ground.components[owner].obstacle.index
        with deciding("what the way from {} to {} touches", piece.start, piece.end):
            legs = legs_of(self._table, self._sensor.rails, owner, piece.curve)
        halt = self._halt
        if halt is not None and piece.start is halt.place:
            first = legs[0] = replace(legs[0], halts=(halt,))
            if first.edge is None:
                first.tell_crossed(halt)
        return legs

    def parts(self, way: Segment) -> list[Segment]:
        """The parts of a straight way of which each is one leg (see `ahead`)."""
        with deciding("what the way from {} to {} touches", way.start, way.end):
            return [part for _, part in parts_of(self._table, way)]

    def divided(self, piece: Piece) -> list[Piece]:
        """A piece along a boundary in pieces of which each is one leg (see `ahead`)."""
        legs = self._legs_of(piece)
        if len(legs) == 1:
            return [piece]
        return [Piece(piece.kind, piece.obstacle, piece.curve.part(leg.start, leg.end)) for leg in legs]

    def ahead(self, piece: Piece) -> Ahead:
        """What a piece that is one leg will tell when it is walked next."""
        (leg,) = self._legs_of(piece)
        ahead = self._sensor.ahead(leg, self._is_retraced(piece, [leg]))
        for notice in ahead.notices:
            # What the way touches, its part to there does.
            leg.tell_touched(self._table, notice.place)
        self._looked = piece, None, ahead
        return ahead

    def shorten(self, part: Piece) -> None:
        """Tell that of the piece that was looked along last a part from its start is to be walked next."""
        known, _, ahead = self._looked
        self._looked = known, part, ahead

    def map_ahead(self, ahead: Ahead, u: Real, place: Point, obstacles: Set[int]) -> Map:
        """The map of some obstacles as it will be at a place of a piece that was looked along.

        Of others, and until the piece is walked, it is the map as it is.
        """
        covers = self._now
        if ahead.shares is not None and ahead.leg.order(u, ahead.leg.first) > 0:
            some = {k for k in obstacles if k in ahead.shares.obstacles}
            covers = covers.grown(ahead.shares.cut(ahead.leg.upto(u, place), some).taught(covers))
        return self._map(covers)

    def near(self, box: tuple[float, float, float, float]) -> set[int]:
        """The obstacles with an edge whose box is within the radius of a box."""
        x, y, right, top = box
        return self._sensor.targets.of_edges(self._table.around((x, y), (right, top), float(self.radius)))

    def visible(self, place: Point, obstacle: int) -> Iterator[tuple[Point, Point, Curve | None]]:
        """The parts of an obstacle in sight from a place: their ends, and their curves, None for a point."""
        for e, seen in self._sensor.visible(place, obstacle):
            if seen.low.compare(seen.high) == 0:
                yield seen.start, seen.start, None
            else:
                yield seen.start, seen.end, self._sensor.rails[e].curve.part(seen.start, seen.end)

    @property
    def now(self) -> Map:
        """The map as it is; what is learned later does not change it."""
        return self._map(self._now)

    @property
    def _now(self) -> Moment:
        return Moment(self._history, self._history.moments - 1, {})

    @property
    def acquired(self) -> Set[int]:
        """The obstacles that are wholly known."""
        return self._sensor.acquired

    @property
    def incomplete(self) -> Set[int]:
        """The obstacles of which some, but not all, is known."""
        return self._sensor.incomplete

    def after(self, count: int) -> Map:
        """The map after the first *count* pieces."""
        return self._map(Moment(self._history, self._before[count], {}))

    def within(self, count: int, place: Point) -> Map:
        """The map when the robot is at a place inside piece number *count*."""
        with deciding("what is known at {}", place):
            return self._within(count, place)

    def _within(self, count: int, place: Point) -> Map:
        legs, before = self._legs[count], self._before[count]
        if count in self._retraced:
            # What it shows is known, in other forms of the same numbers.
            return self._map(Moment(self._history, before, {}))
        found = self._leg_at(count, place)
        if found is None:
            return self._map(Moment(self._history, before + len(legs), {}))
        k, u = found
        known = Moment(self._history, before + k, {})
        if legs[k].order(u, legs[k].first) > 0:
            reports = self._reports_at(count, place)
            acquired = [report.obstacle for report in reports if report.kind is EventKind.ACQUIRE]
            newer = self._sensor.known_within(legs[k], u, place, known, acquired)
            known = Moment(self._history, before + k, newer)
        return self._map(known)

    def view_within(self, count: int, place: Point) -> tuple[Own, PlaceFacts]:
        """The edges through a place inside piece number *count*, and what else is known of the view from it.

        Its numbers may not tell, as on a way that touches something between its ends. There it costs what all
        views of a leg cost; those of the last leg are kept.
        """
        found = self._leg_at(count, place)
        if found is None:
            return None, NOTHING_KNOWN
        leg, u = self._legs[count][found[0]], found[1]
        if not leg.touches:
            return leg.own(u), NOTHING_KNOWN
        kept, facts = self._facts
        if facts is None or kept is not leg:
            facts = LegFacts(self._sensor.shares(leg))
            self._facts = leg, facts
        return leg.own(u), facts.at(u, place)

    def view_after(self, count: int, place: Point) -> tuple[Own, PlaceFacts]:
        """The edges through the place after the first *count* pieces, and what is known of the view there."""
        at = [(legs[-1], legs[-1].last) for legs in self._legs[:count][-1:]]
        at += [(legs[0], legs[0].first) for legs in self._legs[count:][:1]]
        own = next((own for leg, u in at if (own := leg.own(u)) is not None), None)
        facts = NOTHING_KNOWN
        for leg, _ in at:
            facts = facts.joined(leg.facts(self._table, place))
        return own, facts

    def _leg_at(self, count: int, place: Point) -> tuple[int, Real] | None:
        """The number of a leg of a piece on which a place is, and its parameter there."""
        # The last report there: where two legs meet there may be one of each.
        last = next(reversed(self._reports_at(count, place)), None)
        for k, leg in enumerate(self._legs[count]):
            if last is not None and k < last.leg:
                continue
            u = leg.rail.parameter(place) if last is None else last.u
            if leg.span.low.compare(u) <= 0 and leg.span.high.compare(u) >= 0:
                return k, u
        return None

    def report_count(self, count: int) -> int:
        """The number of reports from the start and from the first *count* pieces; 0 before it has begun."""
        return self._report_counts[count] if self._report_counts else 0

    def _reported(self, reports: list[Report]) -> list[Report]:
        self.reports += reports
        self._report_counts.append(len(self.reports))
        return reports

    def _reports_at(self, count: int, place: Point) -> list[Report]:
        """What was reported from a place of a piece."""
        reports = self.reports[self._report_counts[count] : self._report_counts[count + 1]]
        return [report for report in reports if report.place is place]

    def _map(self, covers: Covers) -> Map:
        return Map(self.bodies, self._sensor.targets, self._sensor.rails, covers)
