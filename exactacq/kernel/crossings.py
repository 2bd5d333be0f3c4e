"""How a line meets edges: which of them it crosses, where, and in which direction, in floats with bounds.

A crossing is known by its edge and its *root*: of a segment 1 if the line, followed ahead, passes from free
to blocked, 2 otherwise; of an arc 1 for the crossing farther ahead, 2 for the other one. The state of an edge
is the sum of its roots, or `VAGUE`.
"""

from __future__ import annotations

from math import inf
from typing import Final, final

from exactacq.kernel.bounded import TINY, UNIT, WIDEN, cross, product, quotient, root, total, verdict
from exactacq.kernel.images import CONCAVE, ROLLING, SLIDING, STRAIGHT
from exactacq.kernel.surroundings import LEFT_OUT, THROUGH, FrameLine, FramePoint, Surroundings

VAGUE: Final = 4
"""Whether an edge is crossed is open."""


@final
class EdgeLine:
    """The line of an edge's ends in the frame: the vector between them, and the first end times it."""

    def __init__(self, a: FramePoint, b: FramePoint) -> None:
        self.x, self.y = b.x - a.x, b.y - a.y
        self.size = abs(self.x) + abs(self.y)
        self.bound = (a.bound + b.bound + UNIT * self.size) * WIDEN
        self.turn, self.turn_bound = cross(a.x, a.y, a.bound, self.x, self.y, self.bound)


