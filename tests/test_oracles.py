"""The oracles on cases computed by hand, and against each other."""

from __future__ import annotations

import math
from fractions import Fraction as Q
from random import Random

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from nightly import examples
from oracles import (
    Disc,
    Room,
    arc_of,
    free,
    free_by_shapely,
    reverse_loop,
    shortest_visible,
    signed_area,
    world,
)
from sampled_links import (
    ambiguous,
    free_sample_shorter,
    shortest_by_sampling,
    sightseer_order,
    visibility_weights,
)
from strategies import (
    SIMILARITIES,
    box,
    circle_grid,
    degenerate_terrain,
    degenerate_terrains,
    random_terrain,
    reversed_order,
    terrains,
)

EXACT = 1e-12


class TestWorld:
    def test_a_half_circle_from_its_bulge(self) -> None:
        centre, r, first, sweep = arc_of(1, 0, -1, 0, 1)
        assert centre == pytest.approx((0, 0))
        assert (r, first, sweep) == pytest.approx((1, 0, math.pi))

    def test_a_hollow_quarter(self) -> None:
        bulge = math.tan(math.pi / 8)
        centre, r, _, sweep = arc_of(0, 0, 1, 1, -bulge)
        assert centre == pytest.approx((1, 0))
        assert (r, sweep) == pytest.approx((1, -math.pi / 2))

    def test_area_and_perimeter_of_a_half_ring(self) -> None:
        ring = [(5, 0, 1), (-5, 0, 0), (-3, 0, -1), (3, 0, 0)]
        assert signed_area(ring) == pytest.approx(8 * math.pi)
        assert signed_area(reverse_loop(ring)) == pytest.approx(-8 * math.pi)
        assert world([ring]).perimeter(0) == pytest.approx(8 * math.pi + 4)

    def test_positions_follow_the_boundary_with_the_blocked_side_on_the_left(self) -> None:
        w = world([box(0, 2, 0, 1), Disc(5, 5, 2)])
        assert w.position(0, (2, 0.5)) == pytest.approx(2.5)
        assert w.at(0, 4.0) == pytest.approx((1, 1))
        assert (w.position(1, (5, 7)) - w.position(1, (7, 5))) % w.perimeter(1) == pytest.approx(math.pi)

    @given(terrains(room=True), st.floats(0, 50), st.integers(0, 5))
    def test_position_inverts_at(self, terrain: object, s: float, i: int) -> None:
        w = world(terrain.shapes)
        s %= w.perimeter(i)
        gap = abs(w.position(i, w.at(i, s)) - s)
        assert min(gap, w.perimeter(i) - gap) < 1e-9

    def test_the_end_of_the_last_edge_is_not_its_start(self) -> None:
        """Less the other edges, the length around may exceed the last one by round-off."""
        ring = [
            (Q(2697544345, 4087753921), Q(2708113014, 4087753921), Q(8, 97)),
            (Q(-18680962753, 22148203709), Q(8045876520, 22148203709), Q(8, 97)),
            (Q(-126760781, 585341941), Q(-526615488, 585341941), Q(-7, 97)),
            (Q(413440513, 527503945), Q(-270337446, 527503945), Q(15, 97)),
        ]
        w, corner = world([ring]), tuple(map(float, ring[0][:2]))
        assert w.at(0, w.position(0, corner)) == pytest.approx(corner)


class TestFree:
    def test_grazing_does_not_block(self) -> None:
        shapes = [box(0, 1, 0, 1), Disc(3, 0, 1), box(-1, 0, 2, 3)]
        assert free(shapes, (0, -1), (0, 5))
        assert free(shapes, (1.5, 1), (5, 1))
        assert free(shapes, (-1, 1), (1.5, 1))
        assert free(shapes, (0, 2), (1.9, 0.1))

    def test_a_dip_blocks(self) -> None:
        shapes = [box(0, 1, 0, 1), Disc(3, 0, 1)]
        assert not free(shapes, (-1, 0.5), (2, 0.5))
        assert not free(shapes, (1e-6, -1), (1e-6, 5))
        assert not free(shapes, (1.5, 1 - 1e-6), (5, 1 - 1e-6))
        assert free(shapes, (1.5, 1 - 1e-6), (5, 1 - 1e-6), tol=1e-5)
        assert not free(shapes, (0, 0), (1, 1))
        assert not free(shapes, (0.2, 0.2), (0.4, 0.3))

    def test_hollows_and_rooms(self) -> None:
        ring = [(5, 0, 1), (-5, 0, 0), (-3, 0, -1), (3, 0, 0)]
        assert free([ring], (-3, 0), (3, 0))
        assert free([ring], (0, -9), (0, 3))
        assert not free([ring], (-4, 0.1), (4, 0.1))
        room = Room(box(0, 4, 0, 4))
        assert free([Disc(2, 2, 1), room], (0, 0), (0, 4))
        assert free([Disc(2, 2, 1), room], (0, 1), (4, 1))
        assert not free([Disc(2, 2, 1), room], (0, 0), (4, 4))
        assert not free([Disc(2, 2, 1), room], (1, 1), (1, 5))

    @given(terrains(room=True), st.lists(st.floats(-2, 8), min_size=4, max_size=4))
    def test_agrees_with_geos(self, terrain: object, ends: list[float]) -> None:
        p, q = ends[:2], ends[2:]
        assume(math.dist(p, q) > 0.1)
        strict, lax = free(terrain.shapes, p, q, 1e-4), free(terrain.shapes, p, q, 1e-2)
        geos = free_by_shapely(terrain.shapes, p, q, 1e-3)
        assert strict <= geos <= lax


