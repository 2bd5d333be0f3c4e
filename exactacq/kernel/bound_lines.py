"""Lines of a pencil at which something is passed: where its cells may end."""

from __future__ import annotations

from typing import Final, final

Passed = list[tuple[int, int, int]]
"""What a line passes: number (a vertex, or an arc), side and sign of each (see `kernel.line_events`)."""
NOTHING: Final = -1
"""The number of what is passed where that is nothing."""


@final
class BoundLine:
    """A line of a pencil: its parameter lies between ``low`` and ``high``, its exact value is ``value``.

    The value is None where none is made yet. The line passes ``number``, a vertex or an arc, or `NOTHING`;
    ``side`` and ``sign`` tell how (see `kernel.line_events`). Where equal lines were brought together,
    ``others`` is what it passes besides. Unless it ``is_sure``, floats leave open whether it exists.
    """

    def __init__(
        self, low: float, high: float, number: int, side: int, sign: int, is_sure: bool, value: object
    ) -> None:
        self.low, self.high = low, high
        self.number, self.side, self.sign = number, side, sign
        self.is_sure = is_sure
        self.value = value
        self.others: Passed | None = None

    @property
    def passed(self) -> Passed:
        """All that the line passes."""
        if self.number == NOTHING:
            return []
        own = [(self.number, self.side, self.sign)]
        return own if self.others is None else own + self.others

    @property
    def passes_several(self) -> bool:
        """Whether it passes several things."""
        return self.others is not None and len(self.others) > 0


def known_line(near: float, bound: float, passed: Passed, value: object) -> BoundLine:
    """A line whose exact value is known, held with a *bound*; what it passes.

    Its interval is twice as wide, which makes up for the rounding of its ends.
    """
    number, side, sign = passed[0] if passed else (NOTHING, 0, 0)
    found = BoundLine(near - 2.0 * bound, near + 2.0 * bound, number, side, sign, True, value)
    if len(passed) > 1:
        found.others = passed[1:]
    return found
