"""Whether a segment is free: its open part meets no obstacle's interior (touching a boundary does not block).

Floats settle the clear cases (see `exactacq.kernel.clearance`). Otherwise the contacts with the doubtful
edges divide the segment into pieces, and one exact point of each decides whether the piece is inside an
obstacle.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import hypot
from operator import itemgetter

from flint import fmpq

from exactacq.geometry.curve_images import held_point
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.points import Location, Point
from exactacq.kernel.clearance import crossed, met
from exactacq.numbers.real import Real, rational
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.line_balls import first_meetings
from exactacq.visibility.line_families import Sector

HALF = fmpq(1, 2)


def is_free(table: EdgeTable, start: Point, end: Point) -> bool:
    """Whether the segment between two points, neither of them inside an obstacle, is free.

    Without a contact between its ends it is taken to be outside: from a boundary it must not lead straight
    into the obstacle (see `BoundaryView.buries`).
    """
    first, last = held_point(start), held_point(end)
    (ax, ay, a), (bx, by, b) = first, last
    edges = table.around((min(ax, bx), min(ay, by)), (max(ax, bx), max(ay, by)), max(a, b))
    verdicts = crossed(table.images, edges, first, last)
    if 1 in verdicts:
        return False
    doubtful = [e for e, verdict in zip(edges, verdicts, strict=True) if verdict == 0]
    return is_free_among(table, start, end, doubtful)


def is_free_among(table: EdgeTable, start: Point, end: Point, edges: list[int]) -> bool:
    """Whether a segment is free that meets no edges but some of these, decided exactly (see `is_free`)."""
    direction = end - start
    cuts: dict[int, list[Real]] = {}
    for e in edges:
        for tau in _contacts(start, end, direction, table.curves[e]):
            if tau.sign() > 0 and tau.compare(1) < 0:
                cuts.setdefault(int(table.owner[e]), [Real(0), Real(1)]).append(tau)
    return not any(
        table.obstacles[k].locate(start + direction * ((low + high) * HALF)) is Location.INSIDE
        for k, values in cuts.items()
        for low, high in pairwise(sorted(values))
        if low.compare(high) != 0
    )


def _contacts(start: Point, end: Point, direction: Point, curve: Curve) -> list[Real]:
    """Parameters of a segment's contacts with a curve, but for an end that lies on the curve's circle.

    The other crossing then follows without a root, and the end need not be compared with 0 or 1.
    """
    if not isinstance(curve, Arc):
        return line_contacts(start, direction, curve)
    at_start, at_end = (curve.on_circle(p) for p in (start, end))
    if at_start and at_end:
        return []
    if not (at_start or at_end):
        return line_contacts(start, direction, curve)
    middle = (curve.center - start).dot(direction) / direction.norm_sq()
    other = 2 * middle - (1 if at_end else 0)
    return [other] if curve.contains(start + direction * other) else []


@dataclass(frozen=True, slots=True)
class LineWalk:
    """The contacts (signed parameter, edge) of a line within reach, nearest first; the last may block it.

    The edges *here* are met where it begins.
    """

    hits: list[tuple[Real, int]]
    here: list[int]
    blocked: bool = False


def walk_line(table: EdgeTable, sector: Sector, t: Real, reach: float) -> tuple[LineWalk, LineWalk]:
    """What a tangent line touches behind and ahead of its contact, up to what first blocks it."""
    contact, direction = sector.touch(t)
    x, y = contact.xy
    edges = table.around((x, y), (x, y), reach)
    size = hypot(*direction.xy)
    possible = met(table.images, edges, held_point(contact), held_point(direction))
    edges_met, walls = _as_far_as_walls(table, sector, t, possible)
    hits = [(tau, e) for e in edges_met for tau in line_contacts(contact, direction, table.curves[e])]
    hits.sort(key=itemgetter(0))
    far = reach * (1 + 1e-9) / size
    begun = {e for tau, e in hits if abs(float(tau)) <= far and not table.kind[e]}
    ahead = _as_far([hit for hit in hits if hit[0].sign() > 0], begun, far)
    behind = _as_far([hit for hit in reversed(hits) if hit[0].sign() < 0], begun, far)
    # Beyond the last contact nothing changes within reach: a parameter just short of that tells of the rest.
    end = rational(reach * (1 - 1e-9) / size)
    here = [e for tau, e in hits if tau.sign() == 0]
    return (
        _until_blocked(table, contact, direction, behind, here, walls, Real(-end)),
        _until_blocked(table, contact, direction, ahead, here, walls, Real(end)),
    )


def _as_far_as_walls(
    table: EdgeTable, sector: Sector, t: Real, edges: list[int]
) -> tuple[list[int], set[int]]:
    """Those of some edges that a line may meet up to where it surely is blocked, and those that block it.

    It is where long balls tell that it crosses an edge: the contact, where it begins, is not inside, so if it
    leaves an obstacle there it was blocked before.
    """
    first, left = first_meetings(table, sector, t, edges)
    walls = {e for *_, e in first.values()}
    kept = walls.union(left)
    return [e for e in edges if e in kept], walls


def _as_far(hits: list[tuple[Real, int]], begun: set[int], far: float) -> list[tuple[Real, int]]:
    """The contacts on one side up to a distance, or to the end of an edge along the line that has *begun*.

    Farther away only some edges were looked at; along an edge nothing else can be.
    """
    ends = (abs(float(tau)) for tau, e in hits if e in begun)
    limit = max(far, *ends, 0.0)
    return [hit for hit in hits if abs(float(hit[0])) <= limit]


def _until_blocked(
    table: EdgeTable,
    contact: Point,
    direction: Point,
    hits: list[tuple[Real, int]],
    here: list[int],
    walls: set[int],
    end: Real,
) -> LineWalk:
    """What is met up to what blocks, from a contact with the edges *here*; *walls* surely do.

    As nothing blocked so far, the line goes on inside an obstacle only if it meets it where it last met any.
    """
    previous = Real(0)
    met = {table.owners[e] for e in here}
    for k, (tau, e) in enumerate([*hits, (end, -1)]):
        if (tau - previous).sign() == end.sign():
            middle = contact + direction * ((previous + tau) * HALF)
            if any(table.obstacles[i].locate(middle) is Location.INSIDE for i in met):
                return LineWalk(hits[:k], here, blocked=True)
            previous, met = tau, set()
        if e in walls:
            return LineWalk(hits[: k + 1], here, blocked=True)
        if e >= 0:
            met.add(table.owners[e])
    return LineWalk(hits, here)
