"""Lines of sight that touch one post, are as long as the range, and lead to an inner point of a piece.

They are looked for by their goals q, which run along the piece with a parameter u from 0 to 1. The line
through q that touches a circle of centre c and signed radius t has, with D = q - c and
g = sqrt(D^2 - t^2), the left unit normal n = (t D + g left(D)) / D^2. It meets the vertical line at abscissa
X in the distance l = |q_x - X| / |n_y|. So l is the range R where

    G(u) = R^2 n_y^2 - (q_x - X)^2 = 0.

When q moves by dq the line turns by at most dq / g, so G' is bounded: see `_may_hold`.
Floats halve the pieces until no root is left, all sights are certainly blocked or off the rest, or the parts
are tiny. In these balls find the roots: where G' or G'' has no zero G has two at most, and an extremum that
balls do not part from 0 is one. Elsewhere they halve again; where that does not end the question stays open.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from flint import arb, arb_series

from exactacq.auditing.hits import Bools, Floats, Ints
from exactacq.auditing.known_walls import BallPoint, Wall, coincide, sign
from exactacq.auditing.last_sights import Turned, turned
from exactacq.auditing.rest_of_line import LineOfSight, Post, RestOfLine

HALVINGS = 30
"""Parts of a piece that are 2^-30 of it are left to balls."""
DEEPER = 60
"""How often balls halve such a part."""
STEPS = 2000
"""Parts that balls look at, of one question."""
MOST = 1 << 16
"""Parts at a time; where more are left the question stays open."""


class _TouchingSights(NamedTuple):
    """The lines through inner points of a piece that touch a post; ``own`` if this is an end of the piece:
    1 its start, -1 its end, else 0."""

    piece: int
    touch: Turned
    own: int


class _FamilyTable:
    """Families in floats, one a row: the piece, the post, and how the lines from an own end turn."""

    def __init__(self, targets: Sequence[Wall], families: Sequence[_TouchingSights]) -> None:
        walls = [targets[family.piece] for family in families]
        posts = [family.touch.post.at for family in families]
        self.center = _floats(posts)
        self.turn = np.array([float(family.touch.turn) for family in families])
        self.own = np.array([family.own for family in families])
        self.start, self.end = _floats([w.start for w in walls]), _floats([w.end for w in walls])
        self.is_round = np.array([w.center is not None for w in walls], dtype=bool)
        self.middle = _floats([w.start if w.center is None else w.center for w in walls])
        self.sense = np.array([float(w.sense) for w in walls])
        self.sweep = np.array([float(w.sweep) for w in walls])
        size = np.hypot(*(self.start - self.middle).T)
        self.curvature = np.where(self.is_round, 1 / np.where(self.is_round, size, 1.0), 0.0)
        self.speed = np.where(self.is_round, np.abs(self.sweep) * size, np.hypot(*(self.end - self.start).T))

    def goals(self, f: Ints, u: Floats) -> Floats:
        straight = self.start[f] + u[:, None] * (self.end[f] - self.start[f])
        angle, radial = self.sweep[f] * u, self.start[f] - self.middle[f]
        bent = self.middle[f] + _rotated(radial, angle)
        return np.where(self.is_round[f][:, None], bent, straight)

    def tangents(self, f: Ints, q: Floats) -> Floats:
        """Unit tangents, of arcs counterclockwise."""
        ways = np.where(self.is_round[f][:, None], _left(q - self.middle[f]), self.end[f] - self.start[f])
        return np.asarray(ways / np.hypot(*ways.T)[:, None])

    def own_normals(self, f: Ints, u: Floats) -> Floats:
        """Of the chords of an arc from its end: the tangent there, turned by half the angle between."""
        tangent = _left(self.center[f] - self.middle[f]) * self.sense[f][:, None]
        tangent /= np.hypot(*tangent.T)[:, None]
        start = self.own[f] > 0
        half = np.where(start, u, u - 1) * self.sweep[f] / 2
        return _left(_rotated(np.where(start[:, None], tangent, -tangent), half))


def _floats(spots: Sequence[BallPoint]) -> Floats:
    return np.array([(float(at.x), float(at.y)) for at in spots]).reshape(-1, 2)


def _left(a: Floats) -> Floats:
    return np.stack((-a[..., 1], a[..., 0]), axis=-1)


def _rotated(a: Floats, angle: Floats) -> Floats:
    return np.asarray(a * np.cos(angle)[:, None] + _left(a) * np.sin(angle)[:, None])


class SightsOfRange:
    """The lines of sight that touch one of some posts, are as long as the range, and lead to inner points."""

    def __init__(self, rest: RestOfLine, posts: Sequence[Post]) -> None:
        self.rest, self.walls = rest, rest.walls
        self.is_open, self._left = False, STEPS
        self.families = list(self._families([post for post in posts if post.is_pivot]))
        self._table = _FamilyTable(rest.targets, self.families)

    def first(self) -> LineOfSight | None:
        """A sight that is free; ``is_open`` is set if none is found, but may be."""
        for family, low, high in self._parts():
            found = self._first_in(family, arb(low), arb(high), DEEPER)
            if found is not None:
                return found
        return None

    def _families(self, posts: Sequence[Post]) -> Iterator[_TouchingSights]:
        rest = self.rest
        for touch in turned(posts):
            post, turn = touch.post, abs(float(touch.turn))
            if post.wall is None and not sign(post.at.x - rest.x):
                continue  # A place of the line itself: a stand, or none of the rest.
            x, y = float(post.at.x), float(post.at.y)
            up = max(rest.low - y, y - rest.high, 0.0)
            before = np.hypot(x - rest.float_x, up)
            for k, wall in enumerate(rest.targets):
                x0, y0, x1, y1 = self.walls.boxes[k]
                beyond = np.hypot(max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0))
                if before + beyond - 2 * turn > rest.reach + 8 * rest.grain:
                    continue
                if wall.center is None and not (sign(wall.start.x - rest.x) or sign(wall.end.x - rest.x)):
                    continue  # A piece of the line itself is seen along the line, or from where it is.
                own = 0
                if post.wall is not None:
                    if wall.center is not None and _is_same_circle(post.wall, wall):
                        continue
                elif wall.center is None:
                    if not sign(wall.end.minus(wall.start).cross(post.at.minus(wall.start))):
                        continue
                elif post.lies_on(wall):
                    own = 1 if post.leaving is wall else -1
                yield _TouchingSights(k, touch, own)

    # -- floats ------------------------------------------------------------------------------------

    def _parts(self) -> Iterator[tuple[_TouchingSights, float, float]]:
        """Parts of pieces that may hold a root: joined where they meet."""
        count = len(self.families)
        if not count:
            return
        f, low, width = np.arange(count), np.zeros(count), 1.0
        for _ in range(HALVINGS):
            f, low = np.concatenate((f, f)), np.concatenate((low, low + width / 2))
            width /= 2
            keep = self._may_hold(f, low + width / 2, width)
            f, low = f[keep], low[keep]
            if not len(f):
                return
            if len(f) > MOST:
                self.is_open = True
                return
        order = np.lexsort((low, f))
        f, low = f[order], low[order]
        begins = np.flatnonzero(np.append(True, (f[1:] != f[:-1]) | (low[1:] > low[:-1] + width)))
        for begin, end in zip(begins, [*begins[1:], len(f)], strict=True):
            yield self.families[f[begin]], float(low[begin]), float(low[end - 1] + width)

    def _may_hold(self, f: Ints, u: Floats, width: float) -> Bools:
        """Which parts about u may hold a root with a free sight.

        ``half`` is how far goals are from the middle one, ``turn`` bounds how far normals are from its
        normal, rounding included: D, of size d, is off by 2 h, and n by 14 h / g, as in `last_sights`.
        """
        rest, grain, table = self.rest, self.rest.grain, self._table
        q, speed = table.goals(f, u), table.speed[f]
        half = speed * width / 2
        d = q - table.center[f]
        size, radius = np.hypot(*d.T), np.abs(table.turn[f])
        square = size**2 - radius**2
        # Along the piece g^2 grows by 2 D t, where t is the unit tangent, which turns as the piece does.
        drift = np.abs((d * table.tangents(f, q)).sum(axis=1)) + half * (1 + size * table.curvature[f])
        least = square - 2 * drift * half - 16 * grain * (size + half + radius)
        gap = np.sqrt(np.maximum(square, 0.0))
        with np.errstate(all="ignore"):
            turn = np.where(least > 0, half / np.sqrt(least) + 16 * grain / np.sqrt(least), np.inf)
            n = table.turn[f][:, None] * d + gap[:, None] * _left(d)
            n /= (size**2)[:, None]
        own = table.own[f] != 0
        if own.any():
            n[own] = table.own_normals(f[own], u[own])
            turn[own] = (np.abs(table.sweep[f]) * width / 4)[own] + 2.0**-44
        may = own | (size + half + 4 * grain >= radius)
        off = q[:, 0] - rest.float_x
        may &= np.abs(off) <= rest.reach + half + grain
        value = (rest.reach * n[:, 1]) ** 2 - off**2
        with np.errstate(invalid="ignore"):
            # Of G' = 2 R^2 n_y n_y' - 2 (q_x - X) q_x', both factors at their greatest.
            change = rest.reach**2 * (np.abs(n[:, 1]) + turn) * turn + (np.abs(off) + 2 * half) * (
                half + grain
            )
            may &= ~(np.abs(value) > 2.1 * (change + rest.reach * grain))
        steep = np.abs(n[:, 1]) - turn
        clear = may & (steep > 0)
        with np.errstate(all="ignore"):
            longest = (np.abs(off) + half + grain) / steep
            error = 2 * (half + grain + longest * turn) / steep + grain
            length = np.abs(off / n[:, 1])
            y = q[:, 1] + n[:, 0] * off / n[:, 1]
            sense = -np.sign(off * n[:, 1])
            e = np.stack((n[:, 1], -n[:, 0]), axis=1) * sense[:, None]
            along = -(e * d).sum(axis=1)
            slack = 2 * (half + grain + size * turn) + error
            misses = (y + error < rest.low) | (y - error > rest.high)
            misses |= (along < -slack) | (along > length + 2 * slack)
        may &= ~(clear & misses)
        clear &= may
        p = np.stack((np.full(len(u), rest.float_x), y), axis=1)
        may[clear] = ~self.walls.block(p[clear], q[clear], error[clear] + half[clear] + grain)
        return np.asarray(may)

    # -- balls -------------------------------------------------------------------------------------

    def _first_in(self, family: _TouchingSights, low: arb, high: arb, halvings: int) -> LineOfSight | None:
        """A free sight at a root of G between two parameters."""
        self._left -= 1
        if sign(self._gain(family, low.union(high))):
            return None
        _, slope, bend = self._values(family, low.union(high))
        if sign(slope):
            return self._at_root(family, low, high)
        if sign(bend):
            return self._beside_extremum(family, low, high)
        if not halvings or self._left < 0:
            self.is_open = True
            return None
        middle = arb(((low + high) / 2).mid())
        return self._first_in(family, low, middle, halvings - 1) or self._first_in(
            family, middle, high, halvings - 1
        )

    def _beside_extremum(self, family: _TouchingSights, low: arb, high: arb) -> LineOfSight | None:
        """A free sight at a root of G where G has one extremum at most: it is monotonous on either side."""
        slopes = [sign(self._values(family, u)[1]) for u in (low, high)]
        if slopes[0] * slopes[1] > 0:
            return self._at_root(family, low, high)
        top = self._root(family, low, high, 1) if all(slopes) else high if slopes[0] else low
        return self._at_root(family, low, top) or self._at_root(family, top, high)

    def _at_root(self, family: _TouchingSights, low: arb, high: arb) -> LineOfSight | None:
        """The sight at the only root of G between two parameters, if there is one and the sight is free."""
        ends = [sign(self._gain(family, u)) for u in (low, high)]
        if ends[0] * ends[1] > 0:
            return None
        u = self._root(family, low, high, 0) if all(ends) else high if ends[0] else low
        return self._sight(family, u)

    def _root(self, family: _TouchingSights, low: arb, high: arb, order: int) -> arb:
        """The root of G, or of G', between parameters where it has different signs, and none of its slope."""
        u = low.union(high)
        while True:
            middle = arb(u.mid())
            newton = middle - self._values(family, middle)[order] / self._values(family, u)[order + 1]
            narrower = u.intersection(newton)
            if not narrower.rad() < u.rad() / 2:
                return narrower
            u = narrower

    def _values(self, family: _TouchingSights, u: arb) -> tuple[arb, arb, arb]:
        """G, G' and G'' at all parameters of a ball; no numbers where g may be 0."""
        try:
            series = self._gain(family, arb_series([u, 1], prec=3))
        except ValueError:  # Series are not divided by what may be 0.
            return arb("nan"), arb("nan"), arb("nan")
        return series[0], series[1], 2 * series[2]

    def _gain(self, family: _TouchingSights, u: Any) -> Any:
        """G at a parameter, a ball or a series."""
        qx, _, _, ny, _ = self._line(family, u)
        off = qx - self.rest.x
        return ny * ny * (self.rest.radius * self.rest.radius) - off * off

    def _line(self, family: _TouchingSights, u: Any) -> tuple[Any, ...]:
        """q, n, and the way from q to the post, at a parameter that is a ball or a series."""
        wall, (post, turn) = self.rest.targets[family.piece], family.touch
        if wall.center is None:
            chord = wall.end.minus(wall.start)
            qx, qy = u * chord.x + wall.start.x, u * chord.y + wall.start.y
        else:
            radial, angle = wall.start.minus(wall.center), u * wall.sweep
            cosine, sine = angle.cos(), angle.sin()
            qx = cosine * radial.x - sine * radial.y + wall.center.x
            qy = sine * radial.x + cosine * radial.y + wall.center.y
        dx, dy = qx - post.at.x, qy - post.at.y
        if family.own:
            tangent = wall.germ(post.at).way
            half = (u if family.own > 0 else u - 1) * (wall.sweep / 2)
            cosine, sine = half.cos(), half.sin()
            size = family.own / wall.radius
            nx = (sine * tangent.x + cosine * tangent.y) * -size
            ny = (cosine * tangent.x - sine * tangent.y) * size
        else:
            size = dx * dx + dy * dy
            square = size - turn * turn
            gap = (square.nonnegative_part() if isinstance(square, arb) else square).sqrt()
            nx, ny = (dx * turn - dy * gap) / size, (dy * turn + dx * gap) / size
        return qx, qy, nx, ny, (dx, dy)

    def _sight(self, family: _TouchingSights, u: arb) -> LineOfSight | None:
        """The sight to the goal at a parameter, if its post is on the way and it is free."""
        rest = self.rest
        qx, qy, nx, ny, (dx, dy) = self._line(family, u)
        off = qx - rest.x
        sense = sign(off) * sign(ny)
        if not sense:
            return None
        place, goal = rest.place(qy + nx * off / ny), BallPoint(qx, qy)
        # From the goal along (n_y, -n_x), reversed if that leads away from the line.
        along = (ny * dx - nx * dy) * sense
        if sign(along) < 0 or sign(abs(off / ny) - along) < 0:
            return None
        return LineOfSight(place, goal) if rest.sees(place, goal) else None


def _is_same_circle(a: Wall, b: Wall) -> bool:
    assert a.center is not None and b.center is not None
    return coincide(a.center, b.center) and not sign(a.square - b.square)
