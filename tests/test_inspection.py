"""What is told of files before anything is decided: each cure cures, each start is free, each command works.

Whether a start is free, and how wide gaps are, is asked of shapely. That a cure cures is read off the file as
it is then: by the options that the words say.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from random import Random

import ezdxf
import networkx as nx
import numpy as np
import pytest
import shapely
from flint import fmpq
from nightly import NIGHTLY, some

import exactacq as xa
from exactacq import cli
from exactacq.cli.options import read_from_text
from exactacq.files.checking import cures
from exactacq.files.checking.starts import rounded, rounded_up, widest_gap
from exactacq.files.dxf import entities
from exactacq.files.formats import options
from exactacq.scene import validation

DATA = Path(__file__).parent / "data"
FILES = sorted(
    path
    for path in DATA.rglob("*")
    if path.suffix in (".dxf", ".svg", ".wkt", ".yaml", ".kicad_pcb") or path.parent.name == "arcs"
)
EVERY_DAY = (
    "board.kicad_pcb", "bricks.svg", "film.svg", "buildings.svg", "issue21.dxf", "mousebites.dxf",
    "samecircle-b182.json", "turtlebot3.yaml", "vignette.svg",
)  # fmt: skip
"""Of each format but WKT, whose file takes long; some are legal as they are, some have violations or open
chains with cures."""
CHOSEN = [path for path in FILES if NIGHTLY or path.name in EVERY_DAY]
SMALL = [path for path in CHOSEN if path.stat().st_size < 60_000]
SLOW = ("ref_dxf_complex.dxf", "outline.dxf", "browser-safari.svg", "mousebites.dxf", "turtlebot3.yaml")
"""The runs that are proposed for them take long; that their starts are free is tested."""
TRIED = [path for path in SMALL if path.name not in SLOW and path.suffix != ".wkt"]


@cache
def inspected(path: Path) -> xa.Inspection:
    return xa.inspect(path)


def drawing(path: Path, *lines: Iterable[tuple[float, float]], layers: dict[int, str] | None = None) -> Path:
    """A drawing of polylines; one is closed if its last place is the first."""
    document = ezdxf.new()
    for k, line in enumerate(lines):
        places = list(line)
        closed = places[0] == places[-1]
        look = {"layer": (layers or {}).get(k, "0")}
        document.modelspace().add_lwpolyline(places[:-1] if closed else places, close=closed, dxfattribs=look)
    document.saveas(path)
    return path


def box(x: float, y: float, w: float, h: float) -> list[tuple[float, float]]:
    return [(x, y), (x + w, y), (x + w, y + h), (x, y + h), (x, y)]


def said(words: str) -> dict[str, object]:
    """The options that words of a command line stand for."""
    values: dict[str, object] = {}
    parts = shlex.split(words)
    while parts:
        name, _, value = parts.pop(0).removeprefix("--").partition("=")
        values[name] = True if options()[name].kind == "flag" else value or parts.pop(0)
    return read_from_text(values)


def near(flaw: object, others: Iterable[object], reach: float) -> bool:
    """Whether a violation is still there."""
    return any(
        np.hypot(*np.subtract(p.xy, q.xy)) <= reach
        for other in others
        for p in flaw.places  # type: ignore[attr-defined]
        for q in other.places  # type: ignore[attr-defined]
    )


def check_start(found: xa.Inspection) -> None:
    """The start is free by shapely, up to the flatness of its chords, and the file loads around it."""
    assert found.scene is not None and found.start is not None and found.options is not None
    start = shapely.Point(*map(float, map(str, map(float, (xa.Real(c) for c in found.start)))))
    for obstacle in found.scene.obstacles:
        area = shapely.geometry.shape(obstacle.__geo_interface__["geometry"]).buffer(0)
        assert area.contains(start) == obstacle.is_enclosure
        assert area.boundary.distance(start) > 0


def check_cures(path: Path, found: xa.Inspection, **options: object) -> None:
    size = max(np.subtract(*found.extent[::-1])) if found.extent else 1
    again = {words: None for flaw in found.violations for words in flaw.cures}
    for words in again:
        again[words] = xa.inspect(path, **{**options, **said(words)})
    for flaw in found.violations:
        for words in flaw.cures:
            assert not near(flaw, again[words].violations, 1e-9 * size), (flaw, words)


# -- laws, on real files and on random ones --------------------------------------------------------


@pytest.mark.parametrize("path", CHOSEN, ids=lambda path: path.name)
def test_starts_are_free_and_cures_cure(path: Path) -> None:
    found = inspected(path)
    assert found.ok == (
        not found.violations and not any(c.encloses for c in found.open_chains) and not found.trouble
    )
    check_cures(path, found)
    if found.scene is None:
        assert found.violations and found.start is None and found.command == ""
        return
    if found.contents.start is None:
        check_start(found)
    assert xa.load(path, start=found.start, **found.options) == found.scene
    assert float(xa.Real(found.radius)) >= found.gap or found.contents.radius is not None


@pytest.mark.parametrize("path", TRIED, ids=lambda path: path.name)
def test_the_command_works_as_printed(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = inspected(path)
    if not found.command:
        return
    program, *arguments = shlex.split(found.command)
    assert program == "exactacq"
    status = cli.main(arguments)
    out, err = capsys.readouterr()
    assert status in (0, 3), err
    assert "never seen" not in out or found.contents.radius is not None


@pytest.mark.parametrize("seed", some(range(12), 3))
def test_random_drawings(tmp_path: Path, seed: int) -> None:
    """Boxes on a small grid: they cross, touch, overlap, lie in each other; some stay open."""
    random = Random(seed)
    lines = []
    for _ in range(random.randrange(2, 9)):
        ring = box(*(random.randrange(12) for _ in range(2)), *(random.randrange(1, 7) for _ in range(2)))
        gap = (ring[0][0], ring[0][1] + 1 / 4)
        lines.append([*ring[:-1], gap] if random.random() < 0.3 else ring)
    layers = {k: random.choice("AB") for k in range(len(lines))}
    path = drawing(tmp_path / "random.dxf", *lines, layers=layers)
    found = xa.inspect(path)
    check_cures(path, found)
    for chain in found.open_chains:
        for words in chain.cures:
            left = xa.inspect(path, **said(words)).open_chains
            assert not {label for other in left for label in other.pieces} & set(chain.pieces)
    if found.scene is not None:
        check_start(found)
        assert xa.load(path, start=found.start, **found.options) == found.scene


@pytest.mark.parametrize("seed", some(range(12), 4))
def test_the_gap_is_the_widest_link_of_a_shortest_tree(seed: int) -> None:
    """Of shapely's distances; the radius that follows from it lets the Sightseer see everything."""
    random = Random(seed)
    places = [
        (20 * k + random.randrange(12), 20 * m + random.randrange(12)) for k in range(3) for m in range(2)
    ]
    boxes = [shapely.box(x, y, x + random.randrange(1, 8), y + random.randrange(1, 8)) for x, y in places]
    scene = xa.Scene(boxes, start=(-3, random.randrange(-9, 30)))
    graph = nx.Graph()
    parts = [*boxes, shapely.Point(scene.start.xy)]
    for k, one in enumerate(parts):
        graph.add_weighted_edges_from((k, m, one.distance(parts[m])) for m in range(k))
    wanted = max(d["weight"] for _, _, d in nx.minimum_spanning_edges(graph))
    gap = widest_gap(scene)
    assert wanted * (1 - 1e-9) <= gap <= wanted * 1.01 + 0.1
    assert xa.sightseer(scene, rounded_up(1.5 * gap)).complete


