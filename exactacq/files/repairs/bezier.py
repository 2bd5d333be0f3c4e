"""Curves of drawings as rational Bézier pieces with exact coefficients: splines, NURBS, arcs of ellipses.

A piece of degree n is c(t) = sum B_i(t) (x_i, y_i) / sum B_i(t) w_i for t in [0, 1], with Bernstein's
polynomials B_i and weights w_i > 0. Then c(t) is a weighted mean of the points (x_i, y_i) / w_i, its control
points. Source of the algorithms: G. Farin, Curves and Surfaces for CAGD (polar forms, de Casteljau, de Boor).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from flint import fmpq

from exactacq.errors import FormatError

Pair = tuple[fmpq, fmpq]
Row = tuple[fmpq, fmpq, fmpq]
"""(w x, w y, w): a control point (x, y) of weight w."""

MAX_DEGREE = 12
"""Highest degree of a spline; files have 2 to 5."""
ONE = fmpq(1)


@dataclass(frozen=True, slots=True)
class BezierPiece:
    """A rational Bézier curve by its rows (w x, w y, w), of which each w > 0.

    >>> parabola = polynomial([(fmpq(0), fmpq(0)), (fmpq(1), fmpq(2)), (fmpq(2), fmpq(0))])
    >>> parabola.point(fmpq(1, 2))
    (1, 1)
    """

    rows: tuple[Row, ...]

    def point(self, t: fmpq) -> Pair:
        """The point at a parameter in [0, 1]; quadratic in the degree."""
        x, y, w = _steps(self.rows, t)[-1][0]
        return x / w, y / w

    def part(self, low: fmpq, high: fmpq) -> BezierPiece:
        """The piece between two parameters 0 <= low < high <= 1, run through by a parameter in [0, 1]."""
        rows = self.rows
        if high != 1:
            rows = tuple(level[0] for level in _steps(rows, high))
        if low:
            rows = tuple(level[-1] for level in reversed(_steps(rows, low / high)))
        return BezierPiece(_reduced(rows))

    def reach(self) -> tuple[Pair, Pair]:
        """A box that holds the control points, and so the piece."""
        points = self.control()
        xs, ys = [x for x, _ in points], [y for _, y in points]
        return (min(xs), min(ys)), (max(xs), max(ys))

    def control(self) -> list[Pair]:
        """The control points; the first and the last are the ends."""
        return [(x / w, y / w) for x, y, w in self.rows]

    def image(self, origin: Pair, across: Pair, up: Pair) -> BezierPiece:
        """The piece under (x, y) -> origin + x across + y up."""
        rows = [
            (
                w * origin[0] + x * across[0] + y * up[0],
                w * origin[1] + x * across[1] + y * up[1],
                w,
            )
            for x, y, w in self.rows
        ]
        return BezierPiece(tuple(rows))


def _steps(rows: Sequence[Row], t: fmpq) -> list[list[Row]]:
    """The levels of de Casteljau's scheme, the first being the rows."""
    levels = [list(rows)]
    while len(levels[-1]) > 1:
        levels.append([_between(a, b, t) for a, b in pairwise(levels[-1])])
    return levels


def _between(a: Row, b: Row, t: fmpq) -> Row:
    s = ONE - t
    return s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]


def _reduced(rows: Sequence[Row]) -> tuple[Row, ...]:
    """The rows over the first weight: the same curve by shorter numbers."""
    first = rows[0][2]
    return tuple(rows) if first == 1 else tuple((x / first, y / first, w / first) for x, y, w in rows)


def polynomial(points: Sequence[Pair]) -> BezierPiece:
    """The Bézier curve of control points: two make a segment, three a parabola, four a cubic."""
    return BezierPiece(tuple((x, y, ONE) for x, y in points))


def arc_pieces(start: Pair, end: Pair, bulge: fmpq) -> list[BezierPiece]:
    """The circular arc of a bulge, exactly, as one piece of degree 2, or two from half a circle on.

    The arc is the image of w(s) = s / (s + (1 - s) k), k = exp(2 i atan bulge), under z -> start + (end -
    start) z. Over |s + (1 - s) k|^2 its weights are 1, Re k, 1; where Re k is not positive the weights of
    both halves are, 1 and (1 + Re k) / 2.
    """
    square = bulge * bulge
    cosine, sine = (1 - square) / (1 + square), 2 * bulge / (1 + square)
    dx, dy = end[0] - start[0], end[1] - start[1]
    # s (s + (1 - s) conj k) has the Bernstein coefficients 0, conj(k) / 2, 1.
    middle = (
        cosine * start[0] + (cosine * dx + sine * dy) / 2,
        cosine * start[1] + (cosine * dy - sine * dx) / 2,
        cosine,
    )
    whole = BezierPiece(((*start, ONE), middle, (*end, ONE)))
    if cosine > 0:
        return [whole]
    half = fmpq(1, 2)
    return [whole.part(fmpq(0), half), whole.part(half, ONE)]


def spline(
    degree: int, knots: Sequence[fmpq], points: Sequence[Pair], weights: Sequence[fmpq] = ()
) -> list[BezierPiece]:
    """A B-spline, rational with weights (NURBS), as its Bézier pieces between different knots.

    There are len(points) + degree + 1 knots in ascending order; the curve runs from knot no. degree to knot
    no. len(points). Raises `FormatError` for other knots, or weights that are not positive. The control
    points of a piece are values of its polar form; cubic in the degree for each.

    >>> knots = [fmpq(k) for k in (0, 0, 0, 1, 2, 2, 2)]
    >>> points = [(fmpq(x), fmpq(y)) for x, y in ((0, 0), (0, 2), (2, 2), (2, 0))]
    >>> [piece.control() for piece in spline(2, knots, points)]
    [[(0, 0), (0, 2), (1, 2)], [(1, 2), (2, 2), (2, 0)]]
    """
    if not 1 <= degree <= MAX_DEGREE:
        raise FormatError(f"a spline of degree {degree}; degrees 1 to {MAX_DEGREE} are read")
    if len(points) <= degree or len(knots) != len(points) + degree + 1:
        raise FormatError(f"a spline of degree {degree} with {len(points)} points and {len(knots)} knots")
    if any(a > b for a, b in pairwise(knots)):
        raise FormatError("a spline whose knots do not ascend")
    if weights and (len(weights) != len(points) or min(weights) <= 0):
        raise FormatError("a spline whose weights are not positive, one for each point")
    masses = weights or [ONE] * len(points)
    rows = [(x * w, y * w, w) for (x, y), w in zip(points, masses, strict=True)]
    pieces = []
    for i in range(degree, len(points)):
        low, high = knots[i], knots[i + 1]
        if low < high:
            found = [
                _polar(degree, knots, rows, i, [low] * (degree - k) + [high] * k) for k in range(degree + 1)
            ]
            pieces.append(BezierPiece(_reduced(found)))
    if not pieces:
        raise FormatError("a spline whose knots are all equal")
    return pieces


def _polar(degree: int, knots: Sequence[fmpq], rows: Sequence[Row], i: int, at: Sequence[fmpq]) -> Row:
    """The polar form of the piece between knots i and i + 1, by de Boor's scheme."""
    level = list(rows[i - degree : i + 1])
    for r, u in enumerate(at, 1):
        level = [
            _between(a, b, (u - knots[j]) / (knots[j + degree + 1 - r] - knots[j]))
            for j, (a, b) in enumerate(pairwise(level), i - degree + r)
        ]
    return level[0]
