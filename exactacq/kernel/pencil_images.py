"""Makes the images of the line families of one pencil."""

from __future__ import annotations

from exactacq.kernel.bound_lines import BoundLine
from exactacq.kernel.bounded import UNIT
from exactacq.kernel.cells import LineCells
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.family_images import NONE, EndLine, FamilyImage, locate
from exactacq.kernel.line_keys import LineNumbers
from exactacq.kernel.lines import Frame


def pencil_images(
    rows: list[LineCells],
    frame: Frame,
    at: tuple[int, int],
    goes_back: bool,
    feature: int,
    numbers: LineNumbers,
    curves: list[CurveImage],
    following: list[int],
    origin: object,
) -> list[FamilyImage]:
    """The images of the cells of a pencil, and where their lines meet *curves*; without these, not where.

    *at* is the edge at the contact, and the corner at which that stays or `NONE`; *feature* the number of the
    corner or circle by which lines are numbered, or `NONE`.
    """
    contact, corner = at
    found: list[FamilyImage] = []
    before: FamilyImage | None = None
    # Neighbouring cells share a bound, so they share what is told of it.
    last: EndLine | None = None
    for k in range(len(rows)):
        row = rows[k]
        first = _end(row.first, frame, feature, numbers) if last is None else last
        last = _end(row.last, frame, feature, numbers)
        edges = (row.behind if goes_back else NONE, contact, row.ahead)
        image = FamilyImage(frame, (first, last), edges, goes_back, corner, origin, k)
        if curves:
            locate(image, (first, last), before, curves, following)
        found.append(image)
        before = image
    return found


def _end(bound: BoundLine, frame: Frame, feature: int, numbers: LineNumbers) -> EndLine:
    """A line that bounds cells: the middle of its interval, and half its length.

    Rounding moves the middle by UNIT times its size.
    """
    passed = bound.passed
    middle = 0.5 * (bound.low + bound.high)
    error = 0.5 * (bound.high - bound.low) * (1.0 + 4.0 * UNIT) + 2.0 * UNIT * abs(middle)
    keys = numbers.keys(feature, passed) if feature >= 0 else []
    corners = [number for number, side, _ in passed if side == 0]
    return EndLine(frame, middle, error, corners, keys if keys else [numbers.fresh(1)])
