"""Exact overlays of loops of segments and arcs: the boundary of a set that is told by which loops hold it.

Every edge is cut where it meets edges of other loops. A piece between two cuts meets no other loop, unless it
runs along an edge of one; so each loop holds all of its left side or nothing, and likewise on the right. That
is asked at one rational point of the piece. Pieces with the set on one side only are its boundary; they are
turned to have it on their left, and joined at their ends. All of this is decided exactly.

Where an arc is crossed, the crossing is irrational as a rule. Shapes have rational vertices, so one near it
is taken, and a rational bulge near that of each arc that ends there; `exactacq.files.loops.chains` proves how
far that moves any point.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cmp_to_key
from itertools import pairwise
from math import atan2, pi

import numpy as np
from flint import fmpq
from networkx.utils import UnionFind

from exactacq.errors import FormatError
from exactacq.files.loops.chains import Chain, Corner
from exactacq.files.loops.rational_arcs import arc_around, simplest_between
from exactacq.geometry.box_index import BoxIndex, bounds, united
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.intersections import contacts
from exactacq.geometry.loops import signed_area, winding
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.shapes import Circle, Shape, shape_edges

BITS = 160
"""Bits with which irrational vertices are enclosed."""
DIGITS = fmpq(1, 2**60)
"""A vertex near an irrational one is off by this fraction of the size of the loops, or less."""
MAX_CONTACTS = 20_000
"""Contacts of edges beyond which nothing is merged: each takes some 0.5 milliseconds."""


@dataclass(frozen=True, slots=True)
class Ring:
    """A closed part of a boundary, with the set on its left; *outer* if it runs counterclockwise."""

    chain: Chain
    outer: bool

    def shape(self, name: str) -> Shape:
        """The ring as a shape."""
        self.chain.label = name
        return self.chain.shape()


def overlay(shapes: Sequence[Shape], holds: Callable[[Sequence[bool]], bool]) -> list[Ring]:
    """The boundary of the points for which *holds* is true of the list of which shapes hold them.

    The shapes are simple loops. *holds* is false where none does. Where the boundary touches itself in a
    point, rings are kept apart as far as floats tell; a scene refuses such rings. Raises `FormatError` for
    more than `MAX_CONTACTS`. Near linear in the edges, and in the contacts times the edges of a loop.

    >>> from exactacq.scene.shapes import Polygon
    >>> one, two = (Polygon([(x, x), (x + 2, x), (x + 2, x + 2), (x, x + 2)]) for x in (0, 1))
    >>> ring, = overlay([one, two], any)
    >>> ring.outer, len(ring.chain.corners)
    (True, 8)
    """
    loops = [_counterclockwise(shape) for shape in shapes]
    if not loops:
        return []
    cuts = _cuts(loops)
    hulls = BoxIndex(np.array([_hull(loop) for loop in loops]))
    parts = [part for k in range(len(loops)) for part in _parts_of(k, loops, hulls, cuts, holds)]
    unit = DIGITS
    while any(abs(c) * DIGITS > unit for loop in loops for e in loop for c in (e.start.x, e.start.y)):
        unit *= 2
    return [_finished(walk, unit) for walk in _walks(parts)]


def _counterclockwise(shape: Shape) -> list[Curve]:
    """The edges with the inside on their left; a circle as two halves, whose ends are rational."""
    if isinstance(shape, Circle):
        (x, y), r = shape.center, shape.radius
        east, west = Point(x + r, y), Point(x - r, y)
        return [Arc(a, b, Point(x, y), r * r, True) for a, b in ((east, west), (west, east))]
    edges = list(shape_edges(shape))
    if signed_area(edges).sign() < 0:
        edges = [edge.reversed() for edge in reversed(edges)]
    return edges


Cuts = dict[tuple[int, int], list[Point]]


def _cuts(loops: Sequence[Sequence[Curve]]) -> Cuts:
    """Where each edge meets those of other loops, by loop and number."""
    places = [(k, i) for k, loop in enumerate(loops) for i in range(len(loop))]
    flat = [edge for loop in loops for edge in loop]
    cuts: defaultdict[tuple[int, int], list[Point]] = defaultdict(list)
    count = 0
    for first, second in BoxIndex(bounds(flat)).pairs():
        for i, j in zip(first.tolist(), second.tolist(), strict=True):
            if places[i][0] == places[j][0]:
                continue
            for contact in contacts(flat[i], flat[j]):
                count += 1
                if count > MAX_CONTACTS:
                    raise FormatError(f"more than {MAX_CONTACTS} contacts; select layers that hold one part")
                for place in (places[i], places[j]):
                    cuts[place] += [contact.start, contact.end]
    return dict(cuts)


def _parts_of(
    k: int,
    loops: Sequence[Sequence[Curve]],
    hulls: BoxIndex,
    cuts: Cuts,
    holds: Callable[[Sequence[bool]], bool],
) -> list[Curve]:
    """The pieces of a loop that are boundary; one that other loops share is the first loop's."""
    found = []
    known: list[bool] | None = None
    for i, edge in enumerate(loops[k]):
        rail = Rail(edge)
        marks = _marks(edge, rail, cuts.get((k, i), []))
        for (low, start), (high, end) in pairwise(marks):
            middle = rail.point(_between(low, high))
            if known is None or (k, i) in cuts:
                left, right, shared = _sides(k, middle, edge, loops, hulls)
                known = None if (k, i) in cuts else right
            else:
                left, right, shared = [*known[:k], True, *known[k + 1 :]], known, False
            if holds(left) == holds(right) or shared:
                continue
            piece = edge if len(marks) == 2 else edge.part(start, end)
            found.append(piece if holds(left) else piece.reversed())
        if (k, i) in cuts:
            known = None
    return found


