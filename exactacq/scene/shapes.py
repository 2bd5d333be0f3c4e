"""Input shapes: polygons, outlines with bulges, circles and the terrain, all with rational data.

Numbers are read exactly and without any check of the geometry: that is up to `exactacq.Scene`. Values that
are no numbers raise `FormatError`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.numbers.rationals import rational

Vertex: TypeAlias = "tuple[fmpq, fmpq, fmpq]"
"""(x, y, bulge): the bulge is a quarter-angle tangent and belongs to the edge that follows."""


@dataclass(frozen=True, slots=True)
class Loop:
    """A closed boundary of straight edges and arcs, given clockwise or counterclockwise."""

    vertices: tuple[Vertex, ...]
    name: str | None = None


class Outline(Loop):
    """A closed boundary of straight edges and arcs, from vertices ``(x, y)`` or ``(x, y, bulge)``.

    The bulge, as in DXF, is the tangent of a quarter of the angle of the edge that follows: positive for
    counterclockwise arcs, 0 for a straight edge, 1 for a half circle. At least 3 vertices, or 2 with an arc.

    >>> half = Outline([(-1, 0), (1, 0, 1)])
    >>> import exactacq as xa
    >>> print(xa.Scene([half]).obstacles[0].perimeter)
    2 + pi
    """

    __slots__ = ()

    def __init__(self, vertices: Iterable[Sequence[object]], name: str | None = None) -> None:
        super().__init__(tuple(_vertex(v) for v in vertices), name)


class Polygon(Loop):
    """A closed boundary of straight edges, from at least 3 vertices ``(x, y)``.

    >>> square = Polygon([(0, 0), (1, 0), (1, 1), (0, 1)], name="square")
    >>> import exactacq as xa
    >>> xa.Scene([square]).obstacles[0].perimeter
    Length('4')
    """

    __slots__ = ()

    def __init__(self, vertices: Iterable[Sequence[object]], name: str | None = None) -> None:
        loop = tuple(_vertex(v) for v in vertices)
        if any(bulge for _, _, bulge in loop):
            raise FormatError("a Polygon has no bulges: use Outline")
        super().__init__(loop, name)


@dataclass(frozen=True, slots=True, init=False)
class Circle:
    """A disc, or as an enclosure a round room, with rational centre and positive rational radius.

    >>> import exactacq as xa
    >>> print(xa.Scene([Circle((0, 0), "1/2")]).obstacles[0].area)
    pi/4
    """

    center: tuple[fmpq, fmpq]
    radius: fmpq
    name: str | None = None

    def __init__(self, center: Sequence[object], radius: object, name: str | None = None) -> None:
        object.__setattr__(self, "center", rational_pair(center))
        object.__setattr__(self, "radius", rational(radius))
        object.__setattr__(self, "name", name)


Shape: TypeAlias = "Loop | Circle"


@dataclass(frozen=True, slots=True, init=False)
class Terrain:
    """The rectangle [0, width] x [0, height] that the Seed Spreader sweeps; both sides are positive.

    >>> Terrain(8, "13/2")
    Terrain(width=8, height=13/2)
    """

    width: fmpq
    height: fmpq

    def __init__(self, width: object, height: object) -> None:
        object.__setattr__(self, "width", rational(width))
        object.__setattr__(self, "height", rational(height))


def rational_pair(pair: Sequence[object]) -> tuple[fmpq, fmpq]:
    """Two rationals from any pair of numbers; `FormatError` otherwise."""
    if isinstance(pair, str) or len(pair) != 2:
        raise FormatError(f"a point needs two numbers, not {pair!r}")
    return rational(pair[0]), rational(pair[1])


def _vertex(vertex: Sequence[object]) -> Vertex:
    if isinstance(vertex, str) or len(vertex) not in (2, 3):
        raise FormatError(f"a vertex is (x, y) or (x, y, bulge), not {vertex!r}")
    x, y, bulge = (*vertex, 0)[:3]
    return rational(x), rational(y), rational(bulge)
