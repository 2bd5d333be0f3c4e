"""The robot: all that a strategy may do and ask, and so its only access to the scene.

It moves, senses all the way, and tells what it has learned; names that begin with an underscore are not for
strategies. Obstacles have the robot's own numbers: 0 is the one that it saw first, so that numbers say
nothing of obstacles that it has not seen. Equal scenes give equal numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import cmp_to_key, wraps
from math import inf
from typing import Concatenate, ParamSpec, TypeVar

from flint import fmpq

from exactacq.errors import ExactacqError, InvalidScene, MoveError, Undecided, shown
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Location, Point
from exactacq.numbers.length import Length
from exactacq.scene.scene import Scene, radius_of, start_of
from exactacq.scene.validation import place_text
from exactacq.sensing.event import EventKind, Occasion
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Path, Piece
from exactacq.strategies.first_hit import first_hit, obstacle_at
from exactacq.strategies.known_links import KnownLinks
from exactacq.strategies.known_map import KnownMap, KnownPart, Sighting
from exactacq.strategies.lap import Lap
from exactacq.strategies.moves import EnoughMoves, Halt, HaltKind, KnownLink, Way, kinds_of
from exactacq.strategies.walker import Walker
from exactacq.visibility.links import START, Link, Links, Node, lexicographic

Told = TypeVar("Told")
Given = ParamSpec("Given")


def _move(
    action: Callable[Concatenate[Robot, Given], Told],
) -> Callable[Concatenate[Robot, Given], Told]:
    """A method that moves the robot: it is counted, and what comes into sight is taken in."""

    @wraps(action)
    def counted(robot: Robot, /, *args: Given.args, **options: Given.kwargs) -> Told:
        robot._begin()
        try:
            return action(robot, *args, **options)
        except Undecided as error:
            robot._stuck = error
            raise
        finally:
            robot._take_in()

    return counted


class Robot:
    """A point robot in free space, or on a boundary, with a vision sensor of limited *radius*.

    *start* and *radius* default to the scene's own; both are rational. The robot sees all the way as it
    moves: grazing does not block its sight. What it may do are the methods that move it, `go_to`, `walk`,
    `walk_to`, `circle`, `take` and `go_back`; all else are questions, which cost no way. It never tells
    anything of the scene but what it has seen, and of a boundary all around which it has walked the links
    that begin there. A terrain's border is no wall, and is not seen.

    Raises `InvalidScene` if start or radius is missing or illegal, or if an obstacle meets the terrain's
    border, `FormatError` if they are no number and no point. Moves and questions raise `MoveError` where
    they make no sense there, and `Undecided` if an exact comparison is beyond the library's limits: then the
    robot stays where it is for good. Moves cost what `sightseer` pays for them; `map` is made at once.

    >>> import exactacq as xa
    >>> robot = xa.Robot(xa.load("circles"))
    >>> robot.go_to((10, 0)).kind
    <HaltKind.HIT: 'hit'>
    >>> robot.circle()
    >>> print(robot.position, robot.length, robot.map.acquired, [link.target for link in robot.links(0)])
    (3, 0) 3 + 4*pi (0,) [1]
    """

    def __init__(
        self, scene: Scene, start: Point | Sequence[object] | None = None, radius: object = None
    ) -> None:
        place = start_of(scene, start)
        if border := scene.meets_border():
            rule = "meets the terrain's border: only the Seed Spreader takes such obstacles"
            raise InvalidScene([f"obstacle {scene.obstacles[k].label} {rule}" for k in border])
        reach = radius_of(scene, radius, place)
        for obstacle in scene.obstacles:
            if obstacle.locate(place) is Location.INSIDE:
                raise InvalidScene([f"the start {place_text(place)} lies inside obstacle {obstacle.label}"])
        links = Links(scene, reach)
        self._radius, self._table = reach, links.table
        self._links = KnownLinks(links, place)
        self._walker = Walker(place, Memory(scene, reach, links.table))
        # The scene's numbers of the obstacles in the order in which they were seen, and the other way.
        self._numbers: list[int] = []
        self._own: dict[int, int] = {}
        self._sightings: list[Sighting] = []
        self._lap: Lap | None = None
        self._moves, self._most = 0, inf
        # Why it does not move any more, if it does not.
        self._stuck: ExactacqError | None = None
        self._on_edge: Callable[[], None] = lambda: None
        self._on_sighting: Callable[[Sighting], None] = lambda sighting: None
        self._take_in()

    def __repr__(self) -> str:
        at = "in free space" if self.at is None else f"at obstacle {self.at}"
        return f"<Robot {at}, after {float(self.length):.6g}: {len(self._numbers)} obstacles seen>"

    # -- questions ---------------------------------------------------------------------------------

    @property
    def radius(self) -> fmpq:
        """Up to how far the robot sees, the radius itself included."""
        return self._radius

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
        return self._own_number(self._walker.at)

    @property
    def path(self) -> Path:
        """The path so far; its pieces have the robot's numbers of obstacles."""
        pieces = self._walker.pieces
        own = (None if piece.obstacle is None else self._own[piece.obstacle] for piece in pieces)
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
        return tuple(self._own[k] for k in self._walker.visited)

    @property
    def knows_unvisited(self) -> bool:
        """Whether an obstacle was seen around which the robot has not walked."""
        # What was visited was seen: the robot stood on it.
        return len(self._numbers) > len(self._walker.visited)

    @property
    def map(self) -> KnownMap:
        """What is known now; what is learned later does not change it."""
        return KnownMap(self._walker.memory.now, self._numbers)

    @property
    def frontier(self) -> tuple[tuple[int, Point], ...]:
        """The ends of known boundary beyond which nothing is known: (obstacle, point)."""
        return self.map.frontier

    @property
    def sightings(self) -> tuple[Sighting, ...]:
        """What came into sight, went out of it, or became wholly known so far, in this order."""
        return tuple(self._sightings)

    def look(self) -> tuple[KnownPart, ...]:
        """The parts of boundaries that are in sight from here, obstacle by obstacle.

        The cost of one view.

        >>> import exactacq as xa
        >>> for part in xa.Robot(xa.load("squares")).look():
        ...     print(part.obstacle, part.start, part.end)
        0 (2, 1) (2, -1)
        """
        memory, place = self._walker.memory, self.position
        x, y = place.xy
        near = memory.near((x, y, x, y))
        return tuple(
            KnownPart(i, curve.start, curve.end, None if _is_point(curve) else curve)
            for i, k in enumerate(self._numbers)
            if k in near
            for curve in memory.visible(place, k)
        )

    def links(self, source: int | None) -> tuple[KnownLink, ...]:
        """The links from the boundary of a visited obstacle, or with None from the start, at most R long.

        Their order is fixed for the scene. `MoveError` for an obstacle that was not walked around. Cost: that
        of the links, once.

        >>> import exactacq as xa
        >>> [str(link.length) for link in xa.Robot(xa.load("circles")).links(None)]
        ['3']
        """
        return tuple(self._known_link(link) for link in self._links.of(self._node(source)))

    def nearest_unvisited(self, source: int | None) -> KnownLink | None:
        """The shortest of the links from a boundary, or the start, to an obstacle that was not visited.

        Of equally long ones the first one of `links`. None if there is none; `MoveError` as `links`. Cost:
        that of the links that may be the shortest.

        >>> import exactacq as xa
        >>> xa.Robot(xa.load("circles")).nearest_unvisited(None).target
        0
        """
        link = self._links.nearest(self._node(source), self._walker.visited)
        return None if link is None else self._known_link(link)

    def way_to(self, point: Point | Sequence[object]) -> tuple[Length, str]:
        """Length and hand of the shorter walk along the present boundary, which is acquired, to a point.

        The hand, "left" or "right", is the one on the side of the obstacle; "left" wins a tie. `MoveError` at
        no boundary, at one of which parts are unknown, and for a point that is not on it.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> _ = robot.take(robot.nearest_unvisited(None)), robot.circle()
        >>> print(*robot.way_to((7, 0)))
        2*pi left
        """
        try:
            length, forward = self._walker_on_known_boundary().way_to(Point.of(point))
        except ValueError as error:
            raise _not_there(error) from None
        return length, "left" if forward else "right"

    # -- moves -------------------------------------------------------------------------------------

    @_move
    def go_to(
        self, point: Point | Sequence[object], *, until: EventKind | Collection[EventKind] = ()
    ) -> Halt:
        """Go straight to a point, or to the first place where that would lead into an obstacle.

        With *until*, kinds of sightings, the robot halts at the first of these on its way; those that happen
        just where it sets out do not count. Touching boundaries does not stop it. ValueError for kinds that
        no sensor reports.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"), radius=5)
        >>> halt = robot.go_to((0, 5), until="lose")
        >>> print(halt.kind, halt.sighting.reason, halt.place)
        event range (0, 2*sqrt(6))
        """
        kinds, target, walker = kinds_of(until), Point.of(point), self._walker
        here = walker.position
        hit = first_hit(self._table, Segment(here, target)) if target != here else None
        end = target if hit is None else hit.place
        kind, sighting = (HaltKind.ARRIVED if hit is None else HaltKind.HIT), None
        if hit is not None and end == here and walker.at == hit.obstacle:
            return Halt(kind, here, self.at)
        if walker.at != START and end != here:
            walker.mark(EventKind.LEAVE, int(walker.at))
        if not kinds:
            walker.go_straight(START, end)
        elif end != here:
            for part in walker.memory.parts(Segment(here, end)):
                sighting = self._walk_until(Piece("straight", None, part), kinds)
                if sighting is not None:
                    kind = HaltKind.EVENT
                    break
        self._lap = None
        halted_at_hit = hit is not None and kind is HaltKind.HIT
        at = hit.obstacle if hit is not None and halted_at_hit else obstacle_at(self._table, walker.position)
        walker.at = START if at is None else at
        if at is not None:
            walker.mark(EventKind.HIT, at)
        self._take_in()
        return Halt(kind, walker.position, self.at, sighting)

    @_move
    def walk(
        self,
        hand: str = "left",
        *,
        to: Point | Sequence[object] | None = None,
        until: EventKind | Collection[EventKind] = (),
    ) -> Halt:
        """Walk along the present boundary with a hand at it: all around, or to a point, or until an event.

        A lap that was interrupted goes on if the hand is the same: the robot is round where it began. *to* is
        a point of the boundary; if it is none, the robot finds that out by coming round. For *until* see
        `go_to`. `MoveError` at no boundary, ValueError for another hand or other kinds.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("squares"))
        >>> _ = robot.go_to((5, 0))
        >>> robot.walk("right", to=(2, 1)).kind, robot.position
        (<HaltKind.ARRIVED: 'arrived'>, Point(2, 1))
        >>> robot.walk("right", until=["sight", "acquire"]).kind, robot.position
        (<HaltKind.EVENT: 'event'>, Point(4, -1))
        """
        if hand not in ("left", "right"):
            raise ValueError(f'a hand is "left" or "right", not {shown(hand)}')
        kinds, target = kinds_of(until), None if to is None else Point.of(to)
        walker, obstacle = self._walker, self._at_boundary()
        here = walker.position
        if target is not None and target == here:
            return Halt(HaltKind.ARRIVED, target, self.at)
        lap = self._lap
        if lap is None or lap.forward is not (hand == "left"):
            lap = self._lap = Lap(walker.boundary(), here, hand == "left")
        while lap.rest:
            ends_here, curve = lap.next(target)
            sighting = self._walk_along(Piece("boundary", obstacle, curve), kinds)
            lap.walked(walker.position)
            if not lap.rest:
                self._lap = None
                walker.visited[obstacle] = None
            if sighting is not None:
                return Halt(HaltKind.EVENT, walker.position, self.at, sighting)
            self._on_edge()
            if ends_here:
                return Halt(HaltKind.ARRIVED, walker.position, self.at)
        return Halt(HaltKind.ROUND, walker.position, self.at)

    @_move
    def walk_to(self, point: Point | Sequence[object]) -> None:
        """Walk to a point of the present boundary, which is acquired, the shorter way: see `way_to`.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> _ = robot.take(robot.nearest_unvisited(None)), robot.circle(), robot.walk_to((7, 0))
        >>> robot.position
        Point(7, 0)
        """
        self._lap = None
        try:
            self._walker_on_known_boundary().walk_to(Point.of(point))
        except ValueError as error:
            raise _not_there(error) from None

    @_move
    def circle(self) -> None:
        """Walk all around the present boundary, with the left hand at it. `MoveError` at no boundary.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> _ = robot.go_to((3, 0)), robot.circle()
        >>> robot.visited, robot.map.acquired
        ((0,), (0,))
        """
        self._at_boundary()
        self._lap = None
        self._walker.circumnavigate(self._on_edge)

    @_move
    def take(self, link: KnownLink) -> Way:
        """Walk along the present boundary to where a link begins, and go along it.

        Of its equally short segments it is the one with the least walk before, of those the one to which the
        left hand leads, then the one with the lexicographically least leave point and hit point. `MoveError`
        if the link does not begin where the robot is, or is that of another robot.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> for obstacle in (0, 1):
        ...     way = robot.take(robot.nearest_unvisited(robot.at))
        ...     robot.circle()
        >>> print(way.leave, way.hit, robot.length)
        (7, 0) (9, 0) 5 + 12*pi
        """
        walker, known = self._walker, link._link
        self._check(link._of, link.source, "link begins")
        if link.source is None and self.position != self.start:
            raise MoveError("the link begins at the start, and the robot is somewhere else")
        leave, hit = self._nearest_segment(known)
        if known.source != START:
            walker.walk_to(leave)
            walker.mark(EventKind.LEAVE, int(known.source), occasion=Occasion.ADVANCE, other=known.target)
        walker.go_straight(known.target, hit)
        walker.mark(EventKind.HIT, known.target, occasion=Occasion.ADVANCE, other=known.source)
        self._lap = None
        self._take_in()
        return Way(link.source, link.target, leave, hit, link.length, walker)

    @_move
    def go_back(self, way: Way) -> None:
        """Walk along the present boundary to where a way has ended, and go back to where it began.

        `MoveError` if the robot is not at the obstacle to which the way led, or if it would have to walk
        along a boundary of which parts are unknown.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> _ = robot.go_back(robot.take(robot.nearest_unvisited(None)))
        >>> robot.position, robot.at
        (Point(0, 0), None)
        """
        walker = self._walker
        self._check(way._of, way.target, "way ends")
        if walker.position != way.hit:
            self._walker_on_known_boundary().walk_to(way.hit)
        source, target = self._scene_node(way.source), self._numbers[way.target]
        back = Occasion.BACKTRACK
        walker.mark(EventKind.LEAVE, target, occasion=back, other=source)
        walker.go_straight(source, way.leave)
        at = source if isinstance(source, int) else None
        walker.mark(EventKind.BACKTRACK, at, occasion=back, other=target)
        self._lap = None

    # -- how it is done ----------------------------------------------------------------------------

    def _begin(self) -> None:
        if self._stuck is not None:
            raise self._stuck
        self._moves += 1
        if self._moves > self._most:
            raise EnoughMoves

    def _take_in(self) -> None:
        """Number what came into sight since the last time, and tell of it."""
        for report in self._walker.memory.reports[len(self._sightings) :]:
            if report.obstacle not in self._own:
                self._own[report.obstacle] = len(self._numbers)
                self._numbers.append(report.obstacle)
            seen = Sighting(report.kind, self._own[report.obstacle], report.place, report.reason)
            self._sightings.append(seen)
            self._on_sighting(seen)

    def _own_number(self, node: Node) -> int | None:
        return self._own[node] if isinstance(node, int) else None

    def _scene_node(self, number: int | None) -> Node:
        return START if number is None else self._numbers[number]

    def _node(self, source: int | None) -> Node:
        """The node of the start or of a visited obstacle."""
        if source is None:
            return START
        if source in range(len(self._numbers)) and self._numbers[source] in self._walker.visited:
            return self._numbers[source]
        raise MoveError(f"the links from obstacle {source!r} are known once it was walked around")

    def _known_link(self, link: Link) -> KnownLink:
        source, target = self._own_number(link.source), self._own[link.target]
        return KnownLink(source, target, Length(link.length), self._walker, link)

    def _check(self, owner: Walker, number: int | None, what: str) -> None:
        if owner is not self._walker:
            raise MoveError(f"the {what} at an obstacle of another robot")
        if number != self.at:
            here = "in free space" if self.at is None else f"at obstacle {self.at}"
            there = "the start" if number is None else f"obstacle {number}"
            raise MoveError(f"the {what} at {there}, and the robot is {here}")

    def _at_boundary(self) -> int:
        """The scene's number of the obstacle where the robot is."""
        if self._walker.at == START:
            raise MoveError("the robot is at no boundary: go to one first")
        return int(self._walker.at)

    def _walker_on_known_boundary(self) -> Walker:
        if self._at_boundary() not in self._walker.memory.acquired:
            raise MoveError(
                f"parts of obstacle {self.at} are unknown, and so is the shorter way around it: "
                "use walk, which tells when it is there"
            )
        return self._walker

    def _nearest_segment(self, link: Link) -> tuple[Point, Point]:
        """The segment that `take` goes along."""
        pairs = link.segments(self.position)
        if link.source == START:
            return min(pairs, key=cmp_to_key(lexicographic))
        if len(pairs) == 1:
            return pairs[0]
        ways = [(*self._walker.way_to(leave), leave, hit) for leave, hit in pairs]

        def order(a: tuple[Length, bool, Point, Point], b: tuple[Length, bool, Point, Point]) -> int:
            return a[0].compare(b[0]) or b[1] - a[1] or lexicographic(a[2:], b[2:])

        return min(ways, key=cmp_to_key(order))[2:]

    def _walk_along(self, piece: Piece, kinds: Collection[EventKind]) -> Sighting | None:
        """Walk a piece, or up to the first sighting of one of some kinds, which is returned."""
        if kinds:
            for part in self._walker.memory.divided(piece):
                sighting = self._walk_until(part, kinds)
                if sighting is not None:
                    return sighting
            return None
        self._walker.move(piece)
        self._walker.position = piece.end
        return None

    def _walk_until(self, piece: Piece, kinds: Collection[EventKind]) -> Sighting | None:
        """Walk a piece that is one leg, or up to the first such sighting."""
        walker, found = self._walker, None
        ahead = walker.memory.ahead(piece)
        leg, own = ahead.leg, dict(self._own)
        for notice in ahead.notices:
            number = own.setdefault(notice.obstacle, len(own))
            if notice.kind in kinds and leg.order(notice.u, leg.first) > 0:
                found = Sighting(notice.kind, number, notice.place, notice.reason)
                if leg.order(notice.u, leg.last) < 0:
                    piece = Piece(piece.kind, piece.obstacle, _upto(piece.curve, notice.place))
                break
        walker.move(piece)
        walker.position = piece.end
        self._take_in()
        return found


def _upto(curve: Curve, place: Point) -> Curve:
    return curve.part(curve.start, place)


def _is_point(curve: Curve) -> bool:
    """Whether a part in sight is a single point."""
    return isinstance(curve, Segment) and curve.start is curve.end


def _not_there(error: ValueError) -> MoveError:
    return MoveError(f"no way along this boundary: {error}")
