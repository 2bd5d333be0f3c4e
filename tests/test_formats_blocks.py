"""Blocks of DXF drawings: nested, turned, mirrored and stretched, and what cannot be placed."""

from __future__ import annotations

from cmath import rect
from collections.abc import Callable
from math import radians
from pathlib import Path

import ezdxf
import pytest
from hostile_files import dxf_of

import exactacq as xa
from exactacq.files.dxf import blocks

FAR = (1000, 1000)
TRIANGLE = (1, 4, 4 + 2j)
CIRCLE = [-2 + 1j + rect(1, radians(degrees)) for degrees in range(360)]
LOOP = ("LWPOLYLINE", 100, "AcDbPolyline", 90, 3, 70, 1, 10, 1.0, 20, 0.0, 10, 4.0, 20, 0.0, 10, 4.0, 20, 2.0)
TEXT = ("TEXT", 10, 0.0, 20, 0.0, 40, 1.0, 1, "a")
Turn = tuple[float, float, float, int]
"""Scales along x and y, degrees, and the direction of the extrusion."""


def placed_by(turn: Turn) -> Callable[[complex], complex]:
    """Where a reference with such a turn, inserted at (3, 1), places a point."""
    across, along, degrees, z = turn

    def place(p: complex) -> complex:
        q = complex(p.real * across, p.imag * along) * rect(1, radians(degrees)) + (3 + 1j)
        return complex(q.real * z, q.imag)

    return place


def nested(folder: Path, inner: Turn, outer: Turn) -> Path:
    """The triangle, and a circle, in a block in a block."""
    document = ezdxf.new()
    part, group = document.blocks.new("PART"), document.blocks.new("GROUP")
    part.add_lwpolyline([(p.real, p.imag) for p in TRIANGLE], close=True)
    part.add_circle((-2, 1), 1)
    for space, name, turn in ((group, "PART", inner), (document.modelspace(), "GROUP", outer)):
        across, along, degrees, z = turn
        told = {"xscale": across, "yscale": along, "rotation": degrees, "extrusion": (0, 0, z)}
        space.add_blockref(name, (3, 1), dxfattribs=told)
    path = folder / "nested.dxf"
    document.saveas(path)
    return path


@pytest.mark.parametrize("inner", [(1, 1, 90, 1), (1, -1, 30, 1), (2, 1, 90, -1)])
@pytest.mark.parametrize("outer", [(2, 1, 0, 1), (-1, 3, 90, 1), (1, 0.5, 20, -1), (-2, 2, 45, 1)])
def test_a_turned_block_in_a_stretched_one(tmp_path: Path, inner: Turn, outer: Turn) -> None:
    """ezdxf stretches a reference along its own axes, as if it were not turned, so it is not asked to."""
    scene = xa.load(nested(tmp_path, inner, outer), start=FAR, flatten="1/1000")
    first, second = placed_by(inner), placed_by(outer)
    images = [[second(first(p)) for p in points] for points in (TRIANGLE, CIRCLE)]
    for obstacle, image, near in zip(scene.obstacles, images, (1e-9, 0.1), strict=True):
        corners = [complex(*edge.start.xy) for edge in obstacle.edges]
        assert all(min(abs(corner - p) for p in image) < near for corner in corners)
        assert all(min(abs(corner - p) for corner in corners) < near for p in image if near < 0.1)


@pytest.mark.parametrize("content", [(("OLEFRAME",),) * 6, (("MLINE",),) * 6, (TEXT,) * 6, (LOOP,) * 2])
def test_what_blocks_hold_is_counted_before_it_is_placed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, content: tuple[tuple[object, ...], ...]
) -> None:
    """A file of 70 KB took hours: neither what shows nothing nor the vertices of a polyline counted."""
    monkeypatch.setattr(blocks, "MAX_ENTITIES", 600)
    path = tmp_path / "many.dxf"
    reference = ("INSERT", 2, "B", 10, 0.0, 20, 0.0, 70, 99, 44, 9.0)
    path.write_bytes(dxf_of(reference, LOOP, blocks=content))
    with pytest.raises(xa.FormatError, match="its blocks expand to more than 600 entities and vertices"):
        xa.load(path, start=FAR)


@pytest.mark.parametrize(
    ("reference", "told"),
    [
        (("INSERT", 2, "C"), "left out 1 INSERT of a missing block"),
        (("INSERT", 2, "B", 41, 0.0), "left out 1 CIRCLE in a block"),
    ],
)
def test_references_that_place_nothing_are_left_out(
    tmp_path: Path, reference: tuple[object, ...], told: str
) -> None:
    """The whole drawing was refused for a block that is not there, or one that is scaled to nothing."""
    path = tmp_path / "empty.dxf"
    path.write_bytes(dxf_of(reference, LOOP, blocks=(("CIRCLE", 10, 0.0, 20, 0.0, 40, 1.0),)))
    scene = xa.load(path, start=FAR)
    assert len(scene.obstacles) == 1 and told in scene.notes


def test_lines_of_a_width_are_told(tmp_path: Path) -> None:
    """A ring of a polyline with a width is how AutoCAD draws a donut: what is read is half as large."""
    document = ezdxf.new()
    space = document.modelspace()
    for x, width in ((0, 1), (9, 0)):
        space.add_lwpolyline([(x, 0, 1), (x + 1, 0, 1)], "xyb", close=True, dxfattribs={"const_width": width})
    wide = {"default_start_width": 1, "default_end_width": 1}
    space.add_polyline2d([(20, 0), (24, 0), (24, 4)], close=True, dxfattribs=wide)
    document.saveas(tmp_path / "wide.dxf")
    notes = xa.load(tmp_path / "wide.dxf", start=FAR).notes
    told = [note.removeprefix("read the middle line of ") for note in notes if "width" in note]
    assert told == ["1 LWPOLYLINE drawn with a width", "1 POLYLINE drawn with a width"]
