"""The sweep of a point: what is met first in every direction, by a radial sweep.

Rays from the point meet front faces of obstacles (faces, see `exactacq.visibility.front_faces`). The
ends of the faces within reach, sorted by direction, divide the full turn into cells; in a cell the order
of the faces along all rays is the same, since boundaries do not cross. Floats tell the order of the ends and
the first face of every cell (`exactacq.kernel.radial_sweep`); what they leave open, exact values decide.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby
from operator import itemgetter

from flint import arb, fmpq

from exactacq.geometry.constructions import put_on_tangent, put_past_corner
from exactacq.geometry.coordinates import Vector, advance, cross, minus, raw, sign
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.late import Balls, balls, late_point
from exactacq.geometry.points import Point
from exactacq.grouping import in_groups
from exactacq.kernel import radial_sweep as floats
from exactacq.kernel import single_rays
from exactacq.kernel.radial_faces import FaceEnd
from exactacq.kernel.radial_sweep import FirstFace
from exactacq.kernel.view_parts import ViewParts
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.chords import meet
from exactacq.visibility.features import enters, leaving
from exactacq.visibility.front_faces import NOWHERE, FrontFaces
from exactacq.visibility.line_balls import LONG, CurveBalls, clear_turn, long_vector
from exactacq.visibility.place_facts import NOTHING_KNOWN, PlaceFacts
from exactacq.visibility.sensor_range import Range

NOTHING, BLOCKED = floats.NOTHING, floats.BLOCKED
"""First faces of cells without one: nothing within reach, and inside the point's own obstacle."""
NOWHERE_KNOWN = arb("nan"), arb("nan")
"""Balls that tell nothing of a point."""


