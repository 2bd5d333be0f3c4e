"""Random search for a bound in `exactacq.kernel.lines` that does not hold the exact value."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from random import Random

import pytest
from flint import arb, fmpq

from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point
from exactacq.kernel import lines
from exactacq.kernel.curve_images import CurveImage
from exactacq.numbers.real import Real
from exactacq.visibility.chords import meet
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes, Turning

LOW, HIGH = fmpq(-1), fmpq(1)


def number(rng: Random) -> fmpq:
    return fmpq(rng.randint(-(10**6), 10**6), rng.choice([10**6, 999983])) * rng.choice(
        [1, 10, fmpq(1, 1000)]
    )


def sector(rng: Random, far: int) -> Sector:
    """Any kind of sector, perhaps far from the origin."""
    center, base = (number(rng) + far, number(rng) - far), (number(rng) + fmpq(1, 7), number(rng))
    kind, radius_sq = rng.randrange(6), number(rng) ** 2 + fmpq(1, 100)
    if kind < 2:
        return (Turning, Rolling)[kind](center, base, LOW, HIGH)
    if kind < 4:
        return Sliding(center, base, fmpq(0), HIGH, leftward=kind == 2)
    return Spokes(center, base, LOW, HIGH, radius_sq=radius_sq, outward=kind == 4)


def bounded(rng: Random) -> Iterator[tuple[Real, float, float]]:
    """Exact values of one random case, each with the float that stands for it and the bound of its error."""
    far = rng.choice([0, 0, 10**3, 10**6, 10**9])
    some = sector(rng, far)
    t = Real(fmpq(rng.randint(0, 10**6), 10**6)) * rng.choice([Real(1), Real(2).sqrt() / 2])
    error = rng.choice([2.0**-52, 1e-12, 1e-8])
    line = lines.line_at(some.image, float(t) + rng.uniform(-0.5, 0.5) * error, error)
    contact, direction = some.touch(t)
    yield from ((contact.x, line[0], line[4]), (contact.y, line[1], line[4]))
    yield from ((direction.x, line[2], line[5]), (direction.y, line[3], line[5]))
    place = Point(number(rng) + far, number(rng) - far)
    way = Point(number(rng), number(rng) + fmpq(1, 13))
    side = rng.choice([1, -1])
    if rng.random() < 0.5:
        if direction.rational is not None and rng.random() < 0.3:  # nearly parallel
            way = direction + Point(0, fmpq(1, rng.choice([10**3, 10**9, 10**14])))
        curve: Segment | Arc = Segment(place, place + way)
        met = lines.meets_straight(line, CurveImage(*place.xy, *way.xy, 0.0, 0, False))
        rail = Rail(curve)
    else:
        radius_sq = way.norm_sq().rational
        assert radius_sq is not None
        curve = Arc(place + way, place - way, place, radius_sq, ccw=rng.random() < 0.5)
        sense = 1 if curve.ccw else -1
        image = CurveImage(*place.xy, *way.xy, float(curve.radius), sense, False)
        met = lines.meets_round(line, image, side)
        rail = Rail(Arc(curve.start, curve.start, place, radius_sq, ccw=curve.ccw, full=True))
    if inf in (met[1], met[3]):
        return
    tau = meet(contact, direction, curve, side)
    point = contact + direction * tau
    yield from ((point.x, met[4], met[6]), (point.y, met[5], met[6]))
    yield tau * direction.norm_sq().sqrt(), met[0], met[1]
    yield rail.parameter(point), met[2], met[3]


@pytest.mark.parametrize("seed", range(8))
def test_bounds_hold_the_exact_values(seed: int) -> None:
    """Long edges against their distance, far from the origin, near parallels, all kinds of lines."""
    rng = Random(seed)
    for _ in range(150):
        for value, middle, error in bounded(rng):
            assert not abs(value.ball(256) - arb(middle)) > arb(error)
