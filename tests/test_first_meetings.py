"""First meetings by long balls, against an oracle that computes with 80 digits and knows nothing of balls."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin
from typing import Any

import mpmath
import pytest
from flint import arb, fmpq
from hypothesis import assume, given
from hypothesis import strategies as st
from mpmath import mpf
from nightly import some

import exactacq as xa
from exactacq import kernel
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.late import Balls, clearly_between
from exactacq.kernel.bound_lines import NOTHING
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing import complex_edges
from exactacq.sensing.complex_edges import normals
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.study.random_scenes import Subject, random_scene
from exactacq.visibility import rotational_sweep
from exactacq.visibility.features import features
from exactacq.visibility.line_balls import entered, first_meetings
from exactacq.visibility.line_families import Rolling, Sector, Turning
from exactacq.visibility.sensor_range import Range

TINY = mpf(10) ** -60
Crossing = tuple[mpf, int]
SCENE = xa.Scene(
    [
        xa.Polygon([(1, 1), (3, 1), (3, 2), (1, 2)]),
        xa.Circle((5, 2), 1),
        # A thick line with round ends, one on its side, and a plate with a notch and a fillet.
        xa.Outline([(8, 1, 0), (10, 1, 1), (10, 2, 0), (8, 2, 1)]),
        xa.Outline([(1, 5, 1), (2, 5, 0), (2, 8, 1), (1, 8, 0)]),
        xa.Outline([(4, 5, 0), (6, 5, "-1/2"), (7, 6, 0), (7, 8, "1/3"), (6, 9, 0), (4, 9, -1), (4, 7, 0)]),
        xa.Outline([(9, 5, 1), (11, 5, "1/2"), (11, 7, 0), (9, 7, 0)]),
    ],
    enclosure=xa.Outline([(-1, -1, 0), (13, -1, "1/4"), (13, 11, 0), (-1, 11, 0)]),
)
TABLE = EdgeTable(SCENE.obstacles)


def pencils() -> Iterator[tuple[Sector, tuple[int, ...]]]:
    """All sectors of tangents and normals, with the edges through their contacts."""
    for feature in features(TABLE):
        yield from ((sector, feature.edges) for sector in feature.sectors)
    for e, curve in enumerate(TABLE.curves):
        yield from ((sector, (e,)) for sector in normals(curve))


PENCILS = list(pencils())


def number(value: Real) -> mpf:
    low, _ = value.enclosure(300)
    return mpf(int(low.p)) / int(low.q)


def crossings(curve: Curve, is_own: bool, x: mpf, y: mpf, dx: mpf, dy: mpf) -> list[Crossing] | None:
    """How far ahead a line crosses a curve, with 1 where it enters the obstacle; the contact does not count.

    None if the line is close to a tangent, or to an end of the curve.
    """
    if isinstance(curve, Segment):
        if is_own:
            return []
        ax, ay, bx, by = (number(c) for p in (curve.start, curve.end) for c in p)
        wx, wy = bx - ax, by - ay
        under = wx * dy - wy * dx
        if abs(under) < TINY:
            return None
        u = ((x - ax) * dy - (y - ay) * dx) / under
        if min(abs(u), abs(u - 1)) < TINY:
            return None
        tau = ((ax + u * wx - x) * dx + (ay + u * wy - y) * dy) / (dx * dx + dy * dy)
        return [(tau, 1 if under > 0 else -1)] if 0 < u < 1 else []
    assert isinstance(curve, Arc)
    cx, cy, r = number(curve.center.x), number(curve.center.y), number(curve.radius)
    size = mpmath.hypot(dx, dy)
    nearest, off = ((cx - x) * dx + (cy - y) * dy) / size, ((cx - x) * dy - (cy - y) * dx) / size
    if abs(abs(off) - r) < TINY:
        return None
    if abs(off) > r:
        return []
    half = mpmath.sqrt(r * r - off * off)
    angles = [mpmath.atan2(number(p.y) - cy, number(p.x) - cx) for p in (curve.start, curve.end)]
    if not curve.ccw:
        angles.reverse()
    sweep = 2 * mpmath.pi if curve.full else (angles[1] - angles[0]) % (2 * mpmath.pi)
    found: list[Crossing] = []
    for way, inward in ((nearest - half, 1), (nearest + half, -1)):
        tau = way / size
        if is_own and abs(tau) < TINY:
            continue
        turn = (mpmath.atan2(y + tau * dy - cy, x + tau * dx - cx) - angles[0]) % (2 * mpmath.pi)
        if not curve.full and min(turn, abs(turn - sweep), 2 * mpmath.pi - turn) < TINY:
            return None
        if turn < sweep:
            found.append((tau, inward if curve.ccw else -inward))
    return found


def told(sector: Sector, t: fmpq, edges: list[int], own: tuple[int, ...]) -> tuple[int, int] | None:
    """The edges at which a line enters an obstacle; None if that is open."""
    first, left = first_meetings(TABLE, sector, t, edges, own)
    return None if left else entered(first)


def told_by_digits(sector: Sector, t: fmpq, edges: list[int], own: tuple[int, ...]) -> tuple[int, int] | None:
    """As `told`; None too where the line is close to what changes the answer."""
    contact, direction = sector.touch(Real(t))
    at = [number(c) for c in (*contact, *direction)]
    met: list[tuple[mpf, int, int]] = []
    for e in edges:
        found = crossings(TABLE.curves[e], e in own, *at)
        if found is None or any(abs(tau) < TINY for tau, _ in found):
            return None
        met += [(tau, e, sense) for tau, sense in found]
    behind = max((m for m in met if m[0] < 0), default=(0, NOTHING, -1))
    ahead = min((m for m in met if m[0] > 0), default=(0, NOTHING, 1))
    return behind[1] if behind[2] < 0 else NOTHING, ahead[1] if ahead[2] > 0 else NOTHING


@st.composite
def lines(draw: st.DrawFn) -> tuple[Sector, fmpq, tuple[int, ...]]:
    """Lines of a pencil, half of them very close to one through a vertex or to a tangent."""
    sector, own = draw(st.sampled_from(PENCILS))
    low, high = (Real(bound).enclosure(200)[0] for bound in (sector.low, sector.high))
    t = low + (high - low) * fmpq(draw(st.integers(1, 999)), 1000)
    if draw(st.booleans()):
        curve = TABLE.curves[draw(st.integers(0, len(TABLE.curves) - 1))]
        if isinstance(curve, Arc) and draw(st.booleans()):
            side, sign = draw(st.sampled_from([-1, 1])), draw(st.sampled_from([-1, 1]))
            event = sector.exact(curve.center.rational, curve.radius_sq, side, sign)
        else:
            event = sector.exact(curve.start.rational, fmpq(0), 0, draw(st.sampled_from([-1, 1])))
        if event is not None:
            near = Real(event).enclosure(300)[0]
            near += fmpq(draw(st.sampled_from([-1, 1])), 2 ** draw(st.integers(40, 120)))
            t = near if low < near < high else t
    return sector, t, own


def edges_about(sector: Sector, own: tuple[int, ...]) -> list[int]:
    """All edges but those of the circle on which a contact rolls, which its tangents meet nowhere else."""
    left = TABLE.on_circle_of(own[0]) if isinstance(sector, Rolling) else ()
    return [e for e in range(len(TABLE.curves)) if e not in left]


@given(lines())
def test_what_balls_tell_digits_tell(line: tuple[Sector, fmpq, tuple[int, ...]]) -> None:
    sector, t, own = line
    edges = edges_about(sector, own)
    with mpmath.workdps(80):
        expected = told_by_digits(sector, t, edges, own)
    assume(expected is not None)
    assert told(sector, t, edges, own) == expected


def turning(x: int, y: int) -> Turning:
    """The lines through a place that go east, more or less."""
    return Turning((fmpq(x), fmpq(y)), (fmpq(1), fmpq(0)), fmpq(-1), fmpq(1))


@pytest.mark.parametrize(("height", "is_open"), [(3, True), (1, True), (2, False)])
def test_open_where_the_line_is_a_tangent(height: int, is_open: bool) -> None:
    """Level lines at the circle about (5, 2) with the radius 1."""
    disc = next(e for e, curve in enumerate(TABLE.curves) if isinstance(curve, Arc) and curve.full)
    found = told(turning(0, height), fmpq(0), [disc], ())
    assert found == (None if is_open else (NOTHING, disc))


def test_open_where_the_line_passes_an_end() -> None:
    """With slope 1/3 a line passes the end (3, 1) of a wall, with 2/5 it comes from the blocked side."""
    wall = next(e for e, curve in enumerate(TABLE.curves) if curve.start.rational == (3, 1))
    assert told(turning(0, 0), fmpq(1, 3), [wall], ()) is None
    assert told(turning(0, 0), fmpq(2, 5), [wall], ()) == (NOTHING, NOTHING)


def test_open_where_places_may_be_one() -> None:
    """An edge at the contact that is not known to be there, and two that are met in one place."""
    wall = next(e for e, curve in enumerate(TABLE.curves) if curve.start.rational == (3, 1))
    assert told(turning(3, 1), fmpq(1, 2), [wall], (wall,)) == (NOTHING, NOTHING)
    middle = Turning((fmpq(3), fmpq(3, 2)), (fmpq(1), fmpq(0)), fmpq(-1), fmpq(1))
    assert told(middle, fmpq(0), [wall], ()) is None
    assert told(turning(0, 0), fmpq(2, 5), [wall, wall], ()) is None


def around(x: float, y: float, error: float = 1e-20) -> Balls:
    return arb(x, error), arb(y, error)


def test_between_the_ends_of_half_a_turn() -> None:
    """Whether a half turn is more than one or less is open; what lies on one side of it is told."""
    east, west = around(1, 0), around(-1, 0)
    assert [clearly_between(east, west, around(x, y)) for x, y in ((3, 1), (3, -1))] == [True, False]
    assert clearly_between(east, west, around(1, 0)) is None
    assert clearly_between(east, around(1, 0), around(0, 1)) is None


@pytest.mark.parametrize("k", range(12))
def test_between_as_angles_tell(k: int) -> None:
    """From 0 to 150 degrees, and to 210: by directions at 15 degrees, 45 and so on."""
    for end in (5, 7):
        start, last, way = (around(cos(n * pi / 6), sin(n * pi / 6), 1e-12) for n in (0, end, k + 0.5))
        assert clearly_between(start, last, way) == (k < end)


class Cells:
    """The cells of which balls tell what their lines meet first, compared with all exact contacts."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        decisions = rotational_sweep._Decisions
        self.choose, self.ask, self.sweep = decisions._perhaps_first, decisions._met, complex_edges.swept
        self.possible: list[int] = []
        self.goes_back = True
        self.told = self.all = self.few = 0
        monkeypatch.setattr(kernel, "EXACT_ONLY", True)
        # Unlike methods of this class, functions are bound to the decisions.
        monkeypatch.setattr(decisions, "_perhaps_first", lambda *cell: self.chosen(*cell))  # noqa: PLW0108
        monkeypatch.setattr(decisions, "_met", lambda *cell: self.compared(*cell))  # noqa: PLW0108
        monkeypatch.setattr(complex_edges, "swept", self.swept)

    def swept(self, *sector: Any, goes_back: bool = True, **more: Any) -> Any:
        self.goes_back = goes_back
        return self.sweep(*sector, goes_back=goes_back, **more)

    def chosen(self, decisions: rotational_sweep._Decisions, cell: int, edges: list[int]) -> list[int]:
        self.possible = edges
        few = self.choose(decisions, cell, edges)
        self.all, self.few = self.all + len(edges), self.few + len(few)
        return few

    def compared(
        self, decisions: rotational_sweep._Decisions, middle: fmpq, edges: list[int]
    ) -> tuple[int, int]:
        met = self.ask(decisions, middle, edges)
        behind, ahead = decisions._exact_meet(middle, self.possible)
        # A sweep that does not go back has no events there.
        assert met[1] == ahead and (met[0] == behind or not self.goes_back)
        self.told += 1
        return met


