"""Laws of whole runs, and of graphs far from the origin, tiny, or with the symmetry of a square.

Continues `test_laws` on what rooms, crescents, irrational pieces and large coordinates bring in.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from random import Random

import numpy as np
import pytest
from drawn_scenes import CURVED, terrains
from drawn_scenes.kinds import PINNED, ROUND
from hypothesis import given
from hypothesis import strategies as st
from nightly import examples
from oracles import Disc, Room, free, world
from strategies import Similarity, Terrain, box, circle_grid, square_grid
from test_laws import (
    EXAMPLES,
    differences,
    law_of_description,
    weights,
)

import exactacq as xa
from exactacq.errors import InvalidScene
from exactacq.numbers.length import Length
from exactacq.strategies.run import Run

Q = Fraction
TWO_EDGES = (
    [(-2, 0, 1), (2, 0, Q(-1, 2))],  # crescents: spikes at both tips
    [(-2, 0, Q(1, 3)), (2, 0, Q(-1, 4))],
    [(-1, 0, 2), (1, 0, -1)],
    [(-2, 0, Q(1, 2)), (2, 0, Q(1, 2))],  # lenses
    [(0, -2, 1), (0, 2, Q(1, 3))],
    [(-1, 0, 1), (1, 0, 1)],  # a circle
)
WALLS = (
    box(0, 20, 0, 14),
    [(20, 7, 1), (0, 7, 1)],
    [(0, 0), (8, 0), (9, 5), (10, 0), (20, 0), (20, 14), (12, 14), (12, 10), (6, 14), (0, 14)],  # spikes
    [(0, 0), (6, 0, -1), (12, 0), (20, 0), (20, 4, 1), (20, 10), (20, 14), (0, 14)],  # a dent and a bay
)
CELLS = (*ROUND, *TWO_EDGES)
AFAR = (
    Similarity(shift=(Q(10**9 + 7), Q(3 - 10**9))),
    Similarity(shift=(10**12 + Q(1, 3), -(10**12) - Q(2, 7))),
    Similarity(scale=Q(1, 10**9)),
    Similarity(scale=Q(1, 10**9), shift=(Q(1, 3), Q(5))),
)


def run_of(terrain: Terrain) -> Run | None:
    """The Sightseer's run, or None where the start is not free."""
    try:
        return None if terrain.start is None else xa.sightseer(terrain.scene(), terrain.radius).sense()
    except InvalidScene:
        return None


def crowded_room(rng: Random) -> Terrain:
    """A few shapes in a room, some 1/1000 off its wall; the start perhaps on the wall."""
    wall = rng.choice(WALLS)
    kept: list[object] = []
    for _ in range(rng.randint(1, 4)):
        scale = rng.choice([Q(1), Q(1, 2), Q(1, 3)])
        anywhere = (Q(rng.randint(4, 40), 2), Q(rng.randint(4, 26), 2))
        hugging = (Q(rng.randint(2, 18)), 2 * scale + Q(1, rng.choice([1, 1000])))
        place = Similarity(shift=rng.choice([anywhere, hugging]), scale=scale, mirror=rng.random() < 0.5)
        shape = place.shape(rng.choice([*CELLS, *PINNED]))
        try:
            Terrain((*kept, shape, Room(wall)), None, Q(1)).scene()
        except InvalidScene:
            continue
        kept.append(shape)
    x, y = rng.choice([rng.choice(wall)[:2], (rng.randint(1, 19), rng.randint(1, 13))])
    return Terrain((*kept, Room(wall)), (Q(x), Q(y)), Q(rng.choice([1, 2, 4, 8, 20])))


MOVES = {"start", "hit", "leave", "backtrack", "stop"}
"""Events of the strategy; the others are reports of the sensor."""


