"""The audit: a finished run checked again by other means than the code that made it.

Lengths are re-added in balls, pieces are located among all edges, events are replayed, bounds are computed
again from the paper's formulas, and knowledge is decided from the target's side (`exactacq.audit_views`).
Nothing of the strategy, the robot, the links or the sweep is used.

Places that are not rational are compared with the path and with each other at `DIGITS` digits: there a
deviation beyond them is not found. Everything else is exact, or a ball proves the flaw.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from random import Random
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from flint import arb, ctx, fmpq

from exactacq.audit_views import Lookout, World, point_at, point_near, visible
from exactacq.contacts import nearest_points
from exactacq.curves import Arc, Curve, Segment
from exactacq.errors import AuditError
from exactacq.lengths import Length
from exactacq.points import Point
from exactacq.reals import Real
from exactacq.scene import Obstacle
from exactacq.trace import Event, Run, TreeLink

DIGITS = 500
"""Decimals to which lengths are re-added."""
BITS = 2048
"""First working precision: 500 decimals are 1661 bits, the rest covers cancellation."""
MOMENTS = 6
"""Events at which the map is checked, besides the end."""
ASIDE = fmpq(1, 10**11)
"""How far beside the ends of known parts targets are taken: an end that is farther off is found."""

MOVES = {
    "start": {"hit", "stop"},
    "hit": {"leave", "stop"},
    "leave": {"hit", "backtrack"},
    "backtrack": {"leave", "hit", "stop"},
    "stop": set[str](),
}
"""What the robot does, and what it can do next; the other kinds of events tell what it sees."""
SIGHTS = ("sight", "acquire", "lose", "regain")


class Track(NamedTuple):
    """The edge of the scene on which a boundary piece lies, and whether it follows the edge's sense."""

    edge: int
    forward: bool


Tracks: TypeAlias = "list[Track | None]"


def audit(run: Run, samples: int = 64, seed: int = 0) -> None:
    """Check a finished Sightseer run; `AuditError` names the first flaw, None is praise.

    *samples* is the number of random targets, of targets beside ends of known parts, and of places on the
    path: what is known is checked on a sample, all else completely. The same *seed* takes the same sample.
    ValueError for runs of another strategy, `Undecided` where an exact comparison is beyond its limits. Cost:
    about ten milliseconds a sample at ten obstacles in range, less than one a piece and an event, and that of
    `MOMENTS` maps.
    """
    if run.strategy != "sightseer":
        raise ValueError(f"no audit for runs of the strategy {run.strategy!r}")
    rng = Random(seed)
    world = World(run.scene)
    _check_continuity(run)
    tracks = _check_pieces(run, world)
    _check_length(run)
    _check_events(run, rng)
    _check_moves(run, tracks)
    _check_links(run)
    _check_sights(run)
    _check_bounds(run, world)
    _check_accounts(run)
    knowledge = _Knowledge(run, world, tracks, rng)
    knowledge.check_maps()
    knowledge.check_targets(samples)
    knowledge.check_in_sight(samples)


# -- balls -----------------------------------------------------------------------------------------


def _refined(compute: Callable[[int], arb]) -> arb:
    """A ball computed with enough working bits to know `DIGITS` decimals."""
    bits = BITS
    while True:
        with ctx.workprec(bits):
            ball = compute(bits)
            if ball.is_finite() and ball.rad() < arb(10) ** -DIGITS:
                return ball
        bits *= 2


def _difference(a: Point, b: Point, bits: int) -> tuple[arb, arb]:
    return a.x.ball(bits) - b.x.ball(bits), a.y.ball(bits) - b.y.ball(bits)


def _ball_to(curve: Curve, point: Point, bits: int) -> arb:
    """Length of a curve from its start to a point of it, 0 to the start itself."""
    if _same(point, curve.start):
        return arb(0)
    if isinstance(curve, Segment):
        x, y = _difference(point, curve.start, bits)
        return (x * x + y * y).sqrt()
    a, b = (_difference(p, curve.center, bits) for p in (curve.start, point))
    sine = a[0] * b[1] - a[1] * b[0]
    # From 0 to a full turn, with the cut of the arc tangent at the start.
    angle = arb.pi() + arb.atan2(-sine if curve.ccw else sine, -(a[0] * b[0] + a[1] * b[1]))
    return arb(curve.radius_sq).sqrt() * angle


