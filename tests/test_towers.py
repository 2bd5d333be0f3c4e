"""The field of a real: numbers in towers of square roots, over the rationals or the field of roots.

Ties are planted: a number is taken apart and put together in another way, and told from itself plus a hair.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from math import gcd

import mpmath
import pytest
from flint import arb, fmpq, fmpq_poly, fmpz
from hypothesis import given
from hypothesis import strategies as st

from exactacq.geometry.points import Point
from exactacq.numbers import number_field, sign, tower
from exactacq.numbers.atoms import Root
from exactacq.numbers.fields import RationalFunctions, Rationals
from exactacq.numbers.function_zeros import roots
from exactacq.numbers.number_field import NumberField
from exactacq.numbers.real import Real
from exactacq.numbers.tower import FormalTower, Tower, vanishes, vanishes_about
from exactacq.numbers.tower import _TooLong as TooLong
from exactacq.numbers.transcendental import generic_in, sign_at, transcendental

HAIR = Real(fmpq(1, 10**400))
SMALL = st.integers(-9, 9)
FIELDS = {
    "x^3 - 2": (-2, 0, 0, 1),
    "2x^3 - 4x + 1, three real roots": (1, -4, 0, 2),
    "x^4 - 10x^2 + 1, which holds sqrt(2)": (1, 0, -10, 0, 1),
    "3x^6 - x - 5": (-5, -1, 0, 0, 0, 0, 3),
}
HIGH = (-1, -1, *[0] * 8, 1)
"""x^10 - x - 1: no square roots are looked for in its field."""


def first_root(coefficients: tuple[int, ...]) -> Real:
    return roots(coefficients)[-1]


def is_tie(a: Real, b: Real) -> bool:
    """Whether two numbers are proved to be one, and to be apart once a hair is added."""
    assert vanishes(a - b + HAIR) is False
    return bool(vanishes(a - b))


# -- ties ------------------------------------------------------------------------------------------


@given(st.lists(st.tuples(SMALL, SMALL), min_size=1, max_size=3), st.sampled_from([2, 3, 7, 12]))
def test_the_root_of_a_square_is_found(parts: list[tuple[int, int]], base: int) -> None:
    """sqrt(x^2) = |x| for x = a + b t with t in ever higher fields: the radical adds nothing to the field."""
    x = Real(base).sqrt()
    for a, b in parts:
        x = a + b * (x * x + 1).sqrt()
    root = (x * x).sqrt()
    field = Tower((root - abs(x)).generators())
    assert not field.element(root - abs(x))
    assert len(field.squares) <= 1 + len(parts)


@given(st.tuples(SMALL, SMALL, SMALL), st.tuples(SMALL, SMALL))
def test_inverses_are_canonical(a: tuple[int, int, int], b: tuple[int, int]) -> None:
    """1 / x - 1 / y = (y - x) / (x y) in two forms, with nested roots in both denominators."""
    root, nested = Real(2).sqrt(), (3 + Real(2).sqrt()).sqrt()
    x, y = 30 + a[0] + a[1] * root + a[2] * nested, 30 + b[0] * root + b[1] * nested
    assert is_tie(1 / x - 1 / y, (y - x) / (x * y))


def test_radicands_that_depend_on_each_other() -> None:
    """Of sqrt(6), sqrt(10), sqrt(15) and sqrt(30) three determine the fourth, without any factoring."""
    values = [Real(d).sqrt() + (Real(d).sqrt() + 7).sqrt() for d in (6, 10, 15)]
    total = (values[0] * values[1] * values[2]).sqrt()
    again = (values[2] * values[0]).sqrt() * values[1].sqrt()
    field = Tower((total - again + Real(30).sqrt()).generators())
    assert is_tie(total, again)
    field.element(total - again + Real(30).sqrt())
    assert len([s for s, _ in field.radicals if isinstance(s, int)]) <= 3


@pytest.mark.parametrize("d", [5, 6, 7])
def test_a_line_meets_a_circle_in_a_point_known_before(d: int) -> None:
    """The line through (3, 1) and a point of the unit circle meets the circle there again."""
    x = (Real(d).sqrt() - 1) / 3
    y = (1 - x * x).sqrt()
    u, v = x - 3, y - 1
    square, along, off = u * u + v * v, 3 * u + v, Real(10 - 1)
    ends = [(sign * (along * along - square * off).sqrt() - along) / square for sign in (-1, 1)]
    hits = [(3 + s * u, 1 + s * v) for s in ends]
    assert [vanishes(p - x) and vanishes(q - y) for p, q in hits].count(True) == 1


@given(st.lists(st.integers(2, 40), min_size=2, max_size=4, unique=True))
def test_sums_of_independent_radicals_do_not_vanish(numbers: list[int]) -> None:
    value = Real.sum((Real(n) + Real(n + 1).sqrt()).sqrt() for n in numbers) - 40
    with mpmath.workdps(50):
        oracle = mpmath.fsum(mpmath.sqrt(n + mpmath.sqrt(n + 1)) for n in numbers) - 40
    assert abs(oracle) > 1e-30
    assert vanishes(value) is False


# -- over the field of a root ----------------------------------------------------------------------


@pytest.mark.parametrize("coefficients", FIELDS.values(), ids=FIELDS)
@given(st.data())
def test_square_roots_in_the_field_of_a_root(coefficients: tuple[int, ...], data: st.DataObject) -> None:
    field = NumberField(coefficients, 0)
    parts = data.draw(st.lists(SMALL, min_size=field.degree, max_size=field.degree))
    s = fmpq_poly(parts) / data.draw(st.integers(1, 9))
    square = field.times(s, s)
    assert field.square_root(square) in (s, -s)
    if s != 0:
        # -1 is no square in a field of reals, and norms of negatives are squares where the degree is even.
        assert field.square_root(-square) is None
        assert field.square_root(7 * square) is None


def test_a_root_of_an_integer_in_the_field_of_a_root() -> None:
    """a = sqrt(2) + sqrt(3): the field of its polynomial holds both, and 2 sqrt(2) = a^3 - 9 a."""
    a = first_root((1, 0, -10, 0, 1))
    assert is_tie(a**3 - 9 * a, Real(8).sqrt())
    assert is_tie((a + 5).sqrt() * (Real(2).sqrt() - 1), ((a + 5) * (3 - Real(8).sqrt())).sqrt())


@pytest.mark.parametrize("coefficients", [*FIELDS.values(), HIGH], ids=[*FIELDS, "x^10 - x - 1"])
def test_nested_roots_over_the_field_of_a_root(coefficients: tuple[int, ...]) -> None:
    a = first_root(coefficients)
    x = (a * a + 1).sqrt()
    y = (3 + a + x).sqrt()
    again = (9 + a * a + x * x + 6 * a + 6 * x + 2 * a * x).sqrt().sqrt()
    assert is_tie(y, again)
    assert is_tie(1 / (x + y), (x - y) / (x * x - y * y))
    assert is_tie(1 / (y + again), 1 / (2 * y))


# -- towers kept, and elements over a common denominator ---------------------------------------------


@pytest.fixture
def spent(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[float]]:
    """The work of all towers made meanwhile, none of which was kept before."""
    work: list[float] = []
    plain = Tower._spend
    monkeypatch.setattr(tower, "_kept", {})
    monkeypatch.setattr(Tower, "_spend", lambda self, cost: work.append(cost) or plain(self, cost))  # type: ignore[func-returns-value]
    yield work


def tie(n: int) -> Real:
    """0: what is n times a nested root, in two forms of the same radicals."""
    x = (3 + Real(2).sqrt() + (5 + Real(7).sqrt()).sqrt()).sqrt()
    return n * (1 / (x + 1)) - n * (x - 1) / (x * x - 1)


def test_ties_of_the_same_radicals_share_a_tower(spent: list[float]) -> None:
    assert vanishes(tie(1)) is True
    first = sum(spent)
    assert vanishes(tie(2)) is True
    assert sum(spent) - first < first / 4
    assert vanishes(tie(3) + HAIR) is False


def test_a_tower_that_did_its_work_is_made_anew(spent: list[float], monkeypatch: pytest.MonkeyPatch) -> None:
    assert vanishes(tie(1)) is True
    monkeypatch.setattr(Tower, "most_terms", sum(spent))
    x = (3 + Real(2).sqrt() + (5 + Real(7).sqrt()).sqrt()).sqrt()
    assert vanishes((x + 1) * (x - 1) - x * x + 1) is True, "more than what is left of the first tower's"
    monkeypatch.setattr(Tower, "most_terms", 1)
    assert vanishes(tie(4)) is None
    assert not tower._kept, "none that gave up is kept"


def test_few_towers_are_kept(spent: list[float]) -> None:
    for n in range(2, 3 * tower.TOWERS_KEPT):
        x = (Real(n) + Real(n + 1).sqrt()).sqrt()
        assert vanishes(1 / (x + 1) - (x - 1) / (x * x - 1)) is True
    assert len(tower._kept) == tower.TOWERS_KEPT


@given(st.lists(st.integers(-50, 50).filter(bool), min_size=1, max_size=4), st.integers(1, 500))
def test_common_denominators_are_in_lowest_terms(tops: list[int], under: int) -> None:
    parts, below = Rationals().lowest({k: fmpz(top) for k, top in enumerate(tops)}, fmpz(under))
    assert [Fraction(int(parts[k]), int(below)) for k in range(len(tops))] == [
        Fraction(t, under) for t in tops
    ]
    assert gcd(int(below), *map(int, parts.values())) == 1


@given(st.lists(st.tuples(SMALL, SMALL), min_size=2, max_size=3), SMALL)
def test_common_denominators_of_functions_are_in_lowest_terms(
    pairs: list[tuple[int, int]], root: int
) -> None:
    """What polynomials and their denominator share is told by how they are made: (tau - root) and no more."""
    field = RationalFunctions([(HIGH, 1)])
    tau = field.of_atom(Root.make(HIGH, 1, 1))
    assert tau is not None
    parts = {k: (tau - root) * (a * tau * tau + b * tau + 1) for k, (a, b) in enumerate(pairs)}
    lowest, below = field.lowest(parts, (tau - root) * (tau * tau * tau + 101))
    assert below == tau * tau * tau + 101
    assert [lowest[k] * (tau - root) for k in lowest] == list(parts.values())


def test_radicands_with_denominators() -> None:
    """In its field 1 / (1 + n) is (n - 1) / (2 + sqrt(2)), a sum over 2, and 1 / (a b c + 2) is 1 / 9."""
    n = (3 + Real(2).sqrt()).sqrt()
    c = 1 / (1 + n)
    r = (c + 1).sqrt()
    assert is_tie((r + c) * (r - c), c + 1 - c * c)
    a, b, c = (3 + Real(2).sqrt()).sqrt(), (3 - Real(2).sqrt()).sqrt(), Real(7).sqrt()
    assert is_tie((1 / (a * b * c + 2)).sqrt(), Real(fmpq(1, 3)))


STEPS = st.lists(st.tuples(st.sampled_from("+-*/r"), st.integers(0, 9), st.integers(0, 9)), max_size=7)
LEAVES = {
    "rationals": lambda: [Real(2).sqrt(), Real(fmpq(5, 3)), Real(7).sqrt()],
    "a root": lambda: [first_root((-2, 0, 0, 1)), Real(3).sqrt(), Real(fmpq(1, 6))],
    "two roots": lambda: [first_root((-2, 0, 0, 1)), first_root((-5, 1, 0, 1)), Real(3).sqrt()],
    "any number": lambda: [anything(), Real(3).sqrt(), Real(fmpq(1, 6))],
    "two numbers": lambda: [anything(), first_root(HIGH), Real(3).sqrt()],
}


@pytest.mark.parametrize("leaves", LEAVES.values(), ids=LEAVES)
@given(STEPS)
def test_an_element_is_the_number_that_it_stands_for(
    leaves: Callable[[], list[Real]], steps: list[tuple[str, int, int]]
) -> None:
    """Told by balls of 700 bits: of a number, and of the sum of radicals over a denominator made of it."""
    values = leaves()
    for step, i, j in steps:
        a, b = values[i % len(values)], values[j % len(values)]
        if step == "r":
            values.append((a * a + b * b + 1).sqrt())
        elif step == "/":
            values.append(a / (1 + b * b))
        else:
            values.append(a + b if step == "+" else a - b if step == "-" else a * b)
    value = values[-1]
    kind = FormalTower if generic_in(value) is not None else Tower
    field = kind(value.generators())
    try:
        element = field.element(value)
    except TooLong:
        return
    own, other = field._ball(element, 700), value.ball(700)
    assert own.overlaps(other)
    assert max(own.rad(), other.rad()) < arb(2) ** -400 * (1 + abs(other))


# -- limits ----------------------------------------------------------------------------------------


PAIRS = {
    "of a cubic and a sextic": (FIELDS["x^3 - 2"], FIELDS["3x^6 - x - 5"]),
    "of two quartics": (FIELDS["x^4 - 10x^2 + 1, which holds sqrt(2)"], (-7, 3, 0, 0, 2)),
    "of one polynomial": (FIELDS["2x^3 - 4x + 1, three real roots"],) * 2,
}


@pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
@given(st.tuples(SMALL, SMALL, SMALL), st.integers(1, 9))
def test_the_field_of_two_roots(
    pair: tuple[tuple[int, ...], tuple[int, ...]], numbers: tuple[int, int, int], n: int
) -> None:
    """Fractions and nested roots of two roots, in two forms; where lines meet is on both of them."""
    (x, y), (a, b, c) = (roots(one)[k] for one, k in zip(pair, (0, -1), strict=True)), numbers
    below = y * y + n
    assert is_tie((x + a * y) / below - (b + c * x * x) / below, (x + a * y - b - c * x * x) / below)
    assert is_tie((x * x + y * y + n).sqrt() ** 4, (x * x + y * y + n) ** 2)
    p, q, way = Point(x, y), Point(a, b), Point(1 + x * x, c - y)
    turn = way.cross(Point(n, 1))
    if turn.sign():
        met = p + way * ((q - p).cross(Point(n, 1)) / turn)
        assert is_tie((met - q).cross(Point(n, 1)), Real(0))
        assert is_tie((met - p).cross(way), Real(0))


def test_two_roots_of_which_one_is_in_the_field_of_the_other() -> None:
    """cbrt(16) = 2 cbrt(2): the field of both has the degree 3."""
    x, y = (first_root((-n, 0, 0, 1)) for n in (2, 16))
    assert is_tie(y, 2 * x)
    assert is_tie(1 / (y + x), x * x / 6)


def test_roots_of_many_polynomials_are_left_open() -> None:
    x, y, z = (first_root((-n, 0, 0, 1)) for n in (2, 3, 5))
    assert vanishes((x + y + z) ** 2 - x * (x + 2 * y + 2 * z) - (y + z) ** 2 - HAIR) is None
    assert vanishes(first_root(HIGH) * first_root((-2, *[0] * 6, 1)) - 1) is None


@given(st.lists(SMALL, min_size=2, max_size=10), st.sampled_from([0, 1]))
def test_equal_elements_of_two_fields_of_a_high_degree(numbers: list[int], index: int) -> None:
    """A polynomial in a root x of degree 10 is one in 1 / s too, with s = 1 / x.

    The other real root of the same polynomial gives another number with the same minimal polynomial.
    """
    x = roots(HIGH)[index]
    first, second = (1 / s for s in sorted(roots(HIGH[::-1]), key=lambda s: 1 / s))
    own, other = (first, second) if index == 0 else (second, first)

    def value(root: Real) -> Real:
        total = Real(0)
        for number in numbers:
            total = total * root + number
        return total

    if any(numbers[:-1]):
        assert is_tie(value(x), value(own))
        assert vanishes(value(x) - value(other)) is False


def test_long_elements_of_two_fields_are_left_open(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = first_root(HIGH), 1 / roots(HIGH[::-1])[-1]
    assert vanishes(x * x - y * y) is not None
    monkeypatch.setattr(number_field, "MOST_WORK", 1)
    assert vanishes(x * x - y * y) is None


def test_independent_radicals_without_end_are_left_open() -> None:
    """Ten independent radicals have degree 2^10: the test gives up in time, and balls tell the sign."""
    values = [(Real(n) + Real(n + 1).sqrt()).sqrt() for n in range(2, 16)]
    product = values[0]
    for value in values[1:]:
        product = product * value + 1
    assert vanishes(product) is None
    assert product > 0


# -- numbers of which nothing is known ---------------------------------------------------------------


def anything() -> Real:
    """A number that satisfies no equation: what is 0 here is 0 whatever the number."""
    return transcendental(Real, lambda bits: arb.pi())


def is_identity(value: Real) -> bool:
    tau = generic_in(value)
    assert tau is not None
    return vanishes_about(value)


@given(SMALL, SMALL, st.integers(1, 9), st.tuples(SMALL, SMALL))
def test_a_point_of_a_circle_is_on_it_whatever_its_place_is_made_of(
    x: int, y: int, radius: int, seen_from: tuple[int, int]
) -> None:
    """Where a line from (tau, a) through a corner leaves a circle, told from a circle a hair larger."""
    tau = anything()
    p = Point(tau + 20, Real(seen_from[0]))
    d = Point(Real(x), Real(y)) - p
    size, along = d.norm_sq(), (p - Point(x, y)).dot(d)
    place = p + d * ((-along + (size * radius * radius).sqrt()) / size)
    gap = (place - Point(x, y)).norm_sq() - radius * radius
    assert gap.rational == 0 or is_identity(gap)
    assert not is_identity(gap + HAIR + 0 * tau) if gap.rational is None else True


@given(st.lists(st.tuples(SMALL, SMALL), min_size=1, max_size=2), st.integers(0, 3))
def test_identities_are_those_that_trials_tell(parts: list[tuple[int, int]], kind: int) -> None:
    """At a transcendental number nothing else vanishes: `sign_at` looks at many places beside it."""
    x = anything()
    for a, b in parts:
        x = a + b * (x * x + 1).sqrt()
    y = (x * x).sqrt() if kind % 2 else ((x + 3) * (x + 3)).sqrt() - 3
    value = y - x if kind < 2 else y + x
    if value.rational is None and (tau := generic_in(value)) is not None:
        assert is_identity(value) == (sign_at(value, tau) == 0)


def test_what_vanishes_by_chance_is_no_identity() -> None:
    """The zero of a function may satisfy an equation of which its name says nothing."""
    tau = transcendental(Real, lambda bits: arb(2).sqrt())
    assert not vanishes_about(tau * tau - 2)
    assert not vanishes_about((tau * tau + 7).sqrt() - 3)
    assert vanishes_about((tau * tau).sqrt() - tau)
    assert not vanishes_about((tau * tau).sqrt() + tau)
    assert vanishes_about(((1 - tau) * (1 - tau)).sqrt() + 1 - tau), "1 - tau is negative"


def test_a_long_number_does_not_hide_another() -> None:
    """Once the first of several was too long, none of the others was looked at."""
    tau = anything()
    zero = (tau * tau).sqrt() - tau
    long = 2**17000 * tau + Real(2).sqrt()
    assert vanishes_about(long, zero) and vanishes_about(zero, long)
    assert not vanishes_about(long)


def test_functions_of_two_numbers() -> None:
    """A place inside an arc that begins in the root of a polynomial: what vanishes for all numbers is 0."""
    tau, root = anything(), first_root(HIGH)
    value = ((tau + root) * (tau + root)).sqrt() - tau - root
    assert value.sign() == 0
    assert ((tau * root) ** 2 + HAIR).sqrt().compare(tau * root) > 0
    assert (root * tau - tau * root + (tau * tau).sqrt() - tau).sign() == 0


def test_what_long_balls_tell_apart_is_not_computed_in_the_field(monkeypatch: pytest.MonkeyPatch) -> None:
    """An element of a field whose coefficients nearly cancel has a ball of 256 bits 10^46 wide.

    An audit of 17 obstacles with arcs took 12 s for 12 such signs: each was found in the field, by products
    of polynomials with coefficients of hundreds of digits.
    """
    root = first_root((-3, 1, *[0] * 9, 1))
    near = root - root.enclosure(40)[0]
    large = near**9 * Real(2) ** 400
    value = (large * large + 2).sqrt() - Real(3).sqrt() * (root * root + 1).sqrt()
    assert value.ball(256).rad() > 1
    assert sign._separation_bits(value) > sign.TOWER_BITS
    monkeypatch.setattr(sign, "vanishes", lambda value: pytest.fail("computed in the field"))
    assert value.sign() == -1


def test_roots_of_long_polynomials_are_told_apart_by_balls(monkeypatch: pytest.MonkeyPatch) -> None:
    """The field of two such roots took a minute where corners were shifted by 10^-60."""
    unit = 10**100
    one, other = first_root((-2, 0, 0, 1)), first_root((-2 * unit - 1, 0, 0, unit))
    value = one + (one * one + 1).sqrt() - other - (other * other + 1).sqrt()
    assert sign._separation_bits(value) > sign.TOWER_BITS
    monkeypatch.setattr(sign, "vanishes", lambda value: pytest.fail("computed in the field"))
    assert value.sign() == -1


def test_numbers_of_a_field_of_functions_have_one_order() -> None:
    """They come as a set, whose order is another one in every process."""
    numbers = [((-n, 0, 0, 1), 0) for n in (2, 3, 5)]
    fields = RationalFunctions(numbers), RationalFunctions(numbers[::-1])
    for coefficients, index in numbers:
        first, second = (field.of_atom(Root.make(coefficients, index, 1)) for field in fields)
        assert first == second
