"""Biarcs with rational data, and proofs that a rational Bézier piece lies close to an arc or a segment.

*Rational biarcs.* A biarc joins P to Q by two arcs with one tangent at their joint J. Let the unit tangents
at P, J and Q be the squares of unit complex numbers u, v, w. An arc whose tangent turns from u^2 to v^2 has a
chord in the direction u v, so a u v + b v w = Q - P, which is linear in the lengths a and b of the chords;
and its bulge is the tangent of half the angle from u to v. If P, Q, u, v and w are rational, so is all the
rest. The choice of v is the one freedom that biarcs have (D. Meek and D. Walton, Approximating smooth planar
curves by arc splines, 1995).

*Distance to an arc.* Let an arc of centre m and radius r turn by at most a quarter, and call the sector of
the plane that it spans at m its cone. If the control points of a piece are within e of the cone (which is
convex), so is the piece. If besides | |c - m| - r | <= d < r for all its points c, the nearest point c' of
the cone has | |c' - m| - r | <= d + e, and its radial projection lies on the arc: c is within d + 2 e of the
arc. The condition on d is that

    d (2 r - d) W^2 - |g|  >=  0,    g = |X - m W|^2 - r^2 W^2,    c = X / W,

for ||c - m| - r| = |g| / W^2 / (|c - m| + r), and |c - m| >= r - d follows from g >= -d (2 r - d) W^2. Both
sides are polynomials, and not negative if their Bernstein coefficients are; else the piece is halved.

*Both ways.* Let c on [0, s] be within h of the first arc, on [s, 1] within h of the second one, and |c(s) -
J| <= h, with h less than half of either radius. The map to the nearest point of an arc is continuous where
the distance is less than r, so the images of c cover the arcs but for the points between J and the images of
c(s). These are within h of c(s): on an arc of at most a quarter the distance from c(s) grows from its nearest
point to J. So the Hausdorff distance of curve and biarc is at most h. For a segment the nearest point is
continuous everywhere, and control points within h of it are enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

from flint import fmpq

from exactacq.files.repairs.bezier import BezierPiece, Pair

HALVINGS = 5
"""How often a piece is halved at most to show the signs of a polynomial."""
HALF = fmpq(1, 2)
Scaled = list[fmpq]
"""Bernstein coefficients times binomials: their products are convolutions."""


@dataclass(frozen=True, slots=True)
class RationalArc:
    """An arc from *start* to *end* by its bulge, with the rational centre and radius."""

    start: Pair
    end: Pair
    bulge: fmpq
    center: Pair
    radius: fmpq


@dataclass(frozen=True, slots=True)
class Biarc:
    """Two arcs with one tangent at their joint; *tangent* is a vector of length 1."""

    first: RationalArc
    second: RationalArc
    tangent: Pair


def biarc(start: Pair, end: Pair, turns: tuple[Pair, Pair, Pair]) -> Biarc | None:
    """The biarc whose unit tangents at start, joint and end are the squares of *turns*, unit vectors too.

    None if there is none, or if one of its arcs is straight or turns by more than a quarter.
    """
    u, v, w = turns
    if _dot(u, v) < 0:
        v = (-v[0], -v[1])
    if _dot(v, w) < 0:
        w = (-w[0], -w[1])
    along, across = _times(u, v), _times(v, w)
    gap, both = (end[0] - start[0], end[1] - start[1]), _cross(along, across)
    if both == 0:
        return None
    a, b = _cross(gap, across) / both, _cross(along, gap) / both
    if a <= 0 or b <= 0:
        return None
    joint = start[0] + a * along[0], start[1] + a * along[1]
    first, second = _arc(start, joint, a, u, v), _arc(joint, end, b, v, w)
    return None if first is None or second is None else Biarc(first, second, _times(v, v))


def _arc(start: Pair, end: Pair, chord: fmpq, u: Pair, v: Pair) -> RationalArc | None:
    """The arc whose tangent turns from u^2 to v^2, over a chord of that length."""
    cosine, sine = _dot(u, v), _cross(u, v)
    bulge = sine / (1 + cosine)
    if sine == 0 or 2 * abs(bulge) > 1 - bulge * bulge:
        return None
    signed, tangent = chord / (2 * sine), _times(u, u)
    center = start[0] - tangent[1] * signed, start[1] + tangent[0] * signed
    return RationalArc(start, end, bulge, center, abs(signed))


def fits_biarc(piece: BezierPiece, found: Biarc, parting: fmpq, bound: fmpq) -> bool:
    """Whether it is proven that piece and biarc, with the same ends, are within *bound* of each other.

    *parting* is the parameter of the piece at the joint, nearly: the better, the easier is the proof.
    """
    joint, there = found.first.end, piece.point(parting)
    if (joint[0] - there[0]) ** 2 + (joint[1] - there[1]) ** 2 > bound * bound:
        return False
    halves = ((fmpq(0), parting, found.first), (parting, fmpq(1), found.second))
    return all(_near_arc(piece.part(low, high), arc, bound) for low, high, arc in halves)


def _near_arc(piece: BezierPiece, arc: RationalArc, bound: fmpq) -> bool:
    """Whether all points of a piece are proven to lie within *bound* of an arc of at most a quarter."""
    slack = bound / 32
    reach = bound - 2 * slack
    if 2 * bound > arc.radius or not all(_in_cone(point, arc, slack) for point in piece.control()):
        return False
    return _in_annulus(piece, arc, reach * (2 * arc.radius - reach), HALVINGS)


def _in_cone(point: Pair, arc: RationalArc, slack: fmpq) -> bool:
    """Whether a point lies in the cone of an arc, or within *slack* of one of its two rays."""
    sense = 1 if arc.bulge > 0 else -1
    place = _from(arc.center, point)
    first, last = _from(arc.center, arc.start), _from(arc.center, arc.end)
    sides = sense * _cross(first, place), sense * _cross(place, last)
    if min(sides) >= 0:
        return True
    square, near = arc.radius * arc.radius, slack * slack
    rays = zip((first, last), sides, strict=True)
    return any(_dot(ray, place) >= 0 and side * side <= near * square for ray, side in rays)


def _in_annulus(piece: BezierPiece, arc: RationalArc, room: fmpq, halvings: int) -> bool:
    """Whether ||c - m|^2 - r^2| <= room is proven for all points of a piece."""
    degree = len(piece.rows) - 1
    factors = [comb(degree, i) for i in range(degree + 1)]
    mass = [f * w for f, (_, _, w) in zip(factors, piece.rows, strict=True)]
    aside = [f * (x - arc.center[0] * w) for f, (x, _, w) in zip(factors, piece.rows, strict=True)]
    above = [f * (y - arc.center[1] * w) for f, (_, y, w) in zip(factors, piece.rows, strict=True)]
    square, limit = arc.radius * arc.radius, True
    for x, y, w in zip(_square(aside), _square(above), _square(mass), strict=True):
        limit = limit and abs(x + y - square * w) <= room * w
    if limit or not halvings:
        return limit
    ends = (fmpq(0), HALF), (HALF, fmpq(1))
    return all(_in_annulus(piece.part(low, high), arc, room, halvings - 1) for low, high in ends)


def _square(factor: Scaled) -> Scaled:
    product = [fmpq(0)] * (2 * len(factor) - 1)
    for i, a in enumerate(factor):
        for j, b in enumerate(factor):
            product[i + j] += a * b
    return product


def fits_segment(piece: BezierPiece, bound: fmpq) -> bool:
    """Whether it is proven that piece and the segment of its ends are within *bound* of each other."""
    points = piece.control()
    start, end, limit = points[0], points[-1], bound * bound
    along = _from(start, end)
    square = _dot(along, along)
    for point in points[1:-1]:
        place = _from(start, point)
        t = min(max(_dot(place, along) / square, fmpq(0)), fmpq(1)) if square else fmpq(0)
        dx, dy = place[0] - t * along[0], place[1] - t * along[1]
        if dx * dx + dy * dy > limit:
            return False
    return True


def _from(origin: Pair, point: Pair) -> Pair:
    return point[0] - origin[0], point[1] - origin[1]


def _dot(a: Pair, b: Pair) -> fmpq:
    return a[0] * b[0] + a[1] * b[1]


def _cross(a: Pair, b: Pair) -> fmpq:
    return a[0] * b[1] - a[1] * b[0]


def _times(a: Pair, b: Pair) -> Pair:
    """The product of two complex numbers."""
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]
