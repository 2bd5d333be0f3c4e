"""What the audit knows of sight: whether a point is seen from a curve, against other means."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from random import Random

import pytest
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st
from oracles import Disc, free
from strategies import EPS, box, build
from test_audit import EXAMPLES, Q, terrain_of
from test_laws_of_runs import run_of

from exactacq.auditing import rays, visibility
from exactacq.auditing.places import point_at, point_near
from exactacq.auditing.rays import Direction
from exactacq.auditing.visibility import Viewpoints, World, visible
from exactacq.errors import Undecided
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point


@pytest.fixture(autouse=True, scope="module")
def no_ray_to_what_is_hidden() -> Iterator[None]:
    """Small scenes have few rays: here those to what is hidden are left out of few as well."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(visibility, "MANY_RAYS", 0)
        yield


def rational_points(curve: object, world: World, count: int = 5) -> list[Point]:
    """Rational points of a piece along it, its ends too, as far as it or the edge it lies on is rational."""
    shares = [fmpq(k, count + 1) for k in range(1, count + 1)]
    if isinstance(curve, Segment):
        inner = [curve.point(share) for share in shares]
    else:
        turned = [point_at(e, share) for e in world.edges if isinstance(e, Arc) for share in shares]
        inner = [point for point in turned if point is not None and curve.passes(point)]
    return [point for point in (curve.start, *inner, curve.end) if point.rational is not None]


def clearly_free(shapes: Sequence[object], p: tuple[float, float], q: tuple[float, float]) -> bool:
    """Whether a segment stays free when it is moved aside a little, to either side."""
    size = math.hypot(q[0] - p[0], q[1] - p[1])
    x, y = 1e-6 * (p[1] - q[1]) / size, 1e-6 * (q[0] - p[0]) / size
    moved = [((p[0] + s * x, p[1] + s * y), (q[0] + s * x, q[1] + s * y)) for s in (-1, 1)]
    return all(free(shapes, a, b, 1e-9) for a, b in moved)


