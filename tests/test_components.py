"""What a terrain leaves of its obstacles, where they block straight ways, and the M-line."""

from __future__ import annotations

from fractions import Fraction as Q
from random import Random

import pytest
import shapely
from sweeps import rectangle, swept_scene

from exactacq import Circle, Outline, Point, Polygon, Real, Scene, Terrain
from exactacq.geometry.curves import Segment
from exactacq.geometry.intersections import contacts
from exactacq.numbers.rationals import rational
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.shapes import shape_edges
from exactacq.scene.terrain_components import Component, Ground, ground_of
from exactacq.strategies.seed_spreader.blocked import Blocking, _met
from exactacq.strategies.seed_spreader.mline import MLine


def ground(shapes: list[object], width: object, height: object) -> Ground:
    return Ground(Scene(shapes).obstacles, Terrain(width, height))


def shore(component: Component) -> list[str]:
    return [str(edge.start) for edge in component.edges] + [str(component.edges[-1].end)]


class TestComponents:
    def test_a_wall_across_hides_what_lies_behind(self) -> None:
        wall, behind, before = (
            rectangle(-1, 2, 5, 3),
            rectangle(1, Q(7, 2), 2, Q(15, 4)),
            rectangle(1, 1, 2, Q(3, 2)),
        )
        found = ground([wall, behind, before], 4, 4)
        assert [c.label for c in found.components] == ["O1", "O3"]
        assert [c.obstacle.index for c in found.unreached] == [1]
        assert shore(found.components[0]) == ["(0, 2)", "(4, 2)"]
        assert [len(arc) for arc in found.components[0].hidden] == [1]

    def test_prongs_are_components_with_letters(self) -> None:
        comb = Polygon([(1, 5), (1, 2), (2, 2), (2, 4), (3, 4), (3, 1), (4, 1), (4, 5)])
        found = ground([comb], 6, Q(7, 2))
        assert [c.label for c in found.components] == ["O1a", "O1b"]
        assert shore(found.components[0]) == ["(1, 7/2)", "(1, 2)", "(2, 2)", "(2, 7/2)"]

    def test_a_circle_is_cut_at_roots_and_over_its_start(self) -> None:
        found = ground([Circle((Q(9, 2), 2), 1), Circle((0, 4), 1)], 5, 6)
        assert [c.closed for c in found.components] == [False, False]
        east = ground([Circle((5, 2), 2)], 6, 6).components[0]
        assert str(east.perimeter) == "8*pi/3" or str(east.perimeter) == "(8/3)*pi"
        assert shore(east)[0] == "(6, sqrt(3) + 2)"

    def test_touching_the_border_parts_nothing(self) -> None:
        """A corner, an arc or a notch that only touches the border leaves a way through."""
        corner, arc = Polygon([(2, 4), (1, 3), (3, 3)]), Circle((6, 3), 1)
        assert [c.closed for c in ground([corner, arc], 8, 4).components] == [True, True]
        notch = Polygon([(1, 5), (1, 2), (2, 2), (Q(5, 2), 4), (3, 2), (4, 2), (4, 5)])
        (both,) = ground([notch], 8, 4).components
        assert shore(both)[3] == "(5/2, 4)"
        assert len(both.edges) == 6

    def test_edges_on_the_border(self) -> None:
        """An edge along the border is no shore, on whichever side its obstacle lies."""
        (inside,) = ground([rectangle(1, 3, 2, 4)], 4, 4).components
        assert shore(inside) == ["(1, 4)", "(1, 3)", "(2, 3)", "(2, 4)"]
        outside = ground([rectangle(1, 4, 2, 5)], 4, 4)
        assert not outside.components
        assert not outside.of(0)

    def test_a_circle_that_touches_the_border_opposite_its_start(self) -> None:
        """The place that stands for a loop must not be on the border."""
        found = ground([Circle((1, 5), 1), rectangle(4, -1, 5, 1)], 9, 8)
        assert [c.closed for c in found.components] == [True, False]

    def test_a_cut_edge_leaves_the_numbers_as_they_are(self) -> None:
        """The horns of a crescent were numbered by the edges they have parts of, in which both began at 0."""
        crescent = [("5/2", 2, 1), ("5/2", 5, "-1/2")]
        cut = [("5/2", 2, 1), ("5/2", 5, "-1/4"), ("1877/578", "983/289", "-2/9")]
        for vertices in (crescent, cut):
            found = ground([Outline(vertices)], 3, 12)
            low, high = found.components
            assert any(curve.start == Point("5/2", 2) for curve in low.edges)
            assert any(curve.start == Point("5/2", 5) for curve in high.edges)

    def test_a_pocket_between_two_components(self) -> None:
        """What lies between a component and the border is not in reach, nor is an obstacle in it."""
        found = ground(
            [Polygon([(2, 5), (2, 1), (5, 1), (5, 2), (3, 2), (3, 5)]), rectangle(4, 3, 5, 4)], 6, 5
        )
        assert [c.label for c in found.components] == ["O1", "O2"]
        closed = ground(
            [Polygon([(2, 5), (2, 1), (6, 1), (6, 2), (3, 2), (3, 5)]), rectangle(4, 3, 5, 4)], 6, 5
        )
        assert [c.label for c in closed.components] == ["O1"]
        assert [c.obstacle.index for c in closed.unreached] == [1]

    @pytest.mark.parametrize("seed", range(60))
    def test_against_shapely(self, seed: int) -> None:
        """Polygons: the free region at S and how much of each boundary it has, by another library."""
        scene = swept_scene(Random(seed), arcs=False)
        terrain = scene.terrain
        assert terrain is not None
        box = shapely.box(0, 0, float(terrain.width), float(terrain.height))
        solids = [shapely.Polygon([(float(x), float(y)) for x, y, _ in s.vertices]) for s in scene.shapes]
        free = box.difference(shapely.union_all(solids))
        rest = list(getattr(free, "geoms", [free]))
        parts = [shapely.Point(0, 0)]
        while near := [p for p in rest if any(p.distance(part) < 1e-9 for part in parts)]:
            # Free space is closed: where two of its parts touch, the robot passes.
            parts += near
            rest = [p for p in rest if p not in near]
        found = ground_of(scene)
        inner = box.buffer(-1e-9)
        reached = shapely.union_all(parts).buffer(1e-7)
        lengths = [s.exterior.intersection(inner).intersection(reached).length for s in solids]
        for obstacle, length in zip(scene.obstacles, lengths, strict=True):
            mine = [c for c in found.components if c.obstacle.index == obstacle.index]
            assert sum(float(c.perimeter) for c in mine) == pytest.approx(length, abs=1e-5)