def _marks(edge: Curve, rail: Rail, cuts: Sequence[Point]) -> list[tuple[Real, Point]]:
    """The cuts of an edge in order with their parameters, its ends first and last, each place once."""
    marks = [(Real(0), edge.start)]
    inner = [(rail.parameter(point), point) for point in cuts]
    inner.sort(key=cmp_to_key(_in_order))
    for mark in [*inner, (rail.top, edge.end)]:
        if mark[0].compare(marks[-1][0]) > 0:
            marks.append(mark)
    last = marks.pop()
    return [*marks, (last[0], edge.end if last[0].compare(rail.top) == 0 else last[1])]


def _in_order(one: tuple[Real, Point], other: tuple[Real, Point]) -> int:
    return one[0].compare(other[0])


def _between(low: Real, high: Real) -> fmpq:
    """A simple rational strictly between two numbers."""
    bits = 32
    while True:
        a, b = low.enclosure(bits)[1], high.enclosure(bits)[0]
        if a < b:
            third = (b - a) / 3
            return simplest_between(a + third, b - third)
        bits *= 2


def _sides(
    k: int, middle: Point, edge: Curve, loops: Sequence[Sequence[Curve]], hulls: BoxIndex
) -> tuple[list[bool], list[bool], bool]:
    """Which loops hold the left and the right of a piece, and whether an earlier loop runs along it."""
    left, right, shared = [False] * len(loops), [False] * len(loops), False
    left[k] = True
    for other in hulls.query(*bounds([Segment(middle, middle)])[0].tolist()).tolist():
        if other == k:
            continue
        turns = winding(loops[other], middle)
        if turns is not None:
            left[other] = right[other] = bool(turns)
            continue
        left[other] = _same_way(edge, next(e for e in loops[other] if e.passes(middle)), middle)
        right[other] = not left[other]
        shared = shared or other < k
    return left, right, shared


def _hull(loop: Sequence[Curve]) -> list[float]:
    """The box of a loop, rounded outward."""
    found: list[float] = united(bounds(loop), [0])[0].tolist()
    return found


def _same_way(one: Curve, other: Curve, place: Point) -> bool:
    """Whether two curves that overlap at a place run the same way."""
    along, across = (
        curve.direction if isinstance(curve, Segment) else curve.tangent(place) for curve in (one, other)
    )
    return along.dot(across).sign() > 0


def _walks(parts: Sequence[Curve]) -> list[list[Curve]]:
    """The closed walks of the pieces; where several go on, the one that turns left most."""
    nodes = _nodes(parts)
    leaving: defaultdict[object, list[Curve]] = defaultdict(list)
    for part in parts:
        leaving[nodes[_place(part.start)]].append(part)
    walks = []
    for first in parts:
        beginning = nodes[_place(first.start)]
        if first not in leaving[beginning]:
            continue
        walk = [first]
        leaving[beginning].remove(first)
        while (node := nodes[_place(walk[-1].end)]) != beginning:
            here = leaving[node]
            if not here:
                raise FormatError("no union: parts of arcs meet in irrational points; edit the drawing")
            back = _angle(walk[-1], walk[-1].end) + pi
            following = min(here, key=lambda part: (back - _angle(part, part.start)) % (2 * pi))
            here.remove(following)
            walk.append(following)
        walks.append(walk)
    return walks


