"""Scenes: orientation, measures, every rule of validation, and the broad phase below it."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import cos, inf, pi, sin
from random import Random
from time import perf_counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Polygon as ShapelyPolygon

from exactacq.errors import FormatError, InvalidScene
from exactacq.geometry import box_index
from exactacq.geometry.box_index import BoxIndex, Separator, bounds
from exactacq.geometry.curves import Arc
from exactacq.geometry.intersections import contacts
from exactacq.geometry.points import Location, Point
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real, rational
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon, Terrain, shape_edges
from exactacq.scene.validation import LISTED

HAIR = Fraction(1, 10**60)
ROOM = Polygon([(-10, -10), (10, -10), (10, 10), (-10, 10)], name="room")
OUTLINE = [(0, 0, "1/2"), (4, 0), (4, 4, "-1/3"), (0, 4, 1)]


def square(x, y, side=1, name=None):
    return Polygon([(x, y), (x + side, y), (x + side, y + side), (x, y + side)], name)


def violations(*obstacles, **options) -> tuple[str, ...]:
    try:
        Scene(obstacles, **options)
    except InvalidScene as error:
        return error.violations
    return ()


# -- obstacles -------------------------------------------------------------------------------------


def test_measures_in_closed_form():
    scene = Scene([square(0, 0, 2), Circle((8, 0), 2), Outline([(0, 10), (2, 10, 1), (2, 12), (0, 12)])])
    assert [str(o.perimeter) for o in scene.obstacles] == ["8", "4*pi", "pi + 6"]
    assert [o.area for o in scene.obstacles] == [
        Length(4),
        Length.turns(2),
        Length(4) + Length.turns(Fraction(1, 4)),
    ]


def test_the_blocked_side_is_on_the_left():
    scene = Scene([square(0, 0)], enclosure=ROOM, start=(5, 5))
    inner, room = scene.obstacles
    assert (inner.is_enclosure, room.is_enclosure) == (False, True)
    assert room.index == 1 and room.area == 400 and room.perimeter == 80
    assert inner.locate(Point("1/2", "1/2")) is Location.INSIDE
    assert room.locate(Point(0, 0)) is Location.OUTSIDE
    assert room.locate(Point(11, 0)) is Location.INSIDE
    assert room.locate(Point(10, 3)) is Location.BOUNDARY


@pytest.mark.parametrize("is_enclosure", [False, True])
def test_the_sense_of_the_input_does_not_matter(is_enclosure):
    """The same loop walked backward, from the same first vertex: same edges, ends and measures."""
    backward = [(0, 0, -1), (0, 4, "1/3"), (4, 4, 0), (4, 0, "-1/2")]
    loops = []
    for vertices in (OUTLINE, backward):
        shape = Outline(vertices)
        scene = Scene([], enclosure=shape) if is_enclosure else Scene([shape])
        loops.append(scene.obstacles[0])
    one, other = loops
    assert one.area == other.area and one.perimeter == other.perimeter
    for a, b in zip(one.edges, other.edges, strict=True):
        assert a.start == b.start and a.end == b.end and type(a) is type(b)
        if isinstance(a, Arc):
            assert a.center == b.center and a.ccw == b.ccw
    assert one.edges[0].start == Point(0, 0)
    assert all(a.end is b.start for a, b in zip(one.edges, one.edges[1:], strict=False))


def test_a_circle_is_one_full_arc_from_its_east_point():
    scene = Scene([Circle((1, 2), 3)], enclosure=Circle((0, 0), 50))
    (arc,), (wall,) = (o.edges for o in scene.obstacles)
    assert arc.full and arc.ccw and arc.start is arc.end and arc.start == Point(4, 2)
    assert wall.full and not wall.ccw


def test_a_lens_of_a_hair_is_oriented():
    """Two arcs that differ by 10^-60 in their bulge enclose a positive area in either sense."""
    lens = [(0, 0, "1/2"), (1, 0, -Fraction(1, 2) + HAIR)]
    area = Scene([Outline(lens)]).obstacles[0].area
    mirrored = Scene([Outline([(x, -y, -Fraction(b)) for x, y, b in lens])]).obstacles[0].area
    assert area.sign() == 1 and area == mirrored and float(area) < 1e-59


def test_a_scene_keeps_what_it_was_given():
    shapes = [square(0, 0), Circle((5, 5), 1)]
    start = Point(Real(2).sqrt(), 3)
    scene = Scene(shapes, start=start, enclosure=ROOM, radius="7/2", name="n", notes=["a", "b"])
    assert scene.shapes == tuple(shapes) and scene.enclosure is ROOM and scene.start is start
    assert (scene.radius, scene.name, scene.notes) == (rational("7/2"), "n", ("a", "b"))
    empty = Scene([])
    assert empty.obstacles == () and empty.start is None and empty.radius is None


def test_the_border_is_met_by_contact():
    terrain = Terrain(10, 10)
    shapes = [
        square(1, 1, Fraction(1, 2)),
        Circle((4, 2), 2),
        Circle((2, 7), 2 - HAIR),
        square(9, 5),
        Outline([(7, 1, 1), (8, 1, 1)]),
        Outline([(7, 3, 1), (8, 3)]),
        Outline([(8, "1/4", 1), (9, "1/4")]),
        square(20, 20),
    ]
    assert Scene(shapes, terrain=terrain).meets_border() == [1, 3, 6, 7]
    assert Scene(shapes).meets_border() == []


# -- rules -----------------------------------------------------------------------------------------

RULES = [
    (([Polygon([(0, 0), (1, 0)], "two")], {}), "obstacle O1 'two': 2 vertices at (0, 0): a boundary needs 3"),
    (([Polygon([(3, 4)])], {}), "obstacle O1: 1 vertex at (3, 4): a boundary needs 3"),
    (([Polygon([])], {}), "obstacle O1: 0 vertices: a boundary needs 3"),
    (([Polygon([(0, 0), (4, 0), (4, 0), (4, 4)])], {}), "obstacle O1: edge 1 has zero length at (4, 0)"),
    (([Polygon([(0, 0), (4, 0), (4, 4), (0, 0), (0, 0)])], {}), "edge 3 has zero length at (0, 0)"),
    (([Outline([(0, 0), (4, 0, 1), (4, 0), (0, 4)])], {}), "edge 1 has zero length at (4, 0)"),
    (
        ([Polygon([(0, 0), (2, 2), (2, 0), (0, 2)], "b")], {}),
        "obstacle O1 'b': edges 0 and 2 cross at (1, 1)",
    ),
    (([Polygon([(0, 0), (4, 0), (4, 4), (2, 0), (0, 4)])], {}), "edges 0, 2 and 3 touch at (2, 0)"),
    (([Polygon([(0, 0), (4, 0), (2, 0), (0, 4)])], {}), "edges 0 and 1 overlap from (2, 0) to (4, 0)"),
    (([Outline([(0, 0, 1), (4, 0, -1)])], {}), "edges 0 and 1 overlap from (0, 0) to (4, 0)"),
    (([Outline([(0, 0), (4, 0, -2), (4, 4), (0, 4)])], {}), "edges 1 and 3 touch at (0, 2)"),
    (([Outline([(0, 0), (4, 0, "-2.1"), (4, 4), (0, 4)])], {}), "edges 1 and 3 cross at (0, 1.0"),
    (([Outline([(0, 0, -1), (4, 0), (2, 2)])], {}), "edges 0, 1 and 2 touch at (2, 2)"),
    (([Circle((0, 0), 0)], {}), "obstacle O1: circle radius 0: must be positive"),
    (([Circle((0, 0), "-1/2", "c")], {}), "obstacle O1 'c': circle radius -0.5: must be positive"),
    (
        ([Circle((0, 0), 1, "a"), Circle((3, 0), 2, "b")], {}),
        "obstacle O1 'a', edge 0, touches obstacle O2 'b', edge 0, at (1, 0): obstacles must be disjoint",
    ),
    (
        ([square(0, 0), square(1, 1)], {}),
        "obstacle O1, edges 1 and 2, touches obstacle O2, edges 0 and 3, at (1, 1)",
    ),
    (([square(0, 0, 2), square(1, 1, 2)], {}), "obstacle O1, edge 1, crosses obstacle O2, edge 0, at (2, 1)"),
    (([square(0, 0, 2), square(2, 1, 2)], {}), "overlaps obstacle O2, edge 3, from (2, 1) to (2, 2)"),
    (([Circle((9, 9), 2), Circle((9, 9), 2)], {}), "overlaps obstacle O2, edge 0, all around"),
    (([square(0, 0, 3, "big"), square(1, 1)], {}), "obstacle O2 lies inside obstacle O1 'big', at (1, 1)"),
    (([Circle((2, 2), 1), square(0, 0, 4)], {}), "obstacle O1 lies inside obstacle O2, at (3, 2)"),
    (([square(20, 0)], {"enclosure": ROOM}), "obstacle O1 lies outside the enclosure 'room', at (20, 0)"),
    (([square(-20, -20, 40)], {"enclosure": ROOM}), "obstacle O1 lies outside the enclosure 'room'"),
    (
        ([square(9, 0)], {"enclosure": ROOM}),
        "obstacle O1, edge 1, overlaps the enclosure 'room', edge 1, from (10, 0) to (10, 1)",
    ),
    (
        ([square(0, 0, 2)], {"start": (1, 1)}),
        "start (1, 1) lies inside obstacle O1: it must lie in free space",
    ),
    (([], {"start": (10, 11), "enclosure": ROOM}), "start (10, 11) lies outside the enclosure 'room'"),
    (([], {"radius": 0}), "radius 0: a sensing radius must be positive"),
    (([], {"radius": "1e-400"}), "radius: a sensing radius of less than 1/10^100 is not supported"),
    (([], {"terrain": Terrain(0, 1)}), "terrain width 0: must be positive"),
    (([], {"terrain": Terrain(1, "-1/2")}), "terrain height -0.5: must be positive"),
    (([], {"enclosure": Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])}), "the enclosure: edges 0 and 2 cross"),
]


@pytest.mark.parametrize(("scene", "message"), RULES, ids=[message for _, message in RULES])
def test_each_rule_has_its_message(scene, message):
    obstacles, options = scene
    found = violations(*obstacles, **options)
    assert any(message in violation for violation in found), found


@pytest.mark.parametrize(
    "shapes",
    [
        [square(0, 0), square(1, 1)],
        [square(0, 0), square(1, 0)],
        [square(0, 0, 2), Polygon([(2, 1), (4, 0), (4, 2)])],
        [Polygon([(0, 0), (4, 0), (4, 4), (2, 0), (0, 4)])],
        [Polygon([(0, 0), (4, 0), (2, 0), (0, 4)])],
        [Outline([(0, 0, 1), (4, 0, -1)])],
    ],
)
def test_one_place_is_one_violation(shapes):
    """However many edges meet there."""
    assert len(violations(*shapes)) == 1


def test_all_violations_come_together():
    found = violations(
        Polygon([(0, 0), (2, 2), (2, 0), (0, 2)]),
        Circle((5, 5), 0),
        square(6, 0, 3),
        square(7, 1),
        square(30, 0),
        enclosure=ROOM,
        start=("29/4", "1/2"),
        radius=-1,
    )
    rules = (
        "radius -1",
        "obstacle O2: circle",
        "obstacle O1: edges",
        "O4 lies inside",
        "O5 lies outside",
        "start",
    )
    assert len(found) == len(rules)
    assert all(rule in violation for rule, violation in zip(rules, found, strict=True))


def test_many_violations_are_counted():
    found = violations(*[square(k, 0) for k in range(100)])
    assert len(found) == LISTED + 1
    assert found[-1] == f"and {99 - LISTED} more violations"


def test_what_is_allowed():
    touching_start = Scene([square(0, 0, 2)], start=(2, 1))
    assert touching_start.start == Point(2, 1)
    assert not violations(Outline([(0, 0, 1), (4, 0)]), Outline([(0, 5, 1), (4, 5, "-1/2")]))
    assert not violations(Polygon([(0, 0), (1, 0), (2, 0), (2, 2)]))
    assert not violations(square(-1, -1), square(30, 0), terrain=Terrain(10, 10))
    assert not violations(start=(10, 0), enclosure=ROOM)


def test_a_hair_between_obstacles_is_enough():
    assert not violations(square(0, 0), square(1 + HAIR, 0))
    assert not violations(Circle((0, 0), 1), Circle((2 + HAIR, 0), 1))
    assert not violations(Circle((0, 0), 2 + HAIR), square(3, 0)) and violations(
        Circle((0, 0), 3), square(3, 0)
    )
    assert not violations(Circle((0, 0), 10 - HAIR), enclosure=ROOM)
    assert violations(Circle((0, 0), 10), enclosure=ROOM)
    assert violations(square(0, 0), start=(1 - HAIR, "1/2")) and not violations(
        square(0, 0), start=(1, "1/2")
    )


def test_an_irrational_start_is_decided():
    root = Real(2).sqrt()
    circle = Circle((0, 0), 2)
    assert not violations(circle, start=(root, root))
    assert violations(circle, start=(root, root * (1 - HAIR)))


def test_unreadable_numbers_are_refused():
    for start in ((float("nan"), 0), ("1/0", 0), ("x", 0)):
        with pytest.raises(FormatError):
            Scene([], start=start)


@given(st.integers(0, 10**6))
def test_polygon_scenes_agree_with_shapely(seed):
    """Small lattice polygons, most of them invalid somehow: validity by the DE-9IM of another library."""
    random = Random(seed)
    for _ in range(25):
        loops = []
        for _ in range(random.randint(1, 3)):
            x, y = random.randint(0, 8), random.randint(0, 8)
            count = random.choice([3, 3, 4])
            loops.append([(x + random.randint(0, 4), y + random.randint(0, 4)) for _ in range(count)])
        repeats = any(a == b for loop in loops for a, b in pairwise(loop))
        theirs = [ShapelyPolygon(loop) for loop in loops]
        valid = not repeats and all(p.is_valid and p.area > 0 for p in theirs)
        valid = valid and all(p.disjoint(q) for i, p in enumerate(theirs) for q in theirs[:i])
        assert (not violations(*map(Polygon, loops))) == valid, loops


def test_equal_scenes_have_equal_violations_in_any_order_of_obstacles():
    shapes = [square(0, 0, 2), square(1, 1, 2), Circle((1, 1), "1/4"), square(8, 8)]
    count = len(violations(*shapes))
    random = Random(5)
    for _ in range(5):
        random.shuffle(shapes)
        assert len(violations(*shapes)) == count


# -- broad phase -----------------------------------------------------------------------------------


@given(st.integers(0, 10**6))
def test_boxes_contain_their_curves_closely(seed):
    random = Random(seed)
    for _ in range(8):
        ends = [Point(random.randint(-5, 5), Fraction(random.randint(-50, 50), 7)) for _ in range(2)]
        if ends[0] == ends[1]:
            continue
        bulge = rational(Fraction(random.choice([-9, -4, -2, -1, 1, 2, 4, 9]), 4))
        arc = Arc.from_bulge(*ends, bulge)
        x0, y0, x1, y1 = bounds([arc])[0]
        points = [arc.point(Fraction(k, 64)) for k in range(65)]
        assert all(x0 <= p.x <= x1 and y0 <= p.y <= y1 for p in points)
        xs, ys = [float(p.x) for p in points], [float(p.y) for p in points]
        slack = float(arc.radius) * (1 - cos(pi / 32)) + 1e-9
        assert x0 >= min(xs) - slack and x1 <= max(xs) + slack
        assert y0 >= min(ys) - slack and y1 <= max(ys) + slack


@pytest.mark.parametrize("off", [0, 10**6])
@pytest.mark.parametrize("size", [1, Fraction(1, 10**6)])
@pytest.mark.parametrize("digits", [4, 9, 16, 40, 90])
def test_boxes_of_arcs_that_bend_little(digits, size, off):
    """They were as coarse as sums with the radius are: by thousands of times the chord."""
    for bulge in (Fraction(1, 10**digits), -Fraction(3, 10**digits)):
        for (u, v), k in (((size, 0), 1 if bulge > 0 else 3), ((0, size), 2 if bulge > 0 else 0)):
            arc = Arc.from_bulge(Point(off, off), Point(off + u, off + v), rational(bulge))
            # Its middle is its only extreme point.
            middle, found = arc.point(rational(Fraction(1, 2))), bounds([arc])[0]
            assert found[0] <= middle.x <= found[2] and found[1] <= middle.y <= found[3]
            extreme = float((middle.x, middle.y)[k % 2])
            assert abs(found[k] - extreme) <= 5 * float(np.spacing(extreme)) + 1e-3 * abs(bulge) * size


def test_boxes_of_huge_and_tiny_numbers():
    huge = shape_edges(Polygon([("1e400", 0), (0, "-1e400"), ("1e-400", 1)]))
    assert bounds(huge)[0].tolist()[2] == inf and bounds(huge)[1].tolist()[1] == -inf


@pytest.mark.parametrize(
    ("shape", "rule"),
    [
        (Polygon([("1e400", 0), (0, 1), (0, 0)]), "too far from the origin"),
        (Polygon([("1e-400", 0), (0, 1), (0, 0)]), "too short"),
        (Outline([(0, 0, "1e-150"), (1, 0), (1, 1)]), "bends too little"),
    ],
)
def test_sizes_beyond_floats_are_refused(shape, rule):
    """The float images that prune must not overflow; anything up to 10^100 is fine."""
    assert [rule in text for text in violations(shape, square(-5, -5))] == [True]


@given(st.integers(0, 10**6))
def test_the_index_finds_what_brute_force_finds(seed):
    """Sizes over ten decades, points, equal corners, infinities."""
    rng = np.random.default_rng(seed)
    for _ in range(5):
        n = int(rng.integers(1, 200))
        corner = rng.random((n, 2)) * 10 ** rng.uniform(-3, 3, (n, 1))
        size = 10 ** rng.uniform(-7, 3, (n, 1)) * rng.random((n, 2)) * (rng.random((n, 1)) < 0.9)
        boxes = np.hstack([corner, corner + size])
        if rng.random() < 0.5:
            boxes = np.round(boxes)
        if rng.random() < 0.3:
            boxes[0] = [-inf, 0, inf, 1e308]
        if rng.random() < 0.3:
            boxes[-2:] = [-inf, 0, -1e305, 1]
        index = BoxIndex(boxes)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(box_index, "SCANNED", 0)
            celled = BoxIndex(boxes)
        meets = (boxes[:, None, :2] <= boxes[None, :, 2:]).all(axis=2)
        meets &= meets.T
        found = np.zeros((n, n), dtype=int)
        for a, b in index.pairs():
            np.add.at(found, (a, b), 1)
        assert (found == np.triu(meets, 1)).all()
        for k in range(n):
            assert index.query(*boxes[k]).tolist() == np.flatnonzero(meets[k]).tolist()
            assert celled.query(*boxes[k]).tolist() == np.flatnonzero(meets[k]).tolist()


def test_an_empty_index():
    index = BoxIndex(np.empty((0, 4)))
    assert len(index) == 0 and list(index.pairs()) == [] and len(index.query(0, 0, 1, 1)) == 0


@given(st.integers(0, 10**6))
def test_the_separator_never_parts_curves_that_meet(seed):
    random = Random(seed)
    curves = []
    while len(curves) < 25:
        a, b = ((random.randint(0, 6), random.randint(0, 6)) for _ in range(2))
        if a != b:
            curves += shape_edges(Outline([(*a, random.choice([0, 1, -1, "1/2", -2])), b]))[:1]
    curves += shape_edges(Circle((3, 3), 2)) + shape_edges(Circle((5, 3), 4))
    n = len(curves)
    first, second = np.triu_indices(n, 1)
    apart = Separator(curves, bounds(curves)).separated(first, second)
    for a, b, separated in zip(first, second, apart, strict=True):
        assert not (separated and contacts(curves[a], curves[b]))
    assert apart.any()


# -- size ------------------------------------------------------------------------------------------


def octagons(count: int) -> list[Polygon]:
    side = int(count**0.5) + 1
    turn = [2 * pi * k / 8 + 0.1 for k in range(8)]
    corners = [(round(cos(a), 3), round(sin(a), 3)) for a in turn]
    return [
        Polygon([(Fraction(x) + 3 * (i % side), Fraction(y) + 3 * (i // side)) for x, y in corners])
        for i in range(count)
    ]


def comb(teeth: int) -> Polygon:
    """Long slanted teeth: all boxes overlap though no edges meet."""
    points = [(2 * i + x, y) for i in range(teeth) for x, y in ((0, 0), (Fraction(1, 2), 1000), (1, 0))]
    points += [(2 * teeth, -1), (0, -1)]
    return Polygon([(3 * x - 4 * y, 4 * x + 3 * y) for x, y in points])


def test_thousands_of_edges_validate(capsys):
    times = {}
    for name, shapes in (("375 octagons", octagons(375)), ("slanted comb", [comb(400)])):
        begin = perf_counter()
        assert not violations(*shapes)
        times[name] = perf_counter() - begin
    with capsys.disabled():
        print("; ".join(f"{name}: {seconds:.2f} s" for name, seconds in times.items()), end=" ")
