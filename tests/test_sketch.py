"""Loops in floats, of which `check` makes its proposals, beside shapely and exact winding numbers."""

from __future__ import annotations

import warnings
from random import Random

import numpy as np
import pytest
import shapely
from flint import fmpq
from nightly import some

import exactacq as xa
from exactacq.files.checking.sketch import Sketch
from exactacq.geometry.box_index import box
from exactacq.geometry.curves import Arc
from exactacq.geometry.loops import winding
from exactacq.scene.shapes import shape_edges


def test_places_in_loops_are_told_as_shapely_does() -> None:
    random = Random(8)
    rings = [[(random.random(), random.random()) for _ in range(7)] for _ in range(20)]
    circle = xa.Circle((fmpq(1, 2), fmpq(1, 2)), fmpq(1, 4))
    sketch = Sketch([*(xa.Polygon(ring) for ring in rings), circle])
    areas = [shapely.make_valid(shapely.Polygon(ring)) for ring in rings]
    areas.append(shapely.geometry.shape(circle.__geo_interface__))
    places = np.array([(random.random(), random.random()) for _ in range(300)])
    around, clear = sketch.around(places), sketch.clearance(places)
    lines = [shapely.LinearRing(ring) for ring in rings] + [areas[-1].boundary]
    for k, place in enumerate(map(shapely.Point, places)):
        distance = min(line.distance(place) for line in lines)
        assert clear[k] == pytest.approx(distance, abs=1e-3)
        if distance > 1e-3:
            assert around[k].tolist() == [area.contains(place) for area in areas]


def test_places_beside_arcs_are_told_as_winding_numbers_do() -> None:
    """Chords of 7.5 degrees lie up to a five hundredth of the radius inside: loops there were outside."""
    dice = Random(7)
    outline = xa.Outline([(100, 0, 1), (-100, 0, fmpq(-1, 3)), (0, 40, "0.8")])
    edges = shape_edges(outline)
    places = []
    for edge in edges:
        stroke = edge.stroke()
        for _ in range(80):
            x, y = stroke.at(dice.random())
            places.append([round(c + dice.uniform(-0.3, 0.3), 3) for c in (x, y)])
    inside = Sketch([outline]).around(np.array(places))[:, 0]
    exact = [winding(edges, xa.Point(*(fmpq(round(1000 * c), 1000) for c in place))) for place in places]
    assert inside.tolist() == [bool(w) for w in exact]
    assert 80 < inside.sum() < 160


@pytest.mark.parametrize("bulge", ["1e-7", "1e-13", "-1e-16", "1e-17"])
def test_noise_that_bends_an_edge_changes_nothing(bulge: str) -> None:
    corners = [(0, 0), (7, 3), (10, 10), (3, 8)]
    places = np.array([(x / 2, y / 2 + 0.1) for x in range(-4, 24) for y in range(-4, 24)])
    straight, bent = (Sketch([xa.Outline([(x, y, b) for x, y in corners])]) for b in (0, bulge))
    assert (straight.around(places) == bent.around(places)).all()
    assert np.array(straight.box) == pytest.approx(np.array(bent.box), abs=1e-5)


@pytest.mark.parametrize("seed", some(range(40), 10))
def test_arcs_reach_as_far_as_they_do(seed: int) -> None:
    dice = Random(seed)
    (a, b), (c, d) = ((dice.randint(-9, 9), dice.randint(-9, 9)) for _ in "ab")
    if (a, b) != (c, d):
        arc = Arc.from_bulge(xa.Point(a, b), xa.Point(c, d), fmpq(dice.choice((-30, -7, 3, 10, 25)), 10))
        found = np.array(arc.stroke().extremes())
        assert (*found.min(axis=0), *found.max(axis=0)) == pytest.approx(box(arc), abs=1e-9)


def test_products_of_absurd_coordinates_do_not_overflow() -> None:
    """Python printed a warning of numpy's beside what `check` says."""
    far = 10**150
    shape = xa.Outline([(0, 0, "1/2"), (far, 1), (far, far), (-far, far, "1/2"), (-far, 0)])
    with warnings.catch_warnings(action="error"):
        around = Sketch([shape]).around(np.array([(1e149, 1e149), (1.2e150, 1.2e150)]))
    assert around.tolist() == [[True], [False]]
