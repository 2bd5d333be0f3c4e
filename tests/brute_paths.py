"""Independent of the library: the length of a shortest path by Dijkstra on all tangents, in floats.

Every segment between two vertices, and every common tangent of two circles, is tried against all edges
(`oracles.World.depth`); no condition of tautness and no order is used. Good to about 10^-6 of the scene.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from heapq import heappop, heappush
from itertools import pairwise

import numpy as np
from oracles import GRAZE, TAU, world

SLACK = 1e-7
"""How far a contact may lie beyond the ends of an arc."""


def shortest_length(shapes: Sequence[object], a: Sequence, b: Sequence, tol: float = GRAZE) -> float:
    """The length of a shortest path from a to b; infinite if there is none."""
    return _dijkstra(*_graph(shapes, a, b, tol))


def _graph(shapes: Sequence[object], a: Sequence, b: Sequence, tol: float) -> tuple[list, list]:
    """Points, a and b first, and edges (from, to, length)."""
    w = world(shapes)
    spots: dict[tuple[float, float], int] = {}
    points: list[tuple[float, float]] = []

    def node(point: Sequence[float]) -> int:
        key = round(float(point[0]), 12), round(float(point[1]), 12)
        if key not in spots:
            spots[key] = len(points)
            points.append((float(point[0]), float(point[1])))
        return spots[key]

    circles = [(tuple(map(float, p)), 0.0, [node(p)], 0.0, 0.0) for p in (a, b)]
    assert (node(a), node(b)) == (0, 1), "a and b differ"
    for e in range(len(w.r)):
        node(w.a[e]), node(w.b[e])
    circles += [(p, 0.0, [k], 0.0, 0.0) for k, p in enumerate(points) if k > 1]
    on_row: dict[int, list[tuple[float, int]]] = {}
    for e in np.flatnonzero((w.r > 0) & (w.sweep > 0)).tolist():
        circles.append((tuple(w.c[e]), float(w.r[e]), [-1 - e], float(w.a0[e]), float(w.sweep[e])))
        on_row[e] = [(0.0, node(w.a[e])), (float(w.sweep[e]), node(w.b[e]))]
        for point in (a, b):
            x, y = float(point[0]) - w.c[e][0], float(point[1]) - w.c[e][1]
            turn = (math.atan2(y, x) - w.a0[e]) % TAU
            if abs(math.hypot(x, y) - w.r[e]) < 1e-9 and turn < w.sweep[e]:
                on_row[e].append((turn, node(point)))
    segments = [s for i, one in enumerate(circles) for other in circles[:i] for s in _tangents(one, other)]
    edges = []
    if segments:
        first, second = np.array([s[0][0] for s in segments]), np.array([s[1][0] for s in segments])
        free = np.concatenate(
            [w.depth(first[k : k + 200], second[k : k + 200]) <= tol for k in range(0, len(first), 200)]
        )
        for (one, other), is_free in zip(segments, free, strict=True):
            if is_free:
                numbers = [_number(contact, points, on_row) for contact in (one, other)]
                edges.append((*numbers, math.dist(one[0], other[0])))
    for e, found in on_row.items():
        found.sort()
        edges += [(i, j, (v - u) * w.r[e]) for (u, i), (v, j) in pairwise(found)]
    return points, edges


def _number(contact: tuple, points: list, on_row: dict) -> int:
    point, (k,), turn = contact
    if k >= 0:
        return k
    points.append(point)
    on_row[-1 - k].append((turn, len(points) - 1))
    return len(points) - 1


def _tangents(one: tuple, other: tuple) -> list[tuple]:
    """Common tangents of two circles, of radius 0 for points, as pairs of contacts on both arcs."""
    (p, r, i, *arc), (q, s, j, *back) = one, other
    across, far = complex(q[0] - p[0], q[1] - p[1]), math.dist(p, q)
    found = []
    for side in (1, -1) if r else (1,):
        for turn in (1, -1) if s else (1,):
            k = turn * s - side * r
            if far <= abs(k) or far < 1e-9:
                continue
            u = across * complex(math.sqrt(far * far - k * k), -k) / far**2
            contacts = []
            for c, rho, name, (start, sweep) in ((p, side * r, i, arc), (q, turn * s, j, back)):
                at = complex(*c) - 1j * u * rho
                angle = (math.atan2(at.imag - c[1], at.real - c[0]) - start) % TAU if rho else 0.0
                if angle > TAU - SLACK:
                    angle = 0.0
                if rho and angle > sweep + SLACK:
                    break
                contacts.append(((at.real, at.imag), name, min(angle, sweep)))
            if len(contacts) == 2:
                found.append(tuple(contacts))
    return found


def _dijkstra(points: list, edges: list) -> float:
    beside: dict[int, list[tuple[int, float]]] = {}
    for i, j, length in edges:
        beside.setdefault(i, []).append((j, length))
        beside.setdefault(j, []).append((i, length))
    heap, done = [(0.0, 0)], set[int]()
    while heap:
        length, i = heappop(heap)
        if i == 1:
            return length
        if i in done:
            continue
        done.add(i)
        for j, more in beside.get(i, ()):
            heappush(heap, (length + more, j))
    return math.inf
