"""Vertices as integers: which lines through them are equal, and in which order they come, decided exactly.

Drawings have coordinates of few digits, so that all of them are integers once they are multiplied by one
number. On such a *lattice* lines through many corners, which floats cannot part, cost a few products.
"""

from __future__ import annotations

from typing import final

from exactacq.kernel.bound_lines import NOTHING, BoundLine
from exactacq.kernel.images import SLIDING

Ratio = tuple[int, int]
"""A rational number, with a positive denominator."""


@final
class Lattice:
    """The vertices of a scene, by their numbers: both coordinates, times the same number."""

    def __init__(self, x: list[int], y: list[int]) -> None:
        self.x, self.y = x, y


def place_among(vectors: list[tuple[int, int]], x: int, y: int) -> tuple[int, bool]:
    """Where a direction comes among others, counterclockwise from the east; and whether it is one of them."""
    is_upper = _is_upper(x, y)
    for k in range(len(vectors)):
        other_x, other_y = vectors[k]
        turn = other_x * y - other_y * x
        if _is_upper(other_x, other_y) != is_upper:
            turn = -1 if is_upper else 1
        if turn <= 0:
            return k, turn == 0
    return len(vectors), False


def _is_upper(x: int, y: int) -> bool:
    """Whether a direction is less than half a turn counterclockwise of the east, or the east itself."""
    return y > 0 or (y == 0 and x > 0)


@final
class LatticeLines:
    """The lines about a vertex or, of *kind* sliding, the normals of a straight edge that starts there.

    *base* is the base vector of their frame (see `kernel.surroundings`) on the lattice. *low* and *high* are
    the parameters of the first and the last line, which need not pass vertices.
    """

    def __init__(
        self, lattice: Lattice, kind: int, center: int, base: tuple[int, int], low: Ratio, high: Ratio
    ) -> None:
        self._lattice, self._is_sliding = lattice, kind == SLIDING
        self._x, self._y = lattice.x[center], lattice.y[center]
        self._ex, self._ey = base
        self._low, self._high = low, high

    def parted(self, cluster: list[BoundLine], low: BoundLine, high: BoundLine) -> list[BoundLine]:
        """The distinct lines among some of which floats leave the order open, in order, equal ones as one.

        Lines before the first one, *low*, and after the last one, *high*, are left out. None at all are told
        if one of them touches an arc.
        """
        vectors: list[tuple[int, int]] = []
        groups: list[list[BoundLine]] = []
        for line in cluster:
            top, below = self._ratio(line, low)
            if below == 0:
                return []
            # Turned by a quarter, so that all lie on the upper side.
            at, is_there = place_among(vectors, -top, below)
            if is_there:
                groups[at].append(line)
            else:
                vectors.insert(at, (-top, below))
                groups.insert(at, [line])
        begin, end = 0, len(groups)
        for k in range(len(groups)):
            if low in groups[k]:
                begin = k
            if high in groups[k]:
                end = k + 1
        return [_joined(groups[k]) for k in range(begin, end)]

    def _ratio(self, line: BoundLine, low: BoundLine) -> Ratio:
        """The parameter of a line; with the denominator 0 if it does not tell."""
        v = line.number
        if v == NOTHING:
            return self._low if line is low else self._high
        if line.side != 0 or line.others is not None:
            return 0, 0
        x, y = self._lattice.x[v] - self._x, self._lattice.y[v] - self._y
        along = self._ex * x + self._ey * y
        if self._is_sliding:
            return along, self._ex * self._ex + self._ey * self._ey
        across = self._ex * y - self._ey * x
        return (-across, -along) if along < 0 else (across, along)


def _joined(lines: list[BoundLine]) -> BoundLine:
    """Equal lines as one, that passes what they pass and lies where all of them may lie."""
    first = lines[0]
    if len(lines) == 1:
        return first
    low, high, value = first.low, first.high, first.value
    passed = first.passed
    for line in lines[1:]:
        low, high = max(low, line.low), min(high, line.high)
        value = line.value if value is None else value
        passed = passed + line.passed
    number, side, sign = passed[0] if passed else (NOTHING, 0, 0)
    joined = BoundLine(low, high, number, side, sign, True, value)
    if len(passed) > 1:
        joined.others = passed[1:]
    return joined
