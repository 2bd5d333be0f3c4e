"""The oracle of knowledge against closed forms, and against the other float oracles."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache
from itertools import pairwise
from random import Random

import numpy as np
import pytest
from map_oracle import (
    Answer,
    Track,
    acquire_length,
    first_seen,
    in_sight,
    known,
    known_parts,
    sight_length,
    spots,
    view,
)
from nightly import some
from oracles import free
from stepping import Stepper
from strategies import POLYGONS, degenerate_terrain, random_terrain

from exactacq import Circle, Outline, Point, Polygon, Run, Scene, sightseer
from exactacq.geometry.curves import Segment

Q = Fraction
SQUARE = Scene([Polygon([(2, -1), (4, -1), (4, 1), (2, 1)])])
DISC = Scene([Circle((3, 0), 1)])
WALLS = Scene([Polygon([(1, -1), (2, -1), (2, 1), (1, 1)]), Polygon([(4, -3), (5, -3), (5, 3), (4, 3)])])
"""A low wall before a high one."""
NICHE = Scene([Outline([(0, -2), (4, -2), (4, 2), (0, 2), (0, 1, -1), (0, -1)])])
"""A block with a round niche of radius 1 in its left side, the edge 4."""
UP = [Segment(Point(0, 0), Point(0, 6))]


def walk(*corners: tuple[object, object]) -> list[Segment]:
    return [Segment(Point(*a), Point(*b)) for a, b in pairwise(corners)]


def about(bounds: tuple[float, float], value: float, slack: float = 1e-3) -> bool:
    """Whether the bounds hold the value and are close to it."""
    low, high = bounds
    return value - slack <= low <= value + 1e-9 and value - 1e-9 <= high <= value + slack


# -- closed forms ----------------------------------------------------------------------------------


def test_of_a_square_the_front_and_then_the_top_are_seen() -> None:
    shares = [Q(1, 9), Q(1, 2), Q(8, 9)]
    answers = known(SQUARE, 10, UP, spots(SQUARE, shares)).reshape(4, 3)
    assert answers.tolist() == [[Answer.NO] * 3, [Answer.NO] * 3, [Answer.YES] * 3, [Answer.YES] * 3]
    assert about(first_seen(SQUARE, 10, UP, (3, 1)), 1)
    assert first_seen(SQUARE, 10, UP, (2, 0))[1] == pytest.approx(0, abs=1e-4)
    assert first_seen(SQUARE, 10, UP, (4, 0)) == (math.inf, math.inf)


def test_what_is_out_of_range_is_not_known() -> None:
    towards = walk((-2, 0), (2, 0))
    assert about(sight_length(SQUARE, Q(5, 2), towards, 0), 1.5)
    along = walk((0, 3), (6, 3))
    assert sight_length(SQUARE, Q(199, 100), along, 0) == (math.inf, math.inf)
    assert sight_length(SQUARE, 2, along, 0)[1] == math.inf, "R equal to the gap is not for floats to decide"
    assert sight_length(SQUARE, 2, along, 0)[0] < 2
    assert in_sight(SQUARE, 2, (0, 0), 0) is Answer.CLOSE
    assert in_sight(SQUARE, Q(21, 10), (0, 0), 0) is Answer.YES
    assert in_sight(SQUARE, Q(19, 10), (0, 0), 0) is Answer.NO


@pytest.mark.parametrize("degrees", [100, 110, 135, 150])
def test_a_point_of_a_disc_is_seen_from_above_its_tangent(degrees: int) -> None:
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    height = max(0.0, (1 + 3 * cosine) / sine)
    assert about(first_seen(DISC, 10, UP, (Q(3 + cosine), Q(sine))), height, slack=5e-3)


def test_the_known_part_of_a_disc_lies_between_two_tangents() -> None:
    half = math.acos(1 / 3) / math.tau
    assert known_parts(DISC, 10, [(0, 0)], 0, 0) == [pytest.approx((0.5 - half, 0.5 + half), abs=1e-4)]
    assert known_parts(DISC, 10, walk((0, 0), (0, 1)), 0, 0)[0][0] == pytest.approx(0.25, abs=1e-4)


@pytest.mark.parametrize("height", [0, Q(1, 2), -1, 2, Q(-5, 2)])
def test_a_low_wall_hides_a_high_one(height: Fraction) -> None:
    """From (0, y) both upper corners of the low wall must be under the line to (4, height)."""
    y = max((4 - height) / 3, 2 - height, 0)
    assert about(first_seen(WALLS, 10, UP, (4, height)), float(y))


def test_sight_and_known_part_of_the_high_wall() -> None:
    assert about(sight_length(WALLS, 10, UP, 1), 1 / 3)
    assert sight_length(WALLS, 10, UP, 0)[1] == pytest.approx(0, abs=0.2)
    assert known_parts(WALLS, 10, walk((0, 0), (0, 2)), 1, 3) == [pytest.approx((0, 0.5), abs=1e-4)]
    assert in_sight(WALLS, 10, (0, 0), 1) is Answer.NO
    assert in_sight(WALLS, 10, (0, 1), 1) is Answer.YES


def test_a_loop_around_an_obstacle_acquires_it() -> None:
    """Corners, tangents and own edges on the way: each sample is passed, on a straight edge seen before."""
    for scene in (SQUARE, DISC, NICHE):
        run = sightseer(scene, radius=10, start=(-1, 0))
        samples = spots(scene, [Q(k, 7) for k in range(1, 7)])
        assert (known(scene, 10, run.path, samples) == Answer.YES).all()
        assert acquire_length(scene, 10, run.path, samples[:6]) <= float(run.length)


def test_on_a_disc_a_point_behind_is_known_when_it_is_reached() -> None:
    run = sightseer(DISC, radius=10, start=(0, 0))
    assert about(first_seen(DISC, 10, run.path, (4, 0)), 2 + math.pi, slack=5e-3)


def test_a_niche_is_seen_as_far_as_its_rim_allows() -> None:
    """From (-1, y) past the rim's upper corner: the chord's other end on the circle."""
    place = (-1, Q(1, 2))
    low, high = known_parts(NICHE, 10, [place], 0, 4)[0]
    # The lines to both corners enter the block behind them, so all of the half circle is seen.
    assert low == pytest.approx(0, abs=1e-4) and high == pytest.approx(1, abs=1e-4)
    place = (-1, 3)
    low, high = known_parts(NICHE, 10, [place], 0, 4)[0]
    # From (0, 1) along (1, -2) the chord ends at (4/5, -3/5); below it the left side is seen.
    turned = (math.pi / 2 - math.atan2(-3, 4)) / math.pi
    assert (low, high) == pytest.approx((turned, 1), abs=1e-4)


# -- views -----------------------------------------------------------------------------------------


def parts(scene: Scene, radius: object, place: tuple[object, object]) -> dict[tuple[int, int], list[float]]:
    found: dict[tuple[int, int], list[float]] = {}
    for part in view(scene, radius, place):
        found.setdefault((part.obstacle, part.edge), []).extend((part.low, part.high))
    return found


def test_views_in_closed_form() -> None:
    assert parts(SQUARE, 10, (0, 0)) == {(0, 3): pytest.approx([0, 1])}
    assert parts(SQUARE, Q(41, 20), (0, 0)) == {(0, 3): pytest.approx([0.275, 0.725])}
    half = math.acos(1 / 3) / math.tau
    assert parts(DISC, 10, (0, 0)) == {(0, 0): pytest.approx([0.5 - half, 0.5 + half])}
    cosine = (9 + 1 - 6.25) / 6
    assert parts(DISC, Q(5, 2), (0, 0)) == {
        (0, 0): pytest.approx([0.5 - math.acos(cosine) / math.tau, 0.5 + math.acos(cosine) / math.tau])
    }
    assert parts(WALLS, 10, (0, 2)) == {
        (0, 2): pytest.approx([0, 1]),
        (0, 3): pytest.approx([0, 1]),
        (1, 3): pytest.approx([0, 0.5]),
    }
    assert parts(WALLS, 10, (1, 0)) == {}
    turned = (math.pi / 2 - math.atan2(-3, 4)) / math.pi
    assert parts(NICHE, 10, (-1, 3))[0, 4] == pytest.approx([turned, 1], abs=1e-6)
    room = Scene([], enclosure=Circle((0, 0), 5))
    assert parts(room, 20, (1, 0)) == {(0, 0): pytest.approx([0, 1])}


@pytest.mark.parametrize("seed", some(range(6), 2))
def test_views_agree_with_what_a_path_of_one_point_knows(seed: int) -> None:
    """Rays from the place against the search from the target's side."""
    terrain = random_terrain(Random(seed), room=seed % 2 == 1)
    scene, radius = terrain.scene(), float(terrain.radius)
    samples = spots(scene, [Q(k, 12) for k in range(1, 12, 2)])
    answers = known(scene, radius, [terrain.start], samples)
    seen = parts(scene, radius, terrain.start)
    lines = {o.index: Track(o.edges) for o in scene.obstacles}
    for spot, answer in zip(samples, answers, strict=True):
        share = lines[spot.obstacle].fraction(spot.edge, np.array(spot.xy))
        ends = seen.get((spot.obstacle, spot.edge), [])
        depth = max(
            (min(share - a, b - share) for a, b in zip(ends[::2], ends[1::2], strict=True)), default=-1
        )
        assert depth > -1e-6 if answer == Answer.YES else answer == Answer.CLOSE or depth < 1e-6, spot
    assert (answers != Answer.CLOSE).mean() > 0.95


