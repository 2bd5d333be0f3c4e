"""The kernel: its bounds hold; compiled, uncompiled and by exact arithmetic alone results are the same."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from fractions import Fraction
from math import inf, isfinite
from pathlib import Path
from random import Random

import pytest
from flint import fmpq
from hypothesis import given
from hypothesis import strategies as st
from nightly import examples, some

import exactacq as xa
from exactacq import kernel
from exactacq.files.octagons import random_octagons
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Point
from exactacq.kernel import bounded
from exactacq.kernel.crossings import VAGUE, EdgeStates
from exactacq.kernel.images import EdgeImage
from exactacq.kernel.line_events import line_events
from exactacq.kernel.near_edges import NearEdges
from exactacq.kernel.surroundings import FrameLine, Surroundings
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable, with_rests
from exactacq.sensing.complex_edges import normals
from exactacq.visibility.features import features
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes, Turning
from exactacq.visibility.rotational_sweep import Pencil, pencil

FOLDER = Path(kernel.__file__).parent
ROOT = FOLDER.parent.parent

# -- the rules ---------------------------------------------------------------------------------

SIZES = st.builds(
    lambda m, e: m * 2.0**e,
    st.floats(-1, 1, allow_nan=False),
    st.one_of(st.integers(-40, 40), st.integers(-1070, 1000), st.sampled_from([-537, -512, -450, 0, 511])),
)
"""Floats of every size: small and large, such that products underflow and overflow."""
SHARES = st.fractions(-1, 1, max_denominator=64)


@st.composite
def numbers(draw: st.DrawFn) -> tuple[float, float, Fraction]:
    """A float, a bound, and a number that they hold."""
    m = draw(SIZES)
    e = draw(
        st.one_of(st.just(0.0), SIZES.map(abs), st.floats(0, 1).map(lambda share: abs(m) * share * 1e-12))
    )
    return m, e, Fraction(m) + Fraction(e) * draw(SHARES)


def holds(m: float, e: float, exact: Fraction) -> bool:
    return not isfinite(e) or not isfinite(m) or abs(Fraction(m) - exact) <= Fraction(e)


@given(numbers(), numbers())
@examples(120, 400)
def test_sums_products_and_quotients_are_held(x: tuple, y: tuple) -> None:
    (a, p, u), (b, q, v) = x, y
    assert holds(*bounded.total(a, p, b, q), u + v)
    assert holds(*bounded.product(a, p, b, q), u * v)
    m, e = bounded.quotient(a, p, b, q)
    assert e == inf or holds(m, e, u / v)


@given(numbers())
@examples(120, 400)
def test_square_roots_are_held(x: tuple) -> None:
    a, p, u = x
    if u >= 0:
        m, e = bounded.root(a, p)
        assert e == inf or (max(Fraction(m) - Fraction(e), 0) ** 2 <= u <= (Fraction(m) + Fraction(e)) ** 2)


@given(*[st.tuples(SIZES, SIZES, SIZES.map(abs), SHARES, SHARES) for _ in range(2)])
@examples(120, 400)
def test_products_of_vectors_are_held(x: tuple, y: tuple) -> None:
    (ax, ay, p, s, t), (bx, by, q, u, v) = x, y
    cx, cy, dx, dy = (
        Fraction(c) + Fraction(e) * w for c, e, w in ((ax, p, s), (ay, p, t), (bx, q, u), (by, q, v))
    )
    assert holds(*bounded.cross(ax, ay, p, bx, by, q), cx * dy - cy * dx)
    assert holds(*bounded.dot(ax, ay, p, bx, by, q), cx * dx + cy * dy)


def test_what_is_no_number_decides_nothing() -> None:
    for m, e in ((float("nan"), 0.0), (1.0, float("nan")), (inf, inf), (1.0, inf), (0.0, 0.0), (1.0, 1.0)):
        assert bounded.verdict(m, e) == 0
    assert (bounded.verdict(2.0, 1.0), bounded.verdict(-2.0, 1.0)) == (1, -1)
    huge = bounded.product(1e300, 0.0, 1e300, 0.0)
    assert bounded.verdict(*huge) == bounded.verdict(*bounded.total(*huge, -huge[0], huge[1])) == 0


# -- families of lines -------------------------------------------------------------------------

GAPS = (fmpq(1), fmpq(1, 10**3), fmpq(1, 10**9), fmpq(1, 10**17), fmpq(1, 10**30), fmpq(1, 10**60))
SCALES = (fmpq(1), fmpq(10**6), fmpq(10**9), fmpq(1, 10**6), fmpq(10**30))


class Hostile:
    """Places, sectors and edges that try to break the bounds."""

    def __init__(self, seed: int) -> None:
        self.rng = Random(seed)
        self.far = self.rng.choice((fmpq(0), fmpq(10**6), fmpq(10**9) / 7, fmpq(10**15) / 3))
        self.scale = self.rng.choice(SCALES) if not self.far else fmpq(1)

    def number(self) -> fmpq:
        rng = self.rng
        whole = fmpq(rng.randint(-30, 30), rng.choice((1, 1, 2, 3, 7, 100)))
        return (whole + rng.choice((-1, 0, 0, 1)) * rng.choice(GAPS)) * self.scale

    def pair(self) -> tuple[fmpq, fmpq]:
        return self.number(), self.number()

    def place(self) -> tuple[fmpq, fmpq]:
        x, y = self.pair()
        return x + self.far, y - self.far

    def sector(self, kind: int) -> Sector:
        center, base = self.place(), self.pair()
        while base == (0, 0):
            base = self.pair()
        one = fmpq(1)
        if kind == 0:
            return Turning(center, base, -one, one)
        if kind == 1:
            return Rolling(center, base, fmpq(0), one)
        if kind == 2:
            return Sliding(center, base, fmpq(0), one, leftward=self.rng.random() < 0.5)
        return Spokes(center, base, -one, one, radius_sq=self.size_sq(), outward=self.rng.random() < 0.5)

    def size_sq(self) -> fmpq:
        x, y = self.pair()
        return (x * x + y * y + self.scale * self.scale / 10**6) * self.rng.choice((1, 1, 2, 10**12))

    def near(self, sector: Sector) -> tuple[fmpq, fmpq]:
        """A point: anywhere, hardly off a line of the family, or hardly off its centre or circle."""
        rng = self.rng
        (x, y), (ex, ey) = sector.center, sector.base
        gap = rng.choice(GAPS) * rng.choice((-1, 0, 1)) * self.scale
        t = fmpq(rng.randint(-8, 8), 8)
        way = rng.randrange(4)
        if way == 0:
            return self.place()
        if way == 1:
            s = fmpq(rng.randint(-12, 12), 4)
            return x + s * (ex - t * ey) + gap, y + s * (ey + t * ex)
        if way == 2:
            return x + gap, y + gap * t
        cosine, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
        return x + cosine * ex - sine * ey + gap, y + cosine * ey + sine * ex

    def edges(self, sector: Sector) -> list[Curve]:
        """Segments, short and long, and arcs, shallow and deep, also of huge radii."""
        found: list[Curve] = []
        while len(found) < 6:
            a, b = self.near(sector), self.near(sector)
            if a == b:
                continue
            bulge = fmpq(self.rng.choice((0, 0, 1, -1, 1, -1))) / self.rng.choice((1, 2, 3, 10**4, 10**9))
            found.append(
                Arc.from_bulge(Point(*a), Point(*b), bulge) if bulge else Segment(Point(*a), Point(*b))
            )
        return found


def images_of(curves: list[Curve]) -> list[EdgeImage]:
    """The images of edges without neighbours, whose ends have later numbers than all starts."""
    ends = [c.start.rational for c in curves] + [c.end.rational for c in curves]
    found, n = [], len(curves)
    for k, point in enumerate(ends):
        curve = curves[k % n]
        is_arc = isinstance(curve, Arc)
        center = with_rests(curve.center.rational if is_arc else (fmpq(0), fmpq(0)))
        kind = 0 if not is_arc else 1 if curve.ccw else -1
        radius = float(curve.radius) if is_arc else 0.0
        found.append(EdgeImage(with_rests(point), center, radius, kind, False, (n + k) % (2 * n), -1))
    return found


def solutions(sector: Sector, side: int) -> list[tuple[int, int]]:
    """Sides and signs of the events of points (0) and circles (1)."""
    if isinstance(sector, Rolling):
        return [(s, sign) for s in ((1, -1) if side else (0,)) for sign in (1, -1)]
    return [(1, 1), (1, -1)] if side else [(0, 0)]


@given(st.lists(st.integers(1, 5), min_size=1, max_size=4), st.data())
def test_edges_that_are_near_know_their_ends(sizes: list[int], data: st.DataObject) -> None:
    """Some edges of closed boundaries with so many edges, in their order or not."""
    following = [
        first + (k + 1) % n for first, n in zip(accumulated(sizes), sizes, strict=True) for k in range(n)
    ]
    kinds = data.draw(st.lists(st.sampled_from([0, 1, -1]), min_size=len(following), max_size=len(following)))
    zero = 0.0, 0.0, 0.0, 0.0
    images = [
        EdgeImage(zero, zero, 0.0, kind, False, v, -1) for kind, v in zip(kinds, following, strict=True)
    ]
    edges = data.draw(st.lists(st.sampled_from(range(len(following))), unique=True))
    near = NearEdges(images, edges)
    assert [near.vertices[j] for j in range(len(edges))] == edges
    assert [near.vertices[k] for k in near.last] == [following[e] for e in edges]
    assert len(set(near.vertices)) == len(near.vertices)
    assert [edges[j] for j in near.arcs] == [e for e in edges if kinds[e]]
    assert [near.arcs[k] for k in near.middle if k >= 0] == near.arcs
    for e in range(len(following)):
        assert near.edge(e) == (edges.index(e) if e in edges else -1)
        assert near.has_vertex(e) == (e in near.vertices)


def accumulated(sizes: list[int]) -> list[int]:
    """Where each of some groups of these sizes begins."""
    return [sum(sizes[:k]) for k in range(len(sizes))]


@pytest.mark.parametrize("seed", some(range(150), 50))
def test_events_lie_in_their_intervals(seed: int) -> None:
    """Every event in the sector is found, and each that is certain lies where it is said to."""
    hostile = Hostile(seed)
    sector = hostile.sector(seed % 4)
    curves = hostile.edges(sector)
    images = images_of(curves)
    around = Surroundings(NearEdges(images, list(range(len(curves)))), sector.frame(), ())
    low, high = float(sector.low), float(sector.high)
    found = {(one.number, one.side, one.sign): one for one in line_events(around, -1, low, high)}
    vertices = [c.start.rational for c in curves] + [c.end.rational for c in curves]
    targets = [(k, 0, point, fmpq(0)) for k, point in enumerate(vertices)]
    targets += [
        (k, 1, c.center.rational, c.radius_sq) for k, c in enumerate(curves) if isinstance(c, Arc) and c.ccw
    ]
    for number, round_, center, square in targets:
        for side, sign in solutions(sector, round_):
            value = sector.exact(center, square, side, sign)
            event = found.get((number, side, sign))
            if event is None:
                assert value is None or value < sector.low or value > sector.high
                continue
            first, last = event.low, event.high
            assert not event.is_sure or value is not None
            if value is not None and isfinite(first):
                assert fmpq(*first.as_integer_ratio()) <= value <= fmpq(*last.as_integer_ratio())


def exact_crossings(sector: Sector, t: fmpq, curve: Curve) -> list[Real]:
    contact, direction = sector.touch(Real(t))
    return sorted(line_contacts(contact, direction, curve))


@pytest.mark.parametrize("seed", some(range(150), 50))
def test_crossings_are_where_they_are_said_to_be(seed: int) -> None:
    """Certain states are those of exact crossings, and the places' intervals contain these."""
    hostile = Hostile(seed)
    sector = hostile.sector(seed % 4)
    curves = hostile.edges(sector)
    around = Surroundings(NearEdges(images_of(curves), list(range(len(curves)))), sector.frame(), ())
    states = EdgeStates(around)
    t = fmpq(hostile.rng.randint(0, 256), 256)
    line = FrameLine(around, float(t), 0.0)
    factor = length_of_direction(sector, t)
    for j, (curve, state) in enumerate(zip(curves, states.look_at_all(line), strict=True)):
        assert state == states.look(j, line)
        if state == VAGUE:
            continue
        exact = exact_crossings(sector, t, curve)
        assert len(exact) == (state & 1) + (state >> 1)
        states.state[j] = state
        low, high = states.span(j)
        for which, value in zip([w for w in (2, 1) if state & w], exact, strict=True):
            m, e = states.place(j, which, line)
            from_center = value * factor + center_of(sector, t) * factor
            assert low == -inf or Real(low) <= from_center
            assert high == inf or from_center <= Real(high)
            if e < inf:
                place = value * factor
                assert Real(m) - Real(e) <= place <= Real(m) + Real(e)


