"""What a run leaves behind: path pieces, events, links, bounds, and the run itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from flint import fmpq

from exactacq.curves import Curve
from exactacq.lengths import Length
from exactacq.points import Point
from exactacq.scene import Scene


@dataclass(frozen=True)
class Piece:
    """One piece of the path: ``kind`` "straight", or "boundary" along ``obstacle``."""

    kind: str
    obstacle: int | None
    curve: Curve

    @property
    def start(self) -> Point:
        """Where the piece begins."""
        return self.curve.start

    @property
    def end(self) -> Point:
        """Where the piece ends."""
        return self.curve.end

    @property
    def length(self) -> Length:
        """Exact length."""
        return self.curve.length

    def point(self, u: object) -> Point:
        """The point at rational parameter *u* in [0, 1] of the curve."""
        return self.curve.point(u)


class Path(tuple[Piece, ...]):
    """The pieces in order, each starting where the one before ends."""

    __slots__ = ()

    def length_after(self, count: int) -> Length:
        """Length of the first *count* pieces; linear in *count*."""
        return Length.sum(piece.length for piece in self[:count])


@dataclass(frozen=True)
class Event:
    """Something that happened after the first ``after`` pieces of the path.

    Kinds of the Sightseer: start, hit, leave, backtrack, stop. Events are ordered by ``after``, then as
    they happened.
    """

    kind: str
    point: Point
    obstacle: int | None
    note: str
    after: int
    path: Path = field(repr=False, compare=False)

    @property
    def at(self) -> Length:
        """Path length so far, summed on demand."""
        return self.path.length_after(self.after)


@dataclass(frozen=True)
class TreeLink:
    """An edge of the tree that the run walked: from ``leave`` on ``source`` ("S": the start) to ``hit``."""

    source: int | str
    target: int
    leave: Point
    hit: Point
    length: Length
    traversals: int


@dataclass(frozen=True)
class Bound:
    """An upper bound of the path's length, evaluated exactly.

    ``holds`` compares exactly; ``ratio`` is the path's length over the value (NaN where the value is 0).
    """

    name: str
    source: str
    value: Length
    holds: bool
    ratio: float


@dataclass(frozen=True)
class Run:
    """A finished exploration. See the fields' types for what each entry holds.

    ``unseen`` obstacles never came on the map and ``unvisited`` ones did without being reached: both are
    empty where the paper's model (a) holds for the radius.
    """

    scene: Scene
    radius: fmpq
    strategy: str
    start: Point
    path: Path
    visits: tuple[int, ...]
    links: tuple[TreeLink, ...]
    events: tuple[Event, ...]
    bounds: tuple[Bound, ...]
    unseen: tuple[int, ...]
    unvisited: tuple[int, ...]
    stack_depth: int

    @cached_property
    def length(self) -> Length:
        """Exact length of the path."""
        return self.path.length_after(len(self.path))

    @property
    def complete(self) -> bool:
        """Whether every obstacle was visited."""
        return not self.unseen and not self.unvisited

    @property
    def incomplete(self) -> tuple[int, ...]:
        """The obstacles on the map that were not circumnavigated.

        Visited ones are acquired; whether an unvisited one was seen all around from afar is not tracked.
        """
        return self.unvisited

    def _repr_svg_(self) -> str:
        from exactacq.figures import svg

        return svg(self)

    def to_json(self) -> dict[str, Any]:
        """The run as JSON data with exact numbers; `exactacq.load_run` reads it back."""
        from exactacq.run_json import run_to_json

        return run_to_json(self)

    def names(self) -> Iterator[str]:
        """The obstacles' names, "O" and the number from 1 where none is given."""
        for obstacle in self.scene.obstacles:
            yield obstacle.name or ("wall" if obstacle.is_enclosure else f"O{obstacle.index + 1}")
