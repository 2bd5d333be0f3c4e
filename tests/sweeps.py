"""Random scenes on small integer grids for the Seed Spreader, degenerate on purpose."""

from __future__ import annotations

from fractions import Fraction as Q
from random import Random

import shapely

from exactacq import Circle, Outline, Polygon, Scene, Terrain

RADII = [1, 2, 3, Q(5, 2), 5, 20]


def rectangle(left: object, bottom: object, right: object, top: object) -> Polygon:
    return Polygon([(left, bottom), (right, bottom), (right, top), (left, top)])


def swept_scene(rng: Random, arcs: bool, clear: bool = False) -> Scene:
    """Up to seven obstacles in boxes that are apart, over borders and corners of the M-line unless *clear*.

    The SW corner is free.
    """
    width, height = rng.choice([(8, 8), (6, 10), (14, 6)])
    shapes: list[object] = []
    taken: list[tuple[int, int, int, int]] = []
    low = 1 if clear else -1
    for _ in range(rng.randint(1, 7)):
        for _ in range(20):
            x, y = rng.randint(low, width), rng.randint(low, height)
            right, top = x + rng.randint(1, 3), y + rng.randint(1, 3)
            outside = right <= 0 or top <= 0 or x >= width or y >= height
            if clear:
                outside = right >= width or top >= height
            over = any(not (right < a or c < x or top < b or d < y) for a, b, c, d in taken)
            if (x <= 0 and y <= 0) or outside or over:
                continue
            shape = _shape(rng, arcs, x, y, right, top)
            if not _is_inside(shape, width, height):
                shape = rectangle(x, y, right, top)
            taken.append((x, y, right, top))
            shapes.append(shape)
            break
    return Scene(shapes, terrain=Terrain(width, height), radius=rng.choice(RADII))


def _is_inside(shape: object, width: int, height: int) -> bool:
    """Whether a polygon has a part inside the terrain; other shapes fill their box well enough."""
    if not isinstance(shape, Polygon):
        return True
    outline = shapely.Polygon([(float(x), float(y)) for x, y, _ in shape.vertices])
    return bool(outline.intersection(shapely.box(0, 0, width, height)).area > 1e-9)


def _shape(rng: Random, arcs: bool, x: int, y: int, right: int, top: int) -> object:
    middle = Q(x + right, 2), Q(y + top, 2)
    kind = rng.random()
    if arcs and kind < 0.3 and right - x == top - y:
        return Circle(middle, Q(right - x, 2))
    if arcs and kind < 0.5:
        bulges = [rng.choice([0, Q(-1, 5), 0]) for _ in range(4)]
        return Outline([(x, y, bulges[0]), (right, y, 0), (right, top, bulges[2]), (x, top, 0)])
    if kind < 0.65:
        return rectangle(x, y, right, top)
    return Polygon(
        rng.choice(
            [
                [(x, y), (right, y), (x, top)],
                [(right, y), (right, top), (x, top)],
                [(x, y), (right, y), (right, top), (middle[0], Q(3 * y + top, 4)), (x, top)],
                [(x, middle[1]), (middle[0], y), (right, middle[1]), (middle[0], top)],
            ]
        )
    )
