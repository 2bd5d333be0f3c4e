"""Lengths: laws of an ordered vector space, mpmath as oracle, planted near misses, real ties."""

from __future__ import annotations

import copy
import pickle
import random
import time
from collections.abc import Callable
from decimal import Decimal

import mpmath
import pytest
from flint import fmpq
from hypothesis import given, settings
from hypothesis import strategies as st
from nightly import examples

from exactacq.errors import FormatError, Undecided
from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.numbers.angles import _cosine_of_pi
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real

ORACLE_BITS = 4400
# A random sum of a few terms of small height that is below this is 0: the laws only need a referee.
ORACLE_ZERO = mpmath.mpf(10) ** -1000

Recipe = list[tuple[str, int, int, int, int]]


def sqrt(value: object) -> Real:
    return Real(value).sqrt()


def unit(half_tangent: object) -> tuple[fmpq, fmpq]:
    """The rational point of the unit circle at the angle 2 atan(half_tangent)."""
    u = rational(half_tangent)
    return (1 - u * u) / (1 + u * u), 2 * u / (1 + u * u)


def atan(q: object, coefficient: object = 1) -> Length:
    """atan(q) for q > 0 as an arc; its cosine and sine are irrational unless 1 + q^2 is a square."""
    q = rational(q)
    hypotenuse = sqrt(1 + q * q)
    return Length.arc(coefficient, 1 / hypotenuse, q / hypotenuse)


def acos(cosine: object, coefficient: object = 1, below: bool = False) -> Length:
    """The angle of a cosine in [0, pi], or its explement if *below* the axis."""
    cosine = Real(cosine)
    sine = (1 - cosine * cosine).sqrt()
    return Length.arc(coefficient, cosine, -sine if below else sine)


def product(a: tuple[object, object], b: tuple[object, object]) -> tuple[Real, Real]:
    (x, y), (u, v) = map(tuple, ((Real(t) for t in a), (Real(t) for t in b)))
    return x * u - y * v, x * v + y * u


# -- recipes: the same number for the library and for mpmath -------------------------------------

terms = st.one_of(
    st.tuples(
        st.just("number"), st.integers(-6, 6), st.sampled_from([1, 2, 3, 6, 8]), st.just(0), st.just(0)
    ),
    st.tuples(st.just("turn"), st.integers(-6, 6), st.sampled_from([1, 2, 3]), st.just(0), st.just(0)),
    # tan(angle / 2) from a small grid: many relations among these angles are true
    st.tuples(
        st.just("rational"),
        st.integers(-6, 6),
        st.sampled_from([1, 2, 3]),
        st.integers(-7, 7),
        st.integers(1, 7),
    ),
    # cosine (sqrt(k) - 1) / m, sine on either side
    st.tuples(
        st.just("surd"),
        st.integers(-6, 6),
        st.sampled_from([1, 2]),
        st.integers(2, 5),
        st.sampled_from([-2, 2]),
    ),
)
recipes = st.lists(terms, max_size=5)


def build(recipe: Recipe) -> Length:
    parts = []
    for kind, q, d, p, r in recipe:
        scale = q * sqrt(d)
        if kind == "number":
            parts.append(Length(scale / 4))
        elif kind == "turn":
            parts.append(Length.turns(scale, fmpq(1, 8)))
        elif kind == "rational":
            parts.append(Length.arc(scale, *unit(fmpq(p, r))))
        else:
            parts.append(acos((sqrt(p) - 1) / abs(r), scale, below=r < 0))
    return Length.sum(parts)


def oracle(recipe: Recipe) -> mpmath.mpf:
    mp = mpmath.mp
    total = mp.mpf(0)
    for kind, q, d, p, r in recipe:
        scale = q * mp.sqrt(d)
        if kind == "number":
            total += scale / 4
        elif kind == "turn":
            total += scale * mp.pi / 4
        elif kind == "rational":
            total += scale * ((2 * mp.atan2(p, r)) % (2 * mp.pi))
        else:
            angle = mp.acos((mp.sqrt(p) - 1) / abs(r))
            total += scale * (2 * mp.pi - angle if r < 0 else angle)
    return total


