"""Which edges a segment or a line crosses: what floats say is checked by exact contacts."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction as Q
from itertools import product
from math import inf
from random import Random

import pytest
from strategies import degenerate_terrain, random_terrain

from exactacq import Circle, Point, Polygon, Scene, kernel
from exactacq.geometry.curve_images import held_point
from exactacq.geometry.curves import Segment
from exactacq.geometry.intersections import ContactKind, contacts, line_contacts
from exactacq.kernel.clearance import crossed, met, met_ahead
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.free_segment import is_free

TINY = Q(1, 10**60)
ROUND = Scene([Circle((0, 0), 2), Circle((6, 1), 1)])
SCENES = [
    Scene([Polygon([(0, 0), (3, 1), (1, 4)]), Polygon([(5, 0), (8, 0), (8, 2), (6, 2)])]),
    ROUND,
]


def places(scene: Scene, rng: Random) -> Iterator[Point]:
    """Corners, places on edges and next to them, on tangents and on a grid."""
    for edge in (edge for obstacle in scene.obstacles for edge in obstacle.edges):
        yield edge.start
        yield edge.start + Point(TINY, -TINY)
        if isinstance(edge, Segment):
            yield edge.start + edge.direction * Q(1, 3)
        else:
            yield edge.start + (edge.start - edge.center).left()
    for _ in range(4):
        yield Point(rng.randint(-4, 9), rng.randint(-4, 9))


def all_scenes() -> Iterator[Scene]:
    yield from SCENES
    for seed in range(6):
        rng = Random(seed)
        yield (degenerate_terrain if seed % 2 else random_terrain)(rng).scene()


@pytest.mark.parametrize("number", range(8))
def test_verdicts_are_those_of_exact_contacts(number: int) -> None:
    scene = list(all_scenes())[number]
    rng = Random(number)
    table = EdgeTable(scene.obstacles)
    edges = list(range(len(table.curves)))
    spots = list(places(scene, rng))
    pairs = [pair for pair in product(spots, spots) if pair[0] != pair[1]]
    sure = beyond = 0
    for a, b in rng.sample(pairs, min(120, len(pairs))):
        sight = Segment(a, b)
        verdicts = crossed(table.images, edges, held_point(a), held_point(b))
        possible = met(table.images, edges, held_point(a), held_point(b - a))
        ahead = met_ahead(table.images, edges, held_point(a), held_point(b - a))
        assert set(ahead) <= set(possible)
        beyond += len(possible) - len(ahead)
        for e, verdict in zip(edges, verdicts, strict=True):
            found = contacts(sight, table.curves[e])
            if verdict < 0:
                assert not found
            elif verdict > 0:
                assert any(one.kind is ContactKind.CROSSING for one in found)
            shares = line_contacts(a, b - a, table.curves[e])
            assert e in possible or not shares
            assert e in ahead or not any(share.sign() >= 0 for share in shares)
            sure += bool(verdict)
    assert sure > 100 and beyond > 0


def test_without_floats_everything_is_open(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    for scene in SCENES:
        table = EdgeTable(scene.obstacles)
        edges = list(range(len(table.curves)))
        a, b = held_point(Point(-9, 1)), held_point(Point(9, 2))
        assert a[2] == inf
        assert set(crossed(table.images, edges, a, b)) == {0}
        assert met(table.images, edges, a, b) == met_ahead(table.images, edges, a, b) == edges
        assert not is_free(table, Point(-9, 1), Point(9, 1))
        assert is_free(table, Point(-9, 9), Point(9, 9))
