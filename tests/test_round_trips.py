"""What is written and read again is the same, wherever numbers are finite decimals; if not, it is said."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import pytest
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st

import exactacq as xa

DATA = Path(__file__).parent / "data"
EXACT = "every number is exact"
READ = {".json": {}, ".wkt": {}, ".dxf": {"tolerance": 0}}
"""The formats that keep arcs, and how what they hold is read without any repair."""


def decimals(low: int, high: int, places: int = 4) -> st.SearchStrategy[fmpq]:
    unit = 10**places
    return st.integers(low * unit, high * unit).map(lambda n: fmpq(n, unit))


@st.composite
def shapes(draw: st.DrawFn, west: int) -> xa.Circle | xa.Outline:
    """A disc, or a triangle of edges that may bend outwards, in a square of side 8 from the west."""
    if draw(st.booleans()):
        return xa.Circle((west + draw(decimals(3, 5)), draw(decimals(3, 5))), draw(decimals(1, 3)))
    corners = [
        (west + draw(decimals(*xs)), draw(decimals(*ys)))
        for xs, ys in (((2, 3), (2, 3)), ((5, 6), (2, 3)), ((3, 5), (5, 6)))
    ]
    bends = [draw(st.sampled_from([fmpq(0), fmpq(1, 8), fmpq(3, 10), fmpq(1, 3125)])) for _ in corners]
    rows = [(*place, bend) for place, bend in zip(corners, bends, strict=True)]
    if draw(st.booleans()):  # clockwise
        places, turned = corners[::-1], [-bends[1], -bends[0], -bends[2]]
        rows = [(*place, bend) for place, bend in zip(places, turned, strict=True)]
    return xa.Outline(rows)


@st.composite
def scenes(draw: st.DrawFn) -> xa.Scene:
    count = draw(st.integers(1, 4))
    found = [draw(shapes(west=10 * k)) for k in range(count)]
    wall = None
    if draw(st.booleans()):
        bends = [draw(st.sampled_from([fmpq(0), fmpq(1, 4), fmpq(1, 10)])) for _ in range(4)]
        ends = [(-5, -5), (10 * count, -5), (10 * count, 9), (-5, 9)]
        wall = xa.Outline([(*end, bend) for end, bend in zip(ends, bends, strict=True)])
    return xa.Scene(found, start=(-1, "-0.5"), enclosure=wall)


def bare(scene: xa.Scene) -> list[object]:
    """The shapes without their names, which drawings do not hold; the wall last."""
    walls = [] if scene.enclosure is None else [scene.enclosure]
    return [
        (shape.center, shape.radius) if isinstance(shape, xa.Circle) else shape.vertices
        for shape in (*scene.shapes, *walls)
    ]


@pytest.mark.parametrize("suffix", READ)
@given(scene=scenes())
def test_finite_decimals_stay_as_they_are(suffix: str, scene: xa.Scene) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"scene{suffix}"
        assert xa.write(scene, path)[0] == EXACT
        again = xa.load(path, start=scene.start, **READ[suffix])
    assert bare(again) == bare(scene)


@given(number=st.fractions(-(10**6), 10**6, max_denominator=10**9))
def test_json_holds_every_fraction(number: object) -> None:
    scene = xa.Scene([xa.Circle((number, 0), "1/7")])
    with tempfile.TemporaryDirectory() as folder:
        assert xa.write(scene, f"{folder}/s.json") == (EXACT,)
        assert bare(xa.load(f"{folder}/s.json")) == bare(scene)


def test_a_loop_that_rounding_loses_is_told(tmp_path: Path) -> None:
    """The start is a corner of the obstacle, which in the file is off: so the start is inside."""
    scene = xa.load(DATA / "arcs" / "samecircle-b193.json")
    assert xa.write(scene, tmp_path / "s.wkt")[:2] == (
        "no point lies more than 1.4e-15 from its exact place",
        "rounded so, 1 of its 2 loops are read again from the same start; a .json file holds it exactly",
    )
    assert len(xa.load(tmp_path / "s.wkt", start=scene.start).obstacles) == 1
    assert xa.write(scene, tmp_path / "s.json") == (EXACT,)
    (_, said) = xa.write(scene, tmp_path / "s.svg")
    assert re.match(
        r"rounded so, it is refused from the same start \(.*\); a .json file holds it exactly", said
    )


@pytest.mark.parametrize("path", sorted((DATA / "arcs").glob("*.json")), ids=lambda path: path.stem)
@pytest.mark.parametrize("suffix", [".wkt", ".dxf"])
def test_what_is_rounded_has_all_its_loops_or_says_so(path: Path, suffix: str, tmp_path: Path) -> None:
    scene, target = xa.load(path), tmp_path / f"s{suffix}"
    moved, *told = xa.write(scene, target)
    assert re.fullmatch(r"no point lies more than \d.*e-1[5-7] from its exact place", moved)
    if not any(note.startswith("rounded so") for note in told):
        again = xa.load(target, start=scene.start, **READ[suffix])
        assert len(again.obstacles) == len(scene.obstacles)
        for one, other in zip(again.obstacles, scene.obstacles, strict=True):
            assert float(one.area) == pytest.approx(float(other.area), rel=1e-12)
