"""Chords: the shortest segments in families of free segments.

In one cell of a tangent family (see `exactacq.visibility.rotational_sweep`) the chord with parameter t
runs from the first edge behind the contact to the first edge ahead. Its length is, up to a constant
factor, s g(t) with s = sqrt(1 + t^2) at a corner and s = 1 at a circle, where g is a sum of a rational
function (straight edges, centres) and of rational multiples of sqrt(D_k(t)) (one for each circle that an
end lies on). The derivative's zeros are among the roots of one rational polynomial; for two straight
edges and a corner it is a cubic. Squaring adds further roots, which do no harm: every t of a closed cell
gives a free chord.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, fmpq, fmpq_poly

from exactacq.geometry.coordinates import Vector, cross, dot
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.late import BITS
from exactacq.geometry.points import Point
from exactacq.numbers.function_zeros import roots
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.visibility.line_balls import CurveBalls, line
from exactacq.visibility.line_families import Sector

X = fmpq_poly([0, 1])
UNIT = fmpq_poly([1])
GROWTH = fmpq_poly([1, 0, 1])
"""1 + t^2"""


@dataclass(frozen=True, slots=True)
class Chord:
    """A free segment and its exact length."""

    start: Point
    end: Point
    length: Real

    def reversed(self) -> Chord:
        """The chord from ``end`` to ``start``."""
        return Chord(self.end, self.start, self.length)


class _Fraction:
    """A rational function over Q."""

    __slots__ = ("bottom", "top")

    def __init__(self, top: fmpq_poly, bottom: fmpq_poly = UNIT) -> None:
        self.top, self.bottom = top, bottom

    def __add__(self, other: _Fraction) -> _Fraction:
        return _Fraction(self.top * other.bottom + other.top * self.bottom, self.bottom * other.bottom)

    def __mul__(self, other: _Fraction) -> _Fraction:
        return _Fraction(self.top * other.top, self.bottom * other.bottom)

    def __neg__(self) -> _Fraction:
        return _Fraction(-self.top, self.bottom)

    def derivative(self) -> _Fraction:
        top = self.top.derivative() * self.bottom - self.top * self.bottom.derivative()
        return _Fraction(top, self.bottom * self.bottom)

    def reduced(self) -> _Fraction:
        common = self.top.gcd(self.bottom)
        return self if common.degree() < 1 else _Fraction(self.top // common, self.bottom // common)

    def __bool__(self) -> bool:
        return not self.top.is_zero()


def chord_at(sector: Sector, t: Real, behind: Curve | None, ahead: Curve) -> Chord:
    """The chord of the line at *t*; from the contact itself, as a ray, if *behind* is None."""
    contact, direction = sector.touch(t)
    low = Real(0) if behind is None else meet(contact, direction, behind, -1)
    high = meet(contact, direction, ahead, 1)
    start, end = contact + direction * low, contact + direction * high
    if sector.round:
        # The direction is as long as the radius. The same chord found at another circle has the same roots.
        return Chord(start, end, (high - low) * Real(dot(sector.base, sector.base)).sqrt())
    return Chord(start, end, (end - start).norm_sq().sqrt())


def length_ball(sector: Sector, t: Real, behind: Curve | None, ahead: Curve) -> arb | None:
    """A ball around the length of that chord, or None: the line may run along an edge."""
    at = line(sector, t.ball(BITS))
    low = None if behind is None else CurveBalls(behind).met(at, -1)
    high = CurveBalls(ahead).met(at, 1)
    if high is None or (low is None and behind is not None):
        return None
    share = high[0] if low is None else high[0] - low[0]
    return share * (at[2] * at[2] + at[3] * at[3]).sqrt()


def critical(sector: Sector, behind: Curve | None, ahead: Curve) -> list[Real] | None:
    """A finite superset of the t where the chord's length is stationary; None if it is constant."""
    polynomial = _eliminate(*_derivative(sector, behind, ahead))
    return None if polynomial.is_zero() else roots(polynomial.coeffs())


