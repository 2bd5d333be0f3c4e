"""Independent of the library: shortest paths among walls without thickness, by Dijkstra on all sights.

Walls are polylines with integer vertices, solid polygons closed ones, counterclockwise. Every vertex stands
for two nodes, one on each side, with the directions that it can be left in; the end of a wall is one node
with all directions. A segment between two nodes is taken if it meets no wall on its way (it may run along one
edge from side to side), and begins and ends in such directions. Signs are of integers; lengths are floats.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from heapq import heappop, heappush
from itertools import pairwise
from random import Random
from typing import NamedTuple

Pair = tuple[int, int]
BOTH, RIGHT, LEFT = 0, -1, 1


class Node(NamedTuple):
    """A point on one side of a wall, and its directions: from ``first`` counterclockwise to ``last``."""

    point: Pair
    side: int = BOTH
    first: Pair | None = None
    last: Pair | None = None


def wall_paths(
    walls: Sequence[Sequence[Pair]], solids: Sequence[Sequence[Pair]], a: Pair, b: Pair
) -> tuple[float, set[tuple[Pair, ...]]]:
    """The length of a shortest path, and all that are as short, by their corners; walls have places right."""
    edges = [edge for wall in walls for edge in pairwise(wall)]
    loops = [[*solid, solid[0]] for solid in solids]
    edges += [edge for loop in loops for edge in pairwise(loop)]
    nodes = [place(walls, loops, a), place(walls, loops, b)]
    for wall in walls:
        nodes += [Node(wall[0]), Node(wall[-1])]
        for p, q, r in zip(wall, wall[1:], wall[2:], strict=False):
            nodes += [_node(p, q, r, RIGHT), _node(p, q, r, LEFT)]
    for loop in loops:
        nodes += [_node(p, q, r, RIGHT) for p, q, r in zip([loop[-2], *loop], loop, loop[1:], strict=False)]
    beside: dict[int, list[tuple[int, float]]] = {}
    for i, one in enumerate(nodes):
        for j, other in enumerate(nodes[:i]):
            if one.point == other.point:
                if BOTH in (one.side, other.side) or one.side == other.side:
                    beside.setdefault(i, []).append((j, 0.0))
                    beside.setdefault(j, []).append((i, 0.0))
            elif _sees(one, other, edges):
                far = math.dist(one.point, other.point)
                beside.setdefault(i, []).append((j, far))
                beside.setdefault(j, []).append((i, far))
    far = _dijkstra(beside)
    paths: set[tuple[Pair, ...]] = set()
    rows = [(0, (nodes[0].point,), 0.0)]
    while rows:
        i, row, length = rows.pop()
        if i == 1:
            paths.add(_corners(row))
        for j, more in beside.get(i, ()):
            if math.isclose(length + more + far.get(j, math.inf), far[0], abs_tol=1e-9) and (
                more or (nodes[j].side == BOTH) > (nodes[i].side == BOTH) or j == 1
            ):
                rows.append((j, (*row, nodes[j].point), length + more))
    return far.get(0, math.inf), paths


def _corners(row: Sequence[Pair]) -> tuple[Pair, ...]:
    """A row of points without those that lie between others, or come twice."""
    kept: list[Pair] = []
    for point in row:
        if kept and kept[-1] == point:
            continue
        if len(kept) > 1:
            one, other = _to(kept[-2], kept[-1]), _to(kept[-1], point)
            if _cross(one, other) == 0 and _dot(one, other) > 0:
                kept.pop()
        kept.append(point)
    return tuple(kept)


def place(walls: Sequence[Sequence[Pair]], loops: Sequence[Sequence[Pair]], p: Pair) -> Node:
    """The node of a place."""
    for row in (*walls, *loops):
        closed = row[0] == row[-1]
        if p in (row[0], row[-1]) and not closed:
            return Node(p)
        for k, (q, r) in enumerate(pairwise(row)):
            if p == q:
                return _node(row[k - 1] if k else row[-2], q, r, RIGHT)
            if p != r and _cross(_to(q, r), _to(q, p)) == 0 and _dot(_to(p, q), _to(p, r)) < 0:
                return _node(q, p, r, RIGHT)
    return Node(p)


def free_walls(rng: Random, count: int, size: int, *, most: int = 4) -> list[list[Pair]]:
    """Polylines on a grid that have no point in common."""
    walls: list[list[Pair]] = []
    for _ in range(200):
        if len(walls) == count:
            break
        wall = [(rng.randint(0, size), rng.randint(0, size)) for _ in range(rng.randint(2, most))]
        edges = list(pairwise(wall))
        turns = [(_to(p, q), _to(q, r)) for p, q, r in zip(wall, wall[1:], wall[2:], strict=False)]
        if any(p == q for p, q in edges) or any(_cross(*t) == 0 and _dot(*t) < 0 for t in turns):
            continue
        apart = [(edges[i], edges[j]) for i in range(len(edges)) for j in range(i - 1)]
        apart += [(edge, other) for edge in edges for known in walls for other in pairwise(known)]
        if not any(_meet(*pair) for pair in apart):
            walls.append(wall)
    return walls


def _node(p: Pair, q: Pair, r: Pair, side: int) -> Node:
    back, on = _to(q, p), _to(q, r)
    return Node(q, side, *((back, on) if side == RIGHT else (on, back)))


def _sees(one: Node, other: Node, edges: Sequence[tuple[Pair, Pair]]) -> bool:
    p, q = one.point, other.point
    along = _to(p, q)
    for a, b in edges:
        s, t = _cross(along, _to(p, a)), _cross(along, _to(p, b))
        if s == t == 0:
            inner = [_dot(_to(p, c), _to(c, q)) > 0 for c in (a, b)]
            if any(inner):
                return False
            if _dot(_to(p, a), _to(p, b)) <= 0 and _dot(_to(q, a), _to(q, b)) <= 0:
                return BOTH in (one.side, other.side) or one.side == other.side
        elif s * t <= 0:
            u, v = _cross(_to(a, b), _to(a, p)), _cross(_to(a, b), _to(a, q))
            if u * v < 0:
                return False
    return _leaves(one, along) and _leaves(other, (-along[0], -along[1]))


def _leaves(node: Node, along: Pair) -> bool:
    """Whether a direction is in the node's sector, the ends of which count."""
    if node.first is None or node.last is None:
        return True
    turn, after, before = _cross(node.first, node.last), _cross(node.first, along), _cross(along, node.last)
    if turn > 0:
        return after >= 0 and before >= 0
    if turn < 0:
        return after >= 0 or before >= 0
    return after >= 0 if _dot(node.first, node.last) < 0 else after == 0 and _dot(node.first, along) > 0


