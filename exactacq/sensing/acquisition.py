"""Where on a leg an obstacle becomes whole: the place at which the last gap in what is known of it closes.

What is known is a union of closed intervals that grows, so the place is one of finitely many candidates. They
are bisected: at a place with a rational parameter between two neighbours, the obstacle is whole or not. The
first candidates are the places where families of views begin and end. Between two of these an end of a gap
stays where it is, or moves until the gap closes at another end: so the next candidates are the places from
which the ends of the gaps that are left are seen. Both ends of a gap move where the range leaves the far part
of a concave arc: they meet where the circle of the range touches the arc from inside.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import hypot, inf

from flint import fmpq

from exactacq.cached import cached_property
from exactacq.geometry.constructions import put_around
from exactacq.geometry.curves import Arc
from exactacq.geometry.intersections import contacts
from exactacq.geometry.interval_union import EMPTY, Cover
from exactacq.geometry.points import Point
from exactacq.numbers.between import rational_between
from exactacq.numbers.float_bounds import float_ball
from exactacq.numbers.rationals import ends
from exactacq.numbers.real import Real
from exactacq.sensing.leg_facts import rays_along
from exactacq.sensing.leg_views import Share, Shares
from exactacq.sensing.legs import Leg, Place
from exactacq.visibility.place_facts import NOTHING_KNOWN, PlaceFacts

BITS = 64
"""Precision of the balls that part places: that of late numbers, so none is made."""


@dataclass(frozen=True, slots=True)
class Bracket:
    """A part of a leg at whose start an obstacle is not whole, and at whose end it is.

    ``known`` is what is known at the start.
    """

    leg: Leg
    known: ChainMap[int, Cover]


class Acquisition:
    """Obstacle *k*, which is whole after a leg; *before* is known at its start, with the view from there."""

    def __init__(self, shares: Shares, k: int, before: ChainMap[int, Cover]) -> None:
        self.k, self.before, self._every = k, before, shares
        # All other edges are known all over before the last of these is.
        self._last = shares.last_shown(k, before)
        edges, (self._low, self._high), _ = self._last
        self._targets = [target for target in shares.targets.of[k] if target.edge in edges]
        self._reaching: list[Share] = []
        self._at_range: list[tuple[Point, int, Point]] = []

    @cached_property
    def shares(self) -> Shares:
        """What the leg shows of the edges that may be the last, as far as it is not known before."""
        return self._every.teaching(self.k, self.before, self._last.edges)

    def place(self) -> Place:
        """The first place at which the obstacle is whole."""
        leg = self._every.leg
        if self._is_whole(self.before):
            return leg.first, leg.start
        bracket = Bracket(leg, self.before)
        if self._last.along is not None:
            # Before, the robot is behind that edge; there it sees all of it.
            place = self._every.place_of(self._last.along)
            if len(self._last.edges) == 1:
                return place
            if place[1].rational is not None:
                known = self._partly_known(leg.upto(*place))
                if known is None:
                    return place
                bracket = Bracket(leg.between(place, (leg.last, leg.end)), known)
        _, bracket = self._closing(self._candidates(bracket), bracket)
        cluster, bracket = self._closing(self._candidates(bracket, self._at_gaps(bracket)), bracket)
        # What balls cannot part is compared here, and only here; with an end of the leg too if it is close.
        here = [u for u, _ in cluster]
        for bound, side in ((leg.first, 1), (leg.last, -1)):
            if any(u is bound for u in here):
                cluster = [p for p in cluster if leg.order(p[0], bound) in (0, side)]
        cluster.sort(key=lambda place: place[0], reverse=not leg.ahead)
        distinct = [p for n, p in enumerate(cluster) if n == 0 or leg.order(p[0], cluster[n - 1][0]) > 0]
        (place,), _ = self._closing([[p] for p in distinct], bracket)
        return place

    def facts(self, place: Point) -> PlaceFacts:
        """What is known of the place that was found, by the ends of gaps that close there.

        They are seen along rays, or as far away as the range.
        """
        table = self._every.complex.table
        views = (view for view in self._reaching if view.source.start is place)
        rays = [ray for view in views for ray in rays_along(table, view, place)]
        rim = [(e, point) for at, e, point in self._at_range if at is place]
        return PlaceFacts(rays, rim=rim) if rays or rim else NOTHING_KNOWN

    def _closing(self, clusters: list[list[Place]], bracket: Bracket) -> tuple[list[Place], Bracket]:
        """The first cluster of places after which the obstacle is whole, and the bracket around it, bisected.

        The clusters are in the order of the leg.
        """
        leg = self.shares.leg
        low, high, known = 0, len(clusters) - 1, bracket.known
        begin, end = (bracket.leg.first, bracket.leg.start), (bracket.leg.last, bracket.leg.end)
        while low < high:
            middle = (low + high) // 2
            u = between(clusters[middle], clusters[middle + 1])
            here = Real(u), leg.rail.point(u)
            partly = None if self._is_late(u) else self._partly_known(leg.upto(*here))
            if partly is None:
                high, end = middle, here
            else:
                low, begin, known = middle + 1, here, partly
        return clusters[low], Bracket(leg.between(begin, end), known)

    def _is_late(self, u: fmpq) -> bool:
        """Whether bounds tell that the obstacle is whole before a place."""
        if self.shares.leg.ahead:
            return self._high < inf and u > as_fraction(self._high)
        return self._low > -inf and u < as_fraction(self._low)

    def _partly_known(self, part: Leg) -> ChainMap[int, Cover] | None:
        """What is known after the beginning of the leg; None if the obstacle is whole there.

        The view from its end is taken only if the families leave a gap.
        """
        shares = self.shares.cut(part)
        learned = shares.taught_between(self.before)
        known = ChainMap(learned, *self.before.maps)
        if self._is_whole(known):
            return None
        shares.add_views_from_ends(learned, self.before)
        return None if self._is_whole(known) else known

    def _is_whole(self, covers: ChainMap[int, Cover]) -> bool:
        return all(target.is_in(covers.get(target.edge, EMPTY)) for target in self._targets)

    def _at_gaps(self, bracket: Bracket) -> Iterator[Place]:
        """Where families show the end of a gap, it or its arc comes into range, or the leg reaches it."""
        shares, k, leg = self.shares, self.k, bracket.leg
        corners: set[int] = set()
        for e, span, _ in self._targets:
            curve = shares.complex.table.curves[e]
            if isinstance(curve, Arc) and not curve.ccw:
                rest = shares.complex.range.radius - curve.radius
                if rest.sign() > 0:
                    yield from _at_distance(leg, curve.center, rest * rest)
            for gap in bracket.known.get(e, EMPTY).gaps(span):
                for u, point in ((gap.low, gap.start), (gap.high, gap.end)):
                    for view in shares.reaching(k, e, u, point):
                        self._reaching.append(view)
                        yield view.source.low, view.source.start
                    corner = self._corner(e, point)
                    if corner not in corners:
                        for place in self._in_range(leg, e, point):
                            self._at_range.append((place[1], e, point))
                            yield place
                    if corner is not None:
                        # It may end the gaps of two edges.
                        corners.add(corner)
                    if e == leg.edge:
                        yield u, point

    def _candidates(self, bracket: Bracket, at_gaps: Iterable[Place] = ()) -> list[list[Place]]:
        """The places of a bracket, in its order, where a family begins or ends, and its end; in clusters.

        With those *at gaps* the last gap closes at one of them. Places that balls cannot part form a cluster:
        most are one place, found in several ways.
        """
        shares, k, leg = self.shares, self.k, bracket.leg
        found: list[Place] = [(leg.first, leg.start), (leg.last, leg.end), *at_gaps]
        for share in shares.of[k]:
            for end in (share.family.first, share.family.last):
                found.append((end.places[share.side], end.points[share.side]))
        for _, part in shares.ends.get(k, ()):
            found += [(part.low, part.start), (part.high, part.end)]
        groups = clusters(found)
        first, last = (
            next(n for n, cluster in enumerate(groups) if any(u is bound for u, _ in cluster))
            for bound in (leg.span.low, leg.span.high)
        )
        inside = groups[first : last + 1] if leg.ahead else groups[first : last + 1][::-1]
        # At its start the obstacle is not whole; its end is no candidate if it was put between two of them.
        if len(inside) > 1 and len(inside[0]) == 1:
            inside = inside[1:]
        if len(inside) > 1 and len(inside[-1]) == 1 and leg.last is not shares.leg.last:
            inside = inside[:-1]
        return self._around(inside)

    def _around(self, groups: list[list[Place]]) -> list[list[Place]]:
        """Clusters in order without those that bounds exclude; one is left on each side, to look between."""
        places = [[_enclosure(u) for u, _ in group] for group in groups]
        low, high = self._low, self._high
        early = [low > -inf and max(top for _, top in some) < as_fraction(low) for some in places]
        late = [high < inf and min(bottom for bottom, _ in some) > as_fraction(high) for some in places]
        before, after = (early, late) if self.shares.leg.ahead else (late, early)
        first = max((n for n, is_before in enumerate(before) if is_before), default=0)
        last = next((n for n, is_after in enumerate(after) if is_after), len(groups) - 1)
        return groups[first : last + 1]

    def _corner(self, e: int, point: Point) -> int | None:
        """The number of a place of an edge, if it is one of the edge's ends, as a vertex."""
        table = self.shares.complex.table
        curve = table.curves[e]
        return e if point is curve.start else table.following[e] if point is curve.end else None

    def _in_range(self, leg: Leg, e: int, point: Point) -> Iterator[Place]:
        """The places of a leg that are as far from a point of an edge as the range."""
        range_ = self.shares.complex.range
        least, most = distance_bounds(leg.box, point)
        if most < range_.below or least > range_.above:
            return
        for view in self.shares.end_views:
            if view.is_at_range(e, point):
                put_around(point, view.place, range_.square)
        yield from _at_distance(leg, point, range_.square)


