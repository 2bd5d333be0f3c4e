"""An oracle for algebraic numbers: trees of operations, as 1,000 digits and as eigenvalues of matrices.

A number that a tree tells is an eigenvalue of a rational matrix: a root of a polynomial of its companion;
sums, products and quotients of Kronecker sums and products and of inverses; a square root of a block matrix.
By Cauchy's bound the least eigenvalue that is not 0 is not very small: what is smaller is proved to be 0, and
nothing is assumed of expressions. Nothing here shares code with the library's numbers.

`rewritten` makes another tree of the same number, by identities: so ties are planted, not found.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any, TypeAlias

import mpmath
from sympy import QQ
from sympy.polys.matrices import DomainMatrix

mp = mpmath.mp.clone()
mp.dps = 1000
CLEAR = mp.mpf(10) ** -500
"""Trees are so small that what is below this is 0 wherever no proof is asked for."""

LARGE, LARGER = 2**107 - 1, 2**127 - 1
"""Primes: of the product of one and the square of the other no factor is found by trial division."""

Tree: TypeAlias = "tuple[Any, ...]"
"""("q", rational), ("root", ascending coefficients, index), ("sqrt", tree), or an operation and two trees."""


def q(value: Fraction | int) -> Tree:
    return ("q", Fraction(value))


# -- digits ----------------------------------------------------------------------------------------


@cache
def real_roots(coefficients: tuple[int, ...]) -> list[Any]:
    """All distinct real roots, ascending, to 1,000 digits: isolated by Sturm's sequence, then by halves."""
    chain = _sturm(tuple(map(Fraction, coefficients)))
    bound = 1 + max(abs(Fraction(c, coefficients[-1])) for c in coefficients[:-1])
    todo, found = [(-bound, bound)], []
    while todo:
        low, high = todo.pop()
        count = _changes(chain, low) - _changes(chain, high)
        if count == 1 and high - low < Fraction(1, 10**6):
            found.append(_refined(chain[0], low, high))
        elif count:
            middle = (low + high) / 2
            todo += [(low, middle), (middle, high)]
    return sorted(found)


def _sturm(f: tuple[Fraction, ...]) -> list[tuple[Fraction, ...]]:
    chain = [f, tuple(k * c for k, c in enumerate(f))[1:]]
    while len(chain[-1]) > 1:
        rest = _remainder(chain[-2], chain[-1])
        if not rest:
            # A common factor: divided out, all roots are simple.
            divisor = chain[-1]
            return _sturm(_quotient(f, divisor))
        chain.append(tuple(-c for c in rest))
    return chain


def _divided(f: tuple[Fraction, ...], g: tuple[Fraction, ...]) -> tuple[list[Fraction], list[Fraction]]:
    rest, quotient = list(f), []
    while len(rest) >= len(g):
        factor = rest[-1] / g[-1]
        quotient.append(factor)
        for k, c in enumerate(g):
            rest[len(rest) - len(g) + k] -= factor * c
        rest.pop()
    return quotient[::-1], rest


