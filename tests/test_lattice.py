"""Vertices as integers: sweeps that decide by them beside exact ones, and beside what lies on each line."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from random import Random

import pytest
from flint import fmpq
from nightly import some
from strategies import arc_terrain, build, degenerate_terrain, square_grid

import exactacq as xa
from exactacq.kernel.bound_lines import BoundLine
from exactacq.kernel.images import SLIDING, TURNING
from exactacq.kernel.lattice import Lattice, LatticeLines
from exactacq.kernel.radial_faces import FaceEnd
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.complex_edges import normals
from exactacq.visibility import rotational_sweep
from exactacq.visibility.features import features
from exactacq.visibility.line_families import Sliding
from exactacq.visibility.radial_sweep import RadialSweep
from exactacq.visibility.rotational_sweep import Pencil, pencil
from exactacq.visibility.sensor_range import Range

REACH = 7.3


def polygons(scale: fmpq, shift: fmpq) -> xa.Scene:
    """Triangles and squares on a grid, scaled and moved: many corners on one line."""
    rng = Random(3)
    cells = [(i, j) for i in range(4) for j in range(4)]
    shapes = []
    for i, j in rng.sample(cells, 9):
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        if rng.random() < 0.5:
            del corners[rng.randrange(4)]
        shapes.append(xa.Polygon([((2 * i + x) * scale + shift, (2 * j + y) * scale) for x, y in corners]))
    return xa.Scene(shapes)


SCENES = {
    "squares": build(square_grid(4, 3)),
    "decimals": polygons(fmpq(1234567, 10**6), fmpq(10**6)),
    "large integers": polygons(fmpq(10**15 + 7, 10**15), fmpq(10**9, 3)),
    **{f"degenerate {seed}": build(degenerate_terrain(Random(seed)).shapes) for seed in (1, 3, 5)},
    **{f"arcs {seed}": build(arc_terrain(Random(seed)).shapes) for seed in (0, 2)},
}


def pencils(table: EdgeTable, reach: float) -> Iterator[Pencil]:
    """All tangents and normals, as runs and links sweep them."""
    for feature in features(table):
        vertex = -1 if feature.round else feature.edges[1]
        for sector in feature.sectors:
            yield pencil(table, sector, feature.edges, reach, vertex=vertex)
    for e, curve in enumerate(table.curves):
        for sector in normals(curve):
            vertex = e if isinstance(sector, Sliding) else -1
            yield pencil(table, sector, (e,), reach, vertex=vertex)


def told(lines: Pencil) -> tuple[object, ...]:
    """Cells with their bounds and what these pass, and pinched lines."""
    cells = [
        (str(c.low), str(c.high), c.behind, c.ahead, *(sorted(passed) for passed in c.bounds))
        for c in lines.cells
    ]
    return cells, [(str(t), sorted(passed)) for t, passed in lines.pinches]


@pytest.mark.parametrize("name", some(SCENES, 4))
def test_integers_tell_what_exact_values_tell(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scale = 9 if name == "large integers" else 1
    by_integers = EdgeTable(SCENES[name].obstacles)
    assert by_integers.lattice is not None
    exact = EdgeTable(SCENES[name].obstacles)
    vars(exact)["lattice"] = None
    decided = []
    make = rotational_sweep._Decisions.make
    with monkeypatch.context() as patch:
        patch.setattr(
            rotational_sweep._Decisions, "make", lambda self: (decided.append(self.table), make(self))
        )
        pairs = [
            (told(one), told(other))
            for one, other in zip(
                pencils(by_integers, REACH * scale), pencils(exact, REACH * scale), strict=True
            )
        ]
    for one, other in pairs:
        assert one == other
    # Otherwise exact values would decide both.
    left, all_ = decided.count(by_integers), decided.count(exact)
    assert left < all_
    assert left == 0 or any(by_integers.kind)


@pytest.mark.parametrize("name", ["squares", "decimals", "large integers"])
def test_lines_pass_just_the_vertices_on_them(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of those that are wholly in reach, hidden ones too; by products of fractions."""
    table = EdgeTable(SCENES[name].obstacles)
    monkeypatch.setattr(table, "lit", lambda places, reach: list(range(len(table.curves))))
    several = 0
    for lines in pencils(table, 1000.0):
        for bound in {b for row in lines.rows for b in (row.first, row.last)}:
            value = lines.value(bound)
            assert isinstance(value, Real)
            if value.rational is None:
                continue
            contact, direction = (_fractions(p) for p in lines.sector.touch(value))
            on_it = {
                v
                for v, place in enumerate(table.vertices)
                if _cross(direction, _minus(_pair(place), contact)) == 0 and _pair(place) != contact
            }
            passed = {number for number, side, _ in bound.passed if side == 0}
            # Lines between sectors pass nothing by name; the first normal passes the edge's own start.
            assert passed - {v for v in passed if _pair(table.vertices[v]) == contact} == (
                on_it if passed else set()
            )
            several += len(on_it) > 1
    assert several > 20


def _fractions(point: xa.Point) -> tuple[Fraction, Fraction]:
    return _pair(point.rational)


