"""What is known of the view from a place because of how the place was found."""

from __future__ import annotations

from collections import Counter
from itertools import chain
from pathlib import Path
from random import Random

import pytest
from flint import fmpq
from nightly import NIGHTLY, by_night
from strategies import arc_terrain, degenerate_terrain, random_terrain

import exactacq as xa
from exactacq import Outline, Point, Scene
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.leg_facts import LegFacts
from exactacq.sensing.leg_views import Shares
from exactacq.sensing.legs import HaltPlace, Leg
from exactacq.sensing.sensor import Ahead, Sensor
from exactacq.strategies.run import Run
from exactacq.study.random_scenes import Subject, arc_scene
from exactacq.visibility.front_faces import FrontFaces
from exactacq.visibility.place_facts import NOTHING_KNOWN, Alignment, PlaceFacts, along_edge
from exactacq.visibility.range_clip import Disc, within
from exactacq.visibility.sensor_range import Range
from exactacq.visibility.visible_boundary import BoundaryView

DATA = Path(__file__).parent / "data"


@pytest.fixture
def legs(monkeypatch: pytest.MonkeyPatch) -> list[LegFacts]:
    """What legs tell of their places, of those that a map is read within."""
    found: list[LegFacts] = []
    plain = LegFacts.__init__

    def init(self: LegFacts, shares: Shares) -> None:
        plain(self, shares)
        found.append(self)

    monkeypatch.setattr(LegFacts, "__init__", init)
    return found


def read_maps(run: Run) -> None:
    """Read what is known of all obstacles at all events."""
    for chart in map(run.map_at, run.events):
        for i in range(len(run.scene.obstacles)):
            chart.known(i)


def check_ray(ray: Alignment, table: EdgeTable, place: Point) -> None:
    direction = Point(*ray.direction)
    assert (place - ray.contact).cross(direction) == 0
    for feature, side in ray.touched:
        if side == 0:
            touch = table.curves[feature].start
        else:
            arc = table.curves[table.line_numbers.first_arc(feature)]
            assert isinstance(arc, Arc)
            touch = ray.touch(feature, arc.center)
            spoke = arc.center - touch
            assert spoke.dot(direction) == 0 and spoke.norm_sq() == arc.radius_sq
            assert direction.cross(spoke).sign() == side
        way = touch - place
        assert way.cross(direction) == 0 and (way.dot(direction) > 0 or touch == place)
    for e, met in ray.met.items():
        assert table.curves[e].contains(met)
        assert (met - place).cross(direction) == 0 and (met - place).dot(direction) > 0


def check_tangent(curve: Curve, way: Point, touch: Point) -> None:
    """A way leads along a normal of a curve to a point of its line or circle."""
    if isinstance(curve, Arc):
        spoke = curve.center - touch
        assert spoke.norm_sq() == curve.radius_sq and way.cross(spoke) == 0
    else:
        assert curve.passes(touch) and way.dot(curve.direction) == 0


def check(facts: PlaceFacts, table: EdgeTable, place: Point, range_: Range) -> None:
    """All facts are true, and a view that is told of them sees the same as one that is not."""
    for ray in facts.rays:
        check_ray(ray, table, place)
    for e, point in facts.rim:
        assert (point - place).norm_sq() == range_.square
        assert table.curves[e].contains(point)
    for e, touch in facts.tangent.items():
        assert (touch - place).norm_sq() == range_.square
        check_tangent(table.curves[e], touch - place, touch)
    told, plain = (BoundaryView(table, place, range_, None, some).seen() for some in (facts, NOTHING_KNOWN))
    assert told == plain


def check_single(shares: Shares, u: Real, place: Point) -> int:
    """What a family shows from one place inside a leg is one object; how many of these there are."""
    if u in (shares.leg.first, shares.leg.last):
        return 0
    parts = shares.cut(shares.leg.upto(u, place)).of.values()
    single = [
        share.shown
        for share in chain.from_iterable(parts)
        if share.family.free_views is not None and share.source.low.key == share.source.high.key
    ]
    assert all(shown.low is shown.high for shown in single)
    return len(single)