class TestShortestVisible:
    def test_open_pairs(self) -> None:
        square = box(0, 1, 0, 1)
        assert shortest_visible([square, Disc(5, 0.5, 1)], 0, 1, 9).length == pytest.approx(3, abs=EXACT)
        assert shortest_visible([square, box(4, 5, 5, 6)], 0, 1, 9).length == pytest.approx(5, abs=EXACT)
        assert shortest_visible([Disc(0, 0, 1), Disc(3, 4, 2)], 0, 1, 9).length == pytest.approx(2, abs=EXACT)
        assert shortest_visible([square], (4, 5), 0, 9).length == pytest.approx(5, abs=EXACT)
        assert shortest_visible([square, Disc(5, 0.5, 1)], 0, 1, 2.999) is None

    def test_over_one_corner(self) -> None:
        """A ladder over a box's corner (a, b) is at least (a^(2/3) + b^(2/3))^(3/2) long."""
        for a, b in ((1, 8), (2, 3)):
            shapes = [
                [(0.1, 0), (20, -1), (20, 0)],
                [(0, 0.1), (0, 20), (-1, 20)],
                box(0.01, a, 0.01, b),
            ]
            ladder = (a ** (2 / 3) + b ** (2 / 3)) ** 1.5
            assert shortest_visible(shapes, 0, 1, 40).length == pytest.approx(ladder, abs=EXACT)

    def test_tangent_to_one_arc(self) -> None:
        shapes = [
            [(0.1, 0), (20, -1), (20, 0)],
            [(0, 0.1), (0, 20), (-1, 20)],
            [(0.01, 0.01), (3, 1, 1), (1, 3)],
        ]
        assert shortest_visible(shapes, 0, 1, 40).length == pytest.approx(6 * math.sqrt(2), abs=EXACT)

    def test_held_by_two_corners(self) -> None:
        shapes = [box(-15, 15, -1, 0), box(-15, 15, 10, 11), box(-20, 1, 2, 3), box(-2, 20, 7, 8)]
        chord = shortest_visible(shapes, 0, 1, 40)
        assert chord.length == pytest.approx(12.5, abs=EXACT)
        assert (*chord.start, *chord.end) == pytest.approx((13 / 4, 0, -17 / 4, 10))

    def test_held_by_two_circles(self) -> None:
        """An inner common tangent of circles 10 apart with radii 3 and 3 leans by asin(6/10)."""
        walls = [box(-40, 40, -11, -10), box(-40, 40, 10, 11)]
        bars = [box(-50, 0.5, -8.9, -8.5), box(-0.5, 50, 8.5, 8.9)]
        chord = shortest_visible([*walls, Disc(0, -5, 3), Disc(0, 5, 3), *bars], 0, 1, 40)
        assert chord.length == pytest.approx(25, abs=EXACT)
        assert (*chord.start, *chord.end) == pytest.approx((7.5, -10, -7.5, 10))

    def test_a_pinched_line(self) -> None:
        corridor = [box(0, 10, 0, 1), box(-10, 0, 2, 3), box(0, 10, 4, 5)]
        ends = [box(-0.5, 0.5, -2, -1), box(-0.5, 0.5, 6, 7)]
        chord = shortest_visible(ends + corridor, 0, 1, 8)
        assert chord.length == pytest.approx(7, abs=EXACT)
        assert (chord.start[0], chord.end[0]) == pytest.approx((0, 0))
        shut = [*corridor[:1], box(-10, 1e-3, 2, 3), *corridor[2:]]
        assert shortest_visible(ends + shut, 0, 1, 8) is None

    def test_concentric_arcs(self) -> None:
        ring = [(5, 0, 1), (-5, 0, 0), (-3, 0, -1), (3, 0, 0)]
        assert shortest_visible([Disc(0, 0, 1), ring], 0, 1, 9).length == pytest.approx(2, abs=EXACT)
        behind = [Disc(0, 0, 1), ring, Disc(0, 2, "0.5"), Disc(-2, 0, "0.5"), Disc(2, 0, "0.5")]
        assert shortest_visible(behind, 0, 1, 9).length == pytest.approx(2, abs=EXACT)

    def test_past_the_middle_of_three_circles(self) -> None:
        """Around the unit circle between two others, by symmetry along the tangent y = 1."""
        chord = shortest_visible(circle_grid(3, 1), 0, 2, 9)
        assert chord.length == pytest.approx(6, abs=1e-6)
        assert chord.length <= 6

    def test_none_through_a_wall(self) -> None:
        shapes = [Disc(-3, 0, 1), Disc(3, 0, 1), box(-0.5, 0.5, -9, 9)]
        assert shortest_visible(shapes, 0, 1, 9) is None

    def test_ambiguity(self) -> None:
        pair = [box(0, 1, 0, 1), box(3, 4, 0, 1)]
        assert ambiguous(pair, 0, 1, 2)
        assert not ambiguous(pair, 0, 1, 2.1)
        assert not ambiguous(pair, 0, 1, 1.9)

    @pytest.mark.parametrize("seed", range(6))
    def test_both_methods_agree(self, seed: int) -> None:
        make = degenerate_terrain if seed % 2 else random_terrain
        terrain = make(Random(seed))
        for j in range(1, len(terrain.shapes)):
            best = shortest_visible(terrain.shapes, 0, j, terrain.radius)
            sampled = shortest_by_sampling(terrain.shapes, 0, j, float(terrain.radius) * 1.01, 60)
            if best is None:
                assert (
                    sampled is None
                    or ambiguous(terrain.shapes, 0, j, terrain.radius)
                    or (sampled.length > terrain.radius)
                )
            else:
                assert free(terrain.shapes, best.start, best.end)
                assert free_sample_shorter(terrain.shapes, 0, j, best.length - 1e-9) is None
                assert sampled is None or -1e-9 < sampled.length - best.length < 0.1

    @examples(2, 200)
    @given(terrains())
    def test_images_have_the_same_weights(self, terrain: object) -> None:
        before = visibility_weights(terrain.shapes, terrain.radius, terrain.start)
        images = [(s.terrain(terrain), float(s.scale)) for s in SIMILARITIES.values()]
        for image, scale in [*images, (reversed_order(terrain), 1.0)]:
            after = visibility_weights(image.shapes, image.radius, image.start)
            assert after.keys() == before.keys()
            for key, chord in after.items():
                assert chord.length == pytest.approx(scale * before[key].length, abs=1e-10)

    @given(degenerate_terrains())
    def test_degenerate_scenes_have_free_weights(self, terrain: object) -> None:
        for chord in visibility_weights(terrain.shapes, terrain.radius).values():
            assert free(terrain.shapes, chord.start, chord.end)
            assert chord.length <= terrain.radius * (1 + EXACT)


