"""Rectangles about scenes: the terrain that holds all of one, and a room that is one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import ceil, floor, log2, log10

from flint import fmpq

from exactacq.errors import FormatError, InvalidScene, about
from exactacq.geometry.box_index import DIRECTIONS
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.intersections import spans
from exactacq.geometry.loops import signed_area
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Terrain, shape_edges

DIGITS = 6
"""An irrational extent is rounded outward, by less than 10^-DIGITS of an arc's radius or of a coordinate."""


def terrain_around(scene: Scene, margin: object = 0) -> Terrain:
    """The least terrain that holds all obstacles of a scene and its start, wider by *margin* on every side.

    That of the obstacles alone is the one around ``scene.replace(start=None)``. It is exact, but for arcs of
    irrational radius and irrational coordinates of a start, where it is too wide by less than 10^-6 of them.
    With a margin the SW corner, where the Seed Spreader starts, is free. Raises `InvalidScene` for a scene
    without obstacles, and `FormatError` if the margin is no number or negative. Linear in the edges.

    >>> import exactacq as xa
    >>> scene = xa.Scene([xa.Circle((5, 0), 2), [(0, 0), (1, 0), (1, 1)]])
    >>> xa.terrain_around(scene, "1/2")
    Terrain(width=8, height=5, origin=(-1/2, -5/2))
    >>> xa.terrain_around(scene.replace(start=(-1, 0)), "1/2")
    Terrain(width=9, height=5, origin=(-3/2, -5/2))
    """
    with about("margin"):
        room = rational(margin)
        if room < 0:
            raise FormatError(f"must not be negative, not {room}")
    if not scene.obstacles:
        raise InvalidScene(["a scene without obstacles has no extent: give a terrain"])
    west, south, east, north = _extent([edge for o in scene.obstacles for edge in o.edges])
    if scene.start is not None:
        x, y = scene.start.x, scene.start.y
        west, south = min(west, -_upward(-x)), min(south, -_upward(-y))
        east, north = max(east, _upward(x)), max(north, _upward(y))
    origin = west - room, south - room
    return Terrain(east - west + 2 * room, north - south + 2 * room, origin)


def rectangular_room(scene: Scene) -> Terrain | None:
    """The terrain that a scene's enclosure is the border of, if that is a rectangle along the axes."""
    if scene.enclosure is None:
        return None
    edges = shape_edges(scene.enclosure)
    west, south, east, north = _extent(edges)
    area = signed_area(edges)
    # A simple loop within a rectangle that is as large is the rectangle.
    if (area if area.sign() > 0 else -area) != Length((east - west) * (north - south)):
        return None
    return Terrain(east - west, north - south, (west, south))


def at_corner(scene: Scene) -> Scene:
    """The scene with its start in the SW corner of what the Seed Spreader sweeps, if there is such.

    `InvalidScene` if that is not free.
    """
    terrain = scene.terrain or rectangular_room(scene)
    try:
        return scene if terrain is None else scene.replace(start=terrain.south_west)
    except InvalidScene as error:
        cure = "a sweep starts in the SW corner of its terrain"
        if scene.terrain is not None and rectangular_room(scene) is not None:
            cure += "; without a terrain the enclosure is swept"
        raise InvalidScene(error.violations, error.cure or cure) from None


def _extent(edges: Sequence[Curve]) -> tuple[fmpq, fmpq, fmpq, fmpq]:
    """Bounds of the coordinates: west, south, east, north."""
    points = [_rational(edge.start) for edge in edges]
    west, south = (min(p[k] for p in points) for k in (0, 1))
    east, north = (max(p[k] for p in points) for k in (0, 1))
    for edge in edges:
        if isinstance(edge, Arc):
            for (x, y), reach in _sides(edge):
                west, south = min(west, reach) if x < 0 else west, min(south, reach) if y < 0 else south
                east, north = max(east, reach) if x > 0 else east, max(north, reach) if y > 0 else north
    return west, south, east, north


def _sides(arc: Arc) -> Iterator[tuple[tuple[int, int], fmpq]]:
    """The directions in which an arc reaches as far as its circle does, and the coordinate there."""
    radius = _upward(arc.radius)
    center = _rational(arc.center)
    for x, y in DIRECTIONS:
        if spans(arc, (fmpq(x), fmpq(y))):
            yield (x, y), (center[0] + x * radius if x else center[1] + y * radius)


def _upward(number: Real) -> fmpq:
    """A rational number, or a decimal that is a little more."""
    if number.rational is not None:
        return number.rational
    unit = fmpq(10) ** (floor(log10(abs(float(number)))) - DIGITS)
    _, high = number.enclosure(max(0, ceil(-log2(float(unit)))) + 8)
    return fmpq((high / unit).ceil()) * unit


def _rational(point: Point) -> tuple[fmpq, fmpq]:
    pair = point.rational
    assert pair is not None, "vertices and centres of scenes are rational"
    return pair
