"""Shapes with arcs as drawings have them, for random scenes: circles in several arcs, smooth joints, cusps,
obstacles on one circle or on concentric ones, edges that are subdivided.

All data are rational: an arc turns by four times the arc tangent of its bulge, so it ends at a rational
point if it starts at one, and a part of it with a rational bulge does too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import atan, pi

from flint import fmpq

from exactacq.scene.bends import Around
from exactacq.scene.shapes import Circle, Outline, Shape, Vertex
from exactacq.study.dice import Dice

Corner = tuple[fmpq, fmpq]
Drawn = Sequence[tuple[fmpq | int, ...]]
"""Vertices in the unit square, some with a bulge."""

ONE = fmpq(1)
QUARTER, HALF, LATE = fmpq(1, 4), fmpq(1, 2), fmpq(3, 4)
THIRD, SIXTH, EIGHTEENTH = fmpq(1, 3), fmpq(1, 6), fmpq(1, 18)
BULGES = (fmpq(1, 5), fmpq(1, 4), fmpq(1, 3), fmpq(2, 5), fmpq(1, 2), ONE)
"""Of arcs between 45 degrees and a half turn."""
ROOM_ARCS = (ONE, fmpq(1, 2), fmpq(3, 4), fmpq(2), fmpq(3))
"""Bulges of the first arc of a round room."""


def rounded_triangle(radius: fmpq) -> Drawn:
    """A triangle with its corners rounded: three fillets, each of an angle with rational cosine and sine.

    The edges turn by 4 atan(1/2) twice and by 4 atan(3/4): their directions are rational unit vectors.
    """
    x, y = fmpq(1, 5), fmpq(1, 8)
    size = fmpq(3, 5)
    corners = [(x, y), (x + size, y), (x + size * fmpq(527, 625), y + size * fmpq(336, 625))]
    drawn: list[tuple[fmpq | int, ...]] = []
    for k, bulge in enumerate((HALF, HALF, LATE)):
        (ax, ay), (bx, by) = corners[k], corners[(k + 1) % 3]
        length = (size, size * fmpq(14, 25), size)[k]
        outward = radius * (by - ay) / length, radius * (ax - bx) / length
        drawn.append((ax + outward[0], ay + outward[1], 0))
        drawn.append((bx + outward[0], by + outward[1], bulge))
    return drawn


SMOOTH: tuple[Drawn, ...] = (
    [(QUARTER, QUARTER), (LATE, QUARTER, 1), (LATE, LATE), (QUARTER, LATE, 1)],
    [
        (0, 1),
        (0, HALF, 1),
        (1, HALF),
        (1, 1),
        (LATE, 1),
        (LATE, HALF, -1),
        (QUARTER, HALF),
        (QUARTER, 1),
    ],
    [
        (HALF, 5 * SIXTH + EIGHTEENTH, 1),
        (HALF, HALF - EIGHTEENTH, -1),
        (HALF, SIXTH + EIGHTEENTH),
        (HALF, SIXTH - EIGHTEENTH, 1),
        (HALF, HALF + EIGHTEENTH, -1),
        (HALF, 5 * SIXTH - EIGHTEENTH),
    ],
    rounded_triangle(fmpq(1, 10)),
)
"""A stadium, a rounded U (concentric half circles), a band along an S of half circles, fillets."""
CUSPS: tuple[Drawn, ...] = (
    [(1, QUARTER), (QUARTER, QUARTER, 1), (QUARTER, LATE), (0, LATE), (0, 0), (1, 0)],
    [(1, HALF, 1), (HALF, HALF, 1), (0, HALF), (HALF, 0)],
    [(0, 0), (1, 0), (1, LATE, -THIRD)],
    [(0, HALF, 1), (1, HALF, -HALF)],
)
"""Cusps of free space, between an arc and a floor and between two arcs, and of the obstacle likewise."""


def circle_of_arcs(center: Corner, radius: fmpq, bulge: fmpq) -> Outline:
    """A circle as two arcs, of which the first has the bulge."""
    (x, y), (u, v) = center, turned((radius, fmpq(0)), bulge)
    return Outline([(x + radius, y, bulge), (x + u, y + v, 1 / bulge)])


def turned(vector: Corner, bulge: fmpq) -> Corner:
    """A vector turned by the angle of an arc with a bulge."""
    square = bulge * bulge
    half_cosine, half_sine = (1 - square) / (1 + square), 2 * bulge / (1 + square)
    cosine, sine = half_cosine * half_cosine - half_sine * half_sine, 2 * half_cosine * half_sine
    return vector[0] * cosine - vector[1] * sine, vector[0] * sine + vector[1] * cosine


def subdivided(dice: Dice, shape: Shape, percent: int) -> Shape:
    """The shape with more vertices: a circle as two to four arcs, edges and arcs split at rational points."""
    if isinstance(shape, Circle):
        if not dice.chance(percent):
            return shape
        shape = circle_of_arcs(shape.center, shape.radius, dice.choice((ONE, *ROOM_ARCS)))
    vertices: list[Vertex] = []
    loop = shape.vertices
    for k, vertex in enumerate(loop):
        vertices.append(vertex)
        if dice.chance(percent):
            share = dice.choice((QUARTER, THIRD, HALF, LATE))
            vertices[-1:] = cut(vertex, loop[(k + 1) % len(loop)], share)
    return Outline(vertices, shape.name)


def cut(start: Vertex, end: Vertex, share: fmpq) -> tuple[Vertex, Vertex]:
    """The edge from *start* to *end* as two, the first with a share of the chord, or of the bulge."""
    (x, y, bulge), (u, v, _) = start, end
    assert not isinstance(bulge, Around), "random arcs have bulges"
    if not bulge:
        return start, (x + (u - x) * share, y + (v - y) * share, bulge)
    first = bulge * share
    rest = (bulge - first) / (1 + bulge * first)
    # From the centre, which lies to the left of the chord for small positive bulges.
    height = (1 - bulge * bulge) / (4 * bulge)
    cx, cy = (x + u) / 2 - (v - y) * height, (y + v) / 2 + (u - x) * height
    px, py = turned((x - cx, y - cy), first)
    return (x, y, first), (cx + px, cy + py, rest)


def ring(dice: Dice, center: Corner, radii: tuple[fmpq, fmpq], most: int) -> Iterator[Shape]:
    """Obstacles about one centre, apart from each other, with arcs on two circles: *radii*, ascending.

    Annular sectors with straight or round ends, and segments of the outer circle between an arc and a chord.
    """
    inner, outer = radii
    vector, angle = turned((ONE, fmpq(0)), dice.choice((fmpq(0), *BULGES))), 0.0
    for _ in range(most):
        bulge, gap = dice.choice(BULGES), dice.choice(BULGES[:3])
        angle += 4 * (atan(bulge) + atan(gap))
        if angle > 2 * pi - 0.01:
            return
        first, last = vector, turned(vector, bulge)
        vector = turned(last, gap)
        kind = dice.below(4)
        (ax, ay), (bx, by) = _spoke(center, first, outer), _spoke(center, last, outer)
        if kind == 0:
            yield Outline([(ax, ay, bulge), (bx, by)])
            continue
        (cx, cy), (dx, dy) = _spoke(center, last, inner), _spoke(center, first, inner)
        cap = ONE if kind == 1 and outer - inner < inner * HALF else fmpq(0)
        yield Outline([(ax, ay, bulge), (bx, by, cap), (cx, cy, -bulge), (dx, dy, cap)])


def _spoke(center: Corner, direction: Corner, radius: fmpq) -> Corner:
    return center[0] + direction[0] * radius, center[1] + direction[1] * radius