@pytest.mark.parametrize("x", [-10, 10])
def test_circles_that_touch_from_outside_are_no_holes(tmp_path: Path, x: int) -> None:
    """The first vertex of the one is on the other: rounded it may lie inside."""
    path = tmp_path / "two.svg"
    circles = "".join(f'<circle cx="{20 + c}" cy="10" r="5"/>' for c in (0, x))
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 20">{circles}</svg>')
    assert [loop.role for loop in inspected(path).loops] == ["single", "single"]


def test_rounding_stays_within_the_clearance() -> None:
    random = Random(5)
    for _ in range(300):
        place, clear = np.array([random.uniform(-1e6, 1e6) for _ in "xy"]), 10 ** random.uniform(-9, 6)
        moved = np.hypot(*(np.array([float(xa.Real(c)) for c in rounded(place, clear)]) - place))
        assert moved <= 0.2 * clear + 1e-9
    for _ in range(300):
        value = 10 ** random.uniform(-20, 20)
        up = rounded_up(value)
        assert value <= float(xa.Real(up)) * (1 + 1e-15) and float(xa.Real(up)) <= value * 1.1 + 1e-25


# -- cases ----------------------------------------------------------------------------------------------


def test_a_hole_close_to_the_arc_around_it(tmp_path: Path) -> None:
    document = ezdxf.new()
    for angle in (0.0, 1.1, 2.0, 3.2, 4.5):
        document.modelspace().add_circle((9.98 * np.cos(angle), 9.98 * np.sin(angle)), 0.01)
    document.modelspace().add_circle((0, 0), 10)
    document.saveas(tmp_path / "rim.dxf")
    found = xa.inspect(tmp_path / "rim.dxf")
    assert [loop.role for loop in found.loops].count("hole") == 5
    assert np.array(found.extent) == pytest.approx(np.array(((-10, -10), (10, 10))))


