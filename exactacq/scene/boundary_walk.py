"""Walks along an obstacle's boundary: positions, the shorter way between two points, path pieces."""

from __future__ import annotations

from collections.abc import Sequence

from exactacq.cached import cached_property
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length


class Boundary:
    """The boundary of one obstacle as a closed line that starts and ends at its first vertex.

    Positions grow in the stored direction, which keeps the obstacle on the left: counterclockwise, and
    clockwise inside an enclosure. Points given must lie on the boundary. If it is not *closed* it is a line
    with two ends, and there is one way from any point to another.
    """

    def __init__(self, edges: Sequence[Curve], perimeter: Length, closed: bool = True) -> None:
        self.edges, self.perimeter, self.closed = edges, perimeter, closed
        self._found: tuple[tuple[Point, int], ...] = ()

    @cached_property
    def _starts(self) -> list[Length]:
        """Position of each edge's start."""
        positions = [Length(0)]
        for edge in self.edges[:-1]:
            positions.append(positions[-1] + edge.length)
        return positions

    def edge_at(self, point: Point) -> int:
        """Index of the edge that contains the point; at a vertex the edge that starts there.

        The promise that the point lies on the boundary spares a proof: where balls leave one edge, it is
        that one. ValueError if they leave none. The last two points, the ends of a way, are remembered.
        """
        for known, k in self._found:
            if known is point:
                return k
        k = self._edge_at(point)
        self._found = (*self._found[-1:], (point, k))
        return k

    def _edge_at(self, point: Point) -> int:
        for k, edge in enumerate(self.edges):
            if edge.start is point:
                return k
        candidates = list(range(len(self.edges)))
        for bits in (64, 256):
            candidates = [k for k in candidates if self.edges[k].may_pass(point, bits)]
        if not candidates:
            raise ValueError(f"{point} is not on the boundary")
        if len(candidates) == 1:
            return candidates[0]
        through = [k for k in candidates if self.edges[k].passes(point)]
        if not through:
            raise ValueError(f"{point} is not on the boundary")
        return next((k for k in through if self.edges[k].start == point), through[0])

    def position(self, point: Point) -> Length:
        """Length of the walk from the first vertex to the point."""
        k = self.edge_at(point)
        edge = self.edges[k]
        if edge.start == point:
            return self._starts[k]
        return self._starts[k] + edge.part(edge.start, point).length

    def way(self, start: Point, end: Point) -> tuple[Length, bool]:
        """Length and sense of the shorter walk; True is the stored direction, which wins a tie."""
        forward = self.position(end) - self.position(start)
        if not self.closed:
            return (forward, True) if forward.sign() >= 0 else (-forward, False)
        if forward.sign() < 0:
            forward = forward + self.perimeter
        backward = self.perimeter - forward
        return (forward, True) if forward <= backward else (backward, False)

    def walk(self, start: Point, end: Point, forward: bool) -> list[Curve]:
        """The pieces from start to end, split at corners; equal points give no piece."""
        if start == end:
            return []
        if not forward:
            return [piece.reversed() for piece in reversed(self.walk(end, start, True))]
        return self._onward(start, end)

    def loop(self, start: Point) -> list[Curve]:
        """The pieces of a full turn in the stored direction, or of a walk to the last end and to the first.

        From one end it is the walk to the other.
        """
        if self.closed:
            return self._onward(start, start)
        first, last = self.edges[0].start, self.edges[-1].end
        back = [] if start == first else self.walk(last, first, False)
        return self.walk(start, last, True) + back

    def _onward(self, start: Point, end: Point) -> list[Curve]:
        first, last = self.edge_at(start), self.edge_at(end)
        if self.edges[last].start == end:
            last = (last - 1) % len(self.edges)
        if first == last and self._is_before(self.edges[first], start, end):
            return [_part(self.edges[first], start, end)]
        pieces = [_part(self.edges[first], start, self.edges[first].end)]
        k = (first + 1) % len(self.edges)
        while k != last:
            pieces.append(self.edges[k])
            k = (k + 1) % len(self.edges)
        if len(self.edges) > 1 or self.edges[last].start != start:
            pieces.append(_part(self.edges[last], self.edges[last].start, end))
        return pieces

    @staticmethod
    def _is_before(edge: Curve, start: Point, end: Point) -> bool:
        """Whether a walk along one edge meets *start* strictly before *end*."""
        if isinstance(edge, Arc) and edge.full and start == end:
            return True
        if start == end:
            return False
        if edge.start == start or edge.end == end:
            return True
        return edge.part(edge.start, start).length < edge.part(edge.start, end).length


def _part(edge: Curve, start: Point, end: Point) -> Curve:
    """The part of an edge, the edge itself where nothing is cut off."""
    if edge.start == start and edge.end == end:
        return edge
    return edge.part(start, end)