class RadialSweep:
    """The sights of a free point, counterclockwise, and the exact points where they begin and end.

    *own* are the edges through the point, None if they are not known, and *facts* what is known of it (see
    `FrontFaces`). Faces beyond the range are left out, and what lies beyond it may be reported wrongly or as
    NOTHING.
    """

    def __init__(
        self,
        table: EdgeTable,
        point: Point,
        range_: Range,
        own: tuple[int, ...] | None,
        facts: PlaceFacts = NOTHING_KNOWN,
    ) -> None:
        self.table = table
        self.faces = faces = FrontFaces(table, point, range_, own, facts)
        self._floats = floats.FaceSweep(faces.floats)
        self._order_events()
        self.count = len(self._floats.leads)
        self.first = self._first()
        self.sights = self._sights()

    def edge(self, face: int) -> int:
        """The edge of a face."""
        return self.faces.floats.faces[face].edge

    def low(self, face: int) -> int:
        """The rank of the direction in which a face begins, counterclockwise, or NOWHERE."""
        return self.faces.floats.faces[face].low_rank()

    def high(self, face: int) -> int:
        """The rank of the direction in which a face stops."""
        return self.faces.floats.faces[face].high_rank()

    # -- directions --------------------------------------------------------------------------------

    def _order_events(self) -> None:
        """Group the events by direction, counterclockwise from the east: exact where floats leave doubt."""
        faces, sweep = self.faces, self._floats
        for event in sweep.look_up():
            x, y = faces.offset(event.number)
            upper = (sign(y) or (0 if sign(x) > 0 else -1)) >= 0
            sweep.put(event, upper)
        sweep.order()
        own = faces.own
        for at, events in reversed(sweep.open):
            lattice, parted = self.table.lattice, list[list[FaceEnd]]()
            if lattice is not None and len(own) == 2:
                # Two edges meet at the vertex at which the second one begins.
                parted = sweep.parted(events, lattice[1], own[1])
            sweep.part(at, parted or self._sorted(events))
        sweep.rank()
        self.rank: dict[int, int] = {}
        """Of the events that matter by themselves."""
        several = sweep.several() if sweep.open else []
        if faces.special:
            self.rank = {event.number: event.rank for event in faces.floats.events}
        self.special = sorted({*several, *(self.rank[event] for event in faces.special)})

    def events(self, rank: int) -> list[int]:
        """The events in a direction."""
        return [event.number for event in self._floats.events(rank)]

    def _sorted(self, events: list[FaceEnd]) -> list[list[FaceEnd]]:
        """Events grouped by exact direction, counterclockwise."""
        known = {event.number: event for event in events}
        return [[known[number] for number in group] for group in self._grouped(sorted(known))]

    def _grouped(self, events: list[int]) -> list[list[int]]:
        """Events by number likewise."""
        faces = self.faces
        if all(event < len(self.table.vertices) for event in events):
            vectors = [faces.offset(event) for event in events]
            if all(isinstance(x, fmpq) and isinstance(y, fmpq) for x, y in vectors):
                turns = sorted(zip(map(_turned, vectors), events, strict=True), key=itemgetter(0))
                return [[event for _, event in group] for _, group in groupby(turns, key=itemgetter(0))]
        # On a coarse lattice most directions that look the same are; with rounded coordinates most differ.
        long = {} if self.table.is_coarse else {event: faces.long_offset(event) for event in events}

        def compare(a: int, b: int) -> int:
            if faces.is_one_ray(a, b):
                return 0
            turn = clear_turn(long[a], long[b]) if long else 0
            return -(turn or _turn(faces.offset(a), faces.offset(b)))

        return in_groups(events, compare)

    def direction(self, rank: int) -> Vector:
        """The exact direction of a rank, rational where one of its events shows it."""
        lead = self._floats.leads[rank]
        if lead.beside is None:
            return self.faces.offset(lead.number)
        group = self.events(rank)
        if (ray := self.faces.ray(group)) is not None:
            return ray.direction
        vectors = map(self.faces.offset, group)
        shown = next((v for v in vectors if isinstance(v[0], fmpq) and isinstance(v[1], fmpq)), None)
        return self.faces.offset(group[0]) if shown is None else shown

    # -- cells -------------------------------------------------------------------------------------

    def _first(self) -> list[int]:
        """The first face of every cell."""
        sweep, cone = self._floats, self.faces.cone
        low, high = (-1, -1) if cone is None else (self.rank[cone.low], self.rank[cone.high])
        sweep.look(low, high)
        for cell, some in zip(sweep.doubts, sweep.rivals, strict=True):
            sweep.first[cell] = self.nearest(self._inner_direction(cell), some)
        return sweep.first

    def nearest(self, direction: Vector, faces: Sequence[int]) -> int:
        """The nearest of faces that all cover a direction: exact, where long balls leave it open."""
        clear = self._clearly_nearest(direction, faces)
        if clear is not None:
            return clear
        best, least = NOTHING, None
        ray = Point(*direction)
        for f in faces:
            tau = self.parameter(ray, f)
            if least is None or tau.compare(least) < 0:
                best, least = f, tau
        return best

    def _clearly_nearest(self, direction: Vector, faces: Sequence[int]) -> int | None:
        """The nearest of such faces, by long balls; None where these leave it open."""
        curves, (x, y), (dx, dy) = self.table.curves, long_vector(self.faces.origin), long_vector(direction)
        best: tuple[arb, int] | None = None
        with workprec(LONG):
            for f in faces:
                e = self.edge(f)
                met = None if e in self.faces.own else CurveBalls(curves[e], LONG).met((x, y, dx, dy), 1)
                if met is None or (best is not None and met[0].overlaps(best[0])):
                    return None
                if best is None or met[0] < best[0]:
                    best = met[0], f
        return None if best is None else best[1]

    def parameter(self, ray: Point, face: int) -> Real:
        """How many times a ray's vector leads from the point to a face that covers it."""
        e = self.edge(face)
        return _parameter(self.table.curves[e], self.faces.point, e in self.faces.own, ray)

    def _inner_direction(self, cell: int) -> Vector:
        """Some rational direction strictly within a cell."""
        if not self.count:
            return fmpq(1), fmpq(0)
        low, high = self.direction(cell), self.direction((cell + 1) % self.count)
        wide = self.count == 1 or sign(cross(low, high)) <= 0
        bits = 64
        while True:
            a, b = _approximate(low, bits), _approximate(high, bits)
            if wide:
                a = b = (-a[1], a[0])
            p, q = abs(a[0]) + abs(a[1]), abs(b[0]) + abs(b[1])
            if p and q:
                ray = a[0] * q + b[0] * p, a[1] * q + b[1] * p
                if wide or (sign(cross(low, ray)) > 0 and sign(cross(ray, high)) > 0):
                    return ray
            bits *= 2

    def _sights(self) -> list[FirstFace]:
        """Cells with the same first face joined, the first sight starting at a change."""
        found = self._floats.sights()
        if not found:
            face = self.first[0]
            rank = NOWHERE if not self.count else 0
            if face >= 0 and self.low(face) != NOWHERE:
                rank = self.low(face)
            return [FirstFace(face, rank, rank)]
        return found

    def parts(self) -> ViewParts:
        """What the range leaves of the sights, as far as floats tell."""
        return ViewParts(self._floats, self.sights, self.faces.count, self.faces.here)

    def rank_of(self, event: int) -> int:
        """The rank of an event's direction."""
        return self.faces.floats.event(event).rank

    # -- points ------------------------------------------------------------------------------------

    def at(self, face: int, rank: int, is_low: bool) -> Point:
        """The point of a face in the direction of a rank that the face covers, or that ends it."""
        if rank == (self.low if is_low else self.high)(face):
            return self.end(face, is_low)
        return self.late_hit(face, rank)

    def end(self, face: int, is_low: bool) -> Point:
        """The point that ends a face."""
        low, high = self.faces.ends(face)
        event = low if is_low else high
        return self.table.curves[self.edge(face)].start if event == NOWHERE else self.faces.place(event)

    def hit(self, face: int, rank: int) -> Point:
        """The point of a face in the direction of a rank that it covers."""
        faces, e = self.faces, self.edge(face)
        curve = self.table.curves[e]
        if faces.has_rays and (ray := faces.ray(self.events(rank))) is not None:
            known = ray.met.get(e)
            if known is not None:
                return known
            return self._touching(_hit(curve, ray.contact, False, ray.direction), rank)
        return self._touching(_hit(curve, faces.point, e in faces.own, self.direction(rank)), rank)

    def late_hit(self, face: int, rank: int) -> Point:
        """The point of a face in the direction of a rank that it covers, made when it is looked into."""
        faces, e = self.faces, self.edge(face)
        curve, own = self.table.curves[e], e in faces.own
        group = self.events(rank)
        if len(group) > 1 or faces.ray(group) is not None:
            return self.hit(face, rank)
        vector, make = faces.late_offset(group[0])
        around = _ball_hit(curve, faces.around, own, vector)
        return self._touching(late_point(around, _made_hit, curve, faces.point, own, make), rank)

    def _touching(self, hit: Point, rank: int) -> Point:
        """A point that was made in the direction of a rank, told which features the line to it touches.

        Rational numbers tell this themselves.
        """
        if not hit.is_late and hit.rational is not None and self.faces.point.rational is not None:
            return hit
        faces, count = self.faces, len(self.table.vertices)
        for event in self.events(rank):
            if event >= count:
                mark = faces.mark(event)
                arc = self.table.curves[mark.edge]
                assert isinstance(arc, Arc), "what is no vertex is the tangent of an arc"
                put_on_tangent(hit, faces.point, arc.carrier, mark.point)
            else:
                put_past_corner(hit, faces.point, self.table.starts[event])
        return hit

    def covering(self, rank: int) -> list[int]:
        """The faces that cover a rank's direction and do not end there."""
        return [face.number for face in self._floats.covering(rank)]

    def met(self, rank: int) -> tuple[int, list[int], int] | None:
        """What a ray in the direction of events meets (see `exactacq.kernel.single_rays`); None if that is
        open."""
        count = len(self.table.vertices)
        sure, struck, events, inside = single_rays.met(self._floats, rank, self.faces.here, count)
        return (struck, events, inside) if sure else None

    def blocks(self, event: int, rank: int, own: tuple[int, ...]) -> bool:
        """Whether a ray from the point in the direction of a vertex on it leads into the obstacle there."""
        table = self.table
        if event >= len(table.vertices):
            return False
        before = table.preceding[event]
        if clear := single_rays.blocks(self._floats, rank, event, event in own or before in own):
            return clear > 0
        incoming, outgoing = table.curves[before], table.curves[event]
        ways = leaving(incoming, at_end=True), leaving(outgoing, at_end=False)
        return enters(incoming, outgoing, *ways, self.direction(rank))


