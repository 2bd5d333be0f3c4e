"""WKT and EWKT: areas and their arcs, which side of the rings is free, degenerate and broken text."""

from __future__ import annotations

from pathlib import Path

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

import exactacq as xa
from exactacq.files import wkt

DATA = Path(__file__).parent / "data"
ROUNDED = "CURVEPOLYGON(COMPOUNDCURVE((0 0, 4 0), CIRCULARSTRING(4 0, 5 1, 4 2), (4 2, 0 2, 0 0)))"
DISC = "CURVEPOLYGON(CIRCULARSTRING(10 0, 14 0, 10 0))"


def read(folder: Path, text: str, start: object = None, **options: object) -> xa.Scene:
    path = folder / "areas.wkt"
    path.write_text(text)
    return xa.load(path, start=start, **options)


def areas(scene: xa.Scene) -> list[str]:
    return [str(obstacle.area) for obstacle in scene.obstacles if not obstacle.is_enclosure]


def test_a_real_file_has_the_areas_that_shapely_finds() -> None:
    scene = xa.load(DATA / "inpa.wkt", start=(-100, -100))
    known = shapely.from_wkt((DATA / "inpa.wkt").read_text())
    assert len(scene.obstacles) == len(known.geoms) == 154
    assert sum(float(o.area) for o in scene.obstacles) == pytest.approx(known.area)
    assert scene.obstacles[1].label == "polygon 2" and scene.notes == ()


def test_numbers_are_the_decimals_of_the_file(tmp_path: Path) -> None:
    (shape,) = read(tmp_path, "SRID=4326;POLYGON((0.1 1e-3, 3 -.5, 1. 2, 0.1 1e-3))").shapes
    assert shape == xa.Polygon([("0.1", "1/1000"), (3, "-1/2"), (1, 2)], "polygon 1")


def test_arcs_are_kept(tmp_path: Path) -> None:
    scene = read(tmp_path, ROUNDED + "\n" + DISC)
    assert areas(scene) == ["pi/2 + 8", "4*pi"]
    assert scene.shapes[1] == xa.Circle((12, 0), 2, "polygon 2")


@pytest.mark.parametrize(
    ("text", "area"),
    [
        ("CIRCULARSTRING(1 0, 0 1, -1 0, 0 -1, 1 0)", "pi"),
        ("CIRCULARSTRING(0 0, 1 1, 0 0)", "pi/2"),
        ("CIRCULARSTRING(0 0, 1 2, 2 0, 1 1, 0 0)", None),
        ("COMPOUNDCURVE(CIRCULARSTRING(0 0, 1 1, 2 0), (2 0, 0 0))", "pi/2"),
        ("MULTICURVE((0 0, 1 0, 0 1, 0 0), CIRCULARSTRING(5 0, 6 0, 5 0))", "1/2"),
        ("LINESTRING(0 0, 1 0, 0 1, 0 0)", "1/2"),
        ("TRIANGLE((0 0, 1 0, 0 1, 0 0))", "1/2"),
        ("polygon zm ((0 0 7 8, 1 0 7 8, 0 1 7 8, 0 0 7 8))", "1/2"),
        ("POLYGONZ((0 0 7, 1 0 7, 0 1 7, 0 0 7))", "1/2"),
        ("GEOMETRYCOLLECTION(POINT(9 9), GEOMETRYCOLLECTION(POLYGON((0 0, 0 1, 1 0, 0 0))))", "1/2"),
        ("MULTISURFACE(((0 0, 1 0, 0 1, 0 0)), CURVEPOLYGON((5 0, 6 0, 5 1, 5 0)))", "1/2"),
        ("MULTIPOLYGON(((0 0, 1 0, 0 1, 0 0)), EMPTY, ((5 0, 6 0, 5 1, 5 0)))", "1/2"),
    ],
)
def test_kinds_of_areas(tmp_path: Path, text: str, area: str | None) -> None:
    found = areas(read(tmp_path, text))
    assert area is None or found[0] == area
    assert len(found) == (2 if "5 0" in text else 1)


