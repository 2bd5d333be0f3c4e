"""The free part of a continuum of equally short segments between two parallel edges or concentric arcs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cmp_to_key
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from flint import fmpq

from exactacq.geometry.box_index import box
from exactacq.geometry.coordinates import raw, same_direction
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.nearest_points import NearestFamily, NearestFamilyKind
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.chords import Chord
from exactacq.visibility.free_segment import is_free

Place: TypeAlias = "Real | Point"
"""Position in a family: a fraction of the first segment, or a direction from the common centre."""


def free_pieces(table: EdgeTable, family: NearestFamily) -> Iterator[NearestFamily | Chord]:
    """The maximal free sub-families and the free isolated segments of a family.

    What is free changes only beside vertices and arcs' extreme points: one segment between two neighbouring
    critical places tells for all. Cost: a clearance test for every critical place.
    """
    if _is_clear(table, family):
        yield family
        return
    places = _Fractions(family) if family.kind is NearestFamilyKind.PARALLEL else _Directions(family)
    cuts = places.ordered(_critical(table, family, places))
    free = [_is_open(table, places.chord(places.between(a, b))) for a, b in pairwise(cuts)]
    if places.is_closed:
        # So that no part runs over the place where all begins and ends, if any ends at all.
        first = next((k for k, after in enumerate(free) if not (free[k - 1] and after)), 0)
        cuts = [*cuts[first:-1], *cuts[: first + 1]]
        free = free[first:] + free[:first]
    run: int | None = None
    for k, cut in enumerate(cuts):
        before = free[k - 1] if k > 0 or places.is_closed else False
        after = k < len(free) and free[k]
        if after and run is None:
            run = k
        elif not after and run is not None:
            yield places.part(cuts[run], cut)
            run = None
        is_told = places.is_closed and k == len(free)
        if not (before or after or is_told):
            segment = places.chord(cut)
            if _is_open(table, segment):
                yield Chord(segment.start, segment.end, segment.length.algebraic)


def _is_open(table: EdgeTable, segment: Segment) -> bool:
    return is_free(table, segment.start, segment.end)


def _curves(family: NearestFamily) -> list[Curve]:
    return [c for c in (family.first, family.second) if not isinstance(c, Point)]


def _near(table: EdgeTable, family: NearestFamily) -> list[int]:
    corners = [box(c) for c in _curves(family)]
    corners += [(*p.xy, *p.xy) for p in (family.first, family.second) if isinstance(p, Point)]
    low = np.min([c[:2] for c in corners], axis=0)
    high = np.max([c[2:] for c in corners], axis=0)
    return [int(e) for e in table.near((low[0], low[1]), (high[0], high[1]), 0.0)]


def _is_clear(table: EdgeTable, family: NearestFamily) -> bool:
    """Whether no edge can reach the open strip between two parallel segments: floats with a margin."""
    if family.kind is not NearestFamilyKind.PARALLEL:
        return False
    assert isinstance(family.first, Segment)
    assert isinstance(family.second, Segment)
    a, b, c = (np.array(p.xy) for p in (family.first.start, family.first.end, family.second.start))
    along, across = b - a, c - a
    length, width = float(np.hypot(*along)), float(np.hypot(*across))
    edges = np.array(_near(table, family), dtype=np.intp)
    slack = 64 * table.roundoff
    if min(length, width) < 1024 * slack:
        return False
    for unit, extent in ((along / length, length), (across / width, width)):
        corners = table.boxes[edges].reshape(-1, 2, 2) - a
        near, far = corners.min(axis=1), corners.max(axis=1)
        plus, minus = np.maximum(unit, 0), np.minimum(unit, 0)
        low, high = near @ plus + far @ minus, far @ plus + near @ minus
        straight = table.kind[edges] == 0
        ends = np.stack(((table.start[edges] - a) @ unit, (table.end[edges] - a) @ unit))
        low = np.where(straight, ends.min(axis=0), low)
        high = np.where(straight, ends.max(axis=0), high)
        # Edges that only touch the strip's rim from outside do not enter its open inside.
        edges = edges[(high > slack) & (low < extent - slack)]
    return not len(edges)


def _critical(table: EdgeTable, family: NearestFamily, places: _Places) -> Iterator[Place]:
    for e in _near(table, family):
        curve = table.curves[e]
        yield from places.through(curve.start)
        if isinstance(curve, Arc):
            yield from places.touching(curve)


class _Fractions:
    """Places of a parallel family: fractions of its first segment."""

    is_closed = False

    def __init__(self, family: NearestFamily) -> None:
        assert isinstance(family.first, Segment)
        assert isinstance(family.second, Segment)
        self.first, self.offset = family.first, family.second.start - family.first.start
        self.along = family.first.direction
        self.size = self.along.norm_sq()

    def through(self, point: Point) -> Iterator[Place]:
        yield (point - self.first.start).dot(self.along) / self.size

    def touching(self, arc: Arc) -> Iterator[Place]:
        middle = (arc.center - self.first.start).dot(self.along)
        for sign in (1, -1):
            yield (middle + sign * (self.size * arc.radius_sq).sqrt()) / self.size

    def ordered(self, places: Iterator[Place]) -> list[Place]:
        inner = [p for p in places if isinstance(p, Real) and p.sign() > 0 and p.compare(1) < 0]
        return _distinct([Real(0), *inner, Real(1)], _compare_reals)

    def between(self, low: Place, high: Place) -> Place:
        assert isinstance(low, Real)
        assert isinstance(high, Real)
        middle: Real = (low + high) * fmpq(1, 2)
        return middle

    def chord(self, place: Place) -> Segment:
        start = self.first.start + self.along * place
        return Segment(start, start + self.offset)

    def part(self, low: Place, high: Place) -> NearestFamily:
        a, b = self.chord(low), self.chord(high)
        return NearestFamily(NearestFamilyKind.PARALLEL, Segment(a.start, b.start), Segment(a.end, b.end))


class _Directions:
    """Places of a concentric family: directions from the common centre, counterclockwise from one end."""

    def __init__(self, family: NearestFamily) -> None:
        arc = family.first if isinstance(family.first, Arc) else family.second
        assert isinstance(arc, Arc)
        self.family, self.arc = family, arc if arc.ccw else arc.reversed()
        self.center, self.is_closed = self.arc.center, self.arc.full
        self.low = self.arc.start - self.center
        self.high = self.arc.end - self.center

    def through(self, point: Point) -> Iterator[Place]:
        yield point - self.center

    def touching(self, arc: Arc) -> Iterator[Place]:
        offset = arc.center - self.center
        square = offset.norm_sq() - arc.radius_sq
        if square.sign() > 0:
            reach = square.sqrt()
            for sign in (1, -1):
                yield offset * reach + offset.left() * (arc.radius * sign)

    def ordered(self, places: Iterator[Place]) -> list[Place]:
        inner: list[Place] = []
        for place in places:
            assert isinstance(place, Point)
            if place.norm_sq().sign() > 0 and self._is_inside(place):
                inner.append(place)
        ordered = _distinct(inner, self._compare)
        return [self.low, *ordered, self.high]

    def _is_inside(self, direction: Point) -> bool:
        if any(same_direction(raw(direction), raw(end)) for end in (self.low, self.high)):
            return False
        return self.arc.full or self._compare(direction, self.high) < 0

    def _compare(self, a: Place, b: Place) -> int:
        """Order of the angles in (0, 2 pi) from the first end."""
        assert isinstance(a, Point)
        assert isinstance(b, Point)
        return self._half(a) - self._half(b) or -a.cross(b).sign()

    def _half(self, direction: Point) -> int:
        """0 in the first half turn, 1 just at its end, 2 in the second half turn."""
        side = self.low.cross(direction).sign()
        return 1 - side if side or self.low.dot(direction).sign() < 0 else 0

    def between(self, low: Place, high: Place) -> Place:
        """A direction inside the angle from low to high, of at most a turn."""
        assert isinstance(low, Point)
        assert isinstance(high, Point)
        turn = low.cross(high).sign()
        if turn > 0:
            return low * high.norm_sq().sqrt() + high * low.norm_sq().sqrt()
        if turn == 0 and low.dot(high).sign() < 0:
            return low.left()
        return -low if turn == 0 else -(low * high.norm_sq().sqrt() + high * low.norm_sq().sqrt())

    def chord(self, place: Place) -> Segment:
        assert isinstance(place, Point)
        unit = place / place.norm_sq().sqrt()
        start, end = (
            self.center + unit * c.radius if isinstance(c, Arc) else self.center
            for c in (self.family.first, self.family.second)
        )
        return Segment(start, end)

    def part(self, low: Place, high: Place) -> NearestFamily:
        a, b = self.chord(low), self.chord(high)
        first, second = (
            (c if c.ccw else c.reversed()).part(p, q) if isinstance(c, Arc) else p
            for c, p, q in (
                (self.family.first, a.start, b.start),
                (self.family.second, a.end, b.end),
            )
        )
        return NearestFamily(NearestFamilyKind.CONCENTRIC, first, second)


_Places: TypeAlias = "_Fractions | _Directions"


def _compare_reals(a: Place, b: Place) -> int:
    assert isinstance(a, Real)
    return a.compare(b)


def _distinct(places: list[Place], compare: Callable[[Place, Place], int]) -> list[Place]:
    """Sorted, equal places once."""
    places = sorted(places, key=cmp_to_key(compare))
    return [p for k, p in enumerate(places) if k == 0 or compare(places[k - 1], p) != 0]