def test_a_plate_in_a_frame_is_explored_from_within(tmp_path: Path) -> None:
    """Around the plate there are two boundaries; its holes would be left out without a word."""
    plate = [box(1, 1, 98, 98), *(box(10 * k, 10, 4, 40) for k in range(1, 8))]
    path = drawing(tmp_path / "frame.dxf", box(0, 0, 100, 100), *plate)
    found = xa.inspect(path)
    assert found.scene is not None
    assert (found.options["outer"], len(found.scene.obstacles)) == ("room", 8)
    check_start(found)
    few = drawing(tmp_path / "few.dxf", box(0, 0, 100, 100), *plate[:2])
    assert "outer" not in xa.inspect(few).options, "two boundaries and one loop in the plate"


def test_a_start_in_a_hole_is_cured_by_a_room(tmp_path: Path) -> None:
    path = drawing(tmp_path / "hole.dxf", box(0, 0, 100, 100), box(10, 10, 80, 80), box(30, 30, 20, 20))
    found = xa.inspect(path, start=(20, 20))
    assert [flaw.cures for flaw in found.violations] == [("--outer room",)]
    assert found.scene is not None
    assert len(found.scene.obstacles) == 2


def test_an_outline_with_a_gap_around_holes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The holes alone are a legal scene, but not the one that is meant."""
    outline = [(0, 0.25), (0, 100), (100, 100), (100, 0), (0, 0)]
    path = drawing(tmp_path / "d.dxf", outline, box(20, 20, 10, 10), box(60, 60, 10, 10))
    found = xa.inspect(path)
    (chain,) = found.open_chains
    assert (chain.encloses, chain.edges, chain.length, chain.gap) == (True, 4, 399.75, fmpq(1, 4))
    assert chain.cures == ("--tolerance 0.25",)
    assert not found.ok and found.trouble == "an open chain would enclose other loops"
    assert found.scene.enclosure is not None and "--tolerance 0.25" in found.command
    assert cli.main(["check", str(path)]) == 2
    assert capsys.readouterr().out.endswith("not OK: an open chain would enclose other loops\n")
    assert xa.inspect(path, tolerance="0.25").ok


def test_an_outline_in_pieces_around_a_hole(tmp_path: Path) -> None:
    """No piece alone has the hole within, but the loop that they close to does."""
    sides = ([(0, 0), (99, 0)], [(100, 0), (100, 99)], [(100, 100), (1, 100)], [(0, 100), (0, 1)])
    found = xa.inspect(drawing(tmp_path / "d.dxf", *sides, box(40, 40, 9, 9)))
    assert [chain.encloses for chain in found.open_chains] == [True] * 4
    assert {chain.cures for chain in found.open_chains} == {("--tolerance 1",)}


def test_an_arc_whose_end_is_joined_to_a_line_stays_open(tmp_path: Path) -> None:
    """Its end is moved to the line's: so it has no centre any more, and `check` ended in an error.

    What stays open is asked what it would enclose.
    """
    path = tmp_path / "d.kicad_pcb"
    path.write_text(
        """(kicad_pcb (version 20211014) (generator pcbnew)
 (gr_line (start 41.5 39.11) (end 43.36 39.11) (layer "Edge.Cuts") (width 0.12))
 (gr_arc (start 41.84 37.21) (mid 42.070574 38.233345) (end 41.51 39.12) (layer "Edge.Cuts") (width 0.12))
 (gr_circle (center 50 50) (end 53 50) (layer "Edge.Cuts") (width 0.1)))"""
    )
    (chain,) = xa.inspect(path, tolerance="0.037").open_chains
    assert len(chain.pieces) == 2 and not chain.encloses


def test_sides_of_a_slot_are_not_closed_by_a_tolerance() -> None:
    """Joined at both ends they are one line, drawn twice: a cure was named that only hid one of them."""
    chains = xa.inspect(DATA / "ref_dxf_metric.dxf").open_chains
    assert [chain.cures for chain in chains] == [("--thicken 0.47",)] * 3


HAIRLINE = [(0, 0), (40, 0), (40, 40), (0, 40), (0, 0.003)]
"""An outline with a gap that nobody sees."""


def test_each_gap_is_told_its_own_tolerance(tmp_path: Path) -> None:
    """One was told for all: 3.7 for a gap of 0.003."""
    ways = [[(8, 10), (20, 10)], [(22.6, 10), (22.6, 22)], [(20, 24.6), (8, 24.6)], [(8, 22), (8, 12.6)]]
    path = drawing(tmp_path / "d.dxf", HAIRLINE, box(30, 5, 5, 5), *ways)
    found = xa.inspect(path)
    assert [chain.cures for chain in found.open_chains] == [
        ("--tolerance 0.003",), *4 * [("--tolerance 3.7",)]
    ]  # fmt: skip
    (note,) = (text for text in found.notes if "--tolerance" in text)
    assert "--tolerance 0.003, which closes 1 of 5 open chains: LWPOLYLINE 2F ends at" in note
    assert note.endswith("; --tolerance 3.7 closes 5")
    assert len(xa.inspect(path, tolerance="0.003").open_chains) == 4
    assert not xa.inspect(path, tolerance="3.7").open_chains


def test_a_tolerance_that_takes_away_a_loop_is_not_named(tmp_path: Path) -> None:
    """What would close a wide gap makes nothing of a small plate: the gap is told `--thicken` instead."""
    wide = [(50, 5), (50, 0), (90, 0), (90, 40), (50, 40), (50, 8)]
    path = drawing(tmp_path / "d.dxf", HAIRLINE, wide, box(20, 20, 2, 2))
    found = xa.inspect(path)
    cures = {chain.gap: chain.cures for chain in found.open_chains}
    assert cures == {fmpq(3, 1000): ("--tolerance 0.003",), fmpq(3): ("--thicken 0.46",)}
    assert not any("--tolerance 3" in text for text in found.notes)
    assert len(xa.inspect(path, tolerance=3).loops) == 2
    alone = xa.inspect(drawing(tmp_path / "a.dxf", wide))
    assert [chain.cures for chain in alone.open_chains] == [("--tolerance 3",)]


def test_a_tolerance_that_opens_a_loop_is_not_named(tmp_path: Path) -> None:
    """A loop in pieces has a joint near the gap, where three ends would meet."""
    sides = [(box(0, 0, 9, 9)[k], box(0, 0, 9, 9)[k + 1]) for k in range(4)]
    gap = [(-2, 9.5), (-30, 9.5), (-30, 40)], [(-30, 40), (-2, 40), (-2, 11)]
    path = drawing(tmp_path / "d.dxf", *sides, *gap)
    (chain,) = xa.inspect(path).open_chains
    assert (chain.gap, chain.cures) == (fmpq(3, 2), ("--tolerance 1.5",))
    near = ([(x + 1.5, y) for x, y in piece] for piece in gap)
    (chain,) = xa.inspect(drawing(tmp_path / "n.dxf", *sides, *near)).open_chains
    assert (chain.gap, chain.cures) == (fmpq(3, 2), ("--thicken 0.21",))


def test_a_star_whose_edges_are_as_short_as_its_gap_is_not_closed(tmp_path: Path) -> None:
    """The tolerance that was named took all edges out."""
    star = [(0, 0), (30, 10), (10, -10), (20, 20), (26, -10), (4, 10), (35, 0)]
    path = drawing(tmp_path / "d.dxf", star)
    found = xa.inspect(path)
    (chain,) = found.open_chains
    assert chain.gap == 35 and [words.split()[0] for words in chain.cures] == ["--thicken"]
    assert not any("--tolerance" in text for text in found.notes)
    with pytest.raises(xa.FormatError, match="; give --thicken LENGTH for walls along the lines, or draw"):
        xa.load(path, start=(50, 50))


def test_walls_that_cannot_be_merged_are_not_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = drawing(tmp_path / "d.dxf", [(0, 0), (50, 0)], box(10, 10, 5, 5))

    def fail(*told: object) -> None:
        raise xa.FormatError("no union")

    monkeypatch.setattr("exactacq.files.checking.flaws.unite", fail)
    (chain,) = xa.inspect(path).open_chains
    assert chain.cures == ()


def test_lines_become_walls_only_if_nothing_else_does_as_well(tmp_path: Path) -> None:
    """A line may be drawn for another purpose: two plates that overlap are merged without it."""
    found = xa.inspect(drawing(tmp_path / "d.dxf", box(0, 0, 9, 9), box(5, 5, 9, 9), [(30, 0), (30, 20)]))
    assert found.command is not None and "--union" in found.command and "--thicken" not in found.command
    (chain,) = found.open_chains
    assert [words.split()[0] for words in chain.cures] == ["--thicken"]


def test_a_start_inside_a_wall_around_a_line(tmp_path: Path) -> None:
    """It was told that edges cross, or the wall was the room."""
    path = drawing(tmp_path / "d.dxf", [(0, 0), (50, 0), (50, 30)], box(10, 10, 5, 5))
    message = (
        "the start (25, 0.1) lies inside an obstacle, the wall along 'LWPOLYLINE 2F': it must lie in free "
        "space; give another, such as the one that `exactacq check` proposes"
    )
    (flaw,) = xa.inspect(path, start=(25, "0.1"), thicken=2).violations
    assert flaw.text == message
    with pytest.raises(xa.FormatError) as caught:
        xa.load(path, start=(25, "0.1"), thicken=2)
    assert str(caught.value) == f"{path}: {message}"


def test_no_start_is_proposed_inside_a_wall_around_a_line(tmp_path: Path) -> None:
    """It was: the roomiest place lay in the body along a line, which was then taken for the room."""
    found = xa.inspect(drawing(tmp_path / "d.dxf", [(0, 0), (50, 0)]), thicken=15)
    assert found.ok and len(found.scene.obstacles) == 1 and found.scene.enclosure is None
    check_start(found)


def test_a_line_is_no_loop_but_may_be_a_wall(tmp_path: Path) -> None:
    found = xa.inspect(drawing(tmp_path / "d.dxf", [(0, 0), (50, 0)], box(10, 10, 5, 5)))
    (chain,) = found.open_chains
    assert (
        not chain.encloses and (chain.gap, chain.across) == (50, None) and chain.cures == ("--thicken 0.25",)
    )
    assert found.ok


def test_roles_of_loops(tmp_path: Path) -> None:
    lines = (box(0, 0, 100, 100), box(10, 10, 50, 50), box(20, 20, 5, 5), box(200, 0, 5, 5))
    path = drawing(tmp_path / "d.dxf", *lines, layers={3: "side"})
    found = xa.inspect(path)
    assert [loop.role for loop in found.loops] == ["outer", "hole", "nested", "single"]
    assert found.contents.layers.counts == {"0": 3, "side": 1}
    inside = xa.inspect(path, start=(5, 5), layers="0")
    assert [loop.role for loop in inside.loops] == ["hole", "wall"]
    assert not inside.contents.layers.read("side") and inside.ok and inside.start == (5, 5)


def test_layers_that_cross_are_told_by_layers(tmp_path: Path) -> None:
    lines = (box(0, 0, 10, 10), box(5, 5, 10, 10), box(30, 0, 5, 5))
    found = xa.inspect(drawing(tmp_path / "d.dxf", *lines, layers={0: "part", 1: "frame", 2: "part"}))
    assert {flaw.cures for flaw in found.violations} == {("--union", "--layers part")}


def test_a_loop_that_meets_itself_has_no_cure(tmp_path: Path) -> None:
    bow = [(0, 0), (10, 10), (10, 0), (0, 10), (0, 0)]
    found = xa.inspect(drawing(tmp_path / "d.dxf", bow))
    (flaw,) = found.violations
    assert flaw.cures == () and flaw.places == (xa.Point(5, 5),) and found.loops[flaw.loops[0]].label == "O1"
    assert found.scene is None and found.command == ""


def test_a_spike_is_cured_by_a_tolerance(tmp_path: Path) -> None:
    """An exporter's rounding leaves an edge of 10^-5 that goes back on itself."""
    spike = [(0, 0), (100, 0), (100, 50), (100, 50.0001), (100, 50), (100, 100), (0, 100), (0, 0)]
    path = drawing(tmp_path / "d.dxf", spike)
    found = xa.inspect(path, tolerance=0)
    (words,) = {flaw.cures for flaw in found.violations}
    assert words[0].startswith("--tolerance") and xa.inspect(path, **said(words[0])).ok