NESTED = "MULTIPOLYGON(((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 8 1, 8 8, 1 8, 1 1)), ((3 3, 6 3, 6 6, 3 6, 3 3), "
NESTED += "(4 4, 5 4, 5 5, 4 5, 4 4)))"


@pytest.mark.parametrize(
    ("start", "wall", "obstacles"),
    [
        (None, None, ["81"]),
        ((-1, -1), None, ["81"]),
        (("1/2", 4), "81", ["49"]),
        ((2, 2), "49", ["9"]),
        (("7/2", 4), "9", ["1"]),
        (("9/2", "9/2"), "1", []),
        ((1, 4), "81", ["49"]),
    ],
)
def test_the_start_tells_which_side_is_free(
    tmp_path: Path, start: object, wall: str | None, obstacles: list[str]
) -> None:
    """A frame with an island in its hole, which has a hole too; the last start lies on a ring."""
    scene = read(tmp_path, NESTED, start)
    assert areas(scene) == obstacles
    room = [str(o.area) for o in scene.obstacles if o.is_enclosure]
    assert room == ([] if wall is None else [wall])


def test_a_run_in_a_room_with_arcs_passes_the_audit(tmp_path: Path) -> None:
    text = f"CURVEPOLYGON((-9 -9, 30 -9, 30 9, -9 9, -9 -9), {ROUNDED[13:-1]}, {DISC[13:-1]})"
    scene = read(tmp_path, text, start=(-1, -1))
    run = xa.sightseer(scene, 20)
    assert sorted(run.visits) == [0, 1, 2]
    xa.audit(run)


