"""The gaps that keep chains of a drawing open, and the tolerances that close them.

Stitching joins two ends that are within the tolerance, but no three. So an end is joined first with the end
nearest to it, and well only if that is mutual; it stays joined well until the tolerance reaches a third end
from either. A loop of chains therefore closes for all tolerances from its widest gap to just below the least
distance of a third end, if there are any.

But a tolerance is one for the whole drawing: it also takes out edges that are not longer, and joins ends of
pieces that are loops already. So those that are proposed were tried on all pieces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from flint import fmpq

from exactacq.files.loops.chains import Chain, Corner, distance_above, scientific_above
from exactacq.files.loops.stitching import Stitched, stitch
from exactacq.geometry.strokes import Floats
from exactacq.numbers.rationals import nearest_float, rational

MAX_ENDS = 4000
"""Loose ends beyond which nothing is suggested: their distances would take seconds and a gigabyte."""
MOST_EDGES = 10_000
"""Edges of a drawing beyond which no tolerance is tried: stitching takes some 80 microseconds for each."""
MOST_TRIED, MOST_STITCHED = 6, 30_000
"""How many tolerances are tried besides the one that should close most; fewer for a drawing of many edges, so
that not many more edges are stitched in all."""
MOST_PAIRS = 200_000
"""A tolerance with which so many pairs of ends may be near each other is not tried: it would take seconds."""
PLACES = (2, 4, 8)
"""A tolerance is rounded up to as few digits as the distance of a third end allows."""
WIDER = 10
"""A tolerance is not proposed for a gap that is so many times narrower."""
NEAR_TIE = 1e-6
"""Floats leave to exact numbers which of ends is nearest if squared distances agree up to this fraction."""


@dataclass(frozen=True, slots=True)
class LooseGap:
    """Two loose ends that are nearest to each other: their pieces, places, and a bound of their distance.

    The *width* is at least the distance, and at most a billionth of it more.
    """

    pieces: tuple[str, str]
    places: tuple[tuple[fmpq, fmpq], tuple[fmpq, fmpq]]
    width: fmpq


@dataclass(frozen=True, slots=True)
class Closing:
    """Open chains, by their numbers, which the gaps make one loop.

    With the *tolerance* they close; it is None if a third end is as near to one of the gaps.
    """

    chains: tuple[int, ...]
    gaps: tuple[LooseGap, ...]
    tolerance: fmpq | None
    below: fmpq | None
    """The squared distance of the nearest third end: a tolerance that reaches it makes a branch point."""


@dataclass(frozen=True, slots=True)
class TriedTolerance:
    """A tolerance for one *closing*: when it was tried it closed *chains*, and no loop was lost."""

    closing: Closing
    tolerance: fmpq
    chains: frozenset[int]


@dataclass(frozen=True, slots=True)
class ChainGaps:
    """What would close open chains, and the tolerances that do, from the least to the largest."""

    closings: tuple[Closing, ...] = ()
    tried: tuple[TriedTolerance, ...] = ()

    def least(self, chain: int) -> fmpq | None:
        """The least tolerance that closes a chain, unless it is more than `WIDER` times its widest gap."""
        own = next((closing for closing in self.closings if chain in closing.chains), None)
        if own is None:
            return None
        most = WIDER * max(gap.width for gap in own.gaps)
        return next((t.tolerance for t in self.tried if chain in t.chains and t.tolerance <= most), None)


@dataclass(frozen=True, slots=True)
class _LooseEnd:
    chain: int
    side: int
    corner: Corner
    label: str


def closings(paths: Sequence[Sequence[Chain]]) -> list[Closing]:
    """What closes open chains, each given as its pieces in order; chains that nothing closes are left out.

    What has fewer than three edges, all straight, encloses nothing and is no loop. Edges not
    longer than the tolerance are taken out by stitching, too. Quadratic in the chains, in numpy; nothing is
    found for more than `MAX_ENDS` ends.

    >>> def line(*places):
    ...     return [Chain("line", [Corner(fmpq(x), fmpq(y), fmpq(0)) for x, y in places])]
    >>> u_turn = line((0, 0), (9, 0), (9, 9), (0, 9))
    >>> closing, = closings([u_turn, line((0, 8), (0, 2))])
    >>> closing.chains, [str(gap.width) for gap in closing.gaps], closing.tolerance
    ((0, 1), ['2', '1'], 2)
    """
    ends = [end for k, path in enumerate(paths) for end in _ends(k, path)]
    if len(ends) < 2 or len(ends) > MAX_ENDS:
        return []
    nearest, second = _neighbours(ends, [_may_close(path) for path in paths])
    mates = {i: j for i, j in enumerate(nearest) if j is not None and nearest[j] == i}
    found = []
    seen: set[int] = set()
    for first in range(0, len(ends), 2):
        ring: list[int] = []
        here = first
        while here in mates and here // 2 not in seen:
            seen.add(here // 2)
            ring.append(here)
            here = mates[here] ^ 1
        if ring and here == first and _may_close([piece for i in ring for piece in paths[i // 2]]):
            found.append(_closing(ends, ring, mates, second))
    return found


def best_tolerance(found: Sequence[Closing]) -> tuple[fmpq, int] | None:
    """The tolerance that closes most, the least one of such, and how many chains it closes."""
    counted = []
    for closing in found:
        if (tolerance := closing.tolerance) is not None:
            closed = [c for c in found if c.tolerance is not None and c.tolerance <= tolerance]
            closed = [c for c in closed if c.below is None or tolerance * tolerance < c.below]
            counted.append((sum(len(c.chains) for c in closed), -tolerance))
    if not counted:
        return None
    most, negative = max(counted)
    return -negative, most


def copied(chains: Sequence[Chain]) -> list[Chain]:
    """Chains that may be altered."""
    return [replace(chain, corners=[replace(corner) for corner in chain.corners]) for chain in chains]


def gaps_of(stitched: Stitched, chains: Sequence[Chain]) -> ChainGaps:
    """The gaps of the open chains, and which tolerances close them; *chains* are all pieces before stitching.

    Each tolerance is tried on copies of these, none if they are not given. It counts if it closes the chains
    that it was chosen for, if all loops are still there, with no piece of them open, and if no more of their
    corners are branch points, to which it would have moved other ends.
    """
    found = closings(stitched.open_chains)
    if not chains:
        return ChainGaps(tuple(found))
    ends = [chain.corners[-side] for chain in chains if not chain.closed for side in (0, 1)]
    loops, knots = {loop.label for loop in stitched.loops}, _knots(stitched)
    pieces = [{piece.label for piece in path} for path in stitched.open_chains]
    tried = []
    most = max(1, min(MOST_TRIED, MOST_STITCHED // max(1, sum(chain.edges for chain in chains))))
    for tolerance in _candidates(found, most):
        if _is_crowded(ends, tolerance):
            break
        again = stitch(copied(chains), tolerance)
        still_open = {piece.label for path in again.open_chains for piece in path}
        is_lost = loops - {loop.label for loop in again.loops} or stitched.inside & still_open
        if is_lost or _knots(again) > knots:
            continue
        closed = frozenset(k for k, own in enumerate(pieces) if own & again.inside and not own & still_open)
        wanted = (c for c in found if c.tolerance == tolerance and closed.issuperset(c.chains))
        if (closing := next(wanted, None)) is not None:
            tried.append(TriedTolerance(closing, tolerance, closed))
    return ChainGaps(tuple(found), tuple(tried))


def _knots(stitched: Stitched) -> int:
    """How many branch points loops go through."""
    return len({(c.x, c.y) for loop in stitched.loops for c in loop.corners}.intersection(stitched.branches))


def _candidates(found: Sequence[Closing], most: int) -> list[fmpq]:
    """Tolerances to be tried, in order: the one that should close most, and as many others as are wanted.

    If there are more, one serves all gaps that are less than `WIDER` times narrower.
    """
    best = best_tolerance(found)
    if best is None:
        return []
    every = sorted({closing.tolerance for closing in found if closing.tolerance is not None})
    if len(every) > most:
        some = every[:1]
        for tolerance in every:
            if tolerance > some[-1]:
                some.append(max(other for other in every if other <= (WIDER - 1) * tolerance))
        every = some[:most]
    return sorted({best[0], *every})


def _is_crowded(ends: Sequence[Corner], tolerance: fmpq) -> bool:
    """Whether squares as wide as a tolerance hold more than `MOST_PAIRS` pairs of ends."""
    places, size = _scaled(ends)
    cells = np.floor(places / max(nearest_float(tolerance / size), 1e-300))
    counts = np.unique(cells, axis=0, return_counts=True)[1]
    return bool((counts.astype(float) ** 2).sum() > MOST_PAIRS)


def _ends(k: int, path: Sequence[Chain]) -> tuple[_LooseEnd, _LooseEnd]:
    """The ends of a path of pieces: those that no other piece of it meets."""
    first, last = path[0], path[-1]
    alone = len(path) == 1
    sides = (0, 1) if alone else (1 - _meeting(first, path[1]), 1 - _meeting(last, path[-2]))
    return (
        _LooseEnd(k, 0, first.corners[-sides[0]], first.label),
        _LooseEnd(k, 1, last.corners[-sides[1]], last.label),
    )


def _meeting(piece: Chain, other: Chain) -> int:
    """Which end of a piece, 0 or 1, is one of another piece's."""
    places = {(c.x, c.y) for c in (other.corners[0], other.corners[-1])}
    return 0 if (piece.corners[0].x, piece.corners[0].y) in places else 1


