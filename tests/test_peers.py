"""Views against CGAL's, by way of pyvispoly (optional): both are exact, so the areas must be equal."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest
from strategies import POLYGONS, Similarity, degenerate_terrain, random_terrain

from exactacq import Length, Point, Polygon, Scene, isovist
from exactacq.files.octagons import random_octagons
from exactacq.geometry.points import Location

peers = pytest.importorskip("peers", reason="needs pyvispoly, an optional test dependency")

BEYOND = 1000
"""A radius beyond every scene here."""


def is_free(scene: Scene, point: tuple[Fraction, Fraction]) -> bool:
    """Whether the point is in the open free space."""
    return all(obstacle.locate(Point.of(point)) is Location.OUTSIDE for obstacle in scene.obstacles)


def free_points(scene: Scene, rng: Random, count: int) -> list[tuple[Fraction, Fraction]]:
    """Random rational points: every room here lies within 20 of the origin."""
    found: list[tuple[Fraction, Fraction]] = []
    while len(found) < count:
        point = Fraction(rng.randint(-1994, 1994), 97), Fraction(rng.randint(-1994, 1994), 101)
        if is_free(scene, point):
            found.append(point)
    return found


def corners(scene: Scene, rng: Random, count: int) -> list[tuple[object, object]]:
    """Random corners of obstacles."""
    every = [edge.start.rational for obstacle in scene.obstacles[:-1] for edge in obstacle.edges]
    return rng.sample(every, min(count, len(every)))


def star_room(rng: Random) -> Polygon:
    """A star-shaped room with 14 corners around the origin, at least 8 in any direction."""
    ring = []
    for k in range(14):
        turn, part = divmod(Fraction(4 * k, 14) + Fraction(rng.randint(0, 60), 997), 1)
        x, y = (1 - part * part) / (1 + part * part), 2 * part / (1 + part * part)
        for _ in range(turn % 4):
            x, y = -y, x
        size = rng.randint(10, 20)
        ring.append((size * x, size * y))
    return Polygon(ring)


def check(scene: Scene, points: list[tuple[object, object]]) -> None:
    """The areas of the views from all the points are CGAL's."""
    views = peers.views(scene)
    for point in points:
        area = isovist(scene, point, BEYOND).area
        assert area == Length(area.algebraic), "no arc is part of the view"
        assert (
            peers.number(area.algebraic.rational)
            == views.compute_visibility_polygon(peers.place(point)).area()
        ), point


def test_numbers_are_handed_over_exactly() -> None:
    for value in (Fraction(-(10**40) - 1, 3**50), Fraction(1, 3), 0, -(2**90) + 1):
        p, q = Fraction(value).as_integer_ratio()
        assert peers.number(value) * peers.number(q) == peers.number(p)
    assert peers.number(10**40) != peers.number(10**40 + 1)


@pytest.mark.parametrize("seed", range(4))
def test_among_octagons(seed: int) -> None:
    octagons = random_octagons(12, seed)
    scene = Scene(octagons.shapes, enclosure=Polygon(peers.square_around(octagons)))
    check(scene, free_points(scene, Random(seed), 5))


@pytest.mark.parametrize("seed", range(6))
def test_in_rooms_with_holes(seed: int) -> None:
    """A star-shaped room around polygons that are mostly not convex; from free points and from corners."""
    rng = Random(seed)
    middle = Similarity(shift=(Fraction(-3), Fraction(-3, 2)))
    terrain = middle.terrain(random_terrain(rng, POLYGONS))
    scene = Scene([Polygon(shape) for shape in terrain.shapes], enclosure=star_room(rng))
    check(scene, free_points(scene, rng, 5) + corners(scene, rng, 3))


@pytest.mark.parametrize("seed", range(6))
def test_degenerate_scenes(seed: int) -> None:
    """Small integers: collinear corners, shared lines, and views from corners along walls."""
    rng = Random(seed)
    shapes = [shape for shape in degenerate_terrain(rng).shapes if isinstance(shape, list)]
    polygons = [Polygon(shape) for shape in shapes if all(len(v) == 2 for v in shape)]
    room = Polygon([(-2, -2), (16, -2), (16, 11), (-2, 11)])
    scene = Scene(polygons, enclosure=room)
    grid = [(Fraction(rng.randint(-1, 15)), Fraction(rng.randint(-1, 10))) for _ in range(30)]
    check(scene, [point for point in grid if is_free(scene, point)][:6] + corners(scene, rng, 4))
