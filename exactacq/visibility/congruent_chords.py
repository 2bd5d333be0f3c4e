"""Congruent chords: equal lengths recognised by an isometry, where comparing them would take long.

A stationary chord belongs to a figure: the centre and radius of the feature that holds it, and the circles
or lines of the two edges that it joins. An isometry that maps one figure to another maps the stationary
chords of the one to those of the other: the image's parameter is a root of the polynomial of the sector it
falls in. If balls leave exactly one of that polynomial's roots there, it is that root. The chord is then
built as the image of the one met first, so that lengths, and coordinates along an axis, are equal term by
term.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import NamedTuple

from flint import arb, fmpq

from exactacq.geometry.coordinates import Vector, cross, dot
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.points import Point
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import ball_sign, rational
from exactacq.numbers.real import Real
from exactacq.visibility.chords import Chord, chord_at
from exactacq.visibility.line_balls import LONG, line, long_frame
from exactacq.visibility.line_families import Sector

NO_AXIS: Vector = (fmpq(0), fmpq(0))
BITS = 64
"""Precision of the balls that tell which lengths are not equal."""


class _Figure(NamedTuple):
    """What determines a stationary chord: marks of the edges behind and ahead, from the feature's centre.

    A circle is marked by its centre, a line by the foot of the perpendicular. That does not tell a line
    through the feature's centre: of one its direction is the ``axis``. ``key`` is equal for figures that a
    rotation may map to each other, ``mirrored`` is the key of a mirror image.
    """

    center: Vector
    marks: tuple[Vector, Vector]
    axis: Vector
    key: tuple[object, ...]
    mirrored: tuple[object, ...]


class _Isometry(NamedTuple):
    """The map p -> target + turn (p - source) of complex numbers; it conjugates the bracket if it mirrors."""

    turn: Vector
    mirrors: bool
    source: Vector
    target: Vector

    def linear(self, vector: Vector) -> Vector:
        """The image of a vector."""
        (c, s), (x, y) = self.turn, vector
        if self.mirrors:
            y = -y
        return c * x - s * y, s * x + c * y

    def back(self, point: Point) -> Point:
        """The point whose image is *point*."""
        c, s = self.turn
        x, y = point.x - self.target[0], point.y - self.target[1]
        east, north = c * x + s * y, c * y - s * x
        return Point(east + self.source[0], (-north if self.mirrors else north) + self.source[1])


class _Stationary(NamedTuple):
    figure: _Figure
    sector: Sector
    root: Real
    roots: list[Real]
    chord: Chord


@dataclass(slots=True)
class CongruentChords:
    """The stationary chords that were met so far."""

    met: defaultdict[tuple[object, ...], list[_Stationary]] = field(default_factory=lambda: defaultdict(list))

    def chord(
        self, sector: Sector, t: Real, candidates: list[Real], ends: tuple[Curve, Curve], length: arb
    ) -> Chord:
        """The chord at a parameter, as the image of one that was met before if it is one.

        *candidates* are all roots of the sector's polynomial, *t* one of them, *ends* the chord's edges; the
        *length* is a ball around the chord's, which is wide where the line nearly touches these.
        """
        figure = _figure(sector, *ends)
        if figure is None:
            return chord_at(sector, t, *ends)
        for key, mirrors in ((figure.key, False), (figure.mirrored, True)):
            for other in self.met.get(key, ()):
                if not other.chord.length.ball(BITS).overlaps(length):
                    continue
                isometry = _isometry(figure, other.figure, mirrors)
                if isometry is not None and _is_image(sector, t, isometry, other):
                    start, end = isometry.back(other.chord.start), isometry.back(other.chord.end)
                    # A mirror turns lines round: their obstacle, on the left, comes to the right.
                    return Chord(*((end, start) if mirrors else (start, end)), other.chord.length)
        chord = chord_at(sector, t, *ends)
        self.met[figure.key].append(_Stationary(figure, sector, t, candidates, chord))
        return chord


def _figure(sector: Sector, behind: Curve, ahead: Curve) -> _Figure | None:
    """The figure of a chord; None if two lines run through the feature's centre."""
    center, axis = sector.center, NO_AXIS
    marks, kinds = [], []
    for edge in (behind, ahead):
        if isinstance(edge, Arc):
            x, y = _from(center, edge.center)
            kinds.append((True, edge.ccw, edge.radius_sq))
        else:
            along = _from((fmpq(0), fmpq(0)), edge.direction)
            off = cross(along, _from(center, edge.start)) / dot(along, along)
            x, y = -along[1] * off, along[0] * off
            kinds.append((False, False, fmpq(0)))
            if not off:
                if axis is not NO_AXIS:
                    return None
                axis = along
        marks.append((x, y))
    b, a = marks
    inner = dot(sector.base, sector.base) if sector.round else fmpq(0)
    between = dot(a, b)
    key = inner, kinds[0], dot(b, b), kinds[1], dot(a, a), between
    mirrored = inner, kinds[1], dot(a, a), kinds[0], dot(b, b), between
    return _Figure(center, (b, a), axis, key, mirrored)


def _isometry(figure: _Figure, other: _Figure, mirrors: bool) -> _Isometry | None:
    """What maps a figure to another one of equal distances; None if nothing does, or everything."""
    (b, a), (y, z) = figure.marks, other.marks
    if mirrors:
        y, z = z, y
    one, image = (b, y) if any(b) else (a, z)
    size = dot(one, one)
    if not size:
        return None
    if mirrors:
        one = one[0], -one[1]
    turn = dot(one, image) / size, cross(one, image) / size
    found = _Isometry(turn, mirrors, figure.center, other.center)
    return found if found.linear(a) == z and not cross(found.linear(figure.axis), other.axis) else None


def _is_image(sector: Sector, t: Real, isometry: _Isometry, other: _Stationary) -> bool:
    """Whether a tangent line is mapped to that of another chord: long balls exclude all other roots."""
    base, (cx, cy) = other.sector.base, sector.center
    with workprec(LONG):
        x, y, dx, dy = line(sector, t.working_ball(LONG), long_frame(sector))
        if sector.round:
            image = isometry.linear((x - cx, y - cy))
            across, along = cross(base, image), dot(base, base) + dot(base, image)
        else:
            image = isometry.linear((dx, dy))
            across, along = cross(base, image), dot(base, image)
        if not ball_sign(along):
            return False
        found = across / along
        near = [root for root in other.roots if found.overlaps(root.working_ball(LONG))]
    return len(near) == 1 and near[0] is other.root


def _from(center: Vector, point: Point) -> Vector:
    return rational(point.x) - center[0], rational(point.y) - center[1]
