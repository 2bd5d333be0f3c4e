"""What a reader makes of a drawing: chains of edges and circles, and what it left out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from itertools import product
from typing import Any

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.loops.chains import Chain
from exactacq.files.source import one_line
from exactacq.scene.shapes import Circle

FAR = 100
"""So many times farther from the rest than the rest extends is far off,"""
FEW = 8
"""if it is at most one of so many places."""
SAMPLES = 1000
"""Of more places so many tell how far most of them extend."""


@dataclass(slots=True)
class Drawing:
    """The contents of a drawing: chains, circles (with their places in the file), other entities by name."""

    chains: list[Chain] = field(default_factory=list)
    circles: list[tuple[int, Circle]] = field(default_factory=list)
    dropped: Counter[str] = field(default_factory=Counter)
    wide: Counter[str] = field(default_factory=Counter)
    """Entities that are drawn with a width, by name, of which the middle lines are read."""
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
    has_curves: bool = False
    """Whether curves were left out that are read with ``flatten``."""

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

    A few that lie apart on one side, `FAR` times as far from all others as these extend, do not count: what
    was left at the origin of a plan in the coordinates of its country. Near n log n for n places.

    >>> main_box([(0, 0), *((90000 + k, 90000) for k in range(40))])
    ([90000, 90000], [90039, 90000])
    >>> main_box([(0, 0), (90000, 90000), *((45000 + k, 45000) for k in range(40))])
    ([0, 0], [90000, 90000])
    """
    low, high = _box(places)
    # Between its quartiles is no more than the rest extends, in most drawings far too much.
    some = places[:: len(places) // SAMPLES + 1]
    middle = [sorted(place[k] for place in some)[len(some) // 4 : -(len(some) // 4) or None] for k in (0, 1)]
    if FAR * max(values[-1] - values[0] for values in middle) >= max(high[0] - low[0], high[1] - low[1]):
        return low, high
    rest = list(places)
    most = len(places) // FEW
    while (kept := _without_far(rest, most - (len(places) - len(rest)))) is not None:
        rest = kept
    return _box(rest)


def _without_far(places: list[Sequence[Any]], most: int) -> list[Sequence[Any]] | None:
    """Without some on one side that are far from all others, *most* at most; None if there are none."""
    for axis, sense in product((0, 1), (1, -1)):
        order = sorted(places, key=lambda place: sense * place[axis])
        for k in range(1, most + 1):
            apart = sense * (order[k][axis] - order[k - 1][axis])
            # Most gaps are too narrow for what the others extend along this axis.
            if apart > FAR * sense * (order[-1][axis] - order[k][axis]):
                low, high = _box(order[k:])
                if 0 < FAR * max(high[0] - low[0], high[1] - low[1]) < apart:
                    return order[k:]
    return None


def _box(places: Sequence[Sequence[Any]]) -> tuple[list[Any], list[Any]]:
    low, high = ([end(place[k] for place in places) for k in (0, 1)] for end in (min, max))
    return low, high


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
