"""Suggested tolerances, tried on the stitching itself."""

from __future__ import annotations

from random import Random

import pytest
from flint import fmpq

from exactacq.files.loops.chains import Chain, Corner
from exactacq.files.loops.stitching import stitch
from exactacq.files.repairs.gaps import (
    MOST_PAIRS,
    MOST_TRIED,
    ChainGaps,
    TriedTolerance,
    best_tolerance,
    closings,
    copied,
    gaps_of,
)

LESS = 1 - fmpq(1, 10**6)


def line(*places: tuple[object, object], label: str = "line", bulge: int = 0) -> Chain:
    return Chain(label, [Corner(fmpq(x), fmpq(y), fmpq(bulge)) for x, y in places])


def stitched(paths: list[list[Chain]], tolerance: fmpq) -> int:
    """How many loops there are with a tolerance."""
    copies = [
        Chain(piece.label, [Corner(c.x, c.y, c.bulge) for c in piece.corners])
        for path in paths
        for piece in path
    ]
    return len(stitch(copies, tolerance).loops)


def test_a_chain_closes_at_the_width_of_its_gap() -> None:
    path = [line((0, 0), (9, 0), (9, 9), (1, 1))]
    (closing,) = closings([path])
    assert closing.gaps[0].width ** 2 > 2 > (closing.gaps[0].width * LESS) ** 2
    assert closing.tolerance == fmpq(3, 2)
    assert stitched([path], closing.tolerance) == 1
    assert stitched([path], fmpq(7, 5)) == 0


def test_pieces_of_a_path_are_followed_to_its_ends() -> None:
    first, second = line((0, 0), (9, 0)), line((9, 9), (9, 0))
    third = line((9, 9), (0, 9), (0, 1))
    (closing,) = closings([[first, second, third]])
    assert closing.gaps[0].places == ((0, 0), (0, 1))
    assert closing.tolerance == 1


@pytest.mark.parametrize("seed", range(30))
def test_the_tolerance_is_the_least_that_closes_a_broken_polygon(seed: int) -> None:
    random = Random(seed)
    corners = [(0, 0), (100, 0), (130, 70), (100, 100), (0, 100)]
    paths = []
    for (x, y), (u, v) in zip(corners, corners[1:] + corners[:1], strict=True):
        a, b, c, d = (fmpq(random.randrange(-9, 10), 4) for _ in range(4))
        ends = [(x + a, y + b), (u + c, v + d)]
        paths.append([line(*(ends if random.random() < 0.5 else ends[::-1]))])
    random.shuffle(paths)
    (closing,) = closings(paths)
    assert closing.chains == (0, 1, 2, 3, 4)
    widest = max(gap.width for gap in closing.gaps)
    assert stitched(paths, closing.tolerance) == 1
    assert stitched(paths, widest * LESS) == 0
    assert widest <= closing.tolerance <= widest * fmpq(11, 10)


def test_a_third_end_as_near_closes_nothing() -> None:
    around = line((0, 0), (9, 0), (9, 9), (0, 9), (0, 1))
    assert closings([[around], [line((0, 1), (0, 5))]]) == []
    (closing,) = closings([[around], [line((-1, 1), (-5, 1))]]) or [None]
    assert closing is None


def test_a_third_end_a_little_farther_bounds_the_tolerance() -> None:
    paths = [[line((0, 0), (9, 0), (9, 9))], [line((9, 9), (0, 9), (0, 3))], [line((0, -4), (5, -50))]]
    (closing,) = closings(paths)
    assert closing.tolerance == 3
    assert closing.below == 16
    assert stitched(paths, closing.tolerance) == 1


def test_the_best_tolerance_closes_most() -> None:
    def square(x: int, gap: int) -> list[Chain]:
        return [line((x, 0), (x + 20, 0), (x + 20, 20), (x, 20), (x, gap))]

    paths = [square(0, 1), square(100, 2), square(200, 3), [line((200, -5), (200, -80))]]
    found = closings(paths)
    assert [closing.tolerance for closing in found] == [1, 2, 3]
    assert best_tolerance(found) == (3, 3)
    assert best_tolerance([]) is None


@pytest.mark.parametrize(
    "path",
    [[line((0, 0), (1, 0))], [line((0, 0), (1, 0), (0, 1))], []],
)
def test_what_encloses_nothing_has_no_gap(path: list[Chain]) -> None:
    assert closings([path] if path else []) == []


def test_an_arc_alone_is_closed_by_a_tolerance_over_its_chord() -> None:
    (closing,) = closings([[line((0, 0), (1, 0), (0, 1), bulge=1)]])
    assert closing.chains == (0,)


def test_two_lines_side_by_side_enclose_nothing() -> None:
    """Their ends joined, they would be one line drawn twice: found in a real part of two slots' sides."""
    sides = [[line((0, 0), (0, 50))], [line((10, 0), (10, 50))]]
    assert closings(sides) == []
    (closing,) = closings([sides[0], [line((10, 0), (15, 25), (10, 50))]])
    assert closing.chains == (0, 1)


def square(x: int, gap: object, label: str) -> Chain:
    return line((x, 0), (x + 20, 0), (x + 20, 20), (x, 20), (x, gap), label=label)


def test_no_more_than_some_tolerances_are_tried() -> None:
    """One serves many gaps, but none is told for a gap that is far narrower."""
    gaps = [fmpq(k, 10**6) for k in range(1, 21)] + [fmpq(k, 10) for k in range(1, 31)]
    chains = [square(100 * k, gap, f"line {k}") for k, gap in enumerate(gaps)]
    found = gaps_of(stitch(copied(chains), fmpq(0)), chains)
    tolerances = [tried.tolerance for tried in found.tried]
    assert len(tolerances) <= MOST_TRIED + 1 and (tolerances[0], tolerances[-1]) == (gaps[0], gaps[-1])
    for tried in found.tried:
        assert tried.chains == {k for k, gap in enumerate(gaps) if gap <= tried.tolerance}
    for k, gap in enumerate(gaps):
        assert gap <= found.least(k) <= 10 * gap


def test_a_tolerance_is_not_told_for_a_gap_that_is_far_narrower() -> None:
    """Its own did not help; the wide one closes it, but is none for it."""
    chains = [square(100 * k, gap, f"line {k}") for k, gap in enumerate([fmpq(1, 10**3), fmpq(3)])]
    found = closings([[chain] for chain in chains])
    told = ChainGaps(tuple(found), (TriedTolerance(found[1], fmpq(3), frozenset({0, 1})),))
    assert (told.least(0), told.least(1)) == (None, 3)


def test_tolerances_near_many_ends_are_not_tried() -> None:
    """So many ends would be near each other that to find them takes seconds."""
    many = int(MOST_PAIRS**0.5) // 2 + 1
    dust = [line((fmpq(k, 100), 1), (fmpq(k, 100), -9), label=f"dust {k}") for k in range(2 * many)]
    chains = [square(100, 3, "wide"), square(200, fmpq(1, 10), "narrow"), *dust]
    found = gaps_of(stitch(copied(chains), fmpq(0)), chains)
    assert [tried.tolerance for tried in found.tried] == [fmpq(1, 10)]
