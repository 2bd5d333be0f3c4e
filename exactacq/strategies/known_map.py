"""What a robot tells of boundaries: of those that it has seen what it has seen, and nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from exactacq.geometry.curves import Curve
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.event import EventKind, Reason
from exactacq.sensing.map import Map
from exactacq.strategies.seed_spreader.range_thresholds import nearest_of, nearest_point


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

    def __init__(self, _map: Map, _numbers: Sequence[int]) -> None:
        self._map, self._numbers = _map, tuple(_numbers)

    def __repr__(self) -> str:
        return f"<KnownMap: {len(self.seen)} obstacles seen, {len(self.acquired)} acquired>"

    @property
    def seen(self) -> tuple[int, ...]:
        """Obstacles with a known point."""
        return tuple(range(len(self._numbers)))

    @cached_property
    def incomplete(self) -> tuple[int, ...]:
        """Obstacles of whose boundary some but not all is known."""
        return tuple(i for i, k in enumerate(self._numbers) if self._map.is_incomplete(k))

    @cached_property
    def acquired(self) -> tuple[int, ...]:
        """Obstacles whose whole boundary is known."""
        left = set(self.incomplete)
        return tuple(i for i in self.seen if i not in left)

    @cached_property
    def frontier(self) -> tuple[tuple[int, Point], ...]:
        """Where known boundary ends and nothing beyond is known: (obstacle, point), obstacle by obstacle."""
        own = {k: i for i, k in enumerate(self._numbers)}
        return tuple(sorted(((own[k], p) for k, p in self._map.frontier), key=lambda end: end[0]))

    def known(self, i: int) -> tuple[KnownPart, ...]:
        """The known parts of an obstacle; none is beyond a vertex. ValueError for one that was not seen.

        >>> import exactacq as xa
        >>> [str(part.length) for part in xa.Robot(xa.load("circles")).map.known(0)]
        ['2*acos(-17/25)']
        """
        parts = self._map.known(self._number(i))
        return tuple(KnownPart(i, part.start, part.end, part.curve) for part in parts)

    def known_length(self, i: int | None = None) -> Length:
        """Exact length of what is known of an obstacle, or of all. ValueError for one that was not seen.

        >>> import exactacq as xa
        >>> print(xa.Robot(xa.load("circles")).map.known_length())
        2*acos(-17/25)
        """
        numbers: Iterable[int] = self._numbers if i is None else (self._number(i),)
        return Length.sum(self._map.known_length(k) for k in numbers)

    def knows(self, point: Point | Sequence[object]) -> bool:
        """Whether a point lies on known boundary: False for any other, on a boundary or not.

        >>> import exactacq as xa
        >>> known = xa.Robot(xa.load("circles")).map
        >>> known.knows((3, 0)), known.knows((7, 0)), known.knows((0, 0))
        (True, False, False)
        """
        place = Point.of(point)
        return any(self._map.knows_some(self._map.spots(k, place)) for k in self._numbers)

    def nearest(self, i: int, place: Point | Sequence[object]) -> Point:
        """The known point of an obstacle nearest to a place; of several the lexicographically least.

        ValueError for an obstacle that was not seen.

        >>> import exactacq as xa
        >>> print(xa.Robot(xa.load("circles")).map.nearest(0, (0, 0)))
        (3, 0)
        """
        spot = Point.of(place)
        curves = [(part.start, part.curve) for part in self.known(i)]
        return nearest_of([start if c is None else nearest_point(c, spot) for start, c in curves], spot)

    def _number(self, i: int) -> int:
        if i not in range(len(self._numbers)):
            raise ValueError(f"no obstacle {i!r} was seen yet")
        return self._numbers[i]
