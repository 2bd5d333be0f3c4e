"""Which normals are left out because tangents tell as much: never one that matters, and nothing changes."""

from __future__ import annotations

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
from exactacq.kernel.normals import telling
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
def test_obstacles_are_in_sight_from_the_same_places(kind: str, seed: int) -> None:
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


def ends(shares: Shares, k: int) -> list[object]:
    """Where an obstacle comes into sight on a leg, and where it goes out of it."""
    return [(i.low, i.high) for i in shares.times(k).intervals]


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
