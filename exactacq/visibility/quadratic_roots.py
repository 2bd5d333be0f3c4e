"""Parameters of tangent lines as roots of rational quadratics: which are equal is asked without radicals."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from flint import fmpq


@dataclass(slots=True)
class QuadraticRoot:
    """The root (b + sign sqrt(b^2 - a c)) / a of a t^2 - 2 b t + c, with a not 0; it is real.

    >>> one = QuadraticRoot(fmpq(1), fmpq(0), fmpq(-2), 1)
    >>> one.equals(QuadraticRoot(fmpq(-3), fmpq(0), fmpq(6), -1)), one.is_value(fmpq(1))
    (True, False)
    """

    a: fmpq
    b: fmpq
    c: fmpq
    sign: int

    @property
    def key(self) -> Hashable:
        """Equal keys mean equal roots: the quadratic divided by a, and the side of its axis."""
        b, c = self.b / self.a, self.c / self.a
        return b.p, b.q, c.p, c.q, self.sign if self.a > 0 else -self.sign

    def equals(self, other: QuadraticRoot) -> bool:
        """Whether two roots are one number.

        Two quadratics have a root in common if and only if their resultant q^2 - 4 p r is 0. It is rational,
        q / 2 p, unless one of them is a multiple of the other.
        """
        p = self.a * other.b - self.b * other.a
        q = self.a * other.c - self.c * other.a
        r = self.b * other.c - self.c * other.b
        if q * q != 4 * p * r:
            return False
        if p != 0:
            common = q / (2 * p)
            return self._is_side_of(common) and other._is_side_of(common)
        # Then q is 0 too, and as a is not 0, so is r.
        same_branch = self.sign == (other.sign if (self.a > 0) == (other.a > 0) else -other.sign)
        return same_branch or self.b * self.b == self.a * self.c

    def is_value(self, t: fmpq) -> bool:
        """Whether the root is a rational number."""
        return self.a * t * t - 2 * self.b * t + self.c == 0 and self._is_side_of(t)

    def _is_side_of(self, root: fmpq) -> bool:
        """Whether a root of the quadratic is the one of this sign: a t - b is sign times the radical."""
        return bool((self.a * root - self.b) * self.sign >= 0)


def root_of(a: fmpq, b: fmpq, c: fmpq, sign: int) -> QuadraticRoot | fmpq:
    """The root of a t^2 - 2 b t + c of that sign; if a is 0, the only one there is."""
    return QuadraticRoot(a, b, c, sign) if a != 0 else c / (2 * b)
