"""The figure of a drawing as it was read, legal or not, with what is wrong marked where it is."""

from __future__ import annotations

import os
from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle as Disc
from matplotlib.path import Path as Outline

from exactacq.errors import FormatError, without_controls
from exactacq.files.checking.inspection import Inspection
from exactacq.files.checking.lines import walked
from exactacq.files.checking.sketch import Sketch, places_of, points_of, strokes_of
from exactacq.files.loops.chains import bend_of
from exactacq.files.whole_files import FIGURES, check_output, write_whole
from exactacq.geometry.intersections import ContactKind
from exactacq.geometry.points import Point
from exactacq.geometry.strokes import Floats
from exactacq.numbers.rationals import nearest_float
from exactacq.output.figures.canvas import NARROWEST, TALLEST, WIDEST
from exactacq.output.figures.draw import rendered
from exactacq.output.figures.labels import fitted
from exactacq.output.figures.layout import dress, tick
from exactacq.output.figures.lettering import radius_text
from exactacq.output.figures.sweep import check_size
from exactacq.output.regions import closed
from exactacq.output.vocabulary import AWAY, EDGE, FILL, GROUND, HIT, INK, MISSED, PAPER, SOFT, VIEW
from exactacq.scene.scene import Obstacle
from exactacq.scene.shapes import edge

OPEN, GAP = MISSED, AWAY
MARKS = {
    ContactKind.CROSSING: ("crossing", "X", HIT, PAPER),
    ContactKind.TOUCHING: ("touch", "o", PAPER, HIT),
    ContactKind.OVERLAP: ("ends of an overlap", "D", PAPER, HIT),
    None: ("other violation", "P", HIT, PAPER),
}
"""What marks violations: name, shape, colour and edge."""
MANY = 60
"""Among more violations than this, their marks are smaller."""
MARGIN = 0.06
"""Room around everything, as a part of its size."""
CROWD = 60
"""Among more loops than this, only those that break a rule are labelled; of these so many at most."""
SIDES = 1.1
"""Inches beside the drawing, for its scales."""


def save_inspection(found: Inspection, path: str | os.PathLike[str]) -> None:
    """Write the figure to a .svg, .pdf or .png file, whole or not at all; `FormatError` as `drawing`."""
    target = check_output(path, FIGURES)
    write_whole(target, rendered(lambda: drawing(found), target.suffix.lower()))


def drawing(found: Inspection) -> Figure:
    """A matplotlib figure of an inspection: all loops, violations, open chains and their gaps, the start.

    `FormatError` if there is nothing of a size that can be drawn, or if all is too small where it lies.
    """
    sketch = Sketch([loop.obstacle.shape for loop in found.loops])
    chains = [_points_of(path) for path in found.contents.open_chains]
    every = [*([sketch.starts] if len(sketch.starts) else []), *(row for row in chains if len(row))]
    if not every:
        raise FormatError(f"{found.name}: there is nothing to be drawn")
    page = _Page(found, np.concatenate(every))
    page.loops()
    page.chains(chains)
    page.violations()
    page.beginning()
    page.labels(sketch)
    return page.finished()


def _points_of(path: Any) -> Floats:
    """The points along an open chain."""
    corners = walked(path)
    edges = [edge(Point(a.x, a.y), Point(b.x, b.y), bend_of(a, b)) for a, b in pairwise(corners)]
    rows = points_of(edges)
    return np.concatenate(rows) if rows else np.zeros((0, 2))


def _outlines(obstacles: Iterable[Obstacle]) -> list[Outline]:
    """The outlines of those obstacles that can be drawn."""
    return [closed(strokes) for obstacle in obstacles if (strokes := strokes_of(obstacle.edges))]


