"""A robot that steps and looks in floats: the yardstick for what an exact run costs.

The module is written in the language of the compiled kernel, so that mypyc can compile it (see `compiled`).
Nothing here is exact or certain: what is seen between two steps only is missed, and a tie of floats is
decided anyhow.

Obstacles are loops of edges with the obstacle on the left. A view is what is seen of the edges within the
radius: a sweep of a ray over the edges that face the place, which a grid of cells as wide as the radius
finds. It keeps the edges that the ray meets in the order of their distance. With n edges in reach, of which
the ray meets k at most, that takes O(n log n + n k).
"""

from __future__ import annotations

from math import floor, sqrt
from typing import Final, final

OFF: Final = 1e-6
"""So far off a boundary that it stands on the robot looks from there."""
TOUCH: Final = 1e-9
"""Closer than this to an edge it stands on it."""
CLOSE: Final = 1e-6
"""Parts of an edge that are closer than this, as lengths, are joined."""
LEVEL: Final = 1e-12
"""Heights over an edge below this, times the length of both, are a tie."""
STRIDE: Final = 1 << 20
"""Rows of the grid, at most."""


@final
class FloatViews:
    """The edges of a scene, from (ax, ay) to (bx, by), and what was seen of each so far.

    After `look`, ``seen``, ``low`` and ``high`` are the edges in sight, counterclockwise, and between which
    lengths from their starts.
    """

    def __init__(
        self, ax: list[float], ay: list[float], bx: list[float], by: list[float], radius: float
    ) -> None:
        self.ax, self.ay, self.radius = ax, ay, radius
        self.size = [sqrt((bx[e] - ax[e]) ** 2 + (by[e] - ay[e]) ** 2) for e in range(len(ax))]
        self.ex = [(bx[e] - ax[e]) / self.size[e] for e in range(len(ax))]
        self.ey = [(by[e] - ay[e]) / self.size[e] for e in range(len(ax))]
        self.known: list[list[float]] = [[] for _ in ax]
        """For each edge the sorted ends of the parts that were seen."""
        self.missing = len(ax)
        self.done = [False for _ in ax]
        self.seen: list[int] = []
        self.low: list[float] = []
        self.high: list[float] = []
        self._marks = [0 for _ in ax]
        self._mark = 0
        self._cells: dict[int, list[int]] = {}
        for e in range(len(ax)):
            for i in range(floor(min(ax[e], bx[e]) / radius), floor(max(ax[e], bx[e]) / radius) + 1):
                for j in range(floor(min(ay[e], by[e]) / radius), floor(max(ay[e], by[e]) / radius) + 1):
                    self._cells.setdefault(i * STRIDE + j, []).append(e)
        # The edges of one view, clipped: number, lengths at both ends, and first and last point as the ray
        # turns, from the place.
        self._edge: list[int] = []
        self._from: list[float] = []
        self._to: list[float] = []
        self._px: list[float] = []
        self._py: list[float] = []
        self._qx: list[float] = []
        self._qy: list[float] = []

    def walk(self, places: list[tuple[float, float]]) -> int:
        """Look around at each place and add up what is seen; returns how many edges are not wholly known."""
        for x, y in places:
            self.look(x, y)
            for k in range(len(self.seen)):
                if not self.done[self.seen[k]]:
                    self._learn(self.seen[k], self.low[k], self.high[k])
        return self.missing

    def look(self, x: float, y: float) -> None:
        """See what is in sight from a place."""
        near = self._near(x, y)
        nx, ny = 0.0, 0.0
        for e in near:
            ux, uy = x - self.ax[e], y - self.ay[e]
            ex, ey = self.ex[e], self.ey[e]
            along = ux * ex + uy * ey
            if abs(ux * ey - uy * ex) <= TOUCH and -TOUCH <= along <= self.size[e] + TOUCH:
                nx += ey
                ny -= ex
        self._clip(near, x + OFF * nx, y + OFF * ny)
        self._sweep()

    def _near(self, x: float, y: float) -> list[int]:
        """The edges in the cells around a place, each once."""
        self._mark += 1
        mark, marks = self._mark, self._marks
        found: list[int] = []
        column, row = floor(x / self.radius), floor(y / self.radius)
        for i in range(column - 1, column + 2):
            for j in range(row - 1, row + 2):
                cell = self._cells.get(i * STRIDE + j)
                if cell is not None:
                    for e in cell:
                        if marks[e] != mark:
                            marks[e] = mark
                            found.append(e)
        return found

    def _clip(self, near: list[int], x: float, y: float) -> None:
        """Keep what of some edges faces a place within the radius."""
        self._edge, self._from, self._to = [], [], []
        self._px, self._py, self._qx, self._qy = [], [], [], []
        square = self.radius * self.radius
        for e in near:
            ux, uy = self.ax[e] - x, self.ay[e] - y
            ex, ey = self.ex[e], self.ey[e]
            height = ux * ey - uy * ex
            if height >= 0.0 or height * height >= square:
                continue
            half = sqrt(square - height * height)
            foot = -(ux * ex + uy * ey)
            low, high = max(foot - half, 0.0), min(foot + half, self.size[e])
            if low < high:
                self._edge.append(e)
                self._from.append(low)
                self._to.append(high)
                self._px.append(ux + high * ex)
                self._py.append(uy + high * ey)
                self._qx.append(ux + low * ex)
                self._qy.append(uy + low * ey)

    def _sweep(self) -> None:
        """Turn a ray once around, from west."""
        self.seen, self.low, self.high = [], [], []
        count = len(self._edge)
        angles: list[float] = []
        for k in range(count):
            angles.append(turn(self._qx[k], self._qy[k]))
        for k in range(count):
            angles.append(turn(self._px[k], self._py[k]))
        met = self._met_at_first(angles)
        top = met[0] if met else -1
        x, y = -1.0, 0.0
        # Ends come first, so that of two edges that share a corner the ray never meets both there.
        order = sorted(range(2 * count), key=angles.__getitem__)
        for n in order:
            if n < count:
                if n in met:
                    met.remove(n)
                dx, dy = self._qx[n], self._qy[n]
            else:
                dx, dy = self._px[n - count], self._py[n - count]
                self._insert(met, n - count)
            first = met[0] if met else -1
            if first != top:
                if top >= 0:
                    self._show(top, x, y, dx, dy)
                top, x, y = first, dx, dy
        if top >= 0:
            self._show(top, x, y, -1.0, 0.0)

    def _met_at_first(self, angles: list[float]) -> list[int]:
        """The edges that the ray to the west meets, the nearest first."""
        count = len(self._edge)
        met: list[tuple[float, int]] = []
        for k in range(count):
            if angles[count + k] > angles[k]:
                px, py = self._px[k], self._py[k]
                wx, wy = self._qx[k] - px, self._qy[k] - py
                met.append((-(px - wx * (py / wy)) if wy != 0.0 else -px, k))
        met.sort()
        return [k for _, k in met]

    def _insert(self, met: list[int], k: int) -> None:
        """Put an edge that begins among those that the ray meets."""
        at = 0
        while at < len(met) and not self._is_nearer(k, met[at]):
            at += 1
        met.insert(at, k)

    def _is_nearer(self, k: int, other: int) -> bool:
        """Whether an edge begins before another one, or runs on before it where it begins on it."""
        px, py = self._px[other], self._py[other]
        wx, wy = self._qx[other] - px, self._qy[other] - py
        sx, sy = self._px[k] - px, self._py[k] - py
        height = wx * sy - wy * sx
        if abs(height) <= LEVEL * (abs(wx) + abs(wy)) * (abs(px) + abs(py)):
            height = wx * (self._qy[k] - py) - wy * (self._qx[k] - px)
        return height > 0.0

    def _show(self, k: int, x: float, y: float, dx: float, dy: float) -> None:
        """What is seen of an edge while the ray turns from one direction to another."""
        low, high = self._at(k, dx, dy), self._at(k, x, y)
        if low < high:
            self.seen.append(self._edge[k])
            self.low.append(low)
            self.high.append(high)

    def _at(self, k: int, dx: float, dy: float) -> float:
        """The length along an edge at which a ray meets it."""
        e, low, high = self._edge[k], self._from[k], self._to[k]
        ex, ey = self.ex[e], self.ey[e]
        sine = dx * ey - dy * ex
        if sine == 0.0:
            return high
        qx, qy = self._qx[k], self._qy[k]
        return min(max(low - (dx * qy - dy * qx) / sine, low), high)

    def _learn(self, e: int, low: float, high: float) -> None:
        """Add a part of an edge to what is known."""
        parts = self.known[e]
        if len(parts) == 2 and parts[0] <= low and high <= parts[1]:
            return
        before: list[float] = []
        after: list[float] = []
        for k in range(0, len(parts), 2):
            if parts[k + 1] < low - CLOSE:
                before += parts[k : k + 2]
            elif parts[k] > high + CLOSE:
                after += parts[k : k + 2]
            else:
                low, high = min(low, parts[k]), max(high, parts[k + 1])
        parts = [*before, low, high, *after]
        self.known[e] = parts
        if parts[0] <= CLOSE and parts[1] >= self.size[e] - CLOSE:
            self.done[e] = True
            self.missing -= 1


def turn(x: float, y: float) -> float:
    """A number that grows with the angle of a direction, from -2 in the west around to 2."""
    share = y / (abs(x) + abs(y))
    if x >= 0.0:
        return share
    return 2.0 - share if y >= 0.0 else -2.0 - share
