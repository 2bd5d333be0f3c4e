"""How far along a line something is in reach: floats with proven bounds tell, else exact numbers."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite

from flint import arb, fmpq

from exactacq.cached import cached_property
from exactacq.geometry.curves import Arc, Curve
from exactacq.kernel import bounded
from exactacq.kernel.extents import Span
from exactacq.numbers.float_bounds import float_ball
from exactacq.numbers.real import Real
from exactacq.strategies.seed_spreader.range_thresholds import last_in_reach

Held = tuple[float, float]
"""A float and a bound of its error."""


class Horizon:
    """The last ordinate with some curve in reach as one walks a vertical line.

    It lies between the ``bounds``, which are floats, once all are multiplied by the sense of the walk; -inf
    stands for none. The ordinate itself is made only if it is asked for.
    """

    def __init__(self, x: fmpq, upward: bool, curves: Sequence[Curve], radius: fmpq) -> None:
        self.x, self.upward, self.sense = x, upward, 1 if upward else -1
        self.curves, self.radius = curves, radius
        self.bounds: Span = self._bounds()

    @cached_property
    def exact(self) -> Real | None:
        """The ordinate; None if nothing is in reach."""
        return last_in_reach(self.x, self.upward, self.curves, self.radius)

    @property
    def late(self) -> Real:
        """The ordinate, which must exist, as a number that is made when the bounds do not tell enough."""
        low, high = self.bounds
        if "exact" not in vars(self) and isfinite(low) and isfinite(high):
            return Real.late(arb(self.sense * low).union(arb(self.sense * high)), self._made)
        return self._made()

    def _made(self) -> Real:
        assert self.exact is not None, "something is in reach"
        return self.exact

    def order(self, y: Real) -> int:
        """1, 0 or -1 as it comes after, at or before an ordinate; -1 if nothing is in reach."""
        (low, high), (begin, end) = self.bounds, _span(_held(y, self.sense))
        if low > end:
            return 1
        if high < begin:
            return -1
        return -1 if self.exact is None else self.exact.compare(y) * self.sense

    def _bounds(self) -> Span:
        """From the ends of the curves, and from all places that a curve may come to.

        A point (u, v) is in reach up to v + sqrt(R^2 - (u - x)^2) if |u - x| <= R, and else from nowhere. The
        ends of curves give the lower bound. For the points of a segment, v is at most that of an end, and
        |u - x| at least the distance of x from the interval of its ends' abscissas. A point of an arc is in
        reach only where the centre is within R + r.
        """
        west, radius = _held(Real(self.x), -1), _held(Real(self.radius))
        low = high = -inf
        for curve in self.curves:
            ends = [
                (bounded.total(*_held(p.x), *west), _held(p.y, self.sense)) for p in (curve.start, curve.end)
            ]
            low = max(low, *(_level(across, v, radius)[0] for across, v in ends))
            if isinstance(curve, Arc):
                across = bounded.total(*_held(curve.center.x), *west)
                reach = bounded.total(*radius, *_held(curve.radius))
                high = max(high, _level(across, _held(curve.center.y, self.sense), reach)[1])
            else:
                sides = [_span(across) for across, _ in ends]
                aside = max(min(side[0] for side in sides), -max(side[1] for side in sides), 0.0)
                v = max((v for _, v in ends), key=lambda held: _span(held)[1])
                high = max(high, _level((aside, 0.0), v, radius)[1])
        return low, high


def reach_begins(sense: int, curves: Sequence[Curve], radius: fmpq) -> float:
    """A float before which, along a vertical line, no curve is in reach: -inf if there is none.

    Times the sense of the walk. What is R or less from a place has an ordinate at most R beyond.
    """
    reach, lows = _held(Real(radius)), []
    for curve in curves:
        places = [(curve.start.y, reach), (curve.end.y, reach)]
        if isinstance(curve, Arc):
            places = [(curve.center.y, bounded.total(*reach, *_held(curve.radius)))]
        for y, (most, error) in places:
            lows.append(_span(bounded.total(*_held(y, sense), -most, error))[0])
    return min(lows, default=-inf)


def at_most(y: Real, sense: int) -> float:
    """A float that an ordinate times the sense of the walk does not exceed."""
    return _span(_held(y, sense))[1]


def _level(across: Held, v: Held, radius: Held) -> Span:
    """Bounds of v + sqrt(R^2 - a^2) for an abscissa a aside; -inf, below or on both sides, where R < |a|."""
    aside = abs(across[0]), across[1]
    rest = bounded.total(*radius, -aside[0], aside[1])
    square = bounded.product(*rest, *bounded.total(*radius, *aside))
    sign = bounded.verdict(*square)
    if sign < 0:
        return -inf, -inf
    low, high = _span(bounded.total(*v, *bounded.root(*square)))
    return (low if sign > 0 else -inf), high


def _held(number: Real, sense: int = 1) -> Held:
    """A number times a sense; (0, inf) where its ball is not finite."""
    middle, error = float_ball(number)
    return (sense * middle, error) if error < inf and isfinite(middle) else (0.0, inf)


def _span(held: Held) -> Span:
    """The ends of a number that is held. Their rounding is made up for: errors count that of m twice."""
    middle, error = held
    return middle - error, middle + error
