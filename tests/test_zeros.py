"""Views of one length along irrational ways: eliminated polynomials and floats as oracles, ties, limits."""

from __future__ import annotations

import json
import pickle
import random
import sys
from collections.abc import Callable
from math import hypot
from pathlib import Path
from typing import Any, TypeAlias

import mpmath
import pytest
from flint import arb, arb_series, ctx, fmpq

import exactacq as xa
from exactacq.errors import FormatError, Undecided
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers import function_zeros
from exactacq.numbers.function_zeros import Zero, roots, zero_between, zeros_between
from exactacq.numbers.number_json import Decoder, Encoder
from exactacq.numbers.real import Real
from exactacq.sensing.view_length import ViewLength, of_length_on
from exactacq.visibility.chords import chord_at, of_length
from exactacq.visibility.line_families import Rolling, Sector, Turning

DATA = Path(__file__).parent / "data"
TURNING = Turning((fmpq(0), fmpq(0)), (fmpq(1), fmpq(0)), fmpq(-1), fmpq(1))
ROLLING = Rolling((fmpq(0), fmpq(0)), (fmpq(0), fmpq(-1)), fmpq(0), fmpq(1))
"""Lines that start eastward below the unit circle, and turn counterclockwise."""
Change: TypeAlias = "Callable[[list[Any]], object]"
ROOT2 = Real(2).sqrt()
CUBIC = roots([-3, 1, 0, 1])[0]
"""1.2134..., of x^3 + x = 3"""


def circle(x: object, y: object, radius_sq: object, ccw: bool = True) -> Arc:
    end = Point(Real(x) + Real(radius_sq).sqrt(), y)
    return Arc(end, end, Point(x, y), fmpq(radius_sq), ccw, full=True)


def excess(sector: Sector, t: Real, behind: Curve, ahead: Curve, square: fmpq) -> Real:
    chord = chord_at(sector, t, behind, ahead)
    return (chord.end - chord.start).norm_sq() - square


def solutions(sector: Sector, behind: Curve, ahead: Curve, square: fmpq, low: Real, high: Real) -> list[Real]:
    """Oracle for rational curves: the roots of the eliminated polynomial that are no artefacts."""
    candidates = (t for t in of_length(sector, behind, ahead, square) if low < t < high)
    return [t for t in candidates if excess(sector, t, behind, ahead, square).ball(2000).contains(0)]


def fraction(rng: random.Random, low: int, high: int) -> fmpq:
    return fmpq(rng.randint(16 * low, 16 * high), 16)


def rational_view(rng: random.Random) -> tuple[Sector, Curve, Curve]:
    """A sector, a steep segment behind, and a segment, or a circle as a convex or concave wall, ahead."""
    behind = Segment(Point(fraction(rng, -4, -3), -20), Point(fraction(rng, -3, -2), 20))
    sector: Sector = rng.choice((TURNING, ROLLING))
    ahead: Curve = Segment(Point(fraction(rng, 2, 3), -20), Point(fraction(rng, 3, 4), 20))
    if rng.random() < 0.5:
        ahead = circle(fraction(rng, 3, 4), fraction(rng, -1, 0), 25, ccw=False)
    return sector, behind, ahead


class BesidePole:
    """-1 + e / (p - t): its zero is e before its pole p, and 1 - e/p of all the way from 0."""

    key, degree, height = "beside a pole", 1, 999.0

    def __init__(self, pole: fmpq, before: fmpq) -> None:
        self.pole, self.before = pole, before

    def __call__(self, t: object) -> object:
        if isinstance(t, Real):
            return Real(self.before) / (self.pole - t) - 1
        return arb(self.before) / (arb(self.pole) - t) - 1

    def sense(self, cell: arb) -> int:
        return 0


