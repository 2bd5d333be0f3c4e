"""Pinched lines: free lines that touch three or more obstacles, not all on the same side.

What a line shows is also shown by the closed cells of the tangent lines beside it, unless it is pinched or
runs along an edge. If all it touches lies to its left, it may turn about any of them such that those behind
stay clear, or those ahead. If it touches only two, on two sides, it may turn about either and clear the
other. With three there is one such that the two others are in the way of both turns, or of the one that
clears either: from beyond these it is seen along the line itself only. The same holds for three on one side
if one of them is an arc: the robot sees the others from one point of it, which is no end of an edge.

Which lines may be pinched floats tell mostly, and what such a line meets, by the names of what it passes.
"""

from __future__ import annotations

from collections.abc import Collection

from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.kernel.grazing_lines import OPEN, YES
from exactacq.kernel.grazing_lines import may_be_pinched as pinched
from exactacq.kernel.line_walks import WalkedLine
from exactacq.kernel.lines import line_at
from exactacq.numbers.float_bounds import float_ball
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.features import Feature, Joint, corners_of_segments, joint, leaving
from exactacq.visibility.line_families import Sector
from exactacq.visibility.rotational_sweep import Passed

BITS = 128
"""Precision of the balls that tell sides; where they do not, a line counts as pinched."""


def may_be_pinched(table: EdgeTable, feature: Feature, sector: Sector, t: Real, passed: Passed) -> bool:
    """Whether a tangent line of a feature may show, by what it passes, what no line beside it does."""
    if feature.round:
        is_arc = not table.full[feature.edges[0]]
        if is_arc and not t.is_late and t.rational in (sector.low, sector.high):
            return True
    if sector.is_rational:
        line = line_at(sector.image, *float_ball(t))
        own, corners = feature.edges[-1], corners_of_segments(table)
        told = pinched(table.images, corners, line, own, feature.round, [*passed])
        if told != OPEN:
            return told == YES
    return _is_perhaps_pinched(table, feature, sector, t, passed)


def _is_perhaps_pinched(table: EdgeTable, feature: Feature, sector: Sector, t: Real, passed: Passed) -> bool:
    """Whether the exact line may show what no line beside it does; also where balls do not tell."""
    line = TangentLine(table, sector, t)
    if not feature.round and line.touched_side(feature.edges[1]) is None:
        return True
    sides, is_round = [1], feature.round
    for number, touching, _ in passed:
        if touching:
            is_round = True
            side = line.arc_side(number)
        else:
            side = line.touched_side(number)
        if side is None:
            return True
        if side:
            sides.append(side)
    return len(sides) > 2 and (is_round or min(sides) < 0)


def walked(
    table: EdgeTable,
    feature: Feature,
    sector: Sector,
    t: Real,
    passed: Passed,
    reach: float,
    near: Collection[int] | None = None,
) -> WalkedLine | None:
    """What the tangent line of a feature at a parameter of one of its sectors meets, up to what blocks it.

    *passed* is all that it passes of the edges *near* its contact, or of all within *reach*. None where
    floats leave something open: `free_segment.walk_line` tells then. Cost: near linear in the edges whose
    boxes the line meets within reach.
    """
    if not sector.is_rational:
        return None
    line, own = line_at(sector.image, *float_ball(t)), feature.edges[-1]
    vertices = {number for number, side, _ in passed if not side}
    arcs = {number for number, side, _ in passed if side}
    (arcs if feature.round else vertices).add(own)
    walk = WalkedLine(
        table.images,
        table.curve_images,
        [e for e in table.along(line, reach) if near is None or e in near],
        line,
        vertices,
        arcs,
        table.line_numbers.circles,
        own,
        feature.round,
        reach,
    )
    return walk if walk.is_told else None


class TangentLine:
    """A line of a sector: on which sides of it the obstacles lie that it touches, by balls."""

    def __init__(self, table: EdgeTable, sector: Sector, t: Real) -> None:
        self.table = table
        self.contact, self.direction = sector.touch(t)

    def arc_side(self, e: int) -> int | None:
        """1 or -1 as the centre of an arc lies left or right; None if balls do not tell."""
        curve = self.table.curves[e]
        assert isinstance(curve, Arc), "only arcs are touched between their ends"
        return self.direction.cross(curve.center - self.contact).clear_sign(BITS) or None

    def touched_side(self, vertex: int) -> int | None:
        """1 or -1 as the line touches a corner to its left or right, 0 if it enters the obstacle there.

        None if it runs along an edge there, or balls do not tell.
        """
        incoming, outgoing = self.table.curves[self.table.previous[vertex]], self.table.curves[vertex]
        before, after = leaving(incoming, at_end=True), leaving(outgoing, at_end=False)
        back = -self.direction.cross(Point(*before)).clear_sign(BITS)
        on = self.direction.cross(Point(*after)).clear_sign(BITS)
        if not (back and on):
            return None
        is_touched = back == on and joint(incoming, outgoing, before, after) is Joint.CONVEX
        return on if is_touched else 0
