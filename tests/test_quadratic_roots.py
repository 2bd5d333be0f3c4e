"""Roots of rational quadratics: equality against numbers that are made, and planted common roots."""

from __future__ import annotations

from itertools import product
from random import Random

import pytest
from flint import fmpq

from exactacq.numbers.real import Real
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes, Turning
from exactacq.visibility.quadratic_roots import QuadraticRoot, root_of


def number(root: QuadraticRoot | fmpq) -> Real:
    if isinstance(root, fmpq):
        return Real(root)
    return (Real(root.b) + root.sign * Real(root.b * root.b - root.a * root.c).sqrt()) / root.a


def planted(rng: Random) -> QuadraticRoot:
    """One with small roots, often rational ones, often shared with others; perhaps a multiple."""
    x, y = (fmpq(rng.randint(-3, 3), rng.randint(1, 2)) for _ in range(2))
    a = rng.choice([fmpq(1), fmpq(-2), fmpq(3, 2)])
    if rng.random() < 0.5:
        return QuadraticRoot(a, a * (x + y) / 2, a * x * y, rng.choice([-1, 1]))
    return QuadraticRoot(a, a * x, a * (x * x - abs(y)), rng.choice([-1, 1]))


def test_equal_as_numbers_are() -> None:
    rng = Random(1)
    roots = [planted(rng) for _ in range(150)]
    equal = 0
    for one, other in product(roots, repeat=2):
        assert one.equals(other) == (number(one) == number(other))
        equal += one is not other and one.equals(other)
    assert equal > 200
    for root, t in product(roots, [fmpq(n, 4) for n in range(-13, 14)]):
        assert root.is_value(t) == (number(root) == t)


def rational(rng: Random) -> fmpq:
    return fmpq(rng.randint(-4, 4), rng.randint(1, 2))


def sectors(rng: Random) -> list[Sector]:
    center, base = (rational(rng), rational(rng)), (fmpq(rng.randint(1, 4)), rational(rng))
    low, high, square = fmpq(-1), fmpq(1), base[0] ** 2 + base[1] ** 2
    return [
        Rolling(center, base, fmpq(0), high),
        Turning(center, base, low, high),
        Sliding(center, base, fmpq(0), high, rng.random() < 0.5),
        Spokes(center, base, low, high, square, True),
    ]


@pytest.mark.parametrize("seed", range(8))
def test_events_are_these_roots(seed: int) -> None:
    """Of every sector, where the event exists: irrational radii, tangents at infinity, points on circles."""
    rng = Random(seed)
    found = 0
    for _ in range(60):
        for sector in sectors(rng):
            circle, square = (rational(rng), rational(rng)), fmpq(rng.randint(1, 9), rng.choice([1, 4]))
            for side, sign in product((-1, 0, 1), (-1, 1)):
                event = circle, square if side else fmpq(0), side, sign
                value, root = sector.exact(*event), None
                if value is not None:
                    root = sector.root(*event)
                if root is not None:
                    found += 1
                    assert number(root) == value
    assert found > 300


def test_a_line_has_one_root() -> None:
    assert root_of(fmpq(0), fmpq(2), fmpq(3), 1) == fmpq(3, 4)


def test_rows_of_circles_are_told_without_radicals() -> None:
    """Tangents of one circle to others of its size in a row: one line, and another below."""
    rolling = Rolling((fmpq(0), fmpq(0)), (fmpq(3, 5), fmpq(0)), fmpq(0), fmpq(1))
    row = [((fmpq(-k), fmpq(2 * k)), fmpq(9, 25), -1, 1) for k in range(1, 5)]
    first, *others = (rolling.root(*event) for event in row)
    assert isinstance(first, QuadraticRoot)
    assert all(isinstance(other, QuadraticRoot) and first.equals(other) for other in others)
    inner = rolling.root((fmpq(-1), fmpq(2)), fmpq(9, 25), 1, 1)
    assert isinstance(inner, QuadraticRoot) and not first.equals(inner)
