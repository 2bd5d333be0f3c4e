"""Straight ways in floats: the lines that cross one, and the edges that its own line meets."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction as Q
from itertools import combinations
from random import Random

import pytest
from flint import fmpq
from nightly import NIGHTLY, some

import exactacq as xa
from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.kernel.bounded import UNIT
from exactacq.kernel.extents import EVERYTHING
from exactacq.kernel.family_images import NONE, EndLine, FamilyImage
from exactacq.kernel.images import ROLLING, SPOKES
from exactacq.kernel.lines import Frame
from exactacq.kernel.single_lines import (
    SingleImage,
    extents_of_crossing_lines,
    extents_of_lines,
    lines_by_edge,
)
from exactacq.kernel.ways import WayImage, _crossed
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.legs import legs_of
from exactacq.sensing.line_family import LineFamily
from exactacq.sensing.sensor import Sensor
from exactacq.sensing.straight_way import OWN, StraightWay
from exactacq.sensing.way_crossings import WayCrossings
from exactacq.sensing.way_normals import WayNormals
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import arc_scene
from exactacq.visibility.line_families import Sliding
from exactacq.visibility.sensor_range import Range

GAPS = [Q(0), Q(0), Q(0), Q(1, 10**20), Q(1, 10**15), Q(1, 10**8)]
Pair = tuple[Q, Q]
Make = Callable[[Random], tuple[FamilyImage, list[tuple[Pair, Pair]]]]


def place(rng: Random, far: int) -> Pair:
    """A point of a small grid, or next to one, perhaps far from the origin."""
    x, y = (Q(far, 3) + rng.randrange(5) + rng.choice(GAPS) * rng.choice((-1, 1)) for _ in "xy")
    return x, y


def spot(point: Pair) -> tuple[float, float, float]:
    x, y = map(float, point)
    return x, y, UNIT * max(abs(x), abs(y))


def met(line: tuple[Pair, Pair], way: tuple[Pair, Pair]) -> tuple[Q, Q] | None:
    """Where two segments, which are not parallel, meet: parameters on both."""
    ((px, py), (qx, qy)), ((ax, ay), (bx, by)) = line, way
    dx, dy, wx, wy = qx - px, qy - py, bx - ax, by - ay
    under = wx * dy - wy * dx
    if not under:
        return None
    u, t = ((px - ax) * dy - (py - ay) * dx) / under, ((px - ax) * wy - (py - ay) * wx) / under
    return (t, u) if 0 <= t <= 1 and 0 <= u <= 1 else None


@pytest.mark.parametrize("seed", range(40))
def test_lines_that_cross_a_way_are_found(seed: int) -> None:
    """Each that does is found, with its place; one that is far from doing so is not."""
    rng = Random(seed)
    far = rng.choice([0, 0, 10**6, 10**12])
    left_out = crossing = whole = 0
    for _ in range(60):
        points = [place(rng, far) for _ in range(4)]
        line, way = (points[0], points[1]), (points[2], points[3])
        if line[0] == line[1] or way[0] == way[1]:
            continue
        segments = [Segment(*(Point(*p) for p in pair)) for pair in (line, way)]
        (ax, ay, p), (bx, by, q) = map(spot, way)
        image = WayImage(
            curve_image(segments[1]), (0.0, 0.0), (1.0, 1.0), (ax, ay, bx, by, max(p, q)), [], []
        )
        shown = curve_image(segments[0])
        ends, run = (spot(line[0]), spot(line[1])), rng.choice([None, shown])
        single = SingleImage((NONE, 0), (EVERYTHING, EVERYTHING), *ends, run, [], None, (0, 0, 0))
        radius = rng.choice([Q(2), Q(5), Q(20)])
        found = extents_of_crossing_lines([[single]], {0}, image, [shown], float(radius))
        exact = met(line, way)
        if exact is not None:
            (one,) = found
            assert one.origin is single and one.source[0] <= exact[1] <= one.source[1]
            crossing += 1
        left_out += not found
        if found and found[0].told == EVERYTHING:
            assert exact is not None and run is not None
            (ax, ay), (bx, by) = way
            x, y = ax + (bx - ax) * exact[1], ay + (by - ay) * exact[1]
            # The run is the segment of the line itself here.
            assert all((px - x) ** 2 + (py - y) ** 2 < radius**2 for px, py in line)
            whole += 1
    assert crossing >= 5 and (left_out >= 5 or far == 10**12)
    assert whole >= 1 or far


@pytest.mark.parametrize("seed", range(8))
def test_from_where_a_segment_sees_along_its_line(seed: int) -> None:
    """From all of it a place is seen only if all of it is seen from there, and is within range."""
    rng = Random(seed)
    for _ in range(40):
        (ax, ay), (dx, dy) = (place(rng, 0) for _ in range(2))
        if not (dx or dy):
            continue
        away = Q(rng.randrange(1, 30), 7)
        ahead = rng.random() < 0.5
        near, far = ((ax, ay), (ax + dx, ay + dy)) if ahead else ((ax + dx, ay + dy), (ax, ay))
        seen_from = (
            (ax - away * dx, ay - away * dy) if ahead else (ax + (1 + away) * dx, ay + (1 + away) * dy)
        )
        segment = curve_image(Segment(Point(ax, ay), Point(ax + dx, ay + dy)))
        seen = rng.choice([EVERYTHING, (0.25, 1.0)])
        single = SingleImage(
            (1, 0), ((0.5, 0.5), seen), spot(seen_from), spot(near), segment, [], None, (0, 0, 0)
        )
        size = Q((far[0] - seen_from[0]) ** 2 + (far[1] - seen_from[1]) ** 2)
        radius = rng.choice([Q(1, 2), Q(1), Q(2), Q(5)]) + rng.randrange(40)
        (one,) = extents_of_lines(0, [lines_by_edge([single])], [segment, segment], float(radius))
        assert one.edge == 1
        assert one.in_range <= (size < radius**2)
        assert one.in_range or size > radius**2 * Q(99, 100)
        assert (one.surely == EVERYTHING) == (one.in_range and seen == EVERYTHING)


def turned(base: tuple[int, int], low: Q, high: Q) -> list[Pair]:
    """A vector turned by angles between two, which are given by the tangents of their halves."""
    ex, ey = base
    found = []
    for k in range(33):
        t = low + (high - low) * Q(k, 32)
        c, s = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
        found.append((c * ex - s * ey, c * ey + s * ex))
    return found


def of_circle(frame: Frame, low: Q, high: Q) -> FamilyImage:
    """The family between two parameters, which meets nothing."""
    ends = [EndLine(frame, float(t), UNIT, [], [k]) for k, t in enumerate((low, high))]
    family = FamilyImage(frame, (ends[0], ends[1]), (-1, 0, -1), True, -1, None, 0)
    family.is_known = True
    return family


def tangents(rng: Random) -> tuple[FamilyImage, list[tuple[Pair, Pair]]]:
    """Tangents of a circle, of a part of a quarter turn, and some of them: contacts and directions."""
    x, y, ex, ey = (rng.randrange(-6, 7) for _ in range(4))
    ex = ex or 1
    low, high = Q(rng.randrange(6), 16), Q(rng.randrange(7, 17), 16)
    family = of_circle((ROLLING, float(x), float(y), float(ex), float(ey), 0.0, 1), low, high)
    return family, [((x + vx, y + vy), (-vy, vx)) for vx, vy in turned((ex, ey), low, high)]


def normals(rng: Random) -> tuple[FamilyImage, list[tuple[Pair, Pair]]]:
    """Normals of a part of an eighth of a circle, all to one side, and some of them; see `tangents`."""
    x, y = (rng.randrange(-6, 7) for _ in range(2))
    ex, ey, size = rng.choice([(1, 0, 1), (3, -4, 5), (-5, 12, 13), (-8, -15, 17)])
    radius, sense = rng.randrange(1, 6), rng.choice((-1, 1))
    low, high = Q(rng.randrange(5), 16), Q(rng.randrange(5, 7), 16)
    frame = (SPOKES, float(x), float(y), float(ex), float(ey), float(radius), sense)
    family = of_circle(frame, *(2 * t / (1 - t * t) for t in (low, high)))
    units = [(vx / size, vy / size) for vx, vy in turned((ex, ey), low, high)]
    return family, [((x + radius * u, y + radius * v), (sense * u, sense * v)) for u, v in units]


@pytest.mark.parametrize("make", [tangents, normals])
def test_lines_that_cross_a_way_do_so_where_floats_say(make: Make) -> None:
    """Also if one in between is parallel to the way: the crossings then may come twice by one place.

    They were taken to leave away from where they come back to, which is so for lines through one point only:
    of the tangents of an S of half circles the wrong part was seen.
    """
    rng, known, twice = Random(1), 0, 0
    for _ in range(6000 if NIGHTLY else 500):
        family, lines = make(rng)
        (px, py), (dx, dy) = rng.choice(lines)
        height, start, stop = (
            Q(rng.randrange(-40, 9), 16),
            Q(rng.randrange(-9, 10), 4),
            Q(rng.randrange(-9, 10), 4),
        )
        if rng.random() < 0.5:
            # Across them, perhaps through the centre of a circle.
            dx, dy = -dy, dx
            height = Q(rng.randrange(-40, 20), 128)
        if start == stop:
            continue
        # Parallel to one of them.
        (ax, ay), (bx, by) = ((px + dx * k - dy * height, py + dy * k + dx * height) for k in (start, stop))
        way = WayImage(
            curve_image(Segment(Point(ax, ay), Point(bx, by))),
            (0.0, 0.0), (1.0, 1.0), (*map(float, (ax, ay, bx, by)), 0.0), [], [],
        )  # fmt: skip
        crossed = _crossed(family, way, [])
        if not crossed.is_known:
            continue
        known += 1
        wx, wy = bx - ax, by - ay
        turns = {wx * dy > wy * dx for _, (dx, dy) in lines}
        twice += len(turns) == 2
        for (x, y), (dx, dy) in lines:
            under = wx * dy - wy * dx
            if not under:
                continue
            u = ((x - ax) * dy - (y - ay) * dx) / under
            s = ((x - ax) * wy - (y - ay) * wx) / under
            if 0 <= u <= 1:
                assert (s > 0) - (s < 0) in (crossed.role, 0) and crossed.role
                low, high = sorted((crossed.first, crossed.last))
                assert low[0] <= u <= high[1]
    assert known > 150 and twice > (15 if make is tangents else 2)


def test_parts_of_families_are_seen_as_exact_lines_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    """An S of half circles whose joints lie on one line; some of its tangents meet the way behind itself."""
    part, compared = WayCrossings._role_of_part, 0

    def both(self: WayCrossings, family: LineFamily, t: fmpq, wanted: frozenset[int], told: object) -> object:
        nonlocal compared
        compared += told is not None
        role = part(self, family, t, wanted, told)
        assert role == self._role(family, t, wanted)
        return role

    monkeypatch.setattr(WayCrossings, "_role_of_part", both)
    letter = [("1.2", "1.6", 1), ("-.3", "-.4", -1), ("-.6", "-.8")]
    turned = [("-1.2", "-1.6", 1), (".3", ".4", -1), (".6", ".8")]
    bag = [(-1, "-4.9252"), (1, "-4.9252", "1/2"), ("1.48", "-4.2852"), ("1.1664", "-3.21", "1/2")]
    bag += [(".4176", "-2.9284"), ("-1.2688", "-4.0036", "3/4")]
    box = xa.Polygon([("-1.2", "2.85"), ("2.8", "2.85"), ("2.8", "3.85"), ("-1.2", "3.85")])
    for radius in (5, 10):
        scene = xa.Scene([xa.Outline(letter + turned), xa.Outline(bag), box], start=(-2, "-5.4252"))
        xa.audit(xa.sightseer(scene, radius), samples=12)
    for seed in some(range(40), 4):
        xa.seed_spreader(arc_scene(Subject.SEED_SPREADER, seed))
    assert compared > 50


@pytest.mark.parametrize("base", [(0, 3), (3, 3), (2, 5)])
def test_normals_of_an_irrational_way_have_the_order_of_their_heights(base: tuple[int, int]) -> None:
    """Through vertices and along circles; the base vector has these squared components."""
    rng, equal = Random(7), 0
    x, y = (Real(square).sqrt() for square in base)
    sector = Sliding((Real(2).sqrt(), Real(5).sqrt()), (x, y), Real(0), Real(1), leftward=True)
    events = []
    for _ in range(12):
        center = fmpq(rng.randint(-3, 3)), fmpq(rng.randint(-3, 3))
        side = rng.choice((-1, 0, 1))
        events.append((center, fmpq(rng.choice((1, 2, 4)) if side else 0), side, rng.choice((-1, 1))))
    for one, other in combinations(events, 2):
        a, b = sector.exact(*one), sector.exact(*other)
        assert a is not None
        assert b is not None
        order = a.compare(b)
        equal += order == 0
        assert sector.height(*one).compare(sector.height(*other)) == order
        assert sector.height_at(a).compare(sector.height(*one)) == 0
    assert equal or base == (2, 5)


@pytest.mark.parametrize("hole", [False, True])
@pytest.mark.parametrize("away", [False, True])
def test_a_normal_at_the_end_of_a_way_touches_the_circle_that_it_leads_to(hole: bool, away: bool) -> None:
    """The parameter of that normal, found from the circle, is the end's: it is taken, and not compared."""
    circle = xa.Circle((10, 0), 3)
    room = xa.Outline([(13, 0, xa.Around((10, 0))), (7, 0, xa.Around((10, 0)))])
    scene = xa.Scene([], enclosure=room) if hole else xa.Scene([circle])
    center, start = xa.Point(10, 0), xa.Point(Real(2).sqrt() + (8 if hole else 0), Real(5).sqrt() / 2)
    ray = start - center
    places = [start, center + ray * (3 / ray.norm_sq().sqrt())]
    sensor = Sensor(EdgeTable(scene.obstacles), Range(fmpq(9)))
    way = Segment(*(places[::-1] if away else places))
    (leg,) = legs_of(sensor.table, sensor.rails, None, way)
    normals = WayNormals(StraightWay(sensor.complex, leg), frozenset({0}), sensor._view)
    ((circle_number, sign), u), *others = normals._touching.items()
    assert not others and circle_number == 0
    assert u is (leg.span.low if away else leg.span.high)
    sector = Sliding(*((p.x, p.y) for p in (way.start, way.direction)), Real(0), Real(1), leftward=True)
    assert sector.exact((fmpq(10), fmpq(0)), fmpq(9), 1, sign) == u
    assert sector.exact((fmpq(10), fmpq(0)), fmpq(9), 1, -sign) != u


def test_an_end_on_a_concave_arc_is_what_the_way_leads_to_and_not_what_its_line_meets_ahead() -> None:
    """The line of a chord leaves a round room in two places: in one of them against the way."""
    room = xa.Circle((0, 0), 10)
    scene = xa.Scene([xa.Circle((0, -7), 1)], enclosure=room)
    sensor = Sensor(EdgeTable(scene.obstacles), Range(fmpq(20)))
    way = Segment(xa.Point(-6, -8), xa.Point(2, -8))
    (leg,) = legs_of(sensor.table, sensor.rails, None, way)
    assert leg.touches
    (wall,) = sensor.table.edges_at(way.start)
    pins = StraightWay(sensor.complex, leg).clipper.views.pins
    behind = pins.get((OWN, wall, -1))
    assert behind is not None and behind[0] is way.start
    assert pins.get((OWN, wall, 1)) is None
