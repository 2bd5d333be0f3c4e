"""Arcs told by a centre or a third point: what bends, what is refused, and scenes of them."""

from __future__ import annotations

import json
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import sympy
from flint import fmpq
from hypothesis import assume, given
from hypothesis import strategies as st

import exactacq as xa
from exactacq.files.scene_json import scene_to_json
from exactacq.scene.shapes import shape_edges

Q = Fraction
numbers = st.fractions(-9, 9, max_denominator=12)
places = st.tuples(numbers, numbers)
QUARTER = [(0, 0), (1, 0, xa.Around((0, 0))), (0, 1)]


def first_arc(start: object, told: object, end: object) -> object:
    """The first edge of an outline from one point to another and back by a detour."""
    return shape_edges(xa.Outline([(*start, told), end, (100, 77)]))[0]  # type: ignore[misc]


@given(places, places, places)
def test_the_arc_through_three_points_passes_them_in_order(
    start: object, middle: object, end: object
) -> None:
    """The oracle is sympy's circle."""
    assume(len({start, middle, end}) == 3)
    s, m, e = (sympy.Point(*map(sympy.Rational, map(str, p))) for p in (start, middle, end))  # type: ignore[call-overload]
    if sympy.Point.is_collinear(s, m, e):
        assume((m - s).dot(e - s) > 0 and (m - e).dot(s - e) > 0)
        assert isinstance(first_arc(start, xa.Via(middle), end), xa.Segment)
        return
    arc = first_arc(start, xa.Via(middle), end)
    circle = sympy.Circle(s, m, e)
    assert isinstance(arc, xa.Arc) and arc.passes(xa.Point(*middle))  # type: ignore[misc]
    assert str(arc.center.x) == str(circle.center.x) and str(arc.center.y) == str(circle.center.y)
    assert arc == first_arc(start, xa.Around(arc.center.rational, arc.ccw), end)
    back = first_arc(end, xa.Via(middle), start)
    assert back == arc.reversed()


@given(places, places, st.fractions(-5, 5, max_denominator=20).filter(bool))
def test_a_rational_bulge_is_found_again(start: object, end: object, bulge: Fraction) -> None:
    """Told by the centre of the arc that it makes."""
    assume(start != end)
    one = xa.Outline([(*start, bulge), end, (100, 77)])  # type: ignore[misc]
    arc = shape_edges(one)[0]
    assert one == xa.Outline([(*start, xa.Around(arc.center.rational, arc.ccw)), end, (100, 77)])  # type: ignore[misc]


def test_a_quarter_circle_has_no_rational_bulge() -> None:
    quarter = xa.Outline(QUARTER)
    assert quarter.vertices[1][2] == xa.Around((0, 0))
    (shape,) = xa.Scene([quarter]).obstacles
    assert str(shape.area) == "pi/4"
    assert str(shape.perimeter) == "pi/2 + 2"
    clockwise = xa.Outline([(0, 0), (0, 1, xa.Around((0, 0), ccw=False)), (1, 0)])
    assert str(xa.Scene([clockwise]).obstacles[0].area) == "pi/4"
    assert -clockwise.vertices[1][2] == quarter.vertices[1][2]


@pytest.mark.parametrize(
    "told",
    [xa.Via((-1, 0)), xa.Around((0, 0)), xa.Around((0, 0), ccw=False), xa.Via(("-3/5", "4/5"))],
)
def test_a_full_circle_is_two_halves(told: object) -> None:
    """By a third point that is opposite; another point would make another circle."""
    for ring in ([(1, 0, told)], [(1, 0, told), (1, 0)]):
        (shape,) = xa.Scene([xa.Outline(ring)]).obstacles
        assert len(shape.edges) == 2
        radius_sq = 1 if told != xa.Via(("-3/5", "4/5")) else Q(4, 5)
        assert shape.area == xa.Length.turns(1, Q(1, 2) * radius_sq)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: xa.Outline([(0, 0, xa.Around((1, 1))), (3, 0), (0, 3)]),
            "vertex 0: the centre is",
        ),
        (lambda: xa.Outline([(0, 0, xa.Via((4, 0))), (3, 0), (0, 3)]), "vertex 0: .* not between them"),
        (lambda: xa.Outline([(0, 0, xa.Via((0, 0))), (3, 0), (0, 3)]), "vertex 0: .* not between them"),
        (lambda: xa.Outline([(0, 0, xa.Via((3, 0))), (3, 0), (0, 3)]), "vertex 0: .* not between them"),
        (lambda: xa.Outline([(0, 0, xa.Via((0, 0)))]), "vertex 0: an arc from a point to itself"),
        (lambda: xa.Outline([(0, 0, xa.Around((0, 0)))]), "vertex 0: an arc from a point to itself"),
        (lambda: xa.Outline([(0, 0, "round"), (3, 0), (0, 3)]), "vertex 0: not a number: 'round'"),
        (lambda: xa.Polygon(QUARTER), "a Polygon has no bulges: use Outline"),
        (lambda: xa.Around(3), "a point needs two numbers, not 3"),
        (lambda: xa.Around((0, 0), ccw="yes"), "ccw is True or False, not 'yes'"),
        (lambda: xa.Via((1, "x")), "not a number: 'x'"),
    ],
)
def test_what_makes_no_arc(make: object, message: str) -> None:
    with pytest.raises(xa.FormatError, match=message) as caught:
        make()  # type: ignore[operator]
    assert "\n" not in str(caught.value)


