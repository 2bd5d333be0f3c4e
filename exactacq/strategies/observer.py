"""What a robot tells: its place, its path, its map, what is in sight, and the links that it knows.

Obstacles have the robot's own numbers: 0 is the one that it saw first, so that numbers say nothing of
obstacles that it has not seen. Equal scenes give equal numbers.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from enum import Enum
from functools import cmp_to_key, partial
from itertools import pairwise
from math import inf
from typing import Final

from flint import fmpq

from exactacq.errors import InvalidScene, MoveError, deciding, shown
from exactacq.geometry.constructions import put_on_line
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point, distance_sq
from exactacq.numbers.length import Length
from exactacq.scene.edge_table import EdgeTable, Floats
from exactacq.scene.scene import Scene, radius_of, start_of
from exactacq.scene.shapes import Terrain
from exactacq.scene.terrain_components import Ground, ground_of
from exactacq.scene.validation import LIMIT, LIMIT_TEXT, place_text
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Path, Piece
from exactacq.strategies.first_hit import first_hit, obstacle_at
from exactacq.strategies.known_links import KnownLinks, NearestLink
from exactacq.strategies.known_map import KnownMap, KnownPart, Sighting, nearest_on
from exactacq.strategies.known_paths import KnownPaths
from exactacq.strategies.lap import Lap
from exactacq.strategies.moves import KnownLink
from exactacq.strategies.numbering import Numbering
from exactacq.strategies.routes import Exit, Route
from exactacq.strategies.seed_spreader.blocked import Blocking
from exactacq.strategies.sightings import Sightings
from exactacq.strategies.trace import Trace
from exactacq.strategies.walker import Walker
from exactacq.visibility.links import START, Link, Links, Node
from exactacq.visibility.scene_tables import point_flaws
from exactacq.visibility.shortest_path import ShortestPath


class Here(Enum):
    """The place where a robot is, for questions about one."""

    HERE = "here"


HERE: Final = Here.HERE


class Observer:
    """The part of a robot that answers questions: see `exactacq.Robot`."""

    def __init__(
        self,
        scene: Scene,
        start: Point | Sequence[object] | None = None,
        radius: object = None,
        *,
        confined: bool = False,
    ) -> None:
        ground = ground_of(scene) if confined else None
        place = start_of(scene, start) if ground is None else ground.terrain.south_west
        if ground is None and (border := scene.meets_border()):
            rule = "meets the terrain's border: only robots that are confined to it take such obstacles"
            raise InvalidScene([f"obstacle {scene.obstacles[k].label} {rule}" for k in border])
        reach = radius_of(scene, radius, place)
        if flaws := list(_start_flaws(scene, start, place, confined)):
            raise InvalidScene(flaws)
        links = None if confined else Links(scene, reach)
        table = EdgeTable(scene.obstacles) if links is None else links.table
        self._radius, self._table, self._ground, self._scene = reach, table, ground, scene
        self._blocking = Blocking(ground, table)
        self._links = None if links is None else KnownLinks(links, place)
        self._walker = Walker(place, partial(Memory, scene, reach, table, ground))
        self._trace = Trace(self._walker)
        numbering = Numbering(lambda: table.hulls if ground is None else _hulls(table, ground))
        self._seen = Sightings(self._walker, numbering)
        # The last answer of `nearest`: the point, on which piece of the boundary it lies, and whose it is.
        self._last_nearest: tuple[Point, Curve | None, int] | None = None
        self._lap: Lap | None = None
        self._paths = KnownPaths(self._walker, self._seen)
        self._moves, self._most = 0, inf
        self._is_underway = False
        # Whether its moves write into the trace where it hits and leaves obstacles.
        self._writes = True
        # Whether moves leave it to questions to sense the way.
        self._senses_late = False
        self._on_edge: Callable[[], None] = lambda: None

    def __repr__(self) -> str:
        at = "in free space" if self.at is None else f"at obstacle {self.at}"
        return f"<Robot {at}, after {float(self.length):.6g}: {len(self._numbers)} obstacles seen>"

    # -- questions ---------------------------------------------------------------------------------

    @property
    def radius(self) -> fmpq:
        """Up to how far the robot sees, the radius itself included."""
        return self._radius

    @property
    def terrain(self) -> Terrain | None:
        """The terrain whose border a robot that is confined to it keeps within and knows; else None."""
        return None if self._ground is None else self._ground.terrain

    @property
    def start(self) -> Point:
        """Where the path begins."""
        return self._walker.start

    @property
    def position(self) -> Point:
        """Where the robot is."""
        return self._walker.position

    @property
    def at(self) -> int | None:
        """The obstacle on whose boundary the robot stands; None in free space, and before its first move."""
        return self._seen.own(self._walker.at)

    @property
    def path(self) -> Path:
        """The path so far; its pieces have the robot's numbers of obstacles."""
        pieces = self._walker.pieces
        own = map(self._seen.own, (START if piece.obstacle is None else piece.obstacle for piece in pieces))
        return Path(Piece(p.kind, number, p.curve) for p, number in zip(pieces, own, strict=True))

    @property
    def length(self) -> Length:
        """Exact length of the path so far. Linear in its pieces."""
        return Length.sum(piece.length for piece in self._walker.pieces)

    @property
    def seen(self) -> tuple[int, ...]:
        """The obstacles of which something is known."""
        return tuple(range(len(self._numbers)))

    @property
    def visited(self) -> tuple[int, ...]:
        """The obstacles around which the robot has walked, in this order."""
        return tuple(map(self._own.__getitem__, self._walker.visited))

    @property
    def knows_unvisited(self) -> bool:
        """Whether an obstacle was seen around which the robot has not walked."""
        walker, links = self._walker, self._links
        if links is not None and not walker.is_sensed:
            # What a link from a visited boundary leads to was seen from there: no need to sense that.
            if len(walker.visited) == len(walker.bodies):
                return False
            if links.lead_on(walker.visited):
                return True
        # What was visited was seen: the robot stood on it.
        return len(self._numbers) > len(walker.visited)

    @property
    def unvisited(self) -> tuple[int, ...]:
        """The obstacles of which something is known and around which the robot has not walked. Linear."""
        return tuple(i for i, k in enumerate(self._numbers) if k not in self._walker.visited)

    @property
    def unvisited_now(self) -> Callable[[], tuple[int, ...]]:
        """A function that tells, whenever it is called, what `unvisited` was when it was asked for.

        Reasons that are made when they are read can use it (see `Robot`).

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> before = robot.unvisited_now
        >>> _ = robot.take(robot.nearest_unvisited()), robot.circle()
        >>> before(), robot.unvisited
        ((0,), (1,))
        """
        seen, count, visits = self._seen, self._walker.count, len(self._walker.visited)

        def then() -> tuple[int, ...]:
            return seen.unvisited_after(count, visits)

        return then

    @property
    def in_sight(self) -> frozenset[int]:
        """The obstacles of which something is in sight from here, but for those that are wholly known."""
        return frozenset(self._seen.in_sight)

    @property
    def incomplete(self) -> frozenset[int]:
        """The obstacles of which some, but not all, is known."""
        return frozenset(self._seen.incomplete)

    @property
    def map(self) -> KnownMap:
        """What is known now; what is learned later does not change it."""
        now = self._walker.memory.now
        return KnownMap(self._seen.numbers, lambda _: now, self.incomplete)

    @property
    def frontier(self) -> tuple[tuple[int, Point], ...]:
        """The ends of known boundary beyond which nothing is known: (obstacle, point)."""
        return self.map.frontier

    @property
    def sightings(self) -> tuple[Sighting, ...]:
        """What came into sight, went out of it, or became wholly known so far, in this order."""
        return tuple(self._seen.every)

    def look(self, i: int | None = None) -> tuple[KnownPart, ...]:
        """The parts of boundaries that are in sight from here, obstacle by obstacle; or those of one.

        ValueError for an obstacle that was not seen. The cost of one view.

        >>> import exactacq as xa
        >>> for part in xa.Robot(xa.load("squares")).look():
        ...     print(part.obstacle, part.start, part.end)
        0 (2, 1) (2, -1)
        """
        memory, place = self._walker.memory, self.position
        x, y = place.xy
        near = memory.near((x, y, x, y))
        return tuple(
            KnownPart(j, *part)
            for j, k in ((j, self._scene_number(j)) for j in (self.seen if i is None else (i,)))
            if k in near
            for part in memory.visible(place, k)
        )

    def nearest(self, obstacles: Iterable[int], *, visible: bool = False) -> tuple[int, Point]:
        """Which of some obstacles has the known point that is nearest to the robot, and this point.

        With *visible* the points that are in sight count alone, of obstacles that have some. Of equally near
        obstacles the order is fixed for the scene, of equally near points the lexicographically least is
        taken. ValueError for no obstacles, and for one that was not seen. Linear in their known parts.

        >>> import exactacq as xa
        >>> print(*xa.Robot(xa.load("circles")).nearest([0]))
        0 (3, 0)
        """
        here, chart = self.position, self.map
        found = [(*self._nearest(i, chart, visible), self._scene_number(i)) for i in obstacles]
        if not found:
            raise ValueError("of no obstacles none is the nearest")

        def order(a: tuple[Point, Curve | None, int], b: tuple[Point, Curve | None, int]) -> int:
            return distance_sq(a[0], here).compare(distance_sq(b[0], here)) or a[2] - b[2]

        self._last_nearest = point, _, k = min(found, key=cmp_to_key(order))
        return self._own[k], point

    def news(self, route: Route | None = None) -> frozenset[int]:
        """The obstacles of which more became known since this was asked last, and perhaps others.

        With a *route* also those of which a known crossing point on it came to lie behind the robot since
        this was asked of it last. So a strategy need not look through all that it knows.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("squares"))
        >>> robot.news(), robot.news()
        (frozenset({0}), frozenset())
        """
        if route is not None:
            self._check_owner(route)
        memory = self._walker.memory
        news, now = memory.news(), memory.now
        own = self._own
        if route is not None:
            passed = ((k, n) for k, n in route._passed() if k in own)
            news |= {k for k, n in passed if k in memory.acquired or now.knows_some(route._ashore(n, now))}
        # A border may cut one edge between two components, of which one was not seen.
        return frozenset(own[k] for k in news if k in own)

    # -- routes ------------------------------------------------------------------------------------

    def lay(self, points: Iterable[Point | Sequence[object]]) -> Route:
        """A route for the robot to follow, from where it is along straight pieces from point to point.

        `MoveError` if it does not begin where the robot is, or leads out of the terrain to which the robot is
        confined. Cost: that of looking for what is in the way, which the robot does not tell.

        >>> import exactacq as xa
        >>> xa.Robot(xa.load("squares")).lay([(0, 0), (0, 4), (9, 4)])
        <Route of 2 pieces, at 0>
        """
        places, here = [Point.of(point) for point in points], self.position
        if not places or (places[0] is not here and places[0] != here):
            raise MoveError("a route begins where the robot is: let its first point be robot.position")
        places[1:] = map(self._goal, places[1:])
        pieces = [Segment(p, q) for p, q in pairwise([here, *places[1:]]) if p != q]
        last = self._last_nearest
        end_on = last[1] if last is not None and last[0] is places[-1] else None
        return Route(pieces, self._walker, here, self._blocking.crossings(pieces, end_on))

    def way_back(self, route: Route) -> Route:
        """The way back along a route, from the robot's place on it to where it was laid.

        `MoveError` if the robot is not at its place on the route.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("squares"))
        >>> out = robot.lay([(0, 0), (0, 4)])
        >>> halt, back = robot.follow(out), robot.way_back(out)
        >>> robot.follow(back).place
        Point(0, 0)
        """
        self._check_route(route)
        return route._back(self.position)

    def exits(self, route: Route, i: int) -> Iterator[Exit]:
        """The places ahead where a route comes out of an obstacle that is acquired, in order.

        Places that the robot cannot reach along the boundary are left out. `MoveError` for another robot's
        route and if parts of the obstacle are unknown, ValueError if it was not seen. Each place is found
        when it is asked for.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("squares"))
        >>> route = robot.lay([(0, 0), (20, 0)])
        >>> halt, _ = robot.follow(route), robot.circle()
        >>> print(*(place.point for place in robot.exits(route, 0)))
        (4, 0)
        """
        self._check_owner(route)
        k, memory = self._scene_number(i), self._walker.memory
        if k not in memory.acquired:
            raise MoveError(f"parts of obstacle {i} are unknown, and so is where a route comes out of it")
        return iter(route._exits(k, memory.now))

    # -- links and ways ----------------------------------------------------------------------------

    def links(self, source: int | None) -> tuple[KnownLink, ...]:
        """The links from the boundary of a visited obstacle, or with None from the start, at most R long.

        Their order is fixed for the scene. `MoveError` for an obstacle that was not walked around, and of a
        robot that is confined to a terrain. Cost: that of the links, once.

        >>> import exactacq as xa
        >>> [str(link.length) for link in xa.Robot(xa.load("circles")).links(None)]
        ['3']
        """
        return tuple(self._known_link(link) for link in self._known_links().of(self._node(source)))

    def nearest_unvisited(self, source: int | Here | None = HERE) -> KnownLink | None:
        """The shortest of the links to an obstacle that was not visited, from the boundary where the robot
        is; in free space from the start. With *source* from there, as `links`.

        Of equally long ones the first one of `links`. None if there is none; `MoveError` as `links`. If it is
        taken before any other move, that it was the nearest is told as the decision. Cost: that of the links
        that may be the shortest.

        >>> import exactacq as xa
        >>> xa.Robot(xa.load("circles")).nearest_unvisited().target
        0
        """
        links, walker = self._known_links(), self._walker
        node = self._node_here() if source is HERE else self._node(source)
        link = links.nearest(node, walker.visited)
        if link is None:
            return None
        return self._known_link(
            link, NearestLink(links, link, walker.visited, len(walker.visited), walker.count)
        )

    def way_to(self, point: Point | Sequence[object]) -> tuple[Length, str]:
        """Length and hand of the shorter walk along the present boundary, which is acquired, to a point.

        The hand, "left" or "right", is the one on the side of the obstacle; "left" wins a tie. `MoveError` at
        no boundary, at one of which parts are unknown, and for a point that is not on it.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> _ = robot.take(robot.nearest_unvisited()), robot.circle()
        >>> print(*robot.way_to((7, 0)))
        2*pi left
        """
        length, forward = self._way_to(Point.of(point))
        return length, "left" if forward else "right"

    def path_to(self, point: Point | Sequence[object]) -> ShortestPath:
        """A shortest path from here to a point that respects all that is known.

        What is not known counts as free. Obstacles that are wholly known are solid; known parts of other
        boundaries are walls that the path does not cross, but may touch, follow and turn around: see
        `shortest_path` on a map. Its ``scene`` and ``walls`` are those near enough to be in the way. A robot
        that is confined stays in its terrain. `MoveError` for a point inside an obstacle that is wholly
        known, for one beyond the border of the terrain, and if border and walls leave no path; what
        `shortest_path` raises and costs besides.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> print(robot.path_to((8, 0)).length)
        sqrt(445)/5 + sqrt(21)
        >>> _ = robot.take(robot.nearest_unvisited()), robot.circle()
        >>> print(robot.path_to((8, 0)).length.decimal(6), robot.path_to((7, 0)).length)
        6.83712 2*pi
        """
        goal = self._goal(point)
        try:
            found = self._paths.to(goal)
        except InvalidScene as error:
            # What is known is a scene of its own, with other numbers of obstacles.
            flaw = re.sub(r"\bobstacle O\d+", "an obstacle", error.violations[0])
            raise MoveError(f"no path: {flaw.removeprefix('end: ')}") from None
        if found is None:
            raise MoveError(f"no path: border and known boundaries part the robot from {goal}")
        return found

    # -- how it is done ----------------------------------------------------------------------------

    @property
    def _numbers(self) -> list[int]:
        """The scene's numbers of the obstacles in the order in which they were seen."""
        return self._seen.numbers.order

    @property
    def _own(self) -> dict[int, int]:
        """The robot's numbers of obstacles by the scene's."""
        return self._seen.numbers.own

    def _scene_number(self, number: int) -> int:
        """The scene's number of an obstacle that was seen."""
        return self._seen.numbers.scene_number(number, len(self._numbers))

    def _known_links(self) -> KnownLinks:
        if self._links is None:
            raise MoveError("a robot that is confined to a terrain knows no links: use routes")
        return self._links

    def _nearest(self, i: int, chart: KnownMap, visible: bool) -> tuple[Point, Curve | None]:
        """The point of an obstacle that is nearest to the robot, of those in sight if there are any.

        With the piece of boundary on which it lies; None for a single point.
        """
        parts = self.look(i) if visible else ()
        return nearest_on(parts or chart.known(i), self.position)

    def _node_at(self, place: Point) -> Node:
        """The obstacle on whose boundary a place lies, if there is one."""
        last = self._last_nearest
        if last is not None and last[0] is place:
            return last[2]
        k = obstacle_at(self._table, place)
        if k is None or self._ground is None:
            return START if k is None else k
        shores = (c for c in self._ground.of(k) if c.edges)
        return next((c.index for c in shores if c.edges_at(place)), START)

    def _hit_on(self, way: Segment) -> tuple[int, Point] | None:
        """The obstacle that a way with distinct ends leads into first, and where."""
        with deciding("what the way from {} to {} leads into", way.start, way.end):
            if self._ground is None:
                hit = first_hit(self._table, way)
                if hit is None:
                    return None
                if hit.place.rational is None:
                    # No vertex of the scene: that would keep what is noted.
                    put_on_line(hit.place, way.start, way.end)
                return hit.obstacle, hit.place
            for gap in self._blocking.gaps(way)[:1]:
                assert gap.component is not None, (
                    "a way from a free point is blocked where it leads into something"
                )
                return gap.component.index, gap.begin.point
            return None

    def _goal(self, point: Point | Sequence[object]) -> Point:
        """A point to go to, if it is not too far away, and not beyond a border."""
        goal = Point.of(point)
        if any(c.compare(LIMIT) > 0 or c.compare(-LIMIT) < 0 for c in goal):
            raise MoveError(f"{place_text(goal)} is too far away: coordinates lie within {LIMIT_TEXT}")
        self._check_border(goal)
        return goal

    def _check_border(self, point: Point) -> None:
        if self._ground is None:
            return
        west, south, east, north = self._ground.terrain.limits
        if not (west <= point.x <= east and south <= point.y <= north):
            raise MoveError(f"{point} lies beyond the border of the terrain")

    def _check_owner(self, route: Route) -> None:
        """`MoveError` for what is no route of this robot."""
        if not isinstance(route, Route):
            raise MoveError(f"a route is what robot.lay or robot.way_back gives, not {shown(route)}")
        if route._of is not self._walker:
            raise MoveError("the route is that of another robot")

    def _check_route(self, route: Route) -> None:
        self._check_owner(route)
        if route._place is not self.position and route._place != self.position:
            raise MoveError("the robot is not on the route, where it left it")

    def _node_here(self) -> Node:
        """The node where the robot is; in free space that is the start."""
        at = self._walker.at
        return at if at == START or at in self._walker.visited else self._node(self._seen.own(at))

    def _node(self, source: int | None) -> Node:
        """The node of the start or of a visited obstacle."""
        if source is None:
            return START
        if source in range(len(self._numbers)) and self._numbers[source] in self._walker.visited:
            return self._numbers[source]
        raise MoveError(f"the links from obstacle {source!r} are known once it was walked around")

    def _known_link(self, link: Link, nearest: NearestLink | None = None) -> KnownLink:
        return KnownLink(Length(link.length), self._seen, link, nearest)

    def _check(self, link: KnownLink, node: Node, what: str) -> None:
        """`MoveError` for a link of another robot, and if the robot is not at one of its ends."""
        if link._of is not self._seen:
            raise MoveError(f"the {what} at an obstacle of another robot")
        if node != self._walker.at:
            here = "in free space" if self.at is None else f"at obstacle {self.at}"
            there = "the start" if node == START else f"obstacle {self._seen.own(node)}"
            raise MoveError(f"the {what} at {there}, and the robot is {here}")

    def _at_boundary(self) -> int:
        """The scene's number of the obstacle where the robot is."""
        if self._walker.at == START:
            way = "go to one first"
            if obstacle_at(self._table, self.position) is not None:
                way = "it only touches one; go_to(robot.position) puts it there"
            raise MoveError(f"the robot is at no boundary: {way}")
        return int(self._walker.at)

    def _way_to(self, point: Point) -> tuple[Length, bool]:
        """Length and sense of the shorter walk along the present boundary, which is known, to a point."""
        walker = self._walker_on_known_boundary()
        with on_this_boundary():
            return walker.way_to(point)

    def _walker_on_known_boundary(self) -> Walker:
        at = self._at_boundary()
        # What was walked all around is known, whether it is sensed by now or not.
        is_round = at in self._walker.visited and self._walker.boundary().closed
        if not is_round and at not in self._walker.memory.acquired:
            raise MoveError(
                f"parts of obstacle {self.at} are unknown, and so is the shorter way around it: "
                "use walk, which tells when it is there"
            )
        return self._walker


def _start_flaws(
    scene: Scene, start: Point | Sequence[object] | None, place: Point, confined: bool
) -> Iterator[str]:
    """What is wrong with the place where a robot is to start."""
    if not confined:
        yield from point_flaws("start", place, ((o.locate(place), o) for o in scene.obstacles))
    elif not (start is None and scene.start is None) and (given := start_of(scene, start)) != place:
        yield f"the start {place_text(given)} is not the terrain's SW corner {place_text(place)}"


def _hulls(table: EdgeTable, ground: Ground) -> Floats:
    """Boxes around the whole obstacles of components, which their boundaries do not leave."""
    return table.hulls[[component.obstacle.index for component in ground.components]]


@contextmanager
def on_this_boundary() -> Iterator[None]:
    """`MoveError` within this context for a point that is not on the boundary where the robot is."""
    try:
        yield
    except ValueError as error:
        raise MoveError(f"no way along this boundary: {error}") from None
