"""Independent of the library: links by sampling, where floats cannot tell, and the Sightseer's tour."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from oracles import (
    GRAZE,
    Chord,
    World,
    _first_free,
    _Node,
    shortest_visible,
    world,
)


def boundary_samples(w: World, i: int, count: int) -> NDArray[np.float64]:
    """Arc lengths of `count` evenly spaced points and of all vertices of a boundary."""
    lengths = w.length[w.ids[i]]
    even = np.linspace(0, lengths.sum(), count, endpoint=False)
    return np.concatenate([even, np.concatenate([[0.0], np.cumsum(lengths)[:-1]])])


def free_sample_shorter(
    shapes: Sequence[object], i: int, j: int, length: float, count: int = 60
) -> Chord | None:
    """The shortest free segment shorter than `length` between sampled points of two boundaries, if any."""
    w = world(shapes)
    p, q = (np.array([w.at(k, s) for s in boundary_samples(w, k, count)]) for k in (i, j))
    pairs = [(np.repeat(p, len(q), axis=0), np.tile(q, (len(p), 1)))]
    return _first_free(_Node(w, i), _Node(w, j), pairs, length, GRAZE)


def shortest_by_sampling(
    shapes: Sequence[object], i: int, j: int, radius: float, count: int = 120
) -> Chord | None:
    """An upper bound for the shortest visible segment, close to it when the sampling is fine."""
    w = world(shapes)
    best = free_sample_shorter(shapes, i, j, radius, count)
    if best is None:
        return None
    rng = np.random.default_rng(0)
    nodes = _Node(w, i), _Node(w, j)
    here = np.array([w.position(i, best.start), w.position(j, best.end)])
    step = max(w.perimeter(i), w.perimeter(j)) / count
    while step > 1e-10:
        moves = step * rng.uniform(-1, 1, (24, 2))
        p, q = (np.array([w.at(k, s) for s in here[n] + moves[:, n]]) for n, k in enumerate((i, j)))
        better = _first_free(*nodes, [(p, q)], best.length * (1 - 1e-15), GRAZE)
        if better is None:
            step /= 2
        else:
            best = better
            here = np.array([w.position(i, best.start), w.position(j, best.end)])
    return best


# Graph and tour.


def ambiguous(shapes: Sequence[object], i: int | Sequence[float], j: int, radius: float) -> bool:
    """Whether floats cannot be trusted: the answer hangs on R or on a graze within 1e-7."""
    answers = [
        shortest_visible(shapes, i, j, radius + shift, tol)
        for shift, tol in ((-1e-7, 1e-11), (1e-7, 1e-11), (1e-7, 1e-7))
    ]
    if any(a is None for a in answers):
        return any(a is not None for a in answers)
    lengths = [a.length for a in answers]
    return max(lengths) - min(lengths) > 1e-9


Weights = dict[tuple[object, int], Chord]


def visibility_weights(
    shapes: Sequence[object], radius: float, start: Sequence[float] | None = None
) -> Weights:
    """The obstacle visibility graph: keys (i, j) with i < j, and ("S", j)."""
    n = len(shapes)
    keys = [(i, j) for i in range(n) for j in range(i + 1, n)]
    found: Weights = {key: chord for key in keys if (chord := shortest_visible(shapes, *key, radius))}
    if start is not None:
        found |= {("S", j): c for j in range(n) if (c := shortest_visible(shapes, start, j, radius))}
    return found


class Edge(NamedTuple):
    """A tree edge with the number of times it was walked."""

    source: object
    target: int
    chord: Chord
    traversals: int


class Tour(NamedTuple):
    """What a Sightseer does; `length` counts to the end of the last loop."""

    visits: tuple[int, ...]
    edges: tuple[Edge, ...]
    length: float


def sightseer_order(shapes: Sequence[object], weights: Weights) -> Tour:
    """The Sightseer Strategy on given weights, for scenes without ties and a start that has edges."""
    w = world(shapes)
    near: dict[object, dict[int, Chord]] = {}
    for (i, j), chord in weights.items():
        near.setdefault(i, {})[j] = chord
        if i != "S":
            near.setdefault(j, {})[i] = chord.reversed()
    reachable, todo = set(), list(near.get("S", {}))
    while todo:
        j = todo.pop()
        if j not in reachable:
            reachable.add(j)
            todo += near[j]

    def walk(i: object, a: tuple[float, float], b: tuple[float, float]) -> float:
        if i == "S":
            return 0.0
        ahead = (w.position(i, b) - w.position(i, a)) % w.perimeter(i)
        return min(ahead, w.perimeter(i) - ahead)

    curr, here, total = "S", (0.0, 0.0), 0.0
    visits: list[int] = []
    stack: list[tuple[object, Chord, int]] = []
    edges: list[list] = []
    while reachable - set(visits):
        open_ = [j for j in near[curr] if j not in visits]
        if open_:
            target = min(open_, key=lambda j: near[curr][j].length)
            chord = near[curr][target]
            total += walk(curr, here, chord.start) + chord.length + w.perimeter(target)
            edges.append([curr, target, chord, 1])
            stack.append((curr, chord, len(edges) - 1))
            curr, here = target, chord.end
            visits.append(target)
        else:
            previous, chord, k = stack.pop()
            total += walk(curr, here, chord.end) + chord.length
            edges[k][3] += 1
            curr, here = previous, chord.start
    return Tour(tuple(visits), tuple(Edge(*edge) for edge in edges), total)
