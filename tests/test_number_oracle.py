"""Real numbers against trees of operations: digits, eigenvalues, and planted ties (`matrix_numbers`)."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations, pairwise
from typing import Any

import pytest
from drawn_curves import Draw
from flint import arb, fmpq
from hypothesis import assume, event, given
from hypothesis import strategies as st
from matrix_numbers import (
    LARGER,
    Tree,
    at,
    clear_sign,
    digits,
    mp,
    number,
    proved_sign,
    q,
    real_roots,
    rewritten,
    settled,
    size,
)
from nightly import examples
from sympy.polys.matrices.exceptions import DMNonInvertibleMatrixError

from exactacq.numbers.between import rational_between
from exactacq.numbers.function_zeros import roots
from exactacq.numbers.real import Real

POLYNOMIALS = [
    *((-2, 0, 0, 1), (1, -3, 0, 1), (-1, -1, 0, 1), (1, 0, -10, 0, 1), (1, -4, 0, 2)),
    (-1, -1, 0, 0, 0, 1),
]
"""Irreducible, of degree 3 to 5, with one, three or four real roots; the fourth is of sqrt(2) + sqrt(3)."""
HAIRS = [Fraction(0)] * 3 + [Fraction(s, 10**n) for n in (40, 100, 200) for s in (1, -1)]

MOST_ROWS = 16
"""Larger matrices take long."""

hairs = st.sampled_from(HAIRS)
small = st.sampled_from([Fraction(n, d) for n in range(-7, 8) for d in (1, 2, 3)])
positive = st.sampled_from([Fraction(n, d) for n in range(1, 12) for d in (1, 3)])
rationals = small.map(q)
radicands = st.one_of(positive, positive, positive, positive.map(lambda value: value * LARGER))
surds = radicands.map(lambda value: ("sqrt", q(value)))


@st.composite
def root_leaves(draw: Draw) -> Tree:
    coefficients = draw(st.sampled_from(POLYNOMIALS))
    return ("root", coefficients, draw(st.integers(0, len(real_roots(coefficients)) - 1)))


def trees(leaves: st.SearchStrategy[Tree], most: int) -> st.SearchStrategy[Tree]:
    """Small trees; a root is mostly one of a sum."""
    return st.recursive(
        leaves,
        lambda inner: st.one_of(
            st.tuples(st.sampled_from("+-*/"), inner, inner),
            st.tuples(st.just("sqrt"), inner),
            st.tuples(st.just("sqrt"), st.tuples(st.sampled_from("+-"), inner, rationals)),
        ),
        max_leaves=most,
    ).map(settled)


numbers = trees(st.one_of(surds, surds, rationals), 4)
with_roots = trees(st.one_of(surds, rationals, root_leaves()), 3)


def exact(tree: Tree) -> Real:
    """The library's number."""
    kind = tree[0]
    if kind == "q":
        return Real(tree[1])
    if kind == "root":
        return roots(tree[1])[tree[2]]
    left = exact(tree[1])
    if kind == "sqrt":
        return left.sqrt()
    right = exact(tree[2])
    if kind == "/":
        return left / right
    return left + right if kind == "+" else left - right if kind == "-" else left * right


def late(tree: Tree, width: int) -> Real:
    """The number as a ball, which is not in the middle of it; it is made when more is asked for."""
    middle = exact(tree).enclosure(200)[0] + fmpq(1, 3 * 2**width)
    return Real.late(arb(middle, fmpq(1, 2**width)), lambda: exact(tree))


def laws(a: Real, b: Real, order: int) -> None:
    """Everything that says how two numbers are ordered says the same; what balls say comes first."""
    assert a.overlaps(b) or order
    assert a.compare(b) == order == -b.compare(a)
    assert (a - b).sign() == order == -(b - a).sign()
    assert (a < b, a <= b, a == b, a != b, a >= b, a > b) == (
        order < 0, order <= 0, order == 0, order != 0, order >= 0, order > 0
    )  # fmt: skip
    assert (a - b).clear_sign(64) in (0, order)
    assert (float(a) <= float(b)) if order <= 0 else (float(a) >= float(b))
    if order:
        low, high = (a, b) if order < 0 else (b, a)
        assert low.compare(rational_between(low, high)) < 0 < high.compare(rational_between(low, high))
    else:
        assert float(a) == float(b) and round(a) == round(b) and bool(a) == bool(b)
        assert a.decimal(30) == b.decimal(30) or a.enclosure(150)[0] <= b.enclosure(150)[1]


