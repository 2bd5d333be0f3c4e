"""Input shapes: polygons, outlines with bulges, circles and the terrain, all with rational data.

Numbers are read exactly and without any check of the geometry: that is up to `exactacq.Scene`. Values that
are no numbers raise `FormatError`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from flint import fmpq

from exactacq.errors import FormatError, about, shown
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.geo import Geo, polygon
from exactacq.geometry.loops import signed_area
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import rational
from exactacq.scene.bends import Around, Bend, Via, bend, entries, opposite, rational_pair

Vertex: TypeAlias = "tuple[fmpq, fmpq, Bend]"
"""(x, y, bend): the bend belongs to the edge that follows. It is a bulge, the tangent of a quarter of the
edge's angle, or an `Around` where that is irrational."""


class HasGeoInterface(Protocol):
    """An object of another library that says where it is, such as a polygon of shapely."""

    @property
    def __geo_interface__(self) -> Mapping[str, Any]: ...


Corners: TypeAlias = "Iterable[Iterable[object]] | HasGeoInterface"
"""What gives a ring of straight edges: pairs (x, y), an array of two columns, or a polygon without holes of
another library. Floats are taken for the binary fractions that they are."""


@dataclass(frozen=True, slots=True)
class Loop:
    """A closed boundary of straight edges and arcs, given clockwise or counterclockwise."""

    vertices: tuple[Vertex, ...]
    name: str | None = None

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON Polygon, arcs as chords (see `exactacq.geometry.geo.FLATNESS`).

        Its ring runs counterclockwise, whichever way the vertices do. Nothing is validated: a loop that no
        scene takes gives a ring that is none.
        """
        return _geo_polygon(self)


class Outline(Loop):
    """A closed boundary of straight edges and arcs, from vertices ``(x, y)`` or ``(x, y, bend)``.

    The bend belongs to the edge that follows. A number is a bulge, as in DXF: the tangent of a quarter of the
    edge's angle, positive for counterclockwise arcs, 0 for a straight edge, 1 for a half circle. An arc may
    also be told by its centre, `Around`, or by a third point, `Via`; it then gets the bulge if that is
    rational, and a full circle becomes two halves. At least 3 vertices, or 2 with an arc; a last one that
    repeats the first, without a bend, is left out. Raises `FormatError` for what are no vertices or arcs;
    whether the boundary is a legal one is asked by `Scene`.

    >>> half = Outline([(-1, 0), (1, 0, 1)])
    >>> import exactacq as xa
    >>> print(xa.Scene([half]).obstacles[0].perimeter)
    2 + pi
    >>> len(half.__geo_interface__["coordinates"][0])
    114
    """

    __slots__ = ()

    def __init__(self, vertices: Iterable[Iterable[object]], name: str | None = None) -> None:
        super().__init__(tuple(_bent(_ring(vertices))), as_name(name))


class Polygon(Loop):
    """A closed boundary of straight edges, from at least 3 vertices ``(x, y)``.

    These are pairs of numbers, an array of two columns, or a polygon of another library, such as shapely's:
    anything whose ``__geo_interface__`` is a Polygon without holes, a closed line, or a Feature with one. A
    last vertex that repeats the first is left out. Raises `FormatError` for anything else; whether the
    boundary is a legal one is asked by `Scene`.

    >>> square = Polygon([(0, 0), (1, 0), (1, 1), (0, 1)], name="square")
    >>> import exactacq as xa
    >>> xa.Scene([square]).obstacles[0].perimeter
    Length('4')
    >>> ring = {"type": "Polygon", "coordinates": [[(0, 0), (0, 1), (1, 0.5), (0, 0)]]}
    >>> Polygon(ring) == Polygon([(0, 0), (0, 1), (1, "1/2")])
    True
    >>> Polygon(ring).__geo_interface__["coordinates"]
    (((0.0, 0.0), (1.0, 0.5), (0.0, 1.0), (0.0, 0.0)),)
    """

    __slots__ = ()

    def __init__(self, vertices: Corners, name: str | None = None) -> None:
        loop = vertices.vertices if isinstance(vertices, Loop) else _ring(_corners(vertices))
        if any(bulge for _, _, bulge in loop):
            raise FormatError("a Polygon has no bulges: use Outline")
        super().__init__(tuple((x, y, fmpq(0)) for x, y, _ in loop), as_name(name))


@dataclass(frozen=True, slots=True, init=False)
class Circle:
    """A disc, or as an enclosure a round room, with rational centre and positive rational radius.

    Raises `FormatError` for what are no such numbers; the sign of the radius is asked by `Scene`.

    >>> import exactacq as xa
    >>> print(xa.Scene([Circle((0, 0), "1/2")]).obstacles[0].area)
    pi/4
    >>> len(Circle((0, 0), 2).__geo_interface__["coordinates"][0])
    224
    """

    center: tuple[fmpq, fmpq]
    radius: fmpq
    name: str | None = None

    def __init__(self, center: Iterable[object], radius: object, name: str | None = None) -> None:
        with about("center"):
            object.__setattr__(self, "center", rational_pair(center))
        with about("radius"):
            object.__setattr__(self, "radius", rational(radius))
        object.__setattr__(self, "name", as_name(name))

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON Polygon of chords (see `exactacq.geometry.geo.FLATNESS`), counterclockwise."""
        return _geo_polygon(self)


