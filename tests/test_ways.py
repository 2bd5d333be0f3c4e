"""Straight ways in floats: the lines that cross one, and the edges that its own line meets."""

from __future__ import annotations

from fractions import Fraction as Q
from random import Random

import pytest

import exactacq as xa
from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Point
from exactacq.kernel.bounded import UNIT
from exactacq.kernel.single_lines import SingleImage, crossing_lines
from exactacq.kernel.ways import WayImage
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.own_line import on_line

GAPS = [Q(0), Q(0), Q(0), Q(1, 10**20), Q(1, 10**15), Q(1, 10**8)]
Pair = tuple[Q, Q]


def place(rng: Random, far: int) -> Pair:
    """A point of a small grid, or next to one, perhaps far from the origin."""
    x, y = (Q(far, 3) + rng.randrange(5) + rng.choice(GAPS) * rng.choice((-1, 1)) for _ in "xy")
    return x, y


def spot(point: Pair) -> tuple[float, float, float]:
    x, y = map(float, point)
    return x, y, UNIT * max(abs(x), abs(y))


def met(line: tuple[Pair, Pair], way: tuple[Pair, Pair]) -> tuple[Q, Q] | None:
    """Where two segments, which are not parallel, meet: parameters on both."""
    ((px, py), (qx, qy)), ((ax, ay), (bx, by)) = line, way
    dx, dy, wx, wy = qx - px, qy - py, bx - ax, by - ay
    under = wx * dy - wy * dx
    if not under:
        return None
    u, t = ((px - ax) * dy - (py - ay) * dx) / under, ((px - ax) * wy - (py - ay) * wx) / under
    return (t, u) if 0 <= t <= 1 and 0 <= u <= 1 else None


@pytest.mark.parametrize("seed", range(40))
def test_lines_that_cross_a_way_are_found(seed: int) -> None:
    """Each that does is found, with its place; one that is far from doing so is not."""
    rng = Random(seed)
    far = rng.choice([0, 0, 10**6, 10**12])
    left_out = crossing = 0
    for _ in range(60):
        points = [place(rng, far) for _ in range(4)]
        line, way = (points[0], points[1]), (points[2], points[3])
        if line[0] == line[1] or way[0] == way[1]:
            continue
        segments = [Segment(*(Point(*p) for p in pair)) for pair in (line, way)]
        (ax, ay, p), (bx, by, q) = map(spot, way)
        image = WayImage(
            curve_image(segments[1]), (0.0, 0.0), (1.0, 1.0), (ax, ay, bx, by, max(p, q)), [], []
        )
        single = SingleImage(spot(line[0]), spot(line[1]), rng.choice([None, curve_image(segments[0])]))
        found = crossing_lines([single], image)
        exact = met(line, way)
        if exact is not None:
            ((k, (low, high)),) = found
            assert k == 0 and low <= exact[1] <= high
            crossing += 1
        left_out += not found
    assert crossing >= 5 and (left_out >= 5 or far == 10**12)


@pytest.mark.parametrize("name", ["figure2", "circles", "plate"])
def test_edges_on_a_line(name: str) -> None:
    """No edge that a line meets is left out, nor one that its ray meets; most others are."""
    table, rng = EdgeTable(xa.load(name).obstacles), Random(name)
    every = range(len(table.curves))
    kept = 0
    for _ in range(30):
        a, b = (table.curves[rng.randrange(len(every))].start for _ in "ab")
        along = b - a if a != b else Point(1, Real(2).sqrt())
        found, ahead = (
            on_line(table, every, a, along, 256 * table.roundoff, is_ray) for is_ray in (False, True)
        )
        assert set(ahead) <= set(found)
        kept += len(found)
        for e in every:
            contacts = line_contacts(a, along, table.curves[e])
            assert e in found or not contacts
            assert e in ahead or not any(share.sign() >= 0 for share in contacts)
    assert kept < 30 * len(every)