# -- certified -------------------------------------------------------------------------------------


def check_sign(tree: Tree) -> None:
    """The sign that matrices prove, and digits, floats and decimals that agree."""
    assume(size(tree) <= MOST_ROWS)
    try:
        sign = proved_sign(tree)
    except (ZeroDivisionError, DMNonInvertibleMatrixError):
        assume(False)  # Of sqrt(1) + sqrt(1) the matrix has the eigenvalue 1 - 1 too, and no inverse.
    value, expected = exact(tree), digits(tree)
    event("zero" if not sign else "not zero")
    assert value.sign() == sign and (-value).sign() == -sign
    assert abs(value).sign() == abs(sign)
    low, high = value.enclosure(600)
    slack = mp.mpf(10) ** -300
    assert mp.mpf(int(low.p)) / int(low.q) - slack <= expected <= mp.mpf(int(high.p)) / int(high.q) + slack
    assert high - low <= fmpq(1, 2**600)
    assert float(value) == (float(expected) if sign else 0.0)
    if sign:
        assert abs(mp.mpf(value.decimal(40)) - expected) <= abs(expected) * mp.mpf(10) ** -39


@examples(80)
@given(st.tuples(st.sampled_from("+-*/"), numbers, numbers).map(settled))
def test_signs_are_those_that_matrices_prove(tree: Tree) -> None:
    check_sign(tree)


@examples(40)
@given(st.tuples(st.sampled_from("+-*/"), with_roots, with_roots).map(settled))
def test_signs_with_roots_of_polynomials(tree: Tree) -> None:
    check_sign(tree)


# -- planted ties ----------------------------------------------------------------------------------


@st.composite
def ties(draw: Draw, leaves: st.SearchStrategy[Tree]) -> tuple[Tree, Tree, Fraction, int]:
    """A number, another tree of it, a hair, and what is asked of them beside their order."""
    tree = draw(leaves)
    other = rewritten(tree, lambda count: draw(st.integers(0, count - 1)))
    return tree, other, draw(hairs), draw(st.integers(0, 5))


def check_tie(case: tuple[Tree, Tree, Fraction, int]) -> None:
    """Both trees are one number, unless a hair is added; so are late ones, and their roots."""
    tree, other, hair, made = case
    assert abs(digits(tree) - digits(other)) < mp.mpf(10) ** -500, "the oracle's identities are wrong"
    shifted = ("+", other, q(hair)) if hair else other
    order = (hair < 0) - (hair > 0)
    event("tie" if not hair else "near tie")
    laws(exact(tree), exact(shifted), order)
    if made == 1:
        laws(late(tree, 60), exact(shifted), order)
    elif made == 2:
        laws(late(tree, 20), late(shifted, 40), order)
    elif made == 3:
        laws(late(tree, 20), late(("+", shifted, q(1)), 40), -1)
    elif made == 4 and clear_sign(tree) > 0 and clear_sign(shifted) > 0:
        laws(exact(("sqrt", tree)), exact(("sqrt", shifted)), order)


@examples(150)
@given(ties(numbers))
def test_numbers_that_are_told_otherwise_tie(case: tuple[Tree, Tree, Fraction, int]) -> None:
    check_tie(case)


@examples(60)
@given(ties(with_roots))
def test_roots_that_are_told_otherwise_tie(case: tuple[Tree, Tree, Fraction, int]) -> None:
    check_tie(case)


