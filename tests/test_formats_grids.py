"""Grids of cells: outlines against a flood fill, placement, thresholds, and broken files."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import PIL.Image
import pytest
import shapely
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import exactacq as xa
from exactacq.files import extras
from exactacq.files.grids.outlines import STEPS, outlines
from exactacq.files.loops.rational_arcs import rational_turn

DATA = Path(__file__).parent / "data"
GRIDS = arrays.arrays(bool, st.tuples(st.integers(1, 7), st.integers(1, 7)))
PLAN = [[0, 0, 0, 0], [0, 200, 255, 0], [0, 255, 100, 0], [0, 0, 0, 0]]


def areas(scene: xa.Scene) -> list[str]:
    return [str(obstacle.area) for obstacle in scene.obstacles]


def expected(blocked: np.ndarray, corners: str) -> shapely.Geometry:
    """The blocked cells with the stated rule, by shapely: the cuts are triangles added or taken away."""
    rows, columns = blocked.shape
    area = shapely.union_all([shapely.box(x, y, x + 1, y + 1) for y, x in np.argwhere(blocked)])
    for y in range(1, rows):
        for x in range(1, columns):
            sw, se, nw, ne = (bool(blocked[y - 1 + j, x - 1 + i]) for j in (0, 1) for i in (0, 1))
            if sw == ne and se == nw and sw != se:
                for (i, j), filled in (((-1, -1), sw), ((1, -1), se), ((-1, 1), nw), ((1, 1), ne)):
                    cut = shapely.Polygon([(x, y), (x + i / 4, y), (x, y + j / 4)])
                    if corners == "join" and not filled:
                        area |= cut
                    if corners == "part" and filled:
                        area -= cut
    return area


@given(GRIDS, st.sampled_from(["join", "part"]))
def test_outlines_are_the_boundary_of_what_is_blocked(blocked: np.ndarray, corners: str) -> None:
    rings = outlines(blocked, corners)
    found = shapely.Polygon()
    for ring in rings:
        polygon = shapely.Polygon([(x / STEPS, y / STEPS) for x, y in ring])
        assert polygon.is_valid
        found ^= polygon
    assert found.symmetric_difference(expected(blocked, corners)).area == 0
    lines = [shapely.LinearRing(ring) for ring in rings]
    assert not any(a.intersects(b) for k, a in enumerate(lines) for b in lines[:k])
    for ring in rings:  # no vertex along a straight line
        for (a, b), (c, d), (e, f) in zip(ring, ring[1:] + ring[:1], ring[2:] + ring[:2], strict=True):
            assert (c - a) * (f - d) != (d - b) * (e - c)


def test_a_board_of_touching_cells() -> None:
    board = np.indices((40, 40)).sum(axis=0) % 2 == 0
    assert len(outlines(board, "part")) == 800
    joined = outlines(board, "join")
    assert len(joined) == 1 + 38 * 38 // 2  # around all, and around each free cell that is not at the border


# -- maps of ROS -----------------------------------------------------------------------------------


def ros_map(folder: Path, **said: object) -> Path:
    PIL.Image.fromarray(np.array(PLAN, np.uint8)).save(folder / "plan.png")
    entries = {"image": "plan.png", "resolution": "0.5", "origin": "[-1, 2, 0]", "negate": 0, **said}
    path = folder / "map.yaml"
    path.write_text("".join(f"{key}: {value}\n" for key, value in entries.items() if value is not None))
    return path


def test_a_real_map() -> None:
    scene = xa.load(
        DATA / "turtlebot3.yaml",
        start=("-1/2", "-1/2"),
    )
    assert scene.enclosure is None and len(scene.obstacles) == 10
    assert sum(len(o.edges) for o in scene.obstacles) == 693
    assert "joined the blocked cells at 1 corner" in scene.notes[0]
    xa.audit(xa.sightseer(scene, "1/2"))


@pytest.mark.parametrize(
    ("said", "options", "found"),
    [
        ({}, {}, ["4"]),
        ({}, {"start": ("-1/4", "13/4")}, ["1"]),
        ({"occupied_thresh": "0.99"}, {}, ["4"]),
        ({"free_thresh": "0.1"}, {"unknown": "blocked", "start": ("1/4", "13/4")}, ["31/128"]),
        ({"negate": 1, "free_thresh": 0, "occupied_thresh": "0.3"}, {"corners": "part"}, ["1"]),
        ({"negate": "true", "occupied_thresh": "0.9"}, {}, ["33/64"]),
        ({"mode": "scale", "origin": "[0, 0]"}, {}, ["4"]),
    ],
)
def test_thresholds(
    tmp_path: Path, said: dict[str, object], options: dict[str, object], found: list[str]
) -> None:
    assert areas(xa.load(ros_map(tmp_path, **said), **options)) == found


def test_yaw_turns_about_the_origin_and_keeps_shapes(tmp_path: Path) -> None:
    straight = xa.load(ros_map(tmp_path)).obstacles[0]
    turned = xa.load(ros_map(tmp_path, origin="[-1, 2, 0.7]"))
    assert turned.obstacles[0].area == straight.area
    assert turned.obstacles[0].perimeter == straight.perimeter
    assert "rational rotation within" in turned.notes[0]
    angle = 0.7
    for a, b in zip(straight.edges, turned.obstacles[0].edges, strict=True):
        x, y = a.start.xy[0] + 1, a.start.xy[1] - 2
        assert b.start.xy[0] == pytest.approx(x * math.cos(angle) - y * math.sin(angle) - 1)
        assert b.start.xy[1] == pytest.approx(x * math.sin(angle) + y * math.cos(angle) + 2)


@given(st.integers(-(10**9), 10**9).map(lambda n: fmpq(n, 10**6)))
def test_a_rational_turn_is_a_rotation_within_its_bound(degrees: fmpq) -> None:
    (cosine, sine), far = rational_turn(degrees)
    assert cosine * cosine + sine * sine == 1
    assert 0 <= far < fmpq(1, 2**48)
    assert (float(xa.Real(cosine)), float(xa.Real(sine))) == pytest.approx(
        (math.cos(math.radians(float(xa.Real(degrees)))), math.sin(math.radians(float(xa.Real(degrees))))),
        abs=1e-12,
    )


def test_quarter_turns_are_exact() -> None:
    assert [rational_turn(fmpq(90 * k))[0] for k in range(4)] == [(1, 0), (0, 1), (-1, 0), (0, -1)]
    assert rational_turn(180 - fmpq(1, 10**30))[0] == (-1, 0)


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ({"image": None}, "there is no image: is this a map of map_server?"),
        ({"image": "none.png"}, "image none.png: no such file"),
        ({"image": "/dev/zero.png"}, "no such file"),
        ({"image": "map.yaml"}, "image: 'map.yaml' does not end in"),
        ({"resolution": None}, "there is no resolution"),
        ({"resolution": 0}, "a cell 0 wide"),
        ({"resolution": -1}, "a cell -1 wide"),
        ({"resolution": "wide"}, "resolution: not a number: 'wide'"),
        ({"origin": "[1]"}, r"origin: \[x, y, yaw\] is needed, not 1"),
        ({"origin": "[a, b, c]"}, "origin: not a number"),
        ({"origin": "[0, 0, 1e99]"}, "a yaw of"),
        ({"negate": "perhaps"}, "negate: 0 or 1 is needed"),
        ({"occupied_thresh": 2}, "occupied_thresh: a number from 0 to 1"),
        ({"mode": "raw"}, "mode: trinary or scale is read, not raw"),
        ({"mode": "{a: b}\n? x"}, "line 6: an entry like"),
        ({"negate": "0\nnegate: 0"}, "stands twice"),
        ({"note": "\nx: 1" * 300}, "lines are no map"),
    ],
)
def test_maps_that_are_none(tmp_path: Path, said: dict[str, object], message: str) -> None:
    with pytest.raises(xa.FormatError, match=message) as caught:
        xa.load(ros_map(tmp_path, **said))
    assert "\n" not in str(caught.value)


def test_yaml_with_lists_quotes_and_comments(tmp_path: Path) -> None:
    path = ros_map(tmp_path)
    wanted = areas(xa.load(path))
    path.write_text(
        '# a map\n---\nimage: "plan.png"  # beside\nresolution: 0.5\n'
        "origin:\n- -1\n- 2\n- 0.0\nnegate: 0\nfree_thresh: 0.196\n"
    )
    assert areas(xa.load(path)) == wanted
    (tmp_path / "plan.png").rename(tmp_path / "it's #1.png")
    path.write_text(path.read_text().replace('"plan.png"', '"it\'s #1.png"'))
    assert areas(xa.load(path)) == wanted


# -- images ----------------------------------------------------------------------------------------


def test_a_threshold_parts_dark_from_bright(tmp_path: Path) -> None:
    path = tmp_path / "plan.png"
    PIL.Image.fromarray(np.array(PLAN, np.uint8)).save(path)
    middle = ("3/2", "5/2")
    assert areas(xa.load(path, start=middle)) == ["3"]
    assert areas(xa.load(path, threshold="100/255", start=middle)) == ["4"]
    assert areas(xa.load(path, threshold="101/255", start=middle)) == ["3"]
    assert xa.load(path, threshold=0).obstacles == ()
    with pytest.raises(xa.FormatError, match="threshold: from 0 for black to 1"):
        xa.load(path, threshold=2)
    big = xa.load(path, resolution="1/10")
    assert areas(big) == ["4/25"]


@pytest.mark.parametrize("suffix", ["png", "bmp", "gif", "pgm"])
def test_formats_of_images_agree(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"plan.{suffix}"
    PIL.Image.fromarray(np.array(PLAN, np.uint8)).save(path)
    assert areas(xa.load(path)) == ["16"]
    assert areas(xa.load(path, start=("5/4", "5/4"))) != ["16"]


def test_see_through_pixels_are_free(tmp_path: Path) -> None:
    path = tmp_path / "plan.png"
    pixels = np.zeros((3, 3, 4), np.uint8)
    pixels[1, 1, 3] = 255
    PIL.Image.fromarray(pixels).save(path)
    assert areas(xa.load(path)) == ["1"]


@pytest.mark.parametrize(
    "data",
    [
        b"P2\n# plan\n2 2\n# most\n255\n0 255 # row\n255 0\n",
        b"P5 2 2 255\n\x00\xff\xff\x00",
        b"P5 2 2 65535\n\x00\x00\xff\xff\xff\xff\x00\x01",
        b"P5 2 2 255\n#\xff\xff\n",  # pixels of values 35, 255, 255 and 10, no comment
    ],
)
def test_pgm_in_text_and_bytes(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "plan.pgm"
    path.write_bytes(data)
    assert areas(xa.load(path)) == ["33/16"]
    assert areas(xa.load(path, corners="part")) == ["31/32", "31/32"]


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("a.pgm", b"P5 2 2 255\n\x00\xff\xff", "truncated"),
        ("a.pgm", b"P5 0 2 255\n\x00", "a grid of 0 x 2 cells"),
        ("a.pgm", b"P5 99999 99999 255\n\x00", "are more than the 16777216"),
        ("a.pgm", b"P5 2 2 0\n\x00\x00\x00\x00", "brightest value is 0"),
        ("a.pgm", b"P5 2 1 9\n\x09\x0a", "a value of 10, above its most of 9"),
        ("a.pgm", b"P2 2 1 9\n9", "without 2 values"),
        ("a.pgm", b"P2 2 1 9\n9 x", "without 2 values"),
        ("a.pgm", b"P2 3000 3000 9\n9", "save it as P5"),
        ("a.pgm", b"P6 2 2 255\n", "not a readable image"),
        ("a.pgm", b"P5", "not a PGM image"),
        ("a.pgm", b"P5" + b"\n#" * 2_000_000 + b"x", "not a PGM image"),
        ("a.png", b"\x89PNG\r\n\x1a\n", "not a readable image"),
        ("a.png", b"GIF89a", "not a readable image"),
        ("a.jpg", b"hello", "not a readable image"),
        ("a.png", b"%!PS-Adobe-3.0 EPSF-3.0", "not a readable image"),
    ],
)
def test_images_that_are_none(tmp_path: Path, name: str, data: bytes, message: str) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(xa.FormatError, match=message) as caught:
        xa.load(path)
    assert "\n" not in str(caught.value)


def test_an_image_of_too_many_pixels_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "bomb.png"
    PIL.Image.new("1", (20_000, 20_000)).save(path)
    assert path.stat().st_size < 100_000
    with pytest.raises(xa.FormatError, match="decompression bomb"):
        xa.load(path)


def test_more_pixels_than_are_taken(tmp_path: Path) -> None:
    path = tmp_path / "large.png"
    PIL.Image.new("1", (5000, 5000)).save(path)
    with pytest.raises(xa.FormatError, match="5000 x 5000 cells are more than"):
        xa.load(path)


def test_a_start_in_a_blocked_cell_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "game.map"
    path.write_text(GAME)
    for options in ({}, {"border": "open"}):
        with pytest.raises(xa.FormatError, match="lies in a blocked cell"):
            xa.load(path, start=("3/2", "3/2"), **options)


def test_noise_has_too_many_corners(tmp_path: Path) -> None:
    path = tmp_path / "noise.png"
    noise = np.random.default_rng(7).integers(0, 256, (700, 700), np.uint8)
    PIL.Image.fromarray(noise).save(path)
    with pytest.raises(xa.FormatError, match=r"outlines of \d+ corners are more than the 200000"):
        xa.load(path)


def test_an_extra_that_is_missing_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> object:
        raise ImportError(name)

    monkeypatch.setattr(extras, "import_module", missing)
    path = tmp_path / "plan.png"
    path.write_bytes(b"\x89PNG")
    with pytest.raises(
        xa.FormatError, match=r"this needs PIL: in a clone of exactacq, pip install '\.\[images\]'"
    ):
        xa.load(path)


# -- MovingAI and VisiLibity -----------------------------------------------------------------------

GAME = "type octile\nheight 3\nwidth 4\nmap\n.G.@\n.T.W\nSS.O\n"


def test_a_map_of_a_game(tmp_path: Path) -> None:
    path = tmp_path / "game.map"
    path.write_text(GAME)
    walled = xa.load(path, start=("1/2", "1/2"))
    assert areas(walled) == ["1", "9"] and walled.enclosure is not None
    assert areas(xa.load(path, border="open")) == ["3", "1"]
    with pytest.raises(xa.FormatError, match=r"give a start .* between \(0, 0\) and \(4, 3\)"):
        xa.load(path)
    with pytest.raises(xa.FormatError, match=r"union is for .*, not for MovingAI maps"):
        xa.load(path, union=True)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("type", "tape", "not a MovingAI map"),
        ("height 3", "height 4", "3 rows, but the height is 4"),
        ("width 4", "width 5", "row 0 has 4 cells, but the width is 5"),
        ("SS.O", "SX.O", "row 2, column 1: 'X' is none of"),
        ("height 3", "height 999999999", "more than the 16777216"),
        ("height 3", "height 0", "a grid of 4 x 0 cells"),
    ],
)
def test_maps_of_games_that_are_none(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = tmp_path / "game.map"
    path.write_text(GAME.replace(old, new))
    with pytest.raises(xa.FormatError, match=message):
        xa.load(path, start=("1/2", "1/2"))


ROOM = "//Environment Model\n//Outer Boundary\n0.0 0.0\n10 0\n10 10.0\n0 10\n"
ROOM += "//Hole\n2 2\n2 3\n4 3\n//////\n7 3\n6 4\n8 5\n"


def test_an_environment(tmp_path: Path) -> None:
    path = tmp_path / "room.environment"
    path.write_text(ROOM)
    scene = xa.load(path, start=(1, 1))
    assert areas(scene) == ["1", "3/2", "100"]
    assert scene.enclosure == xa.Polygon([(0, 0), (10, 0), (10, 10), (0, 10)], "boundary")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("//\n", "no polygon"),
        ("1 2 3\n", "line 1: a vertex is two numbers, not 3 words"),
        ("0 0\n1 x\n", "line 2: not a number: 'x'"),
        ("0 0\n1 1\n", "no polygon of three vertices"),
    ],
)
def test_environments_that_are_none(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "room.environment"
    path.write_text(text)
    with pytest.raises(xa.FormatError, match=message):
        xa.load(path)
