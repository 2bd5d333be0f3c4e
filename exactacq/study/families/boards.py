"""Circuit boards: an outline with fillets and notches, mounting holes, and pads, pins and chips."""

from __future__ import annotations

from collections.abc import Iterator
from math import isqrt
from typing import NamedTuple

from flint import fmpq

from exactacq.scene.bends import Around
from exactacq.scene.shapes import Circle, Outline, Shape
from exactacq.study.dice import Dice
from exactacq.study.families.parts import around, box, moved, rounded, slot
from exactacq.study.families.plan import Corner, Plan, Rectangle

SITE = 12
"""Side of the square about each part."""
MARGIN = 6
"""From the sites to the edge of the board."""
FILLET = fmpq(3)
"""Radius of the board's corners; the holes are concentric with them."""
DEEP = 4
"""Depth of a notch: less than the margin."""
ONE, HALF = fmpq(1), fmpq(1, 2)


class Footprint(NamedTuple):
    """Shapes about the origin, and half the width and height that they take."""

    shapes: tuple[Shape, ...]
    wide: fmpq
    high: fmpq


def _pad(x: int, y: int) -> Shape:
    return box(around((fmpq(x), fmpq(y)), HALF))


def _slot(x: int) -> Shape:
    return slot(Rectangle(x - HALF, fmpq(-2), x + HALF, fmpq(2)))


PARTS = (
    Footprint(tuple(_pad(x, y) for y in (-2, 2) for x in (-3, -1, 1, 3)), 3 + HALF, 2 + HALF),
    Footprint(tuple(Circle((x, y), HALF) for y in (-1, 1) for x in (-2, 0, 2)), 2 + HALF, 1 + HALF),
    Footprint((rounded(around((fmpq(0), fmpq(0)), 2), ONE), _slot(-4), _slot(4)), 4 + HALF, 2 * ONE),
    Footprint(tuple(rounded(around((fmpq(x), fmpq(0)), ONE), HALF / 2) for x in (-2, 2)), 3 * ONE, ONE),
    Footprint((Circle((0, 0), 1),), ONE, ONE),
)
"""Two rows of pads, a header of pins, a chip between slots, two pads with fillets, a drill hole."""


def board(dice: Dice, n: int, walled: bool) -> Plan:
    """A board with *n* holes, pads and cases: up to four holes in the corners, the rest in parts on a grid.

    The wall is the board's edge, with a round notch in some sides.
    """
    holes = dice.choice((0, 2, 4)) if n > 8 else 0
    parts = list(_chosen(dice, n - holes))
    columns = max(1, isqrt(len(parts)) + dice.choice((0, 1)))
    rows = -(-len(parts) // columns)
    bounds = Rectangle(fmpq(0), fmpq(0), fmpq(columns * SITE), fmpq(rows * SITE))
    shapes: list[Shape] = []
    places: list[Corner] = []
    drawn = None
    for k, part in enumerate(parts):
        x, y = (k % columns) * SITE + SITE // 2, (k // columns) * SITE + SITE // 2
        shapes += [moved(shape, x, y) for shape in part.shapes]
        drawn = Rectangle(x - part.wide, y - part.high, x + part.wide, y + part.high).united(drawn)
        places += [(fmpq(x), fmpq(y)), (x + HALF * SITE, fmpq(y)), (fmpq(x), y + HALF * SITE)]
    edge = bounds.wider(MARGIN)
    inset = edge.wider(-FILLET)
    corners = [(inset.left, inset.top), (inset.right, inset.bottom)]
    corners += [(inset.left, inset.bottom), (inset.right, inset.top)]
    radius = dice.choice((ONE, fmpq(3, 2)))
    for corner in corners[:holes]:
        shapes.append(Circle(corner, radius))
        drawn = around(corner, radius).united(drawn)
    assert drawn is not None
    wall = _edge(edge, [dice.chance(40) for _ in range(4)]) if walled else None
    return Plan(shapes, wall, drawn, ONE, fmpq(2), HALF / 2, places)


def _chosen(dice: Dice, n: int) -> Iterator[Footprint]:
    """Parts of *n* shapes in all."""
    while n:
        part = dice.choice([part for part in PARTS if len(part.shapes) <= n])
        yield part
        n -= len(part.shapes)


def _edge(place: Rectangle, notched: list[bool]) -> Outline:
    """The board's edge; a side may have a notch in its middle, 2 wide, with a round end.

    From the south counterclockwise: each side is drawn towards the east and turned about the middle.
    """
    x, y = place.middle
    across, along = place.right - x, place.top - y
    vertices: list[tuple[object, ...]] = []
    for k, has_notch in enumerate(notched):
        long, far = (across, along) if k % 2 == 0 else (along, across)
        side: list[tuple[Corner, fmpq | Corner]] = [((FILLET - long, -far), fmpq(0))]
        if has_notch:
            side += [((-ONE, -far), fmpq(0)), ((-ONE, DEEP - 1 - far), fmpq(-1))]
            side += [((ONE, DEEP - 1 - far), fmpq(0)), ((ONE, -far), fmpq(0))]
        side.append(((long - FILLET, -far), (long - FILLET, FILLET - far)))
        for corner, bend in side:
            u, v = _quarter_turned(corner, k)
            if isinstance(bend, tuple):
                center = _quarter_turned(bend, k)
                vertices.append((x + u, y + v, Around((x + center[0], y + center[1]))))
            else:
                vertices.append((x + u, y + v, bend))
    return Outline(vertices)


def _quarter_turned(vector: Corner, times: int) -> Corner:
    x, y = vector
    for _ in range(times):
        x, y = -y, x
    return x, y
