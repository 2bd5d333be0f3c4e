"""The union of overlapping polygons, through pyclipper on an integer grid that holds every vertex exactly.

The grid is the common denominator of all vertices and of all points where edges meet, so the union has its
vertices on it. pyclipper computes crossings in doubles: its answer is therefore checked in rationals (every
vertex is a vertex or a crossing of the input, every edge runs along input edges), and refused if it fails.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import pyclipper
from flint import fmpq
from networkx.utils import UnionFind

from exactacq.errors import FormatError
from exactacq.files.loops.nesting import Loops
from exactacq.geometry.box_index import BoxIndex, bounds
from exactacq.geometry.curves import Segment
from exactacq.geometry.intersections import contacts, winding
from exactacq.geometry.points import Point
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Loop, Polygon, Shape, shape_edges

GRID_BITS = 61
"""Clipper takes integers below 2^62; one bit is left for its differences."""
NAMED = 6
"""How many loops of a group a message names."""

Pair = tuple[fmpq, fmpq]


@dataclass(slots=True)
class Merged:
    """Obstacles and wall after the union."""

    obstacles: list[Shape]
    wall: Shape | None
    notes: list[str] = field(default_factory=list)


def unite(shapes: list[Shape], wall: Shape | None, start: Point | None) -> Merged:
    """Merge obstacles that meet each other, or the wall, into their union.

    What the wall and the obstacles that meet it leave free around the start becomes the new wall; so does a
    hole of a union that holds the start; other holes are filled, for the robot cannot see them. Raises
    `FormatError` if a group of meeting loops holds an arc or has no common grid, or the start is in none of
    its free places, and `InvalidScene` if one of its polygons crosses itself.
    """
    every = [*([] if wall is None else [wall]), *shapes]
    merged = Merged([], wall)
    groups = UnionFind(range(len(every)))
    for pair in Loops(every).meeting:
        groups.union(*pair)
    for group in sorted(map(sorted, groups.to_sets())):
        members = [every[i] for i in group]
        if len(members) > 1:
            _merge(members, members[0] is wall, start, merged)
        elif members[0] is not wall:
            merged.obstacles.append(members[0])
    return merged


def _merge(members: list[Shape], walled: bool, start: Point | None, merged: Merged) -> None:
    """One group of meeting loops; the first is the wall if *walled*."""
    names = ", ".join(repr(member.name) for member in members[:NAMED])
    names += f" and {len(members) - NAMED} more" if len(members) > NAMED else ""
    polygons = [m for m in members if not isinstance(m, Circle) and not any(b for _, _, b in m.vertices)]
    if len(polygons) < len(members):
        raise FormatError(f"no union of {names}: it has arcs and only polygons are merged; edit the drawing")
    for polygon in polygons:
        Scene([polygon])
    grid = _Grid(polygons, names)
    tree = grid.clip(walled)
    rooms = list(_regions(tree, hole=not walled))
    name = f"union of {names}"
    around = () if start is None else (n for n in rooms if _inside(grid.polygon(n.Contour), start))
    room = next(iter(around), None)
    if walled and room is None:
        raise FormatError(f"no union of {names}: the start is not in what it leaves free; choose another")
    merged.notes.append(f"merged {names} into their exact union")
    if room is not None:
        wall = grid.polygon(room.Contour, name)
        if walled or merged.wall is None or _inside(merged.wall, Point(*wall.vertices[0][:2])):
            merged.wall = wall
        merged.obstacles += [grid.polygon(node.Contour, name) for node in room.Childs]
    else:
        merged.obstacles += [grid.polygon(node.Contour, name) for node in tree.Childs]
    closed = len(rooms) - (room is not None)
    if closed:
        merged.notes.append(f"left out {closed} free places closed in by {name} (the robot cannot see them)")


def _regions(node: Any, hole: bool) -> Iterator[Any]:
    """All contours below a node of a polytree that are holes, or that are not."""
    queue = list(node.Childs)
    while queue:
        here = queue.pop(0)
        if here.IsHole == hole:
            yield here
        queue += here.Childs


def _inside(shape: Shape, point: Point) -> bool:
    return bool(winding(shape_edges(shape), point))


def _execute(kind: int, subject: list[Any], clip: Iterable[Any] = ()) -> Any:
    clipper = pyclipper.Pyclipper()
    clipper.AddPaths(subject, pyclipper.PT_SUBJECT)
    for path in clip:
        clipper.AddPath(path, pyclipper.PT_CLIP)
    return clipper.Execute2(kind, pyclipper.PFT_NONZERO, pyclipper.PFT_NONZERO)


class _Grid:
    """Polygons on integers: shifted to their least corner, scaled by the common denominator."""

    def __init__(self, polygons: list[Loop], names: str) -> None:
        self.names = names
        self.polygons = polygons
        self.edges = [e for p in polygons for e in shape_edges(p) if isinstance(e, Segment)]
        self.index = BoxIndex(bounds(self.edges))
        self.points = {(x, y) for p in polygons for x, y, _ in p.vertices} | self._crossings()
        self.origin = (min(x for x, _ in self.points), min(y for _, y in self.points))
        self.scale = 1
        for point in self.points:
            for coordinate, low in zip(point, self.origin, strict=True):
                self.scale *= int((coordinate - low).q // (coordinate - low).q.gcd(self.scale))
                if self.scale.bit_length() > GRID_BITS:
                    self._refuse()
        reach = max(c - low for p in self.points for c, low in zip(p, self.origin, strict=True))
        if reach * self.scale >= 1 << GRID_BITS:
            self._refuse()

    def _refuse(self) -> None:
        raise FormatError(
            f"no union of {self.names}: vertices and crossings have no common grid of {GRID_BITS} bits; "
            "round the coordinates or edit the drawing"
        )

    def _crossings(self) -> set[Pair]:
        found: set[Pair] = set()
        for first, second in self.index.pairs():
            for i, j in zip(first.tolist(), second.tolist(), strict=True):
                for contact in contacts(self.edges[i], self.edges[j]):
                    pairs = (contact.start.rational, contact.end.rational)
                    found.update(pair for pair in pairs if pair is not None)
        return found

    def clip(self, walled: bool) -> Any:
        """The polytree of the union of all, or of the first without the others if *walled*.

        Clipper leaves some neighbours apart that share an edge; feeding its answer to it again joins them.
        """
        paths = [self._path(polygon) for polygon in self.polygons]
        try:
            if walled:
                tree = _execute(pyclipper.CT_DIFFERENCE, paths[:1], paths[1:])
            else:
                tree = _execute(pyclipper.CT_UNION, paths)
            count, contours = -1, pyclipper.PolyTreeToPaths(tree)
            while contours and len(contours) != count:
                count = len(contours)
                tree = _execute(pyclipper.CT_UNION, contours)
                contours = pyclipper.PolyTreeToPaths(tree)
            return tree
        except pyclipper.ClipperException as error:
            raise FormatError(f"no union of {self.names}: {error}; edit the drawing") from None

    def _path(self, polygon: Loop) -> list[tuple[int, int]]:
        """The vertices as integers, counterclockwise (nonzero filling adds what overlaps)."""
        pairs = [
            tuple(int((c - low) * self.scale) for c, low in zip(vertex, self.origin, strict=False))
            for vertex in polygon.vertices
        ]
        path = [(x, y) for x, y in pairs]
        return path if pyclipper.Orientation(path) else path[::-1]

    def polygon(self, contour: Iterable[tuple[int, int]], name: str | None = None) -> Polygon:
        """A contour of the answer in the drawing's coordinates, after the check."""
        left, low = self.origin
        ring = [(left + fmpq(x, self.scale), low + fmpq(y, self.scale)) for x, y in contour]
        exact = all(pair in self.points for pair in ring)
        corners = [Point(*pair) for pair in ring]
        sides = [Segment(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
        if not exact or not all(self._covered(side) for side in sides):
            self._refuse()
        return Polygon(ring, name)

    def _covered(self, side: Segment) -> bool:
        """Whether a segment runs along input edges all the way."""
        along, square = side.direction, side.direction.norm_sq()
        pieces = []
        for k in self.index.query(*bounds([side])[0]).tolist():
            ends = [end - side.start for end in (self.edges[k].start, self.edges[k].end)]
            if all(along.cross(end) == 0 for end in ends):
                pieces.append(sorted(along.dot(end) / square for end in ends))
        reached = fmpq(0)
        for low, high in sorted(pieces):
            if low > reached:
                return False
            reached = max(reached, high)
        return bool(reached >= 1)