class TestLookout:
    """Who sees a point, against point by point tests, and in cases that hang on a single ray."""

    @staticmethod
    def _sees(shapes: list, curve: object, radius: object, q: tuple = (0, 0)) -> bool:
        world = World(build(shapes))
        return Viewpoints(world, fmpq(*Q(radius).as_integer_ratio()), [curve]).first(Point(*q)) is not None

    def test_a_curve_that_comes_within_range_between_its_ends(self) -> None:
        """Neither the rays to its ends nor those of the cells beside them meet it within range."""
        far = box(50, 51, 50, 51)
        way = Segment(Point(-10, Q("3.9")), Point(10000, Q("3.9")))
        assert self._sees([far], way, "3.95")
        assert not self._sees([far], way, "3.899")

    @pytest.mark.parametrize("seed", range(20))
    def test_rays_to_where_segments_pass_the_range(self, seed: int) -> None:
        """Told by balls they are those that exact contacts tell; of tangents balls tell nothing."""
        rng = Random(seed)
        told = 0
        for _ in range(20):
            x, y, *ends = (rng.randrange(-6, 7) for _ in range(6))
            if ends[:2] == ends[2:]:
                continue
            east = Point(x + 3, y)
            circle = Arc(east, east, Point(x, y), fmpq(9), ccw=True, full=True)
            segment = Segment(Point(*ends[:2]), Point(*ends[2:]))
            rays = visibility._clear_crossings(segment, circle)
            places = list(visibility._crossings(segment, circle))
            if rays is None:
                assert len(places) <= 1
                continue
            assert [ray.exact() for ray in rays] == [place - circle.center for place in places]
            for ray in rays:
                (u, v), (a, b) = ray.exact().xy, ray.unit
                assert math.hypot(u / 3 - a, v / 3 - b) < 1e-14 and abs(ray.far - 3) < 1e-14
            told += len(rays)
        assert told > 2

    @EXAMPLES
    @given(st.randoms(use_true_random=False))
    def test_points_and_parts(self, rng: Random) -> None:
        """A curve that has a point which sees q sees q, and a curve sees what its two parts see."""
        terrain = terrain_of(rng)
        run = run_of(terrain)
        if run is None or not run.path:
            return
        world = World(run.scene)
        for _ in range(12):
            curve = rng.choice(run.path).curve
            edge = rng.choice(world.edges)
            q = rng.choice([edge.start, point_at(edge, fmpq(rng.randrange(1, 12), 12))])
            places = rational_points(curve, world)
            if q is None or not places:
                continue
            seen = Viewpoints(world, run.radius, [curve]).first(q) is not None
            views = [visible(world, run.radius, q, place) for place in places]
            for place, view in zip(places, views, strict=True):
                gap = float((place - q).norm_sq()) ** 0.5 - float(run.radius)
                if view:
                    assert free(terrain.shapes, q.xy, place.xy, 1e-6)
                    assert gap < 1e-9
                elif gap < -1e-9 and place != q:
                    assert not clearly_free(terrain.shapes, q.xy, place.xy)
            assert seen or not any(views)
            middle = places[len(places) // 2]
            if middle not in (curve.start, curve.end):
                parts = curve.part(curve.start, middle), curve.part(middle, curve.end)
                assert seen == any(
                    Viewpoints(world, run.radius, [part]).first(q) is not None for part in parts
                )

    @pytest.mark.parametrize(("lift", "expected"), [(0, True), (EPS, False), (-EPS, True)])
    def test_pinch(self, lift: Fraction, expected: bool) -> None:
        """Along y = 0, between an edge above and an edge below, and nowhere else."""
        shapes = [box(2, 3, 0, 1), box(4, 5, -1, lift)]
        assert self._sees(shapes, Segment(Point(7, -1), Point(7, 1)), 10) is expected

    @pytest.mark.parametrize(("more", "expected"), [(0, True), (-EPS, False)])
    def test_range(self, more: Fraction, expected: bool) -> None:
        """The end of a segment, the middle of one, and the nearest point of an arc are at distance 5."""
        east = Point(9, 0)
        curves = (
            Segment(Point(3, 4), Point(3, 5)),
            Segment(Point(5, -1), Point(5, 1)),
            Arc(east, east, Point(7, 0), fmpq(4), ccw=True, full=True),
        )
        for curve in curves:
            assert self._sees([box(20, 21, 0, 1)], curve, 5 + more) is expected

    def test_edge_on(self) -> None:
        """Points of one straight edge see each other, of two edges of a convex corner only the corner."""
        square = [box(0, 2, 0, 2)]
        assert self._sees(square, Segment(Point(1, 0), Point(2, 0)), 2, (0, 0))
        assert not self._sees(square, Segment(Point(1, 0), Point(2, 0)), Q(999, 1000), (0, 0))
        assert not self._sees(square, Segment(Point(2, 1), Point(2, 2)), 5, (0, 0))
        assert self._sees(square, Segment(Point(2, 0), Point(2, 2)), 5, (0, 0))
        assert not self._sees(square, Segment(Point(2, 0), Point(2, 2)), 5, (0, 1))

    def test_across_a_hollow(self) -> None:
        """Two places of a concave arc see each other; of a convex one only a place itself."""
        bay = [[(-2, 0, 0), (-2, -3), (2, -3), (2, 0), (1, 0, -1), (-1, 0)]]
        world = World(build(bay))
        hollow = next(edge for edge in world.edges if isinstance(edge, Arc))
        left = hollow.part(Point(-1, 0), Point(Q(-3, 5), Q(-4, 5))) if not hollow.ccw else None
        if left is None or not left.contains(Point(Q(-4, 5), Q(-3, 5))):
            left = hollow.part(Point(Q(-3, 5), Q(-4, 5)), Point(-1, 0))
        assert self._sees(bay, left, 5, (Q(3, 5), Q(-4, 5)))
        assert not self._sees(bay, left, Q(1), (Q(3, 5), Q(-4, 5)))
        circle = World(build([Disc(0, 0, 1)])).edges[0]
        upper = circle.part(Point(1, 0), Point(-1, 0))
        assert not self._sees([Disc(0, 0, 1)], upper, 5, (Q(3, 5), Q(-4, 5)))
        assert self._sees([Disc(0, 0, 1)], upper, 5, (1, 0))

    def test_between_two_circles(self) -> None:
        """A line that touches two circles from opposite sides is free, and alone."""
        shapes = [Disc(3, 1, 1), Disc(6, -1, 1)]
        assert self._sees(shapes, Segment(Point(9, Q(-1, 10)), Point(9, Q(1, 10))), 20)
        shapes = [Disc(3, 1, 1), Disc(6, -1 + EPS, 1)]
        assert not self._sees(shapes, Segment(Point(9, Q(-1, 10)), Point(9, Q(1, 10))), 20)

    def test_between_two_circles_before_a_wall(self) -> None:
        """The only free line, northward, ends soon after it touches both."""
        tenth = Q(1, 10)
        shapes = [Disc(tenth, Q(29, 5), tenth), Disc(-tenth, 6, tenth), box(-1, 1, Q(32, 5), 7)]
        assert self._sees(shapes, Segment(Point(-tenth, Q(63, 10)), Point(tenth, Q(63, 10))), 20)

    def test_first(self) -> None:
        """Numbers count the curves as given, also if one comes twice."""
        far, near = Segment(Point(3, 9), Point(4, 9)), Segment(Point(1, 0), Point(2, 0))
        lookout = Viewpoints(World(build([box(20, 21, 0, 1)])), fmpq(5), [far, far, near, near])
        assert lookout.first(Point(0, 0)) == 2
        assert lookout.first(Point(30, 0)) is None

    @EXAMPLES
    @given(st.randoms(use_true_random=False))
    def test_any_of_some(self, rng: Random) -> None:
        """Several curves asked together are answered as each of them alone, also one that comes twice."""
        run = run_of(terrain_of(rng))
        if run is None or not run.path:
            return
        world = World(run.scene)
        curves = [rng.choice(world.edges) for _ in range(6)] + [piece.curve for piece in run.path[:4]]
        lookout = Viewpoints(world, run.radius, curves)
        some = [rng.sample(range(len(curves)), rng.randint(0, 3)) for _ in range(4)]
        q = rng.choice(world.edges).start
        alone = [Viewpoints(world, run.radius, [curve]).first(q) is not None for curve in curves]
        assert lookout.any_sees(q, some) == [any(alone[k] for k in numbers) for numbers in some]
        assert lookout.any_sees(q, []) == []

    def test_targets(self) -> None:
        """Rational points at shares of edges and beside points of them."""
        circle = World(build([Disc(0, 0, 1)])).edges[0]
        quarter = point_at(circle, fmpq(1, 4))
        assert quarter is not None
        assert quarter.rational is not None
        assert circle.passes(quarter)
        assert max(abs(quarter.xy[0]), abs(quarter.xy[1] - 1)) < 1e-12
        beside = point_near(circle, Point(1, 0), fmpq(1, 1000))
        assert beside is not None
        assert abs(beside.xy[1] - 1e-3) < 1e-8
        bottom = Segment(Point(0, 0), Point(4, 0))
        assert point_near(bottom, Point(4, 0), fmpq(1, 1000)) is None
        assert point_near(bottom, Point(4, 0), fmpq(-1, 1000)) == Point(Q(3999, 1000), 0)


@pytest.mark.parametrize("count", [2, 3, 4])
@pytest.mark.parametrize("seed", range(4))
def test_rays_whose_order_is_undecided_are_all_looked_along(
    monkeypatch: pytest.MonkeyPatch, count: int, seed: int
) -> None:
    """In whatever order they come, there is a ray in each cell between two of them.

    A comparison of critical rays of one audit took nested roots beyond the library's limits.
    """

    def undecided(a: Direction, b: Direction) -> int:
        raise Undecided("planted")

    monkeypatch.setattr(rays, "_compare", undecided)
    vectors = [Point(1, fmpq(k, 1 << 60)) for k in range(count)]
    shuffled = Random(seed).sample(vectors, count)
    found = [ray.exact() for ray in rays.with_cells([rays.ray_along(vector) for vector in shuffled])]
    for low, high in pairwise(vectors):
        assert low in found and high in found
        assert any(low.cross(ray).sign() > 0 and ray.cross(high).sign() > 0 for ray in found)
    assert any(ray.x.sign() < 0 for ray in found)  # and one in the rest of the turn
