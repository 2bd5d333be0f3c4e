"""Walls that are drawn as lines: every edge of open chains becomes a body around it, every vertex a disc.

What lies within half the thickness h of a segment is a rectangle along it and the discs of its ends; for an
arc of radius R it is the part of a ring between the radii R - h and R + h, or a sector of a disc if R <= h.
The union of these is what lies within h of the chain: round at joints and ends. Discs are exact. A body has
rational corners, for which the unit vectors across the edge are rational ones near the true ones: if these
are off by an angle e, no corner is off by more than h e. With `exactacq.files.loops.chains` no point of an
outline is then off by more than 2 W(b) h e, besides the shifts that the chain has already.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from flint import fmpq

from exactacq.errors import FormatError, shown
from exactacq.files.loops.chains import ZERO, Chain, Corner
from exactacq.files.loops.rational_arcs import simplest_between
from exactacq.numbers.atoms import rational_sqrt
from exactacq.numbers.real import Real
from exactacq.scene.shapes import Circle, Outline, Polygon, Shape

Pair = tuple[fmpq, fmpq]
BITS = 50
"""Tangents of half angles are rounded by 2^-BITS at most; what they bring is short and not seen."""
ROUND = fmpq(1, 2**40)
"""A ring is made a sector if its inner radius is below this fraction of h, which moves it by less."""


@dataclass(slots=True)
class ThickChains:
    """The bodies and discs around chains, which overlap, and how far any outline is off at most."""

    shapes: list[Shape] = field(default_factory=list)
    off: fmpq = ZERO


def thicken(chains: Iterable[Chain], thickness: fmpq) -> ThickChains:
    """Shapes whose union holds what is within half of *thickness* > 0 of the edges of open chains.

    Raises `FormatError` for a thickness that is not positive. Edges of no length add a disc. Linear.

    >>> wall = Chain("wall", [Corner(fmpq(x), fmpq(0), fmpq(0)) for x in (0, 4)])
    >>> thick = thicken([wall], fmpq(2))
    >>> [len(thick.shapes), thick.off, *thick.shapes[0].vertices[0][:2]]
    [3, 0, 0, 1]
    """
    if thickness <= 0:
        raise FormatError(f"thicken: a length above 0 is needed, not {shown(thickness)}")
    half, thick = thickness / 2, ThickChains()
    known: set[Pair] = set()
    for chain in chains:
        for start, end in zip(chain.corners, chain.corners[1:], strict=False):
            if (start.x, start.y) != (end.x, end.y):
                thick.shapes.append(_body(start, end, half, chain.label, thick))
        for corner in chain.corners:
            if (corner.x, corner.y) not in known:
                known.add((corner.x, corner.y))
                thick.shapes.append(Circle((corner.x, corner.y), half, chain.label))
                thick.off = max(thick.off, corner.shift)
    return thick


def _body(start: Corner, end: Corner, half: fmpq, label: str, thick: ThickChains) -> Shape:
    p, q, b = (start.x, start.y), (end.x, end.y), start.bulge
    here = Corner(*p, b, start.shift, start.bulge_shift)
    already = Chain("", [here, Corner(*q, ZERO, end.shift)], closed=True).moved()
    chord = q[0] - p[0], q[1] - p[1]
    if not b:
        along, angle = unit_near(chord)
        across = (-along[1] * half, along[0] * half)
        thick.off = max(thick.off, already + half * angle)
        return Polygon(
            [_moved(p, across), _moved(p, across, -1), _moved(q, across, -1), _moved(q, across)], label
        )
    square = b * b
    side = (1 - square) / (4 * b)
    center = p[0] + chord[0] / 2 - chord[1] * side, p[1] + chord[1] / 2 + chord[0] * side
    spoke = p[0] - center[0], p[1] - center[1]
    out, angle = unit_near(spoke)
    cosine, sine = (1 - square) / (1 + square), 2 * b / (1 + square)
    cosine, sine = cosine * cosine - sine * sine, 2 * sine * cosine
    first = out[0] * half, out[1] * half
    last = first[0] * cosine - first[1] * sine, first[0] * sine + first[1] * cosine
    wide = max(fmpq(1), (1 + square) / (2 * abs(b)) if square > 1 else fmpq(1))
    thick.off = max(thick.off, already + 2 * wide * half * angle + half * ROUND)
    ahead = [(*_moved(p, first), b), (*_moved(q, last), ZERO)]
    inner = half * (1 + ROUND)
    if spoke[0] ** 2 + spoke[1] ** 2 <= inner * inner:
        return Outline([*ahead, (*center, ZERO)], label)
    return Outline([*ahead, (*_moved(q, last, -1), -b), (*_moved(p, first, -1), ZERO)], label)


def _moved(point: Pair, vector: Pair, sign: int = 1) -> Pair:
    return point[0] + sign * vector[0], point[1] + sign * vector[1]


def unit_near(vector: Pair) -> tuple[Pair, fmpq]:
    """A rational unit vector near the direction of a vector that is not 0, and a bound of their angle.

    With t near the tangent of half its angle it is ((1 - t^2) / (1 + t^2), 2 t / (1 + t^2)), off by less than
    2 |t - t'|. Exact if the vector's length is rational.
    """
    x, y = abs(vector[0]), abs(vector[1])
    length = rational_sqrt(x * x + y * y)
    angle = ZERO
    if length is not None:
        unit = x / length, y / length
    else:
        ratio = min(x, y) / max(x, y)
        root = Real(1 + ratio * ratio).sqrt().enclosure(2 * BITS)
        low, high = sorted(ratio / (1 + end) for end in root)
        slack = low / 2**BITS
        t = simplest_between(low - slack, high + slack)
        angle = 2 * max(high - t, t - low)
        near, far = 2 * t / (1 + t * t), (1 - t * t) / (1 + t * t)
        unit = (far, near) if x > y else (near, far)
    return (unit[0] if vector[0] >= 0 else -unit[0], unit[1] if vector[1] >= 0 else -unit[1]), angle
