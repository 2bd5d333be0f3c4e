"""What is left of a line of a sweep, the map as seen from it, and what lines of sight from it may touch."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from flint import arb, fmpq

from exactacq.auditing.hits import Bools, Floats
from exactacq.auditing.known_walls import (
    PRECISION,
    UNIT,
    BallPoint,
    Wall,
    Walls,
    ball_point,
    coincide,
    sign,
)
from exactacq.errors import Undecided
from exactacq.geometry.box_index import bounds
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import nearest_float
from exactacq.numbers.real import Real

FINEST = 2.0**-16
"""Lines of sight are looked for in floats: places must be told apart to this share of the radius."""
COARSEST, FEW = 2.0**-8, 64
"""Circles of arcs that hardly bend are so large that floats leave out few lines, and balls compare the rest.
If errors are larger than this share of the radius, that is done for so many walls at most."""


class Rest(NamedTuple):
    """What is left of a vertical line: from *start* to *stop*, without the start unless *including*."""

    start: Point
    stop: Point
    including: bool = False


class KnownPieces(NamedTuple):
    """What is known: pieces of the obstacle looked for, single points of it, and pieces of others."""

    targets: Sequence[Curve]
    points: Sequence[Point]
    others: Sequence[Curve]


class LineOfSight(NamedTuple):
    """A line of sight from a place of the rest to a known point."""

    place: BallPoint
    goal: BallPoint


class RestOfLine:
    """The rest of a line in balls and floats, with the pieces among which its lines of sight run.

    ``targets`` are pieces of the obstacle in reach, ``dots`` its single points; ``walls`` hold all pieces
    near. ``grain`` bounds the error of coordinates in floats.
    """

    def __init__(self, rest: Rest, known: KnownPieces, radius: fmpq) -> None:
        self.including = rest.including
        at = ball_point(rest.stop)
        self.x, self.stop, self.start = at.x, at.y, ball_point(rest.start).y
        self.radius = Real(radius).ball(PRECISION)
        self.reach = nearest_float(radius)
        self.float_x, begin, end = float(self.x), float(self.start), float(self.stop)
        self.sense = rest.stop.y.compare(rest.start.y) or 1
        low, high = min(begin, end), max(begin, end)
        targets, around = bounds(known.targets), bounds(known.others)
        dots = np.array([(*point.xy, *point.xy) for point in known.points]).reshape(-1, 4)
        goals = np.vstack((targets, dots))
        sizes = (abs(self.float_x), abs(low), abs(high), self.reach, np.abs(goals).max(initial=0.0))
        pad = 8 * UNIT * max(sizes)
        across, up = self.float_x + np.array((-1, 1)) * self.reach, (low - self.reach, high + self.reach)
        window = np.array((across[0], up[0], across[1], up[1])) + pad * np.array((-1, -1, 1, 1))
        in_reach = _meet(goals, window)
        self.limits: list[BallPoint] = []
        """Places on walls from which something would be seen, if the sight did not enter the blocked side."""
        self.is_empty = not in_reach.any()
        if self.is_empty:
            return
        seen = goals[in_reach]
        left, bottom = np.maximum(seen[:, :2].min(axis=0), window[:2])
        right, top = np.minimum(seen[:, 2:].max(axis=0), window[2:])
        self.low, self.high = max(low, bottom - self.reach - pad), min(high, top + self.reach + pad)
        box = (left, bottom, right, top)
        line = (self.float_x, self.low, self.float_x, self.high)
        field = np.array([*np.minimum(box[:2], line[:2]) - pad, *np.maximum(box[2:], line[2:]) + pad])
        count = len(known.targets)
        chosen = [known.targets[k] for k in np.flatnonzero(in_reach[:count]).tolist()]
        others = [known.targets[k] for k in np.flatnonzero(~in_reach[:count]).tolist()]
        others += [known.others[k] for k in np.flatnonzero(_meet(around, field)).tolist()]
        curves = [*chosen, *others]
        size = max(np.abs(bounds(curves)).max(initial=0.0), np.abs(field).max(), *sizes)
        circles = (_extent(curve) for curve in curves if isinstance(curve, Arc))
        self.walls = Walls(curves, len(chosen), float(max(size, *circles, 0.0)))
        self.grain = self.walls.grain
        is_vague = self.grain > COARSEST * self.reach and len(curves) > FEW
        if is_vague or UNIT * size > FINEST * self.reach:
            raise Undecided("what is seen from a line: floats cannot tell places within the radius apart")
        self.targets = self.walls.list[: len(chosen)]
        self.dots = [ball_point(known.points[k]) for k in np.flatnonzero(in_reach[count:]).tolist()]

    # -- one sight ---------------------------------------------------------------------------------

    def place(self, y: arb) -> BallPoint:
        return BallPoint(self.x, y)

    def passes(self, y: arb) -> bool:
        """Whether an ordinate belongs to the rest."""
        after, before = sign((y - self.start) * self.sense), sign((self.stop - y) * self.sense)
        return before >= 0 and (after > 0 or (after == 0 and self.including))

    def sees(self, place: BallPoint, goal: BallPoint) -> bool:
        """Whether a known point is seen from a place, and this belongs to the rest."""
        if not self.passes(place.y):
            return False
        sight = goal.minus(place)
        if sign(self.radius * self.radius - sight.dot(sight)) < 0:
            return False
        if self.walls.is_free(place, goal):
            return True
        if self.walls.is_free(place, goal, leaves_any_side=True):
            self.limits.append(place)
        return False

    def first_seen(self, sights: Sequence[LineOfSight]) -> LineOfSight | None:
        """A sight that is free, of a list from which floats drop most."""
        if not sights:
            return None
        ends = np.array([[float(v) for at in sight for v in at] for sight in sights])
        p, q = ends[:, :2], ends[:, 2:]
        with np.errstate(invalid="ignore"):
            may = (p[:, 1] >= self.low - 2 * self.grain) & (p[:, 1] <= self.high + 2 * self.grain)
            may &= np.hypot(*(q - p).T) <= self.reach + 4 * self.grain
        may[may] = ~self.walls.block(p[may], q[may], np.full(int(may.sum()), self.grain))
        return next((sights[k] for k in np.flatnonzero(may).tolist() if self.sees(*sights[k])), None)

    # -- posts -------------------------------------------------------------------------------------

    def meetings(self, wall: Wall) -> Iterator[BallPoint]:
        """Where the whole line meets a wall; of one along the line, its ends."""
        if wall.center is not None:
            aside = self.x - wall.center.x
            square = wall.square - aside * aside
            if sign(square) < 0:
                return
            root = square.sqrt() if sign(square) else arb(0)
            for y in (wall.center.y - root, wall.center.y + root):
                if wall.holds(at := self.place(y)):
                    yield at
            return
        (a, b), (c, d) = wall.start, wall.end
        one, two = sign(a - self.x), sign(c - self.x)
        if one * two < 0:
            yield self.place(b + (d - b) * ((self.x - a) / (c - a)))
        yield from (end for end, side in ((wall.start, one), (wall.end, two)) if not side)

    def stands(self) -> list[Post]:
        """The end of the rest, and where it meets walls."""
        found = [Post(self.place(self.stop), is_stand=True)]
        for wall in self.walls.list:
            for at in self.meetings(wall):
                if not self.passes(at.y):
                    continue
                if coincide(at, wall.start):
                    found.append(Post(at, is_stand=True, arriving=wall.before, leaving=wall))
                elif coincide(at, wall.end):
                    found.append(Post(at, is_stand=True, arriving=wall, leaving=wall.after))
                else:
                    found.append(Post(at, is_stand=True, arriving=wall, leaving=wall))
        return found

    def posts(self) -> list[Post]:
        """Corners and ends of knowledge, circles of convex arcs, and where pieces of the obstacle end."""
        found = [Post(dot, is_goal=True) for dot in self.dots]
        for wall in self.walls.list:
            before = wall.before
            is_pivot = before is None or _turns_left(before, wall)
            is_goal = wall.target or (before is not None and before.target)
            if is_pivot or is_goal:
                found.append(
                    Post(wall.start, is_pivot=is_pivot, is_goal=is_goal, arriving=before, leaving=wall)
                )
            if wall.after is None:
                found.append(Post(wall.end, is_pivot=True, is_goal=wall.target, arriving=wall))
            if wall.sense > 0:
                assert wall.center is not None
                found.append(Post(wall.center, is_pivot=True, is_goal=wall.target, wall=wall))
        return found


class Post:
    """A point, or the circle of a convex arc ``wall``, that a line of sight may touch.

    Sights can turn about a pivot; a goal is of the obstacle; a stand is a place of the rest. ``arriving`` is
    the piece that ends there, ``leaving`` the one that starts there.
    """

    def __init__(
        self,
        at: BallPoint,
        *,
        is_pivot: bool = False,
        is_goal: bool = False,
        is_stand: bool = False,
        arriving: Wall | None = None,
        leaving: Wall | None = None,
        wall: Wall | None = None,
    ) -> None:
        self.at, self.wall = at, wall
        self.is_pivot, self.is_goal, self.is_stand = is_pivot, is_goal, is_stand
        self.arriving, self.leaving = arriving, leaving

    def lies_on(self, wall: Wall) -> bool:
        return wall in (self.arriving, self.leaving)

    def ways(self) -> list[BallPoint]:
        """Along the pieces, from there."""
        found = []
        if self.leaving is not None:
            found.append(self.leaving.germ(self.at).way)
        if self.arriving is not None:
            found.append(self.arriving.germ(self.at).way.reversed())
        return found


def _turns_left(before: Wall, after: Wall) -> bool:
    """Whether a boundary turns left, or not at all, where two pieces join."""
    return sign(before.germ(before.end).way.cross(after.germ(after.start).way)) >= 0


def _extent(arc: Arc) -> float:
    return max(abs(v) for v in arc.center.xy) + float(arc.radius)


def _meet(boxes: Floats, window: Floats) -> Bools:
    """Which boxes meet a window."""
    inside = (boxes[:, :2] <= window[2:]) & (boxes[:, 2:] >= window[:2])
    return np.asarray(inside.all(axis=1))
