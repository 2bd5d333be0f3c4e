"""A robot's occupancy grid as a scene: what walls it can reach become obstacles."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import exactacq as xa

Cell = tuple[int, int]

OCCUPIED = 0
"""Of the map server's three values: occupied, unknown (205) and free (254)."""


def grid_scene(path: Path, start: Cell, radius: int) -> xa.Scene:
    """The scene of a binary PGM file, a cell a unit; the start is the middle of a cell, from the south-west.

    What is not occupied counts as free. Where two occupied cells meet in a corner alone, a third beside it
    counts as occupied too, for obstacles may not touch. Only walls that are reached from the start are taken,
    and the grid itself has none around it.
    """
    walls, (width, height) = _occupied(path)
    walls |= _fillings(walls)
    inside = _reached(start, walls, (width, height))
    holes = [loop for loop in _loops(inside) if _doubled_area(loop) > 0]
    return xa.Scene(list(map(xa.Polygon, holes)), start=tuple(f"{2 * c + 1}/2" for c in start), radius=radius)


def _occupied(path: Path) -> tuple[set[Cell], Cell]:
    """The occupied cells, counted from the south-west, and width and height."""
    data = path.read_bytes()
    lines = data.split(b"\n", 4)
    assert (lines[0], lines[3]) == (b"P5", b"255"), "a binary PGM file with one comment"
    width, height = map(int, lines[2].split())
    pixels = lines[4]
    cells = product(range(width), range(height))
    return {(x, height - 1 - y) for x, y in cells if pixels[y * width + x] == OCCUPIED}, (width, height)


def _fillings(walls: set[Cell]) -> set[Cell]:
    """Free cells that part two occupied ones which meet in a corner, as often as there are such."""
    filled: set[Cell] = set()
    while True:
        every = walls | filled
        found = {
            (x + 1, y) if (x, y) in every else (x, y)
            for x, y in {(x - dx, y - dy) for x, y in every for dx, dy in product((0, 1), (0, 1))}
            if ((x, y) in every) == ((x + 1, y + 1) in every)
            and ((x + 1, y) in every) == ((x, y + 1) in every)
            and ((x, y) in every) != ((x + 1, y) in every)
        }
        if not found:
            return filled
        filled |= found


def _reached(start: Cell, walls: set[Cell], size: Cell) -> set[Cell]:
    """The free cells that are reached from the start by sides."""
    found, waiting = {start}, [start]
    while waiting:
        x, y = waiting.pop()
        for cell in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
            if (
                cell not in walls
                and cell not in found
                and all(0 <= c < s for c, s in zip(cell, size, strict=True))
            ):
                found.add(cell)
                waiting.append(cell)
    return found


def _loops(inside: set[Cell]) -> list[list[Cell]]:
    """The loops between a set of cells and the others, with the set on the right: their corners."""
    sides: dict[Cell, Cell] = {}
    for x, y in inside:
        if (x, y - 1) not in inside:
            sides[x + 1, y] = x, y
        if (x, y + 1) not in inside:
            sides[x, y + 1] = x + 1, y + 1
        if (x - 1, y) not in inside:
            sides[x, y] = x, y + 1
        if (x + 1, y) not in inside:
            sides[x + 1, y + 1] = x + 1, y
    loops = []
    while sides:
        at = next(iter(sides))
        loop: list[Cell] = []
        while at in sides:
            loop.append(at)
            at = sides.pop(at)
        turns = zip(loop[-1:] + loop[:-1], loop, loop[1:] + loop[:1], strict=True)
        loops.append(
            [b for a, b, c in turns if (b[0] - a[0]) * (c[1] - b[1]) != (b[1] - a[1]) * (c[0] - b[0])]
        )
    return loops


def _doubled_area(loop: list[Cell]) -> int:
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(loop, loop[1:] + loop[:1], strict=True))