def test_a_start_that_is_not_free(tmp_path: Path) -> None:
    found = xa.inspect(drawing(tmp_path / "d.dxf", box(0, 0, 10, 10), box(2, 2, 4, 4)), start=(3, 3))
    (flaw,) = found.violations
    assert flaw.text == "start (3, 3) lies inside obstacle O1 'LWPOLYLINE 30': it must lie in free space"
    scene = {"obstacles": [{"boundary": box(0, 0, 2, 2)[:-1]}], "start": [1, 1]}
    (tmp_path / "s.json").write_text(json.dumps(scene))
    found = xa.inspect(tmp_path / "s.json")
    assert [flaw.text for flaw in found.violations] == [
        "start (1, 1) lies inside obstacle O1: it must lie in free space"
    ]
    grid = tmp_path / "m.map"
    grid.write_text("type octile\nheight 3\nwidth 3\nmap\n...\n.@.\n...\n")
    assert "lies in a blocked cell" in xa.inspect(grid, start=(1.5, 1.5)).violations[0].text
    assert xa.inspect(grid).ok and xa.inspect(grid, simplify=1).ok


def test_objects_of_other_libraries_and_scenes_of_the_gallery() -> None:
    both = shapely.GeometryCollection([shapely.box(0, 0, 2, 2), shapely.box(1, 1, 3, 3)])
    found = xa.inspect(both)
    assert {flaw.cures for flaw in found.violations} == {("--union",)} and found.command == ""
    assert found.options == {"union": True} and xa.load(both, start=found.start, union=True) == found.scene
    assert xa.inspect("circles", start=(1, 1)).start == (1, 1)
    for name in ("figure2", "case2", "m20-3", "plate"):
        found = xa.inspect(name)
        assert found.ok and found.scene == xa.load(name), name


