"""What all views and paths of a scene share: its edges as a table, and who is around a point."""

from __future__ import annotations

from collections.abc import Iterable
from typing import ClassVar
from weakref import WeakKeyDictionary, ref

from exactacq.cached import cached_property
from exactacq.errors import InvalidScene, about
from exactacq.geometry.points import Location, Point
from exactacq.kernel.box_tree import BoxNode, box_tree
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.scene import Obstacle, Scene, as_scene
from exactacq.scene.validation import place_flaws, place_text
from exactacq.visibility.pegs import Pegs, is_within
from exactacq.visibility.tangents import Tangents


class SceneTables:
    """What is made of a scene when it is first needed; kept as long as the scene itself."""

    _known: ClassVar[WeakKeyDictionary[Scene, SceneTables]] = WeakKeyDictionary()
    _last: ClassVar[tuple[ref[Scene], ref[SceneTables]] | None] = None
    """The scene that was asked for last: mostly it is asked for again."""

    def __init__(self, scene: Scene) -> None:
        self.obstacles = scene.obstacles
        self.edges, self._terrain = EdgeTable(scene.obstacles), scene.terrain

    @classmethod
    def of(cls, scene: Scene) -> SceneTables:
        """The tables of a scene, made at the first call; `FormatError` for what is none."""
        if (last := cls._last) is not None and last[0]() is scene and (found := last[1]()) is not None:
            return found
        known = cls._known.get(as_scene(scene))
        if known is None:
            known = cls._known[scene] = cls(scene)
        cls._last = ref(scene), ref(known)
        return known

    @cached_property
    def _hulls(self) -> BoxNode:
        """The boxes of the obstacles, to find those at a point."""
        return box_tree([(x0, y0, x1, y1) for x0, y0, x1, y1 in self.edges.hulls.tolist()])

    @cached_property
    def tangents(self) -> Tangents:
        """What is known of the free tangents of corners and arcs."""
        return Tangents(Pegs(self.edges, self._terrain))

    def around(self, point: Point) -> list[tuple[Location, Obstacle]]:
        """The obstacles that a point lies inside of or on; only those whose box holds it, and the enclosure,
        are asked."""
        x, y = point.xy
        near = self._hulls.near((x, y, x, y), 16 * self.edges.roundoff_at((x, y)))
        last = len(self.obstacles) - 1
        if self.obstacles and self.obstacles[last].is_enclosure and last not in near:
            near.append(last)
        asked = (self.obstacles[k] for k in near)
        return [(where, o) for o in asked if (where := o.locate(point)) is not Location.OUTSIDE]


def point_flaws(name: str, place: Point, around: Iterable[tuple[Location, Obstacle]]) -> list[str]:
    """Why a point, or what its name is, with such obstacles around it is not in free space."""
    blocked = [obstacle for where, obstacle in around if where is Location.INSIDE]
    sides = ["outside the wall" if o.is_enclosure else f"inside obstacle {o.label}" for o in blocked]
    return [f"the {name} {place_text(place)} lies {side}" for side in sides]


def place_in(scene: Scene, name: str, point: object) -> Point:
    """A point of free space; `FormatError` or `InvalidScene` otherwise, with the point's name."""
    with about(name):
        place = Point.of(point)  # type: ignore[arg-type]
    if far := list(place_flaws(name, place)):
        raise InvalidScene(far)
    flaws = [f"{name}: {flaw}" for flaw in point_flaws("point", place, SceneTables.of(scene).around(place))]
    if not is_within(place, scene.terrain):
        flaws.append(f"{name}: the point {place_text(place)} lies outside the terrain")
    if flaws:
        raise InvalidScene(flaws)
    return place
