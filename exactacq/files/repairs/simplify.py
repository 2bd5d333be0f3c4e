"""Rings on a lattice with fewer vertices, within a tolerance and of the same topology.

A run of edges is replaced by the segment of its ends if all its vertices are within the tolerance of that
segment; else it is parted at the farthest one (D. Douglas and T. Peucker, 1973). The run then lies within the
tolerance of the segment, which has a convex neighbourhood; and the segment within that of the run, for the
map to the nearest point of the segment is continuous and keeps its ends. So the Hausdorff distance of each
new edge and the run that it replaces is at most the tolerance.

A run is also parted if its segment would meet any edge that is there by then, in all rings, but for the ends
that it shares with its neighbours; so rings stay simple and disjoint, and none shrinks to a line. And it is
parted if run and segment together wind around another ring, or a fixed point; so what lies inside which ring
stays as it was (each change keeps the winding numbers of the ring around all others, and the place of one
vertex of each ring stays). Everything is decided in integers.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from flint import fmpq

from exactacq.errors import FormatError, shown

Node = tuple[int, int]
Place = tuple[int, int] | tuple[fmpq, fmpq]
Edge = tuple[Node, Node]
CELL = 32
"""Side of the squares that edges are looked up by, in lattice steps: eight cells of a grid."""


def simplify(
    rings: Sequence[Sequence[Node]], tolerance: fmpq, fixed: Sequence[tuple[fmpq, fmpq]] = ()
) -> list[list[Node]]:
    """The rings with fewer vertices, each within *tolerance* >= 0, in lattice steps, of what it was.

    The rings are simple and disjoint, and stay so; their vertices are some of the old ones. No ring passes
    over a *fixed* point that lies on none. Raises `FormatError` for a negative tolerance. Near linear in the
    vertices where rings do not run close to each other for long.

    >>> stairs = [(0, 0), (3, 0), (3, 1), (2, 1), (2, 2), (1, 2), (1, 3), (0, 3)]
    >>> simplify([stairs], fmpq(1))
    [[(0, 0), (3, 1), (0, 3)]]
    >>> simplify([stairs], fmpq(1, 4)) == [stairs]
    True
    """
    check_tolerance(tolerance)
    return _Rings(rings, tolerance * tolerance, fixed).simplified()


def check_tolerance(tolerance: fmpq) -> None:
    """`FormatError` for a negative one."""
    if tolerance < 0:
        raise FormatError(f"simplify: a length of at least 0 is needed, not {shown(tolerance)}")


class _Rings:
    """All rings, of which some runs are replaced already; *edges* are those that are there."""

    def __init__(
        self, rings: Sequence[Sequence[Node]], square: fmpq, fixed: Sequence[tuple[fmpq, fmpq]]
    ) -> None:
        self.rings, self.fixed = rings, fixed
        self.bits = int(square.p), int(square.q)
        self.edges: defaultdict[Node, set[Edge]] = defaultdict(set)
        self.anchors = [min(ring) for ring in rings]
        self.near: defaultdict[Node, list[Node]] = defaultdict(list)
        for anchor in self.anchors:
            self.near[anchor[0] // CELL, anchor[1] // CELL].append(anchor)
        for ring in rings:
            for edge in zip(ring, [*ring[1:], ring[0]], strict=True):
                self._put(edge)

    def simplified(self) -> list[list[Node]]:
        """Each ring, from its least vertex to the farthest one and back."""
        found = []
        for ring, anchor in zip(self.rings, self.anchors, strict=True):
            k = ring.index(anchor)
            turned = [*ring[k:], *ring[:k], anchor]
            far = max(range(len(ring)), key=lambda i: _squared(anchor, turned[i]))
            found.append([*self._kept(turned[: far + 1]), *self._kept(turned[far:])])
        return found

    def _kept(self, run: Sequence[Node]) -> list[Node]:
        """The vertices that stay of a run, without its last one."""
        kept: list[Node] = []
        todo = [(0, len(run) - 1)]
        while todo:
            low, high = todo.pop()
            if high - low == 1 or self._replace(run[low : high + 1]):
                kept.append(run[low])
                continue
            ends = run[low], run[high]
            middle = max(range(low + 1, high), key=lambda i: _parting(ends, run[i], abs(low + high - 2 * i)))
            todo += [(middle, high), (low, middle)]
        return kept

    def _replace(self, run: Sequence[Node]) -> bool:
        """Put the segment of its ends in the place of a run, if that is allowed."""
        start, end = run[0], run[-1]
        length = _squared(start, end)
        top, bottom = self.bits
        if not all(_apart(start, end, node) * bottom <= top * length for node in run[1:-1]):
            return False
        old = list(pairwise(run))
        gone = set(old)
        segment = (start, end)
        for key in _squares(segment):
            if any(edge not in gone and _meet(segment, edge) for edge in self.edges[key]):
                return False
        if self._winds(run):
            return False
        for edge in old:
            for key in _squares(edge):
                self.edges[key].discard(edge)
        self._put(segment)
        return True

    def _winds(self, run: Sequence[Node]) -> bool:
        """Whether a run and the way back along its segment wind around another ring, or a fixed point."""
        xs, ys = [x for x, _ in run], [y for _, y in run]
        low, high = (min(xs), min(ys)), (max(xs), max(ys))
        for column in range(low[0] // CELL, high[0] // CELL + 1):
            for row in range(low[1] // CELL, high[1] // CELL + 1):
                for anchor in self.near.get((column, row), ()):
                    if anchor not in run and _turns(run, anchor):
                        return True
        for x, y in self.fixed:
            if low[0] <= x <= high[0] and low[1] <= y <= high[1]:
                closed = [*run, run[0]]
                on_it = any(_side(a, b, (x, y)) == 0 for a, b in pairwise(closed))
                if on_it or _turns(run, (x, y)):
                    return True
        return False

    def _put(self, edge: Edge) -> None:
        for key in _squares(edge):
            self.edges[key].add(edge)


def _squared(a: Node, b: Node) -> int:
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


def _side(a: Node, b: Node, point: Place) -> Any:
    """Positive if a point lies to the left of a -> b, 0 on the line."""
    return (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])


def _apart(a: Node, b: Node, node: Node) -> int:
    """The squared distance of a node from the segment from a to b, times the squared length of that."""
    length = _squared(a, b)
    along = (b[0] - a[0]) * (node[0] - a[0]) + (b[1] - a[1]) * (node[1] - a[1])
    if along <= 0 or along >= length:
        return min(_squared(a, node), _squared(b, node)) * length
    return int(_side(a, b, node)) ** 2


def _parting(ends: Edge, node: Node, off_middle: int) -> tuple[int, int]:
    """What is largest where a run is parted: the distance of a vertex, then how near it is to the middle."""
    return _apart(*ends, node), -off_middle


def _meet(one: Edge, other: Edge) -> bool:
    """Whether two segments have a point in common that is not an end of both."""
    shared = [node for node in one if node in other]
    if len(shared) == 2:
        return True
    if shared:
        (a,), (b,) = ([node for node in edge if node != shared[0]] for edge in (one, other))
        (x, y) = shared[0]
        ahead = (a[0] - x) * (b[0] - x) + (a[1] - y) * (b[1] - y)
        return bool(_side(shared[0], a, b) == 0 and ahead > 0)
    (a, b), (c, d) = one, other
    sides = _side(a, b, c), _side(a, b, d), _side(c, d, a), _side(c, d, b)
    if sides[0] == sides[1] == 0:
        boxes = ((sorted(p[k] for p in one), sorted(q[k] for q in other)) for k in (0, 1))
        return all(max(p[0], q[0]) <= min(p[1], q[1]) for p, q in boxes)
    return bool(sides[0] * sides[1] <= 0 and sides[2] * sides[3] <= 0)


def _turns(run: Sequence[Node], point: Place) -> int:
    """How often a run, closed by its segment, winds around a point that lies on neither."""
    turns = 0
    for a, b in zip(run, [*run[1:], run[0]], strict=True):
        if (a[1] <= point[1]) != (b[1] <= point[1]):
            side = _side(a, b, point)
            turns += (side > 0) if b[1] > a[1] else -(side < 0)
    return turns


def _squares(edge: Edge) -> Iterator[Node]:
    """The squares that an edge meets, and maybe some next to them."""
    (x0, y0), (x1, y1) = sorted(edge)
    rise, width = y1 - y0, x1 - x0
    for column in range(x0 // CELL, x1 // CELL + 1):
        left, right = max(x0, column * CELL), min(x1, column * CELL + CELL)
        if width:
            heights = y0 + rise * (left - x0) // width, y0 + rise * (right - x0) // width
            low, high = min(heights), max(heights) + 1
        else:
            low, high = min(y0, y1), max(y0, y1)
        for row in range(low // CELL, high // CELL + 1):
            yield column, row
