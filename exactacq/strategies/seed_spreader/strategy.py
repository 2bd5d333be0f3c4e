"""The Seed Spreader Strategy (paper, section 4) on a scene: its rules on a robot, and the run they make."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from exactacq.errors import Undecided
from exactacq.gc_pause import uncollected
from exactacq.progress import Meter, Progress
from exactacq.scene.bounding import rectangular_room
from exactacq.scene.scene import Scene, as_scene
from exactacq.sensing.event import Ending, Event, EventKind
from exactacq.sensing.path import Path
from exactacq.strategies.bounds import with_late_bounds
from exactacq.strategies.options import TargetChoice
from exactacq.strategies.robot import Robot
from exactacq.strategies.run import Diversion, SeedSpreaderRun
from exactacq.strategies.seed_spreader.mline import MLine
from exactacq.strategies.seed_spreader.rules import Spreader, Stuck


@uncollected()
def seed_spreader(
    scene: Scene,
    radius: object = None,
    *,
    lookahead: bool = True,
    target: str = "known",
    progress: Progress | None = None,
) -> SeedSpreaderRun:
    """Explore the terrain of a scene by the Seed Spreader Strategy (paper, section 4), from its SW corner.

    The robot follows the M-line, a path from south to north and back along strips, walks around obstacles
    that block it, and makes a diversion to an obstacle that it is about to lose from sight. *radius*, up to
    which it sees, defaults to the scene's own and is rational. With *lookahead* an obstacle is about to be
    lost where, by the map, it cannot be seen again from the rest of the line; without, as soon as it goes out
    of sight or out of reach. A diversion leads to the nearest known point of the obstacle, with *target*
    "visible" to the nearest visible one. *progress* is called with the number of steps done, and of all: a
    step is a straight piece of the M-line that is behind the robot, or a boundary edge that it circled.

    An enclosure that is the terrain's rectangle counts as its border; without a terrain, a rectangular one is
    it. Numbers of obstacles in the run mean components that the terrain cuts out of obstacles
    (`Run.obstacles`).
    Raises `InvalidScene` if there is no terrain, no radius or an enclosure, if the start is another point
    than the SW corner, if that is not free, or if an obstacle lies outside the terrain; `FormatError` for a
    radius that is no number or another target, `Undecided` for a comparison beyond the library's limits.
    Cost: a tenth to a fifth of a second an obstacle at constant density and radius.

    >>> import exactacq as xa
    >>> discs = [xa.Circle((3, 4), 1), xa.Circle((6, 6), 1)]
    >>> run = seed_spreader(xa.Scene(discs, terrain=xa.Terrain(8, 8)), radius=3)
    >>> print(run.length, run.visits)
    6*pi + 36 (0, 1)
    """
    choice = TargetChoice(target)
    room = rectangular_room(as_scene(scene))
    if room is not None and scene.terrain in (None, room):
        scene = scene.replace(terrain=room, enclosure=None)
    robot = Robot(scene, radius=radius, confined=True)
    return _explored(robot, scene, lookahead, choice, progress)


def _explored(
    robot: Robot, scene: Scene, lookahead: bool, target: TargetChoice, progress: Progress | None
) -> SeedSpreaderRun:
    """The run of a robot at its start; where it is undecided, `Undecided` with the run so far."""
    assert robot.terrain is not None and robot._ground is not None, "a confined robot knows its terrain"
    mline = MLine(robot.terrain, robot.radius)
    edges = sum(len(component.edges) for component in robot._ground.components)
    meter = Meter(progress, len(mline.pieces) + edges)
    # The rules tell where the robot hits and leaves obstacles, and why.
    robot._on_edge, robot._writes = meter.add, False
    trace = robot._trace

    def tell(kind: EventKind, obstacle: int, **why: Any) -> None:
        trace.mark(kind, robot._numbers[obstacle], **why)

    spreader = Spreader(robot, mline, lookahead, target, tell, meter.add)
    try:
        try:
            spreader.explore()
            trace.mark(EventKind.STOP, None, ending=Ending.END_OF_M_LINE)
        except Stuck as stuck:
            trace.mark(EventKind.STOP, robot._numbers[stuck.obstacle], ending=stuck.ending)
        meter.close()
    except Undecided as error:
        first = trace.give_up(error)
        raise Undecided(first.comparison, _finished(spreader, scene)) from error
    return with_late_bounds(_finished(spreader, scene), robot._table)


def _finished(spreader: Spreader, scene: Scene) -> SeedSpreaderRun:
    robot = spreader.robot
    ground, numbers = robot._ground, robot._numbers
    assert ground is not None, "the robot is confined to a ground"
    path, record = Path(robot._walker.pieces), robot._walker.memory
    events = robot._trace.events(path)
    every, chart = range(len(ground.components)), record.now
    seen, incomplete = set(chart.seen), set(chart.incomplete)
    return SeedSpreaderRun(
        scene=scene,
        radius=robot.radius,
        start=robot.start,
        path=path,
        visits=tuple(robot._walker.visited),
        events=events,
        bounds=(),
        unseen=tuple(k for k in every if k not in seen),
        unvisited=tuple(k for k in every if k in incomplete),
        record=record,
        lookahead=spreader.lookahead,
        target=str(spreader.target),
        diversions=tuple(_diversions(spreader, events)),
        encounters=tuple(numbers[k] for k in spreader.encounters),
        again=tuple(numbers[k] for k in spreader.again),
        unreached=tuple(sorted({c.obstacle.index for c in ground.unreached})),
    )


def _diversions(spreader: Spreader, events: Sequence[Event]) -> Iterator[Diversion]:
    """The diversions that were made, between the events that tell when each began and ended."""
    first, last = (
        [event.after for event in events if event.kind is kind]
        for kind in (EventKind.DIVERT, EventKind.RETURN)
    )
    # The last one that began may not have ended.
    for made, begin, end in zip(spreader.diversions, first, last, strict=False):
        obstacle = spreader.robot._numbers[made.loss.obstacle]
        yield Diversion(obstacle, made.leave, made.hit, made.loss.reason, begin, end)
