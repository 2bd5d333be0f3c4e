"""The Sightseer Strategy (paper, section 3): visit the nearest visible unvisited obstacle, circle it,
backtrack by a depth-first stack."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cmp_to_key

from exactacq.errors import InvalidScene
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.scene.scene import Scene
from exactacq.scene.validation import sensor_flaws
from exactacq.strategies.bounds import sightseer_bounds
from exactacq.strategies.gc_pause import uncollected
from exactacq.strategies.run import Run, TreeLink
from exactacq.strategies.sightseer.robot import Scout
from exactacq.visibility.links import START, Link, Node, lexicographic

Progress = Callable[[int, int], None]
"""Called with the number of obstacles visited so far and the number in the scene."""


def sightseer(
    scene: Scene,
    radius: object = None,
    *,
    start: Point | Sequence[object] | None = None,
    progress: Progress | None = None,
) -> Run:
    """Explore a scene by the Sightseer Strategy.

    *radius* and *start* default to the scene's own; both must be rational. Raises `InvalidScene` if there is
    none, if the radius is not positive, if the start is not free, or if an obstacle meets the terrain's
    border.
    Never fails for lack of visibility: what could not be reached is reported in the run. Cost: near
    linear in the number of obstacles at constant density and radius.
    """
    place = scene.start if start is None else Point.of(start)
    if place is None or place.rational is None:
        raise InvalidScene(["a start point with rational coordinates must be given"])
    if flaws := list(sensor_flaws(place, None)):
        raise InvalidScene(flaws)
    border = scene.meets_border()
    if border:
        rule = "meets the terrain's border: the Sightseer needs its obstacles inside"
        raise InvalidScene([f"obstacle {k} {rule}" for k in border])
    try:
        robot = Scout(scene, scene.radius if radius is None else radius, place)
    except ValueError as error:
        raise InvalidScene([str(error)]) from None
    return explored_by(robot, scene, progress)


@uncollected()
def explored_by(robot: Scout, scene: Scene, progress: Progress | None = None) -> Run:
    """Explore a scene by the strategy with a robot at its start, which may have another rule of choice."""
    return _Sightseer(robot, progress, len(scene.obstacles)).run(scene)


class _Sightseer:
    def __init__(self, robot: Scout, progress: Progress | None, total: int) -> None:
        self.robot, self.progress, self.total = robot, progress, total
        self.stack: list[tuple[Node, Point, Point]] = []
        self.tree: dict[int, TreeLink] = {}
        self.depth = 0

    def run(self, scene: Scene) -> Run:
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
        robot.mark("stop", robot.at if isinstance(robot.at, int) else None, self._reason())
        return self._finished(scene)

    def _advance(self, link: Link) -> None:
        robot = self.robot
        source = robot.at
        leave, hit = self._choose(link)
        if source != START:
            robot.walk_to(leave)
            robot.mark("leave", int(source), f"to {link.target}")
        self.stack.append((source, leave, hit))
        self.depth = max(self.depth, len(self.stack))
        robot.linear_navigate(link.target, hit)
        self.tree[link.target] = TreeLink(source, link.target, leave, hit, Length(link.length), 1)
        robot.mark("hit", link.target, f"from {source}")
        robot.circumnavigate()
        if self.progress is not None:
            self.progress(len(robot.visited), self.total)

    def _backtrack(self) -> None:
        robot = self.robot
        current = robot.at
        assert isinstance(current, int)
        previous, leave, hit = self.stack.pop()
        robot.walk_to(hit)
        robot.mark("leave", current, f"back to {previous}")
        robot.linear_navigate(previous, leave)
        self.tree[current] = replace(self.tree[current], traversals=2)
        robot.mark("backtrack", previous if isinstance(previous, int) else None, f"from {current}")

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

    def _reason(self) -> str:
        robot = self.robot
        if len(robot.visited) == self.total:
            return "every obstacle is visited"
        if robot.at == START:
            return "back at the start, nothing unvisited in sight"
        return "no unvisited obstacle on the map"

    def _finished(self, scene: Scene) -> Run:
        robot = self.robot
        path, events, record = robot.trace()
        links = tuple(self.tree.values())
        unvisited, unseen = robot.unvisited()
        length = path.length_after(len(path))
        radius = robot.radius
        bounds = sightseer_bounds(scene, radius, length, links, robot.visited)
        return Run(
            scene,
            radius,
            "sightseer",
            robot.start,
            path,
            tuple(robot.visited),
            links,
            events,
            bounds,
            tuple(unseen),
            tuple(unvisited),
            self.depth,
            record,
        )
