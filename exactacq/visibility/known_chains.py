"""Chains: what is known of a boundary of which some is unknown, as a path has to take it.

A chain is a row of pieces of one boundary, each of which begins where the one before ends. It is a wall
without thickness: a path may touch it, follow it on both sides and turn around its ends, and does not cross
it. So it is a polygon without area, walked there and back, whose ends are corners of angle 0. The obstacle
lies to the left of the pieces; places on a chain, but for its ends, are on its right, the free side.

Chains have no point in common: those of one boundary are as long as they can be, and boundaries are disjoint.
Single known points are no walls.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point


class ChainPart(Protocol):
    """A known part of a boundary, on one of its edges; a single point has no curve."""

    @property
    def edge(self) -> int: ...
    @property
    def curve(self) -> Curve | None: ...


@dataclass(frozen=True, eq=False)
class ChainPiece:
    """A piece of a chain, and the edge of the scene that it is a part of: this has rational data."""

    curve: Curve
    edge: Curve

    def reversed(self) -> ChainPiece:
        """The piece on the way back."""
        return ChainPiece(self.curve.reversed(), self.edge.reversed())

    def direction(self, point: Point) -> Point:
        """The direction of travel at a point; rational where the point is, and on every segment."""
        return self.edge.tangent(point) if isinstance(self.edge, Arc) else self.edge.direction


@dataclass(frozen=True, eq=False)
class KnownChain:
    """A chain of an obstacle's boundary, by the obstacle's number on the map.

    ``opens`` tells whether a path may turn around its start, and around its end: not where the boundary
    itself ends, at the border of a terrain.
    """

    obstacle: int
    pieces: tuple[ChainPiece, ...]
    opens: tuple[bool, bool]


def known_chains(
    obstacle: int, parts: Iterable[ChainPart], edges: Sequence[Curve], closed: bool, wholes: Sequence[Curve]
) -> list[KnownChain]:
    """The chains of the known parts of a boundary, in order; linear in these.

    *edges* are the boundary's, a loop if *closed*, and *wholes* the scene's edges that these are parts of.
    """
    rows: list[list[tuple[int, Curve]]] = []
    for part in parts:
        if part.curve is None:
            continue
        if rows and rows[-1][-1][0] + 1 == part.edge and _meet(rows[-1][-1], (part.edge, part.curve), edges):
            rows[-1].append((part.edge, part.curve))
        else:
            rows.append([(part.edge, part.curve)])
    around = closed and len(rows) > 0 and rows[-1][-1][0] == len(edges) - 1 and rows[0][0][0] == 0
    if around and (len(rows) > 1 or len(edges) > 1) and _meet(rows[-1][-1], rows[0][0], edges):
        assert len(rows) > 1, "a boundary that is known all around is no chain"
        rows[0] = rows.pop() + rows[0]
    return [_chain(obstacle, row, edges, closed, wholes) for row in rows]


def _meet(one: tuple[int, Curve], other: tuple[int, Curve], edges: Sequence[Curve]) -> bool:
    """Whether a part of an edge and one of the next one meet in the vertex between the two."""
    (e, first), (f, second) = one, other
    at_end = first.end is edges[e].end or first.end == edges[e].end
    return at_end and (second.start is edges[f].start or second.start == edges[f].start)


def _chain(
    obstacle: int, row: list[tuple[int, Curve]], edges: Sequence[Curve], closed: bool, wholes: Sequence[Curve]
) -> KnownChain:
    pieces: list[ChainPiece] = []
    for e, curve in row:
        piece = ChainPiece(curve, wholes[e])
        longer = _joined(pieces[-1], piece) if pieces else None
        if longer is None:
            pieces.append(piece)
        else:
            pieces[-1] = longer
    (first, start), (last, end) = row[0], row[-1]
    opens = True, True
    if not closed:
        opens = (
            not (first == 0 and start.start == edges[0].start),
            not (last == len(edges) - 1 and end.end == edges[-1].end),
        )
    return KnownChain(obstacle, tuple(pieces), opens)


def _joined(one: ChainPiece, other: ChainPiece) -> ChainPiece | None:
    """One piece for two that follow each other on a line or circle, else None."""
    a, b = one.edge, other.edge
    if isinstance(a, Arc) and isinstance(b, Arc):
        if (a.ccw, a.radius_sq) != (b.ccw, b.radius_sq) or a.center != b.center:
            return None
        return ChainPiece(Arc(one.curve.start, other.curve.end, a.center, a.radius_sq, a.ccw), a)
    if isinstance(a, Segment) and isinstance(b, Segment):
        turn, ahead = a.direction.cross(b.direction), a.direction.dot(b.direction)
        if turn.sign() == 0 and ahead.sign() > 0:
            return ChainPiece(Segment(one.curve.start, other.curve.end), a)
    return None
