"""What a reader makes of a drawing: chains of edges and circles, and what it left out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from typing import Any

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.loops.chains import Chain
from exactacq.files.source import one_line
from exactacq.scene.shapes import Circle

FAR, FEW = 100, 10
"""Far off is what is so many times farther than the size of the rest; few are less than one of so many."""
SAMPLES = 4000
"""So many places at most tell where most of them are."""


@dataclass(slots=True)
class Drawing:
    """The contents of a drawing: chains, circles (with their places in the file), other entities by name."""

    chains: list[Chain] = field(default_factory=list)
    circles: list[tuple[int, Circle]] = field(default_factory=list)
    dropped: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)
    layers: Counter[str] = field(default_factory=Counter)
    """Number of entities of each layer, in the file's spelling, selected or not."""
    chosen: tuple[str, ...] | None = None
    """The layers that are read, all if None."""
    homes: dict[int, str] = field(default_factory=dict)
    """The layers of entities by their places in the file, where the reader tells."""
    unit: str = ""
    """What the file says of its unit of length."""
    readable: str = ""
    """With which option some of what was left out is read."""

    def corners(self) -> list[tuple[fmpq, fmpq]]:
        """All vertices, and of circles the corners of their boxes (arcs may reach beyond these)."""
        corners = [(c.x, c.y) for chain in self.chains for c in chain.corners]
        for _, circle in self.circles:
            (x, y), r = circle.center, circle.radius
            corners += [(x - r, y - r), (x + r, y + r)]
        return corners

    def layer_list(self) -> str:
        """The layers with their counts of entities, the fullest first."""
        named = [f"{one_line(repr(name))} ({count})" for name, count in self.layers.most_common(12)]
        return ", ".join(named) + (" and others" if len(self.layers) > 12 else "")


def main_box(places: Sequence[Sequence[Any]]) -> tuple[list[Any], list[Any]]:
    """The lower left and the upper right corner of the box of some places, one at least.

    Where a few of them are far from all others, as things that were left at the origin are from a plan in the
    coordinates of its country, it is a box around these others: tolerances and starts go by its size.

    >>> main_box([(0, 0), *((90000 + k, 90000) for k in range(40))])
    ([89971, 89968], [90067, 90032])
    """
    low, high = ([end(place[k] for place in places) for k in (0, 1)] for end in (min, max))
    some = places[:: len(places) // SAMPLES + 1]
    ordered = [sorted(place[k] for place in some) for k in (0, 1)]
    few = len(some) // FEW
    inner = [(values[few], values[-1 - few]) for values in ordered]
    size = max(b - a for a, b in inner)
    if not 0 < size * FAR < max(b - a for a, b in zip(low, high, strict=True)):
        return low, high
    return [a - size for a, _ in inner], [b + size for _, b in inner]


def is_named(layer: str, name: str) -> bool:
    """Whether a layer has a name: in it * stands for any text and ? for any character, as "*A-WALL".

    Upper and lower case are one, as in DXF.

    >>> is_named("house$0$A-Wall", "*a-wall"), is_named("Wall [2]", "wall [2]"), is_named("Walls", "wall")
    (True, True, False)
    """
    return fnmatchcase(layer.casefold(), name.casefold().replace("[", "[[]"))


class LayerChoice:
    """The layers that are read, by names as `is_named` takes them; all if *names* is None."""

    def __init__(self, names: Iterable[str] | None) -> None:
        self.names = None if names is None else tuple(names)
        self._named: dict[str, list[str]] = {}

    def take(self, *layers: str) -> bool:
        """Whether something on these layers is read."""
        if self.names is None:
            return True
        for layer in layers:
            if layer not in self._named:
                self._named[layer] = [name for name in self.names if is_named(layer, name)]
        return any(self._named[layer] for layer in layers)

    def check(self, drawing: Drawing) -> None:
        """Tell the drawing what was read of it; `FormatError` if a layer that was asked for is not there."""
        drawing.chosen = self.names
        there = {name for names in self._named.values() for name in names}
        missing = [name for name in self.names or () if name not in there]
        if missing and drawing.layers:
            raise FormatError(f"no layer {one_line(repr(missing[0]))}; it has {drawing.layer_list()}")
