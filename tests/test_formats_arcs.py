"""What lies between a drawing and its loops: rational arcs with proven bounds, and stitching."""

from __future__ import annotations

import math
from itertools import pairwise
from random import Random

import mpmath
import pytest
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st

from exactacq.files.loops.assembly import default_tolerance
from exactacq.files.loops.chains import Chain, Corner, root_above, scientific_above
from exactacq.files.loops.cusps import open_cusps
from exactacq.files.loops.rational_arcs import arc_around, arc_corners, cosine_sine, simplest_between
from exactacq.files.loops.stitching import _least_turned, stitch
from exactacq.numbers.rationals import rational
from exactacq.scene.bends import Around

decimals = st.integers(-(10**9), 10**9).map(lambda n: fmpq(n, 10**6))
degrees = st.integers(-720 * 10**6, 720 * 10**6).map(lambda n: fmpq(n, 10**6))


def high(value: fmpq) -> mpmath.mpf:
    return mpmath.mpf(int(value.p)) / int(value.q)


def on_edge(a: Corner, b: Corner, s: object) -> mpmath.mpc:
    """The point of an edge at s of the parametrisation w = s / (s + (1 - s) exp(2 i atan b))."""
    p, q = mpmath.mpc(high(a.x), high(a.y)), mpmath.mpc(high(b.x), high(b.y))
    w = s / (s + (1 - s) * mpmath.expj(2 * mpmath.atan(high(a.bulge)))) if s else 0
    return p + (q - p) * w


@given(decimals, decimals, st.integers(1, 10**9).map(lambda n: fmpq(n, 10**6)), degrees, degrees)
def test_a_rational_arc_stays_within_its_proven_bound(
    x: fmpq, y: fmpq, r: fmpq, start: fmpq, end: fmpq
) -> None:
    corners = arc_corners((x, y), r, start, end)
    if corners is None:
        assert ((end - start) / 360).q == 1
        return
    with mpmath.workdps(60):
        included = high(end - start) % 360
        center, n = mpmath.mpc(high(x), high(y)), len(corners) - 1
        for k, (a, b) in enumerate(pairwise(corners)):
            bound = high(Chain("", [a, b], closed=True).moved())
            assert bound < 1e-13 * (abs(center) + high(r))
            turn = mpmath.radians(included) / n
            begin = mpmath.radians(high(start)) + k * turn
            p, q = (center + high(r) * mpmath.expj(t) for t in (begin, begin + turn))
            for i in range(9):
                s = mpmath.mpf(i) / 8
                w = s / (s + (1 - s) * mpmath.expj(turn / 2)) if s else 0
                exact = p + (q - p) * w
                assert abs(abs(exact - center) - high(r)) < 1e-40 * (abs(center) + high(r))
                assert abs(on_edge(a, b, s) - exact) <= bound


@given(
    st.lists(decimals, min_size=4, max_size=4),
    st.integers(-5000, 5000).map(lambda n: fmpq(n, 1000)),
    st.lists(st.integers(-1000, 1000).map(lambda n: fmpq(n, 10**4)), min_size=5, max_size=5),
)
def test_moving_ends_and_bulge_moves_no_point_beyond_the_bound(
    places: list[fmpq], bulge: fmpq, moves: list[fmpq]
) -> None:
    x, y, u, v = places
    shifts = [root_above(moves[i] ** 2 + moves[i + 1] ** 2) for i in (0, 2)]
    old = Corner(x, y, bulge), Corner(u, v, fmpq(0))
    new = (
        Corner(x + moves[0], y + moves[1], bulge + moves[4], shifts[0], abs(moves[4])),
        Corner(u + moves[2], v + moves[3], fmpq(0), shifts[1]),
    )
    bound = Chain("", list(new), closed=True).moved()
    with mpmath.workdps(40):
        for i in range(17):
            s = mpmath.mpf(i) / 16
            assert abs(on_edge(*new, s) - on_edge(*old, s)) <= high(bound) * (1 + mpmath.mpf(10) ** -20)


@given(degrees)
def test_cosine_and_sine_lie_within_their_error(angle: fmpq) -> None:
    (cosine, sine), error = cosine_sine(angle)
    with mpmath.workdps(60):
        assert (
            abs(high(cosine) - mpmath.cos(mpmath.radians(high(angle)))) <= high(error) + mpmath.mpf(10) ** -55
        )
        assert (
            abs(high(sine) - mpmath.sin(mpmath.radians(high(angle)))) <= high(error) + mpmath.mpf(10) ** -55
        )


