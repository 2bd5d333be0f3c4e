"""The command line. Errors are one line on standard error and exit status 2; files are written whole.

What a command needs is imported when it runs: help and refusals of wrong options wait for none of it.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from exactacq.errors import AuditError, ExactacqError, FormatError, InvalidScene, Undecided
from exactacq.file_options import read_from_text, reads_files
from exactacq.files.formats import written_suffixes
from exactacq.strategies.options import Strategy, TargetChoice
from exactacq.study.campaign.command import verify
from exactacq.study.search.command import search

if TYPE_CHECKING:
    from flint import fmpq

    from exactacq.scene.scene import Scene
    from exactacq.scene.shapes import Terrain
    from exactacq.strategies.run import Run

REFUSED, INTERNAL, UNDECIDED, INTERRUPTED = 2, 1, 3, 130
"""Exit statuses: bad input, a file that cannot be written or a failed audit; a fault of exactacq itself; a
comparison beyond its limits; control-C."""
VIOLATIONS = 8
"""Most violations of a scene that the one line of an error names."""
Result = TypeVar("Result")
UsageError: type[Exception] = typer.BadParameter.__bases__[0]
"""What typer raises for a wrong command line; where it lives depends on typer's release."""


DRAWINGS = tuple(suffix for suffix in written_suffixes() if suffix != ".json")
"""What a view is written as."""
SceneName = Annotated[str, typer.Argument(metavar="SCENE", help="A file, or the name of a gallery scene.")]
Start = Annotated[str | None, typer.Option(metavar="X,Y", help="Start point; required for drawings.")]
TerrainSize = Annotated[
    str | None,
    typer.Option(
        metavar="B,A",
        help="Terrain: B,A or X,Y,B,A (SW corner, width, height) or bbox[:MARGIN]; default: the scene's.",
    ),
]
Radius = Annotated[str | None, typer.Option(metavar="R", help="Radius of vision; default: the scene's own.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON, and no table.")]
FigureFile = Annotated[str | None, typer.Option(metavar="F", help="Write a figure: .svg, .pdf or .png.")]

app = typer.Typer(
    name="exactacq",
    help="Exact sensor-based terrain acquisition. Numbers are exact: 10, 0.1 or 21/2.",
    add_completion=False,
    pretty_exceptions_enable=False,
)