def _dijkstra(beside: dict[int, list[tuple[int, float]]]) -> dict[int, float]:
    """How far the nodes are from the second one."""
    heap, far = [(0.0, 1)], dict[int, float]()
    while heap:
        length, i = heappop(heap)
        if i not in far:
            far[i] = length
            for j, more in beside.get(i, ()):
                heappush(heap, (length + more, j))
    return far


def _meet(one: tuple[Pair, Pair], other: tuple[Pair, Pair]) -> bool:
    (a, b), (c, d) = one, other
    s, t = (_cross(_to(a, b), _to(a, p)) for p in (c, d))
    u, v = (_cross(_to(c, d), _to(c, p)) for p in (a, b))
    if s == t == 0:
        ends = [(a, c, d), (b, c, d), (c, a, b), (d, a, b)]
        return any(_dot(_to(p, q), _to(p, r)) <= 0 for p, q, r in ends)
    return s * t <= 0 and u * v <= 0


def _to(a: Pair, b: Pair) -> Pair:
    return b[0] - a[0], b[1] - a[1]


def _cross(a: Pair, b: Pair) -> int:
    return a[0] * b[1] - a[1] * b[0]


def _dot(a: Pair, b: Pair) -> int:
    return a[0] * b[0] + a[1] * b[1]
