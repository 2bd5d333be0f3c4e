"""From where lines past one feature are as long as the range: beside float lines made by angles, by hand."""

from __future__ import annotations

from itertools import pairwise
from math import asin, atan2, cos, hypot, sin, sqrt
from random import Random

import pytest
from test_prediction import block, sees

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real, fmpq
from exactacq.strategies.seed_spreader.prediction.at_range import ordinates_at_range


def some(rng: Random) -> fmpq:
    return fmpq(rng.randint(-30, 30), rng.choice((1, 2, 3, 7)))


def circle(x: fmpq, y: fmpq, radius: fmpq, ccw: bool) -> Arc:
    east = Point(x + radius, y)
    return Arc(east, east, Point(x, y), radius * radius, ccw, full=True)


def lengths(y: float, feature: Point | Arc, target: Curve) -> list[float | None]:
    """How far the target's line or circle is from (0, y) along each line that touches the feature."""
    center, radius = (feature.center, float(feature.radius)) if isinstance(feature, Arc) else (feature, 0.0)
    dx, dy = float(center.x), float(center.y) - y
    far = hypot(dx, dy)
    found: list[float | None] = []
    for side in (1, -1):
        if far <= radius:
            found += [None, None]
            continue
        angle = atan2(dy, dx) + side * asin(radius / far)
        ex, ey = cos(angle), sin(angle)
        if isinstance(target, Arc):
            mx, my = float(target.center.x), float(target.center.y) - y
            foot, height = mx * ex + my * ey, mx * ey - my * ex
            rest = float(target.radius) ** 2 - height * height
            found += [None, None] if rest < 0 else [abs(foot - sqrt(rest)), abs(foot + sqrt(rest))]
            continue
        (ax, ay), (bx, by) = target.start.xy, target.end.xy
        fx, fy = bx - ax, by - ay
        found += [abs((ax * fy - (ay - y) * fx) / (ex * fy - ey * fx)), None]
    return found


@pytest.mark.parametrize("kinds", ["corner, line", "corner, circle", "circle, line", "circle, circle"])
def test_no_change_of_order_is_missed(kinds: str) -> None:
    """Where the length passes the range between two places that are close, there is an ordinate between."""
    rng, passed = Random(5), 0
    for _ in range(15):
        touched, met = kinds.split(", ")
        feature: Point | Arc = Point(some(rng), some(rng))
        if touched == "circle":
            feature = circle(some(rng), some(rng), fmpq(rng.randint(1, 9), 2), True)
        target: Curve = Segment(Point(some(rng), some(rng)), Point(some(rng), 99))
        if met == "circle":
            target = circle(some(rng), some(rng), fmpq(rng.randint(4, 20), 2), rng.random() < 0.5)
        radius = fmpq(rng.randint(4, 60), 2)
        found = ordinates_at_range(fmpq(0), feature, target, radius)
        assert found is not None
        floats = [float(y) for y in found]
        reach = float(radius)
        ys = [k / 16 + 0.003 for k in range(-800, 800)]
        table = [lengths(y, feature, target) for y in ys]
        for (low, before), (high, after) in pairwise(zip(ys, table, strict=True)):
            for a, b in zip(before, after, strict=True):
                # A line that turns through a parallel of the target jumps.
                if a is not None and b is not None and (a - reach) * (b - reach) < 0 and abs(a - b) < 5:
                    passed += 1
                    assert any(low - 1e-9 <= y <= high + 1e-9 for y in floats), (feature, target, radius)
    assert passed > 10


def test_the_shortest_sight_past_a_corner() -> None:
    """Past (27, 0) the shortest way from x = 0 to y = 64 is 125 long, from y = -36: a double root."""
    ceiling = Segment(Point(0, 64), Point(300, 64))
    found = ordinates_at_range(fmpq(0), Point(27, 0), ceiling, fmpq(125))
    assert found is not None
    assert any(y.compare(-36) == 0 for y in found)
    shorter = ordinates_at_range(fmpq(0), Point(27, 0), ceiling, fmpq(125) - fmpq(1, 10**60))
    assert shorter is not None
    assert not any(abs(y + 36) < fmpq(1, 100) for y in shorter)


def test_what_is_not_rational_has_no_closed_form() -> None:
    root = Real(2).sqrt()
    line = Segment(Point(3, 0), Point(3, 1))
    assert ordinates_at_range(fmpq(0), Point(root, 0), line, fmpq(5)) is None
    assert ordinates_at_range(fmpq(0), Point(1, 0), Segment(Point(3, root), Point(4, 1)), fmpq(5)) is None
    # A part of a line between irrational places is on a rational line.
    part = line.part(Point(3, root / 2), line.end)
    assert ordinates_at_range(fmpq(0), Point(1, 0), part, fmpq(5)) is not None
    # Of a circle with an irrational radius some rational point is needed.
    arc = Arc(Point(1, 1), Point(-1, 1), Point(0, 0), fmpq(2), True)
    assert ordinates_at_range(fmpq(-5), arc, line, fmpq(9)) is not None
    turned = Arc(Point(root, 0), Point(0, root), Point(0, 0), fmpq(2), True)
    assert ordinates_at_range(fmpq(-5), turned, line, fmpq(9)) is None


def test_a_sight_under_a_disc_as_long_as_the_range() -> None:
    """Under a disc that the walk touches, the sight from (1, -7/2) is level, and just as long as the range.

    No sight above it is as short; and what is in reach before the start counts no more.
    """
    target = [Segment(Point(-1, -4), Point(-1, -3))]
    disc = [Arc(Point(1, -3), Point(1, -3), Point(fmpq(1, 2), -3), fmpq(1, 4), True, full=True)]
    assert sees(target, disc, fmpq(2), start=-4, stop=8, x=1)
    assert not sees(target, disc, fmpq(2), start=fmpq(-7, 2), stop=8, x=1)
    assert not sees(target, disc, fmpq(2) - fmpq(1, 10**50), start=-4, stop=8, x=1)


def test_sights_that_come_down_to_the_range_at_the_start() -> None:
    """From (0, -1) the level sight to x = 5/2 is as long as the range; later ones, past a disc, grow."""
    disc = circle(fmpq(1), fmpq(-3, 2), fmpq(1, 2), True)
    target = block(fmpq(5, 2), fmpq(7, 2), fmpq(-3, 2), fmpq(-1, 2))
    assert not sees(target, [disc], fmpq(5, 2), start=-1, stop=-8)
    assert sees(target, [disc], fmpq(5, 2) + fmpq(1, 10**50), start=-1, stop=-8)
