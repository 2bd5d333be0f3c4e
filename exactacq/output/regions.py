"""Strokes as Bezier curves and regions, and room for labels: for drawing only, nothing is decided here."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.path import Path as Outline

from exactacq.geometry.strokes import Floats, Stroke
from exactacq.scene.scene import Obstacle

MOVE, LINE, BEZIER, CLOSE = (
    int(code) for code in (Outline.MOVETO, Outline.LINETO, Outline.CURVE4, Outline.CLOSEPOLY)
)
BEND = math.pi / 8
"""Largest angle of an arc that one cubic Bezier curve stands for: it strays by less than 1e-7 radii."""


@dataclass(frozen=True, slots=True)
class Region:
    """An obstacle's outline in floats: ``outline`` of ``strokes`` closes on itself, ``points`` run along it,
    ``box`` (lower left, upper right) holds it."""

    strokes: Sequence[Stroke]
    outline: Outline
    points: Floats
    box: tuple[Floats, Floats]

    @classmethod
    def of(cls, obstacle: Obstacle) -> Region:
        """The region that an obstacle's boundary runs around."""
        return cls.around([edge.stroke() for edge in obstacle.edges])

    @classmethod
    def around(cls, strokes: Sequence[Stroke]) -> Region:
        """The region that a loop of strokes runs around."""
        outline = closed(strokes)
        extents = outline.get_extents()
        box = np.array(extents.min, dtype=float), np.array(extents.max, dtype=float)
        return cls(strokes, outline, np.concatenate([s.points()[:-1] for s in strokes]), box)

    def heart(self) -> tuple[tuple[float, float], float]:
        """A point well inside, and its distance to the boundary: the best of a grid."""
        low, high = self.box
        shares = (np.arange(24) + 0.5) / 24
        columns, rows = (low[k] + shares * (high[k] - low[k]) for k in (0, 1))
        grid = np.stack(np.meshgrid(columns, rows), -1).reshape(-1, 2)
        grid = np.vstack((grid, (low + high) / 2))
        inside = Outline(self.points).contains_points(grid)
        if not inside.any():
            return (float(low[0] + high[0]) / 2, float(low[1] + high[1]) / 2), 0.0
        grid = grid[inside]
        depth = clearance(grid, self.points, np.roll(self.points, -1, axis=0))
        off_centre = np.hypot(*((grid - (low + high) / 2) / np.maximum(high - low, 1e-300)).T)
        best = int(np.argmax(depth * (1 - 0.1 * off_centre)))
        return (float(grid[best, 0]), float(grid[best, 1])), float(depth[best])


@dataclass(frozen=True, slots=True)
class Steps:
    """A path in short steps: of each the drawable piece, the path length, place and heading at its middle,
    and the number of its stroke."""

    pieces: list[Outline]
    times: Floats
    mids: Floats
    headings: Floats
    owners: Floats

    @classmethod
    def of(cls, strokes: Sequence[Stroke], count: int) -> Steps:
        """About *count* steps of a path that has a length."""
        total = sum(stroke.length for stroke in strokes)
        pieces, times, mids, headings, owners = [], [], [], [], []
        done = 0.0
        for number, stroke in enumerate(strokes):
            parts = max(1, round(stroke.length / total * count)) if stroke.length else 0
            for k in range(parts):
                pieces.append(part(stroke, k / parts, (k + 1) / parts))
                middle = (k + 0.5) / parts
                times.append(done + middle * stroke.length)
                mids.append(stroke.at(middle))
                headings.append(stroke.heading(middle))
                owners.append(number)
            done += stroke.length
        return cls(pieces, np.array(times), np.array(mids), np.array(headings), np.array(owners))

    def ranks(self, strokes: Sequence[Stroke], places: Sequence[Hashable], tolerance: float) -> Any:
        """How often each step's middle was passed before, by earlier strokes along the same curve.

        Only strokes at the same of the *places* are compared.
        """
        groups: dict[Hashable, list[int]] = defaultdict(list)
        for number, place in enumerate(places):
            groups[place].append(number)
        ranks = np.zeros(len(self.owners), dtype=int)
        for members in groups.values():
            steps = np.flatnonzero(np.isin(self.owners, members))
            for number in members:
                later = steps[self.owners[steps] > number]
                if len(later):
                    ranks[later] += strokes[number].covers(self.mids[later], self.headings[later], tolerance)
        return ranks


def nodes(
    stroke: Stroke, first: float = 0.0, last: float = 1.0
) -> tuple[list[tuple[float, float]], list[int]]:
    """Vertices and codes of the part of a stroke between two fractions, without its first point."""
    if stroke.center is None:
        return [stroke.at(last)], [LINE]
    turned = abs(stroke.sweep) * (last - first)
    count = max(1, math.ceil(turned / BEND - 1e-9))
    handle = 4 / 3 * math.tan(turned / count / 4) * stroke.radius
    vertices = []
    for k in range(count):
        u, v = (first + (last - first) * step / count for step in (k, k + 1))
        (ax, ay), (bx, by), a, b = stroke.at(u), stroke.at(v), stroke.heading(u), stroke.heading(v)
        vertices += [
            (ax + handle * math.cos(a), ay + handle * math.sin(a)),
            (bx - handle * math.cos(b), by - handle * math.sin(b)),
            (bx, by),
        ]
    return vertices, [BEZIER] * len(vertices)


def part(stroke: Stroke, first: float, last: float) -> Outline:
    """The piece of a stroke between two fractions as a drawable path."""
    vertices, codes = nodes(stroke, first, last)
    return Outline([stroke.at(first), *vertices], [MOVE, *codes])


def closed(strokes: Iterable[Stroke]) -> Outline:
    """The closed outline of a loop of strokes."""
    vertices: list[tuple[float, float]] = []
    codes: list[int] = []
    for stroke in strokes:
        if not vertices:
            vertices, codes = [stroke.start], [MOVE]
        more, kinds = nodes(stroke)
        vertices, codes = vertices + more, codes + kinds
    return Outline([*vertices, vertices[0]], [*codes, CLOSE])


def clearance(points: Floats, starts: Floats, ends: Floats) -> Floats:
    """Distance of each point to the nearest of the segments."""
    least = np.full(len(points), np.inf)
    for start, end in zip(starts, ends, strict=True):
        along = end - start
        size = float(along @ along)
        share = np.clip((points - start) @ along / size, 0, 1) if size else np.zeros(len(points))
        least = np.minimum(least, np.hypot(*(points - start - share[:, None] * along).T))
    return least
