"""What writers write: groups of exact curves and points, with properties.

A scene, a path, a map, a view and links become a sheet (`exactacq.output.sheets`), and each format writes
sheets. So a format is told once, not once for each kind of result.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.geometry.curves import Curve
from exactacq.geometry.points import Point

Property = str | int | float | bool | None
"""What formats without exact numbers can say of a thing."""
TERRAIN = "terrain"
"""The kind of the terrain's border. Formats in which every loop is read as a boundary leave it out."""
NO_TERRAIN = "no terrain, which would be read as a wall"
"""What a writer that leaves it out says."""


@dataclass(frozen=True, slots=True)
class Item:
    """One thing on a sheet: a chain of curves, or a single ``place``.

    ``layer`` says what kind of thing it is. Each curve starts where the one before ends; ``closed``: the
    chain bounds an area and ends where it begins.
    """

    layer: str
    curves: tuple[Curve, ...] = ()
    place: Point | None = None
    closed: bool = False
    properties: Mapping[str, Property] = field(default_factory=dict)

    @property
    def points(self) -> tuple[Point, ...]:
        """Where the curves start, and the end of an open chain; or the place."""
        if self.place is not None:
            return (self.place,)
        starts = tuple(curve.start for curve in self.curves)
        return starts if self.closed else (*starts, self.curves[-1].end)


@dataclass(frozen=True, slots=True)
class Sheet:
    """Things to be written to one file, and the exact JSON form of what they are if it has one."""

    title: str
    items: tuple[Item, ...]
    document: Callable[[], str] | None = None

    @property
    def layers(self) -> tuple[str, ...]:
        """The kinds of things, in the order in which they come first."""
        return tuple(dict.fromkeys(item.layer for item in self.items))

    def only(self, layers: Collection[str]) -> Sheet:
        """The sheet with some kinds of things; `FormatError` for one that it does not have."""
        if unknown := [layer for layer in layers if layer not in self.layers]:
            raise FormatError(f"nothing is of the kind {unknown[0]!r}; there are {', '.join(self.layers)}")
        return self._with(layers)

    def without(self, layer: str) -> Sheet:
        """The sheet without one kind of things."""
        return self._with([other for other in self.layers if other != layer])

    def _with(self, layers: Collection[str]) -> Sheet:
        items = tuple(item for item in self.items if item.layer in layers)
        return replace(self, items=items, document=None)


@dataclass(frozen=True, slots=True)
class Written:
    """A file's content, and an upper bound of how far any point lies from where it exactly is.

    ``notes`` say what else the format does not hold.
    """

    data: bytes
    moved: fmpq = field(default_factory=lambda: fmpq(0))
    notes: tuple[str, ...] = ()
