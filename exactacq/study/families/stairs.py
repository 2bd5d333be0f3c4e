"""Staircases: outlines of unit steps, as grid maps draw slanted walls."""

from __future__ import annotations

from collections.abc import Callable

from flint import fmpq

from exactacq.scene.shapes import Circle, Polygon, Shape
from exactacq.study.dice import Dice
from exactacq.study.families.plan import Plan, Rectangle
from exactacq.study.families.rows import Tile, in_rows

Step = tuple[fmpq, fmpq]
Cells = list[tuple[int, int]]
"""Corners on the lattice of the steps."""
STEPS = ((1, 1), (1, 1), (2, 1), (1, 2))
"""Width and height of a step."""
EDGES = (4, 6, 8, 8, 12, 16, 24)
"""Edges of an outline."""


def staircases(dice: Dice, n: int, walled: bool) -> Plan:
    """Stairs, bands of stairs and stepped pyramids with *n* edges in all, a circle among them if n is odd.

    They stand in rows, turned about. The wall is a rectangle with stairs for corners.
    """
    width, height = dice.choice(STEPS)
    step = fmpq(width), fmpq(height)
    left = n - n % 2
    pieces = []
    while left:
        edges = dice.choice(EDGES)
        if left - edges < 4:
            edges = left
        pieces.append(_turned(dice, _drawn(dice, edges), step))
        left -= edges
    if n % 2:
        pieces.append(Tile(Circle((1, 1), 1), fmpq(2), fmpq(2)))
    gap = dice.choice((fmpq(1), fmpq(1), fmpq(1, 2), fmpq(3)))
    shapes, bounds, places = in_rows(pieces, gap)
    wall = _room(bounds, gap, dice.choice((1, 3)), step) if walled else None
    bite = min(step) / 2
    return Plan(shapes, wall, bounds, gap, step[0] + gap, bite, [*places, bounds.middle])


def stairs(steps: int) -> Cells:
    """Stairs down to the east: 2 edges a step, and 2."""
    down = [corner for k in range(steps) for corner in ((steps - k, k + 1), (steps - k - 1, k + 1))]
    return [(0, 0), (steps, 0), *down]


def band(steps: int) -> Cells:
    """A band two steps high between stairs up to the east: 4 edges a step."""
    up = [corner for k in range(steps) for corner in ((k, k), (k + 1, k))]
    return [*up, *((x, y + 2) for x, y in reversed(up))]


def pyramid(steps: int) -> Cells:
    """Steps up from both sides: 4 edges a step."""
    east = [corner for k in range(steps) for corner in ((2 * steps - k, k), (2 * steps - k, k + 1))]
    return [*east, *((2 * steps - x, y) for x, y in reversed(east))]


def _drawn(dice: Dice, edges: int) -> Cells:
    """An outline with that even number of edges."""
    makers: tuple[Callable[[int], Cells], ...] = (band, pyramid)
    if edges % 4 or dice.chance(40):
        return stairs((edges - 2) // 2)
    return dice.choice(makers)(edges // 4)


def _turned(dice: Dice, cells: Cells, step: Step) -> Tile:
    """The outline with steps of that size, perhaps mirrored."""
    high = max(x for x, _ in cells), max(y for _, y in cells)
    if dice.chance(50):
        cells = [(high[0] - x, y) for x, y in cells]
    if dice.chance(50):
        cells = [(x, high[1] - y) for x, y in cells]
    shape = Polygon([(x * step[0], y * step[1]) for x, y in cells])
    return Tile(shape, high[0] * step[0], high[1] * step[1])


def _room(bounds: Rectangle, gap: fmpq, steps: int, step: Step) -> Shape:
    """A rectangle that is wider by the gap and by its corners, which are stairs."""
    east, north = steps * step[0], steps * step[1]
    x, y = bounds.middle
    far = bounds.right - x + gap + east, bounds.top - y + gap + north
    # From the east's corner stairs to the north's, about the middle; the other quarters are their images.
    quarter = [
        corner
        for k in range(steps)
        for corner in (
            (far[0] - k * step[0], far[1] - north + k * step[1]),
            (far[0] - (k + 1) * step[0], far[1] - north + k * step[1]),
        )
    ]
    quarter.append((far[0] - east, far[1]))
    ring = [*quarter, *((-u, v) for u, v in reversed(quarter))]
    ring += [(-u, -v) for u, v in quarter] + [(u, -v) for u, v in reversed(quarter)]
    return Polygon([(x + u, y + v) for u, v in ring])