class _Page:
    """One figure in the making: axes in the unit of the drawing, which has inches enough around."""

    def __init__(self, found: Inspection, points: Floats) -> None:
        self.found, self.legend = found, dict[str, Any]()
        low, high = points.min(axis=0), points.max(axis=0)
        if found.start is not None:
            start = np.array([nearest_float(c) for c in found.start])
            low, high = np.minimum(low, start), np.maximum(high, start)
        size = float(max(high - low)) or 1.0
        least = size * NARROWEST / WIDEST
        lack = np.maximum(least - (high - low), 0) / 2 + MARGIN * size
        self.low, self.high = low - lack, high + lack
        check_size(self.low, self.high)
        self.scale = float(min(np.array([WIDEST, TALLEST]) / (self.high - self.low)))
        self.figure = Figure()
        FigureCanvasAgg(self.figure)
        self.axes = self.figure.add_axes((0, 0, 1, 1))
        self.axes.set_xlim(self.low[0], self.high[0])
        self.axes.set_ylim(self.low[1], self.high[1])
        self.axes.set_facecolor(GROUND)

    def loops(self) -> None:
        """All loops, and filled what is in the robot's way in the proposed scene.

        Without a scene, where an odd number of loops is around, as far as it can be told.
        """
        outlines = _outlines(loop.obstacle for loop in self.found.loops)
        if not outlines:
            return
        scene = self.found.scene
        filled = outlines if scene is None else _outlines(scene.obstacles)
        if scene is not None and scene.enclosure is not None:
            (x0, y0), (x1, y1) = self.low, self.high
            filled.append(Outline([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], closed=True))
        for some, look in (
            (filled, {"facecolors": FILL, "edgecolors": "none"}),
            (outlines, {"facecolors": "none", "edgecolors": EDGE, "linewidths": 0.8}),
        ):
            if some:
                page = Outline.make_compound_path(*some)
                self.axes.add_collection(PathCollection([page], **look, zorder=1), autolim=False)
        wrong = {k for flaw in self.found.violations for k in flaw.loops}
        marked = [strokes_of(self.found.loops[k].obstacle.edges) for k in sorted(wrong)]
        if bad := [closed(strokes) for strokes in marked if strokes]:
            style: dict[str, Any] = {"facecolors": "none", "edgecolors": HIT, "linewidths": 1.1}
            self.axes.add_collection(PathCollection(bad, zorder=2, **style), autolim=False)
            self.legend["loop that breaks a rule"] = Line2D([], [], color=HIT, linewidth=1.1)

    def chains(self, chains: list[Floats]) -> None:
        """Open chains, their ends, and the gaps between ends that are nearest to each other."""
        found = self.found.open_chains
        shown = [row for row in chains if len(row)]
        if shown:
            self.axes.add_collection(
                LineCollection(shown, colors=OPEN, linewidths=1.2, zorder=2.1), autolim=False
            )
            self.legend["open chain"] = Line2D([], [], color=OPEN, linewidth=1.2)
        gaps = [pair for c in found if c.across is not None and len(pair := places_of(c.across)) == 2]
        if gaps:
            style: dict[str, Any] = {"linewidths": 1.4, "linestyles": [(0, (1.2, 1.2))]}
            self.axes.add_collection(LineCollection(gaps, colors=GAP, zorder=2.2, **style), autolim=False)
            self.legend["gap"] = Line2D([], [], color=GAP, linewidth=1.4, linestyle=(0, (1.2, 1.2)))
        ends = [place for chain in found for place in places_of(chain.ends)]
        self._marks("open end", ends, "s", ms=3.4, mfc=PAPER, mec=OPEN, mew=0.9)

    def violations(self) -> None:
        """A mark at each place of a violation, by how edges meet there."""
        size = 8 if len(self.found.violations) <= MANY else 5
        for kind, (name, marker, colour, border) in MARKS.items():
            flaws = [flaw for flaw in self.found.violations if flaw.kind is kind]
            spots = [place.xy for flaw in flaws for place in flaw.places]
            self._marks(name, spots, marker, ms=size, mec=border, mew=0.9, mfc=colour)

    def beginning(self) -> None:
        """The start, and the circle of the radius of vision around it."""
        if self.found.start is None or self.found.radius is None:
            return
        x, y = map(nearest_float, self.found.start)
        radius = nearest_float(self.found.radius)
        dashes: dict[str, Any] = {"linestyle": (0, (5, 4)), "color": VIEW, "linewidth": 0.8}
        self.axes.add_patch(Disc((x, y), radius, fill=False, zorder=0.8, **dashes))
        self.axes.add_patch(Disc((x, y), radius, color=VIEW, alpha=0.045, linewidth=0, zorder=0.5))
        self.legend[radius_text(self.found.radius)] = Line2D([], [], **dashes)
        self._marks("start S", [(x, y)], "s", ms=6, mfc=INK, mec=PAPER, mew=0.6)

    def labels(self, sketch: Sketch) -> None:
        """The numbers of loops, in their middle; in a crowd those that break a rule only.

        Loops with others within come last: their middle may be in one of these.
        """
        wrong = {k for flaw in self.found.violations for k in flaw.loops}
        named = range(len(self.found.loops)) if len(self.found.loops) <= CROWD else sorted(wrong)[:CROWD]
        named = sorted(named, key=lambda k: self.found.loops[k].holds)
        start = self.found.start
        taken = [] if start is None else [(nearest_float(start[0]), nearest_float(start[1]))]
        reach = 0.16 / self.scale
        for k in named:
            row = sketch.lines[k]
            if not len(row):
                continue
            x, y = ((row.min(axis=0) + row.max(axis=0)) / 2).tolist()
            if all(np.hypot(x - u, y - v) > reach for u, v in taken):
                taken.append((x, y))
                self.axes.text(
                    x, y, self.found.loops[k].label, size=7, color=INK, ha="center",
                    va="center_baseline", parse_math=False, clip_on=True, zorder=5,
                )  # fmt: skip

    def finished(self) -> Figure:
        """The page with its title and legend, laid out in inches."""
        wide, high = ((self.high - self.low) * self.scale).tolist()
        full = max(wide + SIDES, 6.2)
        columns = max(1, int((full - 0.4) / 2.0))
        below = 0.42 + 0.19 * -(-len(self.legend) // columns)
        total = below + high + 0.75
        self.figure.set_size_inches(full, total)
        left = (full - wide) / 2 + 0.12
        self.axes.set_position((left / full, below / total, wide / full, high / total))
        dress(self.axes)
        tick(self.axes)
        title = without_controls(self.found.contents.name or self.found.name)
        lines = ((title, 12, INK), (self.found.trouble or "OK", 9.5, OPEN if self.found.trouble else SOFT))
        for k, (line, size, colour) in enumerate(lines):
            place = 1 - (0.24 + 0.24 * k) / total
            look: dict[str, Any] = {"size": size, "color": colour, "parse_math": False}
            shown = fitted(line, size, 72 * (full - 0.4))
            self.figure.text(0.5, place, shown, ha="center", va="center", **look)
        if self.legend:
            self.figure.legend(
                self.legend.values(), self.legend.keys(), loc="lower center",
                bbox_to_anchor=(0.5, 0.06 / total),
                ncol=min(columns, len(self.legend)), frameon=False, fontsize=8, labelcolor=INK, borderpad=0,
                borderaxespad=0, handlelength=1.8, columnspacing=1.5, labelspacing=0.4,
            )  # fmt: skip
        return self.figure

    def _marks(self, name: str, spots: list[Any], marker: str, **style: Any) -> None:
        if spots:
            x, y = np.array(spots, dtype=float).T
            self.axes.plot(x, y, linestyle="", marker=marker, zorder=4, **style)
            self.legend[name] = Line2D([], [], linestyle="", marker=marker, **style)
