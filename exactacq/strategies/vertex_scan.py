"""The measure that the paper argues against: scans and moves counted from vertex to vertex.

Oommen, Iyengar, Rao and Kashyap, "Robot navigation in unknown terrains using learned visibility graphs",
IEEE Journal of Robotics and Automation 3 (1987): the obstacles are polygons, the robot goes straight from
vertex to vertex, and at each it scans once, with unlimited range. It searches the visibility graph of the
vertices depth first: N vertices cost N scans and at most 2 (N - 1) moves. The paper's introduction objects
that N says little of a round obstacle; `polygon_limit` shows it on circles and their inscribed polygons.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from exactacq.cached import cached_property
from exactacq.errors import InvalidScene
from exactacq.files.gallery import scene as gallery_scene
from exactacq.geometry.coordinates import dot, minus, raw
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import fmpq
from exactacq.scene.scene import Scene, start_of
from exactacq.scene.shapes import Circle, Polygon, Shape
from exactacq.sensing.path import Path, Piece
from exactacq.strategies.sightseer.strategy import sightseer
from exactacq.visibility.isovist import Isovist, isovist

Corner = tuple[int, int]
"""A vertex: the number of its obstacle, and of the edge there that starts at it."""


@dataclass(frozen=True)
class Scan:
    """A finished exploration from vertex to vertex.

    ``order`` are the vertices as they were scanned. ``path`` is straight from vertex to vertex; if
    ``approached``, its first piece leads from the start to the first vertex. That piece and what is seen from
    a start that is no vertex count for the length, but not as a move or a scan.
    """

    scene: Scene
    start: Point
    order: tuple[Corner, ...]
    path: Path
    approached: bool

    @property
    def scans(self) -> int:
        """Scans made: one at each vertex."""
        return len(self.order)

    @property
    def moves(self) -> int:
        """Moves between vertices, those of the backtracking included."""
        return len(self.path) - self.approached

    @cached_property
    def length(self) -> Length:
        """Exact length of the path."""
        return self.path.length_after(len(self.path))


def vertex_scan(scene: Scene, start: Point | Sequence[object] | None = None) -> Scan:
    """Explore polygons by a depth-first search over their vertices, with one scan of unlimited range at each.

    From a vertex the robot goes straight to the nearest unvisited vertex that it sees, of equally near ones
    to the one of least obstacle, then least number. If it sees none it goes back the way it came. Grazing
    does not block, so the ends of an edge see each other. From a start that is no vertex it goes to the
    nearest vertex in sight first. It stops once all vertices that it has seen are visited. These are all: in
    free space, which is connected, shortest paths bend at vertices only, so the visibility graph of the
    vertices is connected.

    *start* defaults to the scene's own. Raises `InvalidScene` if an obstacle has arcs, and if the start is
    missing, irrational or not free. A scene without obstacles costs nothing. Cost: for N vertices N views,
    N^2 log N comparisons of rationals, and for every ordered pair of vertices at most one test of sight.

    >>> import exactacq as xa
    >>> scan = vertex_scan(xa.Scene([xa.Polygon([(0, 0), (1, 0), (1, 1), (0, 1)])], start=(0, -2)))
    >>> print(scan.scans, scan.moves, scan.length)
    4 3 5
    """
    arcs = [o for o in scene.obstacles if not all(isinstance(edge, Segment) for edge in o.edges)]
    if arcs:
        raise InvalidScene(
            [f"obstacle {o.label} has arcs: vertices are scanned on polygons only" for o in arcs]
        )
    return _DepthFirst(scene, start_of(scene, start)).run()


class _DepthFirst:
    """A depth-first search; every vertex keeps what is left of its scan, so no sight is tested twice."""

    def __init__(self, scene: Scene, start: Point) -> None:
        self.scene, self.start = scene, start
        self.places = {(o.index, k): edge.start for o in scene.obstacles for k, edge in enumerate(o.edges)}
        self.unvisited = set(self.places)
        self.range = _span([start, *self.places.values()])
        self.position = start
        self.pieces: list[Piece] = []

    def run(self) -> Scan:
        """Visit the first vertex, then go on until none is left."""
        order: list[Corner] = []
        stack: list[tuple[Point, Iterator[Corner]]] = []
        approached = False
        view = isovist(self.scene, self.start, self.range)
        corner = next(self._in_sight(view), None)
        while corner is not None:
            self.unvisited.discard(corner)
            approached |= not order and self.position != self.places[corner]
            self._go(self.places[corner])
            order.append(corner)
            stack.append((self.position, self._in_sight(isovist(self.scene, self.position, self.range))))
            corner = self._next(stack) if self.unvisited else None
        return Scan(self.scene, self.start, tuple(order), Path(self.pieces), approached)

    def _next(self, stack: list[tuple[Point, Iterator[Corner]]]) -> Corner:
        """The next vertex, after going back as far as needed."""
        while (found := next(stack[-1][1], None)) is None:
            stack.pop()
            self._go(stack[-1][0])
        return found

    def _in_sight(self, view: Isovist) -> Iterator[Corner]:
        """The vertices in sight of a point, nearest first, that are unvisited when they are asked for."""
        here = raw(view.point)

        def nearness(corner: Corner) -> tuple[fmpq, Corner]:
            offset = minus(raw(self.places[corner]), here)
            return dot(offset, offset), corner

        for corner in sorted(self.unvisited, key=nearness):
            if corner in self.unvisited and view.contains(self.places[corner]):
                yield corner

    def _go(self, place: Point) -> None:
        if self.position != place:
            self.pieces.append(Piece("straight", None, Segment(self.position, place)))
        self.position = place


def _span(points: Iterable[Point]) -> fmpq:
    """A range from any of these rational points to any other: half the border of their box, and 1."""
    columns = zip(*(raw(point) for point in points), strict=True)
    return fmpq(1) + sum((max(column) - min(column) for column in columns), start=fmpq(0))


# -- circles as limits of polygons -----------------------------------------------------------------


@dataclass(frozen=True)
class LimitRow:
    """Both strategies where each circle is a polygon of ``sides`` sides.

    ``length`` is the Sightseer's P and ``gap`` what it lacks to P on the circles; ``vertices``, ``scans``,
    ``moves`` and ``scan_length`` are the vertex scan's.
    """

    sides: int
    length: Length
    gap: Length
    vertices: int
    scans: int
    moves: int
    scan_length: Length


def inscribed(circle: Circle, sides: int) -> Polygon:
    """A polygon inscribed in a circle, its vertices and its sides' lengths rational.

    With m = sides / 2 the vertices are at the angles +-4 atan(i / m) for i = 0..m, the circle's east and west
    points among them: they are squares of rational points of the unit circle, which makes chords rational.
    Sides are at most 4 / m radians long, so the perimeters' lack is at most (4 pi / 3) r / m^2. ValueError
    if *sides* is odd or below 4.
    """
    if sides < 4 or sides % 2:
        raise ValueError(f"an inscribed polygon has an even number of sides from 4 on, not {sides}")
    upper = [_on_unit_circle(fmpq(2 * i, sides)) for i in range(sides // 2 + 1)]
    ring = upper + [(x, -y) for x, y in reversed(upper[1:-1])]
    (x0, y0), radius = circle.center, circle.radius
    return Polygon([(x0 + radius * x, y0 + radius * y) for x, y in ring], name=circle.name)


def _on_unit_circle(tangent: fmpq) -> tuple[fmpq, fmpq]:
    """The point at the angle 4 atan(tangent): the square of the point at half of it."""
    square = tangent * tangent
    cosine, sine = (1 - square) / (1 + square), 2 * tangent / (1 + square)
    return cosine * cosine - sine * sine, 2 * cosine * sine


def polygonal(scene: Scene, sides: int) -> Scene:
    """The scene with `inscribed` polygons for its circles; other shapes and the enclosure stay."""

    def flat(shape: Shape) -> Shape:
        return inscribed(shape, sides) if isinstance(shape, Circle) else shape

    return Scene(
        map(flat, scene.shapes),
        scene.start,
        terrain=scene.terrain,
        enclosure=scene.enclosure,
        radius=scene.radius,
        name=scene.name,
    )


def polygon_limit(
    ks: Iterable[int], scene: Scene | None = None, radius: object = None
) -> tuple[LimitRow, ...]:
    """Both strategies on a scene of circles (the gallery's "circles" if None) as polygons of k sides each.

    As k grows, P tends to P on the circles, while scans and moves grow without bound. *radius* is the
    Sightseer's, the scene's own if None. Errors as `inscribed`, `sightseer` and `vertex_scan` raise them.
    Cost: below a second for two polygons up to k = 64.

    >>> [(row.sides, row.scans, row.length.decimal(8)) for row in polygon_limit([4, 8])]
    [(4, 8, '38.600000'), (8, 16, '41.626824')]
    """
    world = gallery_scene("circles") if scene is None else scene
    reach = world.radius if radius is None else rational(radius)
    limit = sightseer(world, reach).length
    return tuple(_row(polygonal(world, k), k, reach, limit) for k in ks)


def _row(scene: Scene, sides: int, radius: fmpq | None, limit: Length) -> LimitRow:
    run, scan = sightseer(scene, radius), vertex_scan(scene)
    vertices = sum(len(obstacle.edges) for obstacle in scene.obstacles)
    return LimitRow(sides, run.length, limit - run.length, vertices, scan.scans, scan.moves, scan.length)
