"""Where a line family is divided by the ends of a straight way: at its lines through them.

Each part then crosses the way in all its lines or in none.
"""

from __future__ import annotations

from operator import itemgetter
from typing import TypeAlias

from exactacq.geometry.constructions import Carrier
from exactacq.geometry.coordinates import dot
from exactacq.geometry.late import Pin
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.sensing.line_family import LineFamily
from exactacq.sensing.line_views import lines_through
from exactacq.sensing.straight_way import StraightWay
from exactacq.visibility.line_families import Rolling, Sector, Spokes
from exactacq.visibility.line_names import Names

Cut: TypeAlias = "tuple[Real, Pin | None, Names]"
"""A parameter where a line family is cut, the point of the way there, and the names of the line."""


class WayCuts:
    """Cuts line families at the ends of one way."""

    def __init__(self, way: StraightWay) -> None:
        self.way = way
        self._through: dict[Sector, list[tuple[Pin, list[Real]]]] = {}

    def of(self, line_family: LineFamily) -> list[Cut]:
        """The ends of a family and, between them, the lines through the way's ends: parameters in order."""
        lines: list[tuple[Real, Pin, Names]] = []
        ends = self._through_ends(line_family.sector)
        # All normals of an arc pass its centre. If one end of the way is there, the line through the other
        # one is the way's own, and its neighbours cross the way in the centre.
        centers = [pin for pin, _ in ends if _is_center(line_family.sector, pin[0])]
        if centers:
            ends = [(centers[0], through) for _, through in ends]
        for pin, through in ends:
            for t in through:
                same = next((k for k, (known, *_) in enumerate(lines) if known.overlaps(t)), None)
                if same is None:
                    lines.append((t, pin, ()))
                elif line_family.anchor in self.way.touches or self._is_own(
                    line_family.sector, t, lines[same][0]
                ):
                    contact, direction = line_family.sector.touch(t)
                    names = self.way.own_names(direction)
                    lines[same] = t, self._pin_of_own(line_family, contact), names
                else:
                    lines.append((t, pin, ()))
        low, high = (
            (t, self.pin_at(line_family, t, names), names)
            for t, names in zip((line_family.low, line_family.high), line_family.names, strict=True)
        )
        inner = [line for line in lines if self._is_inside(line_family, line[0], line[1])]
        inner.sort(key=itemgetter(0))
        cuts: list[Cut] = [low]
        for cut in inner:
            if cut[0].compare(cuts[-1][0]) != 0:
                cuts.append(cut)
        return [*cuts, high]

    def _through_ends(self, sector: Sector) -> list[tuple[Pin, list[Real]]]:
        """The way's ends, with the parameters of a sector's lines through them; families share sectors."""
        kept = self._through.get(sector)
        if kept is None:
            kept = self._through[sector] = [(pin, lines_through(sector, pin[0])) for pin in self.way.ends]
        return kept

    def _is_along(self, names: Names) -> bool:
        """Whether a line is known to be the way's own, as it passes two corners that the way's line passes.

        Circles do not tell: two lines touch a corner and a circle, and up to four touch two circles. From a
        place where the robot halted it may be known which one the way is.
        """
        numbers, touches = self.way.table.line_numbers, self.way.touches
        own = {numbers.least(key) for key in self.way.own_lines}
        if not own.isdisjoint(numbers.least(key) for key, _ in names):
            return True
        if len(touches) < 2:
            return False
        pairs = (numbers.features(key) for key, _ in names)
        return any(a in touches and b in touches and not numbers.is_circle(b) for a, b in pairs)

    def _is_own(self, sector: Sector, t: Real, other: Real) -> bool:
        """Whether the lines through the way's ends, which look the same, are one: the way's own line."""
        if isinstance(sector, Rolling):
            return self.way.is_tangent(Carrier(*sector.center, dot(sector.base, sector.base)))
        return isinstance(sector, Spokes) and t.compare(other) == 0

    def _is_inside(self, line_family: LineFamily, t: Real, pin: Pin) -> bool:
        """Whether a line through a point of the way lies strictly inside a line family.

        A way often ends on a line that bounds a line family. That is asked of the point: comparing parameters
        would take a root more.
        """
        bounds = (line_family.low, 1), (line_family.high, -1)
        for (bound, side), names in zip(bounds, line_family.names, strict=True):
            if t.overlaps(bound):
                if self._is_along(names):
                    return False
                contact, direction = line_family.sector.touch(bound)
                if self._is_crossed_in(pin, names) or direction.cross(pin[0] - contact).sign() == 0:
                    return False
            if t.compare(bound) != side:
                return False
        return True

    def pin_at(self, line_family: LineFamily, t: Real, names: Names) -> Pin | None:
        """The point of the way on a line that bounds a line family, where it need not be computed."""
        is_own = self._is_along(names)
        # No parameter: the end may be the point about which the lines turn.
        near = [
            pin
            for pin, through in self._through_ends(line_family.sector)
            if not through or any(t.overlaps(u) for u in through)
        ]
        if not near and not is_own:
            return None
        contact, direction = line_family.sector.touch(t)
        if is_own:
            return contact, self.way.rail.parameter(contact)
        crossed = next((pin for pin in near if self._is_crossed_in(pin, names)), None)
        if crossed is not None:
            return crossed
        on_line = [pin for pin in near if direction.cross(pin[0] - contact).sign() == 0]
        if len(on_line) == 2:
            return self._pin_of_own(line_family, contact)
        return on_line[0] if on_line else None

    def _is_crossed_in(self, pin: Pin, names: Names) -> bool:
        """Whether a line is known to cross the way at an end of it."""
        pins, number = self.way.clipper.views.pins, self.way.number
        found = (pins.get((name, number, 0)) for name, _ in names)
        return any(known is not None and known[0] is pin[0] for known in found)

    def _pin_of_own(self, line_family: LineFamily, contact: Point) -> Pin:
        """Where the lines of a line family near one that is the way's own cross the way.

        Tangents do so near their contact, normals of an arc in its centre.
        """
        if isinstance(line_family.sector, Rolling) and line_family.anchor in self.way.touches:
            return self.way.foot_on(line_family.anchor)
        place = Point(*line_family.sector.center) if isinstance(line_family.sector, Spokes) else contact
        return place, self.way.rail.parameter(place)


def _is_center(sector: Sector, point: Point) -> bool:
    """Whether a point is the centre of the arc to which a sector's lines are normal."""
    return isinstance(sector, Spokes) and point == Point(*sector.center)
