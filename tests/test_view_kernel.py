"""Views by floats are those of exact arithmetic alone, part by part, also where data are degenerate."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from itertools import pairwise
from math import atan2, inf, pi
from random import Random

import pytest
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st
from nightly import NIGHTLY, examples
from strategies import degenerate_terrain, random_terrain

from exactacq import Circle, Outline, Point, Polygon, Real, Scene, isovist, kernel
from exactacq.files.octagons import random_octagons
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Segment
from exactacq.geometry.interval_union import Cover
from exactacq.geometry.points import Location
from exactacq.kernel.radial_faces import RadialFaces
from exactacq.kernel.radial_sweep import FaceSweep
from exactacq.numbers.rationals import rational
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.end_names import Seen
from exactacq.sensing.family_filter import KnownSpans
from exactacq.study.random_scenes import Subject, arc_scene
from exactacq.visibility.sensor_range import Range
from exactacq.visibility.visible_boundary import BoundaryView

Q = Fraction
TINY = Q(1, 10**60)
ROOT = Real(2).sqrt() / 7


def looks(scene: Scene, place: Point, radius: object) -> list[object]:
    """All that a view tells."""
    view = isovist(scene, place, radius)
    pieces = [(p.kind, p.obstacle, p.edge, p.near, p.curve) for p in view.pieces]
    table = EdgeTable(scene.obstacles)
    seen = Seen(table, [Rail(c) for c in table.curves], place, Range(rational(radius)), None)
    held = {hold: [p.x, p.y, u] for e in seen.spans for hold, (p, u) in seen.held(e).items()}
    return [pieces, list(view.rays), view.seen(), dict(seen.spans), held]


def compare(scene: Scene, place: Point, radius: object) -> None:
    usual = looks(scene, place, radius)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kernel, "EXACT_ONLY", True)
        exact = looks(scene, place, radius)
    for some, other in zip(usual, exact, strict=True):
        assert some == other, (place, radius)


def places(scene: Scene, rng: Random) -> Iterator[Point]:
    """Corners, places on edges and on their lines, tangents and smooth joints, algebraic places, a grid's."""
    edges = [edge for obstacle in scene.obstacles for edge in obstacle.edges]
    found = [Point(rng.randint(-2, 9), rng.randint(-2, 9)) for _ in range(3)]
    for edge in rng.sample(edges, min(3, len(edges))):
        found.append(edge.start)
        if isinstance(edge, Segment):
            found += [edge.start + edge.direction * t for t in (Q(1, 3), Q(-1, 2), Q(3, 2), Q(1, 3) + TINY)]
        else:
            spoke = edge.start - edge.center
            found += [edge.center, edge.start + spoke.left(), edge.center + spoke * 2]
            found += [p for p in (edge.center - spoke, edge.center + spoke.left()) if edge.contains(p)]
    found += [Point(place.x + ROOT, place.y - ROOT * 3) for place in found[:2]]
    found += [Point(place.x + TINY, place.y) for place in found[:2]]
    for place in found:
        if all(obstacle.locate(place) is not Location.INSIDE for obstacle in scene.obstacles):
            yield place


MAKERS = [
    lambda rng: degenerate_terrain(rng).scene(),
    lambda rng: random_terrain(rng).scene(),
    lambda rng: random_terrain(rng, room=True).scene(),
    lambda rng: arc_scene(Subject.SIGHTSEER, rng.randint(0, 10**6)),
]


@pytest.mark.parametrize("make", MAKERS, ids=["degenerate", "random", "room", "arcs"])
@examples(5, 100)
@given(seed=st.integers(0, 10**6))
def test_terrains(make: Callable[[Random], Scene], seed: int) -> None:
    rng = Random(seed)
    scene = make(rng)
    for place in places(scene, rng):
        compare(scene, place, rng.choice((1, 2, 3, Q(7, 2), 9)))


def squares(*corners: tuple[object, object]) -> Scene:
    return Scene([Polygon([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]) for x, y in corners])


SPECIAL = {
    "a grid": (squares(*((2 * x, 2 * y) for x in range(4) for y in range(4))), (1, 2, 3, Q(5, 2))),
    "slits": (squares((1, 0), (1, 1 + TINY), (3, Q(1, 2)), (-2, -1), (-2, TINY)), (1, 2, 5, 2 + TINY)),
    "collinear vertices": (
        Scene([Polygon([(1, 1), (2, 1), (3, 1), (3, 2), (1, 2)]), Polygon([(1, -1), (3, -1), (2, 0)])]),
        (1, 2, 3),
    ),
    "smooth joints": (
        Scene(
            [Outline([(0, 0, 1), (0, 2, 0), (-4, 2, 1), (-4, 0, 0)]), Circle((3, 1), 1), Circle((7, 1), 1)]
        ),
        (1, 2, 4),
    ),
    "a hollow": (
        Scene([Outline([(-3, 0, 0), (-2, 0, -1), (2, 0, 0), (3, 0, 1)]), Circle((0, 1), Q(1, 2))]),
        (1, 2, 4),
    ),
    "arcs of one circle": (
        Scene(
            [
                Outline([(5, 0, Q(1, 3)), (3, 4, 0), (1, 1, 0)]),
                Outline([(-5, 0, Q(1, 3)), (-3, -4, 0), (-1, -1, 0)]),
            ]
        ),
        (3, 5, 4),
    ),
}


@pytest.mark.parametrize("name", SPECIAL)
def test_special_scenes(name: str) -> None:
    """From corners, middles of edges, lines of edges, centres, and places that two lines of edges share."""
    scene, radii = SPECIAL[name]
    rng = Random(1)
    for _ in range(2 if NIGHTLY else 1):
        for place in places(scene, rng):
            for radius in radii:
                compare(scene, place, radius)


