"""Lines that graze obstacles, and where points lie: against the definitions, without what spares work."""

from __future__ import annotations

from functools import cmp_to_key
from itertools import pairwise, product
from random import Random

import pytest
from strategies import build, circle_grid, square_grid

import exactacq as xa
from exactacq.files.octagons import random_octagons
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.loops import locate
from exactacq.geometry.points import Location, Point
from exactacq.numbers.real import Real, fmpq
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import features
from exactacq.visibility.free_segment import walk_line

HALF = fmpq(1, 2)
COMB = [(0, 0), (9, 0), (9, 4), (8, 4), (8, 1), (6, 1), (6, 4), (4, 4), (4, 1), (2, 1), (2, 4), (0, 4)]
MOON = xa.Outline([(12, 0, "1/2"), (16, 0, 0), (16, 3, "-3/10"), (12, 3, 0)])
SAW = xa.Outline(
    [(k // 2 * 2 + k % 2, -3 + k % 2, f"{(-1) ** (k // 3)}/{k % 4 + 3}" if k % 5 else 0) for k in range(16)]
    + [(15, -4, 0), (0, -4, 0)]
)
ROOM = xa.Polygon([(-5, -5), (30, -5), (30, 20), (-5, 20)])
SCENES = {
    "comb": xa.Scene([xa.Polygon(COMB), MOON, SAW, xa.Circle((20, 2), 2)], enclosure=ROOM),
    "octagons": random_octagons(6, 3),
}


@pytest.mark.parametrize("name", SCENES)
def test_points_lie_where_all_edges_say(name: str) -> None:
    scene, rng = SCENES[name], Random(2)
    table = EdgeTable(scene.obstacles)
    corners = [edge.start for edge in table.curves]
    middles = [edge.point(HALF) for edge in table.curves]
    xs, ys = ([getattr(p, axis) for p in corners] for axis in "xy")
    level = [Point(rng.choice(xs), rng.choice(ys)) for _ in range(60)]
    root = Real(2).sqrt()
    beside = [Point(p.x + root - fmpq(rng.randint(10, 18), 10), p.y) for p in corners]
    near = [
        Point(p.x + e, p.y + f)
        for p in corners[:8]
        for e, f in product((fmpq(1, 10**40), 0, -root), repeat=2)
    ]
    found = set()
    for point in [*corners, *middles, *level, *beside, *near, Point(10**30, 1), Point(1, -(10**30))]:
        for obstacle in scene.obstacles:
            where = obstacle.locate(point)
            assert where is locate(obstacle.edges, point)
            found.add(where)
    assert found == set(Location)


def pad(x: int, bulge: str) -> xa.Outline:
    """A pad with round corners, as files have it: rounded, so that arcs and sides are not quite tangent."""
    rows = [(-8, -3, 0), (8, -3, bulge), (10, -1, 0), (10, 1, bulge), (8, 3, 0), (-8, 3, bulge), (-10, 1, 0)]
    return xa.Outline([(x + fmpq(u, 10), fmpq(v, 10), b) for u, v, b in [*rows, (-10, -1, bulge)]])


GRIDS = {
    "pads": xa.Scene([pad(4 * k, f"0.4142135623730{950 + k % 2}") for k in range(4)]),
    "squares": build(square_grid(3, 3)),
    "discs": build(circle_grid(3, 2)),
    "comb": SCENES["comb"],
}


@pytest.mark.parametrize("name", GRIDS)
def test_a_walk_ends_where_the_line_enters_an_obstacle(name: str) -> None:
    """Every place between two contacts is asked of every obstacle."""
    scene = GRIDS[name]
    table = EdgeTable(scene.obstacles)
    ended = grazed = 0
    for feature in features(table):
        for sector, share in product(feature.sectors, (fmpq(0), HALF, fmpq(3, 4), fmpq(1))):
            t = sector.low + share * (sector.high - sector.low)
            contact, direction = sector.touch(Real(t))
            for walk, sense in zip(walk_line(table, sector, Real(t), 50.0), (-1, 1), strict=True):
                onward = direction * sense
                taus = [
                    tau
                    for curve in table.curves
                    for tau in line_contacts(contact, onward, curve)
                    if tau.sign() > 0
                ]
                taus.sort(key=cmp_to_key(lambda a, b: a.compare(b)))
                expected = None
                for low, high in pairwise([Real(0), *taus, Real(10**3)]):
                    middle = contact + onward * ((low + high) * HALF)
                    if low < high and any(o.locate(middle) is Location.INSIDE for o in scene.obstacles):
                        expected = low
                        break
                assert walk.blocked is (expected is not None)
                last = abs(walk.hits[-1][0]) if walk.hits else Real(0)
                assert last == (taus[-1] if taus else Real(0)) if expected is None else last == expected
                ended, grazed = ended + walk.blocked, grazed + (len(walk.hits) > 1)
    assert ended > 10
    assert grazed > 3
