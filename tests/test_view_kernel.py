"""Views by floats are those of exact arithmetic alone, part by part, also where data are degenerate."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import degenerate_terrain, random_terrain

from exactacq import Point, Real, Scene, isovist, kernel
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Location
from exactacq.numbers.rationals import rational
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.end_names import Seen
from exactacq.study.random_scenes import Subject, arc_scene
from exactacq.visibility.sensor_range import Range

Q = Fraction
TINY = Q(1, 10**60)
ROOT = Real(2).sqrt() / 7


def looks(scene: Scene, place: Point, radius: object) -> list[object]:
    """All that a view tells."""
    view = isovist(scene, place, radius)
    pieces = [(p.kind, p.obstacle, p.edge, p.near, p.curve) for p in view.pieces]
    table = EdgeTable(scene.obstacles)
    seen = Seen(table, [Rail(c) for c in table.curves], place, Range(rational(radius)), None)
    held = {hold: [point.x, point.y, u] for hold, (point, u) in seen._held.items()}
    return [pieces, list(view.rays), view.seen(), seen.spans, held]


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
@given(seed=st.integers(0, 10**6))
@settings(max_examples=12, deadline=None)
def test_terrains(make: Callable[[Random], Scene], seed: int) -> None:
    rng = Random(seed)
    scene = make(rng)
    for place in places(scene, rng):
        compare(scene, place, rng.choice((1, 2, 3, Q(7, 2), 9)))
