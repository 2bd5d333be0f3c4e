"""Sweeps and clearance at their edges: lines that only grazing leaves free, and minima on vertices."""

from __future__ import annotations

import math
from fractions import Fraction
from random import Random

import pytest
from flint import fmpq

from exactacq import Circle, Outline, Point, Polygon, Scene, visibility_graph
from exactacq.geometry.curves import Segment
from exactacq.geometry.nearest_points import NearestFamily, nearest_points
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.legs import parts_of
from exactacq.visibility.chords import Chord
from exactacq.visibility.free_segment import is_free
from exactacq.visibility.free_translates import free_pieces
from exactacq.visibility.links import Links

TINY = Fraction(1, 10**60)


def box(x0, y0, x1, y1):
    return Polygon([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def alternating(shift):
    """Three long bars that leave the line x = 0, or nothing if the middle one is shifted to the right."""
    return [box(0, 0, 50, 1), box(-50, 2, shift, 3), box(0, 4, 50, 5)]


SLANTED = [Polygon([(-9, -3), (-9, -4), (9, -4), (9, -1)]), Polygon([(-9, 7), (9, 9), (9, 10), (-9, 10)])]
"""Below and above the bars; along x = 0 they are 10 apart, and no line near it is perpendicular to either."""


def test_a_pinched_line_is_free_though_no_neighbour_is() -> None:
    graph = visibility_graph(Scene([*SLANTED, *alternating(0)]), 20)
    assert graph.edges[0, 1]["weight"] == 10
    assert (graph.edges[0, 1]["leave"], graph.edges[0, 1]["hit"]) == (Point(0, -2), Point(0, 8))


def test_a_line_pinched_too_much_is_blocked() -> None:
    assert not visibility_graph(Scene([*SLANTED, *alternating(TINY)]), 20).has_edge(0, 1)


def test_a_ray_from_the_start_is_pinched() -> None:
    scene = Scene([SLANTED[1], *alternating(0)], start=(0, -2))
    assert visibility_graph(scene, 20).edges["S", 0]["weight"] == 10
    assert not visibility_graph(Scene([SLANTED[1], *alternating(TINY)], start=(0, -2)), 20).has_edge("S", 0)


def test_a_pinch_between_arcs() -> None:
    """Three circles on alternating sides are tangent to x = 0: only that line passes, until one moves in."""
    far = [box(-30, -103, 30, -102), box(-30, 210, 30, 211)]
    right = [Circle((40, -50), 40), Circle((40, 150), 40)]
    graph = visibility_graph(Scene([*far, *right, Circle((-40, 50), 40)]), 400)
    assert graph.edges[0, 1]["weight"] == 312
    assert not visibility_graph(Scene([*far, *right, Circle((-40 + TINY, 50), 40)]), 400).has_edge(0, 1)


def test_the_isolated_segment_of_a_family_is_found() -> None:
    """Bars from both sides leave one perpendicular of two parallel edges, and a strip far from it."""
    low, high = box(-10, -2, 20, 0), box(-10, 6, 20, 8)
    bars = [box(0, 1, 15, 2), box(-9, 3, 0, 4)]
    table = EdgeTable(Scene([low, high, *bars]).obstacles)
    (family,) = [
        found
        for a in table.curves[:4]
        for b in table.curves[4:8]
        for found in nearest_points(a, b)
        if isinstance(found, NearestFamily) and found.distance_sq == 36
    ]
    pieces = list(free_pieces(table, family))
    isolated = [(p.start.x, p.end.x) for p in pieces if isinstance(p, Chord)]
    strips = sorted(sorted((p.first.start.x, p.first.end.x)) for p in pieces if isinstance(p, NearestFamily))
    assert isolated == [(0, 0)]
    assert strips == [[-10, -9], [15, 20]]


def test_corners_that_face_each_other_along_a_line() -> None:
    """Moving along the horizontal edges changes the distance to second order only: it is a minimum."""
    graph = visibility_graph(Scene([box(0, 0, 1, 1), box(1, 3, 2, 4)]), 5)
    assert graph.edges[0, 1]["weight"] == 2


@pytest.mark.parametrize("shift", [0, 10**9, -(10**15)])
def test_clearance_of_a_segment_along_edges(shift: int) -> None:
    """Running along an edge or through a corner is free; entering by 10^-60 is not, wherever it lies."""
    scene = Scene([box(shift, 0, shift + 2, 1), Outline([(shift + 5, 0, 1), (shift + 7, 0)])])
    table = EdgeTable(scene.obstacles)

    def free(x0: object, y0: object, x1: object, y1: object) -> bool:
        return is_free(table, Point(shift + Fraction(x0), y0), Point(shift + Fraction(x1), y1))

    assert free(-1, 1, 3, 1) and free(-1, 0, 8, 0)
    assert not free(-1, 1 - TINY, 3, 1)
    assert free(-1, 2, 1, 0) is False
    assert free(-1, 2, 0, 1) and free(1, 1, 2, 1)
    assert free(6, -1, 6, 0) and not free(6, -1, 6, TINY)


def test_links_refuse_what_they_cannot_sense() -> None:
    scene = Scene([Circle((3, 0), 1)], start=(2, 0))
    with pytest.raises(ValueError, match="positive"):
        Links(scene, 0)
    with pytest.raises(ValueError, match="given"):
        Links(scene, None)
    assert Links(scene, 1).from_point(scene.start)[0].length == 0


@pytest.mark.parametrize("crescent", [[(0, 4, 1), (0, 0, "-1/2")], [(0, 0, "-1/2"), (0, 4, 1)]])
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_start_at_a_tip_of_a_crescent(crescent: list[tuple[object, ...]], mirrored: bool) -> None:
    """Two edges join the same two vertices in both orders: which is the start decides what is in sight."""
    target, start = box(-1, 7, 1, 8), (0, 0)
    if mirrored:
        target, start = box(-1, -4, 1, -3), (0, 4)
    graph = visibility_graph(Scene([Outline(crescent), target], start=start), 10)
    assert graph.edges["S", 0]["weight"] == 0
    assert graph.edges["S", 1]["weight"] == 7
    assert graph.edges["S", 1]["hit"] == (Point(0, -3) if mirrored else Point(0, 7))


@pytest.mark.parametrize(
    ("circles", "radius"),
    [
        ([((0, 0), 1), ((3, 3), Fraction(1, 2)), ((7, 7), 1)], 12),
        ([((0, 0), 1), ((3, 0), Fraction(1, 2)), ((7, 0), 1)], 12),
        ([((0, 0), 1), ((2, 1), Fraction(1, 3)), ((6, 3), 2)], 12),
    ],
)
def test_circles_in_a_row_are_joined_by_two_mirrored_chords(circles: list[tuple], radius: int) -> None:
    """Both have one length, over roots of different polynomials of degree 12 and more: symmetry decides."""
    data = visibility_graph(Scene([Circle(*circle) for circle in circles]), radius).edges[0, 2]
    (one, other) = data["link"].shortest
    (ax, ay), (bx, by) = circles[0][0], circles[2][0]
    dx, dy = bx - ax, by - ay

    def height(point: Point) -> float:
        return (dx * (float(point.y) - ay) - dy * (float(point.x) - ax)) / (dx * dx + dy * dy) ** 0.5

    for p, q in ((one.start, other.start), (one.end, other.end)):
        assert height(p) == pytest.approx(-height(q), abs=1e-12) and abs(height(p)) > 0.1
    for chord in (one, other):
        assert float(chord.length) == pytest.approx(
            float((chord.end - chord.start).norm_sq()) ** 0.5, rel=1e-14
        )
        for point, (center, r) in ((chord.start, circles[0]), (chord.end, circles[2])):
            distance = (point - Point(*center)).norm_sq()
            assert float(distance) == pytest.approx(float(r) ** 2, rel=1e-14)


@pytest.mark.parametrize("parts", [False, True], ids=["whole circles", "circles in arcs"])
@pytest.mark.parametrize(("x", "y"), [(1, 0), (4, 3)])
def test_chords_past_two_mirrored_corners_are_equal(x: int, y: int, parts: bool) -> None:
    """A square hides a disc from another: past one corner or the other, the ways are mirror images.

    They were compared as roots of two polynomials, which was undecided. With (4, 3) the axis
    is not one of coordinates.
    """
    size = math.isqrt(x * x + y * y)
    c, s = Fraction(x, size), Fraction(y, size)

    def turned(u: object, v: object) -> tuple[Fraction, Fraction]:
        u, v = Fraction(u), Fraction(v)
        return c * u - s * v, s * u + c * v

    def disc(u: int, r: int) -> object:
        if not parts:
            return Circle(turned(u, 0), r)
        return Outline([(*turned(u + r, 0), 1), (*turned(u - r, 0), 1)])

    square = Polygon([turned(-1, -1), turned(1, -1), turned(1, 1), turned(-1, 1)])
    scene = Scene([disc(5, 2), square, disc(-6, 1)])
    found = visibility_graph(scene, 20).edges[0, 2]["link"].shortest
    assert len(found) == 2
    for chord in found:
        ends = [(float(p.x), float(p.y)) for p in (chord.start, chord.end)]
        for (px, py), u, r in zip(ends, (5, -6), (2, 1), strict=True):
            assert math.hypot(px - float(c * u), py - float(s * u)) == pytest.approx(r, rel=1e-12)
        assert float(chord.length) == pytest.approx(math.dist(*ends), rel=1e-12)
        (ax, ay), (bx, by) = ends
        corners = [turned(u, v) for u in (-1, 1) for v in (-1, 1)]
        sides = [(bx - ax) * (float(v) - ay) - (by - ay) * (float(u) - ax) for u, v in corners]
        assert min(map(abs, sides)) < 1e-9 and (min(sides) > -1e-9 or max(sides) < 1e-9)
    one, other = found
    assert one.length == other.length


def two_hidden(wall: bool, image: str, turn: tuple[int, int], off: Fraction) -> Scene:
    """A disc or a wall, and two bars that each hide a disc: the second pair is an image of the first."""
    x, y = turn
    size = math.isqrt(x * x + y * y)
    c, s = Fraction(x, size), Fraction(y, size)

    def copied(u: Fraction, v: Fraction, second: bool) -> tuple[Fraction, Fraction]:
        if second:
            u, v = {"mirrored": (-u, v), "turned": (-u, -v - 10), "shifted": (u + 20, v)}[image]
            u += off
        return c * u - s * v + Fraction(1, 3), s * u + c * v + 2

    def bar(second: bool) -> Polygon:
        corners = [copied(Fraction(u), Fraction(v, 2), second) for u, v in ((2, 2), (7, 2), (7, 3), (2, 3))]
        return Polygon(corners[::-1] if second and image == "mirrored" else corners)

    def disc(second: bool) -> Circle:
        return Circle(copied(Fraction(5), Fraction(5), second), Fraction(1, 2))

    ground = Circle(copied(Fraction(0), Fraction(-5), second=False), 4)
    if wall or image == "shifted":
        low, high = (-7, -3) if image == "turned" else (-2, -1)
        corners = ((-50, low), (50, low), (50, high), (-50, high))
        ground = Polygon([copied(Fraction(u), Fraction(v), second=False) for u, v in corners])
    return Scene([ground, bar(False), disc(False), bar(True), disc(True)])


@pytest.mark.parametrize("wall", [False, True], ids=["from a disc", "from a wall"])
@pytest.mark.parametrize("image", ["mirrored", "turned", "shifted"])
@pytest.mark.parametrize("turn", [(1, 0), (4, 3)], ids=["upright", "slanted"])
def test_ways_to_copies_are_equal(wall: bool, image: str, turn: tuple[int, int]) -> None:
    """To each of two discs behind equal bars: their lengths are roots of different polynomials of degree 10.

    Comparing them was undecided. A copy that is a hair away has another length, but along a wall.
    """
    links = Links(two_hidden(wall, image, turn, Fraction(0)), 30)
    one, other = links.between(0, 2), links.between(0, 4)
    assert one is not None and other is not None
    assert one.length == other.length
    for link in (one, other):
        (chord,) = link.shortest
        ends = [(float(p.x), float(p.y)) for p in (chord.start, chord.end)]
        assert math.dist(*ends) == pytest.approx(float(link.length), rel=1e-12)
        disc = links.table.curves[links.table.edges_of(link.target)[0]]
        assert math.dist(ends[1], (float(disc.center.x), float(disc.center.y))) == pytest.approx(0.5)
        assert is_free(links.table, chord.start, chord.end)
    if not wall and image != "shifted":
        for hair in (TINY, -TINY):
            moved = Links(two_hidden(wall, image, turn, hair), 30)
            near, far = moved.between(0, 2), moved.between(0, 4)
            assert near is not None and far is not None
            assert near.length != far.length


def test_a_way_from_afar_is_cut_at_the_corner_that_it_touches() -> None:
    """A margin for coordinates of the scene's size is too small where a way begins 10^11 sizes away."""
    corner, far = (Fraction(1, 7), Fraction(3, 7)), Fraction(10**12, 7)
    table = EdgeTable(Scene([Polygon([corner, (5, -4), (6, -4)])]).obstacles)
    start, end = (Point(corner[0] + s, corner[1] + s / 3) for s in (-far, Fraction(1)))
    assert [part.end for _, part in parts_of(table, Segment(start, end))] == [Point(*corner), end]


@pytest.mark.parametrize("digits", [0, 1, 8, 9, 10, 15, 16, 17, 60, 400])
def test_a_rational_between_two_numbers_is_strictly_between(digits: int) -> None:
    """Wide gaps are told by floats, narrow ones by balls; no gap is too narrow, and no end is met."""
    rng, gap = Random(digits), fmpq(1, 10**digits)
    for low in (fmpq(rng.randint(-(10**6), 10**6), rng.randint(1, 10**6)) for _ in range(20)):
        for a, b in (
            (Real(low), Real(low + gap)),
            (Real(low), Real(low) + Real(2).sqrt() * gap),
            (Real(low) - Real(3).sqrt() * gap, Real(low)),
        ):
            assert a < Real(rational_between(a, b)) < b
