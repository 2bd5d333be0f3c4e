"""What is known of the view from a place because of how the place was found.

Where something comes into sight or goes out of it, the robot often stands on a line through two features, or
as far from something as the range. Its place may have numbers from which arithmetic cannot tell that. How it
was found does, and a line through features has simpler numbers than the way from the place to them.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TypeAlias

from flint import arb, fmpq

from exactacq.cached import cached_property
from exactacq.geometry.constructions import (
    put_around,
    put_on_normal,
    put_on_tangent,
    put_past_corner,
    touch_on_tangent,
)
from exactacq.geometry.coordinates import Vector, cross, dot, minus, raw
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.late import BITS, Balls, balls, from_to
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import CONCAVE, EdgeTable
from exactacq.visibility.line_balls import line
from exactacq.visibility.line_families import Sector

Touched: TypeAlias = "tuple[int, int]"
"""The number of a feature (see `exactacq.kernel.line_keys`), and 1 or -1 if it is a circle to the left or to
the right of the ray that touches it, 0 if it is a corner."""
Hold: TypeAlias = "tuple[int, int, int]"
"""An edge, the number of what the line to its point touches (see `line_keys`) or of the range, and a side."""


@dataclass(frozen=True, eq=False)
class Alignment:
    """A ray from a place along a line, in its direction or (*sense* -1) against it.

    *exact* gives a point of the line and its direction. If there is an ``anchor``, the line touches that
    feature there. Where it comes to edges, by their numbers, is ``met`` as far as it is known (it leaves a
    circle in another place), and where it touches circles are its ``feet``. ``lines`` are numbers of its line
    (see `exactacq.kernel.line_keys`), if they are known.
    """

    exact: Callable[[], tuple[Point, Point]]
    sense: int
    anchor: int | None
    touched: frozenset[Touched]
    met: Mapping[int, Point] = field(default_factory=dict)
    feet: Mapping[int, Point] = field(default_factory=dict)
    lines: frozenset[int] = frozenset()

    @cached_property
    def _line(self) -> tuple[Point, Point]:
        return self.exact()

    @property
    def contact(self) -> Point:
        """A point of the line, on the ray or behind the place."""
        return self._line[0]

    @cached_property
    def direction(self) -> Vector:
        """The ray's direction."""
        return raw(self._line[1] * self.sense)

    def tell(self, table: EdgeTable, place: Point) -> None:
        """Note at the place what the ray's line touches: that is the line from there to all that it meets."""
        corners = (table.starts[feature] for feature, side in self.touched if not side)
        for goal in (*corners, *self.met.values()):
            if goal is not place:
                self.tell_line(table, place, goal)

    def tell_line(self, table: EdgeTable, point: Point, origin: Point) -> None:
        """Tell a point of the ray what its line from another one touches."""
        for feature, side in self.touched:
            if side:
                put_on_tangent(point, origin, table.arc_on(feature).carrier, self.feet.get(feature))
            elif table.starts[feature] is not origin:
                put_past_corner(point, origin, table.starts[feature])

    def joined(self, other: Alignment) -> Alignment:
        """This form of the ray, with what another one tells of it too."""
        return replace(
            self,
            touched=self.touched | other.touched,
            met={**other.met, **self.met},
            feet={**other.feet, **self.feet},
            lines=self.lines | other.lines,
        )

    def touch(self, circle: int, center: Point) -> Point:
        """Where the ray touches a circle, given as a feature, about a centre."""
        if circle in self.feet:
            return self.feet[circle]
        if circle == self.anchor:
            return self.contact
        along = self._line[1]
        return self.contact + along * ((center - self.contact).dot(along) / along.norm_sq())


