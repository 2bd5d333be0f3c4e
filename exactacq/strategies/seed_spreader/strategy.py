"""The Seed Spreader Strategy (paper, section 4): sweep along the M-line, divert at the last moment."""

from __future__ import annotations

from functools import cmp_to_key

from exactacq.errors import InvalidScene, Undecided
from exactacq.geometry.points import Point, distance_sq
from exactacq.progress import Meter, Progress
from exactacq.scene.bounding import rectangular_room
from exactacq.scene.scene import Scene, radius_of
from exactacq.scene.terrain_components import Ground, ground_of
from exactacq.scene.validation import place_text
from exactacq.sensing.event import Ending, EventKind, Occasion
from exactacq.strategies.bounds import with_bounds
from exactacq.strategies.gc_pause import uncollected
from exactacq.strategies.options import TargetChoice
from exactacq.strategies.run import Diversion, SeedSpreaderRun
from exactacq.strategies.seed_spreader.losses import Line, Loss, known
from exactacq.strategies.seed_spreader.range_thresholds import nearest_of, nearest_point
from exactacq.strategies.seed_spreader.robot import Hit, SeedSpreaderRobot


class _Stuck(Exception):
    """The strategy ends before T: an obstacle leaves no way on."""

    def __init__(self, ending: Ending, obstacle: int) -> None:
        self.ending, self.obstacle = ending, obstacle


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
    room = rectangular_room(scene)
    if room is not None and scene.terrain in (None, room):
        scene = scene.replace(terrain=room, enclosure=None)
    ground = ground_of(scene)
    corner = ground.terrain.south_west
    reach = radius_of(scene, radius, corner)
    if scene.start is not None and scene.start != corner:
        raise InvalidScene(
            [f"the start {place_text(scene.start)} is not the terrain's SW corner {place_text(corner)}"]
        )
    robot = SeedSpreaderRobot(scene, ground, reach)
    edges = sum(len(component.edges) for component in ground.components)
    meter = Meter(progress, len(robot.mline.pieces) + edges)
    return _Spreader(robot, lookahead, choice, meter).run(scene, ground)


