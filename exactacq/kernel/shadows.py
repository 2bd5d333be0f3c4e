"""What a straight edge or a circle hides from some places, in floats with bounds: it need not be looked at.

A segment within an obstacle, such as a boundary edge or a diameter of a disc, blocks every line of sight that
crosses it between its ends. So a point is hidden from a place p by a segment from A to B if it lies beyond
the line A B and strictly between the rays from p through A and B. The places from which a point is hidden so
are a convex set: what is hidden from several places is hidden from all places between them.
"""

from __future__ import annotations

from math import hypot
from typing import Final, cast, final

from exactacq.kernel.bounded import UNIT
from exactacq.kernel.box_tree import NUMBER, Box, BoxNode
from exactacq.kernel.images import CONVEX, STRAIGHT, EdgeImage

DIRECTIONS: Final = 256
"""So many directions divide a full turn."""
MOST: Final = 4
"""So many segments are kept in each direction: those that hide most."""

Spot = tuple[float, float]
"""A place in floats."""


@final
class HalfPlane:
    """An open half-plane: a place on its rim, and the normal that points into it, of that size."""

    def __init__(self, x: float, y: float, nx: float, ny: float) -> None:
        self.x, self.y, self.nx, self.ny = x, y, nx, ny
        self.size = abs(nx) + abs(ny)


@final
class Shadow:
    """What one segment hides: the points that lie in all of some half-planes.

    ``size`` grows with the angle at which the segment appears.
    """

    def __init__(self, ax: float, ay: float, bx: float, by: float, size: float) -> None:
        self.ax, self.ay, self.bx, self.by, self.size = ax, ay, bx, by, size
        self.sides: list[HalfPlane] = []

    def hides(self, node: BoxNode, slack: float) -> bool:
        """Whether all of a box certainly lies in the shadow, if all coordinates are held with *slack*.

        A product of an offset o and a normal n, both differences, is off by at most 2 s (|o| + |n|) + 4 s^2
        for the data, | | being the sum of the components' sizes, and its roundings are below 8 UNIT |o| |n|.
        """
        for side in self.sides:
            nx, ny, size = side.nx, side.ny, side.size
            x = (node.x0 if nx > 0.0 else node.x1) - side.x
            y = (node.y0 if ny > 0.0 else node.y1) - side.y
            far = abs(x) + abs(y)
            if not nx * x + ny * y > 2.0 * slack * (far + size + 2.0 * slack) + 8.0 * UNIT * far * size:
                return False
        return True


@final
class Shadows:
    """What straight edges and whole discs hide from some places.

    In each direction from the middle of the places those segments are kept that appear largest: a box is
    looked for in the shadows of its own direction.
    """

    def __init__(
        self, images: list[EdgeImage], edges: list[int], places: tuple[Spot, ...], slack: float
    ) -> None:
        self._places, self._slack = places, slack
        mx = my = 0.0
        for x, y in places:
            mx, my = mx + x / len(places), my + y / len(places)
        self._x, self._y = mx, my
        self._rows: list[list[Shadow]] = [[] for _ in range(DIRECTIONS)]
        for e in edges:
            edge = images[e]
            if edge.kind == STRAIGHT:
                following = images[edge.following]
                self._add(edge.x, edge.y, following.x, following.y)
            elif edge.kind == CONVEX and edge.full:
                # The diameter that is seen broadside; a little within.
                dx, dy = edge.cx - mx, edge.cy - my
                far = hypot(dx, dy)
                if far > edge.radius:
                    part = edge.radius * (1.0 - 1e-9) / far
                    x, y = -dy * part, dx * part
                    self._add(edge.cx + x, edge.cy + y, edge.cx - x, edge.cy - y)

    def hide(self, node: BoxNode) -> bool:
        """Whether one segment certainly hides all of a box."""
        at = _direction((node.x0 + node.x1) / 2.0 - self._x, (node.y0 + node.y1) / 2.0 - self._y)
        for shadow in self._rows[int(at) % DIRECTIONS]:  # noqa: SIM110  # A generator is slow when compiled.
            if shadow.hides(node, self._slack):
                return True
        return False

    def _add(self, ax: float, ay: float, bx: float, by: float) -> None:
        """Keep a segment in the directions in which it is among the largest."""
        ux, uy, vx, vy = ax - self._x, ay - self._y, bx - self._x, by - self._y
        sine, cosine = ux * vy - uy * vx, ux * vx + uy * vy
        if sine < 0.0:
            ax, ay, bx, by = bx, by, ax, ay
            ux, uy, vx, vy, sine = vx, vy, ux, uy, -sine
        first, last = _direction(ux, uy), _direction(vx, vy)
        if first - last > DIRECTIONS / 2.0:
            # Beyond the east: opposite directions differ by half of all.
            last += DIRECTIONS
        # Directions are looked for by their middles.
        low, high = int(first + 0.5), int(last + 0.5)
        below = hypot(ux, uy) * hypot(vx, vy) if low < high else 0.0
        if not below > 0.0:
            return
        # Grows with the angle, up to a half turn.
        part = sine / below
        shadow = Shadow(ax, ay, bx, by, part if cosine > 0.0 else 2.0 - part)
        for k in range(low, high):
            row = self._rows[k % DIRECTIONS]
            if len(row) == MOST and shadow.size <= row[MOST - 1].size:
                continue
            if not shadow.sides:
                shadow.sides = _sides(self._places, shadow, self._slack)
                if not shadow.sides:
                    return
            at = len(row)
            if at == MOST:
                row.pop()
                at -= 1
            while at > 0 and row[at - 1].size < shadow.size:
                at -= 1
            row.insert(at, shadow)


def lit(tree: BoxNode, window: Box, reach: float, hiding: Shadows) -> list[int]:
    """The numbers of the boxes at most as far as *reach* from a window that no shadow contains, ascending."""
    runs: list[BoxNode] = []
    _search(tree, window, reach * reach, hiding, runs)
    runs.sort(key=NUMBER)
    found: list[object] = []
    for run in runs:
        for box in run.group or [run]:
            if _is_lit(box, window, reach * reach, hiding):
                found.append(box.label)
    return cast(list[int], found)


def _search(around: BoxNode, window: Box, square: float, hiding: Shadows, runs: list[BoxNode]) -> None:
    for node in around.group:
        if not _is_lit(node, window, square, hiding):
            continue
        if node.number >= 0:
            runs.append(node)
        else:
            _search(node, window, square, hiding, runs)


def _is_lit(node: BoxNode, window: Box, square: float, hiding: Shadows) -> bool:
    """Whether a box comes near the window, and no shadow contains it."""
    x0, y0, x1, y1 = window
    return node.square_from(x0, y0, x1, y1) <= square and not hiding.hide(node)


def _direction(x: float, y: float) -> float:
    """How far from the east a vector is turned, counterclockwise, in numbers of directions; 0 for none.

    The sum of both components stands for the length: so directions are not all of one width.
    """
    size = abs(x) + abs(y)
    if not size > 0.0:
        return 0.0
    turn = y / size
    if x < 0.0:
        turn = 2.0 - turn
    elif turn < 0.0:
        turn += 4.0
    return turn * (DIRECTIONS / 4.0)


def _sides(places: tuple[Spot, ...], shadow: Shadow, slack: float) -> list[HalfPlane]:
    """The half-planes of a segment's shadow from some places; none if it may have some on both sides.

    From the middle of the places the segment turns to the left.
    """
    ax, ay, bx, by = shadow.ax, shadow.ay, shadow.bx, shadow.by
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
