"""The robot: all that a strategy may do and ask, and so its only access to the scene.

It moves, senses all the way, and tells what it has learned (`exactacq.strategies.observer`); names that begin
with an underscore are not for strategies.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from copy import copy
from functools import cmp_to_key, partial, wraps
from typing import Concatenate, ParamSpec, TypeAlias, TypeVar

from exactacq.errors import MoveError, Undecided, shown
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.decision import Decision
from exactacq.sensing.event import EventKind, Occasion
from exactacq.sensing.path import Piece
from exactacq.strategies.known_links import NearestLink
from exactacq.strategies.known_map import Sighting
from exactacq.strategies.lap import Lap
from exactacq.strategies.lookout import Lookout
from exactacq.strategies.moves import (
    Awaited,
    EnoughMoves,
    Halt,
    HaltKind,
    KnownLink,
    Watch,
    Way,
    hand_along,
    kinds_of,
)
from exactacq.strategies.observer import Observer, on_this_boundary
from exactacq.strategies.routes import Exit, Route
from exactacq.strategies.sightings import Sightings
from exactacq.visibility.links import START, Link, Node, lexicographic
from exactacq.visibility.shortest_path import ShortestPath

Decided: TypeAlias = "Decision | Callable[[], Decision]"
Why: TypeAlias = "str | Decision | Callable[[], str | Decision]"
"""Why a strategy moves the robot: a text, a decision, or what gives one of these when it is first read."""
Told = TypeVar("Told")
Given = ParamSpec("Given")


def _move(
    action: Callable[Concatenate[Robot, Given], Told],
) -> Callable[Concatenate[Robot, Given], Told]:
    """A method that moves the robot: it is counted, and what comes into sight is taken in, if not later."""

    @wraps(action)
    def counted(robot: Robot, /, *args: Given.args, **options: Given.kwargs) -> Told:
        robot._begin()
        try:
            return action(robot, *args, **options)
        except Undecided as error:
            robot._walker.stuck = copy(error)
            raise
        finally:
            if not robot._senses_late:
                robot._seen.take_in()

    return counted


class Robot(Observer):
    """A point robot in free space, or on a boundary, with a vision sensor of limited *radius*.

    *start* and *radius* default to the scene's own; both are rational. The robot sees all the way as it
    moves: grazing does not block its sight. What it may do are the methods that move it, `go_to`, `go_along`,
    `walk`, `walk_to`, `circle`, `follow`, `take_up`, `take` and `go_back`; all else are questions, and
    leave it where it is. It tells nothing of the scene but what it has seen, the links that begin at a
    boundary all around which it has walked, and whether a route crosses a boundary at a known point. A
    terrain's border is no wall, and is not seen. Moves take a *reason*, a text or a `Decision` with the
    robot's numbers of obstacles, which the run tells with the event that begins the move; a move of no length
    has none. The reason may be a function that gives one of these: it is called when somebody reads it.

    One that is *confined* keeps within the scene's `terrain` and knows its border; it starts in the SW
    corner. Its obstacles are the components that the border leaves of the scene's and that the robot can
    reach from there. Where the border cuts a boundary, this has two ends.

    Raises `InvalidScene` if start or radius is missing or illegal, or if an obstacle meets the terrain's
    border, or, if it is confined, without a terrain, with an enclosure, if the SW corner is not free, and if
    an obstacle lies outside; `FormatError` if start and radius are no point and no number. Moves and
    questions raise `MoveError` where they make no sense there, and `Undecided` if an exact comparison is
    beyond the library's limits: then the robot stays where it is for good. Moves cost what `sightseer` pays
    for them; `map` is made at once.

    >>> import exactacq as xa
    >>> robot = xa.Robot(xa.load("circles"))
    >>> robot.go_to((10, 0)).kind
    <HaltKind.HIT: 'hit'>
    >>> robot.circle()
    >>> print(robot.position, robot.length, robot.map.acquired, [link.target for link in robot.links(0)])
    (3, 0) 3 + 4*pi (0,) [1]
    """

    # -- moves -------------------------------------------------------------------------------------

    @_move
    def go_to(
        self,
        point: Point | Sequence[object],
        *,
        until: EventKind | Collection[EventKind] = (),
        just_past: bool = False,
        reason: Why = "",
    ) -> Halt:
        """Go straight to a point, or to the first place where that would lead into an obstacle.

        With *until*, kinds of sightings, the robot halts at the first of these on its way; those that happen
        just where it sets out do not count. Touching boundaries does not stop it.

        The place of a sighting often has long numbers, and those of a place that is found from there are
        longer. *just_past* the sighting it halts at one with short numbers, if the way has any: early on the
        way to whatever happens next, or at the end of the edge or way if it happens there. The sighting has
        its own place.

        ValueError for kinds that no sensor reports, `MoveError` for a point beyond a border that confines the
        robot.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"), radius=5)
        >>> halt = robot.go_to((0, 5), until="lose")
        >>> print(halt.kind, halt.sighting.reason, halt.place)
        event range (0, 2*sqrt(6))
        >>> halt = robot.go_to((0, -7), until="lose", just_past=True)
        >>> print(halt.place, halt.sighting.place)
        (0, -40217/8192) (0, -2*sqrt(6))
        """
        target, walker = self._goal(point), self._walker
        here = walker.position
        awaited = Awaited(kinds_of(until), here, just_past)
        hit = self._hit_on(Segment(here, target)) if target != here else None
        end = target if hit is None else hit[1]
        kind, sighting, moves = (HaltKind.ARRIVED if hit is None else HaltKind.HIT), None, end != here
        if not moves and walker.at != START:
            return Halt(kind, here, self.at)
        decided = self._decided(reason)
        if moves:
            self._set_off(decided)
        if not awaited.kinds or not moves:
            walker.go_straight(START, end if moves else here)
        else:
            for part in walker.memory.parts(Segment(here, end)):
                sighting = self._walk_until(Piece("straight", None, part), awaited)
                if sighting is not None:
                    kind = HaltKind.EVENT
                    break
        node = hit[0] if hit is not None and kind is HaltKind.HIT else self._node_at(walker.position)
        return self._landed(kind, node, sighting)

    @_move
    def walk(
        self,
        hand: str = "left",
        *,
        to: Point | Segment | Sequence[object] | None = None,
        until: EventKind | Collection[EventKind] = (),
        just_past: bool = False,
        reason: Why = "",
    ) -> Halt:
        """Walk along the present boundary with a hand at it: all around, or to a goal, or until an event.

        A lap that was interrupted goes on if the hand is the same: the robot is round where it began. If it
        is stopped just there, the next call without *to* says so and does not move it. *to* is a point of the
        boundary; if it is none, the robot finds that out by coming round. Or it is a segment, as an M-line:
        the robot halts where the boundary next crosses or touches it, and if an edge lies along it, at both
        ends of what they have in common; but not where it sets out or where the lap ends. For *until*
        and *just_past* see `go_to`. `MoveError` at no boundary and at one that a border cuts, ValueError for
        another hand, other kinds or a segment without length.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("squares"))
        >>> _ = robot.go_to((5, 0))
        >>> robot.walk("right", to=(2, 1)).kind, robot.position
        (<HaltKind.ARRIVED: 'arrived'>, Point(2, 1))
        >>> robot.walk("right", until=["sight", "acquire"]).kind, robot.position
        (<HaltKind.EVENT: 'event'>, Point(4, -1))
        >>> robot.walk("right", to=xa.Segment((0, 0), (20, 0))).kind, robot.position
        (<HaltKind.ROUND: 'round'>, Point(2, 0))
        """
        if hand not in ("left", "right"):
            raise ValueError(f'a hand is "left" or "right", not {shown(hand)}')
        target = None if to is None else to if isinstance(to, Segment) else Point.of(to)
        if isinstance(target, Segment) and target.start == target.end:
            raise ValueError("a segment to walk to has two distinct ends")
        walker, obstacle = self._walker, self._at_boundary()
        here = walker.position
        awaited = Awaited(kinds_of(until), here, just_past)
        if not walker.boundary().closed:
            raise MoveError(
                "the border cuts this boundary, and no lap leads around it: use circle or walk_to"
            )
        if isinstance(target, Point) and target == here:
            return Halt(HaltKind.ARRIVED, target, self.at)
        decided = self._decided(reason)
        lap, self._lap = self._lap, None
        if lap is None or lap.after != walker.count or lap.forward is not (hand == "left"):
            lap = Lap(walker.boundary(), here, hand == "left")
        elif not lap.rest:
            if target is None:
                return Halt(HaltKind.ROUND, here, self.at)
            lap = Lap(walker.boundary(), here, lap.forward)
        self._lap = lap
        self._explain(decided)
        while lap.rest:
            ends_here, curve = lap.next(target)
            sighting = self._walk_along(Piece("boundary", obstacle, curve), awaited)
            lap.walked(walker.position, walker.count)
            if not lap.rest:
                walker.visit()
            if sighting is not None:
                return Halt(HaltKind.EVENT, walker.position, self.at, sighting)
            self._lap = lap if lap.rest else None
            self._on_edge()
            if ends_here:
                return Halt(HaltKind.ARRIVED, walker.position, self.at)
        return Halt(HaltKind.ROUND, walker.position, self.at)

    @_move
    def walk_to(self, point: Point | Sequence[object], *, reason: Why = "") -> None:
        """Walk to a point of the present boundary, which is acquired, the shorter way: see `way_to`.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> _ = robot.take(robot.nearest_unvisited()), robot.circle(), robot.walk_to((7, 0))
        >>> robot.position
        Point(7, 0)
        """
        self._walk_to(Point.of(point), reason)

    def go_along(
        self,
        path: ShortestPath,
        *,
        until: EventKind | Collection[EventKind] = (),
        just_past: bool = False,
        reason: Why = "",
    ) -> Halt:
        """Go along a path from where the robot is (see `path_to`), piece by piece as `go_to` and `walk` do.

        It ends where the path does, or at the first place where an obstacle is in the way or what *until*
        says happens; the halt is that of the last piece. `MoveError` for a path that begins elsewhere; what
        the moves raise besides. Each piece counts as a move.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> _ = robot.take(robot.nearest_unvisited()), robot.circle()
        >>> halt = robot.go_along(robot.path_to((7, 1)))
        >>> print(halt.kind, halt.place, robot.length.decimal(6))
        arrived (7, 1) 20.9950
        """
        if not isinstance(path, ShortestPath):
            raise MoveError(f"a path is what robot.path_to gives, not {shown(path)}")
        if path.start is not self.position and path.start != self.position:
            raise MoveError("the path begins elsewhere")
        halt = Halt(HaltKind.ARRIVED, self.position, self.at)
        for piece in path.path:
            if isinstance(piece, Arc):
                if self.at is None:
                    # At a start on a boundary the robot only touches this.
                    self.go_to(self.position)
                hand = hand_along(path, piece)
                halt = self._round(piece.end, hand, until=until, just_past=just_past, reason=reason)
            else:
                halt = self.go_to(piece.end, until=until, just_past=just_past, reason=reason)
            if halt.kind is not HaltKind.ARRIVED:
                break
            reason = ""
        return halt

    @_move
    def circle(self, *, reason: Why = "") -> None:
        """Walk all around the present boundary, with the left hand at it. `MoveError` at no boundary.

        One that a border cuts is walked to the end on the left hand's way, then to the other one, where the
        robot stays; from an end it is walked to the other.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> _ = robot.go_to((3, 0)), robot.circle()
        >>> robot.visited, robot.map.acquired
        ((0,), (0,))
        """
        self._at_boundary()
        self._explain(self._decided(reason))
        self._walker.circumnavigate(self._on_edge)

    @_move
    def follow(self, route: Route, *, watch: Watch | None = None, reason: Why = "") -> Halt:
        """Follow a route to the end of its piece, or to the first place where it leads into an obstacle.

        The robot must be where it left the route. What *watch* is, a function, is asked where the robot sets
        out, and at each sighting on its way: see `Passage`. It answers with a point ahead on the way where
        the robot is to halt, unless it is asked again before, or with None. It cannot move the robot, which
        answers other questions as where it set out. At the end of a piece see `Route.turn`.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("squares"), radius=5)
        >>> route = robot.lay([(0, 0), (0, 8)])
        >>> halt = robot.follow(route, watch=lambda passage: xa.Point(0, 7) if passage.sighting else None)
        >>> print(halt.kind, halt.place, robot.follow(route).kind)
        stopped (0, 7) arrived
        """
        self._check_route(route)
        walker, here = self._walker, self.position
        crossing, over = route._coming(), route.piece >= len(route.pieces)
        target = here if over else route.pieces[route.piece].end if crossing is None else crossing.stop.point
        kind, decided = HaltKind.ARRIVED if crossing is None else HaltKind.HIT, self._decided(reason)
        try:
            if target != here and not self._go_along(Segment(here, target), watch, decided):
                kind = HaltKind.STOPPED
        finally:
            route._place = walker.position
        if kind is HaltKind.HIT and crossing is not None:
            node: Node = crossing.component.index
        elif walker.position is here:
            node = walker.at
        elif kind is HaltKind.ARRIVED and route._ends_at is not None and target is route.end:
            node = route._ends_at
        else:
            node = self._node_at(walker.position)
        return self._landed(kind, node, moved=walker.position is not here)

    @_move
    def take_up(self, route: Route, place: Exit, *, reason: Why = "") -> None:
        """Walk along the present boundary to a place where a route comes out of it, and go on from there.

        It is the shorter way: see `way_to`. `MoveError` if the place is not one of this obstacle, or behind
        the robot's place on the route.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("squares"))
        >>> route = robot.lay([(0, 0), (20, 0)])
        >>> while (halt := robot.follow(route)).kind == "hit":
        ...     robot.circle()
        ...     robot.take_up(route, next(robot.exits(route, halt.obstacle)))
        >>> robot.position, robot.visited
        (Point(20, 0), (0, 1))
        """
        self._check_owner(route)
        if not isinstance(place, Exit):
            raise MoveError(f"an exit is what robot.exits gives, not {shown(place)}")
        crossing = place._crossing
        if place._of is not route:
            raise MoveError("the place is not one of this route, or of this robot")
        if crossing.component.index != self._walker.at or crossing.number < route._next:
            raise MoveError("the place is not ahead at the obstacle where the robot is")
        self._walk_to(place.point, reason)
        route._take_up(crossing)

    @_move
    def take(self, link: KnownLink, *, reason: Why = "") -> Way:
        """Walk along the present boundary to where a link begins, and go along it.

        Of its equally short segments it takes the one with the shortest walk to its leave point, of those one
        to which the left hand leads, then the one with the lexicographically least leave point and hit point.
        `MoveError` if the link does not begin where the robot is, or is that of another robot.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> for obstacle in (0, 1):
        ...     way = robot.take(robot.nearest_unvisited())
        ...     robot.circle()
        >>> print(way.leave, way.hit, robot.length)
        (7, 0) (9, 0) 5 + 12*pi
        """
        if not isinstance(link, KnownLink):
            # That there is none is what `nearest_unvisited` often answers.
            raise MoveError(f"a link is what robot.links or robot.nearest_unvisited gives, not {shown(link)}")
        walker, known = self._walker, link._link
        self._check(link, known.source, "link begins")
        if known.source == START and self.position != self.start:
            raise MoveError("the link begins at the start, and the robot is somewhere else")
        leave, hit = self._nearest_segment(known)
        decided = self._decided(reason, link._nearest)
        if known.source == START:
            self._explain(decided)
        else:
            walker.walk_to(leave)
            why = {"occasion": Occasion.ADVANCE, "other": known.target, "decided": decided}
            self._trace.mark(EventKind.LEAVE, int(known.source), **why)
        walker.go_straight(known.target, hit)
        self._trace.mark(EventKind.HIT, known.target, occasion=Occasion.ADVANCE, other=known.source)
        return Way(leave, hit, link)

    @_move
    def go_back(self, way: Way, *, reason: Why = "") -> None:
        """Walk along the present boundary to where a way has ended, and go back to where it began.

        `MoveError` if the robot is not at the obstacle to which the way led, or if it would have to walk
        along a boundary of which parts are unknown.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("circles"))
        >>> _ = robot.go_back(robot.take(robot.nearest_unvisited()))
        >>> robot.position, robot.at
        (Point(0, 0), None)
        """
        if not isinstance(way, Way):
            raise MoveError(f"a way is what robot.take has returned, not {shown(way)}")
        walker, link = self._walker, way.link._link
        self._check(way.link, link.target, "way ends")
        decided = self._decided(reason)
        if walker.position != way.hit:
            self._walker_on_known_boundary().walk_to(way.hit)
        trace, back = self._trace, Occasion.BACKTRACK
        trace.mark(EventKind.LEAVE, link.target, occasion=back, other=link.source, decided=decided)
        walker.go_straight(link.source, way.leave)
        at = link.source if isinstance(link.source, int) else None
        trace.mark(EventKind.BACKTRACK, at, occasion=back, other=link.target)

    # -- how it is done ----------------------------------------------------------------------------

    @_move
    def _round(
        self, end: Point, hand: str, *, until: EventKind | Collection[EventKind], just_past: bool, reason: Why
    ) -> Halt:
        """Walk as a path leads: on from a lap's end too, and along a boundary that a border cuts."""
        walker, obstacle = self._walker, self._at_boundary()
        awaited = Awaited(kinds_of(until), walker.position, just_past)
        decided = self._decided(reason)
        with on_this_boundary():
            curves = walker.boundary().walk(walker.position, end, hand == "left")
        self._explain(decided)
        for curve in curves:
            sighting = self._walk_along(Piece("boundary", obstacle, curve), awaited)
            if sighting is not None:
                return Halt(HaltKind.EVENT, walker.position, self.at, sighting)
        return Halt(HaltKind.ARRIVED, walker.position, self.at)

    def _begin(self) -> None:
        if self._is_underway:
            raise MoveError("the robot is underway: what watches its way cannot move it")
        if self._walker.stuck is not None:
            raise copy(self._walker.stuck)
        self._moves += 1
        if self._moves > self._most:
            raise EnoughMoves

    def _decided(self, reason: Why, nearest: NearestLink | None = None) -> Decided | None:
        """What a strategy decides here, if it says so, or takes the nearest link that it was told of here."""
        if callable(reason):
            return partial(_numbered, reason, self._seen, self._walker.count)
        if reason:
            return _numbered(lambda: reason, self._seen, self._walker.count)
        return None if nearest is None or nearest.after != self._walker.count else nearest.decision

    def _explain(self, decided: Decided | None) -> None:
        """Tell what was decided, with the event that brought the robot here or with one of its own."""
        trace, at = self._trace, self._walker.at
        if decided is not None and not trace.explain(decided) and self._writes:
            trace.mark(EventKind.DECIDE, at if isinstance(at, int) else None, decided=decided)

    def _walk_to(self, point: Point, reason: Why) -> None:
        """Walk to a point of the present boundary, which is known."""
        (length, forward), decided = self._way_to(point), self._decided(reason)
        if length.sign() > 0:
            self._explain(decided)
        self._walker.walk_on(point, forward)

    def _set_off(self, decided: Decided | None) -> None:
        """Tell what was decided; if the robot is at a boundary, with writing that it leaves this."""
        if self._writes and self._walker.at != START:
            self._trace.mark(EventKind.LEAVE, int(self._walker.at), decided=decided)
        else:
            self._explain(decided)

    def _landed(
        self, kind: HaltKind, node: Node, sighting: Sighting | None = None, moved: bool = True
    ) -> Halt:
        """How a straight move has ended, and at which obstacle."""
        walker = self._walker
        is_new, walker.at = moved or walker.at != node, node
        if self._writes and is_new and node != START:
            self._trace.mark(EventKind.HIT, int(node))
        return Halt(kind, walker.position, self.at, sighting)

    def _go_along(self, way: Segment, watch: Watch | None, decided: Decided | None) -> bool:
        """Go a free way with distinct ends; False if *watch* stops the robot before."""
        walker, numbers = self._walker, self._seen.numbers
        count, self._is_underway = len(numbers.order), watch is not None
        self._seen.is_held = True
        try:
            lookout = None if watch is None else Lookout(way, watch, walker, numbers)
            for part in walker.memory.parts(way):
                piece = Piece("straight", None, part)
                stop = None if lookout is None else lookout.stop_on(piece)
                if stop is not None:
                    if not part.passes(stop):
                        raise MoveError(f"{stop} is not on the way")
                    piece = Piece("straight", None, Segment(walker.position, stop))
                    walker.memory.shorten(piece)
                if stop is None or stop != walker.position:
                    if walker.position is way.start:
                        self._set_off(decided)
                    walker.move(piece)
                if lookout is not None:
                    walker.sense()
                if stop is not None:
                    return False
            return True
        except BaseException:
            # What was passed on a way that was not walked was not seen.
            numbers.cut(count)
            raise
        finally:
            self._is_underway = self._seen.is_held = False

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

    def _walk_along(self, piece: Piece, awaited: Awaited) -> Sighting | None:
        """Walk a piece, or until what is awaited, which is returned."""
        if awaited.kinds:
            for part in self._walker.memory.divided(piece):
                sighting = self._walk_until(part, awaited)
                if sighting is not None:
                    return sighting
            return None
        self._walker.move(piece)
        return None

    def _walk_until(self, piece: Piece, awaited: Awaited) -> Sighting | None:
        """Walk a piece that is one leg, or until what is awaited."""
        walker, found = self._walker, None
        ahead = walker.memory.ahead(piece)
        leg, own = ahead.leg, dict(self._own)
        for k, notice in enumerate(ahead.notices):
            number = own.setdefault(notice.obstacle, len(own))
            if notice.kind not in awaited.kinds:
                continue
            is_at_start = leg.order(notice.u, leg.first) == 0
            if is_at_start and walker.position is awaited.start:
                continue
            found = Sighting(notice.kind, number, notice.place, notice.reason)
            if is_at_start:
                # What was in sight to the end of the leg before is lost as this one begins.
                return found
            if leg.order(notice.u, leg.last) < 0:
                place = notice.place
                if awaited.just_past:
                    later = (n.u for n in ahead.notices[k:] if leg.order(notice.u, n.u) < 0)
                    place = leg.just_past(notice.u, next(later, leg.last))
                piece = Piece(piece.kind, piece.obstacle, piece.curve.part(piece.start, place))
                walker.memory.shorten(piece)
            break
        walker.move(piece)
        return found


def _numbered(reason: Callable[[], str | Decision], seen: Sightings, after: int) -> Decision:
    """What a strategy decides, with the scene's numbers, after so many pieces of the path."""
    made = reason()
    decision = made if isinstance(made, Decision) else Decision(made)
    return decision.numbered(seen.numbers.order, after)
