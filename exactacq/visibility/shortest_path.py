"""Shortest paths: between two points of free space, along straight pieces and convex boundary arcs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cmp_to_key
from typing import TypeAlias

from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.geo import Geo, line_string
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.scene.ports import SVG, made
from exactacq.scene.scene import Scene
from exactacq.scene.validation import place_text
from exactacq.visibility.scene_tables import SceneTables, place_in
from exactacq.visibility.taut_search import Label, PathSearch, TautWay

BITS = 64


@dataclass(frozen=True, repr=False)
class ShortestPath:
    """A shortest path from ``start`` to ``end``: its pieces, its exact length, and how many are as short.

    ``path`` are segments and arcs, as long as they can be: neighbours lie on no common line or circle. It is
    empty if start and end are one point. Of several shortest paths it is the one whose ``points`` come first:
    of the first that differ, the one with the least x, then the least y; where two arcs of one circle lead to
    the same point, the counterclockwise one.

    >>> import exactacq as xa
    >>> found = xa.shortest_path(xa.Scene([xa.Circle((0, 0), 1)]), (-2, 0), (2, 0))
    >>> print(found.length, found.count)
    pi/3 + 2*sqrt(3) 2
    >>> for point in found.points:
    ...     print(point)
    (-2, 0)
    (-1/2, -sqrt(3)/2)
    (1/2, -sqrt(3)/2)
    (2, 0)
    """

    scene: Scene
    start: Point
    end: Point
    path: tuple[Curve, ...]
    length: Length
    count: int = field(default=1)

    @property
    def points(self) -> tuple[Point, ...]:
        """Start, the points between two pieces, and end."""
        return (self.start, *(piece.end for piece in self.path))

    @property
    def __geo_interface__(self) -> Geo:
        """A GeoJSON LineString; arcs are chords (`geometry.geo.FLATNESS`). A Point where the path is one."""
        if not self.path:
            return self.start.__geo_interface__
        return line_string([piece.stroke() for piece in self.path])

    def _repr_svg_(self) -> str:
        return str(made(SVG, self))

    def __repr__(self) -> str:
        pieces = f"{len(self.path)} pieces" if len(self.path) != 1 else "1 piece"
        ends = f"{place_text(self.start)} to {place_text(self.end)}"
        return f"<ShortestPath from {ends}: {float(self.length):.6g}, {pieces}>"


def shortest_path(scene: Scene, start: object, end: object) -> ShortestPath | None:
    """A shortest path between two points of free space; None if there is no path at all.

    Each point is a `Point` or a pair of numbers, with algebraic coordinates. Free space is closed: a path may
    touch boundaries and run along them, and nothing but the inside of an obstacle, and what is beyond the
    enclosure, stops it. If the scene has a terrain, its border is a wall too. Boundaries have no point in
    common, so a path ends only where a terrain's border cuts free space into parts; an obstacle that touches
    the border in a point does not cut it.

    Lengths are compared exactly, and those that are equal are proved to be: see `ShortestPath` for the choice
    among them. Raises `InvalidScene` if a point lies inside an obstacle or outside the terrain, `FormatError`
    for what is no point, and `Undecided` where lengths are too close to tell. Cost: linear in the number of
    corners and arcs for each that the search comes to; only the tangents that are tried are made.

    >>> import exactacq as xa
    >>> wall = xa.Polygon([(0, -1), (1, -1), (1, 3), (0, 3)])
    >>> print(xa.shortest_path(xa.Scene([wall]), (-3, 0), (5, 0)).length)
    1 + sqrt(10) + sqrt(17)
    """
    ends = place_in(scene, "start", start), place_in(scene, "end", end)
    if ends[0] == ends[1]:
        return ShortestPath(scene, *ends, (), Length(0))
    goal = PathSearch(SceneTables.of(scene).tangents, *ends).run()
    if goal is None:
        return None
    tree = _Equals(goal)
    return ShortestPath(scene, *ends, tuple(tree.chosen()), goal.length, tree.count)


_Link: TypeAlias = "tuple[TautWay, Label]"
_Spot: TypeAlias = "tuple[Label, _Link | None, int]"
"""A label, or how many pieces of the way to the next label are walked."""


class _Equals:
    """All paths of the least length, as the labels of the goal's ways back to the start."""

    def __init__(self, goal: Label) -> None:
        self.goal, self.links = goal, dict[int, list[_Link]]()
        self._start = goal
        self._counts: dict[int, int] = {}
        self.count = self._counted()

    def _counted(self) -> int:
        """How many paths there are; finds the links of each label on the way."""
        stack = [self.goal]
        while stack:
            label = stack[-1]
            todo = [way.source for way in label.ways if id(way.source) not in self._counts]
            if todo:
                stack += todo
                continue
            stack.pop()
            if id(label) in self._counts:
                continue
            for way in label.ways:
                self.links.setdefault(id(way.source), []).append((way, label))
            self._start = label if not label.ways else self._start
            self._counts[id(label)] = sum(self._counts[id(way.source)] for way in label.ways) or 1
        return self._counts[id(self.goal)]

    def chosen(self) -> Iterator[Curve]:
        """The pieces of the path whose points come first."""
        spots: list[_Spot] = [(self._start, None, 0)]
        while spots[0][0] is not self.goal or spots[0][1] is not None:
            ends = [found for spot in spots for found in self._onward(spot, None)]
            ends.sort(key=cmp_to_key(_order))
            first, _ = ends[0]
            spots = [spot for piece, spot in ends if piece is first or _order((piece, spot), ends[0]) == 0]
            yield first

    def _onward(self, spot: _Spot, piece: Curve | None) -> Iterator[tuple[Curve, _Spot]]:
        """The longest pieces that begin at a spot or go on with a *piece*, and where they end."""
        label, link, done = spot
        if label is self.goal and link is None:
            assert piece is not None
            yield piece, spot
            return
        has_ended = False
        for way, target in self.links[id(label)] if link is None else (link,):
            if done == len(way.pieces):
                yield from self._onward((target, None, 0), piece)
                continue
            following, _ = way.pieces[done]
            longer = following if piece is None else _joined(piece, following)
            if longer is not None:
                yield from self._onward((label, (way, target), done + 1), longer)
            elif piece is not None and not has_ended:
                has_ended = True
                yield piece, spot


def _joined(first: Curve, second: Curve) -> Curve | None:
    """One piece for two that follow each other on a line or circle, else None."""
    if isinstance(first, Arc) and isinstance(second, Arc):
        same = first.ccw == second.ccw and first.radius_sq == second.radius_sq
        if same and first.center == second.center:
            return Arc(first.start, second.end, first.center, first.radius_sq, first.ccw)
    elif isinstance(first, Segment) and isinstance(second, Segment):
        turn, ahead = (f(first.direction, second.direction) for f in (Point.cross, Point.dot))
        if turn.clear_sign(BITS) == 0 and ahead.sign() > 0 and turn.sign() == 0:
            return Segment(first.start, second.end)
    return None


def _order(one: tuple[Curve, _Spot], other: tuple[Curve, _Spot]) -> int:
    """Order of pieces from one point by their ends, straight ones first, then counterclockwise ones."""
    a, b = one[0], other[0]
    return (0 if a.end is b.end else a.end.compare(b.end)) or _kind(a) - _kind(b)


def _kind(curve: Curve) -> int:
    return 0 if isinstance(curve, Segment) else 1 if curve.ccw else 2