@settings(max_examples=60, deadline=None)
@given(recipes)
def test_enclosure_contains_the_oracle_and_is_as_narrow_as_asked(recipe: Recipe) -> None:
    low, high = build(recipe).enclosure(4096)
    assert high - low <= fmpq(1, 2) ** 4096
    with mpmath.workprec(ORACLE_BITS):
        value, slack = oracle(recipe), mpmath.mpf(2) ** -4200
        assert mpmath.mpf(int(low.p)) / int(low.q) - slack <= value
        assert value <= mpmath.mpf(int(high.p)) / int(high.q) + slack


@settings(max_examples=100, deadline=None)
@given(recipes, recipes)
def test_order_is_that_of_the_oracle_and_total(left: Recipe, right: Recipe) -> None:
    a, b = build(left), build(right)
    with mpmath.workprec(ORACLE_BITS):
        difference = oracle(left) - oracle(right)
    sign = 0 if abs(difference) < ORACLE_ZERO else int(mpmath.sign(difference))
    assert a.compare(b) == sign == -b.compare(a)
    assert (a < b, a <= b, a == b, a >= b, a > b, a != b) == (
        sign < 0,
        sign <= 0,
        sign == 0,
        sign >= 0,
        sign > 0,
        sign != 0,
    )
    assert (a - b).sign() == sign
    assert float(a) <= float(b) if sign <= 0 else float(a) >= float(b)


@settings(max_examples=40, deadline=None)
@given(recipes, recipes, recipes)
def test_sums_commute_associate_and_keep_the_order(left: Recipe, right: Recipe, shift: Recipe) -> None:
    a, b, c = build(left), build(right), build(shift)
    assert a + b == b + a == Length.sum([b, a])
    assert (a + b) + c == a + (b + c) == build(left + right + shift)
    assert (a + c).compare(b + c) == a.compare(b)
    assert (a * 3 - a) / 2 == a
    assert (a * fmpq(-2, 3)).compare(b * fmpq(-2, 3)) == b.compare(a)
    assert a - a == 0 and not a - a and 0 - (0 - a) == a and abs(a) >= 0


@settings(max_examples=40, deadline=None)
@given(recipes)
def test_float_is_correctly_rounded_and_decimal_agrees(recipe: Recipe) -> None:
    value = build(recipe)
    with mpmath.workprec(ORACLE_BITS):
        expected = oracle(recipe)
        if abs(expected) < ORACLE_ZERO:
            assert float(value) == 0 and value.decimal(30) == "0"
            return
        assert float(value) == float(expected)
        assert abs(mpmath.mpf(value.decimal(50)) / expected - 1) < mpmath.mpf(10) ** -49


@settings(max_examples=40, deadline=None)
@given(recipes)
def test_closed_form_has_the_same_value(recipe: Recipe) -> None:
    value = build(recipe)
    with mpmath.workprec(300):
        assert abs(mpmath.mpf(value.sympy().evalf(60)) - oracle(recipe)) < mpmath.mpf(10) ** -50
    assert str(value) == str(value.sympy())


def test_a_radicand_that_sympy_cannot_factor_has_a_closed_form() -> None:
    """It has two factors that are close; sympy 1.14 takes one for a prime, and ends in an error."""
    n = 10**60 - 9
    assert str(Length(Real(n).sqrt() / 3)) == f"sqrt({n})/3"


@settings(max_examples=25, deadline=None)
@given(recipes)
def test_copies_and_pickles_are_equal(recipe: Recipe) -> None:
    value = build(recipe)
    for twin in (copy.copy(value), copy.deepcopy(value), pickle.loads(pickle.dumps(value))):
        assert twin == value and str(twin) == str(value)


# -- near misses: equal to many digits, and still different --------------------------------------


