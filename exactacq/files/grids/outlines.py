"""The exact outlines of the blocked cells of a grid, as polygons on an integer lattice.

Where two blocked cells touch in a corner only, with free cells at both other sides, the outline would touch
itself, which no scene allows. The rule there is stated by *corners*: "join" makes the blocked cells one and
cuts the corners off the free cells, "part" keeps them apart and cuts their own corners off. What is cut off
is a triangle whose legs are a quarter of a cell.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from exactacq.errors import FormatError
from exactacq.files.source import MAX_EDGES

MAX_CELLS = 1 << 24
"""Most cells of a grid (4096 x 4096): a byte each, and some hundred bytes for each corner of the outlines."""
STEPS = 4
"""Lattice steps in a cell: what is cut off a touching corner has legs of one step."""
JOIN, PART = "join", "part"

Node = tuple[int, int]
"""Column and row of a lattice corner, in cells."""
Cells = NDArray[np.bool_]


def check_cells(width: int, height: int) -> None:
    """`FormatError` for a grid without cells or with more than `MAX_CELLS`."""
    if width < 1 or height < 1:
        raise FormatError(f"a grid of {width} x {height} cells; give one with cells")
    if width * height > MAX_CELLS:
        raise FormatError(
            f"{width} x {height} cells are more than the {MAX_CELLS} that are read; give a part"
        )


def outlines(blocked: Cells, corners: str = JOIN) -> list[list[tuple[int, int]]]:
    """The rings between blocked and free cells, each as its corners (x, y) in steps of a quarter cell.

    Rows of *blocked* go up: cell (column, row) is the square from (4 column, 4 row) to (4 column + 4, 4 row +
    4). Outside the grid all is free. No ring meets another or itself. Linear in the cells, in numpy, and near
    linear in the corners; `FormatError` for more of these than a scene may have.
    """
    padded = np.pad(blocked, 1)
    code = padded[:-1, :-1] + 2 * padded[:-1, 1:] + 4 * padded[1:, :-1] + 8 * padded[1:, 1:].astype(np.uint8)
    lone = np.isin(code, (1, 2, 4, 8, 7, 11, 13, 14))
    pinched = (code == 6) | (code == 9)
    count = int(lone.sum()) + 4 * int(pinched.sum())
    if count > MAX_EDGES:
        raise FormatError(
            f"outlines of {count} corners are more than the {MAX_EDGES} that are taken; give a part, "
            "or one with fewer cells"
        )
    nodes = [(int(x), int(y)) for y, x in np.argwhere(lone | pinched)]
    crossing = {(int(x), int(y)): int(code[y, x]) for y, x in np.argwhere(pinched)}
    return list(_rings(_ways(nodes, crossing), crossing, corners))


def _ways(nodes: list[Node], crossing: dict[Node, int]) -> dict[tuple[Node, str], Node]:
    """The corner at the other end of the boundary that leaves a corner to the W, E, S or N.

    Along each row of the lattice the boundary begins at a corner and ends at the next one; where cells touch
    it ends and begins again.
    """
    ways: dict[tuple[Node, str], Node] = {}
    for axis, back, ahead in ((1, "W", "E"), (0, "S", "N")):
        line = sorted((n for node in nodes for n in [node] * (1 + (node in crossing))), key=lambda n: n[::-1])
        if axis == 0:
            line.sort()
        for k in range(0, len(line), 2):
            here, there = line[k], line[k + 1]
            ways[here, ahead], ways[there, back] = there, here
    return ways


_OPPOSITE = {"W": "E", "E": "W", "S": "N", "N": "S"}


def _rings(
    ways: dict[tuple[Node, str], Node], crossing: dict[Node, int], corners: str
) -> Iterator[list[tuple[int, int]]]:
    """The rings, each begun where it was met first; a touching corner becomes the two ends of its cut."""
    left = dict(ways)
    for first in ways:
        if first not in left:
            continue
        ring: list[tuple[int, int]] = []
        node, out = first
        while (node, out) in left:
            there = left.pop((node, out))
            back = _OPPOSITE[out]
            left.pop((there, back))
            if there in crossing:
                turn = _turned(back, crossing[there], corners)
                ring += [_cut(there, back), _cut(there, turn)]
            else:
                turn = next(w for w in ("NS" if back in "WE" else "WE") if (there, w) in ways)
                ring.append((STEPS * there[0], STEPS * there[1]))
            node, out = there, turn
        yield ring


def _turned(arrived: str, code: int, corners: str) -> str:
    """The other side of the cut at a touching corner; *arrived* is where the boundary came from.

    With code 6 the cells to the SE and the NW are blocked, with 9 those to the SW and the NE. The cut goes
    round the free cell of the pair if they are joined, and round the blocked one if they are kept apart.
    """
    around_rising = (code == 9) == (corners == PART)
    pairs = ("WS", "EN") if around_rising else ("WN", "ES")
    pair = next(p for p in pairs if arrived in p)
    return pair.replace(arrived, "")


def _cut(node: Node, way: str) -> tuple[int, int]:
    """The point one step from a corner."""
    dx, dy = {"W": (-1, 0), "E": (1, 0), "S": (0, -1), "N": (0, 1)}[way]
    return STEPS * node[0] + dx, STEPS * node[1] + dy
