"""The page of the command line says what the help says, and its examples run."""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import chdir
from functools import partial
from pathlib import Path
from shutil import copyfile
from types import ModuleType

import pytest
from nightly import NIGHTLY

from exactacq.cli import entry
from exactacq.cli.manual import EXAMPLES, STATUSES, Example
from exactacq.output.animation import frames

DOCS = Path(__file__).parent.parent / "docs"
LONG = ("verify --scenes", "verify --family", "search")
FIGURES = ("explore part.dxf", "compare figure2", "compare figure3")


@pytest.fixture(scope="module")
def extension() -> Iterator[ModuleType]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(DOCS / "_ext")
        yield importlib.import_module("command_page")
    for name in ("command_page", "claims_page", "cut_out"):
        sys.modules.pop(name, None)


def quickly(run: Callable[[Example], tuple[int, str]], example: Example) -> tuple[int, str]:
    """What an example prints; nothing for those that start processes or draw most: the build of the pages
    runs them.
    """
    return (0, "") if example.line.startswith((*LONG, *FIGURES)) else run(example)


@pytest.fixture(scope="module")
def text(extension: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The page; making it runs all examples, one after the other in one folder."""
    folder = tmp_path_factory.mktemp("made")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(frames, "frames_of", partial(frames.frames_of, limit=9, fine=0))
        if not NIGHTLY:
            patch.setattr(extension, "printed", partial(quickly, extension.printed))
        extension.write(folder)
    return (folder / "commands.md").read_text()


def sections(text: str) -> dict[str, str]:
    parts = re.split(r"^## (.*)\n", text, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def test_every_command_has_its_section(text: str) -> None:
    names = [command.callback.__name__ for command in entry.app.registered_commands]
    assert list(sections(text)) == ["Without a command", "Exit statuses", *names]
    assert list(EXAMPLES) == names


def test_sections_have_usage_options_statuses_and_examples(text: str) -> None:
    for name, section in list(sections(text).items())[2:]:
        assert f"```text\nexactacq {name} [OPTIONS]" in section
        assert section.count("$ exactacq ") == len(EXAMPLES[name]) in (2, 3)
        assert all(f"$ exactacq {example.line}\n" in section for example in EXAMPLES[name])
        assert "| `--help` |" in section.split("*How the file is read*")[0]
        assert "0 done, 1 fault, 2 refused, 3 undecided, 130 interrupted." in section
    assert "| `--outer wall\\|drop\\|room` |" in sections(text)["check"].split("*How the file is read*")[1]
    assert "| `SCENE` | A file, or the name of a gallery scene. |" in text


def test_what_is_shown_was_printed(text: str) -> None:
    assert "length  5 + 12*pi  ≈ 42.699111843077518862" in text
    assert "audit passed\ntrace written to run.json\n" in text
    assert re.search(r"^\.\.\. \(\d+ more lines\)$", text, re.MULTILINE)


def test_an_example_that_goes_wrong_ends_the_build(extension: ModuleType, tmp_path: Path) -> None:
    example = Example("explore nowhere.dxf", "A file that is not there.")
    with chdir(tmp_path), pytest.raises(RuntimeError, match=r"nowhere\.dxf: exit status 2"):
        list(extension.told(example, *extension.printed(example)))


def test_statuses_are_those_of_the_program(capsys: pytest.CaptureFixture[str]) -> None:
    assert set(STATUSES) == {0, entry.INTERNAL, entry.REFUSED, entry.UNDECIDED, entry.INTERRUPTED}
    assert entry.main(["--help"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert all(f"{number} {' '.join(words.split())}" in shown for number, words in STATUSES.items())


def test_the_help_shows_the_examples(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    for name, examples in EXAMPLES.items():
        assert entry.main([name, "--help"]) == 0
        shown = " ".join(capsys.readouterr().out.split())
        assert all(f"exactacq {example.line}" in shown for example in examples)


def test_the_drawing_is_the_one_of_the_tutorial(extension: ModuleType, tmp_path: Path) -> None:
    copyfile(str(extension.DRAWING), tmp_path / "part.dxf")
    with chdir(tmp_path):
        assert extension.printed(EXAMPLES["check"][0])[1].endswith("part.dxf: OK\n")