def _at_distance(leg: Leg, point: Point, square: Real | fmpq) -> Iterator[Place]:
    """The places on the whole curve of a leg at a squared distance from a point: as families find them too.

    Of an arc about the point it is where the arc begins.
    """
    for contact in contacts(leg.rail.curve, Arc.circle(point, square)):
        yield leg.rail.parameter(contact.start), contact.start


def distance_bounds(box: tuple[float, float, float, float], point: Point) -> tuple[float, float]:
    """Bounds of the distances from a point to the places of a box; nothing late is made.

    A difference of coordinates of size m has an error of 2^-53 times 2 m beside that of the coordinates
    themselves; the hypotenuse of two adds less than 2^-52 of itself, which is at most 3 m. All that is less
    than 2^-48 m and the coordinates' errors.
    """
    (x, off_x), (y, off_y) = float_ball(point.x), float_ball(point.y)
    left, low, right, high = box
    size = max(abs(x), abs(y), *map(abs, box))
    slack = off_x + off_y + 2.0**-48 * size
    least = hypot(max(left - x, x - right, 0.0), max(low - y, y - high, 0.0))
    most = hypot(max(x - left, right - x), max(y - low, high - y))
    return least - slack, most + slack


def clusters(places: Iterable[Place]) -> list[list[Place]]:
    """Places of a rail from low to high; those whose parameters balls do not part are together.

    Within a cluster they are in no order; a parameter that comes again is left out.
    """
    enclosed = [(_enclosure(place[0]), place) for place in places]
    enclosed.sort(key=lambda item: item[0][0])
    found: list[list[Place]] = []
    reached: fmpq | None = None
    for (low, high), place in enclosed:
        if reached is not None and low <= reached:
            if not any(place[0] is u for u, _ in found[-1]):
                found[-1].append(place)
                reached = max(reached, high)
        else:
            found.append([place])
            reached = high
    return found


def between(one: Sequence[Place], other: Sequence[Place]) -> fmpq:
    """A rational between two clusters; single places may be closer than balls part."""
    if len(one) == len(other) == 1:
        (low, _), (high, _) = sorted((*one, *other), key=lambda place: place[0])
        return rational_between(low, high)
    a, b = ([_enclosure(u) for u, _ in cluster] for cluster in (one, other))
    a, b = (a, b) if a[0] < b[0] else (b, a)
    return rational_between(Real(max(high for _, high in a)), Real(min(low for low, _ in b)))


def as_fraction(bound: float) -> fmpq:
    """A finite float as it is."""
    return fmpq(*bound.as_integer_ratio())


def _enclosure(u: Real) -> tuple[fmpq, fmpq]:
    """Rational bounds, equal for what is seen to be rational."""
    if not u.is_late and u.rational is not None:
        return u.rational, u.rational
    return ends(u.ball(BITS))
