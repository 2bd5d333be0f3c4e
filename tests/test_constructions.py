"""Points that know how they were made: what arithmetic need not prove, and that no more is taken for known.

The strategies go from place to place where the last of an arc is seen, or where its nearest point is: the
numbers of each are made of those of the one before.
"""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random
from typing import TypeAlias

import pytest
from flint import fmpq
from nightly import some

import exactacq as xa
from exactacq import Circle, Outline, Point, Polygon, Scene, Segment
from exactacq.auditing import comparisons
from exactacq.geometry import curves, intersections
from exactacq.geometry.constructions import (
    corners_passed,
    is_normal,
    is_past_corner,
    is_put_around,
    is_put_on,
    is_tangent,
    put_around,
    put_on,
    put_on_line,
    put_on_normal,
    put_on_tangent,
    put_past_corner,
)
from exactacq.geometry.curves import Arc
from exactacq.geometry.intersections import ContactKind, contacts
from exactacq.numbers import tower
from exactacq.numbers.precision import workprec
from exactacq.sensing import acquisition, legs, memory, range_ends, straight_way
from exactacq.sensing.path import Piece
from exactacq.strategies.seed_spreader.prediction.decide import _way
from exactacq.strategies.seed_spreader.prediction.pieces import Pieces
from exactacq.strategies.seed_spreader.prediction.sight import Sights
from exactacq.study.families.scenes import family_scene
from exactacq.study.random_scenes import Subject, arc_scene
from exactacq.visibility import line_families, place_facts

HERE = Path(__file__).parent
UNIT = Arc.circle(Point(0, 0), fmpq(1))
ROOT3 = xa.Real(3).sqrt()
FAR = Point(3, 0)

Slot: TypeAlias = "list[tuple[object, ...]]"


@contextmanager
def work_in_fields(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[float]]:
    """What numbers cost that are computed in their fields: of ties that nothing simpler decides."""
    spent: list[float] = []
    plain = tower.Tower._spend

    def counted(self: tower.Tower, work: float) -> None:
        spent.append(work)
        plain(self, work)

    with monkeypatch.context() as patch:
        patch.setattr(tower.Tower, "_spend", counted)
        yield spent


def test_a_point_knows_the_circles_that_it_was_made_on() -> None:
    (contact, _) = contacts(Segment(FAR, Point(-3, 1)), UNIT)
    assert is_put_on(contact.start, UNIT.carrier)
    assert not is_put_on(Point(*contact.start), UNIT.carrier)
    assert not is_put_on(contact.start, Arc.circle(Point(0, 0), fmpq(2)).carrier)
    assert UNIT.on_circle(contact.start)
    assert UNIT.on_circle(Point(*contact.start))


def test_where_a_way_ends_on_an_arc_is_no_root_to_be_found() -> None:
    """A point near the circle that claims to lie on it is believed: so arithmetic is not asked."""
    liar = Point(fmpq(1, 2), ROOT3 / 2 + fmpq(1, 10**40))
    way = Segment(Point(2, 3), liar)
    assert [c.kind for c in contacts(way, UNIT)] == []
    put_on(liar, UNIT.carrier)
    (contact,) = contacts(way, UNIT)
    assert contact.kind is ContactKind.TOUCHING
    assert contact.start is liar


@pytest.mark.parametrize("beyond", [0, 1])
def test_a_way_through_an_arc_from_a_point_of_it_meets_it_twice(beyond: int) -> None:
    start = Point(fmpq(1, 2), ROOT3 / 2)
    put_on(start, UNIT.carrier)
    across = Segment(start, Point(fmpq(1, 2), -ROOT3 / 2 - beyond))
    here, there = contacts(across, UNIT)
    assert here.start is start
    assert there.start == Point(fmpq(1, 2), -ROOT3 / 2)
    assert (there.kind is ContactKind.CROSSING) == (beyond > 0)


def test_a_line_that_was_made_touching_a_circle_touches_it_once() -> None:
    """It does so inside the way, or at its end if that was made on the circle."""
    touch, last = Point(fmpq(1, 2), ROOT3 / 2), Point(-1, ROOT3)
    origin = Point(2, 0)
    for end in (touch, last):
        put_on_tangent(end, origin, UNIT.carrier)
    put_on(touch, UNIT.carrier)
    (contact,) = contacts(Segment(origin, last), UNIT)
    assert contact.kind is ContactKind.TOUCHING
    assert contact.start == touch
    (contact,) = contacts(Segment(origin, touch), UNIT)
    assert contact.start is touch


