"""Sides of line families: what floats call left or right is so exactly, and what is well apart is called so.

The law is put to families of tiny and of huge lengths, far from the origin, and to places beside them, near
and far. The exact side is a cross product of exact numbers, at sampled lines of the family.
"""

from __future__ import annotations

from fractions import Fraction
from math import sqrt
from random import Random

import pytest

from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.kernel.bounded import UNIT
from exactacq.kernel.extents import EVERYTHING
from exactacq.kernel.family_images import NONE, EndLine, FamilyImage
from exactacq.kernel.single_lines import SingleImage
from exactacq.numbers.float_bounds import float_ball, rough
from exactacq.numbers.real import Real, fmpq, rational
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes, Turning

Q = Fraction
LENGTHS = [1, Q(1, 10**6), Q(1, 10**20), Q(1, 10**60), 10**9]
OFFSETS = [0, 1, 10**6, Q(10**9, 3)]
GAPS = [0, Q(1, 10**60), Q(1, 10**12), Q(1, 10**7), Q(1, 10**4), 1, 10**4, 10**12]
NO_SPOT = 0.0, 0.0, 0.0
DECIDED = 2.0**-43
"""What is farther from all lines, as a part of all coordinates and lengths, is to be decided."""


def fraction(rng: Random) -> Fraction:
    return Q(rng.randint(-999, 999), 997)


def pair(rng: Random, size: object) -> tuple[fmpq, fmpq]:
    return rational(size * (fraction(rng) + 2)), rational(size * fraction(rng))


def beside(rng: Random, contact: Point, direction: Point) -> Point:
    """A place at some distance along a line and from it, now and then irrational."""
    root = Real(rng.choice([1, 1, 2])).sqrt() / abs(Q(float(max(direction, key=abs))))
    along, across = (rational(rng.choice(GAPS) * fraction(rng)) * root for _ in "xy")
    return contact + direction * along + direction.left() * across


def distances(lines: list[tuple[Point, Point]], place: Point) -> list[float]:
    """Distances of a place from lines, positive to the left: their signs are exact."""
    turns = [direction.cross(place - contact) for contact, direction in lines]
    return [float(t) / sqrt(float(d.norm_sq())) for t, (_, d) in zip(turns, lines, strict=True)]


def of_lines(start: Point, end: Point) -> SingleImage:
    """The line from one point through another."""
    spans, segment = (EVERYTHING, EVERYTHING), curve_image(Segment(start, end))
    return SingleImage((NONE, 0), spans, NO_SPOT, NO_SPOT, segment, [], None, (0, 0, 0))


def family(sector: Sector, low: Real, high: Real) -> FamilyImage:
    """The lines of a sector between two parameters."""
    first, last = (EndLine(sector.image, *float_ball(t), [], []) for t in (low, high))
    return FamilyImage(sector.image, (first, last), (NONE, NONE, NONE), True, NONE, None, 0)


def side_of(image: FamilyImage | SingleImage, place: Point) -> int:
    x, y = rough(place.x), rough(place.y)
    return image.side(x, y, UNIT * (abs(x) + abs(y)))


def judge(
    image: FamilyImage | SingleImage, lines: list[tuple[Point, Point]], place: Point, room: float
) -> bool:
    """Whether the side of a place is told, which it rightly is unless a line passes within *room*."""
    side = side_of(image, place)
    exact = distances(lines, place)
    assert not side or all(d * side > 0 for d in exact)
    assert side or (min(exact) <= room and max(exact) >= -room)
    return bool(side)


def size(*points: Point) -> float:
    return sum(abs(float(c)) for p in points for c in p)


@pytest.mark.parametrize("seed", range(20))
def test_sides_of_lines(seed: int) -> None:
    rng = Random(seed)
    told = 0
    for _ in range(60):
        start = Point(*(rng.choice(OFFSETS) * (2 + fraction(rng)) for _ in "xy"))
        direction = Point(*pair(rng, rng.choice(LENGTHS)))
        place = beside(rng, start, direction)
        image, room = of_lines(start, start + direction), DECIDED * size(start, place)
        told += judge(image, [(start, direction)], place, room)
    assert 20 <= told < 60


@pytest.mark.parametrize("kind", [Turning, Rolling, Sliding, Spokes])
@pytest.mark.parametrize("seed", range(8))
def test_sides_of_beams(seed: int, kind: type) -> None:
    rng = Random(seed)
    told = 0
    for _ in range(40):
        center = tuple(rational(rng.choice(OFFSETS) * (2 + fraction(rng))) for _ in "xy")
        base = pair(rng, rng.choice(LENGTHS))
        options = {"leftward": rng.random() < 0.5} if kind is Sliding else {}
        options |= {"radius_sq": fmpq(2), "outward": True} if kind is Spokes else {}
        sector = kind(center, base, fmpq(0), fmpq(1), **options)
        low, high = sorted(abs(fraction(rng)) for _ in "ab")
        if rng.random() < 0.3:
            high = low + (high - low) * rng.choice(GAPS[:5])
        lines = [sector.touch(Real(low + (high - low) * Q(k, 8))) for k in range(9)]
        place = beside(rng, *rng.choice(lines))
        room = DECIDED * (size(Point(*center), place) + sector.extent)
        if kind is Rolling:
            # A line between the first and the last may be the nearest, by up to 0.3 radii.
            room += 0.31 * sector.size
        told += judge(family(sector, Real(low), Real(high)), lines, place, room)
    assert 5 <= told < 40


def test_a_line_between_points_that_floats_confuse() -> None:
    """At 10^9 floats are 10^-7 apart: the difference of these two points is lost, or wrong by a third."""
    for short in (Q(1, 10**60), Q(1, 10**9), Q(1, 10**7)):
        start = Point(10**9, 10**9)
        end = Point(10**9 + short, 10**9 + 3 * short)
        image = of_lines(start, end)
        assert image.side(10**9 + 1.0, 10**9 + 2.0, 1e-3) == -1
        assert image.side(10**9 + 1.0, 10**9 + 4.0, 1e-3) == 1


def test_a_tangent_of_a_tiny_circle() -> None:
    """The parameter of its tangent through this point is 10^-30, from terms that cancel beyond 64 bits."""
    point = Point(Q(1, 10**30), -1)
    circle = Rolling((fmpq(0), fmpq(0)), (rational(Q(1, 10**60)), fmpq(0)), fmpq(0), fmpq(1))
    (t,) = (t for t in circle.through(point) if 0 <= t <= 1)
    contact, direction = circle.touch(t)
    for side in (1, -1):
        place = contact + direction * 10**60 + direction.left() * (side * 10**50)
        assert side_of(family(circle, t, t), place) == side


def test_coordinates_that_cancel() -> None:
    """The ball of 64 bits of such a coordinate is wider than the number."""
    deep = Real(2 * 10**60).sqrt()
    (low, _) = deep.enclosure(20)
    assert (rough(deep - low), rough(Real(low))) == (float(deep - low), float(low))
    assert rough((Real(2).sqrt() + Real(3).sqrt()) ** 2 - Real(24).sqrt() - 5) == 0.0
