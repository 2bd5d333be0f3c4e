"""The tutorial's command lines run, and print what the page says; its Python examples are doctests."""

from __future__ import annotations

import doctest
import re
import shlex
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from shutil import copyfile

import pytest

import exactacq
from exactacq.cli import main
from exactacq.output.animation import film, frames

ROOT = Path(__file__).parent.parent
PAGE = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
DRAWING = Path(exactacq.__file__).parent / "files" / "data" / "issue42.dxf"
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def commands(text: str) -> Iterator[tuple[str, str]]:
    """The command lines in a page's console blocks, each with what is said to be printed."""
    for block in re.findall(r"^```console\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        for part in re.split(r"^\$ ", block.replace("\\\n", " "), flags=re.MULTILINE)[1:]:
            line, _, printed = part.partition("\n")
            yield line, printed


def test_command_lines_print_what_the_page_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    copyfile(DRAWING, tmp_path / "part.dxf")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(film, "FRAMES", 3)
    monkeypatch.setattr(film, "FEWEST", 3)
    monkeypatch.setattr(frames, "frames_of", partial(frames.frames_of, limit=9, fine=0))
    told = list(commands(PAGE))
    assert len(told) >= 10
    for line, printed in told:
        program, *arguments = shlex.split(line)
        assert program == "exactacq" and main(arguments) == 0, line
        found = capsys.readouterr().out
        assert doctest.OutputChecker().check_output(printed, found, FLAGS), f"{line}\n{found}"
        for name in re.findall(r"--(?:figure|trace|out|animate) (\S+)", line):
            assert (tmp_path / name).stat().st_size > 0


def test_a_false_output_is_found() -> None:
    page = "```console\n$ exactacq gallery m4 \\\n    --json\n{...}\n$ exactacq gallery\n```\n"
    assert [(shlex.split(line), said) for line, said in commands(page)] == [
        (["exactacq", "gallery", "m4", "--json"], "{...}\n"),
        (["exactacq", "gallery"], ""),
    ]
    assert not doctest.OutputChecker().check_output("length 3\n...\n", "length 4\nmore\n", FLAGS)


def test_every_command_of_the_program_that_explores_is_shown() -> None:
    shown = {line.split()[1] for line, _ in commands(PAGE)}
    assert {"check", "explore", "isovist", "convert", "compare"} <= shown


def test_every_example_is_in_a_block_that_is_run() -> None:
    """Command lines stand in console blocks, Python in blocks of doctests."""
    kinds = re.findall(r"^```(\S+)$", PAGE, re.MULTILINE)
    assert set(kinds) == {"pycon", "console"}
    assert "$ exactacq" not in re.sub(r"^```console.*?^```", "", PAGE, flags=re.MULTILINE | re.DOTALL)
