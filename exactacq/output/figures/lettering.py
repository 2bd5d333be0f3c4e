"""The texts of a drawing: obstacles' names and the order of visits, S, T, D, Q and R."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from flint import fmpq
from matplotlib.lines import Line2D
from matplotlib.path import Path as Outline
from matplotlib.patheffects import withStroke

from exactacq.geometry.strokes import Stroke
from exactacq.numbers.rationals import nearest_float, plain
from exactacq.output.figures.canvas import RANGE, Canvas, Spot
from exactacq.output.figures.labels import BESIDE, FAR, LEADING, NEAR, SMALLEST, LabelRoom, Placed
from exactacq.output.vocabulary import AWAY, EDGE, INK, PAPER, SOFT, VIEW, Labels, Word, ordinal
from exactacq.scene.edge_table import Floats
from exactacq.strategies.run import SightseerRun

CROWDED = 300
"""Among more obstacles than this, labels that do not fit into their obstacle are left out."""
NAMED = 9
"""At most this many diversions have their ends named in the picture."""
LONGEST = 18
"""Characters of a name in a picture; the rest of a longer one is left out."""
READABLE, SMALL = 4.8, 6.5
"""Size of a label within its obstacle, below which it goes beside it; one up to which all of it is dark."""
DENSITY = 8.0
"""Distance of neighbours over the size of labels beside them."""
DENSEST, SPARSEST = 4000, 40
"""Points that stand for one curve at most, and those of an outline that distances are taken from."""


class _Order(str):
    """The line of a label that tells the order of a visit: names may look like one."""

    __slots__ = ()


class Lettering:
    """The texts of one drawing.

    Their places depend on the whole path: from moment to moment they stand still, but for those that make
    room for a mark.
    """

    def __init__(self, canvas: Canvas, labels: Labels) -> None:
        self.canvas, self.labels = canvas, labels
        self.room = LabelRoom(canvas.points(canvas.width), canvas.points(canvas.height))

    def draw(self) -> None:
        """Write all texts, and tell in the legend what they mean."""
        if self.labels is Labels.NONE:
            self._range_in_words("")
            return
        canvas = self.canvas
        outlines = self._mark()
        texts = dict(self._texts())
        left = []
        for index, lines in texts.items():
            if self._inside(index, lines, outlines[index]):
                canvas.meter.add()
            else:
                left.append(index)
        for spot, text in ((canvas.start, "S"), (canvas.goal, "T")):
            if spot is not None:
                self._at_spot(spot, text, size=10.5)
        self._diversions()
        self._range()
        for index in left:
            if not self._beside(index, texts[index], outlines[index]):
                self.room.left_out += 1
            canvas.meter.add()
        if any(isinstance(line, _Order) for lines in texts.values() for line in lines):
            look: dict[str, Any] = {"marker": "$\\#$", "markersize": 7, "color": SOFT, "linestyle": ""}
            canvas.legend[f"{ordinal(1)}, {ordinal(2)}, ...: {Word.ORDER}"] = Line2D([], [], **look)
        if self.room.left_out:
            count = self.room.left_out
            canvas.legend[f"{count} label{'s' * (count != 1)} left out"] = Line2D([], [], linestyle="")

    # -- what is in the way ------------------------------------------------------------------------

    def _mark(self) -> list[Floats]:
        """Mark all that was drawn; the outlines of the run's obstacles as close points on the paper."""
        canvas, room = self.canvas, self.room
        for obstacle, region in zip(canvas.scene.obstacles, canvas.regions, strict=True):
            room.mark_line(self._sampled(region.strokes))
            if not obstacle.is_enclosure:
                ring = self._on_paper(region.points)
                room.mark_inside(Outline(ring), (ring.min(axis=0), ring.max(axis=0)))
        # The whole path, also of a moment: labels are not in the way of what comes.
        path = () if canvas.run is None else [piece.curve.stroke() for piece in canvas.run.path]
        if path:
            room.mark_line(self._sampled(path))
        if canvas.scene.terrain is not None:
            west, south, east, north = map(float, canvas.scene.terrain.limits)
            corners = (west, south), (east, south), (east, north), (west, north), (west, south)
            room.mark_line(self._sampled([Stroke(p, q, math.dist(p, q)) for p, q in pairwise(corners)]))
        if canvas.sweep is not None and canvas.sweep.line:
            room.mark_line(self._sampled([segment.stroke() for segment in canvas.sweep.line]))
        for spot, size in canvas.spots:
            room.mark_spot(self._spot(spot), size)
        return [self._sampled(region.strokes) for region in canvas.bodies]

    def _sampled(self, strokes: Sequence[Stroke]) -> Floats:
        """Points on strokes that are less than a cell apart, on the paper."""
        points = []
        for stroke in strokes:
            count = min(DENSEST, max(2, math.ceil(1.4 * self.canvas.points(stroke.length))))
            shares = np.linspace(0.0, 1.0, count + 1)
            if stroke.center is None:
                start, end = np.array(stroke.start), np.array(stroke.end)
                points.append(start + shares[:, None] * (end - start))
            else:
                points.append(stroke.points(count))
        return self._on_paper(np.concatenate(points))

    def _on_paper(self, places: Floats) -> Floats:
        found: Floats = (places - self.canvas.low) * self.canvas.scale * 72
        return found

    def _spot(self, place: Spot) -> Spot:
        x, y = self._on_paper(np.array(place))
        return float(x), float(y)

    # -- obstacles ---------------------------------------------------------------------------------

    def _texts(self) -> Iterator[tuple[int, list[str]]]:
        """The lines of each obstacle's label: name and order of its visit.

        Of names that begin alike and are cut none is told, but the obstacle's number.
        """
        canvas = self.canvas
        visits = {} if canvas.run is None else {k: n for n, k in enumerate(canvas.run.visits, 1)}
        bodies = canvas.scene.obstacles if canvas.run is None else canvas.run.obstacles
        names = [_shortened(body.label) for body in bodies]
        many = Counter(names)
        for index, name in enumerate(names):
            lines = []
            if self.labels is not Labels.NUMBERS and not (self._is_wall(index) and index not in visits):
                lines.append(name if many[name] == 1 or name == bodies[index].label else f"O{index + 1}")
            if self.labels is not Labels.NAMES and index in visits:
                lines.append(_Order(ordinal(visits[index])))
            if lines:
                yield index, lines

    def _is_wall(self, index: int) -> bool:
        return self.canvas.sweep is None and self.canvas.scene.obstacles[index].is_enclosure

    def _inside(self, index: int, lines: list[str], outline: Floats) -> bool:
        if self._is_wall(index):
            return False
        heart, depth = self.canvas.bodies[index].heart()
        if depth <= 0:
            return False
        margin = self.canvas.line / 2 + 0.5
        middle = self._spot(heart)
        away = outline - middle
        sizes = np.hypot(*away.T)
        # The line along the boundary takes its share of the room.
        inner = middle + away * np.maximum(1 - margin / np.maximum(sizes, 1e-9), 0.0)[:, None]
        placed = self.room.inside(lines, middle, inner, READABLE)
        return self._written(placed, lines, index)

    def _beside(self, index: int, lines: list[str], outline: Floats) -> bool:
        if len(self.canvas.bodies) > CROWDED:
            return False
        target = outline[:: max(1, len(outline) // SPARSEST)]
        if self._is_wall(index):
            target = self._near_hit(index, target)
        # Sizes fall with density: with the distance of obstacles, were they spread evenly.
        high, wide = self.room.shape
        size = float(np.clip(math.sqrt(wide * high / len(self.canvas.bodies)) / DENSITY, READABLE, BESIDE))
        forms = [(lines, size), (lines, READABLE), (lines, SMALLEST), (lines[:1], SMALLEST)]
        for some, size in forms:
            placed = self.room.beside(some, size, target, self.canvas.line / 2 + 1, FAR)
            if self._written(placed, some, index):
                return True
        return False

    def _near_hit(self, index: int, outline: Floats) -> Floats:
        """Of a wall the point where it was first hit, if it was."""
        run = self.canvas.run
        links = run.links if isinstance(run, SightseerRun) else ()
        hits = [link.hit.xy for link in links if link.target == index]
        return self._on_paper(np.array(hits[:1])) if hits else outline

    def _written(self, placed: Placed | None, lines: Sequence[str], index: int) -> bool:
        """Write an obstacle's label; the order of its visit only if that has begun."""
        if placed is None:
            return False
        if placed.leader is not None:
            ends = zip(*(self._in_scene(end) for end in placed.leader), strict=True)
            self.canvas.axes.plot(*ends, color=EDGE, linewidth=0.6, zorder=5.5, solid_capstyle="round")
        here = [line for line in lines if self._has_begun(index) or not isinstance(line, _Order)]
        for number, line in enumerate(here):
            x, y = placed.middle
            y += ((len(here) - 1) / 2 - number) * LEADING * placed.size
            is_order = isinstance(line, _Order) and len(lines) > 1
            is_soft = is_order and placed.size > SMALL
            self._write((x, y), line, placed.size, SOFT if is_soft else INK, not is_order)
        return True

    def _has_begun(self, index: int) -> bool:
        """Whether the robot has come to an obstacle by the moment."""
        canvas = self.canvas
        return canvas.moment is None or any(piece.obstacle == index for piece in canvas.pieces)

    # -- points and the range ----------------------------------------------------------------------

    def _at_spot(self, spot: Spot, text: str, size: float, colour: str = INK) -> None:
        target = np.array([self._spot(spot)])
        placed = self.room.beside([text], size, target, max(self.canvas.line / 2, 2) + 2, NEAR)
        if placed is None:
            self.room.left_out += 1
        else:
            self._write(placed.middle, text, size, colour)

    def _diversions(self) -> None:
        detours = self.canvas.detours
        if self.canvas.sweep is None or not 0 < len(detours) <= NAMED:
            return
        several = len(self.canvas.sweep.detours) > 1
        for number, detour in enumerate(detours, 1):
            for word, spot in ((Word.D, detour.leave), (Word.Q, detour.hit)):
                if spot is not None:
                    self._at_spot(spot, f"{word}{number}" if several else word, 8.5, AWAY)

    def _range(self) -> None:
        """R beside the circle about S where that is in view; else in the legend."""
        canvas = self.canvas
        if canvas.radius is None or canvas.start is None:
            self._range_in_words("")
            return
        turns = np.arange(180) * math.pi / 90
        ring = np.array(canvas.start) + canvas.radius * np.stack((np.cos(turns), np.sin(turns)), 1)
        on_paper = self._on_paper(ring)
        within = ((on_paper > 0) & (on_paper < (self.room.shape[1], self.room.shape[0]))).all(axis=1)
        placed = self.room.along([self._radius], 8.5, on_paper[within]) if within.any() else None
        if placed is None:
            self._range_in_words("" if within.any() else " (beyond the view)")
        else:
            self._write(placed.middle, self._radius, placed.size, VIEW, False)

    def _range_in_words(self, remark: str) -> None:
        if self.canvas.radius is not None:
            self.canvas.legend[f"{self._radius}{remark}"] = Line2D([], [], **RANGE)

    @property
    def _radius(self) -> str:
        canvas = self.canvas
        return radius_text(canvas.scene.radius if canvas.run is None else canvas.run.radius)

    # -- writing -----------------------------------------------------------------------------------

    def _in_scene(self, spot: Spot) -> Spot:
        x, y = np.array(spot) / (self.canvas.scale * 72) + self.canvas.low
        return float(x), float(y)

    def _write(self, middle: Spot, text: str, size: float, colour: str, is_bold: bool = True) -> None:
        self.canvas.axes.text(
            *self._in_scene(middle), text, size=size, color=colour, weight="bold" if is_bold else "normal",
            ha="center", va="center_baseline", parse_math=False, clip_on=True, zorder=6,
            path_effects=[withStroke(linewidth=min(2.2, 0.22 * size), foreground=PAPER)],
        )  # fmt: skip


def radius_text(radius: fmpq | None) -> str:
    """What a picture says of the radius of vision."""
    assert radius is not None, "it is told where there is one"
    text = f"{Word.RADIUS} = {plain(radius)}"
    return text if len(text) <= 16 else f"{Word.RADIUS} ≈ {nearest_float(radius):.6g}"


def _shortened(name: str) -> str:
    """A name, cut where it is long."""
    return name if len(name) <= LONGEST else name[: LONGEST - 1] + "…"
