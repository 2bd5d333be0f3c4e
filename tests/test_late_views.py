"""Ends of what is seen are late: not made before they are read, and then what exact arithmetic gives."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator
from fractions import Fraction
from random import Random
from weakref import ref

import pytest
from flint import arb, fmpq
from strategies import degenerate_terrain, random_terrain

from exactacq import Circle, Point, Polygon, Real, Scene, isovist
from exactacq.files import gallery
from exactacq.files.octagons import random_octagons
from exactacq.geometry import late
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.interval_union import Interval
from exactacq.geometry.late import late_point
from exactacq.geometry.points import Location
from exactacq.numbers.rationals import rational
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing import end_names
from exactacq.sensing.end_names import Seen
from exactacq.study.random_scenes import Subject, arc_scene
from exactacq.visibility import front_faces, radial_sweep, range_clip
from exactacq.visibility.sensor_range import Range

Q = Fraction
ROOT = Real(2).sqrt() / 7


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[Point]:
    """The late points that are made while a test runs."""
    found: list[Point] = []
    plain = late._Once._made

    def counted(once: late._Once) -> Point:
        unmade = once._make is not None
        point = plain(once)
        found.extend([point] * unmade)
        return point

    monkeypatch.setattr(late._Once, "_made", counted)
    return found


# -- late points -----------------------------------------------------------------------------------


def test_all_numbers_of_a_late_point_share_one_maker(made: list[Point]) -> None:
    """The parameter on a rail is late too, compares by its ball, and makes the point once."""
    rail = Rail(Segment((0, 0), (3, 4)))
    point = late_point((arb(1.5, 1e-9), arb(2, 1e-9)), lambda: Point(Q(3, 2), 2))
    u = rail.parameter(point)
    assert u.is_late and 0 < u < 1 and point.x > 1 and point != Point(1, 2) and not made
    assert u == fmpq(1, 2) and not point.y.is_late and len(made) == 1
    assert point == Point(Q(3, 2), 2) and len(made) == 1


@pytest.mark.parametrize(("x", "y"), [(0, 1), (1, 0), (-1, 3)])
def test_parameters_on_a_segment_shorter_than_any_float(x: int, y: int) -> None:
    """Upright ones were measured by their width, which is 0: a division by it was the end of a sweep."""
    tiny = Q(1, 10**400)
    rail = Rail(Segment((0, 0), (x * tiny, y * tiny)))
    assert rail.parameter(Point(x * tiny / 3, y * tiny / 3)) == Q(1, 3)


@pytest.mark.parametrize("ccw", [True, False])
def test_parameters_on_an_arc(ccw: bool) -> None:
    """In every quarter turn, and next to its ends, where balls do not tell."""
    arc = Arc(Point(5, 0), Point(5, 0), Point(0, 0), fmpq(25), ccw=ccw, full=True)
    rail = Rail(arc)
    for x, y in ((3, 4), (-3, 4), (-4, -3), (4, -3), (0, 5), (-5, 0), (0, -5)):
        ball = arb(x, 1e-12), arb(y, 1e-12)
        u = rail.parameter(late_point(ball, lambda x=x, y=y: Point(x, y)))  # type: ignore[misc]
        assert u.is_late == (x != 0 and y != 0)
        assert u == rail.parameter(Point(x, y))


def test_the_parameter_of_an_irrational_place_on_an_arc_is_late() -> None:
    """It is what exact arithmetic makes of it: the tangent of half the angle beyond the quarter turn."""
    root = Real(3).sqrt()
    for ccw in (True, False):
        rail = Rail(Arc(Point(2, 0), Point(2, 0), Point(0, 0), fmpq(4), ccw=ccw, full=True))
        for x, y, turn in ((1, root, 0), (-1, root, 1), (-1, -root, 2), (1, -root, 3)):
            u = rail.parameter(Point(x, y if ccw else -y))
            assert u.is_late and turn < u < turn + 1
            assert u == turn + (1 / root if turn % 2 == 0 else 2 - root)


def test_copies_are_made() -> None:
    """A late point, its parameter and a rail that was asked for it survive a copy."""
    rail = Rail(Segment((0, 0), (3, 4)))
    point = late_point((arb(1.5, 1e-9), arb(2, 1e-9)), lambda: Point(Q(3, 2), 2))
    again, u, its = pickle.loads(pickle.dumps((point, rail.parameter(point), rail)))
    assert again == point and u == fmpq(1, 2) == its.parameter(again)


def test_a_point_without_finite_balls_is_made_at_once() -> None:
    assert not late_point((arb(1) / arb(0), arb(0)), lambda: Point(1, 2)).x.is_late


# -- nothing is made that nobody reads ----------------------------------------------------------------


def free_places(scene: Scene, count: int, shift: object = 0) -> Iterator[Point]:
    """Places among the obstacles, for which the round-off of floats decides nothing."""
    rng = Random(count)
    while count:
        point = Point(Q(rng.randint(0, 3000), 97) + shift, Q(rng.randint(0, 3000), 97) + 2 * shift)
        if all(obstacle.locate(point) is Location.OUTSIDE for obstacle in scene.obstacles):
            count -= 1
            yield point


@pytest.mark.parametrize("shift", [0, ROOT])
def test_ends_that_are_not_read_are_not_made(made: list[Point], shift: object) -> None:
    scene = random_octagons(100, seed=1)
    table, range_ = EdgeTable(scene.obstacles), Range(fmpq(10))
    rails = [Rail(curve) for curve in table.curves]
    lates = 0
    for place in free_places(scene, 12, shift):
        assert isovist(scene, place, 10).pieces and isovist(scene, place, 10).seen()
        seen = Seen(table, rails, place, range_, ())
        assert any(seen.held(e) for e in seen.spans)
        for e, intervals in seen.spans.items():
            assert all(0 <= i.low <= i.high <= rails[e].top for i in intervals)
            lates += sum(u.is_late for i in intervals for u in (i.low, i.high))
        assert not made
        for intervals in seen.spans.values():
            assert all(i.low * 1 <= i.high * 1 for i in intervals)
        assert made
        made.clear()
    assert lates > 60


def test_an_end_keeps_little_alive() -> None:
    """Unread ends live as long as the map: they hold neither the view nor its sweep."""
    scene = random_octagons(20, seed=1)
    table = EdgeTable(scene.obstacles)
    rails = [Rail(curve) for curve in table.curves]
    seen = Seen(table, rails, next(free_places(scene, 1)), Range(fmpq(10)), ())
    spans = dict(seen.spans)
    assert any(i.low.is_late for some in spans.values() for i in some)
    parts = [ref(part) for part in (seen._view, seen._view.sweep, seen._view.sweep.faces)]
    del seen
    assert not any(part() for part in parts)


# -- what is made is right ---------------------------------------------------------------------------


def without_balls(patch: pytest.MonkeyPatch) -> None:
    """Let balls decide nothing and make every point at once."""
    for module in (radial_sweep, front_faces, range_clip):
        patch.setattr(module, "late_point", lambda around, make, *given: make(*given))
    for module in (late, front_faces, range_clip, end_names):
        patch.setattr(module, "ball_sign", lambda ball: 0)


def looks(scene: Scene, place: Point, radius: object) -> tuple[object, ...]:
    """All that a view tells, read."""
    view = isovist(scene, place, radius)
    pieces = [(p.kind, p.obstacle, p.edge, p.near, p.curve) for p in view.pieces]
    table = EdgeTable(scene.obstacles)
    seen = Seen(table, [Rail(c) for c in table.curves], place, Range(rational(radius)), None)
    held = {hold: [p.x, p.y, u] for e in seen.spans for hold, (p, u) in seen.held(e).items()}
    return pieces, list(view.rays), view.seen(), dict(seen.spans), held


def check(scene: Scene, place: Point, radius: object, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same view with balls and without, and every late end within its ball."""
    some = looks(scene, place, radius)
    with monkeypatch.context() as patch:
        without_balls(patch)
        assert some == looks(scene, place, radius)
    for parts in isovist(scene, place, radius).seen().values():
        for number in (number for part in parts for end in part for number in end):
            ball = number.ball(64)
            assert ball.overlaps((number + 0).ball(256))


