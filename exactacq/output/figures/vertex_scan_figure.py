"""A picture of two measures: lengths converge where circles become polygons, counts of vertices do not.

Above, the paths of the Sightseer and of the vertex scan on one scene of polygons; below, the Sightseer's P
and the vertex scan's moves over the number of sides. In floats: for drawing only.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PathCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.ticker import NullFormatter, NullLocator

from exactacq.files.gallery import scene as gallery_scene
from exactacq.numbers.length import Length
from exactacq.output.figures.canvas import STYLES
from exactacq.output.figures.layout import dress
from exactacq.output.regions import Region, Steps
from exactacq.output.vocabulary import HIT, INK, LINE, PAPER, SCALE, SCALE_END, SOFT, VIEW, Word
from exactacq.scene.scene import Scene
from exactacq.sensing.path import Piece
from exactacq.strategies.sightseer.strategy import sightseer
from exactacq.strategies.vertex_scan import LimitRow, polygon_limit, polygonal, vertex_scan

SIDES, KS = 16, (4, 8, 16, 32, 64)
"""Sides of the polygons in the upper pictures, and numbers of sides for the lower ones."""
COLOURS = 200
"""Steps of the colour scale along a path."""
THICK = 3.2
"""Width in points of what is walked for the first time; half of it the second time, and so on."""
WIDE, HIGH = 10.0, 5.4
"""Size of the page in inches."""


def limit_figure(sides: int = SIDES, ks: Iterable[int] = KS, scene: Scene | None = None) -> Figure:
    """Both strategies on a scene of circles (the gallery's "circles" if None) as polygons.

    Errors and cost as `exactacq.strategies.vertex_scan.polygon_limit`, which gives the numbers; needs at
    least one k.
    """
    world = gallery_scene("circles") if scene is None else scene
    rows = polygon_limit(ks, world)
    page = Figure(figsize=(WIDE, HIGH))
    FigureCanvasAgg(page)
    flat = polygonal(world, sides)
    run, scan = sightseer(flat), vertex_scan(flat)
    left, right, lengths, counts = page.subplots(2, 2, height_ratios=(0.8, 1)).flat
    _paths(left, flat, run.path, f"Sightseer Strategy: P = {float(run.length):.4f}")
    corners = [edge.start.xy for obstacle in flat.obstacles for edge in obstacle.edges]
    title = f"vertex scan: {scan.scans} scans, {scan.moves} moves, length {float(scan.length):.4f}"
    _paths(right, flat, scan.path, title)
    right.plot(*zip(*corners, strict=True), "o", ms=3.6, mfc=HIT, mec=PAPER, mew=0.5, zorder=4, label="scan")
    right.legend(loc="lower left", frameon=False, fontsize=8, borderaxespad=0.1)
    _lengths(lengths, rows, rows[0].length + rows[0].gap)
    _counts(counts, rows)
    page.subplots_adjust(left=0.07, right=0.985, bottom=0.07, top=0.95, wspace=0.16, hspace=0.26)
    return page


def _paths(axes: Any, scene: Scene, path: Sequence[Piece], title: str) -> None:
    """A scene and a path in it, coloured by its length so far; walked again: narrower, on top."""
    for obstacle in scene.obstacles:
        axes.add_patch(PathPatch(Region.of(obstacle).outline, zorder=1, **STYLES[Word.OBSTACLE]))
    strokes = [piece.curve.stroke() for piece in path]
    steps = Steps.of(strokes, COLOURS)
    size = max(abs(coordinate) for stroke in strokes for coordinate in (*stroke.start, *stroke.end))
    ranks = steps.ranks(strokes, [piece.obstacle for piece in path], 1e-7 * size)
    shades = ListedColormap(mpl.colormaps[SCALE](np.linspace(0.0, SCALE_END, 128)))
    drawn = PathCollection(
        steps.pieces, facecolors="none", linewidths=THICK * 0.5 ** np.minimum(ranks, 2), cmap=shades,
        zorder=3, capstyle="round",
    )  # fmt: skip
    drawn.set_array(steps.times)
    axes.add_collection(drawn)
    axes.plot(*path[0].start.xy, "s", ms=5.6, mfc=INK, mec=PAPER, mew=0.6, zorder=5)
    axes.annotate(
        "S", path[0].start.xy, (0, 6), textcoords="offset points", ha="center", weight="bold", size=9
    )
    axes.set_aspect("equal")
    axes.margins(0.04)
    _dress(axes, title)


def _lengths(axes: Any, rows: Sequence[LimitRow], limit: Length) -> None:
    ks = [row.sides for row in rows]
    value = float(limit)
    axes.axhline(value, color=SOFT, linewidth=0.9, linestyle=(0, (5, 4)), zorder=1)
    axes.annotate(f"circles: {limit}", (ks[0], value), (0, 4), textcoords="offset points", size=8, color=SOFT)
    axes.plot(ks, [float(row.length) for row in rows], "o-", ms=4, lw=1.2, color=VIEW, label="Sightseer")
    axes.plot(
        ks, [float(row.scan_length) for row in rows], "s--", ms=3.6, lw=1, color=HIT, label="vertex scan"
    )
    axes.margins(y=0.12)
    _over_sides(axes, ks, "path length over sides k")


def _counts(axes: Any, rows: Sequence[LimitRow]) -> None:
    ks = [row.sides for row in rows]
    most = [2 * (row.vertices - 1) for row in rows]
    axes.plot(ks, most, "--", lw=0.9, color=SOFT, label="2 (N - 1)")
    axes.plot(ks, [row.moves for row in rows], "s-", ms=4, lw=1.2, color=HIT, label="moves")
    axes.plot(ks, [row.scans for row in rows], "o:", ms=3.2, lw=1, color=INK, label="scans = N")
    axes.set_yscale("log", base=2)
    axes.yaxis.set_major_formatter("{x:.0f}")
    _over_sides(axes, ks, "vertex scan: counts over sides k")


def _over_sides(axes: Any, ks: Sequence[int], title: str) -> None:
    axes.set_xscale("log", base=2)
    axes.set_xticks(ks, [str(k) for k in ks])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.legend(frameon=False, fontsize=8)
    axes.grid(color=LINE, alpha=0.5, linewidth=0.6)
    axes.set_axisbelow(True)
    _dress(axes, title)


def _dress(axes: Any, title: str) -> None:
    axes.set_title(title, size=9.5, color=INK, pad=5, parse_math=False)
    dress(axes)
