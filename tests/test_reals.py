"""Reals: laws of an ordered field, mpmath as oracle, planted near misses, nested ties, limits."""

from __future__ import annotations

import copy
import gc
import pickle
import random
import time
from collections.abc import Callable, Iterator
from decimal import Decimal
from fractions import Fraction
from functools import reduce
from math import ceil, floor, inf, isqrt, nextafter
from random import Random

import mpmath
import pytest
from flint import arb, fmpq
from hypothesis import given, settings
from hypothesis import strategies as st

from exactacq.errors import FormatError, Undecided
from exactacq.numbers import sign
from exactacq.numbers.atoms import Node
from exactacq.numbers.float_bounds import float_ball, rough
from exactacq.numbers.function_zeros import roots
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import ball_sign, nearest_float, rational, rational_sign, round_to_float
from exactacq.numbers.real import Real

ORACLE_BITS = 4400
# The expressions below have small height and degree: what is smaller than this is 0.
ORACLE_ZERO = mpmath.mpf(10) ** -1000

small = st.fractions(-9, 9, max_denominator=6)


def sqrt(value: object) -> Real:
    return Real(value).sqrt()


# -- random expressions: a tree that the library and mpmath evaluate separately --------------------

surds = st.tuples(st.just("surd"), small, st.integers(1, 12))
trees = st.recursive(
    surds,
    lambda inner: st.one_of(
        st.tuples(st.sampled_from(["+", "-", "*", "/"]), inner, inner), st.tuples(st.just("sqrt"), inner)
    ),
    max_leaves=4,
)
Tree = tuple  # ("surd", q, n) | (operation, tree, tree) | ("sqrt", tree)


def build(tree: Tree) -> Real:
    """The expression; a quotient by 0 is its numerator, and roots are taken of absolute values."""
    if tree[0] == "surd":
        return tree[1] * sqrt(tree[2])
    left = build(tree[1])
    if tree[0] == "sqrt":
        return abs(left).sqrt()
    right = build(tree[2])
    if tree[0] == "/":
        return left / right if right else left
    return left + right if tree[0] == "+" else left - right if tree[0] == "-" else left * right


def oracle(tree: Tree) -> mpmath.mpf:
    if tree[0] == "surd":
        return mpmath.mpf(tree[1].numerator) / tree[1].denominator * mpmath.sqrt(tree[2])
    left = oracle(tree[1])
    if tree[0] == "sqrt":
        # A root would make the rounding error of a hidden 0 visible.
        return mpmath.sqrt(abs(left)) if abs(left) > ORACLE_ZERO else mpmath.mpf(0)
    right = oracle(tree[2])
    if tree[0] == "/":
        return left / right if abs(right) > ORACLE_ZERO else left
    return left + right if tree[0] == "+" else left - right if tree[0] == "-" else left * right


def oracle_sign(value: mpmath.mpf) -> int:
    return 0 if abs(value) < ORACLE_ZERO else int(mpmath.sign(value))


@settings(max_examples=100)
@given(trees)
def test_enclosure_float_and_decimal_agree_with_the_oracle(tree: Tree) -> None:
    value = build(tree)
    low, high = value.enclosure(4096)
    assert high - low <= fmpq(1, 2) ** 4096
    with mpmath.workprec(ORACLE_BITS):
        expected, slack = oracle(tree), mpmath.mpf(2) ** -4100
        assert mpmath.mpf(int(low.p)) / int(low.q) - slack <= expected
        assert expected <= mpmath.mpf(int(high.p)) / int(high.q) + slack
        assert value.sign() == oracle_sign(expected)
        if oracle_sign(expected):
            assert float(value) == float(expected)
            assert abs(mpmath.mpf(value.decimal(60)) / expected - 1) < mpmath.mpf(10) ** -59
        else:
            assert float(value) == 0 and value.decimal(60) == "0"


@settings(max_examples=100)
@given(trees, trees)
def test_order_is_that_of_the_oracle_and_total(left: Tree, right: Tree) -> None:
    a, b = build(left), build(right)
    with mpmath.workprec(ORACLE_BITS):
        sign = oracle_sign(oracle(left) - oracle(right))
    assert a.compare(b) == sign == -b.compare(a)
    assert (a < b, a <= b, a == b, a >= b, a > b, a != b) == (
        sign < 0,
        sign <= 0,
        sign == 0,
        sign >= 0,
        sign > 0,
        sign != 0,
    )


