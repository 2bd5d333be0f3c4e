"""Nearest points of two curves against an oracle of 1,000 digits (`nearest_oracle`)."""

from __future__ import annotations

from fractions import Fraction

from drawn_curves import library_curve, pairs
from hypothesis import event, example, given
from moebius import Bow, Complex, Drawn, Spot, Trace, is_zero, meetings
from nearest_oracle import (
    Pair,
    Stand,
    common_normals,
    concentric,
    critical,
    is_stationary,
    is_strict_minimum,
    least,
    parallel,
)
from nightly import examples
from test_contact_oracle import digits, seen

from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.nearest_points import Nearest, NearestFamily, nearest_points
from exactacq.geometry.points import Point


def same(a: Pair, b: Pair) -> bool:
    return is_zero(a.first - b.first) and is_zero(a.second - b.second)


def expected_families(a: Trace, b: Trace) -> list[tuple[Pair, Pair]]:
    if a.centre is None and b.centre is None:
        return parallel(a, b)
    return [] if a.centre is None or b.centre is None else concentric(a, b)


def candidates(a: Trace, b: Trace) -> list[Pair]:
    """All pairs that may be least, but for those in families."""
    found = common_normals(a, b)
    found += [Pair(z, w) for z, _ in a.ends for w, _ in b.ends]
    found += [Pair(z, w) for z, _ in a.ends for w in critical(b, z) or ()]
    return found + [Pair(z, w) for w, _ in b.ends for z in critical(a, w) or ()]


def check_family(family: NearestFamily, a: Trace, b: Trace) -> tuple[Pair, Pair] | None:
    """First and last pair of a family; None if a centre is one side of it, which is checked."""
    for part, other, one, two in (
        (family.first, family.second, a, b),
        (family.second, family.first, b, a),
    ):
        if isinstance(part, Point):
            z = seen(part)
            assert one.is_end(z) and is_zero(z - two.centre)
            assert not isinstance(other, Point)
            assert is_zero(seen(other.start) - two.start) and is_zero(seen(other.end) - two.end)
            assert is_zero(digits(family.distance_sq) - two.radius**2)
            return None
    first, second = family.first, family.second
    assert isinstance(first, Segment | Arc) and isinstance(second, Segment | Arc)
    for part, trace in ((first, a), (second, b)):
        middle = seen(part.point("1/2"))
        assert trace.holds(middle), "the piece runs the other way"
    pairs_ = [Pair(seen(first.start), seen(second.start)), Pair(seen(first.end), seen(second.end))]
    assert all(is_zero(digits(family.distance_sq) - pair.distance**2) for pair in pairs_)
    return pairs_[0], pairs_[1]


def check_nearest(pair: tuple[Drawn, Drawn]) -> None:
    """All least pairs are there, what is there is stationary, and families are whole."""
    a, b = map(Trace, pair)
    listed: list[Pair] = []
    families: list[tuple[Pair, Pair]] = []
    distances = []
    about: list[Complex] = []
    for found in nearest_points(*map(library_curve, pair)):
        distances.append(digits(found.distance_sq))
        if isinstance(found, Nearest):
            listed.append(Pair(seen(found.start), seen(found.end)))
            assert is_zero(distances[-1] - listed[-1].distance ** 2)
        elif (ends := check_family(found, a, b)) is not None:
            families.append(ends)
        else:
            about.append(seen(found.first if isinstance(found.first, Point) else found.second))  # type: ignore[arg-type]
    whole = expected_families(a, b)
    assert len(families) == len(whole), (families, whole)
    for ends in families:
        assert any(all(map(same, ends, other)) for other in whole)
    _check_pairs(a, b, listed)
    for one, two in ((a, b), (b, a)):
        centred = [z for z, _ in one.ends if two.centre is not None and is_zero(z - two.centre)]
        assert all(any(is_zero(z - w) for w in about) for z in centred)
    if not meetings(a, b):
        event("apart")
        assert is_zero(min(distances) - least(a, b) ** 2)


def _check_pairs(a: Trace, b: Trace, listed: list[Pair]) -> None:
    for n, each in enumerate(listed):
        assert not any(same(each, other) for other in listed[:n]), "listed twice"
        assert is_stationary(Stand.at(a, each.first), Stand.at(b, each.second)), each
    normals = common_normals(a, b)
    for each in candidates(a, b):
        if is_zero(each.distance):
            continue
        if is_strict_minimum(Stand.at(a, each.first), Stand.at(b, each.second)):
            event("least")
            assert any(same(each, other) for other in listed), "a least pair is missing"
        elif any(same(each, other) for other in normals):
            assert not any(same(each, other) for other in listed), "a saddle is listed"


def about_the_origin(square: Fraction, start: tuple[int, int], end: tuple[int, int]) -> Bow:
    """A clockwise arc from one direction to another."""
    ends = (
        Spot(Fraction(0), Fraction(0), square / (x * x + y * y), Fraction(x), Fraction(y))
        for x, y in (start, end)
    )
    return Bow(Spot(Fraction(0), Fraction(0)), square, *ends, ccw=False)


ONE_START = (
    about_the_origin(Fraction(1, 2), (-7, 1), (-3, -2)),
    about_the_origin(Fraction(9, 2), (-7, 1), (-1, -1)),
)
"""Arcs that begin in one direction: stretched to one radius, their starts differ by 10^-1002 in digits."""


@examples(60, 2400)
@given(pairs())
@example(ONE_START)
def test_nearest_points_are_the_oracles(pair: tuple[Drawn, Drawn]) -> None:
    check_nearest(pair)
