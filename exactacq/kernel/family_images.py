"""Line families in floats: their first and last lines and where these meet the family's edges, with bounds.

Parameters along an edge are bounded in extended numbers: its start, where a line is known to pass it, is
minus infinity and its end infinity, so that nothing is to be compared with them.
"""

from __future__ import annotations

from math import inf
from typing import Final, final

from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.images import ROLLING, SLIDING, EdgeImage
from exactacq.kernel.lines import Frame, Line, line_at, meets, parameter_round, side_of

BEHIND: Final = -1
CONTACT: Final = 0
AHEAD: Final = 1
NONE: Final = -1
"""No edge, or no vertex."""
ROUNDED: Final = 0.3
"""More than 1 - 1/sqrt(2): see `side_of_all`."""

EdgePlace = tuple[float, float, float, float, float]
"""Where a line meets an edge: bounds of the parameter, the point, and the error of its coordinates."""
EdgePlaces = tuple[EdgePlace, EdgePlace]
"""Where the first and the last line of a family meet an edge."""
Divided = dict[int, list[EdgePlaces]]
"""What families meet of full circles, by its role, before they pass the start and after."""
NOWHERE: EdgePlace = (0.0, 0.0, 0.0, 0.0, inf)
ANYWHERE: EdgePlace = (-inf, inf, 0.0, 0.0, inf)
"""Where floats do not tell."""
UNDIVIDED: Final[Divided] = {}


@final
class EndLine:
    """The first or the last line of a family, in floats: its parameter, held with a bound.

    ``corners`` are the vertices that it passes; its ``keys`` are numbers that are equal only for equal lines.
    Neighbouring families share it.
    """

    def __init__(self, frame: Frame, t: float, error: float, corners: list[int], keys: list[int]) -> None:
        self.t, self.error = t, error
        self.line: Line = line_at(frame, t, error)
        self.corners, self.keys = corners, keys


@final
class FamilyImage:
    """A line family: a cell of a pencil, and the edges that its lines meet behind and ahead of the contact.

    ``edges`` are those behind, at the contact and ahead, `NONE` where there is none. The contact is
    ``fixed`` if lines turn about a ``corner``, which else is `NONE`: one of its edge. Of the first and of the
    last line are known: the vertices that they pass, and their ``keys``, numbers that are equal only for
    equal lines. ``fraction`` bounds their parameters, the first one's before the last one's. Unless the image
    ``is_known`` floats cannot tell where the lines meet the edges. It belongs to cell ``number`` of what it
    comes from, its ``origin``.
    """

    def __init__(
        self,
        frame: Frame,
        ends: tuple[EndLine, EndLine],
        edges: tuple[int, int, int],
        goes_back: bool,
        corner: int,
        origin: object,
        number: int,
    ) -> None:
        """*ends* are the first and the last line."""
        self.origin, self.number = origin, number
        self.frame, self.edges = frame, edges
        self.fixed, self.goes_back, self.corner = corner >= 0, goes_back, corner
        first, last = ends
        self.low, self.high = first.t, last.t
        self.first, self.last = first.line, last.line
        self.fraction = first.t - first.error, first.t + first.error, last.t - last.error, last.t + last.error
        self.first_corners, self.last_corners = first.corners, last.corners
        self.first_keys, self.last_keys = first.keys, last.keys
        self.behind: EdgePlaces = (NOWHERE, NOWHERE)
        self.contact: EdgePlaces = (NOWHERE, NOWHERE)
        self.ahead: EdgePlaces = (NOWHERE, NOWHERE)
        self.divided: Divided = UNDIVIDED
        self.is_known = False

    def edge(self, role: int) -> int:
        """The edge behind (-1), at the contact (0) or ahead (1)."""
        return self.edges[0] if role < 0 else self.edges[2] if role > 0 else self.edges[1]

    def places(self, role: int) -> EdgePlaces:
        """Where the first and the last line meet that edge."""
        return self.behind if role < 0 else self.ahead if role > 0 else self.contact

    def move(self, role: int, places: EdgePlaces) -> None:
        """Tell where the first and the last line meet that edge."""
        if role < 0:
            self.behind = places
        elif role > 0:
            self.ahead = places
        else:
            self.contact = places

    def divide(self, role: int, before: EdgePlaces, after: EdgePlaces) -> None:
        """Tell what is met of a full circle before its start is passed, from the first line, and after."""
        self.divided = {**self.divided, role: [before, after]}

    def parts(self, role: int) -> list[EdgePlaces]:
        """What lines meet of an edge; in two parts if they are known to pass the start of a full circle."""
        return self.divided[role] if role in self.divided else [self.places(role)]

    def side(self, x: float, y: float, error: float) -> int:
        """1 or -1 if a place is certainly left or right of all lines of the family, else 0."""
        return side_of_all(self.frame, self.first, self.last, x, y, error)


