"""Single lines in floats: what they show of edges from others, and from straight ways that they cross.

Those at one edge are kept with its line families.
"""

from __future__ import annotations

from math import inf
from typing import final

from exactacq.kernel.bounded import UNIT, WIDEN, length, product, quotient, total
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import EVERYTHING, NOTHING, Extent, Span, extents_from, view_keys
from exactacq.kernel.family_images import FamilyImage, by_edge
from exactacq.kernel.lines import Line, line_along, meets_straight, side_of
from exactacq.kernel.ways import WayImage

Spot = tuple[float, float, float]
"""A point, its coordinates held with one bound."""


@final
class SingleImage:
    """A line from a place to a run of edge ``shown``: one point of it, or all of it as seen along a segment.

    The place lies on edge ``edge``, or in free space (`NONE`). ``source`` and ``seen`` bound parameters of
    the place and of the run, ``near`` is the nearest point of the run; ``keys`` are numbers of the line (see
    `line_keys`). Of its ``origin``, which makes it exact, it is the line with some ``numbers``. Unless it
    ``is_whole``, another one leads to the same run from farther away.
    """

    def __init__(
        self,
        edges: tuple[int, int],
        spans: tuple[Span, Span],
        place: Spot,
        near: Spot,
        run: CurveImage | None,
        keys: list[int],
        origin: object,
        numbers: tuple[int, int, int],
    ) -> None:
        """*run* is the segment that is shown, None if one point is."""
        self.edge, self.shown = edges
        self.source, self.seen = spans
        self.line = _line_through(place, near) if run is None else line_along(run)
        self.place, self.near = place, near
        self.is_point, self.keys = run is None, keys
        self.origin, self.numbers = origin, numbers
        self.is_whole = True

    def side(self, x: float, y: float, error: float) -> int:
        """1 or -1 if a place is certainly left or right of the line, else 0."""
        return side_of(self.line, x, y, error, 0.0)

    def is_shorter_than(self, least: float, place: Spot) -> bool:
        """Whether the view from a place of the line is certainly shorter than that, to all of the run."""
        if self.is_point:
            return _is_nearer(place, self.near, least)
        x, y, dx, dy, p, q = self.line
        start: Spot = x, y, p
        dx, p = total(x, p, dx, q)
        dy, q = total(y, p, dy, q)
        stop: Spot = dx, dy, max(p, q)
        return _is_nearer(place, start, least) and _is_nearer(place, stop, least)

    @property
    def shows_edge(self) -> bool:
        """Whether all of an edge is shown, from wherever the line is in range."""
        return not self.is_point and self.seen == EVERYTHING

    def extent(self, leg: CurveImage, curves: list[CurveImage], is_back: bool) -> Extent:
        """What is shown at most, and from where on a *leg*: of the run, or of the place if that *is_back*.

        A view of more than a point has no keys.
        """
        edge, seen, source = self.shown, self.seen, self.source
        if is_back:
            edge, seen, source = self.edge, source, seen
        keys = view_keys(self.keys, leg, edge, curves) if self.is_point else []
        return Extent(edge, seen, source, NOTHING, keys, keys, self, int(is_back), int(not is_back), True)


def _is_nearer(one: Spot, other: Spot, least: float) -> bool:
    """Whether two places certainly are nearer to each other than that."""
    x, p = total(other[0], other[2], -one[0], one[2])
    y, q = total(other[1], other[2], -one[1], one[2])
    size, bound = length(x, y, max(p, q))
    return size + bound * WIDEN < least * (1.0 - UNIT)


def _line_through(place: Spot, near: Spot) -> Line:
    """The line from a place to another."""
    x, p = total(near[0], near[2], -place[0], place[2])
    y, q = total(near[1], near[2], -place[1], place[2])
    return place[0], place[1], x, y, place[2], max(p, q)


def place_beyond(near: Spot, segment: CurveImage, sense: int, reach: tuple[float, float]) -> Spot:
    """The place as far away as the range from an end of a segment, on its line; *sense* is -1 at its start.

    *reach* bounds the radius of vision from below and above.
    """
    below, above = reach
    _, _, dx, dy, _, error = line_along(segment)
    size, bound = length(dx, dy, error)
    far, bound = quotient(sense * (below + above) / 2.0, above - below, size, bound)
    x, p = product(dx, error, far, bound)
    y, q = product(dy, error, far, bound)
    x, p = total(near[0], near[2], x, p)
    y, q = total(near[1], near[2], y, q)
    return x, y, max(p, q)


