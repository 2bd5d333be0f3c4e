"""What a rectangular terrain leaves of its obstacles: components, and the boundary the robot can walk.

Obstacles may cross the border. A component is a connected piece of an obstacle within the terrain's
interior. The robot starts in the SW corner and reaches at most one arc of the component's boundary, its
*shore*, or none if other obstacles enclose it. A border point that a boundary only touches does not
divide a component: free space is closed. Boundary that runs along the border belongs to no component.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise
from string import ascii_lowercase
from typing import NamedTuple

from exactacq.cached import cached_property
from exactacq.errors import InvalidScene
from exactacq.geometry.boundary_index import BoundaryIndex
from exactacq.geometry.box_index import box
from exactacq.geometry.coordinates import raw
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.intersections import contacts
from exactacq.geometry.interval_union import Interval
from exactacq.geometry.loops import winding
from exactacq.geometry.points import Location, Point
from exactacq.numbers.between import rational_between
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.scene.scene import Obstacle, Scene, as_scene
from exactacq.scene.shapes import Terrain


class Part(NamedTuple):
    """A piece of boundary within the terrain: of which edge of its obstacle, which part, and its curve."""

    edge: int
    span: Interval
    curve: Curve
    is_whole: bool


Shore = tuple[Part, ...]
"""Parts that follow each other along a boundary: a loop, or an arc from border to border."""


@dataclass(frozen=True)
class Component:
    """A component of an obstacle within the terrain.

    ``shore`` is the boundary that the robot can reach, in the stored direction: a loop if ``closed``, an arc
    with both ends on the border if not, and empty if the robot cannot reach the component. ``hidden`` are
    the arcs out of its reach. A strategy treats it as an obstacle with ``edges``, ``perimeter``, ``name``.
    """

    index: int
    obstacle: Obstacle
    shore: Shore
    hidden: tuple[Shore, ...]
    closed: bool
    letter: str = ""

    @property
    def name(self) -> str | None:
        """The obstacle's name."""
        return self.obstacle.name

    @property
    def label(self) -> str:
        """The obstacle's label, with a letter if it has several components within reach."""
        space = " " if self.letter and self.name else ""
        return f"{self.obstacle.label}{space}{self.letter}"

    @cached_property
    def edges(self) -> tuple[Curve, ...]:
        """The curves of the shore."""
        return tuple(part.curve for part in self.shore)

    def edges_at(self, point: Point) -> tuple[int, ...]:
        """The numbers of the shore's curves that pass a point."""
        return tuple(k for k in self._index.may_pass(point) if self.edges[k].passes(point))

    def edges_on(self, point: Point, edges: Container[int]) -> tuple[int, ...]:
        """The numbers of the shore's curves that pass a point, all *edges* of the obstacle that do given."""
        shore = enumerate(self.shore)
        return tuple(k for k, p in shore if p.edge in edges and (p.is_whole or p.curve.contains(point)))

    @cached_property
    def _index(self) -> BoundaryIndex:
        return BoundaryIndex(self.edges)

    @cached_property
    def perimeter(self) -> Length:
        """Length of the shore."""
        return Length.sum(curve.length for curve in self.edges)

    def is_bounded_by(self, point: Point, edges: Container[int]) -> bool:
        """Whether a point lies on this component's boundary, hidden or not; *edges* are all that pass it."""
        parts = (part for shore in (self.shore, *self.hidden) for part in shore)
        return any(p.edge in edges and (p.is_whole or p.curve.contains(point)) for p in parts)


class Ground:
    """The components of a terrain: those that the robot can reach from the SW corner, and the others.

    ``components`` are numbered in the order of their obstacles, those of one obstacle as its boundary comes
    to them from its first vertex. The SW corner must be free.
    """

    def __init__(self, obstacles: Sequence[Obstacle], terrain: Terrain) -> None:
        self.obstacles, self.terrain = obstacles, terrain
        loops: list[tuple[Obstacle, Shore]] = []
        arcs: list[tuple[Obstacle, Shore]] = []
        for obstacle in obstacles:
            for shore, closed in _shores(obstacle, terrain):
                (loops if closed else arcs).append((obstacle, shore))
        border = _BorderCircle(terrain, [shore for _, shore in arcs])
        walked = set(border.reached)
        found: list[tuple[Obstacle, Shore, tuple[Shore, ...], bool, bool]]
        found = [(obstacle, shore, (), True, border.surrounds(shore)) for obstacle, shore in loops]
        for group in border.groups():
            numbers = set(group)
            reached = [k for k in group if k in walked]
            shore = arcs[reached[0]][1] if reached else ()
            hidden = tuple(arcs[k][1] for k in sorted(numbers - set(reached)))
            found.append((arcs[group[0]][0], shore, hidden, False, bool(reached)))
        found.sort(key=lambda f: (f[0].index, min((p.edge, p.span.low) for s in (f[1], *f[2]) for p in s)))
        inside = [f[:4] for f in found if f[4]]
        owners = [f[0].index for f in inside]
        self.components = tuple(
            Component(k, *f, _letter(owners, k) if owners.count(owners[k]) > 1 else "")
            for k, f in enumerate(inside)
        )
        self.unreached = tuple(
            Component(k, obstacle, (), (shore, *hidden) if closed else hidden, closed)
            for k, (obstacle, shore, hidden, closed, _) in enumerate(
                (f for f in found if not f[4]), len(inside)
            )
        )

    def of(self, obstacle: int) -> list[Component]:
        """The components of one obstacle, reached or not."""
        return self._of.get(obstacle, [])

    @cached_property
    def _of(self) -> dict[int, list[Component]]:
        found: dict[int, list[Component]] = {}
        for component in (*self.components, *self.unreached):
            found.setdefault(component.obstacle.index, []).append(component)
        return found