def test_the_audit_does_not_believe_a_point() -> None:
    for liar in (Point(fmpq(1, 2), fmpq(1, 2)), Point(fmpq(1, 2), ROOT3 / 2 + fmpq(1, 10**40))):
        put_on(liar, UNIT.carrier)
        assert UNIT.passes(liar)
        assert not comparisons.passes(UNIT, liar)


def test_a_copy_knows_nothing() -> None:
    """A chain of a thousand places, each made from the one before, is written without them."""
    at = Point(0, 0)
    for k in range(1000):
        onward = Point(k + 1, ROOT3)
        put_on_tangent(onward, at, UNIT.carrier)
        put_on(onward, UNIT.carrier)
        at = onward
    for again in (pickle.loads(pickle.dumps(at)), copy.deepcopy(at)):
        assert again == at
        assert not is_put_on(again, UNIT.carrier)


def to_nearest(robot: xa.Robot) -> None:
    """Three times to a nearest known point of an arc; once another pin is in the way."""
    for x in (7.044, 1, 9.02):
        near = (robot.map.nearest(i, robot.position) for i in robot.map.seen)
        robot.go_to(min(near, key=lambda point: abs(point.xy[0] - x)))


def to_frontiers(robot: xa.Robot) -> None:
    """Straight to the last that is seen of something, which lies on an arc or past one, again and again."""
    for k in range(6):
        ends = robot.frontier
        robot.go_to(ends[k % len(ends)][1])


PINS = [Circle((x, 0), 1) for x in (0, 5, 10)]
POSTS = [Circle((fmpq(5, 2), fmpq(1, 10)), fmpq(1, 2)), Circle((fmpq(15, 2), fmpq(-1, 10)), fmpq(1, 2))]