def _ball_of(curve: Curve, bits: int) -> arb:
    """Length of a curve: sqrt(dx^2 + dy^2), or radius times angle."""
    if isinstance(curve, Arc) and (curve.full or _same(curve.start, curve.end)):
        return 2 * arb.pi() * arb(curve.radius_sq).sqrt()
    return _ball_to(curve, curve.end, bits)


def _ball_sum(curves: Sequence[Curve]) -> arb:
    return _refined(lambda bits: sum((_ball_of(curve, bits) for curve in curves), arb(0)))


def _agrees(length: Length, ball: arb) -> bool:
    """Whether a length and a ball agree to `DIGITS` decimals."""
    with ctx.workprec(BITS):
        low, high = length.enclosure(BITS - 256)
        return not (arb(high) < ball or arb(low) > ball)


def _same(a: Point, b: Point) -> bool:
    """Whether two points are equal: by their form if that shows it, else decided."""
    return a is b or a.key == b.key or a == b


def _passes(curve: Curve, point: Point) -> bool:
    """Whether a curve contains a point: exactly if it is rational, else to `DIGITS` digits."""
    if point is curve.start or point is curve.end:
        return True
    return curve.passes(point) if point.rational else curve.may_pass(point, BITS)


def _text(point: Point) -> str:
    x, y = point.xy
    return f"({x:.15g}, {y:.15g})"


# -- the path --------------------------------------------------------------------------------------


def _check_continuity(run: Run) -> None:
    here = run.start
    for k, piece in enumerate(run.path):
        if not _same(piece.start, here):
            where = f"piece {k - 1} ends" if k else "the run starts"
            raise AuditError(f"piece {k} starts at {_text(piece.start)}, but {where} at {_text(here)}")
        here = piece.end


def _check_pieces(run: Run, world: World) -> Tracks:
    """Straight pieces stay out of interiors, boundary pieces keep to one edge, which is returned."""
    tracks: Tracks = []
    for k, piece in enumerate(run.path):
        i = piece.obstacle
        if (piece.kind, i is None) not in (("straight", True), ("boundary", False)):
            raise AuditError(f"piece {k} is {piece.kind!r} along {i}")
        track = None
        if i is None:
            _check_straight(world, k, piece.curve)
        elif i not in range(len(run.scene.obstacles)):
            raise AuditError(f"piece {k} is along obstacle {i}, which the scene does not have")
        else:
            track = _track(world, run.scene.obstacles[i], piece.curve)
            if track is None:
                raise AuditError(f"piece {k} does not lie on an edge of obstacle {i}")
        tracks.append(track)
    return tracks


def _check_straight(world: World, k: int, curve: Curve) -> None:
    if isinstance(curve, Arc) or _same(curve.start, curve.end):
        raise AuditError(f"piece {k} is straight, but not a segment longer than a point")
    found = world.blocker(curve.start, curve.direction, 1)
    if found is not None:
        inside, point = found
        raise AuditError(f"piece {k} passes through the interior of obstacle {inside} at {_text(point)}")


def _track(world: World, obstacle: Obstacle, curve: Curve) -> Track | None:
    first = world.first[obstacle.index]
    for forward in (True, False):
        walked = curve if forward else curve.reversed()
        for k, edge in enumerate(obstacle.edges):
            if _is_part(walked, edge):
                return Track(first + k, forward)
    return None


