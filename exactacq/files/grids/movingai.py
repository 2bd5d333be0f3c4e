"""Maps of the MovingAI benchmarks (.map): cells of games, of which each row is a line of letters.

Free are ``.`` and ``G`` (ground) and ``S`` (swamp); blocked are ``@`` and ``O`` (out of bounds), ``T``
(trees) and ``W`` (water). Rows run from the top down; here y goes up, and the map's SW corner is (0, 0).
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.grids.outlines import JOIN, check_cells
from exactacq.files.grids.world import Placement, grid_contents
from exactacq.files.loops.contents import Contents
from exactacq.files.source import one_line, read_bytes

FREE, BLOCKED = b".GS", b"@OTW"
_HEADER = re.compile(rb"\s*type\s+(\w+)\s+height\s+(\d{1,9})\s+width\s+(\d{1,9})\s+map[ \t]*\r?\n")


def load_movingai(
    path: Path,
    start: tuple[fmpq, fmpq] | None,
    *,
    corners: str = JOIN,
    border: str | None = None,
    simplify: fmpq | None = None,
) -> Contents:
    """The rings of a map; nothing beyond its border is free, unless *border* is "open".

    See `grid_contents` for the others. Raises `FormatError`.
    """
    data = read_bytes(path)
    header = _HEADER.match(data)
    if header is None:
        raise FormatError("not a MovingAI map (type, height, width, map); give another file")
    height, width = int(header[2]), int(header[3])
    check_cells(width, height)
    rows = data[header.end() :].split()
    if len(rows) != height:
        raise FormatError(f"{len(rows)} rows, but the height is {height}; correct the file")
    for number, row in enumerate(rows):
        if len(row) != width:
            raise FormatError(
                f"row {number} has {len(row)} cells, but the width is {width}; correct the file"
            )
    cells = np.frombuffer(b"".join(rows), np.uint8).reshape(height, width)
    blocked = np.isin(cells, list(BLOCKED))
    odd = np.argwhere(~blocked & ~np.isin(cells, list(FREE)))
    if len(odd):
        row, column = odd[0].tolist()
        letter = one_line(repr(chr(cells[row, column])))
        raise FormatError(f"row {row}, column {column}: {letter} is none of . G S @ O T W")
    return grid_contents(
        blocked[::-1],
        Placement(),
        path.stem,
        start,
        corners=corners,
        border=border or "wall",
        tolerance=simplify,
    )
