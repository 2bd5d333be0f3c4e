"""Images of families in the kernel: the numbers of lines, and which families matter."""

from __future__ import annotations

from math import inf
from random import Random

import networkx as nx
import pytest
from strategies import arc_terrain, degenerate_terrain

import exactacq as xa
from exactacq.kernel.choice import LegSpan, mattering
from exactacq.kernel.extents import Extent, Span
from exactacq.kernel.images import ROLLING
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.complex_edges import FamilySweeper
from exactacq.sensing.line_family import family_of
from exactacq.visibility.sensor_range import Range


def scene_of(seed: int) -> xa.Scene:
    return (arc_terrain, degenerate_terrain)[seed % 2](Random(seed)).scene()


def sweeper_of(seed: int) -> FamilySweeper:
    try:
        table = EdgeTable(scene_of(seed).obstacles)
    except xa.InvalidScene:
        pytest.skip("no scene")
    return FamilySweeper(table, Range(xa.Real(4).rational))


@pytest.mark.parametrize("seed", range(8))
def test_what_is_at_an_edge(seed: int) -> None:
    """All families and single lines of an edge, and no others; and single lines begin where it is said."""
    sweeper = sweeper_of(seed)
    edges = range(len(sweeper.table.curves))
    for found in map(sweeper.of, edges):
        for e in edges:
            assert found.at.get(e, []) == [one for one in found.images if e in one.edges]
            assert found.lines_at.get(e, []) == [
                one for one in found.single_lines if one.edge is not None and e in (one.edge, one.shown)
            ]
        for one in found.single_lines:
            if one.spot is not None and one.edge is not None:
                curve, u = sweeper.table.curves[one.edge], one.u
                assert u is not None and curve.passes(one.place)
                top = sweeper.clipper.rails[one.edge].top
                low, high = (0 if v == -inf else top if v == inf else xa.Real(v) for v in one.spot)
                if sweeper.table.full[one.edge]:
                    assert low <= u <= high or one.spot in ((-inf, -inf), (inf, inf))
                else:
                    assert low <= u <= high


def test_an_arc_sees_from_all_of_it() -> None:
    """What is near an arc's end is swept, though it is far from the corner where the arc starts."""
    half_disc = xa.Outline([(-3, 0), (3, 0, 1)])
    square = xa.Polygon([(-5, 1), (-4, 1), (-4, 2), (-5, 2)])
    table = EdgeTable(xa.Scene([half_disc, square], radius=2).obstacles)
    found = FamilySweeper(table, Range(xa.Real(2).rational)).of(1)
    tangents = [one for one in found.images if one.frame[0] == ROLLING]
    assert any(table.owner[e] == 1 for one in tangents for e in one.edges if e >= 0)


@pytest.mark.parametrize("seed", range(8))
def test_lines_have_one_number_for_each_name(seed: int) -> None:
    """Whatever feature a line is found from, it has the numbers of its names, and no other line has them."""
    sweeper = sweeper_of(seed)
    numbers: dict[object, int] = {}
    for e in range(len(sweeper.table.curves)):
        for image in sweeper.of(e).images:
            family = family_of(image)
            for names, keys in zip(family.names, (image.first_keys, image.last_keys), strict=True):
                if names:
                    assert len(keys) == len(names)
                    for (name, _), key in zip(names, keys, strict=True):
                        assert numbers.setdefault(name, key) == key and key >= 0
                else:
                    assert len(keys) == 1 and keys[0] < 0
    assert len(set(numbers.values())) == len(numbers) > 0


def number(rng: Random) -> float:
    return rng.choice([-inf, inf, *(k / 8 for k in range(9))])


def span(rng: Random) -> Span:
    return min(pair := (number(rng), number(rng))), max(pair)


def extents(rng: Random) -> list[Extent]:
    """Some families at a leg; where one surely is seen from lies within where it is seen from at most."""
    found = []
    for _ in range(rng.randint(1, 8)):
        outer = span(rng) if rng.random() < 0.5 else (low := number(rng), low + 1 / 8)
        inner = sorted(min(max(v, outer[0]), outer[1]) for v in span(rng))
        surely = (inner[0], inner[1]) if rng.random() < 0.7 else (inf, -inf)
        keys = [[rng.randrange(4)], [rng.randrange(4)]]
        known = rng.random() < 0.9
        found.append(Extent(rng.randrange(3), span(rng), outer, surely, *keys, None, 0, 1, known))
    return found


@pytest.mark.parametrize("seed", range(300))
def test_what_matters_by_its_definition(seed: int) -> None:
    """A family is left out only if it shows what is known, from within what is surely seen without a gap."""
    rng = Random(seed)
    some = extents(rng)
    known = {e: [rng.choice([(-inf, inf), span(rng)]) for _ in range(rng.randrange(3))] for e in range(3)}
    owners = {0: [(0, True)], 1: [(0, True), (1, False)]}
    leg = LegSpan((0.0, 0.0), (1.0, 1.0))
    numbers, _ = mattering(some, leg, owners, {0, 1}, set(), known)
    for n, one in enumerate(some):
        if one.edge not in owners:
            assert n not in numbers
            continue
        is_new = not any(a <= one.shown[0] and one.shown[1] <= b for a, b in known[one.edge])
        outer = one.source[0] <= 1 and one.source[1] >= 0
        if one.is_known and outer and is_new:
            assert n in numbers
        if not one.is_known:
            assert n in numbers
        if one.is_known and n not in numbers and outer and one.source[0] < inf and one.source[1] > -inf:
            for k, _ in owners[one.edge]:
                assert within_one_group(one, [two for two in some if (k, True) in owners.get(two.edge, [])])


def within_one_group(one: Extent, others: list[Extent]) -> bool:
    """Whether where a family is seen from lies in a connected union of what others are surely seen from."""
    sure = [o for o in others if o.is_known and o.surely[0] <= o.surely[1] and clipped(o.surely)]
    graph = nx.Graph()
    graph.add_nodes_from(range(len(sure)))
    for a, first in enumerate(sure):
        for b, last in enumerate(sure[:a]):
            low, high = clipped(first.surely), clipped(last.surely)
            meet = low[0] <= high[1] and high[0] <= low[1]
            if meet or {*first.first_keys, *first.last_keys} & {*last.first_keys, *last.last_keys}:
                graph.add_edge(a, b)
    low, high = clipped(one.source)
    for group in nx.connected_components(graph):
        ends = [clipped(sure[k].surely) for k in group]
        if min(a for a, _ in ends) <= low and high <= max(b for _, b in ends):
            return True
    return False


def clipped(source: Span) -> Span | None:
    """What of an interval lies in the leg, whose ends are infinite."""
    low, high = source
    if low > 1 or high < 0:
        return None
    return -inf if low <= 0 else low, inf if high >= 1 else high
