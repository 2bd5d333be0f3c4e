"""Arithmetic on unpacked coordinates."""

from __future__ import annotations

import pytest
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st

from exactacq.geometry.coordinates import at_distance, cross, dot, minus, raw
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real

rationals = st.builds(fmpq, st.integers(-60, 60), st.integers(1, 12))


@given(rationals, rationals, rationals, rationals, rationals.map(abs).filter(bool))
def test_a_point_at_a_distance(x: fmpq, y: fmpq, u: fmpq, v: fmpq, distance: fmpq) -> None:
    """It lies ahead in the direction, at the distance, and is told to be rational where it is."""
    if not (u or v):
        return
    point = at_distance((x, y), (u, v), distance)
    offset = point - Point(x, y)
    assert offset.norm_sq() == Real(distance * distance)
    assert cross(raw(offset), (u, v)) == 0 < dot(raw(offset), (u, v))
    assert (point.rational is None) == (Real(dot((u, v), (u, v))).sqrt().rational is None)


@pytest.mark.parametrize("direction", [(3, 4), (-4, 3), (0, -2), (fmpq(-1, 7), 0)])
def test_rational_points_at_a_distance(direction: tuple[object, object]) -> None:
    """Along the axes and in Pythagorean directions."""
    u, v = (fmpq(c) for c in direction)
    here = fmpq(1, 2), fmpq(5)
    found = at_distance(here, (u, v), fmpq(10)).rational
    assert found is not None
    way = minus(found, here)
    assert dot(way, way) == 100 and cross(way, (u, v)) == 0 < dot(way, (u, v))


def test_irrational_directions() -> None:
    """Directions that are no rationals are taken as they are."""
    root = Real(2).sqrt()
    point = at_distance((fmpq(0), fmpq(0)), (root, root), fmpq(2))
    assert point == Point(root, root)


def test_strokes_of_numbers_that_nearly_cancel() -> None:
    """Where a ball of the bits that strokes take tells nothing of a length, it is told exactly."""
    large = Real(10**90)
    near = (large + 1).sqrt() - large.sqrt() + Real(2).sqrt() * 10**60 - Real(2 * 10**120 + 10**59).sqrt()
    for curve in (
        Segment(Point(near, 0), Point(near, fmpq(1, 10**70))),
        Segment(Point(near, 1), Point(near, 1)),
    ):
        assert curve.stroke().length == float(curve.length)
    radius = fmpq(5)
    for end in (Point(-5, 0), Point(0, 5), Point(0, -5), Point(3, 4), Point(fmpq(7, 5), fmpq(-24, 5))):
        for ccw in (True, False):
            arc = Arc(Point(5, 0), end, Point(0, 0), radius * radius, ccw)
            assert arc.stroke().length == float(arc.length)
            assert arc.stroke().at(0.999999) == pytest.approx(end.xy, abs=1e-4)