@pytest.mark.parametrize("own", [to_nearest, to_frontiers])
def test_places_made_of_places_decide(
    own: Callable[[xa.Robot], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """That a goal lies on its own arc was asked of numbers with three and more nested roots."""
    scene = Scene([*PINS, *POSTS], start=(fmpq(5, 2), -2))
    with work_in_fields(monkeypatch) as spent:
        run = xa.explore(scene, own, 20)
        assert len(run.events) > 5
    assert sum(spent) < 5000
    xa.audit(run)


def test_a_halt_where_a_gap_closes_is_told_along_what_it_closes(monkeypatch: pytest.MonkeyPatch) -> None:
    """From the halt an end of the gap is seen past an arc. That point was made before, in simpler numbers."""
    scene = xa.load(HERE / "data" / "issue21.dxf", start=(700, 60))
    with work_in_fields(monkeypatch) as spent:
        assert len(xa.explore(scene, "nearest-frontier", 560).events) == 16
    assert sum(spent) < 5000


def audited(scene: Scene, own: Callable[[xa.Robot], object]) -> xa.Run:
    run = xa.explore(scene, own)
    xa.audit(run)
    return run


@pytest.mark.parametrize("sense", [1, -1])
def test_a_line_of_sight_that_touches_a_disc_is_not_asked_where_it_leads(
    sense: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A look ahead on a board of 100 pins, R = 50, was undecided: whether a tangent has the disc's direction.

    The line passes the place where another tangent, from an irrational place, touches a disc. A disc that is
    seen from inside blocks it.
    """
    start, one, other = Point(40, 37 + ROOT3), Point(38, 10), Arc.circle(Point(18, 14), fmpq(1))
    disc = other if sense > 0 else other.reversed()
    first = _way(start, xa.Real(0), one, xa.Real(1))
    assert first is not None
    corner = start + first * (first.dot(one - start) / first.norm_sq())
    way = _way(corner, xa.Real(0), disc.center, xa.Real(-1))
    assert way is not None
    place, seen = (corner + way * ((x - corner.x) / way.x) for x in (40, 15))
    with work_in_fields(monkeypatch) as spent:
        assert Sights(Pieces([disc], 50)).is_free(place, seen, (disc, corner)) == (sense > 0)
    assert not spent


def among_slots(low: Slot, high: Slot, start: tuple[int, int], radius: int) -> Scene:
    """Two slots, bent like the plate with round ends that they are cut into."""
    plate = Outline([(0, -25), (70, -25, 1), (70, 25), (0, 25)])
    return Scene([Outline(low), Outline(high)], start, radius=radius, enclosure=plate)


@pytest.mark.parametrize("start", [(88, -2), (25, 17), (26, 9), (29, -4)])
def test_a_halt_where_a_gap_closes_at_the_range_sees_its_end(start: tuple[int, int]) -> None:
    """The end of what was known, exactly 21 from where the robot halts, is the end of what it sees there."""
    low = [("52.527", "-11.649", "0.099"), ("58.351", "-17.473", 1)]
    low += [("60.57", "-14.145", "-0.099"), ("55.855", "-9.43", 1)]
    high = [("58.351", "17.473", "0.099"), ("52.527", "11.649", 1)]
    high += [("55.855", "9.43", "-0.099"), ("60.57", "14.145", 1)]
    run = xa.explore(among_slots(low, high, start, 21), "nearest-frontier")
    assert run.map.acquired == (0, 1, 2)


def test_a_halt_where_a_gap_closes_along_the_arc_that_is_walked_sees_its_end() -> None:
    """The end of what was known is seen along the tangent of the arc; balls hardly hold its parameter."""
    low = [("52.52694381890525", "-11.6487041207298", "48431676/489112441")]
    low += [("58.3512958792702", "-17.47305618109475", "141161246478402/141161246478403")]
    low += [("60.57009666417113", "-14.14485500374335", "-48431676/489112441")]
    low += [("55.85514499625665", "-9.42990333582887", 1)]
    high = [("58.35129587927017", "17.47305618109473", "9559439/96540961")]
    high += [("52.52694381890527", "11.64870412072983", "163287535202857/163287535202858")]
    high += [("55.85514499625667", "9.42990333582889", "-9559439/96540961")]
    high += [("60.57009666417111", "14.14485500374333", 1)]
    for start, radius in (((22, 20), 22), ((20, 23), 20)):
        run = xa.explore(among_slots(low, high, start, radius), "nearest-frontier")
        assert run.map.acquired == (0, 1, 2)
    # From where the audit looks something is exactly as far away as the range.
    xa.audit(run)


def test_a_place_that_was_made_at_the_range_is_not_measured_again() -> None:
    """A point that claims to be as far from another one as the range is believed: arithmetic is not asked."""
    end, liar = Point(ROOT3 + 4, 0), Point(ROOT3 + fmpq(1, 10**40), 0)
    around, wall = Arc.circle(end, fmpq(16)), Segment(liar, Point(-9, 0))
    (contact,) = contacts(wall, around)
    assert contact.start == Point(ROOT3, 0)
    put_around(liar, end, fmpq(16))
    for curve in (wall, Arc(liar, Point(-ROOT3, 0), Point(0, 1), fmpq(4), ccw=True)):
        assert any(contact.start is liar for contact in contacts(curve, around))


def test_what_was_looked_along_is_not_looked_for_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where an obstacle becomes whole on a way that the robot halts on is found once."""
    asked = list[int]()
    place = acquisition.Acquisition.place

    def counted(self: acquisition.Acquisition) -> legs.Place:
        asked.append(self.k)
        return place(self)

    monkeypatch.setattr(acquisition.Acquisition, "place", counted)
    run = xa.explore(xa.load("circles"), "nearest-frontier")
    acquired = [event.obstacle for event in run.events if event.kind is xa.EventKind.ACQUIRE]
    assert len(asked) == len(set(asked)) == len(acquired)


def test_what_was_looked_along_is_not_taken_for_another_way() -> None:
    """Halts where a way begins: then the robot goes on another one, between the same two places.

    A lap along a circle begins and ends where it is lost, and there are two ways along a circle of two arcs.
    """
    block = Polygon([(2, -6), (4, -6), (4, -5), (2, -5)])
    lap = xa.Robot(Scene([Circle((3, 0), 1), block], (0, -1), radius=20))
    lap.go_to((3, -1))
    lap.walk("left", until=["lose"])
    lap.circle()
    assert lap.map.acquired == (0,)
    halves = Outline([(4, 0, xa.Around((3, 0))), (2, 0, xa.Around((3, 0)))])
    above = Polygon([(1, 8), (1, 6), (2, 6), (2, 8)])
    back = xa.Robot(Scene([halves, block, above], (0, -1), radius=20))
    back.go_to((3, -1))
    back.walk("left", until=["lose"])
    back.walk("right", to=(2, 0))
    assert back.map.acquired == ()


def test_nothing_is_noted_on_points_that_others_keep() -> None:
    """Each robot of a scene would leave something on its start, where it sees a wall as far as it can."""
    room = Polygon([(0, 0), (12, 0), (12, 2), (0, 2)])
    scene = Scene([], (1, 1), radius=9, enclosure=room)
    for _ in range(3):
        assert xa.Robot(scene).go_to((9, 1), until="acquire").kind == "event"
    assert scene.start is not None
    assert not hasattr(scene.start, "_facts")


@pytest.mark.parametrize("off", [0, fmpq(1, 10**9)])
def test_a_line_that_touches_a_disc_enters_another_where_it_is_met_first(off: object) -> None:
    """The robot halts at irrational places of a line that is computed with by points of whole coordinates.

    One of these lies on the disc, at the place where the line leaves it.
    """
    touched, met = Circle((-1, 0), 1), Circle((fmpq(3, 4) + off, 1), fmpq(1, 4))
    behind = [Circle((-9, 3), fmpq(1, 2)), Circle((-9, 4), fmpq(1, 4))]

    def own(robot: xa.Robot) -> None:
        for _ in range(2):
            assert robot.go_to((3, 1), until="lose").kind == "event"
        robot.go_to((-9, 1))

    run = audited(Scene([touched, met, *behind], start=(-9, 1), radius=7), own)
    assert not run.map.knows(1, Point(1 + off, 1))
    assert float(run.map.known_length(1)) == pytest.approx(0.38377, abs=1e-4)


def sector(r: object, s: object, *corners: tuple[object, object]) -> xa.Outline:
    outer, inner = xa.Around((0, 0)), xa.Around((0, 0), ccw=False)
    (a, b), (c, d) = corners
    return xa.Outline([(a * s, b * s, outer), (c * s, d * s), (c * r, d * r, inner), (a * r, b * r)])


def test_a_halt_at_a_corner_is_told_no_ray_of_another_place() -> None:
    """A corner that ends a gap is seen from a stretch of the way: the ray from its other end differs."""
    ring = sector(3, 4, (fmpq(-3, 5), fmpq(4, 5)), (fmpq(-4, 5), fmpq(3, 5)))
    hook = xa.Outline(
        [(-4, 6, xa.Around((-2, 6))), (0, 6, xa.Around((-1, 6))), (-2, 6, xa.Around((-3, 6), ccw=False))]
    )

    def own(robot: xa.Robot) -> None:
        robot.go_to((fmpq(-12, 5), fmpq(-16, 5)))
        places = [robot.go_to((-4, 4), until="acquire").place for _ in range(2)]
        assert places[0] == Point(fmpq(-76, 21), fmpq(16, 7))

    run = audited(Scene([ring, hook], start=(0, 0), radius=30), own)
    assert [event.kind.value for event in run.events] == ["start", "sight", "sight", "acquire", "stop"]


def wander(seed: int) -> Callable[[xa.Robot], None]:
    """Some moves to frontiers, nearest points and along boundaries, most until something is seen or lost."""

    def own(robot: xa.Robot) -> None:
        rng = Random(seed)
        for _ in range(6):
            until = rng.choice([(), ("sight", "regain"), ("acquire",), ("lose",), ("lose", "acquire")])
            ends, kind = robot.frontier, rng.randrange(4)
            if kind == 0 and robot.at is not None:
                robot.walk(rng.choice(["left", "right"]), until=until)
            elif kind == 1 and ends:
                robot.go_to(rng.choice(ends)[1], until=until)
            elif kind == 3 and robot.at is not None:
                robot.circle()
            elif robot.seen:
                robot.go_to(robot.map.nearest(rng.choice(robot.seen), robot.position), until=until)

    return own


def told(seed: int) -> list[object] | None:
    """What happens in a run, and what is known at its end, in digits; None if it is undecided."""
    try:
        run = xa.explore(arc_scene(Subject.SIGHTSEER, seed), wander(seed))
    except xa.Undecided:
        return None
    known = [run.map.known_length(k).decimal(30) for k in run.map.seen]
    return [*((e.kind, e.obstacle, [c.decimal(30) for c in e.point]) for e in run.events), *known]


@pytest.mark.parametrize("seed", some(range(60), 12))
def test_what_is_known_of_points_changes_nothing(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without it numbers tell the same, where they can: no point claims what it was not made with.

    There each way is looked along anew when it is walked, also up to a halt.
    """
    with_facts, taken = told(seed), memory.Memory._taken

    def taken_whole(self: memory.Memory, piece: Piece) -> object:
        return taken(self, piece) if self._looked[0] is piece else (None, None)

    for module in (curves, intersections, legs, straight_way, line_families, range_ends, place_facts):
        if hasattr(module, "corners_passed"):
            monkeypatch.setattr(module, "corners_passed", lambda *_: ())
        for name in (
            "is_put_on",
            "is_put_around",
            "is_tangent",
            "is_normal",
            "is_past_corner",
            "touch_on_tangent",
        ):
            if hasattr(module, name):
                monkeypatch.setattr(module, name, lambda *_: None)
    monkeypatch.setattr(memory.Memory, "_taken", taken_whole)
    without = told(seed)
    if without is None:
        pytest.skip("numbers alone do not decide it")
    assert with_facts == without


@pytest.mark.parametrize("x", [fmpq(-1, 4), 1, 4])
def test_a_halt_where_two_common_tangents_meet_tells_them_apart(x: object) -> None:
    """From the outer centre of similitude of two discs the robot goes on along one of their tangents.

    That was taken for the other one, which the way crosses where it begins: a run ended in an error.
    """
    discs = [Circle((0, 0), 1), Circle((4, 0), 2), Circle((1, 4), fmpq(1, 2)), Circle((1, -4), fmpq(1, 2))]
    scene = Scene([*discs, Circle((-6, fmpq(5, 2)), fmpq(1, 2))], start=(-2, 0), radius=9)
    goal = Point(x, -(xa.Real(x) + 4) / xa.Real(15).sqrt())

    def own(robot: xa.Robot) -> None:
        assert robot.go_to((-5, 0), until="sight").place == Point(-4, 0)
        robot.go_to(goal, until=("sight", "regain", "lose"))
        robot.go_to((-3, 3), until=("sight", "regain", "lose"))

    assert len(audited(scene, own).events) == 9


def test_a_way_is_told_of_lines_that_it_was_made_on() -> None:
    """A point that claims so is believed, and what is made on the way to it takes it over."""
    start, end, corner, place = Point(0, 0), Point(2, ROOT3), Point(1, 5), Point(1, ROOT3 / 2)
    assert not is_normal(start, end, UNIT.carrier) and not is_past_corner(start, end, corner)
    put_on_normal(end, start, UNIT.carrier)
    put_past_corner(end, start, corner)
    for a, b in ((start, end), (end, start)):
        assert is_normal(a, b, UNIT.carrier) and is_past_corner(a, b, Point(1, 5))
        assert not is_past_corner(a, b, Point(1, 4))
    assert not is_normal(start, Point(*end), UNIT.carrier)
    assert not is_normal(start, end, Arc.circle(Point(0, 0), fmpq(2)).carrier)
    other, touch, goal = Point(ROOT3, 7), Point(*end), Point(7, ROOT3)
    put_on_tangent(other, goal, UNIT.carrier, touch)
    for first in (goal, touch):
        assert is_tangent(other, first, UNIT.carrier) and is_tangent(first, other, UNIT.carrier)
    assert not is_tangent(other, end, UNIT.carrier) and not is_tangent(goal, touch, UNIT.carrier)
    put_on_line(place, start, end)
    assert is_normal(start, place, UNIT.carrier) and is_past_corner(start, place, corner)
    assert [point is end for point in corners_passed(start, place)] == [True, False]


def test_two_places_on_a_circle_are_where_their_line_meets_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both are known: neither is looked for, nor compared with what is found."""
    places = []
    for k in (2, 5):
        x = (xa.Real(k).sqrt() + xa.Real(3).sqrt() + 1).sqrt() / 9
        places.append(Point(x, (1 - x * x).sqrt()))
        put_on(places[-1], UNIT.carrier)
    with work_in_fields(monkeypatch) as spent:
        found = contacts(Segment(*places), UNIT)
    assert [contact.start is place for contact, place in zip(found, places, strict=True)] == [True, True]
    assert not spent


def test_a_place_at_a_distance_from_a_corner_knows_it_by_its_coordinates() -> None:
    place = Point(1, ROOT3)
    put_around(place, Point(0, 0), fmpq(4))
    assert is_put_around(place, Point(0, 0), fmpq(4)) and is_put_around(Point(0, 0), place, fmpq(4))
    assert not is_put_around(place, Point(0, 1), fmpq(4)) and not is_put_around(place, Point(0, 0), fmpq(5))
    put_around(place, Point(ROOT3, 0), fmpq(9))
    assert not is_put_around(place, Point(ROOT3, 0), fmpq(9))


def test_lines_of_two_origins_are_not_mixed() -> None:
    """What is known of the line to one is not told of the line to the other."""
    place, first, second, corner = Point(0, 0), Point(-3, 0), Point(-3, -4), Point(3, 4)
    carrier = Arc.circle(Point(5, 1), fmpq(1)).carrier
    put_on_tangent(place, first, carrier)
    put_past_corner(place, second, corner)
    assert is_tangent(place, first, carrier) and is_past_corner(place, second, corner)
    assert not is_tangent(place, second, carrier) and not is_tangent(place, corner, carrier)
    assert not is_past_corner(place, first, corner)


def test_of_a_line_through_two_points_that_are_one_nothing_is_noted() -> None:
    """There are many such lines, and what is known of one of them does not hold for another."""
    place, same, corner = Point(0, 0), Point(ROOT3 - ROOT3, 0), Point(3, 4)
    put_past_corner(place, same, corner)
    put_on_tangent(place, same, Arc.circle(Point(5, 1), fmpq(1)).carrier)
    put_on_normal(place, same, UNIT.carrier)
    assert not is_tangent(place, corner, Arc.circle(Point(5, 1), fmpq(1)).carrier)
    assert not is_past_corner(place, corner, corner) and not is_normal(place, corner, UNIT.carrier)


def look_again(robot: xa.Robot) -> None:
    """To one end of what is known after another; where something happens on the way it decides anew."""
    for n in range(5):
        ends = robot.frontier
        if ends:
            robot.go_to(ends[7 * n % len(ends)][1], until=("sight", "regain", "lose"))


@pytest.mark.parametrize("seed", some(range(12), 4))
def test_robots_that_decide_anew_where_something_happens(seed: int) -> None:
    try:
        run = xa.explore(arc_scene(Subject.SIGHTSEER, seed), look_again)
    except xa.Undecided:
        pytest.skip("places found from places have longer and longer numbers")
    xa.audit(run)


@pytest.mark.parametrize(
    ("scene", "first"),
    [
        (lambda: family_scene("gears", 20, 1, "sightseer"), 12),
        (lambda: arc_scene(Subject.SIGHTSEER, 6), 62),
    ],
    ids=["gears", "arcs"],
)
def test_robots_that_are_stopped_on_the_way_to_short_places(scene: Callable[[], Scene], first: int) -> None:
    """They halt by boundaries whose numbers get longer, but for the corners and lines of sight by them.

    Both were `Undecided`: a way to a corner behind the wall that it leads into, and a line that a robot has
    halted on.
    """

    def own(robot: xa.Robot) -> None:
        for n in range(14):
            ends = robot.frontier
            if not ends:
                return
            x, y = ends[(7 * n + first) % len(ends)][1].xy
            here, goal = robot.position, Point(fmpq(round(x * 1024), 1024), fmpq(round(y * 1024), 1024))
            halt = robot.go_to(goal, until="lose")
            way = goal - here
            share = float((halt.place - here).dot(way)) / float(way.norm_sq()) if halt.kind == "event" else 1
            if share < 1:
                robot.go_to(here + way * fmpq(int(share * 4096) + 1, 4096))

    assert len(xa.explore(scene(), own).path) > 6


def test_what_a_halt_tells_to_be_at_the_range_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """As long balls say; and much else is not."""
    told, is_at_range = list[tuple[bool, bool]](), straight_way._is_at_range

    def checked(*given: object) -> bool:
        found = is_at_range(*given)  # type: ignore[arg-type]
        halts, view = given[1], given[3]
        with workprec(512):
            (x, y), (u, v) = (tuple(c.ball(512) for c in p) for p in view.points)  # type: ignore[attr-defined]
            off = (x - u) * (x - u) + (y - v) * (y - v) - fmpq(radius) * fmpq(radius)
        told.append((found, bool(abs(off) < 1e-60)))
        assert halts
        return found

    monkeypatch.setattr(straight_way, "_is_at_range", checked)
    for seed in (5, 9, 17, 26):
        scene = arc_scene(Subject.SIGHTSEER, seed)
        radius = scene.radius
        assert radius is not None
        xa.explore(scene, look_again)
    assert all(is_so for found, is_so in told if found)
    assert any(found for found, _ in told) and any(not is_so for _, is_so in told)
