"""Figures of scenes and runs, as matplotlib figures and as files."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from matplotlib import style
from matplotlib.figure import Figure

from exactacq.files.whole_files import FIGURES, check_output, write_whole
from exactacq.numbers.length import Length
from exactacq.output.figures.canvas import Canvas, show_alike, steps
from exactacq.output.figures.layout import in_axes, inches, on_page
from exactacq.output.figures.way_figure import way_figure
from exactacq.output.vocabulary import Labels
from exactacq.progress import Meter, Progress
from exactacq.scene.scene import Scene, as_scene
from exactacq.sensing.event import Event
from exactacq.strategies.run import Run
from exactacq.visibility.shortest_path import ShortestPath

DOTS = 200
"""Resolution of PNG files in dots per inch."""


def figure(
    subject: Run | Scene | ShortestPath,
    at: Event | Length | object = None,
    *,
    labels: Labels | str = Labels.ALL,
    ax: Any = None,
    progress: Progress | None = None,
) -> Figure:
    """A matplotlib figure of a run, or of a scene alone with the names of its obstacles.

    A run's figure shows the obstacles' names, the order of visits (#1, #2, ...), the path coloured by its
    length so far, hit and leave points, links, start S, end T and the radius of vision R; of the Seed
    Spreader also the M-line, its crossing points and the diversions from D to Q. With *at*, an event or a
    length of the path, it shows that moment: the path so far, the view (shaded), known boundary (strong),
    unknown boundary (dotted), and the frontier between them. A `ShortestPath` is shown in its scene,
    from A to B, and takes no other argument.

    *labels* are "all", "names", "numbers" (of visits) or "none". Those that do not fit into their obstacle
    stand beside it, or farther away with a leader line; none covers another one, and the legend says how many
    were left out. With *ax*, axes of matplotlib, the drawing goes there, fitted to their size at the time,
    with its title and legend, and without the bar of colours. *progress* is told how many of how many steps
    are done.

    ValueError for a length without an algebraic place (see `Run.near`); `FormatError` for other *labels* or
    subjects, and for a scene that is 10^-9 times its distance from the origin or less.

    >>> import exactacq as xa
    >>> [text.get_text() for text in figure(xa.sightseer(xa.load("circles"))).axes[0].texts]
    ['O1', '#1', 'O2', '#2', 'S', 'T']
    """
    if isinstance(subject, ShortestPath):
        return way_figure(subject)
    if not isinstance(subject, Run):
        as_scene(subject)
    choice, meter = Labels(labels), Meter(progress, steps(subject))
    if ax is None:
        return on_page([Canvas(subject, at, meter)], choice)
    in_axes(Canvas(subject, at, meter, inches(ax)), ax, choice)
    drawn: Figure = ax.get_figure()
    return drawn


def side_by_side(
    runs: Sequence[Run], *, labels: Labels | str = Labels.ALL, progress: Progress | None = None
) -> Figure:
    """The figures of runs on one scene side by side, to one scale; more than three in rows."""
    choice, meter = Labels(labels), Meter(progress, sum(map(steps, runs)))
    drawings = [Canvas(run, None, meter) for run in runs]
    show_alike(drawings)
    return on_page(drawings, choice)


def svg(subject: Run | Scene | ShortestPath) -> str:
    """The figure as SVG text; the same subject always gives the same text."""
    return rendered(lambda: figure(subject), ".svg").decode()


def save(
    subject: Run | Scene | ShortestPath,
    path: str | os.PathLike[str],
    at: Event | Length | object = None,
    *,
    labels: Labels | str = Labels.ALL,
    progress: Progress | None = None,
) -> None:
    """Write the figure to a .svg, .pdf or .png file, whole or not at all; arguments as for `figure`.

    Raises `FormatError` for another suffix or a place that cannot be written, before anything is drawn.
    """
    target = check_output(path, FIGURES)
    draw = partial(figure, subject, at, labels=Labels(labels), progress=progress)
    write_whole(target, rendered(draw, target.suffix.lower()))


def save_side_by_side(
    runs: Sequence[Run],
    path: str | os.PathLike[str],
    *,
    labels: Labels | str = Labels.ALL,
    progress: Progress | None = None,
) -> None:
    """Write the figures of runs side by side to one file, with the suffixes and errors of `save`."""
    target = check_output(path, FIGURES)
    draw = partial(side_by_side, runs, labels=Labels(labels), progress=progress)
    write_whole(target, rendered(draw, target.suffix.lower()))


def png(subject: Run | Scene, at: Event | Length | object, labels: Labels, dots: int) -> bytes:
    """The figure as a PNG of so many dots per inch; arguments as for `figure`."""
    return rendered(lambda: figure(subject, at, labels=labels), ".png", dots)


def rendered(draw: Callable[[], Figure], suffix: str, dots: int = DOTS) -> bytes:
    """A figure as a file's content, without dates, random names or the user's own settings of matplotlib:
    equal subjects give equal bytes."""
    maker: dict[str, str | None] = {"Creator": "exactacq"}
    metadata = {
        ".svg": {**maker, "Date": None},
        ".pdf": {**maker, "Producer": None, "CreationDate": None},
        ".png": {"Software": "exactacq"},
    }
    out = io.BytesIO()
    with style.context(["default", {"svg.hashsalt": "exactacq", "hatch.linewidth": 0.5}]):
        draw().savefig(out, format=suffix[1:], metadata=metadata[suffix], dpi=dots)
    return out.getvalue()