@settings(max_examples=60)
@given(trees, trees, st.tuples(st.just("surd"), small, st.integers(1, 12)))
def test_field_laws(left: Tree, right: Tree, third: Tree) -> None:
    a, b, c = build(left), build(right), build(third)
    assert a + b == b + a and a * b == b * a
    assert (a + b) + c == a + (b + c) == Real.sum([c, b, a])
    assert (a + b) * c == a * c + b * c
    assert a - a == 0 and a + 0 == a and a * 1 == a
    assert abs(a).sqrt() ** 2 == abs(a)
    if b:
        assert a / b * b == a
        assert (a + c).compare(b + c) == a.compare(b)


@settings(max_examples=40)
@given(trees)
def test_copies_and_pickles_keep_value_and_structure(tree: Tree) -> None:
    value = build(tree)
    float(value)  # fills the cache of balls, which is not carried along
    for twin in (copy.copy(value), copy.deepcopy(value), pickle.loads(pickle.dumps(value))):
        assert twin.key == value.key and twin == value and str(twin) == str(value)


@pytest.mark.usefixtures("others_frozen")
def test_a_pickle_loads_where_its_atoms_are_gone() -> None:
    value = 1 / (sqrt(2) + sqrt(3) + sqrt(5) - (sqrt(2) + sqrt(3) + sqrt(5)).enclosure(700)[0])
    expected, data = value.decimal(30), pickle.dumps(value)
    del value
    gc.collect()
    assert float(pickle.loads(data)) == float(expected)
    low, high = pickle.loads(data).enclosure(20)
    assert low <= rational(pickle.loads(data).decimal(1000)) <= high


# -- input -----------------------------------------------------------------------------------------


def test_rational_reads_numbers_exactly() -> None:
    cases: dict[object, fmpq] = {
        "0.1": fmpq(1, 10),
        " -3/4 ": fmpq(-3, 4),
        "+.5": fmpq(1, 2),
        "5.": fmpq(5),
        "1.5e-3": fmpq(3, 2000),
        "1.5/2": fmpq(3, 4),
        0.1: fmpq(3602879701896397, 36028797018963968),
        Decimal("0.1"): fmpq(1, 10),
        Fraction(2, 6): fmpq(1, 3),
        7: fmpq(7),
    }
    for given_value, expected in cases.items():
        assert rational(given_value) == expected, given_value
    assert rational(sqrt(4)) == 2


NO_NUMBERS = [
    *["", "nan", "inf", "1/0", "1/-2", "0x10", "1 2", "1e9999999", "1e99999", "9" * 6000, "--1", "\u0663"],
    *[float("nan"), float("inf"), Decimal("NaN"), Decimal("1e999999999"), None, True, [1], 1j],
]


@pytest.mark.parametrize("text", NO_NUMBERS, ids=lambda text: ascii(text)[:12])
def test_rational_refuses_what_is_no_number(text: object) -> None:
    with pytest.raises(FormatError):
        rational(text)


def test_a_long_text_that_is_no_number_is_refused_at_once() -> None:
    """Its digits could be divided in many ways between both sides of a point that is not there."""
    started = time.perf_counter()
    with pytest.raises(FormatError):
        rational("1" * 4999 + "x")
    assert time.perf_counter() - started < 0.5


def test_refusals() -> None:
    with pytest.raises(ValueError, match="negative"):
        sqrt(sqrt(2) - 2)
    with pytest.raises(ZeroDivisionError):
        1 / (sqrt(8) - 2 * sqrt(2))
    hidden = sqrt(2 + sqrt(2)) * sqrt(2 - sqrt(2)) - sqrt(2)
    with pytest.raises(ZeroDivisionError):
        hidden / hidden
    with pytest.raises(ZeroDivisionError):
        Real(1) / 0
    with pytest.raises(TypeError):
        hash(sqrt(2))
    with pytest.raises(TypeError, match="cannot compare"):
        sqrt(2).compare("1")
    with pytest.raises(FormatError):
        rational(sqrt(2))
    assert sqrt(2) != "1" and hash(Real(3)) == hash(3)


