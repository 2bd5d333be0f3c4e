"""Any image as a plan: pixels darker than a threshold are blocked cells, others are free."""

from __future__ import annotations

from pathlib import Path

from flint import fmpq

from exactacq.errors import FormatError, shown
from exactacq.files.grids.outlines import JOIN
from exactacq.files.grids.pixels import read_pixels
from exactacq.files.grids.world import Placement, grid_contents
from exactacq.files.loops.contents import Contents

HALF = fmpq(1, 2)


def load_image(
    path: Path,
    start: tuple[fmpq, fmpq] | None,
    *,
    threshold: fmpq | None = None,
    resolution: fmpq | None = None,
    corners: str = JOIN,
    border: str | None = None,
    simplify: fmpq | None = None,
) -> Contents:
    """The rings of an image whose SW corner is (0, 0) and whose pixels are *resolution* (1) wide.

    Blocked are pixels whose brightness, from 0 for black to 1 for white, is below *threshold* (1/2); what is
    see-through is free. See `grid_contents` for the others. Raises `FormatError`.
    """
    level = HALF if threshold is None else threshold
    if not 0 <= level <= 1:
        raise FormatError(f"threshold: from 0 for black to 1 for white, not {shown(level)}")
    pixels = read_pixels(path)
    blocked = pixels.values < int((level * pixels.most).ceil())
    if pixels.clear is not None:
        blocked &= ~pixels.clear
    place = Placement(fmpq(1) if resolution is None else resolution)
    return grid_contents(
        blocked[::-1], place, path.stem, start, corners=corners, border=border or "open", tolerance=simplify
    )
