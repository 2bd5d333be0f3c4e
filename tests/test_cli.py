"""The command line: what it prints, and that every mistake costs one clear line and leaves no file."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from nightly import some
from terminals import on_a_terminal
from typer.testing import CliRunner

from exactacq import cli
from exactacq.files import gallery
from exactacq.files.whole_files import write_whole

ROOT = Path(__file__).parents[1]
EMPTY_DXF = "0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n"


def scene(tmp_path: Path, *obstacles: object, **parts: object) -> str:
    path = tmp_path / "scene.json"
    path.write_text(json.dumps({"start": [0, 0], "radius": 9, "obstacles": obstacles, **parts}))
    return str(path)


def polygon(*vertices: object) -> dict[str, object]:
    return {"boundary": vertices}


def circle(x: object, y: object, radius: object) -> dict[str, object]:
    return {"circle": {"center": [x, y], "radius": radius}}


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The one line that a wrong command line gets; checks status and streams."""
    status = cli.main(arguments)
    out, err = capsys.readouterr()
    assert status == 2, err
    assert out == ""
    assert err.startswith("exactacq: ")
    assert err.endswith("\n")
    assert err.count("\n") == 1
    return err


def answered(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """What a right command line prints."""
    status = cli.main(arguments)
    out, err = capsys.readouterr()
    assert (status, err) == (0, "")
    return out


def process(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "exactacq", *arguments]
    return subprocess.run(  # type: ignore[call-overload,no-any-return]
        command, capture_output=True, text=True, timeout=60, check=False, **options
    )


# -- what it prints ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "length"), [("circles", "5 + 12*pi  ≈ 42.69911184307751"), ("squares", "24\n")]
)
def test_explore_prints_order_links_length_and_bounds(
    capsys: pytest.CaptureFixture[str], name: str, length: str
) -> None:
    out = answered(capsys, "explore", name)
    assert "O1 → O2" in out
    assert f"length  {length}" in out
    assert re.search(r"^#2 +O2 +O1 +\(\S+, \S+\) +\(\S+, \S+\) +\S+ +once", out, re.M)
    assert re.search(r"^T1 corrected .* yes ", out, re.M)
    assert "never" not in out


def test_bound_that_fails_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    assert re.search(r"^\(1\) .* no +1\.\d+ ", answered(capsys, "explore", "m9"), re.M)


