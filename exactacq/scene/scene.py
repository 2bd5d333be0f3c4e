"""Scenes: obstacles with exact boundaries, an optional enclosure and terrain, and the start."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from flint import fmpq

from exactacq.cached import cached_property
from exactacq.errors import FormatError, InvalidScene, about, shown, without_controls
from exactacq.geometry.boundary_index import BoundaryIndex
from exactacq.geometry.box_index import DIRECTIONS
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.geo import Geo, collection, feature
from exactacq.geometry.intersections import spans
from exactacq.geometry.loops import locate, signed_area
from exactacq.geometry.points import Location, Point
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.scene.ports import SVG, made
from exactacq.scene.shapes import Circle, Corners, Loop, Polygon, Shape, Terrain, as_name, shape_edges
from exactacq.scene.validation import sensor_flaws, validate


class Obstacle:
    """An obstacle of a scene, or its enclosure, by its boundary.

    ``edges`` has the blocked side on the left: an obstacle's boundary runs counterclockwise, an enclosure's
    clockwise, in whichever sense the shape was given. ``edges[0]`` starts at the shape's first vertex. A
    circle is one full arc from its east point. Obstacles are compared by identity and never change.

    >>> import exactacq as xa
    >>> obstacle = xa.Scene([xa.Circle((0, 0), 3, name="pillar")]).obstacles[0]
    >>> print(obstacle.label, obstacle.perimeter, obstacle.area)
    pillar 6*pi 9*pi
    """

    def __init__(self, index: int, shape: Shape, edges: Sequence[Curve], is_enclosure: bool = False) -> None:
        self.index, self.shape, self.is_enclosure = index, shape, is_enclosure
        self.name, self.closed = shape.name, True
        self.edges = tuple(edges)

    @classmethod
    def of(cls, index: int, shape: Shape, is_enclosure: bool = False) -> Obstacle:
        """An obstacle whose edges run in the sense in which the shape was given: see `oriented`."""
        return cls(index, shape, shape_edges(shape), is_enclosure)

    def oriented(self) -> Obstacle:
        """This loop, reversed if the blocked side is not on its left: the exact sign of the area decides."""
        if (signed_area(self.edges).sign() > 0) != self.is_enclosure:
            return self
        edges = tuple(edge.reversed() for edge in reversed(self.edges))
        return Obstacle(self.index, self.shape, edges, self.is_enclosure)

    @property
    def label(self) -> str:
        """The name as it is shown, or "O" and the number from 1."""
        return without_controls(self.name or "") or ("wall" if self.is_enclosure else f"O{self.index + 1}")

    @cached_property
    def perimeter(self) -> Length:
        """Length of the boundary."""
        return Length.sum(edge.length for edge in self.edges)

    @cached_property
    def area(self) -> Length:
        """Area of the obstacle; of the enclosure, the area of the room."""
        area = signed_area(self.edges)
        return -area if self.is_enclosure else area

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON Feature: the shape as a Polygon, with ``kind``, ``index`` and ``name`` (the label)."""
        kind = "enclosure" if self.is_enclosure else "obstacle"
        return feature(self.shape.__geo_interface__, kind=kind, index=self.index, name=self.label)

    def locate(self, point: Point) -> Location:
        """INSIDE if the point is strictly on the blocked side. Linear in the edges, in floats but for few."""
        near = [self.edges[k] for k in self._index.may_be_east(point)]
        return locate(near, point, ccw=not self.is_enclosure)

    def edges_at(self, point: Point) -> tuple[int, ...]:
        """The numbers of the edges that pass a point: none, one, or the two that meet in a vertex.

        >>> import exactacq as xa
        >>> square = xa.Scene([[(0, 0), (2, 0), (2, 2), (0, 2)]]).obstacles[0]
        >>> square.edges_at(xa.Point(1, 0)), square.edges_at(xa.Point(2, 0)), square.edges_at(xa.Point(1, 1))
        ((0,), (0, 1), ())
        """
        return tuple(k for k in self._index.may_pass(point) if self.edges[k].passes(point))

    @cached_property
    def _index(self) -> BoundaryIndex:
        return BoundaryIndex(self.edges)

    def __repr__(self) -> str:
        name = f" {self.name!r}" if self.name else ""
        kind = "enclosure" if self.is_enclosure else "obstacle"
        return f"<{kind} {self.index}{name}: {len(self.edges)} edges>"