class _Spreader:
    def __init__(self, robot: SeedSpreaderRobot, lookahead: bool, target: TargetChoice, meter: Meter) -> None:
        self.robot, self.lookahead, self.target, self.meter = robot, lookahead, target, meter
        self.diversions: list[Diversion] = []
        self.encounters: list[int] = []
        self.again: list[int] = []
        self.line: Line | None = None

    def run(self, scene: Scene, ground: Ground) -> SeedSpreaderRun:
        """The run; where it is undecided, `Undecided` with the run so far."""
        try:
            self._explore()
        except Undecided as error:
            self.robot.give_up()
            raise Undecided(error.comparison, self._finished(scene, ground)) from error
        return with_bounds(self._finished(scene, ground))

    def _explore(self) -> None:
        """Steps 0 to 3 of the paper; comments give their numbers."""
        robot = self.robot
        try:
            while True:
                before = robot.piece
                self._follow()
                self.meter.add(robot.piece + 1 - before)
                if not robot.turn():
                    break
            robot.mark(EventKind.STOP, None, ending=Ending.END_OF_M_LINE)  # 1(a)
        except _Stuck as stuck:
            robot.mark(EventKind.STOP, stuck.obstacle, ending=stuck.ending)
        self.meter.close()

    # -- step 1: along the M-line ------------------------------------------------------------------

    def _follow(self) -> None:
        """Follow the straight pieces of the M-line to the end of the one the robot is on or comes to."""
        robot = self.robot
        piece = -1
        while True:
            if robot.piece != piece:
                piece = robot.piece
                number = robot.mline.line(piece)
                self.line = Line(robot, self.lookahead) if number else None
            hit = robot.follow(None if self.line is None else self.line.watch)
            if hit is not None:
                self._meet(hit)  # 1(b), 1(c)
            elif self.line is not None and self.line.losses:
                self._divert(self.line.losses)  # 1(d)
                self.line.losses = []
            elif not self._diverts_at_end():
                return

    def _diverts_at_end(self) -> bool:
        losses = [] if self.line is None else self.line.at_end()
        if losses:
            self._divert(losses)
        return bool(losses)

    def _meet(self, hit: Hit) -> None:
        """Walk around an obstacle that blocks the M-line (step 2), or that is known, to where it goes on."""
        robot = self.robot
        met = robot.is_acquired(hit.obstacle)
        robot.mark(EventKind.CROSS if met else EventKind.HIT, hit.obstacle, occasion=Occasion.M_LINE)
        self.encounters.append(hit.obstacle)
        if met:
            self.again.append(hit.obstacle)
        else:
            robot.circumnavigate(self.meter.add)
        crossing = robot.leave_point(hit)
        if crossing is None:
            raise _Stuck(Ending.TRAPPED, hit.obstacle)
        here = robot.position
        if self.line is not None and hit.crossing is not None and here == hit.crossing.stop.point:
            leave = crossing.stop.point if crossing.piece == robot.piece else None
            while losses := self.line.before_hop(leave):
                self._divert(losses)
        robot.at = hit.obstacle
        robot.walk_to(crossing.stop.point)
        robot.mark(EventKind.LEAVE, hit.obstacle, occasion=Occasion.M_LINE)
        robot.resume(crossing)

    # -- step 3: diversions ------------------------------------------------------------------------

    def _divert(self, losses: list[Loss]) -> None:
        """Acquire the nearest obstacle that is about to be lost, and come back."""
        robot = self.robot
        leave = robot.position
        aims = [(self._aim(loss), loss) for loss in losses]

        def order(a: tuple[Point, Loss], b: tuple[Point, Loss]) -> int:
            nearer = distance_sq(a[0], leave).compare(distance_sq(b[0], leave))
            return nearer or a[1].obstacle - b[1].obstacle

        aim, loss = min(aims, key=cmp_to_key(order))
        robot.mark(EventKind.DIVERT, loss.obstacle, reason=loss.reason)
        first = robot.count
        robot.head_for(aim)
        self._approach(loss.obstacle)
        aim = robot.position
        robot.circumnavigate(self.meter.add)
        robot.walk_to(aim)
        robot.mark(EventKind.LEAVE, loss.obstacle, occasion=Occasion.DIVERSION)
        robot.head_back()
        self._approach(None)
        robot.mark(EventKind.RETURN, loss.obstacle, reason=loss.reason)
        self.diversions.append(Diversion(loss.obstacle, leave, aim, loss.reason, first, robot.count))

    def _aim(self, loss: Loss) -> Point:
        """The known, or visible, point of an obstacle nearest to the robot."""
        robot = self.robot
        curves = robot.visible(loss.obstacle) if self.target is TargetChoice.VISIBLE else []
        curves = curves or known(robot.map, loss.obstacle)
        return nearest_of([nearest_point(curve, robot.position) for curve in curves], robot.position)

    def _approach(self, obstacle: int | None) -> None:
        """Go the straight way, around what is in the way; or to the first hit of the aimed *obstacle*."""
        robot = self.robot
        occasion = Occasion.WAY_BACK if obstacle is None else Occasion.WAY_OUT
        while (hit := robot.go()) is not None:
            k = hit.obstacle
            robot.mark(EventKind.HIT, k, occasion=occasion)
            if obstacle is not None:
                self.encounters.append(k)
            is_known = robot.is_acquired(k)
            if k == obstacle and not is_known:
                return
            if not is_known:
                robot.circumnavigate(self.meter.add)
            crossing = robot.pass_by(k)
            if crossing is None:
                raise _Stuck(Ending.WAY_CLOSED, k)
            robot.walk_to(crossing)
            robot.mark(EventKind.LEAVE, k, occasion=occasion)
        if obstacle is not None:
            self.encounters.append(obstacle)
            robot.at = obstacle
            robot.mark(EventKind.HIT, obstacle, occasion=Occasion.DIVERSION)

    def _finished(self, scene: Scene, ground: Ground) -> SeedSpreaderRun:
        robot = self.robot
        path, events, record = robot.trace()
        every, seen, incomplete = (
            range(len(ground.components)),
            set(robot.map.seen),
            set(robot.map.incomplete),
        )
        return SeedSpreaderRun(
            scene=scene,
            radius=robot.radius,
            start=robot.start,
            path=path,
            visits=tuple(robot.visited),
            events=events,
            bounds=(),
            unseen=tuple(k for k in every if k not in seen),
            unvisited=tuple(k for k in every if k in incomplete),
            record=record,
            lookahead=self.lookahead,
            target=str(self.target),
            diversions=tuple(self.diversions),
            encounters=tuple(self.encounters),
            again=tuple(self.again),
            unreached=tuple(sorted({c.obstacle.index for c in ground.unreached})),
        )
