"""Which line families cross a straight way through free space, and what they show from it."""

from __future__ import annotations

from math import inf, sqrt
from typing import Final, final

from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import SURE, Extent, Span, bent, extent, unknown
from exactacq.kernel.family_images import AHEAD, BEHIND, CONTACT, EdgePlace, EdgePlaces, FamilyImage
from exactacq.kernel.images import ROLLING, SPOKES
from exactacq.kernel.lines import Line, Meeting, line_at, meets, meets_straight

STEPS: Final = 24
"""How often an interval of lines is halved to find one that crosses the way."""

NOT_MET: EdgePlaces = ((0.0, 0.0, 0.0, 0.0, inf), (0.0, 0.0, 0.0, 0.0, inf))

Crossing = tuple[int, bool]
"""The number of a family that may cross the way, and whether all its lines do."""


@final
class WayImage:
    """A way: a stretch of a segment's line, from parameter ``low`` to ``high``, each with bounds.

    Its ends are given with an error each; the vertices there by their numbers. ``slack`` bounds how far
    round-off may move any place of the scene.
    """

    def __init__(
        self,
        line: CurveImage,
        low: Span,
        high: Span,
        ends: tuple[float, float, float, float, float],
        starts: list[int],
        stops: list[int],
        slack: float,
    ) -> None:
        self.line, self.low, self.high = line, low, high
        self.ends, self.starts, self.stops, self.slack = ends, starts, stops, slack


def crossings(families: list[FamilyImage], way: WayImage) -> list[Crossing]:
    """The families that do not leave the whole way on one side."""
    ax, ay, bx, by, error = way.ends
    found: list[Crossing] = []
    for k in range(len(families)):
        one = families[k].side(ax, ay, error)
        other = families[k].side(bx, by, error)
        if one == 0 or one != other:
            found.append((k, one != 0 and other != 0))
    return found


def extents_from_way(
    families: list[FamilyImage],
    found: list[Crossing],
    wanted: set[int],
    way: WayImage,
    curves: list[CurveImage],
    reach: tuple[float, float],
) -> list[Extent]:
    """What the families that were found show of wanted edges from a way; origins are places in *found*."""
    extents: list[Extent] = []
    for n in range(len(found)):
        family = families[found[n][0]]
        if family.corner >= 0 and (family.corner in way.starts or family.corner in way.stops):
            # All lines pass an end of the way and meet its line nowhere else: the view from there tells.
            continue
        roles = [role for role in (BEHIND, CONTACT, AHEAD) if family.edge(role) in wanted]
        if not roles:
            continue
        open_, role, spots = _source(family, way, curves) if family.is_known else (True, CONTACT, NOT_MET)
        for there in roles:
            edge = family.edge(there)
            if open_:
                extents.append(unknown(edge, n, CONTACT, there))
            elif role != CONTACT and there != role:
                shown = family.places(there)
                slack = bent(family, there, shown, curves) + 2.0 * (spots[0][4] + spots[1][4])
                one = extent(edge, spots, shown, slack, family, True, reach, n, role, there)
                if one is not None:
                    extents.append(one)
    return extents


def _source(family: FamilyImage, way: WayImage, curves: list[CurveImage]) -> tuple[bool, int, EdgePlaces]:
    """Whether floats leave open how a family crosses the way's line; where its first and last line do.

    And on which side of their contact; on none (0) if a wall is before it. Open unless the crossing moves
    one way from the first line to the last: it does if no line between is parallel to the way and the contact
    stays on one side of it.
    """
    one, other = family.first, family.last
    wx, wy = way.line.wx, way.line.wy
    a, b = meets_straight(one, way.line), meets_straight(other, way.line)
    if not (a[3] < inf and b[3] < inf) or (wx * one[3] - wy * one[2] > 0) != (
        wx * other[3] - wy * other[2] > 0
    ):
        return True, CONTACT, NOT_MET
    if a[0] > a[1] and b[0] > b[1]:
        role = AHEAD
    elif -a[0] > a[1] and -b[0] > b[1]:
        role = BEHIND
    else:
        return True, CONTACT, NOT_MET
    kind, cx, cy, ex, ey, radius, sense = family.frame
    if kind in (ROLLING, SPOKES):
        if kind == ROLLING:
            radius = sqrt(ex * ex + ey * ey)
        height = abs((cx - way.line.x) * wy - (cy - way.line.y) * wx) / sqrt(wx * wx + wy * wy)
        if sense < 0 or height < radius * (1.0 + SURE) + way.slack:
            return True, CONTACT, NOT_MET
    spots = (_spot(a, family.first_corners, way), _spot(b, family.last_corners, way))
    wall = family.edge(role)
    if wall < 0:
        return False, role if family.goes_back or role == AHEAD else CONTACT, spots
    if max(spots[0][1], spots[1][1]) < way.low[0] or min(spots[0][0], spots[1][0]) > way.high[1]:
        return False, CONTACT, spots
    before = _is_before(family, way, a[2], b[2], role, curves[wall])
    if before == 0:
        return True, CONTACT, NOT_MET
    return False, role if before > 0 else CONTACT, spots


def _is_before(
    family: FamilyImage, way: WayImage, first: float, last: float, role: int, wall: CurveImage
) -> int:
    """1 or -1 as lines of a family that cross the way do so before they meet a wall or not; 0 if open.

    The way does not cross the wall, so one line tells: it is looked for between the first and the last,
    which cross the way's line at *first* and *last*.
    """
    low, high = family.low, family.high
    middle = (way.low[0] + way.high[1]) / 2.0
    for _ in range(STEPS):
        t = (low + high) / 2.0
        line: Line = line_at(family.frame, t, 0.0)
        crossed: Meeting = meets_straight(line, way.line)
        far: Meeting = meets(line, wall, role)
        u, error = crossed[2], crossed[3]
        if way.low[1] < u - error and u + error < way.high[0] and far[1] < inf:
            gap, bound = (far[0] - crossed[0]) * role, far[1] + crossed[1]
            return 1 if gap > bound else -1 if -gap > bound else 0
        if (u < middle) == (first < last):
            low = t
        else:
            high = t
    return 0


def _spot(met: Meeting, passed: list[int], way: WayImage) -> EdgePlace:
    """Where a line crosses the way's line: at an infinite parameter if it passes an end of the way."""
    _, _, u, error, x, y, e = met
    for vertex in passed:
        if vertex in way.starts:
            return -inf, -inf, x, y, e
        if vertex in way.stops:
            return inf, inf, x, y, e
    return u - error, u + error, x, y, e
