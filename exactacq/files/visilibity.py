"""Environments of VisiLibity: polygons of one vertex a line, ``x y``, parted by lines that begin with //.

The first polygon is the boundary, and so the wall; the others are holes, and so obstacles.
"""

from __future__ import annotations

from pathlib import Path

from flint import fmpq

from exactacq.errors import FormatError, about
from exactacq.files.loops.areas import Areas, Row
from exactacq.files.loops.contents import Contents
from exactacq.files.source import MAX_EDGES, read_text
from exactacq.numbers.rationals import rational


def load_visilibity(path: Path, start: tuple[fmpq, fmpq] | None) -> Contents:
    """The polygons of an environment. Raises `FormatError` with the line."""
    text = read_text(path)
    if text.count("\n") > 4 * MAX_EDGES:
        raise FormatError(f"more than {MAX_EDGES} edges; give a smaller part")
    areas, rows = Areas(), list[Row]()
    for number, line in enumerate((*text.splitlines(), "//"), 1):
        words = line.split()
        if line.lstrip().startswith("//"):
            if rows:
                areas.add([*rows, rows[0]], "hole" if areas.rings else "boundary")
            rows = []
        elif words:
            with about(f"line {number}"):
                if len(words) != 2:
                    raise FormatError(f"a vertex is two numbers, not {len(words)} words")
                rows.append((rational(words[0]), rational(words[1]), fmpq(0)))
    if not areas.rings:
        raise FormatError("no polygon of three vertices; give a boundary and holes")
    wall, *holes = areas.rings
    return Contents(name=path.stem, loops=tuple(holes), wall=wall, start=start, notes=tuple(areas.mended()))
