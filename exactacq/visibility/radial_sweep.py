"""The sweep of a point: what is met first in every direction, by a radial sweep.

Rays from the point meet front faces of obstacles (faces, see `exactacq.visibility.front_faces`). The
ends of the faces within reach, sorted by direction, divide the full turn into cells; in a cell the order
of the faces along all rays is the same, since boundaries do not cross. So for each cell the nearest of
the faces that cover it is found on one ray. Floats propose the order of the events and the nearest
faces; where their proven margins overlap, the exact values decide.
Cost for n edges within reach: O(n log n + k), k the number of pairs of a cell and a face covering it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from itertools import pairwise
from math import inf, pi
from typing import NamedTuple

import numpy as np
from flint import arb, fmpq

from exactacq.geometry.coordinates import Vector, advance, cross, minus, raw, sign
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.late import Balls, balls, late_point
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import STRAIGHT, EdgeTable, Floats, Ints, quotient
from exactacq.visibility.chords import meet
from exactacq.visibility.features import enters, leaving
from exactacq.visibility.front_faces import NOWHERE, VAGUE, FrontFaces

NOTHING, BLOCKED = -1, -2
"""First faces of cells without one: nothing within reach, and inside the point's own obstacle."""
SEAM = 2 * pi


class FirstFace(NamedTuple):
    """Directions, counterclockwise from rank ``low`` to rank ``high``, in which one face comes first.

    ``face`` may be NOTHING or BLOCKED. All around if ``low == high``; without events both are NOWHERE.
    """

    face: int
    low: int
    high: int


