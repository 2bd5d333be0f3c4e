"""Where the texts of a drawing go: no label on another one, and as few lines and marks below them as can be.

Lengths are typographic points from the drawing's lower left corner. What is drawn is marked in a grid of
cells, one point wide; sums over its rows and columns give what lies below a box in constant time. So every
place around an obstacle is looked at: a label goes into it where it fits, else beside it, and if there is no
room there, farther away with a leader line, or smaller. In floats: for drawing only.
"""

from __future__ import annotations

from bisect import bisect
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.textpath import text_to_path

from exactacq.scene.edge_table import Floats

LEADING = 1.15
"""Distance of the lines of a label, in sizes of its text."""
LARGEST, SMALLEST = 10.0, 4.5
"""Sizes of labels; smaller ones cannot be read."""
BESIDE = 8.0
"""Largest size of labels that do not fit into what they name."""
GAP = 1.0
"""Least gap between a label and another one, or a line."""
SPACE = 0.4
"""Least gap between labels side by side, in sizes of the text: else they read as one."""
STEP = 2.0
"""Distance of the places for a label that are looked at."""
NEAR, FAR = 14.0, 44.0
"""Labels are at most so far from what they name: without a leader line, and with one."""
CLEAR = 4.0
"""Cells with lines below a label that are no reason to go far away for."""
LONG = 400
"""Lines of so many characters are wider than any page, and it takes long to tell how wide."""
BLANK = 0.3
"""Width of a text of size 1 in which nothing is to be seen."""
INSIDE, MARK = 0.1, 2.0
"""What a cell within an obstacle, and one below a mark, counts; one below a line counts 1."""

Spot = tuple[float, float]
Box = tuple[float, float, float, float]
"""Left, bottom, right, top."""


@dataclass(frozen=True, slots=True)
class Placed:
    """A label's place: the middle of its box, its size, and where a leader line starts and ends, if any."""

    middle: Spot
    size: float
    leader: tuple[Spot, Spot] | None = None


