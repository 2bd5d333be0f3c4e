"""The Sightseer Strategy (paper, section 3): visit the nearest visible unvisited obstacle, circle it,
backtrack by a depth-first stack."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cmp_to_key

from exactacq.errors import InvalidScene, Undecided
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.progress import Meter, Progress
from exactacq.scene.scene import Scene, radius_of, start_of
from exactacq.sensing.event import Ending, EventKind, Occasion
from exactacq.strategies.bounds import with_bounds
from exactacq.strategies.gc_pause import uncollected
from exactacq.strategies.run import SightseerRun, TreeLink
from exactacq.strategies.sightseer.robot import SightseerRobot
from exactacq.visibility.links import START, Link, Node, lexicographic


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
    place = start_of(scene, start)
    border = scene.meets_border()
    if border:
        rule = "meets the terrain's border: the Sightseer needs its obstacles inside"
        raise InvalidScene([f"obstacle {scene.obstacles[k].label} {rule}" for k in border])
    reach = radius_of(scene, radius, place)
    try:
        robot = SightseerRobot(scene, reach, place)
    except ValueError as error:
        raise InvalidScene([str(error)]) from None
    return explored_by(robot, scene, progress)


@uncollected()
def explored_by(robot: SightseerRobot, scene: Scene, progress: Progress | None = None) -> SightseerRun:
    """Explore a scene by the strategy with a robot at its start, which may have another rule of choice."""
    return _Sightseer(robot, progress, scene).run(scene)


class _Sightseer:
    def __init__(self, robot: SightseerRobot, progress: Progress | None, scene: Scene) -> None:
        self.robot, self.obstacles = robot, len(scene.obstacles)
        self.meter = Meter(progress, sum(len(obstacle.edges) for obstacle in scene.obstacles))
        self.stack: list[tuple[Node, Point, Point]] = []
        self.tree: dict[int, TreeLink] = {}
        self.depth = 0

    def run(self, scene: Scene) -> SightseerRun:
        """The run; where it is undecided, `Undecided` with the run so far."""
        try:
            self._explore()
        except Undecided as error:
            self.robot.give_up()
            raise Undecided(error.comparison, self._finished(scene)) from error
        return with_bounds(self._finished(scene))

    def _explore(self) -> None:
        """Steps 0 to 4 of the paper; comments give their numbers."""
        robot = self.robot
        while True:
            link = robot.nearest_unvisited(robot.at)  # 1
            if link is not None:
                self._advance(link)  # 3 and 4
            elif robot.at == START or not robot.knows_unvisited():
                break
            else:
                self._backtrack()  # 2
        at = robot.at if isinstance(robot.at, int) else None
        robot.mark(EventKind.STOP, at, ending=self._ending())
        self.meter.close()

    def _advance(self, link: Link) -> None:
        robot = self.robot
        source = robot.at
        leave, hit = self._choose(link)
        if source != START:
            robot.walk_to(leave)
            robot.mark(EventKind.LEAVE, int(source), occasion=Occasion.ADVANCE, other=link.target)
        self.stack.append((source, leave, hit))
        self.depth = max(self.depth, len(self.stack))
        robot.linear_navigate(link.target, hit)
        self.tree[link.target] = TreeLink(source, link.target, leave, hit, Length(link.length), 1)
        robot.mark(EventKind.HIT, link.target, occasion=Occasion.ADVANCE, other=source)
        robot.circumnavigate(self.meter.add)

    def _backtrack(self) -> None:
        robot = self.robot
        current = robot.at
        assert isinstance(current, int)
        previous, leave, hit = self.stack.pop()
        robot.walk_to(hit)
        robot.mark(EventKind.LEAVE, current, occasion=Occasion.BACKTRACK, other=previous)
        robot.linear_navigate(previous, leave)
        self.tree[current] = replace(self.tree[current], traversals=2)
        at = previous if isinstance(previous, int) else None
        robot.mark(EventKind.BACKTRACK, at, occasion=Occasion.BACKTRACK, other=current)

    def _choose(self, link: Link) -> tuple[Point, Point]:
        """The segment that the tie rule picks among the shortest: least walk, counterclockwise, L, H."""
        pairs = link.segments(self.robot.position)
        if self.robot.at == START:
            return min(pairs, key=cmp_to_key(lexicographic))
        if len(pairs) == 1:
            return pairs[0]
        ways = [(*self.robot.way_to(leave), leave, hit) for leave, hit in pairs]

        def order(a: tuple[Length, bool, Point, Point], b: tuple[Length, bool, Point, Point]) -> int:
            return a[0].compare(b[0]) or b[1] - a[1] or lexicographic(a[2:], b[2:])

        return min(ways, key=cmp_to_key(order))[2:]

    def _ending(self) -> Ending:
        robot = self.robot
        if len(robot.visited) == self.obstacles:
            return Ending.ALL_VISITED
        return Ending.BACK_AT_START if robot.at == START else Ending.NOTHING_UNVISITED

    def _finished(self, scene: Scene) -> SightseerRun:
        robot = self.robot
        path, events, record = robot.trace()
        unvisited, unseen = robot.unvisited()
        return SightseerRun(
            scene=scene,
            radius=robot.radius,
            start=robot.start,
            path=path,
            visits=tuple(robot.visited),
            events=events,
            bounds=(),
            unseen=tuple(unseen),
            unvisited=tuple(unvisited),
            record=record,
            links=tuple(self.tree.values()),
            stack_depth=self.depth,
        )
