"""CSV tables: a row for each curve or point, with its layer, numbers of item and piece, and properties.

``turn`` is 1 for a counterclockwise arc and -1 for a clockwise one; its centre and radius stand beside it. A
point has the columns of a start only.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator

from flint import fmpq

from exactacq.files.writing.decimals import Precision, text
from exactacq.files.writing.sheet import Item, Sheet, Written
from exactacq.geometry.curves import Arc
from exactacq.numbers.real import Real

PLACES = ("start_x", "start_y", "end_x", "end_y", "center_x", "center_y", "radius", "turn")
COLUMNS = ("layer", "item", "piece", "shape", *PLACES)


def written(sheet: Sheet) -> Written:
    """The sheet as a table in UTF-8, rows end as RFC 4180 says. Linear in the curves."""
    writer = _CsvWriter(Precision.of(sheet))
    keys = list(dict.fromkeys(key for item in sheet.items for key in item.properties))
    own = [f"item_{key}" if key in COLUMNS else key for key in keys]
    out = io.StringIO()
    table = csv.writer(out)
    table.writerow([*COLUMNS, *own])
    for number, item in enumerate(sheet.items, 1):
        told = [item.properties.get(key) for key in keys]
        for piece, (shape, places) in enumerate(writer.rows(item), 1):
            table.writerow([item.layer, number, piece, shape, *places, *told])
    return Written(out.getvalue().encode(), writer.moved)


class _CsvWriter:
    def __init__(self, precision: Precision) -> None:
        self.precision, self.moved = precision, fmpq(0)

    def rows(self, item: Item) -> Iterator[tuple[str, list[str]]]:
        """The shape and the `PLACES` of each curve, or of the point."""
        if item.place is not None:
            yield "point", [*self._numbers(item.place.x, item.place.y), *[""] * 6]
        for curve in item.curves:
            ends = self._numbers(curve.start.x, curve.start.y, curve.end.x, curve.end.y)
            if isinstance(curve, Arc):
                circle = self._numbers(curve.center.x, curve.center.y, curve.radius)
                yield "arc", [*ends, *circle, "1" if curve.ccw else "-1"]
            else:
                yield "segment", [*ends, *[""] * 4]

    def _numbers(self, *values: Real) -> list[str]:
        found = []
        for value in values:
            number, error = self.precision.rounded(value)
            self.moved = max(self.moved, 4 * error)
            found.append(text(number))
        return found
