"""Explained cases: places of a run that are one, found in several ways, as symmetric drawings have them.

When an obstacle becomes wholly known is decided among places at which some view begins or ends. Some of them
are one place under two expressions, which no bound on heights can prove in reasonable time: drawings of laser
parts ended in `Undecided` for ties that had nothing to do with the moment. Only the places near it count.
"""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from flint import fmpq
from nightly import some

import exactacq as xa
from exactacq.geometry.curve_parameter import Rail
from exactacq.numbers import sign
from exactacq.numbers.rationals import rational
from exactacq.sensing import line_points
from exactacq.study.random_scenes import Subject, arc_scene, random_scene

NEAR = 1e-9
DATA = Path(__file__).parent / "data" / "undecided"
WALKED = {5: "656.353119540", 14: "656.353119540", 20: "656.353119540", 30: "656.897193", 100: "656.897193"}
"""The laser plate's path by the radius, as the runs that never were in doubt (5, 10 and 12) walk it."""


@pytest.mark.parametrize("radius", some(WALKED, 2))
def test_a_symmetric_plate_of_laser_parts(radius: int) -> None:
    scene = xa.load(DATA / "example009.dxf", layers=["plate"], start=(-19, 19))
    run = xa.sightseer(scene, radius)
    assert run.length.decimal(12).startswith(WALKED[radius]) and run.complete
    xa.audit(run, samples=16)


@pytest.mark.parametrize("name", ["arcs-1371", "arcs-3029", "arcs-3358"])
def test_bulged_arcs_about_a_start(name: str) -> None:
    run = xa.sightseer(xa.load(DATA / f"{name}.json"))
    assert run.complete
    xa.audit(run, samples=32)


@pytest.mark.parametrize("seed", [426, 748, 1346, 1973, 4001])
def test_a_known_end_that_is_found_again_at_an_event(seed: int) -> None:
    """An end of what is known, and the same end seen from the place of the event that it caused.

    The expressions of both are made of up to five radicals, nested, and of inverses of their sums. The fields
    of the numbers have degree 4 all the same, or 2 over the field of a root: the other radicals are in the
    field that these make, for a line through a known point of a circle meets it there.
    """
    xa.audit(xa.sightseer(arc_scene(Subject.SIGHTSEER, seed)), samples=4)


def test_a_line_of_the_sweep_that_touches_a_circle() -> None:
    """Whether an obstacle is seen again: from (6, 4) it is as far as the range, along the line itself."""
    run = xa.seed_spreader(arc_scene(Subject.SEED_SPREADER, 229))
    assert run.complete
    xa.audit(run, samples=4)


def test_a_map_where_a_view_becomes_as_long_as_the_range() -> None:
    """From the event's place a tangent of a slot's end just reaches another one, at distance R.

    The view from there made that point anew, with a root of degree 6 below others, and was `Undecided`: the
    family of views that ends there knows its length by its name.
    """
    corners = [(-2, 8), (5, 8), (-2, 11), (5, 11), (5, 17), (12, 17)]
    slots = [xa.Outline([(x, y), (x + 4, y, 1), (x + 4, y + 2), (x, y + 2, 1)]) for x, y in corners]
    run = xa.seed_spreader(xa.Scene(slots, terrain=xa.Terrain("61/2", 30, (-3, -2)), radius=14))
    at_range = [event for event in run.events if event.kind in ("regain", "lose") and event.obstacle == 5]
    assert len(at_range) > 1
    for event in at_range:
        chart = run.map_at(event)
        assert sum(float(chart.known_length(k)) for k in range(len(slots))) > 0


def test_the_map_where_an_obstacle_is_acquired_has_all_of_it() -> None:
    """What is known from both sides meets there, in two forms of one nested number: once `Undecided`."""
    run = xa.seed_spreader(random_scene(Subject.SEED_SPREADER, 60000067))
    acquired = [event for event in run.events if event.kind == "acquire"]
    assert len(acquired) > 2
    for event in acquired:
        chart = run.map_at(event)
        assert event.obstacle not in chart.incomplete
        assert chart.known_length(event.obstacle) == run.obstacles[event.obstacle].perimeter


