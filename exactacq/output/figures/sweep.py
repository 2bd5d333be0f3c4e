"""What pictures of a sweep show besides: the M-line, its crossing points, diversions, components as regions.

In floats: for drawing only.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf

import numpy as np

from exactacq.errors import FormatError
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.geometry.strokes import Stroke
from exactacq.output.regions import Region
from exactacq.scene.edge_table import EdgeTable, Floats
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Terrain
from exactacq.scene.terrain_components import Component, Ground
from exactacq.sensing.event import EventKind
from exactacq.strategies.run import Run, SeedSpreaderRun
from exactacq.strategies.seed_spreader.blocked import Blocking
from exactacq.strategies.seed_spreader.mline import MLine

BEYOND = 0.12
"""Of an obstacle that crosses the border this share of the terrain's longer side is shown beyond it."""

FINEST = 1e-9
"""Size over distance from the origin of a scene that is about to be lost in floating point."""

Spot = tuple[float, float]


@dataclass(frozen=True)
class Detour:
    """A diversion from ``leave`` (D) to ``hit`` (Q; None if it was not reached), its pieces of the path."""

    leave: Spot
    hit: Spot | None
    pieces: range


class SweptTerrain:
    """What the terrain looks like to a run that is confined to it; only the Seed Spreader has an M-line."""

    def __init__(self, run: Run, ground: Ground) -> None:
        self.terrain, self.ground = ground.terrain, ground
        self.line: Sequence[Segment] = ()
        self.width, self.arrives = inf, True
        self.crossings: list[Spot] = []
        self.detours: list[Detour] = []
        if isinstance(run, SeedSpreaderRun):
            self._sweep(run)
        self.regions = [component_region(component, ground.terrain) for component in ground.components]

    def _sweep(self, run: SeedSpreaderRun) -> None:
        mline = MLine(self.terrain, run.radius)
        self.line, self.width = mline.pieces, float(mline.width)
        crossings = mline.crossings(Blocking(self.ground, EdgeTable(run.scene.obstacles)))
        self.crossings = list(dict.fromkeys(crossing.stop.point.xy for crossing in crossings))
        self.arrives = bool(run.path) and run.path[-1].end == mline.pieces[-1].end
        self.detours = [Detour(d.leave.xy, d.hit.xy, range(d.first, d.last)) for d in run.diversions]
        starts = [event for event in run.events if event.kind is EventKind.DIVERT]
        # One at most: an obstacle closes the way there or back, and the run ends.
        for event in starts[len(self.detours) :]:
            self.detours.append(Detour(event.point.xy, None, range(event.after, len(run.path))))

    @classmethod
    def of(cls, run: Run) -> SweptTerrain | None:
        """The terrain of a run that is confined to it, else None."""
        return None if run.ground is None else cls(run, run.ground)

    @property
    def corners(self) -> list[Spot]:
        """The corners of the M-line, S and T included."""
        return [self.line[0].start.xy, *(piece.end.xy for piece in self.line)]

    @property
    def away(self) -> set[int]:
        """The numbers of the pieces of the path that belong to diversions."""
        return {number for detour in self.detours for number in detour.pieces}

    def is_whole(self, obstacle: int) -> bool:
        """Whether an obstacle of the scene lies within the border and in reach."""
        parts = self.ground.of(obstacle)
        return len(parts) == 1 and parts[0].closed and bool(parts[0].shore)


def window(scene: Scene, corners: Sequence[Floats], radius: float, swept: bool) -> tuple[Floats, Floats]:
    """The rectangle about what is shown of a scene: the terrain, and *corners* of whatever else is drawn.

    What lies beyond the terrain of a sweep is shown in part; a single point gets a window as wide as the
    radius. Raises `FormatError` for a scene that is `FINEST` times its distance from the origin or less.
    """
    if scene.terrain is not None:
        west, south, east, north = map(float, scene.terrain.limits)
        first, last = np.array([west, south]), np.array([east, north])
        slack = BEYOND * (last - first).max() if swept else np.inf
        corners = [first, last, *(np.clip(corner, first - slack, last + slack) for corner in corners)]
    corners = corners or [np.zeros(2)]
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    if not (high - low).any():
        low, high = low - radius, high + radius
    check_size(low, high)
    return low, high


def check_size(low: Floats, high: Floats) -> None:
    """`FormatError` for a rectangle that is `FINEST` times its distance from the origin or less."""
    if not np.max(high - low) > np.max(np.abs((low, high))) * FINEST:
        raise FormatError("too small to be drawn so far from the origin; move the scene closer")


def turning_places(run: Run) -> list[Point]:
    """Where straight pieces of a run's path end; the rest lies on boundaries.

    A strategy of the user's own may lead the robot far from all obstacles.
    """
    straight = (piece.curve for piece in run.path if piece.kind == "straight")
    return [place for curve in straight for place in (curve.start, curve.end)]


def component_region(component: Component, terrain: Terrain) -> Region:
    """A component as a region: where its boundary ends at the border, it is closed along that."""
    return Region.around(list(_around(component, terrain)))


def _around(component: Component, terrain: Terrain) -> Iterator[Stroke]:
    shores = [[part.curve for part in shore] for shore in (component.shore, *component.hidden) if shore]
    if component.closed:
        yield from (curve.stroke() for shore in shores for curve in shore)
        return
    border = _BorderLength(terrain)
    left, shore = shores[1:], shores[0]
    while True:
        yield from (curve.stroke() for curve in shore)
        here = shore[-1].end.xy
        # From the end of a boundary the border is blocked counterclockwise, as far as the next start of one.
        following = min([shores[0], *left], key=lambda other: border.ahead(here, other[0].start.xy))
        yield from border.along(here, following[0].start.xy)
        if following is shores[0]:
            return
        left, shore = [other for other in left if other is not following], following


class _BorderLength:
    """The border counterclockwise from the SW corner, by its length."""

    def __init__(self, terrain: Terrain) -> None:
        west, south, east, north = map(float, terrain.limits)
        self.limits = west, south, east, north
        self.corners: list[Spot] = [(west, south), (east, south), (east, north), (west, north)]
        width, height = east - west, north - south
        self.marks = [0.0, width, width + height, 2 * width + height]
        self.length = 2 * (width + height)

    def at(self, spot: Spot) -> float:
        """The length of the border from the SW corner to a spot on it."""
        (x, y), (west, south, east, north) = spot, self.limits
        gaps = [abs(y - south), abs(x - east), abs(y - north), abs(x - west)]
        _, first, second, third = self.marks
        on = [x - west, first + y - south, second + east - x, third + north - y]
        return on[int(np.argmin(gaps))]

    def ahead(self, spot: Spot, other: Spot) -> float:
        """The length of the border from one spot on to another."""
        return (self.at(other) - self.at(spot)) % self.length

    def along(self, spot: Spot, other: Spot) -> Iterator[Stroke]:
        """The border from one spot on to another."""
        gap, at = self.ahead(spot, other), self.at(spot)
        ways = [
            ((mark - at) % self.length, corner) for mark, corner in zip(self.marks, self.corners, strict=True)
        ]
        stops = [spot, *(corner for way, corner in sorted(ways) if 0 < way < gap), other]
        for p, q in pairwise(stops):
            yield Stroke(p, q, float(np.hypot(q[0] - p[0], q[1] - p[1])))
