"""Where points lie in loops, against an oracle: crossings of oblique rays, to 1,000 digits (`moebius`).

Points lie on edges, at vertices and cusps, on the lines of edges, level with vertices, and 10^-9 to 10^-60
beside all these. Polygons are put to CGAL as well, where pyvispoly is installed.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple

import pytest
from drawn_curves import HAIRS, UNITS, Draw, Move, Vector, cells, library_point, moves, rational
from hypothesis import event, given
from hypothesis import strategies as st
from moebius import Image, Spot, is_zero, mp, number, place, turns
from nightly import examples

from exactacq import Outline, Scene
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.loops import locate, winding
from exactacq.geometry.points import Location, Point
from exactacq.scene.scene import Obstacle

Corner = tuple[Fraction, Fraction, Fraction]
"""A vertex and the bulge of the edge that follows."""


class Loop(NamedTuple):
    """A closed chain and how it is moved."""

    corners: tuple[Corner, ...]
    move: Move

    @property
    def moved(self) -> list[Corner]:
        spots = [self.move.spot(Spot(x, y)) for x, y, _ in self.corners]
        return [(spot.x, spot.y, b) for spot, (_, _, b) in zip(spots, self.corners, strict=True)]

    @property
    def images(self) -> list[Image]:
        places = [place(Spot(x, y)) for x, y, _ in self.moved]
        ends = places[1:] + places[:1]
        bulges = [number(b) for _, _, b in self.corners]
        return [Image.bulged(*edge) for edge in zip(places, ends, bulges, strict=True)]


def corners(*rows: Sequence[object]) -> tuple[Corner, ...]:
    return tuple((Fraction(x), Fraction(y), Fraction(b)) for x, y, b in rows)  # type: ignore[arg-type]


STILL = Move(Vector(Fraction(1), Fraction(0)), Vector(Fraction(0), Fraction(0)))
LOOPS: dict[str, tuple[Corner, ...]] = {
    "square": corners((0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)),
    "comb": corners(
        *((x, y, 0) for x, y in ((0, 0), (7, 0), (7, 3), (6, 1), (5, 3), (4, 1), (3, 3), (3, 2), (1, 2))),
        (1, 3, 0),
        (0, 3, 0),
    ),
    "disc of two halves": corners((-2, 0, 1), (2, 0, 1)),
    "crescent with cusps": corners((0, 0, 1), (4, 0, Fraction(-1, 2))),
    "arbelos, all cusps": corners((0, 0, 1), (6, 0, -1), (2, 0, -1)),
    "moon with a bite": corners((-3, 0, 1), (3, 0, 1), (1, 0, -1), (-1, 0, 0)),
    "leaf": corners((0, 0, Fraction(1, 3)), (5, 5, Fraction(1, 3))),
    "keyhole of more than half a circle": corners((-1, -1, 0), (1, -1, 0), (1, 0, 2), (-1, 0, 0)),
    "gear": corners(
        *((4 * k, 5 * (k % 2), Fraction(1, 9) if k % 3 else Fraction(-1, 8)) for k in range(24)),
        (93, -9, 0),
        (0, -9, 0),
    ),
    "bay": corners((0, 0, 0), (6, 0, 0), (6, 5, 0), (4, 5, -1), (2, 5, 0), (0, 5, 0)),
}


@cache
def sense(corners_: tuple[Corner, ...]) -> int:
    """1 for a counterclockwise loop, -1 for a clockwise one: by the area within chords."""
    places = [complex(image.at(mp.mpf(i) / 40)) for image in Loop(corners_, STILL).images for i in range(40)]
    doubled = sum((z.conjugate() * w).imag for z, w in pairwise([*places, places[0]]))
    return 1 if doubled > 0 else -1


def library_edges(loop: Loop) -> list[Curve]:
    rows = [(Point(rational(x), rational(y)), rational(b)) for x, y, b in loop.moved]
    following = [p for p, _ in rows[1:] + rows[:1]]
    return [
        Arc.from_bulge(p, q, b) if b else Segment(p, q) for (p, b), q in zip(rows, following, strict=True)
    ]


@cache
def obstacle(loop: Loop, enclosure: bool) -> Obstacle:
    shape = Outline([tuple(map(rational, corner)) for corner in loop.moved])
    return (Scene([], enclosure=shape) if enclosure else Scene([shape])).obstacles[0]


@st.composite
def chains(draw: Draw) -> Loop:
    """A closed chain that may cross and touch itself, on few cells."""
    count = draw(st.integers(2, 6))
    bulges = st.sampled_from([Fraction(n, 3) for n in (0, 0, 0, 1, -1, 3, -3, 6)])
    places: list[tuple[Fraction, Fraction]] = []
    for _ in range(count):
        others = [c for c in ((x, y) for x in range(-2, 3) for y in range(-2, 3)) if c not in places[-1:]]
        others = [c for c in others if len(places) < count - 1 or c != places[0]]
        places.append(draw(st.sampled_from(others)))
    return Loop(tuple((Fraction(x), Fraction(y), draw(bulges)) for x, y in places), draw(moves()))


loops = st.builds(Loop, st.sampled_from(list(LOOPS.values())), moves())


def on_edge(loop: Loop, k: int, t: Fraction) -> Vector:
    """A rational point of an edge, or of its circle for t outside [0, 1], before the loop is moved."""
    (ax, ay, b), (ex, ey, _) = loop.corners[k], loop.corners[(k + 1) % len(loop.corners)]
    start, end, turn = Vector(ax, ay), Vector(ex, ey), Vector(Fraction(1), -b) * Vector(Fraction(1), -b)
    turn = turn * (1 / (1 + b * b))
    top = start * (1 - t) + end * turn * t
    below = Vector(1 - t + turn.x * t, turn.y * t)
    return top * (below.x, -below.y) * (1 / below.square)


@st.composite
def asked(draw: Draw, places: st.SearchStrategy[Loop]) -> tuple[Loop, Spot]:
    """A loop and a point, related to it in some way."""
    loop = draw(places)
    k = draw(st.integers(0, len(loop.corners) - 1))
    x, y, _ = loop.corners[k]
    relation = draw(st.sampled_from(["edge", "vertex", "line", "chord", "level", "free", "irrational"]))
    hair = Vector(*draw(st.sampled_from(UNITS))) * draw(st.sampled_from(HAIRS))
    if relation == "edge":
        at = on_edge(loop, k, draw(st.sampled_from([Fraction(n, 7) for n in (1, 3, 4, 6)])))
    elif relation == "vertex":
        at = Vector(x, y)
    elif relation == "line":
        # Beyond the ends of an edge: on its line, or on the rest of its circle.
        at = on_edge(loop, k, draw(st.sampled_from([Fraction(-1, 3), Fraction(9, 7)])))
    elif relation == "chord":
        u, v, _ = loop.corners[(k + 1) % len(loop.corners)]
        share = draw(st.sampled_from([Fraction(n, 5) for n in (-1, 1, 2, 4, 6)]))
        at = Vector(x, y) + Vector(u - x, v - y) * share
    elif relation == "level":
        at = Vector(draw(cells) * Fraction(3, 2), y)
    else:
        at = Vector(draw(cells) * Fraction(5, 3), draw(cells) * Fraction(4, 3))
    spot = loop.move.spot((at + hair).spot)
    if relation == "irrational":
        q, toward = draw(st.sampled_from([2, 3, Fraction(1, 2)])), Vector(x, y) - at
        spot = loop.move.spot(Spot(*at, Fraction(q), *(toward * draw(st.sampled_from([1, Fraction(1, 2)])))))
    event(relation)
    return loop, spot


def check_winding(case: tuple[Loop, Spot]) -> None:
    """A chain winds round a point as often as it crosses the oracle's ray."""
    loop, spot = case
    expected = turns(loop.images, place(spot))
    assert winding(library_edges(loop), library_point(spot)) == expected
    backward = [edge.reversed() for edge in reversed(library_edges(loop))]
    assert winding(backward, library_point(spot)) == (None if expected is None else -expected)