class RadialSweep:
    """The sights of a free point, counterclockwise, and the exact points where they begin and end.

    *own* are the edges through the point (see `FrontFaces`). Faces beyond *reach* are left out, and what lies
    beyond it may be reported wrongly or as NOTHING.
    """

    def __init__(self, table: EdgeTable, point: Point, reach: float, own: tuple[int, ...]) -> None:
        self.table = table
        self.faces = FrontFaces(table, point, reach, own)
        self.edges: list[int] = self.faces.edge.tolist()
        """The edge of every face, and the events that end it, as plain numbers."""
        self.ends_low: list[int] = self.faces.low.tolist()
        self.ends_high: list[int] = self.faces.high.tolist()
        self.groups: list[list[int]] = []
        self._order_events()
        self.count = len(self.groups)
        self._covers()
        self.first = self._first()
        self.sights = self._sights()

    # -- directions --------------------------------------------------------------------------------

    def _order_events(self) -> None:
        """Group the events by direction, counterclockwise from the east: exact where floats leave doubt."""
        faces = self.faces
        count = len(faces.edge)
        parts = (faces.low, faces.high, np.array(faces.special, dtype=np.intp))
        ids = np.concatenate(parts if faces.special else parts[:2])
        angle, margin = self._angles(ids)
        below, above = angle - margin, angle + margin
        seam = (below < 0) | (above > SEAM)
        if seam.any():
            for k in np.flatnonzero(seam).tolist():
                if ids[k] != NOWHERE:
                    x, y = faces.offset(int(ids[k]))
                    upper = (sign(y) or (0 if sign(x) > 0 else -1)) >= 0
                    if upper != (angle[k] < pi) and margin[k] < VAGUE:
                        angle[k] = 0.0 if upper else SEAM
            below, above = angle - margin, angle + margin
        order = np.argsort(below, kind="stable")
        if faces.curved and (ids == NOWHERE).any():
            order = order[ids[order] != NOWHERE]
        # Most events end two faces, and come twice: with the same angle and margin, so without a gap between.
        events = ids[order]
        gap = np.ones(len(order), dtype=bool)
        gap[1:] = below[order[1:]] > np.maximum.accumulate(above[order[:-1]])
        starts = np.flatnonzero(gap)
        rank = np.full(len(ids), NOWHERE)
        if len(starts) == min(len(order), 1) + np.count_nonzero(events[1:] != events[:-1]):
            self.groups = [[event] for event in events[starts].tolist()]
            rank[order] = np.cumsum(gap) - 1
            chosen = order[starts]
            self.angle, self.margin = angle[chosen], margin[chosen]
        else:
            self._separate(events.tolist(), below[order].tolist(), starts.tolist())
            where = {event: k for k, group in enumerate(self.groups) for event in group}
            rank[order] = [where[event] for event in events.tolist()]
            self.angle, self.margin = np.zeros(len(self.groups)), np.zeros(len(self.groups))
            self.angle[rank[order]] = angle[order]
            np.maximum.at(self.margin, rank[order], margin[order])
        self._low, self._high = rank[:count], rank[count : 2 * count]
        self.low: list[int] = self._low.tolist()
        self.high: list[int] = self._high.tolist()
        self.rank = dict(zip(ids.tolist(), rank.tolist(), strict=True)) if faces.special else {}
        self.special = sorted(
            {self.rank[e] for e in faces.special} | {r for r, g in enumerate(self.groups) if len(g) > 1}
        )

    def _separate(self, events: list[int], below: list[float], starts: list[int]) -> None:
        """Group sorted events; only within runs, which begin at *starts*, margins leave the order open."""
        key = dict(zip(events, below, strict=True))
        for a, b in pairwise((*starts, len(events))):
            some = set(events[a:b])
            self.groups += self._sorted(sorted(some, key=lambda event: (key[event], event)))

    def _angles(self, ids: Ints) -> tuple[Floats, Floats]:
        """Directions of events as angles in [0, 2 pi], with their margins."""
        faces, table = self.faces, self.table
        count, slack = len(table.vertices), faces.slack
        plain = not (faces.marks or faces.curved)
        vertices = ids if plain else np.where((ids >= 0) & (ids < count), ids, 0)
        x, y = table.rows[:2, vertices] if len(ids) else np.zeros((2, 0))
        x -= faces.xy[0]
        y -= faces.xy[1]
        size = np.hypot(x, y)
        margin = 2 * slack / np.maximum(size, 16 * slack) + 2e-15
        margin[size <= 16 * slack] = VAGUE
        if not plain:
            for k in np.flatnonzero((ids < 0) | (ids >= count)).tolist():
                x[k], y[k], margin[k] = 0.0, 0.0, VAGUE
                if ids[k] >= 0:
                    mark = faces.marks[int(ids[k]) - count]
                    (x[k], y[k]), margin[k] = mark.xy, mark.margin
        for e in faces.special:
            if e < count:
                u, v = faces.offset(e)
                some = ids == e
                x[some], y[some], margin[some] = float(u), float(v), 2e-15
        angle = np.arctan2(y, x)
        return np.where(angle < 0, angle + SEAM, angle), margin

    def _sorted(self, events: list[int]) -> list[list[int]]:
        """Events grouped by exact direction, counterclockwise."""
        groups: list[list[int]] = []
        for event in events:
            vector = self.faces.offset(event)
            low, high = 0, len(groups)
            while low < high:
                middle = (low + high) // 2
                order = _turn(self.faces.offset(groups[middle][0]), vector)
                if order == 0:
                    groups[middle].append(event)
                    break
                low, high = (middle + 1, high) if order > 0 else (low, middle)
            else:
                groups.insert(low, [event])
        return groups

    def direction(self, rank: int) -> Vector:
        """The exact direction of a rank, rational where one of its events shows it."""
        group = self.groups[rank]
        if len(group) == 1:
            return self.faces.offset(group[0])
        vectors = [self.faces.offset(event) for event in group]
        return next((v for v in vectors if isinstance(v[0], fmpq) and isinstance(v[1], fmpq)), vectors[0])

    # -- cells -------------------------------------------------------------------------------------

    def _covers(self) -> None:
        """All pairs of a face and a cell that it covers; cell k lies counterclockwise of rank k."""
        cells = max(self.count, 1)
        spans = (self._high - self._low) % cells
        spans[self._low == NOWHERE] = cells
        self._facet = np.repeat(np.arange(len(spans)), spans)
        before = np.cumsum(spans) - spans
        self._cell = (np.arange(len(self._facet)) - before[self._facet] + self._low[self._facet]) % cells

    def _first(self) -> list[int]:
        """The first face of every cell."""
        cells = max(self.count, 1)
        first = np.full(cells, NOTHING)
        if len(self._facet):
            tau, error = self._distances()
            limit = np.full(cells, inf)
            np.minimum.at(limit, self._cell, tau + error)
            close = np.flatnonzero(~((tau - error) > limit[self._cell]))
            cell = self._cell[close]
            first[cell] = self._facet[close]
            if len(cell) > 1:
                rivals = np.bincount(cell, minlength=cells) > 1
                for k in np.flatnonzero(rivals).tolist():
                    some = self._facet[close[cell == k]].tolist()
                    first[k] = self.nearest(self._inner_direction(k), some)
        cone = self.faces.cone
        if cone is not None:
            low, high = self.rank[cone.low], self.rank[cone.high]
            span = (high - low) % cells or cells
            first[(np.arange(span) + low) % cells] = BLOCKED
        found: list[int] = first.tolist()
        return found

    def _distances(self) -> tuple[Floats, Floats]:
        """Float distances of the pairs' faces along the middle rays of their cells, with error bounds."""
        faces, table, slack = self.faces, self.table, self.faces.slack
        if self.count:
            angle = np.append(self.angle, self.angle[0] + SEAM)
            middle = (angle[1:] + angle[:-1]) / 2
            rough = np.maximum(self.margin, np.append(self.margin[1:], self.margin[0])) + 2e-15
        else:
            middle, rough = np.zeros(1), np.full(1, 2e-15)
        face, cell = self._facet, self._cell
        ux, uy, rough = np.array((np.cos(middle), np.sin(middle), rough))[:, cell]
        _, _, ax, ay, above, spread = faces.rows[:, face]
        size = np.abs(ax) + np.abs(ay)
        spread += 4 * slack * slack
        below = ux * ay
        below -= uy * ax
        clear = np.abs(below)
        doubt = size * rough
        doubt += 4 * slack
        sure = clear > 8 * doubt
        if not sure.all():
            # Where the face runs along the ray, nothing is known.
            below[~sure], clear[~sure], spread[~sure] = 1.0, 1.0, inf
        tau = above / below
        error = 2 * (spread + np.abs(tau) * doubt) / clear
        if faces.curved:
            edge = faces.edge[face]
            curved = np.flatnonzero(table.kind[edge] != STRAIGHT)
            e, ux, uy, rough = edge[curved], ux[curved], uy[curved], rough[curved]
            w, radius = table.center[e] - faces.xy, table.radius[e]
            along, across = w[:, 0] * ux + w[:, 1] * uy, w[:, 1] * ux - w[:, 0] * uy
            off = 4 * slack + (np.abs(w).sum(axis=1) + radius) * rough
            half = np.sqrt(np.maximum((radius - np.abs(across)) * (radius + np.abs(across)), 0.0))
            tau[curved] = along - table.kind[e] * half
            error[curved] = np.where(half > 8 * off, off * (2 + quotient(4 * radius, half)), inf)
        return tau, error

    def nearest(self, direction: Vector, faces: Iterable[int]) -> int:
        """The nearest of faces that all cover a direction; exact."""
        best, least = NOTHING, None
        ray = Point(*direction)
        for f in faces:
            tau = self.parameter(ray, f)
            if least is None or tau.compare(least) < 0:
                best, least = f, tau
        return best

    def parameter(self, ray: Point, face: int) -> Real:
        """How many times a ray's vector leads from the point to a face that covers it."""
        e = self.edges[face]
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
        first = self.first
        changes = [k for k, face in enumerate(first) if face != first[k - 1]]
        if not changes:
            face = first[0]
            rank = NOWHERE if not self.count else 0
            if face >= 0 and self.low[face] != NOWHERE:
                rank = self.low[face]
            return [FirstFace(face, rank, rank)]
        ends = [*changes[1:], changes[0]]
        return list(map(FirstFace._make, zip([first[k] for k in changes], changes, ends, strict=True)))

    # -- points ------------------------------------------------------------------------------------

    def at(self, face: int, rank: int, is_low: bool) -> Point:
        """The point of a face in the direction of a rank that the face covers, or that ends it."""
        if rank == (self.low if is_low else self.high)[face]:
            return self.end(face, is_low)
        return self.late_hit(face, rank)

    def end(self, face: int, is_low: bool) -> Point:
        """The point that ends a face."""
        event = (self.ends_low if is_low else self.ends_high)[face]
        return self.table.curves[self.edges[face]].start if event == NOWHERE else self.faces.place(event)

    def hit(self, face: int, vector: Vector) -> Point:
        """The point of a face in a direction that it covers."""
        e = self.edges[face]
        return _hit(self.table.curves[e], self.faces.point, e in self.faces.own, vector)

    def late_hit(self, face: int, rank: int) -> Point:
        """The point of a face in the direction of a rank that it covers, made when it is looked into."""
        faces, e = self.faces, self.edges[face]
        curve, own = self.table.curves[e], e in faces.own
        group = self.groups[rank]
        if len(group) > 1:
            return self.hit(face, self.direction(rank))
        vector, make = faces.late_offset(group[0])
        around = _ball_hit(curve, faces.around, own, vector)
        return late_point(around, partial(_made_hit, curve, faces.point, own, make))

    def covering(self, rank: int) -> list[int]:
        """The faces that cover a rank's direction and do not end there."""
        if not len(self._facet):
            return []
        some = self._facet[self._cell == rank]
        return [f for f in some.tolist() if self.low[f] != rank]

    def blocks(self, event: int, direction: Vector) -> bool:
        """Whether a ray from the point in the direction of a vertex leads into the obstacle there."""
        table = self.table
        if event >= len(table.vertices):
            return False
        owner = int(table.owner[event])
        first = int(table.first[owner])
        last = first + len(table.obstacles[owner].edges) - 1
        incoming = table.curves[event - 1 if event > first else last]
        outgoing = table.curves[event]
        before, after = leaving(incoming, at_end=True), leaving(outgoing, at_end=False)
        return enters(incoming, outgoing, before, after, direction)


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
    if isinstance(curve, Segment):
        (sx, sy), (ax, ay) = balls(curve.start), balls(curve.direction)
        share = (u * (y - sy) - v * (x - sx)) / (u * ay - v * ax)
        return sx + ax * share, sy + ay * share
    cx, cy = balls(curve.center)
    cx, cy = cx - x, cy - y
    middle, size = cx * u + cy * v, u * u + v * v
    if own:
        tau = 2 * middle / size
    else:
        root = (middle * middle - size * (cx * cx + cy * cy - arb(curve.radius_sq))).sqrt()
        tau = (middle - root if curve.ccw else middle + root) / size
    return x + u * tau, y + v * tau


def _parameter(curve: Curve, point: Point, own: bool, ray: Point) -> Real:
    if own and isinstance(curve, Arc):
        # The ray meets the circle at the point itself, and again at twice the foot of the centre.
        tau: Real = 2 * (curve.center - point).dot(ray) / ray.norm_sq()
        return tau
    return meet(point, ray, curve, 1)


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