@pytest.mark.parametrize("seed", [61000367, 61000691])
def test_the_view_is_told_whatever_edge_is_asked_for_first(seed: int) -> None:
    """An edge out of reach came first: the view was made before it was told of its ends at the range."""
    run = xa.seed_spreader(random_scene(Subject.SEED_SPREADER, seed))
    for event in run.events:
        if event.kind == "lose" and event.note == "range":
            assert all(run.map_at(event).known(k) is not None for k in range(len(run.obstacles)))


def test_a_diversion_around_a_wall_to_an_end_of_what_is_known() -> None:
    """The end was seen from where a view became as long as the range: on its arc by name, and not by numbers.

    Whether the way there meets that arc first elsewhere, and a wall on its way, was `Undecided`.
    """
    run = xa.seed_spreader(random_scene(Subject.SEED_SPREADER, 2000031))
    assert run.complete and run.diversions


def test_a_diversion_between_two_roots_of_quartics() -> None:
    """It begins where a view became as long as the range, and ends where another one did, on an edge.

    That its last view is from its end, along the edge, was `Undecided`, for numbers of two roots.
    """
    assert xa.seed_spreader(random_scene(Subject.SEED_SPREADER, 96000186)).complete


def past_a_circle(seed: int) -> xa.Scene:
    """Two circles whose shortest link touches a third one, and something that comes into sight along it."""
    rng = Random(seed)

    def near(value: fmpq) -> fmpq:
        return value + fmpq(rng.randint(-8, 8), 16)

    x, y = near(fmpq(-9, 2)), near(fmpq(-5, 2))
    plate = [(-2, -2), (2, -2), (2, 1), (1, 1, fmpq(-1, 2)), (-1, 1), (-2, 1)]
    shape = rng.choice(
        [
            xa.Outline([(x - 1, y, 1), (x + 1, y, fmpq(-1, 2))]),
            xa.Outline([(x + u, y + v, *bulge) for u, v, *bulge in plate]),
            xa.Polygon([(x - 1, y - 1), (x + 1, y - 1), (x, y + 1)]),
        ]
    )
    circles = [
        xa.Circle((near(fmpq(9, 2)), near(fmpq(5, 2))), 1),
        xa.Circle((near(fmpq(19, 2)), near(fmpq(19, 2))), fmpq(1, 2)),
        xa.Circle((near(fmpq(25, 4)), near(fmpq(4))), fmpq(rng.randint(14, 20), 16)),
    ]
    return xa.Scene([*circles, shape], start=(5, 5), radius=11)


@pytest.mark.parametrize("first", some(range(0, 60, 6), 3))
def test_ways_that_touch_a_circle_between(first: int) -> None:
    """Where such a way is as far from a corner as the range was found along tangents and along normals.

    The way's numbers are those of a root of degree 20, and no comparison of the two places came to an end: a
    quarter of these runs was `Undecided`. What families have in common at the range is one point now. And
    from places of the way one of the two tangents of the circle is the way itself, which need not be told.
    """
    done = 0
    for seed in range(first, first + 6):
        try:
            run = xa.sightseer(past_a_circle(seed))
        except xa.InvalidScene:
            continue
        assert run.complete
        xa.audit(run, samples=4)
        done += 1
    assert done > 1


@pytest.mark.parametrize("seed", some([1, 2, 3, *range(4, 30)], 3))
def test_the_cells_of_a_way_that_touches_a_circle_between(seed: int) -> None:
    """What is seen along the way and from its ends meets in the circle, and where the way ends.

    Nine of twenty maps were `Undecided`: the circle's tangent from an end of the way, where the way's line
    touches the circle, and where tangents and normals of the circle cross it are one point, in five forms.
    """
    try:
        run = xa.sightseer(past_a_circle(seed))
    except xa.InvalidScene:
        return
    for piece in run.path:
        if piece.obstacle is None:
            for cell in xa.sweep(run.scene, piece.curve, run.radius).cells:
                assert cell.map.known_length() > 0


