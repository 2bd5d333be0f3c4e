"""Shortest paths: between two points of free space, along straight pieces and convex boundary arcs."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
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
from exactacq.visibility.known_ground import Charted, Grounded, KnownGround
from exactacq.visibility.scene_tables import place_in
from exactacq.visibility.taut_search import Label, PathSearch, TautWay

BITS = 64


@dataclass(frozen=True, repr=False)
class ShortestPath:
    """A shortest path from ``start`` to ``end``: its pieces, its exact length, and how many are as short.

    ``path`` are segments and arcs, as long as they can be: neighbours lie on no common line or circle. It is
    empty if start and end are one point. Of several shortest paths it is the one whose ``points`` come first:
    of the first that differ, the one with the least x, then the least y; where two arcs of one circle lead to
    the same point, the counterclockwise one.

    Of a path on a map ``scene`` are the obstacles that are wholly known, without their names, and ``walls``
    the known parts of the boundaries of others.

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
    walls: tuple[Curve, ...] = field(default=(), repr=False)

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


def shortest_path(
    scene: Scene | Charted | Grounded | KnownGround, start: object, end: object
) -> ShortestPath | None:
    """A shortest path between two points of free space; None if there is no path at all.

    Each point is a `Point` or a pair of numbers, with algebraic coordinates. Free space is closed: a path may
    touch boundaries and run along them, and nothing but the inside of an obstacle, and what is beyond the
    enclosure, stops it. If the scene has a terrain, its border is a wall too. Boundaries have no point in
    common, so a path ends only where a terrain's border cuts free space into parts; an obstacle that touches
    the border in a point does not cut it.

    The *scene* may be a map, as `Robot.map` or ``run.map``: then what is not known counts as free. Obstacles
    that are wholly known are as in a scene. Known parts of other boundaries are walls without thickness: a
    path may touch them, follow them on both sides and turn around their ends, and does not cross them. A
    point on such a wall is on its free side, where the robot was that saw it; single known points are none.

    Lengths are compared exactly, and those that are equal are proved to be: see `ShortestPath` for the choice
    among them. Raises `InvalidScene` if a point lies inside an obstacle, outside the terrain or beyond
    10^100, `FormatError` for what is no point, no scene and no map, and `Undecided` where lengths are too
    close to tell. Cost: linear in the number of corners and arcs for each that the search comes to; only the
    tangents that are tried are made.

    >>> import exactacq as xa
    >>> wall = xa.Polygon([(0, -1), (1, -1), (1, 3), (0, 3)])
    >>> scene = xa.Scene([wall], start=(-3, 0), radius=9)
    >>> print(xa.shortest_path(scene, (-3, 0), (5, 0)).length)
    1 + sqrt(10) + sqrt(17)
    >>> seen = xa.Robot(scene).map
    >>> print(xa.shortest_path(seen, (-3, 0), (5, 0)).length)
    sqrt(10) + sqrt(26)
    """
    ground = KnownGround.of(scene)
    ends = place_in(ground.scene, "start", start), place_in(ground.scene, "end", end)
    if ends[0] == ends[1]:
        return ShortestPath(ground.scene, *ends, (), Length(0), walls=ground.walls)
    goal = PathSearch(ground.tangents, *ends).run()
    if goal is None:
        return None
    tree = _Equals(goal)
    return ShortestPath(ground.scene, *ends, tuple(tree.chosen()), goal.length, tree.count, ground.walls)


_Link: TypeAlias = "tuple[TautWay, Label]"
_Spot: TypeAlias = "tuple[Label, _Link | None, int]"
"""A label, or how many pieces of the way to the next label are walked."""


