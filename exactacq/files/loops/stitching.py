"""Loose pieces become closed loops: ends within the tolerance are joined, what stays open is left out.

Ends are clustered exactly (a grid of cells as wide as the tolerance proposes, squared distances decide). A
cluster of two ends is a joint; three or more ends make a branch point, where no loop is traced through: a
path that leaves a branch point and comes back to it is a loop, any other path that ends at one is open.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import product

from flint import fmpq
from networkx.utils import UnionFind

from exactacq.files.loops.chains import Chain, Corner, distance_above

Row = tuple[fmpq, fmpq, fmpq]
"""x, y and the bulge of the edge that follows."""


@dataclass(slots=True)
class Stitched:
    """The closed loops in the order of their first piece, and what was done and left out on the way."""

    loops: list[Chain] = field(default_factory=list)
    joined: int = 0
    """Ends that were moved onto another one."""
    largest: fmpq = field(default_factory=lambda: fmpq(0))
    """Upper bound of the largest such move."""
    short_edges: int = 0
    """Edges not longer than the tolerance, taken out."""
    duplicates: int = 0
    """Pieces or loops equal to an earlier one, taken out."""
    flat: int = 0
    """Loops that enclose nothing, taken out: see `_is_flat`."""
    open_chains: list[list[Chain]] = field(default_factory=list)
    """Paths that do not close, as their pieces."""
    branches: list[tuple[fmpq, fmpq]] = field(default_factory=list)
    """Points where three or more ends meet."""
    inside: set[str] = field(default_factory=set)
    """The names of the pieces that loops are made of."""

    def joint(self, corner: Corner, target: Corner) -> None:
        """Move a corner onto another one, and keep count."""
        moved = corner.move_to(target)
        if moved:
            self.joined += 1
            self.largest = max(self.largest, moved)


def stitch(chains: Iterable[Chain], tolerance: fmpq) -> Stitched:
    """Join *chains* (which are altered) into loops; near linear in the edges if they exceed the tolerance."""
    done = Stitched()
    pieces: list[Chain] = []
    loops: dict[int, Chain] = {}
    members: dict[int, list[str]] = {}
    for chain in chains:
        _drop_short_edges(chain, tolerance, done)
        if chain.edges > 0:
            pieces.append(chain)
    nodes = _join_ends([p for p in pieces if not p.closed], tolerance, done)
    pieces = _without_duplicates([p for p in pieces if not _collapsed(p, done)], done)
    at_node: defaultdict[int, list[tuple[int, int]]] = defaultdict(list)
    for i, piece in enumerate(pieces):
        if piece.closed:
            loops[i], members[i] = piece, [piece.label]
        else:
            for side in (0, 1):
                at_node[nodes[id(piece), side]].append((i, side))
    done.branches = [_place(pieces, ends[0]) for ends in at_node.values() if len(ends) > 2]
    used: set[int] = set()
    for i, piece in enumerate(pieces):
        if piece.closed or i in used:
            continue
        path, closed = _trace(pieces, nodes, at_node, i)
        used.update(j for j, _ in path)
        if closed:
            loops[i], members[i] = _merge(pieces, path), [pieces[j].label for j, _ in path]
        else:
            done.open_chains.append([pieces[j] for j, _ in path])
    found = [loops[i] for i in sorted(loops)]
    for loop in found:
        _drop_short_edges(loop, fmpq(0), done)
    solid = [loop for loop in found if not _is_flat(loop)]
    done.flat = len(found) - len(solid)
    done.loops = _without_duplicates(solid, done)
    kept = set(map(id, done.loops))
    done.inside = {label for i, loop in loops.items() if id(loop) in kept for label in members[i]}
    return done


def _is_flat(loop: Chain) -> bool:
    """Whether a loop encloses nothing, for it has fewer than three edges, all straight, or only goes back.

    It goes back if nothing is left when edges that are walked there and at once back again are taken out.
    """
    corners = loop.corners
    if len(corners) < 3 - any(corner.bulge for corner in corners):
        return True
    left: list[tuple[Corner, Corner]] = []
    for start, end in zip(corners, [*corners[1:], corners[0]], strict=True):
        if left and _goes_back(left[-1], start, end):
            left.pop()
        else:
            left.append((start, end))
    return not left


def _goes_back(before: tuple[Corner, Corner], start: Corner, end: Corner) -> bool:
    """Whether an edge runs along the one before it, the other way."""
    first, _ = before
    is_same_curve = first.bulge == -start.bulge and first.center == start.center
    return is_same_curve and first.x == end.x and first.y == end.y


def _drop_short_edges(chain: Chain, tolerance: fmpq, done: Stitched) -> None:
    """Merge neighbouring corners within the tolerance; a chain whose ends meet becomes closed.

    An edge of more than a semicircle is no short edge, unless its ends are equal: then it has no shape.
    """
    kept = chain.corners[:1]
    for corner in chain.corners[1:]:
        if _is_short(kept[-1], corner, tolerance):
            _merge_corners(kept[-1], corner, done)
        else:
            kept.append(corner)
    if len(kept) > 2 and not chain.closed and distance_above(kept[-1], kept[0]) <= tolerance:
        done.joint(kept[-1], kept[0])
        kept[0].shift = max(kept[0].shift, kept.pop().shift)
        chain.closed = True
    elif chain.closed and len(kept) > 1 and _is_short(kept[-1], kept[0], tolerance):
        done.short_edges += 1
        done.joint(kept[-1], kept[0])
        kept[0].shift = max(kept[0].shift, kept.pop().shift)
    chain.corners = kept


def _is_short(start: Corner, end: Corner, tolerance: fmpq) -> bool:
    equal = start.x == end.x and start.y == end.y
    return bool(equal or (abs(start.bulge) <= 1 and distance_above(start, end) <= tolerance))


def _merge_corners(kept: Corner, corner: Corner, done: Stitched) -> None:
    """Take out the edge between two corners: the first one's place, the second one's edge."""
    done.short_edges += 1
    done.joint(corner, kept)
    kept.bulge, kept.bulge_shift, kept.center = corner.bulge, corner.bulge_shift, corner.center
    kept.shift = max(kept.shift, corner.shift)


def _join_ends(pieces: list[Chain], tolerance: fmpq, done: Stitched) -> dict[tuple[int, int], int]:
    """Cluster the ends and move each onto its cluster's first stated end; the cluster of (id, side)."""
    ends = [(piece, side, piece.corners[-side]) for piece in pieces for side in (0, 1)]
    near = _near([corner for _, _, corner in ends], tolerance)
    clusters: defaultdict[int, list[int]] = defaultdict(list)
    for i in range(len(ends)):
        clusters[near[i]].append(i)
    for members in clusters.values():
        target = ends[min(members, key=lambda i: (not ends[i][0].stated, i))][2]
        for i in members:
            done.joint(ends[i][2], target)
    return {(id(piece), side): near[i] for i, (piece, side, _) in enumerate(ends)}


