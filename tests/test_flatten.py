"""Curves and the chains of arcs that stand for them, compared at many points by code of their own."""

from __future__ import annotations

from itertools import pairwise

import mpmath
import numpy as np
import pytest
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st
from nightly import NIGHTLY, examples, some

from exactacq.errors import FormatError
from exactacq.files.repairs.bezier import BezierPiece, arc_pieces, polynomial, spline
from exactacq.files.repairs.biarcs import biarc, fits_biarc, fits_segment
from exactacq.files.repairs.flatten import FlatChain, flatten

SQUARE = [(0, 0), (0, 2), (2, 2), (2, 0)]
CURVES = {
    "arch": SQUARE,
    "loop": [(0, 0), (3, 2), (-1, 2), (2, 0)],
    "bend and back": [(0, 0), (1, 2), (1, -2), (2, 0)],
    "cusp": [(0, 0), (2, 2), (0, 2), (2, 0)],
    "line": [(0, 0), (1, 1), (2, 2), (3, 3)],
    "line that turns back": [(0, 0), (5, 5), (-4, -4), (1, 1)],
    "parabola": [(0, 0), (1, 3), (2, 0)],
    "no tangent at its ends": [(0, 0), (0, 0), (1, 2), (3, 1), (3, 1)],
    "closed": [(0, 0), (4, 3), (-4, 3), (0, 0)],
    "flat": [(0, 0), (1, "1/1000"), (2, "-1/1000"), (3, 0)],
    "far from the origin": [(10**7, 10**7), (10**7 + 1, 10**7 + 2), (10**7 + 3, 10**7)],
    "degree 5": [(0, 0), (1, 4), (2, -3), (3, 5), (4, -2), (5, 0)],
}
PLACES = 1200 if NIGHTLY else 500
"""How many places of a curve are looked at."""
number = st.integers(-60, 60).map(lambda n: fmpq(n, 8))
place = st.tuples(number, number)


def pairs(points: list) -> list[tuple[fmpq, fmpq]]:
    return [(fmpq(*map(int, str(x).split("/"))), fmpq(*map(int, str(y).split("/")))) for x, y in points]


def high(value: fmpq) -> mpmath.mpf:
    return mpmath.mpf(int(value.p)) / int(value.q)


def bernstein(rows: list, t: mpmath.mpf) -> mpmath.mpc:
    """A rational Bézier curve by its definition."""
    n = len(rows) - 1
    basis = [mpmath.binomial(n, i) * t**i * (1 - t) ** (n - i) for i in range(n + 1)]
    x, y, w = (sum(b * high(row[k]) for b, row in zip(basis, rows, strict=True)) for k in range(3))
    return mpmath.mpc(x / w, y / w)


def edges_of(chain: FlatChain) -> list[tuple[complex, complex, float]]:
    """Start, end and bulge of all edges, in floats, from the start of the chain."""
    ends = [*((x, y) for x, y, _ in chain.edges[1:]), chain.end]
    x0, y0, _ = chain.edges[0]
    here = [(complex(high(x - x0), high(y - y0)), float(high(b))) for x, y, b in chain.edges]
    there = [complex(high(x - x0), high(y - y0)) for x, y in ends]
    return [(p, q, b) for (p, b), q in zip(here, there, strict=True)]


def on_edges(edges: list, count: int) -> np.ndarray:
    """Points of arcs and segments by w = s / (s + (1 - s) exp(2 i atan b))."""
    s = np.linspace(0, 1, count)
    return np.concatenate([p + (q - p) * s / (s + (1 - s) * np.exp(2j * np.arctan(b))) for p, q, b in edges])


