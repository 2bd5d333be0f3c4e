"""Scenes and results as files: what is written is read back, and no point moves by more than is said."""

from __future__ import annotations

import csv
import json
import re
import xml.etree.ElementTree as ET
from fractions import Fraction as Q
from itertools import pairwise
from pathlib import Path

import ezdxf
import pytest
import shapely
from flint import fmpq
from gallery_runs import gallery_run
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import exactacq as xa
from exactacq.files import gallery
from exactacq.files.formats import written_suffixes
from exactacq.files.whole_files import write_whole
from exactacq.files.writing.corners import bulge_of
from exactacq.files.writing.decimals import DIGITS, Precision, is_decimal
from exactacq.files.writing.dxf import written as dxf
from exactacq.files.writing.sheet import Item, Sheet
from exactacq.files.writing.svg import written as svg
from exactacq.files.writing.wkt import third_point
from exactacq.files.writing.wkt import written as wkt
from exactacq.geometry.curves import Arc, Curve
from exactacq.numbers.rationals import rational
from exactacq.output.sheets import sheet_of

EXACT = "every number is exact"
MIXED = xa.Scene(
    [
        xa.Circle(("2.5", "0.125"), "0.75", name="disc"),
        xa.Polygon([(5, 0), ("6.1", 0), ("6.1", "1.3")], name="triangle"),
        xa.Outline([(9, 0), (10, 0, "0.25"), (10, 1, "-0.5"), (9, 1)], name="bulged"),
        xa.Outline([(12, 0), (13, 0, xa.Around((12, 0))), (12, 1)], name="quarter"),
        xa.Outline([(15, 0), (17, 0, 1)], name="half"),
        xa.Outline([(20, 0), ("20.6", "0.2", xa.Around((20, 0))), ("19.8", "0.6")], name="turned"),
    ],
    start=(0, 0),
    radius=9,
    name="mixed",
)
ROOM = xa.Scene(
    [xa.Circle((4, 4), 1)],
    start=(1, 1),
    enclosure=xa.Outline([(0, 0), (8, 0, "0.5"), (8, 8), (0, 8)]),
)


@pytest.fixture(scope="module")
def run() -> xa.Run:
    return gallery_run("figure2")


def shapes(scene: xa.Scene) -> list[object]:
    """The shapes without their names, which drawings do not hold."""

    def bare(shape: object) -> object:
        if isinstance(shape, xa.Circle):
            return shape.center, shape.radius
        return None if shape is None else shape.vertices  # type: ignore[attr-defined]

    return [*map(bare, scene.shapes), bare(scene.enclosure)]


# -- scenes, written and read ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", [n for n in gallery.names() if n != "plate"])
def test_json_is_the_scene(name: str, tmp_path: Path) -> None:
    scene = gallery.scene(name)
    assert xa.write(scene, tmp_path / "s.json") == (EXACT,)
    assert xa.load(tmp_path / "s.json") == scene


def test_json_of_a_room_with_notes(tmp_path: Path) -> None:
    plate = gallery.scene("plate")
    xa.write(plate, tmp_path / "s.json")
    assert xa.load(tmp_path / "s.json") == plate


@pytest.mark.parametrize("scene", [MIXED, ROOM], ids=["mixed", "room"])
def test_wkt_is_the_scene(scene: xa.Scene, tmp_path: Path) -> None:
    assert xa.write(scene, tmp_path / "s.wkt")[0] == EXACT
    again = xa.load(tmp_path / "s.wkt", start=scene.start)
    assert shapes(again) == shapes(scene)


@pytest.mark.parametrize("scene", [MIXED, ROOM], ids=["mixed", "room"])
def test_dxf_is_the_scene_but_for_irrational_bulges(scene: xa.Scene, tmp_path: Path) -> None:
    names = ["quarter", "turned"]
    kept = [shape for shape in scene.shapes if shape.name not in names]
    plain = xa.Scene(kept, scene.start, enclosure=scene.enclosure, radius=scene.radius)
    assert xa.write(plain, tmp_path / "s.dxf") == (EXACT,)
    again = xa.load(tmp_path / "s.dxf", start=scene.start, tolerance=0)
    assert shapes(again) == shapes(plain)
    if kept != list(scene.shapes):
        (said,) = xa.write(scene, tmp_path / "s.dxf")
        assert re.fullmatch(r"no point lies more than \d.*e-1[67] from its exact place", said)


