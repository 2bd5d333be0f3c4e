"""Numbers for features and for lines that touch two of them, the same however such a line is found.

Corner v has the number v, the circle whose first arc is c the number *count* + c, where *count* is that of
the edges. A line is known by two corners (kind 0); by a corner, a circle and on which side of it the circle
lies (1 and 2); or by two circles and which of their common tangents it is (3 to 6). Its number is
(a *count* + b) 8 + kind, where a and b are a corner and a corner or first arc, or two first arcs.
"""

from __future__ import annotations

from typing import Final, final

from exactacq.kernel.bound_lines import Passed

NORMAL: Final = 7
"""The kind of the normals of straight edges."""


@final
class LineNumbers:
    """Numbers the lines of one scene; *circles* has for every arc the first on its circle, else itself.

    A line that passes nothing has a number of its own, which is negative.
    """

    def __init__(self, circles: list[int]) -> None:
        self.circles, self.count = circles, len(circles)
        self.used = 0
        self._less: dict[int, int] = {}

    def feature(self, number: int, is_round: bool) -> int:
        """The number of a corner, or of the circle of an arc."""
        return self.count + self.circles[number] if is_round else number

    def is_circle(self, feature: int) -> bool:
        """Whether a feature is a circle."""
        return feature >= self.count

    def first_arc(self, circle: int) -> int:
        """The first arc of a circle, which is given as a feature."""
        return circle - self.count

    def fresh(self, count: int) -> int:
        """The first of some numbers that were not given before, and go down from it."""
        first = -1 - self.used
        self.used += count
        return first

    def keys(self, feature: int, passed: Passed) -> list[int]:
        """The numbers of a feature's tangent line, by all that it passes but arcs of the same circle."""
        found: list[int] = []
        is_round = self.is_circle(feature)
        own = self.first_arc(feature) if is_round else feature
        for number, side, sign in passed:
            if side == 0 and is_round:
                found.append(self.mixed(number, own, sign < 0))
            elif side == 0:
                found.append(self.corners(own, number))
            elif not is_round:
                found.append(self.mixed(own, self.circles[number], sign > 0))
            elif self.circles[number] != own:
                other = self.circles[number]
                turn = sign if side > 0 or own < other else -sign
                kind = 3 + 2 * int(side > 0) + int(turn > 0)
                found.append(self._number(min(own, other), max(own, other), kind))
        if len(found) > 1:
            self._unite(found)
        return found

    def least(self, key: int) -> int:
        """One number for all that a line is known to have, as lines that pass several things have come up."""
        while True:
            less = self._less.get(key, key)
            if less == key:
                return key
            key = less

    def _unite(self, keys: list[int]) -> None:
        """Note that some numbers are one line's."""
        least = self.least(keys[0])
        for key in keys:
            other = self.least(key)
            if other < least:
                least, other = other, least
            if other != least:
                self._less[other] = least

    def corners(self, a: int, b: int) -> int:
        """The number of the line through two corners."""
        return key_of_corners(a, b, self.count)

    def features(self, key: int) -> tuple[int, int]:
        """The two features that a line touches, by its number; no normal does."""
        kind, pair = key % 8, key // 8
        a, b = pair // self.count, pair % self.count
        if kind == 0:
            return a, b
        return (a if kind < 3 else self.count + a), self.count + b

    def touches(self, key: int, edge: int) -> bool:
        """Whether a line touches the circle of an edge; a straight edge has none, nor has a way."""
        if key % 8 in (0, NORMAL) or edge >= self.count:
            return False
        return self.count + self.circles[edge] in self.features(key)

    def tangent(self, one: int, other: int, one_side: int, other_side: int) -> int:
        """The number of the line that touches two circles, given as arcs, by their sides of it.

        A side is 1 if the circle lies to the left of the way from where the line touches the first one to
        where it touches the other, else -1.
        """
        is_right = (one_side if one < other else -other_side) < 0
        kind = 3 + 2 * int(one_side != other_side) + int(is_right)
        return self._number(min(one, other), max(one, other), kind)

    def mixed(self, vertex: int, circle: int, is_left: bool) -> int:
        """The number of the line through a corner, *is_left* of a circle, given as an arc, that it touches.

        It is seen from the corner towards the circle.
        """
        return self._number(vertex, circle, 1 + int(is_left))

    def _number(self, a: int, b: int, kind: int) -> int:
        return (a * self.count + b) * 8 + kind


def key_of_corners(a: int, b: int, count: int) -> int:
    """The number of the line through two corners of a scene with so many edges."""
    return (min(a, b) * count + max(a, b)) * 8


def key_of_normal(edge: int, vertex: int, count: int) -> int:
    """The number of the normal of a straight edge through a vertex."""
    return (edge * count + vertex) * 8 + NORMAL