def test_a_family_narrower_than_a_cell_of_the_search() -> None:
    """Where an edge leaves a rounded corner at an angle of a, lines that roll on it see all of it within a^2.

    A drawing with angles of 10^-15 at its joints has such families (`mousebites.dxf`).
    """
    wide, before = fmpq(1, 2**101), fmpq(1, 2**212)
    (zero,) = zeros_between(BesidePole(wide + before / 8, before), Real(0), Real(wide))
    assert zero.enclosure(400)[0] <= wide - before * 7 / 8 <= zero.enclosure(400)[1]
    assert zeros_between(BesidePole(wide + before * 2, before), Real(0), Real(wide)) == []


class TestOracles:
    @pytest.mark.parametrize("seed", range(60))
    def test_the_eliminated_polynomial_has_the_same_roots(self, seed: int) -> None:
        rng = random.Random(seed)
        sector, behind, ahead = rational_view(rng)
        low, high = sorted((Real(fmpq(rng.randint(0, 99), 200)), Real(fmpq(rng.randint(0, 99), 200))))
        inside = fmpq(rng.randint(1, 30), 31)
        square = (excess(sector, low + (high - low) * inside, behind, ahead, fmpq(0))).enclosure(20)[0]
        expected = solutions(sector, behind, ahead, square, low, high)
        found = of_length_on(sector, behind, ahead, square, low, high)
        assert len(found) == len(expected)
        for one, other in zip(found, expected, strict=True):
            assert (one - other).ball(400).contains(0)
            assert (one - other).ball(400).rad() < 1e-90

    def test_lines_about_a_corner_on_the_circle_of_an_arc(self) -> None:
        way = Segment(Point(-2, -20), Point(-3, 20))
        arc = circle(2, 0, 4, ccw=False)
        expected = solutions(TURNING, way, arc, fmpq(41), Real(-1), Real(1))
        found = of_length_on(TURNING, way, arc, fmpq(41), Real(-1), Real(1))
        assert len(found) == len(expected) > 0
        assert all((a - b).ball(400).contains(0) for a, b in zip(found, expected, strict=True))

    @pytest.mark.parametrize("seed", range(20))
    def test_irrational_ways_against_sampled_lengths(self, seed: int) -> None:
        rng = random.Random(seed)
        sector: Sector = rng.choice((TURNING, ROLLING))
        way = Segment(
            Point(-ROOT2 * fraction(rng, 2, 3), -20), Point(-CUBIC * fraction(rng, 2, 3) - ROOT2.sqrt(), 20)
        )
        ahead: Curve = Segment(Point(fraction(rng, 2, 3), -20), Point(fraction(rng, 3, 4), 20))
        if rng.random() < 0.5:
            ahead = circle(fraction(rng, 3, 4), fraction(rng, -1, 0), 25, ccw=False)
        low, high = Real(0), CUBIC / 3

        def length(t: float) -> float:
            chord = chord_at(sector, Real(t), Segment(Point(*way.start.xy), Point(*way.end.xy)), ahead)
            (ax, ay), (bx, by) = chord.start.xy, chord.end.xy
            return hypot(ax - bx, ay - by)

        steps = [k / 40 * float(high) for k in range(41)]
        lengths = [length(t) for t in steps]
        radius = fmpq(*(0.63 * min(lengths) + 0.37 * max(lengths)).as_integer_ratio())
        found = of_length_on(sector, way, ahead, radius * radius, low, high)
        changes = [
            t
            for t, a, b in zip(steps, lengths, lengths[1:], strict=False)
            if (a > float(radius)) != (b > float(radius))
        ]
        assert len(found) == len(changes)
        for t, at in zip(found, changes, strict=True):
            assert 0 <= float(t) - at <= float(high) / 40
            assert abs(excess(sector, t, way, ahead, radius * radius).ball(400)) < 1e-80