def test_geojson_of_polygons_is_the_scene(tmp_path: Path) -> None:
    squares = gallery.scene("squares")
    assert xa.write(squares, tmp_path / "s.geojson") == (EXACT,)
    again = xa.load(tmp_path / "s.geojson")
    assert shapes(again) == shapes(squares)
    assert again.start == squares.start and again.terrain == squares.terrain
    assert [s.name for s in again.shapes] == [o.label for o in squares.obstacles]


@pytest.mark.parametrize("suffix", [".dxf", ".wkt"])
def test_what_was_rounded_once_is_rounded_no_more(suffix: str, tmp_path: Path) -> None:
    """The bulges of the plate are fractions: written once they are decimals, and those stay."""
    plate = gallery.scene("plate")
    options = {"tolerance": 0} if suffix == ".dxf" else {}
    first, second = (tmp_path / f"{k}{suffix}" for k in (1, 2))
    assert xa.write(plate, first)[0] != EXACT
    once = xa.load(first, start=plate.start, **options)
    assert [len(s) if s else 0 for s in shapes(once)] == [len(s) if s else 0 for s in shapes(plate)]
    said = xa.write(once, second)[0]
    twice = xa.load(second, start=plate.start, **options)
    assert said == EXACT or suffix == ".wkt"
    assert said != EXACT or shapes(twice) == shapes(once)


def test_each_format_opens_elsewhere(tmp_path: Path) -> None:
    for suffix in written_suffixes():
        xa.write(MIXED, tmp_path / f"s{suffix}")
    drawing = ezdxf.readfile(tmp_path / "s.dxf")
    assert not drawing.audit().has_errors
    assert {e.dxf.layer for e in drawing.modelspace()} == {"obstacles", "start"}
    areas = [
        shapely.geometry.shape(f["geometry"])
        for f in json.loads((tmp_path / "s.geojson").read_text())["features"]
    ]
    assert sum(a.area for a in areas) == pytest.approx(sum(float(o.area) for o in MIXED.obstacles), rel=1e-3)
    assert all(a.is_valid for a in areas)
    root = ET.fromstring((tmp_path / "s.svg").read_text())
    assert [g.get("id") for g in root.iter("{http://www.w3.org/2000/svg}g")][1:] == ["obstacles", "start"]
    rows = list(csv.DictReader((tmp_path / "s.csv").open(newline="")))
    assert {row["shape"] for row in rows} == {"arc", "segment", "point"}
    assert rows[0]["radius"] == "0.75" and rows[0]["name"] == "disc"


# -- results ---------------------------------------------------------------------------------------------


def test_a_run_in_layers(run: xa.Run, tmp_path: Path) -> None:
    (said, _) = xa.write(run, tmp_path / "run.dxf")
    assert said.startswith("no point lies more than")
    space = ezdxf.readfile(tmp_path / "run.dxf").modelspace()
    count = {
        layer: len(space.query(f'*[layer=="{layer}"]')) for layer in ("path", "links", "events", "known")
    }
    assert count == {
        "path": 1,
        "links": len(run.links),
        "events": len(run.events),
        "known": len(run.obstacles),
    }
    (path,) = space.query('LWPOLYLINE[layer=="path"]')
    assert any(bulge for *_, bulge in path.get_points("xyb"))
    assert not path.closed


def test_a_run_as_json_is_its_run_file(run: xa.Run, tmp_path: Path) -> None:
    assert xa.write(run, tmp_path / "run.json") == (EXACT,)
    assert xa.load_run(tmp_path / "run.json") == run


def test_a_moment_of_a_run(run: xa.Run) -> None:
    sheet = sheet_of(run, at=100)
    assert set(sheet.layers) == {
        "obstacles",
        "terrain",
        "start",
        "known",
        "frontier",
        "view",
        "path",
        "robot",
    }
    (path,) = (item for item in sheet.items if item.layer == "path")
    assert path.properties["length"] == pytest.approx(100)


def test_parts_of_a_run(run: xa.Run, tmp_path: Path) -> None:
    for part, layers in ((run.path, ["path"]), (run.links, ["links"]), (run.map, ["known"])):
        assert list(sheet_of(part).layers) == layers
    view = run.view_at(10)
    assert set(sheet_of(view).layers) <= {"view", "rays", "viewpoint"}
    xa.write(view, tmp_path / "v.geojson", only="view")
    (feature,) = json.loads((tmp_path / "v.geojson").read_text())["features"]
    assert shapely.geometry.shape(feature["geometry"]).area == pytest.approx(float(view.area), rel=1e-3)


