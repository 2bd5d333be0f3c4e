"""Whether an obstacle can be seen again from the rest of a line of the sweep, as far as the map shows.

The visible pairs (place on the line, point of the obstacle) form a closed set. If it has a pair beyond the
start, then in the pair farthest along the line neither point can be moved on (extremal principle):

- the place is the end of the line or on a known piece, or the target is an end of a piece, and the line of
  sight touches a feature or is as long as the range;
- the line of sight touches two features (a corner, a lone end, a convex arc, the target's own too);
- it is as long as the range and perpendicular to the target, or touches one feature;
- it runs along the line itself.

Floats list these candidates and drop what is certainly blocked or out of range; what is left is decided
exactly. The lengths of lines of sight that touch one feature are bounded between neighbouring lines through
two features, where nothing changes. Where bounds do not part them from the range, a polynomial tells which
are as long (`at_range`, in this folder).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from itertools import chain, pairwise

import numpy as np
from flint import arb, fmpq
from numpy.typing import NDArray

from exactacq.errors import Undecided
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import Touched, contacts, line_contacts, line_points
from exactacq.geometry.points import Point, distance_sq
from exactacq.numbers.between import rational_between
from exactacq.numbers.real import Real, rational
from exactacq.strategies.seed_spreader.horizon import Horizon
from exactacq.strategies.seed_spreader.hulls import hull
from exactacq.strategies.seed_spreader.prediction.at_range import ordinates_at_range
from exactacq.strategies.seed_spreader.prediction.pieces import (
    ANGLE,
    KnownFeature,
    LineCell,
    Lines,
    Pieces,
    cross,
    features_of,
)
from exactacq.strategies.seed_spreader.prediction.proposals import Proposals
from exactacq.strategies.seed_spreader.prediction.sight import (
    Sights,
    VerticalWalk,
    growth,
    unique,
)
from exactacq.strategies.seed_spreader.range_thresholds import nearest_point, thresholds

UP = Point(0, 1)
COARSE, FINE = 8, 32
"""How many places of the walk, and points of each target, the first two grids of trials have, less one."""
TRIES = 6
"""How many lines of sight of a grid are tried exactly."""
FEW, MANY = 50, 2000
"""Into how many stretches a part of the walk is divided to prove that lines about a feature are too long:
before a polynomial is solved, and where there is none."""


@np.errstate(over="ignore")  # A bound that overflows is infinite, and decides nothing.
def sees_later(
    x: fmpq,
    start: Real,
    stop: Real | fmpq,
    targets: Sequence[Curve],
    blockers: Callable[[Sequence[float]], Sequence[Curve]],
    radius: fmpq,
    points: Sequence[Point] = (),
    including: bool = False,
) -> bool:
    """Whether from a place (x, y), y from *start* to *stop*, a point of a target can be seen.

    The start is excluded, unless *including*; the stop belongs to the walk.

    *blockers* gives the known pieces of boundaries in a box, the blocked side on their left; the targets are
    some of them, *points* single known points of the same obstacle. A point is seen within the radius if the
    segment to it nowhere enters the known blocked side; it may touch. Raises `Undecided` where lines of sight
    past one irrational feature come down to exactly the range, which can be neither found nor excluded.
    """
    if not including and Real(stop).compare(start) == 0:
        return False
    walk = VerticalWalk(x, start, stop, radius, including)
    pieces = [*targets, *(Segment(point, point) for point in points)]
    if Horizon(x, walk.sense > 0, pieces, radius).order(start) < (0 if including else 1):
        # Whatever is in the way: nothing is in reach.
        return False
    goals = [curve for curve in targets if walk.may_reach(hull(curve))]
    dots = [point for point in points if walk.may_reach((*point.xy, *point.xy))]
    if not goals and not dots:
        return False
    hulls = [hull(curve) for curve in goals] + [(*point.xy, *point.xy) for point in dots]
    field = walk.field(hulls)
    corridor = walk.corridor(hulls, field)
    known = list(unique([*goals, *(curve for curve in blockers(field) if corridor.may_meet(hull(curve)))]))
    return _Candidates(walk, known, len(list(unique(goals))), dots, field).run()


# -- the search ------------------------------------------------------------------------------------


class _Candidates:
    """All candidates; the first *count* of the known pieces are targets."""

    def __init__(
        self,
        walk: VerticalWalk,
        known: Sequence[Curve],
        count: int,
        dots: Sequence[Point],
        field: Sequence[float],
    ) -> None:
        self.walk, self.known, self.dots = walk, known, dots
        self.targets = known[:count]
        size = max(walk.reach, *(abs(value) for value in field))
        far = max((abs(v) for c in known for v in hull(c)), default=0.0)
        self.pieces = Pieces(known, max(size, far))
        self.sights = Sights(self.pieces)
        self.low, self.high = max(walk.low, field[1]), min(walk.high, field[3])

    def run(self) -> bool:
        """Proposals first, then all candidates, from the cheapest."""
        stands = self._stands()
        if stands is None or self._sees_from_grid(COARSE) or self._sees_from_grid(FINE):
            return True
        if any(self._is_seen(p, q) for p, q in chain(self._along_line(stands), self._at_range(stands))):
            return True
        features = [*features_of(self.pieces, set(range(len(self.targets))))]
        features += [KnownFeature(point, goal=True) for point in self.dots]
        features += stands
        fixed = [
            self.walk.start,
            Real(self.walk.stop),
            *(stand.place.y for stand in stands),
        ]
        proposals = Proposals(
            self.pieces,
            features,
            range(len(self.targets)),
            float(self.walk.x),
            (self.low, self.high),
            self.walk.reach,
            [float(y) for y in fixed],
        )
        return _LineBatch(self, proposals, fixed).see()

    def _is_seen(self, p: Point, q: Point, on: Touched = ()) -> bool:
        """Whether a point of the obstacle can be seen from a place, and this belongs to the walk.

        *on* is what the line through the two is known to touch.
        """
        if not self._may_be_seen(p, q):
            return False
        near = distance_sq(p, q).compare(self.walk.radius * self.walk.radius) <= 0
        return near and self.walk.passes(p.y) and self.sights.is_free(p, q, on)

    def _may_be_seen(self, p: Point, q: Point) -> bool:
        slack, (x, y), (u, v) = self.pieces.slack, p.xy, q.xy
        if not self.low - slack <= y <= self.high + slack or np.hypot(u - x, v - y) > self.walk.reach + slack:
            return False
        a, b, error = np.array([[x, y]]), np.array([[u, v]]), np.array([slack])
        return not self.pieces.block(a, b, error)[0]

    def cut(self, y: Real) -> Real:
        """An ordinate, or the nearest one from which something may be in reach."""
        low, high = self.low - self.pieces.slack, self.high + self.pieces.slack
        if y.compare(low) < 0:
            return Real(rational(low))
        return Real(rational(high)) if y.compare(high) > 0 else y

    def _stands(self) -> list[KnownFeature] | None:
        """The end of the walk and its contacts with known pieces; None if one is a target's point."""
        walk, pieces = self.walk, self.pieces
        found = [KnownFeature(Point(walk.x, walk.stop), stand=True)]
        if any(dot.x.compare(walk.x) == 0 and walk.passes(dot.y) for dot in self.dots):
            return None
        origin = Point(walk.x, 0)
        for k, curve in enumerate(self.known):
            low, _, high, _ = hull(curve)
            if not low - pieces.slack <= float(walk.x) <= high + pieces.slack:
                continue
            ys = line_contacts(origin, UP, curve)
            if k < len(self.targets) and self._meets(ys, isinstance(curve, Segment)):
                return None
            for y in ys:
                if walk.passes(y):
                    found.append(self._stand(k, Point(walk.x, y)))
        return found

    def _meets(self, ys: Sequence[Real], straight: bool) -> bool:
        """Whether the walk meets a target: at ordinates, between which a segment lies on the line."""
        walk = self.walk
        if any(walk.passes(y) for y in ys):
            return True
        along = straight and len(ys) == 2
        return along and min(ys).compare(walk.stop) <= 0 and max(ys).compare(walk.stop) >= 0

    def _stand(self, k: int, place: Point) -> KnownFeature:
        pieces, curve = self.pieces, self.known[k]
        i = j = k
        on: tuple[int, ...] = (k,)
        if place == curve.start and pieces.before[k] >= 0:
            i = int(pieces.before[k])
            on = (i, k)
        elif place == curve.end and pieces.after[k] >= 0:
            j = int(pieces.after[k])
            on = (k, j)
        elif place == curve.start or place == curve.end:
            return KnownFeature(place, stand=True, on=on)
        at = np.array([place.xy])
        (leave,), (back,) = pieces.tangents(np.array([j]), at), -pieces.tangents(np.array([i]), at)
        return KnownFeature(place, tuple(leave.tolist()), tuple(back.tolist()), stand=True, on=on)

    # -- proposals -------------------------------------------------------------------------------------

    def _sees_from_grid(self, n: int) -> bool:
        """Whether some of a grid of lines of sight is free: most walks that see something are told here."""
        walk, shares = self.walk, _inner_shares(n)
        # From the far end on.
        steps = range(n, 0, -1) if walk.sense > 0 else range(n)
        if not self.targets:
            return False
        ends = [(rail, u) for rail in map(Rail, self.targets) for u in _parameters(rail, shares)]
        q = np.concatenate([_spots(curve, shares) for curve in self.targets])
        leave = self.pieces.tangents(np.repeat(np.arange(len(self.targets)), n + 1), q)
        tries = TRIES
        for y in (rational(self.low + (self.high - self.low) * (k / n)) for k in steps):
            p = np.array([float(walk.x), float(y)])
            size = np.hypot(*(q - p).T)
            free = np.flatnonzero((size < walk.reach * (1 - 1e-6)) & (cross(leave, p - q) < -ANGLE * size))
            free = free[~self.pieces.block(np.tile(p, (len(free), 1)), q[free], np.zeros(len(free)))]
            for rail, u in (ends[k] for k in free[:: -walk.sense][:tries]):
                if self._is_seen(Point(walk.x, y), rail.point(rational(u))):
                    return True
            tries -= min(tries, len(free))
            if not tries:
                break
        return False

    # -- lines of sight along the walk's own line --------------------------------------------------

    def _along_line(self, stands: Sequence[KnownFeature]) -> Iterator[tuple[Point, Point]]:
        """From the places of the walk that are nearest to known points on its line, before or beyond it.

        Those before it are seen from just after the start if from anywhere, as free and short as from there.
        """
        walk, origin = self.walk, Point(self.walk.x, 0)
        ends = [Point(walk.x, y) for curve in self.targets for y in self._contacts(curve, origin)]
        ends += [point for point in self.dots if point.x.compare(walk.x) == 0]
        for q in ends:
            if q.y.compare(walk.stop) == walk.sense:
                yield Point(walk.x, walk.stop), q
                continue
            spare = walk.radius - (q.y - walk.start) * -walk.sense
            if walk.including or spare.sign() <= 0:
                yield Point(walk.x, walk.start), q
                continue
            after = [(stand.place.y - walk.start) * walk.sense for stand in stands]
            step = min([spare, *(y for y in after if y.sign() > 0)]) * fmpq(1, 2)
            yield Point(walk.x, walk.start + step * walk.sense), q

    def _contacts(self, curve: Curve, origin: Point) -> list[Real]:
        low, _, high, _ = hull(curve)
        slack, x = self.pieces.slack, float(self.walk.x)
        return line_contacts(origin, UP, curve) if low - slack <= x <= high + slack else []

    # -- lines of sight as long as the range -----------------------------------------------------------

    def _at_range(self, stands: Sequence[KnownFeature]) -> Iterator[tuple[Point, Point]]:
        """Candidates of the full length that have a closed form."""
        walk = self.walk
        for curve in self.targets:
            for y in thresholds(walk.x, curve, walk.radius):
                p = Point(walk.x, y)
                yield from ((p, q) for q in (curve.start, curve.end, nearest_point(curve, p)))
            if isinstance(curve, Arc) and curve.ccw:
                across = curve.center.x - walk.x
                square = walk.radius**2 + curve.radius_sq - across * across
                if square.sign() >= 0:
                    for rise in (square.sqrt(), -square.sqrt()):
                        p = Point(walk.x, curve.center.y + rise)
                        yield from ((p, q) for q in _tangent_points(p, curve) if curve.contains(q))
            for stand in stands:
                p = stand.place
                found = contacts(curve, Arc.circle(p, walk.radius**2))
                yield from ((p, q) for contact in found for q in (contact.start, contact.end))
        for q in self.dots:
            yield from ((Point(walk.x, y), q) for y in thresholds(walk.x, Segment(q, q), walk.radius))