class _Equals:
    """All paths of the least length, as the labels of the goal's ways back to the start.

    On both sides of the end of a chain a path has the directions along it, and so several rows of labels.
    Paths are counted by where they lead: those that have led the same way so far are one.
    """

    def __init__(self, goal: Label) -> None:
        self.goal, self.links = goal, dict[int, list[_Link]]()
        self._start = goal
        self._find_links()
        self.count = self._counted()

    def _find_links(self) -> None:
        """Find the links of each label, and the start."""
        stack, known = [self.goal], {id(self.goal)}
        while stack:
            label = stack.pop()
            self._start = label if not label.ways else self._start
            for way in label.ways:
                self.links.setdefault(id(way.source), []).append((way, label))
                if id(way.source) not in known:
                    known.add(id(way.source))
                    stack.append(way.source)

    def _counted(self) -> int:
        """How many paths there are: by the labels that one form of a path may have come to."""
        counts: dict[frozenset[int], int] = {frozenset((id(self.goal),)): 1}
        stack: list[tuple[Label, ...]] = [(self._start,)]
        following: dict[frozenset[int], list[tuple[Label, ...]]] = {}
        while stack:
            labels = stack[-1]
            key = _key(labels)
            if key not in following:
                following[key] = self._groups(labels)
            todo = [group for group in following[key] if _key(group) not in counts]
            if todo and key not in counts:
                stack += todo
                continue
            stack.pop()
            if key not in counts:
                counts[key] = sum(counts[_key(group)] for group in following[key])
        return counts[frozenset((id(self._start),))]

    def _groups(self, labels: tuple[Label, ...]) -> list[tuple[Label, ...]]:
        """The labels to which labels of one place lead, those by the same pieces together."""
        groups: list[tuple[TautWay, list[Label]]] = []
        for label in labels:
            for way, target in self.links.get(id(label), ()):
                same = (found for first, found in groups if _is_same(first, way))
                found = next(same, None)
                if found is None:
                    groups.append((way, [target]))
                elif target not in found:
                    found.append(target)
        return [tuple(found) for _, found in groups]

    def chosen(self) -> Iterator[Curve]:
        """The pieces of the path whose points come first."""
        spots: list[_Spot] = [(self._start, None, 0)]
        last: Curve | None = None
        while spots[0][0] is not self.goal or spots[0][1] is not None:
            reached: set[Hashable] = set()
            ends = [found for spot in spots for found in self._ends(spot, last, reached)]
            ends.sort(key=cmp_to_key(_order))
            last, _ = ends[0]
            spots = [spot for piece, spot in ends if piece is last or _order((piece, spot), ends[0]) == 0]
            yield last

    def _ends(self, spot: _Spot, last: Curve | None, reached: set[Hashable]) -> Iterator[tuple[Curve, _Spot]]:
        """The longest pieces that begin at a spot, and where they end.

        Pieces that go on with the *last* one are left out: they belong to other paths, in which that is
        longer. Along a row of walls there are ever more ways to the same spot: what it leads to is told once,
        and it is *reached*. Thousands of ways may lie on one line, so there is no recursion.
        """
        depth = [self._steps(spot, None, last, reached)]
        while depth:
            step = next(depth[-1], None)
            if step is None:
                depth.pop()
                continue
            piece, spot, goes_on = step
            if goes_on:
                depth.append(self._steps(spot, piece, last, reached))
            else:
                assert piece is not None, "only pieces end"
                yield piece, spot

    def _steps(
        self, spot: _Spot, piece: Curve | None, last: Curve | None, reached: set[Hashable]
    ) -> Iterator[tuple[Curve | None, _Spot, bool]]:
        """What a *piece* that has come to a spot becomes, if one has begun: with its spot, and whether it may
        go on from there."""
        label, link, done = spot
        # All begin in one place: those on one line or circle that end in one place are one piece.
        kind = None if piece is None else (_kind(piece), piece.center.key if isinstance(piece, Arc) else ())
        key = id(label), None if link is None else id(link[0]), done, kind
        if key in reached:
            return
        reached.add(key)
        if label is self.goal and link is None:
            yield piece, spot, False
            return
        has_ended = False
        for way, target in self.links[id(label)] if link is None else (link,):
            if done == len(way.pieces):
                yield piece, (target, None, 0), True
                continue
            following, _ = way.pieces[done]
            longer = following if piece is None else _joined(piece, following)
            if piece is None and last is not None and _joined(last, following) is not None:
                continue
            if longer is not None:
                yield longer, (label, (way, target), done + 1), True
            elif piece is not None and not has_ended:
                has_ended = True
                yield piece, spot, False


def _key(labels: tuple[Label, ...]) -> frozenset[int]:
    return frozenset(map(id, labels))


def _is_same(one: TautWay, other: TautWay) -> bool:
    """Whether two ways from one place have the same pieces."""
    if len(one.pieces) != len(other.pieces):
        return False
    pairs = list(zip(one.pieces, other.pieces, strict=True))
    is_alike = all(_kind(a) == _kind(b) for (a, _), (b, _) in pairs)
    return is_alike and all(a.end is b.end or a.end == b.end for (a, _), (b, _) in pairs)


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
