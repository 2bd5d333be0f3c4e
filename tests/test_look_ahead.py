"""The audit's own look ahead: by hand, against the strategy's, and what it finds in runs that ask wrongly.

The line goes up x = 0 unless said otherwise; `wall` is a vertical piece whose blocked side is on its right.
"""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

import numpy as np
import pytest
import test_prediction as prediction
from nightly import some
from test_prediction import EPS, FAR, SCREEN, SLIT, block, chain, disc, wall

import exactacq as xa
from exactacq.auditing.audit import audit
from exactacq.auditing.known_walls import PRECISION, Walls, ball_point
from exactacq.auditing.look_ahead import seen_later
from exactacq.auditing.rest_of_line import KnownPieces, Rest
from exactacq.errors import AuditError, Undecided
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.precision import workprec
from exactacq.numbers.real import Real, fmpq
from exactacq.scene.bounding import terrain_around
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline
from exactacq.strategies.seed_spreader.losses import Line
from exactacq.strategies.seed_spreader.prediction.decide import sees_later
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import OUTLINES, POLYGONS, ROUNDED, random_scene


def sees(
    targets: Sequence[Curve],
    others: Sequence[Curve],
    radius: object = FAR,
    start: object = -50,
    stop: object = 50,
    points: Sequence[Point] = (),
    x: object = 0,
    including: bool = False,
) -> bool:
    """The audit's answer, which is never open here."""
    rest = Rest(Point(x, start), Point(x, stop), including)
    answer = seen_later(rest, KnownPieces(targets, points, others), fmpq(radius))
    assert not answer.is_open
    return answer.sees


class TestByHand:
    def test_one_line_from_one_place(self) -> None:
        """Through three gaps only y = 0 leads to the screen."""
        assert sees(SCREEN, SLIT)
        assert sees(SCREEN, SLIT, stop=0)
        assert not sees(SCREEN, SLIT, stop=-EPS)
        assert not sees(SCREEN, [*SLIT[:2], wall(3, -60, EPS)])
        assert sees(SCREEN, [*SLIT[:2], wall(3, -60, -EPS)])

    def test_the_start(self) -> None:
        assert not sees(SCREEN, SLIT, start=0)
        assert sees(SCREEN, SLIT, start=0, including=True)
        assert not sees(SCREEN, [], start=7, stop=7)
        assert sees(SCREEN, [], start=Real(2).sqrt(), stop=Real(2).sqrt(), including=True)

    def test_a_line_that_ends_where_it_begins_in_floats(self) -> None:
        """Both ways along it, a wall is seen that is nearer than the range; its sense no float tells."""
        high = 10**9
        for stop in (high + fmpq(1, 10**9), high - fmpq(1, 10**9)):
            assert sees([wall(3, high - 1, high + 1)], [], 4, start=high, stop=stop)
        assert not sees([wall(3, 2, 3)], [], start=0, stop=0, radius=3, including=True)

    def test_what_floats_cannot_tell_apart_is_not_passed(self) -> None:
        """Where all within the range is one float of a large circle, balls compare few walls only."""
        flat, posts = Arc.from_bulge(Point(3, 1), Point(3, -1), fmpq(1, 10**13)), range(1, 66)
        with pytest.raises(Undecided, match="floats cannot tell places"):
            sees([flat], [wall(1 + fmpq(k, 66), 0, 1) for k in posts], 4)

    def test_the_range(self) -> None:
        assert sees(SCREEN, SLIT, radius=4)
        assert not sees(SCREEN, SLIT, radius=4 - EPS)
        moment = 1 + Real(7).sqrt()
        assert not sees([wall(3, -1, 1)], [], radius=4, start=moment)
        assert sees([wall(3, -1, 1)], [], radius=4, start=moment - EPS)

    def test_the_shortest_sight_past_a_corner(self) -> None:
        """Past (27, 0) the shortest way from x = 0 to y = 64 is 125 long: (9 + 16)^(3/2), from y = -36."""
        ceiling, corner = [Segment(Point(0, 64), Point(300, 64))], block(-60, 27, 0, 60)
        for radius, expected in ((125, True), (125 - fmpq(1, 10**60), False), (126, True)):
            assert sees(ceiling, corner, radius, start=-300, stop=-1) is expected
            assert sees(ceiling, corner, radius, start=-36, stop=-1) is (radius == 126)

    def test_a_screen_is_seen_from_one_side_and_a_point_from_all(self) -> None:
        assert not sees([wall(-3, -1, 1)], [])
        assert sees([wall(-3, -1, 1).reversed()], [])
        assert sees([], [], points=[Point(5, 5)])
        assert not sees([], [wall(3, -60, 60)], points=[Point(5, 5)])

    def test_along_the_line(self) -> None:
        """Behind, a circle touches the line; two walls that end at the line leave nothing else."""
        circle = [Arc(Point(1, 0), Point(1, 0), Point(fmpq(1, 2), 0), fmpq(1, 4), True, full=True)]
        walls = [Segment(Point(0, 2), Point(60, 2)), Segment(Point(-60, 3), Point(0, 3))]
        assert sees(circle, walls, radius=20, start=5, stop=9)
        assert not sees(circle, walls, radius=5, start=5, stop=9)
        assert sees(circle, walls, radius=9, start=5, stop=9)

    def test_from_within_what_a_wall_bounds(self) -> None:
        """All places below the wall see the point, the last one on the wall does not: none is the farthest.

        Beyond, a second wall hides the point, and so does a third one on the way.
        """
        roof = [Segment(Point(1, 2), Point(-1, 2)), Segment(Point(-20, 3), Point(20, 3))]
        point = [Point(5, -5)]
        assert sees([], roof, points=point, start=0, stop=9)
        assert not sees([], [*roof, wall(1, -9, 2)], points=point, start=0, stop=9)

    def test_along_the_side_of_an_obstacle(self) -> None:
        """The line runs along a block west of it: from its corners too what lies west is hidden."""
        known = [*block(-1, 0, -5, 5), *block(-3, -2, 20, 21)]
        assert not sees([wall(-2, 0, 1).reversed()], known, start=5, stop=-5)
        assert sees([wall(-2, 0, 1).reversed()], known[1:], start=5, stop=-5, points=[Point(3, 3)])

    def test_around_a_disc(self) -> None:
        """From the far side of a disc of radius 1 about (3, 0) nothing of it is hidden but by itself."""
        assert sees(disc(3, 0, 1), [])
        assert not sees(disc(3, 0, 1), block(1, fmpq(3, 2), -60, 60))
        assert sees(disc(3, 0, 1)[:1], [])

    def test_the_hollow_of_an_arc(self) -> None:
        """The hollow is open to the west: seen from its mouth, not from behind."""
        hollow = Arc(Point(3, 2), Point(3, -2), Point(3, 0), fmpq(4), False)
        assert sees([hollow], [], start=-1, stop=1)
        assert not sees([hollow], [], start=-1, stop=1, x=9)


