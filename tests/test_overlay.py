"""Overlays of loops with arcs, against shapely and against membership told by formulas."""

from __future__ import annotations

import math
from collections.abc import Sequence
from random import Random

import pytest
import shapely
from flint import fmpq

from exactacq.files.loops.union import unite
from exactacq.files.repairs.overlay import Ring, overlay
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon, Shape


def polygon(shape: Shape) -> shapely.Polygon:
    return shapely.geometry.shape(shape.__geo_interface__)


def area(rings: Sequence[Ring]) -> shapely.Geometry:
    """The area on the left of rings that do not meet."""
    solid = shapely.union_all([polygon(ring.shape("")) for ring in rings if ring.outer])
    return solid.difference(shapely.union_all([polygon(r.shape("")) for r in rings if not r.outer]))


def box(x: object, y: object, w: object, h: object) -> Polygon:
    x, y, w, h = (fmpq(v) for v in (x, y, w, h))
    return Polygon([(x, y), (x + w, y), (x + w, y + h), (x, y + h)])


def pill(x: int, y: int, length: int, r: int) -> Outline:
    """A bar with round ends: its arcs run along others, and touch lines."""
    return Outline([(x, y - r), (x + length, y - r, 1), (x + length, y + r), (x, y + r, 1)])


def random_shape(random: Random) -> Shape:
    x, y = random.randrange(12), random.randrange(12)
    kind = random.randrange(4)
    if kind == 0:
        return Circle((x, y), random.randrange(1, 5))
    if kind == 1:
        return box(x, y, random.randrange(1, 6), random.randrange(1, 6))
    if kind == 2:
        return pill(x, y, random.randrange(1, 6), random.randrange(1, 4))
    return Polygon([(x, y), (x + random.randrange(1, 5), y + 1), (x, y + random.randrange(2, 6))])


@pytest.mark.parametrize("seed", range(60))
def test_a_union_holds_what_its_shapes_hold(seed: int) -> None:
    random = Random(seed)
    shapes = [random_shape(random) for _ in range(random.randrange(2, 6))]
    rings = overlay(shapes, any)
    wanted = shapely.union_all([polygon(shape) for shape in shapes])
    perimeter = wanted.length
    # Chords stray by 10^-4 of a radius of at most 4, on either side.
    assert area(rings).symmetric_difference(wanted).area < perimeter * 2 * 4e-4
    assert max((float(ring.chain.moved()) for ring in rings), default=0) < 1e-12


@pytest.mark.parametrize("seed", range(20))
def test_what_a_wall_leaves_free(seed: int) -> None:
    random = Random(seed)
    wall = pill(0, 5, 12, 6)
    shapes = [wall, *(random_shape(random) for _ in range(3))]
    rings = overlay(shapes, lambda held: held[0] and not any(held[1:]))
    wanted = polygon(wall).difference(shapely.union_all([polygon(s) for s in shapes[1:]]))
    assert area(rings).symmetric_difference(wanted).area < wanted.length * 2 * 6e-4 + 1e-9


@pytest.mark.parametrize("seed", range(10))
def test_order_and_sense_do_not_matter(seed: int) -> None:
    random = Random(seed)
    shapes = [random_shape(random) for _ in range(4)]
    turned = [Outline(reversed_rows(s), None) if not isinstance(s, Circle) else s for s in shapes[::-1]]
    one, other = (sorted(key(ring) for ring in overlay(group, any)) for group in (shapes, turned))
    assert one == other


def reversed_rows(shape: Shape) -> list[tuple[fmpq, fmpq, object]]:
    rows, n = list(shape.vertices), len(shape.vertices)
    return [(*rows[-k % n][:2], -rows[-(k + 1) % n][2]) for k in range(n)]


def key(ring: Ring) -> tuple[bool, int, float]:
    """What does not tell where a circle begins."""
    return ring.outer, len(ring.chain.corners), round(polygon(ring.shape("")).area, 2)


def test_a_union_of_polygons_is_exact() -> None:
    third = fmpq(1, 3)
    (ring,) = overlay([box(0, 0, 2, 2), box(third, third, 5, 1)], any)
    assert ring.chain.moved() == 0
    assert shapely.Polygon([(float(c.x), float(c.y)) for c in ring.chain.corners]).area == pytest.approx(
        4 + (5 + 1 / 3 - 2)
    )


def test_rational_crossings_of_arcs_are_exact() -> None:
    """Circles of radius 5 whose centres are 6 apart cross at a height of 4."""
    (ring,) = overlay([Circle((0, 0), 5), Circle((6, 0), 5)], any)
    assert ring.chain.moved() == 0
    shape = ring.shape("two")
    assert {(x, y) for x, y, _ in shape.vertices} >= {(3, 4), (3, -4)}
    lens = 2 * 25 * math.acos(3 / 5) - 6 / 2 * math.sqrt(4 * 25 - 36)
    assert float(Scene([shape]).obstacles[0].area) == pytest.approx(50 * math.pi - lens)


def test_a_loop_inside_another_is_no_boundary() -> None:
    (ring,) = overlay([box(0, 0, 9, 9), Circle((4, 4), 2)], any)
    assert len(ring.chain.corners) == 4


def test_equal_loops_are_one() -> None:
    (ring,) = overlay([pill(0, 0, 4, 1)] * 3, any)
    assert len(ring.chain.corners) == 4
    (disc,) = overlay([Circle((0, 0), 2)] * 2, any)
    assert len(disc.chain.corners) == 2


def test_loops_that_touch_stay_apart() -> None:
    rings = overlay([Circle((0, 0), 1), Circle((2, 0), 1)], any)
    assert len(rings) == 2
    assert len(overlay([Circle((0, 0), 1), Circle((5, 0), 1)], any)) == 2


def test_a_ring_of_shapes_has_a_hole() -> None:
    frame = [pill(0, 0, 10, 1), pill(0, 10, 10, 1), box(-1, 0, 2, 10), box(9, 0, 2, 10)]
    outer, inner = sorted(overlay(frame, any), key=lambda ring: not ring.outer)
    assert (outer.outer, inner.outer) == (True, False)
    assert len(inner.chain.corners) == 4


def test_the_note_bounds_the_move() -> None:
    merged = unite([Circle((0, 0), 2), Circle((1, 0), 2)], None, None)
    assert merged.notes[0] == "merged None into their union"
    assert "no point of a union moved by more than" in merged.notes[1]
    exact = unite([Circle((0, 0), 5), Circle((6, 0), 5)], None, None)
    assert exact.notes == ["merged None into their exact union"]
