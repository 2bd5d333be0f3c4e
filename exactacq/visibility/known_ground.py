"""What a shortest path has to respect: the obstacles of a scene, or what a map tells of them.

On a map, obstacles that are wholly known are those of a scene. Of the others the known parts of boundaries
are chains (`exactacq.visibility.known_chains`), and what is not known to be an obstacle counts as free: the
*free-space assumption* (S. Koenig and Y. Smirnov, "Sensor-based planning with the freespace assumption",
ICRA 1997). So more knowledge never makes a path shorter.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import ClassVar, Protocol, runtime_checkable
from weakref import WeakKeyDictionary

from exactacq.cached import cached_property
from exactacq.errors import FormatError, shown
from exactacq.geometry.curves import Curve
from exactacq.scene.scene import Obstacle, Scene
from exactacq.scene.shapes import Shape
from exactacq.scene.terrain_components import Component
from exactacq.visibility.chain_table import ChainTable
from exactacq.visibility.known_chains import ChainPart, KnownChain, known_chains
from exactacq.visibility.pegs import Pegs
from exactacq.visibility.scene_tables import SceneTables
from exactacq.visibility.tangents import Tangents


@runtime_checkable
class Charted(Protocol):
    """A map: the boundaries that it is of, by numbers, and what is known of them."""

    @property
    def obstacles(self) -> Sequence[object]: ...
    @property
    def seen(self) -> tuple[int, ...]: ...
    @property
    def acquired(self) -> tuple[int, ...]: ...
    def known(self, i: int, /) -> Sequence[ChainPart]: ...


@runtime_checkable
class Grounded(Protocol):
    """What tells by itself what a path has to respect."""

    @property
    def _known_ground(self) -> KnownGround: ...


class KnownGround:
    """Obstacles, as a scene, and chains. ``numbers`` on the map are those of obstacles, then of chains."""

    _made: ClassVar[WeakKeyDictionary[Charted, KnownGround]] = WeakKeyDictionary()

    def __init__(
        self, scene: Scene, chains: Sequence[KnownChain] = (), numbers: Sequence[int] | None = None
    ) -> None:
        self.scene, self.chains = scene, tuple(chains)
        solid = range(len(scene.obstacles)) if numbers is None else numbers
        self.numbers = (*solid, *(chain.obstacle for chain in chains))

    @classmethod
    def of(cls, place: Scene | Charted | Grounded | KnownGround) -> KnownGround:
        """That of a scene or a map; `FormatError` for anything else. Of a map it is made once."""
        if isinstance(place, KnownGround):
            return place
        if isinstance(place, Scene):
            return cls(place)
        if isinstance(place, Grounded):
            return place._known_ground
        if not isinstance(place, Charted):
            raise FormatError(f"a scene or a map, not {shown(place)}")
        if place not in cls._made:
            cls._made[place] = cls.on_map(place)
        return cls._made[place]

    @classmethod
    def on_map(
        cls,
        chart: Charted,
        *,
        number: Callable[[int], int] = int,
        known: KnownGround | None = None,
    ) -> KnownGround:
        """That of a map; *known* is what was known before, and is used again where no more is known.

        *number* tells other numbers of obstacles than those on the map. A terrain to which a robot is
        confined is convex, and paths do not turn around the ends of boundaries at its border: so they keep
        within it.
        """
        acquired, whole = set(chart.acquired), dict[int, Obstacle]()
        chains: list[KnownChain] = []
        for i in chart.seen:
            body = chart.obstacles[i]
            if i in acquired and (not isinstance(body, Component) or body.closed):
                whole[i] = body.obstacle if isinstance(body, Component) else _obstacle(body)
            else:
                chains += known_chains(number(i), chart.known(i), *_boundary(body))
        inner = {i: o for i, o in whole.items() if not o.is_enclosure}
        room = [i for i, o in whole.items() if o.is_enclosure]
        numbers = [number(i) for i in (*inner, *room)]
        if known is not None and numbers == list(known.numbers[: len(known.scene.obstacles)]):
            return cls(known.scene, chains, numbers)
        shapes = [_nameless(obstacle) for obstacle in inner.values()]
        scene = Scene(shapes, enclosure=_nameless(whole[room[0]]) if room else None)
        return cls(scene, chains, numbers)

    @property
    def walls(self) -> tuple[Curve, ...]:
        """The pieces of the chains."""
        return tuple(piece.curve for chain in self.chains for piece in chain.pieces)

    @cached_property
    def tangents(self) -> Tangents:
        """What is known of the free tangents of corners and arcs."""
        tables = SceneTables.of(self.scene)
        if not self.chains:
            return tables.tangents
        return Tangents(Pegs(ChainTable(tables.edges, self.chains), None))


def _obstacle(body: object) -> Obstacle:
    assert isinstance(body, Obstacle), "maps are of obstacles and components"
    return body


def _boundary(body: object) -> tuple[Sequence[Curve], bool, Sequence[Curve]]:
    """The edges of a boundary, whether it is a loop, and the edges of the scene that these are parts of."""
    if isinstance(body, Component):
        return body.edges, body.closed, [body.obstacle.edges[part.edge] for part in body.shore]
    edges = _obstacle(body).edges
    return edges, True, edges


def _nameless(obstacle: Obstacle) -> Shape:
    return replace(obstacle.shape, name=None)
