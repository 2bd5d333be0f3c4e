"""From vertex to vertex: counts, laws, a search of its own with its own sight, and circles as a limit."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from random import Random

import pytest

from exactacq import Circle, InvalidScene, Length, Outline, Point, Polygon, Scene, sightseer
from exactacq.files import gallery
from exactacq.files.octagons import random_octagons
from exactacq.numbers.real import fmpq
from exactacq.output.figures.vertex_scan_figure import limit_figure
from exactacq.strategies.vertex_scan import inscribed, polygon_limit, polygonal, vertex_scan

Spot = tuple[fmpq, fmpq]

SQUARE = Polygon([(0, 0), (1, 0), (1, 1), (0, 1)])
FAR_SQUARE = Polygon([(3, 0), (4, 0), (4, 1), (3, 1)])


# -- an oracle -------------------------------------------------------------------------------------


def cross(o: Spot, a: Spot, b: Spot) -> fmpq:
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def is_inside(ring: list[Spot], p: Spot) -> bool:
    """Strictly inside, by the parity of crossings of the ray to the east."""
    odd = False
    for a, b in pairwise([*ring, ring[0]]):
        turn = cross(a, b, p)
        if turn == 0 and min(a, b) <= p <= max(a, b):
            return False
        if (a[1] > p[1]) != (b[1] > p[1]):
            odd ^= (turn > 0) == (b[1] > a[1])
    return odd


def sees(rings: list[list[Spot]], wall: list[Spot] | None, p: Spot, q: Spot) -> bool:
    """Cut the segment by the lines of all edges: no piece's middle is blocked."""
    cuts = {fmpq(0), fmpq(1)}
    for ring in [*rings, *([wall] if wall else [])]:
        for a, b in pairwise([*ring, ring[0]]):
            at_p, at_q = cross(a, b, p), cross(a, b, q)
            if at_p != at_q:
                cuts.add(at_p / (at_p - at_q))
            else:
                along = [(c[0] - p[0]) * (q[0] - p[0]) + (c[1] - p[1]) * (q[1] - p[1]) for c in (a, b)]
                cuts |= {v / ((q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2) for v in along}
    ordered = sorted(c for c in cuts if 0 <= c <= 1)
    for low, high in pairwise(ordered):
        t = (low + high) / 2
        middle = p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])
        if any(is_inside(ring, middle) for ring in rings):
            return False
        if wall and not is_inside(wall, middle) and not on_ring(wall, middle):
            return False
    return True


def on_ring(ring: list[Spot], p: Spot) -> bool:
    edges = pairwise([*ring, ring[0]])
    return any(cross(a, b, p) == 0 and min(a, b) <= p <= max(a, b) for a, b in edges)


