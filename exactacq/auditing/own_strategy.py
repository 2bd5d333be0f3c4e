"""The audit of a run by a strategy of the user's own.

Where such a robot goes is its own affair; that it was where its events say, and walked around what it says
that it has visited, is checked, and that its bounds hold or not as is told. Their values are the strategy's.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from flint import arb

from exactacq.auditing.comparisons import BITS, AuditedBody, Tracks, event_name, passes, same
from exactacq.errors import AuditError
from exactacq.numbers.precision import workprec
from exactacq.sensing.event import Ending, Event, EventKind, Occasion
from exactacq.strategies.run import OwnRun

MOVES = (
    EventKind.START,
    EventKind.HIT,
    EventKind.LEAVE,
    EventKind.BACKTRACK,
    EventKind.DECIDE,
    EventKind.STOP,
)
"""What such a robot does."""
SLACK = 1e-9
"""Floats of lengths that differ by no more than this part may be equal."""


def check_own_moves(run: OwnRun, bodies: Sequence[AuditedBody], tracks: Tracks) -> None:
    """Replay where the robot was: at a boundary from a hit to the next leave, else in free space."""
    at: int | None = None
    moves = [event for event in run.events if event.kind in MOVES]
    for before, event in pairwise(moves):
        for k in range(before.after, event.after):
            if run.path[k].obstacle != at:
                ends = f"{event_name(run, before)} and {event_name(run, event)}"
                raise AuditError(f"piece {k} between {ends} is not at {at}")
        at = _then(run, bodies, event, at)
    if run.ending not in (Ending.FINISHED, Ending.MOST_MOVES):
        raise AuditError(f"the run ended because {run.events[-1].note!r}, which no such strategy does")
    if len(set(run.visits)) < len(run.visits):
        raise AuditError(f"visits are {list(run.visits)}, which names one twice")
    for number in run.visits:
        if number not in range(len(run.obstacles)) or not _is_rounded(run, tracks, number):
            raise AuditError(f"obstacle {number} was visited, but never walked all around")


def _then(run: OwnRun, bodies: Sequence[AuditedBody], event: Event, at: int | None) -> int | None:
    """At which obstacle the robot is after an event, if it was *at* that one before."""
    told = event.obstacle
    is_right = {
        EventKind.HIT: told is not None and at in (None, told),
        EventKind.BACKTRACK: at is None and event.occasion is Occasion.BACKTRACK,
        EventKind.LEAVE: told is not None and at == told,
        EventKind.DECIDE: at == told,
        EventKind.STOP: at == told,
    }
    if not is_right[event.kind]:
        raise AuditError(f"{event_name(run, event)} happens at {at}")
    if told is None:
        if event.kind is EventKind.BACKTRACK and not same(event.point, run.start):
            raise AuditError(f"{event_name(run, event)} is not at the start")
    elif not any(passes(curve, event.point) for curve in bodies[told].curves):
        raise AuditError(f"{event_name(run, event)} is not on the boundary of obstacle {told}")
    return None if event.kind is EventKind.LEAVE else told


def _is_rounded(run: OwnRun, tracks: Tracks, number: int) -> bool:
    """Whether pieces one after the other, in one sense, lead all around an obstacle."""
    perimeter = run.obstacles[number].perimeter
    least, most = (float(perimeter) * (1 + sign * SLACK) for sign in (-1, 1))
    for first, begun in enumerate(tracks):
        walked = 0.0
        for last in range(first, len(tracks)):
            track, piece = tracks[last], run.path[last]
            if track is None or begun is None or piece.obstacle != number:
                break
            if track.forward is not begun.forward:
                break
            walked += float(piece.length)
            if walked > most:
                break
            # A walk in one sense from a place back to it is as long as one lap or more: floats tell that it
            # is one. Its last piece may be shorter than what they tell apart.
            if walked >= least and same(piece.end, run.path[first].start):
                return True
    return False


def declared_values(run: OwnRun) -> dict[str, arb]:
    """The values of the bounds, as the strategy tells them."""
    with workprec(BITS):
        ends = {bound.name: bound.value.enclosure(BITS) for bound in run.bounds}
        return {name: arb(low).union(arb(high)) for name, (low, high) in ends.items()}