def equality(left: object, right: object) -> tuple[bool, bool]:
    return left == right, left != right


def test_comparisons_with_numbers_that_are_not_finite() -> None:
    infinity, nan = float("inf"), float("nan")
    for value in (Real(1), sqrt(2), -Real(10**400)):
        for top in (infinity, Decimal("Infinity")):
            assert value < top and value <= top and not value > top and not value >= top
            assert equality(value, top) == (False, True) and value.compare(top) == -1
            assert value > -top and -top < value and value.compare(-top) == 1
        for odd in (nan, Decimal("NaN"), Decimal("sNaN")):
            assert equality(value, odd) == (False, True)
            assert not (value < odd or value <= odd or value > odd or value >= odd)
        with pytest.raises(ValueError, match="NaN"):
            value.compare(nan)
        with pytest.raises(FormatError):
            value + nan
    assert Real(10**400) > Decimal("1e399") and sqrt(2) < Decimal("1e400")


def test_bools_are_not_numbers() -> None:
    one = Real(1)
    assert equality(one, True) == (False, True)
    for operation in (lambda: one < True, lambda: one + True, lambda: True * one, lambda: one.compare(True)):
        with pytest.raises(TypeError):
            operation()


def test_floats_end_at_the_largest() -> None:
    assert float(Real(2) ** 1023 * sqrt(3)) == 3**0.5 * 2.0**1023
    for huge in (Real(10**400), -(10**400) * sqrt(2)):
        with pytest.raises(OverflowError, match="beyond the range of floats"):
            float(huge)
        assert huge.decimal(3) in ("1.00e+400", "-1.41e+400")
    assert float(Real("1e-400")) == 0.0 == float(sqrt(2) / 10**400)


# -- near misses -----------------------------------------------------------------------------------


@pytest.mark.parametrize("digits", [60, 300])
def test_planted_near_misses_are_told_apart(digits: int) -> None:
    gap = fmpq(1, 10**digits)
    surd, nested = sqrt(2) + sqrt(3) + sqrt(5), (sqrt(7) + (sqrt(2) + 3).sqrt()).sqrt()
    cubic = roots([-2, 0, 0, 1])[0]
    pairs = [
        (sqrt(2), sqrt(2 + gap)),
        (surd.enclosure(4 * digits)[0] - gap, surd),
        (surd, surd.enclosure(4 * digits)[1] + gap),
        (nested, (sqrt(7) + (sqrt(2) + 3 + gap).sqrt()).sqrt()),
        (nested * sqrt(3), (nested * nested * (3 + gap)).sqrt()),
        (cubic, (cubic**3 + gap) / cubic**2),
        (1 / (surd + gap), 1 / surd),
    ]
    for index, (smaller, larger) in enumerate(pairs):
        assert smaller < larger and not larger <= smaller, index
        assert smaller != larger, index


def test_nearly_equal_roots_are_separated() -> None:
    gap = fmpq(1, 10**60)
    centers = [fmpq(0), gap, 1 - gap, fmpq(1), 1 + gap]
    coefficients = reduce(
        lambda poly, c: [a - c * b for a, b in zip([fmpq(0), *poly], [*poly, fmpq(0)], strict=True)],
        centers,
        [fmpq(1)],
    )
    assert roots(coefficients) == centers
    low, high = roots([4 - gap, 0, -4, 0, 1])[2:]  # (x^2 - 2)^2 = gap
    assert low < sqrt(2) < high


def test_float_at_a_midpoint_goes_to_even() -> None:
    middle, tiny = 1 + fmpq(1, 2) ** 53, sqrt(2) / 10**300
    assert float(Real(middle)) == 1.0
    assert float(middle + tiny) == 1 + 2.0**-52
    assert float(middle - tiny) == 1.0
    hidden = ((sqrt(2) + sqrt(7)) ** 2 * (sqrt(3) + 1)).sqrt() - (sqrt(2) + sqrt(7)) * (sqrt(3) + 1).sqrt()
    assert hidden.rational is None and float(middle + hidden) == 1.0
    # Balls of 512 bits are wide, around other midpoints too, or around numbers beyond the floats.
    for power in (490, 1100, 6000):
        assert float(middle + hidden * 2**power) == 1.0 and float(hidden * 2**power) == 0.0


