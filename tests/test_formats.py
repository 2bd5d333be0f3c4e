"""The registry of file formats: its readers exist and take the options that it lists, and no others."""

from __future__ import annotations

import inspect
from importlib import import_module
from pathlib import Path

import pytest

import exactacq as xa
from exactacq import cli
from exactacq.files.formats import FileOption, Format, format_of, register

FORMATS = xa.formats()
DATA = Path(__file__).parent / "data"


@pytest.mark.parametrize("known", FORMATS, ids=lambda known: known.name)
def test_a_reader_takes_the_options_of_its_format(known: Format) -> None:
    if known.reader is None:
        assert not known.options and known.writer is not None
        return
    module, function = known.reader.split(":")
    path, start, *rest = inspect.signature(getattr(import_module(module), function)).parameters.values()
    assert (path.name, start.name) == ("path", "start")
    assert {p.name: p.default for p in rest} == {o.name: o.default for o in known.options}


@pytest.mark.parametrize("known", FORMATS, ids=lambda known: known.name)
def test_the_suffix_tells_the_format_in_any_case(known: Format) -> None:
    assert all(format_of(Path(f"x{suffix.upper()}")) is known for suffix in known.suffixes)


@pytest.mark.parametrize("known", FORMATS, ids=lambda known: known.name)
def test_foreign_options_are_refused_in_one_line(known: Format, tmp_path: Path) -> None:
    path = tmp_path / f"x{known.suffixes[0]}"
    path.write_bytes(b"?")
    own = {option.name for option in known.options}
    foreign = {o.name: o for other in FORMATS for o in other.options if o.name not in own}
    for name, option in foreign.items():
        value = {"flag": True, "number": 1, "names": "A", "choice": option.choices[-1:]}[option.kind]
        value = value[0] if isinstance(value, tuple) else value
        with pytest.raises(xa.FormatError, match=rf"{name} is for .*, not for {known.title}; leave it out"):
            xa.load(path, **{name: value})
    with pytest.raises(xa.FormatError, match="no option 'colour'; there are "):
        xa.load(path, colour=1)


def test_why_drawings_are_not_simplified(tmp_path: Path) -> None:
    """A staircase that was drawn may be one; those that cells make say nothing."""
    path = tmp_path / "stairs.wkt"
    path.write_text("POLYGON((0 0, 3 0, 3 1, 2 1, 2 2, 1 2, 1 3, 0 3, 0 0))")
    with pytest.raises(xa.FormatError, match=r"not for well-known text; leave it out \(it smooths the steps"):
        xa.load(path, simplify=1)


def test_options_of_one_name_are_one_option() -> None:
    seen: dict[str, FileOption] = {}
    for known in FORMATS:
        for option in known.options:
            assert seen.setdefault(option.name, option) is option


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"layers": 3}, "layers: a text or a list of texts is needed, not 3"),
        ({"layers": [3]}, "layers: a text or a list of texts is needed"),
        ({"tolerance": "wide"}, "tolerance: not a number: 'wide'; give a number like"),
        ({"outer": "roof"}, 'outer is "wall" or "drop" or "room", not \'roof\''),
        ({"union": "yes"}, "union is False or True, not 'yes'"),
    ],
)
def test_values_of_another_kind(options: dict[str, object], message: str) -> None:
    with pytest.raises(xa.FormatError, match=message):
        xa.load("drawing.dxf", **options)


def test_no_two_formats_share_a_name_or_a_suffix() -> None:
    for taken in ({"name": "dxf", "suffixes": (".x",)}, {"name": "x", "suffixes": (".dxf",)}):
        with pytest.raises(ValueError, match="there is a format"):
            register(Format(title="x", reader="x:x", **taken))  # type: ignore[arg-type]


def test_the_command_line_offers_every_option(capsys: pytest.CaptureFixture[str]) -> None:
    for command in ("explore", "compare", "check"):
        assert cli.main([command, "--help"]) == 0
        out = capsys.readouterr().out
        assert all(f"--{option.name}" in out for known in FORMATS for option in known.options)


@pytest.mark.parametrize(
    ("name", "arguments", "words"),
    [
        ("inpa.wkt", (), "154"),
        (
            "turtlebot3.yaml",
            ("--start", "-1/2,-1/2", "--corners", "part"),
            "parted the blocked cells at 1 corner",
        ),
        (
            "turtlebot3.pgm",
            ("--resolution", "0.05", "--threshold", "0.3"),
            "4 outer loops, 4 holes, 6 single loops",
        ),
        ("keyboard.svg", ("--start", "3/2,5", "--outer", "room"), "and the enclosure"),
        ("board.kicad_pcb", ("--start", "105,-45", "--layers", "Edge.Cuts"), "6, and the enclosure"),
        ("issue21.dxf", ("--start", "470,0"), "the file's unit: millimeters"),
    ],
)
def test_the_command_line_checks_files_of_all_kinds(
    capsys: pytest.CaptureFixture[str], name: str, arguments: tuple[str, ...], words: str
) -> None:
    assert cli.main(["check", str(DATA / name), *arguments]) == 0
    out, err = capsys.readouterr()
    assert words in " ".join(out.split()) and err == ""


def test_the_command_line_explores_a_map_and_draws_it(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    target = tmp_path / "map.svg"
    line = ["explore", str(DATA / "turtlebot3.yaml"), "--start", "-1/2,-1/2", "--radius", "1/2"]
    assert cli.main([*line, "--figure", str(target), "--audit"]) == 0
    assert "audit passed" in capsys.readouterr().out
    assert target.stat().st_size > 1000
    assert cli.main([*line, "--union"]) == 2
    assert "union is for" in capsys.readouterr().err
    assert cli.main([*line, "--corners", "round"]) == 2
    assert capsys.readouterr().err == 'exactacq: --corners is "join" or "part", not \'round\'\n'
