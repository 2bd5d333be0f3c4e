"""Sweeps with planted flaws: good runs, and how to change their path, events and accounts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from functools import cache
from itertools import pairwise

from sweeps import rectangle

import exactacq as xa
from exactacq import Scene, Terrain
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.sensing.event import Event
from exactacq.sensing.path import Path, Piece
from exactacq.strategies.run import Run


@cache
def block() -> Run:
    """A square in the way of the second line, hit at (3, 4) and left at (3, 2).

    Pieces: 0, 1 to (3, 8); 2 down to (3, 4); 3 to 7 around by (2, 4), (2, 2), (4, 2), (4, 4); 8 to 10 by
    (2, 4) and (2, 2) to (3, 2); then down and on.
    """
    return xa.seed_spreader(Scene([rectangle(2, 2, 4, 4)], terrain=Terrain(6, 8)), 3)


@cache
def shelf() -> Run:
    """An obstacle at the western border, hit at (0, 4) and left at (0, 6): its shore has two ends."""
    return xa.seed_spreader(Scene([rectangle(0, 4, 1, 6)], terrain=Terrain(6, 8)), 3)


@cache
def hanging() -> Run:
    """An obstacle that hangs from the northern border between two lines, on the first joint."""
    return xa.seed_spreader(Scene([rectangle(1, 6, 2, 8)], terrain=Terrain(6, 8)), 3)


@cache
def hasty() -> Run:
    """M25 without lookahead: from D = (20, 52) along the top of E to Q = (9, 52) of W, around, and back."""
    return xa.seed_spreader(xa.load("m25"), lookahead=False)


@cache
def around() -> Run:
    """M15: a diversion to W that passes E, which is known by then, on its way out and back."""
    return xa.seed_spreader(xa.load("m15"))


@cache
def ladder() -> Run:
    """M20(3): one bar hit on the second line and met again on the next two."""
    return xa.seed_spreader(xa.load("m20-3"))


MOVES = ("start", "hit", "cross", "leave", "backtrack", "divert", "return", "stop")


def moves(run: Run) -> list[Event]:
    return [event for event in run.events if event.kind in MOVES]


def resewn(run: Run, first: int, last: int, *pieces: Piece) -> Run:
    """The run with pieces first to last of its path, the latter excluded, replaced: with the moves alone.

    What follows is moved along; moves within the old pieces are dropped.
    """
    path = Path((*run.path[:first], *pieces, *run.path[last:]))
    shift = len(path) - len(run.path)
    kept = [event for event in moves(run) if event.after <= first or event.after >= last]
    events = tuple(
        replace(event, path=path, after=event.after + (shift if event.after >= last else 0)) for event in kept
    )
    fresh = {field.name: getattr(run, field.name) for field in fields(run)}
    fresh |= {"path": path, "events": events, "record": None}
    return with_sights(type(run)(**fresh))


def with_sights(run: Run) -> Run:
    """The run with the events of sight that its path makes, ahead of the moves at the same place."""
    places = [
        (Event(r.kind, r.place, r.obstacle, r.after, run.path, r.inside, reason=r.reason), n)
        for n, r in enumerate(run.memory.reports)
    ]
    lengths = {id(event): (event.after, float(event.beyond)) for event, _ in places}
    events = [event for event, _ in places]
    for move in moves(run):
        at = sum(lengths[id(event)] <= (move.after, 0.0) for event, _ in places)
        before = 0 if move.kind == "start" else at
        spot = events.index(places[before][0]) if before < len(places) else len(events)
        events.insert(spot, move)
    return replace(run, events=tuple(events))


def boundary(obstacle: int, *corners: Sequence[object]) -> list[Piece]:
    return [Piece("boundary", obstacle, curve) for curve in chain(*corners)]


def straight(*corners: Sequence[object]) -> list[Piece]:
    return [Piece("straight", None, curve) for curve in chain(*corners)]


def chain(*corners: Sequence[object]) -> list[Curve]:
    points = [Point(*corner) for corner in corners]
    return [Segment(a, b) for a, b in pairwise(points)]


def with_event(run: Run, which: str, /, **changes: object) -> Run:
    """The run with its first event of a kind changed."""
    k = next(k for k, event in enumerate(run.events) if event.kind == which)
    return replace(run, events=(*run.events[:k], replace(run.events[k], **changes), *run.events[k + 1 :]))


def without(run: Run, kind: str) -> Run:
    k = next(k for k, event in enumerate(run.events) if event.kind == kind)
    return replace(run, events=run.events[:k] + run.events[k + 1 :])


def told(run: Run, **changes: object) -> Run:
    """The run with other words about its sweep."""
    return replace(run, **changes)


def diverted(run: Run, **changes: object) -> Run:
    """The run with another account of its diversion."""
    (diversion,) = run.diversions
    return told(run, diversions=(replace(diversion, **changes),))
