"""Laws and oracles for contacts, lines against curves, nearest points, and locating points in loops."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations, pairwise
from math import atan2, cos, pi, sin

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import LineString
from shapely import Point as ShapelyPoint
from shapely import Polygon as ShapelyPolygon

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import ContactKind, contacts, line_contacts, line_points, spans
from exactacq.geometry.loops import locate, signed_area, winding
from exactacq.geometry.nearest_points import NearestFamily, NearestFamilyKind, nearest_points
from exactacq.geometry.points import Location, Point
from exactacq.numbers.real import Real, rational
from exactacq.scene.shapes import Circle, Outline, Polygon, shape_edges
from exactacq.strategies.seed_spreader.range_thresholds import nearest_point

HAIR = Fraction(1, 10**60)
BULGES = tuple(map(Fraction, ("1/2", "-1/2", "1", "-1", "2", "-2", "1/3", "-3")))


def segment(ax, ay, bx, by):
    return Segment(Point(ax, ay), Point(bx, by))


def bulged(ax, ay, bx, by, bulge):
    return Arc.from_bulge(Point(ax, ay), Point(bx, by), rational(bulge))


def circle(x, y, radius):
    return shape_edges(Circle((x, y), radius))[0]


cells = st.integers(-3, 3)


@st.composite
def segments(draw):
    ends = [draw(cells) for _ in range(4)]
    assume(ends[:2] != ends[2:])
    return segment(*ends)


@st.composite
def arcs(draw):
    if draw(st.integers(0, 4)) == 0:
        return circle(draw(cells), draw(cells), draw(st.sampled_from([1, 2, 3, Fraction(5, 2)])))
    ends = [draw(cells) for _ in range(4)]
    assume(ends[:2] != ends[2:])
    return bulged(*ends, draw(st.sampled_from(BULGES)))


curves = segments() | arcs()


def each_pair(law):
    """Check a law of two curves on all pairs of six random ones: degenerate pairs are common on few cells."""

    @given(st.lists(curves, min_size=6, max_size=6))
    def check(some):
        for a, b in combinations(some, 2):
            law(a, b)

    check.__doc__ = law.__doc__
    return check


def turned(point: Point) -> Point:
    return Point(point.x * 3 - point.y * 4, point.x * 4 + point.y * 3) / 5


def turned_curve(curve: Curve) -> Curve:
    if isinstance(curve, Segment):
        return Segment(turned(curve.start), turned(curve.end))
    return Arc(
        turned(curve.start), turned(curve.end), turned(curve.center), curve.radius_sq, curve.ccw, curve.full
    )


def on(curve: Curve, point: Point) -> bool:
    if isinstance(curve, Segment):
        return curve.direction.cross(point - curve.start).sign() == 0 and curve.contains(point)
    return (point - curve.center).norm_sq() == curve.radius_sq and curve.contains(point)


def is_circle(curve: Curve) -> bool:
    return isinstance(curve, Arc) and curve.full


def samples(curve: Curve, count: int) -> np.ndarray:
    """Points along a curve, both ends included, from its floats: shares nothing with the code under test."""
    t = np.linspace(0.0, 1.0, count)
    (ax, ay), (bx, by) = curve.start.xy, curve.end.xy
    if isinstance(curve, Segment):
        return np.column_stack([ax + t * (bx - ax), ay + t * (by - ay)])
    cx, cy = curve.center.xy
    begin, end = atan2(ay - cy, ax - cx), atan2(by - cy, bx - cx)
    sense = 1 if curve.ccw else -1
    phi = begin + t * sense * (2 * pi if curve.full else (sense * (end - begin)) % (2 * pi))
    radius = float(curve.radius_sq.p) ** 0.5 / float(curve.radius_sq.q) ** 0.5
    return np.column_stack([cx + radius * np.cos(phi), cy + radius * np.sin(phi)])


def same_points(left: list[Point], right: list[Point]) -> bool:
    return len(left) == len(right) and all(any(p == q for q in right) for p in left)


def isolated(found) -> list[Point]:
    return [c.start for c in found if c.kind is not ContactKind.OVERLAP]


def overlaps(found) -> int:
    return sum(c.kind is ContactKind.OVERLAP for c in found)


# -- contacts --------------------------------------------------------------------------------------


@each_pair
def test_contacts_lie_on_both_and_are_symmetric(a, b):
    found = contacts(a, b)
    for contact in found:
        assert all(on(c, p) for c in (a, b) for p in (contact.start, contact.end))
        is_point = contact.kind is not ContactKind.OVERLAP
        assert not is_point or contact.start is contact.end
    for other in (contacts(b, a), contacts(a.reversed(), b), contacts(a, b.reversed())):
        assert same_points(isolated(found), isolated(other))
        assert sorted(c.kind.value for c in found) == sorted(c.kind.value for c in other)


@each_pair
def test_contacts_turn_with_the_plane(a, b):
    found, there = contacts(a, b), contacts(turned_curve(a), turned_curve(b))
    assert same_points([turned(p) for p in isolated(found)], isolated(there))
    assert overlaps(found) == overlaps(there)


@given(curves)
def test_a_curve_overlaps_itself(curve):
    for other in (curve, curve.reversed()):
        (contact,) = contacts(curve, other)
        assert contact.kind is ContactKind.OVERLAP
        assert contact.start == curve.start and contact.end == curve.end


@given(segments(), segments())
def test_segments_agree_with_shapely(a, b):
    lines = [LineString([s.start.xy, s.end.xy]) for s in (a, b)]
    common = lines[0].intersection(lines[1])
    found = contacts(a, b)
    assert bool(found) == lines[0].intersects(lines[1])
    if found and found[0].kind is ContactKind.OVERLAP:
        ends = {found[0].start.xy, found[0].end.xy}
        assert ends == set(common.coords)
    elif found:
        assert common.distance(ShapelyPoint(found[0].start.xy)) < 1e-12
        assert (found[0].kind is ContactKind.CROSSING) == lines[0].crosses(lines[1])


@each_pair
def test_contacts_agree_with_sampling(a, b):
    """Where the sampled distance is clearly positive nothing meets; contacts are near samples of both."""
    p, q = samples(a, 181), samples(b, 181)
    gap = np.hypot(*(p[:, None] - q[None]).transpose(2, 0, 1))
    step = max(np.hypot(*np.diff(c, axis=0).T).max() for c in (p, q))
    found = contacts(a, b)
    if gap.min() > 2 * step:
        assert not found
    for contact in found:
        assert all(np.hypot(*(c - contact.start.xy).T).min() <= step for c in (p, q))


@given(arcs(), st.lists(st.integers(-4, 4), min_size=4, max_size=4))
def test_crossings_of_a_general_line_are_its_changes_of_side(arc, numbers):
    """A segment across everything, off the lattice: crossings are where sampled points change sides."""
    x, y, dx, dy = numbers
    assume(dx or dy)
    origin, along = Point(x + Fraction(1, 7), y + Fraction(2, 11)), Point(dx, dy)
    line = Segment(origin - along * 20, origin + along * 20)
    points = samples(arc, 20001)
    (ox, oy), (ax, ay) = origin.xy, along.xy
    side = ax * (points[:, 1] - oy) - ay * (points[:, 0] - ox)
    assume(np.abs(side).min() > 0 and all(c.kind is ContactKind.CROSSING for c in contacts(line, arc)))
    assert len(contacts(line, arc)) == int((np.sign(side[1:]) != np.sign(side[:-1])).sum())


TANGENT = [
    (circle(0, 0, 1), circle(3, 0, 2), (1, 0)),
    (circle(0, 0, 3), circle(1, 0, 2), (3, 0)),
    (circle(0, 0, 5), segment(-1, 7, 7, 1), (3, 4)),
    (circle(0, 0, 5), bulged(3, 4, 6, 8, 1), (3, 4)),
    (circle(0, 0, 1), segment(1, 0, 2, 0), (1, 0)),
    (bulged(0, 0, 2, 0, -1), segment(-1, 1, 4, 1), (1, 1)),
]


@pytest.mark.parametrize(("a", "b", "at"), TANGENT)
def test_a_tangency_touches_once(a, b, at):
    (contact,) = contacts(a, b)
    assert contact.kind is ContactKind.TOUCHING
    assert contact.start == Point(*at)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_hair_decides_tangency(sign):
    gap = contacts(circle(0, 0, 1), circle(2 + sign * HAIR, 0, 1))
    assert [c.kind for c in gap] == ([] if sign > 0 else [ContactKind.CROSSING] * 2)
    line = contacts(segment(-1, 1 + sign * HAIR, 1, 1 + sign * HAIR), circle(0, 0, 1))
    assert len(line) == (0 if sign > 0 else 2)
    end = contacts(segment(1 + sign * HAIR, 0, 2, 0), circle(0, 0, 1))
    assert [c.kind for c in end] == ([] if sign > 0 else [ContactKind.CROSSING])


def test_irrational_tangent_circles_touch():
    """Radii sqrt 2 and 2 sqrt 2, centres (0, 0) and (3, 3): the distance is the sum of the radii."""
    a = Arc(Point(1, 1), Point(1, 1), Point(0, 0), rational(2), ccw=True, full=True)
    b = Arc(Point(5, 5), Point(5, 5), Point(3, 3), rational(8), ccw=False, full=True)
    (contact,) = contacts(a, b)
    assert contact.kind is ContactKind.TOUCHING and contact.start == Point(1, 1)


def test_pieces_of_one_circle():
    upper, lower = bulged(1, 0, -1, 0, 1), bulged(-1, 0, 1, 0, 1)
    assert same_points(isolated(contacts(upper, lower)), [Point(1, 0), Point(-1, 0)])
    three_quarters = Arc(Point(0, -1), Point(-1, 0), Point(0, 0), rational(1), ccw=True)
    (contact,) = contacts(three_quarters, upper)
    assert (contact.kind, contact.start, contact.end) == (ContactKind.OVERLAP, upper.start, upper.end)
    left = Arc(Point("3/5", "4/5"), Point("3/5", "-4/5"), Point(0, 0), rational(1), ccw=True)
    right = Arc(Point("-3/5", "-4/5"), Point("-3/5", "4/5"), Point(0, 0), rational(1), ccw=True)
    found = contacts(left, right)
    assert overlaps(found) == 2
    assert same_points([c.start for c in found], [left.start, right.start])
    (whole,) = contacts(circle(0, 0, 1), circle(0, 0, 1).reversed())
    assert whole.kind is ContactKind.OVERLAP
    assert contacts(circle(0, 0, 1), circle(0, 0, 2)) == []


def test_a_segment_without_length_passes_its_point_alone():
    """It passed all points of the plane: each was on its line, and neither before nor behind it."""
    dot = Segment(Point(1, 2), Point(1, 2))
    assert dot.passes(Point(1, 2)) and not dot.passes(Point(5, 5))
    part = Segment(Point(0, 0), Point(4, 4)).part(Point(1, 1), Point(1, 1))
    assert part.passes(Point(1, 1)) and not part.passes(Point(2, 2))


def test_a_bulge_is_any_rational_but_0():
    """By an int floats were divided: the arc of bulge 3 ran about (0, 1.33...), not about (0, 4/3)."""
    east, west = Point(1, 0), Point(-1, 0)
    assert Arc.from_bulge(east, west, 3).center == Point(0, Fraction(4, 3))
    with pytest.raises(ValueError, match="a bulge that is not 0"):
        Arc.from_bulge(east, west, 0)


def test_shared_ends_are_copied():
    a, b = segment(0, 0, 1, 1), bulged(1, 1, 2, 0, "1/2")
    (contact,) = contacts(a, b)
    assert contact.start is a.end or contact.start is b.start


# -- lines -----------------------------------------------------------------------------------------


@given(curves, cells, cells, cells, cells)
def test_line_parameters_lie_on_the_curve_in_order(curve, x, y, dx, dy):
    assume(dx or dy)
    origin, direction = Point(x, y), Point(dx, dy)
    found = line_contacts(origin, direction, curve)
    assert all(a < b for a, b in pairwise(found))
    assert all(on(curve, origin + direction * parameter) for parameter in found)
    far = Segment(origin - direction * 100, origin + direction * 100)
    ends = [p for c in contacts(far, curve) for p in ([c.start] if c.start is c.end else [c.start, c.end])]
    assert same_points([origin + direction * parameter for parameter in found], ends)


@given(arcs(), st.fractions(0, 1, max_denominator=9), cells, cells)
def test_a_line_through_an_algebraic_point_of_an_arc_finds_it(arc, fraction, x, y):
    target, origin = arc.point(fraction), Point(x, y)
    assume(target != origin)
    found = line_contacts(origin, target - origin, arc)
    assert any(parameter == 1 for parameter in found)


@given(cells, cells, cells, cells)
def test_a_rational_segment_shows_where_it_is_crossed(ax, ay, bx, by):
    """By its form the crossing point is on the line: no number needs to be compared with 0."""
    assume((ax, ay) != (bx, by))
    root, wall = Real(2).sqrt() + Real(3).sqrt(), Segment(Point(ax, ay), Point(bx, by))
    for end in (Point(7 + root, 5), Point(-root, -9)):
        for met in contacts(Segment(Point(root / 9, root / 7), end), wall):
            offset = met.start - wall.start
            assert offset.cross(wall.direction).rational == 0


@given(st.one_of(segments(), arcs()), *[st.integers(-9, 9)] * 2)
def test_a_line_that_is_known_to_touch_an_end_meets_the_same_points(curve, x, y):
    """Ends of the curve are copied, be they known to lie on the line or found to. A circle has none."""
    origin = Point(x, y)
    assume(curve.end != origin)
    found = line_points(origin, curve.end - origin, curve)
    told = line_points(origin, curve.end - origin, curve, on=(curve.end,))
    assert len(told) == len(found) and all(p in found for p in told)
    for points in (told, found):
        assert any(p is curve.end for p in points) or is_circle(curve)


@given(segments(), st.lists(st.integers(0, 6), min_size=2, max_size=2, unique=True), curves, cells, cells)
def test_parts_meet_the_same_points_as_segments_with_their_ends(whole, sixths, curve, x, y):
    """A part computes from the ends of the whole; what its own ends are still counts."""
    start, end = (whole.point(Fraction(n, 6)) for n in sorted(sixths))
    part, alone = whole.part(start, end), Segment(start, end)
    assert part == alone and part.whole is whole and alone.whole is alone

    for other in (curve, alone, whole):
        for swap in (False, True):
            found, expected = (
                contacts(other, piece) if swap else contacts(piece, other) for piece in (part, alone)
            )
            assert len(found) == len(expected)
            assert all(any((c.kind, c.places) == (d.kind, d.places) for d in expected) for c in found)
    origin = Point(x, y)
    for place in (origin, Point(x + Real(2).sqrt(), y)):
        assert part.passes(place) == alone.passes(place)
        assert nearest_point(part, place) == nearest_point(alone, place)
    for way in (part.direction, part.direction.left(), Point(1, 2)):
        assert line_points(origin, way, part) == line_points(origin, way, alone)
        assert line_contacts(origin, way, part) == line_contacts(origin, way, alone)


def test_a_part_is_met_in_numbers_of_its_whole():
    """Whoever knows a part of a wall knows its line: where the wall was cut does not show in what is met."""
    wall = segment(0, 0, 6, 3)
    root = Real(2).sqrt() + Real(3).sqrt()
    part = wall.part(Point(root / 2, root / 4), Point(root, root / 2))
    assert nearest_point(part, Point(2, 2)).rational
    (meeting,) = line_points(Point(0, 5), Point(1, -2), part)
    assert meeting.rational
    (crossing,) = contacts(part, segment(2, 0, 2, 3))
    assert crossing.start.rational == (2, 1)


@given(arcs(), st.fractions(0, 1, max_denominator=7))
def test_a_line_that_is_known_to_touch_an_arc_meets_it_once(arc, fraction):
    touch = arc.point(fraction)
    way = arc.tangent(touch)
    (told,) = line_points(touch - way, way, arc, on=(arc,))
    (found,) = line_points(touch - way, way, arc)
    assert told == found == touch


def test_a_line_keeps_ends_rational():
    """One end of the arc on the line: the other root is rational too, and no square root is taken."""
    found = line_contacts(Point(0, 0), Point(2, 1), bulged(0, 0, 1, 1, 3))
    assert len(found) == 2 and all(parameter.rational is not None for parameter in found)


@given(arcs(), st.integers(-5, 5), st.integers(-5, 5))
def test_spans_is_containment_of_the_radial_point(arc, x, y):
    assume(x or y)
    ray = Point(x, y)
    point = arc.center + ray * (Real(arc.radius_sq) / ray.norm_sq()).sqrt()
    assert spans(arc, (x, y)) == arc.contains(point)
    ends = not arc.full and point in (arc.start, arc.end)
    assert spans(arc, (x, y), strict=True) == (arc.contains(point) and not ends)


# -- nearest points --------------------------------------------------------------------------------


def grid_gap(a: Curve, b: Curve, count: int = 241) -> np.ndarray:
    return np.hypot(*(samples(a, count)[:, None] - samples(b, count)[None]).transpose(2, 0, 1))


@each_pair
def test_nearest_points_hold_the_least_distance(a, b):
    if contacts(a, b):
        return
    distances = [float(pair.distance_sq) ** 0.5 for pair in nearest_points(a, b)]
    gap = grid_gap(a, b)
    step = max(np.hypot(*np.diff(samples(c, 241), axis=0).T).max() for c in (a, b))
    assert min(distances) <= gap.min() + 1e-9
    assert min(distances) >= gap.min() - 2 * step


@each_pair
def test_nearest_points_hold_every_local_minimum(a, b):
    """Each clear pit of the sampled distance has a reported pair of about its depth."""
    if contacts(a, b) or getattr(a, "full", False) or getattr(b, "full", False):
        return
    depths = np.array([float(pair.distance_sq) ** 0.5 for pair in nearest_points(a, b)])
    gap = np.pad(grid_gap(a, b), 4, constant_values=np.inf)
    size = gap.shape[0] - 8
    around = [
        gap[4 + i : 4 + i + size, 4 + j : 4 + j + size]
        for i in range(-4, 5)
        for j in range(-4, 5)
        if (i, j) != (0, 0)
    ]
    inner = gap[4:-4, 4:-4]
    for depth in inner[inner < np.minimum.reduce(around) - 1e-9]:
        assert np.abs(depths - depth).min() < 0.02


@each_pair
def test_nearest_pairs_lie_on_their_curves_and_swap(a, b):
    def check(curve, part):
        ends = [part] if isinstance(part, Point) else [part.start, part.end]
        assert all(on(curve, p) or (isinstance(part, Point) and p == curve.center) for p in ends)

    found, swapped = nearest_points(a, b), nearest_points(b, a)
    for pair in found:
        first, second = (
            (pair.first, pair.second) if isinstance(pair, NearestFamily) else (pair.start, pair.end)
        )
        check(a, first)
        check(b, second)
        if (
            isinstance(pair, NearestFamily)
            and isinstance(first, (Segment, Arc))
            and not isinstance(second, Point)
        ):
            starts, ends = first.start - second.start, first.end - second.end
            assert starts.norm_sq() == ends.norm_sq() == pair.distance_sq
    assert sorted(float(p.distance_sq) for p in found) == sorted(float(p.distance_sq) for p in swapped)


def test_parallel_segments_give_the_facing_pieces():
    a, b = segment(0, 0, 4, 0), segment(6, 3, 1, 3)
    (family,) = nearest_points(a, b)
    assert family.kind is NearestFamilyKind.PARALLEL and family.distance_sq == 9
    assert (family.first.start, family.first.end) == (Point(1, 0), Point(4, 0))
    assert (family.second.start, family.second.end) == (Point(1, 3), Point(4, 3))
    for x, far in ((4, 7), (0, -3)):
        for other in (segment(x, 1, far, 1), segment(far, 1, x, 1)):
            (pair,) = nearest_points(a, other)
            assert (pair.start, pair.end) == (Point(x, 0), Point(x, 1))


def test_concentric_arcs_give_the_common_angles():
    outer = Arc(Point(5, 0), Point(-5, 0), Point(0, 0), rational(25), ccw=True)
    inner = Arc(Point("-6/5", "8/5"), Point("6/5", "8/5"), Point(0, 0), rational(4), ccw=False)
    families = [f for f in nearest_points(outer, inner) if isinstance(f, NearestFamily)]
    (family,) = families
    assert family.distance_sq == 9
    assert family.first.ccw and family.second.ccw
    assert (family.first.start, family.first.end) == (Point(3, 4), Point(-3, 4))
    assert (family.second.start, family.second.end) == (Point("6/5", "8/5"), Point("-6/5", "8/5"))
    (rings,) = nearest_points(circle(0, 0, 1), circle(0, 0, 3))
    assert rings.first.full and rings.second.full and rings.distance_sq == 4


def test_the_centre_of_an_arc_is_a_family():
    families = [
        f for f in nearest_points(segment(0, 0, -1, 0), circle(0, 0, 2)) if isinstance(f, NearestFamily)
    ]
    assert [(f.kind, f.distance_sq) for f in families] == [(NearestFamilyKind.CONCENTRIC, Real(4))]
    assert families[0].first == Point(0, 0)


def test_circles_apart_and_nested_have_one_nearest_pair():
    (pair,) = nearest_points(circle(0, 0, 1), circle(5, 0, 2))
    assert (pair.start, pair.end, pair.distance_sq) == (Point(1, 0), Point(3, 0), Real(4))
    (pair,) = nearest_points(circle(0, 0, 5), circle(1, 0, 2))
    assert (pair.start, pair.end, pair.distance_sq) == (Point(5, 0), Point(3, 0), Real(4))
    (pair,) = nearest_points(circle(1, 0, 2), circle(0, 0, 5))
    assert (pair.start, pair.end) == (Point(3, 0), Point(5, 0))


# -- loops -----------------------------------------------------------------------------------------


POLYGONS = [
    [(0, 0), (4, 0), (4, 4), (0, 4)],
    [(0, 0), (6, 0), (6, 2), (4, 2), (4, 4), (6, 4), (6, 6), (0, 6), (0, 4), (2, 4), (2, 2), (0, 2)],
    [(0, 3), (2, 0), (3, 3), (4, 0), (6, 3), (3, 6)],
    [(1, 0), (3, 2), (5, 0), (5, 5), (3, 3), (1, 5)],
]


@pytest.mark.parametrize("vertices", POLYGONS)
def test_locate_agrees_with_shapely(vertices):
    """Half-integer points: rays run through vertices, along edges and over local extremes."""
    polygon = ShapelyPolygon(vertices)
    edges = shape_edges(Polygon(vertices))
    backward = tuple(e.reversed() for e in reversed(edges))
    ccw = signed_area(edges).sign() > 0
    assert ccw == polygon.exterior.is_ccw
    left, right = (edges, backward) if ccw else (backward, edges)
    for i in range(-2, 15):
        for j in range(-2, 15):
            x, y = Fraction(i, 2), Fraction(j, 2)
            q = ShapelyPoint(float(x), float(y))
            expected = 0 if polygon.touches(q) else 1 if polygon.contains(q) else -1
            assert locate(left, Point(x, y)) == expected
            assert locate(right, Point(x, y)) == -expected
            assert locate(right, Point(x, y), ccw=False) == -expected


OUTLINES = [
    [(0, 0, 1), (4, 0, 1)],
    [(0, 0, Fraction(1, 2)), (4, 0, 0), (4, 4, Fraction(-1, 2)), (0, 4, 1)],
    [(0, 0, 0), (2, 0, 1), (2, 2, 0), (0, 2, -1)],
    [(0, 0, 2), (3, 0, -1), (4, 0, 0), (4, 9, 0), (-4, 9, 0)],
    [(0, 0, -1), (2, 0, -1), (4, 0, 1), (6, 0, 3)],
]


@pytest.mark.parametrize("vertices", OUTLINES)
def test_locate_agrees_with_the_angle_sum(vertices):
    """The winding number from the angle that sampled boundary points turn through, seen from each point."""
    edges = shape_edges(Outline(vertices))
    loop = np.vstack([samples(edge, 2001)[:-1] for edge in edges])
    for i in range(-6, 18):
        for j in range(-8, 20):
            x, y = Fraction(i, 2), Fraction(j, 2)
            offset = loop - (float(x), float(y))
            if np.hypot(*offset.T).min() < 0.02:
                continue
            angle = np.unwrap(np.arctan2(offset[:, 1], offset[:, 0]))
            closing = np.arctan2(offset[0, 1], offset[0, 0]) - np.arctan2(offset[-1, 1], offset[-1, 0])
            total = angle[-1] - angle[0] + (closing + pi) % (2 * pi) - pi
            assert winding(edges, Point(x, y)) == round(total / (2 * pi))


@pytest.mark.parametrize("vertices", OUTLINES)
def test_algebraic_boundary_points_and_hairs(vertices):
    edges = shape_edges(Outline(vertices))
    if signed_area(edges).sign() < 0:
        edges = tuple(e.reversed() for e in reversed(edges))
    for edge in edges:
        for fraction in ("1/3", "1/2", "3/4"):
            point = edge.point(fraction)
            travel = edge.tangent(point) if isinstance(edge, Arc) else edge.direction
            assert locate(edges, point) is Location.BOUNDARY
            assert locate(edges, point + travel.left() * HAIR) is Location.INSIDE
            assert locate(edges, point - travel.left() * HAIR) is Location.OUTSIDE


def test_horizontal_rays_over_extremes_of_a_circle():
    ring = (circle(0, 0, 2),)
    places = {(-3, 2): -1, (0, 2): 0, (0, -2): 0, (-2, 0): 0, (-1, 0): 1, (-3, -2): -1, (-3, 0): -1}
    assert {p: int(locate(ring, Point(*p))) for p in places} == places


@given(st.lists(st.integers(1, 6), min_size=3, max_size=7), st.sampled_from(BULGES))
def test_the_area_of_a_star_shaped_loop(radii, bulge):
    """Against Green's theorem on samples; reversal negates it."""
    n = len(radii)
    corners = [
        (round(r * cos(2 * pi * k / n), 3), round(r * sin(2 * pi * k / n), 3)) for k, r in enumerate(radii)
    ]
    bulges = [0, *[bulge] * (n - 1)]
    edges = shape_edges(Outline([(*corner, b) for corner, b in zip(corners, bulges, strict=True)]))
    loop = np.vstack([samples(edge, 2001)[:-1] for edge in edges])
    x, y = loop.T
    green = (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2
    assert float(signed_area(edges)) == pytest.approx(green, rel=1e-4, abs=1e-3)
    backward = tuple(e.reversed() for e in reversed(edges))
    assert signed_area(backward) == -signed_area(edges)