def meet(contact: Point, direction: Point, edge: Curve, side: int) -> Real:
    """Parameter at which the line enters the obstacle through *edge*, going ahead (1) or back (-1)."""
    if isinstance(edge, Segment):
        along = edge.direction
        straight: Real = (edge.start - contact).cross(along) / direction.cross(along)
        return straight
    to_center = edge.center - contact
    middle, size = to_center.dot(direction), direction.norm_sq()
    square = middle * middle - size * (to_center.norm_sq() - edge.radius_sq)
    # An arc's far crossing is met from inside its circle: there the obstacle lies outside.
    far = -side if edge.ccw else side
    curved: Real = (middle + far * square.sqrt()) / size
    return curved


def of_length(sector: Sector, behind: Curve | None, ahead: Curve | None, square: fmpq) -> list[Real]:
    """A finite superset of the t where the chord's squared length is *square*, of Turning or Rolling lines.

    From the contact itself if an edge is None. Empty where the length is constant. With g as in the module's
    docstring, G g^2 = square |e|^2 with G = 1 + t^2 at a corner and 1 at a circle; the radicals go by norms.
    """
    plain, radicals = _scaled_length(sector, behind, ahead)
    growth = UNIT if sector.round else GROWTH
    value = plain * plain
    for factor, under in radicals:
        value = value + factor * factor * _Fraction(under)
    rest = _Fraction(growth) * value + _Fraction(-square * dot(sector.base, sector.base) * UNIT)
    rest = rest.reduced()
    if radicals:
        twice = _Fraction(2 * growth) * plain
        parts = [(twice * factor).reduced() for factor, _ in radicals]
        under = radicals[0][1]
        if len(radicals) == 1:
            rest = rest * rest + -(parts[0] * parts[0] * _Fraction(under))
        else:
            other = _Fraction(radicals[1][1])
            both = (_Fraction(2 * growth) * radicals[0][0] * radicals[1][0]).reduced()
            first = _Fraction(under)
            # (rest + a r + b s + c r s)(rest + a r - b s - c r s) = norm + 2 mixed r, with r^2 = first
            norm = rest * rest + parts[0] * parts[0] * first
            norm = (norm + -(other * (parts[1] * parts[1] + both * both * first))).reduced()
            mixed = (rest * parts[0] + -(other * parts[1] * both)).reduced()
            rest = norm * norm + -(_Fraction(4 * UNIT) * mixed * mixed * first)
    polynomial = rest.reduced().top
    return [] if polynomial.is_zero() else roots(polynomial.coeffs())


def _scaled_length(
    sector: Sector, behind: Curve | None, ahead: Curve | None
) -> tuple[_Fraction, list[tuple[_Fraction, fmpq_poly]]]:
    """The function g of the module's docstring: a fraction, and factors of square roots."""
    plain = _Fraction(fmpq_poly([0]))
    radicals: list[tuple[_Fraction, fmpq_poly]] = []
    for edge, side in ((behind, -1), (ahead, 1)):
        if edge is None:
            continue
        part, radical = _half(sector, edge, side)
        plain = plain + (part if side > 0 else -part)
        if radical is not None:
            factor, square = radical
            _collect(radicals, factor if side > 0 else -factor, square)
    return plain, radicals


def _derivative(
    sector: Sector, behind: Curve | None, ahead: Curve
) -> tuple[_Fraction, list[tuple[_Fraction, fmpq_poly]]]:
    """The derivative of the length as slope + sum of R_k / sqrt(D_k), times a positive function."""
    plain, radicals = _scaled_length(sector, behind, ahead)
    slope = _grown(sector, plain, plain.derivative())
    terms = []
    for factor, square in radicals:
        # (f sqrt(D))' = (f' D + f D' / 2) / sqrt(D)
        change = factor.derivative() * _Fraction(square) + factor * _Fraction(square.derivative(), 2 * UNIT)
        if term := _grown(sector, factor * _Fraction(square), change):
            terms.append((term.reduced(), square))
    return slope.reduced(), terms