def check_fields(case: tuple[Tree, Tree, Tree]) -> None:
    """(a + b) - b = a, (a b) / b = a, a (b + c) = a b + a c; what is moved by one number keeps its order."""
    a, b, c = map(exact, case)
    assert (a + b) - b == a and a - a == 0 and a + (-a) == 0 and -(0 - a) == a
    assert a * (b + c) == a * b + a * c
    assert (a + b) * (a - b) == a * a - b * b
    if clear_sign(case[1]):
        assert (a * b) / b == a and a / b == a * (1 / b) and b**-2 * b**2 == 1
    assert (a + c).compare(b + c) == a.compare(b)
    assert (2 * c).compare(3 * c) == -c.sign()
    for x in (a, b, c):
        rationally = x if x.rational is None else Real(x.rational)
        assert rationally == x
        if x.rational is not None:
            assert hash(x) == hash(Fraction(*x.as_integer_ratio())) == hash(rationally)
        else:
            with pytest.raises(TypeError):
                hash(x)


@examples(40)
@given(st.tuples(numbers, numbers, surds))
def test_laws_of_fields(case: tuple[Tree, Tree, Tree]) -> None:
    check_fields(case)


# -- fields of their own -----------------------------------------------------------------------------

Element = tuple[Fraction, Fraction, Fraction, Fraction]
"""a + b s + c t + d s t with s^2 = n and t^2 = e + f s."""


def product_in(field: tuple[int, int, int], x: Element, y: Element) -> Element:
    n, e, f = field
    a, b, c, d = x
    p, r, u, v = y
    # Products without t, with t, and with t^2 = e + f s, in which s^2 = n.
    w0, w1 = c * u + n * d * v, c * v + d * u
    return (
        a * p + n * b * r + e * w0 + n * f * w1,
        a * r + b * p + f * w0 + e * w1,
        a * u + c * p + n * (b * v + d * r),
        a * v + b * u + c * r + d * p,
    )


def element_in(field: tuple[int, int, int], x: Element) -> Real:
    n, e, f = field
    s = Real(n).sqrt()
    t = (e + f * s).sqrt()
    return x[0] + x[1] * s + x[2] * t + x[3] * s * t


FIELDS = [(2, 3, 1), (5, 7, -3), (3, 2, 1), (2, 2, 1), (6, 5, 2), (17, 5, -1)]
"""Of (6, 5, 2) t is sqrt(2) + sqrt(3): the field is not what it seems to be, and elements tie as well."""
elements = st.tuples(small, small, small, small)


def check_field(case: tuple[tuple[int, int, int], Element, Element, Fraction]) -> None:
    """Products, roots of squares and conjugates, multiplied out by hand, tie with what the library makes."""
    field, x, y, hair = case
    a, b = element_in(field, x), element_in(field, y)
    product = element_in(field, product_in(field, x, y))
    order = (hair < 0) - (hair > 0)
    laws(a * b, product + hair, order)
    square = element_in(field, product_in(field, x, x))
    laws(square.sqrt(), abs(a) + abs(hair), -abs(order))
    if b.sign():
        laws(product / b, a + hair, order)
    # Over the field of s: (a + b s + (c + d s) t) times its conjugate has no t.
    conjugate: Element = (x[0], x[1], -x[2], -x[3])
    norm = product_in(field, x, conjugate)
    assert norm[2] == norm[3] == 0
    s = Real(field[0]).sqrt()
    assert a * element_in(field, conjugate) == norm[0] + norm[1] * s


long = st.tuples(small, hairs).map(sum)
field_cases = st.tuples(
    st.sampled_from(FIELDS), st.one_of(elements, st.tuples(long, long, small, small)), elements, hairs
)
"""Of long coefficients a height bound says so little that ties are decided in the field."""


@examples(60)
@given(field_cases)
def test_elements_of_a_nested_field(case: tuple[tuple[int, int, int], Element, Element, Fraction]) -> None:
    check_field(case)


# -- roots of polynomials ----------------------------------------------------------------------------


def times(f: list[Fraction], g: list[Fraction]) -> list[Fraction]:
    product = [Fraction(0)] * (len(f) + len(g) - 1)
    for i, a in enumerate(f):
        for j, b in enumerate(g):
            product[i + j] += a * b
    return product