def _is_part(curve: Curve, edge: Curve) -> bool:
    """Whether a curve is a part of an edge, longer than a point, in the edge's sense."""
    if isinstance(curve, Segment) and isinstance(edge, Segment):
        ends_match = all(edge.may_pass(p, 64) and edge.passes(p) for p in (curve.start, curve.end))
        return ends_match and curve.direction.dot(edge.direction).sign() > 0
    if isinstance(curve, Segment) or isinstance(edge, Segment):
        return False
    if (curve.ccw, curve.radius_sq) != (edge.ccw, edge.radius_sq) or not _same(curve.center, edge.center):
        return False
    if _same(curve.start, edge.start) and _same(curve.end, edge.end):
        return curve.full == edge.full
    if curve.full or not all(edge.may_pass(p, 64) and edge.passes(p) for p in (curve.start, curve.end)):
        return edge.full and edge.on_circle(curve.start)
    if edge.full or _same(curve.start, edge.start) or _same(curve.end, edge.end):
        return True
    reverse = _same(curve.start, edge.end) or _same(curve.end, edge.start)
    return not reverse and edge.part(edge.start, curve.end).contains(curve.start)


def _check_length(run: Run) -> None:
    total = _ball_sum([piece.curve for piece in run.path])
    if not _agrees(run.length, total):
        decimals = total.str(20, radius=False)
        raise AuditError(
            f"the length is {run.length.decimal(20)}..., but the pieces add up to {decimals}... "
            f"(compared to {DIGITS} digits)"
        )


# -- events ----------------------------------------------------------------------------------------


def _name(run: Run, event: Event) -> str:
    number = next(k for k, other in enumerate(run.events) if other is event)
    about = "" if event.obstacle is None else f" of obstacle {event.obstacle}"
    return f"event {number} ({event.kind}{about})"


def _place(run: Run, after: int) -> Point:
    """Where the robot is after so many pieces."""
    return run.path[after - 1].end if after else run.start


def _check_events(run: Run, rng: Random) -> None:
    """Events lie on the path where they say, in its order, from the start to the stop."""
    kinds = [event.kind for event in run.events]
    if kinds[:1] != ["start"] or kinds[-1:] != ["stop"] or not {"start", "stop"}.isdisjoint(kinds[1:-1]):
        raise AuditError("events begin with one start and end with one stop")
    places = []
    for event in run.events:
        if event.kind not in MOVES and event.kind not in SIGHTS:
            raise AuditError(f"{_name(run, event)} is of no known kind")
        if not _is_at(run, event):
            raise AuditError(f"{_name(run, event)} is not on the path: {_text(event.point)}")
        places.append(_position(run, event))
    for (before, (k, s)), (event, (m, t)) in pairwise(zip(run.events, places, strict=True)):
        if m < k or (m == k and t < s):
            raise AuditError(f"{_name(run, event)} comes after {_name(run, before)}, but lies before it")
    if run.events[-1].after != len(run.path):
        raise AuditError("the stop is not at the end of the path")
    for event in rng.sample(run.events, min(MOMENTS, len(run.events))):
        done = _ball_sum([piece.curve for piece in run.path[: event.after]])
        if not _agrees(event.at, done + _position(run, event)[1]):
            raise AuditError(f"{_name(run, event)} says that it is at {event.at.decimal(20)}... of the path")


def _is_at(run: Run, event: Event) -> bool:
    """Whether an event is where piece number ``after`` begins, or, if it is no move, inside that piece."""
    if not event.inside:
        return 0 <= event.after <= len(run.path) and _same(event.point, _place(run, event.after))
    on_piece = event.kind in SIGHTS and 0 <= event.after < len(run.path)
    return on_piece and _passes(run.path[event.after].curve, event.point)


def _position(run: Run, event: Event) -> tuple[int, arb]:
    """Number of whole pieces, and the way along the next one."""
    if not event.inside:
        return event.after, arb(0)
    curve = run.path[event.after].curve
    return event.after, _refined(lambda bits: _ball_to(curve, event.point, bits))


