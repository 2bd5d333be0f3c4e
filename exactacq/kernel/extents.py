"""What views along the lines of a family show of an edge, at most, and from where, at most and at least."""

from __future__ import annotations

from math import inf, sqrt
from typing import Final, final

from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.family_images import CONTACT, ByEdge, EdgePlace, EdgePlaces, FamilyImage
from exactacq.kernel.images import ROLLING, SLIDING, SPOKES
from exactacq.kernel.view_lengths import order_of_all

SURE: Final = 1e-9
"""Relative margin of distances: of ten roundings at most, 2^-49 in all, in one and in its comparison."""

Span = tuple[float, float]
"""Bounds of a parameter, or of an interval of parameters, in extended numbers."""
NOTHING: Span = (inf, -inf)
EVERYTHING: Span = (-inf, inf)


@final
class Extent:
    """What is shown of edge ``edge`` at most, from where it is seen at most, and from where surely.

    It comes from ``origin``, by the views from its part ``here`` to its part ``there``; ``in_range`` tells
    whether all of these surely are shorter than the range. The keys tell which lines bound where it surely is
    seen from: equal keys, one place. It ``is_turned`` if the last line bounds the lower end of that. From all
    of its source together ``told`` is surely shown. Unless it ``is_known``, floats tell nothing of it.
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
        self.in_range = self.is_turned = False


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
                places = family.places(here), family.places(there)
                told = views_in_range(family, (here, there), places, curves[edge], curves, reach)
                if family.divided:
                    found += _in_parts(family, (here, there), edge, told, curves)
                    continue
                near, far = places
                keys = _keys_from(family, near, curves[edge], shown, curves)
                one = extent(shown, near, far, told, keys, family, here, there)
                if one is not None:
                    found.append(one)
    return found


def _in_parts(
    family: FamilyImage, roles: tuple[int, int], edge: int, told: int, curves: list[CurveImage]
) -> list[Extent]:
    """What a family shows from one edge of another, divided by the start of a full circle."""
    here, there = roles
    shown, found = family.edge(there), list[Extent]()
    parts = family.parts(here)
    for near in parts:
        keys = _keys_from(family, near, curves[edge], shown, curves)
        for far in family.parts(there):
            one = extent(shown, near, far, told, keys, family, here, there)
            if one is not None:
                if len(parts) > 1:
                    # From each part something of it is shown.
                    one.told = NOTHING
                found.append(one)
    return found


def by_source(extents: list[Extent]) -> list[Extent]:
    """One extent of those of a family that are seen from the same places, for what they show is in parts."""
    found: list[Extent] = []
    for one in extents:
        if found:
            last = found[-1]
            is_one = last.origin == one.origin and last.here == one.here and last.there == one.there
            if is_one and last.source == one.source:
                continue
        found.append(one)
    return found


def _keys_from(
    family: FamilyImage, source: EdgePlaces, leg: CurveImage, shown: int, curves: list[CurveImage]
) -> tuple[list[int], list[int]]:
    """Keys of the first and of the last view of an edge, by where they begin on a leg."""
    first, last = family.first_keys, family.last_keys
    if not leg.sense:
        return first, last
    one, other = source
    return _keys_on_arc(first, one, leg, shown, curves), _keys_on_arc(last, other, leg, shown, curves)


def _keys_on_arc(
    keys: list[int], place: EdgePlace, leg: CurveImage, shown: int, curves: list[CurveImage]
) -> list[int]:
    """Keys of a place of an arc, from which an edge is seen along the line with some keys."""
    # At the start of a full circle parameters jump: there is no one place to name.
    if place[0] == -inf or place[1] == inf:
        return []
    return view_keys(keys, leg, shown, curves)


def view_keys(keys: list[int], leg: CurveImage, shown: int, curves: list[CurveImage]) -> list[int]:
    """Keys of the view of an edge from a leg along a line, by keys of the line; none from or of open arcs.

    Views with equal keys begin in one place, and end in one, unless they run along a straight edge. A line
    meets a straight curve once, but a circle perhaps in two places. What is seen of a round obstacle is the
    nearer of them. From those of a round obstacle it leaves in opposite directions, away from each other: it
    shows an edge from both only if that lies on both sides, which no straight edge and no circle does. The
    inside of a circle, and an arc from its ends, may be seen in two places from one, or from two.
    """
    if _may_be_met_twice(leg) or _may_be_met_twice(curves[shown]):
        return []
    return [key * len(curves) + shown for key in keys] if leg.sense else keys


def _may_be_met_twice(curve: CurveImage) -> bool:
    """Whether a curve is neither straight nor a round obstacle."""
    return curve.sense < 0 or (curve.sense > 0 and not curve.full)


def extent(
    edge: int,
    source: EdgePlaces,
    shown: EdgePlaces,
    told: int,
    keys: tuple[list[int], list[int]],
    origin: object,
    here: int,
    there: int,
) -> Extent | None:
    """What is shown of an edge, and from where, by the two extreme views; None if nothing is within range.

    *told* is what `views_in_range` tells, *keys* are those of the first and of the last line.
    """
    a, b = source
    c, d = shown
    if told < 0:
        return None
    seen, outer = _hull(c, d), _hull(a, b)
    if told == 0:
        return Extent(edge, seen, outer, NOTHING, [], [], origin, here, there, True)
    first, last = keys
    is_turned = b[1] <= a[0] and not a[1] <= b[0]
    if is_turned:
        first, last = last, first
    one = Extent(edge, seen, outer, _inner(a, b), first, last, origin, here, there, True, _inner(c, d))
    one.in_range, one.is_turned = True, is_turned
    return one


def views_in_range(
    family: FamilyImage,
    roles: tuple[int, int],
    places: tuple[EdgePlaces, EdgePlaces],
    leg: CurveImage | None,
    curves: list[CurveImage],
    reach: tuple[float, float],
    part: Span = EVERYTHING,
) -> int:
    """1 if all views of a family from a leg are surely within range, -1 if none is, else 0.

    *roles* are those of the two sides, *places* their extreme points. The leg is None if the contact slides
    along a straight one; only views from a *part* of a straight leg count.
    """
    here, there = roles
    source, far = places
    kind = family.frame[0]
    turns = kind not in (ROLLING, SLIDING)
    shown = curves[family.edge(there)]
    one = leg.radius if leg is not None and not (family.fixed and here == CONTACT) else 0.0
    other = shown.radius if not (family.fixed and there == CONTACT) else 0.0
    told = in_range(source, far, sagitta(one, turns, source) + sagitta(other, turns, far), reach)
    if told or not (one or other or kind in (ROLLING, SPOKES)):
        return told
    return -order_of_all(family.frame, family.fraction, here, there, leg, shown, reach, part)


def in_range(source: EdgePlaces, shown: EdgePlaces, slack: float, reach: tuple[float, float]) -> int:
    """1 if all views between two sides are surely within range, -1 if none is, else 0.

    The sides are told by their extreme points. A view from one hull of points to another is at most as long
    as the longest between these points, and at least as long as the gap of their boxes; *slack* is how far
    the sides may leave them, the errors of the points included.
    """
    a, b = source
    c, d = shown
    # Of two at a time: more are boxed where this is compiled.
    one, other = max(_apart(a, c), _apart(a, d)), max(_apart(b, c), _apart(b, d))
    if (max(one, other) + slack) * (1.0 + SURE) < reach[0]:
        return 1
    x = _gap(a[2], b[2], c[2], d[2])
    y = _gap(a[3], b[3], c[3], d[3])
    return -1 if sqrt(x * x + y * y) - slack > reach[1] * (1.0 + SURE) else 0


def sagitta(radius: float, turns: bool, places: EdgePlaces) -> float:
    """How far a side may leave the box of its two extreme points, with the errors of these.

    It lies on an arc of radius r, 0 if it is straight or a point. No side of lines of which each *turns*
    about a point passes a half turn: so its rise h over its chord c is at most r, and from c^2 / 4 = h (2 r -
    h) >= h r follows h <= c^2 / (4 r).
    """
    one, other = places
    error = 2.0 * (one[4] + other[4])
    if radius == 0.0:
        return error
    if not turns:
        return error + 2.0 * radius * (1.0 + SURE)
    chord = _apart(one, other) + error
    return error + min(chord * chord / (4.0 * radius), radius) * (1.0 + SURE)


def _apart(a: EdgePlace, b: EdgePlace) -> float:
    x, y = a[2] - b[2], a[3] - b[3]
    return sqrt(x * x + y * y)


def _gap(a: float, b: float, c: float, d: float) -> float:
    """How far two intervals are apart, each given by its ends in any order."""
    between = max(min(a, b) - max(c, d), min(c, d) - max(a, b))
    return max(between, 0.0)


def _hull(a: EdgePlace, b: EdgePlace) -> Span:
    return min(a[0], b[0]), max(a[1], b[1])


def _inner(a: EdgePlace, b: EdgePlace) -> Span:
    """What surely lies between two places."""
    if a[1] <= b[0]:
        return a[1], b[0]
    return (b[1], a[0]) if b[1] <= a[0] else NOTHING
