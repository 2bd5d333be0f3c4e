"""Files as people have them: each is read, or refused in one line that says what to do about it."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import exactacq as xa
from exactacq import cli

DATA = Path(__file__).parent / "data"
OUTSIDE = (-1000, "-1000.5")
"""A start outside every drawing, so that outlines are obstacles."""
UNION, OPEN = "with --union it is a scene", "no closed loop"
MENDED = "no option mends a boundary that meets itself: part it in the file where it does"

# What each file is with an outside start, or with no start where it needs none: how many obstacles it has,
# or the cure that its refusal names and how many obstacles it has then.
READ: dict[str, int] = {
    "1001.dxf": 1, "gear.dxf": 1, "vslot-2020_1.dxf": 1, "issue21.dxf": 1, "forms.dxf": 22, "outline.dxf": 1,
    "ref_dxf_complex.dxf": 1, "board.kicad_pcb": 1, "bandaid.svg": 1, "boombox.svg": 1, "bricks.svg": 1,
    "browser-safari.svg": 1, "buildings.svg": 1, "calculator.svg": 1, "film.svg": 1, "grid-3x3-gap.svg": 9,
    "keyboard.svg": 1, "list-columns.svg": 16, "vignette.svg": 1, "inpa.wkt": 154, "turtlebot3.pgm": 10,
    "turtlebot3.yaml": 10, "extremity.json": 2, "arcs/samecircle-a10715.json": 1,
    "arcs/samecircle-a10738.json": 1, "arcs/samecircle-b182.json": 2, "arcs/samecircle-b193.json": 1,
    "arcs/samecircle-b196.json": 1, "arcs/samecircle-b225.json": 2, "undecided/arcs-1371.json": 4,
    "undecided/arcs-3029.json": 3, "undecided/arcs-3358.json": 6, "undecided/rounded-squares.json": 8,
    "undecided/thickened.json": 2, "pads_of_two_arcs.json": 6, "pads_of_three_arcs.json": 4,
}  # fmt: skip
REFUSED: dict[str, tuple[str, dict[str, object], int]] = {
    "issue39.dxf": (UNION, {"union": True}, 1),
    "ref_dxf_metric.dxf": (UNION, {"union": True}, 2),
    "undecided/example009.dxf": (UNION, {"layers": "plate"}, 1),
    "mousebites.dxf": ("--thicken LENGTH for walls along the lines", {"thicken": 1}, 18),
    "qr-code-scan.svg": (f"{MENDED}; --layers reads a part", {}, 0),
}
NO_START = (".wkt", ".json", ".pgm", ".yaml")


def load(name: str, **options: object) -> xa.Scene:
    start = {} if name.endswith(NO_START) else {"start": OUTSIDE}
    return xa.load(DATA / name, **start, **options)


def test_the_table_has_every_file() -> None:
    known = {suffix for f in xa.formats() if f.reader is not None for suffix in f.suffixes}
    found = {str(path.relative_to(DATA)) for path in DATA.rglob("*") if path.suffix in known}
    runs = {name for name in found if name.startswith("runs/")}
    assert found - runs == READ.keys() | REFUSED.keys()


@pytest.mark.parametrize("name", READ)
def test_is_read(name: str) -> None:
    assert len(load(name).shapes) == READ[name]


@pytest.mark.parametrize("name", REFUSED)
def test_is_refused_with_a_cure_that_cures(name: str) -> None:
    cure, options, count = REFUSED[name]
    with pytest.raises(xa.ExactacqError, match=re.escape(cure)) as refused:
        load(name)
    assert "\n" not in str(refused.value)
    if options:
        assert len(load(name, **options).shapes) == count


@pytest.mark.parametrize("name", [name for name in READ if not name.endswith(NO_START)])
def test_a_drawing_without_a_start_says_what_to_give(name: str) -> None:
    with pytest.raises(xa.FormatError, match=r"give one with --start X,Y .*; this one spans x .* to .*, y "):
        xa.load(DATA / name)


def test_buildings_that_share_walls(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One line tells few violations of many, but always what to do; the check tells all."""
    squares = [[[x, 0], [x + 1, 0], [x + 1, 1], [x, 1], [x, 0]] for x in range(30)]
    path = tmp_path / "row.geojson"
    path.write_text(json.dumps({"type": "MultiPolygon", "coordinates": [[ring] for ring in squares]}))
    assert cli.main(["explore", str(path), "--start=-1,-1", "--radius", "2"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "29 violations" in line and "and 26 more" in line and line.endswith(UNION)
    assert cli.main(["check", str(path)]) == 2
    assert "not OK: 29 violations" in capsys.readouterr().out
    assert cli.main(["check", str(path), "--union"]) == 0
    assert "merged" in capsys.readouterr().out


# -- JSON that others write ------------------------------------------------------------------------------


def test_an_environment_of_extremitypathfinder() -> None:
    scene = xa.load(DATA / "extremity.json", start=(6, 5))
    assert scene.enclosure == xa.Polygon([(0, 0), (10, 0), (9, 5), (10, 10), (0, 10)], "boundary")
    assert scene.shapes[0].name == "hole 1"
    assert sum(len(obstacle.edges) for obstacle in scene.obstacles) == 13


def test_geojson_under_the_suffix_of_json(tmp_path: Path) -> None:
    area = {"type": "Polygon", "coordinates": [[[2, 2], [3, 2], [3, 3.5], [2, 2]]]}
    path = tmp_path / "a.json"
    for document in (
        area,
        {"type": "Feature", "geometry": area, "properties": {}},
        {"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": area}]},
        {"type": "GeometryCollection", "geometries": [area]},
    ):
        path.write_text(json.dumps(document))
        (shape,) = xa.load(path, start=(0, 0)).shapes
        assert shape == xa.Polygon([(2, 2), (3, 2), (3, "3.5")], "polygon 1")


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ({"boundary": [[0, 0], [1, 0], [0, 1]], "holes": 3}, "holes: a list is needed, not '3'; correct"),
        ({"boundary": [[0, 0], [1, 0]], "holes": []}, "boundary: three vertices are needed; correct"),
        ({"boundary": [[0, 0], [1, 0], [0, 1]], "holes": [[[0, 0], [1]]]}, "hole 1: a point needs two"),
        ({"boundary": [], "holes": [], "grid": 1}, "has a boundary and holes, not 'grid'; leave it out"),
        ({"boundary": []}, "unknown key 'boundary'"),
    ],
)
def test_environments_that_are_none(document: object, message: str, tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(json.dumps(document))
    with pytest.raises(xa.FormatError, match=message):
        xa.load(path)


def test_a_run_is_no_scene(tmp_path: Path) -> None:
    path = tmp_path / "run.json"
    xa.write(xa.sightseer(xa.load("squares")), path)
    with pytest.raises(xa.FormatError, match=r"this is a run, not a scene: exactacq.load_run reads it"):
        xa.load(path)


def test_a_cure_is_kept_in_copies() -> None:
    import pickle

    error = xa.InvalidScene(["one", "two"], "do this")
    again = pickle.loads(pickle.dumps(error))
    assert (again.violations, again.cure, str(again)) == (("one", "two"), "do this", "one; two; do this")
    assert str(xa.InvalidScene(["one"])) == "one"
