"""Laws of runs among arcs as drawings have them: the same scene drawn otherwise, moved or mirrored.

Continues `test_laws` on circles in several arcs, arcs of one circle or about one centre, smooth joints and
cusps. Here the map and the events are compared too, for a wrong map can leave order and length as they were.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from random import Random

import pytest
from flint import fmpq
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from nightly import NIGHTLY, examples
from oracles import Disc, Room
from strategies import Similarity, Terrain, arc_terrain, build, reversed_order
from test_laws import is_valid, refined, weights

import exactacq as xa
from exactacq.errors import Undecided
from exactacq.numbers.length import Length
from exactacq.strategies.run import Run
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import arc_scene

Q = Fraction
EXAMPLES = examples(4, 120)
DIGITS = 25

terrains = st.randoms(use_true_random=False).map(arc_terrain).filter(is_valid)
rngs = st.randoms(use_true_random=False)


def run_of(terrain: Terrain) -> Run:
    return xa.sightseer(terrain.scene(), terrain.radius).sense()


def same(one: Length, other: Length) -> bool:
    """Equal; where sums of several involved angles are Undecided, to many digits."""
    try:
        return one == other
    except Undecided:
        return one.decimal(DIGITS) == other.decimal(DIGITS)


def place_on(run: Run, rng: Random) -> Length:
    """A place of a path, by its length; by day on a straight way, for on arcs nearly equal ones take long."""
    if NIGHTLY:
        return Length(Q(rng.randint(0, int(float(run.length) * 97)), 97))
    ways = [k for k, piece in enumerate(run.path) if piece.kind == "straight"]
    if not ways:
        return Length(0)
    k = rng.choice(ways)
    return run.path.length_after(k) + run.path[k].length * Q(rng.randint(0, 97), 97)


def law_of_drawing(terrain: Terrain, other: Terrain, rng: Random) -> None:
    """Two drawings of one scene: the same order, length, map and events; and the same map on the way."""
    one, two = run_of(terrain), run_of(other)
    assert one.visits == two.visits
    assert same(one.length, two.length)
    count = len(one.scene.obstacles)
    for k in range(count):
        assert same(one.map.known_length(k), two.map.known_length(k))
    assert (one.map.acquired, one.map.incomplete) == (two.map.acquired, two.map.incomplete)
    for a, b in zip(one.events, two.events, strict=True):
        assert (a.kind, a.obstacle, a.note) == (b.kind, b.obstacle, b.note)
        assert same(a.at, b.at)
    place = place_on(one, rng)
    early, late = (run.map_at(place) for run in (one, two))
    for k in range(count):
        assert early.known_length(k).decimal(DIGITS) == late.known_length(k).decimal(DIGITS)


def has_ties(terrain: Terrain) -> bool:
    """Whether some link is realised by several segments, or two links are equally long."""
    edges = list(xa.visibility_graph(terrain.scene(), terrain.radius).edges(data=True))
    lengths = [data["weight"] for _, _, data in edges]
    equal = any(same(a, b) for a, b in combinations(lengths, 2))
    return equal or any(len(list(data["link"].segments())) > 1 for _, _, data in edges)


def law_of_moving(terrain: Terrain, move: Similarity) -> None:
    """The image of a scene: the same order, the image's length, as much known of every obstacle.

    Ties between hit points are broken by their coordinates, so an image may be walked otherwise.
    """
    one, two = run_of(terrain), run_of(move.terrain(terrain))
    if one.visits != two.visits or not same(one.length * move.scale, two.length):
        assert has_ties(terrain)
        return
    for k in range(len(one.scene.obstacles)):
        assert same(one.map.known_length(k) * move.scale, two.map.known_length(k))
    if move.mirror:
        return  # A mirror image is circled the other way: other events come on the way.
    for a, b in zip(one.events, two.events, strict=True):
        assert (a.kind, a.obstacle, a.note) == (b.kind, b.obstacle, b.note)
        assert same(a.at * move.scale, b.at)


def law_of_numbering(terrain: Terrain, rng: Random) -> None:
    """Another order of the obstacles: the same links, and but for ties the same run."""
    inner = [k for k, shape in enumerate(terrain.shapes) if not isinstance(shape, Room)]
    order = rng.sample(inner, len(inner)) + list(range(len(inner), len(terrain.shapes)))
    after = weights(replace(terrain, shapes=tuple(terrain.shapes[k] for k in order)))
    name = dict(enumerate(order)) | {"S": "S"}
    named = {frozenset(name[k] for k in key): value for key, value in after.items()}
    before = weights(terrain)
    assert before.keys() == named.keys()
    assert all(same(before[key], named[key]) for key in before)
    one, two = run_of(terrain), run_of(replace(terrain, shapes=tuple(terrain.shapes[k] for k in order)))
    if tuple(order[k] for k in two.visits) != one.visits or not same(one.length, two.length):
        assert has_ties(terrain)
        return
    # Events of one place come by number: so each obstacle's are compared.
    for k, number in [(None, None), *enumerate(order)]:
        first, second = ([e for e in r.events if e.obstacle == i] for r, i in ((one, number), (two, k)))
        for a, b in zip(first, second, strict=True):
            assert a.kind == b.kind
            assert same(a.at, b.at)
    for k, number in enumerate(order):
        assert same(one.map.known_length(number), two.map.known_length(k))


@EXAMPLES
@given(terrains, rngs)
def test_edges_cut_and_circles_drawn_as_arcs(terrain: Terrain, rng: Random) -> None:
    law_of_drawing(terrain, refined(terrain, rng), rng)


@EXAMPLES
@given(st.integers(0, 10**6), rngs)
def test_sweeps_of_edges_cut(seed: int, rng: Random) -> None:
    """The Seed Spreader's run among cut edges and circles drawn as arcs: the same events, length and map.

    The first vertices stay: the components of an obstacle that a border cuts are numbered from there.
    """
    scene = arc_scene(Subject.SEED_SPREADER, seed)
    shapes = tuple(plain(shape) for shape in scene.shapes)
    cut = build(refined(Terrain(shapes, None, Q(1)), rng, rotate=False).shapes).shapes
    other = xa.Scene(cut, scene.start, terrain=scene.terrain)
    try:
        one, two = (xa.seed_spreader(s, scene.radius) for s in (scene, other))
    except Undecided:
        assume(False)
    assert same(one.length, two.length)
    assert same(one.map.known_length(), two.map.known_length())
    for a, b in zip(one.events, two.events, strict=True):
        assert (a.kind, a.obstacle, a.note) == (b.kind, b.obstacle, b.note)
        assert same(a.at, b.at)


def plain(shape: xa.Circle | xa.Outline) -> object:
    """A shape as `oracles` takes it."""
    if isinstance(shape, xa.Circle):
        return Disc(*(fraction(c) for c in (*shape.center, shape.radius)))
    return [tuple(fraction(c) for c in vertex) for vertex in shape.vertices]


def fraction(value: fmpq) -> Fraction:
    return Q(int(value.p), int(value.q))


@EXAMPLES
@given(terrains, rngs)
def test_loops_the_other_way_round(terrain: Terrain, rng: Random) -> None:
    law_of_drawing(terrain, reversed_order(terrain), rng)


@pytest.mark.parametrize(
    "move",
    [
        Similarity(shift=(Q(22, 7), Q(-355, 113))),
        Similarity(turn=(Q(3, 5), Q(4, 5))),
        Similarity(mirror=True),
        Similarity(scale=Q(1, 10**30)),
        Similarity(scale=Q(10**30)),
    ],
    ids=["shifted", "turned", "mirrored", "tiny", "huge"],
)
@pytest.mark.filterwarnings("error")
@settings(EXAMPLES, max_examples=EXAMPLES.max_examples // 2)
@given(terrains)
def test_images(move: Similarity, terrain: Terrain) -> None:
    law_of_moving(terrain, move)


@settings(EXAMPLES, max_examples=EXAMPLES.max_examples // 2)
@given(terrains, rngs)
def test_another_order_of_obstacles(terrain: Terrain, rng: Random) -> None:
    law_of_numbering(terrain, rng)
