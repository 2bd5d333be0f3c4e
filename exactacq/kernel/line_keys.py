"""Numbers for lines that touch two features, the same however such a line is found.

A line is known by two vertices; by a vertex, a circle and the side of the circle; or by two circles and the
kind of common tangent (see `exactacq.visibility.line_names`, which names them likewise).
"""

from __future__ import annotations

from typing import final

from exactacq.kernel.bound_lines import Passed


@final
class LineNumbers:
    """Numbers the lines of one scene; *circles* are the numbers of the circles of its arcs.

    A line that passes nothing has a number of its own, which is negative.
    """

    def __init__(self, circles: list[int]) -> None:
        self.circles, self.count = circles, len(circles)
        self.used = 0

    def fresh(self, count: int) -> int:
        """The first of some numbers that were not given before, and go down from it."""
        first = -1 - self.used
        self.used += count
        return first

    def keys(self, own: int, is_round: bool, passed: Passed) -> list[int]:
        """The numbers of a tangent line of corner or circle *own*, by all that it passes."""
        found: list[int] = []
        for number, side, sign in passed:
            if side == 0 and is_round:
                found.append(self._mixed(number, own, sign < 0))
            elif side == 0:
                found.append(self._number(min(own, number), max(own, number), 0))
            elif not is_round:
                found.append(self._mixed(own, self.circles[number], sign > 0))
            elif self.circles[number] != own:
                other = self.circles[number]
                turn = sign if side > 0 or own < other else -sign
                kind = 3 + 2 * int(side > 0) + int(turn > 0)
                found.append(self._number(min(own, other), max(own, other), kind))
        return found

    def _mixed(self, vertex: int, circle: int, is_left: bool) -> int:
        return self._number(vertex, circle, 1 + int(is_left))

    def _number(self, a: int, b: int, kind: int) -> int:
        return (a * self.count + b) * 8 + kind