def test_a_distance_that_is_the_range() -> None:
    """Vertices, edges and circles exactly as far away as the range, or by 10^-60 nearer or farther."""
    scene = Scene(
        [Polygon([(3, 4), (5, 4), (5, 6)]), Circle((0, -7), 2), Polygon([(-6, -1), (-5, -1), (-5, 1)])]
    )
    for radius in (5, 5 - TINY, 5 + TINY, 7, 9):
        for place in (Point(0, 0), Point(TINY, 0), Point(0, -2), Point(5, 4), Point(-5, 0)):
            compare(scene, place, radius)


# -- what is left out ------------------------------------------------------------------------------


def seen_beyond(seen: Seen, known: Mapping) -> dict:
    return seen.beyond(known, seen.edges)


@examples(16, 200)
@given(seed=st.integers(0, 10**6))
def test_beyond_what_is_known(seed: int) -> None:
    """Added to what is known, what is told to lie beyond it makes the same as all that is seen."""
    rng = Random(seed)
    scene = rng.choice(MAKERS)(rng)
    table = EdgeTable(scene.obstacles)
    rails = [Rail(curve) for curve in table.curves]
    range_ = Range(fmpq(rng.choice((2, 4, 9))))
    covers: dict[int, Cover] = {}
    for place in places(scene, rng):
        known = KnownSpans(covers, rails)
        some = seen_beyond(Seen(table, rails, place, range_, None), known)
        every = Seen(table, rails, place, range_, None).spans
        assert set(some) <= set(every)
        for e in every:
            for interval in some.get(e, ()):
                assert any(i.low == interval.low and i.high == interval.high for i in every[e])
            grown = [covers.get(e, Cover()), covers.get(e, Cover())]
            for k, intervals in enumerate((some.get(e, ()), every[e])):
                for interval in intervals:
                    grown[k] = grown[k].added(interval)
            assert len(grown[0].intervals) == len(grown[1].intervals)
            for a, b in zip(grown[0].intervals, grown[1].intervals, strict=True):
                assert a.low == b.low and a.high == b.high
            covers[e] = grown[1]
        assert not any(seen_beyond(Seen(table, rails, place, range_, None), Everything()).values())


class Everything(dict[int, list[tuple[float, float]]]):
    """All edges, whole."""

    def get(self, e: int, default: object = None) -> list[tuple[float, float]]:  # type: ignore[override]
        return [(-inf, inf)]


def test_what_is_known_is_not_made() -> None:
    scene = random_octagons(60, 1)
    table = EdgeTable(scene.obstacles)
    rails = [Rail(curve) for curve in table.curves]
    seen = Seen(table, rails, Point(Q(1, 7), Q(1, 9)), Range(fmpq(10)), None)
    assert seen_beyond(seen, Everything()) == {} and not seen._view.ends._points


# -- bounds ----------------------------------------------------------------------------------------


@examples(24, 400)
@given(seed=st.integers(0, 10**6))
def test_bounds_hold(seed: int) -> None:
    """Offsets, tangents, ways to faces and brackets of ends hold the exact values."""
    rng = Random(seed)
    scene = rng.choice(MAKERS)(rng)
    for place in places(scene, rng):
        table = EdgeTable(scene.obstacles)
        view = BoundaryView(table, place, Range(fmpq(rng.choice((2, 4, 9)))))
        faces = view.sweep.faces.floats
        for event in faces.events:
            x, y, b = event.x, event.y, event.bound
            u, v = (float(c) for c in view.sweep.faces.offset(event.number))
            if event.number < len(table.vertices):
                assert abs(u - x) <= b + 1e-15 * abs(u) and abs(v - y) <= b + 1e-15 * abs(v)
            size = abs(u) + abs(v)
            assert abs(u * y - v * x) <= size * b * 2 + 1e-14 * size * (abs(x) + abs(y))
        for e, parts in view.seen_parts.items():
            rail = Rail(table.curves[e])
            for part in () if rail.is_closed else parts:
                low, high = view.bracket(e, part)
                start, end = (rail.parameter(point) for point in view.ends.span(part))
                assert abs(low) == inf or start >= fmpq(*low.as_integer_ratio()), (e, part)
                assert abs(high) == inf or end <= fmpq(*high.as_integer_ratio()), (e, part)
                low, high = view.surely(e, part)
                if low <= high:
                    first, last = (_plain(bound, rail) for bound in (low, high))
                    assert start <= first <= last <= end, (e, part)


def _plain(bound: float, rail: Rail) -> Real:
    """A parameter that is given in extended numbers."""
    return Real(0) if bound == -inf else rail.top if bound == inf else Real(bound)


@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), max_size=60))
def test_directions_stand_in_the_order_of_their_angles(vectors: list[tuple[int, int]]) -> None:
    """Each vector once, counterclockwise from the east, and equal directions in one place."""
    faces = RadialFaces([], (0.0, 0.0, 0.0, 0.0, 0.0), (1.0, 0.0))
    vectors = [vector for vector in vectors if any(vector)]
    for number, (x, y) in enumerate(vectors):
        faces.add_event(number, float(x), float(y), 1e-15)
    sweep = FaceSweep(faces)
    for event in sweep.look_up():
        sweep.put(event, vectors[event.number][1] >= 0)
    sweep.order()
    opened = {at: [event.number for event in events] for at, events in sweep.open}
    groups = [opened.get(at, [lead.number]) for at, lead in enumerate(sweep.leads)]
    assert sorted(number for group in groups for number in group) == list(range(len(vectors)))
    angles = [{atan2(*vectors[number][::-1]) % (2 * pi) for number in group} for group in groups]
    assert all(max(group) - min(group) < 1e-12 for group in angles)
    assert all(max(one) < min(other) for one, other in pairwise(angles))
