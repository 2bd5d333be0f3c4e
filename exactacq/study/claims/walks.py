"""What a finished path did, read off its pieces alone: stays on boundaries, and moves between obstacles.

A *stay* is a maximal run of boundary pieces on one obstacle. A *move* is a straight piece of a Sightseer's
path. Where a move begins and ends is found by asking boundaries, not the strategy's notes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from exactacq.auditing.comparisons import same
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.event import EventKind
from exactacq.sensing.path import Piece
from exactacq.strategies.run import Run, SightseerRun
from exactacq.visibility.links import START, Node

BITS = 256
"""Balls of this precision tell which of several disjoint boundaries holds a point of one of them."""


@dataclass(frozen=True)
class Stay:
    """The pieces ``first`` to ``last``, the latter excluded, on the boundary of ``obstacle``."""

    obstacle: int
    first: int
    last: int
    pieces: tuple[Piece, ...]

    @property
    def length(self) -> Length:
        """How far the robot walked."""
        return Length.sum(piece.length for piece in self.pieces)


def stays(run: Run) -> Iterator[Stay]:
    """The stays of a path, in order. A stop at a boundary without a walk along it is none.

    An obstacle that is left may block the M-line again at once: then another stay begins there.
    """
    first = 0
    left = {event.after for event in run.events if event.kind is EventKind.LEAVE and not event.inside}
    for k in range(1, len(run.path) + 1):
        if k < len(run.path) and run.path[k].obstacle == run.path[first].obstacle and k not in left:
            continue
        owner = run.path[first].obstacle
        if owner is not None:
            yield Stay(owner, first, k, tuple(run.path[first:k]))
        first = k


def is_circuit(run: Run, stay: Stay) -> bool:
    """Whether a stay walks all of the boundary: a full turn first, or from end to end of an open one."""
    body = run.obstacles[stay.obstacle]
    if not body.closed:
        ends = body.edges[0].start, body.edges[-1].end
        reached = [piece.start for piece in stay.pieces] + [stay.pieces[-1].end]
        return all(any(same(end, point) for point in reached) for end in ends)
    walked, guess = Length(0), float(body.perimeter)
    for piece in stay.pieces:
        walked = walked + piece.length
        # The exact comparison is asked only where it can be equal.
        if abs(float(walked) - guess) <= 1e-9 * guess and walked == body.perimeter:
            return same(piece.end, stay.pieces[0].start)
    return False


class Move(NamedTuple):
    """Straight piece number ``at`` of a Sightseer's path, between two nodes.

    ``visited`` are the obstacles that were circumnavigated before.
    """

    at: int
    piece: Piece
    source: Node
    target: Node
    visited: frozenset[int]

    @property
    def returns(self) -> bool:
        """Whether it leads to where the robot was before."""
        return self.target == START or self.target in self.visited


def node_at(run: Run, point: Point) -> Node:
    """The obstacle on whose boundary a point lies, or "S" for a free start.

    ValueError if balls leave no obstacle, or several.
    """
    owners = {o.index for o in run.scene.obstacles for edge in o.edges if edge.may_pass(point, BITS)}
    if not owners and same(point, run.start):
        return START
    if len(owners) != 1:
        raise ValueError(f"{point} is on {len(owners)} boundaries")
    return owners.pop()


def moves(run: SightseerRun) -> list[Move]:
    """The moves of a Sightseer's path, in order."""
    circled = {stay.first: stay.obstacle for stay in stays(run) if is_circuit(run, stay)}
    visited: frozenset[int] = frozenset()
    made: list[Move] = []
    for k, piece in enumerate(run.path):
        if k in circled:
            visited |= {circled[k]}
        if piece.kind == "straight":
            made.append(Move(k, piece, node_at(run, piece.start), node_at(run, piece.end), visited))
    return made


def is_same_segment(a: Piece, b: Piece) -> bool:
    """Whether two straight pieces are one segment, walked either way."""
    if abs(float(a.length) - float(b.length)) > 1e-6 * (1 + float(a.length)):
        return False
    forward = same(a.start, b.start) and same(a.end, b.end)
    return forward or (same(a.start, b.end) and same(a.end, b.start))


def traversals(made: Sequence[Move]) -> list[tuple[Move, int]]:
    """Every segment that was walked, with how often, either way."""
    counted: list[tuple[Move, int]] = []
    for move in made:
        for k, (first, count) in enumerate(counted):
            ends = {move.source, move.target}
            if ends == {first.source, first.target} and is_same_segment(move.piece, first.piece):
                counted[k] = first, count + 1
                break
        else:
            counted.append((move, 1))
    return counted