def near_misses(gap: fmpq) -> list[tuple[Length, Length]]:
    """Pairs (smaller, larger) that differ by about *gap*."""
    arc = Length.arc(3, *unit("2/7"))
    low, high = arc.enclosure(1100)
    near_circle = sqrt(2) - 1
    return [
        (Length.turns(6), Length.turns(6) + gap),
        (Length.turns(6), Length.turns(6 + gap)),
        (Length(low - gap), arc),
        (arc, Length(high + gap)),
        (arc, Length.arc(3, *unit(fmpq(2, 7) + gap))),
        (arc + sqrt(2), Length.arc(3, *unit("2/7")) + sqrt(2 + gap)),
        (acos(near_circle + gap), acos(near_circle)),
        (acos(near_circle) + acos(-near_circle), Length.turns(1, fmpq(1, 2) + gap)),
        (
            4 * Length.arc(1, *unit("1/5")) - Length.arc(1, *unit(rational("1/239") + gap)),
            Length.turns("1/4"),
        ),
        (
            acos(near_circle, 2) + acos(near_circle + gap, 2, below=True) - gap * gap,
            Length.turns(2) + 4 * gap,
        ),
    ]


@pytest.mark.parametrize("digits", [60, 300])
def test_planted_near_misses_are_told_apart(digits: int) -> None:
    for index, (smaller, larger) in enumerate(near_misses(fmpq(1, 10**digits))):
        assert smaller < larger, index
        assert smaller != larger, index


def test_float_at_a_midpoint_is_decided() -> None:
    middle = 1 + fmpq(1, 2) ** 53
    tiny = Length.turns(fmpq(1, 10) ** 300)
    assert float(Length(middle)) == 1.0
    assert float(middle + tiny) == 1 + 2.0**-52
    assert float(middle - tiny) == 1.0
    # A full turn that cancels leaves the midpoint itself: the tie goes to even.
    hidden = 2 * acos(sqrt(2) - 1) - Length.arc(1, *product(unit_of(sqrt(2) - 1), unit_of(sqrt(2) - 1)))
    assert float(middle + hidden) == 1.0


def unit_of(cosine: Real) -> tuple[Real, Real]:
    return cosine, (1 - cosine * cosine).sqrt()


# -- ties ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "angle", [lambda q: Length.arc(1, *unit(q)) / 2, atan], ids=["rational", "algebraic"]
)
@pytest.mark.parametrize(
    "formula",
    [
        [(4, "1/5"), (-1, "1/239")],  # Machin
        [(2, "1/3"), (1, "1/7")],  # Hutton
        [(1, "1/2"), (1, "1/3")],  # Euler
        [(12, "1/18"), (8, "1/57"), (-5, "1/239")],  # Gauss
        [(44, "1/57"), (7, "1/239"), (-12, "1/682"), (24, "1/12943")],  # Stormer
    ],
    ids=["Machin", "Hutton", "Euler", "Gauss", "Stormer"],
)
def test_machin_like_formulas(angle: Callable[[str], Length], formula: list[tuple[int, str]]) -> None:
    total = Length.sum(angle(q) * m for m, q in formula)
    assert total == Length.turns(1, fmpq(1, 8))
    assert str(total) == "pi/4"
    assert total - fmpq(1, 10**100) < Length.turns(1, fmpq(1, 8))


def test_gaussian_relations_beyond_factoring() -> None:
    rng = random.Random(20)
    parts, whole, estimate = [], [], 0.0
    for radius in range(1, 6):
        a, b = (unit(fmpq(rng.randint(1, 10**40), rng.randint(1, 10**40))) for _ in range(2))
        parts += [Length.arc(radius, *a), Length.arc(radius, *b)]
        whole.append(Length.arc(radius, *product(a, b)))
        turns = float(parts[-1] + parts[-2] - whole[-1]) / 6.283185307179586 / radius
        whole.append(Length.turns(radius, round(turns)))
        estimate += turns
    assert Length.sum(parts) == Length.sum(whole)
    assert Length.sum(parts) != Length.sum(whole) + Length.arc(fmpq(1, 10**90), *unit(fmpq(1, 10**90)))