@pytest.mark.parametrize("terrain", [random_terrain, degenerate_terrain, arc_terrain])
def test_facts_are_true(terrain: object, legs: list[LegFacts]) -> None:
    """Exactly, one by one, where families end: at some places of every leg with an event within."""
    counts: Counter[str] = Counter()
    for seed in range(24 if NIGHTLY else 5):
        some = terrain(Random(seed))  # type: ignore[operator]
        scene = some.scene()
        run = xa.sightseer(Scene(scene.shapes, some.start, enclosure=scene.enclosure, radius=some.radius))
        read_maps(run)
        table, range_, rng = EdgeTable(run.scene.obstacles), Range(run.radius), Random(seed)
        for leg in legs:
            ends = rng.sample(leg._ends, len(leg._ends))
            longest = [pair for pair in ends if pair[0].tight]
            for end, share in longest[:6] + ends[:2]:
                place = end.points[share.side]
                facts = leg.at(end.places[share.side], place)
                check(facts, table, place, range_)
                counts["single"] += check_single(leg._shares, end.places[share.side], place)
                counts.update("alone" if len(ray.touched) == 1 else "aligned" for ray in facts.rays)
                counts.update(rim=len(facts.rim), tangent=len(facts.tangent), holds=len(facts.holds))
        legs.clear()
    assert all(counts[kind] for kind in ("single", "alone", "aligned", "rim", "tangent", "holds")), counts


