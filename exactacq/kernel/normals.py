"""Which normals may tell something that tangents and the views from the ends of a piece of the path do not.

*Of obstacles*: from where one is in sight. Let all of an obstacle be within the range of a place outside of
the box around it. If something of the obstacle is in sight, the views of it are bounded to both sides, for it
is not all around the place. A view that bounds them touches a corner or an arc, of the obstacle or of what
hides the rest of it: it belongs to a tangent, which tells what the normals would. (To one side it may run
along the straight edge on which the place is, but not to both.) So normals matter only from places where
something of their obstacle is out of range, or that are in the box around it. Those of a straight edge go
through the strip before it, those at a corner of two straight edges through the wedge between two strips.

*Of the path*: what is shown. A point is seen from intervals of a straight piece. Where one of them ends, the
view touches something, or the piece ends, or the view is as long as the range. If each interval ends in the
last way on both sides, only normals show the point: it lies straight beside the piece, no farther away than
the range, and both ends of the piece are out of its range.

When the last gap of an edge closes is not asked here: `sensing/acquisition` looks where the ends of gaps, and
arcs as wholes, come into range.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Final, final

from exactacq.kernel.bounded import TINY, UNIT
from exactacq.kernel.box_tree import Box
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.shadows import Spot

Span = tuple[float, float]
"""Bounds of a number."""
SLACK: Final = 64.0 * UNIT
"""A bound of errors, relative to the size m of all coordinates. These are off by m UNIT / 2, differences of
two of them by 2 m UNIT, products of such differences with a vector w by 8 m UNIT (|w_x| + |w_y|). Where a
half-plane cuts a segment its value is off by twice as much as at the ends, and the place by 16 m UNIT."""


@final
class Front:
    """An edge, the one before it, and the box around their obstacle: the plane if not all of it counts."""

    def __init__(self, edge: CurveImage, before: CurveImage, owner: int, around: Box) -> None:
        self.edge, self.before, self.owner = edge, before, owner
        self.left, self.bottom, self.right, self.top = around
        self.is_whole = self.right < inf
        self.is_straight = edge.sense == 0 and before.sense == 0
        self.size = max(_largest(edge.x, edge.y, edge.wx, edge.wy), abs(before.wx) + abs(before.wy))
        if self.is_whole:
            self.size = max(self.size, _largest(self.left, self.bottom, self.right, self.top))


@final
class SegmentPart:
    """What half-planes leave of a segment from (ax, ay) to (bx, by)."""

    def __init__(self, ax: float, ay: float, bx: float, by: float) -> None:
        self.ax, self.ay, self.bx, self.by = ax, ay, bx, by
        self.low, self.high = 0.0, 1.0

    def cut(self, x: float, y: float, nx: float, ny: float, error: float) -> None:
        """Leave what may be in the half-plane from (x, y) on into the direction of (nx, ny)."""
        a = (self.ax - x) * nx + (self.ay - y) * ny
        b = (self.bx - x) * nx + (self.by - y) * ny
        if a < -error:
            self.low = max(self.low, (a + error) / (a - b)) if b > -error else inf
        elif b < -error:
            self.high = min(self.high, (a + error) / (a - b))

    def may_tell(self, front: Front, ex: float, ey: float, reach: Span, slack: float) -> bool:
        """Whether from what is left something of a front's obstacle may be out of range, but not what of its
        edge lies between the start and (ex, ey)."""
        if self.low > self.high:
            return False
        dx, dy, edge = self.bx - self.ax, self.by - self.ay, front.edge
        x0, y0 = self.ax + self.low * dx, self.ay + self.low * dy
        x1, y1 = self.ax + self.high * dx, self.ay + self.high * dy
        gap_x = max(_gap(min(x0, x1), max(x0, x1), min(edge.x, ex), max(edge.x, ex)), 0.0)
        gap_y = max(_gap(min(y0, y1), max(y0, y1), min(edge.y, ey), max(edge.y, ey)), 0.0)
        if gap_x * gap_x + gap_y * gap_y > (reach[1] + slack) ** 2:
            return False
        return not is_near(front, x0, y0, x1, y1, reach[0], slack)


@final
class Beside:
    """The places that only normals of a straight piece of the path show, to both sides of it.

    Of a piece of length L they are at heights from the root of R^2 - L^2 / 4 to R: there both its ends are
    out of range.
    """

    def __init__(self, begin: Spot, end: Spot, reach: Span) -> None:
        self.ax, self.ay = begin
        self.bx, self.by = end
        self.dx, self.dy = self.bx - self.ax, self.by - self.ay
        self.length = sqrt(self.dx * self.dx + self.dy * self.dy)
        self.size = _largest(self.ax, self.ay, self.bx, self.by)
        self.reach = reach

    def may_meet(self, front: Front) -> bool:
        """Whether there may be something of an edge."""
        size, edge = max(self.size, front.size), front.edge
        if self.length <= SLACK * size:
            return True
        # The direction is off by 3 m UNIT / L, so that feet and heights are by 16 m UNIT (1 + m / L) at most.
        slack = SLACK * size * (1.0 + size / self.length)
        half, least = 0.5 * (self.length + slack), self.reach[0] - slack
        low, high = sqrt(max((least - half) * (least + half), 0.0)) - slack, self.reach[1] + slack
        if edge.sense:
            around, height = edge.radius + slack, abs(self._height(edge.x, edge.y))
            is_beside = -around <= self._foot(edge.x, edge.y) <= self.length + around
            return is_beside and low - around <= height <= high + around
        part = SegmentPart(edge.x, edge.y, edge.x + edge.wx, edge.y + edge.wy)
        part.cut(self.ax, self.ay, self.dx, self.dy, slack * self.length)
        part.cut(self.bx, self.by, -self.dx, -self.dy, slack * self.length)
        if part.low > part.high:
            return False
        one = self._height(edge.x + part.low * edge.wx, edge.y + part.low * edge.wy)
        other = self._height(edge.x + part.high * edge.wx, edge.y + part.high * edge.wy)
        return (max(one, other) >= low and min(one, other) <= high) or (
            min(one, other) <= -low and max(one, other) >= -high
        )

    def _foot(self, x: float, y: float) -> float:
        """How far along the piece a place lies."""
        return ((x - self.ax) * self.dx + (y - self.ay) * self.dy) / self.length

    def _height(self, x: float, y: float) -> float:
        """How far to the right of the piece's line it lies."""
        return ((x - self.ax) * self.dy - (y - self.ay) * self.dx) / self.length