Shape: TypeAlias = "Loop | Circle"


@dataclass(frozen=True, slots=True, init=False, repr=False)
class Terrain:
    """The rectangle that the Seed Spreader sweeps: *origin* is its SW corner, both sides are positive.

    Raises `FormatError` for what are no numbers; their signs are asked by `Scene`.

    >>> Terrain(8, "13/2"), Terrain(8, 5, origin=(-1, "1/2"))
    (Terrain(width=8, height=13/2), Terrain(width=8, height=5, origin=(-1, 1/2)))
    >>> Terrain(2, 1, (5, 5)).__geo_interface__["coordinates"]
    (((5.0, 5.0), (7.0, 5.0), (7.0, 6.0), (5.0, 6.0), (5.0, 5.0)),)
    """

    width: fmpq
    height: fmpq
    origin: tuple[fmpq, fmpq]

    def __init__(self, width: object, height: object, origin: Point | Iterable[object] = (0, 0)) -> None:
        with about("width"):
            object.__setattr__(self, "width", rational(width))
        with about("height"):
            object.__setattr__(self, "height", rational(height))
        with about("origin"):
            pair = Point.of(origin).rational  # type: ignore[arg-type]
            if pair is None:
                raise FormatError(f"{shown(origin)} is not rational: give two rational numbers")
            object.__setattr__(self, "origin", pair)

    @property
    def south_west(self) -> Point:
        """The SW corner, where the Seed Spreader starts.

        >>> Terrain(8, 5, origin=(-1, 2)).south_west
        Point(-1, 2)
        """
        return Point(*self.origin)

    @property
    def limits(self) -> tuple[fmpq, fmpq, fmpq, fmpq]:
        """The least and the greatest coordinates: west, south, east, north.

        >>> print(*Terrain(8, 5, origin=(-1, 2)).limits)
        -1 2 7 7
        """
        (x, y) = self.origin
        return x, y, x + self.width, y + self.height

    @property
    def corners(self) -> tuple[Point, Point, Point, Point]:
        """The corners, counterclockwise from the SW one.

        >>> Terrain(8, 5).corners[2]
        Point(8, 5)
        """
        west, south, east, north = self.limits
        return Point(west, south), Point(east, south), Point(east, north), Point(west, north)

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON Polygon, counterclockwise from the SW corner."""
        return Polygon(self.corners).__geo_interface__

    def __repr__(self) -> str:
        origin = f", origin=({self.origin[0]}, {self.origin[1]})" if any(self.origin) else ""
        return f"Terrain(width={self.width}, height={self.height}{origin})"


def shape_edges(shape: Shape) -> tuple[Curve, ...]:
    """The boundary as curves in the shape's own sense; edge i starts at vertex i, and vertices are shared.

    Nothing is checked: a degenerate shape gives degenerate curves.
    """
    if isinstance(shape, Circle):
        return (Arc.circle(Point(*shape.center), shape.radius * shape.radius),)
    points = [Point(x, y) for x, y, _ in shape.vertices]
    ends = [*points[1:], *points[:1]]
    return tuple(map(edge, points, ends, (bend for _, _, bend in shape.vertices)))


def edge(start: Point, end: Point, bend: Bend) -> Curve:
    """The curve from a rational point to another that bends so."""
    if isinstance(bend, Around):
        center = Point(*bend.center)
        return Arc(start, end, center, rational((start - center).norm_sq()), bend.ccw)
    return Arc.from_bulge(start, end, bend) if bend else Segment(start, end)


def _geo_polygon(shape: Shape) -> Geo:
    # An arc between equal points has no radius: no scene takes it, and it adds nothing to the ring.
    edges = [edge for edge in shape_edges(shape) if isinstance(edge, Segment) or edge.radius_sq]
    return polygon((edge.stroke() for edge in edges), clockwise=signed_area(edges).sign() < 0)


def _corners(value: Corners) -> Iterable[Iterable[object]]:
    """The rows of what is no shape of ours: its own, or those of the Polygon that it says it is."""
    geo = value if isinstance(value, Mapping) else getattr(value, "__geo_interface__", None)
    if geo is None:
        return value  # type: ignore[return-value]
    if isinstance(value, Circle):
        raise FormatError("a Circle is no Polygon: give it as it is")
    if geo.get("type") == "Feature":
        geo = geo.get("geometry") or {}
    rings = entries(geo.get("coordinates"))
    if geo.get("type") in ("LinearRing", "LineString"):
        if len(rings) < 2 or tuple(rings[0]) != tuple(rings[-1]):
            raise FormatError("a boundary is closed: its last vertex is the first one")
        rings = (rings,)
    elif geo.get("type") != "Polygon":
        raise FormatError(f"a boundary is one Polygon, not a {geo.get('type', 'mapping without a type')}")
    if len(rings) > 1:
        raise FormatError("a boundary is one ring: give a Polygon with holes by its outer ring alone")
    rows = [entries(row) for ring in rings for row in entries(ring)]
    if any(len(row) != 2 for row in rows):
        raise FormatError("a boundary lies in the plane: give a Polygon of pairs (x, y)")
    return rows


def _ring(vertices: Iterable[Iterable[object]]) -> tuple[tuple[fmpq, fmpq, Any], ...]:
    """The vertices with what their bends are told by, without a last one that only closes the ring."""
    try:
        rows = tuple(vertices)
    except TypeError:
        raise FormatError(f"a boundary is a list of vertices, not {shown(vertices)}") from None
    ring = tuple(_vertex(k, row) for k, row in enumerate(rows))
    closed = len(ring) > 1 and ring[-1][:2] == ring[0][:2] and not ring[-1][2]
    return ring[:-1] if closed else ring


def _vertex(number: int, vertex: Iterable[object]) -> tuple[fmpq, fmpq, Any]:
    values = entries(vertex)
    if len(values) not in (2, 3):
        raise FormatError(f"vertex {number}: a vertex is (x, y) or (x, y, bend), not {shown(vertex)}")
    told = values[2] if len(values) == 3 else 0
    with about(f"vertex {number}"):
        x, y = map(rational, values[:2])
        return x, y, told if isinstance(told, Around | Via) else rational(told)


def _bent(ring: tuple[tuple[fmpq, fmpq, Any], ...]) -> Iterator[Vertex]:
    """The vertices with their bends; a full circle is two halves."""
    for k, (x, y, told) in enumerate(ring):
        end = ring[(k + 1) % len(ring)][:2]
        with about(f"vertex {k}"):
            if end != (x, y):
                yield x, y, bend((x, y), end, told)
            elif (half := opposite((x, y), told)) is None:
                yield x, y, told
            else:
                yield x, y, half[1]
                yield *half[0], half[1]


def as_name(name: str | None) -> str | None:
    """A name as it is; `FormatError` for what is no text, or has half of a character, which no file holds."""
    if name is not None and not isinstance(name, str):
        raise FormatError(f"name: a name is a text, not {shown(name)}")
    if name and any("\ud800" <= letter <= "\udfff" for letter in name):
        raise FormatError(f"name: {shown(name)} has half of a character (a surrogate without its other half)")
    return name
