"""Round rooms: ways through the centre, which all normals of the wall pass, and views from the wall."""

from __future__ import annotations

from fractions import Fraction as Q
from random import Random

import pytest
from map_oracle import Answer, known, spots
from nightly import some

import exactacq as xa
from exactacq import kernel
from exactacq.numbers.real import Real
from exactacq.scene.shapes import Shape

WAYS = [((1, 1), (-1, -1)), ((-1, 2), (Q(1, 2), -1)), ((3, -4), (-3, 4)), ((0, 5), (0, -1))]
ARC = xa.Outline([(4, -3, 2), (-4, -3)])
"""More than half of a circle of radius 5 about the origin, and its chord."""


@pytest.mark.parametrize("more", [0, 1, 6])
@pytest.mark.parametrize(("start", "stop"), WAYS)
def test_a_way_through_the_centre(start: tuple[int, int], stop: tuple[object, object], more: int) -> None:
    """The wall opposite is seen as far as the range exceeds the room's radius.

    Of the two places where the way's line meets the wall, normals of the wall took the one for the other.
    """
    room = xa.Scene([], start=start, enclosure=xa.Circle((0, 0), 6), radius=6 + more)
    run = xa.explore(room, lambda robot: robot.go_to(stop))
    away = Real(start[0] ** 2 + start[1] ** 2).sqrt()
    (acquired,) = (event for event in run.events if event.kind == "acquire")
    assert acquired.at == max(away - more, Real(0))
    xa.audit(run)


@pytest.mark.parametrize("room", [xa.Circle((0, 0), 5), ARC])
@pytest.mark.parametrize("seed", some(range(12), 4))
def test_what_is_known_past_the_centre(room: Shape, seed: int) -> None:
    """Of obstacles in a room, and of its wall, against an oracle: parts of the wall were known too early."""
    rng = Random(seed)
    a, b = rng.choice([(1, 1), (1, 2), (2, -1), (-3, 1)])
    start, stop = (Q(a, 2), Q(b, 2)), (-a, -b)
    radius, shapes = rng.choice([5, 6, 10, 20]), list[Shape]()
    for _ in range(40):
        x, y, size = (Q(rng.randint(-8, 8), 2) for _ in range(3))
        shape: Shape = xa.Circle((x, y), Q(1, 2))
        if size > 0:
            shape = xa.Polygon([(x, y), (x + 1, y), (x + 1, y + 1)])
        try:
            xa.Scene([*shapes, shape], start=start, enclosure=room)
        except xa.InvalidScene:
            continue
        shapes.append(shape)
        if len(shapes) == 3:
            break
    scene = xa.Scene(shapes, start=start, enclosure=room, radius=radius)
    run = xa.explore(scene, lambda robot: robot.go_to(stop))
    samples = spots(scene, [Q(1, 7), Q(1, 2), Q(5, 6)])
    for share in (0.5, 0.7, 0.999):
        moment = run.near(float(run.length) * share)
        way = [xa.Segment(scene.start, moment.point)]
        found = run.map_at(moment)
        for sample, answer in zip(samples, known(scene, radius, way, samples), strict=True):
            if answer != Answer.CLOSE:
                assert found.knows(sample.obstacle, sample.point) == (answer == Answer.YES), (share, sample)


def test_a_view_from_the_centre_is_as_long_as_the_range() -> None:
    """Discs in mirrored places; the robot, on its way from one to another, passes the centre of the wall.

    That the view from there past a disc is as long as the range is known; as a zero of the length it was a
    number of degree 160, equal to an end of what was known of the wall.
    """
    discs = [xa.Circle(center, Q(1, 2)) for center in ((4, -3), (-4, 3), (1, 2), (-1, -2))]
    room = xa.Scene(discs, start=(1, -1), enclosure=xa.Circle((0, 0), 8), radius=8)
    run = xa.explore(room, "nearest-frontier")
    assert not run.map.incomplete
    xa.audit(run)


def test_the_far_end_of_a_slot_comes_into_range() -> None:
    """A slot with round ends, from whose straight side the middle of one end is the last to be seen.

    What is not known there shrinks from both sides, to the point where the circle of the range touches the
    end from inside. Only normals tell the place, and they are not asked for what is shown: the slot was
    acquired too early.
    """
    slot = xa.Outline([(-3, 2), (Q(-9, 13), Q(-46, 13), 1), (3, -2), (Q(9, 13), Q(46, 13), 1)])
    run = xa.sightseer(xa.Scene([], start=(Q(15, 26), Q(-18, 13)), enclosure=slot, radius=6))
    (acquired,) = (event for event in run.events if event.kind == "acquire")
    assert acquired.at == Q(13, 2) - 2 * Real(3).sqrt()
    xa.audit(run)


@pytest.mark.parametrize("seed", some(range(48), 12))
def test_slots_are_acquired_when_all_is_seen(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Walks along their walls, within many ranges, as by exact numbers alone: one in four differed."""
    rng = Random(seed)
    half, end = Q(rng.randint(2, 12), 2), Q(rng.randint(2, 6), 2)
    slot = xa.Outline([(-half, -end), (half, -end, 1), (half, end), (-half, end, 1)])
    radius = end + Q(rng.randint(1, 24), 3)
    start = rng.choice((-1, 1)) * half / rng.randint(2, 5), rng.choice((-1, 0, 1)) * end / 2
    scene = xa.Scene([], start=start, enclosure=slot, radius=radius)
    run = xa.sightseer(scene)
    xa.audit(run)
    told = [(event.kind, event.at) for event in run.events]
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    assert [(event.kind, event.at) for event in xa.sightseer(scene).events] == told


@pytest.mark.parametrize("radius", [12, 13, 30])
@pytest.mark.parametrize("point", [(6, 0), (0, -6), ("18/5", "-24/5")])
def test_a_view_from_the_wall(point: tuple[object, object], radius: int) -> None:
    """All of the wall is seen, as one piece: its two halves meet opposite the point.

    Both had a number of their own for that place, and an arc of the range stood between them.
    """
    view = xa.isovist(xa.Scene([], enclosure=xa.Circle((0, 0), 6)), point, radius)
    assert [piece.kind.value for piece in view.pieces] == ["edge"]
    assert view.area == xa.Length.turns(36, Q(1, 2)) and view.perimeter == xa.Length.turns(12, Q(1, 2))


@pytest.mark.parametrize(
    ("start", "stops"),
    [
        ((Q(144, 13), Q(-153, 26)), [(Q(-264, 13), Q(53, 26)), (0, 0)]),
        ((5, -2), [(3, -5), (0, 0)]),
        ((6, -5), [(0, Q(-7, 2)), (0, 0)]),
    ],
)
@pytest.mark.parametrize("has_disc", [True, False])
def test_ways_to_half_a_ring(start: tuple[object, object], stops: list[object], has_disc: bool) -> None:
    """The ring's arcs have one centre, with the disc in it.

    Of the length of views along its tangents one formula told less of a part of a cell than another of the
    whole: the zero there was refined no more, and the runs did not end.
    """
    about = xa.Around((0, 0))
    inward = xa.Around((0, 0), ccw=False)
    ring = xa.Outline(
        [
            (Q(-72, 13), Q(-30, 13), about),
            (Q(18, 5), Q(-24, 5), 1),
            (3, -4, inward),
            (Q(-60, 13), Q(-25, 13), 1),
        ]
    )
    scene = xa.Scene([ring, xa.Circle((0, 0), 4)] if has_disc else [ring], start=start, radius=1)

    def go(robot: xa.Robot) -> None:
        for stop in stops:
            robot.go_to(stop)

    xa.audit(xa.explore(scene, go))
