"""Laws of a sweep: its way along the M-line, its diversions, and what obstacles look like to it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from exactacq.auditing.comparisons import same
from exactacq.auditing.ground import CrossingPoint, Field
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.sensing.event import Event, EventKind, Occasion
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.strategies.run import Diversion, Run
from exactacq.study.claims.model import Case
from exactacq.study.claims.walks import is_circuit, stays

# -- along the M-line ------------------------------------------------------------------------------


def place(field: Field, point: Point) -> Real:
    """The length of the M-line from S to a point of it; ValueError elsewhere."""
    for k in range(len(field.pieces)):
        at = field.position(k, point)
        if at is not None:
            return at
    raise ValueError(f"{point} is not on the M-line")


def progress_flaw(case: Case) -> str | None:
    """Whether a sweep makes progress: hops advance on the M-line, diversions acquire an obstacle each."""
    run, field = case.spreader, case.field
    at, acquired, hit = Real(0), set[int | None](), False
    for event in run.events:
        if event.kind is EventKind.ACQUIRE:
            acquired.add(event.obstacle)
        if event.occasion is not Occasion.M_LINE and event.kind not in (EventKind.DIVERT, EventKind.RETURN):
            continue
        here = place(field, event.point)
        if here < at or (hit and event.kind is EventKind.LEAVE and here == at):
            return f"the sweep does not advance at {event.point} ({event.kind})"
        if event.kind is EventKind.DIVERT and event.obstacle in acquired:
            return f"a diversion to obstacle {event.obstacle}, which is acquired"
        if event.kind is EventKind.RETURN and event.obstacle not in acquired:
            return f"a diversion did not acquire obstacle {event.obstacle}"
        hit = event.occasion is Occasion.M_LINE and event.kind is not EventKind.LEAVE
        at = here
    last = run.events[-1]
    if last.kind is not EventKind.STOP or last.after != len(run.path):
        return "the run does not end with its stop"
    stuck = last.ending is not None and last.ending.is_early
    return None if case.swept_to_the_end or stuck else f"it stops at {last.point}: {last.note}"


class Hop(NamedTuple):
    """A hit on the M-line with the marks where it begins and where the robot leaves, by their numbers."""

    obstacle: int
    hit: int
    leave: int


def hops(case: Case) -> Iterator[Hop]:
    """All hops over obstacles that block the M-line, in order.

    ValueError where a hit or leave point is no crossing point after the one before.
    """
    marks, after = case.field.marks, -1
    hit = -1
    for event in case.spreader.events:
        if event.occasion is not Occasion.M_LINE:
            continue
        after = _mark(marks, after, event)
        if event.kind is EventKind.LEAVE:
            assert event.obstacle is not None
            yield Hop(event.obstacle, hit, after)
        else:
            hit = after


def _mark(marks: Sequence[CrossingPoint], after: int, event: Event) -> int:
    for k in range(after + 1, len(marks)):
        if marks[k].ends == (event.kind is EventKind.LEAVE) and same(marks[k].point, event.point):
            return k
    raise ValueError(f"{event.point} is no crossing point ahead")


def crossing_flaw(case: Case, clear_only: bool) -> str | None:
    """Whether from its hit c_k the robot leaves an obstacle at c_(k+1), and crossings come in pairs.

    With *clear_only* that is asked of obstacles clear of the border, and of others that L is the first later
    crossing point at which the M-line goes on and that the robot can walk to.
    """
    marks = case.field.marks
    for hop in hops(case):
        mine = [k for k, mark in enumerate(marks) if mark.owner == hop.obstacle]
        if clear_only and not case.spreader.obstacles[hop.obstacle].closed:
            expected = next(k for k in mine if k > hop.hit and marks[k].ends and marks[k].ashore)
        else:
            expected = mine[mine.index(hop.hit) + 1]
        if hop.leave != expected:
            where = f"hit at {marks[hop.hit].point}, left at {marks[hop.leave].point}"
            return f"obstacle {hop.obstacle} is {where}, the next is {marks[expected].point}"
        if clear_only and case.spreader.obstacles[hop.obstacle].closed and len(mine) % 2:
            return f"obstacle {hop.obstacle} has {len(mine)} crossing points"
    return None


# -- diversions ------------------------------------------------------------------------------------


def circled_on(run: Run, diversion: Diversion) -> set[int]:
    """The obstacles that a diversion circles."""
    own = (stay for stay in stays(run) if diversion.first <= stay.first < diversion.last)
    return {stay.obstacle for stay in own if is_circuit(run, stay)}


class Silence(NamedTuple):
    """What a walk along the bare M-line shows.

    ``lost`` are the obstacles that go out of sight on a line with j >= 1 while they are incomplete; ``left``
    those that are incomplete at T.
    """

    lost: frozenset[int]
    left: tuple[int, ...]


def bare_walk(case: Case) -> Silence:
    """Sense along the whole M-line without any diversion: for sweeps that no obstacle blocks."""
    run, field = case.spreader, case.field
    path = [Piece("straight", None, way) for way in field.pieces]
    memory = Memory.of(run.scene, run.radius, run.start, path, run.ground)
    lost = set()
    for report in memory.reports:
        on_line = any(
            n % 2 == 0 and n > 0 and field.position(n, report.place) is not None
            for n in (report.after - 1, report.after)
            if 0 <= n < len(path)
        )
        if report.kind is EventKind.LOSE and on_line:
            lost.add(report.obstacle)
    return Silence(frozenset(lost), memory.now.incomplete)


# -- shapes ----------------------------------------------------------------------------------------


def is_convex(edges: Sequence[Curve]) -> bool:
    """Whether a simple closed boundary, walked with the obstacle on the left, only turns left."""
    if any(isinstance(edge, Arc) and not edge.ccw for edge in edges):
        return False
    if len(edges) == 1:
        return True
    turns = zip(edges, [*edges[1:], edges[0]], strict=True)
    return all(_turns_left(_leaving(a, a.end), _leaving(b, b.start)) for a, b in turns)


def _turns_left(before: Point, after: Point) -> bool:
    """Whether one goes on to the left or straight; at a cusp one turns back, and nothing convex has one."""
    turn = before.cross(after).sign()
    return turn > 0 or (turn == 0 and before.dot(after).sign() > 0)


def _leaving(edge: Curve, point: Point) -> Point:
    return edge.tangent(point) if isinstance(edge, Arc) else edge.direction


def all_convex(run: Run) -> bool:
    """Whether all obstacles are convex and clear of the border."""
    return all(body.closed and is_convex(body.edges) for body in run.obstacles)
