"""Where a view is as long as the range if a side of it runs along an irrational line, a way of the robot.

With contact c(t) and direction d(t) of a sector's lines, a side lies at c + s d, with s = (A + sqrt(D)) / B
for polynomials in t (D = 0 on straight sides), and f(t) = |d|^2 (s_ahead - s_behind)^2 - R^2 is 0 where the
view is as long as the range R. `exactacq.numbers.function_zeros` finds where.

Bounds. The product N of the numerators of f over the signs of both roots is a polynomial in t. It is not 0:
towards the t where a line is parallel to a straight side s has a pole, and on a circle it has none there. The
numerators of A, B, D and |d|^2 have degrees of at most 4 in t and 4 in each number that defines the
function, and at most 2^9 for the sum of their absolute coefficients, 2^7 without D; so N has degrees of at
most 4 (4 + 2 (4 + 4)) = 80 and a coefficient sum of at most (2^3 (2^2 2^7 2^9)^2 + 2^29)^4 < 2^160. A root of
a polynomial of degree n has at most the polynomial's height plus n (Silverman, The Arithmetic of Elliptic
Curves, VIII.5.9), so zeros have degree at most 80 over the field of the numbers, whose degree is at most
the product of those of their generators, and height at most 80 times the sum of their heights plus 240.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from math import prod
from typing import Any, TypeAlias

from flint import arb, arb_series, ctx, fmpq

from exactacq.cached import cached_property
from exactacq.geometry.coordinates import Vector, cross, dot, minus
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.function_zeros import BITS, Parts, zeros_between
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.visibility.line_families import Sector

_Line: TypeAlias = "Callable[[Any], tuple[Vector, Vector]]"
"""Contact and direction of the line at a parameter, in the parameter's arithmetic."""
DEGREE = 80
SPREAD = 240
LINES = ("lines through a corner", 5), ("lines that roll on a circle", 5)
"""The two kinds of lines, and how many numbers define them."""
NEAR, FAR = "near crossing", "far crossing"


@dataclass(frozen=True, eq=False)
class _LengthSide(ABC):
    """One side of a view: the carrier of its curve, by the numbers that define it."""

    numbers: tuple[Real, ...]

    @property
    @abstractmethod
    def name(self) -> str:
        """What the numbers define."""

    @abstractmethod
    def place(self, numbers: tuple[Any, ...], t: Any, line: _Line, root: Any) -> Any:
        """The s of the module's docstring, in the arithmetic of t, which *numbers* have been brought to.

        On a circle the *root* of D may be given; else it is computed.
        """


class _Straight(_LengthSide):
    """The line through a point, given with its direction."""

    name = "line"

    def place(self, numbers: tuple[Any, ...], t: Any, line: _Line, root: Any) -> Any:
        start, along = numbers[:2], numbers[2:]

        def height(t: Any) -> Any:
            return cross(minus(start, line(t)[0]), along)

        return _tight(height, t) / cross(line(t)[1], along)


class _Tangent(_LengthSide):
    """A line that touches the circle on which the contact rolls, given by p and q: it does so at t = p / q.

    Two tangents meet at the tangent of half the angle between their contacts; `_Straight` has 0 / 0 there.
    """

    name = "tangent"

    def place(self, numbers: tuple[Any, ...], t: Any, line: _Line, root: Any) -> Any:
        p, q = numbers
        return (p - t * q) / (q + t * p)


@dataclass(frozen=True, eq=False)
class _Round(_LengthSide):
    """A circle, given by its centre and squared radius; ``far`` is the sign of the root."""

    far: int

    @property
    def name(self) -> str:
        return FAR if self.far > 0 else NEAR

    def place(self, numbers: tuple[Any, ...], t: Any, line: _Line, root: Any) -> Any:
        contact, direction = line(t)
        to_center, size = minus(numbers[:2], contact), dot(direction, direction)
        along, known = dot(to_center, direction), root is not None
        root = self.far * (root if known else _root(_square(numbers, t, line)))
        if _are_opposite(along, root):
            # On a circle that is large beside its arc the two nearly cancel.
            return _tight(partial(_power, numbers, line), t) / (along - root)
        return (along + root) / size


class _Through(_LengthSide):
    """A circle through the corner that the lines turn about, given by its centre: the other crossing."""

    name = "other crossing"

    def place(self, numbers: tuple[Any, ...], t: Any, line: _Line, root: Any) -> Any:
        contact, direction = line(t)
        return 2 * dot(minus(numbers, contact), direction) / dot(direction, direction)