def test_facts_of_halts_are_true(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a gap closes, the end of it is seen along a ray, or is as far away as the range.

    Of each run the first halts: the numbers of later ones are made of theirs.
    """
    counts, halts = Counter[str](), list[HaltPlace]()
    upto = Sensor.upto

    def noted(self: Sensor, ahead: Ahead, leg: Leg, retraced: bool = False) -> Ahead:
        halt = leg.halts[-1]
        assert halt.place is leg.end
        if (halt.facts.rays or halt.facts.rim) and len(halts) < 4:
            halts.append(halt)
        return upto(self, ahead, leg, retraced)

    monkeypatch.setattr(Sensor, "upto", noted)
    for seed in range(60 if NIGHTLY else 14):
        scene = arc_scene(Subject.SIGHTSEER, seed)
        halts.clear()
        xa.explore(scene, "nearest-frontier")
        table = EdgeTable(scene.obstacles)
        for halt in halts:
            facts = halt.facts
            check(facts, table, halt.place, Range(scene.radius))
            for _, ray in halt.lines:
                check_ray(ray, table, halt.place)
            counts.update(rim=len(facts.rim), met=sum(len(ray.met) for ray in facts.rays))
    assert counts["rim"] and counts["met"], counts


def test_where_a_curve_leaves_the_range_is_a_point_that_is_known_to_be_there() -> None:
    """And where it enters it is another one, of which nothing is known."""
    line, circle = Segment(Point(-3, 0), Point(3, 0)), Arc.circle(Point(3, 0), fmpq(4))
    for curve, known, other in ((line, Point(2, 0), Point(-2, 0)), (line, Point(-2, 0), Point(2, 0))):
        (part,) = within(curve, curve.start, curve.end, Disc(Point(0, 0), fmpq(4), [(curve, known)]))
        assert known in part and other in part
        assert any(end is known for end in part)
    upper, lower = (Point(fmpq(3, 2), side * Real(7).sqrt() / 2) for side in (1, -1))
    for known in (upper, lower):
        disc = Disc(Point(0, 0), fmpq(4), [(circle, known)])
        (part,) = within(circle, Point(5, 0), Point(3, -2), disc)
        assert part == (upper, lower)
        assert [end is known for end in part] == [known is upper, known is lower]


def arc(y: int, radius: int, ccw: bool, start: tuple[int, int], end: tuple[int, int]) -> Arc:
    """An arc about (0, y) between two directions, each with whole numbers and of length 5."""
    points = (Point(fmpq(u * radius, 5), y + fmpq(v * radius, 5)) for u, v in (start, end))
    return Arc(*points, Point(0, y), fmpq(radius) ** 2, ccw=ccw)


LEFT, UP, RIGHT, DOWN, NEAR_LEFT, NEAR_RIGHT = (-5, 0), (0, 5), (5, 0), (0, -5), (-3, -4), (3, -4)


@pytest.mark.parametrize(
    "curve",
    [
        *(
            Segment(Point(a, 5), Point(b, 5))
            for a, b in ((-3, 3), (3, -3), (1, 3), (-3, -1), (0, 3), (-3, 0))
        ),
        *(arc(8, 3, True, LEFT, end) for end in (RIGHT, DOWN, NEAR_LEFT, NEAR_RIGHT)),
        *(arc(8, 3, True, start, RIGHT) for start in (DOWN, NEAR_RIGHT, UP)),
        arc(8, 3, False, RIGHT, LEFT),
        arc(-2, 7, False, LEFT, RIGHT),
        arc(-2, 7, False, UP, RIGHT),
        arc(-2, 7, False, RIGHT, DOWN),
        arc(2, 3, True, RIGHT, LEFT),
    ],
)
def test_what_touches_the_range_is_cut_as_if_nobody_had_told(curve: Curve) -> None:
    """The disc has radius 5, and all curves, or their lines or circles, touch its circle in (0, 5)."""
    disc, touch = Disc(Point(0, 0), fmpq(25)), Point(0, 5)
    told, plain = (within(curve, curve.start, curve.end, disc, touch=some) for some in (touch, None))
    assert told == plain


def test_a_circle_in_arcs_is_known_to_touch_the_range_by_each_of_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A disc of radius 3 in three arcs, the range's circle touching it in the middle of one of them."""
    ends = (3, 8), (fmpq(-9, 5), fmpq(52, 5)), (-3, 8)
    disc = Outline([(x, y, xa.Around((0, 8))) for x, y in ends])
    table, here, range_ = EdgeTable(Scene([disc]).obstacles), Point(0, 0), Range(fmpq(5))
    assert len({table.line_numbers.circles[e] for e in range(3)}) == 1
    plain = BoundaryView(table, here, range_).seen()
    assert plain == {2: [(Point(0, 5), Point(0, 5))]}

    def asked(self: FrontFaces, arc: Arc) -> int:
        raise AssertionError

    monkeypatch.setattr(FrontFaces, "_reaches", asked)
    facts = PlaceFacts(tangent={table.line_numbers.circles[0]: Point(0, 5)})
    assert BoundaryView(table, here, range_, None, facts).seen() == plain


@by_night
def test_a_place_whose_numbers_do_not_tell_that_two_arcs_are_in_line() -> None:
    """Within a straight leg of this drawing an arc comes into sight behind another one.

    The place is a number of degree 640. That both arcs touch one ray from there would take a proof with
    650 billion bits, but the place was found on the line that touches both.
    """
    run = xa.sightseer(xa.inspect(DATA / "issue39.dxf").scene, "48/5", start=("5825/2", 3184))
    event = run.events[212]
    assert event.kind == "regain" and event.obstacle == 0
    assert run.map_at(event).known(0)


def test_where_the_line_of_an_edge_leads_from_a_place_on_it() -> None:
    """Each corner and circle that it touches, and no other, is on one of the two rays, on the right side."""
    found = Counter[str]()
    for seed in range(12):
        table = EdgeTable(arc_scene(Subject.SIGHTSEER, seed).obstacles)
        for e, edge in enumerate(table.curves):
            if not isinstance(edge, Segment):
                continue
            place, along = edge.point("2/7"), edge.direction
            rays = {ray.sense: ray for ray in along_edge(table, place, e, range(len(table.curves)))}
            for ray in rays.values():
                check_ray(ray, table, place)
            touched = {(ray.sense, feature) for ray in rays.values() for feature, _ in ray.touched}
            expected = set()
            for other, curve in enumerate(table.curves):
                corner, circle = table.line_numbers.feature(other, False), None
                way = curve.start - place
                if not (isinstance(curve, Arc) and curve.full) and way.cross(along) == 0:
                    expected.add((way.dot(along).sign(), corner))
                if isinstance(curve, Arc):
                    way, circle = curve.center - place, table.line_numbers.feature(other, True)
                    if way.cross(along) ** 2 == along.norm_sq() * curve.radius_sq:
                        expected.add((way.dot(along).sign(), circle))
                        found["circles"] += 1
            assert touched == expected
            found["corners"] += len(expected) > 2
    assert found["circles"] > 5 and found["corners"] > 5


def test_an_arc_that_an_edge_runs_into_is_touched_in_their_joint() -> None:
    """From a place on the edge with nested numbers that took a quarter of a minute."""
    bracket = Outline([(0, 5, 0), (-1, 5, 0), (-1, 0, 0), (2, 0, 0), (2, 1, 1), (0, 1, 0)])
    table = EdgeTable(Scene([bracket], start=(5, 5), radius=9).obstacles)
    height = Real(2).sqrt()
    for k in (3, 5, 7, 11, 13):
        height = (height + Real(k).sqrt() + 1).sqrt() + Real(k + 1).sqrt()
    seen = BoundaryView(table, Point(0, height / 4 + 1), Range(fmpq(9))).seen()
    ((_, joint),) = seen[4]
    assert joint is table.curves[5].start and [*seen] == [4, 5]