LinesByEdge = dict[int, list[SingleImage]]
"""Single lines from edge to edge, by where they begin and by what they show."""


def lines_by_edge(lines: list[SingleImage]) -> LinesByEdge:
    """Those of some single lines that begin on edges, by their edges."""
    found: LinesByEdge = {}
    for one in lines:
        if one.edge >= 0:
            _note(found, one.edge, one)
            if one.shown != one.edge:
                _note(found, one.shown, one)
    return found


def _note(found: LinesByEdge, edge: int, line: SingleImage) -> None:
    some = found.get(edge)
    if some is None:
        found[edge] = [line]
    else:
        some.append(line)


def extents_of_lines(
    edge: int, groups: list[LinesByEdge], curves: list[CurveImage], least: float
) -> list[Extent]:
    """What single lines, in some groups, show of others from an edge; *least* bounds the range from below."""
    found: list[Extent] = []
    leg = curves[edge]
    for group in groups:
        some = group.get(edge)
        if some is None:
            continue
        for one in some:
            is_near = one.is_shorter_than(least, one.place)
            if one.edge == edge:
                found.append(one.extent(leg, curves, False))
                found[-1].in_range = is_near
                if is_near and one.shows_edge:
                    found[-1].told = EVERYTHING
            if one.shown == edge:
                back = one.extent(leg, curves, True)
                back.in_range = is_near
                if is_near and one.shows_edge:
                    back.surely = EVERYTHING
                found.append(back)
    return found


def extents_of_crossing_lines(
    groups: list[list[SingleImage]],
    wanted: set[int],
    way: WayImage,
    curves: list[CurveImage],
    least: float,
) -> list[Extent]:
    """What lines that may cross a way between their two points show of *wanted* edges from it.

    Others leave the whole way on one side, or have both their points on one side of it. *least* bounds the
    range from below.
    """
    ax, ay, bx, by, error = way.ends
    across = line_along(way.line)
    found: list[Extent] = []
    for group in groups:
        for one in group:
            if one.shown not in wanted:
                continue
            side, other = one.side(ax, ay, error), one.side(bx, by, error)
            if side and side == other:
                continue
            px, py, p = one.place
            qx, qy, q = one.near
            there, beyond = side_of(across, px, py, p, 0.0), side_of(across, qx, qy, q, 0.0)
            if there and there == beyond:
                continue
            extent = one.extent(way.line, curves, False)
            is_crossed = side != 0 and other != 0 and there != 0 and beyond != 0
            _, _, u, bound, x, y, e = meets_straight(one.line, way.line)
            end = way.end_of([], one.keys)
            if end:
                extent.source = end, end
            elif bound < inf:
                extent.source = u - bound, u + bound
                spot: Spot = x, y, e
                if is_crossed and one.shows_edge and one.is_shorter_than(least, spot):
                    extent.told = EVERYTHING
            else:
                extent.source = EVERYTHING
            found.append(extent)
    return found


@final
class EdgeFamilies:
    """The line families of one edge of the scene and the single lines, as float images.

    By edges, ``at`` has the families that meet or touch them, and ``lines_at`` the single lines from edge to
    edge that begin there or show them. ``whole_lines`` are those that straight ways look at.
    """

    def __init__(self, images: list[FamilyImage], single_lines: list[SingleImage]) -> None:
        self.images, self.single_lines = images, single_lines
        self.at, self.lines_at = by_edge(images), lines_by_edge(single_lines)
        self.whole_lines = [one for one in single_lines if one.is_whole]


def shown_from(
    edge: int, near: list[EdgeFamilies], curves: list[CurveImage], reach: tuple[float, float]
) -> list[Extent]:
    """What families show of others from an edge, and single lines that meet it; see `extents_from`."""
    found = extents_from(edge, [one.at for one in near], curves, reach)
    return found + extents_of_lines(edge, [one.lines_at for one in near], curves, reach[0])