@final
class EdgeStates:
    """The states of the edges around a family."""

    def __init__(self, around: Surroundings) -> None:
        self.around, self.near = around, around.near
        count = len(self.near.edges)
        self.state = [0] * count
        # Made when they are asked for.
        self.lines: list[EdgeLine | None] = [None] * count

    def look(self, j: int, line: FrameLine) -> int:
        """The state of edge j for a line."""
        around, near = self.around, self.near
        if around.place[j] == LEFT_OUT:
            return 0
        if near.middle[j] >= 0:
            return self._look_at_arc(j, line)
        return between(side(around.spots[j], line), side(around.spots[near.last[j]], line))

    def look_at_all(self, line: FrameLine) -> list[int]:
        """The states of all edges; each vertex is looked at once."""
        around, near = self.around, self.near
        last, middle, place = near.last, near.middle, around.place
        sides: list[int] = []
        for spot in around.spots:
            sides.append(side(spot, line))
        found: list[int] = []
        for j in range(len(near.edges)):
            if place[j] == LEFT_OUT:
                found.append(0)
            elif middle[j] >= 0:
                found.append(self._look_at_arc(j, line))
            else:
                found.append(between(sides[j], sides[last[j]]))
        return found

    def place(self, j: int, which: int, line: FrameLine) -> tuple[float, float]:
        """Where on a line edge j is crossed, in multiples of the direction; *which* of its roots.

        On the line through A along w it is (A - contact) x w / (direction x w).
        """
        if self.near.middle[j] >= 0:
            h, h_bound, half, half_bound, _ = self._chord(j, line)
            return _on_chord(h, h_bound, half, half_bound, 1 if which == 1 else -1, line)
        edge = self._line(j)
        wx, wy, w, size = edge.x, edge.y, edge.bound, edge.size
        below = line.dx * wy - line.dy * wx
        below_bound = w * line.for_bound + size * line.for_size + TINY
        top = edge.turn - (line.cx * wy - line.cy * wx)
        data = line.contact_bound * (size + 2.0 * w) + line.contact_size * w
        rounding = 2.0 * UNIT * (line.contact_size * size + abs(top))
        return quotient(top, (edge.turn_bound + data + rounding + TINY) * WIDEN, below, below_bound)

    def span(self, j: int) -> tuple[float, float]:
        """Bounds of all places where lines of the family cross edge j, in multiples of the direction.

        From the contact; of normals of an arc from its centre. The direction (1, t) of lines that turn makes
        the place the first coordinate of the crossing, and (0, 1) or (0, -1) of those that slide the second
        one or its negative; of normals that go inward it is the negative of the first. A crossing lies
        between the ends of a segment, or within an arc's radius of its centre. Four roundings lose at most
        2 UNIT times the sizes. Of lines that roll nothing is told.
        """
        around, near = self.around, self.near
        kind = around.frame.kind
        if kind == ROLLING:
            return -inf, inf
        if near.middle[j] >= 0:
            a = b = around.centers[near.middle[j]]
            room, room_bound = around.radius(near.edges[j])
            room += room_bound
        else:
            a, b, room = around.spots[j], around.spots[near.last[j]], 0.0
        one, other = (a.y, b.y) if kind == SLIDING else (a.x, b.x)
        if around.frame.sense < 0:
            one, other = -one, -other
        slack = room + 2.0 * UNIT * (abs(one) + abs(other) + a.bound + b.bound + room)
        low, high = min(one - a.bound, other - b.bound), max(one + a.bound, other + b.bound)
        return low - slack * WIDEN, high + slack * WIDEN

    def enters(self, j: int, which: int) -> bool:
        """Whether the line, followed ahead, passes from free to blocked at a crossing."""
        kind = self.around.images[self.near.edges[j]].kind
        if kind == STRAIGHT:
            return which == 1
        return (which == 1) == (kind == CONCAVE)

    def _line(self, j: int) -> EdgeLine:
        line = self.lines[j]
        if line is None:
            spots = self.around.spots
            line = self.lines[j] = EdgeLine(spots[j], spots[self.near.last[j]])
        return line

    def _look_at_arc(self, j: int, line: FrameLine) -> int:
        around = self.around
        h, h_bound, half, half_bound, known = self._chord(j, line)
        if known < 0:
            return 0
        if known == 0:
            return VAGUE
        state = 0
        edge = self.near.edges[j]
        kind = around.images[edge].kind
        for sign in (1, -1):
            if around.place[j] == THROUGH:
                # The line meets the circle in the contact and at twice the foot of the centre.
                ahead = verdict(h, h_bound)
                if ahead == 0:
                    return VAGUE
                if ahead != sign:
                    continue
            if around.images[edge].full:
                state += 1 if sign > 0 else 2
                continue
            # A convex arc lies to the right of its chord.
            place, bound = _on_chord(h, h_bound, half, half_bound, sign, line)
            m, e = self._off_chord(j, line, place, bound)
            bulge = -kind * verdict(m, e)
            if bulge == 0:
                return VAGUE
            if bulge > 0:
                state += 1 if sign > 0 else 2
        return state

    def _off_chord(self, j: int, line: FrameLine, place: float, bound: float) -> tuple[float, float]:
        """On which side of an arc's chord a place on a line lies."""
        chord, a = self._line(j), self.around.spots[j]
        px, px_bound = product(place, bound, line.dx, line.direction_bound)
        py, py_bound = product(place, bound, line.dy, line.direction_bound)
        ox, oy = line.cx - a.x, line.cy - a.y
        x, y = ox + px, oy + py
        rounding = UNIT * (abs(ox) + abs(oy) + abs(x) + abs(y))
        e = (line.contact_bound + a.bound + px_bound + py_bound + rounding) * WIDEN
        return cross(chord.x, chord.y, chord.bound, x, y, e)

    def _chord(self, j: int, line: FrameLine) -> tuple[float, float, float, float, int]:
        """Of a line and a circle: the centre's place and half the chord, both times the direction's length.

        With their bounds; and whether the line crosses the circle (1, -1 or 0). A line through the contact,
        where the circle passes too, has the chord from there to twice the foot of the centre.
        """
        around = self.around
        center = around.centers[self.near.middle[j]]
        x, y, p, size = center.x, center.y, center.bound, center.size
        common = p * line.for_bound + size * line.for_size
        h, h_bound = line.dx * x + line.dy * y - line.dot, common + line.dot_bound
        if around.place[j] == THROUGH:
            return h, h_bound, abs(h), h_bound, 1
        g, g_bound = line.dx * y - line.dy * x - line.cross, common + line.cross_bound
        r, r_bound = around.radius(self.near.edges[j])
        reach, reach_bound = product(r, r_bound, line.length, line.length_bound)
        plus, plus_bound = total(reach, reach_bound, g, g_bound)
        minus, minus_bound = total(reach, reach_bound, -g, g_bound)
        under, under_bound = product(plus, plus_bound, minus, minus_bound)
        half, half_bound = root(under, under_bound)
        return h, h_bound, half, half_bound, verdict(under, under_bound)


def side(spot: FramePoint, line: FrameLine) -> int:
    """On which side of a line a point certainly lies, 1 for the left; 0 where that is open."""
    m = line.dx * spot.y - line.dy * spot.x - line.cross
    e = spot.bound * line.for_bound + spot.size * line.for_size + line.cross_bound
    return 1 if m > e else -1 if -m > e else 0


def between(first: int, last: int) -> int:
    """The state of a segment by the sides of its ends."""
    if first == 0 or last == 0:
        return VAGUE
    return 0 if first == last else 1 if first > 0 else 2


def _on_chord(
    h: float, h_bound: float, half: float, half_bound: float, sign: int, line: FrameLine
) -> tuple[float, float]:
    """Where on a line one end of a chord is, in multiples of the direction."""
    square, bound = product(line.length, line.length_bound, line.length, line.length_bound)
    top, top_bound = total(h, h_bound, sign * half, half_bound)
    return quotient(top, top_bound, square, bound)