@st.composite
def products(draw: Draw) -> tuple[list[Fraction], list[Any]]:
    """A polynomial and its roots: rational ones, double ones, ones a hair apart, those of other factors."""
    f, places = [Fraction(1)], []
    for _ in range(draw(st.integers(0, 3))):
        root = draw(small) + draw(hairs)
        places.append(number(root))
        for _ in range(draw(st.sampled_from([1, 1, 2]))):
            f = times(f, [-root, Fraction(1)])
    if draw(st.booleans()):
        middle, square = draw(small), draw(small) + draw(hairs)
        f = times(f, [middle * middle - square, -2 * middle, Fraction(1)])
        half = [mp.sqrt(number(square))] if square >= 0 else []
        places += [number(middle) + side * h for h in half for side in (1, -1)]
    if draw(st.booleans()):
        factor = draw(st.sampled_from(POLYNOMIALS))
        f = times(f, list(map(Fraction, factor)))
        places += real_roots(factor)
    assume(len(f) > 1)
    kept: list[Any] = []
    for place in sorted(places):
        if not kept or place - kept[-1] > mp.mpf(10) ** -500:
            kept.append(place)
    return [c * Fraction(-3, 2) for c in f], kept


def check_roots(case: tuple[list[Fraction], list[Any]]) -> None:
    """All planted roots are found once, in order, and solve the polynomial."""
    f, expected = case
    found = roots(f)
    assert len(found) == len(expected)
    assert all(a < b for a, b in pairwise(found))
    for value, place in zip(found, expected, strict=True):
        low, high = value.enclosure(900)
        assert abs(mp.mpf(int(low.p)) / int(low.q) - place) < mp.mpf(10) ** -250
        assert high - low <= fmpq(1, 2**900)
        assert Real.sum(c * value**k for k, c in enumerate(f)) == 0


@examples(60)
@given(products())
def test_planted_roots_are_found(case: tuple[list[Fraction], list[Any]]) -> None:
    check_roots(case)


def moved_roots(f: tuple[int, ...], shift: Fraction) -> list[Fraction]:
    """The polynomial whose roots are those of f plus a number."""
    result = [Fraction(0)]
    for c in reversed(f):
        result = times(result, [-shift, Fraction(1)])
        result[0] += c
    return result[: len(f)]


def check_transformed(case: tuple[tuple[int, ...], Fraction, Fraction]) -> None:
    """Roots of polynomials made so that their roots are moved, stretched, turned over or squared."""
    f, shift, hair = case
    found = roots(f)
    order = (hair < 0) - (hair > 0)
    for a, b in zip(found, roots(moved_roots(f, shift)), strict=True):
        laws(a + shift, b + hair, order)
    for a, b in zip(found, roots([c / Fraction(3, 2) ** k for k, c in enumerate(f)]), strict=True):
        laws(a * fmpq(3, 2), b + hair, order)
    turned = sorted(1 / a for a in found)
    assert turned == roots(f[::-1])
    # Graeffe: f(x) f(-x) is a polynomial in x^2.
    squared = times(list(map(Fraction, f)), [c * (-1) ** k for k, c in enumerate(map(Fraction, f))])[::2]
    values = roots(squared)
    for a in found:
        equal = [value for value in values if value == a * a]
        assert len(equal) == 1
        laws(equal[0].sqrt(), abs(a) + hair, order)


@examples(25)
@given(st.tuples(st.sampled_from(POLYNOMIALS), small, hairs))
def test_roots_of_transformed_polynomials_tie(case: tuple[tuple[int, ...], Fraction, Fraction]) -> None:
    check_transformed(case)


# -- identities with names -------------------------------------------------------------------------


def sqrt(value: object) -> Real:
    return Real(value).sqrt()


def cube_root(value: int) -> Real:
    return roots([-value, 0, 0, 1])[0]


def cosine_of_sevenths() -> list[Real]:
    """cos(6 pi / 7), cos(4 pi / 7), cos(2 pi / 7): the roots of 8 x^3 + 4 x^2 - 4 x - 1."""
    return roots([-1, -4, 4, 8])


