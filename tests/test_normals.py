"""Which normals are left out because tangents tell as much: never one that matters, and nothing changes."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from random import Random

import pytest
from flint import fmpq
from nightly import some
from strategies import arc_terrain, degenerate_terrain, random_terrain

import exactacq as xa
from exactacq import kernel
from exactacq.files.octagons import random_octagons
from exactacq.geometry.curves import Segment
from exactacq.kernel.normals import shows_along_normals, telling
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.terrain_components import Ground
from exactacq.sensing.leg_views import Shares
from exactacq.sensing.legs import legs_of
from exactacq.sensing.memory import Memory
from exactacq.sensing.sensor import Sensor
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.visibility.sensor_range import Range

Pair = tuple[fmpq, fmpq]
SCALE = fmpq(10, 11)
"""Of the lattice: far away floats round its differences."""


def dot(a: Pair, b: Pair) -> fmpq:
    return a[0] * b[0] + a[1] * b[1]


def minus(a: Pair, b: Pair) -> Pair:
    return a[0] - b[0], a[1] - b[1]


def right(v: Pair) -> Pair:
    return v[1], -v[0]


def is_partly_away(place: Pair, corners: list[Pair], square: fmpq) -> bool:
    """Whether a corner of an obstacle is out of range, or the place is in the box around it."""
    if any(dot(v, v) >= square for v in (minus(c, place) for c in corners)):
        return True
    xs, ys = zip(*corners, strict=True)
    return bool(min(xs) <= place[0] <= max(xs) and min(ys) <= place[1] <= max(ys))


def polygons(dice: Random, far: fmpq) -> xa.Scene:
    """Convex polygons far apart, with corners on a lattice: places on normals through vertices are common."""
    shapes = []
    for column, row in product(range(3), range(2)):
        x, y, a, b = 12 * column, 12 * row, dice.randint(1, 3), dice.randint(1, 3)
        forms = (
            [(x, y), (x + a, y), (x + a, y + b), (x, y + b)],
            [(x, y), (x + a, y), (x, y + b)],
            [(x - a, y), (x, y - b), (x + a, y), (x, y + b)],
            [(x - 1, y), (x, y - 1), (x + a, y - 1), (x + a, y + b), (x - 1, y + b)],
        )
        shapes.append(xa.Polygon([(u * SCALE + far, v * SCALE - far) for u, v in dice.choice(forms)]))
    return xa.Scene(shapes)


@pytest.mark.parametrize("far", [fmpq(0), fmpq(10**6, 3), fmpq(10**9, 7), fmpq(10**15, 7)])
@pytest.mark.parametrize("seed", some(range(60), 8))
def test_none_that_matters_is_left_out(seed: int, far: fmpq) -> None:
    """Exact numbers tell for places of a segment whether they are on a normal, and what is out of range.

    Also where all is far from the origin, and rounded.
    """
    dice, radius = Random(seed), fmpq(6)
    table = EdgeTable(polygons(dice, far).obstacles)
    fronts, edges = VisibilityComplex(table, Range(radius))._fronts, list(range(len(table.curves)))
    reach = Range(radius).below, Range(radius).above
    for _ in range(20):
        begin, end = (
            (dice.randint(-8, 32) * SCALE + far, dice.randint(-8, 20) * SCALE - far) for _ in range(2)
        )
        if dice.random() < 0.5:
            # Along the rim of a strip.
            e = dice.choice(edges)
            start, stop = table.vertices[e], table.vertices[table.following[e]]
            (x, y), (u, v) = dice.choice([start, stop]), right(minus(stop, start))
            begin, end = ((x + k * u, y + k * v) for k in dice.sample(range(7), 2))
        spots = tuple((float(x), float(y)) for x, y in (begin, end))
        along, at_corners = map(set, telling(fronts, edges, spots, -1, reach))
        assert far > 10**9 or len(along) + len(at_corners) < 2 * len(edges)
        for e in edges:
            start, stop = table.vertices[e], table.vertices[table.following[e]]
            w, v = minus(stop, start), minus(start, table.vertices[table.preceding[e]])
            corners = [table.vertices[k] for k in table.edges_of(table.owners[e])]
            for k in range(25):
                share = fmpq(k, 24)
                place = begin[0] + share * (end[0] - begin[0]), begin[1] + share * (end[1] - begin[1])
                o = minus(place, start)
                if not is_partly_away(place, corners, radius * radius):
                    continue
                height = dot(o, right(w))
                is_before = height >= 0 and height**2 <= radius**2 * dot(w, w)
                if is_before and 0 <= dot(o, w) <= dot(w, w):
                    assert e in along
                if dot(o, v) >= 0 >= dot(o, w) and dot(o, o) <= radius**2:
                    assert e in at_corners


@pytest.mark.parametrize("far", [fmpq(0), fmpq(10**6, 3), fmpq(10**9, 7), fmpq(10**15, 7)])
@pytest.mark.parametrize("seed", some(range(60), 8))
def test_no_normals_of_the_path_that_matter_are_left_out(seed: int, far: fmpq) -> None:
    """They do where a place lies straight beside the piece, in range of it but not of either end."""
    dice, radius = Random(seed), fmpq(6)
    table = EdgeTable(polygons(dice, far).obstacles)
    fronts, edges = VisibilityComplex(table, Range(radius))._fronts, range(len(table.curves))
    reach, left_out = (Range(radius).below, Range(radius).above), 0
    for _ in range(60):
        begin = dice.randint(-8, 32) * SCALE + far, dice.randint(-8, 20) * SCALE - far
        end = begin[0] + dice.randint(-9, 9) * SCALE / 2, begin[1] + dice.randint(1, 9) * SCALE / 2
        along, spots = minus(end, begin), tuple((float(x), float(y)) for x, y in (begin, end))
        for e in edges:
            is_shown = shows_along_normals(fronts, [e], spots, reach)
            left_out += not is_shown
            start, stop = table.vertices[e], table.vertices[table.following[e]]
            for k in range(25):
                o, w = minus(start, begin), minus(stop, start)
                v = o[0] + fmpq(k, 24) * w[0], o[1] + fmpq(k, 24) * w[1]
                is_beside = 0 <= dot(v, along) <= dot(along, along)
                is_in_range = dot(v, right(along)) ** 2 <= radius**2 * dot(along, along)
                if is_beside and is_in_range and not is_shown:
                    assert min(dot(u, u) for u in (v, minus(v, along))) <= radius**2
    assert left_out > 60 * len(edges) / 2 or far > 10**8


@pytest.mark.parametrize("size", ["2", "1/2"])
def test_what_only_normals_of_the_path_show(size: str) -> None:
    """The robot walks by a wall that is just in range, and out of range of both ends of its way."""
    # From a short way all of a wall is in range of one end that is nearer.
    for height, is_shown in (("4.8", False), ("4.99", size == "2"), ("5", True), ("5.01", False)):
        wall = xa.Polygon([(0, height), (1, height), (1, 7), (0, 7)])
        a, b = Fraction("1/2") - Fraction(size) / 2, Fraction("1/2") + Fraction(size) / 2
        sensor = Sensor(EdgeTable(xa.Scene([wall]).obstacles), Range(fmpq(5)))
        (leg,) = legs_of(sensor.table, sensor.rails, None, Segment(xa.Point(a, 0), xa.Point(b, 0)))
        assert sensor.complex.shows_along_normals(leg.spots, [0]) is is_shown
        every = sensor.shares(leg)
        some_ = Shares(sensor.complex, sensor.targets, leg, {0}, sensor._view, {})
        assert shown(some_) == shown(every)


def test_what_only_normals_of_an_arc_show() -> None:
    """The robot walks around the upper half of a disc, and a wall is in range near the top of it alone."""
    scene = xa.Scene([xa.Circle((0, 0), 1), xa.Polygon([(-1, "5.9"), (1, "5.9"), (1, 7), (-1, 7)])])
    sensor = Sensor(EdgeTable(scene.obstacles), Range(fmpq(5)))
    half = scene.obstacles[0].edges[0].part(xa.Point(1, 0), xa.Point(-1, 0))
    (leg,) = legs_of(sensor.table, sensor.rails, 0, half)
    every = sensor.shares(leg)
    some_ = Shares(sensor.complex, sensor.targets, leg, every.obstacles, sensor._view, {})
    assert shown(some_) == shown(every)
    assert {0, 1} == {e for e, *_ in shown(some_)[0]}


def test_few_are_kept() -> None:
    """Of the normals that a leg among octagons may meet a twentieth tell what tangents do not."""
    table = EdgeTable(random_octagons(30, 1).obstacles)
    complex_ = VisibilityComplex(table, Range(fmpq(10)))
    kept = offered = 0
    for e in range(0, len(table.curves), 7):
        every, some_ = complex_.near(table.spots(e)), complex_.telling(table.spots(e), e)
        kept, offered = kept + len(some_), offered + len(every)
    assert kept < 0.6 * offered, "of three kinds of families one is kept all"


def test_of_an_obstacle_that_is_cut_all_normals_count() -> None:
    """Its tangents may touch what is beyond the border."""
    table = EdgeTable(xa.Scene([xa.Polygon([(0, 0), (1, 0), (1, 1), (0, 1)])]).obstacles)
    spots = ((0.5, -2.0), (0.5, -1.0))
    for cut, found in (((), []), ((0,), [0])):
        fronts = VisibilityComplex(table, Range(fmpq(9)), cut)._fronts
        assert telling(fronts, [0, 1, 2, 3], spots, -1, (9.0, 9.0)) == (found, [])


def test_none_are_left_out_if_floats_tell_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    table = EdgeTable(xa.Scene([xa.Circle((0, 0), 1), xa.Polygon([(4, 0), (5, 0), (5, 1)])]).obstacles)
    complex_, spots = VisibilityComplex(table, Range(fmpq(9))), ((2.0, -1.0), (2.0, 1.0))
    assert len(complex_.telling(spots)) == len(table.curves) < len(complex_.near(spots))
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    assert complex_.telling(spots) == complex_.near(spots)


def scene_of(kind: str, seed: int) -> xa.Scene:
    if kind == "octagons":
        return random_octagons(12, seed)
    makers = {"arcs": arc_terrain, "degenerate": degenerate_terrain, "general": random_terrain}
    return makers[kind](Random(seed)).scene()


@pytest.mark.parametrize("kind", ["octagons", "arcs", "degenerate", "general"])
@pytest.mark.parametrize("seed", some(range(20), 5))
def test_the_same_is_shown_from_the_same_places(kind: str, seed: int) -> None:
    """With the normals that are left out every obstacle is in sight from where it was without them."""
    try:
        scene = scene_of(kind, seed)
    except xa.InvalidScene:
        pytest.skip("no scene")
    for radius in (2, 5):
        run = xa.sightseer(scene, radius)
        sensor = Sensor(EdgeTable(run.scene.obstacles), Range(run.radius))
        for piece in run.path[:12]:
            leg = legs_of(sensor.table, sensor.rails, piece.obstacle, piece.curve)[0]
            near = sensor.shares(leg)
            few = Shares(sensor.complex, sensor.targets, leg, near.obstacles, sensor._view, {})
            for k in near.obstacles:
                assert ends(few, k) == ends(near, k)
            assert shown(few) == shown(near)


def ends(shares: Shares, k: int) -> list[object]:
    """Where an obstacle comes into sight on a leg, and where it goes out of it."""
    return [(i.low, i.high) for i in shares.times(k).intervals]


def shown(shares: Shares) -> tuple[set[object], set[int]]:
    """What a leg shows: intervals of edges, and vertices, which alone are told of either edge or of both."""
    table, rails = shares.complex.table, shares.complex.clipper.rails
    parts, vertices = set[object](), set[int]()
    for e, cover in shares.taught({}).items():
        for part in cover.intervals:
            is_first, is_last = part.low.sign() == 0, part.high == rails[e].top
            vertices.update([e] * is_first + [table.following[e]] * is_last)
            if not (part.low == part.high and (is_first or is_last)):
                parts.add((e, digits(part.low), digits(part.high)))
    return parts, vertices


def digits(number: Real) -> str:
    return number.decimal(40)


def memory_of(shape: object, terrain: xa.Terrain, radius: fmpq) -> Memory:
    """That of a robot confined to a terrain."""
    scene = xa.Scene([shape], terrain=terrain, radius=radius)
    return Memory(scene, radius, ground=Ground(scene.obstacles, terrain))


def test_from_one_part_of_an_obstacle_another_comes_into_sight() -> None:
    """A border cuts them apart: the robot walks up the straight one and comes into range of the slant one.

    For a while both ends of that edge are out of range, and so is what normals of the robot's own edge meet.
    """
    corners = [(2, 2), (4, 2), (4, 25), (6, 25), (6, 17), (20, 3), (22, 3), (22, 30), (2, 30)]
    sensor = memory_of(xa.Polygon(corners), xa.Terrain(24, 20), fmpq(9))._sensor
    walk = Segment(xa.Point(4, 2), xa.Point(4, 20))
    (leg,) = legs_of(sensor.table, sensor.rails, 0, walk)
    every = sensor.shares(leg)
    some_ = Shares(sensor.complex, sensor.targets, leg, every.obstacles, sensor._view, {})
    (other,) = (k for k in every.obstacles if not every._is_along(k))
    assert ends(some_, other) == ends(every, other)
    begin = leg.rail.point(every.times(other).intervals[0].low.enclosure(60)[1])
    assert float(begin.y) == pytest.approx(19 - 9 * 2**0.5)


def test_an_edge_of_two_parts_is_done_when_both_are_known() -> None:
    """An arch of which the border cuts off the top: its arc belongs to both legs."""
    arch = xa.Outline([(2, 3), (4, 3), (4, 6, -1), (12, 6), (12, 3), (14, 3), (14, 20), (2, 20)])
    targets = memory_of(arch, xa.Terrain(20, 8), fmpq(5))._sensor.targets
    one, other = targets.edges
    assert len(one & other) == 1 and set(targets.cut) == {0}
    assert targets.alone(0) == one - other and targets.alone(1) == other - one