def spans(rail: Rail, start: xa.Point, end: xa.Point) -> list[tuple[float, float]]:
    """A piece of an edge in parameters, rounded; in two if it passes the start of a full circle."""
    low, high = (rail.parameter(place).rough() for place in (start, end))
    if not rail.is_closed or low < high or start is end:
        return [(low, high)]
    return [(low, 4.0)] if high == 0 else [(low, 4.0), (0.0, high)]


@pytest.mark.parametrize("seed", some([0, 3, *range(4, 30)], 2))
def test_the_cells_of_a_way_that_touches_a_circle_know_what_isovists_see(seed: int) -> None:
    """Points that are taken for one are one: else a map lacks a part of what is seen from inside its cell."""
    try:
        run = xa.sightseer(past_a_circle(seed))
    except xa.InvalidScene:
        return
    compared = 0
    for piece in (piece for piece in run.path if piece.obstacle is None):
        for cell in xa.sweep(run.scene, piece.curve, run.radius).cells:
            middle = fmpq(*((float(cell.low) + float(cell.high)) / 2).as_integer_ratio())
            view = xa.isovist(run.scene, cell.point(middle), run.radius).seen()
            for (k, e), seen in view.items():
                rail = Rail(run.scene.obstacles[k].edges[e])
                parts = [part for part in cell.map.known(k) if part.edge == e]
                known = [span for part in parts for span in spans(rail, part.start, part.end)]
                for low, high in (span for ends in seen for span in spans(rail, *ends)):
                    assert any(a <= low + NEAR and high <= b + NEAR for a, b in known)
                    compared += 1
    assert compared > 20


def slot(x: fmpq, y: int, side: int) -> xa.Outline:
    """A slot with its straight sides from (x, y - 5/2) and 3 further to one *side*, and its ends round."""
    low, high, far = y - fmpq(5, 2), y + fmpq(5, 2), x + 3 * side
    return xa.Outline([(x, low), (x, high, -side), (far, high), (far, low, -side)])


def test_the_cells_of_a_way_among_slots() -> None:
    """It begins where its line touches a slot's end, and ends where a view past another one does."""
    left, right = ([slot(fmpq(3 * side, 4), y, side) for y in (0, 9, 18)] for side in (-1, 1))
    circles = [xa.Circle((fmpq(41 * side, 4), -8), 2) for side in (-1, 1)]
    scene = xa.Scene([*left, circles[0], *right, circles[1]], start=(0, fmpq(59, 4)))
    way = xa.sightseer(scene, 23).path[45]
    swept = xa.sweep(scene, way.curve, 23)
    assert all(cell.map.known_length() > 0 for cell in swept.cells[:4])


def test_a_map_inside_an_arc_among_equal_circles() -> None:
    """What is seen from a transcendental place ends where what was known does: for all numbers alike."""
    rows = (0, 0), (fmpq(3, 2), fmpq(25981, 10000))
    circles = [xa.Circle((x + 3 * k, y), fmpq(5, 4)) for x, y in rows for k in range(3)]
    terrain = xa.Terrain(15, fmpq(78481, 10000), (-4, -4))
    run = xa.seed_spreader(xa.Scene(circles, terrain=terrain), 25, target="visible")
    assert run.map_at(fmpq(221, 4)).known_length() > 0


def test_a_map_on_a_way_that_touches_a_circle() -> None:
    """The view from an event's place past the circle lies between others; the way's own line bounds them."""
    xa.audit(xa.sightseer(past_a_circle(40)))