class Scene:
    """A valid scene: disjoint obstacles, and where given a start, a terrain, an enclosure and a radius.

    *obstacles* are `Polygon`, `Outline` and `Circle` shapes, or whatever `Polygon` takes: lists of pairs,
    arrays, polygons of shapely; the same holds for *enclosure*. *start* is a pair of numbers or a `Point` in
    free space. *terrain* is the rectangle that the Seed Spreader sweeps; obstacles may cross its border.
    *enclosure* is a shape that contains everything: the wall of a room. *radius* is the robot's radius of
    vision, in the unit of the coordinates. *notes* are an importer's remarks to the user.

    ``obstacles`` are the `Obstacle` objects in the given order, the enclosure last; ``shapes`` and
    ``enclosure`` are the shapes. A scene is not changed once made. Raises `InvalidScene` with all violations
    found of the rules in `exactacq.scene.validation`, and `FormatError`, which names the part, for a value of
    the wrong kind. Cost: near linear in the number of edges. Scenes are equal if all that they were made of
    is.

    >>> Scene([Circle((5, 0), 2), Circle((12, 0), 3)], start=(0, 0), radius=20, name="two discs")
    <Scene 'two discs': 2 obstacles>
    >>> scene = Scene([[(1, 0), (2, 0), (2, 1)]], start=(0, 0))
    >>> for part in scene.__geo_interface__["features"]:
    ...     print(part["geometry"]["type"], part["properties"])
    Polygon {'kind': 'obstacle', 'index': 0, 'name': 'O1'}
    Point {'kind': 'start'}
    """

    def __init__(
        self,
        obstacles: Iterable[Shape | Corners] = (),
        start: Point | Sequence[object] | None = None,
        *,
        terrain: Terrain | None = None,
        enclosure: Shape | Corners | None = None,
        radius: object = None,
        name: str | None = None,
        notes: Iterable[str] = (),
    ) -> None:
        self.shapes = _shapes(obstacles)
        with about("start"):
            self.start = None if start is None else Point.of(start)
        if terrain is not None and not isinstance(terrain, Terrain):
            raise FormatError(f"terrain: give a Terrain(width, height), not {shown(terrain)}")
        self.terrain = terrain
        self.enclosure = None if enclosure is None else _shape("enclosure", enclosure)
        with about("radius"):
            self.radius: fmpq | None = None if radius is None else rational(radius)
        self.name, self.notes = as_name(name), tuple(notes)
        loops = [Obstacle.of(index, shape) for index, shape in enumerate(self.shapes)]
        if self.enclosure is not None:
            loops.append(Obstacle.of(len(loops), self.enclosure, is_enclosure=True))
        validate(loops, self.start, self.radius, self.terrain)
        self.obstacles = tuple(loop.oriented() for loop in loops)

    def replace(self, **parts: Any) -> Scene:
        """The scene with other parts: *parts* are named as those of `Scene`. Raises what `Scene` raises.

        >>> Scene([Circle((5, 0), 2)], start=(0, 0)).replace(radius=3, start=(1, 1)).start
        Point(1, 1)
        """
        known = {
            "start": self.start,
            "terrain": self.terrain,
            "enclosure": self.enclosure,
            "radius": self.radius,
            "name": self.name,
            "notes": self.notes,
        }
        return Scene(parts.pop("obstacles", self.shapes), **{**known, **parts})

    def meets_border(self) -> list[int]:
        """Indices of the obstacles, the enclosure aside, that are not strictly inside the terrain.

        Empty without a terrain. Linear in the number of edges.

        >>> Scene([Circle((1, 2), 1), Circle((5, 5), 2)], terrain=Terrain(8, 8)).meets_border()
        [0]
        """
        terrain = self.terrain
        if terrain is None:
            return []
        inner = (o for o in self.obstacles if not o.is_enclosure)
        return [o.index for o in inner if not all(_strictly_inside(edge, terrain) for edge in o.edges)]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return self is other or self._made_of == other._made_of

    def __hash__(self) -> int:
        """Cheap: views look up by the scene what they share. An irrational start would have no hash."""
        return hash((len(self.shapes), self.name))

    @property
    def _made_of(self) -> tuple[object, ...]:
        return self.shapes, self.start, self.terrain, self.enclosure, self.radius, self.name, self.notes

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON FeatureCollection: obstacles, then enclosure, terrain and start if there are such.

        The property ``kind`` says which. An obstacle has its ``index`` and ``name`` too, and the enclosure's
        Polygon is the room. Arcs are chords: see `exactacq.geometry.geo.FLATNESS`.
        """
        parts = [obstacle.__geo_interface__ for obstacle in self.obstacles]
        if self.terrain is not None:
            parts.append(feature(self.terrain.__geo_interface__, kind="terrain"))
        if self.start is not None:
            parts.append(feature(self.start.__geo_interface__, kind="start"))
        return collection(parts)

    def _repr_svg_(self) -> str:
        return str(made(SVG, self))

    def __repr__(self) -> str:
        name = f" {self.name!r}" if self.name else ""
        count = len(self.obstacles)
        return f"<Scene{name}: {count} obstacle{'' if count == 1 else 's'}>"


def radius_of(scene: Scene, radius: object, place: Point | None) -> fmpq:
    """The radius of vision from a place: the one given, or else the scene's own.

    Raises `InvalidScene` if there is none, if it is not positive, or if it or the place is too far out, and
    `FormatError` if it is no number.
    """
    with about("radius"):
        reach = scene.radius if radius is None else rational(radius)
    if reach is None:
        raise InvalidScene(["a radius of vision must be given"])
    if flaws := list(sensor_flaws(place, reach)):
        raise InvalidScene(flaws)
    return reach


def as_scene(value: Scene) -> Scene:
    """A scene as it is; `FormatError` for anything else, such as the name of one."""
    if not isinstance(value, Scene):
        raise FormatError(f"a scene is needed, not {shown(value)}; `load` makes one of a file or a name")
    return value


def start_of(scene: Scene, start: Point | Sequence[object] | None = None) -> Point:
    """The start that is given, or else the scene's own.

    Raises `InvalidScene` if there is none, if it has irrational coordinates, or if it is too far out, and
    `FormatError` if it is no point, or the scene none.
    """
    as_scene(scene)
    with about("start"):
        place = scene.start if start is None else Point.of(start)
    if place is None or place.rational is None:
        raise InvalidScene(["a start point with rational coordinates must be given"])
    if flaws := list(sensor_flaws(place, None)):
        raise InvalidScene(flaws)
    return place


def _shapes(values: Iterable[Shape | Corners]) -> tuple[Shape, ...]:
    if isinstance(values, Loop | Circle) or hasattr(values, "__geo_interface__"):
        raise FormatError("the obstacles are a list of shapes, not a single one: write [shape]")
    try:
        shapes = list(values)
    except TypeError:
        raise FormatError(f"the obstacles are a list of shapes, not {shown(values)}") from None
    return tuple(_shape(f"obstacle {index}", value) for index, value in enumerate(shapes))


def _shape(part: str, value: Shape | Corners) -> Shape:
    """A shape as it is; what gives the corners of one as a Polygon."""
    if isinstance(value, Loop | Circle):
        return value
    with about(part):
        return Polygon(value)


def _strictly_inside(edge: Curve, terrain: Terrain) -> bool:
    """Whether the whole edge lies strictly between the terrain's limits."""
    for wall, (x, y) in zip(map(Real, terrain.limits), DIRECTIONS, strict=True):
        sign = x + y
        for point in (edge.start, edge.end):
            if sign * (point.x if x else point.y).compare(wall) >= 0:
                return False
        if isinstance(edge, Arc) and spans(edge, (x, y)):
            room = (wall - (edge.center.x if x else edge.center.y)) * sign
            if room.sign() <= 0 or (room * room).compare(edge.radius_sq) <= 0:
                return False
    return True
