"""What `__geo_interface__` offers: geometries and features as GeoJSON (RFC 7946) has them.

Coordinates are pairs of floats, in the unit of the scene. Arcs become chords, so the disjoint may meet here
that exactly keep a tiny distance: for drawing and for other libraries, not for decisions. Outer rings run
counterclockwise.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import ceil, sqrt
from typing import Any, TypeAlias

from exactacq.geometry.strokes import Stroke

FLATNESS = 1e-4
"""How far chords stray from their arc, at most: this share of its radius, and of its length if that is less.

A full circle becomes 223 chords; a flat arc of a huge radius strays little too.
"""

Position: TypeAlias = "tuple[float, float]"
Geo: TypeAlias = "dict[str, Any]"


def point(position: Position) -> Geo:
    """A Point."""
    return {"type": "Point", "coordinates": position}


def line_string(strokes: Iterable[Stroke]) -> Geo:
    """A LineString along strokes that follow each other; a Point if they do not leave their place."""
    positions = corners(strokes)
    return point(positions[0]) if len(positions) == 1 else {"type": "LineString", "coordinates": positions}


def polygon(strokes: Iterable[Stroke], clockwise: bool = False) -> Geo:
    """A Polygon without holes inside a loop of strokes, which runs clockwise or not.

    Empty without strokes; where a loop bounds no area, its ring bounds none.
    """
    positions = corners(strokes)
    ring = positions if positions[:1] == positions[-1:] and len(positions) > 1 else positions + positions[:1]
    return {"type": "Polygon", "coordinates": (ring[::-1] if clockwise else ring,) if ring else ()}


def feature(geometry: Geo, **properties: object) -> Geo:
    """A Feature."""
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def collection(features: Iterable[Geo]) -> Geo:
    """A FeatureCollection."""
    return {"type": "FeatureCollection", "features": tuple(features)}


def corners(strokes: Iterable[Stroke]) -> tuple[Position, ...]:
    """The corners of strokes that follow each other, arcs as chords; floats that repeat are told once."""
    positions: list[Position] = []
    for stroke in strokes:
        for k in range(1 + (parts := chords(stroke))):
            position = stroke.at(k / parts)
            if positions[-1:] != [position]:
                positions.append(position)
    return tuple(positions)


def chords(stroke: Stroke) -> int:
    """Into how many chords a stroke is cut: n of them stray by at most radius * sweep^2 / (8 n^2)."""
    turn = abs(stroke.sweep)
    return max(1, ceil(turn / sqrt(8 * FLATNESS * min(1.0, turn)))) if turn else 1


def point_pair(value: Any) -> Any:
    """The coordinates of a Point of shapely or the like; anything else, and a point of ours, as it is."""
    geo = None if hasattr(value, "rational") else getattr(value, "__geo_interface__", None)
    if not isinstance(geo, Mapping) or geo.get("type") != "Point":
        return value
    return geo.get("coordinates")
