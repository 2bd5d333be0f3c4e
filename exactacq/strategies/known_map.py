"""What a robot tells of boundaries: of those that it has seen what it has seen, and nothing else."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence, Set
from dataclasses import dataclass
from typing import NamedTuple

from exactacq.cached import cached_property
from exactacq.errors import shown
from exactacq.geometry.curves import Curve
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.sensing.event import EventKind, Reason
from exactacq.sensing.map import Map
from exactacq.strategies.numbering import Numbering
from exactacq.strategies.routes import Route
from exactacq.strategies.seed_spreader.hulls import hull, overlap
from exactacq.strategies.seed_spreader.range_thresholds import leftmost, nearest_of, nearest_point
from exactacq.visibility.known_ground import KnownGround


@dataclass(frozen=True)
class KnownPart:
    """A part of the boundary of an obstacle, from ``start`` to ``end``, with the obstacle on its left.

    ``curve`` is a `Segment` or an `Arc`, None for a single point.

    >>> import exactacq as xa
    >>> part = xa.Robot(xa.load("squares")).map.known(0)[0]
    >>> print(part.obstacle, part.start, part.end, part.length)
    0 (2, 1) (2, -1) 2
    """

    obstacle: int
    start: Point
    end: Point
    curve: Curve | None

    @property
    def length(self) -> Length:
        """Exact length, 0 for a single point."""
        return Length(0) if self.curve is None else self.curve.length


class Sighting(NamedTuple):
    """That an obstacle came into sight, or went out of it, or is wholly known, and where the robot was.

    ``kind`` is one of the event kinds sight, regain, acquire and lose; ``reason`` tells why it was lost.

    >>> import exactacq as xa
    >>> seen = xa.Robot(xa.load("squares")).sightings[0]
    >>> print(seen.kind, seen.obstacle, seen.place)
    sight 0 (0, 0)
    """

    kind: EventKind
    obstacle: int
    place: Point
    reason: Reason | None


class KnownMap:
    """What a robot knew at one moment: which parts of which boundaries it had seen. Exact, and immutable.

    Obstacles have the robot's numbers: 0 is the one that it saw first. Nothing tells how many there are, or
    how a boundary goes on. See `Map` for what is seen, acquired and incomplete. Linear in the known parts.

    >>> import exactacq as xa
    >>> known = xa.Robot(xa.load("circles")).map
    >>> known.seen, known.acquired, known.incomplete
    ((0,), (), (0,))
    >>> print(*(point for _, point in known.frontier))
    (21/5, 2*sqrt(21)/5) (21/5, -2*sqrt(21)/5)
    """

    def __init__(
        self, _numbers: Numbering, _chart: Callable[[Set[int]], Map], _incomplete: Set[int] | None = None
    ) -> None:
        # A map that is right for some obstacles, by the scene's numbers; what is incomplete, if it is known.
        self._numbers, self._chart, self._count = _numbers, _chart, len(_numbers.order)
        self._incomplete = _incomplete
        self._charts: dict[int, Map] = {}
        self._parts: dict[int, tuple[KnownPart, ...]] = {}

    def __repr__(self) -> str:
        return f"<KnownMap: {len(self.seen)} obstacles seen, {len(self.acquired)} acquired>"

    @property
    def seen(self) -> tuple[int, ...]:
        """Obstacles with a known point."""
        return tuple(range(self._count))

    @cached_property
    def incomplete(self) -> tuple[int, ...]:
        """Obstacles of whose boundary some but not all is known."""
        if self._incomplete is not None:
            return tuple(sorted(self._incomplete))
        return tuple(i for i in self.seen if self.is_incomplete(i))

    @cached_property
    def acquired(self) -> tuple[int, ...]:
        """Obstacles whose whole boundary is known."""
        left = set(self.incomplete)
        return tuple(i for i in self.seen if i not in left)

    @cached_property
    def frontier(self) -> tuple[tuple[int, Point], ...]:
        """Where known boundary ends and nothing beyond is known: (obstacle, point), obstacle by obstacle."""
        numbers = {i: self._number(i) for i in self.incomplete}
        chart = self._chart(set(numbers.values()))
        return tuple((i, point) for i, k in numbers.items() for point in chart.ends(k))

    def is_incomplete(self, i: int) -> bool:
        """Whether not all of an obstacle is known. ValueError for one that was not seen.

        >>> import exactacq as xa
        >>> xa.Robot(xa.load("circles")).map.is_incomplete(0)
        True
        """
        if self._incomplete is None:
            chart, k = self._of(i)
            return chart.is_incomplete(k)
        self._number(i)
        return i in self._incomplete

    def known(self, i: int) -> tuple[KnownPart, ...]:
        """The known parts of an obstacle; none is beyond a vertex. ValueError for one that was not seen.

        >>> import exactacq as xa
        >>> [str(part.length) for part in xa.Robot(xa.load("circles")).map.known(0)]
        ['2*acos(-17/25)']
        """
        chart, k = self._of(i)
        if k not in self._parts:
            self._parts[k] = _parts(chart, k, self._numbers.own[k])
        return self._parts[k]

    def known_in(self, box: Sequence[float], *, but: Collection[int] = ()) -> tuple[KnownPart, ...]:
        """The known parts whose boxes meet a box (west, south, east, north), but for those of some obstacles.

        Of an arc the box around its circle counts. The order of obstacles is fixed for the scene. ValueError
        for what is no box. Linear in the known parts of the obstacles about there.

        >>> import exactacq as xa
        >>> known = xa.Robot(xa.load("squares")).map
        >>> len(known.known_in((0, 0, 9, 9))), len(known.known_in((0, 0, 1, 1)))
        (1, 0)
        """
        try:
            west, south, east, north = map(float, box)
            is_box = west <= east and south <= north
        except (TypeError, ValueError):
            is_box = False
        if not is_box:
            raise ValueError(f"a box is (west, south, east, north), not {shown(box)}")
        own, count = self._numbers.own, self._count
        some = [k for k in self._numbers.meeting(box) if own.get(k, count) < count and own[k] not in but]
        chart = self._chart(set(some))
        return tuple(part for k in some for part in _parts(chart, k, own[k]) if overlap(_hull(part), box))

    def known_length(self, i: int | None = None) -> Length:
        """Exact length of what is known of an obstacle, or of all. ValueError for one that was not seen.

        >>> import exactacq as xa
        >>> print(xa.Robot(xa.load("circles")).map.known_length())
        2*acos(-17/25)
        """
        some = [self._of(j) for j in (self.seen if i is None else (i,))]
        return Length.sum(chart.known_length(k) for chart, k in some)

    def knows(self, point: Point | Sequence[object]) -> bool:
        """Whether a point lies on known boundary: False for any other, on a boundary or not.

        >>> import exactacq as xa
        >>> known = xa.Robot(xa.load("circles")).map
        >>> known.knows((3, 0)), known.knows((7, 0)), known.knows((0, 0))
        (True, False, False)
        """
        place = Point.of(point)
        return any(chart.knows_some(chart.spots(k, place)) for chart, k in map(self._of, self.seen))

    def nearest(self, i: int, place: Point | Sequence[object]) -> Point:
        """The known point of an obstacle nearest to a place; of several the lexicographically least.

        ValueError for an obstacle that was not seen.

        >>> import exactacq as xa
        >>> print(xa.Robot(xa.load("circles")).map.nearest(0, (0, 0)))
        (3, 0)
        """
        nearest, _ = nearest_on(self.known(i), Point.of(place))
        return nearest

    def lies_west(self, i: int, x: object) -> bool:
        """Whether a known point of an obstacle lies west of the vertical line at an abscissa.

        ValueError for an obstacle that was not seen.

        >>> import exactacq as xa
        >>> known = xa.Robot(xa.load("circles")).map
        >>> known.lies_west(0, 3), known.lies_west(0, 4)
        (False, True)
        """
        # Asked first, as this spares the map.
        if not self._numbers.may_lie_west(self._number(i), Real(x)):
            return False
        ends = (part.start.x if part.curve is None else leftmost(part.curve) for part in self.known(i))
        return any(end.compare(x) < 0 for end in ends)

    def blocks(self, i: int, route: Route) -> bool:
        """Whether a known point of an obstacle is one where the rest of a route leads into it or out of it.

        The robot is taken to see at a point of a boundary whether a line that it knows crosses it there.
        ValueError for an obstacle that was not seen.

        >>> import exactacq as xa
        >>> robot = xa.Robot(xa.load("squares"))
        >>> [robot.map.blocks(0, robot.lay([(0, 0), end])) for end in ((9, 0), (0, 9))]
        [True, False]
        """
        k = self._number(i)
        ahead = route._ahead(k)
        if not ahead:
            return False
        chart, _ = self._of(i)
        return any(chart.knows_some(route._ashore(n, chart)) for n in ahead)

    def beside(self, i: int, end: Point | Sequence[object]) -> Point:
        """A known point of an obstacle with short coordinates, beside an end of its known boundary.

        They are no farther apart than a 64th of the known part, if that is straight. The end itself if it is
        a vertex, a single known point, or no end. ValueError for an obstacle that was not seen.

        >>> import exactacq as xa
        >>> known = xa.Robot(xa.load("circles")).map
        >>> print(known.frontier[0][1], known.beside(0, known.frontier[0][1]))
        (21/5, 2*sqrt(21)/5) (4570733/1100105, 1994094/1100105)
        """
        chart, k = self._of(i)
        return chart.beside(k, Point.of(end))

    @cached_property
    def _known_ground(self) -> KnownGround:
        """What a shortest path has to respect."""
        numbers = self._numbers.order[: self._count]
        own = {k: i for i, k in enumerate(numbers)}
        return KnownGround.on_map(self._chart(set(numbers)), number=own.__getitem__)

    def _of(self, i: int) -> tuple[Map, int]:
        """A map that is right for an obstacle, and its number there."""
        k = self._number(i)
        if k not in self._charts:
            self._charts[k] = self._chart({k})
        return self._charts[k], k

    def _number(self, i: int) -> int:
        return self._numbers.scene_number(i, self._count)


def nearest_on(parts: Sequence[KnownPart], place: Point) -> tuple[Point, Curve | None]:
    """The point of some parts nearest to a place, of several the lexicographically least, with its curve."""
    points = [part.start if part.curve is None else nearest_point(part.curve, place) for part in parts]
    nearest = nearest_of(points, place)
    return nearest, next(part.curve for p, part in zip(points, parts, strict=True) if p is nearest)


def _parts(chart: Map, k: int, i: int) -> tuple[KnownPart, ...]:
    """The known parts of an obstacle with one number on a map, which gets another."""
    return tuple(KnownPart(i, part.start, part.end, part.curve) for part in chart.known(k))


def _hull(part: KnownPart) -> tuple[float, ...]:
    return (*part.start.xy, *part.start.xy) if part.curve is None else hull(part.curve)