def location(loop: Loop, count: int | None, enclosure: bool) -> Location:
    """What is blocked is within an obstacle, and outside a room."""
    if count is None:
        return Location.BOUNDARY
    assert count in (0, sense(loop.corners))
    return Location.INSIDE if bool(count) != enclosure else Location.OUTSIDE


def check_locate(case: tuple[Loop, Spot]) -> None:
    """An obstacle, a room, and a bare loop in both senses tell a point's place as the oracle does."""
    loop, spot = case
    point, edges, count = library_point(spot), library_edges(loop), turns(loop.images, place(spot))
    for enclosure in (False, True):
        where = location(loop, count, enclosure)
        event(where.name)
        assert obstacle(loop, enclosure).locate(point) is where
        ccw = not enclosure
        if (sense(loop.corners) > 0) != ccw:
            blocked_left = [edge.reversed() for edge in reversed(edges)]
        else:
            blocked_left = edges
        assert locate(blocked_left, point) is locate(blocked_left, point, ccw=ccw) is where
    z = place(spot)
    rows = obstacle(loop, False).edges
    held = {k for k, image in enumerate(loop.images) if image.holds(z)}
    found = obstacle(loop, False).edges_at(point)
    assert len(found) == len(held)
    for k in found:
        ends = {rows[k].start.xy, rows[k].end.xy}
        assert any({corner_xy(loop, i), corner_xy(loop, i + 1)} == ends for i in held)


def corner_xy(loop: Loop, k: int) -> tuple[float, float]:
    x, y, _ = loop.moved[k % len(loop.corners)]
    return float(x), float(y)


