"""Numbers at a place with transcendental coordinates, and the map there."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction
from random import Random

import pytest
from flint import arb, ctx
from nightly import some
from strategies import degenerate_terrain, random_terrain

import exactacq as xa
from exactacq import Length, Point, Real, Undecided
from exactacq.geometry.curves import Arc, Segment
from exactacq.numbers.transcendental import transcendental

Q = Fraction
ROOT2 = Real(2).sqrt()


def e() -> Real:
    """Euler's number."""
    return transcendental(Real, lambda bits: arb(1).exp())


class TestNumbers:
    def test_identities_are_proved(self) -> None:
        t = e()
        assert ((t * t + 2 * t + 1).sqrt() - t - 1).sign() == 0
        assert (1 / t * t - 1).sign() == 0
        assert (t + ROOT2) * (t - ROOT2) == t * t - 2
        assert ((t + 1 / t + 2).sqrt() - (t + 1) / t.sqrt()).sign() == 0

    def test_a_copy_is_the_same_number(self) -> None:
        t = e() + ROOT2
        assert copy.deepcopy(t) == t and copy.deepcopy([t, t * t])[1] == t * t
        inside = xa.sightseer(xa.load("circles")).view_at(5).point
        assert pickle.loads(pickle.dumps(inside)) == inside

    def test_a_radical_that_takes_the_other_sign_is_none(self) -> None:
        t = e()
        assert (t * t - 6 * t + 9).sqrt() == 3 - t
        assert (t * t - 6 * t + 9).sqrt() != t - 3
        assert (t * t - 4 * t + 4).sqrt() == t - 2

    def test_what_is_not_0_has_a_sign_however_small(self) -> None:
        t = e()
        with ctx.workprec(4000):
            low, high = Real(t.enclosure(3000)[0]), Real(t.enclosure(3000)[1])
        assert low < t < high
        assert (t - low).sqrt() > 0
        assert t.sqrt() != low.sqrt()

    def test_two_such_numbers_are_compared_by_balls_only(self) -> None:
        assert e() < transcendental(Real, lambda bits: arb.pi())
        with pytest.raises(Undecided, match="several"):
            (e() - e()).sign()

    def test_there_is_a_decimal_for_it(self) -> None:
        assert str(e()).startswith("2.718281828459045235360287471")


class TestPlaces:
    def test_a_place_lies_on_its_circle(self) -> None:
        arc = Arc(Point(3, 4), Point(-3, -4), Point(0, 0), Q(25), ccw=True)
        place = arc.after(Length(2))
        assert place.x * place.x + place.y * place.y == 25
        assert place.x.rational is None
        with ctx.workprec(100):
            angle = arb.atan2(place.y.ball(100), place.x.ball(100)) - arb.atan2(arb(4), arb(3))
            assert (5 * angle).overlaps(arb(2))

    def test_a_place_on_a_segment_after_a_length_with_an_angle(self) -> None:
        quarter = Arc(Point(1, 0), Point(0, 1), Point(0, 0), Q(1), ccw=True).length
        place = Segment(Point(0, 0), Point(3, 4)).after(quarter)
        assert 4 * place.x == 3 * place.y
        assert abs(float(place.x) - 1.5707963267948966 * 3 / 5) < 1e-15

    def test_lengths_there_are_not_claimed_to_be_equal(self) -> None:
        arc = Arc(Point(1, 0), Point(-1, 0), Point(0, 0), Q(1), ccw=True)
        walked = arc.part(arc.start, arc.after(Length(2))).length
        assert Length("1.999999") < walked < Length("2.000001")
        with pytest.raises(Undecided, match="transcendental"):
            walked.compare(Length(2))


@pytest.mark.parametrize("make", [random_terrain, degenerate_terrain])
@pytest.mark.parametrize("seed", some([0, 1, 3, 5, 6], 2))
def test_the_map_after_any_length_lies_between_its_neighbours(make: object, seed: int) -> None:
    """What is known grows, and the places beside have rational parameters."""
    terrain, rng, beside = make(Random(seed)), Random(seed), Length("1e-9")
    run = xa.sightseer(terrain.scene(), terrain.radius)
    for _ in range(4):
        length = Length(Q(rng.randint(1, int(float(run.length) * 96)), 97))
        before, now, after = (
            run.map_at(moment) for moment in (run.near(length - beside), length, run.near(length + beside))
        )
        for i in range(len(run.scene.obstacles)):
            assert before.known_length(i) <= now.known_length(i) <= after.known_length(i)
            for part in before.known(i):
                assert now.knows(i, part.start)
                assert now.knows(i, part.end)


def test_closed_form_on_a_circle() -> None:
    # From a circle of radius 1 the robot sees, of its own, only what it has walked and its horizon.
    scene = xa.Scene([xa.Circle((0, 0), 1)], start=(-1, 0), radius=5)
    run = xa.sightseer(scene)
    for length in (1, 2, "7/2", 6):
        assert abs(float(run.map_at(length).known_length()) - float(Q(length))) < 1e-14


class TestFractionsOfCircles:
    """After a sum of angles alone the place is algebraic."""

    @pytest.mark.parametrize(
        ("part", "place"), [(2, (1, 0)), (4, (0, -1)), (3, (Q(1, 2), -Real(3).sqrt() / 2))]
    )
    def test_of_a_full_circle(self, part: int, place: tuple[object, object]) -> None:
        run = xa.sightseer(xa.Scene([xa.Circle((0, 0), 1)], start=(-1, 0), radius=5))
        _, point = run.moment(run.length / part)
        assert point == Point(*place)

    @pytest.mark.parametrize("times", [Q(1, 2), Q(3, 4), Q(1, 8), Q(2)])
    def test_of_an_angle(self, times: Fraction) -> None:
        long = Arc(Point(5, 0), Point(-5, 0), Point(0, 0), Q(25), ccw=True)
        angle = long.part(long.start, Point(4, 3)).length
        place = long.after(angle * Real(times))
        assert place.norm_sq() == 25
        assert long.part(long.start, place).length == angle * Real(times)

    def test_others_are_refused(self) -> None:
        arc = Arc(Point(5, 0), Point(-5, 0), Point(0, 0), Q(25), ccw=True)
        for share in (37, 101):
            with pytest.raises(ValueError, match="no coordinates"):
                arc.after(arc.length / share)
        with pytest.raises(ValueError, match="no coordinates"):
            arc.after(arc.part(arc.start, Point(4, 3)).length / 3)