def telling(
    fronts: list[Front], edges: list[int], places: tuple[Spot, ...], edge: int, reach: Span
) -> tuple[list[int], list[int]]:
    """Those of some edges whose normals may tell of an obstacle, and those with such normals at the corner
    where they start.

    The robot is somewhere between *places*: on *edge*, or on the segment from one place to another if that is
    -1. Of *edge* itself these are normals of the path. *reach* has bounds of the range.
    """
    own = fronts[edge].owner if edge >= 0 else -1
    is_shown = edge >= 0 and (
        len(places) > 2 or shows_along_normals(fronts, [e for e in edges if e != edge], places, reach)
    )
    left, bottom, right, top = _around(places)
    ax, ay = places[0]
    bx, by = places[len(places) - 1]
    size = _largest(left, bottom, right, top)
    along: list[int] = []
    corners: list[int] = []
    for e in edges:
        front = fronts[e]
        slack = SLACK * max(size, front.size)
        # The obstacle on whose boundary the robot walks is in sight all along.
        is_told = front.is_whole and front.owner == own
        if e == edge and is_shown:
            along.append(e)
        if is_told or is_near(front, left, bottom, right, top, reach[0], slack):
            continue
        is_open = not (front.is_straight and len(places) == 2)
        if e != edge and (is_open or _faces_edge(front, SegmentPart(ax, ay, bx, by), reach, slack)):
            along.append(e)
        if is_open or _faces_corner(front, SegmentPart(ax, ay, bx, by), reach, slack):
            corners.append(e)
    return along, corners


def shows_along_normals(fronts: list[Front], edges: list[int], places: tuple[Spot, ...], reach: Span) -> bool:
    """Whether of some edges there may be something that only normals of a straight piece of the path show."""
    beside = Beside(places[0], places[1], reach)
    return any(beside.may_meet(fronts[e]) for e in edges)


def _faces_edge(front: Front, strip: SegmentPart, reach: Span, slack: float) -> bool:
    """Whether normals of a straight edge may tell something on a segment."""
    x, y, wx, wy = front.edge.x, front.edge.y, front.edge.wx, front.edge.wy
    error = slack * (abs(wx) + abs(wy)) + TINY
    # Obstacles lie to the left of their edges.
    strip.cut(x, y, wy, -wx, error)
    strip.cut(x, y, wx, wy, error)
    strip.cut(x + wx, y + wy, -wx, -wy, error)
    return strip.may_tell(front, x + wx, y + wy, reach, slack)


def _faces_corner(front: Front, wedge: SegmentPart, reach: Span, slack: float) -> bool:
    """Whether normals at the corner where an edge starts may; where it turns inward there are none."""
    x, y, wx, wy = front.edge.x, front.edge.y, front.edge.wx, front.edge.wy
    vx, vy = front.before.wx, front.before.wy
    error = slack * max(abs(vx) + abs(vy), abs(wx) + abs(wy)) + TINY
    if vx * wy - vy * wx < -error:
        return False
    wedge.cut(x, y, vx, vy, error)
    wedge.cut(x, y, -wx, -wy, error)
    return wedge.may_tell(front, x, y, reach, slack)


def _around(places: tuple[Spot, ...]) -> Box:
    """The box around some places."""
    x0, y0 = places[0]
    x1, y1 = x0, y0
    for x, y in places:
        x0, x1 = min(x0, x), max(x1, x)
        y0, y1 = min(y0, y), max(y1, y)
    return x0, y0, x1, y1


def is_near(front: Front, ax: float, ay: float, bx: float, by: float, reach: float, slack: float) -> bool:
    """Whether surely all of an obstacle is within reach of all places of a box, and these are outside of the
    box around the obstacle. Two opposite corners of the box are given."""
    left, right = (ax, bx) if ax < bx else (bx, ax)
    bottom, top = (ay, by) if ay < by else (by, ay)
    gap = max(_gap(left, right, front.left, front.right), _gap(bottom, top, front.bottom, front.top))
    dx, dy = max(front.right - left, right - front.left), max(front.top - bottom, top - front.bottom)
    room = reach - slack
    return gap > slack and room > 0.0 and dx * dx + dy * dy < room * room


def _gap(a: float, b: float, c: float, d: float) -> float:
    """How far two intervals are apart; negative if they have something in common."""
    return max(a - d, c - b)


def _largest(a: float, b: float, c: float, d: float) -> float:
    """The largest size of four numbers."""
    one, other = max(abs(a), abs(b)), max(abs(c), abs(d))
    return max(one, other)