IDENTITIES: dict[str, tuple[Any, Any]] = {
    "sqrt 2 + sqrt 3": lambda: (sqrt(5 + 2 * sqrt(6)), sqrt(2) + sqrt(3)),
    "the tangent of an eighth of a right angle": lambda: (
        sqrt(4 + 2 * sqrt(2)) - 1 - sqrt(2),
        (2 - sqrt(2 + sqrt(2))) / sqrt(2 - sqrt(2)),
    ),
    "Ramanujan, sqrt of cube roots": lambda: (
        sqrt(cube_root(5) - cube_root(4)) * 3,
        cube_root(2) + cube_root(20) - cube_root(25),
    ),
    "Ramanujan, a cube": lambda: (
        (1 - cube_root(2) + cube_root(4)) ** 3,
        9 * (cube_root(2) - 1),
    ),
    "Viete of x^3 - 3 x + 1": lambda: (
        Real.sum(x * y for x, y in combinations(roots([1, -3, 0, 1]), 2)),
        Real(-3),
    ),
    "cosines of sevenths": lambda: (
        8 * cosine_of_sevenths()[0] * cosine_of_sevenths()[1] * cosine_of_sevenths()[2],
        Real(1),
    ),
    "the pentagon's diagonal": lambda: (sqrt(10 + 2 * sqrt(5)) * sqrt(10 - 2 * sqrt(5)), 4 * sqrt(5)),
    "Gauss, seventeenths": lambda: (
        roots([1, -8, -40, 80, 240, -192, -448, 128, 256])[-1] * 16,
        -1 + sqrt(17) + sqrt(34 - 2 * sqrt(17))
        + 2 * sqrt(17 + 3 * sqrt(17) - sqrt(34 - 2 * sqrt(17)) - 2 * sqrt(34 + 2 * sqrt(17))),
    ),
    "three levels": lambda: (
        sqrt(2 + sqrt(2 + sqrt(3))) ** 2 * sqrt(2 - sqrt(2 + sqrt(3))) ** 2,
        2 - sqrt(3),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", IDENTITIES)
def test_identities_with_names(name: str) -> None:
    left, right = IDENTITIES[name]()
    laws(left, right, 0)
    for n in (40, 120, 200):
        hair = fmpq(1, 10**n)
        laws(left, right + hair, -1)
        laws(left, right - hair, 1)


# -- rounding ----------------------------------------------------------------------------------------


@st.composite
def halves(draw: Draw) -> tuple[Tree, Fraction, Fraction]:
    """A 0 that hides, the middle of two floats, and a hair."""
    tree = draw(numbers)
    hidden = settled(("-", tree, rewritten(tree, lambda count: draw(st.integers(0, count - 1)))))
    whole = draw(st.integers(1, 2**54))
    return hidden, Fraction(2 * whole + 1, 2 ** draw(st.sampled_from([1, 2, 54]))), draw(hairs)


def check_rounding(case: tuple[Tree, Fraction, Fraction]) -> None:
    """What rounds a number rounds it as its fraction is rounded, though a hidden 0 is added to it."""
    hidden, middle, hair = case
    fraction = middle + hair
    value = exact(hidden) + Real(fraction)
    assert float(value) == float(fraction)
    assert round(value) == round(fraction)
    tenth = round(value, 1)
    assert Fraction(int(tenth.p), int(tenth.q)) == round(fraction, 1)
    assert abs(Fraction(f"{value:.30f}") - fraction) <= Fraction(1, 10**30)


@examples(40)
@given(halves())
def test_rounding_is_that_of_fractions(case: tuple[Tree, Fraction, Fraction]) -> None:
    check_rounding(case)


def test_the_oracle_by_hand() -> None:
    """sqrt(2) + sqrt(3) - sqrt(5 + 2 sqrt(6)) is 0, and is not beside a hair; roots are counted once."""
    two, three = ("sqrt", q(2)), ("sqrt", q(3))
    nested = ("sqrt", ("+", q(5), ("*", q(2), ("sqrt", q(6)))))
    assert proved_sign(("-", ("+", two, three), nested)) == 0
    assert proved_sign(("-", ("+", two, three), ("+", nested, q(Fraction(1, 10**40))))) == -1
    assert len(real_roots((2, -5, 4, -1))) == 2  # (1 - x)^2 (2 - x)
    assert abs(at((-2, 0, 0, 1), real_roots((-2, 0, 0, 1))[0])) < mp.mpf(10) ** -990