def test_radii_must_agree_for_a_relation_to_count() -> None:
    machin = [Length.arc(1, *unit("1/5")) * 2, Length.arc(1, *unit("1/239")) / -2]
    low, high = (Length.sum(machin) - machin[1] * 2).enclosure(300)
    scaled = machin[0] * sqrt(2) + machin[1] * sqrt(2)
    assert scaled == Length.turns(sqrt(2), fmpq(1, 8))
    assert machin[0] * sqrt(2) + machin[1] * sqrt(3) != Length.turns(sqrt(2), fmpq(1, 8))
    assert low < high


def test_two_arcs_of_one_circle_cancel_to_a_full_turn() -> None:
    for cosine in (fmpq(-3, 5), sqrt(2) - 1, (sqrt(2) - sqrt(3)) / 2, (sqrt(2) + 3).sqrt() / 3):
        arcs = acos(cosine, 5), acos(cosine, 5, below=True)
        assert arcs[0] + arcs[1] == Length.turns(5)
        assert str(arcs[0] + arcs[1] + 7) == "7 + 10*pi"
        assert acos(cosine) + acos(-Real(cosine)) == Length.turns(1, "1/2")


def test_two_arcs_equal_only_by_exact_comparison() -> None:
    # sqrt(5 + 2 sqrt 6) = sqrt 2 + sqrt 3, written so that the expressions differ.
    nested = ((sqrt(2) + sqrt(7)) ** 2 * (sqrt(3) + 1)).sqrt() / 9
    plain = (sqrt(2) + sqrt(7)) * (sqrt(3) + 1).sqrt() / 9
    assert nested.key != plain.key
    full = acos(nested, 2) + acos(plain, 2, below=True)
    assert full == Length.turns(2)
    assert str(full) == "4*pi"


def test_three_algebraic_arcs_add_to_a_full_turn() -> None:
    a, b = unit_of(sqrt(2) - 1), unit_of((sqrt(3) - 1) / 2)
    x, y = product(a, b)
    arcs = [Length.arc(3, *a), Length.arc(3, *b), Length.arc(3, x, -y)]
    for order in (arcs, arcs[::-1]):
        assert Length.sum(order) == Length.turns(3)
        assert str(Length.sum(order)) == "6*pi"


def test_mixed_relation_of_an_algebraic_and_a_rational_angle() -> None:
    whole = Length.arc(1, fmpq(24, 25), fmpq(7, 25))
    half = sqrt(2) / 10 * 7, sqrt(2) / 10
    cosine = ((1 + half[0]) / 2).sqrt()
    for part in (Length.arc(2, *half), acos(cosine, 4)):
        assert part == whole and part * sqrt(3) == whole * sqrt(3) and part * sqrt(3) > whole
        assert part + whole + acos(sqrt(2) - 1) == 2 * whole + acos(sqrt(2) - 1)


def test_regular_polygons_fold_to_pi() -> None:
    golden = (sqrt(5) - 1) / 4
    silver = (2 + sqrt(2)).sqrt() / 2
    named = {
        "pi/4": (sqrt(2) / 2, sqrt(2) / 2),
        "pi/6": (sqrt(3) / 2, fmpq(1, 2)),
        "2*pi/3": (fmpq(-1, 2), sqrt(3) / 2),
        "2*pi/5": (golden, (1 - golden * golden).sqrt()),
        "pi/8": (silver, (1 - silver * silver).sqrt()),
        "pi/12": ((sqrt(6) + sqrt(2)) / 4, (sqrt(6) - sqrt(2)) / 4),
        "3*pi/2": (0, -1),
        "pi": (-1, 0),
        "0": (1, 0),
    }
    for text, (cosine, sine) in named.items():
        assert str(Length.arc(1, cosine, sine)) == text
    x = y = (Real(1), Real(0))
    for _ in range(5):
        x = product(x, named["2*pi/5"])
    assert x == y


def test_permuted_sums_of_radicals_are_equal_at_once() -> None:
    rng = random.Random(64)
    radicals = [rng.randint(1, 99) * sqrt(rng.randint(2, 10**9)) for _ in range(64)]
    left, right = Length(Real.sum(radicals)), Length()
    for radical in rng.sample(radicals, 64):
        right = right + radical
    spent = []
    for _ in range(5):
        twin = pickle.loads(pickle.dumps(right))
        started = time.perf_counter()
        assert left == twin
        spent.append(time.perf_counter() - started)
    assert min(spent) < 1e-3


