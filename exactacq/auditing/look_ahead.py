"""Whether by a map an obstacle is seen from the rest of a line, found by code of the audit's own.

The pairs of a place on the rest and a known point that see each other are a closed set, but for the start and
for places on walls, at the end of a stretch within what they bound. If sights from such places may begin on
the blocked side, the set is closed. So if there is one beyond the start, some place is the farthest along the
line; take a direction that cannot be turned one way among those in which something is seen from there. If the
sight could be turned, or moved on with what it touches, the place were not the farthest. So this *last sight*
is one of these:

1. it touches two posts: corners, ends of knowledge, convex arcs, ends of known pieces of the obstacle, and
   stands, which are the end of the rest and the places where it meets a wall (`last_sights`);
2. it runs from a stand along a wall, or to an end of a piece along it: beyond, it would be blocked there;
3. it is as long as the range, and leads to an end of a piece, from a stand, is normal to what it leads to, or
   touches that;
4. it is as long as the range, touches one post, and leads to an inner point (`sights_of_range`);
5. it runs along the line itself.

A grid of sights is tried first. Then floats drop what is certainly blocked, too long or off the rest, and
balls of more than `DIGITS` digits decide the others: what they do not part counts as equal. So "yes" comes
with a sight, and "no" is proved, both but for deviations beyond these digits. Where only sights were found
that begin on the blocked side of a wall, places close by are asked; if nothing is seen from these, the
question stays open.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from flint import arb, fmpq

from exactacq.auditing.known_walls import PRECISION, UNIT, BallPoint, Wall, sign
from exactacq.auditing.last_sights import LastSights, meetings_of_ray
from exactacq.auditing.rest_of_line import FINEST, KnownPieces, LineOfSight, Rest, RestOfLine
from exactacq.auditing.sights_of_range import SightsOfRange
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import nearest_float, rational

GRID = 12
"""Places of the rest, and points of each piece, whose sights are tried first."""
ASIDE = (2.0**-8, 2.0**-16, 2.0**-24)
"""How far beside a place on a wall one looks, in parts of the range."""
TRIES = 8
"""Sights of the grid that are tried with balls."""


class Answer:
    """Whether something is seen: ``sight`` is one that is free, None if there is none, or if ``is_open``."""

    def __init__(self, sight: LineOfSight | None, is_open: bool = False) -> None:
        self.sight, self.is_open = sight, is_open and sight is None
        self.sees = sight is not None
        self.origin = (0.0, 0.0)

    @property
    def place(self) -> str:
        """Where something is seen from."""
        return "" if self.sight is None else _text(self.sight.place, self.origin)

    @property
    def goal(self) -> str:
        """What is seen from there."""
        return "" if self.sight is None else _text(self.sight.goal, self.origin)


def seen_later(rest: Rest, known: KnownPieces, radius: fmpq) -> Answer:
    """Whether from the rest of a line something of an obstacle is seen, known pieces being the only walls.

    Far from the origin all is moved there: floats tell apart what is close to where they are small.
    """
    x, y = rest.start.xy
    if UNIT * max(abs(x), abs(y)) > FINEST * nearest_float(radius) / 4:
        origin = Point(rational(x), rational(y))
        answer = seen_later(*_moved(rest, known, origin), radius)
        answer.origin = x, y
        return answer
    if not rest.including and rest.start.y == rest.stop.y:
        return Answer(None)
    line = RestOfLine(rest, known, radius)
    if line.is_empty:
        return Answer(None)
    with workprec(PRECISION):
        line.walls.join()
        answer = _LookAhead(line).answer()
    if answer.sees or not line.limits:
        return answer
    return _seen_beside(rest, line, known, radius)


def _moved(rest: Rest, known: KnownPieces, origin: Point) -> tuple[Rest, KnownPieces]:
    """A rest of a line and what is known, as seen from an origin."""

    def curve(one: Curve) -> Curve:
        start, end = one.start - origin, one.end - origin
        if isinstance(one, Segment):
            return Segment(start, end)
        return Arc(start, end, one.center - origin, one.radius_sq, one.ccw, full=one.full)

    return (
        Rest(rest.start - origin, rest.stop - origin, rest.including),
        KnownPieces(
            [curve(one) for one in known.targets],
            [point - origin for point in known.points],
            [curve(one) for one in known.others],
        ),
    )


def _seen_beside(rest: Rest, line: RestOfLine, known: KnownPieces, radius: fmpq) -> Answer:
    """What is seen from places shortly before and after those on walls."""
    for y in {float(place.y) for place in line.limits}:
        for aside in ASIDE:
            for sense in (-1, 1):
                at = Point(rest.stop.x, rational(y + sense * aside * line.reach))
                if min(rest.start.y, rest.stop.y) < at.y < max(rest.start.y, rest.stop.y):
                    answer = seen_later(Rest(at, at, True), known, radius)
                    if answer.sees:
                        return answer
    return Answer(None, is_open=True)


class _LookAhead:
    def __init__(self, rest: RestOfLine) -> None:
        self.rest = rest
        self.stands = rest.stands()
        self.posts = rest.posts()

    def answer(self) -> Answer:
        """The grid first, then what floats tell best."""
        rest = self.rest
        sight = self._on_grid() or rest.first_seen(list(self._single()))
        if sight is None:
            sight = LastSights(rest, [*self.posts, *self.stands]).first()
        if sight is not None:
            return Answer(sight)
        about = SightsOfRange(rest, self.posts)
        return Answer(about.first(), about.is_open)

    def _on_grid(self) -> LineOfSight | None:
        """A free sight of a grid; the ones from the farthest places are tried first."""
        rest = self.rest
        shares = (np.arange(GRID) + 0.5) / GRID
        ys = rest.low + (rest.high - rest.low) * shares
        goals = [_inner(wall, arb(u)) for wall in rest.targets for u in shares] + rest.dots
        p = np.stack((np.full(len(ys), rest.float_x), ys), axis=1).repeat(len(goals), axis=0)
        q = np.tile(np.array([(float(at.x), float(at.y)) for at in goals]), (len(ys), 1))
        free = np.hypot(*(q - p).T) < rest.reach
        free[free] = ~self.rest.walls.block(p[free], q[free], np.full(int(free.sum()), rest.grain))
        rows = np.flatnonzero(free)
        for row in rows[:: max(1, len(rows) // TRIES)]:
            place, goal = rest.place(arb(float(p[row, 1]))), goals[row % len(goals)]
            if rest.sees(place, goal):
                return LineOfSight(place, goal)
        return None

    # -- sights that need no pairs of posts --------------------------------------------------------

    def _single(self) -> Iterator[LineOfSight]:
        """The last sights of the kinds 2, 3 and 5."""
        yield from self._on_the_line()
        yield from self._along_walls()
        for post in self.posts:
            if post.is_goal and post.wall is None:
                yield from (LineOfSight(place, post.at) for place in self._within(post.at, self.rest.radius))
        for wall in self.rest.targets:
            yield from self._normals(wall)
            yield from self._from_stands(wall)
            if wall.sense > 0:
                yield from self._touching(wall)

    def _within(self, center: BallPoint, distance: arb) -> Iterator[BallPoint]:
        """The places at a distance from a point."""
        aside = self.rest.x - center.x
        square = distance * distance - aside * aside
        if sign(square) >= 0:
            root = square.sqrt() if sign(square) else arb(0)
            yield from (self.rest.place(y) for y in (center.y - root, center.y + root))

    def _on_the_line(self) -> Iterator[LineOfSight]:
        rest = self.rest
        goals = [dot for dot in rest.dots if not sign(dot.x - rest.x)]
        goals += [at for wall in rest.targets for at in rest.meetings(wall)]
        for stand in self.stands:
            if any(_passes(wall, stand.at) for wall in rest.targets):
                yield LineOfSight(stand.at, stand.at)
        for goal in goals:
            yield LineOfSight(goal, goal)
            yield from (LineOfSight(stand.at, goal) for stand in self.stands)
            yield from (LineOfSight(place, goal) for place in self._within(goal, rest.radius))

    def _along_walls(self) -> Iterator[LineOfSight]:
        rest = self.rest
        for stand in self.stands:
            for way in stand.ways():
                unit = _scaled(way, 1 / way.dot(way).sqrt())
                for ray in (unit, unit.reversed()):
                    for wall in rest.targets:
                        yield from (LineOfSight(stand.at, at) for at in meetings_of_ray(stand.at, ray, wall))
        for post in self.posts:
            if post.is_goal and post.wall is None:
                for way in post.ways():
                    if sign(way.x):
                        y = post.at.y + way.y * ((rest.x - post.at.x) / way.x)
                        yield LineOfSight(rest.place(y), post.at)

    def _normals(self, wall: Wall) -> Iterator[LineOfSight]:
        """Sights as long as the range, and normal to a piece."""
        rest = self.rest
        if wall.center is None:
            chord = wall.end.minus(wall.start)
            if not sign(chord.x):
                return
            size = chord.dot(chord).sqrt()
            # A piece is seen from its right.
            across = _scaled(chord.left(), -rest.radius / size)
            slope = (rest.x - wall.start.x - across.x) / chord.x
            foot = wall.start.along(chord, slope)
            if wall.holds(foot):
                yield LineOfSight(foot.along(across, arb(1)), foot)
            return
        for distance in (wall.radius + rest.radius, abs(wall.radius - rest.radius)):
            for place in self._within(wall.center, distance):
                ray = place.minus(wall.center)
                size = ray.dot(ray)
                if not sign(size):
                    yield LineOfSight(place, wall.start)
                    continue
                for turn in (wall.radius, -wall.radius):
                    foot = wall.center.along(ray, turn / size.sqrt())
                    if wall.holds(foot):
                        yield LineOfSight(place, foot)

    def _from_stands(self, wall: Wall) -> Iterator[LineOfSight]:
        """Sights as long as the range, from a stand to an inner point of a piece."""
        radius = self.rest.radius
        for stand in self.stands:
            at = stand.at
            if wall.center is None:
                chord, offset = wall.end.minus(wall.start), wall.start.minus(at)
                size, middle = chord.dot(chord), -chord.dot(offset)
                square = middle * middle - size * (offset.dot(offset) - radius * radius)
                if sign(square) >= 0:
                    root = square.sqrt() if sign(square) else arb(0)
                    for u in ((middle - root) / size, (middle + root) / size):
                        if sign(u) >= 0 and sign(1 - u) >= 0:
                            yield LineOfSight(at, wall.start.along(chord, u))
                continue
            way = wall.center.minus(at)
            size = way.dot(way)
            if not sign(size):
                continue
            share = (size + radius * radius - wall.square) / (2 * size)
            square = radius * radius / size - share * share
            if sign(square) >= 0:
                root = square.sqrt() if sign(square) else arb(0)
                for height in (root, -root):
                    goal = at.along(way, share).along(way.left(), height)
                    if wall.holds(goal):
                        yield LineOfSight(at, goal)

    def _touching(self, wall: Wall) -> Iterator[LineOfSight]:
        """Sights as long as the range that touch a convex arc of the obstacle there."""
        assert wall.center is not None
        radius = self.rest.radius
        for place in self._within(wall.center, (wall.square + radius * radius).sqrt()):
            way = wall.center.minus(place)
            size = way.dot(way)
            for side in (wall.radius, -wall.radius):
                goal = place.along(way, radius * radius / size).along(way.left(), radius * side / size)
                if wall.holds(goal):
                    yield LineOfSight(place, goal)


def _inner(wall: Wall, u: arb) -> BallPoint:
    """A point of a piece at a share of it."""
    if wall.center is None:
        return wall.start.along(wall.end.minus(wall.start), u)
    radial, angle = wall.start.minus(wall.center), wall.sweep * u
    return wall.center.along(radial, angle.cos()).along(radial.left(), angle.sin())


def _passes(wall: Wall, at: BallPoint) -> bool:
    """Whether a point is on a piece."""
    if wall.center is None:
        return not sign(wall.end.minus(wall.start).cross(at.minus(wall.start))) and wall.holds(at)
    offset = at.minus(wall.center)
    return not sign(offset.dot(offset) - wall.square) and wall.holds(at)


def _scaled(way: BallPoint, factor: arb) -> BallPoint:
    return BallPoint(way.x * factor, way.y * factor)


def _text(at: BallPoint, origin: tuple[float, float]) -> str:
    return f"({float(at.x) + origin[0]:.15g}, {float(at.y) + origin[1]:.15g})"