def _check_moves(run: Run, tracks: Tracks) -> None:
    """Replay what the robot did: hits, loops, leaves and returns along the tree, as a stack."""
    links = {link.target: link for link in run.links}
    stack: list[int | str] = ["S"]
    visits: list[int] = []
    crossings: Counter[int] = Counter()
    depth = 0
    for before, event in pairwise(event for event in run.events if event.kind in MOVES):
        if event.kind not in MOVES[before.kind]:
            raise AuditError(f"{_name(run, event)} cannot follow {_name(run, before)}")
        _check_between(run, before, event)
        if event.kind == "hit":
            link = links.get(event.obstacle if event.obstacle is not None else -1)
            if link is None or link.target in visits or link.source != stack[-1]:
                raise AuditError(f"{_name(run, event)} has no link from {stack[-1]} or is not the first")
            _check_crossing(run, before, event, (link.leave, link.hit))
            stack.append(link.target)
            visits.append(link.target)
            crossings[link.target] += 1
            _check_loop(run, tracks, event)
        elif event.kind == "backtrack":
            link = links[int(stack.pop())]
            _check_crossing(run, before, event, (link.hit, link.leave))
            crossings[link.target] += 1
        if (event.obstacle if event.obstacle is not None else "S") != stack[-1]:
            raise AuditError(f"{_name(run, event)} happens at {stack[-1]}")
        depth = max(depth, len(stack) - 1)
    if list(run.visits) != visits:
        raise AuditError(f"visits are {list(run.visits)}, but the hits were {visits}")
    if list(links) != visits:
        raise AuditError(f"links lead to {list(links)}, but the visits were {visits}")
    for link in run.links:
        if link.traversals != crossings[link.target]:
            times = crossings[link.target]
            raise AuditError(f"{_link(link)} was walked {times} times, not {link.traversals}")
    if run.stack_depth != depth:
        raise AuditError(f"the stack was {depth} deep, not {run.stack_depth}")


def _check_between(run: Run, before: Event, event: Event) -> None:
    """Between two moves the robot keeps to the boundary that it is at, or goes straight between two."""
    at = None if before.kind in ("start", "leave") else before.obstacle
    for k in range(before.after, event.after):
        if run.path[k].obstacle != at:
            raise AuditError(f"piece {k} between {_name(run, before)} and {_name(run, event)} is not at {at}")


def _check_crossing(run: Run, before: Event, event: Event, ends: tuple[Point, Point]) -> None:
    """The robot crosses by the link, in one straight piece, or in none if the link is a point."""
    count = 0 if _same(*ends) else 1
    if event.after - before.after != count:
        pieces = event.after - before.after
        raise AuditError(f"{_name(run, event)} comes {pieces} pieces after the boundary was left")
    for point, end in zip((before.point, event.point), ends, strict=True):
        if not _same(point, end):
            raise AuditError(f"{_name(run, event)}: its link has an end at {_text(end)}, not {_text(point)}")


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
        if len(senses) == 1 and _same(piece.end, hit.point) and Length.sum(walked) == perimeter:
            return
    raise AuditError(f"obstacle {hit.obstacle} was not walked all around after {_name(run, hit)}")


def _check_sights(run: Run) -> None:
    """Of each obstacle: sight before all else, lose and regain in turn until it is acquired, once."""
    state: dict[int, str] = {}
    follows = {"lose": ("sight", "regain"), "regain": ("lose",), "acquire": ("sight", "regain", "lose")}
    for event in run.events:
        i = event.obstacle
        if i is None or event.kind == "stop":
            continue
        before = state.get(i)
        if event.kind in SIGHTS:
            if before not in follows.get(event.kind, (None,)):
                raise AuditError(f"{_name(run, event)} cannot follow {before or 'nothing'}")
            if event.kind == "lose" and event.note not in ("occlusion", "range"):
                raise AuditError(f"{_name(run, event)} is due to {event.note!r}")
            state[i] = event.kind
        elif before is None:
            raise AuditError(f"{_name(run, event)} comes before obstacle {i} was seen")


# -- links and bounds ------------------------------------------------------------------------------


def _link(link: TreeLink) -> str:
    return f"the link from {link.source} to {link.target}"


