"""The isovist: the region that is visible from a point within a limited range, by its closed outline.

The term is Benedikt's ("To take hold of space: isovists and isovist fields", 1979). `visible_boundary`
decides what is seen, and `outline` joins it. Some single rays see more than the rays next to them: those
that pass between two obstacles which touch the same line from both sides, and those along a straight edge.
They bound no area. They belong to the isovist, but not to its outline, and are listed as `rays`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from exactacq.cached import cached_property
from exactacq.errors import InvalidScene, about
from exactacq.geometry.coordinates import raw
from exactacq.geometry.curves import Segment
from exactacq.geometry.geo import Geo, polygon
from exactacq.geometry.loops import signed_area
from exactacq.geometry.points import Location, Point
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import plain
from exactacq.numbers.real import fmpq
from exactacq.scene.ports import SVG, made
from exactacq.scene.scene import Scene, as_scene, radius_of
from exactacq.scene.validation import place_flaws, place_text
from exactacq.visibility.free_segment import is_free
from exactacq.visibility.outline import ViewKind, ViewPiece, outline
from exactacq.visibility.place_facts import NOTHING_KNOWN, PlaceFacts
from exactacq.visibility.range_clip import Span
from exactacq.visibility.scene_tables import SceneTables, point_flaws
from exactacq.visibility.sensor_range import Range
from exactacq.visibility.visible_boundary import BoundaryView

__all__ = ["Isovist", "ViewKind", "ViewPiece", "isovist"]


class Isovist:
    """The region visible from a free point within a rational radius; made by `isovist`.

    Only the interior of an obstacle blocks: a line of sight may touch boundaries or run along them, and the
    region is closed. What is seen first in every direction is decided, exactly, when the isovist is made; the
    end points of `pieces`, `rays` and `seen` are computed on first access.

    >>> import exactacq as xa
    >>> view = xa.isovist(xa.Scene([xa.Circle((3, 0), 1)]), (3, 2), radius=1)
    >>> print(view.area, view.perimeter)
    pi 2*pi
    >>> view.__geo_interface__["type"]
    'Polygon'
    """

    def __init__(
        self,
        scene: Scene,
        point: Point,
        radius: fmpq,
        own: tuple[int, ...] | None = None,
        facts: PlaceFacts = NOTHING_KNOWN,
    ) -> None:
        self.scene, self.point, self.radius = scene, point, radius
        self._view = BoundaryView(SceneTables.of(scene).edges, point, Range(radius), own, facts)

    @cached_property
    def pieces(self) -> tuple[ViewPiece, ...]:
        """The closed outline, counterclockwise: parts of edges, windows and arcs of the range circle.

        A window is a segment that joins a visible boundary point with what is seen beyond it. From a point on
        a boundary the outline passes through the point itself. Empty where the point sees no area.

        >>> import exactacq as xa
        >>> wall = xa.Polygon([(2, -1), (3, -1), (3, 1), (2, 1)])
        >>> [piece.kind.value for piece in xa.isovist(xa.Scene([wall]), (0, 0), radius=5).pieces]
        ['window', 'edge', 'window', 'range']
        """
        return outline(self._view)

    @cached_property
    def rays(self) -> tuple[Segment, ...]:
        """The free parts, within range, of the single rays that see more than their neighbours.

        These go on where the rays to both sides are blocked, or run along a straight edge.
        """
        return tuple(Segment(self.point, end) for end in self._view.lone_ends())

    def seen(self) -> dict[tuple[int, int], list[Span]]:
        """All boundary points seen: by obstacle and edge, closed pieces (start, end) in the edge's direction.

        The pieces of an edge are disjoint and in order; equal ends are a single point. A vertex is the end of
        a piece of either edge, or alone with the edge that starts there. On a full circle a piece may run
        over the circle's start, and a circle that is seen whole has its two halves as pieces.

        >>> import exactacq as xa
        >>> wall = xa.Polygon([(2, -1), (3, -1), (3, 1), (2, 1)])
        >>> xa.isovist(xa.Scene([wall]), (0, 0), radius=5).seen()
        {(0, 3): [(Point(2, 1), Point(2, -1))]}
        """
        table = self._view.table
        return {(table.owners[e], table.numbers[e]): spans for e, spans in self._view.seen().items()}

    @cached_property
    def area(self) -> Length:
        """Exact area."""
        return signed_area([piece.curve for piece in self.pieces])

    @cached_property
    def perimeter(self) -> Length:
        """Exact length of the outline, windows and range arcs included."""
        return Length.sum(piece.curve.length for piece in self.pieces)

    def contains(self, point: Point | Sequence[object]) -> bool:
        """Whether a point, also one as two numbers, is visible; False for points inside obstacles.

        >>> import exactacq as xa
        >>> wall = xa.Polygon([(2, -1), (3, -1), (3, 1), (2, 1)])
        >>> view = xa.isovist(xa.Scene([wall]), (0, 0), radius=5)
        >>> view.contains(xa.Point(4, 0)), view.contains(xa.Point(4, 2))
        (False, True)
        """
        point = Point.of(point)
        if self._view.range.order(self.point, point) > 0:
            return False
        if any(place is Location.INSIDE for place, _ in SceneTables.of(self.scene).around(point)):
            return False
        if point == self.point:
            return True
        view = self._view
        return not view.buries(raw(point - self.point)) and is_free(view.table, self.point, point)

    @property
    def __geo_interface__(self) -> Geo:
        """What is seen, as a GeoJSON Polygon, counterclockwise; arcs as chords (`geometry.geo.FLATNESS`).

        `rays` bound no area and are left out. Only where no area is seen they are all there is: a
        MultiLineString of them, or a Point, that of the isovist, if there are none either.
        """
        if self.pieces:
            return polygon(piece.curve.stroke() for piece in self.pieces)
        lines = tuple((ray.start.xy, ray.end.xy) for ray in self.rays)
        return {"type": "MultiLineString", "coordinates": lines} if lines else self.point.__geo_interface__

    def _repr_svg_(self) -> str:
        return str(made(SVG, self))

    def __reduce__(self) -> tuple[Any, ...]:
        """Its view is made again: it knows places by identity."""
        return Isovist, (self.scene, self.point, self.radius, self._view.own)

    def __repr__(self) -> str:
        return f"<Isovist from {place_text(self.point)} within {plain(self.radius)}>"


def isovist(scene: Scene, point: object, radius: object = None) -> Isovist:
    """The region visible from a free point within the radius (the scene's own if None).

    The point, a `Point` or a pair of numbers, may be algebraic and may lie on a boundary; the radius is
    rational. Raises `InvalidScene` if the point is inside an obstacle or beyond 10^100, or the radius missing
    or not positive, and `FormatError` for what is no scene, point or number. Cost: near linear in the edges
    within the radius, after one pass over all edges of a scene.

    >>> import exactacq as xa
    >>> print(isovist(xa.load("circles"), (0, 0), radius=4).perimeter)
    2*asin(31/200) + 4*asin(569/800) + 7*pi
    """
    as_scene(scene)
    with about("point"):
        place = Point.of(point)  # type: ignore[arg-type]
    if far := list(place_flaws("point", place)):
        raise InvalidScene(far)
    reach = radius_of(scene, radius, None)
    around = SceneTables.of(scene).around(place)
    if flaws := point_flaws("point", place, around):
        raise InvalidScene(flaws)
    return Isovist(scene, place, reach, None if around else ())