def _pair(place: tuple[fmpq, fmpq]) -> tuple[Fraction, Fraction]:
    return Fraction(int(place[0].p), int(place[0].q)), Fraction(int(place[1].p), int(place[1].q))


def _minus(a: tuple[Fraction, Fraction], b: tuple[Fraction, Fraction]) -> tuple[Fraction, Fraction]:
    return a[0] - b[0], a[1] - b[1]


def _cross(a: tuple[Fraction, Fraction], b: tuple[Fraction, Fraction]) -> Fraction:
    return a[0] * b[1] - a[1] * b[0]


def test_coordinates_without_a_small_denominator_have_no_lattice() -> None:
    odd = [xa.Polygon([(0, 0), (1, 0), (fmpq(1, 10**9 + 7), fmpq(1, 10**13 + 37))])]
    assert EdgeTable(xa.Scene(odd).obstacles).lattice is None


def line_to(v: int, side: int = 0) -> BoundLine:
    """A line of which floats tell nothing."""
    return BoundLine(-2.0, 2.0, v, side, 0, True, None)


def test_lines_by_hand() -> None:
    """About (0, 0) with base (2, 1), t = (2 y - x) / (2 x + y): for vertices before the first and after the
    last line too, behind the contact, on one line, and beside an arc."""
    places = [(0, 0), (4, 2), (-6, -3), (2, 2), (1, -1), (10**12, 0), (3, 0), (0, 5)]
    lattice = Lattice([x for x, _ in places], [y for _, y in places])
    about = LatticeLines(lattice, TURNING, 0, (2, 1), (-1, 2), (1, 3))
    level, up, back = line_to(1), line_to(3), line_to(2)
    low, high = line_to(-1), line_to(-1)
    assert passed(about.parted([up, back, level], low, high)) == [{1, 2}, {3}]
    # t = -1/2 at (3, 0) and far along; t = 1/3 at (2, 2); -3 is before, 2 is after.
    cluster = [line_to(7), up, high, line_to(5), low, line_to(6), line_to(4), level]
    found = about.parted(cluster, low, high)
    assert passed(found) == [{5, 6}, {1}, {3}]
    assert about.parted([level, line_to(0, side=1)], low, high) == []
    # Of a joined line: where all may lie, and the value that one has.
    one, other = BoundLine(-2.0, 0.1, 1, 0, 0, True, None), BoundLine(-0.1, 2.0, 2, 0, 0, True, "0")
    (joined,) = about.parted([one, other], low, high)
    assert (joined.low, joined.high, joined.value) == (-0.1, 0.1, "0")


def test_normals_by_hand() -> None:
    """From (1, 0) to (1, 4) with t = y / 4; places at the same height are on one normal."""
    places = [(1, 0), (1, 4), (7, 1), (-3, 1), (9, 5), (9, -1), (8, 4)]
    lattice = Lattice([x for x, _ in places], [y for _, y in places])
    along = LatticeLines(lattice, SLIDING, 0, (0, 4), (0, 1), (1, 1))
    low, high = line_to(0), line_to(1)
    cluster = [line_to(4), line_to(2), high, low, line_to(5), line_to(3), line_to(6)]
    assert passed(along.parted(cluster, low, high)) == [{0}, {2, 3}, {1, 6}]


def passed(lines: list[BoundLine]) -> list[set[int]]:
    return [{number for number, *_ in line.passed} for line in lines]


FAR = 10**16
FAR_CORNERS = xa.Scene(
    [
        xa.Polygon([(0, 0), (-1, 0), (-1, -1)]),
        xa.Polygon([(FAR, 1), (FAR + 2, 2), (FAR + 1, 3)]),
        xa.Polygon([(FAR, -1), (FAR + 1, -3), (FAR + 2, -2)]),
    ]
)
"""From near the origin floats do not part the corners that are far."""


@pytest.mark.parametrize("name", ["squares", "decimals", "far corners"])
def test_directions_about_a_corner(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """By integers the events about a corner come in the order of their exact directions."""
    obstacles, reach = (FAR_CORNERS.obstacles, 2 * FAR) if name not in SCENES else (SCENES[name].obstacles, 7)
    by_integers, exact = EdgeTable(obstacles), EdgeTable(obstacles)
    vars(exact)["lattice"] = None
    asked: list[EdgeTable] = []
    by_values = RadialSweep._sorted

    def noted(self: RadialSweep, events: list[FaceEnd]) -> list[list[FaceEnd]]:
        asked.append(self.table)
        return by_values(self, events)

    monkeypatch.setattr(RadialSweep, "_sorted", noted)
    several = 0
    for e, curve in enumerate(by_integers.curves):
        own = (int(by_integers.previous[e]), e)
        groups = []
        for table in (by_integers, exact):
            sweep = RadialSweep(table, curve.start, Range(fmpq(reach)), own)
            groups.append([sorted(sweep.events(rank)) for rank in range(sweep.count)])
        assert groups[0] == groups[1]
        several += any(len(group) > 1 for group in groups[0])
    assert (several or name == "far corners") and asked.count(by_integers) < asked.count(exact)
