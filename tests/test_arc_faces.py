"""Faces of arcs: the points of an arc whose free side is turned to a place are those that its faces cover.

The oracle is the definition at sampled points, in 50 digits; places lie within, outside and near circles.
"""

from __future__ import annotations

from fractions import Fraction

import mpmath
import pytest
from flint import fmpq
from hypothesis import assume, given
from hypothesis import strategies as st
from mpmath import mpf
from nightly import examples

import exactacq as xa
from exactacq import kernel
from exactacq.geometry.curves import Arc
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.front_faces import NOWHERE, FrontFaces
from exactacq.visibility.sensor_range import Range

SCENE = xa.Scene(
    [
        xa.Circle((5, 2), 1),
        # Thick lines with round ends; a plate with fillets of both senses; most of a disc, and a bite.
        xa.Outline([(8, 1, 0), (10, 1, 1), (10, 2, 0), (8, 2, 1)]),
        xa.Outline([(4, 5, 0), (6, 5, "-1/2"), (7, 6, 0), (7, 8, "1/3"), (6, 9, 0), (4, 9, -1), (4, 7, 0)]),
        xa.Outline([(9, 5, 3), (10, 5, 0)]),
        xa.Outline([(0, 4, 0), (3, 4, "-3/4"), (3, 7, 0), (0, 7, 0)]),
    ],
    enclosure=xa.Outline([(-1, -1, 0), (13, -1, "1/4"), (13, 11, 2), (-1, 11, 0)]),
)
TABLE = EdgeTable(SCENE.obstacles)
ARCS = [e for e, curve in enumerate(TABLE.curves) if isinstance(curve, Arc)]
CLOSE = mpf(10) ** -9


def number(value: Real) -> mpf:
    low, _ = value.enclosure(200)
    return mpf(int(low.p)) / int(low.q)


def turn(a: tuple[mpf, mpf], b: tuple[mpf, mpf]) -> mpf:
    """By how much a vector turns counterclockwise to another one, below a full turn."""
    angle = mpmath.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
    return angle % (2 * mpmath.pi)


def samples(arc: Arc, count: int = 24) -> list[tuple[mpf, mpf]]:
    """Points of an arc, in its sense, away from its ends."""
    cx, cy = number(arc.center.x), number(arc.center.y)
    start, end = ((number(p.x) - cx, number(p.y) - cy) for p in (arc.start, arc.end))
    sweep = 2 * mpmath.pi if arc.full else turn(start, end) if arc.ccw else turn(end, start)
    found = []
    for k in range(count):
        angle = sweep * (2 * k + 1) / (2 * count) * (1 if arc.ccw else -1)
        cosine, sine = mpmath.cos(angle), mpmath.sin(angle)
        found.append((cx + start[0] * cosine - start[1] * sine, cy + start[1] * cosine + start[0] * sine))
    return found


def told(table: EdgeTable, place: xa.Point) -> list[tuple[int, list[xa.Point]]]:
    """The faces of arcs, by edge, with the points where they end."""
    faces = FrontFaces(table, place, Range(fmpq(40)), ())
    ends = [(face.edge, faces.ends(face.number)) for face in faces.floats.faces]
    return sorted(
        [(e, [faces.place(end) for end in pair if end != NOWHERE]) for e, pair in ends if e in ARCS],
        key=lambda face: (face[0], [point.xy for point in face[1]]),
    )


