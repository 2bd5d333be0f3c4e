"""What views along the lines of a family show of an edge, at most, and from where, at most and at least."""

from __future__ import annotations

from math import inf, sqrt
from typing import Final, final

from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.family_images import CONTACT, ByEdge, EdgePlace, EdgePlaces, FamilyImage
from exactacq.kernel.images import ROLLING, SLIDING

SURE: Final = 1e-9
"""Relative margin of distances: of ten roundings at most, 2^-49 in all, in one and in its comparison."""

Span = tuple[float, float]
"""Bounds of a parameter, or of an interval of parameters, in extended numbers."""
NOTHING: Span = (inf, -inf)
EVERYTHING: Span = (-inf, inf)


@final
class Extent:
    """What is shown of edge ``edge`` at most, from where it is seen at most, and from where surely.

    It comes from ``origin``, by the views from its part ``here`` to its part ``there``. The keys tell which
    lines bound where it surely is seen from: equal keys, one place. From all of its source together ``told``
    is surely shown. Unless it ``is_known``, floats tell nothing of it.
    """

    def __init__(
        self,
        edge: int,
        shown: Span,
        source: Span,
        surely: Span,
        first_keys: list[int],
        last_keys: list[int],
        origin: object,
        here: int,
        there: int,
        is_known: bool,
        told: Span = NOTHING,
    ) -> None:
        self.edge = edge
        self.shown, self.source, self.surely = shown, source, surely
        self.first_keys, self.last_keys = first_keys, last_keys
        self.origin, self.here, self.there = origin, here, there
        self.is_known, self.told = is_known, told


def unknown(edge: int, origin: object, here: int, there: int) -> Extent:
    """That of a family of which floats tell nothing."""
    return Extent(edge, EVERYTHING, EVERYTHING, NOTHING, [], [], origin, here, there, False)


def extents_from(
    edge: int, groups: list[ByEdge], curves: list[CurveImage], reach: tuple[float, float]
) -> list[Extent]:
    """What the families of an edge, in some groups, show from it of others, unless all is out of range.

    *reach* bounds the radius of vision from below and above. A side that stays at a corner is left out.
    """
    found: list[Extent] = []
    families: list[FamilyImage] = []
    for group in groups:
        some = group.get(edge)
        if some is not None:
            families += some
    for family in families:
        for here in range(-1, 2):
            if family.edge(here) != edge or (here == CONTACT and family.fixed):
                continue
            for there in range(-1, 2):
                shown = family.edge(there)
                if there == here or shown < 0:
                    continue
                if not family.is_known:
                    found.append(unknown(shown, family, here, there))
                    continue
                near, far = family.places(here), family.places(there)
                slack = bent(family, here, near, curves) + bent(family, there, far, curves)
                # A line may meet an arc twice: there its key does not name one place.
                keys = ([], []) if curves[edge].sense else (family.first_keys, family.last_keys)
                one = extent(shown, near, far, slack, keys, reach, family, here, there)
                if one is not None:
                    found.append(one)
    return found


def extent(
    edge: int,
    source: EdgePlaces,
    shown: EdgePlaces,
    slack: float,
    keys: tuple[list[int], list[int]],
    reach: tuple[float, float],
    origin: object,
    here: int,
    there: int,
) -> Extent | None:
    """What is shown of an edge, and from where, by the two extreme views; None if nothing is within range.

    *slack* is how far sides may leave the boxes of their extreme points, *keys* are those of the first and
    of the last line.
    """
    (a, b), (c, d) = source, shown
    longest = max(_apart(a, c), _apart(a, d), _apart(b, c), _apart(b, d))
    is_in_range = (longest + slack) * (1.0 + SURE) < reach[0]
    if not is_in_range:
        x = _gap(a[2], b[2], c[2], d[2])
        y = _gap(a[3], b[3], c[3], d[3])
        if sqrt(x * x + y * y) - slack > reach[1] * (1.0 + SURE):
            return None
    seen, outer = _hull(c, d), _hull(a, b)
    if not is_in_range:
        return Extent(edge, seen, outer, NOTHING, [], [], origin, here, there, True)
    first, last = keys
    if b[1] <= a[0] and not a[1] <= b[0]:
        first, last = last, first
    return Extent(edge, seen, outer, _inner(a, b), first, last, origin, here, there, True, _inner(c, d))


def bent(family: FamilyImage, role: int, places: EdgePlaces, curves: list[CurveImage]) -> float:
    """How far a side may leave the box of its two extreme points (no side of turning lines passes a half
    turn)."""
    one, other = places
    error = 2.0 * (one[4] + other[4])
    curve = curves[family.edge(role)]
    if (role == CONTACT and family.fixed) or not curve.sense:
        return error
    radius, kind = curve.radius * (1.0 + SURE), family.frame[0]
    if kind in (ROLLING, SLIDING):
        return error + 2.0 * radius
    chord = _apart(one, other)
    return error + min(chord * chord / (4.0 * radius) * (1.0 + SURE) * 2.0, radius)


def _apart(a: EdgePlace, b: EdgePlace) -> float:
    x, y = a[2] - b[2], a[3] - b[3]
    return sqrt(x * x + y * y)


def _gap(a: float, b: float, c: float, d: float) -> float:
    """How far two intervals are apart, each given by its ends in any order."""
    return max(min(a, b) - max(c, d), min(c, d) - max(a, b), 0.0)


def _hull(a: EdgePlace, b: EdgePlace) -> Span:
    return min(a[0], b[0]), max(a[1], b[1])


def _inner(a: EdgePlace, b: EdgePlace) -> Span:
    """What surely lies between two places."""
    if a[1] <= b[0]:
        return a[1], b[0]
    return (b[1], a[0]) if b[1] <= a[0] else NOTHING