class TestRoots:
    """Verticals at -sqrt 2 and 3 seen from between: (3 + sqrt 2)^2 (1 + t^2) is least at t = 0."""

    way = Segment(Point(-ROOT2, -5), Point(-ROOT2, 5))
    wall = Segment(Point(3, -5), Point(3, 5))

    def at(self, square: object, low: object = -1, high: object = 1) -> list[Real]:
        return of_length_on(TURNING, self.way, self.wall, fmpq(square), Real(low), Real(high))

    def test_no_one_and_two_roots(self) -> None:
        assert self.at(19) == []
        first, last = self.at(20)
        assert [float(t) for t in self.at(20, low=0)] == [float(last)]
        assert float(first) == -float(last)

    def test_decimals(self) -> None:
        with mpmath.workdps(80):
            expected = mpmath.sqrt(20 / (3 + mpmath.sqrt(2)) ** 2 - 1)
            assert self.at(20)[1].decimal(50) == mpmath.nstr(expected, 50)
            assert str(self.at(20)[1]).startswith(mpmath.nstr(expected, 25)[:-1])

    def test_an_end_at_the_very_root_is_none_strictly_between(self) -> None:
        root = (20 / (3 + ROOT2) ** 2 - 1).sqrt()
        assert self.at(20, low=root) == []
        assert self.at(20, low=-root, high=root) == []
        assert len(self.at(20, low=root - fmpq(1, 10**60))) == 1
        assert self.at(20, low=root + fmpq(1, 10**60)) == []
        assert len(self.at(20, low=0, high=root + fmpq(1, 10**60))) == 1
        assert self.at(20, low=0, high=root - fmpq(1, 10**60)) == []

    def test_a_dyadic_root_is_found_as_a_rational(self) -> None:
        wall = Segment(Point(ROOT2, -5), Point(ROOT2, 5))
        found = of_length_on(TURNING, self.way, wall, fmpq(10), Real(-1), Real(1))
        assert [t.rational for t in found] == [fmpq(-1, 2), fmpq(1, 2)]
        assert of_length_on(TURNING, self.way, wall, fmpq(10), Real(fmpq(-1, 2)), Real(fmpq(1, 2))) == []

    def test_a_double_root_is_undecided(self) -> None:
        wall = Segment(Point(ROOT2, -5), Point(ROOT2, 5))
        with pytest.raises(Undecided, match=r"through \(0, 0\).*range 2\.828"):
            of_length_on(TURNING, self.way, wall, fmpq(8), Real(-1), Real(1))

    def test_roots_near_a_double_root_are_told_apart(self) -> None:
        wall = Segment(Point(ROOT2, -5), Point(ROOT2, 5))
        gap = fmpq(1, 10**30)
        found = of_length_on(TURNING, self.way, wall, 8 + gap, Real(-1), Real(1))
        assert [float(t) for t in found] == pytest.approx([-(0.125e-30**0.5), 0.125e-30**0.5])
        assert of_length_on(TURNING, self.way, wall, 8 - gap, Real(-1), Real(1)) == []

    def test_the_view_at_a_root_is_as_long_in_every_form(self) -> None:
        """A robot halts where it sees just as far as the range, and later asks from there how far that is.

        The numbers of its way have so high a degree that no zero test of the numbers themselves would end.
        """
        way = Segment(Point(-ROOT2 - CUBIC, -5), Point(-CUBIC.sqrt() - Real(3).sqrt(), 5))
        tilted = Segment(Point(2, -5), Point(3, 7))
        for ahead, square in ((self.wall, 34), (tilted, 31)):
            t, _ = of_length_on(TURNING, way, ahead, fmpq(square), Real(-1), Real(1))
            place = chord_at(TURNING, t, way, ahead).start
            # The line goes on from the place through the corner in the origin.
            share = (ahead.start - place).cross(ahead.direction) / (-place).cross(ahead.direction)
            length = place.norm_sq() * share * share
            assert length.compare(Real(square)) == 0 == Real(square).compare(length)
            assert length.compare(Real(square) + fmpq(1, 10**60)) == -1
            with pytest.raises(Undecided):
                # What no ball tells apart is not called equal for being close.
                length.compare(Real(square) + fmpq(1, 10**25_000))

    def test_a_way_that_touches_the_circle_on_which_lines_roll(self) -> None:
        # The tangent of the unit circle at 45 degrees (t = tan 67.5 degrees, counted from below: a high end
        # of a sector that starts there) meets the line through angle t; behind stands a wall.
        half = ROOT2 / 2
        way = Segment(Point(half, -half), Point(half + 4, -half + 4))
        low = ROOT2 - 1  # tan 22.5 degrees: the way's own line touches at -45 degrees
        wall = Segment(Point(-3, -20), Point(-3, 20))
        assert ROLLING.touch(low)[0] == way.start
        lines = low, Real(fmpq(9, 10))
        mirrored = of_length_on(ROLLING, way, way, fmpq(1), *lines)
        assert mirrored == []  # a view between two points of one line
        near, far = (excess(ROLLING, Real(t), wall, way, fmpq(0)) for t in (fmpq(1, 2), fmpq(7, 10)))
        for square in (near.enclosure(8)[0], far.enclosure(8)[0]):
            (t,) = of_length_on(ROLLING, wall, way, square, *lines)
            assert abs(excess(ROLLING, t, wall, way, square).ball(400)) < 1e-80
            assert of_length_on(ROLLING, wall, way, square, *lines, way)[0].key == t.key

    def test_lines_that_touch_an_arc_at_an_end(self) -> None:
        # The line through the origin with slope 3 / 4 touches the circle about (5, 0) with radius 3.
        arc = circle(5, 0, 9)
        found = of_length_on(TURNING, self.way, arc, fmpq(20), Real(fmpq(-3, 4)), Real(fmpq(3, 4)))
        assert [float(t) for t in found] == pytest.approx([-float(found[1]), float(found[1])])
        assert abs(excess(TURNING, found[1], self.way, arc, fmpq(20)).ball(400)) < 1e-80

    @pytest.mark.parametrize("far", [True, False])
    @pytest.mark.parametrize("square", [81, 64, 80, 82, fmpq(823, 20)])
    def test_a_view_along_a_line_that_touches_an_arc_is_as_long(self, square: object, far: bool) -> None:
        """The tangent from the origin, 4 long, goes on for 5 behind it: there the slope is infinite."""
        arc, way = circle(5, 0, 9, ccw=not far), Segment(Point(-4, -3), Point(-4 - ROOT2, 7))
        way = Segment(way.start - 2 * way.direction, way.end)
        last = fmpq(3, 4)
        found = of_length_on(TURNING, way, arc, fmpq(square), Real(0), Real(last))
        samples = [*(last * k / 400 for k in range(400)), last - fmpq(1, 10**12)]
        signs = [excess(TURNING, Real(t), way, arc, fmpq(square)).sign() for t in samples]
        changes = [t for t, a, b in zip(samples[1:], signs, signs[1:], strict=False) if a != b]
        assert len(found) == len(changes)
        for t, after in zip(found, changes, strict=True):
            assert float(after - last / 400) <= float(t) <= float(after)
            assert abs(excess(TURNING, t, way, arc, fmpq(square)).ball(400)) < 1e-80


