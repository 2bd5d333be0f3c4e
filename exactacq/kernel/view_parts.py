"""What the range leaves of the faces that a place sees first, and the outline of that, in floats with bounds.

Ends of parts are numbers: those of events where a face ends (see `exactacq.kernel.radial_faces`), and from
``base`` on those of ends that are made here: `HIT`, where a ray in the direction of an event meets a face
behind it, and `CROSSING`, where an edge leaves the range. Negative ends are no points of edges: `HERE` is the
place itself, and -2 - k the point of the circle of the range in direction k.
"""

from __future__ import annotations

from math import inf
from typing import Final, final

from exactacq.kernel.bounded import UNIT, WIDEN, cross, dot, length, product, quotient, root, total
from exactacq.kernel.images import STRAIGHT
from exactacq.kernel.radial_sweep import BLOCKED, FaceSweep

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
Part = tuple[int, int]
"""The ends of a closed piece of an edge, in the boundary's direction."""
Piece = tuple[int, int, int, int]
"""Of the outline: edge, `RANGE` or `WINDOW`; both ends, counterclockwise; the nearer one of a window."""


@final
class ViewParts:
    """The parts of all sights; of one that goes all around nothing is told.

    ``parts`` has, for every sight, what of it is within range, and ``ends`` those of the whole sight. Where
    floats leave the parts open there are none, and ``doubts`` tell the sight's number. *here* are the events
    that are the place itself.
    """

    def __init__(
        self, sweep: FaceSweep, sights: list[tuple[int, int, int]], base: int, here: list[int]
    ) -> None:
        self.sweep, self.faces = sweep, sweep.faces
        self.sights, self.base, self.here = sights, base, here
        self.made: list[tuple[int, int, int]] = []
        self.parts: list[list[Part]] = []
        self.ends: list[Part] = []
        self.doubts: list[int] = []
        within = self.faces.within
        for n in range(len(sights)):
            face, low, high = sights[n]
            if face < 0 or low == high:
                self.ends.append((HERE, HERE))
                self.parts.append([])
                continue
            part = self._end(face, high, False), self._end(face, low, True)
            self.ends.append(part)
            start, end = part
            if within[face] and not (here and start in here and end in here):
                self.parts.append([part])
            elif self.faces.images[self.faces.edge[face]].kind == STRAIGHT:
                self.parts.append(self._clipped(n, face, start, end))
            else:
                self.doubts.append(n)
                self.parts.append([])

    def add(self, kind: int, face: int, which: int) -> int:
        """The number of a new end."""
        self.made.append((kind, face, which))
        return self.base + len(self.made) - 1

    def rows(self) -> list[tuple[int, int, int, Part]]:
        """What is seen of edges: (edge, face, position on the face in the boundary's direction, part)."""
        cells = max(len(self.sweep.groups), 1)
        found: list[tuple[int, int, int, Part]] = []
        for n in range(len(self.sights)):
            for part in self.parts[n]:
                face, _, high = self.sights[n]
                found.append((self.faces.edge[face], face, (self.sweep.high[face] - high) % cells, part))
        return found

    # -- clipping ----------------------------------------------------------------------------------

    def _end(self, face: int, rank: int, is_low: bool) -> int:
        faces, sweep = self.faces, self.sweep
        if is_low:
            if rank == sweep.low[face]:
                return faces.events[faces.low[face]]
        elif rank == sweep.high[face]:
            return faces.events[faces.high[face]]
        return self.add(HIT, face, rank)

    def _clipped(self, n: int, face: int, start: int, end: int) -> list[Part]:
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
            return [(start, self.add(CROSSING, face, 1))]
        if first < 0 and last > 0:
            return [(self.add(CROSSING, face, -1), end)]
        if first < 0 and last < 0:
            ax, ay, a, turn, turn_bound = faces.line(faces.edge[face])
            before, before_bound = dot(sx, sy, s, ax, ay, a)
            after, after_bound = dot(tx, ty, t, ax, ay, a)
            if before > before_bound or -after > after_bound:
                return []
            size, size_bound = length(ax, ay, a)
            far, far_bound = quotient(turn, turn_bound, size, size_bound)
            near = faces.reach(far, 0.0, far_bound)
            if near < 0:
                return []
            if near > 0 and -before > before_bound and after > after_bound:
                return [(self.add(CROSSING, face, -1), self.add(CROSSING, face, 1))]
        self.doubts.append(n)
        return []

    def vector(self, face: int, end: int) -> tuple[float, float, float]:
        """The vector from the place to an end of a part of a straight face, a vertex or a hit."""
        faces = self.faces
        if end < self.base:
            return faces.offset(end)
        slot = self.sweep.groups[self.made[end - self.base][2]][0]
        x, y, b = faces.vector(slot)
        m, e = faces.way(face, x, y, b)
        px, p = product(m, e, x, b)
        py, q = product(m, e, y, b)
        return px, py, max(p, q)

    def bracket(self, end: int) -> tuple[float, float]:
        """Bounds of the parameter of a hit or a crossing on a straight edge, (-inf, inf) of other ends.

        With s to the edge's start, a hit along d is at u = -(d x s) / (d x a), a crossing at
        u = (-s . a +- h) / |a|^2, h^2 = |a|^2 R^2 - (s x a)^2.
        """
        faces = self.faces
        if end < self.base:
            return -inf, inf
        kind, face, which = self.made[end - self.base]
        e = faces.edge[face] if kind != GIVEN else -1
        if kind == GIVEN or faces.images[e].kind != STRAIGHT:
            return -inf, inf
        ax, ay, a, turn, turn_bound = faces.line(e)
        sx, sy, s = faces.offset(e)
        if kind == HIT:
            slot = self.sweep.groups[which][0]
            x, y, b = faces.vector(slot)
            top, top_bound = cross(sx, sy, s, x, y, b)
            below, below_bound = cross(x, y, b, ax, ay, a)
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

    def outline(self, at_range: list[int]) -> list[Piece]:
        """The closed outline from the east on, joined; for more than one sight.

        *at_range* are ends that are exactly as far away as the range. A single piece that is an arc of the
        range is all of its circle.
        """
        count = len(self.sights)
        edges: list[int] = []
        starts: list[int] = []
        ends: list[int] = []
        of: list[int] = []
        for k in range(count):
            n = (k - 1) % count
            face, low, high = self.sights[n]
            if face == BLOCKED:
                edges.append(OWN)
                starts.append(HERE)
                ends.append(HERE)
                of.append(n)
                continue
            reached, stop = -2 - low, NOWHERE
            if face >= 0:
                edge = self.faces.edge[face]
                stop, at_low = self._placed(self.ends[n])
                for m in range(len(self.parts[n]) - 1, -1, -1):
                    start, end = self._placed(self.parts[n][m])
                    if self.parts[n][m][0] == self.parts[n][m][1]:
                        continue
                    if end != at_low:
                        edges.append(RANGE)
                        starts.append(reached)
                        ends.append(end)
                        of.append(n)
                    edges.append(edge)
                    starts.append(end)
                    ends.append(start)
                    of.append(n)
                    reached = at_low = start
                if at_low == stop:
                    continue
            edges.append(RANGE)
            starts.append(reached)
            ends.append(-2 - high)
            of.append(n)
        return self._joined(edges, starts, ends, of, at_range)

    def _placed(self, part: Part) -> Part:
        """The ends of a part, the place itself by its own number."""
        if not self.here:
            return part
        start, end = part
        return HERE if start in self.here else start, HERE if end in self.here else end

    def _joined(
        self, edges: list[int], starts: list[int], ends: list[int], of: list[int], at_range: list[int]
    ) -> list[Piece]:
        """Parts joined where they continue each other, with windows where they do not meet."""
        found: list[Piece] = []
        pending: list[Piece] = []
        # Of the parts that became pieces the first and the last one, and where the windows before them begin.
        first = last = -1
        lead, leads = 0, False
        before = len(edges) - 1
        for k in range(len(edges)):
            begin = len(found)
            if pending:
                found += pending
                pending = []
            if ends[before] != starts[k] and of[before] != of[k]:
                self._add_window(found, ends[before], starts[k], of[before], of[k], at_range)
            has_windows = len(found) > begin
            before = k
            if edges[k] == OWN:
                pending = found[begin:]
                del found[begin:]
            elif last >= 0 and not has_windows and edges[last] == edges[k]:
                # The piece goes on: it was the last one found.
                found[-1] = edges[k], found[-1][1], ends[k], HERE
            else:
                lead, last = begin, k
                found.append((edges[k], starts[k], ends[k], HERE))
                if first < 0:
                    first, leads = k, has_windows
        if pending:
            return pending + found
        if first != last and not leads and edges[last] == edges[first]:
            edge, start, _, _ = found[-1]
            found[-1] = edge, start, found[0][2], HERE
            return found[lead:] + found[1:lead]
        return found

    def _add_window(
        self, found: list[Piece], end: int, start: int, before: int, after: int, at_range: list[int]
    ) -> None:
        """Add what joins the end of a sight to the start of the next: perhaps nothing, or a window."""
        if end < HERE and start < HERE:
            return
        rank = self.sights[after][1]
        if end == HERE or start == HERE:
            found.append((FROM_HERE, end, start, rank))
        elif end < HERE or start < HERE:
            near = start if end < HERE else end
            if near not in at_range:
                found.append((WINDOW, end, start, near))
        else:
            stops = self.sweep.high[self.sights[before][0]] == rank
            begins = self.sweep.low[self.sights[after][0]] == rank
            found.append((WINDOW, end, start, HERE if stops == begins else end if stops else start))
