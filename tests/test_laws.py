"""Laws that hold exactly, on degenerate scenes: shared lines, tangencies, cusps, concentric arcs.

Every law is a plain function of a `Terrain`: a seed or a hand-made scene can be put to it as well. Two checks
share no code with the library: whether a reported segment is free, and the least length between polygons, by
all candidates in 70 digits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from random import Random

import networkx as nx
import pytest
from brute_links import FINE, Loops, brute_force, mp
from drawn_scenes import STRAIGHT, terrains
from drawn_scenes.kinds import a_box, a_diamond, a_hook, a_triangle, on_pins
from hypothesis import given, settings
from hypothesis import strategies as st
from nightly import examples, some
from oracles import Disc, Room
from strategies import EPS, Similarity, Terrain, box, reversed_order, split_point

import exactacq as xa
from exactacq.errors import InvalidScene
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length

Q = Fraction
EXAMPLES = examples(3, 150)


# -- the same scene drawn otherwise -----------------------------------------------------------------


def is_valid(terrain: Terrain) -> bool:
    """Whether the scene is accepted and its start free."""
    try:
        scene = terrain.scene()
    except InvalidScene:
        return False
    return bool(scene.obstacles)


def refined(terrain: Terrain, rng: Random, rotate: bool = True) -> Terrain:
    """Some edges cut in two, circles cut into arcs, loops started elsewhere if *rotate*."""

    def refine(shape: object) -> object:
        if isinstance(shape, Room):
            return Room(refine(shape.vertices))
        if isinstance(shape, Disc):
            if rng.random() < 0.4:
                return shape
            x, y, r = (Q(c) for c in shape)
            halves = [[(x + r, y, 1), (x - r, y, 1)], [(x, y - r, 1), (x, y + r, 1)]]
            shape = rng.choice(halves) if rotate else halves[0]
        loop: list[tuple] = []
        for k, (x, y, *b) in enumerate(shape):
            after = shape[(k + 1) % len(shape)]
            bulge = Q(b[0]) if b else Q(0)
            if rng.random() < 0.5:
                middle, first, last = split_point((x, y), after, bulge, rng.choice([Q(1, 2), Q(1, 3)]))
                loop += [(x, y, first), (*middle, last)]
            else:
                loop.append((x, y, bulge))
        k = rng.randrange(len(loop)) if rotate else 0
        return loop[k:] + loop[:k]

    return replace(terrain, shapes=tuple(refine(shape) for shape in terrain.shapes))


# -- the laws --------------------------------------------------------------------------------------


def graph_of(terrain: Terrain) -> nx.Graph:
    return xa.visibility_graph(terrain.scene(), terrain.radius)


def weights(terrain: Terrain) -> dict[frozenset, Length]:
    return {frozenset(edge[:2]): edge[2] for edge in graph_of(terrain).edges(data="weight")}


def differences(before: dict[frozenset, Length], after: dict[frozenset, Length]) -> list[str]:
    """What differs between two graphs, in words."""
    return [
        f"{set(key)}: {before.get(key)} became {after.get(key)}"
        for key in before.keys() | after.keys()
        if key not in before or key not in after or before[key] != after[key]
    ]


def tour(terrain: Terrain) -> tuple[tuple[int, ...], Length] | None:
    if terrain.start is None:
        return None
    try:
        run = xa.sightseer(terrain.scene(), terrain.radius).sense()
    except InvalidScene:
        return None
    return run.visits, run.length


def law_of_description(terrain: Terrain, rng: Random, runs: bool = True) -> None:
    """Cut edges, another first vertex, the other sense: the same graph and the same run."""
    before = weights(terrain)
    known = tour(terrain) if runs else None
    for other in (refined(terrain, rng), reversed_order(terrain), reversed_order(refined(terrain, rng))):
        found = differences(before, weights(other))
        assert not found, (found, other)
        if runs:
            assert tour(other) == known, other


MOVES = (
    Similarity(shift=(Q(22, 7), Q(-355, 113))),
    Similarity(turn=(Q(3, 5), Q(4, 5))),
    Similarity(mirror=True),
    Similarity(scale=Q(7, 3)),
    Similarity(turn=(Q(-5, 13), Q(12, 13)), scale=Q(1, 10**12), shift=(Q(10**9), Q(1, 3)), mirror=True),
)


def law_of_similarity(terrain: Terrain) -> None:
    before = weights(terrain)
    for move in some(reversed(MOVES), 3):
        after = weights(move.terrain(terrain))
        found = differences({key: value * move.scale for key, value in before.items()}, after)
        assert not found, (found, move)


def law_of_numbering(terrain: Terrain, rng: Random) -> None:
    inner = [k for k, shape in enumerate(terrain.shapes) if not isinstance(shape, Room)]
    order = rng.sample(inner, len(inner)) + list(range(len(inner), len(terrain.shapes)))
    after = weights(replace(terrain, shapes=tuple(terrain.shapes[k] for k in order)))
    name = dict(enumerate(order)) | {"S": "S"}
    named = {frozenset(name[k] for k in key): value for key, value in after.items()}
    assert not differences(weights(terrain), named), order


def law_of_removal(terrain: Terrain) -> None:
    """An obstacle only blocks: without it every other v is the same or less."""
    before = weights(terrain)
    count = len(terrain.shapes)
    for gone in range(count):
        kept = [k for k in range(count) if k != gone]
        after = weights(replace(terrain, shapes=tuple(terrain.shapes[k] for k in kept)))
        name = dict(enumerate(kept)) | {"S": "S"}
        named = {frozenset(name[k] for k in key): value for key, value in after.items()}
        for key, value in before.items():
            if gone not in key:
                assert key in named, (gone, set(key))
                assert named[key] <= value, (gone, set(key))


def law_of_distance(terrain: Terrain) -> None:
    """What lies out of reach changes nothing."""
    if any(isinstance(shape, Room) for shape in terrain.shapes):
        return
    count = len(terrain.shapes)
    far = (box(1000, 1001, 0, 2), Disc(-1000, 0, 3), box(-(10**9), 10**9, -2000, -1000))
    after = weights(replace(terrain, shapes=(*terrain.shapes, *far)))
    inner = {key: v for key, v in after.items() if all(k == "S" or k < count for k in key)}
    assert not differences(weights(terrain), inner)


def law_of_growth(terrain: Terrain) -> None:
    """v does not depend on R; an edge is there if and only if v <= R."""
    whole = weights(replace(terrain, radius=Q(40)))
    for radius in (terrain.radius, *sorted({_rational(v) for v in whole.values()} - {None, 0})[:3]):
        within = {key: v for key, v in whole.items() if v <= Length(radius)}
        assert not differences(within, weights(replace(terrain, radius=radius))), radius
    values = {r for v in whole.values() if (r := _rational(v))}
    for value in sorted(values)[:2]:
        within = {key: v for key, v in whole.items() if v < Length(value)}
        assert not differences(within, weights(replace(terrain, radius=value - EPS))), value


def _rational(value: Length) -> Fraction | None:
    exact = value.algebraic.rational
    return None if exact is None else Q(int(exact.p), int(exact.q))


# -- an independent clearance test -----------------------------------------------------------------


def precise(point: Point) -> tuple[object, object]:
    """A point in 70 digits."""
    return tuple(mp.mpf(c.decimal(60)) for c in point)  # type: ignore[return-value]


def law_of_clearance(terrain: Terrain) -> None:
    """Every reported segment joins its boundaries, is free and as long as it says."""
    loops = Loops(terrain.shapes)
    for i, j, data in graph_of(terrain).edges(data=True):
        link = data["link"]
        assert {link.source, link.target} == {i, j}
        for leave, hit in link.segments():
            p, q = precise(leave), precise(hit)
            assert abs(mp.hypot(p[0] - q[0], p[1] - q[1]) - mp.mpf(data["weight"].decimal(60))) < FINE
            assert loops.gap(link.target, *q) < FINE
            if link.source != "S":
                assert loops.gap(link.source, *p) < FINE
            assert loops.is_free(p, q), (i, j, str(leave), str(hit))


# -- an independent v between polygons -------------------------------------------------------------


def law_of_brute_force(terrain: Terrain) -> None:
    found = weights(terrain)
    shapes = terrain.shapes
    for i, j in combinations(range(len(shapes)), 2):
        expected = brute_force(shapes, i, j, terrain.radius)
        value = found.get(frozenset((i, j)))
        assert (value is None) == (expected is None), (i, j, value, expected)
        if value is not None:
            assert abs(mp.mpf(value.decimal(50)) - expected) < mp.mpf(10) ** -25, (i, j, str(value), expected)


# -- under hypothesis, and by hand -----------------------------------------------------------------

rngs = st.randoms(use_true_random=False)
POLYGONS = (a_box, a_triangle, a_diamond, a_hook, on_pins)
"""Of few corners: their candidates are many as it is."""
Law = Callable[[Terrain], None]


class TestGraph:
    @pytest.mark.parametrize(
        "law",
        [law_of_similarity, law_of_removal, law_of_distance, law_of_growth, law_of_clearance],
        ids=lambda law: law.__name__.removeprefix("law_of_"),
    )
    @EXAMPLES
    @given(terrains(moved=False))
    def test_law(self, law: Law, terrain: Terrain) -> None:
        law(terrain)

    @EXAMPLES
    @given(terrains(moved=False), rngs)
    def test_numbering(self, terrain: Terrain, rng: Random) -> None:
        law_of_numbering(terrain, rng)

    @EXAMPLES
    @given(terrains(moved=False), rngs)
    def test_description(self, terrain: Terrain, rng: Random) -> None:
        law_of_description(terrain, rng, runs=False)

    @settings(EXAMPLES, max_examples=EXAMPLES.max_examples // 2)
    @given(terrains(kinds=POLYGONS, rooms=False, moved=False))
    def test_all_candidates(self, terrain: Terrain) -> None:
        law_of_brute_force(replace(terrain, shapes=terrain.shapes[:3]))


class TestRuns:
    @EXAMPLES
    @given(terrains(kinds=STRAIGHT, moved=False), rngs)
    def test_description(self, terrain: Terrain, rng: Random) -> None:
        law_of_description(terrain, rng)


class TestByHand:
    def test_a_hidden_arc_beyond_reach(self) -> None:
        """The rays from S would meet the outer arc from inside; the arcs in front of it are out of reach."""
        spikes = [(0, Q(-3, 2), -1), (0, Q(5, 2), 1), (0, Q(1, 2), 1)]
        terrain = Terrain((spikes,), (Q(4), Q(1)), Q(3))
        for move in (Similarity(), *MOVES):
            assert not weights(move.terrain(terrain)), move

    def test_common_tangents_half_a_turn_away(self) -> None:
        """Two arcs whose other common tangent has an infinite parameter."""
        shapes = ([(-2, 0, 1), (2, 0)], [(7, 1, 1), (3, 1)], [(10, Q(3, 2)), (11, Q(5, 2)), (11, Q(3, 2))])
        law_of_similarity(Terrain(shapes, None, Q(4)))

    def test_a_half_disc_before_a_disc(self) -> None:
        shapes = (Disc(11, 0, 1), Disc(5, 5, 1), [(10, 7, -1), (10, 3, 1), (10, 5, 1)])
        law_of_distance(Terrain(shapes, None, Q(4)))

    def test_a_start_on_an_arc_looks_through_its_own_obstacle(self) -> None:
        """Rays into the blocked side graze the hollow arc, whose tangents bound no cell."""
        crescent = [(3, Q(3, 2), -1), (7, Q(3, 2)), (Q(13, 2), Q(3, 2), 1)]
        found = weights(Terrain((crescent, box(20, 21, 0, 1)), (Q(139, 25), Q(171, 50)), Q(10)))
        assert found == {frozenset({"S", 0}): Length(0)}

    def test_a_difference_of_ten_to_the_minus_120(self) -> None:
        """Far below the filter's bits, far above what a height bound excludes: decided all the same."""
        shapes = (
            [(2, EPS, -1), (Q(3, 2), EPS)],
            Disc(0, EPS, Q(1, 2)),
            [(Q(19, 5), Q(-9, 10), -2), (Q(31, 5), Q(-9, 10))],
        )
        law_of_clearance(Terrain(shapes, None, Q(20)))

    def test_what_is_seen_from_a_piece_with_irrational_ends(self) -> None:
        shapes = (
            [(Q(-7, 10), Q(8, 5), -2), (Q(-7, 10), Q(-8, 5)), (Q(-2, 5), Q(-6, 5), 2), (Q(-2, 5), Q(6, 5))],
            [(0, Q(-1, 2)), (0, Q(1, 2)), (1, Q(1, 2))],
            Room([(25, 0, 1), (-25, 0, 1)]),
        )
        found = tour(Terrain(shapes, (Q(0), Q(0)), Q(6)))
        assert found is not None
        assert sorted(found[0]) == [0, 1]

    def test_a_chord_that_ends_on_an_arc_is_tested_without_its_root(self) -> None:
        ring = [
            (Q(58, 5), Q(63, 10), 2),
            (Q(42, 5), Q(63, 10)),
            (Q(44, 5), Q(33, 5), -2),
            (Q(56, 5), Q(33, 5)),
        ]
        shapes = (ring, Disc(10, Q(15, 2), Q(1, 2)), Room([(25, 0, 1), (-25, 0, 1)]))
        found = tour(Terrain(shapes, (Q(13), Q(0)), Q(10)))
        assert found is not None
        assert sorted(found[0]) == [0, 1]
