"""Rings of areas: of polygons with holes, of cells of a grid.

Where the start lies tells which side of the rings is free: the innermost ring around it is the wall, and what
lies directly inside that wall are the obstacles. So a start outside all areas has the areas as obstacles, one
in a hole has the hole as its room, and one inside an area has that area as its room and its holes as
obstacles. What lies behind is left out, for the robot can never see it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.counting import count
from exactacq.files.loops.chains import ZERO, root_above, scientific_above
from exactacq.files.loops.contents import Contents
from exactacq.files.source import check_edges
from exactacq.numbers.atoms import rational_sqrt
from exactacq.numbers.rationals import rational
from exactacq.scene.bends import Via
from exactacq.scene.shapes import Circle, Outline, Polygon, Shape, Terrain

ROUNDING = fmpq(1, 2**50)
"""The first vertex of a ring may be written once more with other last digits, for a double that was computed:
nearer than this part of the largest coordinate, a few units in the last place, the two are one."""
Row = tuple[fmpq, fmpq, Any]
"""x, y, and what tells how the edge that follows bends: see `Outline`."""


@dataclass(slots=True)
class Areas:
    """The rings that a reader has found, and what it mended and left out on the way."""

    rings: list[Shape] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    edges: int = 0
    repeated: int = 0
    """Vertices equal to the one before."""
    flat: int = 0
    """Rings of fewer than three straight edges."""
    opened: int = 0
    """Rings whose last vertex was not the first."""
    rounded: int = 0
    """Rings whose last vertex was the first one but for rounding."""
    largest: fmpq = ZERO
    """Upper bound of the distance of such a vertex from the first one."""
    flattened: bool = False
    """Whether points had heights or measures."""
    left_out: dict[str, int] = field(default_factory=dict)
    """How often what else was left out."""

    def add(self, rows: Sequence[Row], name: str | None) -> None:
        """A ring by its vertices, of which the last one is the first again; `ROUNDING` tells how closely."""
        self.edges += len(rows)
        check_edges(self.edges)
        closed = len(rows) > 1 and rows[-1][:2] == rows[0][:2]
        kept: list[Row] = []
        for row in rows[:-1] if closed else rows:
            if kept and kept[-1][:2] == row[:2] and not kept[-1][2]:
                kept.pop()
                self.repeated += 1
            kept.append(row)
        while len(kept) > 1 and kept[-1][:2] == kept[0][:2] and not kept[-1][2]:
            kept.pop()
            self.repeated += 1
        if rounded := is_rounded(kept):
            (x, y, _), (u, v, _) = kept[0], kept.pop()
            self.rounded += 1
            self.largest = max(self.largest, root_above((x - u) ** 2 + (y - v) ** 2))
        self.opened += not (closed or rounded)
        bent = any(told for _, _, told in kept)
        if len(kept) < 3 and not bent:
            self.flat += 1
        else:
            self.rings.append(_shape(kept, bent, name))

    def leave_out(self, what: str) -> None:
        """Count something that is no area."""
        self.left_out[what] = self.left_out.get(what, 0) + 1

    def contents(
        self,
        name: str | None,
        start: tuple[fmpq, fmpq] | None,
        *,
        union: bool | None = False,
        terrain: Terrain | None = None,
        free: int | None = None,
    ) -> Contents:
        """What makes a scene around the start, or one of all outermost rings as obstacles if there is none.

        Rings that meet are refused by the scene, or merged if *union* is set; None if that is no option.
        Around a free place are an even number of rings with *free* 0, an odd one with 1; a start elsewhere is
        refused. Raises `FormatError` if there is nothing to read.
        """
        notes = [*self.notes, *self.mended()]
        if not self.rings and (self.flat or self.left_out):
            raise FormatError(f"no area to read ({'; '.join(notes)}); give polygons or closed lines")
        return Contents(
            name=name,
            loops=tuple(self.rings),
            outer="room",
            union=bool(union),
            options=() if union is None else ("union",),
            start=start,
            terrain=terrain,
            notes=tuple(notes),
            free=free,
        )

    def mended(self) -> list[str]:
        notes = []
        if self.repeated:
            notes.append(f"took out {count(self.repeated, 'vertex', 'vertices')} equal to the one before")
        if self.flat:
            notes.append(f"left out {count(self.flat, 'ring')} without area")
        if self.opened:
            notes.append(f"closed {count(self.opened, 'ring')} whose last vertex was not the first")
        if self.rounded:
            notes.append(
                f"left out the last vertex of {count(self.rounded, 'ring')}, the first one but for rounding: "
                f"at most {scientific_above(self.largest)} from it"
            )
        if self.flattened:
            notes.append("left out the heights and measures of points")
        if self.left_out:
            notes.append("left out " + ", ".join(count(n, what) for what, n in self.left_out.items()))
        return notes


def is_rounded(rows: Sequence[Row]) -> bool:
    """Whether the last vertex is another one than the first only by rounding, with straight edges beside it.

    Their numbers are then such as programs write, which compute with doubles: exact ones are taken as told.
    """
    if len(rows) < 4 or rows[-1][2] or rows[-2][2]:
        return False
    (x, y, _), (u, v, _) = rows[0], rows[-1]
    near = ROUNDING * max(max(abs(row[0]), abs(row[1])) for row in rows)
    return bool(max(abs(x - u), abs(y - v)) <= near) and all(map(_is_double, (x, y, u, v)))


def _is_double(value: fmpq) -> bool:
    """Whether a number is a double, or a decimal that is written for one."""
    try:
        double = float(value)
    except OverflowError:
        return False
    return value in (rational(double), rational(repr(double)), rational(f"{double:.17g}"))


def _shape(rows: list[Row], bent: bool, name: str | None) -> Shape:
    """A polygon, an outline, or a circle if the ring is one full circle of rational radius."""
    if not bent:
        return Polygon([row[:2] for row in rows], name)
    if len(rows) == 1 and isinstance(told := rows[0][2], Via):
        (x, y, _), (u, v) = rows[0], told.point
        radius = rational_sqrt((x - u) ** 2 + (y - v) ** 2)
        if radius:
            return Circle(((x + u) / 2, (y + v) / 2), radius / 2, name)
    return Outline(rows, name)
