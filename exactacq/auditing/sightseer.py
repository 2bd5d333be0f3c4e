"""The audit of the Sightseer's moves: its tree, its links, its loops and its stack, along the path."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

from exactacq.auditing.comparisons import (
    Tracks,
    agrees,
    ball_sum,
    event_name,
    is_shorter_way,
    place_text,
    same,
)
from exactacq.errors import AuditError
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.event import Ending, Event, EventKind, Occasion
from exactacq.strategies.run import Run, SightseerRun, TreeLink

MOVES = {
    EventKind.START: {EventKind.HIT, EventKind.STOP},
    EventKind.HIT: {EventKind.LEAVE, EventKind.STOP},
    EventKind.LEAVE: {EventKind.HIT, EventKind.BACKTRACK},
    EventKind.BACKTRACK: {EventKind.LEAVE, EventKind.STOP},
    EventKind.STOP: set[EventKind](),
}
"""What the robot does, and what it can do next; back at S it begins anew."""


def check_moves(run: SightseerRun, tracks: Tracks) -> None:
    """Replay what the robot did: hits, loops, leaves and returns along the tree, as a stack."""
    links = {link.target: link for link in run.links}
    stack: list[int | str] = ["S"]
    visits: list[int] = []
    crossings: Counter[int] = Counter()
    depth, done = 0, 0
    for before, event in pairwise(event for event in run.events if event.kind in MOVES):
        if event.kind not in MOVES[EventKind.START if stack == ["S"] else before.kind]:
            raise AuditError(f"{event_name(run, event)} cannot follow {event_name(run, before)}")
        _check_between(run, before, event)
        if event.kind is EventKind.HIT:
            link = links.get(event.obstacle if event.obstacle is not None else -1)
            if link is None or link.target in visits or link.source != stack[-1]:
                raise AuditError(f"{event_name(run, event)} has no link from {stack[-1]} or is not the first")
            _check_crossing(run, before, event, (link.leave, link.hit))
            _check_words(run, event, Occasion.ADVANCE, link.source)
            if before.kind is EventKind.LEAVE:
                _check_words(run, before, Occasion.ADVANCE, link.target)
            stack.append(link.target)
            visits.append(link.target)
            crossings[link.target] += 1
            done = _check_loop(run, tracks, event)
        elif event.kind is EventKind.BACKTRACK:
            link = links[int(stack.pop())]
            _check_crossing(run, before, event, (link.hit, link.leave))
            _check_words(run, event, Occasion.BACKTRACK, link.target)
            _check_words(run, before, Occasion.BACKTRACK, link.source)
            crossings[link.target] += 1
            done = event.after
        if (event.obstacle if event.obstacle is not None else "S") != stack[-1]:
            raise AuditError(f"{event_name(run, event)} happens at {stack[-1]}")
        if event.kind in (EventKind.LEAVE, EventKind.STOP):
            _check_walk(run, tracks, event, done)
        depth = max(depth, len(stack) - 1)
    if list(run.visits) != visits:
        raise AuditError(f"visits are {list(run.visits)}, but the hits were {visits}")
    if [link.target for link in run.links] != visits:
        raise AuditError(f"links lead to {[link.target for link in run.links]}, but the visits were {visits}")
    for link in run.links:
        if link.traversals != crossings[link.target]:
            times = crossings[link.target]
            raise AuditError(f"{link_name(link)} was walked {times} times, not {link.traversals}")
    if run.stack_depth != depth:
        raise AuditError(f"the stack was {depth} deep, not {run.stack_depth}")


def _check_words(run: Run, event: Event, occasion: Occasion, other: int | str) -> None:
    """A move at one end of a link says on what occasion it is made, and where the other end is."""
    if (event.occasion, event.other) != (occasion, other):
        raise AuditError(f"{event_name(run, event)} is {occasion} by a link with {other}, not {event.note!r}")


def _check_between(run: Run, before: Event, event: Event) -> None:
    """Between two moves the robot keeps to the boundary that it is at, or goes straight between two."""
    at = None if before.kind in (EventKind.START, EventKind.LEAVE) else before.obstacle
    for k in range(before.after, event.after):
        if run.path[k].obstacle != at:
            raise AuditError(
                f"piece {k} between {event_name(run, before)} and {event_name(run, event)} is not at {at}"
            )


def _check_crossing(run: Run, before: Event, event: Event, ends: tuple[Point, Point]) -> None:
    """The robot crosses by the link, in one straight piece, or in none if the link is a point."""
    count = 0 if same(*ends) else 1
    if event.after - before.after != count:
        pieces = event.after - before.after
        raise AuditError(f"{event_name(run, event)} comes {pieces} pieces after the boundary was left")
    for point, end in zip((before.point, event.point), ends, strict=True):
        if not same(point, end):
            raise AuditError(
                f"{event_name(run, event)}: its link has an end at {place_text(end)}, not {place_text(point)}"
            )


def _check_walk(run: Run, tracks: Tracks, event: Event, done: int) -> None:
    """From the end of its loop, or where it came back, the robot walks the shorter way, or it stops."""
    walk = [piece.curve for piece in run.path[done : event.after]]
    senses = {track.forward for track in tracks[done : event.after] if track is not None}
    if walk and event.kind is EventKind.STOP:
        raise AuditError(f"{event_name(run, event)} comes {len(walk)} pieces after the robot was done")
    if event.obstacle is not None and walk:
        whole = ball_sum(run.scene.obstacles[event.obstacle].edges)
        if len(senses) > 1 or not is_shorter_way(walk, whole, senses):
            raise AuditError(f"{event_name(run, event)} is not reached the shorter way")


def _check_loop(run: Run, tracks: Tracks, hit: Event) -> int:
    """After its hit the whole boundary is walked in one go: in one sense, and as long as it is.

    Returns after how many pieces that is done.
    """
    assert hit.obstacle is not None
    perimeter = run.scene.obstacles[hit.obstacle].perimeter
    walked: list[Length] = []
    senses = set()
    for k in range(hit.after, len(run.path)):
        piece, track = run.path[k], tracks[k]
        if track is None or piece.obstacle != hit.obstacle:
            break
        walked.append(piece.length)
        senses.add(track.forward)
        if len(senses) == 1 and same(piece.end, hit.point) and Length.sum(walked) == perimeter:
            return k + 1
    raise AuditError(f"obstacle {hit.obstacle} was not walked all around after {event_name(run, hit)}")


def link_name(link: TreeLink) -> str:
    return f"the link from {link.source} to {link.target}"


def check_links(run: SightseerRun) -> None:
    """Links are as long as their segments, within the radius, and add up to the straight pieces."""
    total = Length(0)
    for link in run.links:
        if not agrees(link.length, ball_sum([Segment(link.leave, link.hit)])):
            raise AuditError(f"{link_name(link)} is not {link.length.decimal(20)}... long")
        if link.length > run.radius:
            raise AuditError(f"{link_name(link)} is longer than the radius")
        total = total + link.length * link.traversals
    straight = ball_sum([piece.curve for piece in run.path if piece.kind == "straight"])
    if not agrees(total, straight):
        raise AuditError(f"the links walked add up to {total.decimal(20)}..., the straight pieces do not")


def check_ending(run: SightseerRun, left: set[int]) -> None:
    """Why a run of the Sightseer ended agrees with what it visited; *left* are seen, but unvisited."""
    stop, is_all = run.events[-1], len(run.visits) == len(run.obstacles)
    is_due = {
        Ending.ALL_VISITED: is_all,
        Ending.NOTHING_UNVISITED: not is_all and not left,
        Ending.BACK_AT_START: not is_all and stop.obstacle is None,
    }
    if stop.ending is None or not is_due.get(stop.ending, False):
        raise AuditError(f"{event_name(run, stop)} is due to {stop.note!r}, which is not so")
