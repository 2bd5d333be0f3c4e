"""Exploring a drawing, and what is told and saved of a run."""

from __future__ import annotations

import json
from collections.abc import Callable
from math import isfinite
from typing import Any

from exactacq.errors import FormatError, Undecided
from exactacq.files.whole_files import readable
from exactacq.numbers.rationals import rational
from exactacq.output.animation.frames import LIMIT, frames_of
from exactacq.output.animation.page import page, told
from exactacq.output.figures.draw import figure, rendered
from exactacq.output.vocabulary import Labels, Word, missed_word
from exactacq.play.scenes import Request, dumped
from exactacq.progress import Progress
from exactacq.strategies.explore import explore
from exactacq.strategies.options import Strategy
from exactacq.strategies.run import OwnRun, Run, SightseerRun
from exactacq.strategies.seed_spreader.strategy import seed_spreader

SOON, FINE = (48, 0), (LIMIT, 200)
"""Stops, and places between them, looked at before the run is first shown; then to make it smooth."""
CLOSED_FORM, DIGITS = 60, 20
"""Characters of a closed form that is shown, and digits of a length."""

Tell = Callable[[str, int, int], None]
"""Called with what is being done, how much of it is done, and how much there is to do."""


class Explored:
    """The last run of a process, from which files are made."""

    def __init__(self) -> None:
        self.run: Run | None = None

    def explore(self, request: Request, tell: Tell, show: Callable[[bytes], None]) -> None:
        """Explore a drawing; *show* gets the run as the page plays it, first coarse and then smooth.

        A run that is given up as undecided is shown up to there. Raises `InvalidScene` and `Undecided`.
        """
        self.run, trouble = None, ""
        try:
            run = _run(request, _told_as("exploring", tell)).sense(_told_as("sensing", tell))
        except Undecided as error:
            if error.run is None:
                raise
            run, trouble = error.run, str(error)
        self.run, report = run, _report(run, trouble)
        for what, (stops, fine) in (("looking around", SOON), ("looking closer", FINE)):
            frames = frames_of(run, stops, fine=fine, progress=_told_as(what, tell))
            show(dumped({"run": told(run, frames, Labels.ALL), "report": report, "whole": fine > 0}))

    def saved(self, kind: str, at: str, tell: Tell) -> bytes:
        """The run as a file: a figure (of the moment after a length, if that is given), a trace or a page."""
        run = self.run
        if run is None:
            raise FormatError("there is no run to be saved; run again")
        if kind == "trace":
            return (json.dumps(run.to_json(), indent=1, ensure_ascii=False) + "\n").encode()
        if kind == "page":
            return page(run, frames_of(run, progress=_told_as("looking around", tell))).encode()
        try:
            moment = run.near(rational(at)) if at else None
        except ValueError as error:
            raise FormatError(str(error)) from None
        return rendered(lambda: figure(run, moment, progress=_told_as("drawing", tell)), ".svg")


def _told_as(what: str, tell: Tell) -> Progress:
    return lambda done, count: tell(what, done, count)


def _run(request: Request, progress: Progress) -> Run:
    scene = request.scene()
    if request.strategy is Strategy.SEED_SPREADER:
        return seed_spreader(
            scene, lookahead=request.lookahead, target=request.target.value, progress=progress
        )
    return explore(scene, request.strategy, progress=progress)


def _report(run: Run, trouble: str) -> dict[str, Any]:
    """What the page says of a run as a whole: its exact length, the bounds, what it did and missed."""
    bounds = [
        {
            **row,
            "value": f"{row['value']:.8g}",
            "ratio": f"{bound.ratio:.3f}" if isfinite(bound.ratio) else "",
        }
        for row, bound in zip(run.bound_table, run.bounds, strict=True)
    ]
    names, is_visiting = list(run.names()), isinstance(run, SightseerRun)
    done = run.visits if is_visiting else run.map.acquired
    missed = {
        Word.UNSEEN: [names[k] for k in run.unseen],
        missed_word(not is_visiting): [names[k] for k in run.unvisited],
    }
    return {
        "title": run.title,
        "length": list(readable(run.length, CLOSED_FORM, DIGITS)),
        "bounds": bounds,
        "is_own": isinstance(run, OwnRun),
        "missed": {word: some for word, some in missed.items() if some},
        "done": [Word.VISITED if is_visiting else Word.ACQUIRED, len(done), len(run.obstacles)],
        "trouble": trouble,
    }