def _check_links(run: Run) -> None:
    """Links are as long as their segments, within the radius, and add up to the straight pieces."""
    total = Length(0)
    for link in run.links:
        if not _agrees(link.length, _ball_sum([Segment(link.leave, link.hit)])):
            raise AuditError(f"{_link(link)} is not {link.length.decimal(20)}... long")
        if link.length > run.radius:
            raise AuditError(f"{_link(link)} is longer than the radius")
        total = total + link.length * link.traversals
    straight = _ball_sum([piece.curve for piece in run.path if piece.kind == "straight"])
    if not _agrees(total, straight):
        raise AuditError(f"the links walked add up to {total.decimal(20)}..., the straight pieces do not")


def _check_bounds(run: Run, world: World) -> None:
    """Each bound has the value of its formula, and holds if and only if it says so."""
    names = [bound.name for bound in run.bounds]
    values = _bound_values(run, world)
    if names != list(values):
        raise AuditError(f"the bounds are {names}, not {list(values)}")
    length = _ball_sum([piece.curve for piece in run.path])
    for bound in run.bounds:
        value = values[bound.name]
        if not _agrees(bound.value, value):
            raise AuditError(f"bound {bound.name} is {bound.value.decimal(20)}..., not {value.str(20)}")
        # Where balls cannot tell the two apart they may be equal, which only exact lengths decide.
        holds = True if length < value else False if length > value else run.length <= bound.value
        if bound.holds is not holds:
            raise AuditError(f"bound {bound.name} says {bound.holds}, but holds is {holds}")
        with ctx.workprec(BITS):
            ratio = length / value if value != 0 else arb("nan")
        if not abs(ratio - arb(bound.ratio)) < 1e-12 and (ratio.is_finite() or bound.ratio == bound.ratio):
            raise AuditError(f"bound {bound.name} has the ratio {bound.ratio}, not {ratio.str(17)}")


def _bound_values(run: Run, world: World) -> dict[str, arb]:
    """The paper's (1) and (2), and the forms that hold; S-S1 is the way from a free start, v a link.

    (1)  2 (n - 1) min(R, d_max) + 3/2 sum p + (n - 2)/2 p_max;  (2)  the same with R for the minimum;
    T1 corrected  S-S1 + (2 n - 3) min(R, v_max) + 3/2 sum p - p_last/2 + (n - 2)/2 p_max, or S-S1 + p_1.
    """
    obstacles, n = run.scene.obstacles, len(run.scene.obstacles)
    if not n:
        return {}
    with ctx.workprec(BITS):
        perimeters = [_ball_sum(obstacle.edges) for obstacle in obstacles]
        reach = arb(run.radius)
        lengths = [(link.source, _ball_sum([Segment(link.leave, link.hit)])) for link in run.links]
        approach = sum((length for source, length in lengths if source == "S"), arb(0))
        steps = [length for source, length in lengths if source != "S"]
        largest = _greatest(perimeters)
        around = sum(perimeters, arb(0)) * 3 / 2 + largest * (n - 2) / 2
        last = perimeters[run.visits[-1]] if run.visits else arb(0)
        step = reach.min(_greatest(steps)) if steps else arb(0)
        corrected = approach + (step * (2 * n - 3) + around - last / 2 if n > 1 else perimeters[0])
        wide = 2 * (n - 1) * reach + around
        return {
            "(1)": 2 * (n - 1) * _clipped_distance(run, world) + around,
            "(2)": wide,
            "T1 corrected": corrected,
            "(2) + S-S1": wide + approach,
        }


def _greatest(balls: Sequence[arb]) -> arb:
    found = balls[0]
    for ball in balls[1:]:
        found = found.max(ball)
    return found


def _clipped_distance(run: Run, world: World) -> arb:
    """The largest closest distance between two obstacles, or the radius if that is less.

    Only pairs whose boxes do not keep them below the largest so far need an exact distance.
    """
    ranges = [_edges_of(world, o.index) for o in run.scene.obstacles]
    hulls = np.array([[*world.boxes[r, :2].min(axis=0), *world.boxes[r, 2:].max(axis=0)] for r in ranges])
    best = Real(0)
    for i, hull in enumerate(hulls):
        reach = np.hypot(*np.maximum(hull[2:] - hulls[:, :2], hulls[:, 2:] - hull[:2]).T) * (1 + 1e-12)
        for j in range(i):
            if reach[j] >= float(best):
                best = max(best, _distance(world, ranges[i], ranges[j]))
                if best.compare(run.radius) >= 0:
                    return arb(run.radius)
    return best.ball(BITS)