def side_of_all(frame: Frame, first: Line, last: Line, x: float, y: float, error: float) -> int:
    """1 or -1 if a place is certainly left or right of all lines of a sector between two of them, else 0.

    *error* bounds that of its coordinates. The height of a place above a line, times the length of the
    direction, is linear in the parameter where the contact is fixed, slides, or lies on the spokes of
    an arc: there both ends decide. Of lines that roll on a circle of radius r it is r (w + r), with w the
    height above the parallel through the centre, a sum a w_1 + b w_2 of those at the ends with a, b >= 0
    and 1 <= a + b <= sqrt(2), as lines turn by a quarter at most. So it is negative if it is at both ends
    (w_1, w_2 < -r), and positive if at both w + r > (1 - 1/sqrt(2)) r.
    """
    least = 0.0
    if frame[0] == ROLLING:
        least = ROUNDED * (frame[3] * frame[3] + frame[4] * frame[4])
    one = side_of(first, x, y, error, least)
    return one if one and one == side_of(last, x, y, error, least) else 0


ByEdge = dict[int, list[FamilyImage]]
"""Families by the edges that their lines meet, or touch at the contact."""


def by_edge(families: list[FamilyImage]) -> ByEdge:
    """Some families by their edges."""
    found: ByEdge = {}
    for family in families:
        behind, contact, ahead = family.edges
        _note(found, contact, family)
        if behind >= 0 and behind != contact:
            _note(found, behind, family)
        if ahead >= 0 and ahead != contact and ahead != behind:
            _note(found, ahead, family)
    return found


def perhaps_over_start(families: list[FamilyImage], images: list[EdgeImage]) -> list[tuple[FamilyImage, int]]:
    """Families and their parts that may pass the start of a full circle, or touch it.

    There parameters jump. Where they stay within a quarter turn off the start, the part does not pass it.
    """
    found: list[tuple[FamilyImage, int]] = []
    for family in families:
        for role in range(-1, 2):
            edge = family.edge(role)
            if not family.is_known or edge < 0 or not images[edge].full:
                continue
            one, other = family.places(role)
            low, high = min(one[0], other[0]), max(one[1], other[1])
            if low <= 0.0 or high >= 4.0 or high - low >= 1.0:
                found.append((family, role))
    return found


def _note(found: ByEdge, edge: int, family: FamilyImage) -> None:
    some = found.get(edge)
    if some is None:
        found[edge] = [family]
    else:
        some.append(family)


def locate(
    image: FamilyImage,
    ends: tuple[EndLine, EndLine],
    before: FamilyImage | None,
    curves: list[CurveImage],
    following: list[int],
) -> None:
    """Find where the first and the last line of a family meet their edges.

    *before* is the family before this one, whose last line is its first: where that meets an edge is known.
    """
    for role in (BEHIND, CONTACT, AHEAD):
        e = image.edge(role)
        if e < 0:
            continue
        curve, after = curves[e], following[e]
        if before is not None and before.is_known and before.edge(role) == e:
            one = before.places(role)[1]
        else:
            one = _place(image, role, e, curve, after, ends[0])
        other = _place(image, role, e, curve, after, ends[1])
        if not (one[4] < inf and other[4] < inf):
            return
        image.move(role, (one, other))
    image.is_known = True


def _place(
    image: FamilyImage, role: int, edge: int, curve: CurveImage, following: int, at: EndLine
) -> EdgePlace:
    """Where a line meets an edge."""
    x, y, _, _, error, _ = at.line
    if role == CONTACT:
        if image.fixed:
            end = -inf if image.corner == edge else inf
            return end, end, x, y, error
        if image.frame[0] == SLIDING:
            end = _corner(edge, following, at.corners)
            return (end, end, x, y, error) if end else (at.t - at.error, at.t + at.error, x, y, error)
        u, ue = parameter_round(curve, x, y, error)
        return u - ue, u + ue, x, y, error
    _, fe, u, ue, x, y, error = meets(at.line, curve, role)
    if not (fe < inf and ue < inf):
        return NOWHERE
    end = 0.0 if curve.sense else _corner(edge, following, at.corners)
    return (end, end, x, y, error) if end else (u - ue, u + ue, x, y, error)


def _corner(edge: int, following: int, passed: list[int]) -> float:
    """Which end of an edge a line passes: minus infinity, infinity, or 0 if none is known."""
    for vertex in passed:
        if vertex == edge:
            return -inf
        if vertex == following:
            return inf
    return 0.0
