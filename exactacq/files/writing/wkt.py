"""Well-known text with curves: CIRCULARSTRING and COMPOUNDCURVE keep arcs, by a third point of each.

Finite decimals are written in full. The third point of an arc with such ends and centre is one too: its
middle if the bulge is a finite decimal, else its start turned about the centre by an angle whose cosine and
sine are finite decimals. Other arcs are rounded to a bulge that is one.
"""

from __future__ import annotations

from collections.abc import Iterator

from flint import fmpq

from exactacq.files.loops.chains import Corner
from exactacq.files.writing.corners import Corners, bulge_of
from exactacq.files.writing.decimals import KEPT, Precision, is_decimal, text
from exactacq.files.writing.sheet import NO_TERRAIN, TERRAIN, Item, Sheet, Written
from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point

Place = tuple[fmpq, fmpq]
WIDEST = fmpq(1)
TURNS = 8
"""Multiples, either way, of the angle of cosine 3/5 that are tried, each with all quarter turns."""


def written(sheet: Sheet) -> Written:
    """The sheet as one geometry, a collection if it has more than one item. Linear in the curves.

    Layers and properties are not held.
    """
    notes = ("no layers, names and properties", *((NO_TERRAIN,) if TERRAIN in sheet.layers else ()))
    sheet = sheet.without(TERRAIN)
    writer = _WktWriter(Precision.of(sheet))
    parts = [writer.geometry(item) for item in sheet.items]
    body = parts[0] if len(parts) == 1 else "GEOMETRYCOLLECTION EMPTY"
    if len(parts) > 1:
        body = "GEOMETRYCOLLECTION (\n" + ",\n".join(parts) + "\n)"
    return Written(f"{body}\n".encode(), writer.moved, notes)


class _WktWriter:
    def __init__(self, precision: Precision) -> None:
        self.precision, self.moved = precision, fmpq(0)

    def geometry(self, item: Item) -> str:
        """One item, in one line."""
        if item.place is not None:
            place, moved = self._place(item.place)
            self.moved = max(self.moved, moved)
            return f"POINT ({_pair(place)})"
        first = item.curves[0]
        if isinstance(first, Arc) and first.full and len(item.curves) == 1:
            kind, curve = "CIRCULARSTRING", self._circle(first)
        else:
            chain = Corners(item, self.precision, self._is_exact, WIDEST)
            self.moved = max(self.moved, chain.moved)
            kind, curve = self._curve(chain)
        if not item.closed:
            return f"{kind} {curve}"
        if kind == "LINESTRING":
            return f"POLYGON ({curve})"
        return f"CURVEPOLYGON ({kind} {curve})"

    def _circle(self, circle: Arc) -> str:
        """A full circle, by its start and the opposite point; its clockwise sense is not told.

        Both ends of a diameter move: centre and radius each move by no more than half of the sum.
        """
        start, moved = self._place(circle.start)
        middle, more = self._place(circle.center + (circle.center - circle.start))
        self.moved = max(self.moved, moved + more)
        return f"({_pair(start)}, {_pair(middle)}, {_pair(start)})"

    def _place(self, point: Point) -> tuple[Place, fmpq]:
        """A point as it is written, and a bound of its move."""
        (x, dx), (y, dy) = self.precision.rounded(point.x), self.precision.rounded(point.y)
        return (x, y), dx + dy

    def _is_exact(self, arc: Arc) -> bool:
        return self.precision.share(bulge_of(arc))[1] == 0 or third_point(arc) is not None

    def _curve(self, chain: Corners) -> tuple[str, str]:
        """The kind of curve that a chain is, and its places in parentheses."""
        runs: list[tuple[bool, list[Place]]] = []
        for (corner, curve), following in self._edges(chain):
            here, there = (corner.x, corner.y), (following.x, following.y)
            bent = isinstance(curve, Arc)
            if not runs or runs[-1][0] != bent:
                runs.append((bent, [here]))
            runs[-1][1].extend([self._third(corner, following, curve)] if isinstance(curve, Arc) else [])
            runs[-1][1].append(there)
        if not runs:  # all fell into one point
            corner = chain.corners[0]
            runs = [(False, [(corner.x, corner.y)] * 2)]
        listed = [(bent, "(" + ", ".join(map(_pair, places)) + ")") for bent, places in runs]
        if len(listed) == 1:
            bent, places = listed[0]
            return ("CIRCULARSTRING" if bent else "LINESTRING"), places
        named = ", ".join(f"CIRCULARSTRING {places}" if bent else places for bent, places in listed)
        return "COMPOUNDCURVE", f"({named})"

    @staticmethod
    def _edges(chain: Corners) -> Iterator[tuple[tuple[Corner, object], Corner]]:
        corners = chain.corners
        following = [*corners[1:], *(corners[:1] if chain.closed else [])]
        yield from zip(zip(corners, chain.curves, strict=True), following, strict=False)

    def _third(self, start: Corner, end: Corner, arc: Arc) -> Place:
        """A point of the arc between two corners: exact, or the middle of the rounded arc."""
        if self.precision.share(bulge_of(arc))[1] and not start.bulge_shift:
            exact = third_point(arc)
            assert exact is not None, "an arc without shift has an exact form"
            return exact
        return _middle((start.x, start.y), (end.x, end.y), start.bulge)


def third_point(arc: Arc) -> Place | None:
    """A point inside an arc between rational points whose coordinates are finite decimals, if one is found.

    The start turns about the centre by multiples of the angle of cosine 3/5 and sine 4/5, and by quarter
    turns: no other angles keep finite decimals (they are the units of the Gaussian integers over 10).

    >>> from exactacq import Point
    >>> quarter = Arc(Point(1, 0), Point(0, 1), Point(0, 0), fmpq(1), ccw=True)
    >>> third_point(quarter)
    (3/5, 4/5)
    """
    start, center = arc.start.rational, arc.center.rational
    if start is None or center is None or not all(map(is_decimal, (*start, *center))):
        return None
    stroke = arc.stroke()
    aim, near = stroke.at(0.5), stroke.length / 4
    found: list[tuple[bool, int, float, Place]] = []
    for x, y in _rotations((start[0] - center[0], start[1] - center[1])):
        place = center[0] + x, center[1] + y
        digits = sum(len(text(c)) for c in place)
        far = abs(float(place[0]) - aim[0]) + abs(float(place[1]) - aim[1])
        if digits <= 2 * KEPT and far < 4 * near:
            found.append((far > near, digits, far, place))
    for *_, place in sorted(found):  # rather near the middle, then short, then nearer
        point = Point(*place)
        if point not in (arc.start, arc.end) and arc.contains(point):
            return place
    return None


def _rotations(vector: Place) -> Iterator[Place]:
    for cosine, sine in ((fmpq(3, 5), fmpq(4, 5)), (fmpq(3, 5), fmpq(-4, 5))):
        x, y = vector
        for _ in range(TURNS + 1):
            yield from ((x, y), (-y, x), (-x, -y), (y, -x))
            x, y = cosine * x - sine * y, sine * x + cosine * y


def _middle(start: Place, end: Place, bulge: fmpq) -> Place:
    """The point of an arc that is equally far from both ends."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    return (start[0] + end[0] + dy * bulge) / 2, (start[1] + end[1] - dx * bulge) / 2


def _pair(place: Place) -> str:
    return f"{text(place[0])} {text(place[1])}"