def test_quarter_turns_and_semicircles_are_exact() -> None:
    assert [cosine_sine(fmpq(90 * k)) for k in range(-1, 5)] == [
        ((fmpq(c), fmpq(s)), fmpq(0)) for c, s in [(0, -1), (1, 0), (0, 1), (-1, 0), (0, -1), (1, 0)]
    ]
    corners = arc_corners((fmpq(3), fmpq(1)), fmpq(2), fmpq(90), fmpq(270))
    assert corners == [Corner(fmpq(3), fmpq(3), fmpq(1)), Corner(fmpq(3), fmpq(-1), fmpq(0))]
    assert arc_corners((fmpq(3), fmpq(1)), fmpq(2), fmpq(-30), fmpq(330)) is None


@given(st.fractions(0, 3, max_denominator=60), st.fractions(0, 1, max_denominator=60))
def test_the_simplest_fraction_has_the_least_denominator(low: object, width: object) -> None:
    left, right = rational(low), rational(low) + rational(width)
    found = simplest_between(left, right)
    assert left <= found <= right
    for q in range(1, int(found.q)):
        assert (left * q).ceil() > (right * q).floor()


@given(st.integers(1, 10**40), st.integers(1, 10**40))
def test_roots_from_above(p: int, q: int) -> None:
    value = fmpq(p, q)
    root = root_above(value)
    assert value <= root * root <= value * (1 + fmpq(1, 10**9)) ** 2
    assert float(scientific_above(root)) >= float(high(root)) * (1 - 1e-15)


# -- stitching ----------------------------------------------------------------------------------------


def star(rng: Random, n: int) -> list[tuple[fmpq, fmpq]]:
    """A star-shaped polygon of radius 1 to 2 with rational vertices."""
    angles = sorted(rng.sample(range(360), n))
    return [
        (
            fmpq(round(r * math.cos(math.radians(a)) * 1000), 1000),
            fmpq(round(r * math.sin(math.radians(a)) * 1000), 1000),
        )
        for a, r in ((a, rng.uniform(1, 2)) for a in angles)
    ]


@given(st.randoms(use_true_random=False), st.integers(3, 12))
def test_pieces_in_any_order_and_sense_give_the_loop(rng: Random, n: int) -> None:
    tolerance = fmpq(1, 1000)
    ring = star(rng, n)
    ring += [(x + 9, y) for x, y in star(rng, 5)]
    pieces = []
    for first, last in ((0, n), (n, n + 5)):
        bulges = [fmpq(rng.randint(-9, 9), 40) for _ in range(last - first)]
        k = first
        while k < last:
            step = min(rng.randint(1, 3), last - k)
            corners = [
                Corner(*ring[first + (i - first) % (last - first)], bulges[(i - first) % (last - first)])
                for i in range(k, k + step + 1)
            ]
            for end in (corners[0], corners[-1]):
                end.x += tolerance * rng.randint(-1, 1) / 4
            chain = Chain("piece", corners, order=k)
            chain.corners = chain.backwards() if rng.random() < 0.5 else corners
            pieces.append(chain)
            k += step
    rng.shuffle(pieces)
    whole = sum(p.edges for p in pieces)
    done = stitch(pieces, tolerance)
    assert sorted(len(loop.corners) for loop in done.loops) == sorted((n, 5))
    assert sum(loop.edges for loop in done.loops) == whole
    assert done.largest <= tolerance / 2
    assert not done.open_chains and not done.branches
    for loop in done.loops:
        for corner in loop.corners:
            least = min((corner.x - x) ** 2 + (corner.y - y) ** 2 for x, y in ring)
            assert least <= (tolerance / 4) ** 2
            assert corner.shift <= tolerance / 2


def test_the_default_tolerance_is_a_round_millionth() -> None:
    for size, value in [("284", "0.0001"), ("1", "1e-6"), ("0.99", "1e-7"), ("1e-9", "1e-15"), ("0", "0")]:
        assert default_tolerance(rational(size)) == rational(value)


