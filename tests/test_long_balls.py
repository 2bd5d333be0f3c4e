"""What long balls tell where floats leave something open: the order of lines and of directions, what is met
first, where a line crosses a way, and the rays of the audit that touch circles.

The scene is one of rounded coordinates: nothing on a line is exactly on it, so that floats part nothing and
all is different. What is told is compared with what exact numbers say.
"""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest
from flint import arb, fmpq
from hypothesis import assume, given
from hypothesis import strategies as st
from nightly import examples

import exactacq as xa
from exactacq.auditing.rays import clear_tangents, surely_crosses, tangent_directions
from exactacq.geometry.intersections import ContactKind, contacts
from exactacq.numbers.precision import workprec
from exactacq.numbers.real import Real
from exactacq.scene import shapes
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.complex_edges import normals
from exactacq.sensing.way_crossings import WayCrossings
from exactacq.visibility import radial_sweep, rotational_sweep
from exactacq.visibility.features import features
from exactacq.visibility.line_balls import LONG, clear_turn, crossing, event_ball, long_frame, long_vector
from exactacq.visibility.line_families import Sector
from exactacq.visibility.radial_sweep import RadialSweep
from exactacq.visibility.rotational_sweep import Pencil, pencil
from exactacq.visibility.sensor_range import Range


def rounded_rows(seed: int = 1) -> xa.Scene:
    """Plates and pins in rows, with coordinates that are off by some 10^-14."""
    rng = Random(seed)

    def off(value: str) -> Fraction:
        return Fraction(value) + Fraction(rng.randrange(-9, 10), 10**14)

    shapes: list[xa.Shape] = []
    for k in range(4):
        x, y = 500 + 3 * k, 300
        corners = [(x, y), (x + 2, y), (x + 2, y + 1), (x, y + 1)]
        shapes.append(xa.Polygon([(off(str(u)), off(str(v))) for u, v in corners]))
        shapes.append(xa.Circle((off(str(x + 1)), off(str(y + 3))), "1/2"))
        ends = [(off(str(x)), off(str(y + 5))), (off(str(x + 2)), off(str(y + 5)))]
        shapes.append(xa.Outline([(*ends[0], 0), (*ends[1], 1), (off(str(x + 2)), off(str(y + 6)), 0)]))
    return xa.Scene(shapes, start=(499, 302))


SCENE = rounded_rows()
TABLE = EdgeTable(SCENE.obstacles)
SECTORS = [(sector, feature.edges) for feature in features(TABLE) for sector in feature.sectors] + [
    (sector, (e,)) for e, curve in enumerate(TABLE.curves) for sector in normals(curve)
]


def swept(sector: Sector, own: tuple[int, ...]) -> Pencil:
    return pencil(TABLE, sector, own, 30.0)


def told(found: Pencil) -> list[tuple[int | None, int | None, object]]:
    return [(cell.behind, cell.ahead, cell.bounds) for cell in found.cells]