class TestNumbers:
    def root(self, low: object = 0, high: object = 1) -> Real:
        (t,) = of_length_on(TURNING, TestRoots.way, TestRoots.wall, fmpq(20), Real(low), Real(high))
        return t

    def test_one_zero_is_one_number_however_it_is_found(self) -> None:
        assert self.root().key == self.root(fmpq(1, 50), fmpq(99, 100)).key
        assert (self.root() - self.root(low=-1 + fmpq(99, 100))).rational == 0
        assert self.root() * 2 - self.root() == self.root(fmpq(1, 7))

    def test_signs_beside_it(self) -> None:
        t = self.root()
        below, above = t.enclosure(1000)
        assert below < t < above
        assert (t * t - above * above).sign() == -1
        assert ((t + ROOT2) / (below + ROOT2) - 1).sign() == 1
        assert t.sqrt() < Real(above).sqrt()

    def test_ties_with_other_expressions_are_decided_as_far_as_the_bounds_allow(self) -> None:
        assert self.root() == (20 / (3 + ROOT2) ** 2 - 1).sqrt()
        many = sum((Real(p).sqrt() for p in (3, 5, 7, 11, 13, 17, 19)), ROOT2)
        way = Segment(Point(-many, -5), Point(-many, 5))
        (t,) = of_length_on(TURNING, way, TestRoots.wall, fmpq(800), Real(0), Real(1))
        with pytest.raises(Undecided):
            t.compare((800 / (3 + many) ** 2 - 1).sqrt())

    def test_balls_are_as_fine_as_asked_for(self) -> None:
        t = self.root()
        for bits in (64, 300, 5000):
            assert t.ball(bits).rel_accuracy_bits() > bits - 60
            assert t.ball(bits).overlaps((20 / (3 + ROOT2) ** 2 - 1).sqrt().ball(bits))

    def test_pickles_and_names(self) -> None:
        t = self.root()
        assert pickle.loads(pickle.dumps(t)).key == t.key
        assert "0.162529" in repr(t)

    def test_bounds_hold_for_a_zero_that_is_known(self) -> None:
        t, known = self.root(), (20 / (3 + ROOT2) ** 2 - 1).sqrt()
        ((node, degree),) = t.generators()
        assert isinstance(node, Zero)
        assert degree >= 4
        assert t.height_bound() >= known.height_bound()

    def test_comes_back_from_json(self) -> None:
        t, (document, number) = self.root(), written(self.root())
        again = Decoder(document, ViewLength.of_parts).number(number)
        assert again.key == t.key
        assert (again * again).compare(t * t) == 0

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            (lambda zero: zero[1].pop(), "no parts"),
            (lambda zero: zero[1].extend(8 * [["line"]]), "few parts"),
            (lambda zero: zero[1][1].pop(), "no parts"),
            (lambda zero: zero[1][0].__setitem__(0, "line"), "no parts"),
            (lambda zero: zero[1][1].__setitem__(0, "circle"), "no parts"),
            (lambda zero: zero.__setitem__(slice(2, 4), zero[3:1:-1]), "not one zero"),
            (lambda zero: zero.__setitem__(slice(2, 4), ["1/2", "3/4"]), "not one zero"),
            (lambda zero: zero.__setitem__(3, f"1/{1 << 5000}"), "moderate ends"),
        ],
    )
    def test_is_proved_again_when_it_is_read(
        self, change: Callable[[list[Any]], object], message: str
    ) -> None:
        document, _ = written(self.root())
        change(document[-1][0][1])
        with pytest.raises((FormatError, ValueError), match=message):
            Decoder(document, ViewLength.of_parts)