class TestMLine:
    def test_metric(self) -> None:
        line = MLine(Terrain(10, 4), rational(3))
        assert line.lines == [0, 3, 6, 9, 10]
        assert line.length == 30
        assert [str(piece.end) for piece in line.pieces][-3:] == ["(9, 0)", "(10, 0)", "(10, 4)"]
        assert line.position(2, Real(1) / 2).rational == 4 + 3 + 2
        wide = MLine(Terrain(5, 2), rational(7))
        assert (wide.strips, wide.width, wide.length) == (1, 5, 9)

    def crossings(self, shapes: list[object], width: object, height: object, radius: int) -> list[str]:
        obstacles, terrain = Scene(shapes).obstacles, Terrain(width, height)
        found = MLine(terrain, rational(radius)).crossings(
            Blocking(Ground(obstacles, terrain), EdgeTable(obstacles))
        )
        return [f"{c.stop.point}{'>' if c.ends else '<'}" for c in found]

    def test_tangency_and_running_along_an_edge_are_no_hits(self) -> None:
        assert self.crossings([Circle((4, 4), 1)], 9, 8, 3) == []
        assert self.crossings([rectangle(3, 2, 4, 5)], 9, 8, 3) == []
        assert self.crossings([Polygon([(2, 2), (3, 4), (2, 6)])], 9, 8, 3) == []

    def test_border_edges_block(self) -> None:
        """On the border only the terrain's side counts: an edge of an obstacle outside does not block."""
        assert self.crossings([rectangle(0, 2, 1, 4)], 9, 8, 3) == ["(0, 2)<", "(0, 4)>"]
        assert self.crossings([rectangle(-1, 2, 0, 4), rectangle(4, 1, 5, 2)], 9, 8, 3) == []

    def test_corners_of_the_mline(self) -> None:
        """A stretch goes on over a corner that is blocked; a notch that reaches the corner parts it."""
        assert self.crossings([rectangle(2, 6, 4, 9)], 9, 8, 3) == ["(2, 8)<", "(3, 6)>"]
        assert self.crossings([Polygon([(2, 6), (3, 8), (4, 6), (4, 9), (2, 9)])], 9, 8, 3) == [
            "(2, 8)<",
            "(3, 8)>",
        ]

    def test_at_the_last_end(self) -> None:
        """T inside an obstacle: a stretch without an end."""
        assert self.crossings([rectangle(8, -1, 10, 2)], 9, 8, 3) == ["(9, 2)<"]

    def test_two_stretches_that_meet_in_a_point(self) -> None:
        """The tip of a notch on the M-line is free: there are four crossing points, two of them equal."""
        notch = Polygon([(2, 2), (4, 2), (4, 6), (2, 6), (3, 4)])
        assert self.crossings([notch], 9, 8, 3) == ["(3, 6)<", "(3, 4)>", "(3, 4)<", "(3, 2)>"]
        teeth = Polygon([(2, 2), (5, 2), (5, 6), (3, 4), (2, 6)])
        assert self.crossings([teeth], 9, 8, 3) == ["(3, 4)<", "(3, 2)>"]


