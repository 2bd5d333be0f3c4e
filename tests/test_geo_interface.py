"""`__geo_interface__`: what is offered is what shapely and RFC 7946 know; what is taken is taken exactly."""

from __future__ import annotations

import json
import math
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import shapely
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st
from nightly import some
from shapely.geometry import shape

import exactacq as xa
from exactacq.files import gallery
from exactacq.geometry.geo import FLATNESS
from exactacq.numbers.rationals import rational

Q = Fraction
TRIANGLE = [(0, 0), (4, 0), (0, 3)]
BULGES = st.fractions(Q(-20), Q(20), max_denominator=50).filter(bool)
SCENES = ["circles", "figure2", "figure4", "m9", "plate"]


def explored(name: str) -> xa.Run:
    scene = gallery.scene(name)
    return xa.seed_spreader(scene) if gallery.is_swept(name) else xa.sightseer(scene)


def rings(geo: dict[str, Any]) -> list[Any]:
    """All rings of polygons in what is offered."""
    if geo["type"] == "FeatureCollection":
        return [ring for feature in geo["features"] for ring in rings(feature["geometry"])]
    return list(geo["coordinates"]) if geo["type"] == "Polygon" else []


# -- what is offered -------------------------------------------------------------------------------


class TestCurves:
    @given(BULGES, st.integers(-5, 5), st.integers(1, 1000))
    def test_chords_stray_as_little_as_promised(self, bulge: Fraction, x: int, size: int) -> None:
        """The middle of a chord is farthest from the arc: its distance to the centre tells how far."""
        arc = xa.Arc.from_bulge(xa.Point(x, 1), xa.Point(x + size, 3), rational(bulge))
        places = arc.__geo_interface__["coordinates"]
        radius, length = float(arc.radius), float(arc.length)
        assert places[0] == (x, 1) and places[-1] == (x + size, 3)
        middles = [((a + c) / 2, (b + d) / 2) for (a, b), (c, d) in pairwise(places)]
        center = arc.center.xy
        assert all(abs(math.dist(place, center) / radius - 1) < 1e-12 for place in places)
        strays = max(radius - math.dist(middle, center) for middle in middles)
        assert strays <= FLATNESS * min(radius, length) * (1 + 1e-6)
        assert shape(arc).length == pytest.approx(length, rel=1e-3)

    def test_a_nearly_straight_arc_is_not_flattened_by_its_radius(self) -> None:
        arc = xa.Arc.from_bulge(xa.Point(0, 0), xa.Point(1, 0), fmpq(1, 10**9))
        assert arc.__geo_interface__["coordinates"] == ((0.0, 0.0), (1.0, 0.0))

    def test_of_a_radius_smaller_than_any_float(self) -> None:
        """The angle was the quotient of two floats that are 0."""
        circle = xa.Arc.circle(xa.Point(1, 2), fmpq(1, 10**800))
        arc = circle.stroke()
        assert (arc.length, arc.radius, arc.sweep) == (0.0, 0.0, 2 * math.pi)
        assert circle.__geo_interface__ == {"type": "Point", "coordinates": (1.0, 2.0)}

    def test_points_and_segments(self) -> None:
        assert shape(xa.Point(1, "1/2")) == shapely.Point(1, 0.5)
        assert shape(xa.Segment((0, 0), (1, 2))) == shapely.LineString([(0, 0), (1, 2)])
        assert shape(xa.Segment((1, 2), (1, 2))) == shapely.Point(1, 2)


class TestShapes:
    @pytest.mark.parametrize(
        ("offered", "area"),
        [
            (xa.Polygon(TRIANGLE), 6),
            (xa.Polygon(TRIANGLE[::-1]), 6),
            (xa.Outline([(-1, 0, 1), (1, 0, 1)]), math.pi),
            (xa.Outline([(-1, 0, -1), (1, 0, -1)]), math.pi),
            (xa.Circle((7, 7), "1/3"), math.pi / 9),
            (xa.Terrain(3, 2), 6),
        ],
    )
    def test_are_polygons_in_the_sense_of_the_standard(self, offered: Any, area: float) -> None:
        (ring,) = offered.__geo_interface__["coordinates"]
        assert ring[0] == ring[-1]
        assert all(type(value) is float for place in ring for value in place)
        found = shape(offered)
        assert found.is_valid and found.exterior.is_ccw
        assert found.area == pytest.approx(area, rel=2e-4)

    def test_that_are_none(self) -> None:
        """Nothing is validated here: a scene would refuse them."""
        assert xa.Polygon([]).__geo_interface__ == {"type": "Polygon", "coordinates": ()}
        assert xa.Polygon([(1, 2)]).__geo_interface__["coordinates"] == (((1.0, 2.0), (1.0, 2.0)),)
        for empty in (xa.Circle((1, 2), 0), xa.Outline([(1, 2, 1), (1, 2, 2)])):
            assert empty.__geo_interface__["coordinates"] == ()
        crossed = xa.Polygon([(0, 0), (1, 1), (1, 0), (0, 1)])
        assert not shape(crossed).is_valid

    def test_a_distance_below_the_floats_repeats_no_corner(self) -> None:
        sliver = xa.Polygon([(1, 1), (3, 1), (3, 1 + Q(1, 10**40)), (1, 2)])
        assert sliver.__geo_interface__["coordinates"] == (((1.0, 1.0), (3.0, 1.0), (1.0, 2.0), (1.0, 1.0)),)


