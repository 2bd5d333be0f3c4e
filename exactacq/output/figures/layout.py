"""Drawings on a page with titles, colour bars and legends, or in axes that a user has.

A page is laid out in inches so that nothing covers the drawing, whatever its shape.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.legend_handler import HandlerTuple

from exactacq.errors import without_controls
from exactacq.files.whole_files import readable
from exactacq.output.figures.canvas import Canvas
from exactacq.output.figures.labels import fitted, width
from exactacq.output.figures.lettering import Lettering
from exactacq.output.vocabulary import INK, LINE, MISSED, SOFT, Labels, Word, missed_word
from exactacq.strategies.run import SeedSpreaderRun, SightseerRun

CLOSED_FORM = 40
"""Closed forms of at most this many characters are shown in the title, the decimal value of others."""
LOST = 1e-30
"""Matplotlib takes shorter sides for so long when it makes the scales of two axes equal."""
SHORT = 10
"""So many where a line with longer closed forms would be wider than the page."""
TITLE, BELOW = 12.0, 9.5
"""Sizes of a title and of the lines below it, in points."""
PLAIN = (-7, 9)
"""Powers of ten at which the numbers at ticks begin to have their power beside the axis."""
LEGEND: dict[str, Any] = {
    "frameon": False, "labelcolor": INK, "borderpad": 0, "borderaxespad": 0, "handlelength": 1.8,
    "columnspacing": 1.5, "labelspacing": 0.4, "handler_map": {tuple: HandlerTuple(ndivide=1)},
}  # fmt: skip


def on_page(drawings: Sequence[Canvas], labels: Labels) -> Figure:
    """Drawings side by side on a page of their size, those of a row on one level."""
    page = Figure()
    FigureCanvasAgg(page)
    settings = []
    for drawing in drawings:
        drawing.draw(page.add_axes((0, 0, 1, 1)))
        Lettering(drawing, labels).draw()
        settings.append(_Setting(drawing))
    most = _in_a_row(len(settings))
    rows = [_Shelf(settings[k : k + most]) for k in range(0, len(settings), most)]
    page.set_size_inches(max(row.wide for row in rows), sum(row.high for row in rows))
    bottom = sum(row.high for row in rows)
    for row in rows:
        bottom -= row.high
        row.lay_out(page, bottom)
    drawings[-1].meter.close()
    return page


def in_axes(drawing: Canvas, axes: Any, labels: Labels) -> None:
    """A drawing in axes that are there, with a title above and the legend below."""
    drawing.draw(axes)
    Lettering(drawing, labels).draw()
    if min(drawing.width, drawing.height) > LOST:
        axes.set_aspect("equal", adjustable="box")
    else:
        axes.set_box_aspect(drawing.height / drawing.width)
    dress(axes)
    axes.set_title("\n".join(title(drawing)), size=9, color=INK, parse_math=False)
    if drawing.legend:
        axes.legend(
            drawing.legend.values(), drawing.legend.keys(), loc="upper center", fontsize=7.5,
            bbox_to_anchor=(0.5, -0.1), ncol=3, **LEGEND,
        )  # fmt: skip
    drawing.meter.close()


def inches(axes: Any) -> tuple[float, float]:
    """Width and height of axes as they are now."""
    box, dots = axes.get_window_extent(), axes.figure.dpi
    return float(box.width) / dots, float(box.height) / dots


def dress(axes: Any) -> None:
    """Light spines and small ticks."""
    for side in axes.spines.values():
        side.set(color=LINE, linewidth=0.6)
    axes.tick_params(labelsize=7.5, colors=SOFT, length=2.5, width=0.6)


def tick(axes: Any) -> None:
    """A few ticks a side, with numbers that are read at a glance and fit beside the drawing."""
    axes.ticklabel_format(useOffset=False, style="sci", scilimits=PLAIN)
    axes.locator_params(nbins=6, min_n_ticks=2)


def title(drawing: Canvas, limit: int = CLOSED_FORM) -> list[str]:
    """What is drawn, how far the robot came, and what was missed; closed forms have *limit* characters."""
    run, name = drawing.run, without_controls(drawing.scene.name or "")
    if run is None:
        count = sum(not o.is_enclosure for o in drawing.scene.obstacles)
        room = " in an enclosure" if drawing.scene.enclosure is not None else ""
        return [name or "Scene", f"{_counted(count)}{room}"]
    first = f"{run.title}: {name}" if name else run.title
    length = " ".join(readable(run.length, limit, digits=8))
    if drawing.moment is not None:
        so_far = " ".join(readable(drawing.moment.at, limit, digits=8))
        seen = f"{len(drawing.moment.map.acquired)} of {_counted(drawing.count)} {Word.ACQUIRED}"
        return [first, f"after {so_far} of {length},  {seen}"]
    mapped = not isinstance(run, SightseerRun)
    done = (len(run.map.acquired), Word.ACQUIRED) if mapped else (len(run.visits), Word.VISITED)
    missed = [(len(run.unseen), Word.UNSEEN), (len(run.unvisited), missed_word(mapped))]
    if isinstance(run, SeedSpreaderRun):
        missed.append((len(run.unreached), Word.UNREACHABLE))
    words = [f"{number} {what}" for number, what in missed if number]
    words += ["ended before T"] if drawing.sweep is not None and not drawing.sweep.arrives else []
    achieved = f"{done[0]} of {_counted(drawing.count)} {done[1]}"
    lines = [first, f"{Word.LENGTH} {length},  {achieved}", ", ".join(words)]
    return [line for line in lines if line]


def _counted(count: int) -> str:
    return f"{count} {Word.OBSTACLE}" + "s" * (count != 1)


class _Setting:
    """What stands around a finished drawing; lengths in inches."""

    def __init__(self, drawing: Canvas) -> None:
        self.drawing = drawing
        self.wide, self.high = drawing.width * drawing.scale, drawing.height * drawing.scale
        first, *others = title(drawing)
        if any(width(line, "normal") * BELOW > 72 * self.full for line in others):
            others = title(drawing, SHORT)[1:]
        self.title = [fitted(first, TITLE, 72 * (self.full - 0.4)), *others]

    @property
    def full(self) -> float:
        """Width of all that is drawn."""
        return max(self.wide + 1.1, 6.2)

    @property
    def columns(self) -> int:
        """Most entries of the legend in a row."""
        return max(1, int((self.full - 0.4) / 1.62))

    @property
    def foot(self) -> float:
        """Height of the legend and the colour bar."""
        rows = math.ceil(len(self.drawing.legend) / self.columns)
        return 0.12 + 0.19 * rows + (0.58 if self.drawing.colours is not None else 0.0)

    @property
    def below(self) -> float:
        """Height of what is below the axes."""
        return self.foot + 0.3

    @property
    def above(self) -> float:
        """Height of what is above the axes."""
        return 0.22 + 0.24 * len(self.title)

    def lay_out(self, page: Figure, x: float, y: float) -> None:
        """Place axes, title, colour bar and legend with their lower left corner at (x, y)."""
        axes, legend = self.drawing.axes, self.drawing.legend
        full, total = (float(side) for side in page.get_size_inches())
        left = x + (self.full - self.wide) / 2 + (0.12 if self.wide + 1.1 >= self.full else 0)
        bottom = y + self.below
        axes.set_position((left / full, bottom / total, self.wide / full, self.high / total))
        dress(axes)
        tick(axes)
        middle, top = (x + self.full / 2) / full, 1 - (total - (bottom + self.high + self.above)) / total
        for k, line in enumerate(self.title):
            size, colour = ((TITLE, INK), (BELOW, SOFT), (BELOW, MISSED))[k]
            place = top - (0.24 + 0.24 * k) / total
            page.text(
                middle, place, line, ha="center", va="center", size=size, color=colour, parse_math=False
            )
        self._colour_bar(page, x, y)
        if legend:
            page.legend(
                legend.values(), legend.keys(), loc="lower center", fontsize=8,
                bbox_to_anchor=(middle, (y + 0.06) / total), ncol=min(self.columns, len(legend)), **LEGEND,
            )  # fmt: skip

    def _colour_bar(self, page: Figure, x: float, y: float) -> None:
        if self.drawing.colours is None:
            return
        full, total = (float(side) for side in page.get_size_inches())
        length = min(self.full - 1.2, 5.0)
        corner = x + (self.full - length) / 2, y + self.foot - 0.12
        spot = (corner[0] / full, corner[1] / total, length / full, 0.09 / total)
        bar = page.colorbar(self.drawing.colours, cax=page.add_axes(spot), orientation="horizontal")
        if self.drawing.run is not None and float(self.drawing.run.length) < self.drawing.longest:
            bar.ax.axvline(float(self.drawing.run.length), color=INK, linewidth=1.6)
        bar.set_label(f"{Word.PATH}, by {Word.LENGTH}", size=8, color=SOFT, labelpad=1)
        bar.ax.tick_params(labelsize=7.5, colors=SOFT, length=2, width=0.6)
        bar.outline.set_visible(False)
        if bar.solids is not None:  # Curves and text apart, the bar should be sharp at any zoom, too.
            bar.solids.set_rasterized(False)


def _in_a_row(count: int) -> int:
    """How many of some drawings stand side by side: all of three, else as many as there are rows."""
    return count if count <= 3 else math.ceil(math.sqrt(count))


class _Shelf:
    """Finished drawings side by side, their axes on one level; lengths in inches."""

    def __init__(self, settings: Sequence[_Setting]) -> None:
        self.settings = settings
        self.below = max(setting.below for setting in settings)
        self.wide = sum(setting.full for setting in settings)
        self.high = self.below + max(setting.high + setting.above for setting in settings)

    def lay_out(self, page: Figure, y: float) -> None:
        """Place the drawings with what stands around them, the lower edge at y."""
        x = 0.0
        for setting in self.settings:
            setting.lay_out(page, x, y + self.below - setting.below)
            x += setting.full
