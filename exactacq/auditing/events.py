"""The audit of events: they lie on the path in its order, and what is seen of an obstacle makes sense."""

from __future__ import annotations

from collections.abc import Collection
from itertools import pairwise
from random import Random

from exactacq.auditing.comparisons import (
    BITS,
    agrees,
    ball_sum,
    event_name,
    event_position,
    passes,
    place_text,
    same,
)
from exactacq.auditing.knowledge import MOMENTS
from exactacq.errors import AuditError
from exactacq.geometry.points import Point
from exactacq.numbers.precision import workprec
from exactacq.sensing.event import SENSED, Event, EventKind, Reason
from exactacq.strategies.run import Run

FOLLOWS: dict[EventKind, tuple[EventKind | None, ...]] = {
    EventKind.SIGHT: (None,),
    EventKind.LOSE: (EventKind.SIGHT, EventKind.REGAIN),
    EventKind.REGAIN: (EventKind.LOSE,),
    EventKind.ACQUIRE: (EventKind.SIGHT, EventKind.REGAIN, EventKind.LOSE),
}
"""What the robot sees of an obstacle, and what of it can come just before."""
DETAILS: dict[EventKind, tuple[str, ...]] = {
    EventKind.HIT: ("occasion", "other"),
    EventKind.CROSS: ("occasion",),
    EventKind.LEAVE: ("occasion", "other"),
    EventKind.BACKTRACK: ("occasion", "other"),
    EventKind.DIVERT: ("reason",),
    EventKind.RETURN: ("reason",),
    EventKind.LOSE: ("reason",),
    EventKind.STOP: ("ending",),
}
"""Which of its words an event may have; those that it has are checked where its kind is."""


def _place(run: Run, after: int) -> Point:
    """Where the robot is after so many pieces."""
    return run.path[after - 1].end if after else run.start


def check_events(run: Run, rng: Random, moves: Collection[EventKind]) -> None:
    """Events lie on the path where they say, in its order, from the start to the stop."""
    kinds = [event.kind for event in run.events]
    ends = EventKind.START, EventKind.STOP
    if (kinds[:1], kinds[-1:]) != ([ends[0]], [ends[1]]) or not set(ends).isdisjoint(kinds[1:-1]):
        raise AuditError("events begin with one start and end with one stop")
    obstacles, places = range(len(run.obstacles)), []
    for event in run.events:
        if event.kind not in moves and event.kind not in SENSED:
            raise AuditError(f"{event_name(run, event)} is of no known kind")
        is_known = event.obstacle in obstacles if event.obstacle is not None else event.kind not in SENSED
        if not is_known:
            raise AuditError(f"{event_name(run, event)} is about none that the run has")
        if not _is_at(run, event):
            raise AuditError(f"{event_name(run, event)} is not on the path: {place_text(event.point)}")
        for word in ("occasion", "other", "reason", "ending"):
            if getattr(event, word) is not None and word not in DETAILS.get(event.kind, ()):
                raise AuditError(f"{event_name(run, event)} has no {word}, but tells one: {event.note!r}")
        places.append(event_position(run, event))
    for (before, (k, s)), (event, (m, t)) in pairwise(zip(run.events, places, strict=True)):
        if m < k or (m == k and t < s):
            raise AuditError(
                f"{event_name(run, event)} comes after {event_name(run, before)}, but lies before it"
            )
    if run.events[-1].after != len(run.path):
        raise AuditError("the stop is not at the end of the path")
    for event in rng.sample(run.events, min(MOMENTS, len(run.events))):
        done = ball_sum([piece.curve for piece in run.path[: event.after]])
        with workprec(BITS):
            here = done + event_position(run, event)[1]
        if not agrees(event.at, here):
            raise AuditError(
                f"{event_name(run, event)} says that it is at {event.at.decimal(20)}... of the path"
            )


def _is_at(run: Run, event: Event) -> bool:
    """Whether an event is where piece number ``after`` begins, or, if it is no move, inside that piece."""
    if not event.inside:
        return 0 <= event.after <= len(run.path) and same(event.point, _place(run, event.after))
    on_piece = event.kind in SENSED and 0 <= event.after < len(run.path)
    return on_piece and passes(run.path[event.after].curve, event.point)


def check_sights(run: Run) -> None:
    """Of each obstacle: sight before all else, lose and regain in turn until it is acquired, once."""
    state: dict[int, EventKind] = {}
    for event in run.events:
        i = event.obstacle
        if i is None or event.kind is EventKind.STOP:
            continue
        before = state.get(i)
        if event.kind in SENSED:
            if before not in FOLLOWS[event.kind]:
                raise AuditError(f"{event_name(run, event)} cannot follow {before or 'nothing'}")
            if event.kind is EventKind.LOSE and event.reason not in (Reason.OCCLUSION, Reason.RANGE):
                raise AuditError(f"{event_name(run, event)} is due to {event.note!r}")
            state[i] = event.kind
        elif before is None:
            raise AuditError(f"{event_name(run, event)} comes before obstacle {i} was seen")
