"""Zeros of rational polynomials, and of algebraic functions that have no convenient polynomial.

Of polynomials `roots` gives all. Eliminating the radicals of a function over a field of high degree would
take polynomials that nobody can factor. Its simple zeros need none: where the slope has a sign, a change of
the function's own sign proves exactly one zero, and interval Newton steps refine it (Moore, Kearfott, Cloud,
Introduction to Interval Analysis, chapter 8). Intervals are dyadic cells, whatever the range that is asked
for, so that one zero is one number.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from flint import arb, arb_series, fmpq, fmpz, fmpz_poly

from exactacq.errors import Undecided
from exactacq.numbers.atoms import Generators, Node
from exactacq.numbers.linear_forms import irreducible_roots
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import ball_sign, decimal_string, rational
from exactacq.numbers.real import Real

if TYPE_CHECKING:
    import sympy

BITS = 256
"""Working precision of the search, and the least with which a zero is refined."""
FINENESS = 100
"""A cell of 2^-100 that shows neither a sign nor a slope holds a double zero, or is taken to. In a range of
width w < 1 cells are searched down to 2^-100 w^3."""
DEEPEST = 3000
"""A zero that is known to lie in a cell, beside an end like a root, is sought down to 2^-3000."""
MOST_CELLS = 50_000
"""Cells of a range that are looked at: some seconds' work. Nearly all searches take a few hundred at most."""
STALLED_BITS = 1 << 16
"""A zero that is not told better than by its cell with so many bits never is."""
PROVING_BITS = 1 << 13
"""Precision with which a zero that is read is proved, if less does not do: who wrote it may mean harm."""
SHOWN_DIGITS = 30
"""Decimals that stand for a zero where a closed form is asked for."""


def roots(coefficients: Iterable[object]) -> list[Real]:
    """All distinct real roots, ascending, of ``c_0 + c_1 x + ...`` with rational coefficients.

    Rational and quadratic roots come in closed form.  ValueError for the zero polynomial.
    """
    values = [rational(c) for c in coefficients]
    common = fmpz(1)
    for c in values:
        common = common.lcm(c.q)
    whole = fmpz_poly([(c * common).p for c in values])
    if whole.degree() < 0:
        raise ValueError("every number is a root of the zero polynomial")
    forms = (root for factor, _ in whole.factor()[1] for root in irreducible_roots(factor))
    return sorted(Real.sum(c * Real.of_atom(atom) for atom, c in form.items()) for form in forms)


Parts: TypeAlias = "tuple[tuple[str, tuple[Real, ...]], ...]"
"""What a function is made of: numbers under names."""


class Function(Protocol):
    """A real function of one variable, analytic wherever its slope is finite."""

    @property
    def parts(self) -> Parts:
        """What it is made of: equal parts are the same function."""

    @property
    def key(self) -> Hashable:
        """Structural identity: equal keys are the same function."""

    @property
    def degree(self) -> int:
        """Upper bound of the degrees of the zeros over the rationals."""

    @property
    def height(self) -> float:
        """Upper bound of the absolute logarithmic heights of the zeros, base 2."""

    def __call__(self, t: Any) -> Any:
        """The value at a Real; or, at the working precision, at an arb or an arb_series.

        Exact at a Real. On a ball an enclosure, not finite (or ValueError, for a series) where it has none.
        """

    def sense(self, cell: arb) -> int:
        """1 or -1 if it surely grows or falls in all of a cell where it is real; else 0, or ValueError.

        The slope may be infinite there. Asked at the ends of a range, at the working precision.
        """


