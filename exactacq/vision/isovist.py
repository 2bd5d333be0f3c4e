"""The isovist: all that a point sees within a limited range, as one closed boundary.

The fan of the point cuts the directions into cells in which one edge, or none within range, comes first.
Cut once more where an edge passes the circle of the range, every cell gives one piece of the boundary: a
part of an edge, or a range arc. Where neighbours do not meet, a window on their common ray joins them. What
is seen along single rays only, between obstacles that pinch a line, bounds no area: it is in the isovist,
not on its outline.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from itertools import pairwise

from exactacq.contacts import contacts, signed_area
from exactacq.curves import Arc, Curve, Segment
from exactacq.errors import InvalidScene
from exactacq.lengths import Length
from exactacq.numerals import rational
from exactacq.points import Location, Point, distance_sq
from exactacq.reals import Real, fmpq
from exactacq.scene import Scene
from exactacq.validation import sensor_flaws
from exactacq.vision.chords import chord_at
from exactacq.vision.clearance import is_free
from exactacq.vision.fans import edges_at, fan
from exactacq.vision.features import is_spike
from exactacq.vision.sectors import Sector
from exactacq.vision.table import EdgeTable


class ViewKind(Enum):
    """What ends the view in some direction."""

    EDGE = "edge"
    """A boundary edge within range."""
    WINDOW = "window"
    """A ray between a near feature and what is seen past it."""
    RANGE = "range"
    """Nothing within range: an arc of the circle of the range."""


@dataclass(frozen=True)
class ViewPiece:
    """One piece of an isovist's outline, run counterclockwise as the point sees it.

    ``obstacle`` and ``edge`` (its number in the obstacle) name the edge seen; None for windows and range
    arcs. ``near`` is the end of a window where its feature lies.
    """

    kind: ViewKind
    curve: Curve
    obstacle: int | None = None
    edge: int | None = None
    near: Point | None = None


class Isovist:
    """The view from a free point with rational coordinates, within a rational radius.

    ``pieces`` run counterclockwise. From a boundary point the outline passes through the point itself.
    """

    def __init__(self, scene: Scene, point: Point, radius: fmpq) -> None:
        self.scene, self.point, self.radius = scene, point, radius
        self._table = EdgeTable(scene.obstacles)
        self.pieces = tuple(_outline(self._table, point, radius))

    @cached_property
    def area(self) -> Length:
        """Exact area."""
        return signed_area([piece.curve for piece in self.pieces])

    @cached_property
    def perimeter(self) -> Length:
        """Exact length of the outline, windows and range arcs included."""
        return Length.sum(piece.curve.length for piece in self.pieces)

    def contains(self, point: Point) -> bool:
        """Whether a point of the closed free space is visible; False for points inside obstacles."""
        if distance_sq(self.point, point).compare(self.radius * self.radius) > 0:
            return False
        if any(o.locate(point) is Location.INSIDE for o in self.scene.obstacles):
            return False
        return point == self.point or is_free(self._table, self.point, point)


def isovist(scene: Scene, point: object, radius: object = None) -> Isovist:
    """What a free point sees within the radius (the scene's own if None).

    The point, a `Point` or a pair of numbers, and the radius must be rational. Raises `InvalidScene` if the
    point is inside an obstacle or the radius missing or not positive. Cost: that of a fan once the scene's
    edges are tabled, which is linear in the scene.
    """
    place = Point.of(point)  # type: ignore[arg-type]
    reach = scene.radius if radius is None else rational(radius)
    if reach is None:
        raise InvalidScene(["a radius of vision must be given"])
    flaws = list(sensor_flaws(place, reach))
    flaws += [
        f"the point {place} lies inside {o!r}" for o in scene.obstacles if o.locate(place) is Location.INSIDE
    ]
    if flaws:
        raise InvalidScene(flaws)
    return Isovist(scene, place, reach)


def _outline(table: EdgeTable, point: Point, radius: fmpq) -> list[ViewPiece]:
    """The pieces of the cells, merged where they continue each other, joined by windows."""
    merged: list[ViewPiece] = []
    for piece in _cell_pieces(table, point, radius):
        if merged and _continues(merged[-1], piece):
            merged[-1] = _joined(merged[-1], piece)
        else:
            merged.append(piece)
    if len(merged) > 1 and _continues(merged[-1], merged[0]):
        merged[0] = _joined(merged.pop(), merged[0])
    pieces: list[ViewPiece] = []
    for before, piece in zip([merged[-1], *merged], merged, strict=False):
        start, end = before.curve.end, piece.curve.start
        if not _is_closed(before.curve, piece.curve) and start != end:
            pieces += _windows(table, edges_at(table, point), point, start, end)
        pieces.append(piece)
    return pieces


def _is_closed(before: Curve, after: Curve) -> bool:
    return before.end is after.start


def _windows(
    table: EdgeTable, own: tuple[int, ...], point: Point, start: Point, end: Point
) -> Iterator[ViewPiece]:
    """What joins two pieces: a window on their ray, or two through a point on a boundary.

    A window from the point itself runs along its edge first, if that is straight and in the way.
    """
    on_ray = (start - point).cross(end - point).sign() == 0 and (start - point).dot(end - point).sign() >= 0
    stops = [start, end] if on_ray or point in (start, end) else [start, point, end]
    for a, b in pairwise(stops):
        near, far = (a, b) if distance_sq(point, a) < distance_sq(point, b) else (b, a)
        pieces = [ViewPiece(ViewKind.WINDOW, Segment(near, far), near=near)]
        if near == point:
            pieces = list(_along_own_edge(table, own, point, far))
        yield from pieces if near is a else (_turned(piece) for piece in reversed(pieces))


def _along_own_edge(table: EdgeTable, own: tuple[int, ...], point: Point, far: Point) -> Iterator[ViewPiece]:
    """The way from a boundary point to a far one: along a straight edge as far as it goes, then a window."""
    ray = far - point
    for e in own:
        curve = table.curves[e]
        for vertex in (curve.start, curve.end) if isinstance(curve, Segment) else ():
            offset = vertex - point
            if offset.cross(ray).sign() == 0 and offset.dot(ray).sign() > 0:
                owner = int(table.owner[e])
                seen = ViewKind.EDGE, owner, e - int(table.first[owner])
                if offset.norm_sq() >= ray.norm_sq():
                    yield ViewPiece(seen[0], Segment(point, far), *seen[1:])
                else:
                    yield ViewPiece(seen[0], Segment(point, vertex), *seen[1:])
                    yield ViewPiece(ViewKind.WINDOW, Segment(vertex, far), near=vertex)
                return
    yield ViewPiece(ViewKind.WINDOW, Segment(point, far), near=point)


def _turned(piece: ViewPiece) -> ViewPiece:
    return replace(piece, curve=piece.curve.reversed())


def _continues(before: ViewPiece, after: ViewPiece) -> bool:
    same = (before.kind, before.obstacle, before.edge) == (after.kind, after.obstacle, after.edge)
    return same and (before.curve.end is after.curve.start or before.curve.end == after.curve.start)


def _joined(before: ViewPiece, after: ViewPiece) -> ViewPiece:
    curve = before.curve.part(before.curve.start, after.curve.end)
    return ViewPiece(before.kind, curve, before.obstacle, before.edge)


def _cell_pieces(table: EdgeTable, point: Point, radius: fmpq) -> Iterator[ViewPiece]:
    """What every cell contributes, counterclockwise from the east; nothing where the obstacle begins."""
    own = edges_at(table, point)
    circle = _range_circle(point, radius)
    for sweep in fan(table, point, float(radius) * (1 + 1e-12)):
        for cell in sweep.cells:
            if cell.ahead is None:
                middle = sweep.sector.touch((cell.low + cell.high) / 2)[1]
                if not own or not _enters(table, own, point, middle):
                    yield _range_piece(sweep.sector, circle, cell.low, cell.high, {})
                continue
            yield from _edge_pieces(table, sweep.sector, circle, cell.ahead, (cell.low, cell.high))


def _edge_pieces(
    table: EdgeTable, sector: Sector, circle: Arc, e: int, ends: tuple[Real, Real]
) -> Iterator[ViewPiece]:
    """The part of an edge that a cell sees, cut where it passes the range."""
    curve, (low, high) = table.curves[e], ends
    crossings: list[tuple[Real, Point]] = []
    for contact in contacts(curve, circle):
        for t in sector.through(contact.start) if contact.start is contact.end else ():
            ahead = sector.touch(t)[1].dot(contact.start - circle.center).sign() > 0
            if ahead and t.compare(low) > 0 and t.compare(high) < 0:
                crossings.append((t, contact.start))
    crossings.sort(key=lambda item: item[0])
    known = {id(t): p for t, p in crossings}
    owner = int(table.owner[e])
    for a, b in pairwise([low, *(t for t, _ in crossings), high]):
        if a.compare(b) == 0:
            continue
        middle = chord_at(sector, (a + b) / 2, None, curve)
        if middle.length.compare(circle.radius) > 0:
            yield _range_piece(sector, circle, a, b, known)
            continue
        start, end = (known.get(id(t)) or chord_at(sector, t, None, curve).end for t in (a, b))
        # Obstacles lie to the left of their edges, the view to the left of its outline.
        seen = curve.part(end, start).reversed()
        yield ViewPiece(ViewKind.EDGE, seen, owner, e - int(table.first[owner]))


def _range_circle(point: Point, radius: fmpq) -> Arc:
    east = Point(point.x + radius, point.y)
    return Arc(east, east, point, radius * radius, ccw=True, full=True)


def _range_piece(sector: Sector, circle: Arc, low: Real, high: Real, known: dict[int, Point]) -> ViewPiece:
    def at(t: Real) -> Point:
        direction = sector.touch(t)[1]
        return circle.center + direction * (circle.radius / direction.norm_sq().sqrt())

    start, end = (known.get(id(t)) or at(t) for t in (low, high))
    return ViewPiece(ViewKind.RANGE, circle.part(start, end))


def _enters(table: EdgeTable, own: tuple[int, ...], point: Point, direction: Point) -> bool:
    """Whether a direction, tangent to no edge, leads from a boundary point into its obstacle."""
    curves = [table.curves[e] for e in own]
    tangents = [c.tangent(point) if isinstance(c, Arc) else c.direction for c in curves]
    left = [tangent.cross(direction).sign() > 0 for tangent in tangents]
    turn = tangents[0].cross(tangents[-1]).sign()
    if turn == 0 and tangents[0].dot(tangents[-1]).sign() < 0:
        return not is_spike(*curves)
    return all(left) if turn >= 0 else any(left)
