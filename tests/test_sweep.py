"""The sweep along a piece: its events by hand, and its cells against isovists made from scratch."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from fractions import Fraction
from random import Random
from subprocess import run as run_process

import pytest
from flint import fmpq
from nightly import NIGHTLY, some
from strategies import arc_terrain, degenerate_terrain, random_terrain
from swept_edges import check_edges

import exactacq as xa
from exactacq import Circle, Point, Polygon, Scene
from exactacq.errors import InvalidScene
from exactacq.geometry.curves import Arc, Segment
from exactacq.numbers.between import rational_between
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.sensing.view_events import Change, Sweep, SweepCell, sweep
from exactacq.visibility.outline import ViewKind

BITS = 600
"""Points made in two ways, as roots of different polynomials, count as equal if so many bits agree."""


def same(p: Point | None, q: Point | None) -> bool:
    if p is None or q is None:
        return p is q
    return all(
        (a - b).ball(BITS).contains(0) and (a - b).ball(BITS).rad() < 1e-100
        for a, b in zip(p, q, strict=True)
    )


def test_assertions_do_nothing_but_assert() -> None:
    """Python leaves them out with -O. One put the places of a leg in order."""
    wall, beyond = "[(2, 0), (4, 0), (4, 1), (2, 1)]", "[(5, -3), (6, -3), (6, -2), (5, -2)]"
    code = f"""