def searched(scene: Scene) -> tuple[list[Spot], list[Spot]]:
    """Order and path of the search by its definition: recursion, and all that is in sight asked again."""
    loops = [[e.start.rational for e in o.edges] for o in scene.obstacles]
    wall = loops.pop() if scene.enclosure is not None else None
    places = [p for loop in [*loops, *([wall] if wall else [])] for p in loop]
    order: list[Spot] = []
    walked = [scene.start.rational]

    def nearest(p: Spot) -> Spot | None:
        left = [q for q in places if q not in order and (p == q or sees(loops, wall, p, q))]
        return min(left, key=lambda q: (q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2, default=None)

    def visit(p: Spot) -> None:
        order.append(p)
        while (q := nearest(p)) is not None:
            walked.append(q)
            visit(q)
            if len(order) < len(places):
                walked.append(p)

    first = nearest(walked[0])
    if first != walked[0]:
        walked.append(first)
    visit(first)
    return order, walked


def grid_scene(seed: int) -> Scene:
    """Squares, bars and triangles on a small grid: shared lines, equal distances, views past corners."""
    rng = Random(seed)
    shapes = []
    for i, j in [(i, j) for i in range(3) for j in range(3) if (i, j) != (0, 0) and rng.random() < 0.6]:
        x, y = 3 * i, 3 * j
        corners = [(x, y), (x + 2, y), (x + 2, y + 2), (x, y + 2)]
        bent = [(x, y), (x + 2, y), (x + 2, y + 2), (x + 1, y + 2), (x + 1, y + 1), (x, y + 1)]
        shapes.append(Polygon(rng.choice([corners, corners[:3], corners[1:], bent])))
    room = Polygon([(-1, -1), (9, -1), (9, 9), (-1, 9)]) if seed % 3 == 0 else None
    return Scene(shapes, start=(rng.choice([0, Fraction(1, 2)]), 0), enclosure=room)


SCENES = [*map(grid_scene, range(9)), random_octagons(3, seed=1)]


@pytest.mark.parametrize("scene", SCENES)
def test_the_search_is_the_one_that_its_definition_gives(scene: Scene) -> None:
    order, walked = searched(scene)
    scan = vertex_scan(scene)
    edges = [o.edges for o in scene.obstacles]
    assert [edges[i][k].start.rational for i, k in scan.order] == order
    assert [scene.start.rational, *(piece.end.rational for piece in scan.path)] == walked


@pytest.mark.parametrize(
    "scene", [*SCENES, random_octagons(8, seed=4), polygonal(gallery.scene("circles"), 24)]
)
def test_scans_moves_and_length(scene: Scene) -> None:
    """One scan at every vertex, at most 2 (N - 1) moves, the length added again."""
    scan = vertex_scan(scene)
    corners = {(o.index, k) for o in scene.obstacles for k in range(len(o.edges))}
    assert len(scan.order) == scan.scans == len(corners) and set(scan.order) == corners
    assert len(corners) - 1 <= scan.moves <= 2 * (len(corners) - 1)
    total = Length(0)
    for piece in scan.path:
        (x, y), (u, v) = piece.start.rational, piece.end.rational
        total = total + Length((Length((u - x) ** 2 + (v - y) ** 2).algebraic).sqrt())
    assert scan.length == total
    assert all(a.end == b.start for a, b in pairwise(scan.path))


# -- cases with known answers ----------------------------------------------------------------------


def test_one_square_is_scanned_on_three_sides() -> None:
    scan = vertex_scan(Scene([SQUARE], start=(0, 0)))
    assert scan.order == ((0, 0), (0, 1), (0, 2), (0, 3))
    assert (scan.scans, scan.moves, scan.length, scan.approached) == (4, 3, Length(3), False)


def test_the_way_from_the_start_is_no_move() -> None:
    scan = vertex_scan(Scene([SQUARE], start=(0, -2)))
    assert (scan.moves, scan.length, scan.approached) == (3, Length(5), True)
    assert vertex_scan(Scene([SQUARE]), start=(0, -2)).length == Length(5)


def test_a_start_between_two_vertices_takes_the_first_of_the_least_obstacle() -> None:
    scan = vertex_scan(Scene([FAR_SQUARE, SQUARE], start=(2, 0)))
    assert scan.order[0] == (0, 0)


def test_it_goes_back_the_way_it_came() -> None:
    """The last corner of the square does not see the bar behind it, nor does the one before."""
    bar = Polygon([(3, "1/4"), (4, "1/4"), (4, "1/2"), (3, "1/2")])
    scan = vertex_scan(Scene([SQUARE, bar], start=(1, 1)))
    assert scan.order == ((0, 2), (0, 1), (0, 0), (0, 3), (1, 0), (1, 3), (1, 2), (1, 1))
    assert (scan.scans, scan.moves) == (8, 3 + 2 + 1 + 3)
    assert str(scan.length) == "sqrt(65)/4 + 13/2"


def test_nothing_to_scan() -> None:
    scan = vertex_scan(Scene([], start=(0, 0)))
    assert (scan.order, scan.moves, scan.length) == ((), 0, Length(0))


@pytest.mark.parametrize(
    ("shapes", "start", "word"),
    [
        ([Circle((3, 0), 1)], (0, 0), "obstacle O1 has arcs"),
        ([SQUARE, Outline([(3, 0), (4, 0, 1), (4, 1), (3, 1)])], (0, 0), "obstacle O2 has arcs"),
        ([SQUARE], None, "start"),
        ([SQUARE], (Length(2).algebraic.sqrt(), 0), "start"),
    ],
)
def test_what_is_refused(shapes: list[object], start: object, word: str) -> None:
    with pytest.raises(InvalidScene, match=word):
        vertex_scan(Scene(shapes), start=start)
    with pytest.raises(InvalidScene, match="inside"):
        vertex_scan(Scene([SQUARE]), start=(Fraction(1, 2), Fraction(1, 2)))


# -- circles as limits of polygons -----------------------------------------------------------------


@pytest.mark.parametrize("sides", [4, 6, 8, 30, 64])
def test_inscribed_polygons_are_rational_and_close_to_their_circle(sides: int) -> None:
    circle = Circle((5, Fraction(1, 3)), Fraction(7, 2), name="disc")
    polygon = inscribed(circle, sides)
    ring = Scene([polygon]).obstacles[0]
    assert len(ring.edges) == sides and ring.name == "disc"
    for edge in ring.edges:
        x, y = edge.start.x - circle.center[0], edge.start.y - circle.center[1]
        assert (x * x + y * y).rational == circle.radius**2
        assert edge.length.algebraic.rational is not None
    starts = [edge.start for edge in ring.edges]
    assert starts[0] == Point("17/2", "1/3") and starts[sides // 2] == Point("3/2", "1/3")
    lack = Length.turns(circle.radius) - ring.perimeter
    most = Length.turns(fmpq(2, 3) * circle.radius / (sides // 2) ** 2)
    assert Length(0) < lack <= most


@pytest.mark.parametrize("sides", [-4, 0, 2, 5])
def test_other_numbers_of_sides_are_refused(sides: int) -> None:
    with pytest.raises(ValueError, match="even number of sides"):
        inscribed(Circle((0, 0), 1), sides)


def test_polygonal_keeps_what_is_not_a_circle() -> None:
    scene = Scene([SQUARE, Circle((5, 0), 1)], start=(-1, 0), radius=9, name="mixed")
    flat = polygonal(scene, 6)
    assert flat.shapes[0] is SQUARE and len(flat.obstacles[1].edges) == 6
    assert (flat.start, flat.radius, flat.name) == (scene.start, scene.radius, "mixed")


def test_the_length_converges_while_scans_and_moves_diverge() -> None:
    """P_k = 5 + 3/2 p_1 + p_2 with the polygons' perimeters, and |P - P_k| <= 8 pi / m^2, m = k / 2."""
    limit = sightseer(gallery.scene("circles")).length
    assert limit == Length(5) + Length.turns(6)
    rows = polygon_limit([4, 8, 16, 32])
    for row in rows:
        p_1, p_2 = (o.perimeter for o in polygonal(gallery.scene("circles"), row.sides).obstacles)
        assert row.length == Length(5) + p_1 * fmpq(3, 2) + p_2
        assert row.gap + row.length == limit
        assert Length(0) < row.gap <= Length.turns(fmpq(4) / (row.sides // 2) ** 2)
        assert row.scans == row.vertices == 2 * row.sides
        assert row.vertices - 1 <= row.moves <= 2 * (row.vertices - 1)
    for row, finer in pairwise(rows):
        assert finer.gap < row.gap / 2
        assert finer.moves > row.moves and finer.scans == 2 * row.scans


def test_one_circle() -> None:
    """A single disc: 1 + its perimeter by the Sightseer; k scans and k - 1 moves from vertex to vertex."""
    scene = Scene([Circle((2, 0), 1)], start=(0, 0), radius=5)
    for row in polygon_limit([4, 12], scene):
        perimeter = polygonal(scene, row.sides).obstacles[0].perimeter
        assert row.length == Length(1) + perimeter
        assert (row.scans, row.moves) == (row.sides, row.sides - 1)
    assert polygon_limit([4], scene, radius=3)[0].length == polygon_limit([4], scene)[0].length


def test_a_limit_needs_a_start() -> None:
    with pytest.raises(InvalidScene, match="start"):
        polygon_limit([4], Scene([Circle((2, 0), 1)], radius=5))


def test_the_figure_shows_the_rows() -> None:
    page = limit_figure(8, [4, 6])
    left, right, lengths, counts = page.axes
    rows = polygon_limit([4, 6])
    assert left.get_title() == "Sightseer Strategy: P = 41.6268"
    assert right.get_title().startswith("vertex scan: 16 scans, 16 moves, ")
    assert len(right.lines[0].get_xdata()) + len(right.lines[1].get_xdata()) == 1 + 16
    drawn = {line.get_label(): list(line.get_ydata()) for line in [*lengths.lines, *counts.lines]}
    assert drawn["Sightseer"] == [float(row.length) for row in rows]
    assert drawn["moves"] == [row.moves for row in rows]
    assert drawn["2 (N - 1)"] == [14, 22]
