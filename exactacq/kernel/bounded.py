"""Floats with a bound of their error, and the rules by which the bounds are computed.

A pair (m, e) of floats *holds* a real number x if |x - m| <= e. Every function below takes pairs that hold
some numbers and returns a pair that holds the result of the exact operation on these numbers (running error
analysis). Code that unrolls a rule for speed says which.

The rules. Let u = 2^-53; fl(z) is the float nearest to z. IEEE arithmetic, rounding to the nearest float,
gives fl(z) = z (1 + d) + h with |d| <= u and |h| <= 2^-1075. Sums and differences of floats have h = 0, and
of |d| <= u follows |fl(z) - z| <= u |fl(z)| for them. With x = a +- p and y = b +- q:

- sum: |x + y - fl(a + b)| <= p + q + u |fl(a + b)|;
- product: |x y - a b| <= |a| q + |b| p + p q, and |a b - fl(a b)| <= u |fl(a b)| (1 + 2 u) + 2^-1075;
- quotient, |b| > q: x/y - a/b = ((x - a) b - a (y - b)) / (y b), so |x/y - a/b| <= (p + |a/b| q) / (|b| - q);
- square root, a > p: |sqrt(x) - sqrt(a)| = |x - a| / (sqrt(x) + sqrt(a)) <= p / sqrt(a); and for x >= 0 in
  any case |sqrt(x) - sqrt(a)| <= sqrt(|x - a|), so x >= 0 is held by (0, sqrt(a + p)) too.

The bounds are themselves computed in floats, by at most twenty operations on numbers that are not negative
(and the difference |b| - q, one rounding). Each loses at most a factor 1 - u. Instead of u the rules take
`UNIT` = 2^-52, twice as much, for the rounding of the value, and multiply the sum of the bounds by `WIDEN` =
1 + 2^-47, more than (1 - u)^-20: so what rounding takes away is given back.

Underflow: results below 2^-1022 lose at most 2^-1075 each. `TINY` = 2^-900 is added where products and
quotients are formed, within the numerator too where something is divided by |b| - q: it outweighs all of
these. So does `UNIT` m for a square root m, which is at least 2^-450 where it is a divisor.

Overflow and what is undefined: a result beyond the floats is infinite or no number, and so is what is
computed from it. The verdicts are comparisons written such that an infinity or a NaN in a bound, or a NaN in
a value, fails them; a value that is infinite has an infinite bound, for `UNIT` |m| is part of it. A divisor
whose interval contains 0 gives (0, inf), which holds everything. Division by zero is never executed, as it
would raise. To make every verdict unsure, give one number that all others are computed from the bound inf.

A verdict is 1 (certainly positive), -1 (certainly negative) or 0 (unsure: exact arithmetic has to decide).
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Final

UNIT: Final = 2.220446049250313e-16
"""2^-52: twice the relative error of one rounding."""
WIDEN: Final = 1.0 + 7.105427357601002e-15
"""1 + 2^-47: makes up for the roundings within a bound."""
TINY: Final = 1.1830521861667747e-271
"""2^-900: outweighs what underflow loses."""


def total(a: float, p: float, b: float, q: float) -> tuple[float, float]:
    """The sum."""
    m = a + b
    return m, (p + q + UNIT * abs(m)) * WIDEN


def product(a: float, p: float, b: float, q: float) -> tuple[float, float]:
    """The product."""
    m = a * b
    return m, (abs(a) * q + abs(b) * p + p * q + UNIT * abs(m) + TINY) * WIDEN


def quotient(a: float, p: float, b: float, q: float) -> tuple[float, float]:
    """The quotient; (0, inf) if the divisor may be 0."""
    room = abs(b) - q
    if not room > TINY:
        return 0.0, inf
    m = a / b
    return m, ((p + (abs(m) + TINY) * q + TINY) / room + UNIT * abs(m) + TINY) * WIDEN


def root(a: float, p: float) -> tuple[float, float]:
    """The square root of a number that is known not to be negative."""
    if a > p and a > TINY:
        m = sqrt(a)
        return m, (p / m + UNIT * m) * WIDEN
    most = a + p
    if not most < inf:
        return 0.0, inf
    return 0.0, (sqrt(max(most, 0.0)) + TINY) * WIDEN


def cross(ax: float, ay: float, p: float, bx: float, by: float, q: float) -> tuple[float, float]:
    """a_x b_y - a_y b_x for vectors whose components are held with the bounds p and q.

    Two products and a difference: the products' roundings are bounded by `UNIT` times their sizes.
    """
    left, right = ax * by, ay * bx
    m = left - right
    sizes = (abs(ax) + abs(ay)) * q + (abs(bx) + abs(by) + 2.0 * q) * p
    return m, (sizes + UNIT * (abs(left) + abs(right) + abs(m)) + TINY) * WIDEN


def dot(ax: float, ay: float, p: float, bx: float, by: float, q: float) -> tuple[float, float]:
    """a_x b_x + a_y b_y, likewise."""
    left, right = ax * bx, ay * by
    m = left + right
    sizes = (abs(ax) + abs(ay)) * q + (abs(bx) + abs(by) + 2.0 * q) * p
    return m, (sizes + UNIT * (abs(left) + abs(right) + abs(m)) + TINY) * WIDEN


def length(x: float, y: float, e: float) -> tuple[float, float]:
    """The length of a vector whose components are held with the bound e."""
    square, bound = dot(x, y, e, x, y, e)
    return root(square, bound)


def verdict(m: float, e: float) -> int:
    """The sign if it is certain, else 0."""
    if m > e:
        return 1
    if -m > e:
        return -1
    return 0


def cross_sign(ax: float, ay: float, p: float, bx: float, by: float, q: float) -> int:
    """1 or -1 if vector b certainly points to the left or to the right of vector a, else 0; as `cross`."""
    m, e = cross(ax, ay, p, bx, by, q)
    return verdict(m, e)


def dot_sign(ax: float, ay: float, p: float, bx: float, by: float, q: float) -> int:
    """1 or -1 if vector b certainly points with or against vector a, else 0; as `dot`."""
    m, e = dot(ax, ay, p, bx, by, q)
    return verdict(m, e)
