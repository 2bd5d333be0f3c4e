"""Sensing along a path: what each piece adds to the map, and where obstacles come into sight or go out of it.

Nothing is sampled and there are no time steps. The path is divided into *legs*, each with an exact parameter
along it. What a leg shows is the union of what the families of views that start on it show and of the views
from its two ends (see `view_families`). Only obstacles that are not acquired yet are considered.
"""

from __future__ import annotations

from collections import ChainMap, deque
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from functools import cmp_to_key, partial
from typing import Any

from exactacq.errors import deciding
from exactacq.geometry.interval_union import Cover, Interval
from exactacq.geometry.points import Point
from exactacq.kernel.extents import Span
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.acquisition import Acquisition
from exactacq.sensing.end_names import Seen
from exactacq.sensing.event import SENSED, EventKind, Reason
from exactacq.sensing.family_filter import KnownSpans, inside
from exactacq.sensing.leg_sights import LegSights
from exactacq.sensing.leg_views import Covers, Shares, add
from exactacq.sensing.legs import Leg
from exactacq.sensing.straight_way import StraightWay
from exactacq.sensing.targets import Targets
from exactacq.sensing.underway import LegNews, Underway
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.visibility.place_facts import NOTHING_KNOWN, PlaceFacts
from exactacq.visibility.sensor_range import Range

VIEWS_KEPT = 64
"""Views from ends of legs that are remembered: enough for a walk along one boundary and back."""

ORDER = {kind: k for k, kind in enumerate(SENSED)}


@dataclass(slots=True)
class Notice:
    """A report from a place of a leg (``u`` on its rail); ``reason`` says why an obstacle was lost.

    The ``facts`` are those of the ends of gaps that close there.
    """

    kind: EventKind
    obstacle: int
    u: Real
    place: Point
    reason: Reason | None = None
    facts: PlaceFacts = NOTHING_KNOWN


def _in_order(leg: Leg, a: Notice, b: Notice) -> int:
    """The order of two reports along a leg: from one place by kind, then by obstacle."""
    return leg.order(a.u, b.u) or ORDER[a.kind] - ORDER[b.kind] or a.obstacle - b.obstacle


@dataclass(frozen=True)
class Ahead:
    """What a leg will show: its reports in order, and the covers that will grow."""

    leg: Leg
    notices: list[Notice]
    learned: dict[int, Cover]
    shares: Shares | None