def written(value: Real) -> tuple[list[Any], Any]:
    """The table and the number of a JSON document."""
    out = Encoder()
    number = out.number(value)
    return json.loads(json.dumps(out.table)), number


class Sine:
    """sin(t): any analytic function with bounds will do."""

    key, parts, degree, height = "sine", (), sys.maxsize, float(1 << 40)

    def __call__(self, t: object) -> object:
        return t.sin()  # type: ignore[attr-defined]

    def sense(self, cell: arb) -> int:
        return 0


def test_zeros_of_any_function() -> None:
    first, second, third = zeros_between(Sine(), Real(fmpq(5, 2)), Real(11))
    with ctx.workprec(1000):
        assert first.ball(1000).overlaps(arb.pi())
        assert (second / 2).ball(1000).overlaps(arb.pi())
        assert (third / 3).ball(1000).overlaps(arb.pi())


class AtRational(Sine):
    """sin(pi t), whose value at a number nobody can tell from 0."""

    key = "at rational"

    def __call__(self, t: object) -> object:
        assert not isinstance(t, Real), "a proof that takes for ever"
        return (arb.pi() * t).sin()


def test_an_end_that_is_a_zero_is_asked_the_easy_way_where_a_cell_ends_there() -> None:
    """A view along the range's edge ended where a robot halted: it was asked of its numbers."""
    asked: list[Real] = []

    def sign_at(t: Real) -> int:
        asked.append(t)
        return 0

    high = Real(1)
    assert zeros_between(AtRational(), Real(fmpq(1, 2)), high, sign_at) == []
    assert all(t is high for t in asked) and asked