def _edges_of(world: World, i: int) -> list[int]:
    return list(range(world.first[i], world.first[i] + len(world.obstacles[i].edges)))


def _distance(world: World, first: Iterable[int], second: Sequence[int]) -> Real:
    """The closest distance between two obstacles, given by their edges."""
    least: Real | None = None
    for a in first:
        gaps = np.maximum(
            world.boxes[second, :2] - world.boxes[a, 2:], world.boxes[a, :2] - world.boxes[second, 2:]
        )
        for gap, b in zip(np.hypot(*np.maximum(gaps, 0).T), second, strict=True):
            if least is None or gap**2 * (1 - 1e-12) <= float(least):
                for pair in nearest_points(world.edges[a], world.edges[b]):
                    least = pair.distance_sq if least is None else min(least, pair.distance_sq)
    assert least is not None
    return least.sqrt()


# -- knowledge -------------------------------------------------------------------------------------


def _check_accounts(run: Run) -> None:
    """Unseen and unvisited obstacles, and the events of sight, agree with the map."""
    seen, acquired, visits = set(run.map.seen), set(run.map.acquired), set(run.visits)
    for name, claimed, expected in (
        ("unseen", run.unseen, set(range(len(run.scene.obstacles))) - seen),
        ("unvisited", run.unvisited, seen - visits),
        ("sighted in events", _obstacles(run, "sight"), seen),
        ("acquired in events", _obstacles(run, "acquire"), acquired),
    ):
        if sorted(claimed) != sorted(expected):
            raise AuditError(f"obstacles {name} are {sorted(claimed)}, by the map {sorted(expected)}")
    if visits - acquired:
        raise AuditError(
            f"obstacles {sorted(visits - acquired)} were visited, but the map lacks parts of them"
        )


def _obstacles(run: Run, kind: str) -> list[int]:
    return [event.obstacle for event in run.events if event.kind == kind and event.obstacle is not None]


class _Moment(NamedTuple):
    """A name for messages, whole pieces so far, the place if it is inside the next one, and the map there."""

    name: str
    after: int
    inside: Point | None
    chart: Any