def test_an_arc_from_a_point_to_itself_by_a_bulge_stays_for_the_scene_to_refuse() -> None:
    with pytest.raises(xa.InvalidScene, match="zero length"):
        xa.Scene([xa.Outline([(0, 0, 1), (0, 0), (1, 1), (0, 3)])])


def rounded() -> xa.Scene:
    """A room with a rounded corner, a rounded square, and a lens through irrational bulges."""
    wall = xa.Outline([(0, 0), (20, 0), (20, 8, xa.Around((16, 8))), (16, 12), (0, 12)])
    square = xa.Outline(
        [(5, 4, xa.Around((5, 5))), (6, 5), (6, 7), (4, 7), (4, 5, xa.Around((5, 5)))], name="rounded"
    )
    lens = xa.Outline([(10, 4, xa.Via(("23/2", 5))), (12, 8, xa.Via((10, 6)))], name="lens")
    return xa.Scene([square, lens], start=(1, 1), enclosure=wall, radius=9)


def test_runs_among_such_arcs_pass_the_audit() -> None:
    run = xa.sightseer(rounded())
    assert sorted(run.visits) == [0, 1, 2]
    xa.audit(run)
    swept = xa.Scene(rounded().shapes, terrain=xa.Terrain(20, 12), radius=4, start=(0, 0))
    xa.audit(xa.seed_spreader(swept))


def test_json_keeps_them(tmp_path: Path) -> None:
    scene = rounded()
    document = scene_to_json(scene)
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(document))
    assert xa.load(path) == xa.Scene(
        scene.shapes, start=(1, 1), enclosure=scene.enclosure, radius=9, name=None
    )
    assert scene_to_json(xa.load(path)) == document
    assert '{"center": [16, 8]}' in json.dumps(document)


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ("{}", 'an arc has either a "center" or a point "through"'),
        ('{"center": [0, 0], "through": [1, 1]}', 'an arc has either a "center" or a point "through"'),
        ('{"through": [1, 1], "clockwise": true}', "unknown key 'clockwise'"),
        ('{"center": [0, 0], "clockwise": 1}', "clockwise: true or false is needed, not a number"),
        ('{"center": [0]}', r"center: \[x, y\] is needed, not 1 values"),
        ('{"centre": [0, 0]}', "unknown key 'centre'"),
        ('{"center": [7, 0]}', r"obstacles\[0\]: vertex 0: the centre is not equally far"),
    ],
)
def test_json_arcs_that_are_none(tmp_path: Path, told: str, message: str) -> None:
    path = tmp_path / "scene.json"
    path.write_text(f'{{"obstacles": [{{"boundary": [[1, 0, {told}], [0, 1], [0, 0]]}}]}}')
    with pytest.raises(xa.FormatError, match=message):
        xa.load(path)


def test_json_by_a_third_point(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text('{"obstacles": [{"boundary": [[1, 0, {"through": [0, 1]}], [-1, 0]]}]}')
    assert xa.load(path).shapes == (xa.Outline([(1, 0, 1), (-1, 0)]),)


@pytest.mark.parametrize(
    "half", [0.5, "0.5", "1/2", Q(1, 2), Decimal("0.5"), fmpq(1, 2), np.float32(0.5), np.float64(0.5),
             np.longdouble(0.5), sympy.Rational(1, 2), xa.Real("1/2"), xa.Length("1/2")],
)  # fmt: skip
@pytest.mark.parametrize("three", [3, "3", 3.0, np.int8(3), np.uint64(3), sympy.Integer(3), Decimal(3), Q(3)])
def test_numbers_of_all_kinds_are_numbers(half: object, three: object) -> None:
    assert xa.Circle((half, three), half) == xa.Circle(("1/2", 3), "1/2")
    assert xa.Outline([(0, 0), (three, 0, half), (0, half)]) == xa.Outline(
        [(0, 0), (3, 0, "1/2"), (0, "1/2")]
    )


@pytest.mark.parametrize("value", [sympy.pi, sympy.oo, sympy.nan, sympy.I, sympy.Symbol("x"), np.True_, 1j])
def test_what_is_no_rational_is_none(value: object) -> None:
    with pytest.raises(xa.FormatError):
        xa.Circle((0, 0), value)


@pytest.mark.parametrize("ring", [QUARTER, [(0, 0), (1, 0, "1/3"), (0, 1)], [(0, 0), (1, 0), (0, 1)]])
def test_closed_and_clockwise_rings_are_the_same_obstacle(ring: list[tuple[object, ...]]) -> None:
    ways = [ring, [*ring, ring[0][:2]]]
    if len(ring[1]) == 2:
        ways += [ring[::-1], [*ring[::-1], ring[-1]]]
    areas = [xa.Scene([xa.Outline(way)]).obstacles[0].area for way in ways]
    assert all(area == areas[0] for area in areas)
