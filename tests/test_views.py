"""All boundary points seen from a point: against brute force in exact arithmetic, and in explained cases."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import pairwise
from random import Random

import pytest
from nightly import some
from strategies import degenerate_terrain, random_terrain

from exactacq import Circle, Outline, Point, Polygon, Real, Scene, isovist, kernel
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Location, distance_sq
from exactacq.numbers.rationals import rational
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.sensor_range import Range
from exactacq.visibility.visible_boundary import BoundaryView

Q = Fraction
TINY = Q(1, 10**60)
RADII = (1, 2, 3, Q(7, 2), 5, 9, 30)


def square(x: object, y: object, side: object = 1) -> Polygon:
    """An axis-parallel square by its lower left corner."""
    return Polygon([(x, y), (x + side, y), (x + side, y + side), (x, y + side)])


# -- brute force -----------------------------------------------------------------------------------


def is_seen(table: EdgeTable, eye: Point, point: Point, radius: object) -> bool:
    """Whether the open segment between two points is free: the middles of all its parts are located."""
    if eye == point:
        return True
    if distance_sq(eye, point).compare(rational(radius) ** 2) > 0:
        return False
    ray = point - eye
    stops: dict[int, list[Real]] = {}
    for e, curve in enumerate(table.curves):
        for t in line_contacts(eye, ray, curve):
            if t.sign() >= 0 and t.compare(1) <= 0:
                stops.setdefault(int(table.owner[e]), [Real(0), Real(1)]).append(t)
    return not any(
        a.compare(b) != 0 and table.obstacles[k].locate(eye + ray * ((a + b) / 2)) is Location.INSIDE
        for k, values in stops.items()
        for a, b in pairwise(sorted(values))
    )


def samples(curve: Curve, rng: Random) -> Iterator[Point]:
    """Rational points of an edge, its ends first."""
    yield from (curve.start, curve.end)
    if isinstance(curve, Segment):
        yield from (curve.point(Q(rng.randint(1, 19), 20)) for _ in range(3))
        return
    spoke = curve.start - curve.center
    for t in (Q(rng.randint(-300, 300), 100) for _ in range(4)):
        point = curve.center + (spoke * (1 - t * t) + spoke.left() * (2 * t)) / (1 + t * t)
        if curve.contains(point):
            yield point


def holds(curve: Curve, piece: tuple[Point, Point], point: Point) -> bool:
    """Whether a piece of an edge contains a point of that edge."""
    start, end = piece
    if start == end:
        return start == point
    if isinstance(curve, Segment):
        along = curve.direction
        return (point - start).dot(along).sign() >= 0 and (end - point).dot(along).sign() >= 0
    return Arc(start, end, curve.center, curve.radius_sq, curve.ccw).contains(point)


def check(scene: Scene, eye: Point, radius: object, rng: Random) -> None:
    """What a place sees, against brute force in sample points, vertices and the pieces' own ends."""
    table = EdgeTable(scene.obstacles)
    seen = BoundaryView(table, eye, Range(rational(radius))).seen()

    def reported(point: Point, edges: tuple[int, ...]) -> bool:
        return any(
            holds(table.curves[e], piece, point)
            for e in edges
            for piece in seen.get(e, ())
            if table.curves[e].passes(point)
        )

    for e, curve in enumerate(table.curves):
        before, after = int((table.next == e).argmax()), int(table.next[e])
        for piece in seen.get(e, ()):
            assert all(curve.passes(end) and is_seen(table, eye, end, radius) for end in piece)
        for point in samples(curve, rng):
            assert is_seen(table, eye, point, radius) == reported(point, (before, e, after)), (e, point)


def eyes(scene: Scene, rng: Random) -> Iterator[Point]:
    """A free point, a corner, and a point of an edge."""
    while True:
        point = Point(Q(rng.randint(-20, 90), 10), Q(rng.randint(-20, 90), 10))
        if all(o.locate(point) is not Location.INSIDE for o in scene.obstacles):
            break
    edge = rng.choice(rng.choice(scene.obstacles).edges)
    yield from (point, edge.start, rng.choice(list(samples(edge, rng))))


