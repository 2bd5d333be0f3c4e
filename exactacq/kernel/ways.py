"""Which line families cross a straight way through free space, and what they show from it."""

from __future__ import annotations

from math import inf
from typing import Final, final

from exactacq.kernel.bounded import TINY, UNIT, cross, dot, length, product, total
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import Extent, Span, extent, unknown, views_in_range
from exactacq.kernel.family_images import AHEAD, BEHIND, CONTACT, EdgePlace, FamilyImage, side_of_all
from exactacq.kernel.images import ROLLING, SLIDING, SPOKES
from exactacq.kernel.lines import Frame, Line, Meeting, line_at, meets, meets_straight, side_of

NEXT: Final = 2.0**-20
"""How far a line is from one next to it, as a part of their family: far more than floats are off."""
STEPS: Final = 24
"""How often an interval of lines is halved to find one that crosses the way."""

OPEN: Final = 2
"""Instead of a role or a part: floats cannot tell."""
NOT_MET: EdgePlace = (0.0, 0.0, 0.0, 0.0, inf)

Crossing = tuple[FamilyImage, bool]
"""A family that may cross the way, and whether all its lines do."""
LineAtEnd = tuple[FamilyImage, bool, bool]
"""A family whose first line, or last one, may pass the way's start, or stop."""


@final
class WayImage:
    """A way: a stretch of a segment's line, from parameter ``low`` to ``high``, each with bounds.

    Its ends are held with one bound; the vertices there are given by their numbers. More may be told of lines
    that pass an end: their keys, and by key and edge which of them touch the edge's circle there.
    """

    def __init__(
        self,
        line: CurveImage,
        low: Span,
        high: Span,
        ends: tuple[float, float, float, float, float],
        starts: list[int],
        stops: list[int],
    ) -> None:
        self.line, self.low, self.high = line, low, high
        self.ends, self.starts, self.stops = ends, starts, stops
        self.lines_at_start: set[int] = set()
        self.lines_at_stop: set[int] = set()
        self.touching: set[tuple[int, int]] = set()

    def end_of(self, corners: list[int], keys: list[int]) -> float:
        """Minus infinity or infinity as a line, which passes vertices and has keys, passes the start or the
        stop; else 0."""
        for vertex in corners:
            if vertex in self.starts:
                return -inf
            if vertex in self.stops:
                return inf
        for key in keys:
            if key in self.lines_at_start:
                return -inf
            if key in self.lines_at_stop:
                return inf
        return 0.0


def crossings(
    families: list[list[FamilyImage]], wanted: set[int], count: int, way: WayImage
) -> list[Crossing]:
    """The families with a *wanted* edge, of *count* ones, that do not leave the whole way on one side."""
    ax, ay, bx, by, error = way.ends
    # One more for `NONE`, which counts from the end.
    is_wanted = [False] * (count + 1)
    for e in wanted:
        is_wanted[e] = True
    found: list[Crossing] = []
    for some in families:
        for family in some:
            behind, contact, ahead = family.edges
            if not (is_wanted[behind] or is_wanted[contact] or is_wanted[ahead]):
                continue
            one = family.side(ax, ay, error)
            other = family.side(bx, by, error)
            if one == 0 or one != other:
                found.append((family, one != 0 and other != 0))
    return found


def lines_at_ends(found: list[Crossing], way: WayImage, at_start: bool, at_stop: bool) -> list[LineAtEnd]:
    """The lines with keys that bound families and may pass the start of a way, if asked *at_start*, or its
    stop.

    Of families all of whose lines cross the way none does.
    """
    ax, ay, bx, by, error = way.ends
    ended: list[LineAtEnd] = []
    for family, certain in found:
        if certain:
            continue
        for is_last in (False, True):
            line, keys = family.first, family.first_keys
            if is_last:
                line, keys = family.last, family.last_keys
            if not keys:
                continue
            if at_start and side_of(line, ax, ay, error, 0.0) == 0:
                ended.append((family, is_last, False))
            if at_stop and side_of(line, bx, by, error, 0.0) == 0:
                ended.append((family, is_last, True))
    return ended


