"""Terrains as the paper describes them in its figures, plain enough for proofs by hand.

The gallery has livelier ones of the same descriptions; what is proved on paper is proved for these.
"""

from __future__ import annotations

from flint import fmpq

from exactacq.numbers.rationals import rational
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Polygon, Shape, Terrain

REACH = 10
"""The radius, the width of a strip, and the gap between neighbours of a column."""
AXIS = 6
"""All shapes of a column are symmetric about x = AXIS, so that the first is REACH from (0, 0)."""
FOOT = 8
"""The height of the lowest tip of a column."""
RHOMBUS = ((rational("3/2"), 2), (0, 4))
HOURGLASS = ((rational("3/2"), 2), (rational("3/4"), 3), (rational("3/2"), 4), (0, 6))
WIDE = ((rational("24/5"), rational("18/5")), (0, rational("36/5")))
LAST = ((rational("3/4"), 1), (0, 2))
DISC = rational("3/2")
KINDS = (RHOMBUS, HOURGLASS, DISC, WIDE, RHOMBUS, HOURGLASS, WIDE, DISC, RHOMBUS, WIDE, LAST)
"""From the south: corners on the eastern side, as steps from the lower tip, to the upper tip; or a radius."""


def column(count: int = len(KINDS)) -> Scene:
    """The first *count* of eleven shapes in a column, convex and not, of lines and of arcs: Figures 2 and 3.

    Each is REACH above the one before, tip over tip, so that it sees its neighbours only. Three are wide
    enough to cross the line x = 10.
    """
    shapes: list[Shape] = []
    height = rational(FOOT)
    for kind in KINDS[:count]:
        shape, top = _upright(kind, height)
        shapes.append(shape)
        height = top + REACH
    return Scene(shapes, (0, 0), terrain=Terrain(20, height), radius=REACH, name=f"column-{count}")


def _upright(kind: object, foot: fmpq) -> tuple[Shape, fmpq]:
    """A shape of a column with its lower tip at a height, and the height of its upper tip."""
    if not isinstance(kind, tuple):
        return Circle((AXIS, foot + kind), kind), foot + 2 * DISC
    east = [(AXIS + x, foot + y) for x, y in kind]
    west = [(AXIS - x, foot + y) for x, y in kind[:-1]]
    return Polygon([(AXIS, foot), *east, *reversed(west)]), foot + kind[-1][1]


def walls() -> Scene:
    """Three rectangles at the border, named like those of Figure 4 of which it tells the same.

    O1 stands on the western border and crosses the next line, O2 stands on the southern one, and O6 on the
    eastern one; it crosses the line that is walked south.
    """
    outlines = {"O1": (-1, 2, 5, 3), "O2": (5, -1, 6, rational("1/2")), "O6": (3, 6, 9, 7)}
    shapes = [
        Polygon([(left, bottom), (right, bottom), (right, top), (left, top)], name=name)
        for name, (left, bottom, right, top) in outlines.items()
    ]
    return Scene(shapes, terrain=Terrain(8, 10), radius=4, name="walls")
