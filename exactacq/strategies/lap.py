"""A walk all around a boundary, which may be interrupted."""

from __future__ import annotations

from collections import deque

from exactacq.geometry.curves import Curve
from exactacq.geometry.points import Point
from exactacq.scene.boundary_walk import Boundary


class Lap:
    """What is left of a walk all around a closed boundary from a place of it back to there.

    *forward* has the obstacle on the left. The pieces in ``rest`` end at vertices or where the walk began.
    """

    def __init__(self, boundary: Boundary, place: Point, forward: bool) -> None:
        self.forward = forward
        loop = boundary.loop(place)
        self.rest = deque(loop if forward else [curve.reversed() for curve in reversed(loop)])

    def next(self, target: Point | None) -> tuple[bool, Curve]:
        """What is walked next, and whether that ends at a target, which is not where it begins."""
        curve = self.rest[0]
        if target is None or not curve.passes(target):
            return False, curve
        return True, curve if curve.end == target else curve.part(curve.start, target)

    def walked(self, place: Point) -> None:
        """Take what was walked up to a place off the next piece."""
        curve = self.rest.popleft()
        if place is not curve.end and place != curve.end:
            self.rest.appendleft(curve.part(place, curve.end))
