"""Parts of figures drawn large, where what a scene is about is small beside the whole of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import matplotlib.pyplot as plt

from exactacq.output.figures import draw as figures
from exactacq.strategies.run import Run

WIDE = 7.2
"""Inches: as wide as the figure of a whole run."""
BESIDE = 0.06
"""How far left of the narrowest obstacles their numbers stand, in the unit of the scene."""


class CutOut(NamedTuple):
    """A window of a scene's figure, west and east, south and north, and what is to be seen in it."""

    across: tuple[float, float]
    up: tuple[float, float]
    words: str


CUT_OUTS = {
    "m9": CutOut(
        (-0.25, 1.35),
        (4.4, 5.55),
        "The ten crumbs in their slots, in the order of their visits. Each is seen from the far wall only, "
        "which is 99 units to the right: the robot goes there and comes back for every one of them.",
    )
}
"""The gallery scenes whose figure has such a part."""


def draw(run: Run, part: CutOut, path: Path) -> None:
    """Write that part of the run's figure, with the order of visits beside the obstacles that lie in it."""
    drawn = figures.figure(run)
    axes = drawn.axes[0]
    for other in (*drawn.axes[1:], *drawn.texts, *drawn.legends):
        other.remove()
    for text in axes.texts:
        text.set_visible(False)
    axes.set_xlim(*part.across)
    axes.set_ylim(*part.up)
    high = WIDE * (part.up[1] - part.up[0]) / (part.across[1] - part.across[0])
    drawn.set_size_inches(WIDE + 0.6, high + 0.4)
    axes.set_position((0.5 / (WIDE + 0.6), 0.3 / (high + 0.4), WIDE / (WIDE + 0.6), high / (high + 0.4)))
    for order, (x, y) in in_window(run, part):
        axes.text(x - BESIDE, y, str(order), ha="center", va="center", size=10, weight="bold", zorder=6)
    drawn.savefig(path)
    plt.close(drawn)


def in_window(run: Run, part: CutOut) -> Iterator[tuple[int, tuple[float, float]]]:
    """The places of obstacles that lie in the window, each with its number in the order of visits."""
    for order, index in enumerate(run.visits, 1):
        places = [edge.start.xy for edge in run.obstacles[index].edges]
        if all(part.across[0] < x < part.across[1] and part.up[0] < y < part.up[1] for x, y in places):
            yield order, places[0]
