"""The audit: a finished run checked again by other means than the code that made it.

Lengths are re-added in balls, pieces are located among all edges, events are replayed, bounds are computed
again from the paper's formulas, and knowledge is decided from the target's side (`exactacq.auditing.visibility`).
For the Seed Spreader the components, the M-line and what blocks it are found again
(`exactacq.auditing.ground`), and its rules are replayed (`exactacq.auditing.seed_spreader`). Nothing of the
strategies, the robot, the links or the sensing is used.

Places that are not rational are compared with the path and with each other at `DIGITS` digits: there a
deviation beyond them is not found. Everything else is exact, or a ball proves the flaw.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise
from random import Random
from typing import Any

from flint import ctx

from exactacq.auditing.bounds import check_bounds, check_links, link_name, sightseer_values, spreader_values
from exactacq.auditing.ground import Field, check_components
from exactacq.auditing.knowledge import MOMENTS, Knowledge
from exactacq.auditing.measure import (
    BITS,
    DIGITS,
    Body,
    Track,
    Tracks,
    agrees,
    ball_sum,
    event_name,
    event_position,
    is_part,
    passes,
    place_text,
    same,
)
from exactacq.auditing.seed_spreader import MOVES as SWEEP_MOVES
from exactacq.auditing.seed_spreader import Replay
from exactacq.auditing.visibility import World
from exactacq.errors import AuditError
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.event import SENSED, Ending, Event, EventKind, Reason
from exactacq.strategies.run import Run, SeedSpreaderRun, SightseerRun

MOVES = {
    EventKind.START: {EventKind.HIT, EventKind.STOP},
    EventKind.HIT: {EventKind.LEAVE, EventKind.STOP},
    EventKind.LEAVE: {EventKind.HIT, EventKind.BACKTRACK},
    EventKind.BACKTRACK: {EventKind.LEAVE, EventKind.HIT, EventKind.STOP},
    EventKind.STOP: set[EventKind](),
}
"""What the robot does, and what it can do next."""
FOLLOWS: dict[EventKind, tuple[EventKind | None, ...]] = {
    EventKind.SIGHT: (None,),
    EventKind.LOSE: (EventKind.SIGHT, EventKind.REGAIN),
    EventKind.REGAIN: (EventKind.LOSE,),
    EventKind.ACQUIRE: (EventKind.SIGHT, EventKind.REGAIN, EventKind.LOSE),
}
"""What the robot sees of an obstacle, and what of it can come just before."""


def audit(run: Run, *, samples: int = 64, seed: int = 0) -> None:
    """Check a finished run by other means than those that made it; raises `AuditError` with the first flaw.

    Path, events, links, bounds and length are checked completely. What is known, and what a sweep was about
    to lose, is checked on samples: *samples* random boundary points, as many beside ends of known parts, and
    as many places on the path. Equal seeds give equal samples. Returns None if no flaw is found. ValueError
    for runs of another strategy, `Undecided` where an exact comparison is beyond the limits. Cost: about ten
    milliseconds a sample at ten obstacles in range, less than one for each piece and event, and that of
    `MOMENTS` maps; for the Seed Spreader also of one map for each piece on its lines.

    >>> import exactacq as xa
    >>> audit(xa.sightseer(xa.load("circles")), samples=8)
    """
    if not isinstance(run, SightseerRun | SeedSpreaderRun):
        raise ValueError(f"no audit for a {type(run).__name__}")
    rng = Random(seed)
    world, field = World(run.scene), None
    if isinstance(run, SeedSpreaderRun):
        field = Field(run, world)
        check_components(run, field)
    bodies = list(_bodies(run, world))
    _check_continuity(run)
    tracks = _check_pieces(run, world, bodies, field)
    _check_length(run)
    _check_events(run, rng, MOVES if field is None else SWEEP_MOVES)
    if isinstance(run, SightseerRun):
        _check_moves(run, tracks)
        check_links(run)
        values = sightseer_values(run, world)
    else:
        assert field is not None
        Replay(run, field, bodies, tracks, rng).check()
        values = spreader_values(run, field)
    _check_sights(run)
    check_bounds(run, values)
    _check_accounts(run)
    knowledge = Knowledge(run, world, bodies, tracks, rng)
    knowledge.check_maps()
    knowledge.check_targets(samples)
    knowledge.check_in_sight(samples)


def _bodies(run: Run, world: World) -> Iterator[Body]:
    """What the numbers of obstacles in a run mean: obstacles of the scene, or shores of components."""
    for k, obstacle in enumerate(run.obstacles):
        body: Any = obstacle
        owner = k if run.ground is None else body.obstacle.index
        first, parts = world.first[owner], range(len(body.edges))
        edges = parts if run.ground is None else [part.edge for part in body.shore]
        yield Body(k, owner, body.edges, [first + e for e in edges], body.closed)


# -- the path --------------------------------------------------------------------------------------


def _check_continuity(run: Run) -> None:
    here = run.start
    for k, piece in enumerate(run.path):
        if not same(piece.start, here):
            where = f"piece {k - 1} ends" if k else "the run starts"
            raise AuditError(
                f"piece {k} starts at {place_text(piece.start)}, but {where} at {place_text(here)}"
            )
        here = piece.end


def _check_pieces(run: Run, world: World, bodies: Sequence[Body], field: Field | None) -> Tracks:
    """Straight pieces stay out of interiors, boundary pieces keep to one edge, which is returned.

    Of a sweep both stay in the terrain: boundaries are shores, and it is enough that ends do.
    """
    tracks: Tracks = []
    for k, piece in enumerate(run.path):
        i = piece.obstacle
        if (piece.kind, i is None) not in (("straight", True), ("boundary", False)):
            raise AuditError(f"piece {k} is {piece.kind!r} along {i}")
        track = None
        if i is None:
            _check_straight(world, k, piece.curve)
        elif i not in range(len(bodies)):
            raise AuditError(f"piece {k} is along obstacle {i}, which the scene does not have")
        else:
            track = _track(bodies[i], piece.curve)
            if track is None:
                raise AuditError(f"piece {k} does not lie on an edge of obstacle {i}")
        if field is not None and not (field.contains(piece.start) and field.contains(piece.end)):
            raise AuditError(f"piece {k} leaves the terrain")
        tracks.append(track)
    return tracks


def _check_straight(world: World, k: int, curve: Curve) -> None:
    if isinstance(curve, Arc) or same(curve.start, curve.end):
        raise AuditError(f"piece {k} is straight, but not a segment longer than a point")
    near = world.near(curve)
    ends = (world.passing(place, near) for place in (curve.start, curve.end))
    found = world.blocker(curve.start, curve.direction, 1, near, *ends)
    if found is not None:
        inside, point = found
        raise AuditError(f"piece {k} passes through the interior of obstacle {inside} at {place_text(point)}")


def _track(body: Body, curve: Curve) -> Track | None:
    for forward in (True, False):
        walked = curve if forward else curve.reversed()
        for number, edge in zip(body.edges, body.curves, strict=True):
            if is_part(walked, edge):
                return Track(number, forward)
    return None


def _check_length(run: Run) -> None:
    total = ball_sum([piece.curve for piece in run.path])
    if not agrees(run.length, total):
        decimals = total.str(20, radius=False)
        raise AuditError(
            f"the length is {run.length.decimal(20)}..., but the pieces add up to {decimals}... "
            f"(compared to {DIGITS} digits)"
        )


# -- events ----------------------------------------------------------------------------------------


def _place(run: Run, after: int) -> Point:
    """Where the robot is after so many pieces."""
    return run.path[after - 1].end if after else run.start


def _check_events(run: Run, rng: Random, moves: Collection[EventKind]) -> None:
    """Events lie on the path where they say, in its order, from the start to the stop."""
    kinds = [event.kind for event in run.events]
    ends = EventKind.START, EventKind.STOP
    if (kinds[:1], kinds[-1:]) != ([ends[0]], [ends[1]]) or not set(ends).isdisjoint(kinds[1:-1]):
        raise AuditError("events begin with one start and end with one stop")
    places = []
    for event in run.events:
        if event.kind not in moves and event.kind not in SENSED:
            raise AuditError(f"{event_name(run, event)} is of no known kind")
        if not _is_at(run, event):
            raise AuditError(f"{event_name(run, event)} is not on the path: {place_text(event.point)}")
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
        with ctx.workprec(BITS):
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


def _check_moves(run: SightseerRun, tracks: Tracks) -> None:
    """Replay what the robot did: hits, loops, leaves and returns along the tree, as a stack."""
    links = {link.target: link for link in run.links}
    stack: list[int | str] = ["S"]
    visits: list[int] = []
    crossings: Counter[int] = Counter()
    depth = 0
    for before, event in pairwise(event for event in run.events if event.kind in MOVES):
        if event.kind not in MOVES[before.kind]:
            raise AuditError(f"{event_name(run, event)} cannot follow {event_name(run, before)}")
        _check_between(run, before, event)
        if event.kind is EventKind.HIT:
            link = links.get(event.obstacle if event.obstacle is not None else -1)
            if link is None or link.target in visits or link.source != stack[-1]:
                raise AuditError(f"{event_name(run, event)} has no link from {stack[-1]} or is not the first")
            _check_crossing(run, before, event, (link.leave, link.hit))
            stack.append(link.target)
            visits.append(link.target)
            crossings[link.target] += 1
            _check_loop(run, tracks, event)
        elif event.kind is EventKind.BACKTRACK:
            link = links[int(stack.pop())]
            _check_crossing(run, before, event, (link.hit, link.leave))
            crossings[link.target] += 1
        if (event.obstacle if event.obstacle is not None else "S") != stack[-1]:
            raise AuditError(f"{event_name(run, event)} happens at {stack[-1]}")
        depth = max(depth, len(stack) - 1)
    if list(run.visits) != visits:
        raise AuditError(f"visits are {list(run.visits)}, but the hits were {visits}")
    if list(links) != visits:
        raise AuditError(f"links lead to {list(links)}, but the visits were {visits}")
    for link in run.links:
        if link.traversals != crossings[link.target]:
            times = crossings[link.target]
            raise AuditError(f"{link_name(link)} was walked {times} times, not {link.traversals}")
    if run.stack_depth != depth:
        raise AuditError(f"the stack was {depth} deep, not {run.stack_depth}")


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


def _check_loop(run: Run, tracks: Tracks, hit: Event) -> None:
    """After its hit the whole boundary is walked in one go: in one sense, and as long as it is."""
    assert hit.obstacle is not None
    perimeter = run.scene.obstacles[hit.obstacle].perimeter
    walked: list[Length] = []
    senses = set()
    for piece, track in zip(run.path[hit.after :], tracks[hit.after :], strict=True):
        if track is None or piece.obstacle != hit.obstacle:
            break
        walked.append(piece.length)
        senses.add(track.forward)
        if len(senses) == 1 and same(piece.end, hit.point) and Length.sum(walked) == perimeter:
            return
    raise AuditError(f"obstacle {hit.obstacle} was not walked all around after {event_name(run, hit)}")


def _check_sights(run: Run) -> None:
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


def _check_accounts(run: Run) -> None:
    """Unseen and unvisited obstacles, and the events of sight, agree with the map.

    A sweep that comes to its end has acquired what it has seen; what it has not is unvisited.
    """
    seen, acquired, visits = set(run.map.seen), set(run.map.acquired), set(run.visits)
    left = seen - (visits if isinstance(run, SightseerRun) else acquired)
    for name, claimed, expected in (
        ("unseen", run.unseen, set(range(len(run.obstacles))) - seen),
        ("unvisited", run.unvisited, left),
        ("sighted in events", _obstacles(run, EventKind.SIGHT), seen),
        ("acquired in events", _obstacles(run, EventKind.ACQUIRE), acquired),
    ):
        if sorted(claimed) != sorted(expected):
            raise AuditError(f"obstacles {name} are {sorted(claimed)}, by the map {sorted(expected)}")
    if visits - acquired:
        raise AuditError(
            f"obstacles {sorted(visits - acquired)} were visited, but the map lacks parts of them"
        )
    if run.ending is Ending.END_OF_M_LINE and left:
        raise AuditError(f"obstacles {sorted(left)} were seen, but not acquired when T was reached")
    if isinstance(run, SightseerRun):
        _check_ending(run, left)


def _check_ending(run: SightseerRun, left: set[int]) -> None:
    """Why a run of the Sightseer ended agrees with what it visited; *left* are seen, but unvisited."""
    stop, is_all = run.events[-1], len(run.visits) == len(run.obstacles)
    is_due = {
        Ending.ALL_VISITED: is_all,
        Ending.NOTHING_UNVISITED: not is_all and not left,
        Ending.BACK_AT_START: not is_all and stop.obstacle is None,
    }
    if stop.ending is None or not is_due.get(stop.ending, False):
        raise AuditError(f"{event_name(run, stop)} is due to {stop.note!r}, which is not so")


def _obstacles(run: Run, kind: EventKind) -> list[int]:
    return [event.obstacle for event in run.events if event.kind == kind and event.obstacle is not None]
