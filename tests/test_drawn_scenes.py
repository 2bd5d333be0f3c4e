"""The strategy of scenes itself: what it draws is legal and what its names promise, and it shrinks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import combinations

import pytest
from drawn_scenes import KINDS, scenes, steps, terrains
from drawn_scenes import placing as p
from drawn_scenes.kinds import VARIANTS, Kind, a_disc
from drawn_scenes.plane import box, edges, lines, minus, rounds, square, vertices
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from nightly import NIGHTLY, by_night, some
from oracles import Disc, Room
from strategies import ONE, ZERO, Pair, Terrain, build

import exactacq as xa
from exactacq.scene.terrain_components import ground_of
from exactacq.study.claims.model import Subject

Q = Fraction
SUBJECTS = pytest.mark.parametrize("subject", list(Subject), ids=lambda subject: subject.value)
PLAIN = p.Step(p.beside, KINDS[0], 1, 1, 0, 0, 0, 0, 0, ONE, 0, ZERO, 0)
"""The step that all others shrink to: a unit square."""
DRAWN = 60 if NIGHTLY else 24
"""Scenes that are drawn to be counted."""


# -- what is drawn ---------------------------------------------------------------------------------


@SUBJECTS
def test_nothing_is_rejected(subject: Subject) -> None:
    drawn: list[xa.Scene] = []

    @settings(
        max_examples=DRAWN, database=None, phases=[Phase.generate], suppress_health_check=list(HealthCheck)
    )
    @given(scenes(subject))
    def draw(scene: xa.Scene) -> None:
        if scene.terrain is not None:
            ground_of(scene)
        drawn.append(scene)

    draw()
    assert len(drawn) == DRAWN
    assert sum(len(scene.obstacles) > 1 for scene in drawn) > DRAWN // 3
    assert len({len(scene.obstacles) for scene in drawn}) > 2


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_kinds_are_legal(kind: Kind) -> None:
    """All variants, in the corners of what sizes are drawn."""
    for width, height in some(((1, 1), (4, 1), (1, 3), (4, 3)), 1):
        for variant in range(VARIANTS):
            group = kind(width, height, variant)
            scene = build(group.shapes)
            assert len(scene.obstacles) == len(group.shapes) > 0


@given(steps(KINDS), steps(KINDS))
def test_boxes_hold_their_shapes(one: p.Step, other: p.Step) -> None:
    for shape in placed(one, other).shapes:
        left, bottom, right, top = box([shape])
        (obstacle,) = build([shape]).obstacles
        for edge in obstacle.edges:
            for share in (Q(0), Q(1, 5), Q(1, 2), Q(6, 7)):
                x, y = edge.point(share)
                assert xa.Real(left) <= x <= xa.Real(right)
                assert xa.Real(bottom) <= y <= xa.Real(top)


# -- relations -------------------------------------------------------------------------------------


def placed(*steps: p.Step) -> p.Ground:
    ground = p.Ground()
    for step in steps:
        ground.place(step)
    return ground


def related(relation: p.Relation, **parts: object) -> st.SearchStrategy[p.Ground]:
    """One obstacle, and one that is placed by it in this relation; nothing is cut or a hair off."""
    plain = steps(KINDS).map(lambda step: replace(step, hair=ZERO, cuts=0))
    second = plain.map(lambda step: replace(step, relation=relation, **parts))
    return st.tuples(plain, second).map(lambda both: placed(*both)).filter(lambda g: len(g.groups) == 2)


@given(related(p.mirrored))
def test_from_a_place_on_the_axis_both_are_equally_far(ground: p.Ground) -> None:
    assert far(ground.groups[0], axis := ground.groups[1].places[-1]) == far(ground.groups[1], axis)


@given(related(p.turned_about))
def test_from_the_centre_of_a_turn_both_are_equally_far(ground: p.Ground) -> None:
    assert far(ground.groups[0], center := ground.groups[1].places[-1]) == far(ground.groups[1], center)


def far(group: object, place: Pair) -> list[Fraction]:
    """Squares of the distances of all vertices and centres."""
    points = [q for shape in group.shapes if not isinstance(shape, Disc) for q in vertices(shape)]
    points += [circle.center for shape in group.shapes for circle in rounds(shape)]
    return sorted(square(minus(q, place)) for q in points)


@given(related(p.on_one_line))
def test_some_lines_are_one(ground: p.Ground) -> None:
    assert any(
        cross(minus(b.point, a.point), a.along) == cross(a.along, b.along) == 0
        for a, b in pairs(ground, lines)
    )


@given(related(p.on_one_circle, kind=a_disc))
def test_some_circles_are_about_one_centre(ground: p.Ground) -> None:
    if all(rounds(shape) for shape in ground.groups[0].shapes):
        assert any(a.center == b.center for a, b in pairs(ground, rounds))


def cross(a: Pair, b: Pair) -> Fraction:
    return a[0] * b[1] - a[1] * b[0]


def pairs(ground: p.Ground, features: Callable[[object], list]) -> list[tuple]:
    """Features of the first obstacle, each with one of the second."""
    first, second = ([f for shape in group.shapes for f in features(shape)] for group in ground.groups)
    return [(a, b) for a in first for b in second]


def test_a_step_without_room_is_left_out() -> None:
    squares = placed(*[PLAIN] * 4)
    assert [box([shape])[:2] for shape in squares.shapes] == [(0, 0), (2, 0), (4, 0), (6, 0)]


# -- shrinking -------------------------------------------------------------------------------------


def least(strategy: st.SearchStrategy, condition: Callable[[Terrain], bool]) -> Terrain:
    """What hypothesis shrinks to."""
    found: list[Terrain] = []

    @settings(max_examples=300, database=None, phases=[Phase.generate, Phase.shrink], print_blob=False)
    @given(strategy)
    def search(terrain: Terrain) -> None:
        if condition(terrain):
            found.append(terrain)
            raise ValueError

    with pytest.raises(ValueError):
        search()
    return found[-1]


SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


def test_the_plainest_scenes() -> None:
    assert least(terrains(), bool) == Terrain((SQUARE,), (Q(-1, 2), Q(-1, 2)), Q(5))
    swept = least(terrains(Subject.SEED_SPREADER), bool)
    assert swept == Terrain((SQUARE,), None, Q(5), (Q(-1), Q(-1), Q(2), Q(2)))


def test_few_obstacles_and_plain_ones() -> None:
    several = least(terrains(), lambda terrain: len(terrain.shapes) > 2)
    assert several.shapes == tuple([(x + k, y) for x, y in SQUARE] for k in (0, 2, 4))


@by_night
def test_what_matters_stays() -> None:
    """A room about some obstacles of which two have their middles on no upright or level line."""

    def is_askew(terrain: Terrain) -> bool:
        boxes = [box([shape]) for shape in terrain.shapes if not isinstance(shape, Room)]
        middles = [(b.left + b.right, b.bottom + b.top) for b in boxes]
        return len(boxes) < len(terrain.shapes) and any(
            a[0] != b[0] and a[1] != b[1] for a, b in combinations(middles, 2)
        )

    found = least(terrains(), is_askew)
    *squares, room = found.shapes
    assert isinstance(room, Room)
    assert len(squares) <= 3
    assert found.radius == 5
    assert all(len(list(edges(shape))) <= 4 for shape in squares)
