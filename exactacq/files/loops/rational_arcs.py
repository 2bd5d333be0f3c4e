"""Arcs as edges with rational ends: by centre, radius and angles in degrees; by two points and a radius.

The ends of such an arc are irrational as a rule, so an edge near it is chosen: ends rounded to
decimals as fine as a double resolves, the bulge to the simplest fraction within 2^-50 of its size. The shifts
recorded in the corners are proven bounds. Ends at multiples of 90 degrees and semicircles are exact.
"""

from __future__ import annotations

from functools import cache, lru_cache
from math import isqrt

from flint import fmpq

from exactacq.files.loops.chains import Corner, root_above
from exactacq.numbers.atoms import rational_sqrt
from exactacq.numbers.length import Length
from exactacq.scene.bends import Around, Pair, bend, slope_of

DECIMALS = 16
"""Significant decimals kept of computed coordinates, counted from the largest coordinate on the circle."""
BULGE_BITS = 50
FIXED_BITS = 128
TERMS = 60
HALVING_DEGREES = 270
"""Longer arcs are halved: the circle through two close ends would magnify their rounding."""


def arc_corners(center: tuple[fmpq, fmpq], radius: fmpq, start: fmpq, end: fmpq) -> list[Corner] | None:
    """The counterclockwise arc between two angles (degrees) as an open chain, or None for the full circle.

    *radius* > 0. An angle of 0 modulo 360 from start to end means the full circle, as in DXF.
    """
    included = end - start
    included -= (included / 360).floor() * 360
    if included == 0:
        return None
    parts = 2 if included > HALVING_DEGREES else 1
    angles = [start + included * i / parts for i in range(parts + 1)]
    corners = [_corner(center, radius, angle) for angle in angles]
    for corner in corners[:-1]:
        corner.bulge, corner.bulge_shift = _bulge(included / parts)
    return corners


def arc_around(start: Pair, end: Pair, center: Pair, ccw: bool) -> Corner:
    """The start of an arc between different points equally far from its rational centre: exact."""
    told = bend(start, end, Around(center, ccw))
    if isinstance(told, fmpq):
        return Corner(*start, told)
    slope = slope_of(start, end, told) * (1 if ccw else -1)
    bulge, shift = _bulge_between(*_positive_bulge((slope, slope), _root(slope * slope + 1)))
    return Corner(*start, bulge if ccw else -bulge, fmpq(0), shift, center)


def arc_of_radius(start: Pair, end: Pair, radius: fmpq, large: bool, ccw: bool) -> Corner:
    """The start of an arc between different points, of the radius, or of half the chord if that is more.

    Of the two arcs in the wanted sense the one of more than half a turn if *large*. Exact where the centre is
    rational.
    """
    dx, dy = end[0] - start[0], end[1] - start[1]
    chord = dx * dx + dy * dy
    square = 4 * radius * radius / chord - 1  # of the slope: see `exactacq.scene.bends`
    if square <= 0:
        return Corner(*start, fmpq(1 if ccw else -1))
    left = large != ccw
    slope = rational_sqrt(square)
    if slope is not None:
        side = slope / 2 if left else -slope / 2
        return arc_around(start, end, (start[0] + dx / 2 - dy * side, start[1] + dy / 2 + dx * side), ccw)
    bulge, shift = _bulge_of_slope(square, large)
    return Corner(*start, bulge if ccw else -bulge, fmpq(0), shift)


@lru_cache(maxsize=1 << 12)
def _bulge_of_slope(square: fmpq, large: bool) -> Pair:
    """The bulge near that of an arc, and how far it is from it at most, from the square of its slope.

    Drawings have many arcs of one chord and radius: a file of a megabyte of them took 20 seconds.
    """
    low, high = _root(square)
    slopes = (-high, -low) if large else (low, high)
    return _bulge_between(*_positive_bulge(slopes, _root(square + 1)))


def _positive_bulge(slopes: Pair, roots: Pair) -> Pair:
    """Bounds of root - slope, the positive root of b^2 + 2 slope b - 1, from bounds of slope and root."""
    if slopes[0] > 0:
        return 1 / (roots[1] + slopes[1]), 1 / (roots[0] + slopes[0])
    return roots[0] - slopes[1], roots[1] - slopes[0]