class _Knowledge:
    """The maps of a run, checked in themselves and against what the path sees."""

    def __init__(self, run: Run, world: World, tracks: Tracks, rng: Random) -> None:
        self.run, self.world, self.tracks, self.rng = run, world, tracks, rng
        self.on = [None if track is None else track.edge for track in tracks]
        self.lookout = Lookout(world, run.radius, [piece.curve for piece in run.path], self.on)
        self.events = {(e.kind, e.obstacle): e for e in run.events if e.kind in ("sight", "acquire")}
        chosen = sorted(rng.sample(range(len(run.events)), min(MOMENTS, len(run.events))))
        self.moments = [
            _Moment(f"the map at {_name(run, event)}", event.after, _inside(event), run.map_at(event))
            for event in (run.events[k] for k in chosen)
        ]
        self.moments.append(_Moment("the final map", len(run.path), None, run.map))

    # -- maps in themselves ------------------------------------------------------------------------

    def check_maps(self) -> None:
        """Each map's parts are in order, and its lists and lengths are what they add up to."""
        for name, _, _, chart in self.moments:
            states = [self._check_parts(name, chart, obstacle) for obstacle in self.run.scene.obstacles]
            for kind, claimed in (("acquired", chart.acquired), ("incomplete", chart.incomplete)):
                expected = [i for i, state in enumerate(states) if state == kind]
                if list(claimed) != expected:
                    raise AuditError(
                        f"{name}: {kind} obstacles are {list(claimed)}, the parts say {expected}"
                    )
            if sorted(chart.seen) != sorted((*chart.acquired, *chart.incomplete)):
                raise AuditError(f"{name}: seen obstacles are {list(chart.seen)}")

    def _check_parts(self, name: str, chart: Any, obstacle: Obstacle) -> str:
        """Parts of one obstacle are on their edges, in order and apart; returns what they make of it."""
        total, before = arb(0), (-1, arb(0))
        parts = chart.known(obstacle.index)
        ends = []
        for part in parts:
            edge = obstacle.edges[part.edge]
            where = (
                f"{name}: the part of obstacle {obstacle.index} from {_text(part.start)} to {_text(part.end)}"
            )
            if not (_passes(edge, part.start) and _passes(edge, part.end)):
                raise AuditError(f"{where} is not on edge {part.edge}")
            low, high = _span(edge, part)
            if high < low:
                raise AuditError(f"{where} runs against edge {part.edge}")
            if part.edge < before[0] or (part.edge == before[0] and not before[1] < low):
                raise AuditError(f"{where} is not beyond the one before")
            before, total = (part.edge, high), total + high - low
            ends += [p for p in (part.start, part.end) if not (_same(p, edge.start) or _same(p, edge.end))]
        if not _agrees(chart.known_length(obstacle.index), total):
            raise AuditError(
                f"{name}: the known length of obstacle {obstacle.index} is not that of its parts"
            )
        whole = [_is_whole(obstacle.edges[part.edge], part) for part in parts]
        if len(whole) == len(obstacle.edges) and all(whole):
            return "acquired"
        frontier = [point for i, point in chart.frontier if i == obstacle.index]
        for end in ends:
            if not any(_same(end, point) for point in frontier):
                raise AuditError(
                    f"{name}: {_text(end)} of obstacle {obstacle.index} is missing in the frontier"
                )
        return "incomplete" if parts else "unseen"

    # -- maps against the path ---------------------------------------------------------------------

    def check_targets(self, samples: int) -> None:
        """Sampled boundary points are known when, and only when, some place of the path has seen them."""
        for i, target in self._targets(samples):
            first = self.lookout.first(target)
            where = f"the point {_text(target)} of obstacle {i}"
            for name, after, inside, chart in self.moments:
                seen = self._is_seen(target, first, after, inside)
                if chart.knows(i, target) and not seen:
                    raise AuditError(f"{name} knows {where}, which no place of the path so far sees")
                if seen and not chart.knows(i, target):
                    raise AuditError(f"{name} lacks {where}, which the path sees from piece {first}")
            self._check_sight(i, target, first, where)

    def _check_sight(self, i: int, target: Point, first: int | None, where: str) -> None:
        """A point is not seen before its obstacle's sight, and not after it is acquired."""
        sight, acquire = self.events.get(("sight", i)), self.events.get(("acquire", i))
        if sight is not None and first is not None:
            last = sight.after if sight.inside else sight.after - 1
            early = self._before(last, sight.point)
            if first < last or (early is not None and self._is_seen(target, first, last, early)):
                raise AuditError(f"{_name(self.run, sight)} is late: piece {first} sees {where} before")
        if acquire is not None and not self._is_seen(target, first, acquire.after, _inside(acquire)):
            raise AuditError(f"{_name(self.run, acquire)} is early: {where} was not seen so far")

    def _before(self, k: int, point: Point) -> Point | None:
        """A place on piece k shortly before a point of it, or None if that is not on the piece."""
        if k < 0:
            return None
        curve, track = self.run.path[k].curve, self.tracks[k]
        if isinstance(curve, Segment):
            return curve.part(curve.start, point).point(1 - ASIDE)
        assert track is not None
        place = point_near(self.world.edges[track.edge], point, -ASIDE if track.forward else ASIDE)
        if place is None or not curve.contains(place):
            return None
        return place if curve.full or curve.part(curve.start, point).contains(place) else None

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
        return Lookout(self.world, self.run.radius, [part], [self.on[after]]).first(target) is not None

    def _targets(self, samples: int) -> Iterator[tuple[int, Point]]:
        """Obstacles with rational points of their boundaries: anywhere, and beside ends of known parts."""
        obstacles = self.run.scene.obstacles
        for _ in range(samples if obstacles else 0):
            obstacle = self.rng.choice(obstacles)
            edge = self.rng.choice(obstacle.edges)
            place = point_at(edge, fmpq(self.rng.randrange(1 << 10), 1 << 10))
            if place is not None:
                yield obstacle.index, place
        ends = [
            (i, part.edge, end)
            for moment in self.moments
            for i in moment.chart.incomplete
            for part in moment.chart.known(i)
            for end in (part.start, part.end)
        ]
        for i, k, end in self.rng.sample(ends, min(samples // 2, len(ends))):
            beside = [point_near(obstacles[i].edges[k], end, shift) for shift in (-ASIDE, ASIDE)]
            for place in (*beside, end if end.rational else None):
                if place is not None:
                    yield i, place

    def check_in_sight(self, samples: int) -> None:
        """At sampled places between events, obstacles are in sight if and only if the events say so."""
        lookouts: dict[int, Lookout] = {}
        for _ in range(samples):
            place = self._anywhere()
            if place is None:
                continue
            k, point = place
            states = self._states(k, point)
            for i in self.rng.sample(sorted(states), min(3, len(states))):
                numbers = _edges_of(self.world, i)
                edges = [self.world.edges[e] for e in numbers]
                lookout = lookouts.setdefault(i, Lookout(self.world, self.run.radius, edges, numbers))
                if (lookout.first(point) is not None) != states[i]:
                    claim = "in sight" if states[i] else "out of sight"
                    raise AuditError(
                        f"obstacle {i} is not {claim} from {_text(point)} on piece {k}, as events say"
                    )

    def _anywhere(self) -> tuple[int, Point] | None:
        """A random piece and a rational point on it, None if there is none at hand."""
        if not self.run.path:
            return None
        k = self.rng.randrange(len(self.run.path))
        curve, track = self.run.path[k].curve, self.tracks[k]
        share = fmpq(self.rng.randrange(1, 1 << 10), 1 << 10)
        if isinstance(curve, Segment):
            point = curve.point(share)
            return None if point.rational is None else (k, point)
        assert track is not None
        place = point_at(self.world.edges[track.edge], share)
        return None if place is None or not curve.contains(place) else (k, place)

    def _states(self, k: int, point: Point) -> dict[int, bool]:
        """Whether each obstacle, but for acquired ones, is in sight at a place; empty at an event's place."""
        curve = self.run.path[k].curve
        here = _refined(lambda bits: _ball_to(curve, point, bits))
        states: dict[int, bool | None] = dict.fromkeys(range(len(self.run.scene.obstacles)), False)
        for event in self.run.events:
            if event.kind not in SIGHTS or event.after > k:
                continue
            assert event.obstacle is not None
            if event.after == k and event.inside:
                there = _position(self.run, event)[1]
                if there > here:
                    continue
                if not there < here:
                    return {}
            if states[event.obstacle] is not None:
                in_sight = event.kind in ("sight", "regain")
                states[event.obstacle] = None if event.kind == "acquire" else in_sight
        return {i: state for i, state in states.items() if state is not None}


def _inside(event: Event) -> Point | None:
    return event.point if event.inside else None


def _is_whole(edge: Curve, part: Any) -> bool:
    ends = _same(part.start, edge.start) and _same(part.end, edge.end)
    return ends and (part.whole or not (isinstance(edge, Arc) and edge.full))


def _span(edge: Curve, part: Any) -> tuple[arb, arb]:
    """Where a part of an edge begins and ends, as lengths along the edge.

    On a full circle, whose ends are one point, a single first point ends where it begins.
    """
    single = _same(part.start, part.end) and not _is_whole(edge, part)
    low = _refined(lambda bits: _ball_to(edge, part.start, bits))
    if single:
        return low, low
    if _same(part.end, edge.end):
        return low, _refined(lambda bits: _ball_of(edge, bits))
    return low, _refined(lambda bits: _ball_to(edge, part.end, bits))
