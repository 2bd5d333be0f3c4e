"""Numbers, points and rings as other libraries have them are taken where they are unambiguous."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import shapely
import sympy
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st

import exactacq as xa

SQUARE = [(0, 0), (0, 1), (1, 1), (1, 0)]  # clockwise
NUMBERS = (
    int, float, np.int16, np.int64, np.float32, np.float64, np.longdouble, np.array, sympy.Integer, Decimal,
    Fraction, fmpq, str,
)  # fmt: skip
HALVES = (
    float,
    np.float16,
    np.float64,
    np.array,
    lambda x: sympy.Rational(int(2 * x), 2),
    Decimal,
    Fraction,
    str,
)


@given(value=st.integers(-(2**14), 2**14), kind=st.sampled_from(NUMBERS))
def test_whole_numbers_of_all_kinds(value: int, kind: type) -> None:
    assert xa.Circle((kind(value), 0), kind(3)) == xa.Circle((value, 0), 3)
    assert xa.Point(kind(value), 1) == xa.Point(value, 1)
    assert xa.Terrain(kind(5), 5, (kind(value), 0)) == xa.Terrain(5, 5, (value, 0))
    assert xa.Scene([], radius=kind(7), start=(kind(value), 0)) == xa.Scene([], radius=7, start=(value, 0))


@given(value=st.integers(-(2**9), 2**9).map(lambda n: n / 2), kind=st.sampled_from(HALVES))
def test_halves_of_all_kinds(value: float, kind: type) -> None:
    assert xa.Polygon([(kind(value), 0), (1000, 0), (0, 1000)]).vertices[0][0] == fmpq(int(2 * value), 2)


@given(st.floats(-1e9, 1e9))
def test_a_float_is_the_binary_fraction_that_it_is(value: float) -> None:
    exact = Fraction(value)
    assert xa.Circle((value, 0), 1).center[0] == fmpq(exact.numerator, exact.denominator)
    assert xa.Circle((np.float64(value), 0), 1) == xa.Circle((value, 0), 1)
    assert xa.Circle((repr(value), 0), 1).center[0] == xa.Circle((Decimal(repr(value)), 0), 1).center[0]


def test_tenths() -> None:
    assert xa.Circle((0, 0), "0.1").radius == xa.Circle((0, 0), Decimal("0.1")).radius == fmpq(1, 10)
    assert xa.Circle((0, 0), 0.1).radius != fmpq(1, 10)


@pytest.mark.parametrize(
    "value",
    [True, np.bool_(True), np.array(True), np.array([1.5]), sympy.sqrt(2), sympy.Float("0.1"), 1j, "x", None,
     float("nan"), np.float64("inf"), np.array(np.nan), Decimal("NaN")],
    ids=repr,
)  # fmt: skip
def test_what_is_no_number_or_ambiguous(value: object) -> None:
    with pytest.raises(xa.FormatError, match=r"center: not a (finite )?number: "):
        xa.Circle((value, 0), 1)


@given(st.integers(0, 3), st.booleans(), st.booleans())
def test_closed_and_clockwise_rings(first: int, closed: bool, clockwise: bool) -> None:
    ring = SQUARE[first:] + SQUARE[:first]
    ring = (ring if clockwise else ring[::-1]) + ([] if not closed else [ring[0] if clockwise else ring[-1]])
    for given_so in (ring, np.array(ring), np.array(ring, dtype=np.float32), tuple(map(list, ring))):
        scene = xa.Scene([xa.Polygon(given_so)], start=(5, 5))
        assert str(scene.obstacles[0].area) == "1"
        assert len(scene.obstacles[0].edges) == 4


def test_objects_of_shapely() -> None:
    square, closed = xa.Polygon(SQUARE), [*SQUARE, SQUARE[0]]
    for ring in (shapely.Polygon(SQUARE), shapely.LinearRing(SQUARE), shapely.LineString(closed)):
        assert xa.Polygon(ring) == square
    with pytest.raises(xa.FormatError, match="a boundary is closed: its last vertex is the first one"):
        xa.Polygon(shapely.LineString(SQUARE))
    scene = xa.Scene([shapely.box(2, 2, 3, 3)], start=shapely.Point(0.5, 0))
    assert scene.start == xa.Point("1/2", 0)
    assert xa.isovist(scene, shapely.Point(1, 1), 3).point == xa.Point(1, 1)


def test_points_of_ours_stay_exact() -> None:
    """They offer floats to other libraries, which must not be taken for them."""
    third = xa.Point("1/3", 0)
    assert xa.Scene([], start=third).start == third
    assert xa.Point.of(third) is third


def test_areas_that_are_loaded() -> None:
    box = shapely.box(2, 2, 3, 3)
    whole = xa.load(box, start=shapely.Point(0, 0))
    for areas in ([box], (box,), [[box]], box.__geo_interface__, [box.__geo_interface__]):
        assert xa.load(areas, start=(0, 0)) == whole
    for other in ([1, 2], [], 3, None):
        with pytest.raises(xa.FormatError, match="a file's or scene's name, or areas, are loaded, not"):
            xa.load(other)  # type: ignore[arg-type]
