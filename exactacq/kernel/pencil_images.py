"""Makes the images of the line families of one pencil."""

from __future__ import annotations

from exactacq.kernel.bound_lines import BoundLine
from exactacq.kernel.bounded import UNIT
from exactacq.kernel.cells import LineCells
from exactacq.kernel.family_images import NONE, FamilyImage
from exactacq.kernel.images import TURNING
from exactacq.kernel.line_keys import LineNumbers
from exactacq.kernel.lines import Frame


def pencil_images(
    rows: list[LineCells],
    frame: Frame,
    at: tuple[int, bool],
    goes_back: bool,
    name: tuple[int, bool],
    numbers: LineNumbers,
    origin: object,
) -> list[FamilyImage]:
    """The images of the cells of a pencil.

    *at* is the edge at the contact, and whether that stays at a corner; *name* the number of the corner or
    circle that names the lines, `NONE` if they have no names, and whether it is a circle.
    """
    (contact, fixed), (own, is_round) = at, name
    found: list[FamilyImage] = []
    corner = contact if frame[0] == TURNING else NONE
    # Neighbouring cells share a bound, so they share what is told of it.
    last_keys: list[int] = []
    last_corners: list[int] = []
    for k in range(len(rows)):
        row = rows[k]
        first_keys = last_keys if k else _keys(row.first, own, is_round, numbers)
        last_keys = _keys(row.last, own, is_round, numbers)
        first_corners = last_corners if k else _vertices(row.first)
        last_corners = _vertices(row.last)
        image = FamilyImage(
            frame,
            (*_parameter(row.first), *_parameter(row.last)),
            (row.behind if goes_back else NONE, contact, row.ahead),
            fixed,
            goes_back,
            corner,
            (first_corners, last_corners),
            (first_keys, last_keys),
            origin,
            k,
        )
        found.append(image)
    return found


def _keys(bound: BoundLine, own: int, is_round: bool, numbers: LineNumbers) -> list[int]:
    keys = numbers.keys(own, is_round, bound.passed) if own >= 0 else []
    return keys if keys else [numbers.fresh(1)]


def _parameter(bound: BoundLine) -> tuple[float, float]:
    """The middle of an interval, and half its length; rounding moves the middle by UNIT times its size."""
    middle = 0.5 * (bound.low + bound.high)
    return middle, 0.5 * (bound.high - bound.low) * (1.0 + 4.0 * UNIT) + 2.0 * UNIT * abs(middle)


def _vertices(bound: BoundLine) -> list[int]:
    return [number for number, side, _ in bound.passed if side == 0]
