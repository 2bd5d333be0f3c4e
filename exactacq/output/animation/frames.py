"""The places of a run that a page shows exactly: where something happens, and many on the way between.

There the map and the view are those of the moment, exact as everywhere else; the page moves the robot from
one to the next. They are so close that the view seems to move with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import groupby

from exactacq.errors import Undecided
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.progress import Meter, Progress
from exactacq.sensing.event import Event, EventKind
from exactacq.strategies.run import Run

LIMIT = 2000
"""Most stops of a page: a few megabytes, and a list of events that a browser scrolls without effort."""
FINE = 480
"""Most places on the way between stops."""
HEAVY = 100_000
"""So many edges of all maps between stops are looked at: in larger scenes there are fewer of these places."""
PIECES = 40_000
"""So many pieces of all views between stops are on a page, about half a megabyte."""
PROBES = 12
"""Views that tell how many pieces a view has."""
CLOSE = 0.4
"""Places between stops keep this share of their distance from stops."""
SHORT = 6
"""Digits of the lengths after which these places lie."""
PASSING = {EventKind.LOSE, EventKind.REGAIN}
"""Kinds of events that are the first to be left out."""


@dataclass(frozen=True, slots=True)
class Frame:
    """What the robot knows and sees at one place of its path, and the events that happen there.

    ``known`` holds the known stretches of an obstacle's boundary by its index (a single known point is a
    segment of length 0), ``frontier`` the ends of known stretches beyond which a boundary is unknown,
    ``view`` the closed outline of the isovist, or nothing where it is undecided, and ``acquired`` the
    obstacles whose whole boundary is known.
    Stretches that are the same object as in the frame before cost nothing.
    """

    at: Length
    place: Point
    events: Sequence[Event]
    known: Mapping[int, Sequence[Curve]]
    frontier: Sequence[Point]
    view: Sequence[Curve]
    acquired: Sequence[int] = ()
    after: int = 0
    """Whole pieces of the path behind the robot."""
    is_passing: bool = False
    """Whether nothing happens there: a place between two stops."""


@dataclass(slots=True)
class Stop:
    """A place where something changes: an end of a path piece, or where events happen.

    ``after`` whole pieces lie behind. Between such places others are of kind "moment", with *passing*.
    """

    after: int
    place: Point
    events: list[Event]
    passing: Event | None = None

    @property
    def rank(self) -> int:
        """The less the more important: 2 without events, 1 if things only go out of sight or come back."""
        kinds = {event.kind for event in self.events}
        return 0 if kinds - PASSING else 1 if kinds else 2


def stops(run: Run) -> list[Stop]:
    """The distinct places along the path, in order; events at the same place share a stop."""
    found: list[Stop] = []
    grouped = {after: list(events) for after, events in groupby(run.events, key=lambda event: event.after)}
    for after, end in enumerate([run.start, *(piece.end for piece in run.path)]):
        found.append(Stop(after, end, []))
        for event in grouped.get(after, ()):
            if event.point != found[-1].place:
                found.append(Stop(after, event.point, []))
            found[-1].events.append(event)
    return found


def chosen(found: Sequence[Stop], limit: int) -> list[Stop]:
    """At most *limit* stops: the important ones, and of those that do not all fit an even choice.

    Both ends are kept. ValueError for a limit below 2.
    """
    if limit < 2:
        raise ValueError(f"an animation has at least 2 frames, not {limit}")
    last = len(found) - 1
    ranks = [0 if k in (0, last) else stop.rank for k, stop in enumerate(found)]
    kept: list[int] = []
    for rank in sorted(set(ranks)):
        group, room = [k for k, own in enumerate(ranks) if own == rank], limit - len(kept)
        if len(group) > room:
            group = [group[k * (len(group) - 1) // max(room - 1, 1)] for k in range(room)]
        kept += group
    return [found[k] for k in sorted(kept)]


def frames_of(
    run: Run, limit: int = LIMIT, *, fine: int = FINE, progress: Progress | None = None
) -> Iterator[Frame]:
    """A frame for each stop of a run and for places between them, one at a time, along the path.

    At most *limit* (2 or more) stops, see `chosen`, and at most *fine* places between them at equal
    distances; fewer in scenes that are heavy or have views of many pieces, and none next to a stop. Those
    that are beyond the library's limits are left out, and views from stops that are. *progress* is told how
    many of how many frames are done. Cost: one map and one view a frame.
    """
    kept = with_ways(run, chosen(stops(run), limit), fine)
    meter = Meter(progress, len(kept))
    lengths = iter([piece.length for piece in run.path])
    walked, after = Length(0), 0
    for stop in kept:
        while after < stop.after:
            walked, after = walked + next(lengths), after + 1
        event = stop.passing or (stop.events[-1] if stop.events else None)
        try:
            yield _frame(run, stop, walked, event)
        except Undecided:
            if stop.passing is None:
                raise
        meter.add()


def _frame(run: Run, stop: Stop, walked: Length, event: Event | None) -> Frame:
    moment = walked if event is None else event
    learnt, is_passing = run.map_at(moment), stop.passing is not None
    known: dict[int, Sequence[Curve]] = {i: run.obstacles[i].edges for i in learnt.acquired}
    for i in learnt.incomplete:
        known[i] = [part.curve or Segment(part.start, part.end) for part in learnt.known(i)]
    frontier = [point for _, point in learnt.frontier]
    try:
        outline = [piece.curve for piece in run.view_at(moment).pieces]
    except Undecided:
        if is_passing:
            raise
        outline = []
    at = walked if event is None else walked + event.beyond
    acquired, after = learnt.acquired, stop.after
    return Frame(at, stop.place, stop.events, known, frontier, outline, acquired, after, is_passing)


def with_ways(run: Run, kept: Sequence[Stop], fine: int) -> list[Stop]:
    """Stops, and places on the way between them, in the order of the path (see `frames_of`)."""
    total, count = float(run.length), _count(run, fine)
    if not total or not count:
        return list(kept)
    ends = [float(end) for end in Length.running_decimals((piece.length for piece in run.path), 17)]
    marks = [ends[stop.after] + (float(stop.events[-1].beyond) if stop.events else 0.0) for stop in kept]
    step, found = total / (count + 1), []
    for stop, here, ahead in zip(kept, marks, [*marks[1:], None], strict=True):
        found.append(stop)
        if ahead is None:
            break
        first, last = int((here + CLOSE * step) / step) + 1, (ahead - CLOSE * step) / step
        for number in range(first, int(last) + 1):
            event = run.near(rational(f"{number * step:.{SHORT}g}"))
            found.append(Stop(event.after, event.point, [], event))
    return found


def _count(run: Run, fine: int) -> int:
    """How many places between stops a page has at most."""
    total = float(run.length)
    edges = sum(len(obstacle.edges) for obstacle in run.scene.obstacles)
    count = min(fine, HEAVY // max(edges, 1))
    if not total or not count:
        return 0
    pieces = 0
    for k in range(1, PROBES + 1):
        with suppress(Undecided):
            pieces += len(run.view_at(run.near(rational(f"{total * k / (PROBES + 1):.{SHORT}g}"))).pieces)
    return min(count, PIECES * PROBES // max(pieces, 1))