@dataclass(frozen=True, eq=False)
class ViewLength:
    """The function f of the module's docstring; ``numbers`` are the sector's centre and base, and R^2."""

    round: bool
    numbers: tuple[Real, ...]
    sides: tuple[_LengthSide, _LengthSide]

    @property
    def parts(self) -> Parts:
        """The kind of the lines and of both sides, each with the numbers that define it."""
        name, _ = LINES[self.round]
        return (name, self.numbers), *((side.name, side.numbers) for side in self.sides)

    @classmethod
    def of_parts(cls, parts: Parts) -> ViewLength:
        """The function that has these parts; ValueError if none has."""
        kinds = [(name, len(numbers)) for name, numbers in parts]
        if len(kinds) != 3 or kinds[0] not in LINES or not {*kinds[1:]} <= {*SIDES}:
            raise ValueError("these are no parts of the length of views")
        (_, numbers), *ends = parts
        one, other = (SIDES[kind](end[1]) for kind, end in zip(kinds[1:], ends, strict=True))
        return cls(kinds[0] == LINES[1], numbers, (one, other))

    @cached_property
    def key(self) -> Hashable:
        """Structural identity."""
        return tuple((name, *(number.key for number in numbers)) for name, numbers in self.parts)

    @cached_property
    def degree(self) -> int:
        """Upper bound of the degrees of the zeros."""
        return DEGREE * prod(d for _, d in frozenset().union(*(n.generators() for n in self._all)))

    @cached_property
    def height(self) -> float:
        """Upper bound of the heights of the zeros."""
        return DEGREE * sum(n.height_bound() for n in self._all) + SPREAD

    @property
    def _all(self) -> Iterator[Real]:
        return (number for _, numbers in self.parts for number in numbers)

    def __call__(self, t: Any) -> Any:
        """The value at a Real, an arb or an arb_series (the latter at the working precision)."""
        return self._value(t, None)

    def _value(self, t: Any, root: Any) -> Any:
        *frame, square = _alike(self.numbers, t)
        line = partial(_line, self.round, frame)
        behind, ahead = (side.place(_alike(side.numbers, t), t, line, root) for side in self.sides)
        direction, length = line(t)[1], ahead - behind
        return dot(direction, direction) * length * length - square

    def sense(self, cell: arb) -> int:
        """1 or -1 if the function grows or falls all over a cell, where its slope may be infinite; else 0.

        With q = sqrt(D) the slope is df/dt + D' df/dq / 2 q: its product with q is finite, and has its sign.
        """
        circle = next((side for side in self.sides if isinstance(side, _Round)), None)
        if circle is None:
            return 0
        along, still = arb_series([cell, 1], prec=2), arb_series([cell, 0], prec=2)
        line = partial(_line, self.round, _alike(self.numbers, cell)[:4])
        square = _square(_alike(circle.numbers, cell), along, line)
        root = _root(square[0])
        by_t = self._value(along, arb_series([root, 0], prec=2))[1]
        by_root = self._value(still, arb_series([root, 1], prec=2))[1]
        return ball_sign(root * by_t + square[1] * by_root / 2)

    def __str__(self) -> str:
        kind = "touching a circle about" if self.round else "through"
        x, y, _, _, square = (float(n) for n in self.numbers)
        return f"the length of views along lines {kind} ({x:.9g}, {y:.9g}), less the range {square**0.5:.9g},"


SIDES: dict[tuple[str, int], Callable[[tuple[Real, ...]], _LengthSide]] = {
    (_Straight.name, 4): _Straight,
    (_Tangent.name, 2): _Tangent,
    (NEAR, 3): partial(_Round, far=-1),
    (FAR, 3): partial(_Round, far=1),
    (_Through.name, 2): _Through,
}
"""The kinds of sides, by their names and how many numbers define them."""


def of_length_on(
    sector: Sector,
    behind: Curve,
    ahead: Curve,
    square: fmpq,
    low: Real,
    high: Real,
    touching: Curve | None = None,
    longer_at: Callable[[Real], int] | None = None,
    known: Sequence[Real] = (),
    is_flat: Callable[[Real], bool] = lambda t: False,
) -> list[Real]:
    """All t strictly between *low* and *high* where a view's squared length is *square*, ascending.

    Of Turning or Rolling lines which from low to high meet the carriers of both curves, behind and ahead of
    the contact; at least one is a segment. *touching* is a segment known to touch the circle that lines roll
    on; of others it is found out where it matters. *longer_at* compares the views at the two ends with the
    value, and *known* are some of the t, which are given back as they are. `Undecided` where the length is
    stationary at that value, but for an end of which *is_flat* knows it. A millisecond, for numbers of small
    degree.
    """
    numbers = tuple(Real(n) for n in (*sector.center, *sector.base, square))
    ends = (low, high)
    one, other = (
        _side(sector, curve, side, curve is touching or _touches(sector, curve, ends))
        for curve, side in ((behind, -1), (ahead, 1))
    )
    length = ViewLength(sector.round, numbers, (one, other))
    return zeros_between(length, low, high, longer_at, known, is_flat)