def test_what_cannot_be_read_is_refused(tmp_path: Path) -> None:
    for name in (tmp_path / "none.dxf", "nowhere", tmp_path):
        with pytest.raises(xa.FormatError):
            xa.inspect(name)
    with pytest.raises(xa.FormatError, match="tolerance is for"):
        xa.inspect(DATA / "inpa.wkt", tolerance=1)


def test_numbers_beyond_floats_are_told_and_not_drawn(tmp_path: Path) -> None:
    huge = {"boundary": [[0, 0], ["1e4000", 0], [0, "1e4000"]]}
    path = tmp_path / "s.json"
    path.write_text(json.dumps({"obstacles": [huge]}))
    found = xa.inspect(path)
    assert "too far from the origin" in found.violations[0].text and found.scene is None
    assert cli.main(["check", str(path), "--figure", str(tmp_path / "f.svg")]) == 2
    (tmp_path / "s.svg").write_text('<svg><path d="M0 0 L 1e3000 0 L 3 3"/><path d="M0 0h1v1z"/></svg>')
    assert cli.main(["check", str(tmp_path / "s.svg"), "--figure", str(tmp_path / "f.svg")]) in (0, 2)


# -- the command --------------------------------------------------------------------------------------


def test_the_report_tells_all_and_ends_in_a_verdict(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / "f.png"
    assert cli.main(["check", str(DATA / "ref_dxf_metric.dxf"), "--figure", str(picture)]) == 2
    out, err = capsys.readouterr()
    assert err == "" and picture.stat().st_size > 10_000
    lines = out.splitlines()
    assert lines[0].split() == ["format", "DXF", "drawings"] and "4 violations" in lines
    assert sum(line.startswith("- obstacle O") and line.endswith("or --union") for line in lines) == 4
    assert lines[-1].endswith("ref_dxf_metric.dxf: not OK: 4 violations of the rules for scenes")
    assert any(line.startswith("exactacq explore ") for line in lines)


def test_the_figure_marks_what_is_wrong(tmp_path: Path) -> None:
    from exactacq.output.figures.drawing_figure import drawing as draw

    lines = (
        box(0, 0, 10, 10),
        box(5, 5, 10, 10),
        box(15, 0, 4, 6),
        box(40, 0, 2, 2),
        [(30, 0), (38, 0), (38, 8), (30, 1)],
    )
    page = draw(xa.inspect(drawing(tmp_path / "d.dxf", *lines)))
    texts = {text.get_text() for text in page.legends[0].get_texts()}
    assert {"crossing", "open chain", "open end", "gap", "loop that breaks a rule", "start S"} <= texts
    assert {"O1", "O2"} <= {text.get_text() for text in page.axes[0].texts}


def test_the_figure_fills_what_is_in_the_way(tmp_path: Path) -> None:
    """In a plate with an opening, in which pads lie, the robot starts in the opening: that is no obstacle."""
    from exactacq.output.figures.drawing_figure import drawing as draw

    pads = [box(8 + 4 * k, 8, 2, 2) for k in range(4)]
    page = draw(found := xa.inspect(drawing(tmp_path / "d.dxf", box(0, 0, 30, 18), box(4, 4, 22, 10), *pads)))
    assert found.options == {"outer": "room"} and found.start is not None
    page.canvas.draw()
    pixels = np.asarray(page.canvas.buffer_rgba())

    def colour(x: float, y: float) -> list[int]:
        column, row = page.axes[0].transData.transform((x, y)).astype(int)
        return pixels[len(pixels) - 1 - row, column, :3].tolist()

    wall, room, pad, outside = (colour(*at) for at in ((2, 16), (6, 12.5), (8.3, 8.3), (-0.7, 9)))
    assert wall == pad == outside != room
    assert {"O2", "O6"} <= {text.get_text() for text in page.axes[0].texts}


def test_json_holds_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = drawing(tmp_path / "d.dxf", box(0, 0, 10, 10), box(5, 5, 10, 10), [(30, 0), (38, 0)])
    assert cli.main(["check", str(path), "--json"]) == 2
    told = json.loads(capsys.readouterr().out)
    assert not told["ok"] and told["layers"] == [{"name": "0", "entities": 3, "read": True}]
    assert [flaw["cures"] for flaw in told["violations"]] == [["--union"]] * 2
    assert told["violations"][0]["loops"] == ["O1", "O2"] and told["violations"][0]["kind"] == "cross"
    assert told["open_chains"][0]["length"] == 8 and told["command"].startswith("exactacq explore")


def test_steps_are_told() -> None:
    steps = []
    xa.inspect("circles", progress=lambda done, total: steps.append((done, total)))
    assert steps == [(k, 4) for k in range(5)]


def test_a_tolerance_that_makes_nothing_of_a_loop_is_no_cure(tmp_path: Path) -> None:
    """A bow tie in a large plate: a thousand times the default tolerance would have it vanish."""
    bow = [(50, 50), (50.01, 50.01), (50.01, 50), (50, 50.01), (50, 50)]
    found = xa.inspect(drawing(tmp_path / "d.dxf", box(0, 0, 100, 100), bow))
    assert [flaw.cures for flaw in found.violations] == [()]


def test_violations_beyond_count_are_not_tried(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two combs, each of whose teeth cross all of the other's: a union would find hundreds of crossings."""
    for module in (validation, cures):
        monkeypatch.setattr(module, "COUNTED", 500)
    teeth = [
        (x, y) for k in range(12) for x, y in ((3 * k, 0), (3 * k + 1, 40), (3 * k + 2, 40), (3 * k + 3, 0))
    ]
    comb = [*teeth, (36, -5), (0, -5), (0, 0)]
    path = drawing(tmp_path / "d.dxf", comb, [(y, x) for x, y in comb])
    found = xa.inspect(path)
    assert len(found.violations) == 500 and {flaw.cures for flaw in found.violations} == {()}


def test_a_drawing_is_parsed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Trials read it with further options: the same contents, of one document."""
    parsed: list[Path] = []
    parse = entities._parsed
    monkeypatch.setattr(entities, "_parsed", lambda path, *told: parsed.append(path) or parse(path, *told))
    found = xa.inspect(DATA / "mousebites.dxf")
    assert len(parsed) == 1
    monkeypatch.setattr(entities, "once", lambda key, make: make())
    again = xa.inspect(DATA / "mousebites.dxf")
    assert len(parsed) > 2
    assert (again.command, again.violations, again.notes) == (found.command, found.violations, found.notes)


@pytest.mark.parametrize("scale", ["1", "0.001", "4000"])
def test_curves_that_are_refused_are_read_by_arcs(tmp_path: Path, scale: str) -> None:
    path = tmp_path / "oval.svg"
    shapes = '<rect x="10" y="10" width="30" height="20"/><ellipse cx="80" cy="40" rx="20" ry="10"/>'
    path.write_text(f'<svg viewBox="0 0 100 50"><g transform="scale({scale})">{shapes}</g></svg>')
    with pytest.raises(xa.FormatError, match="--flatten LENGTH"):
        xa.load(path)
    found = xa.inspect(path)
    assert found.ok and len(found.scene.obstacles) == 2
    assert 0.08 < float(found.options["flatten"]) / float(scale) < 0.1
    assert f"--flatten {float(found.options['flatten']):g} " in found.command