class Sensor:
    """The sensor of a robot in one scene: what is known so far, and what is in sight.

    Obstacles are *targets*: by default all, with their whole boundaries.
    """

    def __init__(self, table: EdgeTable, range_: Range, targets: Targets | None = None) -> None:
        self.table, self.range = table, range_
        self.complex = VisibilityComplex(table, range_, () if targets is None else targets.cut)
        self.rails = self.complex.clipper.rails
        self.targets = Targets.whole(table, self.rails) if targets is None else targets
        self.covers: dict[int, Cover] = {}
        self._known: dict[int, list[Span]] = {}
        self.seen: set[int] = set()
        self.acquired: set[int] = set()
        self.incomplete: set[int] = set()
        self.in_sight: set[int] = set()
        self._views: deque[Seen] = deque(maxlen=VIEWS_KEPT)
        self._last: LegNews | None = None
        self._here: Point | None = None

    # -- moving ------------------------------------------------------------------------------------

    def visible(self, place: Point, k: int) -> list[tuple[int, Interval]]:
        """What is seen of an obstacle from a place: edges and intervals."""
        return self._shown(self._view(place), k)

    def _shown(self, view: Seen, k: int) -> list[tuple[int, Interval]]:
        ends = [(end.edge, end.pin) for end in self.targets.cut_ends.get(k, ()) if end.sees(view.place)]
        return [*(part for _, part in self.targets.within({k}, view.spans)), *ends]

    def look_around(self, place: Point) -> tuple[list[Notice], dict[int, Cover]]:
        """Take in the view from the start of the path; as `follow`."""
        with deciding("what is seen from {}", place):
            return self._looked_around(place)

    def _looked_around(self, place: Point) -> tuple[list[Notice], dict[int, Cover]]:
        view = self._view(place)
        near = sorted({*self.targets.of_edges(view.spans), *self.targets.cut_ends})
        seen = [k for k in near if self._shown(view, k)]
        learned = self._with_view(view, seen)
        notices = []
        for k in seen:
            notices.append(Notice(EventKind.SIGHT, k, Real(0), place))
            if self.targets.is_whole(k, ChainMap(learned, self.covers)):
                notices.append(Notice(EventKind.ACQUIRE, k, Real(0), place))
        self._here = place
        return self._settle(notices, learned)

    def follow(self, ahead: Ahead) -> tuple[list[Notice], dict[int, Cover]]:
        """Move along the leg that was looked along last; returns its reports and the covers that grew."""
        self._here = ahead.leg.end
        return self._settle(ahead.notices, ahead.learned)

    def ahead(self, leg: Leg, retraced: bool = False) -> Ahead:
        """What moving along a leg will tell; nothing is learned where the robot has been (*retraced*)."""
        obstacles = self._near(leg) - self.acquired
        if not obstacles:
            return Ahead(leg, [], {}, None)
        with deciding("what is seen on the way from {} to {}", leg.start, leg.end):
            shares = Shares(self.complex, self.targets, leg, obstacles, self._view, self._known)
            return Ahead(leg, *self._outcome(shares, retraced), shares)

    def upto(self, ahead: Ahead, leg: Leg, retraced: bool = False) -> Ahead:
        """What moving along a leg will tell that is the first part of one that was looked along.

        What is in sight up to its end is lost as the next leg begins. Nothing is learned where the robot has
        been (*retraced*).
        """
        assert ahead.shares is not None, "what is told was seen"
        leg.named.update(ahead.leg.named)
        notices = [
            n for n in ahead.notices if leg.order(n.u, leg.last) < (0 if n.kind is EventKind.LOSE else 1)
        ]
        with deciding("what is seen on the way from {} to {}", leg.start, leg.end):
            shares = ahead.shares.cut(leg)
            is_here = leg.start is self._here
            learned = {} if retraced else shares.taught(self.covers, self._known, is_here)
        return Ahead(leg, notices, learned, shares)

    def _outcome(self, shares: Shares, retraced: bool) -> tuple[list[Notice], dict[int, Cover]]:
        """The reports of a leg in order, and the covers that grow along it."""
        leg = shares.leg
        learned: dict[int, Cover] = {}
        if not retraced:
            # Where the robot is it has looked around.
            learned = shares.taught(self.covers, self._known, leg.start is self._here)
        now = ChainMap(learned, self.covers)
        # None of the obstacles was whole before: only one of which more is known now can be.
        more = self.targets.of_edges(learned)
        notices: list[Notice] = []
        # What is in sight at first is seen from the start: of what is not shown nothing is to be told.
        for k in sorted(shares.shown()):
            whole = self._acquired(shares, k) if k in more and self.targets.is_whole(k, now) else None
            if whole is None and k in self.in_sight and shares.is_in_sight(k):
                continue
            for notice in self._changes(shares, k):
                if whole is None or leg.order(notice.u, whole.u) < (
                    1 if notice.kind is EventKind.SIGHT else 0
                ):
                    notices.append(notice)
            if whole is not None:
                notices.append(whole)
        shares.note(notice.u for notice in notices)
        sense = 1 if leg.ahead else -1
        # In this order exact numbers are compared about once for each.
        notices.sort(key=lambda notice: (sense * notice.u.rough(), ORDER[notice.kind], notice.obstacle))
        notices.sort(key=cmp_to_key(partial(_in_order, leg)))
        return notices, learned

    def known_within(
        self, leg: Leg, u: Real, place: Point, covers: Covers, acquired: Collection[int]
    ) -> Underway:
        """The covers that grow up to a place of a leg, if *covers* are known before it; see `Underway`.

        Some obstacles may be *acquired* just there. What the last leg shows is kept.
        """
        if self._last is None or self._last.shares.leg is not leg:
            known = KnownSpans(covers, self.rails)
            shares = Shares(self.complex, self.targets, leg, self._near(leg), self._view, known, facts=True)
            self._last = LegNews(shares, covers)
        return self._last.upto(u, place, acquired)

    def shares(self, leg: Leg, way: StraightWay | None = None) -> Shares:
        """All that a leg shows, also of acquired obstacles; of a straight one as a *way* if that is there."""
        return Shares(self.complex, self.targets, leg, self._near(leg), self._view, way=way)

    def sights(self, leg: Leg, way: StraightWay | None = None) -> LegSights:
        """From where on a leg edges are seen, also those of acquired obstacles."""
        return LegSights(self.complex, leg, self._view, way)

    def savepoint(self, ahead: Ahead) -> Callable[[], None]:
        """A function that takes back what following a leg will have told. Linear in what that is."""
        obstacles = {notice.obstacle for notice in ahead.notices}
        acquired = (notice.obstacle for notice in ahead.notices if notice.kind is EventKind.ACQUIRE)
        edges = {e for k in acquired for e in self.targets.alone(k)}
        here, own = self._here, (self.seen, self.acquired, self.incomplete, self.in_sight)
        sets = [*((now, obstacles, now & obstacles) for now in own)]
        sets.append((self.complex.done, edges, self.complex.done & edges))
        covers, known = ({e: now.get(e) for e in ahead.learned} for now in (self.covers, self._known))

        def take_back() -> None:
            self._here = here
            for now, touched, before in sets:
                now.difference_update(touched)
                now.update(before)
            for e, cover in covers.items():
                _put_back(self.covers, e, cover)
                _put_back(self._known, e, known[e])

        return take_back

    def _settle(
        self, notices: list[Notice], learned: dict[int, Cover]
    ) -> tuple[list[Notice], dict[int, Cover]]:
        self.covers.update(learned)
        for e, cover in learned.items():
            self._known[e] = inside(cover, self.rails[e])
        for notice in notices:
            if notice.kind is EventKind.ACQUIRE:
                self.acquired.add(notice.obstacle)
                self.complex.done |= self.targets.alone(notice.obstacle)
                self.incomplete.discard(notice.obstacle)
                self.in_sight.discard(notice.obstacle)
            elif notice.kind is EventKind.LOSE:
                self.in_sight.discard(notice.obstacle)
            else:
                self.seen.add(notice.obstacle)
                self.incomplete.add(notice.obstacle)
                self.in_sight.add(notice.obstacle)
        return notices, learned

    def _near(self, leg: Leg) -> set[int]:
        """The obstacles with an edge that may be seen from the leg."""
        return self.targets.of_edges(self.table.lit(leg.spots, self.range.above))

    def _view(
        self,
        place: Point,
        own: tuple[int, ...] | None = None,
        facts: Callable[[], PlaceFacts] = lambda: NOTHING_KNOWN,
    ) -> Seen:
        """What is seen from a place on edges *own*, if known; the last are kept, for legs share ends.

        What else is known of the place is asked for where the view is made.
        """
        for kept in self._views:
            if kept.place is place:
                return kept
        made = Seen(self.table, self.rails, place, self.range, own, facts())
        self._views.appendleft(made)
        return made

    def _with_view(self, view: Seen, obstacles: list[int]) -> dict[int, Cover]:
        """The covers that grow by what a view shows of some obstacles."""
        learned: dict[int, Cover] = {}
        for k in obstacles:
            for e, interval in self._shown(view, k):
                add(learned, self.covers, e, interval)
        return learned

    # -- reports -----------------------------------------------------------------------------------

    def _changes(self, shares: Shares, k: int) -> Iterator[Notice]:
        """When an obstacle comes into sight and goes out of it; it is in sight over closed intervals."""
        leg, times = shares.leg, shares.times(k)
        in_sight, known = k in self.in_sight, k in self.seen
        for interval in times.intervals if leg.ahead else reversed(times.intervals):
            begin, end = (interval.low, interval.start), (interval.high, interval.end)
            if not leg.ahead:
                begin, end = end, begin
            if not in_sight:
                yield Notice(EventKind.REGAIN if known else EventKind.SIGHT, k, *begin)
                known = True
            in_sight = leg.order(end[0], leg.last) == 0
            if not in_sight:
                # Out of range, if all last views were as long as the range; else occluded.
                yield Notice(
                    EventKind.LOSE, k, *end, Reason.OCCLUSION if shares.is_short(k, end[0]) else Reason.RANGE
                )

    def _acquired(self, shares: Shares, k: int) -> Notice:
        """When an obstacle that is wholly known after a leg became so."""
        leg = shares.leg
        here = leg.start is self._here
        seen = {} if here else self._with_view(self._view(leg.start, leg.own(leg.first)), [k])
        acquisition = Acquisition(shares, k, ChainMap(seen, self.covers))
        u, place = acquisition.place()
        return Notice(EventKind.ACQUIRE, k, u, place, facts=acquisition.facts(place))


def _put_back(now: dict[int, Any], e: int, before: Any) -> None:
    """Give a key of a table the value that it had, None if none."""
    if before is None:
        now.pop(e, None)
    else:
        now[e] = before
