"""Figures of scenes and runs: exact curves drawn as curves, the path coloured by time.

What is drawn lies where it is: pieces walked again are drawn on top of the earlier ones as narrower lines,
not beside them. Every figure is laid out in inches so that nothing covers the drawing, whatever its shape.
"""

from __future__ import annotations

import io
import math
import os
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib import style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle
from matplotlib.patches import Circle as Disc
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path as Outline
from matplotlib.patheffects import withStroke
from matplotlib.transforms import Affine2D

from exactacq.files.whole_files import FIGURES, check_output, readable, write_whole
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import plain
from exactacq.output.figures.sweep import SweptTerrain, window
from exactacq.output.regions import Region, Room, Steps, clearance, closed, part
from exactacq.output.snapshot import Snapshot
from exactacq.scene.edge_table import Floats
from exactacq.scene.scene import Scene
from exactacq.sensing.event import Event, EventKind
from exactacq.strategies.run import Run, SeedSpreaderRun, SightseerRun

CLOSED_FORM = 40
"""Closed forms of at most this many characters are shown in the title, the decimal value of others."""

WIDEST, TALLEST, NARROWEST = 7.2, 6.8, 1.2
"""Inches: the drawing fits a box of WIDEST x TALLEST, and a thin scene is given NARROWEST."""
COLOURS = 160
"""Steps of the colour scale along the path."""
CROWDED = 300
"""Among more obstacles than this, labels that do not fit into their obstacle are left out."""
NAMED = 9
"""At most this many diversions have their ends named in the picture."""
DOTS = 200
"""Resolution of PNG files in dots per inch."""


INK, SOFT, PAPER = "#22262b", "#70767d", "#ffffff"
FILL, EDGE = "#dcd7cd", "#8a8377"
VIEW, TREE, HIT = "#3b7dd8", "#f6b64b", "#d6273d"
AWAY, AWAY_AGAIN = "#e8590c", "#ffc9a3"
ARROWHEAD = Outline([(-0.75, -0.62), (1, 0), (-0.75, 0.62), (-0.4, 0), (-0.75, -0.62)], closed=True)
STYLES: dict[str, dict[str, Any]] = {
    "obstacle": {"facecolor": FILL, "edgecolor": EDGE, "linewidth": 0.8},
    "seen, never visited": {
        "facecolor": "#f4e3dc", "edgecolor": "#b3502e", "linewidth": 0.8, "linestyle": "--", "hatch": "////",
    },
    "seen in part": {"facecolor": "#f4e3dc", "edgecolor": "#b3502e", "linewidth": 0.8, "linestyle": "--"},
    "never seen": {"facecolor": PAPER, "edgecolor": "#b3502e", "linewidth": 0.9, "linestyle": ":"},
    "out of reach": {"facecolor": "#f5f3ef", "edgecolor": "#d3cec4", "linewidth": 0.6},
}  # fmt: skip


def figure(subject: Run | Scene, at: Event | Length | object = None) -> Figure:
    """A matplotlib figure of a run, or of a scene alone with the names or numbers of its obstacles.

    A run's figure shows the order of visits, the path coloured by its length so far, hit and leave
    points, tree links, start S, end T and the radius of vision R; of the Seed Spreader also the M-line,
    its crossing points and the diversions from D to Q. With *at*, an event or a length of the path, it
    shows that moment: the path so far, what the robot sees (shaded), known boundary (strong), unknown
    boundary (faint), and the frontier between them. ValueError for a length without an algebraic place
    (see `Run.near`); `FormatError` for a scene that is 10^-9 times its distance from the origin or
    less.

    >>> import exactacq as xa
    >>> [text.get_text() for text in figure(xa.sightseer(xa.load("circles"))).axes[0].texts]
    ['1', '2', 'S', 'T']
    """
    return _page([_Canvas(subject, at)])


def pair(first: Run, second: Run) -> Figure:
    """The figures of two runs side by side."""
    return _page([_Canvas(first), _Canvas(second)])


def svg(subject: Run | Scene) -> str:
    """The figure as SVG text; the same subject always gives the same text."""
    return _rendered(lambda: figure(subject), ".svg").decode()


