"""The command ``exactacq path``; what it needs is imported when it runs."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from exactacq.cli.arguments import (
    DRAWINGS,
    FigureFile,
    SceneName,
    check_free,
    check_outputs,
    needs_start,
    place_of,
    scene_of,
)
from exactacq.cli.options import reads_files
from exactacq.errors import InvalidScene

Place = Annotated[str, typer.Argument(metavar="A", help="Where the path begins: X,Y.")]
Goal = Annotated[str, typer.Argument(metavar="B", help="Where it ends: X,Y.")]


@reads_files
def path(
    scene: SceneName,
    a: Place,
    b: Goal,
    figure: FigureFile = None,
    out: Annotated[
        str | None, typer.Option(metavar="F", help=f"Write the path: {', '.join(DRAWINGS)}.")
    ] = None,
    **options: Any,
) -> None:
    """A shortest path between two points among the obstacles of a scene: its exact length and pieces."""
    from exactacq.files.whole_files import FIGURES
    from exactacq.output.report import console, path_report
    from exactacq.output.results import write
    from exactacq.visibility.shortest_path import shortest_path

    ends = place_of("A", a), place_of("B", b)
    check_outputs(scene, (figure, FIGURES), (out, DRAWINGS))
    world = scene_of(scene, a if needs_start(scene) else None, options)
    for name, place in zip("AB", ends, strict=True):
        check_free(world, name, place)
    found = shortest_path(world, *ends)
    if found is None:
        raise InvalidScene([f"{scene}: no path leads from {a} to {b}: the terrain's border is in the way"])
    remarks = () if out is None else write(found, out)
    if figure is not None:
        from exactacq.output.figures import save

        save(found, figure)
    console().print(path_report(found))
    if figure is not None:
        print(f"figure written to {figure}")
    if out is not None:
        print("; ".join((f"path written to {out}", *remarks)))
