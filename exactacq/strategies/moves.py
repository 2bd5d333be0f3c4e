"""How the moves of a robot end, the ways that it knows, and what it is shown on its way."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple, TypeAlias

from flint import fmpq

from exactacq.errors import shown
from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.event import SENSED, EventKind
from exactacq.strategies.known_links import NearestLink
from exactacq.strategies.known_map import KnownMap, Sighting
from exactacq.strategies.sightings import Sightings
from exactacq.visibility.links import Link
from exactacq.visibility.shortest_path import ShortestPath

HALF = fmpq(1, 2)


class HaltKind(StrEnum):
    """Why a move ended."""

    ARRIVED = "arrived"
    """The robot is where it was to go."""
    HIT = "hit"
    """An obstacle is in the way: the robot stands on its boundary."""
    EVENT = "event"
    """What the robot was to look out for happened here."""
    ROUND = "round"
    """The robot has walked all around, and is back where this lap began."""
    STOPPED = "stopped"
    """What watched the way has stopped the robot here."""


@dataclass(frozen=True)
class Halt:
    """How a move ended: why, where, at which obstacle (None in free space), and at which sighting, if at one.

    >>> import exactacq as xa
    >>> halt = xa.Robot(xa.load("squares")).go_to((5, 0))
    >>> print(halt.kind, halt.place, halt.obstacle)
    hit (2, 0) 0
    """

    kind: HaltKind
    place: Point
    obstacle: int | None
    sighting: Sighting | None = None


class Passage(NamedTuple):
    """What a robot that follows a route knows at a place that it passes.

    ``sighting`` is what it sees there, None where it sets out, and ``map`` its map, this sighting included.
    The map can be asked until the robot goes on.

    >>> import exactacq as xa
    >>> robot = xa.Robot(xa.load("squares"), radius=5)
    >>> def tell(passage):
    ...     print(passage.place, passage.sighting and str(passage.sighting.kind), passage.map.known_length())
    >>> halt = robot.follow(robot.lay([(0, 0), (0, 8)]), watch=tell)
    (0, 0) None 2
    (0, 1 + sqrt(21)) lose 4
    """

    place: Point
    sighting: Sighting | None
    map: KnownMap


Watch: TypeAlias = Callable[[Passage], Point | None]
"""Is shown the places of a way as the robot passes them, and answers where it is to halt, unless it is asked
again before; None lets it go on."""


@dataclass(frozen=True, eq=False, repr=False)
class KnownLink:
    """The shortest segment in sight from one boundary to another, or from the start, whose number is None.

    Robots make them.

    >>> import exactacq as xa
    >>> (link,) = xa.Robot(xa.load("squares")).links(None)
    >>> print(link.source, link.target, link.length)
    None 0 2
    """

    length: Length
    _of: Sightings
    _link: Link
    _nearest: NearestLink | None = None

    @property
    def source(self) -> int | None:
        """Where it begins."""
        return self._of.own(self._link.source)

    @property
    def target(self) -> int:
        """To which obstacle it leads."""
        return self._of.numbers.own[self._link.target]

    def __repr__(self) -> str:
        return f"KnownLink(source={self.source}, target={self.target}, length={self.length!r})"


@dataclass(frozen=True, eq=False, repr=False)
class Way:
    """A straight way that a robot has gone, from ``leave`` on ``source`` to ``hit`` on ``target``.

    >>> import exactacq as xa
    >>> robot = xa.Robot(xa.load("squares"))
    >>> way = robot.take(robot.nearest_unvisited())
    >>> print(way.leave, way.hit, way.length)
    (0, 0) (2, 0) 2
    """

    leave: Point
    hit: Point
    link: KnownLink

    @property
    def source(self) -> int | None:
        """From which obstacle, None for the start."""
        return self.link.source

    @property
    def target(self) -> int:
        """To which obstacle."""
        return self.link.target

    @property
    def length(self) -> Length:
        """How long it is."""
        return self.link.length

    def __repr__(self) -> str:
        ends = f"leave={self.leave!r}, hit={self.hit!r}"
        return f"Way(source={self.source}, target={self.target}, {ends}, length={self.length!r})"


class Awaited(NamedTuple):
    """What ends a move: a sighting of one of some kinds, but not where the robot sets out."""

    kinds: frozenset[EventKind]
    start: Point
    just_past: bool
    """Whether the robot goes a little farther, to a place with short numbers."""


class EnoughMoves(BaseException):
    """A robot was to move more often than it may. Not an `Exception`, so that no strategy goes on."""


def hand_along(path: ShortestPath, arc: Arc) -> str:
    """The hand on whose side the obstacle is where one goes along an arc of a path.

    What the path bends around is on its inner side. That is the obstacle, unless the path follows from behind
    what is known of a hollow arc: this was taken for a wall.
    """
    is_behind = any(
        isinstance(wall, Arc)
        and not wall.ccw
        and wall.radius_sq == arc.radius_sq
        and wall.center == arc.center
        and wall.contains(arc.point(HALF))
        for wall in path.walls
    )
    return "left" if arc.ccw != is_behind else "right"


def kinds_of(until: EventKind | Collection[EventKind]) -> frozenset[EventKind]:
    """Kinds of sightings that were given as one or several."""
    words = f"a robot looks out for {', '.join(SENSED)}, not for"
    if not isinstance(until, Collection):
        raise ValueError(f"{words} {shown(until)}")
    kinds = [until] if isinstance(until, str) else [*until]
    if others := [kind for kind in kinds if kind not in SENSED]:
        raise ValueError(f"{words} {', '.join(sorted(map(str, others)))}")
    return frozenset(map(EventKind, kinds))
