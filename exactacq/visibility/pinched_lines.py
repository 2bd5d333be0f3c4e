"""Pinched lines: free lines that touch three or more obstacles, not all on the same side.

What a line shows is also shown by the closed cells of the tangent lines beside it, unless it is pinched or
runs along an edge. If all it touches lies to its left, it may turn about any of them such that those behind
stay clear, or those ahead. If it touches only two, on two sides, it may turn about either and clear the
other. With three there is one such that the two others are in the way of both turns, or of the one that
clears either: from beyond these it is seen along the line itself only. The same holds for three on one side
if one of them is an arc: the robot sees the others from one point of it, which is no end of an edge.
"""

from __future__ import annotations

from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import Feature, leaving
from exactacq.visibility.line_families import Sector
from exactacq.visibility.rotational_sweep import Passed

BITS = 128
"""Precision of the balls that tell sides; where they do not, a line counts as pinched."""


def may_be_pinched(table: EdgeTable, feature: Feature, sector: Sector, t: Real, passed: Passed) -> bool:
    """Whether a tangent line of a feature may show, by what it passes, what no line beside it does."""
    contact, direction = sector.touch(t)
    if feature.round:
        is_arc = not table.full[feature.edges[0]]
        if is_arc and not t.is_late and t.rational in (sector.low, sector.high):
            return True
    elif touched_side(table, feature.edges[1], direction) is None:
        return True
    sides, is_round = [1], feature.round
    for number, touching, _ in passed:
        if touching:
            curve = table.curves[number]
            assert isinstance(curve, Arc), "only arcs are touched between their ends"
            is_round = True
            side: int | None = direction.cross(curve.center - contact).clear_sign(BITS) or None
        else:
            side = touched_side(table, number, direction)
        if side is None:
            return True
        if side:
            sides.append(side)
    return len(sides) > 2 and (is_round or min(sides) < 0)


def touched_side(table: EdgeTable, vertex: int, direction: Point) -> int | None:
    """1 or -1 as a line touches a corner to its left or right, 0 if it enters the obstacle there.

    None if it runs along an edge there, or balls do not tell.
    """
    incoming, outgoing = table.curves[int(table.previous[vertex])], table.curves[vertex]
    before, after = Point(*leaving(incoming, at_end=True)), Point(*leaving(outgoing, at_end=False))
    back, on = -direction.cross(before).clear_sign(BITS), direction.cross(after).clear_sign(BITS)
    if not (back and on):
        return None
    return on if back == on and before.cross(after).sign() > 0 else 0
