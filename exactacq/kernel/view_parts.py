"""What the range leaves of the faces that a place sees first, and the outline of that, in floats with bounds.

Ends of parts are numbers: those of events where a face ends (see `exactacq.kernel.radial_faces`), and from
``base`` on those of ends that are made here: `HIT`, where a ray in the direction of an event meets a face
behind it, and `CROSSING`, where an edge leaves the range. Negative ends are no points of edges: `HERE` is the
place itself, and -2 - k the point of the circle of the range in direction k.
"""

from __future__ import annotations

from math import inf
from typing import Any, Final, final

from exactacq.kernel.bounded import UNIT, WIDEN, cross, dot, length, product, quotient, root, total
from exactacq.kernel.images import STRAIGHT
from exactacq.kernel.radial_faces import Face, FaceEnd
from exactacq.kernel.radial_sweep import BLOCKED, FaceSweep, FirstFace, Part

HIT: Final = 0
"""An end (HIT, face, rank of the direction)."""
CROSSING: Final = 1
"""An end (CROSSING, face, 1 where the edge leaves the range or -1 where it enters it)."""
GIVEN: Final = 2
"""An end that whoever asks has made: (GIVEN, anything, anything)."""
HERE: Final = -1
"""The place itself."""
NOWHERE: Final = -1 << 40
"""No end."""
RANGE: Final = -1
"""In place of a piece's edge: an arc of the circle of the range."""
WINDOW: Final = -2
"""A piece of a ray, with the end that is nearer, or `HERE` if neither face ends there or both do."""
FROM_HERE: Final = -3
"""What joins the place itself to a point, with the rank of the direction."""
OWN: Final = -4
"""The place itself, as a part between the pieces next to its own obstacle."""


@final
class OutlinePiece:
    """A piece of the outline: its edge, `RANGE` or `WINDOW`, and both ends, counterclockwise.

    ``near`` is the end of a window that is nearer, and ``sight`` the number of the sight that it is made of.
    Its ``curve`` is made, and kept here, by whoever asks.
    """

    def __init__(self, edge: int, start: int, end: int, near: int, sight: int) -> None:
        self.edge, self.start, self.end, self.near, self.sight = edge, start, end, near, sight
        self.curve: Any = None


