"""Areas from GeoJSON files, and from objects of other libraries that have `__geo_interface__`.

Polygons, alone or in collections and features, and closed lines are read; open lines and points are left out
and counted. Numbers of a file are the decimals that stand in it, floats of an object the binary fractions
that they are. Features whose ``kind`` is enclosure, terrain or start, as scenes offer them, are taken for
that. Heights are left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flint import fmpq

from exactacq.errors import FormatError, about, shown
from exactacq.files.loops.areas import Areas, is_rounded
from exactacq.files.loops.contents import Contents
from exactacq.files.scene_json import MAX_COMMAS, parse_json
from exactacq.files.source import MAX_EDGES, read_bytes
from exactacq.numbers.rationals import rational
from exactacq.scene.bends import entries
from exactacq.scene.shapes import Terrain

MAX_DEPTH = 16
"""Deepest nesting of collections that is followed."""
LINES = ("LineString", "MultiLineString", "LinearRing")
Place = tuple[fmpq, fmpq]


def load_geojson(path: Path, start: Place | None, *, union: bool = False) -> Contents:
    """The areas in a GeoJSON file, around the start: see `exactacq.files.loops.areas`.

    Raises `FormatError` with the place in the document. Linear in the file.
    """
    data = read_bytes(path)
    if data.count(b",") > MAX_COMMAS:
        raise FormatError(f"more than {MAX_EDGES} edges; give a smaller part")
    return geo_contents(parse_json(data), path.stem, start, union=union)


def geo_contents(document: Any, name: str | None, start: Place | None, *, union: bool = False) -> Contents:
    """The areas of a GeoJSON document, or of what `__geo_interface__` says of an object."""
    reader = _GeoReader()
    reader.read(document, "the document", 0)
    start = reader.start if start is None else start
    return reader.areas.contents(name, start, union=union, terrain=reader.terrain)


class _GeoReader:
    """The areas of a document, and the start and the terrain if it tells them."""

    def __init__(self) -> None:
        self.areas, self.count = Areas(), 0
        self.start: Place | None = None
        self.terrain: Terrain | None = None

    def read(self, geo: Any, place: str, depth: int, told: Mapping[str, Any] | None = None) -> None:
        """A collection, feature or geometry; *told* are the properties of its feature."""
        if depth > MAX_DEPTH:
            raise FormatError(f"collections are nested more than {MAX_DEPTH} deep")
        kind = geo.get("type") if isinstance(geo, Mapping) else None
        if not isinstance(kind, str):
            raise FormatError(f'{place}: an object with a "type" is needed, not {shown(geo)}')
        if kind in ("FeatureCollection", "GeometryCollection"):
            key = "features" if kind == "FeatureCollection" else "geometries"
            for i, member in enumerate(self._list(geo.get(key), f"{place}: {key}")):
                self.read(member, f"{key}[{i}]", depth + 1, told)
        elif kind == "Feature":
            properties = geo.get("properties")
            if geo.get("geometry") is not None:
                told = properties if isinstance(properties, Mapping) else {}
                self.read(geo["geometry"], place, depth + 1, told)
        else:
            with about(place):
                self._geometry(kind, geo.get("coordinates"), told or {})

    def _geometry(self, kind: str, coordinates: Any, told: Mapping[str, Any]) -> None:
        role = told.get("kind")
        if kind == "Polygon" and role == "terrain":
            xs, ys = zip(*self._ring(next(iter(self._list(coordinates, "coordinates")), ())), strict=True)
            west, south = min(xs), min(ys)
            self.terrain = Terrain(max(xs) - west, max(ys) - south, (west, south))
        elif kind == "Polygon":
            self._polygon(coordinates, told)
        elif kind == "MultiPolygon":
            for rings in self._list(coordinates, "coordinates"):
                self._polygon(rings, told)
        elif kind in LINES:
            for line in self._list(coordinates, "coordinates") if kind == LINES[1] else [coordinates]:
                self._line(line, kind, told)
        elif kind == "Point" and role == "start":
            self.start = self._position(coordinates)
        elif kind in ("Point", "MultiPoint"):
            self.areas.leave_out(kind)
        else:
            raise FormatError(f"no geometry of GeoJSON: {shown(kind)}")

    def _polygon(self, rings: Any, told: Mapping[str, Any]) -> None:
        self.count += 1
        label = told.get("name")
        name = label if isinstance(label, str) and label else f"polygon {self.count}"
        for k, ring in enumerate(self._list(rings, "coordinates")):
            rows = [(x, y, fmpq(0)) for x, y in self._ring(ring)]
            self.areas.add(rows, f"{name}, hole {k}" if k else name)

    def _line(self, line: Any, kind: str, told: Mapping[str, Any]) -> None:
        places = self._ring(line)
        if places[0] == places[-1] or is_rounded([(x, y, fmpq(0)) for x, y in places]):
            self._polygon([line], told)
        else:
            self.areas.leave_out(f"open {kind}")

    def _ring(self, ring: Any) -> list[Place]:
        places = [self._position(position) for position in self._list(ring, "coordinates")]
        if not places:
            raise FormatError("a ring without positions; leave it out")
        return places

    def _position(self, position: Any) -> Place:
        numbers = entries(position)
        if not 2 <= len(numbers) <= 4:
            raise FormatError(f"a position is two to four numbers, not {shown(position)}")
        self.areas.flattened |= len(numbers) > 2
        for number in numbers[:2]:
            if isinstance(number, str) and not hasattr(number, "is_json_number"):
                raise FormatError(f"a number is needed, not the text {shown(number)}")
        return rational(numbers[0]), rational(numbers[1])

    @staticmethod
    def _list(value: Any, what: str) -> tuple[Any, ...]:
        found = entries(value)
        if not found and (value is None or isinstance(value, str | Mapping) or not hasattr(value, "__len__")):
            raise FormatError(f"{what}: a list is needed, not {shown(value)}")
        return found
