"""DXF drawings: closed loops of the model space become a wall and obstacles.

Read are LWPOLYLINE and POLYLINE with bulges, LINE, ARC and CIRCLE, also inside blocks, as seen from above (z
is ignored, the mirrored extrusion (0, 0, -1) applied). Units stay the drawing's. A DXF coordinate is a
double; its value is taken to be the shortest decimal that denotes that double, which is what exporters write.
Everything that is moved, joined or left out is named in the scene's notes, with proven bounds of the moves.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from flint import fmpq

from exactacq.files.dxf.entities import read_drawing
from exactacq.files.loops.assembly import drawing_contents
from exactacq.files.loops.contents import Contents
from exactacq.files.repairs.flattened import Flattening


def load_dxf(
    path: Path,
    start: tuple[fmpq, fmpq] | None,
    layers: Iterable[str] | None = None,
    *,
    outer: str = "wall",
    tolerance: fmpq | None = None,
    union: bool = False,
    thicken: fmpq | None = None,
    flatten: fmpq | None = None,
) -> Contents:
    """The loops of a DXF drawing; *layers* selects by name, all by default.

    With *flatten* arcs stand for ellipses and splines, within that distance. The other options are those of
    `drawing_contents`. Raises `FormatError`.
    """
    flattening = None if flatten is None else Flattening(flatten)
    drawing = read_drawing(path, layers, flattening)
    return drawing_contents(
        drawing, path.stem, start, outer=outer, tolerance=tolerance, union=union, thickness=thicken
    )