@final
class ViewParts:
    """The parts of all sights; of one that goes all around nothing is told.

    Each sight gets the ends of all that is seen of it, and the parts of that within range. Where floats leave
    these open there are none, and ``doubts`` tell the sight's number. *here* are the events that are the
    place itself.
    """

    def __init__(self, sweep: FaceSweep, sights: list[FirstFace], base: int, here: list[int]) -> None:
        self.sweep, self.faces = sweep, sweep.faces
        self.sights, self.base, self.here = sights, base, here
        self.made: list[tuple[int, int, int]] = []
        self.doubts: list[int] = []
        faces, images = self.faces.faces, self.faces.images
        for n in range(len(sights)):
            sight = sights[n]
            if sight.face < 0:
                continue
            if sight.low == sight.high:
                sight.parts = []
                continue
            face = faces[sight.face]
            sight.start = self._end(face.high, sight.high, face)
            sight.end = self._end(face.low, sight.low, face)
            if face.within and not (here and sight.start in here and sight.end in here):
                continue
            if images[face.edge].kind == STRAIGHT:
                sight.parts = self._clipped(n, face, sight.start, sight.end)
            else:
                self.doubts.append(n)
                sight.parts = []

    def add(self, kind: int, face: int, which: int) -> int:
        """The number of a new end."""
        self.made.append((kind, face, which))
        return self.base + len(self.made) - 1

    def within(self, sight: FirstFace) -> list[Part]:
        """What is seen of a sight within range."""
        if sight.parts is None:
            return [(sight.start, sight.end)] if sight.face >= 0 else []
        return sight.parts

    def rows(self) -> list[tuple[int, int, int, Part]]:
        """What is seen of edges: (edge, face, position on the face in the boundary's direction, part)."""
        cells = max(len(self.sweep.leads), 1)
        found: list[tuple[int, int, int, Part]] = []
        for sight in self.sights:
            for part in self.within(sight):
                face = self.faces.faces[sight.face]
                found.append((face.edge, face.number, (face.high_rank() - sight.high) % cells, part))
        return found

    # -- clipping ----------------------------------------------------------------------------------

    def _end(self, event: FaceEnd | None, rank: int, face: Face) -> int:
        """The number of a sight's end: that of the face's own event, if it lies in that direction."""
        if event is not None and event.rank == rank:
            return event.number
        return self.add(HIT, face.number, rank)

    def _clipped(self, n: int, face: Face, start: int, end: int) -> list[Part]:
        """What the range leaves of a straight piece, of which a part is nearest to the foot of the place.

        Both ends beyond, the piece is out of range if the foot is not between them or if the line is too far,
        at |s x a| / |a|.
        """
        faces = self.faces
        sx, sy, s = self.vector(face, start)
        tx, ty, t = self.vector(face, end)
        first, last = faces.reach(sx, sy, s), faces.reach(tx, ty, t)
        if first > 0 and last > 0:
            return [(start, end)]
        if first > 0 and last < 0:
            return [(start, self.add(CROSSING, face.number, 1))]
        if first < 0 and last > 0:
            return [(self.add(CROSSING, face.number, -1), end)]
        if first < 0 and last < 0:
            ax, ay, a = face.ax, face.ay, face.a
            before, before_bound = dot(sx, sy, s, ax, ay, a)
            after, after_bound = dot(tx, ty, t, ax, ay, a)
            if before > before_bound or -after > after_bound:
                return []
            size, size_bound = length(ax, ay, a)
            far, far_bound = quotient(face.turn, face.turn_bound, size, size_bound)
            near = faces.reach(far, 0.0, far_bound)
            if near < 0:
                return []
            if near > 0 and -before > before_bound and after > after_bound:
                return [(self.add(CROSSING, face.number, -1), self.add(CROSSING, face.number, 1))]
        self.doubts.append(n)
        return []

    def vector(self, face: Face, end: int) -> tuple[float, float, float]:
        """The vector from the place to an end of a part of a straight face, a vertex or a hit."""
        faces = self.faces
        if end < self.base:
            return faces.offset(end)
        event = self.sweep.leads[self.made[end - self.base][2]]
        m, e = faces.way(face, event.x, event.y, event.bound)
        px, p = product(m, e, event.x, event.bound)
        py, q = product(m, e, event.y, event.bound)
        return px, py, max(p, q)

    def bracket(self, end: int) -> tuple[float, float]:
        """Bounds of the parameter of a hit or a crossing on a straight edge, (-inf, inf) of other ends.

        With s to the edge's start, a hit along d is at u = -(d x s) / (d x a), a crossing at
        u = (-s . a +- h) / |a|^2, h^2 = |a|^2 R^2 - (s x a)^2.
        """
        faces = self.faces
        if end < self.base:
            return -inf, inf
        kind, number, which = self.made[end - self.base]
        if kind == GIVEN:
            return -inf, inf
        face = faces.faces[number]
        if faces.images[face.edge].kind != STRAIGHT:
            return -inf, inf
        ax, ay, a, turn, turn_bound = face.ax, face.ay, face.a, face.turn, face.turn_bound
        sx, sy, s = faces.offset(face.edge)
        if kind == HIT:
            event = self.sweep.leads[which]
            top, top_bound = cross(sx, sy, s, event.x, event.y, event.bound)
            below, below_bound = cross(event.x, event.y, event.bound, ax, ay, a)
            m, bound = quotient(top, top_bound, below, below_bound)
        else:
            square, square_bound = dot(ax, ay, a, ax, ay, a)
            reach, reach_bound = product(square, square_bound, faces.square, faces.square_bound)
            height, height_bound = product(turn, turn_bound, turn, turn_bound)
            under, under_bound = total(reach, reach_bound, -height, height_bound)
            half, half_bound = root(under, under_bound)
            along, along_bound = dot(sx, sy, s, ax, ay, a)
            top, top_bound = total(-along, along_bound, which * half, half_bound)
            m, bound = quotient(top, top_bound, square, square_bound)
        bound = bound * WIDEN + UNIT * abs(m)
        return m - bound, m + bound

    # -- the outline -------------------------------------------------------------------------------

    def outline(self, at_range: list[int]) -> list[OutlinePiece]:
        """The closed outline from the east on, joined; for more than one sight. Without any it is empty.

        *at_range* are ends that are exactly as far away as the range. A single piece that is an arc of the
        range is all of its circle.
        """
        count = len(self.sights)
        strips: list[OutlinePiece] = []
        for k in range(count):
            n = k - 1 if k else count - 1
            sight = self.sights[n]
            if sight.face == BLOCKED:
                strips.append(OutlinePiece(OWN, HERE, HERE, HERE, n))
                continue
            reached = -2 - sight.low
            if sight.face >= 0:
                edge = self.faces.faces[sight.face].edge
                stop, at_low = self._placed(sight.start), self._placed(sight.end)
                if sight.parts is None:
                    if sight.start != sight.end:
                        strips.append(OutlinePiece(edge, at_low, stop, HERE, n))
                        continue
                else:
                    for m in range(len(sight.parts) - 1, -1, -1):
                        first, last = sight.parts[m]
                        if first == last:
                            continue
                        start, end = self._placed(first), self._placed(last)
                        if end != at_low:
                            strips.append(OutlinePiece(RANGE, reached, end, HERE, n))
                        strips.append(OutlinePiece(edge, end, start, HERE, n))
                        reached = at_low = start
                if at_low == stop:
                    continue
            strips.append(OutlinePiece(RANGE, reached, -2 - sight.high, HERE, n))
        return self._joined(strips, at_range) if strips else []

    def _placed(self, end: int) -> int:
        """The number of an end, the place itself by its own."""
        return HERE if self.here and end in self.here else end

    def _joined(self, strips: list[OutlinePiece], at_range: list[int]) -> list[OutlinePiece]:
        """Parts joined where they continue each other, with windows where they do not meet."""
        found: list[OutlinePiece] = []
        pending: list[OutlinePiece] = []
        # Of the parts that became pieces the first and the last one, and where the windows before them begin.
        first: OutlinePiece | None = None
        last: OutlinePiece | None = None
        lead, leads = 0, False
        before = strips[len(strips) - 1]
        reached = before.end
        for strip in strips:
            begin = len(found)
            if pending:
                found += pending
                pending = []
            if reached != strip.start and before.sight != strip.sight:
                self._add_window(found, reached, strip.start, before, strip, at_range)
            has_windows = len(found) > begin
            before, reached = strip, strip.end
            if strip.edge == OWN:
                pending = found[begin:]
                del found[begin:]
            elif last is not None and not has_windows and last.edge == strip.edge:
                # The piece goes on.
                last.end = strip.end
            else:
                lead, last = begin, strip
                found.append(strip)
                if first is None:
                    first, leads = strip, has_windows
        if pending:
            return pending + found
        if first is None or last is None or first is last or leads or last.edge != first.edge:
            return found
        last.end = first.end
        return found[lead:] + found[1:lead]

    def _add_window(
        self,
        found: list[OutlinePiece],
        end: int,
        start: int,
        before: OutlinePiece,
        after: OutlinePiece,
        at_range: list[int],
    ) -> None:
        """Add what joins the end of a sight to the start of the next: perhaps nothing, or a window."""
        if end < HERE and start < HERE:
            return
        rank = self.sights[after.sight].low
        if end == HERE or start == HERE:
            found.append(OutlinePiece(FROM_HERE, end, start, rank, after.sight))
        elif end < HERE or start < HERE:
            near = start if end < HERE else end
            if near not in at_range:
                found.append(OutlinePiece(WINDOW, end, start, near, after.sight))
        else:
            faces, sights = self.faces.faces, self.sights
            stops = faces[sights[before.sight].face].high_rank() == rank
            begins = faces[sights[after.sight].face].low_rank() == rank
            near = HERE if stops == begins else end if stops else start
            found.append(OutlinePiece(WINDOW, end, start, near, after.sight))


def open_pieces(pieces: list[OutlinePiece]) -> list[int]:
    """Which pieces are to be decided: next to the place, and windows of which either end may be nearer."""
    return [
        n
        for n in range(len(pieces))
        if pieces[n].edge == FROM_HERE or (pieces[n].edge == WINDOW and pieces[n].near == HERE)
    ]