# -- a circle walked in pieces -----------------------------------------------------------------

CENTER = Point(fmpq(1, 3), -2)


def touching(radius_sq: fmpq, x: int, y: int, side: int) -> Point:
    """Where a tangent from the point CENTER + (x, y) touches the circle: nested unless radius is rational."""
    away = Point(x, y)
    reach = side * (Real(radius_sq) * (away.norm_sq() - radius_sq)).sqrt()
    return CENTER + (away * radius_sq + away.left() * reach) / away.norm_sq()


def facing(radius_sq: fmpq, x: int, y: int, side: int) -> Point:
    """The circle's point towards CENTER + (x, y), or the rational one that a unit vector gives."""
    away = Point(*unit(fmpq(x, y or 1))) if side < 0 else Point(x, y)
    return CENTER + away * sqrt(radius_sq) / away.norm_sq().sqrt()


def pieces(points: list[Point], radius_sq: fmpq) -> list[Arc]:
    """The circle once around, cut at the points, in the order of their angles."""

    def angle(point: Point) -> mpmath.mpf:
        offset = point - CENTER
        return mpmath.atan2(float(offset.y), float(offset.x))

    ring = sorted(points, key=angle)
    return [
        Arc(a, b, CENTER, radius_sq, True) for a, b in zip(ring, ring[1:] + ring[:1], strict=True) if a != b
    ]


distant = st.tuples(
    st.sampled_from([touching, facing]),
    st.integers(-30, 30).filter(lambda x: abs(x) > 5),
    st.integers(-30, 30),
    st.sampled_from([1, -1]),
)
squares = st.sampled_from([fmpq(9), fmpq(7), fmpq(5, 2), fmpq(25, 4)])


@examples(25)
@given(squares, st.lists(distant, min_size=2, max_size=24, unique=True), st.randoms(use_true_random=False))
def test_pieces_of_a_circle_add_to_a_full_turn(square: fmpq, where: list, rng: random.Random) -> None:
    arcs = pieces([make(square, x, y, side) for make, x, y, side in where], square)
    rng.shuffle(arcs)
    walked = [arc if rng.random() < 0.5 else arc.reversed() for arc in arcs]
    total, whole = Length.sum(arc.length for arc in walked), Length.turns(sqrt(square))
    assert total == whole
    assert total < Length.turns(sqrt(square) + fmpq(1, 10**60)) and total + fmpq(1, 10**60) > whole
    assert str(3 + total) == str(3 + whole)
    assert pickle.loads(pickle.dumps(total)) == whole
    # Without its largest piece the sum is what that piece lacks to the full turn.
    last = max(arcs, key=lambda arc: float(arc.length))
    rest = Length.sum(arc.length for arc in arcs if arc is not last)
    assert rest == whole - last.length
    assert rest == Arc(last.end, last.start, CENTER, square, True).length


def test_two_cuttings_of_a_circle_have_equal_sums() -> None:
    rng = random.Random(5)
    for square in (fmpq(7), fmpq(9)):

        def points(count: int, common: list[Point], square: fmpq = square) -> list[Point]:
            return common + [
                touching(square, rng.randint(6, 40), rng.randint(-40, 40), 1) for _ in range(count)
            ]

        a, b = points(2, [])
        walks = [pieces(points(20, [a, b]), square) for _ in range(2)]
        sums = []
        for walk in walks:
            first = next(k for k, arc in enumerate(walk) if arc.start is a)
            onward = walk[first:] + walk[:first]
            last = next(k for k, arc in enumerate(onward) if arc.end is b)
            sums.append(Length.sum(arc.length for arc in onward[: last + 1]))
        direct = Arc(a, b, CENTER, square, True).length
        assert sums[0] == sums[1] == direct
        assert sums[0] + Length.turns(fmpq(1, 10**50)) > sums[1]
        assert sums[0] * sqrt(2) + 1 == sqrt(2) * direct + 1


