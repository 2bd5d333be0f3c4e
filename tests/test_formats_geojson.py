"""GeoJSON files and objects of other libraries: areas, roles, and documents that are none."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

import exactacq as xa

SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
HOLE = [[1, 1], [1, 3], [3, 3], [3, 1], [1, 1]]
FAR = [[[x + 10, y] for x, y in SQUARE]]


def read(folder: Path, document: Any, start: object = None, **options: object) -> xa.Scene:
    path = folder / "areas.geojson"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    return xa.load(path, start=start, **options)


def polygon(*rings: object) -> dict[str, Any]:
    return {"type": "Polygon", "coordinates": rings}


def feature(geometry: object, **properties: object) -> dict[str, Any]:
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def areas(scene: xa.Scene) -> list[str]:
    return [str(obstacle.area) for obstacle in scene.obstacles]


@pytest.mark.parametrize(
    "document",
    [
        polygon(SQUARE),
        {"type": "MultiPolygon", "coordinates": [[SQUARE]]},
        {"type": "GeometryCollection", "geometries": [polygon(SQUARE)]},
        feature(polygon(SQUARE)),
        {"type": "Feature", "geometry": polygon(SQUARE), "properties": None},
        {"type": "FeatureCollection", "features": [feature(None), feature(polygon(SQUARE))]},
        {"type": "LineString", "coordinates": SQUARE},
        {"type": "MultiLineString", "coordinates": [SQUARE]},
        polygon(SQUARE[::-1]),
        polygon([[*place, 7] for place in SQUARE]),
        {**polygon(SQUARE), "bbox": [0, 0, 4, 4], "crs": {"type": "name"}},
    ],
)
def test_areas_of_all_kinds(tmp_path: Path, document: dict[str, Any]) -> None:
    assert areas(read(tmp_path, document)) == ["16"]


def test_numbers_are_the_decimals_of_the_file(tmp_path: Path) -> None:
    ring = "[[0.1, 1e-3], [3, -0.5], [1, 2], [0.1, 1e-3]]"
    scene = read(tmp_path, f'{{"type": "Polygon", "coordinates": [{ring}]}}')
    assert scene.shapes == (xa.Polygon([("0.1", "1/1000"), (3, "-1/2"), (1, 2)], "polygon 1"),)


def test_names_are_those_of_the_features(tmp_path: Path) -> None:
    document = {
        "type": "FeatureCollection",
        "features": [feature(polygon(SQUARE, HOLE), name="hall"), feature(polygon(*FAR), name=3)],
    }
    assert [shape.name for shape in read(tmp_path, document).shapes] == ["hall", "3"]
    room = read(tmp_path, document, start=("1/2", "1/2"))
    assert room.enclosure.name == "hall" and [shape.name for shape in room.shapes] == ["hall, hole 1"]


@pytest.mark.parametrize("suffix", ["geojson", "json"])
def test_half_a_character_in_a_name_is_refused(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"areas.{suffix}"
    path.write_text(json.dumps(feature(polygon(SQUARE), name="a\ud800")))
    with pytest.raises(xa.FormatError, match=r"column \d+: \\ud800 is half of a character"):
        xa.load(path, start=(-1, 0))


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are bytes")
def test_a_file_whose_name_is_no_text_gives_results_that_can_be_written(tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(b"caf\xe9.geojson")
    path.write_text(json.dumps(polygon(SQUARE)))
    scene = xa.load(path, start=(-1, 0))
    assert scene.name == "caf?"
    xa.write(scene, tmp_path / "scene.json")


def test_the_start_tells_which_side_is_free(tmp_path: Path) -> None:
    for start, found in (((2, 2), ["4"]), (("1/2", 2), ["4", "16"]), ((9, 9), ["16"])):
        assert areas(read(tmp_path, polygon(SQUARE, HOLE), start)) == found


def test_what_scenes_offer_is_read_again(tmp_path: Path) -> None:
    scene = xa.Scene(
        [xa.Polygon([(1, 1), (2, 1), (2, 2)], "a"), xa.Polygon([(5, 5), (6, 5), (5, 6)], "b")],
        start=(0, 0),
        terrain=xa.Terrain(9, 8),
    )
    for again in (read(tmp_path, scene.__geo_interface__), xa.load(scene)):
        assert (again.shapes, again.start, again.terrain) == (scene.shapes, scene.start, scene.terrain)
    walled = xa.Scene(scene.shapes, start=(0, 0), enclosure=xa.Polygon([(-9, -9), (99, -9), (0, 99)], "wall"))
    again = xa.load(walled)
    assert again.enclosure is not None and areas(again) == areas(walled)


def test_objects_of_other_libraries() -> None:
    frame = shapely.box(0, 0, 8, 8) - shapely.box(1, 1, 7, 7)
    assert areas(xa.load(frame)) == ["64"]
    assert areas(xa.load(frame, start=(2, 2))) == ["36"]
    both = shapely.MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(1, 0, 2, 1)])
    with pytest.raises(xa.InvalidScene, match="overlaps"):
        xa.load(both)
    assert areas(xa.load(both, union=True)) == ["2"]
    assert areas(xa.load(shapely.LinearRing(SQUARE))) == ["16"]
    with pytest.raises(xa.FormatError, match=r"layers is for .*, not for GeoJSON"):
        xa.load(frame, layers="A")
    with pytest.raises(xa.FormatError, match="no area to read"):
        xa.load(shapely.Point(1, 2))


def test_coordinates_may_be_arrays_and_floats_are_exact() -> None:
    class Ring:
        """An object of another library."""

        @property
        def __geo_interface__(self) -> dict[str, Any]:
            return polygon(*np.array([[[0, 0], [0.1, 0], [0, 1], [0, 0]]]))

    assert xa.load(Ring()).obstacles[0].area == xa.Length(0.1) / 2


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ("[]", 'the document: an object with a "type" is needed'),
        ("{}", 'the document: an object with a "type" is needed'),
        ('{"type": [3]}', 'an object with a "type" is needed'),
        ('{"type": "Topology"}', "the document: no geometry of GeoJSON: 'Topology'"),
        ('{"type": "Polygon"}', "the document: coordinates: a list is needed, not None"),
        ('{"type": "Polygon", "coordinates": "0 0"}', "coordinates: a list is needed, not '0 0'"),
        ('{"type": "Polygon", "coordinates": [[]]}', "a ring without positions"),
        ('{"type": "Polygon", "coordinates": [[[0]]]}', "a position is two to four numbers"),
        ('{"type": "Polygon", "coordinates": [[["0", 0]]]}', "a number is needed, not the text '0'"),
        ('{"type": "Polygon", "coordinates": [[[0, null]]]}', "not a number: None"),
        ('{"type": "Polygon", "coordinates": [[[0, NaN]]]}', "not a number: 'NaN'"),
        ('{"type": "Polygon", "coordinates": [[[0, {}]]]}', "not a number: {}"),
        ('{"type": "FeatureCollection", "features": {}}', "features: a list is needed"),
        ('{"type": "FeatureCollection", "features": [7]}', r"features\[0\]: an object with a \"type\""),
        ('{"type": "Polygon", "type": "Polygon"}', "stands twice"),
        ('{"type": "GeometryCollection", "geometries": [' * 20, "not JSON"),
        ("[" * 100_000, "nested too deeply"),
        (json.dumps({"type": "Point", "coordinates": [1, 2]}), "no area to read .left out 1 Point."),
        ('{"type": "Polygon", "coordinates": [[' + "[0, 0], " * 900_000, "more than 200000 edges"),
        ('{"type": "Feature", "geometry": {"type": "Polygon", "coordinates": []},'
         '"properties": {"kind": "terrain"}}', "a ring without positions"),
    ],
)  # fmt: skip
def test_documents_that_are_none(tmp_path: Path, document: str, message: str) -> None:
    with pytest.raises(xa.FormatError, match=message) as caught:
        read(tmp_path, document)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400


def test_collections_nested_too_deeply(tmp_path: Path) -> None:
    document = polygon(SQUARE)
    for _ in range(20):
        document = {"type": "GeometryCollection", "geometries": [document]}
    with pytest.raises(xa.FormatError, match="nested more than 16 deep"):
        read(tmp_path, document)


@pytest.mark.parametrize(
    "ring",
    [
        "[[0.1, 0.3], [4, 0.3], [4, 4], [0.1, 4], [0.1, 0.30000000000000004], [0.1, 0.3]]",
        "[[0.1, 0.3], [4, 0.3], [4, 4], [0.1, 4], [0.10000000000000002, 0.29999999999999999]]",
        "[[4, 0.3], [4, 4], [0.1, 4], [0.1, 0.3], [4.0000000000000009, 0.3], [4, 0.3]]",
    ],
)
def test_a_ring_that_rounding_closes_is_closed(tmp_path: Path, ring: str) -> None:
    """Its last edge is shorter than the last digit tells, and may go back along the one before it."""
    document = f'{{"type": "Polygon", "coordinates": [{ring}]}}'
    scene = read(tmp_path, document)
    assert scene.shapes == read(tmp_path, polygon(json.loads(ring)[:4])).shapes
    (note,) = scene.notes
    assert note.startswith("left out the last vertex of 1 ring, the first one but for rounding: at most ")
    assert 0 < float(note.split()[-3]) < 1e-15
    line = read(tmp_path, document.replace("Polygon", "LineString").replace("[[[", "[[").replace("]]]", "]]"))
    assert areas(line) == areas(scene)


def test_a_short_edge_of_exact_numbers_stays(tmp_path: Path) -> None:
    """No double has so many digits: it is meant."""
    ring = "[[1, 1], [4, 1], [4, 4], [1, 4], [0.9999999999999999999999999, 1], [1, 1]]"
    scene = read(tmp_path, f'{{"type": "Polygon", "coordinates": [{ring}]}}')
    assert len(scene.shapes[0].vertices) == 5 and scene.notes == ()


def test_what_is_left_out_is_counted_in_words(tmp_path: Path) -> None:
    points = [{"type": "Point", "coordinates": [k, 9]} for k in range(2)]
    ways = [{"type": "LineString", "coordinates": [[k, 0], [k, 1]]} for k in range(3)]
    scene = read(tmp_path, {"type": "GeometryCollection", "geometries": [polygon(SQUARE), *points, *ways]})
    assert scene.notes == ("left out 2 Points, 3 open LineStrings",)