def save(subject: Run | Scene, path: str | os.PathLike[str], at: Event | Length | object = None) -> None:
    """Write the figure to a .svg, .pdf or .png file, whole or not at all; *at* as in `figure`.

    Raises `FormatError` for another suffix or a place that cannot be written, before anything is drawn.
    """
    target = check_output(path, FIGURES)
    write_whole(target, _rendered(lambda: figure(subject, at), target.suffix.lower()))


def save_pair(first: Run, second: Run, path: str | os.PathLike[str]) -> None:
    """Write the figures of two runs side by side to one file, with the suffixes and errors of `save`."""
    target = check_output(path, FIGURES)
    write_whole(target, _rendered(lambda: pair(first, second), target.suffix.lower()))


def png(subject: Run | Scene, at: Event | Length | object, dots: int) -> bytes:
    """The figure as a PNG of so many dots per inch; *at* as in `figure`."""
    return _rendered(lambda: figure(subject, at), ".png", dots)


def _rendered(draw: Callable[[], Figure], suffix: str, dots: int = DOTS) -> bytes:
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


def dress(axes: Any) -> None:
    """Light spines and small ticks."""
    for side in axes.spines.values():
        side.set(color="#c9ccd0", linewidth=0.6)
    axes.tick_params(labelsize=7.5, colors=SOFT, length=2.5, width=0.6)


def _counted(count: int) -> str:
    return f"{count} obstacle" + "s" * (count != 1)


def _page(drawings: Sequence[_Canvas]) -> Figure:
    """Drawings side by side, their axes on one level."""
    page = Figure()
    FigureCanvasAgg(page)
    for drawing in drawings:
        drawing.draw(page)
    below, above = (max(getattr(d, side) for d in drawings) for side in ("below", "above"))
    high = below + max(d.height * d.scale for d in drawings) + above
    page.set_size_inches(sum(d.full for d in drawings), high)
    left = 0.0
    for drawing in drawings:
        drawing.lay_out(page, left, below - drawing.below)
        left += drawing.full
    return page