class TestTour:
    def test_two_circles(self) -> None:
        shapes = [Disc(5, 0, 2), Disc(12, 0, 3)]
        tour = sightseer_order(shapes, visibility_weights(shapes, 20, (0, 0)))
        assert tour.visits == (0, 1)
        assert tour.length == pytest.approx(5 + 12 * math.pi, abs=1e-9)

    def test_two_squares(self) -> None:
        shapes = [box(2, 4, -1, 1), box(7, 9, -1, 1)]
        tour = sightseer_order(shapes, visibility_weights(shapes, 20, (0, 0)))
        assert tour.length == pytest.approx(24, abs=1e-9)

    def test_a_star_is_walked_there_and_back(self) -> None:
        """A wheel with three small circles around it: back to it twice, quarters and half turns between."""
        shapes = [Disc(0, 0, 2), Disc(4, 0, 1), Disc(0, 4.5, 1), Disc(-5, 0, 1)]
        tour = sightseer_order(shapes, visibility_weights(shapes, 2.5, (0, -3)))
        assert tour.visits == (0, 1, 2, 3)
        assert [edge.traversals for edge in tour.edges] == [1, 2, 2, 1]
        assert tour.length == pytest.approx(10 * math.pi + 3 * math.pi + 1 + 2 + 3 + 2, abs=1e-9)