@pytest.mark.parametrize("seed", some(range(64700000, 64700060), 4))
def test_as_exact_contacts_tell(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """In every cell of the sweeps of random scenes, where floats tell nothing."""
    cells, scene = Cells(monkeypatch), random_scene(Subject.SIGHTSEER, seed)
    table = EdgeTable(scene.obstacles)
    families = VisibilityComplex(table, Range(scene.radius or fmpq(3)))
    for e in range(len(table.curves)):
        families.extents(e)
    assert cells.told


def test_along_a_row_only_what_has_changed_is_met_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pads with round ends, as on a circuit board: lines along a row meet them one after the other."""
    cells = Cells(monkeypatch)
    pads = [xa.Outline([(x, 0), (x + 1, 0, 1), (x + 1, 2), (x, 2, 1)]) for x in range(0, 40, 4)]
    table = EdgeTable(xa.Scene(pads, start=(-9, 0), radius=50).obstacles)
    families = VisibilityComplex(table, Range(fmpq(50)))
    for e in range(4):
        families.extents(e)
    assert cells.told and 4 * cells.few < cells.all


def spirals(turns: int) -> xa.Scene:
    """Two walls of half circles, whose centres are corners of the walls: all normals of an arc pass one."""

    def wall(x: int) -> xa.Outline:
        inner, outer, middles, middle, radius, sense = [fmpq(1, 2)], [fmpq(1)], [], fmpq(0), fmpq(1, 2), 1
        for _ in range(turns):
            middles.append(middle)
            end = middle - sense * radius
            inner.append(end)
            outer.append(end - sense * fmpq(1, 2))
            sense, radius = -sense, radius + fmpq(1, 2)
            middle = end - sense * radius
        way_in = [(x, inner[k], xa.Around((x, middles[k]))) for k in range(turns)]
        way_out = [(x, outer[k], xa.Around((x, middles[k - 1]), ccw=False)) for k in range(turns, 0, -1)]
        return xa.Outline([*way_in, (x, inner[turns], -1), *way_out, (x, outer[0], -1)])

    return xa.Scene([wall(0), wall(turns + 5)], start=(-turns - 5, 1), radius=100)


def test_normals_through_a_corner_are_decided_among_few_edges(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each of their lines was met with all edges exactly: a walk past 96 edges took a minute."""
    scene = spirals(7)
    met = 0

    def counted(*line: Any) -> list[Real]:
        nonlocal met
        met += 1
        return line_contacts(*line)

    monkeypatch.setattr(rotational_sweep, "line_contacts", counted)
    edge = scene.obstacles[0].edges[0]
    events = xa.sweep(scene, edge, obstacle=0).events
    few, met = met, 0
    monkeypatch.setattr(rotational_sweep, "first_meetings", lambda *line: ({}, list(line[3])))
    again = xa.sweep(scene, edge, obstacle=0).events
    assert [(one.change, one.obstacle, one.edge, one.u) for one in events] == [
        (one.change, one.obstacle, one.edge, one.u) for one in again
    ]
    assert 0 < 4 * few < met
