"""What a straight edge or a circle hides from some places, in floats with bounds: it need not be looked at.

A segment within an obstacle, such as a boundary edge or a diameter of a disc, blocks every line of sight that
crosses it between its ends. So a point is hidden from a place p by a segment from A to B if it lies beyond
the line A B and strictly between the rays from p through A and B. The places from which a point is hidden so
are a convex set: what is hidden from several places is hidden from all places between them.
"""

from __future__ import annotations

from math import hypot
from typing import Final, cast, final

from mypy_extensions import mypyc_attr

from exactacq.kernel.bounded import UNIT
from exactacq.kernel.box_tree import NUMBER, Box, BoxNode
from exactacq.kernel.images import CONVEX, STRAIGHT, EdgeImage

MOST: Final = 16
"""So many segments are looked at: those that hide most."""

Spot = tuple[float, float]
"""A place in floats."""
Ends = tuple[float, float, float, float]
"""Both ends of a segment."""


@mypyc_attr(acyclic=True)
@final
class HalfPlane:
    """An open half-plane: a place on its rim, and the normal that points into it, of that size."""

    def __init__(self, x: float, y: float, nx: float, ny: float) -> None:
        self.x, self.y, self.nx, self.ny = x, y, nx, ny
        self.size = abs(nx) + abs(ny)


@mypyc_attr(acyclic=True)
@final
class Shadow:
    """What one segment hides: the points that lie in all of some half-planes."""

    def __init__(self, sides: list[HalfPlane]) -> None:
        self._sides = sides

    def hides(self, node: BoxNode, slack: float) -> bool:
        """Whether all of a box certainly lies in the shadow, if all coordinates are held with *slack*.

        A product of an offset o and a normal n, both differences, is off by at most 2 s (|o| + |n|) + 4 s^2
        for the data, | | being the sum of the components' sizes, and its roundings are below 8 UNIT |o| |n|.
        """
        for side in self._sides:
            nx, ny, size = side.nx, side.ny, side.size
            x = (node.x0 if nx > 0.0 else node.x1) - side.x
            y = (node.y0 if ny > 0.0 else node.y1) - side.y
            far = abs(x) + abs(y)
            if not nx * x + ny * y > 2.0 * slack * (far + size + 2.0 * slack) + 8.0 * UNIT * far * size:
                return False
        return True


def shadows(
    images: list[EdgeImage], edges: list[int], places: tuple[Spot, ...], slack: float
) -> list[Shadow]:
    """Of what hides most from the middle of some places the shadows: of straight edges and whole discs."""
    mx = my = 0.0
    for x, y in places:
        mx, my = mx + x / len(places), my + y / len(places)
    # The largest so far, in falling order.
    sizes: list[float] = []
    found: list[Ends] = []
    for e in edges:
        edge = images[e]
        if edge.kind == STRAIGHT:
            following = images[edge.following]
            ends = edge.x, edge.y, following.x, following.y
        elif edge.kind == CONVEX and edge.full:
            ends = _across(edge.cx, edge.cy, edge.radius, mx, my)
        else:
            continue
        ax, ay, bx, by = ends[0] - mx, ends[1] - my, ends[2] - mx, ends[3] - my
        below = hypot(ax, ay) * hypot(bx, by)
        if below > 0.0:
            # Grows with the angle at which the segment appears, up to a half turn.
            sine, cosine = abs(ax * by - ay * bx) / below, (ax * bx + ay * by) / below
            size = sine if cosine > 0.0 else 2.0 - sine
            if len(sizes) == MOST:
                if size <= sizes[MOST - 1]:
                    continue
                sizes.pop()
                found.pop()
            at = len(sizes)
            while at > 0 and sizes[at - 1] < size:
                at -= 1
            sizes.insert(at, size)
            found.insert(at, ends)
    made: list[Shadow] = []
    for ends in found:
        sides = _sides(places, ends, slack)
        if sides:
            made.append(Shadow(sides))
    return made


def lit(tree: BoxNode, window: Box, reach: float, hiding: list[Shadow], slack: float) -> list[int]:
    """The numbers of the boxes at most as far as *reach* from a window that no shadow contains, ascending."""
    runs: list[BoxNode] = []
    _search(tree, window, reach * reach, hiding, slack, runs)
    runs.sort(key=NUMBER)
    found: list[object] = []
    for run in runs:
        for box in run.group or [run]:
            if _is_lit(box, window, reach * reach, hiding, slack):
                found.append(box.label)
    return cast(list[int], found)


def _search(
    around: BoxNode, window: Box, square: float, hiding: list[Shadow], slack: float, runs: list[BoxNode]
) -> None:
    for node in around.group:
        if not _is_lit(node, window, square, hiding, slack):
            continue
        if node.number >= 0:
            runs.append(node)
        else:
            _search(node, window, square, hiding, slack, runs)


def _is_lit(node: BoxNode, window: Box, square: float, hiding: list[Shadow], slack: float) -> bool:
    """Whether a box comes near the window, and no shadow contains it."""
    x0, y0, x1, y1 = window
    if node.square_from(x0, y0, x1, y1) > square:
        return False
    for shadow in hiding:  # noqa: SIM110  # A generator is slow when it is compiled.
        if shadow.hides(node, slack):
            return False
    return True


def _across(cx: float, cy: float, radius: float, x: float, y: float) -> Ends:
    """The ends of the diameter of a disc that is seen broadside from a place; a little within."""
    dx, dy = cx - x, cy - y
    far = hypot(dx, dy)
    if not far > radius:
        return cx, cy, cx, cy
    part = radius * (1.0 - 1e-9) / far
    return cx - dy * part, cy + dx * part, cx + dy * part, cy - dx * part


def _sides(places: tuple[Spot, ...], ends: Ends, slack: float) -> list[HalfPlane]:
    """The half-planes of a segment's shadow from some places; none if it may have some on both sides."""
    ax, ay, bx, by = ends
    px, py = places[0]
    if (ax - px) * (by - py) - (ay - py) * (bx - px) < 0.0:
        ax, ay, bx, by = bx, by, ax, ay
    sides = [HalfPlane(ax, ay, by - ay, ax - bx)]
    size = abs(bx - ax) + abs(by - ay)
    for x, y in places:
        ux, uy, vx, vy = ax - x, ay - y, bx - x, by - y
        far = abs(ux) + abs(uy)
        # Before the line: the place itself is beyond if it is turned around.
        before = (bx - ax) * -uy + (by - ay) * ux
        if not before > 2.0 * slack * (far + size + 2.0 * slack) + 8.0 * UNIT * far * size:
            return []
        sides.append(HalfPlane(x, y, -uy, ux))
        sides.append(HalfPlane(x, y, vy, -vx))
    return sides
