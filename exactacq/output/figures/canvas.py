"""The drawing of a scene or run in axes: exact curves as curves, the path coloured by its length so far.

What is drawn lies where it is: pieces walked again are drawn on top of the earlier ones as narrower lines,
not beside them. Texts come last (`lettering`), where they cover least.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle
from matplotlib.patches import Circle as Disc
from matplotlib.patches import Patch, PathPatch, Rectangle
from matplotlib.path import Path as Outline
from matplotlib.transforms import Affine2D

from exactacq.cached import cached_property
from exactacq.numbers.length import Length
from exactacq.output.figures.sweep import Detour, SweptTerrain, turning_places, window
from exactacq.output.regions import Region, Steps, closed, part
from exactacq.output.snapshot import Snapshot
from exactacq.output.vocabulary import (
    AWAY,
    AWAY_AGAIN,
    EDGE,
    FAINT,
    FILL,
    GROUND,
    HIT,
    INK,
    LINE,
    MISSED,
    MISSED_FILL,
    PAPER,
    PARTIAL,
    SCALE,
    SCALE_END,
    SHADE,
    SOFT,
    TREE,
    VIEW,
    Word,
    missed_word,
)
from exactacq.progress import Meter
from exactacq.scene.edge_table import Floats
from exactacq.scene.scene import Scene
from exactacq.sensing.event import Event, EventKind
from exactacq.strategies.run import Run, SightseerRun

WIDEST, TALLEST, NARROWEST = 7.2, 6.8, 1.2
"""Inches: the drawing fits a box of WIDEST x TALLEST, and a thin scene is given NARROWEST."""
COLOURS = 160
"""Steps of the colour scale along the path."""

Spot = tuple[float, float]
ARROWHEAD = Outline([(-0.75, -0.62), (1, 0), (-0.75, 0.62), (-0.4, 0), (-0.75, -0.62)], closed=True)
STYLES: dict[str, dict[str, Any]] = {
    Word.OBSTACLE: {"facecolor": FILL, "edgecolor": EDGE, "linewidth": 0.8},
    Word.UNVISITED: {
        "facecolor": MISSED_FILL, "edgecolor": MISSED, "linewidth": 0.8, "linestyle": "--", "hatch": "////",
    },
    Word.INCOMPLETE: {"facecolor": MISSED_FILL, "edgecolor": MISSED, "linewidth": 0.8, "linestyle": "--"},
    Word.UNSEEN: {"facecolor": PAPER, "edgecolor": MISSED, "linewidth": 0.9, "linestyle": ":"},
    Word.UNREACHABLE: {"facecolor": FAINT, "edgecolor": LINE, "linewidth": 0.6},
}  # fmt: skip
RANGE: dict[str, Any] = {"linestyle": (0, (5, 4)), "color": VIEW, "linewidth": 0.8}
UNKNOWN: dict[str, Any] = {"edgecolor": EDGE, "linewidth": 0.8, "linestyle": (0, (2, 3))}


def steps(subject: Run | Scene) -> int:
    """How many steps a drawing takes: the moment, what is known of each obstacle, and each label."""
    return 1 + 2 * len(subject.scene.obstacles if isinstance(subject, Run) else subject.obstacles)


class Canvas:
    """One drawing in the making; lengths in points follow from the scene's size and that of the axes.

    *room* is the size in inches that it has to fit into. ``legend`` names what was drawn, ``spots`` are the
    round marks with their sizes in points.
    """

    def __init__(
        self,
        subject: Run | Scene,
        at: Event | Length | object,
        meter: Meter,
        room: Spot = (WIDEST, TALLEST),
    ) -> None:
        self.meter = meter
        self.run = subject if isinstance(subject, Run) else None
        self.scene = scene = subject.scene if isinstance(subject, Run) else subject
        start = self.run.start if self.run is not None else scene.start
        radius = self.run.radius if self.run is not None else scene.radius
        self.sweep = None if self.run is None else SweptTerrain.of(self.run)
        self.regions = [Region.of(o) for o in scene.obstacles]
        self.bodies = self.regions if self.sweep is None else self.sweep.regions
        self.count = len(scene.obstacles if self.run is None else self.run.obstacles)
        self.moment = None if self.run is None or at is None else Snapshot.of(self.run, at)
        meter.add()
        walked = self.moment.walked if self.moment is not None else self.run.path if self.run else ()
        self.walked = len(walked) if self.moment is None else self.moment.count
        self.strokes = [p.curve.stroke() for p in walked]
        self.pieces = walked
        self.start = None if start is None else start.xy
        self.radius = None if radius is None else float(radius)
        self.room = room
        self.low, self.high = self._view()
        # Where the colours of the path end, also at a moment of the run.
        self.longest = 0.0 if self.run is None else float(self.run.length)
        self.legend: dict[str, Any] = {}
        self.spots: list[tuple[Spot, float]] = []
        self.colours: PathCollection | None = None

    def draw(self, axes: Any) -> None:
        """Draw all but texts."""
        self.axes = axes
        axes.set_xlim(self.low[0], self.high[0])
        axes.set_ylim(self.low[1], self.high[1])
        self._ground()
        self._view_then()
        self._obstacles()
        self._knowledge()
        self.colours = self._path()
        self._marks()
        self._sweeping()
        self._ends()
        self._range()

    # -- layout ------------------------------------------------------------------------------------

    def _view(self) -> tuple[Floats, Floats]:
        """The drawn rectangle: everything there is, a margin, and no side shorter than NARROWEST inches."""
        corners = [corner for region in self.regions for corner in region.box]
        corners += [np.array(self.start)] if self.start is not None else []
        corners += [np.array(place.xy) for place in turning_places(self.run)] if self.run is not None else []
        low, high = window(self.scene, corners, self.radius or 1.0, self.sweep is not None)
        size = float(np.max(high - low))
        margin = size * (0.07 if self.scene.enclosure is not None else 0.05)
        low, high = low - margin, high + margin
        least = (size + 2 * margin) * NARROWEST / WIDEST
        lack = np.maximum(least - (high - low), 0) / 2
        return low - lack, high + lack

    @property
    def scale(self) -> float:
        """Inches to a unit of the scene."""
        return min(self.room[0] / self.width, self.room[1] / self.height)

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

    # -- the scene ---------------------------------------------------------------------------------

    def _ground(self) -> None:
        axes, terrain = self.axes, self.scene.terrain
        axes.set_facecolor(GROUND)
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
                self._fill(outline, obstacle.index)
            elif not self.sweep.is_whole(obstacle.index):
                self._patch(outline, 0.9, **STYLES[Word.UNREACHABLE])
                self.legend[Word.UNREACHABLE] = Patch(**STYLES[Word.UNREACHABLE])
        for index, region in enumerate(self.bodies if self.sweep is not None else ()):
            self._fill(region.outline, index)

    def _fill(self, outline: Outline, index: int) -> None:
        """An obstacle of the run: as it was known at the moment, or by what the whole run has missed."""
        if self.moment is not None:
            known = self.moment.map
            acquired = index in known.acquired
            fill = FILL if acquired else PARTIAL if index in known.seen else FAINT
            self._patch(outline, 1, facecolor=fill, **UNKNOWN)
            if acquired:
                self.legend[Word.ACQUIRED] = Patch(facecolor=FILL, edgecolor=INK, linewidth=1.2)
            else:
                self.legend[Word.UNKNOWN] = Line2D(
                    [], [], color=EDGE, linewidth=0.8, linestyle=UNKNOWN["linestyle"]
                )
            return
        word = self._missed(index)
        self._patch(outline, 1, **STYLES[word])
        if word is not Word.OBSTACLE:
            self.legend[word] = Patch(**STYLES[word])

    def _patch(self, outline: Outline, level: float, **look: Any) -> None:
        self.axes.add_patch(PathPatch(outline, zorder=level, joinstyle="round", **look))

    def _missed(self, index: int) -> Word:
        """What of an obstacle was missed, by its number in the run."""
        if self.run is not None and index in self.run.unseen:
            return Word.UNSEEN
        if self.run is not None and index in self.run.unvisited:
            return missed_word(not isinstance(self.run, SightseerRun))
        return Word.OBSTACLE

    def _frame(self) -> Outline:
        """A counterclockwise rectangle beyond the view: the clockwise enclosure is a hole in it."""
        (x0, y0), (x1, y1) = self.low - (self.high - self.low), self.high + (self.high - self.low)
        return Outline([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], closed=True)

    # -- what is known -----------------------------------------------------------------------------

    def _view_then(self) -> None:
        """What the robot sees at the moment, shaded."""
        if self.moment is not None:
            outline = closed(piece.curve.stroke() for piece in self.moment.view.pieces)
            look: dict[str, Any] = {"facecolor": VIEW, "alpha": SHADE, "edgecolor": "none"}
            self.axes.add_patch(PathPatch(outline, zorder=0.8, **look))
            self.legend[Word.VIEW] = Patch(**look)

    def _knowledge(self) -> None:
        """Known boundary strong and the frontier marked, where something is left unknown."""
        if self.run is None:
            return
        known = self.run.map if self.moment is None else self.moment.map
        if self.moment is None and len(known.acquired) == self.count:
            return
        curves = []
        for i in known.seen:
            curves += [p.curve for p in known.known(i) if p.curve is not None]
            self.meter.add()
        paths = [part(curve.stroke(), 0.0, 1.0) for curve in curves]
        if paths:
            self.axes.add_collection(
                PathCollection(
                    paths, facecolors="none", edgecolors=INK, linewidths=1.7, zorder=2.2, capstyle="round"
                ),
                autolim=False,
            )
            self.legend[Word.KNOWN] = Line2D([], [], color=INK, linewidth=1.7)
        if known.frontier:
            x, y = zip(*(point.xy for _, point in known.frontier), strict=True)
            look: dict[str, Any] = {"marker": "D", "markersize": 4, "markerfacecolor": PAPER, "linewidth": 0}
            self.axes.plot(x, y, color=HIT, zorder=4.2, **look)
            self.legend[Word.FRONTIER] = Line2D([], [], color=HIT, **look)

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
        total = self.longest
        steps = Steps.of(self.strokes, COLOURS)
        tolerance = 1e-7 * max(self.width, self.height)
        ranks = steps.ranks(self.strokes, [piece.obstacle for piece in self.pieces], tolerance)
        widths = self.line * np.array([1.0, 0.5, 0.25])[np.minimum(ranks, 2)]
        shades = mpl.colormaps[SCALE](np.linspace(0.0, SCALE_END, 128))
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
            self.legend[f"{Word.AGAIN} (inner line)"] = lines
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
        self.legend[Word.LINK] = Line2D([], [], color=TREE, alpha=0.55, linewidth=6)
        leaves = [spot for link, (spot, _) in zip(walked, links, strict=True) if link.source != "S"]
        size = max(self.line + 1.2, 3.6)
        self._dots(Word.LEAVE, leaves, ms=size + 3, mfc=PAPER, mec=INK, mew=0.9, zorder=4.6)
        self._dots(Word.HIT, [hit for _, hit in links], ms=size, mfc=HIT, mec=PAPER, mew=0.5, zorder=5)

    def _sweeping(self) -> None:
        """The M-line, its crossing points, and the ends of diversions: D on the M-line, Q where they hit."""
        if self.sweep is None or not self.sweep.line:
            return
        line: dict[str, Any] = {"color": SOFT, "linewidth": 0.7, "linestyle": (0, (4, 3))}
        self.axes.plot(*zip(*self.sweep.corners, strict=True), zorder=1.5, **line)
        self.legend[Word.M_LINE] = Line2D([], [], **line)
        size, spots = max(self.line, 1.8), self.sweep.crossings
        self._dots(Word.CROSSING, spots, ms=size + 1, mfc=INK, mec=PAPER, mew=0.5, zorder=4.4)
        if not self.detours:
            return
        self.legend[Word.DIVERSION] = Line2D([], [], color=AWAY, linewidth=3)
        hits = [detour.hit for detour in self.detours if detour.hit is not None]
        leaves = [detour.leave for detour in self.detours]
        for word, spots, fill, edge in ((Word.D, leaves, PAPER, AWAY), (Word.Q, hits, AWAY, PAPER)):
            self._dots(word, spots, ms=size + 3, mfc=fill, mec=edge, mew=1, zorder=4.7)

    @cached_property
    def detours(self) -> list[Detour]:
        """The diversions that have begun."""
        found = [] if self.sweep is None else self.sweep.detours
        return [detour for detour in found if detour.pieces.start <= self.walked]

    @property
    def goal(self) -> Spot | None:
        """Where T is, if it is shown: where the run ends, or where its M-line does."""
        if self.run is None or self.moment is not None or not self.strokes:
            return None
        return self.strokes[-1].end if self.sweep is None or self.sweep.arrives else self.sweep.corners[-1]

    def _dots(self, name: str, spots: Sequence[Spot], marker: str = "o", **style: Any) -> None:
        """Marks of one kind, and their entry in the legend."""
        if spots:
            self.axes.plot(*zip(*spots, strict=True), linestyle="", marker=marker, **style)
            self.spots += [(spot, style["ms"] + 1) for spot in spots]
            style["ms"] = min(7, style["ms"])
            self.legend[name] = Line2D([], [], linestyle="", marker=marker, **style)

    def _ends(self) -> None:
        """S and T, the robot, and where a sweep stopped short of T."""
        ends: dict[str, Any] = {"ms": max(self.line + 3.4, 5.6), "mfc": INK, "mec": PAPER, "mew": 0.6}
        if self.start is not None:
            self._dots(Word.START, [self.start], "s", zorder=4.8, **ends)
        if self.moment is not None:
            size = max(self.line + 4, 6.5)
            self._dots(Word.ROBOT, [self.moment.place.xy], ms=size, mfc=VIEW, mec=PAPER, zorder=5.2)
        if self.goal is not None:
            self._dots(Word.END, [self.goal], "D", zorder=4.8, **ends)
            if self.goal != self.strokes[-1].end:
                look: dict[str, Any] = {"ms": 8, "mfc": HIT, "mec": PAPER, "mew": 0.6}
                self._dots(Word.STOP, [self.strokes[-1].end], "X", zorder=5.2, **look)

    def _range(self) -> None:
        """The circle of radius R about S."""
        if self.radius is None or self.start is None:
            return
        self.axes.add_patch(Disc(self.start, self.radius, fill=False, alpha=0.75, zorder=0.8, **RANGE))
        self.axes.add_patch(Disc(self.start, self.radius, color=VIEW, alpha=0.045, linewidth=0, zorder=0.5))


def show_alike(drawings: Sequence[Canvas]) -> None:
    """Let drawings that are not drawn yet show one rectangle, and one length of the path by one colour."""
    low = np.min([drawing.low for drawing in drawings], axis=0)
    high = np.max([drawing.high for drawing in drawings], axis=0)
    longest = max(drawing.longest for drawing in drawings)
    for drawing in drawings:
        drawing.low, drawing.high, drawing.longest = low, high, longest