@pytest.mark.parametrize("make", [degenerate_terrain, random_terrain])
@pytest.mark.parametrize("seed", some(range(12), 4))
def test_brute_force_agrees(make: Callable[[Random], object], seed: int) -> None:
    rng = Random(seed)
    scene = make(rng).scene()
    for eye in eyes(scene, rng):
        check(scene, eye, rng.choice(RADII), rng)


@pytest.mark.parametrize("seed", some(range(4), 2))
def test_brute_force_agrees_inside_an_enclosure(seed: int) -> None:
    rng = Random(seed)
    scene = random_terrain(rng, room=True).scene()
    for eye in eyes(scene, rng):
        check(scene, eye, rng.choice(RADII), rng)


@pytest.mark.parametrize("make", [degenerate_terrain, random_terrain])
@pytest.mark.parametrize("seed", some(range(3), 2))
def test_brute_force_agrees_from_algebraic_points(make: Callable[[Random], object], seed: int) -> None:
    """The ends of what one point sees are points to look from: square roots, some of them nested."""
    rng = Random(seed)
    scene = make(rng).scene()
    first = next(eyes(scene, rng))
    pieces = BoundaryView(EdgeTable(scene.obstacles), first, Range(rational(4))).seen().values()
    ends = [end for spans in pieces for piece in spans for end in piece if end.rational is None]
    for eye in rng.sample(ends, min(2, len(ends))):
        check(scene, eye, rng.choice(RADII), rng)


