"""Mirrored chords: equal lengths recognised by symmetry, where comparing them would take long.

A reflection in the line through the centres of the two arcs that a chord ends on maps both circles to
themselves. If it maps one feature to another, or to itself, the mirror image of a stationary chord of the
one is a stationary chord of the other: its parameter is a root of the polynomial that belongs to the sector
it falls in. If balls leave exactly one of that polynomial's roots there, it is that root. The chord is then
built as the mirror image of the one met first, so that lengths, and coordinates along an axis, are equal
term by term.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.visibility.chords import Chord
from exactacq.visibility.line_families import Sector

BITS = 256


@dataclass(slots=True)
class Mirrors:
    """The stationary chords between two circles that were met so far."""

    known: list[tuple[Sector, Real, list[Real], Chord]] = field(default_factory=list)

    def chord(
        self, sector: Sector, t: Real, candidates: list[Real], chord: Chord, ends: tuple[Curve, Curve]
    ) -> Chord:
        """The chord, as the mirror image of one that was met before if it is one.

        *candidates* are all roots of the sector's polynomial, *t* one of them, *ends* the chord's edges.
        """
        behind, ahead = ends
        if not (isinstance(behind, Arc) and isinstance(ahead, Arc)):
            return chord
        for other, root, roots, met in self.known:
            for axis in _axes(sector, other, behind.center, ahead.center):
                image = _mirrored(sector, t, axis, other)
                if image is not None and _is_only(image, root, roots):
                    center = behind.center
                    p, q = (center + _reflected(point - center, axis) for point in (met.start, met.end))
                    # A mirror turns lines round: their obstacle, on the left, comes to the right.
                    return Chord(q, p, met.length)
        self.known.append((sector, t, candidates, chord))
        return chord


def _axes(sector: Sector, other: Sector, one: Point, two: Point) -> Iterator[Point]:
    """The directions of lines through two centres in which features of two sectors are mirror images.

    A feature is a corner or a circle. Through one common centre there is one line for each two corners that
    are equally far from it.
    """
    if sector.round != other.round:
        return
    if sector.round and Point(*sector.base).norm_sq() != Point(*other.base).norm_sq():
        return
    here, there = Point(*sector.center) - one, Point(*other.center) - one
    if one != two:
        if _reflected(here, two - one) == there:
            yield two - one
    elif here.norm_sq() == there.norm_sq() and here.norm_sq().sign():
        axis = here + there
        yield axis if axis.norm_sq().sign() else here.left()


def _mirrored(sector: Sector, t: Real, axis: Point, other: Sector) -> Real | None:
    """The parameter, in the other sector, of a tangent line's mirror image; None if it has none there."""
    contact, direction = sector.touch(t)
    vector = contact - Point(*sector.center) if sector.round else direction
    image = _reflected(vector, axis)
    base = Point(*other.base)
    if not sector.round:
        below = base.dot(image)
        return base.cross(image) / below if _is_apart(below) else None
    below = base.norm_sq() + base.dot(image)
    return base.cross(image) / below if _is_apart(below) else None


def _reflected(vector: Point, axis: Point) -> Point:
    return axis * (2 * vector.dot(axis) / axis.norm_sq()) - vector


def _is_only(image: Real, root: Real, roots: list[Real]) -> bool:
    """Whether balls exclude that a root's image is any of the roots but one."""
    near = [r for r in roots if not _is_apart(image - r)]
    return len(near) == 1 and near[0] is root


def _is_apart(value: Real) -> bool:
    return bool(abs(value.ball(BITS)) > 0)
