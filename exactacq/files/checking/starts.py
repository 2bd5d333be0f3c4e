"""A place to start from, and a radius of vision, for a file that tells none.

The start is a roomy place where most loops are obstacles, with coordinates of few digits. The radius is
chosen by the widest gap that has to be bridged so that links lead from the start to every obstacle: the
widest link of a shortest tree between them. No third obstacle can stand in the way of such a link, for it
would be nearer to one end than the other end is.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import floor, log10

import numpy as np
from flint import fmpq
from numpy.typing import NDArray

from exactacq.errors import FormatError, InvalidScene, Undecided
from exactacq.files.checking.sketch import Bools, Sketch
from exactacq.files.loops.contents import AS_TOLD, Contents
from exactacq.files.rereading import once
from exactacq.geometry.strokes import Floats
from exactacq.numbers.rationals import rational
from exactacq.scene.scene import Scene

WORK = 10_000_000
"""Pairs of a place and a chord that the search for a start looks at, about half a second's worth."""
FEWEST, MOST = 20, 100
"""Places of the grid along each side, at least and at most."""
ZOOMS = 3
"""How often the best place is looked for again on a finer grid."""
BEYOND = 0.1
"""How far places are looked for around everything, as a part of its size."""
OUTSIDE = 0.01
"""Such a part of the clearance counts beyond the box of all loops, where to start only if it is full."""
WITHIN = 8
"""Room within loops counts so many times."""
NO_ROOM = 1e-9
"""Room below this part of the size is none."""
REGIONS = 4
"""How many free places, parted by loops, are tried."""
POINTS = 6000
"""Points of boundaries between which the shortest tree is sought: quadratic in them."""
MORE = 1.5
"""The radius is so many times the widest gap: who sees just that far sees hardly more than a point there."""

Place = tuple[fmpq, fmpq]
Whole = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Beginning:
    """A start that a scene was made around."""

    start: Place
    scene: Scene
    is_first: bool
    """Whether it was the first choice."""


@dataclass(frozen=True, slots=True)
class _RoomyPlace:
    """A place of a grid, the roomiest one of those that have the same loops around them."""

    place: Floats
    around: Bools
    room: float


@dataclass(frozen=True, slots=True)
class _SurveyedGrid:
    """The roomy places of a grid in its order, its steps, and the size of everything."""

    roomy: list[_RoomyPlace]
    step: Floats
    size: float

    def roomiest(self, sketch: Sketch, k: int) -> tuple[Floats, float]:
        """The roomiest place near one of them, and its room."""
        near = self.roomy[k]
        return once(("roomiest", sketch, k), lambda: _roomier(sketch, near.place, near.around, self.step))


def beginning(contents: Contents, again: Callable[[Place], Contents]) -> Beginning | None:
    """The start that is given, or else the first one proposed, with which there is a scene.

    *again* reads the contents around a start. The search for starts is bounded by `WORK`.
    """
    for choice, start in enumerate(starts(contents) if contents.start is None else [contents.start]):
        try:
            scene = again(start).scene(advise=False)
        except (FormatError, InvalidScene, Undecided):
            continue
        return Beginning(start, scene, choice == 0)
    return None


def starts(contents: Contents) -> Iterator[Place]:
    """Roomy places, of which those come first where most loops are obstacles; not verified."""
    wall = () if contents.wall is None else (contents.wall,)
    sketch = Sketch.of([*contents.loops, *wall])
    if sketch.is_empty:
        if contents.startless == "":
            yield fmpq(0), fmpq(0)
        return
    grid = once(("grid", sketch), lambda: _surveyed(sketch))
    ranked: list[tuple[int, float, int]] = []
    for k, roomy in enumerate(grid.roomy):
        score = _obstacles(contents, sketch, roomy.around)
        if score is not None:
            # Within loops rather than beyond, but not within the walls of a plan, if it has rooms.
            ranked.append((score, roomy.room * (WITHIN if roomy.around.any() else 1), k))
    for *_, k in sorted(ranked, reverse=True)[:REGIONS]:
        place, room_there = grid.roomiest(sketch, k)
        if room_there > NO_ROOM * grid.size:
            yield rounded(place, room_there)


def rounded(place: Floats, clear: float) -> Place:
    """Coordinates with as few digits as a move by less than a fifth of the clearance allows.

    With steps of 10^k <= clear / 4 each coordinate moves by clear / 8 at most, both by less than 0.18 clear.

    >>> print(*rounded(np.array([12.3456, -7.891]), 2.0))
    123/10 -79/10
    """
    digits = -floor(log10(clear / 4))
    step = fmpq(10) ** -digits
    x, y = (fmpq((rational(float(c)) / step + fmpq(1, 2)).floor()) * step for c in place)
    return x, y


def rounded_up(value: float) -> fmpq:
    """A number of two digits that is at least a positive value.

    >>> print(rounded_up(123.4), rounded_up(0.051))
    130 51/1000
    """
    unit = fmpq(10) ** (floor(log10(value)) - 1)
    return fmpq((rational(value) / unit).ceil()) * unit


def vision(scene: Scene) -> tuple[fmpq, float]:
    """The radius of vision that a scene has or may be given, and the gap that this is chosen by."""
    gap = widest_gap(scene)
    return scene.radius or rounded_up(MORE * gap), gap


