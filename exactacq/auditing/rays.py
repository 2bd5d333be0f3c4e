"""The rays from a point that the audit looks along: the critical ones, and one of each cell between them.

A ray is a float unit vector and an exact vector, which is made only where floats leave something open.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cmp_to_key, partial
from itertools import combinations, pairwise
from math import atan2, cos, hypot, pi, sin

from flint import arb, fmpq

from exactacq.errors import Undecided
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import nearest_float, rational
from exactacq.numbers.real import Real

APART = 2.0**-44
"""Angles farther apart than this are ordered by their floats, whose error is below 2^-50. Rounding keeps the
signs of coordinates, so none leaves (-pi, pi]."""

TIE_BITS = 256
"""Numbers that differ by less are taken for candidates of a tie."""


class Direction:
    """A direction: a float unit vector within 2^-50 of it, and the exact vector, made on demand.

    ``aim`` is the number of the point that is one such vector away, if it has one. What the ray leads to is
    at least about ``far`` away.
    """

    def __init__(
        self,
        unit: tuple[float, float],
        exact: Callable[[], Point],
        aim: int | None = None,
        far: float = 0.0,
    ) -> None:
        self.unit, self.exact = unit, exact
        self.angle = atan2(unit[1], unit[0])
        self.aim, self.far = aim, far


def rounded(value: Real | fmpq) -> float:
    """The nearest float."""
    return nearest_float(value) if isinstance(value, fmpq) else float(value)


def unit_vector(x: float, y: float) -> tuple[float, float] | None:
    """A vector of length 1 in a direction, None for that of no length."""
    size = hypot(x, y)
    return (x / size, y / size) if size else None


def ray_along(vector: Point, far: float = 0.0) -> Direction:
    """The ray in a direction that is not 0."""
    unit = unit_vector(rounded(vector.x), rounded(vector.y))
    assert unit is not None
    return Direction(unit, lambda: vector, far=far)


def tangent_directions(q: Point, arc: Arc) -> list[Point]:
    """The directions from q that touch the circle: L c +- r left(c), c to its centre, L^2 = c^2 - r^2."""
    c = arc.center - q
    square = c.norm_sq() - arc.radius_sq
    side = square.sign()
    if side < 0:
        return []
    if side == 0:
        return [c.left(), -c.left()]
    along, across = c * square.sqrt(), c.left() * arc.radius
    return [along + across, along - across]


def clear_tangents(q: Point, arc: Arc, far: float) -> list[Direction] | None:
    """The rays from q that touch the circle, made exact when they are asked for; None if balls leave open
    whether there are any, or on which side of the axes they are.

    What they lead to is at least about *far* away.
    """
    c = arc.center - q
    with workprec(TIE_BITS):
        x, y, radius_sq = c.x.working_ball(TIE_BITS), c.y.working_ball(TIE_BITS), arb(arc.radius_sq)
        square = x * x + y * y - radius_sq
        if square < 0:
            return []
        if not square > 0:
            return None
        along, radius = square.sqrt(), radius_sq.sqrt()
        vectors = [(x * along - y * r, y * along + x * r) for r in (radius, -radius)]
        if any(v.contains(0) for vector in vectors for v in vector):
            return None
        offsets = [(float(u.mid()), float(v.mid())) for u, v in vectors]
    found = []
    for k, offset in enumerate(offsets):
        unit = unit_vector(*offset)
        assert unit is not None, "a tangent has a direction"
        found.append(Direction(unit, partial(_tangent_direction, q, arc, k), far=far))
    return found


def _tangent_direction(q: Point, arc: Arc, k: int) -> Point:
    """The first or the second of the directions from q that touch the circle."""
    return tangent_directions(q, arc)[k]


def surely_crosses(origin: Point, direction: Point, upto: Real, edge: Curve) -> bool:
    """Whether balls tell that a way to ``origin + upto direction`` crosses an edge, both between their ends.

    There an obstacle is on one side of the edge, so the way is blocked. False where balls leave it open.
    """
    with workprec(TIE_BITS):
        x, y, dx, dy, end = (c.working_ball(TIE_BITS) for c in (*origin, *direction, upto))
        ax, ay, bx, by = (c.working_ball(TIE_BITS) for c in (*edge.start, *edge.end))
        ax, ay, wx, wy = ax - x, ay - y, bx - ax, by - ay
        if isinstance(edge, Segment):
            first, across = dx * ay - dy * ax, dx * wy - dy * wx
            if not first * (first + across) < 0:
                return False
            t = (ax * wy - ay * wx) / across
            return bool(t > 0 and t < end)
        cx, cy = (c.working_ball(TIE_BITS) for c in edge.center)
        cx, cy, size = cx - x, cy - y, dx * dx + dy * dy
        along, height = cx * dx + cy * dy, cx * dy - cy * dx
        square = size * arb(edge.radius_sq) - height * height
        if not square > 0:
            return False
        root, outward = square.sqrt(), 1 if edge.ccw else -1
        for t in ((along - root) / size, (along + root) / size):
            # Seen from the chord, an arc is on the side away from its obstacle.
            beside = wx * (dy * t - ay) - wy * (dx * t - ax)
            if t > 0 and t < end and (edge.full or beside * outward < 0):
                return True
    return False


def with_cells(critical: Iterable[Direction]) -> list[Direction]:
    """The critical rays, counterclockwise, equal ones once, and one of each cell between two of them."""
    clusters: list[list[Direction]] = []
    for ray in sorted(critical, key=lambda ray: ray.angle):
        if clusters and ray.angle - clusters[-1][-1].angle <= APART:
            clusters[-1].append(ray)
        else:
            clusters.append([ray])
    parted = [_parted(cluster) for cluster in clusters]
    found = []
    for rays, following in zip(parted, [*parted[1:], parted[0]], strict=True):
        last, after = rays[-1], following[0]
        gap = (after.angle - last.angle) % (2 * pi) or 2 * pi
        found += [*rays, _middle(last.angle + gap / 2) if gap > APART else _halfway(last, after)]
    return found


def _parted(cluster: list[Direction]) -> list[Direction]:
    """Rays that floats cannot tell apart, in exact order, equal ones once, and one between two.

    Where their order is undecided, all of them and one between each pair: more rays than are needed change
    nothing, and whatever the order is there is one in each cell. The first and the last stay what they are.
    """
    if len(cluster) == 1:
        return cluster
    try:
        ordered: list[Direction] = []
        for ray in sorted(cluster, key=cmp_to_key(_compare)):
            if not ordered or _compare(ordered[-1], ray):
                ordered.append(ray)
    except Undecided:
        between_all = [_halfway(a, b) for a, b in combinations(cluster, 2)]
        return [cluster[0], *between_all, *cluster[1:]]
    found = ordered[:1]
    for ray, after in pairwise(ordered):
        found += [_halfway(ray, after), after]
    return found


def _compare(a: Direction, b: Direction) -> int:
    """Order of two rays next to each other by their angle."""
    return -a.exact().cross(b.exact()).sign()


def _middle(angle: float) -> Direction:
    """A ray within a cell; the float vector is the exact one."""
    unit = cos(angle), sin(angle)
    return Direction(unit, lambda: Point(*unit))


def _halfway(a: Direction, b: Direction) -> Direction:
    """A ray between two that floats cannot tell apart: the sum of vectors of about equal length."""
    u, v = a.exact(), b.exact()
    scale = rational(hypot(*u.xy) / hypot(*v.xy))
    return Direction(a.unit, lambda: u + v * scale)