def _collapsed(piece: Chain, done: Stitched) -> bool:
    """Whether a piece of one edge lost its length when its ends were joined."""
    first, last = piece.corners[0], piece.corners[-1]
    gone = piece.edges == 1 and not piece.closed and first.x == last.x and first.y == last.y
    done.short_edges += gone
    return gone


def _near(corners: list[Corner], tolerance: fmpq) -> UnionFind:
    """The indices of corners in clusters: each is at most the tolerance from another one of its cluster.

    Corners lie in cells as wide as the tolerance, and there in quarters. Those of one quarter are near each
    other, so a quarter in a cluster is not looked into again: however many corners it has, that is linear.
    """
    near = UnionFind(range(len(corners)))
    first: dict[tuple[fmpq, fmpq], int] = {}
    cells: defaultdict[tuple[int, int], defaultdict[tuple[int, int], list[int]]]
    cells = defaultdict(lambda: defaultdict(list))
    for i, corner in enumerate(corners):
        j = first.setdefault((corner.x, corner.y), i)
        if j != i:
            near.union(j, i)
            continue
        if not tolerance:
            continue
        quarter = int((2 * corner.x / tolerance).floor()), int((2 * corner.y / tolerance).floor())
        column, row = quarter[0] // 2, quarter[1] // 2
        for dx, dy in product((-1, 0, 1), repeat=2):
            for members in cells.get((column + dx, row + dy), {}).values():
                if near[members[0]] != near[i] and any(
                    _is_within(corners[k], corner, tolerance) for k in members
                ):
                    near.union(members[0], i)
        cells[column, row][quarter].append(i)
    return near


