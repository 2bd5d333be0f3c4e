"""Views from one point: closed forms, laws, and a float ray caster that shares no code."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from itertools import pairwise
from weakref import ref
from xml.etree import ElementTree

import pytest
from nightly import some

import exactacq as xa
from exactacq import Circle, InvalidScene, Length, Outline, Point, Polygon, Real, Scene, isovist
from exactacq.files.octagons import random_octagons
from exactacq.gc_pause import uncollected

SQUARE = Polygon([(1, -1), (2, -1), (2, 1), (1, 1)])
ROOM = Circle((0, 0), 5)


def turns(coefficient):
    return Length.turns(coefficient, Fraction(1, 2))


# -- closed forms ----------------------------------------------------------------------------------


def test_nothing_in_sight_is_a_disc() -> None:
    view = isovist(Scene([]), (0, 0), 3)
    assert view.area == turns(9) and view.perimeter == turns(6)
    assert [piece.kind.value for piece in view.pieces] == ["range"]


def test_a_square_takes_a_quarter_of_the_disc_but_for_a_triangle() -> None:
    view = isovist(Scene([SQUARE]), (0, 0), 10)
    assert view.area == turns(75) + Length(1)
    assert [piece.kind.value for piece in view.pieces] == ["window", "edge", "window", "range"]
    assert (view.pieces[1].obstacle, view.pieces[1].edge) == (0, 3)
    assert view.pieces[0].near == Point(1, -1) and view.pieces[2].near == Point(1, 1)


@pytest.mark.parametrize(("point", "share"), [((1, 0), 2), ((1, 1), 3), ((1, Fraction(1, 3)), 2)])
def test_from_an_edge_half_from_a_corner_three_quarters(point: tuple[object, object], share: int) -> None:
    """The own edges are seen along their length, and the outline passes through the point."""
    view = isovist(Scene([SQUARE]), point, 10)
    assert view.area == turns(25 * share)
    own = sum(1 for p in view.pieces if p.obstacle == 0 and Point(*point) in (p.curve.start, p.curve.end))
    assert own == 2


def test_a_round_obstacle() -> None:
    """Sector outside the tangents, and the kite between them less the circle's part."""
    view = isovist(Scene([Circle((3, 0), 1)]), (0, 0), 5)
    shadow = Length.arc(1, Real(7) / 9, 4 * Real(2).sqrt() / 9)  # 2 asin(1/3)
    front = turns(1) - shadow
    assert view.area == turns(25) - shadow * Fraction(25, 2) + Length(2 * Real(2).sqrt()) - front / 2


def test_from_a_round_boundary_half_the_disc() -> None:
    assert isovist(Scene([Circle((3, 0), 1)]), (2, 0), 5).area == turns(Fraction(25, 2))


@pytest.mark.parametrize(("radius", "area"), [(3, turns(9)), (10, turns(25)), (4, turns(16))])
def test_a_round_room(radius: int, area: Length) -> None:
    """Beyond the wall's reach all of the room; a range that touches the wall from inside changes nothing."""
    assert isovist(Scene([], enclosure=ROOM), (1, 0), radius).area == area


def test_a_radius_equal_to_the_gap_sees_a_point() -> None:
    view = isovist(Scene([SQUARE]), (0, 0), 1)
    assert view.area == turns(1)
    assert view.contains(Point(1, 0)) and not view.contains(Point(1, Fraction(1, 10**60)))


def test_what_is_seen_along_one_ray_only() -> None:
    """Squares that touch a line from both sides: it is in the view, but has no area."""
    pinch = [Polygon([(0, 1), (1, 1), (1, 2), (0, 2)]), Polygon([(-1, 3), (0, 3), (0, 4), (-1, 4)])]
    view = isovist(Scene(pinch), (0, 0), 10)
    assert view.contains(Point(0, 9))
    assert not view.contains(Point(Fraction(1, 10**30), 9))


@pytest.mark.parametrize("point", [("3/2", 0), ("1/7", "x")])
def test_points_that_see_nothing(point: tuple[object, object]) -> None:
    with pytest.raises(ValueError):
        isovist(Scene([SQUARE]), point, 10)
    with pytest.raises(InvalidScene, match="radius"):
        isovist(Scene([SQUARE]), (0, 0))


def test_a_point_that_is_too_far_out_is_no_start() -> None:
    with pytest.raises(InvalidScene, match="point: it must not lie farther than"):
        isovist(Scene([SQUARE]), (0, 10**101), 1)


def test_what_lies_beyond_the_own_obstacle_is_not_in_range() -> None:
    """A far edge met through the point's own obstacle, beyond the range, once passed for free space there."""
    scene = Scene([Polygon([(0, 0), (2, 0), (2, 2), (0, 2)]), Polygon([(0, -2), (2, -2), (2, -1), (0, -1)])])
    view = isovist(scene, (1, 2), 1)
    assert view.area == turns(Fraction(1, 2))
    assert [piece.kind.value for piece in view.pieces] == ["edge", "edge", "range"]


