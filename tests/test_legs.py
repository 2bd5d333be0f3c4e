"""Legs: which edge carries a piece of a boundary, and what is known of a leg's places."""

from __future__ import annotations

from fractions import Fraction as Q
from random import Random

import pytest
from flint import fmpq
from strategies import arc_terrain, degenerate_terrain

from exactacq import Circle, Outline, Point, Polygon, Scene
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.legs import Leg, legs_of

LENS = Outline([(0, 0, "1/2"), (4, 0, "1/2")])
"""Two arcs with the same two ends."""
HALVES = Outline([(10, 0, 1), (14, 0, 1)])
"""A circle in two halves."""
CAP = Outline([(20, 0), (24, 0, 1)])
"""A chord and a half circle with the same two ends."""
SQUARE = Polygon([(30, 0), (34, 0), (34, 4), (30, 4)])
RING = Circle((40, 0), 2)
SHAPES = Scene([LENS, HALVES, CAP, SQUARE, RING])


def legs(table: EdgeTable, obstacle: int, piece: Curve) -> list[Leg]:
    return legs_of(table, [Rail(curve) for curve in table.curves], obstacle, piece)


def carriers(table: EdgeTable, obstacle: int, piece: Curve) -> list[int]:
    """The edges that contain three places of a piece, proved one by one."""
    places = [piece.point(u) for u in (Q(1, 5), Q(1, 2), Q(4, 5))]
    return [e for e in table.edges_of(obstacle) if all(table.curves[e].passes(p) for p in places)]


@pytest.mark.parametrize(
    "scene", [SHAPES, degenerate_terrain(Random(3)).scene(), arc_terrain(Random(5)).scene()]
)
def test_an_edge_carries_itself_and_its_parts(scene: Scene) -> None:
    """In both directions, also where two edges have the same ends; copies are found as well."""
    table = EdgeTable(scene.obstacles)
    for obstacle in range(len(scene.obstacles)):
        for e in table.edges_of(obstacle):
            edge = table.curves[e]
            pieces = [edge, edge.part(Point(*edge.start), Point(*edge.end))]
            middle = edge.point(Q(1, 2))
            pieces += [edge.part(edge.start, middle), edge.part(middle, edge.end)]
            for ahead, some in ((True, pieces), (False, [piece.reversed() for piece in pieces])):
                for piece in some:
                    found = legs(table, obstacle, piece)
                    assert [leg.edge for leg in found] == [e] == carriers(table, obstacle, piece)
                    assert found[0].ahead == ahead
                    assert (found[0].start, found[0].end) == (piece.start, piece.end)


def test_the_ends_of_an_edge_tell_it_without_arithmetic(monkeypatch: pytest.MonkeyPatch) -> None:
    """No place is proved to be on an edge that a piece covers wholly."""

    def refused(*_: object) -> bool:
        raise AssertionError("a proof that nobody needs")

    table = EdgeTable(SHAPES.obstacles)
    for kind in (Segment, Arc):
        monkeypatch.setattr(kind, "may_pass", refused)
        monkeypatch.setattr(kind, "passes", refused)
    for e, edge in enumerate(table.curves):
        for piece in (edge, edge.reversed()):
            (leg,) = legs(table, table.owners[e], piece)
            assert leg.edge == e


def test_ends_alone_do_not_tell_an_edge() -> None:
    """The chord of an arc is no part of it, nor is an edge of one obstacle part of another."""
    table = EdgeTable(SHAPES.obstacles)
    arc = table.curves[table.edges_of(0).start]
    for obstacle, piece in ((0, Segment(arc.start, arc.end)), (3, arc)):
        with pytest.raises(ValueError, match="no edge of the boundary carries"):
            legs(table, obstacle, piece)


def test_a_walk_over_the_start_of_a_circle_has_two_legs() -> None:
    table = EdgeTable(SHAPES.obstacles)
    east, north, south = Point(42, 0), Point(40, 2), Point(40, -2)
    over = Arc(south, north, Point(40, 0), fmpq(4), ccw=True)
    for piece in (over, over.reversed()):
        found = legs(table, 4, piece)
        assert [leg.edge for leg in found] == [table.edges_of(4).start] * 2
        assert found[0].end == east == found[1].start


