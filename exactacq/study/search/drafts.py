"""A scene on the drawing board: rational data that can be changed number by number, not yet validated."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.scene_json import scene_text
from exactacq.numbers.rationals import nearest_float
from exactacq.scene.bends import Around
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon, Shape, Terrain, Vertex

Pair = tuple[fmpq, fmpq]


class Seat(NamedTuple):
    """A start on a boundary: obstacle, edge, and how far along it, from 0 to less than 1.

    The share is 0 on arcs and circles, that is, their start.
    """

    obstacle: int
    edge: int
    share: fmpq


@dataclass(frozen=True)
class Draft:
    """Shapes, the radius of vision, a start or the seat of one, and the terrain's sides and SW corner.

    A start that sits on a boundary goes where the boundary goes. A draft may break the rules of scenes:
    `scene` finds out.
    """

    shapes: tuple[Shape, ...]
    radius: fmpq
    start: Pair | None = None
    seat: Seat | None = None
    size: Pair | None = None
    origin: Pair = (fmpq(0), fmpq(0))

    @classmethod
    def of(cls, scene: Scene) -> Draft:
        """The draft of a scene; `FormatError` without a radius, or with an enclosure."""
        if scene.radius is None:
            raise FormatError("the scene has no radius of vision")
        if scene.enclosure is not None:
            raise FormatError("the scene has an enclosure: scenes are searched without")
        if any(isinstance(bend, Around) for shape in scene.shapes for bend in bends(shape)):
            raise FormatError("the scene has an arc without a rational bulge: scenes are searched without")
        start = None if scene.start is None else scene.start.rational
        terrain = scene.terrain
        seat = None if start is None or terrain is not None else _seat(scene.shapes, start)
        draft = cls(scene.shapes, scene.radius, start if seat is None else None, seat)
        if terrain is None:
            return draft
        return replace(draft, size=(terrain.width, terrain.height), origin=terrain.origin)

    def scene(self, name: str | None = None) -> Scene:
        """The scene; `InvalidScene` if it breaks a rule."""
        terrain = None if self.size is None else Terrain(*self.size, self.origin)
        return Scene(self.shapes, self.place, terrain=terrain, radius=self.radius, name=name)

    def text(self, name: str | None = None) -> str:
        """The scene file of a draft, valid or not, as `exactacq.load` reads it."""
        terrain = None if self.size is None else Terrain(*self.size, self.origin)
        return scene_text(self.shapes, self.place, self.radius, terrain, name)

    @property
    def place(self) -> Pair | None:
        """Where the start is."""
        if self.seat is None:
            return self.start
        shape, share = self.shapes[self.seat.obstacle], self.seat.share
        if isinstance(shape, Circle):
            return shape.center[0] + shape.radius, shape.center[1]
        count = len(shape.vertices)
        (x, y, _), (u, v, _) = (shape.vertices[(self.seat.edge + k) % count] for k in (0, 1))
        return x + (u - x) * share, y + (v - y) * share

    @property
    def edges(self) -> int:
        """The number of edges of all shapes."""
        return sum(1 if isinstance(s, Circle) else len(s.vertices) for s in self.shapes)

    @property
    def extent(self) -> float:
        """The larger side of the box around everything, in floats; 1 for nothing."""
        points = [p for shape in self.shapes for p in corners(shape)]
        points += [p for p in (self.place, self.size) if p is not None]
        sides = (max(c) - min(c) for c in zip(*points, strict=True)) if points else ()
        return max((nearest_float(side) for side in sides), default=0.0) or 1.0

    @property
    def digits(self) -> int:
        """The number of digits of all numerators and denominators."""
        return sum(len(str(abs(v.p))) + len(str(v.q)) for v in self.numbers())

    def replaced(self, k: int, shape: Shape) -> Draft:
        """With another shape in place of number *k*; a seat on it that is lost moves to its first vertex."""
        shapes = (*self.shapes[:k], shape, *self.shapes[k + 1 :])
        draft = replace(self, shapes=shapes)
        if self.seat is None or self.seat.obstacle != k:
            return draft
        if isinstance(shape, Circle) or self.seat.edge >= len(shape.vertices):
            return replace(draft, seat=Seat(k, 0, fmpq(0)))
        return draft

    def without(self, k: int) -> Draft | None:
        """Without shape number *k*; a start that sat on it sits on the first one left. None if none is."""
        shapes = self.shapes[:k] + self.shapes[k + 1 :]
        seat = self.seat
        if seat is not None:
            if not shapes:
                return None
            seat = (
                Seat(0, 0, fmpq(0))
                if seat.obstacle == k
                else seat._replace(obstacle=seat.obstacle - (seat.obstacle > k))
            )
        return replace(self, shapes=shapes, seat=seat)

    def numbers(self) -> Iterator[fmpq]:
        """All numbers, in the order in which `mapped` goes through them."""
        for shape in self.shapes:
            if isinstance(shape, Circle):
                yield from (*shape.center, shape.radius)
            else:
                yield from (value for vertex in shape.vertices for value in vertex)
        yield self.radius
        yield from self.start or ()
        yield from () if self.seat is None else (self.seat.share,)
        yield from self.size or ()

    def mapped(self, change: Callable[[int, str, fmpq], fmpq]) -> Draft:
        """Every number changed; *change* gets the shape's number (-1: none), what it is, and its value.

        Kinds are "x", "y", "bulge", "size" (a circle's radius), "radius", "share", "width" and "height".
        """
        shapes = tuple(_mapped(shape, k, change) for k, shape in enumerate(self.shapes))
        start = self.start and (change(-1, "x", self.start[0]), change(-1, "y", self.start[1]))
        seat = self.seat and self.seat._replace(share=change(-1, "share", self.seat.share))
        size = self.size and (change(-1, "width", self.size[0]), change(-1, "height", self.size[1]))
        radius = change(-1, "radius", self.radius)
        return Draft(shapes, radius, start, seat, size, self.origin)


def corners(shape: Shape) -> list[Pair]:
    """The vertices, or the corners of the box around a circle."""
    if isinstance(shape, Circle):
        (x, y), r = shape.center, shape.radius
        return [(x - r, y - r), (x + r, y + r)]
    return [(x, y) for x, y, _ in shape.vertices]


def bends(shape: Shape) -> list[Any]:
    """How the edges bend; a circle's do not say. In a draft these are all bulges."""
    return [] if isinstance(shape, Circle) else [bend for _, _, bend in shape.vertices]


def is_convex(shape: Shape) -> bool:
    """Whether a valid shape is convex: circle, polygon that turns in one sense only, or lens of two arcs.

    Other outlines with arcs are not looked into, and count as not convex.
    """
    if isinstance(shape, Circle):
        return True
    vertices = shape.vertices
    turns = []
    for k in range(len(vertices)):
        (a, b, _), (c, d, _), (e, f, _) = (vertices[k - i] for i in (2, 1, 0))
        turns.append((c - a) * (f - d) - (d - b) * (e - c))
    bulges = bends(shape)
    if all(bulge == 0 for bulge in bulges):
        return all(t >= 0 for t in turns) or all(t <= 0 for t in turns)
    # With larger bulges on one side the arcs make a dent where they meet: the angles add up to more than pi.
    return len(vertices) == 2 and 0 < bulges[0] * bulges[1] <= 1


def rebuilt(shape: Shape, vertices: tuple[Vertex, ...]) -> Shape:
    """A loop of the same kind and name with other vertices."""
    assert not isinstance(shape, Circle)
    if any(bulge for _, _, bulge in vertices):
        return Outline(vertices, shape.name)
    return Polygon([v[:2] for v in vertices], shape.name)


def _mapped(shape: Shape, k: int, change: Callable[[int, str, fmpq], fmpq]) -> Shape:
    if isinstance(shape, Circle):
        (x, y), size = shape.center, shape.radius
        return Circle((change(k, "x", x), change(k, "y", y)), change(k, "size", size), shape.name)
    vertices = tuple(
        (change(k, "x", x), change(k, "y", y), change(k, "bulge", b)) for x, y, b in shape.vertices
    )
    return rebuilt(shape, vertices)


def _seat(shapes: tuple[Shape, ...], start: Pair) -> Seat | None:
    """Where a point sits on a boundary, if it does on a straight edge, a vertex or a circle's east point."""
    x, y = start
    for k, shape in enumerate(shapes):
        if isinstance(shape, Circle):
            if (x, y) == (shape.center[0] + shape.radius, shape.center[1]):
                return Seat(k, 0, fmpq(0))
            continue
        for edge, ((a, b, bulge), (c, d, _)) in enumerate(
            zip(shape.vertices, (*shape.vertices[1:], shape.vertices[0]), strict=True)
        ):
            along, across = (x - a) * (c - a) + (y - b) * (d - b), (x - a) * (d - b) - (y - b) * (c - a)
            size = (c - a) ** 2 + (d - b) ** 2
            if (x, y) == (a, b) or (bulge == 0 and across == 0 and 0 <= along < size):
                return Seat(k, edge, along / size)
    return None
