"""Glimpses: whether an obstacle is seen from inside a straight piece of the path.

What the ends of a piece see is known from the boundaries they lie on. From an inner point an obstacle is
seen along a local minimum of the distance, or along a segment that a feature holds (see `links`); here
only the existence of such a segment within the radius matters, not the shortest one.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import hypot

import numpy as np
from flint import arb, ctx, fmpq

from exactacq.contacts import line_contacts, nearest_points
from exactacq.curves import Curve, Segment
from exactacq.errors import Undecided
from exactacq.links import Links, box_gaps
from exactacq.points import Point
from exactacq.reals import Real
from exactacq.vision.chords import Chord, chord_at, critical, meet
from exactacq.vision.clearance import is_free, walk_line
from exactacq.vision.pencil import Cell, pencil, rational_between
from exactacq.vision.sectors import Sector
from exactacq.vision.table import Floats

WORKING_BITS = 256
DEPTH = 200
"""A cell is halved at most so often: a chord that equals the radius closer than that is `Undecided`."""


def sees(links: Links, piece: Segment, target: int) -> bool:
    """Whether some inner point of a free segment sees the boundary of an obstacle within the radius.

    Raises `Undecided` where the shortest view from a piece with irrational ends equals the radius.
    """
    (ax, ay), (bx, by) = piece.start.xy, piece.end.xy
    box = np.array((min(ax, bx), min(ay, by), max(ax, bx), max(ay, by)))
    if links.gaps(box)[target] > links.reach:
        return False
    return _directly(links, piece, target) or any(_past_features(links, piece, box, target))


def _directly(links: Links, piece: Segment, target: int) -> bool:
    return any(
        item.distance_sq.compare(links.radius * links.radius) <= 0
        and any(True for _ in links.free_part(item, item.distance_sq.sqrt()))
        for e in links.edges_of(target)
        for item in nearest_points(piece, links.table.curves[e])
    )


def _past_features(links: Links, piece: Segment, box: Floats, target: int) -> Iterator[bool]:
    """For every cell and pinch of the features between piece and target, whether it gives a view."""
    centers, sizes = links.spots
    if not len(centers):
        return
    bounds = box_gaps(centers, box, sizes) + box_gaps(centers, links.hulls[target], sizes)
    table, owner = links.table, links.table.owner
    for k in np.flatnonzero(bounds <= links.reach + table.roundoff):
        feature = links.features[int(k)]
        if feature.owner == target:
            continue
        approach = _tangent_bound(links, int(k), piece)
        if approach > links.reach:
            continue
        for sector in feature.sectors:
            sweep = pencil(table, sector, feature.edges, links.reach)
            for cell in sweep.cells:
                for far, side in ((cell.behind, -1), (cell.ahead, 1)):
                    if far is None or owner[far] != target:
                        continue
                    if approach + links.clearance(int(k), far) <= links.reach:
                        yield _in_cell(links, sector, cell, piece, side)
            for t in sweep.pinches:
                yield _at_pinch(links, sector, t, piece, target)


def _tangent_bound(links: Links, k: int, piece: Segment) -> float:
    """Lower bound of the way along a tangent of a feature from the contact to a piece."""
    (x, y), size = links.spots[0][k], links.spots[1][k]
    (ax, ay), (bx, by) = piece.start.xy, piece.end.xy
    dx, dy = bx - ax, by - ay
    u = ((x - ax) * dx + (y - ay) * dy) / max(dx * dx + dy * dy, 1e-300)
    u = min(max(u, 0.0), 1.0)
    gap = max(hypot(x - ax - u * dx, y - ay - u * dy) * (1 - 1e-14) - 64 * links.table.roundoff, 0.0)
    return float(max(gap**2 - size**2 * (1 + 1e-12), 0.0) ** 0.5 * (1 - 1e-13))


def _at_pinch(links: Links, sector: Sector, t: Real, piece: Segment, target: int) -> bool:
    contact, direction = sector.touch(t)
    size = direction.norm_sq().sqrt()
    for hits in walk_line(links.table, sector, t, links.reach):
        first = links.first_contacts(hits)
        for tau in line_contacts(contact, direction, piece) if target in first else ():
            start, end = contact + direction * tau, contact + direction * first[target]
            near = (abs(first[target] - tau) * size).compare(links.limit) <= 0
            if near and is_free(links.table, start, end):
                return True
    return False


def _in_cell(links: Links, sector: Sector, cell: Cell, piece: Segment, side: int) -> bool:
    """Whether a line of a cell that crosses the piece sees its far edge (ahead: side 1) within the radius."""
    near, far = (cell.behind, cell.ahead) if side > 0 else (cell.ahead, cell.behind)
    assert far is not None
    curves = links.table.curves
    wall = None if near is None else curves[near]
    inner = sorted(t for p in (piece.start, piece.end) for t in _cuts(sector, cell, p))
    return any(
        a.compare(b) != 0
        and _is_open(sector, Real(rational_between(a, b)), piece, wall, side)
        and _comes_near(links, sector, (a, b), piece, curves[far], side)
        for a, b in pairwise([cell.low, *inner, cell.high])
    )


def _cuts(sector: Sector, cell: Cell, p: Point) -> Iterator[Real]:
    """The parameters strictly inside a cell at which its lines pass through a point.

    A piece often ends on a line that bounds the cell. That is asked of the point: comparing the parameters
    would take a root more.
    """
    values = sector.through(p)
    apart = len(values) < 2 or not _overlap(*values)
    for t in values:
        for bound, side in ((cell.low, 1), (cell.high, -1)):
            if apart and _overlap(t, bound):
                contact, direction = sector.touch(bound)
                if direction.cross(p - contact).sign() == 0:
                    break
            if t.compare(bound) != side:
                break
        else:
            yield t


def _overlap(a: Real, b: Real) -> bool:
    return bool(a.ball(WORKING_BITS).overlaps(b.ball(WORKING_BITS)))


def _is_open(sector: Sector, t: Real, piece: Segment, wall: Curve | None, side: int) -> bool:
    """Whether the line at *t* crosses the piece beyond the contact, no farther than the cell's near edge.

    The line is free between the edges of its cell. What the cell left out lies beyond the radius, and so
    does a piece behind it. A rational *t* keeps the numbers short.
    """
    contact, direction = sector.touch(t)
    met = line_contacts(contact, direction, piece)
    if not met or met[0].sign() * side >= 0:
        return False
    return wall is None or (met[0] - meet(contact, direction, wall, -side)).sign() * side >= 0


def _chord(sector: Sector, t: Real, piece: Segment, far: Curve, side: int) -> Chord:
    return chord_at(sector, t, piece, far) if side > 0 else chord_at(sector, t, far, piece)


def _comes_near(
    links: Links, sector: Sector, ends: tuple[Real, Real], piece: Segment, far: Curve, side: int
) -> bool:
    """Whether some chord between two parameters is no longer than the radius."""
    low, high = ends

    def within(t: Real) -> bool:
        return _chord(sector, t, piece, far, side).length.compare(links.limit) <= 0

    if within(low) or within(high):
        return True
    if piece.start.rational is not None and piece.end.rational is not None:
        behind, ahead = (piece, far) if side > 0 else (far, piece)
        stationary = critical(sector, behind, ahead) or ()
        return any(t.compare(low) > 0 and t.compare(high) < 0 and within(t) for t in stationary)
    return _bisected(links, sector, (low, high), piece, far, side)


def _bisected(
    links: Links, sector: Sector, ends: tuple[Real, Real], piece: Segment, far: Curve, side: int
) -> bool:
    """As `_comes_near`, without the roots of a polynomial: halve until balls or an exact chord decide."""
    low, high = ends[0].enclosure(WORKING_BITS)[0], ends[1].enclosure(WORKING_BITS)[1]
    limit = links.limit.ball(WORKING_BITS)
    waiting = [(low, high, 0)]
    while waiting:
        a, b, depth = waiting.pop()
        if _shortest_ball(sector, a, b, piece, far, side) > limit:
            continue
        if depth == DEPTH:
            raise Undecided(f"whether a view over {sector.center} is as short as the radius {links.radius}")
        middle = (a + b) / 2
        t = Real(middle)
        inside = t.compare(ends[0]) > 0 and t.compare(ends[1]) < 0
        if inside and _chord(sector, t, piece, far, side).length.compare(links.limit) <= 0:
            return True
        waiting += [(a, middle, depth + 1), (middle, b, depth + 1)]
    return False


def _shortest_ball(sector: Sector, low: fmpq, high: fmpq, piece: Segment, far: Curve, side: int) -> arb:
    """A ball that contains the lengths of all chords between two parameters (a NaN if it cannot tell)."""
    with ctx.workprec(WORKING_BITS):
        t = arb(low).union(arb(high))
        ex, ey = (arb(c) for c in sector.base)
        cx, cy = (arb(c) for c in sector.center)
        if sector.round:
            cosine, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
            vx, vy = cosine * ex - sine * ey, cosine * ey + sine * ex
            contact, direction = (vx + cx, vy + cy), (-vy, vx)
        else:
            contact, direction = (cx, cy), (ex - t * ey, ey + t * ex)
        size = (direction[0] * direction[0] + direction[1] * direction[1]).sqrt()
        near = _parameter(contact, direction, piece, -side)
        return abs(_parameter(contact, direction, far, side) - near) * size


def _parameter(contact: tuple[arb, arb], direction: tuple[arb, arb], edge: Curve, side: int) -> arb:
    """Ball version of `chords.meet`: where lines enter the obstacle through an edge."""
    (x, y), (dx, dy) = contact, direction
    if isinstance(edge, Segment):
        ax, ay = (c.ball(WORKING_BITS) for c in edge.direction)
        sx, sy = (c.ball(WORKING_BITS) for c in edge.start)
        return ((sx - x) * ay - (sy - y) * ax) / (dx * ay - dy * ax)
    ox, oy = (c.ball(WORKING_BITS) for c in edge.center)
    hx, hy = ox - x, oy - y
    middle, size = hx * dx + hy * dy, dx * dx + dy * dy
    square = middle * middle - size * (hx * hx + hy * hy - arb(edge.radius_sq))
    root = square.nonnegative_part().sqrt()
    return (middle + (-side if edge.ccw else side) * root) / size
