"""Sensing on the move: exact events, laws of the map, and the cases that broke earlier versions."""

from __future__ import annotations

import pickle
from fractions import Fraction
from itertools import pairwise
from random import Random

import numpy as np
import pytest
from flint import fmpq
from hypothesis import given
from nightly import examples, some
from strategies import Terrain, degenerate_terrain, random_terrain, terrains

import exactacq as xa
from exactacq import Circle, Outline, Point, Polygon, Real, Scene, kernel
from exactacq.errors import InvalidScene
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Segment
from exactacq.geometry.interval_union import Cover, Interval
from exactacq.numbers.length import Length
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.event import Event, EventKind
from exactacq.sensing.map import Map
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.sensing.targets import Targets
from exactacq.strategies.run import Run
from exactacq.visibility.isovist import isovist

Q = Fraction


def straight(*places: tuple[object, object]) -> list[Piece]:
    """The straight pieces through some places."""
    points = [Point(*place) for place in places]
    return [Piece("straight", None, Segment(a, b)) for a, b in pairwise(points)]


def walked(scene: Scene, radius: object, *places: tuple[object, object]) -> Memory:
    return Memory.of(scene, xa.Scene([], radius=radius).radius, Point(*places[0]), straight(*places))


def known(memory: Memory, count: int, obstacle: int) -> list[tuple[int, str, str]]:
    """What is known of an obstacle after some pieces, in closed form."""
    return [(p.edge, str(p.start), str(p.end)) for p in memory.after(count).known(obstacle)]


def reports(run: Run, obstacle: int) -> list[tuple[str, str, str]]:
    kinds = ("sight", "acquire", "lose", "regain")
    return [(e.kind, str(e.at), e.note) for e in run.events if e.obstacle == obstacle and e.kind in kinds]


class TestExactEvents:
    def test_m11(self) -> None:
        """O2 becomes known all around from the inside of O1, O3 comes into range on the way to O2."""
        run = xa.sightseer(xa.load("m11"))
        assert reports(run, 1) == [
            ("sight", "15", ""),
            ("lose", "24", "range"),
            ("regain", "28", ""),
            ("acquire", "36", ""),
        ]
        assert reports(run, 2)[:2] == [
            ("sight", "233/2 - 3*sqrt(11)/5", ""),
            ("lose", "118", "occlusion"),
        ]
        loop = [e for e in run.events if e.kind in ("hit", "leave") and e.obstacle == 0]
        acquired = next(e for e in run.events if e.kind == "acquire" and e.obstacle == 1)
        assert loop[0].at < acquired.at < loop[1].at

    def test_figure_1(self) -> None:
        """O2 is acquired on the loop of O1, yet it is visited, and O3 is first seen on the loop of O2."""
        run = xa.sightseer(xa.load("figure1"))
        first = {(e.kind, e.obstacle): e for e in run.events}
        assert first["hit", 0].at < first["acquire", 1].at < first["leave", 0].at
        assert first["hit", 1].at < first["sight", 2].at < first["leave", 1].at
        assert run.visits == (0, 1, 2)

    def test_a_wall_comes_into_range_and_leaves_it(self) -> None:
        """Along y = 0 past the corner (0, 3) with R = 5: in sight from x = -4 to x = 4 + 2 along the wall."""
        wall = Scene([Polygon([(0, 3), (2, 3), (2, 4), (0, 4)])])
        memory = Memory(wall, Q(5) and xa.Scene([], radius=5).radius)
        memory.begin(Point(-10, 0))
        (piece,) = straight((-10, 0), (10, 0))
        told = [(r.kind.value, str(r.place), r.reason) for r in memory.walk(piece)]
        assert told == [("sight", "(-4, 0)", None), ("lose", "(6, 0)", "range")]
        assert known(memory, 1, 0)[:1] == [(0, "(0, 3)", "(2, 3)")]

    def test_lost_at_a_corner_while_both_ends_are_at_the_range(self) -> None:
        """From the tip of a spike the wall is seen from (-4, 3) to (4, 3), R = 5; behind it nothing is."""
        spike, wall = Polygon([(20, 0), (0, 0), (20, -1)]), Polygon([(-10, 3), (10, 3), (10, 4), (-10, 4)])
        scene = Scene([spike, wall])
        memory = Memory(scene, xa.Scene([], radius=5).radius)
        memory.begin(Point(8, 0))
        top, below, _ = scene.obstacles[0].edges
        told = [
            (r.kind.value, str(r.place), r.reason)
            for curve in (top.part(Point(8, 0), Point(0, 0)), below.part(Point(0, 0), Point(10, Q(-1, 2))))
            for r in memory.walk(Piece("boundary", 0, curve))
            if r.obstacle == 1
        ]
        assert told == [("lose", "(0, 0)", "occlusion")]

    def test_radius_equal_to_the_gap(self) -> None:
        """From y = 0 exactly one point of the wall's long side is seen at a time: all of it in the end."""
        wall = Scene([Polygon([(0, 3), (2, 3), (2, 4), (0, 4)])])
        memory = walked(wall, 3, (-1, 0), (1, 0))
        assert known(memory, 1, 0) == [(0, "(0, 3)", "(1, 3)")]
        assert memory.after(1).frontier[-1][1] == Point(1, 3)
        assert not walked(wall, Q(29, 10), (-1, 0), (1, 0)).seen


