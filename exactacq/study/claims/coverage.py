"""How often pieces of a boundary are walked, counted exactly."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cmp_to_key

from exactacq.auditing.comparisons import is_part
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.interval_union import Interval
from exactacq.numbers.real import Real
from exactacq.sensing.path import Piece
from exactacq.strategies.run import Run
from exactacq.study.claims.walks import Stay


def times_walked(run: Run, stays: Iterable[Stay]) -> int:
    """The largest number of times that some piece of boundary was walked on stays at one obstacle, 0 if none.

    Single points do not count: the ends of walks that meet are not walked twice.
    """
    walked: dict[int, list[Interval]] = {}
    for stay in stays:
        edges = run.obstacles[stay.obstacle].edges
        for piece in stay.pieces:
            k, onward = _edge_of(edges, piece)
            walked.setdefault(k, []).extend(_intervals(edges[k], onward))
    return max((_most(intervals) for intervals in walked.values()), default=0)


def _edge_of(edges: Iterable[Curve], piece: Piece) -> tuple[int, Curve]:
    """The edge that a piece is a part of, and the piece in the edge's sense."""
    for k, edge in enumerate(edges):
        for curve in (piece.curve, piece.curve.reversed()):
            if is_part(curve, edge):
                return k, curve
    raise ValueError(f"the piece from {piece.start} is on no edge of its obstacle")


def _intervals(edge: Curve, part: Curve) -> list[Interval]:
    rail = Rail(edge)
    if isinstance(part, Arc) and part.full:
        return [Interval.whole(rail)]
    return Interval.between(rail, part.start, part.end)


def _most(intervals: Iterable[Interval]) -> int:
    """The largest number of intervals with an inner point in common."""
    ends = [(u, step) for i in intervals for u, step in ((i.low, 1), (i.high, -1))]

    def order(a: tuple[Real, int], b: tuple[Real, int]) -> int:
        return a[0].compare(b[0]) or a[1] - b[1]

    most = depth = 0
    for _, step in sorted(ends, key=cmp_to_key(order)):
        depth += step
        most = max(most, depth)
    return most