def ground_of(scene: Scene) -> Ground:
    """The components that a scene's terrain leaves of its obstacles.

    Raises `InvalidScene` if there is no terrain or an enclosure, if the SW corner is not free, or if an
    obstacle lies outside the terrain, and `FormatError` for what is no scene.
    """
    as_scene(scene)
    flaws: list[str] = []
    if scene.enclosure is not None:
        flaws.append(
            "the Seed Spreader sweeps a rectangle: an enclosure of another form must be left out "
            "(of a drawing: outer drop)"
        )
    if scene.terrain is None:
        flaws.append("the Seed Spreader needs a terrain: a rectangle with width and height")
        raise InvalidScene(flaws)
    corner = scene.terrain.south_west
    flaws += [
        f"obstacle {obstacle.label} covers the SW corner {corner}, where the Seed Spreader starts"
        for obstacle in scene.obstacles
        if not obstacle.is_enclosure and obstacle.locate(corner) is not Location.OUTSIDE
    ]
    if flaws:
        raise InvalidScene(flaws)
    ground = Ground(scene.obstacles, scene.terrain)
    outside = [o.label for o in scene.obstacles if not ground.of(o.index)]
    if outside:
        raise InvalidScene([f"obstacle {name} lies outside the terrain" for name in outside])
    return ground


class _Where(Enum):
    INSIDE = 1
    BORDER = 0
    OUTSIDE = -1


def sides(terrain: Terrain) -> list[Segment]:
    """The border, counterclockwise from the SW corner: south, east, north, west."""
    corners = terrain.corners
    return [Segment(p, q) for p, q in zip(corners, [*corners[1:], corners[0]], strict=True)]


def lies_inside(edge: Curve, terrain: Terrain) -> bool:
    """Whether an edge is seen to lie strictly inside the terrain: its ends, or the box of an arc.

    Boxes are rounded outward, and compared with the exact limits.
    """
    west, south, east, north = terrain.limits
    if isinstance(edge, Segment):
        ends = raw(edge.start), raw(edge.end)
        return all(west < x < east and south < y < north for x, y in ends)
    left, bottom, right, top = map(rational, box(edge))
    return bool(west < left and south < bottom and right < east and top < north)


def _letter(owners: Sequence[int], k: int) -> str:
    """a, b, ..., z, aa, ... by the place of the k-th component among those of its obstacle."""
    count, letters = owners[:k].count(owners[k]) + 1, ""
    while count:
        count, digit = divmod(count - 1, 26)
        letters = ascii_lowercase[digit] + letters
    return letters


def _shores(obstacle: Obstacle, terrain: Terrain) -> Iterator[tuple[Shore, bool]]:
    """The maximal runs of an obstacle's boundary in the terrain, and whether they are the whole loop."""
    pieces = [piece for k, edge in enumerate(obstacle.edges) for piece in pieces_within(k, edge, terrain)]
    breaks = [k for k, piece in enumerate(pieces) if piece is None]
    if not breaks:
        yield tuple(piece for piece in pieces if piece is not None), True
        return
    turned = pieces[breaks[0] + 1 :] + pieces[: breaks[0] + 1]
    run: list[Part] = []
    for piece in turned:
        if piece is not None:
            run.append(piece)
        elif run:
            yield tuple(run), False
            run = []


