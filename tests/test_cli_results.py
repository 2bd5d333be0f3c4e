"""The commands that give results: convert and isovist, their files, and their refusals in one line."""

from __future__ import annotations

import json
import re
import sys
from itertools import pairwise
from pathlib import Path

import pytest

import exactacq as xa
from exactacq import cli
from exactacq.cli.arguments import DRAWINGS


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


def test_a_run_is_drawn_at_once(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    target = tmp_path / "run.csv"
    assert f"run written to {target}" in answered(capsys, "explore", "squares", "--out", target)
    assert target.read_text().count("\npath,") == 13
    assert "must end in .wkt" in refused(capsys, "explore", "squares", "--out", tmp_path / "run.json")


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
    for suffix in DRAWINGS:
        target = tmp_path / f"view{suffix}"
        place = ("--at=-30,-60", "--radius", "60")
        out = answered(capsys, "isovist", tmp_path / "plate.wkt", *place, "--out", target)
        assert f"view written to {target}; " in out and target.stat().st_size > 100


def test_isovist_refuses(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert "--at: (5, 0) lies inside obstacle O1" in refused(capsys, "isovist", "circles", "--at", "5,0")
    assert "--at: not two numbers" in refused(capsys, "isovist", "circles", "--at", "5")
    assert "--at: it must not lie farther than" in refused(capsys, "isovist", "circles", "--at", "1e400,0")
    assert "must end in .wkt" in refused(
        capsys, "isovist", "circles", "--at", "0,0", "--out", tmp_path / "x.json"
    )
    bare = tmp_path / "s.json"
    bare.write_text('{"obstacles": []}')
    assert "--radius R" in refused(capsys, "isovist", bare, "--at", "0,0")


def data(capsys: pytest.CaptureFixture[str], *arguments: object) -> object:
    return json.loads(answered(capsys, *arguments, "--json"))


def test_check_as_json(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    found = data(capsys, "check", "circles")
    scene = {
        "name": "circles", "ok": True, "obstacles": 2, "enclosure": False, "segments": 0, "arcs": 2,
        "perimeters": {"closed": "10*pi", "decimal": "31.415926535897932385"},
        "start": ["0", "0"], "radius": "20", "terrain": None, "notes": [],
    }  # fmt: skip
    loops = [
        {"label": f"O{k}", "name": None, "role": "single", "inside": 0, "holds": 0, "segments": 0, "arcs": 1}
        for k in (1, 2)
    ]
    assert found.pop("extent") == [[3, pytest.approx(-3)], [15, pytest.approx(3)]]
    assert found.pop("gap") == pytest.approx(3, rel=0.01)
    assert found == {
        "name": "circles", "ok": True, "trouble": "", "format": "gallery scenes", "unit": None, "layers": [],
        "loops": loops, "open_chains": [], "violations": [], "notes": [], "start": ["0", "0"],
        "radius": "20", "scene": scene, "command": "exactacq explore circles",
    }  # fmt: skip
    assert scene == data(capsys, "gallery", "circles")
    bare = tmp_path / "bare.json"
    bare.write_text('{"obstacles": [], "terrain": {"width": 1, "height": "1/3"}}')
    empty = data(capsys, "check", bare)["scene"]
    assert empty["start"] == ["0", "0"] and empty["terrain"] == {
        "width": "1",
        "height": "1/3",
        "origin": ["0", "0"],
    }


def test_compare_as_json(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    found = data(capsys, "compare", "case3", "--figure", tmp_path / "pair.svg")
    assert [run["strategy"] for run in found["runs"]] == ["sightseer", "seed-spreader"]
    assert [len(run["bounds"]) for run in found["runs"]] == [4, 9]
    assert found["runs"][0]["diversions"] is None and found["runs"][1]["diversions"] == 1
    lengths = [float(run["length"]["decimal"]) for run in found["runs"]]
    assert found["ratio"] == pytest.approx(lengths[1] / lengths[0])
    assert (tmp_path / "pair.svg").exists()


def test_gallery_as_json(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    found = data(capsys, "gallery")
    assert {"name": "squares", "shows": "two squares in a row: the path is 24 long"} in found
    assert "leave the pictures out" in refused(capsys, "gallery", "--out", tmp_path / "g", "--json")


def test_verify_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["verify", "--scenes", "1", "--workers", "1", "--strategy", "sightseer", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["scenes"]["passed"] == 1 and found["wrong"] == found["open"] == []
    assert any(row["tried"] == row["held"] == 1 for row in found["statements"])
    assert cli.main(["verify", "--replay", "sightseer:0", "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert (again["scene"], again["result"]) == ("sightseer:0", "passed")
    assert again["statements"][0]["claim"]


def test_a_path_is_told_drawn_and_written(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Points may begin with a minus sign."""
    figure, out = tmp_path / "way.svg", tmp_path / "way.wkt"
    files = ("--figure", figure, "--out", out)
    told = answered(capsys, "path", "circles", "-1,0", "16,0", *files)
    assert told.startswith("Shortest path from (-1, 0) to (16, 0)\n")
    assert re.search(r"^pieces +3 segments, 2 arcs", told, re.M)
    assert re.search(r"^equally short +2 paths", told, re.M)
    assert f"figure written to {figure}" in told and f"path written to {out}; " in told
    assert figure.read_text().startswith("<?xml") and out.stat().st_size > 100


def test_path_refuses(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert "B: (5, 0) lies inside obstacle O1" in refused(capsys, "path", "circles", "0,0", "5,0")
    assert "A: (900, 0) lies beyond the enclosure" in refused(capsys, "path", "plate", "900,0", "-30,-60")
    assert "A: not two numbers" in refused(capsys, "path", "circles", "0", "5,0")
    assert "Missing argument 'B'" in refused(capsys, "path", "circles", "0,0")
    assert "--figur" in refused(capsys, "path", "circles", "0,0", "9,9", "--figur", "x.svg")
    cut = tmp_path / "cut.json"
    xa.write(xa.Scene([[(4, -1), (5, -1), (5, 9), (4, 9)]], terrain=xa.Terrain(8, 8)), cut)
    assert "no path leads from 0,0 to 8,0" in refused(capsys, "path", cut, "0,0", "8,0")


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_stream_that_is_closed_is_no_fault(stream: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, stream, None)
    assert cli.main(["explore", "squares"]) == 0
    assert cli.main(["check", "squares", "--json"]) == 0
    assert cli.main(["explore", "nowhere"]) == 2