def _may_close(path: Sequence[Chain]) -> bool:
    """Whether a path whose ends are joined is a loop that encloses something."""
    edges = sum(piece.edges for piece in path)
    return edges > 2 or any(corner.bulge for piece in path for corner in piece.corners[:-1])


def _neighbours(
    ends: Sequence[_LooseEnd], may_close: Sequence[bool]
) -> tuple[list[int | None], list[fmpq | None]]:
    """The nearest end of each, None for a tie, and the exact squared distance of the second nearest.

    Floats choose those that exact distances compare.
    """
    places, _ = _scaled([end.corner for end in ends])
    nearest: list[int | None] = []
    second: list[fmpq | None] = []
    for i, end in enumerate(ends):
        apart = ((places - places[i]) ** 2).sum(axis=1)
        apart[i] = np.inf
        if not may_close[end.chain]:
            apart[i ^ 1] = np.inf
        least = np.partition(apart, 1)[1]
        near = np.flatnonzero(apart <= least * (1 + NEAR_TIE)).tolist() if np.isfinite(apart.min()) else []
        exact = sorted((_squared(end.corner, ends[j].corner), j) for j in near if np.isfinite(apart[j]))
        tied = not exact or (len(exact) > 1 and exact[0][0] == exact[1][0])
        nearest.append(None if tied else exact[0][1])
        second.append(exact[1][0] if len(exact) > 1 else None)
    return nearest, second


