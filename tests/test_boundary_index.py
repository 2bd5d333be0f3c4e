"""Which edges a point or its ray may meet: all that do are found, also beyond floats."""

from __future__ import annotations

from random import Random

import pytest
from flint import fmpq

import exactacq as xa
from exactacq import kernel
from exactacq.geometry.boundary_index import BoundaryIndex
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.loops import locate
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real

GEAR = xa.Scene(
    [
        xa.Outline(
            [(4 * k, 5 * (k % 2), "1/9" if k % 3 else "-1/8") for k in range(24)] + [(93, -9, 0), (0, -9, 0)]
        )
    ]
).obstacles[0]
PLACES = [
    *(edge.start for edge in GEAR.edges),
    *(edge.point("1/2") for edge in GEAR.edges),
    *(Point(edge.start.x + fmpq(1, 10**40), edge.start.y) for edge in GEAR.edges),
    *(Point(edge.start.x - Real(2).sqrt(), edge.end.y) for edge in GEAR.edges),
]


@pytest.mark.parametrize("exact_only", [False, True])
def test_no_edge_that_is_met_is_left_out(exact_only: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel, "EXACT_ONLY", exact_only)
    index, left_out = BoundaryIndex(GEAR.edges), 0
    for place in PLACES:
        passed = [k for k, edge in enumerate(GEAR.edges) if edge.passes(place)]
        hit = [
            k
            for k, edge in enumerate(GEAR.edges)
            if any(t.sign() >= 0 for t in line_contacts(place, Point(1, 0), edge))
        ]
        near, east = index.may_pass(place), index.may_be_east(place)
        assert set(passed) <= set(near) <= set(east) >= set(hit)
        assert GEAR.edges_at(place) == tuple(passed)
        assert GEAR.locate(place) is locate(GEAR.edges, place)
        left_out += len(GEAR.edges) - len(near)
    assert (left_out == 0) is exact_only


def test_points_beyond_floats_are_located() -> None:
    for x in (Real(10**400), Real(-(10**400)), Real(10**701).sqrt()):
        assert GEAR.locate(Point(x, 0)).name == "OUTSIDE"
        assert GEAR.edges_at(Point(x, x)) == ()


def test_random_points_lie_where_all_edges_say() -> None:
    rng = Random(5)
    for _ in range(300):
        place = Point(fmpq(rng.randrange(-300, 9900), 100), fmpq(rng.randrange(-1000, 800), 100))
        assert GEAR.locate(place) is locate(GEAR.edges, place)