def _is_within(a: Corner, b: Corner, tolerance: fmpq) -> bool:
    return bool((a.x - b.x) ** 2 + (a.y - b.y) ** 2 <= tolerance**2)


def _trace(
    pieces: list[Chain],
    nodes: dict[tuple[int, int], int],
    at_node: dict[int, list[tuple[int, int]]],
    first: int,
) -> tuple[list[tuple[int, int]], bool]:
    """The path through a piece as (piece, side it is entered at), and whether it closes."""
    path = [(first, 0)]
    for _ in range(2):
        while True:
            last, entered = path[-1]
            node = nodes[id(pieces[last]), 1 - entered]
            if node == nodes[id(pieces[path[0][0]]), path[0][1]]:
                return path, True
            if len(at_node[node]) != 2:
                break
            here, there = at_node[node]
            path.append(there if here == (last, 1 - entered) else here)
        path = [(i, 1 - side) for i, side in reversed(path)]
    return path, False


def _merge(pieces: list[Chain], path: list[tuple[int, int]]) -> Chain:
    """One closed chain from a path of open ones; a joint keeps the larger of the two shifts."""
    corners: list[Corner] = []
    last: fmpq = fmpq(0)
    for i, side in path:
        walked = pieces[i].backwards() if side else pieces[i].corners
        walked[0].shift = max(walked[0].shift, last)
        last = walked[-1].shift
        corners += walked[:-1]
    corners[0].shift = max(corners[0].shift, last)
    first = pieces[min(path)[0]]
    label = first.label if len(path) == 1 else f"loop from {first.label}"
    return Chain(label, corners, first.order, closed=True)


def _without_duplicates(chains: list[Chain], done: Stitched) -> list[Chain]:
    """The chains without those that equal an earlier one, in either direction and from any corner."""
    seen: set[tuple[object, ...]] = set()
    kept = []
    for chain in chains:
        key = _key(chain)
        if key in seen:
            done.duplicates += 1
        else:
            seen.add(key)
            kept.append(chain)
    return kept


def _key(chain: Chain) -> tuple[object, ...]:
    rows = [(c.x, c.y, c.bulge) for c in chain.corners]
    if not chain.closed:
        rows[-1] = (*rows[-1][:2], fmpq(0))
        turned = [(c.x, c.y, c.bulge) for c in chain.backwards()]
        return tuple(min(rows, turned))
    n = len(rows)
    backwards = [(*rows[-i % n][:2], -rows[-(i + 1) % n][2]) for i in range(n)]
    return ("closed", *min(map(_least_turned, (rows, backwards))))


def _least_turned(rows: list[Row]) -> list[Row]:
    """The least list among the rotations of one, in linear time: a path may be in one corner many times.

    Two candidates i < j are compared row by row; whichever loses, none of the rotations passed is the least.
    Source: Y. Shiloach, Fast canonization of circular strings, J. Algorithms 2 (1981).

    >>> _least_turned([3, 1, 2, 1, 1])
    [1, 1, 3, 1, 2]
    """
    n, i, j, same = len(rows), 0, 1, 0
    while max(i, j) < n and same < n:
        one, other = rows[(i + same) % n], rows[(j + same) % n]
        if one == other:
            same += 1
            continue
        if one > other:
            i += same + 1
        else:
            j += same + 1
        j += i == j
        same = 0
    first = min(i, j)
    return rows[first:] + rows[:first]


def _place(pieces: list[Chain], end: tuple[int, int]) -> tuple[fmpq, fmpq]:
    corner = pieces[end[0]].corners[-end[1]]
    return corner.x, corner.y