def test_what_was_missed_is_said(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = scene(tmp_path, circle(5, 0, 2), circle(50, 0, 1), circle("60", 0, 1))
    out = answered(capsys, "explore", path)
    assert "never seen  O2, O3" in out
    assert "does not satisfy the paper's model (a) for R = 9" in out
    assert "seen, never visited  O3" in answered(capsys, "explore", "m4")


def test_a_sweep_says_what_it_met_and_why_it_turned_aside(capsys: pytest.CaptureFixture[str]) -> None:
    out = answered(capsys, "explore", "figure4", "--strategy", "seed-spreader")
    assert "Seed Spreader Strategy on figure4" in out
    assert "met  O1 → O1 → O6" in out
    assert re.search(r"^1 +O3 +\(16, 16\) +\(14.25, 14.25\) +the line ends", out, re.M)
    assert re.search(r"^T2 corrected .* yes ", out, re.M)
    hasty = answered(capsys, "explore", "m25", "--strategy", "seed-spreader", "--no-lookahead")
    assert "out of sight" in hasty
    assert "never seen  X" in answered(capsys, "explore", "m14", "--strategy", "seed-spreader")


def test_both_strategies_side_by_side(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    target = tmp_path / "pair.svg"
    out = answered(capsys, "compare", "m14", "--start", "0,40", "--figure", str(target))
    assert re.search(r"^acquired +3 of 3 +2 of 3", out, re.M)
    assert re.search(r"^Seed Spreader / Sightseer +\d", out, re.M)
    assert target.read_text(encoding="utf-8").startswith("<?xml")
    alone = answered(capsys, "compare", "figure4")
    assert "no sightseer: obstacle O1 meets the terrain's border" in alone
    assert "Seed Spreader Strategy" in alone
    room = scene(tmp_path, circle(3, -3, 1), enclosure=[[-9, -9], [9, -9], [0, 9]])
    assert "no seed-spreader: a sweep takes a rectangle" in answered(capsys, "compare", room)
    beside = answered(capsys, "compare", room, "--terrain", "bbox:1")
    assert "Sightseer" in beside and re.search("no seed-spreader: start .* outside the enclosure", beside)


def test_a_sweep_that_cannot_start_says_where_it_would(capsys: pytest.CaptureFixture[str]) -> None:
    sweep = ("--strategy", "seed-spreader")
    line = refused(capsys, "explore", "circles", *sweep, "--terrain", "6,0,24,12")
    assert "start (6, 0) lies inside obstacle O1" in line
    assert "a sweep starts in the SW corner of its terrain" in line
    assert "a sweep takes a rectangle" in refused(capsys, "explore", "plate", *sweep, "--terrain", "bbox:1")


def test_a_sweep_beyond_an_enclosure_is_told_what_to_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sweep = ("--strategy", "seed-spreader", "--radius", "3")
    room = scene(tmp_path, circle(3, -3, 1), enclosure=[[-9, -9], [9, -9], [9, 9], [-9, 9]])
    assert "without a terrain the enclosure is swept" in refused(
        capsys, "explore", room, *sweep, "--terrain", "bbox:1"
    )
    assert "length" in answered(capsys, "explore", room, *sweep)


def test_numbers_are_exact(capsys: pytest.CaptureFixture[str]) -> None:
    out = answered(capsys, "explore", "circles", "--radius", "61/3", "--start", "0.1,-1/3")
    assert "S = (0.1, -1/3), R = 61/3" in out


def test_a_radius_equal_to_the_gap_sees_and_a_smaller_one_does_not(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert "never" not in answered(capsys, "explore", "circles", "--radius", "3")
    out = answered(capsys, "explore", "circles", "--radius", "2." + 60 * "9")
    assert "never seen  O1, O2" in out


def test_long_closed_forms_are_decimals_in_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    out = answered(capsys, "explore", "figure2")
    assert "length  ≈ 439.739" in out
    assert max(map(len, out.splitlines())) <= 110


def test_json_and_trace_are_the_same_exact_run(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    target = tmp_path / "run.json"
    out = answered(capsys, "explore", "circles", "--json", "--trace", str(target))
    assert target.read_text(encoding="utf-8") == out
    assert "5 + 12*pi" in out
    assert json.loads(out)


def test_figures_of_every_type(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    for suffix in ("svg", "pdf", "png"):
        target = tmp_path / f"run.{suffix}"
        assert f"figure written to {target}" in answered(
            capsys, "explore", "circles", "--figure", str(target)
        )
        assert target.stat().st_size > 1000
    assert len(list(tmp_path.iterdir())) == 3


def test_written_files_have_ordinary_permissions(tmp_path: Path) -> None:
    (tmp_path / "plain").write_bytes(b"")
    write_whole(tmp_path / "whole", b"")
    assert (tmp_path / "whole").stat().st_mode == (tmp_path / "plain").stat().st_mode
    (tmp_path / "whole").chmod(0o640)
    write_whole(tmp_path / "whole", b"new")
    assert (tmp_path / "whole").stat().st_mode & 0o777 == 0o640


def test_check_counts_and_passes_on_notes(capsys: pytest.CaptureFixture[str]) -> None:
    out = answered(capsys, "check", "plate")
    assert "plate: OK" in out
    assert "14, and the enclosure" in out
    assert "14 segments, 19 arcs" in out
    assert "import notes" in out
    out = answered(capsys, "check", "circles", "--start", "1,1")
    assert "10*pi" in out
    assert "(1, 1)" in out


def test_gallery_lists_and_draws(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = answered(capsys, "gallery")
    assert all(name in out for name in gallery.names())
    assert "circles: OK" in answered(capsys, "gallery", "circles")
    answered(capsys, "gallery", "circles", "--figure", str(tmp_path / "c.svg"))
    monkeypatch.setattr(gallery, "names", lambda: ("circles", "case3"))  # to draw all takes long
    answered(capsys, "gallery", "--out", str(tmp_path / "all"))
    assert sorted(p.stem for p in (tmp_path / "all").iterdir()) == ["case3", "circles"]
    for path in [tmp_path / "c.svg", *(tmp_path / "all").iterdir()]:
        ET.parse(path)


def test_version_and_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert re.fullmatch(
        r"exactacq \d+\.\d+\.\d+\S* \((compiled kernel|kernel in Python)\)\n", answered(capsys, "--version")
    )
    assert "explore" in answered(capsys)
    result = CliRunner().invoke(cli.app, ["explore", "--help"])
    assert result.exit_code == 0
    assert "--strategy" in result.output


# -- mistakes ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--radius", "0"], "--radius: must be positive"),
        (["--radius", "-1"], "--radius: must be positive"),
        (["--radius", "nan"], "--radius: not a number"),
        (["--radius", "inf"], "--radius: not a number"),
        (["--radius", "1/0"], "--radius: division by zero"),
        (["--radius", "two"], "--radius: not a number"),
        (["--radius", ""], "--radius: not a number"),
        (["--radius", "٣"], "--radius: not a number"),
        (["--radius", "1\n2"], "--radius: not a number"),
        (["--radius", "1e400000"], ""),
        (["--start", "1"], "--start: not two numbers"),
        (["--start", "1,2,3"], "--start: not two numbers"),
        (["--start", "x,0"], "--start: not a number"),
        (["--start", "nan,0"], "--start: not a number"),
        (["--start", "5,0"], "start"),
        (["--strategy", "seed-spreader"], "a terrain is needed: give one with --terrain"),
        (["--strategy", "seed-spreader", "--terrain", "9"], "--terrain: not two or four numbers"),
        (["--strategy", "seed-spreader", "--terrain", "1/9,1/9"], "outside the terrain"),
        (["--strategy", "seed-spreader", "--target", "far"], "--target"),
        (["--strategy", "random"], "--strategy"),
        (["--outer", "roof"], "--outer"),
        (["--tolerance", "wide"], "--tolerance: not a number"),
        (["--layers", "A"], "no options for files"),
        (["--union"], "no options for files"),
        (["--figure", "run.jpeg"], "must end in .svg, .pdf, .png"),
        (["--figure", "run"], "must end in"),
        (["--figure", "no/run.svg"], "no directory no"),
        (["--figure", "folder.svg"], "this is a directory"),
        (["--figure", "a\0b.svg"], "not a file name"),
        (["--trace", "run.svg"], "must end in .json"),
        (["--trace", "no/run.json"], "no directory no"),
        (["--nonsense"], "--nonsense"),
        (["more"], "more"),
    ],
)
def test_bad_options(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    words: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("folder.svg").mkdir()
    before = sorted(tmp_path.rglob("*"))
    assert words in refused(capsys, "explore", "circles", *arguments)
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize(
    "arguments", [["explore"], ["walk"], ["check"], ["gallery", "nowhere"], ["gallery", "--figure", "f.svg"]]
)
def test_bad_commands(capsys: pytest.CaptureFixture[str], arguments: list[str]) -> None:
    refused(capsys, *arguments)


FILES: dict[str, bytes] = {
    "empty.json": b"",
    "blank.json": b" \n",
    "empty.dxf": b"",
    "truncated.json": b'{"start": [0, 0], "obstacles": [{"circle": {"cen',
    "noise.json": bytes(range(256)) * 40,
    "noise.dxf": bytes(range(256)) * 40,
    "truncated.dxf": b"0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n1.0\n20",
    "nothing.dxf": EMPTY_DXF.encode(),
    "drawing.dwg": b"AC1032",
    "plain": b"hello",
    "list.json": b"[1, 2]",
    "nan.json": b'{"start": [NaN, 0], "radius": 9, "obstacles": []}',
    "words.json": b'{"start": ["one", 0], "radius": 9, "obstacles": []}',
    "deep.json": b"[" * 100_000,
}


@pytest.mark.parametrize("command", ["explore", "check"])
@pytest.mark.parametrize("name", FILES)
def test_bad_files(capsys: pytest.CaptureFixture[str], tmp_path: Path, command: str, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(FILES[name])
    outputs = ["--figure", str(tmp_path / "f.svg")] if command == "explore" else []
    assert name in refused(capsys, command, str(path), "--start", "0,0", *outputs)[:400]
    assert list(tmp_path.iterdir()) == [path]


def test_a_drawing_with_a_damaged_number_costs_one_line(tmp_path: Path) -> None:
    """ezdxf's logger wrote "recovered invalid floating point value" beside the error.

    In a process of its own: pytest's handlers would keep Python from printing it.
    """
    path = tmp_path / "damaged.dxf"
    path.write_text(
        EMPTY_DXF.replace("ENTITIES\n", "ENTITIES\n0\nLINE\n8\n0\n10\n1.2.3\n20\n0\n11\n1\n21\n1\n")
    )
    command = [sys.executable, "-m", "exactacq", "explore", str(path), "--start", "0,0", "--radius", "1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "damaged" in done.stderr


@pytest.mark.parametrize("name", ["huge.json", "huge.dxf"])
def test_200_megabytes_of_noise(capsys: pytest.CaptureFixture[str], tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    with path.open("wb") as file:
        file.write(b"\x07noise")
        file.truncate(200 << 20)
    assert "200 MB" in refused(capsys, "check", str(path), "--start", "0,0")


def test_missing_files_and_directories(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert "no such file" in refused(capsys, "check", str(tmp_path / "none.json"))
    assert "no such file or gallery scene" in refused(capsys, "check", "nowhere")
    assert "did you mean circles?" in refused(capsys, "check", "Circels")
    assert "this is a directory" in refused(capsys, "check", str(tmp_path))
    refused(capsys, "check", "a\0b.json")
    refused(capsys, "check", "")


UNIT = [[3, 0], [5, 0], [5, 2], [3, 2]]


@pytest.mark.parametrize(
    "obstacles",
    [
        [polygon([2, 0], [6, 4], [6, 0], [2, 4])],
        [polygon(*UNIT), polygon([5, 1], [7, 1], [7, 3])],
        [polygon(*UNIT), polygon([4, 1], [7, 1], [7, 3])],
        [polygon([3, 0], [3, 0], [5, 2])],
        [polygon([2, 0, "-1"], [6, 0], [4, 3])],
        [polygon([3, 0], [5, 0])],
        [circle(5, 0, 0)],
        [circle(5, 0, -1)],
        [circle(0, 0, 1)],
        [circle(5, 0, 1), circle(7, 0, 1)],
    ],
    ids=[
        "self-crossing", "touching", "overlapping", "zero-length edge", "bulge across a neighbour",
        "two vertices", "radius zero", "radius negative", "start inside", "tangent circles",
    ],
)  # fmt: skip
def test_bad_scenes(capsys: pytest.CaptureFixture[str], tmp_path: Path, obstacles: list[object]) -> None:
    path = scene(tmp_path, *obstacles)
    refused(capsys, "explore", path)
    assert cli.main(["check", path]) == 2
    out, err = capsys.readouterr()
    assert re.search(r": not OK: \d violations? of the rules for scenes\n$", out) and err == ""


@pytest.mark.parametrize("second", ["a.svg", "./a.svg"])
def test_two_outputs_of_one_name_are_refused(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, second: str
) -> None:
    monkeypatch.chdir(tmp_path)
    for command in (("explore", "circles"), ("path", "circles", "0,0", "20,5")):
        assert "is named for two outputs" in refused(capsys, *command, "--figure", "a.svg", "--out", second)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "strategy, option",
    [
        ("sightseer", ("--no-lookahead",)),
        ("nearest-frontier", ("--target", "visible")),
        ("sightseer", ("--max-moves", "4")),
        ("seed-spreader", ("--max-moves", "4")),
    ],
)
def test_options_that_a_strategy_does_not_heed_are_refused(
    capsys: pytest.CaptureFixture[str], strategy: str, option: tuple[str, ...]
) -> None:
    told = refused(capsys, "explore", "m14", "--strategy", strategy, *option)
    assert told.startswith(f"exactacq: {option[0]}: is for ")


def test_what_no_sweep_can_reach_is_counted(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """A wall across the terrain: what lies behind it was neither known nor missed."""
    wall = polygon([5, -1], [6, -1], [6, 11], [5, 11])
    world = scene(tmp_path, wall, circle(10, 5, 1), terrain={"width": 20, "height": 10})
    command = ("compare", world, "--strategy", "seed-spreader", "--strategy", "seed-spreader")
    assert cli.main(command) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["unreachable", "1", "1"] in rows and ["never", "seen", "0", "0"] in rows
    assert cli.main([*command, "--json"]) == 0
    runs = json.loads(capsys.readouterr().out)["runs"]
    assert [run["unreachable"] for run in runs] == [["O2"]] * 2


@pytest.mark.parametrize(
    "command", [("explore",), ("isovist", "--at", "0,0"), ("compare", "--terrain", "bbox:1")]
)
def test_names_send_a_terminal_nothing_to_obey(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, command: tuple[str, ...]
) -> None:
    world = scene(tmp_path, {**circle(5, 0, 2), "name": "red\x1b[31m\nand more"}, name="a\x1b[2J scene")
    assert cli.main([command[0], world, *command[1:]]) == 0
    out = capsys.readouterr().out
    assert "\x1b" not in out and (command[0] == "compare" or "red [31m and more" in out)


def test_the_report_of_a_trapped_sweep_names_the_obstacle(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    wall = {**polygon([5, -1], [6, -1], [6, 11], [5, 11]), "name": "WALL"}
    world = scene(tmp_path, wall, terrain={"width": 20, "height": 10})
    assert cli.main(["explore", world, "--strategy", "seed-spreader"]) == 0
    assert "is trapped in WALL\n" in capsys.readouterr().out


def test_a_start_in_a_hole_of_a_plate_is_told_of_the_room(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "plate.svg"
    loops = '<rect x="1" y="1" width="30" height="30"/><rect x="5" y="5" width="20" height="20"/>'
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 40">{loops}</svg>')
    command = ("explore", str(path), "--start", "15,25", "--radius", "60")
    assert refused(capsys, *command).endswith("; with --outer room it is a scene\n")
    assert cli.main([*command, "--outer", "room"]) == 0


def test_only_what_is_read_is_offered(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "a.pdf").touch()
    told = refused(capsys, "check", str(tmp_path / "a.pdf"))
    assert ".dxf" in told and ".csv" not in told


def test_many_violations_stay_one_line_of_bounded_length(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    line = refused(capsys, "explore", scene(tmp_path, *(circle(5 * k, 0, 3) for k in range(1, 60))))
    assert re.search(r"; and \d+ more, all told by exactacq check; move the shapes apart in the file", line)
    assert len(line) < 1500


def test_drawing_needs_a_start_and_scene_a_radius(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    drawing = tmp_path / "d.dxf"
    drawing.write_text(
        "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n5.0\n20\n0.0\n40\n1.0\n0\nENDSEC\n0\nEOF\n"
    )
    assert "--start" in refused(capsys, "explore", str(drawing), "--radius", "3")
    assert "--radius" in refused(capsys, "explore", str(drawing), "--start", "0,0")
    assert "2*pi" in answered(capsys, "explore", str(drawing), "--start", "0,0", "--radius", "9")
    # A sweep starts in the corner: the start only says what is the wall, and lies in the terrain.
    sweep = ("--strategy", "seed-spreader", "--terrain", "bbox:1", "--radius", "9")
    assert "S = (-1, -2)" in answered(capsys, "explore", str(drawing), "--start", "0,0", *sweep)


def test_input_is_not_overwritten(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = scene(tmp_path, circle(5, 0, 1))
    before = Path(path).read_bytes()
    assert "overwritten" in refused(capsys, "explore", path, "--trace", path)
    assert Path(path).read_bytes() == before


def test_a_disk_that_fails_leaves_no_file(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    line = refused(capsys, "explore", "circles", "--figure", str(tmp_path / "f.svg"))
    assert "No space left" in line
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may write anywhere")
def test_read_only_directories_are_refused(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    assert "cannot be written" in refused(capsys, "explore", "circles", "--figure", str(tmp_path / "f.svg"))


# -- interruptions and faults --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("error", "status", "words"),
    [
        (KeyboardInterrupt(), 130, "exactacq: interrupted"),
        (RuntimeError("a\nb"), 1, "internal error, please report it (RuntimeError: a b)"),
        (AssertionError(), 1, "internal error, please report it (AssertionError: "),
        (MemoryError(), 1, "internal error, please report it (MemoryError: "),
    ],
)
def test_interruptions_and_faults_cost_one_line(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    error: BaseException,
    status: int,
    words: str,
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr("exactacq.strategies.sightseer.strategy.sightseer", fail)
    assert cli.main(["explore", "circles", "--figure", str(tmp_path / "f.svg")]) == status
    out, err = capsys.readouterr()
    assert out == ""
    assert words in err
    assert err.count("\n") == 1
    assert not list(tmp_path.iterdir())


# -- as a process --------------------------------------------------------------------------------------


def test_process_leaves_nothing_on_standard_error(tmp_path: Path) -> None:
    done = process("explore", "circles", "--figure", str(tmp_path / "f.svg"))
    assert (done.returncode, done.stderr) == (0, "")
    assert "2 obstacles" in done.stdout


def test_process_refuses_with_one_line_and_status_2(tmp_path: Path) -> None:
    wrong = (["explore", "none.json"], ["explore", "circles", "--radius", "0"], ["--nonsense"])
    for arguments in some(wrong, 1):
        done = process(*arguments, cwd=tmp_path)
        assert (done.returncode, done.stdout) == (2, "")
        assert re.fullmatch(r"exactacq: [^\n]+\n", done.stderr)


def test_process_prints_in_any_encoding() -> None:
    done = process("explore", "circles", env={**os.environ, "PYTHONIOENCODING": "ascii"})
    assert (done.returncode, done.stderr) == (0, "")
    assert "5 + 12*pi" in done.stdout


def test_reader_that_stops_early_is_no_fault() -> None:
    command = [sys.executable, "-m", "exactacq", "gallery"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        assert running.stdout is not None
        assert running.stderr is not None
        running.stdout.close()
        assert running.stderr.read() == b""
        assert running.wait(60) in (1, 2)


def test_progress_is_shown_on_a_terminal_only(capsys: pytest.CaptureFixture[str]) -> None:
    """A terminal gets a bar on standard error, and standard output is the same as without."""
    out, seen = on_a_terminal("explore", "circles")
    assert b"exploring" in seen
    assert out.decode() == answered(capsys, "explore", "circles")


def readme() -> str:
    return (ROOT / "README.md").read_text(encoding="utf-8")


def test_readme_names_the_commands_that_are_run_in_ci() -> None:
    commands = [line.strip() for line in readme().splitlines() if line.startswith("    python3 -m venv")]
    assert len(commands) == 2
    assert commands[1] in (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()


def test_readme_example_prints_what_it_says(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code = "".join(re.findall(r"```python\n(.*?)```", readme(), re.S))
    exec(compile(code, "README.md", "exec"), {})
    printed = capsys.readouterr().out.splitlines()
    said = re.findall(r"^print\(.*# (.*)", code, re.M)
    assert len(said) == 5
    for shown, promised in zip(printed, said, strict=False):
        assert promised.startswith(shown)
    assert (tmp_path / "circles.svg").exists()


def test_readme_scene_is_valid(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (text,) = re.findall(r"```json\n(.*?)```", readme(), re.S)
    path = tmp_path / "scene.json"
    path.write_text(text)
    assert "OK" in answered(capsys, "check", str(path))
