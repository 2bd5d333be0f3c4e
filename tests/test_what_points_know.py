"""What robots that halt where something happens hand on from place to place is true, and they decide by it.

Each place is made of the one before, so that numbers soon tell nothing: what touches what is known because of
how places were made.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from fractions import Fraction

import pytest
from flint import arb, fmpq
from nightly import NIGHTLY

import exactacq as xa
from exactacq import Point
from exactacq.geometry import constructions
from exactacq.geometry.constructions import (
    Carrier,
    circles_touched,
    corners_passed,
    is_put_on,
    put_equal,
    put_on,
    put_on_line,
    put_on_tangent,
    put_past_corner,
    tangent_side,
    touch_on_tangent,
)
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc
from exactacq.geometry.interval_union import Cover, Interval
from exactacq.numbers.precision import workprec
from exactacq.numbers.real import Real
from exactacq.study.families.scenes import family_scene
from exactacq.study.random_scenes import Subject, arc_scene

BITS = 600
FAMILIES = ["plates", "boards", "floor-plans", "gears", "slots", "words", "staircases"]
UNIT = Arc.circle(Point(0, 0), fmpq(1))
ROOT3 = Real(3).sqrt()

Kinds = tuple[str, ...]


def scene_of(number: int) -> xa.Scene:
    """Of nine scenes seven are like drawings, and two have arcs at random."""
    kind, seed = number % 9, number // 9
    if kind < 7:
        return family_scene(FAMILIES[kind], 20 if kind in (3, 6) else 12, seed, "sightseer")
    return arc_scene(Subject.SIGHTSEER, seed)


def again_and_again(number: int, kinds: Kinds) -> Callable[[xa.Robot], None]:
    """Towards an end of what is known, until something happens, and then towards another one."""

    def own(robot: xa.Robot) -> None:
        for n in range(14):
            ends = robot.frontier
            if not ends:
                return
            robot.go_to(ends[(7 * n + number) % len(ends)][1], until=kinds)

    return own


ALL, SEEN = ("sight", "regain", "acquire", "lose"), ("sight", "regain")


@pytest.mark.parametrize(
    ("number", "kinds"),
    [
        pytest.param(5, ("sight",), id="a way to a corner is seen along, far beyond its end"),
        pytest.param(5, SEEN, id="what is seen past the corner where a way ends"),
        pytest.param(10, ("sight",), id="a frontier a quarter of the way around a circle"),
        pytest.param(13, ("lose",), id="a halt at the range beside an edge"),
        pytest.param(20, SEEN, id="a line through a corner and along a disc"),
        pytest.param(31, ("lose",), id="a place in line with the straight end of an arc"),
        pytest.param(0, ("lose",), id="a halt on the tangent to what was seen last"),
        pytest.param(40, ("lose",), id="a halt on a line of two discs"),
        pytest.param(41, SEEN, id="a view that is as long as the range where the way ends"),
        pytest.param(11, ALL, id="an own line that is another's end"),
        pytest.param(112, ALL, id="a point at the range on an upright edge"),
        pytest.param(54, ("sight",), id="a level line that touches a disc where another ends"),
        pytest.param(63, ("lose",), id="a way that ends on an edge"),
        pytest.param(58, ("lose",), id="a line of three discs under two numbers"),
    ],
)
def test_robots_that_decide_anew_where_something_happens(number: int, kinds: Kinds) -> None:
    """Each was `Undecided`, as something that is known by how a place was made was not handed on."""
    run = xa.explore(scene_of(number), again_and_again(number, kinds))
    assert len(run.events) > 5


def ball(point: Point) -> tuple[arb, arb]:
    return point.x.ball(BITS), point.y.ball(BITS)


def is_true(point: Point, fact: object) -> bool:
    """Whether long balls hold what a point is told; they are too long for it to be chance."""
    x, y = ball(point)

    def square(a: arb, b: arb) -> arb:
        return a * a + b * b

    def height(origin: Point, u: arb, v: arb) -> tuple[arb, arb]:
        """The height of (u, v) above the line from a point to this one, times its length, and the length."""
        a, b = ball(origin)
        return (x - a) * (v - b) - (y - b) * (u - a), square(x - a, y - b)

    with workprec(BITS):
        match fact:
            case Carrier(cx, cy, radius_sq):
                off = square(x - cx, y - cy) - radius_sq
            case constructions._CircleAbout(center, radius_sq):
                u, v = ball(center)
                off = square(x - u, y - v) - radius_sq
            case constructions._CircleNormal(origin, carrier):
                off, _ = height(origin, arb(carrier.x), arb(carrier.y))
            case constructions._CornerLine(origin, corner):
                off, _ = height(origin, *ball(corner))
            case constructions._CircleTangent(origin, carrier, touch):
                across, size = height(origin, arb(carrier.x), arb(carrier.y))
                off = across * across - size * carrier.square
                if touch is not None and not abs(height(origin, *ball(touch))[0]) < 1e-50:
                    return False
            case _:
                raise AssertionError(f"no kind of fact: {fact}")
        return bool(abs(off) < 1e-50)


@pytest.mark.parametrize("number", range(0, 45 if NIGHTLY else 9))
def test_what_points_are_told_is_true(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[tuple[Point, object]] = []
    put = constructions._put

    def noted(point: Point, fact: object) -> None:
        told.append((point, fact))
        put(point, fact)  # type: ignore[arg-type]

    monkeypatch.setattr(constructions, "_put", noted)
    with suppress(xa.Undecided):
        xa.explore(scene_of(number), again_and_again(number, ALL))
    assert told
    for point, fact in told[:: 1 + len(told) // 120]:
        assert is_true(point, fact), (point.xy, fact)


# -- what is handed on, one by one -----------------------------------------------------------------

FAR = Point(2, 0)
TOUCH = Point(fmpq(1, 2), ROOT3 / 2)
"""Where the upper tangent from `FAR` touches the unit circle."""
BEYOND = Point(-1, ROOT3)


def test_equal_points_know_what_either_does() -> None:
    """A cover keeps one of two ends that are found to be equal."""
    rail, again = Rail(UNIT), Point(*TOUCH)
    put_on_tangent(again, FAR, UNIT.carrier)
    old, new = (Interval(rail.parameter(point), point, Real(2), Point(-1, 0)) for point in (TOUCH, again))
    cover = Cover((old,))
    assert cover.added(new) is cover
    assert circles_touched(FAR, TOUCH) == [UNIT.carrier]
    assert is_put_on(again, UNIT.carrier)
    one, other = Point(7, ROOT3), Point(7, ROOT3)
    put_past_corner(one, Point(0, 0), Point(14, 2 * ROOT3))
    put_equal(one, other)
    put_equal(one, other)
    assert [len(corners_passed(Point(0, 0), point)) for point in (one, other)] == [1, 1]


def test_a_point_between_takes_over_where_the_line_touches() -> None:
    """That was left out where the line ends in the point of contact."""
    end, between = Point(*TOUCH), (FAR + TOUCH) * fmpq(1, 2)
    put_on(end, UNIT.carrier)
    put_on_tangent(end, FAR, UNIT.carrier)
    put_on_line(between, FAR, end)
    assert touch_on_tangent(FAR, between, UNIT.carrier) is end


@pytest.mark.parametrize("upper", [True, False])
def test_two_tangents_from_one_point_on_one_side_are_one_line(upper: bool) -> None:
    """A place on the tangent from a corner sees along the tangent to that side past the corner."""
    corner, place = Point(8, -2 * ROOT3), (FAR + TOUCH) * fmpq(1, 2)
    put_on_tangent(place, corner, UNIT.carrier)
    end = Point(*BEYOND) if upper else Point(0, -1)
    assert bool(tangent_side(place, end, UNIT.carrier) == tangent_side(place, corner, UNIT.carrier)) is upper
    put_on_tangent(end, place, UNIT.carrier)
    assert (corners_passed(place, end) == [corner]) is upper


def test_a_point_of_a_circle_knows_it_where_no_ball_tells_its_quarter() -> None:
    near = Fraction(1, 10**40)
    point = Point(near, Real(1 - near * near).sqrt())
    Rail(UNIT).parameter(point)
    assert is_put_on(point, UNIT.carrier)


def test_corners_keep_nothing_of_runs() -> None:
    """They outlive them."""
    scene = scene_of(39)
    for kinds in (ALL, SEEN):
        with suppress(xa.Undecided):
            xa.explore(scene, again_and_again(1, kinds))
    corners = [edge.start for obstacle in scene.obstacles for edge in obstacle.edges]
    facts = [fact for corner in corners for fact in constructions._facts(corner)]
    assert all(isinstance(fact, Carrier) for fact in facts)
