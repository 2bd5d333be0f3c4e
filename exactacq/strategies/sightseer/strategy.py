"""The Sightseer Strategy (paper, section 3) on a scene: its rules on a robot, and the run that they make."""

from __future__ import annotations

from collections.abc import Sequence

from exactacq.errors import Undecided
from exactacq.gc_pause import uncollected
from exactacq.geometry.points import Point
from exactacq.progress import Meter, Progress
from exactacq.scene.scene import Scene
from exactacq.sensing.event import Ending, EventKind
from exactacq.strategies.bounds import with_bounds
from exactacq.strategies.robot import Robot
from exactacq.strategies.run import SightseerRun, TreeLink
from exactacq.strategies.sightseer.rules import Tour


def sightseer(
    scene: Scene,
    radius: object = None,
    *,
    start: Point | Sequence[object] | None = None,
    progress: Progress | None = None,
) -> SightseerRun:
    """Explore a scene by the Sightseer Strategy (paper, section 3).

    The robot goes to the nearest obstacle that it sees, walks around it, goes on to the nearest unvisited one
    in sight of its boundary, and backtracks where there is none. *radius*, up to which it sees, and *start*
    default to the scene's own; both are rational. *progress* is called with the number of boundary edges
    circled so far and the number in the scene, at the end with that number twice.

    Raises `InvalidScene` if radius or start is missing or illegal, or if an obstacle meets the terrain's
    border, `FormatError` if they are no number and no point, and `Undecided` if an exact comparison is beyond
    the library's limits. Obstacles that are never seen or never reached are no error: the run lists them.
    Cost: near linear in the number of obstacles at constant density and radius, about a tenth of a second an
    obstacle.

    >>> import exactacq as xa
    >>> run = sightseer(xa.load("circles"))
    >>> print(run.length, run.visits)
    5 + 12*pi (0, 1)
    """
    return explored_by(Robot(scene, start, radius), scene, progress)


@uncollected()
def explored_by(robot: Robot, scene: Scene, progress: Progress | None = None) -> SightseerRun:
    """Explore a scene by the strategy with a robot at its start, which may have another rule of choice.

    Where it is undecided, `Undecided` with the run so far.
    """
    meter = Meter(progress, sum(len(obstacle.edges) for obstacle in scene.obstacles))
    robot._on_edge = meter.add
    tour = Tour(robot)
    try:
        tour.explore()
    except Undecided as error:
        robot._walker.give_up()
        raise Undecided(error.comparison, _finished(tour, scene)) from error
    walker = robot._walker
    at = walker.at if isinstance(walker.at, int) else None
    walker.mark(EventKind.STOP, at, ending=_ending(robot, scene))
    meter.close()
    return with_bounds(_finished(tour, scene))


def _ending(robot: Robot, scene: Scene) -> Ending:
    if len(robot.visited) == len(scene.obstacles):
        return Ending.ALL_VISITED
    return Ending.BACK_AT_START if robot.at is None else Ending.NOTHING_UNVISITED


def _finished(tour: Tour, scene: Scene) -> SightseerRun:
    robot = tour.robot
    path, events, record = robot._walker.trace()
    visits = tuple(robot._walker.visited)
    left = [k for k in range(len(scene.obstacles)) if k not in robot._walker.visited]
    return SightseerRun(
        scene=scene,
        radius=robot.radius,
        start=robot.start,
        path=path,
        visits=visits,
        events=events,
        bounds=(),
        unseen=tuple(k for k in left if k not in record.seen),
        unvisited=tuple(k for k in left if k in record.seen),
        record=record,
        links=tuple(
            TreeLink(
                robot._scene_node(way.source),
                robot._numbers[way.target],
                way.leave,
                way.hit,
                way.length,
                2 if way.target in tour.walked_back else 1,
            )
            for way in tour.ways
        ),
        stack_depth=tour.depth,
    )
