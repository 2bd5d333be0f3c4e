"""The Sightseer Strategy (paper, section 3) on a scene: its rules on a robot, and the run that they make."""

from __future__ import annotations

from collections.abc import Sequence

from exactacq.errors import Undecided
from exactacq.gc_pause import uncollected
from exactacq.geometry.points import Point
from exactacq.progress import Meter, Progress
from exactacq.scene.scene import Scene
from exactacq.sensing.event import Ending, Event, EventKind
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Path
from exactacq.strategies.bounds import with_late_bounds
from exactacq.strategies.late_entry import later
from exactacq.strategies.moves import Way
from exactacq.strategies.robot import Robot
from exactacq.strategies.run import SightseerRun, TreeLink
from exactacq.strategies.sightseer.rules import Tour
from exactacq.visibility.links import START


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

    The links between obstacles tell the way. What the robot sees on it is found out when it is first asked
    for, as events and maps are, or by `Run.sense`; at once only if some obstacle is left unvisited.

    Raises `InvalidScene` if radius or start is missing or illegal, or if an obstacle meets the terrain's
    border, `FormatError` if they are no number and no point, and `Undecided` if an exact comparison is beyond
    the library's limits; one that only what is seen depends on raises it there. Obstacles that are never seen
    or never reached are no error: the run lists them. Cost: near linear in the number of obstacles at
    constant density and radius; a few milliseconds an obstacle, and what is seen some twenty.

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
    robot._on_edge, robot._senses_late = meter.add, True
    tour, walker, ending = Tour(robot), robot._walker, Ending.ALL_VISITED
    try:
        tour.explore()
        if len(walker.visited) < len(scene.obstacles):
            # What was seen of the others, the run tells.
            walker.sense()
            ending = Ending.BACK_AT_START if walker.at == START else Ending.NOTHING_UNVISITED
    except Undecided as error:
        raise _given_up(tour, scene, error) from error
    robot._trace.mark(EventKind.STOP, walker.at if isinstance(walker.at, int) else None, ending=ending)
    meter.close()
    return with_late_bounds(_finished(tour, scene, is_sensed=False), robot._table)


def _given_up(tour: Tour, scene: Scene, error: Undecided) -> Undecided:
    """The error that came first on the way, with the run up to there."""
    first = tour.robot._trace.give_up(error)
    return Undecided(first.comparison, _finished(tour, scene, is_sensed=True))


def _finished(tour: Tour, scene: Scene, is_sensed: bool) -> SightseerRun:
    """The run so far; if it is not to be sensed by now, what it saw is found out when somebody asks."""
    robot, walker, trace = tour.robot, tour.robot._walker, tour.robot._trace
    path, visits = Path(walker.pieces), tuple(walker.visited)
    left = [k for k in range(len(scene.obstacles)) if k not in walker.visited]
    seen = walker.memory.seen if left else set()
    # Where it was given up the tour may have gone on.
    there, back = trace.count(EventKind.HIT), set(tour.back[: trace.count(EventKind.BACKTRACK)])
    sensed = None if is_sensed else _Sensed(tour, scene, path)
    return SightseerRun(
        scene=scene,
        radius=robot.radius,
        start=robot.start,
        path=path,
        visits=visits,
        events=trace.events(path) if sensed is None else later(sensed.events),
        bounds=(),
        unseen=tuple(k for k in left if k not in seen),
        unvisited=tuple(k for k in left if k in seen),
        record=walker.memory if sensed is None else sensed,
        links=tuple(_tree_link(way, 2 if way in back else 1) for way in tour.ways[:there]),
        stack_depth=max(tour.depths[:there], default=0),
    )


def _tree_link(way: Way, traversals: int) -> TreeLink:
    link = way.link._link
    return TreeLink(link.source, link.target, way.leave, way.hit, way.length, traversals)


class _Sensed:
    """What the robot of a tour that is over has seen, found out when somebody asks.

    `Undecided` with the run up to there where a comparison is, each time.
    """

    def __init__(self, tour: Tour, scene: Scene, path: Path) -> None:
        self._tour, self._scene, self._path = tour, scene, path
        self._part: SightseerRun | None = None

    def __call__(self, progress: Progress | None = None) -> Memory:
        walker = self._tour.robot._walker
        if walker.undecided is None:
            try:
                walker.sense(progress)
            except Undecided as error:
                raise self._given_up(error) from error
        # Another thread may have found it so meanwhile.
        if walker.undecided is not None:
            raise self._given_up(walker.undecided)
        return walker.memory

    def _given_up(self, error: Undecided) -> Undecided:
        """A new error each time, that keeps no traceback; with one and the same run."""
        if self._part is None:
            self._part = _given_up(self._tour, self._scene, error).run
        return Undecided(error.comparison, self._part)

    def events(self) -> tuple[Event, ...]:
        """What happened, with what was seen."""
        self()
        return self._tour.robot._trace.events(self._path)