def _hit(curve: Curve, point: Point, own: bool, vector: Vector) -> Point:
    """Where a ray from a point meets a curve, which may pass through the point if it is an arc (*own*).

    On a straight edge s + u a with u = v x (p - s) / v x a: linear in one number, however p looks.
    """
    if isinstance(curve, Segment):
        start, along = raw(curve.start), raw(curve.direction)
        share = cross(vector, minus(raw(point), start)) / cross(vector, along)
        return advance(start, along, share)
    ray = Point(*vector)
    return point + ray * _parameter(curve, point, own, ray)


def _made_hit(curve: Curve, point: Point, own: bool, make: Callable[[], Vector]) -> Point:
    return _hit(curve, point, own, make())


def _ball_hit(curve: Curve, point: Balls, own: bool, vector: Balls) -> Balls:
    """Balls around that point, perhaps not finite."""
    (x, y), (u, v) = point, vector
    if own:
        assert isinstance(curve, Arc), "no ray meets a straight edge through its place again"
        cx, cy = balls(curve.center)
        tau = 2 * ((cx - x) * u + (cy - y) * v) / (u * u + v * v)
        return x + u * tau, y + v * tau
    met = CurveBalls(curve).met((x, y, u, v), 1)
    return NOWHERE_KNOWN if met is None else met[1]


def _parameter(curve: Curve, point: Point, own: bool, ray: Point) -> Real:
    if own and isinstance(curve, Arc):
        # The ray meets the circle at the point itself, and again at twice the foot of the centre.
        tau: Real = 2 * (curve.center - point).dot(ray) / ray.norm_sq()
        return tau
    return meet(point, ray, curve, 1)


def _turned(vector: Vector) -> tuple[bool, bool, fmpq]:
    """How far a rational direction is turned from the east, in an order: half turns, and - x / y in each."""
    x, y = vector
    lower = y < 0 or (y == 0 and x < 0)
    return (lower, True, -x / y) if y != 0 else (lower, False, x * 0)


def _turn(a: Vector, b: Vector) -> int:
    """1 if b comes after a, counterclockwise from the east, -1 if before, 0 if they are parallel."""
    upper = [sign(y) > 0 or (sign(y) == 0 and sign(x) > 0) for x, y in (a, b)]
    if upper[0] != upper[1]:
        return 1 if upper[0] else -1
    return sign(cross(a, b))


def _approximate(vector: Vector, bits: int) -> tuple[fmpq, fmpq]:
    """Rational coordinates near a vector's, relative to its size."""
    x, y = (c if isinstance(c, fmpq) else rational(Real(c).enclosure(bits)[0]) for c in vector)
    return x, y
