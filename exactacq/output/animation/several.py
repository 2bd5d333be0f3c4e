"""One page that plays several runs of a scene side by side, on one clock: all have gone equally far."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from exactacq.output.animation.frames import Frame
from exactacq.output.animation.page import Paper, told, whole_page
from exactacq.output.figures.sweep import turning_places
from exactacq.output.vocabulary import Labels
from exactacq.strategies.run import Run


def page_of_runs(
    runs: Sequence[Run], frames: Iterable[Iterable[Frame]], *, labels: Labels | str = Labels.ALL
) -> str:
    """The page of several runs as HTML text; equal runs and frames give the same text.

    *frames* are those of each run (see `exactacq.output.animation.frames.frames_of`), consumed one by one.
    All runs are drawn to one scale, and a colour means the same length of each path. Raises what
    `exactacq.output.animation.page.page` does, and ValueError if there are no runs.

    >>> import exactacq as xa
    >>> from exactacq.output.animation.frames import frames_of
    >>> runs = [xa.sightseer(xa.load("circles"), radius) for radius in (5, 20)]
    >>> page_of_runs(runs, map(frames_of, runs))[:15]
    '<!doctype html>'
    """
    if not runs:
        raise ValueError("a page of runs has at least one")
    first = runs[0]
    radius = max(float(run.radius) for run in runs)
    swept = all(run.ground is not None for run in runs)
    places = [place for run in runs for place in (run.start, *turning_places(run))]
    paper = Paper.of(first.scene, first.start, radius, swept, places)
    shown = [
        _named(run, told(run, own, Labels(labels), paper)) for run, own in zip(runs, frames, strict=True)
    ]
    name = f": {first.scene.name}" if first.scene.name else ""
    return whole_page("several", {"title": f"{len(runs)} runs{name}", "runs": shown})


def _named(run: Run, data: dict[str, Any]) -> dict[str, Any]:
    return {**data, "strategy": run.title}
