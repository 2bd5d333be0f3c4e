"""Things laid out in rows, as on a sheet."""

from __future__ import annotations

from collections.abc import Sequence
from math import isqrt
from typing import NamedTuple

from flint import fmpq

from exactacq.scene.shapes import Shape
from exactacq.study.families.parts import moved
from exactacq.study.families.plan import Corner, Rectangle


class Tile(NamedTuple):
    """A shape in the rectangle from the origin to (width, height)."""

    shape: Shape
    width: fmpq
    height: fmpq


class Layout(NamedTuple):
    """Shapes, the rectangle about them, and places between neighbours, in the middle of gaps."""

    shapes: list[Shape]
    box: Rectangle
    places: list[Corner]


def in_rows(pieces: Sequence[Tile], gap: fmpq) -> Layout:
    """The pieces from west to east in rows of about the same length, with a gap between their rectangles."""
    long = isqrt(int(sum((piece.width + gap) * (piece.height + gap) for piece in pieces))) + 1
    shapes: list[Shape] = []
    places: list[Corner] = []
    x = bottom = top = east = fmpq(0)
    for shape, width, height in pieces:
        if x and x + width > long:
            x, bottom = fmpq(0), top + gap
        shapes.append(moved(shape, x, bottom))
        east, top = max(east, x + width), max(top, bottom + height)
        x += width + gap
        places += [(x - gap / 2, bottom + height / 2), (x - gap / 2, bottom)]
        places += [(x - gap - width / 2, top + gap / 2)]
    return Layout(shapes, Rectangle(fmpq(0), fmpq(0), east, top), places)
