"""Plain geometry of drawn scenes in fractions: vectors as complex numbers, lines, circles, boxes of shapes.

Shapes are as `oracles` and `strategies` take them: lists of vertices (x, y) or (x, y, bulge), or a `Disc`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from math import isqrt
from typing import NamedTuple

from oracles import Disc
from strategies import Pair, Similarity, arcs_of_circle

Q = Fraction
COARSE = 64
"""Square roots that are irrational are rounded up to such parts, so that numbers stay short."""


def plus(p: Pair, q: Pair, times: Fraction | int = 1) -> Pair:
    """p + times q."""
    return p[0] + times * q[0], p[1] + times * q[1]


def minus(p: Pair, q: Pair) -> Pair:
    """p - q."""
    return p[0] - q[0], p[1] - q[1]


def product(p: Pair, q: Pair) -> Pair:
    """The product as complex numbers: p turned and stretched as q says."""
    return p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0]


def quotient(p: Pair, q: Pair) -> Pair:
    """What takes q to p."""
    x, y = product(p, (q[0], -q[1]))
    size = square(q)
    return x / size, y / size


def square(p: Pair) -> Fraction:
    """The square of the length."""
    return p[0] * p[0] + p[1] * p[1]


def root(value: Fraction) -> Fraction:
    """The square root if that is rational, else a round number that is a little more."""
    top, bottom = isqrt(value.numerator), isqrt(value.denominator)
    if top * top == value.numerator and bottom * bottom == value.denominator:
        return Q(top, bottom)
    return Q(isqrt(value.numerator * COARSE * COARSE // value.denominator) + 1, COARSE)


def has_root(value: Fraction) -> bool:
    """Whether the square root is rational."""
    return root(value) ** 2 == value


def turn(t: Fraction) -> Pair:
    """The unit vector at twice the angle whose tangent is t."""
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)


class Line(NamedTuple):
    """The line through a point in a direction."""

    point: Pair
    along: Pair


class Round(NamedTuple):
    """The circle about a centre through a point."""

    center: Pair
    point: Pair


class Box(NamedTuple):
    """A rectangle; that of a shape holds it."""

    left: Fraction
    bottom: Fraction
    right: Fraction
    top: Fraction

    def meets(self, other: Box) -> bool:
        """Whether they have a point in common."""
        aside = self.right < other.left or other.right < self.left
        return not (aside or self.top < other.bottom or other.top < self.bottom)


def edges(shape: object) -> Iterator[tuple[Pair, Pair, Fraction]]:
    """The edges of a loop: ends and bulge."""
    rows = [(Q(v[0]), Q(v[1]), Q(v[2]) if len(v) > 2 else Q(0)) for v in loop(shape)]
    for (x, y, bulge), (u, v, _) in pairwise([*rows, rows[0]]):
        yield (x, y), (u, v), bulge


def loop(shape: object) -> Sequence[tuple]:
    """A disc as two half circles; every other shape as it is."""
    if isinstance(shape, Disc):
        return arcs_of_circle((Q(shape.x), Q(shape.y)), Q(shape.r), Q(1))
    return shape  # type: ignore[return-value]


def center(p: Pair, q: Pair, bulge: Fraction) -> Pair:
    """The centre of an arc."""
    away = (1 - bulge * bulge) / (4 * bulge)
    middle = plus(p, minus(q, p), Q(1, 2))
    return middle[0] - (q[1] - p[1]) * away, middle[1] + (q[0] - p[0]) * away


def lines(shape: object) -> list[Line]:
    """The lines along straight edges, then the tangents in the first ends of arcs."""
    straight = [Line(p, minus(q, p)) for p, q, b in edges(shape) if not b]
    return straight + [Line(r.point, product(minus(r.point, r.center), (Q(0), Q(1)))) for r in rounds(shape)]


def rounds(shape: object) -> list[Round]:
    """The circles of arcs, through their first ends."""
    return [Round(center(p, q, b), p) for p, q, b in edges(shape) if b]


def vertices(shape: object) -> list[Pair]:
    """The vertices; of a disc its east and its west point."""
    return [p for p, _, _ in edges(shape)]


def extremes(shape: object) -> Iterator[Pair]:
    """The vertices, and where arcs reach farthest east, north, west and south.

    Where a radius is irrational, these lie a little outside.
    """
    for p, q, bulge in edges(shape):
        yield p
        if not bulge:
            continue
        (cx, cy), chord = center(p, q, bulge), minus(q, p)
        radius = root(square(minus(p, (cx, cy))))
        for dx, dy in ((1, 0), (0, 1), (-1, 0), (0, -1)):
            place = cx + dx * radius, cy + dy * radius
            far = minus(place, p)
            side = (chord[0] * far[1] - chord[1] * far[0]) * bulge
            if side <= square(chord) * abs(bulge) / 10**30:
                yield place


def box(shapes: Iterable[object]) -> Box:
    """A box that holds the shapes; the least one where radii are rational."""
    xs, ys = zip(*(place for shape in shapes for place in extremes(shape)), strict=True)
    return Box(min(xs), min(ys), max(xs), max(ys))


def moved(shape: object, by: Pair, shift: Pair, mirror: bool = False) -> object:
    """The image under z -> by z + shift, after a mirror in the x-axis if so.

    A disc whose radius becomes irrational comes as two half circles.
    """
    size = root(square(by))
    if has_root(square(by)):
        return Similarity((by[0] / size, by[1] / size), size, shift, mirror).shape(shape)
    return Similarity(by, Q(1), shift, mirror).shape(loop(shape))
