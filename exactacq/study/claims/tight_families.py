"""Families of scenes that come near to the corrected bounds; the arguments prove how near.

What each family is and why its runs have the lengths told there is `proofs/arguments/tight.md`.
"""

from __future__ import annotations

from flint import fmpq

from exactacq.numbers.rationals import rational
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Polygon, Terrain

THICK = rational("1/10")
"""How thick rods, arms and hooks are."""
CRUMB = rational("1/100")
"""A rhombus beside a rod is 6 of these wide and 8 high, so that each of its sides is 5 long."""
UNIT = rational("1/100")
"""The unit of the relay's crumbs and screens."""


def rectangle(left: fmpq, bottom: fmpq, right: fmpq, top: fmpq) -> Polygon:
    """The rectangle with these sides."""
    return Polygon([(left, bottom), (right, bottom), (right, top), (left, top)])


def rods(count: int, length: int) -> Scene:
    """A rod and *count* - 1 crumbs above its ends, each in sight of the rod only: R = 1.

    All crumbs are 1 from the rod, and their numbers send the robot from one end to the other each time.
    The *length* of the rod is at least 2 *count* + 2.
    """
    if length < 2 * count + 2:
        raise ValueError(f"a rod with {count - 1} crumbs is at least {2 * count + 2} long, not {length}")
    e, y = CRUMB, THICK + 1
    crumbs = [
        Polygon([(x, y), (x + 3 * e, y + 4 * e), (x, y + 8 * e), (x - 3 * e, y + 4 * e)])
        for x in (k if k % 2 == 0 else length - k + 1 for k in range(count - 1))
    ]
    rod = rectangle(rational(0), rational(0), rational(length), THICK)
    return Scene([rod, *crumbs], (length, THICK), radius=1, name=f"rods-{count}-{length}")


def slabs(count: int) -> Scene:
    """Thin slabs across a ray from T, one behind the other, each with a pocket: R = B = 20, A = 30.

    All are diverted to from T, the nearest first, and each of these ways crosses all slabs before.
    """
    gap = rational(1) / count**2
    thick = gap / 2
    shapes = []
    for k in range(count):
        near, half = 10 + k * gap, 5 + k * gap
        outline = [*_pocket(near, half, thick / 6), (near + thick, -half), (near + thick, half), (near, half)]
        shapes.append(Polygon([_by_ray(u, v) for u, v in outline]))
    return Scene(shapes, terrain=Terrain(20, 30), radius=20, name=f"slabs-{count}")


def _by_ray(u: fmpq, v: fmpq) -> tuple[fmpq, fmpq]:
    """The point u along the ray from T = (20, 0) to the north-west, and v across it to the north-east."""
    return 20 + (3 * v - 4 * u) / 5, (3 * u + 4 * v) / 5


def _pocket(near: fmpq, half: fmpq, e: fmpq) -> list[tuple[fmpq, fmpq]]:
    """The corners at a slab's south-western end, which a bent pocket opens.

    Its mouth is e wide and e deep, the room behind it twice as wide, so that it has a corner which is seen
    from inside only.
    """
    mouth, low = near + 2 * e, -half
    return [
        (near, low),
        *((mouth, low), (mouth, low + 4 * e), (mouth + 2 * e, low + 4 * e)),
        *((mouth + 2 * e, low + e), (mouth + e, low + e), (mouth + e, low)),
    ]


def arms(count: int, length: int) -> Scene:
    """A thin bar across *count* lines with an arm up at both ends: w = R = 1, A = *length* + 2."""
    half, d = rational("1/2"), THICK
    east, top = count + half, 1 + rational(length)
    outline = [
        *((half, 1), (east, 1), (east, top), (east - d, top)),
        *((east - d, 1 + d), (half + d, 1 + d), (half + d, top), (half, top)),
    ]
    terrain = Terrain(count + 1, length + 2)
    return Scene([Polygon(outline)], terrain=terrain, radius=1, name=f"arms-{count}-{length}")


def hooks(count: int, length: int, last: object = "1/2") -> Scene:
    """A thin bar from the eastern border across *count* lines, with an arm up at its western end.

    w = R = 1, A = *length* + 2, and the *last* strip is that wide, from above 0 to 1.
    """
    half, d = rational("1/2"), THICK
    width, top = count + rational(last), 1 + rational(length)
    outline = [
        *((half, 1), (width + 1, 1), (width + 1, 1 + d)),
        *((half + d, 1 + d), (half + d, top), (half, top)),
    ]
    name = f"hooks-{count}-{length}-{last}"
    return Scene([Polygon(outline)], terrain=Terrain(width, length + 2), radius=1, name=name)


def relay(count: int, foot: int = 30, crumbs: int = 1) -> Scene:
    """A crumb with a pocket, and north of it *count* places 19 apart, each with crumbs between two screens.

    The last place has so many *crumbs*, one above the other, any other has one. They are seen from the place
    before only: from both lines the screens hide them, and these themselves become known from there. R = B =
    20; all crumbs and screens are less than 1/4 around. The first crumb is at height *foot*: if that is low,
    the eastern line ends before the crumb is out of reach.
    """
    u, column = UNIT, rational(14)
    half, bend = rational("1/2"), rational("5/2")
    pocket = [(0, 0), (3, 0), (3, 3), (0, 3), (0, 2), (half, 2), (half, bend), (2, bend), (2, 1), (0, 1)]
    shapes = [Polygon([(column + x * u, foot + y * u) for x, y in pocket])]
    for k in range(1, count + 1):
        y = rational(foot + 19 * k)
        many = crumbs if k == count else 1
        step, r = u / many, u / (20 * many)
        top = y + (many - 1) * step
        west, east = (43 * u / 10, 9 * u / 2, 4 * u), (18 * u / 5, u, 3 * u / 2)
        shapes.append(rectangle(column - west[1], y - west[0], column - west[2], top + west[0]))
        shapes.append(rectangle(column + east[1], y - east[0], column + east[2], top + east[0]))
        shapes += [
            rectangle(column - r, z - r, column + r, z + r) for z in (y + a * step for a in range(many))
        ]
    terrain = Terrain(20, foot + 19 * count + 30)
    return Scene(shapes, terrain=terrain, radius=20, name=f"relay-{count}-{crumbs}")