def extents_from_way(
    found: list[Crossing],
    wanted: set[int],
    way: WayImage,
    curves: list[CurveImage],
    reach: tuple[float, float],
) -> list[Extent]:
    """What the families that were found show of wanted edges from a way; origins are places in *found*."""
    extents: list[Extent] = []
    part = way.low[0], way.high[1]
    for n in range(len(found)):
        family = found[n][0]
        if family.corner >= 0 and (family.corner in way.starts or family.corner in way.stops):
            # All lines pass an end of the way and meet its line nowhere else: the view from there tells.
            continue
        roles = [role for role in (BEHIND, CONTACT, AHEAD) if family.edge(role) in wanted]
        crossed = _crossed(family, way, curves) if family.is_known else _unknown()
        for there in roles:
            edge = family.edge(there)
            if not crossed.is_known:
                extents.append(unknown(edge, n, CONTACT, there))
            elif crossed.role != CONTACT and there != crossed.role:
                spots = crossed.first, crossed.last
                sides, places = (crossed.role, there), (spots, family.places(there))
                told = views_in_range(family, sides, places, way.line, curves, reach, part)
                keys = crossed.first_keys, crossed.last_keys
                for shown in family.parts(there):
                    one = extent(edge, spots, shown, told, keys, n, crossed.role, there)
                    if one is not None:
                        extents.append(one)
    return extents


def extents_along_normals(
    families: list[FamilyImage], curves: list[CurveImage], reach: tuple[float, float]
) -> list[Extent]:
    """What families of a way's normals show from it; they are the origins."""
    extents: list[Extent] = []
    for family in families:
        edge = family.edge(AHEAD)
        if not family.is_known:
            extents.append(unknown(edge, family, CONTACT, AHEAD))
            continue
        a, b, c, d = family.fraction
        ax, ay, _, _, p, _ = family.first
        bx, by, _, _, q, _ = family.last
        spots = (a, b, ax, ay, p), (c, d, bx, by, q)
        told = views_in_range(family, (CONTACT, AHEAD), (spots, family.ahead), None, curves, reach)
        one = extent(edge, spots, family.ahead, told, ([], []), family, CONTACT, AHEAD)
        if one is not None:
            extents.append(one)
    return extents


@final
class Crossed:
    """How a family crosses a way: from where to where, and on which side of the contact.

    ``role`` is `CONTACT` if it does not, or meets a wall before. The keys are those of the lines there, if
    lines of the family's ends they are. Where it is open how the family crosses, nothing ``is_known``.
    """

    def __init__(
        self, role: int, first: EdgePlace, last: EdgePlace, first_keys: list[int], last_keys: list[int]
    ) -> None:
        self.is_known = True
        self.role, self.first, self.last = role, first, last
        self.first_keys, self.last_keys = first_keys, last_keys


def _unknown() -> Crossed:
    crossed = Crossed(CONTACT, NOT_MET, NOT_MET, [], [])
    crossed.is_known = False
    return crossed