def test_inside_an_edge_there_is_no_other() -> None:
    """At a corner there are two, the incoming one first; elsewhere the one that the leg is on."""
    table = EdgeTable(SHAPES.obstacles)
    first = table.edges_of(3).start
    edge = table.curves[first]
    (leg,) = legs(table, 3, edge.part(edge.start, edge.point(Q(1, 3))))
    before, after = int(table.previous[first]), int(table.next[first])
    assert leg.own(leg.first) == (before, first) == table.edges_at(edge.start)
    assert leg.own(leg.last) == (first,)
    (leg,) = legs(table, 3, edge)
    assert leg.own(leg.first) == (before, first)
    assert leg.own(leg.last) == (first, after) == table.edges_at(edge.end)
    copied = Leg(leg.rail, leg.edge, leg.span, leg.ahead, beside=leg.beside)
    assert copied.own(Rail(edge).parameter(edge.end)) is None
    (leg,) = legs(table, 4, table.curves[table.edges_of(4).start])
    assert leg.own(leg.first) == (leg.edge,) == leg.own(leg.last)


def test_what_a_way_touches_is_found() -> None:
    """Corners on its line, and circles; along irrational and nearly touching ways too."""
    shapes = [
        Circle((0, -2), 2),
        Circle((5, 1), 1),
        Polygon([(8, 0), (9, 3), (8, 3)]),
        Polygon([(12, 0), (13, -1), (13, 1)]),
    ]
    table = EdgeTable(Scene(shapes).obstacles)
    (one, other) = (table.edges_of(k).start for k in (0, 1))
    corner, last = table.edges_of(2).start, table.edges_of(3).start

    def touched(start: Point, end: Point) -> list[set[int]]:
        found = legs_of(table, [], None, Segment(start, end))
        return [set(leg.touches) for leg in found]

    circles = {len(table.curves) + one, len(table.curves) + other}
    assert touched(Point(-3, 0), Point(7, 0)) == [circles]
    assert touched(Point(-3, 0), Point(10, 0)) == [{*circles, corner}] * 2
    assert touched(Point(12, 0), Point(-3, 0)) == [{*circles, corner, last}] * 2
    tiny = fmpq(1, 10**50)
    assert touched(Point(-3, tiny), Point(10, tiny)) == [set()]
    # From 2 sqrt(2) away of its centre a circle of radius 2 is touched under 45 degrees.
    root = Real(2).sqrt()
    place = Point(0, root * 2 - 2)
    assert touched(place, place + Point(3, -3)) == [{len(table.curves) + one}]
    assert touched(place, place + Point(3, tiny - 3)) == [set()]


def test_a_way_is_told_whatever_cancels_in_its_numbers() -> None:
    """Powers of sqrt(2) - 1, some 2^k long, have coefficients that cancel to the last of 64 bits.

    An edge along the way, 5 long, was left out of the map, and a corner on it was not found.
    """
    table = EdgeTable(Scene([Polygon([(0, 0), (3, 4), (1, 6)])]).obstacles)
    for k in (10, 30, 60, 120):
        little = (Real(2).sqrt() - 1) ** k
        little = little * 2 ** round(1.27 * k)
        assert 0.4 < float(little) < 1.6
        start, end = Point(-3 * little, -4 * little), Point(3 + 3 * little, 4 + 4 * little)
        assert [leg.edge for leg in legs_of(table, [], None, Segment(start, Point(0, 0)))] == [None]
        rails = [Rail(curve) for curve in table.curves]
        assert [leg.edge for leg in legs_of(table, rails, None, Segment(start, end))] == [None, 0, None]
        start, end = Point(3 - 7 * little, 4 + little), Point(3 + 7 * little, 4 - little)
        assert next(leg.end for leg in legs_of(table, [], None, Segment(start, end))) == Point(3, 4)