@examples(120)
@given(asked(chains()))
def test_chains_wind_as_often_as_they_cross_a_ray(case: tuple[Loop, Spot]) -> None:
    check_winding(case)


@examples(120)
@given(asked(loops))
def test_points_lie_where_the_oracle_says(case: tuple[Loop, Spot]) -> None:
    check_locate(case)


@pytest.mark.parametrize("name", LOOPS)
def test_every_vertex_and_what_is_level_with_it(name: str) -> None:
    """At each vertex, and beside it by a hair in eight directions, for the loop as it stands and far away."""
    for far in (0, 10**9):
        loop = Loop(
            LOOPS[name], Move(Vector(Fraction(1), Fraction(0)), Vector(Fraction(far), Fraction(-far)))
        )
        for x, y, _ in loop.corners[:6]:
            for dx, dy in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (2, 1)):
                hair = Fraction(1, 10**30)
                spot = loop.move.spot(Spot(x + dx * hair, y + dy * hair))
                where = location(loop, turns(loop.images, place(spot)), enclosure=False)
                assert obstacle(loop, False).locate(library_point(spot)) is where


def test_the_oracle_counts_turns_by_hand() -> None:
    """Twice round, not at all, once clockwise, on the chain; and an integral of the angle says the same."""
    twice = [Image.bulged(mp.mpc(p), mp.mpc(-p), mp.mpf(1)) for p in (2, -2, 3, -3)]
    for z, count in (
        (mp.mpc(0, 1), 2),
        (mp.mpc(0, mp.mpf(5) / 2), 1),
        (mp.mpc(4, 4), 0),
        (mp.mpc(0, 2), None),
    ):
        assert turns(twice, z) == count
    clockwise = [Image.bulged(mp.mpc(p), mp.mpc(-p), mp.mpf(-1)) for p in (1, -1)]
    assert turns(clockwise, mp.mpc(mp.mpf(1) / 10, mp.mpf(1) / 3)) == -1

    def angle(image: Image, z: Any) -> Any:
        return mp.quad(lambda t: mp.im(image.slope(t) / (image.at(t) - z)), [0, 1])

    chain = Loop(LOOPS["moon with a bite"], STILL)
    with mp.workdps(20):
        for z in (mp.mpc(2, -1), mp.mpc(0.25, 0.25), mp.mpc(0, 5), mp.mpc(-2, 0.5)):
            around = sum(angle(image, z) for image in chain.images) / (2 * mp.pi)
            assert abs(around - turns_exactly(chain, z)) < 1e-9


def turns_exactly(loop: Loop, z: Any) -> int:
    with mp.workdps(1000):
        count = turns(loop.images, mp.mpc(z))
    assert count is not None
    return count


@pytest.mark.parametrize("name", ["square", "comb"])
def test_polygons_as_cgal_has_them(name: str) -> None:
    peers: Any = pytest.importorskip("peers", reason="needs pyvispoly, an optional test dependency")
    cgal = pytest.importorskip("pyvispoly")
    loop = Loop(
        LOOPS[name], Move(Vector(Fraction(3, 5), Fraction(4, 5)), Vector(Fraction(10**9), Fraction(1, 3)))
    )
    ring = cgal.Polygon([peers.place((x, y)) for x, y, _ in loop.moved])
    for k, (x, y, _) in enumerate(loop.corners):
        places = [Vector(x, y), on_edge(loop, k, Fraction(2, 5)), on_edge(loop, k, Fraction(-1, 3))]
        for at in places:
            for hair in (0, Fraction(1, 10**30), Fraction(-1, 10**30)):
                spot = loop.move.spot((at + Vector(Fraction(2), Fraction(1)) * hair).spot)
                there = peers.place((spot.x, spot.y))
                where = (
                    Location.BOUNDARY if ring.on_boundary(there) else
                    Location.INSIDE if ring.contains(there) else Location.OUTSIDE
                )  # fmt: skip
                assert obstacle(loop, False).locate(library_point(spot)) is where


def test_a_full_circle_winds_once() -> None:
    """The only edge without ends: within, on, and beside it by a hair."""
    ring = Arc(Point(1, 0), Point(1, 0), Point(0, 0), rational(Fraction(1)), ccw=True, full=True)
    halves = [Image.bulged(mp.mpc(p), mp.mpc(-p), mp.mpf(1)) for p in (1, -1)]
    for x, y in ((0, 0), (Fraction(3, 5), Fraction(4, 5)), (-1, 0), (2, 0), (0, -1), (Fraction(1, 2), 0)):
        for hair in HAIRS:
            spot = Spot(Fraction(x) + hair, Fraction(y))
            expected = turns(halves, place(spot))
            assert winding([ring], library_point(spot)) == expected
            assert winding([ring.reversed()], library_point(spot)) == (
                None if expected is None else -expected
            )
    assert is_zero(place(Spot(Fraction(0), Fraction(0))))