def check(place: xa.Point) -> None:
    faces = FrontFaces(TABLE, place, Range(fmpq(40)), ())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kernel, "EXACT_ONLY", True)
        exact = told(EdgeTable(SCENE.obstacles), place)
    assert told(TABLE, place) == exact, place
    x, y = number(place.x), number(place.y)
    for e in ARCS:
        arc = TABLE.curves[e]
        assert isinstance(arc, Arc)
        spans = []
        for face in faces.floats.faces:
            if face.edge == e:
                ends = faces.ends(face.number)
                spans.append(None if NOWHERE in ends else [faces.place(event) for event in ends])
        for u, v in samples(arc):
            cx, cy = number(arc.center.x), number(arc.center.y)
            facing = (u - cx) * (x - u) + (v - cy) * (y - v)
            if abs(facing) < CLOSE:
                continue
            is_front = (facing > 0) == arc.ccw
            covered = 0
            for span in spans:
                if span is None:
                    covered += 1
                    continue
                low, high = ((number(p.x) - x, number(p.y) - y) for p in span)
                covered += turn(low, (u - x, v - y)) < turn(low, high)
            # A direction may lead to the far part as well: then the near part is covered too.
            if is_front:
                assert covered >= 1, (e, place)
            elif not spans:
                continue
            elif covered:
                assert any_front(arc, x, y, u, v), (e, place)


def any_front(arc: Arc, x: mpf, y: mpf, u: mpf, v: mpf) -> bool:
    """Whether the line from a place to a point of an arc meets a front part of it elsewhere."""
    cx, cy, r = number(arc.center.x), number(arc.center.y), number(arc.radius)
    dx, dy = u - x, v - y
    size = dx * dx + dy * dy
    along = ((cx - x) * dx + (cy - y) * dy) / size
    other = 2 * along - 1
    p, q = x + dx * other, y + dy * other
    start, end = ((number(point.x) - cx, number(point.y) - cy) for point in (arc.start, arc.end))
    sweep = 2 * mpmath.pi if arc.full else turn(start, end) if arc.ccw else turn(end, start)
    at = turn(start, (p - cx, q - cy)) if arc.ccw else turn((p - cx, q - cy), start)
    return other > 0 and at < sweep and abs((p - cx) ** 2 + (q - cy) ** 2 - r * r) < CLOSE


def free(x: Fraction, y: Fraction) -> xa.Point:
    place = xa.Point(x, y)
    near = any(curve.passes(place) for curve in TABLE.curves)
    assume(not near)
    return place


coordinates = st.builds(Fraction, st.integers(-90, 130 * 8), st.sampled_from([80, 96]))


@examples(25)
@given(coordinates, coordinates)
def test_faces_cover_what_is_turned_to_a_place(x: Fraction, y: Fraction) -> None:
    with mpmath.workdps(50):
        check(free(x, y))


@examples(20)
@given(st.sampled_from(ARCS), st.integers(0, 23), st.integers(-12, 12), st.integers(3, 14))
def test_faces_seen_from_close_to_an_arc(e: int, k: int, side: int, digits: int) -> None:
    assume(side)
    with mpmath.workdps(50):
        arc = TABLE.curves[e]
        assert isinstance(arc, Arc)
        u, v = samples(arc)[k]
        share = 1 + mpf(side) / mpf(10) ** digits
        cx, cy = number(arc.center.x), number(arc.center.y)
        x, y = (Fraction(str(mpmath.nstr(c + (w - c) * share, 30))) for c, w in ((cx, u), (cy, v)))
        check(free(x, y))


@pytest.mark.parametrize("e", ARCS)
def test_faces_from_the_tangent_at_an_end(e: int) -> None:
    """A place on the tangent at an end sees the arc begin there: floats leave it open."""
    arc = TABLE.curves[e]
    assert isinstance(arc, Arc)
    for end in (arc.start, arc.end):
        for share in (fmpq(1, 3), fmpq(-2, 7)):
            with mpmath.workdps(50):
                check(end + arc.tangent(end) * share)


def test_floats_tell_nearly_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """Exact numbers are made for no arc that a place is not close to."""
    asked: list[int] = []
    arc = FrontFaces._arc
    monkeypatch.setattr(FrontFaces, "_arc", lambda faces, e: asked.append(e) or arc(faces, e))
    FrontFaces(TABLE, xa.Point("7.3", "3.1"), Range(fmpq(40)), ())
    assert not asked
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    FrontFaces(EdgeTable(SCENE.obstacles), xa.Point("7.3", "3.1"), Range(fmpq(40)), ())
    assert len(asked) == len(ARCS)