class TestLaws:
    @examples(3, 100)
    @given(terrains())
    def test_audited(self, terrain: Terrain) -> None:
        law_of_the_audit(terrain)

    @pytest.mark.parametrize("seed", some([0, 9, 16, 22, 26, 33, 53, 62, 67, 68, 83, 153, 161, 177, 208], 4))
    def test_audited_cases(self, seed: int) -> None:
        """Scenes on which the audit or an oracle once found a flaw."""
        rng = Random(seed)
        law_of_the_audit(degenerate_terrain(rng) if seed % 2 else random_terrain(rng, room=seed % 4 == 0))

    @pytest.mark.parametrize("name", ["figure1", "m11", "m4", "squares", "circles"])
    def test_splitting_a_piece_changes_nothing(self, name: str) -> None:
        run = xa.sightseer(xa.load(name))
        halves = [half for piece in run.path for half in split(piece)]
        again = Memory.of(run.scene, run.radius, run.start, halves)
        assert parts(again.after(len(halves)), run) == parts(run.map, run)

    @pytest.mark.parametrize("name", ["m11", "m4", "squares"])
    def test_a_step_adds_the_views_over_it(self, name: str) -> None:
        """What any place of a piece sees is known after it; nothing is forgotten."""
        run = xa.sightseer(xa.load(name))
        before: set[tuple[int, str]] = set()
        for count, piece in enumerate(run.path, 1):
            chart = run.memory.after(count)
            for u in (Q(1, 7), Q(1, 2)):
                for (i, k), spans in isovist(run.scene, piece.point(u), run.radius).seen().items():
                    for a, b in spans:
                        assert chart.knows(i, a)
                        assert chart.knows(i, b)
                        if isinstance(run.scene.obstacles[i].edges[k], Segment):
                            assert chart.knows(i, a + (b - a) * Q(1, 3))
            ends = {(i, str(p)) for i in chart.seen for part in chart.known(i) for p in (part.start,)}
            lost = {(i, p) for i, p in before if i in chart.incomplete} - ends
            assert not {x for x in lost if not chart.knows(x[0], place_of(x[1]))}
            before = ends

    @examples(4, 100)
    @given(terrains())
    def test_links_after_a_loop_are_on_the_map(self, terrain: Terrain) -> None:
        """v on the map equals v on the scene: once a boundary is walked, its shortest segments are known."""
        run = explored(terrain)
        if run is None:
            return
        graph = xa.visibility_graph(run.scene, run.radius)
        for count, event in loops(run):
            chart = run.memory.after(count)
            for j in graph.neighbors(event):
                if j == "S":
                    continue
                link = graph.edges[event, j]["link"]
                for end, k in (
                    (graph.edges[event, j]["hit"], link.target),
                    (graph.edges[event, j]["leave"], link.source),
                ):
                    assert chart.knows(k, end)

    @pytest.mark.parametrize("name", ["squares", "circles", "m8", "m11"])
    def test_floats_decide_nothing(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        """With the switch by which floats decide nothing, every event and interval is the same."""
        scene = xa.load(name)
        usual = xa.sightseer(scene)
        monkeypatch.setattr(kernel, "EXACT_ONLY", True)
        exact = xa.sightseer(scene)
        assert [told(e) for e in exact.events] == [told(e) for e in usual.events]
        assert parts(exact.map, exact) == parts(usual.map, usual)


class TestMoments:
    def test_the_map_grows_along_a_piece(self) -> None:
        run = xa.sightseer(xa.load("m11"))
        lengths = [run.map_at(Q(k)).known_length() for k in range(0, 139, 6)]
        assert all(a <= b for a, b in pairwise(lengths))
        assert run.map_at(run.length).known_length() == run.map.known_length()

    def test_an_event_and_its_length_are_one_moment(self) -> None:
        run = xa.sightseer(xa.load("figure1"))
        for event in run.events:
            assert parts(run.map_at(event), run) == parts(run.map_at(event.at), run)

    def test_bad_moments(self) -> None:
        run = xa.sightseer(xa.load("figure1"))
        for moment in (-1, 1000):
            with pytest.raises(ValueError, match="no place"):
                run.map_at(moment)
        other = xa.sightseer(xa.load("circles")).events[2]
        for ask in (run.map_at, run.view_at):
            with pytest.raises(ValueError, match="an event of another run"):
                ask(other)
        again = pickle.loads(pickle.dumps(run.events[3]))
        assert run.map_at(again).known_length() == run.map_at(run.events[3]).known_length()

    def test_a_moment_at_the_start_of_a_full_circle(self) -> None:
        """Its parameter is 0 and 4: a walk that ends there has the end's. (Once all of it was known.)

        Half the circle was walked, and from the start a part of the other half was seen.
        """
        run = xa.sightseer(
            Scene([Circle((0, 0), 1), Polygon([(6, -1), (7, -1), (7, 1), (6, 1)])], start=(-3, 0)), 6
        )
        event = Event(EventKind.MOMENT, Point(1, 0), None, 1, run.path, inside=True)
        assert float(run.map_at(event).known_length(0)) == pytest.approx(np.pi + np.arccos(1 / 3))


class TestEndOnAndPinched:
    def test_an_edge_after_a_smooth_joint_is_seen_end_on(self) -> None:
        """Where an arc runs on into a straight edge there is no corner, but a line along the edge."""
        slot = Outline([(0, 0), (3, 0, 1), (3, 2), (0, 2)])
        memory = walked(Scene([slot]), 5, (5, 3), (5, 1))
        assert (2, "(3, 2)", "(0, 2)") in known(memory, 1, 0)

    def test_a_pinched_line_touches_an_arc_in_single_points(self) -> None:
        """The ends of a half disc's arc lie on the line y = 1; that does not show the arc between them."""
        scene = Scene([Outline([(0, 1, 1), (2, 1)]), Polygon([(5, 1), (6, 1), (5, 2)])])
        memory = Memory(scene, scene_radius(10))
        memory.begin(Point(5, 2))
        edge = scene.obstacles[1].edges[2]
        memory.walk(Piece("boundary", 1, edge))
        chart = memory.after(1)
        assert chart.knows(0, Point(0, 1))
        assert not chart.knows(0, Point(1, 0))

    def test_the_obstacle_ahead_stays_in_sight(self) -> None:
        """Straight towards a corner at the very range: the way's own line shows it all the time."""
        scene = Scene([Polygon([(5, 5), (8, 5), (8, 8), (5, 8)])], start=(13, 8))
        assert [r[:1] for r in reports(xa.sightseer(scene, 5), 0)] == [("sight",), ("acquire",)]

    def test_beyond_a_corner_at_the_end_of_the_way(self) -> None:
        """The way y = 6 ends at a corner that it grazes: the wall x = 10 is seen past it from 7 away."""
        scene = Scene(
            [Polygon([(5, 5), (8, 5), (5, 6)]), Polygon([(10, 5), (11, 5), (11, 8), (10, 8)])], start=(1, 6)
        )
        assert reports(xa.sightseer(scene, 7), 1)[0][:2] == ("sight", "2")

    def test_tiny_gap(self) -> None:
        """Through a slit of 10^-60 the wall behind is seen as far as lines through the slit meet it."""
        e = Q(1, 10**60)
        scene = Scene(
            [
                Polygon([(-9, 2), (0, 2), (0, 3), (-9, 3)]),
                Polygon([(e, 2), (9, 2), (9, 3), (e, 3)]),
                Polygon([(-9, 5), (9, 5), (9, 6), (-9, 6)]),
            ]
        )
        memory = walked(scene, 20, (-1, 0), (1, 0))
        (part,) = memory.after(1).known(2)
        assert part.length < Length(10 * e)
        assert part.length > Length(e)


def scene_radius(radius: object) -> object:
    return Scene([], radius=radius).radius


def told(event: Event) -> tuple[str, int | None, str, int, bool]:
    return event.kind, event.obstacle, event.note, event.after, event.inside


def parts(chart: object, run: Run) -> list[tuple[int, int, str, str]]:
    """All known parts with ends to 30 digits."""
    return [
        (i, part.edge, digits(part.start), digits(part.end))
        for i in range(len(run.scene.obstacles))
        for part in chart.known(i)  # type: ignore[attr-defined]
    ]


def digits(point: Point) -> str:
    return f"{point.x.decimal(30)} {point.y.decimal(30)}"


def split(piece: Piece) -> list[Piece]:
    middle = piece.point(Q(1, 3))
    curve = piece.curve
    return [
        Piece(piece.kind, piece.obstacle, curve.part(curve.start, middle)),
        Piece(piece.kind, piece.obstacle, curve.part(middle, curve.end)),
    ]


def place_of(text: str) -> Point:
    import sympy

    x, y = sympy.sympify(text)
    return Point(Real(str(x)), Real(str(y))) if x.is_Rational and y.is_Rational else Point(0, 0)


def loops(run: Run) -> list[tuple[int, int]]:
    """For every visit the number of pieces after its loop, and the obstacle."""
    found, pending = [], None
    for event in run.events:
        if event.kind == "hit":
            pending = event
        elif event.kind in ("leave", "stop") and pending is not None:
            perimeter = run.scene.obstacles[pending.obstacle].perimeter
            done, count = Length(0), pending.after
            while done < perimeter:
                done, count = done + run.path[count].length, count + 1
            found.append((count, pending.obstacle))
            pending = None
    return found


def explored(terrain: Terrain) -> Run | None:
    try:
        return None if terrain.start is None else xa.sightseer(terrain.scene(), terrain.radius)
    except InvalidScene:
        return None


def law_of_the_audit(terrain: Terrain) -> None:
    run = explored(terrain)
    if run is not None:
        xa.audit(run, samples=12)


def test_a_moment_inside_an_arc_is_near_the_length() -> None:
    # The point of a circle after a rational length of it is transcendental: an algebraic one is taken.
    run = xa.sightseer(xa.load("circles"))
    for length in (0, 1, "7/2", 5, 12, 17, 40):
        event = run.near(length)
        assert abs(event.at - Length(length)) < Length("1e-12")
        assert run.map_at(event).known_length() <= run.map.known_length()
    assert run.near(1).at == 1
    with pytest.raises(ValueError, match="no coordinates"):
        run.map_at(run.near(1).at + 2 + run.scene.obstacles[0].perimeter / 37)
    with pytest.raises(ValueError, match="no place"):
        run.near(1000)


def test_a_line_that_only_grazes_is_sighted_from_free_space_beyond_its_corners() -> None:
    """Three corners in a row, the first on the left of their line: no neighbour of the line shows the third.

    Nothing stands behind the first corner, so the line comes from free space, where a way crosses it.
    """
    shapes = [
        Polygon([(5, 5), (6, 5), (6, 7), (5, 7)]),
        Polygon([(3, 2), (4, 2), (4, 5), (3, 5)]),
        Polygon([(0, 4), (2, 4), (2, 5), (0, 5)]),
    ]
    way = Piece("straight", None, Segment(Point(-1, 0), Point(-1, 3)))
    memory = Memory.of(Scene(shapes), fmpq(20), way.start, [way])
    seen = [(r.kind.name, str(r.place)) for r in memory.reports if r.obstacle == 0]
    assert seen == [("SIGHT", "(-1, 1)"), ("LOSE", "(-1, 1)")]


def test_the_normal_of_a_way_where_it_touches_a_circle_meets_the_circle_there() -> None:
    """The way's middle is where it touches: its normal starts on the circle, and does not miss it."""
    way = Piece("straight", None, Segment(Point(0, 3), Point(0, 10)))
    scene = Scene([Circle((Fraction(3, 2), Fraction(13, 2)), Fraction(3, 2))])
    (known,) = Memory.of(scene, fmpq(1), way.start, [way]).after(1).known(0)
    assert (str(known.start), str(known.end)) == ("(1, sqrt(2) + 13/2)", "(1, 13/2 - sqrt(2))")


def test_a_way_that_touches_a_corner_sees_what_only_the_corner_bounds() -> None:
    """The inner arc of a crescent whose tip is on the way: from places before the tip, up to the range."""
    crescent = Outline([(0, Fraction(13, 2), -1), (1, Fraction(13, 2), Fraction(1, 2))])
    way = Piece("straight", None, Segment(Point(0, 0), Point(0, 8)))
    chart = Memory.of(Scene([crescent]), fmpq(5), way.start, [way]).after(1)
    inner = next(k for k, e in enumerate(Scene([crescent]).obstacles[0].edges) if not e.ccw)
    assert [(str(i.start), str(i.end)) for i in chart.known(0) if i.edge == inner] == [
        ("(0, 13/2)", "(1, 13/2)")
    ]


def test_normals_of_an_arc_meet_a_way_along_one_of_them_in_the_centre() -> None:
    """Nothing is seen from the start of the way, farther than the range from the middle of the dent."""
    dented = Outline([(13, 1, Fraction(-1, 5)), (13, -1), (16, -1), (16, 1)])
    way = Piece("straight", None, Segment(Point(9, 0), Point(12, 0)))
    memory = Memory.of(Scene([dented]), fmpq(3), way.start, [way])
    seen = [(r.kind.name, str(r.place)) for r in memory.reports]
    assert seen == [("SIGHT", "(13 - 2*sqrt(2), 0)")]


def test_the_start_of_a_circle_is_seen_along_the_way_from_as_far_as_the_range() -> None:
    """The circle's start, at both ends of its parameters, is on the line of the way and of an edge."""
    bar = Polygon([(6, 1), (9, 1), (9, 2), (6, 2)])
    way = Piece("straight", None, Segment(Point(12, 1), Point(9, 1)))
    memory = Memory.of(Scene([bar, Circle((4, 1), 1)]), fmpq(5), way.start, [way])
    assert [str(r.place) for r in memory.reports if r.obstacle == 1] == ["(10, 1)"]


def test_a_line_along_an_edge_ends_at_a_wall_whose_back_is_out_of_reach() -> None:
    """From (4, 5/4) the lower edge of the stadium is seen end on, past its tangent arc."""
    wall = Polygon([(2, 1), (4, 1), (4, 3), (2, 3)])
    x, y = (Fraction(21, 4), Fraction(23, 4)), (Fraction(5, 4), Fraction(7, 4))
    stadium = Outline([(x[0], y[0]), (x[1], y[0], 1), (x[1], y[1]), (x[0], y[1], 1)])
    way = Piece("boundary", 0, Segment(Point(4, 1), Point(4, 3)))
    chart = Memory.of(Scene([wall, stadium]), fmpq(3, 2), way.start, [way]).after(1)
    ends = {str(end) for part in chart.known(1) for end in (part.start, part.end)}
    assert {"(11/2, 5/4)", "(11/2, 7/4)"} <= ends


def test_the_map_on_a_way_that_touches_an_arc() -> None:
    """The last of the arc's tangents is the way itself: the ones before it meet it at the point of touch.

    It passes the way's end too, which was taken for the place where the others meet the way.
    """
    bow = Outline([(3, 6, Q(1, 5)), (3, 1), (4, 1), (4, 6)])
    scene, start, place, end = Scene([bow]), (Q(5, 2), 13), (Q(5, 2), 5), (Q(5, 2), 0)
    whole = walked(scene, Q(5, 2), start, end).within(0, Point(*place))
    halves = walked(scene, Q(5, 2), start, place, end).after(1)
    assert [(p.edge, str(p.start), str(p.end)) for p in whole.known(0)] == [
        (p.edge, str(p.start), str(p.end)) for p in halves.known(0)
    ]


def test_a_circle_s_start_alone_is_not_told_beside_its_end() -> None:
    """Both are one point: seen from either side, it was a part of its own beyond the last one."""
    rails = [Rail(Scene([Circle((0, 0), 1)]).obstacles[0].edges[0])]
    start, left = rails[0].curve.start, rails[0].point(fmpq(2))
    alone = [Interval(u, start, u, start) for u in (Real(0), Real(4))]
    first, second = Interval(Real(0), start, Real(2), left), Interval(Real(2), left, Real(4), start)
    table = EdgeTable(Scene([Circle((0, 0), 1)]).obstacles)
    for cover, ends in (
        ((first, alone[1]), [(start, left)]),
        ((alone[0], second), [(left, start)]),
        ((alone[0], alone[1]), [(start, start)]),
    ):
        chart = Map(table.obstacles, Targets.whole(table, rails), rails, {0: Cover(cover)})
        assert [(p.start, p.end) for p in chart.known(0)] == ends
        assert sorted(map(str, (p for _, p in chart.frontier))) == sorted({str(p) for p in ends[0]})


def test_the_map_where_a_line_along_the_way_touches_another_circle() -> None:
    """At these events of a real part the robot, on one arc, sees another one along their common tangent.

    Its point there came in two forms, from the view and from a family, whose equality took minutes to prove.
    """
    run = xa.sightseer(xa.load("plate"))
    for number in (13, 21, 24, 26):
        assert run.map_at(run.events[number]).known_length() < run.map.known_length()


def test_a_way_along_an_edge_sees_from_its_corner_what_the_corner_sees() -> None:
    """The end of the edge, met with an equal parameter that was another object, was taken for an inner point.

    From the tip beside the dent all of the dent is seen, from inside the edge nothing of it.
    """
    dented = Outline([(3, 3), (3, 4, 1), (4, 4), (4, 3)])
    chart = walked(Scene([dented]), Q(2), (4, 0), (4, 3), (4, 4)).after(2)
    dent = next(k for k, e in enumerate(Scene([dented]).obstacles[0].edges) if not isinstance(e, Segment))
    assert [(str(p.start), str(p.end)) for p in chart.known(0) if p.edge == dent] == [("(4, 4)", "(3, 4)")]


def test_a_line_past_two_corners_ends_at_a_wall_that_is_just_out_of_reach_of_one() -> None:
    """The line by (6, 4) and (4, 5) meets a wall at (1, 13/2), farther than the range from the first corner.

    What is behind the wall was not looked at from there, but for the corner (0, 7): it seemed to be seen.
    """
    shapes = [
        Polygon([(6, 7), (7, 7), (6, 4)]),
        Polygon([(1, 7), (0, 7), (0, Q(27, 4)), (Q(3, 4), Q(27, 4)), (Q(3, 4), 6), (1, 6)]),
        Polygon([(4, 5), (4, 3), (3, 3), (3, 5)]),
    ]
    chart = walked(Scene(shapes), Q(5), (5, 6), (4, 5)).after(1)
    assert not chart.knows(1, Point(0, 7))
    assert chart.knows(1, Point(1, Q(13, 2)))


@pytest.mark.parametrize("bend", [0, xa.Around((Q(1, 2), 0), ccw=False)], ids=["edges", "cusp"])
def test_a_single_view_past_a_tip(bend: object) -> None:
    """From (5, sqrt 2) alone a line touches two discs on one side and passes a tip on its other side.

    A tip that is a cusp, whose edges leave it side by side, was taken for a place where the line enters.
    """
    tip = [(1, 0, xa.Around((0, 0))), (0, 1), (0, Q(1, 2))]
    horn = Outline([*tip, (Q(1, 2), Q(1, 2), bend)] if bend else [(1, 0), *tip[1:], (Q(1, 2), Q(2, 5))])
    scene = Scene([Circle((Q(-1, 2), 0), Q(1, 2)), Circle((4, 0), 1), horn], start=(5, 3), radius=Q(13, 2))
    run = xa.explore(scene, lambda robot: robot.go_to((5, 1)))
    seen = Point(Q(-1, 3), -Real(2).sqrt() / 3)
    assert isovist(scene, Point(5, Real(2).sqrt()), Q(13, 2)).contains(seen)
    assert run.map.knows(0, seen)
    here = [event for event in run.events if event.obstacle == 0]
    assert [event.kind for event in here] == [EventKind.SIGHT, EventKind.LOSE]
    assert all(event.point == Point(5, Real(2).sqrt()) for event in here)