class _Canvas:
    """One figure in the making; lengths in points and inches follow from the scene's size."""

    def __init__(self, subject: Run | Scene, at: Event | Length | object = None) -> None:
        self.run = subject if isinstance(subject, Run) else None
        self.scene = scene = subject.scene if isinstance(subject, Run) else subject
        start = self.run.start if self.run is not None else scene.start
        radius = self.run.radius if self.run is not None else scene.radius
        self.sweep = None if self.run is None else SweptTerrain.of(self.run)
        self.regions = [Region.of(o) for o in scene.obstacles]
        self.bodies = self.regions if self.sweep is None else self.sweep.regions
        self.count = len(scene.obstacles if self.run is None else self.run.obstacles)
        self.moment = None if self.run is None or at is None else Snapshot.of(self.run, at)
        walked = self.moment.walked if self.moment is not None else self.run.path if self.run else ()
        self.walked = len(walked) if self.moment is None else self.moment.count
        self.strokes = [p.curve.stroke() for p in walked]
        self.pieces = walked
        self.start = None if start is None else start.xy
        self.radius = None if radius is None else float(radius)
        self.low, self.high = self._view()
        self.scale = min(WIDEST / self.width, TALLEST / self.height)
        self.legend: dict[str, Any] = {}

    # -- layout ------------------------------------------------------------------------------------

    def _view(self) -> tuple[Floats, Floats]:
        """The drawn rectangle: everything there is, a margin, and no side shorter than NARROWEST inches."""
        corners = [corner for region in self.regions for corner in region.box]
        corners += [np.array(self.start)] if self.start is not None else []
        low, high = window(self.scene, corners, self.radius or 1.0, self.sweep is not None)
        size = float(np.max(high - low))
        margin = size * (0.07 if self.scene.enclosure is not None else 0.05)
        low, high = low - margin, high + margin
        least = (size + 2 * margin) * NARROWEST / WIDEST
        lack = np.maximum(least - (high - low), 0) / 2
        return low - lack, high + lack

    @property
    def width(self) -> float:
        """Width of the view in the scene's unit."""
        return float(self.high[0] - self.low[0])

    @property
    def height(self) -> float:
        """Height of the view in the scene's unit."""
        return float(self.high[1] - self.low[1])

    def points(self, length: float) -> float:
        """A length of the scene in typographic points."""
        return length * self.scale * 72

    @property
    def full(self) -> float:
        """Width in inches of all that is drawn."""
        return max(self.width * self.scale + 1.1, 6.2)

    @property
    def columns(self) -> int:
        """Most entries of the legend in a row."""
        return max(1, int((self.full - 0.4) / 1.62))

    @property
    def foot(self) -> float:
        """Inches for the legend and the colour bar, once all is drawn."""
        rows = math.ceil(len(self.legend) / self.columns)
        return 0.12 + 0.19 * rows + (0.58 if self.colours is not None else 0.0)

    @property
    def below(self) -> float:
        """Inches below the axes."""
        return self.foot + 0.3

    @property
    def above(self) -> float:
        """Inches above the axes."""
        return 0.22 + 0.24 * len(self.title)

    def draw(self, page: Figure) -> None:
        """Draw everything that lies in the axes, which are laid out later."""
        self.axes = axes = page.add_axes((0, 0, 1, 1))
        axes.set_xlim(self.low[0], self.high[0])
        axes.set_ylim(self.low[1], self.high[1])
        self._ground()
        self._view_then()
        self._obstacles()
        self._knowledge()
        self.colours = self._path()
        self._marks()
        self._sweeping()
        self._numbers()
        self._ends()
        self._range()
        self.title = self._title()

    def lay_out(self, page: Figure, x: float, y: float) -> None:
        """Place axes, title, colour bar and legend with their lower left corner at (x, y), in inches."""
        wide, high = self.width * self.scale, self.height * self.scale
        full, total = (float(side) for side in page.get_size_inches())
        left = x + (self.full - wide) / 2 + (0.12 if wide + 1.1 >= self.full else 0)
        bottom = y + self.below
        self.axes.set_position((left / full, bottom / total, wide / full, high / total))
        dress(self.axes)
        self.axes.ticklabel_format(useOffset=False, style="plain")
        self.axes.locator_params(nbins=6, min_n_ticks=2)
        middle, top = (x + self.full / 2) / full, 1 - (total - (bottom + high + self.above)) / total
        for k, line in enumerate(self.title):
            size, colour = ((12, INK), (9.5, SOFT), (9.5, "#b3502e"))[k]
            place = top - (0.24 + 0.24 * k) / total
            page.text(
                middle, place, line, ha="center", va="center", size=size, color=colour, parse_math=False
            )
        if self.colours is not None:
            length = min(self.full - 1.2, 5.0)
            corner = x + (self.full - length) / 2, y + self.foot - 0.12
            spot = (corner[0] / full, corner[1] / total, length / full, 0.09 / total)
            bar = page.colorbar(self.colours, cax=page.add_axes(spot), orientation="horizontal")
            bar.set_label("path length", size=8, color=SOFT, labelpad=1)
            bar.ax.tick_params(labelsize=7.5, colors=SOFT, length=2, width=0.6)
            bar.outline.set_visible(False)
            if bar.solids is not None:  # Curves and text apart, the bar should be sharp at any zoom, too.
                bar.solids.set_rasterized(False)
        if self.legend:
            page.legend(
                self.legend.values(), self.legend.keys(),
                loc="lower center", bbox_to_anchor=(middle, (y + 0.06) / total),
                ncol=min(self.columns, len(self.legend)), frameon=False, fontsize=8, labelcolor=INK,
                borderpad=0, borderaxespad=0, handlelength=1.8, columnspacing=1.5, labelspacing=0.4,
                handler_map={tuple: HandlerTuple(ndivide=1)},
            )  # fmt: skip

    def _title(self) -> list[str]:
        run, name = self.run, self.scene.name
        if run is None:
            count = sum(not o.is_enclosure for o in self.scene.obstacles)
            room = " in an enclosure" if self.scene.enclosure is not None else ""
            return [name or "Scene", f"{_counted(count)}{room}"]
        length = " ".join(readable(run.length, CLOSED_FORM, digits=8))
        if self.moment is not None:
            so_far = " ".join(readable(self.moment.at, CLOSED_FORM, digits=8))
            seen = f"{len(self.moment.map.acquired)} of {_counted(self.count)} acquired"
            return [f"{run.title}: {name}" if name else run.title, f"after {so_far} of {length},  {seen}"]
        done, part = f"{len(run.visits)} of {_counted(self.count)} visited", "seen but never visited"
        if self.sweep is not None:
            done, part = f"{len(run.map.acquired)} of {_counted(self.count)} acquired", "seen in part"
        missed = [(len(run.unseen), "never seen"), (len(run.unvisited), part)]
        if isinstance(run, SeedSpreaderRun):
            missed.append((len(run.unreached), "out of reach"))
        words = [f"{number} {what}" for number, what in missed if number]
        words += ["ended before T"] if self.sweep is not None and not self.sweep.arrives else []
        lines = [f"{run.title}: {name}" if name else run.title, f"length {length},  {done}", ", ".join(words)]
        return [line for line in lines if line]

    # -- the scene ---------------------------------------------------------------------------------

    def _ground(self) -> None:
        axes, terrain = self.axes, self.scene.terrain
        axes.set_facecolor("#fdfdfc")
        if terrain is not None:
            size = float(terrain.width), float(terrain.height)
            corner = terrain.south_west.xy
            axes.add_patch(Rectangle(corner, *size, fill=False, edgecolor=SOFT, linewidth=0.8, zorder=0.6))

    def _obstacles(self) -> None:
        for obstacle, region in zip(self.scene.obstacles, self.regions, strict=True):
            outline = region.outline
            if obstacle.is_enclosure:
                outline = Outline.make_compound_path(self._frame(), outline)
            if self.sweep is None:
                self._fill(outline, self._kind(obstacle.index), 1)
            elif not self.sweep.is_whole(obstacle.index):
                self._fill(outline, "out of reach", 0.9)
        for index, region in enumerate(self.bodies if self.sweep is not None else ()):
            self._fill(region.outline, self._kind(index), 1)

    def _fill(self, outline: Outline, kind: str, level: float) -> None:
        look = STYLES[kind]
        self.axes.add_patch(PathPatch(outline, zorder=level, joinstyle="round", **look))
        if look is not STYLES["obstacle"]:
            self.legend.setdefault(kind, Patch(**look))

    def _kind(self, index: int) -> str:
        """How much of an obstacle was seen, by its number in the run."""
        if self.run is not None and index in self.run.unseen:
            return "never seen"
        if self.run is not None and index in self.run.unvisited:
            return "seen, never visited" if self.sweep is None else "seen in part"
        return "obstacle"

    def _frame(self) -> Outline:
        """A counterclockwise rectangle beyond the view: the clockwise enclosure is a hole in it."""
        (x0, y0), (x1, y1) = self.low - (self.high - self.low), self.high + (self.high - self.low)
        return Outline([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], closed=True)

    # -- what is known -----------------------------------------------------------------------------

    def _view_then(self) -> None:
        """What the robot sees at the moment, shaded."""
        if self.moment is not None:
            outline = closed(piece.curve.stroke() for piece in self.moment.view.pieces)
            look: dict[str, Any] = {"facecolor": VIEW, "alpha": 0.16, "edgecolor": "none"}
            self.axes.add_patch(PathPatch(outline, zorder=0.8, **look))
            self.legend.setdefault("what the robot sees", Patch(**look))

    def _knowledge(self) -> None:
        """Known boundary strong and the frontier marked, where something is left unknown."""
        if self.run is None:
            return
        known = self.run.map if self.moment is None else self.moment.map
        if self.moment is None and len(known.acquired) == self.count:
            return
        curves = [p.curve for i in known.seen for p in known.known(i) if p.curve is not None]
        paths = [part(curve.stroke(), 0.0, 1.0) for curve in curves]
        if paths:
            self.axes.add_collection(
                PathCollection(
                    paths, facecolors="none", edgecolors=INK, linewidths=1.7, zorder=2.2, capstyle="round"
                ),
                autolim=False,
            )
            self.legend.setdefault("known boundary", Line2D([], [], color=INK, linewidth=1.7))
        if known.frontier:
            x, y = zip(*(point.xy for _, point in known.frontier), strict=True)
            look: dict[str, Any] = {"marker": "D", "markersize": 4, "markerfacecolor": PAPER, "linewidth": 0}
            self.axes.plot(x, y, color=HIT, zorder=4.2, **look)
            self.legend.setdefault("frontier", Line2D([], [], color=HIT, **look))

    # -- the path ----------------------------------------------------------------------------------

    @cached_property
    def line(self) -> float:
        """Width in points of a piece walked for the first time; less where obstacles are small."""
        sizes = [self.points(float(np.max(high - low))) for low, high in (r.box for r in self.bodies)]
        width = float(np.clip(0.09 * np.median(sizes), 1.2, 3.6)) if sizes else 3.0
        return width if self.sweep is None else min(width, 0.12 * self.points(self.sweep.width))

    @cached_property
    def away(self) -> set[int]:
        """The numbers of the pieces of the path that belong to diversions."""
        return set() if self.sweep is None else self.sweep.away

    def _path(self) -> PathCollection | None:
        """The path in steps of one colour, later traversals narrower and above; None if there is none."""
        if sum(stroke.length for stroke in self.strokes) == 0:
            return None
        assert self.run is not None
        total = float(self.run.length)  # Of all moments of a run, the colours are those of its end.
        steps = Steps.of(self.strokes, COLOURS)
        tolerance = 1e-7 * max(self.width, self.height)
        ranks = steps.ranks(self.strokes, [piece.obstacle for piece in self.pieces], tolerance)
        widths = self.line * np.array([1.0, 0.5, 0.25])[np.minimum(ranks, 2)]
        shades = mpl.colormaps["viridis"](np.linspace(0.0, 0.94, 128))
        colours = ListedColormap(shades).with_extremes(under=AWAY, over=AWAY_AGAIN)
        collection = PathCollection(
            steps.pieces, facecolors="none", linewidths=widths, cmap=colours, norm=Normalize(0, total),
            zorder=3, capstyle="round", joinstyle="round",
        )  # fmt: skip
        # Steps of diversions are off the scale of lengths, which gives them the colours beyond its ends.
        away = np.isin(steps.owners, list(self.away))
        collection.set_array(np.where(away, np.where(ranks > 0, 2 * total, -total), steps.times))
        self.axes.add_collection(collection, autolim=False)
        self._arrows(collection)
        if ranks.any():
            lines = tuple(Line2D([], [], color=colours(t), linewidth=w) for t, w in ((0.15, 3.6), (0.8, 1.6)))
            self.legend["walked again (inner line)"] = lines
        return collection

    def _arrows(self, collection: PathCollection) -> None:
        """Arrowheads on the straight pieces that are long enough; two ways of one link keep apart."""
        assert self.run is not None
        size, done = self.line + 4.6, 0.0
        ways = Counter(frozenset((stroke.start, stroke.end)) for stroke in self.strokes)
        for number, (piece, stroke) in enumerate(zip(self.pieces, self.strokes, strict=True)):
            twice = ways[frozenset((stroke.start, stroke.end))] > 1
            if piece.kind == "straight" and self.points(stroke.length) > (5 if twice else 3) * size:
                time = -1 if number in self.away else done + stroke.length / 2
                colour = collection.to_rgba(np.array(time))
                shape = MarkerStyle(ARROWHEAD, transform=Affine2D().rotate(stroke.heading(0)))
                self.axes.plot(
                    *stroke.at(0.62 if twice else 0.5), marker=shape, markersize=size, linestyle="",
                    color=colour, mec=PAPER, mew=0.5, zorder=4,
                )  # fmt: skip
            done += stroke.length

    def _marks(self) -> None:
        """Tree links, and the points where they leave and hit."""
        if not isinstance(self.run, SightseerRun) or not self.run.links:
            return
        walked = self.run.links
        if self.moment is not None:
            hits = sum(e.kind is EventKind.HIT and e.after <= self.moment.count for e in self.run.events)
            walked = walked[:hits]
        links = [(link.leave.xy, link.hit.xy) for link in walked]
        style: dict[str, Any] = {"alpha": 0.55, "linewidths": self.line + 4, "capstyle": "round"}
        self.axes.add_collection(LineCollection(links, colors=TREE, zorder=2, **style), autolim=False)
        self.legend["tree link"] = Line2D([], [], color=TREE, alpha=0.55, linewidth=6)
        leaves = [spot for link, (spot, _) in zip(walked, links, strict=True) if link.source != "S"]
        size = max(self.line + 1.2, 3.6)
        self._dots("leave point", leaves, ms=size + 3, mfc=PAPER, mec=INK, mew=0.9, zorder=4.6)
        self._dots("hit point", [hit for _, hit in links], ms=size, mfc=HIT, mec=PAPER, mew=0.5, zorder=5)

    def _sweeping(self) -> None:
        """The M-line, its crossing points, and the ends of diversions: D on the M-line, Q where they hit."""
        if self.sweep is None:
            return
        line: dict[str, Any] = {"color": SOFT, "linewidth": 0.7, "linestyle": (0, (4, 3))}
        self.axes.plot(*zip(*self.sweep.corners, strict=True), zorder=1.5, **line)
        self.legend["M-line"] = Line2D([], [], **line)
        size, spots = max(self.line, 1.8), self.sweep.crossings
        self._dots("crossing point", spots, ms=size + 1, mfc=INK, mec=PAPER, mew=0.5, zorder=4.4)
        detours = [d for d in self.sweep.detours if d.pieces.start <= self.walked]
        if not detours:
            return
        self.legend["diversion"] = Line2D([], [], color=AWAY, linewidth=3)
        hits = [detour.hit for detour in detours if detour.hit is not None]
        leaves = [detour.leave for detour in detours]
        for name, spots, fill, edge in (("D", leaves, PAPER, AWAY), ("Q", hits, AWAY, PAPER)):
            self._dots(name, spots, ms=size + 3, mfc=fill, mec=edge, mew=1, zorder=4.7)
            for number, spot in enumerate(spots if len(detours) <= NAMED else (), 1):
                word = f"{name}{number}" if len(self.sweep.detours) > 1 else name
                self._write(self._beside(spot, 7 + size), word, size=8.5, color=AWAY)

    def _dots(self, name: str, spots: Sequence[tuple[float, float]], marker: str = "o", **style: Any) -> None:
        """Marks of one kind, and their entry in the legend."""
        if spots:
            self.axes.plot(*zip(*spots, strict=True), linestyle="", marker=marker, **style)
            style["ms"] = min(7, style["ms"])
            self.legend[name] = Line2D([], [], linestyle="", marker=marker, **style)

    # -- labels ------------------------------------------------------------------------------------

    @cached_property
    def room(self) -> Room:
        """Where labels fit: clear of boundaries and straight pieces, and rather not in an obstacle."""
        starts = [region.points for region in self.regions]
        ends = [np.roll(region.points, -1, axis=0) for region in self.regions]
        straight = [stroke for stroke in self.strokes if stroke.center is None]
        starts += [np.array([stroke.start for stroke in straight]).reshape(-1, 2)]
        ends += [np.array([stroke.end for stroke in straight]).reshape(-1, 2)]
        inner = zip(self.scene.obstacles, self.regions, strict=True)
        blocks = [region for obstacle, region in inner if not obstacle.is_enclosure]
        return Room(self.low, self.high, np.concatenate(starts), np.concatenate(ends), blocks)

    def _write(self, place: tuple[float, float], text: str, **style: Any) -> None:
        self.room.labels.append(place)
        settings = {"size": 9, "color": INK, "weight": "bold", "zorder": 6, **style}
        self.axes.text(
            *place, text, ha="center", va="center_baseline", parse_math=False, clip_on=True,
            path_effects=[withStroke(linewidth=2.2, foreground=PAPER)], **settings,
        )  # fmt: skip

    def _beside(self, place: tuple[float, float], away: float) -> tuple[float, float]:
        """The clearest spot about *away* points from a place."""
        return self.room.beside(place, away / 72 / self.scale)

    def _numbers(self) -> None:
        """The order of visits, or the names in a scene alone: inside where there is room, else beside.

        A label that would cover another one is left out.
        """
        for index, text in self._texts():
            if self.sweep is None and self.scene.obstacles[index].is_enclosure:
                self._write(self._wall_spot(index), text, size=10)
                continue
            place, depth = self.bodies[index].heart()
            room = self.points(depth) - self.line / 2
            size = min(10.0, 1.4 * room / (0.35 + 0.4 * max(1.6, len(text))))
            if size < 5.5 and len(self.regions) > CROWDED:
                continue
            if size < 5.5:
                place, size = self._beside(place, self.points(depth) + self.line / 2 + 6), 8.0
            if self.points(float(self.room.apart(np.array([place]))[0])) > size:
                self._write(place, text, size=size)

    def _texts(self) -> Iterator[tuple[int, str]]:
        if self.run is not None:
            yield from ((index, str(order)) for order, index in enumerate(self.run.visits, 1))
            return
        for obstacle in self.scene.obstacles:
            if not obstacle.is_enclosure:
                name = obstacle.name or ""
                yield obstacle.index, name if 0 < len(name) <= 4 else str(obstacle.index + 1)

    def _wall_spot(self, index: int) -> tuple[float, float]:
        """A place for a label in the wall, near the point where it was first hit."""
        assert isinstance(self.run, SightseerRun)
        hit = next(link.hit.xy for link in self.run.links if link.target == index)
        return self._beside(hit, 10 + self.line)

    def _ends(self) -> None:
        """S and T."""
        if self.start is not None:
            self._end(self.start, "S", "s")
        if self.moment is not None:
            size = max(self.line + 4, 6.5)
            self._dots("robot", [self.moment.place.xy], ms=size, mfc=VIEW, mec=PAPER, zorder=5.2)
        elif self.sweep is not None and not self.sweep.arrives:
            self._end(self.sweep.corners[-1], "T", "D")
            if self.strokes:
                self._dots("stop", [self.strokes[-1].end], "X", ms=8, mfc=HIT, mec=PAPER, mew=0.6, zorder=5.2)
        elif self.run is not None and self.strokes:
            self._end(self.strokes[-1].end, "T", "D")

    def _end(self, place: tuple[float, float], text: str, marker: str) -> None:
        name = "start S" if text == "S" else "end T"
        self._dots(
            name, [place], marker, ms=max(self.line + 3.4, 5.6), mfc=INK, mec=PAPER, mew=0.6, zorder=4.8
        )
        self._write(self._beside(place, 7 + self.line), text, size=10.5)

    def _range(self) -> None:
        """The circle of radius R about S, labelled where it is in view; else a word in the legend."""
        if self.radius is None:
            return
        radius = self.scene.radius if self.run is None else self.run.radius
        label = f"R = {self.radius if radius is None else plain(radius)}"
        label = label if len(label) <= 16 else f"R ≈ {self.radius:.6g}"
        line: dict[str, Any] = {"linestyle": (0, (5, 4)), "color": VIEW, "linewidth": 0.8}
        if self.start is None:
            self.legend[label] = Line2D([], [], **line)
            return
        turns = np.arange(72) * math.pi / 36
        ring = np.array(self.start) + self.radius * np.stack((np.cos(turns), np.sin(turns)), 1)
        border = np.minimum(ring - self.low, self.high - ring).min(axis=1)
        if self.points(float(border.max())) < 14:
            self.legend[f"{label} (beyond the view)"] = Line2D([], [], **line)
            return
        self.axes.add_patch(Disc(self.start, self.radius, fill=False, alpha=0.75, zorder=0.8, **line))
        self.axes.add_patch(Disc(self.start, self.radius, color=VIEW, alpha=0.045, linewidth=0, zorder=0.5))
        room = np.minimum(clearance(ring, self.room.starts, self.room.ends), border * 0.8)
        room = np.minimum(room, self.room.apart(ring))
        best = ring[int(np.argmax(np.minimum(room, 30 / 72 / self.scale)))]
        self._write((float(best[0]), float(best[1])), label, size=8.5, color=VIEW, weight="normal")
