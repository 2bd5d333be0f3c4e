"""The outline of a view: visible boundary, clipped to the range and joined by windows and range arcs.

A window joins a visible boundary point with the point seen past it, a range arc two pieces between which
only the range limits the view. Pieces run counterclockwise as the point sees them: parts of edges against
the boundary's direction, range arcs with the circle. Which pieces there are follows from what is seen
first in each direction and from which ends are within range.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from functools import partial
from typing import TypeAlias

from exactacq.geometry.coordinates import dot, minus, raw, sign
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.visibility.radial_sweep import BLOCKED, NOTHING, FirstFace
from exactacq.visibility.visible_boundary import BoundaryView


class ViewKind(Enum):
    """What ends the view in some direction."""

    EDGE = "edge"
    """A boundary edge within range."""
    WINDOW = "window"
    """A ray between a near feature and what is seen past it."""
    RANGE = "range"
    """Nothing within range: an arc of the circle of the range."""


class ViewPiece:
    """One piece of an isovist's outline, run counterclockwise as the point sees it.

    ``obstacle`` and ``edge`` (its number in the obstacle) name the edge seen; None for windows and range
    arcs. ``near`` is the end of a window where its feature lies.
    """

    __slots__ = ("_curve", "_make", "edge", "kind", "near", "obstacle")

    def __init__(
        self,
        kind: ViewKind,
        make: Callable[[], Curve],
        obstacle: int | None = None,
        edge: int | None = None,
        near: Point | None = None,
    ) -> None:
        self.kind, self.obstacle, self.edge, self.near = kind, obstacle, edge, near
        self._make, self._curve = make, None

    _curve: Curve | None

    @property
    def curve(self) -> Curve:
        """The exact curve; made at the first access."""
        if self._curve is None:
            self._curve = self._make()
        return self._curve

    def __repr__(self) -> str:
        seen = "" if self.obstacle is None else f" {self.edge} of {self.obstacle}"
        return f"<{self.kind.value}{seen}: {self.curve!r}>"


class _RayHit:
    """Where a ray in the direction of a rank hits a face that is certainly within range."""

    __slots__ = ("_point", "face", "rank", "view")

    def __init__(self, view: BoundaryView, face: int, rank: int) -> None:
        self.view, self.face, self.rank = view, face, rank
        self._point: Point | None = None

    @property
    def point(self) -> Point:
        """The exact point; made at the first access."""
        if self._point is None:
            sweep = self.view.sweep
            self._point = sweep.hit(self.face, sweep.direction(self.rank))
        return self._point


End: TypeAlias = "Point | _RayHit | int"
"""An end of a piece: a rank stands for the point of the range circle in its direction."""


@dataclass(slots=True)
class _PieceEnds:
    """A piece in the making: an edge's number or None for a range arc, and its ends.

    ``is_point`` tells that the part is no piece but the point itself, which the outline passes through.
    """

    edge: int | None
    start: End
    end: End
    is_point: bool = False


def outline(view: BoundaryView) -> tuple[ViewPiece, ...]:
    """The closed outline of a view, from the east on; empty if the point sees nothing but along a ray."""
    sights = view.sweep.sights
    sights = [sights[-1], *sights[:-1]]
    if len(sights) == 1:
        return tuple(_all_around(view, sights[0]))
    return tuple(_Assembly(view, sights).pieces())


def _all_around(view: BoundaryView, sight: FirstFace) -> Iterator[ViewPiece]:
    """The outline where nothing or one full circle is seen in all directions."""
    if sight.face == BLOCKED:
        return
    circle = range_circle(view)
    spans = view.spans(sight) if sight.face != NOTHING else []
    if sight.face != NOTHING:
        e = view.sweep.edges[sight.face]
        curve = view.table.curves[e]
        if len(spans) == 2:
            yield _edge_piece(view, e, curve.reversed)
            return
        for start, end in spans:
            if start is not end:
                yield _edge_piece(view, e, partial(_backwards, curve, start, end))
                yield ViewPiece(ViewKind.RANGE, partial(circle.part, start, end))
                return
    yield ViewPiece(ViewKind.RANGE, lambda: circle)


class _Assembly:
    def __init__(self, view: BoundaryView, sights: list[FirstFace]) -> None:
        self.view, self.sights = view, sights
        self.sweep = view.sweep

    def pieces(self) -> list[ViewPiece]:
        """Parts joined where they continue each other, with windows where they do not meet."""
        parts = self._all_parts()
        found: list[ViewPiece] = []
        pending: list[ViewPiece] = []
        # Of the parts that became pieces the first and the last one, and where the windows before them begin.
        first = last = None
        lead, starts = 0, False
        before, sight = parts[-1]
        for part, after in parts:
            windows = pending
            if not (before.end is part.start or sight is after):
                windows = windows + self._window(before.end, part.start, sight, after)
            before, sight, pending = part, after, []
            if part.is_point:
                pending = windows
            elif last is not None and not windows and last.edge == part.edge:
                last.end = part.end
            else:
                lead = len(found)
                found += windows
                found.append(self._piece(part))
                last = part
                if first is None:
                    first, starts = part, bool(windows)
        assert first is not None and last is not None
        if pending:
            return pending + found
        if first is not last and not starts and last.edge == first.edge:
            last.end = first.end
            return found[lead:] + found[1:lead]
        if len(found) == 1 and first.edge is None:
            return [ViewPiece(ViewKind.RANGE, partial(range_circle, self.view))]
        return found

    def _all_parts(self) -> list[tuple[_PieceEnds, FirstFace]]:
        """What the sights contribute, counterclockwise."""
        found: list[tuple[_PieceEnds, FirstFace]] = []
        near, sweep, curves = self.view.near, self.sweep, self.view.table.curves
        count = len(curves)
        for sight in self.sights:
            face, low, high = sight
            if face < 0 or not near[face]:
                found += [(part, sight) for part in self._parts(sight)]
                continue
            # Most ends are vertices.
            event = sweep.ends_low[face] if low == sweep.low[face] else count
            start = curves[event].start if 0 <= event < count else self._end(face, low, True)
            event = sweep.ends_high[face] if high == sweep.high[face] else count
            end = curves[event].start if 0 <= event < count else self._end(face, high, False)
            found.append((_PieceEnds(sweep.edges[face], start, end), sight))
        return found

    def _parts(self, sight: FirstFace) -> Iterator[_PieceEnds]:
        """What a sight contributes, counterclockwise; the point itself where its obstacle begins."""
        face = sight.face
        if face == BLOCKED:
            yield _PieceEnds(None, self.view.point, self.view.point, is_point=True)
            return
        if face == NOTHING:
            yield _PieceEnds(None, sight.low, sight.high)
            return
        e = self.sweep.edges[face]
        high, low = self.view.ends(sight)
        reached: End = sight.low
        at_low = low
        for start, end in reversed(self.view.clipped(sight, (high, low))):
            if start is end:
                continue
            if end is not at_low:
                yield _PieceEnds(None, reached, end)
            yield _PieceEnds(e, end, start)
            reached = at_low = start
        if at_low is not high:
            yield _PieceEnds(None, reached, sight.high)

    def _end(self, face: int, rank: int, is_low: bool) -> Point | _RayHit:
        """An end of what is seen of a face, all of it within range."""
        sweep = self.sweep
        own = rank == (sweep.low if is_low else sweep.high)[face]
        return sweep.end(face, is_low) if own else _RayHit(self.view, face, rank)

    def _window(self, end: End, start: End, before: FirstFace, after: FirstFace) -> list[ViewPiece]:
        """What joins the end of one sight to the start of the next: nothing, a window, or an own edge."""
        if end is start or (isinstance(end, int) and isinstance(start, int)):
            return []
        point, rank = self.view.point, after.low
        if end is point:
            return list(self._from_point(start, rank, outward=True))
        if start is point:
            return list(self._from_point(end, rank, outward=False))[::-1]
        if isinstance(end, int) or isinstance(start, int):
            near = start if isinstance(end, int) else end
            if isinstance(near, Point) and self._excess(near) == 0:
                return []
        else:
            near = self._near(end, start, before, after)
        make = partial(self._segment, end, start)
        return [ViewPiece(ViewKind.WINDOW, make, near=self._resolved(near))]

    def _near(self, end: Point | _RayHit, start: Point | _RayHit, before: FirstFace, after: FirstFace) -> End:
        """Of two points on one ray the nearer one; only a face that ends on the ray can be nearer."""
        ends = self.sweep.high[before.face] == after.low
        starts = self.sweep.low[after.face] == after.low
        if ends != starts:
            return end if ends else start
        a, b = (minus(raw(self._resolved(p)), self.view.origin) for p in (end, start))
        return end if sign(dot(a, a) - dot(b, b)) < 0 else start

    def _from_point(self, far: End, rank: int, outward: bool) -> Iterator[ViewPiece]:
        """From a boundary point to a far one: along a straight own edge as far as it goes, then a window.

        The pieces come from the point on, and run that way if *outward*.
        """
        view, point, ranks = self.view, self.view.point, self.sweep.rank
        for e in view.own:
            for vertex in (e, int(view.table.next[e])):
                if not (view.runs_out(e, vertex) and ranks.get(vertex) == rank):
                    continue
                place = self.sweep.faces.place(vertex)
                excess = self._excess(place)
                stop = far if excess > 0 else place
                yield _edge_piece(view, e, partial(self._segment, point, stop, outward))
                if excess < 0 and place is not far:
                    make = partial(self._segment, place, far, outward)
                    yield ViewPiece(ViewKind.WINDOW, make, near=place)
                return
        yield ViewPiece(ViewKind.WINDOW, partial(self._segment, point, far, outward), near=point)

    def _segment(self, start: End, end: End, forward: bool = True) -> Segment:
        a, b = self._resolved(start), self._resolved(end)
        return Segment(a, b) if forward else Segment(b, a)

    def _excess(self, point: Point) -> int:
        """-1, 0 or 1 as a point is within range, at its limit, or beyond."""
        return self.view.disc.excess(point)

    def _resolved(self, end: End) -> Point:
        if isinstance(end, Point):
            return end
        return self.view.at_range(end) if isinstance(end, int) else end.point

    def _piece(self, part: _PieceEnds) -> ViewPiece:
        view, e = self.view, part.edge
        if e is None:
            return ViewPiece(ViewKind.RANGE, partial(self._range, part))
        return _edge_piece(view, e, partial(self._edge, part))

    def _range(self, part: _PieceEnds) -> Curve:
        start, end = self._resolved(part.start), self._resolved(part.end)
        return Arc(start, end, self.view.point, self.view.range.square, ccw=True, full=start is end)

    def _edge(self, part: _PieceEnds) -> Curve:
        assert part.edge is not None
        curve = self.view.table.curves[part.edge]
        return _backwards(curve, self._resolved(part.end), self._resolved(part.start))


def _backwards(curve: Curve, start: Point, end: Point) -> Curve:
    """A part of an edge as the view's outline runs, against the boundary's direction."""
    if isinstance(curve, Segment):
        return Segment(end, start)
    return curve.part(start, end).reversed()


def _edge_piece(view: BoundaryView, e: int, make: Callable[[], Curve]) -> ViewPiece:
    return ViewPiece(ViewKind.EDGE, make, view.table.owners[e], view.table.numbers[e])


def range_circle(view: BoundaryView) -> Arc:
    """The circle of the range about the point."""
    east = Point(view.point.x + view.range.radius, view.point.y)
    return Arc(east, east, view.point, view.range.square, ccw=True, full=True)
