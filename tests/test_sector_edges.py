"""Edges that no line of a sector meets: a sweep without them finds what it finds with them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from random import Random

import pytest
from flint import fmpq
from nightly import some
from strategies import arc_terrain, degenerate_terrain, random_terrain

from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.complex_edges import FamilySweeper, normals
from exactacq.visibility import rotational_sweep
from exactacq.visibility.features import features
from exactacq.visibility.line_families import Sector
from exactacq.visibility.rotational_sweep import Pencil, swept
from exactacq.visibility.sensor_range import Range

TERRAINS = {"general": random_terrain, "degenerate": degenerate_terrain, "arcs": arc_terrain}


def sectors(table: EdgeTable) -> Iterator[tuple[Sector, tuple[int, ...], bool]]:
    """Tangents, which go back from the contact too, and normals, which do not; with the edges there."""
    sweeper = FamilySweeper(table, Range(fmpq(1)))
    for feature in features(table):
        for sector in feature.sectors:
            yield sector, feature.edges, True
        for sector in () if feature.round else sweeper._corner_normals(feature):
            yield sector, feature.edges, False
    for e, curve in enumerate(table.curves):
        for sector in normals(curve):
            yield sector, (e,), False


def cells(pencil: Pencil, goes_back: bool) -> list[tuple[int | None, int | None, Real, Real]]:
    """What lines meet behind and ahead, from which one to which; joined where that is the same."""
    rows = [pencil.cell(row) for row in pencil.rows]
    found = []
    for met, group in groupby(rows, key=lambda row: (row.behind if goes_back else None, row.ahead)):
        joined = list(group)
        found.append((*met, joined[0].low, joined[-1].high))
    return found


@pytest.mark.parametrize("kind", TERRAINS)
@pytest.mark.parametrize("seed", some(range(40), 5))
def test_sweeps_are_the_same(kind: str, seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    table = EdgeTable(TERRAINS[kind](Random(seed)).scene().obstacles)
    every, counts = list(range(len(table.curves))), []
    may_be_met = rotational_sweep.may_be_met

    def counted(*args: object) -> list[int]:
        found = may_be_met(*args)  # type: ignore[arg-type]
        counts.append(len(found))
        return found

    def both(sector: Sector, own: tuple[int, ...], goes_back: bool) -> Iterator[Pencil]:
        for chosen in (counted, lambda _images, edges, *_: edges):
            monkeypatch.setattr(rotational_sweep, "may_be_met", chosen)
            yield swept(table, sector, own, every, goes_back=goes_back)

    for sector, own, goes_back in sectors(table):
        fewer, all_ = both(sector, own, goes_back)
        pairs = zip(cells(fewer, goes_back), cells(all_, goes_back), strict=True)
        for (*met, low, high), (*expected, first, last) in pairs:
            assert met == expected and low == first and high == last
        if goes_back:
            found = [[(t, set(passed)) for t, passed in pencil.pinches] for pencil in (fewer, all_)]
            for (t, passed), (at, expected) in zip(*found, strict=True):
                assert t == at and passed == expected
    assert sum(counts) < len(every) * len(counts)