@pytest.mark.parametrize("name", some(SCENES, 3))
def test_a_scene_and_all_that_is_known_of_it(name: str) -> None:
    run = explored(name)
    scene, end, view = run.scene, run.map, xa.isovist(run.scene, run.start, run.radius)
    for offered in (scene, run, run.path, end, view):
        assert json.loads(json.dumps(offered.__geo_interface__))
    assert all(
        shape({"type": "Polygon", "coordinates": [r]}).exterior.is_ccw for r in rings(scene.__geo_interface__)
    )
    for obstacle in scene.obstacles:
        found = shape(obstacle)
        assert found.is_valid
        assert found.area == pytest.approx(float(obstacle.area), rel=1e-3)
        kind = "enclosure" if obstacle.is_enclosure else "obstacle"
        wanted = {"kind": kind, "index": obstacle.index, "name": obstacle.label}
        assert obstacle.__geo_interface__["properties"] == wanted
    kinds = [feature["properties"]["kind"] for feature in scene.__geo_interface__["features"]]
    rest = ["terrain"] * (scene.terrain is not None) + ["start"] * (scene.start is not None)
    assert kinds[len(scene.obstacles) :] == rest
    assert shape(run) == shape(run.path)
    assert shape(run).length == pytest.approx(float(run.length), rel=1e-3)
    assert shape(view).is_valid and shape(view).exterior.is_ccw
    assert shape(view).area == pytest.approx(float(view.area), rel=1e-3)


def test_a_map_tells_its_parts() -> None:
    run = explored("circles")
    for then in (run.map_at(2), run.map):
        parts = then.__geo_interface__["features"]
        assert {part["properties"]["obstacle"] for part in parts} == set(then.seen)
        acquired = {p["properties"]["obstacle"] for p in parts if p["properties"]["acquired"]}
        assert acquired == set(then.acquired)
        length = sum(shape(part).length for part in parts)
        assert length == pytest.approx(float(then.known_length()), rel=1e-3)
    assert parts[0]["properties"] == {"obstacle": 0, "name": "O1", "edge": 0, "acquired": True}


def test_a_single_known_point_is_a_point() -> None:
    """The range just reaches the circle."""
    scene = xa.Scene([xa.Circle((5, 0), 2)], start=(0, 0), radius=3)
    (part,) = xa.sightseer(scene).map_at(0).__geo_interface__["features"]
    assert part["geometry"] == {"type": "Point", "coordinates": (3.0, 0.0)}


def test_a_view_without_an_area_is_its_rays() -> None:
    """From the tip of a crack between two arcs, which are tangent there."""
    x, y = Q(24, 25), Q(32, 25)
    crack = xa.Outline([(x, -y, "1/2"), (0, 0, "1/2"), (x, y), (-3, 3), (-3, -3)])
    assert shape(xa.isovist(xa.Scene([crack]), (0, 0), 3)) == shapely.MultiLineString([[(0, 0), (3, 0)]])
    blind = xa.isovist(xa.Scene([xa.Polygon(TRIANGLE)]), (9, 9), 1)
    blind.__dict__.update(pieces=(), rays=())
    assert shape(blind) == shapely.Point(9, 9)


def test_a_run_that_never_leaves_is_a_point() -> None:
    run = xa.sightseer(xa.Scene([], start=(1, 2), radius=1))
    assert len(run.path) == 0
    assert shape(run) == shapely.Point(1, 2)
    assert shape(run.path).is_empty


# -- what is taken ---------------------------------------------------------------------------------


class Offers:
    """An object of no library."""

    def __init__(self, geo: object) -> None:
        self.__geo_interface__ = geo


CLOSED = [*TRIANGLE, TRIANGLE[0]]
GEO = {"type": "Polygon", "coordinates": [CLOSED]}