def test_a_sweep_writes_diversions(tmp_path: Path) -> None:
    run = xa.seed_spreader(gallery.scene("case3"))
    xa.write(run, tmp_path / "run.csv", only="diversions")
    (row,) = csv.DictReader((tmp_path / "run.csv").open(newline=""))
    assert row["reason"] == "out of sight"


def test_what_never_moves_and_what_is_empty(tmp_path: Path) -> None:
    still = xa.sightseer(xa.Scene([], start=(1, 2), radius=1))
    for suffix in written_suffixes():
        xa.write(still, tmp_path / f"s{suffix}")
        if suffix != ".json":
            xa.write(still.path, tmp_path / f"p{suffix}")
            xa.write((), tmp_path / f"l{suffix}")
    assert (tmp_path / "l.wkt").read_text() == "GEOMETRYCOLLECTION EMPTY\n"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda d: xa.write(MIXED, d / "s.stl"), "must end in .json, .wkt"),
        (lambda d: xa.write(3, d / "s.dxf"), "or its links are written, not 3"),
        (lambda d: xa.write("circles", d / "s.dxf"), "are written, not 'circles'"),
        (lambda d: xa.write(MIXED, d / "s.dxf", at=3), "only a run has moments"),
        (lambda d: xa.write(MIXED, d / "s.dxf", only="path"), "nothing is of the kind 'path'; there are obs"),
        (lambda d: xa.write(MIXED, d / "s.json", only="start"), "holds a whole scene or a whole run"),
        (lambda d: xa.write(xa.isovist(MIXED, (0, 0)), d / "s.json"), "holds a whole scene or a whole run"),
        (lambda d: xa.load(d / "s.csv"), "CSV tables are written, but not read"),
    ],
)
def test_refusals_write_nothing(make: object, message: str, tmp_path: Path) -> None:
    with pytest.raises(xa.FormatError, match=message):
        make(tmp_path)  # type: ignore[operator]
    assert not list(tmp_path.iterdir())


def test_the_same_subject_gives_the_same_bytes(run: xa.Run, tmp_path: Path) -> None:
    for suffix in written_suffixes():
        for name in "ab":
            xa.write(run, tmp_path / f"{name}{suffix}")
        assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


# -- bounds ------------------------------------------------------------------------------------------------

numbers = st.builds(
    lambda n, d, e: rational(Q(n, d) * Q(10) ** e),
    st.integers(-(10**6), 10**6),
    st.integers(1, 99),
    st.integers(-3, 3),
)
roots = st.builds(lambda n, k: xa.Real(abs(n) + 1).sqrt() * k, numbers, st.integers(-5, 5))


@given(st.one_of(numbers.map(xa.Real), roots), st.sampled_from([None, -2, 0, 5, 30]))
def test_rounding_stays_within_its_bound(value: xa.Real, places: int | None) -> None:
    near, bound = Precision(places).rounded(value)
    assert is_decimal(near)
    assert abs(value - near).compare(bound) <= 0
    if places is not None and bound:
        assert bound < fmpq(10) ** -places
    if value.rational is not None and bound == 0:
        assert near == value.rational


@given(numbers, numbers, numbers, st.fractions(-3, 3, max_denominator=40).filter(bool))
@settings(suppress_health_check=[HealthCheck.filter_too_much])
def test_arcs_stay_within_their_bounds(x: fmpq, y: fmpq, dx: fmpq, bulge: Q) -> None:
    """Points of the exact arc, and those of the arcs that the files tell, in exact numbers."""
    if not dx:
        return
    arc = Arc.from_bulge(xa.Point(x, y), xa.Point(x + dx, y - dx / 3), rational(bulge))
    sheet = Sheet("", (Item("path", (arc,)),))
    for written, read in ((dxf, dxf_arcs), (wkt, wkt_arcs), (svg, svg_arcs)):
        content = written(sheet)
        found = read(content.data.decode())
        for k in range(9):
            point = arc.point(fmpq(k, 8))
            assert min(distance(curve, point) for curve in found) <= float(content.moved) + 1e-30, written


def distance(curve: Curve, point: xa.Point) -> float:
    """From a point to a curve, in floats of differences that are exact or have 50 digits."""
    ends = min(float((point - end).norm_sq().sqrt()) for end in (curve.start, curve.end))
    if not isinstance(curve, Arc):
        return ends
    apart = float(abs((point - curve.center).norm_sq().sqrt() - curve.radius))
    return min(apart, ends) if curve.contains(point) else ends


