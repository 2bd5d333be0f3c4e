"""Nearest frontier: to the nearest end of known boundary, and on along it until that obstacle is acquired.

B. Yamauchi, "A frontier-based approach for autonomous exploration", CIRA 1997: the robot goes to the nearest
place where what it knows ends, by the shortest path through what it knows. There that is a grid whose cells
are known to be open; here boundaries are known, and frontiers are the ends of their known parts. So the paths
here are shortest among all that is known, and what is not known counts as free (`Robot.path_to`). Where it is
not (`Robot.go_to` halts there), what is in the way has a frontier itself, and that is taken to be the
nearest.

The robot needs no terrain, and ends when no frontier is left. It acquires an obstacle in each round.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point, distance
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.sensing.decision import NEXT, Candidate, Decision
from exactacq.sensing.event import EventKind
from exactacq.strategies.known_map import KnownPart
from exactacq.strategies.moves import HaltKind, hand_along
from exactacq.visibility.shortest_path import ShortestPath

if TYPE_CHECKING:
    from exactacq.strategies.robot import Robot

PARTS = 8
"""Places on an edge where the robot may stop once an obstacle is acquired."""
NEAREST, STRAIGHT = "to the nearest frontier by path", ", the last one as the crow flies"
"""Why the robot goes to a frontier; what is told of one whose path need not be looked for."""


def nearest_frontier(robot: Robot) -> None:
    """Acquire all obstacles that come into sight, each from its frontier that is nearest at the time.

    Of frontiers equally near the first one of `Robot.frontier` is taken. The run tells the paths that were
    compared, and of the next obstacle, to which none was looked for, the straight distance.

    Numbers that are found from numbers that are found from numbers grow longer. So the robot aims at a place
    beside a frontier that has short ones (`KnownMap.beside`), and walks to the frontier from there; and
    before it leaves a boundary that is wholly known, it goes on to the nearest of `PARTS` places on the edge
    where it is.

    >>> import exactacq as xa
    >>> run = xa.explore(xa.load("squares"), "nearest-frontier")
    >>> print(run.length, run.map.acquired)
    sqrt(5) + 9 (0, 1)
    >>> print(run.events[0].why())
    to the nearest frontier by path (obstacle 0: 2.236)
    """
    while robot.frontier:
        here, (obstacle, way, why) = robot.position, _nearest(robot)
        _follow(robot, way, obstacle, why)
        _acquire(robot, why if robot.position == here else "")
        _rest(robot)


def _nearest(robot: Robot) -> tuple[int, ShortestPath, Decision]:
    """The obstacle of the nearest frontier, the way there, and why; found while it may be shortest."""
    known = robot.map
    places = [(obstacle, known.beside(obstacle, end)) for obstacle, end in known.frontier]
    ends = [(_away(robot.position, end), obstacle, end) for obstacle, end in places]
    best: tuple[int, ShortestPath] | None = None
    ends.sort(key=lambda found: found[0])
    lengths: dict[int, Length] = {}
    for _, obstacle, end in ends:
        if best is not None and best[1].length <= Length(distance(robot.position, end)):
            break
        way = robot.path_to(end)
        if obstacle not in lengths or way.length < lengths[obstacle]:
            lengths[obstacle] = way.length
        if best is None or way.length < best[1].length:
            best = obstacle, way
    assert best is not None, "there is a frontier"
    beyond = next(((k, end) for _, k, end in ends if k not in lengths), None)
    straight = None if beyond is None else Candidate(beyond[0], Length(distance(robot.position, beyond[1])))
    return *best, _why(best[0], lengths, straight)


def _why(chosen: int, lengths: dict[int, Length], straight: Candidate | None) -> Decision:
    """The decision for a frontier, by the lengths of paths, and the next one's straight distance if any."""
    paths = sorted(
        (Candidate(*found) for found in lengths.items()), key=lambda other: float(other.length or 0)
    )
    others = [other for other in paths if other.obstacle != chosen]
    told = tuple(others[:NEXT]) + (() if straight is None else (straight,))
    because = NEAREST if straight is None else NEAREST + STRAIGHT
    return Decision(because, chosen, lengths[chosen], told, more=len(others[NEXT:]))


def _away(here: Point, place: Point) -> Real:
    """The square of a distance: simpler than the distance."""
    return (place - here).norm_sq()


def _follow(robot: Robot, way: ShortestPath, obstacle: int, why: Decision) -> None:
    """Go along a path while nothing is in the way and the obstacle is not wholly known."""
    if not way.path:
        # A robot that starts on a boundary is not at it before its first move.
        robot.go_to(robot.position)
    for k, piece in enumerate(way.path):
        reason = "" if k else why
        if isinstance(piece, Arc):
            hand = hand_along(way, piece)
            if robot.walk(hand, to=piece.end, reason=reason).kind is HaltKind.ROUND:
                # The lap by which the obstacle was acquired is over on the way.
                robot.walk(hand, to=piece.end)
        elif robot.go_to(piece.end, reason=reason).kind is HaltKind.HIT:
            return
        if obstacle not in robot.map.incomplete:
            return


def _acquire(robot: Robot, why: Decision | str) -> None:
    """Walk along the boundary where the robot is, if that is not known yet, until it is."""
    at = robot.at
    if at is None or at not in robot.map.incomplete:
        return
    left, right = _known_beside(robot.map.known(at), robot.position)
    hand = "left" if left <= right else "right"
    while at in robot.map.incomplete:
        robot.walk(hand, until=EventKind.ACQUIRE, reason=why)
        why = ""


def _known_beside(parts: Sequence[KnownPart], here: Point) -> tuple[Length, Length]:
    """How far known boundary goes on from a place to either end, with the left and the right hand."""
    for k, part in enumerate(parts):
        curve = part.curve
        if curve is None or not curve.passes(here):
            continue
        ahead = Length(0) if here == part.end else curve.part(here, part.end).length
        behind = Length(0) if here == part.start else curve.part(part.start, here).length
        others = [*parts[k + 1 :], *parts[:k]]
        return ahead + _joined(part, others, 1), behind + _joined(part, others[::-1], -1)
    return Length(0), Length(0)


def _joined(part: KnownPart, others: Sequence[KnownPart], sense: int) -> Length:
    """The length of those of the following parts, in the order of a walk, that go on where one ends."""
    lengths = []
    for other in others:
        end, start = (part.end, other.start) if sense > 0 else (part.start, other.end)
        if end != start:
            break
        lengths.append(other.length)
        part = other
    return Length.sum(lengths)


def _rest(robot: Robot) -> None:
    """Go on to a near place with short numbers on the same edge, if the robot knows all of the boundary."""
    here, at = robot.position, robot.at
    if here.rational is not None or at not in robot.map.acquired:
        return
    assert at is not None, "what is acquired is an obstacle"
    curves = [part.curve for part in robot.map.known(at) if part.curve is not None]
    near = [curve for curve in curves if curve.may_pass(here, 64)]
    # All of the boundary is known, and the robot is on it: one that is left alone needs no proof.
    for curve in near if len(near) == 1 else (curve for curve in near if curve.passes(here)):
        places = [curve.point(Real(k) / PARTS) for k in range(PARTS + 1)]
        robot.walk_to(min(places, key=lambda place: _away(here, place)))
        return
