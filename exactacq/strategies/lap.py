"""A walk all around a boundary, which may be interrupted."""

from __future__ import annotations

from collections import deque

from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.intersections import contacts
from exactacq.geometry.points import Point
from exactacq.scene.boundary_walk import Boundary


class Lap:
    """What is left of a walk all around a closed boundary from a place of it back to there.

    *forward* has the obstacle on the left. The pieces in ``rest`` end at vertices or where the walk began.
    """

    def __init__(self, boundary: Boundary, place: Point, forward: bool) -> None:
        self.forward = forward
        # After how many pieces of the path it was interrupted: after more the robot is somewhere else.
        self.after = 0
        loop = boundary.loop(place)
        self.rest = deque(loop if forward else [curve.reversed() for curve in reversed(loop)])

    def next(self, target: Point | Segment | None) -> tuple[bool, Curve]:
        """What is walked next, and whether that ends at a target, which is not where it begins.

        At a segment it ends where it first meets it, unless the walk is over there.
        """
        curve = self.rest[0]
        if isinstance(target, Segment):
            end = _first_met(curve, target)
            if end is not None and len(self.rest) == 1 and curve.end == end:
                end = None
        else:
            end = target if target is not None and curve.passes(target) else None
        if end is None:
            return False, curve
        return True, curve if curve.end == end else curve.part(curve.start, end)

    def walked(self, place: Point, after: int) -> None:
        """Take what was walked up to a place off the next piece; *after* pieces of the path by now."""
        curve = self.rest.popleft()
        if place is not curve.end and place != curve.end:
            self.rest.appendleft(curve.part(place, curve.end))
        self.after = after


def _first_met(curve: Curve, line: Segment) -> Point | None:
    """The first place where a segment meets a curve, not at its start; of what both run along the ends."""
    edge = curve.whole if isinstance(curve, Segment) else curve
    met = (place for contact in contacts(edge, line) for place in contact.places)
    places = [place for place in met if place != curve.start and curve.contains(place)]
    return min(places, key=Rail(curve).parameter, default=None)
