"""Pairs of curves for hypothesis, the second placed by a relation to the first, and both as the library's.

All numbers are rational, as `moebius` takes them: grids of few places, hairs of 10^-9 to 10^-60, points of
circles by turns with rational cosine and sine. Each pair is then turned, stretched and moved as a whole.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, NamedTuple, TypeAlias

from flint import fmpq
from hypothesis import assume
from hypothesis import strategies as st
from moebius import Bow, Drawn, Spot, Straight

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real

Draw: TypeAlias = Callable[[st.SearchStrategy[Any]], Any]
HAIRS = [Fraction(0)] * 3 + [Fraction(s, 10**n) for n in (9, 30, 60) for s in (1, -1)]
UNITS = [
    (Fraction(x, n) * s, Fraction(y, n) * t)
    for x, y, n in ((1, 0, 1), (0, 1, 1), (3, 4, 5), (4, 3, 5), (12, 5, 13))
    for s in (1, -1)
    for t in (1, -1)
]
SHARES = [Fraction(n, 6) for n in (-6, -2, 0, 0, 2, 3, 6, 6, 8, 12)]

hairs = st.sampled_from(HAIRS)
units = st.sampled_from(UNITS)
shares = st.sampled_from(SHARES)
cells = st.integers(-3, 3).map(Fraction)
stretches = st.sampled_from([Fraction(n, m) for n, m in ((1, 2), (1, 1), (1, 1), (3, 2), (2, 1), (5, 1))])


class Vector(NamedTuple):
    """A rational vector or point: small letters for its arithmetic, which is that of complex numbers."""

    x: Fraction
    y: Fraction

    def __add__(self, other: Vector) -> Vector:  # type: ignore[override]
        return Vector(self.x + other.x, self.y + other.y)

    def __sub__(self, other: Vector) -> Vector:
        return Vector(self.x - other.x, self.y - other.y)

    def __mul__(self, other: Any) -> Vector:  # type: ignore[override]
        if not isinstance(other, tuple):
            return Vector(self.x * other, self.y * other)
        return Vector(self.x * other[0] - self.y * other[1], self.x * other[1] + self.y * other[0])

    @property
    def square(self) -> Fraction:
        return self.x * self.x + self.y * self.y

    @property
    def spot(self) -> Spot:
        return Spot(self.x, self.y)


LEFT = Vector(Fraction(0), Fraction(1))


class Ring(NamedTuple):
    """A circle by its centre and the radius to one of its points."""

    centre: Vector
    radius: Vector

    @property
    def square(self) -> Fraction:
        return self.radius.square

    def bow(self, start: Spot, end: Spot | None, ccw: bool) -> Bow:
        return Bow(self.centre.spot, self.square, start, end, ccw)


GRID = [Vector(Fraction(x), Fraction(y)) for x in range(-3, 4) for y in range(-3, 4) if x or y]
vectors = st.sampled_from(GRID)
"""Vectors that are not 0."""


@st.composite
def points_of(draw: Draw, ring: Ring) -> Vector:
    """A rational point of a circle, few of them; some a hair from these."""
    turn = Vector(*draw(units))
    t = draw(hairs)
    if t:
        turn = turn * ((1 - t * t) / (1 + t * t), 2 * t / (1 + t * t))
    return ring.centre + ring.radius * turn


@st.composite
def spots_of(draw: Draw, ring: Ring) -> Spot:
    """A point of a circle, in one of five cases an irrational one."""
    if draw(st.integers(0, 4)):
        return draw(points_of(ring)).spot
    v = draw(vectors)
    return Spot(*ring.centre, ring.square / v.square, *v)


@st.composite
def rings(draw: Draw) -> Ring:
    return Ring(Vector(draw(cells), draw(cells)), draw(vectors) * draw(stretches))


def same_spot(a: Spot, b: Spot) -> bool:
    """Whether two points of one circle are one: by direction where they are irrational."""
    if a.q and b.q:
        return a.u * b.v == a.v * b.u and a.u * b.u + a.v * b.v > 0
    if not a.q and not b.q:
        return a == b
    far, near = (a, b) if a.q else (b, a)
    x, y = near.x - far.x, near.y - far.y
    return far.u * y == far.v * x and far.u * x + far.v * y > 0


@st.composite
def bows_on(draw: Draw, ring: Ring) -> Bow:
    start, ccw = draw(spots_of(ring)), draw(st.booleans())
    if draw(st.integers(0, 5)) == 0:
        return ring.bow(start, None, ccw)
    end = draw(spots_of(ring))
    assume(not same_spot(start, end))
    return ring.bow(start, end, ccw)


@st.composite
def straights(draw: Draw) -> Straight:
    a = Vector(draw(cells), draw(cells))
    return Straight(a.spot, (a + draw(vectors)).spot)


def straight(a: Vector, b: Vector) -> Straight:
    assume(a != b)
    return Straight(a.spot, b.spot)


@st.composite
def beside_a_segment(draw: Draw) -> tuple[Drawn, Drawn]:
    """A segment, and a curve related to it."""
    a, along = Vector(draw(cells), draw(cells)), draw(vectors)
    b = a + along
    normal = along * LEFT
    at = a + along * draw(shares) + normal * draw(hairs)
    relations = ["on one line", "parallel", "from it", "tangent", "begins along", "through", "about"]
    relation = draw(st.sampled_from(relations))
    if relation == "on one line":
        other: Drawn = straight(at, a + along * (draw(shares) + draw(hairs)))
    elif relation == "parallel":
        shift = normal * draw(stretches)
        other = straight(at + shift, a + along * draw(shares) + shift)
    elif relation == "from it":
        other = straight(at, at + draw(vectors))
    elif relation == "tangent":
        radius = normal * draw(stretches)
        ring = Ring(at - radius, radius)
        other = draw(bows_on(ring))
    elif relation == "begins along":
        # An arc whose first direction is that of the segment, beside it or on it.
        begin, radius = at + normal * draw(shares), normal * draw(stretches)
        ring = Ring(begin + radius, radius)
        end = draw(spots_of(ring))
        assume(not same_spot(begin.spot, end))
        other = ring.bow(begin.spot, end, draw(st.booleans()))
    elif relation == "through":
        # Of any centre on the bisector: the far ones make an arc that is nearly straight.
        height = draw(st.sampled_from([0, 1, -2, 10**9, -(10**20)]))
        centre = a + along * Fraction(1, 2) + normal * height
        ring = Ring(centre, a - centre)
        ends = draw(st.permutations([a.spot, b.spot, draw(spots_of(ring))]))
        assume(not same_spot(*ends[:2]))
        other = ring.bow(*ends[:2], draw(st.booleans()))
    else:
        ring = Ring(at, along * draw(shares.filter(bool)))
        other = draw(bows_on(ring))
    return straight(a, b), other


@st.composite
def beside_an_arc(draw: Draw) -> tuple[Drawn, Drawn]:
    """An arc, and a curve related to it."""
    ring = draw(rings())
    first = draw(bows_on(ring))
    at = draw(points_of(ring))
    out = at - ring.centre
    relations = ["one circle", "concentric", "tangent", "cutting", "line", "normal", "begins along"]
    relation = draw(st.sampled_from(relations))
    if relation == "one circle":
        other: Drawn = draw(bows_on(ring))
    elif relation == "concentric":
        other = draw(bows_on(Ring(ring.centre, ring.radius * (draw(shares.filter(bool)) + draw(hairs)))))
    elif relation == "tangent":
        share = draw(st.sampled_from([-3, -1, Fraction(-1, 2), Fraction(1, 3), 2, 10**12])) + draw(hairs)
        radius = out * share
        other = draw(bows_on(Ring(at - radius + out * draw(hairs), radius)))
    elif relation == "cutting":
        again = draw(points_of(ring))
        assume(again != at)
        centre = (at + again) * Fraction(1, 2) + (again - at) * LEFT * draw(shares)
        other = draw(bows_on(Ring(centre, at - centre)))
    elif relation == "line":
        again = draw(points_of(ring))
        along = out * LEFT if again == at else again - at
        begin = at + out * draw(hairs)
        other = straight(begin + along * draw(shares), begin + along * draw(shares))
    elif relation == "normal":
        other = straight(
            ring.centre + out * draw(shares) + out * LEFT * draw(hairs), ring.centre + out * draw(shares)
        )
    else:
        # A segment whose direction is that of the circle where its first end stands before it.
        begin = ring.centre + out * draw(shares.filter(bool))
        other = straight(begin, begin + out * LEFT * draw(shares.filter(bool)))
    return (first, other) if draw(st.booleans()) else (other, first)


@st.composite
def irrational_pairs(draw: Draw) -> tuple[Drawn, Drawn]:
    """Two segments whose ends are one point plus multiples of one root: their directions may be rational."""
    a, q = Vector(draw(cells), draw(cells)), Fraction(draw(st.sampled_from([2, 3, 5])))
    u, along = draw(vectors), draw(vectors)
    shift = along * LEFT * draw(shares)
    places = [u, u + along] + [u + along * draw(shares) + shift + draw(vectors) * draw(hairs) for _ in "ab"]
    assume(places[2] != places[3])
    p, r, s, t = (Spot(*a, q, *place) for place in places)
    return Straight(p, r), Straight(s, t)


@st.composite
def free_pairs(draw: Draw) -> tuple[Drawn, Drawn]:
    """Two curves on few cells."""
    one = st.one_of(straights(), rings().flatmap(bows_on))
    return draw(one), draw(one)


# -- moved as a whole ------------------------------------------------------------------------------


class Move(NamedTuple):
    """Turned and stretched by a complex number, then moved."""

    factor: Vector
    shift: Vector

    def spot(self, p: Spot) -> Spot:
        x, y = self.shift + Vector(p.x, p.y) * self.factor
        return Spot(x, y, p.q, *(Vector(p.u, p.v) * self.factor))

    def of(self, drawn: Drawn) -> Drawn:
        if isinstance(drawn, Straight):
            return Straight(self.spot(drawn.start), self.spot(drawn.end))
        end = None if drawn.end is None else self.spot(drawn.end)
        square = drawn.square * self.factor.square
        return Bow(self.spot(drawn.centre), square, self.spot(drawn.start), end, drawn.ccw)


@st.composite
def moves(draw: Draw) -> Move:
    """Often none; else turns by 3 + 4i, sizes of 10^-30 to 10^9, and places as far as 10^9."""
    if draw(st.booleans()):
        return Move(Vector(Fraction(1), Fraction(0)), Vector(Fraction(0), Fraction(0)))
    size = draw(st.sampled_from([Fraction(1), Fraction(1, 10**30), Fraction(10**9)]))
    far = draw(st.sampled_from([0, 0, 10**6, 10**9]))
    turn = Vector(*draw(units))
    return Move(turn * size, Vector(Fraction(far) + draw(cells), Fraction(-2 * far, 3)))


@st.composite
def pairs(draw: Draw) -> tuple[Drawn, Drawn]:
    """Two curves, related in some way, anywhere."""
    a, b = draw(st.one_of(beside_a_segment(), beside_an_arc(), free_pairs(), irrational_pairs()))
    move = draw(moves())
    return move.of(a), move.of(b)


curves = pairs().map(lambda pair: pair[1])


# -- the library's ---------------------------------------------------------------------------------


def rational(q: Fraction) -> fmpq:
    return fmpq(q.numerator, q.denominator)


def library_point(spot: Spot) -> Point:
    root = Real(spot.q).sqrt() if spot.q else Real(0)
    return Point(Real(spot.x) + root * spot.u, Real(spot.y) + root * spot.v)


def library_curve(drawn: Drawn, known: dict[Spot, Point] | None = None) -> Curve:
    """The curve; spots that are *known* become the same points again."""
    known = {} if known is None else known

    def point(spot: Spot) -> Point:
        return known.setdefault(spot, library_point(spot))

    if isinstance(drawn, Straight):
        return Segment(point(drawn.start), point(drawn.end))
    start = point(drawn.start)
    end = start if drawn.end is None else point(drawn.end)
    centre = library_point(drawn.centre)
    return Arc(start, end, centre, rational(drawn.square), drawn.ccw, full=drawn.end is None)
