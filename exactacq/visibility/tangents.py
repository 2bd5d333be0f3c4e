"""Free tangents between pegs: bitangents, tangents through places, and segments between these.

A segment of length L in direction u from entry 0 to entry 1 touches circles about c0 and c1 with radii r0 and
r1 (0 for a point) on sides s0 and s1. With n, u turned to the left by a quarter, the contacts are
c - s r n, so with D = c1 - c0 and k = s1 r1 - s0 r0, in complex numbers,

    D = (L + i k) u,    L = sqrt(|D|^2 - k^2),    u = D (L - i k) / |D|^2.

Floats compute this for all entries at once, with bounds of the errors. Let w bound the error of every
coordinate, radius, and difference of two of them. Then |D| is off by at most 2 w and k by w; of |D| - |k|
and |D| + |k|, whose product is L^2, both by less than 4 w. That bounds L from both sides; let e be how far
these bounds are apart. In u = D (L - i k) / |D|^2 two vectors of length |D| are multiplied. The first is off
by at most 2 w, the second by e + w, and |D| by 2 w twice: together by (e + 7 w) / |D|, to first order. Twice
(e + 8 w) / |D| is taken, and 2^-49 for the roundings; where that is more than 1, nothing is decided.

A tangent counts only from one touch to the next: one that touches a further corner or arc on its way is the
sum of others. So every way has one form. What a line does not cross of a chain it touches at a peg, unless it
runs along it from one peg to the next. So a tangent that meets a chain on its way is none, and one that runs
along a piece of it has both its ends on the same side.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from math import ceil, hypot, sqrt

import numpy as np

from exactacq.cached import cached_property
from exactacq.geometry.coordinates import cross, raw, sign
from exactacq.geometry.curve_images import held_point
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point, distance
from exactacq.kernel.clearance import Place, crossed
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import Floats
from exactacq.visibility.chain_table import ChainTable
from exactacq.visibility.free_segment import is_free_among
from exactacq.visibility.pegs import EntryRows, Peg, Pegs

NO, UNSURE, YES = -1, 0, 1
ROUNDINGS = 2.0**-46
"""More than all roundings of a formula here, of numbers that are no longer than 1."""
FEW = 2.0
"""A part of a segment spans so many times the mean distance of edges, were they spread evenly."""
KEPT = 64
"""Beams that are kept: several labels of an arc ask for the same."""
MOST = 64
"""Most parts of a segment."""


@dataclass(frozen=True, slots=True)
class FreeTangent:
    """A free segment from one entry to another."""

    start: Point
    end: Point
    length: Real

    @property
    def curve(self) -> Segment:
        """The segment."""
        return Segment(self.start, self.end)


class Beams:
    """What floats tell of the tangents from one entry to others; ``entries`` are those that there may be.

    ``verdict`` is `YES` where both pegs are certainly touched. ``low`` bounds the lengths from below,
    ``start`` and ``end`` are the contacts, off by ``blur``; ``turn`` and ``arrival`` say how far along the
    arcs of both entries, as angles from their starts, the contacts are, but for ``slack``.
    """

    def __init__(self, pegs: Pegs, entry: int) -> None:
        w, rows = margin(2.0**-50 * pegs.largest), pegs.rows
        source = rows.some(slice(entry, entry + 1))
        with np.errstate(all="ignore"):
            across = rows.centers - source.centers
            far = np.hypot(across[:, 0], across[:, 1])
            if pegs.is_curved:
                k = rows.rhos - source.rhos
                less, more = far - np.abs(k), far + np.abs(k)
                low = np.sqrt(np.maximum(less - 4 * w, 0.0) * np.maximum(more - 4 * w, 0.0))
                high = np.sqrt(np.maximum(less + 4 * w, 0.0) * (more + 4 * w))
                low, high = low * (1 - 2.0**-50), high * (1 + 2.0**-50)
                length = np.sqrt(np.maximum(less, 0.0) * more)
                along = across[:, 0] * length + across[:, 1] * k, across[:, 1] * length - across[:, 0] * k
                u = np.stack(along, axis=1) / (far * far)[:, None]
                error = 2 * (high - low + 8 * w) / far + 2.0**-49
            else:
                less, low = far, far * (1 - 2.0**-50) - 4 * w
                u, error = across / far[:, None], 32 * w / far + 2.0**-49
            leaves, turn = _touches(source, u, error)
            open_ = (leaves != NO) & ~(less + 4 * w < 0) & (rows.numbers != source.numbers)
            entries = np.flatnonzero(open_)
            lands, arrival = _touches(rows.some(entries), u[entries], error[entries])
            verdict = np.minimum(leaves[entries], lands)
            verdict[(verdict == YES) & ~(less[entries] - 4 * w > 0)] = UNSURE
            kept = verdict != NO
            self.entries, self.verdict, self.arrival = entries[kept], verdict[kept], arrival[kept]
            rest = self.entries
            self.turn, error, right = turn[rest], error[rest], _right(u[rest])
            self.low = np.maximum(np.nan_to_num(low[rest], nan=0.0, posinf=0.0), 0.0)
            self.slack = _angular(error)
            self.start = source.centers + source.rhos * right
            self.end = rows.centers[rest] + rows.rhos[rest, None] * right
            size = np.maximum(np.abs(rows.rhos[rest]), np.abs(source.rhos))
            self.blur = 4 * w + size * (error + ROUNDINGS)

    def at(self, entry: int) -> int | None:
        """Where in the arrays an entry is; None where there is certainly no tangent."""
        k = int(np.searchsorted(self.entries, entry))
        return k if k < len(self.entries) and self.entries[k] == entry else None


def _right(u: Floats) -> Floats:
    """Vectors turned to the right by a quarter."""
    return np.stack((u[:, 1], -u[:, 0]), axis=1)


def _angular(error: Floats) -> Floats:
    """Bounds of the errors of angles: an error of a unit vector, less than 1, counts 60 % more at most."""
    slack = error + ROUNDINGS
    return np.where(slack < 1, 1.6 * slack, np.inf)


def _touches(rows: EntryRows, u: Floats, error: Floats) -> tuple[Floats, Floats]:
    """Whether lines in directions *u* touch the corners and arcs of entries; how far along these.

    There is a row for each direction, or one for all of them.
    """
    verdict, angle = np.full(len(u), YES), np.zeros(len(u))
    corner, arc = rows.ranges.any(axis=1), rows.spokes.any(axis=1)
    if corner.any():
        first = rows.ranges[:, 0] * u[:, 1] - rows.ranges[:, 1] * u[:, 0]
        last = u[:, 0] * rows.ranges[:, 3] - u[:, 1] * rows.ranges[:, 2]
        least, slack = np.minimum(first, last), error + ROUNDINGS
        verdict[corner & ~(least > slack)] = UNSURE
        verdict[corner & (least < -slack)] = NO
    if arc.any():
        # The contact lies from the centre to the right of the way, on side 1.
        spoke, slack = np.sign(rows.rhos)[:, None] * _right(u), _angular(error)
        height = rows.spokes[:, 0] * spoke[:, 1] - rows.spokes[:, 1] * spoke[:, 0]
        angle = np.arctan2(height, (rows.spokes * spoke).sum(axis=1))
        angle = np.where(angle < 0, angle + 2 * np.pi, angle)
        part = np.isfinite(rows.angles)
        verdict[part & ~((angle > slack) & (angle < rows.angles - slack))] = UNSURE
        verdict[part & (angle > rows.angles + slack) & (angle < 2 * np.pi - slack)] = NO
        verdict[arc & ~np.isfinite(slack)] = UNSURE
        # Just before the start, where that is unsure.
        angle = np.where(part & (angle > rows.angles / 2 + np.pi), angle - 2 * np.pi, angle)
    return verdict, angle


class Tangents:
    """The free tangents of a scene's pegs, each made once; those of places are forgotten with these."""

    def __init__(self, pegs: Pegs) -> None:
        self.pegs, self.table = pegs, pegs.table
        self._beams: dict[int, Beams] = {}
        self._known: dict[tuple[int, int], FreeTangent | None] = {}
        self._of_places: dict[tuple[int, int], FreeTangent | None] = {}

    def with_places(self, places: Sequence[Point]) -> Tangents:
        """These tangents and those to and from some places."""
        tangents = copy(self)
        tangents.pegs = self.pegs.with_places(places)
        tangents._beams, tangents._of_places = {}, {}
        return tangents

    def beams(self, entry: int) -> Beams:
        """What floats tell of the tangents from an entry; the last ones are kept."""
        if entry not in self._beams:
            if len(self._beams) >= KEPT:
                self._beams.pop(next(iter(self._beams)))
            self._beams[entry] = Beams(self.pegs, entry)
        return self._beams[entry]

    def between(self, i: int, j: int) -> FreeTangent | None:
        """The free tangent from entry i to entry j, from one touch to the next; None if there is none."""
        known = self._known if max(i, j) < 2 * self.pegs.own else self._of_places
        if (i, j) not in known:
            turned = self.pegs.turned(j), self.pegs.turned(i)
            if turned in known:
                back = known[turned]
                known[i, j] = None if back is None else FreeTangent(back.end, back.start, back.length)
            else:
                known[i, j] = self._made(i, j)
        return known[i, j]

    def _made(self, i: int, j: int) -> FreeTangent | None:
        beams, pegs = self.beams(i), self.pegs
        k = beams.at(j)
        if k is None:
            return None
        is_sure, blur = beams.verdict[k] == YES, float(beams.blur[k])
        if blur < self._stride:
            rough = [(*beams.start[k].tolist(), blur), (*beams.end[k].tolist(), blur)]
            if self._doubtful(i, j, *rough) is None:
                return None
        line = None if self._is_on_circle(i, j) or self._is_on_circle(j, i) else self._line(i, j)
        if line is None or line.tangent.length.sign() == 0:
            return None
        start, end, along = line.tangent.start, line.tangent.end, line.along
        if not is_sure and not (self._is_touched(i, start, along) and self._is_touched(j, end, along)):
            return None
        edges = self._doubtful(i, j, held_point(start), held_point(end))
        if edges is None:
            return None
        if isinstance(self.table, ChainTable):
            chained = [e for e in edges if e >= self.table.solids]
            edges = [e for e in edges if e < self.table.solids]
            if self._meets_chain(self.table, i, j, line, chained):
                return None
        if self._is_divided(i, j, line, edges) or not is_free_among(self.table, start, end, edges):
            return None
        for entry, contact, way in ((i, start, along), (j, end, -along)):
            peg, _ = pegs.entries[entry]
            if not (is_sure and not peg.is_place) and not pegs.may_leave(entry, contact, way):
                return None
        return line.tangent

    def _is_on_circle(self, i: int, j: int) -> bool:
        """Whether entry i is seen to be a point of the circle of entry j, to which it has no tangent."""
        (one, _), (other, _) = self.pegs.entries[i], self.pegs.entries[j]
        if one.arc is not None or other.arc is None:
            return False
        circle = self.table.on_circle_of(other.edges[0])
        return any(e in circle for e in one.edges)

    def _line(self, i: int, j: int) -> _Touching | None:
        """The exact tangent, whatever is in its way."""
        (one, side), (other, turn) = self.pegs.entries[i], self.pegs.entries[j]
        across = other.center - one.center
        if one.arc is None and other.arc is None:
            length = distance(one.center, other.center)
            return _Touching(FreeTangent(one.center, other.center, length), across, Real(1))
        k = other.radius * turn - one.radius * side
        square = across.norm_sq()
        rest = square - k * k
        if square.sign() == 0 or rest.sign() < 0:
            return None
        length = rest.sqrt()
        x, y = across.x, across.y
        u = Point((x * length + y * k) / square, (y * length - x * k) / square)
        right = -u.left()
        start = one.center if one.arc is None else one.center + right * (one.radius * side)
        end = other.center if other.arc is None else other.center + right * (other.radius * turn)
        return _Touching(FreeTangent(start, end, length), u, length)

    def _is_touched(self, entry: int, contact: Point, along: Point) -> bool:
        """Whether a line that touches the circle of an entry touches its peg."""
        peg, side = self.pegs.entries[entry]
        if peg.arc is not None:
            return peg.owns(contact)
        if peg.range is None:
            return True
        way = raw(along if side > 0 else -along)
        first, last = map(raw, peg.range)
        return sign(cross(first, way)) >= 0 and sign(cross(way, last)) >= 0

    # -- what is in the way --------------------------------------------------------------------------

    @cached_property
    def _stride(self) -> float:
        """How long the parts of segments are whose surroundings are looked at in one go."""
        boxes = self.table.boxes
        if not len(boxes):
            return 1.0
        size = float((boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)).max())
        return FEW * size / sqrt(len(boxes))

    def _doubtful(self, i: int, j: int, start: Place, end: Place) -> list[int] | None:
        """The edges that a segment may meet beyond its ends' own pegs; None if it surely crosses one.

        Parts of it are looked at one after the other, as most segments are crossed early.
        """
        (ax, ay, a), (bx, by, b) = start, end
        reach, long = max(a, b), hypot(bx - ax, by - ay)
        count = max(1, min(MOST, ceil(long / self._stride)))
        seen, found = set(self._own(i) + self._own(j)), list[int]()
        x, y = ax, ay
        for part in range(1, count + 1):
            u, v = (
                (bx, by) if part == count else (ax + (bx - ax) * part / count, ay + (by - ay) * part / count)
            )
            near = self.table.around((min(x, u), min(y, v)), (max(x, u), max(y, v)), reach)
            edges = [e for e in near if e not in seen]
            verdicts = crossed(self.table.images, edges, start, end)
            if 1 in verdicts:
                return None
            found += [e for e, verdict in zip(edges, verdicts, strict=True) if verdict == 0]
            seen.update(edges)
            x, y = u, v
        return found

    def _own(self, entry: int) -> tuple[int, ...]:
        """Edges that no tangent of an entry crosses: its circle's, and straight ones through its point."""
        peg, _ = self.pegs.entries[entry]
        if peg.arc is not None:
            return self.table.on_circle_of(peg.edges[0])
        own = [e for e in peg.edges if isinstance(self.table.curves[e], Segment)]
        if isinstance(self.table, ChainTable):
            own += [self.table.twin(e) for e in own]
        return tuple(own)

    def _meets_chain(self, table: ChainTable, i: int, j: int, line: _Touching, edges: Sequence[int]) -> bool:
        """Whether a tangent meets a chain on its way, but for chains away from these edges and its own ones.

        So does one that runs along a piece of a chain and has its ends on different sides of that.
        """
        pegs, ends = [self.pegs.entries[entry][0] for entry in (i, j)], (line.tangent.start, line.tangent.end)
        for e in edges:
            circle = table.on_circle_of(e)
            on = [
                peg.arc is None and (table.twin(e) in peg.edges or any(f in circle for f in peg.edges))
                for peg in pegs
            ]
            if table.touches(e, *ends, (on[0], on[1])):
                return True
        own, other = (
            {
                e
                for e in self.pegs.rim(peg, contact)
                if e >= table.solids and isinstance(table.curves[e], Segment)
            }
            for peg, contact in zip(pegs, ends, strict=True)
        )
        along = {e for e in own if e in other or table.twin(e) in other}
        if along:
            return not own & other
        beyond = (table.curves[e] for e in own | other)
        return any(line.passes(point) for curve in beyond for point in (curve.start, curve.end))

    def _is_divided(self, i: int, j: int, line: _Touching, edges: list[int]) -> bool:
        """Whether a segment that meets some edges touches a further peg on its way."""
        pegs, table = self.pegs, self.table
        ends = pegs.entries[i][0], pegs.entries[j][0]
        vertices = {v for e in edges for v in (e, table.following[e])}
        points = [pegs.at_vertex[v] for v in vertices if v in pegs.at_vertex]
        if any(line.passes(peg.center) for peg in points if peg not in ends):
            return True
        arcs = (peg for e in edges for peg in pegs.on_edge.get(e, ()) if peg not in ends)
        return any(contact is not None and peg.owns(contact) for peg in arcs if (contact := line.touch(peg)))


@dataclass(frozen=True, slots=True)
class _Touching:
    """A tangent with a vector along it that times ``reach`` leads from its start to its end."""

    tangent: FreeTangent
    along: Point
    reach: Real

    def passes(self, point: Point) -> bool:
        """Whether a point lies on it, between its ends."""
        offset = point - self.tangent.start
        return self.along.cross(offset).sign() == 0 and self._is_within(offset)

    def touch(self, peg: Peg) -> Point | None:
        """The point between its ends in which it touches the circle of an arc."""
        offset, size = peg.center - self.tangent.start, self.along.norm_sq()
        assert peg.arc is not None
        height = self.along.cross(offset)
        if (height * height).compare(size * peg.arc.radius_sq) != 0 or not self._is_within(offset):
            return None
        return self.tangent.start + self.along * (offset.dot(self.along) / size)

    def _is_within(self, offset: Point) -> bool:
        way = offset.dot(self.along)
        return way.sign() > 0 and way.compare(self.reach * self.along.norm_sq()) < 0
