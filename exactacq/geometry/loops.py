"""The area of a closed chain of curves, and where a point lies with respect to it.

Every decision is a sign of a polynomial in the coordinates, as in `exactacq.geometry.intersections`, whose
preconditions are these too.
"""

from __future__ import annotations

from collections.abc import Sequence

from exactacq.geometry.coordinates import Vector, compare, cross, dot, minus, raw, sign
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Location, Point
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real


def signed_area(edges: Sequence[Curve]) -> Length:
    """The area that a closed chain encloses, positive if it runs counterclockwise.

    Half the shoelace sum, plus (r^2 / 2)(theta - sin theta) for each counterclockwise arc, minus it for each
    clockwise one.
    """
    shoelace = Real.sum(edge.start.cross(edge.end) for edge in edges)
    caps = []
    for edge in edges:
        if isinstance(edge, Arc):
            half = edge.radius_sq / 2 if edge.ccw else -edge.radius_sq / 2
            if edge.full:
                caps.append(Length.turns(Real(half)))
            else:
                cosine, sine = edge.turn
                caps.append(Length.arc(Real(half), cosine, sine) - Length(sine * half))
    return Length.sum([Length(shoelace / 2), *caps])


def winding(edges: Sequence[Curve], point: Point) -> int | None:
    """How often a closed chain winds round a point, counterclockwise; None if the point is on the chain.

    Crossings of the ray to the east are counted as seen from the point moved by (e^2, e), e infinitesimal,
    so vertices, horizontal edges and tangencies on the ray need no care. An arc counts as its chord, plus one
    turn if the point lies between chord and arc. No square roots; linear in the edges.
    """
    p = raw(point)
    turns = 0
    for edge in edges:
        if isinstance(edge, Arc) and edge.full:
            side = _circle_side(edge, p)
            if side == 0:
                return None
            turns += (1 if edge.ccw else -1) if side < 0 else 0
            continue
        start, end = minus(raw(edge.start), p), minus(raw(edge.end), p)
        from_height, to_height = sign(start[1]), sign(end[1])
        if isinstance(edge, Segment) and from_height * to_height > 0:
            continue
        side = sign(cross(start, end))
        if side == 0:
            if _meets_origin(edge, start, end):
                return None
            chord = minus(end, start)
            side = sign(chord[0]) or -sign(chord[1])
        rise = int(to_height > 0) - int(from_height > 0)
        turns += rise if rise == side else 0
        if isinstance(edge, Arc) and side == (-1 if edge.ccw else 1):
            inside = _circle_side(edge, p)
            if inside == 0:
                return None
            turns -= side if inside < 0 else 0
    return turns


def _circle_side(arc: Arc, point: Vector) -> int:
    """-1, 0 or 1 as the point is inside, on or outside the supporting circle."""
    w = minus(point, raw(arc.center))
    return sign(dot(w, w) - arc.radius_sq)


def _meets_origin(edge: Curve, start: Vector, end: Vector) -> bool:
    """Whether the origin, on the line through start and end, lies on the segment, or is an end of the arc."""
    if isinstance(edge, Segment):
        return sign(dot(start, end)) <= 0
    return compare(start, (0, 0)) == 0 or compare(end, (0, 0)) == 0


def locate(edges: Sequence[Curve], point: Point, ccw: bool | None = None) -> Location:
    """Where a point lies with respect to a simple loop whose blocked side is on the left.

    INSIDE is strictly on the blocked side: within a counterclockwise loop, outside a clockwise one. *ccw*
    is the loop's sense if the caller knows it; otherwise a point that the loop does not wind round costs the
    sign of the loop's area.
    """
    turns = winding(edges, point)
    if turns is None:
        return Location.BOUNDARY
    if turns:
        return Location.INSIDE if turns > 0 else Location.OUTSIDE
    if ccw is None:
        ccw = signed_area(edges).sign() > 0
    return Location.OUTSIDE if ccw else Location.INSIDE