def center_of(sector: Sector, t: fmpq) -> Real:
    """Where on a normal of an arc its centre lies, seen back from the contact; else 0."""
    if not isinstance(sector, Spokes):
        return Real(0)
    contact, direction = sector.touch(Real(t))
    return (contact - Point(*sector.center)).dot(direction) / direction.norm_sq()


def length_of_direction(sector: Sector, t: fmpq) -> Real:
    """What one of the direction's lengths is in the frame, where the directions are shorter or longer."""
    frame = sector.frame()
    (ex, ey), unit = sector.base, fmpq(*frame.unit.as_integer_ratio())
    square = ex * ex + ey * ey
    if isinstance(sector, (Turning, Spokes)):
        # e + t e' is (K, t K) in the frame, with K = |e|^2 / unit, and (1, t) there.
        return Real(square / unit)
    # |d| = |e| in the plane, larger by |e| / unit in the frame, and 1 there.
    return Real(square / unit)


# -- both ways, and neither --------------------------------------------------------------------


def all_pencils(scene: xa.Scene, reach: float) -> list[Pencil]:
    table = EdgeTable(scene.obstacles)
    found = [pencil(table, s, f.edges, reach) for f in features(table) for s in f.sectors]
    return found + [
        pencil(table, s, (e,), reach) for e, curve in enumerate(table.curves) for s in normals(curve)
    ]


