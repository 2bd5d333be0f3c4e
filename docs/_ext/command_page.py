"""The page of the command line: each command with its help as it is, and examples with what they print."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import chdir, redirect_stderr, redirect_stdout
from importlib.resources import files
from io import StringIO
from itertools import groupby
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory
from typing import Any

import typer
from claims_page import plain

from exactacq.cli import app, main
from exactacq.cli.manual import EXAMPLES, STATUSES, Example

DRAWING = files("exactacq") / "files" / "data" / "issue42.dxf"
"""What the examples call ``part.dxf``."""
SHORTLY = ", ".join(f"{number} {words.partition(':')[0]}" for number, words in STATUSES.items())
"""The exit statuses as each command tells them."""
LINES = 24
"""Most lines of what an example prints that are shown."""


def write(folder: Path) -> None:
    """Write commands.md: the sections of all commands, with what their examples print here and now."""
    program = typer.main.get_command(app)
    parent = typer.Context(program, info_name="exactacq")
    lines = [
        "## Without a command",
        "",
        *_parameters(program, parent),
        "## Exit statuses",
        "",
        *_table(("status", "meaning"), STATUSES.items()),
    ]
    with TemporaryDirectory() as place, chdir(place):
        copyfile(str(DRAWING), "part.dxf")
        for name, command in program.commands.items():
            context = typer.Context(command, info_name=name, parent=parent)
            lines += section(name, command, context)
            for example in EXAMPLES[name]:
                lines += told(example, *(printed(example) if example.ends else (0, "")))
            lines += [f"[Exit statuses](#exit-statuses): {SHORTLY}.", ""]
    (folder / "commands.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


def section(name: str, command: Any, context: Any) -> Iterator[str]:
    """What the help of a command says: purpose, usage, arguments, and options in their panels."""
    yield from (f"## {name}", "")
    for paragraph in command.help.split("\n\n"):
        yield from (plain(paragraph), "")
    arguments = [p.metavar for p in command.get_params(context) if p.param_type_name == "argument"]
    yield from ("```text", " ".join([f"exactacq {name} [OPTIONS]", *arguments]), "```", "")
    yield from _parameters(command, context)


def _parameters(command: Any, context: Any) -> Iterator[str]:
    """Tables of the arguments and of the options, one for each panel of the help."""
    shown = [p for p in command.get_params(context) if not getattr(p, "hidden", False)]
    arguments = [(_code(p.metavar), plain(p.help)) for p in shown if p.param_type_name == "argument"]
    if arguments:
        yield from _table(("argument", "meaning"), arguments)
    options = sorted((p for p in shown if p.param_type_name == "option"), key=_panel)
    for panel, group in groupby(options, key=_panel):
        records = [option.get_help_record(context) for option in group]
        if panel:
            yield from (f"*{panel}*", "")
        yield from _table(("option", "meaning"), [(_code(name), plain(words)) for name, words in records])


def _panel(option: Any) -> str:
    """The panel of the help that an option is in; the first one has no name."""
    return option.rich_help_panel or ""


def _table(head: tuple[str, str], rows: Any) -> Iterator[str]:
    yield from (f"| {head[0]} | {head[1]} |", "| --- | --- |")
    yield from (f"| {first} | {second} |" for first, second in rows)
    yield ""


def _code(text: str) -> str:
    """Code in a table, where a bar would end the cell."""
    return "`{}`".format(text.replace("|", "\\|"))


def printed(example: Example) -> tuple[int, str]:
    """The exit status of an example that is run in the current folder, and what it prints."""
    said = StringIO()
    with redirect_stdout(said), redirect_stderr(StringIO()):
        status = main(example.line.split())
    return status, said.getvalue()


def told(example: Example, status: int, said: str) -> Iterator[str]:
    """An example as the page shows it; RuntimeError if it went wrong."""
    if status != 0:
        raise RuntimeError(f"exactacq {example.line}: exit status {status}")
    lines = [line.rstrip() for line in said.rstrip().splitlines()]
    more = [f"... ({len(lines) - LINES} more lines)"] if len(lines) > LINES + 1 else []
    shown = lines[:LINES] + more if more else lines
    yield from (plain(example.words), "", "```console", f"$ exactacq {example.line}", *shown, "```", "")