@pytest.mark.parametrize(
    "offered",
    [
        TRIANGLE,
        CLOSED,
        tuple(map(list, TRIANGLE)),
        [xa.Point(*place) for place in TRIANGLE],
        np.array(TRIANGLE),
        np.array(CLOSED, dtype=float),
        np.array(TRIANGLE, dtype=np.uint8),
        shapely.Polygon(TRIANGLE),
        shapely.LinearRing(TRIANGLE).coords,
        Offers(GEO),
        Offers({"type": "Feature", "geometry": GEO, "properties": {}}),
        GEO,
        xa.Polygon(TRIANGLE),
        xa.Outline(TRIANGLE),
    ],
    ids=lambda offered: type(offered).__name__,
)
def test_what_is_a_polygon_is_one(offered: Any) -> None:
    wanted = xa.Polygon(TRIANGLE)
    assert xa.Polygon(offered) == wanted
    assert xa.Scene([offered]).shapes[0].vertices == wanted.vertices
    assert xa.Scene([], enclosure=offered).enclosure.vertices == wanted.vertices


def test_floats_are_taken_exactly() -> None:
    tenth = fmpq(*(0.1).as_integer_ratio())
    for offered in (np.array([(0.1, 0), (1, 0), (1, 1)]), shapely.Polygon([(0.1, 0), (1, 0), (1, 1)])):
        assert xa.Polygon(offered).vertices[0] == (tenth, 0, 0)
    assert xa.Polygon(np.array([(0.1, 0)], dtype=np.float32)).vertices[0][0] != tenth


def test_either_sense_makes_the_same_scene() -> None:
    room = [(-9, -9), (9, -9), (9, 9), (-9, 9)]
    both = shapely.Polygon(TRIANGLE), shapely.Polygon(TRIANGLE[::-1])
    areas = {xa.Scene([offered], enclosure=room).obstacles[0].area for offered in both}
    assert areas == {xa.Length(6)}


def test_a_scene_of_polygons_of_shapely_is_explored() -> None:
    exact = gallery.scene("squares")
    again = xa.Scene([shape(s) for s in exact.shapes], exact.start, radius=exact.radius)
    assert xa.sightseer(again).length == xa.sightseer(exact).length


HOLED = shapely.Polygon([(0, 0), (9, 0), (9, 9), (0, 9)], [[(1, 1), (2, 1), (1, 2)]])


@pytest.mark.parametrize(
    ("offered", "rule"),
    [
        (HOLED, "a boundary is one ring: give a Polygon with holes by its outer ring alone"),
        (shapely.MultiPolygon([shapely.Polygon(TRIANGLE)]), "a boundary is one Polygon, not a MultiPolygon"),
        (shapely.LineString(TRIANGLE), "a boundary is closed: its last vertex is the first one"),
        (shapely.Point(1, 2), "a boundary is one Polygon, not a Point"),
        (shapely.Polygon([(*place, 1) for place in TRIANGLE]), "a boundary lies in the plane"),
        (
            Offers({"type": "Feature", "geometry": None}),
            "a boundary is one Polygon, not a mapping without a type",
        ),
        ({"type": "Polygon", "coordinates": [[1, 2]]}, "a boundary lies in the plane"),
        ({"type": "Polygon", "coordinates": [[(0, 0), (1, None)]]}, "vertex 1: not a number: None"),
        ({"boundary": TRIANGLE}, "a boundary is one Polygon"),
        (gallery.scene("circles"), "a boundary is one Polygon, not a FeatureCollection"),
    ],
    ids=lambda offered: type(offered).__name__,
)
def test_what_is_none_is_refused_in_one_sentence(offered: Any, rule: str) -> None:
    for part, make in (
        ("", lambda: xa.Polygon(offered)),
        ("obstacle 1: ", lambda: xa.Scene([xa.Circle((50, 0), 1), offered])),
        ("enclosure: ", lambda: xa.Scene([], enclosure=offered)),
    ):
        with pytest.raises(xa.FormatError) as caught:
            make()
        assert str(caught.value).startswith(part + rule)
        assert "\n" not in str(caught.value)


def test_a_circle_is_not_flattened_in_passing() -> None:
    with pytest.raises(xa.FormatError, match="a Circle is no Polygon"):
        xa.Polygon(xa.Circle((0, 0), 1))
    assert xa.Scene([xa.Circle((0, 0), 1)]).shapes == (xa.Circle((0, 0), 1),)


def test_a_single_polygon_is_no_list_of_obstacles() -> None:
    for offered in (shapely.Polygon(TRIANGLE), gallery.scene("circles")):
        with pytest.raises(xa.FormatError, match="not a single one"):
            xa.Scene(offered)
    assert len(xa.Scene(np.array([TRIANGLE, [(8, 8), (9, 8), (8, 9)]])).obstacles) == 2


def test_what_breaks_a_rule_of_the_world_is_invalid_and_not_malformed() -> None:
    for offered in (shapely.Polygon(), np.zeros((0, 2)), [(0, 0), (1, 1), (1, 0), (0, 1)]):
        with pytest.raises(xa.InvalidScene, match="obstacle O1"):
            xa.Scene([offered])