def test_floors_and_ceilings_are_those_of_the_number_itself() -> None:
    """No float tells such numbers from the integer beside them."""
    hidden, tiny = sqrt(2 + sqrt(2)) * sqrt(2 - sqrt(2)) - sqrt(2), sqrt(2) / 10**60
    for whole in (3, 0, -3):
        for value, steps in ((whole + hidden, (0, 0)), (whole + tiny, (0, 1)), (whole - tiny, (-1, 0))):
            assert (floor(value) - whole, ceil(value) - whole) == steps


def gaps(near: float) -> Iterator[tuple[float, Fraction]]:
    """The neighbours of a float, and half the way there."""
    for other in (nextafter(near, inf), nextafter(near, -inf)):
        yield other, (Fraction(other) - Fraction(near)) / 2


@pytest.mark.parametrize("near", [1.0, -1.0, 2.0**-300, 2.0**511, 1.5, 0.1, -1e-17, 5e-324, 2.0**-1022, 0.0])
@pytest.mark.parametrize("bits", [60, 62, 70, 130, 400])
def test_floats_are_nearest_however_wide_balls_are(near: float, bits: int) -> None:
    """Close to half the way to a neighbour, from balls that hold the number anywhere within."""
    for other, half in gaps(near):
        for side in (-1, 1):
            value = Fraction(near) + half * (1 + side * Fraction(1, 2**bits))
            for place in (-1, 0, 1):

                def ball(working: int, value: Fraction = value, place: int = place) -> arb:
                    radius = abs(value) / 2**working
                    middle = value + place * radius * Fraction(99, 100)
                    with workprec(working + 200):
                        return arb(fmpq(*middle.as_integer_ratio()), arb(fmpq(*radius.as_integer_ratio())))

                found = round_to_float(ball, lambda middle: False)
                assert found == (near if side < 0 else other)


@pytest.mark.parametrize(
    "size", [Fraction(0), Fraction(1, 2**1090), Fraction(3, 2**1076), Fraction(5, 2**1074)]
)
@pytest.mark.parametrize("sign", [1, -1])
def test_floats_of_what_is_hardly_more_than_0_need_no_proof(size: Fraction, sign: int) -> None:
    """Balls around 0, as those of a number that is 0 but not proved to be: they shrink below any float."""
    value = fmpq(*(sign * size).as_integer_ratio())

    def ball(bits: int) -> arb:
        with workprec(bits + 2200):
            return arb(value + fmpq(1, 3 * 2**bits), arb(fmpq(1, 2**bits)))

    assert round_to_float(ball, lambda middle: pytest.fail("asked for a proof")) == float(sign * size)


# -- ties ------------------------------------------------------------------------------------------


def test_permuted_sums_of_radicals_are_equal_at_once() -> None:
    rng = random.Random(64)
    parts = [rng.randint(1, 99) * sqrt(rng.randint(2, 10**9)) for _ in range(64)]
    spent = []
    for _ in range(5):
        left, right = Real.sum(parts), Real.sum(rng.sample(parts, 64))
        started = time.perf_counter()
        assert left == right
        spent.append(time.perf_counter() - started)
    assert left.key == right.key
    assert min(spent) < 1e-3


def test_nested_radicals_tie() -> None:
    a, b, c = sqrt(2), sqrt(3), sqrt(5)
    assert (5 + 2 * sqrt(6)).sqrt() == a + b
    assert (a + b).sqrt() * (b - a).sqrt() == 1
    assert ((a + b) ** 2 * (c + 1)).sqrt() == (a + b) * (c + 1).sqrt()
    assert (16 - 2 * sqrt(29) + 2 * (55 - 10 * sqrt(29)).sqrt()).sqrt() == (
        sqrt(5) + (11 - 2 * sqrt(29)).sqrt()
    )  # Borodin, Fagin, Hopcroft, Tompa
    assert 1 / ((a + 1).sqrt() + (b + 1).sqrt()) == ((b + 1).sqrt() - (a + 1).sqrt()) / (b - a)


