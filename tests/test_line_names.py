"""Numbers of features and of the lines that touch two of them: who finds a line finds the same number."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product
from random import Random

import pytest
from flint import fmpq
from strategies import arc_terrain, degenerate_terrain

import exactacq as xa
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point
from exactacq.kernel.line_keys import LineNumbers
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.complex_edges import FamilySweeper
from exactacq.sensing.legs import legs_of
from exactacq.sensing.line_family import LineFamily, family_of
from exactacq.sensing.straight_way import StraightWay
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.sensing.way_cuts import WayCuts
from exactacq.visibility.features import features
from exactacq.visibility.line_names import Namer, Names
from exactacq.visibility.place_facts import numbers_of_way
from exactacq.visibility.sensor_range import Range

BITS = 256
Line = tuple[Point, Point]
"""A point and a direction."""


def sweeper_of(scene: xa.Scene, radius: int = 4) -> FamilySweeper:
    return FamilySweeper(EdgeTable(scene.obstacles), Range(fmpq(radius)))


def random_sweeper(seed: int) -> FamilySweeper:
    try:
        return sweeper_of((arc_terrain, degenerate_terrain)[seed % 2](Random(seed)).scene())
    except xa.InvalidScene:
        pytest.skip("no scene")


def named_lines(sweeper: FamilySweeper) -> Iterator[tuple[LineFamily, Line, Names, list[int]]]:
    """The first and the last line of all families, with their names and the numbers of their images."""
    for e in range(len(sweeper.table.curves)):
        found = sweeper.tangents(e), sweeper.normals(e), sweeper.corner_normals(e)
        for image in (image for families in found for image in families.images):
            family = family_of(image)
            ends = zip((family.low, family.high), family.names, strict=True)
            for (t, names), keys in zip(ends, (image.first_keys, image.last_keys), strict=True):
                yield family, family.sector.touch(t), names, keys


def vanishes(value: Real) -> bool:
    return bool(value.ball(BITS).contains(0))


def touches(table: EdgeTable, line: Line, feature: int) -> bool:
    """Whether a line passes a corner or touches a circle."""
    (contact, along), (center, radius_sq) = line, circle_of(table, feature)
    height = along.cross(center - contact)
    return vanishes(height * height - along.norm_sq() * radius_sq)


def same(a: Line, b: Line) -> bool:
    """Whether two lines are one, in whatever direction."""
    return vanishes(a[1].cross(b[1])) and vanishes(a[1].cross(b[0] - a[0]))


def touch_each_other(table: EdgeTable, features: tuple[int, int]) -> bool:
    """Whether two circles touch, or a corner, a circle of radius 0, and a circle: then some lines are one."""
    (p, a), (q, b) = (circle_of(table, feature) for feature in features)
    rest = (p - q).norm_sq() - a - b
    return rest * rest == 4 * a * b


def circle_of(table: EdgeTable, feature: int) -> tuple[Point, fmpq]:
    """Centre and square of the radius."""
    count = len(table.curves)
    if feature < count:
        return Point(*table.vertices[feature]), fmpq(0)
    arc = table.curves[feature - count]
    assert isinstance(arc, Arc)
    return arc.center, arc.radius_sq


@pytest.mark.parametrize("seed", range(8))
def test_a_number_is_one_line(seed: int) -> None:
    """Whatever a line is found from, it touches what its number says and has one direction by its sense.

    Lines with different numbers that touch the same two features are different lines, unless these two touch.
    """
    sweeper = random_sweeper(seed)
    numbers, lines, normals = sweeper.table.line_numbers, dict[int, Line](), 0
    for family, (contact, along), names, keys in named_lines(sweeper):
        if not names:
            assert len(keys) == 1 and keys[0] < 0
            continue
        is_normal = family.anchor is None
        assert is_normal or (keys == [key for key, _ in names] and min(keys) >= 0)
        for key, sense in names:
            pair, line = numbers.features(key), (contact, along * sense)
            assert is_normal or family.anchor in pair
            normals += is_normal
            assert all(touches(sweeper.table, line, feature) for feature in pair)
            known = lines.setdefault(key, line)
            assert same(known, line) and known[1].dot(line[1]).sign() > 0
    by_pair: dict[tuple[int, int], list[Line]] = {}
    for key, line in lines.items():
        by_pair.setdefault(numbers.features(key), []).append(line)
    for pair, some in by_pair.items():
        if not touch_each_other(sweeper.table, pair):
            assert not any(same(a, b) for a, b in combinations(some, 2))
    assert lines and (normals or not seed % 2)


def test_the_normal_at_a_right_angle_is_the_line_of_the_edge_beside() -> None:
    sweeper = sweeper_of(xa.Scene([xa.Polygon([(0, 0), (2, 0), (2, 1), (0, 3)])]))
    numbers, table = sweeper.table.line_numbers, sweeper.table
    found = {
        (e, float(t)): names
        for e in range(4)
        for image in sweeper.normals(e).images
        for t, names in zip(
            (family_of(image).low, family_of(image).high), family_of(image).names, strict=True
        )
    }
    corner = {e: table.curves[e].start.xy for e in range(4)}
    assert [corner[e] for e in range(4)] == [(0, 0), (2, 0), (2, 1), (0, 3)]
    # Senses: from the corner with the lower number, and normals lead away from the square.
    assert found[0, 0.0] == ((numbers.corners(0, 3), -1),) and found[0, 1.0] == ((numbers.corners(1, 2), -1),)
    assert found[1, 0.0] == ((numbers.corners(0, 1), 1),) and found[1, 1.0] == ()
    assert (
        found[3, 1.0] == ((numbers.corners(0, 1), -1),)
        and found[2, 0.0] == found[2, 1.0] == found[3, 0.0] == ()
    )


def test_what_a_number_says() -> None:
    """Corners, arcs and arcs of one circle: numbers are told apart, and taken apart again."""
    # Edges 2 and 4 are arcs of one circle, 3 is one of another; 0, 1 and 5 are straight.
    numbers = LineNumbers([0, 1, 2, 3, 2, 5])
    circle, other = numbers.feature(4, True), numbers.feature(3, True)
    assert circle == numbers.feature(2, True) and numbers.first_arc(circle) == 2
    assert numbers.is_circle(circle) and not numbers.is_circle(numbers.feature(4, False))
    found: dict[int, tuple[int, int]] = {}
    for a, b in combinations(range(6), 2):
        assert numbers.keys(a, [(b, 0, 1)]) == numbers.keys(b, [(a, 0, -1)]) == [numbers.corners(b, a)]
        found[numbers.corners(a, b)] = a, b
    for v, (arc, feature), sign in product(range(6), ((4, circle), (3, other)), (1, -1)):
        # The circle to the right of the way there lies to the left of the way back.
        (key,) = numbers.keys(v, [(arc, 1, sign)])
        assert [key] == numbers.keys(feature, [(v, 0, -sign)])
        found[key] = v, feature
    for side, sign in product((1, -1), repeat=2):
        (key,) = numbers.keys(circle, [(3, side, sign)])
        assert [key] == numbers.keys(other, [(4, side, sign if side > 0 else -sign)])
        found[key] = circle, other
    assert len(found) == 15 + 6 * 2 * 2 + 4
    for key, pair in found.items():
        assert numbers.features(key) == pair
        round_ = {2, 4} if circle in pair else set()
        assert {e for e in range(7) if numbers.touches(key, e)} == round_ | ({3} if other in pair else set())
    assert numbers.keys(circle, [(2, 1, 1), (4, -1, 1)]) == []


def test_arcs_of_the_own_circle_give_no_names() -> None:
    """A tangent of one half of a circle passes the other half, and a corner behind its contact."""
    circle = xa.Outline([(-1, 0, 1), (1, 0, 1)])
    table = EdgeTable(xa.Scene([circle, xa.Polygon([(1, 2), (2, 2), (2, 3), (1, 3)])]).obstacles)
    tangents = features(table)[0]
    assert tangents.edges == (0,) and table.circles[0] == table.circles[1] == 0
    sector, numbers = tangents.sectors[-1], table.line_numbers
    (key,) = numbers.keys(numbers.feature(0, True), [(2, 0, 1)])
    passed = ((1, 1, 1), (2, 0, 1), (1, -1, -1))
    assert Namer(table).names(tangents, sector, Real(sector.high), passed) == ((key, 1),)


def test_the_numbers_of_a_way_tell_which_lines_are_its_own() -> None:
    """A line through a corner and beside a circle that the way touches may be the other tangent."""
    shapes = [
        xa.Polygon([(2, 0), (1, -1), (3, -1)]),
        xa.Polygon([(5, 0), (6, 1), (4, 1)]),
        xa.Circle((9, -1), 1),
        xa.Circle((13, 2), 2),
    ]
    sweeper = sweeper_of(xa.Scene(shapes), 15)
    table, own = sweeper.table, (Point(0, 0), Point(1, 0))
    # The way is cut at the corners that it passes; all its legs know what its line touches.
    leg = legs_of(table, [], None, Segment(Point(0, 0), Point(14, 0)))[0]
    cuts = WayCuts(StraightWay(VisibilityComplex(table, sweeper.range), leg))
    found: set[tuple[int, bool]] = set()
    for _, line, names, _ in named_lines(sweeper):
        pairs = [table.line_numbers.features(key) for key, _ in names]
        touched = [pair for pair in pairs if {*pair} <= {*leg.touches}]
        if touched:
            is_own = same(line, own)
            assert cuts._is_along(names) == is_own
            found |= {(sum(map(table.line_numbers.is_circle, pair)), is_own) for pair in touched}
    assert found == {(0, True), (1, True), (1, False), (2, True), (2, False)}


@pytest.mark.parametrize("seed", range(20))
def test_a_way_finds_the_numbers_that_families_find(seed: int) -> None:
    """Of the line of two points, by what it touches: those of its families, and no other line's."""
    sweeper = random_sweeper(seed)
    table, numbers = sweeper.table, sweeper.table.line_numbers
    lines = [(line, [key for key, _ in names]) for _, line, names, _ in named_lines(sweeper) if names]
    known = {key: line for line, keys in lines for key in keys}
    for line, keys in Random(seed).sample(lines, min(len(lines), 60)):
        features = {feature for key in keys for feature in numbers.features(key)}
        round_ = {key for key in keys if any(map(numbers.is_circle, numbers.features(key)))}
        (contact, along), shift = line, Random(seed).uniform(-5, 5)
        places = contact + along * fmpq(*shift.as_integer_ratio()), contact + along * 7
        for ends in (places, places[::-1]):
            found = {*numbers_of_way(table, ends, features)}
            touching = {key for key in round_ if touch_each_other(table, numbers.features(key))}
            assert round_ - touching <= found
            assert all(same(line, known[key]) for key in found if key in known)
