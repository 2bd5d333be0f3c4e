"""Explained cases: arcs that share a circle or a centre, touch the range, or join in a cusp.

Drawings are made of such arcs: a DXF polyline draws a circle as two arcs of bulge 1.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

import pytest
from flint import fmpq
from nightly import by_night, some

import exactacq as xa
from exactacq.geometry.curves import Segment
from exactacq.numbers.length import Length
from exactacq.scene.boundary_walk import Boundary
from exactacq.scene.scene import Scene
from exactacq.visibility import rotational_sweep

Q = Fraction
DATA = Path(__file__).parent / "data" / "arcs"
PI = Length.turns(xa.Real(Q(1, 2)))
HALVES = xa.Outline([(1, 0, 1), (-1, 0, 1)])
"""The circle of radius 1 about the origin as two half circles: their ends are the same two points."""


def explored(scene: Scene, radius: object) -> tuple[Length, Length]:
    """What the Sightseer walks and what it knows in the end."""
    run = xa.sightseer(scene, radius)
    assert run.map.incomplete == ()
    xa.audit(run)
    return run.length, run.map.known_length()


class TestHalfCircles:
    """The edge that the robot walks was looked for by its circle and its ends: always the first half."""

    def test_a_walk_around_teaches_both(self) -> None:
        for circle in (HALVES, xa.Circle((0, 0), 1)):
            assert explored(Scene([circle], start=(3, 0)), 5) == (2 + 2 * PI, 2 * PI)

    def test_a_sweep_does_not_divert_to_what_it_has_walked_along(self) -> None:
        shape = xa.Outline([(5, 4, 1), (3, 4, 1)])
        run = xa.seed_spreader(Scene([shape], terrain=xa.Terrain(8, 8)), 4)
        assert run.length == 3 * PI + 30
        assert [event.kind for event in run.events if event.kind == "divert"] == []

    @pytest.mark.parametrize(
        "wall",
        [
            xa.Outline([(9, 0, 1), (-9, 0, 1)]),
            xa.Outline([(9, 0, 2), (Q(-63, 25), Q(-216, 25), "1/2")]),
            xa.Outline(
                [(9, 0, "1/2"), (Q(-63, 25), Q(216, 25), "1/2"), (Q(-4743, 625), Q(-3024, 625), "3/4")]
            ),
        ],
        ids=["two halves", "two arcs", "three arcs"],
    )
    def test_a_round_room_becomes_complete(self, wall: xa.Outline) -> None:
        one = explored(Scene([], start=(3, 0), enclosure=xa.Circle((0, 0), 9)), 5)
        assert explored(Scene([], start=(3, 0), enclosure=wall), 5) == one

    def test_a_point_between_two_edges_is_on_the_one_that_starts_there(self) -> None:
        (obstacle,) = Scene([HALVES]).obstacles
        boundary = Boundary(obstacle.edges, obstacle.perimeter)
        for k, edge in enumerate(obstacle.edges):
            assert boundary.edge_at(edge.start) == k
            assert boundary.edge_at(xa.Point(*(c + 0 for c in edge.start.rational))) == k
        assert boundary.edge_at(xa.Point(0, -1)) == 1

    def test_what_a_boundary_remembers_of_points_is_true(self) -> None:
        (obstacle,) = Scene([xa.Polygon([(0, 0), (4, 0), (4, 4), (0, 4)])]).obstacles
        boundary = Boundary(obstacle.edges, obstacle.perimeter)
        places = [xa.Point(1, 0), xa.Point(4, 4), xa.Point(4, 1), xa.Point(0, 3)]
        for k in (0, 1, 0, 2, 1, 3, 0, 0, 2):
            assert boundary.edge_at(places[k]) == (0, 2, 1, 3)[k]


class TestLinesThroughCornersOnCircles:
    """A corner on the circle of an arc: the tangent there touches the circle in the corner itself.

    Which way the circle was touched was read from a float product, the corner's distance from the contact: 0.
    """

    ROOM = xa.Circle((0, 0), 60)

    def test_an_arc_in_two_pieces(self) -> None:
        one = xa.Outline([(-7, 24, "3/4"), (-7, -24)])
        two = xa.Outline([(-7, 24, "1/3"), (-25, 0, "1/3"), (-7, -24)])
        runs = [xa.sightseer(Scene([s], start=(45, 3), enclosure=self.ROOM), 100) for s in (one, two)]
        assert runs[0].length == runs[1].length
        assert runs[0].length.decimal(10) == "646.5226765"
        assert runs[0].map.known_length() == runs[1].map.known_length()

    @pytest.mark.parametrize(
        "path", sorted((Path(__file__).parent / "data" / "arcs").glob("*.json")), ids=str
    )
    def test_scenes_that_ended_in_an_assertion(self, path: Path) -> None:
        run = xa.sightseer(xa.load(path))
        for k in range(1, 40, 13):
            place = Length(Q(int(float(run.length) * 1000), 40_000) * k)
            known = run.map_at(place)
            assert known.known_length() <= run.map.known_length()


class TestNormalsThroughTheCentre:
    def test_the_centre_of_a_room_on_a_circle(self) -> None:
        """All normals of the room pass its centre; half of them meet the circle there, the others before.

        They were one family, in which the point that is met moves and then stays: a view from a place that
        moves had no line. The start of the circle is there too, so its parameter is 4 on one side.
        """
        circle = xa.Circle((0, 0), 1)
        one = explored(Scene([circle], start=(9, 5), enclosure=xa.Circle((1, 0), 13)), 60)
        wall = xa.Outline([(14, 0, -3), (Q(116, 25), Q(312, 25), "-1/3")])
        assert explored(Scene([circle], start=(9, 5), enclosure=wall), 60) == one

    WALL = xa.Polygon([(-8, -20), (-8, 20), (-9, 20), (-9, -20)])
    HOLLOW = xa.Outline([(2, -3), (2, 3), (0, 3, "-1/3"), (0, -3)])
    """Its arc has the centre (-4, 0) and the radius 5."""

    def test_a_corner_in_the_centre_blocks_the_normals(self) -> None:
        """All normals pass the corner, so it is no event; of its two edges one was taken for what is met.

        If that one was only grazed, nothing was met, and the arc was seen through the wall behind.
        """
        scene = Scene([self.HOLLOW, xa.Polygon([(-4, 0), (-6, 1), (-6, -1)]), self.WALL])
        swept = xa.sweep(scene, Segment(xa.Point(-12, -6), xa.Point(-12, 6)), radius=60)
        assert [event for event in swept.events if event.obstacle == 0] == []

    @pytest.mark.parametrize("first", some(range(8), 1))
    def test_a_hook_whose_corner_is_the_centre_of_its_own_arc(self, first: int) -> None:
        hook = [(0, -1, -1), (0, 1), ("1/2", "1/2"), (0, 0), (2, "-1/4"), (2, 2), (-2, 2), (-2, -1)]
        outline = xa.Outline(hook[first:] + hook[:first])
        triangle = xa.Polygon([("3/2", 4), ("5/2", 4), ("5/2", 5)])
        run = xa.sightseer(Scene([outline, triangle], start=(0, 4)), 60)
        assert run.map_at(Q(3, 2)).known_length(0) == 4
        xa.audit(run)

    @by_night
    @pytest.mark.parametrize("first", [7, 0])
    def test_a_spiral_of_half_circles(self, first: int) -> None:
        """Each half circle ends in the centre of another."""
        band = [
            ("3/2", "23/8", 1), ("3/2", "29/8", 1), ("3/2", "19/8", 1), ("3/2", "33/8"),
            ("3/2", 4, -1), ("3/2", "5/2", -1), ("3/2", "7/2", -1), ("3/2", 3),
        ]  # fmt: skip
        other = xa.Outline(
            [
                ("7/2", "15/2", 1), ("7/2", "49/6", 1), ("7/2", "53/6", 1),
                ("7/2", "19/2"), ("9/2", "19/2"), ("9/2", "15/2"),
            ]
        )  # fmt: skip
        scene = Scene([other, xa.Outline(band[first:] + band[:first])], terrain=xa.Terrain(6, 10))
        run = xa.seed_spreader(scene, 20)
        assert [event.kind for event in run.events if event.obstacle == 1][:3] == ["sight", "lose", "regain"]
        xa.audit(run)

    @pytest.mark.parametrize("radius", some([5, "5001/1000", "51/10"], 1))
    def test_a_way_that_starts_in_the_centre(self, radius: object) -> None:
        """Its own line is a normal of the arc, and the normals beside it cross the way in the centre alone.

        They were cut at the other end of the way instead, and the arc seemed to be in sight from all of it.
        """
        post = xa.Polygon([(-8, -1), (-8, 1), (-9, 0)])
        run = xa.sightseer(Scene([self.HOLLOW, post], start=(-4, 0)), radius)
        reports = [event.kind for event in run.events if event.obstacle == 0]
        assert reports[:3] == ["sight", "lose", "regain"]
        xa.audit(run)

    def test_the_normals_of_concentric_arcs_are_the_same(self) -> None:
        """From a generic place on one of two concentric arcs the other is seen along one normal of both.

        Its foot was found in two ways, and their equality was more than could be decided.
        """
        wall = xa.Outline(
            [
                (13, 0, "3/4"),
                (Q(-6851, 625), Q(4368, 625), "1/7"),
                (-13, 0, "1/2"),
                (Q(91, 25), Q(-312, 25), "1/3"),
            ]
        )
        shapes = [
            xa.Outline([(-5, 0, "1/4"), (Q(-805, 289), Q(-1200, 289), "2/9"), (Q(7, 5), Q(-24, 5))]),
            xa.Outline([(Q(1288, 289), Q(1920, 289), "1/2"), (Q(59400, 83521), Q(586560, 83521))]),
        ]
        run = xa.sightseer(Scene(shapes, start=(9, -5), enclosure=wall), 60)
        known = run.map_at(Q(17287, 500)).known_length()
        assert 0 < known < run.map.known_length()


class TestRangesThatTouch:
    @pytest.mark.parametrize(
        "shape",
        [
            xa.Circle((0, 4), 2),
            xa.Outline([(0, 2, 1), (0, 6)]),
            xa.Outline([(0, 2, 1), (0, 6, 1)]),
            xa.Outline([(0, 2, "1/2"), (Q(48, 25), Q(114, 25), "1/2"), (Q(-672, 625), Q(3554, 625), "3/4")]),
            xa.Outline([(0, 2, 1), (0, 6, "-1/2")]),
        ],
        ids=["circle", "half disc", "two arcs", "three arcs", "crescent"],
    )
    def test_an_arc_that_is_touched_in_its_end(self, shape: object) -> None:
        """Where the range only touches the circle, its two crossings with it are one point.

        The piece between them was taken for the whole circle, and the view had an area of -4 pi.
        """
        view = xa.isovist(Scene([shape]), (0, 0), 2)
        assert view.area == 4 * PI
        assert view.contains(xa.Point(0, 2))
        touched = [point for spans in view.seen().values() for span in spans for point in span]
        assert touched and all(point == xa.Point(0, 2) for point in touched)

    def test_the_range_touches_a_round_room_from_within(self) -> None:
        wall = xa.Outline([(5, 0, 1), (-5, 0, 1)])
        view = xa.isovist(Scene([], enclosure=wall), (3, 0), 2)
        assert view.area == 4 * PI


class TestCusps:
    @pytest.mark.parametrize("radius", [1, 3, 20])
    def test_of_free_space_between_an_arc_and_a_floor(self, radius: int) -> None:
        """The last tangent of the arc runs along the floor: it meets it in the cusp, as in the limit."""
        shape = xa.Outline([(5, 0), (0, 0, 1), (0, 2), (-2, 2), (-2, -1), (5, -1)])
        # From (3, 1) straight down to the floor, then once around.
        assert explored(Scene([shape], start=(3, 1)), radius) == (19 + PI, 18 + PI)


class TestRunsReadBack:
    def test_a_way_that_touches_a_circle(self) -> None:
        """What a way touches is found again."""
        wall = xa.Polygon([(-9, -6), (-8, -6), (-8, 6), (-9, 6)])
        triangle = xa.Polygon([(8, 1), (10, 0), (10, 2)])
        run = xa.sightseer(Scene([xa.Circle((0, 0), 2), wall, triangle], start=(0, 3)), 20)
        text = json.dumps(run.to_json())
        again = xa.load_run(json.loads(text))
        assert json.dumps(again.to_json()) == text
        assert again.map.known_length() == run.map.known_length()


def test_tangents_of_a_circle_in_parts_are_swept_in_floats(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other arcs of the circle are met at the contact only; each line was once followed exactly to see so."""
    asked = []
    exact = rotational_sweep._Decisions._exact_meet

    def counted(self: object, middle: fmpq, edges: Iterable[int]) -> tuple[int, int]:
        asked.append(middle)
        return exact(self, middle, edges)  # type: ignore[arg-type]

    monkeypatch.setattr(rotational_sweep._Decisions, "_exact_meet", counted)
    corners = [(2, 0), (1, 1), (0, 0), (1, -1)]
    slots = [xa.Outline([(x + a, b, xa.Around((x + 1, 0))) for a, b in corners]) for x in (0, 5, 11)]
    run = xa.sightseer(xa.Scene(slots, (3, 7), radius=40)).sense()
    assert len(run.visits) == 3
    assert not asked