def test_a_crossing_that_is_no_rounding_stays() -> None:
    loop = Chain(
        "loop",
        [
            Corner(fmpq(0), fmpq(0), fmpq(1, 4), bulge_shift=fmpq(1, 2**60)),
            Corner(fmpq(4), fmpq(1), fmpq(0)),
            Corner(fmpq(4), fmpq(0), fmpq(0)),
        ],
        closed=True,
    )
    before = [(c.x, c.y, c.bulge) for c in loop.corners]
    assert open_cusps(loop, fmpq(1, 10**6)) == 0
    assert [(c.x, c.y, c.bulge) for c in loop.corners] == before


def quarter(gap: fmpq) -> Chain:
    """A quarter disc as an open chain, whose ends are a gap apart; its arc has an irrational bulge."""
    zero, one = fmpq(0), fmpq(1)
    arc = arc_around((one, zero), (zero, one), (zero, zero), ccw=True)
    corners = [Corner(zero, zero, zero), arc, Corner(zero, one, zero), Corner(gap, zero, zero)]
    return Chain("quarter", corners)


def test_an_arc_stays_exact_while_its_ends_stay() -> None:
    (loop,) = stitch([quarter(fmpq(1, 10**9))], fmpq(1, 10**6)).loops
    assert loop.shape().vertices[1][2] == Around((0, 0))
    assert loop.moved() == fmpq(1, 10**9)
    walked = Chain("back", quarter(fmpq(0)).backwards())
    (back,) = stitch([walked], fmpq(1, 10**6)).loops
    assert -Around((0, 0)) in [bend for _, _, bend in back.shape().vertices]
    assert back.moved() == 0


def test_an_arc_whose_end_moves_has_a_bulge_within_the_bound() -> None:
    zero, one, gap = fmpq(0), fmpq(1), fmpq(1, 10**9)
    arc = arc_around((one, zero), (zero, one), (zero, zero), ccw=True)
    pieces = [
        Chain("lines", [Corner(zero, one + gap, zero), Corner(zero, zero, zero), Corner(one, zero, zero)]),
        Chain("arc", [arc, Corner(zero, one, zero)]),
    ]
    (loop,) = stitch(pieces, fmpq(1, 10**6)).loops
    (bulge,) = [bend for _, _, bend in loop.shape().vertices if bend]
    assert isinstance(bulge, fmpq) and abs(bulge + 1) ** 2 != 2
    assert abs((abs(bulge) + 1) ** 2 - 2) < fmpq(1, 2**45)
    assert gap <= loop.moved() <= 2 * gap


@pytest.mark.parametrize("power", [-12000, -400, -299, -17, -1, 0, 1, 2, 17, 299, 400, 12000])
@pytest.mark.parametrize("value", ["1", "9.9", "9.91", "2.65", "7/3"])
def test_bounds_are_told_in_two_digits_rounded_up(power: int, value: str) -> None:
    """Also of numbers with more digits than Python likes to write out, which transforms can make."""
    exact = rational(value) * fmpq(10) ** power
    digits, _, exponent = scientific_above(exact).partition("e")
    told = rational(digits) * fmpq(10) ** int(exponent or 0)
    assert exact <= told <= exact * fmpq(11, 10)
    assert len(digits.replace(".", "").strip("0")) <= 2


@given(st.lists(st.integers(0, 2), min_size=1, max_size=9))
def test_the_least_rotation(rows: list[int]) -> None:
    assert _least_turned(rows) == min(rows[i:] + rows[:i] for i in range(len(rows)))  # type: ignore[arg-type]


def test_a_loop_that_goes_back_on_itself_is_left_out() -> None:
    """A half circle there and back, as an exporter writes a round end: a scene refuses it."""

    def loop(*rows: tuple[object, object, object]) -> Chain:
        return Chain(f"loop of {len(rows)}", [Corner(*map(fmpq, row)) for row in rows], closed=True)

    lens = loop((0, 0, 1), (0, 4, fmpq(-1, 2)))
    back = [
        loop((0, 0, fmpq(9, 10)), (0, 4, fmpq(-9, 10))),
        loop((9, 0, 0), (12, 0, fmpq(1, 2)), (12, 3, fmpq(-1, 2)), (12, 0, 0)),
        loop((5, 5, 0), (6, 5, 0), (7, 5, 0), (6, 5, 0), (6, 8, 0), (6, 5, 0)),
    ]
    done = stitch([back[0], lens, *back[1:]], fmpq(1, 1000))
    assert done.loops == [lens] and done.flat == len(back) and done.inside == {lens.label}
