"""Words of simple letters in lines of text, as on signs and title blocks."""

from __future__ import annotations

from math import isqrt

from flint import fmpq

from exactacq.scene.shapes import Shape
from exactacq.study.dice import Dice
from exactacq.study.families.letters import HEIGHT, LETTERS, WIDTH
from exactacq.study.families.parts import box, moved, rounded
from exactacq.study.families.plan import Corner, Plan, Rectangle

WORDS = (
    "HALT",
    "SCALE",
    "DATUM",
    "PLATE",
    "HOLE",
    "BOLT",
    "NUT",
    "DECA",
    "SLOT",
    "UNIT",
    "VIA",
    "ZONE",
    "JOIST",
)
"""Some have letters that no outline is given for; these are left out."""


def words(dice: Dice, n: int, walled: bool) -> Plan:
    """*n* letters in words, all as wide as the widest letter or each as wide as it is; many come again.

    The wall is a sign, with fillets or without.
    """
    gap = dice.choice((fmpq(1), fmpq(1, 2), fmpq(2)))
    is_even = dice.chance(50)
    line = HEIGHT + dice.choice((gap, fmpq(2), fmpq(3)))
    long = (WIDTH + gap) * max(3, isqrt(2 * n))
    shapes: list[Shape] = []
    places: list[Corner] = []
    x = y = east = fmpq(0)
    while len(shapes) < n:
        word = [letter for letter in dice.choice(WORDS) if letter in LETTERS][: n - len(shapes)]
        if x + len(word) * (WIDTH + gap) > long and x:
            x, y = fmpq(0), y - line
        for letter in word:
            shapes.append(moved(LETTERS[letter], x, y))
            width = fmpq(WIDTH) if is_even else _width(letter)
            places += [
                (x + width + gap / 2, y),
                (x + width + gap / 2, y + HEIGHT / fmpq(2)),
                (x, y - gap / 2),
            ]
            east = max(east, x + width)
            x += width + gap
        x += WIDTH
    bounds = Rectangle(fmpq(0), y, east, fmpq(HEIGHT))
    wall = None
    if walled:
        place = bounds.wider(dice.choice((gap, fmpq(3))))
        wall = rounded(place, gap) if dice.chance(50) else box(place)
    return Plan(shapes, wall, bounds, gap, WIDTH + gap, fmpq(1, 2), places)


def _width(letter: str) -> fmpq:
    """Where the letter ends in the east: at a vertex, or at the end of a bow between two."""
    return _WIDTHS.get(letter) or max(x for x, _, _ in LETTERS[letter].vertices)


_WIDTHS = {"B": fmpq(7, 2), "D": fmpq(4), "P": fmpq(4)}
"""Letters that end in a bow."""
