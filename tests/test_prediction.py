"""Whether a known obstacle can be seen later: degenerate cases by hand, laws, and a dense sampler.

The walk goes up the line x = 0 unless said otherwise; `wall` is a vertical piece without thickness, whose
blocked side is on the right (east), so that it is seen from the walk.
"""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from math import acos, asin, atan2, cos, hypot, pi, sin
from random import Random

import numpy as np
import pytest
from nightly import some

from exactacq import kernel
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Point
from exactacq.numbers.function_zeros import roots
from exactacq.numbers.real import Real, fmpq
from exactacq.strategies.seed_spreader.hulls import ConvexHull
from exactacq.strategies.seed_spreader.prediction.decide import sees_later
from exactacq.strategies.seed_spreader.prediction.sight import growth

EPS = fmpq(1, 10**40)
FAR = fmpq(100)


@pytest.fixture(autouse=True, params=["with floats", "without"])
def _mode(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every answer is the same if floats decide nothing."""
    if request.param == "without":
        if request.function is test_the_sampler_agrees:
            pytest.skip("takes long")
        monkeypatch.setattr(kernel, "EXACT_ONLY", True)


def wall(x: object, low: object, high: object) -> Segment:
    """A vertical piece that faces west."""
    return Segment(Point(x, high), Point(x, low))


def chain(*vertices: tuple[object, object]) -> list[Curve]:
    """A closed polygon, counterclockwise."""
    points = [Point(*v) for v in vertices]
    return [Segment(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True)]


def block(x0: object, x1: object, y0: object, y1: object) -> list[Curve]:
    """The boundary of a rectangle."""
    return chain((x0, y0), (x1, y0), (x1, y1), (x0, y1))


def disc(x: object, y: object, radius_sq: object) -> list[Curve]:
    """A convex circle about a centre, as two arcs if its radius is rational, from east to west."""
    center, root = Point(x, y), Real(radius_sq).sqrt()
    east, west = center + Point(root, 0), center - Point(root, 0)
    square = Real(radius_sq).rational
    return [Arc(east, west, center, square, True), Arc(west, east, center, square, True)]


def sees(
    targets: list[Curve],
    others: list[Curve],
    radius: object = FAR,
    start: object = -50,
    stop: object = 50,
    points: tuple[Point, ...] = (),
    x: object = 0,
) -> bool:
    """`sees_later` with the targets among the known pieces."""
    known = [*targets, *others]
    return sees_later(
        fmpq(x), Real(start), fmpq(stop), targets, lambda _: known, Real(radius).rational, points
    )


# -- by hand ---------------------------------------------------------------------------------------

# Lines through the three gaps are at least 0 at x = 1 and x = 3 and at most 0 at x = 2: only y = 0 is.
SLIT = [wall(1, -60, 0), wall(2, 0, 60), wall(3, -60, 0)]
SCREEN = [wall(4, -1, 1)]


def test_aligned_ends_are_seen_through_from_one_place() -> None:
    assert sees(SCREEN, SLIT)
    assert sees(SCREEN, SLIT, stop=0)
    assert not sees(SCREEN, SLIT, stop=-EPS)
    assert not sees(SCREEN, [*SLIT[:2], wall(3, -60, EPS)])
    assert sees(SCREEN, [*SLIT[:2], wall(3, -60, -EPS)])


def test_the_start_is_excluded() -> None:
    assert not sees(SCREEN, SLIT, start=0)
    assert sees(SCREEN, SLIT, start=-EPS)
    assert not sees(SCREEN, SLIT, start=0, stop=-50)
    assert sees(SCREEN, SLIT, start=EPS, stop=-50)
    assert not sees(SCREEN, [], start=7, stop=7)


def test_what_is_out_of_reach_is_not_seen() -> None:
    """Only the corner is within range, and only from the start: no other candidate decides that."""
    box, near = block(-1, 0, 3, 5), block(-1, 0, 1, 2)
    assert not sees(box, near, radius=1, start=2, stop=0)
    assert sees(box, near, radius=1 + EPS, start=2, stop=0)


def test_the_start_can_be_included() -> None:
    """Of the slit's one line, from its one place, and from a walk that is no longer than that place."""
    known = [*SCREEN, *SLIT]
    for stop in (50, 0):
        assert sees_later(fmpq(0), Real(0), fmpq(stop), SCREEN, lambda _: known, fmpq(60), including=True)
        assert not sees_later(fmpq(0), Real(0), fmpq(stop), SCREEN, lambda _: known, fmpq(60))
    root = Real(2).sqrt()
    assert not sees_later(fmpq(0), root, root, SCREEN, lambda _: known, fmpq(60), including=True)
    assert sees_later(fmpq(0), root, root, SCREEN, lambda _: SCREEN, fmpq(60), including=True)


def test_the_range_counts() -> None:
    target = [wall(3, -1, 1)]
    assert sees(target, [], radius=3)
    assert not sees(target, [], radius=3 - EPS)
    # 5^2 = 3^2 + 4^2: seen from y = 5 at last.
    assert not sees(target, [], radius=5, start=5)
    assert sees(target, [], radius=5, start=5 - EPS)
    assert sees(SCREEN, SLIT, radius=4)
    assert not sees(SCREEN, SLIT, radius=4 - EPS)
    # An irrational moment: from y = 1 + sqrt(7) on the near end is out of range 4.
    moment = 1 + Real(7).sqrt()
    assert not sees(target, [], radius=4, start=moment)
    assert sees(target, [], radius=4, start=moment - EPS)


def test_a_front_is_not_seen_from_behind() -> None:
    front = [wall(-3, -1, 1)]
    assert not sees(front, [])
    assert sees([front[0].reversed()], [])
    assert not sees([wall(0, -1, 1)], [], x=1)
    # In line with it, its near end is seen, without touching the blocked side.
    level = [Segment(Point(5, 2), Point(3, 2))]
    assert sees(level, [], start=2)
    assert not sees(level, [], start=-50, stop=2 - EPS)
    assert sees(level, [], start=-50, stop=2)


def test_walls_of_joined_pieces_have_no_gaps() -> None:
    joint, top, bottom = Point(1, 0), Point(1, 60), Point(1, -60)
    target = [wall(3, -1, 1)]
    assert not sees(target, [Segment(top, joint), Segment(joint, bottom)])
    assert not sees(target, [Segment(top, joint), Segment(Point(1, 0), bottom)])
    assert sees(target, [Segment(top, joint), Segment(Point(1, -EPS), bottom)])
    # Where both pieces end they do not join: knowledge ends at the point.
    assert sees(target, [Segment(top, joint), Segment(bottom, joint)])


def test_corners_may_be_touched_from_outside() -> None:
    low, high = block(1, 2, -60, 0), block(3, 4, 0, 60)
    target = [wall(6, -1, 1)]
    pinch = [*low, *high, *block(5, fmpq(11, 2), -60, 0)]
    assert sees(target, pinch)
    assert sees(target, pinch, stop=0)
    assert not sees(target, pinch, start=0)
    assert not sees(target, [*pinch, *block(fmpq(17, 3), fmpq(35, 6), -60, EPS)])
    tip = chain((3, 0), (4, 60), (2, 60))
    assert sees(target, [*low, *tip, *block(5, fmpq(11, 2), -60, 0)])


def test_tangents_of_convex_arcs_are_free() -> None:
    target = [wall(9, -1, 1)]
    arcs = [*disc(2, -1, 1), *disc(4, 2, 4), *disc(6, -1, 1)]
    curtains = [wall(2, -60, -1), wall(4, 2, 60), wall(6, -60, -1)]
    assert sees(target, [*arcs, *curtains], stop=0)
    assert not sees(target, [*arcs, *curtains], start=0)
    assert not sees(target, [*arcs, *curtains], stop=-EPS)
    thick = [*disc(2, -1, 1), *disc(4, 2, 4 + EPS), *disc(6, -1, 1), *curtains]
    assert not sees(target, thick)
    assert sees(target, [*disc(2, -1, 1), *disc(4, 2, 4 - EPS), *disc(6, -1, 1), *curtains])


def test_tangents_of_concave_arcs_are_blocked() -> None:
    # Clockwise over the top of a circle about (7/2, -1): the obstacle lies above, outside the circle.
    center = Point(fmpq(7, 2), -1)
    bowl = Arc(Point(fmpq(29, 10), fmpq(-1, 5)), Point(fmpq(41, 10), fmpq(-1, 5)), center, fmpq(1), False)
    target = [wall(5, -1, 1)]
    assert sees(target, SLIT)
    assert not sees(target, [*SLIT, bowl])
    assert sees(target, [*SLIT, bowl.reversed()])


def test_the_inside_of_a_concave_arc_is_seen() -> None:
    center = Point(3, 0)
    bowl = Arc(Point(3, 2), Point(3, -2), center, fmpq(4), False)
    assert sees([bowl], [], radius=5, start=-1, stop=1)
    # Only from within: the line runs west of the opening, where the ends are in range from one place.
    assert sees([bowl], [], radius=3, start=-50, stop=2)
    assert not sees([bowl.reversed()], [], radius=fmpq(29, 10), x=0)


def test_gaps_are_looked_through() -> None:
    target = [wall(3, -1, 1)]
    for gap in (fmpq(1, 10), EPS):
        assert sees(target, [wall(1, gap, 60), wall(1, -60, 0)])
    assert not sees(target, [wall(1, -EPS, 60), wall(1, -60, 0)])
    assert not sees(target, [wall(1, fmpq(1, 10), 60), wall(1, -60, 0), wall(2, -30, 30)])


def test_between_pieces_on_the_line_of_the_walk_there_is_free_sight() -> None:
    """The places between have no first one: sights from the lone ends of the pieces stand for them."""
    target, before = [wall(3, -2, 3)], wall(0, -5, 0)
    assert sees(target, [before, wall(0, 1, 5)], 5, start=-4, stop=4)
    assert sees(target, [before, wall(0, EPS, 5)], 5, start=-4, stop=4)
    assert not sees(target, [before, wall(0, 0, 5)], 5, start=-4, stop=4)
    assert not sees(target, [wall(0, -5, 5)], 5, start=-4, stop=4)


def test_single_points_are_seen_too() -> None:
    dot = Point(4, 0)
    assert sees([], SLIT, points=(dot,))
    assert not sees([], SLIT, points=(Point(4, EPS),))
    assert not sees([], SLIT, points=(dot,), start=0)
    assert sees([], [], points=(dot,), radius=4)
    assert not sees([], [], points=(dot,), radius=4 - EPS)
    assert sees([], [], points=(Point(0, 3),), radius=1, stop=3)
    assert not sees([], [], points=(Point(0, 3),), radius=1, start=4)


def test_the_range_along_a_line_that_turns_about_an_end() -> None:
    """The line from (0, y) past (1, 0) meets y = -1 at 1 + 1 / y, in (1 + y)^2 (1 + 1 / y^2) = 9."""
    target = [Segment(Point(10, -1), Point(fmpq(101, 100), -1))]
    post = [Segment(Point(1, 0), Point(1, -60))]
    moment = max(roots([1, 2, 2 - 9, 2, 1]))
    for bits in (10, 40, 200):
        assert sees(target, post, radius=3, start=moment - fmpq(1, 2**bits))
        assert not sees(target, post, radius=3, start=moment + fmpq(1, 2**bits))
    assert not sees(target, post, radius=3, start=moment)
    assert sees(target, post, radius=3, start=moment, stop=0)


def test_pieces_that_the_walk_touches_are_seen() -> None:
    assert sees([Segment(Point(-1, 5), Point(1, 5))], [], start=4, stop=5, radius=EPS)
    assert not sees([Segment(Point(-1, 5), Point(1, 5))], [], start=5, stop=6, radius=EPS)
    assert sees([wall(0, -60, 60)], [], start=4, stop=5, radius=EPS)


# -- laws and the sampler --------------------------------------------------------------------------


def _round(value: float, unit: int = 101) -> fmpq:
    return fmpq(round(value * unit), unit)


def _corners(rng: Random, count: int) -> list[tuple[fmpq, fmpq]]:
    """Rational points of the unit circle, counterclockwise."""
    found = []
    for k in range(count):
        angle = 2 * pi * (k + 0.7 * rng.random()) / count
        t = _round(sin(angle % (pi / 2) / 2) / cos(angle % (pi / 2) / 2), 97)
        x, y = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
        for _ in range(int(angle // (pi / 2)) % 4):
            x, y = -y, x
        found.append((x, y))
    return found


def _part(curve: Curve, rng: Random) -> list[Curve]:
    """A part of a segment or of an arc, or nothing."""
    u, v = sorted(_round(rng.random(), 1009) for _ in range(2))
    return [curve.part(curve.point(u), curve.point(v))] if v - u > fmpq(1, 5) else []


def _obstacle(rng: Random, x: fmpq, y: fmpq, known: float) -> list[Curve]:
    r = _round(0.3 + 0.5 * rng.random())
    if rng.random() < 0.3:
        pieces = disc(x, y, r * r)
    else:
        points = [Point(x + r * a, y + r * b) for a, b in _corners(rng, rng.randint(3, 6))]
        sides = zip(points, [*points[1:], points[0]], strict=True)
        pieces = [
            Arc.from_bulge(a, b, fmpq(-1, rng.randint(4, 9))) if rng.random() < 0.25 else Segment(a, b)
            for a, b in sides
        ]
    found: list[Curve] = []
    for piece in pieces:
        if rng.random() < known:
            found.append(piece)
        elif isinstance(piece, Segment) and rng.random() < 0.6:
            found += _part(piece, rng)
    return found


def _scene(seed: int) -> tuple[list[Curve], list[Curve], fmpq, fmpq, fmpq]:
    """Targets, other pieces, radius, start and stop."""
    rng = Random(seed)
    cells = [(i, j) for i in range(-3, 4) for j in range(-3, 4) if i]
    rng.shuffle(cells)
    known = rng.choice((0.4, 0.7, 1.0))
    obstacles = []
    for i, j in cells[: rng.randint(6, 20)]:
        x, y = (_round(2 * k + 0.4 * (rng.random() - 0.5)) for k in (i, j))
        obstacles.append(_obstacle(rng, x, y, known))
    first = next(k for k, o in enumerate(obstacles) if o)
    start, stop = _round(rng.uniform(-6, 6)), _round(rng.choice((-8, 8)))
    radius = _round(rng.uniform(3, 8))
    others = [piece for k, o in enumerate(obstacles) if k != first for piece in o]
    return obstacles[first], others, radius, start, stop


def _answer(seed: int) -> bool:
    targets, others, radius, start, stop = _scene(seed)
    return sees(targets, others, radius, start, stop)


@pytest.mark.parametrize("seed", some(range(0, 60, 5), 4))
def test_larger_ranges_and_fewer_pieces_see_no_less(seed: int) -> None:
    for k in range(seed, seed + 5):
        targets, others, radius, start, stop = _scene(k)
        if sees(targets, others, radius, start, stop):
            assert sees(targets, others, radius * fmpq(3, 2), start, stop)
            assert sees(targets, others[::2], radius, start, stop)
            assert sees(targets, others, radius, start - (stop - start) / 3, stop)
        else:
            assert not sees(targets, others, radius * fmpq(2, 3), start, stop)
            assert not sees(targets, others, radius, (start + stop) / 2, stop)


@pytest.mark.parametrize("seed", some(range(0, 60, 5), 4))
def test_mirror_images_answer_alike(seed: int) -> None:
    for k in range(seed, seed + 5):
        targets, others, radius, start, stop = _scene(k)
        expected = sees(targets, others, radius, start, stop)
        for across, up in ((-1, 1), (1, -1), (-1, -1)):
            images = [[_mirrored(c, across, up) for c in curves] for curves in (targets, others)]
            assert sees(*images, radius, start * up, stop * up) == expected


def _mirrored(curve: Curve, across: int, up: int) -> Curve:
    """The image; directed so that the blocked side stays on the left."""

    def image(point: Point) -> Point:
        return Point(point.x * across, point.y * up)

    start, end = image(curve.start), image(curve.end)
    if across * up < 0:
        start, end = end, start
    if isinstance(curve, Segment):
        return Segment(start, end)
    return Arc(start, end, image(curve.center), curve.radius_sq, curve.ccw)


@pytest.mark.parametrize("radius", [20, fmpq(13, 2), 6])
@pytest.mark.parametrize(("start", "stop"), [(2, 8), (8, 2)])
def test_a_slit_along_the_line_itself(start: int, stop: int, radius: int) -> None:
    """Two walls, one from the west and one from the east, leave the line x = 0 alone between them and a disc
    below. It is seen from the end of the walk at 2, 13/2 away, or from just after it if that is the start. Of
    lines of sight along the walk only those as long as the range were asked."""
    disc = [
        Arc(
            Point(fmpq(1, 4), fmpq(-17, 4)),
            Point(fmpq(1, 4), fmpq(-19, 4)),
            Point(fmpq(1, 4), fmpq(-9, 2)),
            fmpq(1, 16),
            ccw=True,
        )
    ]
    walls = [Segment(Point(0, -3), Point(60, -3)), Segment(Point(-60, -2), Point(0, -2))]
    assert sees(disc, walls, radius, start, stop) == (radius == 20 or (radius != 6 and stop == 2))
    assert not sees(disc, [*walls, Segment(Point(-1, 0), Point(1, 0))], radius, start, stop)


def test_the_sampler_agrees() -> None:
    counts: Counter[bool] = Counter()
    seeds = some(range(100, 130), 15)
    for seed in seeds:
        targets, others, radius, start, stop = _scene(seed)
        answer = sees(targets, others, radius, start, stop)
        sampler = _Sampler(targets, others, float(radius))
        # What is seen from a short stretch only needs a finer look.
        steps = (50, 500) if answer else (50,)
        ys = (y for n in steps for y in np.linspace(float(stop), float(start), n)[:-1])
        assert answer == any(sampler.sees(y) for y in ys), seed
        counts[answer] += 1
    assert min(counts[True], counts[False]) > len(seeds) / 4, counts


class _Sampler:
    """Looks from a place of the line x = 0 in many directions, in floats: to features, and just past them."""

    def __init__(self, targets: list[Curve], others: list[Curve], radius: float) -> None:
        self.curves, self.count, self.radius = [*targets, *others], len(targets), radius

    def sees(self, y: float) -> bool:
        ways = np.array([a + e for a in self._angles(y) for e in (-1e-4, -1e-7, 0, 1e-7, 1e-4)])
        d = np.stack((np.cos(ways), np.sin(ways)), axis=1)
        nearest = np.full(len(d), self.radius * (1 - 1e-9))
        seen = np.zeros(len(d), dtype=bool)
        for k, curve in enumerate(self.curves):
            for t, inward in self._hits(curve, y, d):
                nearer = t < nearest
                nearest = np.where(nearer, t, nearest)
                seen = np.where(nearer, (k < self.count) & (inward > 1e-9), seen)
        return bool(seen.any())

    def _angles(self, y: float) -> list[float]:
        found = list(np.linspace(-pi, pi, 40))
        for curve in self.curves:
            (a, b), (c, d) = curve.start.xy, curve.end.xy
            found += [atan2(b - y, a), atan2(d - y, c)]
            if isinstance(curve, Segment):
                foot, far = atan2(-a * (d - b) + (b - y) * (c - a), 1.0), hypot(c - a, d - b)
                height = abs((b - y) * (c - a) - a * (d - b)) / far
                foot = atan2(c - a, b - d) if (b - y) * (c - a) - a * (d - b) > 0 else atan2(a - c, d - b)
                half = acos(min(1.0, height / self.radius))
                found += [foot, foot - half, foot + half]
                continue
            (u, v), r = curve.center.xy, float(curve.radius)
            middle, far = atan2(v - y, u), hypot(u, v - y)
            half = asin(min(1.0, r / far))
            ranged = (self.radius**2 + far * far - r * r) / (2 * self.radius * far)
            other = acos(max(-1.0, min(1.0, ranged)))
            found += [middle, middle - half, middle + half, middle - other, middle + other]
        return found

    def _hits(self, curve: Curve, y: float, d: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Distances along rays, infinite where they miss, and how steeply they enter the blocked side."""
        (a, b), (u, v) = curve.start.xy, curve.end.xy
        along = np.array((u - a, v - b))
        if isinstance(curve, Segment):
            sine = d[:, 0] * along[1] - d[:, 1] * along[0]
            with np.errstate(all="ignore"):
                t = (a * along[1] - (b - y) * along[0]) / sine
                s = (a * d[:, 1] - (b - y) * d[:, 0]) / sine
            return [(np.where((t > 0) & (s >= 0) & (s <= 1), t, np.inf), -sine)]
        (cx, cy), sense = curve.center.xy, 1 if curve.ccw else -1
        middle = d[:, 0] * cx + d[:, 1] * (cy - y)
        rest = float(curve.radius) ** 2 - (d[:, 0] * (cy - y) - d[:, 1] * cx) ** 2
        found = []
        for root in (middle - np.sqrt(np.maximum(rest, 0)), middle + np.sqrt(np.maximum(rest, 0))):
            place = np.stack((root * d[:, 0], y + root * d[:, 1]), axis=1)
            side = along[0] * (place[:, 1] - b) - along[1] * (place[:, 0] - a)
            on = (rest > 0) & (root > 0) & (side * sense <= 0)
            inward = -sense * ((place - (cx, cy)) * d).sum(axis=1)
            found.append((np.where(on, root, np.inf), inward))
        return found


def test_the_sign_of_growth_is_that_of_exact_differences() -> None:
    rng = Random(1)
    step, told = Real(1) / 10**8, 0
    for k in range(660):
        x, y, *numbers = (Real(rng.randint(-40, 40)) / 4 for _ in range(8))
        shape = Point(numbers[0], numbers[1]), Real(rng.choice([0, 1, -1, 2]))
        a, b = Point(numbers[2], numbers[3]), Point(numbers[4], numbers[5])
        circle = Arc(Point(a.x + 2, a.y), Point(a.x + 2, a.y), a, fmpq(4), ccw=True, full=True)
        target = circle if a == b or rng.random() < 0.5 else Segment(a, b)
        if k >= 600:  # Tangents of the target's own circle end where they touch it.
            shape, target = (a, Real(rng.choice([2, -2]))), circle
        before, after = (sights_about(Point(x, z), shape, target) for z in (y, y + step))
        if len(before) == len(after):
            for one, other in zip(before, after, strict=True):
                length, rate = growth(x, (y, y + step), shape, target, one)
                if length.is_finite():
                    assert all(length.overlaps(known.ball(128)) for known in (one, other))
                sign = int(rate > 0) - int(rate < 0)
                assert sign in (0, (other - one).sign())
                told += sign != 0
                assert sign or k < 600
    assert told > 50


def sights_about(place: Point, shape: tuple[Point, Real], target: Curve) -> list[Real]:
    """Lengths of the lines from a place past a point, or touching a circle, to a target ahead."""
    turn, offset = shape[1], shape[0] - place
    rest = offset.norm_sq() - turn * turn
    if rest.sign() <= 0:
        return []
    ahead, across = rest.sqrt(), Point(-offset.y, offset.x)
    way = (offset * ahead + across * turn) / offset.norm_sq()
    return [t for t in line_contacts(place, way, target) if t.sign() > 0]


@pytest.mark.parametrize(("start", "is_seen"), [(7, False), (fmpq(71, 10), True), (1, False)])
def test_a_corner_on_the_line_of_the_walk_bounds_one_line_of_sight(start: object, is_seen: bool) -> None:
    """Past it all lines of sight are the walk's own; on the way down the last one is as long as the range.

    From (5, 7) on, all lines beside that one are as long as the range, as far as floats can tell.
    """
    diamond = [Point(5, 9), Point(fmpq(9, 2), 10), Point(4, 9), Point(fmpq(9, 2), 8)]
    corner = [Segment(a, b) for a, b in zip(diamond, [*diamond[1:], diamond[0]], strict=True)]
    target = Arc(Point(4, 12), Point(5, 12), Point(fmpq(9, 2), fmpq(66, 5)), fmpq(169, 100), ccw=True)
    side = Segment(Point(5, 12), Point(5, 16))
    targets = [side, target]
    assert (
        sees_later(fmpq(5), Real(start), fmpq(0), targets, lambda _: [*targets, *corner], fmpq(5)) is is_seen
    )


@pytest.mark.parametrize(("start", "is_seen"), [(4, False), (fmpq(41, 10), True), (1, False)])
def test_a_circle_that_the_line_of_the_walk_touches(start: object, is_seen: bool) -> None:
    """A block below (6, 4) leaves only that line, a tangent of the circle, and the side that begins there.

    It comes into reach at (6, 4), as far as floats can tell a little later.
    """
    round_part = Arc(Point(4, 6), Point(6, 6), Point(5, 6), fmpq(1), ccw=True)
    corners = [Point(6, 6), Point(6, 7), Point(4, 7), Point(4, 6)]
    targets = [round_part, *(Segment(a, b) for a, b in pairwise(corners))]
    known = [*targets, *block(4, 6, 3, 4)]
    for x in (6, -6):
        seen = sees_later(fmpq(x), Real(start), fmpq(0), targets, lambda _, known=known: known, fmpq(2))
        assert seen is is_seen
        targets, known = ([_mirrored(curve, -1, 1) for curve in curves] for curves in (targets, known))


def test_what_lies_between_some_places_is_in_their_convex_hull() -> None:
    """Also where places coincide, or lie on a line: places on a grid do, here far from the origin."""
    rng = Random(5)
    for _ in range(500):
        far, places = 10.0 ** rng.randrange(7), [(rng.randrange(4), rng.randrange(4)) for _ in range(7)]
        places = [(x + far, y - far) for x, y in places[: rng.randrange(1, 8)]]
        between = ConvexHull(places, 1e-9 * far)
        (a, b), (c, d) = rng.choice(places), rng.choice(places)
        t, west, south, east, north = (rng.random() for _ in range(5))
        x, y = a + t * (c - a), b + t * (d - b)
        assert between.may_meet((x, y, x, y))
        assert between.may_meet((x - west, y - south, x + east, y + north))
    triangle = ConvexHull([(0, 0), (4, 0), (0, 4)], 0.0)
    assert not triangle.may_meet((2.1, 2.1, 9, 9))
    assert not triangle.may_meet((1, -2, 2, -1))
    assert triangle.may_meet((2, 2, 9, 9))


def test_past_a_circle_that_the_walk_touches() -> None:
    """From its places other lines go past the circle too; the wall is exactly as far away as the range."""
    circle, facing = Arc.circle(Point(-1, 6), fmpq(1)), Segment(Point(-3, fmpq(5, 2)), Point(-3, fmpq(21, 4)))
    known = [circle, facing]
    assert sees_later(fmpq(0), Real(4), fmpq(11, 2), [facing], lambda _: known, fmpq(3))
