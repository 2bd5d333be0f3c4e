"""Exploring a scene by any strategy: one of the paper's by its name, or one of the user's own."""

from __future__ import annotations

from collections.abc import Sequence
from inspect import isasyncgen, isawaitable, iscoroutine, isgenerator, signature

from exactacq.errors import FormatError, InvalidScene, MoveError, StrategyError, Undecided, shown
from exactacq.gc_pause import uncollected
from exactacq.geometry.points import Point
from exactacq.progress import Meter, Progress
from exactacq.scene.scene import Scene
from exactacq.sensing.event import Ending, EventKind
from exactacq.sensing.memory import Report
from exactacq.sensing.path import Path
from exactacq.strategies.bounds import own_bounds
from exactacq.strategies.moves import EnoughMoves
from exactacq.strategies.options import MOST_MOVES, Strategy
from exactacq.strategies.registry import OwnStrategy, Rules, names, of_function, registered
from exactacq.strategies.robot import Robot
from exactacq.strategies.run import OwnRun, Run, bounded
from exactacq.strategies.seed_spreader.strategy import seed_spreader
from exactacq.strategies.sightseer.strategy import sightseer


def explore(
    scene: Scene,
    strategy: str | Rules = Strategy.SIGHTSEER,
    radius: object = None,
    *,
    start: Point | Sequence[object] | None = None,
    max_moves: int = MOST_MOVES,
    progress: Progress | None = None,
) -> Run:
    """Explore a scene by a strategy: "sightseer", "seed-spreader", or one of one's own.

    The latter is the name of one that `exactacq.strategy` has registered, or a function: it is called with a
    `Robot` at the start, and the run, an `OwnRun`, ends when it returns. If it calls more than *max_moves* of
    the robot's moves, the run ends where it is, with `Ending.MOST_MOVES`; questions are not counted, so one
    that asks for ever and does not move is not ended. If it is registered as confined, the robot is confined
    to the scene's terrain, and *start*, if given, is the SW corner of that. *radius* and *start* default to
    the scene's own. *progress* is told how many edges of obstacles that are wholly known there are, and how
    many in all; of the paper's strategies it is told what they say, and *max_moves* is nothing to them.

    Raises `StrategyError` for a name that is not known and for what cannot be called with a robot, what
    `Robot` and the paper's strategies raise, `FormatError` if *max_moves* is no positive integer, `Undecided`
    with the run so far for a comparison beyond the library's limits, and whatever the strategy raises.

    >>> import exactacq as xa
    >>> def touch(robot):
    ...     robot.go_to(robot.map.nearest(0, robot.position))
    >>> xa.explore(xa.load("circles"), touch)
    <OwnRun touch on circles, R = 20, length 3, 0 of 2 obstacles visited>
    """
    if isinstance(max_moves, bool) or not isinstance(max_moves, int) or max_moves < 1:
        raise FormatError(f"max_moves: a positive integer, not {shown(max_moves)}")
    if strategy == Strategy.SIGHTSEER:
        return sightseer(scene, radius, start=start, progress=progress)
    if strategy == Strategy.SEED_SPREADER:
        placed = scene if start is None else scene.replace(start=start)
        return seed_spreader(placed, radius, progress=progress)
    own = registered(strategy) if isinstance(strategy, str) else None
    if own is None:
        if not callable(strategy):
            raise StrategyError(f"no strategy {shown(strategy)}; there are {', '.join(names())}")
        own = of_function(strategy)
    _check_call(own)
    if own.confined and scene.terrain is None:
        raise InvalidScene([f"{own.name} needs a terrain: a rectangle with width and height"])
    robot = Robot(scene, start, radius, confined=own.confined)
    return _explored(own, robot, scene, max_moves, progress)


def _check_call(own: OwnStrategy) -> None:
    """`StrategyError` if rules cannot be called with a robot alone, as far as they tell what they take."""
    try:
        taken = signature(own.rules)
    except (TypeError, ValueError):
        return
    try:
        taken.bind(None)
    except TypeError as error:
        text = f"the strategy {own.name} cannot be called with a robot and nothing else: {error}"
        raise StrategyError(text) from None


@uncollected()
def _explored(own: OwnStrategy, robot: Robot, scene: Scene, most: int, progress: Progress | None) -> OwnRun:
    edges = [len(body.edges) for body in robot._walker.bodies]
    meter = Meter(progress, sum(edges))

    def heard(report: Report) -> None:
        if report.kind is EventKind.ACQUIRE:
            meter.add(edges[report.obstacle])

    robot._seen.hear, robot._most = heard, most
    ending, walker = Ending.FINISHED, robot._walker
    try:
        answer = own.rules(robot)
        if isgenerator(answer) or isawaitable(answer) or isasyncgen(answer):
            if iscoroutine(answer):
                answer.close()
            raise StrategyError(f"the strategy {own.name} has not run: it is called, not iterated or awaited")
        if walker.stuck is not None:
            # The strategy went on without moving: what it has learned is not all that its path shows.
            raise walker.stuck
        walker.sense()
    except EnoughMoves:
        ending = Ending.MOST_MOVES
    except Undecided as error:
        first = robot._trace.give_up(error)
        raise Undecided(first.comparison, _finished(own, robot, scene)) from error
    finally:
        walker.stuck = MoveError("the run of this robot is over")
    robot._trace.mark(EventKind.STOP, walker.at if isinstance(walker.at, int) else None, ending=ending)
    meter.close()
    run = _finished(own, robot, scene)
    return bounded(run, own_bounds(run, own))


def _finished(own: OwnStrategy, robot: Robot, scene: Scene) -> OwnRun:
    walker = robot._walker
    path, record = Path(walker.pieces), walker.memory
    # A lap leads all around: along a boundary that the border cuts there is none.
    rounds = (k for k in walker.visited if record.bodies[k].closed)
    return OwnRun(
        scene=scene,
        radius=robot.radius,
        start=robot.start,
        path=path,
        visits=tuple(rounds),
        events=robot._trace.events(path),
        bounds=(),
        unseen=tuple(k for k in range(len(record.bodies)) if k not in record.seen),
        unvisited=tuple(sorted(record.incomplete)),
        record=record,
        name=own.name,
        confined=own.confined,
    )