def around(scene: Scene, rng: Random) -> Iterator[Point]:
    """Free places, corners, places on edges and on their lines, algebraic ones."""
    edges = [edge for obstacle in scene.obstacles for edge in obstacle.edges]
    places = [Point(rng.randint(-2, 9), rng.randint(-2, 9)) for _ in range(3)]
    for edge in rng.sample(edges, min(3, len(edges))):
        places.append(edge.start)
        if isinstance(edge, Segment):
            places += [edge.start + edge.direction * t for t in (Q(1, 3), Q(-1, 2), Q(3, 2))]
        else:
            places += [edge.center, edge.start + (edge.start - edge.center).left()]
    places += [Point(place.x + ROOT, place.y - ROOT * 3) for place in places[:2]]
    for place in places:
        if all(obstacle.locate(place) is not Location.INSIDE for obstacle in scene.obstacles):
            yield place


@pytest.mark.parametrize("make", [degenerate_terrain, random_terrain])
@pytest.mark.parametrize("seed", range(4))
def test_balls_change_nothing(
    make: Callable[[Random], object], seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = Random(seed)
    scene = make(rng).scene()
    for place in around(scene, rng):
        check(scene, place, rng.choice((1, 2, 3, Q(7, 2), 9)), monkeypatch)


@pytest.mark.parametrize("seed", range(4))
def test_balls_change_nothing_among_arcs(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = Random(seed)
    scene = arc_scene(Subject.SIGHTSEER, seed)
    for place in around(scene, rng):
        check(scene, place, rng.choice((1, 2, 4)), monkeypatch)


@pytest.mark.parametrize("name", ["circles", "m11", "case1"])
def test_balls_change_nothing_in_the_gallery(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = gallery.scene(name)
    for place in around(scene, Random(1)):
        check(scene, place, scene.radius or 5, monkeypatch)


TOUCHED = Scene([Polygon([(1, -1), (2, -1), (2, 1), (1, 1)]), Circle((0, 5), 2), Circle((-4, 0), 1)])
"""From the origin the range 1 touches an edge, 3 and 7 a circle from outside and inside, 3 and 5 another."""


@pytest.mark.parametrize("radius", [1, 3, 5, 7, 1 + Q(1, 10**60), 1 - Q(1, 10**60), 3 - Q(1, 10**60)])
@pytest.mark.parametrize("place", [(0, 0), (1, 0), (1, 1), (0, -1), (1, -2), (-4, 1), (0, 3), (2, 1)])
def test_a_range_that_touches(
    place: tuple[int, int], radius: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    check(TOUCHED, Point(*place), radius, monkeypatch)


def test_whole_edges_are_whole_intervals() -> None:
    """Without a comparison; a full circle passes its start and is divided there."""
    rail = Rail(Segment((0, 0), (1, 0)))
    (whole,) = Interval.between(rail, rail.curve.start, rail.curve.end)
    assert (whole.low, whole.high) == (0, 1)
    circle = Circle((0, 0), 1)
    (edge,) = Scene([circle]).obstacles[0].edges
    parts = Interval.between(Rail(edge), Point(Q(3, 5), Q(-4, 5)), Point(Q(3, 5), Q(4, 5)))
    assert [(str(i.start), str(i.end)) for i in parts] == [
        ("(3/5, -4/5)", "(1, 0)"),
        ("(1, 0)", "(3/5, 4/5)"),
    ]
