"""The figure of a shortest path: the obstacles, the path, its ends, and the points where its pieces meet."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path as Outline

from exactacq.files.whole_files import readable
from exactacq.output.figures.canvas import NARROWEST, STYLES, TALLEST, WIDEST
from exactacq.output.figures.layout import CLOSED_FORM, dress
from exactacq.output.figures.sweep import window
from exactacq.output.regions import Region, part
from exactacq.output.vocabulary import FILL, GROUND, INK, PAPER, SOFT, VIEW, Word
from exactacq.visibility.shortest_path import ShortestPath

MARGIN = 0.06
"""Room around everything, as a part of its size."""
ABOVE, BESIDE = 0.5, 0.6
"""Inches above the drawing for its title, and beside and below it for its scales."""


def way_figure(found: ShortestPath) -> Figure:
    """A matplotlib figure of a shortest path in its scene, or on its map.

    `FormatError` for a scene that is 10^-9 times its distance from the origin or less.
    """
    regions = [Region.of(obstacle) for obstacle in found.scene.obstacles]
    strokes = [piece.stroke() for piece in found.path]
    spots = [np.array(point.xy) for point in found.points]
    spots += [row for stroke in strokes for row in stroke.points()]
    spots += [row for wall in found.walls for row in wall.stroke().points()]
    low, high = window(found.scene, [*(c for r in regions for c in r.box), *spots], 1.0, False)
    size = float(np.max(high - low))
    lack = np.maximum(size * NARROWEST / WIDEST - (high - low), 0) / 2 + MARGIN * size
    low, high = low - lack, high + lack
    wide, tall = (high - low) * float(min(np.array([WIDEST, TALLEST]) / (high - low)))
    page = Figure(figsize=(wide + 2 * BESIDE, tall + ABOVE + BESIDE))
    FigureCanvasAgg(page)
    full, above = wide + 2 * BESIDE, tall + ABOVE + BESIDE
    axes = page.add_axes((BESIDE / full, BESIDE / above, wide / full, tall / above))
    draw_path(axes, found, regions, (low, high))
    for name, (x, y) in (("A", found.start.xy), ("B", found.end.xy)):
        look: dict[str, Any] = {"textcoords": "offset points", "size": 9, "weight": "bold"}
        axes.annotate(name, (x, y), (0, 6), ha="center", zorder=6, **look)
    return page


def draw_path(axes: Any, found: ShortestPath, regions: list[Region], view: tuple[Any, Any]) -> None:
    """Draw a shortest path in axes that show a rectangle of the scene and have the ratio of its sides."""
    (x0, y0), (x1, y1) = view
    axes.set_xlim(x0, x1)
    axes.set_ylim(y0, y1)
    axes.set_facecolor(GROUND)
    for obstacle, region in zip(found.scene.obstacles, regions, strict=True):
        outline = region.outline
        if obstacle.is_enclosure:
            frame = Outline([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], closed=True)
            outline = Outline.make_compound_path(frame, outline)
        axes.add_patch(PathPatch(outline, zorder=1, joinstyle="round", **STYLES[Word.OBSTACLE]))
    for wall in found.walls:
        look = {"fill": False, "edgecolor": INK, "linewidth": 1.6, "capstyle": "round", "zorder": 2}
        axes.add_patch(PathPatch(part(wall.stroke(), 0.0, 1.0), **look))
    terrain = found.scene.terrain
    if terrain is not None:
        sides = float(terrain.width), float(terrain.height)
        border: dict[str, Any] = {"fill": False, "edgecolor": SOFT, "linewidth": 0.8, "zorder": 0.6}
        axes.add_patch(Rectangle(terrain.south_west.xy, *sides, **border))
    for piece in found.path:
        line = part(piece.stroke(), 0.0, 1.0)
        look = {"fill": False, "edgecolor": VIEW, "linewidth": 2.2, "capstyle": "round", "zorder": 3}
        axes.add_patch(PathPatch(line, **look))
    spots = [point.xy for point in found.points]
    axes.plot(*zip(*spots, strict=True), "o", ms=3.4, mfc=FILL, mec=INK, mew=0.7, zorder=4)
    axes.plot(*found.start.xy, "s", ms=6, mfc=INK, mec=PAPER, mew=0.6, zorder=5)
    axes.plot(*found.end.xy, "D", ms=6, mfc=INK, mec=PAPER, mew=0.6, zorder=5)
    dress(axes)
    told = readable(found.length, CLOSED_FORM, digits=6)[0]
    axes.set_title(f"{Word.LENGTH} {told}", size=9.5, color=INK, parse_math=False)