def law_of_the_path(terrain: Terrain) -> None:
    """The path is one line; a loop is the whole perimeter; every other walk is the shorter way."""
    run = run_of(terrain)
    if run is None:
        return
    here = run.start
    for piece in run.path:
        assert piece.start == here
        assert piece.length > Length(0)
        here = piece.end
        if piece.kind == "straight":
            assert free(terrain.shapes, piece.start.xy, piece.end.xy, 1e-6)
    moves = [event for event in run.events if event.kind in MOVES]
    for before, after in pairwise(moves):
        walked = run.path[before.after : after.after]
        if before.kind == "leave" or before.obstacle is None:
            assert all(piece.kind == "straight" for piece in walked)
            assert len(walked) <= 1
            continue
        assert all(piece.obstacle == before.obstacle for piece in walked)
        perimeter = run.scene.obstacles[before.obstacle].perimeter
        rest = Length.sum(piece.length for piece in walked)
        if before.kind == "hit":
            rest = rest - perimeter
        assert rest >= Length(0)
        assert rest * 2 <= perimeter
    assert run.length == Length.sum(piece.length for piece in run.path)


def law_of_afar(terrain: Terrain) -> None:
    """Far from the origin or tiny: the same graph and run, exactly."""
    before, run = weights(terrain), run_of(terrain)
    for move in AFAR:
        moved = move.terrain(terrain)
        expected = {key: value * move.scale for key, value in before.items()}
        assert not differences(expected, weights(moved)), move
        again = run_of(moved)
        assert (run is None) == (again is None), move
        if run is not None and again is not None:
            assert (again.visits, again.unseen, again.unvisited) == (run.visits, run.unseen, run.unvisited)
            assert again.length == run.length * move.scale, move


def law_of_the_square(shapes: list, middle: Fraction, radius: Fraction) -> None:
    """The symmetries of a square grid of symmetric shapes map its graph to itself."""
    graph = weights(Terrain(tuple(shapes), None, radius))
    centers = [_center(shape) for shape in shapes]
    for turn in ((1, 0), (0, 1), (-1, 0), (0, -1)):
        for mirror in (False, True):
            about = Similarity((Q(turn[0]), Q(turn[1])), mirror=mirror)
            images = [about.point((x - middle, y - middle)) for x, y in centers]
            name = [centers.index((x + middle, y + middle)) for x, y in images]
            image = {frozenset(name[k] for k in key): value for key, value in graph.items()}
            assert not differences(graph, image)


def _center(shape: object) -> tuple[Fraction, Fraction]:
    if isinstance(shape, Disc):
        return Q(shape.x), Q(shape.y)
    assert isinstance(shape, list)
    return Q(sum(x for x, _ in shape), len(shape)), Q(sum(y for _, y in shape), len(shape))


class TestLaws:
    @examples(2, 150)
    @given(terrains(kinds=CURVED, moved=False), st.randoms(use_true_random=False))
    def test_description_of_round_scenes(self, terrain: Terrain, rng: Random) -> None:
        law_of_description(terrain, rng)

    @EXAMPLES
    @given(st.randoms(use_true_random=False))
    def test_rooms(self, rng: Random) -> None:
        terrain = crowded_room(rng)
        law_of_the_path(terrain)
        law_of_description(terrain, rng)

    @EXAMPLES
    @given(terrains(moved=False))
    def test_path(self, terrain: Terrain) -> None:
        law_of_the_path(terrain)

    @EXAMPLES
    @given(terrains(moved=False))
    def test_afar(self, terrain: Terrain) -> None:
        law_of_afar(terrain)

    @pytest.mark.parametrize("radius", [1, 3, Q(5, 2), 4])
    @pytest.mark.parametrize("grid", [square_grid, circle_grid])
    def test_symmetry_of_a_grid(self, grid: object, radius: Fraction) -> None:
        shapes = square_grid(4, 4) if grid is square_grid else circle_grid(4, 4)
        middle = Q(7, 2) if grid is square_grid else Q(9, 2)
        law_of_the_square(shapes, middle, Q(radius))