def test_pieces_meet_in_points_that_are_written_differently() -> None:
    square = fmpq(4, 9)
    nested = ((sqrt(2) + sqrt(7)) ** 2 * (sqrt(3) + 1)).sqrt() / 18
    plain = (sqrt(2) + sqrt(7)) * (sqrt(3) + 1).sqrt() / 18
    assert nested.key != plain.key

    def at(cosine: Real) -> Point:
        return CENTER + Point(cosine, (square - cosine * cosine).sqrt())

    # More than are left to LLL: each meeting point is one that ends a piece and one that starts the next.
    ring = pieces([at(nested * fmpq(k, 17)) for k in range(3, 17)], square)
    starts = [at(plain * fmpq(k, 17)) for k in range(16, 2, -1)]
    met = [arc.part(start, arc.end) for arc, start in zip(ring, starts, strict=True)]
    assert all(arc.start.key != twin.start.key for arc, twin in zip(ring, met, strict=True))
    assert Length.sum(arc.length for arc in met) == Length.turns(fmpq(2, 3))


def test_a_turned_circle_has_pieces_of_the_same_lengths() -> None:
    def turned(p: Point) -> Point:
        x, y = p - CENTER
        return CENTER + Point(fmpq(3, 5) * x - fmpq(4, 5) * y, fmpq(4, 5) * x + fmpq(3, 5) * y)

    square = fmpq(9)
    arcs = pieces([touching(square, x, 7, 1) for x in range(-30, 30, 3)], square)[:-1]
    twins = [Arc(turned(arc.start), turned(arc.end), CENTER, square, True) for arc in arcs]
    assert all(arc.length == twin.length for arc, twin in zip(arcs, twins, strict=True))
    assert Length.sum(arc.length for arc in arcs) == Length.sum(twin.length for twin in twins)


def test_nested_radicals_tie() -> None:
    assert Length((5 + 2 * sqrt(6)).sqrt()) + Length.turns(1) == sqrt(2) + sqrt(3) + Length.turns(1)
    left = ((sqrt(2) + 1) * (sqrt(3) + sqrt(5))).sqrt() ** 2
    assert Length(left) + atan("1/7") == Length((sqrt(2) + 1) * sqrt(3) + (sqrt(2) + 1) * sqrt(5)) + atan(
        "1/7"
    )


def test_undecided_names_the_comparison() -> None:
    x, y = c, s = unit_of(sqrt(2) - 1)
    for _ in range(6):
        x, y = product((x, y), (x, y))
    x, y = product((x, y), (c, s))  # 65 times the angle: one more than is proved by multiplication
    multiple, once = Length.arc(1, x, y), acos(c)
    turns = round(float(65 * once - multiple) / 6.283185307179586)
    with pytest.raises(Undecided, match=r"comparison of <Length .*> with <Length .*>.*neither proved"):
        assert multiple + Length.turns(1, turns) == 65 * once
    # Beside a rational number the same sum is transcendental, so that this is decided.
    assert multiple + Length.turns(1, turns) + fmpq(1, 10**500) > 65 * once


def test_thousands_of_pieces_add_in_linear_time() -> None:
    rng = random.Random(3)
    pieces = [Length.arc(rng.randint(1, 9), *unit(fmpq(rng.randint(1, 999), 1000))) + i for i in range(2000)]
    started = time.perf_counter()
    total = Length.sum(pieces)
    assert total == Length.sum(reversed(pieces))
    running = Length()
    for piece in pieces:
        running = running + piece
    assert running == total and running > 1999 * 1000
    assert time.perf_counter() - started < 2


# -- closed form, conversions and refusals -----------------------------------------------------