@pytest.mark.parametrize("make", [degenerate_terrain, random_terrain])
@pytest.mark.parametrize("seed", some(range(5), 2))
def test_floats_only_prune(
    make: Callable[[Random], object], seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With margins so wide that floats decide nothing, the same is seen."""
    rng = Random(seed)
    scene = make(rng).scene()
    table = EdgeTable(scene.obstacles)
    for eye in eyes(scene, rng):
        fast = BoundaryView(table, eye, Range(rational(4))).seen()
        with monkeypatch.context() as patch:
            patch.setattr(kernel, "EXACT_ONLY", True)
            slow = BoundaryView(table, eye, Range(rational(4))).seen()
        assert fast.keys() == slow.keys()
        for e, pieces in fast.items():
            assert len(pieces) == len(slow[e])
            for a, b in zip(pieces, slow[e], strict=True):
                assert a[0] == b[0] and a[1] == b[1]


@pytest.mark.parametrize("seed", some(range(6), 2))
def test_a_larger_range_sees_more(seed: int) -> None:
    rng = Random(seed)
    scene = random_terrain(rng).scene()
    table = EdgeTable(scene.obstacles)
    for eye in eyes(scene, rng):
        views = [BoundaryView(table, eye, Range(rational(radius))).seen() for radius in (2, 3, Q(9, 2))]
        for less, more in pairwise(views):
            for e, pieces in less.items():
                ends = (end for piece in pieces for end in piece)
                neighbours = (e, int((table.next == e).argmax()))
                assert all(
                    any(
                        holds(table.curves[k], piece, end)
                        for k in neighbours
                        if table.curves[k].passes(end)
                        for piece in more.get(k, ())
                    )
                    for end in ends
                )


# -- single points and rays ------------------------------------------------------------------------


def test_an_edge_seen_edge_on_and_the_corner_behind_it() -> None:
    """From (0, 1) the tops of two squares lie on one ray, which goes on to the range."""
    view = isovist(Scene([square(1, 0), square(3, 0)]), (0, 1), 10)
    seen = view.seen()
    assert [(p.xy, q.xy) for p, q in seen[0, 2]] == [((2, 1), (1, 1))]
    assert [(p.xy, q.xy) for p, q in seen[1, 2]] == [((4, 1), (3, 1))]
    assert [ray.end.xy for ray in view.rays] == [(10, 1)]


def test_a_range_that_ends_on_an_edge_seen_edge_on() -> None:
    view = isovist(Scene([square(1, 0)]), (0, 1), Q(3, 2))
    assert [(p.xy, q.xy) for p, q in view.seen()[0, 2]] == [((1.5, 1), (1, 1))]


def test_what_a_pinched_ray_strikes_is_one_point() -> None:
    """Between corners on both sides of the ray one inner point of the wall behind is seen, and no more."""
    scene = Scene([square(-1, 1), square(0, 3), square(-5, 6, 10)])
    view = isovist(scene, (0, 0), 20)
    assert [(p.xy, q.xy) for p, q in view.seen()[2, 0]] == [((0, 6), (0, 6)), ((2, 6), (5, 6))]
    assert [ray.end.xy for ray in view.rays] == [(0, 6)]
    assert [(p.xy, q.xy) for p, q in view.seen()[0, 1]] == [((0, 1), (0, 2))]


def test_a_pinched_ray_touches_corners() -> None:
    """The third corner on the ray is an end of nothing that neighbours see: it comes alone."""
    diamond = Polygon([(0, 5), (1, 4), (2, 5), (1, 6)])
    scene = Scene([square(-1, 1), square(0, Q(5, 2)), diamond])
    seen = isovist(scene, (0, 0), 20).seen()
    assert [(p.xy, q.xy) for p, q in seen[2, 0]] == [((0, 5), (0, 5))]
    assert (2, 3) not in seen


@pytest.mark.parametrize("gap", [TINY, Q(1, 10**20)])
def test_a_slit_between_two_squares(gap: Fraction) -> None:
    """Through a slit as narrow as 10^-60 a piece of the wall is seen, three times as wide: the far corners
    of the slit, at height 2, bound it."""
    scene = Scene([square(-1, 1), square(gap, 1), square(-5, 6, 10)])
    ((start, end),) = isovist(scene, (gap / 2, 0), 20).seen()[2, 0]
    assert (start, end) == (Point(-gap, 6), Point(2 * gap, 6))


def test_the_range_reaches_a_corner_exactly() -> None:
    scene = Scene([square(3, 4)])
    assert isovist(scene, (0, 0), 5).seen() == {(0, 0): [(Point(3, 4), Point(3, 4))]}
    assert isovist(scene, (0, 0), 5 - TINY).seen() == {}


def test_the_range_touches_an_edge_and_a_circle() -> None:
    scene = Scene([square(2, -1, 2), Circle((-3, 0), 1)])
    seen = isovist(scene, (0, 0), 2).seen()
    assert {key: [(p.xy, q.xy) for p, q in pieces] for key, pieces in seen.items()} == {
        (0, 3): [((2, 0), (2, 0))],
        (1, 0): [((-2, 0), (-2, 0))],
    }


def test_a_round_room_is_seen_in_two_halves() -> None:
    scene = Scene([], enclosure=Circle((0, 0), 5))
    for eye in ((1, 0), (5, 0), (3, 4)):
        halves = isovist(scene, eye, 20).seen()[0, 0]
        assert len(halves) == 2 and all(p == q for p, q in zip(halves[0], halves[1][::-1], strict=True))


def test_from_a_convex_arc_only_the_point_itself() -> None:
    scene = Scene([Circle((0, 0), 1)])
    assert isovist(scene, (1, 0), 5).seen() == {(0, 0): [(Point(1, 0), Point(1, 0))]}


def test_own_edges_are_seen_along_their_length() -> None:
    scene = Scene([square(0, 0, 4)])
    seen = isovist(scene, (1, 0), 2).seen()
    assert [(p.xy, q.xy) for p, q in seen[0, 0]] == [((0, 0), (3, 0))]
    assert seen.keys() == {(0, 0)}
    corner = isovist(scene, (0, 0), 2)
    assert corner.seen().keys() == {(0, 0), (0, 3)}
    assert sorted(ray.end.xy for ray in corner.rays) == [(0, 2), (2, 0)]


def test_from_the_tip_of_a_crack() -> None:
    """Between two arcs that bulge towards each other from one corner the tangent is the only way out."""
    x, y = Q(24, 25), Q(32, 25)
    crack = Outline([(x, -y, Q(1, 2)), (0, 0, Q(1, 2)), (x, y), (-3, 3), (-3, -3)])
    view = isovist(Scene([crack, square(2, -Q(1, 2))]), (0, 0), 3)
    assert view.pieces == () and view.area.sign() == 0
    assert [ray.end.xy for ray in view.rays] == [(2, 0)]
    assert view.seen() == {
        (0, 1): [(Point(0, 0), Point(0, 0))],
        (1, 3): [(Point(2, 0), Point(2, 0))],
    }
    assert view.contains(Point(2, 0)) and not view.contains(Point(2, TINY))
