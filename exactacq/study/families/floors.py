"""Floor plans: rooms between walls of one thickness, with doors, and pillars in the rooms.

Drawn on a grid of unit cells, of which the walls' outlines are taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isqrt
from typing import NamedTuple

import numpy as np
from flint import fmpq

from exactacq.files.grids.outlines import STEPS, Cells, outlines
from exactacq.scene.shapes import Circle, Polygon, Shape
from exactacq.study.dice import Dice
from exactacq.study.families.parts import around, box, rounded
from exactacq.study.families.plan import Corner, Plan, Rectangle

SIDES = (6, 6, 8, 10)
"""Inner widths of rooms, in cells."""
DOOR = 2
"""Width of a door."""
SPACING = 2
"""From one pillar to the next, and from the first to the wall."""
HALF = fmpq(1, 2)
PILLARS: tuple[Callable[[Corner], Shape], ...] = (
    lambda center: Circle(center, HALF),
    lambda center: box(around(center, HALF)),
    lambda center: rounded(around(center, HALF), HALF / 2),
)


class Span(NamedTuple):
    """The cells of a room along one axis: the first, and the one after the last, which is a wall's."""

    first: int
    end: int


def floor_plan(dice: Dice, n: int, walled: bool) -> Plan:
    """A storey with *n* obstacles: pieces of inner walls, and pillars.

    Some rooms are joined by doors so that all can be reached; other walls have a door, two, none, or are left
    out. The wall is that of the building, with the inner walls that are joined to it. Without it these reach
    over the border of what was the building's inside.
    """
    rooms = max(2, n // dice.choice((2, 3)))
    columns = max(1, isqrt(rooms) - dice.choice((0, 0, 1)))
    across, along = _spans(dice, columns), _spans(dice, -(-rooms // columns))
    blocked = _storey(dice, across, along)
    if not walled:
        _open(blocked)
    rings = sorted(outlines(blocked), key=_size)
    outer = rings[-2] if walled else None
    pieces: list[Shape] = [_polygon(ring) for ring in (rings[:-2] if walled else rings)]
    sites = list(_sites(across, along))
    shape = dice.choice(PILLARS)
    while len(pieces) < n:
        pieces.append(shape(sites.pop(dice.below(len(sites)))))
    bounds = Rectangle(fmpq(0), fmpq(0), fmpq(across[-1].end + 1), fmpq(along[-1].end + 1))
    places = [(fmpq(x.first + x.end, 2), fmpq(y.first + y.end, 2)) for x in across for y in along]
    places += [(x.end + HALF, y + dice.below(8)) for x in across[:-1] for _, y in places]
    wall = None if outer is None else _polygon(outer)
    return Plan(pieces, wall, bounds, fmpq(SPACING - 1), fmpq(SPACING), fmpq(1), places)


def _spans(dice: Dice, count: int) -> list[Span]:
    """Rooms one beside the other, with walls of one cell before, between and after."""
    side = 0 if dice.chance(50) else dice.choice(SIDES)
    spans, first = [], 1
    for _ in range(count):
        end = first + (side or dice.choice(SIDES))
        spans.append(Span(first, end))
        first = end + 1
    return spans


def _storey(dice: Dice, across: list[Span], along: list[Span]) -> Cells:
    """The blocked cells: all walls but for the openings."""
    blocked = np.ones((along[-1].end + 1, across[-1].end + 1), dtype=np.bool_)
    for y in along:
        for x in across:
            blocked[y.first : y.end, x.first : x.end] = False
    for j, y in enumerate(along):
        for i, x in enumerate(across):
            # One wall of each room leads on, to the east or to the north: so all rooms are joined.
            on = [way for way, is_there in ((0, i + 1 < len(across)), (1, j + 1 < len(along))) if is_there]
            sure = dice.choice(on) if on else None
            for way in on:
                side = y if way == 0 else x
                for opening in _openings(dice, side, way == sure):
                    if way == 0:
                        blocked[opening, x.end] = False
                    else:
                        blocked[y.end, opening] = False
    return blocked


def _openings(dice: Dice, side: Span, is_needed: bool) -> Iterator[slice]:
    """Of a wall along a side of a room: doors anywhere, or all of it."""
    kind = dice.below(10)
    if kind == 0:
        yield slice(side.first, side.end)
    elif kind < 7 or is_needed:
        for _ in range(2 if kind == 1 else 1):
            door = dice.between(side.first, side.end - DOOR)
            yield slice(door, door + DOOR)


def _open(blocked: Cells) -> None:
    """Take the building's wall away, but for where inner walls end in it."""
    for rim, next_to in ((0, 1), (-1, -2)):
        blocked[rim, :] &= blocked[next_to, :]
        blocked[:, rim] &= blocked[:, next_to]
    blocked[[0, 0, -1, -1], [0, -1, 0, -1]] = False


def _sites(across: list[Span], along: list[Span]) -> Iterator[Corner]:
    """Where pillars may stand."""
    for y in along:
        for x in across:
            for v in range(y.first + SPACING, y.end - 1, SPACING):
                for u in range(x.first + SPACING, x.end - 1, SPACING):
                    yield fmpq(u), fmpq(v)


def _polygon(ring: list[tuple[int, int]]) -> Polygon:
    return Polygon([(fmpq(x, STEPS), fmpq(y, STEPS)) for x, y in ring])


def _size(ring: list[tuple[int, int]]) -> int:
    """The half perimeter of a ring's bounding box: the building's wall has the two longest."""
    (west, east), (south, north) = (sorted(axis)[:: len(ring) - 1] for axis in zip(*ring, strict=True))
    return int(east - west + north - south)
