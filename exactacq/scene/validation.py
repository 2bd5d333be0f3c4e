"""The rules of a legal scene, and the search for all violations of them.

- A boundary is a simple closed curve: at least 3 vertices, or 2 with an arc, and no edge of length 0.
- No two boundaries have a point in common: obstacles neither cross nor touch nor are tangent to each other or
  to the enclosure, and none lies inside another. All lie within the enclosure.
- The start lies in free space, which is closed: the start may lie on a boundary.
- Radius, and width and height of the terrain, are positive. Obstacles may cross or touch the terrain's
  border: `exactacq.scene.terrain_components` finds what remains of them.
- Coordinates, radii and lengths of edges lie within `LIMIT`.

Floats only choose which edges are compared (boxes rounded outward); every verdict is exact, so a gap of
10^-60 is legal and a tangency is not. Near linear in the number of edges plus that of overlapping boxes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice
from math import inf
from typing import Protocol

import numpy as np
from flint import fmpq

from exactacq.errors import InvalidScene
from exactacq.geometry.box_index import BoxIndex, Separator, bounds, united
from exactacq.geometry.coordinates import cross, dot, minus, raw, sign
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import Contact, ContactKind, contacts
from exactacq.geometry.loops import winding
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import plain
from exactacq.numbers.real import Real
from exactacq.scene.shapes import Circle, Shape, Terrain

LIMIT, LIMIT_TEXT = fmpq(10) ** 100, "10^100"
"""Largest coordinate and radius, inverse of the shortest edge: squares of floats must not overflow."""
LARGEST_SQ, SMALLEST_SQ = LIMIT**2, 1 / LIMIT**2
LISTED = 50
"""Violations listed one by one; the rest are counted."""
COUNTED = 5000
"""Violations after which the search stops: a hostile file could have a quadratic number of them."""
MET = 50_000
"""Contacts of edges after which the search stops, also if they are at few places, as of loops drawn over and
over: it takes some 0.1 milliseconds for each."""

SIMPLE = "a boundary must not meet itself"
DISJOINT = "obstacles must be disjoint, also at their boundaries"
WITHIN = "obstacles must lie strictly within the enclosure"


@dataclass(frozen=True, slots=True)
class Violation:
    """A broken rule in words, by which loops, and where; there may be no loops, and no places.

    Where edges meet the *kind* says how.
    """

    text: str
    loops: tuple[int, ...] = ()
    places: tuple[Point, ...] = ()
    kind: ContactKind | None = None

    def __str__(self) -> str:
        return self.text


class ValidatedLoop(Protocol):
    """What is validated: a shape and its boundary as curves, edge i from vertex i, in either sense."""

    @property
    def index(self) -> int: ...
    @property
    def name(self) -> str | None: ...
    @property
    def shape(self) -> Shape: ...
    @property
    def edges(self) -> Sequence[Curve]: ...
    @property
    def is_enclosure(self) -> bool: ...


@dataclass
class _MeetingLoops:
    """Two loops (maybe one and the same) that meet at a place, and all their edges that do so there."""

    loops: tuple[ValidatedLoop, ValidatedLoop]
    contact: Contact
    first: set[int] = field(default_factory=set)
    second: set[int] = field(default_factory=set)

    @property
    def indices(self) -> tuple[int, int]:
        """The numbers of the two loops."""
        return self.loops[0].index, self.loops[1].index

    def order(self) -> tuple[object, ...]:
        """ValidatedLoop by loop, edge by edge."""
        return *self.indices, sorted(self.first), sorted(self.second), self.contact.kind.value

    def __str__(self) -> str:
        one, other = self.loops
        kind, start, end = self.contact.kind, self.contact.start, self.contact.end
        along = kind is ContactKind.OVERLAP
        place = f"from {place_text(start)} to {place_text(end)}" if along else f"at {place_text(start)}"
        if along and start is end:
            place = "all around"
        if one is other:
            return f"{_label(one)}: {_edges(self.first | self.second)} {kind.value} {place}: {SIMPLE}"
        verb = {"cross": "crosses", "touch": "touches", "overlap": "overlaps"}[kind.value]
        rule = WITHIN if one.is_enclosure or other.is_enclosure else DISJOINT
        sides = f"{_label(one)}, {_edges(self.first)}, {verb} {_label(other)}, {_edges(self.second)}"
        return f"{sides}, {place}: {rule}"


def validate(
    loops: Sequence[ValidatedLoop], start: Point | None, radius: fmpq | None, terrain: Terrain | None
) -> None:
    """Raise `InvalidScene` with every violation of the rules, if there is any.

    Each names obstacles as reports do (O1 is the first) and by their own names, edges by number (from 0),
    the place and the rule. The first `LISTED` are listed and the rest counted.
    """
    found = [violation.text for violation in violations(loops, start, radius, terrain)]
    if not found:
        return
    rest = len(found) - LISTED
    if rest > 0:
        limit = "at least " if len(found) >= COUNTED else ""
        found[LISTED:] = [f"and {limit}{rest} more violation{'s' if rest > 1 else ''}"]
    raise InvalidScene(found)


def violations(
    loops: Sequence[ValidatedLoop],
    start: Point | None = None,
    radius: fmpq | None = None,
    terrain: Terrain | None = None,
    *,
    nested: bool = False,
) -> list[Violation]:
    """All violations of the rules, in a fixed order; the search ends at `COUNTED`.

    With *nested* loops may lie within one another, as long as they do not meet: as in a drawing in which
    nothing is said of what is free.
    """
    return list(islice(_violations(loops, start, radius, terrain, nested), COUNTED))


def _violations(
    loops: Sequence[ValidatedLoop],
    start: Point | None,
    radius: fmpq | None,
    terrain: Terrain | None,
    nested: bool,
) -> Iterator[Violation]:
    yield from map(Violation, sensor_flaws(start, radius))
    sides = [] if terrain is None else [("width", terrain.width), ("height", terrain.height)]
    for side, size in sides:
        if size <= 0:
            yield Violation(f"terrain {side} {_number(size)}: must be positive")
    sound = []
    for loop in loops:
        if sizes := list(_size_flaws(loop)):
            yield from sizes
            continue
        yield from _shape_flaws(loop)
        edges = [(i, edge) for i, edge in enumerate(loop.edges) if not _is_point(edge)]
        straight = all(isinstance(edge, Segment) for _, edge in edges)
        least = 3 if straight else 1 if isinstance(loop.shape, Circle) else 2
        if len(edges) >= least:
            sound.append((loop, edges))
    arrangement = _Arrangement(sound)
    yield from arrangement.meetings()
    if not nested:
        yield from arrangement.nestings()
    if start is not None and not any(sensor_flaws(start, None)):
        yield from arrangement.start_flaws(start)


def sensor_flaws(start: Point | None, radius: fmpq | None) -> Iterator[str]:
    """What is wrong with a start and a radius of vision, whatever the obstacles."""
    if radius is not None and radius <= 0:
        yield f"radius {_number(radius)}: a sensing radius must be positive"
    if radius is not None and radius > LIMIT:
        yield f"radius: a sensing radius of more than {LIMIT_TEXT} is not supported"
    if radius is not None and 0 < radius * LIMIT < 1:
        yield f"radius: a sensing radius of less than 1/{LIMIT_TEXT} is not supported"
    if start is not None:
        yield from place_flaws("start", start)


def place_flaws(name: str, place: Point) -> Iterator[str]:
    """What is wrong with a place, whatever the obstacles."""
    x, y = place.rational or (place.x, place.y)
    if abs(x) > LIMIT or abs(y) > LIMIT:
        yield f"{name}: it must not lie farther than {LIMIT_TEXT} from the axes"


def _of(loop: ValidatedLoop, flaw: str, *places: Point) -> Violation:
    """A flaw of one loop."""
    return Violation(f"{_label(loop)}: {flaw}", (loop.index,), places)


def _shape_flaws(loop: ValidatedLoop) -> Iterator[Violation]:
    if isinstance(loop.shape, Circle):
        if loop.shape.radius <= 0:
            flaw = f"circle radius {_number(loop.shape.radius)}: must be positive"
            yield _of(loop, flaw, Point(*loop.shape.center))
        return
    count = len(loop.edges)
    if count < 2 or (count == 2 and all(isinstance(edge, Segment) for edge in loop.edges)):
        at = f" at {place_text(loop.edges[0].start)}" if count else ""
        plural = "vertex" if count == 1 else "vertices"
        flaw = f"{count} {plural}{at}: a boundary needs 3 vertices, or 2 with a bulge"
        yield _of(loop, flaw, *(edge.start for edge in loop.edges[:1]))
        return
    for i, edge in enumerate(loop.edges):
        if _is_point(edge):
            flaw = f"edge {i} has zero length at {place_text(edge.start)}: leave out the vertex"
            yield _of(loop, flaw, edge.start)


def _size_flaws(loop: ValidatedLoop) -> Iterator[Violation]:
    """What is too large or too small for the float images that prune; exact decisions have no such limit."""
    rule = f"sizes must lie between 1/{LIMIT_TEXT} and {LIMIT_TEXT}"
    for i, edge in enumerate(loop.edges):
        if any(abs(c) > LIMIT for c in raw(edge.start)):
            yield _of(loop, f"vertex {i} lies too far from the origin: {rule}")
        elif isinstance(edge, Arc) and edge.radius_sq > LARGEST_SQ:
            flaw = f"edge {i} bends too little, its radius is too large: {rule}"
            yield _of(loop, flaw, edge.start)
        elif not _is_point(edge) and not _is_full(edge) and _is_tiny(edge):
            yield _of(loop, f"edge {i} is too short: {rule}", edge.start)


def _is_tiny(edge: Curve) -> bool:
    vector = minus(raw(edge.end), raw(edge.start))
    return bool(dot(vector, vector) < SMALLEST_SQ)


def _meet_in_one(one: Curve, other: Curve) -> bool:
    """Whether two straight edges have an end in common, and are not on one line."""
    if not (isinstance(one, Segment) and isinstance(other, Segment)):
        return False
    if one.end is not other.start and one.start is not other.end:
        return False
    return sign(cross(raw(one.direction), raw(other.direction))) != 0


def _is_full(edge: Curve) -> bool:
    return isinstance(edge, Arc) and edge.full


def _is_point(edge: Curve) -> bool:
    if isinstance(edge, Segment):
        return edge.start == edge.end
    return not edge.radius_sq or (not edge.full and edge.start == edge.end)


class _Arrangement:
    """All edges of positive length in one list, loop after loop, with an index of their boxes."""

    def __init__(self, loops: Sequence[tuple[ValidatedLoop, list[tuple[int, Curve]]]]) -> None:
        self.loops = [loop for loop, _ in loops]
        self.curves = [curve for _, edges in loops for _, curve in edges]
        self.numbers = [number for _, edges in loops for number, _ in edges]
        self.owner = [k for k, (_, edges) in enumerate(loops) for _ in edges]
        self.owners = np.array(self.owner, dtype=np.int64)
        self.begin = np.searchsorted(self.owners, range(len(loops) + 1)).tolist()
        self.index = BoxIndex(bounds(self.curves))
        self.loop_index = BoxIndex(united(self.index.boxes, self.begin[:-1]))
        self.enclosures = [k for k, loop in enumerate(self.loops) if loop.is_enclosure]
        self.met: set[tuple[int, int]] = set()
        self.stopped = False
        """Whether the search for meetings stopped early: there are more than enough violations then."""

    def meetings(self) -> Iterator[Violation]:
        """Contacts between edges, but for the vertex that neighbours share; one violation a place.

        A contact at the end of an overlap of the same loops is left out, as the overlap is reported.
        """
        meetings: dict[object, _MeetingLoops] = {}
        count = 0
        for i, j in self._candidates():
            a, b = self.owner[i], self.owner[j]
            shared = self._shared(i, j) if a == b else []
            if shared and _meet_in_one(self.curves[i], self.curves[j]):
                continue
            for contact in contacts(self.curves[i], self.curves[j]):
                point = contact.kind is not ContactKind.OVERLAP
                if point and any(contact.start == vertex for vertex in shared):
                    continue
                self.met.add((a, b))
                count += 1
                site = (a, b, contact.kind, contact.start.key, contact.end.key)
                if site not in meetings:
                    meetings[site] = _MeetingLoops((self.loops[a], self.loops[b]), contact)
                meetings[site].first.add(self.numbers[i])
                meetings[site].second.add(self.numbers[j])
            if len(meetings) >= COUNTED or count >= MET:
                self.stopped = True
                break
        overlaps = [m for m in meetings.values() if m.contact.kind is ContactKind.OVERLAP]
        ends = {(*m.indices, p.key) for m in overlaps for p in (m.contact.start, m.contact.end)}
        for meeting in sorted(meetings.values(), key=_MeetingLoops.order):
            overlap = meeting.contact.kind is ContactKind.OVERLAP
            if overlap or (*meeting.indices, meeting.contact.start.key) not in ends:
                contact = meeting.contact
                places = (contact.start, contact.end) if overlap else (contact.start,)
                yield Violation(str(meeting), tuple(dict.fromkeys(meeting.indices)), places, contact.kind)
        if self.stopped:
            yield Violation("more violations were not looked for")

    def _candidates(self) -> Iterator[tuple[int, int]]:
        separator = Separator(self.curves, self.index.boxes)
        for first, second in self.index.pairs():
            keep = ~separator.separated(first, second)
            yield from zip(first[keep].tolist(), second[keep].tolist(), strict=True)

    def _shared(self, i: int, j: int) -> list[Point]:
        """The vertices that two edges i < j of a loop may share."""
        begin, end = self.begin[self.owner[i]], self.begin[self.owner[i] + 1]
        vertices = [self.curves[j].start] if j == i + 1 else []
        return [*vertices, self.curves[i].start] if i == begin and j == end - 1 else vertices

    def nestings(self) -> Iterator[Violation]:
        """Loops that lie within one another, or not within the enclosure, without meeting it.

        None if the search for meetings stopped: which loops do not meet is not known then.
        """
        for a, loop in enumerate(self.loops):
            if loop.is_enclosure or self.stopped:
                continue
            point = self.curves[self.begin[a]].start
            for b, turns in self._windings(point).items():
                if a == b or (min(a, b), max(a, b)) in self.met:
                    continue
                other = self.loops[b]
                where = f"{_label(other)}, at {place_text(point)}"
                which = loop.index, other.index
                if other.is_enclosure and not turns:
                    yield Violation(f"{_label(loop)} lies outside {where}: {WITHIN}", which, (point,))
                if turns and not other.is_enclosure:
                    yield Violation(f"{_label(loop)} lies inside {where}: {DISJOINT}", which, (point,))

    def start_flaws(self, start: Point) -> Iterator[Violation]:
        """The start must lie in closed free space."""
        for a, turns in self._windings(start).items():
            loop = self.loops[a]
            if turns is not None and bool(turns) != loop.is_enclosure:
                side = "outside" if loop.is_enclosure else "inside"
                text = f"start {place_text(start)} lies {side} {_label(loop)}: it must lie in free space"
                yield Violation(text, (loop.index,), (start,))

    def _windings(self, point: Point) -> dict[int, int | None]:
        """How often loops wind round a point (None: on the loop): the enclosure, and all that may not be 0.

        Only loops whose boxes contain the point can wind round it, and of these only the edges count whose
        boxes meet the ray to the east.
        """
        x0, y0, x1, y1 = bounds([Segment(point, point)])[0].tolist()
        around = {*self.enclosures, *self.loop_index.query(x0, y0, x1, y1).tolist()}
        edges: dict[int, list[Curve]] = {loop: [] for loop in sorted(around)}
        ray = self.index.query(x0, y0, inf, y1)
        for i in ray[np.isin(self.owners[ray], list(edges))].tolist():
            edges[self.owner[i]].append(self.curves[i])
        return {loop: winding(some, point) for loop, some in edges.items()}


def _label(loop: ValidatedLoop) -> str:
    label = "the enclosure" if loop.is_enclosure else f"obstacle O{loop.index + 1}"
    return f"{label} {loop.name!r}" if loop.name else label


def _edges(numbers: Iterable[int]) -> str:
    *head, last = (str(number) for number in sorted(numbers))
    return f"edges {', '.join(head)} and {last}" if head else f"edge {last}"


def place_text(point: Point) -> str:
    """A place in a message: exact coordinates if they are short, else ten digits."""
    return f"({_number(point.x)}, {_number(point.y)})"


def _number(value: fmpq | Real) -> str:
    """Exact if that is short, else ten digits."""
    real = Real(value)
    exact = plain(real.rational) if real.rational is not None else ""
    return exact if 0 < len(exact) <= 12 else real.decimal(10)
