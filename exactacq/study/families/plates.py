"""Plates with pins on a grid: square, staggered or of equal distances; symmetric about the line x = 0."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from flint import fmpq

from exactacq.scene.shapes import Circle, Shape
from exactacq.study.dice import Dice
from exactacq.study.families.parts import around, box, chamfered, diamond, rounded
from exactacq.study.families.plan import Corner, Plan, Rectangle

GRIDS = ((8, 8, 0, 8), (8, 7, 4, 8), (6, 4, 3, 5), (8, 6, 0, 6))
"""Distance in a row, from row to row, how far every other row is shifted, and the least distance of two.

Square; nearly hexagonal; with distances 5 and 6, from legs 3 and 4; oblong with diagonal 10.
"""
PINS: tuple[Callable[[Corner, fmpq], Shape], ...] = (
    Circle,
    lambda center, half: box(around(center, half)),
    lambda center, half: chamfered(around(center, half), half / 2),
    lambda center, half: diamond(around(center, half)),
    lambda center, half: rounded(around(center, half), half / 2),
    lambda center, half: rounded(around(center, half), half),
)
"""Each has the mirror symmetry of the plate."""


def plate(dice: Dice, n: int, walled: bool) -> Plan:
    """A plate with *n* pins, some of the grid's places empty; the pins of a row are alike.

    The wall is the plate's edge: square, chamfered, with fillets, or a circle.
    """
    pitch, rise, shift, least = dice.choice(GRIDS)
    half = fmpq(dice.choice((2, 3, 4) if rise > 4 else (1, 2, 3)), 2)
    columns = _columns(n, pitch, rise)
    spare = dice.choice((0, 0, n // 6, n // 3))
    centers = list(_centers(n + spare, columns, pitch, rise, shift))
    _thin(dice, centers, n)
    kinds = [dice.choice(PINS) for _ in range(dice.choice((1, 1, 2)))]
    shapes = [kinds[int(y / rise) % len(kinds)]((x, y), half) for x, y in centers]
    west, east = min(x for x, _ in centers), max(x for x, _ in centers)
    south, north = min(y for _, y in centers), max(y for _, y in centers)
    bounds = Rectangle(west, south, east, north).wider(half)
    gap = least - 2 * half
    wall = _edge(dice, bounds, gap) if walled else None
    return Plan(shapes, wall, bounds, gap, fmpq(pitch), half, list(_places(centers, pitch, rise)))


def _columns(n: int, pitch: int, rise: int) -> int:
    """An odd number, at least 3, of columns of about a square plate."""
    columns = 3
    while (columns + 1) ** 2 * pitch < n * rise:
        columns += 2
    return columns


def _centers(count: int, columns: int, pitch: int, rise: int, shift: int) -> Iterator[Corner]:
    """Whole rows of centres, mirror symmetric, at least *count* in all; shifted rows have one fewer."""
    row = made = 0
    while made < count:
        width = columns - (row % 2 if shift else 0)
        for k in range(width):
            yield fmpq((2 * k - width + 1) * pitch, 2), fmpq(row * rise)
        made, row = made + width, row + 1


def _thin(dice: Dice, centers: list[Corner], n: int) -> None:
    """Take centres away until *n* are left: one on the axis if that many are odd, the others in pairs."""
    if (len(centers) - n) % 2:
        centers.remove(dice.choice([c for c in centers if c[0] == 0]))
    while len(centers) > n:
        x, y = dice.choice(centers)
        if x:
            centers.remove((x, y))
            centers.remove((-x, y))
        elif not any(x for x, _ in centers):
            del centers[:2]


def _edge(dice: Dice, bounds: Rectangle, gap: fmpq) -> Shape:
    place = bounds.wider(dice.choice((gap, gap / 2, fmpq(3))))
    kind = dice.below(4)
    if kind == 0:
        return box(place)
    if kind == 1:
        return chamfered(place, gap / 2)
    if kind == 2:
        return rounded(place, gap / 2)
    center = place.middle
    # The half perimeter exceeds the half diagonal.
    return Circle(center, (place.right - center[0]) + (place.top - center[1]))


def _places(centers: list[Corner], pitch: int, rise: int) -> Iterator[Corner]:
    """On the axis, between neighbours of a row, and in the middle of four."""
    for x, y in centers:
        yield fmpq(0), y + fmpq(rise, 2)
        yield x + fmpq(pitch, 2), y
        yield x + fmpq(pitch, 2), y + fmpq(rise, 2)
