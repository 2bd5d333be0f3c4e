"""Scenes that arguments refer to and that are families, or too special for the gallery."""

from __future__ import annotations

from fractions import Fraction as Q

from exactacq import Polygon, Scene, Terrain


def rectangle(left: object, bottom: object, right: object, top: object) -> Polygon:
    return Polygon([(left, bottom), (right, bottom), (right, top), (left, top)])


def overlapping_links() -> Scene:
    """Two links of the Sightseer's tree lie on one line, one inside the other, and both are walked back.

    U and W face each other along y = 0. From W the tour goes on below, over A to X, and from X to Y along
    y = 0, past U and W. Z is seen from U only.
    """
    return Scene(
        [
            Polygon([(4, 0), (4, Q(-3, 5)), (5, 0)], name="U"),
            Polygon([(7, 0), (8, -2), (8, 0)], name="W"),
            Polygon([(-1, -3), (8, -3), (8, Q(-27, 10)), (-1, Q(-27, 10))], name="A"),
            Polygon([(-1, Q(-5, 2)), (0, Q(-5, 2)), (0, 0), (-1, 0)], name="X"),
            Polygon([(10, Q(-1, 2)), (11, Q(-1, 2)), (11, 0), (10, 0)], name="Y"),
            Polygon([(Q(9, 2), Q(99, 10)), (Q(23, 5), 10), (Q(22, 5), 10)], name="Z"),
        ],
        start=(5, 0),
        radius=10,
    )


def comb(size: int, spacing: int = 10) -> Scene:
    """Crumbs on a spine and on a tooth over every other crumb of it; only neighbours are within the radius.

    The start is on the first crumb of the spine.
    """
    places = [(spacing * i, 0) for i in range(size)]
    places += [(spacing * i, spacing * j) for i in range(0, size, 2) for j in range(1, size + 1)]
    half = Q(1, 100)
    crumbs = [rectangle(x - half, y - half, x + half, y + half) for x, y in places]
    return Scene(crumbs, start=(0, half), radius=spacing, name=f"comb-{size}")


def trapped_end(is_free: bool) -> Scene:
    """An obstacle with a pocket, to be diverted to at the end T of the M-line; and, unless *is_free*, T in
    another obstacle."""
    inner = Polygon(
        [
            *[(4, 3), (7, 3), (7, 6), (4, 6), (4, Q(51, 10)), (Q(9, 2), Q(51, 10)), (Q(9, 2), Q(11, 2))],
            *[(6, Q(11, 2)), (6, Q(7, 2)), (Q(9, 2), Q(7, 2)), (Q(9, 2), 5), (4, 5)],
        ]
    )
    block = [] if is_free else [rectangle(9, -1, 11, 1)]
    return Scene([inner, *block], terrain=Terrain(10, 10), radius=10)