class Vague(Sine):
    """sin(t), with values that are no better known however many bits there are once its zeros are found."""

    key, is_vague = "vague sine", False

    def __call__(self, t: object) -> object:
        found = t.sin()  # type: ignore[attr-defined]
        return found + arb(0, 0.25) if self.is_vague and isinstance(found, arb) else found


def test_a_zero_that_cannot_be_refined_is_undecided() -> None:
    """Not a loop that doubles the precision for ever."""
    function = Vague()
    (zero,) = zeros_between(function, Real(3), Real(fmpq(7, 2)))
    function.is_vague = True
    with pytest.raises(Undecided, match="is 0 near 3"):
        zero.enclosure(40)


def test_a_side_through_the_corner_that_lines_turn_about() -> None:
    """Its height above the corner does not change with the lines: a series of it is a number."""
    corner, side, circle_ = ((*map(Real, numbers),) for numbers in ((0, 0, 1, 0, 1), (0, 0, 1, 1), (3, 0, 1)))
    parts = (("lines through a corner", corner), ("line", side), ("near crossing", circle_))
    with pytest.raises(ValueError, match="not one zero"):
        zero_between(ViewLength.of_parts(parts), fmpq(-1, 4), fmpq(1, 4))


class Stairs(Sine):
    """1, as is seen in balls below 2^-20 alone, and without a slope."""

    key = "stairs"

    def __call__(self, t: object) -> object:
        if not isinstance(t, arb):
            return arb_series([arb(0, 2), arb.nan()], prec=2)
        return arb(1) if t.rad() < arb(2) ** -20 else arb(0, 2)


def test_a_search_that_leads_nowhere_is_undecided() -> None:
    """Not one that looks at a million cells: it was bounded in depth alone."""
    with pytest.raises(Undecided, match="too close to 0"):
        zeros_between(Stairs(), Real(0), Real(1))


@pytest.mark.parametrize("name", ["pads_of_two_arcs", "pads_of_three_arcs"])
def test_arcs_of_nearly_one_circle_take_few_cells(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Circles drawn as arcs with 15 digits: lines roll on one arc and nearly touch the others.

    What was computed with cancellation told nothing of cells of 10^-23, of which millions were looked at.
    """
    cells, excludes = 0, function_zeros._excludes_zero

    def counted(*cell: Any) -> bool:
        nonlocal cells
        cells += 1
        return excludes(*cell)

    monkeypatch.setattr(function_zeros, "_excludes_zero", counted)
    run = xa.explore(xa.load(DATA / f"{name}.json"), "nearest-frontier")
    assert run.map.incomplete == () and 100 < cells < 1000


@pytest.mark.parametrize("off", ["1e-15", "2e-15", "-2e-15", "1e-12", "1e-40", "1e-60"])
def test_a_common_tangent_a_little_longer_than_the_range(off: str) -> None:
    """By 10^-31, as two circles of a drilling pattern are as far apart but for the last digit of a double.

    Where a line rolls on one of them up to that tangent, its view is as long as the range so near to the end
    that the square of the difference counts: it was sought down to 2^-106. Cells may jut out of where the
    function is real, and need the precision of the search when the zero is refined.
    """
    scene = xa.Scene([xa.Circle((0, 0), 3), xa.Circle((off, 10), 3)])
    way = xa.Segment(xa.Point(Real(off) + 3, 10), xa.Point(Real(37).sqrt() + 3, 8))
    swept = xa.sweep(scene, way, 10)
    assert len(swept.cells) == len(swept.events) + 1 > 1


@pytest.mark.parametrize("strategy", ["nearest-frontier", "sightseer"])
def test_two_holes_as_far_apart_as_the_range(strategy: str) -> None:
    holes = [xa.Circle((0, 0), 5), xa.Circle(("17.320508075688775", "9.999999999999998"), 5)]
    xa.audit(xa.explore(xa.Scene(holes, start=("3.66", "13.66")), strategy, 20))
