"""Which curves in free space see a point, decided from the point's side by code of the audit's own.

From a rational point q every direction is a ray. The critical rays lead to ends of edges and curves, touch
arcs, or lead to where a curve passes the range. Between two of them nothing changes: a curve, which enters no
interior, is met by all rays of the cell or by none, within range or beyond, before or behind what blocks.
So a curve sees q if and only if it does along a critical ray or along one ray of each cell.

Floats with margins settle most pairs of a ray and a curve; the rest is decided exactly along the ray. No
code of `exactacq.visibility` or `exactacq.sensing` is used.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import accumulate, pairwise
from math import hypot
from typing import NamedTuple

import numpy as np
from flint import arb, fmpq

from exactacq.auditing.comparisons import BITS, passes
from exactacq.auditing.hits import (
    EPS,
    Bools,
    Floats,
    Hits,
    Ints,
    arc_hits,
    cross,
    segment_hits,
    surely_blocked,
)
from exactacq.auditing.rays import (
    TIE_BITS,
    Direction,
    clear_tangents,
    ray_along,
    rounded,
    surely_crosses,
    tangent_directions,
    unit_vector,
    with_cells,
)
from exactacq.cached import cached_property
from exactacq.geometry.box_index import BoxIndex, bounds
from exactacq.geometry.coordinates import Vector, raw
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import contacts, line_contacts
from exactacq.geometry.points import Location, Point
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import nearest_float, rational
from exactacq.numbers.real import Real
from exactacq.scene.scene import Scene

SOME_EDGES = 128
"""So many edges at a time are asked what they hide."""
MANY_RAYS = 64
"""Of so many critical rays it is worth while to leave out those to what is hidden."""


class Forms(NamedTuple):
    """What floats need of curves, wherever they are seen from; one row of each array for a curve.

    ``ends`` are numbers of points and ``circle`` those of circles of a `World`, -1 for segments. Arcs have a
    ``shape`` of radius, sense and whether it is full, and a ``chord`` from start to end.
    """

    boxes: Floats
    ends: Ints
    circle: Ints
    shape: Floats
    chord: Floats

    def rows(self, numbers: Ints) -> Forms:
        """Those of some of the curves."""
        return Forms._make(column[numbers] for column in self)

    def and_rows(self, other: Forms) -> Forms:
        """Those of these curves, followed by those of others."""
        return Forms._make(np.concatenate(pair) for pair in zip(self, other, strict=True))


class World:
    """The edges of a scene with their boxes, and the exact test whether a way is blocked."""

    def __init__(self, scene: Scene) -> None:
        self.obstacles = scene.obstacles
        self.edges: list[Curve] = [edge for obstacle in scene.obstacles for edge in obstacle.edges]
        self.owner = [obstacle.index for obstacle in scene.obstacles for _ in obstacle.edges]
        self.first = [0, *accumulate(len(obstacle.edges) for obstacle in scene.obstacles)]
        self.points: list[Point] = []
        self.coordinates: list[Vector] = []
        self.circles: list[Arc] = []
        self._numbers: dict[object, int] = {}
        self.forms = self.forms_of(self.edges)
        self.boxes = self.forms.boxes
        self.index = BoxIndex(self.boxes)

    def forms_of(self, curves: Sequence[Curve]) -> Forms:
        """What floats need of curves. Ends at one place have one number in ``points``, if that shows, and
        arcs of one circle have one in ``circles``.
        """
        ends = [(self._number(curve.start), self._number(curve.end)) for curve in curves]
        circle, shape, chord = [-1] * len(curves), np.zeros((len(curves), 3)), np.zeros((len(curves), 2))
        for k, curve in enumerate(curves):
            if isinstance(curve, Arc):
                key = curve.center.key, curve.radius_sq
                circle[k] = self._numbers.setdefault(key, len(self.circles))
                if circle[k] == len(self.circles):
                    self.circles.append(curve)
                shape[k] = rounded(curve.radius), 1 if curve.ccw else -1, curve.full
                along = curve.end - curve.start
                chord[k] = rounded(along.x), rounded(along.y)
        pairs = np.array(ends, dtype=np.int64).reshape(-1, 2)
        return Forms(bounds(curves), pairs, np.array(circle, dtype=np.int64), shape, chord)

    def _number(self, point: Point) -> int:
        number = self._numbers.setdefault(point.key, len(self.points))
        if number == len(self.points):
            self.points.append(point)
            self.coordinates.append(raw(point))
        return number

    def edges_of(self, i: int) -> list[int]:
        """Numbers of the edges of an obstacle."""
        return list(range(self.first[i], self.first[i + 1]))

    def blocker(
        self,
        origin: Point,
        direction: Point,
        upto: object,
        edges: Iterable[int] | None = None,
        starting: Collection[int] = (),
        ending: Collection[int] = (),
    ) -> tuple[int, Point] | None:
        """An obstacle and a point of its interior on the way to ``origin + upto direction``, or None.

        Exact: where the way meets no edge of an obstacle it does not change sides, so the middle between two
        contacts with it decides. *edges* are those that the way can meet; all edges near it if None. Those
        *starting* and *ending* the way are known to pass through its ends.
        """
        end = Real(upto)
        near = self.near(Segment(origin, origin + direction * end)) if edges is None else edges
        cuts: dict[int, list[Real]] = {}
        for e in near:
            met = line_contacts(origin, direction, self.edges[e])
            at_start = _single(met, Real(0)) if e in starting else None
            at_end = _single(met, end) if e in ending else None
            within = (t for t in met if t is not at_start and t is not at_end and 0 < t < end)
            cuts.setdefault(self.owner[e], []).extend(within)
        for k in sorted(cuts):
            for a, b in pairwise([Real(0), *sorted(cuts[k]), end]):
                if a != b:
                    middle = origin + direction * between(a, b)
                    if self.obstacles[k].locate(middle) is Location.INSIDE:
                        return k, middle
        return None

    def blocker_between(self, way: Segment) -> tuple[int, Point] | None:
        """Likewise on a segment that may begin and end on boundaries.

        To find the edges there first leaves no numbers to compare that are 0 or 1 in another form.
        """
        near = self.near(way)
        ends = (self.passing(place, near) for place in (way.start, way.end))
        return self.blocker(way.start, way.direction, 1, near, *ends)

    def near(self, way: Curve) -> list[int]:
        """The edges whose boxes meet that of a way."""
        (window,) = bounds([way])
        return [int(e) for e in self.index.query(*window)]

    def passing(self, point: Point, near: Sequence[int]) -> list[int]:
        """The edges among *near* that contain a point: two at a vertex, and none in the open."""
        x, y = point.xy
        boxes = self.boxes[list(near)]
        inside = (boxes[:, 0] <= x) & (x <= boxes[:, 2]) & (boxes[:, 1] <= y) & (y <= boxes[:, 3])
        return [e for e, box in zip(near, inside, strict=True) if box and passes(self.edges[e], point)]


class Viewpoints:
    """Curves in free space, in order, of which `first` finds the first that sees a point within the radius.

    ``on`` names for each curve the scene's edge on which it lies, or None. Curves must not enter interiors.
    """

    def __init__(
        self, world: World, radius: fmpq, curves: Sequence[Curve], on: Sequence[int | None] | None = None
    ) -> None:
        self.world, self.radius = world, radius
        names = [None] * len(curves) if on is None else on
        distinct: dict[object, int] = {}
        firsts = [distinct.setdefault(_identity(curve), k) for k, curve in enumerate(curves)]
        self.numbers = sorted(distinct.values())
        places = {number: place for place, number in enumerate(self.numbers)}
        self._places = np.array([places[k] for k in firsts], dtype=np.int64)
        self.curves = [curves[k] for k in self.numbers]
        self.on = [names[k] for k in self.numbers]
        self.forms = world.forms_of(self.curves)
        self.at: dict[int, set[int]] = {}
        for pair, e in zip(self.forms.ends.tolist(), self.on, strict=True):
            if e is not None:
                for number in pair:
                    self.at.setdefault(number, set()).add(e)

    def first(self, point: Point) -> int | None:
        """Number of the first curve that sees a rational point of the closed free space, or None.

        Milliseconds where few pairs of ray and curve need exact numbers.
        """
        near = _within(self.forms.boxes, point, self.radius)
        if not len(near):
            return None
        view = _View(self, point, near)
        seen, unsure = view.verdicts()
        certain = np.flatnonzero(seen)
        limit = int(certain[0]) if len(certain) else len(near)
        numbers = [self.numbers[int(k)] for k in near]
        for k in range(limit):
            if any(view.sees_along(int(ray), k) for ray in np.flatnonzero(unsure[:, k])):
                return numbers[k]
        return numbers[limit] if limit < len(near) else None

    def any_sees(self, point: Point, some: Sequence[Sequence[int]]) -> list[bool]:
        """For some lists of numbers of curves, whether any of them sees such a point: all by one view."""
        places = [np.unique(self._places[list(numbers)]) for numbers in some]
        wanted = np.concatenate([self._places[:0], *places])
        near = np.intersect1d(_within(self.forms.boxes, point, self.radius), wanted)
        if not len(near):
            return [False] * len(some)
        view = _View(self, point, near)
        seen, unsure = view.verdicts()
        return [self._any_sees(view, np.flatnonzero(np.isin(near, one)), seen, unsure) for one in places]

    @staticmethod
    def _any_sees(view: _View, some: Ints, seen: Bools, unsure: Bools) -> bool:
        if seen[some].any():
            return True
        return any(
            view.sees_along(int(ray), int(k)) for k in some for ray in np.flatnonzero(unsure[:, int(k)])
        )


def visible(world: World, radius: fmpq, a: Point, b: Point) -> bool:
    """Whether two free points see each other within the radius."""
    offset = b - a
    if offset.norm_sq().compare(radius * radius) > 0:
        return False
    return a == b or world.blocker_between(Segment(a, b)) is None


def _clear_crossings(segment: Segment, circle: Arc) -> list[Direction] | None:
    """The rays from a circle's centre to where a segment passes it; None if balls leave that open.

    Made exact when they are asked for. As in `_crossings` there may be rays beside the segment's ends.
    """
    places = segment.start, circle.center, segment.direction
    (x, y), (p, q), (u, v) = ((at.x.ball(TIE_BITS), at.y.ball(TIE_BITS)) for at in places)
    with workprec(TIE_BITS):
        x, y = x - p, y - q
        size, half = u * u + v * v, u * x + v * y
        square = half * half - size * (x * x + y * y - arb(circle.radius_sq))
        if square < 0:
            return []
        if not square > 0:
            return None
        root, found = square.sqrt(), list[Direction]()
        for k, t in enumerate(((-half - root) / size, (-half + root) / size)):
            if not (t < 0 or t > 1):
                offset = float((x + u * t).mid()), float((y + v * t).mid())
                unit = unit_vector(*offset)
                assert unit is not None, "a centre is not on its circle"
                found.append(Direction(unit, partial(_crossing, segment, circle, k), far=hypot(*offset)))
        return found


def _crossing(segment: Segment, circle: Arc, k: int) -> Point:
    """The way from a circle's centre to where a segment's line passes it first or last."""
    t = line_contacts(segment.start, segment.direction, circle)[k]
    return segment.start + segment.direction * t - circle.center


def _crossings(curve: Curve, circle: Arc) -> Iterator[Point]:
    """Where a curve meets a full circle, and perhaps where its line or its own circle does beside its ends.

    A ray more changes nothing: so it is not proved that such a point is the curve's end.
    """
    if isinstance(curve, Segment):
        for t in line_contacts(curve.start, curve.direction, circle):
            if t.clear_sign(TIE_BITS) >= 0 and (1 - t).clear_sign(TIE_BITS) >= 0:
                yield curve.start + curve.direction * t
        return
    start = curve.start
    whole = Arc(start, start, curve.center, curve.radius_sq, ccw=curve.ccw, full=True)
    yield from (at.start for at in contacts(whole, circle) if curve.may_pass(at.start, TIE_BITS))


def _identity(curve: Curve) -> object:
    """Equal for curves that are equal point sets, as far as that shows."""
    ends = frozenset((curve.start.key, curve.end.key))
    if isinstance(curve, Segment):
        return ends
    a, b = (curve.start.key, curve.end.key) if curve.ccw else (curve.end.key, curve.start.key)
    return a, b, curve.center.key, curve.radius_sq, curve.full


def _single(met: Sequence[Real], value: Real) -> Real | None:
    """The only one of some numbers that balls do not part from a value."""
    near = [t for t in met if t is value or (t - value).ball(TIE_BITS).contains(0)]
    return near[0] if len(near) == 1 else None


def between(a: Real, b: Real) -> object:
    """A number strictly between, rational if floats can tell the two apart."""
    low, high = float(a), float(b)
    middle = (low + high) / 2
    if low < middle < high:
        return rational(middle)
    return (a + b) / 2


def _within(boxes: Floats, point: Point, radius: fmpq) -> Ints:
    """The boxes that can hold points within the radius of a point."""
    xy = np.array(point.xy)
    apart = np.maximum(np.maximum(boxes[:, :2] - xy, xy - boxes[:, 2:]), 0.0)
    size = np.abs(boxes).max(axis=1) + np.abs(xy).max()
    return np.flatnonzero(np.hypot(*apart.T) <= nearest_float(radius) * (1 + EPS) + size * EPS)


# -- the view from one point -----------------------------------------------------------------------


@dataclass
class _View:
    """All rays from q, and how they meet the edges and the curves within range."""

    lookout: Viewpoints
    q: Point
    near: Ints

    def __post_init__(self) -> None:
        world, radius = self.lookout.world, self.lookout.radius
        self.reach = nearest_float(radius)
        self.origin = raw(self.q)
        self.curves = [self.lookout.curves[k] for k in self.near]
        near = _within(world.boxes, self.q, radius)
        self.edge_numbers: list[int] = near.tolist()
        self.edges = [world.edges[e] for e in self.edge_numbers]
        self.own = world.passing(self.q, self.edge_numbers)
        self.forms = world.forms.rows(near).and_rows(self.lookout.forms.rows(self.near))
        numbers, places = np.unique(self.forms.ends, return_inverse=True)
        self.numbers: list[int] = numbers.tolist()
        self.offsets = np.array([self._offset(world.coordinates[k]) for k in self.numbers]).reshape(-1, 2)
        self.spots = self.offsets[places.reshape(self.forms.ends.shape)]
        self.circles = [k for k in np.unique(self.forms.circle).tolist() if k >= 0]
        self.rays = with_cells(self._critical())

    # -- rays --------------------------------------------------------------------------------------

    def _critical(self) -> list[Direction]:
        """The critical rays that are not certainly hidden, and the east so that there is at least one."""
        others = self._rays_past_ends()
        sizes = np.hypot(*self.offsets.T)
        ends = np.flatnonzero(sizes)
        units = self.offsets[ends] / sizes[ends, None]
        far = np.concatenate((sizes[ends], [ray.far for ray in others]))
        left = self._not_hidden(np.concatenate((units, [ray.unit for ray in others])), far)
        to_ends = ends[left[: len(ends)]].tolist()
        rays = [self._ray_to(k) for k in to_ends]
        return [*rays, *(ray for ray, is_left in zip(others, left[len(ends) :], strict=True) if is_left)]

    def _rays_past_ends(self) -> list[Direction]:
        """The east, the rays to where curves pass the range, and those that touch circles."""
        rays = [Direction((1.0, 0.0), lambda: Point(1, 0)), *self._rays_to_range()]
        for k in self.circles:
            circle = self.lookout.world.circles[k]
            # Not nearer than the circle itself.
            far = hypot(*self._offset(raw(circle.center))) * (1 - EPS) - float(circle.radius) * (1 + EPS)
            clear = clear_tangents(self.q, circle, far)
            if clear is None:
                clear = [ray_along(vector, far) for vector in tangent_directions(self.q, circle)]
            rays += clear
        return rays

    def _not_hidden(self, units: Floats, far: Floats) -> Bools:
        """Which of many rays are not certainly blocked before what they lead to.

        Where a curve begins or ceases to be seen there is a critical ray on which it is seen, and what makes
        the ray critical is seen as well. So a ray to what is hidden is as good as none.
        """
        if len(units) < MANY_RAYS:
            return np.ones(len(units), dtype=bool)
        entering, _ = self._starts(units)
        left = ~(entering & (far > 0))
        for some in self._hiding():
            open_ = np.flatnonzero(left)
            # What is no number hides nothing.
            left[open_] = ~(self._surely_blocked(units[open_], some) < far[open_] * (1 - EPS))
        return left

    def _hiding(self) -> Iterator[Ints]:
        """The edges that do not pass through q, some at a time, all straight or all bent.

        Most rays are hidden by straight edges nearby; arcs take longer.
        """
        count = len(self.edges)
        order = np.argsort(np.hypot(*self.spots[:count].T).min(axis=0), kind="stable")
        is_bent, is_own = self.forms.circle[:count] >= 0, np.isin(self.edge_numbers, self.own)
        for kind in (~is_bent, is_bent):
            some = order[(kind & ~is_own)[order]]
            yield from (some[begin : begin + SOME_EDGES] for begin in range(0, len(some), SOME_EDGES))

    def _surely_blocked(self, units: Floats, some: Ints) -> Floats:
        """Within which distances rays are certainly blocked by such edges; infinite if that is not sure."""
        if self.forms.circle[some[0]] < 0:
            return surely_blocked(units, *self.spots[some].swapaxes(0, 1))
        return _certain(self._hits(units, some)[0])

    def _ray_to(self, k: int) -> Direction:
        """The ray to an end of a curve, by its place among all, that is not q itself."""
        number, (x, y), q = self.numbers[k], self.offsets[k].tolist(), self.q
        point, size = self.lookout.world.points[number], hypot(x, y)
        return Direction((x / size, y / size), lambda: point - q, number, size)

    def _rays_to_range(self) -> Iterator[Direction]:
        """The rays to where curves pass the range."""
        q, radius = self.q, self.lookout.radius
        east = Point(q.x + radius, q.y)
        circle = Arc(east, east, q, radius * radius, ccw=True, full=True)
        boxes, xy = self.forms.boxes[len(self.edges) :], np.array(q.xy)
        extent = np.hypot(*np.maximum(np.abs(boxes[:, :2] - xy), np.abs(boxes[:, 2:] - xy)).T)
        size = np.abs(boxes).max(axis=1) + np.abs(xy).max()
        for k in np.flatnonzero(extent + size * EPS >= self.reach * (1 - EPS)):
            curve = self.curves[k]
            clear = _clear_crossings(curve, circle) if isinstance(curve, Segment) else None
            if clear is not None:
                yield from clear
                continue
            for point in _crossings(curve, circle):
                yield ray_along(point - self.q, hypot(*self._offset(raw(point))))

    def _offset(self, place: Vector) -> tuple[float, float]:
        """From q to a place, exactly, then rounded once."""
        (x, y), (a, b) = place, self.origin
        return rounded(x - a), rounded(y - b)

    # -- verdicts ----------------------------------------------------------------------------------

    def verdicts(self) -> tuple[Bools, Bools]:
        """Which curves certainly see q, and which pairs (ray, curve) floats leave open."""
        units = np.array([ray.unit for ray in self.rays])
        edges, curves = self._hits(units, np.arange(len(self.forms.circle)))
        possible, certain = self._blocks(units, edges)
        nearest = np.argmin(possible, axis=1)[:, None]
        rest = possible.copy()
        np.put_along_axis(rest, nearest, np.inf, axis=1)
        free = np.where(
            nearest == self._partners(edges, curves)[None, :],
            rest.min(axis=1, keepdims=True),
            np.take_along_axis(possible, nearest, axis=1),
        )
        inside, outside = self.reach * (1 - EPS), self.reach * (1 + EPS)
        yes = curves.sure & (curves.high < free) & (curves.high < inside)
        no = (curves.low > certain[:, None]) | (curves.low > outside)
        seen = np.zeros(len(self.curves), dtype=bool)
        np.logical_or.at(seen, curves.curve, yes.any(axis=0))
        unsure = np.zeros((len(self.rays), len(self.curves)), dtype=bool)
        rows, columns = np.nonzero(~no & ~yes)
        unsure[rows, curves.curve[columns]] = True
        self._possible_edges = edges
        return seen, unsure

    def _partners(self, edges: Hits, curves: Hits) -> Ints:
        """For each column of the curves, the column of the edge on which the curve lies, or -1."""
        numbers = [self.edge_numbers[int(e)] for e in edges.curve]
        places = {pair: c for c, pair in enumerate(zip(numbers, edges.far.tolist(), strict=True))}
        on = [self.lookout.on[int(self.near[k])] for k in curves.curve]
        pairs = zip(on, curves.far.tolist(), strict=True)
        return np.array([-1 if e is None else places.get((e, far), -1) for e, far in pairs])

    def _blocks(self, units: Floats, edges: Hits) -> tuple[Floats, Floats]:
        """(possible, certain): distances at which each edge column may block, and where a ray surely does.

        An edge that is crossed has an interior on one side of it.
        """
        possible = edges.low
        entering, leaving = self._starts(units)
        possible = np.hstack((possible, np.where(leaving, np.inf, -np.inf)[:, None]))
        return possible, np.where(entering, 0.0, _certain(edges))

    def _starts(self, units: Floats) -> tuple[Bools, Bools]:
        """Which rays certainly enter the interior at q, and which certainly stay out of it at first."""
        count = len(units)
        if not self.own:
            return np.zeros(count, dtype=bool), np.ones(count, dtype=bool)
        tangents = [_tangent(self.lookout.world.edges[e], self.q) for e in self.own]
        turn = tangents[0].cross(tangents[-1])
        if len(tangents) == 2 and self.lookout.world.edges[self.own[0]].end != self.q:
            turn = -turn
        if turn.sign() == 0 and tangents[0].dot(tangents[-1]).sign() < 0:
            return np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
        sides = cross(np.array([ray_along(tangent).unit for tangent in tangents])[:, None], units)
        left: Bools = sides > EPS
        right: Bools = sides < -EPS
        if turn.sign() > 0:
            return np.logical_and.reduce(left), np.logical_or.reduce(right)
        return np.logical_or.reduce(left), np.logical_and.reduce(right)

    # -- contacts in floats ------------------------------------------------------------------------

    def _hits(self, units: Floats, some: Ints) -> tuple[Hits, Hits]:
        """Contacts of rays with some edges, but for those of q's own edges at q itself, and with some curves.

        They are given by their places among all edges and, after these, all curves.
        """
        count, forms, spots = len(self.edges), self.forms.rows(some), self.spots[some]
        own = np.isin(some, [self.edge_numbers.index(e) for e in self.own])
        straight, bent = np.flatnonzero(forms.circle < 0), np.flatnonzero(forms.circle >= 0)
        parts = [segment_hits(units, spots[straight, 0], spots[straight, 1])]
        parts[0].low[:, own[straight]] = np.inf
        parts[0].sure[:, own[straight]] = False
        if len(bent):
            of_arcs = np.array([self._centers[k] for k in forms.circle[bent].tolist()])
            chords = spots[bent, 0], forms.chord[bent]
            parts += arc_hits(units, of_arcs, forms.shape[bent], chords, own[bent])
        low, high, sure = (np.hstack(columns) for columns in zip(*parts, strict=True))
        curve = some[np.concatenate((straight, *[bent] * (len(parts) - 1)))]
        far = np.arange(len(curve)) >= len(some)
        edges = curve < count
        return (
            Hits(low[:, edges], high[:, edges], sure[:, edges], curve[edges], far[edges]),
            Hits(low[:, ~edges], high[:, ~edges], sure[:, ~edges], curve[~edges] - count, far[~edges]),
        )

    @cached_property
    def _centers(self) -> dict[int, tuple[float, float]]:
        """From q to the centres of circles, by the numbers of these."""
        return {k: self._offset(raw(self.lookout.world.circles[k].center)) for k in self.circles}

    # -- exact -------------------------------------------------------------------------------------

    def sees_along(self, ray: int, k: int) -> bool:
        """Whether a curve has a point on a ray that sees q: exact, but for places at q or at the range.

        These are told to 500 digits.
        """
        direction, curve, aim = self.rays[ray].exact(), self.curves[k], self.rays[ray].aim
        found = line_contacts(self.q, direction, curve)
        if not all(t.clear_sign(TIE_BITS) or t.clear_sign(BITS) for t in found):
            return True
        ending = set() if aim is None else self.lookout.at.get(aim, set())
        if aim in self.forms.ends[len(self.edges) + k]:
            found = [Real(1) if t is _single(found, Real(1)) else t for t in found]
        ahead = [t for t in found if t >= 0]
        if not ahead:
            return False
        through = isinstance(curve, Segment) and len(ahead) < len(found)
        nearest = Real(0) if through else ahead[0]
        excess: Real = nearest * nearest * direction.norm_sq() - self.lookout.radius**2
        if (excess.clear_sign(TIE_BITS) or excess.clear_sign(BITS)) > 0:
            return False
        edges = self._possible_edges
        met = np.unique(edges.curve[edges.low[ray] < np.inf])
        others, world = {self.edge_numbers[e] for e in met} - set(self.own), self.lookout.world
        # Where a ray grazes one after the other, as in a row of pins, long balls tell what floats do not.
        if any(surely_crosses(self.q, direction, nearest, world.edges[e]) for e in others):
            return False
        numbers = others | set(self.own)
        if nearest.rational != 1:
            ending = set()
        return world.blocker(self.q, direction, nearest, sorted(numbers), self.own, ending) is None


def _certain(edges: Hits) -> Floats:
    """Within which distances rays certainly cross one of some edges; infinite if none is sure."""
    certain: Floats = np.where(edges.sure, edges.high, np.inf).min(axis=1, initial=np.inf)
    return certain


def _tangent(edge: Curve, q: Point) -> Point:
    return edge.direction if isinstance(edge, Segment) else edge.tangent(q)