class LabelRoom:
    """The drawing's cells and the labels that it has so far."""

    def __init__(self, width: float, height: float) -> None:
        self.shape = max(1, int(np.ceil(height))), max(1, int(np.ceil(width)))
        self.boxes: list[Box] = []
        self.left_out = 0
        self._cells = np.zeros(self.shape)
        self._sums: Any = None

    def mark_line(self, spots: Floats) -> None:
        """Cells below a line, given by points on it that are less than a cell apart."""
        self._mark(spots, 1.0)

    def mark_spot(self, spot: Spot, size: float) -> None:
        """Cells below a round mark."""
        reach = np.arange(-(size // 2), size // 2 + 1)
        disc = np.stack(np.meshgrid(reach, reach), -1).reshape(-1, 2)
        self._mark(np.array(spot) + disc[np.hypot(*disc.T) <= size / 2 + 0.1], MARK)

    def mark_inside(self, outline: Any, box: tuple[Floats, Floats]) -> None:
        """Cells within an outline (a path of matplotlib) that lies in a box."""
        high, wide = self.shape
        left, bottom = np.maximum(np.floor(box[0]).astype(int), 0)
        right, top = np.minimum(np.ceil(box[1]).astype(int), (wide, high))
        if left >= right or bottom >= top:
            return
        columns, rows = np.meshgrid(np.arange(left, right), np.arange(bottom, top))
        cells = np.stack((columns + 0.5, rows + 0.5), -1).reshape(-1, 2)
        inside = outline.contains_points(cells).reshape(columns.shape)
        self._cells[bottom:top, left:right] += INSIDE * inside
        self._sums = None

    def _mark(self, spots: Floats, cost: float) -> None:
        high, wide = self.shape
        cells = np.floor(spots).astype(int)
        cells = np.unique(cells[(cells >= 0).all(axis=1) & (cells < (wide, high)).all(axis=1)], axis=0)
        self._cells[cells[:, 1], cells[:, 0]] = np.maximum(self._cells[cells[:, 1], cells[:, 0]], cost)
        self._sums = None

    # -- placing -----------------------------------------------------------------------------------

    def inside(self, lines: Sequence[str], middle: Spot, outline: Floats, least: float) -> Placed | None:
        """In a region about its *middle*, as large as its *outline* allows; None if that is below *least*."""
        wide, high = extent(lines, 1.0)
        # Of a box with the label's ratio of sides the outline leaves so much: a distance in other units.
        scaled = np.abs(outline - middle) / (wide / 2, high / 2)
        size = min(LARGEST, 0.92 * float(scaled.max(axis=1).min()))
        if size < least:
            return None
        box = around(middle, (size * wide, size * high))
        if not self._is_free(np.array([box]))[0]:
            return None
        return self._taken(box, Placed(middle, size))

    def beside(
        self, lines: Sequence[str], size: float, target: Floats, own: float = 0.0, far: float = NEAR
    ) -> Placed | None:
        """Near some of the points *target*, at least *own* from all of them; None if there is no room.

        Where all is crowded next to it, as far away as *far*, with a leader line to the nearest point.
        """
        extents = extent(lines, size)
        middle = (target.min(axis=0) + target.max(axis=0)) / 2
        for reach in sorted({min(far, NEAR), far}):
            spread = (np.ptp(target, axis=0) + extents) / 2 + reach
            steps = [np.arange(-(side // STEP), side // STEP + 1) * STEP for side in spread]
            spots = middle + np.stack(np.meshgrid(*steps), -1).reshape(-1, 2)
            gaps = _gaps(spots, extents, target)
            kept = (gaps >= own + GAP) & (gaps <= own + reach)
            spots, gaps = spots[kept], gaps[kept]
            found = self._best(spots, extents, 0.35 * gaps, reach < far)
            if found is not None:
                box = around(found, extents)
                return self._taken(box, Placed(found, size, self._leader(box, target, own + 0.75 * size)))
        return None

    def along(self, lines: Sequence[str], size: float, spots: Floats) -> Placed | None:
        """At the best of some spots."""
        extents = extent(lines, size)
        found = self._best(spots, extents, np.zeros(len(spots)), False)
        return None if found is None else self._taken(around(found, extents), Placed(found, size))

    def _best(self, spots: Floats, extents: Spot, costs: Floats, choosy: bool) -> Spot | None:
        """The spot for a box with the least on it; None if there is none or, for the *choosy*, none clear."""
        half = np.array(extents) / 2 + GAP
        boxes = np.hstack((spots - half, spots + half))
        high, wide = self.shape
        free = (boxes[:, :2] >= 0).all(axis=1) & (boxes[:, 2] <= wide) & (boxes[:, 3] <= high)
        free[free] = self._is_free(boxes[free])
        if not free.any():
            return None
        below = self._below(boxes[free])
        if choosy and below.min() > CLEAR:
            return None
        best = spots[free][int(np.argmin(below + costs[free]))]
        return float(best[0]), float(best[1])

    def _is_free(self, boxes: Floats) -> Any:
        """Which boxes lie on no label."""
        if not self.boxes:
            return np.ones(len(boxes), dtype=bool)
        taken = np.array(self.boxes)
        apart: Any = (boxes[:, None, :2] >= taken[:, 2:]) | (boxes[:, None, 2:] <= taken[:, :2])
        separate: Any = apart.any(axis=2)
        return separate.all(axis=1)

    def _below(self, boxes: Floats) -> Floats:
        """What all cells of each box count."""
        if self._sums is None:
            self._sums = np.pad(self._cells.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
        low, high = np.floor(boxes[:, :2]).astype(int), np.ceil(boxes[:, 2:]).astype(int)
        rows, columns = self.shape
        (x0, y0), (x1, y1) = np.maximum(low, 0).T, np.minimum(high, (columns, rows)).T
        sums = self._sums
        found: Floats = sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0]
        return found

    def _leader(self, box: Box, target: Floats, close: float) -> tuple[Spot, Spot] | None:
        """From the box to the nearest point, unless they are so close that they are seen as one."""
        nearest = np.clip(target, box[:2], box[2:])
        away = np.hypot(*(nearest - target).T)
        k = int(np.argmin(away))
        if away[k] <= close:
            return None
        (x, y), (u, v) = nearest[k], target[k]
        return (float(x), float(y)), (float(u), float(v))

    def _taken(self, box: Box, placed: Placed) -> Placed:
        left, bottom, right, top = box
        space = SPACE * placed.size
        self.boxes.append((left - space, bottom, right + space, top))
        return placed


def around(middle: Spot, extents: Spot) -> Box:
    """The box of some extents about its middle."""
    (x, y), (wide, high) = middle, extents
    return x - wide / 2, y - high / 2, x + wide / 2, y + high / 2


def extent(lines: Sequence[str], size: float) -> Spot:
    """Width and height of a label of some lines."""
    wide = max(width(line) for line in lines)
    return wide * size, (0.85 + LEADING * (len(lines) - 1)) * size


def fitted(line: str, size: float, most: float) -> str:
    """A line of text, cut if it is wider than *most*: then it ends with "…"."""
    if len(line) < LONG and width(line) * size <= most:
        return line
    kept = bisect(range(1, min(len(line), LONG)), most, key=lambda count: width(line[:count] + "…") * size)
    return line[:kept].rstrip() + "…"


def _gaps(spots: Floats, extents: Spot, target: Floats) -> Floats:
    """How far boxes about spots are from the nearest of some points."""
    least = np.full(len(spots), np.inf)
    half = np.array(extents) / 2
    for point in target:
        beyond = np.maximum(np.abs(spots - point) - half, 0.0)
        least = np.minimum(least, np.hypot(*beyond.T))
    return least


@lru_cache(maxsize=4096)
def width(text: str, weight: str = "bold") -> float:
    """The width of a text of size 1; names may have no letters that leave a trace."""
    vertices, codes = text_to_path.get_text_path(FontProperties(weight=weight), text)
    if not len(vertices):
        return BLANK
    return float(Path(vertices, codes).get_extents().width) / text_to_path.FONT_SCALE