def _scaled(corners: Sequence[Corner]) -> tuple[Floats, fmpq]:
    """Corners seen from the first one, in floats, divided by their size, and that size."""
    (x0, y0) = corners[0].x, corners[0].y
    size = max(max(abs(c.x - x0), abs(c.y - y0)) for c in corners) or fmpq(1)
    return np.array([(float((c.x - x0) / size), float((c.y - y0) / size)) for c in corners]), size


def _squared(a: Corner, b: Corner) -> fmpq:
    return (a.x - b.x) ** 2 + (a.y - b.y) ** 2


def _closing(
    ends: Sequence[_LooseEnd], ring: Sequence[int], mates: dict[int, int], second: Sequence[fmpq | None]
) -> Closing:
    gaps = []
    limits = []
    for i in ring:
        one, other = ends[i], ends[mates[i]]
        places = ((one.corner.x, one.corner.y), (other.corner.x, other.corner.y))
        gaps.append(LooseGap((one.label, other.label), places, distance_above(one.corner, other.corner)))
        limits += [s for s in (second[i], second[mates[i]]) if s is not None]
    widest, below = max(gap.width for gap in gaps), min(limits, default=None)
    rounded = (rational(scientific_above(widest, places)) for places in PLACES)
    fit = [t for t in (*rounded, widest) if below is None or t * t < below]
    chains = tuple(sorted(i // 2 for i in ring))
    return Closing(chains, tuple(gaps), fit[0] if fit else None, below)
