"""Contacts of curves and lines against an oracle of 1,000 digits that shares no formula (`moebius`)."""

from __future__ import annotations

from drawn_curves import library_curve, library_point, pairs
from hypothesis import event, given
from moebius import Bow, Complex, Drawn, Trace, is_zero, line_meetings, meetings, mp, place
from nightly import examples

from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.intersections import ContactKind, contacts, line_contacts, spans
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real

BITS = 2400
KINDS = {ContactKind.CROSSING: "cross", ContactKind.TOUCHING: "touch", ContactKind.OVERLAP: "overlap"}


def digits(value: Real) -> object:
    """A number of the library in the oracle's digits."""
    low, high = value.enclosure(BITS)
    middle = (low + high) / 2
    return mp.mpf(int(middle.p)) / int(middle.q)


def seen(point: Point) -> Complex:
    return mp.mpc(digits(point.x), digits(point.y))


def ends_of(curve: Curve) -> list[Point]:
    return [] if isinstance(curve, Arc) and curve.full else [curve.start, curve.end]


def check_contacts(pair: tuple[Drawn, Drawn]) -> None:
    """The components are those of the oracle: kind, places, direction; ends of curves are copied."""
    a, b = map(Trace, pair)
    one, two = map(library_curve, pair)
    expected, found = meetings(a, b), contacts(one, two)
    for m in expected:
        event(m.kind)
    assert len(found) == len(expected), (found, expected)
    for contact in found:
        start, end = seen(contact.start), seen(contact.end)
        matching = [m for m in expected if is_zero(m.start - start) and is_zero(m.end - end)]
        assert [m.kind for m in matching] == [KINDS[contact.kind]], contact
        assert (contact.start is contact.end) == (matching[0].kind != "overlap" or (a.closed and b.closed))
        for place_, z in ((contact.start, start), (contact.end, end)):
            if a.is_end(z) or b.is_end(z):
                assert any(place_ is end for curve in (one, two) for end in ends_of(curve)), "not copied"


def check_line(case: tuple[Drawn, Drawn]) -> None:
    """The line through a segment (or an arc's chord) meets a curve at the oracle's parameters, in order."""
    rail, drawn = case
    first, last = rail.start, rail.centre if isinstance(rail, Bow) else rail.end
    origin, direction = library_point(first), library_point(last) - library_point(first)
    found = line_contacts(origin, direction, library_curve(drawn))
    expected = line_meetings(place(first), place(last) - place(first), Trace(drawn))
    assert len(found) == len(expected), (found, expected)
    assert all(is_zero(digits(t) - s) for t, s in zip(found, expected, strict=True))


def check_spans(case: tuple[Drawn, Drawn]) -> None:
    """A ray from an arc's centre meets it or not: the oracle goes along it as far as the radius."""
    rail, bow = case
    if not isinstance(bow, Bow):
        return
    aim = library_point(rail.start) - library_point(bow.centre)
    if aim.norm_sq() == 0:
        return
    trace, arc = Trace(bow), library_curve(bow)
    assert isinstance(arc, Arc)
    ray = place(rail.start) - trace.centre
    z = trace.centre + ray * (trace.radius / abs(ray))
    direction = tuple(t if t.rational is None else t.rational for t in aim)
    assert spans(arc, direction) == trace.holds(z)
    assert spans(arc, direction, strict=True) == (trace.holds(z) and not trace.is_end(z))


def check_points(case: tuple[Drawn, Drawn]) -> None:
    """Whether a curve passes a point: the ends of another, and points of itself."""
    rail, drawn = case
    trace, curve = Trace(drawn), library_curve(drawn)
    spots = [rail.start, rail.start if rail.end is None else rail.end, drawn.start]
    for spot in spots + ([drawn.centre] if isinstance(drawn, Bow) else []):
        point = library_point(spot)
        assert curve.passes(point) == trace.holds(place(spot)), spot
        assert curve.may_pass(point, 64) or not trace.holds(place(spot))


@examples(120)
@given(pairs())
def test_contacts_are_the_oracles(pair: tuple[Drawn, Drawn]) -> None:
    check_contacts(pair)


@examples(60)
@given(pairs())
def test_lines_meet_curves_where_the_oracle_says(case: tuple[Drawn, Drawn]) -> None:
    check_line(case)
    check_spans(case)


@examples(50)
@given(pairs())
def test_curves_pass_the_points_that_the_oracle_says(case: tuple[Drawn, Drawn]) -> None:
    check_points(case)
