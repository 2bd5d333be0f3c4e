"""The command ``exactacq compare``; what it needs is imported when it runs."""

from __future__ import annotations

import sys
from typing import Any

from exactacq.cli.arguments import (
    AsJson,
    FigureFile,
    LabelChoice,
    Radius,
    SceneName,
    Start,
    TerrainSize,
    range_of,
    same_file,
    scene_of,
)
from exactacq.cli.options import reads_files
from exactacq.cli.runs import explored, watched
from exactacq.errors import FormatError, InvalidScene
from exactacq.output.vocabulary import Labels
from exactacq.strategies.options import Strategy


@reads_files
def compare(
    scene: SceneName,
    radius: Radius = None,
    start: Start = None,
    terrain: TerrainSize = None,
    figure: FigureFile = None,
    labels: LabelChoice = Labels.ALL,
    as_json: AsJson = False,
    **options: Any,
) -> None:
    """Explore a scene by both strategies, and set what they do side by side.

    The Seed Spreader starts in the SW corner of the terrain, the Sightseer there if no other start is given.
    If only one of them takes the scene, it is told why the other one does not.
    """
    from exactacq.files.whole_files import FIGURES, check_output
    from exactacq.output.report import comparison, console, run_report
    from exactacq.output.report_data import comparison_data, text_of
    from exactacq.scene.bounding import at_corner

    range_ = range_of(radius)
    if figure is not None and same_file(check_output(figure, FIGURES), scene):
        raise FormatError(f"{scene}: would be overwritten by the output; choose another name")
    world = scene_of(scene, start, options, terrain)
    if range_ is None and world.radius is None:
        raise FormatError(f"{scene}: the scene has no radius of vision: give one with --radius R")
    corner = at_corner(world)
    starts = {Strategy.SIGHTSEER: corner if world.start is None else world, Strategy.SEED_SPREADER: corner}
    runs, refusals = [], []
    for strategy, begun in starts.items():
        try:
            runs.append(explored(begun, range_, strategy))
        except InvalidScene as error:
            first, *others = error.violations
            more = f" (and {len(others)} more)" if others else ""
            refusals.append(f"no {strategy.value}: {first}{more}")
    if not runs:
        raise InvalidScene(refusals)
    if as_json:
        sys.stdout.write(text_of(comparison_data(runs, refusals)))
    else:
        console().print(comparison(*runs) if len(runs) == 2 else run_report(runs[0]))
        for refusal in refusals:
            console().print(f"\n{refusal}", soft_wrap=True)
    if figure is not None:
        from exactacq.output.figures import save, save_pair

        with watched("drawing") as progress:
            if len(runs) == 2:
                save_pair(runs[0], runs[1], figure, labels=labels, progress=progress)
            else:
                save(runs[0], figure, labels=labels, progress=progress)
        if not as_json:
            print(f"figure written to {figure}")
