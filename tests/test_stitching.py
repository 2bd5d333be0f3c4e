"""Ends of lines in clusters: beside all pairs of them, and many ends within one tolerance."""

from __future__ import annotations

import time
from random import Random

import networkx
import pytest
from flint import fmpq
from nightly import some

from exactacq.files.loops import stitching
from exactacq.files.loops.chains import ZERO, Chain, Corner

SECONDS = 20
"""More than 16,000 ends may take, on a busy machine too; it is about one second."""


@pytest.mark.parametrize("seed", some(range(60), 12))
def test_clusters_are_those_of_all_pairs(seed: int) -> None:
    dice = Random(seed)
    size, tolerance = dice.choice((4, 12, 40)), fmpq(dice.choice((0, 1, 2, 3)), dice.choice((1, 2)))
    corners = [
        Corner(fmpq(dice.randint(-size, size)), fmpq(dice.randint(-size, size)), ZERO) for _ in range(40)
    ]
    pairs = networkx.Graph(
        (i, j)
        for i, a in enumerate(corners)
        for j, b in enumerate(corners)
        if (a.x - b.x) ** 2 + (a.y - b.y) ** 2 <= tolerance**2
    )
    found = {frozenset(group) for group in stitching._near(corners, tolerance).to_sets()}
    assert found == {frozenset(group) for group in networkx.connected_components(pairs)}


def test_many_ends_within_one_tolerance() -> None:
    """All pairs of them were compared: a drawing of a megabyte took half an hour."""
    dice = Random(1)

    def near(x: int) -> Corner:
        return Corner(x + fmpq(dice.randrange(10**9), 10**15), fmpq(dice.randrange(10**9), 10**15), ZERO)

    chains = [Chain(f"line {k}", [near(0), near(1)]) for k in range(8000)]
    begun = time.process_time()
    done = stitching.stitch(chains, fmpq(1, 10**5))
    assert (len(done.open_chains), done.duplicates) == (1, 7999)
    assert time.process_time() - begun < SECONDS
