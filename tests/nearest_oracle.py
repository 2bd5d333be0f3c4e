"""An oracle for pairs of nearest points: critical points of distances along Möbius images (see `moebius`).

The squared distance from a point to z(t) = N(t) / D(t) is a quotient of quadratics, whose slope vanishes at
the roots of one quadratic. A normal of two circles is a line from one centre to a critical point of the
distance to it. That a pair is a least one is told by trying pairs beside it, 10^-200 away: no rule is taken
for granted.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from moebius import (
    Complex,
    Image,
    Meeting,
    Trace,
    dot,
    in_unit,
    is_zero,
    meetings,
    mp,
    quadratic,
    sign,
)

STEP = mp.mpf(10) ** -200
"""So far beside a place distances are compared."""


class Pair(NamedTuple):
    """A place of each curve."""

    first: Complex
    second: Complex

    @property
    def distance(self) -> Any:
        return abs(self.first - self.second)


def critical(curve: Trace, z: Complex) -> list[Complex] | None:
    """Where the distance from a point to the inner places of a curve is stationary; None if everywhere."""
    found: list[Complex] = []
    for image in curve.images:
        top, below = _square(image.n0 - z * image.d0, image.n1 - z * image.d1), _square(image.d0, image.d1)
        hits = quadratic(
            top[1] * below[0] - top[0] * below[1],
            2 * (top[2] * below[0] - top[0] * below[2]),
            top[2] * below[1] - top[1] * below[2],
        )
        if hits is None:
            return None
        places = (image.at(t) for t, _ in hits if in_unit(t))
        found += [w for w in places if not curve.is_end(w) and not any(is_zero(w - v) for v in found)]
    return found


def _square(c: Complex, d: Complex) -> tuple[Any, Any, Any]:
    """Coefficients of |c + d t|^2."""
    return dot(c, c), 2 * dot(c, d), dot(d, d)


def common_normals(a: Trace, b: Trace) -> list[Pair]:
    """Pairs of inner places whose line is normal to both curves; none for parallel and concentric ones."""
    if b.centre is None:
        if a.centre is None:
            return []
        return [Pair(pair.second, pair.first) for pair in common_normals(b, a)]
    found = []
    for z in critical(a, b.centre) or ():
        if not is_zero(z - b.centre):
            feet = (b.centre + side * b.radius * (z - b.centre) / abs(z - b.centre) for side in (1, -1))
            found += [Pair(z, w) for w in feet if b.holds(w) and not b.is_end(w)]
    return found


def least(a: Trace, b: Trace) -> Any:
    """The least distance of two curves that do not meet: the least of all that is stationary or at an end."""
    pairs = [pair.distance for pair in common_normals(a, b)]
    for one, two in ((a, b), (b, a)):
        for z, _ in one.ends:
            feet = critical(two, z)
            pairs += [abs(z - w) for w in feet or ()]
            if feet is None:
                pairs.append(two.radius)
            pairs += [abs(z - w) for w, _ in two.ends]
    if (
        a.centre is not None
        and b.centre is not None
        and is_zero(a.centre - b.centre)
        and meetings(stretched(a, b), b)
    ):
        pairs.append(abs(a.radius - b.radius))
    if a.centre is None and b.centre is None:
        pairs += [Pair(*family[0]).distance for family in parallel(a, b)]
    return min(pairs)


# -- whole pieces ----------------------------------------------------------------------------------


def parallel(a: Trace, b: Trace) -> list[tuple[Pair, Pair]]:
    """The facing pieces of two parallel segments, as first and last pair along the first; none or one."""
    (rail,) = a.images
    (other,) = b.images
    if not is_zero(mp.im(mp.conj(rail.n1) * other.n1)):
        return []
    shares = sorted(mp.re((z - rail.n0) / rail.n1) for z, _ in b.ends)
    low, high = max(shares[0], mp.mpf(0)), min(shares[1], mp.mpf(1))
    if sign(high - low) <= 0:
        return []
    across = mp.im((other.n0 - rail.n0) / rail.n1) * mp.mpc(0, 1) * rail.n1
    return [(Pair(rail.at(low), rail.at(low) + across), Pair(rail.at(high), rail.at(high) + across))]


def concentric(a: Trace, b: Trace) -> list[tuple[Pair, Pair]]:
    """The pieces of two arcs about one centre that span the same angles, along the first."""
    if not is_zero(a.centre - b.centre):
        return []
    onto = b.radius / a.radius
    shared: list[Meeting] = [m for m in meetings(stretched(a, b), b) if m.kind == "overlap"]
    places = [[Pair(a.centre + (z - a.centre) / onto, z) for z in (m.start, m.end)] for m in shared]
    return [(first, last) for first, last in places]


def stretched(a: Trace, b: Trace) -> Trace:
    """A curve stretched about its centre to the radius of another."""
    return a.moved(b.radius / a.radius, a.centre)


# -- what is least beside it -----------------------------------------------------------------------


class Stand(NamedTuple):
    """A place of a curve with the places beside it: one at an end, two within."""

    z: Complex
    beside: list[Complex]
    curve: Trace

    @classmethod
    def at(cls, curve: Trace, z: Complex) -> Stand:
        for image in curve.images:
            t = image.parameter(z)
            if t is not None and in_unit(t):
                size = STEP / abs(image.slope(t))
                steps = (
                    [size] if is_zero(t) and not curve.closed else
                    [-size] if is_zero(1 - t) and not curve.closed else
                    [size, -size]
                )  # fmt: skip
                return cls(z, [image.at(t + s) for s in steps], curve)
        raise AssertionError("the place is not on the curve")

    @property
    def image(self) -> Image:
        return next(image for image in self.curve.images if image.holds(self.z))


def is_stationary(one: Stand, two: Stand) -> bool:
    """Whether no first-order move along the curves brings a pair nearer."""
    gap = two.z - one.z
    if is_zero(gap):
        return True
    for stand, away in ((one, gap), (two, -gap)):
        into = [dot(step - stand.z, away) / STEP / abs(away) for step in stand.beside]
        # Of a stationary place what is left is of the order of the step.
        if any(along > mp.sqrt(STEP) for along in into):
            return False
    return True


def is_strict_minimum(one: Stand, two: Stand) -> bool:
    """Whether all pairs close to one are farther apart: by the quadratic form of the steps, or by slopes."""
    d = abs(one.z - two.z)

    def gain(p: Complex, q: Complex) -> Any:
        return (abs(p - q) - d) / STEP

    for p in one.beside:
        for q in two.beside:
            alone, other, both = gain(p, two.z), gain(one.z, q), gain(p, q)
            if alone <= STEP**2 or other <= STEP**2:
                return False
            mixed = both - alone - other
            if mixed < 0 and not mixed * mixed < 4 * alone * other * (1 - mp.sqrt(STEP)):
                return False
    return True
