"""The outline of a view: visible boundary, clipped to the range and joined by windows and range arcs.

A window joins a visible boundary point with the point seen past it, a range arc two pieces between which
only the range limits the view. Pieces run counterclockwise as the point sees them: parts of edges against
the boundary's direction, range arcs with the circle. Which pieces there are follows from what is seen
first in each direction and from which ends are within range.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum

from exactacq.geometry.coordinates import dot, minus, raw, sign
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.kernel.view_parts import HERE, RANGE, WINDOW, OutlinePiece, open_pieces
from exactacq.scene.edge_table import STRAIGHT
from exactacq.visibility.radial_sweep import BLOCKED, NOTHING
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
    """One piece of an isovist's outline, run counterclockwise as the point sees it."""

    __slots__ = ("_row", "_view")

    _row: OutlinePiece
    _view: BoundaryView

    @classmethod
    def of(cls, view: BoundaryView, rows: list[OutlinePiece]) -> tuple[ViewPiece, ...]:
        """The pieces of a view's outline."""
        # Without a call of its own for each: there are many, and of most little is asked.
        found, new = [], cls.__new__
        for row in rows:
            piece = new(cls)
            piece._row, piece._view = row, view
            found.append(piece)
        return tuple(found)

    @property
    def kind(self) -> ViewKind:
        """What ends the view there."""
        edge = self._row.edge
        return ViewKind.EDGE if edge >= 0 else ViewKind.RANGE if edge == RANGE else ViewKind.WINDOW

    @property
    def obstacle(self) -> int | None:
        """The number of the obstacle that is seen; None for windows and range arcs."""
        edge = self._row.edge
        return self._view.table.owners[edge] if edge >= 0 else None

    @property
    def edge(self) -> int | None:
        """The number of the edge that is seen, in its obstacle; None for windows and range arcs."""
        edge = self._row.edge
        return self._view.table.numbers[edge] if edge >= 0 else None

    @property
    def near(self) -> Point | None:
        """The end of a window where its feature lies."""
        return _point(self._view, self._row.near) if self._row.edge == WINDOW else None

    @property
    def curve(self) -> Curve:
        """The exact curve; made at the first access."""
        curve: Curve | None = self._row.curve
        if curve is None:
            curve = self._row.curve = _curve(self._view, self._row)
        return curve

    def __repr__(self) -> str:
        seen = "" if self.obstacle is None else f" {self.edge} of {self.obstacle}"
        return f"<{self.kind.value}{seen}: {self.curve!r}>"


def outline(view: BoundaryView) -> tuple[ViewPiece, ...]:
    """The closed outline of a view, from the east on; empty if the point sees nothing but along a ray."""
    sights = view.sweep.sights
    rows = _rows(view) if len(sights) > 1 else _all_around(view, sights[0].face)
    return ViewPiece.of(view, rows)


def _all_around(view: BoundaryView, face: int) -> list[OutlinePiece]:
    """The outline where nothing or one full circle is seen in all directions."""
    if face == BLOCKED:
        return []
    if face != NOTHING:
        e = view.sweep.edge(face)
        spans = view.all_around(face)
        if len(spans) == 2:
            return [_piece(e, e, e)]
        for start, end in spans:
            if start is not end:
                a, b = view.ends.number(e, start), view.ends.number(e, end)
                return [_piece(e, b, a), _piece(RANGE, a, b)]
    return [_piece(RANGE, HERE, HERE)]


def _piece(edge: int, start: int, end: int, near: int = HERE) -> OutlinePiece:
    """A piece that is made here, of no single sight."""
    return OutlinePiece(edge, start, end, near, HERE)


def _rows(view: BoundaryView) -> list[OutlinePiece]:
    parts = view.parts
    here = parts.here
    at_range = [
        end
        for n in parts.doubts
        for part in parts.within(parts.sights[n])
        for end in part
        if end in (parts.sights[n].start, parts.sights[n].end)
        and end not in here
        and view.disc.excess(view.ends.point(end)) == 0
    ]
    rows = parts.outline(at_range)
    for n in reversed(open_pieces(rows)):
        row = rows[n]
        if row.edge == WINDOW:
            row.near = _nearer(view, row.start, row.end)
        else:
            is_outward = row.start == HERE
            rows[n : n + 1] = _from_here(view, row.end if is_outward else row.start, row.near, is_outward)
    return [_piece(RANGE, HERE, HERE)] if len(rows) == 1 and rows[0].edge == RANGE else rows


def _nearer(view: BoundaryView, one: int, other: int) -> int:
    """Of two ends on one ray the nearer one."""
    a, b = (minus(raw(view.ends.point(end, read=True)), view.origin) for end in (one, other))
    return one if sign(dot(a, a) - dot(b, b)) < 0 else other


def _from_here(view: BoundaryView, far: int, rank: int, outward: bool) -> list[OutlinePiece]:
    """From a boundary point to a far one: along a straight own edge as far as it goes, then a window.

    The edge may go on in others. The pieces come from the point on if *outward*, else to it.
    """

    def row(edge: int, a: int, b: int, near: int) -> OutlinePiece:
        return _piece(edge, a, b, near) if outward else _piece(edge, b, a, near)

    rows, at = list[OutlinePiece](), HERE
    for e, vertex in _straight_on(view, rank):
        excess = view.disc.excess(view.sweep.faces.place(vertex))
        rows.append(row(e, at, far if excess > 0 else vertex, HERE))
        at = vertex
        if excess >= 0 or vertex == far:
            break
    else:
        rows.append(row(WINDOW, at, far, at))
    return rows if outward else rows[::-1]


def _straight_on(view: BoundaryView, rank: int) -> Iterator[tuple[int, int]]:
    """The straight edges on the ray of a rank from an own one on, each with the vertex at its far end."""
    table, ranks = view.table, view.sweep.rank
    for own in view.own:
        for end, onward in ((own, table.preceding), (table.following[own], table.following)):
            if view.runs_out(own, end) and ranks.get(end) == rank:
                e, vertex = own, end
                while e == own or (table.kinds[e] == STRAIGHT and ranks.get(vertex) == rank):
                    yield e, vertex
                    e, vertex = onward[e], onward[vertex]
                return


def _point(view: BoundaryView, end: int) -> Point:
    """The point of an end, to be read."""
    return view.at_range(-2 - end) if end < HERE else view.ends.point(end, read=True)


def _curve(view: BoundaryView, row: OutlinePiece) -> Curve:
    edge, first, last, vertices = row.edge, row.start, row.end, view.table.starts
    if edge == RANGE and first == HERE:
        return range_circle(view)
    # Most ends are vertices.
    count = len(vertices)
    start = vertices[first] if 0 <= first < count else _point(view, first)
    end = vertices[last] if 0 <= last < count else _point(view, last)
    if edge == RANGE:
        return Arc(start, end, view.point, view.range.square, ccw=True, full=start is end)
    curve = view.table.curves[edge] if edge >= 0 else None
    # A part of an edge runs as the outline does, against the boundary's direction.
    return curve.part(end, start).reversed() if isinstance(curve, Arc) else Segment(start, end)


def range_circle(view: BoundaryView) -> Arc:
    """The circle of the range about the point."""
    return Arc.circle(view.point, view.range.square)
