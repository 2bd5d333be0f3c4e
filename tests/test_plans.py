"""Floor plans as CAD programs write them: which layers and options `inspect` proposes, and where to start."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import cos, inf, pi, sin
from pathlib import Path

import ezdxf
import pytest
from ezdxf.document import Drawing
from ezdxf.layouts import Modelspace
from shapely import Point as Place
from shapely import Polygon

import exactacq as xa

Line = Sequence[tuple[float, float]]


def plan(path: Path, lines: dict[str, list[Line]], more: Callable[[Modelspace], object] = bool) -> Path:
    """A drawing of polylines by layer; one is closed if its last place is the first."""
    document = ezdxf.new()
    for layer, some in lines.items():
        for line in some:
            closed = line[0] == line[-1]
            places = line[:-1] if closed else line
            document.modelspace().add_lwpolyline(places, close=closed, dxfattribs={"layer": layer})
    more(document.modelspace())
    document.saveas(path)
    return path


def box(x: float, y: float, w: float, h: float) -> list[tuple[float, float]]:
    return [(x, y), (x + w, y), (x + w, y + h), (x, y + h), (x, y)]


def count(found: xa.Inspection) -> int:
    assert found.scene is not None
    return len(found.scene.obstacles)


FLAT = [(0, 0), (10, 0), (10, 8), (6, 8), (6, 7.8), (9.8, 7.8), (9.8, 0.2), (0.2, 0.2), (0.2, 7.8), (4, 7.8),
        (4, 8), (0, 8), (0, 0)]  # fmt: skip
"""The walls of one room, 0.2 thick, with a gap for a door."""
SIDES: list[Line] = [list(side) for side in pairwise(FLAT)]
"""The same, line by line."""
DOOR: list[Line] = [[(4, 8), (4, 10)], [(6, 8), (4, 10)]]
"""A leaf and where it swings; both end at corners of walls."""
BEDS: list[Line] = [box(1, 1, 2, 3), box(5, 1, 2, 1)]


def test_the_walls_of_a_plan(tmp_path: Path) -> None:
    """With tables that overlap and lines that measure all, there is no other scene of as many boundaries."""
    walls: list[Line] = [
        [(0, 0), (4, 0)], [(6, 0), (10, 0), (10, 8), (6, 8)], [(4, 8), (0, 8), (0, 0)], [(5, 2), (5, 6)],
    ]  # fmt: skip
    tables = [box(1, 6, 3, 1.5), box(3, 6.5, 3, 3)]
    across: list[Line] = [[(-1, y), (11, y)] for y in range(-1, 10, 2)]
    path = plan(tmp_path / "d.dxf", {"house$0$A-WALL": walls, "0": [*tables, *across]})
    found = xa.inspect(path)
    assert found.options is not None and found.options["layers"] == ["house$0$A-WALL"]
    # Of what was merged the name of one line is enough to find it.
    assert found.scene is not None
    ends = [obstacle.label.partition(" and ")[2] for obstacle in found.scene.obstacles]
    assert ends == ["1 more", "", ""]
    assert "--layers 'house$0$A-WALL' --thicken" in found.command
    # What reads other lines, or none, closes no chain.
    assert not any("--layers" in cure for chain in found.open_chains for cure in chain.cures)
    # Who names layers has chosen, and what needs no cure is read as it is.
    assert xa.inspect(path, layers=["*"]).options == {"layers": ["*"], "union": True}
    whole = plan(tmp_path / "e.dxf", {"WALL": [box(0, 0, 9, 9)], "0": [box(2, 2, 1, 1)]})
    assert xa.inspect(whole).options == {}


@pytest.mark.parametrize("names", [("A-WALL", "A-FURN"), ("W\u00e4nde", "M\u00f6bel")])
def test_doors_that_end_at_corners_of_walls(tmp_path: Path, names: tuple[str, str]) -> None:
    """Where three lines meet none goes on: the walls were open, and only the beds were proposed."""
    walls, beds = names
    found = xa.inspect(plan(tmp_path / "d.dxf", {walls: SIDES, beds: BEDS, "door": DOOR}))
    assert found.open_chains and count(found) == 3
    assert found.options is not None and set(found.options["layers"]) == {walls, beds}  # type: ignore[call-overload]


def test_parts_of_walls_are_no_walls(tmp_path: Path) -> None:
    """Hatches are many lines: made thick, they would be most boundaries."""
    hatch: list[Line] = [[(0.02 + k / 4, 0.02), (0.12 + k / 4, 0.18)] for k in range(39)]
    found = xa.inspect(plan(tmp_path / "d.dxf", {"A-WALL-PATT": hatch, "A-WALL": SIDES, "door": DOOR}))
    assert found.options == {"layers": ["A-WALL"]} and count(found) == 1


def test_the_start_is_in_a_room_rather_than_in_a_wall(tmp_path: Path) -> None:
    found = xa.inspect(plan(tmp_path / "d.dxf", {"0": [FLAT]}))
    assert found.start is not None and Polygon(FLAT).distance(Place(*map(float, found.start))) > 1
    # In a plate with a slot it is in the plate.
    slot = [(0, 0), (10, 0), (10, 8), (6, 8), (6, 4), (4, 4), (4, 8), (0, 8), (0, 0)]
    found = xa.inspect(plan(tmp_path / "e.dxf", {"0": [slot]}))
    assert found.start is not None and Polygon(slot).contains(Place(*map(float, found.start)))


@pytest.mark.parametrize("chairs", [[], [box(4, 4, 1, 1), box(4.5, 4.5, 1, 1)], [[(12, 2), (13, 4)]]])
def test_a_room_is_proposed_whatever_else_is_wrong(tmp_path: Path, chairs: list[Line]) -> None:
    """Walls are two loops, one within the other. A line, or chairs that overlap, hid the room."""
    columns = [box(2 + 3 * k, 2, 0.5, 0.5) for k in range(6)]
    path = plan(tmp_path / "d.dxf", {"0": [box(0, 0, 20, 9), box(0.2, 0.2, 19.6, 8.6), *columns, *chairs]})
    found = xa.inspect(path)
    assert found.options is not None and found.options["outer"] == "room" and count(found) >= 7


def test_what_was_left_at_the_origin(tmp_path: Path) -> None:
    """Tolerance, start and radius go by the plan: a millionth of the way there is more than its doors."""
    x, y = 3512345, 5403210
    lines = [[(x + u, y + v) for u, v in line] for line in (FLAT, *BEDS)]
    alone = xa.inspect(plan(tmp_path / "d.dxf", {"0": lines}))
    found = xa.inspect(plan(tmp_path / "e.dxf", {"0": lines}, lambda space: space.add_circle((0, 0), 1)))
    assert count(found) == count(alone) + 1 == 4 and not found.open_chains
    assert found.radius is not None and found.radius < 30
    assert any(
        note.startswith("what is about (-1, -1) is far from nearly everything") for note in found.notes
    )
    assert not any("far from" in note for note in alone.notes)


def test_what_is_drawn_finely_is_not_all(tmp_path: Path) -> None:
    """A hall with a column and a post of many lines: most vertices are at the post, yet it is in the hall."""
    post = [(15 + cos(k * pi / 30) / 10, 15 + sin(k * pi / 30) / 10) for k in range(60)]
    lines = [box(0, 0, 30, 30), box(5, 5, 2, 2), [*post, post[0]]]
    found = xa.inspect(plan(tmp_path / "d.dxf", {"0": lines}))
    assert count(found) == 3 and found.radius is not None and found.radius > 9
    assert not any("far from" in note for note in found.notes)


def test_layers_that_belong_together_where_nothing_is_wrong(tmp_path: Path) -> None:
    """Pillars whose corners doors touch are torn open, but nothing is in them: so nothing seemed wrong."""
    pillars = [list(side) for k in range(4) for side in pairwise(box(4 * k, 0, 1, 1))]
    doors: list[Line] = [[(4 * k + 1, y), (4 * k + 2, 3)] for k in range(4) for y in (0, 1)]
    tables = [box(3, 6, 1, 1), box(7, 6, 1, 1)]
    layers = {"pillars": pillars, "doors": doors, " odd, name ": [box(40, 0, 1, 1)], "tables": tables}
    found = xa.inspect(plan(tmp_path / "d.dxf", layers))
    assert found.ok and count(found) == 6
    assert "--layers pillars,tables" in found.command


def test_what_is_hidden_is_left_out(tmp_path: Path) -> None:
    """As in SVG drawings: what is switched off, frozen or invisible, unless layers are named."""

    def hidden(space: Modelspace) -> None:
        assert space.doc is not None
        space.doc.layers.add("old").off()
        space.doc.layers.add("demo").freeze()
        block = space.doc.blocks.new("table")
        block.add_circle((0, 0), 0.1, dxfattribs={"layer": "0"})
        block.add_circle((1, 0), 0.1, dxfattribs={"layer": "wood"})
        space.add_blockref("table", (2, 2), dxfattribs={"layer": "demo"})
        space.add_blockref("table", (5, 5), dxfattribs={"layer": "old"})
        space.add_circle((8, 1), 0.1, dxfattribs={"layer": "OLD"})
        space.add_circle((8, 3), 0.1, dxfattribs={"invisible": 1})

    path = plan(tmp_path / "d.dxf", {"0": [FLAT]}, hidden)
    # A layer that is off leaves of its block what is on a layer of its own.
    found = xa.inspect(path)
    assert len(found.loops) == 2 and "left out 5 hidden CIRCLEs" in found.notes
    assert "--layers reads what is hidden too, as on 'demo', 'wood', 'old', 'OLD', '0'" in found.notes
    assert found.contents.layers.counts == {"0": 1, "wood": 1}
    empty = plan(tmp_path / "e.dxf", {}, lambda space: space.add_circle((8, 3), 1, {"invisible": 1}))
    with pytest.raises(
        xa.FormatError, match=r"nothing to read .*; --layers reads what is hidden too, as on '0'"
    ):
        xa.inspect(empty)
    assert len(xa.inspect(path, layers=["demo"]).loops) == 1 and len(xa.inspect(path, layers="*").loops) == 7


@pytest.mark.parametrize("in_block", [False, True])
def test_walls_of_multiple_lines_are_read(tmp_path: Path, in_block: bool) -> None:
    """A wall that ends in caps, and one that goes around a room: two loops, and a loop in a loop."""
    document = ezdxf.new(setup=True)
    style = document.mline_styles.new("capped")
    for offset in (0.1, -0.1):
        style.elements.append(offset)
    style.dxf.flags = 16 + 256  # caps at both ends
    space = document.blocks.new("PLAN") if in_block else document.modelspace()
    space.add_mline([(0, 0), (10, 0), (10, 8), (0, 8)], dxfattribs={"layer": "WALL", "style_name": "capped"})
    space.add_mline([(20, 0), (30, 0), (30, 8), (20, 8)], close=True, dxfattribs={"layer": "WALL"})
    if in_block:
        document.modelspace().add_blockref("PLAN", (0, 0))
    document.saveas(path := tmp_path / "walls.dxf")
    found = xa.inspect(path, layers="WALL")
    assert found.ok and sorted(loop.role for loop in found.loops) == ["hole", "outer", "single"]
    assert any("expanded 2 MLINEs" in note for note in found.notes)


def solid(document: Drawing) -> None:
    document.modelspace().add_solid([(0, 0), (4, 0), (0, 3), (4, 3)])


def paper(document: Drawing) -> None:
    document.layout("Layout1").add_lwpolyline([(0, 0), (4, 0), (4, 3)], close=True)


def infinite(document: Drawing) -> None:
    document.modelspace().add_lwpolyline([(0, 0), (inf, 0), (10, 8)])


@pytest.mark.parametrize(
    ("draw", "words"),
    [
        (solid, r"left out 1 SOLID\); draw obstacles by lines, arcs"),
        (paper, r"only what is in the model space is read.*1 entity on the layout 'Layout1'"),
        (infinite, r"LWPOLYLINE \w+: not a number: 'inf'"),
    ],
)
def test_what_cannot_be_read_is_named(tmp_path: Path, draw: Callable[[Drawing], None], words: str) -> None:
    draw(document := ezdxf.new())
    document.saveas(path := tmp_path / "odd.dxf")
    with pytest.raises(xa.FormatError, match=words):
        xa.inspect(path)


def test_a_finer_tolerance_parts_what_lies_close(tmp_path: Path) -> None:
    """Four panels of single lines that are close to each other: by default their corners are joined."""
    lines = []
    for x, y in ((0, 0), (9 + 1e-6, 0), (0, 9 + 1e-6), (9 + 1e-6, 9 + 1e-6)):
        corners = [(x, y), (x + 9, y), (x + 9, y + 9), (x, y + 9), (x, y)]
        lines += [[*side] for side in pairwise(corners)]
    found = xa.inspect(plan(tmp_path / "panels.dxf", {"PANELS": lines}))
    assert not found.ok and len(found.scene.obstacles) == 4
    assert set(found.options) == {"tolerance"} and float(found.options["tolerance"]) < 1e-6