@pytest.mark.parametrize("number", range(len(SECTORS)))
def test_lines_are_ordered_as_exact_numbers_order_them(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    sector, own = SECTORS[number]
    found = swept(sector, own)
    for cell in found.cells:
        # Looked into, which makes them exact.
        low, high = (Real.sum([bound]) for bound in (cell.low, cell.high))
        assert low < high
    monkeypatch.setattr(rotational_sweep, "event_ball", lambda *_: None)
    assert told(swept(sector, own)) == told(found)


@pytest.mark.parametrize("number", range(0, len(SECTORS), 2))
def test_wide_balls_leave_lines_together(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A ball around many others parts none of these from it, also where they are parted among themselves."""
    sector, own = SECTORS[number]
    found, count = told(swept(sector, own)), 0

    def widened(*given: object) -> arb | None:
        nonlocal count
        count += 1
        ball = event_ball(*given)  # type: ignore[arg-type]
        return ball if ball is None or count % 3 else ball + arb(0, 1e-3)

    monkeypatch.setattr(rotational_sweep, "event_ball", widened)
    assert told(swept(sector, own)) == found


def test_long_balls_part_what_is_not_equal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the lines that floats do not part long balls leave together those that are equal."""
    groups: list[int] = []
    compared = rotational_sweep._Decisions._compared

    def counted(decisions: rotational_sweep._Decisions, group: list[object], *has: bool) -> object:
        groups.append(len(group))
        return compared(decisions, group, *has)  # type: ignore[arg-type]

    monkeypatch.setattr(rotational_sweep._Decisions, "_compared", counted)
    for sector, own in SECTORS:
        swept(sector, own)
    # Along the edges beside it a corner's first and last lines pass their other ends: these are equal.
    assert groups.count(1) > 100
    assert len(groups) - groups.count(1) < 2 * len(SECTORS)


@pytest.mark.parametrize(("bulge", "coarse"), [("1/2", True), ("0.414213562373095", False)])
def test_where_lines_that_look_the_same_are_the_same(bulge: str, coarse: bool) -> None:
    """Corners on a lattice are not enough: of a row of pads with rounded bulges floats part no tangents."""
    corners = [(1, 0, 0), (3, 0, bulge), (4, 1, 0), (4, 2, bulge), (3, 3, 0), (1, 3, bulge), (0, 2, 0)]
    row = [xa.Outline([(x + 9 * k, y, b) for x, y, b in [*corners, (0, 1, bulge)]]) for k in range(3)]
    assert EdgeTable(xa.Scene(row).obstacles).is_coarse is coarse


@examples(60)
@given(st.sampled_from(SECTORS), st.integers(0, len(TABLE.curves) - 1), st.sampled_from([-1, 1]), st.data())
def test_an_event_lies_in_its_ball(
    at: tuple[Sector, tuple[int, ...]], e: int, sign: int, data: st.DataObject
) -> None:
    sector, _ = at
    curve = TABLE.curves[e]
    side = data.draw(st.sampled_from([-1, 1])) if isinstance(curve, xa.Arc) else 0
    circle = rotational_sweep.target(TABLE, e, side)
    exact = sector.exact(*circle, side, sign)
    with workprec(LONG):
        ball = event_ball(sector, long_frame(sector), circle, side, sign)
    if exact is not None and ball is not None:
        assert ball.overlaps(exact.ball(2 * LONG))
        # Beyond the sector a parameter may be huge, and circles that nearly touch cost half of the digits.
        assert ball.rad() < 1e-50 * (1 + ball.mid() ** 2)


# -- directions and faces ----------------------------------------------------------------------------


def places() -> list[xa.Point]:
    row = [xa.Point(f"{499 + k}.5", 302) for k in range(12)]
    irrational = xa.Point(499, Real(2).sqrt() / 1000 + 301)
    # Along what was a line before coordinates were rounded.
    along = [xa.Point(x, y) for x in (450, 499, "502.5", 520) for y in (300, 301, 305)]
    return [*row, irrational, *along, TABLE.curves[0].start]


@pytest.mark.parametrize("k", range(26))
def test_views_are_as_exact_numbers_tell_them(k: int, monkeypatch: pytest.MonkeyPatch) -> None:
    place = places()[k]

    def view() -> list[tuple[object, ...]]:
        sweep = RadialSweep(TABLE, place, Range(fmpq(80)), None)
        firsts = [sweep.edge(f) if f >= 0 else f for f in sweep.first]
        return [*zip(firsts, ([*map(int, sweep.events(rank))] for rank in range(sweep.count)), strict=False)]

    found = view()
    monkeypatch.setattr(radial_sweep, "clear_turn", lambda *_: 0)
    monkeypatch.setattr(RadialSweep, "_clearly_nearest", lambda *_: None)
    assert view() == found


@examples(60)
@given(*[st.integers(-3, 3)] * 4)
def test_turns(ax: int, ay: int, bx: int, by: int) -> None:
    """Long balls tell the order of directions but for those along the east or west, and equal ones."""
    a, b = (long_vector((Real(2).sqrt() * x, Real(2).sqrt() * y)) for x, y in ((ax, ay), (bx, by)))
    turn, open_ = ax * by - ay * bx, not (ay and by)
    expected = 0 if open_ else (1 if ay > 0 else -1) if (ay > 0) != (by > 0) else (turn > 0) - (turn < 0)
    assert clear_turn(a, b) == expected


# -- crossings ---------------------------------------------------------------------------------------


@examples(80)
@given(*[st.fractions(-3, 3, max_denominator=4)] * 8)
def test_crossings(
    x: Fraction,
    y: Fraction,
    dx: Fraction,
    dy: Fraction,
    ax: Fraction,
    ay: Fraction,
    bx: Fraction,
    by: Fraction,
) -> None:
    """By fractions: a x + b y of the line is above or below it at the ends of the segment."""

    def ball(*values: Fraction) -> tuple[arb, ...]:
        return tuple(arb(fmpq(v.numerator, v.denominator)) for v in values)

    with workprec(LONG):
        found = crossing(ball(x, y, dx, dy), ball(ax, ay), ball(bx, by))  # type: ignore[arg-type]
    one, other = (dx * (v - y) - dy * (u - x) for u, v in ((ax, ay), (bx, by)))
    if one == 0 or other == 0:
        assert found is None
    elif (one > 0) == (other > 0):
        assert found == []
    else:
        share = one / (one - other)
        at = ax + share * (bx - ax) - x, ay + share * (by - ay) - y
        tau = (at[0] * dx + at[1] * dy) / (dx * dx + dy * dy)
        assert found is not None
        ((place, sense),) = found
        with workprec(LONG):
            assert (place * tau.denominator - tau.numerator).contains(0)
        # The segment's left is entered where its start lies to the left of the line.
        assert sense == (1 if one > 0 else -1)


def test_ways_are_crossed_as_exact_numbers_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    def run() -> list[tuple[object, ...]]:
        found = xa.sightseer(SCENE, 8)
        return [(event.kind, event.obstacle, event.at) for event in found.events]

    events, asked = run(), 0
    clear = WayCrossings._clear_role

    def told_nothing(*given: object) -> tuple[bool, None]:
        nonlocal asked
        asked += clear(*given)[0]  # type: ignore[arg-type]
        return False, None

    monkeypatch.setattr(WayCrossings, "_clear_role", told_nothing)
    assert run() == events
    assert asked > 50


# -- the audit's rays --------------------------------------------------------------------------------


def circle(x: str, y: str, radius_sq: str) -> xa.Arc:
    center = xa.Point(x, y)
    start = xa.Point(center.x + Real(radius_sq).sqrt(), center.y)
    return xa.Arc(
        start,
        start,
        center,
        fmpq(radius_sq) if "/" not in radius_sq else fmpq(*map(int, radius_sq.split("/"))),
        ccw=True,
        full=True,
    )


@pytest.mark.parametrize("place", [("0", "0"), ("7", "1/3"), ("3", "20"), ("4000001/1000000", "2")])
def test_the_rays_that_touch_a_circle(place: tuple[str, str]) -> None:
    q, round_ = xa.Point(*place), circle("3", "2", "1")
    rays, exact = clear_tangents(q, round_, 0.5), tangent_directions(q, round_)
    assert rays is not None and len(rays) == len(exact) == 2
    for ray, direction in zip(rays, exact, strict=True):
        length = direction.norm_sq().sqrt()
        for unit, component in zip(ray.unit, direction, strict=True):
            assert abs(component / length - Real(unit)) < fmpq(1, 2**50)
        assert ray.exact() == direction and ray.far == 0.5


def test_rays_that_balls_leave_open() -> None:
    """From inside there are none; from the circle itself, and along an axis, exact numbers decide."""
    round_ = circle("3", "2", "1")
    assert clear_tangents(xa.Point(3, "5/2"), round_, 0.0) == []
    assert clear_tangents(xa.Point(4, 2), round_, 0.0) is None
    assert clear_tangents(xa.Point(7, 1), round_, 0.0) is None


@examples(300)
@given(
    st.sampled_from([fmpq(k, 4) for k in (-4, -3, 0, 1, 4)]),
    *(st.integers(-4, 4) for _ in range(6)),
    st.sampled_from([fmpq(0), fmpq(1, 10**30), fmpq(1, 3)]),
)
def test_balls_tell_crossings_that_exact_numbers_tell(
    bulge: fmpq, x: int, y: int, dx: int, dy: int, ux: int, uy: int, off: fmpq
) -> None:
    """All that cross an edge, between the ends of both, are told; none that touch it, or are beside it."""
    assume((dx or dy) and (ux or uy))
    edge = shapes.edge(xa.Point(x + off, y), xa.Point(x + off + ux, y + uy), bulge)
    origin, way = xa.Point(0, 0), xa.Point(dx, dy)
    kinds = [contact.kind for contact in contacts(xa.Segment(origin, way), edge)]
    assert surely_crosses(origin, way, Real(1), edge) is (ContactKind.CROSSING in kinds)
