"""Kinds of obstacles for drawn scenes, the plain ones first: each one or a few shapes near the origin.

A kind is a function of a width, a height (small whole numbers) and a variant. Its shapes are disjoint.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import atan

from oracles import Disc
from strategies import (
    FREE_CUSPS,
    ROUNDED_U,
    S_BAND,
    SPIKES,
    STADIUM,
    Pair,
    arcs_of_circle,
    fillets,
    turned,
)
from strategies import box as rectangle

Q = Fraction


# Shapes in the square [-2, 2]^2; angles are of Pythagorean triangles, so that all data are rational.

PINNED: tuple[Sequence[tuple], ...] = (
    rectangle(-1, 1, -1, 1),
    rectangle(-2, 2, -2, 2),
    rectangle(0, 1, -2, 2),
    rectangle(-2, -1, 0, 1),
    [(-2, -2), (2, -2), (-2, 2)],
    [(0, -2), (2, 0), (0, 2), (-2, 0)],
    [(-2, -2), (2, -2), (2, -1), (-1, -1), (-1, 2), (-2, 2)],
    [(-2, -2), (2, -2), (2, 2), (1, 2), (1, -1), (-1, -1), (-1, 2), (-2, 2)],
    [(-2, 2), (0, 0), (2, 2), (0, -2)],
    [(-2, 0), (0, -1), (2, 0)],
)
RING = [(Q(6, 5), Q(8, 5), 2), (Q(6, 5), Q(-8, 5)), (Q(9, 10), Q(-6, 5), -2), (Q(9, 10), Q(6, 5))]
HALF_RING = [(2, 0, 1), (-2, 0), (Q(-3, 2), 0, -1), (Q(3, 2), 0)]
KEYHOLE = [(2, 2), (-2, 2), (-2, -2), (2, -2), (2, -1), (Q(3, 4), -1, -2), (Q(3, 4), 1), (2, 1)]
BAY = [(-2, -2), (2, -2), (2, 2, -1), (-2, 2)]
HOLLOW: tuple[Sequence[tuple], ...] = (RING, HALF_RING, KEYHOLE)
ROUND: tuple[object, ...] = (
    Disc(0, 0, 1),
    Disc(0, 0, 2),
    Disc(1, 1, 1),
    Disc(-1, 1, 1),
    Disc(0, -1, 1),
    *HOLLOW,
    [(0, 0), (Q(3, 5), Q(4, 5), 2), (Q(3, 5), Q(-4, 5))],  # three quarters, corner at the centre
    [(0, 0), (Q(6, 5), Q(-8, 5), Q(1, 2)), (Q(6, 5), Q(8, 5))],
    [(-1, -1), (1, -1, 1), (1, 1), (-1, 1, 1)],  # stadium: smooth joints
    [(-1, -1, -Q(1, 2)), (1, -1, 1), (1, 1), (-1, 1, 1)],
    [(2, 0, 1), (-2, 0, -1), (0, 0, -1)],  # three spikes
    [(2, 0, 1), (0, 0, 1), (-2, 0, 1)],  # a heart: its cusp is free
    [(2, 0, 1), (-2, 0, -1), (0, 0, 1)],  # both kinds of cusp: yin
    [(-2, 0, 1), (2, 0, Q(-1, 2))],  # crescent with two edges
    [(0, -2, 1), (0, 2, Q(1, 3))],
    [(-1, 0, 3), (1, 0)],  # more than half a circle on a chord
    BAY,
    [(-1, -1, Q(1, 2)), (1, -1, Q(1, 2)), (1, 1, Q(1, 2)), (-1, 1, Q(1, 2))],
    [(-2, -2, Q(-1, 3)), (2, -2, Q(-1, 3)), (2, 2, Q(-1, 3)), (-2, 2, Q(-1, 3))],
)


@dataclass(frozen=True)
class Group:
    """Shapes that are placed together, and free places among them, as in a pocket."""

    shapes: tuple[object, ...]
    places: tuple[Pair, ...] = ()


Kind = Callable[[int, int, int], Group]


def single(*shapes: object, places: tuple[tuple, ...] = ()) -> Group:
    return Group(shapes, tuple((Q(x), Q(y)) for x, y in places))


def a_box(w: int, h: int, _: int) -> Group:
    return single(rectangle(0, w, 0, h))


def a_triangle(w: int, h: int, variant: int) -> Group:
    return single([(0, 0), (w, 0), ((0, Q(w, 2), w)[variant % 3], h)])


def a_disc(w: int, _: int, variant: int) -> Group:
    return single(Disc(0, 0, Q(w, (1, 2, 3)[variant % 3])))


def a_diamond(w: int, h: int, _: int) -> Group:
    return single([(w, 0), (2 * w, h), (w, 2 * h), (0, h)])


def a_hook(w: int, h: int, _: int) -> Group:
    """An L."""
    return single([(0, 0), (w + 1, 0), (w + 1, 1), (1, 1), (1, h + 1), (0, h + 1)], places=((1, 1), (w, h)))


def a_pocket(w: int, h: int, variant: int) -> Group:
    """A U, perhaps with something in it that touches the line over its rim, or its walls but for a hair."""
    walls = [
        (0, 0), (w + 3, 0), (w + 3, h + 2), (w + 2, h + 2), (w + 2, 1), (1, 1), (1, h + 2), (0, h + 2),
    ]  # fmt: skip
    hair = Q(1, 10**9)
    tenants: tuple[object, ...] = (
        rectangle(Q(3, 2), w + Q(3, 2), Q(3, 2), h + 2),
        Disc(Q(w, 2) + Q(3, 2), 2, Q(1, 2)),
        rectangle(1 + hair, w + Q(3, 2), 1 + hair, Q(5, 2)),
        [(Q(3, 2), h + 3), (2, 2), (Q(5, 2), h + 3)],
    )
    inside = ((), *((t,) for t in tenants))[variant % 5]
    return single(walls, *inside, places=((1, 1), (Q(5, 4), Q(5, 4)), (w + 2, h + 2)))


def a_long_wall(w: int, h: int, variant: int) -> Group:
    """An edge that is long against all distances, of a thick or a thin wall."""
    length, thickness = 20 * w, (Q(1), Q(1, 100), Q(1, 10**9))[variant % 3]
    return single(rectangle(0, length, 0, thickness * h))


def an_octagon(w: int, h: int, _: int) -> Group:
    a, b = w, w + h
    return single([(0, a), (a, 0), (b, 0), (a + b, a), (a + b, b), (b, a + b), (a, a + b), (0, b)])


BULGES = (Q(1), Q(1, 2), Q(1, 10), Q(1, 10**3), Q(1, 10**9), Q(2), Q(10))


def a_bulged_box(w: int, h: int, variant: int) -> Group:
    """A box of which one edge, or two, bend outwards or inwards, much or hardly."""
    bulge = BULGES[variant % len(BULGES)]
    inwards = variant // len(BULGES) % 3
    if inwards:  # as deep as half its height at most
        bulge = -min(bulge, Q(2 * h, 3 * w), Q(1, 2))
    other = bulge if inwards == 2 and bulge > -Q(h, 2 * w) else 0
    return single([(0, 0, bulge), (w, 0), (w, h, other), (0, h)])


def two_edges(w: int, _: int, variant: int) -> Group:
    """Half discs, lenses, crescents, nearly whole discs: two edges from (0, 0) to (2w, 0)."""
    below = BULGES[variant % len(BULGES)]
    above = (Q(0), Q(1), Q(1, 2), -below / 2, -below * (1 - Q(1, 10**6)))[variant // len(BULGES) % 5]
    return single([(0, 0, below), (2 * w, 0, above)], places=((0, 0),))


def smooth(w: int, h: int, variant: int) -> Group:
    """Arcs that run on into edges or arcs: stadium, rounded triangle, U of half circles, S."""
    loops: tuple[list[tuple], ...] = (
        [(0, 0), (w, 0, 1), (w, 2 * h), (0, 2 * h, 1)],
        STADIUM,
        fillets(),
        ROUNDED_U,
        S_BAND,
    )
    return single(loops[variant % len(loops)])


def on_pins(_w: int, _h: int, variant: int) -> Group:
    return single(PINNED[variant % len(PINNED)])


def with_arcs(_w: int, _h: int, variant: int) -> Group:
    """What drawings hold: cusps of free space and of obstacles, corners in centres, bays, bulging boxes."""
    loops = (*FREE_CUSPS, *SPIKES, *ROUND)
    return single(loops[variant % len(loops)])


def a_circle_of_arcs(w: int, _: int, variant: int) -> Group:
    bulge = (Q(1), Q(1, 2), Q(3, 4), Q(2), Q(3), Q(1, 5))[variant % 6]
    return single(arcs_of_circle((Q(0), Q(0)), Q(w), bulge))


def a_round_pocket(w: int, _: int, variant: int) -> Group:
    """A ring with an opening, a bay or a keyhole, perhaps with something at its centre."""
    s = Q(w, 2)
    shape = (*HOLLOW, BAY)[variant % 4]
    inside: tuple[object, ...] = (
        (),
        (Disc(0, Q(3, 4), Q(1, 4)),),
        (rectangle(Q(-1, 8), Q(1, 8), Q(3, 4), Q(7, 8)),),
    )[variant // 4 % 3]
    grown = [(2 * s * v[0], 2 * s * v[1], *v[2:]) for v in shape]
    inside = tuple(
        Disc(2 * s * t.x, 2 * s * t.y, 2 * s * t.r)
        if isinstance(t, Disc)
        else [(2 * s * x, 2 * s * y) for x, y in t]
        for t in inside
    )
    return single(grown, *inside, places=((0, s),) if variant % 4 != 1 else ((0, 0), (0, s)))


SECTORS = (Q(1, 5), Q(1, 4), Q(1, 3), Q(2, 5), Q(1, 2))


def a_ring(w: int, h: int, variant: int) -> Group:
    """Pieces of one ring, apart from each other: their arcs share two circles, or one.

    Variants count the pieces, and say how they end and what is at the centre. One alone may have its corner
    there.
    """
    inner, outer = Q(w + 1), Q(w + 1 + h)
    count, form, middle = 1 + variant % 3, variant // 3 % 3, variant // 9 % 3
    ray, angle = (Q(1), Q(0)), 0.0
    shapes: list[object] = []
    for k in range(count):
        bulge, gap = SECTORS[(variant + k) % 5], SECTORS[(variant // 5 + k) % 3]
        angle += 4 * (atan(bulge) + atan(gap))
        if angle > 6.28:
            break
        last = turned(ray, bulge)
        (a, b), (c, d) = ((r * ray[0], r * ray[1]) for r in (outer, inner))
        (e, f), (x, y) = ((r * last[0], r * last[1]) for r in (outer, inner))
        sector: list[tuple] = [(a, b, bulge), (e, f), (x, y, -bulge), (c, d)]
        segment: list[tuple] = [(a, b, bulge), (e, f)]
        pie = [*segment, (0, 0)] if count == 1 and not middle else sector
        shapes.append((sector, segment, pie)[form])
        ray = turned(last, gap)
    if middle:
        shapes.append((Disc(0, 0, 1), rectangle(0, 1, 0, 1))[middle - 1])
    return single(*shapes, places=((0, 0), (inner, 0)))


def a_spiral(w: int, h: int, _: int) -> Group:
    """A pocket in a pocket."""
    x, y = w + 2, h + 2
    return single(
        [
            (0, 0), (x + 6, 0), (x + 6, y + 6), (2, y + 6), (2, 2), (x + 4, 2), (x + 4, y + 4), (4, y + 4),
            (4, y + 3), (x + 3, y + 3), (x + 3, 3), (3, 3), (3, y + 5), (x + 5, y + 5), (x + 5, 1), (0, 1),
        ],
        places=((4, 4), (3, 3), (4, y + 3)),
    )  # fmt: skip


STRAIGHT: tuple[Kind, ...] = (
    a_box,
    a_triangle,
    a_diamond,
    a_hook,
    a_pocket,
    a_long_wall,
    an_octagon,
    on_pins,
    a_spiral,
)
CURVED: tuple[Kind, ...] = (
    a_disc,
    a_bulged_box,
    two_edges,
    a_circle_of_arcs,
    smooth,
    with_arcs,
    a_ring,
    a_round_pocket,
)
KINDS: tuple[Kind, ...] = (
    a_box,
    a_disc,
    *STRAIGHT[1:],
    *CURVED[1:],
)
"""All of them, the plain ones first."""
VARIANTS = 35
"""So many variants are drawn: all those of the kind with the most."""