def _grown(sector: Sector, value: _Fraction, derivative: _Fraction) -> _Fraction:
    """(s g)' / s' s at a corner (s = sqrt(1 + t^2)), g' at a circle."""
    if sector.round:
        return derivative
    return _Fraction(X) * value + _Fraction(GROWTH) * derivative


def _half(sector: Sector, edge: Curve, side: int) -> tuple[_Fraction, tuple[_Fraction, fmpq_poly] | None]:
    """Signed length from the contact to *edge*, scaled as the module's docstring says."""
    size = dot(sector.base, sector.base)
    if isinstance(edge, Segment):
        normal = _vector(edge.direction.left())
        offset = dot(normal, _shifted(edge.start, sector.center))
        if sector.round:
            spoke, tangent = _spoke(sector, normal)
            return _Fraction(size * (offset * GROWTH - spoke), tangent), None
        ahead = fmpq_poly([dot(sector.base, normal), cross(sector.base, normal)])
        return _Fraction(size * offset * UNIT, ahead), None
    middle = _shifted(edge.center, sector.center)
    far = fmpq(-side if edge.ccw else side)
    if sector.round:
        spoke, tangent = _spoke(sector, middle)
        height = spoke - size * GROWTH
        square = edge.radius_sq * size * GROWTH * GROWTH - height * height
        return _Fraction(tangent, GROWTH), (_Fraction(far * UNIT, GROWTH), square)
    along = fmpq_poly([dot(sector.base, middle), cross(sector.base, middle)])
    excess = dot(middle, middle) - edge.radius_sq
    if excess == 0:
        # The arc ends at this corner: its other crossing is at twice the foot of the centre.
        return _Fraction(2 * along, GROWTH), None
    square = along * along - size * excess * GROWTH
    return _Fraction(along, GROWTH), (_Fraction(far * UNIT, GROWTH), square)


def _spoke(sector: Sector, vector: Vector) -> tuple[fmpq_poly, fmpq_poly]:
    """(1 + t^2) v(t) . vector and (1 + t^2) d(t) . vector at a circle."""
    p, q = dot(sector.base, vector), cross(sector.base, vector)
    return fmpq_poly([p, 2 * q, -p]), fmpq_poly([q, -2 * p, -q])


def _collect(radicals: list[tuple[_Fraction, fmpq_poly]], factor: _Fraction, square: fmpq_poly) -> None:
    """Add factor * sqrt(square), merging radicals whose ratio is the square of a rational."""
    if square.is_zero():
        return
    for k, (other, known) in enumerate(radicals):
        ratio = square.leading_coefficient() / known.leading_coefficient()
        if ratio > 0 and square == ratio * known:
            side = Real(ratio).sqrt().rational
            if side is not None:
                radicals[k] = (other + factor * _Fraction(side * UNIT), known)
                return
    radicals.append((factor, square))


def _eliminate(slope: _Fraction, terms: list[tuple[_Fraction, fmpq_poly]]) -> fmpq_poly:
    """A polynomial that vanishes wherever slope + sum of R_k / sqrt(D_k) does."""
    if not terms:
        return slope.top
    squares = [(r * r * _Fraction(UNIT, d)).reduced() for r, d in terms]
    rest = slope * slope
    for square in squares:
        rest = (rest + -square).reduced()
    if len(terms) == 1:
        return rest.top
    return (rest * rest + -(_Fraction(4 * UNIT) * squares[0] * squares[1])).reduced().top


def _shifted(point: Point, center: Vector) -> Vector:
    x, y = _vector(point)
    return x - center[0], y - center[1]


def _vector(point: Point) -> Vector:
    return rational(point.x), rational(point.y)