import exactacq as xa
scene = xa.Scene([xa.Polygon({wall}), xa.Polygon({beyond})])
swept = xa.sweep(scene, xa.Segment(xa.Point(0, 0), xa.Point(8, 0)), radius=6)
print([(event.change.value, event.edge, event.leg, str(event.place)) for event in swept.events])
"""
    told = [
        run_process([sys.executable, *options, "-c", code], capture_output=True, text=True, check=True).stdout
        for options in ([], ["-O"])
    ]
    assert told[0] == told[1] and "reappearance" in told[0]


def seen_through(
    scene: Scene, radius: object, cell: SweepCell, u: object
) -> list[tuple[Point, Point | None]]:
    """The windows of a view made from scratch: what the sweep leaves out is left out."""
    point, line = cell.point(u), cell.rail.curve
    square = Point(radius, 0).norm_sq()
    found = []
    for window in xa.isovist(scene, point, radius).pieces:
        if window.kind is not ViewKind.WINDOW:
            continue
        near, ends = window.near, (window.curve.start, window.curve.end)
        far = next(p for p in ends if p != near)
        beyond = (far - point).norm_sq().compare(square) == 0
        on_own_line = isinstance(line, Segment) and line.direction.cross(near - point).sign() == 0
        if not on_own_line and not (beyond and near == point):
            found.append((near, None if beyond else far))
    return found


def check_cells(scene: Scene, radius: object, piece: Piece) -> int:
    """In the middle of every cell edges and windows are those of the isovist, and all it sees was taught."""
    swept = sweep(scene, piece.curve, radius, obstacle=piece.obstacle)
    assert check_edges(scene, radius, swept) == len(swept.cells)
    for cell in swept.cells:
        u = rational_between(cell.low, cell.high)
        mine, its = cell.windows(u), seen_through(scene, radius, cell, u)
        assert len(mine) == len(its)
        for near, far in its:
            assert any(same(near, n) and same(far, f) for n, f in mine), (piece, u, near, far)
        for (i, e), spans in xa.isovist(scene, cell.point(u), radius).seen().items():
            for start, end in spans:
                assert cell.map.knows(i, start)
                assert cell.map.knows(i, end)
                middle = middle_of(scene.obstacles[i].edges[e], start, end)
                assert middle is None or cell.map.knows(i, middle)
    return len(swept.cells)


def middle_of(edge: Segment | Arc, start: Point, end: Point) -> Point | None:
    """A rational point of a part of an edge, where that is easy to have."""
    if start == end or start.rational is None or end.rational is None:
        return None
    return edge.part(start, end).point(xa.Real(1).rational / 2)


def pieces(terrain: object, count: int) -> Iterator[tuple[Scene, object, Piece]]:
    scene = terrain.scene()
    run = xa.sightseer(scene, terrain.radius)
    for piece in run.path[:count]:
        yield scene, terrain.radius, piece


def events(swept: Sweep) -> list[tuple[str, int, int, str]]:
    return [(e.change.value, e.obstacle, e.edge, str(e.place.x)) for e in swept.events]


def test_past_a_square() -> None:
    # The far corner of its lower side comes into range, then the sides are seen end on from x = 4 and x = 6.
    # In the end the near corner of the lower side goes out of range, but not the rest of it.
    scene = Scene([Polygon([(4, 1), (6, 1), (6, 3), (4, 3)])])
    swept = sweep(scene, Segment(Point(0, 0), Point(10, 0)), 5)
    assert events(swept) == [
        ("turning", 0, 0, "6 - 2*sqrt(6)"),
        ("turning", 0, 0, "4"),
        ("occlusion", 0, 3, "4"),
        ("turning", 0, 0, "6"),
        ("reappearance", 0, 1, "6"),
        ("turning", 0, 0, "4 + 2*sqrt(6)"),
    ]
    assert [str(cell.begin[1].x) for cell in swept.cells] == ["0", "6 - 2*sqrt(6)", "4", "6", "4 + 2*sqrt(6)"]


def test_a_circle_within_range_for_a_while() -> None:
    # From 5 - x = sqrt(7^2 - 5^2) on its nearest point is 4 away.
    swept = sweep(Scene([Circle((5, 5), 3)]), Segment(Point(0, 0), Point(10, 0)), 4)
    assert [event.change for event in swept.events] == [Change.ENTRY, Change.EXIT]
    assert [str(event.place.x) for event in swept.events] == ["5 - 2*sqrt(6)", "2*sqrt(6) + 5"]


def test_a_way_tangent_to_a_circle() -> None:
    """The way is itself one of the tangents that sweep over it; the other ones cross it near the contact."""
    swept = sweep(Scene([Circle((5, 1), 1)]), Segment(Point(6, 6), Point(6, -6)), 2)
    places = [str(e.place) for e in swept.events]
    assert places == ["(6, 1 + 2*sqrt(2))", "(6, 3)", "(6, -1)", "(6, 1 - 2*sqrt(2))"]
    assert [str(known.start) for known in swept.cells[2].map.known(0)] == ["(6, 1)", "(22/5, 1/5)"]


def test_events_come_as_the_robot_passes_them() -> None:
    scene = Scene([Polygon([(4, 1), (6, 1), (6, 3), (4, 3)])])
    there = sweep(scene, Segment(Point(0, 0), Point(10, 0)), 5)
    back = sweep(scene, Segment(Point(10, 0), Point(0, 0)), 5)
    opposite = {
        Change.ENTRY: Change.EXIT,
        Change.EXIT: Change.ENTRY,
        Change.OCCLUSION: Change.REAPPEARANCE,
        Change.REAPPEARANCE: Change.OCCLUSION,
        Change.TURNING: Change.TURNING,
    }
    assert {(e.change, e.edge, str(e.place)) for e in there.events} == {
        (opposite[e.change], e.edge, str(e.place)) for e in back.events
    }
    assert [float(e.place.x) for e in back.events] == sorted(
        (float(e.place.x) for e in back.events), reverse=True
    )
    assert back.cells[0].begin[1] == Point(10, 0)


def test_a_full_circle_is_two_legs_when_its_start_is_passed() -> None:
    scene = Scene([Circle((0, 0), 1), Circle((4, 0), 1)])
    (edge,) = scene.obstacles[0].edges
    half = edge.part(Point(0, -1), Point(0, 1))
    swept = sweep(scene, half, 5, obstacle=0)
    assert {cell.leg for cell in swept.cells} == {0, 1}
    assert swept.cells[0].begin[1] == Point(0, -1)
    assert swept.cells[-1].end[1] == Point(0, 1)


@pytest.mark.parametrize("make", [random_terrain, degenerate_terrain, arc_terrain])
@pytest.mark.parametrize("seed", some([0, 1, 3, 4, 5], 2))
def test_every_cell_has_the_views_of_isovists(make: object, seed: int) -> None:
    cases = list(pieces(make(Random(seed)), 12 if NIGHTLY else 7))
    assert sum(check_cells(*case) for case in cases) > len(cases)


@pytest.mark.parametrize("make", [random_terrain, degenerate_terrain])
@pytest.mark.parametrize("seed", some(range(4), 1))
def test_cells_together_teach_what_the_piece_teaches(make: object, seed: int) -> None:
    for scene, radius, piece in pieces(make(Random(seed)), 8):
        memory = Memory(scene, xa.Scene([], radius=radius).radius)
        memory.walk(piece)
        whole, cells = memory.after(1), sweep(scene, piece.curve, radius, obstacle=piece.obstacle).cells
        for i in range(len(scene.obstacles)):
            parts = [known for cell in cells for known in cell.map.known(i)]
            for known in whole.known(i):
                assert any(same(known.start, p) for part in parts for p in (part.start, part.end))
            for part in parts:
                assert whole.knows(i, part.start)
                assert whole.knows(i, part.end)


def test_a_room_without_any_convex_corner() -> None:
    """There are no features at all, and no view is held: the walls behind and ahead pass the range."""
    room = Scene([], enclosure=Polygon([(0, 0), (10, 0), (10, 10), (0, 10)]))
    swept = sweep(room, Segment(Point(1, 5), Point(9, 5)), radius=3)
    assert [(event.change, event.place.x) for event in swept.events] == [
        (Change.EXIT, Point(3, 0).x),
        (Change.ENTRY, Point(7, 0).x),
    ]
    assert swept.events[0].edge != swept.events[1].edge


def test_errors() -> None:
    scene = Scene([Circle((5, 5), 3)])
    with pytest.raises(InvalidScene, match="radius"):
        sweep(scene, Segment(Point(0, 0), Point(1, 0)))
    with pytest.raises(ValueError, match="obstacle"):
        sweep(scene, scene.obstacles[0].edges[0], 2)
    for number in (-1, 1):
        with pytest.raises(ValueError, match=f"no obstacle number {number}"):
            sweep(scene, scene.obstacles[0].edges[0], 2, obstacle=number)
    with pytest.raises(ValueError, match="without length"):
        sweep(scene, Segment(Point(0, 0), Point(0, 0)), 2)


def test_where_a_way_touches_a_corner() -> None:
    """Below it sees the lower side of the triangle, above the upper one: both change in the corner."""
    scene = Scene([Polygon([(0, 1), (2, 0), (2, 2)])])
    swept = sweep(scene, Segment(Point(0, -1), Point(0, 3)), radius=10)
    assert [(e.change, e.edge, e.leg, e.place) for e in swept.events] == [
        (Change.OCCLUSION, 0, 1, Point(0, 1)),
        (Change.REAPPEARANCE, 2, 1, Point(0, 1)),
    ]
    assert [cell.leg for cell in swept.cells] == [0, 1]


def test_where_a_way_touches_an_arc() -> None:
    """Before the way touches the upper arc it sees of the lower one a single point, past the upper one."""
    scene = Scene([xa.Outline([(2, 1, 1), (2, 2, 1), (2, 3), (1, 2)])])
    piece = Piece("straight", None, Segment(Point("5/2", 4), Point("5/2", 0)))
    assert check_cells(scene, "5/2", piece) == 8
    found = [(e.change, e.edge, e.place) for e in sweep(scene, piece.curve, "5/2").events]
    assert (Change.REAPPEARANCE, 0, Point("5/2", "5/2")) in found
    assert (Change.OCCLUSION, 1, Point("5/2", "3/2")) in found


@pytest.mark.parametrize("x", ["-1/4", "1/4", -1, 2])
def test_rays_from_a_reflex_corner_stay_outside(x: object) -> None:
    """Left of the bracket its arm hides both walls at the corner (1, 1), right of it both are seen."""
    bracket = Scene([Polygon([("1/2", 0), (4, 0), (4, 1), (1, 1), (1, 4), ("1/2", 4)])])
    assert check_cells(bracket, 3, Piece("straight", None, Segment(Point(x, 5), Point(x, "9/8")))) > 1


def test_along_the_side_of_a_square() -> None:
    """The side itself is in sight all along, end on at first and last."""
    scene = Scene([Polygon([(1, 1), (2, 1), (2, 2), (1, 2)])])
    swept = sweep(scene, Segment(Point(1, 0), Point(1, 4)), radius=10)
    assert [(e.change, e.edge, e.leg, e.place) for e in swept.events] == [
        (Change.OCCLUSION, 0, 1, Point(1, 1)),
        (Change.REAPPEARANCE, 2, 2, Point(1, 2)),
    ]


def test_an_arc_next_to_an_edge_that_is_all_but_smooth() -> None:
    """Along the wall its rounded corner is seen past the vertex between, which sticks out by 10^-11."""
    scene = xa.load("plate")
    wall = scene.obstacles[14].edges[5]
    rounded = [e for e in sweep(scene, wall, 60, obstacle=14).events if (e.obstacle, e.edge) == (14, 6)]
    assert [event.change for event in rounded] == [Change.ENTRY]
    assert check_cells(scene, 60, Piece("boundary", 14, wall)) > 10


DISC = Circle((0, -1), 1)
ROOT2 = xa.Real(2).sqrt()


def sector(*angle: object) -> xa.Outline:
    """A wall about the origin between the radii 5 and 6, from one of two unit vectors to the other."""
    corners = [[fmpq(size) * fmpq(x) for x in ends] for size in (6, 5) for ends in (angle[:2], angle[2:])]
    out, back = xa.Around((0, 0)), xa.Around((0, 0), ccw=False)
    first, second, last, third = corners
    return xa.Outline([(*first, out), second, (*third, back), last])


@pytest.mark.parametrize(
    "wall",
    [
        sector(fmpq(12, 13), fmpq(-5, 13), fmpq(12, 13), fmpq(5, 13)),
        sector(fmpq(-12, 13), fmpq(5, 13), fmpq(-12, 13), fmpq(-5, 13)),
        sector(fmpq(4, 5), fmpq(-3, 5), fmpq(-4, 5), fmpq(-3, 5)),
        Polygon([(5, -3), (7, -3), (7, 3), (5, 3)]),
        Circle((6, 0), 1),
    ],
    ids=["round on the right", "round on the left", "round about", "straight", "disc"],
)
@pytest.mark.parametrize("there", [Point(ROOT2, 1), Point(-ROOT2, 1), Point(ROOT2, 0)])
def test_from_where_a_tangent_is_normal_to_a_wall_at_the_range(wall: xa.Outline, there: Point) -> None:
    """There the length of views along tangents of the disc is stationary, and as long as the range.

    On a way beside it, which is rational, polynomials find the events.
    """
    here, scene = Point(0, 0), Scene([DISC, wall])
    near = Point(*(fmpq(round(float(x) * 10**9), 10**9) for x in there))
    for ends, beside in (((here, there), (here, near)), ((there, here), (near, here))):
        check_cells(scene, 5, Piece("straight", None, Segment(*ends)))
        told, expected = (sweep(scene, Segment(*way), 5).events for way in (ends, beside))
        assert [(e.change, e.obstacle, e.edge) for e in told] == [
            (e.change, e.obstacle, e.edge) for e in expected
        ]
        for mine, its in zip(told, expected, strict=True):
            assert [*map(float, mine.place)] == pytest.approx([*map(float, its.place)], abs=1e-6)


@pytest.mark.parametrize("u", [fmpq(1, 2), "1/2", 0.5, Fraction(1, 2)])
def test_places_of_a_cell_take_any_rational_number(u: object) -> None:
    disc = Scene([Circle((0, 0), 1), Circle((5, 0), 1)])
    boundary = sweep(disc, disc.obstacles[0].edges[0], 9, obstacle=0)
    for swept in (boundary, sweep(disc, Segment(Point(3, 3), Point(4, 4)), 9)):
        cell = swept.cells[0]
        assert cell.point(u) == cell.point(fmpq(1, 2))
        assert cell.windows(u) == cell.windows(fmpq(1, 2))


def test_a_segment_that_is_not_free_is_refused() -> None:
    """Along a rounded tangent an assertion failed. What touches an obstacle, or runs along it, is free."""
    scene = xa.Scene([xa.Polygon([(4, -1), (7, -1), (7, 3), (4, 3)]), xa.Circle((4, 6), 1)], radius=9)
    for end, words in (((5, 0), "the end .* lies inside obstacle O1"), ((9, 0), "leads through an obstacle")):
        with pytest.raises(InvalidScene, match=words):
            sweep(scene, Segment((0, 0), end))
    with pytest.raises(InvalidScene, match="leads through an obstacle"):
        sweep(scene, Segment((4, -1), (7, 3)))
    for touching in (Segment((0, 5), (9, 5)), Segment((4, 3), (7, 3)), Segment((4, 3), (4, 5))):
        assert sweep(scene, touching).cells