def dxf_arcs(data: str) -> list[Curve]:
    """The edges of the one polyline of a file."""
    text = data[data.index("AcDbPolyline") :]
    rows: list[list[fmpq]] = []
    for code, value in re.findall(r"\n +(10|20|42)\n(\S+)", text[: text.index("ENDSEC")]):
        rows.append([]) if code == "10" else None
        rows[-1].append(rational(value))
    points = [xa.Point(row[0], row[1]) for row in rows]
    return [
        Arc.from_bulge(a, b, row[2]) if len(row) > 2 and row[2] else xa.Segment(a, b)
        for a, b, row in zip(points, points[1:], rows, strict=False)
    ]


def wkt_arcs(text: str) -> list[Curve]:
    """The arcs of a CIRCULARSTRING, or the edge of a LINESTRING."""
    kind, _, rest = text.partition(" ")
    places = [xa.Point(*map(rational, pair.split())) for pair in rest.strip(" ()\n").split(",")]
    if kind == "LINESTRING":
        return [xa.Segment(a, b) for a, b in pairwise(places)]
    found: list[Curve] = []
    for a, m, b in zip(places[::2], places[1::2], places[2::2], strict=False):
        through = xa.Outline([a.rational, (*m.rational, 0), b.rational])  # type: ignore[misc]
        assert through is not None
        found.append(circle_through(a, m, b))
    return found


def circle_through(a: xa.Point, m: xa.Point, b: xa.Point) -> Arc:
    """The arc from a over m to b, by the equations of its centre."""
    (u, v), (p, q) = (m - a), (b - a)
    turn = 2 * (u * q - v * p)
    first, second = u * u + v * v, p * p + q * q
    offset = xa.Point((q * first - v * second) / turn, (u * second - p * first) / turn)
    return Arc(a, b, a + offset, offset.norm_sq().rational, ccw=turn.sign() > 0)  # type: ignore[arg-type]


def svg_arcs(text: str) -> list[Curve]:
    """The edges of the one path of a document."""
    data = re.search(r' d="([^"]*)"', text)[1]  # type: ignore[index]
    here = None
    found: list[Curve] = []
    for command, arguments in re.findall(r"([MLAhZ])([^MLAhZ]*)", data):
        values = arguments.split()
        if command in "hZ":
            continue
        there = xa.Point(*map(rational, values[-2:]))
        if command == "A":
            radius, large, ccw = rational(values[0]), values[3] == "1", values[4] == "1"
            found.append(svg_arc(here, there, radius, large, ccw))
        elif command == "L":
            found.append(xa.Segment(here, there))
        here = there
    return found


def svg_arc(start: xa.Point, end: xa.Point, radius: fmpq, large: bool, ccw: bool) -> Arc:
    """What the specification of SVG says, with 60 digits of the centre."""
    chord = end - start
    square = xa.Real(radius * radius) / chord.norm_sq() - fmpq(1, 4)
    height = square.sqrt() if square.sign() > 0 else xa.Real(0)
    side = height if large != ccw else -height
    center = start + chord * fmpq(1, 2) + chord.left() * side
    near = xa.Point(*(sum(c.enclosure(400)) / 2 for c in center))
    return Arc(start, end, near, radius * radius, ccw)


