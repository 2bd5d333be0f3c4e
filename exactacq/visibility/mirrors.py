"""Mirrored chords: equal lengths recognised by symmetry, where comparing them would take long.

If the centres of a feature and of the two arcs that a chord ends on lie on one line, reflection in it maps
all three circles to themselves. A stationary chord's mirror image is then stationary too, so its parameter
is a root of the polynomial that belongs to the sector it falls in. If balls leave exactly one of that
polynomial's roots there, it is that root: the chord is then built as the mirror image of the one met
first, so that lengths, and coordinates along an axis, are equal term by term.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.visibility.chords import Chord
from exactacq.visibility.line_families import Sector

BITS = 256


@dataclass(slots=True)
class Mirrors:
    """The stationary chords of one feature and one pair of edges that were met so far."""

    known: list[tuple[Sector, Real, list[Real], Chord, Curve]] = field(default_factory=list)

    def chord(
        self, sector: Sector, t: Real, candidates: list[Real], chord: Chord, ends: tuple[Curve, Curve]
    ) -> Chord:
        """The chord, as the mirror image of one that was met before if it is one.

        *candidates* are all roots of the sector's polynomial, *t* one of them, *ends* the chord's edges.
        """
        axis = _axis(sector, ends)
        if axis is None:
            return chord
        center = Point(*sector.center)
        for other, root, roots, met, behind in self.known:
            image = _mirrored(sector, t, axis, other)
            if image is not None and _is_only(image, root, roots):
                p, q = (center + _reflected(point - center, axis) for point in (met.start, met.end))
                return Chord(p, q, met.length) if behind is ends[0] else Chord(q, p, met.length)
        self.known.append((sector, t, candidates, chord, ends[0]))
        return chord


def _axis(sector: Sector, ends: tuple[Curve, Curve]) -> Point | None:
    """Direction of the line through the three centres, None if there is none or more than one."""
    center = Point(*sector.center)
    offsets = [end.center - center for end in ends if isinstance(end, Arc)]
    if len(offsets) < 2 or offsets[0].cross(offsets[1]).sign() != 0:
        return None
    return next((offset for offset in offsets if offset.norm_sq().sign() > 0), None)


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