def test_a_boundary_point_does_not_see_through_its_obstacle() -> None:
    view = isovist(Scene([SQUARE]), (1, 0), 10)
    assert not view.contains(Point(2, 0)) and not view.contains(Point(2, 1))
    assert view.contains(Point(1, 1)) and view.contains(Point(0, 5))


@pytest.mark.parametrize("radius", [Fraction(1, 2), 5])
def test_from_algebraic_points_of_a_circle(radius: object) -> None:
    """Square roots, plain and nested, whichever way the tangent there runs."""
    half = Real(2).sqrt() / 2
    nested = ((1 + half) / 2).sqrt(), ((1 - half) / 2).sqrt()
    for x, y in ((half, half), nested):
        view = isovist(Scene([Circle((0, 0), 1)]), (x, y), radius)
        assert view.area == turns(Fraction(radius) ** 2 / 2)
        assert view.seen() == {(0, 0): [(view.point, view.point)]}


def test_from_an_algebraic_point_at_large() -> None:
    """A square whose corners lie at 45 degrees either way takes a quarter, but for a triangle."""
    root = Real(2).sqrt()
    view = isovist(Scene([Polygon([(1, -1), (2, -1), (2, 1), (1, 1)])]), (1 - root, 0), 10)
    shadow = Length.arc(1, (root * root - 1) / (root * root + 1), 2 * root / (root * root + 1))
    assert view.area == turns(100) - shadow * 50 + Length(root)
    assert view.pieces[1].curve.start == Point(1, -1)


def test_rays_see_beyond_the_outline() -> None:
    pinch = [Polygon([(0, 1), (1, 1), (1, 2), (0, 2)]), Polygon([(-1, 3), (0, 3), (0, 4), (-1, 4)])]
    (ray,) = isovist(Scene(pinch), (0, 0), 10).rays
    assert (ray.start, ray.end) == (Point(0, 0), Point(0, 10))
    assert isovist(Scene([SQUARE]), (0, 0), 10).rays == ()


def test_the_picture() -> None:
    """Well-formed, the same each time, with the view, dashed windows, range arcs and the point."""
    room = Outline([(-4, -4), (4, -4, Fraction(1, 4)), (4, 4), (-4, 4)])
    view = isovist(Scene([SQUARE, Circle((-1, 2), Fraction(1, 2))], enclosure=room), (0, 0), 3)
    text = view._repr_svg_()
    root = ElementTree.fromstring(text)
    paths = root.findall(".//{http://www.w3.org/2000/svg}path")
    assert len(paths) == 3 + 4 and sum("stroke-dasharray" in path.attrib for path in paths) == 1
    assert text == isovist(view.scene, (0, 0), 3)._repr_svg_()
    assert ElementTree.fromstring(isovist(Scene([]), (0, 0), 1)._repr_svg_()) is not None


# -- laws ------------------------------------------------------------------------------------------


def round_scene(seed: int) -> tuple[list[object], tuple[Fraction, Fraction]]:
    """Shapes on a lattice of spacing 4, and a point between them."""
    rng = random.Random(seed)
    shapes: list[object] = []
    for i in range(-2, 3):
        for j in range(-2, 3):
            if (i, j) != (0, 0) and rng.random() < 0.7:
                shapes.append(lattice_shape(rng, 4 * i, 4 * j))
    return shapes, (Fraction(rng.randint(-9, 9), 10), Fraction(rng.randint(-9, 9), 10))


def lattice_shape(rng: random.Random, x: int, y: int) -> object:
    kind = rng.randrange(4)
    size = Fraction(rng.randint(5, 14), 10)
    if kind == 0:
        return Circle((x, y), size)
    if kind == 1:
        return Polygon([(x - size, y - size), (x + size, y - size), (x, y + size)])
    bulge = Fraction(rng.randint(1, 9), 10) * (1 if kind == 2 else -1)
    return Outline([(x - 1, y - 1), (x + 1, y - 1, bulge / 2), (x + 1, y + 1), (x - 1, y + 1, bulge / 2)])


@pytest.mark.parametrize("seed", range(12))
def test_the_outline_is_closed_and_the_area_grows_with_the_range(seed: int) -> None:
    shapes, point = round_scene(seed)
    scene = Scene(shapes)
    views = [isovist(scene, point, radius) for radius in (2, Fraction(7, 2), 8)]
    for view in views:
        ends = [(piece.curve.start, piece.curve.end) for piece in view.pieces]
        assert all(a[1] == b[0] for a, b in pairwise([*ends, ends[0]]))
        assert view.area <= turns(view.radius * view.radius)
    assert all(a.area <= b.area for a, b in pairwise(views))