def _print_version(asked: bool) -> None:
    if asked:
        from exactacq.kernel import DESCRIPTION

        print(f"exactacq {version('exactacq')} ({DESCRIPTION})")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _top(
    context: typer.Context,
    _: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        print(context.get_help())


@app.command()
@reads_files
def explore(
    scene: SceneName,
    strategy: Annotated[Strategy, typer.Option(help="How to explore.")] = Strategy.SIGHTSEER,
    radius: Radius = None,
    start: Start = None,
    terrain: TerrainSize = None,
    lookahead: Annotated[
        bool, typer.Option(help="Seed Spreader: look ahead on the map before a diversion.")
    ] = True,
    target: Annotated[
        TargetChoice, typer.Option(help="Seed Spreader: what a diversion aims at.")
    ] = TargetChoice.KNOWN,
    figure: FigureFile = None,
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

    Where a comparison stays undecided, all that is done for the run up to there, and the exit status is 3.
    """
    from exactacq.files.whole_files import FIGURES, FILMS, PAGES, TRACES, check_output, write_whole
    from exactacq.output.report import console, run_report

    range_ = _range(radius)
    if at is not None and figure is None:
        raise FormatError("--at: names a moment of a figure; give the figure with --figure F")
    length = None if at is None else _number("--at", at)
    wanted = ((figure, FIGURES), (trace, TRACES), (animate, (*PAGES, *FILMS)), (drawing, DRAWINGS))
    outputs = [check_output(f, s) for f, s in wanted if f is not None]
    if animate is not None and animate.lower().endswith(FILMS):
        from exactacq.output.animation.film import check_film

        check_film(animate)
    if any(_same_file(path, scene) for path in outputs):
        raise FormatError(f"{scene}: would be overwritten by the output; choose another name")
    world = _scene(scene, start, options, terrain)
    if range_ is None and world.radius is None:
        raise FormatError(f"{scene}: the scene has no radius of vision: give one with --radius R")
    trouble: ExactacqError | None = None
    try:
        sweeps = strategy is Strategy.SEED_SPREADER and start is None
        run = _explored(_at_corner(world) if sweeps else world, range_, strategy, lookahead, target)
    except Undecided as error:
        if error.run is None:
            raise
        run, trouble = error.run, error
    if figure is not None:
        from exactacq.output.figures import save

        _said("--at", lambda: save(run, figure, length))
    played = None if animate is None else _animate(run, animate)
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


def _audited(run: Run) -> ExactacqError | None:
    """What the audit has found, if anything: it is told after the report."""
    from exactacq.auditing.audit import audit

    try:
        audit(run)
    except (AuditError, Undecided) as error:
        return error
    return None


def _animate(run: Run, path: str) -> str:
    """Write the page or the film, and say so; a film takes time, so a terminal is told how far it is."""
    from exactacq.files.whole_files import FILMS, write_whole

    if not path.lower().endswith(FILMS):
        from exactacq.output.animation.page import frames_of, page

        write_whole(path, page(run, frames_of(run)).encode())
        return f"page written to {path}"
    from exactacq.output.animation.film import film

    if not sys.stderr.isatty():
        left_out = film(run, path)
    else:
        from exactacq.output.report import progress_bar

        with progress_bar("drawing") as bar:
            task = bar.add_task("")
            left_out = film(run, path, lambda done, total: bar.update(task, completed=done, total=total))
    less = f", without {left_out} frames that are beyond the limits" if left_out else ""
    return f"film written to {path}{less}"


@app.command()
@reads_files
def compare(
    scene: SceneName,
    radius: Radius = None,
    start: Start = None,
    terrain: TerrainSize = None,
    figure: FigureFile = None,
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

    range_ = _range(radius)
    if figure is not None and _same_file(check_output(figure, FIGURES), scene):
        raise FormatError(f"{scene}: would be overwritten by the output; choose another name")
    world = _scene(scene, start, options, terrain)
    if range_ is None and world.radius is None:
        raise FormatError(f"{scene}: the scene has no radius of vision: give one with --radius R")
    corner = _at_corner(world)
    starts = {Strategy.SIGHTSEER: corner if world.start is None else world, Strategy.SEED_SPREADER: corner}
    runs, refusals = [], []
    for strategy, begun in starts.items():
        try:
            runs.append(_explored(begun, range_, strategy))
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

        if len(runs) == 2:
            save_pair(runs[0], runs[1], figure)
        else:
            save(runs[0], figure)
        if not as_json:
            print(f"figure written to {figure}")


def _at_corner(scene: Scene) -> Scene:
    """The scene with its start in the SW corner of what the Seed Spreader sweeps, if there is such."""
    from exactacq.scene.bounding import rectangular_room

    terrain = scene.terrain or rectangular_room(scene)
    return scene if terrain is None else scene.replace(start=terrain.south_west)


@app.command()
@reads_files
def check(
    scene: SceneName,
    start: Start = None,
    as_json: AsJson = False,
    **options: Any,
) -> None:
    """Validate a scene; print its contents and what the import did."""
    from exactacq.output.report import console, scene_report
    from exactacq.output.report_data import scene_data, text_of

    world = _scene(scene, start, options)
    if as_json:
        sys.stdout.write(text_of(scene_data(world)))
    else:
        console().print(scene_report(world))


@app.command()
def gallery(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="A scene to describe or draw.")] = None,
    figure: FigureFile = None,
    out: Annotated[
        str | None, typer.Option(metavar="DIR", help="Explore every scene, and write DIR/NAME.svg.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List the gallery; draw one scene of it (--figure), or the runs on all of them (--out).

    The Seed Spreader runs on the scenes that are there for it.
    """
    from exactacq.files import gallery as scenes
    from exactacq.output.report import console, scene_list, scene_report
    from exactacq.output.report_data import gallery_data, scene_data, text_of

    if as_json and (figure is not None or out is not None):
        raise FormatError("--json: prints what a scene holds; leave the pictures out")
    if name is None and figure is not None:
        raise FormatError(
            "--figure: name the scene to be drawn, as in: exactacq gallery figure2 --figure F.svg"
        )
    if out is not None:
        if name is not None:
            raise FormatError("--out: draws every scene; leave the name out")
        _draw_gallery(Path(out))
    elif as_json:
        data = gallery_data(scenes.names()) if name is None else scene_data(scenes.scene(name))
        sys.stdout.write(text_of(data))
    elif name is None:
        console().print(scene_list(scenes.names()))
    elif figure is None:
        console().print(scene_report(scenes.scene(name)))
    else:
        from exactacq.output.figures import save

        save(scenes.scene(name), figure)
        print(f"figure written to {figure}")


@app.command()
@reads_files
def convert(
    source: Annotated[str, typer.Argument(metavar="IN", help="A scene, or a run that --trace wrote.")],
    target: Annotated[str, typer.Argument(metavar="OUT", help=f"A file: {', '.join(written_suffixes())}.")],
    start: Start = None,
    at: Annotated[
        str | None, typer.Option(metavar="L", help="Of a run: as it was after this length of the path.")
    ] = None,
    only: Annotated[
        str | None, typer.Option(metavar="A,B", help="Kinds of things to write, as path,links; default: all.")
    ] = None,
    **options: Any,
) -> None:
    """Write a scene or a run in another format; say how far any point moved at most."""
    from exactacq.files.whole_files import check_output
    from exactacq.output.report import console, remarks_report
    from exactacq.output.results import write
    from exactacq.output.run_json import is_run_file, load_run

    length = None if at is None else _number("--at", at)
    kinds = None if only is None else [kind.strip() for kind in only.split(",")]
    if _same_file(check_output(target, written_suffixes()), source):
        raise FormatError(f"{source}: would be overwritten by the output; choose another name")
    given = read_from_text(options)
    subject: Run | Scene
    if is_run_file(source):
        if start is not None or given:
            raise FormatError(f"{source}: a run takes no options for reading scenes; leave them out")
        subject = load_run(source)
    elif at is not None:
        raise FormatError("--at: names a moment of a run; give a run that explore --trace wrote")
    else:
        subject = _scene(source, start, options)
    remarks = _said("--at", lambda: write(subject, target, at=length, only=kinds))
    out = console()
    out.print(f"{target} written", soft_wrap=True)
    out.print(remarks_report(remarks))


@app.command()
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
    from exactacq.files.whole_files import check_output
    from exactacq.output.report import console, view_report
    from exactacq.output.results import write
    from exactacq.visibility.isovist import isovist as view_from

    range_, place = _range(radius), _pair("--at", at)
    if out is not None and _same_file(check_output(out, DRAWINGS), scene):
        raise FormatError(f"{scene}: would be overwritten by the output; choose another name")
    world = _scene(scene, at if _needs_start(scene) else None, options)
    if range_ is None and world.radius is None:
        raise FormatError(f"{scene}: the scene has no radius of vision: give one with --radius R")
    view = view_from(world, place, range_)
    remarks = () if out is None else write(view, out)
    console().print(view_report(view))
    if out is not None:
        print("; ".join((f"view written to {out}", *remarks)))


app.command()(verify)
app.command()(search)


def _draw_gallery(folder: Path) -> None:
    from exactacq.files import gallery as scenes
    from exactacq.files.whole_files import FIGURES, check_output
    from exactacq.output.figures import save

    folder.mkdir(exist_ok=True)
    for name in scenes.names():
        path = folder / f"{name}.svg"
        world = scenes.scene(name)
        strategy = Strategy.SEED_SPREADER if scenes.is_swept(name) else Strategy.SIGHTSEER
        save(_explored(world, None, strategy), check_output(path, FIGURES))
        print(f"figure written to {path}")


def _scene(name: str, start: str | None, options: dict[str, Any], terrain: str | None = None) -> Scene:
    """The scene in the file, or else of the gallery, of that name; an error names it too."""
    try:
        scene = _loaded(name, start, read_from_text(options))
        return scene if terrain is None else scene.replace(terrain=_terrain(terrain, scene))
    except InvalidScene as error:
        first, *others = error.violations
        raise InvalidScene([f"{name}: {first}", *others]) from None


def _needs_start(name: str) -> bool:
    """Whether a scene is in a file that tells no start, so that the place to look from takes its part."""
    from exactacq.files.gallery import names

    is_file = name not in names() or os.path.lexists(name)
    return is_file and Path(name).suffix.lower() != ".json"


def _said(option: str, act: Callable[[], Result]) -> Result:
    """What an action returns; a value that makes no sense is an error that names the option."""
    try:
        return act()
    except FormatError:
        raise
    except ValueError as error:
        raise FormatError(f"{option}: {error}") from None


def _loaded(name: str, start: str | None, options: dict[str, object]) -> Scene:
    from exactacq.files.gallery import names
    from exactacq.files.load import load

    place = None if start is None else _pair("--start", start)
    if place is None:
        return load(name, **options)
    if name not in names() or os.path.lexists(name):
        return load(name, start=place, **options)
    return load(name, **options).replace(start=place)


def _terrain(text: str, scene: Scene) -> Terrain:
    """The terrain of an option: its sides, with its SW corner or without, or the rectangle about a scene."""
    from exactacq.scene.bounding import terrain_around
    from exactacq.scene.shapes import Terrain

    word, _, margin = text.partition(":")
    if word == "bbox":
        return terrain_around(scene, _number("--terrain bbox", margin or "0"))
    parts = text.split(",")
    if len(parts) not in (2, 4):
        forms = "B,A or X,Y,B,A without spaces, or bbox:MARGIN"
        raise FormatError(f"--terrain: not two or four numbers: {text!r}; give {forms}")
    *corner, width, height = (_number("--terrain", part) for part in parts)
    return Terrain(width, height, corner or (0, 0))


def _explored(
    scene: Scene,
    radius: fmpq | None,
    strategy: Strategy,
    lookahead: bool = True,
    target: TargetChoice = TargetChoice.KNOWN,
) -> Run:
    """The run; with a progress bar if it is long and a terminal watches."""
    from exactacq.strategies.seed_spreader.strategy import seed_spreader
    from exactacq.strategies.sightseer.strategy import sightseer

    def run(progress: Callable[[int, int], None] | None) -> Run:
        if strategy is Strategy.SIGHTSEER:
            return sightseer(scene, radius, progress=progress)
        return seed_spreader(scene, radius, lookahead=lookahead, target=target.value, progress=progress)

    if not sys.stderr.isatty():
        return run(None)
    from exactacq.output.report import progress_bar

    with progress_bar("exploring") as bar:
        task = bar.add_task("", total=len(scene.obstacles))
        return run(lambda done, total: bar.update(task, completed=done, total=total))


def _range(radius: str | None) -> fmpq | None:
    """The radius of an option, if it is given."""
    range_ = None if radius is None else _number("--radius", radius)
    if range_ is not None and range_ <= 0:
        raise FormatError(f"--radius: must be positive, not {radius}")
    return range_


def _number(option: str, text: str) -> fmpq:
    from exactacq.numbers.rationals import rational

    try:
        return rational(text)
    except FormatError as error:
        raise FormatError(f"{option}: {error}; give a number like 10, 0.1 or 21/2") from None


def _pair(option: str, text: str) -> tuple[fmpq, fmpq]:
    parts = text.split(",")
    if len(parts) != 2:
        raise FormatError(f"{option}: not two numbers: {text!r}; give X,Y without spaces, like 0,21/2")
    return _number(option, parts[0]), _number(option, parts[1])


def _same_file(path: Path, scene: str) -> bool:
    try:
        return path.samefile(scene)
    except (OSError, ValueError):
        return False


def _one_line(error: BaseException) -> str:
    """What is wrong, on one line."""
    if isinstance(error, UsageError) and hasattr(error, "format_message"):
        text = error.format_message()
    elif isinstance(error, InvalidScene) and len(error.violations) > VIOLATIONS:
        shown = "; ".join(error.violations[:VIOLATIONS])
        text = f"{len(error.violations)} violations: {shown}; and {len(error.violations) - VIOLATIONS} more"
    elif isinstance(error, OSError) and error.strerror is not None:
        place = "" if error.filename is None else f"{error.filename}: "
        text = f"{place}{error.strerror}"
    else:
        text = str(error) or type(error).__name__
    return " ".join(text.split())


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line (default: the process's own) and return its exit status; never raises."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # Names of files and obstacles may be beyond the encoding.
            stream.reconfigure(errors="backslashreplace")
    try:
        status = app(args=arguments, prog_name="exactacq", standalone_mode=False)
        sys.stdout.flush()
    except (KeyboardInterrupt, typer.Abort):
        status = INTERRUPTED
    except (BrokenPipeError, SystemExit):  # The reader has seen enough; spare the interpreter its own flush.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return REFUSED
    except Undecided as error:
        return _refuse(_one_line(error), UNDECIDED)
    except (ExactacqError, UsageError, OSError) as error:
        return _refuse(_one_line(error), REFUSED)
    except Exception as error:
        if isinstance(error, ImportError) and error.name == "exactacq.kernel":
            return _refuse(_one_line(error), REFUSED)
        if sys.flags.dev_mode:
            raise
        fault = f"internal error, please report it ({type(error).__name__}: {_one_line(error)})"
        return _refuse(f"{fault}; python -X dev -m exactacq shows where", INTERNAL)
    if status == INTERRUPTED:  # Raised, or returned: typer's releases differ.
        return _refuse("interrupted", INTERRUPTED)
    return status if isinstance(status, int) else 0


def _refuse(line: str, status: int) -> int:
    print(f"exactacq: {line}", file=sys.stderr)
    return status