class TestGlimpses:
    """Pieces with irrational ends: what is seen from them is decided, and quickly."""

    def test_a_view_along_a_tangent_of_a_bulged_square(self) -> None:
        """The middle of a cell is a rational line: at an irrational one, touching an arc is a hard tie."""
        square = [(Q(7, 3), Q(15, 2)), (Q(7, 3), Q(7, 2)), (Q(-5, 3), Q(7, 2)), (Q(-5, 3), Q(15, 2))]
        shapes = (
            Disc(Q(1, 3), 1, 1),
            [(x, y, Q(1, 3)) for x, y in square],
            [(Q(20, 7), 5, Q(-1, 2)), (Q(48, 7), 5, -1)],
            Room([(25, 0, 1), (-25, 0, 1)]),
        )
        self._check(Terrain(shapes, (Q(7, 3), Q(15, 2)), Q(5)))

    def test_a_lens_and_a_crescent_in_a_round_room(self) -> None:
        shapes = (
            [(5, -2, -1), (5, 2, Q(-1, 3))],
            [(1, Q(11, 2), 3), (-1, Q(11, 2))],
            [(Q(48, 7), Q(16, 3), 1), (Q(20, 7), Q(16, 3), Q(1, 3))],
            Room([(25, 0, 1), (-25, 0, 1)]),
        )
        self._check(Terrain(shapes, (Q(20, 7), Q(16, 3)), Q(6)))

    def test_pieces_that_end_on_lines_that_bound_cells(self) -> None:
        shapes = (
            [(Q(1, 2), Q(-3, 2), Q(1, 3)), (Q(1, 2), Q(5, 2), Q(-1, 4))],
            [(Q(34, 7), 0), (Q(191, 35), Q(4, 5), 2), (Q(191, 35), Q(-4, 5))],
            [(8, Q(-1, 7), Q(1, 2)), (12, Q(-1, 7), Q(1, 2))],
            [(Q(5, 2), 7), (Q(5, 2), 3), (Q(-3, 2), 3, 1), (Q(-3, 2), 7)],
            [(7, 3), (3, 3), (3, 7, 1), (7, 7)],
            [(10, Q(22, 3), 1), (10, Q(10, 3), Q(-1, 2))],
            Room([(25, 0, 1), (-25, 0, 1)]),
        )
        self._check(Terrain(shapes, (Q(34, 7), Q(0)), Q(8)))

    @pytest.mark.parametrize("distance", [Q(92, 10), Q(101, 10)])
    @pytest.mark.parametrize("screened", [False, True])
    def test_between_circles(self, distance: Fraction, screened: bool) -> None:
        """M4 with circles, off the axis: the third is seen only from the way between the first two."""
        shapes: list[object] = [Disc(0, 0, Q(1, 2)), Disc(10, 1, Q(1, 2))]
        shapes.append([(5, distance), (6, distance + 1), (4, distance + 1)])
        if screened:
            shapes.append(box(2, 8, 4, 5))
        self._check(Terrain(tuple(shapes), (Q(-2), Q(1)), Q(10)))

    @staticmethod
    def _check(terrain: Terrain) -> None:
        """`unseen` and `unvisited` against sampled views from the path."""
        run = run_of(terrain)
        assert run is not None
        law_of_the_path(terrain)
        points = np.concatenate([_samples(piece) for piece in run.path])
        for k in (*run.unseen, *run.unvisited):
            certain = _is_seen(terrain, points, k, float(terrain.radius) * 0.999)
            possible = _is_seen(terrain, points, k, float(terrain.radius) * 1.02, 2e-3)
            assert possible if k in run.unvisited else not certain, k


def _samples(piece: object) -> np.ndarray:
    (ax, ay), (bx, by) = piece.start.xy, piece.end.xy  # type: ignore[attr-defined]
    u = np.linspace(0, 1, 121)[:, None]
    straight: np.ndarray = (1 - u) * (ax, ay) + u * (bx, by)
    return straight if piece.kind == "straight" else straight[:1]  # type: ignore[attr-defined]


def _is_seen(terrain: Terrain, points: np.ndarray, k: int, reach: float, tolerance: float = 1e-9) -> bool:
    w = world(terrain.shapes)
    step = w.perimeter(k) / 200
    marks = np.concatenate([[w.at(k, step * m) for m in range(200)], w.a[w.ids[k]]])
    gaps = np.hypot(*np.moveaxis(points[:, None] - marks[None], 2, 0))
    rows, columns = np.nonzero(gaps <= reach)
    for m in np.argsort(gaps[rows, columns])[:2000]:
        pair = points[rows[m]], marks[columns[m]]
        if free(terrain.shapes, *pair, max(tolerance, 1e-9)):
            return True
    return False