def test_a_map_at_a_place_of_high_degree() -> None:
    """Where two circles hide a third one from a way that touches a fourth, and show it again at once.

    The way is the shortest link past a circle: its numbers are those of a root of degree 20. A map at the
    event looks along it once more, and finds the line of sight by the other one of the two circles that it
    touches: it is the same place by the line's name, but not by any number that could be compared.
    """
    scene = xa.Scene(
        [
            xa.Circle((0, "9/4"), "43/20"),
            xa.Circle((6, 4), "39/10"),
            xa.Circle((8, "1/4"), "1/4"),
            xa.Circle((20, 2), 2),
        ],
        start=(13, 3),
        radius=20,
    )
    run = xa.sightseer(scene)
    maps = [run.map_at(event) for event in run.events]
    lengths = [sum(float(chart.known_length(k)) for k in range(4)) for chart in maps]
    assert lengths == sorted(lengths) and lengths[-1] < float(run.map.known_length()) + 1e-9


def test_an_end_that_was_seen_at_the_range_from_the_same_line() -> None:
    """Sights past a rounded corner come down to the range at the very place from which a known end was seen.

    That place is known by two roots of degree 12, one of the end and one of the sights.
    """
    assert xa.seed_spreader(xa.load(DATA / "thickened.json")).complete


def test_a_crossing_point_is_on_the_edge_that_it_was_cut_from() -> None:
    """Where a diversion's way meets an arc, nobody asks once more whether the point is on its circle.

    Its numbers come from an end of what is known, and that from an earlier place: it is far to prove. The
    audit compares such points at 500 digits, and proves neither that they end a range.
    """
    run = xa.seed_spreader(random_scene(Subject.SEED_SPREADER, 311001495))
    assert run.complete
    xa.audit(run, samples=4)


def test_a_normal_of_a_corner_that_touches_a_circle_is_a_tangent_of_both() -> None:
    """From a way that touches that circle the corner is seen along it last, as tangents and normals tell.

    Only tangents had a name for that line. So its place on the way, of degree 20, was found twice.
    """
    scene = xa.Scene(
        [
            xa.Outline([(1, "11/2", "1/4"), (3, 5)]),
            xa.Circle((0, "1341/260"), 1),
            xa.Outline([(-1, "909/260"), ("-138/125", 1, "67/250")]),
            xa.Outline([("-3/2", "29/4", 1), (-3, "79/10")]),
        ],
        start=(-3, 5),
    )
    run = xa.sightseer(scene, 4)
    assert run.complete
    xa.audit(run, samples=4)


@pytest.mark.parametrize("seed", some(range(12), 3))
def test_views_at_events_on_a_way_that_touches_a_circle(seed: int) -> None:
    """Which lines meet there, and what is as far away as the range, is what the event is about."""
    try:
        run = xa.sightseer(past_a_circle(seed))
    except xa.InvalidScene:
        return
    for event in run.events:
        view = run.view_at(event)
        assert view.pieces and view.seen()


def test_the_view_at_an_event_on_an_arc() -> None:
    """The robot walks along it: that its place is on the arc is known, and its numbers need not tell."""
    shapes = [
        xa.Circle(("25/2", 19), 5),
        xa.Outline([(3, 2, 1), (-3, -2)]),
        xa.Outline([(7, 4), (2, 6, -1), (3, 8)]),
    ]
    run = xa.sightseer(xa.Scene(shapes, start=(12, 1)), 20)
    assert run.view_at(run.events[19]).area > 0


@pytest.mark.parametrize("length", [9, 10, 11])
def test_a_map_among_concentric_rings(length: int) -> None:
    """As far from an arc as the range are all places of another one, also those with transcendental numbers.

    Some 8,000 places were to be tried. A tower of square roots shows at once that it is so at all of them.
    """
    about, back = xa.Around((0, 0)), xa.Around((0, 0), False)
    rings = [
        xa.Circle((0, 0), 1),
        xa.Outline([("8/5", "6/5"), ("12/5", "9/5", about), (0, 3), (0, 2, back)]),
        xa.Outline([(5, 0), (6, 0, about), (-6, 0), (-5, 0, back)]),
    ]
    run = xa.sightseer(xa.Scene(rings, start=(1, 0)), 4)
    assert run.map_at(length).known_length() > 0