def _inner_shares(n: int) -> NDArray[np.float64]:
    """Shares of a curve's parameters, n + 1 of them, near its ends too."""
    return np.clip(np.arange(n + 1) / n, 2.0**-10, 1 - 2.0**-10)


def _parameters(rail: Rail, shares: NDArray[np.float64]) -> list[float]:
    """Parameters of points inside a curve."""
    found: list[float] = (float(rail.top) * shares).tolist()
    return found


def _spots(curve: Curve, shares: NDArray[np.float64]) -> NDArray[np.float64]:
    """These points in floats, about."""
    if isinstance(curve, Segment):
        (ax, ay), (bx, by) = curve.start.xy, curve.end.xy
        return np.stack((ax + shares * (bx - ax), ay + shares * (by - ay)), axis=1)
    rail = Rail(curve)
    return np.array([rail.point(rational(u)).xy for u in _parameters(rail, shares)])


def _tangent_points(p: Point, arc: Arc) -> Iterator[Point]:
    """Where the tangents from a place touch an arc's circle."""
    for side in (1, -1):
        way = _way(p, Real(0), arc.center, arc.radius * side)
        if way is not None:
            yield p + way * (way.dot(arc.center - p) / way.norm_sq())


def _way(a: Point, turn: Real, b: Point, other: Real) -> Point | None:
    """The direction of the line that passes a at distance *turn* and b at distance *other*, on its left if
    these are negative: 0 for points, plus or minus a radius for circles. None if there is no such line."""
    d = b - a
    if not (turn.sign() or other.sign()):
        return d if d.x.sign() or d.y.sign() else None
    k = turn - other
    rest = d.norm_sq() - k * k
    if d.norm_sq().sign() == 0 or rest.sign() < 0:
        return None
    normal = d * k + d.left() * rest.sqrt()
    return -normal.left()