class Zero(Node):
    """The one zero of a function between two rationals: there its slope has a sign, and about one size."""

    __slots__ = ()
    args: tuple[Function, fmpq, fmpq]

    @classmethod
    def make(cls, *args: Any) -> Node:
        """Of a function and the ends of the cell, as `zeros_between` proves them."""
        function, low, high = args
        return cls._intern((cls, function.key, low, high), args)

    def _evaluate(self, bits: int) -> arb:
        """Newton steps from the cell, or from the last ball; each gains a bit until rounding errors are met.

        With m <= |f'| <= M in a ball of radius r around c, f(c) / f' has radius at most r (M/m - 1) / 2. That
        M/m < 2 is known of the cell; of a part of it another formula may tell less.
        """
        function, low, high = self.args
        # That of the search, which narrow cells need.
        depth = (high - low).q.bit_length() - 1
        with workprec(max(bits, BITS) + 2 * max(0, depth - FINENESS)):
            cell = _cell(low, high)
            ball, slope = self._ball if self._bits else cell, _slope(function, cell)
            while True:
                if (here := _slope(function, ball)).is_finite():
                    slope = slope.intersection(here)
                middle = ball.mid()
                finer = middle - function(middle) / slope
                if not finer.rad() < ball.rad() / 2:
                    break
                ball = finer.intersection(ball)
        if bits > STALLED_BITS and ball.rad() > cell.rad() / 4:
            raise Undecided(f"where {function} is 0 near {float(low):.15g}, in more than {bits} bits")
        return ball

    def _bound(self) -> float:
        return self.args[0].height

    def _collect(self) -> Generators:
        return frozenset({(self, self.args[0].degree)})

    def sympy(self) -> sympy.Expr:
        """A decimal: there is no closed form."""
        from sympy import Float

        return Float(decimal_string(self.precise_ball, SHOWN_DIGITS), SHOWN_DIGITS)


def zeros_between(
    function: Function,
    low: Real,
    high: Real,
    sign_at: Callable[[Real], int] | None = None,
    known: Sequence[Real] = (),
    is_flat: Callable[[Real], bool] = lambda t: False,
) -> list[Real]:
    """The zeros strictly between two numbers, ascending; the function is real and finite from low to high.

    *sign_at* knows an easier way to the function's exact sign at the two ends, where the slope may be
    infinite. Zeros that are *known* are given back as they are. `Undecided` at a double zero (or nearly so),
    but for one at an end of which *is_flat* knows that function and slope are 0 there, and beyond
    `MOST_CELLS`.
    Which side of an end a zero lies on is asked of the function at that end: it is exact, and no comparison
    of numbers of large degree.
    """
    begin, end = low.enclosure(BITS)[0], high.enclosure(BITS)[1]
    # A family of lines may be 10^-31 wide, where one of them nearly touches the circle that they roll on.
    extent = end - begin
    deepest = FINENESS + 3 * max(0, extent.q.bit_length() - extent.p.bit_length())
    cells = [(fmpq(n), fmpq(n + 1)) for n in range(int(begin.floor()), int(end.ceil()))][::-1]
    found: list[Real] = []
    looked_at = 0
    while cells:
        left, right = cells.pop()
        if right < begin or left > end:
            continue
        looked_at, limit = looked_at + 1, deepest
        if looked_at > MOST_CELLS:
            raise Undecided(f"{function} is too close to 0 about {float(left):.15g} to tell where it is")
        depth = (right - left).q.bit_length() - 1
        # The precision is the cell's own, for the same reason as its ends.
        with workprec(BITS + 2 * max(0, depth - FINENESS)):
            cell = _cell(left, right)
            slope = _slope(function, cell)
            if _excludes_zero(function, cell, slope):
                continue
            is_steady = _is_steady(slope)
            ends = [t for t, is_near in ((low, left <= begin), (high, right >= end)) if is_near]
            # Beside a root at an end the slope is infinite, or so large that no cell bounds it well.
            is_steep = not is_steady and ((bool(ends) and not slope.is_finite()) or depth > deepest)
            is_steep = is_steep and _is_monotone(function, cell)
            is_bent = bool(ends) and ball_sign(slope) == 0 and ball_sign(_bend(function, cell)) != 0
        if is_bent and any(
            t.compare(left) >= 0 >= t.compare(right) and not _clear_sign(function, t) and is_flat(t)
            for t in ends
        ):
            continue
        if is_steep:
            # Where a cell juts out the function may not be real; it is narrower than what encloses an end.
            first = low if low.compare(left) >= 0 else Real(left)
            last = high if high.compare(right) <= 0 else Real(right)
            if first.compare(last) >= 0:
                continue
            before, after = (
                _sign(function, t, None if t is not low and t is not high else sign_at) for t in (first, last)
            )
            if before == after or after == 0 or (before == 0 and first is low):
                # Its only zero is an end, or there is none.
                continue
            # It has one. A value that nearly vanishes at an end like a root has it at the square of that.
            limit = max(deepest, DEEPEST)
        if is_steady or (is_steep and before == 0):
            found += _zero_in(function, left, right, low, high, sign_at, known)
        elif depth > limit:
            raise Undecided(
                f"{function} is stationary, or begins or ends, about at 0 near {float(left):.15g}"
            )
        else:
            middle = (left + right) / 2
            cells += [(middle, right), (left, middle)]
    return found