def told(sweep: Pencil) -> list[object]:
    cells: list[object] = [
        (str(c.low), str(c.high), c.behind, c.ahead, *map(sorted, c.bounds)) for c in sweep.cells
    ]
    return [*cells, [(str(t), sorted(passed)) for t, passed in sweep.pinches]]


@pytest.mark.parametrize("name", ["figure1", "circles", "m8", "m11", "plate"])
def test_exact_arithmetic_alone_gives_the_same(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """With every verdict unsure only the time differs."""
    scene = xa.load(name)
    usual = [told(sweep) for sweep in all_pencils(scene, 4.0)]
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    assert [told(sweep) for sweep in all_pencils(scene, 4.0)] == usual


def test_a_lone_event_is_not_made_exact() -> None:
    late = [
        bound.is_late
        for sweep in all_pencils(random_octagons(8, 1), 10.0)
        for cell in sweep.cells
        for bound in (cell.low, cell.high)
    ]
    assert sum(late) > len(late) / 3


def test_neighbouring_cells_share_a_bound() -> None:
    for sweep in all_pencils(random_octagons(4, 1), 10.0):
        assert all(a.high is b.low for a, b in zip(sweep.cells, sweep.cells[1:], strict=False))


SCRIPT = """
from fractions import Fraction as Q
from hashlib import sha256
import exactacq as xa
from exactacq import kernel
from exactacq.files.octagons import random_octagons
from exactacq.kernel.first_edges import first_edges
from exactacq.kernel.line_events import line_events
from exactacq.kernel.near_edges import NearEdges
from exactacq.kernel.radial_faces import RadialFaces
from exactacq.kernel.radial_sweep import FaceSweep
from exactacq.kernel.single_rays import met as met_on
from exactacq.kernel.surroundings import Surroundings
from exactacq.kernel.view_parts import ViewParts
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.complex_edges import normals
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.visibility.features import features
from exactacq.visibility.sensor_range import Range
total = sha256()
for scene in (random_octagons(12, 3), xa.load("circles"), xa.load("plate"), xa.load("figure2")):
    table = EdgeTable(scene.obstacles)
    families = [(s, f.edges) for f in features(table) for s in f.sectors]
    families += [(s, (e,)) for e, curve in enumerate(table.curves) for s in normals(curve)]
    every = list(range(len(table.curves)))
    near = NearEdges(table.images, every)
    for sector, own in families:
        around = Surroundings(near, sector.frame(), own)
        events = line_events(around, -1, float(sector.low), float(sector.high))
        told = [(e.low, e.high, e.number, e.side, e.sign, e.is_sure) for e in events]
        total.update(repr(told).encode())
        ends = sorted(e[:2] for e in told)
        middles = [0.5 * (a[1] + b[0]) for a, b in zip(ends, ends[1:]) if a[1] < b[0]]
        met = first_edges(around, middles, [0.0] * len(middles), events, True)
        total.update(repr((middles, met)).encode())
    complex_ = VisibilityComplex(table, Range(xa.Real(10).rational))
    for one in (one for e in every for one in complex_.extents(e)):
        spans = one.edge, one.shown, one.source, one.surely, one.told, one.here, one.there, one.is_known
        total.update(repr((spans, one.first_keys, one.last_keys)).encode())
    for obstacle in scene.obstacles:
        for place in ((e.start + e.end) / 2 + e.start * Q(1, 97) for e in obstacle.edges[:4]):
            faces = RadialFaces(table.images, (place.xy[0], 0.0, place.xy[1], 0.0, 0.0), (100.0, 0.0))
            faces.add_straight(every)
            for n, e in enumerate(faces.arcs(every)):
                faces.add_event(10**6 + n, *faces.tangent(e, 1))
            sweep = FaceSweep(faces)
            east = [event.number for event in sweep.look_up()]
            told = [(event.number, event.least, event.most) for event in faces.events]
            total.update(repr((east, told)).encode())
            sweep.order()
            for at, events in reversed(sweep.open):
                sweep.part(at, [events])
            sweep.rank()
            sweep.look(-1, -1)
            parts = ViewParts(sweep, sweep.sights(), 10**7, [])
            ranks = [[event.number for event in sweep.events(k)] for k in range(len(sweep.leads))]
            sights = [(s.face, s.low, s.high, s.start, s.end, parts.within(s)) for s in parts.sights]
            pieces = [(p.edge, p.start, p.end, p.near) for p in parts.outline([])]
            total.update(repr((ranks, sweep.first, sights, pieces)).encode())
            brackets = [parts.bracket(parts.base + n) for n in range(len(parts.made))]
            rays = [met_on(sweep, rank, [], 10**6) for rank in range(len(sweep.leads))]
            total.update(repr((brackets, rays)).encode())
print(kernel.DESCRIPTION, total.hexdigest())
"""


def asked(way: str, script: str = SCRIPT, path: Path = ROOT) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(path), kernel.SWITCH: way}
    return subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=False, cwd=path
    )