def _crossed(family: FamilyImage, way: WayImage, curves: list[CurveImage]) -> Crossed:
    """How a family crosses a way.

    While lines of a family turn or slide, and the contact stays on one side of the way's line, the crossing
    moves along that line without turning back, from a to b. A contact that rolls on a circle comes nearer to
    that line, or moves away from it, until a line is parallel to it: so if none is, both ends tell.

    If a line between is parallel to the way, the crossing leaves over infinity and comes back from the other
    side, and the contact is behind it before and ahead after, or the other way round. Where it leaves to is
    where the lines point to, or the opposite, for they turn by a quarter at most: to one side of a and from
    the other side to b. Both parts may meet the way, for two tangents of a circle pass a point. What is
    known is that one of them does not.
    """
    first, last = Outermost(family, way, True), Outermost(family, way, False)
    one, other, a, b = first.line, last.line, first.met, last.met
    wx, wy = way.line.wx, way.line.wy
    # Where these places are known the line is not parallel to the way, and the sign of its turn is sure.
    is_parallel = (wx * one[3] - wy * one[2] > 0.0) != (wx * other[3] - wy * other[2] > 0.0)
    if not (a[3] < inf and b[3] < inf):
        return _unknown()
    if is_parallel and _may_touch(family, way):
        return _unknown()
    role, last_role = _role(a, family, first, way), _role(b, family, last, way)
    role, last_role = role if role else last_role, last_role if last_role else role
    spots = _spot(first, way), _spot(last, way)
    keys = first.keys, last.keys
    low, high = way.low[0], way.high[1]
    turn = wx * one[3] - wy * one[2]
    is_rising = a[2] < b[2]
    part = 0
    if is_parallel:
        ahead = _ahead(one, way)
        if role != -last_role or ahead == 0 or ahead != _ahead(other, way):
            return _unknown()
        is_rising = ahead == role
        part = _part(a, b, is_rising, low, high)
        if part == OPEN:
            return _unknown()
        if part == 0:
            return Crossed(CONTACT, NOT_MET, NOT_MET, [], [])
        beyond = inf if is_rising == (part < 0) else -inf
        end = (beyond, beyond, 0.0, 0.0, 0.0)
        if part < 0:
            spots, keys = (spots[0], end), (keys[0], [])
        else:
            role, spots, keys = last_role, (end, spots[1]), ([], keys[1])
            turn = -turn
    elif role != last_role or role == OPEN or not _is_kept(family, way, role):
        return _unknown()
    if role == 0:
        return _unknown()
    if max(spots[0][1], spots[1][1]) < low or min(spots[0][0], spots[1][0]) > high:
        return Crossed(CONTACT, NOT_MET, NOT_MET, [], [])
    wall = family.edge(role)
    if wall < 0:
        if not family.goes_back and role == BEHIND:
            role = CONTACT
    else:
        ends = first.t, last.t
        before = _is_before(family.frame, ends, way, is_rising, part, turn > 0.0, role, curves[wall])
        if before == 0:
            return _unknown()
        if before < 0:
            role = CONTACT
    return Crossed(role, _within(spots[0], way), _within(spots[1], way), keys[0], keys[1])


@final
class Outermost:
    """The first or the last line of a family, at ``t``, and where it is ``met`` by the way's line.

    A line that is nearly parallel to that may be met anywhere. Then it is one next to it, if none of those
    between them meets the way: both ends of the way are on one side of them. That one passes no vertices and
    has no key.
    """

    def __init__(self, family: FamilyImage, way: WayImage, is_first: bool) -> None:
        self.t, end = (family.low, family.high) if is_first else (family.high, family.low)
        self.line = family.first if is_first else family.last
        self.keys = family.first_keys if is_first else family.last_keys
        self.corners = family.first_corners if is_first else family.last_corners
        self.met = meets_straight(self.line, way.line)
        t = self.t + (end - self.t) * NEXT
        if self.met[3] < inf or not family.fraction[1] < t < family.fraction[2]:
            return
        line = line_at(family.frame, t, 0.0)
        ax, ay, bx, by, error = way.ends
        side = side_of_all(family.frame, self.line, line, ax, ay, error)
        if side and side == side_of_all(family.frame, self.line, line, bx, by, error):
            self.t, self.line, self.met = t, line, meets_straight(line, way.line)
            self.keys, self.corners = [], []


def _is_kept(family: FamilyImage, way: WayImage, role: int) -> bool:
    """Whether all lines cross the way's line on that side of the contact on which the first and the last do.

    None of them is parallel to it. Only of the normals of an arc that may be open. They pass its centre, and
    the crossing is nearest to that on the line that is normal to the way, and farther away on both sides of
    it. So it is nearer than the arc if it is so first and last. If it is farther then, it is so between too,
    unless that normal is among the lines, and the way's line meets the circle.
    """
    if family.frame[0] != SPOKES or role == (AHEAD if family.frame[6] < 0 else BEHIND):
        return True
    ahead = _ahead(family.first, way)
    return (ahead != 0 and ahead == _ahead(family.last, way)) or not _may_touch(family, way)