def apart(points: np.ndarray, polyline: np.ndarray) -> float:
    """The largest distance of points from a polyline, by brute force."""
    a, b = polyline[:-1], polyline[1:]
    square = np.maximum(np.abs(b - a) ** 2, 1e-300)
    worst = 0.0
    for chunk in np.array_split(points, max(1, len(points) // 200)):
        offset = chunk[:, None] - a
        t = np.clip((offset * np.conj(b - a)).real / square, 0, 1)
        worst = max(worst, float(np.abs(offset - t * (b - a)).min(axis=1).max()))
    return worst


def check(pieces: list[BezierPiece], chain: FlatChain, tolerance: float, count: int = PLACES) -> None:
    """Hausdorff's distance by samples; both polylines sag below their curves by much less than they miss."""
    x0, y0 = pieces[0].point(fmpq(0))
    moved = [[(x - x0 * w, y - y0 * w, w) for x, y, w in piece.rows] for piece in pieces]
    with mpmath.workdps(40):
        curve = [complex(bernstein(rows, mpmath.mpf(i) / count)) for rows in moved for i in range(count + 1)]
    edges = edges_of(chain)
    chained = on_edges(edges, 80)
    sag = max(
        max(abs(c - b * 2 + a) for a, b, c in zip(x, x[1:], x[2:], strict=False)) for x in (curve, chained)
    )
    assert apart(np.array(curve), chained) <= tolerance + sag
    assert apart(chained, np.array(curve)) <= tolerance + sag
    assert chain.end == pieces[-1].point(fmpq(1))
    assert chain.edges[0][:2] == pieces[0].point(fmpq(0))


def kinks(chain: FlatChain) -> int:
    """Joints of two arcs whose tangents differ, exactly: the chord turned by -2 atan b and by 2 atan b."""
    found = 0
    ends = [*((x, y) for x, y, _ in chain.edges[1:]), chain.end]
    tangents = []
    for (x, y, b), (u, v) in zip(chain.edges, ends, strict=True):
        dx, dy, c, s = u - x, v - y, 1 - b * b, 2 * b
        tangents.append((b, (dx * c + dy * s, dy * c - dx * s), (dx * c - dy * s, dy * c + dx * s)))
    for (b, _, ahead), (d, back, _) in pairwise(tangents):
        smooth = ahead[0] * back[1] == ahead[1] * back[0] and ahead[0] * back[0] + ahead[1] * back[1] > 0
        found += bool(b and d) and not smooth
    return found


@pytest.mark.parametrize("tolerance", ["1/10", "1/1000"])
@pytest.mark.parametrize("name", some(CURVES, 8))
def test_a_curve_and_its_arcs_are_within_the_tolerance(name: str, tolerance: str) -> None:
    piece = polynomial(pairs(CURVES[name]))
    bound = fmpq(*map(int, tolerance.split("/")))
    check([piece], flatten([piece], bound), float(high(bound)))


@examples(5, 400)
@given(st.lists(place, min_size=2, max_size=5), st.lists(st.integers(1, 9), min_size=5, max_size=5))
def test_any_curve_and_its_arcs_are_within_the_tolerance(points: list, masses: list[int]) -> None:
    rows = [(x * w, y * w, fmpq(w)) for (x, y), w in zip(points, masses, strict=False)]
    if any(point != points[0] for point in points):
        piece = BezierPiece(tuple(rows))
        check([piece], flatten([piece], fmpq(1, 50)), 0.02, count=500)


def test_biarcs_have_one_tangent_at_every_joint() -> None:
    for name in some(("arch", "loop", "bend and back", "parabola", "degree 5"), 3):
        for power in (2, 4, 6) if NIGHTLY else (2, 5):
            chain = flatten([polynomial(pairs(CURVES[name]))], fmpq(1, 10**power))
            assert kinks(chain) == 0
            assert chain.arcs >= len(chain.edges) - 1


def test_arcs_are_fewer_than_chords() -> None:
    """A chord of curvature k and length l is off by k l^2 / 8: so many chords are needed at least."""
    piece = polynomial(pairs(SQUARE))
    t = np.linspace(0, 1, 20001)
    points = np.array([complex(bernstein(list(piece.rows), mpmath.mpf(x))) for x in t[::10]])
    turns = np.abs(np.diff(np.unwrap(np.angle(np.diff(points)))))
    lengths = np.abs(np.diff(points))[1:]
    for power, ratio in ((2, 1.2), (4, 3), (6, 10)):
        chords = np.sum(np.sqrt(turns / lengths / 8 / 10.0**-power) * lengths)
        assert len(flatten([piece], fmpq(1, 10**power)).edges) * ratio < chords


def test_parts_and_polar_forms_are_those_of_the_definition() -> None:
    rows = [(fmpq(x), fmpq(y), fmpq(w)) for x, y, w in ((0, 0, 1), (2, 6, 2), (9, 3, 3), (8, 0, 2))]
    part = BezierPiece(tuple(rows)).part(fmpq(1, 3), fmpq(3, 4))
    with mpmath.workdps(40):
        for i in range(9):
            t = mpmath.mpf(i) / 8
            inner = mpmath.mpf(1) / 3 + t * (mpmath.mpf(3) / 4 - mpmath.mpf(1) / 3)
            assert abs(bernstein(list(part.rows), t) - bernstein(rows, inner)) < 1e-35


def basis(i: int, p: int, knots: list, u: mpmath.mpf) -> mpmath.mpf:
    """Cox's and de Boor's recursion as textbooks state it."""
    if p == 0:
        return mpmath.mpf(knots[i] <= u < knots[i + 1])
    total = mpmath.mpf(0)
    if knots[i + p] != knots[i]:
        total += (u - knots[i]) / (knots[i + p] - knots[i]) * basis(i, p - 1, knots, u)
    if knots[i + p + 1] != knots[i + 1]:
        total += (knots[i + p + 1] - u) / (knots[i + p + 1] - knots[i + 1]) * basis(i + 1, p - 1, knots, u)
    return total


@pytest.mark.parametrize(
    ("degree", "knots"),
    [
        (1, [0, 0, 1, 2, 4, 5, 5]),
        (2, [0, 0, 0, 1, 1, 2, 2, 2]),
        (3, [0, 1, 2, 3, 4, 5, 6, 7, 8]),
        (3, [0, 0, 0, 0, 3, 4, 4, 4, 4]),
    ],
)
def test_the_pieces_of_a_spline_are_the_spline(degree: int, knots: list[int]) -> None:
    count = len(knots) - degree - 1
    points = pairs([(k * k % 7, 3 * k % 5) for k in range(count)])
    weights = [fmpq(1 + k % 3) for k in range(count)]
    pieces = spline(degree, [fmpq(k) for k in knots], points, weights)
    spans = [(a, b) for a, b in pairwise(knots[degree : count + 1]) if a < b]
    assert len(spans) == len(pieces)
    for (a, b), piece in zip(spans, pieces, strict=True):
        for i in range(8):
            t = mpmath.mpf(i) / 8
            mass = [high(w) * basis(k, degree, knots, a + t * (b - a)) for k, w in enumerate(weights)]
            place = sum(m * mpmath.mpc(high(x), high(y)) for m, (x, y) in zip(mass, points, strict=True))
            assert abs(bernstein(list(piece.rows), t) - place / sum(mass)) < 1e-12
    check(pieces, flatten(pieces, fmpq(1, 100)), 0.01, count=300)


@given(place, place, st.integers(-300, 300).map(lambda n: fmpq(n, 100)))
def test_an_arc_as_a_piece_lies_on_its_circle(start: tuple, end: tuple, bulge: fmpq) -> None:
    """From all points of an arc its chord is seen under one angle."""
    if start == end or bulge == 0:
        return
    pieces = arc_pieces(start, end, bulge)
    assert (pieces[0].point(fmpq(0)), pieces[-1].point(fmpq(1))) == (start, end)
    assert all(w > 0 for piece in pieces for _, _, w in piece.rows)
    p, q = (complex(high(x), high(y)) for x, y in (start, end))
    for piece in pieces:
        for i in range(1, 8):
            x, y = piece.point(fmpq(i, 8))
            w = (complex(high(x), high(y)) - p) / (q - p)
            seen = w / (1 - w) * np.exp(2j * np.arctan(float(high(bulge))))
            assert np.angle(seen) == pytest.approx(0, abs=1e-6)


def test_an_ellipse_is_within_its_tolerance() -> None:
    corners = [(1, 0), ("3/5", "4/5"), ("-3/5", "4/5"), (-1, 0), (0, -1), (1, 0)]
    unit = pairs(corners)
    pieces = []
    for a, b in pairwise(unit):
        turned = mpmath.mpc(high(b[0]), high(b[1])) / mpmath.mpc(high(a[0]), high(a[1]))
        bulge = fmpq(round(float(mpmath.tan(mpmath.arg(turned) / 4)) * 10**9), 10**9)
        pieces += [p.image(*pairs([(3, 4), (5, 1), ("-1/5", 1)])) for p in arc_pieces(a, b, bulge)]
    chain = flatten(pieces, fmpq(1, 1000))
    check(pieces, chain, 0.001)
    assert chain.arcs == len(chain.edges) < 48


def test_a_biarc_that_is_off_is_not_accepted() -> None:
    """The proof says yes near the least bound that is true, and no below it."""
    piece = polynomial(pairs(SQUARE)).part(fmpq(0), fmpq(1, 2))
    turns = pairs([("3/5", "4/5"), ("5/13", "12/13"), (1, 0)])
    turns[0] = (fmpq(119, 169), fmpq(120, 169))
    found = biarc(
        piece.point(fmpq(0)), piece.point(fmpq(1)), (turns[0], (fmpq(12, 13), fmpq(5, 13)), turns[2])
    )
    assert found is not None
    chain = FlatChain()
    for arc in (found.first, found.second):
        chain.add(arc.start, arc.bulge, arc.end)
    curve = np.array([complex(bernstein(list(piece.rows), mpmath.mpf(i) / 2000)) for i in range(2001)])
    truly = apart(curve, on_edges(edges_of(chain), 1000))
    joint, along = (complex(high(x), high(y)) for x, y in (found.first.end, found.tangent))
    parting = fmpq(int(np.argmin(np.abs(((curve - joint) * np.conj(along)).real))), 2000)
    assert not fits_biarc(piece, found, parting, fmpq(int(truly * 0.99 * 10**9), 10**9))
    assert fits_biarc(piece, found, parting, fmpq(int(truly * 1.2 * 10**9), 10**9))


def test_a_segment_is_judged_by_the_control_points() -> None:
    piece = polynomial(pairs([(0, 0), (1, 1), (2, 0)]))
    assert fits_segment(piece, fmpq(1))
    assert not fits_segment(piece, fmpq(99, 100))
    beyond = polynomial(pairs([(0, 0), (-1, 0), (1, 0)]))
    assert fits_segment(beyond, fmpq(1))
    assert not fits_segment(beyond, fmpq(1, 2))


def test_a_point_adds_nothing() -> None:
    chain = flatten([polynomial(pairs([(1, 1), (1, 1), (1, 1)]))], fmpq(1))
    assert chain.edges == []
    assert chain.end is None


@pytest.mark.parametrize("tolerance", [fmpq(0), fmpq(-1)])
def test_a_tolerance_is_a_length(tolerance: fmpq) -> None:
    with pytest.raises(FormatError, match="above 0"):
        flatten([polynomial(pairs(SQUARE))], tolerance)


def test_too_small_a_tolerance_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(FormatError, match="too short for so large a curve"):
        flatten([polynomial(pairs(SQUARE))], fmpq(1, 10**16))
    monkeypatch.setattr("exactacq.files.repairs.flatten.MAX_PIECES", 9)
    with pytest.raises(FormatError, match="too many arcs"):
        flatten([polynomial(pairs(SQUARE))], fmpq(1, 10**6))


@pytest.mark.parametrize(
    ("degree", "knots", "weights"),
    [
        (0, [0, 1], ()),
        (2, [0, 0, 1, 1], ()),
        (1, [0, 1, 0, 1], ()),
        (1, [0, 0, 1, 1], (1, 0)),
        (1, [1] * 4, ()),
    ],
)
def test_what_is_no_spline_is_refused(degree: int, knots: list[int], weights: tuple[int, ...]) -> None:
    with pytest.raises(FormatError):
        spline(degree, [fmpq(k) for k in knots], pairs([(0, 0), (1, 1)]), [fmpq(w) for w in weights])