def zero_between(function: Function, low: fmpq, high: fmpq) -> Real:
    """The one zero in a cell that `zeros_between` found, proved again by balls; ValueError if they do not."""
    for bits in (BITS, PROVING_BITS) if low < high else ():
        with workprec(bits):
            before, after = (ball_sign(function(arb(t))) for t in (low, high))
            if before * after < 0 and _is_steady(_slope(function, _cell(low, high))):
                return Real.of_atom(Zero.make(function, low, high))
    raise ValueError(f"not one zero between {float(low):.15g} and {float(high):.15g}")


def _zero_in(
    function: Function,
    left: fmpq,
    right: fmpq,
    low: Real,
    high: Real,
    sign_at: Callable[[Real], int] | None,
    known: Sequence[Real],
) -> Iterator[Real]:
    """The zero of a monotone function in [left, right), if there is one strictly between low and high."""
    before, after = (_sign_in_cell(function, t, (low, high), sign_at) for t in (left, right))
    if before == 0:
        zero = Real(left)
        if zero.compare(low) > 0 and zero.compare(high) < 0:
            yield zero
    elif before * after < 0:
        begins = low.compare(left) <= 0 or (
            low.compare(right) < 0 and _sign(function, low, sign_at) == before
        )
        ends = high.compare(right) >= 0 or (
            high.compare(left) > 0 and _sign(function, high, sign_at) == after
        )
        if begins and ends:
            here = [zero for zero in known if zero.compare(left) > 0 and zero.compare(right) < 0]
            yield here[0] if here else Real.of_atom(Zero.make(function, left, right))


def _sign_in_cell(
    function: Function, t: fmpq, ends: tuple[Real, Real], sign_at: Callable[[Real], int] | None
) -> int:
    """The sign at an end of a cell, which may be one of the *ends* of which *sign_at* knows an easier way."""
    end = next((end for end in ends if not end.is_late and end.rational == t), None)
    return _sign(function, Real(t)) if end is None else _sign(function, end, sign_at)


def _sign(function: Function, t: Real, exact: Callable[[Real], int] | None = None) -> int:
    """The sign of a value: by a ball, and exactly if the ball contains 0."""
    return _clear_sign(function, t) or (int(function(t).sign()) if exact is None else exact(t))


def _clear_sign(function: Function, t: Real) -> int:
    """The sign of a value by a ball; 0 if that contains 0."""
    with workprec(BITS):
        return ball_sign(function(t.working_ball(BITS)))


def _excludes_zero(function: Function, cell: arb, slope: arb) -> bool:
    """Whether a function has no zero in a cell, by its enclosure or by the mean value theorem."""
    if ball_sign(function(cell)):
        return True
    middle = cell.mid()
    return ball_sign(function(middle) + slope * (cell - middle)) != 0


def _slope(function: Function, cell: arb) -> arb:
    """Enclosure of the derivative; not finite where that has none."""
    try:
        return function(arb_series([cell, 1], prec=2))[1]
    except ValueError:
        # A denominator contains 0.
        return arb.nan()


def _bend(function: Function, cell: arb) -> arb:
    """Enclosure of the second derivative, halved; not finite where that has none."""
    try:
        return function(arb_series([cell, 1], prec=3))[2]
    except ValueError:
        return arb.nan()


def _is_steady(slope: arb) -> bool:
    """Whether a slope has a sign and, up to a factor of 2, one size."""
    return bool(slope.abs_upper() < 2 * slope.abs_lower())


def _is_monotone(function: Function, cell: arb) -> bool:
    """Whether a function surely grows or falls in all of a cell."""
    try:
        return function.sense(cell) != 0
    except ValueError:
        return False


def _cell(low: fmpq, high: fmpq) -> arb:
    """The interval between two dyadic rationals as a ball."""
    return arb((low + high) / 2, (high - low) / 2)
