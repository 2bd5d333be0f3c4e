"""Slots in rows: stadiums side by side, row by row, as in ventilation grilles and perforated sheets."""

from __future__ import annotations

from math import isqrt

from flint import fmpq

from exactacq.scene.shapes import Shape
from exactacq.study.dice import Dice
from exactacq.study.families.parts import box, rounded, slot
from exactacq.study.families.plan import Corner, Plan, Rectangle

SIZES = ((6, 2), (4, 2), (2, 8), (3, 3), (5, 1))
"""Width and height of a slot."""


def slots(dice: Dice, n: int, walled: bool) -> Plan:
    """*n* slots in rows, aligned or shifted by half a pitch, the last row perhaps shorter.

    The ends of all are half circles, or fillets, or pairs of quarter circles; in some sheets every other slot
    stands upright. The wall is a rectangle, a larger slot, or one with fillets that are concentric with those
    in the corners.
    """
    width, height = (fmpq(side) for side in dice.choice(SIZES))
    is_woven = dice.chance(25) and width > height
    gap = fmpq(dice.choice((1, 2, 3)))
    pitch, rise = width + gap, (width if is_woven else height) + dice.choice((gap, fmpq(1), fmpq(2)))
    shift = dice.choice((fmpq(0), pitch / 2))
    share = dice.choice((fmpq(0), fmpq(1, 4), fmpq(1, 2)))
    columns = max(2, isqrt(int(n * rise / pitch)))
    shapes: list[Shape] = []
    places: list[Corner] = []
    for k in range(n):
        row, column = divmod(k, columns)
        x, y = column * pitch + shift * (row % 2), row * rise
        is_upright = is_woven and (row + column) % 2 == 1
        w, h = (height / 2, width / 2) if is_upright else (width / 2, height / 2)
        place = Rectangle(x - w, y - h, x + w, y + h)
        shapes.append(rounded(place, share * min(width, height)) if share else slot(place))
        places += [(x + pitch / 2, y), (x, y + rise / 2), (x + pitch / 2, y + rise / 2)]
    last = (n - 1) // columns
    east = (min(n, columns) - 1) * pitch + (shift if last else 0)
    bounds = Rectangle(-width / 2, -(width if is_woven else height) / 2, east + width / 2, last * rise)
    bounds = bounds._replace(top=bounds.top - bounds.bottom)
    wall = _sheet(dice, bounds.wider(gap), gap + share * min(width, height)) if walled else None
    return Plan(shapes, wall, bounds, gap, pitch, min(width, height) / 4, places)


def _sheet(dice: Dice, place: Rectangle, radius: fmpq) -> Shape:
    kind = dice.below(3)
    if kind == 0:
        return box(place)
    if kind == 1:
        return rounded(place, radius)
    # A slot's ends are round: it is longer by its height, so that they are off the rows.
    half = (place.top - place.bottom) / 2
    return slot(Rectangle(place.left - half, place.bottom, place.right + half, place.top))