class TestWalls:
    """One sight among walls, in floats and in balls."""

    def test_certain_blocks_are_blocked(self) -> None:
        rng = Random(7)
        curves = [*block(1, 2, 0, 1), *disc(4, 0, 1), *chain((6, 0), (7, 0), (7, 2))]
        walls = Walls(curves, 0, 10.0)

        def some() -> Point:
            return Point(fmpq(rng.randrange(-40, 90), 10), fmpq(rng.randrange(-40, 40), 10))

        with workprec(PRECISION):
            walls.join()
            pairs = [(some(), some()) for _ in range(600)]
            p, q = (np.array([pair[k].xy for pair in pairs]) for k in (0, 1))
            blocked = walls.block(p, q, np.full(len(p), walls.grain))
            free = [walls.is_free(ball_point(a), ball_point(b)) for a, b in pairs]
        assert not any(f and b for f, b in zip(free, blocked, strict=True))
        assert sum(blocked) > 100
        assert sum(free) > 100
        # Those that floats leave open touch something, or begin or end in an obstacle.
        assert sum(not f and not b for f, b in zip(free, blocked, strict=True)) < 60


# -- the other one ---------------------------------------------------------------------------------


def degenerate(seed: int) -> tuple[list[Curve], list[Curve], fmpq, fmpq, fmpq]:
    """A map on an integer grid: the target's pieces, others, the radius, and the rest's ends."""
    rng = Random(seed)
    cells = [(i, j) for i in (-3, -2, -1, 0, 1, 2) for j in range(-3, 3)]
    rng.shuffle(cells)
    known = rng.choice((0.5, 0.8, 1.0))
    obstacles = []
    for i, j in cells[: rng.randint(2, 9)]:
        x, y = 2 * i + rng.choice((0, 0, fmpq(1, 2))), 2 * j + rng.choice((0, 0, fmpq(1, 2)))
        shape: Any = Circle((x + fmpq(1, 2), y + fmpq(1, 2)), fmpq(1, 2))
        if rng.random() < 0.8:
            drawn = rng.choice((*POLYGONS, *OUTLINES, *ROUNDED))
            shape = Outline([(x + fmpq(v[0]), y + fmpq(v[1]), v[2] if len(v) > 2 else 0) for v in drawn])
        pieces: list[Curve] = []
        for edge in Scene([shape]).obstacles[0].edges:
            if rng.random() < known:
                pieces.append(edge)
            elif rng.random() < 0.6 and not (isinstance(edge, Arc) and edge.full):
                u, v = sorted(fmpq(rng.randint(0, 8), 8) for _ in range(2))
                pieces += [edge.part(edge.point(u), edge.point(v))] if u < v else []
        obstacles.append(pieces)
    first = rng.randrange(len(obstacles))
    radius = rng.choice([fmpq(1), fmpq(2), fmpq(3), fmpq(5, 2), fmpq(5), fmpq(20)])
    others = [piece for k, pieces in enumerate(obstacles) if k != first for piece in pieces]
    return obstacles[first], others, radius, fmpq(rng.randint(-6, 6)), fmpq(rng.choice((-8, -7, 7, 8)))