def test_ways_between_boundary_points() -> None:
    scene = Scene([rectangle(2, 2, 4, 4)], terrain=Terrain(9, 9))
    blocking = Blocking(ground_of(scene), EdgeTable(scene.obstacles))
    assert not blocking.gaps(Segment(Point(2, 2), Point(4, 2)))
    (gap,) = blocking.gaps(Segment(Point(2, 2), Point(4, 4)))
    assert (gap.begin.u.rational, gap.end.u.rational) == (0, 1)
    assert not blocking.gaps(Segment(Point(0, 4), Point(2, 2)))


@pytest.mark.parametrize("bulge", ["1/3", "-1/3", "2", "-2"])
@pytest.mark.parametrize("share", ["1/7", "1/2", "5/6"])
def test_ways_that_end_on_an_arc_meet_it_where_any_way_does(bulge: str, share: str) -> None:
    """What is told from the end on the circle is what the circle's equation tells."""
    (arc, _) = shape_edges(Outline([(0, 0, bulge), (4, 1)]))
    end = arc.point(share)
    for start in (Point(x, y) for x in range(-9, 13, 3) for y in range(-8, 9, 4)):
        way = Segment(start, end)
        told = _met(way, arc, arc)
        found = [contact.start for contact in contacts(way, arc)]
        assert len(told) == len(found)
        assert all(any(p == q for q in found) for p in told)


def test_an_edge_of_a_component_passes_points_of_hidden_shores_too() -> None:
    """A disc across a terrain has one edge, and a shore on either side: only one is within reach."""
    (component,) = Ground(Scene([Circle((1, 5), 3)]).obstacles, Terrain(2, 10)).of(0)
    far, near = Point(1, 8), Point(1, 2)
    assert (component.edges_on(far, {0}), component.edges_on(near, {0})) == ((), (0,))
    assert (component.edges_at(far), component.edges_at(near)) == ((), (0,))
    assert component.edges_on(near, ()) == ()
