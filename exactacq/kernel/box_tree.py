"""A tree of boxes that finds those near a window: a packed R-tree.

Boxes in a row that touch each other, as those of a boundary's edges do, make a run with the box around it.
Runs are sorted into groups of neighbours, and these again (Leutenegger, Lopez and Edgington, "STR: a simple
and efficient algorithm for R-tree packing", 1997). So a search takes time near what it finds, whatever the
boxes' sizes and wherever they lie. Margins are the caller's: distances are compared as they are computed.
"""

from __future__ import annotations

from math import ceil, sqrt
from operator import attrgetter
from typing import Final, cast, final

from exactacq.kernel.bounded import UNIT
from exactacq.kernel.lines import Line

GROUP: Final = 12
"""Boxes in a run or a group at most; from 8 to 20 a search takes about the same."""
NUMBER: Final = attrgetter("number")

Box = tuple[float, float, float, float]
"""(x0, y0, x1, y1)."""


@final
class BoxNode:
    """A box with its number, or the box around a group: its number is that of a run's first box, else -1."""

    def __init__(self, box: Box, number: int, group: list[BoxNode]) -> None:
        self.x0, self.y0, self.x1, self.y1 = box
        self.x, self.y = self.x0 + self.x1, self.y0 + self.y1
        self.number, self.group = number, group
        self.label: object = number
        """The number as one object, which all lists share: many are kept."""

    def near(self, window: Box, reach: float) -> list[int]:
        """The numbers of the boxes at most as far as *reach* from a window, in ascending order."""
        x0, y0, x1, y1 = window
        square = reach * reach
        runs: list[BoxNode] = []
        self._search(x0, y0, x1, y1, square, runs)
        runs.sort(key=NUMBER)
        found: list[object] = []
        for run in runs:
            if not run.group:
                found.append(run.label)
            for box in run.group:
                if box.square_from(x0, y0, x1, y1) <= square:
                    found.append(box.label)
        return cast(list[int], found)

    def square_from(self, x0: float, y0: float, x1: float, y1: float) -> float:
        """The squared distance of the box from a window."""
        dx = self.x0 - x1 if self.x0 > x1 else x0 - self.x1 if x0 > self.x1 else 0.0
        dy = self.y0 - y1 if self.y0 > y1 else y0 - self.y1 if y0 > self.y1 else 0.0
        return dx * dx + dy * dy

    def along(self, line: Line, reach: float, slack: float) -> list[int]:
        """The numbers of the boxes that a line may meet up to *reach* from its contact, in ascending order.

        *slack* covers the errors of boxes and distances. With w from the contact to a corner the line misses
        the box if all d x w have one sign. With sizes as sums of both components, d held with e and w with s,
        d x w is off by at most (|d| + 2 e) s + e |w|, and its roundings are below 8 UNIT |d| |w|.
        """
        found: list[int] = []
        x, y, dx, dy, ce, de = line
        size = abs(dx) + abs(dy)
        shift = (size + 2.0 * de) * (2.0 * slack + ce)
        self._search_along(x, y, dx, dy, shift, de + 8.0 * UNIT * size, (reach + ce) * (reach + ce), found)
        found.sort()
        return found

    def _search_along(
        self,
        x: float,
        y: float,
        dx: float,
        dy: float,
        shift: float,
        turn: float,
        square: float,
        found: list[int],
    ) -> None:
        for node in self.group:
            # From the contact to the sides.
            west, east = node.x0 - x, node.x1 - x
            south, north = node.y0 - y, node.y1 - y
            if node.square_from(x, y, x, y) > square:
                continue
            a, b, c, d = dx * south, dx * north, dy * west, dy * east
            low = (a if a < b else b) - (c if c > d else d)
            high = (a if a > b else b) - (c if c < d else d)
            error = shift + turn * (max(-west, east) + max(-south, north))
            if low > error or -high > error:
                continue
            if not node.group:
                found.append(node.number)
            else:
                node._search_along(x, y, dx, dy, shift, turn, square, found)

    def _search(self, x0: float, y0: float, x1: float, y1: float, square: float, runs: list[BoxNode]) -> None:
        for node in self.group:
            if node.square_from(x0, y0, x1, y1) > square:
                continue
            if node.number >= 0:
                runs.append(node)
            else:
                node._search(x0, y0, x1, y1, square, runs)


def box_tree(boxes: list[Box]) -> BoxNode:
    """The tree of some boxes, numbered in their order."""
    nodes = _runs([BoxNode(boxes[k], k, []) for k in range(len(boxes))])
    while len(nodes) > GROUP:
        # Strips of neighbours from left to right, each cut into groups from bottom to top.
        strip = GROUP * ceil(sqrt(len(nodes) / GROUP))
        groups: list[BoxNode] = []
        nodes.sort(key=attrgetter("x"))
        for start in range(0, len(nodes), strip):
            some = nodes[start : start + strip]
            some.sort(key=attrgetter("y"))
            for k in range(0, len(some), GROUP):
                groups.append(_around(some[k : k + GROUP], -1))
        nodes = groups
    return _around(nodes, -1)


def _runs(boxes: list[BoxNode]) -> list[BoxNode]:
    """Boxes in a row that touch each other grouped; those that do not are left alone."""
    found: list[BoxNode] = []
    run: list[BoxNode] = []
    for box in boxes:
        if run and (len(run) == GROUP or not _touch(run[-1], box)):
            found.append(_around(run, run[0].number) if len(run) > 1 else run[0])
            run = []
        run.append(box)
    if run:
        found.append(_around(run, run[0].number) if len(run) > 1 else run[0])
    return found


def _touch(a: BoxNode, b: BoxNode) -> bool:
    return a.x0 <= b.x1 and b.x0 <= a.x1 and a.y0 <= b.y1 and b.y0 <= a.y1


def _around(group: list[BoxNode], number: int) -> BoxNode:
    x0 = y0 = x1 = y1 = 0.0
    for k in range(len(group)):
        node = group[k]
        x0 = node.x0 if k == 0 or node.x0 < x0 else x0
        y0 = node.y0 if k == 0 or node.y0 < y0 else y0
        x1 = node.x1 if k == 0 or node.x1 > x1 else x1
        y1 = node.y1 if k == 0 or node.y1 > y1 else y1
    return BoxNode((x0, y0, x1, y1), number, group)