def _may_touch(family: FamilyImage, way: WayImage) -> bool:
    """Whether the circle that a family rolls on, or whose normals it is, may meet the way's line.

    Or whether the normals go inward: they leave the circle on the other side too.
    """
    kind, cx, cy, ex, ey, radius, sense = family.frame
    if kind not in (ROLLING, SPOKES):
        return False
    line = way.line
    bound = UNIT * radius
    if kind == ROLLING:
        error = UNIT * max(abs(ex), abs(ey)) + TINY
        radius, bound = length(ex, ey, error)
    ox, p = total(cx, UNIT * abs(cx), -line.x, UNIT * abs(line.x))
    oy, q = total(cy, UNIT * abs(cy), -line.y, UNIT * abs(line.y))
    error = UNIT * max(abs(line.wx), abs(line.wy)) + TINY
    height, height_bound = cross(ox, oy, max(p, q) + TINY, line.wx, line.wy, error)
    size, size_bound = length(line.wx, line.wy, error)
    reach, reach_bound = product(radius, bound, size, size_bound)
    return sense < 0 or not abs(height) - height_bound > reach + reach_bound


def _role(met: Meeting, family: FamilyImage, at: Outermost, way: WayImage) -> int:
    """The side of the contact on which a line crosses the way's line; 0 if it is open or does so there.

    That is known of the normals of a segment from an end of the way, and of lines that touch a circle there.
    """
    if met[0] > met[1]:
        return AHEAD
    if -met[0] > met[1]:
        return BEHIND
    if family.frame[0] == SLIDING and any(v in way.starts or v in way.stops for v in at.corners):
        return 0
    if any((key, family.edges[1]) in way.touching for key in at.keys):
        return 0
    return OPEN


def _ahead(line: Line, way: WayImage) -> int:
    """1 or -1 as a line certainly points ahead along the way or back; else 0."""
    error = UNIT * max(abs(way.line.wx), abs(way.line.wy)) + TINY
    height, bound = dot(line[2], line[3], line[5], way.line.wx, way.line.wy, error)
    return 1 if height > bound else -1 if -height > bound else 0


def _part(a: Meeting, b: Meeting, is_rising: bool, low: float, high: float) -> int:
    """Which part of a family that passes infinity may meet a way: the first (-1), the last (1), none (0).

    `OPEN` if both may. The first line crosses the way's line in a, the last one in b; in between parameters
    rise, or fall.
    """
    if is_rising:
        first, last = high >= a[2] - a[3], low <= b[2] + b[3]
    else:
        first, last = low <= a[2] + a[3], high >= b[2] - b[3]
    if first and last:
        return OPEN
    return -1 if first else 1 if last else 0


def _is_before(
    frame: Frame,
    ends: tuple[float, float],
    way: WayImage,
    is_rising: bool,
    part: int,
    turns_left: bool,
    role: int,
    wall: CurveImage,
) -> int:
    """1 or -1 as lines of a family that cross the way do so before they meet a wall or not; 0 if open.

    The way does not cross the wall, so one line tells. It is looked for between those at the *ends*; if only
    a *part* of the family meets the way, among those that turn from the way to the same side.
    """
    low, high = ends
    middle = (way.low[0] + way.high[1]) / 2.0
    for _ in range(STEPS):
        t = (low + high) / 2.0
        line: Line = line_at(frame, t, 0.0)
        if part and (way.line.wx * line[3] - way.line.wy * line[2] > 0.0) != turns_left:
            if part < 0:
                high = t
            else:
                low = t
            continue
        crossed: Meeting = meets_straight(line, way.line)
        far: Meeting = meets(line, wall, role)
        u, error = crossed[2], crossed[3]
        if way.low[1] < u - error and u + error < way.high[0] and far[1] < inf:
            gap, bound = (far[0] - crossed[0]) * role, far[1] + crossed[1]
            return 1 if gap > bound else -1 if -gap > bound else 0
        if (u < middle) == is_rising:
            low = t
        else:
            high = t
    return 0


def _within(spot: EdgePlace, way: WayImage) -> EdgePlace:
    """A place on the way's line, moved to the end of the way if it certainly lies beyond it."""
    ax, ay, bx, by, error = way.ends
    if spot[1] < way.low[0]:
        return -inf, -inf, ax, ay, error
    if spot[0] > way.high[1]:
        return inf, inf, bx, by, error
    return spot


def _spot(at: Outermost, way: WayImage) -> EdgePlace:
    """Where a line crosses the way's line: at an infinite parameter if it passes an end of the way."""
    _, _, u, error, x, y, e = at.met
    end = way.end_of(at.corners, at.keys)
    return (end, end, x, y, e) if end else (u - error, u + error, x, y, e)
