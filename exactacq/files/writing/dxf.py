"""DXF files: a layer for each kind of thing; arcs are bulges of polylines, circles are circles.

Numbers are doubles, so decimals of up to 15 digits stay as they are. Units are not said.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager

import ezdxf
from ezdxf import options
from flint import fmpq

from exactacq.files.writing.corners import Corners, is_exact_bulge
from exactacq.files.writing.decimals import Precision
from exactacq.files.writing.sheet import NO_TERRAIN, TERRAIN, Item, Sheet, Written
from exactacq.geometry.curves import Arc

RELEASE = "R2000"
"""The first release of the format that has LWPOLYLINE."""
COLOURS = {"obstacles": 8, "enclosure": 8, "path": 5, "known": 7, "links": 30, "diversions": 30, "view": 4}
"""AutoCAD's numbers of colours; other layers are red."""
RED = 1
DOUBLES = Precision(None)
WIDEST = fmpq(1)


def written(sheet: Sheet) -> Written:
    """The sheet as a DXF file; the same sheet always gives the same bytes. Linear in the curves."""
    notes = (NO_TERRAIN,) if TERRAIN in sheet.layers else ()
    sheet = sheet.without(TERRAIN)
    out = io.StringIO()
    with _without_dates():
        document = ezdxf.new(RELEASE, units=0)
        for layer in sheet.layers:
            document.layers.add(layer, color=COLOURS.get(layer, RED))
        space = document.modelspace()
        moved = max((_add(space, item) for item in sheet.items), default=fmpq(0))
        document.write(out)
    return Written(document.encode(out.getvalue()), moved, notes)


@contextmanager
def _without_dates() -> Iterator[None]:
    """Have ezdxf write no times and random numbers."""
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before


def _add(space: ezdxf.layouts.Modelspace, item: Item) -> fmpq:
    """Add an entity for an item; how far its points moved at most."""
    layer = {"layer": item.layer}
    first = item.curves[0] if item.curves else None
    if item.place is not None:
        (x, dx), (y, dy) = DOUBLES.rounded(item.place.x), DOUBLES.rounded(item.place.y)
        space.add_point((float(x), float(y)), dxfattribs=layer)
        return fmpq(dx + dy)
    if isinstance(first, Arc) and first.full and len(item.curves) == 1:
        center, radius = first.center, first.radius
        (x, dx), (y, dy), (r, dr) = map(DOUBLES.rounded, (center.x, center.y, radius))
        space.add_circle((float(x), float(y)), float(r), dxfattribs=layer)
        return fmpq(dx + dy + dr)
    chain = Corners(item, DOUBLES, is_exact_bulge(DOUBLES), WIDEST)
    rows = [(float(c.x), float(c.y), float(c.bulge)) for c in chain.corners]
    space.add_lwpolyline(rows, format="xyb", close=item.closed, dxfattribs=layer)
    return chain.moved
