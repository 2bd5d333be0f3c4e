"""The runs that commands make."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from exactacq.cli.own_strategies import NamedStrategy, blaming
from exactacq.strategies.options import MOST_MOVES, Strategy, TargetChoice

if TYPE_CHECKING:
    from flint import fmpq

    from exactacq.progress import Progress
    from exactacq.scene.scene import Scene
    from exactacq.strategies.run import Run


def explored(
    scene: Scene,
    radius: fmpq | None,
    strategy: NamedStrategy,
    lookahead: bool = True,
    target: TargetChoice = TargetChoice.KNOWN,
    max_moves: int = MOST_MOVES,
) -> Run:
    """The run; with a progress bar if it is long and a terminal watches.

    What a strategy of the user's own does wrong is told with its file and line.
    """
    from exactacq.strategies.explore import explore
    from exactacq.strategies.seed_spreader.strategy import seed_spreader
    from exactacq.strategies.sightseer.strategy import sightseer

    def run(progress: Progress | None) -> Run:
        if strategy.strategy is Strategy.SIGHTSEER:
            return sightseer(scene, radius, progress=progress)
        if strategy.strategy is Strategy.SEED_SPREADER:
            return seed_spreader(scene, radius, lookahead=lookahead, target=target.value, progress=progress)
        with blaming(strategy.file):
            return explore(scene, strategy.strategy, radius, max_moves=max_moves, progress=progress)

    with watched("exploring") as progress:
        found = run(progress)
    with watched("sensing") as progress:
        return found.sense(progress)


@contextmanager
def watched(what: str) -> Iterator[Progress | None]:
    """What to tell how far something is: a bar if a terminal watches, else nothing."""
    if not sys.stderr.isatty():
        yield None
        return
    from exactacq.output.report import progress_bar

    with progress_bar(what) as bar:
        task = bar.add_task("", total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