class TestTheStrategyAgrees:
    """Two answers that share no code."""

    @pytest.mark.parametrize("first", some(range(0, 60, 12), 2))
    def test_in_general_position(self, first: int) -> None:
        for seed in range(first, first + 12):
            targets, others, radius, start, stop = prediction._scene(seed)
            expected = prediction.sees(targets, others, radius, start, stop)
            assert sees(targets, others, radius, start, stop) is expected, seed

    @pytest.mark.parametrize("first", some(range(0, 90, 10), 3))
    def test_on_grids(self, first: int) -> None:
        for seed in range(first, first + 10):
            targets, others, radius, start, stop = degenerate(seed)
            known = [*targets, *others]
            for x in (fmpq(0), fmpq(1)):
                expected = sees_later(x, Real(start), stop, targets, lambda _, k=known: k, radius)
                assert sees(targets, others, radius, start, stop, x=x) is expected, (seed, x)

    @pytest.mark.parametrize("seed", [100246, 102816, 104787])
    def test_where_the_range_is_huge(self, seed: int) -> None:
        """On these maps a bound was no number, 0 times infinity: what it bounds counted as out of sight."""
        targets, others, radius, start, stop = degenerate(seed)
        one, other = ([enlarged(piece, 10**10) for piece in pieces] for pieces in (targets, others))
        x, low, high, reach = (fmpq(number) * 10**10 for number in (1, start, stop, radius))
        expected = sees_later(fmpq(1), Real(start), stop, targets, lambda _: [*targets, *others], radius)
        assert sees_later(x, Real(low), high, one, lambda _: [*one, *other], reach) is expected


def enlarged(piece: Curve, times: int) -> Curve:
    """A piece of a map that is so many times as large."""
    start, end = (Point(place.x * times, place.y * times) for place in (piece.start, piece.end))
    if isinstance(piece, Segment):
        return Segment(start, end)
    center = Point(piece.center.x * times, piece.center.y * times)
    return Arc(start, end, center, piece.radius_sq * times**2, piece.ccw, piece.full)


# -- runs of a strategy that asks wrongly ----------------------------------------------------------


def misled(patch: pytest.MonkeyPatch, scene: Scene, answer: bool) -> xa.SeedSpreaderRun:
    """The run of a strategy whose look ahead always gives one answer."""
    patch.setattr(Line, "_sees", lambda *_, **__: answer)
    return xa.seed_spreader(scene)


def named(name: str | int) -> Scene:
    return xa.load(name) if isinstance(name, str) else random_scene(Subject.SEED_SPREADER, name)


@pytest.mark.parametrize("name", some(["m18", 2, "relay"], 1))
def test_a_forgotten_diversion_is_found(name: str | int, monkeypatch: pytest.MonkeyPatch) -> None:
    audit(xa.seed_spreader(named(name)), samples=2)
    with pytest.raises(AuditError, match=r"\(lose of obstacle \d+\) is not followed by a diversion"):
        audit(misled(monkeypatch, named(name), True), samples=2)


@pytest.mark.parametrize("name", some(["m25", 41, "relay", 50, 62, 70], 2))
def test_a_needless_diversion_is_found(name: str | int, monkeypatch: pytest.MonkeyPatch) -> None:
    audit(xa.seed_spreader(named(name)), samples=2)
    with pytest.raises(AuditError, match=r"is needless: by the map .* is seen from"):
        audit(misled(monkeypatch, named(name), False), samples=2)


def test_two_reasons_at_one_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """What goes out of sight in case3 is out of reach from there on: without asking the path is the same."""
    run = xa.seed_spreader(xa.load("case3"))
    other = misled(monkeypatch, xa.load("case3"), True)
    audit(other, samples=2)
    assert [d.leave for d in run.diversions] == [d.leave for d in other.diversions]


@pytest.mark.parametrize("bulge", ["1e-8", "1e-9", "1e-12", "1e-20"])
def test_sides_that_hardly_bulge(bulge: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """As CAD programs write straight sides: of their circles floats tell nothing within the range."""
    near = [(0, 0), (6, 8), ("26/5", "43/5"), ("-4/5", "3/5")]
    far = [("36/5", "48/5"), (12, 16), ("56/5", "83/5"), ("32/5", "51/5")]
    slabs = Scene([Outline([(x, y, bulge) for x, y in slab]) for slab in (near, far)])
    scene = slabs.replace(terrain=terrain_around(slabs, fmpq(1, 2)), radius=8)
    audit(xa.seed_spreader(scene), samples=2)
    with pytest.raises(AuditError, match=r"is needless: by the map .* is seen from"):
        audit(misled(monkeypatch, scene, False), samples=2)
