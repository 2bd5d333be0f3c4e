"""What a line that grazes several features shows of what it meets, and where it may show it alone.

The places on such a line are numbered from its contact on, -1, -2 and so on behind it, and 1, 2 and so on
ahead of it. Of the features on one line that which is nearest to what is seen tells of it.
"""

from __future__ import annotations

from math import inf
from typing import Final, final

from exactacq.kernel.bound_lines import Passed
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import EVERYTHING, Span
from exactacq.kernel.family_images import NONE
from exactacq.kernel.images import CONVEX, STRAIGHT, EdgeImage
from exactacq.kernel.lines import Line, rounding, side_of
from exactacq.kernel.single_lines import SingleImage, Spot

NO: Final = 0
YES: Final = 1
OPEN: Final = -1
"""Whether a line may be pinched."""


@final
class MetEdge:
    """An edge that a line meets: at which ``vertex`` (or how, if negative), in which ``place``, and where.

    ``span`` bounds the parameter there.
    """

    def __init__(self, edge: int, vertex: int, place: int, span: Span, spot: Spot) -> None:
        self.edge, self.vertex, self.place = edge, vertex, place
        self.span, self.spot = span, spot


@final
class GrazingLine:
    """A line of a feature that grazes others: what it meets, from behind its contact to ahead of it.

    The contact is among that, on edge *own*. ``ends`` are its places as far away as the range. By vertices
    *corners* tells where a feature is a corner of segments.
    """

    def __init__(
        self,
        images: list[EdgeImage],
        curves: list[CurveImage],
        corners: list[bool],
        met: list[MetEdge],
        ends: tuple[Spot, Spot],
        is_blocked: tuple[bool, bool],
        own: int,
    ) -> None:
        self._images, self._curves, self._corners = images, curves, corners
        self.met, self.ends, self.is_blocked = met, ends, is_blocked
        self.blind = self._blind(own)
        self._featured = self._featured_places()

    def _blind(self, own: int) -> set[int]:
        """The convex arcs that the line touches once between their ends: they tell who sees them along it."""
        once: set[int] = set()
        more: set[int] = {own}
        for one in self.met:
            if one.place == 0 or self._images[one.edge].kind != CONVEX:
                continue
            if one.edge in once:
                more.add(one.edge)
            once.add(one.edge)
        if self.is_blocked[0]:
            more.add(self.met[0].edge)
        if self.is_blocked[1]:
            more.add(self.met[-1].edge)
        return once - more

    def _featured_places(self) -> list[int]:
        """Places of features that tell of the line too: not the contact, nor what blocks the line."""
        left_out = {0}
        if self.is_blocked[0]:
            left_out.add(self.met[0].place)
        if self.is_blocked[1]:
            left_out.add(self.met[-1].place)
        found: list[int] = []
        for one in self.met:
            if one.place not in left_out and self._is_featured(one):
                left_out.add(one.place)
                found.append(one.place)
        return found

    def _is_featured(self, one: MetEdge) -> bool:
        """Whether an edge is met in a corner of segments, or inside an arc, that tells of it too."""
        kind = self._images[one.edge].kind
        if kind == STRAIGHT:
            return one.vertex == one.edge and self._corners[one.edge]
        return kind == CONVEX and one.vertex < 0

    def runs(self) -> list[tuple[int, int]]:
        """The first and the last place of each edge that the line meets; of an arc place by place."""
        found: list[tuple[int, int]] = []
        at: dict[int, int] = {}
        for k, one in enumerate(self.met):
            if one.edge in self.blind:
                continue
            if self._images[one.edge].kind == STRAIGHT and one.edge in at:
                n = at[one.edge]
                found[n] = found[n][0], k
            else:
                at[one.edge] = len(found)
                found.append((k, k))
        return found

    def single_lines(self, keys: list[int], origin: object) -> list[SingleImage]:
        """What the touched points and edges show of each other, and what is shown from as far as the range.

        Their numbers are those of the place and of both ends of the run; -1 and the number of what is met are
        free places.
        """
        met, shown = self.met, self.runs()
        low, high = self._gap()
        # From a place with a feature, features tell of all but what is beyond place 0 and before the next.
        inner = [(k, n) for k, n in shown if low < met[k].place < high or low < met[n].place < high]
        found: list[SingleImage] = []
        for number, here in enumerate(met):
            for first, last in inner if here.place in self._featured else shown:
                near, far = first, last
                if here.place > met[first].place:
                    near, far = last, first
                if here.edge == met[first].edge or here.place == met[near].place:
                    continue
                if not self.is_told_by_others(here.place, met[near].place):
                    one = self._from(here.edge, here.span, here.spot, number, near, far, keys, origin)
                    # A way that crosses the line sees the run past all places that lie behind it.
                    end = met[0] if here.place < met[near].place else met[-1]
                    one.is_whole = here.place == end.place or end.edge == one.shown
                    found.append(one)
        for side in (0, 1):
            if self.is_blocked[side]:
                continue
            number = len(met) if side else -1
            for first, last in shown:
                near, far = (last, first) if side else (first, last)
                found.append(self._from(NONE, EVERYTHING, self.ends[side], number, near, far, keys, origin))
        return found

    def _gap(self) -> tuple[float, float]:
        """The next places with features behind the contact and ahead of it."""
        low, high = -inf, inf
        for place in self._featured:
            if place < 0:
                low = max(low, float(place))
            else:
                high = min(high, float(place))
        return low, high

    def is_told_by_others(self, here: int, near: int) -> bool:
        """Whether a view from a place to another is told by features between them, not by that in place 0.

        The one that is nearest to what is seen tells of it.
        """
        is_between = min(here, near) <= 0 <= max(here, near)
        start = 0 if is_between else here
        low, high = min(start, near), max(start, near)
        return any(low <= place <= high for place in self._featured)

    def _from(
        self,
        edge: int,
        source: Span,
        place: Spot,
        number: int,
        near: int,
        far: int,
        keys: list[int],
        origin: object,
    ) -> SingleImage:
        """The line from a place to a run."""
        first, last = self.met[near], self.met[far]
        run = None if near == far else self._curves[first.edge]
        seen = min(first.span[0], last.span[0]), max(first.span[1], last.span[1])
        numbers = number, near, far
        return SingleImage((edge, first.edge), (source, seen), place, first.spot, run, keys, origin, numbers)


