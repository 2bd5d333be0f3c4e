"""An oracle for curves: segments, arcs and lines as Möbius images of an interval, to 1,000 digits.

Nothing here shares code or formulas with the library. A curve is z(t) = (n0 + n1 t) / (d0 + d1 t) for t from
0 to 1, in complex numbers: A + (B - A) t for a segment, and (A (1 - t) + B k t) / (1 - t + k t) for an arc
from A to B, where k turns the chord's direction into that of the tangent at A. A point lies on the curve if
its t is real and in [0, 1]; two curves meet where one's points have a real t on the other, which is a
quadratic equation in t. So one rule serves all pairs of curves.

Curves are told as plain rational data: a `Spot` is a point, a `Straight` a segment, a `Bow` an arc.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple, TypeAlias

import mpmath

mp = mpmath.mp.clone()
mp.dps = 1000
NOTHING, SOMETHING = mp.mpf(10) ** -600, mp.mpf(10) ** -420
"""What is smaller is 0, what is larger is not; tests leave nothing in between, which is asserted."""

Complex: TypeAlias = Any


class Spot(NamedTuple):
    """The point (x + sqrt(q) u, y + sqrt(q) v)."""

    x: Fraction
    y: Fraction
    q: Fraction = Fraction(0)
    u: Fraction = Fraction(0)
    v: Fraction = Fraction(0)


class Straight(NamedTuple):
    """A segment."""

    start: Spot
    end: Spot


class Bow(NamedTuple):
    """An arc about a rational centre with a rational squared radius; without an end it is the full circle."""

    centre: Spot
    square: Fraction
    start: Spot
    end: Spot | None
    ccw: bool


Drawn: TypeAlias = "Straight | Bow"


def number(q: Fraction | int) -> Any:
    q = Fraction(q)
    return mp.mpf(q.numerator) / q.denominator


def place(spot: Spot) -> Complex:
    z = mp.mpc(number(spot.x), number(spot.y))
    return z + mp.sqrt(number(spot.q)) * mp.mpc(number(spot.u), number(spot.v)) if spot.q else z


def is_zero(value: Complex) -> bool:
    # Not the absolute value, whose root takes long.
    size = max(abs(mp.re(value)), abs(mp.im(value)))
    assert not NOTHING < size < SOMETHING, f"the oracle cannot tell {mp.nstr(size, 5)} from 0"
    return bool(size <= NOTHING)


def sign(value: Any) -> int:
    return 0 if is_zero(value) else int(mp.sign(value))


def dot(a: Complex, b: Complex) -> Any:
    return mp.re(mp.conj(a) * b)


def cross(a: Complex, b: Complex) -> Any:
    return mp.im(mp.conj(a) * b)


class Image(NamedTuple):
    """z(t) = (n0 + n1 t) / (d0 + d1 t)."""

    n0: Complex
    n1: Complex
    d0: Complex
    d1: Complex

    @classmethod
    def line(cls, origin: Complex, direction: Complex) -> Image:
        """A line by its parameter; from 0 to 1 it is a segment."""
        return cls(origin, direction, mp.mpc(1), mp.mpc(0))

    @classmethod
    def arc(cls, start: Complex, end: Complex, k: Complex) -> Image:
        return cls(start, end * k - start, mp.mpc(1), k - 1)

    @classmethod
    def bulged(cls, start: Complex, end: Complex, bulge: Any) -> Image:
        """The arc of a bulge, the tangent of a quarter of its angle; 0 makes a segment."""
        half = mp.mpc(1, -bulge)
        return cls.arc(start, end, half * half / abs(half) ** 2)

    def at(self, t: Any) -> Complex:
        return (self.n0 + self.n1 * t) / (self.d0 + self.d1 * t)

    def slope(self, t: Any) -> Complex:
        return (self.n1 * self.d0 - self.n0 * self.d1) / (self.d0 + self.d1 * t) ** 2

    def parameter(self, z: Complex) -> Any:
        """The real t of a point of the whole circle or line; None beside it, and where t is infinite."""
        below = self.n1 - self.d1 * z
        if is_zero(below):
            return None
        t = (self.d0 * z - self.n0) / below
        return mp.re(t) if is_zero(mp.im(t)) else None

    def holds(self, z: Complex) -> bool:
        t = self.parameter(z)
        return t is not None and in_unit(t)

    def moved(self, factor: Complex, about: Complex) -> Image:
        """The image stretched and turned about a point."""
        shift = about - factor * about
        return Image(factor * self.n0 + shift * self.d0, factor * self.n1 + shift * self.d1, self.d0, self.d1)


def in_unit(t: Any) -> bool:
    return sign(t) >= 0 and sign(1 - t) >= 0


def quadratic(c0: Any, c1: Any, c2: Any) -> list[tuple[Any, bool]] | None:
    """The real roots of c0 + c1 t + c2 t^2, and whether they are double; None if every number is a root."""
    size = max(abs(c0), abs(c1), abs(c2))
    if is_zero(size):
        return None
    c0, c1, c2 = c0 / size, c1 / size, c2 / size
    if is_zero(c2):
        return [] if is_zero(c1) else [(-c0 / c1, False)]
    inside = c1 * c1 - 4 * c0 * c2
    if is_zero(inside):
        return [(-c1 / (2 * c2), True)]
    if inside < 0:
        return []
    half = -(c1 + (1 if c1 >= 0 else -1) * mp.sqrt(inside)) / 2
    return [(half / c2, False), (c0 / half, False)]


def common(a: Image, b: Image) -> list[tuple[Any, bool]] | None:
    """The t of a where its circle or line meets that of b, and whether it touches; None if both are one."""
    p0, p1 = b.d0 * a.n0 - b.n0 * a.d0, b.d0 * a.n1 - b.n0 * a.d1
    q0, q1 = b.n1 * a.d0 - b.d1 * a.n0, b.n1 * a.d1 - b.d1 * a.n1
    return quadratic(cross(q0, p0), cross(q1, p0) + cross(q0, p1), cross(q1, p1))


class Trace:
    """A drawn curve as the oracle sees it: one image, or two halves of a full circle."""

    def __init__(self, drawn: Drawn) -> None:
        self.start = place(drawn.start)
        self.closed = isinstance(drawn, Bow) and drawn.end is None
        self.centre = self.radius = None
        if isinstance(drawn, Straight):
            self.end = place(drawn.end)
            self.images = [Image.line(self.start, self.end - self.start)]
            return
        self.centre, self.radius = place(drawn.centre), mp.sqrt(number(drawn.square))
        self.end = self.start if drawn.end is None else place(drawn.end)
        turn = mp.mpc(0, 1 if drawn.ccw else -1)
        if drawn.end is None:
            far = 2 * self.centre - self.start
            self.images = [Image.arc(self.start, far, -turn), Image.arc(far, self.start, -turn)]
        else:
            k = turn * (self.start - self.centre) / (self.end - self.start)
            self.images = [Image.arc(self.start, self.end, k / abs(k))]

    @cached_property
    def ends(self) -> list[tuple[Complex, Complex]]:
        """The ends, each with the direction that leads into the curve."""
        if self.closed:
            return []
        (image,) = self.images
        return [(self.start, image.slope(mp.mpf(0))), (self.end, -image.slope(mp.mpf(1)))]

    def is_end(self, z: Complex) -> bool:
        return any(is_zero(z - end) for end, _ in self.ends)

    def holds(self, z: Complex) -> bool:
        return any(image.holds(z) for image in self.images)

    def tangent(self, z: Complex) -> Complex:
        """The direction of travel at a point of the curve."""
        for image in self.images:
            if image.holds(z):
                return image.slope(image.parameter(z))
        raise AssertionError("the point is not on the curve")

    def moved(self, factor: Complex, about: Complex) -> Trace:
        other = object.__new__(Trace)
        other.start, other.end = (about + factor * (z - about) for z in (self.start, self.end))
        other.centre = None if self.centre is None else about + factor * (self.centre - about)
        other.radius = None if self.radius is None else abs(factor) * self.radius
        other.closed, other.images = self.closed, [image.moved(factor, about) for image in self.images]
        return other


class Meeting(NamedTuple):
    """One component of what two curves share: "cross", "touch" or "overlap", from a place to a place."""

    kind: str
    start: Complex
    end: Complex


def meetings(a: Trace, b: Trace) -> list[Meeting]:
    """All components of the intersection of two curves; overlaps run along the first."""
    found: list[Meeting] = []
    for one in a.images:
        for two in b.images:
            hits = common(one, two)
            if hits is None:
                return _shared(a, b)
            for t, tangent in hits:
                z = one.at(t) if in_unit(t) else None
                if z is None or not two.holds(z) or any(is_zero(z - m.start) for m in found):
                    continue
                inner = not (tangent or a.is_end(z) or b.is_end(z))
                found.append(Meeting("cross" if inner else "touch", z, z))
    return found


def _shared(a: Trace, b: Trace) -> list[Meeting]:
    """What two curves of one line or circle share: a is cut at the ends of both, and each piece is tried."""
    cuts = _distinct(
        [
            *(mp.mpf(i) for i in range(len(a.images) + 1)),
            # Kept within its image: a start of both may be found 10^-1000 before it, which is no place of a.
            *(i + min(max(t, 0), 1) for z, _ in b.ends for i, t in _on(a, z) if in_unit(t)),
        ]
    )
    covered = [b.holds(_along(a, (low + high) / 2)) for low, high in pairwise(cuts)]
    pieces = len(covered)
    if all(covered):
        return [Meeting("overlap", a.start, a.end)]
    # On a full circle a run may pass the start: begin behind a piece that is not shared.
    first = covered.index(False) + 1 if a.closed else 0
    found: list[Meeting] = []
    run: int | None = None
    for step in range(pieces):
        i = (first + step) % pieces
        if covered[i]:
            run = i if run is None else run
        elif run is not None:
            found.append(Meeting("overlap", _along(a, cuts[run]), _along(a, cuts[i])))
            run = None
    if run is not None:
        found.append(Meeting("overlap", _along(a, cuts[run]), a.end))
    for i, cut in enumerate(cuts[:-1] if a.closed else cuts):
        before = covered[i - 1] if i or a.closed else False
        behind = covered[i] if i < pieces else False
        z = _along(a, cut)
        if not before and not behind and b.holds(z):
            found.append(Meeting("touch", z, z))
    return found


def _on(a: Trace, z: Complex) -> Iterable[tuple[int, Any]]:
    for i, image in enumerate(a.images):
        t = image.parameter(z)
        if t is not None:
            yield i, t


def _along(a: Trace, cut: Any) -> Complex:
    i = min(int(mp.floor(cut)), len(a.images) - 1)
    return a.images[i].at(cut - i)


def _distinct(values: Iterable[Any]) -> list[Any]:
    kept: list[Any] = []
    for value in sorted(values):
        if not kept or not is_zero(value - kept[-1]):
            kept.append(value)
    return kept


def line_meetings(origin: Complex, direction: Complex, curve: Trace) -> list[Any]:
    """The ascending parameters at which a line meets a curve; of a segment on the line both ends."""
    line = Image.line(origin, direction)
    found: list[Any] = []
    for image in curve.images:
        hits = common(line, image)
        if hits is None:
            return sorted(line.parameter(z) for z, _ in curve.ends)
        found += [t for t, _ in hits if image.holds(line.at(t))]
    return _distinct(found)


# -- turns round a point ---------------------------------------------------------------------------

RAYS = [mp.mpc(x, y) for x, y in ((17, 5), (-13, 29), (7, -31), (-41, -3), (2, 37), (-19, 11), (23, -8))]
"""Directions of rays, none of them along an axis."""


def turns(images: list[Image], z: Complex) -> int | None:
    """How often a closed chain winds round a point, counterclockwise; None if the point is on it.

    Crossings of one ray are counted. The ray is turned until it passes no end of an edge and touches none.
    """
    if any(image.holds(z) for image in images):
        return None
    for step in range(60):
        ray = RAYS[step % len(RAYS)] * mp.mpc(60, step)
        total = 0
        for image in images:
            crossed = _crossed(z, ray, image)
            if crossed is None:
                break
            total += crossed
        else:
            return total
    raise AssertionError("every ray passes an end")


def _crossed(z: Complex, ray: Complex, image: Image) -> int | None:
    """How often an edge crosses a ray counterclockwise, less how often clockwise; None if that is unclear."""
    hits = common(image, Image.line(z, ray))
    if hits is None:
        return None
    total = 0
    for t, tangent in hits:
        if not in_unit(t):
            continue
        if tangent or is_zero(t) or is_zero(1 - t):
            return None
        ahead = dot(ray, image.at(t) - z)
        assert not is_zero(ahead)
        if ahead > 0:
            total += sign(cross(ray, image.slope(t)))
    return total