def widest_gap(scene: Scene) -> float:
    """The widest link of a shortest tree between the start and the obstacles, or a little more.

    Those that are far from nearly everything else do not count (see `main_box`).

    It is sought between points of the boundaries, at most about `POINTS` of them, so it is never too small.
    Without obstacles it is 1.
    """
    assert scene.start is not None, "a gap is asked for scenes with a start"
    sketch = Sketch.of([*scene.shapes, *([] if scene.enclosure is None else [scene.enclosure])])
    if sketch.is_empty:
        return 1.0
    if sketch.count > 2 * POINTS:
        return float(np.hypot(*(sketch.box[1] - sketch.box[0])))
    lengths = np.hypot(*(sketch.ends - sketch.starts).T)
    spacing = float(lengths.sum()) / (POINTS / 2)
    counts = np.minimum(np.ceil(lengths / spacing), POINTS).astype(int)
    owners = np.repeat(np.repeat(np.arange(sketch.count), np.diff(sketch.begin)), counts)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    share = ((np.arange(counts.sum()) - first) / np.repeat(counts, counts))[:, None]
    points = (
        np.repeat(sketch.starts, counts, axis=0) * (1 - share)
        + np.repeat(sketch.ends, counts, axis=0) * share
    )
    low, high = sketch.main_box
    near = np.unique(owners[((low <= points) & (points <= high)).all(axis=1)])
    points, owners = points[np.isin(owners, near)], owners[np.isin(owners, near)]
    if len(points) > 2 * POINTS:
        points, owners = _thinned(points, owners)
    return _tree(points, owners, np.array(scene.start.xy))


def _thinned(points: Floats, owners: Whole) -> tuple[Floats, Whole]:
    """Every n-th point, and the first one of each loop."""
    keep = np.zeros(len(points), dtype=bool)
    keep[:: len(points) // POINTS] = True
    keep[np.unique(owners, return_index=True)[1]] = True
    return points[keep], owners[keep]


def _tree(points: Floats, owners: Whole, start: Floats) -> float:
    """The widest link of a shortest tree from a start through loops, each of which is walked for nothing."""
    nearest = np.hypot(*(points - start).T)
    widest = 0.0
    left = np.ones(len(points), dtype=bool)
    while left.any():
        near = int(np.argmin(np.where(left, nearest, np.inf)))
        widest = max(widest, float(nearest[near]))
        joined = owners == owners[near]
        left &= ~joined
        others = np.flatnonzero(left)
        for point in points[joined]:
            nearest[others] = np.minimum(nearest[others], np.hypot(*(points[others] - point).T))
    return widest or 1.0


def _surveyed(sketch: Sketch) -> _SurveyedGrid:
    """A grid that reaches a little beyond everything."""
    low, high = sketch.main_box
    size = float(max(high - low)) or 1.0
    side = int(np.clip(np.sqrt(WORK / 2 / len(sketch.starts)), FEWEST, MOST))
    places, step = _grid(low - BEYOND * size, high + BEYOND * size, side)
    around, room = sketch.around(places), _room(sketch, places)
    groups: defaultdict[bytes, list[int]] = defaultdict(list)
    for i, row in enumerate(np.packbits(around, axis=1)):
        groups[row.tobytes()].append(i)
    best = sorted(max(members, key=lambda i: room[i]) for members in groups.values())
    return _SurveyedGrid([_RoomyPlace(places[i], around[i], float(room[i])) for i in best], step, size)


def _obstacles(contents: Contents, sketch: Sketch, around: Bools) -> int | None:
    """How many boundaries the scene has around a place with such loops around it; None if it is not free."""
    depth = int(around.sum())
    if contents.outer == AS_TOLD:
        walls = np.zeros(sketch.count, dtype=bool)
        walls[len(contents.loops) :] = True
        return int(sketch.count) if (around == walls).all() else None
    loops = len(contents.loops)
    if around[loops - contents.walls : loops].any():
        return None
    if (contents.outer in ("wall", "drop") and depth > 1) or contents.free not in (None, depth % 2):
        return None
    if contents.outer == "drop":
        if not depth:
            return None
        inner = sketch.nesting & ~around
        return int((~inner.any(axis=1)).sum()) - depth
    return int((sketch.nesting == around).all(axis=1).sum()) + bool(depth)


def _grid(low: Floats, high: Floats, side: int) -> tuple[Floats, Floats]:
    step = (high - low) / side
    columns, rows = (low[k] + (np.arange(side) + 0.5) * step[k] for k in (0, 1))
    return np.stack(np.meshgrid(columns, rows), -1).reshape(-1, 2), step


def _room(sketch: Sketch, places: Floats) -> Floats:
    """How good places are: their clearance, also from the border of the box of all loops."""
    low, high = sketch.main_box
    clear, border = sketch.clearance(places), np.minimum(places - low, high - places).min(axis=1)
    return np.where(border > 0, np.minimum(clear, border), OUTSIDE * clear)


def _roomier(sketch: Sketch, place: Floats, around: Bools, step: Floats) -> tuple[Floats, float]:
    """The roomiest place near a place with the same loops around it, and its room."""
    clear = float(_room(sketch, place[None])[0])
    for _ in range(ZOOMS):
        places, finer = _grid(place - step, place + step, 7)
        same = (sketch.around(places) == around).all(axis=1)
        room = np.where(same, _room(sketch, places), 0.0)
        best = int(np.argmax(room))
        if room[best] > clear:
            place, clear = places[best], float(room[best])
        step = finer
    return place, clear
