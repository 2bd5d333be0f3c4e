"""Walks along a boundary until it meets a segment, beside what shapely says that the two have in common."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest
import shapely
from nightly import some

import exactacq as xa
from exactacq.geometry.points import Point

SQUARE = xa.Polygon([(2, -1), (4, -1), (4, 1), (2, 1)])


def halts(robot: xa.Robot, hand: str, line: xa.Segment) -> list[Point]:
    """The places of one lap, from where it begins, at which the robot halts for the line."""
    found = []
    while robot.walk(hand, to=line).kind == "arrived":
        found.append(robot.position)
        assert len(found) < 100
    return found


def beside(*shapes: object) -> xa.Robot:
    """A robot at the boundary of what lies east of the origin."""
    robot = xa.Robot(xa.Scene(list(shapes), start=(0, 0), radius=50))
    assert robot.go_to((100, 0)).kind == "hit"
    return robot


def star(rng: Random) -> list[tuple[Fraction, int]]:
    """A polygon around (8, 0) with corners on a small lattice, so that lines pass corners and sides."""
    ways = [(4, 0), (3, 1), (2, 2), (1, 3), (0, 4), (-1, 3), (-2, 2), (-3, 1)]
    ways += [(-x, -y) for x, y in ways]
    picked = sorted({0, 4, 8, 12, *rng.sample(range(16), 6)})
    return [(8 + ways[k][0] * size, ways[k][1] * size) for k in picked for size in (rng.choice((1, 1, 2)),)]


@pytest.mark.parametrize("seed", some(range(200), 30))
def test_all_places_are_met_once_and_in_order_on_both_hands(seed: int) -> None:
    rng = Random(seed)
    corners = star(rng)
    line = xa.Segment(*rng.sample([(x, y) for x in range(1, 16, 2) for y in range(-5, 6)], 2))
    left, right = beside(xa.Polygon(corners)), beside(xa.Polygon(corners))
    ahead, back = halts(left, "left", line), halts(right, "right", line)
    assert ahead == back[::-1] and left.visited == right.visited == (0,)
    assert left.position == right.position and left.length == right.length
    ring = shapely.LinearRing([(float(x), float(y)) for x, y in corners])
    met = ring.intersection(shapely.LineString([line.start.xy, line.end.xy]))
    pieces = getattr(met, "geoms", [met])
    expected = {tuple(round(c, 9) + 0.0 for c in at) for piece in pieces for at in piece.coords}
    begin = tuple(round(c, 9) for c in left.position.xy)
    assert {tuple(round(c, 9) + 0.0 for c in at.xy) for at in ahead} == expected - {begin}
    assert len(ahead) == len(expected - {begin})


def test_a_circle_is_met_where_the_line_crosses_and_touches_it() -> None:
    circle = xa.Circle((5, 0), 2)
    assert halts(beside(circle), "left", xa.Segment((0, 0), (9, 0))) == [Point(7, 0)]
    assert halts(beside(circle), "right", xa.Segment((0, 2), (9, 2))) == [Point(5, 2)]
    high, low = halts(beside(circle), "right", xa.Segment((6, 9), (6, -9)))
    assert high == Point(6, xa.Real(3).sqrt()) and low == Point(6, -xa.Real(3).sqrt())


def test_a_walk_goes_on_from_a_line_in_the_same_lap() -> None:
    robot = beside(SQUARE)
    for line, place in (((3, -5), (3, 5)), Point(3, -1)), (((0, 0), (9, 0)), Point(4, 0)):
        assert robot.walk(to=xa.Segment(*line)).place == place
    assert robot.walk(until="acquire").kind == "event"
    assert robot.walk(to=xa.Segment((0, 0), (9, 0))).kind == "round"
    assert robot.length == 10 and robot.visited == (0,)


@pytest.mark.parametrize("hand", ["left", "right"])
def test_from_an_irrational_place_a_line_is_met_at_short_numbers(hand: str) -> None:
    """The rest of the edge has an irrational end; its line is rational all the same."""
    robot = xa.Robot(xa.Scene([SQUARE, xa.Circle((8, 0), 1)], start=(0, 0), radius="61/20"))
    robot.go_to((100, 0))
    assert robot.walk(until="sight").kind == "event"
    x, y = robot.position.x.rational, robot.position.y
    assert x == 4 and -1 < y < 1 and y.rational is None
    level = Fraction(9, 10) if hand == "left" else Fraction(-9, 10)
    halt = robot.walk(hand, to=xa.Segment((0, level), (9, level)))
    assert halt.kind == "arrived" and halt.place == Point(4, level)
    assert halt.place.y.rational is not None


def test_a_segment_without_length_is_refused() -> None:
    with pytest.raises(ValueError, match="two distinct ends"):
        beside(SQUARE).walk(to=xa.Segment((1, 1), (1, 1)))