@pytest.mark.skipif(
    not (FOLDER / "compiled" / kernel.RECORD).exists(), reason="no compiler when the package was installed"
)
def test_compiled_or_not_the_floats_are_the_same() -> None:
    (*words, python), (*others, compiled) = (asked(way).stdout.split() for way in ("python", "compiled"))
    assert (words, others) == (["kernel", "in", "Python"], ["compiled", "kernel"])
    assert python == compiled


IMPORT = "from exactacq import kernel; print(kernel.DESCRIPTION, kernel.COMPILED)"


def test_it_is_told_without_an_import_of_its_own() -> None:
    told = asked(os.environ.get(kernel.SWITCH, ""), "import exactacq as xa; print(xa.kernel.DESCRIPTION)")
    assert told.stdout == f"{kernel.DESCRIPTION}\n"


def test_the_switch(tmp_path: Path) -> None:
    """Without compiled forms, with forms of other sources, and with forms of these sources."""
    copy = tmp_path / "exactacq" / "kernel"
    shutil.copytree(FOLDER, copy, ignore=shutil.ignore_patterns("compiled", "__pycache__"))
    (tmp_path / "exactacq" / "__init__.py").touch()
    answers = {way: asked(way, IMPORT, tmp_path) for way in ("", "python", "compiled", "fast")}
    assert answers[""].stdout == answers["python"].stdout == "kernel in Python False\n"
    last = answers["compiled"].stderr.splitlines()[-1]
    assert last.startswith("ImportError: EXACTACQ_KERNEL=compiled, but exactacq.kernel was not compiled")
    assert "must be 'python', 'compiled' or unset, not 'fast'" in answers["fast"].stderr
    (copy / "compiled").mkdir()
    (copy / "compiled" / kernel.RECORD).write_text(kernel.digest(copy), encoding="ascii")
    assert asked("", IMPORT, tmp_path).stdout == "compiled kernel True\n"
    with (copy / "bounded.py").open("a", encoding="utf-8") as file:
        file.write("\nCHANGED = True\n")
    assert asked("", IMPORT, tmp_path).stdout == "kernel in Python False\n"
    assert "was edited since it was compiled" in asked("compiled", IMPORT, tmp_path).stderr


def test_a_command_line_says_what_is_wrong_in_one_line() -> None:
    script = "import sys; from exactacq.cli import main; sys.exit(main(['--version']))"
    done = asked("fast", script)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "exactacq: EXACTACQ_KERNEL must be 'python', 'compiled' or unset, not 'fast'\n"


def test_constants_are_what_they_are_called() -> None:
    assert (bounded.UNIT, bounded.WIDEN, bounded.TINY) == (2.0**-52, 1 + 2.0**-47, 2.0**-900)


DEEP = """
from exactacq.kernel.box_tree import box_tree
for depth in range(30, 80):
    for _ in range(20):
        held = box_tree([(0.0, 0.0, 1.0, 1.0)])
        for _ in range(depth):
            held = [held]
        del held
"""


def test_records_are_freed_however_deep_they_are_held() -> None:
    """Python puts off what is more than 50 levels deep, by a field that records without a search lacked."""
    environment = {**os.environ, "PYTHONMALLOC": "debug"}
    done = subprocess.run([sys.executable, "-c", DEEP], env=environment, check=False, capture_output=True)
    assert done.returncode == 0, done.stderr[:400].decode()
