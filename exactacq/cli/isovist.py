"""The command ``exactacq isovist``; what it needs is imported when it runs."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from exactacq.cli.arguments import (
    DRAWINGS,
    Radius,
    SceneName,
    check_free,
    check_outputs,
    check_radius,
    needs_start,
    place_of,
    range_of,
    scene_of,
)
from exactacq.cli.options import reads_files


@reads_files
def isovist(
    scene: SceneName,
    at: Annotated[str, typer.Option(metavar="X,Y", help="The place to look from.")],
    radius: Radius = None,
    out: Annotated[
        str | None, typer.Option(metavar="F", help=f"Write the view: {', '.join(DRAWINGS)}.")
    ] = None,
    **options: Any,
) -> None:
    """What is seen from a place within a radius: area, perimeter and pieces; or a drawing of it."""
    from exactacq.output.report import console, view_report
    from exactacq.output.results import write
    from exactacq.visibility.isovist import isovist as view_from

    range_, place = range_of(radius), place_of("--at", at)
    check_outputs(scene, (out, DRAWINGS))
    world = scene_of(scene, at if needs_start(scene) else None, options)
    check_radius(scene, world, range_)
    check_free(world, "--at", place)
    view = view_from(world, place, range_)
    remarks = () if out is None else write(view, out)
    console().print(view_report(view))
    if out is not None:
        print("; ".join((f"view written to {out}", *remarks)))