def may_be_pinched(
    images: list[EdgeImage], corners: list[bool], line: Line, own: int, is_round: bool, passed: Passed
) -> int:
    """Whether a tangent line may show, by what it passes, what no line beside it does (see `pinched_lines`).

    It touches the corner *own*, or an arc. `OPEN` where floats leave open on which side something lies. By
    vertices *corners* tells where an obstacle is convex at a corner of segments.
    """
    at = {number for number, touching, _ in passed if not touching}
    if not is_round:
        at.add(own)
        side = _touched_side(images, corners, line, own, at)
        if side >= ALONG:
            return YES if side == ALONG else OPEN
    count, is_negative = 1, False
    for number, touching, _ in passed:
        if touching:
            is_round = True
            x, y = images[number].cx, images[number].cy
            side = side_of(line, x, y, rounding(x, y), 0.0)
            if side == 0:
                return OPEN
        else:
            side = _touched_side(images, corners, line, number, at)
            if side >= ALONG:
                return YES if side == ALONG else OPEN
        if side:
            count += 1
            is_negative = is_negative or side < 0
    return YES if count > 2 and (is_round or is_negative) else NO


ALONG: Final = 2
UNSURE: Final = 3
"""A line runs along an edge at a corner; and floats do not tell how it passes. Sides are less."""


def _touched_side(images: list[EdgeImage], corners: list[bool], line: Line, vertex: int, at: set[int]) -> int:
    """1 or -1 as a line touches a corner to its left or right, 0 if it enters the obstacle there.

    It passes the vertices *at*.
    """
    first, last = images[vertex].previous, images[vertex].following
    if images[first].kind != STRAIGHT or images[vertex].kind != STRAIGHT:
        return UNSURE
    if first in at or last in at:
        return ALONG
    back = side_of(line, images[first].x, images[first].y, rounding(images[first].x, images[first].y), 0.0)
    on = side_of(line, images[last].x, images[last].y, rounding(images[last].x, images[last].y), 0.0)
    if back == 0 or on == 0:
        return UNSURE
    return on if back == on and corners[vertex] else 0