@pytest.mark.parametrize("seed", range(6))
def test_rigid_motions_keep_area_and_perimeter(seed: int) -> None:
    shapes, point = round_scene(seed)
    c, s = Fraction(3, 5), Fraction(4, 5)

    def move(x: object, y: object) -> tuple[object, object]:
        return c * Fraction(str(x)) - s * Fraction(str(y)) + 7, s * Fraction(str(x)) + c * Fraction(str(y))

    moved = [
        Circle(move(*shape.center), shape.radius)
        if isinstance(shape, Circle)
        else Outline([(*move(x, y), bulge) for x, y, bulge in shape.vertices])
        for shape in shapes
    ]
    one = isovist(Scene(shapes), point, 5)
    other = isovist(Scene(moved), move(*point), 5)
    assert one.area == other.area and one.perimeter == other.perimeter
    assert sorted(p.kind.value for p in one.pieces) == sorted(p.kind.value for p in other.pieces)


# -- a ray caster in floats ------------------------------------------------------------------------


def cast(shapes: list[object], x: float, y: float, angle: float, reach: float) -> float:
    """Distance to the first obstacle in a direction, at most the range."""
    dx, dy = math.cos(angle), math.sin(angle)
    best = reach
    for shape in shapes:
        if isinstance(shape, Circle):
            arcs = [(float(shape.center[0]), float(shape.center[1]), float(shape.radius), None)]
            edges: list[tuple[float, float, float, float]] = []
        else:
            arcs, edges = split(shape)
        for ax, ay, bx, by in edges:
            below = dx * (by - ay) - dy * (bx - ax)
            if below:
                t = ((ax - x) * (by - ay) - (ay - y) * (bx - ax)) / below
                u = ((ax - x) * dy - (ay - y) * dx) / below
                if t > 0 and 0 <= u <= 1:
                    best = min(best, t)
        for ox, oy, r, inside in arcs:
            b = (ox - x) * dx + (oy - y) * dy
            square = r * r - ((ox - x) ** 2 + (oy - y) ** 2 - b * b)
            for sign in (-1, 1) if square >= 0 else ():
                t = b + sign * math.sqrt(square)
                if t > 0 and (inside is None or inside(x + t * dx, y + t * dy)):
                    best = min(best, t)
    return best


def split(shape: object) -> tuple[list[object], list[tuple[float, float, float, float]]]:
    """Arcs as (centre, radius, test of a point on the circle) and straight edges."""
    rows = [tuple(float(c) for c in vertex) for vertex in shape.vertices]
    arcs, edges = [], []
    for (ax, ay, bulge), (bx, by, _) in pairwise([*rows, rows[0]]):
        if not bulge:
            edges.append((ax, ay, bx, by))
            continue
        offset = (1 - bulge * bulge) / (4 * bulge)
        ox, oy = (ax + bx) / 2 - (by - ay) * offset, (ay + by) / 2 + (bx - ax) * offset

        def inside(px: float, py: float, a: object = (ax, ay, bx, by, bulge)) -> bool:
            return ((a[2] - a[0]) * (py - a[1]) - (a[3] - a[1]) * (px - a[0])) * a[4] <= 0

        arcs.append((ox, oy, math.hypot(ax - ox, ay - oy), inside))
    return arcs, edges


@pytest.mark.parametrize("seed", some(range(8), 4))
def test_area_agrees_with_cast_rays(seed: int) -> None:
    shapes, point = round_scene(seed)
    view = isovist(Scene(shapes), point, 7)
    x, y = (float(c) for c in point)
    count = 3000
    rays = (cast(shapes, x, y, 2 * math.pi * (k + 0.5) / count, 7.0) for k in range(count))
    assert float(view.area) == pytest.approx(sum(r * r for r in rays) * math.pi / count, rel=5e-3)


def test_among_many_octagons() -> None:
    scene = random_octagons(100, seed=3)
    view = isovist(scene, (0, 0), 10)
    assert Length(0) < view.area < turns(100)
    assert {piece.obstacle for piece in view.pieces} > {None}


def test_a_view_is_no_part_of_a_cycle() -> None:
    """So it goes with its last user, and makes no work for the search for cyclic garbage."""
    view = isovist(Scene([Circle((3, 0), 1), Circle((0, 3), 1)]), (0, 0), radius=4)
    assert [piece.curve for piece in view.pieces] and view.seen()
    known = ref(view._view)
    with uncollected():
        del view
        assert known() is None


@pytest.mark.parametrize("divided", [(), (3,), (1, 3), (1, Fraction(5, 2), 3)])
def test_what_is_seen_along_a_wall_does_not_depend_on_vertices_that_divide_it(
    divided: tuple[object, ...],
) -> None:
    """From (2, 0) on the upper side of a box the view runs along that side to both ends, and past them."""
    xs = sorted({0, 4, *divided}, reverse=True)
    scene = xa.Scene([xa.Polygon([(0, -2), (4, -2), *((x, 0) for x in xs)])])
    view = xa.isovist(scene, (2, 0), 8)
    windows = [piece for piece in view.pieces if piece.kind.value == "window"]
    assert sorted(str(piece.near) for piece in windows) == ["(0, 0)", "(4, 0)"]
    along = [piece.curve for piece in view.pieces if piece.kind.value == "edge"]
    assert sum((curve.length for curve in along), xa.Length(0)) == 4