@given(st.integers(0, 40), st.integers(1, 39), st.booleans())
def test_third_points(first: int, more: int, ccw: bool) -> None:
    """A point of the arc, inside it, whenever its ends are turned from each other by the known angles."""

    def turned(k: int) -> xa.Point:
        x, y = fmpq(1), fmpq(0)
        for _ in range(k % 7):
            x, y = (3 * x - 4 * y) / 5, (4 * x + 3 * y) / 5
        for _ in range(k // 7 % 4):
            x, y = -y, x
        return xa.Point(x + fmpq(1, 4), y)

    a, b = turned(first), turned(first + more)
    if a == b:
        return
    arc = Arc(a, b, xa.Point(fmpq(1, 4), 0), fmpq(1), ccw)
    found = third_point(arc)
    if found is None:
        assert float(arc.length) < 0.3
    else:
        assert arc.passes(xa.Point(*found)) and xa.Point(*found) not in (a, b)
        assert all(map(is_decimal, found))


def test_bulges() -> None:
    quarter = Arc(xa.Point(1, 0), xa.Point(0, 1), xa.Point(0, 0), fmpq(1), ccw=True)
    assert bulge_of(quarter) == xa.Real(2).sqrt() - 1
    assert bulge_of(Arc.from_bulge(xa.Point(0, 0), xa.Point(1, 0), fmpq(-7, 3))) == fmpq(7, 3)


def test_digits_follow_the_size() -> None:
    for power in (-40, 0, 40):
        unit = fmpq(10) ** power
        sheet = Sheet("", (Item("path", (xa.Segment((0, 0), (unit / 3, unit * 2)),)),))
        assert Precision.of(sheet).places == DIGITS - power - 1
        content = wkt(sheet)
        assert 0 < content.moved < unit / 10**15


@pytest.mark.parametrize("scene", [MIXED, ROOM], ids=["mixed", "room"])
def test_svg_is_the_scene_where_radii_are_decimals(scene: xa.Scene, tmp_path: Path) -> None:
    kept = [s for s in scene.shapes if s.name not in ("bulged", "quarter", "turned")]
    wall = scene.enclosure if scene is MIXED else xa.Polygon([(0, 0), (9, 0), (9, "9.5"), (0, "9.5")])
    plain = xa.Scene(kept, scene.start, enclosure=wall, radius=scene.radius)
    assert xa.write(plain, tmp_path / "s.svg") == (EXACT,)
    assert shapes(xa.load(tmp_path / "s.svg", start=scene.start, tolerance=0)) == shapes(plain)


def test_svg_shows_the_border_of_a_terrain_which_is_no_wall(tmp_path: Path) -> None:
    """It was read again as one: the bar was left out as within it."""
    swept = xa.load("m20-3")
    xa.write(swept, tmp_path / "s.svg")
    assert 'data-kind="terrain"' in (tmp_path / "s.svg").read_text()
    again = xa.load(tmp_path / "s.svg", start=(0, 0), tolerance=0)
    assert shapes(again) == shapes(swept) and again.notes[0] == "left out 1 border of a terrain"


def test_svg_is_xml_whatever_names_are(tmp_path: Path) -> None:
    """Control characters were written as they are, and the file was refused."""
    named = xa.Scene([xa.Circle((3, 0), 1, name="red\x1b[31m <&>")], (0, 0), name="a\x00\x7f b")
    xa.write(named, tmp_path / "s.svg")
    assert shapes(xa.load(tmp_path / "s.svg", start=(0, 0))) == shapes(named)
    assert "red [31m &lt;&amp;&gt;" in (tmp_path / "s.svg").read_text()


decimals = st.integers(-900, 900).map(lambda n: Q(n, 1000))
bulges = st.sampled_from(["0", "0.25", "-0.125", "0.0625", "0.3", "-0.07"])


@st.composite
def rooms_of_triangles(draw: st.DrawFn) -> xa.Scene:
    """Triangles with bent edges, each in a cell of its own, of decimals with three places."""
    found = []
    for k in range(draw(st.integers(1, 4))):
        corners = [(-1, -1), (1, -1), (0, 1)]
        moved = [(2 * x + draw(decimals) / 2 + 10 * k, 2 * y + draw(decimals) / 2 + 10) for x, y in corners]
        found.append(xa.Outline([(x, y, draw(bulges)) for x, y in moved], f"T{k}"))
    if draw(st.booleans()):
        found.append(xa.Circle((draw(decimals), draw(decimals) - 10), draw(decimals) + 1, "disc"))
    return xa.Scene(found, start=("0.5", "-50"), radius=9, name="random")


@given(rooms_of_triangles())
@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_round_trips_are_exact(tmp_path: Path, scene: xa.Scene) -> None:
    for suffix, options in ((".json", {}), (".wkt", {}), (".dxf", {"tolerance": 0})):
        path = tmp_path / f"s{suffix}"
        assert xa.write(scene, path)[0] == EXACT
        again = xa.load(path, start=("0.5", "-50"), **options)
        assert shapes(again) == shapes(scene)
        assert suffix != ".json" or again == scene


def test_an_error_of_writing_names_the_file(tmp_path: Path) -> None:
    """Not the one beside it that is written first."""
    target = tmp_path / "nowhere" / "scene.json"
    with pytest.raises(OSError, match="No such file") as raised:
        write_whole(target, b"{}")
    assert raised.value.filename == str(target)