def test_what_was_mended_and_left_out_is_said(tmp_path: Path) -> None:
    text = """POLYGON((0 0, 0 0, 4 0, 4 0, 4 4, 0 4, 0 0, 0 0)); POLYGON((9 9, 8 8, 9 9)); POINT(1 1)
    LINESTRING(5 5, 6 6) LINESTRING(20 20, 21 21, 20 20) POLYGON((10 0 1, 12 0 1, 11 1 1)) POINT EMPTY"""
    scene = read(tmp_path, text)
    assert areas(scene) == ["16", "1"]
    assert scene.notes == (
        "took out 3 vertices equal to the one before",
        "left out 2 rings without area",
        "closed 1 ring whose last vertex was not the first",
        "left out the heights and measures of points",
        "left out 1 POINT, 1 open LINESTRING",
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("POLYGON((0 0, 4 0, 4 4, 0 4, 0 0), (0 0, 2 1, 1 2, 0 0))", "touches"),
        ("POLYGON((0 0, 4 0, 4 4, 0 4, 0 0), (0 1, 2 1, 1 2, 0 1))", "touches"),
        ("MULTIPOLYGON(((0 0, 1 0, 1 1, 0 0)), ((1 0, 2 0, 2 1, 1 0)))", "touches"),
        ("POLYGON((0 0, 2 2, 2 0, 0 2, 0 0))", "cross"),
        ("POLYGON((0 0, 1 0, 2 0, 0 0))", "overlap"),
        ("CIRCULARSTRING(0 0, 1 1, 2 0, 1 1, 0 0)", "overlap"),
    ],
)
def test_rings_that_meet_are_refused_with_the_place(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(xa.InvalidScene, match=message):
        read(tmp_path, text, start=(100, 100))


def test_neighbours_are_merged_on_request(tmp_path: Path) -> None:
    text = "MULTIPOLYGON(((0 0, 1 0, 1 1, 0 1, 0 0)), ((1 0, 2 0, 2 1, 1 1, 1 0)))"
    for start in (None, (9, 9)):
        assert areas(read(tmp_path, text, start, union=True)) == ["2"]
    merged = read(tmp_path, f"{ROUNDED} POLYGON((1 1, 2 1, 2 9, 1 1))", union=True)
    assert len(merged.obstacles) == 1
    assert any("merged" in note for note in merged.notes)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty"),
        ("hello", "line 1, column 1: a geometry such as POLYGON is needed, not 'hello'"),
        ("POLYGON((0 0, 1 0, 0 1", r"line 1, column 23: '\)' is needed, not the end"),
        ("POLYGON((0 0, 1 x, 0 1))", r"line 1, column 17: a point has two to four numbers, not 1"),
        ("POLYGON((0 0, 1 2e, 0 1))", r"line 1, column 17: a number is needed"),
        ("POLYGON((0 0, 1 nan, 0 1))", "a point has two to four numbers"),
        ("POLYGON((0 0, 1 1e9999999, 0 1))", "a number is needed"),
        ("POLYGON((0 0, 1 1/0, 0 1))", "a number is needed"),
        ("POLYGON(0 0, 1 1)", r"'\(' is needed, not '0 0, 1 1\)'"),
        ("\n POLYGON((0 0 0 0 0))", "line 2, column 20: a point has two to four numbers, not 5"),
        ("CIRCULARSTRING(0 0, 1 1)", "has 3, 5, 7 ... points, not 2"),
        ("CIRCULARSTRING(0 0, 1 1, 2 2, 3 3)", "has 3, 5, 7 ... points, not 4"),
        ("CIRCULARSTRING(0 0, 0 0, 0 0)", "vertex 0: an arc from a point to itself"),
        ("CURVEPOLYGON(CIRCULARSTRING(0 0, 3 0, 2 0, 1 1, 0 0))", "vertex 0: the third point"),
        ("CURVEPOLYGON(COMPOUNDCURVE((0 0, 1 0), (2 0, 0 0)))", "does not begin where"),
        ("CURVEPOLYGON(COMPOUNDCURVE(COMPOUNDCURVE((0 0, 1 0))))", "a line or an arc is needed"),
        ("CURVEPOLYGON(POLYGON((0 0, 1 0)))", "a line or an arc is needed"),
        ("TIN(((0 0, 1 0, 0 1, 0 0)))", "a geometry such as POLYGON is needed, not 'TIN"),
        ("SRID=x;POLYGON EMPTY", "a number is needed, not 'x;POLYGON EMPTY'"),
        ("POINT(1 1)", "no area to read .left out 1 POINT.; give polygons"),
        ("POLYGON((0 0, 1 1, 0 0))", "no area to read .left out 1 ring without area"),
        ("GEOMETRYCOLLECTION(" * 100_000, "collections are nested more than 16 deep"),
        ("POLYGON((" + "0 0," * 900_000, "more than 200000 edges"),
        ("POLYGON((0 0, " + "1" * 6000 + " 1))", "a number is needed"),
        ("\x00POLYGON", "a geometry is needed, not "),
    ],
)
def test_broken_text_is_one_line_with_the_place(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(xa.FormatError, match=message) as caught:
        read(tmp_path, text)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400


def test_words_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wkt, "MAX_TOKENS", 1000)
    with pytest.raises(xa.FormatError, match="more than 1000 words"):
        read(tmp_path, "POINT EMPTY " * 510)


def test_empty_geometries_are_an_empty_scene(tmp_path: Path) -> None:
    assert read(tmp_path, "POLYGON EMPTY").obstacles == ()


@given(st.lists(st.tuples(st.integers(-5, 5), st.integers(-5, 5)), min_size=3, max_size=6), st.booleans())
def test_rings_of_any_sense_read_as_polygons_do(
    tmp_path_factory: pytest.TempPathFactory, ring: list[tuple[int, int]], closed: bool
) -> None:
    """The oracle is the polygon made of the pairs, without those that repeat the one before."""
    kept = [p for k, p in enumerate(ring) if p != ring[k - 1]]
    text = ", ".join(f"{x} {y}" for x, y in ([*ring, ring[0]] if closed else ring))
    try:
        wanted = xa.Scene([xa.Polygon(kept)]).obstacles[0].area if len(kept) > 2 else None
    except xa.InvalidScene:
        wanted = "invalid"
    try:
        scene = read(tmp_path_factory.mktemp("wkt"), f"POLYGON(({text}))")
        assert scene.obstacles[0].area == wanted
    except xa.InvalidScene:
        assert wanted == "invalid"
    except xa.FormatError:
        assert wanted is None