def test_a_zero_that_hides_prints_as_zero() -> None:
    hidden = ((sqrt(2) + sqrt(7)) ** 2 * (sqrt(3) + 1)).sqrt() - (sqrt(2) + sqrt(7)) * (sqrt(3) + 1).sqrt()
    assert hidden.rational is None
    assert hidden.decimal(20) == "0" and str(float(hidden)) == "0.0"
    with pytest.raises(ZeroDivisionError):
        1 / hidden


def test_radicands_with_large_square_factors_are_the_same_radical() -> None:
    p, q = 2**89 - 1, 2**107 - 1  # neither factor is found by trial division
    left, right = sqrt(p * p * q), p * sqrt(q)
    assert left == right
    assert (left - right).sign() == 0
    assert 1 / (left + right) == right / (2 * p * p * q)


@settings(max_examples=100)
@given(trees, trees)
def test_balls_never_contradict_the_order(left: Tree, right: Tree) -> None:
    """What balls say of a sign or of two numbers is what comparing says, or nothing."""
    a, b = build(left), build(right)
    assert a.overlaps(b) == b.overlaps(a)
    assert a.overlaps(b) or a != b
    assert (a - b).clear_sign(64) in (0, (a - b).sign())
    for x in (a, b):
        if x.rational is not None:
            assert x.clear_sign(64) == x.sign()
    if a.rational is not None and b.rational is not None:
        assert a.overlaps(b) == (a == b)


def test_balls_leave_a_hidden_zero_open() -> None:
    hidden = ((sqrt(2) + sqrt(7)) ** 2 * (sqrt(3) + 1)).sqrt() - (sqrt(2) + sqrt(7)) * (sqrt(3) + 1).sqrt()
    assert hidden.sign() == 0
    assert hidden.clear_sign(256) == 0
    assert hidden.overlaps(Real(0))


@pytest.mark.parametrize(
    "factors", [(1, 1), (4, 1), (2, 3**4), (10**9 + 7, 5), (2**40, 3**21), (97**2, (10**12 + 39) ** 2)]
)
def test_square_factors_leave_the_radical(factors: tuple[int, int]) -> None:
    """Both parts of a fraction: what is left under the root is free of squares, and the square is right."""
    p, q = factors
    root = sqrt(Fraction(p, q))
    assert root * root == Real(Fraction(p, q))
    for atom in root.terms:
        assert all(int(atom) % (k * k) for k in range(2, 1000))


def test_roots_satisfy_their_polynomial() -> None:
    for coefficients in ([-2, 0, 0, 1], [1, -5, 0, 0, 0, 1], [6, -5, 1], [-1, -1, 1], [4, 0, -4, 0, 1]):
        found = roots(coefficients)
        assert found == sorted(found)
        for root in found:
            assert Real.sum(c * root**k for k, c in enumerate(coefficients)).sign() == 0
        with mpmath.workprec(200):
            expected = mpmath.polyroots(coefficients[::-1], maxsteps=500, extraprec=400)
            real = {round(float(r.real), 12) for r in expected if abs(mpmath.im(r)) < mpmath.mpf(10) ** -25}
        assert {round(float(r), 12) for r in found} == real
    assert roots([1, 0, 1]) == [] and roots([3]) == []
    with pytest.raises(ValueError, match="zero polynomial"):
        roots([0, 0])


def test_undecided_names_the_number(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sign, "ZERO_TEST_BITS", 300)
    monkeypatch.setattr(sign, "TRIAL_BITS", 300)
    left = ((sqrt(2) + sqrt(7)) ** 2 * (sqrt(3) + 1)).sqrt()
    right = (sqrt(2) + sqrt(7)) * (sqrt(3) + 1).sqrt()
    monkeypatch.setattr(sign, "TRIAL_BITS", 300)
    with pytest.raises(Undecided, match=r"0 to [0-9]+ decimals is 0: .*more than 300"):
        (left - right).sign()
    monkeypatch.undo()
    assert left == right
    assert left < right + fmpq(1, 10**70)


# -- closed form -----------------------------------------------------------------------------------