def _root(square: fmpq) -> Pair:
    """Rational bounds of the square root of a positive number, within 2^-`FIXED_BITS` of its size."""
    p, q = int(square.p), int(square.q)
    bits = max(0, FIXED_BITS - (p * q).bit_length() // 2) + 1
    low = isqrt((p * q) << (2 * bits))
    return fmpq(low, q << bits), fmpq(low + 1, q << bits)


def _corner(center: tuple[fmpq, fmpq], radius: fmpq, degrees: fmpq) -> Corner:
    reach = max(abs(center[0]), abs(center[1])) + radius
    unit = fmpq(1)
    while unit <= reach:
        unit *= 10
    while unit > reach:
        unit /= 10
    unit /= 10 ** (DECIMALS - 1)
    (cosine, sine), error = cosine_sine(degrees)
    exact = (center[0] + radius * cosine, center[1] + radius * sine)
    x, y = ((c / unit + fmpq(1, 2)).floor() * unit for c in exact)
    return Corner(x, y, fmpq(0), root_above((x - exact[0]) ** 2 + (y - exact[1]) ** 2) + 2 * radius * error)


def _bulge(included: fmpq) -> tuple[fmpq, fmpq]:
    """The tangent of a quarter of the angle (degrees, at most 270), and a bound of the error."""
    if included == 180:
        return fmpq(1), fmpq(0)
    (cosine, sine), error = cosine_sine(included / 4)
    return _bulge_between((sine - error) / (cosine + error), (sine + error) / (cosine - error))


def _bulge_between(low: fmpq, high: fmpq) -> tuple[fmpq, fmpq]:
    """A simple fraction near all of an interval of positive numbers, and how far from it they are at most."""
    middle = (low + high) / 2
    slack = middle / 2**BULGE_BITS
    value = simplest_between(middle - slack, middle + slack)
    return value, max(high - value, value - low)


def rational_turn(degrees: fmpq) -> tuple[tuple[fmpq, fmpq], fmpq]:
    """Cosine and sine of a rational rotation near an angle in degrees, and a bound of the error in radians.

    With t near the tangent of half the angle these are (1 - t^2) / (1 + t^2) and 2 t / (1 + t^2); the angle
    is off by 2 |atan t - atan t'| <= 2 |t - t'| / (1 + min(t, t')^2). Multiples of 90 are exact. An angle
    within 2^-50 of half a turn is taken for one.
    """
    (cosine, sine), error = cosine_sine(degrees)
    if not error:
        return (cosine, sine), fmpq(0)
    bottom = 1 + cosine
    if bottom <= fmpq(1, 1 << (2 * BULGE_BITS + 1)):
        return (fmpq(-1), fmpq(0)), fmpq(1, 1 << BULGE_BITS)
    size = abs(sine)
    low, high = max(fmpq(0), (size - error) / (bottom + error)), (size + error) / (bottom - error)
    slack = high / 2**BULGE_BITS
    tangent = simplest_between(low - min(slack, low), high + slack)
    least = min(low, tangent)
    far = 2 * max(high - tangent, tangent - low) / (1 + least * least)
    square = tangent * tangent
    turned = 2 * tangent / (1 + square)
    return ((1 - square) / (1 + square), turned if sine > 0 else -turned), far


@cache
def nearly_pi() -> fmpq:
    """A rational less than 2^-`FIXED_BITS` below pi.

    Used for angles in fixed point, see `cosine_sine`.
    """
    return Length.turns(1, fmpq(1, 2)).enclosure(FIXED_BITS + 8)[0]


@lru_cache(maxsize=1 << 12)
def _first_quadrant(degrees: fmpq) -> tuple[fmpq, fmpq]:
    one = 1 << FIXED_BITS
    angle = int((nearly_pi() * degrees / 180 * one).floor())
    sums, term = [one, 0], one
    for n in range(1, TERMS):
        term = (term * angle >> FIXED_BITS) // n
        sums[n % 2] += -term if n % 4 >= 2 else term
    return fmpq(sums[0], one), fmpq(sums[1], one)


def cosine_sine(degrees: fmpq) -> tuple[tuple[fmpq, fmpq], fmpq]:
    """Rationals near the cosine and the sine of an angle in degrees, and a bound of either error.

    Multiples of 90 are exact. Otherwise Taylor's series in fixed point for the rest x < pi/2: each term is
    cut off twice, so its error is e_n <= 2 + e_(n-1) x / n < 4 units, 240 for all `TERMS`; what follows them
    (x^60 / 60! < 2^-230) and the error of the angle are below two units each; 2^8 units cover the sum.
    """
    turned = degrees - (degrees / 360).floor() * 360
    quadrant = int((turned / 90).floor())
    rest = turned - 90 * quadrant
    cosine, sine = _first_quadrant(rest) if rest else (fmpq(1), fmpq(0))
    for _ in range(quadrant):
        cosine, sine = -sine, cosine
    return (cosine, sine), fmpq(1, 1 << (FIXED_BITS - 8)) if rest else fmpq(0)


def simplest_between(low: fmpq, high: fmpq) -> fmpq:
    """The fraction of least denominator in [low, high], 0 <= low <= high.

    A descent of the Stern-Brocot tree by continued fractions; ValueError for another interval.
    """
    if low > high or low < 0:
        raise ValueError(f"not an interval of numbers >= 0: [{low}, {high}]")
    p, q, r, s = (int(number) for number in (low.p, low.q, high.p, high.q))
    terms = []
    while (whole := -(-p // q)) * s > r:  # no integer lies between p / q and r / s
        terms.append(whole - 1)
        p, q, r, s = s, r - (whole - 1) * s, q, p - (whole - 1) * q
    top, bottom = whole, 1
    for term in reversed(terms):
        top, bottom = term * top + bottom, top
    return fmpq(top, bottom)
