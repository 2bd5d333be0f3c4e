"""GeoJSON (RFC 7946): a feature for each thing; arcs become chords.

The property "layer" says what kind of thing it is. The ends of curves are exact where they are finite
decimals; chords stray as `exactacq.geometry.geo` says.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise

from flint import fmpq

from exactacq.files.writing.decimals import Precision, text
from exactacq.files.writing.sheet import Item, Sheet, Written
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.geo import FLATNESS, chords
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import rational

ROUNDOFF = 2.0**-44
"""Bound of the error of a computed point over its size and the circle's: a dozen float operations, each
within 2^-52, on angles of up to 10."""


def written(sheet: Sheet) -> Written:
    """The sheet as a FeatureCollection, a feature a line. Linear in the curves and their chords."""
    writer = _GeoWriter(Precision.of(sheet))
    rows = [writer.feature(item) for item in sheet.items]
    body = ("\n" + ",\n".join(rows) + "\n") if rows else ""
    notes = ("chords in place of arcs",) if writer.arcs else ()
    return Written(f'{{"type": "FeatureCollection", "features": [{body}]}}\n'.encode(), writer.moved, notes)


class _GeoWriter:
    def __init__(self, precision: Precision) -> None:
        self.precision, self.moved, self.arcs = precision, fmpq(0), 0

    def feature(self, item: Item) -> str:
        """One item."""
        properties = json.dumps({"layer": item.layer, **item.properties}, ensure_ascii=False)
        geometry = f'{{"type": "{self._kind(item)}", "coordinates": {self._coordinates(item)}}}'
        return f'{{"type": "Feature", "geometry": {geometry}, "properties": {properties}}}'

    @staticmethod
    def _kind(item: Item) -> str:
        return "Point" if item.place is not None else "Polygon" if item.closed else "LineString"

    def _coordinates(self, item: Item) -> str:
        if item.place is not None:
            return _position(self._point(item.place))
        places = [place for curve in item.curves for place in self._along(curve)]
        places.append(places[0] if item.closed else self._point(item.curves[-1].end))
        kept = [place for k, place in enumerate(places) if k == 0 or place != places[k - 1]]
        kept = kept if len(kept) > 1 else places[:1] * 2
        if item.closed and _doubled_area(kept) < 0:
            kept.reverse()
        listed = "[" + ", ".join(map(_position, kept)) + "]"
        return f"[{listed}]" if item.closed else listed

    def _along(self, curve: Curve) -> Iterator[tuple[fmpq, fmpq]]:
        """The start of a curve, and the inner corners of its chords.

        Those are n with n^2 >= turn^2 / (8 F m), m = min(1, turn), so the sagitta r (turn / n)^2 / 8 is at
        most F m r, the `FLATNESS` F times the radius or the length, whichever is less.
        """
        yield self._point(curve.start)
        if not isinstance(curve, Arc):
            return
        stroke = curve.stroke()
        self.arcs += 1
        count = chords(stroke)
        for k in range(1, count):
            x, y = stroke.at(k / count)
            yield rational(repr(x)), rational(repr(y))
        size = sum(map(abs, stroke.start)) + 2 * stroke.radius
        strays = FLATNESS * min(stroke.radius, stroke.length) + ROUNDOFF * size
        self.moved = max(self.moved, rational(strays * (1 + ROUNDOFF)))

    def _point(self, point: Point) -> tuple[fmpq, fmpq]:
        (x, dx), (y, dy) = self.precision.rounded(point.x), self.precision.rounded(point.y)
        self.moved = max(self.moved, dx + dy)
        return x, y


def _position(place: tuple[fmpq, fmpq]) -> str:
    return f"[{text(place[0])}, {text(place[1])}]"


def _doubled_area(ring: list[tuple[fmpq, fmpq]]) -> fmpq:
    return sum((a[0] * b[1] - a[1] * b[0] for a, b in pairwise(ring)), fmpq(0))