def pieces_within(k: int, edge: Curve, terrain: Terrain) -> Iterator[Part | None]:
    """The parts of an edge inside the terrain in its direction, with None for what lies between them."""
    rail = Rail(edge)
    if lies_inside(edge, terrain):
        yield Part(k, Interval.whole(rail), edge, True)
        return
    cuts = [(Real(0), edge.start), (rail.top, edge.end)]
    for side in sides(terrain):
        for contact in contacts(edge, side):
            cuts += [(rail.parameter(point), point) for point in (contact.start, contact.end)]
    cuts.sort(key=lambda cut: cut[0])
    cuts = [cut for n, cut in enumerate(cuts) if n == 0 or cuts[n - 1][0].compare(cut[0]) < 0]
    begin = cuts[0]
    for (u, p), (v, q) in pairwise(cuts):
        if _where(rail.point(rational_between(u, v)), terrain) is not _Where.INSIDE:
            if begin[0] is not u:
                yield _part(k, rail, begin, (u, p))
            yield None
            begin = v, q
    if begin[0] is not cuts[-1][0]:
        yield _part(k, rail, begin, cuts[-1])


def _part(k: int, rail: Rail, begin: tuple[Real, Point], end: tuple[Real, Point]) -> Part:
    whole = begin[0].sign() == 0 and end[0] is rail.top
    curve = rail.curve if whole else rail.curve.part(begin[1], end[1])
    return Part(k, Interval(*begin, *end), curve, whole)


def _where(point: Point, terrain: Terrain) -> _Where:
    west, south, east, north = terrain.limits
    return _Where(
        min(point.x.compare(west), point.y.compare(south), -point.x.compare(east), -point.y.compare(north))
    )


class _BorderCircle:
    """The border as a circle from the SW corner, counterclockwise, cut by the ends of arcs.

    From the end of an arc the border is blocked, counterclockwise, as far as the next start of one.
    """

    def __init__(self, terrain: Terrain, arcs: Sequence[Shore]) -> None:
        self.sides, self.arcs = sides(terrain), arcs
        ends = [(*self._place(arc[0].curve.start), k, True) for k, arc in enumerate(arcs)]
        ends += [(*self._place(arc[-1].curve.end), k, False) for k, arc in enumerate(arcs)]
        ends.sort(key=lambda end: end[:2])
        self.ends = [(k, is_start) for _, _, k, is_start in ends]
        self.at = {end: n for n, end in enumerate(self.ends)}

    def _place(self, point: Point) -> tuple[int, Real]:
        """Which side a border point is on, and how far along: a corner begins a side."""
        for k, side in enumerate(self.sides):
            across = (point - side.start).cross(side.direction)
            if across.sign() == 0 and point != side.end and side.contains(point):
                return k, (point - side.start).dot(side.direction)
        # Arcs are cut where edges meet the four sides, and these are all of the border.
        raise AssertionError("an arc begins and ends on the border")

    @cached_property
    def reached(self) -> list[int]:
        """The arcs of the free region at the SW corner, as one goes round it counterclockwise."""
        found, n = [], 0
        while n < len(self.ends):
            k, is_start = self.ends[n]
            # `ground_of` has refused obstacles that hold the SW corner, so the border is free from there to
            # the first end, and from each start to the next end.
            assert not is_start, "the SW corner is free"
            found.append(k)
            n = self.at[k, True] + 1
        return found

    def groups(self) -> Iterator[list[int]]:
        """The arcs of each component, as one goes round it counterclockwise."""
        left = set(range(len(self.arcs)))
        while left:
            group = [min(left)]
            while (follower := self._after(group[-1])) != group[0]:
                group.append(follower)
            left -= set(group)
            yield group

    def _after(self, arc: int) -> int:
        k, is_start = self.ends[(self.at[arc, False] + 1) % len(self.ends)]
        # The sides of the border alternate: beside an arc's end it is blocked ahead, beside a start behind,
        # and disjoint simple loops share no end.
        assert is_start, "a blocked stretch ends where an arc starts"
        return k

    def surrounds(self, shore: Shore) -> bool:
        """Whether a loop inside the terrain lies in the free region at the SW corner."""
        if not self.arcs:
            return True
        part = shore[0]
        rail, u = Rail(part.curve), part.span.high
        turns = None
        while turns is None:
            # A loop touches the border, and so the outline, in a few points at most.
            u = Real(rational_between(part.span.low, u))
            turns = winding(self._outline, rail.point(u.rational))
        return bool(turns)

    @cached_property
    def _outline(self) -> list[Curve]:
        """The boundary of the free region at the SW corner, counterclockwise."""
        curves: list[Curve] = []
        at = self.sides[0].start
        for k in self.reached:
            shore = self.arcs[k]
            curves += self._along(at, shore[-1].curve.end)
            curves += [part.curve.reversed() for part in reversed(shore)]
            at = shore[0].curve.start
        return curves + self._along(at, self.sides[0].start)

    def _along(self, start: Point, end: Point) -> list[Curve]:
        """The border from one point counterclockwise to another, not past the SW corner."""
        first, last = self._place(start)[0], self._place(end)[0] if end != self.sides[0].start else 3
        stops = [start, *(self.sides[k].end for k in range(first, last)), end]
        return [Segment(p, q) for p, q in pairwise(stops) if p != q]