def _nodes(parts: Sequence[Curve]) -> dict[object, object]:
    """One name for each place where pieces end, by all its names.

    Where an arc meets two loops in one point, that may have been computed in two forms.
    """
    ends = {_place(end): end for part in parts for end in (part.start, part.end)}
    names, points = list(ends), list(ends.values())
    same = UnionFind(names)
    for first, second in BoxIndex(bounds([Segment(point, point) for point in points])).pairs():
        for i, j in zip(first.tolist(), second.tolist(), strict=True):
            if points[i] == points[j]:
                same.union(names[i], names[j])
    return {name: same[name] for name in names}


def _angle(curve: Curve, point: Point) -> float:
    """The direction of a piece at one of its ends, in floats."""
    along = curve.direction if isinstance(curve, Segment) else curve.tangent(point)
    return atan2(float(along.y), float(along.x))


def _place(point: Point) -> object:
    return point.rational or point.key


def _finished(walk: Sequence[Curve], unit: fmpq) -> Ring:
    """A walk without vertices along smooth edges, with rational vertices."""
    curves: list[Curve] = []
    for part in walk:
        joined = _joined(curves[-1], part) if curves else None
        curves[-1:] = [joined] if joined is not None else [*curves[-1:], part]
    joined = _joined(curves[-1], curves[0]) if len(curves) > 2 else None
    if joined is not None:
        curves = [joined, *curves[1:-1]]
    outer = signed_area(curves).sign() > 0
    starts = [_rational(curve.start, unit) for curve in curves]
    corners = []
    for curve, (start, off), (end, shift) in zip(curves, starts, [*starts[1:], *starts[:1]], strict=True):
        corner = Corner(*start, fmpq(0), off)
        if isinstance(curve, Arc):
            center = curve.center.rational
            if center is not None and not off and not shift:
                corner = arc_around(start, end, center, curve.ccw)
            else:
                corner.bulge, corner.bulge_shift = _bulge(curve)
        corners.append(corner)
    return Ring(Chain("union", corners, closed=True), outer)


def _joined(first: Curve, second: Curve) -> Curve | None:
    """Two pieces, one after the other, as one of the same line or circle; None if they are not."""
    if isinstance(first, Segment) and isinstance(second, Segment):
        turn = first.direction.cross(second.direction).sign()
        return None if turn else Segment(first.start, second.end)
    if isinstance(first, Arc) and isinstance(second, Arc):
        one = first.radius_sq == second.radius_sq and first.ccw == second.ccw
        if one and first.center == second.center and first.start != second.end:
            return Arc(first.start, second.end, first.center, first.radius_sq, first.ccw)
    return None


def _rational(point: Point, unit: fmpq) -> tuple[tuple[fmpq, fmpq], fmpq]:
    """A point, or a rational one near it, and a bound of their distance."""
    if point.rational is not None:
        return point.rational, fmpq(0)
    bounds_of = [c.enclosure(BITS) for c in (point.x, point.y)]
    x, y = ((low / unit + fmpq(1, 2)).floor() * unit for low, _ in bounds_of)
    width = max(high - low for low, high in bounds_of)
    return (x, y), unit + 2 * width


def _bulge(arc: Arc) -> tuple[fmpq, fmpq]:
    """A rational near the tangent of a quarter of an arc's angle, and a bound of the error.

    With cosine c and sine s of the angle, and h that of half of it: h = sqrt((1 + c) / 2), negative if s is;
    the tangent is sqrt((1 - c) / 2) / (1 + h).
    """
    cosine, sine = arc.turn
    half = ((1 + cosine) / 2).sqrt() * (-1 if sine.sign() < 0 else 1)
    tangent, bits = ((1 - cosine) / 2).sqrt() / (1 + half), BITS
    while (ends := tangent.enclosure(bits))[0] <= 0:  # it is positive, but perhaps very small
        bits *= 2
    low, high = ends
    value = simplest_between(low - low * DIGITS, high + low * DIGITS)
    off = max(high - value, value - low)
    return (value, off) if arc.ccw else (-value, off)
