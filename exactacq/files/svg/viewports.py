"""Lengths with units, and where nested drawings and symbols are placed: the viewports of SVG."""

from __future__ import annotations

import re
from collections.abc import Mapping

from flint import fmpq

from exactacq.errors import FormatError, shown
from exactacq.files.source import one_line
from exactacq.files.svg.transforms import NUMBER, Matrix, numbers
from exactacq.numbers.rationals import rational

UNITS = {
    "": fmpq(1), "px": fmpq(1), "in": fmpq(96), "cm": fmpq(4800, 127), "mm": fmpq(480, 127),
    "pt": fmpq(4, 3), "pc": fmpq(16), "q": fmpq(120, 127),
}  # fmt: skip
"""Units in pixels, as CSS has them: 96 to the inch."""
_LENGTH = re.compile(rf"\s*({NUMBER})\s*+([A-Za-z]*|%)\s*", re.ASCII)
Box = tuple[fmpq, fmpq]
"""Width and height of the viewport that percentages refer to."""


def length(attributes: Mapping[str, str], key: str, box: Box | None, default: str = "0") -> fmpq:
    """A length in user units from an attribute; `FormatError` for no length, or one in units of a font."""
    text = attributes.get(key) or default
    match = _LENGTH.fullmatch(text)
    if match is None or (match[2] != "%" and match[2].lower() not in UNITS):
        raise FormatError(
            f"{key}: a number, perhaps with {' '.join(filter(None, UNITS))} or %, is needed, "
            f"not {one_line(repr(text[:40]))}"
        )
    value = rational(match[1])
    if match[2] != "%":
        return value * UNITS[match[2].lower()]
    if box is None or key == "r":
        raise FormatError(f"{key}: {one_line(text)} of what is not told; give a number")
    return value / 100 * box[key in ("y", "y1", "y2", "cy", "ry", "height")]


def outermost(attributes: Mapping[str, str]) -> tuple[Matrix, Box | None]:
    """The mirror that makes y go up in the box of a whole drawing, and that box."""
    view = numbers(attributes.get("viewBox", ""), "viewBox")
    if len(view) == 4:
        return Matrix(d=fmpq(-1), f=2 * view[1] + view[3]), (view[2], view[3])
    told = [attributes.get(key, "").strip() for key in ("width", "height")]
    if not all(told) or any(size.endswith("%") for size in told):  # of a page that is not known
        return Matrix(d=fmpq(-1)), None
    width, height = (length(attributes, key, None) for key in ("width", "height"))
    return Matrix(d=fmpq(-1), f=height), (width, height)


def nested(
    attributes: Mapping[str, str], outer: Box | None, size: Mapping[str, str]
) -> tuple[Matrix, Box] | None:
    """Where what is in a nested drawing or symbol lies, and the box for percentages in it.

    None if its box has no size, so that it shows nothing. A ``use`` may tell another *size*. Nothing is cut
    off at the box.
    """
    said = {**attributes, **{key: size[key] for key in ("width", "height") if key in size}}
    x, y = length(said, "x", outer), length(said, "y", outer)
    placed, view = Matrix(e=x, f=y), numbers(attributes.get("viewBox", ""), "viewBox")
    if len(view) not in (0, 4):
        raise FormatError(f"viewBox: four numbers are needed, not {len(view)}")
    if outer is None and not ("width" in said and "height" in said):
        if view:
            raise FormatError(
                "a drawing within the drawing without width and height is not placed; give them"
            )
        return placed, (fmpq(0), fmpq(0))
    width, height = (length(said, key, outer, "100%") for key in ("width", "height"))
    if min(width, height, *view[2:]) <= 0:
        return None
    if not view:
        return placed, (width, height)
    scales = width / view[2], height / view[3]
    align, _, how = attributes.get("preserveAspectRatio", "").strip().partition(" ")
    align = align or "xMidYMid"
    if align == "none":
        return placed.after(Matrix(a=scales[0], d=scales[1])).after(Matrix(e=-view[0], f=-view[1])), (
            view[2],
            view[3],
        )
    shares = {"Min": fmpq(0), "Mid": fmpq(1, 2), "Max": fmpq(1)}
    match = re.fullmatch(r"x(Min|Mid|Max)Y(Min|Mid|Max)", align)
    if match is None:
        raise FormatError(f"preserveAspectRatio: xMidYMid or the like is needed, not {shown(align)}")
    scale = max(scales) if how.strip() == "slice" else min(scales)
    rest = Matrix(
        e=(width - view[2] * scale) * shares[match[1]], f=(height - view[3] * scale) * shares[match[2]]
    )
    inner = rest.after(Matrix(a=scale, d=scale)).after(Matrix(e=-view[0], f=-view[1]))
    return placed.after(inner), (view[2], view[3])