# -- other oracles ---------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", some(range(6), 2))
def test_answers_agree_with_free_segments(seed: int) -> None:
    """A YES has a witness on the path, a NO has none among many of its points."""
    rng = Random(seed)
    terrain = degenerate_terrain(rng) if seed % 2 else random_terrain(rng)
    scene, radius, shapes = terrain.scene(), float(terrain.radius), terrain.shapes
    stops = [tuple(Q(rng.randint(-97, 97), 97) + c for c in terrain.start) for _ in range(3)]
    path = walk(terrain.start, *stops)
    track = Track(path)
    samples = rng.sample(spots(scene, [Q(1, 5), Q(1, 2), Q(7, 9)]), 24)
    for spot, answer in zip(samples, known(scene, radius, path, samples), strict=True):
        low, high = first_seen(scene, radius, path, spot.point)
        assert (high < math.inf, low < math.inf) == (answer == Answer.YES, answer != Answer.NO)
        if answer == Answer.YES:
            place = track.place(high)
            assert math.dist(place, spot.xy) <= radius + 1e-9 and free(shapes, place, spot.xy)
        before = np.linspace(0, min(low, track.before[-1]) - 1e-6, 40) if low > 1e-6 else []
        for place in map(track.place, before):
            assert math.dist(place, spot.xy) > radius or not free(shapes, place, spot.xy, tol=1e-10)


@cache
def explored() -> tuple[Run, list[tuple[float, float]]]:
    """A run among polygons, and bounds of the lengths at which the obstacles are first seen."""
    terrain = random_terrain(Random(3), POLYGONS, columns=2)
    run = sightseer(terrain.scene(), radius=terrain.radius)
    return run, [sight_length(run.scene, run.radius, run.path, o.index) for o in run.scene.obstacles]


@pytest.mark.parametrize("look", some(["lazy", "polygon", "cgal"], 1))
def test_steps_learn_almost_what_is_known(look: str) -> None:
    """The stepping simulator sees every obstacle, at most a step late, and in the end all of it."""
    if look == "cgal":
        pytest.importorskip("peers", reason="needs pyvispoly, an optional test dependency")
    run, sights = explored()
    found = Stepper(run.scene, run.radius, look).walk(piece.curve for piece in run.path)
    steps = {event.obstacle: event.at for event in found.events if event.kind == "sight"}
    for obstacle, (low, high) in enumerate(sights):
        assert low - 1e-6 <= steps[obstacle] <= high + float(run.radius) / 100 + 1e-6
    assert found.known_lengths == pytest.approx([float(o.perimeter) for o in run.scene.obstacles], rel=1e-6)