def _touches(sector: Sector, curve: Curve, ends: tuple[Real, Real]) -> bool:
    """Whether a segment's line touches the circle that lines roll on, at one of the ends."""
    if not sector.round or not isinstance(curve, Segment):
        return False
    along = curve.direction
    if all(abs(sector.touch(t)[1].cross(along).ball(BITS)) > 0 for t in ends):
        return False
    offset = along.cross(curve.start - Point(*sector.center))
    return (offset * offset).compare(along.norm_sq() * dot(sector.base, sector.base)) == 0


def _side(sector: Sector, curve: Curve, side: int, touches: bool) -> _LengthSide:
    if isinstance(curve, Segment):
        return _tangent(sector, curve) if touches else _Straight((*curve.start, *curve.direction))
    center = curve.center
    if not sector.round:
        radius = minus((center.x, center.y), sector.center)
        if dot(radius, radius) == curve.radius_sq:
            return _Through((center.x, center.y))
    # As in `chords.meet`: an arc's far crossing is met from inside its circle.
    far = -side if curve.ccw else side
    return _Round((center.x, center.y, Real(curve.radius_sq)), far)


def _tangent(sector: Sector, line: Segment) -> _Tangent:
    """With n across the line and w the product of n with the vector to it, the contact is at w n / n^2."""
    center, base = Point(*sector.center), Point(*sector.base)
    across = line.direction.left()
    offset, steep, size = across.dot(line.start - center), across.norm_sq(), base.norm_sq()
    return _Tangent((offset * base.cross(across), steep * size + offset * base.dot(across)))


def _alike(numbers: tuple[Real, ...], t: Any) -> tuple[Any, ...]:
    """Numbers in the arithmetic of t."""
    if isinstance(t, Real):
        return numbers
    return tuple(number.working_ball(ctx.prec) for number in numbers)


def _line(is_round: bool, frame: Sequence[Any], t: Any) -> tuple[Vector, Vector]:
    """Contact and direction at a parameter, of lines whose sector has these centre and base."""
    cx, cy, ex, ey = frame
    if not is_round:
        return (cx, cy), (ex - t * ey, ey + t * ex)
    growth = 1 + t * t
    cosine, sine = 2 / growth - 1, 2 * t / growth
    vx, vy = cosine * ex - sine * ey, cosine * ey + sine * ex
    return (cx + vx, cy + vy), (-vy, vx)


def _square(numbers: tuple[Any, ...], t: Any, line: _Line) -> Any:
    """What is under the root on a circle: |d|^2 r^2 - ((m - c) x d)^2."""

    def value(t: Any) -> Any:
        contact, direction = line(t)
        across = cross(minus(numbers[:2], contact), direction)
        return dot(direction, direction) * numbers[2] - across * across

    return _tight(value, t)


def _power(numbers: tuple[Any, ...], line: _Line, t: Any) -> Any:
    """The power of the contact with respect to a circle: |m - c|^2 - r^2."""
    to_center = minus(numbers[:2], line(t)[0])
    return dot(to_center, to_center) - numbers[2]


def _tight(value: Callable[[Any], Any], t: Any) -> Any:
    """The value at t; a ball, or a series about one, that contains 0 is tightened by the mean value theorem.

    Where lines nearly touch a large circle, roll on nearly the same one, or nearly run along a straight side,
    the value hardly changes, though all that it is made of does.
    """
    found = value(t)
    if isinstance(found, Real) or ball_sign(head := _head(found)):
        return found
    cell = _head(t)
    middle, along = cell.mid(), value(arb_series([cell, 1], prec=2))
    if isinstance(along, arb):
        # It does not depend on t.
        return found
    head = head.intersection(value(middle) + along[1] * (cell - middle))
    return head if isinstance(found, arb) else arb_series([head, *list(found)[1:]], prec=found.prec)


def _head(value: Any) -> arb:
    """The value of a ball, or the first coefficient of a series."""
    return value if isinstance(value, arb) else value[0]


def _are_opposite(a: Any, b: Any) -> bool:
    """Whether balls, or series of balls, surely have opposite signs; numbers are told by any formula."""
    if isinstance(a, Real) or isinstance(b, Real):
        return False
    return ball_sign(_head(a)) * ball_sign(_head(b)) < 0


def _root(square: Any) -> Any:
    """The square root; of a ball, that of the part which is not negative."""
    return square.nonnegative_part().sqrt() if isinstance(square, arb) else square.sqrt()
