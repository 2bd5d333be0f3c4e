"""Random scenes for benchmarks and experiments, the same on every platform for the same arguments."""

from __future__ import annotations

from math import isqrt
from random import Random

from flint import fmpq

from exactacq.numbers.rationals import rational
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Polygon

UNIT = 100
"""All coordinates are multiples of 1/100."""
SIZES = range(80, 121)
"""Circumradii in hundredths."""
GAP = 10
"""Least distance, in hundredths, between circumcircles and from them to the square's sides."""
MAX_DENSITY = fmpq(3, 10)
"""Up to here most random places are free; circles thrown like this jam at a density of about 0.547."""
THROWS = 1000
"""Throws of one circle before the square grows: enough for squares that are not nearly full."""


def random_octagons(n: int, seed: int, density: object = "0.14") -> Scene:
    """A square with n disjoint convex octagons at random, their total area *density* times the square's.

    The octagons are about 2 across (circumradius 0.8 to 1.2) and at least 0.1 apart; coordinates are
    multiples of 1/100. The start is the square's south-west corner, the origin, which is free; the radius is
    10. Where a few octagons do not fit, the square is larger. ValueError for n < 1 or a density outside
    (0, 0.3]. Near linear in n.
    """
    share = rational(density)
    if n < 1 or not 0 < share <= MAX_DENSITY:
        raise ValueError(f"n must be positive and the density in (0, {MAX_DENSITY}], not {n} and {share}")
    rng = Random(seed)
    sizes = [rng.choice(SIZES) for _ in range(n)]
    rings = [_octagon(rng, size) for size in sizes]
    area = fmpq(sum(_doubled_area(ring) for ring in rings), 2) / share
    # Whatever the density, one octagon needs room for its circumcircle.
    side = max(isqrt(int(area.p // area.q)), 2 * (SIZES[-1] + GAP))
    while (places := _places(rng, sizes, side)) is None:
        side += side // 20
    shapes = []
    for ring, (x, y) in zip(rings, places, strict=True):
        shapes.append(Polygon([(fmpq(x + dx, UNIT), fmpq(y + dy, UNIT)) for dx, dy in ring]))
    return Scene(shapes, start=(0, 0), radius=10, name=f"octagons-{n}-{seed}")


def _octagon(rng: Random, size: int) -> list[tuple[int, int]]:
    """Eight integer points just inside a circle, one in each octant, in strictly convex position."""
    while True:
        ring = []
        for octant in range(8):
            slope = rng.randrange(10, 91)
            norm = UNIT * UNIT + slope * slope
            x, y = isqrt(size * size * UNIT * UNIT // norm), isqrt(size * size * slope * slope // norm)
            if octant % 2:
                x, y = y, x
            for _ in range(octant // 2):
                x, y = -y, x
            ring.append((x, y))
        turns = zip(ring, ring[1:] + ring[:1], ring[2:] + ring[:2], strict=True)
        if all((b[0] - a[0]) * (c[1] - b[1]) > (b[1] - a[1]) * (c[0] - b[0]) for a, b, c in turns):
            return ring


def _doubled_area(ring: list[tuple[int, int]]) -> int:
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, ring[1:] + ring[:1], strict=True))


def _places(rng: Random, sizes: list[int], side: int) -> list[tuple[int, int]] | None:
    """Centres of disjoint circles thrown into the square, or None if one finds no place in `THROWS`."""
    cell = 2 * SIZES[-1] + GAP
    taken: dict[tuple[int, int], list[tuple[int, int, int]]] = {}
    places = []
    for size in sizes:
        low, high = size + GAP, side - size - GAP
        for _ in range(THROWS):
            x, y = rng.randint(low, high), rng.randint(low, high)
            column, row = x // cell, y // cell
            near = (
                other
                for i in (column - 1, column, column + 1)
                for j in (row - 1, row, row + 1)
                for other in taken.get((i, j), ())
            )
            if all((x - a) ** 2 + (y - b) ** 2 >= (size + r + GAP) ** 2 for a, b, r in near):
                break
        else:
            return None
        taken.setdefault((column, row), []).append((x, y, size))
        places.append((x, y))
    return places
