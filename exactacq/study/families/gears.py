"""Gears: teeth of arcs about the shaft and of lines, in trains, and within a ring gear.

The corners of teeth lie at rational points of the circles, at equal angles but for less than a percent of a
turn's tooth, symmetric about the shaft's vertical line.
"""

from __future__ import annotations

from math import pi, tan

from flint import fmpq

from exactacq.scene.bends import Around
from exactacq.scene.shapes import Circle, Outline
from exactacq.study.dice import Dice
from exactacq.study.families.plan import Corner, Plan
from exactacq.study.families.rows import Tile, in_rows

FINENESS = 500
"""Half tangents of angles are multiples of 1 / FINENESS."""
TEETH = (1, 2, 3, 4, 5, 6, 8, 12)
"""Teeth of a gear."""
PITCH = fmpq(1, 2)
"""Radius of a gear for each of its teeth."""


def gears(dice: Dice, n: int, walled: bool) -> Plan:
    """Gears with *n* edges in all, four a tooth; the rest of that division are shafts, circles of one edge.

    They stand in rows. The wall is a ring gear.
    """
    teeth = n // 4
    slope = dice.choice((fmpq(1), fmpq(1), fmpq(3, 4), fmpq(1, 2)))
    pieces: list[Tile] = []
    while teeth:
        count = min(teeth, dice.choice(TEETH))
        root = max(fmpq(2), PITCH * count)
        tip = root + 1
        pieces.append(Tile(gear((tip, tip), count, root, tip, slope), 2 * tip, 2 * tip))
        teeth -= count
    pieces += [Tile(Circle((1, 1), 1), fmpq(2), fmpq(2))] * (n % 4)
    gap = dice.choice((fmpq(1, 3), fmpq(1), fmpq(2)))
    shapes, bounds, places = in_rows(pieces, gap)
    x, y = bounds.middle
    wall = None
    if walled:
        root = (bounds.right - x) + (bounds.top - y) + gap
        wall = gear((x, y), dice.choice((3, 8, 13)), root, root + 2, slope)
    return Plan(shapes, wall, bounds, gap, pieces[0].width + gap, fmpq(1, 2), [*places, (x, y)])


def gear(center: Corner, teeth: int, root: fmpq, tip: fmpq, slope: fmpq) -> Outline:
    """A gear with arcs about its centre, the first tooth upright.

    *slope* is the angle of a tooth's tip over that of its foot: with 1 the flanks lead to the centre.
    """
    x, y = center
    vertices: list[tuple[object, ...]] = []
    for k in range(teeth):
        foot = fmpq(1, 4 * teeth)
        for turn, radius, turns in (
            (fmpq(k, teeth) - foot, root, False),
            (fmpq(k, teeth) - foot * slope, tip, True),
            (fmpq(k, teeth) + foot * slope, tip, False),
            (fmpq(k, teeth) + foot, root, True),
        ):
            east, north = _direction(turn)
            vertex = x + radius * east, y + radius * north
            vertices.append((*vertex, Around(center)) if turns else vertex)
    return Outline(vertices)


def _direction(turn: fmpq) -> Corner:
    """About the direction at a share of a full turn, counterclockwise from the north, at most a turn.

    A point of the unit circle with rational coordinates. Opposite turns give mirror images, east and west.
    """
    if turn < 0 or turn > fmpq(1, 2):
        east, north = _direction(-turn if turn < 0 else 1 - turn)
        return -east, north
    if turn > fmpq(1, 4):
        east, north = _direction(fmpq(1, 2) - turn)
        return east, -north
    t = fmpq(round(tan(pi * int(turn.p) / int(turn.q)) * FINENESS), FINENESS)
    return -2 * t / (1 + t * t), (1 - t * t) / (1 + t * t)
