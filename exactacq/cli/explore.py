"""The command ``exactacq explore``; what it needs is imported when it runs."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer

from exactacq.cli.arguments import (
    DRAWINGS,
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
    naming,
    needs_start,
    number_of,
    range_of,
    scene_of,
)
from exactacq.cli.completion import strategies
from exactacq.cli.options import reads_files
from exactacq.cli.own_strategies import WORDS, NamedStrategy, chosen
from exactacq.cli.runs import explored, watched
from exactacq.errors import AuditError, ExactacqError, FormatError, Undecided
from exactacq.output.vocabulary import Labels
from exactacq.strategies.options import MOST_MOVES, Strategy, TargetChoice

if TYPE_CHECKING:
    from flint import fmpq

    from exactacq.strategies.run import Run


@reads_files
def explore(
    scene: SceneName,
    strategy: Annotated[
        str, typer.Option(metavar=WORDS, help="How to explore.", autocompletion=strategies)
    ] = Strategy.SIGHTSEER,
    radius: Radius = None,
    start: Start = None,
    terrain: TerrainSize = None,
    lookahead: Annotated[
        bool, typer.Option(help="Seed Spreader: look ahead on the map before a diversion.")
    ] = True,
    target: Annotated[
        TargetChoice, typer.Option(help="Seed Spreader: what a diversion aims at.")
    ] = TargetChoice.KNOWN,
    max_moves: MaxMoves = MOST_MOVES,
    figure: FigureFile = None,
    labels: LabelChoice = Labels.ALL,
    at: Annotated[
        str | None, typer.Option(metavar="L", help="Draw the figure after this length of the path.")
    ] = None,
    animate: Annotated[
        str | None,
        typer.Option(metavar="F", help="Write a page that plays the run: .html; or a film: .gif, .mp4."),
    ] = None,
    trace: Annotated[str | None, typer.Option(metavar="F", help="Write the exact run as .json.")] = None,
    drawing: Annotated[
        str | None,
        typer.Option(
            "--out", metavar="F", help=f"Write the run as a drawing or table: {', '.join(DRAWINGS)}."
        ),
    ] = None,
    check_run: Annotated[
        bool, typer.Option("--audit", help="Check the finished run by independent means.")
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the exact run as JSON, and no table.")
    ] = False,
    **options: Any,
) -> None:
    """Explore a scene; print a summary, or write the figure and the exact trace.

    A strategy of your own is FILE.py:NAME: a function of a robot in a file, which is run. NAME is that of the
    function, or the one under which it is registered.

    Where a comparison stays undecided, the run up to there is told, drawn and written; the exit status is 3.
    """
    from exactacq.files.whole_files import FIGURES, FILMS, PAGES, TRACES, write_whole
    from exactacq.output.report import console, run_report
    from exactacq.scene.bounding import at_corner

    range_ = range_of(radius)
    if at is not None and figure is None:
        raise FormatError("--at: names a moment of a figure; give the figure with --figure F")
    length = None if at is None else number_of("--at", at)
    wanted = ((figure, FIGURES), (trace, TRACES), (animate, (*PAGES, *FILMS)), (drawing, DRAWINGS))
    if animate is not None and animate.lower().endswith(FILMS):
        from exactacq.output.animation.film import check_film

        check_film(animate)
    check_outputs(scene, *wanted)
    rules = chosen(strategy)
    _check_use(rules, lookahead, target, max_moves)
    world = scene_of(scene, start, options, terrain)
    check_radius(scene, world, range_)
    check_start(world, rules.sweeps)
    trouble: ExactacqError | None = None
    # Of a drawing the start tells what is its wall.
    at_start = at_corner(world) if rules.sweeps and (start is None or needs_start(scene)) else world
    try:
        run = explored(at_start, range_, rules, lookahead, target, max_moves)
    except Undecided as error:
        if error.run is None:
            raise
        run, trouble = error.run, error
    if figure is not None:
        _draw(run, figure, length, labels)
    played = None if animate is None else _animate(run, animate, labels)
    if drawing is not None:
        from exactacq.output.results import write

        write(run, drawing)
    if check_run and trouble is None:
        trouble = _audited(run)
    if as_json or trace is not None:
        text = json.dumps(run.to_json(), indent=1, ensure_ascii=False) + "\n"
        if trace is not None:
            write_whole(trace, text.encode())
        if as_json:
            sys.stdout.write(text)
    if not as_json:
        out = console()
        out.print(run_report(run))
        if check_run and trouble is None:
            out.print("audit passed")
        written = (("figure", figure), ("trace", trace), ("run", drawing))
        for line in (played, *(f"{name} written to {path}" for name, path in written if path is not None)):
            if line is not None:
                out.print(line, soft_wrap=True)
    if trouble is not None:
        raise trouble


def _check_use(rules: NamedStrategy, lookahead: bool, target: TargetChoice, max_moves: int) -> None:
    """`FormatError` for an option that the strategy does not heed."""
    if rules.strategy is not Strategy.SEED_SPREADER:
        for option, is_given in (
            ("--no-lookahead", not lookahead),
            ("--target", target is not TargetChoice.KNOWN),
        ):
            if is_given:
                raise FormatError(f"{option}: is for the Seed Spreader; add --strategy seed-spreader")
    if rules.strategy in tuple(Strategy) and max_moves != MOST_MOVES:
        raise FormatError(f"--max-moves: is for strategies of your own, and {rules.name} has no limit")


def _audited(run: Run) -> ExactacqError | None:
    """What the audit has found, if anything: it is told after the report."""
    from exactacq.auditing.audit import audit

    try:
        with watched("auditing") as progress:
            audit(run, progress=progress)
    except (AuditError, Undecided) as error:
        return error
    return None


def _draw(run: Run, path: str, at: fmpq | None, labels: Labels) -> None:
    """Write the figure."""
    from exactacq.output.figures import save

    with watched("drawing") as progress:
        naming("--at", lambda: save(run, path, at, labels=labels, progress=progress))


def _animate(run: Run, path: str, labels: Labels) -> str:
    """Write the page or the film, and say so."""
    from exactacq.files.whole_files import FILMS, write_whole

    if not path.lower().endswith(FILMS):
        from exactacq.output.animation.frames import frames_of
        from exactacq.output.animation.page import page

        with watched("drawing") as progress:
            text = page(run, frames_of(run, progress=progress), labels=labels)
        write_whole(path, text.encode())
        return f"page written to {path}"
    from exactacq.output.animation.film import film

    with watched("drawing") as progress:
        left_out = film(run, path, progress, labels=labels)
    less = f", without {left_out} frames that are beyond the limits" if left_out else ""
    return f"film written to {path}{less}"
