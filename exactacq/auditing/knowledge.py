"""The audit of what a run knows: its maps in themselves, and against what its path sees."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate, chain
from random import Random
from typing import Any, NamedTuple

from flint import arb, fmpq

from exactacq.auditing.comparisons import (
    BITS,
    AuditedBody,
    Tracks,
    agrees,
    ball_of,
    ball_to,
    event_name,
    event_position,
    passes,
    place_text,
    rational_on,
    refined,
    same,
)
from exactacq.auditing.places import point_at, point_near
from exactacq.auditing.visibility import Viewpoints, World, visible
from exactacq.errors import AuditError
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import rational
from exactacq.progress import Meter
from exactacq.sensing.event import SENSED, Event, EventKind
from exactacq.strategies.run import Run

MOMENTS = 6
"""Moments at which the map is checked, besides the end: half of them events, half between events."""
ASIDE = fmpq(1, 10**11)
"""How far beside the ends of known parts targets are taken: an end that is farther off is found."""


class _Instant(NamedTuple):
    """A name for messages, whole pieces so far, the place if it is inside the next one, and the map there."""

    name: str
    after: int
    inside: Point | None
    chart: Any


class _PartEnd(NamedTuple):
    """An end of a known part: of which obstacle, on which edge, and where."""

    obstacle: int
    edge: int
    point: Point


class Knowledge:
    """The maps of a run, checked in themselves and against what the path sees."""

    def __init__(
        self,
        run: Run,
        world: World,
        bodies: Sequence[AuditedBody],
        tracks: Tracks,
        rng: Random,
        meter: Meter,
    ) -> None:
        self.run, self.world, self.tracks, self.rng, self.meter = run, world, tracks, rng, meter
        self.bodies = bodies
        self._sizes: dict[tuple[int, int], arb] = {}
        self.on = [None if track is None else track.edge for track in tracks]
        self.lookout = Viewpoints(world, run.radius, [piece.curve for piece in run.path], self.on)
        self.events = {
            (event.kind, event.obstacle): event
            for event in run.events
            if event.kind in (EventKind.SIGHT, EventKind.ACQUIRE) and event.obstacle is not None
        }
        self.moments = [*self._at_events(), *self._between_events()]
        self.moments.append(_Instant("the final map", len(run.path), None, run.map))

    def _at_events(self) -> Iterator[_Instant]:
        events = self.run.events
        chosen = sorted(self.rng.sample(range(len(events)), min(MOMENTS // 2, len(events))))
        for event in (events[k] for k in chosen):
            name = f"the map at {event_name(self.run, event)}"
            yield _Instant(name, event.after, _inside(event), self.run.map_at(event))

    def _between_events(self) -> Iterator[_Instant]:
        """Maps from inside pieces, where rational places are at hand."""
        for _ in range(MOMENTS // 2):
            k, place = self._anywhere() or (0, None)
            if place is not None and place not in (self.run.path[k].start, self.run.path[k].end):
                name = f"the map at {place_text(place)} on piece {k}"
                moment = Event(EventKind.MOMENT, place, None, k, self.run.path, inside=True)
                yield _Instant(name, k, place, self.run.map_at(moment))

    # -- maps in themselves ------------------------------------------------------------------------

    def check_maps(self) -> None:
        """Each map's parts are in order, and its lists and lengths are what they add up to."""
        for name, _, _, chart in self.moments:
            states = [self._check_parts(name, chart, body) for body in self.bodies]
            for kind, claimed in (("acquired", chart.acquired), ("incomplete", chart.incomplete)):
                expected = [i for i, state in enumerate(states) if state == kind]
                if list(claimed) != expected:
                    raise AuditError(
                        f"{name}: {kind} obstacles are {list(claimed)}, the parts say {expected}"
                    )
            if sorted(chart.seen) != sorted((*chart.acquired, *chart.incomplete)):
                raise AuditError(f"{name}: seen obstacles are {list(chart.seen)}")
            for body, state in zip(self.bodies, states, strict=True):
                if state != "acquired":
                    self._check_frontier(name, chart, body)
            self.meter.add()

    def check_news(self) -> None:
        """Maps know what events tell: nothing of an obstacle before its sight, all from its acquire on.

        Asked in the maps at hand, of each event at the end of the piece before, and of some just before them.
        """
        for name, after, inside, chart in self.moments:
            for kind, claimed in ((EventKind.SIGHT, chart.seen), (EventKind.ACQUIRE, chart.acquired)):
                told = sorted(
                    i for (k, i), e in self.events.items() if k is kind and self._is_by(e, after, inside)
                )
                if sorted(claimed) != told:
                    raise AuditError(
                        f"{name}: events of {kind} tell of obstacles {told}, not {list(claimed)}"
                    )
        near = self.rng.sample(list(self.events), min(MOMENTS // 2, len(self.events)))
        for (kind, i), event in self.events.items():
            after = event.after if event.inside else event.after - 1
            if after < 0:
                continue
            place = self._beside_on(after, event.point, -ASIDE) if (kind, i) in near else None
            if place is not None and self._is_by(event, after, place):
                place = None
            at = self.run.path[after].start if place is None else place
            moment = Event(EventKind.MOMENT, at, None, after, self.run.path, inside=place is not None)
            name = f"the map before {event_name(self.run, event)}"
            state = self._check_parts(name, self.run.map_at(moment), self.bodies[i])
            if state == "acquired" or (state == "incomplete" and kind is EventKind.SIGHT):
                raise AuditError(f"{event_name(self.run, event)} is late: at {place_text(at)} it is {state}")

    def _check_parts(self, name: str, chart: Any, body: AuditedBody) -> str:
        """Parts of one obstacle are on their edges, in order and apart; returns what they make of it."""
        total, before = arb(0), (-1, arb(0))
        i, parts = body.number, chart.known(body.number)
        whole = 0
        for part in parts:
            edge, flaw = body.curves[part.edge], None
            low, high = arb(0), self._size(body, part.edge)
            if is_whole(edge, part):
                whole += 1
            elif passes(edge, part.start) and passes(edge, part.end):
                low, high = span(edge, part)
            else:
                flaw = f"is not on edge {part.edge}"
            if high < low:
                flaw = f"runs against edge {part.edge}"
            elif part.edge < before[0] or (part.edge == before[0] and not before[1] < low):
                flaw = flaw or "is not beyond the one before"
            if flaw is not None:
                where = f"from {place_text(part.start)} to {place_text(part.end)}"
                raise AuditError(f"{name}: the part of obstacle {i} {where} {flaw}")
            with workprec(BITS):
                before, total = (part.edge, high), total + high - low
        if not agrees(chart.known_length(i), total):
            raise AuditError(f"{name}: the known length of obstacle {i} is not that of its parts")
        if whole == len(parts) == len(body.curves):
            return "acquired"
        return "incomplete" if parts else "unseen"

    def _check_frontier(self, name: str, chart: Any, body: AuditedBody) -> None:
        """Parts of one obstacle end at the frontier, if not at vertices, and it holds nothing but ends."""
        i, ends = body.number, list[Point]()
        frontier = [point for k, point in chart.frontier if k == i]
        for part in chart.known(i):
            edge, own = body.curves[part.edge], (part.start, part.end)
            ends += own
            for end in own:
                is_vertex = same(end, edge.start) or same(end, edge.end)
                if not is_vertex and not any(same(end, point) for point in frontier):
                    raise AuditError(f"{name}: {place_text(end)} of obstacle {i} is missing in the frontier")
        for point in frontier:
            if not any(same(end, point) for end in ends):
                raise AuditError(
                    f"{name}: {place_text(point)} of obstacle {i} is in the frontier, but no end"
                )

    def _is_by(self, event: Event, after: int, inside: Point | None) -> bool:
        """Whether an event is not beyond so many pieces, and a place inside the next one."""
        whole, way = event_position(self.run, event)
        if whole != after:
            return whole < after
        if inside is None:
            return not way > 0
        curve = self.run.path[after].curve
        return not way > refined(lambda bits: ball_to(curve, inside, bits))

    def _beside_on(self, k: int, point: Point, shift: fmpq) -> Point | None:
        """A rational place of piece k about *shift* beyond a point of it, None if none is at hand.

        Where *shift* is lost in floats it may be on the other side, but is not the point itself, nor an end.
        """
        curve, track = self.run.path[k].curve, self.tracks[k]
        if track is not None:
            place = point_near(self.world.edges[track.edge], point, shift if track.forward else -shift)
            place = place if place is not None and curve.contains(place) else None
        else:
            assert isinstance(curve, Segment)
            along = (point - curve.start).dot(curve.direction) / curve.direction.norm_sq()
            share = rational(float(along)) + shift / rational(float(curve.length))
            place = rational_on(curve, share) if 0 < share < 1 else None
        return None if place in (point, curve.start, curve.end) else place

    def _size(self, body: AuditedBody, k: int) -> arb:
        """The length of an edge, which many maps know."""
        if (body.number, k) not in self._sizes:
            self._sizes[body.number, k] = refined(lambda bits: ball_of(body.curves[k], bits))
        return self._sizes[body.number, k]

    # -- maps against the path ---------------------------------------------------------------------

    def check_targets(self, samples: int) -> None:
        """Boundary points are known when, and only when, some place of the path has seen them.

        The points are sampled ones, and those beside all ends of what is known in the end.
        """
        for i, target in chain(self._targets(samples), self._beside(self._ends(self.moments[-1].chart))):
            first = self.lookout.first(target)
            where = f"the point {place_text(target)} of obstacle {i}"
            spots = self.run.map.spots(i, target)
            for name, after, inside, chart in self.moments:
                seen = self._is_seen(target, first, after, inside)
                known = chart.knows_some(spots)
                if known and not seen:
                    raise AuditError(f"{name} knows {where}, which no place of the path so far sees")
                if seen and not known:
                    raise AuditError(f"{name} lacks {where}, which the path sees from piece {first}")
            self._check_sight(i, target, first, where)
            self.meter.add()

    def _check_sight(self, i: int, target: Point, first: int | None, where: str) -> None:
        """A point is not seen before its obstacle's sight, and not after it is acquired."""
        sight, acquire = (self.events.get((kind, i)) for kind in (EventKind.SIGHT, EventKind.ACQUIRE))
        if sight is not None and first is not None:
            last = sight.after if sight.inside else sight.after - 1
            early = self._before(last, sight.point)
            if first < last or (early is not None and self._is_seen(target, first, last, early)):
                raise AuditError(f"{event_name(self.run, sight)} is late: piece {first} sees {where} before")
        if acquire is not None and not self._is_seen(target, first, acquire.after, _inside(acquire)):
            raise AuditError(f"{event_name(self.run, acquire)} is early: {where} was not seen so far")

    def _before(self, k: int, point: Point) -> Point | None:
        """A place on piece k shortly before a point of it, or None if that is not on the piece."""
        if k < 0:
            return None
        curve = self.run.path[k].curve
        if isinstance(curve, Segment):
            return curve.part(curve.start, point).point(1 - ASIDE)
        place = self._beside_on(k, point, -ASIDE)
        # Shortly before a point close to the start of a full circle is its end.
        return place if place is not None and curve.part(curve.start, point).contains(place) else None

    def _is_seen(self, target: Point, first: int | None, after: int, inside: Point | None) -> bool:
        """Whether the path sees a target in its first pieces, or on the next one up to a place inside it.

        *first* is the first piece that sees it.
        """
        if first is not None and first < after:
            return True
        if inside is None:
            return after == 0 and visible(self.world, self.run.radius, target, self.run.start)
        if first != after:
            return False
        curve = self.run.path[after].curve
        part = curve.part(curve.start, inside)
        return Viewpoints(self.world, self.run.radius, [part], [self.on[after]]).first(target) is not None

    def _targets(self, samples: int) -> Iterator[tuple[int, Point]]:
        """Obstacles with rational points of their boundaries: anywhere, and beside ends of known parts."""
        for _ in range(samples if self.bodies else 0):
            body = self.rng.choice(self.bodies)
            k = self.rng.randrange(len(body.curves))
            edge, share = self.world.edges[body.edges[k]], fmpq(self.rng.randrange(1 << 10), 1 << 10)
            place = point_on(edge, body.curves[k], share)
            if place is not None:
                yield body.number, place
        ends = [end for moment in self.moments[:-1] for end in self._ends(moment.chart)]
        yield from self._beside(self.rng.sample(ends, min(samples // 2, len(ends))))

    def _ends(self, chart: Any) -> list[_PartEnd]:
        """The ends of the known parts of incomplete obstacles."""
        return [
            _PartEnd(i, part.edge, end)
            for i in chart.incomplete
            for part in chart.known(i)
            for end in (part.start, part.end)
        ]

    def _beside(self, ends: Iterable[_PartEnd]) -> Iterator[tuple[int, Point]]:
        """Rational points close to ends on both sides, if on the edge, and the ends that are rational."""
        for i, k, end in ends:
            edge, curve = self.world.edges[self.bodies[i].edges[k]], self.bodies[i].curves[k]
            beside = [point_near(edge, end, shift) for shift in (-ASIDE, ASIDE)]
            for place in (*beside, end if end.rational else None):
                if place is not None and curve.contains(place):
                    yield i, place

    def check_in_sight(self, samples: int) -> None:
        """At sampled places, some beside events, obstacles are in sight if and only if the events say so."""
        lookout = Viewpoints(
            self.world,
            self.run.radius,
            [curve for body in self.bodies for curve in body.curves],
            [e for body in self.bodies for e in body.edges],
        )
        firsts = [0, *accumulate(len(body.curves) for body in self.bodies)]
        sensed = [event for event in self.run.events if event.kind in SENSED]
        beside = self.rng.sample(sensed, min(samples // 4, len(sensed)))
        places: list[tuple[tuple[int, Point] | None, int | None]] = []
        for event in beside:
            places += self._around(event)
        places += [(self._anywhere(), None) for _ in range(samples - len(places))]
        for place, wanted in places:
            self.meter.add()
            if place is None:
                continue
            k, point = place
            states = self._states(k, point)
            some = self.rng.sample(sorted(states), min(3, len(states)))
            some += [wanted] if wanted in states and wanted not in some else []
            seeing = lookout.any_sees(point, [range(*firsts[i : i + 2]) for i in some])
            for i, sees in zip(some, seeing, strict=True):
                if sees != states[i]:
                    claim = "in sight" if states[i] else "out of sight"
                    raise AuditError(
                        f"obstacle {i} is not {claim} from {place_text(point)} on piece {k}, as events say"
                    )

    def _around(self, event: Event) -> Iterator[tuple[tuple[int, Point], int | None]]:
        """Pieces and rational places on them shortly before and after an event, and its obstacle."""
        for k, shift in ((event.after if event.inside else event.after - 1, -ASIDE), (event.after, ASIDE)):
            place = self._beside_on(k, event.point, shift) if 0 <= k < len(self.run.path) else None
            if place is not None:
                yield (k, place), event.obstacle

    def _anywhere(self) -> tuple[int, Point] | None:
        """A random piece and a rational point on it, None if there is none at hand."""
        if not self.run.path:
            return None
        k = self.rng.randrange(len(self.run.path))
        curve, track = self.run.path[k].curve, self.tracks[k]
        share = fmpq(self.rng.randrange(1, 1 << 10), 1 << 10)
        if isinstance(curve, Segment):
            point = rational_on(curve, share)
            return None if point is None else (k, point)
        assert track is not None
        place = point_at(self.world.edges[track.edge], share)
        return None if place is None or not curve.contains(place) else (k, place)

    def _states(self, k: int, point: Point) -> dict[int, bool]:
        """Whether each obstacle, but for acquired ones, is in sight at a place; empty at an event's place."""
        curve = self.run.path[k].curve
        here = refined(lambda bits: ball_to(curve, point, bits))
        states: dict[int, bool | None] = dict.fromkeys(range(len(self.bodies)), False)
        for event in self.run.events:
            if event.kind not in SENSED or event.after > k:
                continue
            assert event.obstacle is not None
            if event.after == k and event.inside:
                there = event_position(self.run, event)[1]
                if there > here:
                    continue
                if not there < here:
                    return {}
            if states[event.obstacle] is not None:
                in_sight = event.kind in (EventKind.SIGHT, EventKind.REGAIN)
                states[event.obstacle] = None if event.kind is EventKind.ACQUIRE else in_sight
        return {i: state for i, state in states.items() if state is not None}


def _inside(event: Event) -> Point | None:
    return event.point if event.inside else None


def point_on(edge: Curve, part: Curve, share: fmpq) -> Point | None:
    """A rational point at about a share of a part of an edge of the scene, None if there is none at hand."""
    if part is edge:
        return point_at(edge, share)
    place = point_near(edge, part.start, rational(float(ball_of(part, BITS))) * share)
    return place if place is not None and part.contains(place) else None


def is_whole(edge: Curve, part: Any) -> bool:
    ends = same(part.start, edge.start) and same(part.end, edge.end)
    return ends and (part.whole or not (isinstance(edge, Arc) and edge.full))


def span(edge: Curve, part: Any) -> tuple[arb, arb]:
    """Where a part of an edge begins and ends, as lengths along the edge.

    On a full circle, whose ends are one point, a single first point ends where it begins.
    """
    single = same(part.start, part.end) and not is_whole(edge, part)
    low = refined(lambda bits: ball_to(edge, part.start, bits))
    if single:
        return low, low
    if same(part.end, edge.end):
        return low, refined(lambda bits: ball_of(edge, bits))
    return low, refined(lambda bits: ball_to(edge, part.end, bits))