def test_undecided_where_a_divisor_is_tiny() -> None:
    """What a pickle brings has no balls yet: those of 2^16 bits cannot exclude that the divisor is 0."""
    total = Real.sum(roots([-n, -1, 0, 1])[0] for n in (2, 3, 5))
    data = pickle.dumps(1 / (total - total.enclosure(80_000)[0]))
    gc.collect()
    inverse = pickle.loads(data)
    with pytest.raises(Undecided, match="0 to"):
        ((inverse + 1) * (inverse - 1) - (inverse * inverse - 1)).sign()


def test_closed_forms() -> None:
    assert str(7 + 3 * sqrt(2)) == "3*sqrt(2) + 7"
    assert str(Real("1/2")) == "1/2" and repr(Real("1/2")) == "Real('1/2')"
    assert repr(sqrt(2)) == "<Real 1.41421356237310>"
    assert sqrt(2).latex() == r"\sqrt{2}"
    assert sqrt(2).decimal(30) == "1.41421356237309504880168872421"
    assert str((1 + sqrt(5)).sqrt()) == "sqrt(1 + sqrt(5))"
    assert Real("1/3").enclosure(5) == (fmpq(1, 3), fmpq(1, 3))


@settings(max_examples=30)
@given(trees)
def test_closed_form_has_the_same_value(tree: Tree) -> None:
    value = build(tree)
    with mpmath.workprec(300):
        assert abs(mpmath.mpf(str(value.sympy().evalf(50))) - oracle(tree)) < mpmath.mpf(10) ** -40


# -- what the library below rounds ------------------------------------------------------------------


@given(st.fractions(), st.integers(-1300, 1300), st.integers(0, 60))
def test_the_nearest_float_and_the_sign_of_a_rational(value: Fraction, power: int, bits: int) -> None:
    """Also of what is beyond the range of floats, or below the least one, or next to the middle of two."""
    value *= Fraction(2) ** power
    for near in (value, value + abs(value) / 2 ** (50 + bits), value - abs(value) / 2 ** (50 + bits)):
        q = fmpq(near.numerator, near.denominator)
        assert rational_sign(q) == (near > 0) - (near < 0)
        try:
            expected = float(near)
        except OverflowError:
            with pytest.raises(OverflowError, match="beyond the range of floats"):
                nearest_float(q)
        else:
            assert nearest_float(q) == expected


@pytest.mark.parametrize("value", ["1e-400", "-1e-310", "1.23456789e-320", "1e-200", "1/3", "0"])
def test_a_float_ball_holds_its_number_however_small(value: str) -> None:
    for number in (Real(value), Real(value) * sqrt(2)):
        near, error = float_ball(number)
        assert abs(number - near) <= error <= 2.0**-50 * max(abs(near), 1e-200)


@pytest.mark.parametrize("near", [rough, float, lambda value: float_ball(value)[0]])
def test_floats_of_what_a_tiny_number_divides(near: Callable[[Real], float]) -> None:
    """What a pickle brings has no balls yet: those of 64 bits cannot exclude that the divisor is 0."""
    total = Real.sum(sqrt(k) for k in (2, 3, 5))
    data = pickle.dumps(1 / (total - total.enclosure(300)[0]))
    gc.collect()
    assert near(pickle.loads(data)) == pytest.approx(1.3033518851450302e108, rel=1e-15)


@given(st.floats(allow_nan=False, allow_infinity=False), st.floats(0, 1e300))
def test_the_middle_and_the_sign_of_a_ball(middle: float, radius: float) -> None:
    ball = arb(middle, radius)
    assert float(ball) == float(ball.mid()) == middle
    at, reach = rational(middle), ball.rad().fmpq()  # no less than the radius that was asked for
    assert ball_sign(ball) == (at > reach) - (-at > reach)


@pytest.mark.parametrize("finer", [0, 1])
def test_a_product_is_one_node_however_fine_its_factors_are(finer: int) -> None:
    """Of two factors that differ by some 2^-66: their order in balls changes as one of them is refined."""
    rng = Random(1)
    for _ in range(60):
        below = rng.randrange(2**128, 2**130)
        one, other = (2 + Real(below).sqrt()).sqrt(), (3 + Real(below - 2 * isqrt(below)).sqrt()).sqrt()
        before = one * other
        (atom,) = (one, other)[finer].terms
        assert isinstance(atom, Node)
        atom.precise_ball(300)
        assert (Real.of_atom(atom) * (other, one)[finer]).key == before.key
