"""Lines of sight from the rest of a line that touch two posts: floats drop most, balls decide the others.

A line has a left unit normal n, and n z = level for its points z. It touches post i, of centre c and signed
radius t (the turn), if n c + t = level: the circle lies on its right if t > 0. With D = c_j - c_i,
k = t_i - t_j and g = sqrt(D^2 - k^2), the distance between the two points of touch,
n = (k D + g left(D)) / D^2; the other solution is that of -t_i and -t_j, reversed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from flint import arb

from exactacq.auditing.hits import Bools, Floats, Ints, cross
from exactacq.auditing.known_walls import BallPoint, Wall, coincide, sign
from exactacq.auditing.rest_of_line import LineOfSight, Post, RestOfLine

ANGLE = 1e-9
"""Sines that are less leave open whether a corner is entered, besides the error of the direction."""
FLAT = 1e-3
"""Where a line meets a piece at a sine that is less, floats do not tell the place."""


class Turned(NamedTuple):
    """A post, and the signed radius with which lines touch it."""

    post: Post
    turn: arb


def turned(posts: Sequence[Post]) -> list[Turned]:
    """Both sides of circles, and points once."""
    found = []
    for post in posts:
        if post.wall is None:
            found.append(Turned(post, arb(0)))
        else:
            found += [Turned(post, post.wall.radius), Turned(post, -post.wall.radius)]
    return found


def normal(one: Turned, two: Turned) -> BallPoint | None:
    """The unit normal of the line that touches two posts; None if there is none, or if they are one point."""
    way, k = two.post.at.minus(one.post.at), one.turn - two.turn
    size = way.dot(way)
    square = size - k * k
    if sign(size) == 0 or sign(square) < 0:
        return None
    root = square.sqrt() if sign(square) else arb(0)
    return BallPoint((way.x * k - way.y * root) / size, (way.y * k + way.x * root) / size)


class _TouchingLine(NamedTuple):
    """A line that floats leave over, and the pieces and posts to which it may lead."""

    one: int
    two: int
    targets: tuple[int, ...]


class LastSights:
    """The lines of sight through two posts."""

    def __init__(self, rest: RestOfLine, posts: Sequence[Post]) -> None:
        self.rest, self.walls = rest, rest.walls
        self.turned = turned(posts)
        self.center = np.array([(float(t.post.at.x), float(t.post.at.y)) for t in self.turned])
        self.turn = np.array([float(t.turn) for t in self.turned])
        flags = [(t.post.is_pivot, t.post.is_goal, t.post.is_stand) for t in self.turned]
        self.is_pivot, self.is_goal, self.is_stand = np.array(flags, dtype=bool).T
        self.corners = np.array([_corner(t.post) for t in self.turned])
        self.is_corner = np.abs(self.corners).sum(axis=(1, 2)) > 0
        self.arc_chords = np.array([_arc_chord(t.post) for t in self.turned])

    def first(self) -> LineOfSight | None:
        """A sight that is free."""
        return next((sight for line in self._lines() for sight in self._seen_along(line)), None)

    # -- floats ------------------------------------------------------------------------------------

    def _pairs(self) -> tuple[Ints, Ints]:
        i, j = np.triu_indices(len(self.turned), 1)
        end = self.is_goal | self.is_stand
        keep = self.is_pivot[i] & (self.is_pivot[j] | end[j]) | self.is_pivot[j] & end[i]
        keep |= self.is_goal[i] & self.is_stand[j] | self.is_stand[i] & self.is_goal[j]
        keep &= ~(self.is_stand[i] & self.is_stand[j])
        across = np.abs(self.center[:, 0] - self.rest.float_x) - np.abs(self.turn)
        keep &= (across[i] <= self.rest.reach + self.rest.grain) & (
            across[j] <= self.rest.reach + self.rest.grain
        )
        i, j = i[keep], j[keep]
        # Two circles may be one where their centres are, a point and a circle where the point lies on it:
        # what is compared is off by some grains. A pair that is kept for no reason costs time alone.
        size = np.abs(self.turn)
        gap = np.hypot(*(self.center[j] - self.center[i]).T)
        expected = np.where((size[i] > 0) != (size[j] > 0), size[i] + size[j], 0.0)
        apart = np.abs(gap - expected) > 1e3 * self.rest.grain
        for k in np.flatnonzero(~apart):
            apart[k] = not _is_one(self.turned[i[k]].post, self.turned[j[k]].post)
        return i[apart], j[apart]

    def _lines(self) -> Iterator[_TouchingLine]:
        """The lines that are left over.

        Coordinates and radii are off by the grain h at most, so D and k by 2 h, g by 4 h |D| / g, and n by
        14 h / g, called ``bend``. Points of the line up to R from the points of touch are off by
        R ``bend`` + 4 h sideways, called ``blur``; the place, with |n_y| > 4 ``bend``, by 3 ``blur`` / |n_y|.
        """
        rest, grain = self.rest, self.rest.grain
        i, j = self._pairs()
        way, k = self.center[j] - self.center[i], self.turn[i] - self.turn[j]
        size = (way * way).sum(axis=1)
        square = size - k * k
        vague = 16 * grain * (np.sqrt(size) + np.abs(k))
        real = square > -vague
        gap = np.sqrt(np.maximum(square, 0.0))
        with np.errstate(all="ignore"):
            bend = 14 * grain / gap
            n = (k[:, None] * way + gap[:, None] * np.stack((-way[:, 1], way[:, 0]), axis=1)) / size[:, None]
        rough = real & ((square < 1e3 * vague) | ~(bend < 1e-4))
        yield from self._all_of(i[rough], j[rough])
        keep = real & ~rough
        i, j, n, bend = i[keep], j[keep], n[keep], bend[keep]
        reach = rest.reach + np.abs(self.turn[i]) + np.abs(self.turn[j])
        blur = bend * reach + 4 * grain
        rise = n[:, 0] * (self.center[i, 0] - rest.float_x) + self.turn[i]
        keep = np.abs(rise) <= (np.abs(n[:, 1]) + bend) * reach + blur
        level = keep & (np.abs(n[:, 1]) <= 1e-4 + 4 * bend)
        yield from self._all_of(i[level], j[level])
        keep &= ~level
        i, j, n, bend, blur, rise, reach = (a[keep] for a in (i, j, n, bend, blur, rise, reach))
        y = self.center[i, 1] + rise / n[:, 1]
        error = 3 * blur / np.abs(n[:, 1]) + grain
        p = np.stack((np.full(len(y), rest.float_x), y), axis=1)
        keep = (y + error >= rest.low) & (y - error <= rest.high)
        e = np.stack((n[:, 1], -n[:, 0]), axis=1)
        one, two = (((self.center[m] - p) * e).sum(axis=1) for m in (i, j))
        sense = np.where(one + two < 0, -1.0, 1.0)
        e, one, two = e * sense[:, None], one * sense, two * sense
        slack = 2 * error + bend * reach
        keep &= (np.minimum(one, two) > -slack) & (np.maximum(one, two) < rest.reach + slack)
        for m in (i, j):
            keep &= ~self._enters(m, e, bend) & self._may_touch(m, n, blur)
        far = np.where(one >= two, i, j)
        end = self.center[far] + self.turn[far, None] * n
        keep[keep] = ~self.walls.block(p[keep], end[keep], (error + blur)[keep])
        yield from self._with_targets(
            *(a[keep] for a in (i, j, p, e, n, np.maximum(one, two), error, bend, blur))
        )

    def _all_of(self, i: Ints, j: Ints) -> Iterator[_TouchingLine]:
        everything = tuple(range(len(self.rest.targets)))
        yield from (_TouchingLine(int(a), int(b), everything) for a, b in zip(i, j, strict=True))

    def _enters(self, m: Ints, e: Floats, bend: Floats) -> Bools:
        """Whether lines certainly enter what a corner m bounds: onward but at ends, back but for stands."""
        leave, back = self.corners[m, 0], self.corners[m, 1]
        slack = ANGLE + bend
        found = np.zeros(len(m), dtype=bool)
        through = ~(self.is_goal[m] | self.is_stand[m])
        for way, use in ((e, through), (-e, ~self.is_stand[m])):
            one, two = cross(leave, way) > slack, cross(way, back) > slack
            found |= use & (one & two | (cross(leave, back) < -ANGLE) & (one | two))
        return np.asarray(found & self.is_corner[m])

    def _may_touch(self, m: Ints, n: Floats, blur: Floats) -> Bools:
        """Whether lines may touch arcs m, and not only their circles."""
        start, chord = self.arc_chords[m, 0], self.arc_chords[m, 1]
        touch = self.center[m] + self.turn[m, None] * n
        width = np.hypot(*chord.T)
        room = 2 * (blur + self.rest.grain) * (width + np.abs(self.turn[m]))
        return np.asarray(cross(chord, touch - start) <= room)

    def _with_targets(
        self,
        i: Ints,
        j: Ints,
        p: Floats,
        e: Floats,
        n: Floats,
        far: Floats,
        error: Floats,
        bend: Floats,
        blur: Floats,
    ) -> Iterator[_TouchingLine]:
        """The lines with the pieces that they may lead to; those with a goal among the posts in any case."""
        leads = np.zeros((len(i), len(self.rest.targets)), dtype=bool)
        for k, wall in enumerate(self.rest.targets):
            leads[:, k] = self._may_lead(wall, p, e, far, error, bend, blur)
        for row in range(len(i)):
            targets = tuple(np.flatnonzero(leads[row]).tolist())
            if targets or self.is_goal[i[row]] or self.is_goal[j[row]]:
                yield _TouchingLine(int(i[row]), int(j[row]), targets)

    def _may_lead(
        self, wall: Wall, p: Floats, e: Floats, far: Floats, error: Floats, bend: Floats, blur: Floats
    ) -> Bools:
        """Which lines may lead from p in the direction e to a piece beyond their posts."""
        reach, grain = self.rest.reach, self.rest.grain
        a = np.array([float(v) for v in wall.start])
        b = np.array([float(v) for v in wall.end])
        chord = b - a
        width = float(np.hypot(*chord))
        aside = 2 * blur + 2 * bend * reach + 8 * grain
        if wall.center is None:
            one, two = cross(e, a - p), cross(e, b - p)
            wide = aside + 2 * bend * (np.hypot(*(a - p).T) + width)
            may = (np.minimum(one, two) <= wide) & (np.maximum(one, two) >= -wide)
            across = cross(e, chord[None]) / max(width, grain)
            # A piece is seen from its right.
            may &= across < ANGLE + bend
            clear = np.abs(across) > FLAT
            with np.errstate(all="ignore"):
                s = cross(a - p, chord[None]) / (across * max(width, grain))
                off = (aside + error) / np.abs(across)
        else:
            c, r = np.array([float(v) for v in wall.center]), float(wall.radius)
            middle, height = ((c - p) * e).sum(axis=1), cross(e, c - p)
            square = r * r - height * height
            wide = aside + 2 * bend * (np.abs(middle) + r)
            may = np.abs(height) <= r + wide
            clear = square > FLAT * r * r
            half = np.sqrt(np.maximum(square, FLAT * r * r))
            # From without a convex arc one sees its near side, from within a concave one the far side.
            s = middle - wall.sense * half
            off = (wide + error) * (1 + r / half)
            q = p + s[:, None] * e
            if not wall.full:
                side = cross(chord[None], q - a) * wall.sense
                may &= ~clear | (side <= width * (off + wide) * 2 + grain * (width + r))
        with np.errstate(invalid="ignore"):
            may &= ~clear | ((s <= reach + 2 * off) & (s >= far - 2 * off - error))
        sure = may & clear
        q = p + np.where(sure, s, 0.0)[:, None] * e
        may[sure] = ~self.walls.block(p[sure], q[sure], np.maximum(error, off + aside)[sure])
        return np.asarray(may)

    # -- balls -------------------------------------------------------------------------------------

    def _seen_along(self, line: _TouchingLine) -> Iterator[LineOfSight]:
        """The sights along a line that are free."""
        rest, one, two = self.rest, self.turned[line.one], self.turned[line.two]
        n = normal(one, two)
        if n is None or not sign(n.y):
            return
        at = one.post.at
        place = rest.place(at.y + (n.x * (at.x - rest.x) + one.turn) / n.y)
        if not rest.passes(place.y):
            return
        way = BallPoint(n.y, -n.x)
        s, t = (way.dot(m.post.at.minus(place)) for m in (one, two))
        if sign(s) * sign(t) < 0 or not (sign(s) or sign(t)):
            return
        if sign(s) < 0 or sign(t) < 0:
            way = way.reversed()
        goals = [m for m in (one, two) if m.post.is_goal]
        ends = [m.post.at.along(n, m.turn) for m in goals if _touches(m, n)]
        for k in line.targets:
            ends += meetings_of_ray(place, way, rest.targets[k])
        yield from (LineOfSight(place, end) for end in ends if rest.sees(place, end))


def meetings_of_ray(place: BallPoint, way: BallPoint, wall: Wall) -> list[BallPoint]:
    """Where the ray from a place in a unit direction meets a piece, but for one that runs along it."""
    offset = wall.start.minus(place)
    if wall.center is None:
        chord = wall.end.minus(wall.start)
        slope = way.cross(chord)
        if not sign(slope) or sign(way.cross(offset)) * sign(way.cross(wall.end.minus(place))) > 0:
            return []
        found = [offset.cross(chord) / slope]
    else:
        offset = wall.center.minus(place)
        middle, height = way.dot(offset), way.cross(offset)
        square = wall.square - height * height
        if sign(square) < 0:
            return []
        root = square.sqrt() if sign(square) else arb(0)
        found = [middle - root, middle + root]
    ends = [place.along(way, s) for s in found if sign(s) >= 0]
    return ends if wall.center is None else [end for end in ends if wall.holds(end)]


def _touches(one: Turned, n: BallPoint) -> bool:
    """Whether a line touches the arc, not only its circle."""
    wall = one.post.wall
    return wall is None or wall.holds(one.post.at.along(n, one.turn))


def _is_one(a: Post, b: Post) -> bool:
    """Whether two posts are one, or have no line that touches both in two places."""
    if a is b:
        return True
    if a.wall is not None and b.wall is not None:
        return coincide(a.at, b.at)
    wall, point = (a.wall, b) if a.wall is not None else (b.wall, a)
    return wall is not None and point.lies_on(wall)


def _corner(post: Post) -> Floats:
    """Unit directions along the boundary from a corner, the blocked side from the first to the second."""
    if post.arriving is None or post.leaving is None:
        return np.zeros((2, 2))
    ways = np.array([[float(v) for v in way] for way in post.ways()])
    return np.asarray(ways / np.hypot(*ways.T)[:, None])


def _arc_chord(post: Post) -> Floats:
    """Where an arc starts, and from there to its end; zeros if all of its circle may be touched."""
    wall = post.wall
    if wall is None or wall.full:
        return np.zeros((2, 2))
    return np.array([[float(v) for v in at] for at in (wall.start, wall.end.minus(wall.start))])