class _LineBatch:
    """Decides what the floats leave over of the lines that touch features."""

    def __init__(self, search: _Candidates, proposals: Proposals, fixed: Sequence[Real]) -> None:
        self.search, self.proposals, self.fixed = search, proposals, fixed
        self.walk = search.walk

    def see(self) -> bool:
        """Whether some line of sight is free."""
        lines, close = self.proposals.lines()
        sights = self.proposals.sights(lines)
        sights.sort(key=lambda sight: -sight.y * self.walk.sense)
        seen = set()
        for sight in sights:
            key = sight.i, sight.j, sight.piece, sight.goal, sight.target
            if key not in seen and self._sees_along(*key):
                return True
            seen.add(key)
        if any(self._sees_close(i, j) for i, j in close):
            return True
        return self._sees_in_cells(lines)

    # -- lines through two features --------------------------------------------------------------------

    def _shape(self, g: int) -> tuple[Point, Real]:
        """Centre and signed radius of a feature."""
        proposals = self.proposals
        shape = proposals.features[proposals.feature[g]].shape
        if isinstance(shape, Point):
            return shape, Real(0)
        return shape.center, shape.radius * (1 if proposals.turn[g] > 0 else -1)

    def _touched(self, i: int, j: int, piece: int) -> Touched:
        """What a line is known to touch by what it is made of."""
        known, proposals = self.search.known, self.proposals
        found: list[Point | Arc] = []
        for g in (i, j) if j >= 0 else (i,):
            feature = proposals.features[proposals.feature[g]]
            found.append(feature.shape)
            if len(feature.on) == 2:
                before, after = feature.on
                found += [known[before].end, known[after].start]
        if j < 0:
            curve = known[piece]
            found += [curve] if isinstance(curve, Arc) else [curve.start, curve.end]
        return found

    def _line(self, i: int, j: int, piece: int) -> tuple[Point, Point] | None:
        """Where a line meets the walk, and its direction; None if it does not exist or is parallel."""
        a, turn = self._shape(i)
        way: Point | None
        if j < 0:
            curve = self.search.known[piece]
            way = curve.tangent(a) if isinstance(curve, Arc) else curve.whole.direction
        else:
            way = _way(a, turn, *self._shape(j))
        if way is None or way.x.sign() == 0:
            return None
        if turn.sign():
            # `_way` gives a vector as long as the squared distance.
            a = a + way.left() * (turn / distance_sq(a, self._shape(j)[0]))
        return Point(self.walk.x, a.y + way.y * ((self.walk.x - a.x) / way.x)), way

    def _sees_along(self, i: int, j: int, piece: int, goal: int, target: int) -> bool:
        line = self._line(i, j, piece)
        if line is None or not self.walk.passes(line[0].y):
            return False
        p, way = line
        on = self._touched(i, j, piece)
        if target >= 0:
            found = line_points(p, way, self.search.known[target], on)
            return any(self.search._is_seen(p, q, on) for q in found)
        center, turn = self._shape(goal)
        if turn.sign():
            center = p + way * ((center - p).dot(way) / way.norm_sq())
            arc = self.proposals.features[self.proposals.feature[goal]].shape
            if isinstance(arc, Arc) and not arc.contains(center):
                return False
        return self.search._is_seen(p, center, on)

    def _sees_close(self, i: int, j: int) -> bool:
        """Whether a line of two touches is a free line of sight, where floats do not tell which line that is.

        The touches are too close, or the line seems to be the walk's own. Two arcs about one centre have no
        tangent in common, or all of them: these are found as those of one.
        """
        one, other = (self._shape(k)[0].rational for k in (i, j))
        if one is not None and one == other:
            return False
        goals = [k for k in (i, j) if self.proposals.goal[k]]
        targets = range(len(self.search.targets))
        return any(self._sees_along(i, j, -1, k, -1) for k in goals) or any(
            self._sees_along(i, j, -1, -1, k) for k in targets
        )

    # -- lines that touch one feature ------------------------------------------------------------------

    def _sees_in_cells(self, lines: Lines) -> bool:
        undecided, looked_at = None, set()
        for cell in self.proposals.cells(lines, self._is_point_of_line):
            if cell.target not in looked_at and self._is_on_line(cell.touch):
                looked_at.add(cell.target)
                if self._sees_on_line(cell.target):
                    return True
            if self._is_point_of_line(cell.touch):
                # Of the walk's own line alone, which was asked for.
                continue
            answer = self._sees_in(cell, lines)
            if answer:
                return True
            undecided = cell if answer is None else undecided
        if undecided is not None:
            x, y = self._shape(undecided.touch)[0].xy
            raise Undecided(
                f"whether an obstacle is seen later near ({float(self.walk.x)}, {undecided.low}): lines of "
                f"sight past what is known about ({x}, {y}) come down to the range, as far as can be told"
            )
        return False

    def _is_on_line(self, g: int) -> bool:
        """Whether a feature is a point of the walk's own line, or a circle that the line touches."""
        center, turn = self._shape(g)
        return bool(abs(center.x - self.walk.x) == abs(turn))

    def _is_point_of_line(self, g: int) -> bool:
        """Whether a feature is a point of the walk's line: from its places no other line goes past it."""
        return self._shape(g)[1].rational == 0 and self._is_on_line(g)

    def _sees_on_line(self, target: int) -> bool:
        """Whether the walk's own line is free where it is a range long."""
        x, reach = self.walk.x, self.walk.radius
        return any(
            self.search._is_seen(Point(x, y + offset), Point(x, y))
            for y in line_contacts(Point(x, 0), UP, self.search.known[target])
            for offset in (reach, -reach)
        )

    def _sees_in(self, cell: LineCell, lines: Lines) -> bool | None:
        """Whether a line of sight of a cell is free; None if that is not decided."""
        if cell.above:
            y = (cell.low + cell.high) / 2 if cell.sample is None else cell.sample
            sight = self._about(cell, Real(rational(y)))
            if sight is None or not self.search.sights.is_free(*sight):
                return False
            if cell.sample is not None and self.search._is_seen(*sight):
                return True
        return self._sees_between_bounds(cell, lines)

    def _about(self, cell: LineCell, y: Real) -> tuple[Point, Point] | None:
        """The line of sight of a cell from an ordinate; None for the walk's own line.

        That is the only line past a point of it, and one of two tangents of a circle that it touches.
        """
        p = Point(self.walk.x, y)
        way = _way(p, Real(0), *self._shape(cell.touch))
        if way is None or way.x.sign() == 0:
            return None
        found = line_contacts(p, way, self.search.known[cell.target])
        if not found:
            return None
        t = found[-1] if cell.branch or len(found) == 1 else found[0]
        return p, p + way * t

    def _sees_between_bounds(self, cell: LineCell, lines: Lines) -> bool | None:
        """Like `_sees_in`, by exact ordinates: those that bound the cell, or that floats cannot separate."""
        below, above = self._ordinates(cell.below, lines), self._ordinates(cell.above, lines)
        if cell.above and not (below and above):
            return None
        answer: bool | None = False
        for low, high in pairwise(sorted(map(self.search.cut, below + above))):
            if low.compare(high) == 0:
                continue
            y = Real(rational_between(low, high))
            sight = self._about(cell, y)
            if sight is None or not self.walk.passes(y) or not self.search.sights.is_free(*sight):
                continue
            ends = [(z, self._order(cell, z)) for z in (low, high)]
            if any(order == -1 for _, order in ends):
                return True
            tested = [(z, order is not None) for z, order in ends]
            in_range = self._is_in_range_between(cell, *tested, stretches=FEW)
            if in_range is None:
                in_range = self._comes_down_to_range(cell, *ends)
            if in_range is None:
                in_range = self._is_in_range_between(cell, *tested, stretches=MANY)
            if in_range:
                return True
            answer = answer if in_range is False else None
        return answer

    def _is_in_range_between(self, cell: LineCell, *ends: tuple[Real, bool], stretches: int) -> bool | None:
        """Whether a line of a cell between two ordinates is as short as the range; None if that is open.

        The ends are the lower and the upper ordinate, each with whether its line is known to be no shorter
        than the range: if lines grow from there on, all of them are longer.
        """
        radius, shape = self.walk.radius, self._shape(cell.touch)
        target = self.search.known[cell.target]
        open_ones, is_bounded = deque([ends]), True
        for _ in range(stretches):
            if not open_ones:
                return False if is_bounded else None
            (low, is_low_tested), (high, is_high_tested) = ends = open_ones.popleft()
            y = Real(rational_between(low, high))
            sight = self._about(cell, y)
            if sight is None:
                is_bounded = False
                continue
            square = distance_sq(*sight)
            if square.compare(radius**2) <= 0:
                return True
            length, rate = growth(Real(self.walk.x), (low, high), shape, target, square.sqrt())
            is_longer = length > arb(radius) or (rate > 0 and is_low_tested) or (rate < 0 and is_high_tested)
            if not is_longer:
                open_ones += [(ends[0], (y, True)), ((y, True), ends[1])]
        return None

    def _comes_down_to_range(self, cell: LineCell, *ends: tuple[Real, int | None]) -> bool | None:
        """Like `_is_in_range_between`, by all ordinates strictly between two from which a line is as long.

        Next to them, and where there are none, all lines are longer or all are shorter. The ends are given
        with their `_order`: if that is 0, the line there is one of those that are found.
        """
        (low, _), (high, _) = ends
        feature = self.proposals.features[self.proposals.feature[cell.touch]].shape
        target = self.search.known[cell.target]
        found = ordinates_at_range(self.walk.x, feature, target, self.walk.radius)
        if found is None:
            return None
        for z, order in ends:
            same = [y for y in found if y.overlaps(z)]
            if order == 0 and len(same) == 1:
                # What is left open by balls may be far to prove: the end may have another form.
                found = [y for y in found if y is not same[0]]
        inside = sorted(y for y in found if low.compare(y) < 0 < high.compare(y))
        bounds = [low, *inside, high]
        between = [Real(rational_between(a, b)) for a, b in pairwise(bounds) if a.compare(b)]
        orders = [self._order(cell, y) for y in (*between, *inside)]
        if any(order is not None and order <= 0 for order in orders):
            return True
        return None if None in orders else False

    def _order(self, cell: LineCell, y: Real) -> int | None:
        """-1, 0 or 1 as a line of a cell is shorter than the range, as long, or longer; None without one."""
        sight = self._about(cell, y)
        return None if sight is None else distance_sq(*sight).compare(self.walk.radius**2)

    def _ordinates(self, marks: Sequence[int], lines: Lines) -> list[Real]:
        found = (self._ordinate(mark, lines) for mark in marks)
        return [y for y in found if y is not None]

    def _ordinate(self, mark: int, lines: Lines) -> Real | None:
        if mark < 0:
            return self.fixed[-1 - mark]
        line = self._line(int(lines.i[mark]), int(lines.j[mark]), int(lines.piece[mark]))
        return None if line is None else line[0].y
