"""What edges and discs hide: nothing that is left out can be seen, and runs are the same without."""

from __future__ import annotations

from random import Random

import pytest
from flint import fmpq
from nightly import some
from strategies import arc_terrain, build, circle_grid, degenerate_terrain, square_grid

import exactacq as xa
from exactacq import kernel
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.points import Location, Point
from exactacq.kernel.box_tree import box_tree
from exactacq.kernel.shadows import Shadows, lit
from exactacq.scene import edge_table
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.free_segment import is_free

FAR = 10**9
CELLS = [
    [(2 * i + x, 2 * j + y) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))] for i in range(4) for j in range(4)
]
SCENES = {
    "squares": build(square_grid(5, 4)),
    "discs": build(circle_grid(5, 3)),
    "far away": xa.Scene([xa.Polygon([(FAR + x, FAR + y) for x, y in c]) for c in CELLS]),
    **{f"degenerate {seed}": build(degenerate_terrain(Random(seed)).shapes) for seed in range(4)},
    **{f"arcs {seed}": build(arc_terrain(Random(seed)).shapes) for seed in range(4)},
}


@pytest.fixture
def always(monkeypatch: pytest.MonkeyPatch) -> None:
    """What hides is looked for everywhere."""
    monkeypatch.setattr(edge_table, "MANY", 0)
    monkeypatch.setattr(edge_table, "CLOSE", 1.0)
    monkeypatch.setattr(edge_table, "HIDING", 1.0)


@pytest.mark.usefixtures("always")
@pytest.mark.parametrize("name", some(SCENES, 4))
def test_what_is_left_out_is_hidden(name: str) -> None:
    """From places of every edge to points of every edge that is left out: exactly."""
    table, rng, tried = EdgeTable(SCENES[name].obstacles), Random(1), 0
    rails = [Rail(curve) for curve in table.curves]

    def place(e: int) -> Point:
        part = rng.choice([fmpq(0), fmpq(1), fmpq(1, 2), fmpq(rng.randrange(97), 97)])
        return rails[e].point(rails[e].top.rational * part)

    for e in range(len(table.curves)):
        for spots in (table.spots(e), (table.curves[e].start.xy,)):
            seen = table.lit(spots, 100.0)
            for other in sorted(set(range(len(table.curves))) - set(seen)):
                for _ in range(2):
                    here = table.curves[e].start if len(spots) == 1 else place(e)
                    assert not is_free(table, here, place(other))
                    tried += 1
    assert tried > 5 or "arcs" in name


@pytest.mark.parametrize("name", some(SCENES, 4))
def test_runs_are_the_same_where_nothing_is_left_out(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = SCENES[name]
    corner = scene.obstacles[0].edges[0].start
    start = next(
        (corner.x + x, corner.y + y)
        for y in range(-3, 3)
        for x in range(-3, 3)
        if all(o.locate(Point(corner.x + x, corner.y + y)) is Location.OUTSIDE for o in scene.obstacles)
    )
    found = []
    for many, close in ((0, 1.0), (10**9, 0.2)):
        monkeypatch.setattr(edge_table, "MANY", many)
        monkeypatch.setattr(edge_table, "HIDING", close)
        run = xa.sightseer(scene, 8, start=start)
        found.append([(e.kind, e.obstacle, str(e.point), str(e.path)) for e in run.events])
    assert found[0] == found[1]
    assert len(found[0]) > 5


def hidden(place: tuple[float, float], box: tuple[float, float, float, float], slack: float = 0.0) -> bool:
    """Whether the square from (1, -1) to (3, 1) hides a box from a place."""
    table = EdgeTable(xa.Scene([xa.Polygon([(1, -1), (3, -1), (3, 1), (1, 1)])]).obstacles)
    hiding = Shadows(table.images, [0, 1, 2, 3], (place,), slack)
    return lit(box_tree([box]), (*place, *place), 100.0, hiding) == []


def test_a_square_by_hand() -> None:
    """From (0, 0) its near side hides what lies beyond x = 1 strictly between the lines y = x and y = -x."""
    assert hidden((0.0, 0.0), (4.0, -1.0, 5.0, 1.0))
    assert not hidden((0.0, 0.0), (0.25, -0.1, 0.5, 0.1))
    # A corner on the line past the square's corner is seen from one place.
    assert not hidden((0.0, 0.0), (4.0, 1.0, 5.0, 4.0))
    assert hidden((0.0, 0.0), (4.0, 1.0, 5.0, 3.999))
    assert not hidden((0.0, 0.0), (4.0, 1.0, 5.0, 3.999), slack=0.01)
    # What reaches to the near side itself is seen.
    assert not hidden((0.0, 0.0), (1.0, -0.5, 2.0, 0.5))
    # Nothing is hidden from a place on the side.
    table = EdgeTable(xa.Scene([xa.Polygon([(1, -1), (3, -1), (3, 1), (1, 1)])]).obstacles)
    on_it = Shadows(table.images, [3], ((1.0, 0.0),), 0.0)
    assert lit(box_tree([(4.0, -1.0, 5.0, 1.0)]), (1.0, 0.0, 1.0, 0.0), 100.0, on_it) == [0]
    # From several places only what is hidden from all of them; from both sides of a line nothing.
    both = (0.0, -0.5), (0.0, 0.5)
    for places, box, expected in (
        (both, (2.0, -1.0, 2.5, 1.0), []),
        (both, (2.0, -1.5, 2.5, 1.5), [0]),
        (((0.0, 0.0), (2.0, 0.0)), (4.0, 0.0, 5.0, 0.1), [0]),
    ):
        hiding = Shadows(table.images, [3], places, 0.0)
        assert lit(box_tree([box]), (0.0, -0.5, 0.0, 0.5), 100.0, hiding) == expected


def test_a_disc_by_hand() -> None:
    """A disc about (3, 0) with radius 1 hides what is behind its diameter across the view."""
    table = EdgeTable(xa.Scene([xa.Circle((3, 0), 1)]).obstacles)
    hiding = Shadows(table.images, [0], ((0.0, 0.0),), 0.0)
    behind = box_tree([(6.0, -1.0, 7.0, 1.0)])
    for box, expected in (
        ((6.0, -1.0, 7.0, 1.0), []),
        ((6.0, 1.0, 7.0, 2.1), [0]),
        ((2.5, 0.0, 2.9, 0.0), [0]),
    ):
        assert lit(box_tree([box]), (0.0, 0.0, 0.0, 0.0), 100.0, hiding) == expected
    within = Shadows(table.images, [0], ((3.0, 0.5),), 0.0)
    assert lit(behind, (3.0, 0.5, 3.0, 0.5), 100.0, within) == [0]
    # Of parts of circles nothing is told: a lens is much smaller than its circles, a room is outside.
    lens = xa.Outline([(3, -1, fmpq(1, 8)), (3, 1, fmpq(1, 8))])
    room = xa.Scene([xa.Circle((3, 0), 1)], enclosure=xa.Circle((3, 0), 9))
    for scene, arcs in ((xa.Scene([lens]), [0, 1]), (room, [1])):
        images = EdgeTable(scene.obstacles).images
        hiding = Shadows(images, arcs, ((0.0, 0.0),), 0.0)
        assert lit(behind, (0.0, 0.0, 0.0, 0.0), 100.0, hiding) == [0]


@pytest.mark.usefixtures("always")
def test_floats_decide_nothing_where_they_must_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    table = EdgeTable(SCENES["squares"].obstacles)
    assert table.lit(table.spots(0), 100.0) == list(range(len(table.curves)))
