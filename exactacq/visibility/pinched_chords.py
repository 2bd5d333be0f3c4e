"""Chords along pinched lines: which obstacles a line that grazes several features joins, and where."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.kernel.grazing_lines import MetEdge
from exactacq.kernel.line_walks import CROSSED
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.chords import Chord, meet
from exactacq.visibility.features import Feature
from exactacq.visibility.free_segment import walk_line
from exactacq.visibility.line_families import Sector
from exactacq.visibility.pinched_lines import walked
from exactacq.visibility.rotational_sweep import Passed, Pencil

Place: TypeAlias = "MetEdge | Real"
"""Where a line meets an edge: by name, or by its own parameter."""
Met = TypeVar("Met", MetEdge, Real)


@dataclass(frozen=True, slots=True)
class PinchedLine:
    """A line that touches a feature and more, and where it first meets obstacles behind and ahead of it."""

    table: EdgeTable
    sector: Sector
    t: Real
    behind: Mapping[int, Place]
    ahead: Mapping[int, Place]

    @classmethod
    def of(cls, sweep: Pencil, feature: Feature, t: Real, passed: Passed, reach: float) -> PinchedLine:
        """The line of a swept sector at a parameter, with all that it passes, as far as it is free within
        reach."""
        table, sector = sweep.table, sweep.sector
        walk = walked(table, feature, sector, t, passed, reach, sweep.edges)
        if walk is not None:
            named = [
                first_met(table, ((met.edge, met) for met in side)) for side in (walk.behind, walk.ahead)
            ]
            return cls(table, sector, t, *named)
        exact = [
            first_met(table, ((e, tau) for tau, e in side.hits))
            for side in walk_line(table, sector, t, reach)
        ]
        return cls(table, sector, t, *exact)

    def chord(self, i: int, j: int) -> Chord | None:
        """The chord from obstacle i, behind, to j, ahead; None if the line does not join them."""
        first, last = self.behind.get(i), self.ahead.get(j)
        if first is None or last is None:
            return None
        contact, direction = self.sector.touch(self.t)
        low = self._parameter(first, contact, direction, -1)
        high = self._parameter(last, contact, direction, 1)
        length = (high - low) * direction.norm_sq().sqrt()
        return Chord(contact + direction * low, contact + direction * high, length)

    def _parameter(self, place: Place, contact: Point, direction: Point, side: int) -> Real:
        if isinstance(place, Real):
            return place
        curves, vertex = self.table.curves, place.vertex
        curve = curves[place.edge]
        if vertex == CROSSED:
            return meet(contact, direction, curve, side)
        # A circle is touched at the foot of its centre.
        point = curve.center if vertex < 0 and isinstance(curve, Arc) else curves[vertex].start
        far: Real = (point - contact).dot(direction) / direction.norm_sq()
        return far


def first_met(table: EdgeTable, places: Iterable[tuple[int, Met]]) -> dict[int, Met]:
    """The first of some places, each with its edge, on each obstacle."""
    found: dict[int, Met] = {}
    for e, place in places:
        found.setdefault(table.owners[e], place)
    return found