def test_lines_along_rows_cross_a_way_in_one_point_each(monkeypatch: pytest.MonkeyPatch) -> None:
    """Eighteen slots in three rows: from a way that touches one, 50 single lines go along the same rows.

    Where each of them crosses the way was found by itself, in numbers of degree 12: the run took 23 seconds
    to prove 200 of these places equal, and takes one.
    """
    asked: list[object] = []
    vanishes = sign.vanishes
    monkeypatch.setattr(sign, "vanishes", lambda value: asked.append(value) or vanishes(value))  # type: ignore[func-returns-value]
    even, odd = (
        ("-10.5", "-7.96", "-5.42", "2.5", "5.04", "7.58"),
        ("-9.23", "-6.69", "-4.15", "3.77", "6.31", "8.85"),
    )
    rows = ("-0.5", even), ("1.6997", odd), ("3.8994", even)
    places = [(rational(x), rational(y)) for side in (0, 3) for y, xs in rows for x in xs[side : side + 3]]
    slots = [xa.Outline([(x, y), (x + 1, y, 1), (x + 1, y + 1), (x, y + 1, 1)]) for x, y in places]
    assert xa.sightseer(xa.Scene(slots, start=("-4.42", "1.6997")), 10).sense().complete
    assert len(asked) < 30


def test_a_tangent_at_the_end_of_an_arc_crosses_a_way_in_one_point(monkeypatch: pytest.MonkeyPatch) -> None:
    """A hole drawn as four rounded arcs: each joint is a corner, and shares a rational tangent with its arc.

    Where that crosses a way between two circles was found from both, in numbers of a tall field: the sweep of
    this way took 9 seconds to prove 20 of these places equal, and others, among more holes, over a minute.
    """
    hole = [("0.433", "-0.875"), ("-0.25", "-0.692"), ("-0.433", "-1.375"), ("0.25", "-1.558")]
    discs = [xa.Circle((0, y), 1) for y in (6, -6)]
    scene = xa.Scene([*discs, xa.Outline([(*at, "0.414") for at in hole])], start=hole[1])
    way = xa.sightseer(scene, 12).path[9].curve
    asked: list[object] = []
    vanishes = sign.vanishes
    monkeypatch.setattr(sign, "vanishes", lambda value: asked.append(value) or vanishes(value))  # type: ignore[func-returns-value]
    assert len(xa.sweep(scene, way, 12).events) == 16
    assert len(asked) < 20


@pytest.mark.parametrize("direction", [(3, 4), (-1, 2), (0, -2), (5, 0)])
def test_a_rational_line_has_one_form(direction: tuple[int, int]) -> None:
    """Whatever place of it and whatever length of its direction it is told by."""
    along, place = xa.Point(*direction), xa.Point("1/3", "-7/2")
    at, way = line_points._in_one_form(place, along)
    assert way.cross(along) == 0 and along.cross(at - place) == 0 and way.norm_sq() > 0
    again = line_points._in_one_form(place + along * fmpq(5, 7), along * -3)
    assert (at.key, way.key) == (again[0].key, again[1].key)
    root = xa.Point(2, xa.Real(2).sqrt())
    assert line_points._in_one_form(root, along) == (root, along)


def test_an_audit_of_a_way_through_a_sample() -> None:
    """A sampled place lies on a way with numbers of degree 20: that the way passes it need not be proved."""
    scene = xa.load(DATA / "rounded-squares.json")
    xa.audit(xa.sightseer(scene, 10), samples=12, seed=110400)


def test_a_single_ray_is_told_that_it_ends_at_the_range() -> None:
    """From a place where the views past a feature are as long as the range, the ray past it is a single one.

    What the view from there is told counted for what ends beside the ray, but not for the ray itself, and the
    number that is 0 is far to prove.
    """
    run = xa.sightseer(random_scene(Subject.SIGHTSEER, 328001143))
    maps = [run.map_at(event) for event in run.events]
    assert sum(len(chart.known(i)) for chart in maps for i in chart.seen) > len(maps)