@dataclass(frozen=True, slots=True)
class PlaceFacts:
    """Facts about the view from one place.

    ``rays`` from it touch something. Exactly as far away as the range are the ends of sights that are held by
    one of ``holds``, and the points of edges in ``rim``, told apart as objects. ``tangent`` has the point in
    which the line of a straight edge, or the circle of some arcs, touches the circle of the range: by the
    edge, or the first of the arcs.
    """

    rays: Sequence[Alignment] = ()
    holds: Collection[Hold] = frozenset()
    rim: Sequence[tuple[int, Point]] = ()
    tangent: Mapping[int, Point] = field(default_factory=dict)

    def tell(self, table: EdgeTable, place: Point, square: fmpq) -> None:
        """Tell the place, by *square* the range, what is known of the lines from there to what it sees."""
        for ray in self.rays:
            ray.tell(table, place)
        for _, point in self.rim:
            put_around(place, point, square)
        for circle, point in self.tangent.items():
            put_around(place, point, square)
            curve = table.curves[circle]
            if isinstance(curve, Arc):
                put_on_normal(place, point, curve.carrier)

    def joined(self, other: PlaceFacts) -> PlaceFacts:
        """These facts and others of the same place."""
        if other is NOTHING_KNOWN or self is NOTHING_KNOWN:
            return self if other is NOTHING_KNOWN else other
        return PlaceFacts(
            [*self.rays, *other.rays],
            {*self.holds, *other.holds},
            [*self.rim, *other.rim],
            {**self.tangent, **other.tangent},
        )


NOTHING_KNOWN = PlaceFacts()


def by_touched(rays: Iterable[Alignment]) -> dict[Touched, Alignment]:
    """Rays from one place by what they touch: those that touch one thing are one, in the form of the last."""
    found: dict[Touched, Alignment] = {}
    for ray in rays:
        joined = ray
        for touched in ray.touched:
            if touched in found:
                joined = joined.joined(found[touched])
        found.update(dict.fromkeys(joined.touched, joined))
    return found


def tangents_from(
    table: EdgeTable, place: Balls, sector: Sector, t: Real, features: Sequence[int]
) -> Iterator[Alignment]:
    """The two rays from a place on the line of a sector at *t*, which touches *features*, its own first."""
    *_, u, v = line(sector, t.ball(BITS))
    return tangents_along(table, place, (u, v), sector, t, features)


def tangents_along(
    table: EdgeTable, place: Balls, direction: Balls, sector: Sector, t: Real, features: Sequence[int]
) -> Iterator[Alignment]:
    """Like `tangents_from`, if balls hold the line's direction."""
    return _alignments(table, place, direction, partial(sector.touch, t), features, features[0])


def tangents_at(sector: Sector, t: Real, circle: int) -> Iterator[Alignment]:
    """The two rays from a place of a circle, given as a feature, along its tangent: a line of a sector.

    The circle lies to the left of that line.
    """
    for sense in (1, -1):
        yield Alignment(partial(sector.touch, t), sense, circle, frozenset({(circle, sense)}))


def along_way(
    table: EdgeTable,
    place: Point,
    line: Segment,
    ends: tuple[Point, Point],
    features: Sequence[int],
    met: Mapping[int, Point],
) -> Iterator[Alignment]:
    """The two rays from a place on a straight way along it, whose *line* touches *features*.

    The way is free and has these *ends*: so where one lies on a straight edge or a convex arc, the line
    enters that there, which it does once. Ahead of the way edges are *met*.
    """
    along, (start, end) = line.end - line.start, ends
    feet: dict[int, Point] = {}
    for feature in filter(table.line_numbers.is_circle, features):
        if (foot := touch_on_tangent(start, end, table.arc_on(feature).carrier)) is not None:
            feet[feature] = foot
    here = [f for f, foot in feet.items() if foot is place]
    lines = frozenset(numbers_of_way(table, ends, features))
    for ray in _alignments(
        table, balls(place), balls(along), lambda: (line.start, along), features, None, here
    ):
        there = end if ray.sense > 0 else start
        convex = (e for e in table.edges_at(there) if table.kinds[e] != CONCAVE)
        known = {**(met if ray.sense > 0 else {}), **dict.fromkeys(convex, there)}
        # A line that touches a circle meets it there only.
        round_ = ((table.line_numbers.feature(e, True), e) for e in known if e in table.circles)
        touched = {circle: known[e] for circle, e in round_ if circle in features}
        yield replace(ray, met=known, feet=touched | feet, lines=lines)