def test_closed_forms_as_a_person_writes_them() -> None:
    bulge = unit(2 * fmpq(1, 2) / (1 - fmpq(1, 4)))  # bulge 1/2: the angle is 4 atan(1/2)
    assert str(5 + Length.turns(6)) == "5 + 12*pi"
    assert str(Length(sqrt(18)) + 7) == "3*sqrt(2) + 7"
    assert str(Length.arc(3, *bulge)) == "12*atan(1/2)"
    assert str(Length.arc(1, fmpq(3, 5), fmpq(4, 5))) == "2*atan(1/2)"
    assert str(acos(fmpq(1, 3), sqrt(2))) == "sqrt(2)*acos(1/3)"
    assert str(acos(sqrt(2) - 1)) == "acos(-1 + sqrt(2))"
    assert str(atan("1/7", 2)) == "2*atan(1/7)"
    assert str(Length(fmpq(1, 2))) == "1/2" and repr(Length(fmpq(1, 2))) == "Length('1/2')"
    assert repr(Length.turns(1)) == "<Length 6.28318530717959>"
    assert Length.turns(6).latex() == r"12 \pi"
    assert Length.turns(1).decimal(30) == "6.28318530717958647692528676656"
    assert Length(7).enclosure(10) == (7, 7)


def test_degenerate_arcs() -> None:
    assert (
        Length.arc(3, 1, 0) == 0 == Length.turns(0) == Length.arc(0, fmpq(3, 5), fmpq(4, 5)) == Length.sum([])
    )
    assert Length.arc(2, -1, 0) == Length.turns(1)
    assert sum([Length(1), Length(2)]) == 3 and 4 - Length(1) == 3 and Length(sqrt(2)).algebraic == sqrt(2)
    assert Length.arc(-1, fmpq(3, 5), fmpq(4, 5)) < 0 < Length.arc(1, fmpq(3, 5), fmpq(-4, 5))


def test_refusals() -> None:
    with pytest.raises(ValueError, match="unit circle"):
        Length.arc(1, fmpq(3, 5), fmpq(3, 5))
    with pytest.raises(ValueError, match="unit circle"):
        Length.arc(1, sqrt(2), sqrt(3))
    with pytest.raises(TypeError, match="different forms"):
        hash(Length.turns(1))
    with pytest.raises(TypeError):
        Length.turns(1) < "7"  # noqa: B015
    with pytest.raises(TypeError):
        Length(1) * Length(2)
    with pytest.raises(ZeroDivisionError):
        Length(1) / 0
    with pytest.raises(TypeError, match="cannot compare"):
        Length(1).compare("1")
    assert Length(1) != "1"


def equality(left: object, right: object) -> tuple[bool, bool]:
    return left == right, left != right


def test_numbers_that_are_not_finite() -> None:
    infinity, nan = float("inf"), float("nan")
    for length in (Length(1), Length.turns(-1)):
        assert -infinity < length < infinity and length <= infinity and length > Decimal("-Infinity")
        assert equality(length, infinity) == (False, True) and length.compare(infinity) == -1
        for odd in (nan, Decimal("NaN"), Decimal("sNaN")):
            assert equality(length, odd) == (False, True)
            assert not (length < odd or length <= odd or length > odd or length >= odd)
        with pytest.raises(ValueError, match="NaN"):
            length.compare(nan)
        with pytest.raises(FormatError):
            length + infinity
        assert equality(length, True) == (False, True)
        with pytest.raises(TypeError):
            length < True  # noqa: B015
    with pytest.raises(OverflowError, match="range of floats"):
        float(Length.turns(10**400))


def test_cosines_of_many_turns() -> None:
    """Once the root of a polynomial was picked with balls too wide to tell roots apart."""
    share = fmpq(7, 30) + 1
    assert _cosine_of_pi(share + 2 * 10**80).compare(_cosine_of_pi(share)) == 0


def test_a_share_of_pi_is_found_whatever_cancels() -> None:
    """With k = 40 the first ball of the angle was too wide to propose a tenth of a turn."""
    little = (Real(2).sqrt() - 1) ** 40 * 2**51
    cosine = ((Real(5).sqrt() + 1) / 4 + little) ** 2
    cosine = cosine.sqrt() - little
    assert Length.arc(1, cosine, (1 - cosine**2).sqrt()) == Length.turns(1, "1/10")
