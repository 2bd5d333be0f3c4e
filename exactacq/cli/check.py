"""The command ``exactacq check``; what it needs is imported when it runs."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import typer

from exactacq.cli.arguments import AsJson, FigureFile, SceneName, Start, check_outputs, place_of
from exactacq.cli.options import read_from_text, reads_files
from exactacq.errors import FormatError

if TYPE_CHECKING:
    from exactacq.files.checking.inspection import Inspection

NOT_OK = 2
"""Exit status for a file with violations, or with an open chain that would enclose other loops."""


@reads_files
def check(
    scene: SceneName,
    start: Start = None,
    figure: FigureFile = None,
    as_json: AsJson = False,
    **options: Any,
) -> None:
    """Tell what a file holds, what is wrong with it, and what cures that; propose a start and a radius.

    No start is needed. The exit status is 2 if there are violations, or if a chain stays open that would
    enclose other loops; then the last line says so. Options are named as cures only after they were tried.
    """
    from exactacq.files.whole_files import FIGURES
    from exactacq.output.inspections import inspection_data, inspection_report
    from exactacq.output.report import console
    from exactacq.output.report_data import text_of

    check_outputs(scene, (figure, FIGURES))
    found = _inspected(scene, start, options)
    refused = None if figure is None else _draw(found, figure)
    if as_json:
        sys.stdout.write(text_of(inspection_data(found)))
    else:
        out = console()
        parts = list(inspection_report(found))
        for part in parts[:-1]:
            out.print(part, soft_wrap=isinstance(part, str))
        if figure is not None and refused is None:
            out.print(f"figure written to {figure}", soft_wrap=True)
        out.print(parts[-1], soft_wrap=True)
    if refused is not None:
        raise refused
    if not found.ok:
        raise typer.Exit(NOT_OK)


def _draw(found: Inspection, path: str) -> FormatError | None:
    """Write the figure; why there is none is told after the report."""
    from exactacq.output.figures.drawing_figure import save_inspection

    try:
        save_inspection(found, path)
    except FormatError as error:
        return error
    return None


def _inspected(scene: str, start: str | None, options: dict[str, Any]) -> Inspection:
    """The inspection; with a progress bar if a terminal watches."""
    from exactacq.files.checking.inspection import inspect

    place = None if start is None else place_of("--start", start)
    values: dict[str, Any] = read_from_text(options)
    if not sys.stderr.isatty():
        return inspect(scene, start=place, **values)
    from exactacq.output.report import progress_bar

    with progress_bar("checking") as bar:
        task = bar.add_task("")
        return inspect(
            scene,
            start=place,
            progress=lambda done, total: bar.update(task, completed=done, total=total),
            **values,
        )