def numbers_of_way(table: EdgeTable, ends: tuple[Point, Point], features: Iterable[int]) -> Iterator[int]:
    """Numbers of the line of two points that touches some features, as `names_by_circles` tells them."""
    start = balls(ends[0])
    return (number for number, _ in names_by_circles(table, start, from_to(start, balls(ends[1])), features))


def names_by_circles(
    table: EdgeTable, start: Balls, along: Balls, features: Iterable[int]
) -> Iterator[tuple[int, int]]:
    """Names (see `line_names`) of a line that touches some features: by each circle and another feature.

    Balls tell on which side a circle lies, and what comes first; where they leave that open it gives no name.
    """
    numbers = table.line_numbers
    circles, corners = list[tuple[int, int, arb]](), list[tuple[int, arb]]()
    for feature in features:
        if numbers.is_circle(feature):
            way = from_to(start, balls(table.arc_on(feature).center))
            circles.append((numbers.first_arc(feature), ball_sign(cross(along, way)), dot(along, way)))
        else:
            corners.append((feature, dot(along, from_to(start, balls(table.starts[feature])))))
    for n, (circle, side, at) in enumerate(circles):
        for vertex, place in corners:
            if (ahead := ball_sign(at - place)) and side:
                yield numbers.mixed(vertex, circle, side * ahead < 0), ahead
        for other, beyond, place in circles[:n]:
            if (ahead := ball_sign(place - at)) and side and beyond:
                sense = ahead if circle < other else -ahead
                yield numbers.tangent(circle, other, side * ahead, beyond * ahead), sense


def along_edge(table: EdgeTable, place: Point, e: int, near: Iterable[int]) -> Iterator[Alignment]:
    """The two rays from a place inside a straight edge along it, by what its line touches of some edges."""
    edge, numbers = table.curves[e], table.line_numbers
    start, along = raw(edge.start), minus(table.vertices[table.following[e]], table.vertices[e])
    features: dict[int, None] = {}
    for other in near:
        curve = table.curves[other]
        if isinstance(curve, Arc):
            height = cross(along, minus(raw(curve.center), start))
            if height * height == dot(along, along) * curve.radius_sq:
                features[numbers.feature(other, True)] = None
            if curve.full:
                continue
        for vertex in (other, table.following[other]):
            if not cross(along, minus(table.vertices[vertex], start)):
                features[vertex] = None
    way = Point(*along)
    yield from _alignments(table, balls(place), balls(way), lambda: (edge.start, way), [*features], None)


def _alignments(
    table: EdgeTable,
    place: Balls,
    direction: Balls,
    exact: Callable[[], tuple[Point, Point]],
    features: Sequence[int],
    anchor: int | None,
    here: Collection[int] = (),
) -> Iterator[Alignment]:
    """The two rays from a place along a line, each with those *features* that it touches.

    What is too near to the place for balls to tell on which ray it lies is left out. Of some circles it is
    known that they are touched just *here*, by both rays.
    """
    rays: dict[int, set[Touched]] = {1: set(), -1: set()}
    for feature in features:
        is_round = table.line_numbers.is_circle(feature)
        # The line touches a circle in the foot of its centre, so that both lie on one ray.
        way = from_to(place, balls(table.arc_on(feature).center if is_round else table.starts[feature]))
        for sense in (1, -1) if feature in here else (ball_sign(dot(way, direction)),):
            side = ball_sign(cross(direction, way)) * sense if is_round else 0
            if sense and bool(side) == is_round:
                rays[sense].add((feature, side))
    for sense, touched in rays.items():
        if touched:
            yield Alignment(exact, sense, anchor, frozenset(touched))
