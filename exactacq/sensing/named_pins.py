"""Points that families of views share, by name: made once, so that nobody has to compare them."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import TypeAlias

from exactacq.geometry.late import Pin
from exactacq.kernel.line_keys import LineNumbers
from exactacq.numbers.real import Real
from exactacq.recent import Recent

PINS_KEPT = 10_000
"""Points of named lines that are remembered at most: those of a wide neighbourhood."""

PinName: TypeAlias = "tuple[int, int, int]"
"""The number of a line, an edge, and where on the line it is met."""
RimName: TypeAlias = "tuple[Hashable, Hashable, int]"
"""The keys of a centre and of a squared distance, and an edge."""


class NamedPins:
    """Points in which named lines, and circles about named places, meet edges.

    *numbers* tell which numbers one line has. What a way adds to its *base* is its own. Those that were made
    or asked for last are kept, `PINS_KEPT` at most: a point that was forgotten and is made again is
    recognised by its numbers.
    """

    __slots__ = ("_base", "_numbers", "_own", "_rims")

    def __init__(self, numbers: LineNumbers, base: NamedPins | None = None) -> None:
        self._own = Recent[PinName, Pin](PINS_KEPT)
        self._rims = Recent[RimName, list[Pin]](PINS_KEPT)
        self._numbers, self._base = numbers, base

    def get(self, name: PinName) -> Pin | None:
        """The point of a name."""
        pin = self._own.get(self._in_one_form(name))
        return pin if pin is not None or self._base is None else self._base.get(name)

    def put(self, name: PinName, pin: Pin) -> None:
        """Give a point a name."""
        self._own.put(self._in_one_form(name), pin)

    def _in_one_form(self, name: PinName) -> PinName:
        """The name by the least number of the line, if it does not matter in which sense that is taken."""
        key, edge, side = name
        return name if side else (self._numbers.least(key), edge, side)

    def at(self, u: Real) -> dict[PinName, Pin]:
        """The points that have a number as their parameter, not counting those of the base."""
        return {name: pin for name, pin in self._own.items() if pin[1] is u}

    def rim(self, name: RimName, make: Callable[[], list[Pin]]) -> list[Pin]:
        """The points of an edge at a distance from a centre, made at the first call.

        A corner has tangents and normals along the same lines: where they reach the range, numbers alone
        would have to tell that the places are equal.
        """
        found = self._rims.get(name)
        if found is None:
            found = make()
            self._rims.put(name, found)
        return found