def _remainder(f: tuple[Fraction, ...], g: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    rest = _divided(f, g)[1]
    while rest and not rest[-1]:
        rest.pop()
    return tuple(rest)


def _quotient(f: tuple[Fraction, ...], g: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    return tuple(_divided(f, g)[0])


def at(f: tuple[Any, ...], x: Any) -> Any:
    total: Any = 0
    for c in reversed(f):
        total = total * x + c
    return total


def _changes(chain: list[tuple[Fraction, ...]], x: Fraction) -> int:
    signs = [value > 0 for f in chain if (value := at(f, x))]
    return sum(a != b for a, b in pairwise(signs))


def _refined(f: tuple[Fraction, ...], low: Fraction, high: Fraction) -> Any:
    if not at(f, high):
        return number(high)
    for _ in range(60):
        middle = (low + high) / 2
        if (at(f, middle) > 0) == (at(f, high) > 0):
            high = middle
        else:
            low = middle
    numbers = tuple(map(number, f))
    slope = tuple(k * c for k, c in enumerate(numbers))[1:]
    x = number(high)
    for _ in range(14):
        x -= at(numbers, x) / at(slope, x)
    assert number(low) <= x <= number(high) or low == high
    return x


def number(value: Fraction | int) -> Any:
    value = Fraction(value)
    return mp.mpf(value.numerator) / value.denominator


@cache
def digits(tree: Tree) -> Any:
    """The number to 1,000 digits; roots are of non-negative numbers."""
    kind = tree[0]
    if kind == "q":
        return number(tree[1])
    if kind == "root":
        return real_roots(tree[1])[tree[2]]
    left = digits(tree[1])
    if kind == "sqrt":
        return mp.sqrt(left) if left > CLEAR else mp.mpf(0)
    right = digits(tree[2])
    if kind == "/":
        return left / right
    return left + right if kind == "+" else left - right if kind == "-" else left * right


def clear_sign(tree: Tree) -> int:
    value = digits(tree)
    return 0 if abs(value) < CLEAR else int(mp.sign(value))


def settled(tree: Tree) -> Tree:
    """The tree with roots of absolute values, and with quotients by 0 replaced by their numerators."""
    if tree[0] in ("q", "root"):
        return tree
    parts = tuple(map(settled, tree[1:]))
    if tree[0] == "sqrt" and clear_sign(parts[0]) < 0:
        return ("sqrt", ("-", q(0), parts[0]))
    if tree[0] == "/" and not clear_sign(parts[1]):
        return parts[0]
    return (tree[0], *parts)


# -- matrices --------------------------------------------------------------------------------------


def size(tree: Tree) -> int:
    """The number of rows of the matrix of a number."""
    if tree[0] in ("q", "root"):
        return 1 if tree[0] == "q" else len(tree[1]) - 1
    if tree[0] == "sqrt":
        return 2 * size(tree[1])
    return size(tree[1]) * size(tree[2])


def matrix(tree: Tree) -> DomainMatrix:
    """A rational matrix that has the number as an eigenvalue; ZeroDivisionError where one divides by it."""
    kind = tree[0]
    if kind == "q":
        return _rows([[tree[1]]])
    if kind == "root":
        *low, lead = tree[1]
        rows = [[Fraction(int(j == i + 1)) for j in range(len(low))] for i in range(len(low) - 1)]
        return _rows([*rows, [Fraction(-c, lead) for c in low]])
    left = matrix(tree[1])
    if kind == "sqrt":
        zero, one = DomainMatrix.zeros(left.shape, QQ), DomainMatrix.eye(left.shape[0], QQ)
        return zero.hstack(one).vstack(left.hstack(zero)).to_dense()
    right = matrix(tree[2])
    if kind == "/":
        right = right.inv()
    if kind in "*/":
        return _kronecker(left, right)
    one, other = (DomainMatrix.eye(m.shape[0], QQ).to_dense() for m in (left, right))
    first, second = _kronecker(left, other), _kronecker(one, right)
    return first + second if kind == "+" else first - second


def _rows(rows: list[list[Fraction]]) -> DomainMatrix:
    numbers = [[QQ(c.numerator, c.denominator) for c in row] for row in rows]
    return DomainMatrix(numbers, (len(rows), len(rows)), QQ)


def _kronecker(a: DomainMatrix, b: DomainMatrix) -> DomainMatrix:
    one, two = a.to_list(), b.to_list()
    rows = [[x * y for x in row for y in other] for row in one for other in two]
    return DomainMatrix(rows, (len(rows), len(rows)), QQ)


def proved_sign(tree: Tree) -> int:
    """The sign: 0 only if the digits are below the least eigenvalue that is not 0."""
    coefficients = [Fraction(int(c.numerator), int(c.denominator)) for c in matrix(tree).charpoly()]
    while not coefficients[-1]:
        coefficients.pop()
    value = digits(tree)
    if len(coefficients) == 1:
        return 0
    last = abs(coefficients[-1])
    least = number(last / (last + max(map(abs, coefficients[:-1]))))
    assert least > mp.mpf(10) ** -900, "more digits are needed"
    return 0 if abs(value) < least / 2 else int(mp.sign(value))


# -- the same number told otherwise ----------------------------------------------------------------

Rule: TypeAlias = "Callable[[Tree], Tree | None]"


def _sum_swapped(t: Tree) -> Tree | None:
    return (t[0], t[2], t[1]) if t[0] in "+*" else None


def _difference_of_squares(t: Tree) -> Tree | None:
    """a + b = (a^2 - b^2) / (a - b)."""
    if t[0] != "+" or not clear_sign(("-", t[1], t[2])):
        return None
    _, a, b = t
    return ("/", ("-", ("*", a, a), ("*", b, b)), ("-", a, b))


def _distributed(t: Tree) -> Tree | None:
    if t[0] != "*" or t[2][0] not in "+-":
        return None
    return (t[2][0], ("*", t[1], t[2][1]), ("*", t[1], t[2][2]))


def _quarter_squares(t: Tree) -> Tree | None:
    """a b = ((a + b)^2 - (a - b)^2) / 4."""
    if t[0] != "*":
        return None
    total, rest = ("+", t[1], t[2]), ("-", t[1], t[2])
    return ("/", ("-", ("*", total, total), ("*", rest, rest)), q(4))


def _root_of_square(t: Tree) -> Tree | None:
    root = ("sqrt", ("*", t, t))
    return root if clear_sign(t) >= 0 else ("-", q(0), root)


def _nested(t: Tree) -> Tree | None:
    """sqrt(a) + sqrt(b) = sqrt(a + b + 2 sqrt(a b))."""
    if t[0] != "+" or t[1][0] != "sqrt" or t[2][0] != "sqrt":
        return None
    a, b = t[1][1], t[2][1]
    return ("sqrt", ("+", ("+", a, b), ("*", q(2), ("sqrt", ("*", a, b)))))


def _nested_difference(t: Tree) -> Tree | None:
    """sqrt(a) - sqrt(b) = +- sqrt(a + b - 2 sqrt(a b))."""
    if t[0] != "-" or t[1][0] != "sqrt" or t[2][0] != "sqrt":
        return None
    a, b = t[1][1], t[2][1]
    root = ("sqrt", ("-", ("+", a, b), ("*", q(2), ("sqrt", ("*", a, b)))))
    return root if clear_sign(t) >= 0 else ("-", q(0), root)


def _inverse(t: Tree) -> Tree | None:
    return ("*", t[1], ("/", q(1), t[2])) if t[0] == "/" else None


def _root_below(t: Tree) -> Tree | None:
    """sqrt(a) = a / sqrt(a)."""
    return ("/", t[1], t) if t[0] == "sqrt" and clear_sign(t) else None


def _square_taken_in(t: Tree) -> Tree | None:
    """sqrt(a) = sqrt(a p^2) / p, for a large prime p."""
    if t[0] != "sqrt" or t[1][0] != "q":
        return None
    return ("/", ("sqrt", q(t[1][1] * LARGE**2)), q(LARGE))


def _one_root(t: Tree) -> Tree | None:
    """sqrt(a) sqrt(b) = sqrt(a b)."""
    if t[0] != "*" or t[1][0] != "sqrt" or t[2][0] != "sqrt":
        return None
    return ("sqrt", ("*", t[1][1], t[2][1]))


def _by_its_polynomial(t: Tree) -> Tree | None:
    """x = -(c_0 + c_1 x + ... ) / (c_n x^(n - 1))."""
    if t[0] != "root":
        return None
    *low, lead = t[1]
    power, total = q(1), q(0)
    for c in low:
        total = ("+", total, ("*", q(c), power)) if c else total
        last, power = power, ("*", t, power)
    return ("/", ("-", q(0), total), ("*", q(lead), last))


RULES: tuple[Rule, ...] = (
    _sum_swapped,
    _difference_of_squares,
    _distributed,
    _quarter_squares,
    _root_of_square,
    _nested,
    _nested_difference,
    _inverse,
    _root_below,
    _square_taken_in,
    _one_root,
    _by_its_polynomial,
)


def rewritten(tree: Tree, choose: Callable[[int], int]) -> Tree:
    """The same number by another tree: at some places, as *choose* tells, an identity is applied."""
    if tree[0] not in ("q", "root"):
        tree = (tree[0], *(rewritten(part, choose) for part in tree[1:]))
    if choose(2):
        found = [other for rule in RULES if (other := rule(tree)) is not None]
        return found[choose(len(found))] if found else tree
    return tree
