"""Lengths with angles: planted relations of angles, told by products of complex numbers, and 1,000 digits.

A sum of m_k arg(z_k) - arg(w), with w the product of the z_k^(m_k), is a whole number of turns. The z_k are
made of rationals and one square root, and w is multiplied out by hand: so ties are planted, among angles
whose cosines are rational, irrational, or nested roots. Machin's formulas are of this kind.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

import mpmath
import pytest
from drawn_curves import LEFT, Draw, Ring, Vector, library_curve, rational, rings, spots_of, vectors
from flint import fmpq
from hypothesis import assume, event, given
from hypothesis import strategies as st
from moebius import Bow, Spot
from nightly import examples
from test_number_oracle import HAIRS

from exactacq.geometry.curves import Arc
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real

mp = mpmath.mp.clone()
mp.dps = 1000
SHOWN = mp.mpf(10) ** -280
NEAR = st.sampled_from([0, 0, Fraction(1, 10**20), Fraction(-1, 10**20)])
"""Closer directions of irrational angles may leave their sums undecided."""
hairs = st.sampled_from(HAIRS)


class Surd(NamedTuple):
    """a + b sqrt(n)."""

    a: Fraction
    b: Fraction
    n: int

    def plus(self, other: Surd) -> Surd:
        return Surd(self.a + other.a, self.b + other.b, self.n)

    def times(self, other: Surd) -> Surd:
        return Surd(self.a * other.a + self.n * self.b * other.b, self.a * other.b + self.b * other.a, self.n)

    def scaled(self, c: Fraction) -> Surd:
        return Surd(self.a * c, self.b * c, self.n)

    @property
    def exact(self) -> Real:
        return Real(self.a) + self.b * Real(self.n).sqrt()

    @property
    def digits(self) -> Any:
        return number(self.a) + number(self.b) * mp.sqrt(self.n)


class Gauss(NamedTuple):
    """x + i y."""

    x: Surd
    y: Surd

    def times(self, other: Gauss) -> Gauss:
        across = self.y.times(other.y).scaled(Fraction(-1))
        return Gauss(self.x.times(other.x).plus(across), self.x.times(other.y).plus(self.y.times(other.x)))

    @property
    def conjugate(self) -> Gauss:
        return Gauss(self.x, self.y.scaled(Fraction(-1)))

    @property
    def angle(self) -> Any:
        """In [0, 2 pi)."""
        angle = mp.atan2(self.y.digits, self.x.digits)
        return angle + 2 * mp.pi if angle < -SHOWN else angle

    def arc(self, coefficient: Real) -> Length:
        """A coefficient times the angle."""
        x, y = self.x.exact, self.y.exact
        size = (x * x + y * y).sqrt()
        return Length.arc(coefficient, x / size, y / size)


def number(value: Fraction) -> Any:
    return mp.mpf(value.numerator) / value.denominator


def gauss(n: int, x: tuple[object, object], y: tuple[object, object]) -> Gauss:
    return Gauss(*(Surd(Fraction(a), Fraction(b), n) for a, b in (x, y)))  # type: ignore[arg-type]


COEFFICIENTS = {
    "1": lambda: Real(1),
    "-3/2": lambda: Real("-3/2"),
    "sqrt 2": lambda: Real(2).sqrt(),
    "1 + sqrt 5": lambda: 1 + Real(5).sqrt(),
    "nested": (2 + Real(3).sqrt() * 3).sqrt,
}


class Relation(NamedTuple):
    """Angles whose sum, with these multiples, is a whole number of turns; and what all is multiplied by."""

    factors: tuple[tuple[Gauss, int], ...]
    coefficient: str

    def product(self) -> Gauss:
        total = gauss(self.factors[0][0].x.n, (1, 0), (0, 0))
        for z, m in self.factors:
            for _ in range(abs(m)):
                total = total.times(z if m > 0 else z.conjugate)
        return total

    def turns(self) -> int:
        total = sum(m * z.angle for z, m in self.factors) - self.product().angle
        share = total / (2 * mp.pi)
        assert abs(share - mp.nint(share)) < SHOWN, "the oracle's relation is wrong"
        return int(mp.nint(share))

    def parts(self) -> list[Length]:
        """Lengths whose sum is 0."""
        c = COEFFICIENTS[self.coefficient]()
        whole = Length.turns(c, -self.turns())
        return [*(z.arc(c * m) for z, m in self.factors), self.product().arc(-c), whole]

    def nudged(self, size: Fraction) -> tuple[Length, int]:
        """The first part, its direction turned by the angle of (1, *size*), and the sign of the change."""
        (z, m), c = self.factors[0], COEFFICIENTS[self.coefficient]()
        turned = z.times(gauss(z.x.n, (1, 0), (size, 0)))
        return turned.arc(c * m), (c * m).sign()


@st.composite
def relations(draw: Draw, surds: bool) -> Relation:
    n = draw(st.sampled_from([2, 3, 5])) if surds else 1
    part = st.integers(-3, 3)
    factors = []
    for _ in range(draw(st.integers(1, 3))):
        x, y = ((draw(part), draw(part) if surds else 0) for _ in range(2))
        if surds:
            y = (y[0] + draw(NEAR), y[1])  # Close to a simple fraction of pi, perhaps.
        assume(any((*x, *y)))
        z = gauss(n, x, y)
        assume(abs(z.x.digits) + abs(z.y.digits) > SHOWN)
        factors.append((z, draw(st.sampled_from([1, 2, -1, 3, -2]))))
    return Relation(tuple(factors), draw(st.sampled_from(list(COEFFICIENTS))))


def laws(a: Length, b: Length, order: int) -> None:
    """Everything that says how two lengths are ordered says the same."""
    assert a.compare(b) == order == -b.compare(a)
    assert (a - b).sign() == order == -(b - a).sign()
    assert (a < b, a <= b, a == b, a != b, a >= b, a > b) == (
        order < 0, order <= 0, order == 0, order != 0, order >= 0, order > 0
    )  # fmt: skip
    assert (float(a) <= float(b)) if order <= 0 else (float(a) >= float(b))
    if not order:
        assert float(a) == float(b) and round(a) == round(b) and bool(a) == bool(b)


class Tie(NamedTuple):
    """Relations whose lengths are cut into two sums at a place, a hair, and of which kind that is."""

    relations: tuple[Relation, ...]
    cut: int
    hair: Fraction
    kind: str


@st.composite
def ties(draw: Draw, surds: bool) -> Tie:
    some = draw(st.lists(relations(surds), min_size=1, max_size=2))
    kind = draw(st.sampled_from(["number", "turn", "angle", "direction"]))
    return Tie(tuple(some), draw(st.integers(0, 9)), draw(hairs), kind)


def check_tie(tie: Tie) -> None:
    """Both sums are one length, unless a hair is added: a number, a turn, an angle, or to a direction."""
    parts = [part for relation in tie.relations for part in relation.parts()]
    order, size = (tie.hair > 0) - (tie.hair < 0), abs(tie.hair)
    event("tie" if not order else f"near tie, {tie.kind}")
    hair = {
        "number": lambda: Length(size),
        "turn": lambda: Length.turns(Real(2).sqrt(), size),
        "angle": lambda: gauss(1, (1, 0), (size, 0)).arc(Real(3)),
        "direction": Length,
    }[tie.kind]()
    if tie.kind == "direction" and order:
        parts[0], order = tie.relations[0].nudged(size)
    cut = tie.cut % len(parts)
    left, right = Length.sum(parts[cut:]) + hair * order, -Length.sum(parts[:cut])
    laws(left, right, order)
    laws(left * fmpq(-2, 3), right * fmpq(-2, 3), -order)


@examples(60)
@given(ties(surds=False))
def test_relations_of_gaussian_integers_tie(tie: Tie) -> None:
    check_tie(tie)


@examples(15)
@given(ties(surds=True))
def test_relations_of_irrational_directions_tie(tie: Tie) -> None:
    check_tie(tie)


MACHIN = {
    "Machin": [(5, 1, 4), (239, 1, -1)],
    "Euler": [(2, 1, 1), (3, 1, 1)],
    "Hermann": [(2, 1, 2), (7, 1, -1)],
    "Hutton": [(3, 1, 2), (7, 1, 1)],
    "Gauss": [(18, 1, 12), (57, 1, 8), (239, 1, -5)],
    "Stoermer": [(8, 1, 6), (57, 1, 2), (239, 1, 1)],
}
"""Sums of m atan(y / x) that are a quarter of pi."""


@pytest.mark.parametrize("name", MACHIN)
def test_formulas_for_pi(name: str) -> None:
    left = Length.sum(gauss(1, (x, 0), (y, 0)).arc(Real(m)) for x, y, m in MACHIN[name])
    quarter = Length.turns(1, "1/8")
    laws(left, quarter, 0)
    for n in (40, 100, 200):
        laws(left + Length(fmpq(1, 10**n)), quarter, 1)
        laws(left, quarter + Length.turns(fmpq(1, 10**n)), -1)
        x, y, m = MACHIN[name][0]
        off = gauss(1, (x, 0), (y, 0)).times(gauss(1, (1, 0), (Fraction(1, 10**n), 0)))
        rest = Length.sum(gauss(1, (x, 0), (y, 0)).arc(Real(m)) for x, y, m in MACHIN[name][1:])
        laws(off.arc(Real(m)) + rest, quarter, 1)


@st.composite
def sums(draw: Draw) -> tuple[list[tuple[Gauss, Fraction, str]], Fraction]:
    """Multiples of angles, and a rational part."""
    count = draw(st.integers(1, 4))
    terms = []
    for _ in range(count):
        relation = draw(relations(draw(st.booleans())))
        terms.append((relation.factors[0][0], draw(hairs) + relation.factors[0][1], relation.coefficient))
    return terms, Fraction(draw(st.integers(-9, 9)), 4)


def check_sum(case: tuple[list[tuple[Gauss, Fraction, str]], Fraction]) -> None:
    """Enclosure, sign, float and decimals of any sum, and quotients of its parts, are those of the digits."""
    terms, whole = case
    parts = [z.arc(COEFFICIENTS[name]() * rational(m)) for z, m, name in terms]
    values = [z.angle * number(m) * coefficient_digits(name) for z, m, name in terms]
    total, expected = Length.sum([Length(whole), *parts]), number(whole) + sum(values)
    low, high = total.enclosure(900)
    assert mp.mpf(int(low.p)) / int(low.q) - SHOWN <= expected <= mp.mpf(int(high.p)) / int(high.q) + SHOWN
    sign = 0 if abs(expected) < SHOWN else int(mp.sign(expected))
    event(f"sign {sign}")
    assert total.sign() == sign
    assert float(total) == (float(expected) if sign else 0.0)
    if sign:
        assert abs(mp.mpf(total.decimal(40)) - expected) <= abs(expected) * mp.mpf(10) ** -39
        quotient = parts[0] / total
        share = Fraction(mp.nstr(mp.mpf(values[0] / expected), 30))
        assert abs(float(quotient) - float(share)) <= 1e-15 * abs(float(share))
        for step in (-1, 1):
            near = share + step * Fraction(1, 10**20) * max(1, abs(share))
            assert quotient.compare(rational(near)) == -step
    elif whole == 0 and parts[0].sign():
        with pytest.raises(ZeroDivisionError):
            parts[0] / total


def coefficient_digits(name: str) -> Any:
    root = mp.sqrt
    return {
        "1": mp.mpf(1),
        "-3/2": mp.mpf(-3) / 2,
        "sqrt 2": root(2),
        "1 + sqrt 5": 1 + root(5),
        "nested": root(2 + 3 * root(3)),
    }[name]


@examples(50)
@given(sums())
def test_sums_are_those_of_the_digits(case: tuple[list[tuple[Gauss, Fraction, str]], Fraction]) -> None:
    check_sum(case)


# -- arcs of one circle ------------------------------------------------------------------------------


@st.composite
def crossings_of(draw: Draw, ring: Ring) -> Spot:
    """Where a rational line crosses a circle: in an irrational direction from the centre, in general."""
    along, share = draw(vectors), draw(st.sampled_from([Fraction(n, 3) for n in (-1, 1, 2)]))
    foot = ring.centre + along * LEFT * share
    return Spot(*foot, ring.square / along.square - share * share, *along)


def around(ring: Ring, spot: Spot) -> Any:
    """A point of a circle as seen from its centre."""
    at = mp.mpc(number(spot.x - ring.centre.x), number(spot.y - ring.centre.y))
    return at + mp.sqrt(number(spot.q)) * mp.mpc(number(spot.u), number(spot.v))


@st.composite
def cuts(draw: Draw) -> tuple[tuple[Bow, ...], Bow]:
    """A circle that is cut at some places, as arcs from one to the next; and the full circle."""
    ring = draw(rings())
    spots: list[Spot] = []
    for _ in range(draw(st.integers(2, 5))):
        spot = draw(st.one_of(spots_of(ring), crossings_of(ring)))
        assume(spot.q >= 0)
        assume(all(abs(around(ring, spot) - around(ring, other)) > SHOWN for other in spots))
        spots.append(spot)
    spots.sort(key=lambda spot: mp.arg(around(ring, spot)))
    ccw = draw(st.booleans())
    order = spots if ccw else spots[::-1]
    bows = [ring.bow(p, q, ccw) for p, q in zip(order, order[1:] + order[:1], strict=True)]
    return tuple(bows), ring.bow(order[0], None, ccw)


def check_cuts(case: tuple[tuple[Bow, ...], Bow]) -> None:
    """The arcs make the whole circle; each is as long as its digits say, and the rest is what is left."""
    bows, whole = case
    known: dict[Spot, Any] = {}
    arcs = [library_curve(bow, known) for bow in bows]
    circle = library_curve(whole, known)
    lengths = [arc.length for arc in arcs]
    laws(Length.sum(lengths), circle.length, 0)
    radius = mp.sqrt(number(whole.square))
    assert abs(digits(circle.length) - 2 * mp.pi * radius) < SHOWN
    for bow, arc, length in zip(bows, arcs, lengths, strict=True):
        start, end = (seen(bow, spot) for spot in (bow.start, bow.end))
        turned = mp.arg(end / start if bow.ccw else start / end)
        assert abs(digits(length) - radius * (turned if turned > 0 else turned + 2 * mp.pi)) < SHOWN
        assert isinstance(arc, Arc)
        laws(length + arc.part(arc.end, arc.start).length, circle.length, 0)
        laws(length, arc.reversed().length, 0)


def digits(length: Length) -> Any:
    low, high = length.enclosure(1200)
    middle = (low + high) / 2
    return mp.mpf(int(middle.p)) / int(middle.q)


def seen(bow: Bow, spot: Spot | None) -> Any:
    assert spot is not None
    centre = Vector(bow.centre.x, bow.centre.y)
    return around(Ring(centre, centre), spot)


@examples(30)
@given(cuts())
def test_arcs_of_a_circle_make_it_whole(case: tuple[tuple[Bow, ...], Bow]) -> None:
    check_cuts(case)


@pytest.mark.parametrize("digits", [20, 60, 300])
def test_a_tiny_angle_and_what_it_leaves_of_a_twelfth_tie(digits: int) -> None:
    """Of 192 bits a lattice shows nothing of an angle below 2^-192."""
    half, t = Real(3).sqrt() / 2, fmpq(3, 10**digits + 1)
    root = Real(t * t + 1).sqrt()
    for c, s in ((1 / root, t / root), (Real((1 - t * t) / (1 + t * t)), Real(2 * t / (1 + t * t)))):
        rest = Length.arc(1, half * c + s / 2, c / 2 - half * s)
        assert Length.arc(1, c, s) + rest == Length.turns(1, "1/12")
