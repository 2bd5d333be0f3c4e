"""The command ``exactacq compare``; what it needs is imported when it runs."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer

from exactacq.cli.arguments import (
    AsJson,
    FigureFile,
    LabelChoice,
    MaxMoves,
    Radius,
    SceneName,
    Start,
    TerrainSize,
    check_outputs,
    check_radius,
    check_start,
    range_of,
    scene_of,
)
from exactacq.cli.completion import strategies
from exactacq.cli.options import reads_files
from exactacq.cli.own_strategies import WORDS, chosen
from exactacq.cli.runs import explored, watched
from exactacq.errors import InvalidScene
from exactacq.output.vocabulary import Labels
from exactacq.strategies.options import MOST_MOVES, Strategy

if TYPE_CHECKING:
    from exactacq.strategies.run import Run


@reads_files
def compare(
    scene: SceneName,
    radius: Radius = None,
    start: Start = None,
    terrain: TerrainSize = None,
    strategy: Annotated[
        list[str] | None,
        typer.Option(
            metavar=WORDS, help="One to compare; may be repeated. Default: both.", autocompletion=strategies
        ),
    ] = None,
    max_moves: MaxMoves = MOST_MOVES,
    figure: FigureFile = None,
    labels: LabelChoice = Labels.ALL,
    animate: Annotated[
        str | None,
        typer.Option(metavar="F", help="Write a page that plays the runs side by side: .html."),
    ] = None,
    as_json: AsJson = False,
    **options: Any,
) -> None:
    """Explore a scene by both strategies, or those that are named, and set what they do side by side.

    The table has what they know and missed, and how long they are beside the lower bounds of any path.
    The Seed Spreader starts in the SW corner of the terrain, the others there if no other start is given. If
    one of them does not take the scene, it is told why.
    """
    from exactacq.files.whole_files import FIGURES, PAGES
    from exactacq.output.report import comparison, console, run_report
    from exactacq.output.report_data import comparison_data, text_of
    from exactacq.scene.bounding import at_corner

    range_ = range_of(radius)
    check_outputs(scene, (figure, FIGURES), (animate, PAGES))
    wanted = [chosen(text) for text in strategy or Strategy]
    world = scene_of(scene, start, options, terrain)
    check_radius(scene, world, range_)
    runs: list[Run] = []
    refusals: list[str] = []
    for rules in wanted:
        try:
            placed = at_corner(world) if world.start is None or rules.sweeps else world
            check_start(placed, rules.sweeps)
            runs.append(explored(placed, range_, rules, max_moves=max_moves))
        except InvalidScene as error:
            first, *others = error.violations
            more = f" (and {len(others)} more)" if others else ""
            refusals.append(f"no {rules.name}: {first}{more}")
    if not runs:
        raise InvalidScene(refusals)
    if as_json:
        sys.stdout.write(text_of(comparison_data(runs, refusals)))
    else:
        console().print(comparison(runs) if len(runs) > 1 else run_report(runs[0]))
        for refusal in refusals:
            console().print(f"\n{refusal}", soft_wrap=True)
    if figure is not None:
        _draw(runs, figure, labels)
    if animate is not None:
        _animate(runs, animate, labels)
    if not as_json:
        for what, path in (("figure", figure), ("page", animate)):
            if path is not None:
                print(f"{what} written to {path}")


def _draw(runs: list[Run], path: str, labels: Labels) -> None:
    """Write the figure."""
    from exactacq.output.figures import save, save_side_by_side

    with watched("drawing") as progress:
        if len(runs) > 1:
            save_side_by_side(runs, path, labels=labels, progress=progress)
        else:
            save(runs[0], path, labels=labels, progress=progress)


def _animate(runs: list[Run], path: str, labels: Labels) -> None:
    """Write the page."""
    from exactacq.files.whole_files import write_whole
    from exactacq.output.animation.frames import frames_of
    from exactacq.output.animation.several import page_of_runs

    with watched("drawing") as progress:
        text = page_of_runs(runs, (frames_of(run, progress=progress) for run in runs), labels=labels)
    write_whole(path, text.encode())
