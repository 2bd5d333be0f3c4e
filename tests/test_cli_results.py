"""The commands that give results: convert and isovist, their files, and their refusals in one line."""

from __future__ import annotations

import json
import re
from itertools import pairwise
from pathlib import Path

import pytest

import exactacq as xa
from exactacq import cli


def answered(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    status = cli.main([str(argument) for argument in arguments])
    out, err = capsys.readouterr()
    assert (status, err) == (0, "")
    return out


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    assert cli.main([str(argument) for argument in arguments]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("exactacq: ") and err.count("\n") == 1
    return err


@pytest.fixture(scope="module")
def trace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("run") / "run.json"
    path.write_text(json.dumps(xa.sightseer(xa.load("squares")).to_json()))
    return path


def test_a_scene_goes_from_format_to_format(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    steps = [tmp_path / f"s{suffix}" for suffix in (".json", ".dxf", ".wkt", ".json")]
    steps[-1] = tmp_path / "again.json"
    assert "- every number is exact" in answered(capsys, "convert", "circles", steps[0])
    for source, target in pairwise(steps):
        out = answered(capsys, "convert", source, target, "--start", "0,0")
        assert out.startswith(f"{target} written\n") and "- every number is exact" in out
    first, last = xa.load(steps[0]), xa.load(steps[-1])
    assert [(c.center, c.radius) for c in first.shapes] == [(c.center, c.radius) for c in last.shapes]


def test_a_run_becomes_a_drawing(capsys: pytest.CaptureFixture[str], trace: Path, tmp_path: Path) -> None:
    out = answered(capsys, "convert", trace, tmp_path / "path.wkt", "--only", "path")
    assert "no layers" in out
    assert (tmp_path / "path.wkt").read_text().startswith("LINESTRING (0 0, 2 0, 2 -1, 4 -1")
    answered(capsys, "convert", trace, tmp_path / "then.geojson", "--at", "2")
    told = json.loads((tmp_path / "then.geojson").read_text())["features"]
    assert {"robot", "view"} <= {feature["properties"]["layer"] for feature in told}


def test_options_for_reading(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    answered(capsys, "convert", "circles", tmp_path / "c.dxf")
    target = tmp_path / "c.csv"
    out = answered(capsys, "convert", tmp_path / "c.dxf", target, "--start", "0,0", "--layers", "obstacles")
    assert "exact" in out and "enclosure" not in target.read_text()


def test_convert_refuses(capsys: pytest.CaptureFixture[str], trace: Path, tmp_path: Path) -> None:
    target = tmp_path / "x.dxf"
    assert "must end in .json, " in refused(capsys, "convert", "circles", tmp_path / "x.stl")
    assert "would be overwritten" in refused(capsys, "convert", trace, trace)
    assert "give a run that explore --trace wrote" in refused(capsys, "convert", "circles", target, "--at", 3)
    assert "--at: the path has no place after length 99" in refused(
        capsys, "convert", trace, target, "--at", 99
    )
    assert "nothing is of the kind 'way'" in refused(capsys, "convert", trace, target, "--only", "way")
    assert "takes no options" in refused(capsys, "convert", trace, target, "--start", "0,0")
    assert "no such file or gallery scene" in refused(capsys, "convert", "nowhere", target)
    assert [path.name for path in tmp_path.iterdir()] == []


def test_a_view_is_described(capsys: pytest.CaptureFixture[str]) -> None:
    out = answered(capsys, "isovist", "circles", "--at", "0,0", "--radius", "4")
    assert out.startswith("View from (0, 0) within 4\n")
    assert re.search(r"^area +2\*acos\(31/200\) .*≈ 48\.17580524918", out, re.M)
    assert re.search(r"^pieces +1 boundary piece, 0 windows, 1 range arc", out, re.M)
    assert re.search(r"^bounded by +O1", out, re.M)
    empty = answered(capsys, "isovist", "circles", "--at", "0,50", "--radius", "1")
    assert re.search(r"^bounded by +nothing", empty, re.M)


def test_a_view_is_written(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """A drawing needs no start: the place to look from says where the room is."""
    answered(capsys, "convert", "plate", tmp_path / "plate.wkt")
    for suffix in cli.DRAWINGS:
        target = tmp_path / f"view{suffix}"
        place = ("--at=-30,-60", "--radius", "60")
        out = answered(capsys, "isovist", tmp_path / "plate.wkt", *place, "--out", target)
        assert f"view written to {target}; " in out and target.stat().st_size > 100


def test_isovist_refuses(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert "lies inside" in refused(capsys, "isovist", "circles", "--at", "5,0")
    assert "--at: not two numbers" in refused(capsys, "isovist", "circles", "--at", "5")
    assert "must end in .wkt" in refused(
        capsys, "isovist", "circles", "--at", "0,0", "--out", tmp_path / "x.json"
    )
    bare = tmp_path / "s.json"
    bare.write_text('{"obstacles": []}')
    assert "--radius R" in refused(capsys, "isovist", bare, "--at", "0,0")
